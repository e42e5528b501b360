# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverings and bare components as convex bodies (``hulls``) in the pipeline's frame."""

from __future__ import annotations

import math

import numpy as np

from pipeworkbench.insulation.hulls import Hulls, cylinder, discs, joined
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import AnyCovering, BendCovering, BoxCovering, CapCovering, ConeCovering, StraightCovering, TeeCovering
from pipeworkbench.solids.frames import Frame, bend_angle, frame_of

SMOOTH_DEG = 5.0  # of a torus per piece: 0.1 % of its radius outside of it
LEAST_MM = 1e-3  # shorter bodies are none


def covering_hulls(covering: AnyCovering, owner: int) -> Hulls:
    """Return a covering's finished surface; a disc of sheet metal has none."""
    total = covering.total_thickness
    match covering:
        case StraightCovering() | BoxCovering():
            own = _along_z(covering.begin, covering.end, covering.radius + total, owner)
        case BendCovering():
            own = _bend(covering.radius + total, covering.bend_radius, covering.angle, covering.gores, covering.collars, owner)
        case ConeCovering():
            own = _cone(covering.radius + total, covering.end_radius + total, covering.length, covering.offset, owner)
        case TeeCovering():
            own = _along_z(covering.begin, covering.end, covering.radius + total, owner)
            if covering.reach:
                own = joined([own, _branch(covering.branch_radius + total, covering.reach, covering.branch_angle, owner)])
        case CapCovering():
            own = _along_z(0.0, covering.length + total, covering.radius + total, owner)
        case _:
            own = Hulls(np.zeros((0, 2, 3)), np.zeros((0, 2, 3)), np.zeros((0, 2, 3)), np.zeros(0, np.intp))
    return _placed(own, covering.frame)


def metal_hulls(component: AnyComponent, owner: int) -> Hulls:
    """Return a component's own surface.

    Raises
    ------
    InputError
        Where the component's points leave a direction open.
    """
    radius = component.outer_diameter / 2
    match component:
        case Pipe():
            return cylinder(np.array(component.start), np.array(component.end), radius, radius, owner)
        case Elbow():
            frame = frame_of(component)
            return _placed(_bend(radius, component.bend_radius, bend_angle(component), 0, (0.0, 0.0), owner), frame)
        case Flange():
            own = _along_z(0.0, component.C, component.D / 2, owner)
            if component.length - component.C > LEAST_MM:
                neck = (component.neck_diameter or component.outer_diameter) / 2
                way = np.array([0.0, 0.0, 1.0])
                own = joined([own, cylinder(component.C * way, component.length * way, neck, radius, owner)])
            return _placed(own, frame_of(component))
        case Tee():
            run = cylinder(np.array(component.start), np.array(component.end), radius, radius, owner)
            half = component.branch_diameter / 2
            return joined([run, cylinder(np.array(component.intersection), np.array(component.branch_end), half, half, owner)])
        case Reducer():
            frame = frame_of(component)
            offset = float((np.subtract(component.end, component.start)) @ frame.x)
            return _placed(_cone(radius, component.end_diameter / 2, component.length, offset, owner), frame)
        case Cap():
            return _placed(_along_z(0.0, component.length, radius, owner), frame_of(component))


def _placed(own: Hulls, frame: Frame) -> Hulls:
    return own.moved(frame.origin, np.array([frame.x, frame.y, frame.z]))


def _along_z(begin: float, end: float, radius: float, owner: int) -> Hulls:
    centres, size = np.array([[0.0, 0.0, begin], [0.0, 0.0, end]]), radius * np.eye(3)
    return discs(centres, size[[0, 0]], size[[1, 1]], owner)


def _branch(radius: float, reach: float, angle: float, owner: int) -> Hulls:
    return cylinder(np.zeros(3), reach * np.array([math.sin(angle), 0.0, math.cos(angle)]), radius, radius, owner)


def _cone(radius: float, end_radius: float, length: float, offset: float, owner: int) -> Hulls:
    radii = np.array([[radius], [end_radius]])
    centres = np.array([[0.0, 0.0, 0.0], [offset, 0.0, length]])
    return discs(centres, radii * np.array([1.0, 0.0, 0.0]), radii * np.array([0.0, 1.0, 0.0]), owner)


def _bend(radius: float, bend_radius: float, angle: float, gores: int, collars: tuple[float, float], owner: int) -> Hulls:
    """Return the pieces of a bend in the axes of its elbow; a torus is parted into many."""
    count = gores or 1 + math.ceil(math.degrees(angle) / SMOOTH_DEG)
    joint = angle / (count - 1)
    half = bend_radius * math.tan(joint / 2)
    turns = joint * np.arange(count)
    lengths = np.r_[collars[0] + half, np.full(count - 2, 2 * half), half + collars[1]]
    steps = lengths[:, None] * _directions(turns)
    centres = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)]) - [0.0, 0.0, collars[0]]
    # square ends and mitres between
    faces = np.r_[0.0, turns[:-1] + joint / 2, angle]
    wide = radius / np.r_[1.0, np.full(count - 1, math.cos(joint / 2)), 1.0]
    across = _directions(faces + math.pi / 2)
    return discs(centres, wide[:, None] * across, np.broadcast_to([0.0, radius, 0.0], (count + 1, 3)), owner)


def _directions(turns: Array) -> Array:
    """Return the directions (n, 3) of a bend's axis after turns (n,) rad."""
    return np.column_stack([np.sin(turns), np.zeros(len(turns)), np.cos(turns)])
