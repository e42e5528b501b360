# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is around the tools: long work, missing packages, preferences, languages, icons, the tour."""

import json
import shutil
import subprocess
import sys
import threading
import time

import FreeCAD
import FreeCADGui
import pytest
from window import (
    LEFT,
    ROOT,
    SAMPLE,
    QTest,
    answer_message,
    choose_file,
    import_sample,
    later,
    open_dialog,
    press,
    pump,
    screenshot,
    toolbars,
    wait_until,
    when_dialog_opens,
)

from pipeworkbench.commands import GROUPS
from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.features.preferences import PREFERENCES, Preferences, preferences, save_preferences
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, qt_module
from pipeworkbench.gui.dialogs import Cancelled
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.worker import ProgressDialog, is_busy, run_long

ICONS = ROOT / "resources" / "icons"


@pytest.fixture
def fresh_preferences():
    """Preferences at their defaults, before and after."""
    yield save_preferences(Preferences())
    save_preferences(Preferences())


@pytest.fixture
def in_german(workbench):
    """FreeCAD in German, and in English afterwards."""
    FreeCADGui.setLocale("German")
    pump()
    yield
    FreeCADGui.setLocale("English")
    pump()


def progress_dialog():
    return open_dialog(ProgressDialog)


# long work


def test_long_work_runs_in_a_thread_and_gives_its_result():
    def work(progress):
        progress("half", 1, 2)
        return threading.current_thread()

    assert run_long("Work", work) is not threading.main_thread()
    assert not is_busy()


def test_window_lives_and_commands_are_off_while_long_work_runs(document, workbench):
    ticks, active = [], []
    timer = QtCore.QTimer()
    timer.timeout.connect(lambda: ticks.append(time.monotonic()))
    timer.timeout.connect(lambda: active.append(FreeCADGui.Command.get("PipeWB_ImportStation").isActive()))
    timer.start(20)

    def work(_):
        # the work waits for the window: were that not alive, it would come to its deadline
        end = time.monotonic() + 15
        while len(ticks) < 30 and time.monotonic() < end:
            time.sleep(0.02)

    run_long("Work", work)
    timer.stop()
    assert len(ticks) >= 30
    assert not any(active)
    assert FreeCADGui.Command.get("PipeWB_ImportStation").isActive()


def test_progress_dialog_says_what_is_done_and_cancel_ends_the_work(document):
    reached = []
    seen = {}

    def work(progress):
        for step in range(400):
            progress("finding edges", step, 400)
            reached.append(step)
            time.sleep(0.02)

    def press_cancel(dialog):
        pump(200)
        seen["text"], seen["maximum"] = dialog.findChild(QtWidgets.QLabel).text(), dialog.findChild(QtWidgets.QProgressBar).maximum()
        screenshot("progress")
        QTest.mouseClick(dialog.findChild(QtWidgets.QPushButton), LEFT)

    opened = when_dialog_opens(ProgressDialog, press_cancel)
    with pytest.raises(Cancelled):
        run_long("Reconstructing picks", work)
    assert opened
    assert seen == {"text": "Finding edges", "maximum": 400}
    assert len(reached) < 200
    assert progress_dialog() is None


def test_escape_and_closing_the_progress_dialog_cancel_the_work():
    def work(progress):
        for _ in range(400):
            progress("", 0, 0)
            time.sleep(0.02)

    for end in (lambda dialog: QTest.keyClick(dialog, QtCore.Qt.Key.Key_Escape), lambda dialog: dialog.close()):
        when_dialog_opens(ProgressDialog, end)
        with pytest.raises(Cancelled):
            run_long("Work", work)
        assert not is_busy()


def test_cancel_leaves_work_that_only_computes_to_itself():
    ended = threading.Event()

    def work(progress):
        time.sleep(3)
        try:
            progress("", 0, 0)
        finally:
            ended.set()

    when_dialog_opens(ProgressDialog, lambda dialog: dialog.close())
    began = time.monotonic()
    with pytest.raises(Cancelled):
        run_long("Work", work, leave=True)
    assert time.monotonic() - began < 2
    assert not ended.is_set()
    assert not is_busy()
    assert ended.wait(10)


