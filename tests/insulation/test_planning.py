# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which covering goes where: collars, gaps, boxes, stops and gores against what was worked out by hand."""

import dataclasses
import itertools
import math

import grown
import numpy as np
import pytest
from insulated_pipework import BEND_RADIUS, DIAMETER, PLATE, SHEET, Pen, specification, treatment
from pipe_rack import pipe_rack

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.bends import gores_by_rule
from pipeworkbench.insulation.planning import plan
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, SheetSize
from pipeworkbench.pipeline import Flange, Pipe, Pipeline, Tee
from pipeworkbench.solids.coverings import BendCovering, BoxCovering, StopCovering, StraightCovering, TeeCovering

OUTER = DIAMETER / 2 + 30 + SHEET  # radius with 30 mm and a jacket
# M16 bolts through two plates and a gasket, with head, nut and protrusion
BOLT = 2 * 18 + 2 + (0.63 + 0.85 + 0.25) * 16
CUT = 18 + BOLT + 30 - 45  # of a pipe behind a flange: bolt and gap from the plate's back


def made(pen, *args, **kwargs):
    return plan(pen.pipeline(), specification(*args, **kwargs))


def covering(plan_, name):
    return next(piece.covering for piece in plan_.pieces if piece.covering.id == name)


def stops(plan_):
    return {piece.covering.id: piece.covering for piece in plan_.pieces if isinstance(piece.covering, StopCovering)}


def test_an_open_pipe_is_covered_from_end_to_end_and_closed_at_both():
    result = made(Pen().pipe(800.0))
    straight = covering(result, "P1")
    assert (straight.begin, straight.end, straight.radius) == (0.0, 800.0, DIAMETER / 2)
    first, last = stops(result)["P1 stop 0"], stops(result)["P1 stop 1"]
    assert (first.radius, first.outer_radius) == pytest.approx((DIAMETER / 2, OUTER))
    assert first.frame.z == pytest.approx([-1, 0, 0])
    assert last.frame.z == pytest.approx([1, 0, 0])
    assert last.frame.origin == pytest.approx([800, 0, 0])
    assert result.problems == result.bare == result.clashes == ()


def test_without_a_jacket_nothing_is_closed():
    assert stops(made(Pen().pipe(800.0), treatment(jacket=None))) == {}


def test_half_first_gores_take_nothing_of_the_pipes():
    result = made(Pen().pipe(500.0).elbow((0, 1, 0)).pipe(400.0))
    bend = covering(result, "E1")
    assert bend.gores == 5
    assert bend.collars == (0, 0)
    assert (covering(result, "P1").end, covering(result, "P2").begin) == (500.0, 0.0)
    assert set(stops(result)) == {"P1 stop 0", "P2 stop 1"}


@pytest.mark.parametrize(
    ("angle_deg", "outer_radius", "bend_radius", "width", "gores"),
    [
        (90.0, 60.0, 76.0, math.inf, 5),
        (90.0, 150.0, 305.0, math.inf, 5),
        (90.0, 151.0, 305.0, math.inf, 7),
        (45.0, 60.0, 76.0, math.inf, 3),
        # as measured: still bends of 90 and 45 degrees
        (90.02, 60.0, 76.0, math.inf, 5),
        (45.9, 60.0, 76.0, math.inf, 3),
        (91.1, 60.0, 76.0, math.inf, 6),
        (20.0, 60.0, 76.0, math.inf, 3),
        (19.0, 60.0, 76.0, math.inf, 2),
        # a whole gore of 22.5 degrees is 2 * 1140 * tan(11.25 deg) = 453 mm long at the heel, one of 18 deg 361 mm
        (90.0, 140.0, 1000.0, 454.0, 5),
        (90.0, 140.0, 1000.0, 453.0, 6),
        (90.0, 140.0, 1000.0, 361.0, 7),
    ],
)
def test_gores_by_rule(angle_deg, outer_radius, bend_radius, width, gores):
    assert gores_by_rule(math.radians(angle_deg), outer_radius, bend_radius, width) == gores


