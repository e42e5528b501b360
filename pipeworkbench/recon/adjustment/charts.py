# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as unknowns: how each kind may move and change, with as few parameters as that takes.

Every component moves as a rigid body about its reference point, X -> exp([w]x) (X - p) + p + t, and changes some
of its sizes. These nine numbers are its *motion*: translation t (mm), rotation vector w (rad), up to three size changes.
A chart's ``basis`` maps the few parameters, all in mm at the component's own scale, to a motion: a pipe does
not move along its axis, nothing with an axis of revolution turns about it. So no parametrisation has a rank defect.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import DIRECTIONS, HUBBED_FLANGES, POINTS, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.shapes import DISH
from pipeworkbench.recon.vectors import angle_between, as_vector, axes_across, cross, cross_matrices, nearest_on_line, unit

RIGID, SIZES = 6, 3
MOTION = RIGID + SIZES
POSITION, DIRECTION = "position", "direction"
LEAST_SIZE = 1.0  # mm; no adjustment makes a part smaller
LEAST_LEVER = 10.0  # mm
BEND_LIMITS_DEG = 0.5, 179.0


@dataclass(frozen=True, eq=False)
class Chart:
    """How a component may move.

    reference (3,) is the point p in mm; basis (9, k) maps k parameters in mm to a motion; names (k,) say what
    each parameter changes: "position", "direction" or the field of a size.
    """

    reference: Array
    basis: Array
    names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class MovingPort:
    """A port with its derivatives by the motion: point (3,), direction (3,), radius (mm), by_motion (7, 9) of all these."""

    point: Array
    direction: Array
    radius: float
    by_motion: Array


# the sizes of each kind in the order of a motion's last three numbers; diameters change by their radius
SIZE_NAMES: dict[type[AnyComponent], tuple[str, ...]] = {
    Pipe: ("outer_diameter",),
    Elbow: ("outer_diameter", "bend_radius", "angle_deg"),
    Flange: ("outer_diameter", "D", "C"),
    Tee: ("outer_diameter", "branch_diameter"),
    Reducer: ("outer_diameter", "end_diameter"),
    Cap: ("outer_diameter",),
}
DIAMETERS = ("outer_diameter", "branch_diameter", "end_diameter", "D")


def unit_of(name: str) -> float:
    """Return how many of a size's own units one unit of the motion is: a diameter is twice the radius, angles are in degrees."""
    return 2.0 if name in DIAMETERS else float(np.degrees(1.0)) if name == "angle_deg" else 1.0


def bends(elbow: Elbow) -> bool:
    """Tell whether an elbow may be a torus: its axes have a plane, and a corner that is not far away."""
    come, go = np.subtract(elbow.intersection, elbow.start), np.subtract(elbow.end, elbow.intersection)
    least, most = BEND_LIMITS_DEG
    return all(least <= angle <= most for angle in (float(np.degrees(angle_between(come, go))), elbow.angle_deg))


def chart_of(component: AnyComponent, anchor: Array | None = None) -> Chart:
    """Return how a component may move; a pipe with an ``anchor`` (3,), mm, turns about its axis' point that is nearest to it."""
    reference, axis, lever = _frame(component)
    first, second = axes_across(axis)
    shifts: tuple[Array, ...] = tuple(np.eye(3))
    turns: tuple[Array, ...] = (first, second)
    if isinstance(component, Pipe):
        shifts = (first, second)
    elif isinstance(component, Elbow | Tee) or (isinstance(component, Reducer) and component.reducer_type == "eccentric"):
        turns = tuple(np.eye(3))
    sizes = SIZE_NAMES[type(component)]
    names = (POSITION,) * len(shifts) + (DIRECTION,) * len(turns) + sizes
    basis = np.zeros((MOTION, len(names)))
    for column, shift in enumerate(shifts):
        basis[:3, column] = shift
    for column, turn in enumerate(turns, len(shifts)):
        basis[3:6, column] = turn / lever
    if anchor is not None:
        # turning about another point is turning about the reference and going with it
        turning = slice(len(shifts), len(shifts) + len(turns))
        basis[:3, turning] = np.cross(basis[3:6, turning].T, reference - nearest_on_line(anchor, reference, axis)).T
    for row, name in enumerate(sizes, RIGID):
        basis[row, len(shifts) + len(turns) + row - RIGID] = 1 / lever if name == "angle_deg" else 1.0
    return Chart(reference, basis, names)


