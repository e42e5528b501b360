# SPDX-License-Identifier: LGPL-2.1-or-later
"""PCF: a reader of its own finds the components, bores and items of the pipeline, connected where it is joined."""

import dataclasses
import functools
import math
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from measured import DN40
from pipe_rack import pipe_rack
from planned import plan_of, straight

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.errors import InputError
from pipeworkbench.exports.pcf import write_pcf
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.pipeline import Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee

DATA = Path(__file__).resolve().parent.parent / "data"
POINTS = ("END-POINT", "CENTRE-POINT", "BRANCH1-POINT", "CO-ORDS")
KEYWORDS = {Pipe: "PIPE", Elbow: "ELBOW", Cap: "CAP", Tee: "TEE"}
WRITTEN_MM = 1e-4  # coordinates are written with four decimals
WELD_MM = 2.5  # by which the rack's ends are apart at most, gaskets apart


# ---------------------------------------------------------------- a reader that knows nothing of the writer


@dataclass
class Record:
    """A line at the margin and the indented ones below it: points with their bores, all else as texts."""

    kind: str
    value: str
    points: dict[str, list[tuple[tuple[float, float, float], str]]] = field(default_factory=lambda: defaultdict(list))
    said: dict[str, str] = field(default_factory=dict)
    pipeline: str = ""


def read_pcf(path):
    """Return header, components and materials of a file."""
    raw = path.read_bytes()
    assert raw.isascii()
    assert raw.endswith(b"\r\n")
    assert raw.count(b"\n") == raw.count(b"\r\n")
    records = []
    for line in raw.decode("ascii").splitlines():
        assert line.strip()
        key, _, value = line.strip().partition(" ")
        if not line.startswith(" "):
            records.append(Record(key, value))
            continue
        assert line.startswith("    ")
        assert not line.startswith("     ")
        if key in POINTS:
            x, y, z, bore = value.split()
            records[-1].points[key].append(((float(x), float(y), float(z)), bore))
        else:
            assert key not in records[-1].said
            records[-1].said[key] = value
    start = next(index for index, record in enumerate(records) if record.kind == "PIPELINE-REFERENCE")
    end = next(index for index, record in enumerate(records) if record.kind == "MATERIALS")
    pipeline, components = "", []
    for record in records[start:end]:
        if record.kind == "PIPELINE-REFERENCE":
            pipeline = record.value
        else:
            record.pipeline = pipeline
            components.append(record)
    return {record.kind: record.value for record in records[:start]}, components, records[end + 1 :]


def ends(record):
    return [place for place, _ in record.points["END-POINT"]]


def is_near(place, wanted, distance=WRITTEN_MM):
    return math.dist(place, wanted) <= distance


# ---------------------------------------------------------------- what is written

PLANTS = {
    "sample": lambda: Pipeline.read(DATA / "dummy.json"),
    "everything": lambda: Pipeline.read(DATA / "one_of_everything.json"),
    "rack": lambda: pipe_rack(100),
}


@functools.cache
def plant_called(name):
    return PLANTS[name]()


@pytest.fixture(params=PLANTS)
def plant(request):
    return plant_called(request.param)


@pytest.fixture
def written(plant, tmp_path):
    write_pcf(plant, tmp_path / "plant.pcf")
    return read_pcf(tmp_path / "plant.pcf")


def by_name(components):
    named = [record for record in components if "UCI" in record.said]
    found = {record.said["UCI"]: record for record in named}
    assert len(found) == len(named)
    return found


def test_units_are_millimetres_and_kilograms(written):
    header, _, _ = written
    assert header.pop("ISOGEN-FILES") == "ISOGEN.FLS"
    lengths = {f"UNITS-{what}": "MM" for what in ("BORE", "CO-ORDS", "BOLT-LENGTH", "BOLT-DIA")}
    assert header == lengths | {"UNITS-WEIGHT": "KGS"}


def test_every_component_is_there_once_under_its_pipeline(plant, written):
    _, components, _ = written
    found, runs = by_name(components), runs_of(plant)
    assert set(found) == {component.id for component in plant.components}
    for component in plant.components:
        record = found[component.id]
        assert record.pipeline == runs[component.id]
        if isinstance(component, Flange):
            assert record.kind == ("FLANGE-BLIND" if component.flange_type == "05" else "FLANGE")
        elif isinstance(component, Reducer):
            assert record.kind == f"REDUCER-{component.reducer_type.upper()}"
        else:
            assert record.kind == KEYWORDS[type(component)]


