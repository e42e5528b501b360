# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigs from OpenCV: the FileStorage (YAML, XML or JSON) of what stereoCalibrate returns.

Pixel centres are integers and the camera axes are ours. R and T take the first camera's coordinates into
the second's, x2 = R x1 + T; the world is the first camera. The unit is that of the calibration board's
squares, which the file does not say.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior
from pipeworkbench.recon.formats.documents import read_bounded_json, read_bytes, read_xml, read_yaml
from pipeworkbench.recon.formats.rig import Rig, View, image_size, number, numbers, opencv_interior, rotation_matrix, select
from pipeworkbench.recon.station import DISTORTION_LENGTHS

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

DEEPEST = 4  # level at which a calibration may lie in its file
PAIRS = (("1", "2"), ("left", "right"), ("l", "r"), ("0", "1"))  # how the two cameras are told apart
MATRIX_NAMES = ("cameramatrix", "intrinsicmatrix", "intrinsics", "mtx", "m", "k")
DISTORTION_NAMES = ("distcoeffs", "distcoeff", "distortioncoefficients", "distortioncoeffs", "distortion", "dist", "d")
ROTATION_NAMES, TRANSLATION_NAMES = ("r", "rotation", "rotationmatrix", "rmat"), ("t", "translation", "translationvector", "tvec")
SIZE_NAMES, WIDTH_NAMES, HEIGHT_NAMES = ("imagesize", "imgsize", "size"), ("imagewidth", "width"), ("imageheight", "height")
MODEL_NAMES = ("distortionmodel", "cameramodel")
PINHOLE_MODELS = ("plumbbob", "rationalpolynomial", "radtan", "pinhole", "standard", "opencv")
MATRIX_TOLERANCE = 1e-9  # of the zeros and the one in a camera matrix
LARGEST_SKEW = 1e-6  # of the focal length; OpenCV's functions ignore the skew


def read(path: Path, cameras: Sequence[str] | None = None) -> Rig:
    """Read a stereo calibration; a calibration in two files (intrinsics, extrinsics) is found by either.

    Raises
    ------
    InputError
        Where a key is missing or its value does not fit.
    """
    files = [path]
    store = _calibration(_load(path), path)
    other = _other_half(path)
    if other is not None:
        files.append(other)
        store = {**_calibration(_load(other), other), **store}
    # a matrix K1 and a coefficient k1 are told apart by what they hold: the later entry wins
    keys = {_plain(key): key for key in sorted(store, key=lambda key: isinstance(store[key], dict | list))}
    pair, pattern = _pair(keys, path)
    for name in MODEL_NAMES:
        model = store.get(keys.get(name, ""))
        if isinstance(model, str) and _plain(model) not in PINHOLE_MODELS:
            raise InputError(path, keys[name], f"the model '{model}' is not supported", "calibrate with stereoCalibrate, not with a fisheye model")
    size = _size(store, keys, path)
    names = list(pair) if len(pair[0]) > 1 else ["left", "right"] if pair[0] == "l" else [f"camera{side}" for side in pair]
    rotation, translation = _relative_orientation(store, keys, path)
    poses = ((np.eye(3), np.zeros(3)), (rotation, -rotation.T @ translation))
    views = tuple(View(names[i], None, _interior(store, keys, pattern, pair[i], size, path), *poses[i]) for i in select(names, cameras, path))
    return Rig("opencv", path, views, None, None, tuple(files))


def _load(path: Path) -> Any:
    start = read_bytes(path)[:1024].lstrip(b"\xef\xbb\xbf \t\r\n")
    if start.startswith(b"<"):
        return _tree(read_xml(path), path)
    if start.startswith(b"{"):
        return read_bounded_json(path)
    return read_yaml(path)


