# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths of lines and arcs: areas, lengths and bounds against theory, arcs fitted to curves."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pattern_checks import distances
from scipy.special import ellipe

from pipeworkbench.insulation.flat import Path, Text, fit_arcs, joined, turned


def ellipse(a, b):
    return lambda t: np.column_stack([a * np.cos(t), b * np.sin(t)])


def a_path():
    """A rectangle of 100 x 40 whose right side is half a circle outwards and whose top has a bay."""
    return Path(np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 40.0), (60.0, 40.0), (40.0, 40.0), (0.0, 40.0)]), np.array([0.0, 1, 0, 1, 0, 0]))


def test_area_and_length_count_arcs():
    path = a_path()
    assert path.area == pytest.approx(4000 + math.pi * 20**2 / 2 + math.pi * 10**2 / 2, rel=1e-12)
    assert path.length == pytest.approx(100 + 20 * math.pi + 40 + 10 * math.pi + 40 + 40, rel=1e-12)


def test_area_of_a_circle_and_a_slot():
    assert Path.circle((3.0, -4.0), 10.0).area == pytest.approx(math.pi * 100, rel=1e-12)
    assert Path.slot((0.0, 0.0), (30.0, 40.0), 8.0).area == pytest.approx(50 * 8 + math.pi * 16, rel=1e-12)
    assert Path.rectangle((1.0, 2.0), (4.0, 8.0)).area == pytest.approx(18)


@given(st.floats(1e-9, 0.9))
def test_area_of_a_segment_is_that_of_its_formula(bulge):
    # the series near 0 and the formula beside it are one function: compared with the integral over the arc
    path = Path(np.array([(0.0, 0.0), (10.0, 0.0)]), np.array([bulge, 0.0]))
    turn = 4 * math.atan(bulge)
    angles = np.linspace(-turn / 2, turn / 2, 4001)
    # of the segment's height times the chord, Simpson's rule
    radius = 5 / math.sin(turn / 2)
    heights = radius * 2 * np.sin((turn / 2 - angles) / 2) * np.sin((turn / 2 + angles) / 2)
    weights = np.ones(4001)
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    area = float(np.sum(weights * heights * radius * np.cos(angles))) * turn / 4000 / 3
    assert path.area == pytest.approx(area, rel=1e-9)


def test_bounds_reach_to_the_tops_of_arcs():
    assert Path.circle((3.0, -4.0), 10.0).bounds == pytest.approx((-7, -14, 13, 6))
    assert a_path().bounds == pytest.approx((0, 0, 120, 50))
    assert Path.arc((0.0, 0.0), 10.0, 0.0, math.pi / 4).bounds == pytest.approx((10 / math.sqrt(2), 0, 10, 10 / math.sqrt(2)))


@given(st.floats(-360, 360), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_moving_keeps_area_and_length(angle, x, y):
    path = a_path()
    moved = path.moved(angle, (x, y))
    assert moved.area == pytest.approx(path.area, rel=1e-9)
    assert moved.length == pytest.approx(path.length, rel=1e-9)
    assert moved.at(np.array([1]), np.array([0.25]))[0] == pytest.approx(
        turned(path.at(np.array([1]), np.array([0.25])), angle)[0] + (x, y), abs=1e-7
    )


def test_mirrored_and_reversed_paths_run_the_other_way_round():
    path = a_path()
    for other in (path.mirrored(), path.reversed()):
        assert other.area == pytest.approx(-path.area)
        assert other.length == pytest.approx(path.length)
        assert other.counter_clockwise().area == pytest.approx(path.area)
    assert path.mirrored().bounds == pytest.approx((-120, 0, 0, 50))
    assert path.reversed().bounds == pytest.approx(path.bounds)


@pytest.mark.parametrize("error", [1.0, 0.05, 0.001])
def test_sampled_points_keep_the_chord_error(error):
    points = Path.circle((0.0, 0.0), 100.0).sampled(error)
    middles = (points + np.roll(points, -1, axis=0)) / 2
    assert np.hypot(*points.T) == pytest.approx(100)
    assert 100 - np.hypot(*middles.T).min() <= error
    assert len(points) < 2.5 * math.pi / math.acos(1 - error / 100)


def test_a_closed_path_contains_what_is_inside_of_its_arcs():
    inside = Path.slot((0.0, 0.0), (10.0, 0.0), 4.0).contains(np.array([(-1.9, 0.0), (-2.1, 0.0), (5.0, 1.9), (5.0, 2.1), (11.5, 1.0), (11.5, 1.6)]))
    assert inside.tolist() == [True, False, True, False, True, False]


def test_joined_paths_must_meet():
    lines = Path.line((0.0, 0.0), (10.0, 0.0)), Path.line((10.0, 0.0), (0.0, 10.0))
    assert joined(*lines).area == pytest.approx(50)
    with pytest.raises(ValueError, match="begins at"):
        joined(lines[0], Path.line((11.0, 0.0), (0.0, 10.0)))


def test_texts_turn_with_their_part():
    text = Text("P1-1", (10.0, 5.0), 7.0).moved(90.0, (100.0, 0.0))
    assert text.position == pytest.approx((95, 10))
    assert text.angle_deg == 90


@settings(deadline=None, max_examples=20)
@given(st.floats(5, 2000), st.floats(0.02, 1), st.floats(0, 6), st.floats(0.1, 6.2))
def test_fitted_arcs_stay_close_to_an_ellipse(a, ratio, start, turn):
    curve = ellipse(a, a * ratio)
    path = fit_arcs(curve, start, start + turn)
    # more than ten times denser than they were looked at
    samples = curve(start + turn * np.linspace(0, 1, 20001))
    assert distances(samples, path).max() <= 0.02
    assert path.points[[0, -1]] == pytest.approx(samples[[0, -1]], abs=1e-9)


def test_few_arcs_stand_for_an_ellipse():
    path = fit_arcs(ellipse(200, 150), 0.0, 2 * math.pi)
    assert len(path.points) < 30
    assert path.area == pytest.approx(math.pi * 200 * 150, rel=1e-4)
    assert path.length == pytest.approx(4 * 200 * ellipe(1 - 0.75**2), rel=1e-4)


def test_a_circle_is_fitted_by_its_own_half_circles_and_a_line_by_itself():
    circle = fit_arcs(ellipse(50, 50), 2 * math.pi, 0.0)
    assert len(circle.points) <= 4
    assert circle.length == pytest.approx(100 * math.pi, rel=1e-9)
    assert circle.area == pytest.approx(-2500 * math.pi, rel=1e-9)
    line = fit_arcs(lambda t: np.column_stack([t, 3 * t]), 0.0, 10.0)
    assert line.points.tolist() == [[0, 0], [10, 30]]
    assert not line.bulges.any()


def test_a_curve_that_is_not_everywhere_is_refused():
    with pytest.raises(ValueError, match="no arc follows"):
        fit_arcs(lambda t: np.column_stack([t, np.sqrt(np.where(t > 0.5, np.nan, t))]), 0.1, 1.0)
