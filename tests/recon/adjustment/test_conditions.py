# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pseudo-observations: what they say of components that fit and that do not, and their derivatives against differences."""

from dataclasses import replace

import numpy as np
import pytest
from parts import BRANCH, DIAMETER, attached, bend, cone, dish, in_pose, plate, richardson, straight, tee
from scipy.spatial.transform import Rotation
from single import Row, port_of, rows_of, with_pipe_ends
from single import changed as moved
from synthetic import TARGET

from pipeworkbench.pipeline import Elbow, Joint, Pipe
from pipeworkbench.recon.adjustment.charts import MOTION, RIGID
from pipeworkbench.recon.adjustment.conditions import FREE_SIGMA
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.bodies import SIZE_NAMES
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.vectors import unit

ACCURACY = 1e-6
GASKET = 2.0
FREE = AdjustmentSettings(sizes="free", gasket=GASKET)
TOLERANCE = AdjustmentSettings(sizes="tolerance")
OTHER = {"name": "other"}
# one, its port, the other, its port, the gap between them (mm)
JOINTS = {
    "pipe-elbow": (straight(), 1, bend(), 0, 0.0),
    "elbow-pipe": (bend(), 1, straight(), 0, 0.0),
    "pipe-flange": (straight(), 1, plate(), 1, 0.0),
    "flange-flange": (plate(), 0, plate(**OTHER), 0, GASKET),
    "elbow-flange": (bend(), 1, plate(), 1, 0.0),
    "elbow-elbow": (bend(), 1, bend(angle_deg=45.0, **OTHER), 0, 0.0),
    "tee's start-pipe": (tee(), 0, straight(), 0, 0.0),
    "tee's end-pipe": (tee(), 1, straight(), 0, 0.0),
    "tee's branch-pipe": (tee(), 2, straight(diameter=BRANCH), 1, 0.0),
    "reducer-wide pipe": (cone(), 0, straight(), 1, 0.0),
    "reducer-narrow pipe": (cone(), 1, straight(diameter=BRANCH), 0, 0.0),
    "eccentric reducer-narrow pipe": (cone(aside=12.7), 1, straight(diameter=BRANCH), 0, 0.0),
    "cap-pipe": (dish(), 0, straight(), 1, 0.0),
    "pipe-pipe": (straight(), 1, straight(length=200.0, **OTHER), 0, 0.0),
}
EVERY_JOINT = pytest.mark.parametrize("name", JOINTS)


def joined(name, seed=0):
    """Return two components that fit exactly, in a random pose, and their joint."""
    one, port, other, other_port, gap = JOINTS[name]
    one = in_pose(one, seed)
    other, joint = attached(one, port, other, other_port, gap)
    return (one, other), joint


def all_free(components):
    return {row: frozenset(SIZE_NAMES[type(component)]) for row, component in enumerate(components)}


def rows(components, joints=(), settings=FREE, free=None, **more):
    problem = Problem(components, (), tuple(joints), **more)
    return rows_of(problem, components, all_free(components) if free is None else free, range(len(joints)), settings)


def off_by(components, amount=1.0, seed=1):
    """Return components that are off by some mm and some hundredths of a radian."""
    random = np.random.default_rng(seed)
    return tuple(moved(c, amount * np.concatenate([random.normal(0, 0.3, 3), random.normal(0, 0.003, 3), np.zeros(3)])) for c in components)


def values_after(problem, components, settings, row, motion):
    """Return what the components say after a motion of one of them."""
    there = list(components)
    there[row] = moved(there[row], motion)
    found = rows_of(problem, there, all_free(components), range(len(problem.joints)), settings)
    return np.array([-one.misclosure for one in found])


def step_of(component, column):
    return 1e-3 if column in range(3, RIGID) or (isinstance(component, Elbow) and column == MOTION - 1) else 0.1


