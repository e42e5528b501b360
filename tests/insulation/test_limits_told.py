# SPDX-License-Identifier: LGPL-2.1-or-later
"""What `pipeworkbench insulate` tells as the largest or smallest value that works does work."""

import json

import pytest
from insulated_pipework import Pen

from pipeworkbench.cli import main

WOOL = {"layers": [{"material": "mineral wool", "thickness": 30}]}


def summary(capsys, *arguments):
    assert main(["insulate", *map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def refusal(capsys, *arguments):
    assert main(["insulate", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def specified(folder, **keys):
    path = folder / "asked.json"
    path.write_text(json.dumps({"schema": "pipeworkbench-insulation/1", "default": WOOL} | keys), encoding="utf-8")
    return path


def test_the_largest_thickness_told_of_a_box_works(tmp_path, capsys):
    file = tmp_path / "flange.json"
    Pen().flange(faces_on=False).pipe(500.0).elbow((0, 1, 0)).pipe(800.0).pipeline().write(file)
    thick = {"default": {"layers": [{"material": "mineral wool", "thickness": 300}]}}
    said = refusal(capsys, file, "--spec", specified(tmp_path, **thick))
    assert said.startswith("pipeworkbench: F1: thickness: 300 mm is more than half the length of the box allows; give at most ")
    largest = float(said.partition("give at most ")[2].split(" mm")[0])
    for change, works in ((0.0, True), (0.2, False)):
        layer = {"material": "mineral wool", "thickness": largest + change}
        spec = specified(tmp_path, **thick, rules=[{"match": {"ids": ["F1"]}, "layers": [layer]}])
        assert main(["insulate", str(file), "--spec", str(spec), "--quiet"]) == (0 if works else 2)


def test_the_largest_thickness_told_of_a_bend_that_turns_back_works(tmp_path, capsys):
    file = tmp_path / "back.json"
    Pen().pipe(400.0).elbow((0, 1, 0), 170.0, 90.0).pipe(400.0).pipeline().write(file)
    largest = float(refusal(capsys, file, "--thickness", 150).partition("give at most ")[2].split(" mm")[0])
    assert summary(capsys, file, "--thickness", largest)["bare"] == []


@pytest.mark.parametrize("key", ["longitudinal_overlap", "circumferential_overlap"])
def test_the_largest_overlap_told_works(tmp_path, capsys, key):
    file = tmp_path / "pipe.json"
    Pen().pipe(900.0).cap().pipeline().write(file)
    said = refusal(capsys, file, "--spec", specified(tmp_path, default=WOOL | {"seams": {key: 2500}}))
    largest = float(said.partition("give at most ")[2].split(" mm")[0])
    rule = {"match": {"ids": [said.split(": ")[1]]}, "seams": {key: largest}}
    rest = specified(tmp_path, rules=[rule])
    assert summary(capsys, file, "--spec", rest)["bare"] == []


def test_the_sheet_told_for_a_disc_works(tmp_path, capsys):
    file = tmp_path / "flange.json"
    Pen().flange(faces_on=False).pipe(500.0).pipeline().write(file)
    said = refusal(capsys, file, "--spec", specified(tmp_path, sheet_sizes=[{"width": 120, "height": 120}]))
    width, height = said.partition("take a sheet of at least ")[2].split(" mm")[0].split(" x ")
    spec = specified(tmp_path, sheet_sizes=[{"width": float(width), "height": float(height)}])
    assert summary(capsys, file, "--spec", spec)["bare"] == []
