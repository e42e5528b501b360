# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tees: the branch's saddle and the run's hole are one curve in space, areas are those of the cut cylinders."""

import math

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st
from pattern_checks import check_all, common, from_sides, marks

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns import patterns_of_covering
from pipeworkbench.insulation.patterns.tees import PLAY_MM, hole, saddle
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.covering_quantities import hole_area
from pipeworkbench.solids.coverings import Notch, TeeCovering

SEAMS = Seams()
GROWN = 50.4


def tee(radius=57.15, branch_radius=44.45, angle_deg=90.0, reach=400.0, **more):
    return TeeCovering(
        **common("T1", **more), radius=radius, begin=-450.0, end=500.0, branch_radius=branch_radius, branch_angle=math.radians(angle_deg), reach=reach
    )


def on_branch(covering, points, radius):
    """Roll points of the branch's pattern up: x around from the seam, y along the branch from the run's axis."""
    beta = covering.branch_angle
    theta = points[:, 0] / radius + (0.0 if beta <= math.pi / 2 else math.pi)
    along, back = np.array([math.sin(beta), 0.0, math.cos(beta)]), np.array([math.cos(beta), 0.0, -math.sin(beta)])
    return points[:, 1:] * along + radius * (np.cos(theta)[:, None] * back + np.sin(theta)[:, None] * np.array([0.0, 1.0, 0.0]))


def on_run(covering, points, radius, seam=math.pi):
    """Roll points of the run's pattern up: x along the run from its begin, -y around from the seam."""
    angles = seam - points[:, 1] / radius
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), points[:, 0] + covering.begin])


def run_hole(pattern):
    return max(pattern.holes, key=lambda path: path.area)


def dense(path):
    """Return many points of a path, evenly along each of its arcs."""
    count = len(path.segments[2])
    return path.at(np.repeat(np.arange(count), 100), np.tile(np.arange(100) / 100, count))


@settings(deadline=None, max_examples=8, phases=(Phase.explicit, Phase.generate))
@example(45.0, 15.0, 1.0)
@example(135.0, 100.0, 0.05)
@given(st.floats(45, 135), st.floats(15, 100), st.floats(0.05, 1.0))
def test_saddle_and_hole_are_the_same_curve_in_space(angle_deg, radius, ratio):
    covering = tee(radius, radius * ratio, angle_deg)
    run, branch = patterns_of_covering(covering, SEAMS)
    edge = dense(marks(branch, "FOLD")[0])
    width = 2 * math.pi * (covering.branch_radius + GROWN)
    edge = on_branch(covering, edge[edge[:, 0] <= width], covering.branch_radius + GROWN)
    border = on_run(covering, dense(run_hole(run)), covering.radius + GROWN)
    # both are closed curves
    assert from_sides(edge, np.vstack([border, border[:1]])).max() < 0.05
    assert from_sides(border, np.vstack([edge, edge[:1]])).max() < 0.05


@given(st.floats(20, 160), st.floats(50, 300), st.floats(0.02, 1.0))
def test_the_saddle_lies_on_both_cylinders(angle_deg, radius, ratio):
    beta, branch = math.radians(angle_deg), radius * ratio
    theta = np.linspace(0, 2 * math.pi, 37)
    s = saddle(radius, branch, beta, theta)
    x, y = s * math.sin(beta) + branch * np.cos(theta) * math.cos(beta), branch * np.sin(theta)
    assert np.hypot(x, y) == pytest.approx(radius)
    assert (x >= -1e-6).all()


@pytest.mark.parametrize(("branch_radius", "angle_deg"), [(44.45, 90.0), (44.45, 60.0), (30.0, 45.0), (57.15, 90.0), (50.0, 120.0)])
def test_net_areas_are_those_of_the_cut_cylinders(branch_radius, angle_deg):
    import cadquery as cq

    covering = tee(branch_radius=branch_radius, angle_deg=angle_deg)
    run_radius, radius = covering.radius + GROWN, branch_radius + GROWN
    beta = covering.branch_angle
    run = cq.Solid.makeCylinder(run_radius, 950, cq.Vector(0, 0, -450), cq.Vector(0, 0, 1))
    branch = cq.Solid.makeCylinder(radius, 400, cq.Vector(0, 0, 0), cq.Vector(math.sin(beta), 0, math.cos(beta)))

    def round_area(solid, about):
        faces = [face for face in solid.Faces() if face.geomType() == "CYLINDER"]
        return sum(face.Area() for face in faces if abs(face._geomAdaptor().Cylinder().Axis().Direction().Z()) == pytest.approx(about, abs=1e-6))

    both = run.fuse(branch)
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    assert [pattern.kind for pattern in patterns] == ["run", "branch"]
    assert patterns[0].net_area == pytest.approx(round_area(both, 1.0), rel=1e-4)
    assert patterns[1].net_area == pytest.approx(round_area(both, abs(math.cos(beta))), rel=1e-4)


