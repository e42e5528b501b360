# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report: everything is in it, nothing leaves the file, names cannot break it."""

import base64
import re
from dataclasses import replace
from html.parser import HTMLParser

import cv2
import numpy as np
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.exports.report import PHOTO_WIDTH, report_page, write_report
from pipeworkbench.exports.texts import LANGUAGES
from pipeworkbench.exports.writers import Result, write
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import read_station

SUMMARY = {
    "sigma0": 0.94,
    "sigma_image_px": 0.21,
    "observations": 4030.2,
    "unknowns": 91,
    "redundancy": 3939.2,
    "iterations": 8,
    "converged": True,
    "images": [{"station": "A", "image": "left", "rms_px": 0.434, "found": 2079, "samples": 2532}],
    "gross": [{"what": "A-F10: face 37 in A/left", "size": -0.31, "w": -4.3, "left_out": True}],
    "weak": [{"component": "P1", "sigma_mm": 3.2, "reason": "x"}],
    "undetermined": {"C1": "nothing"},
}


VOID = ("meta", "img", "link", "br", "path", "use")


class Reader(HTMLParser):
    """Collects the tables' rows, the text, and whether all tags are closed in order."""

    def __init__(self, page):
        super().__init__()
        self.open, self.rows, self.headings, self.cell = [], [], [], None
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, _attributes):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th", "h1", "h2"):
            self.cell = ""

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        assert self.open.pop() == tag
        if tag in ("td", "th"):
            self.rows[-1].append(self.cell)
        if tag in ("h1", "h2"):
            self.headings.append(self.cell)

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data


def row_of(page, name):
    return next(row for row in Reader(page).rows if row and row[0] == name)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_component_is_a_row_with_its_figures(everything, language):
    page = report_page(everything, language=language)
    reader = Reader(page)
    assert reader.open == []
    first = {row[0] for row in reader.rows if row}
    assert {component.id for component in everything.components} <= first
    pipe = everything.pipes[0]
    row = row_of(page, pipe.id)
    assert f"{pipe.outer_diameter:.1f}" in row
    assert f"{pipe.length:.0f}" in row
    joined = {frozenset((row[0], row[2])) for row in reader.rows if len(row) == 6}
    assert {frozenset((joint.a, joint.b)) for joint in everything.joints} <= joined


def test_both_languages_say_the_same_things():
    from pipeworkbench.exports.report import _texts

    def shape(value):
        if isinstance(value, dict):
            return {key: shape(one) for key, one in value.items()}
        if isinstance(value, list):
            return [shape(one) for one in value]
        return set(re.findall(r"{\w+}", value))

    english, german = (shape(_texts(language)) for language in LANGUAGES)
    assert english == german


def test_accuracy_sources_and_levels_are_told(everything):
    known = replace(
        everything.pipes[0], id="K", sigma_position=(0.3, 0.4, 0.0), sigma_direction_deg=0.02, quality=0.25, loa="LOA50", verified=0, fixed=True
    )
    page = report_page(Pipeline.of_station("S", (known,)))
    row = row_of(page, "K")
    for text in ("0.50", "0.020", "0.25", "LOA50", "not verified", "fixed by hand"):
        assert text in row
    # charts of standard deviations, of fits and of levels stand in the page
    assert page.count("<svg") == 3


def test_adjustment_is_summed_up(everything):
    page = report_page(replace(everything, extra={"adjustment": SUMMARY}))
    assert "redundancy 3939, 8 iterations; converged" in page
    assert row_of(page, "A / left") == ["A / left", "0.43", "82"]
    assert "A-F10: face 37 in A/left: -0.31 off (w -4.3), left out" in page
    assert "P1 is weakly placed" in page
    assert "C1 is not determined" in page


@pytest.mark.parametrize("summary", [{}, {"images": [{}], "gross": [{}], "weak": [{}]}, {"sigma0": "?", "images": None}, "text"], ids=str)
def test_what_other_programs_say_of_an_adjustment_breaks_nothing(everything, summary):
    assert Reader(report_page(replace(everything, extra={"adjustment": summary}))).open == []


def test_names_are_escaped(everything):
    evil = "<script>alert('x')</script>&"
    pipe = replace(everything.pipes[0], id=evil, standard=evil)
    page = report_page(Pipeline.of_station(evil, (pipe,)), title=evil)
    assert "<script" not in page
    assert Reader(page).open == []
    assert row_of(page, evil)[0] == evil


def test_photographs_with_contours_are_inside_the_file(sample, tmp_path):
    station = read_station(sample)
    pipeline = Pipeline.of_station(station.name, ())
    path = tmp_path / "report.html"
    write(Result(pipeline, (station,)), path)
    page = path.read_text(encoding="utf-8")
    pictures = re.findall(r'src="data:image/jpeg;base64,([^"]+)"', page)
    assert len(pictures) == len(station.cameras)
    for picture in pictures:
        image = cv2.imdecode(np.frombuffer(base64.b64decode(picture), np.uint8), cv2.IMREAD_COLOR)
        assert image.shape[1] == PHOTO_WIDTH
    # nothing is loaded from elsewhere
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)
    assert path.stat().st_size < 2_000_000
    assert "data:image" not in report_page(pipeline, [station], photographs=False)


def test_language_that_is_not_known_is_refused_and_writes_nothing(everything, tmp_path):
    with pytest.raises(InputError, match="there is no 'fr'"):
        write_report(everything, tmp_path / "report.html", language="fr")
    assert list(tmp_path.iterdir()) == []
