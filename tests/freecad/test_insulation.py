# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation in a document, without a window: its shape, what it follows, undo, saving, neighbours, bad input."""

import json
from dataclasses import replace
from pathlib import Path

import FreeCAD
import pytest

from pipeworkbench import features
from pipeworkbench.errors import InputError
from pipeworkbench.features.document import add_pipeline, components_in
from pipeworkbench.features.exporting import TAKE_OFF, export_document
from pipeworkbench.features.insulation import change_insulation, insulations_in, plans_of, run_of
from pipeworkbench.features.insulation_settings import Settings, choices_of, set_settings, settings_of
from pipeworkbench.features.transactions import transaction
from pipeworkbench.insulation.materials import materials
from pipeworkbench.insulation.rules import Changes, ComponentRule, LayerSpec, Match
from pipeworkbench.insulation.specification import Obstacle, Specification
from pipeworkbench.insulation.thickness import TableRule
from pipeworkbench.pipeline import Elbow, Joint, Pipe, Pipeline
from pipeworkbench.solids.covering_quantities import layer_volumes, outer_area

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")
RADIUS = 76.0


def pipe(name, start, end, diameter=60.3, station="A"):
    return Pipe(id=name, start=start, end=end, outer_diameter=diameter, wall_thickness=2.9, station=station)


def corner(shift=0.0, names=("P1", "E1", "P2"), station="A"):
    """Return two pipes at a right angle with the elbow between them, and their joints."""
    first, bend, second = names
    return (
        (
            pipe(first, (0.0, shift, 0.0), (1000.0, shift, 0.0), station=station),
            Elbow(
                id=bend,
                start=(1000.0, shift, 0.0),
                end=(1000.0 + RADIUS, shift, RADIUS),
                intersection=(1000.0 + RADIUS, shift, 0.0),
                angle_deg=90.0,
                bend_radius=RADIUS,
                outer_diameter=60.3,
                wall_thickness=2.9,
                station=station,
            ),
            pipe(second, (1000.0 + RADIUS, shift, RADIUS), (1000.0 + RADIUS, shift, 900.0), station=station),
        ),
        (Joint(a=first, a_port=1, b=bend, b_port=0), Joint(a=bend, a_port=1, b=second, b_port=0)),
    )


@pytest.fixture
def bent(document):
    """The document with a bent run."""
    components, joints = corner()
    with transaction(document, "Measure"):
        add_pipeline(document, replace(Pipeline.of_station("A", components), joints=joints))
    return document


def component(document, name):
    return next(obj for obj in components_in(document) if obj.ComponentId == name)


def insulated(document, objects=None, **settings):
    with transaction(document, "Insulate"):
        return features.make_insulation(document, objects, **settings)


def volume_of_plan(document, names=None):
    """Return the volume of all layers and jackets by the formulas."""
    pieces = [piece for plan in plans_of(document) for piece in plan.pieces]
    return sum(sum(layer_volumes(piece.covering)) for piece in pieces if names is None or piece.covering.component in names)


def assert_whole(obj):
    assert not obj.Problems, obj.Problems
    assert "Invalid" not in obj.State
    assert obj.Shape.isValid()
    assert len(obj.Shape.SubShapes) == obj.Pieces > 0


def test_insulation_is_a_valid_compound_of_the_volume_that_formulas_give(bent):
    obj = insulated(bent, thickness=30.0)
    assert_whole(obj)
    assert obj.Shape.Volume == pytest.approx(volume_of_plan(bent), rel=1e-6)
    coverings = [piece.covering for piece in features.plan_of(bent).pieces]
    assert obj.Pieces == len(coverings) == 5  # two pipes, a bend, two stops at the open ends
    assert obj.InsulationVolume.Value == pytest.approx(sum(layer_volumes(c)[0] for c in coverings if c.layers))
    assert obj.JacketArea.Value == pytest.approx(sum(outer_area(c) for c in coverings))
    assert {c.sheet.material for c in coverings} == {"aluminium"}


