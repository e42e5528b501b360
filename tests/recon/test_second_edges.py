# SPDX-License-Identifier: LGPL-2.1-or-later
"""From one edge in space and the list of diameters to the pipe: the second edge decides."""

import numpy as np
import pytest
from synthetic import DN100, TARGET, pipe, views, views_of_dn100, views_without_edges

from pipeworkbench.catalogue import pipe_sizes
from pipeworkbench.recon.edge_lines import EdgeLines
from pipeworkbench.recon.edge_raster import raster_of
from pipeworkbench.recon.second_edges import SecondEdgeSettings, cylinders_from_edges

DIAMETERS = np.array([size.outer_diameter for size in pipe_sizes() if size.series == 1 and 15 <= size.outer_diameter <= 700])
PIPES = {
    "DN 100 into the depth": DN100,
    "DN 150 slanting": pipe(168.3, (30.0, -10.0), centre=np.add(TARGET, [40.0, 500.0, -20.0])),
}
TRUTH = PIPES["DN 100 into the depth"]
VIEWPOINT = np.array([0.0, 0.0, 200.0])  # the middle of the three projection centres


@pytest.fixture
def seen():
    return views_of_dn100()


@pytest.fixture
def blank():
    return views_without_edges()


def answers(some, *arguments):
    """Return the cylinders with two edges in views."""
    return cylinders_from_edges(some, [raster_of(view.edges, 2) for view in some], *arguments)


def edge_of(truth, sides=(1, -1), inwards=1.0, half=200.0):
    """Return lines on the surface where the limb is as seen from the middle of the cameras; the pipe is bright."""
    sight = truth.cylinder.point - VIEWPOINT
    sideways = np.cross(truth.direction, sight)
    sideways /= np.linalg.norm(sideways)
    count = len(sides)
    ends = np.array(
        [[truth.cylinder.at(along) + side * truth.diameter / 2 * sideways for along in np.multiply([-1.0, 1.0], half)] for side in sides]
    ).reshape(count, 2, 3)
    bright = np.multiply.outer(-inwards * np.array(sides, float), sideways).reshape(count, 3)
    numbers = np.zeros((count, 2), np.intp)
    return EdgeLines(ends, bright, np.ones(count), numbers, numbers)


def row_of(cylinders, truth):
    """Return the row with the true diameter whose axis is nearest to the true one."""
    rows = np.flatnonzero(np.isclose(2 * cylinders.radii, truth.diameter))
    assert len(rows)
    return rows[np.argmin(truth.distance(cylinders.points[rows]))]


@pytest.mark.parametrize("truth", PIPES.values(), ids=PIPES)
def test_true_diameter_is_among_the_answers_and_its_axis_is_the_true_one(seen, truth):
    cylinders, extents, score = answers(seen if truth is TRUTH else views([truth], 2, seed=40), edge_of(truth), DIAMETERS)
    row = row_of(cylinders, truth)
    ends = cylinders.points[row] + extents[row][:, None] * cylinders.directions[row]
    assert truth.distance(ends).max() < 2.0
    assert score[row] > 0.9
    # nothing scores higher than what is there
    assert score.max() - score[row] < 0.05


@pytest.mark.parametrize("side", [1, -1])
def test_either_edge_leads_to_the_pipe_whichever_side_is_brighter(seen, side):
    for inwards in (1.0, -1.0):
        cylinders, _, score = answers(seen, edge_of(TRUTH, (side,), inwards), DIAMETERS)
        row = row_of(cylinders, TRUTH)
        assert TRUTH.distance(cylinders.points[row])[0] < 2.0
        assert score[row] > 0.75


def test_edge_and_second_edge_of_like_polarity_count_a_little_less(seen):
    settings = SecondEdgeSettings()
    opposite, like = (answers(seen, edge_of(TRUTH, (1,), inwards), DIAMETERS, settings) for inwards in (1.0, -1.0))
    ratio = like[2][row_of(like[0], TRUTH)] / opposite[2][row_of(opposite[0], TRUTH)]
    # what the line calls its brighter side turns the normals about, so the second edge has the line's polarity
    assert ratio == pytest.approx(settings.same_polarity)


def test_extents_are_what_the_edge_spans(seen):
    for half in (60.0, 250.0):
        cylinders, extents, _ = answers(seen, edge_of(TRUTH, half=half), DIAMETERS)
        assert len(cylinders) == len(extents) > 0
        assert extents == pytest.approx(np.tile([-half, half], (len(extents), 1)))


def test_only_diameters_that_were_asked_for_are_answered_and_no_more_of_an_edge_than_are_kept(seen):
    settings = SecondEdgeSettings(kept=2, least_score=0.0)
    cylinders, _, _ = answers(seen, edge_of(TRUTH), DIAMETERS, settings)
    assert len(cylinders) <= 4
    assert np.isin(2 * cylinders.radii, DIAMETERS).all()
    assert row_of(cylinders, TRUTH) >= 0


def test_pipes_shorter_than_wide_are_left_out(seen):
    lines = edge_of(TRUTH, half=50.0)
    assert (2 * answers(seen, lines, DIAMETERS)[0].radii <= 100.0).all()
    loose = SecondEdgeSettings(least_slenderness=0.5)
    assert row_of(answers(seen, lines, DIAMETERS, loose)[0], TRUTH) >= 0


def test_wrong_diameters_alone_find_nothing(seen):
    cylinders, _, score = answers(seen, edge_of(TRUTH), np.array([88.9, 168.3]))
    assert len(cylinders) == len(score) == 0


@pytest.mark.parametrize("count", [1, 2, 3])
def test_one_image_is_not_enough_and_two_are(seen, count):
    cylinders, _, score = answers(seen[:count], edge_of(TRUTH), DIAMETERS)
    if count == 1:
        assert len(cylinders) == 0
    else:
        assert TRUTH.distance(cylinders.points[row_of(cylinders, TRUTH)])[0] < 2.0
        assert score.max() > 0.9


def test_pictures_without_edges_give_nothing(blank):
    cylinders, extents, score = answers(blank, edge_of(TRUTH), DIAMETERS)
    assert len(cylinders) == len(score) == 0
    assert extents.shape == (0, 2)


def test_no_lines_give_nothing(seen):
    cylinders, extents, score = answers(seen, edge_of(TRUTH, ()), DIAMETERS)
    assert cylinders.points.shape == (0, 3)
    assert extents.shape == (0, 2)
    assert score.shape == (0,)


def test_no_diameters_give_nothing(seen):
    cylinders, extents, score = answers(seen, edge_of(TRUTH), np.zeros(0))
    assert (len(cylinders), len(extents), len(score)) == (0, 0, 0)


@pytest.mark.parametrize("shift", [[5000.0, 0.0, 0.0], [0.0, -6000.0, 0.0]], ids=["beside", "behind"])
def test_lines_that_no_camera_sees_give_nothing(seen, shift):
    lines = edge_of(TRUTH)
    away = EdgeLines(lines.ends + shift, lines.bright, lines.support, lines.views, lines.rows)
    assert len(answers(seen, away, DIAMETERS)[0]) == 0
