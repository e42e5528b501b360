# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a photo window hears of FreeCAD: changes of its document, many of them at once as one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import FreeCAD

from pipeworkbench.gui.compat import QtCore

QUIET_MS = 40  # after the last change, until the contours follow


class Listener(Protocol):
    """What is told of the document."""

    def object_changed(self, name: str) -> None:
        """Take note that an object was made or has another shape, place or visibility."""

    def object_deleted(self, name: str) -> None:
        """Take note that an object is about to be deleted."""

    def document_closed(self) -> None:
        """Take note that the document is about to be closed."""


class DocumentObserver:
    """Follows one document; FreeCAD calls the methods by their names, whatever the document."""

    def __init__(self, document: Any, listener: Listener) -> None:
        self._document = document.Name
        self._listener = listener
        FreeCAD.addDocumentObserver(self)

    def stop(self) -> None:
        """Hear nothing any more."""
        FreeCAD.removeDocumentObserver(self)

    def slotCreatedObject(self, obj: Any) -> None:  # FreeCAD's name
        """Tell of a new object: of those that undo brings back as well."""
        if obj.Document.Name == self._document:
            self._listener.object_changed(obj.Name)

    def slotChangedObject(self, obj: Any, prop: str) -> None:  # noqa: ARG002  # FreeCAD's name
        """Tell of a changed object; what its contour depends on is for the listener to find out."""
        document = obj.Document  # None for an object that is being deleted
        if document is not None and document.Name == self._document:
            self._listener.object_changed(obj.Name)

    def slotDeletedObject(self, obj: Any) -> None:  # FreeCAD's name
        """Tell of an object that goes."""
        if obj.Document.Name == self._document:
            self._listener.object_deleted(obj.Name)

    def slotDeletedDocument(self, document: Any) -> None:  # FreeCAD's name
        """Tell that the document goes."""
        if document.Name == self._document:
            self._listener.document_closed()


class Coalesced:
    """Calls a function once after many requests, when it has become quiet."""

    def __init__(self, owner: QtCore.QObject, function: Callable[[], None], milliseconds: int = QUIET_MS) -> None:
        self._timer = QtCore.QTimer(owner)
        self._timer.setSingleShot(True)
        self._timer.setInterval(milliseconds)
        self._timer.timeout.connect(function)

    def request(self) -> None:
        """Call the function soon; a request does not put off an earlier one, so that it comes while changes go on."""
        if not self._timer.isActive():
            self._timer.start()

    def stop(self) -> None:
        """Call it no more."""
        self._timer.stop()
