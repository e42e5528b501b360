# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pseudo-observations: continuity at the joints (Sect. 7.2), standard sizes, what is level, plumb or square.

Each is a row of the observation equations: what is observed minus what the components say, and how that changes
with their motions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Joint, Pipe, Reducer, Tee
from pipeworkbench.recon.adjustment.charts import MOTION, RIGID, SIZE_NAMES, port_of, unit_of
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import as_vector, axes_across, cross, unit

SAME_DIAMETER = 0.02  # relative; what differs by more is a change of diameter, not an error
TOLERANCE_SIGMAS = 2.0  # a tolerance holds for 95 %
FREE_SIGMA = 1e4  # mm or rad; keeps sizes that nothing observes from being undetermined in the numbers alone
LEAST_PLACE_SIGMA = 0.05  # mm
UP = np.array([0.0, 0.0, 1.0])
RIGHT_ANGLE = np.pi / 2
STANDARD_ANGLES = np.radians((45.0, 90.0))
STANDARD_ANGLE_WITHIN = np.radians(3.0)


@dataclass(frozen=True, eq=False)
class Row:
    """One pseudo-observation: ``what`` in words, the parts (component's row, derivatives (9,)), misclosure and sigma.

    ``joint`` is the number of the joint it belongs to, None for others; ``exact`` tells a condition from a soft one.
    """

    what: str
    parts: tuple[tuple[int, Array], ...]
    misclosure: float
    sigma: float
    joint: int | None = None
    exact: bool = False


def rows_of(
    problem: Problem, components: Sequence[AnyComponent], free: Mapping[int, frozenset[str]], joints: Sequence[int], settings: AdjustmentSettings
) -> list[Row]:
    """Return all pseudo-observations of the components as they are now; ``free`` names the sizes that are unknowns, ``joints`` those that count."""
    number = {component.id: row for row, component in enumerate(components)}
    rows = [row for joint in joints for row in _of_joint(components, number, free, problem.joints[joint], joint, settings)]
    rows += _of_sizes(problem, components, free, settings)
    rows += _of_places(problem, components)
    if settings.aligned:
        rows += _of_directions(components, settings)
    return rows


def _of_joint(
    components: Sequence[AnyComponent],
    number: Mapping[str, int],
    free: Mapping[int, frozenset[str]],
    joint: Joint,
    index: int,
    settings: AdjustmentSettings,
) -> Iterator[Row]:
    """Yield the conditions of a joint: no offset across a pipe's axis, or none at all; the same direction; the same radius."""
    rows = number[joint.a], number[joint.b]
    one, other = components[rows[0]], components[rows[1]]
    a, b = port_of(one, joint.a_port), port_of(other, joint.b_port)
    name = f"{joint.a} - {joint.b}"
    # a pipe may end anywhere along its axis, but one that is fixed ends where it ends
    slides = any(isinstance(components[row], Pipe) and row in free for row in rows)
    turning = 0 if isinstance(one, Pipe) else 1
    axis = (a, b)[turning].direction
    ways = np.array([*axes_across(axis), axis])
    faces = isinstance(one, Flange) and isinstance(other, Flange) and joint.a_port == joint.b_port == 0
    apart = b.point - a.point
    # w = S2 - E1 (Eq. 14) along ways that turn with one of both
    off, derivatives = ways @ apart, [-ways @ a.by_motion[:3], ways @ b.by_motion[:3]]
    derivatives[turning][:, 3:RIGID] += np.cross(ways, apart)
    for way in range(2 if faces or slides else 3):
        parts = ((rows[0], derivatives[0][way]), (rows[1], derivatives[1][way]))
        yield Row(f"{name}: offset", parts, -float(off[way]), settings.offset_sigma, index, exact=True)
    turn, by_one, by_other = ways @ (a.direction + b.direction), ways @ a.by_motion[3:6], ways @ b.by_motion[3:6]
    for way in range(2):
        yield Row(f"{name}: direction", ((rows[0], by_one[way]), (rows[1], by_other[way])), -float(turn[way]), settings.turn_sigma, index, exact=True)
    if faces:
        out = a.direction
        by_one = -out @ a.by_motion[:3]
        by_one[3:RIGID] += cross(out, apart)
        parts = ((rows[0], by_one), (rows[1], out @ b.by_motion[:3]))
        yield Row(f"{name}: gasket", parts, settings.gasket - float(apart @ out), settings.gasket_sigma, index)
    elif abs(a.radius - b.radius) <= SAME_DIAMETER * max(a.radius, b.radius):
        parts = ((rows[0], a.by_motion[6]), (rows[1], -b.by_motion[6]))
        yield Row(f"{name}: diameter", parts, b.radius - a.radius, settings.offset_sigma, index, exact=True)


