# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes from one pick: Sect. 4.2 of the paper, from two clicked edges to an adjusted cylinder.

The clicked edges are drawn onto the subpixel edges of their image, the cylinders they could be are
searched in all images, the best are adjusted with a free diameter; then the nearest standard diameter
is held, the pipe followed to its ends and adjusted over its whole length. Here the answer is chosen among what was found.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.candidates import PipeCandidate, same_cylinder
from pipeworkbench.recon.clicks import complete_picks
from pipeworkbench.recon.completion import adjusted_over_clicks, completed_pipe, contour_quality
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.groups import distinct
from pipeworkbench.recon.one_image import solution_of_one_image
from pipeworkbench.recon.pick_checks import found_plane_problem, no_fit, one_sided_problem, place_problem, plane_problem, size_problem
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import MOST_ALTERNATIVES, PipePick
from pipeworkbench.recon.search import Found, Searched, best_found, search_cylinders
from pipeworkbench.recon.tangents import PipeTangents, all_tangents_of
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import clicked_extents

INSIDE_SCORE, INSIDE_QUALITY = 80.0, 1.3  # logarithm, px; what a pipe must have whose edges nobody clicked: the others were wrong too often
UNSURE = "a pipe {:g} mm nearer or further fits nearly as well; click a longer part or clearer edges, or choose one of the alternatives"


@dataclass(frozen=True, eq=False)
class PickAnswer:
    """What a pick gives: the pipe that is ``chosen``, or a ``reason`` why none is.

    ``ranked`` are the alternatives that a person may choose from, best first, also where none is sure enough.
    """

    chosen: PipeCandidate | None
    ranked: tuple[PipeCandidate, ...]
    reason: str = ""


@dataclass(frozen=True, eq=False)
class Sighting:
    """What is known of a pick's pipe before it is answered: the ends (2, 3) of its axis and its diameter in mm.

    A ``candidate`` is one of the answers, followed to its ends; without one it is a guess, over what was clicked.
    """

    ends: Array
    diameter: float
    candidate: PipeCandidate | None = None


Tell = Callable[[Sighting], None]


def from_pick(views: Sequence[View], pick: PipePick, settings: PickSettings | None = None, candidates: int = 1) -> tuple[PipeCandidate, ...]:
    """Find the pipe that was clicked in one image: by two points on each edge, one near each, or one between them.

    Parameters
    ----------
    views : sequence of View
        All images of the station.
    pick : PipePick
    settings : PickSettings, optional
    candidates : int
        How many alternatives are wanted at most; each is followed to its ends and adjusted.

    Returns
    -------
    tuple of PipeCandidate
        Best first; empty where no cylinder fits the images, or where only one is wanted and another place
        fits nearly as well.
    """
    answer = answer_pick(views, pick, settings, candidates)
    if candidates > 1:
        return answer.ranked[:candidates]
    return () if answer.chosen is None else (answer.chosen,)


def answer_pick(views: Sequence[View], pick: PipePick, settings: PickSettings | None = None, candidates: int = 1) -> PickAnswer:
    """Find the pipe that was clicked, as :func:`from_pick` does, and say why where there is none.

    A pick that names one of the alternatives gets that one, however near the others come.
    """
    settings = settings or PickSettings()
    wholes = complete_picks(views[pick.camera], pick)
    inside = len(pick.edges) == 1
    if not wholes:
        return PickAnswer(None, (), _no_edges(inside=inside))
    searches = _Searches(views)
    best, reason = _surest([_from_edges(views, whole, settings, 1, searches) for whole in wholes], inside=inside)
    if candidates == 1 and pick.alternative is None:
        return PickAnswer(best, () if best is None else (best,), reason)
    others = [other for whole in wholes for other in _from_edges(views, whole, _wide(settings), MOST_ALTERNATIVES, searches)[0]]
    best_first = [*([] if best is None else [best]), *sorted(others, key=lambda other: -other.score)]
    ranked = distinct(best_first, lambda one, other: same_cylinder(other, one))[:MOST_ALTERNATIVES]
    if pick.alternative is None:
        return PickAnswer(best, tuple(ranked), reason)
    if pick.alternative <= len(ranked):
        return PickAnswer(ranked[pick.alternative - 1], tuple(ranked))
    if ranked:
        reason = f"there is no alternative {pick.alternative}, only {len(ranked)}; choose one of those, or leave the key out"
    return PickAnswer(None, tuple(ranked), reason)


