# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components in arrays: places and sizes of all of them at once, for what is computed of many again and again."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import HUBBED_FLANGES, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import as_vector, dot, units

KINDS: tuple[type[AnyComponent], ...] = (Pipe, Elbow, Flange, Tee, Reducer, Cap)
PIPE, ELBOW, FLANGE, TEE, REDUCER, CAP = range(len(KINDS))
POINT_NAMES: dict[type[AnyComponent], tuple[str, ...]] = {
    Pipe: ("start", "end"),
    Elbow: ("start", "end", "intersection"),
    Flange: ("face",),
    Tee: ("start", "end", "intersection", "branch_end"),
    Reducer: ("start", "end"),
    Cap: ("start",),
}
START, END, CORNER, BRANCH_END = range(4)  # columns of points; a flange's face is its start
WITH_AXIS = (Flange, Reducer, Cap)
SIZE_NAMES: dict[type[AnyComponent], tuple[str, ...]] = {
    Pipe: ("outer_diameter",),
    Elbow: ("outer_diameter", "bend_radius", "angle_deg"),
    Flange: ("outer_diameter", "D", "C"),
    Tee: ("outer_diameter", "branch_diameter"),
    Reducer: ("outer_diameter", "end_diameter"),
    Cap: ("outer_diameter",),
}
DIAMETERS = ("outer_diameter", "branch_diameter", "end_diameter", "D")
SIZES = 3  # of a component at most
RADIUS, SECOND, THIRD = range(SIZES)  # columns of sizes
BEND, ANGLE = SECOND, THIRD  # of an elbow
PLATE, THICKNESS = SECOND, THIRD  # of a flange
LEAST_LEVER = 10.0  # mm
LEAST_SIZE = 1.0  # mm; nothing makes a part smaller

Rows = NDArray[np.intp]
Flags = NDArray[np.bool_]


def unit_of(name: str) -> float:
    """Return how many of a size's own units one unit in the arrays is: these have radii, and angles in rad."""
    return 2.0 if name in DIAMETERS else float(np.degrees(1.0)) if name == "angle_deg" else 1.0


@dataclass(frozen=True, eq=False)
class Details:
    """What no adjustment changes, c in number; lengths in mm.

    members are the rows of each kind;
    beyond (c,): from a flange's plate to its weld end, and a cap's length; raised (c, 2): radius and height of a raised face, zeros for none;
    neck (c,): radius of a flange's neck at its plate, NaN where it is the pipe's; straight (c,): length of its straight part;
    hubbed (c,), blind (c,): kinds of flanges; eccentric (c,): reducers; least (c, 3): the smallest sizes.
    """

    members: tuple[Rows, ...]
    beyond: Array
    raised: Array
    neck: Array
    straight: Array
    hubbed: Flags
    blind: Flags
    eccentric: Flags
    least: Array


