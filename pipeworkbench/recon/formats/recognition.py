# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which format a rig's file has, by its content, and its reader."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

from pipeworkbench.errors import InputError
from pipeworkbench.recon.formats import colmap, kalibr, metashape, opencv
from pipeworkbench.recon.formats.documents import cannot_be_read
from pipeworkbench.recon.formats.rig import Rig

READERS: dict[str, Callable[[Path, Sequence[str] | None], Rig]] = {
    "opencv": opencv.read,
    "colmap": colmap.read,
    "metashape": metashape.read,
    "kalibr": kalibr.read,
}
BEGINNING = 65536  # bytes that are looked at
COLMAP_NAMES = {f"{name}{ending}" for name in ("cameras", "images", "points3D", "rigs", "frames") for ending in (".txt", ".bin")}
SUPPORTED = (
    "supported are OpenCV's FileStorage (YAML, XML, JSON) of a stereo calibration, the folder of a COLMAP model, "
    "Metashape's exported cameras (XML) and Kalibr's camchain.yaml"
)


def read_rig(path: Path, format_name: str | None = None, cameras: Sequence[str] | None = None) -> Rig:
    """Read a rig in any supported format.

    Parameters
    ----------
    path : Path
        A file, or the folder of a COLMAP model.
    format_name : str, optional
        One of `READERS`; recognised by the content where it is not given.
    cameras : sequence of str, optional
        Names of the cameras to take, in this order; the others are not looked at.

    Raises
    ------
    InputError
        Where the format is not recognised or something in the file does not fit.
    """
    return READERS[format_name or recognise(path)](path, cameras)


def recognise(path: Path) -> str:
    """Return the name of a file's format.

    Raises
    ------
    InputError
        Where it is none that is supported.
    """
    if path.is_dir() or path.name in COLMAP_NAMES:
        return "colmap"
    try:
        with path.open("rb") as file:
            beginning = file.read(BEGINNING)
    except OSError as error:
        raise cannot_be_read(path, error) from None
    text = beginning.decode("utf-8-sig", errors="replace").lstrip()
    if text.startswith("<"):
        root = re.search(r"<([A-Za-z_][\w.-]*)", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL))
        form = {"document": "metashape", "calibration": "metashape", "opencv_storage": "opencv"}.get(root.group(1) if root else "")
        if form is None:
            raise InputError(path, "", "the format of this XML is not known", SUPPORTED)
        return form
    if re.search(r"^cam0\s*:", text, flags=re.MULTILINE):
        return "kalibr"
    if text.startswith(("{", "%YAML")) or re.search(r"^\s*[\w.-]+\s*:", text, flags=re.MULTILINE):
        return "opencv"
    raise InputError(path, "", "the format is not known", SUPPORTED)
