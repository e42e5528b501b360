# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP: what a CAD program reads back has the volumes, places and names of the pipeline."""

import math

import cadquery
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.exports.kinds import COLOURS
from pipeworkbench.exports.step import write_step
from pipeworkbench.pipeline import Elbow, Pipe, Pipeline
from pipeworkbench.solids import component_solid

HOLLOW = Pipe(id="A-P00", start=(100.0, 3600.0, -50.0), end=(400.0, 3600.0, 350.0), outer_diameter=48.3, wall_thickness=2.6, dn=40)
MASSIVE = Pipe(id="A-P01", start=(0.0, 4000.0, 0.0), end=(0.0, 4000.0, -700.0), outer_diameter=95.0)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = tmp_path_factory.mktemp("step") / "pipes.step"
    write_step(Pipeline.of_station("A", (HOLLOW, MASSIVE)), path)
    return path


def test_volumes_are_those_of_the_pipes(written):
    solids = cadquery.importers.importStep(str(written)).solids().vals()
    hollow = math.pi / 4 * (48.3**2 - 43.1**2) * 500
    massive = math.pi / 4 * 95.0**2 * 700
    assert sorted(solid.Volume() for solid in solids) == pytest.approx(sorted([hollow, massive]), rel=1e-6)


def test_solids_lie_where_the_pipes_are(written):
    solids = sorted(cadquery.importers.importStep(str(written)).solids().vals(), key=lambda solid: solid.Volume())
    for solid, pipe in zip(solids, (HOLLOW, MASSIVE), strict=True):
        middle = [(a + b) / 2 for a, b in zip(pipe.start, pipe.end, strict=True)]
        assert solid.Center().toTuple() == pytest.approx(middle, abs=1e-4)


def test_names_and_the_unit_are_in_the_file(written):
    text = written.read_text(encoding="ascii")
    assert "'A-P00'" in text
    assert "'A-P01'" in text
    assert "SI_UNIT(.MILLI.,.METRE.)" in text.replace(" ", "")


@pytest.mark.slow
def test_all_kinds_are_written_with_their_volumes_names_and_colours(everything, tmp_path):
    path = tmp_path / "all.step"
    write_step(everything, path)
    found = cadquery.importers.importStep(str(path)).solids().vals()
    volumes = sorted(component_solid(component).Volume() for component in everything.components)
    assert sorted(solid.Volume() for solid in found) == pytest.approx(volumes, rel=1e-5)
    text = path.read_text(encoding="ascii")
    assert all(f"'{component.id}'" in text for component in everything.components)
    assert text.count("COLOUR_RGB(") >= len(COLOURS)


def test_pipeline_without_components_is_refused_and_nothing_written(tmp_path):
    with pytest.raises(InputError, match="no components"):
        write_step(Pipeline(frame="A"), tmp_path / "empty.step")
    assert list(tmp_path.iterdir()) == []


def test_component_that_makes_no_solid_is_refused_with_its_id(tmp_path):
    elbow = Elbow(
        id="E7", start=(0.0, 0.0, 0.0), end=(57.0, 57.0, 0.0), intersection=(57.0, 0.0, 0.0), angle_deg=90.0, bend_radius=20.0, outer_diameter=48.3
    )
    with pytest.raises(InputError, match="E7"):
        write_step(Pipeline(frame="A", components=(HOLLOW, elbow)), tmp_path / "elbow.step")
    assert list(tmp_path.iterdir()) == []
