# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole way from photographs to an adjusted pipeline, by mouse and keys alone, undone and done again at every step."""

import FreeCAD
import FreeCADGui
import pytest
from window import (
    KEY,
    LEFT,
    PATIENCE_S,
    PICKS,
    SAMPLE,
    QTest,
    choose_file,
    click_at,
    click_pipe,
    kinds_in,
    press,
    press_button,
    pump,
    screenshot,
    standard_button,
    tool_of,
    wait_until,
    when_dialog_opens,
)

from pipeworkbench.features.document import components_in, pipeline_of
from pipeworkbench.gui.compat import QtCore, QtWidgets, is_alive
from pipeworkbench.gui.panel import open_panel
from pipeworkbench.gui.photos.windows import photo_window

CONTROL = QtCore.Qt.KeyboardModifier.ControlModifier
OK = QtWidgets.QDialogButtonBox.StandardButton.Ok


class Steps:
    """What a document holds after each step of undo, to be compared on the ways back and forth."""

    def __init__(self, document):
        self.document = document
        self.pipelines = []

    @property
    def pipeline(self):
        return pipeline_of(self.document) if components_in(self.document) else None

    def done(self):
        """One more thing was done: it is one step of undo."""
        pump(50)
        self.pipelines.append(self.pipeline)
        assert self.document.UndoCount == len(self.pipelines), self.document.UndoNames

    def back(self):
        """Ctrl+Z in the photographs to the beginning; the last one takes the station and its photographs away."""
        window = photo_window()
        for expected in reversed([None, *self.pipelines[:-1]]):
            QTest.keyClick(window.canvases[0], KEY.Key_Z, CONTROL)
            assert self.pipeline == expected
        assert self.document.Objects == []
        assert self.document.UndoCount == 0
        assert wait_until(lambda: not is_alive(window))

    def forth(self):
        """FreeCAD's own Redo brings the station back, Ctrl+Y in its photographs the rest."""
        FreeCADGui.runCommand("Std_Redo")
        assert self.pipeline == self.pipelines[0]
        window = look_at_photographs()
        for expected in self.pipelines[1:]:
            QTest.keyClick(window.canvases[0], KEY.Key_Y, CONTROL)
            assert self.pipeline == expected
        assert self.document.RedoCount == 0


def look_at_photographs():
    """Open the photo window by its button and return it once it shows the photographs."""
    press("Photo Window")
    assert wait_until(lambda: photo_window() is not None and all(canvas.picture for canvas in photo_window().canvases))
    return photo_window()


def look_in_3d(document):
    """Bring the 3D view to the front, from above."""
    area = FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)
    area.setActiveSubWindow(next(window for window in area.subWindowList() if window.widget() is not photo_window()))
    view = FreeCADGui.getDocument(document.Name).mdiViewsOfType("Gui::View3DInventor")[0]
    view.viewIsometric()
    for obj in document.Objects:
        obj.ViewObject.Visibility = obj in components_in(document)
    view.fitAll()
    screenshot("way_3d")


def choose_another_type(tool):
    """Click on the first row of another type in the flange's list, and return the type."""
    measured = tool.measurement.flange.flange_type
    row = next(row for row, choice in enumerate(tool.measurement.choices) if choice.dimensions.flange_type != measured)
    tool.table.scrollToItem(tool.table.item(row, 1))
    cell = tool.table.visualItemRect(tool.table.item(row, 1))
    QTest.mouseClick(tool.table.viewport(), LEFT, QtCore.Qt.KeyboardModifier.NoModifier, cell.center())
    pump(50)
    return tool.measurement.choices[row].dimensions.flange_type


@pytest.fixture
def english():
    """FreeCAD in English afterwards, whatever happens."""
    yield
    FreeCADGui.setLocale("English")
    pump()


def test_whole_way_from_photographs_to_an_adjusted_pipeline_and_back(document, workbench, tmp_path, english):
    steps = Steps(document)
    measure(steps)
    adjust(steps)
    assert kinds_in(document) == ["elbow", "flange", "flange", "pipe", "pipe"], "the flange that faces the clicked one came along"
    look_in_3d(document)
    steps.back()
    steps.forth()
    reopened = save_and_open_again(document, tmp_path / "measured.FCStd")
    try:
        assert pipeline_of(reopened) == steps.pipelines[-1]
        speak_german_and_english_again(reopened)
    finally:
        FreeCAD.closeDocument(reopened.Name)


