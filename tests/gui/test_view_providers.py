# SPDX-License-Identifier: LGPL-2.1-or-later
"""How document objects look in FreeCAD's window: stations in 3D, colours, selection, deleting."""

import shutil
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import pytest

import pipeworkbench
from pipeworkbench.features import make_station
from pipeworkbench.features.document import add_pipeline, components_in, pipeline_of, stations_in
from pipeworkbench.features.project import project_of
from pipeworkbench.gui.colours import colour_of
from pipeworkbench.gui.compat import QtWidgets
from pipeworkbench.gui.view_providers import colour_by, select
from pipeworkbench.pipeline import Elbow, Pipeline
from pipeworkbench.recon.station import read_station

ROOT = Path(pipeworkbench.__file__).resolve().parent.parent
EVERYTHING = Pipeline.read(ROOT / "tests" / "data" / "one_of_everything.json")


def pump(milliseconds=100):
    end = time.monotonic() + milliseconds / 1000
    while time.monotonic() < end:
        QtWidgets.QApplication.processEvents()
        time.sleep(0.005)


@pytest.fixture
def document(tmp_path):
    """A document with the sample's station and one of everything."""
    FreeCADGui.activateWorkbench("PipeWorkbench")
    shutil.copytree(ROOT / "resources" / "samples" / "dummy" / "A", tmp_path / "A")
    made = FreeCAD.newDocument("views")
    made.UndoMode = 1
    make_station(made, read_station(tmp_path / "A"))
    add_pipeline(made, EVERYTHING)
    pump(20)
    yield made
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


