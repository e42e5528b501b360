# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt as FreeCAD ships it: in 0.20 the widgets are in PySide.QtGui, later in PySide.QtWidgets."""

from PySide import QtCore, QtGui

try:
    from PySide import QtWidgets
except ImportError:  # FreeCAD 0.20
    QtWidgets = QtGui

__all__ = ["QtCore", "QtGui", "QtWidgets"]
