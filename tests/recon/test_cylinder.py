# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders and how their edges look: every ray through a contour touches the cylinder."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.camera import Camera, OpenCVInterior, PhotogrammetricInterior
from pipeworkbench.recon.cylinder import Cylinder, Cylinders, contour, contours, edge_lines, perpendicular_axes, smooth_contours

INTERIORS = (
    OpenCVInterior(1280, 960, 1800.0, 1810.0, 650.0, 470.0, ()),
    OpenCVInterior(1280, 960, 1800.0, 1810.0, 650.0, 470.0, (-0.25, 0.08, 1e-3, -5e-4)),
    PhotogrammetricInterior(2592, 1944, 0.004, 26.0, (-0.05, 0.03), A1=-1.8e-4, A2=2.6e-7, B1=-1e-5, r0=4.0),
)
angles = st.floats(-np.pi, np.pi)
unit_vectors = st.tuples(angles, st.floats(-1, 1)).map(
    lambda a: np.array([np.cos(a[0]) * np.sqrt(1 - a[1] ** 2), np.sin(a[0]) * np.sqrt(1 - a[1] ** 2), a[1]])
)


@st.composite
def scenes(draw):
    """Give a camera anywhere, looking at a cylinder that is not seen end-on."""
    rotation = Rotation.from_euler("xyz", [draw(angles) for _ in range(3)]).as_matrix()
    centre = np.array([draw(st.floats(-5e3, 5e3)) for _ in range(3)])
    camera = Camera("any", draw(st.sampled_from(INTERIORS)), rotation, centre)
    depth = draw(st.floats(1500, 9000))
    point = centre + np.array([draw(st.floats(-0.15, 0.15)) * depth, draw(st.floats(-0.1, 0.1)) * depth, depth]) @ rotation
    direction = draw(unit_vectors)
    assume(abs(direction @ (point - centre)) < 0.9 * np.linalg.norm(point - centre))
    return camera, Cylinder(point, direction, draw(st.floats(0.003, 0.1)) * depth)


def sampled(camera, cylinder):
    along = np.linspace(-3, 3, 13) * cylinder.radius
    return along, contour(camera, cylinder, along)


@given(scenes())
def test_rays_through_the_contour_touch_the_cylinder(scene):
    camera, cylinder = scene
    _, seen = sampled(camera, cylinder)
    pixels = seen.position.reshape(-1, 2)
    pixels = pixels[np.isfinite(pixels[:, 0])]
    assume(len(pixels))
    across = np.cross(camera.rays(pixels), cylinder.direction)
    offset = cylinder.point - camera.projection_centre
    distance = np.abs(across @ offset) / np.linalg.norm(across, axis=1)
    assert distance == pytest.approx(cylinder.radius, abs=1e-6 * cylinder.radius + 1e-6)


@given(scenes())
def test_normals_are_unit_and_point_away_from_the_axis(scene):
    camera, cylinder = scene
    along, seen = sampled(camera, cylinder)
    axis = camera.project(cylinder.point + along[:, None] * cylinder.direction)
    known = np.isfinite(seen.position[0, :, :, 0]) & np.isfinite(axis[:, 0])
    assume(known.any())
    away = np.einsum("sni,sni->sn", seen.position[0] - axis, seen.normal[0])
    assert (away[known] > 0).all()
    assert np.linalg.norm(seen.normal[0][known], axis=1) == pytest.approx(1.0, abs=1e-9)


@given(scenes())
def test_both_sides_lie_on_opposite_sides_of_the_axis(scene):
    camera, cylinder = scene
    _, seen = sampled(camera, cylinder)
    known = np.isfinite(seen.position[0, :, :, 0]).all(axis=0)
    assume(known.any())
    assert (np.einsum("ni,ni->n", *seen.normal[0][:, known]) < 0).all()


@given(scenes())
def test_gain_is_what_a_point_moves_in_the_image_when_the_surface_moves_outward(scene):
    camera, cylinder = scene
    along, seen = sampled(camera, cylinder)
    lines, outward = edge_lines(cylinder.as_many(), camera.projection_centre)
    assert np.array_equal(outward, seen.outward)
    step = 1e-4 * cylinder.radius
    for side in (0, 1):
        points = lines[0, side] + along[:, None] * cylinder.direction
        moved = (camera.project(points + step * outward[0, side]) - camera.project(points - step * outward[0, side])) / (2 * step)
        known = np.isfinite(seen.position[0, side, :, 0])
        numeric = np.einsum("ni,ni->n", moved, seen.normal[0, side])
        assert seen.gain[0, side][known] == pytest.approx(numeric[known], rel=1e-5, abs=1e-7)
        assert (seen.gain[0, side][known] > 0).all()


@given(scenes())
def test_growing_the_radius_moves_the_contour_by_the_gain(scene):
    camera, cylinder = scene
    along, seen = sampled(camera, cylinder)
    step = 1e-4 * cylinder.radius
    grown = contour(camera, Cylinder(cylinder.point, cylinder.direction, cylinder.radius + step), along)
    shift = np.einsum("sni,sni->sn", grown.position[0] - seen.position[0], seen.normal[0]) / step
    known = np.isfinite(shift)
    assert shift[known] == pytest.approx(seen.gain[0][known], rel=2e-3)


