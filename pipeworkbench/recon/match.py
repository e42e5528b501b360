# SPDX-License-Identifier: LGPL-2.1-or-later
"""Matching contours to image edges: distances along the contours' normals and Eq. 4's quality.

One call takes all samples of all contours of an image; a search is look-ups in the edge map's index.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import DIRECTIONS, EdgeMap, coarse_directions

STEP_PX = 1.0  # the index answers for the pixels beside an edge too: no edge slips through between look-ups
LOOK_UPS = 32768  # at a time: they stay in the processor's cache
LATERAL_PX = 1.0  # an edge point further than this beside the normal belongs to another sample
LARGEST_ANGLE = float(np.radians(20))  # between the contour's and an edge's normal


@dataclass(frozen=True, eq=False)
class Match:
    """Nearest edge point of each sample.

    distance (n,) in px along the sample's normal, NaN where there is none; edge (n,) its row, -1 for none.
    """

    distance: Array
    edge: NDArray[np.int32]

    @property
    def found(self) -> NDArray[np.bool_]:
        """Which samples (n,) have an edge point."""
        return self.edge >= 0


def edges_along_normals(
    edges: EdgeMap, positions: Array, normals: Array, search_range: float, largest_angle: float | None = LARGEST_ANGLE
) -> tuple[NDArray[np.intp], NDArray[np.int32], Array]:
    """Return all edges of like direction that lie on the samples' normals within a range.

    Parameters
    ----------
    edges : EdgeMap
    positions, normals : (n, 2) arrays
        Samples of a contour in pixels and their unit normals; samples with NaN find nothing.
    search_range : float
        The paper's b in pixels, to each side.
    largest_angle : float, optional
        Between a sample's and an edge's normal, of either polarity (rad); None takes edges of any direction.

    Returns
    -------
    sample, edge, distance : (m,) arrays
        Rows of samples and edges that belong together and the distance in px along the normal; an
        edge that two look-ups of one sample hit appears twice. Samples ascend.
    """
    least_cosine = -1.0 if largest_angle is None else float(np.cos(largest_angle))
    reach = np.arange(0.0, search_range + STEP_PX, STEP_PX)
    steps = np.concatenate([-reach[:0:-1], reach]).astype(np.float32)
    chunk = LOOK_UPS // len(steps)
    parts = [
        _edges_along_normals(edges, positions[first : first + chunk], normals[first : first + chunk], steps, search_range, least_cosine)
        for first in range(0, max(len(positions), 1), chunk)
    ]
    sample, edge, distance = (np.concatenate(part) for part in zip(*parts, strict=True))
    return np.repeat(np.arange(len(parts)) * chunk, [len(part[0]) for part in parts]) + sample, edge, distance


def _edges_along_normals(
    edges: EdgeMap, positions: Array, normals: Array, steps: NDArray[np.float32], search_range: float, least_cosine: float
) -> tuple[NDArray[np.intp], NDArray[np.int32], Array]:
    columns = np.concatenate([positions, normals], axis=1).T.copy()
    known = np.flatnonzero(np.isfinite(columns.sum(axis=0)))
    if len(known) < len(positions):
        columns = columns[:, known]
    u, v, along_u, along_v = columns
    height, width = edges.index.shape
    # single precision decides about whole pixels only
    flat = _pixels_along(v, along_v, steps, height) * np.intp(width)
    flat += _pixels_along(u, along_u, steps, width)
    direction = edges.directions.reshape(-1).take(flat, mode="clip")
    hit = (direction & np.uint8(1)) == 0
    tolerance = 2 * (int(np.ceil(np.arccos(least_cosine) * DIRECTIONS / np.pi)) + 1)  # rounding included
    if tolerance < DIRECTIONS:
        direction -= (coarse_directions(along_u, along_v) - np.uint8(tolerance))[:, None]
        hit &= direction <= np.uint8(2 * tolerance)

    # from here on only the few look-ups that hit an edge
    found = np.flatnonzero(hit)
    sample = found // len(steps)
    edge = edges.index.reshape(-1).take(flat.reshape(-1).take(found))
    position, normal_u, normal_v = edges.position.take(edge, axis=0), along_u.take(sample), along_v.take(sample)
    offset_u, offset_v = position[:, 0] - u.take(sample), position[:, 1] - v.take(sample)
    distance = offset_u * normal_u + offset_v * normal_v
    lateral = np.abs(offset_u * normal_v - offset_v * normal_u)
    good = (lateral <= LATERAL_PX) & (np.abs(distance) <= search_range)
    if least_cosine > 0:
        normal = edges.normal.take(edge, axis=0)
        good &= np.abs(normal[:, 0] * normal_u + normal[:, 1] * normal_v) >= least_cosine
    return known[sample[good]], edge[good], distance[good]


def _pixels_along(start: Array, along: Array, steps: NDArray[np.float32], size: int) -> NDArray[np.int32]:
    """Return the pixels' rows or columns (n, m) some steps (m,) from ``start`` (n,), at the border (of ``size``) where they are not in the image.

    What is found in a wrong pixel there is too far from the sample to count.
    """
    pixel = along.astype(np.float32)[:, None] * steps
    pixel += (start + 0.5).astype(np.float32)[:, None]
    if start.min(initial=size) + steps[0] < 0 or start.max(initial=0) + steps[-1] > size - 1:
        np.maximum(pixel, np.float32(0), out=pixel)
        np.minimum(pixel, np.float32(size - 1), out=pixel)
    return pixel.astype(np.int32)


def match(
    edges: EdgeMap,
    positions: Array,
    normals: Array,
    search_range: float,
    polarity: Array | None = None,
    largest_angle: float | None = LARGEST_ANGLE,
) -> Match:
    """Search from each sample along its normal, both ways, for the nearest edge.

    Parameters
    ----------
    edges, positions, normals, search_range, largest_angle
        As for :func:`edges_along_normals`.
    polarity : (n,) array, optional
        +1 where the brighter side must lie along the normal, -1 against it, 0 where either will do.
    """
    sample, edge, distance = edges_along_normals(edges, positions, normals, search_range, largest_angle)
    if polarity is not None:
        good = np.einsum("ij,ij->i", edges.normal[edge], normals[sample]) * polarity[sample] >= 0
        sample, edge, distance = sample[good], edge[good], distance[good]
    nearest = np.full(len(positions), np.nan)
    row = np.full(len(positions), -1, np.int32)
    best = nearest_rows(sample, distance)
    nearest[sample[best]] = distance[best]
    row[sample[best]] = edge[best]
    return Match(nearest, row)


def nearest_rows(sample: NDArray[np.intp], distance: Array) -> NDArray[np.intp]:
    """Return one row for each sample of what :func:`edges_along_normals` gives, samples (m,) ascending and distances (m,): its nearest edge's."""
    if not len(sample):
        return np.empty(0, np.intp)
    start = np.flatnonzero(np.diff(sample, prepend=-1))
    off = np.abs(distance)
    least = np.minimum.reduceat(off, start)
    rows = np.flatnonzero(off == np.repeat(least, np.diff(start, append=len(sample))))
    return rows[np.diff(sample[rows], append=-1) != 0]


