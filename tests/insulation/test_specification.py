# SPDX-License-Identifier: LGPL-2.1-or-later
"""The specification: which rules hold for which component, the file and its round trip, and bad input by file and key."""

import copy
import json
import logging
from dataclasses import replace

import pytest

from pipeworkbench.catalogue import InsulationDistance, catalogue
from pipeworkbench.errors import InputError
from pipeworkbench.files import package_folder
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.rules import Changes, ComponentRule, JacketSpec, LayerSpec, Match
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.insulation.specification import SCHEMA, Block, Obstacle, Specification, finished_diameter, is_vertical
from pipeworkbench.insulation.thickness import HeatLossRule
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, SheetSize, Treatment
from pipeworkbench.pipeline import Elbow, Flange, Joint, Pipe, Pipeline
from pipeworkbench.solids.coverings import Layer, Sheet

SAMPLE = package_folder("resources") / "samples" / "insulation.json"
PIPE = Pipe(id="P1", start=(0, 0, 0), end=(1000, 0, 0), outer_diameter=60.3, wall_thickness=2.9, dn=50, station="A")
ELBOW = Elbow(id="E1", start=(0, 0, 0), end=(76, 76, 0), intersection=(76, 0, 0), angle_deg=90.0, bend_radius=76.0, outer_diameter=60.3)
FLANGE = Flange(id="F1", face=(0, 0, 0), axis=(0, 0, 1), flange_type="11", pn=16, D=165.0, C=18.0, length=45.0, outer_diameter=60.3)
WOOL = {"material": "mineral wool", "thickness": 60}


def spec(**keys):
    return Specification.from_dict({"schema": SCHEMA, **keys}, "f.json")


def refused(**keys):
    with pytest.raises(InputError) as error:
        spec(**keys)
    assert error.value.source == "f.json"
    return f"{error.value.key}: {error.value.problem}; {error.value.remedy}"


# ---------------------------------------------------------------- which rule holds


def test_uniform_puts_one_layer_under_aluminium_by_din_4140_around_everything():
    treatment = Specification.uniform(60).treatment_of(PIPE)
    assert treatment.layers == (Layer("mineral wool", 60.0),)
    assert treatment.jacket == Sheet("aluminium", 0.6)
    assert treatment.seams == Seams()
    assert treatment.remarks == ("jacket 0.6 mm of aluminium after DIN 4140 (not verified against the standard)",)


def test_uniform_takes_material_and_jacket():
    specification = Specification.uniform(30, "Glass wool", Sheet("stainless steel", 0.8))
    assert specification.treatment_of(PIPE).jacket == Sheet("stainless steel", 0.8)
    assert specification.treatment_of(PIPE).layers == (Layer("glass wool", 30.0),)
    assert specification.treatment_of(PIPE).remarks == ()
    assert Specification.uniform(30, jacket=None).treatment_of(PIPE).jacket is None


@pytest.mark.parametrize("thickness", [0, -5, float("nan"), float("inf")])
def test_uniform_thickness_must_be_positive(thickness):
    with pytest.raises(InputError, match=r"insulation: thickness: is .* mm; give a positive thickness"):
        Specification.uniform(thickness)


def test_uniform_material_must_be_known():
    with pytest.raises(InputError, match="did you mean 'mineral wool'"):
        Specification.uniform(50, "mineral wol")


def test_nothing_specified_is_bare():
    assert Specification().treatment_of(PIPE) is None
    assert spec(default={"seams": {"bead": True}}).treatment_of(PIPE) is None


def test_treatment_may_be_the_default():
    treatment = Treatment((Layer("glass wool", 40.0),), None, Seams(gore_overlap=7.0), remarks=("as the client wishes",))
    assert Specification(default=treatment).treatment_of(PIPE) == treatment


def test_later_rules_win_and_change_only_what_they_name():
    specification = spec(
        default={"layers": [WOOL], "seams": {"gore_overlap": 12}},
        rules=[
            {"match": {"kinds": ["pipe"]}, "layers": [{"material": "glass wool", "thickness": 40}], "seams": {"bead": True}},
            {"match": {"ids": ["P1"]}, "jacket": None},
            {"match": {"ids": ["P2"]}, "bare": True},
        ],
    )
    first, second = specification.treatment_of(PIPE), specification.treatment_of(ELBOW)
    assert first.layers == (Layer("glass wool", 40.0),)
    assert first.jacket is None
    assert (first.seams.gore_overlap, first.seams.bead, first.seams.longitudinal_overlap) == (12.0, True, 30.0)
    assert second.layers == (Layer("mineral wool", 60.0),)
    assert second.jacket == Sheet("aluminium", 0.6)
    assert second.seams.bead is False
    assert specification.treatment_of(replace(PIPE, id="P2")) is None


