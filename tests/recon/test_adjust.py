# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common adjustment from end to end, against simulated pipelines whose geometry is known exactly, and what it does with bad input."""

from dataclasses import replace

import numpy as np
import pytest
from parts import DIAMETER, attached, bend, gaps, part, run, straight, with_edges
from scipy.spatial.transform import Rotation
from simulated import Noise, errors, perturbed, rig, simulated_pipeline, simulated_views
from single import changed
from synthetic import TARGET, cameras

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Joint, Pipe
from pipeworkbench.recon.accuracy import level_of_accuracy
from pipeworkbench.recon.adjust import AdjustmentSettings, Problem, StationViews, adjust
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.vectors import unit

TRUTH, JOINTS = run()
GASKET = 3  # the joint between both flanges
# what the settings expect of edges of 0.1 px
NOISE = Noise(sigma=0.1, common=0.0943, trend=0.0539)
LITTLE = Noise(sigma=0.05, common=0.01)
EXACT_MM = 0.01
SIGMAS = 4.0


def views_of(components=TRUTH, noise=NOISE, seed=1, seen_by=None):
    return simulated_views(seen_by or cameras(), components, np.random.default_rng(seed), noise)


def off(components=TRUTH, seed=2, position_mm=3.0, direction_deg=0.3):
    return perturbed(components, np.random.default_rng(seed), position_mm, direction_deg)


@pytest.fixture(scope="module")
def views():
    return views_of()


@pytest.fixture(scope="module")
def start():
    return off()


@pytest.fixture(scope="module")
def solved(views, start):
    return adjust(problem_of(views, start))


def problem_of(views, components, joints=JOINTS, **more):
    return Problem(tuple(components), (StationViews("S", views),), tuple(joints), **more)


def with_part(components, name, **changes):
    return tuple(replace(one, **changes) if one.id == name else one for one in components)


def of(components, name):
    (found,) = [one for one in components if one.id == name]
    return found


def shifted(component, shift):
    return changed(component, np.array([*shift, 0, 0, 0, 0, 0, 0]))


def position_errors(solution, truth):
    return np.linalg.norm(errors(solution.components, truth).position, axis=1)


def assert_true(solution, truth=TRUTH, joints=JOINTS, gasket=GASKET):
    """Positions and directions are within their sigmas of the truth, and the joints are closed."""
    found = errors(solution.components, truth)
    for row, component in enumerate(truth):
        estimate = solution.estimates[component.id]
        sigma = np.sqrt(np.linalg.eigvalsh(estimate.covariance)[-1])
        assert np.linalg.norm(found.position[row]) < SIGMAS * sigma, component.id
        assert np.linalg.norm(found.direction[row]) < SIGMAS * max(estimate.sigma_direction, 1e-6), component.id
    assert solution.converged
    apart = gaps(solution.components, joints)
    assert np.delete(apart, gasket).max(initial=0.0) < EXACT_MM


# ---------------------------------------------------------------- accuracy


def test_truth_is_recovered_within_the_sigmas_and_joints_are_closed(solved):
    assert_true(solved)
    assert not solved.undetermined
    assert not solved.warnings


def test_gap_at_the_gasket_is_as_thick_as_the_gasket(solved):
    assert gaps(solved.components, JOINTS)[GASKET] == pytest.approx(2.0, abs=0.5)


def test_neighbours_have_one_direction_and_one_diameter(solved):
    for joint in JOINTS:
        one, other = (of(solved.components, name).ports[port] for name, port in ((joint.a, joint.a_port), (joint.b, joint.b_port)))
        assert np.linalg.norm(np.add(one.direction, other.direction)) < 1e-4
        assert one.diameter == pytest.approx(other.diameter, abs=EXACT_MM)


def test_components_say_how_well_they_are_known(solved):
    for component in solved.components:
        estimate = solved.estimates[component.id]
        assert component.sigma_position == pytest.approx(tuple(estimate.sigma_position), abs=1e-4)
        assert component.sigma_direction_deg == pytest.approx(np.degrees(estimate.sigma_direction), abs=1e-5)
        assert component.loa == level_of_accuracy(float(np.linalg.norm(estimate.sigma_position)))
        # q is the mean of squares or less: edges of 0.1 px with a common error of as much
        assert component.quality is not None
        names, covariance = solved.covariance(component.id)
        assert len(names) == len(covariance)
        assert np.linalg.eigvalsh(covariance)[0] > 0
    assert 0.7 * NOISE.sigma < solved.sigma_image < 2.5 * NOISE.sigma


