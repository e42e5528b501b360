# SPDX-License-Identifier: LGPL-2.1-or-later
"""One axis from several stations' axes, one anchor from several anchors, and from where to where a pipe reaches."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.settings import FusionSettings
from pipeworkbench.recon.vectors import unit

ALIKE_MM = 60.0  # ends that are joined are the same end if they are no further apart
ROBUST = 3.0  # standard deviations beyond which a member of an axis counts less
ROBUST_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class FusedAxis:
    """A straight axis: point (3,) mm, direction (3,) unit, covariances (3, 3) of both, mm^2 and rad^2."""

    point: Array
    direction: Array
    position: Array
    tilt: Array


def fused_axis(marks: Landmarks, rows: NDArray[np.intp], middle: float | None = None) -> FusedAxis:
    """Return the axis that fits axes ``rows`` best, each weighted with its inverse covariance.

    Unknowns are two shifts at a point of the axis and two tilts; an axis observes both, its shift at its own middle.

    Parameters
    ----------
    marks : Landmarks
    rows : (k,) array
    middle : float, optional
        Where on the first axis, in mm from its middle, the point lies; default: where the members' middles lie on average.
    """
    longest = rows[np.argmax(marks.half[rows])]
    axis = marks.axis[longest]
    signs = np.where(marks.axis[rows] @ axis < 0, -1.0, 1.0)
    offsets = marks.point[rows] - marks.point[longest]
    along = offsets @ axis
    place = float(np.average(along, weights=marks.half[rows])) if middle is None else middle
    across = np.stack(perpendicular_axes(axis))
    levers = along - place
    shifts, tilts = offsets @ across.T, (signs[:, None] * marks.axis[rows]) @ across.T
    position, direction = (np.linalg.inv(across @ covariance @ across.T) for covariance in (marks.position[rows], marks.direction[rows]))
    design = np.concatenate([np.broadcast_to(np.eye(2), (len(rows), 2, 2)), levers[:, None, None] * np.eye(2)], axis=2)
    only_tilt = np.concatenate([np.zeros((2, 2)), np.eye(2)], axis=1)
    weights, solution, covariance = np.ones(len(rows)), np.zeros(4), np.eye(4)
    for _ in range(ROBUST_ROUNDS):
        normal = (
            np.einsum("kci,kcd,kdj,k->ij", design, position, design, weights) + only_tilt.T @ np.einsum("kcd,k->cd", direction, weights) @ only_tilt
        )
        right = np.einsum("kci,kcd,kd,k->i", design, position, shifts, weights) + only_tilt.T @ np.einsum("kcd,kd,k->c", direction, tilts, weights)
        covariance = np.linalg.inv(normal)
        solution = covariance @ right
        off = shifts - design @ solution
        distance = np.sqrt(np.einsum("kc,kcd,kd->k", off, position, off) / 2)
        weights = np.minimum(1.0, ROBUST / np.maximum(distance, 1e-9)) ** 2
    return FusedAxis(
        marks.point[longest] + place * axis + solution[:2] @ across,
        unit(axis + solution[2:] @ across),
        across.T @ covariance[:2, :2] @ across,
        across.T @ covariance[2:, 2:] @ across,
    )


def fused_point(marks: Landmarks, rows: NDArray[np.intp]) -> tuple[Array, Array]:
    """Return the mean (3,), mm, of anchors weighted with their inverse covariances, and its covariance (3, 3)."""
    information = np.linalg.inv(marks.position[rows])
    covariance = np.linalg.inv(information.sum(0))
    return covariance @ np.einsum("kij,kj->i", information, marks.point[rows]), covariance


@dataclass(frozen=True, eq=False)
class Reach:
    """A part of an axis that is one pipe: ``low`` and ``high`` mm along it; rows of the members that lie in it."""

    low: float
    high: float
    rows: NDArray[np.intp]


def reaches(marks: Landmarks, rows: NDArray[np.intp], station: NDArray[np.intp], axis: FusedAxis, settings: FusionSettings) -> list[Reach]:
    """Return from where to where pipes reach along the axis they share.

    An axis is cut where one station saw two pipes with something joined between them, and where no station saw a pipe over
    more than a small gap. A joined end is where it is; an end that is not joined was perhaps just not seen further.
    """
    signs = np.where(marks.axis[rows] @ axis.direction < 0, -1.0, 1.0)
    middle = (marks.point[rows] - axis.point) @ axis.direction
    low, high = middle - marks.half[rows], middle + marks.half[rows]
    held = np.where(signs[:, None] < 0, marks.held[rows][:, ::-1], marks.held[rows])
    gap = min(settings.gap * float(marks.sizes[rows[0], 0]), settings.gap_mm)
    breaks = _merged([*_own_breaks(low, high, held, station[rows]), *_uncovered(low, high, held, gap)])
    bounds = [-np.inf, *(value for one in breaks for value in one), np.inf]
    found = []
    for first, last in zip(bounds[::2], bounds[1::2], strict=True):
        shared = np.minimum(high, last) - np.maximum(low, first)
        inside = shared > 0
        if inside.any():
            starts = _end(low[inside], held[inside, 0], first, -1)
            stops = _end(high[inside], held[inside, 1], last, 1)
            # a member that only touches the part with its noise belongs to the next one
            mostly = inside & ((shared > gap / 2) | (shared > 0.5 * (high - low)))
            if stops > starts and mostly.any():
                found.append(Reach(starts, stops, rows[mostly]))
    return found


def _own_breaks(low: Array, high: Array, held: NDArray[np.bool_], station: NDArray[np.intp]) -> list[tuple[float, float]]:
    """Return what lies between two pipes that one station saw in line and joined to something there."""
    found = []
    for name in np.unique(station):
        own = np.flatnonzero(station == name)
        own = own[np.argsort(low[own])]
        for before, after in itertools.pairwise(own):
            if held[before, 1] or held[after, 0]:
                found.append((min(high[before], low[after]), max(high[before], low[after])))
    return found


def _uncovered(low: Array, high: Array, held: NDArray[np.bool_], gap: float) -> list[tuple[float, float]]:
    """Return what no pipe covers, where it is wide or an end beside it is joined."""
    found, order = [], np.argsort(low)
    reach, reaching = high[order[0]], order[0]
    for row in order[1:]:
        if low[row] > reach and (low[row] - reach > gap or held[reaching, 1] or held[row, 0]):
            found.append((float(reach), float(low[row])))
        if high[row] > reach:
            reach, reaching = high[row], row
    return found


def _merged(intervals: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return intervals in order, those that overlap or nearly touch as one."""
    found: list[tuple[float, float]] = []
    for low, high in sorted(intervals):
        if found and low <= found[-1][1] + ALIKE_MM:
            # the same fitting, seen by two stations: what lies between the pipes in the middle of both
            begin = max(found[-1][0], low)
            found[-1] = (begin, max(min(found[-1][1], high), begin))
        else:
            found.append((low, high))
    return found


def _end(ends: Array, held: NDArray[np.bool_], bound: float, side: int) -> float:
    """Return where a pipe ends: at the mean of joined ends that are near the farthest, else at the farthest, within its bound."""
    limited = np.minimum(ends, bound) if side > 0 else np.maximum(ends, bound)
    farthest = float((side * limited).max()) * side
    joined = held & (np.abs(limited - farthest) <= ALIKE_MM)
    return float(limited[joined].mean()) if joined.any() else farthest
