# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looking for flanges along an axis: rims that the images show, then every type, class and standard of such a rim.

A hypothesis is a shape, a place, a facing and, where the images show a second rim a gasket away, a partner.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench import catalogue
from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.flange_axes import FlangeAxis, occluders_of
from pipeworkbench.recon.flange_settings import FlangeSettings
from pipeworkbench.recon.flange_variants import Variant, variants_of
from pipeworkbench.recon.flange_weighing import Hypothesis, Partner, weigh
from pipeworkbench.recon.rim_profile import RimProfile, rim_profile
from pipeworkbench.recon.vectors import across
from pipeworkbench.recon.views import View

SIMILAR = 0.1  # of its diameter that a pipe without flanges of its own was measured wrong by
LEAST_SCALE = 0.05  # px per mm: an axis that points at all cameras


@dataclass(frozen=True, eq=False)
class Ranked:
    """A hypothesis after it was weighed: the logarithm of how likely it is, its q in px, the covariance (3, 3) of its position in mm^2."""

    axis: FlangeAxis
    hypothesis: Hypothesis
    score: float
    quality: float
    covariance: Array


def search(
    views: Sequence[View],
    axis: FlangeAxis,
    variants: Sequence[Variant],
    places: tuple[float, float],
    others: Sequence[AnyComponent] = (),
    click: tuple[int, Array] | None = None,
    settings: FlangeSettings | None = None,
    facing: int | None = None,
) -> list[Ranked]:
    """Return the flanges that the images show at places along an axis, the likeliest first.

    Parameters
    ----------
    views : sequence of View
    axis : FlangeAxis
    variants : sequence of Variant
        The shapes that are possible.
    places : (float, float)
        From where to where the rim may lie, mm along the axis from its cylinder's point.
    others : sequence of components
        What else is known and may hide it.
    click : (int, (2,) array), optional
        View and pixel that was clicked.
    settings : FlangeSettings, optional
    facing : int, optional
        +1 for flanges that face along the axis, -1 against it.
    """
    settings = settings or FlangeSettings()
    return weighed(views, rims_along(views, axis, variants, places, click, settings, facing), others, click, settings)


def rims_along(
    views: Sequence[View],
    axis: FlangeAxis,
    variants: Sequence[Variant],
    places: tuple[float, float],
    click: tuple[int, Array] | None,
    settings: FlangeSettings,
    facing: int | None = None,
    most: int | None = None,
) -> list[Rim]:
    """Return the rims that stand out along an axis, the likeliest first; parameters as for :func:`search`, at ``most`` so many."""
    if not variants:
        return []
    margin = 2 * max(v.thickness for v in variants) + settings.gaps[1]
    span = (places[0] - margin, places[1] + margin)
    scale = _scale(views, axis.cylinder, span)
    along = _grid(span, scale, settings)
    diameters = np.array(sorted({v.dimensions.D for v in variants}))
    profile = rim_profile(views, axis.cylinder, diameters, along, click, settings.likelihood)
    found = _rims(profile, axis, variants, settings, scale, click=click is not None, facing=facing)
    found.sort(key=lambda rim: -rim.score)
    return found[:most]


def weighed(
    views: Sequence[View], rims: Sequence[Rim], others: Sequence[AnyComponent], click: tuple[int, Array] | None, settings: FlangeSettings
) -> list[Ranked]:
    """Return all shapes of the best rims of any axes, weighed, the likeliest first; parameters as for :func:`search`."""
    best = sorted(rims, key=lambda rim: -rim.score)[: settings.rims]
    best = [rim for rim in best if rim.score >= settings.rim_share * best[0].score]
    ranked: list[Ranked] = []
    for axis in {id(rim.axis): rim.axis for rim in best}.values():
        here = [rim for rim in best if rim.axis is axis]
        hypotheses = [h for rim in here for h in _expanded(rim, settings)][: settings.hypotheses]
        middle = np.mean([h.face for h in hypotheses], axis=0)
        hiding = occluders_of(axis, others, views, middle, max(rim.form[0] for rim in here) / 2)
        reach = max(v.length for rim in here for v in rim.variants)

        own = _ranked(views, axis, hypotheses, reach, hiding, click, settings)
        if _off_axis(own[0]) > settings.again_off:
            # contours change with the distance from the camera: weigh the best again where they have moved to
            own = _ranked(views, axis, [one.hypothesis for one in own[: settings.again]], reach, hiding, click, settings)
        ranked += own
    return sorted(ranked, key=lambda one: -one.score)


