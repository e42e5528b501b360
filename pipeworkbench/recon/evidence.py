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
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, outlines, spread
from pipeworkbench.recon.match import edges_along_normals
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
    along = spread(extents, np.linspace(0, 1, settings.samples))
    own, steps = _in_view(views[reference], cylinders, along, None, settings)
    polarity = _smoothed(steps, settings)
    return np.array([own if n == reference else _in_view(view, cylinders, along, polarity, settings)[0] for n, view in enumerate(views)])


def _smoothed(steps: Array, settings: EvidenceSettings) -> Array:
    """Return the mean sign (k, 2, samples) of the brightness steps in the stretch that a sample is in."""
    stretches = steps.reshape(*steps.shape[:2], -1, settings.stretch)
    # two imaginary steps, one of either sign: a stretch with few edges says little
    mean = stretches.sum(axis=3) / (np.abs(stretches).sum(axis=3) + 2)
    return np.repeat(mean, settings.stretch, axis=2)


def _in_view(view: View, cylinders: Cylinders, along: Array, polarity: Array | None, settings: EvidenceSettings) -> tuple[Array, Array]:
    """Return the ratios (k, 2) and the signs (k, 2, samples) of the steps that the contours met, 0 for none."""
    position, normal = outlines(view.camera, cylinders, along)
    shape = position.shape[:3]
    position, normal = position.reshape(-1, 2), normal.reshape(-1, 2)
    visible = np.isfinite(position[:, 0]).reshape(shape)
    count = np.maximum(visible.sum(axis=2), 1)
    windows = np.array(settings.background)
    sample, edge, distance = edges_along_normals(view.edges, position, normal, float(np.abs(windows).max()))
    sign = np.sign(np.einsum("ij,ij->i", view.edges.normal[edge], normal[sample]))

    # nearest-edge distances of a Poisson process: P(none within a window) = exp(-density width)
    hit = np.zeros((len(position), len(windows)), bool)
    for column, (low, high) in enumerate(windows):
        hit[sample[(distance > low) & (distance < high)], column] = True
    chance = hit.reshape(*shape, -1).sum(axis=(2, 3)) / (count * len(windows))
    width = float(np.mean(windows[:, 1] - windows[:, 0]))
    density = np.maximum(-np.log(1 - np.minimum(chance, 0.98)) / width, settings.least_density)

    off, met = _nearest(len(position), sample, distance, sign, settings.search_range)
    off, met = off.reshape(shape), met.reshape(shape)
    # a Laplace scatter forgives the tails that real edges have
    own = np.exp(-off / settings.scatter) / (2 * settings.scatter)
    if polarity is not None:
        own *= 1 + settings.polarity_trust * polarity * met
    by_chance = density[:, :, None] * np.exp(-2 * density[:, :, None] * off)
    quotient = np.where(np.isnan(off), 0.0, own / by_chance)
    rates = []
    for rate in settings.hit_rates:
        mean = np.where(visible, np.log(rate * quotient + 1 - rate), 0.0).sum(axis=2) / count
        rates.append(settings.stretches * mean)
    ratio = np.logaddexp.reduce(rates, axis=0) - np.log(len(rates))
    enough = (visible.sum(axis=2) >= settings.least_visible * shape[2]).all(axis=1)
    return np.where(enough[:, None], ratio, np.nan), np.where(off <= settings.near, met, 0.0)


def _nearest(count: int, sample: NDArray[np.intp], distance: Array, sign: Array, reach: float) -> tuple[Array, Array]:
    """Return the distance (count,) of each sample's nearest edge, NaN for none, and its sign, 0 for none."""
    off = np.abs(distance)
    near = np.flatnonzero(off <= reach)
    # write the far ones first: the nearest of each sample stays
    near = near[np.argsort(-off[near])]
    nearest, met = np.full(count, np.nan), np.zeros(count)
    nearest[sample[near]] = off[near]
    met[sample[near]] = sign[near]
    return nearest, met
