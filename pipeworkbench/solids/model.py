# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids of components, made with CadQuery in the component's own axes (``frames``) and put in place."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids.frames import Frame, bend_angle, frame_of, local_point
from pipeworkbench.solids.modelling import location, modeller, one_solid, turned
from pipeworkbench.solids.outlines import (
    ACROSS_FLATS,
    GASKET_MM,
    HEAD_HEIGHT,
    NUT_HEIGHT,
    PROTRUSION,
    bolt_diameter,
    dish_height,
    flange_outline,
    reducer_outline,
    refuse_odd_reducer,
    refuse_thick_wall,
    refuse_tight_bend,
    tee_axes,
)

if TYPE_CHECKING:
    import cadquery


def component_solid(component: AnyComponent) -> cadquery.Solid:
    """Return a component's solid in the pipeline's frame (mm).

    Raises
    ------
    InputError
        Where the component's dimensions make no solid; names the component.
    """
    frame = frame_of(component)
    return local_solid(component, frame).located(location(frame))


def local_solid(component: AnyComponent, frame: Frame | None = None) -> cadquery.Solid:
    """Return a component's solid in its own axes (mm), which ``frame_of`` places.

    Raises
    ------
    InputError
        Where the component's dimensions make no solid; names the component.
    """
    match component:
        case Pipe():
            return straight_pipe(component.outer_diameter, component.wall_thickness, component.length)
        case Elbow():
            solid = _elbow(component)
        case Flange():
            solid = _flange(component)
        case Tee():
            solid = _tee(component, frame or frame_of(component))
        case Reducer():
            solid = _reducer(component, frame or frame_of(component))
        case Cap():
            solid = _cap(component)
    if not (solid.isValid() and solid.Volume() > 0):
        raise InputError(component.id, "", f"these dimensions make no {component.kind}", "correct the component's dimensions")
    return solid


def straight_pipe(outer_diameter: float, wall_thickness: float | None, length: float) -> cadquery.Solid:
    """Return a pipe from the origin along +z (mm); massive where the wall thickness is not known.

    Raises
    ------
    InputError
        Where the dimensions do not make a pipe.
    """
    if not all(math.isfinite(x) and x > 0 for x in (outer_diameter, length)):
        raise InputError("pipe", "", f"diameter {outer_diameter:g} mm and length {length:g} mm make no pipe", "give positive dimensions")
    make = modeller().Solid.makeCylinder
    body = make(outer_diameter / 2, length)
    if not wall_thickness:
        return body
    inner_radius = outer_diameter / 2 - wall_thickness
    if not (math.isfinite(wall_thickness) and wall_thickness > 0 and inner_radius > 0):
        raise InputError("pipe", "wall_thickness", f"{wall_thickness:g} mm does not fit into {outer_diameter:g} mm", "give less than the radius")
    return one_solid(body.cut(make(inner_radius, length)))


def flange_bolts(flange: Flange, grip: float | None = None) -> cadquery.Compound | None:
    """Return a flange's bolts in its own axes: hexagon heads behind its back, nuts behind its partner's.

    Parameters
    ----------
    flange : Flange
    grip : float
        From this flange's back to its partner's in mm; where it is not given, two equal flanges with a gasket.

    Returns
    -------
    Compound or None
        None where bolt circle, hole or number are not known.
    """
    if flange.K is None or flange.L is None or flange.bolts is None:
        return None
    cq = modeller()
    diameter = bolt_diameter(flange)
    grip = 2 * flange.C + GASKET_MM if grip is None else grip
    back, front = flange.C, flange.C - grip
    corners = ACROSS_FLATS * diameter * 2 / math.sqrt(3)

    def along_z(bottom: float) -> Any:
        return cq.Workplane("XY", origin=(0, 0, bottom))

    bolt = (
        along_z(front - (NUT_HEIGHT + PROTRUSION) * diameter)
        .circle(diameter / 2)
        .extrude(grip + (NUT_HEIGHT + PROTRUSION) * diameter)
        .union(along_z(back).polygon(6, corners).extrude(HEAD_HEIGHT * diameter))
        .union(along_z(front - NUT_HEIGHT * diameter).polygon(6, corners).extrude(NUT_HEIGHT * diameter))
        .val()
    )
    solids = [one_solid(bolt.located(cq.Location(cq.Vector(x, y, 0)))) for x, y in bolt_places(flange.K, flange.bolts)]
    return cq.Compound.makeCompound(solids)


