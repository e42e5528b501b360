# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the user's own: they add to the standards' or take their place, and are refused by line and column."""

import dataclasses
import json
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeworkbench.catalogue import (
    FlangeDimensions,
    PipeSize,
    bends,
    caps,
    catalogue,
    flanges_of_pipe,
    flanges_of_rim,
    nearest_pipe_size,
    pipe_size,
    pipe_sizes,
    pipe_walls,
    reducers,
    tees,
    use_folder,
    use_folders,
    using_folder,
)
from pipeworkbench.catalogue.tables import read_table
from pipeworkbench.cli import main
from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipe, Pipeline

PIPES = "outer_diameter,dn,wall_thickness\n"
FLANGES = "standard,flange_type,pn,dn,pipe_diameter,D,K,L,bolts,bolt_size,C,length,neck_diameter,neck_straight\n"
GOOD = "Works 7,11,16,40,48.3,157,110,18,4,M16,20,50,64,7\n"


@pytest.fixture(autouse=True)
def _catalogue_as_before():
    before = catalogue().folders
    yield
    use_folders(before)


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "tables"
    made.mkdir()
    return made


@pytest.fixture
def refused(folder):
    """Give a function that writes a table which must be refused and returns the message without the path."""

    def run(name, text, encoding="utf-8"):
        (folder / name).write_bytes(text.encode(encoding))
        with pytest.raises(InputError) as error:
            use_folder(folder)
        assert catalogue().folders == ()
        message = str(error.value)
        assert message.startswith(f"{folder / name}: ")
        assert "\n" not in message
        return message.removeprefix(f"{folder / name}: ")

    return run


def write(folder, name, text):
    (folder / name).write_text(text, encoding="utf-8")


# ---------------------------------------------------------------- what fits


def test_users_rows_are_found_by_all_functions_and_marked_with_their_file(folder):
    write(folder, "pipes_ours.csv", "# our works' pipes\n" + PIPES + "50.5,41,3.2\n")
    write(folder, "pipe_walls_ours.csv", "outer_diameter,wall_thickness\n50.5,3.2\n")
    write(folder, "bends_ours.csv", "outer_diameter,bend_type,bend_radius\n50.5,3D,70\n")
    write(folder, "flanges_ours.csv", FLANGES + GOOD)
    write(folder, "tees_ours.csv", "run_diameter,branch_diameter,run_length,branch_length\n50.5,26.9,60,55\n")
    write(folder, "reducers_ours.csv", "large_diameter,small_diameter,length\n50.5,26.9,70\n")
    write(folder, "caps_ours.csv", "outer_diameter,height\n50.5,40\n")
    write(folder, "notes.txt", "not a table")
    with using_folder(folder):
        found = [
            pipe_size(50.5), *pipe_walls(50.5), *bends(50.5), *flanges_of_rim(157, 0.1), *tees(50.5, 26.9), *reducers(50.5, 26.9), *caps(50.5),
        ]  # fmt: skip
        assert {type(record).__name__ for record in found} == {"PipeSize", "PipeWall", "Bend", "FlangeDimensions", "Tee", "Reducer", "Cap"}
        assert [record.source for record in found] == [f"{name}_ours.csv" for name in
            ("pipes", "pipe_walls", "bends", "flanges", "tees", "reducers", "caps")]  # fmt: skip
        assert all(record.verified == 0 for record in found)
        assert found[2].standard == "bends_ours"
        assert found[3].standard == "Works 7"
        assert found[3] in flanges_of_pipe(48.3)
        assert nearest_pipe_size(50).dn == 41
    assert pipe_size(50.5) is None


def test_users_row_takes_the_place_of_the_one_with_its_key(folder):
    write(folder, "flanges_ours.csv", FLANGES.replace("\n", ",verified\n") + "EN 1092-1,11,16,40,48.3,150,110,18,4,M16,19,46,64,7,2\n")
    write(folder, "pipes_ours.csv", PIPES + "48.3,40,3.2\n")
    number = len(catalogue().flanges()), len(pipe_sizes())
    with using_folder(folder):
        (flange,) = catalogue().flanges(standard="EN 1092-1", flange_type="11", pn=16, dn=40)
        assert (flange.C, flange.length, flange.verified, flange.source) == (19, 46, 2, "flanges_ours.csv")
        assert (pipe_size(48.3).wall_thickness, pipe_size(48.3).weakest_source, pipe_size(48.3).standard) == (3.2, 0, "pipes_ours")
        assert (len(catalogue().flanges()), len(pipe_sizes())) == number
    assert pipe_size(48.3).wall_thickness == 2.6


