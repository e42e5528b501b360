# SPDX-License-Identifier: LGPL-2.1-or-later
"""What notches take away from surfaces of straight lines, cylinders and cones: closed paths in the plane of the developed sheet."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.insulation.flat import Path, fit_arcs, joined
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import AnyNotch, BlockNotch, Notch

ANGLES = 3600  # at which a notch is looked for around a cylinder: one narrower than 0.1 degrees may be missed
BISECTIONS = 48
Lines = Callable[[Array], tuple[Array, Array]]
Flat = Callable[[Array, Array], Array]

SHORTEST_WALL_MM = 1e-4  # what is shorter is no wall of an opening
PARALLEL = 1e-12  # squared sine of an angle below which two lines count as parallel
BAND = (-2 * np.pi, 6 * np.pi)
FARTHEST_MM = 1e7  # where an opening ends that never does


@dataclass(frozen=True, eq=False)
class Opening:
    """A closed path in the developed plane, and what needs the room.

    One that goes all ``around`` is a band over several turns; it has no path where the surface does not repeat itself straight on.
    ``net`` is what it takes of the net area where that is not the whole path: without play.
    """

    cause: str
    path: Path | None
    around: bool = False
    net: Path | None = None

    def moved(self, shift: tuple[float, float]) -> Opening:
        """Return it elsewhere in the plane (mm)."""
        path, net = (one.moved(0.0, shift) if one else None for one in (self.path, self.net))
        return replace(self, path=path, net=net)


def cylinder_openings(notches: Iterable[AnyNotch], radius: float) -> tuple[Opening, ...]:
    """Return what notches take away from a cylinder of ``radius`` (mm) about z, in the plane of radius × angle and z."""

    def lines(angles: Array) -> tuple[Array, Array]:
        origins = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), np.zeros(len(angles))])
        return origins, np.tile([0.0, 0.0, 1.0], (len(angles), 1))

    def flat(angles: Array, heights: Array) -> Array:
        return np.column_stack([radius * angles, heights])

    return notch_openings(notches, lines, flat, BAND)


def notch_openings(notches: Iterable[AnyNotch], lines: Lines, flat: Flat, band: tuple[float, float] | None = None) -> tuple[Opening, ...]:
    """Return what notches take away from a surface of straight lines.

    On each line a notch, which is convex, covers one interval: of a cylinder between the roots of a quadratic equation and the planes
    of its ends, of a block between its faces. The angles where there is one, and those where another of these bounds comes to
    hold, are found by bisection; in between the bounds are smooth.

    Parameters
    ----------
    notches : iterable of Notch and BlockNotch
        In the surface's own axes.
    lines : callable
        From angles (n,) to a point on each line (n, 3), mm, and its unit direction (n, 3).
    flat : callable
        From angles (n,) and lengths along the lines (n,), mm, to points of the developed surface (n, 2).
    band : (float, float)
        The angles (rad) between which an opening that goes all around is drawn; it gets no path without.
    """
    return tuple(opening for notch in notches for opening in _openings(notch, lines, flat, band))


@dataclass(frozen=True, eq=False)
class Interval:
    """Where a notch begins and ends along lines: ``lower`` and ``upper`` (n,) mm, where it is ``there`` (n,) at all.

    ``bounds`` (n,) tells what gives both. Of a cylinder: 0 its mantle, 1 and 2 the planes of its ends for the lower and the upper one;
    of a block: which pairs of faces.
    """

    lower: Array
    upper: Array
    there: NDArray[np.bool_]
    bounds: NDArray[np.intp]


def interval(notch: AnyNotch, origins: Array, directions: Array) -> Interval:
    """Return where a notch begins and ends along straight lines: points on them (n, 3), mm, and unit directions (n, 3)."""
    return _block_interval(notch, origins, directions) if isinstance(notch, BlockNotch) else _round_interval(notch, origins, directions)


def _block_interval(notch: BlockNotch, origins: Array, directions: Array) -> Interval:
    """Return where a block's three pairs of parallel faces all enclose a line."""
    axes = np.array([notch.frame.x, notch.frame.y, notch.frame.z])
    base, rise = (origins - notch.frame.origin) @ axes.T, directions @ axes.T
    leaning = rise**2 > PARALLEL
    safe = np.where(leaning, rise, 1.0)
    one, other = -base / safe, (notch.size - base) / safe
    lower = np.where(leaning, np.minimum(one, other), -FARTHEST_MM)
    upper = np.where(leaning, np.maximum(one, other), FARTHEST_MM)
    there = np.all(leaning | ((base > 0) & (base < notch.size)), axis=1)
    first, last = lower.argmax(axis=1), upper.argmin(axis=1)
    low, high = lower.max(axis=1), upper.min(axis=1)
    return Interval(low, high, there & (high > low), 3 * first + last)


