# SPDX-License-Identifier: LGPL-2.1-or-later
"""The station in a document: a group that knows its calibration file and holds what was measured from it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import READ_ONLY, Feature, Property
from pipeworkbench.recon.station import Station, read_station


class StationFeature(Feature):
    """Proxy of a station: an oriented rig of cameras whose level frame is the document's frame."""

    type_name = "PipeWorkbench::Station"
    properties = (
        Property("StationFile", "App::PropertyFile", "Station", "station.json with the calibration of the cameras"),
        Property("StationName", "App::PropertyString", "Station", "Name in exchange files", READ_ONLY),
        Property("Cameras", "App::PropertyStringList", "Station", "Names of the cameras", READ_ONLY),
        Property("Images", "App::PropertyStringList", "Station", "Files of the photographs", READ_ONLY),
    )

    def execute(self, obj: Any) -> None:
        """Do nothing: a station has no shape."""


def add_station_object(document: Any, station: Station) -> Any:
    """Add a station to a document and return the object."""
    obj = document.addObject("App::DocumentObjectGroupPython", "Station")
    StationFeature(obj)
    obj.Label = f"Station {station.name}"
    obj.StationFile = str(station.source.resolve())
    obj.StationName = station.name
    obj.Cameras = [camera.name for camera in station.cameras]
    obj.Images = [str(image.resolve()) for image in station.images]
    return obj


def station_of(obj: Any) -> Station:
    """Return a station object's cameras and images, read anew from its file.

    Raises
    ------
    InputError
        Where the file has moved or no longer fits.
    """
    path = Path(obj.StationFile)
    if not path.is_file():
        # a document that travelled with its photographs: look beside it
        beside = Path(obj.Document.FileName).parent / path.parent.name / path.name
        if not (obj.Document.FileName and beside.is_file()):
            raise InputError(obj.Label, "StationFile", f"there is no file {path}", "set the property to where station.json is now")
        path = beside
    return read_station(path)
