# SPDX-License-Identifier: LGPL-2.1-or-later
"""What speaks for the cylinders that a pick could be, and which of them lead.

The evidence of the edges, the agreement of texture and shading, the clicks and the sizes are logarithms of
likelihood ratios and add up. Cylinders at one place that differ in their limbs only are told apart by what a wider
pipe explains and a narrower one does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.appearance import likeness
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.evidence import evidence
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.texture import TextureSettings, texture
from pipeworkbench.recon.views import View

MOST_SHADED = 0.35  # of the radius: how far inside a limb its shading has edges
NESTED_DEPTH, NESTED_COSINE = 0.015, float(np.cos(np.radians(5)))  # what counts as the same place and direction
LEAST_GAP_PX = 1.8  # between two rows of edges that are not the same one
SHADING_PRICE = 5.0  # logarithm of what it costs to explain a row of edges as shading
NO_RIVAL = 20.0  # lead over nothing at all, beyond the worst that was compared
FINE_TEXTURE = TextureSettings(along=120, across=14)  # every other pixel or so: less noise


@dataclass(frozen=True, eq=False)
class Weights:
    """What speaks for cylinders, logarithms of likelihood ratios: both their edges (k, 2), and all else (k,).

    ``elsewhere`` (k,) is the part of the images that were not clicked in: what is clicked fits anyhow.
    """

    edges: Array
    rest: Array
    elsewhere: Array

    @property
    def total(self) -> Array:
        """Return the scores (k,)."""
        return np.asarray(self.edges.sum(axis=1) + self.rest)

    def __getitem__(self, rows: NDArray[np.intp]) -> Weights:
        return Weights(self.edges[rows], self.rest[rows], self.elsewhere[rows])


def weights_of(
    views: Sequence[View],
    pick: PipePick,
    tangents: PipeTangents,
    cylinders: Cylinders,
    series: Array | float,
    settings: PickSettings,
    extents: Array | None = None,
    surface_samples: TextureSettings = FINE_TEXTURE,
) -> Weights:
    """Return the evidence of edges, texture, shading, clicks and size; -inf for what no other image contains or is out of range.

    ``series`` (k,) are those of EN 10220 that the cylinders' sizes belong to, 1 where there is none; ``extents``
    (k, 2) say which part of the cylinders counts (mm along the axes), by default what was clicked;
    ``surface_samples`` how finely their texture is compared.
    """
    camera = views[pick.camera].camera
    extents = clicked_extents(cylinders, camera.projection_centre, tangents) if extents is None else extents
    ratios = evidence(views, pick.camera, cylinders, extents)
    known = np.isfinite(ratios)
    # an image that does not contain a hypothesis speaks neither for nor against it
    edges = np.where(known, ratios, 0).sum(axis=0)
    # two descriptions of one surface: where something hides a part of the shading, or there is no texture, the other counts
    # the larger a surface, the more its texture says, up to a limit that keeps it on a par with the edges
    area = 4 * tangents.half_length * tangents.half_width * camera.interior.pixels_per_radian**2
    patches = min(settings.surface_patches, area / settings.patch_area)
    surface = patches * texture(views, pick.camera, cylinders, extents, surface_samples)
    surface = np.maximum(surface, settings.likeness_weight * likeness(views, pick.camera, cylinders, extents)).sum(axis=0)
    clicks = tangents.click_prior(cylinders, camera.projection_centre, camera.interior.pixels_per_radian)
    rest = surface + clicks - settings.series_penalty * (series - 1)
    middle = cylinders.at(extents.mean(axis=1))
    distance = np.linalg.norm(middle - camera.projection_centre, axis=1)
    possible = np.delete(known, pick.camera, axis=0).any(axis=(0, 2))
    possible &= (distance >= settings.working_range[0]) & (distance <= settings.working_range[1])
    elsewhere = np.delete(np.where(known, ratios, 0), pick.camera, axis=0).sum(axis=(0, 2)) + surface
    return Weights(edges, np.where(possible, rest, -np.inf), elsewhere)


def clicked_extents(cylinders: Cylinders, origin: Array, tangents: PipeTangents) -> Array:
    """Return where the clicked part begins and ends on each axis (k, 2), ascending, mm."""
    ends = [cylinders.nearest_to_ray(origin, ray) for ray in tangents.end_rays]
    return np.sort(np.stack(ends, axis=1), axis=1)


def leads_of(cylinders: Cylinders, scores: Array, origin: Array) -> Array:
    """Return by how much each score (k,) exceeds the best of those that lie at another distance from ``origin``."""
    inverse = 1 / np.linalg.norm(cylinders.points - origin, axis=1)
    elsewhere = np.abs(inverse[:, None] / inverse - 1) > NESTED_DEPTH
    return np.asarray(scores - np.where(elsewhere, scores, scores.min() - NO_RIVAL).max(axis=1))


def outermost_first(cylinders: Cylinders, weights: Weights, origin: Array, pixels_per_radian: float) -> NDArray[np.intp]:
    """Return the rows by their scores, but the outermost of what fits inside one another in front of the inner ones.

    A pipe has edges of its own besides its limbs: beside a limb the shading falls off steeply, and often
    that is a clearer edge than the limb itself before a background of like brightness. A wider pipe
    explains the rows of edges inside of it as its shading (at a price), a narrower one does not explain
    the row outside: so its edges need not be the better ones, only good ones.
    """
    order = np.argsort(-weights.total, kind="stable")
    order = order[np.isfinite(weights.total[order])]
    if not len(order):
        return order
    distance = np.linalg.norm(cylinders.points - origin, axis=1)
    best = order[0]
    for _ in order:
        offset = cylinders.points - cylinders.points[best]
        ray = (cylinders.points[best] - origin) / distance[best]
        # the first edge lies where the cross product of axis and direction to the camera points
        lateral = np.cross(ray, cylinders.directions[best])
        shift = offset @ lateral / np.linalg.norm(lateral)
        wider = cylinders.radii - cylinders.radii[best]
        gap = np.stack([wider + shift, wider - shift], axis=1) / distance[best] * pixels_per_radian
        outside = gap >= LEAST_GAP_PX
        near = (gap > -LEAST_GAP_PX).all(axis=1) & outside.any(axis=1) & (wider > 0) & (wider < MOST_SHADED * cylinders.radii[best])
        near &= np.abs(distance / distance[best] - 1) < NESTED_DEPTH
        near &= np.abs(cylinders.directions @ cylinders.directions[best]) > NESTED_COSINE
        gain = np.where(outside, weights.edges - SHADING_PRICE, weights.edges - weights.edges[best]).sum(axis=1) + weights.rest - weights.rest[best]
        gain[~near] = -np.inf
        if gain.max() <= 0:
            break
        best = int(np.argmax(gain))
    return np.concatenate([[best], order[order != best]]).astype(np.intp)
