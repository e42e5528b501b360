# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pseudo-observations: continuity at the joints (Sect. 7.2), standard sizes, what is level, plumb or square.

Each is a row of the observation equations: what is observed minus what the components say, and how that changes
with their motions.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.adjustment.charts import MOTION, RIGID, Ports, port_places, ports_of
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.bodies import ANGLE, ELBOW, END, FLANGE, PIPE, SIZE_NAMES, START, Bodies, Flags, Rows, unit_of
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.vectors import axes_across, dot, unit

SAME_DIAMETER = 0.02  # relative; what differs by more is a change of diameter, not an error
TOLERANCE_SIGMAS = 2.0  # a tolerance holds for 95 %
FREE_SIGMA = 1e4  # mm or rad; keeps sizes that nothing observes from being undetermined in the numbers alone
LEAST_PLACE_SIGMA = 0.05  # mm
UP = np.array([0.0, 0.0, 1.0])
RIGHT_ANGLE = np.pi / 2
STANDARD_ANGLES = np.radians((45.0, 90.0))
STANDARD_ANGLE_WITHIN = np.radians(3.0)
NO_JOINT = -1
NOBODY = -1  # the second component of an observation of one


@dataclass(frozen=True, eq=False)
class Observed:
    """Pseudo-observations, r in number.

    bodies (r, 2) rows of the components that they are of, the second NOBODY where there is only one; derivative (r, 2, 9) by their motions;
    misclosure and sigma (r,) in mm or rad; joint (r,) the number of the joint that they belong to, NO_JOINT for others; exact (r,) tells
    conditions from soft ones; subject (r,) and label (r,) say in words what they are.
    """

    bodies: Rows
    derivative: Array
    misclosure: Array
    sigma: Array
    joint: Rows
    exact: Flags
    subject: tuple[str, ...]
    label: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.sigma)

    @property
    def what(self) -> tuple[str, ...]:
        """What they are, in words."""
        return tuple(f"{subject}: {label}" for subject, label in zip(self.subject, self.label, strict=True))

    @property
    def telling(self) -> Flags:
        """Which (r,) say more than next to nothing."""
        return np.asarray(self.sigma < FREE_SIGMA / 2)

    @property
    def soft(self) -> Flags:
        """Which (r,) of these are no exact conditions."""
        return np.asarray(~self.exact & self.telling)

    @property
    def squares(self) -> Array:
        """Their weighted squares (r,)."""
        return np.asarray((self.misclosure / self.sigma) ** 2)

    def __getitem__(self, rows: Flags) -> Observed:
        words: dict[str, Any] = {name: tuple(np.array(getattr(self, name), object)[rows]) for name in _WORDS}
        return Observed(**{name: getattr(self, name)[rows] for name in _ARRAYS}, **words)


_ARRAYS = ("bodies", "derivative", "misclosure", "sigma", "joint", "exact")
_WORDS = ("subject", "label")


def _of_one(subject: Sequence[str], label: Sequence[str] | str, rows: Rows, derivative: Array, misclosure: Array, sigma: Array) -> Observed:
    """Return soft observations (r,) of one component each, with derivatives (r, 9)."""
    count = len(rows)
    bodies, both = np.full((count, 2), NOBODY), np.zeros((count, 2, MOTION))
    bodies[:, 0], both[:, 0] = rows, derivative
    labels = (label,) * count if isinstance(label, str) else tuple(label)
    return Observed(bodies, both, misclosure, sigma, np.full(count, NO_JOINT), np.zeros(count, bool), tuple(subject), labels)


def _joined(parts: Sequence[Observed]) -> Observed:
    words: dict[str, Any] = {name: tuple(itertools.chain.from_iterable(getattr(part, name) for part in parts)) for name in _WORDS}
    return Observed(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in _ARRAYS}, **words)


