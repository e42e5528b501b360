# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation of components in IFC: coverings that are parts of them, as a plan has them or as components say themselves.

A covering has a type for what it is built of: layers and jacket as an IfcMaterialLayerSet from the inside to the outside, with
Pset_CoveringCommon and, as properties, each layer's and the jacket's material and thickness. Its body has at least one item for each of them,
coloured by its material. It is a part of the component it lies around; a box over several is one of the first, and names all.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_covering_shapes import covering_items
from pipeworkbench.exports.ifc_file import ORIGIN, Entities, label, rounded
from pipeworkbench.exports.ifc_properties import LABEL, LENGTH, NUMBER, Q_AREA, Q_LENGTH, Properties, Quantities
from pipeworkbench.exports.ifc_shapes import ALONG_Y, SOLID, SWEPT, Body, Shapes
from pipeworkbench.exports.ifc_spatial import MapPlace
from pipeworkbench.exports.insulated import insulation_of
from pipeworkbench.exports.kinds import INSULATION_COLOUR, material_colour
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids import Frame
from pipeworkbench.solids.covering_quantities import axis_length, layer_volumes, outer_area
from pipeworkbench.solids.coverings import AnyCovering, BendCovering, BoxCovering, Layer, StopCovering
from pipeworkbench.solids.frames import bend_angle, local_point

if TYPE_CHECKING:
    from pipeworkbench.exports.ifc_types import Types
    from pipeworkbench.insulation.planning import Piece, Plan

QUANTITIES, PROPERTIES = "Qto_CoveringBaseQuantities", "PipeWorkbench_Insulation"
VOLUME = "IfcVolumeMeasure"
M3_PER_MM3 = 1e-9


@dataclass(frozen=True)
class Planned:
    """The pieces of a plan by the component they lie around, and the 4 x 4 motion from its coordinates to the file's."""

    pieces: dict[str, list[Piece]]
    motion: np.ndarray[Any, np.dtype[np.float64]]


def planned_coverings(plan: Plan | None, place: MapPlace | None) -> Planned | None:
    """Return a plan's pieces for a file that lies at a place on the map; None without a plan.

    Raises
    ------
    InputError
        Where two coverings have the same id: their GlobalIds derive from it.
    """
    if plan is None:
        return None
    pieces: dict[str, list[Piece]] = {}
    seen: set[str] = set()
    for piece in plan.pieces:
        name = piece.covering.id
        if name in seen:
            raise InputError(plan.pipeline.frame, "pieces", f"two coverings are called '{name}'", "give each covering its own id")
        seen.add(name)
        pieces.setdefault(piece.covering.component, []).append(piece)
    motion = None if place is None else place.file_from_pipeline
    return Planned(pieces, np.eye(4) if motion is None else np.array(motion))