def test_equal_first_gores_go_over_the_pipes_by_half_their_length():
    result = made(Pen().pipe(500.0).elbow((0, 1, 0)).pipe(400.0), treatment(bends=Bends(first_gore="equal")))
    half = BEND_RADIUS * math.tan(math.radians(22.5 / 2))
    assert covering(result, "E1").collars == pytest.approx((half, half))
    assert covering(result, "P1").end == pytest.approx(500 - half)
    assert covering(result, "P2").begin == pytest.approx(half)


def test_first_gores_are_longer_only_where_a_pipe_has_the_room():
    result = made(Pen().pipe(500.0).elbow((0, 1, 0)).pipe(39.0), treatment(bends=Bends(first_gore=40.0)))
    assert covering(result, "E1").collars == (40.0, 0.0)
    assert covering(result, "P2").begin == 0.0
    assert any(remark.startswith("E1: no pipe beside its end 1") for remark in result.remarks)


def test_bolts_can_be_pulled_out_and_the_box_lies_over_the_jackets():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0)
    result = made(pen)
    assert covering(result, "P1").end == pytest.approx(600 - CUT)
    assert covering(result, "P2").begin == pytest.approx(CUT)
    assert (stops(result)["P1 stop 1"].frame.origin[0], stops(result)["P2 stop 0"].frame.z[0]) == pytest.approx((600 - CUT, -1))
    box = covering(result, "F1 box")
    # 50 mm of overlap and the end of 31 mm itself; its axes are those of F1, whose z goes from the face to the back
    assert (box.begin, box.end) == pytest.approx((-2 - 45 - CUT - 81, 45 + CUT + 81))
    assert box.openings == pytest.approx((OUTER, OUTER))
    assert box.radius == PLATE["D"] / 2 + 20
    assert set(box.components) == {"F1", "F2"}
    assert result.piece_of("F2").covering is box
    assert result.remarks == ()


def test_a_pipe_beside_its_flange_s_axis_makes_the_box_s_opening_wider():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0)
    aside = dataclasses.replace(pen.components[0], start=(0.0, 0.3, 0.0), end=(600.0, 0.4, 0.0))
    pen.components[0] = aside
    opening = covering(made(pen), "F1 box").openings
    assert min(opening) == pytest.approx(OUTER)
    assert OUTER + 0.35 < max(opening) < OUTER + 0.4


def test_thick_insulation_reaches_into_the_box():
    result = made(Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0), treatment(90.0))
    assert covering(result, "F1 box").radius == pytest.approx(DIAMETER / 2 + 91 + 1)


def test_a_blind_flange_closes_the_box():
    result = made(Pen().pipe(600.0).flange().gap(2.0, joined=True).blind())
    box = covering(result, "F1 box")
    # the blind plate, nuts and bolts' ends behind it, the clearance, the end of the box
    assert box.begin == pytest.approx(-2 - 18 - 1.1 * 16 - 20 - 31)
    assert box.openings == pytest.approx((0, OUTER))


def test_an_open_face_is_covered_and_told():
    result = made(Pen().pipe(600.0).flange())
    box = covering(result, "F1 box")
    assert (box.begin, box.openings[0]) == (-20 - 31, 0)
    assert "F1: nothing is joined to its face; the box is closed there" in result.remarks


def test_faces_that_look_at_each_other_are_a_valve_under_one_box():
    pen = Pen().pipe(600.0).flange().gap(230.0).flange(faces_on=False).pipe(700.0)
    result = made(pen)
    box = covering(result, "F1 box")
    assert (box.begin, box.end) == pytest.approx((-230 - 45 - CUT - 81, 45 + CUT + 81))
    assert [remark for remark in result.remarks if "bonnet" in remark] == [
        "F1: the bonnet and the handwheel of the valve between it and F2 are not known; their opening in the box is to be cut on site"
    ]
    short = made(pen, treatment(flanges=Flanges(longest_valve=229.0)))
    assert {p.covering.id for p in short.pieces if isinstance(p.covering, BoxCovering)} == {"F1 box", "F2 box"}