def test_ends_lie_where_the_components_are(plant, written):
    found = by_name(written[1])
    for component in plant.components:
        record = found[component.id]
        places = ends(record) + [place for place, _ in record.points["BRANCH1-POINT"]]
        for port in component.ports:
            assert min(math.dist(place, port.point) for place in places) < WELD_MM
        if isinstance(component, Elbow | Tee):
            ((centre, _),) = record.points["CENTRE-POINT"]
            assert is_near(centre, component.intersection)


def test_joined_ends_coincide_or_have_a_gasket_between_them(plant, written):
    _, components, _ = written
    found = by_name(components)
    gaskets = [ends(record) for record in components if record.kind == "GASKET"]
    between = 0
    for joint in plant.joints:
        a, b = found[joint.a], found[joint.b]
        places = [ends(record) + [place for place, _ in record.points["BRANCH1-POINT"]] for record in (a, b)]
        if set(places[0]) & set(places[1]):
            continue
        between += 1
        assert a.kind.startswith("FLANGE")
        assert b.kind.startswith("FLANGE")
        assert sum(one in places[0] and other in places[1] for one, other in gaskets) == 1
    assert between == len(gaskets) > 0


def test_bores_are_nominal_diameters(plant, written):
    found = by_name(written[1])
    for component in plant.components:
        record = found[component.id]
        bores = [bore for _, bore in record.points["END-POINT"]]
        if isinstance(component, Reducer):
            assert bores == [str(component.dn), str(pipe_size(component.end_diameter).dn)]
        else:
            assert set(bores) == {str(component.dn)}
        if isinstance(component, Tee):
            assert [bore for _, bore in record.points["BRANCH1-POINT"]] == [str(pipe_size(component.branch_diameter).dn)]


def test_elbows_turn_as_they_do(plant, written):
    found = by_name(written[1])
    elbows = [component for component in plant.components if isinstance(component, Elbow)]
    for elbow in elbows:
        record = found[elbow.id]
        assert record.said["SKEY"] == "ELBW"
        assert int(record.said["ANGLE"]) == round(100 * elbow.angle_deg)
    assert elbows


def test_every_item_is_described_once_and_used(written):
    _, components, materials = written
    described = {record.value: record.said["DESCRIPTION"] for record in materials}
    assert {record.kind for record in materials} == {"ITEM-CODE"}
    assert len(described) == len(materials) == len(set(described.values()))
    used = {record.said.get("ITEM-CODE") or record.said["BOLT-ITEM-CODE"] for record in components}
    assert used == set(described)


def test_the_same_pipeline_gives_the_same_bytes(everything, tmp_path):
    for name in ("one.pcf", "other.pcf"):
        write_pcf(everything, tmp_path / name)
    assert (tmp_path / "one.pcf").read_bytes() == (tmp_path / "other.pcf").read_bytes()


# ---------------------------------------------------------------- what is special


def only(pipeline, tmp_path, plan=None):
    """Return the components of a pipeline's file."""
    write_pcf(pipeline, tmp_path / "special.pcf", plan)
    return read_pcf(tmp_path / "special.pcf")[1]


def test_symbol_keys_are_those_of_the_flanges_types(everything, tmp_path):
    flange = next(component for component in everything.components if component.id == "F1")
    keys = {"01": "FLSO", "02": "FLLB", "04": "FLLB", "05": "FLBL", "11": "FLWN", "12": "FLSO", "13": "FLSC", "21": "FLWN"}
    flanges = tuple(dataclasses.replace(flange, id=kind, flange_type=kind) for kind in keys)
    records = by_name(only(Pipeline(frame="A", components=flanges), tmp_path))
    assert {kind: record.said["SKEY"] for kind, record in records.items()} == keys


def test_bolts_go_through_both_flanges_and_the_gasket(everything, tmp_path):
    records = only(everything, tmp_path)
    (bolt,) = (record for record in records if record.kind == "BOLT")
    # 18 mm and 18 mm of flanges, 2 mm of gasket and 1.1 times 16 mm of nut and thread are 55.6 mm
    assert {key: bolt.said[key] for key in ("BOLT-DIA", "BOLT-QUANTITY", "BOLT-LENGTH")} == {
        "BOLT-DIA": "16",
        "BOLT-QUANTITY": "4",
        "BOLT-LENGTH": "60",
    }


