# SPDX-License-Identifier: LGPL-2.1-or-later
"""What solids are made of and placed with: CadQuery, imported late, and bodies whose faces have names."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.solids.frames import Frame
from pipeworkbench.solids.outlines import Outline

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

SEWING_MM = 1e-5  # edges nearer than this are the same; those of neighbouring faces are made to coincide


def modeller() -> Any:
    """Import CadQuery late: it takes seconds and only some steps need it.

    Raises
    ------
    MissingPackageError
    """
    try:
        import cadquery
    except ImportError:
        raise MissingPackageError("CadQuery", "Making solids", "pip install 'cadquery>=2.4,<2.9'") from None
    return cadquery


def location(frame: Frame) -> Any:
    """Return the motion (Location) from a component's own axes to the pipeline's frame."""
    cq = modeller()
    return cq.Location(cq.Plane(origin=tuple(frame.origin.tolist()), xDir=tuple(frame.x.tolist()), normal=tuple(frame.z.tolist())))


def one_solid(shape: Any) -> Any:
    """Return the one solid of a shape that an operation packed into a compound."""
    solids = shape.Solids()
    if len(solids) != 1:
        raise InputError("solid", "", f"the dimensions give {len(solids)} pieces instead of one", "correct the dimensions")
    return solids[0]


class NotClosedError(ValueError):
    """Faces do not go together to a closed body."""


@dataclass(frozen=True, eq=False)
class NamedSolid:
    """A solid and its faces by name, oriented as the solid has them: their normals point out of it."""

    solid: Any
    faces: dict[str, list[Any]]

    @classmethod
    def of(cls, solid: Any, named: Iterable[tuple[str, Any]]) -> NamedSolid:
        """Look up in a solid the faces that are the same as the named ones."""
        groups: dict[str, list[Any]] = {}
        for name, face in named:
            groups.setdefault(name, []).append(face)
        own = solid.Faces()
        faces = {name: [face for face in own if any(face.isSame(wanted) for wanted in group)] for name, group in groups.items()}
        return cls(solid, {name: found for name, found in faces.items() if found})


@dataclass(frozen=True, eq=False)
class Skin:
    """An open surface: its ``faces`` and by name its ``rims``, closed plane edges. Between two of them lies a body."""

    faces: list[Any]
    rims: dict[str, Any]


def axes(origin: Sequence[float], z: Sequence[float], x: Sequence[float]) -> Any:
    """Return right-handed axes of Open CASCADE from a point (mm) and the directions z and x."""
    modeller()
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    return gp_Ax2(gp_Pnt(*origin), gp_Dir(*z), gp_Dir(*x))


def circle(place: Any, radius: float) -> Any:
    """Return a circle (Edge) about the z axis of ``axes``, which begins on their x axis."""
    cq = modeller()
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Circ

    return cq.Edge(BRepBuilderAPI_MakeEdge(gp_Circ(place, radius)).Edge())


def prism(edge: Any, direction: Sequence[float], length: float) -> Any:
    """Return the face that an edge sweeps along a unit direction (mm)."""
    cq = modeller()
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.gp import gp_Vec

    return cq.Face(BRepPrimAPI_MakePrism(edge.wrapped, gp_Vec(*(length * x for x in direction))).Shape())


def turned(outline: Outline, names: Sequence[str] = (), start: float = 0.0, angle: float = 2 * math.pi) -> NamedSolid:
    """Return what an outline (radius, along the axis) makes about the z axis.

    Parameters
    ----------
    outline : list of (float, float)
        Corners of the half section, mm.
    names : sequence of str
        What each side makes, from a corner to the next; none where nobody asks for them.
    start, angle : float
        From where and how far it is turned, rad; the cut faces of less than a full turn are called "parting".
    """
    cq = modeller()
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

    corners = [cq.Vector(radius * math.cos(start), radius * math.sin(start), z) for radius, z in outline]
    sides = [cq.Edge.makeLine(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    section = cq.Face.makeFromWires(cq.Wire.assembleEdges(sides)).wrapped
    axis = gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
    revolution = BRepPrimAPI_MakeRevol(section, axis) if angle >= 2 * math.pi else BRepPrimAPI_MakeRevol(section, axis, angle)
    solid = cq.Solid(revolution.Shape())
    return NamedSolid.of(solid, [(_side_name(face, outline, names), face) for face in solid.Faces()] if names else [])


def _side_name(face: Any, outline: Outline, names: Sequence[str]) -> str:
    """Return the name of the side that made a turned face; Open CASCADE's own account lacks the plane ones."""
    places = [(math.hypot(vertex.X, vertex.Y), vertex.Z) for vertex in face.Vertices()]
    plane = face.geomType() == "PLANE"
    for name, a, b in zip(names, outline, [*outline[1:], outline[0]], strict=True):
        on_side = all(math.dist(a, place) + math.dist(place, b) < math.dist(a, b) + SEWING_MM for place in places)
        if on_side and plane == (a[1] == b[1]):
            return name
    return "parting"


def between(outer: Skin, inner: Skin, walls: Sequence[tuple[str, Any]] = ()) -> NamedSolid:
    """Return the body between two skins, closed by plane faces between their rims, which give them their names, and by ``walls``.

    Raises
    ------
    NotClosedError
    """
    cq = modeller()
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
    from OCP.BRepLib import BRepLib
    from OCP.TopAbs import TopAbs_ShapeEnum

    wire = cq.Wire.assembleEdges
    ends = [(name, cq.Face.makeFromWires(wire([rim]), [wire([inner.rims[name]])])) for name, rim in outer.rims.items()]
    named = [("outer", face) for face in outer.faces] + [("inner", face) for face in inner.faces] + ends + list(walls)
    sewing = BRepBuilderAPI_Sewing(SEWING_MM)
    for _, face in named:
        sewing.Add(face.wrapped)
    sewing.Perform()
    sewn = sewing.SewedShape()
    if sewn.ShapeType() != TopAbs_ShapeEnum.TopAbs_SHELL:
        raise NotClosedError
    solid = BRepBuilderAPI_MakeSolid(cq.Shell(sewn).wrapped).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    return NamedSolid.of(cq.Solid(solid), [(name, cq.Face(sewing.Modified(face.wrapped))) for name, face in named])


def cut(body: NamedSolid, tool: Any, name: str) -> list[NamedSolid]:
    """Return what is left of a body without a tool (Solid), piece by piece; the faces that the tool makes get a name."""
    cq = modeller()
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut

    operation = BRepAlgoAPI_Cut(body.solid.wrapped, tool.wrapped)
    left = cq.Shape.cast(operation.Shape())
    named = [(old, face) for old, faces in body.faces.items() for face in faces]
    kept = [(old, cq.Face(new)) for old, face in named for new in (list(operation.Modified(face.wrapped)) or [face.wrapped])]
    made = [(name, cq.Face(new)) for face in tool.Faces() for new in (list(operation.Modified(face.wrapped)) or [face.wrapped])]
    return [NamedSolid.of(solid, kept + made) for solid in left.Solids()]
