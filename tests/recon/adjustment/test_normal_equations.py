# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sparse normal equations against dense ones that are set up row by row, covariances against the dense inverse, frames against differences."""

from dataclasses import replace

import numpy as np
import pytest
from parts import Sight, in_pose, part, plate, richardson, run
from scipy.spatial.transform import Rotation
from simulated import Noise, simulated_views
from single import rates_of, rows_as_such
from synthetic import TARGET, cameras

from pipeworkbench.recon.adjustment.charts import MOTION, RIGID, by_motion
from pipeworkbench.recon.adjustment.linearisation import Variances, linearised, sampled
from pipeworkbench.recon.adjustment.normal_equations import FRAME_LEVER, LEAST_INFORMATION, Frame, covariance
from pipeworkbench.recon.adjustment.observations import SYSTEMATIC
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem, StationViews
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.shapes import shapes_of

SETTINGS = AdjustmentSettings(sizes="free", spacing=12.0)
COMPONENTS, JOINTS = run()
# a prior that is none, where one is asked for
ANYWHERE = {"sigma_position": 1e9, "sigma_rotation": 1e9}
SIDE = np.eye(4)
SIDE[:3, :3] = Rotation.from_euler("z", 0.3).as_matrix()
SIDE[:3, 3] = TARGET - SIDE[:3, :3] @ TARGET


@pytest.fixture(scope="module")
def seen():
    """What two stations see, with noise: one in the frame itself and one from aside."""
    random = np.random.default_rng(4)
    front, aside = cameras(2), tuple(camera.placed(SIDE) for camera in cameras(2))
    noise = Noise(sigma=0.1, common=0.05)
    views = [simulated_views(some, COMPONENTS, random, noise) for some in (front, aside)]
    own = [replace(view, camera=camera) for view, camera in zip(views[1], cameras(2), strict=True)]
    return views[0], own


def stations(seen, **more):
    """Return a station that is fixed and one whose freedom is given."""
    return (StationViews("front", seen[0]), StationViews("aside", seen[1], SIDE, **more))


FREEDOMS = {
    "no frame": {},
    "a station": {"free": True},
    "a station with a prior": {"free": True, "sigma_position": 3.0, "sigma_rotation": 1e-3},
    "a camera": {"free_cameras": frozenset({1})},
    "a station and a camera of it": {"free": True, "free_cameras": frozenset({0})},
}
EVERY_FREEDOM = pytest.mark.parametrize("freedom", FREEDOMS)


def linear_of(problem, settings=SETTINGS, moved_by=None):
    state = State.of(problem, settings)
    if moved_by is not None:
        state = state.moved(state.unknowns(), moved_by(state.unknowns()))
    samples = sampled(state, settings)
    return linearised(state, samples, 6.0, Variances(), settings), samples


def problem_of(seen, freedom):
    return Problem(COMPONENTS, stations(seen, **FREEDOMS[freedom]), JOINTS)


def off(unknowns):
    """Return a step that leaves all that is free a little off."""
    return np.random.default_rng(2).normal(0, 0.3, unknowns.total)


