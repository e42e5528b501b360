# SPDX-License-Identifier: LGPL-2.1-or-later
"""`pipeworkbench insulate`: from a pipeline to cut sheets, solids, lists and coverings."""

import csv
import json
import re
from pathlib import Path

import openpyxl
import pytest

from pipeworkbench.cli import main
from pipeworkbench.pipeline import Elbow, Joint, Pipe, Pipeline

DUMMY = Path(__file__).parent / "data" / "dummy.json"
SAMPLE = Path(__file__).parents[1] / "resources" / "samples" / "insulation.json"


def bend(radius):
    """Two pipes and the bend between them."""
    size = {"outer_diameter": 48.3, "wall_thickness": 2.6, "dn": 40}
    return Pipeline(
        frame="A",
        components=(
            Pipe(id="P0", start=(0, 0, 0), end=(1000, 0, 0), **size),
            Elbow(
                id="E0",
                start=(1000, 0, 0),
                intersection=(1000 + radius, 0, 0),
                end=(1000 + radius, radius, 0),
                angle_deg=90,
                bend_radius=radius,
                **size,
            ),
            Pipe(id="P1", start=(1000 + radius, radius, 0), end=(1000 + radius, radius + 800, 0), **size),
        ),
        joints=(Joint(a="P0", a_port=1, b="E0", b_port=0), Joint(a="E0", a_port=1, b="P1", b_port=0)),
    )


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "bend.json"
    bend(57.0).write(path)
    return path