def quality(distances: Array, search_range: float, axis: int = -1, missing: Literal["range", "half"] = "range") -> Array:
    """Return Eq. 4's q in px: the root mean square of the distances.

    Parameters
    ----------
    distances : array
        Signed, px, NaN where no edge was found.
    search_range : float
        The paper's b, px.
    axis : int
    missing : "range" or "half"
        What a missing edge counts as: the paper's b or b / 2.
    """
    filled = np.where(np.isnan(distances), search_range if missing == "range" else search_range / 2, distances)
    return np.asarray(np.sqrt(np.mean(filled**2, axis=axis)))


def robust_quality(distances: Array, search_range: float, axis: int = -1, missing: Literal["range", "half"] = "range", scale: float = 1.0) -> Array:
    """Return q with a bounded influence of far edges: the root of the mean of Geman and McClure's loss, in px.

    A distance d counts as d^2 / (1 + (d / s)^2): near edges as in Eq. 4, far ones, which are somebody
    else's, at most ``scale`` s each; a missing one as a far one does. So some samples that meet
    clutter do not hide that all others fit.

    Parameters
    ----------
    distances, search_range, axis, missing
        As for :func:`quality`.
    scale : float
        The distance in px that counts half.
    """
    filled = np.where(np.isnan(distances), search_range if missing == "range" else search_range / 2, distances)
    return np.asarray(np.sqrt(np.mean(filled**2 / (1 + (filled / scale) ** 2), axis=axis)))