def assert_derivatives(problem, components, settings, rel=ACCURACY):
    """All rows change with all motions of all components as their parts say."""
    found = rows_of(problem, components, all_free(components), range(len(problem.joints)), settings)
    assert found
    for row, component in enumerate(components):
        derivative = np.array([sum((part for of, part in one.parts if of == row), np.zeros(MOTION)) for one in found])
        for column in range(RIGID + len(SIZE_NAMES[type(component)])):

            def values(h, row=row, column=column):
                return values_after(problem, components, settings, row, h * np.eye(MOTION)[column])

            truth = richardson(values, step_of(component, column))
            scale = np.maximum(np.abs(derivative).max(axis=1), 1.0)
            assert np.abs(derivative[:, column] - truth).max(initial=0.0) <= rel * scale.max(), (component.id, column, [r.what for r in found])


# ---------------------------------------------------------------- joints


@EVERY_JOINT
def test_components_that_fit_leave_no_misclosure(name):
    components, joint = joined(name)
    found = [row for row in rows(components, [joint]) if row.joint is not None]
    assert max(abs(row.misclosure) for row in found) < 1e-9
    assert {row.joint for row in found} == {0}


@EVERY_JOINT
@pytest.mark.parametrize("seed", range(3))
def test_misclosures_of_a_joint_change_as_their_derivatives_say(name, seed):
    components, joint = joined(name, seed)
    assert_derivatives(Problem(components, (), (joint,)), components, FREE)


@EVERY_JOINT
def test_misclosures_are_the_offset_and_the_kink_that_is_there(name):
    components, joint = joined(name)
    there = off_by(components)
    one, other = there[0].ports[joint.a_port], there[1].ports[joint.b_port]
    apart, kink = np.subtract(other.point, one.point), np.add(one.direction, other.direction)
    axis = unit(one.direction if isinstance(there[0], Pipe) else other.direction)
    found = [row for row in rows(there, [joint]) if row.joint is not None]
    offsets = np.array([row.misclosure for row in found if row.what.endswith(": offset")])
    aside = isinstance(there[0], Pipe) or isinstance(there[1], Pipe) or name == "flange-flange"
    assert len(offsets) == (2 if aside else 3)
    expected = np.linalg.norm(apart - (apart @ axis) * axis) if aside else np.linalg.norm(apart)
    assert np.linalg.norm(offsets) == pytest.approx(expected, rel=1e-9)
    turns = np.array([row.misclosure for row in found if row.what.endswith(": direction")])
    assert np.linalg.norm(turns) == pytest.approx(np.linalg.norm(kink - (kink @ axis) * axis), rel=1e-9)
    assert all(row.exact for row in found if not row.what.endswith("gasket"))


@EVERY_JOINT
def test_conditions_are_as_many_as_a_joint_takes_freedoms(name):
    components, joint = joined(name)
    conditions = [row for row in rows(components, [joint]) if row.joint is not None and not row.what.endswith("diameter")]
    matrix = np.zeros((len(conditions), 2 * MOTION))
    for line, row in enumerate(conditions):
        for of, part in row.parts:
            matrix[line, MOTION * of : MOTION * (of + 1)] = part
    expected = 4 if any(isinstance(one, Pipe) for one in components) else 5
    assert len(conditions) == expected
    assert np.linalg.matrix_rank(matrix, tol=1e-6) == expected


def test_joint_says_the_same_from_both_sides():
    components, joint = joined("pipe-elbow")
    there = off_by(components)
    turned = Joint(a=joint.b, a_port=joint.b_port, b=joint.a, b_port=joint.a_port)
    both = [[row for row in rows(there, [one]) if row.joint is not None] for one in (joint, turned)]
    sizes = [sorted(abs(row.misclosure) for row in some) for some in both]
    assert np.linalg.norm(sizes[0]) == pytest.approx(np.linalg.norm(sizes[1]), rel=1e-6)


