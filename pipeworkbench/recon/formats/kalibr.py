# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigs from Kalibr: camchain.yaml.

Pixel centres are integers and the camera axes are ours. ``T_cn_cnm1`` takes the previous camera's
coordinates into this one's, in metres; the world is cam0.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior
from pipeworkbench.recon.formats.documents import read_yaml
from pipeworkbench.recon.formats.fisheye import field_of_view, kannala_brandt
from pipeworkbench.recon.formats.fitting import fit_opencv
from pipeworkbench.recon.formats.rig import METRE, Rig, View, image_size, numbers, opencv_interior, positive_focal_length, rigid_motion, select, shown

COEFFICIENTS = {"radtan": 4, "none": 0, "equidistant": 4, "fov": 1}
REMEDY = "calibrate with the models pinhole-radtan"
MOST_CAMERAS = 1000


def read(path: Path, cameras: Sequence[str] | None = None) -> Rig:
    """Read a chain of cameras.

    Raises
    ------
    InputError
        Where a key is missing or its value does not fit.
    """
    data = read_yaml(path)
    if not isinstance(data, dict) or "cam0" not in data:
        raise InputError(path, "cam0", "is missing", "give the camchain.yaml that Kalibr writes")
    names = [f"cam{index}" for index in range(MOST_CAMERAS) if f"cam{index}" in data]
    poses = [(np.eye(3), np.zeros(3))]
    for index, name in enumerate(names):
        if name != f"cam{index}":
            raise InputError(path, f"cam{index}", "is missing, the chain is broken", "give the whole chain")
        if index:
            poses.append(_next_pose(poses[-1], _get(data[name], "T_cn_cnm1", path, name), path, f"{name}.T_cn_cnm1"))
    views = []
    for i in select(names, cameras, path):
        rotation, translation = poses[i]
        interior, deviation = _interior(data[names[i]], path, names[i])
        views.append(View(names[i], None, interior, rotation, -rotation.T @ translation, deviation))
    return Rig("kalibr", path, tuple(views), METRE, None, (path,))


def _get(camera: Any, key: str, path: Path, name: str) -> Any:
    if not isinstance(camera, dict):
        raise InputError(path, name, f"{shown(camera)} is not a camera", "give the camchain.yaml that Kalibr writes")
    if key not in camera:
        raise InputError(path, f"{name}.{key}", "is missing", "give the camchain.yaml that Kalibr writes")
    return camera[key]


def _next_pose(previous: tuple[Array, Array], transform: Any, path: Path, key: str) -> tuple[Array, Array]:
    """Return camera_from_world of the next camera in the chain."""
    if not isinstance(transform, list) or len(transform) != 4:
        raise InputError(path, key, "is not a list of four rows", "correct this value")
    rotation, translation = rigid_motion(np.array([numbers(row, 4, path, f"{key}[{i}]") for i, row in enumerate(transform)]), path, key)
    return rotation @ previous[0], rotation @ previous[1] + translation


def _interior(camera: Any, path: Path, name: str) -> tuple[OpenCVInterior, float]:
    """Return a camera's interior orientation and its deviation from the file's."""
    model = _get(camera, "camera_model", path, name)
    if model != "pinhole":
        raise InputError(path, f"{name}.camera_model", f"{shown(model)} is not supported", REMEDY)
    lens = _get(camera, "distortion_model", path, name)
    if not isinstance(lens, str) or lens not in COEFFICIENTS:
        raise InputError(path, f"{name}.distortion_model", f"{shown(lens)} is not supported", REMEDY)
    width, height = numbers(_get(camera, "resolution", path, name), 2, path, f"{name}.resolution").tolist()
    size = image_size(width, height, path, f"{name}.resolution")
    fx, fy, cx, cy = map(float, numbers(_get(camera, "intrinsics", path, name), 4, path, f"{name}.intrinsics"))
    key = f"{name}.distortion_coeffs"
    coefficients = numbers(_get(camera, "distortion_coeffs", path, name), COEFFICIENTS[lens], path, key) if COEFFICIENTS[lens] else np.zeros(0)
    if lens in ("radtan", "none"):
        return opencv_interior(size, (fx, fy), (cx, cy), coefficients, path, f"{name}.intrinsics"), 0.0
    positive_focal_length((fx, fy), path, f"{name}.intrinsics")
    distort = kannala_brandt if lens == "equidistant" else field_of_view
    return fit_opencv(lambda ideal: distort(ideal, *coefficients) * (fx, fy) + (cx, cy), *size, path, f"{name}.distortion_model ({lens})", REMEDY)