def test_errors_of_long_work_come_out_in_the_caller():
    def work(_):
        raise InputError("picks.json", "picks[0]", "is wrong", "correct it")

    with pytest.raises(InputError, match="picks"):
        run_long("Work", work)
    assert not is_busy()


def test_closing_the_document_cancels_the_work_that_is_meant_for_it():
    made = FreeCAD.newDocument("closed")
    later(lambda: FreeCAD.closeDocument(made.Name), 450)

    def work(progress):
        for _ in range(400):
            progress("", 0, 0)
            time.sleep(0.02)

    with pytest.raises(Cancelled):
        run_long("Work", work, made)
    assert progress_dialog() is None


def test_second_long_work_is_refused_while_the_first_one_runs():
    said = []

    def second():
        try:
            run_long("Second", lambda _: None)
        except PipeWorkbenchError as error:
            said.append(str(error))

    later(second, 100)
    assert run_long("First", lambda _: time.sleep(0.5) or "done") == "done"
    assert len(said) == 1
    assert "still being computed" in said[0]


def test_cancelled_reconstruction_leaves_the_document_as_it_was(document):
    import_sample(document)
    before = [obj.Name for obj in document.Objects], document.UndoNames
    when_dialog_opens(QtWidgets.QFileDialog, choose_file(SAMPLE / "picks.json"))
    opened = when_dialog_opens(ProgressDialog, lambda dialog: dialog.close())
    press("Reconstruct Picks")
    assert wait_until(lambda: not is_busy())
    assert opened
    assert ([obj.Name for obj in document.Objects], document.UndoNames) == before


# missing packages


def test_command_says_how_to_install_what_it_needs_and_the_others_go_on(document, workbench, monkeypatch):
    import_sample(document)
    monkeypatch.setitem(sys.modules, "cv2", None)
    said = []
    when_dialog_opens(QtWidgets.QMessageBox, answer_message(said))
    press("Reconstruct Picks")
    pump()
    assert len(said) == 1
    assert "Reconstruct Picks needs opencv-python-headless" in said[0]
    assert "-m pip install --target" in said[0]
    assert "freecad" not in said[0].split(" -m pip")[0].rsplit("/", 1)[-1].lower()
    assert FreeCADGui.Command.get("PipeWB_Export").isActive() is False
    other = FreeCAD.newDocument("other")
    import_sample(other)
    assert "Station A" in [obj.Label for obj in other.Objects]
    FreeCAD.closeDocument(other.Name)


def test_export_without_ifcopenshell_says_so_and_other_formats_are_written(document, tmp_path, monkeypatch):
    from pipeworkbench.features.exporting import export_document
    from pipeworkbench.features.kinds import add_component
    from pipeworkbench.pipeline import Pipe

    add_component(document, Pipe(id="p", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 500.0), outer_diameter=48.3))
    document.recompute()
    monkeypatch.setitem(sys.modules, "ifcopenshell", None)
    press("Export")
    pump()
    path = FreeCADGui.getMainWindow().findChild(QtWidgets.QLineEdit, "path")
    path.setText(str(tmp_path / "out.ifc"))
    QTest.keyClick(path, QtCore.Qt.Key.Key_Return)
    pump()
    said = FreeCADGui.getMainWindow().findChild(QtWidgets.QLabel, "message").text()
    assert "ifcopenshell" in said
    assert "--target" in said
    export_document(document, tmp_path / "out.csv")
    assert (tmp_path / "out.csv").is_file()


