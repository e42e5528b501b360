# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well pairs of landmarks coincide at many poses at once, and what at a pose contradicts it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.hypotheses import Hypotheses, Pairs
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.settings import SearchSettings

TIE_MM = 5.0  # pieces of one pipe lie as near to it as the nearest, give or take the noise
LEAST_COURSE_MM = 30.0  # over which two pipes must run beside each other to be the same
INSIDE = 1.0  # diameters from their ends from which on two pipes that cross cannot both be there
DEEP = 0.6  # part of the sum of both radii below which crossing axes mean that pipes lie in each other
PARALLEL_COSINE = 0.9
NEAR_MM, NEAR_SLOPE = 150.0, 0.1  # beyond what any tolerance and any tilt of the directions lets coincide


@dataclass(frozen=True, eq=False)
class Comparison:
    """Pairs of landmarks at poses, m combinations in number.

    pose (m,), pair (m,) rows; points (m, 2, 3) of the second landmark in the first's frame, mm: the ends of the course both have in
    common, or the anchor twice; off (m, 2, 3) from the first landmark to them, across its axis; distance (m,), their root mean
    square; course (m,) mm in common, infinite for anchors; sigma (m,) mm expected of the distances; agrees (m,) whether directions do.
    """

    pose: NDArray[np.intp]
    pair: NDArray[np.intp]
    points: Array
    off: Array
    distance: Array
    course: Array
    sigma: Array
    agrees: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.pose)

    def __getitem__(self, rows: NDArray[np.bool_]) -> Comparison:
        return Comparison(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))


def compared(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses, settings: SearchSettings) -> Comparison:
    """Return how pairs of landmarks lie to each other at poses of the second station, where they are near each other at all."""
    h, p = _near(one, other, pairs, poses)
    i, j = pairs.first[p], pairs.second[p]
    line, axis = one.is_axis[i], one.axis[i]
    rotation = poses.rotation[h]
    moved = np.einsum("mab,mb->ma", rotation, other.point[j]) + poses.translation[h]
    turned = np.einsum("mab,mb->ma", rotation, other.axis[j])
    cosine = np.einsum("ma,ma->m", turned, axis)
    way = np.where(cosine < 0, -1.0, 1.0)
    along = np.einsum("ma,ma->m", moved - one.point[i], axis)
    low, high = np.maximum(-one.half[i], along - other.half[j]), np.minimum(one.half[i], along + other.half[j])
    # pipes that do not meet are compared where they are nearest to each other
    places = np.where(line[:, None], np.stack([low, high], 1), along[:, None])
    steps = np.where(line[:, None], (places - along[:, None]) * way[:, None], 0.0)
    points = moved[:, None] + steps[..., None] * turned[:, None]
    off = points - one.point[i][:, None]
    aside = off - np.einsum("msa,ma->ms", off, axis)[..., None] * axis[:, None]
    off = np.where(line[:, None, None], aside, off)
    distance = np.sqrt((off**2).sum(-1).mean(-1))
    (position, direction), (other_position, other_direction) = (_variances(marks) for marks in (one, other))
    floor, tilt_floor = settings.floor_mm**2, np.radians(settings.floor_deg) ** 2
    variance = position[i] + other_position[j] + 2 * floor
    levers = (places**2).mean(-1) * (direction[i] + tilt_floor) + (steps**2).mean(-1) * (other_direction[j] + tilt_floor)
    agrees = np.where(line, np.abs(cosine), cosine) >= np.cos(np.radians(settings.direction_deg))
    sigma = np.sqrt(variance + np.where(line, levers, 0.0))
    return Comparison(h, p, points, off, distance, np.where(line, high - low, np.inf), sigma, agrees)


