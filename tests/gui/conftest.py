# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests in FreeCAD's window share: waiting, clicking, answering dialogs, pictures of the screen."""

import sys
from pathlib import Path

import FreeCAD
import FreeCADGui
import pytest

sys.path.insert(0, str(Path(__file__).parent))

from window import pump, wait_until


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
def workbench():
    """The Pipe Workbench, active."""
    FreeCADGui.activateWorkbench("PipeWorkbench")
    assert wait_until(lambda: FreeCADGui.activeWorkbench().name() == "PipeWorkbench")
    return FreeCADGui.activeWorkbench()
