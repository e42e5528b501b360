# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC exported again: the same bytes for the same pipeline, few changes for a small one, and what others added stays."""

import dataclasses
import logging

import ifc_checks as checks
import ifcopenshell
import ifcopenshell.api.classification
import ifcopenshell.api.group
import ifcopenshell.api.pset
import ifcopenshell.guid
import ifcopenshell.validate
import pytest
from ifcopenshell.util.classification import get_references
from ifcopenshell.util.element import get_psets
from pipe_rack import pipe_rack

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, ifc_model, write_ifc
from pipeworkbench.pipeline import Pipe, Pipeline

RACK = pipe_rack(60)
SECONDS, LATER = 1_700_000_000, 1_700_100_000
MOVED_MM = (3.0, -2.0, 1.0)
every_schema = pytest.mark.parametrize("schema", SCHEMAS)
JOINED = next(joint.a for joint in RACK.joints if "-P" in joint.a)
NEIGHBOURS = {joint.b if joint.a == JOINED else joint.a for joint in RACK.joints if JOINED in (joint.a, joint.b)}


def with_pipe(pipeline, name, change):
    return dataclasses.replace(pipeline, components=tuple(change(c) if c.id == name else c for c in pipeline.components))


def shifted(pipe):
    start, end = (tuple(a + b for a, b in zip(point, MOVED_MM, strict=True)) for point in (pipe.start, pipe.end))
    return dataclasses.replace(pipe, start=start, end=end)


def signatures(model):
    """Return what each rooted entity says, with all that only serves it, by its GlobalId; other rooted ones count by their GlobalIds."""

    def told(value, *, top=False):
        if isinstance(value, tuple):
            return tuple(told(part) for part in value)
        if not isinstance(value, ifcopenshell.entity_instance):
            return value
        if value.is_a("IfcRoot") and not top:
            return value.GlobalId
        if value.is_a("IfcLocalPlacement") and not top:
            # where the parent is, is the parent's own business
            return (value.RelativePlacement and told(value.RelativePlacement), value.PlacementRelTo and "parent")
        return (value.is_a(), *(told(part) for part in value))

    return {item.GlobalId: told(item, top=True) for item in model.by_type("IfcRoot")}


@every_schema
def test_same_pipeline_at_the_same_time_gives_the_same_bytes(tmp_path, schema):
    for folder in ("one", "other"):
        (tmp_path / folder).mkdir()
        write_ifc(pipe_rack(60), tmp_path / folder / "rack.ifc", IfcOptions(schema, SECONDS))
    first = (tmp_path / "one" / "rack.ifc").read_bytes()
    assert (tmp_path / "other" / "rack.ifc").read_bytes() == first
    write_ifc(pipe_rack(60), tmp_path / "one" / "rack.ifc", IfcOptions(schema, SECONDS))  # over itself
    assert (tmp_path / "one" / "rack.ifc").read_bytes() == first


def test_json_in_between_changes_nothing(tmp_path):
    RACK.write(tmp_path / "rack.json")
    write_ifc(RACK, tmp_path / "rack.ifc", IfcOptions(timestamp=SECONDS))
    first = (tmp_path / "rack.ifc").read_bytes()
    write_ifc(Pipeline.read(tmp_path / "rack.json"), tmp_path / "rack.ifc", IfcOptions(timestamp=SECONDS))
    assert (tmp_path / "rack.ifc").read_bytes() == first


def test_another_time_changes_no_global_id():
    models = [ifc_model(RACK, options=IfcOptions(timestamp=when)) for when in (SECONDS, LATER)]
    first, second = (signatures(model) for model in models)
    assert list(first) == list(second)


@every_schema
@pytest.mark.parametrize("free", [True, False], ids=["free", "joined"])
def test_a_moved_pipe_changes_only_its_own_entities(schema, free):
    before = dataclasses.replace(RACK, joints=()) if free else RACK
    after = with_pipe(before, JOINED, shifted)
    options = IfcOptions(schema, SECONDS)
    old, new = (ifc_model(pipeline, options=options) for pipeline in (before, after))
    was, now = signatures(old), signatures(new)
    assert set(was) == set(now)
    changed = {key for key in was if was[key] != now[key]}
    products = checks.products_by_tag(old)
    own = {products[JOINED].GlobalId}
    assert own <= changed
    # the places of joints lie between both ends
    ports = {port.GlobalId for name in {JOINED} | NEIGHBOURS for port in checks.ports_of(products[name])}
    assert changed <= (own if free else own | ports)


def test_a_component_more_keeps_all_global_ids_and_properties():
    extra = Pipe(id="NEW", start=(0.0, -9000.0, 0.0), end=(0.0, -9000.0, 700.0), outer_diameter=60.3)
    options = IfcOptions(timestamp=SECONDS)
    models = [ifc_model(pipeline, options=options) for pipeline in (RACK, dataclasses.replace(RACK, components=(extra, *RACK.components)))]
    was, now = (signatures(model) for model in models)
    assert set(was) <= set(now)
    changed = {was[key][0] for key in was if was[key] != now[key]}
    # what counts everybody: who lies in the storey and who shares a property set
    assert changed <= {"IfcRelContainedInSpatialStructure", "IfcRelDefinesByProperties", "IfcRelAssociatesMaterial"}


def test_order_of_components_changes_no_global_id():
    backwards = dataclasses.replace(RACK, components=RACK.components[::-1], joints=RACK.joints[::-1])
    kept = {"IfcPipeSegment", "IfcPipeFitting", "IfcPipeSegmentType", "IfcPipeFittingType", "IfcDistributionPort", "IfcRelConnectsPorts"}
    models = [ifc_model(pipeline) for pipeline in (RACK, backwards)]  # entities live as long as their file
    first, second = ({item.GlobalId for item in model.by_type("IfcRoot") if item.is_a() in kept} for model in models)
    assert first == second


