# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random pipework that cameras see: runs of pipes and fittings of the standards' sizes that fit together exactly.

A run grows from an open end by one fitting and the pipe after it at a time, in directions along the edges and the faces'
diagonals of a cube. What would leave the pictures or cover what is there already is thrown away and tried anew;
two groups that lie apart in one picture cannot meet in space.
"""

import functools
import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from elbows_flanges import SAMPLE
from numpy.typing import NDArray
from scenes import DIRECTIONS, RIGHT_ANGLES
from scipy.spatial.transform import Rotation

from pipeworkbench import catalogue
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Joint, Pipe, Reducer, Tee
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.flange_variants import CURRENT_STANDARD, flange_of
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.vectors import as_vector, unit

DIAMETERS = (33.7, 42.4, 48.3, 60.3, 76.1, 88.9, 114.3, 139.7, 168.3)  # mm, EN 10220
CROWD = 40.0  # components of a station with which a diameter is as usual as it is thin
GASKET_MM = 2.0
FLANGE_TYPES = ("01", "11", "12")
ECCENTRIC = 0.3  # share of the reducers
KINDS = {"elbow": 0.4, "flanges": 0.2, "tee": 0.25, "reducer": 0.15}  # how often one follows a pipe
SIZES = {"elbow": 2, "flanges": 3, "tee": 3, "reducer": 2}  # components of a fitting with the pipes after it
CAPPED = 0.6  # share of the ends without another component
RUN = (6, 18)  # components after which a run ends
RANGE_MM = (3000.0, 6000.0)  # distance from the rig's first camera
LEGS_MM, LEGS_DIAMETERS = (90.0, 280.0), 0.4  # length of pipes, without and in addition what goes with the diameter
FORESHORTENED = np.cos(np.radians(30.0))  # of the angle between pipe and line of sight, at least: what is looked at from its end shows little
TURN_DEG = 8.0  # by which runs are turned against each other
TRIES, STARTS, LAST_STARTS = 24, 150, 1000  # of an end, of a new run, and of one at the last level
COARSER = 12  # pixels of the pictures in one of the masks
GAPS_PX = (40.0, 12.0, 6.0)  # between groups that do not touch, in the order in which they are tried
CROSSED = 0.25  # share of a group's area in a picture that may cross others at the last
LENS_PX = 12.0  # what lenses distort the places of components by, at most; they grow as if there were no distortion
STEP_MM = 60.0  # between points of axes
SPACING_MM = 1150.0  # between a plant's stations: neighbours see a good part of what one sees


def rig(position: Array, heading: float, name: str = "") -> tuple[Camera, ...]:
    """Return three calibrated cameras as the sample's rig has them: left, right and top, 650 mm apart, turned to each other.

    Parameters
    ----------
    position : (3,) array
        Projection centre of the first camera, mm.
    heading : float
        Turn of the whole about the plumb line, rad; with 0 the cameras look along y.
    name : str
        What the cameras' names begin with.
    """
    turn = Rotation.from_euler("z", heading).as_matrix()
    return tuple(
        replace(one, name=f"{name}{one.name}", rotation=one.rotation @ turn.T, projection_centre=turn @ one.projection_centre + np.asarray(position))
        for one in read_station(SAMPLE).cameras
    )


def simulated_pipeline(
    random: np.random.Generator, count: int, cameras: Sequence[Camera] | None = None
) -> tuple[tuple[AnyComponent, ...], tuple[Joint, ...]]:
    """Return so many components in runs, and their joints, at 3 to 6 m before cameras that see all of them.

    Parameters
    ----------
    random : Generator
    count : int
        Components in total.
    cameras : sequence of Camera, optional
        Of one rig; default: the sample's at the origin.

    Raises
    ------
    RuntimeError
        Where there is no room for so many.
    """
    return _grown(_Room.of(cameras if cameras is not None else rig(np.zeros(3), 0.0)), count, random, 0)


def plant(
    random: np.random.Generator, components: int = 1000, stations: int = 12
) -> tuple[tuple[AnyComponent, ...], tuple[Joint, ...], tuple[tuple[Camera, ...], ...]]:
    """Return a long plant: components, their joints and the cameras of the stations before it, which see a part of it each.

    Every run is before all cameras of one station; the neighbours see some of it too.
    """
    rigs = tuple(rig(np.array([SPACING_MM * number, 0.0, 0.0]), 0.0, f"{number} ") for number in range(stations))
    masks = [_Room.of(cameras).taken for cameras in rigs]
    shares = np.diff(np.rint(np.linspace(0, components, stations + 1)).astype(int))
    every: tuple[AnyComponent, ...] = ()
    joints: tuple[Joint, ...] = ()
    for number, share in enumerate(shares):
        # two stations further on nothing is seen of what this one sees
        near = [number, *(other for other in range(number - 2, number + 3) if other != number and 0 <= other < stations)]
        room = _Room(
            tuple(itertools.chain.from_iterable(rigs[one] for one in near)),
            tuple(itertools.chain.from_iterable(masks[one] for one in near)),
            len(rigs[number]),
        )
        made, between = _grown(room, int(share), random, len(every))
        every, joints = every + made, joints + between
    return every, joints, rigs


@dataclass(frozen=True, eq=False)
class _Room:
    """What the pictures of cameras show already.

    The first ``own`` cameras must see all that grows; ``taken`` are masks (rows, columns), one for each camera, which change.
    """

    cameras: tuple[Camera, ...]
    taken: tuple[NDArray[np.uint8], ...]
    own: int

    @classmethod
    def of(cls, cameras: Sequence[Camera]) -> "_Room":
        """Return the empty room before the cameras of one station."""
        shapes = [(camera.interior.height // COARSER, camera.interior.width // COARSER) for camera in cameras]
        return cls(tuple(cameras), tuple(np.zeros(shape, np.uint8) for shape in shapes), len(cameras))

    def shows(self, components: Sequence[AnyComponent]) -> bool:
        """Tell whether all of the components lies before the own cameras, at a good distance and, for pipes, seen from aside."""
        centre = self.cameras[0].projection_centre
        axes = [axis for component in components for axis in spines(component)]
        every = np.concatenate([points for points, _ in axes])
        distance = np.linalg.norm(every - centre, axis=1)
        if distance.min() < RANGE_MM[0] or distance.max() > RANGE_MM[1]:
            return False
        for pipe in (one for one in components if isinstance(one, Pipe)):
            if abs(unit(np.subtract(pipe.end, pipe.start)) @ unit(np.add(pipe.end, pipe.start) / 2 - centre)) > FORESHORTENED:
                return False
        radius = np.repeat([diameter / 2 for _, diameter in axes], [len(points) for points, _ in axes])
        pixels, scale = self._seen(every)
        own = zip(self.cameras[: self.own], pixels, scale, strict=False)
        return all(camera.sees(simple, radius * magnified + LENS_PX).all() for camera, simple, magnified in own)

    @functools.cached_property
    def _matrices(self) -> Array:
        """Points in space to homogeneous pixels (c, 3, 4) without the lenses' distortion: many times faster, a few pixels off."""
        matrices = []
        for camera in self.cameras:
            calibration = np.diag([camera.interior.pixels_per_radian] * 2 + [1.0])
            calibration[:2, 2] = camera.interior.pixels(np.zeros((1, 2)))[0]
            matrices.append(calibration @ np.column_stack([camera.rotation, -camera.rotation @ camera.projection_centre]))
        return np.array(matrices)

    def _seen(self, points: Array) -> tuple[Array, Array]:
        """Return about where points (n, 3) are in all pictures (c, n, 2) and px per mm there (c, n)."""
        x, y, z = np.moveaxis(self._matrices[:, :, :3] @ points.T + self._matrices[:, :, 3:], 1, 0)
        return np.stack([x, y], axis=2) / z[:, :, None], np.array([[one.interior.pixels_per_radian] for one in self.cameras]) / z

    def outlines(self, components: Sequence[AnyComponent], gap: float) -> Iterator[NDArray[np.uint8]]:
        """Yield a mask of what each camera sees of components, wider by ``gap`` px on all sides."""
        axes = [axis for component in components for axis in spines(component)]
        last = np.cumsum([len(points) for points, _ in axes])
        pixels, scale = self._seen(np.concatenate([points for points, _ in axes]))
        # in the masks pixel centres are at integers too
        drawn = np.rint((pixels + 0.5) / COARSER - 0.5).astype(np.int32)
        for number, taken in enumerate(self.taken):
            mask = np.zeros_like(taken)
            for (points, diameter), stop in zip(axes, last, strict=True):
                width = (diameter * scale[number, stop - 1] + 2 * gap) / COARSER
                cv2.polylines(mask, [drawn[number, stop - len(points) : stop]], isClosed=False, color=1, thickness=int(np.ceil(width)))
            yield mask

    def has_place(self, components: Sequence[AnyComponent], before: Sequence[NDArray[np.uint8]] | None, level: int) -> bool:
        """Tell whether components cover nothing but what they grow from, ``before``.

        At the last level they need not be free in more than one of the own pictures, and cross others in the rest.
        """
        masks = zip(self.outlines(components, GAPS_PX[level]), self.taken, before or itertools.repeat(np.uint8(0)), strict=False)
        # no further picture is looked at than needed
        covered = (np.count_nonzero(wanted & taken & ~own) / max(np.count_nonzero(wanted), 1) for wanted, taken, own in masks)
        if level < len(GAPS_PX) - 1:
            return not any(covered)
        shares = list(itertools.islice(covered, self.own))
        return min(shares) == 0 and max(shares) < CROSSED

    def take(self, components: Sequence[AnyComponent]) -> None:
        """Enter components."""
        for taken, mask in zip(self.taken, self.outlines(components, 0.0), strict=True):
            np.maximum(taken, mask, out=taken)


