# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statistics of an adjustment: variance components, redundancy and Baarda's tests."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import scipy.special
from numpy.typing import NDArray

from pipeworkbench.recon.adjustment.charts import MOTION, RIGID
from pipeworkbench.recon.adjustment.conditions import NOBODY
from pipeworkbench.recon.adjustment.linearisation import Linearisation, Variances
from pipeworkbench.recon.adjustment.normal_equations import Covariance, covariance
from pipeworkbench.recon.adjustment.observations import reduced
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.camera import Array

NEAR = 0.1  # relative change of a variance that makes no difference
ROUNDS = 10  # of the estimation of variances
LEAST_REDUNDANCY = 0.2  # of a contour's common error that others must check before it may be called a gross error
SMALL = 1e-12
# of a pseudo-observation; less may be what is left of the numbers where a condition holds a thousand times better than images do
LEAST_PSEUDO_REDUNDANCY = 0.01


@dataclass(frozen=True, eq=False)
class Assessment:
    """What the residuals of a linearisation say.

    Attributes
    ----------
    covariance
        The cofactors of the unknowns.
    motion_cofactor : (c, 9, 9) array
        The components' part of it, by their motions.
    systematic : (g, 3) array
        Estimated systematic errors in px.
    posterior : (g, 3) array
        Their variances in px^2.
    offset : (g,) array
        How far a contour is off as a whole, in px, from where all others put it.
    w : (g,) array
        The same in its standard deviations (Baarda); NaN where nothing checks it. Contours that are left out have both from the
        distances that they still have.
    checked : (g,) array
        The part of a common error that the other observations would show.
    redundancy : (g,) array
        The contours' redundancy, in independent samples.
    squares : (g,) array
        Weighted squares of their residuals, common errors eliminated.
    pseudo_redundancy, pseudo_w : (r,) arrays
        Redundancy numbers and standardised residuals of the pseudo-observations.
    """

    covariance: Covariance
    motion_cofactor: Array
    systematic: Array
    posterior: Array
    offset: Array
    w: Array
    checked: Array
    redundancy: Array
    squares: Array
    pseudo_redundancy: Array
    pseudo_w: Array

    @property
    def image_factor(self) -> float:
        """The variance factor of the image observations."""
        return float(self.squares.sum() / max(self.redundancy.sum(), 1.0))

    def pseudo_factor(self, linear: Linearisation) -> float:
        """Return the variance factor of the soft pseudo-observations, 1 where there is next to none."""
        soft = linear.observed.soft
        redundancy = float(self.pseudo_redundancy[soft].sum())
        return float(linear.observed.squares[soft].sum() / redundancy) if redundancy >= 1 else 1.0


def assessed(
    linear: Linearisation, variances: Variances, settings: AdjustmentSettings, *, pseudo: bool = True, cofactors: Covariance | None = None
) -> Assessment:
    """Return the statistics of a linearisation at which the iteration has converged, those of the pseudo-observations where they are asked for.

    The ``cofactors`` may be those that it had with slightly other variances.
    """
    unknowns, groups = linear.unknowns, linear.groups
    cofactors = covariance(linear.equations) if cofactors is None else cofactors
    every = np.arange(len(unknowns.count))
    motion = unknowns.basis @ cofactors.blocks(unknowns, every, every) @ np.swapaxes(unknowns.basis, 1, 2)
    seen = motion[groups.owner]
    if unknowns.frames:
        seen = _with_frames(linear, cofactors, seen)
    # next to nothing where the iteration has converged with these variances
    step = linear.equations.solve()
    precision = variances.precision(groups, settings)
    out = np.zeros(len(groups), bool) if variances.left_out is None else variances.left_out
    systems = reduced(linear.complete, precision) if out.any() else linear.systems
    solver = systems.solver[:, :, :MOTION]
    share = np.einsum("gij,gjk,glk->gil", solver, seen, solver)
    systematic = linear.systematic(step, systems.solver)
    posterior = np.einsum("gii->gi", systems.cofactor + share)
    prior, nominal = np.maximum(1 / precision[:, 0], SMALL), np.maximum(variances.of(groups, settings)[:, 0], SMALL)
    # the part of a common error that shows; one that is left out has not drawn the result to itself
    shown = np.where(out, prior - systems.cofactor[:, 0, 0], prior - posterior[:, 0]) / prior
    with np.errstate(invalid="ignore", divide="ignore"):
        # how sure all others are of where it is does not depend on what it counts itself
        others = np.where(out, (systems.cofactor[:, 0, 0] / shown + share[:, 0, 0] / shown**2), posterior[:, 0] / shown)
        there = (shown > SMALL) & (linear.complete.effective > 0)
        offset = np.where(there, systematic[:, 0] / shown, np.nan)
        w = offset / np.sqrt(nominal + others)
        checked = np.where(there, nominal / (nominal + others), 0.0)
    systematic[out], posterior[out] = 0.0, 0.0
    taken = np.einsum("gij,gji->g", linear.systems.normal[:, :MOTION, :MOTION], seen)
    redundancy, pseudo_w = _of_pseudo(linear, cofactors, motion) if pseudo else (np.zeros(0), np.zeros(0))
    return Assessment(
        cofactors,
        motion,
        systematic,
        posterior,
        offset,
        w,
        checked,
        groups.effective - taken,
        linear.squares(step),
        redundancy,
        pseudo_w,
    )


