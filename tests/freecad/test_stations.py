# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations in a document: where their photographs are, inside it or out; the project that holds them."""

import dataclasses
import shutil
from pathlib import Path

import FreeCAD
import numpy as np
import pytest

import pipeworkbench
from pipeworkbench.errors import InputError
from pipeworkbench.features import component_of, make_pipe, make_project, make_station
from pipeworkbench.features.document import add_pipeline, components_in, connections_in, frame_of, pipeline_of, stations_in
from pipeworkbench.features.project import project_of
from pipeworkbench.features.station import cameras_of, embed_images, image_files, missing_images, release_images, relocate, station_of
from pipeworkbench.pipeline import Pipe, Pipeline, StationPose
from pipeworkbench.recon.plant import placed
from pipeworkbench.recon.station import read_station

SAMPLE = Path(pipeworkbench.__file__).resolve().parent.parent / "resources" / "samples" / "dummy" / "A"
PIPE = Pipe(id="P1", start=(0.0, 3600.0, 0.0), end=(500.0, 3600.0, 0.0), outer_diameter=48.3, station="A", pick=0)
TURNED = ((0.0, -1.0, 0.0, 5000.0), (1.0, 0.0, 0.0, -200.0), (0.0, 0.0, 1.0, 80.0), (0.0, 0.0, 0.0, 1.0))


@pytest.fixture
def folder(tmp_path):
    """A folder with the sample's station in ``A``."""
    shutil.copytree(SAMPLE, tmp_path / "job" / "A")
    return tmp_path / "job"


@pytest.fixture
def station(document, folder):
    """The sample's station in the document."""
    return make_station(document, read_station(folder / "A"))


def saved(document, path):
    """The document, saved, closed and opened again."""
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    return FreeCAD.openDocument(str(path))


def test_first_station_makes_the_project_that_holds_it(station, document):
    project = project_of(document)
    assert project.Group == [station]
    pipe = make_pipe(document, PIPE)
    other = make_pipe(document, dataclasses.replace(PIPE, id="P2", station="B"))
    assert station.Group == [pipe]
    assert project.Group == [station, other]


def test_files_are_named_relative_to_the_document_once_it_is_saved(station, document, folder):
    document.saveAs(str(folder / "job.FCStd"))
    assert (station.StationFile, station.Images) == ("A/station.json", ["A/left.jpg", "A/right.jpg", "A/top.jpg"])
    document.saveAs(str(folder / "A" / "job.FCStd"))
    assert (station.StationFile, station.Images[0]) == ("station.json", "left.jpg")
    assert missing_images(station) == []


def test_document_that_travels_with_its_photographs_finds_them(station, document, folder, tmp_path):
    saved(document, folder / "job.FCStd")
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    folder.rename(tmp_path / "elsewhere")
    (again,) = stations_in(FreeCAD.openDocument(str(tmp_path / "elsewhere" / "job.FCStd")))
    assert station_of(again).images[0] == tmp_path / "elsewhere" / "A" / "left.jpg"
    assert station_of(again).source == tmp_path / "elsewhere" / "A" / "station.json"


def test_document_that_travels_alone_finds_them_where_they_stayed(station, document, folder, tmp_path):
    again = saved(document, folder / "job.FCStd")
    FreeCAD.closeDocument(again.Name)
    (tmp_path / "far" / "away").mkdir(parents=True)
    (folder / "job.FCStd").rename(tmp_path / "far" / "away" / "job.FCStd")
    (again,) = stations_in(FreeCAD.openDocument(str(tmp_path / "far" / "away" / "job.FCStd")))
    assert station_of(again).images[0] == folder / "A" / "left.jpg"


def test_photographs_that_were_moved_away_are_asked_for_and_found_beside_one_of_them(station, folder, tmp_path):
    (folder / "A").rename(tmp_path / "moved")
    assert [path.name for path in missing_images(station)] == ["left.jpg", "right.jpg", "top.jpg"]
    with pytest.raises(InputError, match=r"left\.jpg, right\.jpg, top\.jpg cannot be found .*job/A"):
        station_of(station)
    assert len(cameras_of(station)) == 3  # the calibration is in the document
    assert relocate(station, tmp_path) != []
    assert relocate(station, tmp_path / "moved" / "right.jpg") == []
    assert station_of(station).images[2] == tmp_path / "moved" / "top.jpg"


