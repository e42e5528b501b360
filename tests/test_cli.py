# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: what it refuses and how, and the whole way from photographs to files."""

import argparse
import csv
import json
import logging
import os
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from conftest import ROOT, altered_station

from pipeworkbench import cli
from pipeworkbench.cli import MOST_LISTED, main
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.picks import MOST_ALTERNATIVES, read_picks
from pipeworkbench.recon.station import read_station

PIPE_PICKS, FLANGE_PICKS = 9, 4  # of the sample


def rename(mapping, old, new):
    mapping[new] = mapping.pop(old)


@pytest.fixture
def out(tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    return folder


@pytest.fixture
def refusal(out, capsys, caplog):
    """Give a function that runs a command which must be refused and returns the line it said."""

    def run(station, *more, output=None):
        status = main(["reconstruct", "--out", str(output or out / "result.json"), str(station), *map(str, more)])
        said = capsys.readouterr()
        assert status == 2
        assert said.out == ""
        lines = said.err.splitlines()
        assert len(lines) == 1, said.err
        assert "Traceback" not in lines[0]
        assert list(out.iterdir()) == []
        return lines[0]

    return run


# ---------------------------------------------------------------- the station


def test_missing_image_is_named_with_its_key(altered, refusal):
    line = refusal(altered(station=lambda s: s["cameras"][1].update(image="gone.jpg")))
    assert "station.json: cameras[1].image:" in line
    assert "gone.jpg" in line


@pytest.mark.parametrize(
    ("change", "key", "right"),
    [
        (lambda s: rename(s["cameras"][0]["interior"], "principal_point", "principal_pont"), "cameras[0].interior", "principal_point"),
        (lambda s: rename(s["cameras"][2]["interior"], "pixel_pitch", "pixelpitch"), "cameras[2].interior", "pixel_pitch"),
        (lambda s: rename(s["cameras"][1]["exterior"], "projection_centre", "projection_center"), "cameras[1].exterior", "projection_centre"),
        (lambda s: rename(s, "level_from_rig", "level_form_rig"), "level_form_rig", "level_from_rig"),
        (lambda s: rename(s, "cameras", "camera"), "camera", "cameras"),
    ],
    ids=["principal_point", "pixel_pitch", "projection_centre", "level_from_rig", "cameras"],
)
def test_misspelt_key_is_refused_with_the_right_spelling(altered, refusal, change, key, right):
    line = refusal(altered(station=change))
    assert "station.json: " in line
    assert key in line
    assert "did you mean" in line or "rename" in line
    assert f"'{right}'" in line or f".{right}:" in line


def test_misspelt_optional_key_is_not_silently_ignored(altered, refusal):
    # a distortion that is lost without a word would spoil every result
    line = refusal(altered(station=lambda s: s.update(lenght_unit=s.pop("length_unit"))))
    assert "station.json: lenght_unit:" in line
    assert "did you mean 'length_unit'?" in line


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (lambda s: s.pop("level_from_rig"), "level_from_rig"),
        (lambda s: s["cameras"][1].pop("width"), "cameras[1].width"),
        (lambda s: s["cameras"][2]["interior"].pop("principal_distance"), "cameras[2].interior.principal_distance"),
        (lambda s: s["cameras"][0]["exterior"].pop("projection_centre"), "cameras[0].exterior.projection_centre"),
        (lambda s: s["cameras"][0].pop("interior"), "cameras[0].interior"),
    ],
)
def test_missing_key_is_named(altered, refusal, change, key):
    line = refusal(altered(station=change))
    assert f"station.json: {key}: is missing" in line


def test_rotation_that_is_not_orthonormal_is_refused(altered, refusal):
    def shear(station):
        station["cameras"][1]["exterior"]["rotation_rig_to_camera"][0][1] += 0.01

    line = refusal(altered(station=shear))
    assert "station.json: cameras[1].exterior.rotation_rig_to_camera:" in line
    assert "not orthonormal" in line


def test_reflection_is_refused_as_a_rotation(altered, refusal):
    def mirror(station):
        station["level_from_rig"][0] = [-x for x in station["level_from_rig"][0]]

    line = refusal(altered(station=mirror))
    assert "station.json: level_from_rig:" in line
    assert "reflection" in line


