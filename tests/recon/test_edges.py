# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subpixel edges against blurred steps whose place is known exactly."""

import numpy as np
import pytest
from scipy.special import ndtr

from pipeworkbench.recon.edges import EdgeSettings, detect_edges

SIZE = 120
BLUR_PX = 0.7
# Gauss-Legendre nodes: a pixel's value is the mean of the scene over its area
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


def signed_distance(u, v, angle_deg, offset):
    """Return the distance of points from a line near the image's centre, positive on its bright side."""
    angle = np.radians(angle_deg)
    return (u - SIZE / 2) * np.cos(angle) + (v - SIZE / 2) * np.sin(angle) - offset


def step_image(angle_deg, offset, low, high, dtype=np.uint8, noise=0.0, seed=1):
    v, u = np.mgrid[:SIZE, :SIZE].astype(float)
    image = np.zeros((SIZE, SIZE))
    for du, wu in zip(NODES / 2, WEIGHTS / 2, strict=True):
        for dv, wv in zip(NODES / 2, WEIGHTS / 2, strict=True):
            image += wu * wv * ndtr(signed_distance(u + du, v + dv, angle_deg, offset) / BLUR_PX)
    image = low + (high - low) * image
    if noise:
        image += np.random.default_rng(seed).normal(0, noise, image.shape)
    return np.clip(np.rint(image), 0, np.iinfo(dtype).max).astype(dtype)


def inner(edges):
    """Return which edge points are away from the image's border, where the scene ends."""
    return ((edges.position > 10) & (edges.position < SIZE - 11)).all(axis=1)


@pytest.mark.parametrize("angle_deg", [0, 7, 30, 45, 63, 90, 135, 181, 250, 300])
@pytest.mark.parametrize("offset", [0.0, 0.21, 0.5, -0.37])
def test_step_is_found_at_its_subpixel_place(angle_deg, offset):
    edges = detect_edges(step_image(angle_deg, offset, 40, 200))
    good = inner(edges)
    distance = signed_distance(*edges.position[good].T, angle_deg, offset)
    assert good.sum() > 0.6 * SIZE
    assert abs(distance.mean()) < 0.03
    assert np.abs(distance).max() < 0.1


@pytest.mark.parametrize(("low", "high", "dtype"), [(100, 115, np.uint8), (10, 250, np.uint8), (3000, 60000, np.uint16), (1000, 3000, np.uint16)])
@pytest.mark.parametrize("angle_deg", [12, 200])
def test_step_of_any_contrast_and_depth_is_found_without_bias(low, high, dtype, angle_deg):
    edges = detect_edges(step_image(angle_deg, 0.3, low, high, dtype))
    good = inner(edges)
    distance = signed_distance(*edges.position[good].T, angle_deg, 0.3)
    assert good.sum() > 0.6 * SIZE
    assert abs(distance.mean()) < 0.03
    assert np.sqrt(np.mean(distance**2)) < 0.1


@pytest.mark.parametrize("angle_deg", [0, 33, 90, 170, 250])
def test_normal_points_to_the_brighter_side(angle_deg):
    edges = detect_edges(step_image(angle_deg, 0.1, 40, 200))
    good = inner(edges)
    towards = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    assert np.linalg.norm(edges.normal, axis=1) == pytest.approx(1.0, abs=1e-5)
    assert (edges.normal[good] @ towards).min() > np.cos(np.radians(2))


def test_gradient_is_that_of_the_smoothed_step():
    settings = EdgeSettings()
    edges = detect_edges(step_image(0, 0.0, 40, 200))
    width = np.sqrt(settings.sigma**2 + BLUR_PX**2 + 1 / 12)  # smoothing, blur and the pixel's area add up
    assert edges.gradient[inner(edges)].mean() == pytest.approx(160 / (np.sqrt(2 * np.pi) * width), rel=0.03)


