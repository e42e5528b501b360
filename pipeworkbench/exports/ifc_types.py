# SPDX-License-Identifier: LGPL-2.1-or-later
"""The types of an IFC file's components: one for each distinct dimension, with its shared body, material, colour and properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pipeworkbench.exports.ifc_file import ENUMERATED, Entities, digest, label, rounded
from pipeworkbench.exports.ifc_properties import LABEL, LENGTH, NUMBER, Properties, material_of, type_sets
from pipeworkbench.exports.ifc_shapes import ANGLE_DIGITS, LENGTH_DIGITS, Body, Shapes
from pipeworkbench.exports.kinds import COLOURS, Colour, designation
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee, free_id
from pipeworkbench.solids import Frame
from pipeworkbench.solids.coverings import Layer, Sheet
from pipeworkbench.solids.frames import bend_angle, local_point

IDENTIFIER, TEXT = "IfcIdentifier", "IfcText"


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

    def covering(self, layers: Sequence[Layer], sheet: Sheet | None, *, is_planned: bool = False) -> Typed:
        """Return the type of coverings built of layers and a jacket; with properties where it is planned."""
        key: tuple[Any, ...] = tuple((layer.material, rounded(layer.thickness)) for layer in layers)
        # what one layer without a jacket is told by is as old as the first files
        key = ("insulation", *reversed(key[0])) if len(key) == 1 and sheet is None else ("insulation", key, sheet and _told(sheet))
        if key not in self._types:
            self._types[key] = self._make_covering(digest(key), layers, sheet, is_planned=is_planned)
        return self._types[key]

    def _make_covering(self, key: str, layers: Sequence[Layer], sheet: Sheet | None, *, is_planned: bool) -> Typed:
        name = self._name(covering_name(layers, sheet))
        sets = covering_sets(layers, sheet, name) if is_planned else {}
        entity = self.entities.root(
            "IfcCoveringType",
            key,
            Name=label(name),
            HasPropertySets=tuple(self.shared_set(title, properties) for title, properties in sets.items()) or None,
            PredefinedType="INSULATION",
        )
        told: list[dict[str, str]] = [
            {"Name": f"Layer {number}", "Category": "Insulation"} if is_planned else {} for number in range(1, len(layers) + 1)
        ]
        made = [self._material_layer(layer, **about) for layer, about in zip(layers, told, strict=True)]
        if sheet is not None:
            made.append(self._material_layer(sheet, Name="Jacket", Category="Finish"))
        layer_set = self.entities.add("IfcMaterialLayerSet", MaterialLayers=tuple(made), LayerSetName=label(name))
        self.entities.relate("IfcRelAssociatesMaterial", key, "RelatingMaterial", "RelatedObjects", layer_set, [entity])
        return Typed(key, entity)

    def _material_layer(self, layer: Layer | Sheet, **about: str) -> Any:
        material = self._material(layer.material)[0]
        return self.entities.add("IfcMaterialLayer", Material=material, LayerThickness=rounded(layer.thickness), **about)

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

    def styled(self, body: Body, kind: type[AnyComponent]) -> Body:
        """Give a body's items the colour of a kind of components; return the body."""
        self.coloured(body[1], kind.kind, COLOURS[kind])
        return body

    def coloured(self, items: Sequence[Any], name: str, colour: Colour) -> None:
        """Give solids a colour, which has a name; all of one name and colour share it."""
        style = self.entities.once(("style", name, colour), lambda: self._style(name, colour))
        for item in items:
            self.entities.add("IfcStyledItem", Item=item, Styles=(style,))

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

    def _style(self, name: str, colour: Colour) -> Any:
        red, green, blue = colour
        made = self.entities.add("IfcColourRgb", Red=red, Green=green, Blue=blue)
        shading = self.entities.add("IfcSurfaceStyleShading", SurfaceColour=made, Transparency=0.0)
        return self.entities.add("IfcSurfaceStyle", Name=label(name), Side="BOTH", Styles=(shading,))


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


def covering_name(layers: Sequence[Layer], sheet: Sheet | None) -> str:
    """Return what a type of coverings is called, such as ``Insulation 30 mm, Mineral wool; jacket 0.8 mm, Aluminium``."""
    inside = "; ".join(f"{layer.thickness:g} mm, {layer.material}" for layer in layers)
    jacket = f"{sheet.thickness:g} mm, {sheet.material}" if sheet else ""
    if not layers:
        return f"Cladding {jacket}"
    return f"Insulation {inside}; jacket {jacket}" if jacket else f"Insulation {inside}"


def covering_sets(layers: Sequence[Layer], sheet: Sheet | None, name: str) -> dict[str, Properties]:
    """Return the property sets that all planned coverings of one build share, by their names."""
    common: Properties = {"Reference": (IDENTIFIER, name), "Status": (ENUMERATED, "NEW")}
    build: Properties = {"NumberOfLayers": (NUMBER, len(layers))}
    for number, layer in enumerate(layers, 1):
        build |= {f"Layer{number}Material": (LABEL, layer.material), f"Layer{number}Thickness": (LENGTH, rounded(layer.thickness))}
    if sheet is not None:
        common["Finish"] = TEXT, f"{sheet.thickness:g} mm {sheet.material}"
        build |= {"JacketMaterial": (LABEL, sheet.material), "JacketThickness": (LENGTH, rounded(sheet.thickness))}
    return {"Pset_CoveringCommon": common, "PipeWorkbench_InsulationBuild": build}


def _told(sheet: Sheet) -> tuple[str, float]:
    return sheet.material, rounded(sheet.thickness)


def _length(value: float | None) -> float | None:
    return None if value is None else rounded(value, LENGTH_DIGITS)