def test_image_of_another_size_than_the_calibration_is_refused(altered, refusal):
    def widen(station):
        for camera in station["cameras"]:
            camera["width"] += 8

    line = refusal(altered(station=widen))
    assert "station.json: cameras[0].image:" in line
    assert "2592 x 1944" in line
    assert "2600 x 1944" in line


def test_file_that_is_no_image_is_refused(altered, refusal):
    folder = altered()
    for image in folder.glob("*.jpg"):
        image.unlink()
        image.write_bytes(b"this is no photograph")
    line = refusal(folder)
    assert "station.json: cameras[0].image:" in line


def test_unknown_model_of_the_interior_orientation_is_refused(altered, refusal):
    line = refusal(altered(station=lambda s: s["cameras"][0]["interior"].update(model="fisheye")))
    assert "station.json: cameras[0].interior" in line
    assert "opencv" in line


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (lambda s: s["cameras"][1]["interior"]["principal_point"].pop(), "cameras[1].interior.principal_point"),
        (lambda s: s["cameras"][0]["exterior"]["projection_centre"].pop(), "cameras[0].exterior.projection_centre"),
        (lambda s: s["level_from_rig"].pop(), "level_from_rig"),
    ],
)
def test_list_that_is_too_short_is_refused_with_its_key(altered, refusal, change, key):
    assert f"station.json: {key}" in refusal(altered(station=change))


def test_list_that_is_too_long_is_refused_with_its_key(altered, refusal):
    line = refusal(altered(station=lambda s: s["cameras"][1]["interior"]["principal_point"].append(0.0)))
    assert "station.json: cameras[1].interior.principal_point:" in line


def test_single_camera_is_refused(altered, refusal):
    line = refusal(altered(station=lambda s: s.update(cameras=s["cameras"][:1])))
    assert "station.json: cameras:" in line


def test_two_cameras_of_one_name_are_refused(altered, refusal):
    line = refusal(altered(station=lambda s: s["cameras"][1].update(name="left")))
    assert "station.json: cameras:" in line
    assert "not unique" in line


def test_coinciding_projection_centres_are_refused(altered, refusal):
    def metres(station):
        for camera in station["cameras"]:
            camera["exterior"]["projection_centre"] = [x / 1000 for x in camera["exterior"]["projection_centre"]]

    line = refusal(altered(station=metres))
    assert "station.json: cameras:" in line
    assert "mm" in line


def test_missing_station_is_named(tmp_path, refusal):
    line = refusal(tmp_path / "nowhere")
    assert "nowhere" in line
    assert "no such file" in line


def test_file_that_is_not_json_is_refused_with_the_place(altered, refusal):
    folder = altered()
    (folder / "station.json").write_text('{"schema": "pipeworkbench-station/1",\n "name" "A"}', encoding="utf-8")
    line = refusal(folder)
    assert "station.json: line 2, column 9:" in line


@pytest.mark.parametrize("text", ["[]", "3", '"A"', "null"])
def test_json_that_is_no_object_is_refused(altered, refusal, text):
    folder = altered()
    (folder / "station.json").write_text(text, encoding="utf-8")
    assert "station.json: is not a JSON object" in refusal(folder)


def with_number(folder, file, number):
    """Write a number, as JSON spells it, into a file of a station."""
    path = folder / file
    path.write_text(path.read_text(encoding="utf-8").replace("987654321", number), encoding="utf-8")
    return folder


def marked_station(station):
    station["cameras"][1]["interior"]["principal_distance"] = 987654321


def marked_pick(picks):
    picks["picks"][2]["edges"][0][1][0] = 987654321


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_number_that_is_not_finite_is_refused(altered, refusal, number):
    assert "station.json: " in refusal(with_number(altered(station=marked_station), "station.json", number))


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_number_that_is_not_finite_is_refused_with_its_key(altered, refusal, number):
    line = refusal(with_number(altered(station=marked_station), "station.json", number))
    assert "station.json: cameras[1].interior.principal_distance:" in line


