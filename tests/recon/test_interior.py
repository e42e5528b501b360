# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interior orientations: both models there and back, their formulas and their derivatives."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lenses import (
    COEFFICIENTS,
    HEIGHT,
    RIG,
    STRONG,
    WIDTH,
    every_tenth_pixel,
    interiors,
    opencv,
    photogrammetric,
    whole_sensor,
)

from pipeworkbench.recon.interior import OpenCVInterior, PhotogrammetricInterior

STEPS = {"A1": 1e-7, "A2": 1e-9, "r0": 1e-4}  # of central differences by a parameter; these act on mm to the third and fifth power


def matrix_of(interior):
    return np.array([[interior.fx, 0, interior.cx], [0, interior.fy, interior.cy], [0, 0, 1]])


def by_parameters(interior, function):
    """Differentiate function(interior) numerically by every parameter, in the order of the names."""
    columns = []
    for index, name in enumerate(interior.parameter_names):
        step = STEPS.get(name, 1e-5)
        more, less = interior.parameters, interior.parameters
        more[index] += step
        less[index] -= step
        columns.append((function(interior.with_parameters(more)) - function(interior.with_parameters(less))) / (2 * step))
    return np.stack(columns, axis=-1)


def wide(focal, distortion):
    """Return a 5-megapixel camera whose focal length is this fraction of its width."""
    return OpenCVInterior(2592, 1944, focal * 2592, focal * 2592, 1304.0, 960.0, distortion)


# ---------------------------------------------------------------- pixel -> ray -> pixel

WIDE = {
    "k1 -0.3, narrow": wide(1.5, (-0.3, 0, 0, 0)),
    "k1 -0.3, up to just before the fold": wide(0.9, (-0.3, 0, 0, 0)),
    "k1 -0.3, 77 deg": wide(0.8, (-0.3, 0.1, 0, 0)),
    "k1 -0.3, decentred, 90 deg": wide(0.7, (-0.3, 0.1, 1e-3, -1e-3, -0.005)),
    "k1 -0.3, 100 deg": wide(0.5, (-0.3, 0.1, 0, 0)),
    "pincushion": wide(0.5, (1.0, 1.0, 0, 0)),
    "rational, prism and tilt": wide(0.8, COEFFICIENTS[14]),
    "strongly tilted": wide(0.8, (-0.3, 0.1, 1e-3, -7e-4, 0, 0.05, 0.02, 0.01, 2e-3, -1e-3, -1.5e-3, 8e-4, 0.2, -0.15)),
    "the paper's size": photogrammetric(**RIG),
    "photogrammetric, wide": photogrammetric(8.0, A1=1.5e-3),
    "photogrammetric, barrel": photogrammetric(8.0, A1=-6e-3),
    "photogrammetric, almost folding": photogrammetric(8.0, A1=8e-3),
}


@pytest.mark.parametrize("interior", WIDE.values(), ids=WIDE)
def test_every_tenth_pixel_comes_back_from_its_ray(interior):
    pixels = every_tenth_pixel(interior)
    assert np.abs(interior.pixels(interior.ideal(pixels)) - pixels).max() < 1e-6


@given(interiors)
def test_pixels_come_back_from_their_rays(interior):
    pixels = whole_sensor(interior)
    assert np.abs(interior.pixels(interior.ideal(pixels)) - pixels).max() < 1e-6


@pytest.mark.parametrize(("k2", "fold"), [(0.0, np.sqrt(1 / 0.9)), (0.02, np.sqrt((0.9 - np.sqrt(0.81 - 0.4)) / 0.2))])
def test_pixels_that_no_ray_reaches_have_none_and_the_others_have_the_ray_before_the_fold(k2, fold):
    # r (1 + k1 r2 + k2 r4) rises up to 1 + 3 k1 r2 + 5 k2 r4 = 0; with k2 it falls from there and rises once more
    interior = wide(0.7, (-0.3, k2, 0, 0))
    pixels = every_tenth_pixel(interior)
    distorted = np.linalg.norm((pixels - (interior.cx, interior.cy)) / interior.fx, axis=1)
    reach = fold * (1 - 0.3 * fold**2 + k2 * fold**4)
    assert 0.05 < np.mean(distorted > reach) < 0.5  # of the picture: its corners
    ideal = interior.ideal(pixels)
    near = np.abs(distorted - reach) < 1e-9
    assert np.array_equal(np.isfinite(ideal).all(axis=1)[~near], (distorted < reach)[~near])
    assert np.nanmax(np.linalg.norm(ideal, axis=1)) < fold + 1e-9
    again = interior.pixels(ideal)
    assert np.abs(again - pixels)[distorted < reach - 1e-9].max() < 1e-6


def test_lens_whose_whole_border_is_behind_the_fold_still_projects_its_middle():
    interior = wide(0.3, (-0.3, 0, 0, 0))
    pixels = np.array([[1304.0, 960.0], [1500.0, 800.0]])
    assert np.isnan(interior.ideal(interior.border(5))).all()
    assert np.abs(interior.pixels(interior.ideal(pixels)) - pixels).max() < 1e-6


