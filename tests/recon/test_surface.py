# SPDX-License-Identifier: LGPL-2.1-or-later
"""Images agree about a surface that is where it is said to be, and not about what is beside a pipe that stands free."""

from dataclasses import dataclass

import cv2
import numpy as np
import pytest
from synthetic import HEIGHT, WIDTH, cameras, pipe, views

from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.surface import agreement, surface_agreement
from pipeworkbench.recon.views import View

TRUTH = pipe(114.3, (10.0, 5.0))
EXTENT = np.array([[-200.0, 200.0]])
NOISE = 1.5
STAIN_MM = 15.0
PAIRS = 3  # of three cameras


def stains(points, seed=5, count=8):
    """Return a mottled brightness (n,) of unit variance as a function of the place (n, 3)."""
    rng = np.random.default_rng(seed)
    waves, phases = rng.normal(0, 1 / STAIN_MM, (count, 3)), rng.uniform(0, 2 * np.pi, count)
    return np.sin(points @ waves.T + phases).sum(axis=1) / np.sqrt(count / 2)


@dataclass(frozen=True)
class Wall:
    """A plane across the cameras' sight at a distance, with a brightness (n,) as a function of the place (n, 3)."""

    distance: float
    paint: object

    def hit(self, centre, rays):
        """Return how far (n,) rays (n, 3) go."""
        return (self.distance - centre[1]) / rays[:, 1]


@dataclass(frozen=True)
class PaintedPipe:
    """A pipe without ends, with a brightness as a function of the place relative to its middle."""

    truth: object
    paint: object

    def hit(self, centre, rays):
        """Return how far (n,) rays (n, 3) go, infinity where they miss."""
        cylinder = self.truth.cylinder
        offset = centre - cylinder.point
        across_ray = rays - np.outer(rays @ cylinder.direction, cylinder.direction)
        across_offset = offset - (offset @ cylinder.direction) * cylinder.direction
        a, b = np.sum(across_ray**2, axis=1), across_ray @ across_offset
        root = b**2 - a * (across_offset @ across_offset - cylinder.radius**2)
        return np.where(root > 0, (-b - np.sqrt(np.maximum(root, 0))) / a, np.inf)


def photograph(camera, things, seed, rays=None):
    """Return a picture (height, width) of painted things, the nearest in front, with noise; no thing is dark."""
    if rays is None:
        v, u = np.mgrid[:HEIGHT, :WIDTH]
        rays = camera.rays(np.column_stack([u.ravel(), v.ravel()]).astype(float))
    centre = camera.projection_centre
    nearest, picture = np.full(len(rays), np.inf), np.full(len(rays), 60.0)
    for thing in things:
        far = thing.hit(centre, rays)
        front = far < nearest
        nearest[front] = far[front]
        picture[front] = thing.paint(centre + far[front, None] * rays[front])
    return (picture + np.random.default_rng(seed).normal(0, NOISE, len(rays))).reshape(HEIGHT, WIDTH)


def views_of_things(*things, count=3):
    """Return views for their shading alone: their edges are not found."""
    blank = views([], 1)[0]
    return [
        View(camera, blank.edges, cv2.GaussianBlur(photograph(camera, things, 70 + k).astype(np.float32), (0, 0), 1.5))
        for k, camera in enumerate(cameras(count))
    ]


def many(truth, *shifts):
    """Return a cylinder where it is and moved along the sight by distances (mm), as wide in the picture."""
    origin = np.mean([camera.projection_centre for camera in cameras()], axis=0)
    towards = truth.cylinder.point - origin
    factor = 1 + np.array([0.0, *shifts]) / np.linalg.norm(towards)
    return Cylinders(origin + factor[:, None] * towards, np.tile(truth.direction, (len(factor), 1)), truth.diameter / 2 * factor)


def across_of(points):
    """Return where points (n, 3) of the true pipe lie across axis and sight, in radii."""
    sideways = np.cross(TRUTH.direction, TRUTH.cylinder.point - np.mean([camera.projection_centre for camera in cameras()], axis=0))
    return (points - TRUTH.cylinder.point) @ sideways / np.linalg.norm(sideways) / (TRUTH.diameter / 2)


def mottled(brightness=120.0, contrast=12.0, seed=5):
    return lambda points: brightness + contrast * stains(points, seed)


@pytest.fixture(scope="module")
def free_pipe():
    """A mottled pipe half a metre before a mottled wall."""
    return views_of_things(Wall(3500.0, mottled(90.0, 15.0, 8)), PaintedPipe(TRUTH, mottled(150.0)))


def test_images_agree_about_the_surface_where_it_is_and_not_further_back_or_nearer(free_pipe):
    cylinders = many(TRUTH, 100.0, -100.0)
    values = agreement(free_pipe, cylinders, np.repeat(EXTENT, 3, axis=0)).surface
    assert values.shape == (PAIRS, 3)
    assert (values[:, 0] > 0.95).all()
    assert (values[:, 1:] < 0.6).all()


def test_few_samples_find_the_same_agreement(free_pipe):
    cylinders, extents = many(TRUTH, 100.0), np.repeat(EXTENT, 2, axis=0)
    coarse, fine = surface_agreement(free_pipe, cylinders, extents, 10, 7), agreement(free_pipe, cylinders, extents).surface
    assert surface_agreement(free_pipe, cylinders, extents) == pytest.approx(fine)
    assert coarse[:, 0] == pytest.approx(fine[:, 0], abs=0.03)
    assert (coarse[:, 1] < 0.7).all()


