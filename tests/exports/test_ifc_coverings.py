# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC of planned insulation: layers, jacket, bodies and properties of every kind of covering, valid and stable."""

import dataclasses
import math

import ifc_checks as checks
import ifcopenshell
import ifcopenshell.geom
import numpy as np
import pytest
from ifcopenshell.util.element import get_predefined_type, get_psets, get_type
from ifcopenshell.util.placement import get_local_placement
from planned import JACKET, LAYERS, bend, plan_of, plan_of_everything, straight, tee

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, ifc_model, write_ifc
from pipeworkbench.exports.kinds import material_colour
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.plant import placed
from pipeworkbench.solids import Frame
from pipeworkbench.solids.covering_quantities import layer_volumes, outer_area
from pipeworkbench.solids.coverings import BlockNotch, BoxCovering, Layer, StopCovering
from pipeworkbench.solids.insulation import placed_bodies

IDS = checks.ROOT / "resources" / "ids" / "pipework_as_built.ids"
SECONDS = 1_700_000_000
COVERINGS = ("IfcCovering",)
OCC_VOLUME, WEB_IFC_VOLUME, BOX_MM = 1e-4, 5e-3, 0.5
INSULATION = {"insulation": {"thickness": 30, "material": "Mineral wool"}}
every_schema = pytest.mark.parametrize("schema", SCHEMAS)


@pytest.fixture(scope="module")
def plan(everything):
    return plan_of_everything(everything)


@pytest.fixture(scope="module", params=SCHEMAS)
def path(request, everything, plan, tmp_path_factory):
    path = tmp_path_factory.mktemp("planned") / "planned.ifc"
    write_ifc(everything, path, IfcOptions(request.param, SECONDS, plan))
    return path


@pytest.fixture
def model(path):
    return ifcopenshell.open(str(path))


@pytest.fixture(scope="module")
def truth(plan):
    """What every covering takes up, by its id, as the solids have it."""
    found = {}
    for piece in plan.pieces:
        solids = [body.solid for body in placed_bodies(piece.covering)]
        boxes = [solid.BoundingBox() for solid in solids]
        low = np.min([(box.xmin, box.ymin, box.zmin) for box in boxes], axis=0)
        high = np.max([(box.xmax, box.ymax, box.zmax) for box in boxes], axis=0)
        found[piece.covering.id] = checks.Body(sum(solid.Volume() for solid in solids), low, high)
    return found


def faults(bodies, truth, volume):
    """Return which coverings take up other volumes or lie elsewhere."""
    assert set(bodies) == set(truth)
    found = []
    for name, body in bodies.items():
        wanted = truth[name]
        if abs(body.volume / wanted.volume - 1) > volume:
            found.append(f"{name}: {body.volume:.0f} instead of {wanted.volume:.0f} mm3")
        off = max(np.abs(body.low - wanted.low).max(), np.abs(body.high - wanted.high).max())
        if off > BOX_MM:
            found.append(f"{name}: box off by {off:.3f} mm")
    return found


# ---------------------------------------------------------------- valid, and the same bodies in independent readers


@pytest.mark.slow
def test_ifcopenshells_commands_find_nothing(path):
    assert checks.command_faults(path) == []


def test_what_a_coordinator_demands_is_kept(model, everything):
    ids = pytest.importorskip("ifctester.ids", reason="ifctester is not installed")
    specifications = ids.open(str(IDS), validate=True)
    specifications.validate(model, should_filter_version=True)
    assert [one.name for one in specifications.specifications if one.is_ifc_version and not one.status] == []
    assert checks.property_set_faults(model) == []
    assert checks.type_faults(model, everything) == []
    assert checks.port_faults(model, everything) == []
    assert checks.system_faults(model, everything) == []


@pytest.mark.slow
def test_open_cascade_finds_the_volumes_and_boxes_of_the_solids(model, truth):
    assert faults(checks.occ_bodies(model, COVERINGS), truth, OCC_VOLUME) == []


@pytest.mark.slow
@pytest.mark.skipif(bool(checks.web_ifc_missing()), reason=checks.web_ifc_missing())
def test_web_ifc_finds_the_volumes_and_boxes_of_the_solids(path, truth):
    assert faults(checks.web_ifc_bodies(path, COVERINGS), truth, WEB_IFC_VOLUME) == []


