# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station: a rig of oriented cameras and their images, read from ``station.json``.

Cameras come out in the station's level frame (x right, y forward, z up), so that nothing after this
module needs to know about rigs and inclination sensors.
"""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter, field_validator
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, read_json, warn_of_unknown_keys, written_whole
from pipeworkbench.recon.camera import Array, Camera, Interior, OpenCVInterior, PhotogrammetricInterior

log = logging.getLogger(__name__)

SCHEMA = "pipeworkbench-station/1"
ORTHONORMAL_TOLERANCE = 1e-5  # largest entry of R R^T - I; files with six decimals stay below it
DISTORTION_LENGTHS = (0, 4, 5, 8, 12, 14)  # what OpenCV's functions take

MOST_PIXELS = 100_000  # along one side of an image
LARGEST_RIG = 1e6  # mm from the first camera to another
SMALLEST_FIELD_DEG, LARGEST_FIELD_DEG = 1.0, 170.0  # angle of view across the diagonal
LARGEST_STRETCH = 100.0  # of an area in the image by the distortion, between any two places
ROUND_TRIP_PX = 0.01  # what a pixel may be off after the way to its ray and back

Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Positive = Annotated[Finite, Field(gt=0)]
Near = Annotated[Finite, Field(ge=-LARGEST_RIG, le=LARGEST_RIG)]
Row = tuple[Finite, Finite, Finite]
RotationMatrix = tuple[Row, Row, Row]


class _Photogrammetric(BaseModel):
    model: Literal["photogrammetric"]
    pixel_pitch: Positive
    principal_distance: Positive
    principal_point: tuple[Finite, Finite]
    A1: Finite = 0.0
    A2: Finite = 0.0
    B1: Finite = 0.0
    B2: Finite = 0.0
    C1: Finite = 0.0
    C2: Finite = 0.0
    r0: Finite = 0.0

    def interior(self, width: int, height: int) -> Interior:
        return PhotogrammetricInterior(width, height, **self.model_dump(exclude={"model"}))


class _OpenCV(BaseModel):
    model: Literal["opencv"]
    fx: Positive
    fy: Positive
    cx: Finite
    cy: Finite
    distortion: tuple[Finite, ...] = ()

    @field_validator("distortion")
    @classmethod
    def _known_length(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if len(value) not in DISTORTION_LENGTHS:
            raise ValueError(f"has {len(value)} coefficients, OpenCV knows {', '.join(map(str, DISTORTION_LENGTHS))}")
        return value

    def interior(self, width: int, height: int) -> Interior:
        return OpenCVInterior(width, height, **self.model_dump(exclude={"model"}))


def _orthonormal(value: RotationMatrix) -> RotationMatrix:
    matrix = np.array(value)
    deviation = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
    if deviation > ORTHONORMAL_TOLERANCE:
        raise ValueError(f"not a rotation: its rows are not orthonormal (deviation {deviation:.2g})")
    if np.linalg.det(matrix) < 0:
        raise ValueError("not a rotation but a reflection (determinant -1)")
    return value


class _Exterior(BaseModel):
    rotation_rig_to_camera: RotationMatrix
    projection_centre: tuple[Near, Near, Near]

    _check = field_validator("rotation_rig_to_camera")(_orthonormal)


class _Camera(BaseModel):
    name: Annotated[str, Field(min_length=1)]
    image: Annotated[str, Field(min_length=1)]
    width: Annotated[int, Field(ge=16, le=MOST_PIXELS, strict=True)]
    height: Annotated[int, Field(ge=16, le=MOST_PIXELS, strict=True)]
    interior: Annotated[_Photogrammetric | _OpenCV, Field(discriminator="model")]
    exterior: _Exterior


class _Station(BaseModel):
    schema_name: Annotated[Literal["pipeworkbench-station/1"], Field(alias="schema")]
    name: Annotated[str, Field(min_length=1)]
    length_unit: Literal["mm"] = "mm"
    cameras: Annotated[list[_Camera], Field(min_length=2)]
    level_from_rig: RotationMatrix

    _check = field_validator("level_from_rig")(_orthonormal)


@dataclass(frozen=True, eq=False)
class Station:
    """Cameras in the station's level frame and where their images lie; ``source`` is the file."""

    name: str
    cameras: tuple[Camera, ...]
    images: tuple[Path, ...]
    source: Path

    def camera_index(self, name: str) -> int | None:
        """Return the index of the camera with this name, None where there is none."""
        return next((i for i, camera in enumerate(self.cameras) if camera.name == name), None)


