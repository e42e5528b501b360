# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cameras: the two models of the interior orientation, projection and rays."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.camera import Camera, OpenCVInterior, PhotogrammetricInterior

WIDTH, HEIGHT = 1280, 960


def whole_sensor(interior, columns=17, rows=13):
    u, v = np.meshgrid(np.linspace(0, interior.width - 1, columns), np.linspace(0, interior.height - 1, rows))
    return np.column_stack([u.ravel(), v.ravel()])


def opencv(distortion, focal=1500.0):
    return OpenCVInterior(WIDTH, HEIGHT, focal, focal * 1.01, 655.0, 470.0, tuple(distortion))


def photogrammetric(**terms):
    return PhotogrammetricInterior(2592, 1944, 0.004, 26.0, (-0.05, 0.03), r0=4.0, **terms)


def oriented(interior, rotation=None, centre=(100.0, -200.0, 300.0)):
    return Camera("test", interior, np.eye(3) if rotation is None else rotation, np.array(centre))


STRONG = opencv((-0.3, 0.12, 1e-3, -8e-4, -0.02))

opencv_interiors = st.builds(
    lambda k1, k2, p1, p2, focal: opencv((k1, k2, p1, p2), focal),
    st.floats(-0.3, 0.3),
    st.floats(-0.05, 0.1),
    st.floats(-2e-3, 2e-3),
    st.floats(-2e-3, 2e-3),
    st.floats(1400, 4000),
)
photogrammetric_interiors = st.builds(
    lambda a1, a2, b1, b2, c1, c2: photogrammetric(A1=a1, A2=a2, B1=b1, B2=b2, C1=c1, C2=c2),
    st.floats(-1.5e-3, 1.5e-3),
    st.floats(-2e-6, 2e-6),
    st.floats(-1e-4, 1e-4),
    st.floats(-1e-4, 1e-4),
    st.floats(-1e-3, 1e-3),
    st.floats(-1e-3, 1e-3),
)
angles = st.floats(-np.pi, np.pi)
rotations = st.tuples(angles, angles, angles).map(lambda a: Rotation.from_euler("xyz", a).as_matrix())


# ---------------------------------------------------------------- pixel -> ray -> pixel


@given(opencv_interiors | photogrammetric_interiors, rotations, st.floats(10, 1e5))
def test_ray_of_a_pixel_projects_onto_it_over_the_whole_sensor(interior, rotation, distance):
    camera = oriented(interior, rotation)
    pixels = whole_sensor(interior)
    again = camera.project(camera.projection_centre + distance * camera.rays(pixels))
    assert np.abs(again - pixels).max() < 1e-6


@pytest.mark.parametrize("interior", [opencv((-0.3, 0, 0, 0)), STRONG, photogrammetric(A1=1.5e-3), photogrammetric(A1=-1.8e-4, A2=2.6e-7)])
def test_strong_distortion_is_inverted_on_every_tenth_pixel(interior):
    pixels = whole_sensor(interior, interior.width // 10, interior.height // 10)
    assert np.abs(interior.pixels(interior.ideal(pixels)) - pixels).max() < 1e-6


@given(st.floats(0, 2591), st.floats(0, 1943))
def test_photogrammetric_rays_follow_the_written_formula(u, v):
    interior = photogrammetric(A1=-1.8e-4, A2=2.6e-7, B1=-1.5e-5, B2=1.3e-5, C1=-8e-6, C2=2.7e-5)
    x, y = (u - 2591 / 2) * 0.004 + 0.05, (v - 1943 / 2) * 0.004 - 0.03
    r2 = x * x + y * y
    radial = -1.8e-4 * (r2 - 4.0**2) + 2.6e-7 * (r2**2 - 4.0**4)
    dx = x * radial - 1.5e-5 * (r2 + 2 * x * x) + 2 * 1.3e-5 * x * y - 8e-6 * x + 2.7e-5 * y
    dy = y * radial + 1.3e-5 * (r2 + 2 * y * y) - 2 * 1.5e-5 * x * y
    assert interior.ideal(np.array([[u, v]]))[0] == pytest.approx([(x - dx) / 26.0, (y - dy) / 26.0], abs=1e-12)


def test_rays_are_unit_vectors_in_front_of_the_camera():
    rotation = Rotation.from_euler("xyz", [0.3, -0.4, 2.0]).as_matrix()
    rays = oriented(STRONG, rotation).rays(whole_sensor(STRONG))
    assert np.linalg.norm(rays, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert (rays @ rotation[2]).min() > 0


# ---------------------------------------------------------------- OpenCV's own projection

COEFFICIENTS = {
    0: (),
    4: (-0.28, 0.11, 1e-3, -7e-4),
    5: (-0.28, 0.11, 1e-3, -7e-4, -0.03),
    8: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01),
    12: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01, 2e-3, -1e-3, -1.5e-3, 8e-4),
    14: (0.2, 0.05, 1e-3, -7e-4, 0.01, 0.45, 0.02, 0.01, 2e-3, -1e-3, -1.5e-3, 8e-4, 0.03, -0.05),
}


