# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clashes of insulation: distances against theory and against sampled surfaces, who gives way, and what is cut."""

import dataclasses
import math

import numpy as np
import pytest
from insulated_pipework import DIAMETER, SHEET, Pen, specification, treatment
from pipe_rack import pipe_rack
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from pipeworkbench.insulation.hulls import block, cylinder, signed_distances
from pipeworkbench.insulation.planning import plan
from pipeworkbench.insulation.specification import Block, Obstacle, Specification
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.solids.coverings import BendCovering, BlockNotch, StopCovering

RADIUS = DIAMETER / 2
OUTER = RADIUS + 30 + SHEET


def covering(plan_, name):
    return next(piece.covering for piece in plan_.pieces if piece.covering.id == name)


def beside(apart, **kwargs):
    """Two parallel pipes whose axes are so far apart."""
    return Pen().pipe(1000.0).pipeline(Pen(at=(300.0, apart, 0.0), prefix="X", **kwargs).pipe(1000.0))


def crossing(apart, diameter=DIAMETER):
    """A pipe that crosses another one so far above its axis."""
    return Pen().pipe(1000.0).pipeline(Pen(at=(500.0, -500.0, apart), along=(0, 1, 0), prefix="X", diameter=diameter).pipe(1000.0))


def test_discs_are_cut_where_the_insulation_that_they_close_is():
    result = plan(beside(100.0), specification())
    assert covering(result, "P1 stop 1").notches == covering(result, "XP1 stop 1").notches == ()
    (notch,) = covering(result, "XP1 stop 0").notches
    disc = covering(result, "XP1 stop 0").frame
    # the axis of P1 with its air, in the disc's own axes
    ends = np.array([disc.origin + end @ np.array([disc.x, disc.y, disc.z]) for end in (notch.start, notch.end)])
    assert ends[:, 1:] == pytest.approx(np.zeros((2, 2)), abs=1e-9)
    assert (notch.cause, notch.radius) == ("P1", pytest.approx(OUTER + 5))


def test_a_disc_within_other_insulation_is_left_out():
    thick = Pen(at=(0.0, 0.0, 0.0), diameter=114.3).pipe(1000.0)
    thin = Pen(at=(500.0, -600.0, 0.0), along=(0, 1, 0), prefix="X").pipe(600.0 - 57.15 - 8.0)
    result = plan(thick.pipeline(thin), specification(treatment(80.0)))
    assert [notch.cause for notch in covering(result, "XP1").notches] == ["P1"]
    assert {piece.covering.id for piece in result.pieces} == {"P1", "P1 stop 0", "P1 stop 1", "XP1", "XP1 stop 0"}


def test_parallel_pipes_are_as_far_apart_as_their_surfaces():
    (clash,) = plan(beside(200.0), specification()).clashes
    assert (clash.a, clash.b, clash.least, clash.resolved) == ("P1", "XP1", 100.0, "")
    assert clash.distance == pytest.approx(200 - 2 * OUTER, abs=1e-6)
    assert clash.point[1:] == pytest.approx((100, 0), abs=1e-3)
    assert 300 <= clash.point[0] <= 1000
    assert plan(beside(2 * OUTER + 100.1), specification()).clashes == ()
    assert len(plan(beside(2 * OUTER + 99.9), specification()).clashes) == 1


def test_crossing_pipes_clash_where_their_axes_are_the_nearest():
    (clash,) = plan(crossing(150.0), specification()).clashes
    assert clash.distance == pytest.approx(150 - 2 * OUTER, abs=1e-6)
    assert clash.point == pytest.approx((500, 0, 75), abs=0.01)


def test_the_flat_end_of_a_pipe_counts_not_a_ball_around_it():
    end_on = Pen(at=(500.0, OUTER + 20.0, 0.0), along=(0, 1, 0), prefix="X").pipe(500.0)
    (clash,) = plan(Pen().pipe(1000.0).pipeline(end_on), specification()).clashes
    assert clash.distance == pytest.approx(20, abs=0.01)
    assert clash.point == pytest.approx((500, OUTER + 10, 0), abs=0.5)


def test_the_largest_thickness_keeps_the_least_distance():
    pipeline = crossing(250.0)
    (clash,) = plan(pipeline, specification(treatment(50.0))).clashes
    assert clash.largest_a == clash.largest_b == pytest.approx(50 - (100 - (250 - 2 * (OUTER + 20))))
    assert plan(pipeline, specification(treatment(50.0), {"XP1": treatment(clash.largest_b - 0.01)})).clashes == ()
    assert plan(pipeline, specification(treatment(50.0), {"XP1": treatment(clash.largest_b + 0.01)})).clashes


