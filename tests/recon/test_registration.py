# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of the registration: derivatives, the pre-transformation, the network adjustment."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from stations import plant, pose, seen

from pipeworkbench.recon.registration.hypotheses import Pairs, alike, hypotheses_of
from pipeworkbench.recon.registration.landmarks import Landmarks, landmarks_of
from pipeworkbench.recon.registration.network import adjust_network
from pipeworkbench.recon.registration.observations import jacobians, observations_of, residuals
from pipeworkbench.recon.registration.poses import Pose, rotated, rotated_by_quaternion
from pipeworkbench.recon.registration.pretransformation import from_points, from_two_axes, pretransformation
from pipeworkbench.recon.registration.settings import NetworkSettings, SearchSettings

HERE, THERE = pose(20, (300, -4000, 100)), pose(75, (2500, -3500, 0), (0.4, -0.3))
TRUE = Pose.from_matrix(np.linalg.inv(HERE) @ THERE)
SAME = np.arange(len(plant()))
PAIRS = Pairs(SAME, SAME, np.ones(len(SAME)))


def marks(rng=None):
    """Return the landmarks of two stations."""
    return tuple(landmarks_of(seen(name, plant(), place, noise=rng)) for name, place in (("A", HERE), ("B", THERE)))


def turned(angles, shift=(0.0, 0.0, 0.0)):
    return Pose(Rotation.from_euler("zyx", angles).as_matrix(), np.array(shift, float))


angles = st.tuples(*[st.floats(-3, 3)] * 3)
shifts = st.tuples(*[st.floats(-5000, 5000)] * 3)


@given(angles, st.tuples(*[st.floats(-3000, 3000)] * 3))
@settings(max_examples=40, deadline=None)
def test_rotation_by_a_quaternion_and_its_derivatives(turn, point):
    quaternion, point = turned(turn).quaternion[None], np.array([point])
    assert np.allclose(rotated(quaternion, point), turned(turn).points(point), atol=1e-8)
    step = 1e-6
    numeric = np.stack([(rotated(quaternion + d, point) - rotated(quaternion - d, point))[0] / (2 * step) for d in step * np.eye(4)], axis=1)
    assert np.allclose(rotated_by_quaternion(quaternion, point)[0], numeric, atol=1e-4 * max(1.0, np.abs(point).max()) * 1e-2)


@given(angles, shifts, angles, shifts)
@settings(max_examples=25, deadline=None)
def test_derivatives_of_the_observations_agree_with_central_differences(turn, shift, other_turn, other_shift):
    one, other = marks()
    observed = observations_of(one, other, PAIRS, TRUE, (0, 1))
    poses = [turned(turn, shift), turned(other_turn, other_shift)]
    quaternions, translations = np.array([p.quaternion for p in poses]), np.array([p.translation for p in poses])
    analytic = jacobians(observed, quaternions, translations)
    for station in (0, 1):
        for column in range(7):
            # residuals are quadratic in a quaternion's elements, linear in a translation: central differences are exact
            step = 1e-3 if column < 4 else 1.0
            change, shift_by = np.zeros((2, 4)), np.zeros((2, 3))
            (change if column < 4 else shift_by)[station, column % 4 if column < 4 else column - 4] = step
            numeric = residuals(observed, quaternions + change, translations + shift_by) - residuals(
                observed, quaternions - change, translations - shift_by
            )
            expected = analytic[station][:, :, column]
            assert np.allclose(numeric / (2 * step), expected, rtol=1e-6, atol=1e-6 * max(1.0, np.abs(expected).max()))


@given(angles, shifts)
@settings(max_examples=30, deadline=None)
def test_two_axes_give_three_points_and_those_the_pose(turn, shift):
    first, second = (np.array([0.0, 0, 0]), np.array([1.0, 0, 0])), (np.array([500.0, 300, 40]), np.array([0.0, 0.6, 0.8]))
    points = from_two_axes(first, second, 700.0)
    assert np.linalg.norm(np.diff(points[:2], axis=0)) == pytest.approx(700)
    there = turned(turn, shift)
    moved = [(there.points(point), there.rotation @ axis) for point, axis in (first, second)]
    found = from_points(points, from_two_axes(moved[0], moved[1], 700.0))
    assert found.farthest(there, points) < 1e-6


def test_the_artificial_point_is_in_the_middle_of_the_common_perpendicular():
    points = from_two_axes((np.zeros(3), np.array([1.0, 0, 0])), (np.array([300.0, 0, 20]), np.array([0.0, 1, 0])), 100.0)
    assert np.allclose(points, [[300, 0, 10], [400, 0, 10], [300, 100, 10]])


