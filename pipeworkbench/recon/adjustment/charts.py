# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as unknowns: how they may move, and what images and ports make of it.

A motion has nine numbers: a rigid motion as a twist (t, w), X' = X + t + w x (X - p) about a reference point p, and up
to three sizes. A chart's columns, each scaled so that one unit moves the component by about 1 mm, span the motions that change anything: a pipe does
not move along its axis, nothing with an axis of revolution turns about it. So no parametrisation is ever singular.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import AnyComponent, Elbow, Pipe, Reducer, Tee
from pipeworkbench.recon.bodies import (
    ANGLE,
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
    SIZE_NAMES,
    SIZES,
    START,
    TEE,
    THICKNESS,
    Bodies,
    Flags,
    Rows,
)
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.shapes import DISH, neck_radius
from pipeworkbench.recon.vectors import angle_between, cross_matrices, dot, units

RIGID = 6
MOTION = RIGID + SIZES
POSITION, DIRECTION = "position", "direction"
BEND_LIMITS_DEG = 0.5, 179.0
PORT = 7  # numbers of a port: point, direction, radius


def bends(elbow: Elbow) -> bool:
    """Tell whether an elbow may be a torus: its axes have a plane, and a corner that is not far away."""
    come, go = np.subtract(elbow.intersection, elbow.start), np.subtract(elbow.end, elbow.intersection)
    least, most = BEND_LIMITS_DEG
    return all(least <= angle <= most for angle in (float(np.degrees(angle_between(come, go))), elbow.angle_deg))


def parameter_names(component: AnyComponent) -> tuple[str, ...]:
    """Return what each column of a component's chart changes: its position, its direction or the field of a size."""
    sided = isinstance(component, Elbow | Tee) or (isinstance(component, Reducer) and component.reducer_type == "eccentric")
    shifts, turns = 2 if isinstance(component, Pipe) else 3, 3 if sided else 2
    return (POSITION,) * shifts + (DIRECTION,) * turns + SIZE_NAMES[type(component)]


def charts(bodies: Bodies, anchored: Rows, anchors: Array) -> tuple[Array, Array]:
    """Return the reference points (c, 3), mm, and the bases (c, 9, 9) that map components' parameters in mm to motions; of fewer the rest is zero.

    ``anchored`` (m,) are rows of pipes that turn about their axes' points nearest to ``anchors`` (m, 3), mm.
    """
    reference, axis, lever = bodies.references
    count = len(bodies)
    ways = np.stack(perpendicular_axes(axis), axis=2) if count else np.zeros((0, 3, 2))
    sided = np.isin(bodies.kind, (ELBOW, TEE)) | bodies.details.eccentric
    basis = np.zeros((count, MOTION, MOTION))
    pipes, others = bodies.rows(PIPE), np.flatnonzero(bodies.kind != PIPE)
    basis[pipes, :3, :2] = ways[pipes]
    basis[others, :3, :3] = np.eye(3)
    # where the turns begin among the columns, and the sizes
    first = np.where(bodies.kind == PIPE, 2, 3)
    last = first + np.where(sided, 3, 2)
    for begin, end in {(int(a), int(b)) for a, b in zip(first, last, strict=True)}:
        rows = np.flatnonzero((first == begin) & (last == end))
        turns = np.broadcast_to(np.eye(3), (len(rows), 3, 3)) if end - begin == 3 else ways[rows]
        basis[rows, 3:RIGID, begin:end] = turns / lever[rows, None, None]
        for size in range(min(SIZES, MOTION - end)):
            basis[rows, RIGID + size, end + size] = np.where((bodies.kind[rows] == ELBOW) & (size == ANGLE), 1 / lever[rows], 1.0)
    # turning about another point is turning about the reference and going with it
    beside = dot(anchors - reference[anchored], axis[anchored])[:, None] * axis[anchored]
    basis[anchored, :3, 2:4] = cross_matrices(beside) @ basis[anchored, 3:RIGID, 2:4]
    return reference, basis


