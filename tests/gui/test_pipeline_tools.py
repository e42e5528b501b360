# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adjusting, merging, comparing, exporting in FreeCAD's real window: buttons, tables, undo, closing at any time."""

import csv
import itertools
import math
from dataclasses import replace

import FreeCAD
import FreeCADGui
import pytest
from window import LEFT, SAMPLE, QTest, choose_file, press, pump, screenshot, standard_button, wait_until, when_dialog_opens

from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import add_pipeline, add_station, components_in, pipeline_of
from pipeworkbench.gui.compat import QtCore, QtWidgets, is_alive
from pipeworkbench.gui.dialogs import saved_files
from pipeworkbench.gui.panel import Panel, open_panel
from pipeworkbench.pipeline import Pipe, Pipeline, moved
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.reconstruct import reconstruct
from pipeworkbench.recon.station import read_station

pytestmark = pytest.mark.usefixtures("closed_panels")

BUTTONS = QtWidgets.QDialogButtonBox.StandardButton
KEYS = QtCore.Qt.Key


@pytest.fixture(scope="module")
def recognised():
    """Two pipes of the sample and the elbow between them, as recognised, not adjusted."""
    station = read_station(SAMPLE)
    picks = read_picks(SAMPLE / "picks.json", station)
    return reconstruct(station, replace(picks, pipes=picks.pipes[:2], flanges=()), adjustment=None).pipeline


def fill(document, *pipelines):
    from pipeworkbench.gui.view_providers import show

    document.openTransaction("Measure")
    for pipeline in pipelines:
        add_pipeline(document, pipeline)
    document.recompute()
    for obj in document.Objects:
        show(obj)
    document.commitTransaction()
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")


@pytest.fixture
def measured(document, workbench, recognised):
    """The document with the sample station and what was recognised in it."""
    add_station(document, read_station(SAMPLE))
    fill(document, recognised)
    return document


def geometry(document):
    return {obj.ComponentId: [port.point for port in component_of(obj).ports] for obj in components_in(document)}


def child(kind, name):
    found = [widget for widget in open_panel().form.findChildren(kind, name) if is_alive(widget)]
    assert found, name
    return found[0]


def click(name):
    widget = child(QtWidgets.QPushButton, name)
    QTest.mouseClick(widget, LEFT)


def overlays():
    """Return what panels have put into the 3D view."""
    graph = FreeCADGui.ActiveDocument.mdiViewsOfType("Gui::View3DInventor")[0].getSceneGraph()
    return [node for node in (graph.getChild(row) for row in range(graph.getNumChildren())) if node.getName() == "PipeWorkbenchOverlay"]


def assert_numbers_are_whole(table, width=350):
    """Check that all columns of a table are in sight in a narrow side panel, and that none but names are cut."""
    table.setFixedWidth(width)
    pump(50)
    assert table.horizontalHeader().length() <= table.viewport().width()
    for column in range(table.columnCount()):
        if table.item(0, column).textAlignment() & QtCore.Qt.AlignmentFlag.AlignRight:
            assert table.columnWidth(column) >= table.sizeHintForColumn(column)
        assert table.item(0, column).toolTip() or not table.item(0, column).text()


class Plain(Panel):
    """A panel with a step that Esc takes back, and something to lose."""

    title = "Plain"
    icon = "pipe.svg"

    def __init__(self, *, steps=0, precious=False):
        super().__init__()
        self.steps, self.precious, self.ended, self.refreshed = steps, precious, 0, 0
        self.field = QtWidgets.QLineEdit()
        self.layout.addWidget(self.field)

    def step_back(self):
        self.steps -= 1
        return self.steps >= 0

    def has_result(self):
        return self.precious

    def refresh(self):
        self.refreshed += 1

    def discard(self):
        self.ended += 1


def test_only_one_panel_is_open_and_results_are_not_lost_unasked(document):
    first, second = Plain(), Plain(precious=True)
    first.open()
    second.open()
    assert (first.is_open, first.ended, second.is_open) == (False, 1, True)
    said = []

    def say_no(dialog):
        said.append(dialog.text())
        dialog.button(QtWidgets.QMessageBox.StandardButton.No).click()

    when_dialog_opens(QtWidgets.QMessageBox, say_no)
    third = Plain()
    with pytest.raises(Exception, match="still open"):
        third.open()
    assert "not applied" in said[0]
    assert open_panel() is second
    second.close()
    pump()
    assert (second.ended, open_panel(), bool(FreeCADGui.Control.activeDialog())) == (1, None, False)


