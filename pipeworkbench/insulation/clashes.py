# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where insulation comes too near to other insulation, bare components and obstacles, and what is cut out of it there.

Coverings that follow each other along the pipework touch by construction and are no clash. Along the axes near each other, such as both
sides of an elbow or a tee, they only clash where they overlap.
"""

from __future__ import annotations

import dataclasses
import heapq
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.bodies import covering_hulls, metal_hulls
from pipeworkbench.insulation.connections import BRANCH, Connections, End
from pipeworkbench.insulation.hulls import Hulls, Rows, block, cylinder, joined, near_pairs, signed_distances
from pipeworkbench.insulation.specification import Block, Obstacle, Specification
from pipeworkbench.pipeline import Tee, Vector
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import as_vector
from pipeworkbench.solids.coverings import AnyCovering, AnyNotch, BlockNotch, BoxCovering, Notch, StopCovering, TeeCovering
from pipeworkbench.solids.frames import Frame, local_point

NOTCH_AIR_MM = 5.0  # between what is cut and what it is cut for
TOUCH_MM = 1.0  # overlaps of neighbours that the misfits of measured pipework explain
DISC_POINTS = (12, 180)  # along the radius and around, where a disc is compared with what is cut
SAME = 1e-9

Kin = Literal["joined", "near", "far"]


@dataclass(frozen=True)
class Clash:
    """Two finished surfaces that are too near.

    ``a`` and ``b`` are coverings', bare components' or obstacles' ids; ``distance`` (mm) is negative where they overlap, then
    it is the least way by which they must be moved apart; ``point`` lies between both surfaces in the pipeline's frame (mm);
    ``least`` is the distance asked for; ``resolved`` "cut" where one of them is cut. ``largest_a`` and ``largest_b`` are the
    thicknesses (mm) of the layers with which ``a`` or ``b`` alone would keep that distance; None for what has none.
    """

    a: str
    b: str
    distance: float
    point: Vector
    least: float
    resolved: str = ""
    largest_a: float | None = None
    largest_b: float | None = None


@dataclass(frozen=True, eq=False)
class Resolved:
    """Coverings with what was cut out of them, the clashes, the nearest first, and what cannot be cut."""

    coverings: tuple[AnyCovering, ...]
    clashes: tuple[Clash, ...]
    problems: tuple[InputError, ...]


@dataclass(frozen=True, eq=False)
class _Body:
    """A covering, a bare component or an obstacle; ``components`` are those it belongs to, ``diameter`` (mm) decides who gives way."""

    id: str
    hulls: Hulls
    components: tuple[str, ...] = ()
    diameter: float = 0.0
    covering: AnyCovering | None = None
    obstacle: Obstacle | Block | None = None

    @property
    def thickness(self) -> float | None:
        return self.covering.thickness if self.covering else None


@dataclass(frozen=True, eq=False)
class _Meeting:
    """Two bodies that clash, and the rows of their parts that overlap."""

    one: int
    other: int
    clash: Clash
    rows: Rows
    other_rows: Rows


def resolved_clashes(
    coverings: Sequence[AnyCovering], connections: Connections, faces: Mapping[End, End], bare: Iterable[str], specification: Specification
) -> Resolved:
    """Return the clashes of a pipeline's insulation and cut away what overlaps.

    Of two coverings the one around the thicker component stays, of equal ones that of the smaller id; bare components
    and obstacles always stay.

    Parameters
    ----------
    coverings : sequence of Covering
    connections : Connections
    faces : mapping
        Open faces of flanges that belong together, as ends.
    bare : iterable of str
        Components without insulation.
    specification : Specification
        Least distance (mm) and obstacles.
    """
    bodies = _bodies(coverings, connections, bare, specification)
    kinship = _Kinship(connections, faces, bodies, specification.minimum_distance)
    meetings = _meetings(bodies, kinship, specification.minimum_distance)
    notches: dict[str, list[AnyNotch]] = {}
    problems, clashes = [], []
    for meeting in meetings:
        problem = _cut(meeting, bodies, connections, notches) if meeting.clash.distance < 0 else None
        problems += [problem] if problem else []
        clashes.append(dataclasses.replace(meeting.clash, resolved="cut" if meeting.clash.distance < 0 and not problem else ""))
    cut = tuple(dataclasses.replace(c, notches=(*c.notches, *notches[c.id])) if c.id in notches else c for c in coverings)
    cut = _with_stops_cut(cut)
    return Resolved(cut, tuple(sorted(clashes, key=lambda clash: clash.distance)), tuple(problems))


def _with_stops_cut(coverings: Sequence[AnyCovering]) -> tuple[AnyCovering, ...]:
    """Return coverings whose discs are cut where the insulation that they close is; discs of which nothing is left are left out."""
    closed = {c.component: c for c in coverings if not isinstance(c, StopCovering | BoxCovering)}
    kept: list[AnyCovering] = []
    for covering in coverings:
        if isinstance(covering, StopCovering) and covering.component in closed and closed[covering.component].notches:
            other, own = closed[covering.component].frame, covering.frame
            axes = np.array([[float(here @ there) for there in (other.x, other.y, other.z)] for here in (own.x, own.y, own.z)])
            notches = [notch.moved(axes, local_point(other, as_vector(own.origin))) for notch in closed[covering.component].notches]
            held: NDArray[np.bool_] = np.array([notch.holds(_disc_points(covering)) for notch in notches])
            if not held.any(axis=0).all():
                met = tuple(notch for notch, inside in zip(notches, held, strict=True) if inside.any())
                kept.append(dataclasses.replace(covering, notches=met))
        else:
            kept.append(covering)
    return tuple(kept)


def _disc_points(covering: StopCovering) -> Array:
    """Return points (n, 3) mm spread over a disc, in its own axes."""
    radii, angles = np.meshgrid(np.linspace(covering.radius, covering.outer_radius, DISC_POINTS[0]), np.linspace(0, 2 * math.pi, DISC_POINTS[1]))
    return np.stack([radii * np.cos(angles), radii * np.sin(angles), np.full(radii.shape, covering.total_thickness / 2)], axis=-1).reshape(-1, 3)


def _bodies(coverings: Sequence[AnyCovering], connections: Connections, bare: Iterable[str], specification: Specification) -> list[_Body]:
    components = connections.components
    bodies: list[_Body] = []
    for covering in coverings:
        if not isinstance(covering, StopCovering):
            members = covering.components if isinstance(covering, BoxCovering) else (covering.component,)
            diameter = components[covering.component].outer_diameter
            bodies.append(_Body(covering.id, covering_hulls(covering, len(bodies)), members, diameter, covering))
    for name in bare:
        try:
            hulls = metal_hulls(components[name], len(bodies))
        except InputError:
            # a problem of the component's, not of what is near it
            continue
        bodies.append(_Body(name, hulls, (name,), components[name].outer_diameter))
    bodies += [_Body(o.id, _obstacle(o, len(bodies) + number), obstacle=o) for number, o in enumerate(specification.obstacles)]
    return bodies


def _obstacle(obstacle: Obstacle | Block, owner: int) -> Hulls:
    if isinstance(obstacle, Block):
        return block(obstacle.lower, obstacle.upper, owner)
    radius = obstacle.diameter / 2
    return cylinder(np.array(obstacle.start), np.array(obstacle.end), radius, radius, owner)


class _Kinship:
    """How bodies belong together along the pipework, by walking from component to component."""

    def __init__(self, connections: Connections, faces: Mapping[End, End], bodies: Sequence[_Body], least: float) -> None:
        self.connections, self.bodies, self.least = connections, bodies, least
        self.neighbours: dict[str, set[str]] = {name: set() for name in connections.components}
        for (name, _), (other, _) in [*connections.partners.items(), *faces.items()]:
            self.neighbours[name].add(other)
        self.radius = [float(body.hulls.radius.max()) for body in bodies]
        self.walks: dict[int, dict[str, float]] = {}

    def of(self, one: int, other: int) -> Kin:
        """Return whether two bodies follow each other, are near along the pipework, or meet by chance."""
        members, others = self.bodies[one].components, self.bodies[other].components
        if not members or not others:
            return "far"
        if not {*members}.isdisjoint(others):
            return "joined"
        if any(not self.neighbours[name].isdisjoint(others) for name in members):
            return "near" if self._hole(one, other) or self._hole(other, one) else "joined"
        way = min((self._walk(one).get(name, math.inf) for name in others), default=math.inf)
        return "near" if way < self.least + self.radius[one] + self.radius[other] else "far"

    def _hole(self, one: int, other: int) -> bool:
        """Tell whether one is a tee with a mere hole for the branch, at which the other begins."""
        covering = self.bodies[one].covering
        if not isinstance(covering, TeeCovering) or covering.reach or self.bodies[other].covering is None:
            return False
        return self.connections.partners.get((covering.component, BRANCH), ("", 0))[0] in self.bodies[other].components

    def _walk(self, body: int) -> dict[str, float]:
        """Return the lengths (mm) of what lies between a body and other components, as far as that can matter (Dijkstra)."""
        if body not in self.walks:
            limit = self.least + 2 * max(self.radius)
            ways = dict.fromkeys(self.bodies[body].components, 0.0)
            queue = [(0.0, name) for name in ways]
            while queue:
                way, name = heapq.heappop(queue)
                if way > ways[name]:
                    continue
                inside = name in self.bodies[body].components
                onwards = way + (0.0 if inside else _length(self.connections, name))
                for other in self.neighbours[name] if onwards <= limit else ():
                    if onwards < ways.get(other, math.inf):
                        ways[other] = onwards
                        heapq.heappush(queue, (onwards, other))
            self.walks[body] = ways
        return self.walks[body]


def _length(connections: Connections, name: str) -> float:
    component = connections.components[name]
    return max(component.length, math.dist(component.intersection, component.branch_end)) if isinstance(component, Tee) else component.length


def _meetings(bodies: Sequence[_Body], kinship: _Kinship, least: float) -> list[_Meeting]:
    """Return all pairs of bodies that clash, of which one at least is a covering."""
    round_ones = [body.hulls for body in bodies if not isinstance(body.obstacle, Block)]
    blocks = [body.hulls for body in bodies if isinstance(body.obstacle, Block)]
    if not round_ones:
        return []
    hulls = joined(round_ones)
    meetings = _meetings_of(hulls, hulls, bodies, kinship, least)
    return meetings + (_meetings_of(hulls, joined(blocks), bodies, kinship, least) if blocks else [])


def _meetings_of(one: Hulls, other: Hulls, bodies: Sequence[_Body], kinship: _Kinship, least: float) -> list[_Meeting]:
    rows, columns = near_pairs(one, other, least)
    covered = np.array([body.covering is not None for body in bodies])
    first, second = one.owner[rows], other.owner[columns]
    good = (first < second) & (covered[first] | covered[second])
    rows, columns, first, second = rows[good], columns[good], first[good], second[good]
    pairs, number = np.unique(np.column_stack([first, second]), axis=0, return_inverse=True)
    kin = np.array([kinship.of(*pair) for pair in pairs.tolist()], object)
    asked = np.where(kin == "far", least, -TOUCH_MM)
    wanted = (kin != "joined")[number]
    rows, columns, number = rows[wanted], columns[wanted], number[wanted]
    distance, point = signed_distances(one[rows], other[columns], least)
    # the nearest parts of each pair come first
    order = np.lexsort((distance, number))
    found = []
    for group in np.split(order, np.flatnonzero(np.diff(number[order])) + 1) if len(order) else ():
        nearest = group[0]
        pair = number[nearest]
        if distance[nearest] >= asked[pair]:
            continue
        a, b = (bodies[index] for index in pairs[pair])
        clash = _clash(a, b, float(distance[nearest]), as_vector(point[nearest]), max(float(asked[pair]), 0.0))
        overlap = group[distance[group] < 0]
        own = (rows[overlap] - _first(one, pairs[pair][0]), columns[overlap] - _first(other, pairs[pair][1]))
        found.append(_Meeting(int(pairs[pair][0]), int(pairs[pair][1]), clash, *own))
    return found


def _first(hulls: Hulls, owner: int) -> int:
    """Return the row of an owner's first body; owners follow each other."""
    return int(np.searchsorted(hulls.owner, owner))


