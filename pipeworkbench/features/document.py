# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipelines and stations in and out of FreeCAD documents."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import is_kind
from pipeworkbench.features.component import component_of, set_component
from pipeworkbench.features.connections import ConnectionsFeature, data_of, is_needed, set_connections
from pipeworkbench.features.kinds import FEATURES, add_component, is_component
from pipeworkbench.features.station import StationFeature, add_station_object
from pipeworkbench.pipeline import AnyComponent, Pipeline
from pipeworkbench.recon.station import Station


def stations_in(document: Any) -> list[Any]:
    """Return the station objects of a document."""
    return [obj for obj in document.Objects if is_kind(obj, StationFeature)]


def components_in(document: Any) -> list[Any]:
    """Return the component objects of a document."""
    return [obj for obj in document.Objects if is_component(obj)]


def connections_in(document: Any) -> dict[str, Any]:
    """Return the objects that hold joints and stations, by the name of their frame."""
    return {obj.FrameName: obj for obj in document.Objects if is_kind(obj, ConnectionsFeature)}


def add_station(document: Any, station: Station) -> Any:
    """Add a station; refuse a second one of the same name, which could not be told from the first.

    Raises
    ------
    InputError
        Where the document has a station of this name.
    """
    if any(obj.StationName == station.name for obj in stations_in(document)):
        raise InputError(station.source, "name", f"the document has a station '{station.name}' already", "use another document or rename the station")
    return add_station_object(document, station)


def add_pipeline(document: Any, pipeline: Pipeline) -> list[Any]:
    """Add a pipeline's components, each into its station's group, and return their objects.

    A component that the document holds already (the same pick, reconstructed again) is brought up to date
    in place, so that what depends on it stays; one that the user fixed is left alone.

    Raises
    ------
    InputError
        Where the document has a component of another kind under the same name.
    """
    groups = {obj.StationName: obj for obj in stations_in(document)}
    known = {obj.ComponentId: obj for obj in components_in(document)}
    objects = []
    for component in pipeline.components:
        obj = known.get(component.id)
        if obj is None:
            obj = add_component(document, component)
            group = groups.get(component.station or pipeline.frame)
            if group is not None:
                group.addObject(obj)
        elif not is_kind(obj, FEATURES[type(component)]):
            raise InputError(document.Label, obj.Label, f"is not a {component.kind}, as '{component.id}' now is", "delete or rename the object")
        elif not obj.Fixed:
            set_component(obj, component)
        objects.append(obj)
    connections = connections_in(document).get(pipeline.frame)
    if connections is None and is_needed(pipeline):
        connections = document.addObject("App::FeaturePython", "Connections")
        ConnectionsFeature(connections)
    if connections is not None:
        set_connections(connections, pipeline)
    return objects


def pipeline_of(document: Any, objects: Iterable[Any] | None = None) -> Pipeline:
    """Return the document's components (or those among ``objects``) as a pipeline, with the joints between them.

    Raises
    ------
    InputError
        Where there is no component, or where they come from stations that are not merged.
    """
    chosen = [obj for obj in (document.Objects if objects is None else objects) if is_component(obj)]
    if not chosen:
        raise InputError(document.Label, "", "the document has no pipes or fittings", "reconstruct some picks first")
    components = tuple(component_of(obj) for obj in chosen)
    measured_by = {component.station for component in components if component.station}
    merged = [data for data in map(data_of, connections_in(document).values()) if measured_by <= {data["frame"], *data["stations"]}]
    if merged:
        return _joined(document, merged[0], components)
    if len(measured_by) > 1:
        raise InputError(document.Label, "", "the components come from several stations that are not merged", "select those of one station")
    stations = stations_in(document)
    frame = next(iter(measured_by), stations[0].StationName if stations else document.Label)
    return Pipeline.of_station(frame, components)


def _joined(document: Any, data: dict[str, Any], components: tuple[AnyComponent, ...]) -> Pipeline:
    """Return components with what the document knows beyond them; joints to what is not among them are left out."""
    held = {component.id for component in components}
    bare = Pipeline(frame=data["frame"], components=components).to_dict()["components"]
    joints = [joint for joint in data["joints"] if {joint["a"], joint["b"]} <= held]
    return Pipeline.from_dict(data | {"components": bare, "joints": joints}, source=document.Label)
