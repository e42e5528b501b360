# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flanges from one click, at a pipe's end, or without a click along known pipes (Sect. 6 of the paper).

The axis is the nearest pipe's; where the click's ray passes it says which diameters are possible, and the images
say where a rim of such a diameter stands. Every type, pressure class and standard of that rim is then ranked by
how well its contours fit the edges of all images.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.catalogue import FlangeDimensions
from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Flange, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.flange_axes import axes_of
from pipeworkbench.recon.flange_clicks import axes_of_click, rim_diameter
from pipeworkbench.recon.flange_detection import clusters_of, without_edges_of
from pipeworkbench.recon.flange_search import Ranked, drilling_of, rims_along, search, variants_for, weighed
from pipeworkbench.recon.flange_settings import FlangeSettings
from pipeworkbench.recon.flange_variants import flange_of
from pipeworkbench.recon.groups import distinct, groups_of
from pipeworkbench.recon.picks import FlangePick
from pipeworkbench.recon.vectors import across, rounded
from pipeworkbench.recon.views import View

SAME_FLANGE_MM = 8.0  # two flanges of one facing nearer than this are the same
ALTERNATIVE_SHARE = 0.6  # of the best score that another flange needs where the best one is already another pick's
BEHIND_SHARE = 0.7  # of a rim's radius in the image: nearer centres are one behind the other
OVERLAP_MM = 3.0  # measured plates may overlap by this
ENDS_APART_MM = 250.0  # beyond the ends of what is known of a pipe a flange may still be found


@dataclass(frozen=True, eq=False)
class FlangeCandidate:
    """A flange with what else fits: ``ranking`` are all types that were weighed, the likeliest first."""

    flange: Flange
    ranking: tuple[Ranked, ...]

    @property
    def score(self) -> float:
        """The logarithm of how much likelier the images are with it than by chance."""
        return self.ranking[0].score


@dataclass(frozen=True)
class FlangesFound:
    """The flanges of picks, their partners included, and why the others (by index) gave none."""

    flanges: tuple[Flange, ...]
    failures: tuple[tuple[int, str], ...]


def from_pick(
    views: Sequence[View],
    pick: FlangePick,
    pipes: Sequence[Pipe],
    others: Sequence[AnyComponent] = (),
    settings: FlangeSettings | None = None,
    station: str = "",
) -> tuple[FlangeCandidate, ...]:
    """Return the flanges that one click on a rim can mean, the likeliest first.

    Parameters
    ----------
    views : sequence of View
    pick : FlangePick
        A point on the straight edge of the rim or on an edge of its face.
    pipes : sequence of Pipe
        In the station's frame; the flange sits on one of them or on its continuation.
    others : sequence of components
        What else may hide the flange.
    settings : FlangeSettings, optional
    station : str
        The station's name, for the components' ids.

    Raises
    ------
    InputError
        Where the click is outside the image, far from any pipe, on no rim, or no table knows such a flange.
    """
    settings = settings or FlangeSettings()
    name = f"flange pick {pick.index}"
    view = views[pick.camera]
    if not view.camera.sees(pick.point[None])[0]:
        u, v = pick.point
        raise InputError(name, "point", f"the click at ({u:g}, {v:g}) is outside the image of camera '{view.camera.name}'", "click inside the image")
    if not pipes:
        raise InputError(name, "point", "there is no pipe that a flange could sit on", "pick the flange's pipe as well")
    hidden_by = [*pipes, *others]
    click = (pick.camera, pick.point)
    rims = [
        rim
        for axis, places in axes_of_click(view, pick, pipes, settings, name)
        for rim in rims_along(views, axis, variants_for(axis.pipe.outer_diameter, rim_diameter(view, axis, pick.point)), places, click, settings)
    ]
    good = [ranked for ranked in weighed(views, rims, hidden_by, click, settings) if _accepted(ranked, settings)]
    if not good:
        problem = "no rim of a standard flange is seen there"
        if rims:
            measured = rim_diameter(view, max(rims, key=lambda rim: rim.score).axis, pick.point)
            problem += f" (measured from the pipe's axis it would be {measured:.0f} mm wide)"
        raise InputError(name, "point", problem, "click on the straight edge of the rim, not on a bolt or the neck")
    identity = f"{station}-F{pick.index:02d}"
    return tuple(FlangeCandidate(_component(group[0], identity, pick.index, station), tuple(group)) for group in _flanges_apart(good))


