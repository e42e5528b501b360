# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thicknesses by table, by heat loss, by surface temperature, from stock; jackets by DIN 4140."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeworkbench.catalogue import using_folder
from pipeworkbench.errors import InputError
from pipeworkbench.insulation.materials import Material, material
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.thickness import (
    Band,
    BandsRule,
    HeatLossRule,
    Situation,
    SurfaceTemperatureRule,
    TableRule,
    converted,
    inner_diameter,
    jacket_thickness,
    stock_thickness,
    thickness_by,
)

REFERENCE = Material.constant("reference", 0.035)
HOT = Operation(medium_temperature=150.0)


def around(outer, wall=None, own=REFERENCE, operation=HOT, **more):
    return Situation(name="P1", outer_diameter=outer, wall_thickness=wall, material=own, operation=operation, **more)


def geg(outer, wall, case="full", own=REFERENCE):
    return thickness_by(TableRule(case=case), around(outer, wall, own)).value


# ---------------------------------------------------------------- GEG


@pytest.mark.parametrize(
    ("inner", "thickness"),
    [(10.0, 20), (22.0, 20), (22.1, 30), (35.0, 30), (35.1, 36), (60.0, 60), (99.9, 100), (100.0, 100), (100.1, 100), (500.0, 100)],
)
def test_geg_goes_by_the_inner_diameter_with_its_upper_bounds_included(inner, thickness):
    # whole millimetres, rounded up
    assert geg(inner + 6, 3.0) == thickness


def test_geg_cases_are_half_double_and_fixed():
    assert geg(66.0, 3.0, "half") == 30
    assert geg(66.0, 3.0, "double") == 120
    assert geg(66.0, 3.0, "floor") == 6
    assert geg(21.3, 2.0, "half") == 10


def test_geg_cooling_has_two_steps():
    assert geg(21.3, 2.0, "cooling") == 9
    assert geg(48.3, 2.6, "cooling") == 19


def test_unknown_wall_is_the_normal_one_of_en_10220_and_told():
    found = thickness_by(TableRule(), around(60.3))
    assert found.value == math.ceil(60.3 - 2 * 2.9)
    assert any("wall 2.9 mm assumed: normal wall of EN 10220" in remark for remark in found.remarks)
    assert thickness_by(TableRule(), around(60.3, 2.9)).remarks == ()


def test_unverified_wall_is_told_as_such():
    assert inner_diameter(10.2, None)[1] == ("wall 1.6 mm assumed: normal wall of EN 10220 (not verified against the standard)",)


def test_diameter_of_no_standard_counts_as_the_inner_one():
    inner, remarks = inner_diameter(77.7, None)
    assert inner == 77.7
    assert "not known" in remarks[0]


def test_conversion_keeps_the_loss_per_metre():
    # by hand: 60.3 mm, 54.5 mm of 0.035 against s of 0.05 W/(m K), 10 W/(m2 K) outside
    value = converted(54.5, 60.3, 0.05, 0.035)
    outer, table = 60.3 + 2 * value, 60.3 + 2 * 54.5
    own = math.log(outer / 60.3) / (2 * math.pi * 0.05) + 1 / (math.pi * outer / 1000 * 10)
    asked = math.log(table / 60.3) / (2 * math.pi * 0.035) + 1 / (math.pi * table / 1000 * 10)
    assert own == pytest.approx(asked, rel=1e-9)
    # somewhat more than the ratio of the logarithms alone, for the thicker layer has a wider surface
    assert value > 60.3 / 2 * ((table / 60.3) ** (0.05 / 0.035) - 1) > 54.5


@given(outer=st.floats(10, 400), thickness=st.floats(5, 120), conductivity=st.floats(0.015, 0.1))
def test_conversion_there_and_back_is_the_thickness(outer, thickness, conductivity):
    there = converted(thickness, outer, conductivity, 0.035)
    if there > 1:  # less is beneath the critical radius, where the way back is not unique
        assert converted(there, outer, 0.035, conductivity) == pytest.approx(thickness, abs=1e-4)
    assert (there > thickness) == (conductivity > 0.035) or conductivity == pytest.approx(0.035)


def test_better_insulation_may_be_thinner_and_is_told():
    found = thickness_by(TableRule(), around(60.3, 2.9, Material.constant("good", 0.025)))
    assert found.value < 54
    assert any("converted to 0.025 W/(m K) of good" in remark for remark in found.remarks)


def test_conductivity_is_taken_at_the_tables_temperature():
    steep = Material("steep", ((10.0, 0.035), (40.0, 0.05)))
    assert geg(21.3, 2.0, "cooling", steep) == 9
    assert geg(21.3, 2.0, "full", steep) > 20


def test_unknown_table_and_case_are_refused_with_those_there_are():
    with pytest.raises(InputError, match=r"P1: thickness\.table: no table is called 'ours'; use one of GEG Annex 8"):
        thickness_by(TableRule(table="ours"), around(60.3))
    with pytest.raises(InputError, match=r"has no case 'quarter'; use one of cooling, double, floor, full, half"):
        thickness_by(TableRule(case="quarter"), around(60.3))


def test_users_table_by_outer_diameter(tmp_path):
    text = "standard,to_diameter,thickness\nour works,50,25\n"
    (tmp_path / "insulation_thickness_ours.csv").write_text(text, "utf-8")
    with using_folder(tmp_path):
        found = thickness_by(TableRule(table="our works"), around(48.3))
        assert found.value == 25
        assert found.remarks == ("our works, case full: not verified against the standard",)
        with pytest.raises(InputError, match=r"our works, case full, has no row for 60\.3 mm"):
            thickness_by(TableRule(table="our works"), around(60.3))


# ---------------------------------------------------------------- bands, stock