def _frame(component: AnyComponent) -> tuple[Array, Array, float]:
    """Return reference point (3,), axis (3,) and lever (mm): half of the size along the axis."""
    match component:
        case Pipe():
            start, end = np.array(component.start), np.array(component.end)
            return (start + end) / 2, unit(end - start), max(component.length / 2, LEAST_LEVER)
        case Elbow():
            corner = np.array(component.intersection)
            tangent = float(np.linalg.norm(np.array(component.start) - corner))
            return corner, unit(corner - np.array(component.start)), max(tangent, LEAST_LEVER)
        case Flange():
            return np.array(component.face), unit(component.axis), component.D / 2
        case Tee():
            return np.array(component.intersection), unit(np.subtract(component.end, component.start)), max(component.length / 2, LEAST_LEVER)
        case _:
            return np.array(component.start), unit(component.axis), max(component.length, component.outer_diameter / 2)


def normalised(component: AnyComponent) -> AnyComponent:
    """Return an elbow with its ends where its bend radius and its axes put them; anything else as it is."""
    return _bent(component, {}) if isinstance(component, Elbow) else component


def moved(component: AnyComponent, motion: Array) -> AnyComponent:
    """Return a component after a motion (9,); sizes stay positive."""
    reference, _, _ = _frame(component)
    turn = Rotation.from_rotvec(motion[3:RIGID]).as_matrix()
    changes: dict[str, Any] = {}
    for name in _names_of(type(component).__name__, POINTS):
        changes[name] = as_vector(turn @ (np.array(getattr(component, name)) - reference) + reference + motion[:3])
    for name in _names_of(type(component).__name__, DIRECTIONS):
        changes[name] = as_vector(unit(turn @ np.array(getattr(component, name))))
    sizes: dict[str, float] = {}
    for name, change in zip(SIZE_NAMES[type(component)], motion[RIGID:], strict=False):
        if change:
            sizes[name] = getattr(component, name) + unit_of(name) * float(change)
    if isinstance(component, Elbow):
        return _bent(replace(component, **changes), sizes)
    for name, size in sizes.items():
        changes[name] = max(size, _least(component, name))
    if isinstance(component, Flange) and "C" in sizes:
        # in this order, so that a flange without a neck gets none by rounding
        changes["length"] = changes["C"] + (component.length - component.C)
    return replace(component, **changes)


@functools.cache
def _names_of(kind: str, wanted: frozenset[str]) -> tuple[str, ...]:
    (found,) = (one for one in SIZE_NAMES if one.__name__ == kind)
    return tuple(f.name for f in fields(found) if f.name in wanted)


def _least(component: AnyComponent, name: str) -> float:
    """Return the least value (mm) of a size with which a component is still one: what is in it or on it has room."""
    if name == "D" and isinstance(component, Flange):
        holes = component.K + (component.L or 0.0) if component.K is not None else 0.0
        return max(holes, component.raised_face_diameter or 0.0) + LEAST_SIZE
    if name == "C" and isinstance(component, Flange):
        return (component.raised_face_height or 0.0) + LEAST_SIZE
    if name in DIAMETERS and component.wall_thickness is not None:
        return 2 * component.wall_thickness + LEAST_SIZE
    return LEAST_SIZE


def _axes(elbow: Elbow) -> tuple[Array, Array, Array]:
    """Return the directions (3,) in which an elbow is entered and left, and its plane's normal, about which it turns."""
    corner = np.array(elbow.intersection)
    come, go = unit(corner - np.array(elbow.start)), unit(np.array(elbow.end) - corner)
    return come, go, unit(cross(come, go))


def _bent(elbow: Elbow, sizes: Mapping[str, float]) -> Elbow:
    """Return an elbow with other sizes: both axes turn about the corner by half of the angle's change, the ends follow."""
    come, go, normal = _axes(elbow)
    angle = float(np.radians(np.clip(sizes.get("angle_deg", np.degrees(angle_between(come, go))), *BEND_LIMITS_DEG)))
    half = Rotation.from_rotvec((angle - angle_between(come, go)) / 2 * normal).as_matrix()
    come, go = half.T @ come, half @ go
    radius = max(sizes.get("bend_radius", elbow.bend_radius), LEAST_SIZE)
    length, corner = radius * np.tan(angle / 2), np.array(elbow.intersection)
    return replace(
        elbow,
        start=as_vector(corner - length * come),
        end=as_vector(corner + length * go),
        angle_deg=float(np.degrees(angle)),
        bend_radius=radius,
        outer_diameter=max(sizes.get("outer_diameter", elbow.outer_diameter), _least(elbow, "outer_diameter")),
    )