def read_station(path: Path) -> Station:
    """Read ``station.json`` (or the folder that holds it) and check that the images are there.

    Raises
    ------
    InputError
        Where the file or an image is missing or a value does not fit; names file, key and remedy.
    """
    source = path / "station.json" if path.is_dir() else path
    return station_from(read_json(source), source)


def station_from(data: Any, source: Path, images: Mapping[str, Path] | None = None) -> Station:
    """Check the structure of a ``station.json`` and return it as a station.

    Parameters
    ----------
    data : object
        What the file holds.
    source : Path
        The file, which relative names of images are relative to and errors name.
    images : mapping, optional
        Where the images of cameras are instead, by the cameras' names.

    Raises
    ------
    InputError
        Where an image is missing or a value does not fit; names file, key and remedy.
    """
    station = _checked(data, source)
    given = images or {}
    paths = tuple(given.get(camera.name, source.parent / camera.image) for camera in station.cameras)
    seen: dict[Path, int] = {}
    for index, image in enumerate(paths):
        key = f"cameras[{index}].image"
        if not _is_file(image):
            raise InputError(source, key, f"there is no file {image}", "put the image there or correct the name")
        earlier = seen.setdefault(image.resolve(), index)
        if earlier != index:
            raise InputError(source, key, f"is the image of cameras[{earlier}] as well", "give each camera its own photograph")
    return Station(station.name, _oriented(station), paths, source)


def cameras_from(data: Any, source: Path) -> tuple[Camera, ...]:
    """Return the cameras of a ``station.json``'s structure in the station's level frame; their images need not be there.

    Raises
    ------
    InputError
        Where a value does not fit.
    """
    return _oriented(_checked(data, source))


def _checked(data: Any, source: Path) -> _Station:
    """Check everything of a ``station.json``'s structure but its images."""
    if not isinstance(data, dict):
        raise InputError(source, "", "is not a JSON object", f"give a file of schema {SCHEMA}")
    if data.get("schema") != SCHEMA:
        raise InputError(source, "schema", f"is {data.get('schema')!r}", f"give a file of schema {SCHEMA}")
    _look_at_keys(data, source)
    station = check(TypeAdapter(_Station), data, source)
    names = [camera.name for camera in station.cameras]
    if len(set(names)) < len(names):
        raise InputError(source, "cameras", f"names are not unique ({', '.join(names)})", "give each camera its own name")
    cameras = _oriented(station)
    for index, camera in enumerate(cameras):
        _refuse_impossible_lens(camera.interior, f"cameras[{index}].interior", source)
    _refuse_single_viewpoint(cameras, source)
    return station


def _oriented(station: _Station) -> tuple[Camera, ...]:
    """Return the cameras in the station's level frame."""
    level_from_rig = _rotation(station.level_from_rig)
    return tuple(
        Camera(
            camera.name,
            camera.interior.interior(camera.width, camera.height),
            _rotation(camera.exterior.rotation_rig_to_camera) @ level_from_rig.T,
            level_from_rig @ np.array(camera.exterior.projection_centre),
        )
        for camera in station.cameras
    )


def write_station(station: Station, path: Path) -> None:
    """Write a station as the file that `read_station` takes, whole or not at all.

    The rig's axes are the first camera's; the origin stays where it is. Images are named relative to the file.

    Raises
    ------
    InputError
        Where the file cannot be written or would be refused on reading; then nothing is left behind.
    """
    level_from_rig = station.cameras[0].rotation.T
    data = {
        "schema": SCHEMA,
        "name": station.name,
        "length_unit": "mm",
        "level_from_rig": level_from_rig.tolist(),
        "cameras": [
            {
                "name": camera.name,
                "image": _relative(image, path),
                "width": camera.interior.width,
                "height": camera.interior.height,
                "interior": _interior_as_dict(camera.interior),
                "exterior": {
                    "rotation_rig_to_camera": (camera.rotation @ level_from_rig).tolist(),
                    "projection_centre": (level_from_rig.T @ camera.projection_centre).tolist(),
                },
            }
            for camera, image in zip(station.cameras, station.images, strict=True)
        ],
    }
    with written_whole(path) as temporary:
        temporary.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
        try:
            read_station(temporary)
        except InputError as error:
            if error.source != str(temporary):
                raise
            raise InputError(path, error.key, error.problem, error.remedy) from None