@dataclass(frozen=True, eq=False)
class _End:
    """An open end: its place and direction (3,), mm, its diameter, the directions (18, 3) of its run and masks of the pipe that it ends."""

    point: Array
    direction: Array
    diameter: float
    directions: Array
    before: tuple[NDArray[np.uint8], ...] | None = None

    def at(self, point: Array, direction: Array | None = None, diameter: float | None = None) -> "_End":
        """Return another end of the same run."""
        return _End(point, self.direction if direction is None else direction, diameter or self.diameter, self.directions)

    def turned(self, angle_deg: float, random: np.random.Generator) -> Array:
        """Return one of the run's directions (3,) that has this angle with the end's."""
        fits = np.abs(self.directions @ self.direction - np.cos(np.radians(angle_deg))) < 1e-6
        return random.choice(self.directions[fits])


# the components of a group, whose pipes come last, and the open ends of these pipes
_Group = tuple[list[AnyComponent], list[_End]]


def _grown(room: _Room, count: int, random: np.random.Generator, first: int) -> tuple[tuple[AnyComponent, ...], tuple[Joint, ...]]:
    """Return components in a room, numbered from ``first`` on, and their joints."""
    made: list[AnyComponent] = []
    joints: list[Joint] = []
    ends: list[tuple[_End, tuple[str, int]]] = []  # with the port that is open there
    level, of_run, longest = 0, 0, 0
    while len(made) < count:
        group: _Group | None = None
        end, port = ends.pop() if ends else (None, None)
        if end is None:
            of_run, longest = 0, int(random.integers(*RUN))
            group, level = _started(room, count, level, random)
        elif of_run < longest:
            group = _continued(room, end, count - len(made), level, random)
        if group is None and end is not None and random.uniform() < CAPPED:
            group = _fitting(room, end, _cap, level, random)
        if group is None:
            continue
        components, opened = group
        named = [replace(one, id=f"{one.kind[0].upper()}{first + len(made) + row:04d}") for row, one in enumerate(components)]
        joints += _joints(named, port)
        room.take(named)
        made += named
        of_run += len(named)
        # the last pipes are those with the ends, in their order
        for one, pipe in zip(opened, named[len(named) - len(opened) :], strict=True):
            ends.append((replace(one, before=tuple(room.outlines([pipe], max(GAPS_PX)))), (pipe.id, 1)))
    return tuple(made), tuple(joints)


