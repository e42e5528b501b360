# SPDX-License-Identifier: LGPL-2.1-or-later
"""DXF: what is written passes ezdxf's audit and reads back as the same parts on the right layers."""

import math
import sys
from collections import Counter
from pathlib import Path as FilePath

import ezdxf
import numpy as np
import pytest
from flat_parts import ODD_ID, disc, gore, gore_area, jacket, rectangle

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.exports.dxf import APPLICATION, LAYERS, file_names, write_dxf, write_parts, write_sheet_files, write_sheets
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.flat import Path, Text
from pipeworkbench.insulation.treatment import SheetSize


def read(path):
    """Return the model space of a file that the audit finds nothing in."""
    document = ezdxf.readfile(path)
    auditor = document.audit()
    assert not auditor.errors
    assert not auditor.fixes
    return document.modelspace()


def closed_areas(space, layer="CUT"):
    """Areas of all closed outlines of a layer, by ezdxf's own reading of bulges."""
    areas = [math.pi * circle.dxf.radius**2 for circle in space.query(f'CIRCLE[layer=="{layer}"]')]
    for line in space.query(f'LWPOLYLINE[layer=="{layer}"]'):
        assert line.closed
        areas.append(polyline_area(line))
    return sorted(areas)


def polyline_area(line):
    """The polygon of the points and the segments of the arcs, which ezdxf gives as centre, angles and radius."""
    points = np.array(line.get_points("xyb"))
    following = np.roll(points, -1, axis=0)
    area = np.sum(points[:, 0] * following[:, 1] - following[:, 0] * points[:, 1]) / 2
    for (x, y, bulge), (x1, y1, _) in zip(points, following, strict=True):
        if bulge:
            _, start, end, radius = ezdxf.math.bulge_to_arc((x, y), (x1, y1), bulge)
            angle = (end - start) % (2 * math.pi)
            area += math.copysign(radius**2 / 2 * (angle - math.sin(angle)), bulge)
    return abs(area)


def test_parts_read_back_with_their_outlines_areas_and_layers(tmp_path):
    patterns = (jacket(), gore(), disc())
    files = write_parts(patterns, tmp_path / "parts")
    assert [file.name for file in files] == ["P1_jacket.dxf", "E1_gore.dxf", "F1_disc.dxf"]
    expected = ([math.pi * 4, math.pi * 4, 180000.0], [gore_area()], [math.pi * 3600, math.pi * 10000])
    for file, areas in zip(files, expected, strict=True):
        assert closed_areas(read(file)) == pytest.approx(areas, rel=1e-9)
    kinds = Counter((entity.dxftype(), entity.dxf.layer) for entity in read(files[0]))
    assert kinds == {
        ("LWPOLYLINE", "CUT"): 1,
        ("CIRCLE", "CUT"): 2,
        ("LINE", "MARK"): 1,
        ("LINE", "FOLD"): 1,
        ("LINE", "CENTRE"): 1,
        ("TEXT", "TEXT"): 1,
    }


def test_file_is_in_millimetres_and_only_the_sheets_layer_is_not_plotted(tmp_path):
    (file,) = write_parts([jacket()], tmp_path)
    document = ezdxf.readfile(file)
    assert (document.dxfversion, document.header["$INSUNITS"], document.header["$MEASUREMENT"]) == ("AC1024", 4, 1)
    assert {name: bool(document.layers.get(name).dxf.plot) for name in LAYERS} == {name: name != "SHEET" for name in LAYERS}
    assert document.header["$EXTMAX"][:2] == pytest.approx((600.0, 300.0))
    assert {document.layers.get(name).dxf.linetype for name in ("FOLD", "CENTRE")} == {"DASHED", "CENTER"}


def test_sheets_hold_every_piece_once_and_inside_the_sheet(tmp_path):
    patterns = (jacket(quantity=9), gore(quantity=5), disc())
    sheets = nest(patterns, [SheetSize(1250.0, 1000.0)])
    write_sheets(sheets, tmp_path / "sheets.dxf")
    space = read(tmp_path / "sheets.dxf")
    areas = [180000.0] * 9 + [math.pi * 4] * 18 + [gore_area()] * 5 + [math.pi * 3600, math.pi * 10000] * 2
    assert closed_areas(space) == pytest.approx(sorted(areas), rel=1e-9)
    assert closed_areas(space, "SHEET") == pytest.approx([1250.0 * 1000.0] * len(sheets))
    corners = [np.array(line.get_points("xy")) for line in space.query('LWPOLYLINE[layer=="SHEET"]')]
    boxes = [(points.min(axis=0) + 10, points.max(axis=0) - 10) for points in corners]
    for line in space.query('LWPOLYLINE[layer=="CUT"]'):
        points = np.array(line.get_points("xy"))
        assert any((points >= lower - 1e-6).all() and (points <= upper + 1e-6).all() for lower, upper in boxes)


def test_every_entity_of_a_part_says_whose_it_is(tmp_path):
    sheets = nest((jacket(), gore()), [SheetSize()])
    write_sheets(sheets, tmp_path / "sheets.dxf")
    owners = Counter((tags[0].value, tags[1].value) for entity in read(tmp_path / "sheets.dxf") if (tags := marks_of(entity)))
    assert owners == {("P1 jacket", 1): 7, ("E1 gore", 1): 2, ("E1 gore", 2): 2, ("E1 gore", 3): 2}


def marks_of(entity):
    return entity.get_xdata(APPLICATION) if entity.has_xdata(APPLICATION) else None