def _tree(element: Element, path: Path, depth: int = 0) -> Any:
    """Return FileStorage's XML as the dictionaries and lists of its YAML."""
    if depth > DEEPEST + 2:
        return None
    if len(element) == 0:
        words = (element.text or "").split()
        return words[0] if len(words) == 1 else words
    if all(child.tag == "_" for child in element):
        return [_tree(child, path, depth + 1) for child in element]
    result: dict[str, Any] = {}
    for child in element:
        if child.tag in result:
            raise InputError(path, child.tag, "the key is given twice", "keep one of them")
        result[child.tag] = _tree(child, path, depth + 1)
    if isinstance(result.get("data"), str):
        result["data"] = [result["data"]]
    return result


def _calibration(data: Any, path: Path) -> Mapping[str, Any]:
    """Return the part of a document that holds a calibration's keys."""
    for part in _parts(data):
        keys = {_plain(key) for key in part}
        if any(_patterns(keys)) or (keys & set(ROTATION_NAMES) and keys & set(TRANSLATION_NAMES)):
            return part
    raise InputError(
        path,
        "cameraMatrix1",
        "there are no two camera matrices (as cameraMatrix1 and cameraMatrix2, M1 and M2, K1 and K2 or camera_matrix_left and _right)",
        "give the file of a stereo calibration",
    )


def _parts(data: Any, depth: int = 0) -> Iterator[dict[str, Any]]:
    if isinstance(data, dict) and depth < DEEPEST:
        part = {str(key): value for key, value in data.items()}
        yield part
        for value in part.values():
            yield from _parts(value, depth + 1)


def _patterns(keys: Iterable[str]) -> Iterator[tuple[tuple[str, str], str]]:
    """Yield the ways, as (pair, pattern), in which keys name two camera matrices."""
    known = set(keys)
    for name in MATRIX_NAMES:
        for pair in PAIRS:
            for pattern in (f"{name}%s", f"%s{name}"):
                if {pattern % side for side in pair} <= known:
                    yield pair, pattern


def _pair(keys: Mapping[str, str], path: Path) -> tuple[tuple[str, str], str]:
    found = next(_patterns(keys), None)
    if found is None:
        remedy = "put intrinsics and extrinsics into one file, or beside each other under these names"
        raise InputError(path, "cameraMatrix1", "is missing", remedy)
    return found


def _plain(key: str) -> str:
    return "".join(letter for letter in key.lower() if letter.isalnum())


def _other_half(path: Path) -> Path | None:
    """Return the extrinsics beside intrinsics and the other way round, as OpenCV's example writes them."""
    for half, other in (("intrinsics", "extrinsics"), ("extrinsics", "intrinsics"), ("intrinsic", "extrinsic"), ("extrinsic", "intrinsic")):
        if half in path.name:
            candidate = path.with_name(path.name.replace(half, other))
            return candidate if candidate.is_file() else None
    return None


def _first(store: Mapping[str, Any], keys: Mapping[str, str], names: Sequence[str]) -> tuple[str, Any] | None:
    return next(((keys[name], store[keys[name]]) for name in names if name in keys), None)


def _matrix(value: Any, path: Path, key: str) -> Array:
    """Return a matrix: FileStorage's rows, cols and data, or nested lists."""
    if isinstance(value, dict):
        missing = [part for part in ("rows", "cols", "data") if part not in value]
        if missing:
            raise InputError(path, f"{key}.{missing[0]}", "is missing", "export the matrix again")
        rows, columns = (number(value[part], path, f"{key}.{part}") for part in ("rows", "cols"))
        data = numbers(value["data"], None, path, f"{key}.data")
        if rows < 0 or columns < 0 or rows != int(rows) or columns != int(columns) or rows * columns != len(data):
            raise InputError(path, f"{key}.data", f"has {len(data)} numbers where {rows:g} x {columns:g} belong", "correct this value")
        return data.reshape(int(rows), int(columns))
    if isinstance(value, list) and value and all(isinstance(row, list) for row in value):
        rows_of = [numbers(row, None, path, f"{key}[{index}]") for index, row in enumerate(value)]
        if len({len(row) for row in rows_of}) > 1:
            raise InputError(path, key, "has rows of different lengths", "correct this value")
        return np.array(rows_of)
    return numbers(value, None, path, key)[None]


