# SPDX-License-Identifier: LGPL-2.1-or-later
"""Helpers of the tests in FreeCAD's window: waiting with a deadline, toolbar buttons, dialogs, pictures of the screen."""

import json
import os
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import numpy as np

import pipeworkbench
from pipeworkbench.gui.compat import QtCore, QtWidgets, is_alive, qt_module

QTest = qt_module("QtTest").QTest
LEFT = QtCore.Qt.MouseButton.LeftButton
ROOT = Path(pipeworkbench.__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "dummy" / "A"
PICKS = json.loads((SAMPLE / "picks.json").read_text(encoding="utf-8"))["picks"]
KEY = QtCore.Qt.Key
NO_KEY = QtCore.Qt.KeyboardModifier.NoModifier
SCREENSHOTS = os.environ.get("PIPEWORKBENCH_SCREENSHOTS")
DEADLINE_S = 20.0
PATIENCE_S = 60.0  # an answer takes two seconds where nothing else is computed


def pump(milliseconds=100):
    """Let the window live for a while."""
    end = time.monotonic() + milliseconds / 1000
    while time.monotonic() < end:
        QtWidgets.QApplication.processEvents()
        time.sleep(0.005)


def wait_until(condition, seconds=DEADLINE_S):
    """Let the window live until a condition holds; tell whether it came to hold in time."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        pump(10)
    return True


def later(action, milliseconds=50):
    """Do something once the window has gone on, for what runs an event loop of its own."""
    QtCore.QTimer.singleShot(milliseconds, action)


def screenshot(name):
    """Save a picture of the screen where PIPEWORKBENCH_SCREENSHOTS names a folder."""
    if SCREENSHOTS:
        pump(300)
        for dock in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDockWidget):
            if dock.objectName() in ("Tree view", "Property view", "Selection view", "Python console", "DAG View", "Report view"):
                dock.setVisible(False)
        pump(500)
        # the screen, not the window: a grab of the window leaves the 3D view out
        QtWidgets.QApplication.primaryScreen().grabWindow(0).save(str(Path(SCREENSHOTS) / f"{name}.png"))


def toolbars():
    """Return the workbench's toolbars, shown."""
    FreeCADGui.activateWorkbench("PipeWorkbench")
    pump()
    names = FreeCADGui.activeWorkbench().listToolbars()
    bars = [bar for bar in FreeCADGui.getMainWindow().findChildren(QtWidgets.QToolBar) if bar.objectName() in names]
    for bar in bars:
        bar.show()
    return bars


def button(text):
    """Return the toolbar button of a command, by its English or translated text."""
    actions = [(bar, action) for bar in toolbars() for action in bar.actions()]
    return next(bar.widgetForAction(action) for bar, action in actions if action.text().replace("&", "") == text)


def press(text):
    """Click a command's toolbar button, once FreeCAD has switched it on."""
    widget = button(text)
    assert wait_until(widget.isEnabled), f"'{text}' stays off"
    QTest.mouseClick(widget, LEFT)


def open_dialog(kind):
    """Return the modal dialog in front where it is of this kind, else None; PySide cannot list all windows safely while some are going."""
    dialog = QtWidgets.QApplication.activeModalWidget()
    return dialog if isinstance(dialog, kind) and dialog.isVisible() else None


def when_dialog_opens(kind, act, tries=200):
    """Once a dialog of this kind is open, act on it; a dialog that never comes fails the test by leaving act undone."""
    done = []

    def look(left=tries):
        dialog = open_dialog(kind)
        if dialog is not None:
            done.append(True)
            act(dialog)
        elif left:
            later(lambda: look(left - 1))

    later(look)
    return done


def choose_file(path):
    """Return what types a path into a file dialog and accepts it."""

    def act(dialog):
        dialog.findChild(QtWidgets.QLineEdit).setText(str(path))
        dialog.accept()

    return act


def answer_message(said):
    """Return what reads a message box into a list and accepts it."""

    def act(dialog):
        said.append(dialog.text())
        dialog.accept()

    return act


def log_text():
    """Return what the report view shows."""
    view = FreeCADGui.getMainWindow().findChild(QtWidgets.QTextEdit, "Report view")
    return view.toPlainText() if view else ""


def import_sample(document):
    """Add the sample station to a document and return the object."""
    from pipeworkbench.commands.import_station import import_station

    FreeCAD.setActiveDocument(document.Name)
    return import_station(SAMPLE / "station.json", document)


def tool_of(command):
    """Press a command's button and return its tool once its photographs can be measured in."""
    from pipeworkbench.gui.panel import open_panel

    press(command)
    tool = open_panel()
    assert tool is not None
    assert wait_until(lambda: tool.window.views is not None, PATIENCE_S)
    return tool


def click_at(window, camera, point, scale=1.0):
    """Click on a pixel of a photograph."""
    canvas = window.canvas(camera)
    window.show_place(camera, (float(point[0]), float(point[1])), scale)
    pump(30)
    place = canvas.screen_at((float(point[0]), float(point[1]))).toPoint()
    QTest.mouseMove(canvas, place)
    pump(30)
    QTest.mouseClick(canvas, LEFT, NO_KEY, place)
    pump(30)


def edge_points(pick):
    """Return a place on each of a pick's edges, and one in the middle between them."""
    edges = np.mean(pick["edges"], axis=1)
    return edges[0], edges[1], edges.mean(axis=0)


def click_pipe(tool, pick):
    """Click on both edges of a pipe and wait for the answer."""
    one, other, _ = edge_points(pick)
    click_at(tool.window, pick["camera"], one)
    click_at(tool.window, pick["camera"], other)
    assert wait_until(lambda: not tool.measurement.is_measuring, PATIENCE_S)


def kinds_in(document):
    """Return the kinds of a document's components, sorted."""
    from pipeworkbench.features.document import components_in

    return sorted(obj.Proxy.kind.kind for obj in components_in(document))


def press_button(tool, name):
    """Click a button of a panel by its object's name."""
    QTest.mouseClick(tool.form.findChild(QtWidgets.QPushButton, name), LEFT)
    pump(100)


def standard_button(button):
    """Return the visible OK, Apply, Cancel ... of FreeCAD's task panel."""
    boxes = [box for box in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialogButtonBox) if is_alive(box) and box.isVisible()]
    return next(found for found in (box.button(button) for box in reversed(boxes)) if found is not None)