@dataclass(frozen=True, eq=False)
class Links:
    """Joints, j in number: number (j,) in the problem; bodies (j, 2) rows and port (j, 2) numbers of what meets; name (j,)."""

    number: Rows
    bodies: Rows
    port: Rows
    name: tuple[str, ...]

    @classmethod
    def of(cls, problem: Problem, joints: Sequence[int]) -> Links:
        """Return those of a problem's joints that count."""
        row = {component.id: number for number, component in enumerate(problem.components)}
        ours = [problem.joints[number] for number in joints]
        bodies = np.array([(row[joint.a], row[joint.b]) for joint in ours], np.intp).reshape(-1, 2)
        port = np.array([(joint.a_port, joint.b_port) for joint in ours], np.intp).reshape(-1, 2)
        return cls(np.array(joints, np.intp), bodies, port, tuple(f"{joint.a} - {joint.b}" for joint in ours))

    def faces(self, bodies: Bodies) -> Flags:
        """Return at which joints (j,) the faces of two flanges meet."""
        return np.asarray((bodies.kind[self.bodies] == FLANGE).all(axis=1) & (self.port == 0).all(axis=1))


@dataclass(frozen=True, eq=False)
class _Sizes:
    """Observed sizes, s in number: their components' rows, columns, values and standard deviations in the arrays' own units, what they are called."""

    row: Rows
    column: Rows
    value: Array
    sigma: Array
    subject: tuple[str, ...]
    name: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Places:
    """Observed places of pipes, p in number.

    row (p,); the middles (p, 3) where they were, mm, two ways across (p, 2, 3) with their sigmas (p, 2), mm; two ways (p, 2, 3) by which their
    directions are observed, with sigmas (p,) in rad, infinite where they are not.
    """

    row: Rows
    middle: Array
    way: Array
    sigma: Array
    turn: Array
    turn_sigma: Array
    subject: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Conditions:
    """All that is said of components besides the images, for one choice of unknowns and of joints that count."""

    links: Links
    settings: AdjustmentSettings
    free: Flags
    sizes: _Sizes
    places: _Places

    @classmethod
    def of(cls, problem: Problem, free: Sequence[frozenset[str]], joints: Sequence[int], settings: AdjustmentSettings) -> Conditions:
        """Return what is known of a problem; ``free`` names for each component the parameters that are unknowns."""
        return cls(
            Links.of(problem, joints), settings, np.array([bool(names) for names in free], bool), _sizes(problem, free, settings), _places(problem)
        )

    def without_alignment(self) -> Conditions:
        """Return the same, but that nothing need be level, plumb or square."""
        return replace(self, settings=replace(self.settings, aligned=False))

    def at(self, bodies: Bodies) -> Observed:
        """Return the pseudo-observations of the components as they are now."""
        parts = [self._of_joints(bodies), self._of_sizes(bodies), *self._of_places(bodies)]
        if self.settings.aligned:
            parts += self._of_directions(bodies)
        return _joined(parts)

    def _of_joints(self, bodies: Bodies) -> Observed:
        """Return the conditions of joints: no offset across a pipe's axis, or none at all; the same direction; the same radius."""
        links, settings = self.links, self.settings
        count = len(links.number)
        a, b = (ports_of(bodies, links.bodies[:, side], links.port[:, side]) for side in (0, 1))
        pipe = bodies.kind[links.bodies] == PIPE
        # a pipe may end anywhere along its axis, but one that is fixed ends where it ends
        slides = (pipe & self.free[links.bodies]).any(axis=1)
        faces = links.faces(bodies)
        # the axis is the first one's where that is a pipe
        turning = pipe[:, 0]
        axis = np.where(turning[:, None], a.direction, b.direction)
        ways = np.stack([*perpendicular_axes(axis), axis], axis=1) if count else np.zeros((0, 3, 3))
        apart = b.point - a.point
        derivative, misclosure = np.zeros((count, 6, 2, MOTION)), np.zeros((count, 6))
        # w = S2 - E1 (Eq. 14) along ways that turn with one of both
        misclosure[:, :3] = -np.einsum("jwi,ji->jw", ways, apart)
        derivative[:, :3, 0], derivative[:, :3, 1] = -ways @ a.by_motion[:, :3], ways @ b.by_motion[:, :3]
        turns = np.cross(ways, apart[:, None])
        derivative[turning, :3, 0, 3:RIGID] += turns[turning]
        derivative[~turning, :3, 1, 3:RIGID] += turns[~turning]
        misclosure[:, 3:5] = -np.einsum("jwi,ji->jw", ways[:, :2], a.direction + b.direction)
        derivative[:, 3:5, 0], derivative[:, 3:5, 1] = ways[:, :2] @ a.by_motion[:, 3:6], ways[:, :2] @ b.by_motion[:, 3:6]
        # one more: the gasket between two faces, else the radius
        misclosure[:, 5] = np.where(faces, settings.gasket - dot(apart, a.direction), b.radius - a.radius)
        derivative[:, 5] = np.where(faces[:, None, None], _gaskets(a, b, apart), np.stack([a.by_motion[:, 6], -b.by_motion[:, 6]], axis=1))
        alike = np.abs(a.radius - b.radius) <= SAME_DIAMETER * np.maximum(a.radius, b.radius)
        there = np.ones((count, 6), bool)
        there[:, 2], there[:, 5] = ~faces & ~slides, faces | alike
        sigma = np.tile([settings.offset_sigma] * 3 + [settings.turn_sigma] * 2 + [settings.offset_sigma], (count, 1))
        sigma[faces, 5] = settings.gasket_sigma
        exact = np.ones((count, 6), bool)
        exact[faces, 5] = False
        joint, column = np.nonzero(there)
        label = np.array(["offset", "offset", "offset", "direction", "direction", "diameter", "gasket"], object)
        words = label[np.where((column == 5) & faces[joint], 6, column)]
        return Observed(
            links.bodies[joint],
            derivative[there],
            misclosure[there],
            sigma[there],
            links.number[joint],
            exact[there],
            tuple(links.name[number] for number in joint),
            tuple(words),
        )

    def _of_sizes(self, bodies: Bodies) -> Observed:
        """Return the pseudo-observations of sizes that are unknowns."""
        sizes = self.sizes
        derivative = np.zeros((len(sizes.row), MOTION))
        derivative[np.arange(len(sizes.row)), RIGID + sizes.column] = 1.0
        return _of_one(sizes.subject, sizes.name, sizes.row, derivative, sizes.value - bodies.sizes[sizes.row, sizes.column], sizes.sigma)

    def _of_places(self, bodies: Bodies) -> Iterator[Observed]:
        """Yield the pseudo-observations of where pipes were: both parts of position and direction across the axis."""
        places = self.places
        here = bodies.directions(places.row)
        reference = (bodies.points[places.row, START] + bodies.points[places.row, END]) / 2
        # the axis' point that was the middle
        beside = reference + dot(places.middle - reference, here)[:, None] * here
        for way, sigma in zip(np.swapaxes(places.way, 0, 1), places.sigma.T, strict=True):
            derivative = np.zeros((len(way), MOTION))
            derivative[:, :3], derivative[:, 3:RIGID] = way, np.cross(beside - reference, way)
            yield _of_one(places.subject, "place", places.row, derivative, dot(places.middle - beside, way), sigma)
        for way in np.swapaxes(places.turn, 0, 1):
            observed = _of_one(places.subject, "direction", places.row, _turning(way, here), -dot(here, way), places.turn_sigma)
            yield observed[np.isfinite(places.turn_sigma)]

    def _of_directions(self, bodies: Bodies) -> Iterator[Observed]:
        """Yield weak pseudo-observations of runs that are nearly level or plumb and of bends that are nearly square."""
        within, sigma = np.radians(self.settings.aligned_within_deg), np.radians(self.settings.aligned_sigma_deg)
        pipes = bodies.rows(PIPE)
        direction = bodies.directions(pipes)
        height = direction @ UP
        level, plumb = np.abs(height) < np.sin(within), np.abs(height) > np.cos(within)
        for there, label, ways in ((level, "level", (UP,)), (plumb, "plumb", axes_across(UP))):
            rows, along = pipes[there], direction[there]
            names = [bodies.given[row].id for row in rows]
            for way in ways:
                yield _of_one(names, label, rows, _turning(way, along), -along @ way, np.full(len(rows), sigma))
        elbows = bodies.rows(ELBOW)
        elbows = elbows[np.abs(bodies.sizes[elbows, ANGLE] - RIGHT_ANGLE) < within]
        derivative = np.zeros((len(elbows), MOTION))
        derivative[:, RIGID + ANGLE] = 1.0
        off = RIGHT_ANGLE - bodies.sizes[elbows, ANGLE]
        yield _of_one([bodies.given[row].id for row in elbows], "square", elbows, derivative, off, np.full(len(elbows), sigma))