@pytest.mark.slow
@pytest.mark.parametrize("gores", [3, 7])
@pytest.mark.parametrize("collars", [(0.0, 0.0), (12.0, 0.0), (15.0, 25.0)], ids=str)
def test_segmented_bends_have_the_volumes_of_the_formulas(everything, gores, collars):
    covering = bend(component(everything, "E1"), gores, collars)
    model = ifc_model(everything, options=IfcOptions(plan=plan_of(everything, [covering])))
    (body,) = checks.occ_bodies(model, COVERINGS).values()
    assert body.volume == pytest.approx(sum(layer_volumes(covering)), rel=1e-5)


@pytest.mark.slow
def test_where_the_bend_is_too_tight_two_pieces_meet_in_their_collars(everything, tmp_path):
    covering = bend(component(everything, "E1"), 2, (15.0, 25.0))
    covering = dataclasses.replace(covering, layers=(Layer("mineral wool", 40.0),))
    assert covering.radius + covering.total_thickness > covering.bend_radius
    path = tmp_path / "mitred.ifc"
    write_ifc(everything, path, IfcOptions(plan=plan_of(everything, [covering])))
    (body,) = checks.occ_bodies(ifcopenshell.open(str(path)), COVERINGS).values()
    assert body.volume == pytest.approx(sum(layer_volumes(covering)), rel=1e-5)
    if not checks.web_ifc_missing():
        (body,) = checks.web_ifc_bodies(path, COVERINGS).values()
        assert body.volume == pytest.approx(sum(layer_volumes(covering)), rel=WEB_IFC_VOLUME)


def component(pipeline, name):
    return next(one for one in pipeline.components if one.id == name)


@pytest.mark.slow
def test_a_branch_that_does_not_come_out_is_a_hole(everything):
    covering = dataclasses.replace(tee(component(everything, "T1"), 0.0), reach=0.0)
    model = ifc_model(everything, options=IfcOptions(plan=plan_of(everything, [covering])))
    (body,) = checks.occ_bodies(model, COVERINGS).values()
    assert body.volume == pytest.approx(sum(layer_volumes(covering)), rel=OCC_VOLUME)


@pytest.mark.slow
def test_a_block_is_cut_out_as_it_stands(everything):
    pipe = component(everything, "P4")
    turn = np.array([(0.8, 0.6, 0.0), (-0.6, 0.8, 0.0), (0.0, 0.0, 1.0)])
    block = BlockNotch("wall", Frame(np.array((30.0, -50.0, 40.0)), *turn), np.array((100.0, 200.0, 70.0)))
    covering = straight(pipe, notches=(block,))
    model = ifc_model(everything, options=IfcOptions(plan=plan_of(everything, [covering])))
    (body,) = checks.occ_bodies(model, COVERINGS).values()
    whole = sum(layer_volumes(covering))
    missing = whole - body.volume
    # the block's side x = 30 in its own turned axes cuts off a part of each circle: seen from the axis it is a segment
    distance = float(np.array((30.0, -50.0)) @ turn[0, :2])
    outer, inner = pipe.outer_diameter / 2 + covering.total_thickness, pipe.outer_diameter / 2
    assert abs(distance) < inner
    assert missing == pytest.approx(70.0 * (segment(outer, distance) - segment(inner, distance)), rel=1e-4)


def segment(radius, distance):
    """Return the area of a circle beyond a line at a distance from its middle."""
    return radius**2 * math.acos(distance / radius) - distance * math.sqrt(radius**2 - distance**2)


# ---------------------------------------------------------------- what is said


def by_tag(model):
    return checks.products_by_tag(model, COVERINGS)


def test_coverings_are_parts_of_the_components_they_lie_around(model, plan):
    found = by_tag(model)
    assert set(found) == {piece.covering.id for piece in plan.pieces}
    for piece in plan.pieces:
        item = found[piece.covering.id]
        (whole,) = (relation.RelatingObject for relation in item.Decomposes)
        assert whole.Tag == piece.covering.component
        assert item.ObjectPlacement.PlacementRelTo == whole.ObjectPlacement
        assert get_predefined_type(item) == "INSULATION"
        assert not item.ContainedInStructure
    assert not model.by_type("IfcRelCoversBldgElements")  # deprecated
    aggregates = [relation.RelatingObject for relation in model.by_type("IfcRelAggregates")]
    assert len(set(aggregates)) == len(aggregates)


def test_coverings_are_placed_as_in_the_plan(model, plan):
    found = by_tag(model)
    for piece in plan.pieces:
        matrix = get_local_placement(found[piece.covering.id].ObjectPlacement)
        assert matrix == pytest.approx(np.array(piece.covering.frame.matrix), abs=1e-6)