def test_bare_pipes_and_obstacles_count():
    result = plan(crossing(180.0), specification(choices={"XP1": None}))
    (clash,) = result.clashes
    assert clash.distance == pytest.approx(180 - OUTER - RADIUS, abs=1e-6)
    assert (clash.largest_a, clash.largest_b) == (pytest.approx(30 - (100 - clash.distance)), None)
    post = Obstacle(id="post", start=(500.0, 180.0, -400.0), end=(500.0, 180.0, 400.0), diameter=60.0)
    (clash,) = plan(Pen().pipe(1000.0).pipeline(), specification(obstacles=(post,))).clashes
    assert (clash.a, clash.b) == ("P1", "post")
    assert clash.distance == pytest.approx(180 - 30 - OUTER, abs=1e-6)
    wall = Block(id="wall", lower=(-500.0, 120.0, -500.0), upper=(3000.0, 140.0, 500.0))
    (clash,) = plan(Pen().pipe(1000.0).pipeline(), specification(obstacles=(wall,))).clashes
    assert clash.distance == pytest.approx(120 - OUTER, abs=1e-6)
    assert clash.point[1] == pytest.approx(OUTER + (120 - OUTER) / 2, abs=0.01)
    # two bare pipes are the pipeline's own matter
    assert plan(crossing(20.0), specification(choices={"default": None})).clashes == ()


@pytest.mark.parametrize(("diameter", "loser", "winner"), [(DIAMETER, "XP1", "P1"), (88.9, "P1", "XP1"), (33.7, "XP1", "P1")])
def test_the_thicker_component_keeps_its_insulation_and_of_equal_ones_the_first(diameter, loser, winner):
    result = plan(crossing(108.0, diameter), specification())
    (clash,) = result.clashes
    assert clash.resolved == "cut"
    assert clash.distance < 0
    (notch,) = covering(result, loser).notches
    outer = (DIAMETER if winner == "P1" else diameter) / 2 + 30 + SHEET
    assert (notch.cause, notch.radius) == (winner, outer + 5)
    assert covering(result, winner).notches == ()
    # along the other's axis, as long as the loser is wide, with 5 mm of air at both ends
    frame = covering(result, loser).frame
    ends = np.array([notch.start, notch.end]) @ np.array([frame.x, frame.y, frame.z]) + frame.origin
    axis = 0 if winner == "P1" else 1
    width = (DIAMETER if loser == "P1" else diameter) / 2 + 31
    assert np.sort(ends[:, axis]) == pytest.approx(np.array([-width - 5, width + 5]) + (500 if axis == 0 else 0))
    assert ends[:, 2] == pytest.approx(0 if winner == "P1" else 108)


def test_a_bare_pipe_inside_the_others_insulation_is_cut_out_of_it():
    result = plan(crossing(75.0), specification())
    assert [notch.cause for notch in covering(result, "XP1").notches] == ["P1"]
    (notch,) = covering(result, "P1").notches
    assert (notch.cause, notch.radius) == ("XP1", RADIUS + 5)
    # the pipe's lower side is 10 mm outside of the jacket: nothing to cut there
    assert covering(plan(crossing(OUTER + RADIUS + 10), specification()), "P1").notches == ()


def test_obstacles_are_cut_out_of_what_they_run_into():
    post = Obstacle(id="post", start=(500.0, 90.0, -400.0), end=(500.0, 90.0, 400.0), diameter=80.0)
    result = plan(Pen().pipe(1000.0).pipeline(), specification(obstacles=(post,)))
    (notch,) = covering(result, "P1").notches
    assert (notch.cause, notch.radius) == ("post", 45)
    assert result.problems == ()
    beam = Block(id="beam", lower=(400.0, 70.0, -20.0), upper=(600.0, 300.0, 20.0))
    result = plan(Pen(along=(0.8, 0.6, 0.0), at=(100.0, -370.0, 0.0)).pipe(1000.0).pipeline(), specification(obstacles=(beam,)))
    straight = covering(result, "P1")
    (notch,) = straight.notches
    assert isinstance(notch, BlockNotch)
    axes = np.array([straight.frame.x, straight.frame.y, straight.frame.z])
    own = np.array([notch.frame.x, notch.frame.y, notch.frame.z])
    assert own @ axes == pytest.approx(np.eye(3), abs=1e-12)
    lower = notch.frame.origin @ axes + straight.frame.origin
    assert lower == pytest.approx([395, 65, -25])
    assert (lower + notch.size)[0] == pytest.approx(605)
    assert (lower + notch.size)[2] == pytest.approx(25)


