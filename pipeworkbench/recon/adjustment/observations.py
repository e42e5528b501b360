# SPDX-License-Identifier: LGPL-2.1-or-later
"""Image observations: distances of contour samples to the nearest subpixel edges, and their normal equations by contour.

A contour in an image is a group. Its samples' errors have three parts: their own noise, which edge points share with
their neighbours because the detector smooths; an error that all samples have in common (calibration, shading of the
limb); and a change of it along the contour, on circles from side to side. The last two are unknowns of the group with a known
variance; they are eliminated group by group, so that a long contour does not count for more than its common error allows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from pipeworkbench.recon.adjustment.charts import MOTION, by_motion
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.sampling import Samples
from pipeworkbench.recon.bodies import Bodies
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.match import match
from pipeworkbench.recon.shapes import Shapes
from pipeworkbench.recon.vectors import dot
from pipeworkbench.recon.views import View

SYSTEMATIC = 3  # unknowns of a group: its common error and how it changes
DISTANCE = MOTION  # column: after the motion, before the systematic errors
LENGTH = DISTANCE + 1 + SYSTEMATIC
NEIGHBOURS = 21  # samples over which the brighter side is decided
CLEAR = 0.5  # part by which one side must be brighter more often than the other
MAD = 1.4826  # standard deviations in a median of absolute deviations of normal errors
SHRINKING = 8.0  # samples that speak for the edge points' own standard deviations
CORRELATION = 2 * np.sqrt(np.pi)  # times the smoothing: the length over which errors along an edge are alike
FAR = 3.0  # standard deviations; what a sample without an edge costs


@dataclass(frozen=True, eq=False)
class Groups:
    """Contours in images, g in number, with the normal equations of their samples.

    view, owner (g,) rows; part (g,) and curve (g,) name the contour; normal (g, 13, 13) is the weighted product of the
    columns motion, distance, systematic errors; circle (g,) tells which are closed; samples, found (g,) numbers; effective (g,) number of independent
    samples; spread (g,) robust standard deviation of the distances in px; missing (g,) the number of independent samples without an edge.
    """

    view: NDArray[np.intp]
    owner: NDArray[np.intp]
    part: NDArray[np.str_]
    curve: NDArray[np.intp]
    normal: Array
    circle: NDArray[np.bool_]
    samples: NDArray[np.intp]
    found: NDArray[np.intp]
    effective: Array
    spread: Array
    missing: Array

    def __len__(self) -> int:
        return len(self.owner)

    def systematic_variance(self, settings: AdjustmentSettings) -> Array:
        """Return what is expected of the squares (g, 3), px^2, of the common errors and their changes.

        Opposite parts of a circle err as independently of each other as both sides of a pipe: there all three have half of the
        common error's variance.
        A contour that scatters more is drawn to shading and others' edges, and off as a whole by most of its scatter; where
        edges are missing what is left says less about the whole.
        """
        found = np.maximum(self.found, 1) / np.maximum(self.samples, 1)
        square = (self.spread**2 / found)[:, None]
        common = settings.common_sigma**2 + square * settings.common_share**2
        trend = settings.trend_sigma**2 + square * settings.trend_share**2
        closed = self.circle[:, None]
        return np.asarray(np.where(closed, common / 2, np.concatenate([common, trend, np.zeros_like(trend)], axis=1)))

    def without(self, left_out: NDArray[np.bool_]) -> Groups:
        """Return the groups with some (g,) that count for nothing."""
        normal = np.where(left_out[:, None, None], 0.0, self.normal)
        return replace(self, normal=normal, effective=np.where(left_out, 0.0, self.effective), missing=np.where(left_out, 0.0, self.missing))


@dataclass(frozen=True, eq=False)
class SampleRows:
    """The samples of one image with their linearised observations.

    edge (n,) rows of the edge points, -1 for none; position and normal (n, 2) of the contour, px; distance (n,) px, NaN where there is no
    edge; sigma (n,) px of the edge points; weight (n,) 1 / px^2, zero where it does not count; scale (g,) their
    robust standard deviation over the edge points' own; spread and missing (g,) as in the groups.
    """

    edge: NDArray[np.int32]
    position: Array
    normal: Array
    distance: Array
    sigma: Array
    weight: Array
    scale: Array
    spread: Array
    missing: Array


def observe(
    view: View,
    camera: Camera,
    number: int,
    samples: Samples,
    shapes: Shapes,
    bodies: Bodies,
    reach: float,
    settings: AdjustmentSettings,
    matched: SampleRows | None = None,
) -> tuple[Groups, SampleRows]:
    """Match the samples of one image (the ``number``-th) and return their normal equations by group, and the samples themselves.

    Where they are ``matched`` already, edges and weights stay: then the observations are a smooth function of the unknowns.
    """
    seen = samples.seen_by(camera, shapes)
    part = samples.group_part[samples.group]
    motion = seen.gain[:, None] * by_motion(bodies, samples.owner, part, seen.point, seen.outward)
    if matched is None:
        rows = matched_edges(view, seen.position, seen.normal, samples, reach, settings)
    else:
        offset = view.edges.position[matched.edge] - seen.position if len(view.edges) else np.zeros_like(seen.position)
        distance = np.where(matched.edge >= 0, dot(offset, seen.normal), np.nan)
        rows = replace(matched, position=seen.position, normal=seen.normal, distance=distance)
    usable = (rows.weight > 0) & np.isfinite(motion).all(axis=1) & np.isfinite(rows.distance)
    weight = np.where(usable, rows.weight, 0.0)
    root = np.sqrt(weight)
    columns = np.empty((len(samples), LENGTH))
    columns[:, :MOTION] = np.where(usable[:, None], motion, 0.0) * root[:, None]
    columns[:, DISTANCE] = np.where(usable, rows.distance, 0.0) * root
    columns[:, DISTANCE + 1] = root
    columns[:, DISTANCE + 2 :] = samples.pattern * root[:, None]
    count = len(samples.group_owner)
    groups = Groups(
        np.full(count, number),
        samples.group_owner,
        samples.group_part,
        samples.group_curve,
        _products(columns, samples),
        samples.circle,
        samples.count,
        np.bincount(samples.group, usable, count).astype(np.intp),
        _sums(samples.group, weight * np.where(usable, rows.sigma * rows.scale[samples.group], 0.0) ** 2, count),
        rows.spread,
        rows.missing,
    )
    return groups, rows


def joined(parts: Sequence[Groups]) -> Groups:
    """Return the groups of all images."""
    if not parts:
        none, nothing = np.zeros(0, np.intp), np.zeros(0)
        return Groups(none, none, np.zeros(0, str), none, np.zeros((0, LENGTH, LENGTH)), np.zeros(0, bool), none, none, nothing, nothing, nothing)
    names = Groups.__dataclass_fields__
    return Groups(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def matched_edges(view: View, position: Array, normal: Array, samples: Samples, reach: float, settings: AdjustmentSettings) -> SampleRows:
    """Return the nearest edges whose brighter side is where it is along most of the contour, with their weights."""
    edges = view.edges
    count = len(samples.group_owner)
    if not len(edges):
        none = np.full(len(samples), np.nan)
        nothing = samples.count.astype(float)
        return SampleRows(
            np.full(len(samples), -1, np.int32), position, normal, none, none, np.zeros(len(samples)), np.ones(count), np.zeros(count), nothing
        )
    first = match(edges, position, normal, reach)
    brighter = np.where(first.found, dot(edges.normal[first.edge], normal), 0.0)
    polarity = _polarity(brighter, samples)
    again = np.flatnonzero(polarity * brighter < 0)
    edge, distance = first.edge.copy(), first.distance.copy()
    if len(again):
        second = match(edges, position[again], normal[again], reach, polarity[again])
        edge[again], distance[again] = second.edge, second.distance
    sigma, smoothing = edges.sigma[edge], edges.smoothing[edge]
    good = (edge >= 0) & np.isfinite(sigma) & (sigma > 0) & np.isfinite(smoothing) & np.isfinite(distance)
    edge = np.where(good, edge, np.int32(-1))
    distance, sigma, smoothing = (np.where(good, values, np.nan) for values in (distance, sigma, smoothing))
    return SampleRows(edge, position, normal, distance, sigma, *_weights(distance, sigma, smoothing, samples, reach, settings))


def _polarity(sign: Array, samples: Samples) -> Array:
    """Return for samples (n,) on which side it must be brighter: +1 along the normal, -1 against it, 0 where the neighbours disagree."""
    table, rank = _table(np.sign(sign), samples)
    known = uniform_filter1d(np.abs(table), NEIGHBOURS, axis=1, mode="constant")
    mean = uniform_filter1d(table, NEIGHBOURS, axis=1, mode="constant")
    clear = np.abs(mean) > CLEAR * np.maximum(known, 2 / NEIGHBOURS)
    return np.asarray(np.where(clear, np.sign(mean), 0.0)[samples.group, rank])


def _table(values: Array, samples: Samples, filling: float = 0.0) -> tuple[Array, NDArray[np.intp]]:
    """Return values (n, ...) as a table (g, m, ...) with a group in each row, filled up where it has no more samples, and their columns (n,)."""
    count = samples.count
    rank = np.arange(len(samples)) - (np.cumsum(count) - count)[samples.group]
    table = np.full((len(count), int(count.max(initial=0)), *values.shape[1:]), filling)
    table[samples.group, rank] = values
    return table, rank


def _weights(
    distance: Array, sigma: Array, smoothing: Array, samples: Samples, reach: float, settings: AdjustmentSettings
) -> tuple[Array, Array, Array, Array]:
    """Return weights (n,); robust scales, spreads in px and numbers of independent samples that are missing (g,)."""
    count = len(samples.group_owner)
    group = samples.group
    middle = _medians(distance, samples)
    off = np.abs(distance - middle[group]) / sigma
    over_sigma, spread = (MAD * _medians(values, samples) for values in (off, off * sigma))
    known = np.bincount(group, np.isfinite(off), count)
    scale = np.sqrt(np.maximum((known * np.nan_to_num(over_sigma, nan=1.0) ** 2 + SHRINKING) / (known + SHRINKING), 1.0))
    limit = settings.tukey * scale[group]
    if reach > settings.ranges[-1]:
        # while the search is coarse all within it may belong together
        limit = np.maximum(limit, reach / np.where(np.isfinite(sigma), sigma, 1.0))
    with np.errstate(invalid="ignore"):
        robust = np.nan_to_num(np.clip(1 - (off / limit) ** 2, 0, None) ** 2)
        independent = np.minimum(samples.spacing[group] / (CORRELATION * smoothing), 1.0)
        weight = np.nan_to_num(robust * independent / (sigma * scale[group]) ** 2)
        share = np.where(np.isfinite(independent), independent, 1.0)
    return weight, scale, np.nan_to_num(spread), _sums(group, share * (1 - robust), count)


def _sums(group: NDArray[np.intp], values: Array, count: int) -> Array:
    """Return the sums (g,) of the values (n,) of each group."""
    return np.asarray(np.bincount(group, values, count), float)


def _medians(values: Array, samples: Samples) -> Array:
    """Return the medians (g,) of the values (n,) of each group that are numbers, NaN where there are none."""
    table, _ = _table(np.where(np.isfinite(values), values, np.inf), samples, np.inf)
    table.sort(axis=1)
    number = np.isfinite(table).sum(axis=1)
    row = np.arange(len(table))
    with np.errstate(invalid="ignore"):
        middle = (table[row, np.maximum(number - 1, 0) // 2] + table[row, np.minimum(number // 2, table.shape[1] - 1)]) / 2 if table.size else row
    return np.asarray(np.where(number > 0, middle, np.nan))


def _products(rows: Array, samples: Samples) -> Array:
    """Return the products (g, m, m) of each group's rows (n, m) with themselves."""
    table, _ = _table(rows, samples)
    return np.asarray(np.swapaxes(table, 1, 2) @ table)


@dataclass(frozen=True, eq=False)
class Reduced:
    """Groups after their systematic errors were eliminated.

    normal (g, 10, 10) of motion and distance; solver (g, 3, 10) gives the errors (3,) that go with a motion x (9,): solver
    [-x, 1]; cofactor (g, 3, 3) their covariance where the motion is known.
    """

    normal: Array
    solver: Array
    cofactor: Array


def reduced(groups: Groups, precision: Array) -> Reduced:
    """Eliminate the common errors and trends of groups with known precisions (g, 3), 1 / px^2."""
    own, errors = slice(DISTANCE + 1), slice(DISTANCE + 1, LENGTH)
    cofactor = np.linalg.inv(groups.normal[:, errors, errors] + precision[:, :, None] * np.eye(SYSTEMATIC))
    solver = cofactor @ groups.normal[:, errors, own]
    return Reduced(groups.normal[:, own, own] - groups.normal[:, own, errors] @ solver, solver, cofactor)
