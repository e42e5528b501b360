# SPDX-License-Identifier: LGPL-2.1-or-later
"""The addon's metadata as FreeCAD reads it, and the sample through a document."""

import re
from pathlib import Path

import FreeCAD

import pipeworkbench
from pipeworkbench.features.document import add_station, stations_in
from pipeworkbench.features.station import station_of
from pipeworkbench.recon.station import read_station

ROOT = Path(pipeworkbench.__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "dummy" / "A"


def test_freecad_reads_package_xml():
    metadata = FreeCAD.Metadata(str(ROOT / "package.xml"))
    assert metadata.Name == "Pipe Workbench"
    assert metadata.Version == pipeworkbench.__version__
    workbench = metadata.Content["workbench"][0]
    assert workbench.Classname == "PipeWorkbench"
    assert (ROOT / workbench.Icon).is_file()
    assert metadata.License[0]["name"] == "LGPL-2.1-or-later"
    assert (ROOT / metadata.License[0]["file"]).is_file()
    assert any(url["type"] == "repository" and url["branch"] for url in metadata.Urls)


def test_package_xml_names_every_dependency_of_the_project():
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    wanted = set(re.findall(r'^  "([a-z0-9-]+)[><]', project.split("dependencies = [")[1].split("]\n")[0], re.MULTILINE))
    named = set(re.findall(r'<depend type="python">([a-z0-9-]+)</depend>', (ROOT / "package.xml").read_text(encoding="utf-8")))
    assert named == wanted


def test_station_object_finds_its_photographs_again(tmp_path):
    document = FreeCAD.newDocument("station")
    try:
        obj = add_station(document, read_station(SAMPLE))
        assert stations_in(document) == [obj]
        assert obj.Cameras == ["left", "right", "top"]
        assert [camera.name for camera in station_of(obj).cameras] == ["left", "right", "top"]
    finally:
        FreeCAD.closeDocument(document.Name)