def _clash(a: _Body, b: _Body, distance: float, point: Vector, least: float) -> Clash:
    largest = [None if body.thickness is None else max(body.thickness + distance - least, 0.0) for body in (a, b)]
    return Clash(a.id, b.id, distance, point, least, largest_a=largest[0], largest_b=largest[1])


def _cut(meeting: _Meeting, bodies: Sequence[_Body], connections: Connections, notches: dict[str, list[AnyNotch]]) -> InputError | None:
    """Add what is cut out of either body; return the problem where that would bare metal."""
    loser, winner = bodies[meeting.one], bodies[meeting.other]
    rows, winner_rows = meeting.rows, meeting.other_rows
    if _stays(loser, winner):
        loser, winner, rows, winner_rows = winner, loser, winner_rows, rows
    if loser.covering is None:
        return None
    if winner.obstacle is not None and (problem := _bared(loser, winner, meeting.clash, connections)):
        return problem
    cause = winner.hulls[np.unique(winner_rows)]
    notches.setdefault(loser.covering.id, []).extend(_notches(loser.covering, loser.hulls[np.unique(rows)], winner.id, cause))
    if winner.covering is not None:
        metal = joined([metal_hulls(connections.components[name], 0) for name in loser.components])
        inside = _overlapping(winner.hulls, metal)
        if len(inside):
            notches.setdefault(winner.covering.id, []).extend(_notches(winner.covering, winner.hulls, loser.covering.component, metal[inside]))
    return None


