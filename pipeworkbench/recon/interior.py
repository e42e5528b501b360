# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interior orientations: measured pixels to ideal image coordinates and back, with derivatives.

Measured pixels have u right, v down and centres at integers; ideal coordinates are (x/z, y/z) of the
camera frame. In the photogrammetric model measured -> ideal is closed form, in OpenCV's the other way
round; the other direction is iterated, and its derivatives follow by implicit differentiation:
with F(ideal, parameters) = pixels, d ideal = (dF/d ideal)^-1 (d pixels - dF/d parameters d parameters).
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pipeworkbench.recon.inversion import Array, RadialInverse, by_columns, determinant, inverse_2x2, invert, length

FIELD_SAMPLES = 16  # along each side of the image, in search of the widest ray
FIELD_MARGIN = 1.15  # points beyond the image corner's field angle by more than this are not projected
WIDEST_HALF_FIELD = np.radians(85)  # as far as OpenCV's radial polynomial is tabulated
WIDEST_IMAGE = 1.5  # the same for the photogrammetric one, in distances of the image's corner
PROFILE_SAMPLES = 1024  # of a radial polynomial: Newton's method then starts at about 1e-6 of the solution

# OpenCV's coefficients in OpenCV's order: rational radial, decentring, thin prism, tilted sensor
DISTORTION_TERMS = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "tau_x", "tau_y")


