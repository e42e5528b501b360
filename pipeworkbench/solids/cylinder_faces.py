# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of cylinders between circles, mitres and the curves in which two cylinders meet.

They are put together from the curves' formulas: exact within 1e-6 mm and many times faster than general intersections, whose
curves also spoil the volumes that CAD programs compute. On a cylinder u is the angle about its z axis from its x axis and v the
length along z; a border goes around it once, from u = 0 to 2 pi.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.modelling import axes, modeller

# steps of a curve's parameter, rad: with them splines are within 1e-6 mm; fewer and higher pieces are checked much faster
MITRE_STEP, CROSSING_STEP = 0.5, 0.18
SPLINE_DEGREE = 9
BEYOND = 4  # steps that splines are made longer than needed, because they are less exact near their ends
EDGE_TOLERANCE_MM = 1e-5
SAME_RADIUS_MM = 1e-6  # cylinders whose radii differ by less meet in two ellipses

Way: TypeAlias = Callable[[Array], tuple[Array, Array]]  # from a curve's parameter to the angle p and the root, see ``crossing``


@dataclass(frozen=True, eq=False)
class Place:
    """A cylinder's axes: where v is 0 (mm) and the unit directions z and x, each (3,)."""

    origin: Array
    z: Array
    x: Array

    @property
    def y(self) -> Array:
        """The third axis (3,)."""
        return np.cross(self.z, self.x)

    def around(self, radius: float, u: Array, v: Array) -> Array:
        """Return the points (n, 3) of a cylinder at u (n,) and v (n,)."""
        across = np.cos(u)[:, None] * self.x + np.sin(u)[:, None] * self.y
        return self.origin + v[:, None] * self.z + radius * across

    @property
    def axes(self) -> Any:
        """The axes as Open CASCADE's."""
        return axes(self.origin.tolist(), self.z.tolist(), self.x.tolist())


@dataclass(frozen=True, eq=False)
class Border:
    """Edges that go around a cylinder one behind the other, each with its curve in the cylinder's u and v."""

    pieces: list[tuple[Any, Any]]
    start: float  # v at u = 0


@dataclass(frozen=True, eq=False)
class Crossing:
    """The closed curve in which a branch comes out of a run: as a border of the branch and as a hole in the run."""

    branch: Border
    run: Border


def square_border(place: Place, radius: float, v: float) -> Border:
    """Return the circle around a cylinder at a length along it (mm)."""
    modeller()
    from OCP.Geom import Geom_Circle
    from OCP.Geom2d import Geom2d_Line
    from OCP.gp import gp_Dir2d, gp_Pnt2d

    origin = place.origin + v * place.z
    curve = Geom_Circle(axes(origin.tolist(), place.z.tolist(), place.x.tolist()), radius)
    return Border([(_edge(curve, 0, 2 * math.pi), Geom2d_Line(gp_Pnt2d(0, v), gp_Dir2d(1, 0)))], v)


def mitre_border(place: Place, radius: float, v: float, slope: float) -> Border:
    """Return the ellipse in which the plane cuts a cylinder that meets its axis at v (mm) and rises by ``slope`` along x."""
    modeller()
    from OCP.Geom import Geom_Ellipse

    secant = math.hypot(1.0, slope)
    x, z = (place.x + slope * place.z) / secant, (place.z - slope * place.x) / secant
    ellipse_axes = axes((place.origin + v * place.z).tolist(), z.tolist(), x.tolist())
    # the major axis comes first: a plane across the cylinder's axis is drawn as a circle
    if secant == 1.0:
        return square_border(place, radius, v)
    flat = _spline(lambda u: np.column_stack([u, v + slope * radius * np.cos(u)]), 0, 2 * math.pi, MITRE_STEP)
    return Border([(_edge(Geom_Ellipse(ellipse_axes, radius * secant, radius), 0, 2 * math.pi), flat)], v + slope * radius)