def test_another_programs_task_is_not_closed(document):
    class Foreign:
        form = QtWidgets.QWidget()

    FreeCADGui.Control.showDialog(Foreign())
    with pytest.raises(Exception, match="another task is open"):
        Plain().open()
    FreeCADGui.Control.closeDialog()


def test_escape_takes_steps_back_before_it_closes(document):
    panel = Plain(steps=1)
    panel.open()
    pump()
    panel.field.setFocus()
    QTest.keyClick(panel.field, KEYS.Key_Escape)
    assert panel.is_open
    QTest.keyClick(panel.field, KEYS.Key_Escape)
    assert wait_until(lambda: not panel.is_open)
    assert panel.ended == 1


def test_panel_follows_its_document(document):
    panel = Plain()
    obj = document.addObject("App::FeaturePython", "Needed")
    panel.depends_on(obj)
    panel.open()
    panel.apply("Add", lambda: document.addObject("App::FeaturePython", "More"))
    pump()
    refreshed = panel.refreshed
    assert refreshed >= 1
    document.undo()
    pump()
    assert panel.refreshed > refreshed
    assert document.getObject("More") is None
    document.removeObject("Needed")
    assert wait_until(lambda: not panel.is_open)
    assert panel.ended == 1


def test_panel_closes_with_its_document():
    made = FreeCAD.newDocument("short")
    panel = Plain()
    panel.open()
    FreeCAD.closeDocument(made.Name)
    assert wait_until(lambda: not panel.is_open)
    assert not FreeCADGui.Control.activeDialog()


def test_what_fails_is_told_in_the_panel_and_changes_nothing(document):
    panel = Plain()
    panel.open()

    def half_way():
        document.addObject("App::FeaturePython", "Half")
        from pipeworkbench.errors import InputError

        raise InputError("this", "", "does not fit", "try that")

    assert not panel.attempt(lambda: panel.apply("Fail", half_way))
    assert document.Objects == []
    message = panel.form.findChild(QtWidgets.QLabel, "message")
    assert not message.isHidden()
    assert "does not fit" in message.text()


def test_adjusting_shows_before_and_after_and_is_one_step(measured):
    before, steps = geometry(measured), measured.UndoCount
    press("Adjust")
    pump()
    assert not standard_button(BUTTONS.Ok).isEnabled()
    click("start")
    panel = open_panel()
    assert wait_until(panel.has_result)
    assert geometry(measured) == before
    assert standard_button(BUTTONS.Ok).isEnabled()
    rows = panel.components.texts()
    assert sorted(row[0] for row in rows) == sorted(before)
    assert all(float(row[1]) >= 0 and "→" in row[3] for row in rows)
    assert [row[0] for row in panel.images.texts()] == ["A / left", "A / right", "A / top"]
    assert all(float(row[1]) < 1 for row in panel.images.texts())
    assert "σ₀" in panel.summary.text()
    assert_numbers_are_whole(panel.components)
    child(QtWidgets.QCheckBox, "residuals").click()
    pump(200)
    screenshot("adjust_residuals")
    panel.components.selectRow(0)
    assert [obj.ComponentId for obj in FreeCADGui.Selection.getSelection()] == [rows[0][0]]
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: not panel.is_open)
    assert measured.UndoCount == steps + 1
    after = geometry(measured)
    assert after != before
    assert pipeline_of(measured).sigma0 is not None
    measured.undo()
    assert geometry(measured) == before
    measured.redo()
    assert geometry(measured) == after


def test_discarding_leaves_everything_and_undo_outdates_a_result(measured):
    before = geometry(measured)
    press("Adjust")
    pump()
    click("start")
    panel = open_panel()
    assert wait_until(panel.has_result)
    screenshot("adjust")
    measured.openTransaction("Fix")
    components_in(measured)[0].Fixed = True
    measured.recompute()
    measured.commitTransaction()
    assert wait_until(lambda: not panel.has_result())
    assert "changed" in panel.form.findChild(QtWidgets.QLabel, "message").text()
    click("start")
    assert wait_until(panel.has_result)
    assert "fixed" in [row[-1] for row in panel.components.texts()]
    panel.form.setFocus()
    QTest.keyClick(panel.form, KEYS.Key_Escape)
    assert wait_until(lambda: not panel.is_open)
    assert geometry(measured) == before


