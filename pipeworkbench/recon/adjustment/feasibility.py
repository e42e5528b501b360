# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the conditions at the joints can hold together where the user fixed something."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_matrix, identity
from scipy.sparse.linalg import splu

from pipeworkbench.recon.adjustment.conditions import Row, rows_of
from pipeworkbench.recon.adjustment.normal_equations import pseudo_rows
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.state import State

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
    fixed = {component.id for component, names in zip(state.components, state.free, strict=True) if not names} | set(state.problem.held)
    if not fixed or not state.joints:
        return nothing
    sizes = {row: names for row, names in enumerate(state.free) if names}
    here, rest = state, np.inf
    rows: list[Row] = []
    for _ in range(STEPS):
        rows = [row for row in rows_of(state.problem, here.components, sizes, here.joints, replace(settings, aligned=False)) if row.exact]
        off = np.array([abs(row.misclosure) / _tolerance(row, settings) for row in rows])
        if not len(off) or off.max() <= 1 or off.max() > SLOW * rest:
            break
        rest = off.max()
        unknowns = here.unknowns()
        matrix, _, misclosure = pseudo_rows(rows, unknowns)
        scale = np.array([LEVER if row.sigma == settings.turn_sigma else 1.0 for row in rows])
        weighted = matrix.multiply(scale[:, None] ** 2).tocsc()
        normal = csc_matrix(matrix.T @ weighted + GIVEN * identity(unknowns.total))
        here = here.moved(unknowns, splu(normal).solve(weighted.T @ misclosure) if unknowns.total else np.zeros(0))
    broken = [row for row in rows if abs(row.misclosure) > _tolerance(row, settings)]
    if not broken:
        return nothing
    reasons: dict[int, str] = {}
    for row in broken:
        for component, _ in row.parts:
            if state.free[component]:
                reasons.setdefault(component, f"{row.what} cannot be fulfilled together with what is fixed (off by {abs(row.misclosure):.3g})")
    return Contradictions(frozenset(row.joint for row in broken if row.joint is not None), reasons)


def _tolerance(row: Row, settings: AdjustmentSettings) -> float:
    return TOLERANCE_RAD if row.sigma == settings.turn_sigma else TOLERANCE_MM
