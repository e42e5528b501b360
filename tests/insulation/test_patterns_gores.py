# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gores rolled up again: they lie on their cylinder between their mitre planes, and neighbours' edges fit."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pattern_checks import check_all, common, marks

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns import patterns_of_covering
from pipeworkbench.insulation.patterns.gores import smallest_gore_count
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import BendCovering, Notch

SEAMS = Seams()


def bend(gores=5, angle_deg=90.0, radius=57.15, bend_radius=152.4, thickness=50.0, **more):
    return BendCovering(**common("E1", thickness, **more), radius=radius, bend_radius=bend_radius, angle=math.radians(angle_deg), gores=gores)


def neutral(covering):
    return covering.radius + covering.thickness + covering.sheet.thickness / 2


def seam(covering, index, seams=SEAMS):
    return covering.seam + math.radians(seams.stagger_deg) * (-1) ** index


def rolled(covering, index, points, seams=SEAMS):
    """Roll points (n, 2) of a gore's pattern up and put them into the covering's axes."""
    radius = neutral(covering)
    phi = seam(covering, index, seams) + points[:, 0] / radius
    tilt = index * covering.angle / (covering.gores - 1)
    # the gore's axis touches the bend's circle about (bend_radius, 0, 0) at the angle tilt
    touching = np.array([covering.bend_radius * (1 - math.cos(tilt)), 0.0, covering.bend_radius * math.sin(tilt)])
    inwards, along = np.array([math.cos(tilt), 0.0, -math.sin(tilt)]), np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    around = np.cos(phi)[:, None] * inwards + np.sin(phi)[:, None] * np.array([0.0, 1.0, 0.0])
    return touching + radius * around + points[:, 1:] * along, touching, along


def mitre_distance(covering, joint, points):
    """Return the distances of points from the plane between gores ``joint`` and ``joint + 1``: it goes through the bend's centre."""
    turn = (joint + 0.5) * covering.angle / (covering.gores - 1)
    return (points - (covering.bend_radius, 0.0, 0.0)) @ (math.sin(turn), 0.0, math.cos(turn))


def by_index(covering, patterns):
    """Return each gore's pattern: first, the two variants of the middle ones by turns, last."""
    middle = patterns[1:-1]
    return [patterns[0], *(middle[(k - 1) % len(middle)] for k in range(1, covering.gores - 1)), patterns[-1]]


def edges(covering, pattern):
    """Return the points of a middle gore's outline on its lower and its upper side, without the overlap around."""
    points = pattern.outline.sampled(0.001)
    width = 2 * math.pi * neutral(covering)
    inside = (points[:, 0] > 1e-6) & (points[:, 0] < width - 1e-6)
    lower = points[:, 1] < 0
    return points[inside & lower], points[inside & ~lower]


@settings(deadline=None, max_examples=6)
@given(st.integers(2, 9), st.floats(15, 180), st.floats(10, 250), st.floats(1.05, 4), st.floats(20, 100))
def test_gores_rolled_up_lie_on_their_cylinder_and_mitre_planes(gores, angle_deg, radius, ratio, thickness):
    covering = bend(gores, angle_deg, radius, (radius + thickness + 1) * ratio, thickness)
    assume(math.degrees(covering.joint_angle) < 100)
    patterns = patterns_of_covering(covering, SEAMS)
    for index, pattern in enumerate(by_index(covering, patterns)):
        fold = marks(pattern, "FOLD")
        if index < gores - 1:
            placed, touching, along = rolled(covering, index, fold[0].sampled(0.002))
            assert abs(mitre_distance(covering, index, placed)).max() < 0.03
            offset = placed - touching
            offset = offset - np.outer(offset @ along, along)
            assert np.linalg.norm(offset, axis=1) == pytest.approx(neutral(covering), abs=1e-6)
    # the cut edges: of the last gore the lower one
    points = patterns[-1].outline.sampled(0.001)
    lower = points[(points[:, 1] < -1e-9) & (points[:, 0] > 0)]
    on_the_plane, _, _ = rolled(covering, gores - 1, lower)
    assert abs(mitre_distance(covering, gores - 2, on_the_plane)).max() < 0.03


