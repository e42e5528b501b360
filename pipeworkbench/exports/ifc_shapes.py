# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies of components for IFC, in the component's own axes: swept solids, exact and small.

Bolt holes are voids of the plate's profile. Only where two cylinders meet, in tees, there is a boolean operation: the run less the
branch's passage and the branch less the run, each by itself, which is what even simple programs compute. A cap's ellipse is followed by
arcs, which more programs read than ellipses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from pipeworkbench.exports.ifc_file import ORIGIN, Entities, Point, X, Z, rounded
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import bend_angle, local_point
from pipeworkbench.solids.model import bolt_places
from pipeworkbench.solids.outlines import (
    Outline,
    bore_radius,
    dish_height,
    flange_outline,
    neck_outline,
    raised_face,
    reducer_outline,
    refuse_odd_reducer,
    refuse_thick_wall,
    refuse_tight_bend,
    tee_axes,
)

LENGTH_DIGITS, ANGLE_DIGITS = 3, 6  # decimals of mm and rad in which components of one type agree
ARCS = 8  # of a quarter of an ellipse: less than a thousandth of its height off
OVER_MM = 1.0  # by which a cutting solid reaches over what it cuts
SWEPT, TAPERED, SOLID = "SweptSolid", "AdvancedSweptSolid", "CSG"
ALONG_Y = (0.0, 1.0, 0.0)

Body = tuple[str, list[Any]]  # type of representation and items


