# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statistics of the adjustment: redundancy, data snooping and variance factors against theory and planted errors."""

from dataclasses import replace

import numpy as np
import pytest
from parts import DIAMETER, run, with_edges
from simulated import Noise, simulated_edges, simulated_views
from synthetic import cameras

from pipeworkbench.recon.adjust import AdjustmentSettings, Problem, StationViews, adjust
from pipeworkbench.recon.adjustment.conditions import FREE_SIGMA
from pipeworkbench.recon.adjustment.linearisation import Variances, linearised, sampled
from pipeworkbench.recon.adjustment.normal_equations import LEAST_INFORMATION
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.adjustment.variances import assessed, estimated, near
from pipeworkbench.recon.views import View

COMPONENTS, JOINTS = run()
SETTINGS = AdjustmentSettings()
# what the settings expect of edges of 0.1 px: sqrt(0.05^2 + (0.8 0.1)^2) and sqrt(0.02^2 + (0.5 0.1)^2) px
ASSUMED = Noise(sigma=0.1, common=0.0943, trend=0.0539)
BRIGHTER = np.ones(len(COMPONENTS), bool)
SHIFT_PX = 1.5


def problem_of(views, **more):
    return Problem(COMPONENTS, (StationViews("S", views, **more),), JOINTS)


def views_of(noise, seed):
    return simulated_views(cameras(), COMPONENTS, np.random.default_rng(seed), noise, BRIGHTER)


@pytest.fixture(scope="module")
def usual():
    return views_of(ASSUMED, 3)


@pytest.fixture(scope="module")
def solved(usual):
    return adjust(problem_of(usual))


def linear_of(problem, settings=SETTINGS):
    state = State.of(problem, settings)
    return linearised(state, sampled(state, settings), 2.0, Variances(), settings)


# ---------------------------------------------------------------- redundancy


@pytest.mark.parametrize("sizes", ["exact", "tolerance", "free"])
@pytest.mark.parametrize("free", [False, True])
def test_redundancy_numbers_sum_to_observations_minus_unknowns(usual, sizes, free):
    settings = replace(SETTINGS, sizes=sizes)
    linear = linear_of(problem_of(usual, free=free, sigma_position=1.0, sigma_rotation=1e-3), settings)
    found = assessed(linear, Variances(), settings)
    # what is known before, a station's prior and what keeps all in place, are observations with a redundancy of their own
    matrix = linear.equations.matrix.toarray()
    scale = 1 / np.sqrt(np.diag(matrix))
    covariance = np.linalg.inv(matrix * np.outer(scale, scale)) * np.outer(scale, scale)
    before = LEAST_INFORMATION * np.trace(covariance)
    if free:
        before += np.diag(covariance)[-6:] @ np.repeat([1.0, 1.0], 3)
    observations = linear.groups.effective.sum() + len(linear.observed)
    total = found.redundancy.sum() + found.pseudo_redundancy.sum()
    assert total == pytest.approx(observations - linear.unknowns.total + before, abs=5e-3)  # some 30 conditions, each to 1e-4


def test_redundancy_numbers_of_pseudo_observations_are_parts_of_one(solved):
    numbers = np.array([row.redundancy for row in solved.pseudo])
    assert numbers.min() > -1e-4
    assert numbers.max() < 1 + 1e-9


def test_solution_counts_independent_observations(solved):
    samples = sum(fit.found for fit in solved.contours)
    assert 0.2 * samples < solved.observations < samples + len(solved.pseudo)
    soft = sum(row.sigma < FREE_SIGMA / 2 for row in solved.pseudo)
    # samples 4 px apart whose errors are alike over 2 sqrt(pi) 1.9 px
    assert solved.observations - soft == pytest.approx(samples * 4.0 / (2 * np.sqrt(np.pi) * 1.9), rel=0.15)
    assert solved.redundancy == pytest.approx(solved.observations - solved.unknowns)


def test_share_that_others_check_is_between_nothing_and_all(usual):
    found = assessed(linear_of(problem_of(usual)), Variances(), SETTINGS)
    assert (found.checked > -1e-9).all()
    assert (found.checked < 1).all()
    # three images of both sides of a pipe: most of a common error shows
    assert np.median(found.checked) > 0.3


def test_one_image_checks_less_than_three(usual):
    linear = [linear_of(problem_of(views)) for views in (usual[:1], usual)]
    share = [np.median(assessed(one, Variances(), SETTINGS).checked) for one in linear]
    assert share[0] < share[1]


# ---------------------------------------------------------------- gross errors