def test_what_stands_between_two_faces_is_no_valve():
    between = Pen(at=(700.0, 0.0, 0.0), along=(0.0, 0.0, 1.0), prefix="X").pipe(300.0)
    pen = Pen().pipe(600.0).flange().gap(230.0).flange(faces_on=False).pipe(700.0)
    result = plan(pen.pipeline(between), specification())
    assert {"F1 box", "F2 box"} <= {piece.covering.id for piece in result.pieces}


def test_faces_across_a_gasket_need_no_joint():
    result = made(Pen().pipe(600.0).flange().gap(3.0).flange(faces_on=False).pipe(700.0), treatment(flanges=Flanges(longest_valve=0.0)))
    # without a joint a gasket of 2 mm is taken for the bolts' length
    assert covering(result, "F1 box").begin == pytest.approx(-3 - 45 - CUT - 81)


def test_flanges_with_a_short_pipe_between_are_under_one_box():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(150.0)
    pen.flange().gap(2.0, joined=True).flange(faces_on=False).pipe(500.0)
    result = made(pen)
    boxes = [piece.covering for piece in result.pieces if isinstance(piece.covering, BoxCovering)]
    assert [box.id for box in boxes] == ["F1 box"]
    assert set(boxes[0].components) == {"F1", "F2", "F3", "F4", "P2"}
    assert boxes[0].begin == pytest.approx(-2 - 45 - 150 - 45 - 2 - 45 - CUT - 81)
    assert result.bare == ()


def test_two_boxes_share_a_pipe_by_halves():
    # 2 * 68.68 mm for the bolts leave 92.64 mm, on which both boxes' ends of 31 mm find room, not their overlaps
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(230.0)
    pen.flange().gap(2.0, joined=True).flange(faces_on=False).pipe(500.0)
    result = made(pen)
    first, second = covering(result, "F1 box"), covering(result, "F3 box")
    assert first.frame.origin[0] - first.begin == pytest.approx(645 + 2 + 45 + 115)
    assert second.frame.origin[0] - second.end == pytest.approx(645 + 2 + 45 + 115)


def test_before_an_elbow_a_box_ends_where_the_elbow_begins():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).elbow((0, 1, 0)).pipe(400.0)
    result = made(pen)
    box = covering(result, "F1 box")
    assert box.begin == pytest.approx(-2 - 45)
    # the neck's cone is still there where the nuts end, 18 + 1.1 * 16 mm behind the face
    neck = np.interp(18 + 17.6, [18, 37], [37, DIAMETER / 2])
    assert box.openings[0] == pytest.approx(neck)
    assert [notch.cause for notch in box.notches] == ["F2"]
    assert box.notches[0].end == pytest.approx([0, 0, -2 - 18 - 17.6])
    assert not {"E1 stop 0"} & set(stops(result))
    assert any(remark.startswith("F2: E1 follows without a pipe") for remark in result.remarks)


def test_a_pipe_too_short_for_insulation_is_under_the_box():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(60.0).elbow((0, 1, 0)).pipe(400.0)
    result = made(pen)
    box = covering(result, "F1 box")
    assert box.begin == pytest.approx(-2 - 45 - 60)
    assert "P2" in box.components
    assert result.bare == ()
    assert "E1 stop 0" not in stops(result)
    assert any(remark.startswith("P2: 60 mm are too short") for remark in result.remarks)


def test_bare_flanges_keep_the_room_for_their_bolts():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0)
    result = made(pen, treatment(flanges=Flanges(cover="bare")))
    assert result.bare == ("F1", "F2")
    assert covering(result, "P1").end == pytest.approx(600 - CUT)
    assert {"P1 stop 1", "P2 stop 0"} <= set(stops(result))