@dataclass(frozen=True, eq=False)
class Bodies:
    """Components in arrays, c in number; what a kind has no use for is zero.

    ``given`` are the components they were made of; kind (c,) the rows of KINDS; points (c, 4, 3) mm, those of POINT_NAMES; axis (c, 3) unit, of a
    flange out of its face, of a reducer to its narrow end, of a cap out of its pipe; sizes (c, 3), those of SIZE_NAMES as radii or lengths (mm)
    or rad; ``details``; changed (c,) whose arrays are no longer those of the given component.
    """

    given: tuple[AnyComponent, ...]
    kind: NDArray[np.int8]
    points: Array
    axis: Array
    sizes: Array
    details: Details
    changed: Flags

    def __len__(self) -> int:
        return len(self.kind)

    @classmethod
    def of(cls, components: Sequence[AnyComponent]) -> Bodies:
        """Return components in arrays."""
        count = len(components)
        kind = np.array([KINDS.index(type(component)) for component in components], np.int8)
        points, axis, sizes = np.zeros((count, 4, 3)), np.zeros((count, 3)), np.zeros((count, SIZES))
        for number, own in enumerate(KINDS):
            rows = np.flatnonzero(kind == number)
            ours: list[Any] = [components[row] for row in rows]
            if not ours:
                continue
            for column, name in enumerate(POINT_NAMES[own]):
                points[rows, column] = [getattr(component, name) for component in ours]
            for column, name in enumerate(SIZE_NAMES[own]):
                sizes[rows, column] = np.array([getattr(component, name) for component in ours]) / unit_of(name)
            if own in WITH_AXIS:
                axis[rows] = units(np.array([component.axis for component in ours]))
        return cls(tuple(components), kind, points, axis, sizes, _details(components, kind), np.zeros(count, bool))

    def restored(self, rows: Rows) -> Bodies:
        """Return components of which some (m,) are as they were given again."""
        given = Bodies.of(self.given)
        arrays = {name: getattr(self, name).copy() for name in ("points", "axis", "sizes", "changed")}
        for name, array in arrays.items():
            array[rows] = getattr(given, name)[rows]
        return replace(self, **arrays)

    def rows(self, *kinds: int) -> Rows:
        """Return the rows of the components of some kinds, kind by kind."""
        members = self.details.members
        return members[kinds[0]] if len(kinds) == 1 else np.concatenate([members[kind] for kind in kinds])

    @functools.cached_property
    def references(self) -> tuple[Array, Array, Array]:
        """The points (c, 3), mm, that components turn about, their axes (c, 3) and levers (c,), mm: half of their sizes along the axes."""
        reference, axis = self.points[:, START].copy(), self.axis.copy()
        lever = self.sizes[:, PLATE].copy()
        pipes, elbows, tees, reducers, caps = (self.rows(kind) for kind in (PIPE, ELBOW, TEE, REDUCER, CAP))
        reference[pipes] = (self.points[pipes, START] + self.points[pipes, END]) / 2
        reference[elbows], reference[tees] = self.points[elbows, CORNER], self.points[tees, CORNER]
        straight = self.rows(PIPE, TEE)
        axis[straight], lever[straight] = self.directions(straight), self.lengths(straight) / 2
        tangent = self.points[elbows, CORNER] - self.points[elbows, START]
        axis[elbows], lever[elbows] = units(tangent), np.linalg.norm(tangent, axis=1)
        lever[reducers] = np.maximum(self.reducer_lengths(reducers), self.sizes[reducers, RADIUS])
        lever[caps] = np.maximum(self.details.beyond[caps], self.sizes[caps, RADIUS])
        return reference, axis, np.maximum(lever, LEAST_LEVER)

    @functools.cached_property
    def number(self) -> dict[str, int]:
        """The rows of components by their ids."""
        return {component.id: row for row, component in enumerate(self.given)}

    @functools.cached_property
    def components(self) -> tuple[AnyComponent, ...]:
        """The components as they are now; those that have not changed are the given ones."""
        return tuple(self._component(row) if changed else self.given[row] for row, changed in enumerate(self.changed))

    def _component(self, row: int) -> AnyComponent:
        given = self.given[row]
        own = type(given)
        changes: dict[str, Any] = {name: as_vector(self.points[row, column]) for column, name in enumerate(POINT_NAMES[own])}
        changes |= {name: float(self.sizes[row, column] * unit_of(name)) for column, name in enumerate(SIZE_NAMES[own])}
        if own in WITH_AXIS:
            changes["axis"] = as_vector(self.axis[row])
        if isinstance(given, Pipe):
            # its gaps go with it
            given = given.with_ends(changes.pop("start"), changes.pop("end"))
        elif isinstance(given, Flange):
            # in this order, so that a flange without a neck gets none by rounding
            changes["length"] = changes["C"] + float(self.details.beyond[row])
        return replace(given, **changes)

    def first_and_last(self) -> tuple[Array, Array]:
        """Return the first and the last port's points (c, 3), mm; of one port it is both times the same."""
        last = self.points[:, END].copy()
        flanges, tees, caps = self.rows(FLANGE), self.rows(TEE), self.rows(CAP)
        last[flanges] = self.points[flanges, START] - (self.flange_length(flanges) * ~self.details.blind[flanges])[:, None] * self.axis[flanges]
        last[tees] = self.points[tees, BRANCH_END]
        last[caps] = self.points[caps, START]
        return self.points[:, START], last

    def flange_length(self, flanges: Rows) -> Array:
        """Return the lengths (m,), mm, of flanges (m,) from face to weld end."""
        return np.asarray(self.sizes[flanges, THICKNESS] + self.details.beyond[flanges])

    def directions(self, rows: Rows) -> Array:
        """Return the unit directions (m, 3) of components (m,) from start to end."""
        return units(self.points[rows, END] - self.points[rows, START])

    def elbow_axes(self, elbows: Rows) -> tuple[Array, Array, Array]:
        """Return the directions (m, 3) in which elbows (m,) are entered and left, and their planes' normals, about which they turn."""
        corner = self.points[elbows, CORNER]
        come, go = units(corner - self.points[elbows, START]), units(self.points[elbows, END] - corner)
        return come, go, units(np.cross(come, go))

    def lengths(self, rows: Rows) -> Array:
        """Return the distances (m,), mm, of start and end of components (m,)."""
        return np.asarray(np.linalg.norm(self.points[rows, END] - self.points[rows, START], axis=1))

    def reducer_lengths(self, reducers: Rows) -> Array:
        """Return the lengths (m,), mm, of reducers (m,) along their axes."""
        return dot(self.points[reducers, END] - self.points[reducers, START], self.axis[reducers])


def _details(components: Sequence[AnyComponent], kind: NDArray[np.int8]) -> Details:
    members = tuple(np.flatnonzero(kind == number) for number in range(len(KINDS)))
    count = len(components)
    beyond, raised, neck, straight = np.zeros(count), np.zeros((count, 2)), np.full(count, np.nan), np.zeros(count)
    hubbed, blind, eccentric = (np.zeros(count, bool) for _ in range(3))
    least = np.full((count, SIZES), LEAST_SIZE)
    for row, component in enumerate(components):
        wall = 2 * component.wall_thickness if component.wall_thickness is not None else 0.0
        # what is in a part or on it has room
        for column, name in enumerate(SIZE_NAMES[type(component)]):
            if name in DIAMETERS and name != "D":
                least[row, column] = (wall + LEAST_SIZE) / 2
        match component:
            case Flange():
                height = component.raised_face_height if component.raised_face_diameter else None
                beyond[row], straight[row] = component.length - component.C, component.neck_straight or 0.0
                if component.raised_face_diameter and height:
                    raised[row] = component.raised_face_diameter / 2, height
                if component.neck_diameter:
                    neck[row] = component.neck_diameter / 2
                hubbed[row], blind[row] = component.flange_type in HUBBED_FLANGES, len(component.ports) == 1
                holes = component.K + (component.L or 0.0) if component.K is not None else 0.0
                least[row, PLATE] = (max(holes, component.raised_face_diameter or 0.0) + LEAST_SIZE) / 2
                least[row, THICKNESS] = (component.raised_face_height or 0.0) + LEAST_SIZE
            case Reducer():
                eccentric[row] = component.reducer_type == "eccentric"
            case Cap():
                beyond[row] = component.length
            case _:
                pass
    return Details(members, beyond, raised, neck, straight, hubbed, blind, eccentric, least)
