# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of cut sheets and of single parts, to be looked at and printed: PDF with a page for each, or one SVG."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path as FilePath

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.exports.pages import (
    GREY,
    HAIR,
    INK,
    LANDSCAPE,
    LINE,
    MM_PER_POINT,
    PALE,
    THIN,
    Page,
    fitted,
    text_width,
    write_pages,
)
from pipeworkbench.exports.sheets import NestedSheet, Placed
from pipeworkbench.exports.texts import Texts, named, phrased, texts_of
from pipeworkbench.insulation.flat import Path, Pattern
from pipeworkbench.recon.camera import Array

TEXTS = "cut_sheets.texts.json"
# colour, pattern of dashes; as on the layers of the DXF file, dark enough for paper
STYLES = {"CUT": (INK, "-"), "MARK": ("#0050b0", "-"), "FOLD": ("#00803c", (0, (6, 3))), "CENTRE": ("#b03060", (0, (10, 3, 2, 3)))}
ENGRAVED, CAPITALS = "#7030a0", 0.73  # colour of engraved texts; height of capitals in sizes of the font
FILLS = ("#cfe3f5", "#fbe0c4", "#d5ecd4", "#f3d3e4", "#e6e0f2", "#fbf3c4", "#d6eff0", "#e9dccf")
FRAME = 7.0  # mm from the page's edge
LEFT, RIGHT, TOP = 20.0, 287.0, 190.0  # mm, where the drawing of a sheet may be
FOOTER, DIMENSION_ROOM = 15.0, 9.0  # mm
COLUMNS, ROW, HEADER_ROW = 3, 3.5, 5.0  # of the list of parts; mm
MOST_ROWS, ROWS_ALONE = 13, 48  # of the list under a sheet, of one that goes on
CELLS = (8.0, 43.0, 26.0)  # mm, widths of the list's first columns
LIST_POINTS = 6.5
GRID = 17  # places along each side where a part's label is tried
CLEARANCE = 0.08  # mm around a label for each point of its first line's size
DENSE = 0.8  # mm on paper between points of an outline that labels keep clear of
CHORD_ERROR = 0.03  # mm on paper
LINE_SPACING = 1.25
PARTS_ACROSS, PARTS_DOWN = 3, 2


def write_sheet_pictures(sheets: Sequence[NestedSheet], path: FilePath, *, language: str = "en", title: str = "") -> None:
    """Draw each sheet on a page of its own with its parts, their numbers and a list of them.

    Parameters
    ----------
    sheets : sequence of NestedSheet
    path : Path
        Ends in ``.pdf``, or in ``.svg`` for one picture with all pages below each other.
    language : str
        One of ``texts.LANGUAGES``.
    title : str
        What stands on every page, such as the project's name.

    Raises
    ------
    InputError
        Where there is no sheet or the language or the path's ending is not known.
    MissingPackageError
        Where matplotlib is not installed.
    """
    texts = texts_of(TEXTS, language, "the pictures of sheets")
    if not sheets:
        raise InputError(path, "", "there is no sheet to be drawn", "nest parts first")
    drawings: list[Callable[[Page], None]] = []
    for sheet in sheets:
        patterns = _patterns_on(sheet)
        head = partial(_sheet_head, sheet=sheet, count=len(sheets), title=title, texts=texts)
        drawings.append(partial(_draw_sheet, sheet=sheet, patterns=patterns, head=head, texts=texts))
        rest = range(COLUMNS * MOST_ROWS, len(patterns), COLUMNS * ROWS_ALONE)
        drawings += [partial(_draw_rest, sheet=sheet, patterns=patterns, first=first, head=head, texts=texts) for first in rest]
    write_pages(drawings, path, LANDSCAPE)


def write_part_pictures(patterns: Sequence[Pattern], path: FilePath, *, language: str = "en", title: str = "") -> None:
    """Draw each part once with its dimensions, several on a page; parameters and errors are those of ``write_sheet_pictures``."""
    texts = texts_of(TEXTS, language, "the pictures of parts")
    if not patterns:
        raise InputError(path, "", "there is no part to be drawn", "give the insulation a jacket of sheet metal")
    on_a_page = PARTS_ACROSS * PARTS_DOWN
    groups = [patterns[first : first + on_a_page] for first in range(0, len(patterns), on_a_page)]
    heads = [texts["page_of"].format(page=page, pages=len(groups)) for page in range(1, len(groups) + 1)]
    drawings = [partial(_draw_parts, patterns=group, head=head, title=title, texts=texts) for group, head in zip(groups, heads, strict=True)]
    write_pages(drawings, path, LANDSCAPE)


def _patterns_on(sheet: NestedSheet) -> list[Pattern]:
    """Return what lies on a sheet, each pattern once, by component and id."""
    by_key = {id(part.pattern): part.pattern for part in sheet.parts}
    return sorted(by_key.values(), key=lambda pattern: (pattern.component, pattern.id))


