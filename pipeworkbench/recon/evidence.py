# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much the images speak for a cylinder: a likelihood ratio against chance hits in clutter.

Eq. 4's q ranks hypotheses that are far apart, but where edges are dense (brick, rust, highlights) a
wrong contour finds an edge nearby everywhere. So the distances are compared with what the same
contour finds when it is shifted sideways: an edge counts for as much as it is unlikely by chance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, outlines, spread
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class EvidenceSettings:
    """Tunables of the weighing.

    ``search_range`` and ``shifts`` in px; ``hit_rate`` and ``scatter`` (px) of a true edge;
    ``polarity_trust`` says how far the polarity seen in one image is trusted to hold in the others.
    """

    search_range: float = 3.0
    shifts: tuple[float, ...] = (-21.0, -14.0, -8.0, 8.0, 14.0, 21.0)
    hit_rate: float = 0.75
    scatter: float = 0.35
    polarity_trust: float = 0.8
    least_density: float = 0.02  # edges per px: an empty neighbourhood is not known to stay empty
    least_visible: float = 0.3
    samples: int = 48


def evidence(
    views: Sequence[View], cylinders: Cylinders, extents: Array, polarity: Array | None = None, settings: EvidenceSettings | None = None
) -> Array:
    """Weigh the contours of cylinders in all views.

    Parameters
    ----------
    views : sequence of View
    cylinders : Cylinders
    extents : (k, 2) array
        From where to where, mm along the axes.
    polarity : (2, samples) array, optional
        What brightness steps are expected along the sides, -1 to 1: the same pipe before the same wall
        looks alike from neighbouring cameras.
    settings : EvidenceSettings, optional

    Returns
    -------
    (views, k) array
        Mean log-likelihood ratio per sample, positive where the edges fit better than by chance;
        NaN where the cylinder is not in the image.
    """
    settings = settings or EvidenceSettings()
    along = spread(extents, np.linspace(0, 1, settings.samples))
    return np.array([_in_view(view, cylinders, along, polarity, settings) for view in views])


def _in_view(view: View, cylinders: Cylinders, along: Array, polarity: Array | None, settings: EvidenceSettings) -> Array:
    position, normal = outlines(view.camera, cylinders, along)
    shape, reach = position.shape[:3], settings.search_range
    position, normal = position.reshape(-1, 2), normal.reshape(-1, 2)
    visible = np.isfinite(position[:, 0]).reshape(shape)
    count = visible.sum(axis=2)

    # nearest-edge distances of a Poisson process: P(none within b) = exp(-2 density b)
    hits = sum(match(view.edges, position + shift * normal, normal, reach).found for shift in settings.shifts)
    chance = np.asarray(hits).reshape(shape).sum(axis=2) / np.maximum(count * len(settings.shifts), 1)
    density = np.maximum(-np.log(1 - np.minimum(chance, 0.98)) / (2 * reach), settings.least_density)[:, :, None]

    matched = match(view.edges, position, normal, reach)
    distance = np.abs(matched.distance).reshape(shape)
    # a Laplace scatter forgives the tails that real edges have
    true_edge = np.exp(-distance / settings.scatter) / (2 * settings.scatter)
    if polarity is not None:
        sign = np.sign(np.einsum("ij,ij->i", view.edges.normal[matched.edge], normal)).reshape(shape)
        true_edge *= 1 + settings.polarity_trust * polarity * sign
    by_chance = density * np.exp(-2 * density * distance)
    ratio = np.log(settings.hit_rate * true_edge / by_chance + 1 - settings.hit_rate)
    ratio = np.where(np.isnan(distance), np.log(1 - settings.hit_rate), ratio)
    ratio[~visible] = 0
    side = ratio.sum(axis=2) / np.maximum(count, 1)
    enough = (count >= settings.least_visible * shape[2]).all(axis=1)
    return np.where(enough, side.mean(axis=1), np.nan)
