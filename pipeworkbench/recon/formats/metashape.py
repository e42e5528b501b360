# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigs from Agisoft Metashape: the XML of File > Export > Export Cameras.

Frame cameras, with x = X/Z, y = Y/Z and r2 = x x + y y:
x' = x (1 + k1 r2 + k2 r2^2 + k3 r2^3 + k4 r2^4) + (p1 (r2 + 2 x x) + 2 p2 x y) (1 + p3 r2 + p4 r2^2),
y' = y (1 + ...) + (p2 (r2 + 2 y y) + 2 p1 x y) (1 + p3 r2 + p4 r2^2),
u = width / 2 + cx + x' (f + b1) + y' b2, v = height / 2 + cy + y' f; a fisheye takes x theta / r for x first.
So OpenCV's p1 is Metashape's p2 and the other way round, and k4, b2, p3, p4 are in no OpenCV model. Pixels are
counted from the image's corner. A camera's transform is chunk_from_camera, the chunk's (or its component's)
is world_from_chunk; the world is metric, and geocentric where the chunk's reference is not a local one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pipeworkbench.errors import COMMAND_LINE, InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior
from pipeworkbench.recon.formats.documents import read_xml
from pipeworkbench.recon.formats.fisheye import equidistant_factor
from pipeworkbench.recon.formats.fitting import fit_opencv
from pipeworkbench.recon.formats.rig import (
    METRE,
    Rig,
    View,
    image_size,
    number,
    numbers,
    opencv_interior,
    positive_focal_length,
    rigid_motion,
    rotation_matrix,
    select,
    short_forms,
)

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

HALF_PIXEL = 0.5
PARAMETERS = ("cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4")  # besides f; those at zero are left out
WITHOUT_EQUIVALENT = ("k4", "b2", "p3", "p4")
FRAME, FISHEYES = "frame", ("fisheye", "equidistant_fisheye")
FALSE = ("false", "0")
ECCENTRICITY_SQUARED = 0.00669437999  # of the ellipsoid WGS 84
EXPORT = "export it again with File > Export > Export Cameras"
REMEDY = "optimise the cameras in Metashape with f, cx, cy, b1, k1 to k3, p1 and p2 only, or export undistorted images"


@dataclass(frozen=True)
class _Block:
    """Cameras that are oriented in one frame: a component of a chunk."""

    key: str
    chunk: Element
    transform: Element | None
    cameras: tuple[Element, ...]


def read(path: Path, cameras: Sequence[str] | None = None) -> Rig:
    """Read the oriented, enabled cameras of a chunk.

    Raises
    ------
    InputError
        Where the file holds no poses or what does not fit.
    """
    root = read_xml(path)
    if root.tag == "calibration" or (root.tag == "document" and root.find("chunk") is None):
        raise InputError(path, root.tag, "is the calibration of a single camera or a project without poses", EXPORT)
    if root.tag != "document":
        raise InputError(path, root.tag, "is not a Metashape document", EXPORT)
    block = _wanted_block(list(_blocks(root)), cameras, path)
    world_rotation, world_translation, scale, unit, up_is_z = _world(block, path)
    sensors = {sensor.get("id"): sensor for sensor in block.chunk.iterfind("sensors/sensor")}
    lenses: dict[str | None, tuple[OpenCVInterior, float]] = {}
    names = [_label(camera) for camera in block.cameras]
    views = []
    for index in select(names, cameras, path):
        camera, key = block.cameras[index], f"camera '{names[index]}'"
        sensor = camera.get("sensor_id")
        if sensor not in sensors:
            raise InputError(path, f"{key}: sensor_id", f"there is no sensor '{sensor}'", EXPORT)
        if sensor not in lenses:
            lenses[sensor] = _interior(sensors[sensor], path, f"sensor '{sensor}'")
        values = numbers((camera.findtext("transform") or "").split(), 16, path, f"{key}: transform")
        chunk_from_camera, centre = rigid_motion(values, path, f"{key}: transform")
        rotation = (world_rotation @ chunk_from_camera).T
        position = scale * world_rotation @ centre + world_translation
        views.append(View(names[index], names[index], lenses[sensor][0], rotation, position, lenses[sensor][1]))
    up = _up(block.chunk, views[0].projection_centre) if up_is_z else None
    return Rig("metashape", path, tuple(views), unit, up, (path,))