def _draw_frame(page: Page, title: str, texts: Texts) -> None:
    """Draw what every page has: the frame, the title and what the lines mean."""
    width, height = page.size
    corners = [(FRAME, FRAME), (width - FRAME, FRAME), (width - FRAME, height - FRAME), (FRAME, height - FRAME), (FRAME, FRAME)]
    page.line(corners, LINE)
    x, y = FRAME + 4.0, FRAME + 3.0
    for layer, (colour, dashes) in STYLES.items():
        page.line([(x, y + 0.8), (x + 9.0, y + 0.8)], LINE, colour, linestyle=dashes)
        page.text(x + 11.0, y, texts["legend"][layer], 7.0)
        x += 17.0 + text_width(texts["legend"][layer], 7.0)
    page.text(x, y, texts["side"], 7.0, color=GREY)
    x += text_width(texts["side"], 7.0)
    page.text(width - FRAME - 4.0, y, fitted(title, 7.0, width - FRAME - 10.0 - x), 7.0, ha="right", color=GREY)


def _sheet_head(page: Page, *, sheet: NestedSheet, count: int, title: str, texts: Texts, said: Sequence[str]) -> None:
    _draw_frame(page, title, texts)
    name = texts["sheet_of"].format(number=sheet.number, count=count)
    material = texts["material"].format(material=named(texts, "materials", sheet.sheet.material), thickness=sheet.sheet.thickness)
    size = texts["sheet_size"].format(width=sheet.size.width, height=sheet.size.height)
    _draw_head(page, name, " · ".join((material, size, texts["used"].format(share=100 * sheet.used), *said)))


def _draw_head(page: Page, name: str, rest: str) -> None:
    x, y = FRAME + 4.0, page.size[1] - FRAME - 7.5
    page.text(x, y, name, 13.0, fontweight="bold")
    x += text_width(name, 13.0, bold=True) + 8.0
    page.text(x, y, fitted(rest, 9.5, page.size[0] - FRAME - 4.0 - x), 9.5)
    page.line([(FRAME, y - 3.5), (page.size[0] - FRAME, y - 3.5)], THIN)


def _draw_sheet(page: Page, *, sheet: NestedSheet, patterns: Sequence[Pattern], head: Callable[..., None], texts: Texts) -> None:
    rows = min(MOST_ROWS, math.ceil(len(patterns) / COLUMNS))
    bottom = FOOTER + HEADER_ROW + rows * ROW + 3.0 + DIMENSION_ROOM
    scale = max(sheet.size.width / (RIGHT - LEFT), sheet.size.height / (TOP - bottom))
    width, height = sheet.size.width / scale, sheet.size.height / scale
    corner = np.array([(LEFT + RIGHT - width) / 2, bottom + (TOP - bottom - height) / 2])
    pieces = texts["parts_on_sheet"].format(pieces=len(sheet.parts), kinds=len(patterns))
    head(page, said=(pieces, texts["scale"].format(scale=scale)))
    x, y = (float(value) for value in corner)
    page.area([corner + np.array([(0, 0), (width, 0), (width, height), (0, height)])], "#ffffff", LINE)
    page.dimension((x, y - 5.0), (x + width, y - 5.0), f"{sheet.size.width:g}", 8.0)
    page.dimension((x - 6.0, y), (x - 6.0, y + height), f"{sheet.size.height:g}", 8.0)
    components = sorted({pattern.component for pattern in patterns})
    numbers = {id(pattern): number for number, pattern in enumerate(patterns, 1)}
    for part in sheet.parts:
        fill = FILLS[components.index(part.pattern.component) % len(FILLS)]
        _draw_piece(page, part, numbers[id(part.pattern)], fill, scale, corner)
    _draw_marks(page, sheet.parts, scale, corner)
    _draw_list(page, sheet, patterns, 0, FOOTER + HEADER_ROW + rows * ROW, rows, texts)


def _draw_rest(page: Page, *, sheet: NestedSheet, patterns: Sequence[Pattern], first: int, head: Callable[..., None], texts: Texts) -> None:
    """Draw what of the list of a sheet's parts has no room under the sheet."""
    head(page, said=(texts["continued"],))
    rows = min(ROWS_ALONE, math.ceil((len(patterns) - first) / COLUMNS))
    _draw_list(page, sheet, patterns, first, TOP - HEADER_ROW, rows, texts)


