# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes read from IFC models: our own, in other units, mapped, swept, and what cannot be read."""

import csv

import ifcopenshell
import ifcopenshell.guid
import numpy as np
import pytest
from measured import DN40

from pipeworkbench.errors import InputError
from pipeworkbench.exports.deviations import COLUMNS, write_deviations
from pipeworkbench.exports.ifc import ifc_model, write_ifc
from pipeworkbench.exports.ifc_reading import ifc_pipes, read_ifc_pipes
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.plant import Deviation

STEEP = Pipe(id="P1", start=(100.0, 4000.0, 50.0), end=(700.0, 4300.0, -800.0), outer_diameter=95.0)
PIPELINE = Pipeline.of_station("A", (DN40, STEEP))


def test_our_own_file_comes_back(tmp_path):
    write_ifc(PIPELINE, tmp_path / "pipes.ifc")
    found = read_ifc_pipes(tmp_path / "pipes.ifc")
    assert found.unreadable == 0
    assert found.pipeline.frame == "pipes"
    assert [pipe.extra["name"] for pipe in found.pipeline.pipes] == [DN40.id, STEEP.id]
    for read, pipe in zip(found.pipeline.pipes, PIPELINE.pipes, strict=True):
        assert np.allclose([read.start, read.end], [pipe.start, pipe.end], atol=1e-6)
        assert read.outer_diameter == pytest.approx(pipe.outer_diameter)


class Model:
    """A small model in metres."""

    def __init__(self):
        self.file = ifcopenshell.file(schema="IFC4")
        unit = self.add("IfcSIUnit", UnitType="LENGTHUNIT", Name="METRE")
        units = self.add("IfcUnitAssignment", Units=[unit])
        context = self.add("IfcGeometricRepresentationContext", ContextType="Model", CoordinateSpaceDimension=3, WorldCoordinateSystem=self.axes())
        self.add("IfcProject", GlobalId=ifcopenshell.guid.new(), RepresentationContexts=[context], UnitsInContext=units)
        self.context = context

    def add(self, kind, **attributes):
        return self.file.create_entity(kind, **attributes)

    def point(self, *values):
        return self.add("IfcCartesianPoint", Coordinates=tuple(map(float, values)))

    def axes(self, *location):
        return self.add("IfcAxis2Placement3D", Location=self.point(*(location or (0, 0, 0))))

    def line(self, start, end):
        return self.add("IfcPolyline", Points=[self.point(*start), self.point(*end)])

    def segment(self, name, items, identifier="Body", location=(0, 0, 0)):
        shape = self.add("IfcShapeRepresentation", ContextOfItems=self.context, RepresentationIdentifier=identifier, Items=items)
        return self.add(
            "IfcPipeSegment",
            GlobalId=ifcopenshell.guid.new(),
            Name=name,
            ObjectPlacement=self.add("IfcLocalPlacement", RelativePlacement=self.axes(*location)),
            Representation=self.add("IfcProductDefinitionShape", Representations=[shape]),
        )

    def cylinder(self, radius=0.05, depth=2.0):
        profile = self.add("IfcCircleProfileDef", ProfileType="AREA", Radius=radius)
        up = self.add("IfcDirection", DirectionRatios=(0.0, 0.0, 1.0))
        return self.add("IfcExtrudedAreaSolid", SweptArea=profile, Position=self.axes(0, 0, 0.5), ExtrudedDirection=up, Depth=depth)

    def told(self, segment, **values):
        properties = [
            self.add("IfcPropertySingleValue", Name=k, NominalValue=self.file.create_entity("IfcPositiveLengthMeasure", v)) for k, v in values.items()
        ]
        pset = self.add("IfcPropertySet", GlobalId=ifcopenshell.guid.new(), Name="Pset_PipeSegmentTypeCommon", HasProperties=properties)
        self.add("IfcRelDefinesByProperties", GlobalId=ifcopenshell.guid.new(), RelatedObjects=[segment], RelatingPropertyDefinition=pset)


def test_metres_and_placements():
    model = Model()
    model.segment("one", [model.cylinder()], location=(1, 2, 3))
    (pipe,) = ifc_pipes(model.file).pipeline.pipes
    assert np.allclose([pipe.start, pipe.end], [[1000, 2000, 3500], [1000, 2000, 5500]])
    assert pipe.outer_diameter == pytest.approx(100)


def test_mapped_items_swept_disks_and_axes_with_properties():
    model = Model()
    inner = model.add("IfcShapeRepresentation", ContextOfItems=model.context, RepresentationIdentifier="Body", Items=[model.cylinder()])
    mapped = model.add("IfcRepresentationMap", MappingOrigin=model.axes(), MappedRepresentation=inner)
    target = model.add("IfcCartesianTransformationOperator3D", LocalOrigin=model.point(0, 0, 10), Scale=1.0)
    model.segment("mapped", [model.add("IfcMappedItem", MappingSource=mapped, MappingTarget=target)])
    model.segment("disk", [model.add("IfcSweptDiskSolid", Directrix=model.line((0, 0, 0), (0, 3, 0)), Radius=0.03)])
    model.told(model.segment("axis", [model.line((0, 0, 0), (1, 0, 0))], "Axis"), OuterDiameter=0.0603)
    model.segment("untold", [model.line((0, 0, 0), (1, 0, 0))], "Axis")
    found = ifc_pipes(model.file)
    assert found.unreadable == 1
    by_name = {pipe.extra["name"]: pipe for pipe in found.pipeline.pipes}
    assert np.allclose([by_name["mapped"].start, by_name["mapped"].end], [[0, 0, 10500], [0, 0, 12500]])
    assert by_name["disk"].outer_diameter == pytest.approx(60)
    assert by_name["disk"].length == pytest.approx(3000)
    assert by_name["axis"].outer_diameter == pytest.approx(60.3)


def test_files_without_pipes_are_refused(tmp_path):
    path = tmp_path / "none.ifc"
    ifc_model(Pipeline(frame="A")).write(str(path))
    with pytest.raises(InputError, match="holds no IfcPipeSegment"):
        read_ifc_pipes(path)
    path.write_text("nonsense")
    with pytest.raises(InputError, match="cannot be read as IFC"):
        read_ifc_pipes(path)


def test_deviations_are_a_table(tmp_path):
    rows = [
        Deviation("D1", "A-P0", "pipe", 60.3, 60.3, (1.0, -2.0, 0.5), (2.1, 2.5), 0.12),
        Deviation("D2", None, "pipe", designed_diameter=48.3),
        Deviation(None, "A-X", "pipe", built_diameter=33.7),
    ]
    write_deviations(rows, tmp_path / "deviations.csv")
    with (tmp_path / "deviations.csv").open(encoding="utf-8", newline="") as file:
        read = list(csv.DictReader(file))
    assert tuple(read[0]) == COLUMNS
    assert [float(read[0][f"offset_{axis}_mm"]) for axis in "xyz"] == [1.0, -2.0, 0.5]
    assert read[0]["distance_end_mm"] == "2.5"
    assert [row["remark"] for row in read] == ["", "not seen in the pipework", "not in the model"]
