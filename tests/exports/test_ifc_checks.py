# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC as a BIM coordinator checks it: valid by several programs, ports connected, IDS kept, the same bodies in independent readers."""

import dataclasses
import functools
from pathlib import Path

import ifc_checks as checks
import ifcopenshell
import ifcopenshell.guid
import pytest
from ifcopenshell.util.element import get_materials, get_predefined_type, get_psets
from pipe_rack import pipe_rack

from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, write_ifc
from pipeworkbench.pipeline import Elbow, Pipe, Pipeline

DATA = checks.ROOT / "tests" / "data"
IDS = checks.ROOT / "resources" / "ids" / "pipework_as_built.ids"
SECONDS = 1_700_000_000
LARGEST_BYTES = 2_000_000  # of 1,000 components
PLANTS = {
    "dummy": lambda: Pipeline.read(DATA / "dummy.json"),  # what the command line makes of the bundled sample
    "everything": lambda: Pipeline.read(DATA / "one_of_everything.json"),
    "rack": lambda: pipe_rack(100),
    "large rack": lambda: pipe_rack(1000),
}
OCC_VOLUME, WEB_IFC_VOLUME, BOX_MM = 5e-4, 5e-3, 0.5
SMALL = [(schema, plant) for schema in SCHEMAS for plant in PLANTS if plant != "large rack"]
every_small = pytest.mark.parametrize(("schema", "plant"), SMALL, ids=[" ".join(pair) for pair in SMALL])
every_schema = pytest.mark.parametrize("schema", SCHEMAS)


@functools.cache
def pipeline_of(plant):
    return PLANTS[plant]()


@pytest.fixture(scope="module")
def path_of(tmp_path_factory):
    """Give a function that writes a plant once in a schema and returns the file's path."""
    folder = tmp_path_factory.mktemp("ifc")

    @functools.cache
    def written(schema, plant):
        path = Path(folder) / f"{plant} {schema}.ifc"
        write_ifc(pipeline_of(plant), path, IfcOptions(schema, SECONDS))
        return path

    return written


@pytest.fixture
def opened(path_of):
    return lambda schema, plant: ifcopenshell.open(str(path_of(schema, plant)))


@pytest.fixture(scope="module")
def specifications():
    ids = pytest.importorskip("ifctester.ids", reason="ifctester is not installed")
    return ids.open(str(IDS), validate=True)


def ids_faults(specifications, model):
    specifications.validate(model, should_filter_version=True)
    return [
        f"{one.name}: {[str(facet.failures[0]['reason']) for facet in one.requirements if facet.failures]}"
        for one in specifications.specifications
        if one.is_ifc_version and not one.status
    ]


# ---------------------------------------------------------------- valid


@pytest.mark.slow
@every_small
def test_ifcopenshells_commands_find_nothing(path_of, schema, plant):
    assert checks.command_faults(path_of(schema, plant)) == []


@pytest.mark.slow
@every_schema
def test_a_thousand_components_are_valid_connected_as_demanded_and_small(path_of, opened, specifications, schema):
    path, pipeline = path_of(schema, "large rack"), pipeline_of("large rack")
    assert len(pipeline.components) == 1000
    assert path.stat().st_size < LARGEST_BYTES
    assert checks.command_faults(path) == []
    model = opened(schema, "large rack")
    assert checks.type_faults(model, pipeline) == []
    assert checks.port_faults(model, pipeline) == []
    assert checks.system_faults(model, pipeline) == []
    assert ids_faults(specifications, model) == []


@every_small
def test_header_units_and_contexts(opened, schema, plant):
    assert checks.header_faults(opened(schema, plant), schema) == []


@every_small
def test_components_have_types_materials_and_a_storey(opened, schema, plant):
    assert checks.type_faults(opened(schema, plant), pipeline_of(plant)) == []


@every_small
def test_standard_property_sets_are_the_schemas(opened, schema, plant):
    assert checks.property_set_faults(opened(schema, plant)) == []


# ---------------------------------------------------------------- ports and systems


@every_small
def test_every_joint_is_a_pair_of_coincident_ports(opened, schema, plant):
    assert checks.port_faults(opened(schema, plant), pipeline_of(plant)) == []


@every_small
def test_every_run_is_a_system(opened, schema, plant):
    assert checks.system_faults(opened(schema, plant), pipeline_of(plant)) == []


