# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window: one MDI window per station, its photographs side by side, to look at and to click in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.features.preferences import pick_settings
from pipeworkbench.features.station import missing_images, relocate, station_of
from pipeworkbench.files import package_folder
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, Signal, is_alive
from pipeworkbench.gui.photos.background import Background
from pipeworkbench.gui.photos.canvas import PhotoCanvas
from pipeworkbench.gui.photos.contours import Colouring, ComponentContours
from pipeworkbench.gui.photos.keys import meaning_of
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.photos.missing_page import MissingPage, ask_folder
from pipeworkbench.gui.photos.navigation import Navigation
from pipeworkbench.gui.photos.observers import DocumentObserver
from pipeworkbench.gui.photos.photographs import Photographs
from pipeworkbench.gui.photos.picture import Picture, Tone
from pipeworkbench.gui.photos.pointing import Pixel, Pointing
from pipeworkbench.gui.photos.status import StatusLine
from pipeworkbench.gui.photos.toolbar import VECTOR_START, PhotoToolbar
from pipeworkbench.gui.translation import tr
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgeMap
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View

EDGE_COLOUR, LINE_COLOUR = "#ffb347", "#ff6ad5"

Qt = QtCore.Qt


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
    closed = Signal()

    station: Station

    def __init__(self, station_object: Any) -> None:
        super().__init__()
        self.station_object = station_object
        self.canvases: list[PhotoCanvas] = []
        self.contours: ComponentContours | None = None
        self.is_closed = False
        self.is_missing = True
        self.document_name: str = station_object.Document.Name
        self._object_name: str = station_object.Name
        self._layers: dict[str, Layer] = {}
        self._tool = False
        self._pointing = Pointing(self)
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
        self._tool, self._pointing.snaps = active, active and snapping
        self.status.set_hint(hint)
        self.layer("snap").clear()
        if self.contours is not None:
            self.contours.hover(None)
        if self.canvases:
            self._pointing.again()

    @property
    def key(self) -> tuple[str, str]:
        """The names of the document and of the station."""
        return self.document_name, self._object_name

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

    def reveal(self, lines: Mapping[str, Sequence[Array]], still: str | None = None) -> None:
        """Move photographs in which lines, by camera and in pixels, are hardly to be seen, so that they are; all keep their scale.

        The photograph of the camera ``still`` stays where it is.
        """
        if self._navigation is not None:
            for canvas in self.canvases:
                shown = [line for line in lines.get(canvas.camera, ()) if len(line)]
                if shown and canvas.camera != still:
                    self._navigation.reveal(canvas, np.concatenate(shown))

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
            self._pointing.again()

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
            self._end()
        elif self.contours is not None:
            self.contours.object_changed(name)

    def document_closed(self) -> None:
        """Close with the document (called by its observer)."""
        self._end()

    # Qt's events

    def event(self, event: Any) -> bool:  # Qt's name
        """Keep FreeCAD's shortcuts (digits turn the 3D view) from taking the window's own keys."""
        if event.type() == QtCore.QEvent.Type.ShortcutOverride and meaning_of(event, self) is not None:
            event.accept()
            return True
        return bool(super().event(event))

    def keyPressEvent(self, event: Any) -> None:  # Qt's name
        """Do what a key means here."""
        meaning = meaning_of(event, self)
        if meaning is None:
            super().keyPressEvent(event)
        else:
            meaning()

    def keyReleaseEvent(self, event: Any) -> None:  # Qt's name
        """End panning with the space bar."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.pan_with_left(pans=False)
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
            canvas.hovered.connect(partial(self._pointing.hovered, canvas))
            canvas.clicked.connect(partial(self._pointing.clicked, canvas))
            canvas.missed.connect(self._missed)
            canvas.activated.connect(partial(self._set_leader, index))
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

    def _show_view(self, _index: int, _view: View) -> None:
        if self.views is not None:
            self.status.work.setText("")
        self._fill_layers()

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

    # the pointer and keys

    def step_back(self) -> None:
        """Take Esc: a step of a tool's back, or nothing selected any more."""
        if not self._tool:
            FreeCADGui.Selection.clearSelection(self.document_name)
        self.stepped_back.emit()

    def pan_with_left(self, *, pans: bool) -> None:
        """Let the left button pan, while the space bar is held."""
        for canvas in self.canvases:
            canvas.set_pans_with_left(pans)

    def _missed(self) -> None:
        self.status.notice(tr("That is beside the photograph: click inside it"))

    def _show_scale(self) -> None:
        if self.canvases:
            canvas = self.canvases[self._leader]
            self._pointing.show_place(canvas, None if canvas.pointer is None else canvas.photograph_at(canvas.pointer))

    def _same_place(self, camera: str, point: Pixel, other: str) -> Pixel | None:
        """Return the pixel of another photograph that shows what one shows, at the components' distance or in the middle of the working range."""
        source, target = (self.station.cameras[self._index_of(name)] for name in (camera, other))
        near, far = pick_settings().working_range
        known = None if self.contours is None else self.contours.distance_from(source.projection_centre)
        distance = known or (near * far) ** 0.5
        u, v = target.project(source.projection_centre + distance * source.rays(np.array([point], float)))[0].tolist()
        return (u, v) if target.sees(np.array([[u, v]]))[0] else None

    # small things

    def _view(self, camera: str) -> View | None:
        return None if self._photographs is None else self._photographs.view(self._index_of(camera))

    def _index_of(self, camera: str) -> int:
        return next(index for index, canvas in enumerate(self.canvases) if canvas.camera == camera)

    def _set_leader(self, index: int) -> None:
        self._leader = index

    def _end(self) -> None:
        """Stop everything and close the sub window: nothing of the document is touched any more."""
        if self.is_closed:
            return
        self.is_closed = True
        if self._observer is not None:
            self._observer.stop()
            self._observer = None
        if self.contours is not None:
            self.contours.stop()
        self._background.stop()
        self.closed.emit()
        # not now: Qt and FreeCAD may be in the middle of something with both; an inner widget that is closed leaves an empty tab behind
        QtCore.QTimer.singleShot(0, self._close_sub_window)

    def _close_sub_window(self) -> None:
        if is_alive(self) and is_alive(self.parent()):
            self.parent().close()
