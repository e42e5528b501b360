# SPDX-License-Identifier: LGPL-2.1-or-later
"""One click inside a pipe: the edges around it, and the pipe they give, or a sentence where that is not sure."""

import numpy as np
import pytest
from synthetic import cameras, pipe, true_edges, views

from pipeworkbench.recon.inside import edges_around
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.pipes import answer_pick

TRUTH = pipe(114.3)


@pytest.fixture(scope="module")
def seen():
    return views([TRUTH], seed=3)


def click(part=0.5):
    """Return a point between the edges in the first picture, ``part`` of the way across."""
    edges = true_edges(cameras()[0], TRUTH).mean(axis=1)
    return edges[0] + part * (edges[1] - edges[0])


@pytest.mark.parametrize("part", [0.35, 0.5, 0.6])
def test_edges_around_a_click_are_found(seen, part):
    found = edges_around(seen[0].edges, click(part))
    truth = true_edges(cameras()[0], TRUTH)
    directions = (truth[:, 1] - truth[:, 0]) / np.linalg.norm(truth[:, 1] - truth[:, 0], axis=1)[:, None]

    def off(edge, row):
        offset = edge - truth[row, 0]
        return np.abs(offset[:, 0] * directions[row, 1] - offset[:, 1] * directions[row, 0]).max()

    assert min(max(off(found[0][0], a), off(found[0][1], 1 - a)) for a in (0, 1)) < 3.0


def test_click_beside_everything_has_no_edges_around(seen):
    assert edges_around(seen[0].edges, np.array([40.0, 40.0])) == []


@pytest.mark.slow
def test_click_inside_gives_the_pipe(seen):
    answer = answer_pick(seen, PipePick(0, 0, click(0.45).reshape(1, 1, 2)))
    assert answer.chosen.size.outer_diameter == 114.3
    assert TRUTH.distance(answer.chosen.ends).max() < 2.0


def test_click_where_nothing_is_says_what_to_do(seen):
    answer = answer_pick(seen, PipePick(0, 0, np.array([[[40.0, 40.0]]])))
    assert answer.chosen is None
    assert "click near both edges" in answer.reason
