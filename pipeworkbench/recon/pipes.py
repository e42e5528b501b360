# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes from one pick: Sect. 4.2 of the paper, from two clicked edges to an adjusted cylinder.

The clicked edges are drawn onto the subpixel edges of their image, the cylinders they could be are
searched in all images, the best are adjusted with a free diameter; then the nearest standard diameter
is held, the pipe followed to its ends and adjusted over its whole length.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.catalogue import PipeSize, pipe_size
from pipeworkbench.recon.adjust import AdjustSettings, CylinderSolution, adjust_cylinder
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.clicks import complete_picks
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.extent import extent_of
from pipeworkbench.recon.match import match, quality
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.search import (
    LEAST_GAIN,
    Found,
    PickSettings,
    best_moved,
    clicked_extents,
    find_cylinders,
    joined,
    lead_over_neighbours,
    weights_of,
)
from pipeworkbench.recon.tangents import PipeTangents, all_tangents_of
from pipeworkbench.recon.views import View

COARSE = AdjustSettings(spacing=6.0, ranges=(3.0,), iterations=4)  # enough to compare candidates
UNMOVED = AdjustSettings(spacing=6.0, ranges=(1.5,), iterations=0)
FINAL = AdjustSettings(ranges=(2.0, 1.5))  # what is settled must not wander off to a neighbour
HELD_RADIUS_SIGMA = 1e-4  # mm; a pseudo-observation with a weight that no number of edges moves
SURE_GAIN = 5.0  # logarithm; what a place must gain over the one that the edges of a whole pipe give
LEAST_SEEN = 0.35  # part of all samples that must find an edge, else the pipe is approximate
WORST_QUALITY = 0.75  # of the quality's search range; near it most edges are missing or others'
LEAST_SUPPORT = 0.5  # of the clicked part's: a pipe whose extension finds fewer edges was followed too far


@dataclass(frozen=True, eq=False)
class PipeCandidate:
    """A pipe that fits the images: geometry, standard size (None where free) and quality.

    ``extent`` is where its edges are seen, in mm along the axis; ``quality`` Eq. 4's q in px over
    all views; ``diameter`` in mm the adjusted one, with ``sigma_diameter``, before the standard's was held;
    ``score`` the logarithm of how much more likely it is than clutter, ``lead`` than the best pipe elsewhere.
    """

    solution: CylinderSolution
    extent: tuple[float, float]
    size: PipeSize | None
    quality: float
    diameter: float
    sigma_diameter: float
    score: float
    lead: float
    approximate: bool

    @property
    def ends(self) -> Array:
        """End points of the axis (2, 3) in mm."""
        return np.array([self.solution.cylinder.at(self.extent[0]), self.solution.cylinder.at(self.extent[1])])


def from_pick(views: Sequence[View], pick: PipePick, settings: PickSettings | None = None, candidates: int = 1) -> tuple[PipeCandidate, ...]:
    """Find the pipe that was clicked in one image: by two points on each edge or one near each.

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
    settings = settings or PickSettings()
    answers = [answer for whole in complete_picks(views[pick.camera], pick) for answer in _from_edges(views, whole, settings, candidates)]
    answers.sort(key=lambda answer: -answer.score)
    return tuple(answers[:candidates])


def _from_edges(views: Sequence[View], pick: PipePick, settings: PickSettings, candidates: int) -> tuple[PipeCandidate, ...]:
    tangents = all_tangents_of(views[pick.camera], pick)
    found: list[PipeCandidate] = []
    adjusted = _adjusted(views, pick, tangents[0], find_cylinders(views, pick, tangents, settings), settings)
    for candidate in adjusted:
        if not any(_same(candidate, other) for other in found):
            found.append(candidate)
    completed = (_completed(views, candidate, pick, tangents[0], settings) for candidate in found)
    answers = tuple(itertools.islice((c for c in completed if _in_range(c, views[pick.camera], settings)), candidates))
    return () if candidates == 1 and answers and answers[0].lead < settings.least_lead else answers


def _adjusted(views: Sequence[View], pick: PipePick, tangents: PipeTangents, found: Sequence[Found], settings: PickSettings) -> list[PipeCandidate]:
    """Adjust hypotheses over the clicked part with all images, their diameters held where they are a standard's."""
    origin = views[pick.camera].camera.projection_centre
    solutions: list[tuple[Found, CylinderSolution]] = []
    for hypothesis in found:
        start, end = clicked_extents(hypothesis.cylinder.as_many(), origin, tangents)[0]
        held = None if pick.diameter == "free" else (hypothesis.cylinder.radius, HELD_RADIUS_SIGMA)
        # edges measure best, but where they are other things' the place that texture and edges gave is better left
        for how in (COARSE, UNMOVED):
            solution = adjust_cylinder(views, hypothesis.cylinder, (float(start), float(end)), held, how)
            if solution is not None:
                solutions.append((hypothesis, solution))
    if not solutions:
        return []
    series = np.array([hypothesis.size.series if hypothesis.size else 1 for hypothesis, _ in solutions], float)
    cylinders = joined([solution.cylinder.as_many() for _, solution in solutions])
    weights = weights_of(views, pick, tangents, cylinders, series, settings)
    scores = weights.total
    candidates = []
    for hypothesis in found:
        rows = [row for row, (owner, _) in enumerate(solutions) if owner is hypothesis]
        if not rows:
            continue
        row = max(rows, key=lambda row: float(scores[row]) - (LEAST_GAIN if solutions[row][1].iterations == 0 else 0.0))
        if weights.elsewhere[row] < settings.least_elsewhere:
            continue
        solution, score = solutions[row][1], float(scores[row])
        diameter, sigma = 2 * solution.cylinder.radius, 2 * solution.sigma_radius
        size = pipe_size(pick.diameter) if isinstance(pick.diameter, float) else hypothesis.size
        extent = (-solution.half_length, solution.half_length)
        poor = score < settings.least_score
        candidates.append(PipeCandidate(solution, extent, size, np.inf, diameter, sigma, score, hypothesis.lead, approximate=poor))
    return candidates


