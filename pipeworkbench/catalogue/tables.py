# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the standards from CSV files, checked cell by cell: what is wrong is named by file, line and column.

UTF-8, commas between the cells, decimal points; empty lines and lines that start with ``#`` are left out.
"""

from __future__ import annotations

import csv
import dataclasses
import difflib
import functools
import logging
import math
import re
import types
import typing
from collections.abc import Container, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pipeworkbench.catalogue.kinds import KINDS
from pipeworkbench.catalogue.records import PipeSize, Record
from pipeworkbench.errors import InputError, one_line
from pipeworkbench.files import MISSPELLING_SIMILARITY

R = TypeVar("R", bound=Record)
USER_DEFAULTS: Mapping[str, Any] = {"verified": 0, "series": 3}  # what a user's table need not say
GRADES = (0, 1, 2)
NUMBER = r"[+-]?(\d+\.?\d*|\.\d+)"  # Python's own reader also takes nan, 1_000 and 1e999
DECIMAL_COMMA = r"[+-]?(\d+|\d{1,3}(\.\d{3})+),\d*"
LONGEST_CELL = 40  # characters of a wrong cell that a message shows

_log = logging.getLogger(__name__)


@dataclasses.dataclass(frozen=True)
class _Column:
    """How the cells of a column are read; an empty one is ``default``, and refused where it is ``needed``."""

    kind: type
    needed: bool
    default: Any = None


def kind_of(path: Path) -> type[Record] | None:
    """Return the kind of table that a file's name begins with (``flanges_ours.csv`` holds flanges), None for others."""
    name = path.stem.lower()
    # the longest first: pipe_walls are no pipes
    names = (kind for kind in sorted(KINDS, key=len, reverse=True) if name == kind or name.startswith(f"{kind}_"))
    return next((KINDS[kind] for kind in names), None)


def _known_kind_of(path: Path) -> type[Record]:
    kind = kind_of(path)
    if kind is not None:
        return kind
    close = difflib.get_close_matches(path.stem.lower().rpartition("_")[0] or path.stem.lower(), KINDS, 1, MISSPELLING_SIMILARITY)
    hint = f" (did you mean '{close[0]}'?)" if close else ""
    names = ", ".join(f"{known}_..." for known in KINDS)
    raise InputError(path, "", f"no table is called so{hint}", f"begin the name with the kind of its rows: {names}")


def read_user_tables(folder: Path) -> dict[type[Record], tuple[Record, ...]]:
    """Read all ``*.csv`` of a user's folder.

    Returns
    -------
    dict
        Records by their kind, each with its file's name as ``source``. ``verified`` is 0 and ``standard``
        the file's name without ending where the table does not say otherwise.

    Raises
    ------
    InputError
        Where the folder is none or holds no table, and for everything wrong in a table.
    """
    try:
        files = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".csv" and path.is_file())
    except FileNotFoundError:
        raise InputError(folder, "", "there is no such folder", "check the path of the folder with your tables") from None
    except NotADirectoryError:
        raise InputError(folder, "", "this is not a folder", "name the folder that holds the tables") from None
    except OSError as error:
        raise InputError(folder, "", f"cannot be read ({error.strerror})", "check the permissions") from None
    if not files:
        raise InputError(folder, "", "holds no table", f"put a CSV file into it, such as {next(iter(KINDS))}_ours.csv")
    tables: dict[type[Record], list[Record]] = {}
    places: dict[tuple[Any, ...], Path] = {}
    for path in files:
        kind = _known_kind_of(path)
        for record in read_table(path, kind, {**USER_DEFAULTS, "standard": path.stem}, path.name):
            other = places.setdefault((kind, *record.key), path)
            if other != path:
                what = ", ".join(f"{name} {getattr(record, name)}" for name in kind.KEY)
                raise InputError(path, "", f"{what} is in {other.name} too", "leave it in one of the two files")
            tables.setdefault(kind, []).append(record)
    return {kind: tuple(records) for kind, records in tables.items()}


def read_table(path: Path, kind: type[R], defaults: Mapping[str, Any] | None = None, source: str = "") -> tuple[R, ...]:
    """Read the records of one table in the file's order.

    Parameters
    ----------
    path : Path
    kind : type
        The kind of record; its fields are the columns.
    defaults : mapping, optional
        Values of columns that the file may leave out or leave empty.
    source : str, optional
        What the records say of where they come from.

    Raises
    ------
    InputError
        With line and column: missing or misspelt columns, cells that are no number, inconsistent
        dimensions, repeated keys, another encoding than UTF-8.
    """
    lines = _lines(path)
    if not lines:
        raise InputError(path, "", "the table is empty", f"begin it with a line of column names: {', '.join(_needed(kind))}")
    (first, header), *rows = lines
    columns = {name: _with_default(column, name, defaults or {}) for name, column in _columns(kind).items()}
    _check_header(path, first, header, columns)
    records: list[R] = []
    seen: dict[tuple[Any, ...], int] = {}
    for number, cells in rows:
        if len(cells) > len(header):
            problem = f"column {len(header) + 1}: there are {len(cells)} cells for {len(header)} columns"
            raise InputError(path, f"line {number}", problem, "write decimal points, not commas, and one cell per column")
        texts = dict(zip(header, cells, strict=False))  # what is missing at the end is empty
        values = {name: _value(path, number, name, texts.get(name, ""), column) for name, column in columns.items()}
        _check_names(path, number, values.get("unsourced") or (), columns)
        record = kind(**values | {"source": source})
        misfit = record.problem()
        if misfit is not None:
            raise _wrong(path, number, *misfit, "correct this row")
        earlier = seen.setdefault(record.key, number)
        if earlier != number:
            raise _wrong(path, number, kind.KEY[0], f"the same {', '.join(kind.KEY)} as in line {earlier}", "leave one of the two rows")
        records.append(record)
    return tuple(records)