def _label(camera: Element) -> str:
    return camera.get("label") or f"camera {camera.get('id')}"


def _blocks(root: Element) -> Iterator[_Block]:
    """Yield what is oriented in one frame, with enabled cameras that have a transform."""
    for number_of_chunk, chunk in enumerate(root.iterfind("chunk")):
        components = {component.get("id"): component for component in chunk.iterfind("components/component")}
        groups: dict[str | None, list[Element]] = {}
        for camera in chunk.iterfind("cameras//camera"):
            if camera.get("enabled", "true").lower() not in FALSE and (camera.findtext("transform") or "").strip():
                # a file with one component or none need not say which
                component = camera.get("component_id") if len(components) != 1 else next(iter(components))
                groups.setdefault(component, []).append(camera)
        for component, cameras in groups.items():
            transform = components[component].find("transform") if component in components else None
            if transform is None:
                transform = chunk.find("transform")
            yield _Block(f"chunk {number_of_chunk}, component {component}", chunk, transform, tuple(cameras))


def _wanted_block(blocks: Sequence[_Block], cameras: Sequence[str] | None, path: Path) -> _Block:
    if cameras is not None:
        holding = []
        for block in blocks:
            names = {name for camera in block.cameras for name in (_label(camera), *short_forms(_label(camera)))}
            if names.issuperset(cameras):
                holding.append(block)
        if not holding and len(blocks) > 1:
            problem = f"no chunk or component of {path} has all of these cameras enabled and aligned"
            raise InputError(COMMAND_LINE, "--cameras", problem, "name cameras that are aligned together")
        blocks = holding or blocks
    if not blocks:
        problem = "there is no enabled camera with a pose (a transform of its own)"
        raise InputError(
            path, "chunk.cameras", problem, f"align the photographs, make the cameras of a multi-camera system independent, and {EXPORT}"
        )
    if len(blocks) > 1:
        found = "; ".join(block.key for block in blocks[:5])
        raise InputError(path, "chunk", f"cameras are aligned in {len(blocks)} separate frames ({found})", "name the cameras of one with --cameras")
    return blocks[0]


def _world(block: _Block, path: Path) -> tuple[Array, Array, float, float | None, bool]:
    """Return rotation, translation and scale of world_from_chunk, mm per unit if known, and whether the vertical is known.

    What no reference or scale bar has fixed is marked ``locked="false"``; it is arbitrary.
    """
    if block.transform is None:
        return np.eye(3), np.zeros(3), 1.0, None, False
    parts = {name: block.transform.find(name) for name in ("rotation", "translation", "scale")}
    fixed = {name: part is not None and part.get("locked", "true").lower() not in FALSE for name, part in parts.items()}

    def values(name: str, count: int, default: Sequence[float]) -> Array:
        part = parts[name]
        key = f"{block.key}: transform.{name}"
        return np.array(default, float) if part is None else numbers((part.text or "").split(), count, path, key)

    key = f"{block.key}: transform"
    rotation = rotation_matrix(values("rotation", 9, np.eye(3).ravel().tolist()), path, f"{key}.rotation")
    scale = float(values("scale", 1, [1.0])[0])
    if scale <= 0:
        raise InputError(path, f"{key}.scale", f"is {scale:g}", "a scale is positive: export the cameras again")
    unit = METRE if fixed["scale"] and _unit_in_metres(block.chunk) == 1 else None
    return rotation, values("translation", 3, [0, 0, 0]), scale, unit, fixed["rotation"]


def _reference(chunk: Element) -> str:
    return (chunk.findtext("reference") or "").strip()


def _is_local(chunk: Element) -> bool:
    return not re.match(r"(PROJCS|GEOGCS|GEOCCS|COMPD_CS|GEODCRS|GEOGCRS|PROJCRS|COMPOUNDCRS)\b", _reference(chunk))