def test_a_box_over_one_flange_covers_its_partner():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0)
    result = made(pen, choices={"F1": None})
    assert set(covering(result, "F1 box").components) == {"F1", "F2"}
    assert "F1: lies under the box over F2" in result.remarks


def test_pipes_beside_a_box_that_are_bare():
    pen = Pen().pipe(600.0).flange().gap(2.0, joined=True).flange(faces_on=False).pipe(700.0)
    result = made(pen, choices={"P2": None})
    box = covering(result, "F1 box")
    assert box.begin == pytest.approx(-2 - 45 - 31)
    assert box.openings == pytest.approx((DIAMETER / 2, OUTER))
    assert result.bare == ("P2",)


def tight_collar(thickness, angle_deg=90.0):
    return (DIAMETER / 2 + thickness + SHEET - BEND_RADIUS) * math.tan(math.radians(angle_deg / 2)) + 30


@pytest.mark.parametrize("angle_deg", [90.0, 45.0])
def test_a_tight_bend_is_made_of_two_pieces_that_go_over_its_neighbours(angle_deg):
    result = made(Pen().pipe(500.0).elbow((0, 1, 0), angle_deg).pipe(400.0), treatment(60.0))
    bend = covering(result, "E1")
    collar = tight_collar(60.0, angle_deg)
    assert bend.gores == 2
    assert bend.collars == pytest.approx((collar, collar))
    assert (covering(result, "P1").end, covering(result, "P2").begin) == pytest.approx((500 - collar, collar))
    assert any(remark.startswith("E1: 60 mm is too thick for gores") for remark in result.remarks)


def test_a_tight_smooth_bend_is_mitred_too():
    result = made(Pen().pipe(500.0).elbow((0, 1, 0)).pipe(400.0), treatment(60.0, bends=Bends(shape="smooth")))
    assert covering(result, "E1").gores == 2
    assert covering(made(Pen().elbow((0, 1, 0)), treatment(bends=Bends(shape="smooth"))), "E1").gores == 0


def test_tight_bends_are_refused_on_request_with_the_largest_thickness():
    pen = Pen().pipe(500.0).elbow((0, 1, 0)).pipe(400.0)
    refuse = Bends(tight="refuse")
    result = made(pen, treatment(60.0, bends=refuse))
    # 76 - 30.15 - 1 mm of sheet - 1 mm that is left of the throat
    assert [str(problem) for problem in result.problems] == [
        "E1: thickness: 60 mm does not fit into a bend of radius 76 mm: the throat would run into itself; give at most 43 mm"
    ]
    assert result.bare == ("E1",)
    assert {"P1 stop 1", "P2 stop 0"} <= set(stops(result))
    assert made(pen, treatment(43.0, bends=refuse)).problems == ()
    assert made(pen, treatment(44.0, bends=refuse)).problems


def test_mitre_joints_longer_than_the_sheet_are_refused_with_the_largest_thickness():
    pen = Pen(diameter=323.9).pipe(2000.0).elbow((0, 1, 0), bend_radius=305.0).pipe(2000.0)
    sheet = (SheetSize(900.0, 400.0, margin=10.0),)
    result = made(pen, treatment(210.0), sheet_sizes=sheet)
    # two radii of 161.95 + 210 + 1, 30 of throat and 50 of overlap; (880 - 80) / 2 - 161.95 - 1 = 237.05
    assert result.problems == ()
    result = made(pen, treatment(238.0), sheet_sizes=sheet)
    assert str(result.problems[0]) == (
        "E1: thickness: the pieces of its mitre joint are 882 mm long at the heel with their overlaps; the widest sheet is 880 mm; "
        "give a sheet of 882 mm between its margins or at most 237 mm"
    )
    assert made(pen, treatment(237.0), sheet_sizes=sheet).problems == ()
    assert made(pen, treatment(238.0, jacket=None), sheet_sizes=sheet).problems == ()


