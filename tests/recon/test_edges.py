# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subpixel edges against blurred steps whose place is known exactly."""

import tracemalloc

import cv2
import numpy as np
import pytest
from scipy.special import ndtr

from pipeworkbench.errors import InputError
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


def test_gradient_contrast_and_blur_are_those_of_the_step():
    settings = EdgeSettings()
    edges = detect_edges(step_image(0, 0.0, 40, 200))
    width = np.sqrt(settings.sigma**2 + BLUR_PX**2 + 1 / 12)  # smoothing, blur and the pixel's area add up
    assert edges.gradient[inner(edges)].mean() == pytest.approx(160 / (np.sqrt(2 * np.pi) * width), rel=0.03)
    assert edges.contrast[inner(edges)] == pytest.approx(160, rel=0.02)
    assert edges.blur[inner(edges)] == pytest.approx(BLUR_PX, abs=0.03)


@pytest.mark.parametrize("method", ["gradient", "partial area"])
@pytest.mark.parametrize("angle_deg", [0, 20, 45, 70, 160, 290])
def test_both_methods_tell_place_direction_and_contrast(method, angle_deg):
    edges = detect_edges(step_image(angle_deg, 0.2, 60, 180, noise=5.0), EdgeSettings(method=method))
    distance = signed_distance(*edges.position.T, angle_deg, 0.2)
    good = inner(edges) & (np.abs(distance) < 2)
    towards = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    assert good.sum() > 0.6 * SIZE
    assert abs(distance[good].mean()) < 0.04
    assert (edges.normal[good] @ towards).mean() > np.cos(np.radians(6))
    assert np.median(edges.contrast[good]) == pytest.approx(120, rel=0.08)
    assert np.median(edges.blur[good]) == pytest.approx(BLUR_PX, abs=0.25)
    assert 1 / 3 < distance[good].std() / np.sqrt(np.mean(edges.sigma[good] ** 2)) < 2


def test_partial_areas_are_exact_for_the_edges_they_are_made_for():
    """An ideal step, cut by the pixels' areas alone, as the method assumes."""
    angle, offset, fine = np.radians(17.0), 0.23, 40
    v, u = np.mgrid[: 60 * fine, : 60 * fine].astype(np.float32)
    distance = ((u + 0.5) / fine - 0.5 - 30) * np.cos(angle) + ((v + 0.5) / fine - 0.5 - 30) * np.sin(angle) - offset
    image = cv2.resize(np.where(distance > 0, 200.0, 40.0), (60, 60), interpolation=cv2.INTER_AREA)
    edges = detect_edges(np.rint(image * 256).astype(np.uint16), EdgeSettings(method="partial area"))
    good = (edges.position > 8).all(axis=1) & (edges.position < 51).all(axis=1)
    found = (edges.position[good] - 30) @ [np.cos(angle), np.sin(angle)] - offset
    assert np.abs(found).max() < 0.03
    assert edges.normal[good] @ [np.cos(angle), np.sin(angle)] == pytest.approx(1, abs=1e-3)


def disc(radius, centre, *, bright=True, size=120, fine=8, blur=1.0):
    v, u = np.mgrid[: size * fine, : size * fine].astype(np.float32)
    distance = np.hypot((u + 0.5) / fine - 0.5 - centre[0], (v + 0.5) / fine - 0.5 - centre[1])
    image = cv2.GaussianBlur(np.clip((radius - distance) * fine + 0.5, 0, 1), (0, 0), blur * fine)
    image = cv2.resize(image, (size, size), interpolation=cv2.INTER_AREA)
    return np.rint(60 + 120 * (image if bright else 1 - image)).astype(np.uint8)


@pytest.mark.parametrize("bright", [True, False])
@pytest.mark.parametrize(("radius", "bias"), [(40, 0.005), (20, 0.008), (12, 0.015)])
def test_curved_edges_are_not_drawn_inwards(radius, bias, bright):
    """Without the correction smoothing moves them by 0.06 px at a radius of 40 px, by 0.2 px at 12 px."""
    centre = (59.7, 60.2)
    edges = detect_edges(disc(radius, centre, bright=bright))
    off = np.hypot(*(edges.position - centre).T) - radius
    assert len(off) > 4 * radius
    assert abs(off.mean()) < bias
    assert np.abs(off).max() < 0.05


