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

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.appearance import likeness
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, Cylinders, outlines, spread
from pipeworkbench.recon.evidence import evidence
from pipeworkbench.recon.extent import ExtentSettings
from pipeworkbench.recon.match import match
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.settle import settle
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.texture import NODES, TextureSettings, parabola, texture
from pipeworkbench.recon.views import View

NEAR_DEPTH, NEAR_SLOPE = 0.004, 0.12  # hypotheses nearer than this (relative, sine) settle on one cylinder
SAME_AXIS = 0.3  # in radii: settled cylinders nearer than this are one
SLOPE_SIGMAS = 4.0
SAME_RADIUS = 0.005  # relative; finer than the steps between sizes
SIZED_KEPT = 24  # cylinders of standard size that are compared with each other
MOST_SHADED = 0.35  # of the radius: how far inside a limb its shading has edges
NESTED_DEPTH, NESTED_COSINE = 0.015, float(np.cos(np.radians(5)))  # what counts as the same place and direction
LEAST_GAP_PX = 1.8  # between two rows of edges that are not the same one
SHADING_PRICE = 5.0  # logarithm of what it costs to explain a row of edges as shading
MOVES_PX, TILTS_PX = np.linspace(-3.9, 3.9, 7), np.linspace(-1.3, 1.3, 3)  # of a cylinder's middle and of its ends against it
RIVAL_MOVES, RIVAL_TILTS_PX = np.array([-4.0, -3, -2, -1, 1, 2, 3, 4]), np.linspace(-2, 2, 5)  # the same, of which the first in steps
LEAST_GAIN = 2.0  # logarithm; what a move must gain, for settled cylinders are where their edges are
NO_RIVAL = 20.0  # lead over nothing at all, beyond the worst that was compared
ANCHORS = np.array([-1.0, 0.0, 1.0])  # what stays when the radius changes: one edge, the axis, the other edge
ROUGH_TEXTURE = TextureSettings(along=18, across=6, patches=(3, 2))  # for thousands of hypotheses
FINE_TEXTURE = TextureSettings(along=120, across=14)  # every other pixel or so: less noise