def pipework(prefix, motion=None):
    """Pipes of a course with three directions and a branch, in a frame of its own."""
    motion = motion or ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    corners = [(0.0, 0.0, 0.0), (1200.0, 0.0, 0.0), (1200.0, 700.0, 0.0), (1200.0, 700.0, 900.0), (400.0, 700.0, 900.0)]
    courses = [(*ends, 48.3, 40) for ends in itertools.pairwise(corners)]
    courses.append(((300.0, 60.0, 200.0), (300.0, 900.0, 200.0), 60.3, 50))
    known = {"sigma_position": (0.3, 0.3, 0.3), "sigma_direction_deg": 0.05, "station": prefix, "quality": 0.3, "loa": "LOA50"}
    return Pipeline.of_station(
        prefix,
        tuple(
            replace(moved(Pipe(id=f"{prefix}-P{n}", start=start, end=end, outer_diameter=size, dn=dn), motion), **known)
            for n, (start, end, size, dn) in enumerate(courses)
        ),
    )


def turned(angle_deg, shift):
    cosine, sine = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return ((cosine, -sine, 0.0, shift[0]), (sine, cosine, 0.0, shift[1]), (0.0, 0.0, 1.0, shift[2]), (0.0, 0.0, 0.0, 1.0))


def test_merging_shows_the_assignment_and_is_one_step(document, workbench):
    alone = Pipeline.of_station(
        "C", (Pipe(id="C-P0", start=(0.0, 0.0, 2000.0), end=(500.0, 0.0, 2000.0), outer_diameter=114.3, dn=100, station="C"),)
    )
    fill(document, pipework("A"), pipework("B", turned(35, (900.0, -2500.0, 40.0))), alone)
    before, steps = geometry(document), document.UndoCount
    press("Merge Stations")
    pump()
    child(QtWidgets.QCheckBox, "adjusted").setChecked(False)
    click("start")
    panel = open_panel()
    assert wait_until(panel.has_result)
    assert geometry(document) == before
    rows = panel.pairs.texts()
    assert {(row[1], row[2]) for row in rows} == {(f"A-P{n}", f"B-P{n}") for n in range(5)}
    assert all(float(row[3]) < 0.1 for row in rows)
    assert "A + B" in panel.summary.text()
    assert "C has" in panel.summary.text()
    assert len(overlays()) == 1
    screenshot("merge")
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: not panel.is_open)
    assert overlays() == []
    assert document.UndoCount == steps + 1
    assert sorted(geometry(document)) == [*(f"A-P{n}" for n in range(5)), "C-P0"]
    document.undo()
    assert geometry(document) == before


def test_merging_nothing_is_told(document, workbench):
    fill(document, pipework("A"))
    press("Merge Stations")
    pump()
    click("start")
    message = open_panel().form.findChild(QtWidgets.QLabel, "message")
    assert "fewer than two" in message.text()
    assert not standard_button(BUTTONS.Ok).isEnabled()


def test_deviations_from_a_model_are_shown_coloured_and_saved(document, workbench, tmp_path):
    from pipeworkbench.exports.ifc import write_ifc

    design = pipework("A")
    write_ifc(replace(design, components=design.components[:4]), tmp_path / "model.ifc")
    fill(document, pipework("B", turned(0, (0.0, 0.0, 12.0))))
    press("Deviations")
    pump()
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "model.ifc"))
    child(QtWidgets.QCheckBox, "fit").setChecked(False)
    click("start")
    panel = open_panel()
    assert wait_until(lambda: panel.table.rowCount() > 0)
    rows = {row[0]: row for row in panel.table.texts()}
    assert rows["B-P0"][1:5] == ["12.0", "0.0", "0.0", "12.0"]
    assert rows["B-P4"][-1]
    assert "Largest distance 12.0 mm" in panel.summary.text()
    assert len(overlays()) == 1
    screenshot("deviations")
    written = tmp_path / "deviations.csv"
    opened = when_dialog_opens(QtWidgets.QFileDialog, choose_file(written))
    click("csv")
    assert wait_until(lambda: opened and written.exists())
    with written.open(encoding="utf-8", newline="") as file:
        assert len(list(csv.DictReader(file))) == len(rows)
    QTest.mouseClick(standard_button(BUTTONS.Close), LEFT)
    assert wait_until(lambda: not panel.is_open)
    assert overlays() == []