@dataclass(frozen=True, eq=False)
class Interior(ABC):
    """Interior orientation of an image of ``width`` x ``height`` pixels."""

    parameter_names: ClassVar[tuple[str, ...]]

    width: int
    height: int

    @property
    @abstractmethod
    def parameters(self) -> Array:
        """The parameters (p,) in the order of ``parameter_names``."""

    @abstractmethod
    def with_parameters(self, values: ArrayLike) -> Self:
        """Return an interior orientation of the same kind and size with other parameters (p,)."""

    @abstractmethod
    def ideal(self, pixels: Array) -> Array:
        """Return the ideal coordinates (n, 2) of measured pixels (n, 2); NaN where no ray leads to the pixel."""

    @abstractmethod
    def pixels(self, ideal: Array) -> Array:
        """Return the measured pixels (n, 2) of ideal coordinates (n, 2); NaN outside the field of view."""

    @abstractmethod
    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:
        """Return d pixels / d ideal (n, 2, 2) where ``ideal`` and ``pixels`` (n, 2) belong together."""

    @abstractmethod
    def parameter_derivative(self, ideal: Array, pixels: Array) -> Array:
        """Return d pixels / d parameters (n, 2, p) at fixed ideal coordinates; ``ideal`` and ``pixels`` (n, 2) belong together."""

    @abstractmethod
    def ideal_derivatives(self, ideal: Array, pixels: Array) -> tuple[Array, Array]:
        """Return d ideal / d pixels (n, 2, 2), and d ideal / d parameters (n, 2, p) at fixed pixels."""

    @functools.cached_property
    def field_radius(self) -> float:
        """Largest distance from the optical axis, in ideal coordinates, that is still projected.

        Distortion polynomials fold back far outside the image; points there must not reappear in it.
        """
        u, v = np.meshgrid(np.linspace(-0.5, self.width - 0.5, FIELD_SAMPLES), np.linspace(-0.5, self.height - 0.5, FIELD_SAMPLES))
        distance = length(self.ideal(np.column_stack([u.ravel(), v.ravel()])))
        return FIELD_MARGIN * float(distance[np.isfinite(distance)].max(initial=0.0))

    @functools.cached_property
    def pixels_per_radian(self) -> float:
        """Principal distance in pixels: the image's scale on the optical axis."""
        axis = np.zeros((1, 2))
        return float(np.sqrt(abs(determinant(self.pixel_derivative(axis, self.pixels(axis)))[0])))

    def border(self, samples: int) -> Array:
        """Return pixels (4 * samples, 2) along the outer edges of the image's outermost pixels, corners included."""
        u, v = np.linspace(-0.5, self.width - 0.5, samples), np.linspace(-0.5, self.height - 0.5, samples)
        level = [np.column_stack([u, np.full(samples, w)]) for w in (v[0], v[-1])]
        upright = [np.column_stack([np.full(samples, w), v]) for w in (u[0], u[-1])]
        return np.concatenate(level + upright)

    def _checked(self, values: ArrayLike) -> list[float]:
        array = np.asarray(values, float)
        if array.shape != (len(self.parameter_names),):
            raise ValueError(f"the parameters are {', '.join(self.parameter_names)}: one number each, not an array of shape {array.shape}")
        return [float(value) for value in array]

    def _outside(self, ideal: Array) -> NDArray[np.bool_]:
        return ~(length(ideal) <= self.field_radius)


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

    parameter_names: ClassVar[tuple[str, ...]] = ("principal_distance", "x0", "y0", "A1", "A2", "B1", "B2", "C1", "C2", "r0")

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

    @property
    def parameters(self) -> Array:  # noqa: D102
        return np.array([self.principal_distance, *self.principal_point, self.A1, self.A2, self.B1, self.B2, self.C1, self.C2, self.r0])

    def with_parameters(self, values: ArrayLike) -> Self:  # noqa: D102
        c, x0, y0, *terms = self._checked(values)
        names = self.parameter_names[3:]
        return replace(self, principal_distance=c, principal_point=(x0, y0), **dict(zip(names, terms, strict=True)))  # type: ignore[arg-type]

    def ideal(self, pixels: Array) -> Array:  # noqa: D102
        return self._corrected(self._image(pixels))[0] / self.principal_distance

    def pixels(self, ideal: Array) -> Array:  # noqa: D102
        target = ideal * np.where(self._outside(ideal), np.nan, self.principal_distance)[:, None]
        image = invert(self._corrected, target, self._radial_inverse.start(target))
        np.copyto(image, np.nan, where=self._radial_inverse.beyond(image)[:, None])
        return (image + self.principal_point) / self.pixel_pitch + self._centre

    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: ARG002, D102
        return inverse_2x2(self._corrected(self._image(pixels))[1]) * (self.principal_distance / self.pixel_pitch)

    def parameter_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: D102
        by_pixels, by_parameters = self.ideal_derivatives(ideal, pixels)
        return -inverse_2x2(by_pixels) @ by_parameters

    def ideal_derivatives(self, ideal: Array, pixels: Array) -> tuple[Array, Array]:  # noqa: D102
        image = self._image(pixels)
        by_image = self._corrected(image)[1] / self.principal_distance
        x, y = image.T
        r2 = x * x + y * y
        by_distortion = np.zeros((len(x), 2, 7))  # d (dx, dy) / d (A1, A2, B1, B2, C1, C2, r0)
        by_distortion[:, :, 0] = image * (r2 - self.r0**2)[:, None]
        by_distortion[:, :, 1] = image * (r2 * r2 - self.r0**4)[:, None]
        by_distortion[:, 0, 2], by_distortion[:, 1, 2] = r2 + 2 * x * x, 2 * x * y
        by_distortion[:, 0, 3], by_distortion[:, 1, 3] = 2 * x * y, r2 + 2 * y * y
        by_distortion[:, 0, 4], by_distortion[:, 0, 5] = x, y
        by_distortion[:, :, 6] = image * (-2 * self.A1 * self.r0 - 4 * self.A2 * self.r0**3)
        by_parameters = np.concatenate([-(ideal / self.principal_distance)[:, :, None], -by_image, -by_distortion / self.principal_distance], axis=2)
        return by_image * self.pixel_pitch, by_parameters

    @property
    def _centre(self) -> Array:
        return np.array([(self.width - 1) / 2, (self.height - 1) / 2])

    @functools.cached_property
    def _radial_inverse(self) -> RadialInverse:
        corner = length(self._image(self.border(2))).max()
        radius = np.linspace(0, WIDEST_IMAGE * corner, PROFILE_SAMPLES)
        return RadialInverse.of(radius, radius * (1 - self._radial(radius * radius)))

    def _image(self, pixels: Array) -> Array:
        return (pixels - self._centre) * self.pixel_pitch - np.asarray(self.principal_point)

    def _radial(self, r2: Array) -> Array:
        return self.A1 * (r2 - self.r0**2) + self.A2 * (r2 * r2 - self.r0**4)

    def _corrected(self, image: Array) -> tuple[Array, Array]:
        """Return image coordinates without distortion (n, 2) and their derivative (n, 2, 2)."""
        x, y = image.T
        r2 = x * x + y * y
        slope = 2 * self.A1 + 4 * self.A2 * r2  # d radial / dx = x * slope, d radial / dy = y * slope
        # the docstring's formulas with what is common to x and y, and its derivatives, taken out
        shrunk = (1 + self.A1 * self.r0**2 + self.A2 * self.r0**4) - r2 * (self.A1 + self.A2 * r2) - 2 * (self.B1 * x + self.B2 * y)
        by_x, by_y = x * slope + 2 * self.B1, y * slope + 2 * self.B2
        corrected, derivative = by_columns(len(x))
        corrected[:, 0] = x * (shrunk - self.C1) - self.B1 * r2 - self.C2 * y
        corrected[:, 1] = y * shrunk - self.B2 * r2
        derivative[:, 0, 0] = shrunk - x * (by_x + 2 * self.B1) - self.C1
        derivative[:, 0, 1] = -x * by_y - 2 * self.B1 * y - self.C2
        derivative[:, 1, 0] = -y * by_x - 2 * self.B2 * x
        derivative[:, 1, 1] = shrunk - y * (by_y + 2 * self.B2)
        return corrected, derivative


