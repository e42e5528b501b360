# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC4: pipes as IfcPipeSegment with analytic, hollow extrusions, in millimetres."""

from __future__ import annotations

import time
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeworkbench import __version__
from pipeworkbench.errors import MissingPackageError
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.cylinder import perpendicular_axes

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
    products = [builder.pipe(pipe, storey, body, axis) for pipe in pipeline.pipes]
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
        self.origin = self._point((0.0, 0.0, 0.0))
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
            ],
        )
        model = self.add(
            "IfcGeometricRepresentationContext",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-5,
            WorldCoordinateSystem=self._axes(self.origin),
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
            placement = self.add("IfcLocalPlacement", PlacementRelTo=placement, RelativePlacement=self._axes(self.origin))
            child = self.root(kind, name, Name=name, ObjectPlacement=placement, CompositionType="ELEMENT")
            self.root("IfcRelAggregates", name, RelatingObject=parent, RelatedObjects=[child])
            parent = child
        return parent, body, axis

    def pipe(self, pipe: Pipe, storey: Any, body: Any, axis: Any) -> Any:
        """Add a pipe segment, extruded along its local +z, with its axis and properties."""
        start, end = np.array(pipe.start), np.array(pipe.end)
        direction = (end - start) / pipe.length
        placement = self.add(
            "IfcLocalPlacement",
            PlacementRelTo=storey.ObjectPlacement,
            RelativePlacement=self._axes(self._point(pipe.start), direction, perpendicular_axes(direction)[0]),
        )
        solid = self.add(
            "IfcExtrudedAreaSolid",
            SweptArea=self._profile(pipe),
            Position=self._axes(self.origin),
            ExtrudedDirection=self._direction((0.0, 0.0, 1.0)),
            Depth=pipe.length,
        )
        line = self.add("IfcPolyline", Points=[self.origin, self._point((0.0, 0.0, pipe.length))])
        shape = self.add(
            "IfcProductDefinitionShape",
            Representations=[
                self.add("IfcShapeRepresentation", ContextOfItems=axis, RepresentationIdentifier="Axis", RepresentationType="Curve3D", Items=[line]),
                self.add(
                    "IfcShapeRepresentation", ContextOfItems=body, RepresentationIdentifier="Body", RepresentationType="SweptSolid", Items=[solid]
                ),
            ],
        )
        size = f"DN {pipe.dn}" if pipe.dn else f"{pipe.outer_diameter:g} mm"
        segment = self.root(
            "IfcPipeSegment",
            pipe.id,
            Name=pipe.id,
            Description=f"Pipe {size}",
            ObjectType=f"Pipe {size}",
            ObjectPlacement=placement,
            Representation=shape,
            Tag=pipe.id,
            PredefinedType="RIGIDSEGMENT",
        )
        self._properties(segment, pipe)
        return segment

    def _profile(self, pipe: Pipe) -> Any:
        common = {"ProfileType": "AREA", "Position": self._axes_2d(), "Radius": pipe.outer_diameter / 2}
        if pipe.wall_thickness is None:  # not known: a full profile is honest, an invented wall is not
            return self.add("IfcCircleProfileDef", **common)
        return self.add("IfcCircleHollowProfileDef", WallThickness=pipe.wall_thickness, **common)

    def _properties(self, segment: Any, pipe: Pipe) -> None:
        dimensions = {
            "NominalDiameter": ("IfcPositiveLengthMeasure", pipe.dn),
            "OuterDiameter": ("IfcPositiveLengthMeasure", pipe.outer_diameter),
            "InnerDiameter": ("IfcPositiveLengthMeasure", pipe.wall_thickness and round(pipe.outer_diameter - 2 * pipe.wall_thickness, 6)),
            "Length": ("IfcPositiveLengthMeasure", pipe.length),
        }
        sigma = pipe.sigma_position or (None, None, None)
        measurement = {
            "Standard": ("IfcLabel", pipe.standard),
            "VerifiedSources": ("IfcInteger", pipe.verified),
            "QualityPixel": ("IfcReal", pipe.quality),
            "SigmaX": ("IfcNonNegativeLengthMeasure", sigma[0]),
            "SigmaY": ("IfcNonNegativeLengthMeasure", sigma[1]),
            "SigmaZ": ("IfcNonNegativeLengthMeasure", sigma[2]),
            "SigmaDirectionDegrees": ("IfcReal", pipe.sigma_direction_deg),
            "LevelOfAccuracy": ("IfcLabel", pipe.loa),
            "Approximate": ("IfcBoolean", pipe.approximate),
            "Station": ("IfcLabel", pipe.station),
        }
        for name, values in (("Pset_PipeSegmentTypeCommon", dimensions), ("PipeWorkbench_Measurement", measurement)):
            properties = [
                self.add("IfcPropertySingleValue", Name=key, NominalValue=self.file.create_entity(kind, value))
                for key, (kind, value) in values.items()
                if value is not None
            ]
            pset = self.root("IfcPropertySet", f"{pipe.id}/{name}", Name=name, HasProperties=properties)
            self.root("IfcRelDefinesByProperties", f"{pipe.id}/{name}", RelatedObjects=[segment], RelatingPropertyDefinition=pset)

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

    def _point(self, values: tuple[float, ...]) -> Any:
        return self.add("IfcCartesianPoint", Coordinates=tuple(float(value) for value in values))

    def _direction(self, values: Any) -> Any:
        return self.add("IfcDirection", DirectionRatios=tuple(float(value) for value in values))

    def _axes(self, location: Any, axis: Any = None, reference: Any = None) -> Any:
        return self.add(
            "IfcAxis2Placement3D",
            Location=location,
            Axis=None if axis is None else self._direction(axis),
            RefDirection=None if reference is None else self._direction(reference),
        )

    def _axes_2d(self) -> Any:
        return self.add("IfcAxis2Placement2D", Location=self._point((0.0, 0.0)))
