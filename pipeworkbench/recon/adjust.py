# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common adjustment of pipelines to the edges of all images (the paper's Sect. 7), with conditions between components.

Observations are the image distances of contour samples to the nearest subpixel edges, matched anew in each iteration
within a shrinking range; pseudo-observations hold standard sizes and make the pipeline continuous at its joints.
Unknowns are the components' parameters and, where wanted, the poses of stations and cameras.
Gauss and Newton's iteration with the damping of Levenberg and Marquardt; variances are estimated from the residuals, and
the adjustment repeated with them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.pipeline import Elbow
from pipeworkbench.recon.adjustment.charts import DIRECTION, MOTION, POSITION, bends
from pipeworkbench.recon.adjustment.feasibility import contradictions
from pipeworkbench.recon.adjustment.linearisation import Linearisation, Variances, linearised, sampled
from pipeworkbench.recon.adjustment.normal_equations import covariance
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem, StationViews
from pipeworkbench.recon.adjustment.report import Outcome, solution_of
from pipeworkbench.recon.adjustment.sampling import Samples
from pipeworkbench.recon.adjustment.slides import slid
from pipeworkbench.recon.adjustment.solution import AdjustedStation, ContourFit, Estimate, Gross, PseudoFit, Solution, Weak
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.adjustment.variances import assessed, estimated, gross_contours, near, wrongly_left_out
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import dot

__all__ = [
    "AdjustedStation",
    "AdjustmentSettings",
    "ContourFit",
    "Estimate",
    "Gross",
    "Problem",
    "PseudoFit",
    "Solution",
    "StationViews",
    "Weak",
    "adjust",
]

LEAST_DAMPING, FIRST_DAMPING = 1e-3, 0.3  # of the diagonal; less is none
FASTER, SLOWER = 0.1, 10.0
NO_GAIN = 0.01  # of the cost, in variances: what changes it by less moves nothing by a tenth of its standard deviation
LARGEST_STEP = 60.0  # mm in one iteration
UNDER_SIGMA = 0.02  # part of a standard deviation that is no movement
RESAMPLED_PX = 0.5  # contours that moved by more are sampled anew
THINNED = 3  # samples of which one is used on the way
NEAR_PX = 10.0  # search ranges that come again when flanges have found their places
CONVERGED = "converged: nothing moves by more than {:g} mm or a fiftieth of its standard deviation"
NOT_CONVERGED = "the largest number of iterations was reached"
STUCK = "converged: no step makes the fit better"
NOTHING = "there is nothing to adjust"
NO_BEND = "it is no bend, its axes are nearly in line; its joints do not count"
REASON = "nothing that is observed determines its {}"


def adjust(
    problem: Problem,
    settings: AdjustmentSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
) -> Solution:
    """Adjust components, and stations that are free, to the edges of all images and to what is known of them.

    Parameters
    ----------
    problem : Problem
    settings : AdjustmentSettings, optional
    progress : callable
        Called with what is being done, how many iterations are done and how many there may be.

    Returns
    -------
    Solution
        Also where something is not determined or conditions contradict each other: what that concerns is as it was.
    """
    settings = settings or AdjustmentSettings()
    state = State.of(problem, settings)
    against = contradictions(state, settings)
    reasons = {one.id: NO_BEND for one in problem.components if isinstance(one, Elbow) and not bends(one)}
    reasons |= {problem.components[row].id: reason for row, reason in against.reasons.items()}
    state = state.without(against.joints, {row: state.free[row] for row in against.reasons})
    samples = sampled(state, settings)
    state, more, far = _approached(state, samples, settings, progress)
    reasons |= more
    if settings.slide:
        state = slid(state, settings)
        samples = sampled(state, settings)
        near_ranges = tuple(reach for reach in settings.ranges if reach <= NEAR_PX) or settings.ranges[-1:]
        state, more, far = _approached(state, samples, replace(settings, ranges=near_ranges), progress)
        reasons |= more
    if far > RESAMPLED_PX:
        # what is seen is another thing now, and the result is not to depend on where it began
        samples = sampled(state, settings)
    variances = Variances()
    # what was determined by edges further away may no longer be
    first, more = _determined(linearised(state, samples, settings.ranges[-1], variances, settings), settings)
    reasons |= more
    run = _settled(first, samples, variances, settings, len(settings.ranges), settings.settling, progress)
    weighed, variances = _weighed(run.last, variances, settings)
    if weighed is not run.last:
        run = _settled(weighed, samples, variances, settings, run.iterations, 0, progress)
    assessment = assessed(run.last, variances, settings)
    return solution_of(Outcome(problem, run.last, assessment, variances, samples, reasons, run.iterations, run.converged, run.message), settings)


@dataclass(frozen=True, eq=False)
class _Run:
    """Where an iteration ended and why."""

    last: Linearisation
    iterations: int
    converged: bool
    message: str


def _approached(
    state: State, samples: Sequence[Samples], settings: AdjustmentSettings, progress: Callable[[str, int, int], None]
) -> tuple[State, dict[str, str], float]:
    """Return the state after one step with each search range, from fewer samples, what is not determined, which stays, and how far it went in px.

    Edges are matched anew each time. How far the last step goes is not looked at: it is a small one where there is more than one.
    """
    few = [one.thinned(THINNED) for one in samples]
    begin: Linearisation | None = None
    far = 0.0
    reasons: dict[str, str] = {}
    for number, reach in enumerate(settings.ranges):
        progress("adjusting", number, settings.iterations)
        linear = linearised(state, few, reach, Variances(), settings)
        if number == 0:
            linear, reasons = _determined(linear, settings)
        begin = begin or linear
        far = max(far, _moved(begin, linear))
        state = linear.state.moved(linear.unknowns, _limited(linear.equations.solve()))
    return state, reasons, far