@dataclass(frozen=True, eq=False)
class OpenCVInterior(Interior):
    """OpenCV's pinhole model: focal lengths and principal point in pixels, up to 14 distortion terms.

    ``distortion`` is in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 taux tauy, padded with zeros.
    The formulas are those of OpenCV's reference, module calib3d, "Detailed Description".
    """

    parameter_names: ClassVar[tuple[str, ...]] = ("fx", "fy", "cx", "cy", *DISTORTION_TERMS)

    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()
    _coefficients: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_coefficients", np.concatenate([self.distortion, np.zeros(len(DISTORTION_TERMS) - len(self.distortion))]))

    @property
    def parameters(self) -> Array:  # noqa: D102
        return np.array([self.fx, self.fy, self.cx, self.cy, *self._coefficients])

    def with_parameters(self, values: ArrayLike) -> Self:  # noqa: D102
        fx, fy, cx, cy, *terms = self._checked(values)
        # as many terms as before where that is enough, so that a five-term calibration stays one
        used = len(self.distortion) if not any(terms[len(self.distortion) :]) else len(terms)
        return replace(self, fx=fx, fy=fy, cx=cx, cy=cy, distortion=tuple(terms[:used]))

    def ideal(self, pixels: Array) -> Array:  # noqa: D102
        target = (pixels - (self.cx, self.cy)) / (self.fx, self.fy)
        if not self._coefficients.any():
            return target
        if self._is_tilted:
            target = _mapped(target, np.linalg.inv(self._tilt[0]))
        ideal = invert(self._upright, target, self._radial_inverse.start(target))
        ideal[self._radial_inverse.beyond(ideal)] = np.nan
        return ideal

    def pixels(self, ideal: Array) -> Array:  # noqa: D102
        distorted, derivative = self._distorted(np.where(self._outside(ideal)[:, None], np.nan, ideal))
        pixels = distorted * (self.fx, self.fy) + (self.cx, self.cy)
        pixels[~(determinant(derivative) > 0)] = np.nan  # behind the fold
        return pixels

    def pixel_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: ARG002, D102
        return self._distorted(ideal)[1] * np.array([self.fx, self.fy])[:, None]

    def parameter_derivative(self, ideal: Array, pixels: Array) -> Array:  # noqa: D102
        x, y = ideal.T
        r2 = x * x + y * y
        radial, below = self._radial(r2)
        by_terms = np.zeros((len(x), 2, 14))  # of the distorted coordinates, by k1 k2 p1 p2 k3 ... s4 tau_x tau_y
        for term, power in ((0, r2), (1, r2**2), (4, r2**3)):
            by_terms[:, :, term] = ideal * (power / below)[:, None]
        for term, power in ((5, r2), (6, r2**2), (7, r2**3)):
            by_terms[:, :, term] = ideal * (-radial * power / below)[:, None]
        by_terms[:, 0, 2] = by_terms[:, 1, 3] = 2 * x * y
        by_terms[:, 1, 2], by_terms[:, 0, 3] = r2 + 2 * y * y, r2 + 2 * x * x
        by_terms[:, 0, 8] = by_terms[:, 1, 10] = r2
        by_terms[:, 0, 9] = by_terms[:, 1, 11] = r2**2
        homography, *by_angles = self._tilt
        upright = self._upright(ideal)[0]
        if self._is_tilted:
            by_terms[:, :, :12] = _mapped_derivative(upright, homography) @ by_terms[:, :, :12]
        tilted = _mapped(upright, homography)
        weight = _homogeneous(upright) @ homography[2]
        for term, by_angle in zip((12, 13), by_angles, strict=True):
            moved = _homogeneous(upright) @ by_angle.T
            by_terms[:, :, term] = (moved[:, :2] - tilted * moved[:, 2:]) / weight[:, None]
        by_parameters = np.zeros((len(x), 2, 18))
        by_parameters[:, 0, 0], by_parameters[:, 1, 1] = ((pixels - (self.cx, self.cy)) / (self.fx, self.fy)).T
        by_parameters[:, 0, 2] = by_parameters[:, 1, 3] = 1
        by_parameters[:, :, 4:] = by_terms * np.array([self.fx, self.fy])[:, None]
        by_parameters[np.isnan(pixels).any(axis=1)] = np.nan
        return by_parameters

    def ideal_derivatives(self, ideal: Array, pixels: Array) -> tuple[Array, Array]:  # noqa: D102
        by_pixels = inverse_2x2(self.pixel_derivative(ideal, pixels))
        return by_pixels, -by_pixels @ self.parameter_derivative(ideal, pixels)

    @functools.cached_property
    def _radial_inverse(self) -> RadialInverse:
        radius = np.tan(np.linspace(0, WIDEST_HALF_FIELD, PROFILE_SAMPLES))
        with np.errstate(all="ignore"):
            radial, below = self._radial(radius * radius)
            value = np.where(np.minimum.accumulate(below) > 0, radius * radial, np.nan)
        return RadialInverse.of(radius, value)

    @functools.cached_property
    def _tilt(self) -> tuple[Array, Array, Array]:
        """The homography (3, 3) of the tilted sensor and its derivatives by tau_x and tau_y."""
        tau_x, tau_y = self._coefficients[12:]
        about_x, about_y = _about_x(tau_x), _about_y(tau_y)
        rotations = (about_y @ about_x, about_y @ _about_x(tau_x, 1), _about_y(tau_y, 1) @ about_x)
        onto_sensor, *by_angles = (np.array([[r[2, 2], 0, -r[0, 2]], [0, r[2, 2], -r[1, 2]], [0, 0, 0]]) for r in rotations)
        onto_sensor[2, 2] = 1
        by_tau_x, by_tau_y = (by @ rotations[0] + onto_sensor @ turned for by, turned in zip(by_angles, rotations[1:], strict=True))
        return onto_sensor @ rotations[0], by_tau_x, by_tau_y

    @property
    def _is_tilted(self) -> bool:
        return bool(self._coefficients[12:].any())

    def _radial(self, r2: Array) -> tuple[Array, Array]:
        """Return the radial factor (n,) and its denominator (n,)."""
        k1, k2, _, _, k3, k4, k5, k6 = self._coefficients[:8]
        below = 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
        return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / below, below

    def _upright(self, ideal: Array) -> tuple[Array, Array]:
        """Return normalised coordinates (n, 2) distorted but for the tilt, and their derivative (n, 2, 2)."""
        k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = self._coefficients[:12]
        x, y = ideal.T
        r2 = x * x + y * y
        radial, below = self._radial(r2)
        # derivative of the radial factor with respect to r2
        slope = (k1 + r2 * (2 * k2 + r2 * 3 * k3) - radial * (k4 + r2 * (2 * k5 + r2 * 3 * k6))) / below
        distorted, derivative = by_columns(len(x))
        distorted[:, 0] = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + r2 * (s1 + r2 * s2)
        distorted[:, 1] = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + r2 * (s3 + r2 * s4)
        prism_x, prism_y = s1 + 2 * r2 * s2, s3 + 2 * r2 * s4  # with respect to r2
        mixed = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y
        derivative[:, 0, 0] = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x + 2 * x * prism_x
        derivative[:, 0, 1] = mixed + 2 * y * prism_x
        derivative[:, 1, 0] = mixed + 2 * x * prism_y
        derivative[:, 1, 1] = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x + 2 * y * prism_y
        return distorted, derivative

    def _distorted(self, ideal: Array) -> tuple[Array, Array]:
        """Return distorted normalised coordinates (n, 2) and their derivative (n, 2, 2)."""
        distorted, derivative = self._upright(ideal)
        if not self._is_tilted:
            return distorted, derivative
        homography = self._tilt[0]
        return _mapped(distorted, homography), _mapped_derivative(distorted, homography) @ derivative


