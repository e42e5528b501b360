# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where an adjustment stands: components, cameras and poses as they are now, and what of them may move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import AnyComponent, Elbow, Pipe
from pipeworkbench.recon.adjustment.charts import POSITION, RIGID, bends, charts, moved, normalised, parameter_names
from pipeworkbench.recon.adjustment.conditions import Conditions, has_standard_size, with_pipe_ends
from pipeworkbench.recon.adjustment.normal_equations import FRAME_UNITS, Frame, Layout, Unknowns
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.bodies import ELBOW, END, SIZE_NAMES, START, Bodies
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.vectors import as_vector, dot
from pipeworkbench.recon.views import View

LEAST_LENGTH = 1.0  # mm; what stands for an elbow without a bend is no shorter


@dataclass(frozen=True, eq=False)
class State:
    """Components, cameras (in the common frame) and stations' poses at one moment of the iteration.

    ``free`` names for each component the parameters that are unknowns, ``conditions`` say what else is known, of the joints those that count.
    Elbows that do not bend are no tori: they stay, nothing is joined to them, and a pipe between their ends stands for them.
    """

    problem: Problem
    bodies: Bodies
    free: tuple[frozenset[str], ...]
    layout: Layout
    conditions: Conditions
    anchored: NDArray[np.intp]
    views: tuple[View, ...]
    cameras: tuple[Camera, ...]
    station_of_view: tuple[int, ...]
    poses: tuple[Array, ...]
    frames: tuple[Frame, ...]

    @classmethod
    def of(cls, problem: Problem, settings: AdjustmentSettings) -> State:
        """Return the state that a problem begins with."""
        free = tuple(_free(component, problem, settings) for component in problem.components)
        bodies = Bodies.of([_standing_for(component) if _straight(component) else component for component in problem.components])
        bodies = normalised(bodies, np.array([row for row in bodies.rows(ELBOW) if free[row]], np.intp))
        views: list[View] = []
        cameras: list[Camera] = []
        station_of_view: list[int] = []
        frames: list[Frame] = []
        for number, station in enumerate(problem.stations):
            first = len(views)
            for view in station.views:
                views.append(view)
                cameras.append(view.camera.placed(station.frame_from_level))
                station_of_view.append(number)
            centres = np.array([camera.projection_centre for camera in cameras[first:]])
            if station.free:
                mine = frozenset(range(first, len(views)))
                frames.append(Frame(station.name, False, mine, centres.mean(axis=0), station.sigma_position, station.sigma_rotation, np.zeros(6)))
            for index in sorted(station.free_cameras):
                name = f"{station.name}, camera {station.views[index].camera.name}"
                sigmas = station.camera_sigma_position, station.camera_sigma_rotation
                frames.append(Frame(name, True, frozenset([first + index]), centres[index], *sigmas, np.zeros(6)))
        poses = tuple(np.asarray(station.frame_from_level, float) for station in problem.stations)
        ends = {component.id for component in problem.components if _straight(component)}
        every = [number for number, joint in enumerate(problem.joints) if not ends & {joint.a, joint.b}]
        conditions = Conditions.of(problem, free, every, settings)
        layout = Layout.of(problem.components, free)
        anchored = _anchored(problem, free)
        state = cls(problem, bodies, free, layout, conditions, anchored, tuple(views), tuple(cameras), tuple(station_of_view), poses, tuple(frames))
        return state.with_ends()

    @property
    def components(self) -> tuple[AnyComponent, ...]:
        """The components as they are now."""
        return self.bodies.components

    @property
    def joints(self) -> tuple[int, ...]:
        """The numbers of the problem's joints that count."""
        return tuple(self.conditions.links.number.tolist())

    def with_ends(self, *, exact: bool = False) -> State:
        """Return the state with pipes that end where what is joined to them begins."""
        bodies = with_pipe_ends(self.bodies, self.conditions.links, ~self.conditions.free, exact=exact)
        if len(self.anchored):
            # to the second order a turn shifts what it is to be about
            bodies = _through(bodies, self.anchored, self._anchors())
        return replace(self, bodies=bodies)

    def _anchors(self) -> Array:
        """Return the middles (m, 3), mm, of where pipes whose position is held were given; an axis has no other point that stays."""
        given = [self.problem.components[row] for row in self.anchored]
        return np.array([np.add(pipe.start, pipe.end) / 2 for pipe in given if isinstance(pipe, Pipe)]).reshape(-1, 3)

    def without(self, joints: frozenset[int], frozen: Mapping[int, frozenset[str]]) -> State:
        """Return the state in which some joints do not count and parameters of components, by row, are held.

        A component that is held altogether is as it was given, and its joints do not count: nothing is drawn to it.
        """
        if not joints and not frozen:
            return self
        free = tuple(names - frozen.get(row, frozenset()) for row, names in enumerate(self.free))
        stays = np.array([row for row, names in enumerate(free) if not names and self.free[row]], np.intp)
        ids = {self.problem.components[row].id for row in stays}
        left = [n for n in self.joints if n not in joints and not ids & {self.problem.joints[n].a, self.problem.joints[n].b}]
        return replace(
            self,
            free=free,
            bodies=self.bodies.restored(stays),
            layout=Layout.of(self.problem.components, free),
            conditions=Conditions.of(self.problem, free, left, self.conditions.settings),
            anchored=_anchored(self.problem, free),
        )

    def unknowns(self) -> Unknowns:
        """Return the unknowns with their charts at the components as they are now."""
        return self.layout.unknowns(*charts(self.bodies, self.anchored, self._anchors()), self.frames)

    def moved(self, unknowns: Unknowns, step: Array) -> State:
        """Return the state after a step (u,) of all unknowns."""
        bodies = moved(self.bodies, unknowns.motions(step), self.conditions.free)
        cameras, poses, frames = list(self.cameras), list(self.poses), list(self.frames)
        for number, frame in enumerate(self.frames):
            start = unknowns.frame_start[number]
            shift, turn = np.split(step[start : start + RIGID] / FRAME_UNITS, 2)
            motion = np.eye(4)
            motion[:3, :3] = Rotation.from_rotvec(turn).as_matrix()
            motion[:3, 3] = frame.origin + shift - motion[:3, :3] @ frame.origin
            for view in frame.views:
                cameras[view] = cameras[view].placed(motion)
            if not frame.camera:
                station = self.station_of_view[min(frame.views)]
                poses[station] = motion @ poses[station]
            frames[number] = replace(frame, origin=frame.origin + shift, deviation=frame.deviation + np.concatenate([shift, turn]))
        state = replace(self, bodies=bodies, cameras=tuple(cameras), poses=tuple(poses), frames=tuple(frames))
        return state.with_ends()