def test_everything_there_is_can_be_insulated(document):
    add_pipeline(document, EVERYTHING)
    obj = insulated(document, thickness=20.0)
    assert obj.Shape.isValid()
    assert obj.Shape.Volume == pytest.approx(volume_of_plan(document), rel=1e-4)
    bare = {name for plan in plans_of(document) for name in plan.bare}
    kinds = {one.kind for one in EVERYTHING.components if one.id not in bare}
    assert kinds >= {"pipe", "elbow", "flange", "tee", "reducer", "cap"}, (bare, obj.Problems)


def test_insulation_follows_a_changed_diameter_and_models_nothing_else_anew(bent, monkeypatch):
    components, joints = corner(2000.0, ("Q1", "E2", "Q2"))
    add_pipeline(bent, replace(Pipeline.of_station("A", components), joints=joints))
    obj = insulated(bent, thickness=30.0)
    before, keys = obj.Shape.Volume, set(obj.PieceKeys)
    component(bent, "P1").OutsideDiameter = 48.3
    bent.recompute()
    assert_whole(obj)
    assert obj.Shape.Volume == pytest.approx(volume_of_plan(bent), rel=1e-6)
    assert obj.Shape.Volume < before
    assert len(keys & set(obj.PieceKeys)) == 5  # those of the other run


def test_insulation_follows_a_moved_pipe(bent):
    obj = insulated(bent, [component(bent, "P2")], thickness=30.0)
    before = obj.Shape.BoundBox.ZMax
    component(bent, "P2").Length = component(bent, "P2").Length.Value + 250
    bent.recompute()
    assert obj.Shape.BoundBox.ZMax == pytest.approx(before + 250, abs=1e-6)


def test_insulation_follows_its_own_settings(bent):
    obj = insulated(bent, thickness=30.0, jacket="none")
    obj.Thickness = 20
    obj.SecondMaterial = "glass wool"
    obj.SecondThickness = 15
    obj.Jacket = "galvanised steel"
    obj.Gores = 5
    bent.recompute()
    assert_whole(obj)
    piece = features.plan_of(bent).piece_of("E1")
    assert [(layer.material, layer.thickness) for layer in piece.covering.layers] == [("mineral wool", 20.0), ("glass wool", 15.0)]
    assert (piece.covering.sheet.material, piece.covering.gores) == ("galvanised steel", 5)
    assert obj.Shape.Volume == pytest.approx(volume_of_plan(bent), rel=1e-6)


def test_undo_and_redo_take_insulation_back_and_forth(bent):
    obj = insulated(bent, thickness=30.0)
    volume = obj.Shape.Volume
    with transaction(bent, "Thicker"):
        obj.Thickness = 40
    thicker = obj.Shape.Volume
    bent.undo()
    assert (obj.Thickness.Value, obj.Shape.Volume) == (30, pytest.approx(volume))
    bent.recompute()
    assert obj.Shape.Volume == pytest.approx(volume)
    bent.redo()
    assert obj.Shape.Volume == pytest.approx(thicker)
    bent.undo()
    bent.undo()
    assert not insulations_in(bent)
    bent.redo()
    assert_whole(insulations_in(bent)[0])


def test_insulation_survives_saving_and_opening(bent, tmp_path):
    specification = Specification(rules=(ComponentRule(match=Match(ids=("P2",)), changes=Changes(layers=(LayerSpec("glass wool", 20.0),))),))
    made = insulated(bent, specification=specification, thickness=30.0, medium_temperature=90.0, wind_speed=2.5)
    settings, volume, keys = settings_of(made), made.Shape.Volume, list(made.PieceKeys)
    bent.saveAs(str(tmp_path / "insulated.FCStd"))
    FreeCAD.closeDocument(bent.Name)
    again = FreeCAD.openDocument(str(tmp_path / "insulated.FCStd"))
    obj = insulations_in(again)[0]
    assert settings_of(obj) == settings
    assert obj.Shape.Volume == pytest.approx(volume)
    again.recompute(None, True)
    assert_whole(obj)
    assert obj.PieceKeys == keys
    assert features.plan_of(again).piece_of("P2").covering.layers[0].material == "glass wool"
    component(again, "P1").Length = 700
    again.recompute()
    assert obj.Shape.Volume < volume


