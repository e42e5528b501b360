# SPDX-License-Identifier: LGPL-2.1-or-later
"""The residuals of an adjustment in the photographs: an arrow from each contour point that counts to its edge, which the window enlarges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pipeworkbench.features.document import stations_in
from pipeworkbench.gui.compat import is_alive

if TYPE_CHECKING:
    from pipeworkbench.recon.adjustment.solution import Solution

LAYER = "residuals"
COLOUR = "#e64b00"


class ResidualVectors:
    """The overlay in the photo windows of a document's stations; gone with the panel that shows it."""

    def __init__(self, document: Any) -> None:
        self._document = document
        self._windows: dict[str, Any] = {}  # by station name

    def show(self, solutions: Sequence[Solution]) -> None:
        """Show the residuals of adjustments; windows are opened where they are needed."""
        from pipeworkbench.gui.photos.windows import open_photo_window

        self.hide()
        objects = {obj.StationName: obj for obj in stations_in(self._document)}
        for solution in solutions:
            for image in solution.residuals:
                if image.station not in objects:
                    continue
                if image.station not in self._windows:
                    self._windows[image.station] = open_photo_window(objects[image.station])
                layer = self._windows[image.station].layer(LAYER)
                layer.visible = True
                layer.set_vectors(image.image, image.contour, image.edge, COLOUR)

    def hide(self) -> None:
        """Take the residuals out of all windows that are still there."""
        for window in self._windows.values():
            if is_alive(window):
                window.layer(LAYER).clear()
        self._windows.clear()
