# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nesting: every piece once, inside the sheet, apart from the others, turned only where its grain lets it."""

import itertools
import sys
from collections import Counter

import numpy as np
import pytest
from flat_parts import ALUMINIUM, STEEL, disc, gore, jacket, rectangle
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.flat import Path
from pipeworkbench.insulation.treatment import SheetSize

SMALL, LARGE = SheetSize(1000.0, 500.0), SheetSize(2500.0, 1250.0, margin=15.0, spacing=8.0)
TOLERANCE = 1e-6  # mm


def lengths(longest):
    return st.floats(20.0, longest)


PARTS = st.lists(
    st.tuples(lengths(900.0), lengths(450.0), st.sampled_from(["any", "along"]), st.integers(1, 3), st.sampled_from([ALUMINIUM, STEEL])),
    min_size=1,
    max_size=12,
)


def made(descriptions):
    """Parts away from the origin, so that nobody takes their corner for it."""
    return [
        rectangle(f"P{i}", 1.0, 1.0, outline=Path.rectangle((-50.0, 7.0), (w - 50.0, h + 7.0)), grain=grain, quantity=number, sheet=sheet)
        for i, (w, h, grain, number, sheet) in enumerate(descriptions)
    ]


def refuse_bad_nesting(sheets):
    for sheet in sheets:
        boxes = [part.bounds for part in sheet.parts]
        for left, bottom, right, top in boxes:
            assert min(left, bottom) >= sheet.size.margin - TOLERANCE
            assert right <= sheet.size.width - sheet.size.margin + TOLERANCE
            assert top <= sheet.size.height - sheet.size.margin + TOLERANCE
        for one, other in itertools.combinations(boxes, 2):
            gap = max(one[0] - other[2], other[0] - one[2], one[1] - other[3], other[1] - one[3])
            assert gap >= sheet.size.spacing - TOLERANCE


@settings(deadline=None, max_examples=40)
@given(PARTS, st.sampled_from([[SMALL], [SMALL, LARGE], [LARGE, SMALL]]))
def test_every_piece_lies_once_inside_its_sheet_and_apart_from_the_others(descriptions, sizes):
    patterns = made(descriptions)
    sheets = nest(patterns, sizes)
    refuse_bad_nesting(sheets)
    pieces = Counter((part.pattern.id, part.number) for sheet in sheets for part in sheet.parts)
    assert pieces == {(pattern.id, number): 1 for pattern in patterns for number in range(1, pattern.quantity + 1)}
    for sheet in sheets:
        assert {part.pattern.sheet for part in sheet.parts} == {sheet.sheet}
        assert all(part.turn_deg % 180 == 0 for part in sheet.parts if part.pattern.grain == "along")
        area = sum(part.pattern.cut_area for part in sheet.parts)
        assert sheet.used == pytest.approx(area / (sheet.size.width * sheet.size.height))
    assert [sheet.number for sheet in sheets] == list(range(1, len(sheets) + 1))


def test_same_input_gives_the_same_sheets():
    patterns = [jacket(quantity=7), gore(quantity=9), disc(quantity=5)]
    first, second = (
        [(s.number, s.size, [(p.pattern.id, p.number, p.turn_deg, p.position) for p in s.parts]) for s in nest(patterns, [SMALL, LARGE])]
        for _ in range(2)
    )
    assert first == second


def test_a_part_that_fits_only_upright_is_turned_where_its_grain_lets_it():
    (sheet,) = nest([rectangle("A", 400.0, 900.0)], [SMALL])
    (part,) = sheet.parts
    assert part.turn_deg == 90.0
    assert part.bounds == pytest.approx((10.0, 10.0, 910.0, 410.0))
    with pytest.raises(InputError, match=r"grain runs along"):
        nest([rectangle("A", 400.0, 900.0, grain="along")], [SMALL])


def test_parts_that_fill_a_sheet_exactly_take_no_second_one():
    size = SheetSize(1000.0, 500.0, margin=10.0, spacing=5.0)
    patterns = [rectangle("A", (980.0 - 15.0) / 4, (480.0 - 5.0) / 2, quantity=8)]
    (sheet,) = nest(patterns, [size])
    assert len(sheet.parts) == 8


def test_few_parts_take_the_smaller_sheet_and_materials_do_not_mix():
    sheets = nest([rectangle("A", 300.0, 200.0), disc()], [LARGE, SMALL])
    assert [(sheet.sheet, sheet.size) for sheet in sheets] == [(ALUMINIUM, SMALL), (STEEL, SMALL)]


def test_packing_is_better_than_one_row_after_another():
    random = np.random.default_rng(4)
    patterns = [rectangle(f"P{i}", *random.uniform((80.0, 60.0), (700.0, 400.0))) for i in range(60)]
    sheets = nest(patterns, [LARGE])
    refuse_bad_nesting(sheets)
    rows, x, y, high = 1, 15.0, 15.0, 0.0
    for pattern in patterns:
        left, bottom, right, top = pattern.outline.bounds
        if x + right - left > 2485.0:
            x, y, high = 15.0, y + high + 8.0, 0.0
        if y + top - bottom > 1235.0:
            rows, x, y, high = rows + 1, 15.0, 15.0, 0.0
        x, high = x + right - left + 8.0, max(high, top - bottom)
    assert len(sheets) < rows
    assert min(sheet.used for sheet in sheets[:-1]) > 0.8


def test_usage_leaves_holes_out():
    (sheet,) = nest([disc(quantity=1)], [SheetSize(300.0, 300.0)])
    assert sheet.used == pytest.approx(np.pi * (100.0**2 - 60.0**2) / 300.0**2)


def test_a_part_larger_than_every_sheet_is_named_with_the_sheet_it_needs():
    with pytest.raises(InputError) as caught:
        nest([gore(), rectangle("E7 gore", 2600.4, 300.0)], [SMALL, LARGE])
    assert str(caught.value).startswith("E7: E7 gore: the part of 2600 x 300 mm is larger than every sheet")
    assert "2631 x 330 mm" in str(caught.value)
    (sheet,) = nest([rectangle("E7 gore", 2600.4, 300.0)], [SheetSize(2631.0, 330.0, margin=15.0)])
    assert sheet.number == 1


@pytest.mark.parametrize("outline", [Path.rectangle((0.0, 0.0), (0.0, 50.0)), Path.polygon([(0.0, 0.0), (np.nan, 1.0), (2.0, 2.0)])])
def test_a_part_without_extent_is_refused_with_its_name(outline):
    with pytest.raises(InputError, match=r"P9: P9 jacket: .* no part of sheet metal"):
        nest([rectangle("P9 jacket", 1.0, 1.0, outline=outline)], [SMALL])


def test_nothing_to_cut_and_no_sheet_are_said():
    with pytest.raises(InputError, match="no part to be cut"):
        nest([], [SMALL])
    with pytest.raises(InputError, match="no part to be cut"):
        nest([gore(quantity=0)], [SMALL])
    with pytest.raises(InputError, match="no sheet to cut from"):
        nest([gore()], [])


def test_missing_rectpack_is_said_with_the_command(monkeypatch):
    monkeypatch.setitem(sys.modules, "rectpack", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'rectpack>=0.2.2,<0.3'"):
        nest([gore()], [SMALL])
