# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as simple surfaces, in arrays: what a camera sees of them and what hides what.

A pipe is a frustum (with equal radii), an elbow a part of a torus, a flange frustums one behind the
other: raised face, plate and neck; a tee two pipes, a reducer a frustum, a cap a row of them on its ellipse. Ends are
closed with discs: pipework is opaque.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import HUBBED_FLANGES, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import unit

STRAIGHT_DEG = 1e-3  # a bend by less is not a torus
DISH = 0.25  # height over diameter of an ellipsoidal head with axes 2 : 1, as caps have it (EN 10253-2)
DISH_STEPS = 6  # frustums that stand for it: off by less than 1 % of the radius


@dataclass(frozen=True, eq=False)
class Frustums:
    """Surfaces of revolution with straight generators.

    start (k, 3) the first end's centre; axis (k, 3) unit, towards the other end; length (k,); radius
    (k, 2) at both ends; owner (k,) row of the component. Lengths in mm.
    """

    start: Array
    axis: Array
    length: Array
    radius: Array
    owner: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.length)


@dataclass(frozen=True, eq=False)
class Tori:
    """Parts of tori.

    centre (k, 3); axis (k, 3) unit, of revolution; first (k, 3) unit, from the centre towards the bend's
    start; angle (k,) rad, turned from ``first`` about ``axis``; bend_radius, tube_radius (k,); owner (k,) row
    of the component. Lengths in mm.
    """

    centre: Array
    axis: Array
    first: Array
    angle: Array
    bend_radius: Array
    tube_radius: Array
    owner: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.angle)

    @property
    def second(self) -> Array:
        """Unit vectors (k, 3) at a right angle to ``first``, in the direction of the bend."""
        return np.cross(self.axis, self.first)


@dataclass(frozen=True, eq=False)
class Circles:
    """Sharp circular edges: centre (k, 3), axis (k, 3) unit, radius (k,) in mm, owner (k,) row of the component."""

    centre: Array
    axis: Array
    radius: Array
    owner: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.radius)


S = TypeVar("S", Frustums, Tori, Circles)


@dataclass(frozen=True, eq=False)
class Shapes:
    """The surfaces of components.

    ``frustums`` and ``tori`` with the ``part`` names of the former ("pipe", "branch", "cone", "cap", "rim", "neck", "raised face"); ``discs`` close
    them; ``edges`` are the sharp edges that a camera may see, with their ``edge_part`` ("face", "back", "raised face", "hub end").
    """

    frustums: Frustums
    part: tuple[str, ...]
    tori: Tori
    discs: Circles
    edges: Circles
    edge_part: tuple[str, ...]
    count: int

    def of(self, wanted: NDArray[np.bool_]) -> Shapes:
        """Return the shapes of the wanted components (count,); owners keep their numbers."""
        frustum, edge = wanted[self.frustums.owner], wanted[self.edges.owner]
        return Shapes(
            _rows(self.frustums, frustum),
            tuple(np.array(self.part, object)[frustum]),
            _rows(self.tori, wanted[self.tori.owner]),
            _rows(self.discs, wanted[self.discs.owner]),
            _rows(self.edges, edge),
            tuple(np.array(self.edge_part, object)[edge]),
            self.count,
        )


def _rows(surfaces: S, rows: NDArray[np.bool_]) -> S:
    """Return some of the surfaces."""
    return type(surfaces)(*(getattr(surfaces, f.name)[rows] for f in fields(surfaces)))


def shapes_of(components: Sequence[AnyComponent]) -> Shapes:
    """Return the surfaces of components; ``owner`` is the component's row.

    Raises
    ------
    InputError
        Where an elbow's ends, intersection and bend radius do not belong together.
    """
    rows = _Rows()
    for owner, component in enumerate(components):
        match component:
            case Pipe():
                rows.add_frustum(owner, "pipe", component.start, component.end, component.outer_diameter, component.outer_diameter)
            case Elbow():
                rows.add_torus(owner, component)
            case Flange():
                rows.add_flange(owner, component)
            case Tee():
                rows.add_frustum(owner, "pipe", component.start, component.end, component.outer_diameter, component.outer_diameter)
                rows.add_frustum(owner, "branch", component.intersection, component.branch_end, component.branch_diameter, component.branch_diameter)
            case Reducer():
                rows.add_frustum(owner, "cone", component.start, component.end, component.outer_diameter, component.end_diameter)
            case Cap():
                rows.add_cap(owner, component)
    return Shapes(
        Frustums(*_columns(rows.frustums, (3, 3, 0, 2, 0))),
        tuple(rows.part),
        Tori(*_columns(rows.tori, (3, 3, 3, 0, 0, 0, 0))),
        Circles(*_columns(rows.discs, (3, 3, 0, 0))),
        Circles(*_columns(rows.edges, (3, 3, 0, 0))),
        tuple(rows.edge_part),
        len(components),
    )


