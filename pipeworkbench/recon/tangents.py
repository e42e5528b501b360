# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicked edges drawn onto the image's subpixel edges, and the tangent planes they span (Fig. 3)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, edge_lines
from pipeworkbench.recon.match import edges_along_normals
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.views import View

CLICK_SIGMA_PX = 1.5  # how far a click is off the edge it means
SNAPPED_SIGMA_PX = 0.3  # of a plane drawn onto its edge, shading and roughness included
VOTE_RANGE_PX, VOTE_STEP_PX, VOTE_SIGMA_PX = 4.5, 0.5, 0.5
VOTES_TO_LOG = 12.0  # weight of full support against the clicks' prior: some 4 px in all
POLARITY_BINS = 12  # along a clicked edge: backgrounds change
LEAST_VOTES = 0.2  # support below which the clicks are taken as they are


@dataclass(frozen=True, eq=False)
class PipeTangents:
    """What one image says of a pipe's axis.

    normals (2, 3) of the tangent planes, away from the pipe; middle (3,) unit ray to the middle of the
    clicked part, in the plane of the axis; across (3,) the direction in that plane perpendicular to
    ``middle``; half_width the angle in radians from ``middle`` to each edge; slope the tangent of the
    axis' tilt that the convergence of the edges suggests; end_rays (2, 3) unit rays at both ends of
    the clicked part, in the plane of the axis; half_length the angle in radians from ``middle`` to them;
    sigma_px the standard deviation of the apparent width in px; polarity (2, POLARITY_BINS) the mean
    sign of the brightness step away from the pipe, along either edge from start to end.
    """

    normals: Array
    middle: Array
    across: Array
    half_width: float
    slope: float
    end_rays: Array
    half_length: float
    sigma_px: float
    polarity: Array

    def polarity_of(self, cylinders: Cylinders, origin: Array, samples: int) -> Array:
        """Return the polarity (2, samples) along the sides of cylinders as :func:`contours` orders them."""
        _, outward = edge_lines(cylinders[np.arange(1)], origin)
        sides = self.polarity if outward[0, 0] @ self.normals[0] > outward[0, 1] @ self.normals[0] else self.polarity[::-1]
        bins = np.minimum((np.linspace(0, 1, samples) * POLARITY_BINS).astype(int), POLARITY_BINS - 1)
        return np.asarray(sides[:, bins])

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
    middles = rays.mean(axis=1)
    snapped = [snapped_edge(view, rays[k]).turned_away_from(middles[1 - k]) for k in (0, 1)]
    normals = np.array([edge.normal for edge in snapped])
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
        float(np.hypot(snapped[0].sigma_px, snapped[1].sigma_px)),
        np.array([edge.polarity for edge in snapped]),
    )


@dataclass(frozen=True, eq=False)
class SnappedEdge:
    """A clicked edge after it was drawn onto the image.

    normal (3,): unit normal of the plane through the projection centre and the edge; sigma_px: its
    standard deviation across the edge, the clicks' where no edge supports them; polarity (POLARITY_BINS,):
    along the edge, the mean sign of the brightness step towards ``normal``.
    """

    normal: Array
    sigma_px: float
    polarity: Array

    def turned_away_from(self, ray: Array) -> SnappedEdge:
        """Return the same edge with its normal pointing away from a ray (3,)."""
        return self if self.normal @ ray <= 0 else replace(self, normal=-self.normal, polarity=-self.polarity)


def snapped_edge(view: View, end_rays: Array) -> SnappedEdge:
    """Draw a clicked line onto the image edge it means.

    Every edge point near the line votes for the lines through it, over the offsets of both ends; the
    votes are weighed with how far a click is likely to be off, and the winner is fitted robustly.

    Parameters
    ----------
    view : View
    end_rays : (2, 3) array
        Unit rays of the two clicked points.
    """
    clicked = np.cross(end_rays[0], end_rays[1])
    clicked /= np.linalg.norm(clicked)
    angle = float(np.arccos(np.clip(end_rays[0] @ end_rays[1], -1, 1)))
    scale = view.camera.interior.pixels_per_radian
    count = int(np.clip(angle * scale / 1.5, 16, 400))
    fraction = np.linspace(0, 1, count)
    # the line is curved in the image where the lens distorts: sample the plane, not the chord
    chord = end_rays[0] + fraction[:, None] * (end_rays[1] - end_rays[0])
    pixels, derivative = view.camera.project_with_derivative(view.camera.projection_centre + 1000 * chord)
    across = derivative @ clicked
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    sample, edge, distance = edges_along_normals(view.edges, pixels, across, VOTE_RANGE_PX)
    if not len(sample):
        return SnappedEdge(clicked, CLICK_SIGMA_PX, np.zeros(POLARITY_BINS))
    offsets = np.arange(-VOTE_RANGE_PX, VOTE_RANGE_PX + VOTE_STEP_PX, VOTE_STEP_PX)
    first, last = (x.ravel() for x in np.meshgrid(offsets, offsets))
    line = first[:, None] + (last - first)[:, None] * fraction[sample]
    votes = np.exp(-((distance - line) ** 2) / (2 * VOTE_SIGMA_PX**2)).sum(axis=1) / count
    score = VOTES_TO_LOG * votes - (first**2 + last**2) / (2 * CLICK_SIGMA_PX**2)
    best = int(np.argmax(score))
    if votes[best] < LEAST_VOTES:
        return SnappedEdge(clicked, CLICK_SIGMA_PX, np.zeros(POLARITY_BINS))

    inlier = np.abs(distance - line[best]) < 3 * VOTE_SIGMA_PX
    sample, edge = sample[inlier], edge[inlier]
    sign = np.sign(np.einsum("ij,ij->i", view.edges.normal[edge], across[sample]))
    bins = np.minimum((fraction[sample] * POLARITY_BINS).astype(int), POLARITY_BINS - 1)
    seen = np.bincount(bins, minlength=POLARITY_BINS)
    # one imaginary observation of either sign: a bin with few edges says little
    polarity = np.bincount(bins, sign, POLARITY_BINS) / (seen + 2)
    rays = view.camera.rays(view.edges.position[edge])
    misfit = distance[inlier] - line[best][inlier]
    normal = clicked
    for _ in range(4):
        limit = max(3 * 1.4826 * float(np.median(np.abs(misfit))), 0.3)
        weight = np.clip(1 - (misfit / limit) ** 2, 0, None) ** 2 / view.edges.sigma[edge] ** 2
        _, vectors = np.linalg.eigh((rays * weight[:, None]).T @ rays)
        normal = vectors[:, 0] * np.sign(vectors[:, 0] @ clicked)
        misfit = (rays @ normal) * scale
    return SnappedEdge(normal, SNAPPED_SIGMA_PX, polarity)