def dense(linear, samples, settings=SETTINGS):
    """Return the matrix and the right side for all unknowns, set up row by row with the contours' errors as unknowns of their own."""
    state, unknowns, groups = linear.state, linear.unknowns, linear.groups
    total, count = unknowns.total, len(groups)
    size = total + SYSTEMATIC * count
    matrix, right = np.zeros((size, size)), np.zeros(size)

    def add(row, weight, distance):
        matrix[:] += weight * np.outer(row, row)
        right[:] += weight * distance * row

    shapes = shapes_of(state.components)
    before = 0
    for number, (camera, some, rows) in enumerate(zip(state.cameras, samples, linear.samples, strict=True)):
        seen = some.seen_by(camera, shapes)
        rates = seen.gain[:, None] * by_motion(state.bodies, some.owner, some.group_part[some.group], seen.point, seen.outward)
        for sample in np.flatnonzero(rows.weight > 0):
            row = np.zeros(size)
            owner = some.owner[sample]
            row[unknowns.columns(owner)] = rates[sample] @ unknowns.basis[owner][:, : unknowns.count[owner]]
            for start, frame in zip(unknowns.frame_start, unknowns.frames, strict=True):
                if number in frame.views:
                    row[start : start + RIGID] = rates[sample, :RIGID] @ unknowns.frame_motions(frame, np.array([owner]))[0]
            group = before + some.group[sample]
            # all samples alike, and how it changes: along lines, by cosine and sine around circles
            row[total + group + count * np.arange(SYSTEMATIC)] = 1.0, *some.pattern[sample]
            add(row, rows.weight[sample], rows.distance[sample])
        before += len(some.group_owner)
    errors = Variances().precision(groups, settings)
    matrix[range(total, size), range(total, size)] += errors.T.ravel()
    for condition in rows_as_such(linear.observed):
        row = np.zeros(size)
        for owner, derivative in condition.parts:
            row[unknowns.columns(owner)] += derivative @ unknowns.basis[owner][:, : unknowns.count[owner]]
        add(row, condition.sigma**-2.0, condition.misclosure)
    for start, frame in zip(unknowns.frame_start, unknowns.frames, strict=True):
        sigma = np.repeat([frame.sigma_position, frame.sigma_rotation * FRAME_LEVER], 3)
        deviation = frame.deviation * np.repeat([1.0, FRAME_LEVER], 3)
        for column in range(RIGID):
            row = np.zeros(size)
            row[start + column] = 1.0
            add(row, sigma[column] ** -2.0, -deviation[column])
    matrix[range(total), range(total)] += LEAST_INFORMATION
    # the contours' errors are eliminated
    inverse = np.linalg.inv(matrix[total:, total:])
    between = matrix[:total, total:]
    return matrix[:total, :total] - between @ inverse @ between.T, right[:total] - between @ inverse @ right[total:]


# ---------------------------------------------------------------- sum


@EVERY_FREEDOM
def test_sparse_equations_are_the_dense_ones(seen, freedom):
    linear, samples = linear_of(problem_of(seen, freedom), moved_by=off)
    matrix, right = dense(linear, samples)
    scale = np.sqrt(np.diag(matrix))
    found = linear.equations.matrix.toarray()
    assert np.abs((found - matrix) / np.outer(scale, scale)).max() < 1e-9
    assert np.abs((linear.equations.right - right) / scale).max() < 1e-9 * np.abs(right / scale).max()
    assert (found == found.T).all() or np.abs((found - found.T) / np.outer(scale, scale)).max() < 1e-12


@EVERY_FREEDOM
def test_solution_is_that_of_the_dense_equations(seen, freedom):
    linear, samples = linear_of(problem_of(seen, freedom), moved_by=off)
    matrix, right = dense(linear, samples)
    scale = np.sqrt(np.diag(matrix))
    for damping in (0.0, 1e-2):
        damped = matrix + damping * np.diag(np.diag(matrix))
        expected = np.linalg.solve(damped / np.outer(scale, scale), right / scale) / scale
        assert linear.equations.solve(damping) == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_more_damping_makes_the_step_shorter(seen):
    linear, _ = linear_of(problem_of(seen, "no frame"), moved_by=off)
    scale = np.sqrt(linear.equations.matrix.diagonal())
    lengths = [np.linalg.norm(scale * linear.equations.solve(damping)) for damping in (0.0, 1e-2, 1.0, 1e3)]
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[-1] < 0.01 * lengths[0]


# ---------------------------------------------------------------- covariance