class Coverings:
    """Adds the coverings of components to one IFC file: planned ones, or what components say where there is no plan."""

    def __init__(self, entities: Entities, shapes: Shapes, types: Types, planned: Planned | None) -> None:
        self.entities, self.shapes, self.types, self.planned = entities, shapes, types, planned

    def of(self, component: AnyComponent, product: Any, frame: Frame, name: str) -> None:
        """Add the coverings of a component, called by a name, as parts of its product."""
        if self.planned is None:
            layer = insulation_of(component)
            made = [] if layer is None else [self._own(component, product, layer, frame, name)]
        else:
            made = [self._planned(piece, product, frame, name, self.planned.motion) for piece in self.planned.pieces.get(component.id, ())]
        if made:
            self.entities.relate("IfcRelAggregates", component.id, "RelatingObject", "RelatedObjects", product, made)

    def _own(self, component: AnyComponent, product: Any, layer: Layer, frame: Frame, name: str) -> Any:
        """Add what a component says it is insulated with."""
        body = _own_body(self.shapes, component, layer, frame)
        self.types.coloured(body[1], "insulation", INSULATION_COLOUR)
        typed = self.types.covering((layer,), None)
        placement = self.entities.identity
        made = self._covering(component.id, product, placement, body, Name=label(f"{name} insulation"), Tag=label(component.id))
        typed.occurrences.append(made)
        self._describe(made, component.id, _own_quantities(component, layer))
        return made

    def _planned(self, piece: Piece, product: Any, frame: Frame, name: str, motion: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
        """Add a covering of a plan."""
        covering = piece.covering
        kind, items = covering_items(self.shapes, covering)
        for number, item in items:
            is_jacket = number == len(covering.layers)
            material = covering.sheet.material if is_jacket and covering.sheet else covering.layers[number].material
            self.types.coloured([item], material, material_colour(material, jacket=is_jacket))
        typed = self.types.covering(covering.layers, covering.sheet, is_planned=True)
        placement = self._placed(np.array(frame.inverse) @ motion @ np.array(covering.frame.matrix))
        body: Body = kind, [item for _, item in items]
        made = self._covering(covering.id, product, placement, body, Name=label(f"{name} {_what(covering)}"), Tag=label(covering.id))
        typed.occurrences.append(made)
        self._describe(made, covering.id, _planned_quantities(covering))
        key = f"{covering.id}/{PROPERTIES}"
        self.entities.describe(made, key, self.types.property_set(key, PROPERTIES, _planned_properties(piece)))
        return made

    def _covering(self, key: str, product: Any, axes: Any, body: Body, **attributes: Any) -> Any:
        """Add an IfcCovering at a place in the axes of the product it belongs to."""
        placement = self.entities.add("IfcLocalPlacement", PlacementRelTo=product.ObjectPlacement, RelativePlacement=axes)
        representation = self.entities.add("IfcProductDefinitionShape", Representations=(self.types.shape(*body),))
        return self.entities.root("IfcCovering", key, ObjectPlacement=placement, Representation=representation, **attributes)

    def _describe(self, made: Any, name: str, found: Quantities) -> None:
        key = f"{name}/{QUANTITIES}"
        self.entities.describe(made, key, self.entities.quantity_set(key, QUANTITIES, found))

    def _placed(self, matrix: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
        """Return the axes that a 4 x 4 motion moves the origin's to."""
        return self.entities.axes(matrix[:3, 3].tolist(), matrix[:3, 2].tolist(), matrix[:3, 0].tolist())


def _what(covering: AnyCovering) -> str:
    match covering:
        case BoxCovering():
            return "insulation box"
        case StopCovering():
            return "insulation stop"
        case _:
            return "insulation"


def _planned_quantities(covering: AnyCovering) -> Quantities:
    """Return thickness and outer area; the net area where nothing is cut out."""
    area = rounded(outer_area(covering) * 1e-6, 9)
    found: Quantities = {"Width": (Q_LENGTH, rounded(covering.total_thickness)), "GrossArea": (Q_AREA, area)}
    return found if covering.notches else found | {"NetArea": (Q_AREA, area)}


def _planned_properties(piece: Piece) -> Properties:
    """Return what a covering is: its run, what it goes over, how it is built, how much it takes of every layer before notches are cut."""
    covering = piece.covering
    over: Sequence[str] = covering.components if isinstance(covering, BoxCovering) else ()
    said: Properties = {"Run": (LABEL, piece.run), "Kind": (LABEL, covering.kind), "Components": (LABEL, ", ".join(over or (covering.component,)))}
    if isinstance(covering, BendCovering) and covering.gores:
        said["NumberOfGores"] = NUMBER, covering.gores
    if length := axis_length(covering):
        said["AxisLength"] = LENGTH, rounded(length, 3)
    for number, volume in enumerate(layer_volumes(covering), 1):
        name = f"Layer{number}Volume" if number <= len(covering.layers) else "JacketVolume"
        said[name] = VOLUME, rounded(volume * M3_PER_MM3, 12)
    causes = dict.fromkeys(notch.cause for notch in covering.notches)
    return said | ({"CutFor": (LABEL, ", ".join(causes))} if causes else {})


def _own_body(shapes: Shapes, component: AnyComponent, insulation: Layer, frame: Frame) -> Body:
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


def _own_quantities(component: AnyComponent, insulation: Layer) -> Quantities:
    """Return the base quantities of a component's insulation: its thickness and, of pipes and elbows, its outer surface."""
    found: Quantities = {"Width": (Q_LENGTH, rounded(insulation.thickness))}
    if isinstance(component, Pipe | Elbow):
        area = rounded(math.pi * (component.outer_diameter + 2 * insulation.thickness) * component.length * 1e-6, 9)
        found |= {"GrossArea": (Q_AREA, area), "NetArea": (Q_AREA, area)}
    return found
