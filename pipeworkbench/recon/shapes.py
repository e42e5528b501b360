# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as simple surfaces, in arrays: what a camera sees of them and what hides what.

A pipe is a frustum (with equal radii), an elbow a part of a torus, a flange frustums one behind the
other: raised face, plate and neck; a tee two pipes, a reducer a frustum, a cap a row of them on its ellipse. Ends are
closed with discs: pipework is opaque.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.bodies import (
    BEND,
    BRANCH_END,
    CAP,
    CORNER,
    ELBOW,
    END,
    FLANGE,
    PIPE,
    PLATE,
    RADIUS,
    REDUCER,
    SECOND,
    START,
    TEE,
    THICKNESS,
    Bodies,
    Rows,
)
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import dot

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


def _rows(surfaces: S, rows: NDArray[np.bool_] | Rows) -> S:
    """Return some of the surfaces."""
    return type(surfaces)(*(getattr(surfaces, f.name)[rows] for f in fields(surfaces)))


def shapes_of(components: Sequence[AnyComponent]) -> Shapes:
    """Return the surfaces of components; ``owner`` is the component's row.

    Raises
    ------
    InputError
        Where an elbow's ends, intersection and bend radius do not belong together.
    """
    return shapes_of_bodies(Bodies.of(components))


def shapes_of_bodies(bodies: Bodies) -> Shapes:
    """Do what :func:`shapes_of` does for components in arrays."""
    frustums = [*_pipes(bodies), *_flanges(bodies), *_caps(bodies)]
    part = np.concatenate([np.full(len(some.owner), some.name, object) for some in frustums])
    owner, start, end, radius = (np.concatenate([getattr(some, name) for some in frustums]) for name in ("owner", "start", "end", "radius"))
    # a component's surfaces follow each other
    order = np.argsort(owner, kind="stable")
    owner, start, end, radius, part = owner[order], start[order], end[order], radius[order], part[order]
    length = np.linalg.norm(end - start, axis=1)
    axis = (end - start) / length[:, None]
    tori = _tori(bodies)
    first_disc, last_disc = Circles(start, axis, radius[:, 0], owner), Circles(end, axis, radius[:, 1], owner)
    edges, edge_part = _flange_edges(bodies)
    return Shapes(
        Frustums(start, axis, length, radius, owner),
        tuple(part),
        tori,
        _together(first_disc, last_disc, *_ends_of_tori(tori)),
        edges,
        edge_part,
        len(bodies),
    )


class _Lateral(NamedTuple):
    """Frustums of one kind: their components' rows (k,), both ends' centres (k, 3), radii (k, 2)."""

    name: str
    owner: Rows
    start: Array
    end: Array
    radius: Array


def _lateral(name: str, owner: Rows, start: Array, end: Array, first: Array, last: Array) -> _Lateral:
    return _Lateral(name, owner, start, end, np.stack([first, last], axis=1))


def _pipes(bodies: Bodies) -> Iterator[_Lateral]:
    """Yield what is round from end to end: pipes, both parts of tees, reducers."""
    rows = bodies.rows(PIPE, TEE)
    radius = bodies.sizes[rows, RADIUS]
    yield _lateral("pipe", rows, bodies.points[rows, START], bodies.points[rows, END], radius, radius)
    rows = bodies.rows(TEE)
    radius = bodies.sizes[rows, SECOND]
    yield _lateral("branch", rows, bodies.points[rows, CORNER], bodies.points[rows, BRANCH_END], radius, radius)
    rows = bodies.rows(REDUCER)
    yield _lateral("cone", rows, bodies.points[rows, START], bodies.points[rows, END], bodies.sizes[rows, RADIUS], bodies.sizes[rows, SECOND])


def _flanges(bodies: Bodies) -> Iterator[_Lateral]:
    """Yield the rims of plates, raised faces, and what stands on plates: a hub, straight to its end, or a cone that tapers to the pipe."""
    rows = bodies.rows(FLANGE)
    front, back = _plates(bodies, rows)
    plate = bodies.sizes[rows, PLATE]
    yield _lateral("rim", rows, front, back, plate, plate)
    raised = bodies.details.raised[rows, 1] > 0
    radius = bodies.details.raised[rows[raised], 0]
    yield _lateral("raised face", rows[raised], bodies.points[rows[raised], START], front[raised], radius, radius)
    necked = bodies.details.beyond[rows] > 0
    rows, back = rows[necked], back[necked]
    axis, tube, beyond = -bodies.axis[rows], bodies.sizes[rows, RADIUS], bodies.details.beyond[rows]
    root, hubbed = neck_radius(bodies, rows), bodies.details.hubbed[rows]
    straight = np.where(hubbed, 0.0, np.minimum(bodies.details.straight[rows], beyond / 2))
    narrowed = back + (beyond - straight)[:, None] * axis
    yield _lateral("neck", rows, back, narrowed, root, np.where(hubbed, root, tube))
    there = straight > 0
    yield _lateral("neck", rows[there], narrowed[there], (back + beyond[:, None] * axis)[there], tube[there], tube[there])