# what spoils a file, and what the port check must say of it
SPOILED = {
    "apart": lambda model: setattr(connected(model).ObjectPlacement.RelativePlacement, "Location", model.createIfcCartesianPoint((0.0, 0.0, 999.0))),
    "flows": lambda model: setattr(connected(model), "FlowDirection", "SOURCEANDSINK"),
    "axis of a": lambda model: setattr(connected(model).ObjectPlacement.RelativePlacement, "Axis", model.createIfcDirection((0.6, 0.0, 0.8))),
    "connected 0 times": lambda model: model.remove(model.by_type("IfcRelConnectsPorts")[0]),
    "nested 2 times": lambda model: model.create_entity(
        "IfcRelNests", GlobalId=ifcopenshell.guid.new(), RelatingObject=model.by_type("IfcPipeSegment")[0], RelatedObjects=[connected(model)]
    ),
    "IfcRelConnectsPortToElement": lambda model: model.create_entity(
        "IfcRelConnectsPortToElement",
        GlobalId=ifcopenshell.guid.new(),
        RelatingPort=connected(model),
        RelatedElement=model.by_type("IfcPipeSegment")[0],
    ),
}


def connected(model):
    return model.by_type("IfcRelConnectsPorts")[0].RelatingPort


@pytest.mark.parametrize("fault", SPOILED)
def test_port_check_finds_what_is_spoiled(opened, fault):
    model = opened("IFC4", "everything")
    SPOILED[fault](model)
    assert any(fault in found for found in checks.port_faults(model, pipeline_of("everything")))


# ---------------------------------------------------------------- IDS


@every_small
def test_ids_is_kept(opened, specifications, schema, plant):
    assert ids_faults(specifications, opened(schema, plant)) == []


def test_ids_names_each_specification_once(specifications):
    names = [one.name for one in specifications.specifications]
    assert len(set(names)) == len(names)


# what a coordinator would not accept, and the specification that must fail
UNACCEPTABLE = {
    "Lengths are in millimetres": lambda model: [setattr(u, "Prefix", None) for u in model.by_type("IfcSIUnit") if u.UnitType == "LENGTHUNIT"],
    "Pipes and fittings belong to a system": lambda model: model.remove(model.by_type("IfcRelAssignsToGroup")[0]),
    "Pipes are rigid segments by their type": lambda model: setattr(model.by_type("IfcPipeSegment")[0], "PredefinedType", "RIGIDSEGMENT"),
    "Connectors are flanges": lambda model: [setattr(t, "ElementType", None) for t in model.by_type("IfcPipeFittingType")],
    "Ports are pipe ports of a component": lambda model: model.remove(model.by_type("IfcRelNests")[0]),
    "Pipes say how accurately they were measured": lambda model: rename_property(model, "LevelOfAccuracy"),
    "Dimensions of standards say how well they are sourced": lambda model: rename_property(model, "VerifiedGrade"),
}


def rename_property(model, name):
    for item in model.by_type("IfcPropertySingleValue"):
        if item.Name == name:
            item.Name = "Other"


@pytest.mark.parametrize("specification", UNACCEPTABLE)
def test_ids_finds_what_is_not_acceptable(opened, specifications, specification):
    model = opened("IFC4", "everything")
    UNACCEPTABLE[specification](model)
    assert specification in [fault.split(":")[0] for fault in ids_faults(specifications, model)]


# ---------------------------------------------------------------- geometry


@pytest.mark.slow
@every_small
def test_open_cascade_finds_the_analytic_volumes_and_boxes(opened, schema, plant):
    bodies = checks.occ_bodies(opened(schema, plant))
    assert checks.body_faults(bodies, pipeline_of(plant), volume=OCC_VOLUME, box_mm=BOX_MM) == []


@pytest.mark.slow
@pytest.mark.skipif(bool(checks.web_ifc_missing()), reason=checks.web_ifc_missing())
@every_small
def test_web_ifc_finds_the_analytic_volumes_and_boxes(path_of, schema, plant):
    bodies = checks.web_ifc_bodies(path_of(schema, plant))
    assert checks.body_faults(bodies, pipeline_of(plant), volume=WEB_IFC_VOLUME, box_mm=BOX_MM) == []


def test_body_check_finds_what_is_too_thin_or_elsewhere():
    pipeline = pipeline_of("everything")
    bodies = {component.id: checks.true_body(component) for component in pipeline.components}
    assert checks.body_faults(bodies, pipeline, volume=OCC_VOLUME, box_mm=BOX_MM) == []
    thin = bodies["E1"]
    bodies["E1"] = checks.Body(thin.volume * (1 - 2 * OCC_VOLUME), thin.low, thin.high + 2 * BOX_MM)
    assert len(checks.body_faults(bodies, pipeline, volume=OCC_VOLUME, box_mm=BOX_MM)) == 2


