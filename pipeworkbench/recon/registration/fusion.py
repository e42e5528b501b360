# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several stations' components in one frame become one pipeline: what they saw twice is fused, pieces of one pipe are joined."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import SHORTEST_GAP, AnyComponent, Cap, Flange, Joint, Pipe, Pipeline, Reducer, StationPose, free_id, moved
from pipeworkbench.recon.accuracy import level_of_accuracy
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.ends import SIGMA_FACTOR
from pipeworkbench.recon.registration.corners import closed
from pipeworkbench.recon.registration.fused_axes import FusedAxis, Reach, fused_axis, fused_point, reaches
from pipeworkbench.recon.registration.grouping import in_frame, same_things
from pipeworkbench.recon.registration.landmarks import PIPE, Landmarks, landmarks_of
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.settings import FusionSettings
from pipeworkbench.recon.topology import join
from pipeworkbench.recon.vectors import as_vector, nearest_on_line, rounded, unit

PORT_MM = 80.0  # ports of members are the fused component's nearest one within this


@dataclass(frozen=True, eq=False)
class Merged:
    """One pipeline of several stations; ``sources`` names for each of its components, by id, the ids it was made of per station."""

    pipeline: Pipeline
    sources: Mapping[str, Mapping[str, tuple[str, ...]]]


@dataclass(frozen=True, eq=False)
class _Seen:
    """All components in one frame, n in number: their landmarks, station (n,) rows and ids before."""

    components: tuple[AnyComponent, ...]
    marks: Landmarks
    station: NDArray[np.intp]
    names: tuple[str, ...]


def merge(pipelines: Sequence[Pipeline], poses: Sequence[Pose], settings: FusionSettings | None = None) -> Merged:
    """Return one pipeline of several stations in the frame of the first, whose pose leaves it where it is.

    Parameters
    ----------
    pipelines : sequence of Pipeline
        Each in the level frame of its station.
    poses : sequence of Pose
        From each one's frame to the common one.
    settings : FusionSettings, optional

    Returns
    -------
    Merged
        Pipes have the axis that fits all stations best and the longest extent; other components lie at the weighted mean. A component's
        ``pick`` is the first station's, ``picks`` among its extra keys holds each station's.
    """
    settings = settings or FusionSettings()
    seen = _seen(pipelines, poses)
    groups = same_things(seen.marks, seen.station, settings) if len(seen.names) else []
    fused: list[AnyComponent] = []
    members: list[NDArray[np.intp]] = []
    used: set[str] = set()
    for rows in sorted(groups, key=lambda rows: int(rows[0])):
        for component, own in _fused(seen, rows, settings):
            name = free_id(component.id, used)
            used.add(name)
            fused.append(_attributed(replace(component, id=name), seen, own))
            members.append(own)
    joints = _carried(seen, pipelines, fused, members)
    components = closed(fused, joints)
    found = join(components)
    taken = {(j.a, j.a_port) for j in found} | {(j.b, j.b_port) for j in found}
    carried = [j for j in joints if (j.a, j.a_port) not in taken and (j.b, j.b_port) not in taken]
    stations = {
        name: StationPose(frame_from_level=(pose @ Pose.from_matrix(own.frame_from_level)).matrix(), extra=dict(own.extra))
        for pipeline, pose in zip(pipelines, poses, strict=True)
        for name, own in pipeline.stations.items()
    }
    first = pipelines[0]
    extra = {key: value for pipeline in reversed(pipelines) for key, value in pipeline.extra.items()}
    pipeline = Pipeline(frame=first.frame, components=components, joints=(*found, *carried), stations=stations, sigma0=first.sigma0, extra=extra)
    return Merged(pipeline, {component.id: _sources(seen, own, pipelines) for component, own in zip(components, members, strict=True)})


