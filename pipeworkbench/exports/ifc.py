# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC4: pipes as IfcPipeSegment, everything else as IfcPipeFitting, in millimetres.

IFC4 names what a fitting does, not what it is: an elbow is a BEND, a tee a JUNCTION, a reducer a TRANSITION. A flange
is a CONNECTOR, which joins two pipes (the enumeration has no flange); a cap and a blind flange, which close a pipe's
end, are an OBSTRUCTION. What it is stands in ObjectType.
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench import __version__
from pipeworkbench.errors import MissingPackageError
from pipeworkbench.exports.ifc_properties import property_sets
from pipeworkbench.exports.ifc_shapes import Shapes
from pipeworkbench.exports.kinds import COLOURS, designation
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee
from pipeworkbench.solids import Frame, frame_of

if TYPE_CHECKING:
    import ifcopenshell

NAMESPACE = uuid.UUID("7a1f4d55-3c5e-4f0b-9b55-0d6c8ac1e2f4")  # of this program's GlobalIds
APPLICATION = "Pipe Workbench"


def write_ifc(pipeline: Pipeline, path: Path) -> None:
    """Write an IFC4 file; the same pipeline always gives the same GlobalIds."""
    file = ifc_model(pipeline, path.name)
    with written_whole(path) as temporary:
        file.write(str(temporary))


def ifc_model(pipeline: Pipeline, name: str = "pipeline.ifc") -> ifcopenshell.file:
    """Return the pipeline as an ifcopenshell model."""
    try:
        import ifcopenshell
    except ImportError:
        raise MissingPackageError("ifcopenshell", "Writing IFC", "pip install 'ifcopenshell>=0.8.4,<0.10'") from None

    file = ifcopenshell.file(schema="IFC4")
    _header(file, name)
    builder = _Builder(file, pipeline.frame)
    storey, body, axis = builder.skeleton()
    products = [builder.product(component, storey, body, axis) for component in pipeline.components]
    if products:
        builder.root("IfcRelContainedInSpatialStructure", "contained", RelatedElements=products, RelatingStructure=storey)
    return file


def _header(file: ifcopenshell.file, name: str) -> None:
    file.header.file_description.description = ("ViewDefinition [ReferenceView_V1.2]",)
    file.header.file_name.name = name
    file.header.file_name.originating_system = f"{APPLICATION} - {__version__}"
    file.header.file_name.preprocessor_version = f"{APPLICATION} {__version__}"


