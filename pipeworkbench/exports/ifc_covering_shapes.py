# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies of planned coverings for IFC, in the covering's own axes: one item or more for each layer and for the jacket.

What can be swept is. Gores are cylinders cut off by the planes of their joints; the elbow itself is taken from the first layer of
them. Tees are booleans as the tees of the pipework are, and notches are cut from every item.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from pipeworkbench.exports.ifc_shapes import ALONG_Y, OVER_MM, SOLID, SWEPT, TAPERED, Shapes
from pipeworkbench.pipeline import Vector
from pipeworkbench.recon.vectors import across
from pipeworkbench.solids.coverings import (
    AnyCovering,
    AnyNotch,
    BendCovering,
    BlockNotch,
    BoxCovering,
    CapCovering,
    ConeCovering,
    StopCovering,
    StraightCovering,
    TeeCovering,
)
from pipeworkbench.solids.outlines import Outline

CONCENTRIC_MM = 1e-6  # an offset below this is none
OVER_RAD = 0.1  # by which the part of an elbow that is taken from a gore reaches over it

Items = list[tuple[int, Any]]  # the number of the layer, the jacket's is the last, and a solid of it


def covering_items(shapes: Shapes, covering: AnyCovering) -> tuple[str, Items]:
    """Return the kind of representation and the solids of a covering, from the inside to the outside."""
    layers = list(enumerate(itertools.pairwise(covering.boundaries)))
    kind, items = SWEPT, []
    for number, (inner, outer) in layers:
        kind, found = _layer(shapes, covering, inner, outer)
        items += [(number, item) for item in found]
    for notch in covering.notches:
        tool = _notch(shapes, notch)
        kind, items = SOLID, [(number, shapes.boolean("DIFFERENCE", item, tool)) for number, item in items]
    return kind, items


def _layer(shapes: Shapes, covering: AnyCovering, inner: float, outer: float) -> tuple[str, list[Any]]:
    """Return the solids of a layer between two distances (mm) from the inner face."""
    kind, items = SWEPT, []
    match covering:
        case StraightCovering():
            items = [_tube(shapes, covering.radius + outer, outer - inner, covering.begin, covering.end)]
        case BendCovering() if covering.gores:
            kind, items = SOLID, list(_gores(shapes, covering, inner, outer))
        case BendCovering():
            items = list(_torus(shapes, covering, inner, outer))
        case ConeCovering():
            kind, items = _cone(shapes, covering, inner, outer)
        case TeeCovering():
            kind, items = SOLID, list(_tee(shapes, covering, inner, outer))
        case CapCovering():
            items = [shapes.turned(_pot(covering, inner, outer))]
        case BoxCovering():
            items = [shapes.turned(_can(covering, inner, outer))]
        case StopCovering():
            items = [_tube(shapes, covering.outer_radius, covering.outer_radius - covering.radius, inner, outer)]
    return kind, items


def _tube(shapes: Shapes, radius: float, wall: float | None, begin: float, end: float) -> Any:
    """Return a cylinder about z with an outer radius, hollow where there is a wall (mm)."""
    return shapes.extruded(shapes.ring(2 * radius, wall), end - begin, (0.0, 0.0, begin))


def _torus(shapes: Shapes, covering: BendCovering, inner: float, outer: float) -> Iterator[Any]:
    """Yield a smooth bend and its collars."""
    ring = shapes.ring(2 * (covering.radius + outer), outer - inner)
    yield shapes.bent(ring, covering.bend_radius, covering.angle)
    first, last = covering.collars
    if first:
        yield shapes.extruded(ring, first, (0.0, 0.0, -first))
    if last:
        point, along, across = _on_bend(covering, covering.angle)
        yield shapes.extruded(ring, last, point, along, across)


def _gores(shapes: Shapes, covering: BendCovering, inner: float, outer: float) -> Iterator[Any]:
    """Yield the pieces of a segmented bend; each touches the bend's axis where the axes of ``_on_bend`` are."""
    radius, joint = covering.radius + outer, covering.joint_angle
    section = shapes.ring(2 * radius, outer - inner if inner else None)
    # to the heel of the joint, from where the cylinder is cut off
    far = (covering.bend_radius + radius) * math.tan(joint / 2) + OVER_MM
    # under the first layer is the elbow, a torus, and under its collars what goes on straight
    first, last = covering.collars if inner else (0.0, 0.0)
    for number in range(covering.gores):
        turn = number * joint
        back, front = (first if number == 0 else far), (last if number == covering.gores - 1 else far)
        solid = _along(shapes, covering, section, turn, (-back, front))
        if number > 0:
            solid = shapes.clipped(solid, *_plane(covering, turn - joint / 2, -1.0))
        if number < covering.gores - 1:
            solid = shapes.clipped(solid, *_plane(covering, turn + joint / 2, 1.0))
        yield solid if inner else shapes.boolean("DIFFERENCE", solid, _elbow_in(shapes, covering, turn))
    if not inner:
        yield from _collars(shapes, covering, outer)


def _collars(shapes: Shapes, covering: BendCovering, outer: float) -> Iterator[Any]:
    """Yield the collars of the first layer of a segmented bend, cut off like its gores: one representation holds one kind of items."""
    radius = covering.radius + outer
    for length, turn, sign in zip(covering.collars, (0.0, covering.angle), (-1.0, 1.0), strict=True):
        if not length:
            continue
        ends = sorted((sign * length, -sign * OVER_MM))
        solid = _along(shapes, covering, shapes.ring(2 * radius, outer), turn, (ends[0], ends[1]))
        solid = shapes.clipped(solid, *_plane(covering, turn, -sign))
        if radius > covering.bend_radius:
            # behind the bend's centre both collars would meet
            solid = shapes.clipped(solid, *_plane(covering, turn - sign * covering.joint_angle / 2, -sign))
        yield solid