def test_one_file_for_each_sheet(tmp_path):
    sheets = nest((jacket(quantity=6), disc()), [SheetSize(1250.0, 1000.0)])
    files = write_sheet_files(sheets, tmp_path / "sheets")
    assert len(files) == len(sheets)
    for file, sheet in zip(files, sheets, strict=True):
        assert len(read(file).query('LWPOLYLINE[layer=="SHEET"]')) == 1
        assert sum(closed_areas(read(file), "CUT")) > 0
        assert sheet.sheet.material in read(file).query('TEXT[layer=="SHEET"]').first.dxf.text


def test_odd_ids_survive_as_text_and_as_file_names(tmp_path):
    patterns = (gore(ODD_ID), gore(ODD_ID.upper()), gore("con"), gore("../../etc"), gore(""), gore("ü" * 500))
    files = write_parts(patterns, tmp_path)
    assert len({file.name.casefold() for file in files}) == len(patterns)
    assert all(file.parent == tmp_path and file.is_file() and len(file.name.encode()) < 100 for file in files)
    assert files[2].stem == "part_con"
    shown = read(files[0]).query("TEXT").first.plain_text()
    assert shown == '=A1+"Rohr % %c ^J/äöüß\\n\\ U+0041'


def test_names_of_files_are_different_and_stay_in_their_order():
    assert file_names(["a/b", "a:b", "A b", "a_b_2"]) == ["a_b", "a_b_2", "A_b_3", "a_b_2_2"]


def test_patterns_alone_are_laid_beside_each_other(tmp_path):
    write_dxf([gore(), gore("E2 gore"), disc()], tmp_path / "parts.dxf")
    space = read(tmp_path / "parts.dxf")
    assert closed_areas(space) == pytest.approx(sorted([gore_area()] * 2 + [math.pi * 3600, math.pi * 10000]), rel=1e-9)
    first, second = (np.array(line.get_points("xy")) for line in space.query("LWPOLYLINE"))
    assert first[:, 0].max() < second[:, 0].min()


def test_arcs_stay_arcs_and_repeated_points_are_left_out(tmp_path):
    corners = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 50.0), (0.0, 1e-9)])
    outline = Path(corners, np.array([0.0, 0.0, 0.0, 0.3, 0.0, 0.0]))
    (file,) = write_parts([rectangle("A", 1.0, 1.0, outline=outline)], tmp_path)
    (line,) = read(file).query("LWPOLYLINE")
    assert len(line) == 4
    assert sorted(bulge for *_, bulge in line.get_points("xyb")) == [0.0, 0.0, 0.0, 0.3]


def test_a_full_circle_of_several_arcs_is_one_circle_and_a_slot_is_none(tmp_path):
    angles = np.arange(3) * 2 * np.pi / 3
    points = 50.0 * np.column_stack([np.cos(angles), np.sin(angles)]) + (7.0, 9.0)
    outline = Path(points, np.full(3, np.tan(np.pi / 6)))
    (file,) = write_parts([rectangle("A", 1.0, 1.0, outline=outline, holes=(Path.slot((0.0, 0.0), (20.0, 0.0), 8.0),))], tmp_path)
    (circle,) = read(file).query("CIRCLE")
    assert (circle.dxf.center.x, circle.dxf.center.y, circle.dxf.radius) == pytest.approx((7.0, 9.0, 50.0))
    assert len(read(file).query("LWPOLYLINE")) == 1


def test_a_mark_that_lies_on_another_is_written_once(tmp_path):
    line = Path.arc((0.0, 0.0), 30.0, 0.0, 1.0)
    marks = (("MARK", line), ("FOLD", line.reversed()), ("CENTRE", line.moved(0.0, (0.0, 5.0))))
    (file,) = write_parts([rectangle("A", 100.0, 100.0, marks=marks)], tmp_path)
    assert sorted(entity.dxf.layer for entity in read(file)) == ["CENTRE", "CUT", "MARK"]


def test_a_text_on_a_turned_part_turns_with_it(tmp_path):
    tall = rectangle("A", 900.0, 1900.0, texts=(Text("A", (100.0, 200.0), 8.0),))
    write_sheets(nest([tall], [SheetSize()]), tmp_path / "a.dxf")
    (text,) = read(tmp_path / "a.dxf").query('TEXT[layer=="TEXT"]')
    # a quarter turn: the part's height runs along the sheet, from its right
    assert text.dxf.rotation % 360 == pytest.approx(90.0)
    assert tuple(text.dxf.insert)[:2] == pytest.approx((10.0 + 1900.0 - 200.0, 10.0 + 100.0), abs=1e-6)


@pytest.mark.parametrize("write", [write_dxf, write_sheets, write_parts, write_sheet_files])
def test_nothing_to_cut_is_said(write, tmp_path):
    with pytest.raises(InputError, match="no part to be cut"):
        write([], tmp_path / "a.dxf")


def test_a_line_that_is_not_finite_is_refused_with_its_part(tmp_path):
    bad = Path(np.array([(0.0, 0.0), (np.nan, 0.0), (1.0, 1.0)]), np.zeros(3))
    with pytest.raises(InputError, match=r"A jacket: a line on the layer CUT is not finite"):
        write_parts([rectangle("A jacket", 1.0, 1.0, outline=bad)], tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_hole_without_extent_is_refused_with_its_part(tmp_path):
    nothing = Path(np.zeros((4, 2)), np.zeros(4))
    with pytest.raises(InputError, match=r"A jacket: .* has no extent"):
        write_parts([rectangle("A jacket", 50.0, 50.0, holes=(nothing,))], tmp_path)


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="folder cannot be made"):
        write_parts([gore()], tmp_path / "file" / "parts")


def test_missing_ezdxf_is_said_with_the_command(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'ezdxf>=1.3,<2'"):
        write_parts([gore()], tmp_path)


def test_range_of_versions_is_that_of_the_project():
    text = (FilePath(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    assert '"ezdxf>=1.3,<2"' in text