def _of_sizes(
    problem: Problem, components: Sequence[AnyComponent], free: Mapping[int, frozenset[str]], settings: AdjustmentSettings
) -> Iterator[Row]:
    """Yield the pseudo-observations of sizes that are unknowns."""
    start = {component.id: component for component in problem.components}
    for row, names in free.items():
        component = components[row]
        given = problem.observed.get(component.id, {})
        for column, name in enumerate(SIZE_NAMES[type(component)], RIGID):
            if name not in names:
                continue
            factor = 1 / unit_of(name)
            nominal = float(getattr(start[component.id], name))
            sigma = FREE_SIGMA
            if name in given:
                nominal, sigma = given[name]
            elif (known := _tolerance(start[component.id], name, settings)) is not None:
                nominal, sigma = known
            derivative = np.zeros(MOTION)
            derivative[column] = 1.0
            yield Row(f"{component.id}: {name}", ((row, derivative),), factor * (nominal - float(getattr(component, name))), factor * sigma)


def _tolerance(component: AnyComponent, name: str, settings: AdjustmentSettings) -> tuple[float, float] | None:
    """Return a standard size and its standard deviation, in the field's own unit; None where it is no standard's."""
    if name == "angle_deg" and isinstance(component, Elbow):
        angle = np.radians(component.angle_deg)
        nearest = float(STANDARD_ANGLES[np.argmin(np.abs(STANDARD_ANGLES - angle))])
        if component.bend_type is None or abs(nearest - angle) > STANDARD_ANGLE_WITHIN or settings.sizes == "free":
            return None
        return float(np.degrees(nearest)), settings.angle_sigma_deg
    if settings.sizes == "free" or not has_standard_size(component, name):
        return None
    nominal = float(getattr(component, name))
    if name == "bend_radius":
        return nominal, settings.bend_tolerance * nominal / TOLERANCE_SIGMAS
    if name in ("D", "C"):
        return nominal, settings.plate_tolerance / TOLERANCE_SIGMAS
    part, least = settings.diameter_tolerance
    return nominal, max(part * nominal, least) / TOLERANCE_SIGMAS


def has_standard_size(component: AnyComponent, name: str) -> bool:
    """Tell whether a size is a standard's; then nothing but its tolerance is unknown."""
    match component:
        case Elbow() if name == "bend_radius":
            return component.bend_type is not None
        case Elbow() if name == "angle_deg":
            return False
        case Flange():
            return True
        case Elbow():
            return component.dn is not None
        case Pipe() | Tee() | Reducer() | Cap():
            return component.dn is not None or component.standard is not None


def _of_places(problem: Problem, components: Sequence[AnyComponent]) -> Iterator[Row]:
    """Yield the pseudo-observations of where pipes were: both parts of position and direction across the axis."""
    for row, (component, given) in enumerate(zip(components, problem.components, strict=True)):
        if given.id not in problem.placed or not isinstance(given, Pipe) or not isinstance(component, Pipe) or given.sigma_position is None:
            continue
        middle = (np.array(given.start) + np.array(given.end)) / 2
        axis = unit(np.subtract(given.end, given.start))
        across = np.array(axes_across(axis))
        # independent directions of the covariance across the axis
        variances, turn = np.linalg.eigh(across @ np.diag(np.square(given.sigma_position)) @ across.T)
        here, reference = unit(np.subtract(component.end, component.start)), (np.array(component.start) + np.array(component.end)) / 2
        # the axis' point that was the middle
        beside = reference + ((middle - reference) @ here) * here
        for way, variance in zip(turn.T @ across, variances, strict=True):
            derivative = np.zeros(MOTION)
            derivative[:3] = way
            derivative[3:RIGID] = cross(beside - reference, way)
            yield Row(f"{given.id}: place", ((row, derivative),), float((middle - beside) @ way), max(float(np.sqrt(variance)), LEAST_PLACE_SIGMA))
        if given.sigma_direction_deg:
            for way in across:
                yield Row(f"{given.id}: direction", ((row, _turning(way, here)),), -float(here @ way), float(np.radians(given.sigma_direction_deg)))


