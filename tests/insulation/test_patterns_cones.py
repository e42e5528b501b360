# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cones: true lengths of their straight lines and edges, areas of the ruled faces, nearly straight ones."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pattern_checks import SHEET, check, check_all, common, marks

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns import patterns_of_covering
from pipeworkbench.insulation.patterns.cones import development
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import ConeCovering, Notch

SEAMS = Seams()
GROWN = 50.4


def cone(radius=84.0, end_radius=57.0, length=140.0, offset=0.0, **more):
    return ConeCovering(**common("R1", **more), radius=radius, end_radius=end_radius, length=length, offset=offset)


def in_space(covering, angles):
    """Return the points of both edges in space."""
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
    return (covering.radius + GROWN) * circle, (covering.end_radius + GROWN) * circle + (covering.offset, 0.0, covering.length)


@settings(deadline=None, max_examples=20)
@given(st.floats(10, 500), st.floats(10, 500), st.floats(20, 600), st.floats(-1, 1))
def test_development_keeps_lengths(radius, end_radius, length, share):
    covering = cone(radius, end_radius, length, share * abs(radius - end_radius))
    assume(abs(radius - end_radius) > 1 or abs(covering.offset) < 1e-3)
    developed = development(covering, SHEET)
    angles = np.linspace(0, 2 * math.pi, 801)
    lower, upper = developed.lower(angles, 0.0), developed.upper(angles, 0.0)
    first, second = in_space(covering, angles)
    # straight lines and diagonals between them are as long in the plane as in space: nothing is stretched or sheared
    assert np.hypot(*(upper - lower).T) == pytest.approx(np.linalg.norm(second - first, axis=1), abs=1e-7)
    for flat, solid in ((lower, first), (upper, second)):
        chords, true = np.hypot(*np.diff(flat, axis=0).T), np.linalg.norm(np.diff(solid, axis=0), axis=1)
        assert chords == pytest.approx(true, rel=2e-5)
        assert chords.sum() == pytest.approx(true.sum(), rel=2e-5)
    diagonal = np.hypot(*(upper[1:] - lower[:-1]).T)
    assert diagonal == pytest.approx(np.linalg.norm(second[1:] - first[:-1], axis=1), rel=1e-4)


def test_angle_between_developed_lines_is_that_of_a_fine_sum():
    covering = cone(offset=27.0)
    developed = development(covering, SHEET)
    # with 2^17 chords of the wide circle, extrapolated
    sums = []
    apex = np.array([27.0, 0.0, 140.0]) * (84 + GROWN) / 27 * np.array([1, 0, 1])
    for n in (2**15, 2**16, 2**17):
        angles = np.linspace(math.pi, 2 * math.pi, n + 1)
        to = in_space(covering, angles)[0] - apex
        lengths = np.linalg.norm(to, axis=1)
        chords = 2 * (84 + GROWN) * math.sin(math.pi / 2 / n)
        sums.append(2 * np.sum(np.arcsin(np.sqrt((chords**2 - np.diff(lengths) ** 2) / (4 * lengths[1:] * lengths[:-1])))))
    truth = sums[2] + (sums[2] - sums[1]) / 3
    point = developed.lower(np.array([2 * math.pi]), 0.0)[0]
    lengths = np.linalg.norm(in_space(covering, np.array([2 * math.pi, math.pi]))[0] - apex, axis=1)
    psi = math.atan2(point[0], lengths[1] - point[1])
    assert psi == pytest.approx(truth, abs=1e-9)


@pytest.mark.parametrize(
    ("radius", "end_radius", "length", "offset"), [(84, 57, 140, 27), (84, 57, 140, 0), (200, 60, 100, 60), (60, 150, 90, 50), (84, 84, 140, 0)]
)
def test_net_area_is_that_of_the_ruled_face(radius, end_radius, length, offset):
    import cadquery as cq

    covering = cone(radius, end_radius, length, offset)
    patterns = check_all(patterns_of_covering(covering, SEAMS))
    wires = [
        cq.Wire.makeCircle(radius + GROWN, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1)),
        cq.Wire.makeCircle(end_radius + GROWN, cq.Vector(offset, 0, length), cq.Vector(0, 0, 1)),
    ]
    face = [f for f in cq.Solid.makeLoft(wires, True).Faces() if f.geomType() != "PLANE"]
    assert sum(p.net_area * p.quantity for p in patterns) == pytest.approx(sum(f.Area() for f in face), rel=1e-4)


