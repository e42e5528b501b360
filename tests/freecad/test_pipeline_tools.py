# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adjusting, merging and comparing components of a document, from Python without a window."""

import itertools
import math
from dataclasses import replace
from pathlib import Path

import FreeCAD
import numpy as np
import Part
import pytest

import pipeworkbench
from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import adjust_document, frames_of, tasks_of
from pipeworkbench.features.comparing import compare_with_ifc, compare_with_solids, distances_to_surface
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import add_pipeline, add_station, components_in, connections_in, frame_of, pipeline_of, stations_in
from pipeworkbench.features.kinds import add_component
from pipeworkbench.features.merging import merge_stations
from pipeworkbench.pipeline import Pipe, Pipeline, StationPose, moved
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.reconstruct import reconstruct
from pipeworkbench.recon.station import read_station

ROOT = Path(pipeworkbench.__file__).resolve().parent.parent
SAMPLE = ROOT / "resources" / "samples" / "dummy" / "A"


@pytest.fixture(scope="module")
def found():
    """Two pipes of the sample and the elbow between them, as recognised, not adjusted."""
    station = read_station(SAMPLE)
    picks = read_picks(SAMPLE / "picks.json", station)
    return reconstruct(station, replace(picks, pipes=picks.pipes[:2], flanges=()), adjustment=None).pipeline


@pytest.fixture
def measured(document, found):
    """A document with the sample station and these components."""
    add_station(document, read_station(SAMPLE))
    document.openTransaction("Measure")
    add_pipeline(document, found)
    document.recompute()
    document.commitTransaction()
    return document


def geometry(document):
    return {obj.ComponentId: [port.point for port in component_of(obj).ports] for obj in components_in(document)}


def test_adjusting_is_one_step_of_undo_that_makes_joints_exact(measured):
    before = geometry(measured)
    steps = measured.UndoCount
    (result,) = adjust_document(measured)
    assert measured.UndoCount == steps + 1
    after = geometry(measured)
    assert after != before
    assert result.solution.converged
    assert {change.after.id for change in result.changes} == set(before)
    assert all(0 <= change.shift < 5 and change.rotation_deg < 1 for change in result.changes)
    pipeline = pipeline_of(measured)
    ports = {component.id: component.ports for component in pipeline.components}
    for joint in pipeline.joints:
        assert math.dist(ports[joint.a][joint.a_port].point, ports[joint.b][joint.b_port].point) < 1e-3
    assert pipeline.sigma0 == pytest.approx(result.solution.sigma0, abs=1e-4)
    summary = pipeline.extra["adjustment"]
    assert {image["image"] for image in summary["images"]} == {"left", "right", "top"}
    assert all(image["rms_px"] < 1 for image in summary["images"])
    measured.undo()
    assert geometry(measured) == before


def test_residuals_lie_between_contour_and_edge(measured):
    (result,) = adjust_document(measured)
    images = result.solution.residuals
    assert [one.image for one in images] == ["left", "right", "top"]
    for one in images:
        lengths = np.linalg.norm(one.edge - one.contour, axis=1)
        assert len(lengths) > 100
        assert lengths.max() <= 3
        assert np.sqrt(np.mean(lengths**2)) < 1


def test_fixed_and_unselected_components_stay(measured):
    fixed, free, elbow = components_in(measured)
    fixed.Fixed = True
    before = geometry(measured)
    (result,) = adjust_document(measured, [fixed, free])
    after = geometry(measured)
    assert after[fixed.ComponentId] == before[fixed.ComponentId]
    assert after[elbow.ComponentId] == before[elbow.ComponentId]
    assert [change.after.id for change in result.changes] == [fixed.ComponentId, free.ComponentId]


def test_nothing_to_adjust_is_told(document):
    with pytest.raises(InputError, match="no pipes or fittings to adjust"):
        tasks_of(document)
    add_pipeline(document, Pipeline.of_station("S", (Pipe(id="P", start=(0, 0, 0), end=(0, 0, 500), outer_diameter=48.3, station="S"),)))
    with pytest.raises(InputError, match="no station whose photographs"):
        tasks_of(document)


