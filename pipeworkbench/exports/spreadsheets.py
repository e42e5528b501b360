# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables for spreadsheets: CSV as ``tables`` writes it and XLSX; no text of ours ever becomes a formula."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pipeworkbench.errors import MissingPackageError, one_line
from pipeworkbench.files import written_whole

FORMULA_SIGNS = ("=", "+", "-", "@")  # what a spreadsheet takes a text for a formula by
LONGEST_TEXT = 32_000  # characters; Excel's cells hold a little more
WIDEST, NARROWEST = 60, 8  # characters, of columns
LINE_BETWEEN = 2  # rows between tables on one worksheet

Cell = str | int | float | None
Row = Mapping[str, Cell]


@dataclass(frozen=True)
class Column:
    """A column: its key in rows and in CSV, and how many decimals its numbers are shown with."""

    key: str
    decimals: int | None = None


@dataclass(frozen=True)
class Table:
    """Rows under headers of text by the columns' keys; ``total`` is a last row that stands out."""

    title: str
    columns: Sequence[Column]
    headers: Mapping[str, str]
    rows: Sequence[Row]
    total: Row | None = None


def write_csv_rows(columns: Sequence[Column], rows: Sequence[Row], path: Path) -> None:
    """Write rows under the columns' keys; UTF-8 with commas, decimal points and a header.

    A text that begins with a sign of a formula gets an apostrophe before it.
    """
    keys = [column.key for column in columns]
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(keys)
        writer.writerows([_csv_cell(row.get(key)) for key in keys] for row in rows)


def write_xlsx(worksheets: Mapping[str, Sequence[Table]], path: Path, title: str) -> None:
    """Write worksheets by their names, on each its tables below each other; the header of a single one stays in sight.

    Raises
    ------
    MissingPackageError
        Where openpyxl is not installed.
    """
    try:
        import openpyxl
    except ImportError:
        raise MissingPackageError("openpyxl", "Writing XLSX", "pip install 'openpyxl>=3.1,<4'") from None
    book = openpyxl.Workbook()
    book.remove(book.active)
    book.properties.creator, book.properties.title = "Pipe Workbench", one_line(title)
    for name, tables in worksheets.items():
        _fill(book.create_sheet(name), tables)
    with written_whole(path) as temporary:
        book.save(temporary)


def _csv_cell(value: Cell) -> Cell:
    if value is None:
        return ""
    if not isinstance(value, str):
        return value
    text = one_line(value)
    return f"'{text}" if text.lstrip().startswith(FORMULA_SIGNS) else text


def _fill(sheet: Any, tables: Sequence[Table]) -> None:
    row = 1
    for table in tables:
        if len(tables) > 1:
            _write_cell(sheet, row, 1, table.title, bold=True)
            row += 1
        row = _add_table(sheet, table, row) + LINE_BETWEEN
    _set_widths(sheet, tables)
    if len(tables) == 1:
        sheet.freeze_panes, sheet.print_title_rows = "B2", "1:1"
    sheet.page_setup.orientation, sheet.page_setup.paperSize = "landscape", sheet.PAPERSIZE_A4
    sheet.sheet_properties.pageSetUpPr.fitToPage, sheet.page_setup.fitToHeight = True, 0
    sheet.oddFooter.right.text = "&P / &N"


def _add_table(sheet: Any, table: Table, row: int) -> int:
    """Write a table from a row on; return the number of the row after it."""
    from openpyxl.styles import Alignment, Border, Side

    for place, column in enumerate(table.columns, 1):
        cell = _write_cell(sheet, row, place, table.headers[column.key], bold=True)
        cell.alignment = Alignment(wrap_text=True, vertical="bottom", horizontal=None if column.decimals is None else "right")
        cell.border = Border(bottom=Side(style="thin"))
    for line in table.rows:
        row += 1
        _write_row(sheet, row, table.columns, line)
    if table.total is not None:
        row += 1
        _write_row(sheet, row, table.columns, table.total, bold=True)
    return row + 1


def _write_row(sheet: Any, row: int, columns: Sequence[Column], line: Row, *, bold: bool = False) -> None:
    for place, column in enumerate(columns, 1):
        cell = _write_cell(sheet, row, place, line.get(column.key), bold=bold)
        if column.decimals is not None:
            cell.number_format = "0." + "0" * column.decimals if column.decimals else "0"


def _write_cell(sheet: Any, row: int, place: int, value: Cell, *, bold: bool = False) -> Any:
    from openpyxl.styles import Font

    cell = sheet.cell(row, place)
    if isinstance(value, str):
        cell.value = one_line(value)[:LONGEST_TEXT]
        # a text stays one, even if it looks like a formula or an error
        cell.data_type = "s"
    else:
        cell.value = value
    if bold:
        cell.font = Font(bold=True)
    return cell


def _set_widths(sheet: Any, tables: Sequence[Table]) -> None:
    from openpyxl.utils import get_column_letter

    for place in range(max(len(table.columns) for table in tables)):
        longest = max(_longest(table, table.columns[place]) for table in tables if place < len(table.columns))
        sheet.column_dimensions[get_column_letter(place + 1)].width = min(max(longest + 2, NARROWEST), WIDEST)


def _longest(table: Table, column: Column) -> int:
    """Return how many characters a column's longest cell has; headers are broken between words."""
    rows = [*table.rows, *([table.total] if table.total else [])]
    words = [len(word) for word in table.headers[column.key].split()]
    return max([*words, *(len(_shown(row.get(column.key), column)) for row in rows)])


def _shown(value: Cell, column: Column) -> str:
    if value is None:
        return ""
    return f"{value:.{column.decimals or 0}f}" if isinstance(value, float) else str(value)
