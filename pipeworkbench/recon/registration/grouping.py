# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which components of several stations, once they are in one frame, are the same thing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import cdist

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.settings import FusionSettings

SAME_DIAMETER = 0.02  # relative
ANCHOR_COSINE = 0.94  # 20 degrees: a short pipe's direction and the elbow's that hangs on it err alike


def in_frame(landmarks: Sequence[Landmarks], poses: Sequence[Pose]) -> Landmarks:
    """Return the landmarks of all stations in one frame, one station after the other."""

    def stacked(name: str) -> Any:
        return np.concatenate([getattr(marks, name) for marks in landmarks])

    turned = {
        name: np.concatenate([pose.rotation @ getattr(marks, name) @ pose.rotation.T for marks, pose in zip(landmarks, poses, strict=True)])
        for name in ("position", "direction")
    }
    starts = np.cumsum([0, *(len(marks) for marks in landmarks)])
    redundant = np.concatenate([np.where(marks.redundant >= 0, marks.redundant + start, -1) for marks, start in zip(landmarks, starts, strict=False)])
    return Landmarks(
        kind=stacked("kind"),
        point=np.concatenate([pose.points(marks.point) for marks, pose in zip(landmarks, poses, strict=True)]),
        axis=np.concatenate([marks.axis @ pose.rotation.T for marks, pose in zip(landmarks, poses, strict=True)]),
        half=stacked("half"),
        sizes=stacked("sizes"),
        held=stacked("held").astype(bool),
        weight=stacked("weight"),
        redundant=redundant,
        **turned,
    )


def same_things(marks: Landmarks, station: NDArray[np.intp], settings: FusionSettings) -> list[NDArray[np.intp]]:
    """Return the rows of landmarks (n) in groups that are one thing each; ``station`` (n,) says who saw them.

    Two of one station are never the same of themselves; a longer pipe of another station may join them.
    """
    count = len(marks)
    first, second = np.nonzero(np.triu((marks.kind[:, None] == marks.kind) & (station[:, None] != station) & _near(marks, settings), 1))
    line = marks.is_axis[first]
    same = np.abs(marks.sizes[first, 0] - marks.sizes[second, 0]) <= SAME_DIAMETER * marks.sizes[first, 0]
    same &= np.where(line, _same_axis(marks, first, second, settings), _same_anchor(marks, first, second, settings))
    first, second, line = first[same], second[same], line[same]
    # of anchors that are close to each other each has one counterpart in a station
    distance = np.linalg.norm(marks.point[first] - marks.point[second], axis=1)
    kept = line | (_nearest_of(distance, first, station[second]) & _nearest_of(distance, second, station[first]))
    graph = coo_array((np.ones(int(kept.sum())), (first[kept], second[kept])), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return [np.flatnonzero(label == number) for number in range(int(label.max(initial=-1)) + 1)]


def _near(marks: Landmarks, settings: FusionSettings) -> NDArray[np.bool_]:
    """Return which landmarks (n, n) could touch at all."""
    reach = marks.half + np.maximum(settings.anchor_mm, settings.gap_mm)
    return np.asarray(cdist(marks.point, marks.point) <= reach[:, None] + reach)


def _nearest_of(distance: Array, rows: NDArray[np.intp], station: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return which pairs have the least distance of all that join a row to the same station."""
    if not len(rows):
        return np.zeros(0, bool)
    key = rows * (station.max() + 1) + station
    _, group = np.unique(key, return_inverse=True)
    least = np.full(int(group.max()) + 1, np.inf)
    np.minimum.at(least, np.ravel(group), distance)
    return np.asarray(distance <= least[np.ravel(group)])


def _same_anchor(marks: Landmarks, first: NDArray[np.intp], second: NDArray[np.intp], settings: FusionSettings) -> NDArray[np.bool_]:
    distance = np.linalg.norm(marks.point[first] - marks.point[second], axis=1)
    cosine = np.einsum("pi,pi->p", marks.axis[first], marks.axis[second])
    return np.asarray((distance <= np.maximum(settings.anchor * marks.sizes[first, 0], settings.anchor_mm)) & (cosine >= ANCHOR_COSINE))


def _same_axis(marks: Landmarks, first: NDArray[np.intp], second: NDArray[np.intp], settings: FusionSettings) -> NDArray[np.bool_]:
    """Return which pairs of pipes lie on one axis and overlap, or nearly meet with nothing joined between them."""
    axis, diameter = marks.axis[first], marks.sizes[first, 0]
    cosine = np.einsum("pi,pi->p", axis, marks.axis[second])
    away = marks.point[second] - marks.point[first]
    along = np.einsum("pi,pi->p", away, axis)
    reach = np.abs(cosine) * marks.half[second]
    low, high = np.maximum(-marks.half[first], along - reach), np.minimum(marks.half[first], along + reach)
    # where both are to be compared: at the ends of what they share, or of the gap between them
    aside = np.zeros((len(first), 2))
    for side, place in enumerate((low, high)):
        there = marks.point[second] + ((place - along) / np.where(cosine == 0, 1.0, cosine))[:, None] * marks.axis[second]
        aside[:, side] = np.linalg.norm(there - marks.point[first] - place[:, None] * axis, axis=1)
    good = (np.abs(cosine) >= np.cos(np.radians(settings.direction_deg))) & (aside.mean(1) <= settings.aside * diameter)
    # the ends that face each other where the second lies ahead of the first, or behind it
    ahead = along > 0
    facing = marks.held[first, ahead.astype(int)] | marks.held[second, np.where(cosine > 0, ~ahead, ahead).astype(int)]
    gap = np.minimum(settings.gap * diameter, settings.gap_mm)
    return np.asarray(
        good & (((high > low) & ((high - low > diameter) | ~facing)) | ((low - high <= gap) & ~facing) | _mostly(marks, first, second, high - low))
    )


def _mostly(marks: Landmarks, first: NDArray[np.intp], second: NDArray[np.intp], course: Array) -> NDArray[np.bool_]:
    """Return which pairs share most of the shorter one's length."""
    return np.asarray(course > 0.5 * 2 * np.minimum(marks.half[first], marks.half[second]))