def of_picks(
    views: Sequence[View],
    picks: Sequence[FlangePick],
    pipes: Sequence[Pipe],
    station: str,
    others: Sequence[AnyComponent] = (),
    settings: FlangeSettings | None = None,
) -> FlangesFound:
    """Return the flanges of all picks, and those that face them; a pick that fails leaves the others alone.

    Parameters
    ----------
    views, pipes, others, settings
        As for :func:`from_pick`.
    picks : sequence of FlangePick
    station : str
        The station's name.
    """
    settings = settings or FlangeSettings()
    failures: list[tuple[int, str]] = []
    candidates: dict[int, tuple[FlangeCandidate, ...]] = {}
    for pick in picks:
        try:
            candidates[pick.index] = from_pick(views, pick, pipes, others, settings, station)
        except InputError as error:
            failures.append((pick.index, f"{error.problem}; {error.remedy}"))
    chosen: dict[int, FlangeCandidate] = {}
    # who is surer chooses first
    for index, options in sorted(candidates.items(), key=lambda item: -item[1][0].score):
        least = ALTERNATIVE_SHARE * options[0].score
        taken = next((other for other in chosen if _in_one_place(chosen[other].flange, options[0].flange)), None)
        free = [o for o in options if o.score >= least and not any(_in_one_place(o.flange, c.flange) for c in chosen.values())]
        if free:
            chosen[index] = free[0]
        else:
            failures.append((index, f"it means the same flange as pick {taken}; leave one of them out or click on the other flange"))
    flanges = [chosen[index].flange for index in sorted(chosen)]
    for index in sorted(chosen):
        if any(_faces(chosen[index].flange, flange) for flange in flanges):
            continue
        partner = partner_of(views, chosen[index], pipes, others, settings)
        if partner is not None and not any(_in_one_place(partner, flange) for flange in flanges):
            flanges.append(partner)
    return FlangesFound(tuple(flanges), tuple(sorted(failures)))


def attach(
    views: Sequence[View],
    pipe: Pipe,
    end: int,
    pipes: Sequence[Pipe] = (),
    settings: FlangeSettings | None = None,
    name: str = "flange",
) -> FlangeCandidate:
    """Return the flange at a pipe's end, found without a click (last part of Sect. 6).

    Parameters
    ----------
    views : sequence of View
    pipe : Pipe
    end : int
        0 for its start, 1 for its end.
    pipes : sequence of Pipe
        All pipes that are known.
    settings : FlangeSettings, optional
    name : str
        The flange's id.

    Raises
    ------
    InputError
        Where no table has flanges for the pipe, or none is seen at its end.
    """
    settings = settings or FlangeSettings()
    pipes = pipes if any(other is pipe for other in pipes) else (*pipes, pipe)
    axis = next(axis for axis in axes_of(pipes, settings) if axis.pipe is pipe)
    variants = tuple(v for v in variants_for(pipe.outer_diameter) if not v.blind)
    if not variants:
        raise InputError(pipe.id, "outer_diameter", f"no table has flanges for {pipe.outer_diameter:g} mm", "give the pipe a standard diameter")
    longest = max(v.length for v in variants)
    # the pipe was seen up to somewhere between the weld and the back of the plate
    places = (pipe.length - longest / 2, pipe.length + 1.5 * longest) if end else (-1.5 * longest, longest / 2)
    found = search(views, axis, variants, places, pipes, None, settings, facing=1 if end else -1)
    good = [ranked for ranked in found if _accepted(ranked, settings)]
    if not good:
        raise InputError(pipe.id, f"end {end}", "no flange is seen there", "click on the flange's rim, or attach one of a known type")
    return FlangeCandidate(_component(good[0], name, None, None), tuple(good))


