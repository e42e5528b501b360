# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ghosts in 3D: components that are not in the document, drawn into its views beside the document's own scene."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np

from pipeworkbench.gui.compat import QtGui
from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.shapes import shapes_of

AROUND = 33  # points of a circle, the first one again at its end
ALONG = 17  # points of a bend
TRANSPARENCY = 0.45


class Ghosts:
    """What a tool shows in the 3D views of a document; nothing of it is saved, selected or undone."""

    def __init__(self, document: Any) -> None:
        from pivy import coin

        self._document_name = document.Name
        self._root = coin.SoSeparator()
        pickable = coin.SoPickStyle()
        pickable.style = coin.SoPickStyle.UNPICKABLE
        hints = coin.SoShapeHints()
        hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
        self._content = coin.SoSeparator()
        for node in (pickable, hints, self._content):
            self._root.addChild(node)
        self._scenes: list[Any] = []

    @property
    def count(self) -> int:
        """How many surfaces are shown."""
        return int(self._content.getNumChildren())

    def show(self, coloured: Iterable[tuple[AnyComponent, str]]) -> None:
        """Show components, each in its colour, instead of what was shown."""
        self._content.removeAllChildren()
        for component, colour in coloured:
            for surface in surfaces_of(component):
                self._content.addChild(_node(surface, colour))
        self._enter_views()

    def clear(self) -> None:
        """Show nothing any more, and leave the views."""
        self._content.removeAllChildren()
        for scene in self._scenes:
            if scene.findChild(self._root) >= 0:
                scene.removeChild(self._root)
        self._scenes.clear()

    def _enter_views(self) -> None:
        """Add the ghosts to the views that do not have them yet: some may have been opened meanwhile."""
        if self._document_name not in FreeCAD.listDocuments():
            return
        for view in FreeCADGui.getDocument(self._document_name).mdiViewsOfType("Gui::View3DInventor"):
            scene = view.getSceneGraph()
            if scene.findChild(self._root) < 0:
                scene.addChild(self._root)
                self._scenes.append(scene)


def surfaces_of(component: AnyComponent) -> list[Array]:
    """Return a component's surfaces as grids (rows, columns, 3) of points, mm."""
    shapes = shapes_of([component])
    frustums, tori = shapes.frustums, shapes.tori
    around = np.linspace(0, 2 * np.pi, AROUND)
    circle = np.stack([np.cos(around), np.sin(around)])
    grids = []
    first, second = perpendicular_axes(frustums.axis)
    for row in range(len(frustums)):
        ring = circle.T @ np.stack([first[row], second[row]])
        ends = frustums.start[row] + np.array([[0.0], [frustums.length[row]]]) * frustums.axis[row]
        grids.append(ends[:, None] + frustums.radius[row][:, None, None] * ring)
    for row in range(len(tori)):
        turn = np.linspace(0, tori.angle[row], ALONG)
        radial = np.stack([np.cos(turn), np.sin(turn)]).T @ np.stack([tori.first[row], tori.second[row]])
        outwards = tori.bend_radius[row] + tori.tube_radius[row] * circle[0]
        along_axis = tori.tube_radius[row] * circle[1]
        grids.append(tori.centre[row] + outwards[None, :, None] * radial[:, None] + along_axis[None, :, None] * tori.axis[row])
    return grids


def _node(grid: Array, colour: str) -> Any:
    """Return a grid of points as a transparent surface of coin."""
    from pivy import coin

    rows, columns = grid.shape[:2]
    node = coin.SoSeparator()
    material = coin.SoMaterial()
    red, green, blue, _ = QtGui.QColor(colour).getRgbF()
    material.diffuseColor = (red, green, blue)
    material.transparency = TRANSPARENCY
    points = coin.SoCoordinate3()
    values: Sequence[Sequence[float]] = grid.reshape(-1, 3).tolist()
    points.point.setValues(0, len(values), values)
    mesh = coin.SoQuadMesh()
    mesh.verticesPerRow, mesh.verticesPerColumn = columns, rows
    for part in (material, points, mesh):
        node.addChild(part)
    return node
