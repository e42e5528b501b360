# SPDX-License-Identifier: LGPL-2.1-or-later
"""The edge under a pointer: the nearest subpixel edge point, and the piece of its thread on both sides.

The edge map's own pixel index is the grid in which neighbours are looked up, so that a look-up costs the same
in an image of any size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap


@dataclass(frozen=True)
class SnapSettings:
    """Tunables of snapping; lengths in px of the image.

    A thread is followed for ``reach`` to each side; its next point lies ahead by no less than ``least_step`` and no more than
    ``largest_step``, aside by no more than ``aside`` of the way, and its normal turns by no more than ``largest_turn_deg``.
    """

    reach: float = 40.0
    least_step: float = 0.3
    largest_step: float = 2.6
    aside: float = 0.7
    largest_turn_deg: float = 30.0


@dataclass(frozen=True, eq=False)
class SnappedEdge:
    """An edge near a point.

    Attributes
    ----------
    point : (2,) array
        The point's foot on the edge, pixels.
    direction : (2,) array
        Unit vector along the edge; the brighter side is on its right as seen in the image (v down).
    polyline : (n, 2) array
        The subpixel points of the edge's thread around the foot, in the order of ``direction``.
    distance : float
        From the point to the foot, px.
    row : int
        The nearest edge point's row in the edge map.
    sigma : float
        Expected standard deviation of the edge's position along its normal, px.
    """

    point: Array
    direction: Array
    polyline: Array
    distance: float
    row: int
    sigma: float


def nearest_edge(edge_map: EdgeMap, point: tuple[float, float] | Array, radius: float, settings: SnapSettings | None = None) -> SnappedEdge | None:
    """Return the edge that is nearest to a point, None where there is none within the radius.

    Parameters
    ----------
    edge_map : EdgeMap
    point : (u, v)
        Pixels; may lie outside the image.
    radius : float
        In px.
    settings : SnapSettings, optional
    """
    settings = settings or SnapSettings()
    pointer = np.asarray(point, float)
    rows = _rows_around(edge_map, pointer, radius + 1.0)  # the index says where a point was found, which is within a pixel of it
    if not len(rows):
        return None
    distance = np.linalg.norm(edge_map.position[rows] - pointer, axis=1)
    seed = int(rows[distance.argmin()])
    if distance.min() > radius:
        return None
    tangent = _tangents(edge_map.normal[seed])
    # half a step to each side belongs to this edge point
    along = np.clip((pointer - edge_map.position[seed]) @ tangent, -0.5, 0.5)
    foot = edge_map.position[seed] + along * tangent
    polyline = _thread(edge_map, seed, settings)
    return SnappedEdge(foot, tangent, polyline, float(np.linalg.norm(pointer - foot)), seed, float(edge_map.sigma[seed]))


def _rows_around(edge_map: EdgeMap, middle: Array, reach: float) -> NDArray[np.int32]:
    """Return the rows of the edge points found in a square around a point, each once."""
    height, width = edge_map.index.shape
    left, top = np.maximum(np.floor(middle - reach).astype(int), 0)
    right, bottom = np.minimum(np.ceil(middle + reach).astype(int) + 1, (width, height))
    if left >= right or top >= bottom:
        return np.zeros(0, np.int32)
    rows = np.unique(edge_map.index[top:bottom, left:right])
    return rows[rows >= 0]


def _tangents(normals: Array) -> Array:
    """Return normals (..., 2) turned so that they have the brighter side on their right, v down."""
    return np.stack([normals[..., 1], -normals[..., 0]], axis=-1)


def _thread(edge_map: EdgeMap, seed: int, settings: SnapSettings) -> Array:
    """Return the points (n, 2) of the thread through an edge point, in the direction of its tangent."""
    start = edge_map.position[seed]
    rows = _rows_around(edge_map, start, settings.reach)
    points, tangents = edge_map.position[rows], _tangents(edge_map.normal[rows])
    first = int(np.searchsorted(rows, seed))
    backwards = _followed(points, -tangents, first, settings)
    forwards = _followed(points, tangents, first, settings)
    return points[[*reversed(backwards), first, *forwards]]


def _followed(points: Array, headings: Array, first: int, settings: SnapSettings) -> list[int]:
    """Return the rows of points (n, 2) that follow one another from the first on, which itself is not among them."""
    least_cosine = np.cos(np.radians(settings.largest_turn_deg))
    chain: list[int] = []
    here, way = first, 0.0
    while way < settings.reach:
        offset = points - points[here]
        heading = headings[here]
        ahead = offset @ heading
        aside = np.abs(offset[:, 0] * heading[1] - offset[:, 1] * heading[0])
        fits = (ahead >= settings.least_step) & (ahead <= settings.largest_step) & (aside <= settings.aside * ahead)
        fits &= headings @ heading >= least_cosine
        candidates = np.flatnonzero(fits)
        if not len(candidates):
            break
        length = np.hypot(ahead[candidates], aside[candidates])
        here = int(candidates[length.argmin()])
        if here in chain or here == first:  # a small circle closes
            break
        way += float(length.min())
        chain.append(here)
    return chain