def test_every_cut_edge_of_a_usual_bend_lies_on_its_plane():
    covering = bend(5)
    patterns = by_index(covering, check_all(patterns_of_covering(covering, SEAMS)))
    for index in range(1, 4):
        lower, upper = edges(covering, patterns[index])
        placed, _, _ = rolled(covering, index, lower)
        assert abs(mitre_distance(covering, index - 1, placed)).max() < 0.03
        placed, _, _ = rolled(covering, index, upper - (0.0, SEAMS.gore_overlap))
        assert abs(mitre_distance(covering, index, placed)).max() < 0.03


@settings(deadline=None, max_examples=6)
@given(st.integers(3, 8), st.floats(20, 120), st.floats(1.05, 3))
def test_neighbouring_edges_are_equally_long(gores, angle_deg, ratio):
    covering = bend(gores, angle_deg, bend_radius=110 * ratio)
    assume(math.degrees(covering.joint_angle) < 100)
    # a full turn of a mitre edge is as long wherever the seam lies
    seams = Seams(longitudinal_overlap=0.0)
    patterns = by_index(covering, patterns_of_covering(covering, seams))
    width = 2 * math.pi * neutral(covering)
    for pattern, following in itertools.pairwise(patterns):
        upper = marks(pattern, "FOLD")[0].length
        bottom = following.outline.sampled(0.002)
        # from the lower left corner along the lower edge to the lower right one
        start = int(np.argmin(np.hypot(bottom[:, 0], bottom[:, 1] - bottom[bottom[:, 0] < 1e-6, 1].min())))
        turned = np.roll(bottom, -start, axis=0)
        stop = int(np.argmax(turned[:, 0] > width - 1e-6))
        lower = np.hypot(*np.diff(turned[: stop + 1], axis=0).T).sum()
        assert lower == pytest.approx(upper, abs=0.1)


@pytest.mark.parametrize("gores", [2, 5])
def test_net_areas_are_those_of_the_cut_cylinder(gores):
    import cadquery as cq

    covering = dataclasses.replace(bend(gores), collars=(40.0, 25.0))
    radius = neutral(covering)
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    half_turn = math.degrees(covering.joint_angle / 2)

    def cylinder(below, above):
        """A cylinder from a plane to another; an angle tilts a plane at half a gore's length, None lets it end there."""
        solid = cq.Workplane("XY").circle(radius).extrude(1000, both=True)
        for end, sign in ((below, -1), (above, 1)):
            tilt, at = (half_turn, covering.half_length) if end is None else (0.0, end)
            plate = cq.Workplane("XY").box(5000, 5000, 5000).translate((0, 0, sign * 2500))
            plate = plate.rotate((0, 0, 0), (0, 1, 0), sign * tilt).translate((0, 0, sign * at))
            solid = solid.cut(plate)
        return sum(face.Area() for face in solid.faces("%CYLINDER").vals())

    assert patterns[0].net_area == pytest.approx(cylinder(40.0, None), rel=1e-6)
    assert patterns[-1].net_area == pytest.approx(cylinder(None, 25.0), rel=1e-6)
    for pattern in patterns[1:-1]:
        assert pattern.net_area == pytest.approx(cylinder(None, None), rel=1e-6)


def test_equal_gores_are_one_part_and_seams_change_sides():
    patterns = patterns_of_covering(bend(7), SEAMS)
    assert [pattern.quantity for pattern in patterns] == [1, 3, 2, 1]
    plain = patterns_of_covering(bend(7), Seams(stagger_deg=0.0))
    assert [pattern.quantity for pattern in plain] == [1, 5, 1]


def test_seams_lie_beside_the_throat():
    patterns = patterns_of_covering(bend(5), SEAMS)
    width = 2 * math.pi * neutral(bend(5))
    for pattern, sign in zip(by_index(bend(5), patterns), (1, -1, 1, -1, 1), strict=True):
        heels = [path.points[0, 0] for path in marks(pattern, "CENTRE")]
        # the heel's line is half a turn from the throat, the seam 30 degrees from it
        heel = width / 2 - sign * width / 12
        assert min(abs(x - heel) for x in heels) < 1e-6


