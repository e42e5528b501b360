# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes, pots and discs: numbers and areas of their parts, slits, sectors for small sheets; parts of a whole plan."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from pattern_checks import SHEET, check_all, common, marks

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns import patterns_of, patterns_of_covering
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import BoxCovering, CapCovering, Notch, StopCovering

SEAMS = Seams()
GROWN = 50.4


def box(openings=(110.0, 110.0), **more):
    return BoxCovering(**common("F1 box", **more), radius=160.0, begin=-200.0, end=220.0, openings=openings)


def cap(**more):
    return CapCovering(**common("C1", **more), radius=57.15, length=80.0)


def stop(radius=57.15, outer=107.95):
    return StopCovering(**common("S1") | {"layers": ()}, radius=radius, outer_radius=outer)


def test_a_box_is_two_mantles_and_four_half_faces():
    mantle, face = check_all(patterns_of_covering(box(), SEAMS, SheetSize()))
    assert [(p.kind, p.quantity) for p in (mantle, face)] == [("box mantle", 2), ("box face", 4)]
    radius = 160 + GROWN
    # between the middles of the sheets of both ends
    assert 2 * mantle.net_area == pytest.approx(2 * math.pi * radius * (420 - 0.8))
    assert 4 * face.net_area == pytest.approx(2 * math.pi * (radius**2 - 110**2))
    left, bottom, right, top = mantle.outline.bounds
    assert (right - left, top - bottom) == pytest.approx((419.2, math.pi * radius + 30))


def test_different_openings_make_different_faces_and_a_closed_end_none():
    _, first, second = check_all(patterns_of_covering(box((110.0, 0.0)), SEAMS, SheetSize()))
    assert (first.quantity, second.quantity) == (2, 2)
    assert 2 * second.net_area == pytest.approx(math.pi * (160 + GROWN) ** 2)


def test_latches_are_marked_at_both_joints_and_nothing_is_riveted_there():
    mantle, face = patterns_of_covering(box(), SEAMS)
    latches = [path for path in marks(mantle, "MARK") if path.closed]
    assert len(latches) == 2 * 2
    assert mantle.holes == ()
    assert face.holes == ()


def test_a_large_box_has_its_latches_at_its_joints_alone():
    large = dataclasses.replace(box((500.0, 500.0)), radius=900.0)
    patterns = check_all(patterns_of_covering(large, SEAMS, SheetSize()))
    mantles = [p for p in patterns if p.kind == "box mantle"]
    latches = [len([path for path in marks(p, "MARK") if path.closed]) for p in mantles]
    # each half is two parts: the first has the catches and is riveted to the second, which has the latches
    assert [(p.quantity, count, len(p.holes) > 0) for p, count in zip(mantles, latches, strict=True)] == [(2, 2, True), (2, 2, False)]


def test_a_pot_is_a_mantle_and_a_disc():
    mantle, disc = check_all(patterns_of_covering(cap(), SEAMS, SheetSize()))
    radius = 57.15 + GROWN
    assert mantle.net_area == pytest.approx(2 * math.pi * radius * (80 + 50.4))
    assert disc.net_area == pytest.approx(math.pi * radius**2)
    left, _, right, _ = mantle.outline.bounds
    # it goes over the pipe's jacket at its mouth
    assert (left, right - left) == pytest.approx((-50, 80 + 50.4 + 50))
    assert disc.outline.bounds == pytest.approx((-radius - 10, -radius - 10, radius + 10, radius + 10))
    assert marks(disc, "FOLD")[0].area == pytest.approx(math.pi * radius**2)


def test_a_stop_is_a_slit_ring_with_play():
    (disc,) = check_all(patterns_of_covering(stop(), SEAMS, SheetSize()))
    assert disc.net_area == pytest.approx(math.pi * (107.95**2 - 57.15**2))
    points = disc.outline.sampled(0.01)
    radii = np.hypot(*points.T)
    assert radii.min() == pytest.approx(58.15)
    assert radii.max() == pytest.approx(117.95)
    # one outline: the slit connects its border with the hole
    assert disc.holes == ()
    slit = (117.95 - 58.15) * 2
    assert disc.outline.area == pytest.approx(math.pi * (117.95**2 - 58.15**2) - slit, abs=2)


def test_a_disc_larger_than_the_sheet_is_made_of_sectors():
    size = SheetSize(width=1000.0, height=1000.0)
    (sector,) = check_all(patterns_of_covering(stop(300.0, 600.0), SEAMS, size))
    assert sector.quantity > 1
    assert sector.quantity * sector.net_area == pytest.approx(math.pi * (600**2 - 300**2))
    assert len(sector.holes) > 0
    left, bottom, right, top = sector.outline.bounds
    assert max(right - left, top - bottom) <= 980
    with pytest.raises(InputError, match="S1: sheet_size: a ring of 8000 mm"):
        patterns_of_covering(stop(300.0, 4000.0), SEAMS, size)


def test_a_stop_without_width_is_refused():
    with pytest.raises(InputError, match="S1: thickness"):
        patterns_of_covering(stop(57.15, 58.0), SEAMS)


def test_notches_of_faces_are_told():
    notch = Notch("bar", np.array([150.0, 0.0, 100.0]), np.array([150.0, 0.0, 300.0]), 20.0)
    patterns = check_all(patterns_of_covering(box(notches=(notch,)), SEAMS))
    told = [pattern for pattern in patterns if pattern.remarks]
    assert [(p.kind, p.remarks) for p in told] == [("box face", ("the opening for bar is to be cut on site",))]


def test_a_plan_gives_the_patterns_of_all_its_jackets():
    bare = dataclasses.replace(cap(), id="C2", sheet=None)
    pieces = [SimpleNamespace(covering=covering, treatment=SimpleNamespace(seams=SEAMS)) for covering in (box(), bare, cap())]
    small = SheetSize(width=300.0, height=300.0)
    plan = SimpleNamespace(pieces=pieces, specification=SimpleNamespace(sheet_sizes=(small, SheetSize())))
    patterns = check_all(patterns_of(plan))
    assert [pattern.id for pattern in patterns] == ["F1 box-1", "F1 box-2", "C1-1", "C1-2"]
    assert {pattern.sheet for pattern in patterns} == {SHEET}
    assert {pattern.component for pattern in patterns} == {"F1 box", "C1"}
