# SPDX-License-Identifier: LGPL-2.1-or-later
"""The station in a document: a group that knows the calibration of its cameras and where the photographs are.

The calibration is kept in the document. The photographs are files beside it, named relative to the document, so that both
can travel together; on request the document holds them itself. Where files were moved away, ``relocate`` finds them again.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_kind, is_newer, is_restoring, refuse_newer
from pipeworkbench.files import read_json
from pipeworkbench.pipeline import Matrix
from pipeworkbench.recon.camera import Camera
from pipeworkbench.recon.station import Station, cameras_from, station_from

EMBEDDED = "EmbeddedImage"  # and the camera's number: one property for each photograph that the document holds
FIND_THEM = "say where the photographs are now (Find Photographs in the station's context menu)"


class StationFeature(Feature):
    """Proxy of a station: an oriented rig of cameras whose level frame is the document's frame, unless it was merged with others."""

    type_name = "PipeWorkbench::Station"
    version = 2
    properties = (
        Property("StationFile", "App::PropertyString", "Station", "station.json with the calibration, relative to the document", READ_ONLY),
        Property("StationName", "App::PropertyString", "Station", "Name in exchange files", READ_ONLY),
        Property("Cameras", "App::PropertyStringList", "Station", "Names of the cameras", READ_ONLY),
        Property("Images", "App::PropertyStringList", "Station", "Files of the photographs, relative to the document", READ_ONLY),
        Property("EmbedImages", "App::PropertyBool", "Station", "Keep the photographs inside the document, which makes its file larger"),
        Property("Pose", "App::PropertyPlacement", "Station", "Where the station's level frame lies in the document's frame", READ_ONLY),
        Property("Calibration", "App::PropertyString", "Base", "What station.json holds", HIDDEN),
        Property("KnownFiles", "App::PropertyStringList", "Base", "Where station.json and the photographs were found last", HIDDEN),
    )
    _settling = False

    def execute(self, obj: Any) -> None:
        """Do nothing: a station has no shape."""

    def onChanged(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Take the photographs into the document, or out of it, as the user wishes."""
        if name != "EmbedImages" or self._settling or is_restoring(obj) or is_newer(obj) or "KnownFiles" not in obj.PropertiesList:
            return
        self._settling = True
        try:
            (embed_images if obj.EmbedImages else release_images)(obj)
        except InputError as error:
            obj.EmbedImages = not obj.EmbedImages
            FreeCAD.Console.PrintError(f"{error}\n")
        finally:
            self._settling = False

    def migrate(self, obj: Any, version: int, replaced: dict[str, Any]) -> None:
        """Version 1 had absolute names of files alone."""
        if version < 2:
            obj.StationFile = replaced.get("StationFile", "")
            obj.KnownFiles = [obj.StationFile, *obj.Images]
            with contextlib.suppress(InputError):  # the file may have moved: whoever needs the station is told then
                calibration_of(obj)


class SaveObserver:
    """Names the files of all stations relative to a document that is saved, just before it is."""

    def slotStartSaveDocument(self, document: Any, path: str) -> None:  # FreeCAD's name
        """Name the files anew; a copy of the document elsewhere leaves the names as they are."""
        if Path(path) != Path(document.FileName):
            return
        for obj in document.Objects:
            if is_kind(obj, StationFeature) and not is_newer(obj):
                name_relative_to(obj, Path(path))


FreeCAD.addDocumentObserver(SaveObserver())


def add_station_object(document: Any, station: Station) -> Any:
    """Add a station to a document and return the object."""
    obj = document.addObject("App::DocumentObjectGroupPython", "Station")
    StationFeature(obj)
    obj.Label = f"Station {station.name}"
    obj.StationName = station.name
    obj.Cameras = [camera.name for camera in station.cameras]
    obj.Calibration = json.dumps(read_json(station.source))
    _remember_files(obj, [station.source, *station.images])
    return obj


def station_of(obj: Any) -> Station:
    """Return a station object's cameras and images.

    Raises
    ------
    InputError
        Where photographs have moved or the calibration no longer fits, or a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    calibration, files = calibration_of(obj), image_files(obj)
    missing = _missing(obj, files)
    if missing:
        names = ", ".join(path.name for path in missing)
        raise InputError(obj.Label, "Images", f"{names} cannot be found (last seen in {missing[0].parent})", FIND_THEM)
    source = station_file(obj) or Path(obj.KnownFiles[0])
    return station_from(calibration, source, {name: path for name, path in files.items() if path is not None})


def cameras_of(obj: Any) -> tuple[Camera, ...]:
    """Return a station object's cameras in its level frame; its photographs need not be there.

    Raises
    ------
    InputError
        Where the calibration does not fit, or cannot be found (documents of older versions do not hold it).
    """
    return cameras_from(calibration_of(obj), Path(obj.KnownFiles[0] if obj.KnownFiles else obj.StationFile))


def calibration_of(obj: Any) -> Any:
    """Return what a station object's ``station.json`` holds; it is taken into the document where that does not have it yet.

    Raises
    ------
    InputError
        Where neither the document nor a file has it.
    """
    if obj.Calibration:
        return json.loads(obj.Calibration)
    path = station_file(obj)
    if path is None:
        raise InputError(obj.Label, "StationFile", f"there is no file {obj.StationFile}", FIND_THEM)
    data = read_json(path)
    obj.Calibration = json.dumps(data)
    return data


def station_file(obj: Any) -> Path | None:
    """Return where a station object's ``station.json`` is; None where it cannot be found."""
    return next(_places(obj, 0, obj.StationFile), None)


def image_files(obj: Any) -> dict[str, Path | None]:
    """Return where the photographs are, by the names of their cameras; None for those that cannot be found."""
    return {
        camera: _embedded(obj, number) or next(_places(obj, number + 1, name), None)
        for number, (camera, name) in enumerate(zip(obj.Cameras, obj.Images, strict=True))
    }


def missing_images(obj: Any) -> list[Path]:
    """Return the photographs of a station object that cannot be found, each where it was seen last."""
    return _missing(obj, image_files(obj))


def relocate(obj: Any, place: Path) -> list[Path]:
    """Look for what a station object misses where one of its files, or their folder, is now.

    Parameters
    ----------
    obj : document object
    place : Path
        A folder, or one of the files in it; the others are looked for beside it, and in folders that are named as they were
        beside ``station.json``.

    Returns
    -------
    list of Path
        The photographs that are not there either, each where it was seen last.

    Raises
    ------
    InputError
        Where a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    folder = place if place.is_dir() else place.parent
    known = [Path(name) for name in obj.KnownFiles]
    files = []
    for path in known:
        beside = os.path.relpath(path, known[0].parent) if path.anchor == known[0].anchor else path.name
        tried = (folder / path.name, folder / beside, folder.parent / path.parent.name / path.name)
        files.append(next((candidate.resolve() for candidate in tried if candidate.is_file()), path))
    _remember_files(obj, files)
    return missing_images(obj)


def embed_images(obj: Any) -> None:
    """Take the photographs into the document.

    Raises
    ------
    InputError
        Where one of them cannot be found, or a newer version of the workbench made the object.
    """
    station = station_of(obj)
    for number, image in enumerate(station.images):
        name = f"{EMBEDDED}{number}"
        if name not in obj.PropertiesList:
            obj.addProperty("App::PropertyFileIncluded", name, "Base", "A photograph")
            obj.setEditorMode(name, HIDDEN)
        if _embedded(obj, number) is None:
            # names of their own: two folders may have photographs of one name
            setattr(obj, name, (str(image), f"{obj.Name}_{number}{image.suffix}"))
    _say_embedded(obj, embedded=True)


def release_images(obj: Any, folder: Path | None = None) -> None:
    """Take the photographs out of the document: it refers to their files again.

    Parameters
    ----------
    obj : document object
    folder : Path, optional
        Where to write them; without it their files must still be where they were.

    Raises
    ------
    InputError
        Where the files are not there any more: the document then keeps its photographs.
    """
    refuse_newer(obj)
    known = [Path(name) for name in obj.KnownFiles]
    held = {number: path for number in range(len(obj.Cameras)) if (path := _embedded(obj, number)) is not None}
    if folder is not None:
        for number, path in held.items():
            known[number + 1] = (folder / known[number + 1].name).resolve()
            known[number + 1].write_bytes(path.read_bytes())
        _remember_files(obj, known)
    lost = [known[number + 1].name for number in held if next(_places(obj, number + 1, obj.Images[number]), None) is None]
    if lost:
        problem = f"{', '.join(lost)} would be lost, for the files are not where they were"
        raise InputError(obj.Label, "EmbedImages", problem, "leave the photographs in the document or write them to a folder first")
    for number in held:
        obj.removeProperty(f"{EMBEDDED}{number}")
    _say_embedded(obj, embedded=False)


def set_pose(obj: Any, frame_from_level: Matrix) -> None:
    """Say where a station object's level frame lies in the document's frame."""
    pose = FreeCAD.Placement(FreeCAD.Matrix(*(value for row in frame_from_level for value in row)))
    if not is_newer(obj) and obj.Pose != pose:
        obj.Pose = pose


def name_relative_to(obj: Any, document_file: Path) -> None:
    """Name a station object's files relative to where its document is going to be."""
    found = [station_file(obj), *(next(_places(obj, number + 1, name), None) for number, name in enumerate(obj.Images))]
    files = [str(path or known) for path, known in zip(found, obj.KnownFiles, strict=True)]
    named = [_relative(Path(name), document_file.parent) for name in files]
    for name, value in (("KnownFiles", files), ("StationFile", named[0]), ("Images", named[1:])):
        if getattr(obj, name) != value:
            setattr(obj, name, value)


def _missing(obj: Any, files: Mapping[str, Path | None]) -> list[Path]:
    """Return those of the photographs' files that were not found, each where it was seen last."""
    known = [Path(name) for name in obj.KnownFiles[1:]] or [Path(name) for name in obj.Images]
    return [path for path, found in zip(known, files.values(), strict=True) if found is None]


def _remember_files(obj: Any, files: list[Path]) -> None:
    """Keep where ``station.json`` and the photographs are."""
    obj.KnownFiles = [str(path.resolve()) for path in files]
    folder = Path(obj.Document.FileName).parent if obj.Document.FileName else None
    named = [_relative(Path(name), folder) for name in obj.KnownFiles]
    obj.StationFile, obj.Images = named[0], named[1:]


def _relative(path: Path, folder: Path | None) -> str:
    """Return a file's name relative to a folder, with forward slashes; the whole name without a folder, or on another drive."""
    if folder is None or path.anchor != folder.resolve().anchor:
        return str(path)
    return Path(os.path.relpath(path, folder.resolve())).as_posix()


def _places(obj: Any, number: int, name: str) -> Iterator[Path]:
    """Yield where a file is: as it is named relative to the document, where it was last, or beside a document that travelled."""
    document = obj.Document.FileName
    known = Path(obj.KnownFiles[number]) if number < len(obj.KnownFiles) else Path(name)
    tried = [known]
    if document:
        folder = Path(document).parent
        tried = [folder / name, known, folder / known.parent.name / known.name, folder / known.name]
    yield from (path.resolve() for path in tried if path.is_file())


def _embedded(obj: Any, number: int) -> Path | None:
    """Return the file that FreeCAD unpacked of a photograph in the document; None where it has none."""
    path = getattr(obj, f"{EMBEDDED}{number}", "")
    return Path(path) if path and Path(path).is_file() else None


def _say_embedded(obj: Any, *, embedded: bool) -> None:
    settling, obj.Proxy._settling = obj.Proxy._settling, True  # noqa: SLF001  # of our own proxy
    obj.EmbedImages = embedded
    obj.Proxy._settling = settling  # noqa: SLF001