@EVERY_FREEDOM
def test_covariances_are_blocks_of_the_dense_inverse(seen, freedom):
    linear, _ = linear_of(problem_of(seen, freedom))
    matrix = linear.equations.matrix.toarray()
    scale = 1 / np.sqrt(np.diag(matrix))
    inverse = np.linalg.inv(matrix * np.outer(scale, scale)) * np.outer(scale, scale)
    found, unknowns = covariance(linear.equations), linear.unknowns
    own = unknowns.own

    def assert_same(block, rows, columns):
        expected = inverse[np.ix_(rows, columns)]
        sigma = np.sqrt(np.outer(np.diag(inverse)[rows], np.diag(inverse)[columns]))
        assert np.abs((block - expected) / sigma).max(initial=0.0) < 1e-5

    for row in range(len(COMPONENTS)):
        columns = unknowns.columns(row)
        assert_same(found.of(columns), columns, columns)
    # of components that a joint binds, also what is between them
    pair = np.concatenate([unknowns.columns(0), unknowns.columns(1)])
    assert_same(found.of(pair), pair, pair)
    every, one, other = np.arange(len(COMPONENTS)), np.array([0, 0, 1]), np.array([1, 6, 0])
    for rows, columns in ((every, every), (one, other)):
        for block, row, column in zip(found.blocks(unknowns, rows, columns), rows, columns, strict=True):
            first, second = unknowns.columns(row), unknowns.columns(column)
            assert not block[len(first) :].any()
            assert not block[:, len(second) :].any()
            if 6 not in {row, column} or row == column:
                assert_same(block[: len(first), : len(second)], first, second)
            else:
                # nothing binds them, but for a camera that both are seen by
                assert not block.any()
    frames = np.arange(own, unknowns.total)
    assert_same(found.border, frames, frames)
    assert_same(found.with_border, np.arange(own), frames)
    if len(frames):
        between = found.between(unknowns, np.array([1, 6]), np.arange(RIGID))
        for number, row in enumerate((1, 6)):
            expected = unknowns.basis[row][:, : unknowns.count[row]] @ inverse[np.ix_(unknowns.columns(row), frames[:RIGID])]
            assert between[number] == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_covariance_of_a_part_too_large_to_be_inverted_at_once_is_the_same(seen, monkeypatch):
    linear, _ = linear_of(problem_of(seen, "a station"))
    expected = covariance(linear.equations)
    monkeypatch.setattr("pipeworkbench.recon.adjustment.normal_equations.LARGEST_DENSE", 10)
    monkeypatch.setattr("pipeworkbench.recon.adjustment.normal_equations.COLUMNS", 7)
    found = covariance(linear.equations)
    for row in range(len(COMPONENTS)):
        columns = linear.unknowns.columns(row)
        sigma = np.sqrt(np.diag(expected.of(columns)))
        assert np.abs((found.of(columns) - expected.of(columns)) / np.outer(sigma, sigma)).max() < 1e-6


def test_pipelines_without_a_joint_between_them_are_parts_of_their_own(seen):
    linear, _ = linear_of(problem_of(seen, "no frame"))
    found = covariance(linear.equations)
    assert len(found.parts) == 2
    assert found.part_of_unknown[linear.unknowns.columns(0)[0]] != found.part_of_unknown[linear.unknowns.columns(6)[0]]


def test_size_that_nothing_observes_has_a_variance_of_its_own():
    """A flange alone: its contours say nothing of its pipe, whose diameter is bound to nothing else."""
    flange = in_pose(part("flat flange"), 1)
    views = simulated_views(cameras(2), [flange], np.random.default_rng(0))
    linear, _ = linear_of(Problem((flange,), (StationViews("S", views),)))
    columns = linear.unknowns.columns(0)
    found = covariance(linear.equations).of(columns)
    expected = np.linalg.inv(linear.equations.matrix.toarray())
    assert np.diag(found) == pytest.approx(np.diag(expected), rel=1e-6)
    assert linear.unknowns.names[0][5] == "outer_diameter"
    assert np.sqrt(found[5, 5]) > 1000.0


# ---------------------------------------------------------------- frames


@pytest.mark.parametrize("kind", ["pipe", "elbow", "flange", "tee"])
@pytest.mark.parametrize("column", range(RIGID))
def test_distances_change_with_a_stations_pose_as_the_design_says(kind, column):
    component, camera = in_pose(part(kind), 3), cameras()[2]
    sight = Sight(camera, component)
    problem = Problem((component,), (StationViews("S", (_view(camera),), free=True, **ANYWHERE),))
    state = State.of(problem, SETTINGS)
    unknowns = state.unknowns()
    rates = sight.seen.gain[:, None] * rates_of(component, sight)
    design = rates[:, :RIGID] @ unknowns.frame_motions(unknowns.frames[0], np.array([0]))[0]

    def distances(h):
        step = np.zeros(unknowns.total)
        step[unknowns.frame_start[0] + column] = h
        return sight.distances(component, state.moved(unknowns, step).cameras[0])

    truth = richardson(distances, 0.2)
    assert design[:, column] == pytest.approx(truth, rel=1e-6, abs=1e-6 * np.abs(design).max())


