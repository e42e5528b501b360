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
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.extent import extent_of
from pipeworkbench.recon.match import match, quality
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.search import PickSettings, clicked_extents, find_cylinders, scores_of, sizes_in
from pipeworkbench.recon.tangents import PipeTangents, tangents_of
from pipeworkbench.recon.views import View

COARSE = AdjustSettings(spacing=6.0, ranges=(3.0,), iterations=4)  # enough to compare candidates
FINAL = AdjustSettings(ranges=(3.0, 2.0))  # what is settled must not wander off to a neighbour
HELD_RADIUS_SIGMA = 1e-4  # mm; a pseudo-observation with a weight that no number of edges moves
SERIES_MISFIT = 0.25  # tolerances: sizes of series 1 are far more common, another must fit that much better
LEAST_SEEN = 0.35  # part of all samples that must find an edge, else the pipe is approximate
WORST_QUALITY = 0.75  # of the quality's search range; near it most edges are missing or others'
LEAST_SUPPORT = 0.5  # of the clicked part's: a pipe whose extension finds fewer edges was followed too far


@dataclass(frozen=True, eq=False)
class PipeCandidate:
    """A pipe that fits the images: geometry, standard size (None where free) and quality.

    ``extent`` is where its edges are seen, in mm along the axis; ``quality`` Eq. 4's q in px over
    all views; ``diameter`` in mm the adjusted one, with ``sigma_diameter``, before the standard's was held.
    """

    solution: CylinderSolution
    extent: tuple[float, float]
    size: PipeSize | None
    quality: float
    diameter: float
    sigma_diameter: float
    score: float
    approximate: bool

    @property
    def ends(self) -> Array:
        """End points of the axis (2, 3) in mm."""
        return np.array([self.solution.cylinder.at(self.extent[0]), self.solution.cylinder.at(self.extent[1])])


def from_pick(views: Sequence[View], pick: PipePick, settings: PickSettings | None = None, candidates: int = 1) -> tuple[PipeCandidate, ...]:
    """Find the pipe whose two edges were clicked in one image.

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
        Best first; empty where no cylinder fits the images.
    """
    settings = settings or PickSettings()
    tangents = tangents_of(views[pick.camera], pick)
    found: list[PipeCandidate] = []
    for cylinder in find_cylinders(views, pick, tangents, settings):
        candidate = _adjusted(views, pick, tangents, cylinder, settings)
        if candidate is not None and candidate.score >= settings.hopeless_score and not any(_same(candidate, other) for other in found):
            found.append(candidate)
    found.sort(key=lambda c: -c.score)
    completed = (_completed(views, candidate, pick, settings) for candidate in found)
    return tuple(itertools.islice((c for c in completed if _in_range(c, views[pick.camera], settings)), candidates))


def _adjusted(views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinder: Cylinder, settings: PickSettings) -> PipeCandidate | None:
    """Adjust a hypothesis over the clicked part with all images and find its standard size."""
    origin = views[pick.camera].camera.projection_centre
    start, end = clicked_extents(cylinder.as_many(), origin, tangents)[0]
    fixed = (pick.diameter / 2, HELD_RADIUS_SIGMA) if isinstance(pick.diameter, float) else None
    solution = adjust_cylinder(views, cylinder, (float(start), float(end)), fixed, COARSE)
    if solution is None:
        return None
    diameter, sigma = 2 * solution.cylinder.radius, 2 * solution.sigma_radius
    size, fits = _size_of(pick, diameter, sigma, settings)
    extent = (-solution.half_length, solution.half_length)
    score = float(scores_of(views, pick, tangents, solution.cylinder.as_many(), np.array([extent]), np.array([diameter]), settings)[0])
    return PipeCandidate(solution, extent, size, np.inf, diameter, sigma, score, approximate=not fits or score < settings.least_score)


def _size_of(pick: PipePick, diameter: float, sigma: float, settings: PickSettings) -> tuple[PipeSize | None, bool]:
    """Return the standard size that the adjusted diameter is taken for, and whether it fits well."""
    if pick.diameter == "free":
        return None, True
    if pick.diameter is not None:
        return pipe_size(pick.diameter), True
    tolerance = np.hypot(max(settings.tolerance * diameter, settings.least_tolerance), 2 * sigma)
    best = min(sizes_in(settings), key=lambda size: abs(size.outer_diameter - diameter) / tolerance + SERIES_MISFIT * (size.series - 1))
    return best, bool(abs(best.outer_diameter - diameter) <= tolerance)


def _completed(views: Sequence[View], candidate: PipeCandidate, pick: PipePick, settings: PickSettings) -> PipeCandidate:
    """Hold the standard diameter, follow the pipe to where its edges end, adjust it over all of its length."""
    solution, extent = candidate.solution, candidate.extent
    diameter = pick.diameter if isinstance(pick.diameter, float) else candidate.size.outer_diameter if candidate.size else None
    held = None if diameter is None else (diameter / 2, HELD_RADIUS_SIGMA)
    solution = adjust_cylinder(views, solution.cylinder, extent, held, FINAL) or solution
    followed = extent_of(views, solution.cylinder, extent, settings.extent)
    longer = adjust_cylinder(views, solution.cylinder, followed, held, FINAL)
    if longer is not None and longer.support >= LEAST_SUPPORT * solution.support:
        solution = longer
        extent = extent_of(views, longer.cylinder, (-longer.half_length, longer.half_length), settings.extent)
    poor = candidate.approximate or solution.support < LEAST_SEEN
    measured = candidate if held else replace(candidate, diameter=2 * solution.cylinder.radius, sigma_diameter=2 * solution.sigma_radius)
    q = _final_quality(views, solution.cylinder, extent, settings)
    return replace(measured, solution=solution, extent=extent, quality=q, approximate=poor or q > WORST_QUALITY * settings.final_range)


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
    return bool(np.linalg.norm(offset, axis=1).max() < 0.1 * other.diameter)