@pytest.mark.parametrize(("contrast", "noise"), [(160, 8.0), (80, 5.0), (60, 6.0)])
@pytest.mark.parametrize("angle_deg", [0, 20, 100, 45])
def test_scatter_under_noise_is_what_is_claimed(contrast, noise, angle_deg):
    distances, claimed = [], []
    for seed in range(8):
        edges = detect_edges(step_image(angle_deg, 0.2, 50, 50 + contrast, noise=noise, seed=seed))
        distance = signed_distance(*edges.position.T, angle_deg, 0.2)
        good = inner(edges) & (np.abs(distance) < 2)
        distances.append(distance[good])
        claimed.append(edges.sigma[good])
    distance, sigma = np.concatenate(distances), np.sqrt(np.mean(np.concatenate(claimed) ** 2))
    assert len(distance) > 8 * 0.5 * SIZE
    assert sigma > 1.3 * EdgeSettings().sigma_floor  # noise decides here, not the floor
    assert 1 / 1.6 < distance.std() / sigma < 1.6
    assert abs(distance.mean()) < 0.03


def test_more_noise_is_claimed_to_be_less_exact():
    sigmas = [detect_edges(step_image(10, 0, 50, 200, noise=noise)).sigma.mean() for noise in (4.0, 8.0, 16.0)]
    assert sigmas[0] < sigmas[1] < sigmas[2]


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_same_picture_gives_the_same_edges_at_either_depth(dtype):
    image = step_image(25, 0.4, 50, 200, noise=3)
    scaled = image if dtype is np.uint8 else image.astype(np.uint16) * 257
    edges, reference = detect_edges(scaled), detect_edges(image)
    assert len(edges) == len(reference)
    assert np.abs(edges.position - reference.position).max() < 1e-3


def test_index_leads_from_every_pixel_to_its_edge():
    edges = detect_edges(step_image(40, 0.3, 40, 200, noise=4))
    assert edges.index.shape == (SIZE, SIZE)
    # every edge answers in its own pixel, and beside it where no other edge does
    u, v = np.rint(edges.position).astype(int).T
    assert (np.abs(edges.position[edges.index[v, u]] - edges.position) <= 1).all()
    v, u = np.nonzero(edges.index >= 0)
    assert set(edges.index[v, u]) == set(range(len(edges)))
    assert np.abs(edges.position[edges.index[v, u]] - np.column_stack([u, v])).max() <= 1.5


@pytest.mark.parametrize("value", [0, 128, 255])
def test_blank_image_has_no_edges(value):
    edges = detect_edges(np.full((60, 80), value, np.uint8))
    assert len(edges) == 0
    assert (edges.index == -1).all()


@pytest.mark.parametrize("shape", [(1, 1), (1, 50), (50, 1), (2, 3), (4, 4), (5, 7), (24, 24), (25, 23)])
def test_tiny_image_is_no_trouble(shape):
    edges = detect_edges(np.random.default_rng(5).integers(0, 256, shape, np.uint8))
    assert edges.index.shape == shape
    assert np.isfinite(edges.position).all()
    assert np.isfinite(edges.sigma).all()


@pytest.mark.parametrize(("level", "noise", "dtype"), [(120, 3, np.uint8), (120, 25, np.uint8), (30000, 2000, np.uint16)])
def test_noise_alone_gives_hardly_any_edges(level, noise, dtype):
    image = np.random.default_rng(7).normal(level, noise, (400, 500))
    edges = detect_edges(np.clip(np.rint(image), 0, np.iinfo(dtype).max).astype(dtype))
    assert len(edges) / image.size < 0.01


def test_shade_gives_hardly_any_edges():
    v, u = np.mgrid[:200, :300]
    image = 60 + 0.1 * u + 0.08 * v + np.random.default_rng(8).normal(0, 2, u.shape)
    assert len(detect_edges(np.rint(image).astype(np.uint8))) / image.size < 0.01