def crossing(run: Place, radius: float, branch: Place, branch_radius: float) -> Crossing:
    """Return where a branch comes out of a run.

    Both axes meet in the origins; the branch's x lies in the plane of both and towards the run's z, the run's x away from the branch.
    With p around the branch at the angle a to the run, a point is (sqrt(r² - b² sin² p) + b cos p cos a) / sin a along it. For
    nearly equal radii this almost has corners; it is smooth over the elliptic argument w with p = am(w, b² / r²).
    """
    cosine, sine = float(branch.z @ run.z), float(branch.x @ run.z)

    def on_branch(turn: Array, root: Array) -> Array:
        return np.column_stack([turn, (root + branch_radius * np.cos(turn) * cosine) / sine])

    def in_space(turn: Array, root: Array) -> Array:
        return branch.around(branch_radius, *on_branch(turn, root).T)

    def on_run(turn: Array, root: Array) -> Array:
        return np.column_stack([math.pi - np.arctan2(branch_radius * np.sin(turn), root), (in_space(turn, root) - run.origin) @ run.z])

    def after(way: Way, place: Callable[[Array, Array], Array], parameter: Array) -> Array:
        return place(*way(parameter))

    edges: list[Any] = []
    flats: dict[str, list[Any]] = {"branch": [], "run": []}
    for start, end, way in _ways_around(radius, branch_radius):
        curve, flat, hole = (_spline(functools.partial(after, way, f), start, end, CROSSING_STEP) for f in (in_space, on_branch, on_run))
        edges.append(_edge(curve, start, end, edges))
        flats["branch"].append(flat)
        flats["run"].append(hole)
    seam = float(on_branch(np.zeros(1), np.array([radius]))[0, 1])
    return Crossing(*(Border(list(zip(edges, flats[name], strict=True)), seam) for name in ("branch", "run")))


def cylinder_face(place: Place, radius: float, low: Border, high: Border, holes: Sequence[Border] = ()) -> Any:
    """Return a cylinder's face (cadquery) between two borders, without holes, which go around counter-clockwise."""
    cq = modeller()
    from OCP.BRep import BRep_Builder
    from OCP.Geom import Geom_CylindricalSurface
    from OCP.Geom2d import Geom2d_Line
    from OCP.gp import gp_Ax3, gp_Dir2d, gp_Pnt2d
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Face, TopoDS_Wire

    build, surface, at = BRep_Builder(), Geom_CylindricalSurface(gp_Ax3(place.axes), radius), TopLoc_Location()
    seam = _seam(place, radius, low, high)
    sides = [Geom2d_Line(gp_Pnt2d(u, low.start), gp_Dir2d(0, 1)) for u in (2 * math.pi, 0.0)]
    build.UpdateEdge(seam, *sides, surface, at, EDGE_TOLERANCE_MM)
    for edge, flat in (piece for border in (low, high, *holes) for piece in border.pieces):
        build.UpdateEdge(edge, flat, surface, at, EDGE_TOLERANCE_MM)
    face = TopoDS_Face()
    build.MakeFace(face, surface, at, EDGE_TOLERANCE_MM)
    outline = [edge for edge, _ in low.pieces] + [seam] + [edge.Reversed() for edge, _ in reversed(high.pieces)] + [seam.Reversed()]
    for edges in (outline, *([edge.Reversed() for edge, _ in reversed(hole.pieces)] for hole in holes)):
        wire = TopoDS_Wire()
        build.MakeWire(wire)
        for edge in edges:
            build.Add(wire, edge)
        wire.Closed(True)
        build.Add(face, wire)
    return cq.Face(face)