@pytest.mark.parametrize("rows", [[0, 2], [0, 7], [8, 10, 11], [1, 3], [1, 5]])
def test_pairs_give_the_pose(rows):
    one, other = marks()
    found = pretransformation(one, other, PAIRS[np.array(rows)])
    assert found.farthest(TRUE, other.point) < 1e-3


def test_what_does_not_fix_a_pose_gives_none():
    one, other = marks()
    assert pretransformation(one, other, PAIRS[np.array([4, 7])]) is None  # one axis
    assert from_points(np.eye(3)[:2], np.eye(3)[:2]) is None
    line = np.outer([1.0, 2, 5], [1.0, 1, 0])
    assert from_points(line, line) is None


@given(angles.map(lambda a: np.array(a) / 30), st.tuples(*[st.floats(-100, 100)] * 3))
@settings(max_examples=20, deadline=None)
def test_the_adjustment_finds_the_pose_from_bad_starting_values(turn, shift):
    one, other = marks()
    start = turned(turn, shift) @ TRUE
    found = adjust_network(observations_of(one, other, PAIRS, TRUE, (0, 1)), [Pose.identity(), start], 0, NetworkSettings(tilt_deg=None))
    assert found.converged
    assert found.poses[1].farthest(TRUE, other.point) < 1e-3
    assert found.poses[0].farthest(Pose.identity(), other.point) < 1e-12
    assert np.linalg.norm(found.poses[1].quaternion) == pytest.approx(1, abs=1e-12)


@pytest.mark.slow
def test_the_covariance_is_that_of_repeated_adjustments():
    rng, middle, off, sigma = np.random.default_rng(1), marks()[1].middle, [], []
    one, other = marks()
    for _ in range(200):
        # each landmark off by its own covariance
        drawn = [_drawn(part, rng) for part in (one, other)]
        observed = observations_of(*drawn, PAIRS, TRUE, (0, 1))
        found = adjust_network(observed, [Pose.identity(), TRUE], 0, NetworkSettings(tilt_deg=None, tukey=20.0, huber=20.0))
        off.append(found.poses[1].points(middle) - TRUE.points(middle))
        sigma.append(found.sigma_at(1, middle)[0])
    assert np.allclose(np.std(off, 0) / np.mean(sigma, 0), 1, atol=0.25)


def _drawn(landmarks: Landmarks, rng):
    point = np.array([rng.multivariate_normal(p, c, check_valid="ignore") for p, c in zip(landmarks.point, landmarks.position, strict=True)])
    axis = np.array([rng.multivariate_normal(a, c, check_valid="ignore") for a, c in zip(landmarks.axis, landmarks.direction, strict=True)])
    return replace(landmarks, point=point, axis=axis / np.linalg.norm(axis, axis=1, keepdims=True))


def test_a_pair_that_does_not_fit_loses_its_weight():
    one, other = marks(np.random.default_rng(3))
    other.point[0] += [0, 25, 25]
    found = adjust_network(observations_of(one, other, PAIRS, TRUE, (0, 1)), [Pose.identity(), TRUE], 0)
    assert found.weights[0] == 0
    assert np.median(found.weights[found.weights > 0]) > 0.6
    assert found.poses[1].farthest(TRUE, other.point[1:]) < 6


def test_corners_between_pipes_that_correspond_tell_nothing_new():
    one, other = marks()
    share = observations_of(one, other, PAIRS, TRUE, (0, 1)).share
    assert [plant()[row].id for row in np.flatnonzero(share == 0)] == ["E0", "E1", "E2"]
    without = observations_of(one, other, PAIRS[np.array([1, 2, 3])], TRUE, (0, 1)).share
    assert np.all(without == 1)


def test_covariances_of_axes_lie_across_them():
    for part in marks():
        lines = part.is_axis
        assert np.allclose(np.einsum("nij,nj->ni", part.position[lines], part.axis[lines]), 0, atol=1e-9)
        assert np.all(np.linalg.eigvalsh(part.position[lines])[:, 1] > 0.08)


def test_the_right_pose_is_among_the_hypotheses():
    one, other = marks(np.random.default_rng(9))
    limits = SearchSettings()
    pairs = alike(one, other, limits)
    assert {(int(i), int(j)) for i, j in zip(pairs.first, pairs.second, strict=True)} >= {(row, row) for row in SAME}
    nearest = min(
        Pose(rotation, translation).farthest(TRUE, other.point)
        for _, poses, _ in hypotheses_of(one, other, pairs, limits)
        for rotation, translation in zip(poses.rotation, poses.translation, strict=True)
    )
    assert nearest < 60