def test_an_obstacle_at_the_pipe_itself_is_a_problem_with_the_largest_thickness():
    bracket = Obstacle(id="bracket", start=(500.0, 44.0, -400.0), end=(500.0, 44.0, 400.0), diameter=20.0)
    pipeline = Pen().pipe(1000.0).pipeline()
    result = plan(pipeline, specification(obstacles=(bracket,)))
    # 44 - 10 - 30.15 leave 3.85 mm: less than the air of a cut
    (problem,) = result.problems
    assert str(problem) == "P1: thickness: 30 mm run into 'bracket', which is so near that a cut would bare the metal; give at most 2 mm"
    assert covering(result, "P1").notches == ()
    assert result.clashes[0].resolved == ""
    again = plan(pipeline, specification(treatment(2.0), obstacles=(bracket,)))
    assert again.problems == ()
    assert again.clashes[0].distance >= 0
    assert result.without(result.problems).bare == ("P1",)


def test_what_follows_each_other_does_not_clash():
    pen = Pen().pipe(400.0).elbow((0, 1, 0)).pipe(300.0).tee().branch(300.0).pipe(5.0)
    pen.joints[-1] = dataclasses.replace(pen.joints[-1], a="T1", a_port=1)
    pen.pipe(200.0).reducer().pipe(300.0).elbow((1, 0, 0), 45.0, 57.0).cap()
    result = plan(pen.pipeline(), specification())
    assert result.problems == result.clashes == ()


def test_both_legs_of_a_loop_clash_although_they_are_one_run():
    pen = Pen().pipe(600.0).elbow((0, 1, 0)).pipe(10.0).elbow((-1, 0, 0)).pipe(600.0)
    clashes = {(clash.a, clash.b): clash for clash in plan(pen.pipeline(), specification()).clashes}
    assert clashes["P1", "P3"].distance == pytest.approx(2 * 76 + 10 - 2 * OUTER, abs=1e-6)


def test_neighbours_with_much_thicker_insulation_are_cut():
    pen = Pen().pipe(600.0).elbow((0, 1, 0)).pipe(600.0)
    result = plan(pen.pipeline(), specification(treatment(100.0), {"E1": treatment(20.0)}))
    (clash,) = result.clashes
    assert (clash.a, clash.b, clash.least, clash.resolved) == ("P1", "P2", 0.0, "cut")
    # the corner of each lies 131.15 - 76 mm inside of the other's end
    assert clash.distance == pytest.approx(-(RADIUS + 101 - 76), abs=0.01)
    assert covering(result, "P2").notches


def surface(piece, step=5.0):
    """Points on a covering's finished surface in the pipeline's frame."""
    radius = piece.radius + piece.total_thickness
    turns = np.linspace(0, 2 * math.pi, 72, endpoint=False)
    if isinstance(piece, BendCovering):
        return bent_surface(piece, radius, turns)
    along = np.linspace(piece.begin, piece.end, 2 + int((piece.end - piece.begin) / step))
    radii = np.linspace(0, radius, 2 + int(radius / step))
    mantle = [(radius * math.cos(t), radius * math.sin(t), z) for t in turns for z in along]
    ends = [(r * math.cos(t), r * math.sin(t), z) for t in turns for r in radii for z in (piece.begin, piece.end)]
    return np.array(mantle + ends) @ np.array([piece.frame.x, piece.frame.y, piece.frame.z]) + piece.frame.origin


def bent_surface(piece, radius, turns):
    """The gores' mantles: cylinders between mitres, from their own geometry."""
    points = []
    joint = piece.joint_angle
    for number in range(piece.gores):
        turn = number * joint
        way, aside = np.array([math.sin(turn), 0, math.cos(turn)]), np.array([math.cos(turn), 0, -math.sin(turn)])
        # a gore's axis touches the bend's at its own angle
        touch = np.array([piece.bend_radius, 0, 0]) - piece.bend_radius * aside
        for t in turns:
            reach = (piece.bend_radius - radius * math.cos(t)) * math.tan(joint / 2)
            first = -reach if number else -piece.collars[0]
            last = reach if number < piece.gores - 1 else piece.collars[1]
            out = radius * (math.cos(t) * aside + math.sin(t) * np.array([0, 1, 0]))
            points += [touch + part * way + out for part in np.linspace(first, last, 12)]
            ends = [first] * (number == 0) + [last] * (number == piece.gores - 1)
            points += [touch + part * way + share * out for part in ends for share in np.linspace(0, 1, 12)]
    return np.array(points) @ np.array([piece.frame.x, piece.frame.y, piece.frame.z]) + piece.frame.origin


