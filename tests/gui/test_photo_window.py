# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window with real mouse and key events: looking, snapping, clicking, selecting, and being closed at any moment."""

import json
import shutil

import FreeCAD
import FreeCADGui
import numpy as np
import pytest
from window import LEFT, ROOT, SAMPLE, QTest, choose_file, later, press, pump, screenshot, wait_until, when_dialog_opens

from pipeworkbench.commands.import_station import import_station
from pipeworkbench.features.document import components_in
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, device_pixel_ratio, is_alive
from pipeworkbench.gui.photos.contours import Colouring
from pipeworkbench.gui.photos.windows import mdi_area, open_photo_window, photo_window

Qt = QtCore.Qt
RIGHT, MIDDLE = Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton
NONE, CONTROL = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
REDUCTION = 4  # of the sample's photographs: the tests are about the window, not about five megapixels
SIZE = (648, 486)
MIDDLE_OF_IT = (325.0, 225.0)
ON_PIPE = (475.0, 300.0)  # beside the sample's upright pipe, in the left photograph


class Heard:
    """What a window's signals have told."""

    def __init__(self, window):
        self.clicks, self.pointed, self.keys, self.selected = [], [], [], []
        window.clicked.connect(self.clicks.append)
        window.pointed.connect(self.pointed.append)
        window.accepted.connect(lambda: self.keys.append("accepted"))
        window.stepped_back.connect(lambda: self.keys.append("stepped back"))
        window.digit_pressed.connect(self.keys.append)
        window.component_clicked.connect(lambda name, adds: self.selected.append((name, adds)))


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The sample with small photographs."""
    import cv2

    folder = tmp_path_factory.mktemp("small")
    data = json.loads((SAMPLE / "station.json").read_text(encoding="utf-8"))
    for camera in data["cameras"]:
        grey = cv2.imread(str(SAMPLE / camera["image"]), cv2.IMREAD_GRAYSCALE)
        cv2.imwrite(str(folder / camera["image"]), cv2.resize(grey, SIZE, interpolation=cv2.INTER_AREA))
        camera["width"], camera["height"] = SIZE
        camera["interior"]["pixel_pitch"] *= REDUCTION
    (folder / "station.json").write_text(json.dumps(data), encoding="utf-8")
    return folder


@pytest.fixture
def station(document, small):
    """A station in a document."""
    return import_station(small / "station.json", document)


@pytest.fixture
def window(station):
    """A photo window with its photographs."""
    made = open_photo_window(station)
    assert wait_until(lambda: all(canvas.picture for canvas in made.canvases))
    return made


@pytest.fixture
def measured(window):
    """A photo window with its edges."""
    assert wait_until(lambda: window.views is not None)
    return window


def photograph_tabs():
    """Return the titles of the photo windows in FreeCAD's window, and of tabs that are left of some."""
    area = mdi_area()
    tabs = [bar.tabText(number) for bar in area.findChildren(QtWidgets.QTabBar) for number in range(bar.count())]
    windows = [sub_window.windowTitle() for sub_window in area.subWindowList()]
    return sorted({title for title in (*tabs, *windows) if "photographs" in title})


class Shown:
    """What a canvas shows now: colours at its own places, and whether it is the same as before."""

    def __init__(self, canvas):
        self.image = canvas.grab().toImage()
        self.ratio = device_pixel_ratio(canvas)

    def at(self, point):
        return self.image.pixelColor(int((point.x() + 0.5) * self.ratio), int((point.y() + 0.5) * self.ratio))

    def near(self, point):
        """Return the colours of the screen's own pixels above and below a place."""
        u, v = int((point.x() + 0.5) * self.ratio), int((point.y() + 0.5) * self.ratio)
        return [self.image.pixelColor(u, v + step) for step in range(-3, 4)]

    def __eq__(self, other):
        return self.image == other.image

    __hash__ = None


def place(canvas, point):
    """Return where a pixel of the photograph is, in whole pixels of the canvas."""
    return canvas.screen_at(point).toPoint()


