# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders: the geometry of an axis with a radius, and how its two edges look from a camera."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.interpolation import NODES, interpolation


@dataclass(frozen=True, eq=False)
class Cylinder:
    """An endless cylinder: a ``point`` (3,) on its axis, the unit ``direction`` (3,), ``radius`` in mm."""

    point: Array
    direction: Array
    radius: float

    def as_many(self) -> Cylinders:
        """Return the cylinder as a batch of one."""
        return Cylinders(self.point[None], self.direction[None], np.array([self.radius]))

    def at(self, along: float) -> Array:
        """Return the axis point (3,) at a signed distance from ``point``."""
        return self.point + along * self.direction


@dataclass(frozen=True, eq=False)
class Cylinders:
    """Many cylinders at once: points (k, 3), unit directions (k, 3), radii (k,)."""

    points: Array
    directions: Array
    radii: Array

    def __len__(self) -> int:
        return len(self.radii)

    def __getitem__(self, rows: NDArray[Any]) -> Cylinders:
        return Cylinders(self.points[rows], self.directions[rows], self.radii[rows])

    def one(self, row: int) -> Cylinder:
        """Return one of them."""
        return Cylinder(self.points[row], self.directions[row], float(self.radii[row]))

    def at(self, along: Array) -> Array:
        """Return an axis point of each (k, 3) at signed distances (k,) from their points, mm."""
        return np.asarray(self.points + along[:, None] * self.directions)

    def nearest_to_ray(self, origin: Array, ray: Array) -> Array:
        """Return where a ray (3,) from ``origin`` (3,) passes nearest to each axis: distances (k,) along it."""
        w = self.points - origin
        b = self.directions @ ray
        return np.asarray((b * (w @ ray) - np.einsum("ki,ki->k", w, self.directions)) / (1 - b**2))


@dataclass(frozen=True, eq=False)
class Contours:
    """Samples of both edges of cylinders in one image.

    The leading axes (k, 2, n) are cylinder, side and sample: position (k, 2, n, 2) pixels, NaN where
    not in the image; normal (k, 2, n, 2) unit, away from the cylinder; gain (k, 2, n) pixels along
    ``normal`` per mm along ``outward`` (k, 2, 3), the surface's normal along each edge.
    """

    position: Array
    normal: Array
    gain: Array
    outward: Array


def joined(parts: Sequence[Cylinders]) -> Cylinders:
    """Return all cylinders of several parts."""
    points, directions, radii = zip(*((part.points, part.directions, part.radii) for part in parts), strict=True)
    return Cylinders(np.concatenate(points), np.concatenate(directions), np.concatenate(radii))


def perpendicular_axes(directions: Array) -> tuple[Array, Array]:
    """Return two arrays of unit vectors (..., 3) that form right-handed frames with directions (..., 3)."""
    helper = np.eye(3)[np.argmin(np.abs(directions), axis=-1)]
    first = np.cross(directions, helper)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    return first, np.cross(directions, first)


def spread(extents: Array, fractions: Array) -> Array:
    """Return positions (k, n) at fractions (n,) of the way along extents (k, 2)."""
    return extents[:, :1] + (extents[:, 1:] - extents[:, :1]) * fractions