@pytest.mark.slow
def test_errors_over_many_noises_are_as_large_as_the_sigmas():
    ratios = []
    for seed in range(6):
        solution = adjust(problem_of(views_of(seed=100 + seed), off(seed=seed)))
        found = errors(solution.components, TRUTH).position
        for row, component in enumerate(TRUTH):
            values, axes = np.linalg.eigh(solution.estimates[component.id].covariance)
            # a pipe has no place along its axis
            kept = slice(1, None) if isinstance(component, Pipe) else slice(None)
            ratios += (found[row] @ axes / np.sqrt(np.maximum(values, 1e-12)))[kept].tolist()
    # 6 independent runs of some 10 independent errors each: what is asked for is 0.8 to 1.25
    assert 0.7 < np.sqrt(np.mean(np.square(ratios))) < 1.35


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 4])
def test_rough_values_lead_to_the_same_place(seed):
    """Also flanges, each as thick as two are apart, so that one alone looks the same where the other one is."""
    views = views_of(seed=seed)
    # 20 mm are 9 px, and 3 degrees as much at the ends
    settings = AdjustmentSettings.for_rough_values(reach=25.0, slide=25.0)
    assert_true(adjust(problem_of(views, off(seed=seed, position_mm=20.0, direction_deg=3.0)), settings))


def test_flange_beside_one_that_is_fixed_goes_to_its_gasket(views):
    given = tuple(replace(of(TRUTH, one.id), fixed=True) if one.id == "F" else one for one in off(position_mm=15.0))
    solution = adjust(problem_of(views, given), AdjustmentSettings.for_rough_values(reach=15.0, slide=20.0))
    assert gaps(solution.components, JOINTS)[GASKET] == pytest.approx(2.0, abs=0.5)
    assert np.linalg.norm(errors([of(solution.components, "G")], [of(TRUTH, "G")]).position) < 0.5


@pytest.mark.slow
def test_grown_pipeline_with_fittings_of_all_kinds_is_recovered():
    random = np.random.default_rng(3)
    seen_by = rig(np.zeros(3), 0.0)
    truth, joints = simulated_pipeline(random, 12, seen_by)
    assert len({one.kind for one in truth}) >= 4
    views = simulated_views(seen_by, truth, random, NOISE)
    faces = [n for n, joint in enumerate(joints) if joint.a_port == joint.b_port == 0 and joint.a[0] == joint.b[0] == "F"]
    # 3 mm are up to 6 px here, and more than flanges' edges are apart
    solution = adjust(problem_of(views, off(truth), joints), AdjustmentSettings.for_rough_values(reach=10.0, slide=8.0))
    assert_true(solution, truth, joints, faces)


def test_adjustment_of_its_own_result_moves_nothing_by_more_than_its_sigma(solved, views):
    again = adjust(problem_of(views, solved.components))
    sigma = [np.linalg.norm(solved.estimates[one.id].sigma_position) for one in solved.components]
    assert (position_errors(again, solved.components) < sigma).all()


def test_adjustment_of_its_own_result_moves_next_to_nothing(solved, views):
    again = adjust(problem_of(views, solved.components))
    assert position_errors(again, solved.components).max() < 0.02


def test_progress_is_told_and_never_beyond_its_end(views, start):
    told = []
    adjust(problem_of(views, start), progress=lambda text, done, total: told.append((text, done, total)))
    assert told
    assert [done for _, done, _ in told] == sorted(done for _, done, _ in told)
    assert all(0 <= done <= total for _, done, total in told)


# ---------------------------------------------------------------- what the user knows


def test_component_that_is_fixed_stays_and_its_neighbours_join_it(views, start):
    fixed = replace(shifted(of(TRUTH, "B"), (0.3, 0.4, 0.0)), fixed=True)
    given = tuple(fixed if one.id == "B" else one for one in start)
    solution = adjust(problem_of(views, given))
    assert of(solution.components, "B") is fixed
    assert "B" not in solution.estimates
    assert np.delete(gaps(solution.components, JOINTS), GASKET).max() < EXACT_MM
    assert not solution.undetermined


def test_parts_on_both_sides_of_a_fixed_elbow_join_it(views, start):
    given = tuple(replace(of(TRUTH, "E"), fixed=True) if one.id == "E" else one for one in start)
    solution = adjust(problem_of(views, given))
    assert of(solution.components, "E") is of(given, "E")
    assert np.delete(gaps(solution.components, JOINTS), GASKET).max() < EXACT_MM
    # both pipes follow from the elbow
    for name in "AB":
        assert np.linalg.norm(errors([of(solution.components, name)], [of(TRUTH, name)]).position) < 0.05


