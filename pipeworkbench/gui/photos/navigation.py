# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zoom and pan of photographs side by side: one scale for all, and on request one object point in all their middles."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from pipeworkbench.gui.compat import QtCore, device_pixel_ratio
from pipeworkbench.gui.photos.canvas import PhotoCanvas
from pipeworkbench.recon.camera import Array

LARGEST_SCALE = 64.0
SMALLEST_FIT = 0.5  # of the scale at which everything fits
FIT_MARGIN = 0.98
ENOUGH_SHOWN = 0.5  # of what could be shown of something

# the pixel of one camera's photograph -> the same object point's pixel in another's, None where it is not seen there
Transfer = Callable[[str, tuple[float, float], str], "tuple[float, float] | None"]


class Navigation:
    """Moves canvases together."""

    def __init__(self, canvases: Sequence[PhotoCanvas], transfer: Transfer, moved: Callable[[], None]) -> None:
        self._canvases, self._transfer, self._moved = list(canvases), transfer, moved
        self._fits = True
        self._linked = False
        for canvas in self._canvases:
            canvas.zoomed.connect(lambda factor, place, canvas=canvas: self.zoom(canvas, factor, place))
            canvas.panned.connect(lambda way, canvas=canvas: self.pan(canvas, way))
            canvas.resized.connect(self._resized)

    def set_linked(self, linked: bool, leader: PhotoCanvas) -> None:  # noqa: FBT001  # as Qt's setters
        """Let all photographs show what one of them shows."""
        self._linked = linked
        self._look(leader, leader.centre, leader.scale)

    def fit(self) -> None:
        """Show all photographs whole."""
        self._fits = True
        scale = self._fitting_scale()
        for canvas in self._canvases:
            width, height = canvas.size_of_photograph
            canvas.look_at(((width - 1) / 2, (height - 1) / 2), scale)
        self._moved()

    def one_to_one(self, leader: PhotoCanvas) -> None:
        """Show one pixel of the photographs as one of the screen, about where the pointer is."""
        place = leader.pointer or QtCore.QPointF(leader.width() / 2, leader.height() / 2)
        self.zoom(leader, 1 / device_pixel_ratio(leader) / leader.scale, place)

    def zoom(self, leader: PhotoCanvas, factor: float, place: QtCore.QPointF) -> None:
        """Zoom by a factor; what one photograph shows at a place of its canvas stays there."""
        scale = min(max(leader.scale * factor, SMALLEST_FIT * self._fitting_scale()), LARGEST_SCALE)
        u, v = leader.photograph_at(place)
        self._fits = False
        self._look(leader, (u - (place.x() - leader.width() / 2) / scale, v - (place.y() - leader.height() / 2) / scale), scale)

    def pan(self, leader: PhotoCanvas, way: QtCore.QPointF) -> None:
        """Move a photograph with the pointer."""
        self._fits = False
        self._look(leader, (leader.centre[0] - way.x() / leader.scale, leader.centre[1] - way.y() / leader.scale), leader.scale)

    def show(self, leader: PhotoCanvas, point: tuple[float, float], scale: float | None = None) -> None:
        """Show a pixel of one photograph in its middle."""
        self._fits = False
        self._look(leader, point, scale or leader.scale)

    def reveal(self, canvas: PhotoCanvas, points: Array) -> None:
        """Show points (n, 2) of one photograph in it, where much more of them could be seen than is seen; the other photographs stay."""
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        if _share_shown(canvas, points, middle) == 0:  # a bend, close up: its lines pass far from the middle
            middle = points[np.linalg.norm(points - middle, axis=1).argmin()]
        centre = (float(middle[0]), float(middle[1]))
        if _share_shown(canvas, points, canvas.centre) < ENOUGH_SHOWN * _share_shown(canvas, points, centre):
            self._fits = False
            canvas.look_at(centre, canvas.scale)
            self._moved()

    def _look(self, leader: PhotoCanvas, centre: tuple[float, float], scale: float) -> None:
        width, height = leader.size_of_photograph
        centre = (min(max(centre[0], 0.0), width - 1.0), min(max(centre[1], 0.0), height - 1.0))
        leader.look_at(centre, scale)
        for canvas in self._canvases:
            if canvas is not leader:
                same = self._transfer(leader.camera, centre, canvas.camera) if self._linked else None
                canvas.look_at(same or canvas.centre, scale)
        self._moved()

    def _fitting_scale(self) -> float:
        sizes = [(canvas, *canvas.size_of_photograph) for canvas in self._canvases]
        return FIT_MARGIN * min(min(canvas.width() / width, canvas.height() / height) for canvas, width, height in sizes)

    def _resized(self) -> None:
        if self._fits:
            self.fit()


def _share_shown(canvas: PhotoCanvas, points: Array, centre: Array | Sequence[float]) -> float:
    """Return which part of points (n, 2) of a photograph a canvas shows that has a pixel in its middle."""
    half = np.array([canvas.width(), canvas.height()]) / (2 * canvas.scale)
    return float((np.abs(points - np.asarray(centre)) <= half).all(axis=1).mean())
