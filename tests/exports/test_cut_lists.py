# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut and material lists: areas, volumes and weights against hand calculation; texts never become formulas."""

import csv
import math
import sys
from dataclasses import dataclass

import numpy as np
import openpyxl
import pytest
from flat_parts import ALUMINIUM, ODD_ID, STEEL, disc, gore, gore_area, jacket

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.exports.cut_lists import cut_lists, write_cut_list_csv, write_cut_list_xlsx, write_material_list_csv
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.treatment import SheetSize
from pipeworkbench.solids.covering_quantities import layer_volumes
from pipeworkbench.solids.coverings import AnyCovering, BoxCovering, Layer, Sheet, StopCovering, StraightCovering, TeeCovering
from pipeworkbench.solids.frames import Frame

SHEET_DENSITIES = {"aluminium": 2700.0, "galvanised steel": 7850.0}
LAYER_DENSITIES = {"mineral wool": 80.0}
FRAME = Frame(np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, 1.0]))
WOOL, FOAM = Layer("mineral wool", 40.0), Layer("foam", 20.0)


@dataclass(frozen=True)
class Piece:
    covering: AnyCovering
    run: str


def straight(name, length, *layers, radius=24.15):
    return StraightCovering(id=name, component=name.split(" ")[0], frame=FRAME, layers=layers, sheet=ALUMINIUM, radius=radius, begin=0.0, end=length)


def lists_of(patterns, sheets=(), pieces=()):
    return cut_lists(patterns, sheets, pieces, sheet_density=SHEET_DENSITIES.get, layer_density=LAYER_DENSITIES.get)


@pytest.fixture
def patterns():
    return [jacket(quantity=2, remarks=("bead", "rivets")), gore(), disc()]


@pytest.fixture
def lists(patterns):
    pieces = [Piece(straight("P1 jacket", 1500.0, WOOL, FOAM), "R1"), Piece(straight("P2 jacket", 500.0, WOOL), "R2")]
    return lists_of(patterns, nest(patterns, [SheetSize(1250.0, 1000.0)]), pieces)


def test_a_part_has_its_areas_and_its_weight(lists):
    sheet, hoop, ring = lists.cuts
    area = (600 * 300 - 2 * math.pi * 4) / 1e6
    assert sheet["gross_area_m2"] == pytest.approx(area, rel=1e-6)
    assert sheet["net_area_m2"] == pytest.approx(0.171)
    assert sheet["weight_kg"] == pytest.approx(area * 0.0008 * 2700, rel=1e-5)
    assert sheet["total_weight_kg"] == pytest.approx(2 * area * 0.0008 * 2700, rel=1e-5)
    assert (sheet["run"], sheet["component"], sheet["remarks"], sheet["sheets"]) == ("R1", "P1", "bead; rivets", "1")
    assert hoop["total_area_m2"] == pytest.approx(3 * gore_area() / 1e6, rel=1e-6)
    assert (hoop["width_mm"], hoop["height_mm"], hoop["quantity"], hoop["run"]) == (400.0, 100.0, 3, "")
    assert ring["weight_kg"] == pytest.approx(math.pi * (0.1**2 - 0.06**2) * 0.001 * 7850, rel=1e-5)
    assert ring["sheets"] == "2"


def test_sheet_metal_is_summed_with_sheets_and_waste(lists):
    aluminium, steel = lists.metals
    gross = 2 * (600 * 300 - 8 * math.pi) + 3 * gore_area()
    assert aluminium["parts_area_m2"] == pytest.approx(gross / 1e6, abs=1e-6)
    assert (aluminium["pieces"], aluminium["sheet_count"], aluminium["sheet_area_m2"]) == (5, 1, 1.25)
    assert aluminium["waste_m2"] == pytest.approx(1.25 - gross / 1e6, abs=1e-6)
    assert aluminium["waste_percent"] == pytest.approx(100 - lists.sheets[0]["used_percent"], abs=0.01)
    assert aluminium["sheet_weight_kg"] == pytest.approx(1.25 * 0.0008 * 2700)
    assert (steel["material"], steel["thickness_mm"], steel["pieces"]) == (STEEL.material, 1.0, 2)