def attached(pipe: Pipe, end: int, dimensions: FlangeDimensions, name: str = "flange", *, raised: bool = True) -> Flange:
    """Return a flange of known dimensions welded to a pipe's start (0) or end (1): it begins where the pipe ends."""
    port = pipe.ports[end]
    axis = np.array(port.direction)
    return flange_of(dimensions, np.array(port.point) + float(dimensions.length or 0) * axis, axis, pipe.outer_diameter, name, raised=raised)


def with_dimensions(flange: Flange, dimensions: FlangeDimensions) -> Flange:
    """Return a flange as another type, class or standard: its face stays where it is (Sect. 6), the other end moves."""
    raised = bool(flange.raised_face_height)
    made = flange_of(dimensions, np.array(flange.face), np.array(flange.axis), flange.outer_diameter, flange.id, raised=raised)
    return replace(made, pick=flange.pick, station=flange.station, fixed=flange.fixed, extra=flange.extra)


def partner_of(
    views: Sequence[View],
    candidate: FlangeCandidate,
    pipes: Sequence[Pipe],
    others: Sequence[AnyComponent] = (),
    settings: FlangeSettings | None = None,
) -> Flange | None:
    """Return the flange on the other side of the gasket, on the pipe over there if one is known; None where none is seen.

    Parameters
    ----------
    views, pipes, others, settings
        As for :func:`from_pick`.
    candidate : FlangeCandidate
    """
    settings = settings or FlangeSettings()
    best = candidate.ranking[0]
    hypothesis = best.hypothesis
    if hypothesis.partner is None:
        return None
    away = hypothesis.face + ENDS_APART_MM * hypothesis.axis
    lines = [axis for axis in axes_of(pipes, settings) if axis.pipe.id in best.axis.same]
    axis = min(lines, key=lambda line: _distance_from_pipe(line.pipe, away))
    drilling = drilling_of(hypothesis.variant)
    variants = tuple(v for v in variants_for(axis.pipe.outer_diameter, drilling[0]) if drilling_of(v) == drilling)
    face = float((hypothesis.face + hypothesis.partner.gap * hypothesis.axis - axis.cylinder.point) @ axis.cylinder.direction)
    sign = 1 if hypothesis.axis @ axis.cylinder.direction > 0 else -1
    found = search(views, axis, variants, (face - settings.apart, face + settings.apart), [*pipes, *others], None, settings, facing=-sign)
    reach = settings.gaps[1] + settings.apart
    near = [r for r in found if abs(float((r.hypothesis.face - hypothesis.face) @ hypothesis.axis)) <= reach and _accepted(r, settings)]
    flange = candidate.flange
    return _component(near[0], f"{flange.id}-2", None, flange.station) if near else None


def _accepted(ranked: Ranked, settings: FlangeSettings) -> bool:
    return ranked.score >= settings.least_score and ranked.quality <= settings.largest_quality_px


def _flanges_apart(ranked: Iterable[Ranked]) -> list[list[Ranked]]:
    """Return hypotheses in groups of one flange each: its types; the likeliest group and type first."""
    return groups_of(ranked, _same_place)


def _same_place(one: Ranked, other: Ranked) -> bool:
    near = float(np.linalg.norm(one.hypothesis.face - other.hypothesis.face)) < SAME_FLANGE_MM
    return near and float(one.hypothesis.axis @ other.hypothesis.axis) > 0


def _faces(one: Flange, other: Flange) -> bool:
    """Return whether two flanges are a pair."""
    return float(np.linalg.norm(np.array(one.face) - other.face)) < SAME_FLANGE_MM and float(np.dot(one.axis, other.axis)) < 0


def _component(ranked: Ranked, name: str, pick: int | None, station: str | None) -> Flange:
    """Return a weighed hypothesis as a component of the pipeline."""
    hypothesis = ranked.hypothesis
    # where a rim told which pipe it must be, the pipe was measured wrong
    outer_diameter = hypothesis.variant.dimensions.pipe_diameter or ranked.axis.pipe.outer_diameter
    flange = hypothesis.variant.at(hypothesis.face, hypothesis.axis, outer_diameter, name)
    sigma = np.sqrt(np.maximum(np.diag(ranked.covariance), 0.0))
    return replace(
        flange,
        pick=pick,
        station=station,
        quality=round(ranked.quality, 4),
        sigma_position=rounded(sigma, 4),
    )


