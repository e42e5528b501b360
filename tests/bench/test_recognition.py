# SPDX-License-Identifier: LGPL-2.1-or-later
"""The recognition benchmark: verdicts, the cylinder from one image, pictures that can be read."""

from types import SimpleNamespace

import numpy as np
import pytest
import recognition
from synthetic import DN100, cameras, pick, views_of_dn100

from pipeworkbench.errors import InputError
from pipeworkbench.recon.pipes import from_pick

TRUTH = DN100


class Judge:
    """Deviations as those of the scenes' judge, from a true pipe in the station's frame."""

    @staticmethod
    def move(component, transform):
        return {key: transform[:3, :3] @ value + transform[:3, 3] if key in ("start", "end") else value for key, value in component.items()}

    @staticmethod
    def pipe_dev(found, truth):
        direction = (found["end"] - found["start"]) / np.linalg.norm(found["end"] - found["start"])
        angle = np.degrees(np.arccos(min(1.0, abs(direction @ TRUTH.direction))))
        position = float(TRUTH.distance(np.array([found["start"], found["end"]])).mean())
        return {"position": position, "direction": angle, "overlap": 1.0, "diameter": abs(found["outer_diameter"] - truth["outer_diameter"])}

    @staticmethod
    def pipe_ok(deviation):
        return deviation["position"] < 10 and deviation["direction"] < 3 and deviation["diameter"] < 0.5


@pytest.fixture(scope="module")
def seen():
    return views_of_dn100()


@pytest.fixture
def scene(monkeypatch):
    """A scene with the one pipe, as the benchmark reads it from a folder."""
    made = object.__new__(recognition.Scene)
    made.score, made.name, made.station = Judge, "synthetic/A", SimpleNamespace(cameras=cameras())
    made.picks = SimpleNamespace(pipes=(pick(0, TRUTH),))
    made.truth_of_pick, made.world_from_level = ["P00"], np.eye(4)
    made.pipes = {"P00": {"start": TRUTH.start, "end": TRUTH.end, "outer_diameter": TRUTH.diameter}}
    made.visible = {"P00"}
    monkeypatch.setattr(recognition, "read_image", lambda *_: np.full((480, 640), 90, np.uint8))
    return made


@pytest.fixture(scope="module")
def candidates(seen):
    return from_pick(seen, pick(0, TRUTH, 1.0))


@pytest.fixture
def says(monkeypatch):
    """Give a function that makes all picks be answered so."""
    return lambda answer: monkeypatch.setattr(recognition, "from_pick", lambda *_: answer())


def test_right_answer_is_correct(scene, seen, says, candidates):
    says(lambda: candidates)
    found = recognition.answer_to(scene, seen, pick(0, TRUTH))
    assert found.verdict == "correct"
    assert found.deviation["position"] < 1.0
    assert "114.3 mm found" in found.caption


def test_answer_of_another_diameter_is_wrong(scene, seen, says, candidates):
    says(lambda: candidates)
    scene.pipes["P00"]["outer_diameter"] = 139.7
    assert recognition.answer_to(scene, seen, pick(0, TRUTH)).verdict == "wrong"


def refusal():
    raise InputError("pick 0", "edges", "cross", "click along the pipe")


class Failed(tuple):
    """No candidates, but why."""

    reason = "two places fit as well"
    __slots__ = ()


@pytest.mark.parametrize(("failure", "reason"), [(tuple, ""), (Failed, "two places fit as well"), (refusal, "click along the pipe")])
def test_no_answer_is_a_failure_with_its_reason(scene, seen, says, failure, reason):
    says(failure)
    found = recognition.answer_to(scene, seen, pick(0, TRUTH))
    assert found.verdict == "failed"
    assert reason in found.caption


def test_one_image_starts_from_clicks_drawn_onto_the_edges(scene, seen):
    exact = recognition.from_one_image(scene, seen, pick(0, TRUTH))
    clicked = [recognition.from_one_image(scene, seen, pick(0, TRUTH, 1.5, seed)) for seed in range(3)]
    # a click that is 1.5 px off would move the pipe by 1.5 % of 3 m
    assert max(one["position"] for one in [exact, *clicked]) < 15
    assert max(abs(one["position"] - exact["position"]) for one in clicked) < 5


def test_picture_shows_pick_and_what_was_found_over_a_caption(scene, seen, candidates):
    found = recognition.Answer(pick(0, TRUTH), "P00", "wrong", candidates[0], {"position": 12.0, "direction": 1.0, "diameter": 0.0})
    drawn = recognition.picture(scene, seen, found)
    assert drawn.shape[0] == recognition.PANEL_PX + 2 * recognition.CAPTION_PX
    in_colour = [(drawn == colour).all(axis=2).any(axis=0) for colour in (recognition.YELLOW, recognition.RED)]
    panels = [[part.any() for part in np.array_split(columns, 3)] for columns in in_colour]
    assert panels == [[True, False, False], [True, True, True]]
    # something is written
    assert (drawn[-recognition.CAPTION_PX :] < 100).any()
    failed = recognition.picture(scene, seen, recognition.Answer(pick(0, TRUTH), "P00", "failed", reason="nothing fits"))
    assert failed.shape[0] == drawn.shape[0]
    assert not (failed == recognition.RED).all(axis=2).any()


def test_pipes_without_picks_are_counted(scene):
    ends = np.array([TRUTH.start, TRUTH.end])
    found = recognition.judged(scene, [(ends, 114.3), (ends, 114.3), (ends + 500.0, 114.3)])
    assert found == recognition.Unpicked(visible=1, hit=1, answers=3, false=1)
    assert recognition.Unpicked.total([found, found]) == recognition.Unpicked(2, 2, 6, 2)
    assert found.row("a", "b", "1.0", "2.0") == "| a | b | 1 | 1 | 1.00 | 3 | 1 | 0.67 | 1.0 | 2.0 |"


def test_shares_are_in_percent():
    assert recognition.shares("x", {"correct": 3, "wrong": 0, "failed": 1}) == "| x | 4 | 3 (75 %) | 0 (0 %) | 1 (25 %) |"