def _completed(views: Sequence[View], candidate: PipeCandidate, pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> PipeCandidate:
    """Follow the pipe to where its edges end and adjust it over all of its length, a standard diameter held."""
    solution, extent = candidate.solution, candidate.extent
    held = None if pick.diameter == "free" else (solution.cylinder.radius, HELD_RADIUS_SIGMA)
    followed = extent_of(views, solution.cylinder, extent, settings.extent)
    longer = _adjusted_over(views, pick, tangents, solution.cylinder, followed, held, settings)
    if longer is not None and longer.support >= LEAST_SUPPORT * solution.support:
        solution = longer
        extent = extent_of(views, longer.cylinder, (-longer.half_length, longer.half_length), settings.extent)
    poor = candidate.approximate or solution.support < LEAST_SEEN
    free = adjust_cylinder(views, solution.cylinder, extent, None, FINAL) or solution
    diameter, sigma = 2 * free.cylinder.radius, 2 * free.sigma_radius
    if held is not None:
        tolerance = np.hypot(max(settings.tolerance * diameter, settings.least_tolerance), 2 * sigma)
        poor |= pick.diameter is None and abs(diameter - 2 * solution.cylinder.radius) > tolerance
    lead = min(candidate.lead, lead_over_neighbours(views, pick, tangents, solution.cylinder, settings))
    q = _final_quality(views, solution.cylinder, extent, settings)
    poor |= q > WORST_QUALITY * settings.final_range
    return replace(candidate, solution=solution, extent=extent, quality=q, diameter=diameter, sigma_diameter=sigma, lead=lead, approximate=bool(poor))


def _adjusted_over(
    views: Sequence[View],
    pick: PipePick,
    tangents: PipeTangents,
    cylinder: Cylinder,
    extent: tuple[float, float],
    held: tuple[float, float] | None,
    settings: PickSettings,
) -> CylinderSolution | None:
    """Adjust a pipe over all of its length, but not to edges on which its texture does not fit."""
    wide = adjust_cylinder(views, cylinder, extent, held, FINAL)
    unmoved = adjust_cylinder(views, cylinder, extent, held, UNMOVED)
    if wide is None or unmoved is None or held is None:
        return wide or unmoved
    half = wide.half_length
    ends = np.array([[-half, half]] * 2)
    both = joined([wide.cylinder.as_many(), unmoved.cylinder.as_many()])
    moved, weights = best_moved(views, pick, tangents, both, ends, np.ones(2), settings)
    as_it_is = weights_of(views, pick, tangents, wide.cylinder.as_many(), 1.0, settings, ends[:1]).total[0]
    row = int(np.argmax(weights.total))
    if weights.total[row] < as_it_is + SURE_GAIN:
        return wide
    return adjust_cylinder(views, moved.one(row), (-half, half), held, UNMOVED) or wide


def _final_quality(views: Sequence[View], cylinder: Cylinder, extent: tuple[float, float], settings: PickSettings) -> float:
    along = np.linspace(*extent, 100)
    distances = []
    for view in views:
        position, normal = (x.reshape(-1, 2) for x in outlines(view.camera, cylinder.as_many(), along[None]))
        visible = np.isfinite(position[:, 0])
        if np.count_nonzero(visible) >= settings.least_visible * len(position):
            distances.append(match(view.edges, position[visible], normal[visible], settings.final_range).distance)
    return float(quality(np.concatenate(distances), settings.final_range)) if distances else settings.final_range


def _in_range(candidate: PipeCandidate, view: View, settings: PickSettings) -> bool:
    """Tell whether the clicked part of a pipe lies in the working range."""
    distance = float(np.linalg.norm(candidate.solution.cylinder.point - view.camera.projection_centre))
    near, far = settings.working_range
    return near <= distance <= far


def _same(one: PipeCandidate, other: PipeCandidate) -> bool:
    """Tell whether two candidates are one cylinder: axes within a tenth of the diameter at both ends."""
    ends = one.ends
    offset = ends - other.solution.cylinder.point
    offset -= np.outer(offset @ other.solution.cylinder.direction, other.solution.cylinder.direction)
    return one.size == other.size and bool(np.linalg.norm(offset, axis=1).max() < 0.1 * other.diameter)
