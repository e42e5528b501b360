# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cameras: projection, rays and the derivatives of both; what is not projected."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lenses import COEFFICIENTS, RIG, STRONG, interiors, opencv, photogrammetric, whole_sensor
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.camera import Camera

angles = st.floats(-np.pi, np.pi)
rotations = st.tuples(angles, angles, angles).map(lambda a: Rotation.from_euler("xyz", a).as_matrix())
models = pytest.mark.parametrize("distortion", COEFFICIENTS.values(), ids=[f"{n} coefficients" for n in COEFFICIENTS])


def oriented(interior, rotation=None, centre=(100.0, -200.0, 300.0)):
    return Camera("test", interior, np.eye(3) if rotation is None else rotation, np.array(centre))


def differences(function, count, steps):
    """Return the central differences (..., count) of function(shift) by each entry of a shift (count,) from zero."""
    columns = []
    for index in range(count):
        shift = np.zeros(count)
        shift[index] = steps[index]
        columns.append((function(shift) - function(-shift)) / (2 * steps[index]))
    return np.stack(columns, axis=-1)


# of the interior parameters: those to high powers of mm need small steps
def interior_steps(interior):
    return [{"A1": 1e-7, "A2": 1e-9, "r0": 1e-4}.get(name, 1e-5) for name in interior.parameter_names]


def with_interior_shifted(camera, shift):
    return replace(camera, interior=camera.interior.with_parameters(camera.interior.parameters + shift))


EXTERIOR_STEPS = [0.01] * 3 + [1e-5] * 3  # mm, radians


def assert_close(derivative, numeric, relative, absolute):
    """Compare derivatives (n, i, p) parameter by parameter: their units differ."""
    scale = np.abs(numeric).max(axis=(0, 1))
    assert derivative.shape == numeric.shape
    assert np.all(np.abs(derivative - numeric).max(axis=(0, 1)) < relative * scale + absolute)


# ---------------------------------------------------------------- pixel -> ray -> pixel


@given(interiors, rotations, st.floats(10, 1e5))
def test_ray_of_a_pixel_projects_onto_it_over_the_whole_sensor(interior, rotation, distance):
    camera = oriented(interior, rotation)
    pixels = whole_sensor(interior)
    again = camera.project(camera.projection_centre + distance * camera.rays(pixels))
    assert np.abs(again - pixels).max() < 1e-6


def test_rays_are_unit_vectors_in_front_of_the_camera():
    rotation = Rotation.from_euler("xyz", [0.3, -0.4, 2.0]).as_matrix()
    rays = oriented(STRONG, rotation).rays(whole_sensor(STRONG))
    assert np.linalg.norm(rays, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert (rays @ rotation[2]).min() > 0


def test_ray_of_one_pixel_may_be_asked_for_without_a_list():
    camera = oriented(STRONG)
    assert np.array_equal(camera.rays(np.array([3.0, 4.0])), camera.rays(np.array([[3.0, 4.0]])))
    assert camera.rays_with_derivatives(np.array([3.0, 4.0])).by_pixel.shape == (1, 3, 2)


# ---------------------------------------------------------------- OpenCV's own projection


def points_and_opencv(interior, distortion):
    """Return an oriented camera, points (400, 3) before it, OpenCV's pixels and its derivatives (400, 2, k)."""
    rotation = Rotation.from_euler("xyz", [0.2, -0.3, 0.5]).as_matrix()
    camera = oriented(interior, rotation)
    random = np.random.default_rng(1)
    depth = random.uniform(500, 9000, 400)
    local = np.column_stack([random.uniform(-0.4, 0.4, 400) * depth, random.uniform(-0.3, 0.3, 400) * depth, depth])
    points = local @ rotation + camera.projection_centre
    matrix = np.array([[interior.fx, 0, interior.cx], [0, interior.fy, interior.cy], [0, 0, 1]])
    translation = -rotation @ camera.projection_centre
    pixels, jacobian = cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], translation, matrix, np.array(distortion) if distortion else None)
    return camera, points, pixels[:, 0], jacobian.reshape(400, 2, -1)


@models
def test_projection_is_opencvs(distortion):
    camera, points, expected, jacobian = points_and_opencv(opencv(distortion), distortion)
    pixels, derivative = camera.project_with_derivative(points)
    assert np.isfinite(pixels).all()
    assert np.abs(pixels - expected).max() < 1e-7
    # OpenCV differentiates by the translation t of x = R p + t, so d pixel / d p is that times R
    assert np.abs(derivative - jacobian[:, :, 3:6] @ camera.rotation).max() < 1e-8


