# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station of a rig: millimetres, level frame, photographs; and its station.json.

The first view is the reference camera: its axes are the rig's, its projection centre the origin.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath

import numpy as np

from pipeworkbench.errors import COMMAND_LINE, InputError
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.formats.photographs import find_photographs, picture_size
from pipeworkbench.recon.formats.rig import Rig, View
from pipeworkbench.recon.station import LARGEST_RIG, Station, write_station

log = logging.getLogger(__name__)

SMALLEST_RIG = 1.0  # mm, between projection centres
MEAN_UP_LENGTH = 0.1  # shorter means of the cameras' upward axes point nowhere
STEEPEST_DEG = 89.0  # of the optical axis, above or below which the image's vertical says where forward is
DOUBTFUL_UP_DEG = 60.0  # between the vertical and the cameras' upward axes


def convert_rig(
    rig: Rig,
    output: Path,
    *,
    images: Sequence[Path] | None = None,
    image_folder: Path | None = None,
    scale: float | None = None,
    up: Sequence[float] | None = None,
    name: str | None = None,
) -> Station:
    """Write the station.json of a rig and return the station.

    Parameters
    ----------
    rig : Rig
        What a reader returned.
    output : Path
        The file to write; the photographs are named relative to it.
    images, image_folder : optional
        The photographs in the views' order, or where they lie.
    scale : float, optional
        Millimetres per unit of the file; needed where the format has no unit.
    up : (3,), optional
        The upward vertical in the file's world.
    name : str, optional
        The station's name; the name of the folder it is written to without one.

    Raises
    ------
    InputError
        Where the photographs, the unit or a value are missing or do not fit.
    """
    factor = _millimetres_per_unit(rig, scale)
    vertical = _vertical(rig, up)
    photographs = find_photographs(rig, images, image_folder)
    reference = rig.views[0]
    level_from_world = level_axes(reference.rotation, vertical)
    names = _camera_names(rig.views)
    cameras = tuple(
        Camera(
            camera_name,
            _sized(view, photograph, rig).interior,
            view.rotation @ level_from_world.T,
            factor * (level_from_world @ (view.projection_centre - reference.projection_centre)),
        )
        for camera_name, view, photograph in zip(names, rig.views, photographs, strict=True)
    )
    _refuse_odd_base(cameras, rig)
    station = Station(name or output.absolute().parent.name or "station", cameras, photographs, output)
    try:
        write_station(station, output)
    except InputError as error:
        if error.source != str(output) or not error.key:
            raise
        # the key is the station's, the mistake the input's
        key = re.sub(r"^cameras\[(\d+)\]", lambda found: f"camera '{rig.views[int(found.group(1))].name}'", error.key)
        raise InputError(rig.source, key, error.problem, error.remedy) from None
    _tell_what_is_uncertain(rig, vertical, vertical_is_given=up is not None)
    return station


def level_axes(rotation: Array, up: Array) -> Array:
    """Return the rotation (3, 3) from the world to x right, y forward, z up of a camera.

    Forward is the horizontal part of the optical axis; for a camera that looks straight up or down it is that
    of the image's vertical, so that right stays right.

    Parameters
    ----------
    rotation : (3, 3)
        World to camera (x right, y down, z forward).
    up : (3,)
        Unit vector in the world.
    """
    height = float(rotation[2] @ up)
    forward = rotation[2] if abs(height) < math.sin(math.radians(STEEPEST_DEG)) else math.copysign(1.0, height) * rotation[1]
    forward = forward - (forward @ up) * up
    forward = forward / np.linalg.norm(forward)
    return np.stack([np.cross(forward, up), forward, up])


def _millimetres_per_unit(rig: Rig, scale: float | None) -> float:
    if scale is not None:
        if not (math.isfinite(scale) and scale > 0):
            raise InputError(COMMAND_LINE, "--scale", f"{scale:g} is not a scale", "give the millimetres per unit of the input")
        return scale
    if rig.millimetres_per_unit is None:
        problem = f"{'this chunk is not scaled' if rig.format == 'metashape' else f'the format {rig.format} has no unit of length'}: "
        problem += "depths and diameters would be wrong"
        raise InputError(rig.source, "unit", problem, "give --unit mm, cm or m, or --scale with the millimetres per unit")
    return rig.millimetres_per_unit