def test_wrong_radius_disagrees(free_pipe):
    right = many(TRUTH)
    for factor, less in ((0.5, 0.05), (2.0, 0.1)):
        wrong = Cylinders(right.points, right.directions, factor * right.radii)
        assert (surface_agreement(free_pipe, wrong, EXTENT) < surface_agreement(free_pipe, right, EXTENT) - less).all()


def test_an_axis_the_other_way_round_is_the_same_surface(free_pipe):
    there = many(TRUTH)
    back = Cylinders(there.points, -there.directions, there.radii)
    one, other = agreement(free_pipe, there, EXTENT), agreement(free_pipe, back, EXTENT)
    assert other.surface == pytest.approx(one.surface, abs=1e-3)
    assert np.sort(other.beside, axis=0) == pytest.approx(np.sort(one.beside, axis=0), abs=1e-3)
    assert other.constancy == pytest.approx(one.constancy, abs=1e-3)


def test_brighter_pictures_of_one_camera_agree_as_well(free_pipe):
    dim = [View(view.camera, view.edges, view.smooth * (0.5 + number) + 10 * number) for number, view in enumerate(free_pipe)]
    assert agreement(dim, many(TRUTH), EXTENT).surface == pytest.approx(agreement(free_pipe, many(TRUTH), EXTENT).surface, abs=1e-3)


def test_images_disagree_about_what_is_beside_a_pipe_that_stands_free(free_pipe):
    values = agreement(free_pipe, many(TRUTH), EXTENT).beside
    assert values.shape == (4, 1)
    assert (values < 0.6).all()


def test_images_agree_beside_a_stripe_painted_on_a_wall():
    upright = pipe(114.3, (0.0, 0.0))

    def paint(points):
        return mottled()(points) + np.where(np.abs(points[:, 0]) < upright.diameter / 2, 50.0, 0.0)

    values = agreement(views_of_things(Wall(3000.0, paint), count=2), many(upright), EXTENT)
    assert (values.beside > 0.95).all()


def test_brightness_that_changes_across_alone_is_constant_along():
    def shading(points):
        return 120 + 40 * across_of(points)

    values = agreement(views_of_things(PaintedPipe(TRUTH, shading)), many(TRUTH), EXTENT)
    assert values.constancy[0] > 0.95
    assert (values.surface > 0.95).all()


def test_brightness_that_changes_along_alone_is_not_constant():
    def rings(points):
        return 120 + 30 * np.sin((points - TRUTH.cylinder.point) @ TRUTH.direction / 20)

    assert agreement(views_of_things(PaintedPipe(TRUTH, rings), count=2), many(TRUTH), EXTENT).constancy[0] < 0.1


@pytest.mark.slow
def test_constancy_is_the_share_of_the_variance_across():
    # of two patterns of like variance each explains a half
    def both(points):
        along = (points - TRUTH.cylinder.point) @ TRUTH.direction
        return 120 + 20 * np.sin(along / 20) + 20 * np.sin(2 * np.pi * across_of(points) / 1.6)

    assert agreement(views_of_things(PaintedPipe(TRUTH, both), count=2), many(TRUTH), EXTENT).constancy[0] == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize("shift", [[5000.0, 0.0, 0.0], [0.0, -6000.0, 0.0]], ids=["beside", "behind"])
def test_nothing_is_known_of_what_the_images_do_not_contain(free_pipe, shift):
    right = many(TRUTH)
    values = agreement(free_pipe, Cylinders(right.points + shift, right.directions, right.radii), EXTENT)
    assert np.isnan(values.surface).all()
    assert np.isnan(values.beside).all()
    assert values.constancy.tolist() == [0.0]


def test_camera_that_does_not_see_the_pipe_leaves_its_pairs_unknown(free_pipe):
    left, right, top = free_pipe
    away = View(type(top.camera)("away", top.camera.interior, top.camera.rotation, np.array([9000.0, 0.0, 0.0])), top.edges, top.smooth)
    # its projection centre is part of what the visible side is, so ask for the pairs alone
    values = surface_agreement([left, right, away], many(TRUTH), EXTENT)[:, 0]
    assert np.isfinite(values[0])
    assert np.isnan(values[1:]).all()


def test_blank_pictures_do_not_agree(free_pipe):
    blank = [View(view.camera, view.edges, np.full_like(view.smooth, 100.0)) for view in free_pipe]
    values = agreement(blank, many(TRUTH), EXTENT)
    assert np.abs(values.surface).max() < 0.5
    assert np.isfinite(values.constancy).all()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_every_two_images_are_compared(free_pipe, count):
    values = agreement(free_pipe[:count], many(TRUTH, 100.0), np.repeat(EXTENT, 2, axis=0))
    assert values.surface.shape == (count * (count - 1) // 2, 2)
    assert values.beside.shape == (4, 2)
    assert values.constancy.shape == (2,)
    assert np.isnan(values.beside).all() == (count == 1)


def test_no_cylinders_have_no_agreement(free_pipe):
    nothing = Cylinders(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    values = agreement(free_pipe, nothing, np.zeros((0, 2)))
    assert values.surface.shape == (PAIRS, 0)
    assert values.beside.shape == (4, 0)
    assert values.constancy.shape == (0,)
