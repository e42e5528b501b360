# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subpixel edge points of an image, in arrays, with a pixel -> edge index for fast look-ups.

The image is worked through in strips, on as many threads as there are cores, so that memory stays
low however large it is. Thresholds follow from the image's own noise, so that dim and bright images
need no tuning. Two methods locate the points: :mod:`.gradient_edges` (the default, which measures
better: bench/edges.py) and :mod:`.partial_area_edges` (the paper's).
"""

from __future__ import annotations

import functools
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.recon import noise
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.threads import thread_count

Grey = NDArray[np.uint8] | NDArray[np.uint16]

KERNEL_REACH = 3.2  # kernel half width in standard deviations
STRIP_BLOCKS = 8  # blocks of the noise estimate in a strip's height: its arrays stay near the processor's cache
BORDER = 2  # px along the image's border without edges: their profile is not in the image
DIRECTIONS = 128  # coarse ones in half a turn
NO_DIRECTION = 1


@dataclass(frozen=True)
class EdgeSettings:
    """Tunables of the edge detector.

    Attributes
    ----------
    method
        "gradient" (Devernay's) or "partial area" (Trujillo-Pino's).
    sigma
        Standard deviation in px of the smoothing that edges are found with: two edges nearer than
        about three times this are one.
    fine_sigma
        The gradient method's smoothing (px, at least ``sigma``) for the position of edges without
        neighbours, where more smoothing means less noise.
    noise_factor
        How many standard deviations of the gradient's noise an edge must exceed.
    least_gradient
        A floor in parts of the image's range of values per pixel.
    sigma_floor
        The best standard deviation (px) ever claimed.
    """

    method: Literal["gradient", "partial area"] = "gradient"
    sigma: float = 1.2
    fine_sigma: float = 1.9
    noise_factor: float = 3.5
    least_gradient: float = 0.0012
    sigma_floor: float = 0.03

    def __post_init__(self) -> None:
        if self.method not in ("gradient", "partial area") or not 0.5 <= self.sigma <= self.fine_sigma <= 10:
            raise InputError("the edge settings", "method, sigma, fine_sigma", f"do not fit ({self})", "0.5 <= sigma <= fine_sigma <= 10")


@dataclass(frozen=True, eq=False)
class EdgePoints:
    """Edge points in arrays of one length n.

    position (n, 2) pixels; normal (n, 2) unit, towards the brighter side; gradient (n,) of the smoothed
    image in grey values per pixel; contrast (n,) grey values between both sides; blur (n,) standard
    deviation in px of the edge's own profile, without the pixel's area; sigma (n,) expected standard
    deviation in px along the normal; smoothing (n,) standard deviation in px of the smoothing in it: errors
    of points nearer than about 2 sqrt(pi) times this along an edge are alike; pixel (n, 2) the whole pixel
    (u, v) where the point was found.
    """

    position: Array
    normal: Array
    gradient: Array
    contrast: Array
    blur: Array
    sigma: Array
    smoothing: Array
    pixel: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True, eq=False)
class EdgeMap(EdgePoints):
    """The edge points of one image.

    ``index`` (height, width) is the row of the point that lies in a pixel or else beside it, -1 where
    there is none.
    """

    index: NDArray[np.int32]

    @functools.cached_property
    def directions(self) -> NDArray[np.uint8]:
        """Where ``index`` (height, width) is a point, the direction of its normal as :func:`coarse_directions` gives it, else an odd number.

        A quarter of the index's size: what is looked up in it stays in the processor's cache, and the points
        that are an edge's of another direction, which are most, need not be looked at.
        """
        # the index's -1 is the last entry
        return np.append(coarse_directions(*self.normal.T), np.uint8(NO_DIRECTION)).take(self.index, mode="wrap")


@dataclass(frozen=True, eq=False)
class Strip:
    """Some rows of an image with what surrounds them.

    ``grey`` (height + 2 halo, width + 2 halo) values; ``noise`` (height, width) standard deviations in
    grey values; ``floor`` the least gradient in grey values per pixel.
    """

    grey: NDArray[np.float32]
    noise: NDArray[np.float32]
    halo: int
    floor: float


def coarse_directions(along_u: Array, along_v: Array) -> NDArray[np.uint8]:
    """Return the directions (n,) of vectors with components (n,) as even numbers that are the same for both signs: 256 is half a turn.

    Differences in this type wrap around as the directions do.
    """
    steps = np.rint(np.nan_to_num(np.arctan2(along_v, along_u)) * (DIRECTIONS / np.pi)).astype(np.int32)
    return (2 * steps).astype(np.uint8)


def detect_edges(image: NDArray[Any], settings: EdgeSettings | None = None, cores: int | None = None) -> EdgeMap:
    """Find the edge points of an image.

    Parameters
    ----------
    image : (height, width) or (height, width, 3 or 4) array of uint8 or uint16
        Grey values, or colours in OpenCV's order (blue, green, red, opacity).
    settings : EdgeSettings, optional
    cores : int, optional
        Number of threads at most (default: one for each core of the processor).

    Raises
    ------
    InputError
        Where the array is not such an image.
    """
    import cv2

    settings = settings or EdgeSettings()
    grey = as_grey(image)
    height, width = grey.shape
    index = np.full((height, width), -1, np.int32)
    smooth, _, _ = kernels(settings.sigma)
    with ThreadPoolExecutor(thread_count(cores)) as threads:
        levels = _noise_levels(grey, smooth, threads)
        if settings.method == "gradient":
            from pipeworkbench.recon.gradient_edges import find, halo_of
        else:
            from pipeworkbench.recon.partial_area_edges import find, halo_of
        halo = halo_of(settings)
        padded = cv2.copyMakeBorder(grey, halo, halo, halo, halo, cv2.BORDER_REPLICATE)
        floor = settings.least_gradient * np.iinfo(grey.dtype).max
        step = STRIP_BLOCKS * noise.BLOCK

        def points_of(top: int) -> EdgePoints:
            rows = min(step, height - top)
            strip = Strip(padded[top : top + rows + 2 * halo].astype(np.float32), noise.interpolated(levels, top, rows, width), halo, floor)
            border = (max(BORDER - top, 0), max(top + rows - (height - BORDER), 0))
            found = find(strip, settings, border)
            found.position[:, 1] += top
            found.pixel[:, 1] += top
            return found

        parts = list(threads.map(points_of, range(0, height, step)))
    columns = {field.name: np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(EdgePoints)}
    _fill(index, columns["pixel"], columns["position"])
    return EdgeMap(**columns, index=index)


def kernels(sigma: float) -> tuple[Array, Array, Array]:
    """Return a Gaussian and its first and second derivative, exact on constants, ramps and parabolas."""
    reach = kernel_reach(sigma)
    x = np.arange(-reach, reach + 1, dtype=float)
    smooth = np.exp(-(x**2) / (2 * sigma**2))
    smooth /= smooth.sum()
    slope = x * smooth
    slope /= (x * slope).sum()
    curvature = (x**2 / sigma**2 - 1) * smooth
    curvature -= curvature.mean()
    curvature /= (x**2 * curvature).sum() / 2
    return smooth, slope, curvature


def kernel_reach(sigma: float) -> int:
    """Return the half width in px of the kernels of a smoothing."""
    return int(np.ceil(KERNEL_REACH * sigma))


def as_grey(image: NDArray[Any]) -> Grey:
    """Return an image as grey values (height, width) of its own depth, or say what is wrong with it."""
    import cv2

    if not isinstance(image, np.ndarray) or image.dtype not in (np.uint8, np.uint16):
        kind = image.dtype if isinstance(image, np.ndarray) else type(image).__name__
        raise InputError("the image", "", f"has values of type {kind}", "give 8- or 16-bit grey values or colours (uint8, uint16)")
    if image.ndim == 3 and image.shape[2] == 1:
        image = image[:, :, 0]
    if image.ndim == 3 and image.shape[2] in (3, 4) and image.size:
        image = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY if image.shape[2] == 3 else cv2.COLOR_BGRA2GRAY))
    if image.ndim != 2 or not image.size:
        raise InputError("the image", "", f"has the shape {image.shape}", "give (height, width) grey values or (height, width, 3 or 4) colours")
    return image


def _noise_levels(grey: Grey, smooth: Array, threads: Executor) -> NDArray[np.float32]:
    """Return the noise per block (rows, columns) of the whole image."""
    import cv2

    height, width = grey.shape
    reach = len(smooth) // 2
    around = noise.REACH + reach
    padded = cv2.copyMakeBorder(grey, around, around + -height % noise.BLOCK, around, around + -width % noise.BLOCK, cv2.BORDER_REFLECT)
    step = STRIP_BLOCKS * noise.BLOCK

    def levels_of(top: int) -> NDArray[np.float32]:
        rows = padded[top : min(top + step + 2 * around, len(padded))].astype(np.float32)
        smoothed = cv2.sepFilter2D(rows, cv2.CV_32F, smooth, smooth)
        return noise.block_levels(np.asarray(smoothed)[reach:-reach, reach:-reach], smooth)

    return np.concatenate(list(threads.map(levels_of, range(0, height, step))))


def _fill(index: NDArray[np.int32], pixel: NDArray[np.int32], position: Array) -> None:
    """Enter points found at pixels (n, 2) and placed at positions (n, 2) into an index (height, width).

    Slanted edges are chains of pixels that touch at corners, and a search along the normal steps
    through between two of them: so the four neighbours of an edge pixel answer for it as well.
    """
    height, width = index.shape
    rows = np.arange(len(pixel), dtype=np.int32)
    table = index.reshape(-1)
    place = np.clip(np.rint(position), 0, (width - 1, height - 1)).astype(np.intp)
    table[place[:, 1] * width + place[:, 0]] = rows
    flat = pixel[:, 1].astype(np.intp) * width + pixel[:, 0]
    # points keep BORDER pixels from the border: no neighbour is outside
    for step in (1, -1, width, -width):
        table[flat + step] = rows
    table[flat] = rows
