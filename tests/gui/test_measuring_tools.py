# SPDX-License-Identifier: LGPL-2.1-or-later
"""The measuring tools in FreeCAD's window, with real clicks and keys in the photographs of the sample station."""

import json
import shutil

import FreeCAD
import FreeCADGui
import numpy as np
import pytest
from window import (
    KEY,
    LEFT,
    NO_KEY,
    PATIENCE_S,
    PICKS,
    SAMPLE,
    QTest,
    click_at,
    click_pipe,
    edge_points,
    import_sample,
    kinds_in,
    press_button,
    pump,
    screenshot,
    tool_of,
    toolbars,
    wait_until,
)

from pipeworkbench.gui.compat import QtCore, QtWidgets


@pytest.fixture
def station(document):
    """The sample station in a new document."""
    toolbars()
    return import_sample(document)


def share_in_sight(window, camera):
    """Return which part of a proposal's outline a photograph shows of it."""
    canvas = window.canvas(camera)
    points = np.concatenate([drawing.points for drawing in window.layer("proposal").drawings(camera)])
    screen = canvas.frame.to_screen(points)
    return float(((screen >= 0) & (screen <= (canvas.width(), canvas.height()))).all(axis=1).mean())


def contents_of(document):
    """Return what a document holds, to compare: each component as its file would have it."""
    from pipeworkbench.features.document import pipeline_of

    return {component["id"]: component for component in pipeline_of(document).to_dict()["components"]}


def test_two_edges_give_a_pipe_that_is_chosen_accepted_undone_and_done_again(station):
    document = station.Document
    tool = tool_of("Pipe")
    one, other, _ = edge_points(PICKS[0])
    click_at(tool.window, "left", one)
    assert len(tool.measurement.touches) == 1
    assert kinds_in(document) == []
    click_at(tool.window, "left", other)
    assert wait_until(lambda: tool.measurement.shown is not None, PATIENCE_S)
    for camera in ("left", "right", "top"):
        assert not tool.window.layer("proposal").is_empty(camera)
    assert wait_until(lambda: not tool.measurement.is_measuring, PATIENCE_S)
    best = tool.measurement.answers[0]
    assert best.size.designation == "DN 40"
    assert tool.table.rowCount() == len(tool.measurement.answers)
    assert tool._ghosts.count == 1
    screenshot("tool_pipe")
    if len(tool.measurement.answers) > 1:
        QTest.keyClick(tool.window, KEY.Key_2)
        assert tool.measurement.row == 1
        QTest.keyClick(tool.window, KEY.Key_1)
    assert tool.measurement.row == 0
    QTest.keyClick(tool.window, KEY.Key_Return)
    pump(100)
    assert kinds_in(document) == ["pipe"]
    pipe = next(obj for obj in document.Objects if hasattr(obj, "ComponentId"))
    assert pipe.NominalDiameter == "DN 40"
    assert pipe.Pick == len(PICKS), "the picks of the file keep their numbers"
    assert tool._ghosts.count == 0
    assert pipe.ComponentId in tool._accepted_label.text()

    document.undo()
    pump(100)
    assert kinds_in(document) == []
    assert tool._accepted_label.text() == ""
    document.redo()
    pump(100)
    assert kinds_in(document) == ["pipe"]
    assert pipe.ComponentId in tool._accepted_label.text()
    tool.close()


def test_photographs_move_to_the_proposal_but_for_the_one_that_was_clicked_in(station):
    tool = tool_of("Pipe")
    window = tool.window
    for camera in ("right", "top"):
        window.show_place(camera, (0.0, 0.0), 1.0)
    click_pipe(tool, PICKS[0])
    clicked_at = tuple(map(float, edge_points(PICKS[0])[1]))
    assert window.canvas("left").centre == pytest.approx(clicked_at, abs=0.5), "nothing moves under the pointer"
    for camera in ("right", "top"):
        assert share_in_sight(window, camera) > 0
        assert window.canvas(camera).scale == 1.0
    # what the user then moves away stays there until something else is shown
    window.show_place("right", (0.0, 0.0))
    tool._show()
    assert window.canvas("right").centre == (0.0, 0.0)
    tool.close()


def test_one_click_inside_gives_a_second_pipe_with_a_name_of_its_own(station):
    document = station.Document
    tool = tool_of("Pipe")
    click_pipe(tool, PICKS[4])
    QTest.keyClick(tool.window, KEY.Key_Return)
    _, _, inside = edge_points(PICKS[3])
    tool._mode.setCurrentIndex(2)
    click_at(tool.window, PICKS[3]["camera"], inside)
    assert tool.measurement.is_measuring
    assert wait_until(lambda: tool.measurement.answers, PATIENCE_S), tool.measurement.reason
    press_button(tool, "accept")
    assert kinds_in(document) == ["pipe", "pipe"]
    assert len({obj.ComponentId for obj in document.Objects if hasattr(obj, "ComponentId")}) == 2
    tool.close()


