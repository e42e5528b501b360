# SPDX-License-Identifier: LGPL-2.1-or-later
"""The texture of a cylinder's surface finds its place in depth; which of nested rows of edges is the limb."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from synthetic import HEIGHT, WIDTH, cameras, pick, pipe, views

from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.tangents import all_tangents_of, tangents_of
from pipeworkbench.recon.texture import texture
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import Weights, outermost_first

TRUTH = pipe(114.3, (10.0, 5.0))
EXTENT = np.array([[-150.0, 150.0]])
NOISE = 1.5


def photograph_of_surface(camera, contrast, seed):
    """Return a smoothed picture of the cylinder alone, painted with stains of about 15 mm."""
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    rays = camera.rays(np.column_stack([u.ravel(), v.ravel()]).astype(float))
    cylinder = TRUTH.cylinder
    offset = camera.projection_centre - cylinder.point
    across_ray = rays - np.outer(rays @ cylinder.direction, cylinder.direction)
    across_offset = offset - (offset @ cylinder.direction) * cylinder.direction
    a, b = np.sum(across_ray**2, axis=1), across_ray @ across_offset
    root = b**2 - a * (across_offset @ across_offset - cylinder.radius**2)
    hit = root > 0
    point = offset + ((-b - np.sqrt(np.where(hit, root, 0))) / a)[:, None] * rays
    waves = np.random.default_rng(5).normal(0, 1 / 15, (40, 3))
    phases = np.random.default_rng(6).uniform(0, 2 * np.pi, 40)
    stains = np.sin(point @ waves.T + phases).sum(axis=1) / np.sqrt(20)
    picture = np.where(hit, 120 + contrast * stains, 60.0) + np.random.default_rng(seed).normal(0, NOISE, len(rays))
    return cv2.GaussianBlur(picture.reshape(HEIGHT, WIDTH).astype(np.float32), (0, 0), 1.5)


def surface_views(contrast):
    empty = views([])
    return [View(camera, empty[0].edges, photograph_of_surface(camera, contrast, 70 + k)) for k, camera in enumerate(cameras())]


def at_distances(origin, shifts):
    """Return the true cylinder, as wide in the picture but nearer or further away (mm)."""
    towards = TRUTH.cylinder.point - origin
    factor = 1 + np.asarray(shifts) / np.linalg.norm(towards)
    directions = np.repeat(TRUTH.direction[None], len(factor), axis=0)
    return Cylinders(origin + factor[:, None] * towards, directions, TRUTH.diameter / 2 * factor)


@pytest.mark.parametrize("reference", [0, 2])
def test_texture_peaks_at_the_true_distance(reference):
    seen = surface_views(contrast=12.0)
    shifts = np.array([-200.0, -60.0, -30.0, 0.0, 30.0, 60.0, 200.0])
    cylinders = at_distances(seen[reference].camera.projection_centre, shifts)
    ratios = texture(seen, reference, cylinders, np.repeat(EXTENT, len(shifts), axis=0))
    assert ratios.shape == (3, len(shifts))
    assert (ratios[reference] == 0).all()
    others = np.delete(ratios, reference, axis=0)
    assert (others.argmax(axis=1) == 3).all()
    assert (others[:, 3] > 2).all()
    assert (others[:, [0, -1]] < others[:, 3:4] - 2).all()


def test_bare_surface_says_little():
    seen = surface_views(contrast=0.0)
    cylinders = at_distances(seen[0].camera.projection_centre, np.linspace(-200, 200, 21))
    ratios = texture(seen, 0, cylinders, np.repeat(EXTENT, 21, axis=0))
    assert np.abs(ratios).max() < 1.0


def test_surface_beyond_the_image_says_nothing():
    seen = surface_views(contrast=12.0)
    aside = Cylinders(TRUTH.cylinder.point[None] + [[5000.0, 0, 0]], TRUTH.direction[None], np.array([TRUTH.diameter / 2]))
    assert (texture(seen, 0, aside, EXTENT) == 0).all()


def nested(edges, rest):
    """Return a pipe of 57 mm and one of 60.3 mm around it that share their first edge."""
    radii = np.array([57.0, 60.3]) / 2
    points = np.array([[0.0, 5000.0, 0.0], [0.0, 5000.0, 0.0]])
    directions = np.array([[0.0, 0.0, 1.0]] * 2)
    points[1, 0] = -(radii[1] - radii[0])
    weights = Weights(np.asarray(edges, float), np.asarray(rest, float), np.zeros(2))
    return outermost_first(Cylinders(points, directions, radii), weights, np.zeros(3), 7000.0)


def test_outer_of_two_rows_is_the_limb_though_the_inner_is_clearer():
    assert nested([[20.0, 60.0], [20.0, 12.0]], [0.0, 0.0])[0] == 1
    assert nested([[60.0, 20.0], [12.0, 20.0]], [0.0, 0.0])[0] == 0


def test_outer_row_needs_edges():
    assert nested([[20.0, 60.0], [20.0, -3.0]], [0.0, 0.0])[0] == 0


def test_pipe_elsewhere_must_be_better():
    radii = np.array([57.0, 60.3]) / 2
    points = np.array([[0.0, 5000.0, 0.0], [0.0, 5400.0, 0.0]])
    weights = Weights(np.array([[20.0, 60.0], [20.0, 12.0]]), np.zeros(2), np.zeros(2))
    order = outermost_first(Cylinders(points, np.array([[0.0, 0.0, 1.0]] * 2), radii), weights, np.zeros(3), 7000.0)
    assert order.tolist() == [0, 1]


def test_clicks_prefer_the_cylinder_they_were_made_on():
    (view, *_) = views([TRUTH], seed=3)
    tangents = tangents_of(view, pick(0, TRUTH, off_px=1.0, seed=1))
    origin, scale = view.camera.projection_centre, view.camera.interior.pixels_per_radian
    cylinder = TRUTH.cylinder
    aside = Cylinders(
        cylinder.point + np.array([[0.0, 0, 0], [5.0, 0, 0], [20.0, 0, 0]]), np.tile(cylinder.direction, (3, 1)), np.full(3, cylinder.radius)
    )
    prior = tangents.click_prior(aside, origin, scale)
    assert prior[0] > prior[1] > prior[2]
    assert prior[0] > -4


def test_pipe_reaches_from_the_first_to_the_last_click_of_either_edge():
    (view, *_) = views([TRUTH], seed=3)
    clicked = pick(0, TRUTH)
    first, second = clicked.edges
    # one edge hidden in its second half, the other in its first
    halves = np.array([[first[0], first.mean(axis=0)], [second.mean(axis=0), second[1]]])
    whole, parts = tangents_of(view, clicked), tangents_of(view, replace(clicked, edges=halves))
    assert parts.half_length == pytest.approx(whole.half_length, rel=0.03)
    assert parts.half_width == pytest.approx(whole.half_width, rel=0.02)
    assert parts.sigma_slope > whole.sigma_slope


def test_alternatives_begin_with_the_most_likely_edges():
    (view, *_) = views([TRUTH], seed=3)
    alternatives = all_tangents_of(view, pick(0, TRUTH, off_px=1.5, seed=2))
    width = 2 * np.arcsin(TRUTH.diameter / 2 / np.linalg.norm(TRUTH.cylinder.point - view.camera.projection_centre))
    assert 2 * alternatives[0].half_width == pytest.approx(width, rel=0.03)