def test_held_parameters_stay(views, start):
    held = {"D": frozenset({"direction", "outer_diameter"}), "A": frozenset({"position"}), "E": frozenset({"bend_radius", "angle_deg"})}
    free = AdjustmentSettings(sizes="free")
    solution = adjust(problem_of(views, start, held=held), free)
    here, there = of(start, "D"), of(solution.components, "D")
    assert unit(np.subtract(there.end, there.start)) == pytest.approx(unit(np.subtract(here.end, here.start)), abs=1e-12)
    assert there.outer_diameter == here.outer_diameter
    assert np.linalg.norm(errors([there], [here]).position) > 1.0
    assert of(solution.components, "E").bend_radius == of(start, "E").bend_radius
    assert of(solution.components, "E").angle_deg == pytest.approx(90.0, abs=1e-9)
    # the point of the axis that was its middle, while the pipe has turned and got another end
    assert np.linalg.norm(errors([of(solution.components, "A")], [of(start, "A")]).position) < 1e-6
    assert np.linalg.norm(errors([of(solution.components, "A")], [of(start, "A")]).direction) > 1e-3
    assert np.linalg.norm(errors([of(solution.components, "A")], [of(TRUTH, "A")]).direction) < 0.7 * np.linalg.norm(
        errors([of(start, "A")], [of(TRUTH, "A")]).direction
    )
    assert "direction" not in solution.covariance("D")[0]


@pytest.mark.parametrize(("sigma", "low", "high"), [(1e-3, 61.98, 62.02), (1e3, 59.6, 61.0)])
def test_observed_size_counts_as_much_as_its_sigma_says(views, start, sigma, low, high):
    solution = adjust(problem_of(views, start, observed={"D": {"outer_diameter": (62.0, sigma)}}))
    assert low < of(solution.components, "D").outer_diameter < high


@pytest.mark.slow
def test_observed_size_between_both_is_the_weighted_mean(views, start):
    diameters, weight = [], []
    for sigma in (1e3, 0.15):
        solution = adjust(problem_of(views, start, observed={"D": {"outer_diameter": (60.8, sigma)}}))
        diameters.append(of(solution.components, "D").outer_diameter)
        weight.append(solution.estimates["D"].sizes["outer_diameter"] ** -2.0)
    expected = (weight[0] * diameters[0] + 0.15**-2 * 60.8) / (weight[0] + 0.15**-2)
    assert diameters[1] == pytest.approx(expected, abs=0.3 * abs(60.8 - diameters[0]))


def test_diameter_within_its_tolerance_is_found():
    truth = with_part(TRUTH, "D", outer_diameter=60.6)
    solution = adjust(problem_of(views_of(truth, LITTLE), with_part(off(), "D", outer_diameter=60.3)), AdjustmentSettings(sizes="tolerance"))
    found = of(solution.components, "D")
    sigma = solution.estimates["D"].sizes["outer_diameter"]
    assert found.outer_diameter == pytest.approx(60.6, abs=SIGMAS * sigma)
    assert abs(found.outer_diameter - 60.6) < 0.1
    assert sigma < 0.15
    assert found.sigma_outer_diameter == pytest.approx(sigma, abs=1e-4)


def test_standard_sizes_that_are_exact_stay(solved, start):
    for one, other in zip(solved.components, start, strict=True):
        assert one.outer_diameter == other.outer_diameter
    assert of(solved.components, "E").bend_radius == 152.0
    assert of(solved.components, "E").angle_deg != 90.0


def test_size_that_nothing_observes_keeps_its_value_and_is_said_to_be_unknown():
    """A flat flange alone: its pipe's diameter is in no contour."""
    flange = part("flat flange")
    truth = changed(flange, np.array([0, 0, 0, 0, 0, 0.8, 0, 0, 0]))
    solution = adjust(problem_of(views_of([truth]), off([truth]), ()), AdjustmentSettings(sizes="free"))
    (found,) = solution.components
    assert found.outer_diameter == truth.outer_diameter
    assert "outer diameter" in solution.undetermined[truth.id]
    assert "position" not in solution.undetermined[truth.id]
    assert np.linalg.norm(errors([found], [truth]).position) < 1.0
    assert pytest.approx(truth.D, abs=1.0) == found.D


def level(direction, name="L"):
    way = 230.0 * unit(direction)
    return Pipe(id=name, start=tuple(TARGET - way), end=tuple(TARGET + way), outer_diameter=DIAMETER, dn=100)