def test_bare_can_be_given_back():
    rules = [{"bare": True}, {"match": {"kinds": ["elbow"]}, "bare": False}]
    specification = spec(default={"layers": [WOOL]}, rules=rules)
    assert specification.treatment_of(PIPE) is None
    assert specification.treatment_of(ELBOW).thickness == 60


@pytest.mark.parametrize(
    ("match", "fits"),
    [
        ({}, True),
        ({"ids": ["P1", "x"]}, True),
        ({"ids": ["p1"]}, False),
        ({"runs": ["R1"]}, True),
        ({"runs": ["R2"]}, False),
        ({"kinds": ["elbow", "flange"]}, False),
        ({"stations": ["A"]}, True),
        ({"dn": [40, 50]}, True),
        ({"dn": [40]}, False),
        ({"diameter": [60.3, 60.3]}, True),
        ({"diameter": [60.4, 100]}, False),
        ({"diameter": [0, 60.2]}, False),
        ({"kinds": ["pipe"], "runs": ["R2"]}, False),
    ],
)
def test_all_that_is_named_must_be_true(match, fits):
    specification = spec(rules=[{"match": match, "layers": [WOOL]}])
    assert (specification.treatment_of(PIPE, "R1") is not None) == fits


def test_jacket_of_a_flange_goes_by_its_box():
    wide = replace(FLANGE, D=300.0)
    assert finished_diameter(wide, 60.0, 20.0) == 460
    assert Specification.uniform(60).treatment_of(wide).jacket == Sheet("aluminium", 0.8)
    assert Specification.uniform(60).treatment_of(FLANGE).jacket == Sheet("aluminium", 0.6)


def test_operation_is_that_of_the_file_with_a_rules_changes():
    rules = [{"match": {"kinds": ["elbow"]}, "operation": {"wind_speed": 3}}]
    specification = spec(operation={"medium_temperature": 120, "price_per_kwh": 0.1}, rules=rules)
    assert specification.operation_of(PIPE) == Operation(medium_temperature=120.0, price_per_kwh=0.1)
    assert specification.operation_of(ELBOW) == Operation(medium_temperature=120.0, price_per_kwh=0.1, wind_speed=3.0)


def test_thickness_by_heat_loss_counts_the_layers_beside_it():
    layers = [
        {"material": "mineral wool wired mat", "thickness": 40},
        {"material": "mineral wool", "thickness": {"rule": "heat loss", "at_most": 80}},
    ]
    treatment = spec(operation={"medium_temperature": 300}, default={"layers": layers}).treatment_of(PIPE)
    assert treatment.layers[0].thickness == 40
    assert 20 < treatment.layers[1].thickness < 100
    assert "conductivity of mineral wool wired mat: general knowledge, no source" in treatment.remarks


def test_medium_hotter_than_the_material_may_get_is_told():
    specification = spec(operation={"medium_temperature": 300}, default={"layers": [{"material": "polyurethane foam", "thickness": 40}]})
    assert "the medium (300 deg C) is hotter than polyurethane foam may get (130 deg C)" in specification.treatment_of(PIPE).remarks


def test_axes_of_45_degrees_and_more_stand():
    assert not is_vertical(PIPE)
    assert is_vertical(replace(PIPE, end=(0.0, 0.0, 1000.0)))
    assert is_vertical(replace(PIPE, end=(0.0, 1000.0, -1001.0)))
    assert is_vertical(FLANGE)
    assert not is_vertical(replace(ELBOW, start=(0.0, 0.0, -76.0), intersection=(0.0, 0.0, 0.0)))


def test_distance_that_nobody_named_is_the_tables_and_told_as_not_verified():
    (table,) = (record for record in catalogue().records(InsulationDistance) if record.subject == "pipes")
    assert Specification().minimum_distance == table.distance
    assert Specification().remarks == ("minimum distance 100 mm, overlaps 30 and 50 mm: after DIN 4140 (not verified against the standard)",)
    assert spec(minimum_distance=60).remarks == ()


def test_default_overlaps_are_those_of_the_table():
    distances = {record.subject: record.distance for record in catalogue().records(InsulationDistance)}
    assert Seams().longitudinal_overlap == distances["longitudinal overlap"]
    assert Seams().circumferential_overlap == distances["circumferential overlap"]
    assert Flanges().gap == distances["bolts"]


