# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies of components for IFC, in the component's own axes: swept solids where these are exact, else facets.

No boolean operations: many programs compute them badly. Bolt holes are voids of the plate's profile.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids import Frame, local_solid
from pipeworkbench.solids.frames import bend_angle
from pipeworkbench.solids.model import bolt_places
from pipeworkbench.solids.outlines import Outline, bore_radius, flange_outline, neck_outline, raised_face, reducer_outline, refuse_tight_bend

if TYPE_CHECKING:
    import ifcopenshell

DEVIATION = 1e-3  # of facets from the surface, part of the outside diameter
FACET_ANGLE = math.radians(10)  # between neighbouring facets
SAME_VERTEX_MM = 1e-4  # facets of neighbouring faces meet in vertices closer than this
ORIGIN = (0.0, 0.0, 0.0)


class Shapes:
    """Adds geometry to one IFC file."""

    def __init__(self, file: ifcopenshell.file) -> None:
        self.file = file

    def add(self, kind: str, **attributes: Any) -> Any:
        """Add an entity to the file."""
        return self.file.create_entity(kind, **attributes)

    def body(self, component: AnyComponent, frame: Frame) -> tuple[str, list[Any]]:
        """Return the representation type and the items of a component's body."""
        match component:
            case Pipe():
                # a wall that is not known: a full profile is honest, an invented wall is not
                return "SweptSolid", [self._extruded(self._circle_profile(component), 0.0, component.length)]
            case Elbow():
                refuse_tight_bend(component)
                profile = self._circle_profile(component)
                axis = self._axis((component.bend_radius, 0.0, 0.0))
                solid = self.add("IfcRevolvedAreaSolid", SweptArea=profile, Position=self.axes(), Axis=axis, Angle=bend_angle(component))
                return "SweptSolid", [solid]
            case Flange():
                return "SweptSolid", self._flange(component)
            case Reducer() if component.reducer_type == "concentric":
                return "SweptSolid", [self._turned(reducer_outline(component))]
            case Reducer() | Tee() | Cap():
                return "Tessellation", [self._facets(component, frame)]

    def line(self, length: float) -> Any:
        """Return an axis from the origin along z."""
        return self.add("IfcPolyline", Points=[self._point(ORIGIN), self._point((0.0, 0.0, length))])

    def axes(self, location: Iterable[float] = ORIGIN, axis: Iterable[float] | None = None, reference: Iterable[float] | None = None) -> Any:
        """Return axes at a place: ``axis`` is their z, ``reference`` their x direction."""
        return self.add(
            "IfcAxis2Placement3D",
            Location=self._point(location),
            Axis=None if axis is None else self._direction(axis),
            RefDirection=None if reference is None else self._direction(reference),
        )

    def _flange(self, flange: Flange) -> list[Any]:
        if flange.K is None or flange.L is None or flange.bolts is None:
            return [self._turned(flange_outline(flange))]
        flange_outline(flange)  # refuses what makes no flange
        bore, face = bore_radius(flange), raised_face(flange)
        voids = [self._circle(flange.L / 2, place) for place in bolt_places(flange.K, flange.bolts)]
        if bore:
            voids.append(self._circle(bore))
        plate = self.add("IfcArbitraryProfileDefWithVoids", ProfileType="AREA", OuterCurve=self._circle(flange.D / 2), InnerCurves=voids)
        front = face[1] if face else 0.0
        items = [self._extruded(plate, front, flange.C - front)]
        if face:
            items.append(self._turned([(bore, 0.0), (face[0], 0.0), (face[0], front), (bore, front)]))
        neck = neck_outline(flange)
        return [*items, self._turned(neck)] if neck else items

    def _circle_profile(self, component: Pipe | Elbow) -> Any:
        common = {"ProfileType": "AREA", "Position": self._axes_2d((0.0, 0.0)), "Radius": component.outer_diameter / 2}
        if component.wall_thickness is None:
            return self.add("IfcCircleProfileDef", **common)
        return self.add("IfcCircleHollowProfileDef", WallThickness=component.wall_thickness, **common)

    def _extruded(self, profile: Any, start: float, length: float) -> Any:
        """Return a profile extruded along z."""
        position = self.axes((0.0, 0.0, start))
        up = self._direction((0.0, 0.0, 1.0))
        return self.add("IfcExtrudedAreaSolid", SweptArea=profile, Position=position, ExtrudedDirection=up, Depth=length)

    def _turned(self, outline: Outline) -> Any:
        """Return the solid that an outline (radius, along z) makes about the z axis."""
        points = [self._point(point) for point in outline]
        profile = self.add("IfcArbitraryClosedProfileDef", ProfileType="AREA", OuterCurve=self.add("IfcPolyline", Points=[*points, points[0]]))
        # the profile's x and y are the component's x and z
        position = self.axes(ORIGIN, (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))
        return self.add("IfcRevolvedAreaSolid", SweptArea=profile, Position=position, Axis=self._axis(ORIGIN), Angle=2 * math.pi)

    def _axis(self, location: Iterable[float]) -> Any:
        """Return an axis of revolution along y, in the profile's plane."""
        return self.add("IfcAxis1Placement", Location=self._point(location), Axis=self._direction((0.0, 1.0, 0.0)))

    def _facets(self, component: AnyComponent, frame: Frame) -> Any:
        """Return a component's solid as a closed set of triangles."""
        vertices, triangles = local_solid(component, frame).tessellate(DEVIATION * component.outer_diameter, FACET_ANGLE)
        # each face brings vertices of its own: a closed set shares them
        places: dict[tuple[int, int, int], int] = {}
        coordinates: list[tuple[float, float, float]] = []
        shared = []
        for vertex in vertices:
            point = vertex.toTuple()
            key = tuple(round(value / SAME_VERTEX_MM) for value in point)
            if key not in places:
                places[key] = len(coordinates) + 1  # IFC counts from 1
                coordinates.append(point)
            shared.append(places[key])
        faces = [tuple(shared[corner] for corner in triangle) for triangle in triangles]
        return self.add(
            "IfcTriangulatedFaceSet",
            Coordinates=self.add("IfcCartesianPointList3D", CoordList=coordinates),
            Closed=True,
            CoordIndex=[face for face in faces if len(set(face)) == 3],
        )

    def _circle(self, radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> Any:
        return self.add("IfcCircle", Position=self._axes_2d(centre), Radius=radius)

    def _point(self, values: Iterable[float]) -> Any:
        return self.add("IfcCartesianPoint", Coordinates=tuple(float(value) for value in values))

    def _direction(self, values: Iterable[float]) -> Any:
        return self.add("IfcDirection", DirectionRatios=tuple(float(value) for value in values))

    def _axes_2d(self, location: tuple[float, float]) -> Any:
        return self.add("IfcAxis2Placement2D", Location=self._point(location))