def test_table_of_a_spreadsheet_is_read(folder):
    # byte order mark, carriage returns, empty rows of commas, blanks around cells, quoted cells, capitals in the ending
    text = '\ufeff# ours\r\n\r\nouter_diameter , dn,wall_thickness,remark\r\n"50.5",41, 3.2,"a, b"\r\n,,,\r\n'
    (folder / "Pipes_ours.CSV").write_bytes(text.encode())
    with using_folder(folder):
        assert pipe_size(50.5).source == "Pipes_ours.CSV"


def test_blind_flange_is_one_without_a_pipe(folder):
    write(folder, "flanges_ours.csv", FLANGES + "Works 7,BL,16,40,,157,110,18,4,,20,,,\n")
    with using_folder(folder):
        (flange,) = flanges_of_rim(157, 0.1)
        assert flange.blind
        assert flange.length == 20
        assert flange in flanges_of_pipe(48.3)


def test_unknown_column_is_told_and_ignored(folder, caplog):
    write(folder, "pipes_ours.csv", "outer_diameter,dn,wall_thickness,colour\n50.5,41,3.2,red\n")
    with using_folder(folder):
        assert pipe_size(50.5) is not None
    assert "line 1: column 'colour'" in caplog.text


def test_none_keeps_the_catalogue_in_use(folder):
    write(folder, "pipes_ours.csv", PIPES + "50.5,41,3.2\n")
    use_folder(folder)
    with using_folder(None):
        assert pipe_size(50.5) is not None
    use_folder(None)
    assert pipe_size(50.5) is None


def test_catalogue_is_as_before_after_an_error(folder):
    write(folder, "pipes_ours.csv", PIPES + "50.5,41,3.2\n")
    with pytest.raises(ZeroDivisionError), using_folder(folder):
        raise ZeroDivisionError
    assert pipe_size(50.5) is None


# ---------------------------------------------------------------- what does not


@pytest.mark.parametrize(
    ("row", "where", "what"),
    [
        ('"50,5",41,3.2', "line 3: column 'outer_diameter'", "decimal comma"),
        ("50,5,41,3.2", "line 3: column 4", "4 cells for 3 columns"),
        ("fifty,41,3.2", "line 3: column 'outer_diameter'", "'fifty' is not a number"),
        ("50.5 mm,41,3.2", "line 3: column 'outer_diameter'", "without unit"),
        ("50.5,forty,3.2", "line 3: column 'dn'", "'forty' is not a number"),
        ("50.5,4.5,3.2", "line 3: column 'dn'", "whole number"),
        ("-50.5,41,3.2", "line 3: column 'outer_diameter'", "not more than 0"),
        ("0,41,3.2", "line 3: column 'outer_diameter'", "not more than 0"),
        ("50.5,41,-3.2", "line 3: column 'wall_thickness'", "not more than 0"),
        ("nan,41,3.2", "line 3: column 'outer_diameter'", "not a number"),
        ("1e999,41,3.2", "line 3: column 'outer_diameter'", "not a number"),
        ("9" * 400 + ",41,3.2", "line 3: column 'outer_diameter'", "not more than 0"),
        ("1_000,41,3.2", "line 3: column 'outer_diameter'", "not a number"),
        ("0.0505,41,3.2", "line 3: column 'outer_diameter'", "no diameter in mm"),
        ("50.5,41,30", "line 3: column 'wall_thickness'", "half the outside diameter"),
        (",41,3.2", "line 3: column 'outer_diameter'", "is empty"),
        ('50.5,"41,3.2', "line 3", "quotation marks"),
    ],
)
def test_wrong_cell_is_refused_by_line_and_column(refused, row, where, what):
    message = refused("pipes_ours.csv", "# ours\n" + PIPES + row + "\n")
    assert message.startswith(where + ":")
    assert what in message


@pytest.mark.parametrize(
    ("header", "column", "what"),
    [
        ("dn,wall_thickness", "outer_diameter", "is missing"),
        ("outer_diametre,dn", "outer_diametre", "did you mean 'outer_diameter'?"),
        ("outer_diameter,dn,dn", "dn", "two of this name"),
        ("outer_diameter;dn;wall_thickness", "outer_diameter;dn;wall_thickness", "parted by commas"),
    ],
)
def test_wrong_header_is_refused_by_line_and_column(refused, header, column, what):
    message = refused("pipes_ours.csv", f"\n{header}\n50.5,41,3.2\n")
    assert message.startswith(f"line 2: column '{column}': ")
    assert what in message