def largest(problem):
    assert problem.remedy.startswith("give at most ")
    return float(problem.remedy.split()[3])


TIGHT = {
    "a short pipe": Pen().pipe(40.0).elbow((0, 1, 0)).pipe(400.0),
    "a shared pipe": Pen().pipe(400.0).elbow((0, 1, 0)).pipe(85.0).elbow((0, 0, 1)).pipe(400.0),
    "a shared pipe of two angles": Pen().pipe(400.0).elbow((0, 1, 0)).pipe(85.0).elbow((0, 0, 1), 45.0, 60.0).pipe(400.0),
    "a flange": Pen().flange(faces_on=False).elbow((0, 1, 0)).pipe(400.0),
    "a flange behind a pipe": Pen().flange(faces_on=False).pipe(CUT + 40).elbow((0, 1, 0)).pipe(400.0),
    "another elbow": Pen().pipe(400.0).elbow((0, 1, 0)).elbow((0, 0, 1)).pipe(400.0),
    "nothing": Pen().elbow((0, 1, 0)).pipe(400.0),
}


@pytest.mark.parametrize("name", TIGHT)
def test_a_tight_bend_without_room_names_the_largest_thickness(name):
    pen = TIGHT[name]
    result = made(pen, treatment(60.0))
    assert {problem.key for problem in result.problems} == {"thickness"}
    for problem in result.problems:
        same = {problem.source: None, "elbow": None}
        for extra, fits in ((0.0, True), (1.0, False)):
            fitting = treatment(largest(problem) + extra)
            changed = made(pen, fitting, {**dict.fromkeys(same, fitting)})
            assert (problem.source not in {other.source for other in changed.problems}) == fits


def test_two_tight_bends_share_a_pipe_that_has_the_room():
    room = 2 * tight_collar(60.0)
    for length, fits in ((room + 0.1, True), (room - 0.1, False)):
        pen = Pen().pipe(400.0).elbow((0, 1, 0)).pipe(length).elbow((0, 0, 1)).pipe(400.0)
        assert {problem.source for problem in made(pen, treatment(60.0)).problems} == (set() if fits else {"E1", "E2"})


def test_too_few_gores_for_the_sheet_are_refused_with_the_smallest_number():
    pen = Pen(diameter=323.9).pipe(2000.0).elbow((0, 1, 0), bend_radius=1525.0).pipe(2000.0)
    sheet = (SheetSize(500.0, 400.0, margin=10.0),)
    wanted = treatment(60.0, bends=Bends(gores=5))
    result = made(pen, wanted, sheet_sizes=sheet)
    # 2 * (1525 + 222.95) * tan(11.25 deg) = 695.4 mm; 470 mm are left: 1 + 90 / (2 * atan(470 / 3495.9)) = 6.87
    assert str(result.problems[0]) == (
        "E1: gores: 5 gores are 695 mm long at the heel and need 10 mm of overlap; the widest sheet is 480 mm; give at least 7 gores"
    )
    for gores, fits in ((6, False), (7, True)):
        again = made(pen, treatment(60.0, bends=Bends(gores=gores)), sheet_sizes=sheet)
        assert (again.problems == ()) == fits
    assert covering(made(pen, treatment(60.0), sheet_sizes=sheet), "E1").gores == 7


def test_a_branch_comes_out_of_the_runs_insulation():
    result = made(Pen().pipe(500.0).tee().branch(300.0))
    tee = covering(result, "T1")
    assert tee.reach == pytest.approx(OUTER + 30)
    assert covering(result, "B1").begin == pytest.approx(OUTER + 30 - 51)
    # the branch is 16.85 + 31 mm wide, and 10 mm stay beside it
    assert (tee.begin, tee.end) == pytest.approx((-64, 64))


