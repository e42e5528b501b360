# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation in FreeCAD's real window: the button, the panel's fields and answers, OK, editing by double click, undo, wrong values."""

from dataclasses import replace

import FreeCADGui
import pytest
from window import LEFT, QTest, choose_file, press, pump, screenshot, standard_button, wait_until, when_dialog_opens

from pipeworkbench.features.document import add_pipeline, components_in
from pipeworkbench.features.insulation import insulations_in, make_insulation
from pipeworkbench.gui.compat import QtCore, QtWidgets, is_alive
from pipeworkbench.gui.panel import open_panel
from pipeworkbench.insulation.rules import Changes, ComponentRule, LayerSpec, Match
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.pipeline import Elbow, Flange, Joint, Pipe, Pipeline

BUTTONS = QtWidgets.QDialogButtonBox.StandardButton
RADIUS = 76.0


def pipe(name, start, end):
    return Pipe(id=name, start=start, end=end, outer_diameter=60.3, wall_thickness=2.9, station="A")


def elbow(name):
    """Return the elbow from the pipe along x to the one upwards."""
    return Elbow(
        id=name,
        start=(1000.0, 0.0, 0.0),
        end=(1000.0 + RADIUS, 0.0, RADIUS),
        intersection=(1000.0 + RADIUS, 0.0, 0.0),
        angle_deg=90.0,
        bend_radius=RADIUS,
        outer_diameter=60.3,
        wall_thickness=2.9,
        station="A",
    )


def flange(name, face, axis):
    plate = {"D": 165.0, "C": 20.0, "length": 45.0, "neck_diameter": 75.0, "neck_straight": 8.0, "K": 125.0, "L": 18.0, "bolts": 4}
    return Flange(id=name, face=face, axis=axis, flange_type="11", pn=16.0, outer_diameter=60.3, wall_thickness=2.9, dn=50, station="A", **plate)


def flanged():
    """Return a bent run with a pair of flanges."""
    components = (
        flange("F1", (452.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
        flange("F2", (454.0, 0.0, 0.0), (-1.0, 0.0, 0.0)),
        pipe("P0", (0.0, 0.0, 0.0), (407.0, 0.0, 0.0)),
        pipe("P1", (499.0, 0.0, 0.0), (1000.0, 0.0, 0.0)),
        elbow("E1"),
        pipe("P2", (1000.0 + RADIUS, 0.0, RADIUS), (1000.0 + RADIUS, 0.0, 600.0)),
    )
    ends = (("P0", 1, "F1", 1), ("F1", 0, "F2", 0), ("F2", 1, "P1", 0), ("P1", 1, "E1", 0), ("E1", 1, "P2", 0))
    joints = tuple(Joint(a=a, a_port=a_port, b=b, b_port=b_port) for a, a_port, b, b_port in ends)
    return replace(Pipeline.of_station("A", components), joints=joints)


def fill(document, pipeline):
    document.openTransaction("Measure")
    add_pipeline(document, pipeline)
    document.recompute()
    document.commitTransaction()
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")


@pytest.fixture
def bent(document, workbench):
    """The document with a bent run, and a pipe that runs beside it."""
    components = (
        pipe("P1", (0.0, 0.0, 0.0), (1000.0, 0.0, 0.0)),
        elbow("E1"),
        pipe("P2", (1000.0 + RADIUS, 0.0, RADIUS), (1000.0 + RADIUS, 0.0, 900.0)),
        pipe("P3", (0.0, 180.0, 0.0), (1000.0, 180.0, 0.0)),
    )
    joints = (Joint(a="P1", a_port=1, b="E1", b_port=0), Joint(a="E1", a_port=1, b="P2", b_port=0))
    fill(document, replace(Pipeline.of_station("A", components), joints=joints))
    return document


@pytest.fixture(autouse=True)
def closed_panels():
    """No test leaves a panel to the next one."""
    yield
    if open_panel() is not None:
        open_panel().close()
    pump(20)


def select(document, *names):
    FreeCADGui.Selection.clearSelection()
    for obj in components_in(document):
        if obj.ComponentId in names:
            FreeCADGui.Selection.addSelection(obj)
    pump(50)


def child(kind, name):
    found = [widget for widget in open_panel().form.findChildren(kind, name) if is_alive(widget)]
    assert found, name
    return found[0]


def opened():
    """Press the button and return the panel with its first answer."""
    press("Insulation")
    return answered(open_panel())


def answered(panel):
    assert panel is not None
    assert wait_until(lambda: not panel.is_planning)
    return panel


def type_number(name, text):
    field = child(QtWidgets.QDoubleSpinBox, name)
    tabs = child(QtWidgets.QTabWidget, "settings")
    tabs.setCurrentIndex(next(place for place in range(tabs.count()) if tabs.widget(place).isAncestorOf(field)))
    pump(30)
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, QtCore.Qt.Key.Key_Tab)
    pump(30)


def choose(name, text):
    box = child(QtWidgets.QComboBox, name)
    place = box.findText(text)
    assert place >= 0, [box.itemText(n) for n in range(box.count())]
    box.setCurrentIndex(place)
    pump(30)


def press_ok():
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: open_panel() is None), open_panel()._message.text()


