# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small parts that panels and tools are made of; all of them may become narrow, for FreeCAD's task panel is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from pipeworkbench.gui.compat import QtWidgets

LEAST_CHARACTERS = 8  # that a list shows where there is little room
LEAST_BUTTON_PX = 40


def group(title: str) -> tuple[Any, Any]:
    """Return a box with a title and its form layout."""
    box = QtWidgets.QGroupBox(title)
    form = QtWidgets.QFormLayout(box)
    form.setRowWrapPolicy(QtWidgets.QFormLayout.RowWrapPolicy.WrapLongRows)
    form.setFieldGrowthPolicy(QtWidgets.QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    return box, form


def choice(name: str, items: Sequence[str] = (), tooltip: str = "") -> Any:
    """Return a list to choose one from."""
    box = QtWidgets.QComboBox()
    box.setObjectName(name)
    box.addItems(list(items))
    box.setToolTip(tooltip)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(LEAST_CHARACTERS)
    return box


def switch(name: str, text: str, tooltip: str = "", *, on: bool = False) -> Any:
    """Return a box to check."""
    box = QtWidgets.QCheckBox(text)
    box.setObjectName(name)
    box.setToolTip(tooltip)
    box.setChecked(on)
    return box


def button(name: str, text: str, tooltip: str, pressed: Callable[..., None]) -> Any:
    """Return a push button."""
    made = QtWidgets.QPushButton(text)
    made.setObjectName(name)
    made.setToolTip(tooltip)
    made.setMinimumWidth(LEAST_BUTTON_PX)
    made.clicked.connect(pressed)
    return made


def amount(value: float, limits: tuple[float, float], unit: str, decimals: int, tooltip: str = "", name: str = "") -> Any:
    """Return a field for a number with a unit."""
    box = QtWidgets.QDoubleSpinBox()
    box.setObjectName(name)
    box.setDecimals(decimals)
    box.setRange(*limits)
    box.setValue(value)
    box.setSuffix(f" {unit}")
    box.setToolTip(tooltip)
    return box


def text_line(name: str, tooltip: str = "", text: str = "") -> Any:
    """Return a field for a line of text."""
    line = QtWidgets.QLineEdit(text)
    line.setObjectName(name)
    line.setToolTip(tooltip)
    return line


def words(name: str) -> Any:
    """Return a text that wraps, no higher than it must be."""
    label = QtWidgets.QLabel()
    label.setObjectName(name)
    label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Preferred, QtWidgets.QSizePolicy.Policy.Maximum)
    label.setWordWrap(True)
    return label


def beside(*widgets: Any) -> Any:
    """Return a widget that holds others beside each other."""
    holder = QtWidgets.QWidget()
    holder.setSizePolicy(QtWidgets.QSizePolicy.Policy.Preferred, QtWidgets.QSizePolicy.Policy.Maximum)
    layout = QtWidgets.QHBoxLayout(holder)
    layout.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        layout.addWidget(widget)
    return holder


def sentence(reason: str) -> str:
    """Return a reason as it is read: with a capital and a full stop."""
    return reason[:1].upper() + reason[1:].removesuffix(".") + "." if reason else ""