class _Rows:
    """The surfaces as lists of rows while they are collected."""

    def __init__(self) -> None:
        self.frustums: list[tuple[object, ...]] = []
        self.tori: list[tuple[object, ...]] = []
        self.discs: list[tuple[object, ...]] = []
        self.edges: list[tuple[object, ...]] = []
        self.part: list[str] = []
        self.edge_part: list[str] = []

    def add_frustum(self, owner: int, part: str, start: Sequence[float], end: Sequence[float], diameter: float, end_diameter: float) -> None:
        first, last = np.array(start, float), np.array(end, float)
        length = float(np.linalg.norm(last - first))
        axis = (last - first) / length
        self.frustums.append((first, axis, length, (diameter / 2, end_diameter / 2), owner))
        self.part.append(part)
        self.discs += [(first, axis, diameter / 2, owner), (last, axis, end_diameter / 2, owner)]

    def add_torus(self, owner: int, elbow: Elbow) -> None:
        torus = _torus_of(elbow)
        centre, axis, first, angle, bend_radius, tube_radius = torus
        self.tori.append((*torus, owner))
        second = np.cross(axis, first)
        for turn in (0.0, angle):
            outwards = np.cos(turn) * first + np.sin(turn) * second
            self.discs.append((centre + bend_radius * outwards, np.cross(axis, outwards), tube_radius, owner))

    def add_flange(self, owner: int, flange: Flange) -> None:
        face, axis = np.array(flange.face, float), -unit(flange.axis)
        height = flange.raised_face_height if flange.raised_face_diameter else None
        front, back = face + (height or 0.0) * axis, face + flange.C * axis
        self.add_frustum(owner, "rim", tuple(front), tuple(back), flange.D, flange.D)
        for centre, name in ((front, "face"), (back, "back")):
            self.edges.append((centre, axis, flange.D / 2, owner))
            self.edge_part.append(name)
        if height and flange.raised_face_diameter:
            self.add_frustum(owner, "raised face", tuple(face), tuple(front), flange.raised_face_diameter, flange.raised_face_diameter)
            self.edges.append((face, axis, flange.raised_face_diameter / 2, owner))
            self.edge_part.append("raised face")
        if flange.length > flange.C:
            self._add_neck(owner, flange, back, face + flange.length * axis, axis)

    def _add_neck(self, owner: int, flange: Flange, back: Array, end: Array, axis: Array) -> None:
        """Add what stands on the plate: a hub, straight to its end, or a cone that tapers to the pipe."""
        root = min(flange.neck_diameter or flange.outer_diameter, flange.D)
        if flange.flange_type in HUBBED_FLANGES:
            self.add_frustum(owner, "neck", tuple(back), tuple(end), root, root)
            self.edges.append((end, axis, root / 2, owner))
            self.edge_part.append("hub end")
            return
        straight = min(flange.neck_straight or 0.0, (flange.length - flange.C) / 2)
        self.add_frustum(owner, "neck", tuple(back), tuple(end - straight * axis), root, flange.outer_diameter)
        if straight:
            self.add_frustum(owner, "neck", tuple(end - straight * axis), tuple(end), flange.outer_diameter, flange.outer_diameter)

    def add_cap(self, owner: int, cap: Cap) -> None:
        start, axis, diameter = np.array(cap.start, float), unit(cap.axis), cap.outer_diameter
        dish = min(DISH * diameter, cap.length)
        if cap.length > dish:
            self.add_frustum(owner, "pipe", tuple(start), tuple(start + (cap.length - dish) * axis), diameter, diameter)
        turn = np.linspace(0, np.pi / 2, DISH_STEPS + 1)
        along, width = cap.length - dish * (1 - np.sin(turn)), diameter * np.cos(turn)
        for step in range(DISH_STEPS):
            here, there = tuple(start + along[step] * axis), tuple(start + along[step + 1] * axis)
            self.add_frustum(owner, "cap", here, there, float(width[step]), float(width[step + 1]))


def _torus_of(elbow: Elbow) -> tuple[Array, Array, Array, float, float, float]:
    """Return centre, axis, first direction, angle, bend radius and tube radius of an elbow."""
    corner = np.array(elbow.intersection, float)
    come, go = corner - np.array(elbow.start, float), np.array(elbow.end, float) - corner
    if min(np.linalg.norm(come), np.linalg.norm(go)) == 0:
        raise InputError(elbow.id, "intersection", "coincides with an end of the elbow", "give the point where both axes meet")
    come, go = unit(come), unit(go)
    normal = np.cross(come, go)
    angle = float(np.arctan2(np.linalg.norm(normal), come @ go))
    if angle < np.radians(STRAIGHT_DEG):
        raise InputError(elbow.id, "angle_deg", "the elbow does not bend", "leave it out: the pipes meet in a line")
    # perpendicular to the incoming axis in the bend's plane; anti-parallel axes have no plane
    if angle > np.pi - np.radians(STRAIGHT_DEG):
        raise InputError(elbow.id, "angle_deg", "the elbow turns back on itself", "give both halves as elbows of their own")
    normal /= np.linalg.norm(normal)
    inwards = np.cross(normal, come)
    # where both axes' tangent lengths agree with the bend radius, the centre lies beside the start
    centre = np.array(elbow.start, float) + elbow.bend_radius * inwards
    return centre, normal, -inwards, angle, elbow.bend_radius, elbow.outer_diameter / 2


def _columns(rows: list[tuple[object, ...]], sizes: Sequence[int]) -> list[Any]:
    """Return rows as arrays, one per column; (k, size) where the size is not 0; the last one, the owner, as integers."""
    columns = [np.array([row[i] for row in rows], float).reshape((len(rows), size) if size else (len(rows),)) for i, size in enumerate(sizes)]
    return [*columns[:-1], columns[-1].astype(np.intp)]
