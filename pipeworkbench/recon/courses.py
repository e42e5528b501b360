# SPDX-License-Identifier: LGPL-2.1-or-later
"""The course of pipework around a corner: a straight piece, a bend, a straight piece, many of them at once.

All three are tubes around one curve, so that one formula gives their contours: at a point A of the axis
with the tangent T the line of sight touches the tube at A + r N where N is perpendicular to T and
N (P - A) = r with the projection centre P; that is the torus' condition of contour.py and the cylinder's.
When the course moves, the contour moves in the image by gain N dA: moves along T or around A do not show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.contour import image_normal
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.views import View

PARAMETERS = 8  # the corner, two tilts of each direction, the bend radius
TILT = 1e-5  # rad; for difference quotients
HIDES = 0.95  # of the radius: a line of sight that passes an axis nearer than this is stopped
BEFORE = 0.3  # radii by which what hides a sample is nearer than the sample
Obstacles = Sequence[tuple[Array, Array, Array]]


@dataclass(frozen=True, eq=False)
class Courses:
    """Corners (k, 3) in mm, unit directions ``come`` towards and ``go`` away from them (k, 3), bend and tube radius (k,).

    ``reach`` (k,) is how far from the corner, in mm, the straight pieces begin and end.
    """

    corner: Array
    come: Array
    go: Array
    bend_radius: Array
    tube_radius: Array
    reach: Array

    def __len__(self) -> int:
        return len(self.bend_radius)

    def __getitem__(self, rows: NDArray[Any]) -> Courses:
        return Courses(self.corner[rows], self.come[rows], self.go[rows], self.bend_radius[rows], self.tube_radius[rows], self.reach[rows])

    @property
    def angle(self) -> Array:
        """Angles (k,) of the bends in rad, 0 for none."""
        return np.asarray(np.arctan2(np.linalg.norm(np.cross(self.come, self.go), axis=1), np.einsum("ki,ki->k", self.come, self.go)))

    @property
    def tangent_length(self) -> Array:
        """From the corner to the ends of the bend (k,), mm."""
        return np.asarray(self.bend_radius * np.tan(self.angle / 2))

    def spread(self, count: int) -> Array:
        """Return places (k, count) that are evenly spaced: -1 to 0 on the first straight piece, to 1 on the bend, to 2 on the last."""
        straight = np.maximum(self.reach - self.tangent_length, 0.0)
        bend = self.bend_radius * self.angle
        along = np.linspace(0, 1, count) * (2 * straight + bend)[:, None]
        with np.errstate(invalid="ignore", divide="ignore"):
            first, second = along / straight[:, None] - 1, (along - straight[:, None]) / bend[:, None]
            last = 1 + (along - straight[:, None] - bend[:, None]) / straight[:, None]
        return np.where(along < straight[:, None], first, np.where(along <= (straight + bend)[:, None], second, last))

    def axis(self, places: Array) -> tuple[Array, Array]:
        """Return points and unit tangents (k, n, 3) of the axes at places (k, n)."""
        angle, length = self.angle[:, None], self.tangent_length[:, None]
        inwards = self.go - np.cos(angle) * self.come
        inwards /= np.sin(angle)
        turn = np.clip(places, 0, 1) * angle
        radius = self.bend_radius[:, None]
        straight = np.maximum(self.reach[:, None] - length, 0.0)
        # along the first direction, inwards across it, and from the bend's end along the second direction
        a = -length + radius * np.sin(turn) + np.minimum(places, 0) * straight
        b = radius * (1 - np.cos(turn))
        c = np.maximum(places - 1, 0) * straight
        points = self.corner[:, None] + a[..., None] * self.come[:, None] + b[..., None] * inwards[:, None] + c[..., None] * self.go[:, None]
        return points, np.cos(turn)[..., None] * self.come[:, None] + np.sin(turn)[..., None] * inwards[:, None]

    def moved(self, step: Array) -> Courses:
        """Return the courses after steps (k, 8): the corner's, the tilts of both directions (rad), the radius'."""
        come, go = _tilted(self.come, step[:, 3:5]), _tilted(self.go, step[:, 5:7])
        return Courses(self.corner + step[:, :3], come, go, self.bend_radius + step[:, 7], self.tube_radius, self.reach)

    def derivatives(self, places: Array) -> Array:
        """Return the movement (k, n, 3, 8) of the axes' points at places (k, n) per unit of each parameter."""
        points, _ = self.axis(places)
        result = np.empty((*points.shape, PARAMETERS))
        result[..., :3] = np.eye(3)
        for parameter in range(3, PARAMETERS):
            step = np.zeros((len(self), PARAMETERS))
            step[:, parameter] = TILT if parameter < PARAMETERS - 1 else TILT * self.tube_radius
            moved, _ = self.moved(step).axis(places)
            result[..., parameter] = (moved - points) / step[:, None, None, parameter]
        return result