def _round_interval(notch: Notch, origins: Array, directions: Array) -> Interval:
    start, end = notch.start, notch.end
    height = float(np.linalg.norm(end - start))
    axis = (end - start) / height
    base = origins - start
    along, rise = base @ axis, directions @ axis
    # |base + s direction - its part along the axis|² = radius², a quadratic of s with the sine squared as its first coefficient
    a = np.maximum(1 - rise**2, 0.0)
    b, c = np.sum(base * directions, axis=1) - along * rise, np.sum(base**2, axis=1) - along**2 - notch.radius**2
    crossing, leaning = a > PARALLEL, rise**2 > PARALLEL
    safe_a, safe_rise = np.where(crossing, a, 1.0), np.where(leaning, rise, 1.0)
    root = np.sqrt(np.maximum(b**2 - a * c, 0.0))
    round_lower = np.where(crossing, (-b - root) / safe_a, -FARTHEST_MM)
    round_upper = np.where(crossing, (-b + root) / safe_a, FARTHEST_MM)
    planes = np.sort(np.column_stack([-along, height - along]) / safe_rise[:, None], axis=1)
    planes = np.where(leaning[:, None], planes, [-FARTHEST_MM, FARTHEST_MM])
    there = np.where(crossing, b**2 > a * c, c < 0) & (leaning | ((along > 0) & (along < height)))
    lower, upper = np.maximum(round_lower, planes[:, 0]), np.minimum(round_upper, planes[:, 1])
    bounds = np.where(planes[:, 0] > round_lower, 1, 0) + np.where(planes[:, 1] < round_upper, 2, 0)
    return Interval(lower, upper, there & (upper > lower), bounds)


def _openings(notch: AnyNotch, lines: Lines, flat: Flat, band: tuple[float, float] | None) -> list[Opening]:
    """Return what one notch takes away."""

    def state(angles: Array) -> Array:
        found = interval(notch, *lines(angles))
        return np.where(found.there, 1 + found.bounds, 0)

    angles = np.arange(ANGLES) * 2 * np.pi / ANGLES
    there = state(angles) > 0
    if there.all():
        knots = None if band is None else _changes(state, np.linspace(*band, ANGLES))
        return [Opening(notch.cause, None if knots is None else _loop(notch, lines, flat, list(knots)), around=True)]
    if not there.any():
        return []
    # begin where there is nothing, so that no opening is parted by the full turn
    angles = np.roll(angles, -int(np.argmin(there)))
    angles = np.unwrap(np.append(angles, angles[0] + 2 * np.pi), period=2 * np.pi)
    knots = _changes(state, angles)
    inside = state((knots[:-1] + knots[1:]) / 2) > 0
    # from where something begins to where it ends
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
    return [Opening(notch.cause, _loop(notch, lines, flat, list(knots[a : b + 1]))) for a, b in edges.reshape(-1, 2)]


def _changes(state: Callable[[Array], Array], angles: Array) -> Array:
    """Return the angles between which a state does not change, the first and the last angle included."""
    states = state(angles)
    change = np.nonzero(states[1:] != states[:-1])[0]
    low, high, before = angles[change], angles[change + 1], states[change]
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        same = state(middle) == before
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.concatenate([angles[:1], (low + high) / 2, angles[-1:]])


def _loop(notch: AnyNotch, lines: Lines, flat: Flat, knots: list[float]) -> Path:
    """Return the closed path around an opening that reaches from the first to the last angle and has corners at those between."""

    def low(angles: Array) -> Array:
        return flat(angles, interval(notch, *lines(angles)).lower)

    def high(angles: Array) -> Array:
        return flat(angles, interval(notch, *lines(angles)).upper)

    there = [smooth(low, a, b) for a, b in itertools.pairwise(knots)]
    back = [smooth(high, b, a) for a, b in itertools.pairwise(knots)][::-1]
    return chain([*there, *back])


def smooth(curve: Callable[[Array], Array], start: float, end: float) -> Path:
    """Return arcs along a curve of an angle that may turn sharply at both ends: the angle goes with a cosine there."""
    return fit_arcs(lambda turn: curve(start + (end - start) * (1 - np.cos(turn)) / 2), 0.0, np.pi)


def chain(paths: list[Path]) -> Path:
    """Return one closed path through several: straight walls between those that do not meet, gaps of rounding closed."""
    pieces: list[Path] = []
    for k, path in enumerate(paths):
        before = paths[k - 1].points[-1]
        if np.hypot(*(path.points[0] - before)) > SHORTEST_WALL_MM:
            pieces.append(Path.line(before, path.points[0]))
            pieces.append(path)
        else:
            pieces.append(Path(np.vstack([before, path.points[1:]]), path.bulges, closed=False))
    return joined(*pieces).counter_clockwise()
