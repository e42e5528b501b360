# SPDX-License-Identifier: LGPL-2.1-or-later
"""The example project: a document with the sample station, whose files lie where the user may write."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.files import package_folder
from pipeworkbench.gui.translation import tr

SAMPLE = ("samples", "dummy", "A")


def make_example(folder: Path | None = None) -> Any:
    """Return a new, unsaved document with the sample station.

    Parameters
    ----------
    folder : Path, optional
        Where the sample's files are copied to (default: into FreeCAD's folder of the user); the addon itself may be read-only.

    Raises
    ------
    InputError
        Where the files cannot be copied.
    """
    from pipeworkbench.features.document import add_station
    from pipeworkbench.features.transactions import transaction
    from pipeworkbench.recon.station import read_station

    copied = copy_sample(folder or Path(FreeCAD.getUserAppDataDir()) / "PipeWorkbench" / "example")
    station = read_station(copied / "station.json")
    document = FreeCAD.newDocument("Example")
    try:
        document.Label = tr("Example project")
        document.UndoMode = 1
        with transaction(document, "Import Station"):
            add_station(document, station)
    except BaseException:
        FreeCAD.closeDocument(document.Name)
        raise
    return document


def copy_sample(folder: Path) -> Path:
    """Copy the sample station into a folder, or a temporary one where that cannot be written; return the station's folder."""
    source = package_folder("resources").joinpath(*SAMPLE)
    try:
        return _copied(source, folder)
    except OSError:
        try:
            return _copied(source, Path(tempfile.mkdtemp(prefix="pipeworkbench-")))
        except OSError as error:
            raise InputError(folder, "", f"the example cannot be copied there ({error.strerror})", "make room on the disk") from None


def _copied(source: Path, folder: Path) -> Path:
    target = folder / source.name
    target.mkdir(parents=True, exist_ok=True)
    for path in source.iterdir():
        # contents alone: the permissions of a read-only installation would make the copy read-only too
        shutil.copyfile(path, target / path.name)
    return target