@given(scenes())
def test_edge_lines_lie_on_the_surface_and_face_the_camera_edge_on(scene):
    camera, cylinder = scene
    lines, outward = edge_lines(cylinder.as_many(), camera.projection_centre)
    assert lines[0] == pytest.approx(cylinder.point + cylinder.radius * outward[0], abs=1e-9)
    assert outward[0] @ cylinder.direction == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(outward[0], axis=1) == pytest.approx(1.0)
    view = lines[0] - camera.projection_centre
    assert np.einsum("si,si->s", view, outward[0]) / np.linalg.norm(view, axis=1) == pytest.approx(0.0, abs=1e-9)


@given(unit_vectors)
def test_perpendicular_axes_form_a_right_handed_frame(direction):
    first, second = perpendicular_axes(direction)
    frame = np.array([first, second, direction])
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(frame) == pytest.approx(1.0)


@given(scenes(), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_nearest_point_to_a_ray_is_perpendicular_to_ray_and_axis(scene, a, b):
    camera, cylinder = scene
    ray = np.array([a, b, 1.0]) @ camera.rotation
    ray /= np.linalg.norm(ray)
    assume(abs(ray @ cylinder.direction) < 0.95)
    (along,) = cylinder.as_many().nearest_to_ray(camera.projection_centre, ray)
    gap = cylinder.at(along) - camera.projection_centre
    gap -= (gap @ ray) * ray
    assert gap @ cylinder.direction == pytest.approx(0.0, abs=1e-6)


def test_camera_inside_the_cylinder_sees_no_contour():
    camera = Camera("inside", INTERIORS[0], np.eye(3), np.zeros(3))
    seen = contour(camera, Cylinder(np.array([0.0, 10.0, 3000.0]), np.array([0.0, 0.0, 1.0]), 50.0), np.linspace(-100, 100, 9))
    assert np.isnan(seen.position).all()


def test_cylinder_behind_the_camera_has_no_contour():
    camera = Camera("turned", INTERIORS[0], np.eye(3), np.zeros(3))
    seen = contour(camera, Cylinder(np.array([0.0, 0.0, -3000.0]), np.array([1.0, 0.0, 0.0]), 50.0), np.linspace(-100, 100, 9))
    assert np.isnan(seen.position).all()


def test_many_cylinders_look_like_each_by_itself():
    camera = Camera("any", INTERIORS[1], np.eye(3), np.zeros(3))
    random = np.random.default_rng(2)
    directions = random.normal(size=(5, 3)) * [1, 1, 0.3]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    many = Cylinders(random.normal([0, 0, 3000], 200, (5, 3)), directions, random.uniform(10, 80, 5))
    along = np.tile(np.linspace(-200, 200, 7), (5, 1))
    together = contours(camera, many, along)
    for row in range(5):
        alone = contour(camera, many.one(row), along[row])
        for name in ("position", "normal", "gain", "outward"):
            assert getattr(alone, name)[0] == pytest.approx(getattr(together, name)[row], nan_ok=True, abs=1e-9)
    assert len(many[np.array([True, False, True, False, False])]) == 2


@given(scenes())
def test_contours_through_few_nodes_are_those_of_all_samples(scene):
    camera, cylinder = scene
    # as long in the image as what is clicked, a few hundred pixels
    half = min(3 * cylinder.radius, 0.1 * float(np.linalg.norm(cylinder.point - camera.projection_centre)))
    fractions = np.linspace(0, 1, 21)
    smooth = smooth_contours(camera, cylinder.as_many(), np.array([[-half, half]]), fractions)
    exact = contour(camera, cylinder, half * (2 * fractions - 1))
    known = np.isfinite(smooth.position[..., 0]) & np.isfinite(exact.position[..., 0])
    assume(known.any())
    across = np.einsum("ksni,ksni->ksn", smooth.position - exact.position, exact.normal)
    assert np.abs(across[known]).max() < 0.01
    assert smooth.normal[known] == pytest.approx(exact.normal[known], abs=1e-3)
    assert smooth.gain[known] == pytest.approx(exact.gain[known], rel=1e-2)


def test_contours_that_leave_the_field_are_followed_to_the_border():
    camera = Camera("level", INTERIORS[1], np.eye(3), np.zeros(3))
    cylinder = Cylinder(np.array([0.0, 0.0, 3000.0]), np.array([1.0, 0.0, 0.0]), 50.0)
    fractions = np.linspace(0, 1, 80)
    smooth = smooth_contours(camera, cylinder.as_many(), np.array([[0.0, 4000.0]]), fractions)
    exact = contour(camera, cylinder, 4000.0 * fractions)
    assert np.array_equal(smooth.position, exact.position, equal_nan=True)
    assert 0.1 < np.isfinite(smooth.position[..., 0]).mean() < 0.5
