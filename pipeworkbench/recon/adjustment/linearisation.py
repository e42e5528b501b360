# SPDX-License-Identifier: LGPL-2.1-or-later
"""One linearisation of everything that is observed, at the state where the iteration stands."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.adjustment.charts import MOTION
from pipeworkbench.recon.adjustment.conditions import Observed
from pipeworkbench.recon.adjustment.normal_equations import NormalEquations, Unknowns, normal_equations
from pipeworkbench.recon.adjustment.observations import FAR, Groups, Reduced, SampleRows, joined, matched_edges, observe, reduced
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.sampling import Samples, samples_of
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.shapes import shapes_of_bodies
from pipeworkbench.recon.threads import thread_count
from pipeworkbench.recon.views import View

WORKERS = 2  # images at a time; more wait for each other's interpreter lock
CERTAIN = 1e12  # 1 / px^2; the precision of an error that is not there


@dataclass(frozen=True, eq=False)
class Variances:
    """Factors of the expected variances of contours' common errors and trends, and factors (g,) by which single contours count less.

    The latter are those of Student's t: a contour drawn to another edge has a large common error. ``left_out`` (g,) are gross errors.
    """

    common: float = 1.0
    trend: float = 1.0
    factor: Array | None = None
    left_out: NDArray[np.bool_] | None = None

    def of(self, groups: Groups, settings: AdjustmentSettings) -> Array:
        """Return the variances (g, 3), px^2, of the systematic errors of all contours."""
        factors = np.where(groups.circle[:, None], self.common, np.array([self.common, self.trend, self.trend]))
        return np.asarray(groups.systematic_variance(settings) * factors)

    def precision(self, groups: Groups, settings: AdjustmentSettings) -> Array:
        """Return the precisions (g, 3), 1 / px^2, that these errors count with."""
        factor = np.ones(len(groups)) if self.factor is None else self.factor
        return np.asarray(factor[:, None] / np.maximum(self.of(groups, settings), 1 / CERTAIN))


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Everything observed at a state: contours with their systems, pseudo-observations, and the normal equations of both.

    In ``groups`` those that are left out count for nothing; in ``complete`` they have what they would count for.
    """

    state: State
    groups: Groups
    complete: Groups
    systems: Reduced
    samples: tuple[SampleRows, ...]
    observed: Observed
    unknowns: Unknowns
    equations: NormalEquations
    reach: float

    @property
    def cost(self) -> float:
        """What the iteration makes least: weighted squares, with what an edge costs that is not found."""
        return float(self.systems.normal[:, MOTION, MOTION].sum() + FAR**2 * self.groups.missing.sum() + self.observed.squares.sum())

    def at(self, state: State) -> Linearisation:
        """Return the same observations for a state in which other parameters are unknowns."""
        observed, unknowns = state.conditions.at(state.bodies), state.unknowns()
        equations = normal_equations(self.groups, self.systems, observed, unknowns)
        return replace(self, state=state, observed=observed, unknowns=unknowns, equations=equations)

    def weighted(self, variances: Variances, settings: AdjustmentSettings) -> Linearisation:
        """Return the same observations with other variances of the contours' systematic errors, and others left out."""
        groups = _counted(self.complete, variances)
        systems = reduced(groups, variances.precision(groups, settings))
        equations = normal_equations(groups, systems, self.observed, self.unknowns)
        return replace(self, groups=groups, systems=systems, equations=equations)

    def squares(self, step: Array) -> Array:
        """Return the weighted squares (g,) of the contours' residuals after a step (u,), common errors eliminated."""
        rest = np.concatenate([-self.contour_motions(step), np.ones((len(self.groups), 1))], axis=1)
        return np.asarray(np.einsum("gi,gij,gj->g", rest, self.systems.normal, rest))

    def contour_motions(self, step: Array) -> Array:
        """Return how contours' components seem to move (g, 9) with a step (u,), their cameras' own movement included."""
        motions = self.unknowns.motions(step)[self.groups.owner]
        for number, frame in enumerate(self.unknowns.frames):
            mine = frame.of(self.groups.view)
            start = self.unknowns.frame_start[number]
            transform = self.unknowns.frame_motions(frame, self.groups.owner[mine])
            motions[mine, :6] += np.einsum("gij,j->gi", transform, step[start : start + 6])
        return motions

    def systematic(self, step: Array, solver: Array) -> Array:
        """Return the systematic errors (g, 3) of the contours in px, after a step (u,), by their systems' solver (g, 3, 10)."""
        motions = self.contour_motions(step)
        return np.asarray(solver[:, :, MOTION] - np.einsum("gij,gj->gi", solver[:, :, :MOTION], motions))


def sampled(state: State, settings: AdjustmentSettings) -> tuple[Samples, ...]:
    """Return the samples of all images at a state."""
    shapes = shapes_of_bodies(state.bodies)
    with ThreadPoolExecutor(thread_count(WORKERS)) as pool:
        return tuple(pool.map(lambda camera: samples_of(camera, state.bodies, shapes, settings), state.cameras))


def image_distances(state: State, samples: Sequence[Samples], reach: float, settings: AdjustmentSettings) -> Array:
    """Return the distances in px of the samples of all images to their edges, NaN where there is none in reach."""
    shapes = shapes_of_bodies(state.bodies)

    def one(view: View, camera: Camera, some: Samples) -> Array:
        seen = some.seen_by(camera, shapes)
        return matched_edges(view, seen.position, seen.normal, some, reach, settings).distance

    with ThreadPoolExecutor(thread_count(WORKERS)) as pool:
        return np.concatenate([np.zeros(0), *pool.map(one, state.views, state.cameras, samples)])


def linearised(
    state: State,
    samples: Sequence[Samples],
    reach: float,
    variances: Variances,
    settings: AdjustmentSettings,
    matched: Sequence[SampleRows] | None = None,
) -> Linearisation:
    """Observe everything at a state; ``reach`` is the search range in px. What is ``matched`` already stays so."""
    shapes = shapes_of_bodies(state.bodies)

    def one(number: int) -> tuple[Groups, SampleRows]:
        known = matched[number] if matched else None
        return observe(state.views[number], state.cameras[number], number, samples[number], shapes, state.bodies, reach, settings, known)

    with ThreadPoolExecutor(thread_count(WORKERS)) as pool:
        parts = list(pool.map(one, range(len(state.views))))
    complete = joined([part for part, _ in parts])
    groups = _counted(complete, variances)
    systems = reduced(groups, variances.precision(groups, settings))
    observed, unknowns = state.conditions.at(state.bodies), state.unknowns()
    equations = normal_equations(groups, systems, observed, unknowns)
    return Linearisation(state, groups, complete, systems, tuple(rows for _, rows in parts), observed, unknowns, equations, reach)


def _counted(groups: Groups, variances: Variances) -> Groups:
    """Return groups of which those that are left out count for nothing."""
    return groups if variances.left_out is None else groups.without(variances.left_out)
