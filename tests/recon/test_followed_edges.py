# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges under the pointer, followed along a drawn bar with a gap in one of its edges."""

import numpy as np
import pytest

from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.followed_edges import edges_of_clicks, followed_edge
from pipeworkbench.recon.snapping import nearest_edge


@pytest.fixture(scope="module")
def edges():
    """A bright bar from (40, 60) to (360, 100) whose upper edge has a short gap and which ends at 300 below."""
    import cv2

    image = np.full((160, 400), 60, np.uint8)
    image[60:101, 40:361] = 160
    image[55:66, 200:207] = 110
    noise = np.random.default_rng(1).normal(0, 1.0, image.shape)
    return detect_edges(np.clip(cv2.GaussianBlur(image, (0, 0), 1.2) + noise, 0, 255).astype(np.uint8))


def test_an_edge_is_followed_over_short_gaps_to_its_ends(edges):
    ends = followed_edge(edges, nearest_edge(edges, (120.0, 61.0), 5.0))
    assert np.sort(ends[:, 0]) == pytest.approx([40.0, 360.0], abs=6.0)
    assert ends[:, 1] == pytest.approx(59.5, abs=0.5)


def test_both_edges_run_in_one_direction(edges):
    points = np.array([[100.0, 59.5], [250.0, 100.5]])
    found = edges_of_clicks(edges, points, tuple(nearest_edge(edges, point, 5.0) for point in points))
    directions = found[:, 1] - found[:, 0]
    assert directions[0] @ directions[1] > 0
    assert np.abs(found[0, :, 1] - found[1, :, 1]) == pytest.approx(41.0, abs=1.0)


def test_an_edge_that_cannot_be_followed_is_parallel_to_the_other_one(edges):
    points = np.array([[100.0, 59.5], [100.0, 80.0]])
    found = edges_of_clicks(edges, points, (nearest_edge(edges, points[0], 5.0), None))
    assert found[1, :, 1] == pytest.approx(80.0, abs=0.6)
    assert edges_of_clicks(edges, points, (None, None)) is None