def _stays(one: _Body, other: _Body) -> bool:
    """Tell whether the first of two bodies is left as it is and the second gives way."""
    if one.covering is None or other.covering is None:
        return one.covering is None
    return (-one.diameter, one.id) < (-other.diameter, other.id)


def _bared(body: _Body, obstacle: _Body, clash: Clash, connections: Connections) -> InputError | None:
    """Return the problem of a covering that an obstacle leaves nothing of."""
    metal = joined([metal_hulls(connections.components[name], 0) for name in body.components])
    distance, _ = signed_distances(metal, obstacle.hulls[np.zeros(len(metal), np.intp)])
    if distance.min() >= NOTCH_AIR_MM or body.covering is None:
        return None
    largest = math.floor(body.covering.thickness + clash.distance + SAME)
    problem = f"{body.covering.thickness:g} mm run into '{obstacle.id}', which is so near that a cut would bare the metal"
    remedy = f"give at most {largest} mm" if largest > 0 else "leave it bare or move the obstacle"
    return InputError(body.covering.component, "thickness", problem, remedy)


def _overlapping(one: Hulls, other: Hulls) -> Rows:
    """Return the rows of the second bodies that overlap any of the first."""
    rows, columns = near_pairs(one, other, 0.0)
    distance, _ = signed_distances(one[rows], other[columns], 0.0)
    return np.unique(columns[distance < 0])


