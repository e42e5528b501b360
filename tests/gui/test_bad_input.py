# SPDX-License-Identifier: LGPL-2.1-or-later
"""What goes wrong in practice, in FreeCAD's window: it is said, nothing is lost, and the window goes on."""

import shutil
import sys

import FreeCAD
import FreeCADGui
import pytest
from window import (
    KEY,
    LEFT,
    PICKS,
    ROOT,
    SAMPLE,
    QTest,
    answer_message,
    click_at,
    edge_points,
    import_sample,
    log_text,
    press,
    press_button,
    pump,
    standard_button,
    tool_of,
    wait_until,
    when_dialog_opens,
)

from pipeworkbench.commands import GROUPS
from pipeworkbench.commands.import_station import import_station
from pipeworkbench.environment import PACKAGES
from pipeworkbench.features.document import add_pipeline, components_in, pipeline_of
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, is_alive
from pipeworkbench.gui.panel import open_panel
from pipeworkbench.gui.photos.windows import photo_window
from pipeworkbench.pipeline import Pipe, Pipeline

pytestmark = pytest.mark.usefixtures("closed_panels")

CONTROL = QtCore.Qt.KeyboardModifier.ControlModifier
EVERYTHING = ROOT / "tests" / "data" / "one_of_everything.json"
PIPE = Pipe(id="P1", start=(0.0, 4000.0, 0.0), end=(0.0, 4000.0, 500.0), outer_diameter=48.3, wall_thickness=2.6, dn=40, station="A")


def message_of(panel):
    """Return what a panel says at its foot."""
    return panel.form.findChild(QtWidgets.QLabel, "message").text()


def write(panel, path):
    """Let the export panel write a file."""
    pump()
    panel.form.findChild(QtWidgets.QLineEdit, "path").setText(str(path))
    QTest.mouseClick(standard_button(QtWidgets.QDialogButtonBox.StandardButton.Ok), LEFT)
    pump()


def said_by(command):
    """Press a command's button and return what the message box says that it answers with."""
    said = []
    opened = when_dialog_opens(QtWidgets.QMessageBox, answer_message(said))
    press(command)
    pump(50)
    assert opened, command
    return said[0]


# a document of a newer version


@pytest.fixture
def newer(document, tmp_path, workbench):
    """A station and one of everything, two of them saved by a newer version, opened again."""
    import_sample(document)
    objects = add_pipeline(document, Pipeline.read(EVERYTHING))
    document.recompute()
    for obj in objects[:2]:
        obj.SchemaVersion = 99
    path = tmp_path / "newer.FCStd"
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    opened = FreeCAD.openDocument(str(path))
    pump(200)
    yield opened
    FreeCAD.closeDocument(opened.Name)


def test_document_of_a_newer_version_is_shown_and_says_so(newer):
    assert "newer version" in log_text()
    for obj in components_in(newer):
        assert obj.ViewObject.Visibility
        assert QtGui.QIcon(obj.ViewObject.Proxy.getIcon()).pixmap(32, 32).toImage().pixelColor(16, 16).alpha() > 0
        FreeCADGui.Selection.addSelection(obj)
    pump(50)
    FreeCADGui.Selection.clearSelection()


@pytest.mark.parametrize("command", ["Adjust", "Export"])
def test_commands_refuse_what_a_newer_version_made_and_change_nothing(newer, command, tmp_path):
    before = newer.UndoCount
    press(command)
    panel = open_panel()
    if command == "Adjust":
        pump()
        press_button(panel, "start")
    else:
        write(panel, tmp_path / "out.json")
    assert "update the Pipe Workbench" in message_of(panel)
    assert newer.UndoCount == before
    assert not (tmp_path / "out.json").exists()


# stations and photographs that went away


