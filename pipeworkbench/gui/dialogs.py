# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialogs that the commands ask with; Qt's own, so that they look and test alike everywhere."""

from __future__ import annotations

from pathlib import Path

import FreeCAD
import FreeCADGui

from pipeworkbench.features.preferences import PREFERENCES
from pipeworkbench.gui.compat import QtWidgets

saved_files: list[Path] = []  # what was exported since FreeCAD began


class Cancelled(Exception):  # noqa: N818  # not an error: the user's wish
    """The user pressed Cancel while something was being computed."""


def ask_open(title: str, file_filter: str, start: Path | None = None) -> Path | None:
    """Ask for an existing file; None where the user cancels. The folder is remembered."""
    name, _ = QtWidgets.QFileDialog.getOpenFileName(
        FreeCADGui.getMainWindow(), title, str(start or _last_folder()), file_filter, "", QtWidgets.QFileDialog.Option.DontUseNativeDialog
    )
    return _remembered(name)


def ask_save(title: str, file_filter: str, suggestion: str) -> Path | None:
    """Ask for a file to write; None where the user cancels. The chosen filter's ending is added if there is none."""
    name, chosen = QtWidgets.QFileDialog.getSaveFileName(
        FreeCADGui.getMainWindow(), title, str(Path(_last_folder()) / suggestion), file_filter, "", QtWidgets.QFileDialog.Option.DontUseNativeDialog
    )
    path = _remembered(name)
    if path is not None and not path.suffix:
        path = path.with_suffix(chosen.split("*")[-1].rstrip(")"))
    return path


def show_error(text: str) -> None:
    """Show a message that the user must see; it is in the report view as well."""
    QtWidgets.QMessageBox.warning(FreeCADGui.getMainWindow(), "Pipe Workbench", text)


def ask_folder(title: str, start: Path | None = None) -> Path | None:
    """Ask for an existing folder; None where the user cancels."""
    option = QtWidgets.QFileDialog.Option
    name = QtWidgets.QFileDialog.getExistingDirectory(
        FreeCADGui.getMainWindow(), title, str(start or _last_folder()), option.DontUseNativeDialog | option.ShowDirsOnly
    )
    return Path(name) if name else None


def _last_folder() -> str:
    return str(FreeCAD.ParamGet(PREFERENCES).GetString("LastFolder", str(Path.home())))


def _remembered(name: str) -> Path | None:
    if not name:
        return None
    FreeCAD.ParamGet(PREFERENCES).SetString("LastFolder", str(Path(name).parent))
    return Path(name)
