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
from pipeworkbench.recon.edges import EdgeMap

STEP_PX = 1.0  # the index answers for the pixels beside an edge too: no edge slips through between look-ups
CHUNK = 2048  # samples at a time: their look-ups stay in the processor's cache
LATERAL_PX = 1.0  # an edge point further than this beside the normal belongs to another sample
LARGEST_ANGLE = float(np.radians(20))  # between the contour's and an edge's normal
OUTSIDE = -1_000_000.0  # px; where samples that are not in the image are put


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
        edge that two look-ups of one sample hit appears twice.
    """
    least_cosine = -1.0 if largest_angle is None else float(np.cos(largest_angle))
    parts = [_edges_along_normals(edges, positions, normals, search_range, least_cosine, start) for start in range(0, max(len(positions), 1), CHUNK)]
    sample, edge, distance = (np.concatenate(part) for part in zip(*parts, strict=True))
    return sample, edge, distance


def _edges_along_normals(
    edges: EdgeMap, positions: Array, normals: Array, search_range: float, least_cosine: float, first: int
) -> tuple[NDArray[np.intp], NDArray[np.int32], Array]:
    positions, normals = positions[first : first + CHUNK], normals[first : first + CHUNK]
    reach = np.arange(0.0, search_range + STEP_PX, STEP_PX)
    steps = np.concatenate([-reach[:0:-1], reach]).astype(np.float32)
    height, width = edges.index.shape
    known = (np.isfinite(positions) & np.isfinite(normals)).all(axis=1, keepdims=True)
    start, normals = np.where(known, positions, OUTSIDE), np.where(known, normals, 0.0)
    # single precision decides about whole pixels only
    half, along = (start + 0.5).astype(np.float32), normals.astype(np.float32)
    u = np.floor(half[:, :1] + along[:, :1] * steps).astype(np.int32)
    v = np.floor(half[:, 1:] + along[:, 1:] * steps).astype(np.int32)
    # a negative number is a large unsigned one: one comparison for both ends
    inside = (u.view(np.uint32) < width) & (v.view(np.uint32) < height)
    flat = np.where(inside, v * np.int32(width) + u, 0) if height * width < 2**31 else np.where(inside, v.astype(np.int64) * width + u, 0)
    hit = edges.index.reshape(-1).take(flat)
    hit[~inside] = -1

    # from here on only the few look-ups that hit an edge
    found = np.flatnonzero(hit >= 0)
    sample = found // len(steps)
    edge = hit.reshape(-1)[found]
    offset = edges.position.take(edge, axis=0) - start.take(sample, axis=0)
    normal = normals.take(sample, axis=0)
    distance = offset[:, 0] * normal[:, 0] + offset[:, 1] * normal[:, 1]
    lateral = np.abs(offset[:, 0] * normal[:, 1] - offset[:, 1] * normal[:, 0])
    good = (lateral <= LATERAL_PX) & (np.abs(distance) <= search_range)
    if least_cosine > 0:
        good &= np.abs(np.einsum("ij,ij->i", edges.normal.take(edge, axis=0), normal)) >= least_cosine
    return sample[good] + first, edge[good], distance[good]


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
    # write the far ones first: the nearest of each sample stays
    order = np.argsort(-np.abs(distance), kind="stable")
    nearest[sample[order]] = distance[order]
    row[sample[order]] = edge[order]
    return Match(nearest, row)


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