def port_of(component: AnyComponent, number: int) -> MovingPort:
    """Return a component's port with its derivatives by the motion (Eq. 15 for all parameters)."""
    port = component.ports[number]
    point, direction = np.array(port.point), np.array(port.direction)
    reference, _, _ = _frame(component)
    by_motion = np.zeros((7, MOTION))
    by_motion[:3, :3] = np.eye(3)
    # of w x (X - p), by w
    by_motion[:3, 3:6] = -cross_matrices(point - reference)
    by_motion[3:6, 3:6] = -cross_matrices(direction)
    match component:
        case Elbow():
            angle = np.radians(component.angle_deg)
            half_tangent = np.tan(angle / 2)
            _, _, normal = _axes(component)
            # both axes turn by half of the angle's change, away from each other; a port looks away from the corner
            turned = cross(normal, direction) / 2 * (-1 if number == 0 else 1)
            length = component.bend_radius * half_tangent
            by_motion[:3, 7] = half_tangent * direction
            by_motion[:3, 8] = component.bend_radius * (1 + half_tangent**2) / 2 * direction + length * turned
            by_motion[3:6, 8] = turned
        case Flange() if number == 1:
            by_motion[:3, 8] = direction
        case _:
            pass
    other = (isinstance(component, Tee) and number == 2) or (isinstance(component, Reducer) and number == 1)
    by_motion[6, RIGID + int(other)] = 1.0
    if isinstance(component, Flange) and number == 0:
        # the face is as wide as the plate
        by_motion[6, RIGID : RIGID + 2] = 0.0, 1.0
    return MovingPort(point, direction, port.diameter / 2, by_motion)


