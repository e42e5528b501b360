# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window: one MDI window per station, its photographs side by side, to look at and to click in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.features.preferences import pick_settings, preferences
from pipeworkbench.features.station import missing_images, relocate, station_of
from pipeworkbench.files import package_folder
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, Signal, is_alive
from pipeworkbench.gui.photos.background import Background
from pipeworkbench.gui.photos.canvas import SNAP, PhotoCanvas
from pipeworkbench.gui.photos.contours import Colouring, ComponentContours
from pipeworkbench.gui.photos.drawing import Band, Points, Polylines
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.photos.missing_page import MissingPage, ask_folder
from pipeworkbench.gui.photos.navigation import Navigation
from pipeworkbench.gui.photos.observers import DocumentObserver
from pipeworkbench.gui.photos.photographs import Photographs
from pipeworkbench.gui.photos.picture import Picture, Tone
from pipeworkbench.gui.photos.status import StatusLine
from pipeworkbench.gui.photos.toolbar import VECTOR_START, PhotoToolbar
from pipeworkbench.gui.translation import tr
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap
from pipeworkbench.recon.image_curves import epipolar_curve
from pipeworkbench.recon.snapping import SnappedEdge, nearest_edge
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View

LEAST_SNAP_PX = 3.0  # of the photograph
HIT_SCREEN_PX = 6.0
EDGE_COLOUR, LINE_COLOUR, EPIPOLAR_COLOUR = "#ffb347", "#ff6ad5", "#4dd0e1"
BAND_COLOUR, SNAP_GLOW = "#404dd0e1", "#60ffe14d"
GLOW_WIDTH, SNAP_WIDTH = 7.0, 2.0
DISTANCES_M = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 30, 50)  # marked along the search band

Qt = QtCore.Qt
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


