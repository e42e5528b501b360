# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where another station could stand: all poses that two pairs of alike components allow, those most pairs vote for first (Sect. 8.1).

Stations are roughly level: a pair of horizontal directions gives the heading, two pairs of axes that cross, or one pair
of anchors, the translation. Nothing is drawn by lot: all headings and, of the rarest components first, all pairs are tried.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.landmarks import ELBOW, Landmarks
from pipeworkbench.recon.registration.poses import headed
from pipeworkbench.recon.registration.settings import SearchSettings

HORIZONTAL = 0.35  # sine of the angle with the vertical from which on a direction tells the heading: 20 degrees
SMOOTHING = 2  # steps of the histogram of headings on both sides
LEAST_HEADINGS = 3.0  # votes below which headings come from pairs of places, too
PLACES = 60  # rarest vertical axes and anchors from which such headings are taken
PLACES_APART_MM, PLACES_ALIKE_MM = 200.0, 40.0
ORTHOGONAL_BONUS = 1.0  # by how much more axes at right angles count than parallel ones


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of landmarks of two stations that could be the same component, p in number, sorted by the first.

    first, second (p,) rows; rarity (p,): one over the number of pairs that the two have with others.
    """

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    rarity: Array

    def __len__(self) -> int:
        return len(self.first)

    def __getitem__(self, rows: NDArray[np.bool_] | NDArray[np.intp]) -> Pairs:
        return Pairs(self.first[rows], self.second[rows], self.rarity[rows])


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """Poses of a second station in the first one's frame, h in number: rotation (h, 3, 3), translation (h, 3) mm."""

    rotation: Array
    translation: Array

    def __len__(self) -> int:
        return len(self.rotation)

    def __getitem__(self, rows: NDArray[np.bool_] | NDArray[np.intp]) -> Hypotheses:
        return Hypotheses(self.rotation[rows], self.translation[rows])


def alike(one: Landmarks, other: Landmarks, settings: SearchSettings) -> Pairs:
    """Return the pairs of the same kind, sizes and inclination."""
    kind = one.kind[:, None] == other.kind
    diameter = np.maximum(one.sizes[:, None, 0], other.sizes[:, 0])
    same = kind & (np.abs(one.sizes[:, None, 0] - other.sizes[:, 0]) <= settings.diameter * diameter)
    difference = np.abs(one.sizes[:, None, 1] - other.sizes[:, 1])
    tolerance = np.where(one.kind[:, None] == ELBOW, settings.bend_deg, settings.second_size * np.maximum(one.sizes[:, None, 1], other.sizes[:, 1]))
    inclination, other_inclination = (np.arcsin(np.clip(marks.axis[:, 2], -1, 1)) for marks in (one, other))
    inclined = np.abs(inclination[:, None] - other_inclination)
    either_way = np.abs(inclination[:, None] + other_inclination)
    inclined = np.where(one.is_axis[:, None], np.minimum(inclined, either_way), inclined)
    same &= (difference <= tolerance) & (inclined <= np.radians(settings.inclination_deg))
    first, second = np.nonzero(same)
    per_first, per_second = same.sum(1), same.sum(0)
    return Pairs(first, second, 1 / (per_first[first] * per_second[second]))


def hypotheses_of(one: Landmarks, other: Landmarks, pairs: Pairs, settings: SearchSettings) -> list[tuple[float, Hypotheses, Pairs]]:
    """Return for each heading (rad) the poses to look at, and the pairs whose directions agree at it."""
    found = []
    for heading in _headings(one, other, pairs, settings):
        rotation = headed(heading)
        agree = pairs[agreeing(one, other, pairs, rotation, settings)]
        translation = _translations(one, other, agree, rotation, settings)
        if len(translation):
            found.append((heading, Hypotheses(np.broadcast_to(rotation, (len(translation), 3, 3)), translation), agree))
    return found


def agreeing(one: Landmarks, other: Landmarks, pairs: Pairs, rotation: Array, settings: SearchSettings) -> NDArray[np.bool_]:
    """Return which pairs' (p,) directions agree after a rotation (3, 3) of the second station."""
    cosine = np.einsum("pi,pi->p", one.axis[pairs.first], other.axis[pairs.second] @ rotation.T)
    cosine = np.where(one.is_axis[pairs.first], np.abs(cosine), cosine)
    return np.asarray(cosine >= np.cos(np.radians(settings.direction_deg)))


