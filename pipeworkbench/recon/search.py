# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which cylinders a pick could be: hypotheses over depth and tilt, ranked by all images.

The two tangent planes of a pick give the plane of the axis sharply; how deep the axis lies in it and
how it is tilted there depends on the diameter and on the faint convergence of the edges. So the
hypotheses are cylinders over depth and tilt, those of standard diameters within the working range.
Eq. 4 and the surface's texture rank them in the other images; the best are drawn onto the edges and
weighed. What is left is a place, not yet a diameter, for an edge may be a stain's beside the limb: so
the standard sizes that come near are tried with either edge, each by the evidence of all images.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.catalogue import PipeSize
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, Cylinders, joined, outlines, spread
from pipeworkbench.recon.match import match
from pipeworkbench.recon.moves import best_moved, longest_base
from pipeworkbench.recon.pick_settings import PickSettings, sizes_in
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.settle import settle
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.texture import NODES, TextureSettings, parabola, texture
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import Weights, clicked_extents, leads_of, outermost_first, weights_of

NEAR_DEPTH, NEAR_SLOPE = 0.004, 0.12  # hypotheses nearer than this (relative, sine) settle on one cylinder
SAME_AXIS = 0.3  # in radii: settled cylinders nearer than this are one
SLOPE_SIGMAS = 4.0
SAME_RADIUS = 0.005  # relative; finer than the steps between sizes
SIZED_KEPT = 24  # cylinders of standard size that are compared with each other
ANCHORS = np.array([-1.0, 0.0, 1.0])  # what stays when the radius changes: one edge, the axis, the other edge
ROUGH_TEXTURE = TextureSettings(along=18, across=6, patches=(3, 2))  # for thousands of hypotheses


@dataclass(frozen=True, eq=False)
class Found:
    """A cylinder that fits a pick, its standard size (None where free), its score and its lead.

    ``lead`` is by how much the score exceeds that of the best pipe elsewhere, with the same weights; negative
    for what is not the best.
    """

    cylinder: Cylinder
    size: PipeSize | None
    score: float
    lead: float


@dataclass(frozen=True, eq=False)
class Searched:
    """All cylinders (k) that a pick could be, before the best are chosen: their weights and which (k,) of the ``sizes`` each has.

    ``series`` (n,) are the sizes'; without any sizes the diameter is the pick's own or free.
    """

    cylinders: Cylinders
    weights: Weights
    which: NDArray[np.intp]
    sizes: tuple[PipeSize, ...]
    series: Array


def search_cylinders(
    views: Sequence[View],
    pick: PipePick,
    tangents: Sequence[PipeTangents],
    settings: PickSettings,
    seen: Callable[[Cylinder], None] = lambda cylinder: None,  # noqa: ARG005
) -> Searched | None:
    """Return all cylinders that a pick could be, None where there are none; how many are ``kept`` does not matter to them.

    ``tangents`` are the planes that the pick could mean, the most likely first.
    ``seen`` is called with the one that looks best before the sizes of the standard are tried.
    """
    clicked = tangents[0]
    origin = views[pick.camera].camera.projection_centre
    depth, slope = _hypotheses(views, pick, tangents, settings)
    if not len(depth):
        return None
    chosen = _rank(views, pick, clicked, depth, slope, settings)
    hypotheses = joined([planes.cylinders_at(origin, depth[chosen], slope[chosen]) for planes in tangents[: settings.alternatives]])

    def extents_of(cylinders: Cylinders) -> Array:
        return clicked_extents(cylinders, origin, clicked)

    settled = settle(views, hypotheses, extents_of)
    weights = weights_of(views, pick, clicked, settled, 1.0, settings, surface_samples=TextureSettings())
    best = _best_distinct(settled, weights.total, extents_of(settled), settings.sized)
    settled, weights = settled[best], weights[best]
    if len(settled):
        seen(settled.one(int(np.argmax(weights.total))))
    if pick.diameter == "free":
        return Searched(settled, weights, np.zeros(len(settled), np.intp), (), np.ones(1))
    sizes = sizes_in(settings) if pick.diameter is None else ()
    standard = np.array([size.outer_diameter for size in sizes] if sizes else [pick.diameter], float)
    series = np.array([size.series for size in sizes] or [1], float)
    sized, which = _with_sizes(settled, standard / 2, series, origin, settings)
    if not len(sized):
        return None
    # edges draw a limb without contrast of its own to another row: so the ones that hold the clear edge are weighed as well
    sized, which = joined([settle(views, sized, extents_of, held=True), sized]), np.tile(which, 2)
    weights = weights_of(views, pick, clicked, sized, series[which], settings, surface_samples=TextureSettings())
    best = _best_distinct(sized, weights.total, extents_of(sized), SIZED_KEPT)
    return Searched(sized[best], weights[best], which[best], sizes, series)


