# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cameras: interior orientation with distortion, exterior orientation, projection and image rays.

An interior orientation maps measured pixels (u right, v down, centres at integers) to ideal image
coordinates (x/z, y/z of the camera frame) and back. In the photogrammetric model measured -> ideal is
closed form, in OpenCV's the other way round; the inverse is Newton's method with analytic derivatives.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEWTON_ITERATIONS = 20
NEWTON_TOLERANCE = 1e-6  # of the coordinates, BEFORE the last step, which squares what is missing
FIELD_MARGIN = 1.15  # points beyond the image corner's field angle by more than this are not projected


@dataclass(frozen=True, eq=False)
class Interior(ABC):
    """Interior orientation of an image of ``width`` x ``height`` pixels."""

    width: int
    height: int

    @abstractmethod
    def ideal(self, pixels: Array) -> Array:
        """Return the ideal coordinates (n, 2) of measured pixels (n, 2)."""

    @abstractmethod
    def pixels(self, ideal: Array) -> Array:
        """Return the measured pixels (n, 2) of ideal coordinates (n, 2); NaN outside the field of view."""

    @abstractmethod
    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:
        """Return d pixels / d ideal (n, 2, 2) where ``ideal`` and ``pixels`` (n, 2) belong together."""

    @functools.cached_property
    def field_radius(self) -> float:
        """Largest distance from the optical axis, in ideal coordinates, that is still projected.

        Distortion polynomials fold back far outside the image; points there must not reappear in it.
        """
        u, v = np.linspace(-0.5, self.width - 0.5, 16), np.linspace(-0.5, self.height - 0.5, 16)
        border = np.concatenate(
            [np.column_stack([u, np.full(16, w)]) for w in (v[0], v[-1])] + [np.column_stack([np.full(16, w), v]) for w in (u[0], u[-1])]
        )
        return FIELD_MARGIN * float(np.nanmax(np.linalg.norm(self.ideal(border), axis=1)))

    @functools.cached_property
    def pixels_per_radian(self) -> float:
        """Principal distance in pixels: the image's scale on the optical axis."""
        axis = np.zeros((1, 2))
        return float(np.sqrt(abs(np.linalg.det(self.pixel_derivative(axis, self.pixels(axis))[0]))))

    def _outside(self, ideal: Array) -> NDArray[np.bool_]:
        return ~(np.linalg.norm(ideal, axis=1) <= self.field_radius)


@dataclass(frozen=True, eq=False)
class PhotogrammetricInterior(Interior):
    """Principal distance, principal point (mm), radial (A), decentring (B), scale and shear (C) terms.

    With image coordinates in mm, y down: x = (u - (width - 1) / 2) * pitch - x0, y alike, r2 = x x + y y;
    radial = A1 (r2 - r0 r0) + A2 (r2 r2 - r0^4);
    dx = x radial + B1 (r2 + 2 x x) + 2 B2 x y + C1 x + C2 y,
    dy = y radial + B2 (r2 + 2 y y) + 2 B1 x y;
    the ideal coordinates are ((x - dx) / c, (y - dy) / c). ``r0`` is the radius in mm at which the radial
    distortion vanishes; the parameters are those of the paper's Sect. 3.
    """

    pixel_pitch: float
    principal_distance: float
    principal_point: tuple[float, float]
    A1: float = 0.0
    A2: float = 0.0
    B1: float = 0.0
    B2: float = 0.0
    C1: float = 0.0
    C2: float = 0.0
    r0: float = 0.0

    def ideal(self, pixels: Array) -> Array:  # noqa: D102
        image = self._image(pixels)
        return (image - self._distortion(image)) / self.principal_distance

    def pixels(self, ideal: Array) -> Array:  # noqa: D102
        target = ideal * self.principal_distance
        start = target + self._distortion(target)
        image, converged = _newton(lambda x: (x - self._distortion(x), self._ideal_derivative(x)), target, start)
        pixels = (image + self.principal_point) / self.pixel_pitch + self._centre
        pixels[self._outside(ideal) | ~converged] = np.nan
        return pixels

    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: ARG002, D102
        inverse = _inverse_2x2(self._ideal_derivative(self._image(pixels)))
        return inverse * (self.principal_distance / self.pixel_pitch)

    @property
    def _centre(self) -> Array:
        return np.array([(self.width - 1) / 2, (self.height - 1) / 2])

    def _image(self, pixels: Array) -> Array:
        return (pixels - self._centre) * self.pixel_pitch - np.asarray(self.principal_point)

    def _distortion(self, image: Array) -> Array:
        x, y = image.T
        r2 = x * x + y * y
        radial = self.A1 * (r2 - self.r0**2) + self.A2 * (r2 * r2 - self.r0**4)
        dx = x * radial + self.B1 * (r2 + 2 * x * x) + 2 * self.B2 * x * y + self.C1 * x + self.C2 * y
        dy = y * radial + self.B2 * (r2 + 2 * y * y) + 2 * self.B1 * x * y
        return np.stack([dx, dy], axis=1)

    def _ideal_derivative(self, image: Array) -> Array:
        """Return d (image - distortion) / d image (n, 2, 2)."""
        x, y = image.T
        r2 = x * x + y * y
        radial = self.A1 * (r2 - self.r0**2) + self.A2 * (r2 * r2 - self.r0**4)
        slope = 2 * (self.A1 + 2 * self.A2 * r2)  # d radial / dx = x * slope, d radial / dy = y * slope
        mixed = x * y * slope + 2 * self.B1 * y + 2 * self.B2 * x
        derivative = np.empty((len(x), 2, 2))
        derivative[:, 0, 0] = 1 - (radial + x * x * slope + 6 * self.B1 * x + 2 * self.B2 * y + self.C1)
        derivative[:, 0, 1] = -(mixed + self.C2)
        derivative[:, 1, 0] = -mixed
        derivative[:, 1, 1] = 1 - (radial + y * y * slope + 6 * self.B2 * y + 2 * self.B1 * x)
        return derivative