def _free(component: AnyComponent, problem: Problem, settings: AdjustmentSettings) -> frozenset[str]:
    """Return the names of the parameters that are unknowns."""
    if component.fixed or _straight(component):
        return frozenset()
    names = set(parameter_names(component)) - problem.held.get(component.id, frozenset())
    observed: Sequence[str] = tuple(problem.observed.get(component.id, ()))
    if settings.sizes == "exact":
        names -= {name for name in SIZE_NAMES[type(component)] if has_standard_size(component, name) and name not in observed}
    return frozenset(names)


def _straight(component: AnyComponent) -> bool:
    return isinstance(component, Elbow) and not bends(component)


def _standing_for(component: AnyComponent) -> AnyComponent:
    """Return the pipe from end to end of an elbow that does not bend."""
    assert isinstance(component, Elbow)  # noqa: S101  # nothing else is asked for
    start, end = np.array(component.start), np.array(component.end)
    if np.linalg.norm(end - start) < LEAST_LENGTH:
        end = start + np.array([LEAST_LENGTH, 0.0, 0.0])
    return Pipe(id=component.id, start=as_vector(start), end=as_vector(end), outer_diameter=component.outer_diameter, fixed=True)


def _anchored(problem: Problem, free: Sequence[frozenset[str]]) -> NDArray[np.intp]:
    """Return the rows of pipes whose position is held, and whose direction is not."""
    pipes = (row for row, given in enumerate(problem.components) if isinstance(given, Pipe) and free[row])
    return np.array([row for row in pipes if POSITION in problem.held.get(problem.components[row].id, ())], np.intp)


def _through(bodies: Bodies, rows: NDArray[np.intp], points: Array) -> Bodies:
    """Return components with some pipes (m,) shifted across their axes so that these go through points (m, 3), mm."""
    start, axis = bodies.points[rows, START], bodies.directions(rows)
    off = points - start
    places = bodies.points.copy()
    places[rows, : END + 1] += (off - dot(off, axis)[:, None] * axis)[:, None]
    return replace(bodies, points=places)