def by_motion(components: list[AnyComponent], owner: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    """Return how far contours move along their outward normals with the motions of their components: Eqs. 5 and 6 for every shape.

    Parameters
    ----------
    components : list of Component
    owner : (n,) array
        The component that each sample belongs to.
    part : (n,) array of str
        The names of their curves, as :class:`.contour.Contour` has them.
    point, outward : (n, 3) arrays
        The edge-generating points, mm, and the unit normals there.

    Returns
    -------
    (n, 9) array
        Millimetres along ``outward`` per unit of the motion.
    """
    reference = np.array([_frame(component)[0] for component in components]).reshape(-1, 3)
    rates = np.zeros((len(owner), MOTION))
    rates[:, :3] = outward
    # N (w x (X - p)) = w ((X - p) x N), in columns: NumPy's own is slower
    (x, y, z), (a, b, c) = (point - reference[owner]).T, outward.T
    rates[:, 3], rates[:, 4], rates[:, 5] = y * c - z * b, z * a - x * c, x * b - y * a
    order = list(_RATES)
    kinds = np.array([order.index(type(component)) for component in components], np.int8)
    kind = kinds[owner]
    for number, of_sizes in enumerate(_RATES.values()):
        members = np.flatnonzero(kinds == number)
        rows = np.flatnonzero(kind == number) if len(members) else members
        if len(rows):
            place = np.zeros(len(components), np.intp)
            place[members] = np.arange(len(members))
            ours: list[Any] = [components[row] for row in members]
            rates[rows, RIGID:] = of_sizes(ours, place[owner[rows]], part[rows], point[rows], outward[rows])
    return rates


def _dot(one: Array, other: Array) -> Array:
    return np.asarray(np.einsum("ni,ni->n", one, other))


def _pipe_rates(pipes: list[Pipe], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del pipes, row, part, point
    return np.column_stack([np.ones(len(outward)), np.zeros((len(outward), 2))])


def _elbow_rates(elbows: list[Elbow], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del part
    axes = [_axes(elbow) for elbow in elbows]
    # from the corner to the torus' centre
    bisector = np.array([unit(go - come) for come, go, _ in axes])
    half = np.radians([elbow.angle_deg for elbow in elbows]) / 2
    bend, tube = np.array([elbow.bend_radius for elbow in elbows]), np.array([elbow.outer_diameter / 2 for elbow in elbows])
    corner = np.array([elbow.intersection for elbow in elbows])
    centre = corner + (bend / np.cos(half))[:, None] * bisector
    towards = _dot(outward, bisector[row])
    # X = C + R e + r N, thus N e = (N (X - C) - r) / R; the corner stays where it is (Sect. 7.3)
    ring = (_dot(outward, point - centre[row]) - tube[row]) / bend[row]
    by_bend = towards / np.cos(half)[row] + ring
    by_angle = towards * (bend * np.tan(half) / np.cos(half) / 2)[row]
    return np.column_stack([np.ones(len(row)), by_bend, by_angle])


def _flange_rates(flanges: list[Flange], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    axis = np.array([unit(flange.axis) for flange in flanges])[row]
    offset = point - np.array([flange.face for flange in flanges])[row]
    radial = offset - _dot(offset, axis)[:, None] * axis
    radius = np.linalg.norm(radial, axis=1)
    across = _dot(outward, radial) / radius
    behind = -_dot(outward, axis)
    tube = np.array([flange.outer_diameter / 2 for flange in flanges])[row]
    root = np.array([min(flange.neck_diameter or flange.outer_diameter, flange.D) / 2 for flange in flanges])[row]
    # a cone from the root to the pipe; without a root of its own the whole neck is as wide as the pipe
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(root > tube, (root - radius) / (root - tube), 1.0)
    straight = np.array([flange.flange_type in HUBBED_FLANGES and flange.neck_diameter is not None for flange in flanges])[row]
    neck, plate = np.isin(part, ("neck", "hub end")), np.isin(part, ("rim", "face", "back"))
    rates = np.zeros((len(row), SIZES))
    rates[:, 0] = np.where(neck & ~straight, share * across, 0.0)
    rates[:, 1] = np.where(plate, across, 0.0)
    rates[:, 2] = np.where(neck | (part == "back"), behind, 0.0)
    return rates


def _tee_rates(tees: list[Tee], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del tees, row, point
    branch = part == "branch"
    return np.column_stack([~branch, branch, np.zeros(len(outward))]).astype(float)


def _reducer_rates(reducers: list[Reducer], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del part
    start, end = (np.array([getattr(reducer, name) for reducer in reducers]) for name in ("start", "end"))
    length = np.linalg.norm(end - start, axis=1)
    axis = (end - start) / length[:, None]
    radii = np.array([(reducer.outer_diameter, reducer.end_diameter) for reducer in reducers]) / 2
    radial = 1 / np.hypot(1, (radii[:, 1] - radii[:, 0]) / length)[row]
    share = _dot(point - start[row], axis[row]) / length[row]
    return np.column_stack([(1 - share) * radial, share * radial, np.zeros(len(outward))])


def _cap_rates(caps: list[Cap], row: NDArray[np.intp], part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    axis = np.array([unit(cap.axis) for cap in caps])[row]
    length, radius = (np.array(values) for values in zip(*((cap.length, cap.outer_diameter / 2) for cap in caps), strict=True))
    dish = np.minimum(2 * DISH * radius, length)
    offset = point - np.array([cap.start for cap in caps])[row]
    along = _dot(offset, axis)
    radial = offset - along[:, None] * axis
    width = np.linalg.norm(radial, axis=1)
    # the dish grows with the diameter while its top stays: X = (L - dish (1 - sin t)) a + r cos t e
    backwards = np.where(2 * DISH * radius < length, 2 * DISH / dish, 0.0)[row] * (length[row] - along)
    with np.errstate(invalid="ignore", divide="ignore"):
        across = _dot(outward, radial) / width
    curved = np.nan_to_num(width / radius[row] * across) - backwards * _dot(outward, axis)
    return np.column_stack([np.where(part == "cap", curved, 1.0), np.zeros((len(row), 2))])


_RATES: dict[type[AnyComponent], Callable[..., Array]] = {
    Pipe: _pipe_rates,
    Elbow: _elbow_rates,
    Flange: _flange_rates,
    Tee: _tee_rates,
    Reducer: _reducer_rates,
    Cap: _cap_rates,
}