@models
def test_derivatives_of_the_projection_are_opencvs(distortion):
    camera, points, expected, jacobian = points_and_opencv(opencv(distortion), distortion)
    projection = camera.project_with_derivatives(points)
    assert np.abs(projection.pixels - expected).max() < 1e-7
    by_translation = jacobian[:, :, 3:6]
    assert np.abs(projection.by_point - by_translation @ camera.rotation).max() < 1e-8
    # t = -R centre
    assert np.abs(projection.by_exterior[:, :, :3] + by_translation @ camera.rotation).max() < 1e-8
    interior = 4 + max(len(distortion), 4)
    assert np.abs(projection.by_interior[:, :, :interior] - jacobian[:, :, 6 : 6 + interior]).max() < 1e-8
    # OpenCV's rotation vector is the whole one with the translation held: x = exp([v + dv]x) p + t. Our small one
    # turns R (p - centre), which is R p + t; the part of it that OpenCV's leaves in the translation is w x t.
    vector, centre = Rotation.from_matrix(camera.rotation).as_rotvec(), camera.projection_centre
    step = 1e-6
    small = [Rotation.from_rotvec(vector + step * axis) * Rotation.from_rotvec(vector - step * axis).inv() for axis in np.eye(3)]
    small_by_vector = np.stack([turn.as_rotvec() for turn in small], axis=1) / (2 * step)
    translation = -camera.rotation @ centre
    translation_by_small = np.cross(np.eye(3), translation).T
    ours = (projection.by_exterior[:, :, 3:] - by_translation @ translation_by_small) @ small_by_vector
    assert np.abs(ours - jacobian[:, :, :3]).max() < 1e-5  # px / rad, of some 10^3


# ---------------------------------------------------------------- derivatives


@given(interiors, rotations)
@settings(max_examples=20)
def test_derivatives_of_the_projection_agree_with_central_differences(interior, rotation):
    camera = oriented(interior, rotation)
    points = camera.projection_centre + 3000 * camera.rays(whole_sensor(interior, 4, 3))
    projection = camera.project_with_derivatives(points)
    assert np.array_equal(projection.pixels, camera.project(points))
    assert_close(projection.by_point, differences(lambda shift: camera.project(points + shift), 3, [0.01] * 3), 1e-6, 1e-6)
    assert_close(projection.by_exterior, differences(lambda shift: camera.moved(shift).project(points), 6, EXTERIOR_STEPS), 1e-6, 1e-6)
    numeric = differences(lambda shift: with_interior_shifted(camera, shift).project(points), len(interior.parameters), interior_steps(interior))
    assert_close(projection.by_interior, numeric, 1e-5, 1e-4)


@given(interiors, rotations)
@settings(max_examples=20)
def test_derivatives_of_the_rays_agree_with_central_differences(interior, rotation):
    camera = oriented(interior, rotation)
    pixels = whole_sensor(interior, 4, 3)
    rays = camera.rays_with_derivatives(pixels)
    assert np.array_equal(rays.directions, camera.rays(pixels))
    assert_close(rays.by_pixel, differences(lambda shift: camera.rays(pixels + shift), 2, [1e-2] * 2), 1e-6, 1e-11)
    assert_close(rays.by_exterior, differences(lambda shift: camera.moved(shift).rays(pixels), 6, EXTERIOR_STEPS), 1e-6, 1e-9)
    numeric = differences(lambda shift: with_interior_shifted(camera, shift).rays(pixels), len(interior.parameters), interior_steps(interior))
    assert_close(rays.by_interior, numeric, 1e-5, 1e-8)


@given(interiors, rotations)
def test_quick_derivative_is_the_full_ones(interior, rotation):
    camera = oriented(interior, rotation)
    points = camera.projection_centre + 3000 * camera.rays(whole_sensor(interior, 4, 3))
    pixels, derivative = camera.project_with_derivative(points)
    projection = camera.project_with_derivatives(points)
    assert np.array_equal(pixels, projection.pixels)
    assert np.array_equal(derivative, projection.by_point)


