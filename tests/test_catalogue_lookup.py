# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looking up the standards: by diameter, nominal diameter, type, pressure class; and what looks the same."""

import doctest

import pytest
from hypothesis import given
from hypothesis import strategies as st

import pipeworkbench.catalogue
from pipeworkbench.catalogue import (
    bends,
    caps,
    catalogue,
    equivalents,
    flanges_of_pipe,
    flanges_of_rim,
    pipe_sizes,
    pipe_walls,
    reducers,
    tees,
)

FLANGES = catalogue().flanges()


def flange(standard, kind, pn, dn):
    (found,) = catalogue().flanges(standard=standard, flange_type=kind, pn=pn, dn=dn)
    return found


def names(flanges):
    return {(other.standard, other.flange_type, other.pn) for other in flanges}


def test_examples_of_the_documentation_are_true():
    assert doctest.testmod(pipeworkbench.catalogue).failed == 0


def test_bends_of_a_diameter_are_its_three_types_by_radius():
    assert [(bend.bend_type, bend.bend_radius, bend.dn) for bend in bends(114.3)] == [("2D", 102, 100), ("3D", 152, 100), ("5D", 270, 100)]
    assert bends(114.4) == ()
    assert len(bends(114.4, tolerance=0.2)) == 3


def test_both_radii_are_given_where_the_standards_differ():
    assert [(bend.standard, bend.bend_radius) for bend in bends(48.3) if bend.bend_type == "5D"] == [("DIN 2605", 107.5), ("EN 10253", 108)]
    assert [bend.bend_radius for bend in bends(21.3)] == [17.5, 25, 28, 42.5, 45]


def test_long_bends_are_given_when_asked_for():
    assert [bend.bend_type for bend in catalogue().bends(60.3, types=None)] == ["2D", "3D", "5D", "10D", "20D"]
    assert [bend.bend_radius for bend in catalogue().bends(60.3, types=["10D"])] == [254]


def test_flange_is_found_by_standard_type_pn_and_dn():
    found = flange("EN 1092-1", "11", 16, 100)
    assert (found.D, found.K, found.L, found.bolts, found.bolt_size) == (220, 180, 18, 8, "M16")
    assert (found.C, found.length, found.neck_diameter, found.neck_straight, found.pipe_diameter) == (20, 52, 131, 12, 114.3)
    assert (found.raised_face_diameter, found.raised_face_height, found.blind) == (158, 3, False)
    assert found.designation == "EN 1092-1 type 11 DN 100 PN 16"
    assert catalogue().flanges(standard="EN 1092-1", flange_type="11", pn=16, dn=101) == ()


def test_plate_is_as_long_as_it_is_thick():
    plate, blind = flange("EN 1092-1", "01", 16, 40), flange("EN 1092-1", "05", 16, 40)
    assert (plate.length, plate.has_neck, plate.blind) == (plate.C, False, False)
    assert (blind.length, blind.has_neck, blind.blind) == (blind.C, False, True)
    assert flange("EN 1092-1", "11", 16, 40).has_neck


def test_flange_of_unknown_thickness_is_not_complete():
    assert not flange("EN 1092-1", "01", 16, 50).is_complete
    assert flange("EN 1092-1", "01", 16, 50).length is None
    # a neck can be drawn without its diameter
    assert flange("DIN 2633", "11", 16, 50).is_complete
    assert flange("DIN 2633", "11", 16, 50).has_neck


def test_rim_of_150_mm_belongs_to_dn_32_to_40_only():
    found = flanges_of_rim(150.3, 0.5)
    assert {other.dn for other in found} == {40}
    assert {"01", "05", "11", "12", "13"} == {other.flange_type for other in found}
    assert {other.pn for other in found} == {10, 16, 25, 40}


def test_flanges_of_a_pipe_have_its_diameter_or_are_its_blind_ones():
    found = flanges_of_pipe(114.3)
    assert {other.dn for other in found} == {100}
    assert {other.flange_type for other in found if other.blind} == {"05"}
    assert {other.standard for other in found if other.blind} == {"EN 1092-1", "DIN 2527"}
    assert flanges_of_pipe(110) == ()


