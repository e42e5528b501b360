# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders: the geometry of an axis with a radius, and how its two edges look from a camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.camera import Array, Camera


@dataclass(frozen=True, eq=False)
class Cylinder:
    """An endless cylinder: a ``point`` (3,) on its axis, the unit ``direction`` (3,), ``radius`` in mm."""

    point: Array
    direction: Array
    radius: float

    def along(self, points: Array) -> Array:
        """Return where points (n, 3) project onto the axis: signed distances (n,) from ``point``."""
        return np.asarray((points - self.point) @ self.direction)

    def at(self, along: float) -> Array:
        """Return the axis point (3,) at a signed distance from ``point``."""
        return self.point + along * self.direction


@dataclass(frozen=True, eq=False)
class Contour:
    """Samples of the two edges of a cylinder in one image; axis 0 is the side of the cylinder.

    position (2, n, 2) pixels, NaN where not in the image; normal (2, n, 2) unit, away from the
    cylinder; point (2, n, 3) the edge-generating points; outward (2, n, 3) the surface normals there;
    gain (2, n) pixels along ``normal`` per mm along ``outward``.
    """

    position: Array
    normal: Array
    point: Array
    outward: Array
    gain: Array


def perpendicular_axes(direction: Array) -> tuple[Array, Array]:
    """Return two unit vectors (3,) that form a right-handed frame with a unit direction (3,)."""
    helper = np.eye(3)[np.argmin(np.abs(direction))]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first)
    return first, np.cross(direction, first)


def edge_lines(centres: Array, directions: Array, radii: Array, projection_centre: Array) -> tuple[Array, Array]:
    """Return the lines on cylinders along which a camera sees their edges.

    Parameters
    ----------
    centres, directions : (k, 3) arrays
        A point on each axis and the unit directions.
    radii : (k,) array
    projection_centre : (3,) array

    Returns
    -------
    points : (k, 2, 3) array
        A point of each edge line, in the cross-section of ``centres``; NaN where the camera is inside.
    outward : (k, 2, 3) array
        Surface normals along each line.
    """
    to_camera = projection_centre - centres
    to_camera = to_camera - np.einsum("ki,ki->k", to_camera, directions)[:, None] * directions
    distance = np.linalg.norm(to_camera, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        towards = to_camera / distance[:, None]
        sideways = np.cross(directions, towards)
        # tangent from the camera: the radius is perpendicular to the ray, so cos(angle) = radius / distance
        cosine = (radii / distance)[:, None]
        sine = np.sqrt(1 - cosine**2)
        outward = np.stack([cosine * towards + sine * sideways, cosine * towards - sine * sideways], axis=1)
    return centres[:, None, :] + radii[:, None, None] * outward, outward


def contour(camera: Camera, cylinder: Cylinder, along: Array) -> Contour:
    """Return the cylinder's edges in an image at signed distances ``along`` (n,) from its point."""
    lines, outward = edge_lines(cylinder.point[None], cylinder.direction[None], np.array([cylinder.radius]), camera.projection_centre)
    points = lines[0][:, None, :] + along[None, :, None] * cylinder.direction
    count = len(along)
    flat, derivative = camera.project_with_derivative(points.reshape(-1, 3))
    flat = np.where(camera.sees(flat)[:, None], flat, np.nan)
    tangent = derivative @ cylinder.direction
    normals = np.repeat(outward[0], count, axis=0)
    position, normal, gain = _normal_and_gain(flat, tangent, derivative, normals)
    return Contour(
        position.reshape(2, count, 2),
        normal.reshape(2, count, 2),
        points,
        normals.reshape(2, count, 3),
        gain.reshape(2, count),
    )


def _normal_and_gain(position: Array, tangent: Array, derivative: Array, outward: Array) -> tuple[Array, Array, Array]:
    """Return positions, image normals away from the cylinder and their gain in px/mm, row by row."""
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent = tangent / np.linalg.norm(tangent, axis=1, keepdims=True)
        normal = np.column_stack([tangent[:, 1], -tangent[:, 0]])
        gain = np.einsum("ni,nij,nj->n", normal, derivative, outward)
        sign = np.where(gain < 0, -1.0, 1.0)
    return position, normal * sign[:, None], gain * sign


def intersect_axes(cylinder: Cylinder, origin: Array, rays: Array) -> Array:
    """Return where rays (n, 3) from ``origin`` (3,) pass nearest to the axis, as distances along it (n,)."""
    w = cylinder.point - origin
    b = rays @ cylinder.direction
    return np.asarray((b * (rays @ w) - cylinder.direction @ w) / (1 - b**2))
