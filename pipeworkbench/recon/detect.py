# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes without a pick: from the straight edges of all images to cylinders that explain them.

The paper's brute force (Sect. 4.1) combines pairs of lines of one image with pairs of another, which grows with
the fourth power of their number. Here one line of an image meets one of another (the second power),
a third image confirms the line in space, and the list of standard diameters says where the pipe's second edge
must be. What remains is ranked by how well the images agree about the surface and by the evidence of its
edges, drawn onto them, and accepted greedily: a part of space belongs to one pipe.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.cylinder import Cylinders, joined, outlines, spread
from pipeworkbench.recon.edge_lines import EdgeLineSettings, match_lines
from pipeworkbench.recon.edge_raster import raster_of
from pipeworkbench.recon.evidence import EvidenceSettings, evidence
from pipeworkbench.recon.long_lines import LongLineSettings, long_lines
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.pipes import from_pick
from pipeworkbench.recon.prolong import prolonged
from pipeworkbench.recon.second_edges import SecondEdgeSettings, cylinders_from_edges
from pipeworkbench.recon.settle import drawn_onto_edges
from pipeworkbench.recon.surface import Agreement, agreement, surface_agreement
from pipeworkbench.recon.threads import thread_count
from pipeworkbench.recon.vectors import across
from pipeworkbench.recon.views import View

TRUE_SHARE, TRUE_DECLINE = 0.95, 0.06  # correlations of right cylinders pile up below 1 like this
FALSE_RANGE = 1.2  # those of wrong ones spread evenly over about so much
NEAR_PX = 2  # what counts as an edge at first glance
SETTLING_PX = (3.0, 3.0, 2.0)  # search ranges of the steps onto the edges
PROLONGED_PX = (2.0, 1.5)  # the same once they are longer
CELL_PX, CELL_MM, CELL_RADIUS = 6.0, 100.0, 0.04  # cylinders in one cell of direction, place and relative radius are alike
NESTED = 0.8  # radii; of what lies further beside an accepted pipe, most is outside it
PARALLEL = 0.97  # cosine
PICK_SAMPLES = 25  # along a detected cylinder, to find what of it an image shows
WORKERS = 2  # more wait for each other's interpreter lock
STEPS = 7  # that are reported
RIVALS = 1.4  # of the distance; the next sizes with the same edges are nearer than this
SAME_PLACE = 0.5  # radii; a measured pipe further from what was detected is another one
FURTHEST_SETTLED = 200.0  # mm; what is drawn further off was something else
SCREENING = EvidenceSettings(samples=16, background=((-14.0, -6.0), (6.0, 14.0)))  # for many hypotheses at a time