def _seen(pipelines: Sequence[Pipeline], poses: Sequence[Pose]) -> _Seen:
    """Return all components in one frame; ids that several stations use get the station's name in front."""
    counts = Counter(component.id for pipeline in pipelines for component in pipeline.components)
    components = []
    for number, (pipeline, pose) in enumerate(zip(pipelines, poses, strict=True)):
        matrix = pose.matrix()
        for component in pipeline.components:
            name = component.id if counts[component.id] == 1 or number == 0 else f"{pipeline.frame}-{component.id}"
            components.append(replace(moved(component, matrix), id=name, sigma_position=pose.sigmas(component.sigma_position)))
    station = np.repeat(np.arange(len(pipelines)), [len(pipeline.components) for pipeline in pipelines])
    names = tuple(component.id for pipeline in pipelines for component in pipeline.components)
    return _Seen(tuple(components), in_frame([landmarks_of(pipeline) for pipeline in pipelines], poses), station, names)


def _fused(seen: _Seen, rows: NDArray[np.intp], settings: FusionSettings) -> list[tuple[AnyComponent, NDArray[np.intp]]]:
    """Return what a group becomes, with the rows of the members of each."""
    if len(rows) == 1:
        return [(seen.components[rows[0]], rows)]
    if seen.marks.kind[rows[0]] != PIPE:
        return [(_fused_anchor(seen, rows), rows)]
    axis = fused_axis(seen.marks, rows)
    return [(_fused_pipe(seen, part, axis), part.rows) for part in reaches(seen.marks, rows, seen.station, axis, settings)]


def _base_of(seen: _Seen, rows: NDArray[np.intp]) -> AnyComponent:
    """Return the member whose sizes and names stay: one the user fixed, one of a standard, the first station's, the best measured."""

    def rank(row: int) -> tuple[bool, bool, bool, int, float]:
        component = seen.components[row]
        approximate = isinstance(component, Pipe) and component.approximate
        quality = component.quality if component.quality is not None else np.inf
        return not component.fixed, component.standard is None, approximate, int(seen.station[row]), quality

    return seen.components[min((int(row) for row in rows), key=rank)]


def _fused_pipe(seen: _Seen, part: Reach, common: FusedAxis) -> Pipe:
    """Return one pipe of the members that lie in a part of a common axis; they alone fix where it runs there."""
    base = _base_of(seen, part.rows)
    axis = fused_axis(seen.marks, part.rows)
    places = (common.point + place * common.direction for place in (part.low, part.high))
    start, end = (nearest_on_line(place, axis.point, axis.direction) for place in places)
    pipes = [seen.components[row] for row in part.rows]
    if not isinstance(base, Pipe):
        raise TypeError(f"{base.id} is no pipe")
    if np.dot(end - start, np.subtract(base.end, base.start)) < 0:
        start, end = end, start
    sigma = np.sqrt(np.maximum(np.diag(axis.position), 0)) / SIGMA_FACTOR
    direction = float(np.degrees(np.sqrt(np.linalg.eigvalsh(axis.tilt)[-1]))) / SIGMA_FACTOR
    return replace(
        base,
        start=as_vector(start),
        end=as_vector(end),
        gaps=_gaps([pipe for pipe in pipes if isinstance(pipe, Pipe)], start, end),
        approximate=all(isinstance(pipe, Pipe) and pipe.approximate for pipe in pipes),
        sigma_position=rounded(sigma, 4),
        sigma_direction_deg=round(direction, 5),
        loa=level_of_accuracy(float(np.linalg.norm(sigma))),
    )


def _gaps(pipes: Sequence[Pipe], start: Array, end: Array) -> tuple[tuple[float, float], ...] | None:
    """Return the parts, mm from the start, that no member saw."""
    length = float(np.linalg.norm(end - start))
    axis = (end - start) / length
    covered: list[tuple[float, float]] = []
    for pipe in pipes:
        along = [float((np.array(point) - start) @ axis) for point in (pipe.start, pipe.end)]
        way = 1.0 if along[1] >= along[0] else -1.0
        bounds = [0.0, *(value for gap in pipe.gaps or () for value in gap), pipe.length]
        covered += [
            (min(pair), max(pair))
            for first, last in zip(bounds[::2], bounds[1::2], strict=True)
            for pair in [(along[0] + way * first, along[0] + way * last)]
        ]
    found, reach = [], max(0.0, min((low for low, _ in covered), default=0.0))
    for low, high in sorted(covered):
        if low - reach >= SHORTEST_GAP and reach < length:
            found.append((round(reach, 1), round(min(low, length), 1)))
        reach = max(reach, high)
    return tuple(found) or None


