# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long lines in clutter: short interruptions do not matter, texture is none."""

import cv2
import numpy as np
import pytest

from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.long_lines import long_lines, significance

WIDTH, HEIGHT = 640, 480
SLOPE = 0.07


def strip(rng, hidden=(), texture=0.0):
    """Return a noisy picture of a slanting edge that brick as bright as the strip hides in some stretches (u from, u to)."""
    v, u = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    picture = 90 + 60 / (1 + np.exp(-(v - 200 - SLOPE * u) / 0.6))
    for low, high in hidden:
        picture[:, low:high] = 120
    blobs = cv2.GaussianBlur(rng.normal(0, 1, picture.shape), (0, 0), 3.0)
    return np.clip(np.rint(picture + texture * blobs / blobs.std() + rng.normal(0, 2, picture.shape)), 0, 255).astype(np.uint8)


def on_the_edge(lines):
    """Return which segments lie on the strip's edge."""
    return (np.abs(lines.ends[:, :, 1] - 200 - SLOPE * lines.ends[:, :, 0]) < 1.0).all(axis=1)


def test_an_edge_is_one_line_at_its_place():
    lines = long_lines(detect_edges(strip(np.random.default_rng(1))))
    assert len(lines) == 1
    assert lines.length[0] > 0.95 * WIDTH
    assert np.abs(lines.ends[0, :, 1] - 200 - SLOPE * lines.ends[0, :, 0]).max() < 0.1
    assert lines.normal[0, 1] > 0.99  # what is brighter is below


def test_short_interruptions_do_not_end_a_line_and_long_ones_do():
    lines = long_lines(detect_edges(strip(np.random.default_rng(2), hidden=((120, 126), (300, 305), (480, 520)))))
    assert sorted(lines.length[on_the_edge(lines)]) == pytest.approx([116, 476], abs=10)


def test_an_edge_stands_out_of_texture_and_texture_alone_has_few_lines():
    rng = np.random.default_rng(3)
    lines = long_lines(detect_edges(strip(rng, texture=6.0)))
    assert on_the_edge(lines)[0]
    assert lines.length[on_the_edge(lines)].sum() > 0.8 * WIDTH
    alone = np.clip(np.rint(120 + 30 * cv2.GaussianBlur(rng.normal(0, 1, (HEIGHT, WIDTH)), (0, 0), 2.0) / 0.14), 0, 255).astype(np.uint8)
    edges = detect_edges(alone)
    assert len(edges) > 5000
    assert len(long_lines(edges)) < 40


def test_nothing_to_find():
    assert len(long_lines(detect_edges(np.full((HEIGHT, WIDTH), 100, np.uint8)))) == 0


def test_points_are_significant_where_they_are_more_than_expected():
    assert significance(np.array([10, 3]), np.array([10.0, 5.0])) == pytest.approx([0.0, 0.0])
    few, many = significance(np.array([20, 40]), np.array([10.0, 20.0]))
    assert many == pytest.approx(2 * few)
    assert few > 0
