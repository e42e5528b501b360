# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subpixel edge points of an image, in arrays, with a pixel -> edge index for fast look-ups.

Gradients are Gaussian derivatives; ridges of the gradient magnitude are located to a fraction of a
pixel along the image axis nearest the gradient (Devernay, "A non-maxima suppression method for edge
detection with sub-pixel accuracy", INRIA RR-2724, 1995), here with a parabola through the LOGARITHM
of the magnitude: the gradient of a blurred step is a Gaussian, for which that is exact.
Thresholds follow from the image's own noise, so that dim and bright images need no tuning.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array

KERNEL_REACH = 4.0  # kernel half width in standard deviations
LOG_FLOOR = 0.02  # neighbours of a ridge count as at least this part of it, so that the logarithm exists
NOISE_SPREAD = 3  # px between the taps of the noise mask
NOISE_BLOCK = 24  # px; the noise is taken as even over such a block
GAUSSIAN_MAD = 0.6745  # median absolute deviation of a unit normal distribution


@dataclass(frozen=True)
class EdgeSettings:
    """Tunables of the edge detector.

    ``sigma`` is the standard deviation of the smoothing in pixels, ``noise_factor`` how many standard
    deviations of the gradient's noise an edge must exceed, ``least_gradient`` a floor in parts of the
    image's range of values per pixel, ``sigma_floor`` the best standard deviation (px) ever claimed.
    """

    sigma: float = 1.2
    noise_factor: float = 3.5
    least_gradient: float = 0.0012
    sigma_floor: float = 0.03


@dataclass(frozen=True, eq=False)
class EdgeMap:
    """Edge points of one image.

    position (n, 2) pixels; normal (n, 2) unit, towards the brighter side; gradient (n,) grey values
    per pixel; sigma (n,) expected standard deviation in px along the normal; index (height, width)
    the row of the point that lies in a pixel or else beside it, -1 where there is none.
    """

    position: Array
    normal: Array
    gradient: Array
    sigma: Array
    index: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.position)


def detect_edges(image: NDArray[np.uint8] | NDArray[np.uint16], settings: EdgeSettings | None = None) -> EdgeMap:
    """Find the edge points of a grey image (height, width), 8 or 16 bit."""
    import cv2

    settings = settings or EdgeSettings()
    grey = image.astype(np.float32)
    smooth, slope, curvature = _kernels(settings.sigma)
    gradient_x = cv2.sepFilter2D(grey, cv2.CV_32F, slope, smooth, borderType=cv2.BORDER_REPLICATE)
    gradient_y = cv2.sepFilter2D(grey, cv2.CV_32F, smooth, slope, borderType=cv2.BORDER_REPLICATE)
    magnitude = cv2.magnitude(gradient_x, gradient_y)

    noise = _noise_level(grey, smooth)
    gradient_noise = noise * float(np.linalg.norm(slope) * np.linalg.norm(smooth))
    floor = settings.least_gradient * np.iinfo(image.dtype).max
    candidate = magnitude > np.maximum(settings.noise_factor * gradient_noise, floor)
    candidate[:2] = candidate[-2:] = False
    candidate[:, :2] = candidate[:, -2:] = False

    v, u = np.nonzero(candidate)
    gx, gy, peak = gradient_x[v, u], gradient_y[v, u], magnitude[v, u]
    across_u = np.abs(gx) >= np.abs(gy)
    step_u, step_v = across_u.astype(np.intp), (~across_u).astype(np.intp)
    before, after = magnitude[v - step_v, u - step_u], magnitude[v + step_v, u + step_u]
    ridge = (peak > before) & (peak >= after)
    u, v, gx, gy, peak, before, after, across_u = (x[ridge] for x in (u, v, gx, gy, peak, before, after, across_u))

    low = np.log(np.maximum(before, LOG_FLOOR * peak) / peak)
    high = np.log(np.maximum(after, LOG_FLOOR * peak) / peak)
    bend = np.minimum(low + high, -1e-3)  # minus 1 / variance of the edge's profile along the axis
    offset = np.clip(0.5 * (low - high) / bend, -0.5, 0.5).astype(float)

    position = np.column_stack([u + np.where(across_u, offset, 0.0), v + np.where(across_u, 0.0, offset)])
    normal = np.column_stack([gx, gy]).astype(float) / peak[:, None]
    # a ridge's position is the zero of the second derivative: its noise over its slope, peak / profile variance
    obliquity = np.where(across_u, normal[:, 0] ** 2, normal[:, 1] ** 2)
    second_noise = noise[v, u] * float(np.linalg.norm(curvature) * np.linalg.norm(smooth))
    sigma = np.maximum(second_noise / (peak * -bend / obliquity), settings.sigma_floor)

    return EdgeMap(position, normal, peak.astype(float), sigma, _index(grey.shape, u, v))