def test_flange_faces_are_as_far_apart_as_the_gasket_is_thick():
    one = plate()
    other, joint = attached(one, 0, plate(**OTHER), 0, gap=3.5)
    (gasket,) = [row for row in rows((one, other), [joint]) if row.what.endswith("gasket")]
    # observed minus computed: 2 mm are there instead of 3.5
    assert gasket.misclosure == pytest.approx(GASKET - 3.5)
    assert gasket.sigma == FREE.gasket_sigma
    assert not gasket.exact


def test_diameters_are_alike_at_a_joint_but_not_where_one_changes():
    pipe = straight()
    wider, joint = attached(pipe, 1, straight(diameter=DIAMETER + 0.5, **OTHER), 0)
    (row,) = [row for row in rows((pipe, wider), [joint]) if row.what.endswith(": diameter") and row.joint is not None]
    assert row.misclosure == pytest.approx(0.25)
    much_wider, joint = attached(pipe, 1, straight(diameter=139.7, **OTHER), 0)
    assert not [row for row in rows((pipe, much_wider), [joint]) if row.what.endswith(": diameter") and row.joint is not None]


@EVERY_JOINT
def test_one_step_along_the_conditions_closes_a_joint(name):
    """Newton's method on the conditions alone halves the digits that are wrong: 1 mm becomes far less."""
    components, joint = joined(name)
    there = off_by(components, 0.3)
    sizes = []
    for _ in range(3):
        found = [row for row in rows(there, [joint]) if row.joint is not None]
        sizes.append(max(abs(row.misclosure) for row in found))
        matrix = np.zeros((len(found), 2 * MOTION))
        for line, row in enumerate(found):
            for of, part in row.parts:
                matrix[line, MOTION * of : MOTION * (of + 1)] = part
        scale = np.tile([1, 1, 1, 0.01, 0.01, 0.01, 1, 1, 0.01], 2)
        step = scale * np.linalg.lstsq(matrix * scale, [row.misclosure for row in found], rcond=1e-10)[0]
        there = tuple(moved(c, motion) for c, motion in zip(there, step.reshape(2, MOTION), strict=True))
        there = tuple(with_pipe_ends(there, [joint], frozenset()))
    assert sizes[1] < 0.05 * sizes[0]
    assert sizes[2] < 1e-3 * sizes[0]


# ---------------------------------------------------------------- sizes


@pytest.mark.parametrize("component", [straight(), bend(), plate(), tee(), cone(), dish()], ids=lambda c: c.kind)
def test_observed_sizes_change_as_their_derivatives_say(component):
    component = in_pose(component, 2)
    observed = {component.id: {name: (getattr(component, name) + 1.5, 0.2) for name in SIZE_NAMES[type(component)]}}
    problem = Problem((component,), (), observed=observed)
    assert_derivatives(problem, (component,), FREE)
    for row, name in zip(rows((component,), observed=observed), SIZE_NAMES[type(component)], strict=True):
        one_unit = {"angle_deg": np.radians(1.0), "bend_radius": 1.0, "C": 1.0}.get(name, 0.5)
        assert row.misclosure == pytest.approx(1.5 * one_unit)
        assert row.sigma == pytest.approx(0.2 * one_unit)


def test_standard_sizes_have_the_tolerances_of_their_standards():
    components = (
        straight(dn=100),
        straight("thin", diameter=26.9, dn=20),
        bend(dn=100, bend_type="3D", angle_deg=88.5),
        plate(),
        straight("of no standard", diameter=111.0),
    )
    found = {row.what: row for row in rows(components, settings=TOLERANCE)}
    # +-1 % and 0.5 mm of the diameter hold for 95 %, which are two standard deviations; a radius has half of it
    assert found["pipe: outer_diameter"].sigma == pytest.approx(0.01 * DIAMETER / 4)
    assert found["thin: outer_diameter"].sigma == pytest.approx(0.5 / 4)
    assert found["elbow: bend_radius"].sigma == pytest.approx(0.01 * 152.0 / 2)
    assert found["elbow: angle_deg"].misclosure == pytest.approx(np.radians(1.5))
    assert found["flange: D"].sigma == pytest.approx(0.5)
    assert found["of no standard: outer_diameter"].sigma == FREE_SIGMA / 2


