# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the conditions at the joints can hold together where the user fixed something."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, identity
from scipy.sparse.linalg import splu

from pipeworkbench.recon.adjustment.conditions import NOBODY, Conditions, Observed
from pipeworkbench.recon.adjustment.normal_equations import design
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.camera import Array

TOLERANCE_MM, TOLERANCE_RAD = 0.01, 2e-5  # what an exact condition may be off
LEVER = 1000.0  # mm; a direction's misclosure counts by what it is at this distance
GIVEN = 1e-6  # weight of where everything is, beside that of the conditions
STEPS, SLOW = 25, 0.7  # of the iteration; it has ended where a step leaves more of the misclosure than this


@dataclass(frozen=True, eq=False)
class Contradictions:
    """What cannot be fulfilled: numbers of joints, and for each component, by row, why it stays as it was."""

    joints: frozenset[int]
    reasons: dict[int, str]


def contradictions(state: State, settings: AdjustmentSettings) -> Contradictions:
    """Find joints that cannot be without offset and kink because of what is fixed or held.

    The conditions alone are adjusted, with everything else where it is: what is left over contradicts.
    """
    nothing = Contradictions(frozenset(), {})
    if not state.joints or (state.conditions.free.all() and not state.problem.held):
        return nothing
    conditions = state.conditions.without_alignment()
    here, rest = state, np.inf
    exact = _exact(conditions, here)
    for _ in range(STEPS):
        off = np.abs(exact.misclosure) / _tolerances(exact, settings)
        if not len(off) or off.max() <= 1 or off.max() > SLOW * rest:
            break
        rest = off.max()
        unknowns = here.unknowns()
        matrix = design(exact, unknowns)
        scale = np.where(exact.sigma == settings.turn_sigma, LEVER, 1.0)
        weighted = matrix.multiply(scale[:, None] ** 2).tocsc()
        normal = csc_matrix(matrix.T @ weighted + GIVEN * identity(unknowns.total))
        here = here.moved(unknowns, splu(normal).solve(weighted.T @ exact.misclosure) if unknowns.total else np.zeros(0))
        exact = _exact(conditions, here)
    broken = exact[np.abs(exact.misclosure) > _tolerances(exact, settings)]
    reasons: dict[int, str] = {}
    for what, bodies, misclosure in zip(broken.what, broken.bodies, broken.misclosure, strict=True):
        for body in bodies[bodies != NOBODY]:
            if state.free[body]:
                reasons.setdefault(int(body), f"{what} cannot be fulfilled together with what is fixed (off by {abs(misclosure):.3g})")
    return Contradictions(frozenset(broken.joint.tolist()), reasons)


def _exact(conditions: Conditions, state: State) -> Observed:
    observed = conditions.at(state.bodies)
    return observed[observed.exact]


def _tolerances(exact: Observed, settings: AdjustmentSettings) -> Array:
    return np.where(exact.sigma == settings.turn_sigma, TOLERANCE_RAD, TOLERANCE_MM)