def _interior(store: Mapping[str, Any], keys: Mapping[str, str], pattern: str, side: str, size: tuple[int, int], path: Path) -> OpenCVInterior:
    key = keys[pattern % side]
    matrix = _matrix(store[key], path, key)
    if matrix.size != 9:
        raise InputError(path, key, f"is {matrix.shape[0]} x {matrix.shape[1]}, a camera matrix is 3 x 3", "correct this value")
    matrix = matrix.reshape(3, 3)
    lower = np.array([matrix[1, 0], *matrix[2]])
    if np.abs(lower - [0, 0, 0, 1]).max() > MATRIX_TOLERANCE or abs(matrix[0, 1]) > LARGEST_SKEW * abs(matrix[0, 0]):
        raise InputError(path, key, "is not of the form fx 0 cx, 0 fy cy, 0 0 1", "calibrate without skew or correct this value")
    found = _first(store, keys, [form for name in DISTORTION_NAMES for form in (f"{name}{side}", f"{side}{name}")])
    if found is None:
        remedy = "add it, as zeros only where the photographs are undistorted"
        raise InputError(path, f"distCoeffs{side}", "there are no distortion coefficients for this camera", remedy)
    coefficients = _matrix(found[1], path, found[0]).ravel() if found[1] not in ([], None) else np.zeros(0)
    if len(coefficients) not in DISTORTION_LENGTHS:
        lengths = ", ".join(map(str, DISTORTION_LENGTHS))
        raise InputError(path, found[0], f"has {len(coefficients)} coefficients, OpenCV knows {lengths}", "correct this value")
    return opencv_interior(size, (matrix[0, 0], matrix[1, 1]), (matrix[0, 2], matrix[1, 2]), coefficients, path, key)


def _relative_orientation(store: Mapping[str, Any], keys: Mapping[str, str], path: Path) -> tuple[Array, Array]:
    """Return R (3, 3) and T (3,): x2 = R x1 + T."""
    values = []
    for names in (ROTATION_NAMES, TRANSLATION_NAMES):
        found = _first(store, keys, names)
        if found is None:
            remedy = "put it into the file, or give the extrinsics' file beside this one the same name (intrinsics.yml, extrinsics.yml)"
            raise InputError(path, names[0].upper(), "is missing", remedy)
        values.append((found[0], _matrix(found[1], path, found[0])))
    (rotation_key, rotation), (translation_key, translation) = values
    if rotation.size == 3:  # a rotation vector
        rotation = np.asarray(Rotation.from_rotvec(rotation.ravel()).as_matrix())
    if rotation.size != 9:
        raise InputError(path, rotation_key, f"has {rotation.size} numbers where 3 x 3 belong", "correct this value")
    if translation.size != 3:
        raise InputError(path, translation_key, f"has {translation.size} numbers where 3 belong", "correct this value")
    return rotation_matrix(rotation, path, rotation_key), translation.ravel()


def _size(store: Mapping[str, Any], keys: Mapping[str, str], path: Path) -> tuple[int, int]:
    """Return the images' size, zeros where the file has none."""
    found = _first(store, keys, SIZE_NAMES)
    if found is not None:
        value = found[1]
        if isinstance(value, dict):
            value = [value.get("width"), value.get("height")] if "width" in value else value.get("data")
        sides = numbers(value, 2, path, found[0])
        return image_size(sides[0], sides[1], path, found[0])
    width, height = _first(store, keys, WIDTH_NAMES), _first(store, keys, HEIGHT_NAMES)
    if width is not None and height is not None:
        return image_size(width[1], height[1], path, width[0])
    return 0, 0
