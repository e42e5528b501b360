# SPDX-License-Identifier: LGPL-2.1-or-later
"""Why a pick gives no pipe: each sentence says what is wrong with it, and nothing is invented."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from synthetic import TARGET, pick, pipe, views

from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import PipePick, read_picks
from pipeworkbench.recon.pipes import answer_pick
from pipeworkbench.recon.reconstruct import reconstruct
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.views import View

DN100 = pipe()
LEVEL = pipe(114.3, (90.0, 0.0))  # along the base of the first two cameras
ALIGNED = pipe(114.3, (90.0, 0.0), centre=np.add(TARGET, [0.0, 0.0, 150.0]))


@pytest.fixture(scope="module")
def seen():
    return views([DN100], seed=20)


def reason(seen, clicked, settings=None):
    answer = answer_pick(seen, clicked, settings)
    assert answer.chosen is None
    assert "; " in answer.reason
    assert not answer.reason.endswith(".")
    return answer.reason


def test_edges_too_far_apart_for_any_diameter_are_told(seen):
    far = PipePick(0, 0, np.array([[[10.0, 50.0], [10.0, 400.0]], [[620.0, 50.0], [620.0, 400.0]]]))
    said = reason(seen, far, PickSettings(diameter_range=(10.0, 600.0)))
    assert "603 px apart, too far" in said
    assert "widen" in said


def test_edges_too_near_together_for_the_diameters_are_told(seen):
    said = reason(seen, pick(0, DN100), PickSettings(diameter_range=(700.0, 900.0)))
    assert "too near" in said
    assert "711 to 864 mm" in said or "711 to 813 mm" in said


def test_range_without_a_standard_diameter_is_told(seen):
    assert "holds no diameter of EN 10220" in reason(seen, pick(0, DN100), PickSettings(diameter_range=(115.0, 116.0)))


def test_fixed_diameter_out_of_the_range_is_told(seen):
    said = reason(seen, pick(0, DN100, diameter=114.3), PickSettings(diameter_range=(10.0, 100.0)))
    assert "114.3 mm is outside the range of 10 to 100 mm" in said


@pytest.mark.parametrize("diameter", [None, "free"])
def test_lines_without_edges_are_told(seen, diameter):
    nowhere = PipePick(0, 0, np.array([[[30.0, 50.0], [30.0, 400.0]], [[80.0, 50.0], [80.0, 400.0]]]), diameter)
    assert "edge" in reason(seen, nowhere)


@pytest.mark.slow
def test_one_edge_of_a_wall_gives_no_pipe():
    wall = pipe(1800.0, (5.0, 0.0), centre=np.add(TARGET, [1000.0, 600.0, 0.0]))
    edge = pick(0, wall).edges
    visible = edge[np.argmin(edge[:, :, 0].mean(axis=1))]
    visible = visible[0] + np.array([[0.4], [0.6]]) * (visible[1] - visible[0])
    clicked = PipePick(0, 0, np.array([visible, np.add(visible, [60.0, 0.0])]))
    assert reason(views([wall], seed=8), clicked)


def test_pipe_behind_the_other_camera_is_told(seen):
    away = replace(seen[1].camera, rotation=seen[1].camera.rotation @ Rotation.from_euler("z", 180, degrees=True).as_matrix())
    said = reason([seen[0], View(away, seen[1].edges, seen[1].smooth)], pick(0, DN100))
    assert "behind camera right" in said
    assert "give its diameter" in said


def test_pipe_that_one_image_shows_is_approximate_where_its_diameter_is_known(seen):
    away = replace(seen[1].camera, rotation=seen[1].camera.rotation @ Rotation.from_euler("z", 180, degrees=True).as_matrix())
    alone = [seen[0], View(away, seen[1].edges, seen[1].smooth)]
    answer = answer_pick(alone, pick(0, DN100, diameter=DN100.diameter))
    assert answer.chosen.approximate
    assert answer.chosen.size.outer_diameter == DN100.diameter
    # a percent or two of the distance is what one image gives
    assert DN100.distance(answer.chosen.ends).max() < 0.03 * np.linalg.norm(answer.chosen.ends[0] - seen[0].camera.projection_centre)
    far = answer_pick(alone, pick(0, DN100, diameter=DN100.diameter), PickSettings(working_range=(500.0, 600.0)))
    assert far.chosen is None


def test_pipe_along_the_base_of_two_cameras_is_degenerate():
    said = reason(views([LEVEL], 2, seed=3), pick(0, LEVEL))
    assert said.startswith("degenerate: the pipe lies in one plane with cameras left and right")
    assert "no camera pair of the station works" in said


@pytest.mark.slow
def test_pipe_along_the_base_is_found_with_a_third_camera():
    answer = answer_pick(views([LEVEL], seed=3), pick(0, LEVEL))
    assert answer.chosen.size.outer_diameter == LEVEL.diameter
    assert LEVEL.distance(answer.chosen.ends).max() < 2.0


@pytest.mark.slow
def test_camera_pair_that_would_work_is_named():
    seen = views([LEVEL], seed=3)
    blank = views([], seed=3)[2]
    said = reason([*seen[:2], blank], pick(0, LEVEL, diameter="free"))
    assert said.startswith("degenerate")
    assert "the camera pair that still works is" in said
    assert "top" in said.split("still works is")[1]


@pytest.mark.slow
def test_fixed_diameter_needs_no_second_direction():
    answer = answer_pick(views([LEVEL], 2, seed=3), pick(0, LEVEL, diameter=114.3))
    assert answer.chosen is not None
    assert LEVEL.distance(answer.chosen.solution.cylinder.point[None])[0] < 30.0


@pytest.mark.slow
def test_chosen_alternative_is_the_one_of_the_ranking(seen):
    ranked = answer_pick(seen, pick(0, DN100), candidates=3).ranked
    assert len(ranked) > 1
    second = answer_pick(seen, replace(pick(0, DN100), alternative=2)).chosen
    assert second.size == ranked[1].size
    assert second.ends == pytest.approx(ranked[1].ends, abs=1e-6)
    first = answer_pick(seen, pick(0, DN100)).chosen
    assert first.ends == pytest.approx(ranked[0].ends, abs=1e-6)


@pytest.mark.slow
def test_alternative_that_is_not_there_is_told(seen):
    assert "there is no alternative 6" in reason(seen, replace(pick(0, DN100, diameter=114.3), alternative=6))


@pytest.mark.slow
def test_real_insulated_pipes_are_vertical_and_of_like_diameters_and_level_ones_degenerate(shared):
    folder = shared / "scenes" / "eth3d_pipes" / "X"
    station = read_station(folder)
    picks = read_picks(folder / "picks.json", station)
    upper = picks.pipes[:4]
    above = np.array([[[820.0, 122.0], [1140.0, 122.4]], [[885.0, 168.0], [1140.0, 168.5]]])
    below = np.array([[[632.0, 655.0], [675.0, 655.0]], [[590.0, 694.0], [740.0, 694.5]]])
    level = [PipePick(10 + row, 1, edges, diameter) for row, edges in enumerate((above, below)) for diameter in ("free", None)]
    found = reconstruct(station, replace(picks, pipes=(*upper, *level)))
    pipes = found.pipeline.pipes
    assert [one.pick for one in pipes] == [0, 1, 2, 3]
    for one in pipes:
        direction = np.subtract(one.end, one.start) / one.length
        assert np.degrees(np.arccos(abs(direction[2]))) < 1.0
        assert one.sigma_outer_diameter < 2.0
        assert one.dn is None
    diameters = np.array([one.outer_diameter for one in pipes])
    assert np.abs(diameters / diameters.mean() - 1).max() < 0.05
    assert len(found.failed_picks) == 4
    assert all(reason.startswith("degenerate") for _, reason in found.failed_picks)