@pytest.mark.parametrize(
    ("old", "new", "column"),
    [
        (",110,18,", ",140,18,", "K"),  # K + L >= D
        (",4,M16,", ",40,M16,", "bolts"),
        ("M16", "M20", "bolt_size"),
        (",48.3,", ",93,", "pipe_diameter"),
        (",64,7", ",93,7", "neck_diameter"),  # wider than what the bolts leave
        (",64,7", ",40,7", "neck_diameter"),  # narrower than the pipe
        (",20,50,", ",20,18,", "length"),
        (",20,50,", ",20,27,", "length"),  # no room between plate and straight part
        ("11,16,40", "11,16,", "dn"),
        ("Works 7,11", "Works 7,", "flange_type"),
    ],
)
def test_inconsistent_flange_is_refused_by_line_and_column(refused, old, new, column):
    assert old in GOOD
    assert refused("flanges_ours.csv", FLANGES + GOOD.replace("Works 7", "Works 8") + GOOD.replace(old, new)).startswith(
        f"line 3: column '{column}': "
    )


@pytest.mark.parametrize(
    ("name", "text", "column"),
    [
        (
            "flanges_x.csv",
            "pn,dn,pipe_diameter,D,K,L,bolts,C,flange_type,raised_face_diameter\n16,40,48.3,157,110,18,4,20,01,95\n",
            "raised_face_diameter",
        ),
        (
            "flanges_x.csv",
            "pn,dn,pipe_diameter,D,K,L,bolts,C,flange_type,raised_face_height\n16,40,48.3,157,110,18,4,20,01,20\n",
            "raised_face_height",
        ),
        ("flanges_x.csv", "pn,dn,pipe_diameter,D,K,L,bolts,C,flange_type,weld_wall\n16,40,48.3,157,110,18,4,20,01,25\n", "weld_wall"),
        ("bends_x.csv", "outer_diameter,bend_type,bend_radius\n50.5,3D,25\n", "bend_radius"),
        ("bends_x.csv", "outer_diameter,bend_type,bend_radius\n50.5,long,75\n", "bend_type"),
        ("tees_x.csv", "run_diameter,branch_diameter,run_length,branch_length\n26.9,50.5,60,55\n", "branch_diameter"),
        ("tees_x.csv", "run_diameter,branch_diameter,run_length,branch_length\n50.5,26.9,13,55\n", "run_length"),
        ("tees_x.csv", "run_diameter,branch_diameter,run_length,branch_length\n50.5,26.9,60,25\n", "branch_length"),
        ("reducers_x.csv", "large_diameter,small_diameter,length\n26.9,50.5,60\n", "small_diameter"),
        ("caps_x.csv", "outer_diameter,height\n0.1,60\n", "outer_diameter"),
        ("pipe_walls_x.csv", "outer_diameter,wall_thickness\n50.5,26\n", "wall_thickness"),
        ("pipes_x.csv", "outer_diameter,series\n50.5,4\n", "series"),
        ("caps_x.csv", "outer_diameter,height,verified\n50.5,60,3\n", "verified"),
        ("caps_x.csv", "outer_diameter,height,unsourced\n50.5,60,heigth\n", "unsourced"),
    ],
)
def test_inconsistent_row_of_any_table_is_refused_by_line_and_column(refused, name, text, column):
    assert refused(name, text).startswith(f"line 2: column '{column}': ")


def test_repeated_key_is_refused_with_both_lines(refused):
    message = refused("flanges_ours.csv", FLANGES + GOOD + "\n" + GOOD)
    assert message.startswith("line 4: column 'standard': ")
    assert "line 2" in message


def test_key_that_is_in_two_files_is_refused_with_both(folder, refused):
    write(folder, "pipes_a.csv", PIPES + "50.5,41,3.2\n")
    message = refused("pipes_b.csv", PIPES + "50.5,42,3.2\n")
    assert "outer_diameter 50.5 is in pipes_a.csv too" in message


def test_other_encoding_is_refused_by_line_and_column(refused):
    message = refused("pipes_ours.csv", PIPES + "50.5,41,3.2\n60,größer,3\n", encoding="latin-1")
    assert message.startswith("line 3: column 2: ")
    assert "UTF-8" in message


def test_wide_characters_are_refused(refused):
    assert "UTF-8" in refused("pipes_ours.csv", PIPES + "50.5,41,3.2\n", encoding="utf-16")


@pytest.mark.parametrize(("name", "meant"), [("flange_ours.csv", "flanges"), ("valves.csv", None), ("bend.csv", "bends")])
def test_unknown_table_is_refused_with_the_names_that_are_known(refused, name, meant):
    message = refused(name, FLANGES + GOOD)
    assert "flanges_..." in message
    assert (f"did you mean '{meant}'?" in message) == (meant is not None)


@pytest.mark.parametrize("text", ["", "# nothing yet\n\n"])
def test_empty_table_is_refused(refused, text):
    assert "the table is empty" in refused("flanges_ours.csv", text)