# run by a FreeCAD of its own, from whose start the packages are missing
WITHOUT_PACKAGES = """
import json, sys, traceback
from pathlib import Path

class Hide:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("cv2", "cadquery", "OCP", "ifcopenshell"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Hide())
import FreeCAD, FreeCADGui
from PySide import QtCore

def look():
    said = {}
    try:
        FreeCADGui.activateWorkbench("PipeWorkbench")
        said["commands"] = [name for name in FreeCADGui.listCommands() if name.startswith("PipeWB_")]
        document = FreeCAD.openDocument(DOCUMENT)
        obj = next(obj for obj in document.Objects if hasattr(obj, "OutsideDiameter"))
        said["before"] = obj.Shape.Volume
        obj.Length = 400
        document.recompute()
        said["after"], said["invalid"] = obj.Shape.Volume, "Invalid" in obj.State
        from pipeworkbench.features.exporting import export_document
        export_document(document, Path(DOCUMENT).with_suffix(".csv"))
        said["csv"] = Path(DOCUMENT).with_suffix(".csv").is_file()
        from pipeworkbench.commands.import_station import import_station
        said["station"] = import_station(Path(STATION), document).Label
    except Exception:
        said["error"] = traceback.format_exc()
    Path(ANSWER).write_text(json.dumps(said))
    import os
    os._exit(0)

QtCore.QTimer.singleShot(500, look)
"""


def test_workbench_works_and_documents_keep_their_shapes_where_packages_are_missing(document, tmp_path):
    from pipeworkbench.features.kinds import add_component
    from pipeworkbench.pipeline import Pipe

    add_component(document, Pipe(id="p", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 500.0), outer_diameter=48.3))
    document.recompute()
    path, answer, script, settings = (tmp_path / name for name in ("pipe.FCStd", "answer.json", "look.py", "user.cfg"))
    document.saveAs(str(path))
    settings.write_text((ROOT / "tests" / "gui" / "user.cfg").read_text(encoding="utf-8"), encoding="utf-8")
    names = {"DOCUMENT": path, "STATION": SAMPLE / "station.json", "ANSWER": answer}
    script.write_text("".join(f"{name} = {str(value)!r}\n" for name, value in names.items()) + WITHOUT_PACKAGES, encoding="utf-8")
    run = subprocess.run([shutil.which("freecad"), "-u", str(settings), str(script)], capture_output=True, text=True, timeout=120, check=False)
    said = json.loads(answer.read_text(encoding="utf-8"))
    assert "error" not in said, said["error"]
    assert set(said["commands"]) == {command.name for group in GROUPS for command in group.commands}
    assert said["before"] == said["after"] > 1000
    assert said["invalid"]
    assert said["csv"]
    assert said["station"] == "Station A"
    assert "needs CadQuery, which is not installed" in run.stdout + run.stderr


# preferences


def pages():
    from pipeworkbench.gui.preferences_page import ColoursPage, MeasuringPage

    return MeasuringPage(), ColoursPage()


def test_defaults_are_those_of_the_reconstruction(fresh_preferences):
    from pipeworkbench.features.preferences import adjustment_settings, assemble_settings, pick_settings
    from pipeworkbench.recon.adjust import AdjustmentSettings
    from pipeworkbench.recon.assemble import AssembleSettings
    from pipeworkbench.recon.pick_settings import PickSettings

    assert pick_settings() == PickSettings()
    assert adjustment_settings() == AdjustmentSettings()
    assert assemble_settings() == AssembleSettings()


def test_default_colours_are_those_of_the_pictures():
    from pipeworkbench.exports.kinds import COLOURS

    chosen = Preferences()
    assert {kind.kind: chosen.kind_colour(kind.kind) for kind in COLOURS} == {kind.kind: colour for kind, colour in COLOURS.items()}


