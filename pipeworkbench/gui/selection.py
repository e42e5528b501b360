# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's selection, as the window uses it: which components are selected, selecting them by id, hearing of changes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCADGui

from pipeworkbench.features.document import components_in
from pipeworkbench.features.kinds import is_component


def selected_objects(document: Any) -> list[Any]:
    """Return the selected objects of a document."""
    return list(FreeCADGui.Selection.getSelection(document.Name))


def selected_components(document: Any) -> list[Any]:
    """Return the selected components of a document."""
    return [obj for obj in selected_objects(document) if is_component(obj)]


def select_components(document: Any, ids: Iterable[str]) -> None:
    """Select components by their ids, and nothing else."""
    wanted = set(ids)
    FreeCADGui.Selection.clearSelection(document.Name)
    for obj in components_in(document):
        if obj.ComponentId in wanted:
            FreeCADGui.Selection.addSelection(obj)


class SelectionObserver:
    """Calls a function whenever the selection of a document changes, until it is stopped; the methods' names are FreeCAD's."""

    def __init__(self, document: Any, changed: Callable[[], None]) -> None:
        self._document = document.Name
        self._changed = changed
        FreeCADGui.Selection.addObserver(self)

    def stop(self) -> None:
        """Hear no more."""
        FreeCADGui.Selection.removeObserver(self)

    def addSelection(self, document: str, *_: Any) -> None:  # FreeCAD's name
        """Something was selected."""
        if document == self._document:
            self._changed()

    removeSelection = addSelection  # noqa: N815  # FreeCAD's name

    def setSelection(self, *_: Any) -> None:  # FreeCAD's name
        """Something else is selected, or nothing: FreeCAD does not always say where."""
        self._changed()

    clearSelection = setSelection  # noqa: N815  # FreeCAD's name