def test_run_that_is_level_is_known_better_where_it_is_said_to_be():
    truth = level((0.8, 0.6, 0.0))
    views = views_of([truth], replace(NOISE, common=0.3, trend=0.3))
    start = off([truth])
    free, aligned = (adjust(problem_of(views, start, ()), AdjustmentSettings(aligned=on, aligned_sigma_deg=0.01)) for on in (False, True))
    heights = [abs(unit(np.subtract(one.end, one.start))[2]) for one in (free.components[0], aligned.components[0])]
    assert heights[1] < min(heights[0], np.radians(0.03))
    names = [np.linalg.norm(one.estimates["L"].sigma_direction) for one in (free, aligned)]
    assert names[1] <= names[0]


def test_run_that_is_visibly_not_level_stays_so():
    truth = level((0.8, 0.6, np.tan(np.radians(1.5))))
    solution = adjust(problem_of(views_of([truth], LITTLE), off([truth]), ()), AdjustmentSettings(aligned=True))
    tilt = np.degrees(np.arcsin(abs(unit(np.subtract(solution.components[0].end, solution.components[0].start))[2])))
    assert tilt == pytest.approx(1.5, abs=0.15)


@pytest.mark.slow
def test_given_place_holds_a_pipe_where_it_is_said_to_be(views, start):
    given = with_part(start, "D", sigma_position=(0.01, 0.01, 0.01), sigma_direction_deg=0.001)
    free, placed = (adjust(problem_of(views, given, placed=names)) for names in (frozenset(), frozenset({"D"})))
    moved_by = [np.linalg.norm(errors([of(one.components, "D")], [of(start, "D")]).position) for one in (free, placed)]
    assert moved_by[0] > 1.0
    assert moved_by[1] < 0.5


# ---------------------------------------------------------------- stations and cameras

SIDE = np.eye(4)
SIDE[:3, :3] = Rotation.from_euler("z", 0.3).as_matrix()
SIDE[:3, 3] = TARGET - SIDE[:3, :3] @ TARGET


def two_stations(seed=6, noise=LITTLE):
    """Return the views of two stations, each with cameras in its own frame."""
    random = np.random.default_rng(seed)
    front = simulated_views(cameras(), TRUTH, random, noise)
    aside = simulated_views(tuple(camera.placed(SIDE) for camera in cameras()), TRUTH, random, noise)
    return front, [replace(view, camera=camera) for view, camera in zip(aside, cameras(), strict=True)]


def wrong_pose(shift_mm, turn_deg, seed=0):
    """Return a pose that is off from SIDE by so much at the station's place."""
    random = np.random.default_rng(seed)
    centre = SIDE[:3, 3]
    motion = np.eye(4)
    motion[:3, :3] = Rotation.from_rotvec(np.radians(turn_deg) * unit(random.normal(size=3))).as_matrix()
    motion[:3, 3] = centre + shift_mm * unit(random.normal(size=3)) - motion[:3, :3] @ centre
    return motion @ SIDE


def assert_pose(pose, centre):
    """A station's cameras are where they are, within the covariance of its pose."""
    off_by = pose.frame_from_level @ np.linalg.inv(SIDE)
    shift = off_by[:3, :3] @ centre + off_by[:3, 3] - centre
    turn = Rotation.from_matrix(off_by[:3, :3]).as_rotvec()
    sigma = np.sqrt(np.diag(pose.covariance))
    assert (sigma > 0).all()
    assert (np.abs(shift) < SIGMAS * sigma[:3]).all()
    assert (np.abs(turn) < SIGMAS * sigma[3:]).all()
    assert np.linalg.norm(shift) < 1.0
    assert np.degrees(np.linalg.norm(turn)) < 0.02


@pytest.mark.slow
def test_station_that_is_free_is_put_where_it_is():
    front, aside = two_stations()
    stations = StationViews("front", front), StationViews("aside", aside, wrong_pose(5.0, 0.1), free=True)
    solution = adjust(Problem(off(position_mm=1.0, direction_deg=0.1), stations, JOINTS))
    centre = np.mean([camera.placed(SIDE).projection_centre for camera in cameras()], axis=0)
    assert_pose(solution.stations["aside"], centre)
    assert_true(solution)
    # the other one stays, and its pose is certain
    assert solution.stations["front"].frame_from_level == pytest.approx(np.eye(4))
    assert not solution.stations["front"].covariance.any()
    assert solution.unknowns == adjust(Problem(TRUTH, (StationViews("front", front),), JOINTS)).unknowns + 6


