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
from pipeworkbench.recon.chance import densities_beside, over_rates
from pipeworkbench.recon.cylinder import Cylinders, smooth_contours
from pipeworkbench.recon.match import edges_along_normals, nearest_rows
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class EvidenceSettings:
    """Tunables of the weighing; distances in px.

    An edge within ``search_range`` of a contour may be its own, with a scatter of ``scatter``; how many of
    a contour's samples find one depends on its contrast: each of ``hit_rates`` is as likely.
    ``background`` are the windows to either side that show how dense edges are by chance.
    ``polarity_trust`` says how far the polarity seen in one image is trusted to hold in the others.
    """

    search_range: float = 3.0
    background: tuple[tuple[float, float], ...] = ((-19.0, -12.0), (-12.0, -5.0), (5.0, 12.0), (12.0, 19.0))
    hit_rates: tuple[float, ...] = (0.85, 0.6, 0.3)
    scatter: float = 0.35
    polarity_trust: float = 0.8
    least_density: float = 0.02  # edges per px: an empty neighbourhood is not known to stay empty
    least_visible: float = 0.3
    samples: int = 48
    stretch: int = 4  # samples along which the background hardly changes
    stretches: float = 8.0  # independent ones along a contour: neighbouring samples meet the same edge
    near: float = 1.5  # px; edges further off a contour are not its own


def evidence(views: Sequence[View], reference: int, cylinders: Cylinders, extents: Array, settings: EvidenceSettings | None = None) -> Array:
    """Weigh the contours of cylinders in all views.

    Parameters
    ----------
    views : sequence of View
    reference : int
        The view whose brightness steps along the contours are expected in the others too: the same pipe
        before the same wall looks alike from neighbouring cameras.
    cylinders : Cylinders
    extents : (k, 2) array
        From where to where, mm along the axes.
    settings : EvidenceSettings, optional

    Returns
    -------
    (views, k, 2) array
        Log-likelihood ratios of either side, positive where the edges fit better than by chance; NaN where
        the cylinder is not in the image.
    """
    settings = settings or EvidenceSettings()
    own, steps = _in_view(views[reference], cylinders, extents, None, settings)
    polarity = _smoothed(steps, settings)
    return np.array([own if n == reference else _in_view(view, cylinders, extents, polarity, settings)[0] for n, view in enumerate(views)])


def _smoothed(steps: Array, settings: EvidenceSettings) -> Array:
    """Return the mean sign (k, 2, samples) of the brightness steps in the stretch that a sample is in."""
    stretches = steps.reshape(*steps.shape[:2], -1, settings.stretch)
    # two imaginary steps, one of either sign: a stretch with few edges says little
    mean = stretches.sum(axis=3) / (np.abs(stretches).sum(axis=3) + 2)
    return np.repeat(mean, settings.stretch, axis=2)


def _in_view(view: View, cylinders: Cylinders, extents: Array, polarity: Array | None, settings: EvidenceSettings) -> tuple[Array, Array]:
    """Return the ratios (k, 2) and the signs (k, 2, samples) of the steps that the contours met, 0 for none."""
    seen = smooth_contours(view.camera, cylinders, extents, np.linspace(0, 1, settings.samples))
    shape = seen.gain.shape
    position, normal = seen.position.reshape(-1, 2), seen.normal.reshape(-1, 2)
    contours = shape[0] * shape[1]
    visible = np.isfinite(position[:, 0]).reshape(contours, -1).sum(axis=1)
    count = np.maximum(visible, 1)
    windows = np.array(settings.background)
    sample, edge, distance = edges_along_normals(view.edges, position, normal, float(np.abs(windows).max()))

    density = densities_beside(sample, distance, windows, visible, shape[2], settings.least_density)

    # from here on only the samples that met an edge, each its nearest
    near = np.flatnonzero(np.abs(distance) <= settings.search_range)
    near = near[nearest_rows(sample[near], distance[near])]
    sample, off = sample[near], np.abs(distance[near])
    step = np.sign(np.einsum("ij,ij->i", view.edges.normal[edge[near]], normal[sample]))
    contour = sample // shape[2]
    # a Laplace scatter forgives the tails that real edges have
    own = np.exp(-off / settings.scatter) / (2 * settings.scatter)
    if polarity is not None:
        own *= 1 + settings.polarity_trust * polarity.reshape(-1)[sample] * step
    by_chance = density[contour] * np.exp(-2 * density[contour] * off)
    quotient = own / by_chance
    rates = []
    for rate in settings.hit_rates:
        met = np.bincount(contour, np.log1p(rate / (1 - rate) * quotient), contours)
        rates.append(settings.stretches * (met + visible * np.log(1 - rate)) / count)
    ratio = over_rates(rates).reshape(shape[:2])
    enough = (visible >= settings.least_visible * shape[2]).reshape(shape[:2]).all(axis=1)
    steps = np.zeros(len(position))
    steps[sample[off <= settings.near]] = step[off <= settings.near]
    return np.where(enough[:, None], ratio, np.nan), steps.reshape(shape)