def test_a_wide_branch_takes_collars_of_the_run():
    pen = Pen().pipe(500.0).tee(branch_diameter=DIAMETER, branch=64.0)
    pen.branch(300.0).pipe(400.0)
    pen.joints[-1] = dataclasses.replace(pen.joints[-1], a="T1", a_port=1)
    result = made(pen)
    tee = covering(result, "T1")
    assert (tee.begin, tee.end) == pytest.approx((-OUTER - 10, OUTER + 10))
    assert covering(result, "P1").end == pytest.approx(500 - (OUTER + 10 - 64))
    assert covering(result, "P2").begin == pytest.approx(OUTER + 10 - 64)


@pytest.mark.parametrize("angle_deg", [45.0, 60.0, 90.0, 120.0])
def test_an_oblique_branch_reaches_far_enough_all_around(angle_deg):
    angle = math.radians(angle_deg)
    pen = Pen().pipe(900.0).tee(half=300.0, branch=60.0, towards=(math.cos(angle), 0.0, math.sin(angle))).branch(900.0)
    tee = covering(made(pen), "T1")
    assert tee.branch_angle == pytest.approx(angle)
    turn = np.linspace(0, 2 * math.pi, 3600)
    radius = 33.7 / 2 + 31
    # the branch's end circle in the tee's axes
    x = tee.reach * math.sin(angle) - radius * np.cos(turn) * math.cos(angle)
    assert np.hypot(x, radius * np.sin(turn)).min() >= OUTER
    least = tee.reach - 30
    x = least * math.sin(angle) - radius * np.cos(turn) * math.cos(angle)
    assert np.hypot(x, radius * np.sin(turn)).min() == pytest.approx(OUTER, abs=1e-3)


def test_a_branch_without_room_is_a_hole():
    result = made(Pen().tee(branch_diameter=DIAMETER).branch(300.0))
    tee = covering(result, "T1")
    assert (tee.reach, tee.begin, tee.end) == (0, -64, 64)
    # from the run's outer face on
    assert covering(result, "B1").begin == pytest.approx(OUTER - 51)
    assert any(remark.startswith("T1: the pipes beside it are too short") for remark in result.remarks)


def test_reducers_and_caps_have_their_own_coverings():
    result = made(Pen().pipe(300.0).reducer().pipe(300.0).cap())
    cone, cap = covering(result, "R1"), covering(result, "C1")
    assert (cone.radius, cone.end_radius, cone.length, cone.offset) == pytest.approx((DIAMETER / 2, 24.15, 76, 0))
    assert (cap.radius, cap.length) == (24.15, 38)
    assert set(stops(result)) == {"P1 stop 0"}


def test_where_insulation_becomes_thinner_a_disc_closes_the_thicker_one():
    result = made(Pen().pipe(300.0).elbow((0, 1, 0)).pipe(300.0), choices={"P2": treatment(20.0)})
    disc = stops(result)["E1 stop 1"]
    assert (disc.radius, disc.outer_radius) == pytest.approx((OUTER - 10, OUTER))
    assert disc.frame.z == pytest.approx([0, 1, 0])
    assert "P2 stop 0" not in stops(result)


def test_insulation_is_closed_where_the_neighbour_is_bare():
    result = made(Pen().pipe(300.0).elbow((0, 1, 0)).pipe(300.0), choices={"P2": None})
    assert stops(result)["E1 stop 1"].radius == pytest.approx(DIAMETER / 2)
    assert result.bare == ("P2",)


def test_a_stop_lies_where_the_collar_over_a_bare_pipe_ends():
    result = made(Pen().pipe(300.0).elbow((0, 1, 0)).pipe(300.0), treatment(60.0), {"P2": None})
    disc = stops(result)["E1 stop 1"]
    assert disc.frame.origin == pytest.approx([300 + BEND_RADIUS, BEND_RADIUS + tight_collar(60.0), 0])


