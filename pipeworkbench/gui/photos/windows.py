# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo windows that are open: one per station, each in a sub window of FreeCAD's, the last used one known."""

from __future__ import annotations

from functools import partial
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.photos.window import PhotoWindow

_open: list[PhotoWindow] = []  # the last used one last


def open_photo_window(station_object: Any) -> PhotoWindow:
    """Return the station's photo window, raised; it is made where there is none."""
    key = station_object.Document.Name, station_object.Name
    window = next((window for window in _open if window.key == key), None)
    if window is None:
        window = PhotoWindow(station_object)
        sub_window = mdi_area().addSubWindow(window)
        sub_window.setAttribute(QtCore.Qt.WidgetAttribute.WA_DeleteOnClose)
        sub_window.setWindowIcon(window.windowIcon())
        sub_window.aboutToActivate.connect(partial(_used, window))
        window.closed.connect(partial(_forget, window))
        _open.append(window)
        sub_window.showMaximized()
    window.parent().show()
    mdi_area().setActiveSubWindow(window.parent())
    window.setFocus()
    _used(window)
    return window


def photo_window() -> PhotoWindow | None:
    """Return the photo window that was used last, None where none is open."""
    return _open[-1] if _open else None


def photo_window_in_front(document: Any) -> PhotoWindow | None:
    """Return the photo window that the user looks at, None where that is something else or another document's."""
    window = photo_window()
    is_in_front = window is not None and mdi_area().activeSubWindow() is window.parent() and window.document_name == document.Name
    return window if is_in_front else None


def mdi_area() -> Any:
    """Return the part of FreeCAD's window in which 3D views and photo windows are."""
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)


def _forget(window: PhotoWindow) -> None:
    if window in _open:
        _open.remove(window)


def _used(window: PhotoWindow) -> None:
    """Remember that a window was used; its document becomes the active one, so that commands work on it."""
    if window.is_closed or window not in _open:
        return
    _open.remove(window)
    _open.append(window)
    if FreeCAD.ActiveDocument is None or FreeCAD.ActiveDocument.Name != window.document_name:
        FreeCAD.setActiveDocument(window.document_name)