def pipework(prefix, matrix):
    """Pipes and elbows of a course with three directions, in a frame of its own."""
    corners = [(0, 0, 0), (1200, 0, 0), (1200, 700, 0), (1200, 700, 900), (400, 700, 900)]
    pipes = [
        Pipe(id=f"P{n}", start=tuple(map(float, a)), end=tuple(map(float, b)), outer_diameter=48.3, dn=40)
        for n, (a, b) in enumerate(itertools.pairwise(corners))
    ]
    branch = Pipe(id="X", start=(300.0, 60.0, 200.0), end=(300.0, 900.0, 200.0), outer_diameter=60.3, dn=50)
    sigma = {"sigma_position": (0.3, 0.3, 0.3), "sigma_direction_deg": 0.05}
    components = tuple(replace(moved(pipe, matrix), id=f"{prefix}-{pipe.id}", station=prefix, **sigma) for pipe in (*pipes, branch))
    return Pipeline.of_station(prefix, components)


def turned(angle_deg, shift):
    cosine, sine = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return ((cosine, -sine, 0.0, shift[0]), (sine, cosine, 0.0, shift[1]), (0.0, 0.0, 1.0, shift[2]), (0.0, 0.0, 0.0, 1.0))


IDENTITY = turned(0, (0, 0, 0))


def test_merging_brings_everything_into_the_first_frame_in_one_step(document):
    document.openTransaction("Measure")
    add_pipeline(document, pipework("A", IDENTITY))
    other = pipework("B", turned(35, (500.0, -2000.0, 40.0)))
    alone = Pipe(id="B-Y", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 400.0), outer_diameter=114.3, station="B", fixed=True)
    add_pipeline(document, replace(other, components=(*other.components, alone)))
    document.recompute()
    document.commitTransaction()
    assert sorted(frames_of(document)) == ["A", "B"]
    before, steps = geometry(document), document.UndoCount
    merged = merge_stations(document)
    assert merged.merged_frames == ("A", "B")
    assert document.UndoCount == steps + 1
    after = geometry(document)
    # what both saw is one now, what B alone saw came along, although it is fixed
    assert set(after) == {*(name for name in before if name.startswith("A-")), "B-Y"}
    back = np.linalg.inv(turned(35, (500.0, -2000.0, 40.0)))
    assert np.allclose(after["B-Y"][0], back[:3, 3], atol=1.0)
    assert list(frames_of(document)) == ["A"]
    assert list(connections_in(document)) == ["A"]
    assert set(pipeline_of(document).stations) == {"A", "B"}
    document.undo()
    assert geometry(document) == before
    assert sorted(frames_of(document)) == ["A", "B"]


def test_frame_that_is_left_from_before_a_merge_counts_nowhere(document):
    add_station(document, read_station(SAMPLE))
    (station,) = stations_in(document)
    pipe = Pipe(id="A-P", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 400.0), outer_diameter=114.3, station="A")
    add_pipeline(document, replace(Pipeline.of_station("A", (pipe,)), sigma0=0.5))
    merged = pipework("B", IDENTITY)
    poses = merged.stations | {"A": StationPose(frame_from_level=turned(35, (500.0, -2000.0, 40.0)))}
    add_pipeline(document, replace(merged, components=(*merged.components, pipe), stations=poses, sigma0=0.7))
    assert list(connections_in(document)) == ["A", "B"]
    unmeasured = add_component(document, replace(pipe, id="by hand", station=None))
    measured = [obj for obj in components_in(document) if obj.ComponentId == "A-P"]
    for chosen in (measured, [*measured, unmeasured], [unmeasured], None):
        assert (pipeline_of(document, chosen).frame, pipeline_of(document, chosen).sigma0) == ("B", 0.7)
        assert list(frames_of(document, chosen)) == ["B"]
    assert frame_of(station).name == "B"


def test_stations_that_share_nothing_stay_and_say_why(document):
    add_pipeline(document, pipework("A", IDENTITY))
    alone = Pipe(id="B-Y", start=(0.0, 0.0, 0.0), end=(0.0, 0.0, 400.0), outer_diameter=114.3, station="B")
    add_pipeline(document, Pipeline.of_station("B", (alone,)))
    before = geometry(document)
    with pytest.raises(InputError, match="no station could be merged"):
        merge_stations(document)
    assert geometry(document) == before
    with pytest.raises(InputError, match="fewer than two"):
        merge_stations(document, ["A"])


