# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two edges under the pointer become a pick: each is followed along its edge points as far as it goes on straight.

Whoever clicks on an edge has said which one is meant: nothing has to be guessed as with points near edges (``clicks``).
"""

from __future__ import annotations

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap
from pipeworkbench.recon.match import match
from pipeworkbench.recon.snapping import SnappedEdge

REACH_PX = 1.5  # from the continuation of an edge to the points that belong to it
LARGEST_GAP_PX = 12.0  # brackets and stains interrupt a pipe's edge
GROWTH = 0.6  # of its length that an edge is followed by at a time, to each side
LEAST_GROWTH_PX = 24.0
LONGEST_PX = 1200.0
CURVED_PX = 150.0  # from which length on the lens bends an edge
LEAST_OVERLAP = 0.3  # of what is seen of two edges; where less is shared, both are taken as they are
SHORTEST_PX = 40.0  # less than that does not say where an edge goes


def followed_edge(edges: EdgeMap, snapped: SnappedEdge) -> Array | None:
    """Return both ends (2, 2) in pixels of the straight edge that a pointer snapped to; None where it is a mere dot.

    Parameters
    ----------
    edges : EdgeMap
    snapped : SnappedEdge
    """
    thread = snapped.polyline
    if len(thread) < 3:
        return None
    while True:
        line = _Line(thread)
        low, high = line.span
        more = max(GROWTH * (high - low), LEAST_GROWTH_PX)
        along = np.arange(low - more, high + more, 1.0)
        position, normal = line.at(along)
        found = match(edges, position, normal, REACH_PX)
        seen = along[found.found]
        begin, end = _reached(seen, low, high)
        if end - begin < high - low + 2.0 or end - begin > LONGEST_PX:
            break
        inside = found.found & (along >= begin) & (along <= end)
        thread = position[inside] + found.distance[inside, None] * normal[inside]
    ends, _ = line.at(np.array(line.span))
    return ends if np.linalg.norm(ends[1] - ends[0]) >= SHORTEST_PX else None


def edges_of_clicks(edges: EdgeMap, points: Array, snapped: tuple[SnappedEdge | None, SnappedEdge | None]) -> Array | None:
    """Return two points on each of two edges (2, 2, 2) of a pipe that were clicked on, in pixels.

    An edge that cannot be followed, for it is faint or hidden there, is taken as parallel to the other one.

    Parameters
    ----------
    edges : EdgeMap
    points : (2, 2) array
        Where the clicks were, pixels.
    snapped : two of SnappedEdge or None
        The edges that they are on.

    Returns
    -------
    (2, 2, 2) array or None
        None where neither can be followed.
    """
    ends = [None if edge is None else followed_edge(edges, edge) for edge in snapped]
    if ends[0] is None and ends[1] is None:
        return None
    for missing in (0, 1):
        other = ends[1 - missing]
        if ends[missing] is None and other is not None:
            direction = (other[1] - other[0]) / np.linalg.norm(other[1] - other[0])
            offset = points[missing] - other[0]
            ends[missing] = other + offset - (offset @ direction) * direction
    return _where_both_are(np.array(ends))


def _where_both_are(both: Array) -> Array:
    """Return two edges (2, 2, 2) in one direction and, where they share enough, without what one has more: a neighbour's edge may go on in line."""
    directions = (both[:, 1] - both[:, 0]) / np.linalg.norm(both[:, 1] - both[:, 0], axis=1, keepdims=True)
    if directions[0] @ directions[1] < 0:
        both[1], directions[1] = both[1, ::-1].copy(), -directions[1]
    along = directions.sum(axis=0) / np.linalg.norm(directions.sum(axis=0))
    spans = both @ along
    low, high = spans[:, 0].max(), spans[:, 1].min()
    if high - low <= LEAST_OVERLAP * np.ptp(spans):
        return both
    steps = (np.array([low, high]) - spans[:, :1]) / (directions @ along)[:, None]
    return np.asarray(both[:, :1] + steps[..., None] * directions[:, None])


class _Line:
    """A straight edge through points (n, 2), bent a little as lenses do."""

    def __init__(self, points: Array) -> None:
        self._middle = points.mean(axis=0)
        _, _, axes = np.linalg.svd(points - self._middle, full_matrices=False)
        self._axes = axes
        along, aside = ((points - self._middle) @ axes.T).T
        self.span = (float(along.min()), float(along.max()))
        self._scale = max(self.span[1] - self.span[0], 1.0)
        degree = 2 if self._scale > CURVED_PX else 1
        self._curve = np.polyfit(along / self._scale, aside, degree)
        off = np.abs(aside - np.polyval(self._curve, along / self._scale))
        near = off <= max(3 * float(np.median(off)), 0.3)
        self._curve = np.polyfit(along[near] / self._scale, aside[near], degree)

    def at(self, along: Array) -> tuple[Array, Array]:
        """Return points and unit normals (n, 2) at places (n,) along it, px."""
        points = self._middle + along[:, None] * self._axes[0] + np.polyval(self._curve, along / self._scale)[:, None] * self._axes[1]
        slope = np.polyval(np.polyder(self._curve), along / self._scale) / self._scale
        normals = self._axes[1] - slope[:, None] * self._axes[0]
        return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _reached(seen: Array, low: float, high: float) -> tuple[float, float]:
    """Return how far places (n,), ascending, go on from a stretch without a gap that is too large."""
    after, before = seen[seen >= high], seen[seen <= low][::-1]
    return -_last(-before, -low), _last(after, high)


def _last(places: Array, start: float) -> float:
    """Return the last of ascending places (n,) before the first gap."""
    steps = np.diff(np.concatenate([[start], places]))
    gaps = np.flatnonzero(steps > LARGEST_GAP_PX)
    reached = places[: gaps[0]] if len(gaps) else places
    return float(reached[-1]) if len(reached) else start