def planted(component, shift, seed=3):
    """Return views in which the edges of one side of a component are shifted in the first image, and the other edges are not."""
    random = np.random.default_rng(seed)
    made = [simulated_edges(camera, COMPONENTS, random, ASSUMED, BRIGHTER) for camera in cameras()]
    picture = np.broadcast_to(np.float32(0), made[0].edges.index.shape)
    views = [View(camera, one.edges, picture) for camera, one in zip(cameras(), made, strict=True)]
    ours = made[0].component == component
    side = made[0].curve[ours].min()
    return [with_edges(views[0], np.flatnonzero(ours & (made[0].curve == side)), shift), *views[1:]]


@pytest.mark.parametrize(("component", "shift"), [(0, -SHIFT_PX), (2, SHIFT_PX), (6, SHIFT_PX)])
def test_contour_that_is_shifted_has_the_largest_w_and_is_left_out(component, shift):
    problem, name = problem_of(planted(component, shift)), COMPONENTS[component].id
    found = adjust(problem, replace(SETTINGS, variance_rounds=0))
    w = sorted((abs(np.nan_to_num(fit.w)), fit.component, fit.image, fit.contour) for fit in found.contours)
    assert w[-1][1:3] == (name, "left")
    assert w[-1][0] > 2 * max(SETTINGS.snooping, w[-2][0])
    out = [one.what for one in adjust(problem).gross if one.left_out]
    assert f"{name}: {w[-1][3]} in S/left" in out
    # another one may go by chance
    assert len(out) <= 2


@pytest.mark.parametrize("component", [0, 2, 6])
def test_contour_that_is_left_out_says_by_how_much_it_is_off(component):
    solution = adjust(problem_of(planted(component, SHIFT_PX)))
    largest = solution.gross[0]
    assert largest.left_out
    # three standard deviations of what the contour is off besides
    assert abs(largest.size) == pytest.approx(SHIFT_PX, abs=3 * ASSUMED.common)
    assert abs(largest.w) > 2 * SETTINGS.snooping
    sizes = [abs(one.w) for one in solution.gross]
    assert sizes == sorted(sizes, reverse=True)
    (fit,) = [fit for fit in solution.contours if f"{fit.component}: {fit.contour} in {fit.station}/{fit.image}" == largest.what]
    assert (fit.offset, fit.w) == (largest.size, largest.w)


def test_contour_left_out_has_the_w_that_it_had_before_it_was():
    """How far it is off from all others does not depend on what it counts itself: Baarda's w is that of the deleted residual.

    But for its trend, which says a little too.
    """
    problem = problem_of(planted(6, 0.3))
    state = State.of(problem, SETTINGS)
    samples = sampled(state, SETTINGS)
    linear = linearised(state, samples, 2.0, Variances(), SETTINGS)
    counting = assessed(linear, Variances(), SETTINGS)
    row = int(np.flatnonzero(linear.groups.owner == 6)[0])
    left_out = Variances(left_out=np.arange(len(linear.groups)) == row)
    deleted = assessed(linearised(state, samples, 2.0, left_out, SETTINGS), left_out, SETTINGS)
    assert deleted.offset[row] == pytest.approx(counting.offset[row], rel=0.02)
    assert deleted.w[row] == pytest.approx(counting.w[row], rel=0.02)
    factor = np.ones(len(linear.groups))
    factor[row] = 0.2
    less = Variances(factor=factor)
    weaker = assessed(linear.weighted(less, SETTINGS), less, SETTINGS)
    assert weaker.w[row] == pytest.approx(counting.w[row], rel=0.02)
    # and where it has full weight it is what Baarda defined: the residual in its own standard deviations
    variance = Variances().of(linear.groups, SETTINGS)[row, 0] - counting.posterior[row, 0]
    assert counting.w[row] == pytest.approx(counting.systematic[row, 0] / np.sqrt(variance), rel=1e-9)


def test_contours_that_fit_after_all_are_let_back_in():
    """With a limit as low as this, contours go whose w is less as soon as another one has gone, too."""
    solutions = [adjust(problem_of(views_of(ASSUMED, seed)), replace(SETTINGS, snooping=1.5)) for seed in range(2)]
    out = [one for solution in solutions for one in solution.gross if one.left_out]
    assert out
    # where another one comes back everything moves a little
    assert min(abs(one.w) for one in out) > 0.9 * 1.5


def test_contours_of_a_component_whose_size_is_contradicted_are_not_left_out(usual):
    problem = replace(problem_of(usual), observed={"D": {"outer_diameter": (66.0, 0.2)}})
    assert not [one for one in adjust(problem).gross if one.left_out and one.what.startswith("D")]