def measure(steps):
    """Station, two pipes, the elbow between them, a flange of another type than the proposed one."""
    opened = when_dialog_opens(QtWidgets.QFileDialog, choose_file(SAMPLE / "station.json"))
    press("Import Station")
    assert opened
    steps.done()

    tool = tool_of("Pipe")
    for number, pick in enumerate(PICKS[:2]):
        click_pipe(tool, pick)
        assert tool.measurement.answers, tool.measurement.reason
        assert all(not tool.window.layer("proposal").is_empty(camera) for camera in ("left", "right", "top"))
        assert tool.table.rowCount() == len(tool.measurement.answers)
        if number == 0:
            tool.window.fit()
            screenshot("way_pipe")
        QTest.keyClick(tool.window, KEY.Key_Return)
        steps.done()

    tool = tool_of("Elbows")
    assert wait_until(lambda: not tool._task.is_running, PATIENCE_S)
    assert len(tool.proposals.items) == 1
    tool.window.fit()
    screenshot("way_elbows")
    QTest.keyClick(tool.window, KEY.Key_Return)
    steps.done()

    tool = tool_of("Flange")
    pick = next(pick for pick in PICKS if pick["kind"] == "flange")
    click_at(tool.window, pick["camera"], pick["point"])
    assert wait_until(lambda: tool.measurement.flange is not None or tool.reason, PATIENCE_S)
    assert tool.reason == ""
    face = tool.measurement.flange.face
    changed = choose_another_type(tool)
    assert tool.measurement.flange.flange_type == changed
    tool.window.toolbar.linked.setChecked(True)
    tool.window.show_place(pick["camera"], tuple(pick["point"]), 0.4)
    screenshot("way_flange")
    tool.window.toolbar.linked.setChecked(False)
    QTest.keyClick(tool.window, KEY.Key_Return)
    steps.done()
    flanges = [component for component in steps.pipeline.components if component.kind == "flange"]
    assert (changed, pytest.approx(face, abs=1e-6)) in [(flange.flange_type, flange.face) for flange in flanges]
    press_close(tool)


def adjust(steps):
    """All components to all photographs."""
    FreeCADGui.Selection.clearSelection()
    press("Adjust")
    panel = open_panel()
    press_button(panel, "start")
    assert wait_until(panel.has_result, PATIENCE_S)
    assert steps.pipeline == steps.pipelines[-1], "nothing is changed before it is applied"
    panel.form.findChild(QtWidgets.QCheckBox, "residuals").click()
    photo_window().toolbar.linked.setChecked(True)
    photo_window().show_place("left", (600.0, 620.0), 0.5)
    screenshot("way_adjust")
    photo_window().toolbar.linked.setChecked(False)
    QTest.mouseClick(standard_button(OK), LEFT)
    assert wait_until(lambda: not panel.is_open)
    steps.done()
    assert steps.pipeline.sigma0 is not None


def press_close(tool):
    """Click FreeCAD's Close button."""
    QTest.mouseClick(standard_button(QtWidgets.QDialogButtonBox.StandardButton.Close), LEFT)
    assert wait_until(lambda: not tool.is_open)


def save_and_open_again(document, path):
    """Save with FreeCAD's dialog, close, and open the file."""
    FreeCAD.setActiveDocument(document.Name)
    opened = when_dialog_opens(QtWidgets.QFileDialog, choose_file(path))
    FreeCADGui.runCommand("Std_SaveAs")
    assert opened
    assert wait_until(path.is_file)
    FreeCAD.closeDocument(document.Name)
    return FreeCAD.openDocument(str(path))


def speak_german_and_english_again(document):
    """The menu follows at once, a panel when it is opened the next time."""
    FreeCAD.setActiveDocument(document.Name)
    for language, entry, title, start in (("German", "Ausgleichen", "Ausgleichen", "Ausgleichen"), ("English", "Adjust", "Adjust", "Adjust")):
        FreeCADGui.setLocale(language)
        pump()
        entries = {action.text().replace("&", "") for menu in FreeCADGui.getMainWindow().findChildren(QtWidgets.QMenu) for action in menu.actions()}
        assert entry in entries
        press(entry)
        panel = open_panel()
        assert panel.form.windowTitle() == title
        assert panel.form.findChild(QtWidgets.QPushButton, "start").text() == start
        panel.close()
        pump()