class PhotoWindow(QtWidgets.QWidget):  # type: ignore[misc]  # Qt has no types
    """A station's photographs side by side; tools listen to its signals and draw into its layers.

    Attributes
    ----------
    station : Station
        Cameras in their level frame; not there while ``is_missing``.
    station_object : document object
    """

    pointed = Signal(object)  # Pointed
    clicked = Signal(object)  # Click
    accepted = Signal()
    stepped_back = Signal()
    digit_pressed = Signal(int)
    component_clicked = Signal(str, bool)  # object's name, whether it is added to the selection
    edges_ready = Signal(str)  # camera
    closed = Signal()

    station: Station

    def __init__(self, station_object: Any) -> None:
        super().__init__()
        self.station_object = station_object
        self.canvases: list[PhotoCanvas] = []
        self.contours: ComponentContours | None = None
        self.is_closed = False
        self.is_missing = True
        self._object_name, self._document_name = station_object.Name, station_object.Document.Name
        self._layers: dict[str, Layer] = {}
        self._tool, self._snapping = False, False
        self._leader = 0
        self._splitter: QtWidgets.QSplitter | None = None
        self._background = Background(self)
        self._photographs: Photographs | None = None
        self._navigation: Navigation | None = None
        self.toolbar = PhotoToolbar(self)
        self._make_layers()
        self.status = StatusLine()
        self._missing = MissingPage(self._find_missing)
        self._pages = QtWidgets.QStackedWidget()
        self._pages.addWidget(self._missing)
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.toolbar)
        layout.addWidget(self._pages, 1)
        layout.addWidget(self.status)
        for name, action in self.toolbar.layers.items():
            action.setChecked(self.layer(name).visible)
        self.setWindowTitle(tr("{station} - photographs").format(station=station_object.Label))
        self.setWindowIcon(QtGui.QIcon(str(package_folder("resources") / "icons" / "photo_window.svg")))
        self._observer: DocumentObserver | None = DocumentObserver(station_object.Document, self)
        self._load()

    # for tools

    def set_tool(self, active: bool, *, snapping: bool = False, hint: str = "") -> None:  # noqa: FBT001  # the interface
        """Tell that a tool is active: clicks are its own and select nothing; with ``snapping`` they take the edge under the pointer."""
        self._tool, self._snapping = active, active and snapping
        self.status.set_hint(hint)
        self.layer("snap").clear()
        if self.contours is not None:
            self.contours.hover(None)
        if self.canvases:
            self._hover_again()

    @property
    def has_tool(self) -> bool:
        """Whether a tool is active."""
        return self._tool

    def layer(self, name: str) -> Layer:
        """Return the overlay of a name, which is made at its first use."""
        if name not in self._layers:
            self._layers[name] = Layer(name, self._layer_changed)
        return self._layers[name]

    def edges(self, camera: str) -> EdgeMap | None:
        """Return the edges of a camera's photograph, None while they are being found."""
        view = self._view(camera)
        return None if view is None else view.edges

    @property
    def views(self) -> tuple[View, ...] | None:
        """The cameras with their edges, None while they are being found."""
        views = [self._view(canvas.camera) for canvas in self.canvases]
        found = tuple(view for view in views if view is not None)
        return found if self.canvases and len(found) == len(views) else None

    def wait_for_views(self) -> tuple[View, ...]:
        """Return the cameras with their edges once they are found; for worker threads, as it waits.

        Raises
        ------
        InputError
            Where a photograph is missing or cannot be read, or the window was closed meanwhile.
        """
        if self._photographs is None:
            raise InputError(self._object_name, "", "its photographs are missing", "say where they are in its photo window")
        return self._photographs.wait_for_views()

    def canvas(self, camera: str) -> PhotoCanvas:
        """Return the widget of a camera's photograph."""
        return next(canvas for canvas in self.canvases if canvas.camera == camera)

    def show_place(self, camera: str, point: Pixel, scale: float | None = None) -> None:
        """Move a pixel of a photograph into its middle; the others follow where they are linked."""
        if self._navigation is not None:
            self._navigation.show(self.canvas(camera), point, scale)

    # the toolbar's actions

    def fit(self) -> None:
        """Show all photographs whole."""
        if self._navigation is not None:
            self._navigation.fit()

    def one_to_one(self) -> None:
        """Show one pixel of the photographs as one of the screen."""
        if self._navigation is not None:
            self._navigation.one_to_one(self.canvases[self._leader])

    def set_linked(self, linked: bool) -> None:  # noqa: FBT001  # as Qt's setters
        """Let all photographs show the same part of the object."""
        if self._navigation is not None:
            self._navigation.set_linked(linked, self.canvases[self._leader])

    def set_loupe(self, shown: bool) -> None:  # noqa: FBT001  # as Qt's setters
        """Show the pixels around the pointer enlarged."""
        for canvas in self.canvases:
            canvas.loupe = shown
            canvas.update()

    def set_tone(self, tone: Tone) -> None:
        """Show the photographs with other contrast and gamma."""
        for canvas in self.canvases:
            canvas.set_tone(tone)

    def show_layer(self, name: str, shown: bool) -> None:  # noqa: FBT001  # as Qt's setters
        """Show or hide a layer; what it shows is found when it is shown first."""
        self.layer(name).visible = shown
        if shown and not self.is_closed:
            self._fill_layers()
        if name == "epipolar" and self.canvases:
            self._hover_again()

    def set_vector_scale(self, scale: float) -> None:
        """Draw residuals longer or shorter."""
        self.layer("residuals").vector_scale = scale

    def set_colouring(self, colouring: Colouring) -> None:
        """Let the contours' colours tell the kind or the quality."""
        if self.contours is not None:
            self.contours.colouring = colouring

    def set_hidden_shown(self, shown: bool) -> None:  # noqa: FBT001  # as Qt's setters
        """Show what components hide of each other dashed, or not at all."""
        if self.contours is not None:
            self.contours.shows_hidden = shown
            self.contours.draw()

    # the document

    def object_changed(self, name: str) -> None:
        """Follow the document (called by its observer)."""
        if self.contours is not None:
            self.contours.object_changed(name)

    def object_deleted(self, name: str) -> None:
        """Close with the station (called by the document's observer)."""
        if name == self._object_name:
            # not now: Qt and FreeCAD may be in the middle of something with both
            self._end()
            QtCore.QTimer.singleShot(0, self._close_sub_window)
        elif self.contours is not None:
            self.contours.object_changed(name)

    def document_closed(self) -> None:
        """Close with the document (called by its observer)."""
        self._end()
        QtCore.QTimer.singleShot(0, self._close_sub_window)

    # Qt's events

    def event(self, event: Any) -> bool:  # Qt's name
        """Keep FreeCAD's shortcuts (digits turn the 3D view) from taking the window's own keys."""
        if event.type() == QtCore.QEvent.Type.ShortcutOverride and self._meaning_of(event) is not None:
            event.accept()
            return True
        return bool(super().event(event))

    def keyPressEvent(self, event: Any) -> None:  # Qt's name
        """Do what a key means here."""
        meaning = self._meaning_of(event)
        if meaning is None:
            super().keyPressEvent(event)
        else:
            meaning()

    def keyReleaseEvent(self, event: Any) -> None:  # Qt's name
        """End panning with the space bar."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self._pan_with_left(pans=False)
        else:
            super().keyReleaseEvent(event)

    def closeEvent(self, event: Any) -> None:  # Qt's name
        """End everything that is under way."""
        self._end()
        event.accept()

    # loading

    def _load(self) -> None:
        """Show the station's photographs, or say which are missing."""
        try:
            self.station = station_of(self.station_object)
            missing: list[Path] = []
            problem = ""
        except PipeWorkbenchError as error:
            missing, problem = missing_images(self.station_object), str(error)
        self.is_missing = bool(missing or problem)
        if self.is_missing:
            self._missing.tell(self.station_object.Label, missing, problem)
            self._pages.setCurrentWidget(self._missing)
            return
        self._show_canvases()
        self.status.work.setText(tr("reading..."))
        self._photographs = Photographs(self.station, self._background, self._show_picture, self._show_problem, self._show_view)
        self.contours = ComponentContours(
            self, self.station_object, self.station, self.layer("contours"), self.layer("hovered contour"), self._background
        )

    def _show_canvases(self) -> None:
        self._splitter = QtWidgets.QSplitter(Qt.Orientation.Horizontal)
        self._splitter.setChildrenCollapsible(False)
        self._splitter.setHandleWidth(3)
        for index, camera in enumerate(self.station.cameras):
            canvas = PhotoCanvas(camera.name, (camera.interior.width, camera.interior.height), self._all_layers)
            canvas.loupe = self.toolbar.loupe.isChecked()
            canvas.hovered.connect(lambda point, canvas=canvas: self._hovered(canvas, point))
            canvas.clicked.connect(lambda point, modifiers, canvas=canvas: self._clicked(canvas, point, modifiers))
            canvas.missed.connect(self._missed)
            canvas.activated.connect(lambda index=index: self._set_leader(index))
            self.canvases.append(canvas)
            self._splitter.addWidget(canvas)
        self._navigation = Navigation(self.canvases, self._same_place, self._show_scale)
        self._pages.addWidget(self._splitter)
        self._pages.setCurrentWidget(self._splitter)
        self._navigation.fit()
        self.setFocusProxy(self.canvases[0])

    def _show_picture(self, index: int, picture: Picture) -> None:
        self.canvases[index].show_picture(picture)
        self.status.work.setText(tr("finding edges..."))

    def _show_problem(self, index: int, error: Exception) -> None:
        self.canvases[index].show_problem(str(error))
        FreeCAD.Console.PrintError(f"{error}\n")
        self.status.work.setText("")

    def _show_view(self, index: int, _view: View) -> None:
        if self.views is not None:
            self.status.work.setText("")
        self._fill_layers()
        self.edges_ready.emit(self.canvases[index].camera)

    def _find_missing(self) -> None:
        """Ask where the photographs are and load them."""
        from pipeworkbench.features.transactions import transaction
        from pipeworkbench.gui.dialogs import show_error

        missing = missing_images(self.station_object)
        folder = ask_folder(self, str(missing[0].parent if missing else Path.home()))
        if not folder:
            return
        try:
            with transaction(self.station_object.Document, tr("Find Photographs")):
                relocate(self.station_object, Path(folder))
        except PipeWorkbenchError as error:
            show_error(str(error))
        self._load()

    # layers

    def _make_layers(self) -> None:
        for name in ("edges", "lines", "contours", "residuals"):
            self.layer(name).visible = name in ("contours", "residuals")
        self.layer("residuals").vector_scale = VECTOR_START
        for name in ("epipolar", "hovered contour", "snap"):
            self._layers[name] = Layer(name, self._layer_changed, live=True)
        self.layer("epipolar").visible = False

    def _all_layers(self) -> Iterator[Layer]:
        return iter(list(self._layers.values()))

    def _layer_changed(self, layer: Layer, camera: str | None) -> None:
        for canvas in self.canvases:
            if camera in (None, canvas.camera):
                if layer.live:
                    canvas.update()
                else:
                    canvas.refresh()
        if layer.name in self.toolbar.layers:
            self.toolbar.layers[layer.name].setChecked(layer.visible)

    def _fill_layers(self) -> None:
        """Let the layers of edges and lines have what is found, as far as they are shown."""
        for index, canvas in enumerate(self.canvases):
            edges = self.edges(canvas.camera)
            if edges is not None and self.layer("edges").visible and self.layer("edges").is_empty(canvas.camera):
                self.layer("edges").set_edges(canvas.camera, edges, EDGE_COLOUR)
            if self._photographs is not None and self.layer("lines").visible and edges is not None:
                self._photographs.find_lines(index, self._show_lines)

    def _show_lines(self, index: int, lines: Array) -> None:
        self.layer("lines").set_polylines(self.canvases[index].camera, list(lines), LINE_COLOUR, width=1.2)

    # the pointer

    def _hovered(self, canvas: PhotoCanvas, point: Pixel | None) -> None:
        if self.is_closed:
            return
        edge = self._edge_at(canvas, point)
        self._show_snap(canvas.camera, edge)
        if self.contours is not None and not self._tool:
            name = self._component_at(canvas, point)
            self.contours.hover(name)
            self.status.set_hint("" if name is None else self.contours.label_of(name))
        self._show_search_band(canvas.camera, point if edge is None else (float(edge.point[0]), float(edge.point[1])))
        self._show_place(canvas, point)
        self.pointed.emit(Pointed(canvas.camera, point, edge))

    def _hover_again(self) -> None:
        """Do what a movement of the pointer would do, after something else has changed."""
        canvas = next((canvas for canvas in self.canvases if canvas.pointer is not None), None)
        if canvas is None or canvas.pointer is None:
            self._show_search_band(self.canvases[0].camera, None)
            return
        point = canvas.photograph_at(canvas.pointer)
        self._hovered(canvas, point if canvas.contains(point) else None)

    def _clicked(self, canvas: PhotoCanvas, point: Pixel, modifiers: Any) -> None:
        if self.is_closed:
            return
        if self._tool:
            self.clicked.emit(Click(canvas.camera, point, self._edge_at(canvas, point), modifiers))
            return
        adds = bool(modifiers & Qt.KeyboardModifier.ControlModifier)
        name = self._component_at(canvas, point)
        self.clicked.emit(Click(canvas.camera, point, None, modifiers))
        if not adds:
            FreeCADGui.Selection.clearSelection(self._document_name)
        if name is not None:
            FreeCADGui.Selection.addSelection(self._document_name, name)
            self.component_clicked.emit(name, adds)

    def _missed(self) -> None:
        self.status.notice(tr("That is beside the photograph: click inside it"))

    def _edge_at(self, canvas: PhotoCanvas, point: Pixel | None) -> SnappedEdge | None:
        edges = self.edges(canvas.camera) if self._snapping and point is not None else None
        if edges is None or point is None:
            return None
        return nearest_edge(edges, point, max(preferences().snap_radius_px / canvas.scale, LEAST_SNAP_PX))

    def _component_at(self, canvas: PhotoCanvas, point: Pixel | None) -> str | None:
        if point is None or self.contours is None or not self.layer("contours").visible:
            return None
        return self.contours.nearest(canvas.camera, point, HIT_SCREEN_PX / canvas.scale)

    def _show_snap(self, camera: str, edge: SnappedEdge | None) -> None:
        layer = self.layer("snap")
        layer.clear()
        if edge is not None:
            thread = [edge.polyline]
            glow = Polylines(thread, SNAP_GLOW, GLOW_WIDTH, casing=False)
            layer.set_drawings(camera, [glow, Polylines(thread, SNAP, SNAP_WIDTH, casing=False), Points(edge.point, SNAP)])

    def _show_search_band(self, camera: str, point: Pixel | None) -> None:
        layer = self.layer("epipolar")
        layer.clear()
        if point is None or not layer.visible:
            return
        settings = pick_settings()
        source = self.station.cameras[self._index_of(camera)]
        for other in self.station.cameras:
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

    def _show_place(self, canvas: PhotoCanvas, point: Pixel | None) -> None:
        if point is None:
            self.status.place.setText(f"{100 * canvas.scale:.0f} %")
            return
        value = None if canvas.picture is None else canvas.picture.value_at(*point)
        grey = "" if value is None else tr("grey {value}").format(value=value)
        self.status.place.setText(f"{canvas.camera}   {point[0]:8.2f}, {point[1]:8.2f}   {grey:>9}   {100 * canvas.scale:4.0f} %")

    def _show_scale(self) -> None:
        if self.canvases:
            canvas = self.canvases[self._leader]
            self._show_place(canvas, None if canvas.pointer is None else canvas.photograph_at(canvas.pointer))

    def _same_place(self, camera: str, point: Pixel, other: str) -> Pixel | None:
        """Return the pixel of another photograph that shows what one shows, at the components' distance or in the middle of the working range."""
        source, target = (self.station.cameras[self._index_of(name)] for name in (camera, other))
        near, far = pick_settings().working_range
        known = None if self.contours is None else self.contours.distance_from(source.projection_centre)
        distance = known or (near * far) ** 0.5
        u, v = target.project(source.projection_centre + distance * source.rays(np.array([point], float)))[0].tolist()
        return (u, v) if target.sees(np.array([[u, v]]))[0] else None

    # keys

    def _meaning_of(self, event: Any) -> Any:
        """Return what a key does here, None where it means nothing."""
        if self.is_closed:
            return None
        modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        key = event.key()
        if modifiers == Qt.KeyboardModifier.NoModifier:
            plain = {
                Qt.Key.Key_Return: self.accepted.emit,
                Qt.Key.Key_Enter: self.accepted.emit,
                Qt.Key.Key_Escape: self._step_back,
                Qt.Key.Key_F: self.fit,
                Qt.Key.Key_L: self.toolbar.loupe.toggle,
                Qt.Key.Key_Space: self._pan_with_left,
            }
            text = event.text()
            if text.isdigit() and text != "0":
                return lambda: self.digit_pressed.emit(int(text))
            return plain.get(key)
        if modifiers == Qt.KeyboardModifier.ControlModifier:
            return {
                Qt.Key.Key_1: self.one_to_one,
                Qt.Key.Key_Z: self._undo,
                Qt.Key.Key_Y: self._redo,
            }.get(key)
        if modifiers == Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier and key == Qt.Key.Key_Z:
            return self._redo
        return None

    def _step_back(self) -> None:
        if not self._tool:
            FreeCADGui.Selection.clearSelection(self._document_name)
        self.stepped_back.emit()

    def _undo(self) -> None:
        FreeCAD.getDocument(self._document_name).undo()

    def _redo(self) -> None:
        FreeCAD.getDocument(self._document_name).redo()

    def _pan_with_left(self, *, pans: bool = True) -> None:
        for canvas in self.canvases:
            canvas.set_pans_with_left(pans)

    # small things

    def _view(self, camera: str) -> View | None:
        return None if self._photographs is None else self._photographs.view(self._index_of(camera))

    def _index_of(self, camera: str) -> int:
        return next(index for index, canvas in enumerate(self.canvases) if canvas.camera == camera)

    def _set_leader(self, index: int) -> None:
        self._leader = index

    def _end(self) -> None:
        """Stop everything; nothing of the document is touched any more."""
        if self.is_closed:
            return
        self.is_closed = True
        if self._observer is not None:
            self._observer.stop()
            self._observer = None
        if self.contours is not None:
            self.contours.stop()
        self._background.stop()
        forget(self)
        self.closed.emit()

    def _close_sub_window(self) -> None:
        if is_alive(self) and is_alive(self.parent()):
            self.parent().close()


