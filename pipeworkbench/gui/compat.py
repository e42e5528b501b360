# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt as the running FreeCAD ships it: PySide2 up to 1.0, PySide6 from 1.1 on; the one place that knows the differences.

FreeCAD's ``PySide`` package stands for either; in 0.20 it has the widgets in ``PySide.QtGui`` and no ``QtWidgets``.
Write enums in full (``QtCore.Qt.MouseButton.LeftButton``): both know them so.
"""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

try:
    from PySide import QtWidgets
except ImportError:  # FreeCAD 0.20
    QtWidgets = QtGui

Signal = QtCore.Signal
# Qt 6 moved it from the widgets to QtGui
QAction = getattr(QtGui, "QAction", None) or QtWidgets.QAction

__all__ = [
    "QAction",
    "QtCore",
    "QtGui",
    "QtWidgets",
    "Signal",
    "device_pixel_ratio",
    "event_position",
    "execute",
    "is_alive",
    "qt_module",
    "qt_version",
    "text_width",
]


def qt_version() -> tuple[int, ...]:
    """Return Qt's version at run time, such as ``(5, 15, 8)``."""
    return tuple(int(part) for part in QtCore.qVersion().split("."))


def qt_module(name: str) -> Any:
    """Return a Qt module that FreeCAD's ``PySide`` does not always have, such as ``QtSvg`` or ``QtTest``.

    Raises
    ------
    ImportError
        Where the binding that FreeCAD runs with has no such module.
    """
    import importlib

    # the binding is the package that the classes come from, whatever stands in front of it
    binding = QtCore.QObject.__module__.split(".")[0]
    return importlib.import_module(f"{binding}.{name}")


def execute(runnable: Any, *arguments: Any) -> Any:
    """Run a dialog, menu, drag or event loop and return what it returns; ``exec_`` of PySide2 is ``exec`` now."""
    run = getattr(runnable, "exec_" if qt_version() < (6,) else "exec", None) or runnable.exec
    return run(*arguments)


def event_position(event: Any) -> QtCore.QPointF:
    """Return where a mouse or wheel event happened, in the widget's coordinates."""
    if hasattr(event, "position"):
        return event.position()
    # PySide2's mouse events
    return event.localPos() if hasattr(event, "localPos") else event.posF()


def device_pixel_ratio(widget: Any) -> float:
    """Return how many pixels of the screen make one of the widget's."""
    return float(widget.devicePixelRatioF())


def text_width(metrics: Any, text: str) -> int:
    """Return the width of a text in pixels (``QFontMetrics``)."""
    return int(metrics.horizontalAdvance(text) if hasattr(metrics, "horizontalAdvance") else metrics.width(text))


def is_alive(obj: Any) -> bool:
    """Tell whether Qt still has an object: a window that was closed leaves an empty shell in Python."""
    if obj is None:
        return False
    try:
        obj.objectName()
    except RuntimeError:  # libshiboken: Internal C++ object already deleted
        return False
    return True