@pytest.mark.slow
def test_station_with_a_strong_prior_stays():
    front, aside = two_stations()
    given = wrong_pose(5.0, 0.1)
    stations = StationViews("front", front), StationViews("aside", aside, given, free=True, sigma_position=1e-4, sigma_rotation=1e-8)
    solution = adjust(Problem(TRUTH, stations, JOINTS))
    assert solution.stations["aside"].frame_from_level == pytest.approx(given, abs=0.01)


@pytest.mark.slow
def test_camera_that_is_free_is_put_where_it_is():
    views = views_of(noise=LITTLE)
    turned = views[2].camera.moved(np.array([0.6, -0.5, 0.4, 2e-4, -3e-4, 2e-4]))
    given = [*views[:2], replace(views[2], camera=turned)]
    sigmas = {"camera_sigma_position": 3.0, "camera_sigma_rotation": 2e-3}
    held, freed = (
        adjust(Problem(off(), (StationViews("S", given, free_cameras=cameras_, **sigmas),), JOINTS)) for cameras_ in (frozenset(), frozenset({2}))
    )
    points = np.array([port.point for one in TRUTH for port in one.ports])
    pixels = [one.stations["S"].cameras[2].project(points) - views[2].camera.project(points) for one in (held, freed)]
    assert np.linalg.norm(pixels[0], axis=1).max() > 0.3
    assert np.linalg.norm(pixels[1], axis=1).mean() < 0.1
    assert freed.sigma0 < held.sigma0
    for one in (0, 1):
        assert freed.stations["S"].cameras[one].projection_centre == pytest.approx(views[one].camera.projection_centre, abs=1e-9)


# ---------------------------------------------------------------- bad input


def test_fixed_pipes_that_do_not_meet_leave_their_elbow_as_it_was(views, start):
    fixed = {"A": replace(of(TRUTH, "A"), fixed=True), "B": replace(shifted(of(TRUTH, "B"), (15.0, 30.0, 0.0)), fixed=True)}
    given = tuple(fixed.get(one.id, one) for one in start)
    solution = adjust(problem_of(views, given))
    assert set(solution.undetermined) == {"E"}
    assert "cannot be fulfilled" in solution.undetermined["E"]
    for name in "ABE":
        assert of(solution.components, name) is of(given, name)
    assert any("E" in text for text in solution.warnings)
    # what has nothing to do with it is adjusted
    assert np.linalg.norm(errors([of(solution.components, "D")], [of(TRUTH, "D")]).position) < SIGMAS * np.linalg.norm(
        solution.estimates["D"].sigma_position
    )


def test_fixed_pipes_that_meet_contradict_nothing(views, start):
    given = tuple(replace(of(TRUTH, one.id), fixed=True) if one.id in "AB" else one for one in start)
    solution = adjust(problem_of(views, given))
    assert not solution.undetermined
    assert position_errors(solution, TRUTH)[1] < EXACT_MM
    assert np.delete(gaps(solution.components, JOINTS), GASKET).max() < EXACT_MM


UNSEEN = {
    "far outside the images": straight("X", diameter=60.3, start=(5000.0, 9000.0, 0.0), end=(5000.0, 9500.0, 0.0)),
    "where no edges are": straight("X", diameter=60.3, start=(-300.0, 3000.0, 300.0), end=(-100.0, 3000.0, 300.0)),
    "behind the cameras": straight("X", diameter=60.3, start=(-300.0, -3000.0, 300.0), end=(-100.0, -3000.0, 300.0)),
}


@pytest.mark.parametrize("where", UNSEEN)
def test_component_without_observations_stays_exactly_as_it_was(views, start, solved, where):
    unseen = UNSEEN[where]
    solution = adjust(problem_of(views, [*start, unseen]))
    assert solution.components[-1] is unseen
    assert set(solution.undetermined) == {"X"}
    assert "X" not in solution.estimates
    assert any(text.startswith("X:") for text in solution.warnings)
    # it is far from the others, which are as they are without it
    assert errors(solution.components[:-1], solved.components).position == pytest.approx(0.0, abs=0.05)


def test_unseen_component_at_a_joint_stays_and_its_neighbour_is_adjusted(views, start):
    """How far an elbow that nobody sees is turned about its pipe nothing says."""
    pipe = of(start, "C")
    elbow, one = attached(pipe, 1, bend("X"), 0, gap=2500.0)
    solution = adjust(problem_of(views, [*start, elbow], [*JOINTS, one]))
    assert of(solution.components, "X") is elbow
    assert set(solution.undetermined) == {"X"}
    assert_true(replace(solution, components=solution.components[:-1]))


