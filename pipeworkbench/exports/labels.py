# SPDX-License-Identifier: LGPL-2.1-or-later
"""Labels to be stuck on the cut pieces: PDF, several on an A4 page, or CSV for a label printer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from pipeworkbench.errors import InputError
from pipeworkbench.exports.pages import GREY, HAIR, PALE, PORTRAIT, Page, fitted, text_width, write_pages
from pipeworkbench.exports.sheets import NestedSheet
from pipeworkbench.exports.spreadsheets import Column, write_csv_rows
from pipeworkbench.exports.texts import Texts, named, texts_of
from pipeworkbench.insulation.flat import Pattern

TEXTS = "cut_sheets.texts.json"
ACROSS, DOWN = 3, 8
WIDTH, HEIGHT = 70.0, 37.0  # mm, of a label: 24 on a page, a common size
EDGE = 5.0  # mm from a label's edge that printers keep free
TITLE_POINTS, POINTS, LINE = 12.0, 8.0, 4.2  # sizes of texts; mm from line to line
COLUMNS = tuple(
    Column(key) for key in ("part", "run", "component", "kind", "material", "thickness_mm", "width_mm", "height_mm", "piece", "quantity", "sheet")
)


@dataclass(frozen=True)
class Label:
    """What is said of one piece: lengths in mm; ``sheet`` is the number of the sheet it is cut from, None where it is not known."""

    part: str
    run: str
    component: str
    kind: str
    material: str
    thickness: float
    width: float
    height: float
    number: int
    quantity: int
    sheet: int | None = None


def labels_of_sheets(sheets: Sequence[NestedSheet], runs: Mapping[str, str]) -> tuple[Label, ...]:
    """Return a label for each piece, sheet by sheet and in the order of the parts; ``runs`` are the coverings' by their ids."""
    return tuple(
        _label(part.pattern, part.number, runs, sheet.number)
        for sheet in sheets
        for part in sorted(sheet.parts, key=lambda part: (part.pattern.component, part.pattern.id, part.number))
    )


def labels_of_patterns(patterns: Sequence[Pattern], runs: Mapping[str, str]) -> tuple[Label, ...]:
    """Return a label for each piece that is not on a sheet, in the order of the patterns."""
    return tuple(_label(pattern, number, runs, None) for pattern in patterns for number in range(1, pattern.quantity + 1))


def write_labels(labels: Sequence[Label], path: Path, *, language: str = "en") -> None:
    """Write labels as pages of A4 (``.pdf``, ``.svg``) or as one line each (``.csv``), as the path ends.

    Raises
    ------
    InputError
        Where there is no label or the language or the path's ending is not known.
    MissingPackageError
        Where matplotlib is not installed and pages are written.
    """
    texts = texts_of(TEXTS, language, "the labels")
    if not labels:
        raise InputError(path, "", "there is no part to be labelled", "give the insulation a jacket of sheet metal")
    if path.suffix.lower() == ".csv":
        write_csv_rows(COLUMNS, [_row(label) for label in labels], path)
        return
    on_a_page = ACROSS * DOWN
    pages = [labels[first : first + on_a_page] for first in range(0, len(labels), on_a_page)]
    write_pages([partial(_draw_page, labels=page, texts=texts) for page in pages], path, PORTRAIT)


def _label(pattern: Pattern, number: int, runs: Mapping[str, str], sheet: int | None) -> Label:
    left, bottom, right, top = pattern.outline.bounds
    size = (round(right - left, 3), round(top - bottom, 3))
    metal = pattern.sheet
    run = runs.get(pattern.covering, "")
    return Label(pattern.id, run, pattern.component, pattern.kind, metal.material, metal.thickness, *size, number, pattern.quantity, sheet)


def _row(label: Label) -> dict[str, str | int | float | None]:
    return {
        "part": label.part,
        "run": label.run,
        "component": label.component,
        "kind": label.kind,
        "material": label.material,
        "thickness_mm": label.thickness,
        "width_mm": label.width,
        "height_mm": label.height,
        "piece": label.number,
        "quantity": label.quantity,
        "sheet": label.sheet,
    }


def _draw_page(page: Page, *, labels: Sequence[Label], texts: Texts) -> None:
    margin = (page.size[1] - DOWN * HEIGHT) / 2
    for column in range(1, ACROSS):
        page.line([(column * WIDTH, margin), (column * WIDTH, page.size[1] - margin)], HAIR, PALE)
    for row in range(DOWN + 1):
        page.line([(0.0, margin + row * HEIGHT), (page.size[0], margin + row * HEIGHT)], HAIR, PALE)
    for index, label in enumerate(labels):
        row, column = divmod(index, ACROSS)
        _draw_label(page, label, column * WIDTH, page.size[1] - margin - row * HEIGHT, texts)


def _draw_label(page: Page, label: Label, left: float, top: float, texts: Texts) -> None:
    """Draw one label whose upper left corner is given (mm)."""
    names, room = texts["label"], WIDTH - 2 * EDGE
    x, y = left + EDGE, top - EDGE - 4.0
    page.text(x, y, fitted(label.part, TITLE_POINTS, room, bold=True), TITLE_POINTS, fontweight="bold")
    piece = texts["pieces_of"].format(here=label.number, all=label.quantity)
    sheet = "" if label.sheet is None else f", {names['sheet']} {label.sheet}"
    lines = (
        (names["component"], f"{label.component}, {named(texts, 'kinds', label.kind)}"),
        (names["run"], label.run),
        (names["material"], texts["material"].format(material=named(texts, "materials", label.material), thickness=label.thickness)),
        (names["size"], f"{label.width:.1f} × {label.height:.1f} mm"),
        (names["piece"], f"{piece}{sheet}"),
    )
    start = max(text_width(name, POINTS) for name, _ in lines) + 3.0
    for number, (name, value) in enumerate(lines, 1):
        page.text(x, y - 1.5 - number * LINE, name, POINTS, color=GREY)
        page.text(x + start, y - 1.5 - number * LINE, fitted(value, POINTS, room - start), POINTS)
