# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cameras: an interior and an exterior orientation; projection and image rays, with derivatives.

The exterior orientation's six parameters are the projection centre (mm, in the station's frame) and a
small rotation vector w (radians) in the camera's frame: rotation_new = exp([w]x) rotation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.interior import Interior, OpenCVInterior, PhotogrammetricInterior
from pipeworkbench.recon.inversion import Array

__all__ = ["Array", "Camera", "Interior", "OpenCVInterior", "PhotogrammetricInterior", "Projection", "Rays"]


@dataclass(frozen=True, eq=False)
class Projection:
    """Projected points and their derivatives; NaN outside the field of view.

    Attributes
    ----------
    pixels : (n, 2) array
        The projections.
    by_point : (n, 2, 3) array
        Derivatives by the points' coordinates, px / mm.
    by_exterior : (n, 2, 6) array
        Derivatives by the projection centre, px / mm, and the rotation vector, px / rad.
    by_interior : (n, 2, p) array
        Derivatives by the interior orientation's parameters, in the order of their ``parameter_names``.
    """

    pixels: Array
    by_point: Array
    by_exterior: Array
    by_interior: Array


@dataclass(frozen=True, eq=False)
class Rays:
    """Directions of image rays and their derivatives; NaN where no ray leads to a pixel.

    Attributes
    ----------
    directions : (n, 3) array
        Unit vectors in the station's frame; the rays start at the projection centre.
    by_pixel : (n, 3, 2) array
        Derivatives by the pixels' coordinates, 1 / px.
    by_exterior : (n, 3, 6) array
        Derivatives by the projection centre, which are zero, and by the rotation vector, 1 / rad.
    by_interior : (n, 3, p) array
        Derivatives by the interior orientation's parameters, in the order of their ``parameter_names``.
    """

    directions: Array
    by_pixel: Array
    by_exterior: Array
    by_interior: Array


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
        return pixels, self._turned(self._derivative(local, ideal, pixels))

    def project_with_derivatives(self, points: Array) -> Projection:
        """Project points (n, 3) with the derivatives by the points and by every parameter of the camera."""
        local, ideal, pixels = self._project(points)
        by_local = self._derivative(local, ideal, pixels)
        by_point = self._turned(by_local)
        # a turned camera sees the point at local + w x local, and g (w x l) = w (l x g)
        by_exterior = np.concatenate([-by_point, np.cross(local[:, None, :], by_local)], axis=2)
        return Projection(pixels, by_point, by_exterior, self.interior.parameter_derivative(ideal, pixels))

    def rays(self, pixels: Array) -> Array:
        """Return unit directions (n, 3), in the station's frame, of the rays through pixels (n, 2)."""
        local, distance = self._local_rays(self.interior.ideal(_pixels(pixels)))
        return (local / distance) @ self.rotation

    def rays_with_derivatives(self, pixels: Array) -> Rays:
        """Return the rays through pixels (n, 2) with the derivatives by the pixels and by every parameter of the camera."""
        pixels = _pixels(pixels)
        ideal = self.interior.ideal(pixels)
        local, distance = self._local_rays(ideal)
        unit = local / distance
        # d (l / |l|) = (I - u u^T) / |l| dl, of which the ideal coordinates are the first two columns
        by_ideal = (np.eye(3)[:, :2] - unit[:, :, None] * unit[:, None, :2]) / distance[:, :, None]
        by_ideal = self.rotation.T @ by_ideal
        ideal_by_pixel, ideal_by_interior = self.interior.ideal_derivatives(ideal, pixels)
        # of R^T exp(-[w]x) u: R^T (u x e) for the axes e, which are the rows that cross() runs over
        turned = np.swapaxes(np.cross(unit[:, None, :], np.eye(3)), 1, 2)
        by_exterior = np.concatenate([np.zeros_like(turned), self.rotation.T @ turned], axis=2)
        return Rays(unit @ self.rotation, by_ideal @ ideal_by_pixel, by_exterior, by_ideal @ ideal_by_interior)

    def moved(self, delta: ArrayLike) -> Camera:
        """Return the camera with its exterior orientation changed by (6,): projection centre (mm), rotation vector (rad)."""
        delta = np.asarray(delta, float)
        turned = Rotation.from_rotvec(delta[3:]).as_matrix() @ self.rotation
        return replace(self, rotation=turned, projection_centre=self.projection_centre + delta[:3])

    def placed(self, b_from_a: Array) -> Camera:
        """Return the camera of frame a in frame b, for the 4 x 4 motion from a to b."""
        turn, shift = b_from_a[:3, :3], b_from_a[:3, 3]
        return replace(self, rotation=self.rotation @ turn.T, projection_centre=turn @ self.projection_centre + shift)

    def sees(self, pixels: Array, margin: float = 0.0) -> NDArray[np.bool_]:
        """Return which pixels (n, 2) lie in the image, at least ``margin`` pixels from its border."""
        u, v = pixels[..., 0], pixels[..., 1]
        right, bottom = self.interior.width - 1 - margin, self.interior.height - 1 - margin
        with np.errstate(invalid="ignore"):
            return (u >= margin) & (u <= right) & (v >= margin) & (v <= bottom)

    def _project(self, points: Array) -> tuple[Array, Array, Array]:
        """Return points in the camera's frame (n, 3), ideal coordinates and pixels (n, 2); the latter NaN where not seen."""
        # transposed, so that each coordinate is in one piece for what follows
        local = (self.rotation @ (np.asarray(points, float) - self.projection_centre).T).T
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            depth = np.where(local[:, 2] > 0, local[:, 2], np.nan)
            ideal = (local[:, :2].T / depth).T
            pixels = self.interior.pixels(ideal)
        np.copyto(ideal, np.nan, where=np.isnan(pixels))
        return local, ideal, pixels

    def _derivative(self, local: Array, ideal: Array, pixels: Array) -> Array:
        """Return d pixels / d local (n, 2, 3)."""
        by_ideal = self.interior.pixel_derivative(ideal, pixels).transpose(1, 2, 0)
        by_local = np.empty((2, 3, len(local)))
        # d (x / z, y / z) = (dx, dy) / z - (x, y) / z dz / z
        with np.errstate(invalid="ignore", divide="ignore"):
            by_local[:, :2] = by_ideal / local[:, 2]
            by_local[:, 2] = -(by_local[:, 0] * ideal[:, 0] + by_local[:, 1] * ideal[:, 1])
        return by_local.transpose(2, 0, 1)

    def _turned(self, by_local: Array) -> Array:
        """Return derivatives (n, 2, 3) by the station's coordinates from those by the camera's: one product for all points."""
        return (self.rotation.T @ by_local.transpose(1, 2, 0)).transpose(2, 0, 1)

    @staticmethod
    def _local_rays(ideal: Array) -> tuple[Array, Array]:
        """Return directions (n, 3) in the camera's frame and their lengths (n, 1)."""
        local = np.column_stack([ideal, np.ones(len(ideal))])
        return local, np.linalg.norm(local, axis=1, keepdims=True)


def _pixels(pixels: Array) -> Array:
    return np.asarray(pixels, float).reshape(-1, 2)