def best_found(views: Sequence[View], pick: PipePick, clicked: PipeTangents, searched: Searched | None, settings: PickSettings) -> list[Found]:
    """Return the best of the cylinders that a pick could be, at most ``settings.kept``, best first."""
    if searched is None:
        return []
    origin = views[pick.camera].camera.projection_centre
    sized, weights, which, series, sizes = searched.cylinders, searched.weights, searched.which, searched.series, searched.sizes
    leads = leads_of(sized, weights.total, origin)
    if pick.diameter == "free":
        return [Found(sized.one(row), None, float(weights.total[row]), float(leads[row])) for row in range(min(settings.kept, len(sized)))]
    order = outermost_first(sized, weights, origin, views[pick.camera].camera.interior.pixels_per_radian)[: settings.kept]
    # what was preferred for lying around the best has the lead of their common place
    leads[order[0]] = leads[np.argmax(weights.total)]
    leads = leads[order]
    sized, which = sized[order], which[order]
    moved, weights = best_moved(views, pick, clicked, sized, clicked_extents(sized, origin, clicked), series[which], settings)
    order = outermost_first(moved, weights, origin, views[pick.camera].camera.interior.pixels_per_radian)
    return [Found(moved.one(row), sizes[which[row]] if sizes else None, float(weights.total[row]), float(leads[row])) for row in order]


def _hypotheses(views: Sequence[View], pick: PipePick, alternatives: Sequence[PipeTangents], settings: PickSettings) -> tuple[Array, Array]:
    """Return depths and slopes (k,) of the cylinders that look as clicked in the picked image."""
    tangents = alternatives[0]
    camera = views[pick.camera].camera
    scale = camera.interior.pixels_per_radian
    base = longest_base(views, camera.projection_centre)
    width_error = tangents.sigma_px / (2 * tangents.half_width * scale)

    near, far = settings.working_range
    shift = scale * base  # px of parallax per unit of inverse depth
    inverse_depth = np.linspace(1 / far, 1 / near, max(2, int(np.ceil((1 / near - 1 / far) * shift / settings.step))))

    steepest = np.tan(np.radians(settings.largest_tilt_deg))
    low = max(min(planes.slope - SLOPE_SIGMAS * planes.sigma_slope for planes in alternatives), -steepest)
    high = min(max(planes.slope + SLOPE_SIGMAS * planes.sigma_slope for planes in alternatives), steepest)
    if low >= high:
        low, high = -steepest, steepest
    # the ends' parallax, and with it the number of slopes that differ, falls with the distance
    counts = np.maximum(3, np.ceil((high - low) * shift * tangents.half_length * inverse_depth / settings.step).astype(int))
    depth = np.repeat(1 / inverse_depth, counts)
    place = np.arange(len(depth)) - np.repeat(np.cumsum(counts) - counts, counts)
    slope = low + (high - low) * place / np.repeat(counts - 1, counts)
    diameters = 2 * tangents.cylinders_at(camera.projection_centre, depth, slope).radii
    keep = (diameters >= settings.diameter_range[0]) & (diameters <= settings.diameter_range[1])
    tolerance = 4 * width_error + settings.tolerance
    if pick.diameter is None:
        standard = np.array([size.outer_diameter for size in sizes_in(settings)])
        keep &= (np.abs(diameters[:, None] / standard - 1) < tolerance).any(axis=1)
    elif pick.diameter != "free":
        keep &= np.abs(diameters / pick.diameter - 1) < tolerance
    return depth[keep], slope[keep]


def _rank(views: Sequence[View], pick: PipePick, tangents: PipeTangents, depth: Array, slope: Array, settings: PickSettings) -> NDArray[np.intp]:
    """Return the rows of the hypotheses that fit the other images best by Eq. 4 and by texture, none beside a better one."""
    origin = views[pick.camera].camera.projection_centre
    hypotheses = tangents.cylinders_at(origin, depth, slope)
    extents = clicked_extents(hypotheses, origin, tangents)
    others = [view for number, view in enumerate(views) if number != pick.camera]
    squares = np.array([_quality_in(view, hypotheses, extents, settings) ** 2 for view in others])
    known = np.isfinite(squares)
    total = np.where(known.any(axis=0), np.where(known, squares, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1), np.inf)
    surface = -texture(views, pick.camera, hypotheses, extents, ROUGH_TEXTURE).sum(axis=0)
    surface[~known.any(axis=0)] = np.inf
    chosen = np.concatenate([_best_apart(order, depth, slope, settings.ranked) for order in (total, surface)])
    return np.unique(chosen)


