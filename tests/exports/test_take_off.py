# SPDX-License-Identifier: LGPL-2.1-or-later
"""The take-off: what is alike is one line, with its quantity, length and weight by hand."""

import csv
import dataclasses
import math

import pytest
from measured import DN40

from pipeworkbench.exports.take_off import COLUMNS, write_take_off
from pipeworkbench.pipeline import Elbow, Pipeline

STEEL_KG_PER_MM3 = 7850e-9
ELBOW = Elbow(
    id="E1",
    start=(0.0, 0.0, 0.0),
    intersection=(57.0, 0.0, 0.0),
    end=(57.0, 57.0, 0.0),
    angle_deg=90.0,
    bend_radius=57.0,
    outer_diameter=48.3,
    wall_thickness=2.6,
    dn=40,
    standard="EN 10253-2",
)


def lines(pipeline, tmp_path):
    path = tmp_path / "take_off.csv"
    write_take_off(pipeline, path)
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        assert tuple(reader.fieldnames) == COLUMNS
        return list(reader)


def described(rows):
    return {row["description"]: row for row in rows}


def test_pipes_of_one_size_are_one_line_of_metres_and_kilograms(tmp_path):
    longer = dataclasses.replace(DN40, id="A-P01", end=(700.0, 3600.0, 750.0))
    thicker = dataclasses.replace(DN40, id="A-P02", wall_thickness=5.0)
    first, second = lines(Pipeline(frame="A", components=(DN40, thicker, longer)), tmp_path)
    assert (first["kind"], first["dn"], first["standard"], first["material"]) == ("pipe", "40", "EN 10220", "Steel")
    assert (float(first["quantity"]), first["unit"], first["pieces"], float(first["length_m"])) == (1.5, "m", "2", 1.5)
    assert first["components"] == "A-P00 A-P01"
    section = math.pi * (48.3 - 2.6) * 2.6
    assert float(first["weight_kg"]) == pytest.approx(section * 1500 * STEEL_KG_PER_MM3, abs=1e-3)
    assert float(second["weight_kg"]) == pytest.approx(math.pi * (48.3 - 5.0) * 5.0 * 500 * STEEL_KG_PER_MM3, abs=1e-3)


def test_measured_elbows_of_one_kind_are_one_line(tmp_path):
    elbows = tuple(dataclasses.replace(ELBOW, id=name, angle_deg=angle) for name, angle in (("E1", 90.0), ("E2", 89.93), ("E3", 45.2)))
    rows = described(lines(Pipeline(frame="A", components=elbows), tmp_path))
    assert {text: (row["quantity"], row["unit"]) for text, row in rows.items()} == {
        "Elbow DN 40, 90 deg, R 57 mm": ("2", "pcs"),
        "Elbow DN 40, 45 deg, R 57 mm": ("1", "pcs"),
    }


def test_weight_is_left_out_where_a_wall_or_a_material_is_not_known(tmp_path):
    massive = dataclasses.replace(DN40, wall_thickness=None)
    copper = dataclasses.replace(DN40, id="A-P01", extra={"material": "Copper"})
    rows = lines(Pipeline(frame="A", components=(massive, copper)), tmp_path)
    assert [(row["material"], row["weight_kg"], row["length_m"]) for row in rows] == [("Steel", "", "0.5"), ("Copper", "", "0.5")]


def test_every_component_is_counted_once(everything, tmp_path):
    rows = [row for row in lines(everything, tmp_path) if row["kind"] not in {"gasket", "bolt"}]
    counted = [name for row in rows for name in row["components"].split()]
    assert sorted(counted) == sorted(component.id for component in everything.components)
    assert sum(int(row["pieces"]) for row in rows) == len(everything.components)
    assert [row["item"] for row in rows] == [str(number) for number in range(1, len(rows) + 1)]


def test_gaskets_and_bolts_are_counted_where_faces_are_joined(everything, tmp_path):
    rows = described(lines(everything, tmp_path))
    assert rows["Gasket DN 50, PN 16, 2.0 mm"]["quantity"] == "1"
    assert (rows["Bolt M16 x 60 with nut"]["quantity"], rows["Bolt M16 x 60 with nut"]["unit"]) == ("4", "pcs")
    apart = dataclasses.replace(everything, joints=())
    assert not {"gasket", "bolt"} & {row["kind"] for row in lines(apart, tmp_path)}