def test_bands_are_open_below_and_closed_above():
    rule = BandsRule(bands=(Band(thickness=20.0, to_diameter=48.3), Band(thickness=30.0, from_diameter=48.3, to_diameter=114.3)))
    assert thickness_by(rule, around(48.3)).value == 20
    assert thickness_by(rule, around(48.4)).value == 30
    with pytest.raises(InputError, match=r"P1: thickness\.bands: no band holds 219\.1 mm"):
        thickness_by(rule, around(219.1))
    assert thickness_by(replace(rule, measured_at="inner"), around(50.0, 3.0)).value == 20


def test_stock_thickness_is_the_next_that_is_no_thinner():
    assert [stock_thickness(s).value for s in (1, 20, 20.1, 54.5, 60, 100.5, 160)] == [20, 20, 25, 60, 60, 120, 160]
    assert "no standard" in stock_thickness(30).remarks[0]


def test_more_than_the_thickest_of_stock_is_laid_in_layers():
    found = stock_thickness(171)
    assert found.value == 180
    assert "several layers" in found.remarks[0]


def test_rule_with_stock_gives_a_stock_thickness():
    assert thickness_by(TableRule(stock=True), around(60.3, 2.9)).value == 60


# ---------------------------------------------------------------- heat loss, surface temperature


@given(outer=st.floats(20, 400), limit=st.floats(15, 200), medium=st.floats(60, 350))
def test_thickness_for_a_heat_loss_is_the_least_whole_millimetre(outer, limit, medium):
    situation = around(outer, own=material("mineral wool"), operation=Operation(medium_temperature=medium))
    try:
        value = thickness_by(HeatLossRule(at_most=limit), situation).value
    except InputError:
        assert situation.flow(1000.0).flow > limit
        return
    assert situation.flow(value).flow <= limit * (1 + 1e-6)
    assert value == 10 or situation.flow(value - 1).flow > limit


@given(outer=st.floats(20, 400), limit=st.floats(30, 70), medium=st.floats(80, 350))
def test_thickness_for_a_surface_temperature_is_the_least_whole_millimetre(outer, limit, medium):
    situation = around(outer, own=material("mineral wool"), operation=Operation(medium_temperature=medium), emissivity=0.13)
    try:
        value = thickness_by(SurfaceTemperatureRule(at_most=limit), situation).value
    except InputError:
        assert situation.flow(1000.0).surface_temperature > limit
        return
    assert situation.flow(value).surface_temperature <= limit + 1e-6
    assert value == 10 or situation.flow(value - 1).surface_temperature > limit


def test_layers_beneath_and_above_count():
    alone = thickness_by(HeatLossRule(at_most=30.0), around(114.3)).value
    beneath = thickness_by(HeatLossRule(at_most=30.0), around(114.3, inside=((REFERENCE, 20.0),))).value
    above = thickness_by(HeatLossRule(at_most=30.0), around(114.3, outside=((REFERENCE, 20.0),))).value
    # of one constant conductivity, only the sum matters
    assert beneath == above == alone - 20


def test_loss_that_needs_next_to_nothing_gets_the_least_thickness_and_says_so():
    found = thickness_by(HeatLossRule(at_most=5000.0), around(48.3))
    assert found.value == 10
    assert "no more than the least thickness" in found.remarks[0]


def test_loss_that_cannot_be_reached_is_refused_with_the_least_that_can():
    situation = around(219.1, own=material("mineral wool"))
    with pytest.raises(InputError, match=r"P1: thickness.at_most: a heat loss of 1 W/m is not reached with 1000 mm .*; give ([0-9.]+) W/m") as error:
        thickness_by(HeatLossRule(at_most=1.0), situation)
    told = float(str(error.value).rpartition("give ")[2].split(" ")[0])
    assert situation.flow(1000.0).flow <= told <= 1.01 * situation.flow(1000.0).flow
    assert thickness_by(HeatLossRule(at_most=told), situation).value <= 1000.0


def test_surface_colder_than_the_air_is_refused():
    with pytest.raises(InputError, match="20 deg C is not more than the surroundings' 20 deg C; give more than 20"):
        thickness_by(SurfaceTemperatureRule(at_most=20.0), around(48.3))


def test_rule_of_heat_needs_the_mediums_temperature():
    with pytest.raises(InputError, match=r"P1: operation\.medium_temperature: is missing"):
        thickness_by(HeatLossRule(at_most=20.0), around(48.3, operation=Operation()))


# ---------------------------------------------------------------- jackets


@pytest.mark.parametrize(
    ("sheet", "diameter", "thickness"),
    [("aluminium", 400, 0.6), ("aluminium", 400.1, 0.8), ("Aluminium", 9000, 1.2), ("stainless steel", 1000, 0.6), ("galvanised steel", 700, 0.6)],
)
def test_jacket_goes_by_the_finished_diameter_and_says_that_it_is_not_verified(sheet, diameter, thickness):
    found = jacket_thickness(sheet, diameter)
    assert found.value == thickness
    assert "after DIN 4140 (not verified against the standard)" in found.remarks[0]


def test_sheet_without_a_row_is_refused():
    with pytest.raises(InputError, match="P1: jacket: no thickness for lead around 200 mm is in the tables; give the sheet's thickness"):
        jacket_thickness("lead", 200.0, "P1", "jacket")


def test_users_jacket_goes_before_the_standards(tmp_path):
    (tmp_path / "insulation_jackets_ours.csv").write_text("sheet,thickness,verified\naluminium,1.0,2\n", "utf-8")
    with using_folder(tmp_path):
        assert jacket_thickness("aluminium", 200.0).value == 1.0
        assert jacket_thickness("aluminium", 200.0).remarks == ()
