# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tests inside FreeCAD share."""

import FreeCAD
import pytest


@pytest.fixture
def document():
    """A new document that can be undone; afterwards all are closed."""
    made = FreeCAD.newDocument("test")
    made.UndoMode = 1
    yield made
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