@pytest.mark.slow
@pytest.mark.parametrize("blur", [0.6, 1.0])
def test_lines_are_known_to_near_the_cramer_rao_bound(blur, monkeypatch):
    monkeypatch.setattr("test_edges.BLUR_PX", blur)
    monkeypatch.setattr("test_edges.SIZE", 160)
    random = np.random.default_rng(11)
    errors = []
    for seed in range(96):
        angle_deg, offset = random.uniform(0, 360), random.uniform(-0.5, 0.5)
        edges = detect_edges(step_image(angle_deg, offset, 90, 150, noise=2.0, seed=seed))
        distance = signed_distance(*edges.position.T, angle_deg, offset)
        along = (edges.position - 80) @ [-np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))]
        near = (np.abs(distance) < 1.5) & (np.abs(along) < 60)
        errors.append(np.polynomial.polynomial.polyfit(along[near], distance[near], 1)[0])
    bound = 2.0 / 60 * np.sqrt(2 * np.sqrt(np.pi) * np.sqrt(blur**2 + 1 / 12) / 120)
    # 96 errors tell their own size to 7 %
    assert np.sqrt(np.mean(np.square(errors))) < 1.25 * 1.15 * bound
    assert abs(np.mean(errors)) < 0.003


def test_neighbouring_edges_keep_their_places():
    """A bar of 5 px: what smooths more for less noise must not draw its sides to each other."""
    _, u = np.mgrid[:80, :80]
    image = np.rint(60 + 100 * (ndtr((u - 37.3) / 0.7) - ndtr((u - 42.3) / 0.7))).astype(np.uint8)
    edges = detect_edges(image)
    inside = (edges.position[:, 1] > 10) & (edges.position[:, 1] < 70)
    left, right = (edges.position[inside & (np.abs(edges.position[:, 0] - at) < 1.5), 0] for at in (37.3, 42.3))
    assert len(left) >= 50
    assert len(right) >= 50
    assert np.abs(left - 37.3).max() < 0.1
    assert np.abs(right - 42.3).max() < 0.1


# ---------------------------------------------------------------- kinds of images, strips, threads


def test_colours_give_the_edges_of_their_grey_picture():
    grey = step_image(70, 0.2, 40, 200, noise=3)
    colour = np.stack([grey] * 3, axis=2)
    reference = detect_edges(grey)
    for image in (colour, np.concatenate([colour, np.full((*grey.shape, 1), 255, np.uint8)], axis=2), grey[:, :, None]):
        assert np.array_equal(detect_edges(image).position, reference.position)
    deep = detect_edges(colour.astype(np.uint16) * 257)
    assert np.abs(deep.position - reference.position).max() < 0.02


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((40, 40)),
        np.full((40, 40), np.nan, np.float32),
        np.zeros((40, 40), np.int32),
        np.zeros((40, 40), bool),
        np.zeros((40, 40, 2), np.uint8),
        np.zeros((0, 40), np.uint8),
        np.zeros(40, np.uint8),
        np.zeros((0, 40, 3), np.uint16),
        None,
        [[1, 2], [3, 4]],
    ],
)
def test_what_is_no_image_is_refused_in_words(image):
    with pytest.raises(InputError, match=r"the image.*(type|shape)"):
        detect_edges(image)


@pytest.mark.parametrize("settings", [{"sigma": 0.0}, {"sigma": 2.0, "fine_sigma": 1.0}, {"method": "magic"}, {"fine_sigma": 99.0}])
def test_settings_that_do_not_fit_are_refused(settings):
    with pytest.raises(InputError, match="edge settings"):
        EdgeSettings(**settings)


@pytest.mark.parametrize("method", ["gradient", "partial area"])
def test_strips_and_threads_leave_no_trace(method, monkeypatch):
    """The same edges whether an image is worked through in one piece or in many."""
    random = np.random.default_rng(2)
    image = cv2.GaussianBlur(random.integers(0, 256, (333, 250), np.uint8), (0, 0), 4.0)
    image = np.where(image > np.median(image), 200, 60).astype(np.uint8)
    settings = EdgeSettings(method=method)
    monkeypatch.setattr("pipeworkbench.recon.edges.STRIP_BLOCKS", 1000)
    whole = detect_edges(image, settings, cores=1)
    assert len(whole) > 2000
    for blocks, cores in ((1, 1), (3, 2), (7, 4)):
        monkeypatch.setattr("pipeworkbench.recon.edges.STRIP_BLOCKS", blocks)
        parts = detect_edges(image, settings, cores=cores)
        assert np.array_equal(parts.pixel, whole.pixel)
        assert np.abs(parts.position - whole.position).max() < 1e-3
        assert np.array_equal(parts.index, whole.index)


@pytest.mark.slow
def test_twelve_megapixels_need_less_than_a_gigabyte():
    image = cv2.resize(step_image(30, 0.0, 40, 200), (4000, 3000))
    image = cv2.add(image, np.random.default_rng(1).integers(0, 9, image.shape, np.uint8))
    tracemalloc.start()
    detect_edges(image)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # NumPy's arrays are traced, OpenCV's are of a strip's size
    assert peak < 400e6


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
    assert (np.abs(edges.position[edges.index[v, u]] - edges.position) <= 1.1).all()
    v, u = np.nonzero(edges.index >= 0)
    assert set(edges.index[v, u]) == set(range(len(edges)))
    assert np.abs(edges.position[edges.index[v, u]] - np.column_stack([u, v])).max() <= 2


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
