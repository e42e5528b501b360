# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents of older versions are brought up to date, those of newer ones are left as they are."""

import shutil
from pathlib import Path

import FreeCAD
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.features import component_of, make_cap, make_project, set_component
from pipeworkbench.features.base import newer_objects
from pipeworkbench.features.document import add_pipeline, components_in, connections_in, pipeline_of, stations_in
from pipeworkbench.features.joints import joints_of
from pipeworkbench.features.project import project_of
from pipeworkbench.features.station import image_files, station_of
from pipeworkbench.pipeline import Pipeline

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = ROOT / "tests" / "data"
EVERYTHING = Pipeline.read(DATA / "one_of_everything.json")
BY_ID = {component.id: component for component in EVERYTHING.components}


@pytest.fixture
def old(tmp_path):
    """A document of schema 2 (before joints were links), beside the folder of its station; afterwards all are closed."""
    shutil.copy(DATA / "schema_2.FCStd", tmp_path)
    shutil.copytree(ROOT / "resources" / "samples" / "dummy" / "A", tmp_path / "A")
    yield FreeCAD.openDocument(str(tmp_path / "schema_2.FCStd"))
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


def test_old_document_keeps_all_that_it_held(old):
    assert pipeline_of(old) == EVERYTHING
    assert not [obj.Label for obj in old.Objects if "Invalid" in obj.State]


def test_old_joints_become_links_and_carry(old):
    objects = {obj.ComponentId: obj for obj in components_in(old)}
    assert sum(len(list(joints_of(obj))) for obj in objects.values()) == 2 * len(EVERYTHING.joints)
    assert "Joints" not in connections_in(old)["A"].PropertiesList
    old.recompute()
    objects["P3"].NominalDiameter = "DN 32"
    old.recompute()
    assert objects["E2"].OutsideDiameter.Value == 42.4
    assert not [obj.Label for obj in old.Objects if "Invalid" in obj.State]


def test_old_texts_become_enumerations(old):
    objects = {obj.ComponentId: obj for obj in components_in(old)}
    assert (objects["F1"].FlangeType, objects["F1"].PN, objects["F1"].Standard) == ("11", "PN 16", "EN 1092-1")
    assert objects["E1"].BendType == "3D"
    assert {obj.SchemaVersion for obj in objects.values()} == {3}


def test_old_station_finds_its_photographs_and_takes_its_calibration_in(old, tmp_path):
    (station,) = stations_in(old)
    assert [camera.name for camera in station_of(station).cameras] == ["left", "right", "top"]
    assert image_files(station)["top"] == tmp_path / "A" / "top.jpg"
    (tmp_path / "A" / "station.json").unlink()
    assert len(station_of(station).images) == 3


def test_document_without_a_project_works_and_may_get_one(old):
    assert project_of(old) is None
    project = make_project(old, "boiler house")
    assert project_of(old) == project
    assert pipeline_of(old) == EVERYTHING


@pytest.fixture
def newer(document, tmp_path):
    """One of everything, saved by a newer version with a property that this one does not know."""
    objects = add_pipeline(document, EVERYTHING)
    document.recompute()
    for obj in objects[:2]:
        obj.addProperty("App::PropertyString", "Novelty", "Pipe", "").Novelty = "of a later day"
        obj.Proxy.state = {"later": [1, 2]}
        obj.SchemaVersion = 99
    path = tmp_path / "newer.FCStd"
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    return FreeCAD.openDocument(str(path))


def test_newer_objects_are_shown_but_neither_touched_nor_edited(newer):
    objects = newer_objects(newer)
    assert [obj.ComponentId for obj in objects] == ["F1", "F2"]
    volume, length = objects[0].Shape.Volume, objects[0].Length.Value
    assert objects[0].getEditorMode("OutsideDiameter") == ["ReadOnly"]
    objects[0].OutsideDiameter = 88.9
    newer.recompute(None, True)
    assert (objects[0].Shape.Volume, objects[0].Length.Value, objects[0].SchemaVersion) == (volume, length, 99)
    assert not [obj.Label for obj in newer.Objects if "Invalid" in obj.State]


def test_editing_newer_objects_is_refused_with_what_to_do(newer):
    flange = newer_objects(newer)[0]
    for refused in (lambda: set_component(flange, BY_ID["F1"]), lambda: component_of(flange), lambda: pipeline_of(newer)):
        with pytest.raises(InputError, match=r"SchemaVersion: is 99, .* update the Pipe Workbench"):
            refused()
    with pytest.raises(InputError, match="SchemaVersion"):
        add_pipeline(newer, EVERYTHING)


@pytest.mark.parametrize("kind", ["Connections", "Project"])
def test_newer_connections_and_projects_are_left_alone(document, tmp_path, kind):
    make_project(document)
    pipe = add_pipeline(document, EVERYTHING)[2]
    document.getObject(kind).SchemaVersion = 99
    document.saveAs(str(tmp_path / "newer.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "newer.FCStd"))
    pipe = next(obj for obj in components_in(again) if obj.ComponentId == "P1")
    pipe.NominalDiameter = "DN 65"
    if kind == "Connections":
        with pytest.raises(InputError, match="SchemaVersion"):
            pipeline_of(again)
    else:
        assert pipeline_of(again).joints == EVERYTHING.joints
        with pytest.raises(InputError, match="SchemaVersion"):
            make_project(again, "another name")
    assert again.getObject(kind).SchemaVersion == 99


def test_newer_objects_are_not_dragged(newer):
    objects = {obj.ComponentId: obj for obj in components_in(newer)}
    objects["P1"].NominalDiameter = "DN 65"
    assert (objects["P1"].OutsideDiameter.Value, objects["F1"].OutsideDiameter.Value) == (76.1, 60.3)


def test_saving_loses_nothing_of_newer_objects(newer, tmp_path):
    newer.saveAs(str(tmp_path / "again.FCStd"))
    FreeCAD.closeDocument(newer.Name)
    again = FreeCAD.openDocument(str(tmp_path / "again.FCStd"))
    flange = newer_objects(again)[0]
    assert (flange.Novelty, flange.SchemaVersion, flange.Proxy.state["later"]) == ("of a later day", 99, [1, 2])
    assert flange.Shape.isValid()


def test_rest_of_a_newer_document_can_be_edited(newer):
    cap = next(obj for obj in components_in(newer) if obj.ComponentId == "C1")
    cap.Length = 40
    newer.recompute()
    assert component_of(cap).length == 40
    with pytest.raises(InputError, match="already"):
        make_cap(newer, BY_ID["C1"])