def test_preferences_page_is_in_freecads_dialog_and_saves_what_is_shown(fresh_preferences, workbench):
    shown = []

    def change(dialog):
        pump(300)
        near = dialog.findChild(QtWidgets.QDoubleSpinBox, "nearest")
        shown.append(near.value())
        screenshot("preferences")
        tabs = dialog.findChild(QtWidgets.QPushButton, "pipe_colour").window().findChildren(QtWidgets.QTabWidget)
        tab = next(tab for tab in tabs if tab.count() == 2 and tab.tabText(1) == "Colours")
        tab.setCurrentIndex(1)
        screenshot("colours")
        tab.setCurrentIndex(0)
        near.setValue(1500)
        dialog.findChild(QtWidgets.QDoubleSpinBox, "joint_gap").setValue(25)
        dialog.findChild(QtWidgets.QComboBox, "sizes").setCurrentIndex(1)
        dialog.findChild(QtWidgets.QSpinBox, "threads").setValue(1)
        box = dialog.findChild(QtWidgets.QDialogButtonBox)
        QTest.mouseClick(box.button(QtWidgets.QDialogButtonBox.StandardButton.Ok), LEFT)

    opened = when_dialog_opens(QtWidgets.QDialog, change)
    press("Preferences ...")
    pump()
    assert opened
    assert shown == [2000.0]
    assert preferences().nearest == 1500.0
    from pipeworkbench.features.preferences import adjustment_settings, assemble_settings, pick_settings, use_preferences
    from pipeworkbench.recon.threads import thread_count

    assert pick_settings().working_range == (1500.0, 12000.0)
    assert assemble_settings().topology.gap_mm == 25.0
    assert adjustment_settings().sizes == "tolerance"
    use_preferences()
    assert (thread_count(), thread_count(2)) == (1, 1)
    save_preferences(Preferences())
    use_preferences()
    assert thread_count(1) == 1


def test_page_says_what_does_not_fit_and_does_not_save_it(fresh_preferences):
    page, _ = pages()
    page.loadSettings()
    page.form.findChild(QtWidgets.QDoubleSpinBox, "nearest").setValue(20_000)
    message = page.form.findChild(QtWidgets.QLabel, "message")
    assert "the working range is empty" in message.text()
    said = []
    when_dialog_opens(QtWidgets.QMessageBox, answer_message(said))
    page.saveSettings()
    assert len(said) == 1
    assert preferences() == Preferences()
    QTest.mouseClick(page.form.findChild(QtWidgets.QPushButton, "defaults"), LEFT)
    assert message.text() == ""
    assert page.form.findChild(QtWidgets.QDoubleSpinBox, "nearest").value() == 2000.0


def test_several_folders_of_tables_are_used_in_their_order(fresh_preferences, tmp_path):
    from pipeworkbench.catalogue import pipe_size
    from pipeworkbench.features.preferences import use_preferences

    for name, wall in (("one", 3.2), ("two", 4.5)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "pipes_ours.csv").write_text(f"outer_diameter,dn,wall_thickness\n50.5,41,{wall}\n", encoding="utf-8")
    page, _ = pages()
    page.loadSettings()
    folders = page.form.findChild(QtWidgets.QListWidget, "catalogue_folders")
    for name in ("one", "two"):
        opened = when_dialog_opens(QtWidgets.QFileDialog, choose_file(tmp_path / name))
        QTest.mouseClick(page.form.findChild(QtWidgets.QToolButton, "add_folder"), LEFT)
        assert opened
    page.saveSettings()
    assert preferences().catalogue_folders == (str(tmp_path / "one"), str(tmp_path / "two"))
    use_preferences()
    assert pipe_size(50.5).wall_thickness == 4.5
    folders.setCurrentRow(1)
    QTest.mouseClick(page.form.findChild(QtWidgets.QToolButton, "move_up"), LEFT)
    page.saveSettings()
    use_preferences()
    assert pipe_size(50.5).wall_thickness == 3.2
    (tmp_path / "two" / "pipes_ours.csv").write_text("outer_diameter\nwide\n", encoding="utf-8")
    page.loadSettings()
    assert "pipes_ours.csv" in page.form.findChild(QtWidgets.QLabel, "message").text()
    folders.setCurrentRow(0)
    QTest.mouseClick(page.form.findChild(QtWidgets.QToolButton, "remove_folder"), LEFT)
    page.saveSettings()
    assert preferences().catalogue_folders == (str(tmp_path / "one"),)
    save_preferences(Preferences())
    use_preferences()
    assert pipe_size(50.5) is None


