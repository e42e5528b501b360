# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD documents: what is said where FreeCAD is missing or fails, and a real document."""

import os
import re
import shutil
import zipfile

import pytest

from pipeworkbench.errors import MissingPackageError, PipeWorkbenchError
from pipeworkbench.exports.fcstd import PROGRAM_VARIABLE, PROGRAMS, write_fcstd
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.station import read_station

PIPELINE = Pipeline.of_station(
    "A",
    (
        Pipe(id="A-P00", start=(100.0, 3600.0, -50.0), end=(400.0, 3600.0, 350.0), outer_diameter=48.3, wall_thickness=2.6, dn=40),
        Pipe(id="A-P01", start=(0.0, 4000.0, 0.0), end=(0.0, 4000.0, -700.0), outer_diameter=95.0),
    ),
)
FREECAD = os.environ.get(PROGRAM_VARIABLE) or next(filter(None, map(shutil.which, PROGRAMS)), None)


def test_missing_freecad_is_named_with_the_way_to_install_it(tmp_path, monkeypatch):
    monkeypatch.delenv(PROGRAM_VARIABLE, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(MissingPackageError, match="apt-get install freecad") as error:
        write_fcstd(PIPELINE, tmp_path / "pipes.FCStd")
    assert "FreeCAD" in str(error.value)
    assert PROGRAM_VARIABLE in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_program_that_cannot_be_started_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv(PROGRAM_VARIABLE, str(tmp_path / "nothing_here"))
    with pytest.raises(PipeWorkbenchError, match=r"nothing_here.*cannot be started") as error:
        write_fcstd(PIPELINE, tmp_path / "pipes.FCStd")
    assert PROGRAM_VARIABLE in str(error.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(shutil.which("true") is None, reason="there is no program 'true'")
def test_program_that_does_nothing_is_reported_and_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv(PROGRAM_VARIABLE, shutil.which("true"))
    with pytest.raises(PipeWorkbenchError, match=r"pipes\.FCStd: FreeCAD could not write the document"):
        write_fcstd(PIPELINE, tmp_path / "pipes.FCStd")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.skipif(FREECAD is None, reason="FreeCAD's command-line program is not installed")
def test_freecad_writes_a_document_with_every_kind_of_component_and_the_joints(tmp_path, everything):
    path = tmp_path / "all.FCStd"
    write_fcstd(everything, path)
    with zipfile.ZipFile(path) as document:
        text = document.read("Document.xml").decode("utf-8")
    for component in everything.components:
        assert f'type="Part::FeaturePython" name="{component.kind.capitalize()}' in text
        assert f'"{component.id} DN' in text
    # both ends of a joint link to each other
    assert len(re.findall(r'<Link value="\w+"', text)) == 2 * len(everything.joints)


@pytest.mark.slow
@pytest.mark.skipif(FREECAD is None, reason="FreeCAD's command-line program is not installed")
def test_freecad_writes_a_document_with_every_pipe(tmp_path, sample):
    path = tmp_path / "pipes.FCStd"
    write_fcstd(PIPELINE, path, [read_station(sample)])
    with zipfile.ZipFile(path) as document:
        assert document.testzip() is None
        text = document.read("Document.xml").decode("utf-8")
        shapes = [name for name in document.namelist() if name.endswith((".brp", ".bin"))]
    assert "A-P00" in text
    assert "A-P01" in text
    assert len(shapes) >= 2
    assert [entry.name for entry in tmp_path.iterdir()] == ["pipes.FCStd"]
