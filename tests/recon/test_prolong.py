# SPDX-License-Identifier: LGPL-2.1-or-later
"""A piece of a pipe is followed to the pipe's ends, and no further."""

import numpy as np
import pytest
from synthetic import pipe, views

from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.prolong import prolonged

TRUTH = pipe(114.3, (10.0, 15.0))


@pytest.fixture(scope="module")
def seen():
    return views([TRUTH], seed=5)


def test_a_piece_is_followed_as_far_as_the_edges_go(seen):
    half = float(np.linalg.norm(TRUTH.end - TRUTH.start)) / 2
    piece = np.array([[-0.4 * half, 0.3 * half]])
    found = prolonged(seen, TRUTH.cylinder.as_many(), piece)[0]
    # the pictures may end before the pipe does
    assert found[0] < -0.6 * half
    assert found[1] > 0.6 * half
    assert np.abs(found).max() < 1.15 * half


def test_what_has_no_edges_stays_as_it_is(seen):
    beside = TRUTH.cylinder.as_many()
    moved = Cylinders(beside.points + np.array([[0.0, 0.0, 400.0]]), beside.directions, beside.radii / 3)
    assert prolonged(seen, moved, np.array([[-50.0, 60.0]])) == pytest.approx(np.array([[-50.0, 60.0]]), abs=20.0)


def test_none_are_none(seen):
    none = Cylinders(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    assert prolonged(seen, none, np.zeros((0, 2))).shape == (0, 2)