# ---------------------------------------------------------------- the file


def test_sample_reads_and_says_how_everything_is_insulated(everything):
    specification = Specification.read(SAMPLE)
    runs = runs_of(everything)
    treatments = {c.id: specification.treatment_of(c, runs[c.id]) for c in everything.components}
    assert all(treatment is not None for treatment in treatments.values())
    assert {treatment.jacket.material for treatment in treatments.values()} == {"aluminium"}


def test_file_survives_a_round_trip_with_unknown_keys(tmp_path, caplog):
    data = json.loads(SAMPLE.read_text(encoding="utf-8"))
    data["customer"] = {"number": 7}
    data["default"]["colour"] = "grey"
    data["rules"][0]["note"] = "ask again"
    data["obstacles"] = [
        {"id": "column", "start": [0, 0, 0], "end": [0, 0, 3000], "diameter": 200},
        {"id": "wall", "lower": [0, 0, 0], "upper": [100, 5000, 3000]},
    ]
    data["rules"].append({"layers": [{"material": "glass wool", "thickness": {"rule": "bands", "bands": [{"thickness": 30}]}}], "jacket": None})
    path = tmp_path / "in.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    with caplog.at_level(logging.WARNING):
        first = Specification.read(path)
    assert [record.getMessage().split(": ", 1)[1] for record in caplog.records] == [
        "customer: unknown key, ignored",
        "default.colour: unknown key, ignored",
        "rules[0].note: unknown key, ignored",
    ]
    first.write(tmp_path / "out.json")
    second = Specification.read(tmp_path / "out.json")
    assert second == first
    written = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    assert written["customer"] == {"number": 7}
    assert written["default"]["colour"] == "grey"
    assert written["rules"][0]["note"] == "ask again"
    assert second.obstacles == (
        Obstacle(id="column", start=(0, 0, 0), end=(0, 0, 3000), diameter=200.0),
        Block(id="wall", lower=(0, 0, 0), upper=(100, 5000, 3000)),
    )
    assert second.to_dict() == first.to_dict()


def test_specification_made_in_python_survives_the_file(tmp_path):
    made = Specification(
        default=Changes(layers=(LayerSpec("mineral wool", HeatLossRule(at_most=25.0, stock=True)),), jacket=JacketSpec("stainless steel")),
        rules=(ComponentRule(match=Match(kinds=("elbow",), diameter=(20.0, 60.0)), changes=Changes(bends={"gores": 5}, bare=False), name="bends"),),
        operation=Operation(medium_temperature=140.0, price_per_kwh=0.12),
        sheet_sizes=(SheetSize(3000.0, 1500.0),),
        minimum_distance=50.0,
        prices={"mineral wool": 200.0},
        name="made",
    )
    made.write(tmp_path / "made.json")
    assert Specification.read(tmp_path / "made.json") == made


def test_short_file_means_what_is_usual():
    specification = spec()
    assert specification.minimum_distance == 100
    assert specification.sheet_sizes == (SheetSize(),)
    assert specification.obstacles == ()
    assert specification == Specification()


def test_uniform_specification_survives_the_file():
    made = Specification.uniform(45)
    assert Specification.from_dict(made.to_dict()) == made


def layer(**keys):
    return {"layers": [{"material": "mineral wool", "thickness": 60} | keys]}