@pytest.mark.parametrize("distortion", COEFFICIENTS.values(), ids=[f"{n} coefficients" for n in COEFFICIENTS])
def test_projection_is_opencvs(distortion):
    interior = opencv(distortion)
    rotation = Rotation.from_euler("xyz", [0.2, -0.3, 0.5]).as_matrix()
    camera = oriented(interior, rotation)
    random = np.random.default_rng(1)
    depth = random.uniform(500, 9000, 400)
    local = np.column_stack([random.uniform(-0.4, 0.4, 400) * depth, random.uniform(-0.3, 0.3, 400) * depth, depth])
    points = local @ rotation + camera.projection_centre
    matrix = np.array([[interior.fx, 0, interior.cx], [0, interior.fy, interior.cy], [0, 0, 1]])
    translation = -rotation @ camera.projection_centre
    expected, jacobian = cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], translation, matrix, np.array(distortion) if distortion else None)
    pixels, derivative = camera.project_with_derivative(points)
    assert np.isfinite(pixels).all()
    assert np.abs(pixels - expected[:, 0]).max() < 1e-7
    # OpenCV differentiates by the translation t of x = R p + t, so d pixel / d p is that times R
    by_translation = jacobian[:, 3:6].reshape(-1, 2, 3)
    assert np.abs(derivative - by_translation @ rotation).max() < 1e-8


# ---------------------------------------------------------------- derivative


@given(opencv_interiors | photogrammetric_interiors, rotations)
def test_derivative_agrees_with_central_differences(interior, rotation):
    camera = oriented(interior, rotation)
    points = camera.projection_centre + 3000 * camera.rays(whole_sensor(interior, 5, 4))
    _, derivative = camera.project_with_derivative(points)
    step = 0.01
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        numeric = (camera.project(points + shift) - camera.project(points - shift)) / (2 * step)
        assert np.abs(derivative[:, :, axis] - numeric).max() < 1e-6


@pytest.mark.parametrize("distortion", COEFFICIENTS.values(), ids=[f"{n} coefficients" for n in COEFFICIENTS])
def test_derivative_of_every_model_of_opencv_agrees_with_central_differences(distortion):
    interior = opencv(distortion)
    ideal = interior.ideal(whole_sensor(interior, 7, 5))
    derivative = interior.pixel_derivative(ideal, interior.pixels(ideal))
    step = 1e-6
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        numeric = (interior.pixels(ideal + shift) - interior.pixels(ideal - shift)) / (2 * step)
        assert np.abs(derivative[:, :, axis] - numeric).max() < 1e-4 * interior.fx * 1e-2


@pytest.mark.parametrize("interior", [opencv(()), STRONG, photogrammetric()])
def test_scale_on_the_axis_is_the_principal_distance_in_pixels(interior):
    expected = np.sqrt(interior.fx * interior.fy) if isinstance(interior, OpenCVInterior) else 26.0 / 0.004
    assert interior.pixels_per_radian == pytest.approx(expected, rel=2e-3)


# ---------------------------------------------------------------- what is not projected


@given(opencv_interiors | photogrammetric_interiors, rotations, st.floats(0, 1e4))
def test_points_behind_the_camera_are_nan(interior, rotation, distance):
    camera = oriented(interior, rotation)
    behind = camera.projection_centre - distance * camera.rays(whole_sensor(interior, 4, 3))
    assert np.isnan(camera.project(behind)).all()


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