def follow_pick(views: Sequence[View], pick: PipePick, tell: Tell, settings: PickSettings | None = None) -> PickAnswer:
    """Answer a pick for one who watches: what is seen on the way is told at once, the likeliest first, and all that it could be is ranked.

    Parameters
    ----------
    views : sequence of View
    pick : PipePick
    tell : callable
        Called with each sighting; what it raises ends the work.
    settings : PickSettings, optional

    Returns
    -------
    PickAnswer
        As that of :func:`answer_pick`; around one click the alternatives are the pipes of other pairs of edges, and of the likeliest pair.
    """
    settings = settings or PickSettings()
    wholes = complete_picks(views[pick.camera], pick)
    inside = len(pick.edges) == 1
    if not wholes:
        return PickAnswer(None, (), _no_edges(inside=inside))
    searches = _Searches(views, tell)
    answers = [_from_edges(views, whole, settings, 1, searches) for whole in wholes]
    best, reason = _surest(answers, inside=inside)
    sure = [candidate for found, _ in answers for candidate in found]
    scores = [max((candidate.score for candidate in found), default=-np.inf) for found, _ in answers]
    likeliest = wholes[int(np.argmax(scores))]
    others = sure + _from_edges(views, likeliest, _wide(settings), MOST_ALTERNATIVES, searches)[0]
    best_first = [*([] if best is None else [best]), *sorted(others, key=lambda other: -other.score)]
    return PickAnswer(best, tuple(distinct(best_first, lambda one, other: same_cylinder(other, one)))[:MOST_ALTERNATIVES], reason)


class _Searches:
    """The cylinders that picks could be, each searched once; what looks best on the way is told."""

    def __init__(self, views: Sequence[View], tell: Tell | None = None) -> None:
        self._views, self._tell = views, tell
        self._done: dict[PipePick, Searched | None] = {}

    def find(self, pick: PipePick, tangents: Sequence[PipeTangents], settings: PickSettings) -> list[Found]:
        """Return the best cylinders of a pick."""
        is_new = pick not in self._done
        origin = self._views[pick.camera].camera.projection_centre

        def guess(cylinder: Cylinder) -> None:
            if self._tell is not None:
                start, end = clicked_extents(cylinder.as_many(), origin, tangents[0])[0]
                self._tell(Sighting(np.array([cylinder.at(start), cylinder.at(end)]), 2 * cylinder.radius))

        if is_new:
            self._done[pick] = search_cylinders(self._views, pick, tangents, settings, guess)
        found = best_found(self._views, pick, tangents[0], self._done[pick], settings)
        if is_new and found:
            guess(found[0].cylinder)
        return found

    def tell(self, candidate: PipeCandidate) -> None:
        """Tell that a candidate was followed to its ends."""
        if self._tell is not None:
            diameter = candidate.size.outer_diameter if candidate.size else 2 * candidate.solution.cylinder.radius
            self._tell(Sighting(candidate.ends, diameter, candidate))


def _wide(settings: PickSettings) -> PickSettings:
    """Return settings with which all that a pick could be is found; how many are compared does not depend on how many are wanted."""
    return replace(settings, kept=MOST_ALTERNATIVES, least_lead=-np.inf, least_nearby_lead=-np.inf, least_elsewhere=-np.inf)


def _no_edges(*, inside: bool) -> str:
    if inside:
        return "no two edges of a pipe are seen around the click; click near both edges of the pipe"
    return "no straight edges run beside the clicks; click two points on each edge of the pipe"


def _surest(found: Sequence[tuple[list[PipeCandidate], str]], *, inside: bool) -> tuple[PipeCandidate | None, str]:
    """Return the best pipe of those found between the pairs of edges that a pick can mean, or the reason of the likeliest pair.

    Pairs around one click ``inside`` are guesses: what they give must fit better than what was clicked.
    """
    answers = [candidate for candidates, _ in found for candidate in candidates]
    if not answers:
        # the reason of a guess says nothing to a person who did not make it
        return None, "no pipe around the click fits the images; click near both edges of the pipe" if inside else found[0][1]
    best = max(answers, key=lambda answer: answer.score)
    if inside and (best.approximate or best.score < INSIDE_SCORE or best.quality > INSIDE_QUALITY):
        return None, "which edges around the click are the pipe's is not sure; click near both edges of the pipe"
    return best, ""


