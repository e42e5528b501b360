# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edge points as ridges of the gradient (Devernay's method), refined at a second scale and for curvature.

Gradients are Gaussian derivatives; ridges of their magnitude are located to a fraction of a pixel
along the image axis nearest the gradient (Devernay, "A non-maxima suppression method for edge detection
with sub-pixel accuracy", INRIA RR-2724, 1995), here with a parabola through the LOGARITHM of the
magnitude: the gradient of a blurred step is a Gaussian, for which that is exact, and the parabola's
curvature tells the width of the profile.

Two scales: the noise of a ridge's position falls with the smoothing (against the Cramer-Rao bound
of a step of width s it is least where the smoothing is sqrt(5) s), but smoothing merges neighbouring
edges. So edges are found with little smoothing and placed with more, where both agree.

Curvature: smoothing moves a curved edge towards its centre of curvature by tau^2 / (2 R), where tau is
the width of the smoothed profile and R the radius (the gradient of a blurred disc along its radius is
sqrt(R / r) exp(-(r - R)^2 / (2 tau^2)) but for terms of third order). 1 / R is taken from the
turn of the gradient along the edge, and the point is moved back.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgePoints, EdgeSettings, Strip, kernel_reach, kernels

LOG_FLOOR = 0.02  # neighbours of a ridge count as at least this part of it, so that the logarithm exists
TURN_PX = 4.0  # to each side along the edge where its direction is compared
MOST_CURVED = 1 / 8.0  # 1/px; what turns faster is a corner, not an arc
LARGEST_MOVE = 2.5  # standard deviations between the positions at both scales; more means a neighbouring edge
LEAST_MOVE = 0.08  # px; such a move never counts as one
FURTHEST = 0.75  # px from the pixel where an edge was found to its place
PIXEL_VARIANCE = 1 / 12  # px^2; a pixel is the mean over its area


def halo_of(settings: EdgeSettings) -> int:
    """Return how many pixels around a strip the method looks at."""
    return kernel_reach(settings.fine_sigma) + int(np.ceil(TURN_PX)) + 2


def find(strip: Strip, settings: EdgeSettings, border: tuple[int, int]) -> EdgePoints:
    """Find the edge points of a strip; ``border`` are the first and last rows without edges."""
    coarse, fine = _Scale(strip, settings.sigma), _Scale(strip, settings.fine_sigma)
    magnitude, steep_u = coarse.magnitude(strip.halo - 1)
    height, width = strip.noise.shape

    # whole pixels first, densely: a ridge along the axis nearest the gradient
    candidate = magnitude[1:-1, 1:-1] > np.maximum(settings.noise_factor * coarse.gain * strip.noise, strip.floor)
    rising_u, rising_v = magnitude[1:-1, 1:] > magnitude[1:-1, :-1], magnitude[1:, 1:-1] > magnitude[:-1, 1:-1]
    along_u, along_v = rising_u[:, :-1] > rising_u[:, 1:], rising_v[:-1] > rising_v[1:]
    steep_u = steep_u[1:-1, 1:-1]
    candidate &= along_v ^ (steep_u & (along_u ^ along_v))  # along_u where steep_u, along_v elsewhere
    candidate[: border[0]] = candidate[height - border[1] :] = False
    candidate[:, :2] = candidate[:, -2:] = False
    v, u = np.divmod(np.flatnonzero(candidate), width)

    across_u = steep_u[v, u]
    axis = np.where(across_u, 1, coarse.stride)
    at = coarse.flat(u + strip.halo, v + strip.halo)
    found, placed = coarse.ridge(at, axis), fine.ridge(at, axis)
    noise = strip.noise[v, u]
    sigma_found, sigma_placed = coarse.sigma(found, noise), fine.sigma(placed, noise)
    # both positions share noise: their difference has the variance that the second one gains
    expected = np.sqrt(np.maximum(sigma_found**2 - sigma_placed**2, 0.0))
    agree = np.abs(placed.offset - found.offset) <= np.maximum(LARGEST_MOVE * expected, LEAST_MOVE)
    agree &= np.abs(placed.offset) < FURTHEST
    best = found.where(agree, placed)
    sigma = np.where(agree, sigma_placed, sigma_found)

    smoothing = np.where(agree, settings.fine_sigma, settings.sigma)
    shift = 0.5 * best.variance * _turn(fine, at, best.normal)
    position = np.column_stack([u + np.where(across_u, best.offset, 0.0), v + np.where(across_u, 0.0, best.offset)])
    return EdgePoints(
        position=position + shift[:, None] * best.normal,
        normal=best.normal,
        gradient=found.peak,
        contrast=best.peak * np.sqrt(2 * np.pi * best.variance),
        blur=np.sqrt(np.maximum(best.variance - smoothing**2 - PIXEL_VARIANCE, 0.0)),
        sigma=np.maximum(sigma, settings.sigma_floor),
        smoothing=smoothing,
        pixel=np.column_stack([u, v]).astype(np.int32),
    )