def _headings(one: Landmarks, other: Landmarks, pairs: Pairs, settings: SearchSettings) -> list[float]:
    """Return the headings (rad) that most pairs vote for, best first."""
    a, b = one.axis[pairs.first], other.axis[pairs.second]
    flat = (np.hypot(a[:, 0], a[:, 1]) > HORIZONTAL) & (np.hypot(b[:, 0], b[:, 1]) > HORIZONTAL)
    turn = np.arctan2(a[flat, 1], a[flat, 0]) - np.arctan2(b[flat, 1], b[flat, 0])
    weight = pairs.rarity[flat]
    both_ways = one.is_axis[pairs.first][flat]
    turn, weight = np.concatenate([turn, turn[both_ways] + np.pi]), np.concatenate([weight, weight[both_ways]])
    if len(turn) < LEAST_HEADINGS:
        turn_of_places, weight_of_places = _turns_of_places(one, other, pairs)
        turn, weight = np.concatenate([turn, turn_of_places]), np.concatenate([weight, weight_of_places])
    steps = round(360 / settings.heading_step_deg)
    place = np.mod(turn, 2 * np.pi) / (2 * np.pi) * steps
    votes = np.bincount(np.floor(place).astype(int) % steps, weight, minlength=steps)
    smooth = np.sum([np.roll(votes, shift) for shift in range(-SMOOTHING, SMOOTHING + 1)], axis=0)
    headings: list[float] = []
    while len(headings) < settings.headings and smooth.max(initial=0.0) > 0:
        peak = int(smooth.argmax())
        off = (place - peak - 0.5 + steps / 2) % steps - steps / 2
        near = np.abs(off) <= SMOOTHING + 0.5
        headings.append(float((peak + 0.5 + np.average(off[near], weights=weight[near])) * 2 * np.pi / steps))
        smooth[np.arange(peak - 2 * SMOOTHING, peak + 2 * SMOOTHING + 1) % steps] = 0
    return headings


def _turns_of_places(one: Landmarks, other: Landmarks, pairs: Pairs) -> tuple[Array, Array]:
    """Return headings (rad) and their weights from every two vertical axes or anchors: what joins them in plan."""
    upright = np.hypot(one.axis[pairs.first, 0], one.axis[pairs.first, 1]) <= HORIZONTAL
    located = np.flatnonzero(upright | ~one.is_axis[pairs.first])
    located = located[np.argsort(-pairs.rarity[located], kind="stable")[:PLACES]]
    i, j = (located[rows] for rows in np.triu_indices(len(located), 1))
    a = (one.point[pairs.first[j]] - one.point[pairs.first[i]])[:, :2]
    b = (other.point[pairs.second[j]] - other.point[pairs.second[i]])[:, :2]
    length, other_length = np.hypot(*a.T), np.hypot(*b.T)
    good = (length > PLACES_APART_MM) & (np.abs(length - other_length) < PLACES_ALIKE_MM)
    good &= (pairs.first[i] != pairs.first[j]) & (pairs.second[i] != pairs.second[j])
    turn = np.arctan2(a[good, 1], a[good, 0]) - np.arctan2(b[good, 1], b[good, 0])
    return turn, (pairs.rarity[i] * pairs.rarity[j])[good]


def _translations(one: Landmarks, other: Landmarks, pairs: Pairs, rotation: Array, settings: SearchSettings) -> Array:
    """Return the translations (h, 3), mm, that most pairs of axes and anchors vote for at a rotation (3, 3)."""
    shift = one.point[pairs.first] - other.point[pairs.second] @ rotation.T
    lines = one.is_axis[pairs.first]
    # a pipe that ends in joints on both sides is fixed by them: it tells the slide as an anchor does
    length = np.abs(one.half[pairs.first] - other.half[pairs.second])
    whole = lines & one.held[pairs.first].all(1) & other.held[pairs.second].all(1) & (2 * length <= settings.coarse)
    anchors = ~lines | whole
    rows = np.flatnonzero(lines)
    rows = rows[np.argsort(-pairs.rarity[rows], kind="stable")[: settings.rarest]]
    crossing, weight = _crossings(one.axis[pairs.first[rows]], shift[rows], pairs.rarity[rows], settings)
    return _voted(np.concatenate([shift[anchors], crossing]), np.concatenate([pairs.rarity[anchors], weight]), settings)


def _crossings(axis: Array, shift: Array, rarity: Array, settings: SearchSettings) -> tuple[Array, Array]:
    """Return the translations (h, 3), mm, and weights (h,) at which two pairs of axes coincide each.

    Each pair of axes leaves the translation a line, through its ``shift`` (r, 3) along its ``axis`` (r, 3); the middle of
    the common perpendicular of two such lines is what both pairs agree on.
    """
    i, j = np.triu_indices(len(axis), 1)
    cosine = np.einsum("hi,hi->h", axis[i], axis[j])
    steep = np.abs(cosine) <= np.cos(np.radians(settings.crossing_deg))
    i, j, cosine = i[steep], j[steep], cosine[steep]
    away = shift[j] - shift[i]
    along, other_along = np.einsum("hi,hi->h", away, axis[i]), np.einsum("hi,hi->h", away, axis[j])
    sine2 = 1 - cosine**2
    here = shift[i] + ((along - cosine * other_along) / sine2)[:, None] * axis[i]
    there = shift[j] + ((cosine * along - other_along) / sine2)[:, None] * axis[j]
    near = np.linalg.norm(there - here, axis=1) <= settings.skew
    weight = np.sqrt(rarity[i] * rarity[j]) * (1 + ORTHOGONAL_BONUS * sine2)
    return ((here + there) / 2)[near], weight[near]


def _voted(translation: Array, weight: Array, settings: SearchSettings) -> Array:
    """Return the means (h, 3) of translations that lie together, mm, those with most votes first."""
    if not len(translation):
        return translation
    _, cell = np.unique(np.round(translation / settings.cell), axis=0, return_inverse=True)
    cell = np.ravel(cell)
    votes = np.bincount(cell, weight)
    means = np.stack([np.bincount(cell, weight * coordinate) for coordinate in translation.T], axis=1) / votes[:, None]
    return np.asarray(means[np.argsort(-votes, kind="stable")[: settings.translations]])