def test_distance_to_a_selected_solid_is_measured(document, workbench):
    fill(document, pipework("A"))
    wall = document.addObject("Part::Box", "Wall")
    wall.Length, wall.Width, wall.Height = 1500, 100, 1000
    wall.Placement.Base = FreeCAD.Vector(0, -200, -50)
    document.recompute()
    press("Deviations")
    pump()
    child(QtWidgets.QComboBox, "source").setCurrentIndex(2)
    click("start")
    panel = open_panel()
    assert "no solid is selected" in panel.form.findChild(QtWidgets.QLabel, "message").text()
    FreeCADGui.Selection.addSelection(wall)
    click("start")
    assert wait_until(lambda: panel.table.rowCount() > 0)
    rows = {row[0]: row for row in panel.table.texts()}
    assert float(rows["A-P0"][1]) == pytest.approx(100 - 24.15, abs=0.1)


def test_exporting_writes_what_is_selected_in_the_chosen_format(document, workbench, tmp_path):
    fill(document, pipework("A"))
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(components_in(document)[1])
    press("Export")
    pump()
    panel = open_panel()
    panel.format.setCurrentIndex([one.ending for one in panel.formats].index(".csv"))
    assert child(QtWidgets.QLineEdit, "path").text().endswith(".csv")
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "no folder" / "pipes.csv"))
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert "there is no folder" in panel.form.findChild(QtWidgets.QLabel, "message").text()
    assert panel.is_open
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "pipes.csv"))
    screenshot("export")
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: not panel.is_open)
    with (tmp_path / "pipes.csv").open(encoding="utf-8", newline="") as file:
        assert [row["id"] for row in csv.DictReader(file)] == ["A-P1"]
    assert saved_files[-1] == tmp_path / "pipes.csv", "the guide checks its last step off by it"


def test_take_off_list_and_table_have_the_same_ending_and_names_of_their_own(document, workbench, tmp_path):
    fill(document, pipework("A"))
    for name, file, column in (("Take-off list (*.csv)", "pipes-take-off.csv", "item"), ("Table (*.csv)", "pipes.csv", "id")):
        press("Export")
        pump()
        panel = open_panel()
        child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "pipes.ifc"))
        panel.format.setCurrentIndex(panel.format.findText(name))
        assert child(QtWidgets.QLineEdit, "path").text() == str(tmp_path / file)
        QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
        assert wait_until(lambda panel=panel: not panel.is_open)
        with (tmp_path / file).open(encoding="utf-8", newline="") as written:
            assert next(csv.reader(written))[0] == column


def test_ifc_is_written_in_the_chosen_version(document, workbench, tmp_path):
    fill(document, pipework("A"))
    press("Export")
    pump()
    panel = open_panel()
    panel.format.setCurrentIndex([one.ending for one in panel.formats].index(".ifc"))
    assert child(QtWidgets.QComboBox, "ifcSchema").isVisible()
    child(QtWidgets.QComboBox, "ifcSchema").setCurrentIndex(1)
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "pipes.ifc"))
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: not panel.is_open)
    assert "FILE_SCHEMA(('IFC4X3_ADD2'))" in (tmp_path / "pipes.ifc").read_text(encoding="utf-8")


def test_a_report_is_written_and_opened(measured, tmp_path, monkeypatch):
    from pipeworkbench.gui.pipeline_panels import export

    shown = []
    monkeypatch.setattr(export, "open_in_browser", shown.append)
    press("Report")
    pump()
    panel = open_panel()
    child(QtWidgets.QComboBox, "language").setCurrentIndex(1)
    child(QtWidgets.QLineEdit, "reportTitle").setText("Halle <3> & Keller")
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "report.html"))
    screenshot("report")
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: not panel.is_open)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Halle &lt;3&gt; &amp; Keller" in page
    assert page.count("data:image/jpeg") == 3
    assert "Ausgleichung" not in page  # it was not adjusted
    assert shown == [tmp_path / "report.html"]


def test_commands_are_off_without_components(document, workbench):
    for name in ("Adjust", "MergeStations", "Deviations", "Export", "Report"):
        assert not FreeCADGui.Command.get(f"PipeWB_{name}").isActive()
