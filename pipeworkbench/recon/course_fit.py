# SPDX-License-Identifier: LGPL-2.1-or-later
"""Courses drawn onto the image edges, and how much the images speak for them; all hypotheses at once.

The adjustment is the paper's Sect. 7.3 in its second form: the full set of parameters with pseudo-observations
that keep the straight pieces on the axes of their pipes, as well as these are known. A held radius makes
it the fit of a standard bend. The weighing is the likelihood ratio of evidence.py, which unlike Eq. 4 alone knows how
dense edges are by chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.chance import densities_beside, over_rates, own_over_chance
from pipeworkbench.recon.courses import PARAMETERS, CourseContour, Courses, Obstacles, contour_of_courses, hidden_samples
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.match import edges_along_normals, match, nearest_rows
from pipeworkbench.recon.views import View

RADIUS = PARAMETERS - 1  # column of the bend radius
STIFF = 1e12  # weight of what is held
FREEDOM = 4.0  # of Student's t, two-dimensional
FULL_SAMPLES = 72  # along a side; what edge_sigma is for


@dataclass(frozen=True)
class FitSettings:
    """Tunables of fitting and weighing; distances in px.

    ``ranges`` are the search ranges b iteration by iteration, ``samples`` the number along each side of a
    course; ``edge_sigma`` weighs an edge against the pseudo-observations (neighbouring samples err alike,
    so it is larger than an edge point's). ``search_range``, ``scatter``, ``hit_rates``, ``background``,
    ``least_density`` and ``stretches`` are those of the evidence.
    """

    ranges: tuple[float, ...] = (6.0, 4.0, 3.0, 2.0)
    samples: int = 72
    edge_sigma: float = 2.0
    search_range: float = 3.0
    scatter: float = 0.35
    hit_rates: tuple[float, ...] = (0.9, 0.7, 0.4)
    background: tuple[tuple[float, float], ...] = ((-19.0, -12.0), (12.0, 19.0))
    least_density: float = 0.02
    stretches: float = 10.0
    least_seen: float = 0.2


@dataclass(frozen=True, eq=False)
class AxisObservations:
    """Pseudo-observations of the axes of the pipes on both sides: points (k, 4, 3), the first two of the first pipe.

    ``covariance`` (k, 4, 3, 3) in mm^2.
    """

    points: Array
    covariance: Array

    def __getitem__(self, rows: NDArray[np.intp]) -> AxisObservations:
        return AxisObservations(self.points[rows], self.covariance[rows])


@dataclass(frozen=True, eq=False)
class CourseEvidence:
    """How well courses fit (k,).

    ``score`` the logarithm of how much more likely all edges are than by chance, with what the
    pseudo-observations were strained by; ``bend`` the same ratio per stretch on the bend alone; ``quality`` Eq. 4's
    q in px on the bend; ``support`` the part of the bend's samples that found an edge; ``seen`` the part of them that is
    in view, over all views.
    """

    score: Array
    bend: Array
    quality: Array
    support: Array
    seen: Array


def fitted(
    views: Sequence[View],
    courses: Courses,
    observed: AxisObservations,
    settings: FitSettings,
    obstacles: Obstacles = (),
    *,
    free_radius: bool = False,
) -> tuple[Courses, Array, list[NDArray[np.bool_]]]:
    """Draw courses onto the edges.

    Parameters
    ----------
    views : sequence of View
    courses : Courses
    observed : AxisObservations
    settings : FitSettings
    obstacles : sequence
        As for :func:`.courses.hidden_samples`.
    free_radius : bool
        Whether the bend radius is free or held.

    Returns
    -------
    courses : Courses
    sigma_radius : (k,) array
        Standard deviation of the radius in mm, NaN where it is held.
    hidden : list of (k, n, 2) arrays
        For each view, the samples that something stands before.
    """
    held = np.zeros(PARAMETERS, bool)
    held[RADIUS] = not free_radius
    cofactor = np.full(len(courses), np.nan)
    # what stands before a course hardly changes while it moves
    hidden = [hidden_samples(view, courses, courses.spread(settings.samples), obstacles) for view in views]
    for reach in settings.ranges:
        if not len(courses):
            break
        matrix, right = _pseudo_observations(courses, observed)
        places = courses.spread(settings.samples)
        derivatives = courses.derivatives(places)
        for view, behind in zip(views, hidden, strict=True):
            contour = contour_of_courses(view, courses, places, behind)
            distance = match(view.edges, contour.position.reshape(-1, 2), contour.normal.reshape(-1, 2), reach).distance
            distance = distance.reshape(contour.gain.shape)
            weight = np.where(np.isnan(distance), 0, (1 - (np.nan_to_num(distance) / (1.2 * reach)) ** 2) ** 2)
            # the edges of a course count as often as there are independent stretches, however many samples
            weight *= FULL_SAMPLES / settings.samples / settings.edge_sigma**2
            design = np.nan_to_num(contour.gain[..., None] * np.einsum("knsi,knip->knsp", contour.outward, derivatives))
            design = design.reshape(len(courses), 2 * settings.samples, PARAMETERS)
            weighted = design * weight.reshape(len(courses), 2 * settings.samples, 1)
            matrix += np.swapaxes(weighted, 1, 2) @ design
            right += np.einsum("knp,kn->kp", weighted, np.nan_to_num(distance).reshape(len(courses), 2 * settings.samples))
        matrix[:, held] = 0.0
        matrix[:, :, held] = 0.0
        matrix[:, held, held] = STIFF
        right[:, held] = 0.0
        # a radius that no edge speaks for stays; its unit is mm, a weight of 1e-4 is a standard deviation of 100 mm
        matrix[:, RADIUS, RADIUS] += 1e-4
        step = np.linalg.solve(matrix, right[..., None])[..., 0]
        limit = 0.5 * courses.tube_radius
        step[:, RADIUS] = np.clip(step[:, RADIUS], -limit, limit)
        step[:, :3] *= np.minimum(1.0, limit / np.maximum(np.linalg.norm(step[:, :3], axis=1), 1e-9))[:, None]
        courses = courses.moved(step)
        courses = Courses(
            courses.corner,
            courses.come,
            courses.go,
            np.maximum(courses.bend_radius, 1.02 * courses.tube_radius),
            courses.tube_radius,
            np.maximum(courses.reach, courses.tangent_length),
        )
        cofactor = np.linalg.inv(matrix)[:, RADIUS, RADIUS]
    return courses, np.sqrt(np.maximum(cofactor, 0.0)) if free_radius else np.full(len(courses), np.nan), hidden


def _pseudo_observations(courses: Courses, observed: AxisObservations) -> tuple[Array, Array]:
    """Return normal matrices (k, 8, 8) and right sides (k, 8) of what is known of the pipes' axes."""
    count = len(courses)
    matrix, right = np.zeros((count, PARAMETERS, PARAMETERS)), np.zeros((count, PARAMETERS))
    for number, axes, off, weight in _off_the_axes(courses, observed):
        direction, columns = (courses.come, (3, 4)) if number < 2 else (courses.go, (5, 6))
        along = np.einsum("ki,ki->k", observed.points[:, number] - courses.corner, direction)
        design = np.zeros((count, 2, PARAMETERS))
        design[:, :, :3] = axes
        design[:, [0, 1], columns] = along[:, None]
        square = np.einsum("ka,kab,kb->k", off, weight, off)
        # Student's t: a pipe that was led astray by other edges is further off than its covariance says
        robust = weight * ((FREEDOM + 2) / (FREEDOM + square))[:, None, None]
        matrix += np.swapaxes(design, 1, 2) @ robust @ design
        right += np.einsum("kap,kab,kb->kp", design, robust, off)
    return matrix, right


def _off_the_axes(courses: Courses, observed: AxisObservations) -> Iterator[tuple[int, Array, Array, Array]]:
    """Yield, of each observed point, its number, the axes (k, 2, 3) across, its offset along them (k, 2) and the weight (k, 2, 2)."""
    offset = observed.points - courses.corner[:, None]
    for direction, numbers in ((courses.come, (0, 1)), (courses.go, (2, 3))):
        axes = np.stack(perpendicular_axes(direction), axis=1)
        for number in numbers:
            weight = np.linalg.inv(axes @ observed.covariance[:, number] @ np.swapaxes(axes, 1, 2))
            yield number, axes, np.einsum("kai,ki->ka", axes, offset[:, number]), weight


def strain(courses: Courses, observed: AxisObservations) -> Array:
    """Return twice the negative log-likelihood (k,) of how far courses are from the axes of their pipes."""
    total = np.zeros(len(courses))
    for _, _, off, weight in _off_the_axes(courses, observed):
        total += (FREEDOM + 2) * np.log1p(np.einsum("ka,kab,kb->k", off, weight, off) / FREEDOM)
    return total


def weighed(
    views: Sequence[View],
    courses: Courses,
    observed: AxisObservations,
    group: NDArray[np.intp],
    settings: FitSettings,
    hidden: Sequence[NDArray[np.bool_]],
) -> CourseEvidence:
    """Weigh courses by the edges along them.

    ``group`` (k,) numbers what the courses are hypotheses of: those of one group share the density of
    edges by chance, so that their scores can be compared. ``hidden`` is as :func:`fitted` returns it.
    """
    count = len(courses)
    places = courses.spread(settings.samples)
    on_bend = (places > 0) & (places < 1)
    score, bend, squares = np.zeros(count), np.zeros(count), np.zeros(count)
    found, visible, possible = np.zeros(count), np.zeros(count), np.zeros(count)
    for view, behind in zip(views, hidden, strict=True):
        contour = contour_of_courses(view, courses, places, behind)
        off, density = _nearest_and_density(view, contour, settings)
        density = np.bincount(group, density)[group] / np.bincount(group)[group]
        quotient = own_over_chance(off, density[:, None, None], settings.scatter)
        seen, bent = contour.seen, on_bend[:, :, None] & contour.seen
        enough = seen.mean(axis=(1, 2)) >= settings.least_seen
        score += np.where(enough, _log_ratio(quotient, seen, settings), 0.0)
        weight = np.where(enough, bent.sum(axis=(1, 2)), 0)
        bend += weight * _log_ratio(quotient, bent, settings) / settings.stretches
        squares += np.where(bent, np.where(np.isnan(off), settings.search_range, off) ** 2, 0).sum(axis=(1, 2))
        found += (bent & ~np.isnan(off)).sum(axis=(1, 2))
        visible += bent.sum(axis=(1, 2))
        possible += 2 * on_bend.sum(axis=1)
    number = np.maximum(visible, 1)
    return CourseEvidence(
        score - strain(courses, observed) / 2,
        bend / number,
        np.where(visible > 0, np.sqrt(squares / number), settings.search_range),
        found / number,
        visible / np.maximum(possible, 1),
    )


def _nearest_and_density(view: View, contour: CourseContour, settings: FitSettings) -> tuple[Array, Array]:
    """Return distances (k, n, 2) of the nearest edges, NaN for none, and how many edges per px there are by chance (k,)."""
    shape = contour.gain.shape
    position, normal = contour.position.reshape(-1, 2), contour.normal.reshape(-1, 2)
    windows = np.array(settings.background)
    sample, _, distance = edges_along_normals(view.edges, position, normal, float(np.abs(windows).max()))
    density = densities_beside(sample, distance, windows, contour.seen.sum(axis=(1, 2)), shape[1] * shape[2], settings.least_density)
    rows = np.flatnonzero(np.abs(distance) <= settings.search_range)
    rows = rows[nearest_rows(sample[rows], distance[rows])]
    off = np.full(len(position), np.nan)
    off[sample[rows]] = np.abs(distance[rows])
    return off.reshape(shape), density


def _log_ratio(quotient: Array, share: NDArray[np.bool_], settings: FitSettings) -> Array:
    """Return the logarithm (k,) of how much more likely the edges of some samples (k, n, 2) are, over all hit rates."""
    number = np.maximum(share.sum(axis=(1, 2)), 1)
    # neighbouring samples meet the same edge: their mean counts as often as there are independent stretches
    rates = [settings.stretches * np.where(share, np.log(rate * quotient + 1 - rate), 0).sum(axis=(1, 2)) / number for rate in settings.hit_rates]
    return over_rates(rates)