@dataclass(frozen=True)
class DetectSettings:
    """Tunables; lengths in mm.

    ``working_range`` and ``diameter_range`` limit the pipes (below 15 mm mouldings and rails look like pipes).
    ``screened``, ``weighed``, ``settled`` and ``prolonged`` are how many hypotheses go on to the next step at most;
    ``surface_weight`` is what the images' agreement about the surface counts against the evidence of
    the edges. A pipe is accepted with at least ``least_evidence``, ``least_agreement`` of its surface in
    every pair of images, at most ``most_beside`` of what is beside it, ``least_constancy`` along the
    axis, ``slenderness`` and a diameter within ``tolerance`` (and ``tolerance_px`` in the images) of one of series 1 or ``rare_tolerance`` of
    another (parts of the diameter). When it is measured it must lead other places by ``least_lead`` and itself moved by
    ``least_nearby_lead``, more than a pick: nobody said that there is a pipe.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (15.0, 700.0)
    segments: LongLineSettings = field(default_factory=LongLineSettings)
    lines: EdgeLineSettings = field(default_factory=lambda: EdgeLineSettings(least_length=25.0, least_witnesses=0.45, steepest_deg=85.0))
    second_edges: SecondEdgeSettings = field(default_factory=SecondEdgeSettings)
    screened: int = 6000
    weighed: int = 2500
    settled: int = 1000
    prolonged: int = 400
    surface_weight: float = 0.6
    least_evidence: float = 0.9
    least_agreement: float = 0.955
    most_beside: float = 0.9
    least_constancy: float = 0.15
    slenderness: float = 1.3
    tolerance: float = 0.012
    tolerance_px: float = 0.3
    rare_tolerance: float = 0.004
    least_lead: float = 30.0
    least_nearby_lead: float = 16.0


@dataclass(frozen=True, eq=False)
class Detected:
    """Cylinders that are pipes, best first: extents (k, 2) mm along the axes, sizes and confidence (k,)."""

    cylinders: Cylinders
    extents: Array
    sizes: tuple[PipeSize, ...]
    confidence: Array


def detect_cylinders(
    views: Sequence[View],
    settings: DetectSettings | None = None,
    progress: Callable[[str], None] = lambda text: None,  # noqa: ARG005
) -> Detected:
    """Find the pipes in a station's images.

    Parameters
    ----------
    views : sequence of View
    settings : DetectSettings, optional
    progress : callable
        Called with what is being done.
    """
    settings = settings or DetectSettings()
    progress("finding lines")
    with ThreadPoolExecutor(thread_count(WORKERS)) as threads:
        segments = list(threads.map(lambda view: long_lines(view.edges, view.camera.interior, settings.segments), views))
        rasters = list(threads.map(lambda view: raster_of(view.edges, NEAR_PX), views))
    progress("matching lines")
    lines = match_lines(views, segments, settings.lines)
    common = [size for size in pipe_sizes() if size.series == 1 and settings.diameter_range[0] <= size.outer_diameter <= settings.diameter_range[1]]
    diameters = np.array([size.outer_diameter for size in common])
    progress("finding second edges")
    cylinders, extents, second = cylinders_from_edges(views, rasters, lines, diameters, settings.second_edges)
    if not len(cylinders):
        return Detected(cylinders, extents, (), np.zeros(0))
    progress("comparing surfaces")
    surface = _log_ratio(surface_agreement(views, cylinders, extents, 10, 7))
    best = _distinct(views, cylinders, extents, surface + 2 * second, settings.screened)
    cylinders, extents, surface = cylinders[best], extents[best], surface[best]
    best = np.argsort(-surface - 2 * second[best], kind="stable")[: settings.weighed]
    cylinders, extents, surface = cylinders[best], extents[best], surface[best]
    progress("weighing edges")
    score = _edge_evidence(views, cylinders, extents, SCREENING) + settings.surface_weight * surface
    best = np.argsort(-score, kind="stable")[: settings.settled]
    progress("drawing onto edges")
    cylinders, extents, _ = _settled(views, cylinders[best], extents[best], SETTLING_PX)
    score = _edge_evidence(views, cylinders, extents, SCREENING)
    score += settings.surface_weight * _log_ratio(surface_agreement(views, cylinders, extents, 10, 7))
    best = _distinct(views, cylinders, extents, score, settings.prolonged)
    cylinders, extents = _prolonged(views, cylinders[best], extents[best])
    return _accepted(views, cylinders, extents, settings)


def detect(
    views: Sequence[View],
    settings: DetectSettings | None = None,
    pick_settings: PickSettings | None = None,
    progress: Callable[[str], None] = lambda text: None,  # noqa: ARG005
) -> tuple[PipeCandidate, ...]:
    """Find the pipes in a station's images and measure each as if its edges had been clicked.

    Parameters
    ----------
    views : sequence of View
    settings : DetectSettings, optional
    pick_settings : PickSettings, optional
        Of the measurement; the diameters and the working range are those of ``settings``.
    progress : callable
        Called with what is being done.

    Returns
    -------
    tuple of PipeCandidate
        No two in the same place; best first.
    """
    settings = settings or DetectSettings()
    pick_settings = replace(
        pick_settings or PickSettings(),
        working_range=settings.working_range,
        diameter_range=settings.diameter_range,
        least_lead=settings.least_lead,
        least_nearby_lead=settings.least_nearby_lead,
    )
    found = detect_cylinders(views, settings, progress)
    progress("measuring pipes")
    picks = [pick for row in range(len(found.sizes)) if (pick := _as_pick(views, found, row)) is not None]
    with ThreadPoolExecutor(thread_count(WORKERS)) as threads:
        answers = list(threads.map(lambda pick: from_pick(views, pick, _nearby(views, found, pick, pick_settings)), picks))
    # a pipe that the measurement takes for another than the detection is not sure enough
    candidates = [
        answer[0]
        for pick, answer in zip(picks, answers, strict=True)
        if answer and not answer[0].approximate and _confirms(answer[0], found, pick.index)
    ]
    if not candidates:
        return ()
    cylinders = joined([candidate.solution.cylinder.as_many() for candidate in candidates])
    extents = np.array([candidate.extent for candidate in candidates])
    return tuple(candidates[row] for row in _beside_each_other(cylinders, extents, range(len(candidates))))


def _nearby(views: Sequence[View], found: Detected, pick: PipePick, settings: PickSettings) -> PickSettings:
    """Return settings that search where pipes of the detected size and its neighbours would have the same edges."""
    middle = found.cylinders.points[pick.index] + found.extents[pick.index].mean() * found.cylinders.directions[pick.index]
    distance = float(np.linalg.norm(middle - views[pick.camera].camera.projection_centre))
    near, far = settings.working_range
    return replace(settings, working_range=(max(near, distance / RIVALS), min(far, distance * RIVALS)))


def _confirms(candidate: PipeCandidate, found: Detected, row: int) -> bool:
    """Tell whether a measured pipe has the size and, over the detected extent, the place of a detected one."""
    cylinder, size = candidate.solution.cylinder, found.sizes[row]
    ends = found.cylinders.points[row] + found.extents[row][:, None] * found.cylinders.directions[row]
    offset = across(ends - cylinder.point, cylinder.direction)
    return candidate.size == size and bool(np.linalg.norm(offset, axis=1).max() <= SAME_PLACE * cylinder.radius)


def _as_pick(views: Sequence[View], found: Detected, row: int) -> PipePick | None:
    """Return a pick on the edges of a detected cylinder, in the image that shows most of it."""
    which = np.array([row])
    along = spread(found.extents[which], np.linspace(0.02, 0.98, PICK_SAMPLES))
    outline = [outlines(view.camera, found.cylinders[which], along)[0][0] for view in views]
    seen = [np.flatnonzero(np.isfinite(position).all(axis=(0, 2))) for position in outline]
    camera = int(np.argmax([len(rows) for rows in seen]))
    if len(seen[camera]) < 2:
        return None
    edges = outline[camera][:, [seen[camera][0], seen[camera][-1]]]
    return PipePick(row, camera, edges, None)


def _edge_evidence(views: Sequence[View], cylinders: Cylinders, extents: Array, settings: EvidenceSettings) -> Array:
    """Return the mean log-likelihood ratio (k,) of the edges per independent stretch of a contour."""
    ratios = evidence(views, 0, cylinders, extents, settings)
    return _mean_known(ratios.mean(axis=2) / settings.stretches)


def _log_ratio(correlations: Array) -> Array:
    """Return the mean log-likelihood ratio (k,) of correlations (pairs, k) for the same surface against another."""
    alike = TRUE_SHARE * np.exp(-(1 - correlations) / TRUE_DECLINE) / TRUE_DECLINE + (1 - TRUE_SHARE)
    return _mean_known(np.log(alike * FALSE_RANGE))


def _mean_known(values: Array) -> Array:
    """Return means (k,) of values (views or pairs, k) over those that are known; one alone counts half."""
    known = np.isfinite(values)
    return np.where(known, values, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 2)


def _distinct(views: Sequence[View], cylinders: Cylinders, extents: Array, score: Array, most: int) -> NDArray[np.intp]:
    """Return the best of cylinders that are nearly the same: one per cell of a grid over how they look."""
    cells = []
    middle = cylinders.at(extents.mean(axis=1))
    for view in views[:2]:
        normal = np.cross(middle - view.camera.projection_centre, cylinders.directions)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        normal *= np.where(normal[:, :1] + 0.37 * normal[:, 1:2] < 0, -1.0, 1.0)
        cells.append(np.rint(normal * view.camera.interior.pixels_per_radian / CELL_PX))
    along = np.rint(np.einsum("ki,ki->k", middle, np.abs(cylinders.directions)) / np.maximum(extents[:, 1] - extents[:, 0], CELL_MM))
    cells += [np.rint(np.log(cylinders.radii) / CELL_RADIUS)[:, None], along[:, None]]
    order = np.argsort(-score, kind="stable")
    _, first = np.unique(np.column_stack(cells)[order], axis=0, return_index=True)
    return order[np.sort(first)][:most]


def _settled(views: Sequence[View], cylinders: Cylinders, extents: Array, ranges: Sequence[float]) -> tuple[Cylinders, Array, NDArray[np.intp]]:
    """Return the cylinders (k) drawn onto the edges, their extents from their middles, and the rows (k,) that they were."""
    half = (extents[:, 1] - extents[:, 0]) / 2
    middle = Cylinders(cylinders.at(extents.mean(axis=1)), cylinders.directions, cylinders.radii)
    moved = middle
    for reach in ranges:
        moved = drawn_onto_edges(views, moved, half, reach)
    with np.errstate(invalid="ignore"):
        good = np.isfinite(moved.points).all(axis=1) & (moved.radii > 0.5 * middle.radii) & (moved.radii < 2 * middle.radii)
        good &= np.linalg.norm(moved.points - middle.points, axis=1) < FURTHEST_SETTLED
    return moved[good], np.column_stack([-half, half])[good], np.flatnonzero(good)


def _prolonged(views: Sequence[View], cylinders: Cylinders, extents: Array) -> tuple[Cylinders, Array]:
    """Return the cylinders drawn onto their edges as far as these go on.

    The extents remain those of the pieces: beyond a flange a pipe in line goes on as another one.
    """
    whole = prolonged(views, cylinders, extents)
    moved, _, rows = _settled(views, cylinders, whole, PROLONGED_PX)
    return moved, extents[rows] - whole[rows].mean(axis=1, keepdims=True)


def _accepted(views: Sequence[View], cylinders: Cylinders, extents: Array, settings: DetectSettings) -> Detected:
    """Return the cylinders that are pipes, without those in the same place as a better one."""
    if not len(cylinders):
        return Detected(cylinders, extents, (), np.zeros(0))
    length = extents[:, 1] - extents[:, 0]
    size, fits = _sizes_of(2 * cylinders.radii, _tolerances(views, cylinders, extents, settings), settings)
    rows = np.flatnonzero(fits & (length >= settings.slenderness * 2 * cylinders.radii))
    cylinders, extents, size, length = cylinders[rows], extents[rows], size[rows], length[rows]
    edges = _edge_evidence(views, cylinders, extents, EvidenceSettings())
    images = agreement(views, cylinders, extents)
    good = (edges >= settings.least_evidence) & _is_pipe(images, settings)
    confidence = edges + settings.surface_weight * _log_ratio(images.surface)
    order = np.argsort(-confidence * np.sqrt(length), kind="stable")
    rows = np.array(_beside_each_other(cylinders, extents, order[good[order]]), dtype=np.intp)
    return Detected(cylinders[rows], extents[rows], tuple(pipe_sizes()[i] for i in size[rows]), confidence[rows])


def _tolerances(views: Sequence[View], cylinders: Cylinders, extents: Array, settings: DetectSettings) -> Array:
    """Return by how much (k,) of themselves diameters may deviate: what the images resolve counts for thin pipes."""
    camera = views[0].camera
    distance = np.linalg.norm(cylinders.at(extents.mean(axis=1)) - camera.projection_centre, axis=1)
    return np.hypot(settings.tolerance, settings.tolerance_px * distance / camera.interior.pixels_per_radian / (2 * cylinders.radii))


def _is_pipe(images: Agreement, settings: DetectSettings) -> NDArray[np.bool_]:
    """Return which surfaces (k,) are seen alike in every pair of images, stand free and do not change along the axis."""
    known = np.isfinite(images.surface)
    alike = np.where(known, images.surface, 1.0).min(axis=0) >= settings.least_agreement
    free = (np.nan_to_num(images.beside, nan=-1.0) <= settings.most_beside).all(axis=0)
    return known.any(axis=0) & alike & free & (images.constancy > settings.least_constancy)


def _sizes_of(diameters: Array, tolerances: Array, settings: DetectSettings) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the nearest standard sizes' rows (k,) and whether the diameters fit; of those that do, a common one comes first."""
    standard = np.array([size.outer_diameter for size in pipe_sizes()])
    common = np.array([size.series == 1 for size in pipe_sizes()])
    off = np.abs(diameters[:, None] / standard - 1) / np.where(common, tolerances[:, None], settings.rare_tolerance)
    best = off.argmin(axis=1)
    return best, off.min(axis=1) <= 1


def _beside_each_other(cylinders: Cylinders, extents: Array, order: Iterable[int]) -> list[int]:
    """Return the rows in their order, without those that are in the way of an earlier one."""
    chosen: list[int] = []
    for row in order:
        if not _in_the_way(cylinders, extents, int(row), chosen):
            chosen.append(int(row))
    return chosen


def _in_the_way(cylinders: Cylinders, extents: Array, row: int, chosen: Sequence[int]) -> bool:
    """Tell whether a cylinder runs along and through one that is accepted already."""
    others = np.array(chosen, dtype=np.intp)
    ends = cylinders.points[row] + extents[row][:, None] * cylinders.directions[row]
    offset = ends[None] - cylinders.points[others][:, None]
    along = np.einsum("kei,ki->ke", offset, cylinders.directions[others])
    across = np.linalg.norm(offset - along[:, :, None] * cylinders.directions[others][:, None], axis=2)
    near = across.min(axis=1) < cylinders.radii[others] + NESTED * cylinders.radii[row]
    beside = (along.max(axis=1) > extents[others, 0]) & (along.min(axis=1) < extents[others, 1])
    parallel = np.abs(cylinders.directions[others] @ cylinders.directions[row]) > PARALLEL
    return bool((near & beside & parallel).any())