def test_unseen_pipe_that_a_joint_determines_follows_its_neighbour(views, start):
    """A pipe behind an edge of the image goes on in a line."""
    pipe = of(start, "C")
    behind, one = attached(pipe, 1, straight("X", length=400.0, dn=100), 0)
    far = tuple(np.array(behind.end) + 3000.0 * unit(np.subtract(behind.end, behind.start)))
    behind = replace(behind, start=tuple(np.array(pipe.end)), end=far)
    joints = [*JOINTS, one]
    solution = adjust(problem_of(views, [*start, behind], joints))
    assert "X" not in solution.undetermined
    assert np.delete(gaps(solution.components, joints), GASKET).max() < EXACT_MM


@pytest.mark.parametrize(
    ("more", "key"), [({"held": {"nobody": frozenset({"position"})}}, "held"), ({"observed": {"nobody": {"D": (1, 1)}}}, "observed")]
)
def test_fixed_value_of_no_component_is_refused_by_name(views, start, more, key):
    with pytest.raises(InputError, match=rf"{key}\.nobody: there is no such component"):
        problem_of(views, start, **more)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ({"held": {"A": frozenset({"bend_radius"})}}, "'bend_radius' is nothing it has"),
        ({"observed": {"A": {"outer_diameter": (np.nan, 1.0)}}}, "positive value and sigma"),
        ({"observed": {"A": {"outer_diameter": (100.0, 0.0)}}}, "positive value and sigma"),
        ({"joints": (Joint(a="A", a_port=2, b="E", b_port=0),)}, "there is no port 2 of 'A'"),
        ({"joints": (Joint(a="A", a_port=0, b="nobody", b_port=0),)}, "there is no port 0 of 'nobody'"),
    ],
)
def test_values_that_fit_nothing_are_refused(views, start, more, text):
    with pytest.raises(InputError, match=text):
        problem_of(views, start, **more)


def test_two_components_of_one_name_are_refused(start):
    with pytest.raises(InputError, match="two have the same id"):
        Problem((*start, start[0]), ())


def test_component_that_is_nowhere_is_refused_by_name(views, start):
    with pytest.raises(InputError, match="D: its ends are not all numbers"):
        problem_of(views, with_part(start, "D", start=(np.nan, 3000.0, 0.0)))


@pytest.mark.parametrize("more", [{"sigma_position": 0.0}, {"sigma_rotation": np.nan}, {"free_cameras": frozenset({3})}])
def test_station_whose_freedom_makes_no_sense_is_refused_by_name(views, more):
    with pytest.raises(InputError, match="station S"):
        StationViews("S", views, free=True, **more)


@pytest.mark.parametrize("sigmas", [{}, {"sigma_position": 5.0}, {"sigma_rotation": 1e-3}])
def test_stations_that_are_all_anywhere_are_refused(views, start, sigmas):
    with pytest.raises(InputError, match="at least one station must be held, or its pose known with a sigma"):
        Problem(start, (StationViews("S", views, free=True, **sigmas),), JOINTS)
    # what is fixed holds them
    fixed = tuple(replace(one, fixed=one.id == "A") for one in start)
    Problem(fixed, (StationViews("S", views, free=True, **sigmas),), JOINTS)


def test_station_that_sees_nothing_is_said_to(views, start):
    """Its pose is what was known before, and the others are as they are without it."""
    blind = [without_edges(view) for view in views]
    solution = adjust(Problem(start, (StationViews("S", views), StationViews("blind", blind, SIDE, free=True)), JOINTS))
    assert any(text.startswith("station blind: none of its edges") for text in solution.warnings)
    assert not any("station S" in text for text in solution.warnings)
    assert solution.stations["blind"].frame_from_level == pytest.approx(SIDE)
    assert_true(solution)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("ranges", ()),
        ("ranges", (3.0, 0.0)),
        ("ranges", (np.inf,)),
        ("spacing", 0.0),
        ("spacing", np.nan),
        ("most_samples", 0),
        ("iterations", 0),
        ("tukey", -1.0),
        ("step", 0.0),
        ("slide", -1.0),
        ("offset_sigma", 0.0),
        ("diameter_tolerance", (0.0, 0.5)),
        ("variance_rounds", -1),
        ("snooping", np.nan),
        ("weak_sigma", -1.0),
    ],
)
def test_settings_that_make_no_sense_are_refused_by_name(name, value):
    with pytest.raises(InputError, match=f"the adjustment: {name}: "):
        AdjustmentSettings(**{name: value})