def tree_items(obj):
    """Return the trees that show an object, each with its item."""
    flags = QtCore.Qt.MatchFlag.MatchExactly | QtCore.Qt.MatchFlag.MatchRecursive
    trees = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTreeWidget)
    return [(tree, item) for tree in trees for item in tree.findItems(obj.Label, flags)]


def double_click(obj):
    """Double click an object's name in the tree, once FreeCAD shows it there."""
    assert wait_until(lambda: tree_items(obj)), obj.Label
    tree, item = tree_items(obj)[0]
    dock = tree.parent()
    while not isinstance(dock, QtWidgets.QDockWidget):
        dock = dock.parent()
    dock.show()
    tree.scrollToItem(item)
    pump(200)
    place = tree.visualItemRect(item).center()
    QTest.mouseClick(tree.viewport(), LEFT, QtCore.Qt.KeyboardModifier.NoModifier, place)
    QTest.mouseDClick(tree.viewport(), LEFT, QtCore.Qt.KeyboardModifier.NoModifier, place)
    assert wait_until(lambda: open_panel() is not None)


def test_components_are_insulated_with_the_button_and_ok(bent):
    panel = opened()
    type_number("thickness", "40")
    choose("second_material", "glass wool")
    type_number("second_thickness", "20")
    type_number("medium_temperature", "90")
    type_number("price_per_kwh", "0.11")
    answered(panel)
    assert "pieces" in panel.result.summary.text()
    now, then, saved = ([float(cell.replace("–", "nan")) for cell in row[1:]] for row in panel.result.energy.texts())
    assert now[0] > 4 * then[0] > 0
    assert saved[1] == pytest.approx(now[1] - then[1], abs=1.5)
    assert saved[2] == pytest.approx(0.11 * saved[1], rel=0.02)
    screenshot("insulation_operation")
    child(QtWidgets.QTabWidget, "settings").setCurrentIndex(0)
    screenshot("insulation_layers")
    press_ok()
    obj = insulations_in(bent)[0]
    assert (obj.Thickness.Value, obj.SecondMaterial, obj.SecondThickness.Value, obj.MediumTemperature) == (40, "glass wool", 20, 90)
    assert obj.Shape.isValid()
    assert obj.Pieces > 4
    assert obj.ViewObject.Transparency == 60
    assert obj.ViewObject.Visibility
    screenshot("insulation_done")
    bent.undo()
    assert not insulations_in(bent)
    bent.redo()
    assert insulations_in(bent)[0].Pieces > 4


def test_only_what_is_selected_or_hangs_together_with_it_is_insulated(bent):
    select(bent, "E1")
    panel = opened()
    assert panel.scope.currentText() == "selected (1)"
    choose("scope", "runs of the selected (3)")
    answered(panel)
    press_ok()
    assert [obj.ComponentId for obj in insulations_in(bent)[0].Components] == ["E1", "P1", "P2"]


def test_clash_is_listed_and_selects_both_components(bent):
    panel = opened()
    assert ["P1", "P3"] in [sorted(row[:2]) for row in panel.result.clashes.texts()]
    row = [sorted(row[:2]) for row in panel.result.clashes.texts()].index(["P1", "P3"])
    child(QtWidgets.QTabWidget, "settings")
    panel.result.clashes.selectRow(row)
    pump(100)
    assert sorted(obj.ComponentId for obj in FreeCADGui.Selection.getSelection()) == ["P1", "P3"]
    screenshot("insulation_clash")
    assert panel.scope.currentText().startswith("all")
    type_number("minimum_distance", "10")
    answered(panel)
    assert ["P1", "P3"] not in [sorted(row[:2]) for row in panel.result.clashes.texts()]


def test_preview_shows_the_insulation_and_leaves_the_document_alone(bent):
    select(bent, "P1", "E1", "P2")
    panel = opened()
    child(QtWidgets.QTabWidget, "settings").setCurrentIndex(1)
    type_number("gores", "5")
    QTest.mouseClick(panel.preview, LEFT)
    assert wait_until(lambda: panel._overlay.count > 0)
    assert panel._overlay.count == len(panel._outcome.pieces)
    assert not insulations_in(bent)
    screenshot("insulation_bends")
    type_number("gores", "6")
    assert panel._overlay.count == 0  # outdated
    QTest.mouseClick(standard_button(BUTTONS.Cancel), LEFT)
    assert wait_until(lambda: open_panel() is None)
    assert not insulations_in(bent)


