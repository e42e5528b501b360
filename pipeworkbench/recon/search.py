# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which cylinders a pick could be: hypotheses over depth and tilt, ranked by all images.

The two tangent planes of a pick give the plane of the axis sharply; how deep the axis lies in it and
how it is tilted there depends on the diameter and on the faint convergence of the edges. So the
hypotheses are cylinders over depth and tilt, those of standard diameters within the working range.
Eq. 4 ranks them in the other images; the best are drawn onto the edges and weighed by the evidence of
edges and shading.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.appearance import likeness
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, Cylinders, outlines, spread
from pipeworkbench.recon.evidence import EvidenceSettings, evidence
from pipeworkbench.recon.extent import ExtentSettings
from pipeworkbench.recon.match import match
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.settle import settle
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.views import View

NEAR_DEPTH, NEAR_SLOPE = 0.004, 0.05  # hypotheses nearer than this (relative, sine) settle on one cylinder
SAME_AXIS = 0.3  # in radii: settled cylinders nearer than this are one
MOST_MISFIT = 4.0  # standard deviations; beyond that a diameter is simply wrong


@dataclass(frozen=True)
class PickSettings:
    """Tunables of the search; lengths in mm, distances in the image in px.

    ``working_range`` and ``diameter_range`` limit the hypotheses (paper: 3-10 m, Fig. 6);
    ``search_range`` is Eq. 4's b of the ranking and ``step`` the hypotheses' distance in the other
    images, below twice b so that none is missed; ``largest_tilt_deg`` limits the axis against the image
    plane; ``ranked`` hypotheses are drawn onto the edges, ``kept`` of those adjusted in full;
    ``final_range`` is the b of the reported quality.

    The score is the evidence of the edges, plus ``likeness_weight`` times that of the shading, less
    ``misfit_penalty`` for a diameter off the standard's (in units of ``diameter_scatter`` and of what
    the width leaves open) and ``series_penalty`` per series of EN 10220 above the first. Below
    ``hopeless_score`` there is no pipe; below ``least_score``, or with a diameter off by more than
    ``tolerance``, a pipe is marked approximate.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (10.0, 2600.0)
    search_range: float = 8.0
    step: float = 7.0
    samples: int = 12
    largest_tilt_deg: float = 65.0
    ranked: int = 240
    kept: int = 6
    final_range: float = 3.0
    tolerance: float = 0.012  # relative deviation of the adjusted diameter from the standard's
    least_tolerance: float = 0.4  # mm, the same for thin pipes
    diameter_scatter: float = 0.006  # relative; EN 10216 allows 1 % at most
    misfit_penalty: float = 0.15
    series_penalty: float = 0.3
    likeness_weight: float = 0.6
    least_score: float = 1.0
    hopeless_score: float = -0.5
    most_misfit_px: float = 2.0
    least_visible: float = 0.3  # part of the samples a view must contain to have a say
    extent: ExtentSettings = field(default_factory=ExtentSettings)


def find_cylinders(views: Sequence[View], pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> list[Cylinder]:
    """Return the cylinders that fit a pick and all images best, at most ``settings.kept``, best first."""
    hypotheses = _hypotheses(views, pick, tangents, settings)
    if hypotheses is None:
        return []
    origin = views[pick.camera].camera.projection_centre
    ranked = _rank(views, pick, tangents, hypotheses, settings)
    settled = settle(views, ranked, lambda cylinders: clicked_extents(cylinders, origin, tangents))
    return _best_distinct(views, pick, tangents, settled, settings)


def sizes_in(settings: PickSettings) -> tuple[PipeSize, ...]:
    """Return the standard sizes within the diameter range."""
    low, high = settings.diameter_range
    return tuple(size for size in pipe_sizes() if low <= size.outer_diameter <= high)


def scores_of(
    views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinders: Cylinders, extents: Array, diameters: Array, settings: PickSettings
) -> Array:
    """Return the evidence of edges and shading (k,) less what speaks against the size: a misfit of the diameter, a rare series."""
    # the picked image agrees with every hypothesis: only the others can tell them apart
    others = [view for number, view in enumerate(views) if number != pick.camera]
    polarity = tangents.polarity_of(cylinders, views[pick.camera].camera.projection_centre, EvidenceSettings().samples)
    ratios = evidence(others, cylinders, extents, polarity)
    known = np.isfinite(ratios)
    # an image that does not contain a hypothesis speaks neither for nor against it
    edges = np.where(known, ratios, 0).sum(axis=0) / len(others)
    alike = likeness(views, pick.camera, cylinders, extents).sum(axis=0) / len(others)
    scores = np.where(known.any(axis=0), edges + settings.likeness_weight * alike, -np.inf)
    if pick.diameter == "free":
        return scores
    sizes = sizes_in(settings) if pick.diameter is None else ()
    standard = np.array([size.outer_diameter for size in sizes] if sizes else [pick.diameter], float)
    rarity = np.array([size.series - 1 for size in sizes] or [0], float)
    width_px = 2 * tangents.half_width * views[pick.camera].camera.interior.pixels_per_radian
    scatter = np.hypot(settings.diameter_scatter, tangents.sigma_px / width_px)
    misfit = np.minimum(np.abs(diameters[:, None] / standard - 1) / scatter, MOST_MISFIT)
    penalty = settings.misfit_penalty * misfit**2 + settings.series_penalty * rarity
    return np.asarray(scores - penalty.min(axis=1))


def _hypotheses(views: Sequence[View], pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> Cylinders | None:
    """Return cylinders over depth and tilt that look as clicked in the picked image."""
    camera = views[pick.camera].camera
    scale = camera.interior.pixels_per_radian
    base = max(float(np.linalg.norm(v.camera.projection_centre - camera.projection_centre)) for v in views)
    width_error = tangents.sigma_px / (2 * tangents.half_width * scale)

    near, far = settings.working_range
    shift = scale * base  # px of parallax per unit of inverse depth
    inverse_depth = np.linspace(1 / far, 1 / near, max(2, int(np.ceil((1 / near - 1 / far) * shift / settings.step))))

    slope_spread = 4 * tangents.sigma_px / scale / (2 * tangents.half_length * tangents.half_width)
    steepest = np.tan(np.radians(settings.largest_tilt_deg))
    low, high = max(tangents.slope - slope_spread, -steepest), min(tangents.slope + slope_spread, steepest)
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
        standard = np.array([size.outer_diameter for size in sizes_in(settings)])
        keep &= (np.abs(2 * radii[:, None] / standard - 1) < tolerance).any(axis=1)
    elif pick.diameter != "free":
        keep &= np.abs(2 * radii / pick.diameter - 1) < tolerance
    if not keep.any():
        return None
    directions = np.cos(tilt)[:, None] * tangents.across + np.sin(tilt)[:, None] * tangents.middle
    points = camera.projection_centre + depth[:, None] * tangents.middle
    return Cylinders(points, directions, radii)[keep]


def _rank(views: Sequence[View], pick: PipePick, tangents: PipeTangents, hypotheses: Cylinders, settings: PickSettings) -> Cylinders:
    """Return the hypotheses that fit the other images best by Eq. 4, at most ``ranked``, none beside a better one."""
    origin = views[pick.camera].camera.projection_centre
    along = spread(clicked_extents(hypotheses, origin, tangents), np.linspace(0, 1, settings.samples))
    others = [view for number, view in enumerate(views) if number != pick.camera]
    polarity = np.rint(tangents.polarity_of(hypotheses, origin, settings.samples))
    squares = np.array([_quality_in(view, hypotheses, along, polarity, settings) ** 2 for view in others])
    known = np.isfinite(squares)
    total = np.where(known, squares, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    order = np.argsort(total, kind="stable")
    order = order[known.any(axis=0)[order]][: 8 * settings.ranked]
    depth = np.linalg.norm(hypotheses.points - origin, axis=1)
    slope = hypotheses.directions @ tangents.middle
    chosen = np.empty(0, int)
    for row in order:
        near_better = (np.abs(depth[row] / depth[chosen] - 1) < NEAR_DEPTH) & (np.abs(slope[row] - slope[chosen]) < NEAR_SLOPE)
        if not near_better.any():
            chosen = np.append(chosen, row)
        if len(chosen) == settings.ranked:
            break
    return hypotheses[chosen]


def clicked_extents(cylinders: Cylinders, origin: Array, tangents: PipeTangents) -> Array:
    """Return where the clicked part begins and ends on each axis (k, 2), ascending, mm."""
    ends = [cylinders.nearest_to_ray(origin, ray) for ray in tangents.end_rays]
    return np.sort(np.stack(ends, axis=1), axis=1)


def _quality_in(view: View, hypotheses: Cylinders, along: Array, polarity: Array, settings: PickSettings) -> Array:
    """Return Eq. 4's q (k,) of the hypotheses in one view; NaN where the view does not contain them.

    ``polarity`` (2, samples) of the picked image gates the edges where it is clear (-1 or 1, not 0).
    """
    position, normal = outlines(view.camera, hypotheses, along)
    gate = np.broadcast_to(polarity, position.shape[:3]).ravel()
    distance = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), settings.search_range, gate).distance
    visible = np.isfinite(position[..., 0]).reshape(len(hypotheses), -1)
    squares = np.where(np.isnan(distance), settings.search_range, distance).reshape(visible.shape) ** 2
    count = visible.sum(axis=1)
    q = np.sqrt(np.where(visible, squares, 0).sum(axis=1) / np.maximum(count, 1))
    return np.where(count >= settings.least_visible * visible.shape[1], q, np.nan)


def _best_distinct(views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinders: Cylinders, settings: PickSettings) -> list[Cylinder]:
    """Return the best cylinders by evidence, at most ``kept``, no two of them the same."""
    origin = views[pick.camera].camera.projection_centre
    extents = clicked_extents(cylinders, origin, tangents)
    distance = np.linalg.norm(cylinders.points - origin, axis=1)
    scores = scores_of(views, pick, tangents, cylinders, extents, 2 * cylinders.radii, settings)
    scores[(distance < settings.working_range[0]) | (distance > settings.working_range[1])] = -np.inf
    off = tangents.misfit(cylinders, origin) * views[pick.camera].camera.interior.pixels_per_radian
    scores[off > max(settings.most_misfit_px, 2 * tangents.sigma_px)] = -np.inf
    ends = cylinders.points[:, None] + extents[:, :, None] * cylinders.directions[:, None]
    chosen: list[int] = []
    for row in np.argsort(-scores):
        apart = np.linalg.norm(ends[chosen] - ends[row], axis=2).max(axis=1)
        if np.isfinite(scores[row]) and not (apart < SAME_AXIS * cylinders.radii[row]).any():
            chosen.append(int(row))
        if len(chosen) == settings.kept:
            break
    return [cylinders.one(row) for row in chosen]