def _along(shapes: Shapes, covering: BendCovering, section: Any, turn: float, ends: tuple[float, float]) -> Any:
    """Return a section extruded along the bend's tangent at an angle, from one place on it to another (mm)."""
    origin, along, across = _on_bend(covering, turn)
    start = tuple(a + ends[0] * b for a, b in zip(origin, along, strict=True))
    return shapes.extruded(section, ends[1] - ends[0], start, along, across)


def _elbow_in(shapes: Shapes, covering: BendCovering, turn: float) -> Any:
    """Return the part of the elbow that is in the gore at an angle, a little longer: programs stumble over faces that coincide.

    Some also stumble over what is much longer than it need be.
    """
    half = covering.joint_angle / 2
    begin, end = max(turn - half, 0.0) - OVER_RAD, min(turn + half, covering.angle) + OVER_RAD
    return shapes.bent(shapes.ring(2 * covering.radius, None), covering.bend_radius, end - begin, *_on_bend(covering, begin))


def _on_bend(covering: BendCovering, turn: float) -> tuple[Vector, Vector, Vector]:
    """Return a point of the bend's axis, the axis' direction there and the one to the bend's centre."""
    sine, cosine, radius = math.sin(turn), math.cos(turn), covering.bend_radius
    return (radius - radius * cosine, 0.0, radius * sine), (sine, 0.0, cosine), (cosine, 0.0, -sine)


def _plane(covering: BendCovering, turn: float, sign: float) -> tuple[Vector, Vector]:
    """Return a point of the plane across the bend at an angle and its normal, forwards (1) or backwards (-1)."""
    return (covering.bend_radius, 0.0, 0.0), (sign * math.sin(turn), 0.0, sign * math.cos(turn))


def _cone(shapes: Shapes, covering: ConeCovering, inner: float, outer: float) -> tuple[str, list[Any]]:
    wide, narrow, length = covering.radius, covering.end_radius, covering.length
    if abs(covering.offset) < CONCENTRIC_MM:
        section = [(wide + inner, 0.0), (wide + outer, 0.0), (narrow + outer, length), (narrow + inner, length)]
        return SWEPT, [shapes.turned(section)]
    return TAPERED, [shapes.tapered(2 * (wide + outer), 2 * (narrow + outer), outer - inner, length, covering.offset)]


def _tee(shapes: Shapes, covering: TeeCovering, inner: float, outer: float) -> Iterator[Any]:
    """Yield the run less the branch's passage and the branch less the run; only the run where the branch is a hole."""
    run = _tube(shapes, covering.radius + outer, outer - inner, covering.begin, covering.end)
    branch = {"along": (math.sin(covering.branch_angle), 0.0, math.cos(covering.branch_angle)), "across": ALONG_Y}
    hole = covering.branch_radius + (inner if covering.reach else 0.0)
    reach = covering.reach or 2 * (covering.radius + outer + covering.branch_radius) / math.sin(covering.branch_angle)
    yield shapes.boolean("DIFFERENCE", run, shapes.extruded(shapes.ring(2 * hole, None), reach + OVER_MM, **branch))
    if covering.reach:
        arm = shapes.extruded(shapes.ring(2 * (covering.branch_radius + outer), outer - inner), reach, **branch)
        block = _tube(shapes, covering.radius + outer, None, covering.begin, covering.end)
        yield shapes.boolean("DIFFERENCE", arm, block)


def _pot(covering: CapCovering, inner: float, outer: float) -> Outline:
    (radius, top), (wide, high) = ((covering.radius + distance, covering.length + distance) for distance in (inner, outer))
    return [(radius, 0.0), (wide, 0.0), (wide, high), (0.0, high), (0.0, top), (radius, top)]


def _can(covering: BoxCovering, inner: float, outer: float) -> Outline:
    """Return the half section of a layer of a box, both half shells as one."""
    total, (first, last) = covering.total_thickness, covering.openings
    (radius, low, high), (wide, bottom, top) = (
        (covering.radius + distance, covering.begin + total - distance, covering.end - total + distance) for distance in (inner, outer)
    )
    return [(first, bottom), (wide, bottom), (wide, top), (last, top), (last, high), (radius, high), (radius, low), (first, low)]


def _notch(shapes: Shapes, notch: AnyNotch) -> Any:
    """Return the cylinder or the block that a notch takes out."""
    if isinstance(notch, BlockNotch):
        frame, (width, depth, height) = notch.frame, notch.size.tolist()
        return shapes.extruded(shapes.rectangle(width, depth), height, frame.origin.tolist(), frame.z.tolist(), frame.x.tolist())
    axis = notch.end - notch.start
    length = float(np.linalg.norm(axis))
    along = axis / length
    # across the axis, next to the direction that is farthest from it
    sideways = across(np.eye(3)[int(np.abs(along).argmin())], along)
    sideways = sideways / np.linalg.norm(sideways)
    return shapes.extruded(shapes.ring(2 * notch.radius, None), length, notch.start.tolist(), along.tolist(), sideways.tolist())
