# SPDX-License-Identifier: LGPL-2.1-or-later
"""The benchmark of elbows and flanges: it judges as the judge does, and its made-up pipework is what it says."""

import dataclasses
import json
import subprocess
import sys
import warnings
from types import SimpleNamespace

import elbows_flanges
import numpy as np
import pytest
import scenes
from synthetic import views_without_edges

from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, moved
from pipeworkbench.recon.picks import FlangePick
from pipeworkbench.recon.station import read_station


@pytest.fixture(scope="module")
def cameras(sample):
    return read_station(sample).cameras


@pytest.fixture(scope="module")
def scene(shared):
    with warnings.catch_warnings():
        # the judge leaves files open
        warnings.simplefilter("ignore", ResourceWarning)
        return scenes.Scene(scenes.judge(shared), shared / "scenes" / "dummy" / "A")


def true_components(scene):
    """Return the true pipes, elbows and picked flanges in the station's frame."""
    pick = {name: index for index, name in enumerate(scene.truth_of_pick)}
    kinds = [(Pipe, scene.pipes), (Elbow, scene.elbows), (Flange, scene.flanges)]
    level_from_world = tuple(map(tuple, np.linalg.inv(scene.world_from_level).tolist()))
    made = {}
    for kind, truths in kinds:
        names = {field.name for field in dataclasses.fields(kind)}
        for name, true in truths.items():
            known = {"flange_type": true["type"]} if kind is Flange else {}
            known |= {key: tuple(value) if isinstance(value, list) else value for key, value in true.items() if key in names}
            made[name] = moved(kind(**known, pick=pick.get(name)), level_from_world)
    return made


def judgement(scene, components, folder):
    """Return what the judge itself says of the components."""
    Pipeline.of_station(scene.folder.name, tuple(components)).write(folder / "result.json")
    arguments = [folder / "result.json", scene.folder.parent, "--picks", scene.folder / "picks.json", "--json"]
    return json.loads(subprocess.run([sys.executable, scene.score.__file__, *arguments], capture_output=True, check=True).stdout)


def judged(scene, components):
    sorted_out = elbows_flanges.components_of(scene, Pipeline.of_station(scene.folder.name, tuple(components)))
    return elbows_flanges.judged_elbows(scene, sorted_out), elbows_flanges.judged_flanges(scene, sorted_out)


def beside(component, by):
    """Return a component moved along x, mm."""
    return moved(component, ((1.0, 0.0, 0.0, by), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)))


def test_truth_is_right(scene):
    (bent, first), (flanged, second) = judged(scene, true_components(scene).values())
    assert (bent.asked, bent.there, bent.false, bent.right) == (6, 6, 0, 6)
    assert (flanged.picks, len(flanged.off), flanged.types, flanged.classes, flanged.false) == (4, 4, 4, 4, 0)
    assert max(*bent.off, *(value for off in flanged.off for value in off)) < 1e-3
    assert first == second == []


def test_faults_are_counted_as_the_judge_counts_them(scene, tmp_path):
    made = true_components(scene)
    made["E00"] = dataclasses.replace(beside(made["E00"], 2.0), bend_type="5D")
    made["E01"] = beside(made["E01"], 40.0)
    made["F00"] = dataclasses.replace(made["F00"], flange_type="01")
    same = {"flange_type": made["F01"].flange_type, "pn": made["F01"].pn, "standard": "EN 1092-1"}
    made["F01"] = dataclasses.replace(beside(made["F01"], 1.0), flange_type="12", equivalents=(same,))
    made["F02"] = beside(made["F02"], 60.0)
    (bent, first), (flanged, second) = judged(scene, made.values())
    says = judgement(scene, made.values(), tmp_path)
    assert (len(bent.off), bent.false, bent.right) == tuple(says["elbows"][key] for key in ("found", "false", "bend_type_right"))
    assert np.mean(bent.off) == pytest.approx(says["elbows"]["intersection_mm"]["mean"], abs=1e-3)
    keys = ("found", "false", "type_right", "type_and_pn_right")
    assert (len(flanged.off), flanged.false, flanged.types, flanged.classes) == tuple(says["flanges"][key] for key in keys)
    for column, key in enumerate(("axial_mm", "orthogonal_mm", "direction_deg")):
        assert np.mean([off[column] for off in flanged.off]) == pytest.approx(says["flanges"][key]["mean"], abs=1e-3)
    text = "\n".join(first + second)
    assert all(
        part in text for part in ("E00: 5D", "E01: not found, both neighbours are", "F00: type 01", "F02: not found: its flange is somewhere else")
    )
    assert "F01" not in text