def test_ranges_need_not_descend():
    assert AdjustmentSettings(ranges=(2.0, 5.0), slide=0.0, variance_rounds=0).ranges == (2.0, 5.0)


def test_two_stations_of_one_name_are_refused(views, start):
    with pytest.raises(InputError, match="two have the same name"):
        Problem(start, (StationViews("S", views), StationViews("S", views)), JOINTS)


def test_sizes_that_contradict_each_other_at_a_joint_are_gross_errors(views, start):
    """Both are standard sizes and stay; nobody fixed them."""
    solution = adjust(problem_of(views, with_part(start, "E", outer_diameter=114.8)))
    assert {"A - E: diameter", "E - B: diameter"} <= {one.what for one in solution.gross}


def straight_on(elbow, degrees):
    """Return an elbow's end so that its axes meet at an angle, its start and its corner as they are."""
    come = np.subtract(elbow.intersection, elbow.start)
    normal = unit(np.cross(come, np.subtract(elbow.end, elbow.intersection)))
    return tuple(np.add(elbow.intersection, Rotation.from_rotvec(np.radians(degrees) * normal).apply(come)))


NO_BENDS = {
    "in line": lambda elbow: {"end": straight_on(elbow, 0.0)},
    "nearly in line": lambda elbow: {"end": straight_on(elbow, 0.3)},
    "turning back": lambda elbow: {"end": straight_on(elbow, 179.5)},
    "end at its start": lambda elbow: {"end": elbow.start},
    "angle of nothing": lambda _: {"angle_deg": 0.1},
    "in line and fixed": lambda elbow: {"end": straight_on(elbow, 0.0), "fixed": True},
}


@pytest.mark.parametrize("how", NO_BENDS)
def test_elbow_that_does_not_bend_stays_and_moves_nobody(views, start, how):
    given = with_part(start, "E", **NO_BENDS[how](of(start, "E")))
    solution = adjust(problem_of(views, given))
    assert of(solution.components, "E") is of(given, "E")
    assert set(solution.undetermined) == {"E"}
    assert "is no bend" in solution.undetermined["E"]
    assert any(text.startswith("E:") for text in solution.warnings)
    assert solution.converged
    # nothing is drawn to it: the others are where images and the other joints put them
    others = [one for one in solution.components if one.id != "E"]
    assert_true(replace(solution, components=tuple(others)), [one for one in TRUTH if one.id != "E"], JOINTS[2:], 1)


def test_elbow_that_bends_by_a_little_is_one():
    elbow = bend(angle_deg=1.0, bend_radius=5000.0)
    solution = adjust(problem_of(views_of([elbow]), [elbow], ()))
    assert "no bend" not in str(solution.undetermined)


@pytest.mark.parametrize("name", ["position", "normal", "sigma", "smoothing"])
def test_edges_that_are_no_numbers_are_left_out_with_a_warning(views, start, solved, name):
    edges = views[0].edges
    column = getattr(edges, name).copy()
    column[::40] = np.nan
    solution = adjust(problem_of([replace(views[0], edges=replace(edges, **{name: column})), *views[1:]], start))
    assert len(solution.warnings) == 1
    assert f"image left: {len(column[::40])} of {len(edges)} edge points" in solution.warnings[0]
    assert_true(solution)
    assert errors(solution.components, solved.components).position == pytest.approx(0.0, abs=0.3)


def test_image_whose_edges_are_all_no_numbers_is_as_none(views, start):
    edges = views[0].edges
    broken = replace(views[0], edges=replace(edges, position=np.full_like(edges.position, np.nan)))
    solution = adjust(problem_of([broken, *views[1:]], start))
    assert "all" in solution.warnings[0] or f"{len(edges)} of {len(edges)}" in solution.warnings[0]
    assert_true(solution)


def without_edges(view):
    edges = view.edges
    columns = {name: getattr(edges, name)[:0] for name in edges.__dataclass_fields__ if name != "index"}
    return replace(view, edges=type(edges)(**columns, index=np.full_like(edges.index, -1)))


def test_images_without_edges_move_nothing(views, start):
    solution = adjust(problem_of([without_edges(view) for view in views], start))
    assert all(one is other for one, other in zip(solution.components, start, strict=True))
    assert set(solution.undetermined) == {one.id for one in start}
    assert solution.unknowns == 0