def edge_lines(cylinders: Cylinders, projection_centre: Array) -> tuple[Array, Array]:
    """Return the lines on cylinders along which a camera sees their edges.

    Returns
    -------
    points : (k, 2, 3) array
        A point of each edge line, in the cross-section of the cylinder's point; NaN where the
        projection centre is inside the cylinder.
    outward : (k, 2, 3) array
        The surface's normal along each line.
    """
    directions = cylinders.directions
    to_camera = projection_centre - cylinders.points
    to_camera = to_camera - np.einsum("ki,ki->k", to_camera, directions)[:, None] * directions
    distance = np.linalg.norm(to_camera, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        towards = to_camera / distance[:, None]
        sideways = np.cross(directions, towards)
        # tangent from the camera: the radius is perpendicular to the ray, so cos(angle) = radius / distance
        cosine = (cylinders.radii / distance)[:, None]
        sine = np.sqrt(1 - cosine**2)
        outward = np.stack([cosine * towards + sine * sideways, cosine * towards - sine * sideways], axis=1)
    return cylinders.points[:, None, :] + cylinders.radii[:, None, None] * outward, outward


def edge_points(camera: Camera, cylinders: Cylinders, along: Array) -> Array:
    """Return points (k, 2, n, 3) on the edges that a camera sees at signed distances ``along`` (k, n) from the cylinders' points."""
    lines, _ = edge_lines(cylinders, camera.projection_centre)
    return _along_lines(lines, cylinders.directions, along)


def _along_lines(lines: Array, directions: Array, along: Array) -> Array:
    return np.asarray(lines[:, :, None, :] + along[:, None, :, None] * directions[:, None, None, :])


def outlines(camera: Camera, cylinders: Cylinders, along: Array, *, unseen: bool = False) -> tuple[Array, Array]:
    """Return positions and normals (k, 2, n, 2) of the edges as :func:`contours` does, but in less time.

    The normals come from neighbouring samples (n >= 2) instead of derivatives: good enough to search
    along them, not to adjust with. ``unseen`` leaves positions beyond the image's border as they are.
    """
    points = edge_points(camera, cylinders, along)
    position = camera.project(points.reshape(-1, 3)).reshape(len(cylinders), 2, along.shape[1], 2)
    tangent = np.gradient(position, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent /= np.linalg.norm(tangent, axis=3, keepdims=True)
    normal = np.stack([tangent[..., 1], -tangent[..., 0]], axis=3)
    away = np.einsum("kni,kni->kn", position[:, 0] - position[:, 1], normal[:, 0])
    normal *= np.where(away < 0, -1.0, 1.0)[:, None, :, None] * np.array([1.0, -1.0])[None, :, None, None]
    if not unseen:
        position[~camera.sees(position)] = np.nan
    return position, normal


def contours(camera: Camera, cylinders: Cylinders, along: Array, *, unseen: bool = False) -> Contours:
    """Return the edges of cylinders in an image at signed distances ``along`` (k, n) from their points.

    ``unseen`` leaves positions beyond the image's border as they are.
    """
    lines, outward = edge_lines(cylinders, camera.projection_centre)
    points = _along_lines(lines, cylinders.directions, along)
    shape = points.shape[:3]
    position, derivative = camera.project_with_derivative(points.reshape(-1, 3))
    if not unseen:
        np.copyto(position, np.nan, where=~camera.sees(position)[:, None])
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent = _by_motion(derivative, cylinders.directions[:, None, None], shape)
        tangent /= np.sqrt(tangent[0] ** 2 + tangent[1] ** 2)
        across = _by_motion(derivative, outward[:, :, None], shape)
        gain = tangent[1] * across[0] - tangent[0] * across[1]
        sign = np.where(gain < 0, -1.0, 1.0)
    normal = np.stack([tangent[1] * sign, -tangent[0] * sign], axis=3)
    return Contours(position.reshape(*shape, 2), normal, gain * sign, outward)


def smooth_contours(camera: Camera, cylinders: Cylinders, extents: Array, fractions: Array) -> Contours:
    """Return the edges at fractions (n,) of the way along extents (k, 2), as :func:`contours` does, but project a few nodes only.

    Between them all is smooth: along what was clicked the positions are off by less than 0.01 px.
    """
    nodes = contours(camera, cylinders, spread(extents, (1 + NODES) / 2), unseen=True)
    # quantities before samples: one product of matrices for all
    stacked = np.concatenate([np.moveaxis(nodes.position, 3, 2), np.moveaxis(nodes.normal, 3, 2), nodes.gain[:, :, None]], axis=2)
    smooth = stacked @ interpolation(NODES, 2 * fractions - 1)
    position, normal, gain = np.moveaxis(smooth[:, :, :2], 2, 3), np.moveaxis(smooth[:, :, 2:4], 2, 3), smooth[:, :, 4]
    np.copyto(position, np.nan, where=~camera.sees(position)[..., None])
    known = np.isfinite(nodes.gain).reshape(len(cylinders), 2 * len(NODES))
    cut = known.any(axis=1) & ~known.all(axis=1)
    if cut.any():  # those that reach out of the camera's field
        exact = contours(camera, cylinders[cut], spread(extents[cut], fractions))
        position[cut], normal[cut], gain[cut] = exact.position, exact.normal, exact.gain
    return Contours(position, normal, gain, nodes.outward)


def _by_motion(derivative: Array, vectors: Array, shape: tuple[int, ...]) -> Array:
    """Return how points move in the image (2, k, 2, n) by derivatives (k * 2 * n, 2, 3) along vectors, broadcast to (k, 2, n, 3)."""
    by = derivative.transpose(1, 2, 0).reshape(2, 3, *shape)
    return np.asarray(by[:, 0] * vectors[..., 0] + by[:, 1] * vectors[..., 1] + by[:, 2] * vectors[..., 2])


def contour(camera: Camera, cylinder: Cylinder, along: Array) -> Contours:
    """Return the edges of one cylinder (k = 1) at signed distances ``along`` (n,) from its point."""
    return contours(camera, cylinder.as_many(), along[None])
