# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipelines moved into the plant's system, and compared with what was designed."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stations import plant, pose, rack, seen

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipe, Pipeline, moved
from pipeworkbench.recon.plant import placed, placement_on_model, placement_on_points

HERE = pose(20, (300, -4000, 100), (0.3, -0.2))
BUILT = seen("A", plant(), HERE)
POINTS = np.array([[0, 0, -300], [1500, 0, -300], [0, 1500, -250], [1500, 1500, 900], [700, 300, 500]], float)


def known():
    return {f"T{n}": tuple(point) for n, point in enumerate(POINTS.tolist())}


def observed(points=POINTS):
    back = np.linalg.inv(HERE)
    return {f"T{n}": tuple(point) for n, point in enumerate((points @ back[:3, :3].T + back[:3, 3]).tolist())}


@given(st.floats(-180, 180), st.tuples(*[st.floats(-1e6, 1e6)] * 3), st.floats(-180, 180))
@settings(max_examples=25, deadline=None)
def test_a_typed_placement_moves_everything_and_is_kept(heading, shift, second):
    there = placed(placed(BUILT, pose(heading, shift)), pose(second, (1.0, 2.0, 3.0)), "site")
    whole = pose(second, (1.0, 2.0, 3.0)) @ pose(heading, shift)
    for before, after in zip(BUILT.components, there.components, strict=True):
        for one, other in zip(before.ports, after.ports, strict=True):
            assert np.allclose(whole @ [*one.point, 1], [*other.point, 1], atol=1e-6)
    assert there.frame == "site"
    assert np.allclose(there.stations["A"].frame_from_level, whole)
    assert there.extra["georeference"]["frame"] == "A"
    assert np.allclose(there.extra["georeference"]["plant_from_frame"], whole)
    assert Pipeline.from_dict(there.to_dict()).extra == there.extra


def test_standard_deviations_turn_with_the_axes():
    component = replace(BUILT.pipes[0], sigma_position=(0.1, 1.0, 0.2))
    turned = placed(replace(BUILT, components=(component,), joints=()), pose(90, (0, 0, 0))).components[0]
    assert turned.sigma_position == pytest.approx((1.0, 0.1, 0.2))


@pytest.mark.parametrize("matrix", [np.eye(3), 2 * np.eye(4), np.diag([1.1, 1.1, 1.1, 1]), np.diag([1, 1, -1, 1]), np.full((4, 4), np.nan)], ids=str)
def test_what_is_no_motion_is_refused(matrix):
    with pytest.raises(InputError, match="4 x 4 matrix"):
        placed(BUILT, matrix.tolist())


def test_control_points_give_the_placement():
    found = placement_on_points(observed(), known())
    assert np.allclose(found.plant_from_frame, HERE, atol=1e-6)
    assert found.problems == ()
    assert max(np.abs(list(found.residuals.values())).ravel()) < 1e-6


def test_a_control_point_that_does_not_fit_is_told_and_does_not_pull():
    wrong = POINTS + np.array([0, 0, 0, 0, 30.0])[:, None]
    found = placement_on_points(observed(wrong), known())
    assert np.allclose(found.plant_from_frame, HERE, atol=1e-3)
    assert found.problems == ("the control points T4 do not fit the others; check their names and coordinates",)


def test_too_few_control_points_are_refused():
    with pytest.raises(InputError, match="too few or lie in line"):
        placement_on_points({"T0": (0.0, 0.0, 0.0), "T1": (1.0, 0.0, 0.0)}, known())


def design():
    return Pipeline(frame="model", components=tuple(replace(c, id=f"D-{c.id}") for c in plant() if isinstance(c, Pipe)))


def test_a_model_gives_the_placement_and_the_deviations():
    # one pipe was built 40 mm too high, one was not built, one was not designed
    built = [moved(c, pose(0, (0, 0, 40)).tolist()) if c.id == "R0" else c for c in plant() if c.id != "P3"]
    built.append(Pipe(id="X", start=(0.0, 1200.0, 0.0), end=(900.0, 1200.0, 0.0), outer_diameter=88.9))
    found = placement_on_model(seen("A", built, HERE), design())
    assert found.problems == ()
    points = np.array([c.start for c in BUILT.pipes])
    off = (np.array(found.plant_from_frame) - HERE) @ np.c_[points, np.ones(len(points))].T
    assert np.abs(off).max() < 6
    by_name = {deviation.designed_id: deviation for deviation in found.deviations}
    assert by_name["D-R0"].built_id == "A-R0"
    assert np.allclose(by_name["D-R0"].offset, (0, 0, 40), atol=6)
    assert by_name["D-P3"].built_id is None
    assert max(by_name["D-Q1"].distances) < 6
    assert {d.built_id for d in found.deviations if d.designed_id is None} >= {"A-X"}


def test_a_model_that_does_not_tell_says_so():
    parallel = Pipeline(frame="model", components=rack())
    found = placement_on_model(seen("A", rack(), HERE), parallel)
    assert found.plant_from_frame is None
    assert "parallel" in found.problems[0]
