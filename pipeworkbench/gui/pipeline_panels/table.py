# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the panels: numbers are aligned and sorted as numbers, what is not known comes last."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets

KEY_ROLE = QtCore.Qt.ItemDataRole.UserRole
SORT_ROLE = QtCore.Qt.ItemDataRole.UserRole + 1
WIDEST_PX = 380
VISIBLE_ROWS = 9  # the panel scrolls; a table that is higher than the window does not help


@dataclass(frozen=True)
class Column:
    """A column's header and what its tooltip says."""

    title: str
    tooltip: str = ""


@dataclass(frozen=True)
class Cell:
    """What a cell shows, what it is sorted by (the text where it is None), its tooltip and its colour."""

    text: str
    value: float | None = None
    tooltip: str = ""
    colour: str = ""


def number(value: float | None, digits: int, *, colour: str = "", tooltip: str = "") -> Cell:
    """Return the cell of a number, a dash where it is not known."""
    if value is None or not math.isfinite(value):
        return Cell("–", math.inf, tooltip)
    # adding zero takes the sign from what is rounded to nothing
    return Cell(f"{round(value, digits) + 0.0:.{digits}f}", value, tooltip, colour)


def from_to(before: float | None, after: float | None, digits: int) -> Cell:
    """Return the cell of a number that changed, sorted by what it is now."""
    one, other = number(before, digits), number(after, digits)
    return Cell(f"{one.text} → {other.text}", other.value)


class Table(QtWidgets.QTableWidget):  # type: ignore[misc]  # Qt has no types
    """Rows with a key each; ``chosen`` is called with the keys of the selected rows."""

    def __init__(self, name: str, columns: Sequence[Column], chosen: Callable[[list[str]], None] | None = None) -> None:
        super().__init__(0, len(columns))
        self.setObjectName(name)
        for number_, column in enumerate(columns):
            header = QtWidgets.QTableWidgetItem(column.title)
            header.setToolTip(column.tooltip)
            self.setHorizontalHeaderItem(number_, header)
        self.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
        self.setAlternatingRowColors(True)
        self.setWordWrap(False)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 6)
        self.horizontalHeader().setHighlightSections(False)
        if chosen is not None:
            self.itemSelectionChanged.connect(lambda: chosen(self.chosen_keys()))

    def fill(self, rows: Sequence[tuple[str, Sequence[Cell]]]) -> None:
        """Show other rows: (key, cells)."""
        self.setSortingEnabled(False)
        self.blockSignals(True)
        self.setRowCount(len(rows))
        for row, (key, cells) in enumerate(rows):
            for column, cell in enumerate(cells):
                item = _Item(cell)
                item.setData(KEY_ROLE, key)
                self.setItem(row, column, item)
        self.blockSignals(False)
        # in the order that they came in, until a header is clicked
        self.horizontalHeader().setSortIndicator(-1, QtCore.Qt.SortOrder.AscendingOrder)
        self.setSortingEnabled(True)
        self.resizeColumnsToContents()
        height = self.horizontalHeader().sizeHint().height() + self.verticalHeader().defaultSectionSize() * min(max(len(rows), 3), VISIBLE_ROWS)
        self.setMinimumHeight(height + self.horizontalScrollBar().sizeHint().height() + 4)

    def sizeHint(self) -> Any:  # Qt's name
        """Return what the columns need, as far as a side panel has it."""
        hint = super().sizeHint()
        hint.setWidth(min(self.horizontalHeader().length() + self.verticalScrollBar().sizeHint().width() + 4, WIDEST_PX))
        return hint

    def chosen_keys(self) -> list[str]:
        """Return the keys of the selected rows."""
        return list(dict.fromkeys(str(index.data(KEY_ROLE)) for index in self.selectionModel().selectedRows()))

    def texts(self) -> list[list[str]]:
        """Return what the rows show."""
        return [[self.item(row, column).text() for column in range(self.columnCount())] for row in range(self.rowCount())]


class _Item(QtWidgets.QTableWidgetItem):  # type: ignore[misc]
    """A cell that sorts by its value."""

    def __init__(self, cell: Cell) -> None:
        super().__init__(cell.text)
        self.setToolTip(cell.tooltip or cell.text)
        if cell.value is not None:
            self.setData(SORT_ROLE, cell.value)
            self.setTextAlignment(QtCore.Qt.AlignmentFlag.AlignRight | QtCore.Qt.AlignmentFlag.AlignVCenter)
        if cell.colour:
            self.setForeground(QtGui.QBrush(QtGui.QColor(cell.colour)))

    def __lt__(self, other: Any) -> bool:
        one, two = self.data(SORT_ROLE), other.data(SORT_ROLE)
        return bool(self.text() < other.text()) if one is None or two is None else bool(one < two)