def test_deleted_component_leaves_the_insulation_and_comes_back_with_undo(bent):
    obj = insulated(bent, thickness=30.0)
    volume = obj.Shape.Volume
    with transaction(bent, "Delete"):
        bent.removeObject(component(bent, "P2").Name)
    assert {one.ComponentId for one in obj.Components} == {"P1", "E1"}
    assert_whole(obj)
    assert obj.Shape.Volume < volume
    bent.undo()
    bent.recompute()
    assert {one.ComponentId for one in obj.Components} == {"P1", "E1", "P2"}
    assert obj.Shape.Volume == pytest.approx(volume)


def test_insulation_without_components_says_so(bent):
    obj = insulated(bent, thickness=30.0)
    for name in ("P1", "E1", "P2"):
        bent.removeObject(component(bent, name).Name)
    bent.recompute()
    assert "no components" in obj.Problems[0]
    assert obj.Pieces == 0
    assert obj.Shape.isNull() or not obj.Shape.Solids


def test_two_insulations_side_by_side_fit_and_the_later_one_wins(bent):
    whole = insulated(bent, thickness=30.0)
    volume = whole.Shape.Volume
    hot = insulated(bent, [component(bent, "P2")], thickness=60.0, medium_temperature=200.0)
    for obj in (whole, hot):
        assert_whole(obj)
    assert whole.Shape.Volume < volume
    assert whole.Shape.Volume + hot.Shape.Volume == pytest.approx(volume_of_plan(bent), rel=1e-6)
    assert any("P2 is insulated by" in remark for remark in whole.Remarks)
    assert features.plan_of(bent).piece_of("P2").covering.thickness == 60
    bent.removeObject(hot.Name)
    bent.recompute()
    assert whole.Shape.Volume == pytest.approx(volume)


def test_insulation_is_planned_anew_where_only_its_neighbour_changes(bent):
    bend = insulated(bent, [component(bent, "E1"), component(bent, "P1")], thickness=30.0)
    other = insulated(bent, [component(bent, "P2")], thickness=30.0)
    before = bend.Pieces
    other.Components = []
    bent.recompute()
    assert bend.Pieces == before + 1  # a stop closes the bend's end
    assert bend.Shape.Volume == pytest.approx(volume_of_plan(bent, {"E1", "P1"}), rel=1e-6)
    other.Components = [component(bent, "P2")]
    bent.recompute()
    assert bend.Pieces == before
    # what an expression changes while the document is recomputed counts, too
    component(bent, "P2").setExpression("Length", "500 mm")
    bent.recompute()
    assert other.PlannedFrom == bend.PlannedFrom
    assert other.Shape.Volume == pytest.approx(volume_of_plan(bent, {"P2"}), rel=1e-6)


def test_thickness_that_does_not_fit_leaves_that_component_bare_and_says_what_would_fit(bent):
    obj = insulated(bent, thickness=30.0, tight_bends="refuse", bend_shape="smooth")
    obj.Thickness = 400
    bent.recompute()
    assert obj.Problems
    assert any("E1" in problem for problem in obj.Problems)
    assert any(any(character.isdigit() for character in problem.split(";")[-1]) for problem in obj.Problems)
    assert obj.Shape.Solids  # the others keep theirs
    obj.Thickness = 20
    bent.recompute()
    assert_whole(obj)


