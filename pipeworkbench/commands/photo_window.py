# SPDX-License-Identifier: LGPL-2.1-or-later
"""Photo Window: a station's photographs side by side, to look at and to click in."""

from __future__ import annotations

import FreeCAD

from pipeworkbench.commands.base import Command


class PhotoWindowCommand(Command):
    """Opens the photo window of the selected or the only station."""

    name = "PipeWB_PhotoWindow"
    menu_text = "Photo Window"
    tooltip = "Show the station's photographs side by side, with the contours of pipes and fittings"
    icon = "photo_window.svg"
    accelerator = "Q, W"
    needs = ("cv2",)
    needs_station = True

    def run(self) -> None:
        """Open the window."""
        from pipeworkbench.commands.stations import chosen_station
        from pipeworkbench.gui.photos.windows import open_photo_window

        open_photo_window(chosen_station(FreeCAD.ActiveDocument))