def test_layers_and_jacket_are_a_layer_set_from_the_inside_to_the_outside(model, plan):
    found = by_tag(model)
    for piece in plan.pieces:
        covering = piece.covering
        (relation,) = get_type(found[covering.id]).HasAssociations
        told = [(layer.Material.Name, layer.LayerThickness, layer.Category) for layer in relation.RelatingMaterial.MaterialLayers]
        wanted = [(layer.material, layer.thickness, "Insulation") for layer in covering.layers]
        assert told == wanted + ([(covering.sheet.material, covering.sheet.thickness, "Finish")] if covering.sheet else [])


def test_coverings_of_one_build_share_a_type(model, plan):
    builds = {(piece.covering.layers, piece.covering.sheet) for piece in plan.pieces}
    types = model.by_type("IfcCoveringType")
    assert len(types) == len(builds)
    assert len({item.Name for item in types}) == len(types)
    assert "Insulation 15 mm, mineral wool; 10 mm, elastomeric foam; jacket 0.8 mm, aluminium" in {item.Name for item in types}


def test_thickness_and_area_are_base_quantities(model, plan):
    found = by_tag(model)
    for piece in plan.pieces:
        covering = piece.covering
        said = get_psets(found[covering.id])["Qto_CoveringBaseQuantities"]
        assert said["Width"] == pytest.approx(covering.total_thickness)
        assert said["GrossArea"] == pytest.approx(outer_area(covering) * 1e-6, rel=1e-6)
        assert ("NetArea" in said) == (not covering.notches)


def test_each_layers_thickness_material_and_volume_are_properties(model, plan):
    found = by_tag(model)
    for piece in plan.pieces:
        covering = piece.covering
        said = get_psets(found[covering.id])
        build, own = said["PipeWorkbench_InsulationBuild"], said["PipeWorkbench_Insulation"]
        assert build["NumberOfLayers"] == len(covering.layers)
        for number, layer in enumerate(covering.layers, 1):
            assert (build[f"Layer{number}Material"], build[f"Layer{number}Thickness"]) == (layer.material, layer.thickness)
        volumes = [own[f"Layer{number}Volume"] for number in range(1, len(covering.layers) + 1)]
        if covering.sheet:
            assert (build["JacketMaterial"], build["JacketThickness"]) == (JACKET.material, JACKET.thickness)
            volumes.append(own["JacketVolume"])
        assert volumes == pytest.approx([volume * 1e-9 for volume in layer_volumes(covering)], rel=1e-6)
        assert (own["Run"], own["Kind"]) == (piece.run, covering.kind)
        assert said["Pset_CoveringCommon"]["Status"] == ["NEW"]


def test_a_box_names_all_that_it_goes_over_and_a_notch_what_it_is_for(model):
    found = by_tag(model)
    assert get_psets(found["I-F1"])["PipeWorkbench_Insulation"]["Components"] == "F1, F2"
    assert get_psets(found["I-P4"])["PipeWorkbench_Insulation"]["CutFor"] == "bracket"
    assert get_psets(found["I-E1"])["PipeWorkbench_Insulation"]["NumberOfGores"] == 4


def test_every_item_has_the_colour_of_its_material(model, plan):
    found = by_tag(model)
    for piece in plan.pieces:
        covering = piece.covering
        (shape,) = found[covering.id].Representation.Representations
        assert all(len(item.StyledByItem) == 1 for item in shape.Items)
        styles = {item.StyledByItem[0].Styles[0] for item in shape.Items}
        shown = {style.Name: style.Styles[0].SurfaceColour for style in styles}
        materials = {layer.material: False for layer in covering.layers} | ({covering.sheet.material: True} if covering.sheet else {})
        assert set(shown) == set(materials)
        for name, colour in shown.items():
            assert (colour.Red, colour.Green, colour.Blue) == pytest.approx(material_colour(name, jacket=materials[name]))


# ---------------------------------------------------------------- plans and what components say


def test_a_plan_stands_for_what_components_say(everything):
    pipe = component(everything, "P1")
    said = dataclasses.replace(everything, components=tuple(dataclasses.replace(one, extra=INSULATION) for one in everything.components))
    model = ifc_model(said, options=IfcOptions(plan=plan_of(said, [straight(pipe)])))
    assert set(by_tag(model)) == {"I-P1"}
    assert set(by_tag(ifc_model(said))) == {one.id for one in said.components}


def test_coverings_of_components_that_are_not_written_are_left_out(everything, plan):
    part = Pipeline(frame=everything.frame, components=(component(everything, "P1"),))
    assert set(by_tag(ifc_model(part, options=IfcOptions(plan=plan)))) == {"I-P1"}