def test_components_of_a_deleted_station_are_not_adjusted_but_reported(document, workbench, tmp_path):
    station = import_sample(document)
    add_pipeline(document, Pipeline.of_station("A", (PIPE,)))
    before = pipeline_of(document)
    document.openTransaction("Delete")
    document.removeObject(station.Name)
    document.commitTransaction()
    pump(50)
    assert not FreeCADGui.Command.get("PipeWB_Adjust").isActive()
    press("Report")
    panel = open_panel()
    panel.form.findChild(QtWidgets.QCheckBox, "opened").setChecked(False)
    write(panel, tmp_path / "report.html")
    assert wait_until(lambda: (tmp_path / "report.html").is_file())
    document.undo()
    assert wait_until(lambda: document.getObject(station.Name) is not None)
    assert pipeline_of(document) == before


def test_tools_ask_for_photographs_that_were_moved(document, workbench, tmp_path):
    shutil.copytree(SAMPLE, tmp_path / "there")
    import_station(tmp_path / "there" / "station.json", document)
    add_pipeline(document, Pipeline.of_station("A", (PIPE,)))
    (tmp_path / "there" / "left.jpg").rename(tmp_path / "left.jpg")
    for command in ("Pipe", "Flange"):
        assert "photographs are missing" in said_by(command)
        assert open_panel() is None
        assert photo_window().is_missing, "the window asks where they are"


# undo and closing while something is measured


def test_undoing_the_import_while_a_pipe_is_measured_ends_the_tool(document, workbench):
    import_sample(document)
    tool = tool_of("Pipe")
    window = tool.window
    for point in edge_points(PICKS[0])[:2]:
        click_at(window, "left", point)
    assert tool.measurement.is_measuring
    QTest.keyClick(window.canvases[0], KEY.Key_Z, CONTROL)
    assert wait_until(lambda: open_panel() is None and not is_alive(window))
    assert document.Objects == []
    document.redo()
    pump(100)
    assert [obj.Label for obj in document.Objects] == ["Project", "Station A"]


def test_closing_the_document_while_a_pipe_is_measured_ends_the_tool(workbench):
    made = FreeCAD.newDocument("closing")
    import_sample(made)
    tool = tool_of("Pipe")
    window = tool.window
    for point in edge_points(PICKS[0])[:2]:
        click_at(window, "left", point)
    assert tool.measurement.is_measuring
    FreeCAD.closeDocument(made.Name)
    assert wait_until(lambda: open_panel() is None and not is_alive(window))
    assert not FreeCADGui.Control.activeDialog()


def test_undoing_an_accepted_pipe_takes_its_elbow_proposal_and_flange_away(document, workbench):
    import_sample(document)
    document.openTransaction("Pipe")
    add_pipeline(document, Pipeline.of_station("A", (PIPE,)))
    document.recompute()
    document.commitTransaction()
    tool = tool_of("Flange")
    pick = next(pick for pick in PICKS if pick["kind"] == "flange")
    click_at(tool.window, pick["camera"], pick["point"])
    document.undo()
    assert wait_until(lambda: not tool._task.is_running)
    QTest.keyClick(tool.window, KEY.Key_Return)
    pump(50)
    assert components_in(document) == []
    assert tool.is_open
    tool.close()


# packages that are not installed


@pytest.mark.parametrize("module", ["cv2", "cadquery", "ifcopenshell"])
def test_every_command_that_needs_a_package_says_how_to_install_it(document, workbench, monkeypatch, module):
    import_sample(document)
    add_pipeline(document, Pipeline.of_station("A", (PIPE,)))
    document.recompute()
    commands = [command for group in GROUPS for command in group.commands if module in command.needs]
    before = len(document.Objects)
    monkeypatch.setitem(sys.modules, module, None)
    for command in commands:
        said = said_by(command.menu_text)
        assert PACKAGES[module] in said, command.menu_text
        assert "pip install" in said
        assert open_panel() is None
    assert len(document.Objects) == before
    if module == "cv2":
        assert len(commands) >= 8, "all that looks at photographs"
