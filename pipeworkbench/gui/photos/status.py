# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window's status line: what to do, what is going on, and what the pointer is at."""

from __future__ import annotations

from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets

MARGIN = 6
HINT_MS = 4000


class StatusLine(QtWidgets.QWidget):  # type: ignore[misc]  # Qt has no types
    """A hint that stays, a notice that goes, and the pointer's place."""

    def __init__(self) -> None:
        super().__init__()
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(MARGIN, 2, MARGIN, 2)
        self.hint = QtWidgets.QLabel()
        self.work = QtWidgets.QLabel()
        self.place = QtWidgets.QLabel()
        self.place.setFont(QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.SystemFont.FixedFont))
        layout.addWidget(self.hint, 1)
        layout.addWidget(self.work)
        layout.addWidget(self.place)
        # a text that is too long is cut off instead of widening the window
        self.hint.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)
        self._standing = ""
        self._timer = QtCore.QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._show_standing)

    def set_hint(self, text: str) -> None:
        """Say what to do; it stays until another is set."""
        self._standing = text
        if not self._timer.isActive():
            self._show_standing()

    def notice(self, text: str) -> None:
        """Say something that is over in a moment."""
        self.hint.setText(text)
        self._timer.start(HINT_MS)

    def _show_standing(self) -> None:
        self.hint.setText(self._standing)