def _about_x(angle: float, order: int = 0) -> Array:
    """Return OpenCV's rotation (3, 3) about x, or its derivative of this order by the angle."""
    cos, sin = np.cos(angle + order * np.pi / 2), np.sin(angle + order * np.pi / 2)
    return np.array([[0.0 if order else 1.0, 0, 0], [0, cos, sin], [0, -sin, cos]])


def _about_y(angle: float, order: int = 0) -> Array:
    """Return OpenCV's rotation (3, 3) about y, or its derivative of this order by the angle."""
    cos, sin = np.cos(angle + order * np.pi / 2), np.sin(angle + order * np.pi / 2)
    return np.array([[cos, 0, -sin], [0, 0.0 if order else 1.0, 0], [sin, 0, cos]])


def _homogeneous(points: Array) -> Array:
    return np.column_stack([points, np.ones(len(points))])


def _mapped(points: Array, homography: Array) -> Array:
    """Apply a homography (3, 3) to points (n, 2)."""
    mapped = _homogeneous(points) @ homography.T
    return mapped[:, :2] / mapped[:, 2:]


def _mapped_derivative(points: Array, homography: Array) -> Array:
    """Return the derivative (n, 2, 2) of a homography (3, 3) at points (n, 2)."""
    weight = _homogeneous(points) @ homography[2]
    return (homography[None, :2, :2] - _mapped(points, homography)[:, :, None] * homography[None, None, 2, :2]) / weight[:, None, None]