def test_lens_that_turns_its_image_inside_out_projects_nothing():
    assert np.isnan(photogrammetric(C1=3.0, C2=0.5).pixels(np.array([[0.01, 0.02]]))).all()
    assert np.isnan(photogrammetric(A1=0.1).pixels(np.array([[0.2, 0.1]]))).all()


def test_pixels_that_are_not_numbers_have_no_ray_and_do_no_harm():
    pixels = np.array([[10.0, 20.0], [np.nan, 5.0], [np.inf, 5.0], [600.0, 400.0]])
    for interior in (STRONG, photogrammetric(**RIG)):
        ideal = interior.ideal(pixels[[0, 3]])
        with np.errstate(invalid="ignore"):
            assert np.array_equal(interior.ideal(pixels)[[0, 3]], ideal)
        rows = np.array([ideal[0], [np.nan, 0.1], [1e300, 0.0], ideal[1]])
        projected = interior.pixels(rows)
        assert np.isnan(projected[[1, 2]]).all()
        assert np.abs(projected[[0, 3]] - pixels[[0, 3]]).max() < 1e-6


# ---------------------------------------------------------------- formulas


@given(st.floats(0, 2591), st.floats(0, 1943))
def test_photogrammetric_rays_follow_the_written_formula(u, v):
    interior = photogrammetric(**RIG)
    x, y = (u - 2591 / 2) * 0.004 + 0.05, (v - 1943 / 2) * 0.004 - 0.03
    r2 = x * x + y * y
    radial = -1.8e-4 * (r2 - 4.0**2) + 2.6e-7 * (r2**2 - 4.0**4)
    dx = x * radial - 1.5e-5 * (r2 + 2 * x * x) + 2 * 1.3e-5 * x * y - 8e-6 * x + 2.7e-5 * y
    dy = y * radial + 1.3e-5 * (r2 + 2 * y * y) - 2 * 1.5e-5 * x * y
    assert interior.ideal(np.array([[u, v]]))[0] == pytest.approx([(x - dx) / 26.0, (y - dy) / 26.0], abs=1e-12)


@pytest.mark.parametrize("distortion", COEFFICIENTS.values(), ids=[f"{n} coefficients" for n in COEFFICIENTS])
def test_rays_are_opencvs(distortion):
    interior = opencv(distortion)
    pixels = whole_sensor(interior)
    criteria = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 500, 1e-14)
    coefficients = np.array(distortion) if distortion else None
    expected = cv2.undistortPointsIter(pixels[:, None], matrix_of(interior), coefficients, None, None, criteria)[:, 0]
    assert np.abs(interior.ideal(pixels) - expected).max() < 1e-8


@pytest.mark.parametrize("interior", [opencv(()), STRONG, photogrammetric()])
def test_scale_on_the_axis_is_the_principal_distance_in_pixels(interior):
    expected = np.sqrt(interior.fx * interior.fy) if isinstance(interior, OpenCVInterior) else 26.0 / 0.004
    assert interior.pixels_per_radian == pytest.approx(expected, rel=2e-3)


# ---------------------------------------------------------------- parameters


def test_parameters_are_named_in_the_order_of_their_values():
    interior = photogrammetric(**RIG)
    values = dict(zip(interior.parameter_names, interior.parameters, strict=True))
    assert values == {"principal_distance": 26.0, "x0": -0.05, "y0": 0.03, **RIG, "r0": 4.0}
    interior = opencv(COEFFICIENTS[14])
    values = dict(zip(interior.parameter_names, interior.parameters, strict=True))
    assert list(values)[:9] == ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"]
    assert [values[name] for name in ("fx", "cy", "p2", "k3", "s1", "tau_x", "tau_y")] == [1500.0, 470.0, -7e-4, 0.01, 2e-3, 0.03, -0.05]


@given(interiors)
def test_interior_with_its_own_parameters_is_the_same(interior):
    same = interior.with_parameters(interior.parameters)
    assert type(same) is type(interior)
    assert np.array_equal(same.parameters, interior.parameters)
    pixels = whole_sensor(interior, 3, 3)
    assert np.array_equal(same.ideal(pixels), interior.ideal(pixels))
    assert (same.width, same.height) == (interior.width, interior.height)


def test_new_parameters_arrive_where_their_names_say():
    changed = photogrammetric().with_parameters([25.0, 0.1, 0.2, 1, 2, 3, 4, 5, 6, 7])
    assert isinstance(changed, PhotogrammetricInterior)
    assert (changed.principal_distance, changed.principal_point, changed.A2, changed.C1, changed.r0) == (25.0, (0.1, 0.2), 2, 5, 7)
    assert changed.pixel_pitch == 0.004
    changed = STRONG.with_parameters(np.arange(18.0))
    assert (changed.fx, changed.cy, changed.distortion) == (0.0, 3.0, tuple(range(4, 18)))


