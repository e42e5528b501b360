# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long work in a thread of its own, with progress and a Cancel button; FreeCAD's window goes on drawing meanwhile."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, TypeVar

import FreeCAD
import FreeCADGui

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.gui.compat import QtCore, QtWidgets, execute, is_alive
from pipeworkbench.gui.jobs import Job, Progress
from pipeworkbench.gui.translation import tr

T = TypeVar("T")

POLL_MS = 30
PATIENCE_MS = 300  # work that is shorter shows no dialog
LAST_WORDS_S = 5.0  # how long FreeCAD's end waits for the work to notice that it was cancelled

_running: list[Job[Any]] = []


class ProgressDialog(QtWidgets.QDialog):  # type: ignore[misc]  # Qt has no types
    """Says what is being done and how far it is; Cancel, Esc and closing it cancel the job. It is closed by the job's end alone."""

    def __init__(self, title: str, job: Job[Any], parent: Any) -> None:
        super().__init__(parent)
        self._job = job
        self.setObjectName("PipeWorkbenchProgress")
        self.setWindowTitle(title)
        self.setWindowModality(QtCore.Qt.WindowModality.ApplicationModal)
        self.setMinimumWidth(420)
        self._label = QtWidgets.QLabel(title, self)
        self._bar = QtWidgets.QProgressBar(self)
        self._button = QtWidgets.QPushButton(tr("Cancel"), self)
        self._button.clicked.connect(self.reject)
        row = QtWidgets.QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self._button)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self._label)
        layout.addWidget(self._bar)
        layout.addLayout(row)

    def refresh(self) -> None:
        """Show the job's state."""
        text, done, total = self._job.state
        self._bar.setRange(0, total)
        self._bar.setValue(min(done, total))
        if self._job.cancelled:
            self._label.setText(tr("Cancelling: waiting for the end of this step ..."))
            self._button.setEnabled(False)
        elif text:
            self._label.setText(text[:1].upper() + text[1:])

    def reject(self) -> None:
        """Cancel the job (Qt's name)."""
        self._job.cancel()
        self.refresh()

    def closeEvent(self, event: Any) -> None:  # Qt's name
        """Cancel the job, and wait for it."""
        if not self._job.finished:
            event.ignore()
            self.reject()


class _Watch:
    """Ends an event loop when the job is finished; shows the dialog when it takes long; cancels the job when its document is closed."""

    def __init__(self, title: str, job: Job[Any], document: Any, *, leave: bool) -> None:
        self._title, self._job, self._leave = title, job, leave
        self._document = None if document is None else document.Name
        self._began = time.monotonic()
        self._dialog: ProgressDialog | None = None
        self.loop = QtCore.QEventLoop()
        self._timer = QtCore.QTimer()
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self._look)

    def run(self) -> None:
        """Let the window live until the job is finished, or FreeCAD ends."""
        self._timer.start()
        FreeCAD.addDocumentObserver(self)
        # until the dialog takes the input, clicks wait: they must not start anything beside the job
        QtWidgets.QApplication.setOverrideCursor(QtCore.Qt.CursorShape.WaitCursor)
        try:
            execute(self.loop, QtCore.QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)
            QtWidgets.QApplication.restoreOverrideCursor()
            if not self._is_over():
                self._show()
                execute(self.loop)
        finally:
            self._timer.stop()
            FreeCAD.removeDocumentObserver(self)
            if is_alive(self._dialog):
                self._dialog.hide()  # type: ignore[union-attr]
                self._dialog.deleteLater()  # type: ignore[union-attr]

    def slotDeletedDocument(self, document: Any) -> None:  # FreeCAD's name
        """Cancel the job whose document is closed."""
        if document.Name == self._document:
            self._job.cancel()

    def _is_over(self) -> bool:
        return self._job.finished or (self._leave and self._job.cancelled)

    def _look(self) -> None:
        if self._is_over():
            self.loop.quit()
        elif self._dialog is None:
            if time.monotonic() - self._began > PATIENCE_MS / 1000:
                self.loop.quit()
        elif is_alive(self._dialog):
            self._dialog.refresh()

    def _show(self) -> None:
        self._dialog = ProgressDialog(self._title, self._job, FreeCADGui.getMainWindow())
        self._dialog.refresh()
        self._dialog.show()


def is_busy() -> bool:
    """Tell whether long work is running: commands are off meanwhile."""
    return bool(_running)


def run_long(title: str, function: Callable[[Progress], T], document: Any = None, *, leave: bool = False) -> T:
    """Run a function in a thread and return what it returns; the window goes on drawing, and nothing else can be started.

    Parameters
    ----------
    title : str
        Title of the dialog, which appears when the work takes longer than 0.3 s.
    function : callable
        Gets ``progress(text, done, total)``; ``total`` 0 means that nobody knows. It must touch neither a document nor Qt.
    document : FreeCAD document, optional
        What the result is meant for (default: the active document): closing it cancels the work.
    leave : bool
        Whether Cancel comes back at once and leaves the function to itself until its next call of progress ends it: right for what only
        computes. Without it Cancel waits for that call, so that nothing that writes is at work any more.

    Raises
    ------
    Cancelled
        Where the user pressed Cancel, or closed the document or FreeCAD.
    PipeWorkbenchError
        Where other long work is running.
    BaseException
        Whatever the function raised.
    """
    if is_busy():
        raise PipeWorkbenchError(tr("Something else is still being computed; wait for its end or cancel it"))
    job = Job(function)
    _running.append(job)
    try:
        _Watch(title, job, document or FreeCAD.ActiveDocument, leave=leave).run()
        if not (job.finished or (leave and job.cancelled)):  # FreeCAD ends: its loops are over
            job.cancel()
            job.wait(LAST_WORDS_S)
        return job.result()
    finally:
        _running.remove(job)