def test_edges_of_the_pattern_are_as_long_as_the_circles():
    for offset in (0.0, 27.0):
        (pattern,) = patterns_of_covering(cone(offset=offset), SEAMS)
        lengths = sorted(path.length for path in marks(pattern, "FOLD"))
        assert lengths == pytest.approx([2 * math.pi * (57 + GROWN), 2 * math.pi * (84 + GROWN)], abs=0.02)


def test_a_right_cone_is_made_of_true_arcs():
    (pattern,) = patterns_of_covering(cone(end_radius=40.0), SEAMS)
    slant = math.hypot(140, 44)
    radii = [(r + GROWN) * slant / 44 for r in (40, 84)]
    for path, radius in zip(sorted(marks(pattern, "FOLD"), key=lambda p: p.length), radii, strict=True):
        starts, ends, bulges = path.segments
        assert abs(np.hypot(*(ends - starts).T) * (1 + bulges**2) / (4 * bulges)) == pytest.approx(radius, rel=1e-6)
        assert len(bulges) <= 4


def test_the_seam_of_an_eccentric_cone_lies_on_its_shortest_line():
    for radii in ((84.0, 57.0), (57.0, 84.0)):
        (pattern,) = patterns_of_covering(cone(*radii, offset=27.0), SEAMS)
        seam = next(path for path in marks(pattern, "MARK") if len(path.points) == 2)
        assert seam.length - 2 * SEAMS.gore_overlap == pytest.approx(140, abs=1e-6)


@settings(deadline=None, max_examples=20)
@given(st.floats(-9, 1), st.sampled_from([-1, 1]))
def test_nearly_straight_cones_go_over_into_a_rectangle(exponent, sign):
    (pattern,) = patterns_of_covering(cone(84.0, 84.0 + sign * 10**exponent), SEAMS)
    check(pattern)
    left, bottom, right, top = pattern.outline.bounds
    around = 2 * math.pi * (84 + GROWN)
    assert right - left == pytest.approx(around + 30, abs=10**exponent * 10 + 1e-6)
    assert top - bottom == pytest.approx(140 + 2 * SEAMS.gore_overlap, abs=10**exponent * 10 + 1e-6)


@settings(deadline=None, max_examples=10)
@given(st.floats(10, 300), st.floats(10, 300), st.floats(5, 600), st.floats(0, 1.2))
def test_any_cone_makes_parts_that_can_be_cut(radius, end_radius, length, share):
    offset = share * abs(radius - end_radius)
    assume(abs(radius - end_radius) > 0.01 or offset < 1e-3)
    patterns = check_all(patterns_of_covering(cone(radius, end_radius, length, offset), SEAMS, SheetSize()))
    assert all(min(p.outline.bounds[2] - p.outline.bounds[0], p.outline.bounds[3] - p.outline.bounds[1]) <= 980 for p in patterns)


def test_a_flat_cone_is_parted_where_its_overlap_would_lie_on_itself():
    patterns = check_all(patterns_of_covering(cone(300.0, 30.0, 20.0), SEAMS))
    assert [p.quantity for p in patterns] == [2]


def test_a_notch_is_cut_where_it_meets_the_cone():
    first, second = in_space(cone(offset=27.0), np.array([2.0]))
    middle = (first[0] + second[0]) / 2
    notch = Notch("bar", np.array([0.0, 0.0, middle[2]]), middle * (3.0, 3.0, 1.0), 20.0)
    (pattern,) = check_all(patterns_of_covering(cone(offset=27.0, notches=(notch,)), SEAMS))
    (plain,) = patterns_of_covering(cone(offset=27.0), SEAMS)
    assert len(pattern.holes) == len(plain.holes) + 1
    # a cylinder of 20 mm square through a sheet that is bent and leans a little
    assert plain.net_area - pattern.net_area == pytest.approx(math.pi * 20**2, rel=0.05)
    assert plain.net_area - pattern.net_area > math.pi * 20**2


def test_an_oblique_tube_is_refused():
    with pytest.raises(InputError, match=r"R1: end_diameter: .* oblique tube"):
        patterns_of_covering(cone(84.0, 84.0, 140.0, 20.0), SEAMS)


def test_a_cone_longer_than_the_sheet_is_refused():
    with pytest.raises(InputError, match=r"R1: sheet_size: .* longest line"):
        patterns_of_covering(cone(length=700.0), SEAMS, SheetSize(width=600.0, height=600.0))