def normalised(bodies: Bodies, rows: Rows) -> Bodies:
    """Return components of which some elbows (m,) have their ends where their bend radii and axes put them."""
    points, sizes, changed = bodies.points.copy(), bodies.sizes.copy(), bodies.changed.copy()
    come, go, _ = bodies.elbow_axes(rows)
    sizes[rows, ANGLE] = _angles(come, go)
    changed[rows] = True
    return _bent(replace(bodies, points=points, sizes=sizes, changed=changed), rows)


def moved(bodies: Bodies, motions: Array, free: Flags) -> Bodies:
    """Return components of which those that are free (c,) made motions (c, 9); sizes stay positive."""
    if not free.any():
        return bodies
    reference, _, _ = bodies.references
    turn = Rotation.from_rotvec(motions[:, 3:RIGID]).as_matrix()
    # zeros that no kind uses move, too, and nobody looks at them
    points = (bodies.points - reference[:, None]) @ np.swapaxes(turn, 1, 2) + (reference + motions[:, :3])[:, None]
    axis = np.einsum("cij,cj->ci", turn, bodies.axis)
    with np.errstate(invalid="ignore", divide="ignore"):
        axis = np.where(bodies.axis.any(axis=1)[:, None], units(axis), 0.0)
    sizes = np.where(motions[:, RIGID:] != 0, np.maximum(bodies.sizes + motions[:, RIGID:], bodies.details.least), bodies.sizes)
    elbows = bodies.rows(ELBOW)
    sizes[elbows, ANGLE] = np.clip(bodies.sizes[elbows, ANGLE] + motions[elbows, RIGID + ANGLE], *np.radians(BEND_LIMITS_DEG))
    result = replace(
        bodies,
        points=np.where(free[:, None, None], points, bodies.points),
        axis=np.where(free[:, None], axis, bodies.axis),
        sizes=np.where(free[:, None], sizes, bodies.sizes),
        changed=bodies.changed | free,
    )
    return _bent(result, elbows[free[elbows]])


