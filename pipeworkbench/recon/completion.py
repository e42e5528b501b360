# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a cylinder that was found to a pipe: adjusted over the clicked part, followed to its ends, adjusted over its whole length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.cylinder import Cylinder, joined
from pipeworkbench.recon.cylinder_adjustment import HELD_RADIUS_SIGMA, AdjustSettings, CylinderSolution, adjust_cylinder
from pipeworkbench.recon.extent import extent_of
from pipeworkbench.recon.match import quality
from pipeworkbench.recon.moves import LEAST_GAIN, best_moved, lead_over_neighbours
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.placement import outline_match
from pipeworkbench.recon.search import Found
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import clicked_extents, weights_of

COARSE = AdjustSettings(spacing=6.0, ranges=(3.0,), iterations=4)  # enough to compare candidates
UNMOVED = AdjustSettings(spacing=6.0, ranges=(1.5,), iterations=0)
FINAL = AdjustSettings(ranges=(2.0, 1.5))  # what is settled must not wander off to a neighbour
SURE_GAIN = 5.0  # logarithm; what a place must gain over the one that the edges of a whole pipe give
LEAST_SEEN = 0.35  # part of all samples that must find an edge, else the pipe is approximate
WORST_QUALITY = 0.75  # of the quality's search range; near it most edges are missing or others'
LEAST_SUPPORT = 0.5  # of the clicked part's: a pipe whose extension finds fewer edges was followed too far
SURE_SUPPORT = 0.75  # of the clicked part's: an extension with fewer edges says how far the pipe reaches, but not where it is


def adjusted_over_clicks(
    views: Sequence[View], pick: PipePick, tangents: PipeTangents, found: Sequence[Found], settings: PickSettings
) -> list[PipeCandidate]:
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


def completed_pipe(views: Sequence[View], candidate: PipeCandidate, pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> PipeCandidate:
    """Follow the pipe to where its edges end and adjust it over all of its length, a standard diameter held."""
    solution, extent = candidate.solution, candidate.extent
    held = None if pick.diameter == "free" else (solution.cylinder.radius, HELD_RADIUS_SIGMA)
    followed = extent_of(views, solution.cylinder, extent, settings.extent)
    longer = _adjusted_over(views, pick, tangents, solution.cylinder, followed.both, held, settings)
    gaps = candidate.gaps
    if longer is not None and longer.support >= LEAST_SUPPORT * solution.support:
        if longer.support >= SURE_SUPPORT * solution.support:
            solution = longer
            followed = extent_of(views, longer.cylinder, (-longer.half_length, longer.half_length), settings.extent)
        extent, gaps = followed.both, followed.gaps
    poor = candidate.approximate or solution.support < LEAST_SEEN
    free = adjust_cylinder(views, solution.cylinder, extent, None, FINAL) or solution
    diameter, sigma = 2 * free.cylinder.radius, 2 * free.sigma_radius
    if held is not None:
        tolerance = np.hypot(max(settings.tolerance * diameter, settings.least_tolerance), 2 * sigma)
        poor |= pick.diameter is None and abs(diameter - 2 * solution.cylinder.radius) > tolerance
    nearby_lead = lead_over_neighbours(views, pick, tangents, solution.cylinder, settings)
    q = contour_quality(views, solution.cylinder, extent, settings)
    poor |= q > WORST_QUALITY * settings.final_range
    return replace(
        candidate,
        solution=solution,
        extent=extent,
        quality=q,
        diameter=diameter,
        sigma_diameter=sigma,
        nearby_lead=nearby_lead,
        approximate=bool(poor),
        gaps=gaps,
    )


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


def contour_quality(views: Sequence[View], cylinder: Cylinder, extent: tuple[float, float], settings: PickSettings) -> float:
    """Return Eq. 4's q over all views that show enough of a pipe, px."""
    along = np.linspace(*extent, 100)
    distances = [outline_match(view, cylinder, along, settings.final_range).distance for view in views]
    distances = [distance for distance in distances if len(distance) >= settings.least_visible * 2 * len(along)]
    return float(quality(np.concatenate(distances), settings.final_range)) if distances else settings.final_range
