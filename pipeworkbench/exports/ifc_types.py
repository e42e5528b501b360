# SPDX-License-Identifier: LGPL-2.1-or-later
"""The types of an IFC file's components: one for each distinct dimension, with its shared body, material, colour and properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pipeworkbench.exports.ifc_coverings import Insulation
from pipeworkbench.exports.ifc_file import Entities, digest, label, rounded
from pipeworkbench.exports.ifc_properties import Properties, material_of, type_sets
from pipeworkbench.exports.ifc_shapes import ANGLE_DIGITS, LENGTH_DIGITS, Body, Shapes
from pipeworkbench.exports.kinds import COLOURS, INSULATION_COLOUR, designation
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee, free_id
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import bend_angle, local_point


@dataclass
class Typed:
    """A type in the file: what it is told by, its entity, its body for fittings to map, and what is of it."""

    key: str
    entity: Any
    mapped: Any | None = None
    occurrences: list[Any] = field(default_factory=list)


class Types:
    """Makes types where components ask for them."""

    def __init__(self, entities: Entities, shapes: Shapes, context: Any) -> None:
        self.entities, self.shapes, self.context = entities, shapes, context
        self.as_it_is = entities.add("IfcCartesianTransformationOperator3D", LocalOrigin=entities.origin)
        self._types: dict[tuple[Any, ...], Typed] = {}
        self._names: set[str] = set()
        self._materials: dict[str, tuple[Any, list[Any]]] = {}

    def of(self, component: AnyComponent, frame: Frame) -> Typed:
        """Return a component's type."""
        key = type_key(component, frame)
        if key not in self._types:
            self._types[key] = self._make(component, frame, digest(key))
        return self._types[key]

    def covering(self, insulation: Insulation) -> Typed:
        """Return the type of a layer of insulation."""
        key = "insulation", rounded(insulation.thickness), insulation.material
        if key not in self._types:
            name = self._name(f"Insulation {insulation.thickness:g} mm, {insulation.material}")
            identity = digest(key)
            entity = self.entities.root("IfcCoveringType", identity, Name=label(name), PredefinedType="INSULATION")
            material = self._material(insulation.material)[0]
            layer = self.entities.add("IfcMaterialLayer", Material=material, LayerThickness=rounded(insulation.thickness))
            layers = self.entities.add("IfcMaterialLayerSet", MaterialLayers=(layer,), LayerSetName=label(name))
            self.entities.relate("IfcRelAssociatesMaterial", identity, "RelatingMaterial", "RelatedObjects", layers, [entity])
            self._types[key] = Typed(identity, entity)
        return self._types[key]

    def relate(self) -> None:
        """Relate types to what is of them, and materials to types; to be called once, after all components."""
        for typed in self._types.values():
            self.entities.relate("IfcRelDefinesByType", typed.key, "RelatingType", "RelatedObjects", typed.entity, typed.occurrences)
        for name, (material, types) in self._materials.items():
            if types:
                self.entities.relate("IfcRelAssociatesMaterial", f"material/{name}", "RelatingMaterial", "RelatedObjects", material, types)

    def property_set(self, key: str, name: str, properties: Mapping[str, tuple[str, Any]]) -> Any:
        """Return a new property set."""
        made = tuple(self.entities.property_value(title, kind, value) for title, (kind, value) in properties.items())
        return self.entities.root("IfcPropertySet", key, Name=name, HasProperties=made)

    def shared_set(self, name: str, properties: Properties) -> Any:
        """Return a property set that whatever has just these properties shares."""
        key = f"{name}/{digest(properties)}"
        return self.entities.once(key, lambda: self.property_set(key, name, properties))

    def shape(self, kind: str, items: Sequence[Any]) -> Any:
        """Return a body's representation."""
        return self.entities.add(
            "IfcShapeRepresentation", ContextOfItems=self.context, RepresentationIdentifier="Body", RepresentationType=kind, Items=tuple(items)
        )

    def styled(self, body: Body, kind: type[AnyComponent | Insulation]) -> Body:
        """Give a body's items the colour of a kind of components; return the body."""
        for item in body[1]:
            self.entities.add("IfcStyledItem", Item=item, Styles=(self._style(kind),))
        return body

    def _make(self, component: AnyComponent, frame: Frame, key: str) -> Typed:
        mapped = None
        if not isinstance(component, Pipe):
            body = self.styled(self.shapes.body(component, frame), type(component))
            mapped = self.entities.add("IfcRepresentationMap", MappingOrigin=self.entities.identity, MappedRepresentation=self.shape(*body))
        sets: dict[str, Properties] = type_sets(component, self.entities.schema)
        entity = self.entities.root(
            "IfcPipeSegmentType" if isinstance(component, Pipe) else "IfcPipeFittingType",
            key,
            Name=label(self._name(type_name(component))),
            HasPropertySets=tuple(self.shared_set(name, properties) for name, properties in sets.items()),
            RepresentationMaps=None if mapped is None else (mapped,),
            ElementType="FLANGE" if isinstance(component, Flange) else None,
            PredefinedType=predefined_type(component),
        )
        self._material(material_of(component))[1].append(entity)
        return Typed(key, entity, mapped)

    def _name(self, wished: str) -> str:
        """Return a type's name, which no other has."""
        name = free_id(wished, self._names)
        self._names.add(name)
        return name

    def _material(self, name: str) -> tuple[Any, list[Any]]:
        if name not in self._materials:
            self._materials[name] = self.entities.add("IfcMaterial", Name=label(name)), []
        return self._materials[name]

    def _style(self, kind: type[AnyComponent | Insulation]) -> Any:
        """Return the surface style of a kind of components, which all of that kind share."""

        def make() -> Any:
            red, green, blue = INSULATION_COLOUR if issubclass(kind, Insulation) else COLOURS[kind]
            colour = self.entities.add("IfcColourRgb", Red=red, Green=green, Blue=blue)
            shading = self.entities.add("IfcSurfaceStyleShading", SurfaceColour=colour, Transparency=0.0)
            name = "insulation" if issubclass(kind, Insulation) else kind.kind
            return self.entities.add("IfcSurfaceStyle", Name=name, Side="BOTH", Styles=(shading,))

        return self.entities.once(("style", kind), make)