def test_photographs_in_a_folder_of_their_own_are_found_beside_station_json(document, folder, tmp_path):
    text = (folder / "A" / "station.json").read_text(encoding="utf-8")
    (folder / "A" / "photos").mkdir()
    for name in ("left", "right", "top"):
        (folder / "A" / f"{name}.jpg").rename(folder / "A" / "photos" / f"{name}.jpg")
        text = text.replace(f'"{name}.jpg"', f'"photos/{name}.jpg"')
    (folder / "A" / "station.json").write_text(text, encoding="utf-8")
    station = make_station(document, read_station(folder / "A"))
    (folder / "A").rename(tmp_path / "moved")
    assert relocate(station, tmp_path / "moved") == []
    assert station_of(station).source == tmp_path / "moved" / "station.json"


def test_some_photographs_may_stay_missing(station, folder, tmp_path):
    (folder / "A").rename(tmp_path / "moved")
    (tmp_path / "moved" / "top.jpg").unlink()
    assert relocate(station, tmp_path / "moved") == [folder / "A" / "top.jpg"]
    assert [path.name for path in image_files(station).values() if path] == ["left.jpg", "right.jpg"]


def test_embedded_photographs_travel_inside_the_document(station, document, folder, tmp_path):
    original = (folder / "A" / "top.jpg").read_bytes()
    station.EmbedImages = True
    again = saved(document, tmp_path / "alone.FCStd")
    shutil.rmtree(folder)
    (station,) = stations_in(again)
    assert (station.EmbedImages, missing_images(station)) == (True, [])
    assert station_of(station).images[2].read_bytes() == original
    assert image_files(station)["top"].parent == Path(again.TransientDir)


def test_embedding_is_one_step_of_undo(station, document):
    document.openTransaction("Embed")
    embed_images(station)
    document.commitTransaction()
    assert "EmbeddedImage2" in station.PropertiesList
    document.undo()
    assert not station.EmbedImages
    assert all(path.suffix == ".jpg" and path.parent.name == "A" for path in image_files(station).values())
    document.redo()
    assert station.EmbedImages
    assert missing_images(station) == []


def test_photographs_leave_the_document_only_where_they_are_not_lost(station, document, folder, tmp_path):
    station.EmbedImages = True
    shutil.rmtree(folder / "A")
    station.EmbedImages = False
    assert station.EmbedImages  # the report view says why
    assert missing_images(station) == []
    (tmp_path / "out").mkdir()
    release_images(station, tmp_path / "out")
    assert not station.EmbedImages
    assert station_of(station).images[0] == tmp_path / "out" / "left.jpg"


def test_missing_photographs_cannot_be_embedded(station, folder):
    (folder / "A" / "top.jpg").unlink()
    station.EmbedImages = True
    assert not station.EmbedImages


def test_components_of_a_deleted_station_stay_and_can_be_exported(station, document):
    add_pipeline(document, Pipeline.of_station("A", (PIPE,)))
    document.openTransaction("Delete")
    document.removeObject(station.Name)
    document.commitTransaction()
    (pipe,) = components_in(document)
    assert component_of(pipe) == PIPE  # it was measured there: the name stays
    assert pipeline_of(document) == Pipeline.of_station("A", (PIPE,))
    pipe.Length = 700
    document.recompute()
    assert not [obj.Label for obj in document.Objects if "Invalid" in obj.State]
    document.undo()
    assert stations_in(document)[0].Group == [pipe]


def test_merged_stations_stand_where_the_pipeline_has_them(station, document):
    merged = Pipeline(
        frame="B",
        components=(PIPE,),
        stations={"B": StationPose(frame_from_level=tuple(map(tuple, np.eye(4).tolist()))), "A": StationPose(frame_from_level=TURNED)},
    )
    add_pipeline(document, merged)
    assert frame_of(station).frame_from_level == TURNED
    assert station.Pose.multVec(FreeCAD.Vector(0, 0, 0)).isEqual(FreeCAD.Vector(5000, -200, 80), 1e-9)
    assert connections_in(document)["B"] in project_of(document).Group


def test_georeference_stays_with_the_project(station, document, tmp_path):
    in_plant = placed(Pipeline.of_station("A", (PIPE,)), TURNED, "unit 3")
    add_pipeline(document, in_plant)
    project = project_of(document)
    assert project.PlantSystem == "unit 3"
    assert project.PlantPlacement.Base.isEqual(FreeCAD.Vector(5000, -200, 80), 1e-9)
    assert pipeline_of(saved(document, tmp_path / "plant.FCStd")).extra["georeference"]["plant_from_frame"] == [list(row) for row in TURNED]


def test_georeference_that_does_not_fit_is_refused(document):
    with pytest.raises(InputError, match="4 x 4"):
        make_project(document, georeference={"system": "x", "frame": "A", "plant_from_frame": [[1.0]]})
    with pytest.raises(InputError, match="give system"):
        make_project(document, georeference={"frame": "A"})


def test_project_is_made_once(document):
    project = make_project(document, "boiler house")
    assert make_project(document) == project
    assert project.ProjectName == "boiler house"
