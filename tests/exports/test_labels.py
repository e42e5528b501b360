# SPDX-License-Identifier: LGPL-2.1-or-later
"""Labels: one for each piece, with its sheet, on pages or as CSV."""

import csv
import re

import pytest
from flat_parts import ODD_ID, disc, gore, jacket

from pipeworkbench.errors import InputError
from pipeworkbench.exports.labels import ACROSS, DOWN, labels_of_patterns, labels_of_sheets, write_labels
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.treatment import SheetSize


def test_every_piece_has_a_label_with_the_sheet_it_lies_on():
    sheets = nest([jacket(quantity=7), gore(), disc()], [SheetSize(1250.0, 1000.0)])
    labels = labels_of_sheets(sheets, {"P1 jacket": "R1", "E1 gore": "R1"})
    assert len(labels) == 7 + 3 + 2
    for label in labels:
        (sheet,) = [sheet for sheet in sheets if any((p.pattern.id, p.number) == (label.part, label.number) for p in sheet.parts)]
        assert (label.sheet, label.material) == (sheet.number, sheet.sheet.material)
    assert {(label.component, label.run) for label in labels} == {("P1", "R1"), ("E1", "R1"), ("F1", "")}
    assert {(label.width, label.height) for label in labels if label.component == "E1"} == {(400.0, 100.0)}


def test_labels_fill_pages_of_a4(tmp_path):
    labels = labels_of_patterns([gore(quantity=ACROSS * DOWN + 1)], {})
    write_labels(labels, tmp_path / "labels.pdf", language="de")
    data = (tmp_path / "labels.pdf").read_bytes()
    assert len(re.findall(rb"/Type /Page\b", data)) == 2
    width, height = map(float, re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", data).groups())
    assert (width / 72 * 25.4, height / 72 * 25.4) == pytest.approx((210.0, 297.0), abs=0.1)


def test_labels_as_csv_have_one_line_each_and_no_formula(tmp_path):
    write_labels(labels_of_patterns([gore(ODD_ID, component="@x", covering="C")], {"C": "+R"}), tmp_path / "labels.csv")
    with (tmp_path / "labels.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["piece"] for row in rows] == ["1", "2", "3"]
    assert rows[0]["part"].startswith("'=A1")
    assert (rows[0]["component"], rows[0]["run"], rows[0]["sheet"]) == ("'@x", "'+R", "")
    assert (rows[0]["width_mm"], rows[0]["height_mm"], rows[0]["thickness_mm"], rows[0]["quantity"]) == ("400.0", "100.0", "0.8", "3")


def test_nothing_to_label_and_unknown_endings_are_said(tmp_path):
    with pytest.raises(InputError, match="no part to be labelled"):
        write_labels([], tmp_path / "labels.csv")
    with pytest.raises(InputError, match=r"no pages can be written as '\.txt'"):
        write_labels(labels_of_patterns([gore()], {}), tmp_path / "labels.txt")