def _near(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows of poses and pairs (m,) whose landmarks are so near that they may coincide after all."""
    i, j = pairs.first, pairs.second
    moved = other.point @ poses.rotation.transpose(0, 2, 1) + poses.translation[:, None]
    away = moved[:, j] - one.point[i]
    along = (away * one.axis[i]).sum(-1)
    reach = one.half[i] + other.half[j]
    aside = (away**2).sum(-1) - along**2
    h, p = np.nonzero((np.abs(along) <= reach + NEAR_MM) & (aside <= (NEAR_MM + NEAR_SLOPE * reach) ** 2))
    return h, p


def _variances(marks: Landmarks) -> tuple[Array, Array]:
    """Return the largest variances (n,) of positions, mm^2, and directions, rad^2."""
    if not len(marks):
        return np.zeros(0), np.zeros(0)
    return np.linalg.eigvalsh(marks.position)[:, -1], np.linalg.eigvalsh(marks.direction)[:, -1]


def nearest(one: Landmarks, pairs: Pairs, good: Comparison, count: int, seconds: int) -> NDArray[np.bool_]:
    """Return which (m,) combinations are the nearest of both their landmarks; of axes all that are as near.

    Parameters
    ----------
    one : Landmarks
    pairs : Pairs
    good : Comparison
        Those of m combinations that may be chosen.
    count : int
        Of poses.
    seconds : int
        How many landmarks the second station has.
    """
    tolerance = np.where(one.is_axis[pairs.first[good.pair]], TIE_MM, 0.0)
    chosen = np.ones(len(good), bool)
    for rows, landmarks in ((pairs.first[good.pair], len(one)), (pairs.second[good.pair], seconds)):
        chosen &= good.distance <= least_of(good.distance, good.pose, rows, (count, landmarks))[good.pose, rows] + tolerance
    return chosen


def least_of(values: Array, poses: NDArray[np.intp], rows: NDArray[np.intp], shape: tuple[int, int]) -> Array:
    """Return the least of the values (m,) that belong to each pose and landmark, an array of a shape, infinite where there is none."""
    best = np.full(shape, np.inf)
    np.minimum.at(best, (poses, rows), values)
    return best


def coarse_scores(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses, settings: SearchSettings) -> Array:
    """Return the weight (h,) of what poses explain within the wide tolerance that an unknown tilt asks for."""
    i, j = pairs.first, pairs.second
    if not len(pairs):
        return np.zeros(len(poses))
    line, axis = one.is_axis[i], one.axis[i]
    # all poses of one heading share the rotation
    fixed = other.point[j] @ poses.rotation[0].T - one.point[i]
    off = fixed + poses.translation[:, None]
    along = np.einsum("hpa,pa->hp", off, axis)
    square = (off**2).sum(-1) - np.where(line, along**2, 0.0)
    lever = np.linalg.norm(other.point[j] - other.middle, axis=1)
    tolerance = settings.coarse + settings.coarse_slope * lever
    explained = (square <= tolerance**2) & (~line | (np.abs(along) < one.half[i] + other.half[j] + tolerance))
    gain = explained * one.weight[i]
    sums = []
    for rows, order in ((i, slice(None)), (j, np.argsort(j, kind="stable"))):
        sorted_rows = rows[order]
        starts = np.flatnonzero(np.diff(sorted_rows, prepend=-1))
        sums.append(np.maximum.reduceat(gain[:, order], starts, axis=1).sum(1))
    return np.minimum(*sums)


def contradictions(one: Landmarks, other: Landmarks, poses: Hypotheses) -> Array:
    """Return how many pipes (h,) of one station pass through a pipe of the other at poses: two bodies cannot be in one place."""
    a, b = np.flatnonzero(one.is_axis), np.flatnonzero(other.is_axis)
    if not len(a) or not len(b):
        return np.zeros(len(poses))
    middle = np.einsum("hab,pb->hpa", poses.rotation, other.point[b]) + poses.translation[:, None]
    axis = np.einsum("hab,pb->hpa", poses.rotation, other.axis[b])
    cosine = np.einsum("ia,hja->hij", one.axis[a], axis)
    away = middle[:, None] - one.point[a][:, None]
    first, second = np.einsum("hija,ia->hij", away, one.axis[a]), np.einsum("hija,hja->hij", away, axis)
    sine2 = np.maximum(1 - cosine**2, 1e-6)
    here, there = (first - cosine * second) / sine2, (cosine * first - second) / sine2
    square = (away**2).sum(-1) + here**2 + there**2 - 2 * here * first + 2 * there * second - 2 * here * there * cosine
    diameter, other_diameter = one.sizes[a, 0], other.sizes[b, 0]
    inside = (np.abs(here) < (one.half[a] - INSIDE * diameter)[:, None]) & (np.abs(there) < other.half[b] - INSIDE * other_diameter)
    near = square < (DEEP * (diameter[:, None] + other_diameter) / 2) ** 2
    return np.asarray((inside & near & (np.abs(cosine) < PARALLEL_COSINE)).sum((1, 2)))
