# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes from clicks: the standard diameter, the extent and what the user fixes, against known geometry."""

import numpy as np
import pytest
from synthetic import DN100, TARGET, pick, pipe, views, views_of_dn100

from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.pipes import from_pick
from pipeworkbench.recon.reconstruct import as_component, level_of_accuracy

pytestmark = pytest.mark.slow  # a search takes seconds

PIPES = {
    "DN 100 upright": pipe(114.3, (5.0, 0.0)),
    "DN 100 into the depth": DN100,
    "DN 80 level": pipe(88.9, (85.0, 5.0)),
    "DN 150 slanting": pipe(168.3, (20.0, -10.0), centre=np.add(TARGET, [50.0, 300.0, -30.0])),
}


@pytest.fixture
def seen():
    return views_of_dn100()


def assert_is(candidate, truth):
    ends = candidate.ends
    assert truth.distance(ends).max() < 1.5
    assert truth.distance(candidate.solution.cylinder.point[None])[0] < 0.5
    direction = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    assert abs(direction @ truth.direction) > np.cos(np.radians(0.2))


@pytest.mark.parametrize("truth", PIPES.values(), ids=PIPES)
@pytest.mark.parametrize("camera", [0, 2])
def test_clicks_beside_the_edges_find_the_diameter_and_the_place(truth, camera):
    (candidate,) = from_pick(views([truth], seed=30), pick(camera, truth, off_px=1.5, seed=camera))
    assert candidate.size.outer_diameter == truth.diameter
    assert not candidate.approximate
    assert candidate.diameter == pytest.approx(truth.diameter, abs=0.6)
    assert candidate.quality < 1.0
    assert_is(candidate, truth)


def test_quality_of_a_clear_slanting_pipe_is_as_good_as_of_an_upright_one():
    qualities = []
    for truth in (PIPES["DN 100 upright"], pipe(114.3, (42.0, 0.0))):
        (candidate,) = from_pick(views([truth], seed=30), pick(0, truth))
        assert_is(candidate, truth)
        qualities.append(candidate.quality)
    assert qualities[1] < qualities[0] + 0.2


def test_pipe_is_followed_to_its_ends(seen):
    (candidate,) = from_pick(seen, pick(0, DN100, off_px=1.5, seed=4))
    along = np.sort((candidate.ends - DN100.start) @ DN100.direction)
    # an end is known to a window of samples, a third of the diameter
    assert along == pytest.approx([0.0, 2 * DN100.half_length], abs=DN100.diameter / 3)


def test_clicks_in_the_other_order_find_the_same_pipe(seen):
    clicked = pick(0, DN100)
    turned = type(clicked)(0, 0, clicked.edges[::-1, ::-1].copy())
    (one,), (other,) = from_pick(seen, clicked), from_pick(seen, turned)
    assert one.size == other.size
    assert other.solution.cylinder.radius == pytest.approx(one.solution.cylinder.radius, abs=0.02)
    assert_is(other, DN100)


@pytest.mark.parametrize("diameter", [121.0, 95.0])
def test_free_diameter_is_estimated(diameter):
    truth = pipe(diameter)
    (candidate,) = from_pick(views([truth], seed=40), pick(0, truth, off_px=1.0, diameter="free"))
    assert candidate.size is None
    assert candidate.diameter == pytest.approx(diameter, abs=0.6)
    assert abs(candidate.diameter - diameter) < 5 * candidate.sigma_diameter
    assert_is(candidate, truth)


def test_free_diameter_is_what_the_component_has():
    truth = pipe(95.0)
    clicked = pick(0, truth, diameter="free")
    component = as_component(from_pick(views([truth], seed=40), clicked)[0], clicked, "synthetic")
    assert component.outer_diameter == pytest.approx(95.0, abs=0.6)
    assert (component.dn, component.standard, component.wall_thickness, component.verified) == (None, None, None, None)


@pytest.mark.parametrize("fixed", [114.3, 113.5])
def test_fixed_diameter_is_kept(seen, fixed):
    clicked = pick(0, DN100, diameter=fixed)
    component = as_component(from_pick(seen, clicked)[0], clicked, "synthetic")
    assert component.outer_diameter == pytest.approx(fixed, abs=0.15)
    assert component.dn == (100 if fixed == 114.3 else None)


def test_component_says_what_is_known_of_it(seen):
    clicked = pick(0, DN100)
    (candidate,) = from_pick(seen, clicked)
    component = as_component(candidate, clicked, "synthetic")
    assert (component.id, component.pick, component.station) == ("synthetic-P00", 0, "synthetic")
    assert (component.dn, component.outer_diameter, component.standard) == (100, 114.3, "EN 10220")
    assert np.array([component.start, component.end]) == pytest.approx(candidate.ends)
    assert component.quality == pytest.approx(candidate.quality, abs=1e-4)
    assert component.sigma_position == pytest.approx(candidate.solution.sigma_position, abs=1e-4)
    assert 0 < max(component.sigma_position) < 5.0
    assert DN100.distance([component.start, component.end]).mean() < 5 * np.linalg.norm(component.sigma_position) + 0.1
    assert component.loa == level_of_accuracy(float(np.linalg.norm(component.sigma_position)))


def test_pictures_without_edges_give_nothing():
    assert from_pick(views([]), pick(0, DN100)) == ()


def test_pipe_beyond_the_working_range_gives_nothing(seen):
    assert from_pick(seen, pick(0, DN100), PickSettings(working_range=(5000.0, 9000.0))) == ()


def test_diameter_beyond_the_range_is_not_given(seen):
    found = from_pick(seen, pick(0, DN100), PickSettings(diameter_range=(200.0, 400.0)))
    assert all(200 <= candidate.size.outer_diameter <= 400 for candidate in found)


def test_alternatives_are_distinct_and_best_first(seen):
    found = from_pick(seen, pick(0, DN100), candidates=3)
    assert 1 <= len(found) <= 3
    assert [c.score for c in found] == sorted((c.score for c in found), reverse=True)
    assert found[0].size.dn == 100


@pytest.mark.parametrize(
    ("sigma", "level"), [(0.1, "LOA50"), (0.5, "LOA50"), (0.51, "LOA40"), (2.5, "LOA40"), (7.0, "LOA30"), (20.0, "LOA20"), (30.0, "LOA10")]
)
def test_level_of_accuracy_covers_95_percent(sigma, level):
    assert level_of_accuracy(sigma) == level