def test_equal_radii_give_corners_at_both_sides():
    run, branch = check_all(patterns_of_covering(tee(branch_radius=57.15), SEAMS))
    edge = marks(branch, "FOLD")[0]
    radius = 57.15 + GROWN
    # the saddle goes down to the run's axis at a quarter and three quarters of the circumference
    for share in (0.25, 0.75):
        corner = edge.points[np.argmin(abs(edge.points[:, 0] - share * 2 * math.pi * radius))]
        assert corner == pytest.approx((share * 2 * math.pi * radius, 0.0), abs=1e-5)
    left, bottom, right, top = run_hole(run).bounds
    assert (right - left, top - bottom) == pytest.approx((2 * radius, math.pi * radius), abs=0.02)


@settings(deadline=None, max_examples=6)
@given(st.floats(1e-9, 0.05), st.floats(45, 135))
def test_nearly_equal_radii_can_be_cut(less, angle_deg):
    radius = 57.15 + GROWN
    check_all(patterns_of_covering(tee(branch_radius=radius * (1 - less) - GROWN, angle_deg=angle_deg), SEAMS))


def test_a_bare_branch_leaves_a_hole_with_play():
    (pattern,) = check_all(patterns_of_covering(tee(reach=0.0), SEAMS))
    assert pattern.kind == "run"
    left, bottom, right, top = run_hole(pattern).bounds
    assert right - left == pytest.approx(2 * (44.45 + PLAY_MM), abs=0.04)
    assert top - bottom == pytest.approx(2 * (57.15 + GROWN) * math.asin((44.45 + PLAY_MM) / (57.15 + GROWN)), abs=0.04)


def test_the_net_area_of_a_bare_branch_s_run_knows_no_play():
    covering = tee(reach=0.0)
    (run,) = patterns_of_covering(covering, SEAMS)
    radius = 57.15 + GROWN
    assert run.net_area == pytest.approx(2 * math.pi * radius * 950 - hole_area(radius, 44.45, math.pi / 2), rel=1e-6)


def test_the_runs_seam_keeps_away_from_the_branch():
    for seam, expected in ((0.0, math.pi), (0.5, math.pi), (2.5, 2.5)):
        run, _ = check_all(patterns_of_covering(tee(seam=seam), SEAMS))
        points = on_run(tee(), run_hole(run).sampled(0.01), 57.15 + GROWN, expected)
        assert np.hypot(points[:, 1], (points[:, 2])).max() < 100
        assert (points[:, 0] > 0).all()


def test_the_rim_of_the_saddle_is_folded():
    _, branch = patterns_of_covering(tee(), SEAMS)
    fold = marks(branch, "FOLD")[0]
    assert branch.outline.bounds[1] == pytest.approx(fold.bounds[1] - 8.0, abs=0.03)


def test_notches_meet_run_and_branch_alike():
    notch = Notch("bar", np.array([300.0, -400.0, 0.0]), np.array([300.0, 400.0, 0.0]), 25.0)
    run, branch = check_all(patterns_of_covering(tee(notches=(notch,)), SEAMS))
    plain_run, plain_branch = patterns_of_covering(tee(), SEAMS)
    assert run.net_area == pytest.approx(plain_run.net_area)
    # through both sides of the branch
    assert len([path for path in branch.holes if path.area > 100]) == 2
    assert plain_branch.net_area - branch.net_area > 2 * math.pi * 25**2


def test_long_runs_are_parted_through_the_hole_too():
    size = SheetSize(width=620.0, height=1000.0)
    patterns = check_all(patterns_of_covering(tee(), SEAMS, size))
    whole = patterns_of_covering(tee(), SEAMS)
    assert sum(p.quantity for p in patterns if p.kind == "run") == 2
    assert sum(p.net_area * p.quantity for p in patterns) == pytest.approx(sum(p.net_area for p in whole), rel=1e-6)


def test_a_branch_wider_than_the_run_is_refused_with_the_widest_that_works():
    with pytest.raises(InputError, match=r"T1: branch_diameter: .* 215\.1 mm wide at most"):
        patterns_of_covering(tee(branch_radius=60.0), SEAMS)


def test_a_branch_that_is_covered_too_short_is_refused_with_what_it_needs():
    with pytest.raises(InputError, match=r"T1: reach: .* cover more than 107\.6 mm"):
        patterns_of_covering(tee(reach=100.0), SEAMS)
    check_all(patterns_of_covering(tee(reach=107.6), SEAMS))


def test_hole_area_is_that_of_the_elliptic_integrals():
    from scipy.special import ellipe, ellipk

    radius, branch, beta = 100.0, 60.0, math.radians(50)
    m = (branch / radius) ** 2
    area = 4 * radius**2 * (ellipe(m) - (1 - m) * ellipk(m)) / math.sin(beta)
    assert hole(radius, branch, beta).area == pytest.approx(area, rel=1e-4)