def _fused_anchor(seen: _Seen, rows: NDArray[np.intp]) -> AnyComponent:
    """Return the best member at the weighted mean of all."""
    base = _base_of(seen, rows)
    own = next(row for row in rows if seen.components[row] is base)
    place, covariance = fused_point(seen.marks, rows)
    shift = Pose(np.eye(3), place - seen.marks.point[own])
    component = moved(base, shift.matrix())
    if any(seen.components[row].sigma_position is not None for row in rows):
        component = replace(component, sigma_position=rounded(np.sqrt(np.diag(covariance)) / SIGMA_FACTOR, 4))
    if isinstance(component, Flange | Reducer | Cap):
        component = replace(component, axis=as_vector(unit(seen.marks.axis[rows].mean(0))))
    return component


def _attributed(component: AnyComponent, seen: _Seen, rows: NDArray[np.intp]) -> AnyComponent:
    """Return a component with the picks and stations it comes from."""
    picks = {c.station: c.pick for row in rows if (c := seen.components[row]).station is not None and c.pick is not None}
    own = [c.pick for row in rows if seen.station[row] == 0 and (c := seen.components[row]).pick is not None]
    extra = dict(component.extra)
    if picks:
        extra["picks"] = {**picks, **extra.get("picks", {})}
    if len(rows) > 1:
        extra["stations"] = sorted({c.station for row in rows if (c := seen.components[row]).station is not None})
    return replace(component, pick=own[0] if own else None, extra=extra)


def _sources(seen: _Seen, rows: NDArray[np.intp], pipelines: Sequence[Pipeline]) -> dict[str, tuple[str, ...]]:
    return {
        pipelines[number].frame: tuple(seen.names[row] for row in rows if seen.station[row] == number) for number in np.unique(seen.station[rows])
    }


def _carried(seen: _Seen, pipelines: Sequence[Pipeline], fused: Sequence[AnyComponent], members: Sequence[NDArray[np.intp]]) -> tuple[Joint, ...]:
    """Return the stations' joints between the fused components, each port once, the first station's first."""
    homes: dict[int, list[int]] = {}
    for number, rows in enumerate(members):
        for row in rows:
            homes.setdefault(int(row), []).append(number)
    row_of = {(int(station), name): row for row, (station, name) in enumerate(zip(seen.station, seen.names, strict=True))}
    taken: set[tuple[int, int]] = set()
    found = []
    for number, pipeline in enumerate(pipelines):
        for joint in pipeline.joints or join(pipeline.components):
            ends = [
                _port_of(seen.components[row], int(port), [(home, fused[home]) for home in homes.get(row, ())])
                for row, port in ((row_of[number, joint.a], joint.a_port), (row_of[number, joint.b], joint.b_port))
            ]
            a, b = ends
            if a is None or b is None or a[0] == b[0] or a in taken or b in taken:
                continue
            taken |= {a, b}
            found.append(Joint(a=fused[a[0]].id, a_port=a[1], b=fused[b[0]].id, b_port=b[1], extra=joint.extra))  # type: ignore[arg-type]  # 0, 1 or 2
    return tuple(found)


def _port_of(member: AnyComponent, port: int, homes: Sequence[tuple[int, AnyComponent]]) -> tuple[int, int] | None:
    """Return which fused component, and which of its ports, a member's port became."""
    there = member.ports[port]
    best: tuple[float, int, int] | None = None
    for number, component in homes:
        for index, own in enumerate(component.ports):
            distance = float(np.linalg.norm(np.subtract(own.point, there.point)))
            if np.dot(own.direction, there.direction) > 0 and distance <= PORT_MM and (best is None or distance < best[0]):
                best = (distance, number, index)
    return None if best is None else best[1:]