class Shapes:
    """Adds geometry to one IFC file."""

    def __init__(self, entities: Entities) -> None:
        self.entities, self.add = entities, entities.add

    def body(self, component: AnyComponent, frame: Frame) -> Body:
        """Return a component's body; lengths are those of its type.

        Raises
        ------
        InputError
            Where the component's dimensions make no solid; names the component.
        """
        match component:
            case Pipe():
                return SWEPT, [self.extruded(self.ring(component.outer_diameter, component.wall_thickness), component.length)]
            case Elbow():
                return SWEPT, [self._bend(component)]
            case Flange():
                return SWEPT, self._flange(component)
            case Reducer():
                return self._reducer(component, frame)
            case Tee():
                return SOLID, self._tee(component, frame)
            case Cap():
                return SWEPT, [self.turned(*_cap_outline(component))]

    def line(self, length: float) -> Any:
        """Return an axis from the origin along z."""
        return self.add("IfcPolyline", Points=(self.entities.origin, self.entities.point((0.0, 0.0, length))))

    def ring(self, diameter: float, wall: float | None) -> Any:
        """Return a pipe's section; a full one where the wall is not known: that is honest, an invented wall is not."""
        radius, wall = _length(diameter / 2), wall and _length(wall)
        kind, rest = ("IfcCircleHollowProfileDef", {"WallThickness": wall}) if wall else ("IfcCircleProfileDef", {})
        position = self.entities.axes_2d()
        return self.entities.once((kind, radius, wall), lambda: self.add(kind, ProfileType="AREA", Position=position, Radius=radius, **rest))

    def rectangle(self, width: float, depth: float) -> Any:
        """Return a rectangle from the origin of its plane along x and y."""
        middle = self.entities.axes_2d((width / 2, depth / 2))
        return self.add("IfcRectangleProfileDef", ProfileType="AREA", Position=middle, XDim=_length(width), YDim=_length(depth))

    def extruded(self, profile: Any, length: float, start: Point = ORIGIN, along: Point = Z, across: Point = X) -> Any:
        """Return a profile extruded from a place, in its plane's z direction."""
        up = self.entities.direction((0.0, 0.0, 1.0))
        return self.add(
            "IfcExtrudedAreaSolid", SweptArea=profile, Position=self.entities.axes(start, along, across), ExtrudedDirection=up, Depth=rounded(length)
        )

    def turned(self, outline: Outline, arcs: Sequence[tuple[int, int, int]] = ()) -> Any:
        """Return the solid that an outline (radius, along z) makes about the z axis; ``arcs`` are triples of its points."""
        points = self.add("IfcCartesianPointList2D", CoordList=tuple((_length(x), _length(y)) for x, y in outline))
        curve = self.add("IfcIndexedPolyCurve", Points=points, Segments=self._segments(len(outline), arcs), SelfIntersect=False)
        profile = self.add("IfcArbitraryClosedProfileDef", ProfileType="AREA", OuterCurve=curve)
        # the profile's x and y are the component's x and z
        position = self.entities.axes(ORIGIN, (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))
        angle = 2 * math.pi
        return self.add("IfcRevolvedAreaSolid", SweptArea=profile, Position=position, Axis=self._axis(ORIGIN), Angle=angle)

    def bent(self, profile: Any, radius: float, angle: float, start: Point = ORIGIN, along: Point = Z, across: Point = X) -> Any:
        """Return a profile turned about an axis along y at a distance along x, from a place in its plane's z direction on."""
        axis = self._axis((_length(radius), 0.0, 0.0))
        position = self.entities.axes(start, along, across)
        return self.add("IfcRevolvedAreaSolid", SweptArea=profile, Position=position, Axis=axis, Angle=rounded(angle, ANGLE_DIGITS))

    def tapered(self, diameter: float, end_diameter: float, wall: float | None, length: float, offset: float) -> Any:
        """Return a cone along z whose other end is offset along x, hollow where there is a wall."""
        wide = self.ring(diameter, wall)
        narrow = self.add(
            wide.is_a(),
            ProfileType="AREA",
            Position=self.entities.axes_2d((_length(offset), 0.0)),
            Radius=_length(end_diameter / 2),
            **({} if wall is None else {"WallThickness": _length(wall)}),
        )
        return self.add(
            "IfcExtrudedAreaSolidTapered",
            SweptArea=wide,
            Position=self.entities.identity,
            ExtrudedDirection=self.entities.direction((0.0, 0.0, 1.0)),
            Depth=_length(length),
            EndSweptArea=narrow,
        )

    def clipped(self, solid: Any, point: Point, normal: Point) -> Any:
        """Return a swept solid without what lies on the side of a plane's normal, which is across y."""
        x, y, z = normal
        plane = self.add("IfcPlane", Position=self.entities.axes(point, (x, y, z), (z, y, -x)))
        half = self.add("IfcHalfSpaceSolid", BaseSurface=plane, AgreementFlag=False)
        return self.add("IfcBooleanClippingResult", Operator="DIFFERENCE", FirstOperand=solid, SecondOperand=half)

    def _bend(self, elbow: Elbow) -> Any:
        refuse_tight_bend(elbow)
        return self.bent(self.ring(elbow.outer_diameter, elbow.wall_thickness), elbow.bend_radius, bend_angle(elbow))

    def _flange(self, flange: Flange) -> list[Any]:
        outline = flange_outline(flange)  # refuses what makes no flange
        if flange.K is None or flange.L is None or flange.bolts is None:
            return [self.turned(outline)]
        bore, face = bore_radius(flange), raised_face(flange)
        voids = [self._circle(flange.L / 2, place) for place in bolt_places(flange.K, flange.bolts)]
        if bore:
            voids.append(self._circle(bore))
        plate = self.add("IfcArbitraryProfileDefWithVoids", ProfileType="AREA", OuterCurve=self._circle(flange.D / 2), InnerCurves=tuple(voids))
        front = face[1] if face else 0.0
        items = [self.extruded(plate, _length(flange.C - front), (0.0, 0.0, _length(front)))]
        if face:
            wall = face[0] - bore if bore else None
            items.append(self.extruded(self.ring(2 * face[0], wall), _length(front)))
        neck = neck_outline(flange)
        return [*items, self.turned(neck)] if neck else items

    def _reducer(self, reducer: Reducer, frame: Frame) -> Body:
        refuse_odd_reducer(reducer)
        if reducer.reducer_type == "concentric":
            return SWEPT, [self.turned(reducer_outline(reducer))]
        offset = float(local_point(frame, reducer.end)[0])
        return TAPERED, [self.tapered(reducer.outer_diameter, reducer.end_diameter, reducer.wall_thickness, reducer.length, offset)]

    def _tee(self, tee: Tee, frame: Frame) -> list[Any]:
        begin, end, branch_end = tee_axes(tee, frame)
        reach = math.hypot(*branch_end)
        along = tuple(rounded(value, ANGLE_DIGITS) for value in branch_end / reach)
        branch = {"along": along, "across": ALONG_Y}
        wall, start, length = tee.wall_thickness, (0.0, 0.0, _length(begin)), _length(end) - _length(begin)
        run = self.extruded(self.ring(tee.outer_diameter, wall), length, start)
        arm = self.extruded(self.ring(tee.branch_diameter, wall), _length(reach), **branch)
        if wall is None:
            return [self.boolean("UNION", run, arm)]
        passage = self.extruded(self.ring(tee.branch_diameter - 2 * wall, None), _length(reach) + OVER_MM, **branch)
        block = self.extruded(self.ring(tee.outer_diameter, None), length, start)
        return [self.boolean("DIFFERENCE", run, passage), self.boolean("DIFFERENCE", arm, block)]

    def boolean(self, operator: str, first: Any, second: Any) -> Any:
        """Return what an operation ("UNION", "DIFFERENCE") makes of two solids."""
        return self.add("IfcBooleanResult", Operator=operator, FirstOperand=first, SecondOperand=second)

    def _segments(self, count: int, arcs: Sequence[tuple[int, int, int]]) -> tuple[Any, ...]:
        """Return lines and arcs that close the outline; IFC counts from 1."""
        bends = {first: (first, middle, last) for first, middle, last in arcs}
        found: list[Any] = []
        at = 0
        indices: tuple[int, ...]
        while at < count:
            if at in bends:
                indices, kind = bends[at], "IfcArcIndex"
            else:
                indices, kind = (at, at + 1), "IfcLineIndex"
            found.append(self.entities.file.create_entity(kind, tuple(index % count + 1 for index in indices)))
            at = indices[-1]
        return tuple(found)

    def _axis(self, location: Point) -> Any:
        """Return an axis of revolution along y, in the profile's plane."""
        return self.add("IfcAxis1Placement", Location=self.entities.point(location), Axis=self.entities.direction(ALONG_Y))

    def _circle(self, radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> Any:
        return self.add("IfcCircle", Position=self.entities.axes_2d(centre), Radius=_length(radius))


def _cap_outline(cap: Cap) -> tuple[Outline, list[tuple[int, int, int]]]:
    """Return a cap's half section and which of its points are joined by arcs: ellipsoidal heads, the inner one smaller by the wall."""
    refuse_thick_wall(cap)
    height, radius, wall = dish_height(cap), cap.outer_diameter / 2, cap.wall_thickness
    straight = cap.length - height
    turns = [math.pi / 2 * step / (2 * ARCS) for step in range(2 * ARCS + 1)]
    outer = [(radius * math.cos(turn), straight + height * math.sin(turn)) for turn in turns]
    arcs: list[tuple[int, int, int]] = []
    outline: Outline = []

    def follow(points: Outline) -> None:
        arcs.extend((len(outline) + step, len(outline) + step + 1, len(outline) + step + 2) for step in range(0, 2 * ARCS, 2))
        outline.extend(points)

    if straight > 10**-LENGTH_DIGITS:
        outline.append((radius, 0.0))
    follow(outer)
    if wall is None:
        return [*outline, (0.0, 0.0)], arcs
    follow([((radius - wall) * math.cos(turn), straight + (height - wall) * math.sin(turn)) for turn in reversed(turns)])
    if straight > 10**-LENGTH_DIGITS:
        outline.append((radius - wall, 0.0))
    return outline, arcs


def _length(value: float) -> float:
    return rounded(value, LENGTH_DIGITS)