@dataclass(frozen=True, eq=False)
class Rim:
    """A rim seen on an ``axis``: the ``variants`` of one ``form`` share it (`form_of`).

    ``face`` is where the sealing face lies, mm along the axis, ``sign`` whether it faces along or against it.
    """

    axis: FlangeAxis
    variants: tuple[Variant, ...]
    form: tuple[float, ...]
    face: float
    sign: int
    partner: Partner | None
    score: float


def form_of(variant: Variant) -> tuple[float, ...]:
    """Return what the rim shows of a shape: diameter, width, raised face, bolt circle and bolts (which a pair shares)."""
    d = variant.dimensions
    return d.D, variant.width, variant.raised, d.K, float(d.bolts)


def _ranked(
    views: Sequence[View],
    axis: FlangeAxis,
    hypotheses: Sequence[Hypothesis],
    reach: float,
    hiding: Sequence[AnyComponent],
    click: tuple[int, Array] | None,
    settings: FlangeSettings,
) -> list[Ranked]:
    """Return hypotheses where they have moved to, the likeliest first."""
    weights = weigh(views, hypotheses, axis.cylinder, reach, hiding, click, settings.weighing, settings.likelihood)
    return [
        Ranked(axis, hypotheses[i].moved(weights.shift[i]), float(weights.score[i]), float(weights.quality[i]), weights.covariance[i])
        for i in np.argsort(-weights.score)
    ]


def _off_axis(ranked: Ranked) -> float:
    """Return how far (mm) a flange was moved off its axis."""
    line = ranked.axis.cylinder
    return float(np.linalg.norm(across(ranked.hypothesis.face - line.point, line.direction)))


def drilling_of(variant: Variant) -> tuple[float, ...]:
    """Return what both flanges of a pair share: diameter, bolt circle and number of bolts."""
    d = variant.dimensions
    return d.D, d.K, float(d.bolts)


def _scale(views: Sequence[View], cylinder: Cylinder, places: tuple[float, float]) -> float:
    """Return the px per mm along the axis in the image that resolves it best."""
    middle = cylinder.at(sum(places) / 2)
    steps = [view.camera.project(np.stack([middle, middle + cylinder.direction])) for view in views]
    return float(np.nanmax([np.linalg.norm(pixels[1] - pixels[0]) for pixels in steps] + [LEAST_SCALE]))


def _grid(places: tuple[float, float], scale: float, settings: FlangeSettings) -> Array:
    """Return places along the axis about ``step_px`` apart in the image that resolves them best."""
    count = int(np.clip((places[1] - places[0]) * scale / settings.step_px, 40, settings.most_places))
    return np.linspace(places[0], places[1], count)


def _rims(
    profile: RimProfile, axis: FlangeAxis, variants: Sequence[Variant], settings: FlangeSettings, scale: float, *, click: bool, facing: int | None
) -> list[Rim]:
    """Return the rims that stand out, with their facing and partner, the likeliest first."""
    best = {form_of(v): v for v in sorted(variants, key=lambda v: v.prior)}
    row_of = {d: row for row, d in enumerate(profile.diameters)}
    step = profile.along[1] - profile.along[0]
    seen = {form: profile.rims(row_of[form[0]], form[1]) for form in best}
    gaps = np.arange(settings.gaps[0], settings.gaps[1] + step / 2, max(step, 0.5))
    found = []
    least = settings.form_share * max(float(own.max()) for own, _ in seen.values())
    for form, (score, near) in seen.items():
        _, width, raised, *_ = form
        if score.max() < least:
            continue
        clicked = np.where(near <= settings.click_reach_px, score - 0.5 * (near / settings.click_sigma_px) ** 2, -np.inf)
        own = clicked if click else score
        for sign in (1, -1) if facing is None else (facing,):
            face = profile.along + (width + raised if sign > 0 else -raised)
            gain, partners = _partners(profile, seen, best, form, face, sign, gaps, settings.apart_px / scale)
            # both rims of a pair look alike: where the one is seen well, so is the other
            gain = np.where(gain > settings.partner_share * own, np.maximum(gain - settings.partner_margin, 0.0), 0.0)
            sides = axis.coverage(face - sign * settings.near, face - sign * settings.far) - axis.coverage(
                face + sign * settings.near, face + sign * settings.far
            )
            total = own + gain + settings.coverage * sides
            for _ in range(settings.peaks):
                top = int(np.argmax(total))
                if not np.isfinite(total[top]):
                    break
                partner = partners[top] if gain[top] > 0 else None
                found.append(Rim(axis, tuple(v for v in variants if form_of(v) == form), form, float(face[top]), sign, partner, float(total[top])))
                total[np.abs(face - face[top]) < settings.apart] = -np.inf
    return found


