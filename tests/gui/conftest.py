# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests in FreeCAD's window share: waiting, clicking, answering dialogs, pictures of the screen."""

import sys
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import pytest

sys.path.insert(0, str(Path(__file__).parent))

from window import DEADLINE_S, open_dialog, pump, wait_until

from pipeworkbench.gui.compat import QtCore, QtWidgets

UNANSWERED_S = DEADLINE_S + 5.0  # longer than any test waits for a dialog


@pytest.fixture(autouse=True)
def no_dialog_hangs():
    """A message that nobody answers is closed after a while, and fails the test instead of stopping all of them."""
    unanswered, shown, since = [], None, 0.0

    def look():
        nonlocal shown, since
        box = open_dialog(QtWidgets.QMessageBox)
        if box is not shown:
            shown, since = box, time.monotonic()
        elif box is not None and time.monotonic() - since > UNANSWERED_S:
            unanswered.append(box.text())
            box.reject()

    timer = QtCore.QTimer()
    timer.timeout.connect(look)
    timer.start(500)
    yield
    timer.stop()
    assert not unanswered


@pytest.fixture
def document():
    """A new document that can be undone; afterwards it is closed, and so is whatever task panel or dialog a failed test left open."""
    made = FreeCAD.newDocument("gui")
    made.UndoMode = 1
    name = made.Name
    yield made
    FreeCADGui.Control.closeDialog()
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    pump(20)


@pytest.fixture
def closed_panels():
    """No test leaves a panel to the next one."""
    from pipeworkbench.gui.panel import open_panel

    yield
    if open_panel() is not None:
        open_panel().close()
    pump(20)


@pytest.fixture
def workbench():
    """The Pipe Workbench, active."""
    FreeCADGui.activateWorkbench("PipeWorkbench")
    assert wait_until(lambda: FreeCADGui.activeWorkbench().name() == "PipeWorkbench")
    return FreeCADGui.activeWorkbench()
