# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC: valid, in millimetres, and with the pipes where the pipeline has them."""

import gc

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import ifcopenshell.validate
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from measured import DN40

from pipeworkbench.exports.ifc import ifc_model, write_ifc
from pipeworkbench.pipeline import Cap, Pipe, Pipeline
from pipeworkbench.solids import component_solid

UNKNOWN_WALL = Pipe(id="A-P01", start=(0.0, 4000.0, 0.0), end=(0.0, 4000.0, -700.0), outer_diameter=95.0)
PIPELINE = Pipeline.of_station("A", (DN40, UNKNOWN_WALL))


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = tmp_path_factory.mktemp("ifc") / "pipes.ifc"
    write_ifc(PIPELINE, path)
    return path


@pytest.fixture(scope="module")
def model(written):
    return ifcopenshell.open(str(written))


def segment(model, name):
    (found,) = (item for item in model.by_type("IfcPipeSegment") if item.Name == name)
    return found


def body_shape(item):
    """Return a product's body, that of its type where it is mapped."""
    (shape,) = (r for r in item.Representation.Representations if r.RepresentationIdentifier == "Body")
    return shape.Items[0].MappingSource.MappedRepresentation if shape.RepresentationType == "MappedRepresentation" else shape


def body(item):
    (solid,) = body_shape(item).Items
    return solid


def properties(item):
    """Return the property sets of a product and its type."""
    return ifcopenshell.util.element.get_psets(item)


def axis_of(item):
    """Return both ends of a segment's axis from its placement and the depth of its extrusion."""
    placement = ifcopenshell.util.placement.get_local_placement(item.ObjectPlacement)
    solid = body(item)
    along = np.array(solid.ExtrudedDirection.DirectionRatios) * solid.Depth
    start = np.array(solid.Position.Location.Coordinates)
    return (placement @ [*start, 1.0])[:3], (placement @ [*(start + along), 1.0])[:3]


def test_validator_finds_nothing(written):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(written), logger)
    assert logger.statements == []


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")  # the validator leaves files open
def test_validator_finds_nothing_by_the_schemas_rules_either(written):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(written), logger, express_rules=True)
    gc.collect()
    assert logger.statements == []


def test_schema_is_ifc4_and_lengths_are_millimetres(model):
    assert model.schema == "IFC4"
    assert ifcopenshell.util.unit.calculate_unit_scale(model) == pytest.approx(0.001)


def test_segments_hang_in_project_site_building_and_storey(model):
    item = segment(model, "A-P00")
    (contained,) = item.ContainedInStructure
    chain = [contained.RelatingStructure]
    while chain[-1].Decomposes:
        chain.append(chain[-1].Decomposes[0].RelatingObject)
    assert [part.is_a() for part in chain] == ["IfcBuildingStorey", "IfcBuilding", "IfcSite", "IfcProject"]
    assert chain[-1].Name == "A"
    assert len(model.by_type("IfcProject")) == 1


def test_every_pipe_is_a_segment_with_its_id(model):
    assert [item.Name for item in model.by_type("IfcPipeSegment")] == ["A-P00", "A-P01"]


def test_known_wall_gives_a_hollow_profile(model):
    profile = body(segment(model, "A-P00")).SweptArea
    assert profile.is_a("IfcCircleHollowProfileDef")
    assert pytest.approx(24.15) == profile.Radius
    assert pytest.approx(2.6) == profile.WallThickness


def test_unknown_wall_gives_a_full_profile(model):
    profile = body(segment(model, "A-P01")).SweptArea
    assert profile.is_a() == "IfcCircleProfileDef"
    assert pytest.approx(47.5) == profile.Radius
    assert "InnerDiameter" not in properties(segment(model, "A-P01"))["Pset_PipeSegmentTypeCommon"]


@pytest.mark.parametrize("pipe", PIPELINE.pipes, ids=lambda pipe: pipe.id)
def test_placement_and_depth_give_the_ends_of_the_axis(model, pipe):
    start, end = axis_of(segment(model, pipe.id))
    assert start == pytest.approx(pipe.start, abs=1e-6)
    assert end == pytest.approx(pipe.end, abs=1e-6)


@pytest.mark.parametrize("pipe", PIPELINE.pipes, ids=lambda pipe: pipe.id)
def test_axis_representation_is_the_pipes_axis(model, pipe):
    item = segment(model, pipe.id)
    (shape,) = (r for r in item.Representation.Representations if r.RepresentationIdentifier == "Axis")
    placement = ifcopenshell.util.placement.get_local_placement(item.ObjectPlacement)
    first, last = (placement @ [*point.Coordinates, 1.0] for point in shape.Items[0].Points)
    assert first[:3] == pytest.approx(pipe.start, abs=1e-6)
    assert last[:3] == pytest.approx(pipe.end, abs=1e-6)


