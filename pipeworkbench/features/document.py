# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipelines and stations in and out of FreeCAD documents."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import is_kind
from pipeworkbench.features.pipe import PipeFeature, add_pipe, pipe_of, set_pipe
from pipeworkbench.features.station import StationFeature, add_station_object
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import Station


def stations_in(document: Any) -> list[Any]:
    """Return the station objects of a document."""
    return [obj for obj in document.Objects if is_kind(obj, StationFeature)]


def pipes_in(document: Any) -> list[Any]:
    """Return the pipe objects of a document."""
    return [obj for obj in document.Objects if is_kind(obj, PipeFeature)]


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
    """Add a pipeline's pipes, each into its station's group, and return their objects.

    A pipe that the document holds already (the same pick, reconstructed again) is brought up to date
    in place, so that what depends on it stays; one that the user fixed is left alone.
    """
    groups = {obj.StationName: obj for obj in stations_in(document)}
    known = {obj.ComponentId: obj for obj in pipes_in(document)}
    objects = []
    for pipe in pipeline.pipes:
        obj = known.get(pipe.id)
        if obj is None:
            obj = add_pipe(document, pipe)
            group = groups.get(pipe.station or pipeline.frame)
            if group is not None:
                group.addObject(obj)
        elif not obj.Fixed:
            set_pipe(obj, pipe)
        objects.append(obj)
    return objects


def pipeline_of(document: Any, objects: Iterable[Any] | None = None) -> Pipeline:
    """Return the document's pipes (or those among ``objects``) as a pipeline.

    Raises
    ------
    InputError
        Where there is no pipe.
    """
    pipes = [obj for obj in (document.Objects if objects is None else objects) if is_kind(obj, PipeFeature)]
    if not pipes:
        raise InputError(document.Label, "", "the document has no pipes", "reconstruct some picks first")
    stations = stations_in(document)
    if len({obj.StationName for obj in pipes if obj.StationName}) > 1:
        raise InputError(document.Label, "", "the pipes come from several stations that are not merged", "select the pipes of one station")
    frame = pipes[0].StationName or (stations[0].StationName if stations else document.Label)
    return Pipeline.of_station(frame, tuple(pipe_of(obj) for obj in pipes))