def _index(shape: tuple[int, ...], u: NDArray[np.intp], v: NDArray[np.intp]) -> NDArray[np.int32]:
    """Return the row of the edge in or beside each pixel (height, width), -1 where there is none.

    Slanted edges are chains of pixels that touch at corners, and a search along the normal steps
    through between two of them: so the four neighbours of an edge pixel answer for it as well.
    """
    rows = np.arange(len(u), dtype=np.int32)
    index = np.full(shape, -1, np.int32)
    # candidates keep two pixels from the border: no neighbour is outside
    for step_u, step_v in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        index[v + step_v, u + step_u] = rows
    index[v, u] = rows
    return index


def _kernels(sigma: float) -> tuple[Array, Array, Array]:
    """Return a Gaussian and its first and second derivative, exact on constants, ramps and parabolas."""
    reach = int(np.ceil(KERNEL_REACH * sigma))
    x = np.arange(-reach, reach + 1, dtype=float)
    smooth = np.exp(-(x**2) / (2 * sigma**2))
    smooth /= smooth.sum()
    slope = x * smooth
    slope /= (x * slope).sum()
    curvature = (x**2 / sigma**2 - 1) * smooth
    curvature -= curvature.mean()
    curvature /= (x**2 * curvature).sum() / 2
    return smooth, slope, curvature


def _noise_level(grey: NDArray[np.float32], smooth: Array) -> NDArray[np.float32]:
    """Return the local standard deviation (height, width) of white noise that would look like the image's.

    Immerkaer's mask ("Fast noise variance estimation", CVIU 64(2), 1996) removes planes and steps along
    two perpendicular directions. It is spread to the detector's scale and smoothed alike, because
    demosaicking, compression and rough surfaces make noise that single pixels do not show. The median
    over a block leaves single edges out and follows shot noise and shade. Of the masks along the axes
    and along the diagonals the smaller answer counts: a step seen by one is removed by the other.
    """
    import cv2

    reach = NOISE_SPREAD
    straight = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
    straight[reach, [0, reach, -1]] = 1, -2, 1
    falling = np.zeros_like(straight)
    falling[[0, reach, -1], [0, reach, -1]] = 1, -2, 1
    smoothed = cv2.sepFilter2D(grey, cv2.CV_32F, smooth, smooth, borderType=cv2.BORDER_REFLECT)
    levels = [
        _block_level(smoothed, smooth, one, other) for one, other in ((straight, straight.T), (falling, np.ascontiguousarray(falling[:, ::-1])))
    ]
    level = np.minimum(*levels)
    height, width = grey.shape
    full = cv2.resize(level, (level.shape[1] * NOISE_BLOCK, level.shape[0] * NOISE_BLOCK), interpolation=cv2.INTER_LINEAR)
    quantisation = np.float32(1 / np.sqrt(12))  # even a noiseless image is known to one grey value only
    return np.maximum(full[:height, :width], quantisation)


def _block_level(smoothed: NDArray[np.float32], smooth: Array, one: NDArray[np.float32], other: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the noise (rows, columns) per block that two second differences in succession see."""
    import cv2

    def apply(image: NDArray[np.float32]) -> NDArray[np.float32]:
        first = cv2.filter2D(image, cv2.CV_32F, one, borderType=cv2.BORDER_REFLECT)
        return np.asarray(cv2.filter2D(first, cv2.CV_32F, other, borderType=cv2.BORDER_REFLECT))

    size = len(smooth) + 4 * len(one)
    impulse = np.zeros((size, size), np.float32)
    impulse[size // 2, size // 2] = 1
    gain = float(np.linalg.norm(apply(cv2.sepFilter2D(impulse, cv2.CV_32F, smooth, smooth))))
    rough = np.abs(apply(smoothed))
    rough = np.pad(rough, ((0, -rough.shape[0] % NOISE_BLOCK), (0, -rough.shape[1] % NOISE_BLOCK)), mode="symmetric")
    rows, columns = rough.shape[0] // NOISE_BLOCK, rough.shape[1] // NOISE_BLOCK
    # every second pixel in both directions will do for a median
    blocks = rough.reshape(rows, NOISE_BLOCK, columns, NOISE_BLOCK)[:, ::2, :, ::2]
    medians = np.median(blocks.swapaxes(1, 2).reshape(rows, columns, -1), axis=2)
    return np.asarray(medians / (GAUSSIAN_MAD * gain), np.float32)
