# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station's components for measuring, in its level frame, and what was measured back into the document."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any

from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import add_pipeline, components_in, frame_of
from pipeworkbench.features.preferences import assemble_settings
from pipeworkbench.features.station import station_file
from pipeworkbench.pipeline import AnyComponent, Joint, Pipeline, StationPose, moved


def components_of(station_object: Any) -> tuple[AnyComponent, ...]:
    """Return the components that were measured in a station's frame, in its level frame.

    Those of stations that are merged with it are among them, for pipes go on from one viewpoint to the next.
    """
    frame = frame_of(station_object)
    level_from_frame = frame.level_from_frame
    components = (component_of(obj) for obj in components_in(station_object.Document) if frame.holds(obj.StationName))
    return tuple(moved(component, level_from_frame) for component in components)


def object_of(document: Any, component_id: str) -> Any:
    """Return the object of a component, None where there is none."""
    return next((obj for obj in components_in(document) if obj.ComponentId == component_id), None)


def put_into_document(station_object: Any, components: Sequence[AnyComponent], joints: Iterable[Joint] = ()) -> list[Any]:
    """Add components of a station's level frame to its document, or bring them up to date, with their joints; return their objects.

    Whoever calls it opens the transaction.
    """
    frame = frame_of(station_object)
    pipeline = Pipeline(
        frame=frame.name,
        components=tuple(moved(component, frame.frame_from_level) for component in components),
        joints=tuple(joints),
        stations={name: StationPose(frame_from_level=pose) for name, pose in frame.poses.items()},
    )
    return add_pipeline(station_object.Document, pipeline)


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

    names, settings = {component.id for component in changed}, assemble_settings().topology
    joints = tuple(joint for joint in join(after, settings) if {joint.a, joint.b} & names)
    former = tuple(joint for joint in join(before, settings) if {joint.a, joint.b} & names)
    concerned = names | {name for joint in (*joints, *former) for name in (joint.a, joint.b)}
    return tuple(component for component in after if component.id in concerned), joints


def next_pick_index(station_object: Any) -> int:
    """Return an index that no pick of a station has, neither in the document nor in the file beside the station: both name pipes."""
    station = station_object.StationName
    taken = [obj.Pick for obj in components_in(station_object.Document) if obj.StationName == station]
    calibration = station_file(station_object)
    try:
        count = len(json.loads((calibration.parent / "picks.json").read_text(encoding="utf-8"))["picks"]) if calibration else 0
    except (OSError, ValueError, KeyError, TypeError):
        count = 0  # there are none, or none that could be reconstructed
    return max([count - 1, *taken]) + 1


def in_document(station_object: Any, components: Iterable[AnyComponent]) -> list[AnyComponent]:
    """Return components of a station's level frame in the frame of the document."""
    frame_from_level = frame_of(station_object).frame_from_level
    return [moved(component, frame_from_level) for component in components]