def _started(room: _Room, count: int, level: int, random: np.random.Generator) -> tuple[_Group, int]:
    """Return the first pipe of a new run, and the level at which there was room for it."""
    camera = room.cameras[0]
    usual = (DIAMETERS[0] / np.array(DIAMETERS)) ** (count / CROWD)
    for relaxed in range(level, len(GAPS_PX)):
        for _ in range(STARTS if relaxed < len(GAPS_PX) - 1 else LAST_STARTS):
            pixel = random.uniform((0, 0), (camera.interior.width, camera.interior.height))
            point = camera.projection_centre + random.uniform(*RANGE_MM) * camera.rays(pixel)[0]
            turn = Rotation.from_rotvec(np.radians(random.uniform(-TURN_DEG, TURN_DEG, 3)))
            directions = turn.apply(DIRECTIONS)
            end = _End(point, random.choice(directions), float(random.choice(DIAMETERS, p=usual / usual.sum())), directions)
            group = _fitting(room, end, _with_pipes, relaxed, random)
            if group is not None:
                return group, relaxed
    raise RuntimeError(f"no room for {count} components before these cameras")


def _continued(room: _Room, end: _End, most: int, level: int, random: np.random.Generator) -> _Group | None:
    """Return a fitting at an end with pipes after it, ``most`` components at most, None where nothing has room."""
    kinds = [kind for kind in KINDS if SIZES[kind] <= most]
    if not kinds:
        return None
    makers = {"elbow": _elbow, "flanges": _flanges, "tee": _tee, "reducer": _reducer}
    share = np.array([KINDS[kind] for kind in kinds])
    options = (_fitting(room, end, makers[kind], level, random) for kind in random.choice(kinds, TRIES, p=share / share.sum()))
    return next((group for group in options if group is not None), None)