@pytest.mark.parametrize("seed", range(6))
def test_distances_agree_with_sampled_surfaces(seed):
    random = np.random.default_rng(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    thickness = float(random.uniform(20, 50))
    first = Pen(along=turn[0]).pipe(300.0).elbow(turn[1], 90.0, 152.0).pipe(250.0)
    at = random.uniform(-60, 60, 3) + 260 * turn[2]
    other = Rotation.random(random_state=seed + 100).as_matrix()
    second = Pen(at=at, along=other[0], prefix="X", diameter=33.7).pipe(200.0).elbow(other[1], 60.0, 114.0).pipe(220.0)
    result = plan(first.pipeline(second), specification(treatment(thickness), minimum_distance=400.0))
    pieces = [piece.covering for piece in result.pieces if not isinstance(piece.covering, StopCovering)]
    points = {piece.id: surface(piece) for piece in pieces}
    trees = {name: cKDTree(array) for name, array in points.items()}
    found = {(clash.a, clash.b): clash for clash in result.clashes}
    checked = 0
    for name in ("P1", "E1", "P2"):
        for second_name in ("XP1", "XE1", "XP2"):
            sampled = float(trees[name].query(points[second_name])[0].min())
            clash = found.get((name, second_name))
            if clash is None:
                assert sampled > 399
            elif clash.distance > 5:
                # samples lie some 5 mm apart; gores' hulls stand out by less than 0.5 mm
                assert sampled - 3 <= clash.distance <= sampled + 0.5
                checked += 1
    assert checked >= 3


def test_the_depth_of_overlapping_cylinders_is_the_least_way_out():
    one = cylinder(np.zeros(3), np.array([0, 0, 400.0]), 50, 50, 0)
    # along the axis it takes 30 mm, aside 80
    other = cylinder(np.array([20.0, 0, 370.0]), np.array([20.0, 0, 900.0]), 50, 50, 0)
    assert signed_distances(one, other)[0] == pytest.approx([-30], abs=0.01)
    # across it takes 90 - 60
    third = cylinder(np.array([60.0, 0, 100.0]), np.array([60.0, 0, 900.0]), 40, 40, 0)
    assert signed_distances(one, third)[0] == pytest.approx([-30], abs=1e-6)


def test_a_block_is_as_far_away_as_its_nearest_corner():
    pipe = cylinder(np.array([0.0, 0, -50]), np.array([0.0, 0, 50]), 40, 40, 0)
    corner = block((30.0 + 40 / math.sqrt(2), 40 / math.sqrt(2) + 40, 50 + 0.0), (200.0, 300.0, 400.0), 0)
    distance, _ = signed_distances(pipe, corner)
    assert distance == pytest.approx([math.hypot(30 + 40 / math.sqrt(2), 40 + 40 / math.sqrt(2)) - 40], abs=0.01)


def test_clashes_do_not_depend_on_where_the_plant_stands():
    pipeline = pipe_rack(24, 4)
    shift = np.array([500.0, -80.0, 60.0])
    moved = [move(component, shift) for component in pipeline.components]
    both = Pipeline(frame="A", components=(*pipeline.components, *(dataclasses.replace(c, id=f"M{c.id}") for c in moved)))
    first = plan(both, Specification.uniform(40.0)).clashes
    far = Pipeline(frame="A", components=tuple(move(c, np.array([7e4, -3e4, 2e3])) for c in both.components))
    second = {(clash.a, clash.b): clash for clash in plan(far, Specification.uniform(40.0)).clashes}
    assert len(first) == len(second) > 5
    for clash in first:
        assert second[clash.a, clash.b].distance == pytest.approx(clash.distance, abs=0.05)


def move(component, shift):
    names = {"start", "end", "intersection", "branch_end", "face"} & {field.name for field in dataclasses.fields(component)}
    return dataclasses.replace(component, **{name: tuple((np.array(getattr(component, name)) + shift).tolist()) for name in names})