def test_wrong_value_of_a_property_is_a_problem_of_this_object_alone(bent):
    one = insulated(bent, [component(bent, "P1")], thickness=30.0)
    other = insulated(bent, [component(bent, "P2")], thickness=30.0)
    one.Thickness = 0
    other.Efficiency = 0.8
    bent.recompute()
    assert ["thickness: is 0 mm" in problem for problem in one.Problems] == [True]
    assert_whole(other)
    other.Efficiency = -1
    bent.recompute()
    assert any("efficiency" in problem for problem in other.Problems)


@pytest.mark.parametrize(
    ("settings", "key"),
    [
        ({"thickness": 0.0}, "thickness"),
        ({"material": "marshmallow"}, "material"),
        ({"gores": 1}, "gores"),
        ({"further_layers": ("much",)}, "layers"),
    ],
    ids=str,
)
def test_what_does_not_fit_is_refused_before_anything_is_made(bent, settings, key):
    with pytest.raises(InputError, match=key):
        features.make_insulation(bent, None, **settings)
    assert not insulations_in(bent)


def test_component_that_makes_no_sense_keeps_no_other_from_being_insulated(bent):
    add_pipeline(bent, Pipeline.of_station("A", (pipe("Q1", (0.0, 900.0, 0.0), (1000.0, 900.0, 0.0)),)))
    obj = insulated(bent, [component(bent, name) for name in ("P1", "E1", "P2")], thickness=30.0)
    component(bent, "Q1").WallThickness = 55
    obj.Thickness = 20
    bent.recompute()
    assert_whole(obj)
    assert obj.Shape.Volume == pytest.approx(volume_of_plan(bent), rel=1e-6)


def test_stations_that_are_not_merged_are_planned_by_themselves(bent):
    components, joints = corner(0.0, ("Q1", "E2", "Q2"), "B")
    add_pipeline(bent, replace(Pipeline.of_station("B", components), joints=joints))
    obj = insulated(bent, thickness=30.0)
    assert_whole(obj)
    assert len(plans_of(bent)) == 2
    assert not obj.Clashes  # B's frame is not A's
    with pytest.raises(InputError, match="not merged"):
        features.plan_of(bent)


def test_heat_loss_is_told_where_the_temperature_of_the_medium_is_known(bent):
    obj = insulated(bent, thickness=50.0)
    assert (obj.HeatLossBare, obj.HeatLossInsulated) == (0, 0)
    obj.MediumTemperature = 90
    bent.recompute()
    assert obj.HeatLossBare > 5 * obj.HeatLossInsulated > 0


def test_clashes_are_listed_with_their_distance(bent):
    beside = pipe("Q1", (0.0, 200.0, 0.0), (1000.0, 200.0, 0.0))
    add_pipeline(bent, Pipeline.of_station("A", (beside,)))
    obj = insulated(bent, thickness=40.0, jacket="none")
    assert any({"P1", "Q1"} <= set(text.split(":")[0].split(" and ")) and "60 mm apart" in text for text in obj.Clashes)
    obj.MinimumDistance = 50
    bent.recompute()
    assert not obj.Clashes


def test_rules_of_a_specification_hold_and_its_default_becomes_properties(bent):
    specification = Specification(
        default=Changes(layers=(LayerSpec("glass wool", TableRule()), LayerSpec("mineral wool", 20.0)), bends={"gores": 4}),
        rules=(ComponentRule(match=Match(kinds=("elbow",)), changes=Changes(layers=(LayerSpec("foam glass", 30.0),))),),
        obstacles=(Obstacle(id="column", start=(500.0, 100.0, -500.0), end=(500.0, 100.0, 500.0), diameter=50.0),),
    )
    obj = features.apply_specification(bent, specification)
    bent.recompute()
    assert (obj.Material, obj.ThicknessRule, obj.SecondThickness.Value, obj.Gores) == ("glass wool", "GEG Annex 8, full", 20, 4)
    plan = features.plan_of(bent)
    assert plan.piece_of("E1").covering.layers[0].material == "foam glass"
    assert len(plan.piece_of("P1").covering.layers) == 2
    assert plan.specification.obstacles == specification.obstacles
    again = features.insulation_of(obj).specification
    assert Settings.of(again) == settings_of(obj)
    obj.SecondMaterial = "none"
    bent.recompute()
    assert len(features.plan_of(bent).piece_of("P1").covering.layers) == 1


