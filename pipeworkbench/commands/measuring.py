# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the commands of the measuring tools share: the station to measure in, and what is selected."""

from __future__ import annotations

from typing import Any

import FreeCAD

from pipeworkbench.commands.base import Command
from pipeworkbench.commands.stations import chosen_station


class MeasuringCommand(Command):
    """Opens a measuring tool."""

    needs = ("cv2", "cadquery")
    needs_station = True


def station_to_measure() -> Any:
    """Return the station whose photographs are in front, else the one that is selected, else the only one.

    Raises
    ------
    InputError
        Where none of these says which.
    """
    from pipeworkbench.gui.photos.windows import photo_window_in_front

    document = FreeCAD.ActiveDocument
    window = photo_window_in_front(document)
    return chosen_station(document) if window is None else window.station_object


def selected_of_kind(*kinds: type[Any]) -> list[Any]:
    """Return the selected objects of the active document that are of one of some features' kinds."""
    from pipeworkbench.features.base import is_kind
    from pipeworkbench.gui.selection import selected_objects

    return [obj for obj in selected_objects(FreeCAD.ActiveDocument) if any(is_kind(obj, kind) for kind in kinds)]