def test_camera_moves_its_centre_in_the_station_and_turns_in_its_own_frame():
    rotation = Rotation.from_euler("xyz", [0.2, -0.3, 0.5]).as_matrix()
    camera = oriented(STRONG, rotation)
    moved = camera.moved([1, 2, 3, 0, 0, np.pi / 2])
    assert moved.projection_centre == pytest.approx([101, -198, 303])
    # a quarter turn about the viewing direction: what was on its x axis is on its y axis
    assert moved.rotation @ rotation.T @ [1, 0, 0] == pytest.approx([0, 1, 0])
    assert moved.rotation[2] == pytest.approx(rotation[2])
    assert (moved.name, moved.interior) == (camera.name, camera.interior)
    assert np.array_equal(camera.moved(np.zeros(6)).rotation, rotation)


# ---------------------------------------------------------------- what is not projected


@given(interiors, rotations, st.floats(0, 1e4))
def test_points_behind_the_camera_are_nan(interior, rotation, distance):
    camera = oriented(interior, rotation)
    behind = camera.projection_centre - distance * camera.rays(whole_sensor(interior, 4, 3))
    assert np.isnan(camera.project(behind)).all()


@pytest.mark.parametrize("interior", [opencv(()), STRONG, opencv(COEFFICIENTS[14]), photogrammetric(**RIG)])
def test_rows_outside_the_field_are_nan_in_every_derivative(interior):
    camera = oriented(interior, centre=(0, 0, 0))
    points = np.array([[10.0, 20.0, 3000.0], [0, 0, -1000.0], [1e5, 0, 1000.0], [0, 0, 0], [1e9, 1e300, 1e-9]])
    projection = camera.project_with_derivatives(points)
    for values in (projection.pixels, projection.by_point, projection.by_exterior, projection.by_interior):
        assert np.isfinite(values[0]).all()
        assert np.isnan(values[1:]).all()


def test_pixels_without_a_ray_have_none_among_the_others():
    interior = opencv((-0.3, 0, 0, 0), focal=900.0)  # its corners are behind the fold
    rays = oriented(interior).rays_with_derivatives(np.array([[0.0, 0.0], [640.0, 480.0]]))
    assert np.isfinite(rays.directions).all(axis=1).tolist() == [False, True]
    assert np.isnan(rays.by_pixel[0]).all()
    assert np.isnan(rays.by_interior[0]).all()
    assert np.isfinite(rays.by_exterior[1]).all()
    assert np.isfinite(rays.by_interior[1]).all()


def test_points_that_the_polynomial_folds_back_into_the_image_are_nan():
    interior = opencv((-0.3, 0, 0, 0))
    ideal = np.column_stack([np.linspace(1.6, 1.85, 20), np.zeros(20)])  # 58 to 62 deg off the axis, seen by no such lens
    points = np.column_stack([ideal, np.ones(20)]) * 3000
    matrix = np.array([[interior.fx, 0, interior.cx], [0, interior.fy, interior.cy], [0, 0, 1]])
    folded = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, np.array([-0.3, 0, 0, 0]))[0][:, 0]
    camera = oriented(interior, centre=(0, 0, 0))
    assert camera.sees(folded).any()  # the bare formula would show them
    assert np.isnan(camera.project(points)).all()


def test_points_far_outside_the_field_are_nan():
    for interior in (STRONG, photogrammetric(A1=-1.8e-4, A2=2.6e-7)):
        camera = oriented(interior, centre=(0, 0, 0))
        assert np.isnan(camera.project(np.array([[1e5, 0, 1000.0], [0, -1e5, 1000.0], [1e9, 1e9, 1.0]]))).all()


def test_points_just_outside_the_image_are_projected_but_not_seen():
    camera = oriented(STRONG, centre=(0, 0, 0))
    pixels = camera.project(1000 * camera.rays(np.array([[-20.0, 480.0], [640.0, 975.0]])))
    assert np.isfinite(pixels).all()
    assert not camera.sees(pixels).any()


def test_image_ends_at_the_centres_of_its_outermost_pixels():
    camera = oriented(opencv(()))
    pixels = np.array([[0.0, 0.0], [1279.0, 959.0], [1279.1, 0.0], [0.0, -0.1], [np.nan, 1.0], [9.0, 500.0]])
    assert camera.sees(pixels).tolist() == [True, True, False, False, False, True]
    assert camera.sees(pixels, margin=10).tolist() == [False] * 6