def test_seams_lie_at_the_underside_in_turns_to_either_side():
    result = made(Pen().pipe(300.0).elbow((0, 1, 0)).pipe(300.0).reducer(), treatment(seams=Seams(stagger_deg=40.0)))
    sides = []
    for name in ("P1", "P2", "R1"):
        piece = covering(result, name)
        seam = math.cos(piece.seam) * piece.frame.x + math.sin(piece.seam) * piece.frame.y
        assert seam[2] == pytest.approx(-math.cos(math.radians(20)))
        sides.append(np.sign(np.cross(piece.frame.z, [0, 0, -1]) @ seam))
    assert sides == [1, 1, -1]


@pytest.mark.parametrize(
    ("along", "towards", "seam"),
    [((1, 0, 0), (0, 1, 0), 0.0), ((1, 0, 0), (0, 0, -1), 0.0), ((1, 0, 0), (0, 0, 1), math.pi), ((0, 0, -1), (1, 0, 0), math.pi)],
    ids=["lying", "downwards", "upwards", "out of a downpipe"],
)
def test_seams_of_bends_lie_at_the_throat_or_where_that_looks_up_at_the_heel(along, towards, seam):
    result = made(Pen(along=along).pipe(300.0).elbow(towards).pipe(300.0))
    assert covering(result, "E1").seam == pytest.approx(seam)


def test_seams_of_vertical_pipes_follow_x():
    result = made(Pen(along=(0, 0, 1)).pipe(300.0), treatment(seams=Seams(stagger_deg=0.0)))
    assert covering(result, "P1").seam == 0


def test_ids_of_pieces_are_free():
    pen = Pen().pipe(300.0)
    taken = Pen(at=(0, 2000, 0)).pipe(300.0)
    taken.components[0] = dataclasses.replace(taken.components[0], id="P1 stop 0")
    result = plan(pen.pipeline(taken), specification())
    names = [piece.covering.id for piece in result.pieces]
    assert len(names) == len(set(names))
    assert "P1 stop 0.2" in names


def test_the_first_problem_tells_how_many_more_there_are():
    pen = Pen().elbow((0, 1, 0)).elbow((0, 0, 1))
    result = made(pen, treatment(60.0))
    with pytest.raises(InputError, match=r"E1: thickness: .* give at most 43 mm \(1 more such problem\)"):
        result.check()
    made(pen).check()


def test_components_with_problems_can_be_left_bare():
    pen = Pen().elbow((0, 1, 0)).pipe(400.0).elbow((0, 0, 1)).pipe(300.0)
    result = made(pen, treatment(60.0))
    assert [problem.source for problem in result.problems] == ["E1"]
    rest = result.without(result.problems)
    rest.check()
    assert rest.bare == ("E1",)
    assert {piece.covering.id for piece in rest.pieces} >= {"P1", "E2", "P2", "P1 stop 0"}


def test_a_component_that_is_no_solid_is_a_problem():
    pen = Pen().pipe(400.0).elbow((0, 1, 0), bend_radius=30.0).pipe(400.0)
    result = made(pen)
    assert [(problem.source, problem.key) for problem in result.problems] == [("E1", "bend_radius")]
    tee = Pen().tee()
    tee.components[0] = dataclasses.replace(tee.components[0], branch_diameter=70.0)
    assert [problem.key for problem in made(tee).problems] == ["branch_diameter"]


def test_an_elbow_without_an_angle_is_a_problem():
    pen = Pen().pipe(400.0).elbow((0, 1, 0)).pipe(400.0)
    straight = dataclasses.replace(pen.components[1], end=(552.0, 0.0, 0.0))
    pen.components[1] = straight
    result = made(pen)
    assert [(problem.source, problem.key) for problem in result.problems] == [("E1", "intersection")]
    assert result.bare == ("E1",)


def test_flanges_joined_in_a_ring_are_a_problem():
    pen = Pen().flange().gap(2.0, joined=True).flange(faces_on=False)
    pen.joints.append(dataclasses.replace(pen.joints[0], a_port=1, b_port=1))
    result = made(pen)
    assert [(problem.source, problem.key) for problem in result.problems] == [("F1", "joints")]
    assert result.bare == ("F1", "F2")


