# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the photo window shows where photographs are not where they were: which, and a way to find them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.translation import tr

ICON_PX = 48
TEXT_WIDTH = 560


class MissingPage(QtWidgets.QWidget):  # type: ignore[misc]  # Qt has no types
    """Names the missing files and offers to look for them."""

    def __init__(self, find: Callable[[], None]) -> None:
        super().__init__()
        layout = QtWidgets.QVBoxLayout(self)
        layout.addStretch()
        icon = QtWidgets.QLabel()
        icon.setPixmap(self.style().standardIcon(QtWidgets.QStyle.StandardPixmap.SP_MessageBoxWarning).pixmap(ICON_PX, ICON_PX))
        self.text = QtWidgets.QLabel()
        self.text.setWordWrap(True)
        self.text.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
        self.button = QtWidgets.QPushButton(tr("Find them..."))
        self.button.setToolTip(tr("Choose the folder that the photographs are in now"))
        self.button.clicked.connect(lambda *_: find())
        self.text.setMinimumWidth(TEXT_WIDTH)
        for widget in (icon, self.text, self.button):
            layout.addWidget(widget, 0, QtCore.Qt.AlignmentFlag.AlignHCenter)
        self.text.setAlignment(QtCore.Qt.AlignmentFlag.AlignHCenter)
        layout.addStretch()

    def tell(self, station: str, missing: Sequence[Path], problem: str) -> None:
        """Say which files are missing, or what else is wrong."""
        if missing:
            head = tr("{station}: these photographs are not where they were").format(station=station)
            folder = tr("last seen in {folder}").format(folder=missing[0].parent)
            self.text.setText("\n".join((head, "", *(path.name for path in missing), "", folder, "")))
        else:
            self.text.setText(problem)


def ask_folder(parent: QtWidgets.QWidget, start: str) -> str:
    """Ask for a folder; empty where the user cancels."""
    title = tr("Folder with the photographs")
    options = QtWidgets.QFileDialog.Option.DontUseNativeDialog | QtWidgets.QFileDialog.Option.ShowDirsOnly
    return str(QtWidgets.QFileDialog.getExistingDirectory(parent, title, start, options))