def test_throat_and_heel_are_told_and_true():
    covering = bend(5)
    pattern = patterns_of_covering(covering, SEAMS)[1]
    slope = math.tan(math.radians(90 / 8))
    throat, heel = (2 * (152.4 + side * neutral(covering)) * slope for side in (-1, 1))
    assert pattern.remarks == (f"throat {throat:.1f} mm, heel {heel:.1f} mm",)
    assert any(f"throat {throat:.1f} heel {heel:.1f}" in text.text for text in pattern.texts)
    _, bottom, _, top = pattern.outline.bounds
    assert top - bottom == pytest.approx(heel + SEAMS.gore_overlap, abs=1e-3)


def test_a_smooth_bend_has_no_patterns_and_neither_has_one_without_jacket():
    assert patterns_of_covering(bend(0), SEAMS) == ()
    assert patterns_of_covering(bend(5, sheet=None), SEAMS) == ()


@pytest.mark.parametrize("gores", [3, 6])
def test_too_thick_insulation_is_refused_with_the_largest_that_works(gores):
    with pytest.raises(InputError, match=r"E1: thickness: 100 mm .* take less than 94\.8 mm"):
        patterns_of_covering(bend(gores, thickness=100.0), SEAMS)
    check_all(patterns_of_covering(bend(gores, thickness=94.7), SEAMS))


def test_collars_let_a_mitre_be_thicker_than_the_bend_radius():
    covering = dataclasses.replace(bend(2, thickness=100.0), collars=(40.0, 40.0))
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    assert len(patterns) == 2
    # 40 mm of the collar less the 5.15 mm by which the radius is too large
    assert patterns[0].remarks[0].startswith("throat 34.8 mm")


def test_too_few_gores_for_the_sheet_are_refused_with_the_number_that_works():
    covering = bend(3, radius=300.0, bend_radius=2000.0)
    size = SheetSize(width=1000.0, height=1000.0)
    least = smallest_gore_count(covering, SEAMS, covering.sheet, size)
    with pytest.raises(InputError, match=f"E1: gores: 3 gores .* take {least} or more"):
        patterns_of_covering(covering, SEAMS, size)
    assert least > 3
    patterns = check_all(patterns_of_covering(dataclasses.replace(covering, gores=least), SEAMS, size))
    assert all(
        max(pattern.outline.bounds[2] - pattern.outline.bounds[0], pattern.outline.bounds[3] - pattern.outline.bounds[1]) <= 980
        for pattern in patterns
    )
    with pytest.raises(InputError, match="gores"):
        patterns_of_covering(dataclasses.replace(covering, gores=least - 1), SEAMS, size)


def test_a_wide_gore_is_parted_around():
    covering = bend(12, radius=400.0, bend_radius=1200.0)
    patterns = check_all(patterns_of_covering(covering, SEAMS, SheetSize()))
    whole = patterns_of_covering(covering, SEAMS)
    assert sum(p.net_area * p.quantity for p in patterns) == pytest.approx(sum(p.net_area * p.quantity for p in whole), rel=1e-9)
    assert sum(p.quantity for p in patterns) == 2 * 12


def test_a_notch_goes_through_the_gores_it_meets():
    whole = patterns_of_covering(bend(5), SEAMS)
    # a bar across the bend's heel, at half of its turn
    middle = 152.4 * (1 - math.sqrt(0.5)), 152.4 * math.sqrt(0.5)
    heel, across = np.array([middle[0] - 75.0, 0.0, middle[1] + 75.0]), np.array([0.0, 400.0, 0.0])
    notch = Notch("bar", heel - across, heel + across, 20.0)
    covering = dataclasses.replace(bend(5), notches=(notch,))
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    assert [pattern.quantity for pattern in patterns] == [1] * 5
    plain = by_index(covering, whole)
    changed = [k for k in range(5) if patterns[k].net_area < plain[k].net_area - 1]
    assert changed == [2]
    outside = [rolled(covering, 2, hole.sampled(0.01))[0] for hole in patterns[2].holes if abs(hole.area) > 100]
    assert len(outside) == 1
    away = np.hypot(outside[0][:, 0] - heel[0], outside[0][:, 2] - heel[2])
    assert away == pytest.approx(20.0, abs=0.03)