def type_key(component: AnyComponent, frame: Frame) -> tuple[Any, ...]:
    """Return what components of one type agree in: their dimensions, rounded as bodies are, standard and material."""
    dimensions: list[float | str | None]
    match component:
        case Pipe():
            dimensions = []
        case Elbow():
            dimensions = [_length(component.bend_radius), rounded(bend_angle(component), ANGLE_DIGITS), component.bend_type]
        case Flange():
            letters = (component.D, component.C, component.length, component.K, component.L, component.bolts, component.neck_diameter)
            face = (component.raised_face_diameter, component.raised_face_height, component.neck_straight, component.pn)
            dimensions = [component.flange_type, *map(_length, (*letters, *face)), repr(component.equivalents)]
        case Tee():
            ends = [value for point in (component.start, component.end, component.branch_end) for value in local_point(frame, point)]
            dimensions = [component.tee_type, _length(component.branch_diameter), *map(_length, ends)]
        case Reducer():
            offset = float(local_point(frame, component.end)[0])
            dimensions = [component.reducer_type, *map(_length, (component.end_diameter, component.length, offset))]
        case Cap():
            dimensions = [_length(component.length)]
    size = _length(component.outer_diameter), _length(component.wall_thickness), component.dn
    return component.kind, *size, component.standard, material_of(component), *dimensions


def type_name(component: AnyComponent) -> str:
    """Return what a type is called, such as ``Pipe DN 40, wall 2.6 mm``."""
    wall = component.wall_thickness
    return designation(component) if wall is None else f"{designation(component)}, wall {wall:g} mm"


def predefined_type(component: AnyComponent) -> str:
    """Return the value of IfcPipeSegmentTypeEnum or IfcPipeFittingTypeEnum that says what a component does."""
    match component:
        case Pipe():
            return "RIGIDSEGMENT"
        case Elbow():
            return "BEND"
        case Tee():
            return "JUNCTION"
        case Reducer():
            return "TRANSITION"
        case Flange():
            return "OBSTRUCTION" if component.flange_type == BLIND_FLANGE else "CONNECTOR"
        case Cap():
            return "OBSTRUCTION"


def _length(value: float | None) -> float | None:
    return None if value is None else rounded(value, LENGTH_DIGITS)
