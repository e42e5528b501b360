# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fewer clicks: from one click near each edge of a pipe to the edges that they mean.

The straight edges around the clicks are looked for in the clicked image; where there are several near a click
(stains, seams, highlights), the other images decide between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap
from pipeworkbench.recon.inside import edges_around
from pipeworkbench.recon.lines import INTERRUPTED, LineSegments, hough_segments
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.views import View

REGION_PX = 500  # around the clicks: a pipe as wide as that is clicked at its edges
NEAR_PX = 8.0  # from a click near an edge to that edge
BESIDE = 0.25  # parts of its length that a segment may end before the click
LEAST_OVERLAP = 0.3  # of what is seen of two edges; where less is shared, their lines are extended
LARGEST_GAP = 1.0  # between two edges along the pipe, in lengths of the shorter
LARGEST_ANGLE_DEG = 12.0  # between both edges of a pipe
EDGES_EACH = 3  # that one click can mean
ALTERNATIVES = 3


def complete_picks(view: View, pick: PipePick) -> tuple[PipePick, ...]:
    """Return picks with both edges that a pick can mean, the likeliest first.

    Parameters
    ----------
    view : View
        The image that was clicked in.
    pick : PipePick
        With both edges (returned as it is), one point near each edge or one between them.

    Returns
    -------
    tuple of PipePick
        Empty where there are no such edges.
    """
    if pick.edges.shape[1] == 2:
        return (pick,)
    clicks = pick.edges[:, 0]
    if len(clicks) == 1:
        return tuple(replace(pick, edges=edges) for edges in edges_around(view.edges, clicks[0]))
    segments = _segments_around(view.edges, clicks)
    if not len(segments):
        return ()
    sides = [_near(segments, click) for click in clicks]
    pairs = [edges for one in sides[0] for other in sides[1] if (edges := _edges_of(segments, one, other)) is not None]
    pairs += [_parallel(segments, row, click) for row, click in _alone(sides, clicks)]
    return tuple(replace(pick, edges=edges) for edges in pairs[:ALTERNATIVES])


def _segments_around(edges: EdgeMap, clicks: Array) -> LineSegments:
    """Return the straight edges around clicks (m, 2), in pixels of the whole image."""
    height, width = edges.index.shape
    low = np.maximum(np.floor(clicks.min(axis=0)).astype(int) - REGION_PX, 0)
    high = np.minimum(np.ceil(clicks.max(axis=0)).astype(int) + REGION_PX + 1, (width, height))
    part = _cropped(edges, low, high)
    found = hough_segments(part, None, INTERRUPTED)
    return replace(found, ends=found.ends + low, centre=found.centre + low)


def _cropped(edges: EdgeMap, low: NDArray[np.intp], high: NDArray[np.intp]) -> EdgeMap:
    """Return the edge points in a part of the image, in that part's pixels."""
    inside = ((edges.pixel >= low) & (edges.pixel < high)).all(axis=1)
    renumbered = np.full(len(edges) + 1, -1, np.int32)
    renumbered[:-1][inside] = np.arange(inside.sum())
    index = renumbered[edges.index[low[1] : high[1], low[0] : high[0]]]  # -1 stays -1
    return EdgeMap(
        edges.position[inside] - low,
        edges.normal[inside],
        edges.gradient[inside],
        edges.contrast[inside],
        edges.blur[inside],
        edges.sigma[inside],
        edges.smoothing[inside],
        (edges.pixel[inside] - low).astype(np.int32),
        index,
    )


def _distances(segments: LineSegments, click: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the signed distances (k,) of a click along the segments' normals, and whether it lies beside them."""
    offset = click - segments.ends[:, 0]
    along = np.einsum("ki,ki->k", offset, segments.direction)
    beside = (along > -BESIDE * segments.length) & (along < (1 + BESIDE) * segments.length)
    return np.einsum("ki,ki->k", click - segments.centre, segments.normal), beside


def _alone(sides: Sequence[Sequence[int]], clicks: Array) -> list[tuple[int, Array]]:
    """Return the segment of the one side and the click of the other where only one side has any."""
    if bool(sides[0]) == bool(sides[1]):
        return []
    found, missing = (0, 1) if sides[0] else (1, 0)
    return [(row, clicks[missing]) for row in sides[found]]


def _parallel(segments: LineSegments, row: int, click: Array) -> Array:
    """Return a segment and its parallel through a click (2, 2, 2): where an edge is too faint for a line."""
    ends = segments.ends[row]
    normal = segments.normal[row]
    return np.array([ends, ends + ((click - segments.centre[row]) @ normal) * normal])


def _near(segments: LineSegments, click: Array) -> list[int]:
    """Return the segments that a click near an edge can mean, nearest first."""
    distance, beside = _distances(segments, click)
    rows = np.flatnonzero(beside & (np.abs(distance) <= NEAR_PX))
    return [int(row) for row in rows[np.argsort(np.abs(distance[rows]))]][:EDGES_EACH]


def _edges_of(segments: LineSegments, one: int, other: int) -> Array | None:
    """Return two points on each of two edges (2, 2, 2) where both are, None where they are not the sides of one thing."""
    first, second = segments.direction[one], segments.direction[other]
    second = second * np.sign(first @ second)
    if one == other or first @ second < np.cos(np.radians(LARGEST_ANGLE_DEG)):
        return None
    along = (first + second) / np.linalg.norm(first + second)
    spans = np.sort(np.einsum("kei,i->ke", segments.ends[[one, other]], along), axis=1)
    overlap = spans[:, 1].min() - spans[:, 0].max()
    if overlap < -LARGEST_GAP * (spans[:, 1] - spans[:, 0]).min():
        return None
    # where both are seen, or all that is seen of either
    low, high = (spans[:, 0].max(), spans[:, 1].min()) if overlap > LEAST_OVERLAP * np.ptp(spans) else (spans.min(), spans.max())
    return np.array([_points_at(segments.centre[row], segments.direction[row], along, (low, high)) for row in (one, other)])


def _points_at(centre: Array, direction: Array, along: Array, places: Sequence[float]) -> Array:
    """Return the points (2, 2) of a line whose components along a direction are given."""
    steps = (np.asarray(places) - centre @ along) / (direction @ along)
    return centre + steps[:, None] * direction