def detect(
    views: Sequence[View],
    pipes: Sequence[Pipe],
    station: str = "",
    others: Sequence[AnyComponent] = (),
    settings: FlangeSettings | None = None,
) -> tuple[Flange, ...]:
    """Propose flanges along known pipes without a click: rims of standard diameters on their axes, the likeliest first.

    Parameters
    ----------
    views : sequence of View
    pipes : sequence of Pipe
        In the station's frame; flanges are looked for along and a little beyond them.
    station : str
        The station's name, for the components' ids.
    others : sequence of components
        What else may hide a flange.
    settings : FlangeSettings, optional
    """
    settings = settings or FlangeSettings()
    done: set[str] = set()
    found: list[tuple[float, Flange]] = []
    for axis in axes_of(pipes, settings):
        if axis.pipe.id in done:
            continue
        done.update(axis.same)
        variants = variants_for(axis.pipe.outer_diameter)
        clear = without_edges_of(views, [pipe for pipe in pipes if pipe.id not in axis.same])
        places = (float(axis.spans.min()) - ENDS_APART_MM, float(axis.spans.max()) + ENDS_APART_MM)
        rims = rims_along(clear, axis, variants, places, None, replace(settings, peaks=settings.peaks_along, most_places=settings.most_places_along))
        for cluster in clusters_of(rims, settings):
            for group in _flanges_apart(weighed(clear, cluster, [*pipes, *others], None, settings)):
                best = group[0]
                flange = _component(best, f"{station}-AF{len(found):02d}", None, station or None)
                # a blind flange is bolted to another one: alone it is a circle like many
                lonely = best.hypothesis.variant.blind and best.hypothesis.partner is None
                good = best.score >= settings.least_score_without_click and best.quality <= settings.largest_quality_without_click_px
                if good and not lonely and not any(_in_one_place(flange, other) for _, other in found):
                    found.append((best.score, flange))
    best_first = [flange for _, flange in sorted(found, key=lambda item: -item[0])]
    return tuple(distinct(best_first, lambda kept, flange: _same_edges(views, flange, kept)))


def _same_edges(views: Sequence[View], one: Flange, other: Flange) -> bool:
    """Return whether two flanges that are no pair lie behind each other in all images: one rim's edges, seen from two pipes."""
    if _faces(one, other):
        return False
    faces = np.array([one.face, other.face])
    for view in views:
        pixels = view.camera.project(np.concatenate([faces, faces + min(one.D, other.D) / 2 * view.camera.rotation[0]]))
        radius = np.linalg.norm(pixels[2:] - pixels[:2], axis=1).min()
        if not float(np.linalg.norm(pixels[1] - pixels[0])) < BEHIND_SHARE * radius:
            return False
    return True


def _in_one_place(one: Flange, other: Flange) -> bool:
    """Return whether two plates overlap: they are the same flange, or one of them is none."""
    axis = np.array(one.axis)
    offset = np.array(other.face) - one.face
    along = float(offset @ axis)
    if float(np.linalg.norm(across(offset, axis))) > (one.D + other.D) / 4:
        return False
    sign = 1 if float(np.dot(one.axis, other.axis)) > 0 else -1
    low, high = sorted((along, along - sign * other.C))
    return min(high, 0.0) - max(low, -one.C) > OVERLAP_MM


def _distance_from_pipe(pipe: Pipe, point: Array) -> float:
    start, end = np.array(pipe.start), np.array(pipe.end)
    part = float(np.clip((point - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1))
    return float(np.linalg.norm(start + part * (end - start) - point))


__all__ = [
    "FlangeCandidate",
    "FlangeSettings",
    "FlangesFound",
    "attach",
    "attached",
    "detect",
    "from_pick",
    "of_picks",
    "partner_of",
    "with_dimensions",
]
