# SPDX-License-Identifier: LGPL-2.1-or-later
"""The adjustment of a cylinder against pictures whose geometry is known exactly."""

import numpy as np
import pytest
from synthetic import TARGET, pipe, views

from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.cylinder_adjustment import AdjustSettings, adjust_cylinder

PIPE = pipe()
RANDOM_ONLY = AdjustSettings(systematic=0.0)  # the pictures have noise, but no calibration error


@pytest.fixture(scope="module")
def seen():
    return views([PIPE])


def disturbed(truth, shift=(3.0, 4.0, 0.0), tilt=(0.004, -0.003, 0.0), radius=1.0):
    """Return starting values that are some pixels off."""
    direction = truth.direction + tilt
    return Cylinder(truth.cylinder.point + shift, direction / np.linalg.norm(direction), truth.diameter / 2 + radius)


def adjusted(seen, truth=PIPE, start=None, **more):
    part = 0.9 * truth.half_length
    return adjust_cylinder(seen, start or disturbed(truth), (-part, part), **more)


def angle_deg(one, other):
    return float(np.degrees(np.arcsin(np.linalg.norm(np.cross(one, other)))))


def assert_true(solution, truth):
    """The errors are small, and not many times what the adjustment says they are."""
    cylinder = solution.cylinder
    middle = truth.distance(cylinder.point[None])[0]
    assert middle < 0.5
    assert angle_deg(cylinder.direction, truth.direction) < 0.1
    assert abs(cylinder.radius - truth.diameter / 2) < 0.25
    assert middle < 5 * np.linalg.norm(solution.sigma_position)
    assert angle_deg(cylinder.direction, truth.direction) < 5 * np.degrees(solution.sigma_direction)
    assert abs(cylinder.radius - truth.diameter / 2) < 5 * solution.sigma_radius


@pytest.mark.parametrize("tilt_deg", [(10.0, 15.0), (80.0, 0.0), (45.0, -30.0), (0.0, 0.0)])
@pytest.mark.parametrize("diameter", [48.3, 114.3])
def test_position_direction_and_radius_are_recovered(tilt_deg, diameter):
    truth = pipe(diameter, tilt_deg)
    solution = adjusted(views([truth], seed=5), truth)
    assert_true(solution, truth)
    assert solution.converged


@pytest.mark.parametrize("tilt_deg", [(0.0, 0.0), (90.0, 0.0), (45.0, -30.0)])
def test_nearly_all_samples_of_a_clear_pipe_find_its_edges(tilt_deg):
    truth = pipe(114.3, tilt_deg)
    assert adjusted(views([truth], seed=5), truth).support > 0.95


def test_two_cameras_are_enough(seen):
    solution = adjusted(seen[:2])
    assert_true(solution, PIPE)


def test_common_errors_of_the_edges_make_the_sigmas_larger_not_the_result_another(seen):
    random, common = adjusted(seen, settings=RANDOM_ONLY), adjusted(seen, settings=AdjustSettings(systematic=0.2))
    assert common.cylinder.point == pytest.approx(random.cylinder.point)
    assert (np.linalg.eigvalsh(common.covariance - random.covariance) > -1e-12).all()
    # 0.2 px at the best possible: six edges of 0.43 px per mm fix the shift across the view
    assert np.linalg.norm(common.sigma_position) > 0.2 / 0.43 / np.sqrt(6)


def test_third_camera_makes_the_result_more_exact(seen):
    two, three = adjusted(seen[:2]), adjusted(seen)
    assert np.linalg.norm(three.sigma_position) < np.linalg.norm(two.sigma_position)


def test_sigmas_are_those_of_a_good_measurement(seen):
    solution = adjusted(seen, settings=RANDOM_ONLY)
    # edges of a tenth of a pixel, hundreds of them, 0.43 px per mm: well below a millimetre and not nothing
    assert 0.001 < np.linalg.norm(solution.sigma_position) < 0.3
    assert 1e-6 < solution.sigma_direction < 1e-3
    assert 0.001 < solution.sigma_radius < 0.3
    assert 0.01 < solution.sigma0 < 0.3
    assert solution.redundancy > 100
    assert len(solution.residuals) > solution.redundancy