# the windows that are open, the last used one last
_open: list[PhotoWindow] = []


def open_photo_window(station_object: Any) -> PhotoWindow:
    """Return the station's photo window, raised; it is made where there is none."""
    key = station_object.Document.Name, station_object.Name
    window = next((w for w in _open if (w._document_name, w._object_name) == key), None)  # noqa: SLF001  # of this module
    if window is None:
        window = PhotoWindow(station_object)
        area = FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)
        sub_window = area.addSubWindow(window)
        sub_window.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        sub_window.setWindowIcon(window.windowIcon())
        sub_window.aboutToActivate.connect(lambda: _used(window))
        _open.append(window)
        sub_window.showMaximized()
    window.parent().show()
    FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).setActiveSubWindow(window.parent())
    window.setFocus()
    _used(window)
    return window


def photo_window() -> PhotoWindow | None:
    """Return the photo window that was used last, None where none is open."""
    return _open[-1] if _open else None


def forget(window: PhotoWindow) -> None:
    """Take a window that closes out of the list."""
    if window in _open:
        _open.remove(window)


def _used(window: PhotoWindow) -> None:
    """Remember that a window was used; its document becomes the active one, so that commands work on it."""
    if window.is_closed or window not in _open:
        return
    _open.remove(window)
    _open.append(window)
    document = window.station_object.Document
    if FreeCAD.ActiveDocument is None or FreeCAD.ActiveDocument.Name != document.Name:
        FreeCAD.setActiveDocument(document.Name)
