# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edge points from partial areas: the method the paper uses.

Trujillo-Pino, Krissian, Aleman-Flores, Santana-Cedres, "Accurate subpixel edge location based on partial
area effect", Image and Vision Computing 31(1), 2013. A pixel that an edge crosses shows the mean of
both sides, weighted with their areas in it. Here, for an edge that runs nearly along u, with the
intensity A below and B above: the values of a column sum up to
S = A (l + 1/2 + y) + B (m + 1/2 - y), where y is the mean height of the edge in the column and m and l
are how many pixels the window reaches above and below the middle. Three columns give the
parabola y(x) = a + b x + c x^2, in which a mean over a column of width 1 adds c / 12 to the height and
smoothing along u with a kernel of variance q adds c q (the paper's Eq. for its 3 x 3 mask alike). The
windows grow while the intensity keeps changing in the edge's direction, at most to ``LONGEST``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgePoints, EdgeSettings, Strip, kernel_reach, kernels

SMOOTHING = 0.6  # px, standard deviation; about the method's 3 x 3 mask
SHORTEST, LONGEST = 2, 4  # px from the middle to the ends of a window
LEAST_CHANGE = 0.05  # of the middle's gradient: less is no longer the edge
PIXEL_VARIANCE = 1 / 12  # px^2


def halo_of(settings: EdgeSettings) -> int:  # noqa: ARG001
    """Return how many pixels around a strip the method looks at."""
    return kernel_reach(SMOOTHING) + LONGEST + 3


def find(strip: Strip, settings: EdgeSettings, border: tuple[int, int]) -> EdgePoints:
    """Find the edge points of a strip; ``border`` are the first and last rows without edges."""
    import cv2

    smooth, _, _ = kernels(SMOOTHING)
    variance = float((np.arange(len(smooth)) - len(smooth) // 2) ** 2 @ smooth)
    grey = np.asarray(cv2.sepFilter2D(strip.grey, cv2.CV_32F, smooth, smooth))
    halo, stride = strip.halo, grey.shape[1]

    u, v, across_u = _steepest(grey, smooth, strip, settings, border)
    at = (v + halo) * stride + u + halo
    down, right = np.where(across_u, 1, stride), np.where(across_u, stride, 1)
    values = grey.reshape(-1)
    step = np.arange(-LONGEST - 1, LONGEST + 2)
    # n columns of three, each with the window's pixels: (n, 3, 2 LONGEST + 3)
    columns = values.take(at[:, None, None] + right[:, None, None] * np.array([-1, 0, 1])[:, None] + down[:, None, None] * step)
    change = 0.5 * (columns[:, :, 2:] - columns[:, :, :-2])
    columns = columns[:, :, 1:-1]
    sign = np.sign(change[:, 1, LONGEST])
    change = change * sign[:, None, None]
    above, below = _limit(change[:, :, LONGEST::-1]), _limit(change[:, :, LONGEST:])
    offsets = np.arange(-LONGEST, LONGEST + 1)
    inside = (offsets >= -above[:, :, None]) & (offsets <= below[:, :, None])
    rows = np.arange(len(at))[:, None]
    three = np.arange(3)[None, :]
    # the ends of all three windows tell the intensities of both sides
    upper, lower = columns[rows, three, LONGEST - above].mean(axis=1), columns[rows, three, LONGEST + below].mean(axis=1)
    step_height = np.where(np.abs(lower - upper) > 1e-3, lower - upper, 1e-3)
    total = np.where(inside, columns, 0).sum(axis=2, dtype=float)
    # coordinates grow downwards: y is how far the upper side reaches below the middle
    y = (lower[:, None] * (below + 0.5) + upper[:, None] * (above + 0.5) - total) / step_height[:, None]
    c = 0.5 * (y[:, 0] + y[:, 2]) - y[:, 1]
    b = 0.5 * (y[:, 2] - y[:, 0])
    a = y[:, 1] - c * (PIXEL_VARIANCE + variance)

    good = np.abs(a) <= 1
    u, v, a, b, across_u, step_height, sign = (x[good] for x in (u, v, a, b, across_u, step_height, sign))
    noise, count = strip.noise[v, u], (above + below + 1)[good, 1]
    # the sum has the noise of its pixels, smoothed along u only; either side's mean that of three smoothed values
    one_way = float(smooth @ smooth)
    amplified = count * one_way + 2 * (count / 2) ** 2 * one_way**2 / 3
    # the normal of y = a + b x + c x^2 at x = 0, towards the brighter side
    length = np.hypot(1.0, b) * np.sign(step_height)
    along, across = -b / length, 1 / length
    slope = np.abs(change[good, 1, LONGEST]) * np.hypot(1.0, b)
    width_px = np.abs(step_height) / np.maximum(np.sqrt(2 * np.pi) * slope, 1e-6)
    return EdgePoints(
        position=np.column_stack([u + np.where(across_u, a, 0.0), v + np.where(across_u, 0.0, a)]),
        normal=np.column_stack([np.where(across_u, across, along), np.where(across_u, along, across)]),
        gradient=slope.astype(float),
        contrast=np.abs(step_height).astype(float),
        blur=np.sqrt(np.maximum(width_px**2 - variance - PIXEL_VARIANCE, 0.0)),
        sigma=np.maximum(noise * np.sqrt(amplified) / np.abs(step_height) * np.abs(across), settings.sigma_floor),
        smoothing=np.full(len(u), SMOOTHING),
        pixel=np.column_stack([u, v]).astype(np.int32),
    )


def _steepest(
    grey: NDArray[np.float32], smooth: Array, strip: Strip, settings: EdgeSettings, border: tuple[int, int]
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.bool_]]:
    """Return pixels u, v (n,) of a smoothed strip where the difference along its steeper axis is largest, and whether that is u."""
    height, width = strip.noise.shape
    halo = strip.halo
    around = grey[halo - 2 : halo + height + 2, halo - 2 : halo + width + 2]
    gradient_u, gradient_v = 0.5 * (around[1:-1, 2:] - around[1:-1, :-2]), 0.5 * (around[2:, 1:-1] - around[:-2, 1:-1])
    steep_u = np.abs(gradient_u) >= np.abs(gradient_v)
    strength = np.where(steep_u, np.abs(gradient_u), np.abs(gradient_v))
    gain = float(np.linalg.norm(np.convolve(smooth, [0.5, 0, -0.5])) * np.linalg.norm(smooth))
    candidate = strength[1:-1, 1:-1] > np.maximum(settings.noise_factor * gain * strip.noise, strip.floor)
    size_u, size_v = np.abs(gradient_u), np.abs(gradient_v)
    along_u = (size_u[1:-1, 1:-1] > size_u[1:-1, :-2]) & (size_u[1:-1, 1:-1] >= size_u[1:-1, 2:])
    along_v = (size_v[1:-1, 1:-1] > size_v[:-2, 1:-1]) & (size_v[1:-1, 1:-1] >= size_v[2:, 1:-1])
    candidate &= np.where(steep_u[1:-1, 1:-1], along_u, along_v)
    candidate[: border[0]] = candidate[height - border[1] :] = False
    candidate[:, :2] = candidate[:, -2:] = False
    v, u = np.divmod(np.flatnonzero(candidate), width)

    return u, v, steep_u[v + 1, u + 1]


def _limit(change: NDArray[np.float32]) -> NDArray[np.intp]:
    """Return how far windows reach (n, 3) where the change of intensity (n, 3, LONGEST + 1) goes outwards from the middle.

    A window ends where the change stops falling, turns or is gone; not before ``SHORTEST``.
    """
    goes_on = (change[:, :, 1:] < change[:, :, :-1]) & (change[:, :, 1:] > LEAST_CHANGE * change[:, :, :1])
    goes_on[:, :, :SHORTEST] = True
    return np.cumprod(goes_on, axis=2).sum(axis=2)
