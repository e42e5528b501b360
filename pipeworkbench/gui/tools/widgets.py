# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small parts of the tools' panels; a task panel is narrow."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pipeworkbench.gui.compat import QtWidgets

LEAST_LETTERS = 8


def narrow_combo(name: str = "") -> Any:
    """Return a combo box that may be narrower than its longest text."""
    combo = QtWidgets.QComboBox()
    combo.setObjectName(name)
    combo.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    combo.setMinimumContentsLength(LEAST_LETTERS)
    return combo


def wrapped_label(name: str) -> Any:
    """Return a label that breaks its lines."""
    label = QtWidgets.QLabel()
    label.setObjectName(name)
    label.setWordWrap(True)
    label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Preferred, QtWidgets.QSizePolicy.Policy.Maximum)
    return label


def push_button(text: str, tooltip: str, pressed: Callable[..., None], name: str) -> Any:
    """Return a button that may be narrow, and what it does."""
    button = QtWidgets.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(tooltip)
    button.setMinimumWidth(40)
    button.clicked.connect(pressed)
    return button


def row_of(*widgets: Any) -> Any:
    """Return widgets beside each other."""
    row = QtWidgets.QHBoxLayout()
    for widget in widgets:
        row.addWidget(widget)
    return row


def sentence(reason: str) -> str:
    """Return a reason as it is read: with a capital and a full stop."""
    return reason[:1].upper() + reason[1:].removesuffix(".") + "." if reason else ""