def _fitting(
    room: _Room, end: _End, make: Callable[[_End, np.random.Generator], _Group | None], level: int, random: np.random.Generator
) -> _Group | None:
    """Return what is made at an end, None where it cannot be or has no room."""
    group = make(end, random)
    return group if group is not None and room.shows(group[0]) and room.has_place(group[0], end.before, level) else None


def _with_pipes(end: _End, random: np.random.Generator, fittings: Sequence[AnyComponent] = (), others: Sequence[_End] = ()) -> _Group:
    """Return fittings with a pipe at their end, and at the other ones that they have."""
    components, ends = list(fittings), []
    for one in (end, *others):
        stop = one.point + (random.uniform(*LEGS_MM) + LEGS_DIAMETERS * one.diameter) * one.direction
        components.append(Pipe(id="", start=as_vector(one.point), end=as_vector(stop), **_size(one.diameter)))
        ends.append(one.at(stop))
    return components, ends


def _elbow(end: _End, random: np.random.Generator) -> _Group | None:
    angle_deg = 90.0 if random.uniform() < RIGHT_ANGLES else 45.0
    bend = _one_of(catalogue.bends(end.diameter), random)
    go = end.turned(angle_deg, random)
    tangent = bend.bend_radius * np.tan(np.radians(angle_deg) / 2)
    corner = end.point + tangent * end.direction
    elbow = Elbow(
        id="",
        start=as_vector(end.point),
        end=as_vector(corner + tangent * go),
        intersection=as_vector(corner),
        angle_deg=angle_deg,
        bend_radius=bend.bend_radius,
        bend_type=bend.bend_type,
        **_size(end.diameter),
    )
    return _with_pipes(end.at(corner + tangent * go, go), random, [elbow])


def _flanges(end: _End, random: np.random.Generator) -> _Group | None:
    """Return two flanges that face each other, with a gasket between them."""
    row = _one_of(_flange_rows(end.diameter), random)
    raised = bool(row.raised_face_height and row.raised_face_diameter)
    face = end.point + row.length * end.direction
    other = face + GASKET_MM * end.direction
    flanges = [
        flange_of(row, face, end.direction, end.diameter, "", raised=raised),
        flange_of(row, other, -end.direction, end.diameter, "", raised=raised),
    ]
    return _with_pipes(end.at(other + row.length * end.direction), random, flanges)


@functools.cache
def _flange_rows(diameter: float) -> tuple[catalogue.FlangeDimensions, ...]:
    """Return the flanges that sit on a pipe of this outside diameter (mm)."""
    known = (row for row in catalogue.flanges_of_pipe(diameter) if row.is_complete and row.standard == CURRENT_STANDARD)
    return tuple(row for row in known if row.flange_type in FLANGE_TYPES)