def rule_layer(**rule):
    return layer(thickness=rule)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"default": []}, "default: is not a JSON object"),
        ({"default": {"layers": []}}, "default.layers: is not a list of layers; give at least one"),
        ({"default": {"layers": [60]}}, "default.layers[0]: is not a JSON object"),
        ({"default": {"layers": [{"material": "mineral wool"}]}}, "default.layers[0].thickness: is missing; add this key"),
        ({"default": {"layers": [{"materal": "mineral wool", "thickness": 6}]}}, "default.layers[0].materal: unknown key; did you mean 'material'?"),
        ({"default": layer(material="mineral wol")}, "default.layers[0].material: no material is called 'mineral wol'; did you mean 'mineral wool'?"),
        ({"default": layer(material=7)}, "default.layers[0].material: input should be a valid string"),
        ({"default": layer(thickness=0)}, "default.layers[0].thickness: input should be greater than or equal to 1 (found 0)"),
        ({"default": layer(thickness=-60)}, "default.layers[0].thickness: input should be greater than or equal to 1"),
        ({"default": layer(thickness="thick")}, "default.layers[0].thickness: input should be a valid number"),
        ({"default": rule_layer(rule="geg")}, "default.layers[0].thickness.rule: is 'geg'; use one of GEG, table, bands, heat loss"),
        ({"default": rule_layer(at_most=5)}, "default.layers[0].thickness.rule: is None"),
        ({"default": rule_layer(rule="heat loss")}, "default.layers[0].thickness.at_most: is missing"),
        ({"default": rule_layer(rule="heat loss", atmost=5)}, "default.layers[0].thickness.atmost: unknown key; did you mean 'at_most'?"),
        ({"default": rule_layer(rule="heat loss", at_most=0)}, "default.layers[0].thickness.at_most: input should be greater than 0"),
        ({"default": rule_layer(rule="table")}, "default.layers[0].thickness.table: is missing; name the table"),
        ({"default": rule_layer(rule="bands", bands=[])}, "default.layers[0].thickness.bands: "),
        (
            {"default": rule_layer(rule="bands", bands=[{"thickness": 20, "from_diameter": 50, "to_diameter": 40}])},
            "default.layers[0].thickness.bands[0]: to_diameter is not more than from_diameter",
        ),
        (
            {"default": {"layers": [rule_layer(rule="heat loss", at_most=5)["layers"][0]] * 2}},
            "default.layers[1].thickness: is the second that follows from the heat flow",
        ),
        ({"default": {"jacket": {"material": "tin"}}}, "default.jacket.material: no material is called 'tin'; use one of aluminised steel"),
        ({"default": {"jacket": {"material": "aluminium", "thickness": -1}}}, "default.jacket.thickness: "),
        ({"default": {"jacket": "aluminium"}}, "default.jacket: is not a JSON object"),
        (
            {"default": {"seams": {"longitudinal_overlap": -5}}},
            "default.seams.longitudinal_overlap: input should be greater than or equal to 0 (found -5)",
        ),
        ({"default": {"seams": {"longitudinal_overlp": 5}}}, "default.seams.longitudinal_overlp: unknown key; did you mean 'longitudinal_overlap'?"),
        ({"default": {"bends": {"gores": 1}}}, "default.bends.gores: input should be greater than or equal to 2"),
        ({"default": {"bends": {"shape": "square"}}}, "default.bends.shape: input should be 'segmented' or 'smooth' (found 'square')"),
        ({"default": {"flanges": {"cover": "hat"}}}, "default.flanges.cover: input should be 'box' or 'bare'"),
        ({"default": {"bare": "perhaps"}}, "default.bare: input should be a valid boolean"),
        ({"rules": {}}, "rules: is not a list; give a JSON array"),
        ({"rules": [{"match": {"kinds": ["valve"]}}]}, "rules[0].match.kinds[0]: input should be 'pipe', 'elbow'"),
        ({"rules": [{}, {"match": {"diameter": [100, 50]}}]}, "rules[1].match: the diameters go from 100 to 50"),
        ({"rules": [{"match": {"diameter": [50]}}]}, "rules[0].match.diameter"),
        ({"rules": [{"match": {"ids": "P1"}}]}, "rules[0].match.ids: input should be a valid tuple (found 'P1')"),
        ({"rules": [{"seams": {"gore_overlap": -1}}]}, "rules[0].seams.gore_overlap: input should be greater than or equal to 0"),
        ({"operation": {"medium_temperature": -300}}, "operation.medium_temperature: input should be greater than -273.15"),
        ({"operation": {"hours_per_year": 9000}}, "operation.hours_per_year: input should be less than or equal to 8760"),
        ({"operation": {"efficiency": 0}}, "operation.efficiency: input should be greater than 0"),
        ({"operation": {"wind_speed": -1}}, "operation.wind_speed: input should be greater than or equal to 0"),
        ({"sheet_sizes": [{"width": 0}]}, "sheet_sizes[0].width: input should be greater than 0"),
        ({"minimum_distance": -1}, "minimum_distance: input should be greater than or equal to 0"),
        ({"minimum_distanc": 1}, "minimum_distanc: unknown key; did you mean 'minimum_distance'?"),
        ({"obstacles": [{"id": "a", "start": [0, 0, 0], "end": [0, 0, 0], "diameter": 5}]}, "obstacles[0]: start and end are the same point"),
        ({"obstacles": [{"id": "a", "start": [0, 0], "end": [0, 0, 1], "diameter": 5}]}, "obstacles[0].start[2]: is missing"),
        ({"obstacles": [{"id": "a", "lower": [0, 0, 0], "upper": [1, 0, 1]}]}, "obstacles[0]: lower is not less than upper"),
        ({"obstacles": [{"id": "a", "lower": [0, 0, 0], "upper": [1, 1, 1]}] * 2}, "obstacles[1].id: 'a' is used twice"),
        ({"prices": {"minral wool": 1}}, "prices.minral wool: unknown key; did you mean 'mineral wool'?"),
        (
            {"default": {"layers": [{"material": "mineral wool", "thickness": 1001}]}},
            "default.layers[0].thickness: input should be less than or equal to",
        ),
        ({"default": {"jacket": {"material": "aluminium", "thickness": 500}}}, "default.jacket.thickness: input should be less than or equal to 20"),
        ({"default": {"seams": {"rivet_pitch": 1e-12}}}, "default.seams.rivet_pitch: is 1e-12 mm; give at least 20, or 0 for no rivets"),
        ({"default": {"seams": {"rivet_diameter": 100}}}, "default.seams.rivet_diameter: input should be less than or equal to 10"),
        ({"default": {"seams": {"bead_allowance": 300}}}, "default.seams.bead_allowance: input should be less than or equal to 100"),
        ({"default": {"bends": {"gores": 10**30}}}, "default.bends.gores: input should be less than or equal to 1000"),
        ({"default": {"flanges": {"clearance": 1e6}}}, "default.flanges.clearance: input should be less than or equal to 1000"),
        ({"sheet_sizes": [{"width": 1e300}]}, "sheet_sizes[0].width: input should be less than or equal to 1000000"),
        ({"sheet_sizes": [{"margin": 500}]}, "sheet_sizes[0]: margins of 500 mm leave nothing of 1000 mm: give less than 500"),
        ({"obstacles": [{"id": "", "lower": [0, 0, 0], "upper": [1, 1, 1]}]}, "obstacles[0]: the id is empty"),
        ({"obstacles": [{"id": "a", "lower": [-1e300, 0, 0], "upper": [1, 1, 1]}]}, "obstacles[0]: a length is more than 1e+10 mm"),
        ({"prices": {"mineral wool": -1}}, "prices.mineral wool: input should be greater than or equal to 0"),
    ],
)
def test_bad_input_is_refused_by_file_and_key(keys, message):
    assert refused(**copy.deepcopy(keys)).startswith(message)