def _draw_list(page: Page, sheet: NestedSheet, patterns: Sequence[Pattern], first: int, top: float, rows: int, texts: Texts) -> None:
    """Draw ``rows`` rows of the list of parts in columns below ``top`` (mm), from the part with the index ``first`` on."""
    here = Counter(id(part.pattern) for part in sheet.parts)
    width = (page.size[0] - 2 * FRAME - 8.0) / COLUMNS
    for column in range(COLUMNS):
        left = FRAME + 4.0 + column * width
        starts = [left, left + CELLS[0], left + sum(CELLS[:2]), left + sum(CELLS)]
        shown = patterns[first + column * rows : first + (column + 1) * rows]
        if not shown:
            break
        for start, name in zip(starts, ("number", "part", "size", "pieces"), strict=True):
            page.text(start, top, texts["columns"][name], LIST_POINTS, color=GREY)
        page.line([(left, top - 1.2), (left + width - 5.0, top - 1.2)], HAIR, GREY)
        for row, pattern in enumerate(shown):
            number = first + column * rows + row + 1
            pieces = texts["pieces_of"].format(here=here[id(pattern)], all=pattern.quantity) if pattern.quantity > 1 else "1"
            cells = (str(number), fitted(pattern.id, LIST_POINTS, CELLS[1] - 2.0), _size_text(pattern), pieces)
            for start, cell in zip(starts, cells, strict=True):
                page.text(start, top - (row + 1) * ROW - 0.7, cell, LIST_POINTS)


def _size_text(pattern: Pattern) -> str:
    left, bottom, right, top = pattern.outline.bounds
    return f"{right - left:.1f} × {top - bottom:.1f}"


def _on_paper(path: Path, scale: float, corner: Array) -> Array:
    """Return points (n, 2) of a path in mm of the page."""
    return path.sampled(CHORD_ERROR * scale) / scale + corner


def _draw_piece(page: Page, part: Placed, number: int, fill: str, scale: float, corner: Array) -> None:
    """Draw a piece of a sheet with its number, its id and its size as far as there is room in it."""
    outlines = _draw_shape(page, part, fill, scale, corner)
    pattern = part.pattern
    size = _size_text(pattern)
    forms = [
        [(str(number), 10.0), (pattern.id, 6.0), (size, 6.0)],
        [(str(number), 8.0), (pattern.id, 5.0)],
        *([(str(number), points)] for points in (9.0, 7.0, 5.5, 4.5)),
    ]
    for form in forms:
        for upright in (False, True):
            place = _free_place(outlines, form, upright=upright)
            if place is not None:
                _draw_label(page, place, form, fill, upright=upright)
                return
    left, bottom, right, top = part.bounds
    middle = np.array([left + right, bottom + top]) / 2 / scale + corner
    _draw_label(page, middle, [(str(number), 4.0)], "none", upright=False)


def _draw_shape(page: Page, part: Placed, fill: str, scale: float, corner: Array) -> list[Array]:
    """Draw a piece without its marks; return outline and holes as points (n, 2) on paper, holes clockwise."""
    pattern = part.pattern
    paths = [part.path(pattern.outline).counter_clockwise(), *(part.path(hole).counter_clockwise().reversed() for hole in pattern.holes)]
    outlines = [_on_paper(path, scale, corner) for path in paths]
    page.area(outlines, fill, THIN)
    return outlines


def _draw_marks(page: Page, parts: Sequence[Placed], scale: float, corner: Array) -> None:
    """Draw what is scribed on pieces."""
    for layer in ("MARK", "FOLD", "CENTRE"):
        paths = [part.path(path) for part in parts for on, path in part.pattern.marks if on == layer]
        points = [_on_paper(path, scale, corner) for path in paths]
        colour, dashes = STYLES[layer]
        closed = [np.vstack([row, row[:1]]) if path.closed else row for row, path in zip(points, paths, strict=True)]
        page.lines(closed, THIN, colour, dashes)


def _label_size(form: Sequence[tuple[str, float]]) -> tuple[float, float]:
    """Return width and height (mm) of a label's lines."""
    width = max(text_width(text, points, bold=index == 0) for index, (text, points) in enumerate(form))
    return width, sum(points * MM_PER_POINT * LINE_SPACING for _, points in form)


def _free_place(outlines: Sequence[Array], form: Sequence[tuple[str, float]], *, upright: bool) -> Array | None:
    """Return the place (2,) nearest to a part's middle where a label lies in the sheet metal and on no edge, None where there is none."""
    half = np.array(_label_size(form)[:: -1 if upright else 1]) / 2 + CLEARANCE * form[0][1]
    lower, upper = outlines[0].min(axis=0), outlines[0].max(axis=0)
    if (upper - lower < 2 * half).any():
        return None
    middle = (lower + upper) / 2
    edge = np.concatenate([_dense(points) for points in outlines])
    steps = np.linspace(-1.0, 1.0, GRID)
    grid = middle + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2) * ((upper - lower) / 2 - half)
    nearest_first = grid[np.argsort(np.linalg.norm(grid - middle, axis=1), kind="stable")]
    # the middle is free most often
    for places in (middle[None], nearest_first):
        inside = sum(Path.polygon(points).contains(places).astype(int) for points in outlines) == 1
        clear = ~(abs(edge - places[inside][:, None]) < half).all(axis=2).any(axis=1)
        if clear.any():
            return np.asarray(places[inside][clear][0])
    return None


