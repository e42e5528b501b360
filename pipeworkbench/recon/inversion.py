# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inversion of plane mappings such as a lens's distortion: many points at once, on the branch of the axis.

A distortion polynomial that is strong enough folds back on itself, so that several points have the same
image. The one that the lens shows is connected to the optical axis without a fold in between: the search
starts from the inverse of the radial part, which is a table, and a solution behind a fold is none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PLAIN_ITERATIONS = 4  # of all points together, undamped: what a good start needs
NEWTON_ITERATIONS = 40
NEWTON_TOLERANCE = 1e-7  # of the coordinates, BEFORE the last step, which squares what is missing
SHORTER, LONGER = 0.25, 2.0  # factors on the next step where one fails to come nearer, where one does
SHORTEST = 1e-4  # of a Newton step: where even this does not come nearer, there is no solution
FOLD_SLACK = 1.02  # decentring moves the fold a little away from where the radial part alone has it
WITHIN_FOLD = 0.9  # of the way to the fold: the start for targets that lie beyond its image


@dataclass(frozen=True, eq=False)
class RadialInverse:
    """The inverse of an increasing function of the radius, up to its first fold, as a table.

    ``value`` (m,) are the function's values, ``ratio`` (m,) radius / value there; ``fold`` is the radius
    where the function stops increasing, infinite where it does not.
    """

    value: Array
    ratio: Array
    fold: float

    @classmethod
    def of(cls, radius: Array, value: Array) -> RadialInverse:
        """Tabulate the inverse of a function from samples (m,) that start at zero; NaN ends it."""
        with np.errstate(invalid="ignore", divide="ignore"):
            stops = np.flatnonzero(~(np.diff(value) > 0))
            last = int(stops[0]) if len(stops) else len(value) - 1
            fold = float(radius[last]) if len(stops) else np.inf
            ratio = radius[: last + 1] / value[: last + 1]
        ratio[0] = ratio[1] if last else 1.0  # 0 / 0: the factor is smooth there
        return cls(value[: last + 1], ratio, fold)

    def start(self, target: Array) -> Array:
        """Return points (n, 2) whose radial image is near the targets (n, 2)."""
        radius = length(target)
        reach = self.value[-1]
        with np.errstate(invalid="ignore", divide="ignore"):
            factor = np.interp(radius, self.value, self.ratio) * np.where(radius < reach, 1.0, WITHIN_FOLD * reach / radius)
            return target * factor[:, None]

    def beyond(self, points: Array) -> NDArray[np.bool_]:
        """Return which points (n, 2) lie behind the fold; NaN does not."""
        return length(points) > FOLD_SLACK * self.fold


def invert(function: Callable[[Array], tuple[Array, Array]], target: Array, start: Array) -> Array:
    """Solve function(x) = target (n, 2) for all rows by Newton's method, with damped steps where plain ones do not lead there.

    Parameters
    ----------
    function : callable
        Gives values (m, 2) and derivatives (m, 2, 2) of points (m, 2), row by row.
    target, start : (n, 2) array
        What to reach and where to start; rows that are not finite have no solution.

    Returns
    -------
    (n, 2) array
        The solutions; NaN where there is none or where the mapping turns the image over.
    """
    with np.errstate(all="ignore"):
        size = length(target)
        tolerance = NEWTON_TOLERANCE * np.maximum(size, 1.0)
        position = start
        for _ in range(PLAIN_ITERATIONS):
            value, derivative = function(position)
            missing = target - value
            distance = length(missing)
            position = position + solve_2x2(derivative, missing)
            if not (distance > tolerance).any():
                break
        solved = (distance <= tolerance) & (determinant(derivative) > 0)
    if solved.all():
        return position
    position[~solved] = np.nan
    rows = np.flatnonzero(~solved & np.isfinite(size))
    if len(rows):
        position[rows] = _invert_damped(function, target[rows], start[rows], tolerance[rows])
    return position


def _invert_damped(function: Callable[[Array], tuple[Array, Array]], goal: Array, position: Array, tolerance: Array) -> Array:
    """Return the solutions (n, 2) of :func:`invert` by steps that are shortened until they come nearer the goal (n, 2)."""
    solution = np.full_like(goal, np.nan)
    rows = np.arange(len(goal))
    damping = np.ones(len(rows))
    with np.errstate(all="ignore"):
        value, derivative = function(position)
        missing = goal - value
        distance = length(missing)
        for _ in range(NEWTON_ITERATIONS):
            step = solve_2x2(derivative, missing)
            reached = distance <= tolerance
            done = reached | (damping < SHORTEST)
            if done.any():
                valid = reached & (determinant(derivative) > 0)
                solution[rows[valid]] = position[valid] + step[valid]
                if done.all():
                    break
                rows, goal, tolerance, damping = rows[~done], goal[~done], tolerance[~done], damping[~done]
                position, step, missing = position[~done], step[~done], missing[~done]
                distance, derivative = distance[~done], derivative[~done]
            moved = position + damping[:, None] * step
            value, slope = function(moved)
            left = goal - value
            remaining = length(left)
            worse = ~(remaining < distance)
            if worse.any():
                moved[worse], left[worse], remaining[worse], slope[worse] = position[worse], missing[worse], distance[worse], derivative[worse]
            damping = np.minimum(1.0, damping * np.where(worse, SHORTER, LONGER))
            position, missing, distance, derivative = moved, left, remaining, slope
    return solution


def by_columns(count: int) -> tuple[Array, Array]:
    """Return empty vectors (n, 2) and matrices (n, 2, 2) that have each component in one piece: what is computed by component is faster so."""
    return np.empty((2, count)).T, np.empty((2, 2, count)).transpose(2, 0, 1)


def length(vectors: Array) -> Array:
    """Return the lengths (n,) of vectors (n, 2); several times faster than NumPy's general norm."""
    with np.errstate(over="ignore"):
        return np.sqrt(vectors[:, 0] ** 2 + vectors[:, 1] ** 2)


def determinant(matrices: Array) -> Array:
    """Return the determinants (n,) of matrices (n, 2, 2)."""
    return matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] * matrices[:, 1, 0]


def solve_2x2(matrices: Array, right: Array) -> Array:
    """Solve matrices (n, 2, 2) times x = right (n, 2) by Cramer's rule; not finite where singular."""
    solution = np.empty_like(right)
    solution[:, 0] = matrices[:, 1, 1] * right[:, 0] - matrices[:, 0, 1] * right[:, 1]
    solution[:, 1] = matrices[:, 0, 0] * right[:, 1] - matrices[:, 1, 0] * right[:, 0]
    solution /= determinant(matrices)[:, None]
    return solution


def inverse_2x2(matrices: Array) -> Array:
    """Return the inverses of matrices (n, 2, 2); not finite where singular."""
    inverse = np.empty_like(matrices)
    inverse[:, 0, 0], inverse[:, 1, 1] = matrices[:, 1, 1], matrices[:, 0, 0]
    inverse[:, 0, 1], inverse[:, 1, 0] = -matrices[:, 0, 1], -matrices[:, 1, 0]
    inverse /= determinant(matrices)[:, None, None]
    return inverse