coordinates = st.floats(-1e5, 1e5)
points = st.tuples(coordinates, coordinates, coordinates)


@given(points, points)
def test_any_axis_is_placed_exactly_with_a_right_handed_frame(start, end):
    assume(np.linalg.norm(np.subtract(end, start)) > 1.0)
    pipe = Pipe(id="P", start=start, end=end, outer_diameter=60.3)
    made = ifc_model(Pipeline(frame="A", components=(pipe,)))  # entities live as long as their file
    (item,) = made.by_type("IfcPipeSegment")
    found_start, found_end = axis_of(item)
    assert found_start == pytest.approx(start, abs=1e-6)
    assert found_end == pytest.approx(end, abs=1e-6)
    rotation = ifcopenshell.util.placement.get_local_placement(item.ObjectPlacement)[:3, :3]
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_measurement_and_dimensions_are_properties(model):
    sets = properties(segment(model, "A-P00"))
    dimensions, measurement = sets["Pset_PipeSegmentTypeCommon"], sets["PipeWorkbench_AsBuilt"]
    assert dimensions["NominalDiameter"] == 40
    assert dimensions["OuterDiameter"] == pytest.approx(48.3)
    assert dimensions["InnerDiameter"] == pytest.approx(48.3 - 2 * 2.6)
    assert sets["Qto_PipeSegmentBaseQuantities"]["Length"] == pytest.approx(500.0)
    assert [measurement[f"Sigma{axis}"] for axis in "XYZ"] == pytest.approx(list(DN40.sigma_position))
    assert measurement["Standard"] == "EN 10220"
    assert measurement["VerifiedGrade"] == 2


def test_unverified_dimensions_are_marked():
    pipe = Pipe(id="P", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 9.0), outer_diameter=10.2, verified=0)
    made = ifc_model(Pipeline(frame="A", components=(pipe,)))  # entities live as long as their file
    (item,) = made.by_type("IfcPipeSegment")
    assert properties(item)["PipeWorkbench_AsBuilt"]["VerifiedGrade"] == 0


def test_same_pipeline_gives_the_same_global_ids(model, tmp_path):
    write_ifc(PIPELINE, tmp_path / "again.ifc")
    again = ifcopenshell.open(str(tmp_path / "again.ifc"))
    ids = [item.GlobalId for item in model.by_type("IfcRoot")]
    assert [item.GlobalId for item in again.by_type("IfcRoot")] == ids
    assert len(set(ids)) == len(ids)


def test_another_project_gives_other_global_ids(model):
    other = ifc_model(Pipeline.of_station("B", PIPELINE.pipes))
    assert not {item.GlobalId for item in model.by_type("IfcRoot")} & {item.GlobalId for item in other.by_type("IfcRoot")}


def test_pipeline_without_pipes_is_valid_too(tmp_path):
    path = tmp_path / "empty.ifc"
    write_ifc(Pipeline(frame="A"), path)
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    assert logger.statements == []
    assert [entry.name for entry in tmp_path.iterdir()] == ["empty.ifc"]


# ---------------------------------------------------------------- other kinds than pipes


@pytest.fixture(scope="module")
def all_written(everything, tmp_path_factory):
    path = tmp_path_factory.mktemp("ifc") / "all.ifc"
    write_ifc(everything, path)
    return path


@pytest.fixture(scope="module")
def all_model(all_written):
    return ifcopenshell.open(str(all_written))


@pytest.fixture(scope="module")
def products(all_model):  # entities live as long as their file
    return {item.Name: item for kind in ("IfcPipeSegment", "IfcPipeFitting") for item in all_model.by_type(kind)}


def meshed(item):
    """Return the vertices (n, 3) mm in the project's frame and the triangles (m, 3) of a product."""
    settings = ifcopenshell.geom.settings()
    for name, value in (("use-world-coords", True), ("mesher-linear-deflection", 1e-6), ("mesher-angular-deflection", 0.05)):
        settings.set(name, value)
    geometry = ifcopenshell.geom.create_shape(settings, item).geometry
    return np.array(geometry.verts).reshape(-1, 3) * 1000, np.array(geometry.faces).reshape(-1, 3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")  # the validator leaves files open
def test_validator_finds_nothing_in_all_kinds(all_written):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(all_written), logger, express_rules=True)
    gc.collect()
    assert logger.statements == []