def _partners(
    profile: RimProfile,
    seen: dict[tuple[float, ...], tuple[Array, Array]],
    best: dict[tuple[float, ...], Variant],
    form: tuple[float, ...],
    face: Array,
    sign: int,
    gaps: Array,
    apart: float,
) -> tuple[Array, list[Partner]]:
    """Return the best ratio (n,) of a second rim behind a gasket, and what it is, for faces at places (n,)."""
    gain, choice = np.full(len(face), -np.inf), np.zeros(len(face), np.intp)
    options: list[Partner] = []
    circle = profile.circle[int(np.searchsorted(profile.diameters, form[0]))]
    for other, (score, _) in seen.items():
        if (other[0], *other[3:]) != (form[0], *form[3:]):
            continue
        for gap in gaps:
            near = face + sign * (gap + other[2])
            start = near if sign > 0 else near - other[1]
            value = np.interp(start, profile.along, np.maximum(score, -1e3), left=-1e3, right=-1e3)
            distinct = form[2] + gap + other[2] >= apart
            if not distinct:
                # the same image edge must not speak for both plates
                value = value - np.maximum(np.interp(near, profile.along, circle), 0.0)
            better = value > gain
            gain[better], choice[better] = value[better], len(options)
            options.append(Partner(best[other], float(gap), bool(distinct)))
    return gain, [options[i] for i in choice] if options else []


def _expanded(rim: Rim, settings: FlangeSettings) -> list[Hypothesis]:
    """Return all shapes of a rim seen as hypotheses."""
    made = []
    axis = rim.axis

    def covered(near: float, far: float) -> float:
        """Return which part of a stretch before the face is covered with pipe; behind it distances are negative."""
        return float(axis.coverage(np.array([rim.face + rim.sign * near]), np.array([rim.face + rim.sign * far]))[0])

    ahead = covered(settings.near, settings.far)
    for variant in rim.variants:
        behind = covered(-variant.length - 5.0, -variant.length - settings.far)
        prior = variant.prior + settings.coverage * (behind - ahead)
        if variant.blind:
            # it is bolted to another flange, and behind it there is no pipe
            alone = settings.blind_alone if rim.partner is None else 0.0
            prior = variant.prior + settings.coverage * (ahead - behind) - settings.blind_pipe * max(behind - settings.overrun, 0.0) - alone
        made.append(Hypothesis(variant, axis.cylinder.at(rim.face), rim.sign * axis.cylinder.direction, rim.partner, prior))
    return made


@functools.lru_cache(maxsize=64)
def _variants_of_pipe(tables: catalogue.Catalogue, outer_diameter: float) -> tuple[Variant, ...]:
    return variants_of(tables.flanges_of_pipe(outer_diameter))


def variants_for(outer_diameter: float, rim: float | None = None, rim_tolerance: float = 6.0) -> tuple[Variant, ...]:
    """Return the shapes of flanges for a pipe; where no table has its diameter, those of a rim that sit on a pipe of about that size.

    Parameters
    ----------
    outer_diameter : float
        The pipe's, mm.
    rim : float, optional
        The rim's measured diameter, mm.
    rim_tolerance : float
    """
    known = _variants_of_pipe(catalogue.catalogue(), outer_diameter)
    if known or rim is None:
        return known
    near = catalogue.flanges_of_rim(rim, rim_tolerance)
    return variants_of(tuple(row for row in near if row.pipe_diameter is not None and abs(row.pipe_diameter / outer_diameter - 1) < SIMILAR))
