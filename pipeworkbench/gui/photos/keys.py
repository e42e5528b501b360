# SPDX-License-Identifier: LGPL-2.1-or-later
"""What keys mean in a photo window."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import FreeCAD

from pipeworkbench.gui.compat import QtCore

if TYPE_CHECKING:
    from pipeworkbench.gui.photos.window import PhotoWindow

Qt = QtCore.Qt
Meaning = Callable[[], object]


def meaning_of(event: Any, window: PhotoWindow) -> Meaning | None:
    """Return what a key does in a window, None where it means nothing."""
    if window.is_closed:
        return None
    modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    text = event.text()
    if modifiers == Qt.KeyboardModifier.NoModifier and text.isdigit() and text != "0":
        return lambda: window.digit_pressed.emit(int(text))
    return _meanings(modifiers, window).get(event.key())


def _meanings(modifiers: Any, window: PhotoWindow) -> dict[Any, Meaning]:
    """Return what keys do together with modifiers."""
    control, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier

    def undo() -> None:
        FreeCAD.getDocument(window.document_name).undo()

    def redo() -> None:
        FreeCAD.getDocument(window.document_name).redo()

    if modifiers == Qt.KeyboardModifier.NoModifier:
        return {
            Qt.Key.Key_Return: window.accepted.emit,
            Qt.Key.Key_Enter: window.accepted.emit,
            Qt.Key.Key_Escape: window.step_back,
            Qt.Key.Key_F: window.fit,
            Qt.Key.Key_L: window.toolbar.loupe.toggle,
            Qt.Key.Key_Space: lambda: window.pan_with_left(pans=True),
        }
    if modifiers == control:
        return {Qt.Key.Key_1: window.one_to_one, Qt.Key.Key_Z: undo, Qt.Key.Key_Y: redo}
    return {Qt.Key.Key_Z: redo} if modifiers == control | shift else {}