def test_free_sizes_are_held_by_next_to_nothing():
    for row in rows((straight(dn=100), bend(dn=100, bend_type="3D"), plate()), settings=FREE):
        assert row.sigma >= np.radians(1.0) * FREE_SIGMA, row.what
        assert row.misclosure == 0.0


def test_sizes_that_are_no_unknowns_are_not_observed():
    assert not rows((straight(dn=100),), settings=TOLERANCE, free={0: frozenset({"position", "direction"})})


# ---------------------------------------------------------------- level, plumb, square

ALIGNED = replace(FREE, aligned=True)


def along(direction, name="pipe"):
    """Return a pipe in a direction (3,)."""
    way = 200.0 * unit(direction)
    return Pipe(id=name, start=tuple(TARGET - way), end=tuple(TARGET + way), outer_diameter=DIAMETER)


def aligned_rows(component):
    return [row for row in rows((component,), settings=ALIGNED) if not row.what.endswith("diameter") and "bend_radius" not in row.what]


@pytest.mark.parametrize(
    ("component", "whats"),
    [
        (along((0.8, 0.6, 0.02)), ["pipe: level"]),
        (along((0.01, -0.02, 1.0)), ["pipe: plumb", "pipe: plumb"]),
        (along((0.02, 0.01, -1.0)), ["pipe: plumb", "pipe: plumb"]),
        (along((0.5, 0.5, 0.5)), []),
        (along((1.0, 0.0, 0.06)), []),
        (in_pose(bend(angle_deg=91.0), 1), ["elbow: angle_deg", "elbow: square"]),
        (in_pose(bend(angle_deg=94.0), 1), ["elbow: angle_deg"]),
    ],
)
def test_only_what_is_nearly_aligned_is_observed_to_be(component, whats):
    assert [row.what for row in aligned_rows(component)] == whats


@pytest.mark.parametrize(
    "component", [along((0.8, 0.6, 0.02)), along((0.01, -0.02, 1.0)), along((0.02, 0.01, -1.0)), in_pose(bend(angle_deg=91.0), 1)]
)
def test_aligned_rows_change_as_their_derivatives_say(component):
    assert_derivatives(Problem((component,), ()), (component,), ALIGNED)


def test_misclosures_of_aligned_rows_are_the_angles_that_are_off():
    (level,) = aligned_rows(along((1.0, 1.0, np.sqrt(2) * np.tan(0.02))))
    assert -level.misclosure == pytest.approx(np.sin(0.02))
    plumb = aligned_rows(along((np.sin(0.02), 0.0, np.cos(0.02))))
    assert np.linalg.norm([row.misclosure for row in plumb]) == pytest.approx(np.sin(0.02))
    (_, square) = aligned_rows(bend(angle_deg=91.0))
    assert -square.misclosure == pytest.approx(np.radians(1.0))
    assert level.sigma == pytest.approx(np.radians(ALIGNED.aligned_sigma_deg))


# ---------------------------------------------------------------- places

PLACED = {"sigma_position": (0.3, 2.0, 0.7), "sigma_direction_deg": 0.2}


@pytest.mark.parametrize("seed", range(4))
def test_place_rows_change_as_their_derivatives_say(seed):
    given = replace(in_pose(straight(), seed), **PLACED)
    assert_derivatives(Problem((given,), (), placed=frozenset({"pipe"})), (given,), FREE)


@pytest.mark.parametrize("seed", range(4))
def test_place_rows_hold_the_part_of_the_axis_that_was_the_middle(seed):
    given = replace(in_pose(straight(length=300.0), seed), **PLACED)
    # the pipe has grown to one side since, by which its middle went along the axis: nothing has moved
    longer = replace(given, end=tuple(np.array(given.end) + 500.0 * unit(np.subtract(given.end, given.start))))
    problem = Problem((given,), (), placed=frozenset({"pipe"}))
    found = [row for row in rows_of(problem, (longer,), all_free((longer,)), [], FREE) if row.sigma < 100]
    assert len(found) == 4
    assert max(abs(row.misclosure) for row in found) < 1e-9
    assert_derivatives(problem, (longer,), FREE)