def _with_frames(linear: Linearisation, cofactors: Covariance, seen: Array) -> Array:
    """Return the cofactors (g, 9, 9) of the components' motions relative to the cameras that see them."""
    unknowns, groups = linear.unknowns, linear.groups
    result = seen.copy()
    for number, frame in enumerate(unknowns.frames):
        mine = frame.of(groups.view)
        place = np.arange(RIGID) + (unknowns.frame_start[number] - unknowns.own)
        transform = unknowns.frame_motions(frame, groups.owner[mine])
        own = cofactors.border[np.ix_(place, place)]
        between = cofactors.between(unknowns, groups.owner[mine], place)
        crossed = between @ np.swapaxes(transform, 1, 2)
        result[mine, :, :6] += crossed
        result[mine, :6, :] += np.swapaxes(crossed, 1, 2)
        result[mine, :6, :6] += transform @ own @ np.swapaxes(transform, 1, 2)
    return result


def _of_pseudo(linear: Linearisation, cofactors: Covariance, motion: Array) -> tuple[Array, Array]:
    """Return redundancy numbers and standardised residuals of the pseudo-observations."""
    unknowns, observed = linear.unknowns, linear.observed
    one, other = np.maximum(observed.bodies, 0).T
    first, second = np.swapaxes(observed.derivative, 0, 1)
    between = unknowns.basis[one] @ cofactors.blocks(unknowns, one, other) @ np.swapaxes(unknowns.basis[other], 1, 2)
    known = np.einsum("ri,rij,rj->r", first, motion[one], first) + np.einsum("ri,rij,rj->r", second, motion[other], second)
    known += 2 * np.einsum("ri,rij,rj->r", first, between, second)
    # what is of components that stay has none
    moving = ((observed.bodies != NOBODY) & (unknowns.count[np.maximum(observed.bodies, 0)] > 0)).any(axis=1)
    redundancy = np.where(moving, 1 - known / observed.sigma**2, 0.0)
    checked = (redundancy > LEAST_PSEUDO_REDUNDANCY) & observed.telling
    with np.errstate(invalid="ignore", divide="ignore"):
        w = np.where(checked, -observed.misclosure / (observed.sigma * np.sqrt(redundancy)), np.nan)
    return redundancy, w


def estimated(linear: Linearisation, variances: Variances, settings: AdjustmentSettings) -> Variances:
    """Return the variances that go with the residuals of a linearisation, edges and weights of its samples as they are."""
    cofactors = covariance(linear.equations)
    for _ in range(ROUNDS):
        # how sure the components are changes less than what their contours weigh, and the caller asks again
        assessment = assessed(linear, variances, settings, pseudo=False, cofactors=cofactors)
        better = _better(linear, assessment, variances, settings)
        same = near(better, variances)
        variances, linear = better, linear.weighted(better, settings)
        if same:
            break
    return variances


