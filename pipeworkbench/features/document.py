# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipelines and stations in and out of FreeCAD documents."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import is_kind, refuse_newer
from pipeworkbench.features.component import component_of, set_component
from pipeworkbench.features.connections import ConnectionsFeature, data_of, is_needed, linked_joints, set_connections
from pipeworkbench.features.kinds import FEATURES, add_component, is_component
from pipeworkbench.features.project import georeference_of, make_project, project_of, set_georeference
from pipeworkbench.features.station import StationFeature, add_station_object, set_pose
from pipeworkbench.pipeline import AnyComponent, Matrix, Pipeline
from pipeworkbench.recon.station import Station


def stations_in(document: Any) -> list[Any]:
    """Return the station objects of a document."""
    return [obj for obj in document.Objects if is_kind(obj, StationFeature)]


def components_in(document: Any) -> list[Any]:
    """Return the component objects of a document."""
    return [obj for obj in document.Objects if is_component(obj)]


def connections_in(document: Any) -> dict[str, Any]:
    """Return the objects that hold what is known beyond components, by the name of their frame."""
    return {obj.FrameName: obj for obj in document.Objects if is_kind(obj, ConnectionsFeature)}


def add_station(document: Any, station: Station) -> Any:
    """Add a station, and a project to hold it where there is none; refuse a second one of the same name, which could not be told from the first.

    Raises
    ------
    InputError
        Where the document has a station of this name.
    """
    if any(obj.StationName == station.name for obj in stations_in(document)):
        raise InputError(station.source, "name", f"the document has a station '{station.name}' already", "use another document or rename the station")
    project = project_of(document) or make_project(document)
    obj = add_station_object(document, station)
    project.addObject(obj)
    return obj


def add_pipeline(document: Any, pipeline: Pipeline) -> list[Any]:
    """Add a pipeline's components, each into its station's group, with the joints between them, and return their objects.

    A component that the document holds already (the same pick, reconstructed again) is brought up to date
    in place, so that what depends on it stays; one that the user fixed is left alone.

    Raises
    ------
    InputError
        Where the document has a component of another kind under the same name, or a newer version of the workbench
        made an object that would have to be changed.
    """
    known = {obj.ComponentId: obj for obj in components_in(document)}
    objects: list[Any] = []
    made: dict[str, list[Any]] = {}
    for component in pipeline.components:
        obj = known.get(component.id)
        if obj is None:
            obj = add_component(document, component)
            made.setdefault(component.station or pipeline.frame, []).append(obj)
        else:
            _bring_up_to_date(obj, component)
        objects.append(obj)
    for station, measured in made.items():
        put_into_group(document, measured, station)
    _connect(document, pipeline, objects)
    return objects


def replace_components(document: Any, pipeline: Pipeline, chosen: Collection[str] | None = None) -> list[Any]:
    """Give a document's components what an adjustment or a merge made of them, in place, and return their objects.

    Parameters
    ----------
    document : FreeCAD document
    pipeline : Pipeline
        With all components of its frame; its joints, station poses and sigma0 take the place of the document's.
    chosen : collection of str, optional
        Ids of the components to change; all of the pipeline's where it is not given. Those that the user fixed stay as they are.

    Raises
    ------
    InputError
        Where the document does not have one of the components any more; nothing was changed then.
    """
    known = {obj.ComponentId: obj for obj in components_in(document)}
    missing = [component.id for component in pipeline.components if component.id not in known]
    if missing:
        raise InputError(document.Label, ", ".join(missing), "the document does not have these components any more", "start the adjustment again")
    for component in pipeline.components:
        if chosen is None or component.id in chosen:
            _bring_up_to_date(known[component.id], component)
    objects = [known[component.id] for component in pipeline.components]
    _connect(document, pipeline, objects)
    return objects


def remove_component(obj: Any) -> None:
    """Remove a component object from its document; what was joined to it has open ends then."""
    obj.Document.removeObject(obj.Name)


def put_into_group(document: Any, objects: Iterable[Any], station: str | None) -> None:
    """Put objects into the group of a station, into the project's where there is no station of this name."""
    group = next((other for other in stations_in(document) if other.StationName == station), None) or project_of(document)
    if group is not None:
        group.addObjects(list(objects))