def test_weld_neck_of_dn_40_looks_the_same_from_pn_10_to_40():
    assert names(equivalents(flange("EN 1092-1", "11", 16, 40))) == {
        ("EN 1092-1", "11", 10),
        ("EN 1092-1", "11", 25),
        ("EN 1092-1", "11", 40),
        ("DIN 2634", "11", 25),
        ("DIN 2635", "11", 40),
    }


def test_weld_necks_of_din_2632_and_2633_look_the_same_but_not_like_en():
    assert names(equivalents(flange("DIN 2632", "11", 10, 40))) == {("DIN 2633", "11", 16)}


def test_hubs_with_and_without_thread_look_the_same():
    assert ("EN 1092-1", "13", 16) in names(equivalents(flange("EN 1092-1", "12", 16, 40)))


def test_blind_flange_is_never_taken_for_a_plate():
    for other in (flange("EN 1092-1", "05", 6, 20), flange("EN 1092-1", "05", 25, 65)):
        assert all(same.blind for same in equivalents(other))


def test_neck_of_unknown_diameter_is_not_told_from_a_known_one():
    assert ("EN 1092-1", "11", 16) in names(equivalents(flange("DIN 2633", "11", 16, 65)))


@given(st.sampled_from(FLANGES), st.sampled_from(FLANGES))
def test_looking_the_same_is_mutual(one, other):
    assert one.looks_like(other) == other.looks_like(one)
    assert one.looks_like(one)


@given(st.sampled_from(FLANGES))
def test_equivalents_leave_the_flange_itself_out_and_have_its_rim_thickness_and_length(one):
    found = equivalents(one)
    assert one not in found
    assert all((other.D, other.C, other.length, other.pipe_diameter) == (one.D, one.C, one.length, one.pipe_diameter) for other in found)


@given(st.floats(50, 1400), st.floats(0, 60))
def test_rims_within_the_tolerance_are_found_all_and_no_others_nearest_first(diameter, tolerance):
    found = flanges_of_rim(diameter, tolerance)
    assert set(found) == {other for other in FLANGES if abs(other.D - diameter) <= tolerance}
    distances = [abs(other.D - diameter) for other in found]
    assert distances == sorted(distances)


@given(st.sampled_from(pipe_sizes()), st.floats(-0.049, 0.049))
def test_bends_of_a_measured_diameter_are_those_of_its_size(size, error):
    assert bends(size.outer_diameter + error) == bends(size.outer_diameter)


def test_nominal_diameter_gives_the_usual_outside_diameter_first():
    assert [size.outer_diameter for size in catalogue().pipe_sizes_of(50)] == [60.3]
    assert catalogue().pipe_sizes_of(51) == ()


def test_walls_of_a_diameter_ascend():
    walls = [wall.wall_thickness for wall in pipe_walls(48.3)]
    assert walls == sorted(walls)
    assert 2.6 in walls
    assert pipe_walls(49) == ()


def test_fittings_are_found_by_their_diameters():
    (tee,) = tees(60.3, 26.9)
    assert (tee.run_length, tee.branch_length, tee.equal) == (64, 44, False)
    assert tees(60.3, 60.3)[0].equal
    assert tees(26.9, 60.3) == ()
    assert {(reducer.standard, reducer.length) for reducer in reducers(76.1, 60.3)} == {("EN 10253", 89), ("DIN 2616", 90)}
    assert reducers(60.3, 76.1) == ()
    assert [cap.height for cap in caps(114.3)] == [64]


@pytest.mark.parametrize(("size", "unsourced"), [(10.2, ("outer_diameter", "wall_thickness")), (48.3, ()), (457, ("wall_thickness",))])
def test_pipe_size_names_what_has_no_source(size, unsourced):
    assert catalogue().pipe_size(size).unsourced == unsourced