def test_folder_that_is_missing_none_or_empty_is_refused(folder, tmp_path):
    for path, what in ((tmp_path / "gone", "no such folder"), (folder, "holds no table")):
        with pytest.raises(InputError, match=what):
            use_folder(path)
    file = tmp_path / "pipes.csv"
    file.write_text(PIPES, encoding="utf-8")
    with pytest.raises(InputError, match="not a folder"):
        use_folder(file)


# ---------------------------------------------------------------- any table at all


@given(st.sampled_from(catalogue().flanges()))
def test_record_survives_being_written_and_read(tmp_path_factory, flange):
    path = tmp_path_factory.mktemp("round") / "flanges.csv"
    values = {field.name: getattr(flange, field.name) for field in dataclasses.fields(flange) if field.name != "source"}
    values["unsourced"] = " ".join(flange.unsourced)
    cells = ("" if value is None else str(value) for value in values.values())
    path.write_text(",".join(values) + "\n" + ",".join(cells) + "\n", encoding="utf-8")
    assert read_table(path, FlangeDimensions) == (flange,)


@given(st.integers(0, 13), st.text(st.characters(exclude_categories=["Cs"]), max_size=12))
def test_whatever_stands_in_a_cell_is_read_or_refused_by_its_line(tmp_path_factory, index, text):
    path = tmp_path_factory.mktemp("any") / "flanges.csv"
    cells = GOOD.strip().split(",")
    cells[index] = text
    path.write_text(FLANGES + ",".join(cells) + "\n", encoding="utf-8", newline="")
    try:
        for record in read_table(path, FlangeDimensions, {"verified": 0}):
            assert record.problem() is None
    except InputError as error:
        assert re.match(r"line [2-9]", error.key)  # noqa: PT017


@given(st.binary(max_size=200))
def test_whatever_is_in_a_file_is_read_or_refused(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("any") / "pipes.csv"
    path.write_bytes(data)
    with pytest.raises(InputError):
        read_table(path, PipeSize)


# ---------------------------------------------------------------- the command line


@pytest.fixture
def pipeline(tmp_path):
    pipe = Pipe(id="p1", start=(0.0, 3000.0, 0.0), end=(2000.0, 3000.0, 0.0), outer_diameter=48.3)
    file = tmp_path / "pipes.json"
    Pipeline.of_station("A", (pipe,)).write(file)
    return file


@pytest.mark.parametrize("command", ["reconstruct", "convert"])
def test_wrong_table_ends_the_command_with_one_line(command, folder, sample, pipeline, tmp_path, capsys):
    write(folder, "flanges_ours.csv", FLANGES + GOOD.replace("157", "-157"))
    source = sample if command == "reconstruct" else pipeline
    assert main([command, str(source), "--out", str(tmp_path / "out.json"), "--catalogue", str(folder)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "flanges_ours.csv: line 2: column 'D': is -157, not more than 0; give a positive number" in line
    assert not (tmp_path / "out.json").exists()
    assert catalogue().folders == ()


def test_conversion_with_tables_of_ones_own_leaves_no_trace(folder, pipeline, tmp_path):
    write(folder, "pipes_ours.csv", PIPES + "50.5,41,3.2\n")
    assert main(["convert", str(pipeline), "--out", str(tmp_path / "out.json"), "--catalogue", str(folder), "--quiet"]) == 0
    assert json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["components"][0]["outer_diameter"] == 48.3
    assert catalogue().folders == ()


@pytest.mark.slow
def test_reconstruction_finds_a_size_of_the_users_table(folder, altered, tmp_path):
    # the sample's pipes are 48.3 mm wide; in this works that is DN 41 with a thicker wall
    write(folder, "pipes_ours.csv", "outer_diameter,series,dn,wall_thickness\n48.3,1,41,4\n")
    station = altered(picks=lambda picks: picks.update(picks=picks["picks"][:1]))
    out = tmp_path / "out.json"
    assert main(["reconstruct", str(station), "--out", str(out), "--catalogue", str(folder), "--quiet"]) == 0
    components = json.loads(out.read_text(encoding="utf-8"))["components"]
    assert {(c["dn"], c["wall_thickness"], c["verified"]) for c in components if c["outer_diameter"] == 48.3} == {(41, 4, 0)}


def test_later_folder_takes_the_place_of_an_earlier_one(tmp_path):
    for name, wall in (("one", "3.2"), ("two", "4.5")):
        (tmp_path / name).mkdir()
        write(tmp_path / name, "pipes_ours.csv", PIPES + f"50.5,41,{wall}\n")
    write(tmp_path / "one", "pipes_more.csv", PIPES + "51.5,42,3\n")
    use_folders((tmp_path / "one", tmp_path / "two"))
    assert (pipe_size(50.5).wall_thickness, pipe_size(51.5).dn) == (4.5, 42)
    use_folders((tmp_path / "two", tmp_path / "one"))
    assert pipe_size(50.5).wall_thickness == 3.2
