# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicked edges drawn onto the image's subpixel edges, and the tangent planes they span (Fig. 3).

Beside a limb there often are other edges: stains, highlights, mortar. Which one was meant, the image
alone does not tell, so that a click gives several tangent planes; the other images decide.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, edge_lines
from pipeworkbench.recon.match import edges_along_normals
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.views import View

CLICK_SIGMA_PX = 1.5  # how far a click is off the edge it means
SNAPPED_SIGMA_PX = 0.3  # of a plane drawn onto its edge, shading and roughness included
VOTE_RANGE_PX, VOTE_STEP_PX, VOTE_SIGMA_PX = 5.0, 0.5, 0.5
VOTES_TO_LOG = 12.0  # weight of full support against the clicks' prior: some 4 px in all
LEAST_VOTES = 0.2  # support below which the clicks are taken as they are
APART_PX = 1.5  # two edges nearer than this at both ends are one
EDGES_EACH, ALTERNATIVES = 4, 8  # at most: edges that one clicked line could mean, and pairs of them
WORST_ALTERNATIVE = 7.0  # how much less likely than the best an edge may be (logarithm)
SLIP = 2.0  # standard deviations from which on a click's error is a slip


@dataclass(frozen=True, eq=False)
class PipeTangents:
    """What one image says of a pipe's axis.

    normals (2, 3) of the tangent planes, away from the pipe; middle (3,) unit ray to the middle of the
    clicked part, in the plane of the axis; across (3,) the direction in that plane perpendicular to
    ``middle``; half_width the angle in radians from ``middle`` to each edge; slope the tangent of the
    axis' tilt that the convergence of the edges suggests; end_rays (2, 3) unit rays at both ends of
    the clicked part, in the plane of the axis; half_length the angle in radians from ``middle`` to them;
    sigma_px the standard deviation of the apparent width in px, sigma_slope that of the slope; clicks (4, 3) unit rays of the clicked points,
    two for each normal.
    """

    normals: Array
    middle: Array
    across: Array
    half_width: float
    slope: float
    end_rays: Array
    half_length: float
    sigma_px: float
    sigma_slope: float
    clicks: Array

    def cylinders_at(self, origin: Array, depth: Array, slope: Array) -> Cylinders:
        """Return the cylinders (k) that touch the planes, ``depth`` (k,) mm along ``middle`` and tilted by the tangent ``slope`` (k,)."""
        tilt = np.arctan(slope)
        # the tangent planes, opened by the tilt: tan(angle about the axis) = tan(half width) / cos(tilt)
        radii = depth * np.cos(tilt) * np.sin(np.arctan(np.tan(self.half_width) / np.cos(tilt)))
        directions = np.cos(tilt)[:, None] * self.across + np.sin(tilt)[:, None] * self.middle
        return Cylinders(origin + depth[:, None] * self.middle, directions, radii)

    def click_prior(self, cylinders: Cylinders, origin: Array, pixels_per_radian: float) -> Array:
        """Return the logarithm (k,) of how likely the clicks are, made to hit the edges of each cylinder."""
        _, outward = edge_lines(cylinders, origin)
        off = np.einsum("ksi,ci->ksc", outward, self.clicks) * pixels_per_radian / CLICK_SIGMA_PX
        # a slip of the hand is rarer than the normal distribution's middle tells, but not as rare as its tail
        loss = np.where(np.abs(off) < SLIP, off**2 / 2, SLIP * (np.abs(off) - SLIP / 2))
        # either side may be the first edge
        as_ordered = loss[:, 0, :2].sum(axis=1) + loss[:, 1, 2:].sum(axis=1)
        turned = loss[:, 1, :2].sum(axis=1) + loss[:, 0, 2:].sum(axis=1)
        return np.asarray(-np.fmin(as_ordered, turned))


def tangents_of(view: View, pick: PipePick) -> PipeTangents:
    """Return the most likely tangent planes of a pick after drawing its edges onto the image's."""
    return all_tangents_of(view, pick)[0]


def all_tangents_of(view: View, pick: PipePick) -> tuple[PipeTangents, ...]:
    """Return the tangent planes that a pick could mean, the most likely first, at most ``ALTERNATIVES``."""
    rays = view.camera.rays(pick.edges.reshape(-1, 2)).reshape(2, 2, 3)
    if np.sum(rays[0] * rays[1]) < np.sum(rays[0] * rays[1, ::-1]):
        rays[1] = rays[1, ::-1]  # both edges clicked in the same direction
    edges = [snapped_edges(view, rays[k]) for k in (0, 1)]
    pairs = sorted(itertools.product(edges[0], edges[1]), key=lambda pair: -(pair[0].likelihood + pair[1].likelihood))
    least = pairs[0][0].likelihood + pairs[0][1].likelihood - WORST_ALTERNATIVE
    return tuple(_tangents(view, pair, rays) for pair in pairs[:ALTERNATIVES] if pair[0].likelihood + pair[1].likelihood >= least)