def _notches(covering: AnyCovering, hulls: Hulls, cause: str, bodies: Hulls) -> list[AnyNotch]:
    """Return the room that bodies need in a covering, whose overlapping parts are ``hulls``, no longer than it is there."""
    if bodies.centres.shape[1] != 2:
        return [_block_notch(covering, hulls, cause, bodies)]
    return [_notch(covering, hulls, cause, bodies[np.array([row])]) for row in range(len(bodies))]


def _notch(covering: AnyCovering, hulls: Hulls, cause: str, body: Hulls) -> Notch:
    start, way = body.centres[0, 0], body.ways[0]
    length = float(np.linalg.norm(way))
    along = way / length
    sizes = np.linalg.norm([body.u[0], body.v[0]], axis=2)
    radius = float(sizes.min(axis=0).max())
    # a mitred end reaches further than the axis
    slope = math.sqrt(max(float(sizes.max()) ** 2 - radius**2, 0.0)) if float(sizes.min(axis=0).min()) == radius else 0.0
    directions = np.broadcast_to(np.stack([along, -along]), (len(hulls), 2, 3))
    reach = hulls.support(directions).max(axis=0)
    place = float(start @ along)
    first = max(-reach[1] - place, -slope) - NOTCH_AIR_MM
    last = min(reach[0] - place, length + slope) + NOTCH_AIR_MM
    ends = [local_point(covering.frame, as_vector(start + value * along)) for value in (first, last)]
    return Notch(cause, ends[0], ends[1], radius + NOTCH_AIR_MM)


def _block_notch(covering: AnyCovering, hulls: Hulls, cause: str, body: Hulls) -> BlockNotch:
    (low, high), (own_low, own_high) = body.bounds, hulls.bounds
    lower = np.maximum(low[0], own_low.min(axis=0)) - NOTCH_AIR_MM
    upper = np.minimum(high[0], own_high.max(axis=0)) + NOTCH_AIR_MM
    frame: Frame = covering.frame
    axes: Array = np.column_stack([frame.x, frame.y, frame.z])
    return BlockNotch(cause, Frame(local_point(frame, as_vector(lower)), *axes), upper - lower)
