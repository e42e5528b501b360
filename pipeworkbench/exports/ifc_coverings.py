# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation around components: thickness and material, and the body that lies around the component in its own axes."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_file import ORIGIN, rounded
from pipeworkbench.exports.ifc_properties import Q_AREA, Q_LENGTH, Quantities
from pipeworkbench.exports.ifc_shapes import ALONG_Y, SOLID, SWEPT, Body, Shapes
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import bend_angle, local_point

KEY = "insulation"


@dataclass(frozen=True)
class Insulation:
    """One layer: its thickness in mm and what it is made of."""

    thickness: float
    material: str


def insulation_of(component: AnyComponent) -> Insulation | None:
    """Return what a component is insulated with (``extra["insulation"]``), None where it is not.

    Raises
    ------
    InputError
        Where thickness or material do not fit.
    """
    said = component.extra.get(KEY)
    if said is None:
        return None
    thickness, material = (said.get("thickness"), said.get("material")) if isinstance(said, dict) else (None, None)
    if isinstance(thickness, bool) or not isinstance(thickness, int | float) or not (math.isfinite(thickness) and thickness > 0):
        raise InputError(component.id, f"{KEY}.thickness", f"is {thickness!r}", "give the layer's thickness in mm")
    if not isinstance(material, str) or not material:
        raise InputError(component.id, f"{KEY}.material", f"is {material!r}", "name the layer's material")
    return Insulation(float(thickness), material)


def covering_body(shapes: Shapes, component: AnyComponent, insulation: Insulation, frame: Frame) -> Body:
    """Return the insulation's body in the component's own axes; a flange and a cap get a box that is turned around them."""
    thick, outer = insulation.thickness, component.outer_diameter
    match component:
        case Flange():
            radius = component.D / 2
            box = [(radius, 0.0), (radius + thick, 0.0), (radius + thick, component.length), (radius, component.length)]
            return SWEPT, [shapes.turned(box)]
        case Cap():
            radius, top = outer / 2, component.length
            box = [(radius, 0.0), (radius + thick, 0.0), (radius + thick, top + thick), (0.0, top + thick), (0.0, top), (radius, top)]
            return SWEPT, [shapes.turned(box)]
        case Elbow() if component.bend_radius <= outer / 2 + thick:
            return SWEPT, _mitred(shapes, component, thick)
        case Tee() if local_point(frame, component.branch_end)[0] <= outer / 2 + thick:
            return SOLID, [_pierced(shapes, component, thick, frame)]
    grown: AnyComponent = dataclasses.replace(component, outer_diameter=outer + 2 * thick, wall_thickness=None)
    if isinstance(grown, Reducer):
        grown = dataclasses.replace(grown, end_diameter=grown.end_diameter + 2 * thick)
    elif isinstance(grown, Tee):
        grown = dataclasses.replace(grown, branch_diameter=grown.branch_diameter + 2 * thick)
    return shapes.body(dataclasses.replace(grown, wall_thickness=thick), frame)


def _mitred(shapes: Shapes, elbow: Elbow, thick: float) -> list[Any]:
    """Return two straight shells along an elbow's tangents, where a layer does not fit into the bend."""
    angle = bend_angle(elbow)
    tangent, ring = elbow.bend_radius * math.tan(angle / 2), shapes.ring(elbow.outer_diameter + 2 * thick, thick)
    along, across = (math.sin(angle), 0.0, math.cos(angle)), (math.cos(angle), 0.0, -math.sin(angle))
    return [shapes.extruded(ring, tangent), shapes.extruded(ring, tangent, (0.0, 0.0, tangent), along, across)]


def _pierced(shapes: Shapes, tee: Tee, thick: float, frame: Frame) -> Any:
    """Return the run's shell with a hole for the branch, where the branch ends inside it."""
    begin, end = (float(local_point(frame, point)[2]) for point in (tee.start, tee.end))
    branch = local_point(frame, tee.branch_end)
    reach = math.hypot(*branch)
    shell = shapes.extruded(shapes.ring(tee.outer_diameter + 2 * thick, thick), end - begin, (0.0, 0.0, begin))
    hole = shapes.extruded(shapes.ring(tee.branch_diameter, None), tee.outer_diameter + reach + 2 * thick, ORIGIN, (branch / reach).tolist(), ALONG_Y)
    return shapes.boolean("DIFFERENCE", shell, hole)


def covering_quantities(component: AnyComponent, insulation: Insulation) -> Quantities:
    """Return the base quantities of a component's insulation: its thickness and, of pipes and elbows, its outer surface."""
    found: Quantities = {"Width": (Q_LENGTH, rounded(insulation.thickness))}
    if isinstance(component, Pipe | Elbow):
        area = rounded(math.pi * (component.outer_diameter + 2 * insulation.thickness) * component.length * 1e-6, 9)
        found |= {"GrossArea": (Q_AREA, area), "NetArea": (Q_AREA, area)}
    return found
