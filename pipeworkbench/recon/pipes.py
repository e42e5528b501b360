# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes from one pick: Sect. 4.2 of the paper, from two clicked edges to an adjusted cylinder.

The clicked edges are first drawn onto the subpixel edges of their image. The two tangent planes give
the plane of the axis sharply; how deep the axis lies in it and how it is tilted there depends on the
diameter and on the faint convergence of the edges. So the hypotheses are cylinders over depth and
tilt, those of standard diameters within the working range; the other images rank them (Eq. 4), the
best are adjusted with a free diameter, and the nearest standard diameter is then held.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.adjust import CylinderSolution, adjust_cylinder
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, contour, edge_lines, intersect_axes
from pipeworkbench.recon.extent import ExtentSettings, extent_of
from pipeworkbench.recon.match import match, quality
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.tangents import PipeTangents, tangents_of
from pipeworkbench.recon.views import View

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class PickSettings:
    """Tunables of the search; lengths in mm, distances in the image in px.

    ``working_range`` and ``diameter_range`` limit the hypotheses (paper: 3-10 m, Fig. 6);
    ``search_range`` is Eq. 4's b of the ranking and ``step`` the hypotheses' distance in the other
    images, below twice b so that none is missed; ``width_sigma`` the standard deviation of the
    apparent width; ``largest_tilt_deg`` of the axis against the image plane; ``kept`` the number of
    hypotheses that are adjusted; ``final_range`` the b of the reported quality.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (10.0, 2600.0)
    search_range: float = 8.0
    step: float = 6.0
    samples: int = 24
    width_sigma: float = 0.3
    largest_tilt_deg: float = 65.0
    kept: int = 16
    final_range: float = 3.0
    tolerance: float = 0.012  # relative deviation of the adjusted diameter from the standard's
    least_tolerance: float = 0.4  # mm, the same for thin pipes
    least_visible: float = 0.3  # part of the samples a view must contain to have a say
    extent: ExtentSettings = ExtentSettings()


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
    approximate: bool

    @property
    def ends(self) -> Array:
        """End points of the axis (2, 3) in mm."""
        return np.array([self.solution.cylinder.at(self.extent[0]), self.solution.cylinder.at(self.extent[1])])


def from_pick(views: Sequence[View], pick: PipePick, settings: PickSettings | None = None) -> tuple[PipeCandidate, ...]:
    """Find the pipe whose two edges were clicked in one image.

    Returns
    -------
    tuple of PipeCandidate
        Best first, at most a few; empty where no cylinder fits the images.
    """
    settings = settings or PickSettings()
    tangents = tangents_of(views[pick.camera], pick)
    hypotheses = _hypotheses(views, pick, tangents, settings)
    if hypotheses is None:
        return ()
    ranked = _rank(views, pick, tangents, hypotheses, settings)
    found: list[PipeCandidate] = []
    for cylinder in ranked:
        candidate = _adjusted(views, pick, tangents, cylinder, settings)
        if candidate is not None and not any(_same(candidate, other) for other in found):
            found.append(candidate)
    found.sort(key=lambda c: (c.approximate, c.quality))
    return tuple(_completed(views, candidate, pick, settings) for candidate in found[:3])


@dataclass(frozen=True, eq=False)
class _Hypotheses:
    """Cylinders: points (k, 3), directions (k, 3), radii (k,)."""

    points: Array
    directions: Array
    radii: Array

    def __getitem__(self, rows: Array) -> _Hypotheses:
        return _Hypotheses(self.points[rows], self.directions[rows], self.radii[rows])


def _hypotheses(views: Sequence[View], pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> _Hypotheses | None:
    """Return cylinders over depth and tilt that look as clicked in the picked image."""
    camera = views[pick.camera].camera
    scale = camera.interior.pixels_per_radian
    base = max(float(np.linalg.norm(v.camera.projection_centre - camera.projection_centre)) for v in views)
    width_error = settings.width_sigma / (tangents.half_width * scale) / np.sqrt(2)

    near, far = settings.working_range
    shift = scale * base  # px of parallax per unit of inverse depth
    inverse_depth = np.linspace(1 / far, 1 / near, max(2, int(np.ceil((1 / near - 1 / far) * shift / settings.step))))

    spread = 4 * settings.width_sigma / scale / (2 * tangents.half_length * tangents.half_width)
    steepest = np.tan(np.radians(settings.largest_tilt_deg))
    low, high = max(tangents.slope - spread, -steepest), min(tangents.slope + spread, steepest)
    if low >= high:
        low, high = -steepest, steepest
    slope_step = settings.step / max(shift * tangents.half_length / near, 1.0)
    slopes = np.linspace(low, high, max(3, int(np.ceil((high - low) / slope_step))))

    depth, slope = (x.ravel() for x in np.meshgrid(1 / inverse_depth, slopes))
    tilt = np.arctan(slope)
    # the tangent planes, opened by the tilt: tan(angle about the axis) = tan(half width) / cos(tilt)
    angle = np.arctan(np.tan(tangents.half_width) / np.cos(tilt))
    radii = depth * np.cos(tilt) * np.sin(angle)
    keep = (2 * radii >= settings.diameter_range[0]) & (2 * radii <= settings.diameter_range[1])
    tolerance = 4 * width_error + settings.tolerance
    if pick.diameter is None:
        standard = np.array([size.outer_diameter for size in pipe_sizes()])
        keep &= (np.abs(2 * radii[:, None] / standard - 1) < tolerance).any(axis=1)
    elif pick.diameter != "free":
        keep &= np.abs(2 * radii / pick.diameter - 1) < tolerance
    if not keep.any():
        return None
    directions = np.cos(tilt)[:, None] * tangents.across + np.sin(tilt)[:, None] * tangents.middle
    points = camera.projection_centre + depth[:, None] * tangents.middle
    return _Hypotheses(points, directions, radii)[keep]


def _rank(views: Sequence[View], pick: PipePick, tangents: PipeTangents, hypotheses: _Hypotheses, settings: PickSettings) -> list[Cylinder]:
    """Return the hypotheses that fit the other images best, at most ``kept``, none beside a better one."""
    origin = views[pick.camera].camera.projection_centre
    fractions = np.linspace(0, 1, settings.samples)
    # both ends of the clicked edges, carried onto each axis
    along = np.stack([_along(hypotheses, origin, ray) for ray in tangents.end_rays], axis=1)
    along = along[:, :1] + (along[:, 1:] - along[:, :1]) * fractions
    squares = np.full((len(views), len(hypotheses.radii)), np.nan)
    for number, view in enumerate(views):
        if number != pick.camera:
            squares[number] = _quality_in(view, hypotheses, along, settings) ** 2
    with np.errstate(invalid="ignore"):
        total = np.nanmean(np.where(np.isnan(squares).all(axis=0), np.inf, squares), axis=0)
    order = np.argsort(total, kind="stable")
    order = order[np.isfinite(total[order])]
    depth = np.linalg.norm(hypotheses.points - origin, axis=1)
    slope = np.einsum("ki,i->k", hypotheses.directions, tangents.middle)
    chosen: list[int] = []
    for row in order[:400]:
        near_better = [abs(depth[row] / depth[k] - 1) < 0.01 and abs(slope[row] - slope[k]) < 0.1 for k in chosen]
        if not any(near_better):
            chosen.append(int(row))
        if len(chosen) == settings.kept:
            break
    return [Cylinder(hypotheses.points[k], hypotheses.directions[k], float(hypotheses.radii[k])) for k in chosen]


def _along(hypotheses: _Hypotheses, origin: Array, ray: Array) -> Array:
    """Return where a ray (3,) passes nearest to each axis, as distances (k,) along it."""
    w = hypotheses.points - origin
    b = hypotheses.directions @ ray
    return np.asarray((b * (w @ ray) - np.einsum("ki,ki->k", w, hypotheses.directions)) / (1 - b**2))


def _quality_in(view: View, hypotheses: _Hypotheses, along: Array, settings: PickSettings) -> Array:
    """Return Eq. 4's q (k,) of the hypotheses in one view; NaN where the view does not contain them."""
    lines, _ = edge_lines(hypotheses.points, hypotheses.directions, hypotheses.radii, view.camera.projection_centre)
    points = lines[:, :, None, :] + along[:, None, :, None] * hypotheses.directions[:, None, None, :]
    shape = points.shape[:3]
    pixels = view.camera.project(points.reshape(-1, 3)).reshape(*shape, 2)
    # edges are nearly straight over a pick: one normal per edge from its ends
    chord = pixels[:, :, -1] - pixels[:, :, 0]
    step = np.diff(pixels, axis=2, append=pixels[:, :, -1:])
    tangent = np.where(np.isfinite(chord)[:, :, None, :], chord[:, :, None, :], step)
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent = tangent / np.linalg.norm(tangent, axis=-1, keepdims=True)
    normal = np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1).reshape(-1, 2)
    flat = pixels.reshape(-1, 2)
    visible = view.camera.sees(flat) & np.isfinite(normal[:, 0])
    distance = np.full(len(flat), np.nan)
    distance[visible] = match(view.edges, flat[visible], normal[visible], settings.search_range).distance
    squares = np.where(np.isnan(distance), settings.search_range, distance) ** 2
    squares[~visible] = 0
    count = visible.reshape(len(points), -1).sum(axis=1)
    q = np.sqrt(squares.reshape(len(points), -1).sum(axis=1) / np.maximum(count, 1))
    return np.where(count >= settings.least_visible * shape[1] * shape[2], q, np.nan)