def _tangents(view: View, pair: tuple[SnappedEdge, SnappedEdge], rays: Array) -> PipeTangents:
    """Return the tangent planes of two edges, clicked at rays (2, 2, 3)."""
    middles = rays.mean(axis=1)
    normals = np.array([edge.normal_away_from(middles[1 - k]) for k, edge in enumerate(pair)])
    plane = normals[0] - normals[1]
    plane /= np.linalg.norm(plane)
    middle = rays.sum(axis=(0, 1))
    middle -= (middle @ plane) * plane
    middle /= np.linalg.norm(middle)
    across = np.cross(plane, middle)
    if across @ (rays[0, 1] - rays[0, 0]) < 0:
        across = -across
    # the pipe lies between the outermost clicks of either edge: where one is hidden, the other was clicked
    angle = np.arctan2(rays @ across, rays @ middle)
    start, end = (np.cos(a) * middle + np.sin(a) * across for a in (angle.min(), angle.max()))
    middle = (start + end) / np.linalg.norm(start + end)
    across = np.cross(plane, middle) * np.sign(np.cross(plane, middle) @ (end - start))
    half_widths = [np.arctan(-(n @ middle) / (n @ plane)) for n in normals]
    half_width = float(half_widths[0] - half_widths[1]) / 2
    axis = np.cross(normals[0], normals[1])
    if axis @ across < 0:
        axis = -axis
    # an edge's direction is known from its two ends, the slope from the difference of both directions
    scale = view.camera.interior.pixels_per_radian
    turns = [np.sqrt(2) * edge.sigma_px / scale / length for edge, length in zip(pair, np.ptp(angle, axis=1), strict=True)]
    return PipeTangents(
        normals,
        middle,
        across,
        half_width,
        float(axis @ middle) / max(float(axis @ across), 1e-12),
        np.array([start, end]),
        float(angle.max() - angle.min()) / 2,
        float(np.hypot(pair[0].sigma_px, pair[1].sigma_px)),
        float(np.hypot(*turns)) / (2 * half_width),
        rays.reshape(4, 3),
    )


@dataclass(frozen=True, eq=False)
class SnappedEdge:
    """A clicked edge after it was drawn onto the image.

    normal (3,): unit normal of the plane through the projection centre and the edge; sigma_px: its
    standard deviation across the edge, the clicks' where no edge supports them; likelihood: the
    logarithm of how likely it is the one meant, up to a constant.
    """

    normal: Array
    sigma_px: float
    likelihood: float

    def normal_away_from(self, ray: Array) -> Array:
        """Return the normal so that it points away from a ray (3,)."""
        return self.normal if self.normal @ ray <= 0 else -self.normal


def snapped_edges(view: View, end_rays: Array) -> list[SnappedEdge]:
    """Return the image edges that a clicked line could mean, the most likely first.

    Every edge point near the line votes for the lines through it, over the offsets of both ends; the
    votes are weighed with how far a click is likely to be off, and the best lines are fitted robustly.

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
        return [SnappedEdge(clicked, CLICK_SIGMA_PX, 0.0)]
    offsets = np.arange(-VOTE_RANGE_PX, VOTE_RANGE_PX + VOTE_STEP_PX / 2, VOTE_STEP_PX)
    first, last = (x.ravel() for x in np.meshgrid(offsets, offsets))
    line = first[:, None] + (last - first)[:, None] * fraction[sample]
    votes = np.exp(-((distance - line) ** 2) / (2 * VOTE_SIGMA_PX**2)).sum(axis=1) / count
    score = VOTES_TO_LOG * votes - (first**2 + last**2) / (2 * CLICK_SIGMA_PX**2)
    found: list[SnappedEdge] = []
    free = votes >= LEAST_VOTES
    while free.any() and len(found) < EDGES_EACH:
        best = int(np.argmax(np.where(free, score, -np.inf)))
        if found and score[best] < found[0].likelihood - WORST_ALTERNATIVE:
            break
        inlier = np.abs(distance - line[best]) < 3 * VOTE_SIGMA_PX
        normal = _fitted(view, edge[inlier], distance[inlier] - line[best][inlier], clicked)
        found.append(SnappedEdge(normal, SNAPPED_SIGMA_PX, float(score[best])))
        free &= np.maximum(np.abs(first - first[best]), np.abs(last - last[best])) > APART_PX
    return found or [SnappedEdge(clicked, CLICK_SIGMA_PX, 0.0)]


def _fitted(view: View, edge: Array, misfit: Array, clicked: Array) -> Array:
    """Return the normal (3,) of the plane through edge points (m,) with misfits (m,) in px, fitted robustly."""
    rays = view.camera.rays(view.edges.position[edge])
    normal = clicked
    for _ in range(4):
        limit = max(3 * 1.4826 * float(np.median(np.abs(misfit))), 0.3)
        weight = np.clip(1 - (misfit / limit) ** 2, 0, None) ** 2 / view.edges.sigma[edge] ** 2
        _, vectors = np.linalg.eigh((rays * weight[:, None]).T @ rays)
        normal = vectors[:, 0] * np.sign(vectors[:, 0] @ clicked)
        misfit = (rays @ normal) * view.camera.interior.pixels_per_radian
    return normal
