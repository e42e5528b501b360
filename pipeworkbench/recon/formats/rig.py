# SPDX-License-Identifier: LGPL-2.1-or-later
"""What every reader of a foreign format returns, and the checks of values that all of them make."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import COMMAND_LINE, InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior
from pipeworkbench.recon.station import ORTHONORMAL_TOLERANCE

METRE = 1000.0  # mm
NAMES_SHOWN = 10  # of the cameras there are, in a message


@dataclass(frozen=True, eq=False)
class View:
    """One oriented photograph of a rig.

    ``interior`` counts pixels our way (centres at integers) and has width and height 0 where the file does
    not give them; ``rotation`` (3, 3) turns the world's axes into the camera's (x right, y down, z forward)
    and ``projection_centre`` (3,) is in the world, in the file's unit. ``image`` is the photograph's name
    as the file gives it, None where it gives none. ``deviation`` is how far, in pixels, ``interior`` is at most
    from the file's lens model, 0 where that is exactly ours.
    """

    name: str
    image: str | None
    interior: OpenCVInterior
    rotation: Array
    projection_centre: Array
    deviation: float = 0.0


@dataclass(frozen=True, eq=False)
class Rig:
    """Views in one frame, the file's world.

    ``millimetres_per_unit`` is None where the format has no unit of length, ``up`` (3,), in the world, is
    None where it does not know the vertical; ``files`` are all files that were read.
    """

    format: str
    source: Path
    views: tuple[View, ...]
    millimetres_per_unit: float | None
    up: Array | None
    files: tuple[Path, ...]


def select(names: Sequence[str], wanted: Sequence[str] | None, source: Path) -> list[int]:
    """Return the indices of the wanted cameras in their order; all where ``wanted`` is None.

    A camera goes by its name, or by the name's last part with or without ending (``left/001.jpg``, ``001.jpg``,
    ``001``) where that belongs to one camera only.

    Raises
    ------
    InputError
        Where a name is unknown, ambiguous or given twice, or fewer than two cameras remain.
    """
    if wanted is None:
        doubled = _doubled(names)
        if doubled is not None:
            raise InputError(source, f"camera '{doubled}'", "the name is used twice", "give each camera its own name")
        chosen = list(range(len(names)))
    else:
        chosen = [_index_of(name, names, source) for name in wanted]
        if len(set(chosen)) < len(chosen):
            raise InputError(COMMAND_LINE, "--cameras", "names a camera twice", "name each camera once")
    if len(chosen) < 2:
        raise InputError(source, "cameras", f"a station needs two oriented cameras, here is {len(chosen)}", "give a rig of two or more cameras")
    return chosen


def _index_of(name: str, names: Sequence[str], source: Path) -> int:
    for matches in ((lambda other: other == name), (lambda other: name in short_forms(other))):
        found = [index for index, other in enumerate(names) if matches(other)]
        if len(found) == 1:
            return found[0]
        if found:
            raise InputError(COMMAND_LINE, "--cameras", f"'{name}' is the name of {len(found)} cameras of {source}", "give the full name")
    shown = ", ".join(names[:NAMES_SHOWN]) + (" ..." if len(names) > NAMES_SHOWN else "")
    raise InputError(COMMAND_LINE, "--cameras", f"{source} has no oriented camera '{name}'", f"choose from: {shown or 'none'}")


def short_forms(name: str) -> set[str]:
    """Return the short forms of a camera's name: without folders, without ending, without both."""
    path = PurePosixPath(name.replace("\\", "/"))
    return {path.name, path.stem, str(path.with_suffix("")) if path.name else name}


def _doubled(names: Iterable[str]) -> str | None:
    seen: set[str] = set()
    return next((name for name in names if name in seen or seen.add(name)), None)  # type: ignore[func-returns-value]


def number(value: object, source: Path, key: str) -> float:
    """Return a finite number that a file gives as a number or as its text."""
    try:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise TypeError  # noqa: TRY301
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(source, key, f"{shown(value)} is not a number", "correct this value") from None
    if not math.isfinite(result):
        raise InputError(source, key, f"{shown(value)} is not a finite number", "correct this value")
    return result


def numbers(values: object, count: int | None, source: Path, key: str) -> Array:
    """Return finite numbers (count,), of any count where that is None."""
    if not isinstance(values, list | tuple):
        raise InputError(source, key, f"{shown(values)} is not a list of numbers", "correct this value")
    if count is not None and len(values) != count:
        raise InputError(source, key, f"has {len(values)} numbers where {count} belong", "correct this value")
    return np.array([number(value, source, key) for value in values], float)


def shown(value: object) -> str:
    """Return a value as a message shows it; a list's contents are not, they may be endless."""
    if isinstance(value, str | int | float) or value is None:
        text = repr(value)
        return text if len(text) <= 60 else text[:57] + "..."
    return f"a {type(value).__name__}"


def image_size(width: object, height: object, source: Path, key: str) -> tuple[int, int]:
    """Return an image's size in whole pixels."""
    sides = [number(side, source, key) for side in (width, height)]
    if any(side < 1 or side != int(side) for side in sides):
        raise InputError(source, key, f"{sides[0]:g} x {sides[1]:g} is not an image's size", "give whole numbers of pixels")
    return int(sides[0]), int(sides[1])


def opencv_interior(
    size: tuple[int, int], focal: tuple[float, float], principal_point: tuple[float, float], distortion: Iterable[float], source: Path, key: str
) -> OpenCVInterior:
    """Return an interior orientation in our pixels after checking the focal lengths (px)."""
    positive_focal_length(focal, source, key)
    (fx, fy), (cx, cy) = focal, principal_point
    return OpenCVInterior(*size, float(fx), float(fy), float(cx), float(cy), tuple(map(float, distortion)))


def positive_focal_length(focal: Iterable[float], source: Path, key: str) -> None:
    """Refuse focal lengths that are zero or negative."""
    if min(focal) <= 0:
        raise InputError(source, key, "the focal length is not positive", "calibrate anew or correct this value")


def rotation_matrix(values: Array, source: Path, key: str) -> Array:
    """Return the exact rotation (3, 3) nearest to a file's rounded one."""
    matrix = np.asarray(values, float).reshape(3, 3)
    with np.errstate(over="ignore", invalid="ignore"):
        deviation = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
    if not deviation <= ORTHONORMAL_TOLERANCE:
        raise InputError(source, key, f"is not a rotation: its rows are not orthonormal (deviation {deviation:.2g})", "correct this value")
    if np.linalg.det(matrix) < 0:
        raise InputError(source, key, "is not a rotation but a reflection (determinant -1)", "correct this value")
    return np.asarray(Rotation.from_matrix(matrix).as_matrix())


def rigid_motion(values: Array, source: Path, key: str) -> tuple[Array, Array]:
    """Return rotation (3, 3) and translation (3,) of a 4 x 4 transform."""
    matrix = np.asarray(values, float).reshape(4, 4)
    if not np.allclose(matrix[3], [0, 0, 0, 1], rtol=0, atol=ORTHONORMAL_TOLERANCE):
        raise InputError(source, key, "the last row of a transform is 0 0 0 1", "correct this value")
    return rotation_matrix(matrix[:3, :3], source, key), matrix[:3, 3]
