# SPDX-License-Identifier: LGPL-2.1-or-later
"""A list of what can be chosen from, with columns; one row is the chosen one, rows may be ticked."""

from __future__ import annotations

from collections.abc import Sequence

from pipeworkbench.gui.compat import QtCore, QtWidgets, Signal

MOST_VISIBLE = 9  # rows, before it is scrolled
CHECKED, UNCHECKED = QtCore.Qt.CheckState.Checked, QtCore.Qt.CheckState.Unchecked


class ChoiceTable(QtWidgets.QTableWidget):  # type: ignore[misc]  # Qt has no types here
    """Rows of texts; signals tell what the user does, not what the program does."""

    chosen = Signal(int)
    ticked = Signal(int, bool)

    def __init__(self, headers: Sequence[str], tooltip: str, *, ticks: bool = False) -> None:
        super().__init__(0, len(headers))
        self._ticks = ticks
        self._is_filling = False
        self.setHorizontalHeaderLabels(list(headers))
        self.setToolTip(tooltip)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 8)
        header = self.horizontalHeader()
        header.setSectionResizeMode(QtWidgets.QHeaderView.ResizeMode.ResizeToContents)
        header.setStretchLastSection(True)
        header.setHighlightSections(False)
        self.setSelectionBehavior(QtWidgets.QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setMinimumWidth(120)
        self.currentCellChanged.connect(self._current_changed)
        self.itemChanged.connect(self._item_changed)
        self._fit_height()

    def fill(self, rows: Sequence[Sequence[str]], current: int = -1, ticks: Sequence[bool] = ()) -> None:
        """Show rows of texts, one of them as the chosen one; ``ticks`` say which are ticked."""
        self._is_filling = True
        self.setRowCount(len(rows))
        for number, texts in enumerate(rows):
            for column, text in enumerate(texts):
                item = QtWidgets.QTableWidgetItem(text)
                if self._ticks and column == 0:
                    item.setFlags(item.flags() | QtCore.Qt.ItemFlag.ItemIsUserCheckable)
                    item.setCheckState(CHECKED if ticks[number] else UNCHECKED)
                self.setItem(number, column, item)
        self._fit_height()
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

    def _fit_height(self) -> None:
        """Be as high as the rows need: a task panel is short of room."""
        rows = min(max(self.rowCount(), 2), MOST_VISIBLE)
        header = max(self.horizontalHeader().sizeHint().height(), 20)
        self.setFixedHeight(header + rows * self.verticalHeader().defaultSectionSize() + 6)

    def _current_changed(self, row: int, _column: int, old_row: int, _old_column: int) -> None:
        if not self._is_filling and row not in (-1, old_row):
            self.chosen.emit(row)

    def _item_changed(self, item: QtWidgets.QTableWidgetItem) -> None:
        if not self._is_filling and self._ticks and item.column() == 0:
            self.ticked.emit(item.row(), item.checkState() == CHECKED)
