# SPDX-License-Identifier: LGPL-2.1-or-later
"""One click inside a pipe: which two edges in the picture it lies between.

The edge points around the click vote for the straight lines beside it, by direction, offset and by which side
is the brighter; two lines of about one direction with the click near the middle between them are a pipe's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap


@dataclass(frozen=True)
class InsideSettings:
    """Tunables; lengths in px.

    Edges up to ``reach`` from the click are looked at, in ``halves`` of stretches along the pipe around it (a pipe is
    longer than wide, but it may end); ``step_deg`` and ``largest_turn_deg`` are the directions' distance
    and how far an edge point's normal may be off; ``convergence_deg`` is between both edges of a pipe;
    ``least_support`` the part of the shortest stretch that a line must cover; ``most_lines`` on each side
    and ``most_pairs`` in all are compared. The weights are those of the logarithm of a pair's likelihood.
    """

    reach: float = 260.0
    halves: tuple[float, ...] = (40.0, 110.0)
    step_deg: float = 1.5
    largest_turn_deg: float = 9.0
    convergence_deg: float = 4.0
    least_support: float = 0.3
    nearest: float = 3.0
    most_lines: int = 120
    most_pairs: int = 5
    support_weight: float = 4.0
    middle_weight: float = 20.0
    polarity_weight: float = 0.2
    width_weight: float = 1.0


def edges_around(edges: EdgeMap, click: Array, settings: InsideSettings | None = None) -> list[Array]:
    """Return pairs of edges (2, 2, 2) in pixels that a click (2,) lies between, the likeliest first."""
    settings = settings or InsideSettings()
    votes = _votes(edges, click, settings)
    rows = _peaks(votes, settings)
    if not len(rows):
        return []
    polarity, direction, place = rows.T
    angle = np.radians(direction * settings.step_deg)
    offset = place - settings.reach
    support = votes[polarity, direction, place]
    left, right = np.flatnonzero(offset < 0), np.flatnonzero(offset > 0)
    one, other = (x.ravel() for x in np.meshgrid(left, right, indexing="ij"))
    turn = np.abs(angle[one] - angle[other])
    good = turn <= np.radians(settings.convergence_deg) + 1e-9
    one, other = one[good], other[good]
    if not len(one):
        return []
    width = offset[other] - offset[one]
    off_middle = (offset[other] + offset[one]) / width
    score = settings.support_weight * (support[one] + support[other]) - settings.middle_weight * off_middle**2
    score += np.where(polarity[one] != polarity[other], settings.polarity_weight, -settings.polarity_weight)
    score -= settings.width_weight * np.log(width)
    found: list[tuple[float, float, float]] = []
    pairs = []
    for row in np.argsort(-score, kind="stable"):
        this = (float(angle[one[row]]), float(offset[one[row]]), float(offset[other[row]]))
        if any(abs(this[1] - a) < 3 and abs(this[2] - b) < 3 and abs(np.sin(this[0] - t)) < 0.1 for t, a, b in found):
            continue
        found.append(this)
        half = settings.halves[0]
        pairs.append(np.array([_line(click, float(angle[k]), float(offset[k]), half) for k in (one[row], other[row])]))
        if len(pairs) == settings.most_pairs:
            break
    return pairs


def _line(click: Array, angle: float, offset: float, half: float) -> Array:
    """Return two points (2, 2) of the line at an offset from the click along a direction."""
    normal = np.array([np.cos(angle), np.sin(angle)])
    along = np.array([-normal[1], normal[0]])
    return np.asarray(click + offset * normal + np.array([[-half], [half]]) * along)


def _votes(edges: EdgeMap, click: Array, settings: InsideSettings) -> Array:
    """Return which part of a line is covered by edges (2, directions, places): brighter away from the click's side or towards it."""
    radius = float(np.hypot(settings.reach, max(settings.halves)))
    offset = edges.position - click
    near = np.flatnonzero((np.abs(offset) <= radius).all(axis=1))
    offset, normal = offset[near], edges.normal[near]
    directions, places = round(180 / settings.step_deg), 2 * round(settings.reach) + 1
    own = np.arctan2(normal[:, 1], normal[:, 0])
    votes = np.zeros((len(settings.halves), 2 * directions * places))
    turns = round(settings.largest_turn_deg / settings.step_deg)
    middle = np.rint(np.degrees(own) / settings.step_deg).astype(int)
    for turn in range(-turns, turns + 1):
        direction = (middle + turn) % directions
        angle = np.radians(direction * settings.step_deg)
        axis = np.column_stack([np.cos(angle), np.sin(angle)])
        across = np.einsum("ni,ni->n", offset, axis)
        along = offset[:, 1] * axis[:, 0] - offset[:, 0] * axis[:, 1]
        polarity = (np.einsum("ni,ni->n", normal, axis) > 0).astype(int)
        place = np.rint(across + settings.reach).astype(int)
        inside = (place >= 0) & (place < places)
        cell = (polarity * directions + direction) * places + place
        for scale, half in enumerate(settings.halves):
            which = inside & (np.abs(along) <= half)
            votes[scale] += np.bincount(cell[which], minlength=votes.shape[1])
    shares = votes.reshape(len(settings.halves), 2, directions, places) / (2 * np.array(settings.halves))[:, None, None, None]
    # a line seldom runs along the middle of one row of pixels
    shares[..., 1:-1] = shares[..., 1:-1] + (shares[..., :-2] + shares[..., 2:]) / 2
    shares = np.minimum(shares, 1.0)
    shares[0][shares[0] < settings.least_support] = 0.0
    return np.asarray(shares.mean(axis=0) * (shares[0] > 0))


def _peaks(votes: Array, settings: InsideSettings) -> NDArray[np.intp]:
    """Return the rows (k, 3) of votes that are largest among their neighbours, the strongest, none at the click itself."""
    from scipy.ndimage import maximum_filter

    largest = maximum_filter(votes, size=(1, 5, 5), mode=("nearest", "wrap", "nearest"))
    rows = np.argwhere((votes > 0) & (votes == largest))
    rows = rows[np.abs(rows[:, 2] - settings.reach) >= settings.nearest]
    order = np.argsort(-votes[tuple(rows.T)], kind="stable")
    return rows[order[: settings.most_lines]]
