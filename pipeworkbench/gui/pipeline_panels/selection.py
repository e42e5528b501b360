# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's selection, as the panels use it: which components are selected, selecting them by id, hearing of changes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCADGui

from pipeworkbench.features.document import components_in


def selected_objects(document: Any) -> list[Any]:
    """Return the selected objects of a document."""
    return list(FreeCADGui.Selection.getSelection(document.Name))


def selected_components(document: Any) -> list[Any]:
    """Return the selected components of a document."""
    components = components_in(document)
    return [obj for obj in selected_objects(document) if obj in components]


def select_components(document: Any, ids: Iterable[str]) -> None:
    """Select components by their ids, and nothing else."""
    wanted = set(ids)
    FreeCADGui.Selection.clearSelection(document.Name)
    for obj in components_in(document):
        if obj.ComponentId in wanted:
            FreeCADGui.Selection.addSelection(obj)


class SelectionObserver:
    """Calls a function whenever the selection changes, until it is ended; the methods' names are FreeCAD's."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        FreeCADGui.Selection.addObserver(self)

    def end(self) -> None:
        """Hear no more."""
        FreeCADGui.Selection.removeObserver(self)

    def addSelection(self, *_: Any) -> None:
        """Something was selected."""
        self._changed()

    def removeSelection(self, *_: Any) -> None:
        """Something is no longer selected."""
        self._changed()

    def setSelection(self, *_: Any) -> None:
        """Something else is selected."""
        self._changed()

    def clearSelection(self, *_: Any) -> None:
        """Nothing is selected."""
        self._changed()
