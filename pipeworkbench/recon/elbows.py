# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elbows between two ends whose axes meet: Sect. 5 of the paper, found without a click.

Every two ends whose axes are coplanar are candidates; each bend radius of the catalogue for the diameter is
drawn onto the edges, with the axes held by what is known of the pipes, and weighed. The best is an elbow where its
contours match (Eq. 4) and are much more likely than by chance; its type is the standard's where
no other type fits nearly as well, else the radius is free (Sect. 7.3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.catalogue import Bend, bends
from pipeworkbench.pipeline import AnyComponent, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.course_fit import AxisObservations, CourseEvidence, FitSettings, fitted, weighed
from pipeworkbench.recon.courses import Courses, near_sight
from pipeworkbench.recon.ends import Corners, Ends, axis_observations, corners_of, each_end_once, ends_of, in_line, segments_of
from pipeworkbench.recon.groups import distinct
from pipeworkbench.recon.views import View

FREE_RADII = (0.8, 1.2, 1.8, 2.6, 3.8)  # diameters; where free radii are begun
NOT_SHOWN = 10.0  # what a bend without edges of its own loses in the comparison, logarithm
CHUNK = 100  # candidates at a time, for the memory's sake
SAME_RADIUS = 0.03  # relative; standards that differ by less mean one bend


@dataclass(frozen=True)
class ElbowSettings:
    """Tunables of the search; the first group are the paper's (Sect. 9.2), diameters are outside diameters.

    ``largest_skew`` and ``largest_skew_mm`` limit the distance of the axes, whichever is more, with ``skew_growth`` for each mm that an end is
    extrapolated by; ``standard_angles_deg`` are those
    that bends are made with, ``angle_tolerance_deg`` how far from them axes may be (None: any angle between
    ``least_angle_deg`` and ``largest_angle_deg``); ``gap`` and ``gap_mm``, whichever is more, how far beyond the largest bend an end may
    be from the corner, ``overshoot`` how far an end may lie beyond the tangent point of the smallest bend; ``collinear_*``
    say what counts as an object that goes on in line (then it is a tee).

    ``worst_quality`` is the threshold of Eq. 4's q in px, ``least_support`` the part of the bend's samples that
    find an edge, ``least_bend`` the logarithm of how much more likely than by chance a sample's edge is;
    ``far_bend`` is asked for where an end is further off the bend than ``near_gap`` diameters; ``poor_bend`` and ``poor_support`` are enough for a
    type that leads by ``far_lead``. ``clear`` is by how much (logarithm) a type must fit better than any other, ``clear_free`` a
    free radius better than a standard's; a free radius within ``sigmas`` standard deviations or ``radius_tolerance`` of a standard's is
    that. Where no standard fits, ``free_bend`` is asked for and a radius known to ``largest_sigma`` of itself,
    and only where ``hope`` of some standard bend's samples find an edge.
    """

    largest_skew: float = 0.15
    largest_skew_mm: float = 15.0
    skew_growth: float = 0.03
    standard_angles_deg: tuple[float, ...] = (90.0, 60.0, 45.0, 30.0)
    angle_tolerance_deg: float | None = None
    least_angle_deg: float = 12.0
    largest_angle_deg: float = 135.0
    gap: float = 3.0
    gap_mm: float = 420.0
    overshoot: float = 1.2
    diameter_tolerance: float = 0.02
    collinear_offset: float = 0.5
    collinear_angle_deg: float = 4.0
    collinear_gap: float = 4.0

    worst_quality: float = 2.3
    least_support: float = 0.45
    least_bend: float = 0.25
    far_bend: float = 0.5
    poor_bend: float = 0.05
    poor_support: float = 0.6
    far_lead: float = 8.0
    near_gap: float = 1.5
    least_visible: float = 0.12
    clear: float = 2.0
    clear_free: float = 6.0
    sigmas: float = 3.0
    radius_tolerance: float = 0.08
    free_bend: float = 0.6
    largest_sigma: float = 0.15
    hope: float = 0.3
    margin: float = 0.75  # diameters of straight pipe beyond the largest bend that are compared too
    coarse: FitSettings = field(default_factory=lambda: FitSettings(ranges=(6.0, 4.0, 3.0, 2.0), samples=36))
    fit: FitSettings = field(default_factory=lambda: FitSettings(ranges=(2.5, 2.0), samples=72))
    patient: FitSettings = field(default_factory=lambda: FitSettings(ranges=(6.0, 5.0, 4.0, 3.0, 3.0, 2.0, 2.0, 2.0), edge_sigma=4.0))
    free: FitSettings = field(default_factory=lambda: FitSettings(ranges=(4.0, 3.0, 2.0), samples=36))


@dataclass(frozen=True, eq=False)
class FoundElbow:
    """An elbow between two ends: rows of the components with their ports, the corner (3,) mm, the bend, how well it fits.

    ``come`` (3,) and ``go`` (3,) are the unit directions of the axes towards and away from the corner; ``bend`` is None
    where the radius is free; ``lead`` is the logarithm of how much better it fits than the next type.
    """

    first: tuple[int, int]
    second: tuple[int, int]
    corner: Array
    come: Array
    go: Array
    bend_radius: float
    bend: Bend | None
    outer_diameter: float
    quality: float
    score: float
    lead: float


def candidates_of(components: Sequence[AnyComponent], ends: Ends, settings: ElbowSettings) -> Corners:
    """Return the pairs of ends between which an elbow may be."""
    corners = corners_of(ends)
    first, second = ends.diameter[corners.first], ends.diameter[corners.second]
    diameter = (first + second) / 2
    with np.errstate(invalid="ignore"):
        good = np.abs(first - second) <= settings.diameter_tolerance * diameter
        good &= corners.skew <= np.maximum(settings.largest_skew * diameter, settings.largest_skew_mm) + settings.skew_growth * np.maximum(
            corners.ahead.max(axis=1), 0
        )
        good &= (corners.angle >= np.radians(settings.least_angle_deg)) & (corners.angle <= np.radians(settings.largest_angle_deg))
        if settings.angle_tolerance_deg is not None:
            off = np.abs(np.degrees(corners.angle)[:, None] - np.array(settings.standard_angles_deg)).min(axis=1)
            good &= off <= settings.angle_tolerance_deg
    corners, diameter = corners[good], diameter[good]
    radii = [[bend.bend_radius for bend in bends(d)] or [0.7 * d, 3 * d] for d in diameter]
    half = np.tan(corners.angle / 2)
    shortest = np.array([min(r) for r in radii]) * half
    longest = np.array([max(r) for r in radii]) * half
    slack = np.maximum(settings.gap * diameter, settings.gap_mm)
    reachable = (corners.ahead >= (shortest - settings.overshoot * diameter)[:, None]) & (corners.ahead <= (longest + slack)[:, None])
    corners = corners[reachable.all(axis=1)]
    pipes = [c for c in components if isinstance(c, Pipe)]
    angle = float(np.radians(settings.collinear_angle_deg))
    beyond, between = in_line(ends, corners, segments_of(pipes), settings.collinear_offset, angle, settings.collinear_gap)
    return corners[~(beyond | between).any(axis=1)]


def detect(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    settings: ElbowSettings | None = None,
    taken: frozenset[tuple[int, int]] = frozenset(),
) -> tuple[FoundElbow, ...]:
    """Find the elbows between components.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        In the station's frame.
    settings : ElbowSettings, optional
    taken : frozenset of (row, port)
        Ends that are joined already.

    Returns
    -------
    tuple of FoundElbow
        Each end has one elbow at most.
    """
    settings = settings or ElbowSettings()
    ends = ends_of(components, taken)
    corners = candidates_of(components, ends, settings)
    if not len(corners):
        return ()
    parts = np.array_split(np.arange(len(corners)), -(-len(corners) // CHUNK))
    found = [elbow for part in parts for elbow in _confirmed_elbows(views, components, ends, corners[part], settings)]
    return tuple(each_end_once(sorted(found, key=lambda elbow: -elbow.score), lambda elbow: (elbow.first, elbow.second)))


@dataclass(frozen=True, eq=False)
class _Hypotheses:
    """Courses with the standard bends (None: a free radius), the candidates they belong to and what is known of their axes."""

    courses: Courses
    bends: list[Bend | None]
    group: NDArray[np.intp]
    observed: AxisObservations
    obstacles: list[tuple[Array, Array, Array]]

    def __getitem__(self, rows: NDArray[np.intp]) -> _Hypotheses:
        picked = [int(row) for row in rows]
        return _Hypotheses(
            self.courses[rows], [self.bends[r] for r in picked], self.group[rows], self.observed[rows], [self.obstacles[r] for r in picked]
        )


def _hypotheses(
    views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, corners: Corners, settings: ElbowSettings, *, free: bool = False
) -> _Hypotheses:
    """Return every bend of the catalogue for every candidate; with ``free`` and for unknown diameters, radii to begin a free one at."""
    diameter = (ends.diameter[corners.first] + ends.diameter[corners.second]) / 2
    choices: list[tuple[int, Bend | None, float]] = []
    for number, d in enumerate(diameter):
        known = () if free else _distinct_bends(bends(d))
        choices += [(number, bend, bend.bend_radius) for bend in known] or [(number, None, float(d) * factor) for factor in FREE_RADII]
    group = np.array([number for number, _, _ in choices], np.intp)
    radius = np.array([r for _, _, r in choices])
    come, go = ends.direction[corners.first], -ends.direction[corners.second]
    longest = np.zeros(len(corners))
    np.maximum.at(longest, group, radius * np.tan(corners.angle[group] / 2))
    reach = longest + settings.margin * diameter
    courses = Courses(corners.corner[group], come[group], go[group], radius, diameter[group] / 2, reach[group])
    first, first_covariance = axis_observations(components, ends, corners.first)
    second, second_covariance = axis_observations(components, ends, corners.second)
    observed = AxisObservations(np.concatenate([first, second], axis=1), np.concatenate([first_covariance, second_covariance], axis=1))
    obstacles = _obstacles(views, components, ends, corners, reach)
    return _Hypotheses(courses, [bend for _, bend, _ in choices], group, observed[group], [obstacles[number] for number in group])


def _distinct_bends(known: Sequence[Bend]) -> tuple[Bend, ...]:
    """Return bends without those that images cannot tell apart, where the standards round differently: the better sourced stays."""

    def alike(kept: Bend, bend: Bend) -> bool:
        return kept.bend_type == bend.bend_type and abs(kept.bend_radius - bend.bend_radius) <= SAME_RADIUS * bend.bend_radius

    return tuple(distinct(sorted(known, key=lambda bend: -bend.verified), alike))


def _obstacles(
    views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, corners: Corners, reach: Array
) -> list[tuple[Array, Array, Array]]:
    """Return, for each candidate, the other pipes that do not touch it but may stand before it."""
    pipes = [(row, c) for row, c in enumerate(components) if isinstance(c, Pipe)]
    rows = np.array([row for row, _ in pipes], np.intp)
    starts, stops = segments_of([c for _, c in pipes])
    radii = np.array([c.outer_diameter / 2 for _, c in pipes])
    axis = stops - starts
    offset = corners.corner[:, None] - starts
    place = np.clip(np.einsum("cpi,pi->cp", offset, axis) / np.einsum("pi,pi->p", axis, axis), 0, 1)
    apart = np.linalg.norm(offset - place[..., None] * axis, axis=2) > reach[:, None]
    other = (rows != ends.owner[corners.first][:, None]) & (rows != ends.owner[corners.second][:, None])
    around = reach + ends.diameter[corners.first]
    before = np.any([near_sight(view, corners.corner, around, starts, stops, radii) for view in views], axis=0)
    return [(starts[near], stops[near], radii[near]) for near in apart & other & before]


@dataclass(frozen=True, eq=False)
class _Fit:
    """Fitted hypotheses with their evidence, standard deviations of free radii (k,) in mm, and which samples are hidden in each view."""

    hypotheses: _Hypotheses
    courses: Courses
    weight: CourseEvidence
    sigma_radius: Array
    hidden: list[NDArray[np.bool_]]

    def best_of(self, number: int) -> list[int]:
        """Return the best row of each type of a candidate, the best type first."""
        rows = np.flatnonzero(self.hypotheses.group == number)
        best: dict[str | None, int] = {}
        for row in rows[np.argsort(-self.weight.score[rows], kind="stable")]:
            bend = self.hypotheses.bends[row]
            best.setdefault(bend.bend_type if bend else None, int(row))
        return list(best.values())


def _fit(views: Sequence[View], hypotheses: _Hypotheses, settings: FitSettings, *, free: bool = False) -> _Fit:
    courses, sigma, hidden = fitted(views, hypotheses.courses, hypotheses.observed, settings, hypotheses.obstacles, free_radius=free)
    weight = weighed(views, courses, hypotheses.observed, hypotheses.group, settings, hidden)
    # straight pieces that fit do not make a bend: one that no edges show is behind all that they show
    shown = weight.bend > 0
    return _Fit(replace(hypotheses, courses=courses), courses, replace(weight, score=weight.score - np.where(shown, 0.0, NOT_SHOWN)), sigma, hidden)


def _confirmed_elbows(
    views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, corners: Corners, settings: ElbowSettings
) -> list[FoundElbow]:
    """Return the elbows of all candidates that the images confirm: with a standard radius, else with a free one."""
    coarse = _fit(views, _hypotheses(views, components, ends, corners, settings), settings.coarse)
    # few samples tell which two types it can be, all of them which one it is
    two = np.array([row for number in range(len(corners)) for row in coarse.best_of(number)[:2]], np.intp)
    fine = _fit(views, coarse.hypotheses[two], settings.fit)
    first = np.array([fine.best_of(number)[0] for number in range(len(corners))], np.intp)
    free = _fit(views, fine.hypotheses[first], settings.free, free=True)
    # the same samples and density by chance for both
    again = weighed(views, fine.courses[first], fine.hypotheses.observed[first], np.arange(len(first)), settings.free, free.hidden)
    found, rest = [], []
    for number in range(len(corners)):
        ranking = fine.best_of(number)
        row = ranking[0]
        bend = fine.hypotheses.bends[row]
        lead = float(fine.weight.score[row] - fine.weight.score[ranking[1]]) if len(ranking) > 1 else np.inf
        better = float(free.weight.score[number] - again.score[number])
        radius, sigma = float(free.courses.bend_radius[number]), float(free.sigma_radius[number])
        if bend is not None and (lead < settings.clear or better > settings.clear_free):
            near = _nearest_bend(fine.hypotheses, number, radius, sigma, settings)
            # where no radius is much better than a standard's, the type that fits best stays
            bend = near if near is not None or better > settings.clear_free else bend
        if bend is not None and bend.bend_type != getattr(fine.hypotheses.bends[row], "bend_type", None) and len(ranking) > 1:
            row = ranking[1]
        chosen, at = (fine, row) if bend is not None else (free, number)
        if _is_confirmed(chosen, at, corners, number, lead if bend is not None else np.inf, settings):
            found.append(_elbow(chosen, at, bend, lead, ends, corners, number))
        else:
            rest.append(number)
    # where hardly an edge is near any bend there is nothing to look for
    rest = [number for number in rest if coarse.weight.support[coarse.hypotheses.group == number].max() >= settings.hope]
    return found + _second_look(views, components, ends, corners[np.array(rest, np.intp)], settings)


def _second_look(
    views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, corners: Corners, settings: ElbowSettings
) -> list[FoundElbow]:
    """Return what more patience finds: pipes whose axes are worse than they say, and radii that are no standard's."""
    if not len(corners):
        return []
    patient = _fit(views, _hypotheses(views, components, ends, corners, settings), settings.patient)
    free = _fit(views, _hypotheses(views, components, ends, corners, settings, free=True), settings.free, free=True)
    found = []
    for number in range(len(corners)):
        ranking = patient.best_of(number)
        row, other = ranking[0], free.best_of(number)[0]
        bend = patient.hypotheses.bends[row]
        lead = float(patient.weight.score[row] - patient.weight.score[ranking[1]]) if len(ranking) > 1 else 0.0
        known = free.sigma_radius[other] <= settings.largest_sigma * free.courses.bend_radius[other] and free.weight.bend[other] >= settings.free_bend
        if bend is not None and lead >= settings.clear and _is_confirmed(patient, row, corners, number, lead, settings):
            found.append(_elbow(patient, row, bend, lead, ends, corners, number))
        elif known and _is_confirmed(free, other, corners, number, np.inf, settings):
            found.append(_elbow(free, other, None, np.inf, ends, corners, number))
    return found


def _nearest_bend(hypotheses: _Hypotheses, number: int, radius: float, sigma: float, settings: ElbowSettings) -> Bend | None:
    """Return the standard bend whose radius a free one agrees with, None where there is none."""
    known = [b for row, b in enumerate(hypotheses.bends) if b is not None and hypotheses.group[row] == number]
    near = min(known, key=lambda b: abs(b.bend_radius - radius))
    tolerance = max(settings.sigmas * sigma, settings.radius_tolerance * near.bend_radius)
    return near if abs(near.bend_radius - radius) <= tolerance else None


def _is_confirmed(fit: _Fit, row: int, corners: Corners, number: int, lead: float, settings: ElbowSettings) -> bool:
    """Tell whether the images show an elbow."""
    length = float(fit.courses.tangent_length[row])
    far = corners.ahead[number].max() - length > settings.near_gap * 2 * fit.courses.tube_radius[row]
    bend = float(fit.weight.bend[row])
    sure = bend >= (settings.far_bend if far else settings.least_bend)
    # few good edges are enough where all other radii find none
    clear = bend >= settings.poor_bend and lead >= settings.far_lead and fit.weight.support[row] >= settings.poor_support
    return bool(
        (sure or clear)
        and fit.weight.quality[row] <= settings.worst_quality
        and fit.weight.support[row] >= settings.least_support
        and fit.weight.seen[row] >= settings.least_visible
    )


def _elbow(fit: _Fit, row: int, bend: Bend | None, lead: float, ends: Ends, corners: Corners, number: int) -> FoundElbow:
    first, second = int(corners.first[number]), int(corners.second[number])
    return FoundElbow(
        first=ends.row_and_port(first),
        second=ends.row_and_port(second),
        corner=fit.courses.corner[row],
        come=fit.courses.come[row],
        go=fit.courses.go[row],
        bend_radius=bend.bend_radius if bend is not None else float(fit.courses.bend_radius[row]),
        bend=bend,
        outer_diameter=float(2 * fit.courses.tube_radius[row]),
        quality=float(fit.weight.quality[row]),
        score=float(fit.weight.score[row]),
        lead=lead,
    )