def test_fittings_say_what_they_do_and_what_they_are(products, everything):
    assert set(products) == {component.id for component in everything.components}
    types = {name: ifcopenshell.util.element.get_type(item) for name, item in products.items()}
    assert all(item.PredefinedType is None for item in products.values())  # the type says it
    said = {name: (item.is_a(), types[name].PredefinedType, types[name].Name.split(" DN")[0]) for name, item in products.items()}
    assert said["P1"] == ("IfcPipeSegment", "RIGIDSEGMENT", "Pipe")
    assert said["E1"] == ("IfcPipeFitting", "BEND", "Elbow")
    assert said["T1"] == ("IfcPipeFitting", "JUNCTION", "Tee")
    assert said["R1"] == ("IfcPipeFitting", "TRANSITION", "Reducer")
    assert said["F1"] == ("IfcPipeFitting", "CONNECTOR", "Flange")
    assert said["F2"] == ("IfcPipeFitting", "OBSTRUCTION", "Blind flange")
    assert said["C1"] == ("IfcPipeFitting", "OBSTRUCTION", "Cap")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["E1", "E2", "F1", "F2", "F3", "T1", "R1", "R2", "C1"])
def test_geometry_is_that_of_the_solids(products, everything, name):
    (component,) = (component for component in everything.components if component.id == name)
    vertices, triangles = meshed(products[name])
    solid = component_solid(component)
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    # a faceted surface lies inside the curved one
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(solid.Volume(), rel=4e-3)
    box = solid.BoundingBox()
    assert vertices.min(axis=0) == pytest.approx((box.xmin, box.ymin, box.zmin), abs=0.02)
    assert vertices.max(axis=0) == pytest.approx((box.xmax, box.ymax, box.zmax), abs=0.02)


def test_nothing_is_tessellated(all_model):
    assert not all_model.by_type("IfcTessellatedItem")
    assert not all_model.by_type("IfcFacetedBrep")


def test_boolean_operations_are_where_two_cylinders_meet(all_model, everything):
    tees = sum(component.kind == "tee" for component in everything.components)
    assert {shape.RepresentationType for shape in all_model.by_type("IfcShapeRepresentation") if shape.Items[0].is_a("IfcBooleanResult")} == {"CSG"}
    assert len(all_model.by_type("IfcBooleanResult")) <= 2 * tees


def test_elbow_is_an_analytic_bend_of_a_hollow_section(products):
    solid = body(products["E2"])
    assert solid.is_a("IfcRevolvedAreaSolid")
    assert solid.Angle == pytest.approx(np.pi / 4)
    assert solid.Axis.Location.Coordinates == pytest.approx((57, 0, 0))
    assert (solid.SweptArea.Radius, solid.SweptArea.WallThickness) == pytest.approx((24.15, 2.6))


def test_bolt_holes_are_voids_not_boolean_operations(products):
    shape = body_shape(products["F1"])
    assert shape.RepresentationType == "SweptSolid"
    (plate,) = (item for item in shape.Items if item.is_a("IfcExtrudedAreaSolid") and item.SweptArea.is_a("IfcArbitraryProfileDefWithVoids"))
    assert len(plate.SweptArea.InnerCurves) == 4 + 1  # and the bore


def test_properties_of_fittings(products):
    sets = {name: ifcopenshell.util.element.get_psets(products[name]) for name in ("E1", "F1", "T1", "R1")}
    assert sets["E1"]["Pset_PipeFittingTypeBend"]["BendAngle"] == pytest.approx(np.pi / 2)
    assert sets["E1"]["Pset_PipeFittingTypeBend"]["BendRadius"] == 57
    assert sets["F1"]["Pset_PipeFittingTypeCommon"]["PressureClass"] == pytest.approx(16e5)
    dimensions = sets["F1"]["PipeWorkbench_Flange"]
    assert (dimensions["FlangeDiameter"], dimensions["NumberOfBoltholes"], dimensions["NominalDiameter"]) == (165, 4, 50)
    assert dimensions["SameDimensionsAs"] == "DIN 2633 type 11 PN 16"
    assert sets["T1"]["Pset_PipeFittingTypeJunction"]["JunctionType"] == ["TEE"]
    assert sets["R1"]["PipeWorkbench_Dimensions"]["EndDiameter"] == 48.3
    for found in sets.values():
        assert found["Pset_PipeFittingTypeCommon"]["Status"] == ["EXISTING"]
        assert found["PipeWorkbench_AsBuilt"]["SigmaY"] == pytest.approx(0.3)


def test_fitting_of_which_nothing_but_its_dimensions_is_known_is_valid(tmp_path):
    cap = Cap(id="C", start=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), length=38.0, outer_diameter=60.3)
    path = tmp_path / "cap.ifc"
    write_ifc(Pipeline(frame="A", components=(cap,)), path)
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    assert logger.statements == []


def test_components_of_a_kind_share_their_colour(all_model):
    assert sorted(style.Name for style in all_model.by_type("IfcSurfaceStyle")) == ["cap", "elbow", "flange", "pipe", "reducer", "tee"]
    shapes = [shape for shape in all_model.by_type("IfcShapeRepresentation") if shape.RepresentationIdentifier == "Body"]
    assert all(item.StyledByItem for shape in shapes if shape.RepresentationType != "MappedRepresentation" for item in shape.Items)
