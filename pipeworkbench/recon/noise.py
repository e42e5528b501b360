# SPDX-License-Identifier: LGPL-2.1-or-later
"""The local noise of an image, as an edge detector of a given smoothing sees it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array

BLOCK = 24  # px; the noise is taken as even over such a block
SPREAD = 3  # px between the taps of the mask, and between the pixels looked at: that is enough for a median
GAUSSIAN_MAD = 0.6745  # median absolute deviation of a unit normal distribution
QUANTISATION = float(1 / np.sqrt(12))  # even a noiseless image is known to one grey value only
REACH = 2 * SPREAD  # of both masks together, beyond the smoothing


def block_levels(smoothed: NDArray[np.float32], smooth: Array) -> NDArray[np.float32]:
    """Return per block the standard deviation of white noise that would look like the image's.

    Immerkaer's mask ("Fast noise variance estimation", CVIU 64(2), 1996) removes planes and steps along
    two perpendicular directions. It is spread to the detector's scale and applied to the smoothed image,
    because demosaicking, compression and rough surfaces make noise that single pixels do not show. The
    median over a block leaves single edges out and follows shot noise and shade. Of the masks along the
    axes and along the diagonals the smaller answer counts: a step seen by one is removed by the other.

    Parameters
    ----------
    smoothed : (rows * BLOCK + 2 * REACH, columns * BLOCK + 2 * REACH) array
        The image after smoothing along both axes with ``smooth``, with ``REACH`` pixels around it.
    smooth : (m,) array
        The smoothing kernel.

    Returns
    -------
    (rows, columns) array, grey values.
    """
    grid = smoothed[::SPREAD, ::SPREAD]
    height, width = (size - 2 * REACH // SPREAD for size in grid.shape)
    side = BLOCK // SPREAD

    levels = []
    for mask in (_STRAIGHT, _DIAGONAL):
        rough = np.zeros((height, width), np.float32)
        for (down, right), weight in mask.items():
            rough += np.float32(weight) * grid[2 + down : 2 + down + height, 2 + right : 2 + right + width]
        blocks = np.abs(rough, out=rough).reshape(height // side, side, width // side, side).swapaxes(1, 2)
        middle = side**2 // 2
        medians = np.partition(blocks.reshape(height // side, width // side, -1), middle, axis=2)[:, :, middle]
        levels.append(medians / (GAUSSIAN_MAD * _gain(mask, smooth)))
    return np.maximum(np.minimum(*levels), QUANTISATION).astype(np.float32)


def interpolated(levels: NDArray[np.float32], top: int, height: int, width: int) -> NDArray[np.float32]:
    """Return the noise (height, width) of the pixel rows from ``top`` (a block's first) on, bilinear between the blocks' centres."""
    import cv2

    first, last = top // BLOCK - 1, -(-(top + height) // BLOCK) + 1
    rows = levels[np.clip(np.arange(first, last), 0, len(levels) - 1)]
    full = cv2.resize(rows, (rows.shape[1] * BLOCK, rows.shape[0] * BLOCK), interpolation=cv2.INTER_LINEAR)
    return np.asarray(full[BLOCK : BLOCK + height, :width])


def _mask(*axes: tuple[int, int]) -> dict[tuple[int, int], float]:
    """Return the taps of second differences along two directions in succession."""
    (a, b), (c, d) = axes
    return {(a * i + c * j, b * i + d * j): float((3 * i * i - 2) * (3 * j * j - 2)) for i in (-1, 0, 1) for j in (-1, 0, 1)}


_STRAIGHT = _mask((1, 0), (0, 1))
_DIAGONAL = _mask((1, 1), (1, -1))


def _gain(mask: dict[tuple[int, int], float], smooth: Array) -> float:
    """Return by how much the smoothing and a mask together amplify white noise (smoothed noise has the kernel's autocorrelation)."""
    auto = np.correlate(smooth, smooth, "full")
    auto = np.pad(auto, 4 * SPREAD)
    middle = len(auto) // 2
    return float(
        np.sqrt(
            sum(
                one * other * auto[middle + (down - below) * SPREAD] * auto[middle + (right - beside) * SPREAD]
                for (down, right), one in mask.items()
                for (below, beside), other in mask.items()
            )
        )
    )