def cylinder(document, name, start, end, radius, inner=0.0):
    direction = FreeCAD.Vector(*end) - FreeCAD.Vector(*start)
    shape = Part.makeCylinder(radius, direction.Length, FreeCAD.Vector(*start), direction)
    if inner:
        shape = shape.cut(Part.makeCylinder(inner, direction.Length, FreeCAD.Vector(*start), direction))
    obj = document.addObject("Part::Feature", name)
    obj.Shape = shape
    return obj


def test_deviations_from_solids_are_those_that_were_made(document):
    built = Pipeline.of_station("A", (Pipe(id="P", start=(0, 0, 7.0), end=(1000.0, 0, 7.0), outer_diameter=60.3, station="A"),))
    add_pipeline(document, built)
    design = cylinder(document, "Designed", (-100, 3, 0), (900, 3, 0), 24.15, inner=21.0)
    away = cylinder(document, "Away", (0, 5000, 0), (0, 5000, 800), 30.0)
    document.recompute()
    comparison = compare_with_solids(document, [design, away])
    by_id = {deviation.designed_id: deviation for deviation in comparison.deviations}
    assert by_id["Designed"].built_id is None or by_id["Designed"].designed_diameter == pytest.approx(48.3)
    assert by_id["Away"].built_id is None
    # 60.3 is no 48.3: it is not the same pipe; with the right diameter it is
    components_in(document)[0].OutsideDiameter = 48.3
    document.recompute()
    (found,) = (one for one in compare_with_solids(document, [design, away]).deviations if one.built_id)
    assert found.offset == pytest.approx((0, -3, 7), abs=1e-6)
    assert max(found.distances) == pytest.approx(math.hypot(3, 7), abs=1e-3)
    assert found.angle_deg == pytest.approx(0, abs=1e-4)


def test_distance_to_a_solid_is_that_between_the_surfaces(document):
    add_pipeline(document, Pipeline.of_station("A", (Pipe(id="P", start=(0, 0, 0), end=(1000.0, 0, 0), outer_diameter=60.0, station="A"),)))
    wall = document.addObject("Part::Box", "Wall")
    wall.Length, wall.Width, wall.Height = 1000, 100, 500
    wall.Placement.Base = FreeCAD.Vector(0, 80, -250)
    document.recompute()
    (found,) = distances_to_surface(document, [wall]).deviations
    assert found.distances == pytest.approx((50,), abs=1e-3)
    assert found.offset == pytest.approx((0, -50, 0), abs=1e-3)
    with pytest.raises(InputError, match="no round outer faces"):
        compare_with_solids(document, [wall])


def test_deviations_from_an_ifc_file_in_place_and_fitted(document, tmp_path):
    from pipeworkbench.exports.ifc import write_ifc

    design = pipework("A", IDENTITY)
    write_ifc(design, tmp_path / "model.ifc")
    add_pipeline(document, pipework("B", turned(0, (0.0, 0.0, 12.0))))
    document.recompute()
    in_place = [one for one in compare_with_ifc(document, tmp_path / "model.ifc", fit=False).deviations if one.built_id]
    level = [one for one in in_place if abs(one.offset[2]) > 1]
    assert level
    assert all(max(one.distances) == pytest.approx(12, abs=0.01) for one in level)
    fitted = compare_with_ifc(document, tmp_path / "model.ifc").deviations
    assert max(max(one.distances) for one in fitted if one.distances) < 0.5


def test_freecads_own_export_writes_the_selected_components_as_a_table(document, tmp_path):
    from pipeworkbench.features.table_export import export

    add_pipeline(document, pipework("A", IDENTITY))
    wall = document.addObject("Part::Box", "Wall")
    document.recompute()
    export([wall, *components_in(document)[:2]], str(tmp_path / "table.csv"))
    lines = (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()
    assert [line.split(",")[0] for line in lines] == ["id", "A-P0", "A-P1"]
    with pytest.raises(InputError, match="no pipe or fitting"):
        export([wall], str(tmp_path / "none.csv"))