@dataclass(frozen=True, eq=False)
class OpenCVInterior(Interior):
    """OpenCV's pinhole model: focal lengths and principal point in pixels, up to 14 distortion terms.

    ``distortion`` is in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 taux tauy, padded with zeros.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    _coefficients: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_coefficients", np.concatenate([self.distortion, np.zeros(14 - len(self.distortion))]))

    def ideal(self, pixels: Array) -> Array:  # noqa: D102
        target = (pixels - (self.cx, self.cy)) / (self.fx, self.fy)
        if not self._coefficients.any():
            return target
        ideal, converged = _newton(self._distorted, target, target)
        ideal[~converged] = np.nan
        return ideal

    def pixels(self, ideal: Array) -> Array:  # noqa: D102
        pixels = self._distorted(ideal)[0] * (self.fx, self.fy) + (self.cx, self.cy)
        pixels[self._outside(ideal)] = np.nan
        return pixels

    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: ARG002, D102
        return self._distorted(ideal)[1] * np.array([self.fx, self.fy])[None, :, None]

    def _distorted(self, ideal: Array) -> tuple[Array, Array]:
        """Return distorted normalised coordinates (n, 2) and their derivative (n, 2, 2)."""
        k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y = self._coefficients
        x, y = ideal.T
        r2 = x * x + y * y
        above = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
        radial = above / below
        # derivative of the radial factor with respect to r2
        slope = (k1 + r2 * (2 * k2 + r2 * 3 * k3) - radial * (k4 + r2 * (2 * k5 + r2 * 3 * k6))) / below
        distorted = np.stack(
            [
                x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + r2 * (s1 + r2 * s2),
                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + r2 * (s3 + r2 * s4),
            ],
            axis=1,
        )
        prism_x, prism_y = s1 + 2 * r2 * s2, s3 + 2 * r2 * s4  # with respect to r2
        derivative = np.empty((len(x), 2, 2))
        derivative[:, 0, 0] = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x + 2 * x * prism_x
        derivative[:, 0, 1] = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y + 2 * y * prism_x
        derivative[:, 1, 0] = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y + 2 * x * prism_y
        derivative[:, 1, 1] = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x + 2 * y * prism_y
        if tau_x or tau_y:
            distorted, tilt = _tilted(distorted, tau_x, tau_y)
            derivative = tilt @ derivative
        return distorted, derivative


@dataclass(frozen=True, eq=False)
class Camera:
    """An oriented camera: its station's frame (level, mm) to pixels.

    ``rotation`` (3, 3) turns the station's axes into the camera's (x right, y down, z forward) and
    ``projection_centre`` (3,) is in the station's frame.
    """

    name: str
    interior: Interior
    rotation: Array
    projection_centre: Array

    def project(self, points: Array) -> Array:
        """Return the pixels (n, 2) of points (n, 3); NaN behind the camera or outside its field."""
        return self._project(points)[2]

    def project_with_derivative(self, points: Array) -> tuple[Array, Array]:
        """Return pixels (n, 2) and d pixels / d points (n, 2, 3); the paper's Eqs. 7 and 8 with distortion."""
        local, ideal, pixels = self._project(points)
        with np.errstate(invalid="ignore", divide="ignore"):
            depth = local[:, 2:]
            perspective = np.zeros((len(points), 2, 3))
            perspective[:, 0, 0] = perspective[:, 1, 1] = 1 / depth[:, 0]
            perspective[:, :, 2] = -ideal / depth
        derivative = self.interior.pixel_derivative(ideal, pixels) @ perspective @ self.rotation
        return pixels, derivative

    def rays(self, pixels: Array) -> Array:
        """Return unit directions (n, 3), in the station's frame, of the rays through pixels (n, 2)."""
        ideal = self.interior.ideal(np.asarray(pixels, float).reshape(-1, 2))
        local = np.column_stack([ideal, np.ones(len(ideal))])
        return (local / np.linalg.norm(local, axis=1, keepdims=True)) @ self.rotation

    def sees(self, pixels: Array, margin: float = 0.0) -> NDArray[np.bool_]:
        """Return which pixels (n, 2) lie in the image, at least ``margin`` pixels from its border."""
        size = np.array([self.interior.width, self.interior.height])
        with np.errstate(invalid="ignore"):
            return np.all((pixels >= margin) & (pixels <= size - 1 - margin), axis=-1)

    def _project(self, points: Array) -> tuple[Array, Array, Array]:
        local = (np.asarray(points, float) - self.projection_centre) @ self.rotation.T
        with np.errstate(invalid="ignore", divide="ignore"):
            ideal = np.where(local[:, 2:] > 0, local[:, :2] / local[:, 2:], np.nan)
            return local, ideal, self.interior.pixels(ideal)