@dataclass(frozen=True, eq=False)
class CourseContour:
    """Contours of courses in one image: position, normal (k, n, 2, 2) px, NaN where not seen; outward (k, n, 2, 3); gain (k, n, 2) px per mm.

    The third index of (k, n, 2, .) is the side; normals point away from the tube.
    """

    position: Array
    normal: Array
    outward: Array
    gain: Array

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which samples (k, n, 2) are seen."""
        return np.isfinite(self.position[..., 0])


def contour_of_courses(view: View, courses: Courses, places: Array, hidden: NDArray[np.bool_] | None = None) -> CourseContour:
    """Return what a camera sees of courses.

    Parameters
    ----------
    view : View
    courses : Courses
    places : (k, n) array
        As :meth:`Courses.spread` gives them.
    hidden : (k, n, 2) array of bool, optional
        Samples that something stands before, as :func:`hidden_samples` finds them.
    """
    camera = view.camera
    surface, outward = _touched(camera.projection_centre, courses, *courses.axis(places))
    shape = surface.shape[:3]
    position, derivative = camera.project_with_derivative(surface.reshape(-1, 3))
    normal, gain = image_normal(derivative, outward.reshape(-1, 3))
    position, normal = position.reshape(*shape, 2), normal.reshape(*shape, 2)
    unseen = ~camera.sees(position)
    if hidden is not None:
        unseen |= hidden
    position[unseen] = normal[unseen] = np.nan
    return CourseContour(position, normal, outward, gain.reshape(shape))


def hidden_samples(view: View, courses: Courses, places: Array, obstacles: Obstacles = ()) -> NDArray[np.bool_]:
    """Return which samples (k, n, 2) of courses are behind another part of the course or behind an obstacle.

    Parameters
    ----------
    view, courses, places
        As for :func:`contour_of_courses`.
    obstacles : sequence of (starts (m, 3), ends (m, 3), radii (m,)), optional
        For each course, the pipes that may stand before it.
    """
    centre = view.camera.projection_centre
    points, tangents = courses.axis(places)
    surface, _ = _touched(centre, courses, points, tangents)
    hidden = _behind_itself(centre, courses, points, surface)
    for row, (starts, ends, radii) in enumerate(obstacles):
        if len(radii):
            hidden[row] |= _behind_pipes(centre, surface[row].reshape(-1, 3), starts, ends, radii).reshape(hidden.shape[1:])
    return hidden


def _touched(centre: Array, courses: Courses, points: Array, tangents: Array) -> tuple[Array, Array]:
    """Return where lines of sight touch the tubes (k, n, 2, 3) and the surfaces' normals there."""
    to_camera = centre - points
    to_camera -= np.einsum("kni,kni->kn", to_camera, tangents)[..., None] * tangents
    distance = np.sqrt(np.einsum("kni,kni->kn", to_camera, to_camera))[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        towards = to_camera / distance
        cosine = courses.tube_radius[:, None, None] / distance
        sine = np.sqrt(1 - cosine**2)
    sideways = np.cross(tangents, towards)
    outward = np.stack([cosine * towards + sine * sideways, cosine * towards - sine * sideways], axis=2)
    return points[:, :, None] + courses.tube_radius[:, None, None, None] * outward, outward


def near_sight(view: View, corners: Array, around: Array, starts: Array, ends: Array, radii: Array) -> NDArray[np.bool_]:
    """Return which pipes (k, m) come near the lines of sight to corners (k, 3), within ``around`` (k,) mm of them, and before them."""
    sight = corners - view.camera.projection_centre
    distance = np.linalg.norm(sight, axis=1)[:, None]
    _, along, off = _nearest_on_axes(view.camera.projection_centre, sight / distance, starts, ends)
    return np.asarray((off < around[:, None] + radii) & (along < distance + around[:, None]))


def _behind_itself(centre: Array, courses: Courses, points: Array, surface: Array) -> NDArray[np.bool_]:
    """Return which samples (k, n, 2) are behind another part of their own course."""
    rays = surface - centre
    depth = np.linalg.norm(rays, axis=3)
    rays /= depth[..., None]
    axis = points[:, ::4] - centre  # dense enough: neighbours overlap by far
    along = np.einsum("knsi,kmi->knsm", rays, axis)
    off = np.maximum(np.einsum("kmi,kmi->km", axis, axis)[:, None, None] - along**2, 0.0)
    radius = courses.tube_radius[:, None, None, None]
    inside = (HIDES * radius) ** 2 - off
    return np.asarray(((inside > 0) & (along - np.sqrt(np.maximum(inside, 0)) < depth[..., None] - BEFORE * radius)).any(axis=3))


def _behind_pipes(centre: Array, surface: Array, starts: Array, ends: Array, radii: Array) -> NDArray[np.bool_]:
    """Return which points (n, 3) are behind pipes: whose lines of sight pass an axis within the radius."""
    depth = np.linalg.norm(surface - centre, axis=1)[:, None]
    _, along, off = _nearest_on_axes(centre, (surface - centre) / depth, starts, ends)
    return np.asarray(((off < HIDES * radii) & (along < depth - (1 + BEFORE) * radii)).any(axis=1))


def _nearest_on_axes(centre: Array, rays: Array, starts: Array, ends: Array) -> tuple[Array, Array, Array]:
    """Return where rays (n, 3) pass nearest to axes, m in number: places on them, distances along and off the rays (n, m)."""
    length = np.linalg.norm(ends - starts, axis=1)
    axis = (ends - starts) / length[:, None]
    start = starts - centre
    cosine = rays @ axis.T
    with np.errstate(invalid="ignore", divide="ignore"):
        place = (cosine * (rays @ start.T) - np.einsum("mi,mi->m", start, axis)) / (1 - cosine**2)
    place = np.clip(np.nan_to_num(place), 0, length)
    nearest = start[None] + place[..., None] * axis[None]
    along = np.einsum("nmi,ni->nm", nearest, rays)
    return place, along, np.linalg.norm(nearest - along[..., None] * rays[:, None], axis=2)


def _tilted(directions: Array, tilt: Array) -> Array:
    first, second = perpendicular_axes(directions)
    tilted = directions + tilt[:, :1] * first + tilt[:, 1:] * second
    return np.asarray(tilted / np.linalg.norm(tilted, axis=1, keepdims=True))
