# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables: the CSV as a spreadsheet reads it and the rows on the terminal."""

import csv
import math

import pytest
from measured import DN40

from pipeworkbench.exports.tables import TERMINAL_COLUMNS, terminal_row, write_csv
from pipeworkbench.pipeline import Pipe, Pipeline

UNVERIFIED = Pipe(
    id="A-P01", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 80.0), outer_diameter=10.2, dn=6, wall_thickness=1.6, verified=0, approximate=True
)
BARE = Pipe(id='odd, "name"', start=(0.0, 0.0, 0.0), end=(12.5, 0.0, 0.0), outer_diameter=95.0)


@pytest.fixture
def rows(tmp_path):
    path = tmp_path / "pipes.csv"
    write_csv(Pipeline.of_station("A", (DN40, UNVERIFIED, BARE)), path)
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_pipe_is_a_row_and_every_cell_has_a_column(rows):
    assert [row["id"] for row in rows] == ["A-P00", "A-P01", 'odd, "name"']
    assert all(None not in row and None not in row.values() for row in rows)


def test_geometry_is_read_back(rows):
    row = rows[0]
    assert [float(row[f"start_{axis}_mm"]) for axis in "xyz"] == [100.0, 3600.0, -50.0]
    assert [float(row[f"end_{axis}_mm"]) for axis in "xyz"] == [400.0, 3600.0, 350.0]
    assert float(row["length_mm"]) == pytest.approx(500.0)
    assert (float(row["outer_diameter_mm"]), float(row["wall_thickness_mm"]), int(row["dn"])) == (48.3, 2.6, 40)


def test_accuracy_is_read_back(rows):
    row = rows[0]
    assert [float(row[f"sigma_{axis}_mm"]) for axis in "xyz"] == [0.02, 0.12, 0.03]
    assert (float(row["quality_px"]), float(row["sigma_direction_deg"]), float(row["sigma_outer_diameter_mm"])) == (0.2134, 0.015, 0.11)
    assert (row["loa"], row["approximate"], row["verified_sources"], row["pick"], row["kind"]) == ("LOA50", "no", "2", "0", "pipe")


def test_unverified_dimensions_are_marked(rows):
    assert rows[1]["verified_sources"] == "0"
    assert rows[1]["approximate"] == "yes"
    remarks = dict(zip(TERMINAL_COLUMNS, terminal_row(UNVERIFIED), strict=True))["remarks"]
    assert "not verified" in remarks
    assert "approximate" in remarks


def test_verified_dimensions_are_not_marked():
    assert dict(zip(TERMINAL_COLUMNS, terminal_row(DN40), strict=True))["remarks"] == ""


def test_bridged_gaps_and_the_nearest_standard_are_told(tmp_path):
    pipe = Pipe(
        id="A-P02", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 800.0), outer_diameter=60.1, gaps=((54.2, 132.0), (300.0, 340.5)), nearest_standard="DN 50"
    )
    remarks = dict(zip(TERMINAL_COLUMNS, terminal_row(pipe), strict=True))["remarks"]
    assert remarks == "within 3 sigma of DN 50, bridged at 54-132, 300-340 mm"
    write_csv(Pipeline.of_station("A", (pipe,)), tmp_path / "pipes.csv")
    with (tmp_path / "pipes.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["gaps_mm"], row["nearest_standard"]) == ("54.2-132 300-340.5", "DN 50")


def test_what_is_not_known_is_left_empty(rows):
    for column in (
        "pick",
        "station",
        "standard",
        "dn",
        "wall_thickness_mm",
        "verified_sources",
        "quality_px",
        "sigma_y_mm",
        "loa",
        "gaps_mm",
        "nearest_standard",
    ):
        assert rows[2][column] == ""


@pytest.fixture
def all_rows(everything, tmp_path):
    path = tmp_path / "all.csv"
    write_csv(everything, path)
    with path.open(encoding="utf-8", newline="") as file:
        return {row["id"]: row for row in csv.DictReader(file)}


def test_every_component_is_a_row_with_its_kind_and_ports(everything, all_rows):
    assert list(all_rows) == [component.id for component in everything.components]
    for component in everything.components:
        row = all_rows[component.id]
        assert row["kind"] == component.kind
        assert [float(row[f"start_{axis}_mm"]) for axis in "xyz"] == pytest.approx(component.ports[0].point, abs=1e-3)
        if len(component.ports) > 1:
            assert [float(row[f"end_{axis}_mm"]) for axis in "xyz"] == pytest.approx(component.ports[1].point, abs=1e-3)
        else:
            assert row["end_x_mm"] == ""


def test_key_dimensions_of_fittings_are_in_the_table(all_rows):
    elbow, flange, tee, reducer = (all_rows[name] for name in ("E2", "F1", "T1", "R1"))
    assert (elbow["type"], float(elbow["bend_angle_deg"]), float(elbow["bend_radius_mm"])) == ("3D", 45, 57)
    assert float(elbow["length_mm"]) == pytest.approx(57 * math.pi / 4, abs=1e-3)
    assert (flange["type"], float(flange["pn"]), flange["bolts"]) == ("11", 16, "4")
    assert [float(flange[f"{letter}_mm"]) for letter in "DCKL"] == [165, 18, 125, 18]
    assert (tee["type"], float(tee["second_diameter_mm"])) == ("tee", 33.7)
    assert (reducer["type"], float(reducer["second_diameter_mm"]), float(reducer["length_mm"])) == ("eccentric", 48.3, 76)
    assert all_rows["P1"]["type"] == ""


def test_remarks_name_what_cannot_be_told_apart_and_what_is_not_verified(everything, all_rows):
    assert all_rows["F1"]["remarks"] == "same dimensions as DIN 2633 type 11 PN 16"
    assert "not verified" in all_rows["F2"]["remarks"]
    assert all_rows["P4"]["remarks"] == "approximate"
    said = {component.id: terminal_row(component)[-1] for component in everything.components}
    assert said["F1"] == "Flange DN 50, type 11, PN 16, same dimensions as DIN 2633 type 11 PN 16"
    assert said["F2"].startswith("Blind flange DN 50")
    assert said["E1"] == "Elbow DN 40, 90 deg, 3D (R 57 mm)"
    assert said["R1"] == "Reducer DN 50 to 48.3 mm, eccentric"
    assert said["C1"] == "Cap DN 20"
    assert all(len(terminal_row(component)) == len(TERMINAL_COLUMNS) for component in everything.components)


def test_terminal_row_has_the_rounded_figures():
    row = dict(zip(TERMINAL_COLUMNS, terminal_row(DN40), strict=True))
    assert (row["pick"], row["DN"], row["outside diameter"], row["length"]) == ("0", "40", "48.3 mm", "500 mm")
    assert row["quality"] == "0.21 px"
    assert row["sigma"] == "0.13 mm"  # the root of 0.02^2 + 0.12^2 + 0.03^2


def test_terminal_row_of_a_pipe_without_measurement_has_dashes():
    row = dict(zip(TERMINAL_COLUMNS, terminal_row(BARE), strict=True))
    assert (row["pick"], row["DN"], row["quality"], row["sigma"]) == ("-", "-", "-", "-")