def _of_directions(components: Sequence[AnyComponent], settings: AdjustmentSettings) -> Iterator[Row]:
    """Yield weak pseudo-observations of runs that are nearly level or plumb and of bends that are nearly square."""
    within, sigma = np.radians(settings.aligned_within_deg), np.radians(settings.aligned_sigma_deg)
    for row, component in enumerate(components):
        if isinstance(component, Pipe):
            direction = unit(np.subtract(component.end, component.start))
            height = float(direction @ UP)
            if abs(height) < np.sin(within):
                yield Row(f"{component.id}: level", ((row, _turning(UP, direction)),), -height, sigma)
            elif abs(height) > np.cos(within):
                for way in axes_across(UP):
                    yield Row(f"{component.id}: plumb", ((row, _turning(way, direction)),), -float(direction @ way), sigma)
        elif isinstance(component, Elbow) and abs(np.radians(component.angle_deg) - RIGHT_ANGLE) < within:
            derivative = np.zeros(MOTION)
            derivative[RIGID + SIZE_NAMES[Elbow].index("angle_deg")] = 1.0
            yield Row(f"{component.id}: square", ((row, derivative),), RIGHT_ANGLE - float(np.radians(component.angle_deg)), sigma)


def _turning(way: Array, direction: Array) -> Array:
    """Return how the part of a direction along a way (3,) changes with the motion: way (w x d) = w (d x way)."""
    derivative = np.zeros(MOTION)
    derivative[3:6] = cross(direction, way)
    return derivative


def with_pipe_ends(components: Sequence[AnyComponent], joints: Sequence[Joint], kept: frozenset[int], *, exact: bool = False) -> list[AnyComponent]:
    """Return the components with pipes that end where what is joined to them begins.

    Parameters
    ----------
    components : sequence of Component
    joints : sequence of Joint
    kept : frozenset of int
        Rows of pipes that stay as they are.
    exact : bool
        Put the ends where their neighbours' ports are, else on the pipe's axis beside them.
    """
    number = {component.id: row for row, component in enumerate(components)}
    ends: dict[int, dict[int, Array]] = {}
    for joint in joints:
        for (name, port), (other, other_port) in (
            ((joint.a, joint.a_port), (joint.b, joint.b_port)),
            ((joint.b, joint.b_port), (joint.a, joint.a_port)),
        ):
            row, neighbour = number[name], components[number[other]]
            if not isinstance(components[row], Pipe) or row in kept:
                continue
            point = np.array(neighbour.ports[other_port].point)
            if isinstance(neighbour, Pipe) and number[other] not in kept:
                point = (point + np.array(components[row].ports[port].point)) / 2
            ends.setdefault(row, {})[port] = point
    result = list(components)
    for row, points in ends.items():
        pipe = components[row]
        assert isinstance(pipe, Pipe)  # noqa: S101  # only pipes were collected
        result[row] = _between(pipe, points, exact=exact)
    return result


def _between(pipe: Pipe, points: Mapping[int, Array], *, exact: bool) -> Pipe:
    start, axis = np.array(pipe.start), unit(np.subtract(pipe.end, pipe.start))
    ends: list[Array] = []
    for port, own in enumerate((pipe.start, pipe.end)):
        point = points.get(port)
        if point is None:
            ends.append(np.array(own))
        else:
            ends.append(point if exact else start + ((point - start) @ axis) * axis)
    if (ends[1] - ends[0]) @ axis <= 0:  # its neighbours have changed places: that is nothing to follow
        return pipe
    return pipe.with_ends(as_vector(ends[0]), as_vector(ends[1]))
