# SPDX-License-Identifier: LGPL-2.1-or-later
"""Overlays that can be switched: what they draw, for each camera, in the pixels of its photograph."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pipeworkbench.gui.compat import QtGui
from pipeworkbench.gui.photos.drawing import Drawing, EdgeDots, Points, Polylines, Vectors
from pipeworkbench.gui.photos.picture import Frame
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgePoints


class Layer:
    """An overlay; ``live`` ones are drawn anew with every movement of the pointer and above all others."""

    def __init__(self, name: str, changed: Callable[[Layer, str | None], None], *, live: bool = False) -> None:
        self.name = name
        self.live = live
        self._changed = changed
        self._visible = True
        self._exaggeration = 1.0
        self._drawings: dict[str, dict[str, list[Drawing]]] = {}

    @property
    def visible(self) -> bool:
        """Whether the layer is drawn."""
        return self._visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        if visible != self._visible:
            self._visible = visible
            self._changed(self, None)

    @property
    def vector_scale(self) -> float:
        """How many times longer than they are vectors are drawn."""
        return self._exaggeration

    @vector_scale.setter
    def vector_scale(self, scale: float) -> None:
        self._exaggeration = scale
        for kinds in self._drawings.values():
            for drawing in kinds.get("vectors", []):
                if isinstance(drawing, Vectors):
                    drawing.exaggeration = scale
        self._changed(self, None)

    def set_polylines(self, camera: str, lines: Sequence[Array], colour: str, *, width: float = 1.5, dashed: bool = False) -> None:
        """Draw polylines (n, 2) instead of the camera's earlier ones."""
        self._set(camera, "polylines", [Polylines(lines, colour, width, dashed=dashed)])

    def add_polylines(self, camera: str, lines: Sequence[Array], colour: str, *, width: float = 1.5, dashed: bool = False) -> None:
        """Draw more polylines (n, 2), above the camera's earlier ones."""
        earlier = self._drawings.get(camera, {}).get("polylines", [])
        self._set(camera, "polylines", [*earlier, Polylines(lines, colour, width, dashed=dashed)])

    def set_points(self, camera: str, points: Array, colour: str, *, labels: Sequence[str] = ()) -> None:
        """Draw points (n, 2) instead of the camera's earlier ones, with labels where there are any."""
        self._set(camera, "points", [Points(points, colour, labels)])

    def set_vectors(self, camera: str, starts: Array, ends: Array, colour: str) -> None:
        """Draw arrows between points (n, 2) instead of the camera's earlier ones, ``vector_scale`` times as long."""
        vectors = Vectors(starts, ends, colour)
        vectors.exaggeration = self._exaggeration
        self._set(camera, "vectors", [vectors])

    def set_edges(self, camera: str, edges: EdgePoints, colour: str) -> None:
        """Draw the edge points of an image instead of the camera's earlier ones."""
        self._set(camera, "edges", [EdgeDots(edges, colour)])

    def set_drawings(self, camera: str, drawings: Sequence[Drawing]) -> None:
        """Draw these instead of all that the camera had."""
        self._drawings[camera] = {"polylines": list(drawings)}
        self._changed(self, camera)

    def clear(self, camera: str | None = None) -> None:
        """Draw nothing any more, in one camera or in all."""
        if camera is None:
            had = bool(self._drawings)
            self._drawings.clear()
        else:
            had = self._drawings.pop(camera, None) is not None
        if had:
            self._changed(self, camera)

    def is_empty(self, camera: str) -> bool:
        """Tell whether there is nothing to be drawn in a camera's photograph."""
        return not self._drawings.get(camera)

    def drawings(self, camera: str) -> list[Drawing]:
        """Return what is drawn in a camera's photograph, visible or not."""
        return [drawing for kind in self._drawings.get(camera, {}).values() for drawing in kind]

    def draw(self, painter: QtGui.QPainter, camera: str, frame: Frame) -> None:
        """Draw what the camera has over what a frame shows."""
        if self._visible:
            for drawing in self.drawings(camera):
                drawing.draw(painter, frame)

    def _set(self, camera: str, kind: str, drawings: list[Drawing]) -> None:
        self._drawings.setdefault(camera, {})[kind] = drawings
        self._changed(self, camera)