def grown_pipeline(seed, count=45):
    components, joints = grown.simulated_pipeline(np.random.default_rng(seed), count)
    return Pipeline(frame="A", components=components, joints=joints)


PLANTS = {"rack": lambda: pipe_rack(60, 3), "grown": lambda: grown_pipeline(2), "grown otherwise": lambda: grown_pipeline(5)}


@pytest.mark.parametrize("thickness", [20.0, 60.0, 100.0])
@pytest.mark.parametrize("name", PLANTS)
def test_in_any_plant_coverings_follow_each_other_without_overlap(name, thickness):
    pipeline = PLANTS[name]()
    result = plan(pipeline, Specification.uniform(thickness))
    pieces = {piece.covering.component: piece.covering for piece in result.pieces if not isinstance(piece.covering, BoxCovering | StopCovering)}
    covered = set(pieces) | {one for piece in result.pieces if isinstance(piece.covering, BoxCovering) for one in piece.covering.components}
    problems = {problem.source for problem in result.problems}
    assert covered.isdisjoint(result.bare)
    assert covered | set(result.bare) == {component.id for component in pipeline.components}
    assert problems.isdisjoint(covered)
    # only what has a problem, or is told of, is bare
    told = {remark.split(":")[0] for remark in result.remarks}
    assert set(result.bare) - told <= problems | partners_of(problems, pipeline)
    for pipe in pipeline.pipes:
        if isinstance(straight := pieces.get(pipe.id), StraightCovering):
            gaps = {port: given_up(pipe, port, pieces, pipeline) for port in (0, 1)}
            for port, place in ((0, straight.begin), (1, pipe.length - straight.end)):
                assert place >= -1e-9
                if gaps[port] is not None:
                    assert place == pytest.approx(gaps[port], abs=1e-6)
    assert len({piece.covering.id for piece in result.pieces}) == len(result.pieces)


def partners_of(names, pipeline):
    pairs = [(joint.a, joint.b) for joint in pipeline.joints if joint.a_port == joint.b_port == 0]
    return set(itertools.chain.from_iterable(pair for pair in pairs if set(pair) & names))


def given_up(pipe, port, pieces, pipeline):
    """How much of a pipe's end its neighbour's covering or a flange's bolts need; None where a tee's branch is a hole."""
    ends = {(j.a, j.a_port): (j.b, j.b_port) for j in pipeline.joints} | {(j.b, j.b_port): (j.a, j.a_port) for j in pipeline.joints}
    if (pipe.id, port) not in ends:
        return 0.0
    name, other_port = ends[pipe.id, port]
    component = next(c for c in pipeline.components if c.id == name)
    match component, pieces.get(name):
        case Flange(), _:
            partner = ends.get((name, 0))
            facing = next((c for c in pipeline.components if partner and c.id == partner[0]), component)
            between = abs(np.subtract(facing.face, component.face) @ component.axis) if partner else 2.0
            d = (component.L or component.C + 2) - 2
            away = np.subtract(pipe.ports[port].point, component.face) @ -np.array(component.axis)
            return max(component.C + component.C + facing.C + between + 1.73 * d + 30 - away, 0.0)
        case _, BendCovering() as bend:
            return bend.collars[other_port]
        case Tee() as tee, TeeCovering() as covered:
            reach = (abs(covered.begin), covered.end, covered.reach)[other_port]
            middle = np.array(tee.intersection)
            return reach - np.linalg.norm(np.array(tee.ports[other_port].point) - middle) if reach else None
    return 0.0


def test_what_nothing_is_said_of_stays_bare():
    lonely = Pipe(id="P", start=(0.0, 0.0, 0.0), end=(100.0, 0.0, 0.0), outer_diameter=33.7)
    result = plan(Pipeline(frame="A", components=(lonely,)), Specification())
    assert result.pieces == ()
    assert result.bare == ("P",)
    assert result.piece_of("P") is None
