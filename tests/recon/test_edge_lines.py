# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight edges in space: where planes of two images meet, and what a third image has to say."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import DN100, TARGET, pipe, views, views_of_dn100, views_without_edges

from pipeworkbench.recon.cylinder import edge_lines
from pipeworkbench.recon.edge_lines import EdgeLineSettings, match_lines
from pipeworkbench.recon.lines import LineSegments, hough_segments

TRUTH = DN100
RADIUS = TRUTH.diameter / 2
LEVEL = pipe(114.3, (90.0, 0.0))  # along the base of the first two cameras
HALF = 250.0  # mm of the axis to each side in exact segments


@pytest.fixture
def seen():
    return views_of_dn100()


@pytest.fixture
def blank():
    return views_without_edges()


def exact_segments(camera, truth, sides=(0, 1)):
    """Return a cylinder's edges as a camera without errors has them, the bright side inside."""
    points, _ = edge_lines(truth.cylinder.as_many(), camera.projection_centre)
    ends = []
    for side in sides:
        local = (points[0, side] + np.outer([-HALF, HALF], truth.direction) - camera.projection_centre) @ camera.rotation.T
        (axis,) = (truth.cylinder.point[None] - camera.projection_centre) @ camera.rotation.T
        ideal, inside = local[:, :2] / local[:, 2:], axis[:2] / axis[2]
        (du, dv), (u, v) = ideal[1] - ideal[0], inside - ideal[0]
        # the brighter side is on the right, where v points down
        ends.append(ideal if du * v - dv * u > 0 else ideal[::-1])
    ends = np.array(ends) * camera.interior.pixels_per_radian + camera.interior.pixels(np.zeros((1, 2)))
    count, none = len(ends), np.zeros(0, np.intp)
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    direction = along / length[:, None]
    normal = np.column_stack([-direction[:, 1], direction[:, 0]])
    one, nothing = np.ones(count), np.zeros(count)
    return LineSegments(ends, direction, normal, one, length, ends.mean(axis=1), np.zeros((count, 2, 2)), nothing, one.astype(int), none, none)


def without_segments():
    flat, none = np.zeros((0, 2)), np.zeros(0, np.intp)
    return LineSegments(np.zeros((0, 2, 2)), flat, flat, np.zeros(0), np.zeros(0), flat, np.zeros((0, 2, 2)), np.zeros(0), none, none, none)


def lines_in(some, settings=None):
    return match_lines(some, [hough_segments(view.edges, view.camera.interior) for view in some], settings)


def planes_angle(one, other, truth, points):
    """Return the angles (k,) between the planes through lines (k, 3) along a pipe and two projection centres."""
    normals = [np.cross(points - camera.projection_centre, truth.direction) for camera in (one, other)]
    normals = [normal / np.linalg.norm(normal, axis=1, keepdims=True) for normal in normals]
    return np.arccos(np.abs(np.einsum("ki,ki->k", *normals)))


def towards_axis(truth, points):
    offset = truth.start - points
    offset -= np.outer(offset @ truth.direction, truth.direction)
    return offset / np.linalg.norm(offset, axis=1, keepdims=True)


def directions_differ(lines, truth):
    """Return the sines (k,) of the angles between lines and a pipe."""
    return np.linalg.norm(np.cross(lines.direction, truth.direction), axis=1)


@pytest.mark.parametrize("truth", [TRUTH, pipe(60.3, (30.0, -10.0)), pipe(323.9, (0.0, 0.0), centre=np.add(TARGET, [80.0, 400.0, 0.0]))])
def test_planes_of_exact_edges_meet_beside_the_surface_as_far_as_the_formula_says(blank, truth):
    two = blank[:2]
    lines = match_lines(two, [exact_segments(view.camera, truth) for view in two])
    middle = lines.ends.mean(axis=1)
    tangents = [edge_lines(truth.cylinder.as_many(), view.camera.projection_centre)[1][0] for view in two]
    for side in (0, 1):
        # the surface's normals along both edges of a side are as far from each other as the planes
        angle = np.arccos(tangents[0][side] @ tangents[1][side])
        theory = truth.diameter / 2 * (1 / np.cos(angle / 2) - 1)
        row = np.argmax(-towards_axis(truth, middle) @ (tangents[0][side] + tangents[1][side]))
        assert truth.distance(lines.ends[row]) - truth.diameter / 2 == pytest.approx(theory, rel=1e-6)
        assert lines.bright[row] == pytest.approx(towards_axis(truth, middle[row : row + 1])[0], abs=1e-9)
    assert len(lines) == 2
    assert directions_differ(lines, truth).max() < 1e-9