def test_elbows_are_asked_for_between_found_pipes_only(scene):
    made = true_components(scene)
    made["P01"] = beside(made["P01"], 1000.0)
    made.pop("E00")
    made.pop("E01")
    (bent, remarks), _ = judged(scene, made.values())
    assert (bent.asked, bent.there) == (5, 4)
    (remark,) = remarks
    assert "E01" in remark


def test_neighbours_are_the_next_pipes_of_the_run():
    runs = [["P0", "E0", "P1", "F0", "F1", "E1", "P2", "E2"]]
    made = SimpleNamespace(runs=runs, pipes=dict.fromkeys(("P0", "P1", "P2")), elbows=dict.fromkeys(("E0", "E1", "E2")))
    assert elbows_flanges.neighbours_of(made) == {"E0": ("P0", "P1"), "E1": ("P1", "P2"), "E2": ("P2", None)}


def test_totals_are_of_all_elbows_and_flanges():
    one, other = elbows_flanges.Elbows(6, 5, 2, 0, 2, (0.5, 1.0), 2.0), elbows_flanges.Elbows(4, 3, 1, 2, 0, (3.0, 3.5), 1.0)
    assert elbows_flanges.Elbows.total([one, other]).row("all") == "| all | 10 | 8 | 3 (38 %) | 4 | 2 | 2 (50 %) | 2.00 | 3.50 | 3.0 |"
    flanged = elbows_flanges.Flanges(2, 0, 1, 1, ((0.5, 1.0, 2.0),))
    assert elbows_flanges.Flanges.total([flanged, flanged]).row("all") == "| all | 4 | 2 (50 %) | 0 | 2 (50 %) | 2 (50 %) | 0.50 | 1.00 | 2.00 |"
    assert "-" in elbows_flanges.Flanges.total([]).row("none")


def test_published_means_are_those_of_the_published_flanges():
    for flanges, means in elbows_flanges.PAPER_FLANGES.values():
        assert np.mean(flanges, axis=0) == pytest.approx(means, abs=0.051)
    assert len(elbows_flanges.paper_rows()) == 2
    assert all(text.count("|") == len(elbows_flanges.FLANGE_COLUMNS) + 1 for text in elbows_flanges.paper_rows())


def test_picks_that_fail_take_their_time_too():
    pipe = Pipe(id="P", start=(-300.0, 3000.0, 150.0), end=(300.0, 3000.0, 150.0), outer_diameter=114.3)
    picks = [FlangePick(index, 0, np.array([-9.0, 5.0])) for index in range(2)]
    seconds = elbows_flanges.flange_seconds(views_without_edges(), picks, [pipe])
    assert [len(one) for one in seconds] == [2, 2]
    assert elbows_flanges.speed_row("a", 2, [(1.0, 0.5), (3.0, 1.5)], 0.3) == "| a | 2 | 2.00 | 3.00 | 1.00 | < 0.3 |"
    assert "nan" in elbows_flanges.speed_row("a", 0, [], 0.3)


@pytest.mark.slow
def test_elbows_of_made_up_pipes_are_found(cameras):
    seconds, made = elbows_flanges.elbow_speed(cameras, 8, repeats=1)
    assert len(seconds) == 1
    assert (made.every, made.there, made.false, made.right) == (7, 7, 0, 7)
    assert np.mean(made.off) < 1


def test_made_up_lines_are_seen_and_apart_from_each_other(cameras):
    random = np.random.default_rng(1)
    lines = []
    for _ in range(3):
        lines.append(scenes._line(cameras, 6, 48.3, lines, random))
    for line in lines:
        assert len(line.corners) == 7
        assert len(line.radii) == 5
        assert all(np.isfinite(camera.project(line.corners)).all() for camera in cameras)
        # what is left of every pipe between its bends
        assert min(np.linalg.norm(end - start) for start, end in scenes._straights(line)) >= 48.3
    one, other = (scenes._along(line.corners) for line in lines[:2])
    assert np.linalg.norm(one[:, None] - other, axis=2).min() >= scenes.CLEARANCE * 48.3
