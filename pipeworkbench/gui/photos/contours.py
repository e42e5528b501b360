# SPDX-License-Identifier: LGPL-2.1-or-later
"""The contours of the document's components over the photographs: they follow the document, are selected and select."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import StationFrame, frame_of
from pipeworkbench.features.kinds import is_component
from pipeworkbench.features.preferences import preferences
from pipeworkbench.gui.colours import hex_of, quality_colour
from pipeworkbench.gui.compat import QtCore
from pipeworkbench.gui.photos.background import Background
from pipeworkbench.gui.photos.drawing import Drawing, Polylines
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.photos.observers import Coalesced
from pipeworkbench.gui.selection import SelectionObserver, selected_objects
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee, moved
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.image_curves import ComponentCurves, component_curves, distance_to_polyline
from pipeworkbench.recon.station import Station

# told apart on grey photographs, by colour-blind people too (Okabe and Ito)
KIND_COLOURS: dict[type[AnyComponent], str] = {
    Pipe: "#56b4e9",
    Elbow: "#e69f00",
    Flange: "#2fd69f",
    Tee: "#f0e442",
    Reducer: "#ff8a4c",
    Cap: "#e59ac4",
}
SELECTED_COLOUR, HOVERED_COLOUR = "#3dff5a", "#ffffff"
WIDTH, HIDDEN_WIDTH, SELECTED_WIDTH = 1.6, 1.0, 3.0


class Colouring(Enum):
    """What the contours' colours say."""

    KIND = "kind"
    QUALITY = "quality"


@dataclass(frozen=True, eq=False)
class Shown:
    """A document object's component and its contour by camera."""

    name: str
    label: str
    component: AnyComponent
    curves: dict[str, ComponentCurves]