def bolt_places(bolt_circle: float, count: int) -> list[tuple[float, float]]:
    """Return where bolts stand across a flange's axis (mm): equally spaced, none on the x axis, which is the vertical (EN 1092-1)."""
    turns = [2 * math.pi * (number + 0.5) / count for number in range(count)]
    return [(bolt_circle / 2 * math.cos(turn), bolt_circle / 2 * math.sin(turn)) for turn in turns]


def brep_text(shape: cadquery.Shape) -> str:
    """Return a shape in Open CASCADE's BREP format, which FreeCAD reads in no time."""
    buffer = io.BytesIO()
    shape.exportBrep(buffer)
    return buffer.getvalue().decode("ascii")


def _elbow(elbow: Elbow) -> Any:
    radius = elbow.outer_diameter / 2
    refuse_tight_bend(elbow)
    section = modeller().Workplane("XY").circle(radius)
    if elbow.wall_thickness is not None:
        section = section.circle(radius - elbow.wall_thickness)
    # about an axis along +y beside the start: z turns towards x
    return section.revolve(math.degrees(bend_angle(elbow)), (elbow.bend_radius, 0, 0), (elbow.bend_radius, 1, 0)).val()


def _flange(flange: Flange) -> Any:
    body = turned(flange_outline(flange)).solid
    if flange.K is None or flange.L is None or flange.bolts is None:
        return body
    cq = modeller()
    holes = [cq.Solid.makeCylinder(flange.L / 2, flange.C, cq.Vector(x, y, 0)) for x, y in bolt_places(flange.K, flange.bolts)]
    return one_solid(body.cut(*holes))


def _tee(tee: Tee, frame: Frame) -> Any:
    """Return run and branch as one body: where the branch is set on, the run cuts it just as well."""
    cq = modeller()
    begin, end, branch_end = tee_axes(tee, frame)
    reach, direction = math.hypot(*branch_end), cq.Vector(*branch_end.tolist())

    def body(inwards: float) -> Any:
        run = cq.Solid.makeCylinder(tee.outer_diameter / 2 - inwards, end - begin, cq.Vector(0, 0, begin))
        return run.fuse(cq.Solid.makeCylinder(tee.branch_diameter / 2 - inwards, reach, cq.Vector(), direction)).clean()

    if tee.wall_thickness is None:
        return one_solid(body(0))
    return one_solid(body(0).cut(body(tee.wall_thickness)))


def _reducer(reducer: Reducer, frame: Frame) -> Any:
    refuse_odd_reducer(reducer)
    offset = float(local_point(frame, reducer.end)[0])
    if reducer.reducer_type == "concentric":
        return turned(reducer_outline(reducer)).solid
    cq = modeller()

    def body(inwards: float) -> Any:
        up = cq.Vector(0, 0, 1)
        wide = cq.Wire.makeCircle(reducer.outer_diameter / 2 - inwards, cq.Vector(), up)
        narrow = cq.Wire.makeCircle(reducer.end_diameter / 2 - inwards, cq.Vector(offset, 0, reducer.length), up)
        return cq.Solid.makeLoft([wide, narrow], ruled=True)

    if reducer.wall_thickness is None:
        return body(0)
    return one_solid(body(0).cut(body(reducer.wall_thickness)))


def _cap(cap: Cap) -> Any:
    """Return a cylinder with an ellipsoidal head; the inner head's half axes are shorter than the outer one's by the wall."""
    refuse_thick_wall(cap)
    cq = modeller()
    height, radius = dish_height(cap), cap.outer_diameter / 2
    straight = cap.length - height
    wall = cap.wall_thickness

    def arc(inwards: float) -> Any:
        # in the x, z plane between the top and the widest point; about -y the same arc makes a face that STEP loses
        return cq.Edge.makeEllipse(radius - inwards, height - inwards, (0, 0, straight), (0, 1, 0), (1, 0, 0), 270, 360)

    def line(start: tuple[float, float], end: tuple[float, float]) -> list[Any]:
        return [] if start == end else [cq.Edge.makeLine(cq.Vector(start[0], 0, start[1]), cq.Vector(end[0], 0, end[1]))]

    inner_radius, inner_top = (0.0, 0.0) if wall is None else (radius - wall, cap.length - wall)
    edges = [*line((inner_radius, 0), (radius, 0)), *line((radius, 0), (radius, straight)), arc(0), *line((0, cap.length), (0, inner_top))]
    if wall is not None:
        edges += [arc(wall), *line((inner_radius, straight), (inner_radius, 0))]
    section = cq.Wire.assembleEdges(edges)
    return cq.Solid.revolve(section, [], 360, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))
