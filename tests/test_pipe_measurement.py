# SPDX-License-Identifier: LGPL-2.1-or-later
"""The states of a pipe's measurement, without a window and without images."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from pipeworkbench.catalogue import pipe_size
from pipeworkbench.gui.tools.pipe_measurement import CLICKED, ClickMode, PipeMeasurement, State
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.cylinder_adjustment import CylinderSolution
from pipeworkbench.recon.pipes import PickAnswer, Sighting
from pipeworkbench.recon.station import read_station

SAMPLE = Path(__file__).resolve().parent.parent / "resources" / "samples" / "dummy" / "A" / "station.json"
ENDS = np.array([[0.0, 3600.0, 0.0], [0.0, 3600.0, 500.0]])


@dataclass
class Edge:
    point: tuple[float, float]
    polyline: np.ndarray


@pytest.fixture
def measurement():
    return PipeMeasurement(read_station(SAMPLE), 7)


def edge(u, v):
    return Edge((u, v), np.zeros((0, 2)))


def candidate(diameter, score=100.0):
    cylinder = Cylinder(ENDS.mean(axis=0), np.array([0.0, 0.0, 1.0]), diameter / 2)
    solution = CylinderSolution(cylinder, np.eye(5), np.eye(3)[:2], 250.0, 1.0, np.zeros(0), 1, 1, True, 1.0, "")
    return PipeCandidate(solution, (-250.0, 250.0), pipe_size(diameter), 0.5, diameter, 0.1, score, 10.0, approximate=False)


def test_a_click_inside_asks_for_an_answer_at_once(measurement):
    measurement.click("left", (530.0, 960.0), None)
    assert measurement.state is State.MEASURING
    assert measurement.request.pick.edges.shape == (1, 1, 2)


def test_two_edges_are_asked_for_together_and_in_one_photograph(measurement):
    measurement.click("left", (490.0, 960.0), edge(490.0, 960.0))
    assert measurement.state is State.ONE_EDGE
    assert measurement.request is None
    measurement.click("right", (300.0, 960.0), edge(300.0, 960.0))
    assert measurement.state is State.ONE_EDGE
    assert "same photograph" in measurement.reason
    measurement.click("right", (380.0, 960.0), edge(380.0, 960.0))
    assert measurement.request.pick.edges.shape == (2, 1, 2)


def test_the_mode_says_what_a_click_means(measurement):
    measurement.mode = ClickMode.INSIDE
    measurement.click("left", (490.0, 960.0), edge(490.0, 960.0))
    assert measurement.request.pick.edges.shape == (1, 1, 2)
    measurement.restart()
    measurement.mode = ClickMode.EDGES
    measurement.click("left", (490.0, 960.0), None)
    assert measurement.state is State.ONE_EDGE


def test_a_second_click_that_cannot_be_right_leaves_the_first(measurement):
    measurement.click("left", (490.0, 960.0), edge(490.0, 960.0))
    measurement.click("left", (491.0, 960.0), edge(491.0, 960.0))
    assert "apart" in measurement.reason
    assert measurement.state is State.ONE_EDGE
    assert len(measurement.touches) == 1


def test_what_is_seen_is_shown_and_the_users_choice_stays_when_the_answer_comes(measurement):
    measurement.click("left", (530.0, 960.0), None)
    request = measurement.request
    measurement.sighted(request, Sighting(ENDS, 48.3))
    assert measurement.shown.outer_diameter == 48.3
    assert measurement.is_guess
    first, second = candidate(48.3), candidate(60.3, 80.0)
    for one in (first, second):
        measurement.sighted(request, Sighting(ENDS, one.diameter, one))
    assert measurement.choose(1)
    assert not measurement.choose(5)
    measurement.answered(request, PickAnswer(first, (first, second)))
    assert measurement.row == 1
    assert measurement.component().outer_diameter == 60.3
    assert not measurement.is_measuring


def test_what_comes_for_older_clicks_is_ignored(measurement):
    measurement.click("left", (530.0, 960.0), None)
    old = measurement.request
    measurement.set_diameter(48.3)
    assert measurement.request.pick.diameter == 48.3
    measurement.answered(old, PickAnswer(candidate(60.3), (candidate(60.3),)))
    assert measurement.answers == []
    assert measurement.state is State.MEASURING


def test_a_failed_pick_says_why_and_keeps_its_clicks(measurement):
    measurement.click("left", (530.0, 960.0), None)
    measurement.answered(measurement.request, PickAnswer(None, (), "no pipe around the click fits the images"))
    assert measurement.state is State.FAILED
    assert measurement.reason.startswith("no pipe")
    assert len(measurement.touches) == 1
    measurement.set_diameter("free")
    assert measurement.state is State.MEASURING


def test_the_component_is_named_after_the_pick_and_knows_its_clicks(measurement):
    measurement.set_diameter(48.3)
    measurement.click("left", (530.0, 960.0), None)
    answer = candidate(48.3)
    measurement.answered(measurement.request, PickAnswer(answer, (answer,)))
    pipe = measurement.component()
    assert (pipe.id, pipe.pick, pipe.station) == ("A-P07", 7, "A")
    assert pipe.extra[CLICKED] == {"kind": "pipe", "camera": "left", "point": [530.0, 960.0], "diameter": 48.3}
    again = PipeMeasurement(measurement.station, 7)
    again.repeat(pipe.extra[CLICKED])
    assert again.request.pick.diameter == 48.3
    assert again.request.pick.edges.tolist() == [[[530.0, 960.0]]]


def test_a_tried_diameter_keeps_the_picture_in_the_clicked_photograph(measurement):
    measurement.click("left", (530.0, 960.0), None)
    measurement.sighted(measurement.request, Sighting(ENDS, 48.3))
    camera = measurement.station.cameras[0]
    before = camera.project(np.array([measurement.shown.start, measurement.shown.end]))
    tried = measurement.try_diameter(60.3)
    assert camera.project(np.array([tried.start, tried.end])) == pytest.approx(before, abs=1e-6)
    assert measurement.shown is tried
    assert measurement.step_back()
    assert measurement.shown.outer_diameter == 48.3


def test_stepping_back_takes_one_click_after_the_other(measurement):
    measurement.click("left", (490.0, 960.0), edge(490.0, 960.0))
    measurement.click("left", (580.0, 960.0), edge(580.0, 960.0))
    answer = candidate(48.3)
    measurement.answered(measurement.request, PickAnswer(answer, (answer, replace(answer, score=1.0))))
    assert measurement.state is State.ANSWERED
    assert measurement.step_back()
    assert measurement.state is State.ONE_EDGE
    assert measurement.step_back()
    assert measurement.state is State.EMPTY
    assert not measurement.step_back()
