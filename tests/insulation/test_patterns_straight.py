# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight jackets: sizes and overlaps, parts that fit the sheet, rivets, beads, and notches against the cylinders they are for."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pattern_checks import check, check_all, common, marks

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns import patterns_of_covering
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import Notch, StraightCovering

SEAMS = Seams()
RADIUS = 57.15 + 50 + 0.4


def pipe(length=800.0, radius=57.15, begin=100.0, **more):
    return StraightCovering(**common(**more), radius=radius, begin=begin, end=begin + length)


def size_of(pattern):
    left, bottom, right, top = pattern.outline.bounds
    return right - left, top - bottom


def rolled(points, radius=RADIUS, begin=100.0, seam=0.0):
    """Roll points of a part laid with x along the pipe and its seam at y = 0 up."""
    angles = seam - points[:, 1] / radius
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), points[:, 0] + begin])


def test_a_jacket_is_as_wide_as_the_middle_of_its_sheet_around():
    (pattern,) = patterns_of_covering(pipe(), SEAMS, SheetSize())
    check(pattern)
    assert size_of(pattern) == pytest.approx((800 + 50, 2 * math.pi * RADIUS + 30))
    assert pattern.net_area == pytest.approx(2 * math.pi * RADIUS * 800)
    assert (pattern.id, pattern.grain, pattern.quantity, pattern.kind) == ("P1-1", "along", 1, "jacket")
    lines = {round(abs(path.points[0, 1]), 6) for path in marks(pattern, "CENTRE")}
    assert lines == {round(2 * math.pi * RADIUS * k / 4, 6) for k in (1, 2, 3)}


def test_overlap_lines_lie_where_the_overlaps_begin():
    (pattern,) = patterns_of_covering(pipe(), SEAMS)
    along, across = sorted(marks(pattern, "MARK"), key=lambda path: np.ptp(path.points[:, 1]))
    assert along.points[:, 1] == pytest.approx(-2 * math.pi * RADIUS)
    assert across.points[:, 0] == pytest.approx(800)


@settings(deadline=None, max_examples=30)
@given(st.floats(20, 6000), st.floats(15, 1000), st.floats(600, 1000), st.floats(600, 1500))
def test_parts_fit_the_sheet_and_cover_the_pipe(length, radius, width, height):
    size = SheetSize(width=width, height=height)
    patterns = patterns_of_covering(pipe(length, radius), SEAMS, size)
    for pattern in patterns:
        wide, tall = size_of(pattern)
        assert wide <= width - 20 + 1e-6
        assert tall <= height - 20 + 1e-6
        assert pattern.grain == "along"
    assert sum(p.quantity * p.net_area for p in patterns) == pytest.approx(2 * math.pi * (radius + 50.4) * length, rel=1e-9)


def test_long_jackets_are_parted_into_equal_sections():
    (pattern,) = check_all(patterns_of_covering(pipe(5000.0), SEAMS, SheetSize()))
    assert pattern.quantity == 3
    assert size_of(pattern)[0] == pytest.approx(5000 / 3 + 50)


def test_wide_jackets_run_around_along_the_sheet_before_they_are_parted():
    (once,) = check_all(patterns_of_covering(pipe(900.0, 200.0), SEAMS, SheetSize()))
    assert size_of(once) == pytest.approx((2 * math.pi * 250.4 + 30, 950))
    (halves,) = check_all(patterns_of_covering(pipe(900.0, 300.0), SEAMS, SheetSize()))
    assert halves.quantity == 2
    assert size_of(halves) == pytest.approx((math.pi * 350.4 + 30, 950))


def test_rivets_keep_their_pitch_within_the_overlap():
    (pattern,) = patterns_of_covering(pipe(), SEAMS)
    centres = np.array([hole.points.mean(axis=0) for hole in pattern.holes])
    assert centres[:, 1] == pytest.approx(-2 * math.pi * RADIUS - 15)
    steps = np.diff(np.sort(centres[:, 0]))
    assert steps.max() <= SEAMS.rivet_pitch
    assert len(centres) == 1 + math.ceil(770 / 150)
    assert all(hole.area == pytest.approx(math.pi / 4 * 4.1**2) for hole in pattern.holes)


