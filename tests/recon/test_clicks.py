# SPDX-License-Identifier: LGPL-2.1-or-later
"""One click near each edge instead of two: the edges that are meant, and the pipe they give."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import cameras, pick, pipe, true_edges, views

from pipeworkbench.recon.clicks import complete_picks
from pipeworkbench.recon.pipes import from_pick

TRUTH = pipe(114.3)


@pytest.fixture(scope="module")
def seen():
    return views([TRUTH], seed=3)


def one_click_each(off_px=0.0, seed=0):
    """Return a pick with one point near the middle of each edge, ``off_px`` beside it in any direction."""
    whole = pick(0, TRUTH)
    angle = np.random.default_rng(seed).uniform(0, 2 * np.pi, 2)
    points = whole.edges.mean(axis=1) + off_px * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return replace(whole, edges=points[:, None])


def distances(points, edge):
    """Return the distances of points from the line through an edge (2, 2)."""
    direction = (edge[1] - edge[0]) / np.linalg.norm(edge[1] - edge[0])
    offset = points - edge[0]
    return np.abs(offset[:, 0] * direction[1] - offset[:, 1] * direction[0])


@pytest.mark.parametrize("off_px", [0.0, 3.0, 5.0])
@pytest.mark.parametrize("seed", range(3))
def test_edges_are_found_from_one_click_near_each(seen, off_px, seed):
    found = complete_picks(seen[0], one_click_each(off_px, seed))
    truth = true_edges(cameras()[0], TRUTH)
    assert found
    assert found[0].edges.shape == (2, 2, 2)
    for edge, true_edge in zip(found[0].edges, truth, strict=True):
        assert np.linalg.norm(edge[1] - edge[0]) > 100
        assert distances(edge, true_edge).max() < 0.7


def test_pick_with_both_edges_stays_as_it_is(seen):
    whole = pick(0, TRUTH, off_px=1.0)
    assert complete_picks(seen[0], whole) == (whole,)


def test_an_edge_that_is_too_faint_for_a_line_runs_along_the_other_through_its_click(seen):
    clicks = one_click_each()
    inside = clicks.edges.mean(axis=0, keepdims=True)  # nothing is there
    found = complete_picks(seen[0], replace(clicks, edges=np.concatenate([clicks.edges[:1], inside])))
    assert found
    one, other = found[0].edges
    assert np.cross(one[1] - one[0], other[1] - other[0]) == pytest.approx(0, abs=1e-6)
    assert distances(inside[0], other).max() < 1e-6


def test_clicks_far_from_any_edge_mean_nothing(seen):
    nowhere = replace(one_click_each(), edges=np.array([[[40.0, 40.0]], [[90.0, 40.0]]]))
    assert complete_picks(seen[0], nowhere) == ()
    assert from_pick(seen, nowhere) == ()


@pytest.mark.slow
def test_one_click_near_each_edge_gives_the_pipe(seen):
    (found,) = from_pick(seen, one_click_each(3.0, 1))
    assert found.size.outer_diameter == 114.3
    assert TRUTH.distance(found.ends).max() < 2.0
