# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of standard pipe sizes against EN 10220's figures."""

import csv
from itertools import pairwise

import pytest

from pipeworkbench.catalogue import PipeSize, nearest_pipe_size, pipe_size, pipe_sizes, read_pipe_sizes
from pipeworkbench.errors import InputError

HEADER = "outer_diameter,series,dn,wall_thickness,verified,wall_verified\n"
KNOWN = {15: 21.3, 25: 33.7, 40: 48.3, 50: 60.3, 80: 88.9, 100: 114.3, 150: 168.3, 200: 219.1}  # EN 10220, series 1


def test_diameters_ascend_and_are_unique():
    diameters = [size.outer_diameter for size in pipe_sizes()]
    assert len(diameters) > 30
    assert all(a < b for a, b in pairwise(diameters))


def test_nominal_diameters_ascend_with_the_outside_diameters_and_are_unique():
    nominal = [size.dn for size in pipe_sizes() if size.dn is not None]
    assert all(a < b for a, b in pairwise(nominal))


@pytest.mark.parametrize(("dn", "outer_diameter"), KNOWN.items())
def test_nominal_diameter_has_the_outside_diameter_of_the_standard(dn, outer_diameter):
    assert [size.outer_diameter for size in pipe_sizes() if size.dn == dn] == [outer_diameter]
    size = pipe_size(outer_diameter)
    assert size.dn == dn
    assert size.series == 1
    assert size.designation == f"DN {dn}"


def test_every_wall_is_thinner_than_the_radius():
    walls = [(size.wall_thickness, size.outer_diameter / 2) for size in pipe_sizes() if size.wall_thickness is not None]
    assert walls
    assert all(0 < wall < radius for wall, radius in walls)


def test_series_and_grades_are_those_that_exist():
    for size in pipe_sizes():
        assert size.series in {1, 2, 3}
        assert size.verified in {0, 1, 2}
        assert size.wall_verified in {None, 0, 1, 2}
        assert (size.wall_thickness is None) == (size.wall_verified is None)
        assert 0 < size.outer_diameter < 3000


def test_weakest_source_is_the_lower_grade():
    assert PipeSize(48.3, 1, 40, 2.6, 2, 0).weakest_source == 0
    assert PipeSize(48.3, 1, 40, 2.6, 1, 2).weakest_source == 1
    assert PipeSize(44.5, 3, None, None, 2, None).weakest_source == 2


def test_size_is_found_within_its_tolerance_only():
    assert pipe_size(48.34).dn == 40
    assert pipe_size(48.4) is None
    assert pipe_size(48.4, tolerance=0.2).dn == 40
    assert nearest_pipe_size(49.0).dn == 40
    assert nearest_pipe_size(1.0) == pipe_sizes()[0]
    assert nearest_pipe_size(1e6) == pipe_sizes()[-1]


def test_size_without_nominal_diameter_is_called_by_its_outside_diameter():
    assert PipeSize(44.5, 3, None, None, 0, None).designation == "44.5 mm"


def test_table_is_read_in_order_of_the_diameters_and_comments_are_left_out(tmp_path):
    path = tmp_path / "sizes.csv"
    path.write_text("# a comment\n" + HEADER + "60.3,1,50,2.9,2,1\n# another\n48.3,1,40,2.6,2,1\n44.5,3,,,0,\n", encoding="utf-8")
    assert read_pipe_sizes(path) == (
        PipeSize(44.5, 3, None, None, 0, None),
        PipeSize(48.3, 1, 40, 2.6, 2, 1),
        PipeSize(60.3, 1, 50, 2.9, 2, 1),
    )


@pytest.mark.parametrize(
    "row", ["wide,1,40,2.6,2,1", "48.3,one,40,2.6,2,1", "48.3,1,40,thin,2,1", "48.3,1,40,2.6,,1", "48.3,1", "48.3,1,4.5,2.6,2,1"]
)
def test_broken_row_is_refused_with_its_line_number(tmp_path, row):
    path = tmp_path / "sizes.csv"
    path.write_text("# first line\n" + HEADER + "60.3,1,50,2.9,2,1\n# fourth line\n" + row + "\n", encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_pipe_sizes(path)
    assert error.value.key == "line 5"
    assert "sizes.csv" in error.value.source


def test_empty_line_in_the_table_is_skipped_or_refused_with_its_number(tmp_path):
    path = tmp_path / "sizes.csv"
    path.write_text(HEADER + "60.3,1,50,2.9,2,1\n\n48.3,1,40,2.6,2,1\n", encoding="utf-8")
    try:
        assert [size.dn for size in read_pipe_sizes(path)] == [40, 50]
    except InputError as error:
        assert error.key == "line 3"  # noqa: PT017


@pytest.mark.parametrize("row", ["-48.3,1,40,2.6,2,1", "nan,1,40,2.6,2,1", "48.3,1,40,30,2,1", "48.3,9,40,2.6,2,1", "48.3,1,40,2.6,5,1"])
def test_impossible_size_is_refused_with_its_line_number(tmp_path, row):
    path = tmp_path / "sizes.csv"
    path.write_text(HEADER + row + "\n", encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_pipe_sizes(path)
    assert error.value.key == "line 2"


def test_table_equals_the_sourced_one(shared):
    with (shared / "standards" / "pipes_en10220.csv").open(encoding="utf-8", newline="") as file:
        sourced = {
            float(row["od"]): (
                int(row["series"]),
                int(row["dn"]) if row["dn"] else None,
                float(row["wall_normal_seamless"]) if row["wall_normal_seamless"] else None,
            )
            for row in csv.DictReader(file)
        }
    assert {size.outer_diameter: (size.series, size.dn, size.wall_thickness) for size in pipe_sizes()} == sourced
