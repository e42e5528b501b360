# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fused components fitted together again: pipes end where their fittings begin, elbows sit where the axes of their pipes meet.

As in ``recon.fitting`` a pipe between two elbows runs from corner to corner, so that axes meet and joints are without a kink.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Joint, Pipe, Reducer, Tee, moved
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.ends import line_of
from pipeworkbench.recon.registration.pretransformation import from_two_axes
from pipeworkbench.recon.vectors import angle_between, as_vector, nearest_on_line, unit

LEAST_ANGLE = 0.05  # rad: straighter courses have no corner
SHORTEST_PIPE = 0.02  # diameters that must remain of a pipe
RUN_PORTS = 2  # a tee's third port, the branch's, does not place it
MOVED_MM = 30.0  # a corner further away than this from where the stations saw it is not the elbow's


def closed(components: Sequence[AnyComponent], joints: Sequence[Joint]) -> tuple[AnyComponent, ...]:
    """Return components whose joined ends coincide.

    Parameters
    ----------
    components : sequence of Component
    joints : sequence of Joint
        Between them; what the user fixed stays.
    """
    rows = {component.id: row for row, component in enumerate(components)}
    partner: dict[tuple[int, int], tuple[int, int]] = {}
    for joint in joints:
        a, b = (rows[joint.a], int(joint.a_port)), (rows[joint.b], int(joint.b_port))
        partner |= {a: b, b: a}
    corners = _corners(components, partner)
    components = [_on_pipes(components, row, partner) for row in range(len(components))]
    courses = {row: _course(row, pipe, partner, corners) for row, pipe in enumerate(components) if isinstance(pipe, Pipe) and not pipe.fixed}
    elbows = {row: _elbow(components[row], corner, [courses[partner[row, port][0]] for port in (0, 1)]) for row, corner in corners.items()}
    result = [elbows.get(row, component) for row, component in enumerate(components)]
    for row, course in courses.items():
        result[row] = _with_ends(result, row, course, partner)
    return tuple(result)


def _corners(components: Sequence[AnyComponent], partner: Mapping[tuple[int, int], tuple[int, int]]) -> dict[int, Array]:
    """Return where (3,) the axes of the pipes of elbows, by row, meet, mm."""
    found = {}
    for row, component in enumerate(components):
        if not isinstance(component, Elbow) or component.fixed:
            continue
        pipes = [components[partner[row, port][0]] for port in (0, 1) if (row, port) in partner]
        lines = [line_of(pipe) for pipe in pipes if isinstance(pipe, Pipe) and not pipe.fixed]
        if len(lines) < 2 or np.linalg.norm(np.cross(lines[0][1], lines[1][1])) < LEAST_ANGLE:
            continue
        corner = from_two_axes(lines[0], lines[1], 1.0)[0]
        if np.linalg.norm(corner - component.intersection) <= MOVED_MM:
            found[row] = corner
    return found


def _on_pipes(components: Sequence[AnyComponent], row: int, partner: Mapping[tuple[int, int], tuple[int, int]]) -> AnyComponent:
    """Return a tee, reducer or cap on the axis of its pipes: one station may have seen it, several the pipes that place it."""
    fitting = components[row]
    if not isinstance(fitting, Tee | Reducer | Cap) or fitting.fixed:
        return fitting
    offsets = []
    for port, end in enumerate(fitting.ports[:RUN_PORTS]):
        other = components[partner[row, port][0]] if (row, port) in partner else None
        if isinstance(other, Pipe):
            offsets.append(nearest_on_line(np.array(end.point), *line_of(other)) - end.point)
    if not offsets:
        return fitting
    shift = np.eye(4)
    shift[:3, 3] = np.mean(offsets, axis=0)
    return moved(fitting, shift.tolist())


def _course(row: int, pipe: Pipe, partner: Mapping[tuple[int, int], tuple[int, int]], corners: Mapping[int, Array]) -> Array:
    """Return the corners that a pipe's axis runs through, its own ends where there are none, (2, 3) mm."""
    own = (pipe.start, pipe.end)
    return np.array([corners.get(partner.get((row, port), (-1, 0))[0], own[port]) for port in (0, 1)], float)


def _with_ends(components: Sequence[AnyComponent], row: int, course: Array, partner: Mapping[tuple[int, int], tuple[int, int]]) -> AnyComponent:
    """Return a pipe along its course that ends where its fittings begin."""
    pipe = components[row]
    direction = unit(course[1] - course[0])
    ends = list(course)
    for port in (0, 1):
        other = partner.get((row, port))
        if other is not None and not isinstance(components[other[0]], Pipe):
            ends[port] = nearest_on_line(np.array(components[other[0]].ports[other[1]].point), course[0], direction)
    if not isinstance(pipe, Pipe) or (ends[1] - ends[0]) @ direction < SHORTEST_PIPE * pipe.outer_diameter:
        return pipe
    return pipe.with_ends(as_vector(ends[0]), as_vector(ends[1]))


def _elbow(elbow: AnyComponent, corner: Array, courses: Sequence[Array]) -> AnyComponent:
    """Return an elbow in a corner that touches the courses (2, 3) of its pipes."""
    if not isinstance(elbow, Elbow):
        return elbow
    # from the corner towards the farther end of each course
    legs = [unit(course[int(np.argmax(np.linalg.norm(course - corner, axis=1)))] - corner) for course in courses]
    angle = angle_between(-legs[0], legs[1])
    length = elbow.bend_radius * np.tan(angle / 2)
    return replace(
        elbow,
        start=as_vector(corner + length * legs[0]),
        end=as_vector(corner + length * legs[1]),
        intersection=as_vector(corner),
        angle_deg=round(float(np.degrees(angle)), 4),
    )
