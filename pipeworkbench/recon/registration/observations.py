# SPDX-License-Identifier: LGPL-2.1-or-later
"""What pairs of corresponding components observe of the poses of their stations, with derivatives (Sect. 8.3).

A point p of station b lies at x = R(q_b) p + t_b in the frame and at y = R(q_a)^T (x - t_a) in station a. Of a pipe two points are
observed, at the ends of the course that both stations saw; their distances to the axis in a are split into two perpendicular components.
Those of an anchor (corner, face, control point) are split into three.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.registration.hypotheses import Pairs
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.poses import Pose, conjugated, rotated, rotated_by_quaternion

LEAST_HALF_MM = 50.0  # between two points of an axis that tell its direction, halved
CONJUGATE = np.diag([-1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class Observations:
    """Pairs of components, m in number.

    stations (m, 2) rows of stations a and b; points (m, 2, 3) mm in b; targets (m, 2, 3) mm in a; splits (m, 4, 6) from
    the vectors between both points and targets in a to their perpendicular components, each over its standard deviation (a fourth row of
    zeros for anchors); axes (m, 3) in a, zero for anchors; counts (m,) components observed; share (m,) between 0 and 1 of the weight that
    a pair may have, 0 for what follows from other pairs.
    """

    stations: NDArray[np.intp]
    points: Array
    targets: Array
    splits: Array
    axes: Array
    counts: NDArray[np.intp]
    share: Array

    def __len__(self) -> int:
        return len(self.stations)

    @classmethod
    def joined(cls, parts: Sequence[Observations]) -> Observations:
        """Return observations one after the other."""
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__dataclass_fields__))


def observations_of(one: Landmarks, other: Landmarks, pairs: Pairs, one_from_other: Pose, stations: tuple[int, int]) -> Observations:
    """Return what pairs of landmarks observe.

    Parameters
    ----------
    one, other : Landmarks
        Of stations a and b.
    pairs : Pairs
    one_from_other : Pose
        Approximately; turns covariances and finds the courses that pipes have in common.
    stations : (int, int)
        Rows of a and b.
    """
    i, j = pairs.first, pairs.second
    line, axis = one.is_axis[i], one.axis[i]
    moved, turned = one_from_other.points(other.point[j]), other.axis[j] @ one_from_other.rotation.T
    way = np.where(np.einsum("mi,mi->m", turned, axis) < 0, -1.0, 1.0)
    along = np.einsum("mi,mi->m", moved - one.point[i], axis)
    low, high = np.maximum(-one.half[i], along - other.half[j]), np.minimum(one.half[i], along + other.half[j])
    middle, half = (low + high) / 2, np.maximum((high - low) / 2, LEAST_HALF_MM)
    places = np.where(line[:, None], np.stack([middle - half, middle + half], 1), 0.0)  # along a's axis, from its middle
    steps = np.where(line[:, None], (places - along[:, None]) * way[:, None], 0.0)  # along b's
    points = other.point[j][:, None] + steps[..., None] * other.axis[j][:, None]
    targets = one.point[i][:, None] + places[..., None] * axis[:, None]
    rotation = one_from_other.rotation
    place = one.position[i] + rotation @ other.position[j] @ rotation.T
    tilt, other_tilt = one.direction[i], rotation @ other.direction[j] @ rotation.T
    covariance = place[:, None, None] + np.einsum("ms,mt->mst", places, places)[..., None, None] * tilt[:, None, None]
    covariance = covariance + np.einsum("ms,mt->mst", steps, steps)[..., None, None] * other_tilt[:, None, None]
    splits = np.empty((len(pairs), 4, 6))
    splits[line], splits[~line] = _line_splits(axis[line], covariance[line]), _point_splits(place[~line])
    counts = np.where(line, 4, 3)
    rows = np.broadcast_to(np.array(stations, np.intp), (len(pairs), 2))
    return Observations(rows, points, targets, splits, np.where(line[:, None], axis, 0.0), counts, _shares(one, other, pairs))


def observations_of_points(points: Array, targets: Array, covariance: Array, stations: tuple[int, int]) -> Observations:
    """Return what control points (m, 3) of station b and their places (m, 3) in a observe, mm, with covariances (m, 3, 3)."""
    count = len(points)
    rows = np.broadcast_to(np.array(stations, np.intp), (count, 2))
    both = [np.repeat(np.asarray(array, float)[:, None], 2, axis=1) for array in (points, targets)]
    return Observations(rows, both[0], both[1], _point_splits(covariance), np.zeros((count, 3)), np.full(count, 3), np.ones(count))


def _line_splits(axis: Array, covariance: Array) -> Array:
    """Return the splits (m, 4, 6) of axes (m, 3) whose points have covariances (m, 2, 2, 3, 3)."""
    across = np.stack(perpendicular_axes(axis), axis=1)
    split = np.zeros((len(axis), 4, 6))
    split[:, :2, :3], split[:, 2:, 3:] = across, across
    whole = split @ covariance.transpose(0, 1, 3, 2, 4).reshape(-1, 6, 6) @ split.transpose(0, 2, 1)
    return np.asarray(np.linalg.solve(np.linalg.cholesky(whole), split))


def _point_splits(covariance: Array) -> Array:
    """Return the splits (m, 4, 6) of anchors with covariances (m, 3, 3)."""
    split = np.zeros((len(covariance), 4, 6))
    split[:, :3, :3] = np.linalg.inv(np.linalg.cholesky(covariance))
    return split


def _shares(one: Landmarks, other: Landmarks, pairs: Pairs) -> Array:
    """Return 0 for corners between two pipes that correspond themselves: they tell nothing that their axes do not, else 1."""
    first, second = set(pairs.first.tolist()), set(pairs.second.tolist())
    known = [
        all(row in first for row in one.redundant[i].tolist()) and all(row in second for row in other.redundant[j].tolist())
        for i, j in zip(pairs.first, pairs.second, strict=True)
    ]
    return np.where(known, 0.0, 1.0)


def offsets(observations: Observations, quaternions: Array, translations: Array) -> Array:
    """Return the vectors (m, 2, 3), mm in station a, from targets to points, for poses (s, 4), (s, 3)."""
    a, b = observations.stations.T
    flat = observations.points.reshape(-1, 3)
    moved = rotated(np.repeat(quaternions[b], 2, axis=0), flat) + np.repeat(translations[b] - translations[a], 2, axis=0)
    return rotated(conjugated(np.repeat(quaternions[a], 2, axis=0)), moved).reshape(-1, 2, 3) - observations.targets


def residuals(observations: Observations, quaternions: Array, translations: Array) -> Array:
    """Return the perpendicular components (m, 4) over their standard deviations."""
    off = offsets(observations, quaternions, translations).reshape(-1, 6)
    return np.asarray(np.einsum("mcv,mv->mc", observations.splits, off))


def jacobians(observations: Observations, quaternions: Array, translations: Array) -> tuple[Array, Array]:
    """Return the derivatives (m, 4, 7) of the residuals by quaternion and translation of a and of b (Eqs. 17 to 20)."""
    a, b = (np.repeat(rows, 2) for rows in observations.stations.T)
    flat = observations.points.reshape(-1, 3)
    from_frame = np.stack([rotated(conjugated(quaternions[a]), np.broadcast_to(basis, (len(a), 3))) for basis in np.eye(3)], axis=2)
    away = rotated(quaternions[b], flat) + translations[b] - translations[a]
    by_a = np.concatenate([rotated_by_quaternion(conjugated(quaternions[a]), away) @ CONJUGATE, -from_frame], axis=2)
    by_b = np.concatenate([from_frame @ rotated_by_quaternion(quaternions[b], flat), from_frame], axis=2)
    first, second = (np.einsum("mcv,mvk->mck", observations.splits, by.reshape(-1, 6, 7)) for by in (by_a, by_b))
    return first, second


def distances(observations: Observations, quaternions: Array, translations: Array) -> Array:
    """Return the distances (m, 2), mm, of points to their axes or anchors."""
    off = offsets(observations, quaternions, translations)
    off = off - np.einsum("msi,mi->ms", off, observations.axes)[..., None] * observations.axes[:, None]
    return np.asarray(np.linalg.norm(off, axis=2))
