# SPDX-License-Identifier: LGPL-2.1-or-later
"""Weighing hypotheses of flanges: all contours of all of them in all images, in one go per image.

Each hypothesis may first move a little, along its axis and across, to where its own edges are: the pipe's
axis and the place along it are known to a millimetre or two only. What the flange, its partner or other
components hide does not count; edges that nothing explains do not count against anyone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent, Flange, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.chance import density_of, hits_beside, over_rates
from pipeworkbench.recon.contour import Contour, contour_of
from pipeworkbench.recon.cylinder import Cylinder, perpendicular_axes
from pipeworkbench.recon.flange_variants import Variant
from pipeworkbench.recon.match import edges_along_normals, nearest_rows, robust_quality
from pipeworkbench.recon.rim_profile import LikelihoodSettings, log_ratio
from pipeworkbench.recon.shapes import shapes_of
from pipeworkbench.recon.views import View
from pipeworkbench.recon.visibility import hidden

OCCLUDING_MM = 10.0  # something else hides a sample only where it is nearer by more than this: it was measured too
RIM_CURVES = ("rim", "face", "back", "raised face")


@dataclass(frozen=True)
class WeighingSettings:
    """Tunables; lengths in mm unless they end in px.

    A flange lies ``sigma_across`` beside its pipe's measured axis and ``sigma_along`` from where its rim was
    seen; ``first_range_px`` is how far its edges are looked for then. ``behind`` is the length of pipe, from the face
    on, that is part of a hypothesis: what a short flange leaves to the pipe must be compared with a long one's neck.
    """

    sigma_across: float = 2.5
    sigma_along: float = 1.0
    first_range_px: float = 6.0
    interval_px: float = 6.0
    coarse: int = 25
    rounds: int = 5
    robust_px: float = 0.7
    behind: float = 15.0
    click_sigma_px: float = 3.0
    click_reach_px: float = 9.0
    touching: float = 1.0


@dataclass(frozen=True, eq=False)
class Partner:
    """The other flange of a pair: its shape, the ``gap`` (mm) between both faces, and whether both rims' edges are seen apart there."""

    variant: Variant
    gap: float
    apart: bool


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A flange of a shape with its sealing face at a point (3,), facing along a unit vector (3,).

    ``partner`` is the other flange of the pair, None for an open end;
    ``prior`` the logarithm of its probability before the images are asked, up to a constant.
    """

    variant: Variant
    face: Array
    axis: Array
    partner: Partner | None
    prior: float

    def partner_flange(self, outer_diameter: float) -> Flange | None:
        """Return the other flange, None for an open end."""
        if self.partner is None:
            return None
        return self.partner.variant.at(self.face + self.partner.gap * self.axis, -self.axis, outer_diameter)

    def moved(self, shift: Array) -> Hypothesis:
        """Return the hypothesis moved by (3,) mm."""
        return replace(self, face=self.face + shift)


@dataclass(frozen=True, eq=False)
class Weights:
    """What the images say.

    ``score`` (h,) log-posteriors up to a constant, ``shift`` (h, 3) mm that each was moved by, ``quality`` (h,) Eq. 4's q of the
    flange's own contours in px, with a bounded influence of far edges, ``covariance`` (h, 3, 3) of the position, mm^2.
    """

    score: Array
    shift: Array
    quality: Array
    covariance: Array


def weigh(
    views: Sequence[View],
    hypotheses: Sequence[Hypothesis],
    cylinder: Cylinder,
    reach: float,
    occluders: Sequence[AnyComponent] = (),
    click: tuple[int, Array] | None = None,
    settings: WeighingSettings | None = None,
    likelihood: LikelihoodSettings | None = None,
) -> Weights:
    """Weigh hypotheses in all views.

    Parameters
    ----------
    views : sequence of View
    hypotheses : sequence of Hypothesis
    cylinder : Cylinder
        The pipe that they sit on.
    reach : float
        The longest flange's length, mm.
    occluders : sequence of components
        What else may hide them.
    click : (int, (2,) array), optional
        View and pixel that was clicked: it lies near one of the rim's edges.
    settings : WeighingSettings, optional
    likelihood : LikelihoodSettings, optional
    """
    settings, likelihood = settings or WeighingSettings(), likelihood or LikelihoodSettings()
    parts = _parts(hypotheses, 2 * cylinder.radius, reach + settings.behind)
    sides = perpendicular_axes(cylinder.direction[None])
    frame = np.stack([cylinder.direction, sides[0][0], sides[1][0]])
    seen = [_samples(view, parts, frame, occluders, settings) for view in views]
    shift, covariance = _shifts(seen, len(hypotheses), settings, likelihood.independent)
    score = np.array([hypothesis.prior for hypothesis in hypotheses]) - 0.5 * ((shift / _sigmas(settings)) ** 2).sum(axis=1)
    far, total, count = likelihood.search_range, np.zeros(len(hypotheses)), np.zeros(len(hypotheses))
    for view, samples in zip(views, seen, strict=True):
        distance = samples.nearest(shift, far)
        density = _densities(view, samples, likelihood)
        score += _curve_ratios(samples, distance, density, settings.interval_px, likelihood, len(hypotheses))
        loss = robust_quality(distance[:, None], far, axis=1) ** 2
        flange = samples.own
        total += np.bincount(samples.owner[flange], loss[flange], len(hypotheses))
        count += np.bincount(samples.owner[flange], minlength=len(hypotheses))
    if click is not None:
        score += _click_ratios(seen[click[0]], click[1], len(hypotheses), settings)
    with np.errstate(invalid="ignore", divide="ignore"):
        quality = np.sqrt(total / count)
    return Weights(score, shift @ frame, quality, frame.T @ covariance @ frame)


@dataclass(frozen=True, eq=False)
class _Samples:
    """The visible samples (n,) of all hypotheses' contours in one view.

    ``owner`` (n,) is the hypothesis, ``own`` (n,) whether it is the flange itself, ``slope`` (n, 3) px along the
    normal per mm of shift; ``sample``, ``off`` (m,) the edges near them with their distances in px.
    """

    contour: Contour
    owner: NDArray[np.intp]
    own: NDArray[np.bool_]
    slope: Array
    sample: NDArray[np.intp]
    off: Array

    def nearest(self, shift: Array, reach: float) -> Array:
        """Return the distances (n,) px to the nearest edges after shifts (h, 3), NaN where there is none within reach."""
        left = self.off - np.einsum("ni,ni->n", self.slope, shift[self.owner])[self.sample]
        rows = nearest_rows(self.sample, left)
        nearest = np.full(len(self.owner), np.nan)
        nearest[self.sample[rows]] = left[rows]
        nearest[np.abs(nearest) > reach] = np.nan
        return nearest


@dataclass(frozen=True, eq=False)
class _Parts:
    """The components (k) of all hypotheses: ``owner`` (k,) the hypothesis, ``own`` (k,) whether it is the flange that is asked for.

    ``blurred`` (k,) is whether the front of a plate is too near to the other plate's to be an edge of its own.
    """

    components: list[AnyComponent]
    owner: NDArray[np.intp]
    own: NDArray[np.bool_]
    blurred: NDArray[np.bool_]


def _parts(hypotheses: Sequence[Hypothesis], outer_diameter: float, reach: float) -> _Parts:
    components: list[AnyComponent] = []
    rows = []
    for number, hypothesis in enumerate(hypotheses):
        components.append(hypothesis.variant.at(hypothesis.face, hypothesis.axis, outer_diameter))
        rows.append((number, True, False))
        if not hypothesis.variant.blind:
            start, end = hypothesis.face - hypothesis.variant.length * hypothesis.axis, hypothesis.face - reach * hypothesis.axis
            components.append(Pipe(id="", start=tuple(start), end=tuple(end), outer_diameter=outer_diameter))
            rows.append((number, False, False))
        partner = hypothesis.partner_flange(outer_diameter)
        if partner is not None and hypothesis.partner is not None:
            # of the partner only the plate: which neck it has is another question
            components.append(replace(partner, length=partner.C))
            rows.append((number, False, not hypothesis.partner.apart))
    owner, own, blurred = zip(*rows, strict=True)
    return _Parts(components, np.array(owner, np.intp), np.array(own, bool), np.array(blurred, bool))


def _samples(view: View, parts: _Parts, frame: Array, occluders: Sequence[AnyComponent], settings: WeighingSettings) -> _Samples:
    contour = contour_of(view.camera, parts.components, settings.interval_px, settings.touching, parts.owner.tolist(), settings.coarse)
    names = np.array(contour.names, object)[contour.curve]
    # one image edge must not speak for two contours
    doubled = parts.blurred[contour.component] & np.isin(names, ["face", "raised face"])
    contour = contour[contour.visible & np.isfinite(contour.normal).all(axis=1) & ~doubled]
    if occluders and len(contour):
        nobody = np.full(len(contour), -1, np.intp)
        contour = contour[~hidden(view.camera.projection_centre, contour.point, shapes_of(occluders), nobody, OCCLUDING_MM)[1]]
    # the pipe behind and the partner go with the flange: they have one axis
    slope = contour.gain[:, None] * (contour.outward @ frame.T)
    sample, _, off = edges_along_normals(view.edges, contour.position, contour.normal, settings.first_range_px)
    return _Samples(contour, parts.owner[contour.component], parts.own[contour.component], slope, sample, off)


def _sigmas(settings: WeighingSettings) -> Array:
    return np.array([settings.sigma_along, settings.sigma_across, settings.sigma_across])


def _shifts(seen: Sequence[_Samples], count: int, settings: WeighingSettings, independent: float) -> tuple[Array, Array]:
    """Return the shifts (h, 3) in mm, along and across, that bring each hypothesis onto its edges, and their covariances.

    Least squares with Cauchy's weights; neighbouring samples are not independent.
    """
    shift = np.zeros((count, 3))
    prior = np.diag(1 / _sigmas(settings) ** 2)
    each = min(settings.interval_px / independent, 1.0) / settings.robust_px**2
    normal = np.tile(prior, (count, 1, 1))
    for round_ in range(settings.rounds):
        # from far to near: first what is within reach, at last what fits
        reach = settings.first_range_px / (1 + round_)
        normal = np.tile(prior, (count, 1, 1))
        right = -shift @ prior
        for samples in seen:
            left = samples.nearest(shift, reach)
            used = np.flatnonzero(np.isfinite(left))
            slope, rest, row = samples.slope[used], left[used], samples.owner[used]
            weight = each / (1 + (rest / settings.robust_px) ** 2)
            for i in range(3):
                right[:, i] += np.bincount(row, weight * slope[:, i] * rest, count)
                for j in range(3):
                    normal[:, i, j] += np.bincount(row, weight * slope[:, i] * slope[:, j], count)
        shift = shift + np.linalg.solve(normal, right[:, :, None])[:, :, 0]
    return shift, np.linalg.inv(normal)


def _densities(view: View, samples: _Samples, likelihood: LikelihoodSettings) -> Array:
    """Return how many edges per px there are by chance around each sample (n,): for rims as around all of them, else as around the curve itself.

    Bolts stand around a neck, and their sides are parallel to a hub's: there an edge says less.
    """
    contour = samples.contour
    if not len(contour):
        return np.zeros(0)
    low, high = likelihood.background
    sample, _, distance = edges_along_normals(view.edges, contour.position, contour.normal, high)
    hit = hits_beside(sample, distance, low, len(contour))
    names = np.array(contour.names, object)[contour.curve]
    group = np.where(np.isin(names, RIM_CURVES), 0, contour.curve + 1)
    _, group = np.unique(group, return_inverse=True)
    share = np.bincount(group, hit.mean(axis=1)) / np.bincount(group)
    return density_of(share, high - low, likelihood.least_density)[group]


def _curve_ratios(samples: _Samples, distance: Array, density: Array, interval: float, likelihood: LikelihoodSettings, count: int) -> Array:
    """Return the log-likelihood ratios (h,): each curve's over all rates of hits that are possible, summed up."""
    names, curve = np.unique(samples.contour.curve, return_inverse=True)
    if not len(names):
        return np.zeros(count)
    weight = interval / likelihood.independent
    rates = [np.bincount(curve, weight * log_ratio(distance, density, rate, likelihood), len(names)) for rate in likelihood.hit_rates]
    ratio = over_rates(rates)
    first = np.zeros(len(names), np.intp)
    first[curve] = samples.owner
    return np.asarray(np.bincount(first, ratio, count), float)


def _click_ratios(samples: _Samples, click: Array, count: int, settings: WeighingSettings) -> Array:
    """Return how well the click (2,) fits: it should lie on an edge of the rim."""
    names = np.array(samples.contour.names, object)[samples.contour.curve]
    off = np.linalg.norm(samples.contour.position - click, axis=1)
    nearest = np.full(count, np.inf)
    good = samples.own & np.isin(names, ["rim", "face", "back"])
    np.minimum.at(nearest, samples.owner[good], off[good])
    return np.asarray(-0.5 * (np.minimum(nearest, settings.click_reach_px) / settings.click_sigma_px) ** 2, float)