def test_preview_and_heat_saved_of_a_run_with_an_elbow_and_flanges(document, workbench):
    fill(document, flanged())
    panel = opened()
    type_number("thickness", "40")
    type_number("medium_temperature", "120")
    type_number("price_per_kwh", "0.09")
    answered(panel)
    QTest.mouseClick(panel.preview, LEFT)
    assert wait_until(lambda: panel._overlay.count > 0)
    assert {piece.covering.kind for piece in panel._outcome.pieces} >= {"straight", "bend", "box"}
    bare, insulated = (float(row[1]) for row in panel.result.energy.texts()[:2])
    assert bare > 4 * insulated > 0
    screenshot("insulation")


def test_insulation_is_edited_by_double_click_and_undone(bent):
    select(bent, "P1", "E1", "P2")
    opened()
    type_number("thickness", "30")
    press_ok()
    obj = insulations_in(bent)[0]
    double_click(obj)
    panel = answered(open_panel())
    assert child(QtWidgets.QDoubleSpinBox, "thickness").value() == 30
    assert panel.scope.currentText() == "as it is (3)"
    type_number("thickness", "45")
    choose("jacket", "none")
    press_ok()
    assert insulations_in(bent) == [obj]
    assert (obj.Thickness.Value, obj.Jacket, len(obj.Components)) == (45, "none", 3)
    bent.undo()
    bent.recompute()
    assert (obj.Thickness.Value, obj.Jacket) == (30, "aluminium")


def test_wrong_thickness_is_told_with_what_would_fit_and_changes_nothing(bent):
    select(bent, "E1")
    panel = opened()
    type_number("thickness", "0")
    answered(panel)
    assert "0 mm" in panel._message.text()
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    pump(300)
    assert open_panel() is panel
    assert not insulations_in(bent)
    choose("tight_bends", "refuse")
    type_number("thickness", "200")
    answered(panel)
    assert "E1" in panel.result.problems.text()
    assert any(character.isdigit() for character in panel.result.problems.text().split(";")[-1])
    screenshot("insulation_problem")
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: "E1" in panel._message.text())
    assert open_panel() is panel
    assert not insulations_in(bent)


def test_specification_file_gives_rules_for_single_components(bent, tmp_path):
    rules = (ComponentRule(match=Match(ids=("P2",)), changes=Changes(layers=(LayerSpec("foam glass", 25.0),))),)
    default = Changes(layers=(LayerSpec("glass wool", 35.0),))
    Specification(default=default, rules=rules, name="plant 7").write(tmp_path / "plant.json")
    panel = opened()
    done = when_dialog_opens(QtWidgets.QFileDialog, choose_file(tmp_path / "plant.json"))
    QTest.mouseClick(panel.loaded, LEFT)
    assert wait_until(lambda: done)
    answered(panel)
    assert child(QtWidgets.QDoubleSpinBox, "thickness").value() == 35
    assert "plant 7: 1 rules" in panel.rules.text()
    screenshot("insulation_specification")
    press_ok()
    from pipeworkbench.features import plan_of

    plan = plan_of(bent)
    assert plan.piece_of("P2").covering.layers[0].material == "foam glass"
    assert plan.piece_of("P1").covering.layers[0].material == "glass wool"


def test_export_carries_the_insulation_unless_the_switch_is_off(bent, tmp_path):
    def exported(name, *, insulated=True):
        press("Export")
        choose("format", "IFC (*.ifc)")
        found = child(QtWidgets.QCheckBox, "insulation")
        assert found.isVisible() == bool(insulations_in(bent))
        if found.isChecked() != insulated:
            found.click()
        child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / name))
        press_ok()
        return "IFCCOVERING(" in (tmp_path / name).read_text(encoding="utf-8")

    assert not exported("bare.ifc")
    opened()
    press_ok()
    assert exported("covered.ifc")
    assert not exported("switched off.ifc", insulated=False)


def test_cut_sheets_are_exported_once_something_is_insulated(bent, tmp_path):
    press("Export")
    choose("format", "Cut sheets (*.dxf)")
    child(QtWidgets.QLineEdit, "path").setText(str(tmp_path / "cut.dxf"))
    explanation = child(QtWidgets.QLabel, "explanation")
    assert "Nothing is insulated yet" in explanation.text()
    QTest.mouseClick(standard_button(BUTTONS.Ok), LEFT)
    assert wait_until(lambda: "nothing is insulated" in open_panel()._message.text())
    bent.openTransaction("Insulate")
    make_insulation(bent)
    bent.recompute()
    bent.commitTransaction()
    assert wait_until(lambda: "Nothing" not in explanation.text())
    press_ok()
    assert "CUT" in (tmp_path / "cut.dxf").read_text(encoding="utf-8")


def test_panel_closes_with_the_insulation_that_it_edits(bent):
    opened()
    press_ok()
    obj = insulations_in(bent)[0]
    double_click(obj)
    panel = answered(open_panel())
    bent.undo()
    assert wait_until(lambda: not panel.is_open)
