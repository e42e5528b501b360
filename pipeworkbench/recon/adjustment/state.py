# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where an adjustment stands: components, cameras and poses as they are now, and what of them may move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import AnyComponent, Elbow, Pipe
from pipeworkbench.recon.adjustment.charts import POSITION, RIGID, SIZE_NAMES, bends, chart_of, moved, normalised
from pipeworkbench.recon.adjustment.conditions import has_standard_size, with_pipe_ends
from pipeworkbench.recon.adjustment.normal_equations import FRAME_UNITS, Frame, Unknowns, unknowns_of
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.vectors import as_vector, nearest_on_line, unit
from pipeworkbench.recon.views import View

LEAST_LENGTH = 1.0  # mm; what stands for an elbow without a bend is no shorter


@dataclass(frozen=True, eq=False)
class State:
    """Components, cameras (in the common frame) and stations' poses at one moment of the iteration.

    ``free`` names for each component the parameters that are unknowns; ``joints`` are the numbers of those that count.
    Elbows that do not bend are no tori: they stay, nothing is joined to them, and a pipe between their ends stands for them.
    """

    problem: Problem
    components: tuple[AnyComponent, ...]
    free: tuple[frozenset[str], ...]
    joints: tuple[int, ...]
    views: tuple[View, ...]
    cameras: tuple[Camera, ...]
    station_of_view: tuple[int, ...]
    poses: tuple[Array, ...]
    frames: tuple[Frame, ...]

    @classmethod
    def of(cls, problem: Problem, settings: AdjustmentSettings) -> State:
        """Return the state that a problem begins with."""
        free = tuple(_free(component, problem, settings) for component in problem.components)
        components = tuple(
            _standing_for(component) if _straight(component) else normalised(component) if names else component
            for component, names in zip(problem.components, free, strict=True)
        )
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
        every = tuple(number for number, joint in enumerate(problem.joints) if not ends & {joint.a, joint.b})
        state = cls(problem, components, free, every, tuple(views), tuple(cameras), tuple(station_of_view), poses, tuple(frames))
        return state.with_ends()

    def with_ends(self, *, exact: bool = False) -> State:
        """Return the state with pipes that end where what is joined to them begins."""
        kept = frozenset(row for row, names in enumerate(self.free) if not names)
        joints = [self.problem.joints[number] for number in self.joints]
        components = with_pipe_ends(self.components, joints, kept, exact=exact)
        for row, anchor in self._anchors().items():
            # to the second order a turn shifts what it is to be about
            components[row] = _through(components[row], anchor)
        return replace(self, components=tuple(components))

    def _anchors(self) -> dict[int, Array]:
        """Return by row where pipes whose position is held were given: the middle (3,), mm; an axis has no other point that stays."""
        found = {}
        for row, given in enumerate(self.problem.components):
            if isinstance(given, Pipe) and self.free[row] and POSITION in self.problem.held.get(given.id, ()):
                found[row] = np.add(given.start, given.end) / 2
        return found

    def without(self, joints: frozenset[int], frozen: Mapping[int, frozenset[str]]) -> State:
        """Return the state in which some joints do not count and parameters of components, by row, are held.

        A component that is held altogether is as it was given, and its joints do not count: nothing is drawn to it.
        """
        if not joints and not frozen:
            return self
        free = tuple(names - frozen.get(row, frozenset()) for row, names in enumerate(self.free))
        stays = {row for row, names in enumerate(free) if not names and self.free[row]}
        ids = {self.components[row].id for row in stays}
        left = tuple(n for n in self.joints if n not in joints and not ids & {self.problem.joints[n].a, self.problem.joints[n].b})
        components = tuple(self.problem.components[row] if row in stays else one for row, one in enumerate(self.components))
        return replace(self, free=free, joints=left, components=components)

    def unknowns(self) -> Unknowns:
        """Return the unknowns with their charts at the components as they are now."""
        anchors = self._anchors()
        return unknowns_of([chart_of(component, anchors.get(row)) for row, component in enumerate(self.components)], self.free, self.frames)

    def moved(self, unknowns: Unknowns, step: Array) -> State:
        """Return the state after a step (u,) of all unknowns."""
        motions = unknowns.motions(step)
        components = tuple(
            moved(component, motion) if names else component for component, motion, names in zip(self.components, motions, self.free, strict=True)
        )
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
        state = replace(self, components=components, cameras=tuple(cameras), poses=tuple(poses), frames=tuple(frames))
        return state.with_ends()


def _free(component: AnyComponent, problem: Problem, settings: AdjustmentSettings) -> frozenset[str]:
    """Return the names of the parameters that are unknowns."""
    if component.fixed or _straight(component):
        return frozenset()
    names = set(chart_of(component).names) - problem.held.get(component.id, frozenset())
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


def _through(component: AnyComponent, point: Array) -> AnyComponent:
    """Return a pipe shifted across its axis so that this goes through a point (3,), mm."""
    assert isinstance(component, Pipe)  # noqa: S101  # only pipes have anchors
    start, end = np.array(component.start), np.array(component.end)
    shift = point - nearest_on_line(point, start, unit(end - start))
    return component.with_ends(as_vector(start + shift), as_vector(end + shift))
