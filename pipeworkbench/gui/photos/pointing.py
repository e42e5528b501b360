# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pointer over a photo window: the edge or the component that it is at, what is shown of that, and what a click means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import FreeCADGui
import numpy as np

from pipeworkbench.features.preferences import pick_settings, preferences
from pipeworkbench.gui.compat import QtCore
from pipeworkbench.gui.photos.canvas import SNAP, PhotoCanvas
from pipeworkbench.gui.photos.drawing import Band, Points, Polylines
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.translation import tr
from pipeworkbench.recon.image_curves import epipolar_curve
from pipeworkbench.recon.snapping import SnappedEdge, nearest_edge
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    from pipeworkbench.gui.photos.window import PhotoWindow

LEAST_SNAP_PX = 3.0  # of the photograph
HIT_SCREEN_PX = 6.0
EPIPOLAR_COLOUR, BAND_COLOUR, SNAP_GLOW = "#4dd0e1", "#404dd0e1", "#60ffe14d"
GLOW_WIDTH, SNAP_WIDTH = 7.0, 2.0
DISTANCES_M = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 50)  # marked along the search band

Pixel = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Pointed:
    """What the pointer is at: a pixel of a camera's photograph, None where it has left it, and the edge there, with a tool that snaps."""

    camera: str
    point: Pixel | None
    edge: SnappedEdge | None


@dataclass(frozen=True, eq=False)
class Click:
    """A click of the left button on a pixel of a camera's photograph, with the edge there, with a tool that snaps."""

    camera: str
    point: Pixel
    edge: SnappedEdge | None
    modifiers: Any


class Pointing:
    """Follows the pointer over a window's photographs, and tells in the window's signals what it is at."""

    def __init__(self, window: PhotoWindow) -> None:
        self._window = window
        self.snaps = False

    def hovered(self, canvas: PhotoCanvas, point: Pixel | None) -> None:
        """Show what the pointer is at, None where it has left the photograph."""
        window = self._window
        if window.is_closed:
            return
        edge = self._edge_at(canvas, point)
        show_snap(window.layer("snap"), canvas.camera, edge)
        if window.contours is not None and not window.has_tool:
            name = self._component_at(canvas, point)
            window.contours.hover(name)
            window.status.set_hint("" if name is None else window.contours.label_of(name))
        focus = point if edge is None else (float(edge.point[0]), float(edge.point[1]))
        show_search_band(window.layer("epipolar"), window.station, canvas.camera, focus)
        self.show_place(canvas, point)
        window.pointed.emit(Pointed(canvas.camera, point, edge))

    def again(self) -> None:
        """Do what a movement of the pointer would do, after something else has changed."""
        window = self._window
        canvas = next((canvas for canvas in window.canvases if canvas.pointer is not None), None)
        if canvas is None or canvas.pointer is None:
            window.layer("epipolar").clear()
            return
        point = canvas.photograph_at(canvas.pointer)
        self.hovered(canvas, point if canvas.contains(point) else None)

    def clicked(self, canvas: PhotoCanvas, point: Pixel, modifiers: Any) -> None:
        """Take a click: a tool's, or one that selects the component under the pointer."""
        window = self._window
        if window.is_closed:
            return
        if window.has_tool:
            window.clicked.emit(Click(canvas.camera, point, self._edge_at(canvas, point), modifiers))
            return
        adds = bool(modifiers & QtCore.Qt.KeyboardModifier.ControlModifier)
        name = self._component_at(canvas, point)
        window.clicked.emit(Click(canvas.camera, point, None, modifiers))
        if not adds:
            FreeCADGui.Selection.clearSelection(window.document_name)
        if name is not None:
            FreeCADGui.Selection.addSelection(window.document_name, name)
            window.component_clicked.emit(name, adds)

    def show_place(self, canvas: PhotoCanvas, point: Pixel | None) -> None:
        """Tell in the status line which pixel the pointer is at."""
        place = self._window.status.place
        if point is None:
            place.setText(f"{100 * canvas.scale:.0f} %")
            return
        value = None if canvas.picture is None else canvas.picture.value_at(*point)
        grey = "" if value is None else tr("grey {value}").format(value=value)
        place.setText(f"{canvas.camera}   {point[0]:8.2f}, {point[1]:8.2f}   {grey:>9}   {100 * canvas.scale:4.0f} %")

    def _edge_at(self, canvas: PhotoCanvas, point: Pixel | None) -> SnappedEdge | None:
        edges = self._window.edges(canvas.camera) if self.snaps and point is not None else None
        if edges is None or point is None:
            return None
        return nearest_edge(edges, point, max(preferences().snap_radius_px / canvas.scale, LEAST_SNAP_PX))

    def _component_at(self, canvas: PhotoCanvas, point: Pixel | None) -> str | None:
        contours = self._window.contours
        if point is None or contours is None or not self._window.layer("contours").visible:
            return None
        return contours.nearest(canvas.camera, point, HIT_SCREEN_PX / canvas.scale)


def show_snap(layer: Layer, camera: str, edge: SnappedEdge | None) -> None:
    """Show the edge that a click would take."""
    layer.clear()
    if edge is not None:
        thread = [edge.polyline]
        glow = Polylines(thread, SNAP_GLOW, GLOW_WIDTH, casing=False)
        layer.set_drawings(camera, [glow, Polylines(thread, SNAP, SNAP_WIDTH, casing=False), Points(edge.point, SNAP)])


def show_search_band(layer: Layer, station: Station, camera: str, point: Pixel | None) -> None:
    """Show where the object point of a camera's pixel can be in the other photographs, with its distances."""
    layer.clear()
    if point is None or not layer.visible:
        return
    settings = pick_settings()
    source = station.cameras[station.camera_index(camera) or 0]
    for other in station.cameras:
        if other is source:
            continue
        curve = epipolar_curve(source, point, other, settings.working_range)
        if len(curve.position) < 2:
            continue
        metres = curve.distance / 1000
        marks = [metre for metre in DISTANCES_M if metres.min() < metre < metres.max()]
        places = np.column_stack([np.interp(marks, metres, curve.position[:, axis]) for axis in (0, 1)])
        line = [curve.position]
        layer.set_drawings(
            other.name,
            [
                Band(line, BAND_COLOUR, settings.search_range),
                Polylines(line, EPIPOLAR_COLOUR, 1.0),
                Points(places, EPIPOLAR_COLOUR, [f"{metre} m" for metre in marks]),
            ],
        )