def _dense(points: Array) -> Array:
    """Return points (m, 2) along a closed polygon (n, 2) that are not farther apart than DENSE."""
    following = np.roll(points, -1, axis=0)
    counts = np.ceil(np.linalg.norm(following - points, axis=1) / DENSE).astype(int).clip(1)
    segment = np.repeat(np.arange(len(points)), counts)
    share = (np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[segment]
    return points[segment] + share[:, None] * (following - points)[segment]


def _draw_label(page: Page, place: Array, form: Sequence[tuple[str, float]], fill: str, *, upright: bool) -> None:
    """Draw lines of text, the first bold, in the middle of a place and on the part's colour, so that no mark runs through them."""
    _, height = _label_size(form)
    across = np.array([-1.0, 0.0]) if upright else np.array([0.0, 1.0])
    done = 0.0
    for index, (text, points) in enumerate(form):
        line = points * MM_PER_POINT * LINE_SPACING
        x, y = place + across * (height / 2 - done - line / 2)
        done += line
        around = {"facecolor": fill, "edgecolor": "none", "pad": 0.3}
        weight = "bold" if index == 0 else "normal"
        page.text(x, y, text, points, ha="center", va="center", rotation=90 if upright else 0, fontweight=weight, bbox=around, zorder=5)


def _draw_parts(page: Page, *, patterns: Sequence[Pattern], head: str, title: str, texts: Texts) -> None:
    _draw_frame(page, title, texts)
    _draw_head(page, texts["single_parts"], head)
    width = (page.size[0] - 2 * FRAME) / PARTS_ACROSS
    height = (TOP - FOOTER) / PARTS_DOWN
    for index, pattern in enumerate(patterns):
        row, column = divmod(index, PARTS_ACROSS)
        _draw_part(page, pattern, (FRAME + column * width, TOP - (row + 1) * height), (width, height), texts)
    for column in range(1, PARTS_ACROSS):
        page.line([(FRAME + column * width, FOOTER), (FRAME + column * width, TOP)], HAIR, PALE)
    page.line([(FRAME, TOP - height), (page.size[0] - FRAME, TOP - height)], HAIR, PALE)


def _draw_part(page: Page, pattern: Pattern, cell: tuple[float, float], size: tuple[float, float], texts: Texts) -> None:
    """Draw one part in a cell (its lower left corner and its size in mm) with what is to be known of it."""
    x, top, room = cell[0] + 4.0, cell[1] + size[1] - 5.0, size[0] - 8.0
    left, bottom, right, upper = pattern.outline.bounds
    width, height = right - left, upper - bottom
    sheet = pattern.sheet
    kind = named(texts, "kinds", pattern.kind)
    material = named(texts, "materials", sheet.material)
    line = texts["part_line"].format(kind=kind, material=material, thickness=sheet.thickness, quantity=pattern.quantity)
    page.text(x, top, fitted(pattern.id, 9.0, room, bold=True), 9.0, fontweight="bold")
    page.text(x, top - 4.2, fitted(line, 7.0, room), 7.0)
    areas = texts["part_areas"].format(width=width, height=height, area=pattern.cut_area / 1e6)
    page.text(x, top - 7.8, fitted(areas, 7.0, room), 7.0)
    page.text(x, cell[1] + 2.0, fitted("; ".join(phrased(texts, "remarks", remark) for remark in pattern.remarks), 6.0, room), 6.0, color=GREY)
    scale = max(width / (room - 10.0), height / (size[1] - 29.0))
    middle = np.array([cell[0] + size[0] / 2 + 3.0, cell[1] + (size[1] - 29.0) / 2 + 13.0])
    corner = middle - np.array([left + right, bottom + upper]) / 2 / scale
    part = Placed(pattern, 1, 0.0, (0.0, 0.0))
    _draw_shape(page, part, FILLS[0], scale, corner)
    _draw_marks(page, [part], scale, corner)
    for text in pattern.texts:
        x2, y2 = np.array(text.position) / scale + corner
        points = text.height / scale / CAPITALS / MM_PER_POINT
        page.text(x2, y2, text.text, points, rotation=text.angle_deg, rotation_mode="anchor", color=ENGRAVED)
    (x0, y0), (x1, y1) = ((float(u), float(v)) for u, v in (np.array([(left, bottom), (right, upper)]) / scale + corner))
    page.dimension((x0, y0 - 4.0), (x1, y0 - 4.0), f"{width:.1f}", 6.5)
    page.dimension((x0 - 4.5, y0), (x0 - 4.5, y1), f"{height:.1f}", 6.5)