def _unit_in_metres(chunk: Element) -> float | None:
    """Return the unit of a local coordinate system in m; geocentric coordinates are always metres."""
    if not _is_local(chunk) or not _reference(chunk):
        return 1.0
    found = re.search(r'UNIT\["[^"]*",\s*([0-9.eE+-]{1,30})', _reference(chunk))
    try:
        return float(found.group(1)) if found else None
    except ValueError:
        return None


def _up(chunk: Element, position: Array) -> Array:
    """Return the upward vertical (3,): z of a local system, the ellipsoid's normal at a geocentric position in m."""
    if _is_local(chunk):
        return np.array([0.0, 0.0, 1.0])
    x, y, z = position
    normal = np.array([x, y, z / (1 - ECCENTRICITY_SQUARED)])  # exact on the ellipsoid, some 0.001 deg at 10 km above it
    return np.asarray(normal / np.linalg.norm(normal))


def _interior(sensor: Element, path: Path, key: str) -> tuple[OpenCVInterior, float]:
    """Return a sensor's interior orientation in our pixels and its deviation from the file's; the adjusted calibration comes first."""
    calibrations = sensor.findall("calibration")
    calibration = next((c for c in calibrations if c.get("class") == "adjusted"), calibrations[0] if calibrations else None)
    if calibration is None:
        raise InputError(path, f"{key}: calibration", "is missing", EXPORT)
    kind = calibration.get("type") or sensor.get("type") or FRAME
    if kind not in (FRAME, *FISHEYES):
        raise InputError(path, f"{key}: calibration.type", f"{kind!r} is not supported", "use frame cameras")
    resolution = calibration.find("resolution")
    if resolution is None:
        resolution = sensor.find("resolution")
    if resolution is None:
        raise InputError(path, f"{key}: resolution", "is missing", EXPORT)
    width, height = image_size(resolution.get("width"), resolution.get("height"), path, f"{key}: resolution")
    if calibration.find("f") is None:
        older = calibration.find("fx") is not None
        problem = "is missing (this is PhotoScan's form up to version 1.1)" if older else "is missing"
        raise InputError(path, f"{key}: calibration.f", problem, f"open it in Metashape and {EXPORT}")
    f = number(calibration.findtext("f"), path, f"{key}: calibration.f")
    given = {name: number(calibration.findtext(name, "0"), path, f"{key}: calibration.{name}") for name in PARAMETERS}
    focal = (f + given["b1"], f)
    principal_point = (width / 2 + given["cx"] - HALF_PIXEL, height / 2 + given["cy"] - HALF_PIXEL)
    if kind == FRAME and not any(given[name] for name in WITHOUT_EQUIVALENT):
        distortion = [given[name] for name in ("k1", "k2", "p2", "p1", "k3")]
        return opencv_interior((width, height), focal, principal_point, distortion, path, f"{key}: calibration.f"), 0.0
    positive_focal_length(focal, path, f"{key}: calibration.f")
    used = [name for name in WITHOUT_EQUIVALENT if given[name]]

    def project(ideal: Array) -> Array:
        x, y = (ideal if kind == FRAME else ideal * equidistant_factor(ideal)).T
        r2 = x * x + y * y
        radial = 1 + r2 * (given["k1"] + r2 * (given["k2"] + r2 * (given["k3"] + r2 * given["k4"])))
        growth = 1 + r2 * (given["p3"] + r2 * given["p4"])
        p1, p2 = given["p1"], given["p2"]
        x_distorted = x * radial + (p1 * (r2 + 2 * x * x) + 2 * p2 * x * y) * growth
        y_distorted = y * radial + (p2 * (r2 + 2 * y * y) + 2 * p1 * x * y) * growth
        return np.stack([x_distorted * focal[0] + y_distorted * given["b2"], y_distorted * focal[1]], axis=1) + principal_point

    described = f"{key}: calibration ({' '.join([kind] * (kind != FRAME) + used)})"
    return fit_opencv(project, width, height, path, described, REMEDY)