@pytest.mark.parametrize(("data", "key"), [([], ""), ({}, "schema"), ({"schema": "pipeworkbench-insulation/2"}, "schema")])
def test_file_of_another_kind_is_refused(data, key):
    with pytest.raises(InputError, match="give a file of schema pipeworkbench-insulation/1") as error:
        Specification.from_dict(data, "f.json")
    assert error.value.key == key


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        Specification.read(tmp_path / "none.json")


def test_documentation_names_every_key():
    text = (package_folder("resources").parent / "docs" / "insulation.md").read_text(encoding="utf-8")
    for part in (Operation, SheetSize, Match, Seams, Bends, Flanges):
        for name in part.__dataclass_fields__:
            assert f"`{name}`" in text, (part, name)
    for name in Specification().to_dict() | dict.fromkeys(
        ("default", "rules", "operation", "sheet_sizes", "minimum_distance", "obstacles", "prices"), 0
    ):
        assert f"`{name}`" in text, name


# ---------------------------------------------------------------- runs


def pipeline(names, pairs):
    components = tuple(replace(PIPE, id=name) for name in names)
    return Pipeline(frame="A", components=components, joints=tuple(Joint(a=a, a_port=1, b=b, b_port=0) for a, b in pairs))


def test_runs_are_what_hangs_together_numbered_by_the_smallest_id():
    found = runs_of(pipeline(["P10", "P2", "P9", "P1", "X"], [("P10", "P2"), ("P9", "P1"), ("X", "P10")]))
    assert found == {"P10": "R2", "P2": "R2", "P9": "R1", "P1": "R1", "X": "R2"}


def test_runs_do_not_depend_on_the_order_of_components_and_joints():
    names, pairs = ["c", "a", "b", "d", "e", "f"], [("a", "b"), ("b", "c"), ("e", "f")]
    backwards = [(b, a) for a, b in reversed(pairs)]
    assert (
        runs_of(pipeline(names, pairs))
        == runs_of(pipeline(names[::-1], backwards))
        == {"a": "R1", "b": "R1", "c": "R1", "d": "R2", "e": "R3", "f": "R3"}
    )


def test_everything_joined_is_one_run(everything):
    assert set(runs_of(everything).values()) == {"R1"}
    assert list(runs_of(everything)) == [component.id for component in everything.components]