def _gaskets(a: Ports, b: Ports, apart: Array) -> Array:
    """Return how the distances of faces along the first one's axis change with both components' motions: (j, 2, 9)."""
    by_one = -np.einsum("ji,jik->jk", a.direction, a.by_motion[:, :3])
    by_one[:, 3:RIGID] += np.cross(a.direction, apart)
    return np.stack([by_one, np.einsum("ji,jik->jk", a.direction, b.by_motion[:, :3])], axis=1)


def _turning(way: Array, direction: Array) -> Array:
    """Return how the part of directions (p, 3) along ways (3,) or (p, 3) changes with the motion (p, 9): way (w x d) = w (d x way)."""
    derivative = np.zeros((len(direction), MOTION))
    derivative[:, 3:RIGID] = np.cross(direction, way)
    return derivative


def _sizes(problem: Problem, free: Sequence[frozenset[str]], settings: AdjustmentSettings) -> _Sizes:
    found = []
    for row, (component, names) in enumerate(zip(problem.components, free, strict=True)):
        given = problem.observed.get(component.id, {})
        for column, name in enumerate(SIZE_NAMES[type(component)]):
            if name not in names:
                continue
            value, sigma = given.get(name) or _tolerance(component, name, settings) or (float(getattr(component, name)), FREE_SIGMA)
            found.append((row, column, value / unit_of(name), sigma / unit_of(name), component.id, name))
    rows, columns, values, sigmas, subjects, labels = zip(*found, strict=True) if found else ((),) * 6
    return _Sizes(np.array(rows, np.intp), np.array(columns, np.intp), np.array(values, float), np.array(sigmas, float), subjects, labels)