def _reducer(end: _End, random: np.random.Generator) -> _Group | None:
    """Return a reducer to a narrower or a wider pipe."""
    sizes = {end.diameter, *DIAMETERS}
    rows = [row for row in catalogue.catalogue().records(catalogue.Reducer) if {row.large_diameter, row.small_diameter} <= sizes]
    row = _one_of([row for row in rows if end.diameter in (row.large_diameter, row.small_diameter)], random)
    narrows = row.large_diameter == end.diameter
    eccentric = random.uniform() < ECCENTRIC
    aside = eccentric * (row.large_diameter - row.small_diameter) / 2 * end.turned(90.0, random)
    stop = end.point + row.length * end.direction + aside
    reducer = Reducer(
        id="",
        start=as_vector(end.point if narrows else stop),
        end=as_vector(stop if narrows else end.point),
        axis=as_vector(end.direction if narrows else -end.direction),
        end_diameter=row.small_diameter,
        reducer_type="eccentric" if eccentric else "concentric",
        **_size(row.large_diameter),
    )
    return _with_pipes(end.at(stop, diameter=row.small_diameter if narrows else row.large_diameter), random, [reducer])


def _tee(end: _End, random: np.random.Generator) -> _Group | None:
    row = _one_of([tee for size in DIAMETERS for tee in catalogue.tees(end.diameter, size) if tee.branch_length is not None], random)
    side = end.turned(90.0, random)
    middle = end.point + row.run_length * end.direction
    stop, branch_end = middle + row.run_length * end.direction, middle + row.branch_length * side
    tee = Tee(
        id="",
        start=as_vector(end.point),
        end=as_vector(stop),
        intersection=as_vector(middle),
        branch_end=as_vector(branch_end),
        branch_diameter=row.branch_diameter,
        **_size(end.diameter),
    )
    return _with_pipes(end.at(stop), random, [tee], [end.at(branch_end, side, row.branch_diameter)])


def _cap(end: _End, random: np.random.Generator) -> _Group | None:
    row = _one_of(catalogue.caps(end.diameter), random)
    return [Cap(id="", start=as_vector(end.point), axis=as_vector(end.direction), length=row.height, **_size(end.diameter))], []


def _one_of(rows: Sequence, random: np.random.Generator):
    """Return one of the catalogue's rows."""
    return rows[random.integers(len(rows))]


def _size(diameter: float) -> dict:
    """Return what components say of their pipe's size."""
    return {"outer_diameter": diameter, "dn": catalogue.pipe_size(diameter).dn}


def _joints(group: Sequence[AnyComponent], port: tuple[str, int] | None) -> list[Joint]:
    """Return the joints of a group that grows from a port of another component, None for the first of a run."""
    head, pipes = group[0], [one for one in group[1:] if isinstance(one, Pipe)]
    # what a component is entered by; a flange by its weld end, and by its face from the one before it
    entered = {Flange: 1}.get(type(head), 0)
    if isinstance(head, Reducer) and pipes and pipes[0].outer_diameter == head.outer_diameter:
        entered = 1
    joints = [Joint(a=port[0], a_port=port[1], b=head.id, b_port=entered)] if port is not None else []
    if isinstance(head, Flange):
        other = group[1]
        return [*joints, Joint(a=head.id, a_port=0, b=other.id, b_port=0), Joint(a=other.id, a_port=1, b=pipes[0].id, b_port=0)]
    # a tee's branch is its third port
    leaving = (1 - entered, 2)
    return joints + [Joint(a=head.id, a_port=way, b=pipe.id, b_port=0) for way, pipe in zip(leaving, pipes, strict=False)]


def spines(component: AnyComponent) -> list[tuple[Array, float]]:
    """Return points (n, 3) along a component's axes and the diameters (mm) around them, about what cameras see."""
    match component:
        case Elbow():
            part = np.linspace(0, 1, 6)[:, None]
            start, corner, end = (np.array(point) for point in (component.start, component.intersection, component.end))
            return [((1 - part) ** 2 * start + 2 * part * (1 - part) * corner + part**2 * end, component.outer_diameter)]
        case Flange():
            face = np.array(component.face)
            return [(np.array([face, face - component.length * unit(component.axis)]), component.D)]
        case Cap():
            start = np.array(component.start)
            return [(np.array([start, start + component.length * unit(component.axis)]), component.outer_diameter)]
        case Tee():
            branch = _between(component.intersection, component.branch_end), component.branch_diameter
            return [(_between(component.start, component.end), component.outer_diameter), branch]
        case _:
            return [(_between(component.start, component.end), component.outer_diameter)]


def _between(start: Sequence[float], end: Sequence[float]) -> Array:
    """Return points (n, 3) from one to another."""
    count = int(np.ceil(np.linalg.norm(np.subtract(end, start)) / STEP_MM)) + 1
    return np.linspace(start, end, count)