def test_segments_that_see_different_parts_make_a_line_over_both(blank):
    two = blank[:2]
    segments = [exact_segments(view.camera, TRUTH, (0,)) for view in two]
    start, end = segments[0].ends[0]
    shorter = replace(segments[0], ends=np.array([[start, start + 0.5 * (end - start)]]), length=segments[0].length / 2)
    (whole,) = match_lines(two, segments).ends
    (both,) = match_lines(two, [shorter, segments[1]]).ends
    # the second camera sees its own edge, which begins and ends elsewhere by some millimetres
    assert np.linalg.norm(both[1] - both[0]) == pytest.approx(np.linalg.norm(whole[1] - whole[0]), abs=10)


def test_segments_that_share_too_little_make_no_line(blank):
    two = blank[:2]
    segments = [exact_segments(view.camera, TRUTH, (0,)) for view in two]
    parts = []
    # either's way along the pipe may run up or down in the picture
    for one, (low, high) in zip(segments, ((0.0, 0.45), (0.55, 1.0)), strict=True):
        first, last = sorted(one.ends[0].tolist(), key=lambda end: end[1])
        ends = np.array([[np.add(first, part * np.subtract(last, first)) for part in (low, high)]])
        if one.ends[0, 0, 1] > one.ends[0, 1, 1]:
            ends = ends[:, ::-1]
        parts.append(replace(one, ends=ends, length=np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))
    assert len(match_lines(two, parts)) == 0
    assert len(match_lines(two, [segments[0], parts[1]])) == 1


def test_edges_of_opposite_polarity_are_not_matched(blank):
    two = blank[:2]
    first, second = (exact_segments(view.camera, TRUTH, (0,)) for view in two)
    turned = replace(second, ends=second.ends[:, ::-1])
    assert len(match_lines(two, [first, second])) == 1
    assert len(match_lines(two, [first, turned])) == 0


def test_lines_out_of_the_working_range_are_not_kept(blank):
    two = blank[:2]
    segments = [exact_segments(view.camera, TRUTH) for view in two]
    for working_range in ((4000.0, 9000.0), (500.0, 2000.0)):
        assert len(match_lines(two, segments, EdgeLineSettings(working_range=working_range))) == 0


def test_edges_in_pictures_are_found_beside_the_surface_with_the_pipe_on_the_bright_side(seen):
    lines = lines_in(seen)
    middle = lines.ends.mean(axis=1)
    inwards = np.einsum("ki,ki->k", lines.bright, towards_axis(TRUTH, middle))
    axial = directions_differ(lines, TRUTH) < np.sin(np.radians(1.0))
    assert axial.sum() >= 2
    assert (inwards[axial] > 0.98).all()
    for row in np.flatnonzero(axial):
        one, other = (seen[number].camera for number in lines.views[row])
        theory = RADIUS * (1 / np.cos(planes_angle(one, other, TRUTH, middle[row : row + 1])[0] / 2) - 1)
        # a fifth of a pixel is half a millimetre there
        assert TRUTH.distance(middle[row : row + 1])[0] - RADIUS == pytest.approx(theory, abs=0.5)
    # both edges are there
    sideways = np.cross(TRUTH.direction, TRUTH.cylinder.point)
    assert set(np.sign(lines.bright[axial] @ sideways)) == {-1.0, 1.0}


def test_support_and_rows_say_what_made_a_line(seen):
    segments = [hough_segments(view.edges, view.camera.interior) for view in seen]
    settings = EdgeLineSettings()
    lines = match_lines(seen, segments, settings)
    assert ((lines.support >= settings.least_witnesses) & (lines.support <= 1)).all()
    assert (lines.views[:, 0] < lines.views[:, 1]).all()
    for (one, other), rows in zip(lines.views, lines.rows, strict=True):
        assert rows[0] < len(segments[one])
        assert rows[1] < len(segments[other])
    assert np.linalg.norm(lines.bright, axis=1) == pytest.approx(np.ones(len(lines)))
    axial = lines[directions_differ(lines, TRUTH) < np.sin(np.radians(1.0))]
    assert axial.support.max() > 0.9
    assert np.einsum("ki,ki->k", axial.bright, axial.direction) == pytest.approx(np.zeros(len(axial)), abs=1e-3)