def _from_edges(
    views: Sequence[View], pick: PipePick, settings: PickSettings, candidates: int, searches: _Searches
) -> tuple[list[PipeCandidate], str]:
    """Return pipes between two clicked edges, at most ``candidates``, or why there is none."""
    tangents = all_tangents_of(views[pick.camera], pick)
    first = tangents[0]
    pixels_per_radian = views[pick.camera].camera.interior.pixels_per_radian
    problem = size_problem(pick, first, settings, pixels_per_radian)
    if not problem and (alone := place_problem(views, pick, first, settings)):
        return _from_one_image(views, pick, first, alone, settings)
    problem = problem or plane_problem(views, pick, first, settings)
    if problem:
        return [], problem
    adjusted = adjusted_over_clicks(views, pick, first, searches.find(pick, tangents, settings), settings)
    if adjusted and adjusted[0].lead < settings.least_lead:
        in_plane = found_plane_problem(views, pick, adjusted[0].solution.cylinder, adjusted[0].extent)
        return (
            [],
            in_plane
            or "pipes at two distances fit nearly as well; click where its edges are clearer, fix its diameter, or choose one of the alternatives",
        )
    found: list[PipeCandidate] = []
    for candidate in distinct(adjusted, lambda one, other: same_cylinder(other, one)):
        completed = completed_pipe(views, candidate, pick, first, settings)
        reason = _range_problem(views[pick.camera], completed, settings) or _objection(views, pick, completed, candidate, settings)
        problem = problem or reason
        if not reason:
            found.append(completed)
            searches.tell(completed)
        # where the best cannot be right, the next one is no better an answer, only an alternative
        if len(found) == candidates or (reason and candidates == 1 and _in_range(completed, views[pick.camera], settings)):
            break
    return found, "" if found else problem or no_fit(views, pick, first)


def _from_one_image(
    views: Sequence[View], pick: PipePick, tangents: PipeTangents, alone: str, settings: PickSettings
) -> tuple[list[PipeCandidate], str]:
    """Return the approximate pipe of a pick that no other image can show, or ``alone``, which says that, with what would help."""
    if not isinstance(pick.diameter, float):
        return [], f"{alone}, or give its diameter: then it is placed approximately from this image"
    solution = solution_of_one_image(views[pick.camera], pick, pick.diameter, tangents)
    if isinstance(solution, str):
        return [], f"{alone}; {solution}"
    diameter, extent = 2 * solution.cylinder.radius, (-solution.half_length, solution.half_length)
    q = contour_quality(views, solution.cylinder, extent, settings)
    candidate = PipeCandidate(solution, extent, pipe_size(diameter), q, diameter, 2 * solution.sigma_radius, 0.0, 0.0, approximate=True)
    problem = _range_problem(views[pick.camera], candidate, settings)
    return ([], problem) if problem else ([candidate], "")


def _objection(views: Sequence[View], pick: PipePick, completed: PipeCandidate, candidate: PipeCandidate, settings: PickSettings) -> str:
    """Return why what was found cannot be right or is not sure, or nothing; ``candidate`` is the clicked part of what was ``completed``."""
    cylinder = completed.solution.cylinder
    middle = float((candidate.solution.cylinder.point - cylinder.point) @ cylinder.direction)
    clicked = (middle + candidate.extent[0], middle + candidate.extent[1])
    problem = one_sided_problem(views, pick, cylinder, clicked)
    if problem or completed.nearby_lead >= settings.least_nearby_lead:
        return problem  # its surface may tell the distance where its edges cannot
    return found_plane_problem(views, pick, cylinder, completed.extent) or UNSURE.format(settings.certain_within)


def _in_range(candidate: PipeCandidate, view: View, settings: PickSettings) -> bool:
    """Tell whether the clicked part of a pipe lies in the working range."""
    near, far = settings.working_range
    return near <= _distance(candidate, view) <= far


def _distance(candidate: PipeCandidate, view: View) -> float:
    return float(np.linalg.norm(candidate.solution.cylinder.point - view.camera.projection_centre))


def _range_problem(view: View, candidate: PipeCandidate, settings: PickSettings) -> str:
    """Return that a pipe is out of the working range, or nothing."""
    if _in_range(candidate, view, settings):
        return ""
    near, far = settings.working_range
    distance = _distance(candidate, view)
    return f"the pipe is {distance:.0f} mm from the camera, outside the working range of {near:g} to {far:g} mm; widen the range"