@pytest.mark.parametrize("seams", [Seams(rivet_pitch=0.0), Seams(longitudinal_overlap=0.0), Seams(longitudinal_overlap=6.0)])
def test_without_pitch_or_overlap_there_are_no_rivets(seams):
    (pattern,) = patterns_of_covering(pipe(), seams)
    assert pattern.holes == ()


def test_beads_are_marked_and_their_allowance_is_added():
    plain, beaded = (patterns_of_covering(pipe(), Seams(bead=bead))[0] for bead in (False, True))
    check(beaded)
    assert size_of(beaded)[0] == pytest.approx(size_of(plain)[0] + 2 * 3.0)
    assert beaded.net_area == pytest.approx(plain.net_area)
    beads = [path for path in marks(beaded, "MARK") if not any(np.allclose(path.points, other.points) for other in marks(plain, "MARK"))]
    places = sorted(path.points[0, 0] for path in beads if np.ptp(path.points[:, 0]) == 0)
    # half the overlap from both ends; the overlap itself begins one allowance later
    assert places == pytest.approx([25, 803, 803 + 53 / 2])


def area_taken(notch, radius, begin, end):
    """The area of a cylinder that lies within a notch, by counting."""
    angles, heights = np.meshgrid((np.arange(1000) + 0.5) * 2 * np.pi / 1000, begin + (np.arange(1000) + 0.5) * (end - begin) / 1000)
    points = np.stack([radius * np.cos(angles), radius * np.sin(angles), heights], axis=-1)
    axis = (notch.end - notch.start) / np.linalg.norm(notch.end - notch.start)
    along = (points - notch.start) @ axis
    across = np.linalg.norm(points - notch.start - along[..., None] * axis, axis=-1)
    inside = (across < notch.radius) & (along > 0) & (along < np.linalg.norm(notch.end - notch.start))
    return inside.mean() * 2 * np.pi * radius * (end - begin)


NOTCHES = {
    "square through one side": Notch("bar", np.array([0.0, 0.0, 500.0]), np.array([0.0, 300.0, 500.0]), 40.0),
    "slanted": Notch("bar", np.array([-20.0, 40.0, 350.0]), np.array([-60.0, 250.0, 650.0]), 30.0),
    "ends in the sheet": Notch("bar", np.array([-300.0, 95.0, 450.0]), np.array([20.0, 95.0, 500.0]), 60.0),
    "along the pipe": Notch("bar", np.array([-110.0, 20.0, 300.0]), np.array([-110.0, 20.0, 700.0]), 30.0),
    "over the end": Notch("bar", np.array([-50.0, 90.0, 880.0]), np.array([-80.0, 300.0, 880.0]), 60.0),
    "over the seam": Notch("bar", np.array([50.0, 0.0, 500.0]), np.array([300.0, 10.0, 500.0]), 50.0),
}


@pytest.mark.parametrize("name", NOTCHES)
def test_notches_take_what_they_cover(name):
    notch = NOTCHES[name]
    covering = pipe(notches=(notch,))
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    assert not any("on site" in remark for pattern in patterns for remark in pattern.remarks)
    taken = area_taken(notch, RADIUS, 100.0, 900.0)
    assert taken > 1000
    assert 2 * math.pi * RADIUS * 800 - patterns[0].net_area == pytest.approx(taken, rel=1e-2)


@pytest.mark.parametrize("name", ["square through one side", "slanted"])
def test_a_hole_rolled_up_lies_on_its_notch(name):
    notch = NOTCHES[name]
    (pattern,) = patterns_of_covering(pipe(notches=(notch,)), SEAMS)
    hole = max(pattern.holes, key=lambda path: path.area)
    points = rolled(hole.sampled(0.001))
    axis = (notch.end - notch.start) / np.linalg.norm(notch.end - notch.start)
    across = points - notch.start - np.outer((points - notch.start) @ axis, axis)
    assert np.linalg.norm(across, axis=1) == pytest.approx(notch.radius, abs=0.03)


