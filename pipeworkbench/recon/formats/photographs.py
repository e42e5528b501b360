# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photographs of a rig: where they lie and how large they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

import numpy as np

from pipeworkbench.errors import COMMAND_LINE, InputError
from pipeworkbench.recon.formats.documents import cannot_be_read
from pipeworkbench.recon.formats.rig import Rig

ENDINGS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")
NAMES_SHOWN = 5  # of the photographs that are missing, in a message


def find_photographs(rig: Rig, images: Sequence[Path] | None = None, folder: Path | None = None) -> tuple[Path, ...]:
    """Return the photograph of each view.

    Given ``images`` belong to the views in their order. Otherwise the names in the file are looked up in
    ``folder``, or without one beside the file and in the usual folders ``images`` around it; a name without
    ending (a Metashape label) is completed.

    Raises
    ------
    InputError
        Where photographs are missing; names them.
    """
    if images is not None:
        if len(images) != len(rig.views):
            problem = f"names {len(images)} photographs for {len(rig.views)} cameras ({', '.join(view.name for view in rig.views[:10])})"
            raise InputError(COMMAND_LINE, "--images", problem, "name one photograph per camera, in this order")
        missing = [str(image) for image in images if not _is_file(image)]
        if missing:
            raise InputError(COMMAND_LINE, "--images", f"there is no file {_listed(missing)}", "correct the names")
        return tuple(images)
    unnamed = [view.name for view in rig.views if view.image is None]
    if unnamed:
        problem = f"the format {rig.format} does not name the photographs of its cameras ({_listed(unnamed)})"
        raise InputError(rig.source, "images", problem, "name them with --images, one per camera in this order")
    if folder is not None and not folder.is_dir():
        raise InputError(COMMAND_LINE, "--image-folder", f"there is no folder {folder}", "correct the path")
    base = rig.source if rig.source.is_dir() else rig.source.parent
    base = base.absolute()
    folders = [folder] if folder is not None else [base, base / "images", base.parent / "images", base.parent.parent / "images"]
    found = [_find(view.image or "", folders, rig.source) for view in rig.views]
    missing = [view.image or "" for view, path in zip(rig.views, found, strict=True) if path is None]
    if missing:
        where = ", ".join(str(place) for place in folders)
        remedy = "name their folder with --image-folder, or the photographs with --images"
        raise InputError(rig.source, "images", f"the photographs {_listed(missing)} are not in {where}", remedy)
    return tuple(path for path in found if path is not None)


def picture_size(path: Path) -> tuple[int, int]:
    """Return width and height of a picture's pixels as they are stored."""
    import cv2

    try:
        data = np.fromfile(path, np.uint8)
    except OSError as error:
        raise cannot_be_read(path, error) from None
    picture = None
    if data.size:
        try:
            picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)
        except cv2.error:  # larger than OpenCV takes
            picture = None
    if picture is None:
        raise InputError(path, "", "is not a photograph that can be read", "give a PNG, JPEG or TIFF")
    return int(picture.shape[1]), int(picture.shape[0])


def _find(name: str, folders: Sequence[Path], source: Path) -> Path | None:
    relative = PurePosixPath(name.replace("\\", "/"))
    for folder in folders:
        for candidate in dict.fromkeys((folder / relative, folder / relative.name)):
            if _is_file(candidate):
                return candidate
            if relative.suffix.lower() not in ENDINGS and relative.name:
                completed = _completed(candidate)
                if len(completed) > 1:
                    raise InputError(source, f"camera '{name}'", f"{_listed(map(str, completed))} go by this name", "name one with --images")
                if completed:
                    return completed[0]
    return None


def _completed(path: Path) -> list[Path]:
    """Return the pictures whose name is this one and an ending."""
    try:
        beside = sorted(path.parent.iterdir())
    except (OSError, ValueError):
        return []
    return [other for other in beside if other.stem == path.name and other.suffix.lower() in ENDINGS and _is_file(other)]


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # a name that no file system takes
        return False


def _listed(names: Sequence[str] | map[str]) -> str:
    every = list(names)
    return ", ".join(every[:NAMES_SHOWN]) + (f" and {len(every) - NAMES_SHOWN} more" if len(every) > NAMES_SHOWN else "")