def test_dragging_the_diameter_shows_it_at_once_and_measures_with_it_afterwards(station):
    tool = tool_of("Pipe")
    click_pipe(tool, PICKS[0])
    before = np.array(tool.measurement.shown.start)
    slider = tool.form.findChild(QtWidgets.QSlider, "drag")
    slider.setSliderDown(True)
    slider.setValue(80)
    tried = tool.measurement.shown
    assert tried.outer_diameter > 48.3
    centre = tool.station.cameras[0].projection_centre
    # as far away as it is thicker: the picture in the photograph that was clicked in stays
    assert np.linalg.norm(np.array(tried.start) - centre) / np.linalg.norm(before - centre) == pytest.approx(tried.outer_diameter / 48.3)
    assert tool._spin.value() == pytest.approx(tried.outer_diameter, abs=0.1)
    screenshot("tool_pipe_drag")
    tool._spin.setValue(48.3)
    slider.setSliderDown(False)
    assert wait_until(lambda: tool.measurement.diameter == 48.3, PATIENCE_S)
    assert wait_until(lambda: not tool.measurement.is_measuring, PATIENCE_S)
    assert tool.measurement.answers[0].size.outer_diameter == 48.3
    tool.close()


def test_escape_steps_back_and_leaves_at_last(station):
    from pipeworkbench.gui.panel import open_panel

    tool = tool_of("Pipe")
    one, other, _ = edge_points(PICKS[0])
    click_at(tool.window, "left", one)
    click_at(tool.window, "left", other)
    QTest.keyClick(tool.window, KEY.Key_Escape)
    assert len(tool.measurement.touches) == 1
    assert not tool._task.is_running
    QTest.keyClick(tool.window, KEY.Key_Escape)
    assert tool.measurement.touches == []
    window = tool.window
    QTest.keyClick(window, KEY.Key_Escape)
    pump(50)
    assert open_panel() is None
    assert not window.has_tool
    assert all(window.layer("proposal").is_empty(camera) for camera in ("left", "right", "top"))


def test_a_pick_that_fails_says_why_and_keeps_the_first_click(station):
    tool = tool_of("Pipe")
    one, _, _ = edge_points(PICKS[0])
    click_at(tool.window, "left", one)
    click_at(tool.window, "left", one + np.array((0.2, 30.0)))
    assert "same edge" in tool.measurement.reason or "apart" in tool.measurement.reason
    assert "edge" in tool.form.findChild(QtWidgets.QLabel, "reason").text()
    assert len(tool.measurement.touches) == 1
    assert kinds_in(station.Document) == []
    tool.close()


def test_double_clicks_and_clicks_beside_the_photograph_do_nothing_bad(station):
    tool = tool_of("Pipe")
    canvas = tool.window.canvas("left")
    tool.window.fit()
    pump(50)
    QTest.mouseClick(canvas, LEFT, NO_KEY, QtCore.QPoint(5, 40))
    assert tool.measurement.touches == []
    one, _, _ = edge_points(PICKS[0])
    tool.window.show_place("left", tuple(map(float, one)), 1.0)
    pump(50)
    place = canvas.screen_at(tuple(map(float, one))).toPoint()
    QTest.mouseClick(canvas, LEFT, NO_KEY, place)
    QTest.mouseDClick(canvas, LEFT, NO_KEY, place)
    pump(50)
    assert len(tool.measurement.touches) <= 2
    assert kinds_in(station.Document) == []
    tool.close()


def test_deleting_the_station_or_closing_its_window_ends_a_tool_without_trace(station):
    from pipeworkbench.gui.panel import open_panel

    document = station.Document
    for end in (lambda tool: tool.window.parent().close(), lambda _: document.removeObject(station.Name)):
        tool = tool_of("Pipe")
        one, other, _ = edge_points(PICKS[0])
        click_at(tool.window, "left", one)
        click_at(tool.window, "left", other)
        end(tool)
        assert wait_until(lambda: open_panel() is None)
        assert not FreeCADGui.Control.activeDialog()
        assert kinds_in(document) == []
        pump(100)


def test_a_click_in_another_station_begins_anew_there(station, tmp_path):
    from pipeworkbench.commands.import_station import import_station
    from pipeworkbench.gui.photos.windows import open_photo_window

    other = tmp_path / "B"
    shutil.copytree(SAMPLE, other)
    text = json.loads((other / "station.json").read_text(encoding="utf-8"))
    (other / "station.json").write_text(json.dumps(text | {"name": "B"}), encoding="utf-8")
    (other / "picks.json").unlink()
    second = import_station(other / "station.json", station.Document)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(station)
    for sub_window in FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).subWindowList():
        if "photographs" in sub_window.windowTitle():
            sub_window.close()
    pump(50)
    tool = tool_of("Pipe")
    assert tool.station.name == "A"
    one, _, _ = edge_points(PICKS[0])
    click_at(tool.window, "left", one)
    window = open_photo_window(second)
    assert wait_until(lambda: window.views is not None, PATIENCE_S)
    click_pipe_in = [edge_points(PICKS[0])[0], edge_points(PICKS[0])[1]]
    for point in click_pipe_in:
        click_at(window, "left", point)
    assert tool.station.name == "B"
    assert wait_until(lambda: tool.measurement.answers, PATIENCE_S)
    press_button(tool, "accept")
    pipe = next(obj for obj in station.Document.Objects if hasattr(obj, "ComponentId"))
    assert (pipe.StationName, pipe.ComponentId) == ("B", "B-P00")
    tool.close()