def test_number_of_distortion_terms_stays_where_it_is_enough():
    assert len(opencv(COEFFICIENTS[5]).with_parameters(opencv(COEFFICIENTS[4]).parameters).distortion) == 5
    assert opencv(COEFFICIENTS[4]).with_parameters(opencv(COEFFICIENTS[5]).parameters).distortion[:5] == COEFFICIENTS[5]


@pytest.mark.parametrize("interior", [STRONG, photogrammetric()])
@pytest.mark.parametrize("change", [-1, 1])
def test_wrong_number_of_parameters_is_refused(interior, change):
    with pytest.raises(ValueError, match="one number each"):
        interior.with_parameters(np.ones(len(interior.parameters) + change))


# ---------------------------------------------------------------- derivatives


@given(interiors)
@settings(max_examples=20)
def test_derivative_by_ideal_coordinates_agrees_with_central_differences(interior):
    ideal = interior.ideal(whole_sensor(interior, 7, 5))
    derivative = interior.pixel_derivative(ideal, interior.pixels(ideal))
    step = 1e-6
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        numeric = (interior.pixels(ideal + shift) - interior.pixels(ideal - shift)) / (2 * step)
        assert np.abs(derivative[:, :, axis] - numeric).max() < 1e-6 * interior.pixels_per_radian


@given(interiors)
@settings(max_examples=20)
def test_derivative_by_every_parameter_agrees_with_central_differences(interior):
    ideal = interior.ideal(whole_sensor(interior, 4, 3))
    derivative = interior.parameter_derivative(ideal, interior.pixels(ideal))
    numeric = by_parameters(interior, lambda changed: changed.pixels(ideal))
    assert derivative.shape == (12, 2, len(interior.parameter_names))
    scale = np.abs(numeric).max(axis=(0, 1))
    assert np.all(np.abs(derivative - numeric).max(axis=(0, 1)) < 1e-5 * scale + 1e-4)


@given(interiors)
@settings(max_examples=20)
def test_derivatives_of_ideal_coordinates_agree_with_central_differences(interior):
    pixels = whole_sensor(interior, 4, 3)
    by_pixels, derivative = interior.ideal_derivatives(interior.ideal(pixels), pixels)
    step = 1e-3
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        numeric = (interior.ideal(pixels + shift) - interior.ideal(pixels - shift)) / (2 * step)
        assert np.abs(by_pixels[:, :, axis] - numeric).max() * interior.pixels_per_radian < 1e-6
    numeric = by_parameters(interior, lambda changed: changed.ideal(pixels))
    scale = np.abs(numeric).max(axis=(0, 1))
    assert np.all(np.abs(derivative - numeric).max(axis=(0, 1)) < 1e-5 * scale + 1e-7)


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.1, 0.0), (-0.2, 0.3)])
def test_derivative_by_the_tilt_agrees_with_central_differences(tilt):
    interior = opencv((*COEFFICIENTS[12], *tilt))
    ideal = interior.ideal(whole_sensor(interior, 5, 4))
    derivative = interior.parameter_derivative(ideal, interior.pixels(ideal))[:, :, -2:]
    numeric = by_parameters(interior, lambda changed: changed.pixels(ideal))[:, :, -2:]
    assert np.abs(derivative).max() > 100  # px / rad: not the comparison of two zeros
    assert np.abs(derivative - numeric).max() < 1e-4


@pytest.mark.parametrize("distortion", COEFFICIENTS.values(), ids=[f"{n} coefficients" for n in COEFFICIENTS])
def test_derivative_by_every_parameter_is_opencvs(distortion):
    interior = opencv((*distortion, *np.zeros(14 - len(distortion))))
    ideal = interior.ideal(whole_sensor(interior))
    points = np.column_stack([ideal, np.ones(len(ideal))])
    _, jacobian = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix_of(interior), np.array(interior.distortion))
    expected = jacobian[:, 6:24].reshape(-1, 2, 18)
    derivative = interior.parameter_derivative(ideal, interior.pixels(ideal))
    assert np.abs(derivative - expected).max() < 1e-8


@given(interiors)
def test_derivatives_outside_the_field_are_nan(interior):
    ideal = np.array([[5.0, 0.0], [0.01, 0.02], [np.nan, np.nan]])
    pixels = interior.pixels(ideal)
    seen = np.isfinite(pixels).all(axis=1)
    assert seen.tolist() == [False, True, False]
    derivative = interior.parameter_derivative(ideal, pixels)
    assert np.isnan(derivative[~seen]).all()
    assert np.isfinite(derivative[seen]).all()


def test_border_runs_along_the_outer_edges_of_the_pixels():
    border = STRONG.border(5)
    assert border.shape == (20, 2)
    assert border.min(axis=0).tolist() == [-0.5, -0.5]
    assert border.max(axis=0).tolist() == [WIDTH - 0.5, HEIGHT - 0.5]
    on_edge = (border == -0.5) | (border == (WIDTH - 0.5, HEIGHT - 0.5))
    assert on_edge.any(axis=1).all()