def _adjusted(views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinder: Cylinder, settings: PickSettings) -> PipeCandidate | None:
    """Adjust a hypothesis over the clicked part with all images, then hold the standard diameter."""
    origin = views[pick.camera].camera.projection_centre
    ends = np.sort(intersect_axes(cylinder, origin, tangents.end_rays))
    fixed = pick.diameter if isinstance(pick.diameter, float) else None
    observation = (fixed / 2, HELD_RADIUS_SIGMA) if fixed else None
    solution = adjust_cylinder(views, cylinder, (float(ends[0]), float(ends[1])), observation)
    if solution is None or not _in_range(solution.cylinder, origin, settings):
        return None
    diameter, sigma = 2 * solution.cylinder.radius, 2 * solution.sigma_radius
    size, fits = _size_of(pick, diameter, sigma, settings)
    if size is not None and fixed is None:
        held = (size.outer_diameter / 2, HELD_RADIUS_SIGMA)
        solution = adjust_cylinder(views, solution.cylinder, (-solution.half_length, solution.half_length), held)
        if solution is None:
            return None
    extent = (-solution.half_length, solution.half_length)
    q = _final_quality(views, solution.cylinder, extent, settings)
    return PipeCandidate(solution, extent, size, q, diameter, sigma, approximate=not fits)