def summary(capsys, *arguments):
    assert main(["insulate", *map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refusal(capsys, *arguments):
    assert main(["insulate", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def rows(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.slow
def test_every_ending_gets_what_belongs_into_it(file, tmp_path, capsys):
    outputs = [tmp_path / f"out.{ending}" for ending in ("dxf", "svg", "pdf", "csv", "xlsx", "step", "ifc", "pcf")]
    tables = {"--labels": tmp_path / "labels.csv", "--clashes": tmp_path / "clashes.csv", "--energy": tmp_path / "energy.csv"}
    more = [str(part) for option, path in tables.items() for part in (option, path)]
    said = summary(
        capsys, file, "--thickness", 30, "--medium", 90, "--parts", tmp_path / "parts", *more, *(part for path in outputs for part in ("--out", path))
    )
    begins = {
        "dxf": b"  0\nSECTION",
        "svg": b"<?xml",
        "pdf": b"%PDF",
        "csv": b"part,",
        "xlsx": b"PK",
        "step": b"ISO-10303-21",
        "pcf": b"ISOGEN-FILES",
    }
    for path in outputs:
        assert path.read_bytes().startswith(begins.get(path.suffix[1:], b"ISO-10303-21")), path
    assert b"IFCCOVERING(" in (tmp_path / "out.ifc").read_bytes()
    parts = rows(tmp_path / "out.csv")
    assert sum(int(part["quantity"]) for part in parts) == said["parts"] == len(rows(tables["--labels"]))
    assert len(list((tmp_path / "parts").glob("*.dxf"))) == len(parts)
    assert [row["component"] for row in rows(tables["--energy"])] == ["P0", "E0", "P1"]
    assert rows(tables["--clashes"]) == []
    assert said["energy"]["bare"]["heat"] > 5 * said["energy"]["insulated"]["heat"] > 0
    assert said["volume_m3"] > 0.01


def test_two_answers_what_a_pipe_loses_now_and_what_with_more(file, capsys):
    heat = [summary(capsys, file, "--thickness", thickness, "--medium", 90)["energy"]["insulated"]["heat"] for thickness in (20, 30)]
    bare = summary(capsys, file, "--thickness", 20, "--medium", 90, "--price", 0.12, "--co2", 0.2)["energy"]
    assert bare["bare"]["heat"] > heat[0] > heat[1]
    assert bare["saved"]["cost"] == pytest.approx(0.12 * bare["saved"]["energy"])
    assert bare["saved"]["co2"] == pytest.approx(0.2 * bare["saved"]["energy"])


def test_without_a_temperature_no_loss_is_told(file, capsys):
    assert summary(capsys, file, "--thickness", 20)["energy"] is None


def test_without_a_jacket_there_are_no_parts(file, capsys):
    said = summary(capsys, file, "--thickness", 20, "--jacket", "none")
    assert said["parts"] == said["sheets"] == 0
    assert said["pieces"] == 3


def test_sample_specification_fits_the_sample_pipeline(tmp_path, capsys):
    out = tmp_path / "cuts.csv"
    said = summary(capsys, DUMMY, "--spec", SAMPLE, "--out", out)
    assert said["bare"] == []
    assert {row["component"] for row in rows(out)} >= {"A-P00", "A-E00", "A-F09"}


def test_every_label_says_the_run_of_its_part(tmp_path, capsys):
    labels, out = tmp_path / "labels.csv", tmp_path / "cuts.csv"
    summary(capsys, DUMMY, "--thickness", 30, "--labels", labels, "--out", out)
    runs = {row["part"]: row["run"] for row in rows(out)}
    assert {row["kind"] for row in rows(labels)} >= {"jacket", "gore", "disc", "box mantle", "box face"}
    assert {row["part"]: row["run"] for row in rows(labels)} == runs
    assert all(runs.values())


def test_money_is_told_in_its_currency(file, tmp_path, capsys):
    spec = tmp_path / "spec.json"
    operation = {"medium_temperature": 90, "price_per_kwh": 0.1, "currency": "CHF"}
    changes = {"layers": [{"material": "mineral wool", "thickness": 30}]}
    spec.write_text(json.dumps({"schema": "pipeworkbench-insulation/1", "default": changes, "operation": operation}), encoding="utf-8")
    assert main(["insulate", str(file), "--spec", str(spec)]) == 0
    saved = capsys.readouterr().out.partition("Saved: ")[2].splitlines()[0]
    assert re.search(r", \d+ CHF a year$", saved)


@pytest.mark.slow
def test_german_lists_hold_no_english_words(tmp_path, capsys):
    out = tmp_path / "lists.xlsx"
    summary(capsys, DUMMY, "--spec", SAMPLE, "--language", "de", "--out", out)
    cells = {cell.value for sheet in openpyxl.load_workbook(out) for row in sheet.iter_rows() for cell in row if isinstance(cell.value, str)}
    words = {word for cell in cells for word in re.findall("[A-Za-zÄÖÜäöüß]+", cell)}
    assert {"Mineralwolle", "Aluminium", "Kehle", "Endscheibe", "Dämmung"} <= words
    assert not words & {"mineral", "wool", "aluminium", "throat", "heel", "gore", "disc", "jacket"}


@pytest.mark.slow
def test_what_does_not_fit_is_named_with_the_largest_thickness_that_works(tmp_path, capsys):
    file = tmp_path / "tight.json"
    bend(57.0).write(file)
    tight = tmp_path / "tight.spec.json"
    layer = {"material": "mineral wool", "thickness": 60}
    tight.write_text(
        json.dumps({"schema": "pipeworkbench-insulation/1", "default": {"layers": [layer], "bends": {"tight": "refuse"}}}), encoding="utf-8"
    )
    said = refusal(capsys, file, "--spec", tight)
    assert said.startswith("pipeworkbench: E0: thickness: 60 mm does not fit into a bend of radius 57 mm")
    largest = float(said.partition("give at most ")[2].split(" mm")[0])
    layer["thickness"] = largest
    tight.write_text(
        json.dumps({"schema": "pipeworkbench-insulation/1", "default": {"layers": [layer], "bends": {"tight": "refuse"}}}), encoding="utf-8"
    )
    assert main(["insulate", str(file), "--spec", str(tight), "--out", str(tmp_path / "tight.step"), "--quiet"]) == 0


def test_what_does_not_fit_stays_bare_where_that_is_asked_for(tmp_path, capsys):
    file, spec = tmp_path / "tight.json", tmp_path / "spec.json"
    bend(57.0).write(file)
    changes = {"layers": [{"material": "mineral wool", "thickness": 60}], "bends": {"tight": "refuse"}}
    spec.write_text(json.dumps({"schema": "pipeworkbench-insulation/1", "default": changes}), encoding="utf-8")
    said = summary(capsys, file, "--spec", spec, "--leave-out")
    assert said["bare"] == ["E0"]
    assert len(said["left_out"]) == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--thickness", "-5"], ["thickness", "positive"]),
        (["--thickness", "nan"], ["thickness", "positive"]),
        (["--thickness", "30", "--material", "minral wool"], ["material", "mineral wool"]),
        (["--thickness", "30", "--jacket", "tin foil"], ["jacket"]),
        (["--thickness", "30", "--medium", "-300"], ["the command line", "medium_temperature"]),
        (["--thickness", "30", "--energy", "e.csv"], ["--energy", "--medium"]),
        (["--thickness", "30", "--out", "x.FCStd"], ["x.FCStd", ".dxf"]),
        (["--thickness", "30", "--labels", "x.doc"], ["x.doc", ".pdf"]),
        (["--spec", "{sample}", "--material", "mineral wool"], ["--material", "--thickness"]),
        (["--spec", "missing.json"], ["missing.json"]),
    ],
)
def test_what_cannot_be_meant_is_refused_in_one_line(file, capsys, arguments, words):
    said = refusal(capsys, file, *(argument.format(sample=SAMPLE) for argument in arguments))
    assert said.count("\n") == 1
    for word in words:
        assert word in said


def test_inputs_are_never_overwritten(file, tmp_path, capsys):
    spec = tmp_path / "spec.csv"
    assert "input" in refusal(capsys, file, "--spec", spec, "--out", spec)


def test_negative_overlap_is_refused_with_its_key(file, tmp_path, capsys):
    spec = tmp_path / "spec.json"
    changes = {"layers": [{"material": "mineral wool", "thickness": 30}], "seams": {"longitudinal_overlap": -1}}
    spec.write_text(json.dumps({"schema": "pipeworkbench-insulation/1", "default": changes}), encoding="utf-8")
    said = refusal(capsys, file, "--spec", spec)
    assert f"{spec}: default.seams.longitudinal_overlap" in said


# ---------------------------------------------------------------- slips of the pen


WOOL = {"layers": [{"material": "mineral wool", "thickness": 30}]}


def specified(folder, **keys):
    path = folder / "asked.json"
    path.write_text(json.dumps({"schema": "pipeworkbench-insulation/1", "default": WOOL} | keys), encoding="utf-8")
    return path


def test_parts_never_take_the_place_of_files_that_are_there(file, tmp_path, capsys):
    folder, other = tmp_path / "parts", tmp_path / "cuts.csv"
    folder.mkdir()
    (folder / "p0-1.DXF").write_text("another name", encoding="utf-8")
    (folder / "P0-1.dxf").write_text("mine", encoding="utf-8")
    said = refusal(capsys, file, "--thickness", 30, "--parts", folder, "--out", other)
    assert f"{folder / 'P0-1.dxf'}: is there already and would be lost" in said
    assert (folder / "P0-1.dxf").read_text(encoding="utf-8") == "mine"
    assert len(list(folder.iterdir())) <= 2
    assert not other.exists()


def test_an_output_is_not_a_part_as_well(file, tmp_path, capsys):
    (tmp_path / "parts").mkdir()
    said = refusal(capsys, file, "--thickness", 30, "--parts", tmp_path / "parts", "--out", tmp_path / "parts" / "P0-1.dxf")
    assert "is an output and the name of a part as well" in said
    assert not list((tmp_path / "parts").iterdir())


def test_parts_need_a_folder(file, capsys):
    assert f"{file}: is a file; name a folder for the parts" in refusal(capsys, file, "--thickness", 30, "--parts", file)


@pytest.mark.parametrize("last", [("--labels", "labels.csv"), ("--parts", "parts"), ("--out", "cut.dxf"), ("--out", "cut.pdf")])
def test_nothing_is_written_where_a_later_output_cannot_be(file, tmp_path, capsys, last):
    option, name = last
    said = refusal(capsys, file, "--thickness", 30, "--jacket", "none", "--out", tmp_path / "list.csv", option, tmp_path / name)
    assert f"{tmp_path / name}: there is no part to be cut; give the insulation a jacket of sheet metal" in said
    assert list(tmp_path.iterdir()) == [file]


def test_one_name_for_two_tables_is_told_as_such(file, tmp_path, capsys):
    table = tmp_path / "table.csv"
    assert "is given twice as an output" in refusal(capsys, file, "--thickness", 30, "--labels", table, "--clashes", table)


def test_what_the_sheets_are_too_small_for_stays_bare_where_that_is_asked_for(file, tmp_path, capsys):
    rule = {"match": {"ids": ["E0"]}, "seams": {"circumferential_overlap": 2500}}
    spec = specified(tmp_path, rules=[rule])
    assert "E0: gores: " in refusal(capsys, file, "--spec", spec, "--out", tmp_path / "cut.dxf")
    assert not (tmp_path / "cut.dxf").exists()
    said = summary(capsys, file, "--spec", spec, "--leave-out", "--out", tmp_path / "cut.dxf")
    assert said["bare"] == ["E0"]
    assert [text.partition(":")[0] for text in said["left_out"]] == ["E0"]
    assert (tmp_path / "cut.dxf").exists()


def test_rules_that_are_for_nothing_are_told(file, tmp_path, capsys):
    rules = [{"name": "typo", "match": {"ids": ["P0", "Pl"]}, "bare": False}, {"match": {"dn": [999]}}, {"match": {"runs": ["R7"]}}]
    remarks = summary(capsys, file, "--spec", specified(tmp_path, rules=rules))["remarks"]
    assert remarks[:4] == [
        "rules[0] 'typo': match.ids: there is no 'Pl'",
        "rules[1]: is for none of the components",
        "rules[2]: match.runs: there is no 'R7'",
        "rules[2]: is for none of the components",
    ]


def test_a_misspelt_id_is_told_with_the_one_that_is_alike(tmp_path, capsys):
    pipe = Pipe(id="LINE-1001", start=(0, 0, 0), end=(900, 0, 0), outer_diameter=48.3)
    Pipeline(frame="A", components=(pipe,)).write(tmp_path / "one.json")
    said = summary(capsys, tmp_path / "one.json", "--spec", specified(tmp_path, rules=[{"match": {"ids": ["LINE-101"]}}]))
    assert said["remarks"][0] == "rules[0]: match.ids: there is no 'LINE-101'; did you mean 'LINE-1001'?"


def test_a_key_given_twice_is_refused(file, tmp_path, capsys):
    spec = tmp_path / "twice.json"
    spec.write_text('{"schema": "pipeworkbench-insulation/1", "default": {"bare": true}, "default": {"bare": false}}', encoding="utf-8")
    assert f"{spec}: default: is given twice in one object; keep one of them" in refusal(capsys, file, "--spec", spec)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--thickness", "1e9"], ["thickness: is 1e+09 mm", "1 to 1000 mm"]),
        (["--thickness", "1e-9"], ["thickness: is 1e-09 mm", "1 to 1000 mm"]),
        (["--thickness", "30", "--material", ""], ["material: no material is called ''"]),
        (["--thickness", "30", "--jacket", ""], ["jacket: no material is called ''"]),
        (["--thickness", "30", "--price", "0.1"], ["--price", "--medium"]),
        (["--thickness", "30", "--co2", "0.1"], ["--co2", "--medium"]),
        (["--thickness", "30", "--medium", "nan"], ["medium_temperature: input should be a finite number (found nan)"]),
        (["--thickness", "30", "--medium", "1e9"], ["medium_temperature: input should be less than or equal to 2000"]),
    ],
)
def test_numbers_nobody_means_are_refused_in_one_line(file, capsys, arguments, words):
    said = refusal(capsys, file, *arguments)
    assert said.count("\n") == 1
    for word in words:
        assert word in said


def test_the_thinnest_layer_gets_no_stops(file, capsys):
    assert summary(capsys, file, "--thickness", 1)["pieces"] == 3