def _settled(
    linear: Linearisation,
    samples: Sequence[Samples],
    variances: Variances,
    settings: AdjustmentSettings,
    done: int,
    settling: int,
    progress: Callable[[str, int, int], None],
) -> _Run:
    """Iterate until nothing moves.

    Edges are matched anew ``settling`` times, then they stay, so that the sum of squares is a smooth function, and a step that makes it
    larger is taken back and damped.
    """
    reach = linear.reach
    if not linear.unknowns.total:
        return _Run(linear, done, converged=True, message=NOTHING)
    kept = linear
    for number in range(settling):
        progress("adjusting", done + number, done + settings.iterations)
        state = kept.state.moved(kept.unknowns, _limited(kept.equations.solve()))
        kept = linearised(state, samples, reach, variances, settings)
    done += settling
    damping = 0.0
    for iteration in range(settings.iterations):
        progress("adjusting", done + iteration, done + settings.iterations)
        step = _limited(kept.equations.solve(damping))
        least = np.maximum(settings.step, UNDER_SIGMA / np.sqrt(kept.equations.matrix.diagonal()))
        still = bool((np.abs(step) < least).all())
        if still and damping <= LEAST_DAMPING:
            return _Run(kept, done + iteration + 1, converged=True, message=CONVERGED.format(settings.step))
        linear = linearised(kept.state.moved(kept.unknowns, step), samples, reach, variances, settings, kept.samples)
        gain = kept.cost - linear.cost
        if gain > -NO_GAIN:
            kept, damping = linear, damping * FASTER if damping > LEAST_DAMPING else 0.0
        else:
            damping = max(damping * SLOWER, FIRST_DAMPING)
        if still or (damping > LEAST_DAMPING and abs(gain) < NO_GAIN):
            return _Run(kept, done + iteration + 1, converged=True, message=STUCK)
    return _Run(kept, done + settings.iterations, converged=False, message=NOT_CONVERGED)


def _weighed(linear: Linearisation, variances: Variances, settings: AdjustmentSettings) -> tuple[Linearisation, Variances]:
    """Return the linearisation with the variances that go with its residuals, and contours left out that do not belong to the others.

    It says what the residuals would be with any of them: what moves by so little needs no other.
    """
    for _ in range(settings.variance_rounds):
        better = estimated(linear, variances, settings)
        weighted = linear.weighted(better, settings)
        gross = gross_contours(weighted, assessed(weighted, better, settings), settings)
        if near(better, variances) and variances.factor is not None and not gross.any():
            break
        left_out = gross if variances.left_out is None else gross | variances.left_out
        variances = replace(better, left_out=left_out)
        linear = linear.weighted(variances, settings)
    if variances.left_out is None or not variances.left_out.any():
        return linear, variances
    back = wrongly_left_out(assessed(linear, variances, settings), variances, settings)
    if not back.any():
        return linear, variances
    # once, so that none goes out and in for ever
    variances = replace(variances, left_out=variances.left_out & ~back)
    return linear.weighted(variances, settings), variances


def _moved(one: Linearisation, other: Linearisation) -> float:
    """Return by how much (px) contours moved across themselves between two linearisations of the same samples."""
    parts = zip(one.samples, other.samples, strict=True)
    across = [np.abs(dot(there.position - here.position, here.normal)) for here, there in parts]
    return max((float(np.nanmax(some, initial=0.0)) for some in across), default=0.0)


def _limited(step: Array) -> Array:
    """Return a step (u,) that moves nothing too far; what is not a number moves nothing."""
    largest = float(np.abs(step).max(initial=0.0))
    if not np.isfinite(largest):
        return np.zeros_like(step)
    return step * (LARGEST_STEP / max(largest, LARGEST_STEP))


def _determined(linear: Linearisation, settings: AdjustmentSettings) -> tuple[Linearisation, dict[str, str]]:
    """Return the linearisation in which only what is observed may move, and for each component's id what is not."""
    reasons: dict[str, str] = {}
    # what is held in one round may have been what held others
    for _ in range(len(linear.state.free) + 1):
        every = np.arange(len(linear.state.free))
        variance = np.einsum("cii->ci", covariance(linear.equations).blocks(linear.unknowns, every, every))
        # what is not a number is not known, either
        loose = ~(variance < settings.undetermined**2) & (np.arange(MOTION) < linear.unknowns.count[:, None])
        held: dict[int, frozenset[str]] = {}
        for row in np.flatnonzero(loose.any(axis=1)).tolist():
            names = {name for name, is_loose in zip(linear.unknowns.names[row], loose[row], strict=False) if is_loose}
            held[row] = linear.state.free[row] if names & {POSITION, DIRECTION} else frozenset(names)
            reasons[linear.state.problem.components[row].id] = REASON.format(" and ".join(name.replace("_", " ") for name in sorted(names)))
        if not held:
            break
        linear = linear.at(linear.state.without(frozenset(), held))
    return linear, reasons