def _relative(image: Path, station_file: Path) -> str:
    """Return an image's path relative to the station's file, with forward slashes."""
    # folders are resolved, so that the way up through a link leads where the system goes; the image may be a link itself
    folder, here = image.absolute().parent.resolve(), station_file.absolute().parent.resolve()
    try:
        return Path(os.path.relpath(folder / image.name, here)).as_posix()
    except ValueError:  # another drive of Windows
        raise InputError(image, "", f"is on another drive than {station_file}", "put both on one drive") from None


def _interior_as_dict(interior: Interior) -> dict[str, Any]:
    """Return an interior orientation as the file's structure."""
    model: type[BaseModel]
    if isinstance(interior, OpenCVInterior):
        name, model = "opencv", _OpenCV
    elif isinstance(interior, PhotogrammetricInterior):
        name, model = "photogrammetric", _Photogrammetric
    else:
        raise TypeError(f"no file format for {type(interior).__name__}")
    return {"model": name} | {key: getattr(interior, key) for key in model.model_fields if key != "model"}


def _rotation(matrix: RotationMatrix) -> Array:
    """Return the nearest exact rotation matrix (3, 3): files are rounded."""
    return np.asarray(Rotation.from_matrix(matrix).as_matrix())


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name that no file system takes
        return False


def _refuse_impossible_lens(interior: Interior, key: str, source: Path) -> None:
    """Refuse an interior orientation that does not map its own image to rays and back."""
    u, v = np.meshgrid(np.linspace(0, interior.width - 1, 13), np.linspace(0, interior.height - 1, 9))
    pixels = np.column_stack([u.ravel(), v.ravel()])
    with np.errstate(all="ignore"):
        ideal = interior.ideal(pixels)
        back = interior.pixels(ideal) if np.isfinite(ideal).all() else np.full_like(pixels, np.nan)
        turned = np.linalg.det(interior.pixel_derivative(ideal, pixels)) if np.isfinite(back).all() else np.zeros(1)
        corners = np.column_stack([ideal[[0, -1]], np.ones(2)])
        corners /= np.linalg.norm(corners, axis=1, keepdims=True)
        field = float(np.degrees(np.arccos(np.clip(corners[0] @ corners[1], -1, 1))))
    remedy = "check the calibration and its units (principal distance and pixel pitch in mm, focal lengths in pixels)"
    if not (np.abs(back - pixels).max() <= ROUND_TRIP_PX and (turned > 0).all() and turned.max() < LARGEST_STRETCH * turned.min()):
        raise InputError(source, key, "the distortion folds or tears the image: pixels and rays do not belong together one to one", remedy)
    if not SMALLEST_FIELD_DEG <= field <= LARGEST_FIELD_DEG:
        raise InputError(source, key, f"the angle of view is {field:.3g} deg across the diagonal", remedy)


def _refuse_single_viewpoint(cameras: tuple[Camera, ...], source: Path) -> None:
    centres = np.array([camera.projection_centre for camera in cameras])
    if np.linalg.norm(centres - centres[0], axis=1).max() < 1.0:
        raise InputError(source, "cameras", "all projection centres coincide (within 1 mm)", "give them in mm; a base is needed for depth")


def _look_at_keys(data: dict[str, Any], source: Path) -> None:
    """Refuse misspelt keys and tell of unknown ones, at every level."""

    def look(values: object, model: type[BaseModel], location: str) -> None:
        if isinstance(values, dict):
            warn_of_unknown_keys(values, [f.alias or n for n, f in model.model_fields.items()], source, location, log.warning)

    look(data, _Station, "")
    cameras = data.get("cameras")
    for index, camera in enumerate(cameras if isinstance(cameras, list) else []):
        if isinstance(camera, dict):
            look(camera, _Camera, f"cameras[{index}]")
            look(camera.get("exterior"), _Exterior, f"cameras[{index}].exterior")
            interior = camera.get("interior")
            if isinstance(interior, dict):
                model = _OpenCV if interior.get("model") == "opencv" else _Photogrammetric
                look(interior, model, f"cameras[{index}].interior")