def test_insulation_is_summed_by_material_and_thickness(lists):
    foam, wool = lists.insulation
    inner, middle, outer = 24.15, 64.15, 84.15
    assert wool["volume_m3"] == pytest.approx(math.pi * (middle**2 - inner**2) * 2000 / 1e9, abs=1e-9)
    assert wool["outer_area_m2"] == pytest.approx(2 * math.pi * middle * 2000 / 1e6, abs=1e-6)
    assert wool["total_weight_kg"] == pytest.approx(80 * math.pi * (middle**2 - inner**2) * 2000 / 1e9, abs=1e-5)
    assert foam["volume_m3"] == pytest.approx(math.pi * (outer**2 - middle**2) * 1500 / 1e9, abs=1e-9)
    assert foam["total_weight_kg"] is None  # its density is not known


def test_sections_are_summed_by_inner_diameter(lists):
    sections = {(row["material"], row["inner_diameter_mm"]): (row["kind"], row["pieces"], row["length_m"]) for row in lists.sections}
    assert sections == {("mineral wool", 48.3): ("straight", 2, 2.0), ("foam", 128.3): ("straight", 1, 1.5)}


def test_each_layer_is_listed_with_what_it_is_cut_to(lists):
    keys = ("covering", "run", "material", "inner_diameter_mm", "outer_diameter_mm", "length_mm")
    assert [tuple(row[key] for key in keys) for row in lists.coverings] == [
        ("P1 jacket", "R1", "mineral wool", 48.3, 128.3, 1500.0),
        ("P1 jacket", "R1", "foam", 128.3, 168.3, 1500.0),
        ("P2 jacket", "R2", "mineral wool", 48.3, 128.3, 500.0),
    ]
    wool = lists.coverings[0]
    assert wool["weight_kg"] == pytest.approx(80 * math.pi * (64.15**2 - 24.15**2) * 1500 / 1e9, abs=1e-5)
    assert lists.coverings[1]["weight_kg"] is None
    assert sum(row["volume_m3"] for row in lists.coverings) == pytest.approx(sum(row["volume_m3"] for row in lists.insulation), abs=1e-8)


def test_remarks_are_in_the_language_of_the_list(tmp_path):
    remarks = ("throat 0.8 mm, heel 35.3 mm", "the opening for P 7 box, all around, is to be cut on site", "bead")
    write_cut_list_xlsx(lists_of([gore(remarks=remarks)]), tmp_path / "cuts.xlsx", language="de")
    cell = openpyxl.load_workbook(tmp_path / "cuts.xlsx")["Zuschnitt"]["P2"]
    assert cell.value == "Kehle 0.8 mm, Rücken 35.3 mm; Ausschnitt für P 7 box rundum auf der Baustelle schneiden; bead"


def test_layers_of_a_box_have_their_own_outer_areas():
    box = BoxCovering(
        id="B", component="F1", frame=FRAME, layers=(WOOL,), sheet=Sheet("aluminium", 1.0), radius=100.0, begin=0.0, end=400.0, openings=(0, 0)
    )
    stop = StopCovering(id="S", component="F1", frame=FRAME, layers=(), sheet=ALUMINIUM, radius=50.0, outer_radius=90.0)
    lists = lists_of([], pieces=[Piece(box, "R1"), Piece(stop, "R1")])
    (row,) = lists.insulation
    # the wool's outer face is 1 mm inside of the sheet's everywhere
    assert row["outer_area_m2"] == pytest.approx((2 * math.pi * 140 * 398 + 2 * math.pi * 140**2) / 1e6, abs=1e-6)
    assert row["volume_m3"] == pytest.approx(math.pi * (140**2 * 398 - 100**2 * 318) / 1e9, abs=1e-9)
    assert [section["kind"] for section in lists.sections] == ["box"]