def test_both_orders_of_the_cameras_give_the_same_lines(seen):
    there, back = lines_in(seen[:2]), lines_in(seen[1::-1])
    assert len(there) == len(back) > 0

    def sorted_ends(lines):
        middle, half = lines.ends.mean(axis=1), (lines.ends[:, 1] - lines.ends[:, 0]) / 2
        half *= np.where(half @ TRUTH.direction < 0, -1.0, 1.0)[:, None]
        rows = np.column_stack([middle, half, lines.bright])
        return rows[np.lexsort(np.round(rows, 3).T)]

    assert sorted_ends(back) == pytest.approx(sorted_ends(there), abs=1e-6)


def test_line_that_no_other_camera_shows_is_not_kept(blank):
    segments = [*(exact_segments(view.camera, TRUTH) for view in blank[:2]), without_segments()]
    assert len(match_lines(blank, segments)) == 0


def test_line_that_the_other_camera_shows_is_kept(seen, blank):
    segments = [*(exact_segments(view.camera, TRUTH) for view in seen[:2]), without_segments()]
    lines = match_lines([*blank[:2], seen[2]], segments)
    assert len(lines) == 2
    assert (lines.support > 0.9).all()


def looking_away(view):
    return replace(view, camera=replace(view.camera, rotation=np.diag([-1.0, 1.0, -1.0]) @ view.camera.rotation))


def test_camera_that_does_not_see_a_line_says_nothing_against_it(blank):
    settings = EdgeLineSettings()
    segments = [*(exact_segments(view.camera, TRUTH) for view in blank[:2]), without_segments()]
    lines = match_lines([*blank[:2], looking_away(blank[2])], segments, settings)
    assert len(lines) == 2
    assert lines.support.tolist() == [settings.least_witnesses] * 2


def test_camera_that_does_not_see_a_line_does_not_outvote_one_that_denies_it(blank):
    segments = [*(exact_segments(view.camera, TRUTH) for view in blank[:2]), without_segments(), without_segments()]
    assert len(match_lines([*blank, looking_away(blank[2])], segments)) == 0


def test_line_in_the_plane_of_the_base_needs_another_pair(blank):
    assert len(match_lines(blank[:2], [exact_segments(view.camera, LEVEL) for view in blank[:2]])) == 0
    pair = [blank[0], blank[2]]
    lines = match_lines(pair, [exact_segments(view.camera, LEVEL) for view in pair])
    assert len(lines) == 2
    assert (LEVEL.distance(lines.ends.reshape(-1, 3)) < 1.02 * LEVEL.diameter / 2).all()


@pytest.mark.parametrize(("slope", "count"), [(3.0, 0), (12.0, 2)])
def test_planes_that_are_nearly_one_know_no_line(blank, slope, count):
    # base over distance is a fifth: the angle between the planes is a fifth of the slope
    truth = pipe(114.3, (90.0 - slope, 0.0))
    assert len(match_lines(blank[:2], [exact_segments(view.camera, truth) for view in blank[:2]])) == count


@pytest.mark.slow
def test_level_edges_in_pictures_come_from_the_pairs_that_know_them():
    level = views([LEVEL], seed=30)
    lines = lines_in(level)
    axial = lines[directions_differ(lines, LEVEL) < np.sin(np.radians(1.0))]
    assert len(axial) >= 2
    assert (axial.views[:, 1] == 2).all()
    assert np.abs(LEVEL.distance(axial.ends.mean(axis=1)) - LEVEL.diameter / 2).max() < 2.0


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_pictures_without_edges_have_no_lines(blank, count):
    lines = lines_in(blank[:count])
    assert len(lines) == 0
    assert lines.ends.shape == (0, 2, 3)
    assert lines.direction.shape == (0, 3)
    assert lines.views.shape == lines.rows.shape == (0, 2)


def test_one_camera_alone_knows_no_line_in_space(seen):
    lines = lines_in(seen[:1])
    assert len(lines) == 0
    assert lines[np.zeros(0, np.intp)].ends.shape == (0, 2, 3)


def test_two_cameras_need_no_witness(seen):
    lines = lines_in(seen[:2])
    assert (directions_differ(lines, TRUTH) < np.sin(np.radians(1.0))).sum() >= 2
    assert (lines.support == 1).all()
