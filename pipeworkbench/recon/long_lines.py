# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long straight edges in clutter: a Hough transform that knows the edges' directions, and what is unlikely by chance.

The edges of pipes are long but interrupted: where brick or shade behind is as bright as the pipe, there is no edge.
Between them rust and stains have short edges in all directions. So every edge point votes only for lines along its
own direction (Ballard, Pattern Recognition 13(2), 1981), after the distortion is taken off, over the whole
image, and a line counts by how unlikely its points are by chance, given how dense edges of like direction are
around them (as Desolneux, Moisan, Morel, IJCV 40(1), 2000).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array, Interior
from pipeworkbench.recon.edges import EdgeMap
from pipeworkbench.recon.lines import INTERRUPTED, MOST_SHARED, LineSegments, fit_points, fit_segments, longest_first, owned, without_distortion

BLOCK_PX = 48  # in which edges are counted for their density
DIRECTIONS = 12  # bins of half a circle for the same
LEAST_CHANCE = 0.05  # expected points: an empty neighbourhood is not known to stay empty
LEAST_OWN = 0.3  # of a line's points; if more are a likelier line's it is the same, before lines are fitted
PEAK_REACH = (2, 12)  # bins of offset: within the first a peak is the highest, within the second it must stand out


@dataclass(frozen=True)
class LongLineSettings:
    """Tunables; lengths in px.

    ``angle_step_deg`` of the transform's bins, whose other side is 1 px; ``spread_deg`` the most between an
    edge's and its line's direction; a peak needs ``votes`` and ``peak_significance``. A line ends
    at gaps of more than ``gap`` and needs ``least_length`` and ``significance`` (logarithm of how
    much likelier its points are than by chance). ``width`` is what counts as on a line in the transform.
    """

    angle_step_deg: float = 0.4
    spread_deg: float = 7.0
    votes: float = 20.0
    peak_significance: float = 9.0
    gap: float = 10.0
    least_length: float = 25.0
    significance: float = 18.0
    width: float = 2.5


@dataclass(frozen=True, eq=False)
class _Lines:
    """Edge points on lines of the transform, line by line and along them: rows of edge and line (m,), place along it in px (m,)."""

    edge: NDArray[np.intp]
    line: NDArray[np.intp]
    along: Array


def long_lines(edges: EdgeMap, interior: Interior | None = None, settings: LongLineSettings | None = None) -> LineSegments:
    """Find long straight edges, interrupted or not.

    Parameters
    ----------
    edges : EdgeMap
    interior : Interior, optional
        With it everything that is returned is in pixels of an image without distortion.
    settings : LongLineSettings, optional
    """
    settings = settings or LongLineSettings()
    if not len(edges):
        return fit_segments(edges, np.zeros((0, 2, 2)))
    position, normal = edges.position, edges.normal
    if interior is not None:
        position, normal = without_distortion(position, normal, interior)
    angle = np.arctan2(normal[:, 1], normal[:, 0])
    # how many points of like direction a px of line meets by chance
    chance = _density(position, angle) * settings.width * min(2 * settings.spread_deg / (3 * 180 / DIRECTIONS), 1)
    lines = _transformed(position, angle, settings)
    segment, edge, likely, by_chance = _segments(lines, chance, settings)
    # lines are found several times: the sooner doubles go, the less there is to fit
    own = owned(segment, edge, likely)[1]
    single = own >= LEAST_OWN * np.bincount(segment, minlength=len(likely))
    kept = single[segment]
    segment, edge, by_chance = (np.cumsum(single) - 1)[segment[kept]], edge[kept], by_chance[single]
    fitted = fit_points(position, normal, edges, segment, edge, len(by_chance), INTERRUPTED)
    # the fit takes points within its own range
    by_chance = by_chance * 2 * INTERRUPTED.fit_range / settings.width
    keep, own = owned(fitted.segment, fitted.edge, significance(fitted.support, by_chance * fitted.length))
    good = (own >= MOST_SHARED * fitted.support) & (fitted.length >= settings.least_length)
    good &= significance(own, by_chance * fitted.length) >= settings.significance
    keep = keep[good[fitted.segment[keep]]]
    fitted = fit_points(position, normal, edges, fitted.segment[keep], fitted.edge[keep], len(fitted), INTERRUPTED)
    return longest_first(fitted, good & (fitted.support > 2) & (fitted.length >= settings.least_length))