def test_pipes_are_found_ticked_by_confidence_rejected_and_accepted(station, monkeypatch):
    from pipeworkbench.recon import detect
    from pipeworkbench.recon.picks import read_picks
    from pipeworkbench.recon.pipes import from_pick

    def few(views, *_settings, progress):
        progress("finding lines")
        picks = read_picks(SAMPLE / "picks.json", tool_station).pipes
        return tuple(from_pick(views, picks[index])[0] for index in (0, 3, 4))

    from pipeworkbench.features.station import station_of

    tool_station = station_of(station)
    monkeypatch.setattr(detect, "detect", few)
    tool = tool_of("Find Pipes")
    assert wait_until(lambda: len(tool.proposals.items) == 3, PATIENCE_S)
    screenshot("tool_find_pipes")
    assert tool._ghosts.count == 3
    scores = sorted(item.confidence for item in tool.proposals.items)
    tool._slider.setValue(int(scores[1]) + 1)
    assert sum(tool.proposals.ticks) == sum(score >= int(scores[1]) + 1 for score in scores)
    press_button(tool, "reject")
    assert len(tool.proposals.items) == 2
    press_button(tool, "accept")
    assert kinds_in(station.Document) == ["pipe"]
    station.Document.undo()
    pump(100)
    assert kinds_in(station.Document) == []
    assert len(tool.proposals.items) == 2, "what was undone is proposed again"
    tool.close()


def test_pipes_elbow_and_flange_from_clicks_undone_to_the_beginning_done_again_saved_and_opened(station, tmp_path):  # noqa: PLR0915  # one story
    document = station.Document
    tool = tool_of("Pipe")
    for pick in (PICKS[0], PICKS[1]):
        click_pipe(tool, pick)
        assert tool.measurement.answers, tool.measurement.reason
        QTest.keyClick(tool.window, KEY.Key_Return)
        pump(50)
    assert kinds_in(document) == ["pipe", "pipe"]

    FreeCADGui.Selection.clearSelection()
    tool = tool_of("Elbows")
    assert wait_until(lambda: not tool._task.is_running, PATIENCE_S)
    assert len(tool.proposals.items) == 1
    screenshot("tool_elbows")
    bend = tool.form.findChild(QtWidgets.QComboBox, "bend")
    assert bend.count() >= 4
    kind = tool.proposals.current.component.bend_type
    tool._radius.setValue(tool._radius.value() + 8.0)
    assert tool.proposals.current.component.bend_type is None
    row = next(row for row in range(bend.count() - 1) if bend.itemData(row).bend_type == kind)
    bend.setCurrentIndex(row)
    bend.activated.emit(row)
    assert tool.proposals.current.component.bend_type == kind
    QTest.keyClick(tool.window, KEY.Key_Return)
    pump(50)
    assert kinds_in(document) == ["elbow", "pipe", "pipe"]
    assert tool.proposals.items == []

    tool = tool_of("Flange")
    flange = next(pick for pick in PICKS if pick["kind"] == "flange")
    click_at(tool.window, flange["camera"], flange["point"])
    assert wait_until(lambda: tool.measurement.flange is not None or tool.reason, PATIENCE_S)
    assert tool.reason == ""
    face = tool.measurement.flange.face
    QTest.keyClick(tool.window, KEY.Key_2)
    changed = tool.measurement.flange
    assert changed.face == face
    screenshot("tool_flange")
    QTest.keyClick(tool.window, KEY.Key_Return)
    pump(50)
    made = next(obj for obj in document.Objects if getattr(obj, "ComponentId", "") == changed.id)
    assert made.Proxy.type_name == "PipeWorkbench::Flange"

    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(made)
    tool = tool_of("Flange")
    assert tool.measurement.flange.id == changed.id
    other = next(row for row, choice in enumerate(tool.measurement.choices) if choice.dimensions.flange_type != changed.flange_type)
    tool.table.selectRow(other)
    press_button(tool, "accept")
    assert contents_of(document)[changed.id]["flange_type"] != changed.flange_type
    assert contents_of(document)[changed.id]["face"] == pytest.approx(face, abs=1e-6)
    tool.close()

    final = contents_of(document)
    while document.UndoCount:
        document.undo()
    pump(100)
    assert kinds_in(document) == []
    while document.RedoCount:
        document.redo()
    pump(100)
    assert contents_of(document) == final
    path = tmp_path / "measured.FCStd"
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    opened = FreeCAD.openDocument(str(path))
    try:
        assert contents_of(opened) == final
    finally:
        FreeCAD.closeDocument(opened.Name)