class _Builder:
    """Adds entities to one IFC file; keeps the owner history and the name its GlobalIds derive from."""

    def __init__(self, file: ifcopenshell.file, project: str) -> None:
        self.file, self.project = file, project
        self.shapes = Shapes(file)
        self.styles: dict[type[AnyComponent], Any] = {}
        self.history = self._owner_history()

    def add(self, kind: str, **attributes: Any) -> Any:
        return self.file.create_entity(kind, **attributes)

    def root(self, kind: str, key: str, **attributes: Any) -> Any:
        """Add a rooted entity with a GlobalId that depends on the project, its kind and ``key`` only."""
        import ifcopenshell.guid

        identity = uuid.uuid5(NAMESPACE, f"{self.project}/{kind}/{key}")
        return self.add(kind, GlobalId=ifcopenshell.guid.compress(identity.hex), OwnerHistory=self.history, **attributes)

    def skeleton(self) -> tuple[Any, Any, Any]:
        """Add project, site, building and storey; return the storey and the body and axis contexts."""
        units = self.add(
            "IfcUnitAssignment",
            Units=[
                self.add("IfcSIUnit", UnitType="LENGTHUNIT", Prefix="MILLI", Name="METRE"),
                self.add("IfcSIUnit", UnitType="AREAUNIT", Name="SQUARE_METRE"),
                self.add("IfcSIUnit", UnitType="VOLUMEUNIT", Name="CUBIC_METRE"),
                self.add("IfcSIUnit", UnitType="PLANEANGLEUNIT", Name="RADIAN"),
                self.add("IfcSIUnit", UnitType="PRESSUREUNIT", Name="PASCAL"),
            ],
        )
        model = self.add(
            "IfcGeometricRepresentationContext",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-5,
            WorldCoordinateSystem=self.shapes.axes(),
        )
        body, axis = (
            self.add(
                "IfcGeometricRepresentationSubContext",
                ContextIdentifier=name,
                ContextType="Model",
                ParentContext=model,
                TargetView=view,
            )
            for name, view in (("Body", "MODEL_VIEW"), ("Axis", "GRAPH_VIEW"))
        )
        project = self.root("IfcProject", "project", Name=self.project, RepresentationContexts=[model], UnitsInContext=units)
        parent, placement = project, None
        for kind, name in (("IfcSite", "Site"), ("IfcBuilding", "Building"), ("IfcBuildingStorey", "Storey")):
            placement = self.add("IfcLocalPlacement", PlacementRelTo=placement, RelativePlacement=self.shapes.axes())
            child = self.root(kind, name, Name=name, ObjectPlacement=placement, CompositionType="ELEMENT")
            self.root("IfcRelAggregates", name, RelatingObject=parent, RelatedObjects=[child])
            parent = child
        return parent, body, axis

    def product(self, component: AnyComponent, storey: Any, body: Any, axis: Any) -> Any:
        """Add a component, modelled in its own axes, with its place, colour and properties."""
        frame = frame_of(component)
        placement = self.add("IfcLocalPlacement", PlacementRelTo=storey.ObjectPlacement, RelativePlacement=self._place(frame))
        kind, items = self.shapes.body(component, frame)
        for item in items:
            self.add("IfcStyledItem", Item=item, Styles=[self._style(type(component))])
        representations = [
            self.add("IfcShapeRepresentation", ContextOfItems=body, RepresentationIdentifier="Body", RepresentationType=kind, Items=items)
        ]
        if isinstance(component, Pipe):
            line = self.shapes.line(component.length)
            representations.insert(
                0,
                self.add("IfcShapeRepresentation", ContextOfItems=axis, RepresentationIdentifier="Axis", RepresentationType="Curve3D", Items=[line]),
            )
        made = self.root(
            "IfcPipeSegment" if isinstance(component, Pipe) else "IfcPipeFitting",
            component.id,
            Name=component.id,
            Description=designation(component),
            ObjectType=designation(component),
            ObjectPlacement=placement,
            Representation=self.add("IfcProductDefinitionShape", Representations=representations),
            Tag=component.id,
            PredefinedType=predefined_type(component),
        )
        for name, values in property_sets(component).items():
            self._properties(made, component.id, name, values)
        return made

    def _properties(self, product: Any, key: str, name: str, values: Mapping[str, tuple[str, Any]]) -> None:
        properties = [
            self._enumerated(label, value)
            if kind == "enumerated"
            else self.add("IfcPropertySingleValue", Name=label, NominalValue=self.file.create_entity(kind, value))
            for label, (kind, value) in values.items()
        ]
        pset = self.root("IfcPropertySet", f"{key}/{name}", Name=name, HasProperties=properties)
        self.root("IfcRelDefinesByProperties", f"{key}/{name}", RelatedObjects=[product], RelatingPropertyDefinition=pset)

    def _enumerated(self, name: str, value: str) -> Any:
        return self.add("IfcPropertyEnumeratedValue", Name=name, EnumerationValues=[self.file.create_entity("IfcLabel", value)])

    def _style(self, kind: type[AnyComponent]) -> Any:
        """Return the surface style of a kind of components, which all of that kind share."""
        if kind not in self.styles:
            red, green, blue = COLOURS[kind]
            shading = self.add("IfcSurfaceStyleShading", SurfaceColour=self.add("IfcColourRgb", Red=red, Green=green, Blue=blue))
            self.styles[kind] = self.add("IfcSurfaceStyle", Name=kind.kind, Side="BOTH", Styles=[shading])
        return self.styles[kind]

    def _place(self, frame: Frame) -> Any:
        return self.shapes.axes(frame.origin, frame.z, frame.x)

    def _owner_history(self) -> Any:
        now = int(time.time())
        organisation = self.add("IfcOrganization", Name=APPLICATION)
        person = self.add("IfcPersonAndOrganization", ThePerson=self.add("IfcPerson", FamilyName="User"), TheOrganization=organisation)
        application = self.add(
            "IfcApplication",
            ApplicationDeveloper=organisation,
            Version=__version__,
            ApplicationFullName=APPLICATION,
            ApplicationIdentifier="PipeWorkbench",
        )
        return self.add(
            "IfcOwnerHistory", OwningUser=person, OwningApplication=application, ChangeAction="ADDED", LastModifiedDate=now, CreationDate=now
        )


def predefined_type(component: AnyComponent) -> str:
    """Return the value of IFC4's IfcPipeSegmentTypeEnum or IfcPipeFittingTypeEnum that says what a component does."""
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