@dataclass(frozen=True)
class PickSettings:
    """Tunables of the search; lengths in mm, distances in the image in px.

    ``working_range`` and ``diameter_range`` limit the hypotheses (paper: 3-10 m, Fig. 6);
    ``search_range`` is Eq. 4's b of the ranking and ``step`` the hypotheses' distance in the other
    images, below twice b so that none is missed; ``largest_tilt_deg`` limits the axis against the image
    plane; the best ``ranked`` hypotheses by Eq. 4 and as many by texture are drawn onto the edges, at
    each of the edges that the clicks could mean; ``sized`` of those are tried with standard sizes, up to
    ``sizes`` each that are off by no more than ``widest_misfit``, and ``kept`` adjusted in full;
    ``final_range`` is the b of the reported quality.

    The score is a logarithm of likelihood ratios against clutter, summed over independent stretches of the
    edges, patches of the surface (of ``patch_area`` px^2, at most ``surface_patches``), the shading
    (``likeness_weight``), the clicks and the size: ``series_penalty`` per series of EN 10220 above the
    first. Where the other images speak for it by less than
    ``least_elsewhere`` there is no pipe; below ``least_score``, or with a diameter off by more
    than ``tolerance``, a pipe is marked approximate. A pipe that does not lead those at other places, from
    ``certain_within`` on, by ``least_lead`` is not given without the alternatives.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (10.0, 2600.0)
    search_range: float = 8.0
    step: float = 7.0
    samples: int = 10
    largest_tilt_deg: float = 65.0
    ranked: int = 40
    alternatives: int = 3
    sized: int = 12
    sizes: int = 2
    widest_misfit: float = 0.15
    kept: int = 2
    final_range: float = 3.0
    tolerance: float = 0.012  # relative deviation of the adjusted diameter from the standard's
    least_tolerance: float = 0.4  # mm, the same for thin pipes
    surface_patches: float = 18.0
    patch_area: float = 800.0
    likeness_weight: float = 2.0
    series_penalty: float = 12.0
    least_score: float = 20.0
    least_elsewhere: float = 0.0
    least_lead: float = 8.0
    certain_within: float = 10.0
    least_visible: float = 0.3  # part of the samples a view must contain to have a say
    extent: ExtentSettings = field(default_factory=ExtentSettings)


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


def find_cylinders(views: Sequence[View], pick: PipePick, tangents: Sequence[PipeTangents], settings: PickSettings) -> list[Found]:
    """Return the cylinders that fit a pick and all images best, at most ``settings.kept``, best first.

    ``tangents`` are the planes that the pick could mean, the most likely first.
    """
    clicked = tangents[0]
    origin = views[pick.camera].camera.projection_centre
    pixels_per_radian = views[pick.camera].camera.interior.pixels_per_radian
    depth, slope = _hypotheses(views, pick, tangents, settings)
    if not len(depth):
        return []
    chosen = _rank(views, pick, clicked, depth, slope, settings)
    hypotheses = joined([planes.cylinders_at(origin, depth[chosen], slope[chosen]) for planes in tangents[: settings.alternatives]])

    def extents_of(cylinders: Cylinders) -> Array:
        return clicked_extents(cylinders, origin, clicked)

    settled = settle(views, hypotheses, extents_of)
    weights = weights_of(views, pick, clicked, settled, 1.0, settings, surface_samples=TextureSettings())
    best = _best_distinct(settled, weights.total, extents_of(settled), settings.sized)
    settled, weights = settled[best], weights[best]
    if pick.diameter == "free":
        leads = leads_of(settled, weights.total, origin)
        return [Found(settled.one(row), None, float(weights.total[row]), float(leads[row])) for row in range(min(settings.kept, len(settled)))]
    sizes = sizes_in(settings) if pick.diameter is None else ()
    standard = np.array([size.outer_diameter for size in sizes] if sizes else [pick.diameter], float)
    series = np.array([size.series for size in sizes] or [1], float)
    sized, which = _with_sizes(settled, standard / 2, series, origin, settings)
    if not len(sized):
        return []
    # edges draw a limb without contrast of its own to another row: so the ones that hold the clear edge are weighed as well
    sized, which = joined([settle(views, sized, extents_of, held=True), sized]), np.tile(which, 2)
    weights = weights_of(views, pick, clicked, sized, series[which], settings, surface_samples=TextureSettings())
    best = _best_distinct(sized, weights.total, extents_of(sized), SIZED_KEPT)
    sized, weights, which = sized[best], weights[best], which[best]
    order = outermost_first(sized, weights, origin, pixels_per_radian)[: settings.kept]
    leads = leads_of(sized, weights.total, origin)
    # what was preferred for lying around the best has the lead of their common place
    leads[order[0]] = leads[np.argmax(weights.total)]
    leads = leads[order]
    sized, which = sized[order], which[order]
    moved, weights = best_moved(views, pick, clicked, sized, extents_of(sized), series[which], settings)
    order = outermost_first(moved, weights, origin, pixels_per_radian)
    return [Found(moved.one(row), sizes[which[row]] if sizes else None, float(weights.total[row]), float(leads[row])) for row in order]


def best_moved(
    views: Sequence[View],
    pick: PipePick,
    tangents: PipeTangents,
    cylinders: Cylinders,
    extents: Array,
    series: Array,
    settings: PickSettings,
) -> tuple[Cylinders, Weights]:
    """Return each cylinder as it is or, where that is clearly more likely, a little nearer, further or tilted.

    Edges draw a contour to the nearest row only, which may be a joint of a wall: the moves find the row
    with which the texture fits too.
    """
    camera = views[pick.camera].camera
    variants = joined([cylinders, _moved(cylinders, extents, views, camera.projection_centre, camera.interior.pixels_per_radian, MOVES_PX, TILTS_PX)])
    count = len(variants) // len(cylinders)
    lengths = np.tile(np.diff(extents, axis=1)[:, 0] / 2, count)
    middle = np.tile(extents.mean(axis=1), count)
    middle[len(cylinders) :] = 0.0  # moved ones have their point there
    spans = np.stack([middle - lengths, middle + lengths], axis=1)
    weights = weights_of(views, pick, tangents, variants, np.tile(series, count), settings, spans)
    total = weights.total.reshape(count, -1)
    total[0] += LEAST_GAIN
    best = total.argmax(axis=0) * len(cylinders) + np.arange(len(cylinders))
    return variants[best], weights[best]


def lead_over_neighbours(views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinder: Cylinder, settings: PickSettings) -> float:
    """Return by how much a cylinder's score exceeds the best of itself moved by ``certain_within`` and more, nearer or further.

    Where a limb is hidden, mirrors its surroundings or has no contrast, edges still draw a cylinder to
    some place with a small standard deviation; how much better that place fits than those around it tells whether it is the pipe's.
    """
    camera = views[pick.camera].camera
    origin, pixels_per_radian = camera.projection_centre, camera.interior.pixels_per_radian
    own = cylinder.as_many()
    extents = clicked_extents(own, origin, tangents)
    distance = float(np.linalg.norm(cylinder.at(float(extents.mean())) - origin))
    # less than a pixel of parallax does not show
    step = max(settings.certain_within / distance**2 * _longest_base(views, origin) * pixels_per_radian, 1.0)
    moved = _moved(own, extents, views, origin, pixels_per_radian, step * RIVAL_MOVES, RIVAL_TILTS_PX)
    half = np.full(len(moved), np.ptp(extents) / 2)
    score = weights_of(views, pick, tangents, own, 1.0, settings, extents).total[0]
    return float(score - weights_of(views, pick, tangents, moved, 1.0, settings, np.stack([-half, half], axis=1)).total.max())


def _longest_base(views: Sequence[View], origin: Array) -> float:
    return max(float(np.linalg.norm(view.camera.projection_centre - origin)) for view in views)


def _moved(
    cylinders: Cylinders, extents: Array, views: Sequence[View], origin: Array, pixels_per_radian: float, moves: Array, tilts: Array
) -> Cylinders:
    """Return the cylinders with their ends moved along the rays from the picked camera, all of the first move first.

    In the picked image they stay where they are; in the others they move by ``moves`` and turn by ``tilts``, px at the longest base.
    """
    base = _longest_base(views, origin)
    middle, tilt = (x.ravel() for x in np.meshgrid(moves, tilts))
    ends = []
    for end, sign in ((0, -1.0), (1, 1.0)):
        towards = cylinders.points + extents[:, end, None] * cylinders.directions - origin
        # parallax is inverse to the distance
        nearer = (middle + sign * tilt)[:, None] / (pixels_per_radian * base) * np.linalg.norm(towards, axis=1)
        ends.append((origin + towards / (1 + nearer)[..., None]).reshape(-1, 3))
    directions = ends[1] - ends[0]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Cylinders((ends[0] + ends[1]) / 2, directions, np.tile(cylinders.radii, len(middle)))


def leads_of(cylinders: Cylinders, scores: Array, origin: Array) -> Array:
    """Return by how much each score (k,) exceeds the best of those that lie at another distance from ``origin``."""
    inverse = 1 / np.linalg.norm(cylinders.points - origin, axis=1)
    elsewhere = np.abs(inverse[:, None] / inverse - 1) > NESTED_DEPTH
    return np.asarray(scores - np.where(elsewhere, scores, scores.min() - NO_RIVAL).max(axis=1))


def outermost_first(cylinders: Cylinders, weights: Weights, origin: Array, pixels_per_radian: float) -> NDArray[np.intp]:
    """Return the rows by their scores, but the outermost of what fits inside one another in front of the inner ones.

    A pipe has edges of its own besides its limbs: beside a limb the shading falls off steeply, and often
    that is a clearer edge than the limb itself before a background of like brightness. A wider pipe
    explains the rows of edges inside of it as its shading (at a price), a narrower one does not explain
    the row outside: so its edges need not be the better ones, only good ones.
    """
    order = np.argsort(-weights.total, kind="stable")
    order = order[np.isfinite(weights.total[order])]
    if not len(order):
        return order
    distance = np.linalg.norm(cylinders.points - origin, axis=1)
    best = order[0]
    for _ in order:
        offset = cylinders.points - cylinders.points[best]
        ray = (cylinders.points[best] - origin) / distance[best]
        # the first edge lies where the cross product of axis and direction to the camera points
        lateral = np.cross(ray, cylinders.directions[best])
        shift = offset @ lateral / np.linalg.norm(lateral)
        wider = cylinders.radii - cylinders.radii[best]
        gap = np.stack([wider + shift, wider - shift], axis=1) / distance[best] * pixels_per_radian
        outside = gap >= LEAST_GAP_PX
        near = (gap > -LEAST_GAP_PX).all(axis=1) & outside.any(axis=1) & (wider > 0) & (wider < MOST_SHADED * cylinders.radii[best])
        near &= np.abs(distance / distance[best] - 1) < NESTED_DEPTH
        near &= np.abs(cylinders.directions @ cylinders.directions[best]) > NESTED_COSINE
        gain = np.where(outside, weights.edges - SHADING_PRICE, weights.edges - weights.edges[best]).sum(axis=1) + weights.rest - weights.rest[best]
        gain[~near] = -np.inf
        if gain.max() <= 0:
            break
        best = int(np.argmax(gain))
    return np.concatenate([[best], order[order != best]]).astype(np.intp)


def sizes_in(settings: PickSettings) -> tuple[PipeSize, ...]:
    """Return the standard sizes within the diameter range."""
    low, high = settings.diameter_range
    return tuple(size for size in pipe_sizes() if low <= size.outer_diameter <= high)


@dataclass(frozen=True, eq=False)
class Weights:
    """What speaks for cylinders, logarithms of likelihood ratios: both their edges (k, 2), and all else (k,).

    ``elsewhere`` (k,) is the part of the images that were not clicked in: what is clicked fits anyhow.
    """

    edges: Array
    rest: Array
    elsewhere: Array

    @property
    def total(self) -> Array:
        """Return the scores (k,)."""
        return np.asarray(self.edges.sum(axis=1) + self.rest)

    def __getitem__(self, rows: NDArray[np.intp]) -> Weights:
        return Weights(self.edges[rows], self.rest[rows], self.elsewhere[rows])


def weights_of(
    views: Sequence[View],
    pick: PipePick,
    tangents: PipeTangents,
    cylinders: Cylinders,
    series: Array | float,
    settings: PickSettings,
    extents: Array | None = None,
    surface_samples: TextureSettings = FINE_TEXTURE,
) -> Weights:
    """Return the evidence of edges, texture, shading, clicks and size; -inf for what no other image contains or is out of range.

    ``series`` (k,) are those of EN 10220 that the cylinders' sizes belong to, 1 where there is none; ``extents``
    (k, 2) say which part of the cylinders counts (mm along the axes), by default what was clicked;
    ``surface_samples`` how finely their texture is compared.
    """
    camera = views[pick.camera].camera
    extents = clicked_extents(cylinders, camera.projection_centre, tangents) if extents is None else extents
    ratios = evidence(views, pick.camera, cylinders, extents)
    known = np.isfinite(ratios)
    # an image that does not contain a hypothesis speaks neither for nor against it
    edges = np.where(known, ratios, 0).sum(axis=0)
    # two descriptions of one surface: where something hides a part of the shading, or there is no texture, the other counts
    # the larger a surface, the more its texture says, up to a limit that keeps it on a par with the edges
    area = 4 * tangents.half_length * tangents.half_width * camera.interior.pixels_per_radian**2
    patches = min(settings.surface_patches, area / settings.patch_area)
    surface = patches * texture(views, pick.camera, cylinders, extents, surface_samples)
    surface = np.maximum(surface, settings.likeness_weight * likeness(views, pick.camera, cylinders, extents)).sum(axis=0)
    clicks = tangents.click_prior(cylinders, camera.projection_centre, camera.interior.pixels_per_radian)
    rest = surface + clicks - settings.series_penalty * (series - 1)
    middle = cylinders.points + extents.mean(axis=1)[:, None] * cylinders.directions
    distance = np.linalg.norm(middle - camera.projection_centre, axis=1)
    possible = np.delete(known, pick.camera, axis=0).any(axis=(0, 2))
    possible &= (distance >= settings.working_range[0]) & (distance <= settings.working_range[1])
    elsewhere = np.delete(np.where(known, ratios, 0), pick.camera, axis=0).sum(axis=(0, 2)) + surface
    return Weights(edges, np.where(possible, rest, -np.inf), elsewhere)


def _hypotheses(views: Sequence[View], pick: PipePick, alternatives: Sequence[PipeTangents], settings: PickSettings) -> tuple[Array, Array]:
    """Return depths and slopes (k,) of the cylinders that look as clicked in the picked image."""
    tangents = alternatives[0]
    camera = views[pick.camera].camera
    scale = camera.interior.pixels_per_radian
    base = _longest_base(views, camera.projection_centre)
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


def joined(parts: Sequence[Cylinders]) -> Cylinders:
    """Return all cylinders of several parts."""
    points, directions, radii = zip(*((part.points, part.directions, part.radii) for part in parts), strict=True)
    return Cylinders(np.concatenate(points), np.concatenate(directions), np.concatenate(radii))


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


def clicked_extents(cylinders: Cylinders, origin: Array, tangents: PipeTangents) -> Array:
    """Return where the clicked part begins and ends on each axis (k, 2), ascending, mm."""
    ends = [cylinders.nearest_to_ray(origin, ray) for ray in tangents.end_rays]
    return np.sort(np.stack(ends, axis=1), axis=1)


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
