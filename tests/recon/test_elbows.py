# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elbows between pipes: found with the right type, not found where there is none, ends at the tangent points."""

from dataclasses import replace

import numpy as np
import pytest
from pipework import CENTRE, corner_of_two, pipe, straight, unit, views

from pipeworkbench.pipeline import Elbow
from pipeworkbench.recon.assemble import complete
from pipeworkbench.recon.elbows import ElbowSettings, candidates_of, detect
from pipeworkbench.recon.ends import ends_of

D = 114.3
RADII = {"2D": 102.0, "3D": 152.0, "5D": 270.0}  # EN 10253 for 114.3 mm


@pytest.mark.slow
@pytest.mark.parametrize(("angle_deg", "turn_deg"), [(90.0, 0.0), (45.0, 60.0)])
@pytest.mark.parametrize("bend_type", RADII)
def test_the_type_of_a_bend_is_found_in_any_plane(bend_type, turn_deg, angle_deg):
    pictures, pipes = corner_of_two(angle_deg, RADII[bend_type], D, turn_deg)
    (found,) = detect(pictures, pipes)
    assert found.bend.bend_type == bend_type
    assert found.bend_radius == pytest.approx(RADII[bend_type], abs=3)
    assert np.linalg.norm(found.corner - CENTRE) < 1.5


@pytest.mark.slow
def test_a_radius_of_no_standard_is_free():
    pictures, pipes = corner_of_two(90.0, 205.0, D)
    (found,) = detect(pictures, pipes)
    assert found.bend is None
    assert found.bend_radius == pytest.approx(205.0, rel=0.01)


@pytest.mark.slow
def test_a_bend_of_an_unknown_diameter_has_a_free_radius():
    pictures, pipes = corner_of_two(90.0, 150.0, 100.0)
    (found,) = detect(pictures, pipes)
    assert found.bend is None
    assert found.bend_radius == pytest.approx(150.0, rel=0.02)


def test_pipes_that_point_at_each_other_without_a_bend_are_no_elbow():
    pictures, pipes = corner_of_two(90.0, 152.0, D)
    bare = views(*(straight(p.start, p.end, D) for p in pipes))
    assert candidates_of(pipes, ends_of(pipes), ElbowSettings())
    assert detect(bare, pipes) == ()
    assert detect(pictures, pipes) != ()


@pytest.fixture(scope="module")
def corner():
    return corner_of_two(90.0, 152.0, D)


def candidates(*pipes, **changes):
    return len(candidates_of(pipes, ends_of(pipes), ElbowSettings(**changes)))


def test_only_ends_whose_axes_meet_are_candidates():
    one = pipe("a", (-600, 3000, 0), (-160, 3000, 0), D)
    other = pipe("b", (0, 3000, -160), (0, 3000, -600), D)
    assert candidates(one, other) == 1
    assert candidates(one, pipe("b", (0, 3060, -160), (0, 3060, -600), D)) == 0  # skew
    assert candidates(one, pipe("b", (0, 3000, -160), (0, 3000, -600), 60.3)) == 0  # another diameter
    assert candidates(one, pipe("b", (0, 3000, -1600), (0, 3000, -2600), D)) == 0  # far away
    assert candidates(one, pipe("b", (100, 3000, 0), (600, 3000, 0), D)) == 0  # in line
    assert candidates(one, pipe("b", (-600, 3000, 300), (-160, 3000, 300), D)) == 0  # parallel


def test_an_object_in_line_beyond_the_corner_indicates_a_tee():
    one = pipe("a", (-600, 3000, 0), (-160, 3000, 0), D)
    other = pipe("b", (0, 3000, -160), (0, 3000, -600), D)
    beyond = pipe("c", (160, 3000, 0), (600, 3000, 0), D)
    assert candidates(one, other, beyond) == 0


def test_standard_angles_can_be_asked_for():
    one = pipe("a", (-600, 3000, 0), (-160, 3000, 0), D)
    direction = unit(np.cos(np.radians(75)), 0, -np.sin(np.radians(75)))
    slanting = pipe("b", np.array([0, 3000, 0]) + 160 * direction, np.array([0, 3000, 0]) + 600 * direction, D)
    assert candidates(one, slanting) == 1
    assert candidates(one, slanting, angle_tolerance_deg=3.0) == 0


def test_an_elbow_already_there_gets_a_neighbour(corner):
    # the second elbow's free end is the corner's first pipe's partner: its end cannot move
    pictures, (first, second) = corner
    bend = Elbow(
        id="S-E00",
        start=(second.start[0], 3000.0, second.start[2] - 152.0),
        end=second.end,
        intersection=second.start,
        angle_deg=90.0,
        bend_radius=152.0,
        outer_diameter=D,
    )
    ends = ends_of([first, bend])
    assert set(ends.owner) == {0, 1}
    assert ends.length[ends.owner == 1] == pytest.approx(0.0)
    assert detect(pictures, [first, bend], taken=frozenset({(0, 1)})) == ()


def test_pipes_end_at_the_tangent_points_and_meet_without_a_kink(corner):
    pictures, pipes = corner
    done = complete(pictures, pipes)
    first, second, elbow = done.components
    assert elbow.id == "S-E00"
    assert elbow.bend_type == "3D"
    assert elbow.standard
    assert elbow.dn is None or elbow.dn == 100
    assert first.end == pytest.approx(elbow.start)
    assert second.end == pytest.approx(elbow.end)
    for port, other in ((elbow.ports[0], first.ports[1]), (elbow.ports[1], second.ports[1])):
        assert np.dot(port.direction, other.direction) == pytest.approx(-1.0, abs=1e-12)
    assert np.linalg.norm(np.subtract(elbow.start, elbow.intersection)) == pytest.approx(152.0 * np.tan(np.radians(elbow.angle_deg) / 2), rel=1e-6)
    assert {(j.a, j.a_port, j.b, j.b_port) for j in done.joints} == {("S-P00", 1, "S-E00", 0), ("S-P01", 1, "S-E00", 1)}
    assert done.warnings == ()


def test_a_fixed_pipe_keeps_its_axis(corner):
    pictures, (first, second) = corner
    fixed = replace(first, fixed=True)
    done = complete(pictures, (fixed, second)).components
    assert np.cross(np.subtract(done[0].end, fixed.start), fixed.ports[1].direction) == pytest.approx(np.zeros(3), abs=1e-6)


def test_nothing_becomes_of_nothing(corner):
    pictures, (first, _) = corner
    assert detect(pictures, ()) == ()
    assert complete(pictures, ()).components == ()
    assert complete(pictures, (first,)).components == (first,)