@pytest.mark.parametrize("number", ["NaN", "1e999"])
def test_pick_that_is_not_finite_is_refused_with_its_key(altered, refusal, number):
    line = refusal(with_number(altered(picks=marked_pick), "picks.json", number))
    assert "picks.json: picks[2].edges[0][1][0]:" in line


# ---------------------------------------------------------------- the picks


def only(number, change):
    """Return a change of a picks file: one pick alone, altered."""

    def alter(picks):
        picks["picks"] = [picks["picks"][number]]
        change(picks["picks"][0])

    return alter


def test_pick_outside_the_image_alone_is_refused(altered, refusal):
    line = refusal(altered(picks=only(3, lambda pick: pick["edges"][1][0].__setitem__(0, 2600.0))))
    assert "picks.json: picks: no pipe fits the images (pick 0: the point (2600, " in line
    assert "outside the image of 2592 x 1944 pixels; click inside the image" in line


def test_both_edges_the_same_edge_alone_are_refused(altered, refusal):
    def repeat(pick):
        (u1, v1), (u2, v2) = pick["edges"][0]
        pick["edges"][1] = [[u1 + 20, v1], [u2 - 15, v2 + 1]]

    assert "pick 0: both edges are the same edge" in refusal(altered(picks=only(1, repeat)))


def test_points_too_near_together_alone_are_refused(altered, refusal):
    line = refusal(altered(picks=only(0, lambda pick: pick["edges"].__setitem__(1, [[487.4, 1201.7], [487.4, 1196.7]]))))
    assert "pick 0: the points of edges[1] are only 5.0 px apart" in line


@pytest.mark.parametrize("shorten", [lambda pick: pick["edges"].pop(), lambda pick: pick["edges"][0].pop(), lambda pick: pick["edges"][0][0].pop()])
def test_pick_with_too_few_points_is_refused(altered, refusal, shorten):
    assert "picks.json: picks[0].edges" in refusal(altered(picks=lambda p: shorten(p["picks"][0])))


def test_edges_across_each_other_alone_are_refused(altered, refusal):
    line = refusal(altered(picks=only(0, lambda pick: pick["edges"].__setitem__(1, [[300.0, 1000.0], [700.0, 1000.0]]))))
    assert "pick 0: the edges are not the two sides of one pipe (more than 45 deg apart)" in line