def _best_apart(cost: Array, depth: Array, slope: Array, most: int) -> NDArray[np.intp]:
    """Return the rows of the least finite costs, none beside a better one."""
    order = np.argsort(cost, kind="stable")[: 8 * most]
    chosen = np.empty(0, np.intp)
    for row in order[np.isfinite(cost[order])]:
        near_better = (np.abs(depth[row] / depth[chosen] - 1) < NEAR_DEPTH) & (np.abs(slope[row] - slope[chosen]) < NEAR_SLOPE)
        if not near_better.any():
            chosen = np.append(chosen, row)
        if len(chosen) == most:
            break
    return chosen


def _with_sizes(cylinders: Cylinders, radii: Array, series: Array, origin: Array, settings: PickSettings) -> tuple[Cylinders, NDArray[np.intp]]:
    """Return the cylinders with the standard radii nearest to theirs, held at either edge, and which radius each has.

    Where the images do not fix the depth, the pipe may also be as much further away as it is thicker.
    """
    misfit = np.abs(np.log(radii / cylinders.radii[:, None]))
    common = np.where(series == 1, misfit, np.inf)
    nearest = (_ranks(misfit) < settings.sizes) | (_ranks(common) < settings.sizes)
    row, which = np.nonzero(nearest & (misfit < settings.widest_misfit))
    start, change = cylinders[row], radii[which] - cylinders.radii[row]
    sideways = np.cross(start.directions, origin - start.points)
    sideways /= np.linalg.norm(sideways, axis=1, keepdims=True)
    moved = [start.points + (anchor * change)[:, None] * sideways for anchor in ANCHORS]
    moved.append(origin + (start.points - origin) * (radii[which] / start.radii)[:, None])
    all_sized = joined([Cylinders(points, start.directions, radii[which]) for points in moved])
    return all_sized, np.tile(which, len(moved))


def _ranks(costs: Array) -> NDArray[np.intp]:
    """Return the place (k, n) of each cost in the order of its row."""
    return np.argsort(np.argsort(costs, axis=1), axis=1)


def _quality_in(view: View, hypotheses: Cylinders, extents: Array, settings: PickSettings) -> Array:
    """Return Eq. 4's q (k,) of the hypotheses in one view; NaN where the view does not contain them."""
    position, normal = _rough_outlines(view, hypotheses, extents, settings.samples)
    distance = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), settings.search_range).distance
    visible = np.isfinite(position[..., 0]).reshape(len(hypotheses), -1)
    squares = np.where(np.isnan(distance), settings.search_range, distance).reshape(visible.shape) ** 2
    count = visible.sum(axis=1)
    q = np.sqrt(np.where(visible, squares, 0).sum(axis=1) / np.maximum(count, 1))
    return np.where(count >= settings.least_visible * visible.shape[1], q, np.nan)


def _rough_outlines(view: View, cylinders: Cylinders, extents: Array, samples: int) -> tuple[Array, Array]:
    """Return what :func:`outlines` does for evenly spaced samples, of which it projects three only."""
    nodes, _ = outlines(view.camera, cylinders, spread(extents, (1 + NODES) / 2), unseen=True)
    position = np.einsum("ai,ksic->ksac", parabola(samples), nodes)
    tangent = nodes[:, :, 2] - nodes[:, :, 0]
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    normal = np.stack([tangent[..., 1], -tangent[..., 0]], axis=2)
    position[~view.camera.sees(position)] = np.nan
    # the search goes both ways: the sign does not matter here
    return position, np.broadcast_to(normal[:, :, None], position.shape)


def _best_distinct(cylinders: Cylinders, scores: Array, extents: Array, most: int) -> NDArray[np.intp]:
    """Return the rows of the best cylinders, no two of them the same."""
    ends = cylinders.points[:, None] + extents[:, :, None] * cylinders.directions[:, None]
    chosen: list[int] = []
    for row in np.argsort(-scores):
        apart = np.linalg.norm(ends[chosen] - ends[row], axis=2).max(axis=1)
        alike = np.abs(cylinders.radii[chosen] / cylinders.radii[row] - 1) < SAME_RADIUS
        if np.isfinite(scores[row]) and not ((apart < SAME_AXIS * cylinders.radii[row]) & alike).any():
            chosen.append(int(row))
        if len(chosen) == most:
            break
    return np.array(chosen, np.intp)
