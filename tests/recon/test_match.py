# SPDX-License-Identifier: LGPL-2.1-or-later
"""Matching along normals: the nearest edge with the right sign, the gates, and Eq. 4."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_edges import SIZE as SIZE_OF_STEP
from test_edges import step_image

from pipeworkbench.recon.edges import EdgeMap, coarse_directions, detect_edges
from pipeworkbench.recon.match import match, nearest_rows, quality, robust_quality

SIZE = 100


def edge_map(*lines):
    """Return an edge map of straight lines (point, direction of the bright side in degrees), a point per pixel."""
    found = {}
    for point, bright_deg in lines:
        normal = np.array([np.cos(np.radians(bright_deg)), np.sin(np.radians(bright_deg))])
        tangent = np.array([-normal[1], normal[0]])
        for along in np.arange(-150, 150, 0.25):
            u, v = np.asarray(point, float) + along * tangent
            pixel = (round(v), round(u))
            # keep the point nearest to the pixel's centre, as an edge detector has one per pixel
            off = np.hypot(u - pixel[1], v - pixel[0])
            if 0 <= pixel[0] < SIZE and 0 <= pixel[1] < SIZE and off < found.get(pixel, (1.0,))[0]:
                found[pixel] = (off, (u, v), normal)
    index = np.full((SIZE, SIZE), -1, np.int32)
    for row, pixel in enumerate(found):
        index[pixel] = row
    position = np.array([p for _, p, _ in found.values()]).reshape(-1, 2)
    normals = np.array([n for _, _, n in found.values()]).reshape(-1, 2)
    ones = np.ones(len(position))
    pixel = np.array([(u, v) for v, u in found], np.int32).reshape(-1, 2)
    return EdgeMap(position, normals, 10 * ones, 30 * ones, 0.8 * ones, 0.1 * ones, ones, pixel, index)


def at(u, v, direction_deg, count=1):
    angle = np.radians(direction_deg)
    return np.tile([float(u), float(v)], (count, 1)), np.tile([np.cos(angle), np.sin(angle)], (count, 1))


UPRIGHT = edge_map(((40.3, 50.0), 0.0))


@given(st.floats(-7.5, 7.5), st.floats(20, 80), st.sampled_from([0.0, 180.0]))
def test_distance_is_signed_along_the_normal(distance, v, direction_deg):
    sign = 1 if direction_deg == 0 else -1
    found = match(UPRIGHT, *at(40.3 - sign * distance, v, direction_deg), 8.0)
    assert found.found.all()
    assert found.distance[0] == pytest.approx(distance, abs=1e-9)
    assert abs(UPRIGHT.position[found.edge[0], 1] - v) <= 1.0


@given(st.floats(0, 360), st.floats(-6, 6), st.floats(-12, 12))
def test_line_in_any_direction_is_found_at_its_distance(angle_deg, distance, lateral):
    normal = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    edges = edge_map(((50.0, 50.0), angle_deg))
    place = np.array([50.0, 50.0]) - distance * normal + lateral * np.array([-normal[1], normal[0]])
    found = match(edges, place[None], normal[None], 8.0)
    assert found.found.all()
    assert found.distance[0] == pytest.approx(distance, abs=1e-9)


def test_nearest_of_several_edges_is_taken():
    edges = edge_map(((30.0, 50.0), 0.0), ((36.5, 50.0), 180.0), ((45.0, 50.0), 0.0))
    found = match(edges, *at(34.0, 50.0, 0.0), 15.0)
    assert found.distance[0] == pytest.approx(2.5)
    found = match(edges, *at(32.0, 50.0, 0.0), 15.0)
    assert found.distance[0] == pytest.approx(-2.0)


@pytest.mark.parametrize(("distance", "search_range", "found"), [(4.9, 5.0, True), (5.1, 5.0, False), (-4.9, 5.0, True), (-5.1, 5.0, False)])
def test_edges_beyond_the_range_are_not_found(distance, search_range, found):
    assert match(UPRIGHT, *at(40.3 - distance, 50, 0.0), search_range).found.tolist() == [found]


@pytest.mark.parametrize(
    ("direction_deg", "found"), [(0, True), (17, True), (-17, True), (23, False), (-23, False), (90, False), (163, True), (203, False)]
)
def test_edges_of_another_direction_are_not_found(direction_deg, found):
    assert match(UPRIGHT, *at(39.6, 50, direction_deg), 5.0).found.tolist() == [found]


def test_polarity_asks_for_the_brighter_side():
    positions, normals = at(38.0, 50.0, 0.0, count=3)
    assert match(UPRIGHT, positions, normals, 5.0, np.array([1.0, -1.0, 0.0])).found.tolist() == [True, False, True]
    assert match(UPRIGHT, positions, -normals, 5.0, np.array([1.0, -1.0, 0.0])).found.tolist() == [False, True, True]


def test_polarity_prefers_a_further_edge_of_the_right_kind():
    edges = edge_map(((30.0, 50.0), 0.0), ((33.0, 50.0), 180.0))
    assert match(edges, *at(32.0, 50.0, 0.0), 5.0, np.array([1.0])).distance[0] == pytest.approx(-2.0)
    assert match(edges, *at(32.0, 50.0, 0.0), 5.0).distance[0] == pytest.approx(1.0)


def test_unknown_positions_match_nothing_and_disturb_nobody():
    positions, normals = at(38.0, 50.0, 0.0, count=4)
    positions[1] = np.nan
    normals[2, 0] = np.nan
    found = match(UPRIGHT, positions, normals, 5.0)
    assert found.found.tolist() == [True, False, False, True]
    assert np.isnan(found.distance).tolist() == [False, True, True, False]
    assert found.edge[1] == found.edge[2] == -1


def test_samples_at_the_border_and_outside_the_image_are_no_trouble():
    positions = np.array([[-2.0, 50.0], [101.0, 50.0], [40.3, 0.0], [40.3, 99.0], [40.3, 500.0], [-1e5, 1e5]])
    found = match(UPRIGHT, positions, np.tile([1.0, 0.0], (6, 1)), 5.0)
    assert found.found.tolist() == [False, False, True, True, False, False]


def test_image_without_edges_and_contour_without_samples_give_nothing():
    assert not match(edge_map(), *at(50.0, 50.0, 0.0, count=3), 5.0).found.any()
    assert len(match(UPRIGHT, np.empty((0, 2)), np.empty((0, 2)), 5.0).distance) == 0


@pytest.mark.parametrize("angle_deg", [0, 90, *(angle for angle in (20, 30, 44, 45, 135))])
def test_unbroken_edge_is_found_from_every_sample(angle_deg):
    edges = detect_edges(step_image(angle_deg, 0.2, 40, 200))
    normal = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    along = np.arange(-35, 35, 0.37)[:, None] * np.array([-normal[1], normal[0]])
    for beside in (-1.7, 0.4, 2.1):
        found = match(edges, SIZE_OF_STEP / 2 + (0.2 + beside) * normal + along, np.tile(normal, (len(along), 1)), 3.0)
        assert found.found.mean() > 0.98


distances = st.lists(st.floats(-8, 8) | st.just(float("nan")), min_size=1, max_size=40)


@given(distances)
def test_quality_is_equation_4(values):
    squares = [64.0 if np.isnan(value) else value**2 for value in values]
    assert float(quality(np.array(values), 8.0)) == pytest.approx((sum(squares) / len(squares)) ** 0.5)


def test_quality_of_nothing_found_is_the_range_and_of_a_perfect_fit_zero():
    assert float(quality(np.full(5, np.nan), 3.0)) == pytest.approx(3.0)
    assert float(quality(np.zeros(5), 3.0)) == 0.0


def test_quality_is_taken_along_the_axis_that_is_asked_for():
    values = np.array([[3.0, 4.0, np.nan], [0.0, 0.0, 0.0]])
    assert quality(values, 5.0) == pytest.approx([np.sqrt(50 / 3), 0.0])
    assert quality(values, 5.0, axis=0) == pytest.approx(np.sqrt([4.5, 8.0, 12.5]))


@given(st.lists(st.floats(-8, 8), min_size=1, max_size=40))
def test_missing_edges_count_as_the_range_or_half_of_it(values):
    distances = np.array([*values, np.nan, np.nan])
    by_hand = np.sqrt((np.sum(np.square(values)) + 2 * 4.0**2) / (len(values) + 2))
    assert quality(distances, 8.0, missing="half") == pytest.approx(by_hand)
    assert quality(distances, 8.0) >= quality(distances, 8.0, missing="half")


@given(st.lists(st.floats(-0.05, 0.05), min_size=5, max_size=40))
def test_robust_quality_is_eq_4_where_all_fit(values):
    distances = np.array(values)
    assert robust_quality(distances, 8.0) == pytest.approx(quality(distances, 8.0), rel=3e-3, abs=1e-12)


def test_clutter_beside_a_part_of_a_contour_spoils_the_plain_quality_only():
    """A contour that fits but for a fifth of its samples must beat one that is off everywhere."""
    right = np.concatenate([np.full(80, 0.1), np.full(20, 11.0)])
    wrong = np.full(100, 2.0)
    assert quality(right, 12.0) > quality(wrong, 12.0)
    assert robust_quality(right, 12.0) < robust_quality(wrong, 12.0)


@pytest.mark.parametrize(("largest_angle_deg", "found"), [(20, False), (46, True), (None, True)])
def test_direction_gate_is_settable(largest_angle_deg, found):
    gate = None if largest_angle_deg is None else np.radians(largest_angle_deg)
    assert match(UPRIGHT, *at(42, 50, 45), 4.0, largest_angle=gate).found[0] == found


def test_samples_in_many_chunks_are_matched_like_one_by_one():
    random = np.random.default_rng(4)
    edges = detect_edges(step_image(33, 0.2, 40, 200, noise=6))
    angle = random.uniform(0, 2 * np.pi, 5000)
    positions, normals = random.uniform(-10, SIZE_OF_STEP + 10, (5000, 2)), np.column_stack([np.cos(angle), np.sin(angle)])
    together = match(edges, positions, normals, 7.0)
    for row in random.integers(0, 5000, 60):
        alone = match(edges, positions[row : row + 1], normals[row : row + 1], 7.0)
        assert np.array_equal(alone.distance, together.distance[row : row + 1], equal_nan=True)
        assert alone.edge[0] == together.edge[row]


@given(st.floats(-180, 180), st.floats(-90, 90))
def test_coarse_directions_differ_by_the_angle_of_either_sign(angle_deg, turn_deg):
    first, second = (coarse_directions(np.cos([angle]), np.sin([angle])) for angle in np.radians([angle_deg, angle_deg + turn_deg]))
    opposite = coarse_directions(-np.cos(np.radians([angle_deg])), -np.sin(np.radians([angle_deg])))
    assert (opposite - first).view(np.int8)[0] in (-2, 0, 2)
    difference = int((second - first).view(np.int8)[0])
    assert difference % 2 == 0
    assert min(abs(difference - 256 * turn_deg / 180 + whole) for whole in (-256, 0, 256)) <= 2.0 + 1e-6


def test_nearest_rows_are_one_for_each_sample():
    sample, distance = np.array([1, 1, 1, 4, 7, 7]), np.array([2.0, -0.5, 0.5, 3.0, -1.0, 1.5])
    rows = nearest_rows(sample, distance)
    assert sample[rows].tolist() == [1, 4, 7]
    assert np.abs(distance[rows]).tolist() == [0.5, 3.0, 1.0]
    assert len(nearest_rows(sample[:0], distance[:0])) == 0