def drag(canvas, button, way, start=(200, 200)):
    QTest.mousePress(canvas, button, NONE, QtCore.QPoint(*start))
    # QTest's moves tell of no buttons
    for part in (0.5, 1.0):
        to = QtCore.QPointF(start[0] + part * way[0], start[1] + part * way[1])
        move = QtGui.QMouseEvent(QtCore.QEvent.Type.MouseMove, to, canvas.mapToGlobal(to.toPoint()), button, button, NONE)
        QtWidgets.QApplication.sendEvent(canvas, move)
    QTest.mouseRelease(canvas, button, NONE, QtCore.QPoint(start[0] + way[0], start[1] + way[1]))


def turn_wheel(canvas, point, notches):
    at = canvas.screen_at(point)
    event = QtGui.QWheelEvent(
        at,
        QtCore.QPointF(canvas.mapToGlobal(at.toPoint())),
        QtCore.QPoint(),
        QtCore.QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        NONE,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QtWidgets.QApplication.sendEvent(canvas, event)


@pytest.fixture
def pipeline(document, window):
    """A window over the sample with its pipes, as a reconstruction left them."""
    from pipeworkbench.features.document import add_pipeline
    from pipeworkbench.gui.view_providers import show
    from pipeworkbench.pipeline import Pipe, Pipeline

    name = window.station.name
    # pipes across the view at 4 m, whatever the sample shows there
    pipes = [
        Pipe(id=f"P{i}", start=(-500.0, 4000.0, z), end=(500.0, 4000.0, z), outer_diameter=114.3, wall_thickness=3.6, dn=100, station=name, quality=q)
        for i, (z, q) in enumerate(((300.0, 0.3), (0.0, 1.5)))
    ]
    document.openTransaction("Pipes")
    for obj in add_pipeline(document, Pipeline.of_station(name, pipes)):
        show(obj)
    document.recompute()
    document.commitTransaction()
    assert wait_until(lambda: len(window.contours._shown) == 2 and window.contours.up_to_date)
    return window


def contour_point(window, name, camera="left"):
    """Return a pixel on a component's visible contour."""
    line = next(shown for shown in window.contours._shown if shown.name == name).curves[camera].seen[0]
    middle = len(line) // 2
    return tuple(line[middle - 1 : middle + 1].mean(axis=0))


# opening


def test_import_station_opens_the_window_with_all_photographs(document):
    opened = when_dialog_opens(QtWidgets.QFileDialog, choose_file(SAMPLE / "station.json"))
    press("Import Station")
    assert opened
    window = photo_window()
    assert window is not None
    assert [canvas.camera for canvas in window.canvases] == ["left", "right", "top"]
    assert wait_until(lambda: all(canvas.picture for canvas in window.canvases))
    assert all(canvas.picture.size == (2592, 1944) for canvas in window.canvases)
    assert window.parent() in FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).subWindowList()
    screenshot("photo_window")


def test_the_command_raises_the_window_that_is_open(window):
    window.parent().showMinimized()
    press("Photo Window")
    assert photo_window() is window
    assert window.parent().isActiveWindow() or window.parent() is FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).activeSubWindow()
    # Qt deletes closed windows of other tests when it gets to it
    every = FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).findChildren(type(window))
    assert [one for one in every if not one.is_closed] == [window]


def test_what_is_painted_is_the_photograph(window):
    canvas = window.canvases[0]
    window.show_place("left", (325.0, 242.0), 8.0)
    pump()
    shown = Shown(canvas)
    for point in ((325, 242), (335, 247), (310, 232)):
        at = place(canvas, point)
        low, high = canvas.picture.range
        expected = np.clip((canvas.picture.value_at(*point) - low) / (high - low), 0, 1) * 255
        assert shown.at(at).red() == pytest.approx(expected, abs=1.5)
    # one pixel of the photograph is one even square: nearest neighbour
    corner = canvas.screen_at((324.6, 241.6)).toPoint()
    assert len({shown.at(corner + QtCore.QPoint(i, i)).red() for i in range(6)}) == 1


