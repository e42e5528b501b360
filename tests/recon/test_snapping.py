# SPDX-License-Identifier: LGPL-2.1-or-later
"""The edge under a pointer: nearest, with its direction and the thread around it."""

import numpy as np
import pytest
from scipy.special import ndtr

from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.snapping import SnapSettings, nearest_edge

SIDE = 200
CENTRE, RADIUS = np.array([103.2, 96.7]), 60.0


@pytest.fixture(scope="module")
def disc_edges():
    """A bright disc on dark ground."""
    v, u = np.mgrid[:SIDE, :SIDE].astype(float)
    distance = np.hypot(u - CENTRE[0], v - CENTRE[1])
    return detect_edges(np.rint(60 + 120 * ndtr((RADIUS - distance) / 0.9)).astype(np.uint8))


@pytest.mark.parametrize("angle_deg", range(0, 360, 30))
def test_foot_and_direction_are_those_of_the_edge(disc_edges, angle_deg):
    outwards = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    pointer = CENTRE + (RADIUS + 4.0) * outwards
    edge = nearest_edge(disc_edges, pointer, 6.0)
    assert np.linalg.norm(edge.point - CENTRE) == pytest.approx(RADIUS, abs=0.1)
    assert edge.distance == pytest.approx(4.0, abs=0.15)
    # the brighter side, inwards, is on the right of the direction as seen in the image
    right = np.array([-edge.direction[1], edge.direction[0]])
    assert right @ -outwards == pytest.approx(1.0, abs=0.01)
    assert 0 < edge.sigma < 0.2


def test_thread_follows_the_edge_to_both_sides(disc_edges):
    edge = nearest_edge(disc_edges, CENTRE + np.array([0, -RADIUS]), 3.0, SnapSettings(reach=30.0))
    assert np.linalg.norm(edge.polyline - CENTRE, axis=1) == pytest.approx(RADIUS, abs=0.15)
    steps = np.linalg.norm(np.diff(edge.polyline, axis=0), axis=1)
    assert steps.max() < 3
    assert steps.sum() == pytest.approx(60, abs=6)
    towards_ends = (edge.polyline[[0, -1]] - edge.point) @ edge.direction
    assert towards_ends[0] < -15
    assert towards_ends[1] > 15


def test_thread_of_a_small_circle_ends_where_it_began():
    v, u = np.mgrid[:60, :60].astype(float)
    edges = detect_edges(np.rint(60 + 120 * ndtr((8 - np.hypot(u - 30, v - 30)) / 0.9)).astype(np.uint8))
    edge = nearest_edge(edges, (30, 22), 3.0, SnapSettings(reach=500.0))
    assert len(edge.polyline) < 150


def test_nothing_beyond_the_radius(disc_edges):
    assert nearest_edge(disc_edges, CENTRE, RADIUS - 2) is None
    assert nearest_edge(disc_edges, CENTRE, RADIUS + 2) is not None


@pytest.mark.parametrize("point", [(-50.0, -50.0), (SIDE + 80.0, 10.0), (10.0, SIDE + 80.0)])
def test_pointer_outside_the_image_finds_nothing(disc_edges, point):
    assert nearest_edge(disc_edges, point, 20.0) is None


def test_image_without_edges_has_nothing_to_snap_to():
    assert nearest_edge(detect_edges(np.full((80, 80), 90, np.uint8)), (40, 40), 30) is None
