# SPDX-License-Identifier: LGPL-2.1-or-later
"""Starting values of a station's pose from two pairs of components (Sect. 8.2), or from common points."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.hypotheses import Pairs
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.poses import Pose

LEAST_SINE2 = 0.03  # squared sine of the angle between axes that are not parallel: 10 degrees
LEAST_SPREAD = 1e-3  # second singular value over the first one of points that do not lie on a line
LEAST_EXTENT_MM = 100.0


def from_two_axes(first: tuple[Array, Array], second: tuple[Array, Array], distance: float) -> Array:
    """Return the artificial points s, t1, t2 (3, 3), mm, of two axes (Fig. 15).

    Parameters
    ----------
    first, second : (point (3,) mm, unit direction (3,))
        Of axes that are not parallel. s is where they meet, or the middle of their common perpendicular.
    distance : float
        From s to t1 along the first axis and to t2 along the second, mm.
    """
    (p, d), (q, e) = first, second
    away = q - p
    normal = np.stack([d, -e], axis=1)
    along, other = np.linalg.lstsq(normal, away, rcond=None)[0]
    s = (p + along * d + q + other * e) / 2
    return np.array([s, s + distance * d, s + distance * e])


def from_points(points: Array, targets: Array) -> Pose | None:
    """Return the pose that carries points (n, 3) onto targets (n, 3), mm, best; None where they lie on a line or are fewer than three."""
    if len(points) < 3:
        return None
    centre, target = points.mean(0), targets.mean(0)
    spread = np.linalg.svd(points - centre, compute_uv=False)
    if spread[1] <= LEAST_SPREAD * spread[0]:
        return None
    turn, _ = Rotation.align_vectors(targets - target, points - centre)
    rotation = turn.as_matrix()
    return Pose(rotation, target - rotation @ centre)


def pretransformation(one: Landmarks, other: Landmarks, pairs: Pairs) -> Pose | None:
    """Return the pose of a second station from pairs that correspond.

    Of the axes the two with the largest product of length and squared sine of the angle between them are taken, both ways round
    where the direction of a pipe is open; of anchors the points themselves. What explains the other pairs best wins.
    """
    candidates = [*_from_axes(one, other, pairs), *_from_anchors(one, other, pairs)]
    return min(candidates, key=lambda pose: _misfit(one, other, pairs, pose), default=None)


def _from_axes(one: Landmarks, other: Landmarks, pairs: Pairs) -> list[Pose]:
    lines = np.flatnonzero(one.is_axis[pairs.first])
    if len(lines) < 2:
        return []
    first, second = (lines[rows] for rows in np.triu_indices(len(lines), 1))
    extent = np.minimum(one.half[pairs.first], other.half[pairs.second])
    sine2 = 1 - np.einsum("pi,pi->p", one.axis[pairs.first[first]], one.axis[pairs.first[second]]) ** 2
    best = int(np.argmax(extent[first] * extent[second] * sine2))
    if sine2[best] < LEAST_SINE2:
        return []
    chosen = pairs[np.array([first[best], second[best]])]
    distance = max(2 * float(extent[first[best]]), LEAST_EXTENT_MM)
    axes = [(one.point[row], one.axis[row]) for row in chosen.first]
    targets = from_two_axes(axes[0], axes[1], distance)
    found = []
    for ways in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        turned = [(other.point[row], way * other.axis[row]) for row, way in zip(chosen.second, ways, strict=True)]
        pose = from_points(from_two_axes(turned[0], turned[1], distance), targets)
        if pose is not None:
            found.append(pose)
    return found


def _from_anchors(one: Landmarks, other: Landmarks, pairs: Pairs) -> list[Pose]:
    """Return the pose that anchors give: their points, and a point along each direction."""
    anchors = pairs[~one.is_axis[pairs.first]]
    if len(anchors) < 1:
        return []
    points = np.concatenate([other.point[anchors.second], other.point[anchors.second] + LEAST_EXTENT_MM * other.axis[anchors.second]])
    targets = np.concatenate([one.point[anchors.first], one.point[anchors.first] + LEAST_EXTENT_MM * one.axis[anchors.first]])
    pose = from_points(points, targets)
    return [] if pose is None else [pose]


def _misfit(one: Landmarks, other: Landmarks, pairs: Pairs, pose: Pose) -> float:
    """Return how far pairs are apart at a pose in all, mm, and how far stations would stand askew: they are roughly level."""
    off = pose.points(other.point[pairs.second]) - one.point[pairs.first]
    axis = one.axis[pairs.first]
    aside = off - np.einsum("pi,pi->p", off, axis)[:, None] * axis
    off = np.where(one.is_axis[pairs.first][:, None], aside, off)
    turned = other.axis[pairs.second] @ pose.rotation.T
    kink = 1 - np.abs(np.einsum("pi,pi->p", turned, axis))
    askew = 1 - pose.rotation[2, 2]
    # sections of one pipe rarely lie far from each other
    along = np.abs(np.einsum("pi,pi->p", pose.points(other.point[pairs.second]) - one.point[pairs.first], axis))
    apart = np.where(one.is_axis[pairs.first], np.maximum(along - one.half[pairs.first] - other.half[pairs.second], 0.0), 0.0)
    return float(np.linalg.norm(off, axis=1).sum() + apart.sum() + 1e3 * (kink.sum() + 10 * askew))