def nodes(obj, kind):
    """The coin nodes of a kind in an object's scene."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setType(getattr(coin, kind).getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(obj.ViewObject.RootNode)
    return [path.getTail() for path in search.getPaths()]


def test_objects_of_the_python_interface_have_their_views(document):
    assert {type(obj.ViewObject.Proxy).__name__ for obj in document.Objects} >= {"ProjectView", "StationView", "PipeView", "ConnectionsView"}
    assert all(obj.ViewObject.Visibility for obj in components_in(document))


def test_elbows_are_drawn_with_no_more_triangles_than_look_round(document):
    document.recompute()
    elbow = next(obj for obj in components_in(document) if obj.Proxy.kind is Elbow)
    (coordinates,) = nodes(elbow, "SoCoordinate3")
    points = coordinates.point.getNum()
    assert points > 100
    elbow.ViewObject.Deviation = 0.2  # FreeCAD's own
    assert coordinates.point.getNum() > 1.5 * points


def test_cameras_of_a_station_are_drawn_and_cannot_be_picked(document):
    (station,) = stations_in(document)
    (lines,) = nodes(station, "SoLineSet")
    assert lines.numVertices.getNum() == 3 * 9
    (coordinates,) = nodes(station, "SoCoordinate3")
    before = coordinates.point[1].getValue()
    station.ViewObject.CameraSize = 600
    (coordinates,) = nodes(station, "SoCoordinate3")
    centre = coordinates.point[0].getValue()
    assert [b - c for b, c in zip(coordinates.point[1].getValue(), centre, strict=True)] == pytest.approx(
        [2 * (b - c) for b, c in zip(before, centre, strict=True)], rel=1e-5
    )
    assert any(node.style.getValue() == node.UNPICKABLE for node in nodes(station, "SoPickStyle"))


def test_photograph_hangs_where_its_camera_sees_it(document):
    (station,) = stations_in(document)
    view = station.ViewObject
    assert view.Photo == "none"
    view.Photo = "right"
    view.PhotoDistance = 3000
    (mesh,) = nodes(station, "SoQuadMesh")
    points = nodes(station, "SoCoordinate3")[-1].point
    across, down = mesh.verticesPerRow.getValue(), mesh.verticesPerColumn.getValue()
    assert points.getNum() == across * down
    camera = read_station(Path(station.KnownFiles[0])).cameras[1]
    corner = camera.project([points[across * down - 1].getValue()])[0]
    assert corner == pytest.approx((camera.interior.width - 0.5, camera.interior.height - 0.5), abs=0.1)
    (texture,) = nodes(station, "SoTexture2")
    assert not texture.image.isDefault()
    view.Photo = "none"
    assert nodes(station, "SoQuadMesh") == []


def test_photograph_that_moved_away_is_told_in_the_report_view(document, tmp_path):
    (station,) = stations_in(document)
    (tmp_path / "A").rename(tmp_path / "B")
    station.ViewObject.Photo = "left"
    assert nodes(station, "SoQuadMesh") == []
    assert len(nodes(station, "SoLineSet")) == 1


def test_views_survive_saving(document, tmp_path):
    stations_in(document)[0].ViewObject.Photo = "left"
    colour_by(document, "quality")
    document.saveAs(str(tmp_path / "views.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "views.FCStd"))
    pump(200)
    (station,) = stations_in(again)
    assert station.ViewObject.Photo == "left"
    assert len(nodes(station, "SoQuadMesh")) == 1
    assert project_of(again).ColourMode == "quality"
    for obj in components_in(again):
        assert obj.ViewObject.ShapeColor[:3] == pytest.approx(colour_of(obj, "quality"), abs=0.01)


def test_colours_follow_the_mode_and_what_is_measured(document):
    pipe = next(obj for obj in components_in(document) if obj.ComponentId == "P1")
    for mode in ("loa", "kind", "quality"):
        project_of(document).ColourMode = mode  # as in the property editor
        assert pipe.ViewObject.ShapeColor[:3] == pytest.approx(colour_of(pipe, mode), abs=0.01)
    pipe.Quality = 3.0
    assert pipe.ViewObject.ShapeColor[:3] == pytest.approx(colour_of(pipe, "quality"), abs=0.01)


def test_objects_are_selected_by_name(document):
    first, second = components_in(document)[:2]
    select(document, [first.Name])
    select(document, [second.Name, "nobody"], add=True)
    assert FreeCADGui.Selection.getSelection() == [first, second]
    select(document, [second.Name])
    assert FreeCADGui.Selection.getSelection() == [second]


def test_components_that_are_moved_together_do_not_drag_each_other(document):
    objects = [obj for obj in components_in(document) if obj.ComponentId in ("E1", "P4", "E2")]
    before = [obj.Placement.Base for obj in objects]
    select(document, [obj.Name for obj in objects])
    for obj in objects:
        obj.Placement.Base = obj.Placement.Base + FreeCAD.Vector(0, 0, 40)
    assert [obj.Placement.Base.z - base.z for obj, base in zip(objects, before, strict=True)] == pytest.approx([40] * 3)
    # what is not selected follows
    p3 = next(obj for obj in components_in(document) if obj.ComponentId == "P3")
    assert p3.Placement.Base.z == pytest.approx(346)


def test_deleted_station_leaves_its_components_in_the_project(document):
    select(document, [stations_in(document)[0].Name])
    FreeCADGui.runCommand("Std_Delete")
    pump()
    assert stations_in(document) == []
    assert set(components_in(document)) <= set(project_of(document).Group)
    assert pipeline_of(document) == EVERYTHING
    document.undo()
    assert set(components_in(document)) <= set(stations_in(document)[0].Group)


def test_context_menu_takes_photographs_into_the_document_and_out(document):
    (station,) = stations_in(document)

    def texts():
        menu = QtWidgets.QMenu()
        station.ViewObject.Proxy.setupContextMenu(station.ViewObject, menu)
        return {action.text(): action for action in menu.actions()}, menu

    actions, _menu = texts()
    actions["Keep Photographs in the Document"].trigger()
    assert station.EmbedImages
    actions, _menu = texts()
    actions["Take Photographs out of the Document"].trigger()
    assert not station.EmbedImages
    document.undo()
    assert station.EmbedImages
