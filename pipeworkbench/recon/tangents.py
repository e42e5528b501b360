# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicked edges drawn onto the image's subpixel edges, and the tangent planes they span (Fig. 3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.match import match
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.views import View

SNAP_RANGES_PX = (5.0, 4.0, 3.0, 2.0)  # clicks are a few pixels off; the range shrinks as the line settles
LEAST_SUPPORT = 0.3  # part of the samples that must find an edge, else the clicks are taken as they are


@dataclass(frozen=True, eq=False)
class PipeTangents:
    """What one image says of a pipe's axis.

    normals (2, 3) of the tangent planes, away from the pipe; middle (3,) unit ray to the middle of the
    clicked part, in the plane of the axis; across (3,) the direction in that plane perpendicular to
    ``middle``; half_width the angle in radians from ``middle`` to each edge; slope the tangent of the
    axis' tilt that the convergence of the edges suggests; end_rays (2, 3) unit rays at both ends of
    the clicked part, in the plane of the axis; half_length the angle in radians from ``middle`` to them.
    """

    normals: Array
    middle: Array
    across: Array
    half_width: float
    slope: float
    end_rays: Array
    half_length: float

    def misfit(self, cylinders: Cylinders, origin: Array) -> Array:
        """Return how far (k,), in radians, the edges of cylinders lie from the tangent planes at worst.

        A tangent plane is one radius away from the axis: at both ends of the clicked part.
        """
        worst = np.zeros(len(cylinders))
        for ray in self.end_rays:
            along = cylinders.nearest_to_ray(origin, ray)
            offset = cylinders.points + along[:, None] * cylinders.directions - origin
            distance = np.linalg.norm(offset, axis=1)
            for normal in self.normals:
                worst = np.maximum(worst, np.abs(offset @ normal + cylinders.radii) / distance)
        return worst


def tangents_of(view: View, pick: PipePick) -> PipeTangents:
    """Return the tangent planes of a pick after drawing its edges onto the image's."""
    rays = view.camera.rays(pick.edges.reshape(-1, 2)).reshape(2, 2, 3)
    if np.sum(rays[0] * rays[1]) < np.sum(rays[0] * rays[1, ::-1]):
        rays[1] = rays[1, ::-1]  # both edges clicked in the same direction
    normals = np.array([snapped_plane(view, edge) for edge in rays])
    middles = rays.mean(axis=1)
    for k in (0, 1):
        if normals[k] @ middles[1 - k] > 0:
            normals[k] = -normals[k]
    plane = normals[0] - normals[1]
    plane /= np.linalg.norm(plane)

    def into_plane(ray: Array) -> Array:
        inside = ray - (ray @ plane) * plane
        return np.asarray(inside / np.linalg.norm(inside))

    # the part between the outermost clicks of either edge
    start, end = into_plane(rays[:, 0].sum(axis=0)), into_plane(rays[:, 1].sum(axis=0))
    middle = into_plane(start + end)
    across = np.cross(plane, middle)
    if across @ (end - start) < 0:
        across = -across
    half_widths = [np.arctan(-(n @ middle) / (n @ plane)) for n in normals]
    axis = np.cross(normals[0], normals[1])
    if axis @ across < 0:
        axis = -axis
    return PipeTangents(
        normals,
        middle,
        across,
        float(half_widths[0] - half_widths[1]) / 2,
        float(axis @ middle) / max(float(axis @ across), 1e-12),
        np.array([start, end]),
        float(np.arccos(np.clip(start @ end, -1, 1))) / 2,
    )


def snapped_plane(view: View, end_rays: Array) -> Array:
    """Return the unit normal (3,) of the plane through the projection centre and an image edge.

    ``end_rays`` (2, 3) are the rays of two clicked points; edge points near the clicked line, which
    is curved in the image by the distortion, are fitted robustly.
    """
    clicked = np.cross(end_rays[0], end_rays[1])
    clicked /= np.linalg.norm(clicked)
    angle = float(np.arccos(np.clip(end_rays[0] @ end_rays[1], -1, 1)))
    scale = view.camera.interior.pixels_per_radian
    count = int(np.clip(angle * scale / 1.5, 16, 2000))
    fractions = np.linspace(0, 1, count)[:, None]
    chord = end_rays[0] + fractions * (end_rays[1] - end_rays[0])
    normal = clicked
    for reach in SNAP_RANGES_PX:
        inside = chord - (chord @ normal)[:, None] * normal
        pixels, derivative = view.camera.project_with_derivative(view.camera.projection_centre + 1000 * inside)
        across = derivative @ normal
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        matched = match(view.edges, pixels, across, reach)
        if np.count_nonzero(matched.found) < LEAST_SUPPORT * count:
            return clicked
        edge = matched.edge[matched.found]
        rays = view.camera.rays(view.edges.position[edge])
        for _ in range(3):
            misfit = (rays @ normal) * scale
            limit = max(3 * 1.4826 * float(np.median(np.abs(misfit))), 0.3)
            weight = np.clip(1 - (misfit / limit) ** 2, 0, None) ** 2 / view.edges.sigma[edge] ** 2
            _, vectors = np.linalg.eigh((rays * weight[:, None]).T @ rays)
            normal = vectors[:, 0] * np.sign(vectors[:, 0] @ clicked)
    return normal