def test_faces_that_touch_have_no_gasket_but_bolts(everything, tmp_path):
    moved = tuple(dataclasses.replace(one, face=(-600.0, 3600.0, 300.0)) if one.id == "F2" else one for one in everything.components)
    records = only(dataclasses.replace(everything, components=moved), tmp_path)
    assert Counter(record.kind for record in records)["GASKET"] == 0
    assert Counter(record.kind for record in records)["BOLT"] == 1
    faces = [ends(by_name(records)[name])[0] for name in ("F1", "F2")]
    assert faces[0] == faces[1]


def test_an_eccentric_reducer_says_where_it_is_flat(everything, tmp_path):
    (reducer,) = (one for one in everything.components if one.id == "R1")
    down = dataclasses.replace(reducer, id="down", end=(*reducer.end[:2], 2 * reducer.start[2] - reducer.end[2]))
    records = by_name(only(Pipeline(frame="A", components=(reducer, down)), tmp_path))
    assert (records["R1"].said["FLAT-DIRECTION"], records["down"].said["FLAT-DIRECTION"]) == ("UP", "DOWN")


def test_under_a_set_on_branch_the_pipe_runs_through(everything, tmp_path):
    (tee,) = (one for one in everything.components if one.id == "T1")
    names = ("T1", "T1-RUN")  # the name of the pipe that runs through is taken
    tees = tuple(dataclasses.replace(tee, id=name, tee_type="set-on") for name in names)
    records = by_name(only(Pipeline(frame="A", components=tees), tmp_path))
    assert Counter(record.kind for record in records.values()) == {"PIPE": 2, "TEE-SET-ON": 2}
    branch = records["T1"]
    assert not branch.points["END-POINT"]
    assert is_near(branch.points["CENTRE-POINT"][0][0], tee.intersection)
    assert branch.said["SKEY"] == "TESO"
    run = records["T1-RUN.2"]
    assert run.kind == "PIPE"
    assert ends(run) == [tee.start, tee.end]
    assert run.said["ITEM-CODE"].startswith("PIPE-")


def test_a_diameter_of_no_standard_is_its_own_bore(tmp_path):
    free = dataclasses.replace(DN40, outer_diameter=95.04, dn=None, standard=None)
    (record,) = only(Pipeline(frame="A", components=(free,)), tmp_path)
    assert {bore for _, bore in record.points["END-POINT"]} == {"95"}


def test_names_become_words_of_ascii_that_differ(tmp_path):
    names = ["Rücklauf 1", "Rucklauf 1", "管", "ä\n2", " "]
    pipes = tuple(dataclasses.replace(DN40, id=name, extra={"system": "Kühl wasser"}) for name in names)
    records = only(Pipeline(frame="Halle Süd", components=pipes), tmp_path)
    assert [record.said["UCI"] for record in records] == ["Rucklauf-1", "Rucklauf-1.2", "_", "a_2", "_.2"]
    assert [record.pipeline for record in records] == ["Kuhl-wasser", *(f"Kuhl-wasser.{number}" for number in range(2, 6))]


def test_insulation_that_components_say_is_written(tmp_path):
    wool = dataclasses.replace(DN40, extra={"insulation": {"thickness": 30, "material": "Mineral wool"}})
    bare = dataclasses.replace(DN40, id="bare")
    records = by_name(only(Pipeline(frame="A", components=(wool, bare)), tmp_path))
    said = records["A-P00"].said
    assert (said["INSULATION"], said["INSULATION-SPEC"], said["COMPONENT-ATTRIBUTE1"]) == ("ON", "30-mm-Mineral-wool", "30")
    assert not {"INSULATION", "INSULATION-SPEC", "COMPONENT-ATTRIBUTE1"} & set(records["bare"].said)


def test_planned_insulation_is_written_with_all_layers(tmp_path):
    wool = dataclasses.replace(DN40, extra={"insulation": {"thickness": 30, "material": "Mineral wool"}})
    pipeline = Pipeline(frame="A", components=(wool, dataclasses.replace(wool, id="bare")))
    records = by_name(only(pipeline, tmp_path, plan_of(pipeline, [straight(wool)])))
    said = records["A-P00"].said
    assert said["INSULATION-SPEC"] == "15-mm-mineral-wool-+-10-mm-elastomeric-foam-+-0.8-mm-aluminium"
    assert said["COMPONENT-ATTRIBUTE1"] == "25"
    assert "INSULATION" not in records["bare"].said  # what the plan leaves bare is


def test_a_pipeline_without_components_is_refused_and_nothing_written(tmp_path):
    with pytest.raises(InputError, match="no components"):
        write_pcf(Pipeline(frame="A"), tmp_path / "empty.pcf")
    assert list(tmp_path.iterdir()) == []
