# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which directions edges have near each pixel: one look-up tells whether a sample of a contour has an edge.

Where the first question is only whether there is any edge at all, for millions of samples, searching along
normals (match.py) takes too long. Here each pixel holds a bit per direction of the edges around it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap

BINS = 16  # of direction, a bit each
BIN = 2 * np.pi / BINS
TOLERANCE = np.radians(14)  # with the bins' own width, about the 20 deg of match.py


@dataclass(frozen=True, eq=False)
class EdgeRaster:
    """The directions of the edges near each pixel: ``bits`` (height, width), bit i for normals in the i-th part of the circle."""

    bits: NDArray[np.uint16]

    def near(self, u: NDArray[np.float32], v: NDArray[np.float32]) -> NDArray[np.uint16]:
        """Return the bits at pixels (u, v) of any one shape, none outside the image or where they are NaN."""
        height, width = self.bits.shape
        with np.errstate(invalid="ignore"):
            inside = (u > -0.5) & (u < width - 0.5) & (v > -0.5) & (v < height - 0.5)
            column, row = np.where(inside, u + 0.5, 0).astype(np.int32), np.where(inside, v + 0.5, 0).astype(np.int32)
        return np.where(inside, self.bits.reshape(-1).take(row * np.int32(width) + column), np.uint16(0))


def raster_of(edges: EdgeMap, reach: int) -> EdgeRaster:
    """Enter edges into all pixels that are no further than ``reach`` px from their own, along rows and along columns."""
    height, width = edges.index.shape
    angle = np.arctan2(edges.normal[:, 1], edges.normal[:, 0])
    own = np.zeros(len(edges), np.uint16)
    for turn in (-TOLERANCE, 0.0, TOLERANCE):
        own |= np.uint16(1) << bin_of(angle + turn)
    bits = np.zeros((height, width), np.uint16)
    bits[edges.pixel[:, 1], edges.pixel[:, 0]] = own
    for axis in (0, 1):
        bits = _spread(bits, reach, axis)
    return EdgeRaster(bits)


def bin_of(angle: Array) -> NDArray[np.uint16]:
    """Return the bins of directions (rad)."""
    return (np.floor(angle / BIN).astype(np.int32) % BINS).astype(np.uint16)


def _spread(bits: NDArray[np.uint16], reach: int, axis: int) -> NDArray[np.uint16]:
    """Return for each pixel the bits of all within ``reach`` along an axis."""
    along = np.moveaxis(bits, axis, 0)
    result = along.copy()
    for step in range(1, reach + 1):
        result[step:] |= along[:-step]
        result[:-step] |= along[step:]
    return np.ascontiguousarray(np.moveaxis(result, 0, axis))
