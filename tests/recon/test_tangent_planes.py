# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tangent planes from clicked pixels: they contain their edges, and their errors are of the size that is said."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import INTERIOR, cameras, pipe, true_edges

from pipeworkbench.errors import InputError
from pipeworkbench.recon.cylinder import edge_lines
from pipeworkbench.recon.tangent_planes import apparent_pipe, tangent_plane

LEFT, RIGHT, TOP = cameras()
TRIALS = 100


def edges_of(camera, cylinder, half_length, count=2):
    """Return pixels (2, count, 2) of both edges of a cylinder."""
    lines, _ = edge_lines(cylinder.as_many(), camera.projection_centre)
    along = np.linspace(-half_length, half_length, count)
    return np.array([camera.project(point + along[:, None] * cylinder.direction) for point in lines[0]])


def test_plane_contains_its_edge_and_the_projection_centre():
    edge = true_edges(LEFT, pipe())[0]
    plane = tangent_plane(LEFT, edge)
    assert LEFT.rays(edge) @ plane.normal == pytest.approx(0.0, abs=1e-12)
    assert plane.rays == pytest.approx(LEFT.rays(edge), abs=1e-12)
    assert plane.projection_centre == pytest.approx(LEFT.projection_centre)
    assert np.linalg.norm(plane.normal) == pytest.approx(1.0)
    assert plane.residual_rms == pytest.approx(0.0, abs=1e-9)


def test_plane_is_one_radius_from_the_axis():
    truth = pipe()
    for edge in true_edges(LEFT, truth):
        plane = tangent_plane(LEFT, edge, inside=LEFT.project(truth.cylinder.point[None])[0])
        assert plane.normal @ (truth.start - LEFT.projection_centre) == pytest.approx(truth.diameter / 2, abs=1e-6)
        assert plane.normal @ (truth.end - LEFT.projection_centre) == pytest.approx(truth.diameter / 2, abs=1e-6)


def test_normal_points_to_the_side_that_was_clicked():
    edge = true_edges(LEFT, pipe())[0]
    across = np.array([40.0, 0.0])
    one, other = (tangent_plane(LEFT, edge, inside=edge.mean(axis=0) + side * across) for side in (1, -1))
    assert one.normal == pytest.approx(-other.normal, abs=1e-12)
    assert one.side_known
    assert other.side_known
    assert one.normal @ LEFT.rays(edge.mean(axis=0) + across)[0] > 0
    assert not tangent_plane(LEFT, edge).side_known


def test_distorted_edge_spans_a_plane():
    camera = replace(LEFT, interior=replace(INTERIOR, distortion=(-0.25, 0.08, 1e-3, -5e-4)))
    edges = edges_of(camera, pipe().cylinder, 250.0, count=15)
    ends = edges[0][[0, -1]]
    chord = ends[0] + np.linspace(0, 1, 15)[:, None] * (ends[1] - ends[0])
    assert np.abs(edges[0] - chord).max() > 0.3  # the lens bends it by far more than a measurement's error
    assert tangent_plane(camera, edges[0]).residual_rms < 1e-6


@pytest.mark.parametrize("count", [2, 3, 25])
def test_errors_of_planes_agree_with_their_covariance(count):
    random = np.random.default_rng(count)
    edge = edges_of(LEFT, pipe().cylinder, 250.0, count)[0]
    truth = tangent_plane(LEFT, edge, sigma_px=0.5)
    squares, rms = [], []
    for _ in range(TRIALS):
        plane = tangent_plane(LEFT, edge + random.normal(0, 0.5, edge.shape), sigma_px=0.5)
        normal = plane.normal * np.sign(plane.normal @ truth.normal)
        error = truth.axes @ (normal - truth.normal)
        squares.append(error @ np.linalg.solve(truth.covariance, error))
        rms.append(plane.residual_rms)
    # chi-square of two degrees of freedom: mean 2, variance 4
    assert np.mean(squares) == pytest.approx(2.0, abs=4 * 2 / np.sqrt(TRIALS))
    assert np.mean(np.square(rms)) == pytest.approx(0.25 * (count - 2) / count, abs=0.02)


