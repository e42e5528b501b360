# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station's components for measuring, in its level frame, and what was measured back into the document."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pipeworkbench.features.component import component_of
from pipeworkbench.features.connections import data_of
from pipeworkbench.features.document import add_pipeline, components_in, connections_in
from pipeworkbench.pipeline import AnyComponent, Joint, Matrix, Pipeline, StationPose, moved

IDENTITY: Matrix = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def components_of(station_object: Any) -> tuple[AnyComponent, ...]:
    """Return the components that were measured in a station's frame, in its level frame.

    Those of stations that are merged with it are among them, for pipes go on from one viewpoint to the next.
    """
    frame, stations, level_from_frame = _place_of(station_object)
    names = {None, station_object.StationName, frame, *stations}
    return tuple(
        moved(component, level_from_frame) for obj in components_in(station_object.Document) if (component := component_of(obj)).station in names
    )


def object_of(document: Any, component_id: str) -> Any:
    """Return the object of a component, None where there is none."""
    return next((obj for obj in components_in(document) if obj.ComponentId == component_id), None)


def put_into_document(station_object: Any, components: Sequence[AnyComponent], joints: Iterable[Joint] = ()) -> list[Any]:
    """Add components of a station's level frame to its document, or bring them up to date, with their joints; return their objects.

    Whoever calls it opens the transaction.
    """
    from pipeworkbench.gui.view_providers import show

    document = station_object.Document
    frame, stations, level_from_frame = _place_of(station_object)
    pipeline = Pipeline(
        frame=frame,
        components=tuple(moved(component, _inverse(level_from_frame)) for component in components),
        joints=tuple(joints),
        stations={name: StationPose(frame_from_level=pose) for name, pose in stations.items()},
    )
    known = {obj.Name for obj in document.Objects}
    objects = add_pipeline(document, pipeline)
    for obj in document.Objects:
        if obj.Name not in known:
            show(obj)
    return objects


def joints_among(
    before: Sequence[AnyComponent], after: Sequence[AnyComponent], changed: Iterable[AnyComponent]
) -> tuple[tuple[AnyComponent, ...], tuple[Joint, ...]]:
    """Return the joints of changed components, and what must be put into the document for them: what is joined to them now, or was.

    Parameters
    ----------
    before, after : sequence of components
        All of the station, as they were and as they are now.
    changed : components
        Those of ``after`` that are new or changed.
    """
    from pipeworkbench.recon.topology import join

    names = {component.id for component in changed}
    joints = tuple(joint for joint in join(after) if {joint.a, joint.b} & names)
    former = tuple(joint for joint in join(before) if {joint.a, joint.b} & names)
    concerned = names | {name for joint in (*joints, *former) for name in (joint.a, joint.b)}
    return tuple(component for component in after if component.id in concerned), joints


def next_pick_index(station_object: Any) -> int:
    """Return an index that no pick of a station has, neither in the document nor in the file beside the station: both name pipes."""
    station = station_object.StationName
    taken = [obj.Pick for obj in components_in(station_object.Document) if obj.StationName == station]
    beside = Path(station_object.StationFile).parent / "picks.json"
    try:
        count = len(json.loads(beside.read_text(encoding="utf-8"))["picks"])
    except (OSError, ValueError, KeyError, TypeError):
        count = 0  # there is none, or none that could be reconstructed
    return max([count - 1, *taken]) + 1


def in_document(station_object: Any, component: AnyComponent) -> AnyComponent:
    """Return a component of a station's level frame in the frame of the document."""
    return moved(component, _inverse(_place_of(station_object)[2]))


def _place_of(station_object: Any) -> tuple[str, dict[str, Matrix], Matrix]:
    """Return the frame of a station's components, the poses in it of the stations that share it, and the motion from it to the level frame."""
    name = station_object.StationName
    for data in map(data_of, connections_in(station_object.Document).values()):
        poses = {key: pose["frame_from_level"] for key, pose in data.get("stations", {}).items()}
        if name in poses:
            return data["frame"], poses, _inverse(poses[name])
    return name, {name: IDENTITY}, IDENTITY


def _inverse(motion: Matrix) -> Matrix:
    """Return the inverse of a rigid motion (4 x 4)."""
    rows: list[list[float]] = np.linalg.inv(np.array(motion, float)).tolist()
    return tuple((row[0], row[1], row[2], row[3]) for row in rows)