def _vertical(rig: Rig, up: Sequence[float] | None) -> Array:
    """Return the unit vector (3,) that points upward in the world."""
    mean = _mean_up(rig)
    if up is not None:
        vertical = np.array(up, float)
        length = float(np.linalg.norm(vertical)) if np.isfinite(vertical).all() else 0.0
        if vertical.shape != (3,) or not (length > 0 and math.isfinite(length)):
            raise InputError(COMMAND_LINE, "--up", f"{' '.join(map(str, up))} is not a direction", "give three numbers, not all zero")
        vertical = vertical / length
    elif rig.up is not None:
        vertical = rig.up
    else:
        if np.linalg.norm(mean) < MEAN_UP_LENGTH:
            problem = "the vertical is not known and the cameras' upward axes point in opposite directions"
            raise InputError(rig.source, "up", problem, "give the vertical in the input's world with --up X Y Z")
        vertical = mean / np.linalg.norm(mean)
    return np.asarray(vertical)


def _tell_what_is_uncertain(rig: Rig, vertical: Array, *, vertical_is_given: bool) -> None:
    """Warn of an assumed or doubtful vertical and of approximated lenses."""
    if not vertical_is_given and rig.up is None:
        x, y, z = vertical
        log.warning("%s: the vertical is not known; taken from the cameras' upward axes: --up %.4f %.4f %.4f", rig.source, x, y, z)
    mean = _mean_up(rig)
    cosine = float(vertical @ mean) / max(float(np.linalg.norm(mean)), MEAN_UP_LENGTH)
    if cosine < math.cos(math.radians(DOUBTFUL_UP_DEG)):
        angle = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
        log.warning("%s: the vertical is %.0f deg off the cameras' upward axes; if that is wrong, give it with --up", rig.source, angle)
    for view in rig.views:
        if view.deviation:
            problem = "lens model approximated by OpenCV's, largest deviation"
            log.warning("%s: camera '%s': %s %.2g px", rig.source, view.name, problem, view.deviation)


def _mean_up(rig: Rig) -> Array:
    """Return the mean (3,) of the cameras' upward axes in the world."""
    return np.asarray(-np.mean([view.rotation[1] for view in rig.views], axis=0))


def _camera_names(views: Sequence[View]) -> list[str]:
    """Return the shortest names that tell the cameras apart: the file's without folder and ending, without ending, whole."""
    paths = [PurePosixPath(view.name.replace("\\", "/")) for view in views]
    for names in ([path.stem for path in paths], [str(path.with_suffix("")) if path.name else "" for path in paths]):
        if all(names) and len(set(names)) == len(names):
            return names
    return [view.name for view in views]


def _sized(view: View, photograph: Path, rig: Rig) -> View:
    """Return a view whose interior has the photograph's size; refuse a photograph of another size."""
    width, height = picture_size(photograph)
    known = (view.interior.width, view.interior.height)
    if known == (0, 0):
        return replace(view, interior=replace(view.interior, width=width, height=height))
    if known != (width, height):
        problem = f"is {width} x {height} pixels, {rig.source} calibrates the camera '{view.name}' for {known[0]} x {known[1]}"
        raise InputError(photograph, "", problem, "give the original photograph or the calibration of this size")
    return view


def _refuse_odd_base(cameras: Sequence[Camera], rig: Rig) -> None:
    centres = np.array([camera.projection_centre for camera in cameras])
    base = float(np.linalg.norm(centres - centres[0], axis=1).max())
    if not SMALLEST_RIG <= base <= LARGEST_RIG:
        problem = f"the cameras are at most {base:.3g} mm from the first"
        raise InputError(rig.source, "cameras", problem, "check --unit or --scale, and that they belong to one rig")