def test_two_coverings_of_one_id_are_refused(everything):
    twice = plan_of(everything, [straight(component(everything, "P1"))] * 2)
    with pytest.raises(InputError, match="I-P1"):
        ifc_model(everything, options=IfcOptions(plan=twice))


def test_far_from_the_origin_coverings_stay_on_their_components(everything):
    cosine, sine = math.cos(0.6), math.sin(0.6)
    turn = ((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0))
    matrix = (*((*row, shift) for row, shift in zip(turn, (3.5e9, 5.4e9, 1e5), strict=True)), (0.0, 0.0, 0.0, 1.0))
    far = placed(everything, matrix, "EPSG:25832")
    # plans are made where the pipeline is
    near_plan, far_plan = plan_of_everything(everything), plan_of_everything(far)
    near, shifted = (ifc_model(pipeline, options=IfcOptions(plan=plan)) for pipeline, plan in ((everything, near_plan), (far, far_plan)))
    for name, item in by_tag(near).items():
        here, there = (get_local_placement(one.ObjectPlacement) for one in (item, by_tag(shifted)[name]))
        # what is left of a coordinate of 5,000 km is a micrometre; up stays up, and a vertical pipe's x is any
        assert there[:3, 3] == pytest.approx(here[:3, 3], abs=1e-2)
        assert there[:3, 2] == pytest.approx(here[:3, 2], abs=1e-5)


# ---------------------------------------------------------------- exported again


def global_ids(model):
    return {item.GlobalId for item in model.by_type("IfcRoot")}


@every_schema
def test_the_same_plan_at_the_same_time_gives_the_same_bytes(everything, tmp_path, schema):
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        write_ifc(everything, tmp_path / name / "plan.ifc", IfcOptions(schema, SECONDS, plan_of_everything(everything)))
    first = (tmp_path / "one" / "plan.ifc").read_bytes()
    assert (tmp_path / "other" / "plan.ifc").read_bytes() == first
    write_ifc(everything, tmp_path / "one" / "plan.ifc", IfcOptions(schema, SECONDS, plan_of_everything(everything)))  # over itself
    assert (tmp_path / "one" / "plan.ifc").read_bytes() == first


def test_a_thicker_layer_keeps_the_coverings_global_ids(everything, plan):
    thicker = [
        piece.covering
        if isinstance(piece.covering, StopCovering | BoxCovering)
        else dataclasses.replace(piece.covering, layers=(dataclasses.replace(LAYERS[0], thickness=12.0), *piece.covering.layers[1:]))
        for piece in plan.pieces
    ]
    models = [ifc_model(everything, options=IfcOptions(plan=one)) for one in (plan, plan_of(everything, thicker))]
    before, after = ({item.Tag: item.GlobalId for item in model.by_type("IfcCovering")} for model in models)
    assert before == after


def test_a_plan_changes_no_global_id_of_the_pipework(everything, plan):
    without, planned = (ifc_model(everything, options=IfcOptions(timestamp=SECONDS, plan=one)) for one in (None, plan))
    assert global_ids(without) <= global_ids(planned)
    added = {item.is_a() for item in planned.by_type("IfcRoot") if item.GlobalId not in global_ids(without)}
    assert added == {
        "IfcCovering",
        "IfcCoveringType",
        "IfcElementQuantity",
        "IfcPropertySet",
        "IfcRelAggregates",
        "IfcRelAssociatesMaterial",
        "IfcRelDefinesByProperties",
        "IfcRelDefinesByType",
    }


def test_what_others_added_to_a_covering_stays(everything, plan, tmp_path):
    path, options = tmp_path / "plan.ifc", IfcOptions(timestamp=SECONDS, plan=plan)
    write_ifc(everything, path, options)
    model = ifcopenshell.open(str(path))
    note = model.create_entity("IfcPropertySingleValue", Name="Checked", NominalValue=model.create_entity("IfcBoolean", True))
    pset = model.create_entity("IfcPropertySet", GlobalId=ifcopenshell.guid.new(), Name="Site_Notes", HasProperties=[note])
    related = {"RelatedObjects": [by_tag(model)["I-E1"]], "RelatingPropertyDefinition": pset}
    model.create_entity("IfcRelDefinesByProperties", GlobalId=ifcopenshell.guid.new(), **related)
    model.write(str(path))
    write_ifc(everything, path, options)
    again = ifcopenshell.open(str(path))
    assert get_psets(by_tag(again)["I-E1"])["Site_Notes"]["Checked"] is True
    assert checks.property_set_faults(again) == []