def test_wrong_parameters_are_replaced_by_the_defaults(fresh_preferences):
    parameters = FreeCAD.ParamGet(PREFERENCES)
    parameters.SetFloat("WorkingRangeNear", float("nan"))
    parameters.SetFloat("SmallestDiameter", 500.0)
    parameters.SetFloat("LargestDiameter", 100.0)
    parameters.SetFloat("GoodQualityPx", 0.8)
    parameters.SetFloat("FairQualityPx", 5.0)
    parameters.SetString("Sizes", "large")
    parameters.SetString("CatalogueFolders", "no list")
    assert preferences() == Preferences()


def test_colour_of_a_kind_reaches_what_is_open(fresh_preferences, document):
    from pipeworkbench.features.kinds import add_component
    from pipeworkbench.gui.view_providers import show
    from pipeworkbench.pipeline import Pipe

    obj = add_component(document, Pipe(id="p", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 500.0), outer_diameter=48.3))
    document.recompute()
    show(obj)
    _, page = pages()
    page.loadSettings()
    page.form.findChild(QtWidgets.QPushButton, "pipe_colour").set_colour((1.0, 0.0, 0.0))
    page.saveSettings()
    assert obj.ViewObject.ShapeColor[:3] == pytest.approx((1.0, 0.0, 0.0), abs=0.01)
    assert preferences().kind_colour("pipe") == (1.0, 0.0, 0.0)


# languages


def test_menus_tooltips_and_dialogs_follow_the_language(workbench, in_german):
    texts = {action.text().replace("&", "") for bar in toolbars() for action in bar.actions()}
    assert {"Standpunkt importieren", "Exportieren", "Einstellungen ..."} <= texts
    tooltips = [action.toolTip() for bar in toolbars() for action in bar.actions()]
    assert any("Fotos und Kalibrierung eines Standpunkts" in text for text in tooltips)
    assert {"Rohre messen", "Rohre ausgeben"} <= {bar.windowTitle() for bar in toolbars()}
    assert tr("Cancel") == "Abbrechen"
    assert QtCore.QCoreApplication.translate("App::Property", "Outside diameter") == "Außendurchmesser"
    page, _ = pages()
    assert page.form.windowTitle() == "Messen"
    screenshot("german")
    FreeCADGui.setLocale("English")
    pump()
    texts = {action.text().replace("&", "") for bar in toolbars() for action in bar.actions()}
    assert {"Import Station", "Export", "Preferences ..."} <= texts


def test_error_names_the_command_in_the_users_language(document, in_german, monkeypatch):
    import_sample(document)
    monkeypatch.setitem(sys.modules, "cv2", None)
    said = []
    when_dialog_opens(QtWidgets.QMessageBox, answer_message(said))
    press("Markierungen rekonstruieren")
    pump()
    assert "Markierungen rekonstruieren braucht opencv-python-headless" in said[0]


# icons and texts


def test_every_icon_is_drawn_at_16_pixels():
    renderer = qt_module("QtSvg").QSvgRenderer
    for path in sorted(ICONS.glob("*.svg")):
        svg = renderer(str(path))
        assert svg.isValid(), path.name
        image = QtGui.QImage(16, 16, QtGui.QImage.Format.Format_ARGB32_Premultiplied)
        image.fill(0)
        painter = QtGui.QPainter(image)
        svg.render(painter)
        painter.end()
        pixels = [image.pixelColor(x, y) for x in range(16) for y in range(16)]
        drawn = [pixel for pixel in pixels if pixel.alpha() > 100]
        assert len(drawn) > 40, path.name
        # something light for dark themes, something dark for light ones
        assert max(pixel.lightness() for pixel in drawn) > 110, path.name
        assert min(pixel.lightness() for pixel in drawn) < 110, path.name


def test_every_command_has_texts_icon_and_a_status_tip():
    for group in GROUPS:
        for command in group.commands:
            resources = command().GetResources()
            assert resources["MenuText"]
            assert len(resources["ToolTip"]) > 15
            assert resources["StatusTip"]
            assert (ICONS / command.icon).is_file()
            assert command.name.startswith("PipeWB_")