def _better(linear: Linearisation, assessment: Assessment, variances: Variances, settings: AdjustmentSettings) -> Variances:
    """Return the variance factors of common errors and trends that go with the residuals, and the factors of Student's t.

    Each is the fixed point of sum of squares over redundancy, together with some contours that have what is expected.
    """
    used = linear.groups.effective > 0
    expected = np.maximum(linear.groups.systematic_variance(settings), SMALL)
    now = np.maximum(variances.of(linear.groups, settings), SMALL)
    square = assessment.systematic**2
    # how far a contour is off, by what all of it has in common and by its largest change
    scaled = (square + assessment.posterior) / now
    distance = scaled[:, 0] + np.where(linear.groups.circle, scaled[:, 1:].max(axis=1), scaled[:, 1])
    scale, weight = _of_normal_errors(settings.common_freedom)
    factor = np.where(used, _student(distance, settings.common_freedom) / weight, 1.0)
    checked = np.clip(1 - factor[:, None] * assessment.posterior / now, 0, 1)
    share = factor[:, None] * square / expected / scale
    circle = linear.groups.circle[:, None]
    result = []
    # circles' changes are as large as their common errors
    for there in (np.array([True, False, False]) | circle, np.array([False, True, False]) & ~circle):
        ours = used[:, None] & there
        total = settings.systematic_weight + float(share[ours].sum())
        result.append(total / (settings.systematic_weight + float(checked[ours].sum())))
    return Variances(result[0], result[1], factor, variances.left_out)


def _student(square: Array, freedom: float) -> Array:
    """Return the weights of Student's t, two-dimensional, for standardised squared distances."""
    return np.asarray((freedom + 2) / (freedom + square))


@functools.cache
def _of_normal_errors(freedom: float) -> tuple[float, float]:
    """Return the weighted mean square of errors that are normal after all, and their mean weight: both are to be 1."""
    # the squared distance of two-dimensional normal errors is distributed as 2 exp(1)
    node, share = scipy.special.roots_laguerre(60)
    weight = _student(2 * node, freedom)
    mean = float(share @ weight)
    return float(share @ (weight * node)) / mean, mean


def gross_contours(linear: Linearisation, assessment: Assessment, settings: AdjustmentSettings) -> NDArray[np.bool_]:
    """Return which contours (g,) have a gross error: of each component the one with the largest w beyond the limit (data snooping).

    None where what is said of the component itself, such as its size, is beyond the limit: that is never left out, and draws all its contours
    away from their edges.
    """
    observed = linear.observed
    contradicted = np.zeros(len(linear.unknowns.count), bool)
    contradicted[observed.bodies[~observed.exact & (observed.bodies[:, 1] == NOBODY) & (np.abs(assessment.pseudo_w) > settings.snooping), 0]] = True
    w = np.where(linear.groups.effective > 0, np.abs(np.nan_to_num(assessment.w)), 0.0)
    suspicious = np.flatnonzero((w > settings.snooping) & ~contradicted[linear.groups.owner] & (assessment.checked > LEAST_REDUNDANCY))
    order = suspicious[np.lexsort((-w[suspicious], linear.groups.owner[suspicious]))]
    found = np.zeros(len(w), bool)
    found[order[np.unique(linear.groups.owner[order], return_index=True)[1]]] = True
    return found


def wrongly_left_out(assessment: Assessment, variances: Variances, settings: AdjustmentSettings) -> NDArray[np.bool_]:
    """Return which contours (g,) that are left out fit a solution they had no part in: it was another's error that they showed."""
    if variances.left_out is None:
        return np.zeros(len(assessment.w), bool)
    return np.asarray(variances.left_out & (np.abs(assessment.w) <= settings.snooping))


def near(one: Variances, other: Variances) -> bool:
    """Tell whether two estimates make no difference."""
    pairs = ((one.common, other.common), (one.trend, other.trend))
    return all(abs(a - b) <= NEAR * max(a, b) for a, b in pairs)