def test_settings_come_back_from_properties_and_specifications_as_they_were(bent):
    settings = Settings(
        material="glass wool",
        thickness=25.5,
        second_material="foam glass",
        second_thickness=10.0,
        further_layers=("12.5 mm mineral wool",),
        jacket="stainless steel",
        sheet_thickness=0.8,
        stagger=45.0,
        gores=6,
        first_gore="longer",
        first_gore_extra=12.0,
        tight_bends="refuse",
        flange_cover="bare",
        valve_length=900.0,
        medium_temperature=-40.0,
        ambient_temperature=30.0,
        wind_speed=3.5,
        price_per_kwh=0.12,
        co2_per_kwh=0.2,
        efficiency=0.85,
        bead=True,
    )
    assert Settings.of(settings.specification()) == settings
    obj = features.make_insulation(bent, None)
    set_settings(obj, settings)
    assert settings_of(obj) == settings


def test_lists_offer_what_the_catalogue_has(bent):
    obj = features.make_insulation(bent, None)
    assert obj.getEnumerationsOfProperty("Material") == [material.name for material in materials()]
    assert obj.getEnumerationsOfProperty("BendShape") == ["segmented", "smooth"] == list(choices_of("bend_shape"))
    assert obj.getEnumerationsOfProperty("Jacket")[0] == obj.getEnumerationsOfProperty("SecondMaterial")[0] == "none"


def test_changing_an_insulation_is_one_step_of_undo(bent):
    obj = insulated(bent, thickness=30.0)
    with transaction(bent, "Change"):
        change_insulation(obj, Settings(thickness=20.0, jacket="none"), [component(bent, "P1")])
    assert ([one.ComponentId for one in obj.Components], obj.Jacket) == (["P1"], "none")
    bent.undo()
    assert (len(obj.Components), obj.Thickness.Value, obj.Jacket) == (3, 30, "aluminium")


def test_pasted_insulation_holds_what_the_copy_holds(bent):
    obj = insulated(bent, thickness=30.0)
    copy = bent.copyObject(obj, False)
    bent.recompute()
    assert [one.ComponentId for one in copy.Components] == [one.ComponentId for one in obj.Components]
    assert (obj.Pieces, copy.Pieces) == (0, 5)
    assert any("is insulated by" in remark for remark in obj.Remarks)


def test_run_is_what_hangs_together(bent):
    add_pipeline(bent, Pipeline.of_station("A", (pipe("Q1", (0.0, 900.0, 0.0), (1000.0, 900.0, 0.0)),)))
    assert {obj.ComponentId for obj in run_of([component(bent, "E1")])} == {"P1", "E1", "P2"}


def test_insulation_of_a_newer_version_is_left_alone(bent):
    obj = insulated(bent, thickness=30.0)
    volume = obj.Shape.Volume
    obj.SchemaVersion = 99
    obj.Thickness = 50
    bent.recompute()
    assert obj.Shape.Volume == pytest.approx(volume)
    with pytest.raises(InputError, match="update"):
        change_insulation(obj, Settings(), obj.Components)
    assert not insulations_in(bent)


