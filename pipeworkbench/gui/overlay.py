# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components, shapes and lines in a document's 3D views that are not in the document: not selected, not saved, not undone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import FreeCADGui

from pipeworkbench.gui.colours import Colour
from pipeworkbench.gui.surfaces import surfaces_of
from pipeworkbench.pipeline import AnyComponent

Point = Sequence[float]
DEVIATION_MM = 1.0  # of the triangles from the shape
SMOOTH = 0.6  # rad; facets that meet at less are shaded as one surface
NEARER = -4.0  # of the polygon offset: what is drawn over an object's own surface is in front of it


class Overlay:
    """What a panel or a tool shows in all 3D views of a document until it is cleared."""

    def __init__(self, document: Any) -> None:
        from pivy import coin

        self._document_name: str = document.Name
        self._root = coin.SoSeparator()
        self._root.setName("PipeWorkbenchOverlay")
        unpickable = coin.SoPickStyle()
        unpickable.style = coin.SoPickStyle.UNPICKABLE
        self._root.addChild(unpickable)
        self._content = coin.SoSeparator()
        self._root.addChild(self._content)

    @property
    def count(self) -> int:
        """How many shapes, surfaces and sets of lines there are."""
        return int(self._content.getNumChildren())

    def show(self) -> None:
        """Put the overlay into the document's 3D views, those opened since the last call too."""
        for view in self._open_views():
            graph = view.getSceneGraph()
            if graph.findChild(self._root) < 0:
                graph.addChild(self._root)

    def remove(self) -> None:
        """Take the overlay out of all views."""
        for view in self._open_views():
            graph = view.getSceneGraph()
            if graph.findChild(self._root) >= 0:
                graph.removeChild(self._root)

    def clear(self) -> None:
        """Take everything out of the overlay."""
        self._content.removeAllChildren()

    def add_component(self, component: AnyComponent, colour: Colour, transparency: float = 0.0) -> None:
        """Show a component of the document's frame."""
        from pivy import coin

        for grid in surfaces_of(component):
            coordinates, mesh = coin.SoCoordinate3(), coin.SoQuadMesh()
            coordinates.point.setValues(0, grid.shape[0] * grid.shape[1], grid.reshape(-1, 3).tolist())
            mesh.verticesPerColumn, mesh.verticesPerRow = grid.shape[:2]
            self._add(_material(colour, transparency), _two_sided(), coordinates, mesh)

    def add_shape(self, shape: Any, colour: Colour, transparency: float = 0.0, motion: Sequence[Sequence[float]] | None = None) -> None:
        """Show a Part shape, moved by a motion (4 x 4) where one is given, in front of what is at the same place."""
        from pivy import coin

        points, facets = shape.tessellate(DEVIATION_MM)
        if not facets:
            return
        transform, hints = coin.SoMatrixTransform(), _two_sided()
        if motion is not None:
            # coin multiplies rows with matrices
            transform.matrix.setValue(coin.SbMatrix(*(float(motion[row][column]) for column in range(4) for row in range(4))))
        hints.creaseAngle = SMOOTH
        offset = coin.SoPolygonOffset()
        offset.factor, offset.units = NEARER, NEARER
        coordinates, faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
        coordinates.point.setValues(0, len(points), [tuple(point) for point in points])
        indices = [index for facet in facets for index in (*facet, -1)]
        faces.coordIndex.setValues(0, len(indices), indices)
        self._add(transform, _material(colour, transparency), hints, offset, coordinates, faces)

    def add_lines(self, lines: Iterable[tuple[Point, Point]], colour: Colour, width: float = 3.0) -> None:
        """Show straight lines between pairs of points, with a dot at either end."""
        from pivy import coin

        points = [tuple(map(float, point)) for line in lines for point in line]
        if not points:
            return
        light = coin.SoLightModel()
        light.model = coin.SoLightModel.BASE_COLOR
        style = coin.SoDrawStyle()
        style.lineWidth, style.pointSize = width, 2 * width
        coordinates, segments, dots = coin.SoCoordinate3(), coin.SoLineSet(), coin.SoPointSet()
        coordinates.point.setValues(0, len(points), points)
        segments.numVertices.setValues(0, len(points) // 2, [2] * (len(points) // 2))
        self._add(light, _material(colour, 0.0), style, coordinates, segments, dots)

    def _add(self, *nodes: Any) -> None:
        """Add one thing that is shown, made of nodes."""
        from pivy import coin

        group = coin.SoSeparator()
        for node in nodes:
            group.addChild(node)
        self._content.addChild(group)

    def _open_views(self) -> list[Any]:
        try:
            document = FreeCADGui.getDocument(self._document_name)
        except NameError:  # it is closed, or being closed: then FreeCAD still lists it
            return []
        return list(document.mdiViewsOfType("Gui::View3DInventor")) if document is not None else []


def _material(colour: Colour, transparency: float) -> Any:
    from pivy import coin

    material = coin.SoMaterial()
    material.diffuseColor = colour
    material.transparency = transparency
    return material


def _two_sided() -> Any:
    """Return what has both sides of surfaces lit."""
    from pivy import coin

    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    return hints