@pytest.mark.slow
def test_contour_that_is_left_out_hardly_changes_the_result():
    clean, spoilt = (adjust(problem_of(planted(0, shift))) for shift in (0.0, SHIFT_PX))
    here, there = (np.add(one.components[0].start, one.components[0].end) / 2 for one in (clean, spoilt))
    sigma = np.linalg.norm(clean.estimates["A"].sigma_position)
    # one side of six is missing then
    assert np.linalg.norm(here - there) < 2 * sigma
    drawn = adjust(problem_of(planted(0, SHIFT_PX)), replace(SETTINGS, variance_rounds=0)).components[0]
    assert np.linalg.norm(here - np.add(drawn.start, drawn.end) / 2) > np.linalg.norm(here - there)


@pytest.mark.slow
def test_usual_errors_are_no_gross_ones():
    found = [len(adjust(problem_of(views_of(ASSUMED, seed))).gross) for seed in range(2)]
    # some 40 contours each, of which 0.1 % by chance
    assert sum(found) <= 2


def test_standardised_errors_of_contours_are_standard_normal():
    w = []
    for seed in range(3):
        found = assessed(linear_of(problem_of(views_of(ASSUMED, 20 + seed))), Variances(), SETTINGS)
        w += found.w[np.isfinite(found.w)].tolist()
    # at the truth, where nothing has been fitted yet, they are a little larger than 1
    assert 0.7 < np.sqrt(np.mean(np.square(w))) < 1.7


def test_diameter_observed_wrongly_is_found_among_the_pseudo_observations(usual):
    problem = replace(problem_of(usual), observed={"D": {"outer_diameter": (66.0, 0.2)}})
    solution = adjust(problem)
    assert any(one.what == "D: outer_diameter" and abs(one.w) > SETTINGS.snooping for one in solution.gross)
    (fit,) = [one for one in solution.pseudo if one.what == "D: outer_diameter"]
    assert fit.residual < 0  # less than what is observed
    assert fit.sigma == pytest.approx(0.1)


# ---------------------------------------------------------------- variance factors


def factors(noise, seeds):
    found = [adjust(problem_of(views_of(noise, seed))) for seed in seeds]
    return {name: np.mean([one.variance_factors[name] for one in found]) for name in ("image", "common", "trend")}, found


@pytest.mark.slow
def test_variance_factors_are_one_where_the_noise_is_as_assumed():
    mean, found = factors(ASSUMED, range(4))
    for name, value in mean.items():
        assert 0.6 < value < 1.5, name
    assert 0.8 < np.mean([one.sigma0 for one in found]) < 1.2


@pytest.mark.slow
@pytest.mark.parametrize(("name", "noise"), [("common", replace(ASSUMED, common=0.25)), ("trend", replace(ASSUMED, trend=0.2))])
def test_variance_factor_grows_with_what_it_is_the_factor_of(name, noise):
    usual_factors, _ = factors(ASSUMED, range(2))
    larger, found = factors(noise, range(2))
    assert larger[name] > 2 * usual_factors[name]
    expected = {"common": 0.25, "trend": 0.2}[name]
    measured = np.mean([getattr(one, f"{name}_sigma") for one in found])
    assert 0.35 * expected < measured < 1.5 * expected


def test_sigmas_grow_with_the_noise_that_edges_do_not_know_of():
    def noisy(sigma):
        views = views_of(Noise(sigma=sigma), 5)
        return adjust(problem_of([with_edges(view, [], sigma=np.full(len(view.edges), 0.1)) for view in views]))

    quiet, loud = noisy(0.1), noisy(0.4)
    assert quiet.sigma_image == pytest.approx(0.1, rel=0.25)
    assert loud.sigma_image == pytest.approx(0.4, rel=0.25)
    for name, estimate in loud.estimates.items():
        assert np.linalg.norm(estimate.sigma_position) > 1.5 * np.linalg.norm(quiet.estimates[name].sigma_position), name


def test_factors_that_differ_by_little_make_no_difference():
    assert near(Variances(), Variances(1.1, 0.9))
    assert not near(Variances(), Variances(1.5, 1.0))


def test_variances_are_a_fixed_point_at_the_expected_ones(usual):
    """Estimated from residuals that are exactly as expected, the factors would be one: from ones near to it, near to one."""
    linear = linear_of(problem_of(usual))
    found = estimated(linear, Variances(), SETTINGS)
    assert 0.4 < found.common < 2.5
    assert 0.4 < found.trend < 2.5
    assert found.factor.max() <= (SETTINGS.common_freedom + 2) / SETTINGS.common_freedom
    assert DIAMETER == COMPONENTS[0].outer_diameter