def _places(problem: Problem) -> _Places:
    rows, middles, ways, sigmas, turns, turn_sigmas, names = [], [], [], [], [], [], []
    for row, given in enumerate(problem.components):
        if given.id not in problem.placed or not isinstance(given, Pipe) or given.sigma_position is None:
            continue
        across = np.array(axes_across(unit(np.subtract(given.end, given.start))))
        # independent directions of the covariance across the axis
        variances, turn = np.linalg.eigh(across @ np.diag(np.square(given.sigma_position)) @ across.T)
        rows.append(row)
        middles.append(np.add(given.start, given.end) / 2)
        ways.append(turn.T @ across)
        sigmas.append(np.maximum(np.sqrt(np.maximum(variances, 0.0)), LEAST_PLACE_SIGMA))
        turns.append(across)
        turn_sigmas.append(np.radians(given.sigma_direction_deg) if given.sigma_direction_deg else np.inf)
        names.append(given.id)
    count = len(rows)
    return _Places(
        np.array(rows, np.intp),
        np.array(middles).reshape(count, 3),
        np.array(ways).reshape(count, 2, 3),
        np.array(sigmas).reshape(count, 2),
        np.array(turns).reshape(count, 2, 3),
        np.array(turn_sigmas, float),
        tuple(names),
    )


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


def with_pipe_ends(bodies: Bodies, links: Links, kept: Flags, *, exact: bool = False) -> Bodies:
    """Return the components with pipes that end where what is joined to them begins.

    Parameters
    ----------
    bodies : Bodies
    links : Links
        The joints that count.
    kept : (c,) array of bool
        Pipes that stay as they are.
    exact : bool
        Put the ends where their neighbours' ports are, else on the pipe's axis beside them.
    """
    own, other = np.concatenate([links.bodies, links.bodies[:, ::-1]]).T
    port, other_port = np.concatenate([links.port, links.port[:, ::-1]]).T
    ours = (bodies.kind[own] == PIPE) & ~kept[own]
    own, other, port, other_port = own[ours], other[ours], port[ours], other_port[ours]
    target, _ = port_places(bodies, other, other_port)
    shared = (bodies.kind[other] == PIPE) & ~kept[other]
    target[shared] = (target[shared] + bodies.points[own[shared], port[shared]]) / 2
    if not exact:
        start, axis = bodies.points[own, START], bodies.directions(own)
        target = start + dot(target - start, axis)[:, None] * axis
    points = bodies.points.copy()
    points[own, port] = target
    pipes = np.unique(own)
    # where its neighbours have changed places, that is nothing to follow
    turned_back = dot(points[pipes, END] - points[pipes, START], bodies.directions(pipes)) <= 0
    points[pipes[turned_back]] = bodies.points[pipes[turned_back]]
    changed = bodies.changed.copy()
    changed[pipes[~turned_back]] = True
    return replace(bodies, points=points, changed=changed)