# ---------------------------------------------------------------- insulation

WOOL = {"thickness": 20.0, "material": "Mineral wool"}
COVERINGS = ("IfcCovering",)


@functools.cache
def insulated():
    pipeline = pipeline_of("everything")
    return dataclasses.replace(pipeline, components=tuple(dataclasses.replace(c, extra=c.extra | {"insulation": WOOL}) for c in pipeline.components))


def layer(component):
    """Return a pipe or elbow in the shape of its insulation."""
    thick = WOOL["thickness"]
    return dataclasses.replace(component, outer_diameter=component.outer_diameter + 2 * thick, wall_thickness=thick)


@pytest.fixture(scope="module", params=SCHEMAS)
def insulated_path(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("insulated") / "insulated.ifc"
    write_ifc(insulated(), path, IfcOptions(request.param, SECONDS))
    return path


@pytest.fixture
def insulated_model(insulated_path):
    return ifcopenshell.open(str(insulated_path))


@pytest.mark.slow
def test_insulation_is_valid_and_as_demanded(insulated_path, insulated_model, specifications):
    assert checks.command_faults(insulated_path) == []
    assert ids_faults(specifications, insulated_model) == []
    assert checks.property_set_faults(insulated_model) == []
    assert checks.port_faults(insulated_model, insulated()) == []


def test_insulation_is_a_part_of_its_component_and_placed_with_it(insulated_model):
    coverings = insulated_model.by_type("IfcCovering")
    assert len(coverings) == len(insulated().components)
    for covering in coverings:
        (whole,) = (relation.RelatingObject for relation in covering.Decomposes)
        assert whole.Tag == covering.Tag
        assert covering.ObjectPlacement.PlacementRelTo == whole.ObjectPlacement
        assert get_predefined_type(covering) == "INSULATION"
        assert not covering.ContainedInStructure  # it is where its component is
    assert not insulated_model.by_type("IfcRelCoversBldgElements")


def test_insulation_has_thickness_material_and_quantities(insulated_model):
    for covering in insulated_model.by_type("IfcCovering"):
        assert get_psets(covering)["Qto_CoveringBaseQuantities"]["Width"] == WOOL["thickness"]
        assert WOOL["material"] in {material.Name for material in get_materials(covering)}


@pytest.mark.slow
def test_open_cascade_finds_the_insulations_volume(insulated_model):
    straight = dataclasses.replace(insulated(), components=tuple(layer(c) for c in insulated().components if isinstance(c, Pipe | Elbow)))
    every = checks.occ_bodies(insulated_model, COVERINGS)
    bodies = {component.id: every[component.id] for component in straight.components}
    assert checks.body_faults(bodies, straight, volume=OCC_VOLUME, box_mm=BOX_MM) == []


@pytest.mark.slow
@pytest.mark.skipif(bool(checks.web_ifc_missing()), reason=checks.web_ifc_missing())
def test_web_ifc_finds_every_component_and_its_insulation(insulated_path):
    assert checks.body_faults(checks.web_ifc_bodies(insulated_path), insulated(), volume=WEB_IFC_VOLUME, box_mm=BOX_MM) == []
    bodies = checks.web_ifc_bodies(insulated_path, COVERINGS)
    assert set(bodies) == {component.id for component in insulated().components}
    for component in insulated().components:
        if isinstance(component, Pipe | Elbow):
            assert bodies[component.id].volume == pytest.approx(checks.true_body(layer(component)).volume, rel=WEB_IFC_VOLUME)


@pytest.mark.parametrize("thickness", [30.0, 60.0, 100.0])
def test_insulation_as_thick_as_plants_have_it_is_written(tmp_path, thickness):
    wool = {"insulation": WOOL | {"thickness": thickness}}
    components = tuple(dataclasses.replace(component, extra=wool) for component in pipeline_of("everything").components)
    path = tmp_path / "thick.ifc"
    write_ifc(dataclasses.replace(insulated(), components=components), path, IfcOptions(timestamp=SECONDS))
    assert checks.command_faults(path, rules=False) == []
    assert len(ifcopenshell.open(str(path)).by_type("IfcCovering")) == len(components)