def pipeline_of(document: Any, objects: Iterable[Any] | None = None, read: Callable[[Any], AnyComponent] = component_of) -> Pipeline:
    """Return the document's components (or those among ``objects``) as a pipeline, with the joints between them.

    A component whose station was deleted still names it: it was measured there. ``read`` returns an object's component, for
    those who know most of them already.

    Raises
    ------
    InputError
        Where there is no component, where they come from stations that are not merged, or where a newer version of
        the workbench made one of them.
    """
    chosen = [obj for obj in (document.Objects if objects is None else objects) if is_component(obj)]
    if not chosen:
        raise InputError(document.Label, "", "the document has no pipes or fittings", "reconstruct some picks first")
    components = tuple(read(obj) for obj in chosen)
    measured_by = {component.station for component in components if component.station}
    for obj in connections_in(document).values():
        refuse_newer(obj)
    data = frame_data(document, measured_by)
    bare = Pipeline(frame=data["frame"], components=components).to_dict()["components"]
    joints = linked_joints(chosen, data["joints"])
    georeference = georeference_of(document)
    if georeference is not None and data.get("georeference", georeference)["frame"] == georeference["frame"]:
        data |= {"georeference": georeference}
    return Pipeline.from_dict(data | {"components": bare, "joints": joints}, source=document.Label)


def known_frames(document: Any) -> list[dict[str, Any]]:
    """Return the frames of which a document knows more than their components, as files have them, those of more stations first.

    So a merged frame comes before its stations' own, which may be left from before the merge.
    """
    known = [data for data in map(data_of, connections_in(document).values()) if {"frame", "stations"} <= data.keys()]
    return sorted(known, key=lambda data: -len(data["stations"]))


def frame_data(document: Any, stations: Collection[str]) -> dict[str, Any]:
    """Return the frame in which lies what these stations measured, as a file has it, without its components.

    What nobody measured lies in the first station's.

    Raises
    ------
    InputError
        Where the stations are not merged.
    """
    known, imported = known_frames(document), stations_in(document)
    first = imported[0].StationName if imported else document.Label

    def holding(names: Collection[str]) -> dict[str, Any] | None:
        return next((data for data in known if set(names) <= {data["frame"], *data["stations"]}), None)

    # without any station that was imported there may be a frame all the same
    found = holding(stations or [first]) or holding(stations)
    if found is None and len(stations) > 1:
        raise InputError(document.Label, "", "the components come from several stations that are not merged", "select those of one station")
    return found or Pipeline.of_station(next(iter(stations), first), ()).to_dict()


@dataclass(frozen=True)
class StationFrame:
    """The frame in which a station's components lie in the document: its own level frame, or the one it was merged into.

    Attributes
    ----------
    name : str
        Of the station that the frame belongs to.
    poses : dict of str to Matrix
        The motions (4 x 4, mm) from the level frames of all stations that share it, by their names.
    station : str
        The station that was asked about.
    """

    name: str
    poses: dict[str, Matrix]
    station: str

    @property
    def frame_from_level(self) -> Matrix:
        """The motion from the station's level frame."""
        return self.poses[self.station]

    @property
    def level_from_frame(self) -> Matrix:
        """The motion into the station's level frame."""
        return _as_matrix(np.linalg.inv(np.array(self.frame_from_level, float)).tolist())

    def holds(self, station: str | None) -> bool:
        """Tell whether what a station measured lies in this frame; what nobody measured lies in any."""
        return not station or station == self.name or station in self.poses


def frame_of(station_object: Any) -> StationFrame:
    """Return the frame of a station object's components: as merged, else its own."""
    station = station_object.StationName
    data = next((data for data in known_frames(station_object.Document) if station in data["stations"]), None)
    if data is None:
        return StationFrame(station, {station: Pipeline.of_station(station, ()).stations[station].frame_from_level}, station)
    return StationFrame(data["frame"], {name: _as_matrix(pose["frame_from_level"]) for name, pose in data["stations"].items()}, station)


def _as_matrix(rows: Sequence[Sequence[float]]) -> Matrix:
    return tuple((row[0], row[1], row[2], row[3]) for row in rows)


def _bring_up_to_date(obj: Any, component: AnyComponent) -> None:
    if not is_kind(obj, FEATURES[type(component)]):
        raise InputError(obj.Document.Label, obj.Label, f"is not a {component.kind}, as '{component.id}' now is", "delete or rename the object")
    if not obj.Fixed:
        set_component(obj, component)


def _connect(document: Any, pipeline: Pipeline, objects: Iterable[Any]) -> None:
    """Keep what a pipeline knows beyond its components."""
    connections = connections_in(document).get(pipeline.frame)
    if connections is None and is_needed(pipeline):
        connections = document.addObject("App::FeaturePython", "Connections")
        ConnectionsFeature(connections)
    if connections is not None:
        set_connections(connections, pipeline, objects)
    for station in stations_in(document):
        if station.StationName in pipeline.stations:
            set_pose(station, frame_of(station).frame_from_level)
    project = project_of(document)
    if project is not None:
        if connections is not None:
            project.addObject(connections)
        if "georeference" in pipeline.extra:
            set_georeference(project, pipeline.extra["georeference"])