def test_keys_of_commands_are_their_own():
    keys = [command.accelerator for group in GROUPS for command in group.commands if command.accelerator]
    assert "Q, I" in keys
    assert len(set(keys)) == len(keys)


def test_menu_has_every_command_once(workbench):
    bar = FreeCADGui.getMainWindow().menuBar()
    menu = next(menu for menu in bar.findChildren(QtWidgets.QMenu) if menu.title().replace("&", "") == "Pipe Workbench")
    entries = [action.text().replace("&", "") for action in menu.actions() if not action.isSeparator()]
    assert entries == [command.menu_text for group in GROUPS for command in group.commands]
    assert not menu.actions()[0].isSeparator()


def test_context_menu_is_offered_for_what_is_selected(document, workbench):
    obj = import_sample(document)
    offered = []
    workbench.appendContextMenu = lambda menu, names: offered.append((menu, names))
    try:
        workbench.ContextMenu("Tree")
        assert offered == []
        FreeCADGui.Selection.addSelection(obj)
        workbench.ContextMenu("Tree")
    finally:
        del workbench.appendContextMenu
        FreeCADGui.Selection.clearSelection()
    assert offered == [("Pipe Workbench", ["PipeWB_PhotoWindow"])]


# the tour


@pytest.fixture
def example(tmp_path):
    from pipeworkbench.gui.tour.example import make_example

    made = make_example(tmp_path / "example")
    name = made.Name
    yield made
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    pump(50)


def test_example_is_an_unsaved_document_whose_photographs_may_be_changed(example, tmp_path):
    assert example.FileName == ""
    station = example.getObject("Station")
    assert station.StationFile == str(tmp_path / "example" / "A" / "station.json")
    assert all((tmp_path / "example" / "A" / f"{camera}.jpg").stat().st_mode & 0o200 for camera in ("left", "right", "top"))


def test_example_goes_to_a_temporary_folder_where_the_usual_one_cannot_be_made(tmp_path):
    from pipeworkbench.gui.tour.example import copy_sample

    blocked = tmp_path / "file"
    blocked.write_text("", encoding="utf-8")
    copied = copy_sample(blocked / "example")
    assert (copied / "station.json").is_file()
    assert tmp_path not in copied.parents


def test_guide_checks_steps_off_by_the_document_and_opens_them_again_on_undo(example):
    from pipeworkbench.features.document import add_pipeline
    from pipeworkbench.features.transactions import transaction
    from pipeworkbench.gui.tour.guide import start_guide
    from pipeworkbench.pipeline import Pipeline

    guide = start_guide(example)
    pump()
    titles = [step.title for step in guide.steps]
    assert titles[0] == "Import a station"
    assert titles[guide.current] == "Open its photo window"
    screenshot("tour")
    export = titles.index("Export it")
    assert not guide.steps[export].is_done(example)
    pipes = [step for step in guide.steps if step.title == "Measure a pipe"]
    everything = Pipeline.read(ROOT / "tests" / "data" / "one_of_everything.json")
    with transaction(example, "Pipe"):
        add_pipeline(example, everything)
    pump()
    assert all(step.is_done(example) for step in pipes)
    example.undo()
    pump()
    assert not any(step.is_done(example) for step in pipes)
    FreeCAD.closeDocument(example.Name)
    assert wait_until(lambda: FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, "PipeWorkbenchTour") is None)


def test_tour_opens_from_the_toolbar_with_guide_and_photographs(workbench):
    from pipeworkbench.gui.photos.windows import photo_window

    press("Example project: dummy station")
    assert wait_until(lambda: photo_window() is not None)
    made = FreeCAD.ActiveDocument
    guide = FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, "PipeWorkbenchTour")
    assert wait_until(lambda: guide.current >= 2)
    screenshot("tour_window")
    photo_window().close()
    QTest.mouseClick(guide.findChild(QtWidgets.QPushButton, "end"), LEFT)
    pump()
    FreeCAD.closeDocument(made.Name)