class ComponentContours:
    """Keeps a layer in step with the components of a document that a station's cameras see."""

    def __init__(self, owner: QtCore.QObject, station_object: Any, station: Station, layer: Layer, highlight: Layer, background: Background) -> None:
        self._station_object, self._station = station_object, station
        self._layer, self._highlight, self._background = layer, highlight, background
        self._known: dict[str, AnyComponent | None] = {}  # None for those that have no geometry
        self._shown: list[Shown] = []
        self._running: Future[list[dict[str, ComponentCurves]]] | None = None
        self._outdated = False
        self._hovered: str | None = None
        self._colouring = Colouring.KIND
        self.shows_hidden = True
        self._update = Coalesced(owner, self._follow)
        self._redraw = Coalesced(owner, self.draw, 0)
        self._selection = SelectionObserver(station_object.Document, self._redraw.request)
        self._update.request()

    @property
    def colouring(self) -> Colouring:
        """What the contours' colours say."""
        return self._colouring

    @colouring.setter
    def colouring(self, colouring: Colouring) -> None:
        self._colouring = colouring
        self.draw()

    @property
    def up_to_date(self) -> bool:
        """Whether what is drawn is what the document has."""
        return self._running is None and not self._outdated

    def stop(self) -> None:
        """Follow the document and the selection no more."""
        self._update.stop()
        self._redraw.stop()
        self._selection.stop()

    def object_changed(self, name: str) -> None:
        """Look at an object again."""
        self._known.pop(name, None)
        self._outdated = True
        self._update.request()

    def nearest(self, camera: str, point: tuple[float, float], tolerance: float) -> str | None:
        """Return the name of the object whose visible contour is nearest to a pixel, None where none is within the tolerance (px)."""
        best, found = tolerance, None
        for shown in self._shown:
            for line in shown.curves[camera].seen:
                distance = distance_to_polyline(np.asarray(point, float), line)
                if distance < best:
                    best, found = distance, shown.name
        return found

    def label_of(self, name: str) -> str:
        """Return what the user calls a shown object."""
        return next((shown.label for shown in self._shown if shown.name == name), name)

    def distance_from(self, place: Array) -> float | None:
        """Return the median distance (mm) of the components from a place, None where there are none."""
        middles = [np.mean([port.point for port in shown.component.ports], axis=0) for shown in self._shown]
        return float(np.median(np.linalg.norm(np.array(middles) - place, axis=1))) if middles else None

    def hover(self, name: str | None) -> None:
        """Emphasise the contour that a click would select."""
        if name != self._hovered:
            self._hovered = name
            self._draw_hovered()

    def _follow(self) -> None:
        """Compute the contours anew, in the background, one after the other; only where a component is another one than is shown."""
        if self._running is not None:
            self._outdated = True
            return
        self._outdated = False
        frame = frame_of(self._station_object)
        level_from_frame = frame.level_from_frame
        objects = self._visible_objects(frame)
        named = [(obj.Name, obj.Label) for obj in objects]
        placed = [moved(component, level_from_frame) for obj in objects if (component := self._known[obj.Name]) is not None]

        def show(curves: list[dict[str, ComponentCurves]]) -> None:
            self._running = None
            self._shown = [Shown(*names, component, by_camera) for names, component, by_camera in zip(named, placed, curves, strict=True)]
            self.draw()
            if self._outdated:
                self._update.request()

        def give_up(_error: Exception) -> None:
            named.clear()
            placed.clear()
            show([])

        if placed != [shown.component for shown in self._shown]:
            self._running = self._background.submit(lambda: component_curves(self._station, placed), show, give_up)
        elif named != [(shown.name, shown.label) for shown in self._shown]:
            show([shown.curves for shown in self._shown])

    def _visible_objects(self, frame: StationFrame) -> list[Any]:
        """Return the objects of a frame that are to be shown; what they are is asked only of those that have changed."""
        document = self._station_object.Document
        found = []
        for obj in document.Objects:
            if not is_component(obj) or (obj.ViewObject is not None and not obj.ViewObject.Visibility):
                continue
            if obj.Name not in self._known:
                self._known[obj.Name] = _component_or_none(obj)
            if self._known[obj.Name] is not None and frame.holds(obj.StationName):
                found.append(obj)
        return found

    def draw(self) -> None:
        """Draw the contours, those of selected components above the others."""
        selected = {obj.Name for obj in selected_objects(self._station_object.Document)}
        colours = self._colours()
        for camera in (camera.name for camera in self._station.cameras):
            drawings: list[Drawing] = []
            by_colour: dict[str, tuple[list[Array], list[Array]]] = {}
            chosen: list[Array] = []
            for shown, colour in zip(self._shown, colours, strict=True):
                curves = shown.curves[camera]
                seen, hidden = by_colour.setdefault(colour, ([], []))
                hidden += curves.hidden
                (chosen if shown.name in selected else seen).extend(curves.seen)
            for colour, (seen, hidden) in by_colour.items():
                if self.shows_hidden:
                    drawings.append(Polylines(hidden, colour, HIDDEN_WIDTH, dashed=True))
                drawings.append(Polylines(seen, colour, WIDTH))
            drawings.append(Polylines(chosen, SELECTED_COLOUR, SELECTED_WIDTH))
            self._layer.set_drawings(camera, drawings)
        self._draw_hovered()

    def _draw_hovered(self) -> None:
        shown = next((shown for shown in self._shown if shown.name == self._hovered), None)
        self._highlight.clear()
        if shown is not None:
            for camera, curves in shown.curves.items():
                self._highlight.set_polylines(camera, curves.seen, HOVERED_COLOUR, width=WIDTH)

    def _colours(self) -> list[str]:
        """Return the colours of what is shown."""
        if self._colouring is Colouring.KIND:
            return [KIND_COLOURS[type(shown.component)] for shown in self._shown]
        chosen = preferences()
        return [hex_of(quality_colour(shown.component.quality, chosen)) for shown in self._shown]


def _component_or_none(obj: Any) -> AnyComponent | None:
    """Return the component of an object, None while its dimensions do not belong together: FreeCAD marks it."""
    try:
        return component_of(obj)
    except PipeWorkbenchError:
        return None