def test_a_station_of_two_cameras_has_two_photographs(document, small, tmp_path):
    shutil.copytree(small, tmp_path / "two")
    data = json.loads((small / "station.json").read_text(encoding="utf-8"))
    data["cameras"] = data["cameras"][:2]
    (tmp_path / "two" / "station.json").write_text(json.dumps(data), encoding="utf-8")
    window = open_photo_window(import_station(tmp_path / "two" / "station.json", document))
    assert len(window.canvases) == 2
    assert wait_until(lambda: all(canvas.picture for canvas in window.canvases))


# looking


def test_wheel_zooms_to_the_pointer_and_all_photographs_alike(window):
    left, right, _ = window.canvases
    fitting = left.scale
    before = place(left, (175.0, 125.0))
    turn_wheel(left, (175.0, 125.0), 5)
    assert left.scale == pytest.approx(fitting * 1.25**5)
    assert right.scale == left.scale
    assert (place(left, (175.0, 125.0)) - before).manhattanLength() <= 1
    turn_wheel(left, (175.0, 125.0), -40)
    assert left.scale >= 0.49 * fitting
    turn_wheel(left, (175.0, 125.0), 200)
    assert left.scale == 64


@pytest.mark.parametrize("button", [MIDDLE, RIGHT])
def test_middle_and_right_button_pan(window, button):
    heard = Heard(window)
    canvas = window.canvases[0]
    window.show_place("left", MIDDLE_OF_IT, 1.0)
    drag(canvas, button, (60, 40))
    assert canvas.centre == pytest.approx((265.0, 185.0))
    assert heard.clicks == []


def test_space_lets_the_left_button_pan(window):
    heard = Heard(window)
    canvas = window.canvases[0]
    window.show_place("left", MIDDLE_OF_IT, 1.0)
    QTest.keyPress(canvas, Qt.Key.Key_Space)
    drag(canvas, LEFT, (50, 0))
    QTest.keyRelease(canvas, Qt.Key.Key_Space)
    assert canvas.centre == pytest.approx((275.0, 225.0))
    assert heard.clicks == []
    drag(canvas, LEFT, (50, 0))
    assert canvas.centre == pytest.approx((275.0, 225.0))


def test_keys_for_fit_and_one_to_one(window):
    canvas = window.canvases[1]
    fitting = canvas.scale
    QTest.keyClick(canvas, Qt.Key.Key_1, CONTROL)
    assert canvas.scale == pytest.approx(1 / device_pixel_ratio(canvas))
    QTest.keyClick(canvas, Qt.Key.Key_F)
    assert canvas.scale == pytest.approx(fitting)
    assert canvas.centre == pytest.approx((323.5, 242.5))


def test_linked_photographs_show_the_same_object(pipeline):
    left, right, _ = pipeline.canvases
    point = contour_point(pipeline, components_in(pipeline.station_object.Document)[0].Name)
    pipeline.toolbar.linked.setChecked(True)
    pipeline.show_place("left", point, 1.0)
    source, target = pipeline.station.cameras[:2]
    ray = source.rays(np.array([point]))[0]
    at_four_metres = source.projection_centre + ray * (4000 - source.projection_centre[1]) / ray[1]
    assert right.centre == pytest.approx(target.project(at_four_metres[None])[0], abs=15)
    assert right.scale == left.scale == 1.0


def test_lines_out_of_sight_are_brought_into_it_at_the_same_scale(window):
    window.show_place("left", (100.0, 100.0), 4.0)
    before = {canvas.camera: canvas.centre for canvas in window.canvases}
    line = np.array([[500.0, 400.0], [560.0, 420.0]])
    window.reveal({canvas.camera: [line] for canvas in window.canvases}, still="left")
    assert window.canvas("left").centre == before["left"]
    for camera in ("right", "top"):
        canvas = window.canvas(camera)
        assert canvas.centre == pytest.approx((530.0, 410.0))
        assert canvas.rect().contains(place(canvas, (530.0, 410.0)))
    assert {canvas.scale for canvas in window.canvases} == {4.0}
    # what is in sight stays where it is
    window.reveal({"right": [line + 3.0]})
    assert window.canvas("right").centre == pytest.approx((530.0, 410.0))
    # and so does a photograph of which no part shows more of something large
    large = np.column_stack([np.linspace(0, 647, 50), np.full(50, 410.0)])
    window.reveal({"right": [large]})
    assert window.canvas("right").centre == pytest.approx((530.0, 410.0))