def test_one_image_without_edges_leaves_it_to_the_others(views, start):
    assert_true(adjust(problem_of([*views[:2], without_edges(views[2])], start)))


@pytest.mark.parametrize("stations", [(), (StationViews("S", ()),)], ids=["no station", "no image"])
def test_no_images_move_nothing(start, stations):
    solution = adjust(Problem(start, stations, JOINTS))
    assert all(one is other for one, other in zip(solution.components, start, strict=True))
    assert set(solution.undetermined) == {one.id for one in start}


def test_nothing_to_adjust_is_no_error(views):
    for problem in (Problem((), ()), problem_of(views, (), ())):
        solution = adjust(problem)
        assert solution.components == ()
        assert solution.unknowns == 0
        assert solution.message == "there is nothing to adjust"


def test_components_that_are_all_fixed_stay(views):
    given = tuple(replace(one, fixed=True) for one in TRUTH)
    solution = adjust(problem_of(views, given))
    assert all(one is other for one, other in zip(solution.components, given, strict=True))
    assert not solution.estimates


def test_covariance_of_what_was_not_adjusted_is_refused(views, start):
    solution = adjust(problem_of(views, [*start, UNSEEN["behind the cameras"]]))
    with pytest.raises(InputError, match="was not adjusted"):
        solution.covariance("X")


# ---------------------------------------------------------------- weak geometry


def test_pipe_along_the_base_of_two_cameras_is_weak_towards_them():
    truth = level((1.0, 0.0, 0.0), "W")
    views = views_of([truth], LITTLE, seen_by=cameras(2))
    solution = adjust(problem_of(views, off([truth], position_mm=2.0), ()))
    (weak,) = solution.weak
    assert weak.component == "W"
    assert "parallel to the cameras' base" in weak.reason
    sight = unit(np.array(TARGET) - np.mean([camera.projection_centre for camera in cameras(2)], axis=0))
    assert abs(np.dot(weak.direction, sight)) > np.cos(np.radians(5.0))
    across = perpendicular_axes(np.array([1.0, 0.0, 0.0]))
    covariance = solution.estimates["W"].covariance
    assert weak.sigma == pytest.approx(max(np.sqrt(np.linalg.eigvalsh(np.array(across) @ covariance @ np.array(across).T))), rel=1e-3)


def test_pipe_across_the_base_is_not_weak():
    truth = level((0.1, 0.1, 1.0), "W")
    solution = adjust(problem_of(views_of([truth], LITTLE, seen_by=cameras(2)), off([truth]), ()))
    assert not solution.weak
    assert_true(solution, [truth], (), [])


def test_what_a_fixed_neighbour_places_to_a_tenth_of_a_millimetre_is_not_weak(views, start):
    given = tuple(replace(of(TRUTH, "B"), fixed=True) if one.id == "B" else one for one in start)
    solution = adjust(problem_of(views, given))
    assert all(np.linalg.norm(solution.estimates[name].sigma_position) < 0.2 for name in "EF")
    assert not {"E", "F"} & {weak.component for weak in solution.weak}


def test_third_camera_away_from_the_base_makes_a_pipe_along_it_sure():
    truth = level((1.0, 0.0, 0.0), "W")
    two, three = (adjust(problem_of(views_of([truth], LITTLE, seen_by=cameras(count)), off([truth]), ())) for count in (2, 3))
    sigma = [np.linalg.norm(one.estimates["W"].sigma_position) for one in (two, three)]
    assert sigma[1] < sigma[0] / 3
    assert not three.weak


def test_edges_of_other_polarity_beside_a_pipe_do_not_draw_it():
    """A dark line along the pipe: one of its edges is as near as the pipe's, but brighter on the other side."""
    truth = level((0.3, 0.2, 1.0), "W")
    views = views_of([truth], LITTLE)
    # a second edge 3 px outside, turned round, for all points of the first
    spoilt = []
    for view in views:
        edges = view.edges
        outside = with_edges(view, np.arange(len(edges)), 3.0).edges
        columns = {
            name: np.concatenate([getattr(edges, name), getattr(outside, name)])
            for name in edges.__dataclass_fields__
            if name not in ("index", "normal")
        }
        both = replace(view, edges=type(edges)(**columns, normal=np.concatenate([edges.normal, -edges.normal]), index=edges.index))
        spoilt.append(with_edges(both, []))
    clean, drawn = (adjust(problem_of(some, off([truth]), ())) for some in (views, spoilt))
    assert position_errors(drawn, [truth])[0] < position_errors(clean, [truth])[0] + 0.3