def test_places_weigh_as_their_sigmas_say():
    given = replace(along((1.0, 0.0, 0.0)), sigma_position=(9.0, 2.0, 0.7), sigma_direction_deg=0.2)
    shifted = moved(given, np.array([5.0, 1.0, 0.0, 0, 0, 0, 0, 0, 0]))
    problem = Problem((given,), (), placed=frozenset({"pipe"}))
    place = [row for row in rows_of(problem, (shifted,), {0: frozenset()}, [], FREE) if row.what.endswith("place")]
    assert sorted(row.sigma for row in place) == pytest.approx([0.7, 2.0])
    # what it moved along its axis is nothing
    assert sum((row.misclosure / row.sigma) ** 2 for row in place) == pytest.approx((1.0 / 2.0) ** 2)
    turned_by = moved(given, np.array([0, 0, 0, 0, 0.003, 0.004, 0, 0, 0]))
    turns = [row for row in rows_of(problem, (turned_by,), {0: frozenset()}, [], FREE) if row.what.endswith("direction")]
    assert np.linalg.norm([row.misclosure for row in turns]) == pytest.approx(np.sin(0.005))
    assert [row.sigma for row in turns] == pytest.approx([np.radians(0.2)] * 2)


# ---------------------------------------------------------------- ends of pipes


def test_pipes_end_where_their_neighbours_begin():
    elbow = in_pose(bend(), 3)
    pipe, joint = attached(elbow, 1, straight(), 0, gap=12.0)
    _, there = with_pipe_ends((elbow, pipe), [joint], frozenset())
    assert there.start == pytest.approx(elbow.end, abs=1e-9)
    assert there.end == pytest.approx(pipe.end, abs=1e-9)
    # on the axis only, unless it must be exact
    aside = moved(elbow, np.array([*(3.0 * perpendicular_axes(np.array(pipe.ports[0].direction))[0]), 0, 0, 0, 0, 0, 0]))
    _, beside = with_pipe_ends((aside, pipe), [joint], frozenset())
    assert np.linalg.norm(np.subtract(beside.start, aside.end)) == pytest.approx(3.0)
    _, exact = with_pipe_ends((aside, pipe), [joint], frozenset(), exact=True)
    assert exact.start == pytest.approx(aside.end)


def test_pipes_that_are_kept_keep_their_ends_and_are_what_others_end_at():
    pipe = in_pose(straight(), 3)
    other, joint = attached(pipe, 1, straight(**OTHER), 0, gap=10.0)
    kept, there = with_pipe_ends((pipe, other), [joint], frozenset({0}))
    assert kept is pipe
    assert there.start == pytest.approx(pipe.end, abs=1e-9)
    both = with_pipe_ends((pipe, other), [joint], frozenset())
    middle = (np.array(pipe.end) + np.array(other.start)) / 2
    assert both[0].end == pytest.approx(middle)
    assert both[1].start == pytest.approx(middle)


def test_pipe_whose_neighbours_have_changed_places_stays():
    pipe = straight()
    first, one = attached(pipe, 0, bend("first"), 0, gap=-400.0)
    kept = with_pipe_ends((pipe, first), [one], frozenset())[0]
    assert kept.start == pipe.start


def test_port_of_a_moving_pipe_is_where_the_pipe_ends():
    pipe = in_pose(straight(), 3)
    turn = Rotation.from_rotvec([0.1, 0.2, -0.1])
    there = moved(pipe, np.array([1.0, 2, 3, *turn.as_rotvec(), 0, 0, 0]))
    assert port_of(there, 1).point == pytest.approx(np.array(there.end))
    assert isinstance(rows((pipe,))[0], Row)