class _Ridge:
    """Ridges of a gradient near pixels: offset (n,) px along the axis, normal (n, 2), peak (n,), variance (n,) px^2 of the profile."""

    def __init__(self, offset: Array, normal: Array, peak: Array, variance: Array) -> None:
        self.offset, self.normal, self.peak, self.variance = offset, normal, peak, variance

    def where(self, condition: NDArray[np.bool_], other: _Ridge) -> _Ridge:
        """Return a mixture: the other's where the condition (n,) holds."""
        return _Ridge(
            np.where(condition, other.offset, self.offset),
            np.where(condition[:, None], other.normal, self.normal),
            np.where(condition, other.peak, self.peak),
            np.where(condition, other.variance, self.variance),
        )


class _Scale:
    """The gradient of a strip at one smoothing."""

    def __init__(self, strip: Strip, sigma: float) -> None:
        import cv2

        smooth, slope, curvature = kernels(sigma)
        self.gradient_x = np.asarray(cv2.sepFilter2D(strip.grey, cv2.CV_32F, slope, smooth))
        self.gradient_y = np.asarray(cv2.sepFilter2D(strip.grey, cv2.CV_32F, smooth, slope))
        self.gain = float(np.linalg.norm(slope) * np.linalg.norm(smooth))  # of white noise to the gradient's
        self.second_gain = float(np.linalg.norm(curvature) * np.linalg.norm(smooth))  # to the second derivative's
        self.stride = strip.grey.shape[1]

    def magnitude(self, inset: int) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Return the gradient's magnitude and where it is nearer the u axis, without ``inset`` pixels around."""
        import cv2

        inner = slice(inset, -inset)
        x, y = self.gradient_x[inner, inner], self.gradient_y[inner, inner]
        return np.asarray(cv2.magnitude(x, y)), np.abs(x) >= np.abs(y)

    def flat(self, u: NDArray[np.intp], v: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return indices (n,) into the flattened gradient."""
        return v * self.stride + u

    def at(self, flat: NDArray[np.intp]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return both components (n,) of the gradient."""
        return self.gradient_x.reshape(-1).take(flat), self.gradient_y.reshape(-1).take(flat)

    def ridge(self, at: NDArray[np.intp], axis: NDArray[np.intp]) -> _Ridge:
        """Locate ridges near pixels ``at`` along ``axis`` (n,), the step to the next pixel."""
        (x, y), before, after = self.at(at), self.at(at - axis), self.at(at + axis)
        peak = np.maximum(np.hypot(x, y), np.float32(1e-6))
        low = np.log(np.maximum(np.hypot(*before) / peak, LOG_FLOOR))
        high = np.log(np.maximum(np.hypot(*after) / peak, LOG_FLOOR))
        bend = np.minimum(low + high, -1e-3).astype(float)  # minus 1 / variance of the profile along the axis
        offset = 0.5 * (low - high) / bend
        normal = np.column_stack([x, y]) / peak[:, None].astype(float)
        obliquity = np.where(axis == 1, normal[:, 0], normal[:, 1]) ** 2
        # the ridge's height lies on the parabola through the three logarithms
        height = peak * np.exp(np.clip(-0.5 * bend * offset * offset, 0.0, 1.0))
        return _Ridge(np.clip(offset, -FURTHEST, FURTHEST), normal, height, obliquity / -bend)

    def sigma(self, ridge: _Ridge, noise: Array) -> Array:
        """Return standard deviations (n,) in px: a ridge is a zero of the second derivative, whose slope is peak / variance."""
        return self.second_gain * noise * ridge.variance / ridge.peak


def _turn(scale: _Scale, at: NDArray[np.intp], normal: Array) -> Array:
    """Return the signed curvature (n,) in 1/px of edges, positive where the centre lies against the normal."""
    along_u, along_v = np.rint(-TURN_PX * normal[:, 1]).astype(np.intp), np.rint(TURN_PX * normal[:, 0]).astype(np.intp)
    step = along_v * scale.stride + along_u
    (ahead_x, ahead_y), (back_x, back_y) = scale.at(at + step), scale.at(at - step)
    # the angle from the normal behind to the one ahead
    turn = np.arctan2(back_x * ahead_y - back_y * ahead_x, back_x * ahead_x + back_y * ahead_y)
    curvature = turn / (2 * np.hypot(along_u, along_v))
    return np.where(np.abs(curvature) <= MOST_CURVED, curvature, 0.0)