def _angles(come: Array, go: Array) -> Array:
    """Return the angles (m,) between directions (m, 3); sharp for small angles too."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(come, go), axis=1), dot(come, go)))


def _bent(bodies: Bodies, rows: Rows) -> Bodies:
    """Return components of which some elbows (m,) have the angles and bend radii of their sizes.

    Both axes turn about the corner by half of the angle's change, the ends follow.
    """
    if not len(rows):  # SciPy has no rotations of nothing
        return bodies
    come, go, normal = bodies.elbow_axes(rows)
    angle, radius = bodies.sizes[rows, ANGLE], bodies.sizes[rows, BEND]
    half = Rotation.from_rotvec((angle - _angles(come, go))[:, None] / 2 * normal).as_matrix()
    come, go = np.einsum("mji,mj->mi", half, come), np.einsum("mij,mj->mi", half, go)
    length, corner = (radius * np.tan(angle / 2))[:, None], bodies.points[rows, CORNER]
    points = bodies.points.copy()
    points[rows, START], points[rows, END] = corner - length * come, corner + length * go
    return replace(bodies, points=points)


@dataclass(frozen=True, eq=False)
class Ports:
    """Ports with their derivatives by the motions: point (p, 3), direction (p, 3), radius (p,) mm; by_motion (p, 7, 9) of all these."""

    point: Array
    direction: Array
    radius: Array
    by_motion: Array


def ports_of(bodies: Bodies, rows: Rows, number: NDArray[np.intp]) -> Ports:
    """Return the ports (p,) of components (p,) with their derivatives by the motion (Eq. 15 for all parameters)."""
    kind = bodies.kind[rows]
    reference = bodies.references[0][rows]
    point, direction = port_places(bodies, rows, number)
    by_motion = np.zeros((len(rows), PORT, MOTION))
    by_motion[:, :3, :3] = np.eye(3)
    # of w x (X - p), by w
    by_motion[:, :3, 3:RIGID] = -cross_matrices(point - reference)
    by_motion[:, 3:RIGID, 3:RIGID] = -cross_matrices(direction)
    elbow = np.flatnonzero(kind == ELBOW)
    angle, bend = bodies.sizes[rows[elbow], ANGLE], bodies.sizes[rows[elbow], BEND]
    half_tangent = np.tan(angle / 2)[:, None]
    # both axes turn by half of the angle's change, away from each other; a port looks away from the corner
    away = np.where(number[elbow] == 0, -0.5, 0.5)[:, None]
    turned = away * np.cross(bodies.elbow_axes(rows[elbow])[2], direction[elbow])
    by_motion[elbow, :3, RIGID + BEND] = half_tangent * direction[elbow]
    by_motion[elbow, :3, RIGID + ANGLE] = bend[:, None] * ((1 + half_tangent**2) / 2 * direction[elbow] + half_tangent * turned)
    by_motion[elbow, 3:RIGID, RIGID + ANGLE] = turned
    weld_end = np.flatnonzero((kind == FLANGE) & (number == 1))
    by_motion[weld_end, :3, RIGID + THICKNESS] = direction[weld_end]
    # a face is as wide as its plate
    size = np.where(_second(kind, number), SECOND, RADIUS)
    by_motion[np.arange(len(rows)), PORT - 1, RIGID + size] = 1.0
    return Ports(point, direction, bodies.sizes[rows, size], by_motion)


def _second(kind: NDArray[np.int8], number: NDArray[np.intp]) -> Flags:
    """Return which ports (p,) have the second size of their components: faces of flanges, branches of tees, narrow ends of reducers."""
    return np.asarray(((kind == FLANGE) & (number == 0)) | ((kind == TEE) & (number == 2)) | ((kind == REDUCER) & (number == 1)))


def port_places(bodies: Bodies, rows: Rows, number: NDArray[np.intp]) -> tuple[Array, Array]:
    """Return the points (p, 3), mm, and unit directions (p, 3) of ports."""
    kind = bodies.kind[rows]
    point = bodies.points[rows, np.where((kind == TEE) & (number == 2), BRANCH_END, np.where(kind == FLANGE, START, number))]
    weld_end = np.flatnonzero((kind == FLANGE) & (number == 1))
    point[weld_end] -= bodies.flange_length(rows[weld_end])[:, None] * bodies.axis[rows[weld_end]]
    # flanges look along their axes with the face, reducers with the narrow end, caps with none
    outwards = np.where((kind == FLANGE) == (number == 0), 1.0, -1.0)
    direction = np.where(kind == CAP, -1.0, outwards)[:, None] * bodies.axis[rows]
    straight = np.flatnonzero((kind == PIPE) | ((kind == TEE) & (number < 2)))
    direction[straight] = units(bodies.points[rows[straight], number[straight]] - bodies.points[rows[straight], 1 - number[straight]])
    cornered = np.flatnonzero((kind == ELBOW) | ((kind == TEE) & (number == 2)))
    direction[cornered] = units(point[cornered] - bodies.points[rows[cornered], CORNER])
    return point, direction


def by_motion(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    """Return how far contours move along their outward normals with the motions of their components: Eqs. 5 and 6 for every shape.

    Parameters
    ----------
    bodies : Bodies
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
    reference, _, _ = bodies.references
    rates = np.zeros((len(owner), MOTION))
    rates[:, :3] = outward
    # N (w x (X - p)) = w ((X - p) x N), in columns: NumPy's own is slower
    (x, y, z), (a, b, c) = (point - reference[owner]).T, outward.T
    rates[:, 3], rates[:, 4], rates[:, 5] = y * c - z * b, z * a - x * c, x * b - y * a
    kind = bodies.kind[owner]
    for number, of_sizes in enumerate(_RATES):
        rows = np.flatnonzero(kind == number)
        if len(rows):
            rates[rows, RIGID:] = of_sizes(bodies, owner[rows], part[rows], point[rows], outward[rows])
    return rates


