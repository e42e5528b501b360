# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigs from COLMAP: the folder of a sparse model, cameras and images, as text or binary.

COLMAP counts pixels from the image's corner, the centre of the first pixel is (0.5, 0.5): half a pixel is
taken off the principal point. The camera axes are ours; an image's quaternion (w, x, y, z) and translation
take the world's coordinates into the camera's. The world has neither a unit nor a vertical.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior
from pipeworkbench.recon.formats.documents import cannot_be_read
from pipeworkbench.recon.formats.fisheye import equidistant_factor, field_of_view, kannala_brandt
from pipeworkbench.recon.formats.fitting import fit_opencv
from pipeworkbench.recon.formats.rig import Rig, View, image_size, number, opencv_interior, positive_focal_length, select

HALF_PIXEL = 0.5
FILES = ("cameras", "images")
# parameters of each model, in the order of COLMAP's numbers for them in binary files
MODELS: dict[str, tuple[str, ...]] = {
    "SIMPLE_PINHOLE": ("f", "cx", "cy"),
    "PINHOLE": ("fx", "fy", "cx", "cy"),
    "SIMPLE_RADIAL": ("f", "cx", "cy", "k1"),
    "RADIAL": ("f", "cx", "cy", "k1", "k2"),
    "OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"),
    "OPENCV_FISHEYE": ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"),
    "FULL_OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
    "FOV": ("fx", "fy", "cx", "cy", "omega"),
    "SIMPLE_RADIAL_FISHEYE": ("f", "cx", "cy", "k1"),
    "RADIAL_FISHEYE": ("f", "cx", "cy", "k1", "k2"),
    "THIN_PRISM_FISHEYE": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "sx1", "sy1"),
}
EXACT_MODELS = ("SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "FULL_OPENCV")
OPENCV_ORDER = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
REMEDY = f"use one of {', '.join(EXACT_MODELS)} (colmap model_converter and bundle_adjuster, or undistort the images)"

QUATERNION_TOLERANCE = 1e-3  # of its length; files are rounded
LONGEST_LINE = 64 * 2**20  # bytes; a line of images.txt holds all points of an image
LONGEST_NAME = 4096  # bytes
LARGEST_CAMERAS = 32 * 2**20  # bytes of cameras.txt or cameras.bin
POINT_BYTES = 24  # of a 2D point: x, y and the 3D point's number


@dataclass(frozen=True)
class _Camera:
    """A set of interior parameters as the file gives it; ``key`` says where."""

    key: str
    model: str
    width: object
    height: object
    parameters: tuple[object, ...]


@dataclass(frozen=True)
class _Image:
    """A pose as the file gives it: quaternion (w, x, y, z) and translation."""

    key: str
    name: str
    camera: int
    pose: tuple[object, ...]


def model_files(folder: Path) -> tuple[Path, Path] | None:
    """Return cameras and images of a sparse model, None where a folder is none; binary comes first, as in COLMAP."""
    for ending in (".bin", ".txt"):
        cameras, images = (folder / f"{name}{ending}" for name in FILES)
        if cameras.is_file() and images.is_file():
            return cameras, images
    return None


def read(path: Path, cameras: Sequence[str] | None = None) -> Rig:
    """Read a sparse model: its folder or one of its files (whose ending then says text or binary).

    Raises
    ------
    InputError
        Where a file is missing, torn or holds what does not fit.
    """
    if path.is_dir():
        found = model_files(path)
        if found is None:
            raise InputError(path, "", "there is no COLMAP model (cameras and images, .txt or .bin) in this folder", "name the folder of one model")
    else:
        found = (path.with_name("cameras" + path.suffix), path.with_name("images" + path.suffix))
    cameras_file, images_file = found
    binary = cameras_file.suffix == ".bin"
    try:
        if cameras_file.stat().st_size > LARGEST_CAMERAS:
            raise InputError(cameras_file, "", f"is larger than {LARGEST_CAMERAS // 2**20} MB", "give a COLMAP model")
        with cameras_file.open("rb") as file:
            models = dict(_binary_cameras(_Reader(file, cameras_file)) if binary else _text_cameras(file, cameras_file))
        with images_file.open("rb") as file:
            images = list(_binary_images(_Reader(file, images_file)) if binary else _text_images(file, images_file))
    except OSError as error:
        missing = cameras_file if not cameras_file.exists() else images_file
        raise cannot_be_read(missing, error) from None
    lenses: dict[int, tuple[OpenCVInterior, float]] = {}
    views = []
    names = [image.name for image in images]
    for index in select(names, cameras, images_file):
        image = images[index]
        if image.camera not in models:
            raise InputError(images_file, f"{image.key}: CAMERA_ID", f"camera {image.camera} is not in {cameras_file.name}", "export the model again")
        if image.camera not in lenses:
            lenses[image.camera] = _interior(models[image.camera], cameras_file)
        rotation, translation = _pose(image, images_file)
        views.append(View(names[index], image.name, lenses[image.camera][0], rotation, -rotation.T @ translation, lenses[image.camera][1]))
    return Rig("colmap", path, tuple(views), None, None, found)


def _interior(camera: _Camera, source: Path) -> tuple[OpenCVInterior, float]:
    """Return the interior orientation in our pixels and its deviation from the file's."""
    key = camera.key
    if camera.model not in MODELS:
        raise InputError(source, f"{key}: MODEL", f"the camera model {camera.model!r} is not supported", REMEDY)
    names = MODELS[camera.model]
    if len(camera.parameters) != len(names):
        problem = f"has {len(camera.parameters)} parameters, {camera.model} takes {len(names)} ({' '.join(names)})"
        raise InputError(source, f"{key}: PARAMS", problem, "export the model again")
    given = {name: number(value, source, f"{key}: {name}") for name, value in zip(names, camera.parameters, strict=True)}
    size = image_size(camera.width, camera.height, source, f"{key}: WIDTH, HEIGHT")
    focal = (given.get("fx", given.get("f", 0.0)), given.get("fy", given.get("f", 0.0)))
    principal_point = (given["cx"] - HALF_PIXEL, given["cy"] - HALF_PIXEL)
    if camera.model in EXACT_MODELS:
        last = max((i + 1 for i, name in enumerate(OPENCV_ORDER) if name in given), default=0)
        distortion = [given.get(name, 0.0) for name in OPENCV_ORDER[: max(4, last)]] if last else []
        return opencv_interior(size, focal, principal_point, distortion, source, f"{key}: {names[0]}"), 0.0
    positive_focal_length(focal, source, f"{key}: {names[0]}")

    def project(ideal: Array) -> Array:
        return _fisheye(camera.model, ideal, given) * focal + principal_point

    return fit_opencv(project, *size, source, f"{key} ({camera.model})", REMEDY)


def _fisheye(model: str, ideal: Array, given: dict[str, float]) -> Array:
    """Return distorted coordinates (n, 2) of COLMAP's fisheye models."""
    if model == "FOV":
        return field_of_view(ideal, given["omega"])
    if model == "THIN_PRISM_FISHEYE":
        turned = ideal * equidistant_factor(ideal)
        x, y = turned.T
        r2 = x * x + y * y
        radial = 1 + r2 * (given["k1"] + r2 * (given["k2"] + r2 * (given["k3"] + r2 * given["k4"])))
        p1, p2 = given["p1"], given["p2"]
        dx = 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + given["sx1"] * r2
        dy = 2 * p2 * x * y + p1 * (r2 + 2 * y * y) + given["sy1"] * r2
        return np.stack([x * radial + dx, y * radial + dy], axis=1)
    return kannala_brandt(ideal, *(given.get(name, 0.0) for name in ("k1", "k2", "k3", "k4")))


def _pose(image: _Image, source: Path) -> tuple[Array, Array]:
    values = np.array([number(value, source, f"{image.key}: pose") for value in image.pose])
    with np.errstate(over="ignore"):
        length = float(np.linalg.norm(values[:4]))
    if not abs(length - 1) <= QUATERNION_TOLERANCE:
        raise InputError(
            source, f"{image.key}: QW QX QY QZ", f"the quaternion's length is {length:.4g}, not 1", "correct it or export the model again"
        )
    w, x, y, z = values[:4]
    return np.asarray(Rotation.from_quat([x, y, z, w]).as_matrix()), values[4:]


# ---------------------------------------------------------------- text


def _lines(file: BinaryIO, source: Path) -> Iterator[tuple[int, str]]:
    """Yield the numbered lines of a text file, each of limited length."""
    count = 0
    while line := file.readline(LONGEST_LINE):
        count += 1
        if len(line) == LONGEST_LINE:
            raise InputError(source, f"line {count}", f"is longer than {LONGEST_LINE // 2**20} MB", "give a COLMAP model")
        try:
            yield count, line.decode("utf-8-sig" if count == 1 else "utf-8").strip()
        except UnicodeDecodeError:
            raise InputError(
                source, f"line {count}", "is not UTF-8 text", "give COLMAP's text files, or name the folder to read the binary ones"
            ) from None


def _whole(value: str, source: Path, key: str) -> int:
    if not (value.isascii() and value.isdigit() and len(value) < 20):
        raise InputError(source, key, f"{value[:20]!r} is not a whole number", "correct this value")
    return int(value)


def _text_cameras(file: BinaryIO, source: Path) -> Iterator[tuple[int, _Camera]]:
    seen = set()
    for count, line in _lines(file, source):
        if not line or line.startswith("#"):
            continue
        words = line.split()
        if len(words) < 5:
            raise InputError(source, f"line {count}", "is not CAMERA_ID MODEL WIDTH HEIGHT PARAMS", "correct this line")
        key = f"line {count}"
        number_of_camera = _whole(words[0], source, f"{key}: CAMERA_ID")
        if number_of_camera in seen:
            raise InputError(source, f"{key}: CAMERA_ID", f"camera {number_of_camera} is given twice", "keep one of them")
        seen.add(number_of_camera)
        yield number_of_camera, _Camera(key, words[1], words[2], words[3], tuple(words[4:]))


def _text_images(file: BinaryIO, source: Path) -> Iterator[_Image]:
    lines = _lines(file, source)
    for count, line in lines:
        if not line or line.startswith("#"):
            continue
        words = line.split(maxsplit=9)
        key = f"line {count}"
        if len(words) != 10:
            raise InputError(source, key, "is not IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME", "correct this line")
        yield _Image(key, words[9], _whole(words[8], source, f"{key}: CAMERA_ID"), tuple(words[1:8]))
        # the line of the image's points follows; it is empty where there are none
        line_of_points, points = next(lines, (count + 1, ""))
        words = points.split()
        if len(words) % 3 or (words and not words[-1].lstrip("-").isdigit()):
            problem = "is not the line of an image's points (X Y POINT3D_ID ...)"
            raise InputError(source, f"line {line_of_points}", problem, "put an empty line after each image that has no points")


# ---------------------------------------------------------------- binary


class _Reader:
    """Little-endian values from a binary file, never more than it holds."""

    def __init__(self, file: BinaryIO, source: Path) -> None:
        self.file, self.source = file, source
        self.left = source.stat().st_size

    def take(self, layout: str, key: str) -> tuple[int | float, ...]:
        size = struct.calcsize(layout)
        self._spend(size, key)
        data = self.file.read(size)
        if len(data) < size:
            raise self._torn(key)
        return struct.unpack(layout, data)

    def count(self, record: int, key: str) -> int:
        """Return a number of records, each of at least ``record`` bytes."""
        (count,) = self.take("<Q", key)
        if count * record > self.left:
            raise InputError(self.source, key, f"{count} records do not fit into the rest of the file ({self.left} bytes)", "export the model again")
        return int(count)

    def skip(self, size: int, key: str) -> None:
        self._spend(size, key)
        self.file.seek(size, 1)

    def text(self, key: str) -> str:
        """Return a text that ends in a null byte."""
        letters = bytearray()
        while (letter := self.file.read(1)) not in (b"", b"\0"):
            letters += letter
            if len(letters) > LONGEST_NAME:
                raise InputError(self.source, key, f"is longer than {LONGEST_NAME} bytes", "export the model again")
        self._spend(len(letters) + 1, key)
        try:
            return letters.decode()
        except UnicodeDecodeError:
            raise InputError(self.source, key, "is not UTF-8 text", "rename the photographs and export the model again") from None

    def _spend(self, size: int, key: str) -> None:
        if size > self.left:
            raise self._torn(key)
        self.left -= size

    def _torn(self, key: str) -> InputError:
        return InputError(self.source, key, "the file ends here", "it is incomplete: copy or export it again")


def _binary_cameras(reader: _Reader) -> Iterator[tuple[int, _Camera]]:
    models = list(MODELS)
    seen = set()
    for index in range(reader.count(24, "number of cameras")):
        key = f"record {index}"
        number_of_camera, model, width, height = map(int, reader.take("<IiQQ", key))
        if not 0 <= model < len(models):
            raise InputError(reader.source, f"{key}: MODEL", f"the camera model number {model} is not supported", REMEDY)
        if number_of_camera in seen:
            raise InputError(reader.source, f"{key}: CAMERA_ID", f"camera {number_of_camera} is given twice", "export the model again")
        seen.add(number_of_camera)
        parameters = reader.take(f"<{len(MODELS[models[model]])}d", f"{key}: PARAMS")
        yield number_of_camera, _Camera(f"camera {number_of_camera}", models[model], width, height, parameters)


def _binary_images(reader: _Reader) -> Iterator[_Image]:
    for index in range(reader.count(64 + 1 + 8, "number of images")):
        key = f"record {index}"
        *pose, camera = reader.take("<I7dI", key)[1:]
        name = reader.text(f"{key}: NAME")
        reader.skip(reader.count(POINT_BYTES, f"{key}: number of points") * POINT_BYTES, f"{key}: points")
        yield _Image(key, name, int(camera), tuple(pose))