def test_contrast_and_gamma_change_what_is_shown(window):
    canvas = window.canvases[0]
    pump()

    def brightness():
        shown = Shown(canvas)
        return np.mean([shown.at(QtCore.QPoint(u, canvas.height() // 2)).red() for u in range(20, canvas.width() - 20, 3)])

    plain = brightness()
    window.toolbar.gamma.set_number(2.5)
    assert brightness() > plain + 10
    window.toolbar.gamma.reset()
    assert brightness() == pytest.approx(plain, abs=0.5)
    window.toolbar.contrast.set_number(0.25)
    assert abs(brightness() - 127) < abs(plain - 127)


def test_loupe_shows_the_pixels_at_the_pointer(window):
    canvas = window.canvases[0]
    # the middle: how wide the canvas is, and where the photograph ends, depends on what else is open
    middle = QtCore.QPoint(canvas.width() // 2, canvas.height() // 2)
    QTest.mouseMove(canvas, middle)
    # a pointer's place is in whole pixels of the screen, which may be other than the widget's
    assert wait_until(lambda: canvas.pointer is not None and (canvas.pointer - QtCore.QPointF(middle)).manhattanLength() < 3)
    grid = [QtCore.QPoint(u, v) for u in range(5, canvas.width() - 5, 10) for v in range(5, canvas.height() - 5, 10)]
    plain = Shown(canvas)
    QTest.keyClick(canvas, Qt.Key.Key_L)
    assert window.toolbar.loupe.isChecked()
    enlarged = Shown(canvas)
    changed = [at for at in grid if enlarged.at(at) != plain.at(at)]
    assert len(changed) > 40
    assert all((at - middle).manhattanLength() < 500 for at in changed)
    QTest.keyClick(canvas, Qt.Key.Key_L)
    assert not window.toolbar.loupe.isChecked()


def test_status_line_tells_camera_pixel_and_grey_value(window):
    canvas = window.canvases[1]
    window.show_place("right", (250.0, 200.0), 4.0)
    QTest.mouseMove(canvas, place(canvas, (253.0, 202.0)))
    assert wait_until(lambda: canvas.pointer is not None and "grey" in window.status.place.text())
    text = window.status.place.text()
    assert text.startswith("right")
    assert f"grey {canvas.picture.value_at(253, 202)}" in text
    assert "400 %" in text


# clicking with a tool


def test_edge_under_the_pointer_is_shown_before_the_click(measured):
    window = measured
    heard = Heard(window)
    window.set_tool(True, snapping=True, hint="Click an edge")
    canvas = window.canvases[0]
    edges = window.edges("left")
    near = np.linalg.norm(edges.position - ON_PIPE, axis=1) < 75
    strongest = edges.position[np.flatnonzero(near)[edges.contrast[near].argmax()]]
    window.show_place("left", tuple(strongest), 2.0)
    QTest.mouseMove(canvas, QtCore.QPoint(40, 40))
    QTest.mouseMove(canvas, place(canvas, strongest) + QtCore.QPoint(4, 0))
    assert wait_until(lambda: heard.pointed and heard.pointed[-1].edge is not None)
    edge = heard.pointed[-1].edge
    assert edge.distance < 3
    assert not window.layer("snap").is_empty("left")
    QTest.mouseClick(canvas, LEFT, NONE, place(canvas, strongest) + QtCore.QPoint(4, 0))
    assert len(heard.clicks) == 1
    assert heard.clicks[0].camera == "left"
    assert heard.clicks[0].edge.row == edge.row
    assert heard.clicks[0].point == pytest.approx(tuple(strongest + np.array([2.0, 0.0])), abs=1.0)
    assert window.status.hint.text() == "Click an edge"
    window.set_tool(False)
    assert window.layer("snap").is_empty("left")
    assert window.status.hint.text() == ""


def test_double_click_is_one_click(window):
    heard = Heard(window)
    window.set_tool(True)
    canvas = window.canvases[0]
    at = place(canvas, MIDDLE_OF_IT)
    QTest.mouseClick(canvas, LEFT, NONE, at)
    second = (QtCore.QPointF(at), QtCore.QPointF(canvas.mapToGlobal(at)), LEFT)
    for kind, held in ((QtCore.QEvent.Type.MouseButtonDblClick, LEFT), (QtCore.QEvent.Type.MouseButtonRelease, Qt.MouseButton.NoButton)):
        QtWidgets.QApplication.sendEvent(canvas, QtGui.QMouseEvent(kind, *second, held, NONE))
    assert len(heard.clicks) == 1
    QTest.mouseClick(canvas, LEFT, NONE, at)
    assert len(heard.clicks) == 2


def test_click_beside_the_photograph_is_none_and_says_so(window):
    heard = Heard(window)
    window.set_tool(True, hint="Click a pipe")
    canvas = window.canvases[0]
    assert not canvas.contains(canvas.photograph_at(QtCore.QPointF(5, 5)))
    QTest.mouseClick(canvas, LEFT, NONE, QtCore.QPoint(5, 5))
    assert heard.clicks == []
    assert "beside" in window.status.hint.text()


def test_keys_tell_the_tool(window):
    heard = Heard(window)
    canvas = window.canvases[0]
    canvas.setFocus()
    view = FreeCADGui.ActiveDocument.ActiveView if FreeCADGui.ActiveDocument else None
    before = view.getCamera() if hasattr(view, "getCamera") else None
    for key in (Qt.Key.Key_Return, Qt.Key.Key_Escape, Qt.Key.Key_3, Qt.Key.Key_Enter, Qt.Key.Key_9):
        QTest.keyClick(canvas, key)
    assert heard.keys == ["accepted", "stepped back", 3, "accepted", 9]
    assert before is None or view.getCamera() == before  # FreeCAD's digits turn the 3D view


def test_search_band_is_shown_in_the_other_photographs(window):
    canvas = window.canvases[0]
    window.toolbar.layers["epipolar"].setChecked(True)
    QTest.mouseMove(canvas, QtCore.QPoint(30, 200))
    QTest.mouseMove(canvas, place(canvas, MIDDLE_OF_IT))
    layer = window.layer("epipolar")
    assert wait_until(lambda: not layer.is_empty("right"))
    assert layer.is_empty("left")
    assert not layer.is_empty("right")
    assert not layer.is_empty("top")
    window.toolbar.layers["epipolar"].setChecked(False)
    pump(20)
    assert layer.is_empty("right")


# layers


def test_layers_draw_where_they_are_told_and_can_be_switched(window):
    canvas = window.canvases[2]
    window.show_place("top", MIDDLE_OF_IT, 2.0)
    pump()
    plain = Shown(canvas)
    layer = window.layer("made up")
    assert window.layer("made up") is layer
    line = np.array([[275.0, 225.0], [375.0, 225.0]])
    layer.set_polylines("top", [line], "#ff0000", width=3)
    at = place(canvas, MIDDLE_OF_IT)
    assert Shown(canvas).at(at).red() > 240
    layer.visible = False
    assert Shown(canvas).at(at) == plain.at(at)
    layer.visible = True
    layer.set_polylines("top", [line + np.array([0.0, 30.0])], "#ff0000", width=3)
    assert Shown(canvas).at(at) == plain.at(at)
    layer.set_points("top", np.array([[325.0, 195.0]]), "#00ff00", labels=["P 1"])
    layer.set_vectors("top", np.array([[305.0, 225.0]]), np.array([[305.2, 225.0]]), "#0000ff")
    layer.vector_scale = 200.0  # 0.2 px become 40 px, 80 on the screen
    drawn = Shown(canvas)
    assert any(colour.blue() > colour.red() + 60 for colour in drawn.near(place(canvas, (320.0, 225.0))))
    layer.clear("top")
    assert Shown(canvas) == plain


@pytest.mark.parametrize("scale", [0.3, 6.0])
def test_edges_are_drawn_from_afar_and_near_by(measured, scale):
    window = measured
    canvas = window.canvases[0]
    window.show_place("left", ON_PIPE, scale)
    plain = Shown(canvas)
    window.toolbar.layers["edges"].setChecked(True)
    drawn = Shown(canvas)
    assert drawn != plain
    colours = [drawn.at(QtCore.QPoint(u, v)) for u in range(0, canvas.width(), 2) for v in range(0, canvas.height(), 2)]
    assert sum(colour.red() > colour.blue() + 40 for colour in colours) > 20


# the document


def test_contours_follow_the_document_through_undo_and_redo(pipeline):
    document = pipeline.station_object.Document
    first, second = (obj.Name for obj in components_in(document))
    above, below = contour_point(pipeline, first), contour_point(pipeline, second)

    def drawn_at(point):
        return pipeline.contours.nearest("left", point, 4.0)

    assert (drawn_at(above), drawn_at(below)) == (first, second)
    document.openTransaction("Thicker")
    document.getObject(first).OutsideDiameter = 219.1
    document.recompute()
    document.commitTransaction()
    assert wait_until(lambda: drawn_at(above) is None)
    QTest.keyClick(pipeline.canvases[0], Qt.Key.Key_Z, CONTROL)
    assert document.getObject(first).OutsideDiameter.Value == pytest.approx(114.3)
    assert wait_until(lambda: drawn_at(above) == first)
    QTest.keyClick(pipeline.canvases[0], Qt.Key.Key_Y, CONTROL)
    assert wait_until(lambda: drawn_at(above) is None)
    document.undo()
    document.undo()
    assert wait_until(lambda: pipeline.contours._shown == [])
    document.redo()
    assert wait_until(lambda: drawn_at(above) == first)
    document.getObject(second).ViewObject.Visibility = False
    assert wait_until(lambda: drawn_at(below) is None)
    document.removeObject(first)
    assert wait_until(lambda: drawn_at(above) is None)


def test_contours_are_not_computed_anew_for_what_changes_no_component(pipeline, monkeypatch):
    from pipeworkbench.gui.photos import contours

    computed, compute = [], contours.component_curves
    monkeypatch.setattr(contours, "component_curves", lambda station, placed: computed.append(placed) or compute(station, placed))
    pipe = components_in(pipeline.station_object.Document)[0]
    pipe.Label = "the upper one"
    assert wait_until(lambda: pipeline.contours.label_of(pipe.Name) == "the upper one")
    assert computed == []
    pipe.OutsideDiameter = 88.9
    pipe.Document.recompute()
    assert wait_until(lambda: pipeline.contours._shown[0].component.outer_diameter == 88.9)
    assert computed


def test_clicking_a_contour_selects_the_object_and_back(pipeline):
    document = pipeline.station_object.Document
    heard = Heard(pipeline)
    first, second = (obj.Name for obj in components_in(document))
    canvas = pipeline.canvases[0]

    def selected():
        return [obj.Name for obj in FreeCADGui.Selection.getSelection(document.Name)]

    QTest.mouseClick(canvas, LEFT, NONE, place(canvas, contour_point(pipeline, first)))
    assert selected() == [first]
    QTest.mouseClick(canvas, LEFT, CONTROL, place(canvas, contour_point(pipeline, second)))
    assert selected() == [first, second]
    assert heard.selected == [(first, False), (second, True)]
    pump(50)
    screenshot("photo_window_selected")
    QTest.mouseClick(canvas, LEFT, NONE, place(canvas, (75.0, 425.0)))
    assert selected() == []
    # the other way round: selected in the tree, shown in the photographs
    pump(50)
    plain = Shown(canvas)
    FreeCADGui.Selection.addSelection(document.Name, first)
    pump(50)
    assert Shown(canvas) != plain
    # a tool takes the clicks for itself
    FreeCADGui.Selection.clearSelection(document.Name)
    pipeline.set_tool(True)
    QTest.mouseClick(canvas, LEFT, NONE, place(canvas, contour_point(pipeline, second)))
    assert selected() == []
    assert len(heard.selected) == 2


def test_contours_tell_kind_or_quality(pipeline):
    canvas = pipeline.canvases[0]
    by_kind = Shown(canvas)
    pipeline.toolbar.colouring.setCurrentIndex(1)
    assert pipeline.contours.colouring is Colouring.QUALITY
    pump(20)
    assert Shown(canvas) != by_kind
    pipeline.toolbar.colouring.setCurrentIndex(0)
    pump(20)
    assert Shown(canvas) == by_kind


# ends


def test_window_closed_while_it_is_loading_leaves_nothing_behind(document):
    window = open_photo_window(import_station(SAMPLE / "station.json", document))
    closed = []
    window.closed.connect(lambda: closed.append(True))
    later(window.parent().close)
    assert wait_until(lambda: not is_alive(window))
    assert closed == [True]
    assert photo_window() is not window
    document.addObject("App::FeaturePython", "Other")  # the observers are gone
    FreeCADGui.Selection.addSelection(document.Name, "Station")
    pump(100)


def test_window_can_be_opened_again_after_it_was_closed(window):
    station = window.station_object
    later(window.parent().close)
    assert wait_until(lambda: not is_alive(window))
    again = open_photo_window(station)
    assert again is not window
    assert wait_until(lambda: all(canvas.picture for canvas in again.canvases))


def test_window_closes_with_its_station(document, window):
    document.removeObject(window.station_object.Name)
    assert wait_until(lambda: not is_alive(window))
    assert photo_window() is not window


def test_window_closes_when_the_import_is_undone(document, window):
    QTest.keyClick(window.canvases[0], Qt.Key.Key_Z, CONTROL)
    assert document.Objects == []
    assert wait_until(lambda: not is_alive(window))


def test_window_closes_with_its_document(small):
    made = FreeCAD.newDocument("closing")
    window = open_photo_window(import_station(small / "station.json", made))
    FreeCAD.closeDocument(made.Name)
    assert wait_until(lambda: not is_alive(window))
    assert photograph_tabs() == []


def test_tab_goes_with_the_photographs_whoever_closes_them(window):
    assert len(photograph_tabs()) == 1
    window.close()
    assert photo_window() is None
    assert wait_until(lambda: photograph_tabs() == [])
    assert wait_until(lambda: not is_alive(window))


def test_worker_that_waits_for_edges_is_told_when_the_window_is_closed(document):
    import threading

    from pipeworkbench.errors import PipeWorkbenchError

    window = open_photo_window(import_station(SAMPLE / "station.json", document))
    told = []

    def work():
        try:
            told.append(window.wait_for_views())
        except PipeWorkbenchError as error:
            told.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    window.parent().close()
    assert wait_until(lambda: not thread.is_alive())
    assert len(told) == 1


def test_photographs_that_were_moved_are_named_and_found(document, small, tmp_path):
    shutil.copytree(small, tmp_path / "there")
    station = import_station(tmp_path / "there" / "station.json", document)
    (tmp_path / "elsewhere").mkdir()
    for name in ("left.jpg", "top.jpg"):
        (tmp_path / "there" / name).rename(tmp_path / "elsewhere" / name)
    window = open_photo_window(station)
    assert window.is_missing
    assert "left.jpg" in window._missing.text.text()
    assert "right.jpg" not in window._missing.text.text()
    screenshot("photo_window_missing")
    when_dialog_opens(QtWidgets.QFileDialog, choose_file(tmp_path / "elsewhere"))
    QTest.mouseClick(window._missing.button, LEFT)
    assert wait_until(lambda: not window.is_missing and all(canvas.picture for canvas in window.canvases))


def test_damaged_photograph_is_told_where_it_would_be(document, small, tmp_path):
    shutil.copytree(small, tmp_path / "bad")
    (tmp_path / "bad" / "right.jpg").write_bytes(b"no photograph")
    window = open_photo_window(import_station(tmp_path / "bad" / "station.json", document))
    assert wait_until(lambda: window.canvases[0].picture and window.canvases[2].picture and window.canvases[1]._problem)
    assert "right.jpg" in window.canvases[1]._problem


def test_icons_of_the_toolbar_are_there(window):
    actions = [action for action in window.toolbar.actions() if not action.isSeparator() and action.text()]
    assert len(actions) >= 9
    for action in actions:
        assert action.toolTip()
        image = action.icon().pixmap(18, 18).toImage()
        assert any(image.pixelColor(u, v).alpha() > 100 for u in range(image.width()) for v in range(image.height()))
    assert (ROOT / "resources" / "icons" / "photo_window.svg").is_file()