def test_sigma_of_two_clicks_is_that_of_their_mean():
    edge = true_edges(LEFT, pipe())[0]
    # the middle of two points, at some 1300 px per radian
    assert tangent_plane(LEFT, edge, sigma_px=2.0).sigma == pytest.approx(2.0 / np.sqrt(2) / 1300, rel=0.05)
    assert tangent_plane(LEFT, edge, sigma_px=4.0).sigma == pytest.approx(2 * tangent_plane(LEFT, edge, sigma_px=2.0).sigma)


def test_point_that_is_less_certain_counts_less():
    edge = edges_of(LEFT, pipe().cylinder, 250.0, 3)[0]
    edge[1] += [3.0, 0.0]
    fair, wary = tangent_plane(LEFT, edge, sigma_px=1.0), tangent_plane(LEFT, edge, sigma_px=[1.0, 1e4, 1.0])
    assert np.abs(LEFT.rays(edge[[0, 2]]) @ wary.normal).max() < 1e-8
    assert np.abs(LEFT.rays(edge[[0, 2]]) @ fair.normal).max() > 1e-4


@pytest.mark.parametrize(
    ("pixels", "sigma", "problem"),
    [
        ([[100.0, 100.0]], 1.0, "fewer than two points"),
        ([[100.0, 100.0], [101.0, 102.0]], 1.0, "only 2.2 px apart"),
        ([[100.0, 100.0], [np.nan, 200.0]], 1.0, "no ray"),
        ([[100.0, 100.0], [100.0, 200.0]], 0.0, "standard deviation"),
        ([[100.0, 100.0], [100.0, 200.0]], np.nan, "standard deviation"),
    ],
)
def test_edges_that_span_no_plane_are_refused(pixels, sigma, problem):
    with pytest.raises(InputError, match=f"the edge in camera left: .*{problem}"):
        tangent_plane(LEFT, pixels, sigma_px=sigma)


def test_side_that_is_nowhere_is_refused():
    with pytest.raises(InputError, match="the point beside it has no ray"):
        tangent_plane(LEFT, true_edges(LEFT, pipe())[0], inside=[np.nan, 3.0])


def test_normals_of_both_edges_point_to_the_axis():
    truth = pipe()
    seen = apparent_pipe(RIGHT, *true_edges(RIGHT, truth))
    for plane in seen.edges:
        assert plane.side_known
        assert plane.normal @ (truth.start - RIGHT.projection_centre) == pytest.approx(truth.diameter / 2, abs=1e-6)


def test_centre_plane_contains_the_axis():
    truth = pipe()
    seen = apparent_pipe(TOP, *true_edges(TOP, truth))
    assert seen.centre_normal @ (truth.start - TOP.projection_centre) == pytest.approx(0.0, abs=1e-6)
    assert seen.centre_normal @ (truth.end - TOP.projection_centre) == pytest.approx(0.0, abs=1e-6)
    assert np.abs(seen.direction @ truth.direction) == pytest.approx(1.0, abs=1e-9)


def test_one_edge_clicked_twice_is_refused():
    edge = true_edges(LEFT, pipe())[0]
    with pytest.raises(InputError, match="the pipe in camera left: both edges are the same edge; click one edge on each side"):
        apparent_pipe(LEFT, edge, np.add(edge, [0.5, 0.0]))


def test_edges_that_cross_are_refused():
    first, second = true_edges(LEFT, pipe())
    with pytest.raises(InputError, match="cross in the picture"):
        apparent_pipe(LEFT, [first[0], second[1]], [second[0], first[1]])


def test_edges_may_be_clicked_in_either_direction():
    first, second = true_edges(LEFT, pipe())
    one, other = apparent_pipe(LEFT, first, second), apparent_pipe(LEFT, first, second[::-1])
    for a, b in zip(one.edges, other.edges, strict=True):
        assert a.normal == pytest.approx(b.normal, abs=1e-12)
