# SPDX-License-Identifier: LGPL-2.1-or-later
"""Materials of insulation and jackets: found by name, conductivity by temperature, tables graded honestly."""

import csv

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeworkbench.catalogue import (
    InsulationDistance,
    InsulationMaterial,
    InsulationThickness,
    JacketSheet,
    JacketThickness,
    StockThickness,
    catalogue,
    using_folder,
)
from pipeworkbench.errors import InputError
from pipeworkbench.insulation.materials import DEFAULT_MATERIAL, DEFAULT_SHEET, Material, material, materials, sheet_metal

ALL_KINDS = (InsulationDistance, InsulationMaterial, InsulationThickness, JacketSheet, JacketThickness, StockThickness)


def test_defaults_are_in_the_tables():
    assert material(DEFAULT_MATERIAL).name == DEFAULT_MATERIAL
    assert sheet_metal(DEFAULT_SHEET).name == DEFAULT_SHEET


def test_names_are_found_whatever_their_capitals():
    assert material("  Mineral WOOL ") == material("mineral wool")
    assert sheet_metal("Stainless steel").density == 7900


def test_misspelt_name_is_refused_with_the_likely_one():
    with pytest.raises(InputError, match=r"f\.json: layers: no material is called 'mineral wol'; did you mean 'mineral wool'\?"):
        material("mineral wol", "f.json", "layers")
    with pytest.raises(InputError, match="did you mean 'aluminium'"):
        sheet_metal("aluminum")


def test_unknown_name_is_refused_with_what_there_is():
    with pytest.raises(InputError, match=r"use one of aerogel blanket, .*glass wool.*, or add it to a table insulation_materials_"):
        material("straw")


def test_conductivity_lies_on_straight_lines_between_the_points():
    wool = Material("x", ((10.0, 0.03), (50.0, 0.04), (100.0, 0.06)))
    assert wool.conductivity(np.array([10, 30, 50, 75, 100])) == pytest.approx([0.03, 0.035, 0.04, 0.05, 0.06])


def test_conductivity_goes_on_above_and_stays_below_the_points():
    wool = Material("x", ((10.0, 0.03), (50.0, 0.04)))
    assert wool.conductivity([[-50, 90]]) == pytest.approx(np.array([[0.03, 0.05]]))
    # one that falls is not followed below its last figure
    assert Material("x", ((10.0, 0.04), (50.0, 0.03))).conductivity(1000.0) == pytest.approx(0.03)
    assert Material.constant("x", 0.5).conductivity(-10.0) == pytest.approx(0.5)


@given(temperature=st.floats(-200, 900), name=st.sampled_from([m.name for m in materials()]))
def test_conductivity_of_one_temperature_equals_that_of_an_array(temperature, name):
    own = material(name)
    assert own.conductivity_at(temperature) == pytest.approx(float(own.conductivity(temperature)), rel=1e-12)
    assert own.conductivity_at(temperature) > 0


@given(temperature=st.floats(-200, 900))
def test_insulation_conducts_no_better_when_cold(temperature):
    for own in materials():
        assert own.conductivity_at(temperature) <= own.conductivity_at(temperature + 10)


def test_figures_are_of_the_right_size():
    for own in materials():
        assert 0.015 < own.conductivity_at(20) < 0.08, own.name
        assert 10 < own.density < 300, own.name
        assert own.highest_temperature > 80, own.name


def test_users_material_is_found_and_takes_the_place_of_ours(tmp_path):
    (tmp_path / "insulation_materials_ours.csv").write_text(
        "name,conductivities,density\nfleece,20:0.05 80:0.06,90\nmineral wool,0:0.04,80\n", "utf-8"
    )
    with using_folder(tmp_path):
        assert material("fleece").points == ((20.0, 0.05), (80.0, 0.06))
        assert material("fleece").highest_temperature is None
        assert material("mineral wool").conductivity_at(500) == 0.04
    assert material("mineral wool").density == 120


@pytest.mark.parametrize(
    ("table", "text", "problem"),
    [
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,0.05,90\n", "column 'conductivities': '0.05' is not a temperature and"),
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,50:0.05 20:0.04,90\n", "the temperatures do not increase"),
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,50:0,90\n", "0 is no thermal conductivity"),
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,50:37000,90\n", "37000 is no thermal conductivity"),
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,-300:0.03,90\n", "-300 deg C is below absolute zero"),
        ("insulation_materials_x.csv", "name,conductivities,density\nfleece,,90\n", "column 'conductivities': is empty"),
        ("insulation_sheets_x.csv", "name,density,emissivity\ntin,7300,1.2\n", "column 'emissivity': is 1.2, not between 0 and 1"),
        ("insulation_thickness_x.csv", "thickness,share_of_diameter\n20,1\n", "2 of thickness, share_of_diameter and share_of_full are given"),
        ("insulation_thickness_x.csv", "case,share_of_full\nfull,1\n", "the case full is a share of itself"),
        ("insulation_thickness_x.csv", "from_diameter,to_diameter,thickness\n50,20,20\n", "is 50, not less than to_diameter 20"),
        ("insulation_thickness_x.csv", "measured_at,thickness\nmiddle,20\n", "is 'middle', not inner or outer"),
        ("insulation_jackets_x.csv", "sheet,from_diameter,to_diameter,thickness\ntin,50,20,1\n", "is 50, not less than to_diameter 20"),
    ],
)
def test_table_that_does_not_fit_is_refused_by_line_and_column(tmp_path, table, text, problem):
    (tmp_path / table).write_text(text, "utf-8")
    with pytest.raises(InputError) as error, using_folder(tmp_path):
        pass
    assert "line 2" in str(error.value)
    assert problem in str(error.value)


def test_every_figure_without_a_source_is_named():
    for kind in ALL_KINDS:
        for record in catalogue().records(kind):
            assert record.verified or record.unsourced, record


def test_tables_equal_the_sourced_facts_and_no_grade_is_raised(shared):
    with (shared / "standards" / "insulation.csv").open(encoding="utf-8", newline="") as file:
        facts = list(csv.DictReader(file))

    def grade(row):
        return min(2, len([source for source in row["sources"].split() if source != "memory"]))

    thicknesses = {(r.case, r.from_diameter or 0, r.to_diameter): r for r in catalogue().records(InsulationThickness)}
    jackets = {(r.sheet, r.from_diameter or 0, r.to_diameter): r for r in catalogue().records(JacketThickness)}
    stock = {r.thickness: r for r in catalogue().records(StockThickness)}
    used = 0
    for row in facts:
        lower, upper = float(row["from_mm"] or 0), float(row["to_mm"]) if row["to_mm"] else None
        if row["key"] == "inner_diameter":
            case = "cooling" if "cooling" in row["table"] else "full"
            record = thicknesses[case, lower, upper]
            value = "= inner diameter" if record.share_of_diameter == 1 else f"{record.thickness:g}"
        elif "cladding" in row["table"]:
            record = jackets[row["material_or_case"].replace("galvanised/aluminised", "galvanised"), lower, upper]
            value = f"{record.thickness:.1f}"
        elif row["key"] == "stock thickness":
            record, value = stock[float(row["value_mm"])], row["value_mm"]
        else:
            continue
        used += 1
        assert value == row["value_mm"], row
        assert record.verified <= grade(row), row
    assert used == 6 + 18 + len(stock)
