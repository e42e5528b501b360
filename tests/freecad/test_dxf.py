# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's own reader of DXF finds the outlines of the parts that are written, with the same areas."""

import math

import Import
import numpy as np
import Part
import pytest

from pipeworkbench.exports.dxf import write_sheets
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.flat import Path, Pattern, Text
from pipeworkbench.insulation.treatment import SheetSize
from pipeworkbench.solids.coverings import Sheet

BULGE = 0.15


def part(name, outline, quantity, *, holes=()):
    """A part with one mark and a text."""
    return Pattern(
        id=name,
        covering=name,
        component=name,
        kind="gore",
        outline=outline,
        sheet=Sheet("aluminium", 0.8),
        net_area=outline.area,
        holes=holes,
        marks=(("MARK", Path.line((20.0, 5.0), (60.0, 5.0))),),
        texts=(Text("Rohr äöü", (20.0, 10.0), 8.0),),
        quantity=quantity,
    )


@pytest.fixture
def gore():
    corners = np.array([(0.0, 0.0), (400.0, 0.0), (400.0, 40.0), (0.0, 40.0)])
    return part("gore", Path(corners, np.array([BULGE, 0.0, -BULGE / 2, 0.0])), 4)


@pytest.fixture
def jacket():
    return part("jacket", Path.rectangle((0.0, 0.0), (600.0, 300.0)), 2, holes=(Path.circle((300.0, 150.0), 50.0),))


def wires_of(objects):
    """Wires, put together from whatever the reader made of them."""
    edges = [edge for obj in objects if hasattr(obj, "Shape") for edge in obj.Shape.Edges]
    return [Part.Wire(chain) for chain in Part.sortEdges(edges)]


def test_outlines_are_closed_and_have_their_areas(document, gore, jacket, tmp_path):
    path = tmp_path / "sheets.dxf"
    sheets = nest((gore, jacket), [SheetSize()])
    write_sheets(sheets, path)
    Import.readDXF(str(path), document.Name)
    closed = [wire for wire in wires_of(document.Objects) if wire.isClosed()]
    areas = sorted(Part.Face(wire).Area for wire in closed)
    expected = [abs(gore.outline.area)] * 4 + [600.0 * 300.0] * 2 + [math.pi * 50.0**2] * 2 + [2000.0 * 1000.0] * len(sheets)
    assert areas == pytest.approx(sorted(expected), rel=1e-6)
    edges = [edge for obj in document.Objects if hasattr(obj, "Shape") for edge in obj.Shape.Edges]
    arcs = [edge for edge in edges if isinstance(edge.Curve, Part.Circle)]
    assert len(arcs) == 2 * 4 + 2
    # nothing twice: outlines, holes, the sheet and one mark for each part
    assert len(edges) == 4 * 4 + 2 * 4 + 2 + 4 * len(sheets) + 6
