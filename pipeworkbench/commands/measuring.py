# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the commands of the measuring tools share: the station to measure in, and what is selected."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.commands.base import Command
from pipeworkbench.commands.stations import chosen_station


class MeasuringCommand(Command):
    """Opens a measuring tool."""

    needs = ("cv2",)
    needs_station = True


def station_to_measure() -> Any:
    """Return the station whose photographs are in front, else the one that is selected, else the only one.

    Raises
    ------
    InputError
        Where none of these says which.
    """
    from pipeworkbench.gui.compat import QtWidgets
    from pipeworkbench.gui.photos.window import photo_window

    document = FreeCAD.ActiveDocument
    window = photo_window()
    area = FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)
    if window is not None and area.activeSubWindow() is window.parent() and window.station_object.Document.Name == document.Name:
        return window.station_object
    return chosen_station(document)


def selected_of_kind(*kinds: type[Any]) -> list[Any]:
    """Return the selected objects of the active document that are of one of some features' kinds."""
    from pipeworkbench.features.base import is_kind

    selected = FreeCADGui.Selection.getSelection(FreeCAD.ActiveDocument.Name)
    return [obj for obj in selected if any(is_kind(obj, kind) for kind in kinds)]
