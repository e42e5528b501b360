# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of panels and tools, made for a narrow place: numbers stay whole, names are cut where they must be, and said whole in their tooltips."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, Signal, text_width

KEY_ROLE = QtCore.Qt.ItemDataRole.UserRole
SORT_ROLE = QtCore.Qt.ItemDataRole.UserRole + 1
CHECKED, UNCHECKED = QtCore.Qt.CheckState.Checked, QtCore.Qt.CheckState.Unchecked
WIDEST_PX = 380
VISIBLE_ROWS = 9  # the panel scrolls; a table that is higher than the window does not help
ROW_PADDING_PX, HEADER_PADDING_PX, FRAME_PX = 6, 10, 6
LEAST_NAME_PX = 40  # of a column whose texts are cut
THIN_SPACE = "\N{THIN SPACE}"
UNITS = ("mm", "m", "px", "%", "°")


@dataclass(frozen=True)
class Column:
    """A column's header and what its tooltip says; where there is little room, the texts of a column of ``names`` are cut."""

    title: str
    tooltip: str = ""
    names: bool = False


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
    return Cell(f"{one.text}{THIN_SPACE}→{THIN_SPACE}{other.text}", other.value)


class NarrowTable(QtWidgets.QTableWidget):  # type: ignore[misc]  # Qt has no types
    """What all tables have: they cannot be edited, rows are chosen as a whole, and columns share the room that there is."""

    def __init__(self, name: str, columns: Sequence[Column]) -> None:
        super().__init__(0, len(columns))
        self._names = [row for row, column in enumerate(columns) if column.names]
        self.setObjectName(name)
        for place, column in enumerate(columns):
            header = QtWidgets.QTableWidgetItem(_unit_below(column.title))
            header.setToolTip(column.tooltip or column.title)
            if column.names:
                header.setTextAlignment(QtCore.Qt.AlignmentFlag.AlignLeft | QtCore.Qt.AlignmentFlag.AlignVCenter)
            self.setHorizontalHeaderItem(place, header)
        self.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
        self.setAlternatingRowColors(True)
        self.setWordWrap(False)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + ROW_PADDING_PX)
        self.horizontalHeader().setHighlightSections(False)
        self.horizontalHeader().setTextElideMode(QtCore.Qt.TextElideMode.ElideRight)

    def sizeHint(self) -> Any:  # Qt's name
        """Return what the columns need, as far as a side panel has it."""
        hint = super().sizeHint()
        needed = sum(self._widths_of_contents()) + self.verticalScrollBar().sizeHint().width() + FRAME_PX
        hint.setWidth(min(needed, WIDEST_PX))
        return hint

    def resizeEvent(self, event: Any) -> None:  # Qt's name
        """Share another width."""
        super().resizeEvent(event)
        self.share_width()

    def share_width(self) -> None:
        """Give each column what its contents need; too little room is taken from names, the rest is left to the last column of names."""
        widths = self._widths_of_contents()
        spare = self.viewport().width() - sum(widths)
        if spare > 0:
            widths[self._names[-1] if self._names else -1] += spare
        else:
            beyond = {place: max(widths[place] - LEAST_NAME_PX, 0) for place in self._names}
            part = min(-spare / max(sum(beyond.values()), 1), 1.0)
            for place, pixels in beyond.items():
                widths[place] -= math.ceil(part * pixels)
        for place, width in enumerate(widths):
            self.setColumnWidth(place, width)

    def height_of_rows(self, least: int) -> int:
        """Return the height that the rows need, and as many as there should at least be room for."""
        rows = min(max(self.rowCount(), least), VISIBLE_ROWS)
        return int(self.horizontalHeader().sizeHint().height() + self.verticalHeader().defaultSectionSize() * rows + FRAME_PX)

    def texts(self) -> list[list[str]]:
        """Return what the rows show."""
        return [[self.item(row, column).text() for column in range(self.columnCount())] for row in range(self.rowCount())]

    def _widths_of_contents(self) -> list[int]:
        return [max(self.sizeHintForColumn(place), self._width_of_header(place)) for place in range(self.columnCount())]

    def _width_of_header(self, place: int) -> int:
        header = self.horizontalHeader()
        if header.isSortIndicatorShown() and header.sortIndicatorSection() == place:
            return int(header.sectionSizeHint(place))
        # Qt's hint has room for the arrow in every column that could be sorted by
        lines = self.horizontalHeaderItem(place).text().split("\n")
        return max(text_width(header.fontMetrics(), line) for line in lines) + HEADER_PADDING_PX


class Table(NarrowTable):
    """Rows with a key each, sorted by the header that is clicked; ``chosen`` is called with the keys of the selected rows."""

    def __init__(self, name: str, columns: Sequence[Column], chosen: Callable[[list[str]], None] | None = None) -> None:
        super().__init__(name, columns)
        self.horizontalHeader().sortIndicatorChanged.connect(lambda *_: self.share_width())
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
        self.setMinimumHeight(self.height_of_rows(3) + self.horizontalScrollBar().sizeHint().height())
        self.updateGeometry()
        self.share_width()

    def chosen_keys(self) -> list[str]:
        """Return the keys of the selected rows."""
        return list(dict.fromkeys(str(index.data(KEY_ROLE)) for index in self.selectionModel().selectedRows()))


class ChoiceTable(NarrowTable):
    """A list of which one row is the chosen one, and rows may be ticked; signals tell what the user does, not what the program does."""

    chosen = Signal(int)
    ticked = Signal(int, bool)

    def __init__(self, columns: Sequence[Column], tooltip: str, *, ticks: bool = False) -> None:
        super().__init__("choices", columns)
        self._ticks = ticks
        self._is_filling = False
        self.setToolTip(tooltip)
        self.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.SingleSelection)
        self.currentCellChanged.connect(self._current_changed)
        self.itemChanged.connect(self._item_changed)
        self.setFixedHeight(self.height_of_rows(2))

    def fill(self, rows: Sequence[Sequence[str]], current: int = -1, ticks: Sequence[bool] = ()) -> None:
        """Show rows of texts, one of them as the chosen one; ``ticks`` say which are ticked."""
        self._is_filling = True
        self.setRowCount(len(rows))
        for number_, texts in enumerate(rows):
            for column, text in enumerate(texts):
                item = QtWidgets.QTableWidgetItem(text)
                if column in self._names:
                    item.setToolTip(text)
                if self._ticks and column == 0:
                    item.setFlags(item.flags() | QtCore.Qt.ItemFlag.ItemIsUserCheckable)
                    item.setCheckState(CHECKED if ticks[number_] else UNCHECKED)
                self.setItem(number_, column, item)
        self.setFixedHeight(self.height_of_rows(2))
        self.share_width()
        self._is_filling = False
        self.select(current)

    def select(self, row: int) -> None:
        """Mark a row as the chosen one, none where it is -1."""
        self._is_filling = True
        if row < 0:
            self.setCurrentItem(None)
            self.clearSelection()
        else:
            self.selectRow(row)
        self._is_filling = False

    def _current_changed(self, row: int, _column: int, old_row: int, _old_column: int) -> None:
        if not self._is_filling and row not in (-1, old_row):
            self.chosen.emit(row)

    def _item_changed(self, item: QtWidgets.QTableWidgetItem) -> None:
        if not self._is_filling and self._ticks and item.column() == 0:
            self.ticked.emit(item.row(), item.checkState() == CHECKED)


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


def _unit_below(title: str) -> str:
    """Return a header with its unit below the quantity: columns of numbers are narrow."""
    quantity, _, unit = title.rpartition(" ")
    return f"{quantity}\n{unit}" if quantity and unit in UNITS else title