def significance(points: NDArray[np.generic], expected: Array) -> Array:
    """Return the logarithm of how much likelier numbers of points are than by chance (Poisson), 0 where there are fewer than expected."""
    k, mu = np.maximum(np.asarray(points, float), 1e-9), np.maximum(expected, LEAST_CHANCE)
    return np.where(k > mu, k * np.log(k / mu) - (k - mu), 0.0)


def _density(position: Array, angle: Array) -> Array:
    """Return the number of edges of like direction (three bins of it) per px^2 around each."""
    import cv2

    block = ((position - position.min(axis=0, initial=0)) / BLOCK_PX).astype(np.intp)
    columns, rows = block.max(axis=0, initial=0) + 1
    direction = np.floor(angle % np.pi / np.pi * DIRECTIONS).astype(np.intp) % DIRECTIONS
    count = np.bincount((block[:, 1] * columns + block[:, 0]) * DIRECTIONS + direction, minlength=int(rows * columns * DIRECTIONS))
    count = count.reshape(rows, columns, DIRECTIONS).astype(float)
    count = np.roll(count, 1, axis=2) + count + np.roll(count, -1, axis=2)
    return np.asarray(cv2.blur(count, (3, 3)))[block[:, 1], block[:, 0], direction] / BLOCK_PX**2


def _transformed(position: Array, angle: Array, settings: LongLineSettings) -> _Lines:
    """Return the lines that most edges of their direction vote for, with these edges."""
    import cv2

    steps = round(180 / settings.angle_step_deg)
    step, turns = np.pi / steps, round(settings.spread_deg / settings.angle_step_deg)
    # single precision is enough for bins of a pixel and halves the memory that is read
    u, v = (position - position.mean(axis=0)).astype(np.float32).T.copy()
    middle = int(np.hypot(u, v).max(initial=0)) + PEAK_REACH[1] + 1
    offsets = 2 * middle + 1
    cosine, sine = (f(np.arange(steps) * step).astype(np.float32) for f in (np.cos, np.sin))
    own = np.rint(angle / step).astype(np.int32)
    bins = np.empty((2 * turns + 1, len(u)), np.int32)
    for row, turn in enumerate(range(-turns, turns + 1)):
        direction = (own + turn) % steps
        offset = u * cosine[direction] + v * sine[direction] + np.float32(middle)
        bins[row] = direction * offsets + offset.astype(np.int32)
    votes = np.bincount(bins.ravel(), minlength=steps * offsets).astype(np.float32).reshape(steps, offsets)
    votes = cv2.sepFilter2D(votes, -1, np.array([0.5, 1.0, 0.5]), np.ones(1))
    around = 2 * PEAK_REACH[0] + 1
    peak = (votes >= cv2.dilate(votes, np.ones((around, around), np.uint8))) & (votes >= settings.votes)
    # texture votes for all lines through it
    peak &= significance(votes, np.asarray(cv2.blur(votes, (2 * PEAK_REACH[1] + 1, around)), float)) >= settings.peak_significance
    peak[:, [0, -1]] = False
    direction, offset = np.nonzero(peak)
    order = np.argsort(votes[direction, offset], kind="stable")  # where peaks meet the highest is written last
    direction, offset = direction[order], offset[order]
    label = np.full((steps, offsets), -1, np.int32)
    for beside in (-1, 1, 0):
        label[direction, offset + beside] = np.arange(len(order))
    line = label.reshape(-1).take(bins.ravel())
    voted = np.flatnonzero(line >= 0)
    line, edge = line[voted].astype(np.intp), voted % max(len(u), 1)
    along = v[edge] * cosine[direction[line]] - u[edge] * sine[direction[line]]
    order = np.lexsort((along, line))
    return _Lines(edge[order], line[order], along[order].astype(float))


def _segments(lines: _Lines, chance: Array, settings: LongLineSettings) -> tuple[NDArray[np.intp], NDArray[np.intp], Array, Array]:
    """Return segments and edges (m,) that belong together; of each segment (k,) its significance and the points per px expected by chance."""
    breaks = np.ones(len(lines.edge), bool)
    breaks[1:] = (lines.line[1:] != lines.line[:-1]) | (np.diff(lines.along) > settings.gap)
    first = np.flatnonzero(breaks)
    last = np.append(first[1:], len(breaks))[: len(first)] - 1
    piece, points = np.cumsum(breaks) - 1, last - first + 1
    length = lines.along[last] - lines.along[first] + 1
    chance = np.bincount(piece, chance[lines.edge]) / points
    likely = significance(points, chance * length)
    good = (length >= settings.least_length) & (likely >= settings.significance)
    kept = good[piece]
    return (np.cumsum(good) - 1)[piece[kept]], lines.edge[kept], likely[good], chance[good]
