# SPDX-License-Identifier: LGPL-2.1-or-later
"""Matching a contour to image edges: distances along the contour's normals and Eq. 4's quality."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap

STEP_PX = 1.0  # the index answers for the pixels beside an edge too: no edge slips through between look-ups
CHUNK = 4096  # samples at a time: their look-ups stay in the processor's cache
LATERAL_PX = 1.0  # an edge point further than this beside the normal belongs to another sample
LEAST_COSINE = np.cos(np.radians(20))  # largest angle between the contour's and an edge's normal


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


def edges_along_normals(edges: EdgeMap, positions: Array, normals: Array, search_range: float) -> tuple[NDArray[np.intp], NDArray[np.int32], Array]:
    """Return all edges of like direction that lie on the samples' normals within a range.

    Parameters
    ----------
    edges : EdgeMap
    positions, normals : (n, 2) arrays
        Samples of a contour in pixels and their unit normals; samples with NaN find nothing.
    search_range : float
        The paper's b in pixels, to each side.

    Returns
    -------
    sample, edge, distance : (m,) arrays
        Rows of samples and edges that belong together and the distance in px along the normal; an
        edge that two look-ups of one sample hit appears twice.
    """
    parts = [_edges_along_normals(edges, positions, normals, search_range, start) for start in range(0, max(len(positions), 1), CHUNK)]
    sample, edge, distance = (np.concatenate(part) for part in zip(*parts, strict=True))
    return sample, edge, distance


def _edges_along_normals(
    edges: EdgeMap, positions: Array, normals: Array, search_range: float, first: int
) -> tuple[NDArray[np.intp], NDArray[np.int32], Array]:
    positions, normals = positions[first : first + CHUNK], normals[first : first + CHUNK]
    reach = np.arange(0.0, search_range + STEP_PX, STEP_PX)
    steps = np.concatenate([-reach[:0:-1], reach])
    height, width = edges.index.shape
    known = (np.isfinite(positions) & np.isfinite(normals)).all(axis=1, keepdims=True)
    start, normals = np.where(known, positions, -1e6), np.where(known, normals, 0.0)
    u = np.rint(start[:, :1] + normals[:, :1] * steps).astype(np.int32)
    v = np.rint(start[:, 1:] + normals[:, 1:] * steps).astype(np.int32)
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    hit = np.where(inside, edges.index[np.clip(v, 0, height - 1), np.clip(u, 0, width - 1)], -1)

    # from here on only the few look-ups that hit an edge
    sample, step = np.nonzero(hit >= 0)
    edge = hit[sample, step]
    offset = edges.position[edge] - start[sample]
    normal = normals[sample]
    distance = np.einsum("ij,ij->i", offset, normal)
    lateral = np.abs(offset[:, 0] * normal[:, 1] - offset[:, 1] * normal[:, 0])
    cosine = np.einsum("ij,ij->i", edges.normal[edge], normal)
    good = (lateral <= LATERAL_PX) & (np.abs(distance) <= search_range) & (np.abs(cosine) >= LEAST_COSINE)
    return sample[good] + first, edge[good], distance[good]


def match(edges: EdgeMap, positions: Array, normals: Array, search_range: float, polarity: Array | None = None) -> Match:
    """Search from each sample along its normal, both ways, for the nearest edge of like direction.

    Parameters
    ----------
    edges, positions, normals, search_range
        As for :func:`edges_along_normals`.
    polarity : (n,) array, optional
        +1 where the brighter side must lie along the normal, -1 against it, 0 where either will do.
    """
    sample, edge, distance = edges_along_normals(edges, positions, normals, search_range)
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


def quality(distances: Array, search_range: float, axis: int = -1) -> Array:
    """Return Eq. 4's q: the RMS of the distances, where a missing edge (NaN) counts as ``search_range``."""
    filled = np.where(np.isnan(distances), search_range, distances)
    return np.asarray(np.sqrt(np.mean(filled**2, axis=axis)))