def test_sigma_position_has_no_part_along_the_axis(seen):
    solution = adjusted(seen)
    shifts = solution.covariance[:2, :2]
    assert np.sum(solution.sigma_position**2) == pytest.approx(np.trace(shifts))
    assert np.abs(solution.axes @ solution.cylinder.direction).max() < 1e-3


def test_depth_is_the_weakest_direction(seen):
    sigma = adjusted(seen, pipe()).sigma_position
    assert sigma[1] > sigma[0]


def test_errors_over_many_noises_agree_with_the_sigmas():
    truth = pipe(length=400.0)
    ratios = []
    for seed in range(6):
        solution = adjusted(views([truth], count=2, seed=100 * seed), truth, settings=RANDOM_ONLY)
        offset = solution.cylinder.point - truth.cylinder.point
        offset -= (offset @ truth.direction) * truth.direction
        ratios.append(np.linalg.norm(offset) / np.linalg.norm(solution.sigma_position))
    rms = float(np.sqrt(np.mean(np.square(ratios))))
    assert 0.2 < rms < 4.0


def test_radius_pseudo_observation_is_held(seen):
    wrong = PIPE.diameter / 2 + 1.0
    # hundreds of edges of some 0.1 mm give the radius to about 0.01 mm: far less holds it against them
    solution = adjusted(seen, radius_observation=(wrong, 1e-4))
    assert solution.cylinder.radius == pytest.approx(wrong, abs=0.05)
    free = adjusted(seen)
    assert abs(free.cylinder.radius - wrong) > 0.7
    assert solution.sigma_radius <= 0.02
    assert solution.sigma0 > free.sigma0  # the edges contradict it


def test_true_radius_pseudo_observation_sharpens_the_depth(seen):
    held = adjusted(seen, radius_observation=(PIPE.diameter / 2, 0.01))
    assert PIPE.distance(held.cylinder.point[None])[0] < 0.5
    assert np.linalg.norm(held.sigma_position) <= 1.001 * np.linalg.norm(adjusted(seen).sigma_position)


def test_weak_pseudo_observation_gives_way_to_the_edges(seen):
    solution = adjusted(seen, radius_observation=(PIPE.diameter / 2 + 1.0, 50.0))
    assert solution.cylinder.radius == pytest.approx(adjusted(seen).cylinder.radius, abs=0.02)


def test_true_values_stay_where_they_are(seen):
    solution = adjusted(seen, start=PIPE.cylinder)
    again = adjusted(seen)
    assert again.cylinder.radius == pytest.approx(solution.cylinder.radius, abs=0.02)
    assert PIPE.distance(again.cylinder.point[None])[0] == pytest.approx(PIPE.distance(solution.cylinder.point[None])[0], abs=0.05)


def test_reversed_direction_gives_the_same_pipe(seen):
    forward = adjusted(seen, start=PIPE.cylinder)
    turned = Cylinder(PIPE.cylinder.point, -PIPE.direction, PIPE.cylinder.radius)
    backward = adjusted(seen, start=turned)
    assert backward.cylinder.direction @ PIPE.direction < -0.99
    assert backward.cylinder.radius == pytest.approx(forward.cylinder.radius, abs=0.01)


def test_middle_of_the_extent_becomes_the_point(seen):
    solution = adjust_cylinder(seen, PIPE.cylinder, (-100.0, 300.0))
    along = (solution.cylinder.point - PIPE.cylinder.point) @ PIPE.direction
    assert along == pytest.approx(100.0, abs=1.0)
    assert solution.half_length == pytest.approx(200.0)


def test_too_few_edges_give_none(seen):
    beside = Cylinder(np.add(TARGET, [400.0, 0.0, 0.0]), PIPE.direction, 20.0)
    assert adjusted(seen, start=beside) is None


def test_blank_pictures_give_none():
    assert adjusted(views([])) is None


def test_cylinder_behind_the_cameras_gives_none(seen):
    assert adjusted(seen, start=Cylinder(-TARGET, np.array([0.0, 0.0, 1.0]), 57.0)) is None


def test_no_views_give_none():
    assert adjusted(()) is None