def _ways_around(radius: float, branch_radius: float) -> Iterator[tuple[float, float, Way]]:
    """Yield smooth pieces of the way around a branch: the parameter's start and end, and what gives p and the root from it."""
    if radius - branch_radius <= SAME_RADIUS_MM:
        quarter = math.pi / 2
        yield 0.0, quarter, lambda p: (p, radius * np.cos(p))
        yield quarter, 3 * quarter, lambda p: (p, -radius * np.cos(p))
        yield 3 * quarter, 4 * quarter, lambda p: (p, radius * np.cos(p))
        return
    from scipy.special import ellipj, ellipkm1

    difference = (radius - branch_radius) * (radius + branch_radius)
    quarter = float(ellipkm1(difference / radius**2))

    def way(w: Array) -> tuple[Array, Array]:
        sine, cosine, _, _ = ellipj(w, 1 - difference / radius**2)
        turn = np.arctan2(sine, cosine)
        turn += 2 * math.pi * np.round((w / quarter * math.pi / 2 - turn) / (2 * math.pi))
        return turn, np.sqrt(difference + (branch_radius * cosine) ** 2)

    for first, last in ((0, 1), (1, 3), (3, 4)):
        yield first * quarter, last * quarter, way


def _seam(place: Place, radius: float, low: Border, high: Border) -> Any:
    """Return the straight edge at u = 0 between the first vertices of two borders."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.Geom import Geom_Line
    from OCP.gp import gp_Dir, gp_Pnt
    from OCP.TopExp import TopExp

    foot = place.origin + radius * place.x + low.start * place.z
    line = Geom_Line(gp_Pnt(*foot.tolist()), gp_Dir(*place.z.tolist()))
    first, last = (TopExp.FirstVertex_s(border.pieces[0][0]) for border in (low, high))
    return BRepBuilderAPI_MakeEdge(line, first, last, 0.0, high.start - low.start).Edge()


def _edge(curve: Any, start: float, end: float, before: Sequence[Any] = ()) -> Any:
    """Return the edge of a curve between two parameters; its ends are the vertices of those before that are in the same points."""
    from OCP.BRep import BRep_Builder, BRep_Tool
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex
    from OCP.TopExp import TopExp

    known = [vertex(edge) for edge in before for vertex in (TopExp.FirstVertex_s, TopExp.LastVertex_s)]
    ends = []
    for point in (curve.Value(start), curve.Value(end)):
        same = (vertex for vertex in known if BRep_Tool.Pnt_s(vertex).Distance(point) < EDGE_TOLERANCE_MM)
        ends.append(next(same, None) or BRepBuilderAPI_MakeVertex(point).Vertex())
        BRep_Builder().UpdateVertex(ends[-1], EDGE_TOLERANCE_MM)
        known.append(ends[-1])
    return BRepBuilderAPI_MakeEdge(curve, *ends, start, end).Edge()


def _spline(curve: Callable[[Array], Array], start: float, end: float, step: float) -> Any:
    """Return the spline of a curve, which gives points (n, 2) or (n, 3) for parameters (n,), also a little beyond its ends."""
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
    from scipy.interpolate import make_interp_spline

    steps = max(math.ceil((end - start) / step), 1)
    # the spline is longer than needed: it is less exact near its ends
    parameter = start + (end - start) / steps * np.arange(-BEYOND, steps + BEYOND + 1)
    spline = make_interp_spline(parameter, curve(parameter), k=SPLINE_DEGREE)
    knots, counts = np.unique(spline.t, return_counts=True)
    knot_array = TColStd_Array1OfReal(1, len(knots))
    count_array = TColStd_Array1OfInteger(1, len(knots))
    for index, (knot, count) in enumerate(zip(knots.tolist(), counts.tolist(), strict=True), start=1):
        knot_array.SetValue(index, knot)
        count_array.SetValue(index, count)
    if spline.c.shape[1] == 2:
        from OCP.Geom2d import Geom2d_BSplineCurve as Curve
        from OCP.gp import gp_Pnt2d as Point
        from OCP.TColgp import TColgp_Array1OfPnt2d as Points
    else:
        from OCP.Geom import Geom_BSplineCurve as Curve
        from OCP.gp import gp_Pnt as Point
        from OCP.TColgp import TColgp_Array1OfPnt as Points
    poles = Points(1, len(spline.c))
    for index, pole in enumerate(spline.c.tolist(), start=1):
        poles.SetValue(index, Point(*pole))
    made = Curve(poles, knot_array, count_array, SPLINE_DEGREE)
    made.Segment(start, end)
    return made