def _pipe_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del bodies, part, point, outward
    return np.column_stack([np.ones(len(owner)), np.zeros((len(owner), 2))])


def _elbow_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del part
    elbows, row = np.unique(owner, return_inverse=True)
    come, go, _ = bodies.elbow_axes(elbows)
    # from the corner to the torus' centre
    bisector = units(go - come)
    tube, bend, half = bodies.sizes[elbows, RADIUS], bodies.sizes[elbows, BEND], bodies.sizes[elbows, ANGLE] / 2
    centre = bodies.points[elbows, CORNER] + (bend / np.cos(half))[:, None] * bisector
    towards = dot(outward, bisector[row])
    # X = C + R e + r N, thus N e = (N (X - C) - r) / R; the corner stays where it is (Sect. 7.3)
    ring = (dot(outward, point - centre[row]) - tube[row]) / bend[row]
    by_bend = towards / np.cos(half)[row] + ring
    by_angle = towards * (bend * np.tan(half) / np.cos(half) / 2)[row]
    return np.column_stack([np.ones(len(row)), by_bend, by_angle])


def _flange_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    axis = bodies.axis[owner]
    offset = point - bodies.points[owner, START]
    radial = offset - dot(offset, axis)[:, None] * axis
    radius = np.linalg.norm(radial, axis=1)
    across, behind = dot(outward, radial) / radius, -dot(outward, axis)
    tube, root = bodies.sizes[owner, RADIUS], neck_radius(bodies, owner)
    # a cone from the root to the pipe; without a root of its own the whole neck is as wide as the pipe
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(root > tube, (root - radius) / (root - tube), 1.0)
    straight = bodies.details.hubbed[owner] & ~np.isnan(bodies.details.neck[owner])
    neck, plate = np.isin(part, ("neck", "hub end")), np.isin(part, ("rim", "face", "back"))
    rates = np.zeros((len(owner), SIZES))
    rates[:, RADIUS] = np.where(neck & ~straight, share * across, 0.0)
    rates[:, PLATE] = np.where(plate, across, 0.0)
    rates[:, THICKNESS] = np.where(neck | (part == "back"), behind, 0.0)
    return rates


def _tee_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del bodies, point, outward
    branch = part == "branch"
    return np.column_stack([~branch, branch, np.zeros(len(owner))]).astype(float)


def _reducer_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    del part, outward
    length, axis = bodies.lengths(owner), bodies.directions(owner)
    radial = 1 / np.hypot(1, (bodies.sizes[owner, SECOND] - bodies.sizes[owner, RADIUS]) / length)
    share = dot(point - bodies.points[owner, START], axis) / length
    return np.column_stack([(1 - share) * radial, share * radial, np.zeros(len(owner))])


def _cap_rates(bodies: Bodies, owner: Rows, part: NDArray[np.str_], point: Array, outward: Array) -> Array:
    axis, length, radius = bodies.axis[owner], bodies.details.beyond[owner], bodies.sizes[owner, RADIUS]
    dish = np.minimum(2 * DISH * radius, length)
    offset = point - bodies.points[owner, START]
    along = dot(offset, axis)
    radial = offset - along[:, None] * axis
    width = np.linalg.norm(radial, axis=1)
    # the dish grows with the diameter while its top stays: X = (L - dish (1 - sin t)) a + r cos t e
    backwards = np.where(2 * DISH * radius < length, 2 * DISH / dish, 0.0) * (length - along)
    with np.errstate(invalid="ignore", divide="ignore"):
        across = dot(outward, radial) / width
    curved = np.nan_to_num(width / radius * across) - backwards * dot(outward, axis)
    return np.column_stack([np.where(part == "cap", curved, 1.0), np.zeros((len(owner), 2))])


_RATES: tuple[Callable[..., Array], ...] = (_pipe_rates, _elbow_rates, _flange_rates, _tee_rates, _reducer_rates, _cap_rates)
