# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages to look at: one for each sheet, readable, and no text of a part lies across an edge or on another text."""

import itertools
import json
import re
import sys
import warnings
from pathlib import Path as FilePath

import numpy as np
import pytest
from flat_parts import ALUMINIUM, ODD_ID, disc, gore, jacket, rectangle

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.exports import pages, sheet_pictures
from pipeworkbench.exports.pages import fitted, text_width
from pipeworkbench.exports.sheet_pictures import write_part_pictures, write_sheet_pictures
from pipeworkbench.exports.sheets import nest
from pipeworkbench.insulation.treatment import SheetSize

SIZE = SheetSize(1500.0, 800.0)
TEMPLATES = FilePath(__file__).parents[2] / "resources" / "templates"


@pytest.fixture
def sheets():
    random = np.random.default_rng(2)
    small = [rectangle(f"Q{i} jacket", *random.uniform((40.0, 30.0), (260.0, 150.0))) for i in range(9)]
    return nest([jacket(quantity=3), gore(quantity=4), disc(sheet=ALUMINIUM), *small], [SIZE])


def figures_of(write, monkeypatch, *arguments, **options):
    """The figures of the pages that would be written."""
    drawn = []

    def keep(drawings, path, size):
        drawn.extend(pages.figure_of([draw], size) for draw in drawings)

    monkeypatch.setattr(sheet_pictures, "write_pages", keep)
    write(*arguments, **options)
    return drawn


def boxes_of(figure):
    """The rectangles on the page that texts take, with the texts."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    renderer = FigureCanvasAgg(figure).get_renderer()
    return [(text.get_window_extent(renderer), text.get_text()) for axes in figure.axes for text in axes.texts if text.get_text()]


@pytest.mark.parametrize("write", [write_sheet_pictures, write_part_pictures])
def test_texts_do_not_overlap_and_stay_on_the_page(write, sheets, monkeypatch):
    what = sheets if write is write_sheet_pictures else [jacket(texts=()), gore(texts=()), disc()]
    for figure in figures_of(write, monkeypatch, what, FilePath("x.pdf"), title="Projekt " * 30):
        boxes = boxes_of(figure)
        assert len(boxes) > 10
        for box, _ in boxes:
            assert box.x0 >= 0
            assert box.y0 >= 0
            assert box.x1 <= figure.bbox.width
            assert box.y1 <= figure.bbox.height
        for (one, first), (other, second) in itertools.combinations(boxes, 2):
            overlap = min(one.x1, other.x1) - max(one.x0, other.x0), min(one.y1, other.y1) - max(one.y0, other.y0)
            # boxes of letters reach a little beyond the letters
            assert min(overlap) < 1.0, (first, second)


def test_every_piece_has_its_number_and_every_part_its_line(sheets, monkeypatch):
    figures = figures_of(write_sheet_pictures, monkeypatch, sheets, FilePath("x.pdf"))
    assert len(figures) == len(sheets)
    for figure, sheet in zip(figures, sheets, strict=True):
        texts = [text.get_text() for axes in figure.axes for text in axes.texts]
        patterns = sorted({part.pattern.id for part in sheet.parts})
        for number in range(1, len(patterns) + 1):
            pieces = sum(part.pattern.id == texts[texts.index(str(number), texts.index("No.")) + 1] for part in sheet.parts)
            assert texts.count(str(number)) >= pieces + 1
        assert all(pattern in texts for pattern in patterns)
        assert f"Sheet {sheet.number} of {len(sheets)}" in texts


def test_a_long_list_goes_on_on_another_page(monkeypatch):
    tiny = [rectangle(f"P{i}", 60.0, 20.0) for i in range(100)]
    (sheet,) = nest(tiny, [SIZE])
    figures = figures_of(write_sheet_pictures, monkeypatch, [sheet], FilePath("x.pdf"))
    assert len(figures) == 2
    texts = [text.get_text() for figure in figures for axes in figure.axes for text in axes.texts]
    assert all(f"P{i}" in texts for i in range(100))


def test_pdf_has_a_page_for_each_sheet_and_svg_is_one_picture(sheets, tmp_path):
    write_sheet_pictures(sheets, tmp_path / "a.pdf", title="Süd")
    assert len(re.findall(rb"/Type /Page\b", (tmp_path / "a.pdf").read_bytes())) == len(sheets)
    write_sheet_pictures(sheets, tmp_path / "a.svg", language="de")
    text = (tmp_path / "a.svg").read_text(encoding="utf-8")
    height = float(re.search(r'height="([\d.]+)pt"', text).group(1))
    assert height == pytest.approx(len(sheets) * 210 / 25.4 * 72, abs=0.01)
    assert "Tafel 1 von" in text  # as a comment beside its outlines


@pytest.mark.parametrize("ending", [".pdf", ".svg"])
def test_same_sheets_give_the_same_file(sheets, tmp_path, ending):
    for name in ("a", "b"):
        write_sheet_pictures(sheets[:1], tmp_path / f"{name}{ending}")
    assert (tmp_path / f"a{ending}").read_bytes() == (tmp_path / f"b{ending}").read_bytes()


def test_odd_ids_are_drawn_without_a_word(tmp_path):
    patterns = [gore(name) for name in (ODD_ID, "$\\frac{1}$", "配管 1", "<b>&--", "W" * 300, "")]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        write_sheet_pictures(nest(patterns, [SIZE]), tmp_path / "a.svg")
        write_part_pictures(patterns, tmp_path / "a.pdf")
    assert (tmp_path / "a.pdf").stat().st_size > 1000


def test_a_text_is_shortened_in_its_middle_to_fit():
    name = "A-P01 jacket of a very long pipe, piece 17"
    short = fitted(name, 8.0, 30.0)
    assert short.startswith("A-P01")
    assert short.endswith("17")
    assert 25.0 < text_width(short, 8.0) <= 30.0
    assert fitted(name, 8.0, 200.0) == name
    assert text_width(name, 16.0) == pytest.approx(2 * text_width(name, 8.0))


def test_what_cannot_be_drawn_is_said(sheets, tmp_path, monkeypatch):
    with pytest.raises(InputError, match="no sheet to be drawn"):
        write_sheet_pictures([], tmp_path / "a.pdf")
    with pytest.raises(InputError, match="no part to be drawn"):
        write_part_pictures([], tmp_path / "a.pdf")
    with pytest.raises(InputError, match=r"end the name in \.pdf or \.svg"):
        write_sheet_pictures(sheets, tmp_path / "a.png")
    with pytest.raises(InputError, match="there is no 'fr'"):
        write_sheet_pictures(sheets, tmp_path / "a.pdf", language="fr")
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'matplotlib>=3.6,<4'"):
        write_sheet_pictures(sheets, tmp_path / "a.pdf")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("file", ["cut_sheets.texts.json", "cut_lists.texts.json"])
def test_both_languages_have_the_same_texts_and_places(file):
    texts = json.loads((TEMPLATES / file).read_text(encoding="utf-8"))

    def shape(value):
        return {key: shape(one) for key, one in value.items()} if isinstance(value, dict) else sorted(re.findall(r"\{.*?\}", value))

    assert shape(texts["en"]) == shape(texts["de"])