def test_insulation_is_written_in_the_format_of_the_ending(bent, tmp_path):
    insulated(bent, thickness=30.0)
    for name in ("sheets.dxf", "list.csv"):
        features.export_insulation(bent, tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    with pytest.raises(InputError, match="unknown ending"):
        features.export_insulation(bent, tmp_path / "sheets.doc")


def test_nothing_is_written_where_nothing_is_insulated(bent, tmp_path):
    with pytest.raises(InputError, match="nothing is insulated"):
        features.export_insulation(bent, tmp_path / "sheets.dxf")


@pytest.mark.parametrize("ending", [".ifc", ".step", ".pcf"])
def test_models_carry_the_insulation_unless_it_is_left_out(bent, tmp_path, ending):
    """What the formats say of aluminium jackets or of insulation, which bare pipework never says."""
    mark = {".ifc": b"IFCCOVERING(", ".step": b"'P1 jacket", ".pcf": b"INSULATION ON"}[ending]
    insulated(bent, thickness=30.0)
    export_document(bent, tmp_path / f"with{ending}")
    export_document(bent, tmp_path / f"without{ending}", insulation=False)
    assert mark in (tmp_path / f"with{ending}").read_bytes()
    assert mark not in (tmp_path / f"without{ending}").read_bytes()


def test_selected_components_are_exported_with_their_own_insulation(bent, tmp_path):
    insulated(bent, [component(bent, "P1"), component(bent, "E1")], thickness=30.0)
    export_document(bent, tmp_path / "one.pcf", [component(bent, "P1"), component(bent, "P2")])
    assert (tmp_path / "one.pcf").read_text(encoding="utf-8").count("INSULATION ON") == 1
    export_document(bent, tmp_path / "bare.pcf", [component(bent, "P2")])
    assert "INSULATION ON" not in (tmp_path / "bare.pcf").read_text(encoding="utf-8")
    with pytest.raises(InputError, match="nothing is insulated"):
        export_document(bent, tmp_path / "bare.dxf", [component(bent, "P2")])


def test_insulation_of_the_exported_station_alone_counts_where_stations_are_not_merged(bent, tmp_path):
    components, joints = corner(0.0, ("Q1", "E2", "Q2"), "B")
    add_pipeline(bent, replace(Pipeline.of_station("B", components), joints=joints))
    insulated(bent, [component(bent, "Q1")], thickness=30.0)
    insulated(bent, [component(bent, name) for name in ("P1", "E1")], thickness=30.0)
    with pytest.raises(InputError, match="merge"):
        export_document(bent, tmp_path / "all.pcf")
    export_document(bent, tmp_path / "one.pcf", [component(bent, name) for name in ("P1", "E1", "P2")])
    assert (tmp_path / "one.pcf").read_text(encoding="utf-8").count("INSULATION ON") == 2


@pytest.mark.parametrize("ending", [".dxf", ".pdf", ".xlsx"])
def test_cut_sheets_and_lists_are_exported_where_something_is_insulated(bent, tmp_path, ending):
    with pytest.raises(InputError, match="nothing is insulated"):
        export_document(bent, tmp_path / f"cut{ending}")
    insulated(bent, thickness=30.0)
    with pytest.raises(InputError, match="no folder"):
        export_document(bent, tmp_path / "nowhere" / f"cut{ending}")
    export_document(bent, tmp_path / f"cut{ending}", insulation=False)
    assert (tmp_path / f"cut{ending}").stat().st_size > 1000


def test_take_off_list_is_told_apart_from_the_table_by_its_key(bent, tmp_path):
    export_document(bent, tmp_path / "table.csv")
    export_document(bent, tmp_path / "list.csv", key=TAKE_OFF)
    assert (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()[0].startswith("id,")
    assert (tmp_path / "list.csv").read_text(encoding="utf-8").splitlines()[0].startswith("item,kind,")
    with pytest.raises(InputError, match=r"use one of \.csv"):
        export_document(bent, tmp_path / "list.ifc", key=TAKE_OFF)


def test_hidden_specification_is_that_of_files(bent):
    specification = Specification(rules=(ComponentRule(match=Match(ids=("P2",)), changes=Changes(bare=True)),), name="plant 7")
    obj = insulated(bent, specification=specification, thickness=30.0)
    assert json.loads(obj.Specification)["name"] == "plant 7"
    assert "P2" in features.plan_of(bent).bare