def _view(camera):
    (view,) = simulated_views((camera,), COMPONENTS, np.random.default_rng(0))
    return view


def rigid_step(unknowns, motion):
    """Return the step (u,) with which everything makes one small rigid motion (6,) about the origin: t + w x X."""
    shift, turn = motion[:3], motion[3:]
    step = np.zeros(unknowns.total)
    for row, reference in enumerate(unknowns.reference):
        whole = np.concatenate([shift + np.cross(turn, reference), turn, np.zeros(MOTION - RIGID)])
        basis = unknowns.basis[row][:, : unknowns.count[row]]
        # a pipe's way along its axis and its turn about it change nothing
        step[unknowns.columns(row)] = np.linalg.lstsq(basis, whole, rcond=None)[0]
    for start, frame in zip(unknowns.frame_start, unknowns.frames, strict=True):
        step[start : start + RIGID] = *(shift + np.cross(turn, frame.origin)), *(turn * FRAME_LEVER)
    return step


def information(linear):
    """Return the normal matrix without what is known before, in standard deviations."""
    matrix = linear.equations.matrix.toarray() - LEAST_INFORMATION * np.eye(linear.unknowns.total)
    scale = 1 / np.sqrt(np.diag(matrix))
    return matrix * np.outer(scale, scale), scale


@pytest.mark.parametrize("fixed", [False, True])
def test_everything_may_move_together_unless_a_station_is_fixed(seen, fixed):
    both = (StationViews("front", seen[0], free=not fixed, **ANYWHERE), StationViews("aside", seen[1], SIDE, free=True))
    linear, _ = linear_of(Problem(COMPONENTS, both, JOINTS))
    matrix, scale = information(linear)
    values = np.linalg.eigvalsh(matrix)
    steps = np.array([rigid_step(linear.unknowns, motion) for motion in np.diag([1.0, 1, 1, 1e-3, 1e-3, 1e-3])]).T / scale[:, None]
    directions, _ = np.linalg.qr(steps)
    left = np.abs(matrix @ directions).max()
    if fixed:
        assert values[0] > 1e-12
        assert left > 1e-3
    else:
        assert left < 1e-9
        assert (values < 1e-13).sum() >= RIGID - 1
        # without these six nothing is open
        rest = matrix + directions @ directions.T
        assert np.linalg.eigvalsh(rest)[0] > 1e3 * np.abs(values[:RIGID]).max()


def test_camera_that_moves_in_its_rig_is_a_frame_of_its_own(seen):
    linear, _ = linear_of(problem_of(seen, "a station and a camera of it"))
    station, camera = linear.unknowns.frames
    assert (station.camera, station.views) == (False, frozenset({2, 3}))
    assert (camera.camera, camera.views) == (True, frozenset({2}))
    assert camera.sigma_position == 0.1


def test_frame_that_moved_is_drawn_back_by_its_prior():
    frame = Frame("S", camera=False, views=frozenset({0}), origin=np.zeros(3), sigma_position=2.0, sigma_rotation=1e-3, deviation=np.zeros(6))
    component = in_pose(plate(), 1)
    problem = Problem((component,), (StationViews("S", (_view(cameras()[0]),), free=True, sigma_position=2.0, sigma_rotation=1e-3),))
    state = State.of(problem, SETTINGS)
    unknowns = state.unknowns()
    step = np.zeros(unknowns.total)
    step[unknowns.frame_start[0] :] = 1.0, -2.0, 3.0, 0.4, 0.5, -0.6
    there = state.moved(unknowns, step)
    assert there.frames[0].deviation == pytest.approx([1.0, -2.0, 3.0, 4e-4, 5e-4, -6e-4])
    # without any samples only the prior is left, which leads back to the beginning
    linear = linearised(there, tuple(_none(one) for one in sampled(there, SETTINGS)), 6.0, Variances(), SETTINGS)
    back = linear.equations.solve()
    assert back[unknowns.frame_start[0] :] == pytest.approx(-step[unknowns.frame_start[0] :], rel=1e-6)
    assert frame.sigma_position == there.frames[0].sigma_position


def _none(samples):
    """Return no samples of the same components."""
    empty = {name: getattr(samples, name)[:0] for name in samples.__dataclass_fields__ if name != "wanted"}
    return type(samples)(wanted=samples.wanted, **empty)
