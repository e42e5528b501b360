# SPDX-License-Identifier: LGPL-2.1-or-later
"""The guide: a dock beside the drawing that lists the tour's steps, checks them off and says what to click next."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.files import package_folder
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, is_alive
from pipeworkbench.gui.dialogs import saved_files
from pipeworkbench.gui.tour.steps import Step, available_steps
from pipeworkbench.gui.translation import tr, translate

OBJECT_NAME = "PipeWorkbenchTour"
LOOK_MS = 1000  # windows and files tell no document observer
DONE, OPEN = "✔", "○"

_guide: Guide | None = None


class Guide(QtWidgets.QDockWidget):  # type: ignore[misc]  # Qt has no types
    """Steps of one document; it is closed with it.

    Attributes
    ----------
    steps : tuple of Step
    current : int
        Index of the first step that is not done; their number when all are.
    """

    def __init__(self, document: Any, parent: Any) -> None:
        super().__init__(parent)
        self.setObjectName(OBJECT_NAME)
        self._document = document.Name
        self.steps = available_steps()
        self.current = 0
        self._is_due = False
        self._build()
        self._retranslate()
        self._observer = _Observer(self._look_soon)
        FreeCAD.addDocumentObserver(self._observer)
        self._timer = QtCore.QTimer(self)
        self._timer.setInterval(LOOK_MS)
        self._timer.timeout.connect(self.refresh)
        self._timer.start()

    def refresh(self) -> None:
        """Look at the document: what is done, and what comes next."""
        self._is_due = False
        if self._document not in FreeCAD.listDocuments():
            self.close()
            return
        document = FreeCAD.getDocument(self._document)
        done = [step.is_done(document) for step in self.steps]
        self.current = next((row for row, is_done in enumerate(done) if not is_done), len(done))
        for row, (item, is_done) in enumerate(zip(self._items, done, strict=True)):
            item.setText(f"{DONE if is_done else OPEN}  {row + 1}. {tr(self.steps[row].title)}")
            font = item.font()
            font.setBold(row == self.current)
            item.setFont(font)
            item.setFlags(QtCore.Qt.ItemFlag.ItemIsEnabled if is_done or row == self.current else QtCore.Qt.ItemFlag.NoItemFlags)
        self._bar.setValue(sum(done))
        self._show_step(self.steps[self.current] if self.current < len(self.steps) else None)

    def closeEvent(self, event: Any) -> None:  # Qt's name
        """Stop looking at the document."""
        self._timer.stop()
        FreeCAD.removeDocumentObserver(self._observer)
        super().closeEvent(event)
        self.deleteLater()

    def changeEvent(self, event: Any) -> None:  # Qt's name
        """Follow the user's language."""
        if event.type() == QtCore.QEvent.Type.LanguageChange and hasattr(self, "_bar"):
            self._retranslate()
            self.refresh()
        super().changeEvent(event)

    def _look_soon(self, document: Any) -> None:
        """Look again once the change is over."""
        if document.Name == self._document and not self._is_due:
            self._is_due = True
            QtCore.QTimer.singleShot(0, self._look)

    def _look(self) -> None:
        if is_alive(self) and self._is_due:
            self.refresh()

    def _build(self) -> None:
        body = QtWidgets.QWidget(self)
        layout = QtWidgets.QVBoxLayout(body)
        self._intro = QtWidgets.QLabel(body)
        self._intro.setWordWrap(True)
        self._list = QtWidgets.QListWidget(body)
        self._list.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.NoSelection)
        self._list.setFocusPolicy(QtCore.Qt.FocusPolicy.NoFocus)
        self._list.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._items = [QtWidgets.QListWidgetItem(self._list) for _ in self.steps]
        self._bar = QtWidgets.QProgressBar(body)
        self._bar.setRange(0, len(self.steps))
        self._bar.setFormat("%v / %m")
        self._text = QtWidgets.QLabel(body)
        self._text.setObjectName("text")
        self._text.setWordWrap(True)
        self._text.setAlignment(QtCore.Qt.AlignmentFlag.AlignTop | QtCore.Qt.AlignmentFlag.AlignLeft)
        self._do = QtWidgets.QPushButton(body)
        self._do.setObjectName("do")
        self._do.clicked.connect(self._run_command)
        self._end = QtWidgets.QPushButton(body)
        self._end.setObjectName("end")
        self._end.clicked.connect(self.close)
        row = QtWidgets.QHBoxLayout()
        row.addWidget(self._do, 1)
        row.addWidget(self._end)
        for widget in (self._intro, self._list, self._bar, self._text):
            layout.addWidget(widget)
        layout.addLayout(row)
        layout.addStretch(1)  # the buttons stay with the text that speaks of them
        self.setWidget(body)
        self.setMinimumWidth(280)

    def _retranslate(self) -> None:
        self.setWindowTitle(tr("First steps"))
        self._intro.setText(tr("From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again."))
        self._end.setText(tr("End the tour"))
        self._end.setToolTip(tr("Close the guide; the document stays open"))

    def _show_step(self, step: Step | None) -> None:
        self._list.setFixedHeight(self._list.sizeHintForRow(0) * len(self.steps) + 2 * self._list.frameWidth() + 4)
        self._do.setVisible(step is not None)
        if step is None:
            self._text.setText(
                tr(
                    "That is all. The document's other tab shows the pipeline in 3D; the keys V and F, one after the other, fit the view. "
                    "Import photographs of your own with Import Station."
                )
            )
            return
        self._text.setText(tr(step.text))
        command = FreeCADGui.Command.get(step.command)
        info = command.getInfo()
        self._do.setEnabled(command.isActive())
        self._do.setText(translate(step.command, info["menuText"]).replace("&", ""))
        self._do.setToolTip(translate(step.command, info["toolTip"]))
        self._do.setIcon(QtGui.QIcon(info["pixmap"]))

    def _run_command(self) -> None:
        if self.current < len(self.steps):
            FreeCAD.setActiveDocument(self._document)
            FreeCADGui.runCommand(self.steps[self.current].command)


class _Observer:
    """Tells of whatever may change what is done; the names are FreeCAD's."""

    def __init__(self, tell: Callable[[Any], None]) -> None:
        self._tell = tell

    def slotCreatedObject(self, obj: Any) -> None:
        self._tell(obj.Document)

    def slotDeletedObject(self, obj: Any) -> None:
        self._tell(obj.Document)

    def slotRecomputedDocument(self, document: Any) -> None:
        self._tell(document)

    def slotUndoDocument(self, document: Any) -> None:
        self._tell(document)

    def slotRedoDocument(self, document: Any) -> None:
        self._tell(document)

    def slotDeletedDocument(self, document: Any) -> None:
        self._tell(document)


def start_guide(document: Any) -> Guide:
    """Show the guide of a document; one that is open is closed."""
    global _guide  # noqa: PLW0603  # FreeCAD has one window, and that has one guide
    if is_alive(_guide):
        _guide.close()  # type: ignore[union-attr]
    saved_files.clear()  # what was exported before does not count
    window = FreeCADGui.getMainWindow()
    _guide = Guide(document, window)
    _guide.setWindowIcon(QtGui.QIcon(str(package_folder("resources") / "icons" / "tour.svg")))
    window.addDockWidget(QtCore.Qt.DockWidgetArea.RightDockWidgetArea, _guide)
    _guide.refresh()
    _guide.show()
    return _guide