def test_a_tee_is_made_of_sections_for_its_run_and_its_branch():
    size = {"radius": 57.15, "begin": -150.0, "end": 150.0, "branch_radius": 24.15, "branch_angle": math.pi / 2, "reach": 140.0}
    tee = TeeCovering(id="T1", component="T1", frame=FRAME, layers=(WOOL, FOAM), sheet=None, **size)
    lists = lists_of([], pieces=[Piece(tee, "R1")])
    found = [(row["kind"], row["material"], row["inner_diameter_mm"], row["length_m"]) for row in lists.sections]
    assert found == [
        ("branch", "foam", 128.3, 0.14),
        ("tee", "foam", 194.3, 0.3),
        ("branch", "mineral wool", 48.3, 0.14),
        ("tee", "mineral wool", 114.3, 0.3),
    ]
    assert sum(row["volume_m3"] for row in lists.sections) == pytest.approx(sum(layer_volumes(tee)) * 1e-9, abs=1e-8)


def test_volume_of_sections_is_that_of_the_insulation(lists):
    assert sum(row["volume_m3"] for row in lists.sections) == pytest.approx(sum(row["volume_m3"] for row in lists.insulation), abs=1e-9)


def test_csv_is_read_back(lists, tmp_path):
    write_cut_list_csv(lists, tmp_path / "cuts.csv")
    with (tmp_path / "cuts.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["part"] for row in rows] == ["P1 jacket", "E1 gore", "F1 disc"]
    assert [float(row["gross_area_m2"]) for row in rows] == pytest.approx([row["gross_area_m2"] for row in lists.cuts])
    write_material_list_csv(lists, tmp_path / "materials.csv")
    with (tmp_path / "materials.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["list"] for row in rows] == ["sheet metal"] * 2 + ["insulation"] * 2 + ["section"] * 2
    assert rows[2]["total_weight_kg"] == ""
    assert float(rows[3]["volume_m3"]) == lists.insulation[1]["volume_m3"]


@pytest.mark.parametrize(
    ("language", "names", "header"),
    [("en", ["Cut list", "Insulation", "Materials", "Sheets"], "Part"), ("de", ["Zuschnitt", "Dämmung", "Material", "Tafeln"], "Teil")],
)
def test_workbook_has_numbers_as_numbers_under_headers_with_units(lists, tmp_path, language, names, header):
    write_cut_list_xlsx(lists, tmp_path / "cuts.xlsx", language=language, title="Süd")
    book = openpyxl.load_workbook(tmp_path / "cuts.xlsx")
    assert book.sheetnames == names
    sheet = book[names[0]]
    headers = [cell.value for cell in sheet[1]]
    assert headers[0] == header
    assert headers[9].endswith("(m²)")
    assert all(cell.font.bold for cell in sheet[1])
    assert (sheet.freeze_panes, sheet.print_title_rows, sheet.page_setup.orientation) == ("B2", "$1:$1", "landscape")
    assert sheet["J2"].value == lists.cuts[0]["gross_area_m2"]
    assert sheet["J2"].data_type == "n"
    assert sheet["N5"].value == pytest.approx(sum(row["total_weight_kg"] for row in lists.cuts))
    assert sheet["G5"].value == 2 + 3 + 2
    texts = {cell.value for row in book[names[2]].iter_rows() for cell in row}
    named = {"en": {"mineral wool", "aluminium"}, "de": {"Mineralwolle", "Aluminium"}}
    assert {"foam", 48.3, 128.3, *named[language]} <= texts
    assert book[names[3]]["A2"].value == 1


def test_a_sum_with_an_unknown_weight_is_not_told(lists, tmp_path):
    write_cut_list_xlsx(lists, tmp_path / "cuts.xlsx")
    sheet = openpyxl.load_workbook(tmp_path / "cuts.xlsx")["Materials"]
    rows = [[cell.value for cell in row] for row in sheet.iter_rows()]
    start = rows.index(["Insulation"] + [None] * (len(rows[0]) - 1))
    total = rows[start + 4]
    assert total[:3] == ["Total", None, pytest.approx(sum(row["volume_m3"] for row in lists.insulation))]
    assert total[4] is None


@pytest.mark.parametrize("name", [ODD_ID, "+49", "-P1", "@SUM(A1)", " =1+1", "#N/A", "=1", "a\tb", "\x00", "x" * 40_000])
def test_no_id_becomes_a_formula_or_breaks_a_file(name, tmp_path):
    lists = lists_of([gore(name, component=name, covering=name, remarks=(name,))])
    write_cut_list_xlsx(lists, tmp_path / "cuts.xlsx", title=name)
    cell = openpyxl.load_workbook(tmp_path / "cuts.xlsx")["Cut list"]["A2"]
    assert cell.data_type == "s"
    assert cell.value.startswith(name[:1] if name.isprintable() or name == ODD_ID or "\t" in name else "\\x00")
    write_cut_list_csv(lists, tmp_path / "cuts.csv")
    with (tmp_path / "cuts.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert not row["part"].lstrip().startswith(("=", "+", "-", "@"))
    assert not row["remarks"].lstrip().startswith(("=", "+", "-", "@"))


def test_negative_numbers_stay_numbers_in_csv(tmp_path):
    lists = lists_of([gore(net_area=-1e6)])
    write_cut_list_csv(lists, tmp_path / "cuts.csv")
    with (tmp_path / "cuts.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert float(row["net_area_m2"]) == -1.0


def test_same_lists_give_the_same_cells(patterns, tmp_path):
    books = []
    for name in ("a", "b"):
        write_cut_list_xlsx(lists_of(patterns), tmp_path / f"{name}.xlsx")
        book = openpyxl.load_workbook(tmp_path / f"{name}.xlsx")
        books.append([[(cell.value, cell.number_format) for cell in row] for sheet in book for row in sheet.iter_rows()])
    assert books[0] == books[1]


def test_without_sheets_waste_is_left_empty(patterns):
    lists = lists_of(patterns)
    assert lists.sheets == ()
    assert "waste_m2" not in lists.metals[0]
    assert lists.cuts[0]["sheets"] == ""


def test_nothing_to_list_an_unknown_language_and_a_missing_package_are_said(patterns, tmp_path, monkeypatch):
    with pytest.raises(InputError, match="neither a part nor insulation"):
        lists_of([])
    with pytest.raises(InputError, match="there is no 'fr'"):
        write_cut_list_xlsx(lists_of(patterns), tmp_path / "a.xlsx", language="fr")
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'openpyxl>=3.1,<4'"):
        write_cut_list_xlsx(lists_of(patterns), tmp_path / "a.xlsx")
    assert not list(tmp_path.iterdir())


def test_prices_make_costs_of_whole_sheets_and_of_volumes_and_none_where_they_are_not_known(patterns):
    pieces = [Piece(straight("P1", 1500.0, WOOL), "R1")]
    sheets = nest(patterns, [SheetSize(1250.0, 1000.0)])
    prices = {"aluminium": 12.0, "mineral wool": 150.0}
    made = cut_lists(patterns, sheets, pieces, sheet_density=SHEET_DENSITIES.get, layer_density=LAYER_DENSITIES.get, price=prices.get)
    aluminium, steel = made.metals
    assert aluminium["cost"] == pytest.approx(12.0 * 1.25)
    assert steel["cost"] is None
    assert made.insulation[0]["cost"] == pytest.approx(150.0 * made.insulation[0]["volume_m3"], abs=0.005)
    unplaced = cut_lists(patterns, (), pieces, sheet_density=SHEET_DENSITIES.get, layer_density=LAYER_DENSITIES.get, price=prices.get)
    assert unplaced.metals[0]["cost"] == pytest.approx(12.0 * aluminium["parts_area_m2"], abs=0.005)