def _newton(function: Callable[[Array], tuple[Array, Array]], target: Array, start: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Solve function(x) = target for all rows at once; return x and which rows converged."""
    x = np.array(start, float)
    scale = np.maximum(np.abs(target).max(axis=1, initial=0.0), 1.0)
    residual = np.full(len(x), np.inf)
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_ITERATIONS):
            value, derivative = function(x)
            missing = target - value
            residual = np.abs(missing).max(axis=1)
            x += np.einsum("nij,nj->ni", _inverse_2x2(derivative), missing)
            if not np.any(residual > NEWTON_TOLERANCE * scale):
                break
        return x, residual <= NEWTON_TOLERANCE * scale


def _inverse_2x2(matrices: Array) -> Array:
    (a, b), (c, d) = np.moveaxis(matrices, 0, -1)
    return np.moveaxis(np.array([[d, -b], [-c, a]]) / (a * d - b * c), -1, 0)


def _tilted(points: Array, tau_x: float, tau_y: float) -> tuple[Array, Array]:
    """Apply OpenCV's tilted-sensor homography to (n, 2); return points and derivative (n, 2, 2)."""
    sin_x, cos_x, sin_y, cos_y = np.sin(tau_x), np.cos(tau_x), np.sin(tau_y), np.cos(tau_y)
    rotation = np.array([[cos_y, 0, -sin_y], [0, 1, 0], [sin_y, 0, cos_y]]) @ np.array([[1, 0, 0], [0, cos_x, sin_x], [0, -sin_x, cos_x]])
    onto_sensor = np.array([[rotation[2, 2], 0, -rotation[0, 2]], [0, rotation[2, 2], -rotation[1, 2]], [0, 0, 1]])
    homography = onto_sensor @ rotation
    mapped = np.column_stack([points, np.ones(len(points))]) @ homography.T
    tilted = mapped[:, :2] / mapped[:, 2:]
    derivative = (homography[None, :2, :2] - tilted[:, :, None] * homography[None, None, 2, :2]) / mapped[:, 2, None, None]
    return tilted, derivative