@pytest.mark.slow
def test_bad_picks_are_told_and_the_others_still_processed(altered, out, capsys):
    def spoil(picks):
        good = picks["picks"][0]
        outside = {**good, "edges": [good["edges"][0], [[2600.0, 10.0], [2600.0, 100.0]]]}
        (a, b), (c, d) = good["edges"]
        crossing = {**good, "edges": [[a, d], [c, b]]}
        wall = {**good, "camera": "left", "edges": [[[100.0, 1800.0], [100.0, 1700.0]], [[160.0, 1800.0], [160.0, 1700.0]]], "diameter": 1.0}
        picks["picks"] = [outside, good, crossing, {**good, "edges": [e[::-1] for e in good["edges"]]}, wall]

    assert main(["reconstruct", str(altered(picks=spoil)), "--out", str(out / "result.json"), "--json", "--alternatives", "2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert [pipe["pick"] for pipe in summary["components"]] == [1]
    reasons = {one["pick"]: one["reason"] for one in summary["failed_picks"]}
    assert list(reasons) == [0, 2, 3, 4]
    for pick, words in ((0, "outside the image"), (2, "cross"), (3, "same as those of picks[1]"), (4, "diameter of 1 mm is outside")):
        assert words in reasons[pick]
        assert "; " in reasons[pick]
    ranked = next(entry["ranked"] for entry in summary["alternatives"] if entry["pick"] == 1)
    assert [one["alternative"] for one in ranked] == list(range(1, len(ranked) + 1))
    assert ranked[0]["chosen"]
    assert ranked[0]["outer_diameter"] == summary["components"][0]["outer_diameter"]


@pytest.mark.parametrize("number", ["0", "7"])
def test_number_of_alternatives_that_is_none_is_refused(sample, refusal, number):
    assert "--alternatives" in refusal(sample, "--alternatives", number)


def test_as_many_alternatives_are_listed_as_a_pick_may_name():
    assert MOST_LISTED == MOST_ALTERNATIVES


def test_picks_are_given_once_per_station(sample, refusal):
    line = refusal(sample, sample, "--picks", sample / "picks.json")
    assert "--picks" in line
    assert "2 stations" in line


def test_alternatives_of_several_stations_are_refused(sample, refusal):
    assert "--alternatives" in refusal(sample, sample, "--alternatives", "2")


def test_tolerances_without_an_adjustment_are_refused(sample, refusal):
    assert "--no-adjustment" in refusal(sample, "--no-adjustment", "--tolerance")


def test_two_stations_of_one_name_are_refused(sample, refusal):
    assert "name" in refusal(sample, sample)


def test_alternatives_without_picks_are_refused(sample, refusal):
    assert "--alternatives" in refusal(sample, "--auto", "--alternatives", "3")


def test_empty_list_of_picks_is_refused(altered, refusal):
    assert "picks.json: picks:" in refusal(altered(picks=lambda p: p.update(picks=[])))


def test_missing_list_of_picks_is_refused(altered, refusal):
    assert "picks.json: picks: is missing" in refusal(altered(picks=lambda p: p.pop("picks")))


def test_pick_in_an_unknown_camera_is_refused_with_the_known_ones(altered, refusal):
    line = refusal(altered(picks=lambda p: p["picks"][4].update(camera="middle")))
    assert "picks.json: picks[4].camera:" in line
    assert "left, right, top" in line


def test_unknown_kind_of_pick_is_refused(altered, refusal):
    line = refusal(altered(picks=lambda p: p["picks"][2].update(kind="tube")))
    assert "picks.json: picks[2]" in line
    assert "tube" in line


def test_picks_of_another_station_are_refused(altered, refusal):
    line = refusal(altered(picks=lambda p: p.update(station="B")))
    assert "picks.json: station:" in line
    assert "'B'" in line


def test_picks_of_another_schema_are_refused(altered, refusal):
    assert "picks.json: schema:" in refusal(altered(picks=lambda p: p.update(schema="pipeworkbench-picks/9")))


def test_picks_that_are_not_json_are_refused(altered, refusal):
    folder = altered()
    (folder / "picks.json").write_text("{", encoding="utf-8")
    assert "picks.json: line 1, column 2:" in refusal(folder)


def test_missing_picks_file_is_named(sample, tmp_path, refusal):
    line = refusal(sample, "--picks", tmp_path / "other_picks.json")
    assert "other_picks.json: there is no such file" in line


def test_pick_where_no_pipe_can_be_is_refused(altered, refusal):
    def only_the_background(picks):
        edges = [[[100.0, 1800.0], [100.0, 1700.0]], [[160.0, 1800.0], [160.0, 1700.0]]]
        picks["picks"] = [{"kind": "pipe", "camera": "left", "edges": edges, "diameter": 1.0}]

    line = refusal(altered(picks=only_the_background))
    assert "picks.json: picks: no pipe fits the images" in line


# ---------------------------------------------------------------- the call


def test_unknown_ending_of_an_output_is_refused_with_the_known_ones(sample, out, refusal):
    line = refusal(sample, output=out / "result.docx")
    assert "result.docx" in line
    assert ".json" in line
    assert ".ifc" in line


def test_missing_output_folder_is_refused(sample, out, refusal):
    line = refusal(sample, output=out / "not_there" / "result.json")
    assert "not_there" in line
    assert "folder" in line


def test_output_that_is_given_twice_is_refused(sample, out, refusal):
    assert "given twice" in refusal(sample, "--out", out / "." / "result.json")


@pytest.mark.parametrize(
    ("name", "problem"), [("list.json", "list.json: unknown ending '.json'"), ("result.csv", "is given twice"), ("nowhere/list.csv", "no folder")]
)
def test_take_off_list_that_could_not_be_written_is_refused(sample, out, refusal, name, problem):
    assert problem in refusal(sample, "--takeoff", out / name, output=out / "result.csv")


def test_output_that_is_a_folder_is_refused(sample, tmp_path, refusal):
    (tmp_path / "folder.json").mkdir()
    assert "folder.json" in refusal(sample, output=tmp_path / "folder.json")


@pytest.mark.parametrize(("option", "values"), [("--working-range", ("8000", "3000")), ("--diameters", ("0", "100")), ("--diameters", ("nan", "5"))])
def test_range_that_is_none_is_refused(sample, refusal, option, values):
    assert option in refusal(sample, option, *values)


@pytest.mark.parametrize(
    ("option", "values"),
    [
        ("--working-range", ("1", "1e300")),
        ("--working-range", ("1", "5000")),
        ("--working-range", ("1e-300", "1e-299")),
        ("--diameters", ("49", "50")),
    ],
)
def test_range_that_holds_nothing_sensible_is_refused(sample, refusal, option, values):
    assert option in refusal(sample, option, *values)


@pytest.mark.parametrize("name", ["station.json", "picks.json"])
def test_output_over_an_input_is_refused_and_the_input_kept(altered, refusal, name):
    folder = altered()
    before = (folder / name).read_bytes()
    assert "is an input" in refusal(folder, output=folder / name)
    assert (folder / name).read_bytes() == before


def test_output_name_that_no_disk_takes_is_refused(sample, out, refusal):
    assert "too long" in refusal(sample, output=out / ("x" * 300 + ".json"))


@pytest.mark.parametrize(
    "change",
    [
        {"A1": 1000.0},
        {"A1": 1e300},
        {"A2": 1.0},
        {"principal_distance": 0.001},
        {"principal_distance": 1e300},
        {"principal_point": [1e9, 0.0]},
        {"pixel_pitch": 1e-300},
    ],
    ids=str,
)
def test_lens_that_cannot_be_is_refused(altered, refusal, change):
    line = refusal(altered(station=lambda s: s["cameras"][1]["interior"].update(change)))
    assert "station.json: cameras[1].interior:" in line


OPENCV = {"model": "opencv", "fx": 6500.0, "fy": 6500.0, "cx": 1295.5, "cy": 971.5, "distortion": [-0.3, 0.1, 0, 0]}


def test_opencv_lens_of_a_real_kind_is_taken(altered):
    station = read_station(altered(station=lambda s: s["cameras"][1].update(interior=OPENCV)))
    assert station.cameras[1].interior.fx == 6500


@pytest.mark.parametrize("distortion", [[1e6, 0, 0, 0], [-5.0, 0, 0, 0], [1e300, 0, 0, 0]])
def test_opencv_distortion_that_folds_the_image_is_refused(altered, refusal, distortion):
    folded = OPENCV | {"fx": 1500.0, "fy": 1500.0, "distortion": distortion}
    assert "cameras[1].interior:" in refusal(altered(station=lambda s: s["cameras"][1].update(interior=folded)))


@pytest.mark.parametrize("centre", [[1e9, 0.0, 0.0], [1e300, 0.0, 0.0]])
def test_camera_a_world_away_is_refused(altered, refusal, centre):
    line = refusal(altered(station=lambda s: s["cameras"][1]["exterior"].update(projection_centre=centre)))
    assert "cameras[1].exterior.projection_centre[0]:" in line


def test_image_given_for_two_cameras_is_refused(altered, refusal):
    assert "cameras[1].image:" in refusal(altered(station=lambda s: s["cameras"][1].update(image="left.jpg")))


def test_image_name_that_no_disk_takes_is_refused(altered, refusal):
    assert "cameras[1].image:" in refusal(altered(station=lambda s: s["cameras"][1].update(image="x" * 5000)))


def test_control_characters_of_a_name_do_not_break_up_the_message(altered, refusal):
    line = refusal(altered(station=lambda s: s["cameras"][1].update(image="one\ntwo\x1b[31m.jpg")))
    assert "one\\ntwo\\x1b" in line


def test_picks_given_as_the_station_are_told_by_their_schema(sample, refusal):
    assert "picks.json: schema:" in refusal(sample / "picks.json")


def test_flange_picks_alone_are_told_as_such(altered, refusal):
    line = refusal(altered(picks=lambda p: p.update(picks=[pick for pick in p["picks"] if pick["kind"] == "flange"])))
    assert "only flange picks" in line


@pytest.mark.parametrize(
    "arguments",
    [[], ["rebuild"], ["reconstruct"], ["reconstruct", "somewhere"], ["reconstruct", "somewhere", "--out", "a.json", "--diameters", "few", "many"]],
)
def test_wrong_call_exits_with_2_and_one_line(capsys, arguments):
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_version_is_printed(capsys):
    import pipeworkbench

    with pytest.raises(SystemExit) as exit_:
        main(["--version"])
    assert exit_.value.code == 0
    assert capsys.readouterr().out.strip() == pipeworkbench.__version__


# ---------------------------------------------------------------- harmless input


def test_unknown_harmless_keys_are_ignored_with_a_warning(altered, caplog):
    def decorate(station):
        station["photographer"] = "somebody"
        station["cameras"][0]["serial_number"] = 4711
        station["cameras"][2]["interior"]["calibrated_on"] = "a Monday"

    folder = altered(station=decorate, picks=lambda p: p["picks"][0].update(remark="left of the pump", truth="P01"))
    with caplog.at_level(logging.WARNING):
        station = read_station(folder)
        picks = read_picks(folder / "picks.json", station)
    assert len(station.cameras) == 3
    assert len(picks.pipes) == PIPE_PICKS
    said = "\n".join(caplog.messages)
    for key in ("photographer", "cameras[0].serial_number", "cameras[2].interior.calibrated_on"):
        assert f"station.json: {key}: unknown key, ignored" in said


# ---------------------------------------------------------------- the whole way

WATCHED_RUN = """
import json, runpy, sys
from pathlib import Path

log = Path(sys.argv.pop(1))
opened = []
sys.addaudithook(lambda event, arguments: opened.append(str(arguments[0])) if event == "open" else None)
try:
    runpy.run_module("pipeworkbench", run_name="__main__", alter_sys=True)
finally:
    names = list(opened)
    log.write_text(json.dumps(names))
"""
ENDINGS = (".json", ".ifc", ".step", ".png", ".csv")


def watched(folder: Path, station: Path, *more: str) -> tuple[subprocess.CompletedProcess[str], list[str]]:
    """Run the program in a process of its own; return what it said and the names of all files it opened."""
    script, log = folder / "watched_run.py", folder / "opened.json"
    script.write_text(WATCHED_RUN, encoding="utf-8")
    command = [sys.executable, str(script), str(log), "reconstruct", str(station), "--json", *more]
    for ending in ENDINGS:
        command += ["--out", str(folder / "results" / f"dummy{ending}")]
    (folder / "results").mkdir()
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=600, env={**os.environ, "PYTHONPATH": str(ROOT)})
    return done, json.loads(log.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def sample_run(sample, tmp_path_factory):
    """The sample, reconstructed in a process of its own with decoys beside it that must not be opened."""
    folder = tmp_path_factory.mktemp("run")
    station = altered_station(sample, folder / "scene" / "A")
    for place in (station, station.parent):
        (place / "truth.json").write_text("{}", encoding="utf-8")
    done, opened = watched(folder, station)
    assert done.returncode == 0, done.stderr
    return folder / "results", done, opened


def score(shared: Path, result: Path) -> dict:
    scene = shared / "scenes" / "dummy"
    command = [sys.executable, str(shared / "tools" / "score.py"), str(result), str(scene), "--picks", str(scene / "A" / "picks.json"), "--json"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["pipes"]


def assert_good(pipes: dict) -> None:
    assert pipes["n"] == PIPE_PICKS
    assert pipes["correct"] >= 8
    assert pipes["position_mm"]["mean"] <= 2.0
    assert pipes["direction_deg"]["mean"] <= 0.5


@pytest.mark.slow
def test_run_opens_the_inputs_and_nothing_called_truth(sample_run):
    _, _, opened = sample_run
    names = {Path(name).name for name in opened}
    assert {"station.json", "picks.json", "left.jpg", "right.jpg", "top.jpg"} <= names
    assert not [name for name in names if "truth" in name.lower()]


@pytest.mark.slow
def test_every_pipe_pick_of_the_sample_is_answered(sample_run):
    folder, _, _ = sample_run
    pipeline = Pipeline.read(folder / "dummy.json")
    assert [pipe.pick for pipe in pipeline.pipes] == list(range(PIPE_PICKS))
    assert len({pipe.id for pipe in pipeline.pipes}) == PIPE_PICKS


@pytest.mark.slow
def test_json_summary_parses_and_agrees_with_the_pipeline(sample_run):
    folder, done, _ = sample_run
    summary = json.loads(done.stdout)
    assert done.stderr == ""
    assert summary["station"] == "A"
    assert summary["pipes"] == PIPE_PICKS
    assert summary["failed_picks"] == []
    assert summary["components"] == json.loads((folder / "dummy.json").read_text(encoding="utf-8"))["components"]
    assert sorted(Path(name).suffix for name in summary["outputs"]) == sorted(ENDINGS)


@pytest.mark.slow
def test_every_output_is_written_and_nothing_else_is_left(sample_run):
    folder, _, _ = sample_run
    assert sorted(path.name for path in folder.iterdir()) == sorted(f"dummy{ending}" for ending in ENDINGS)
    import ifcopenshell

    assert len(ifcopenshell.open(str(folder / "dummy.ifc")).by_type("IfcPipeSegment")) == PIPE_PICKS
    with (folder / "dummy.csv").open(encoding="utf-8", newline="") as file:
        kinds = [row["kind"] for row in csv.DictReader(file)]
    assert kinds.count("pipe") == PIPE_PICKS
    assert kinds.count("flange") == FLANGE_PICKS
    assert kinds.count("elbow") >= 5
    assert (folder / "dummy.step").read_text(encoding="ascii").startswith("ISO-10303-21")
    picture = cv2.imread(str(folder / "dummy.png"))
    assert picture.shape[1] > 2 * picture.shape[0]
    assert np.ptp(picture) > 100


@pytest.mark.slow
def test_sample_agrees_with_the_known_truth(sample_run, shared):
    folder, _, _ = sample_run
    assert_good(score(shared, folder / "dummy.json"))


@pytest.mark.slow
def test_uncompressed_images_agree_with_the_known_truth(shared, tmp_path, capsys):
    result = tmp_path / "result.json"
    assert main(["reconstruct", str(shared / "scenes" / "dummy" / "A"), "--out", str(result), "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert_good(score(shared, result))


def test_auto_and_picks_exclude_each_other(sample, refusal):
    said = refusal(sample, "--auto", "--picks", str(sample / "picks.json"))
    assert "--auto" in said
    assert "give one of the two" in said


@pytest.mark.slow
def test_pipes_are_found_without_picks_and_agree_with_the_known_truth(sample, shared, tmp_path, altered):
    station = altered()
    (station / "picks.json").unlink()
    result = tmp_path / "auto.json"
    assert main(["reconstruct", str(station), "--auto", "--out", str(result), "--quiet"]) == 0
    pipeline = Pipeline.read(result)
    assert all(pipe.pick is None for pipe in pipeline.pipes)
    assert len({pipe.id for pipe in pipeline.pipes}) == len(pipeline.pipes)
    command = [sys.executable, str(shared / "tools" / "score.py"), str(result), str(shared / "scenes" / "dummy"), "--auto", "--json"]
    found = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    assert found["pipes"]["correct"] >= 7
    assert found["false_pipes"] <= 1
    assert found["duplicate_pipes"] == 0
    assert found["pipes"]["position_mm"]["mean"] <= 1.0


def test_stations_that_stay_apart_are_written_beside_whatever_they_are_called(tmp_path):
    pipelines = [
        Pipeline.of_station(name, (Pipe(id="P1", start=(0, 0, 0), end=(0, 0, 900.0), outer_diameter=48.3),)) for name in ("A", "../B:1", "..?B 1")
    ]
    options = argparse.Namespace(out=[tmp_path / "plant.json", tmp_path / "plant.csv"], language="en", ifc_schema="IFC4", takeoff=None)
    outputs = cli._written(options, pipelines[0], pipelines[1:], ())
    assert len(set(outputs)) == 6
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(path.name for path in outputs)
    assert {Pipeline.read(path).frame for path in outputs if path.suffix == ".json"} == {"A", "../B:1", "..?B 1"}