def test_a_hole_at_the_seam_is_cut_from_both_ends_of_the_sheet():
    (pattern,) = patterns_of_covering(pipe(notches=(NOTCHES["over the seam"],)), SEAMS)
    whole = patterns_of_covering(pipe(), SEAMS)[0]
    assert len(pattern.outline.points) > len(whole.outline.points) + 4
    assert all(hole.area < 20 for hole in pattern.holes)
    # no rivet hole where the overlap is cut away
    assert len(pattern.holes) < len(whole.holes)


def test_what_would_part_the_sheet_is_marked_for_the_site():
    notch = Notch("beam", np.array([-150.0, 0.0, 50.0]), np.array([-150.0, 0.0, 1000.0]), 60.0)
    (pattern,) = check_all(patterns_of_covering(pipe(notches=(notch,)), SEAMS))
    assert pattern.remarks == ("the opening for beam is marked and to be cut on site",)
    # both sides of the beam, over the whole sheet
    assert len([path for path in marks(pattern, "MARK") if path.length > 840]) == 2 + 1


@pytest.mark.parametrize("seam", [0.0, 2.0, -3.5])
@pytest.mark.parametrize(("start", "end"), [(850.0, 1200.0), (850.0, 910.0), (0.0, 150.0)])
def test_what_is_all_around_an_end_makes_the_jacket_shorter(start, end, seam):
    sleeve = Notch("sleeve", np.array([5.0, 0.0, start]), np.array([5.0, 0.0, end]), 200.0)
    (pattern,) = check_all(patterns_of_covering(pipe(notches=(sleeve,), seam=seam), SEAMS))
    assert pattern.remarks == ()
    assert pattern.net_area == pytest.approx(2 * math.pi * RADIUS * 750)
    # the overlap at the end is gone with it, what it parts from the rest too; at the begin there was none
    assert size_of(pattern)[0] == pytest.approx(750 if start else 800)


def test_what_is_all_around_the_middle_is_marked_for_the_site():
    sleeve = Notch("sleeve", np.array([0.0, 0.0, 300.0]), np.array([0.0, 0.0, 400.0]), 200.0)
    (pattern,) = check_all(patterns_of_covering(pipe(notches=(sleeve,)), SEAMS))
    assert pattern.remarks == ("the opening for sleeve is marked and to be cut on site",)
    places = sorted(path.points[0, 0] for path in marks(pattern, "MARK") if abs(np.ptp(path.points[:, 0])) < 1e-6)
    assert places == pytest.approx([200, 300, 800])


def test_only_the_section_with_a_notch_differs():
    notch = Notch("bar", np.array([0.0, 0.0, 4000.0]), np.array([0.0, 300.0, 4000.0]), 40.0)
    patterns = check_all(patterns_of_covering(pipe(5000.0, notches=(notch,)), SEAMS, SheetSize()))
    assert [(p.quantity, max(hole.area for hole in p.holes) > 4000) for p in patterns] == [(2, False), (1, True)]


@settings(deadline=None, max_examples=12)
@given(st.floats(-150, 150), st.floats(0, 1000), st.floats(10, 120), st.floats(-1, 1), st.floats(-1, 1), st.floats(0, 6.28))
def test_any_notch_leaves_a_part_that_can_be_cut(aside, height, radius, lean, across, seam):
    start = np.array([0.0, aside, height])
    notch = Notch("bar", start, start + 400.0 * np.array([1.0, across, lean]), radius)
    (pattern,) = patterns_of_covering(pipe(notches=(notch,), seam=seam), SEAMS)
    check(pattern)


@pytest.mark.parametrize("key", ["circumferential_overlap", "longitudinal_overlap"])
def test_overlaps_larger_than_the_sheet_are_refused_with_the_largest_that_works(key):
    size = SheetSize(width=1000.0, height=1000.0)
    with pytest.raises(InputError, match=rf"P1: {key}: 1000 mm .* give at most 97\d") as error:
        patterns_of_covering(pipe(), Seams(**{key: 1000.0}), size)
    largest = float(error.value.remedy.removeprefix("give at most ").partition(" mm")[0])
    assert patterns_of_covering(pipe(), Seams(**{key: largest}), size)