def neck_radius(bodies: Bodies, flanges: Rows) -> Array:
    """Return the radii (m,), mm, of the necks of flanges (m,) where they leave their plates."""
    given = bodies.details.neck[flanges]
    return np.minimum(np.where(np.isnan(given), bodies.sizes[flanges, RADIUS], given), bodies.sizes[flanges, PLATE])


def _plates(bodies: Bodies, flanges: Rows) -> tuple[Array, Array]:
    """Return the centres (m, 3) of both ends of flanges' rims."""
    face, axis = bodies.points[flanges, START], -bodies.axis[flanges]
    return face + bodies.details.raised[flanges, 1, None] * axis, face + bodies.sizes[flanges, THICKNESS, None] * axis


def _flange_edges(bodies: Bodies) -> tuple[Circles, tuple[str, ...]]:
    """Return the sharp edges of flanges and their names, each component's together."""
    rows = bodies.rows(FLANGE)
    front, back = _plates(bodies, rows)
    raised = bodies.details.raised[rows, 1] > 0
    hubs = bodies.details.hubbed[rows] & (bodies.details.beyond[rows] > 0)
    end = bodies.points[rows, START] - bodies.flange_length(rows)[:, None] * bodies.axis[rows]
    plate = bodies.sizes[rows, PLATE]
    found = (
        ("face", rows, front, plate),
        ("back", rows, back, plate),
        ("raised face", rows[raised], bodies.points[rows[raised], START], bodies.details.raised[rows[raised], 0]),
        ("hub end", rows[hubs], end[hubs], neck_radius(bodies, rows[hubs])),
    )
    circles = _together(*(Circles(centre, -bodies.axis[owner], radius, owner) for _, owner, centre, radius in found))
    order = np.argsort(circles.owner, kind="stable")
    names = np.concatenate([np.full(len(owner), name, object) for name, owner, _, _ in found])
    return _rows(circles, order), tuple(names[order])


def _caps(bodies: Bodies) -> Iterator[_Lateral]:
    """Yield the straight parts of caps, and their dishes as cones one behind the other."""
    rows = bodies.rows(CAP)
    start, axis, radius, length = bodies.points[rows, START], bodies.axis[rows], bodies.sizes[rows, RADIUS], bodies.details.beyond[rows]
    dish = np.minimum(2 * DISH * radius, length)
    long = length > dish
    yield _lateral("pipe", rows[long], start[long], (start + (length - dish)[:, None] * axis)[long], radius[long], radius[long])
    turn = np.linspace(0, np.pi / 2, DISH_STEPS + 1)
    along, width = length[:, None] - dish[:, None] * (1 - np.sin(turn)), radius[:, None] * np.cos(turn)
    places = start[:, None] + along[:, :, None] * axis[:, None]
    for step in range(DISH_STEPS):
        yield _lateral("cap", rows, places[:, step], places[:, step + 1], width[:, step], width[:, step + 1])


def _tori(bodies: Bodies) -> Tori:
    """Return the bent parts of elbows; their angles are those between their axes."""
    rows = bodies.rows(ELBOW)
    corner = bodies.points[rows, CORNER]
    come, go = corner - bodies.points[rows, START], bodies.points[rows, END] - corner
    lengths = np.linalg.norm(come, axis=1), np.linalg.norm(go, axis=1)
    _refuse(bodies, rows[np.minimum(*lengths) == 0], "intersection", "coincides with an end of the elbow", "give the point where both axes meet")
    come, go = come / lengths[0][:, None], go / lengths[1][:, None]
    normal = np.cross(come, go)
    sine = np.linalg.norm(normal, axis=1)
    angle = np.arctan2(sine, dot(come, go))
    _refuse(bodies, rows[angle < np.radians(STRAIGHT_DEG)], "angle_deg", "the elbow does not bend", "leave it out: the pipes meet in a line")
    # perpendicular to the incoming axis in the bend's plane; anti-parallel axes have no plane
    turned_back = angle > np.pi - np.radians(STRAIGHT_DEG)
    _refuse(bodies, rows[turned_back], "angle_deg", "the elbow turns back on itself", "give both halves as elbows of their own")
    normal /= sine[:, None]
    inwards = np.cross(normal, come)
    # where both axes' tangent lengths agree with the bend radius, the centre lies beside the start
    bend, tube = bodies.sizes[rows, BEND], bodies.sizes[rows, RADIUS]
    return Tori(bodies.points[rows, START] + bend[:, None] * inwards, normal, -inwards, angle, bend, tube, rows)


def _refuse(bodies: Bodies, rows: Rows, key: str, problem: str, remedy: str) -> None:
    if len(rows):
        raise InputError(bodies.given[rows[0]].id, key, problem, remedy)


def _ends_of_tori(tori: Tori) -> Iterator[Circles]:
    second = tori.second
    for turn in (np.zeros(len(tori)), tori.angle):
        outwards = np.cos(turn)[:, None] * tori.first + np.sin(turn)[:, None] * second
        yield Circles(tori.centre + tori.bend_radius[:, None] * outwards, np.cross(tori.axis, outwards), tori.tube_radius, tori.owner)


def _together(*circles: Circles) -> Circles:
    return Circles(*(np.concatenate([getattr(some, f.name) for some in circles]) for f in fields(Circles)))