HELD_RADIUS_SIGMA = 0.02  # mm; a pseudo-observation with a weight that no image evidence moves


def _size_of(pick: PipePick, diameter: float, sigma: float, settings: PickSettings) -> tuple[PipeSize | None, bool]:
    """Return the standard size that the adjusted diameter is taken for, and whether it fits well."""
    if pick.diameter == "free":
        return None, True
    wanted = diameter if pick.diameter is None else pick.diameter
    tolerance = np.hypot(max(settings.tolerance * wanted, settings.least_tolerance), 2 * sigma)

    # sizes of series 1 are far more common: another one must fit clearly better
    def misfit(size: PipeSize) -> float:
        return abs(size.outer_diameter - wanted) / tolerance + 0.25 * (size.series - 1)

    if pick.diameter is not None:
        exact = min(pipe_sizes(), key=lambda size: abs(size.outer_diameter - wanted))
        return (exact if abs(exact.outer_diameter - wanted) < 0.05 else None), True
    best = min(pipe_sizes(), key=misfit)
    return best, abs(best.outer_diameter - diameter) <= tolerance


def _completed(views: Sequence[View], candidate: PipeCandidate, pick: PipePick, settings: PickSettings) -> PipeCandidate:
    """Follow the pipe to where its edges end and adjust it once more over all of its length."""
    solution = candidate.solution
    held = None if pick.diameter == "free" else (solution.cylinder.radius, HELD_RADIUS_SIGMA)
    extent = extent_of(views, solution.cylinder, candidate.extent, settings.extent)
    longer = adjust_cylinder(views, solution.cylinder, extent, held)
    if longer is None or longer.support < 0.5 * solution.support:
        return candidate
    half = longer.half_length
    extent = extent_of(views, longer.cylinder, (-half, half), settings.extent)
    q = _final_quality(views, longer.cylinder, extent, settings)
    diameter, sigma = (2 * longer.cylinder.radius, 2 * longer.sigma_radius) if held is None else (candidate.diameter, candidate.sigma_diameter)
    return replace(candidate, solution=longer, extent=extent, quality=q, diameter=diameter, sigma_diameter=sigma)


def _final_quality(views: Sequence[View], cylinder: Cylinder, extent: tuple[float, float], settings: PickSettings) -> float:
    along = np.linspace(*extent, 4 * settings.samples)
    distances = []
    for view in views:
        seen = contour(view.camera, cylinder, along)
        position, normal = seen.position.reshape(-1, 2), seen.normal.reshape(-1, 2)
        visible = np.isfinite(position[:, 0])
        if np.count_nonzero(visible) >= settings.least_visible * len(position):
            distances.append(match(view.edges, position[visible], normal[visible], settings.final_range).distance)
    return float(quality(np.concatenate(distances), settings.final_range)) if distances else settings.final_range


def _in_range(cylinder: Cylinder, origin: Array, settings: PickSettings) -> bool:
    distance = float(np.linalg.norm(cylinder.point - origin))
    near, far = settings.working_range
    return 0.9 * near <= distance <= 1.1 * far


def _same(one: PipeCandidate, other: PipeCandidate) -> bool:
    """Tell whether two candidates are one cylinder: axes within a tenth of the diameter at both ends."""
    ends = one.ends
    offset = ends - other.solution.cylinder.point
    offset -= np.outer(offset @ other.solution.cylinder.direction, other.solution.cylinder.direction)
    return bool(np.linalg.norm(offset, axis=1).max() < 0.1 * other.diameter)