def read_pipe_sizes(path: Path) -> tuple[PipeSize, ...]:
    """Read a table of pipe sizes by increasing diameter; lines that start with ``#`` are comments."""
    return tuple(sorted(read_table(path, PipeSize), key=lambda size: size.outer_diameter))


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """Return the numbers and cells of the lines that are neither empty nor comments."""
    try:
        data = path.read_bytes()
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        row, column = before.count(b"\n") + 1, before.rpartition(b"\n")[2].count(b",") + 1
        raise InputError(path, f"line {row}", f"column {column}: the characters are not UTF-8", "save the file as CSV UTF-8") from None
    except OSError as error:
        raise InputError(path, "", f"cannot be read ({error.strerror})", "check the file and its permissions") from None
    lines = []
    for number, line in enumerate(text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), 1):
        if not line.strip().strip(",;") or line.lstrip().startswith("#"):
            continue
        try:
            cells = next(csv.reader([line], strict=True))
        except (csv.Error, ValueError) as error:
            raise InputError(path, f"line {number}", f"not a line of cells ({error})", "correct the quotation marks") from None
        lines.append((number, [cell.strip() for cell in cells]))
    return lines


@functools.cache
def _columns(kind: type[Record]) -> dict[str, _Column]:
    """Return the columns of a kind of record from the types of its fields."""
    hints = typing.get_type_hints(kind)
    columns = {}
    for field in dataclasses.fields(kind):  # type: ignore[arg-type]  # all kinds of records are dataclasses
        if field.name == "source":
            continue
        hint = hints[field.name]
        options = typing.get_args(hint) if isinstance(hint, types.UnionType) else (hint,)
        needed = types.NoneType not in options and field.default is dataclasses.MISSING
        cell = {typing.Literal: int, tuple: tuple}.get(typing.get_origin(options[0]), options[0])
        columns[field.name] = _Column(cell, needed, None if field.default is dataclasses.MISSING else field.default)
    return columns


def _needed(kind: type[Record]) -> list[str]:
    return [name for name, column in _columns(kind).items() if column.needed and name not in USER_DEFAULTS]


def _with_default(column: _Column, name: str, defaults: Mapping[str, Any]) -> _Column:
    return dataclasses.replace(column, needed=False, default=defaults[name]) if name in defaults else column


def _check_header(path: Path, number: int, header: list[str], columns: Mapping[str, _Column]) -> None:
    for name in header:
        if header.count(name) > 1:
            raise _wrong(path, number, name, "there are two of this name", "leave one of the two")
        if name in columns:
            continue
        if any(mark in name for mark in ";\t"):
            raise _wrong(path, number, name, "the cells are not parted by commas", "save the file with commas between cells and decimal points")
        close = [column for column in difflib.get_close_matches(name, columns, 1, MISSPELLING_SIMILARITY) if column not in header]
        if close:
            raise _wrong(path, number, name, "no column of this table is called so", f"did you mean '{close[0]}'?")
        _log.warning("%s", one_line(f"{path}: line {number}: column '{name}': not a column of this table, ignored"))
    for name, column in columns.items():
        if column.needed and name not in header:
            raise _wrong(path, number, name, "is missing", "add this column")


def _value(path: Path, number: int, name: str, text: str, column: _Column) -> Any:
    """Return a cell's value, checked by the column's kind."""
    if not text:
        if column.needed:
            raise _wrong(path, number, name, "is empty", "fill in this cell")
        return column.default
    if column.kind is str:
        return text
    if column.kind is tuple:
        return tuple(text.split())
    value = _number(path, number, name, text)
    if name.endswith("verified"):
        if value not in GRADES:
            raise _wrong(path, number, name, f"is {text}, not 0, 1 or 2", "give the number of independent sources, 2 for more")
    elif not 0 < value < math.inf:
        raise _wrong(path, number, name, f"is {_shown(text)}, not more than 0", "give a positive number")
    if column.kind is int and value != int(value):
        raise _wrong(path, number, name, f"is {text}, not a whole number", "give a whole number")
    return column.kind(value)


def _number(path: Path, number: int, name: str, text: str) -> float:
    if re.fullmatch(DECIMAL_COMMA, text, re.ASCII):
        raise _wrong(path, number, name, f"'{_shown(text)}' has a decimal comma", "write a decimal point")
    if not re.fullmatch(NUMBER, text, re.ASCII):
        raise _wrong(path, number, name, f"'{_shown(text)}' is not a number", "give a number without unit, with a decimal point")
    return float(text)


def _shown(text: str) -> str:
    return text if len(text) <= LONGEST_CELL else f"{text[:LONGEST_CELL]}..."


def _check_names(path: Path, number: int, names: Iterable[str], columns: Container[str]) -> None:
    unknown = [name for name in names if name not in columns]
    if unknown:
        raise _wrong(path, number, "unsourced", f"there is no column '{unknown[0]}'", "name columns of this table, with spaces between")


def _wrong(path: Path, number: int, column: str, problem: str, remedy: str) -> InputError:
    return InputError(path, f"line {number}", f"column '{column}': {problem}", remedy)
