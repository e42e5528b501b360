# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command convert: rigs to stations, pipelines to other formats, and one line for what is refused."""

import csv
import json
import shutil
import struct

import cv2
import numpy as np
import pytest

from pipeworkbench.cli import main
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.station import read_station

SIZE = (640, 480)


@pytest.fixture
def rig(tmp_path):
    """A COLMAP text model of three images 0.7 m apart, with its photographs."""
    folder = tmp_path / "model"
    (folder / "images").mkdir(parents=True)
    lines = []
    for index, name in enumerate(("left", "right", "top")):
        cv2.imwrite(str(folder / "images" / f"{name}.png"), np.zeros(SIZE[::-1], np.uint8))
        lines += [f"{index + 1} 1 0 0 0 {-0.7 * (index == 1)} {0.7 * (index == 2)} 0 1 {name}.png", ""]
    (folder / "cameras.txt").write_text("1 SIMPLE_RADIAL 640 480 600.0 320.0 240.0 -0.1\n", encoding="utf-8")
    (folder / "images.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


@pytest.fixture
def pipeline(tmp_path):
    pipe = Pipe(id="p1", start=(0.0, 3000.0, 0.0), end=(2000.0, 3000.0, 0.0), outer_diameter=48.3, dn=40, standard="EN 10220", wall_thickness=2.6)
    file = tmp_path / "pipes.json"
    Pipeline.of_station("A", (pipe,)).write(file)
    return file


@pytest.fixture
def refusal(capsys):
    """Give a function that runs a conversion which must be refused, and returns the line it said."""

    def run(*arguments):
        status = main(["convert", *map(str, arguments)])
        said = capsys.readouterr()
        assert status == 2
        assert said.out == ""
        (line,) = said.err.splitlines()
        return line

    return run


@pytest.mark.parametrize(("unit", "base"), [(("--unit", "m"), 700), (("--unit", "cm"), 7), (("--scale", "1234.5"), 864.15)])
def test_rig_becomes_a_station_that_can_be_read(rig, tmp_path, capsys, unit, base):
    output = tmp_path / "station.json"
    assert main(["convert", str(rig), "--out", str(output), *unit, "--name", "Hall 3", "--up", "0", "-1", "0"]) == 0
    station = read_station(output)
    assert (station.name, [camera.name for camera in station.cameras]) == ("Hall 3", ["left", "right", "top"])
    expected = np.array([[0, 0, 0], [base, 0, 0], [0, 0, base]])
    assert np.array([camera.projection_centre for camera in station.cameras]) == pytest.approx(expected, abs=1e-9)
    # a point straight ahead of the left camera is at COLMAP's (320, 240), which is our (319.5, 239.5)
    assert station.cameras[0].project(np.array([[0.0, 5000.0, 0.0]]))[0] == pytest.approx([319.5, 239.5], abs=1e-9)
    said = capsys.readouterr()
    assert said.out.splitlines() == [f"written: {output}: 3 cameras (colmap), {base:.1f}, {base:.1f} mm from the first"]


def test_binary_model_is_converted_alike(rig, tmp_path):
    text, binary = tmp_path / "text.json", tmp_path / "binary.json"
    arguments = ["--unit", "m", "--image-folder", str(rig / "images"), "--quiet", "--name", "A"]
    assert main(["convert", str(rig), "--out", str(text), *arguments]) == 0
    folder = tmp_path / "binary"
    folder.mkdir()
    (folder / "cameras.bin").write_bytes(struct.pack("<QIiQQ4d", 1, 1, 2, *SIZE, 600, 320, 240, -0.1))
    data = struct.pack("<Q", 3)
    for index, name in enumerate(("left", "right", "top")):
        data += struct.pack("<I7dI", index + 1, 1, 0, 0, 0, -0.7 * (index == 1), 0.7 * (index == 2), 0, 1) + f"{name}.png".encode() + bytes(9)
    (folder / "images.bin").write_bytes(data)
    assert main(["convert", str(folder), "--out", str(binary), *arguments]) == 0
    assert json.loads(text.read_text(encoding="utf-8")) == json.loads(binary.read_text(encoding="utf-8"))


def test_cameras_are_chosen_and_ordered(rig, tmp_path):
    output = tmp_path / "station.json"
    assert main(["convert", str(rig), "--out", str(output), "--unit", "m", "--cameras", "top", "left", "--quiet"]) == 0
    assert [camera.name for camera in read_station(output).cameras] == ["top", "left"]


def test_quiet_says_nothing_and_otherwise_the_assumed_vertical_is_told(rig, tmp_path, capsys, caplog):
    output = tmp_path / "station.json"
    assert main(["convert", str(rig), "--out", str(output), "--unit", "m", "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert main(["convert", str(rig), "--out", str(output), "--unit", "m"]) == 0
    assert "--up" in caplog.text


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        ((), ("model: unit:", "depths and diameters would be wrong", "--unit")),
        (("--scale", "0"), ("--scale", "not a scale")),
        (("--unit", "mm"), ("model: cameras:", "at most 0.7 mm", "--unit")),
        (("--unit", "m", "--cameras", "left", "bottom"), ("--cameras", "'bottom'", "left.png, right.png, top.png")),
        (("--unit", "m", "--cameras", "left"), ("images.txt: cameras:", "two oriented cameras")),
        (("--unit", "m", "--images", "a.png"), ("--images", "1 photographs for 3 cameras")),
        (("--unit", "m", "--image-folder", "nowhere"), ("--image-folder", "no folder nowhere")),
        (("--unit", "m", "--up", "0", "0", "0"), ("--up", "not a direction")),
        (("--format", "kalibr"), ("model", "folder")),
    ],
    ids=lambda value: " ".join(value) or "no unit",
)
def test_what_does_not_fit_is_refused_in_one_line(rig, tmp_path, refusal, arguments, parts):
    output = tmp_path / "station.json"
    line = refusal(rig, "--out", output, *arguments)
    assert all(part in line for part in parts), line
    assert not output.exists()


def test_missing_photographs_are_named(rig, tmp_path, refusal):
    (rig / "images" / "right.png").unlink()
    line = refusal(rig, "--out", tmp_path / "station.json", "--unit", "m")
    assert "the photographs right.png are not in" in line
    assert "--image-folder" in line


@pytest.mark.parametrize(
    ("name", "problem"), [("station.txt", "ends in .json"), ("station.csv", "ends in .json"), ("nowhere/station.json", "no folder")]
)
def test_output_that_is_no_station_is_refused(rig, tmp_path, refusal, name, problem):
    assert problem in refusal(rig, "--out", tmp_path / name, "--unit", "m")


def test_rig_has_one_output(rig, tmp_path, refusal):
    assert "one station" in refusal(rig, "--out", tmp_path / "a.json", "--out", tmp_path / "b.json", "--unit", "m")


def test_inputs_are_never_overwritten(rig, tmp_path, refusal, pipeline):
    file = tmp_path / "stereo.json"
    file.write_text('{"M1": 1, "M2": 2}', encoding="utf-8")
    assert "is an input" in refusal(file, "--out", file)
    assert file.read_text(encoding="utf-8") == '{"M1": 1, "M2": 2}'
    before = pipeline.read_bytes()
    assert "is an input" in refusal(pipeline, "--out", pipeline)
    assert pipeline.read_bytes() == before


def test_second_file_of_a_calibration_is_not_overwritten_either(tmp_path, refusal):
    for name, keys in (("intrinsics.json", ("M1", "D1", "M2", "D2")), ("extrinsics.json", ("R", "T"))):
        values = {key: np.eye(3).tolist() if key[0] in "MR" else np.zeros((1, 5)).tolist() if key[0] == "D" else [1, 0, 0] for key in keys}
        (tmp_path / name).write_text(json.dumps(values), encoding="utf-8")
    assert "is an input" in refusal(tmp_path / "intrinsics.json", "--out", tmp_path / "extrinsics.json", "--unit", "m")


def test_wrong_call_is_one_line(rig, tmp_path, capsys):
    with pytest.raises(SystemExit) as status:
        main(["convert", str(rig), "--out", str(tmp_path / "station.json"), "--unit", "m", "--scale", "3"])
    assert status.value.code == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_station_is_not_converted_to_itself(sample, tmp_path, refusal):
    shutil.copy(sample / "station.json", tmp_path)
    assert "pipeworkbench-pipeline/1" in refusal(tmp_path / "station.json", "--out", tmp_path / "other.json")


# ---------------------------------------------------------------- pipelines


def test_pipeline_is_written_in_several_formats(pipeline, tmp_path, capsys):
    outputs = [tmp_path / name for name in ("copy.json", "table.csv", "model.ifc")]
    assert main(["convert", str(pipeline), *(part for path in outputs for part in ("--out", str(path)))]) == 0
    assert capsys.readouterr().out.splitlines() == [f"written: {path}" for path in outputs]
    assert Pipeline.read(outputs[0]) == Pipeline.read(pipeline)
    with outputs[1].open(encoding="utf-8", newline="") as file:
        assert len(list(csv.DictReader(file))) == 1
    assert outputs[2].read_text(encoding="utf-8").startswith("ISO-10303-21")


def test_take_off_list_is_written_beside_the_table(pipeline, tmp_path, capsys):
    table, listed = tmp_path / "table.csv", tmp_path / "listed.CSV"
    assert main(["convert", str(pipeline), "--out", str(table), "--takeoff", str(listed)]) == 0
    assert capsys.readouterr().out.splitlines() == [f"written: {table}", f"written: {listed}"]
    with listed.open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["kind"], row["dn"], row["quantity"], row["unit"], row["components"]) == ("pipe", "40", "2.0", "m", "p1")


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("list.xlsx", "unknown ending '.xlsx'; use one of .csv"),
        ("copy.csv", "is given twice"),
        ("pipes.json", "unknown ending"),
        ("nowhere/list.csv", "no folder"),
    ],
)
def test_take_off_list_that_could_not_be_written_is_refused_before_anything_is(pipeline, tmp_path, refusal, name, problem):
    assert problem in refusal(pipeline, "--out", tmp_path / "copy.csv", "--takeoff", tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["pipes.json"]


def test_take_off_list_of_a_rig_is_refused(rig, tmp_path, refusal):
    line = refusal(rig, "--out", tmp_path / "station.json", "--unit", "m", "--takeoff", tmp_path / "list.csv")
    assert "--takeoff: is for pipelines" in line


def test_picture_of_a_pipeline_needs_a_station(pipeline, tmp_path, refusal):
    line = refusal(pipeline, "--out", tmp_path / "copy.json", "--out", tmp_path / "picture.png")
    assert "picture.png: a picture needs the station's photographs" in line
    assert not (tmp_path / "copy.json").exists()


@pytest.mark.parametrize("option", [("--unit", "m"), ("--up", "0", "0", "1"), ("--cameras", "a"), ("--name", "A")], ids=lambda option: option[0])
def test_options_of_rigs_are_refused_for_pipelines(pipeline, tmp_path, refusal, option):
    line = refusal(pipeline, "--out", tmp_path / "copy.json", *option)
    assert f"{option[0]}: is for rigs" in line


def test_damaged_pipeline_is_refused_with_its_key(pipeline, tmp_path, refusal):
    data = json.loads(pipeline.read_text(encoding="utf-8"))
    data["components"][0]["outer_diameter"] = -1
    pipeline.write_text(json.dumps(data), encoding="utf-8")
    assert "pipes.json: components[0].outer_diameter" in refusal(pipeline, "--out", tmp_path / "copy.json")