# ---------------------------------------------------------------- what others added


@pytest.fixture(params=SCHEMAS)
def extended(request, tmp_path):
    """A file to which others added things, the GlobalIds of what they added, and how it was written."""
    path, options = tmp_path / "rack.ifc", IfcOptions(request.param, SECONDS)
    write_ifc(RACK, path, options)
    model = ifcopenshell.open(str(path))
    products = checks.products_by_tag(model)
    gone = RACK.components[-1].id
    for name in (JOINED, gone):
        pset = ifcopenshell.api.pset.add_pset(model, product=products[name], name="Operator_Maintenance")
        ifcopenshell.api.pset.edit_pset(model, pset=pset, properties={"Inspected": "2026-11-01", "Note": "Ventil tropft"})
    of_type = ifcopenshell.util.element.get_type(products[JOINED])
    pset = ifcopenshell.api.pset.add_pset(model, product=of_type, name="Operator_Type")
    ifcopenshell.api.pset.edit_pset(model, pset=pset, properties={"Article": "4711"})
    system = ifcopenshell.api.classification.add_classification(model, classification="eCl@ss")
    ifcopenshell.api.classification.add_reference(
        model, products=[products[JOINED], products[gone]], identification="22-41-01", name="Pipe", classification=system
    )
    group = ifcopenshell.api.group.add_group(model, name="To be insulated")
    ifcopenshell.api.group.assign_group(model, products=[products[JOINED]], group=group)
    model.write(str(path))
    return path, options, gone


def added(path, name):
    model = ifcopenshell.open(str(path))
    product = checks.products_by_tag(model)[name]
    sets = get_psets(product)
    groups = [relation.RelatingGroup.Name for relation in product.HasAssignments if relation.RelatingGroup.is_a() == "IfcGroup"]
    references = [(reference.Identification, reference.ReferencedSource.Name) for reference in get_references(product)]
    return (sets.get("Operator_Maintenance", {}).get("Note"), sets.get("Operator_Type", {}).get("Article"), references, groups)


ADDED = ("Ventil tropft", "4711", [("22-41-01", "eCl@ss")], ["To be insulated"])


def statements(path):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    return logger.statements


def test_updating_keeps_what_others_added(extended):
    path, options, _ = extended
    assert added(path, JOINED) == ADDED
    write_ifc(with_pipe(RACK, JOINED, shifted), path, options)
    assert added(path, JOINED) == ADDED
    assert statements(path) == []


def test_updating_again_changes_nothing_any_more(extended):
    path, options, _ = extended
    write_ifc(RACK, path, options)
    first = path.read_bytes()
    write_ifc(RACK, path, options)
    assert path.read_bytes() == first


def test_updating_drops_what_belonged_to_components_that_are_gone(extended):
    path, options, gone = extended
    left = tuple(component for component in RACK.components if component.id != gone)
    write_ifc(dataclasses.replace(RACK, components=left, joints=tuple(j for j in RACK.joints if gone not in (j.a, j.b))), path, options)
    assert added(path, JOINED) == ADDED
    model = ifcopenshell.open(str(path))
    assert gone not in checks.products_by_tag(model)
    assert sum(item.Name == "Operator_Maintenance" for item in model.by_type("IfcPropertySet")) == 1
    assert statements(path) == []


def test_updating_does_not_mix_projects(extended):
    path, options, _ = extended
    write_ifc(dataclasses.replace(RACK, frame="another"), path, options)
    model = ifcopenshell.open(str(path))
    assert not model.by_type("IfcClassification")


def test_another_schema_over_what_others_added_is_refused(extended):
    path, options, _ = extended
    before = path.read_bytes()
    other = next(schema for schema in SCHEMAS if schema != options.schema)
    with pytest.raises(InputError, match=options.schema):
        write_ifc(RACK, path, IfcOptions(other, SECONDS))
    assert path.read_bytes() == before


def test_a_standard_set_that_others_put_beside_ours_does_not_make_two_of_one_name(extended):
    path, options, _ = extended
    model = ifcopenshell.open(str(path))
    product = checks.products_by_tag(model)[JOINED]
    colour = next(name for name in get_psets(product) if name.endswith("Occurrence"))
    pset = model.create_entity("IfcPropertySet", GlobalId=ifcopenshell.guid.new(), Name=colour, HasProperties=[note(model)])
    for relation in product.IsDefinedBy:
        if relation.is_a("IfcRelDefinesByProperties") and relation.RelatingPropertyDefinition.Name == colour:
            relation.RelatedObjects = [item for item in relation.RelatedObjects if item != product]
    rest = {"RelatedObjects": [product], "RelatingPropertyDefinition": pset}
    model.create_entity("IfcRelDefinesByProperties", GlobalId=ifcopenshell.guid.new(), **rest)
    model.write(str(path))
    write_ifc(RACK, path, options)
    again = ifcopenshell.open(str(path))
    assert [fault for fault in checks.property_set_faults(again) if "times" in fault] == []


def note(model):
    return model.create_entity("IfcPropertySingleValue", Name="InvertElevation", NominalValue=model.create_entity("IfcLengthMeasure", 12.0))


def test_a_file_that_is_no_ifc_is_replaced(tmp_path, caplog):
    path = tmp_path / "rack.ifc"
    path.write_text("ISO-10303-21;\nnot what it seems", encoding="utf-8")
    with caplog.at_level(logging.ERROR):
        write_ifc(RACK, path, IfcOptions(timestamp=SECONDS))
    assert statements(path) == []
    assert not caplog.records
