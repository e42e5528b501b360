# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as simple surfaces, in arrays: what a camera sees of them and what hides what.

A pipe is a frustum (with equal radii), an elbow a part of a torus, a flange two frustums one behind the
other: plate and neck. Ends are closed with discs: pipework is opaque.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Elbow, Pipe
from pipeworkbench.recon.camera import Array

STRAIGHT_DEG = 1e-3  # a bend by less is not a torus


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


@dataclass(frozen=True, eq=False)
class Shapes:
    """The surfaces of components.

    ``frustums`` and ``tori`` with the ``part`` names of the former ("pipe", "rim", "neck"); ``discs`` close them;
    ``edges`` are the sharp edges that a camera may see, with their ``edge_part`` ("face", "back").
    """

    frustums: Frustums
    part: tuple[str, ...]
    tori: Tori
    discs: Circles
    edges: Circles
    edge_part: tuple[str, ...]
    count: int


def shapes_of(components: Sequence[AnyComponent]) -> Shapes:
    """Return the surfaces of components; ``owner`` is the component's row.

    Raises
    ------
    InputError
        Where an elbow's ends, intersection and bend radius do not belong together.
    """
    frustums: list[tuple[object, ...]] = []
    tori: list[tuple[object, ...]] = []
    discs: list[tuple[object, ...]] = []
    edges: list[tuple[object, ...]] = []
    part, edge_part = [], []
    for owner, component in enumerate(components):
        if isinstance(component, Pipe):
            start, axis, length = _axis_of(component)
            radius = component.outer_diameter / 2
            frustums.append((start, axis, length, (radius, radius), owner))
            part.append("pipe")
            discs += [(start, axis, radius, owner), (start + length * axis, axis, radius, owner)]
        elif isinstance(component, Elbow):
            torus = _torus_of(component)
            centre, axis, first, angle, bend_radius, tube_radius = torus
            tori.append((*torus, owner))
            second = np.cross(axis, first)
            for turn in (0.0, angle):
                outwards = np.cos(turn) * first + np.sin(turn) * second
                discs.append((centre + bend_radius * outwards, np.cross(axis, outwards), tube_radius, owner))
        else:
            face, back, axis = np.array(component.face, float), component.C, -_unit(component.axis)
            rim, pipe = component.D / 2, component.outer_diameter / 2
            frustums.append((face, axis, back, (rim, rim), owner))
            part.append("rim")
            for along, name in ((0.0, "face"), (back, "back")):
                circle = (face + along * axis, axis, rim, owner)
                discs.append(circle)
                edges.append(circle)
                edge_part.append(name)
            neck_length = component.length - back
            if neck_length > 0:
                root = min((component.neck_diameter or component.outer_diameter) / 2, rim)
                frustums.append((face + back * axis, axis, neck_length, (root, pipe), owner))
                part.append("neck")
                discs.append((face + component.length * axis, axis, pipe, owner))
    return Shapes(
        Frustums(*_columns(frustums, (3, 3, 0, 2, 0))),
        tuple(part),
        Tori(*_columns(tori, (3, 3, 3, 0, 0, 0, 0))),
        Circles(*_columns(discs, (3, 3, 0, 0))),
        Circles(*_columns(edges, (3, 3, 0, 0))),
        tuple(edge_part),
        len(components),
    )


def _unit(vector: Sequence[float]) -> Array:
    array = np.array(vector, float)
    return array / np.linalg.norm(array)


def _axis_of(pipe: Pipe) -> tuple[Array, Array, float]:
    start, end = np.array(pipe.start, float), np.array(pipe.end, float)
    length = float(np.linalg.norm(end - start))
    return start, (end - start) / length, length


def _torus_of(elbow: Elbow) -> tuple[Array, Array, Array, float, float, float]:
    """Return centre, axis, first direction, angle, bend radius and tube radius of an elbow."""
    corner = np.array(elbow.intersection, float)
    come, go = corner - np.array(elbow.start, float), np.array(elbow.end, float) - corner
    if min(np.linalg.norm(come), np.linalg.norm(go)) == 0:
        raise InputError(elbow.id, "intersection", "coincides with an end of the elbow", "give the point where both axes meet")
    come, go = _unit(come), _unit(go)
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
