# SPDX-License-Identifier: LGPL-2.1-or-later
"""All kinds of components in a document, without a window: their solids, their properties, the way there and back."""

import dataclasses
import json
import math
from pathlib import Path

import FreeCAD
import pytest

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import add_pipeline, components_in, connections_in, pipeline_of
from pipeworkbench.features.kinds import add_component
from pipeworkbench.pipeline import Cap, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, StationPose, Tee
from pipeworkbench.solids import component_solid

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")
BY_ID = {component.id: component for component in EVERYTHING.components}
MOVED = StationPose(frame_from_level=((0.0, -1.0, 0.0, 5000.0), (1.0, 0.0, 0.0, -200.0), (0.0, 0.0, 1.0, 80.0), (0.0, 0.0, 0.0, 1.0)))


def reopened(document, path):
    document.recompute()
    document.saveAs(str(path))
    FreeCAD.closeDocument(document.Name)
    return FreeCAD.openDocument(str(path))


def test_pipeline_comes_back_from_a_document_as_it_was(document):
    add_pipeline(document, EVERYTHING)
    assert pipeline_of(document) == EVERYTHING


def test_pipeline_survives_saving_reopening_and_recomputing(document, tmp_path):
    add_pipeline(document, EVERYTHING)
    again = reopened(document, tmp_path / "all.FCStd")
    assert pipeline_of(again) == EVERYTHING
    again.recompute(None, True)
    assert not [obj.Label for obj in again.Objects if "Invalid" in obj.State]
    assert pipeline_of(again) == EVERYTHING


@pytest.mark.parametrize("component", EVERYTHING.components, ids=lambda component: component.id)
def test_solid_lies_where_the_component_is(document, component):
    obj = add_component(document, component)
    document.recompute()
    wanted = component_solid(component)
    assert obj.Shape.isValid()
    assert len(obj.Shape.Solids) == 1
    assert obj.Shape.Volume == pytest.approx(wanted.Volume(), rel=1e-6)
    assert tuple(obj.Shape.CenterOfMass) == pytest.approx(wanted.Center().toTuple(), abs=1e-4)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("P1", {"Length": 400}),
        ("E1", {"BendRadius": 76}),
        ("E1", {"Angle": 30}),
        ("F1", {"PlateDiameter": 185, "BoltCircle": 145}),
        ("F1", {"BoltCount": 8}),
        ("F1", {"RaisedFaceHeight": 0}),
        ("T1", {"BranchDiameter": 48.3}),
        ("T1", {"BranchAngle": 60, "BranchLength": 80}),
        ("R1", {"Offset": 3}),
        ("R2", {"EndDiameter": 21.3}),
        ("C1", {"Length": 30}),
        ("C1", {"WallThickness": 0}),
    ],
    ids=str,
)
def test_solid_and_component_follow_the_properties(document, name, change):
    obj = add_component(document, BY_ID[name])
    document.recompute()
    before = (obj.Shape.Volume, *obj.Shape.CenterOfMass)
    for key, value in change.items():
        setattr(obj, key, value)
    document.recompute()
    assert "Invalid" not in obj.State
    assert obj.Shape.isValid()
    assert (obj.Shape.Volume, *obj.Shape.CenterOfMass) != pytest.approx(before, rel=1e-4)
    # the component that is exported is the one that is shown
    wanted = component_solid(component_of(obj))
    assert obj.Shape.Volume == pytest.approx(wanted.Volume(), rel=1e-6)
    assert tuple(obj.Shape.CenterOfMass) == pytest.approx(wanted.Center().toTuple(), abs=1e-4)


def test_changed_bend_keeps_its_start_and_loses_type_standard_and_accuracy(document):
    obj = add_component(document, BY_ID["E1"])
    obj.BendRadius = 108
    elbow = component_of(obj)
    assert elbow.start == pytest.approx(BY_ID["E1"].start)
    assert elbow.end == pytest.approx((208, 3600, 198))
    assert (elbow.bend_radius, elbow.bend_type, elbow.standard, elbow.verified) == (108, None, None, None)
    assert (elbow.quality, elbow.sigma_position, elbow.loa) == (None, None, None)
    assert (elbow.dn, elbow.station, elbow.wall_thickness) == (40, "A", 2.6)


def test_moved_component_keeps_its_standard_and_loses_its_accuracy(document):
    obj = add_component(document, BY_ID["F1"])
    obj.Placement.Base = obj.Placement.Base + FreeCAD.Vector(0, 0, 10)
    flange = component_of(obj)
    assert flange.face == pytest.approx((-600, 3600, 310))
    assert (flange.standard, flange.equivalents, flange.pn, flange.K) == ("EN 1092-1", BY_ID["F1"].equivalents, 16, 125)
    assert (flange.quality, flange.loa) == (None, None)


def test_pressure_class_that_the_standard_does_not_have_makes_a_flange_of_no_standard(document):
    obj = add_component(document, BY_ID["F1"])
    obj.PressureClass = 37
    flange = component_of(obj)
    assert (flange.pn, flange.equivalents, flange.standard) == (37, (), None)
    assert (obj.PN, obj.Standard) == ("none", "none")
    assert flange.quality == BY_ID["F1"].quality  # it was not moved


def test_unknown_key_of_a_component_survives(document):
    assert component_of(add_component(document, BY_ID["F3"])).extra == {"note": "no bolts known"}


def test_points_that_do_not_quite_fit_come_back_as_they_were(document):
    # an adjustment rounds: the tangent length of this bend is 57 mm
    elbow = dataclasses.replace(BY_ID["E1"], end=(157.02, 3600.03, 248.99), sigma_position=(0.1, 0.1, 0.1))
    obj = add_component(document, elbow)
    document.recompute()
    assert component_of(obj) == elbow


def test_bolts_are_drawn_where_they_are_wanted(document):
    obj = add_component(document, BY_ID["F1"])
    document.recompute()
    alone = obj.Shape.Volume
    obj.ShowBolts = True
    document.recompute()
    assert len(obj.Shape.Solids) == 1 + 4
    assert obj.Shape.Volume > alone + 4 * math.pi / 4 * 16**2 * 38
    assert component_of(obj) == BY_ID["F1"]


def test_nominal_diameter_of_an_elbow_is_not_a_pipes_standard(document):
    obj = add_component(document, BY_ID["E1"])
    obj.NominalDiameter = "DN 50"
    elbow = component_of(obj)
    # its own: that of the bends
    assert (elbow.outer_diameter, elbow.wall_thickness, elbow.dn) == (60.3, 2.9, 50)
    assert (elbow.bend_type, elbow.bend_radius, elbow.standard) == ("3D", 76, "EN 10253 / DIN 2605")


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("F1", {"BoltCircle": 160}, "bolt holes"),
        ("E1", {"BendRadius": 20}, "bend_radius"),
        ("C1", {"WallThickness": 20}, "wall"),
        ("T1", {"BranchDiameter": 100}, "branch_diameter"),
    ],
    ids=str,
)
def test_impossible_dimensions_are_an_error_of_the_object(document, name, change, said):
    obj = add_component(document, BY_ID[name])
    document.recompute()
    for key, value in change.items():
        setattr(obj, key, value)
    document.recompute()
    assert "Invalid" in obj.State
    with pytest.raises(InputError, match=said):
        component_solid(component_of(obj))


def test_component_of_another_kind_is_not_overwritten(document):
    add_pipeline(document, EVERYTHING)
    impostor = dataclasses.replace(BY_ID["C1"], id="P1")
    with pytest.raises(InputError, match="is not a cap"):
        add_pipeline(document, Pipeline.of_station("A", (impostor,)))


def test_plain_pipes_need_no_connections(document):
    add_pipeline(document, Pipeline.of_station("A", (BY_ID["P1"],)))
    assert connections_in(document) == {}
    assert pipeline_of(document) == Pipeline.of_station("A", (BY_ID["P1"],))


def test_joints_to_what_is_not_exported_are_left_out(document):
    objects = add_pipeline(document, EVERYTHING)
    chosen = [obj for obj in objects if obj.ComponentId in ("P3", "E1", "P4", "C1")]
    part = pipeline_of(document, chosen)
    assert [(joint.a, joint.b) for joint in part.joints] == [("P3", "E1"), ("E1", "P4")]
    document.removeObject(objects[0].Name)
    assert all("F1" not in (joint.a, joint.b) for joint in pipeline_of(document).joints)


def test_reconstructing_a_part_again_keeps_the_other_joints(document):
    add_pipeline(document, EVERYTHING)
    part = Pipeline.of_station("A", (BY_ID["P3"], BY_ID["E1"]))
    add_pipeline(document, dataclasses.replace(part, joints=(Joint(a="E1", a_port=0, b="P3", b_port=1),), sigma0=0.2))
    joints = pipeline_of(document).joints
    assert len(joints) == len(EVERYTHING.joints)
    assert joints[-1] == Joint(a="E1", a_port=0, b="P3", b_port=1)
    assert pipeline_of(document).sigma0 == 0.2


def test_merged_stations_come_back_as_one_pipeline(document, tmp_path):
    merged = dataclasses.replace(
        EVERYTHING,
        components=tuple(dataclasses.replace(component, station="AB"[number % 2]) for number, component in enumerate(EVERYTHING.components)),
        stations=EVERYTHING.stations | {"B": MOVED},
        extra={"project": "boiler house"},
    )
    add_pipeline(document, merged)
    assert pipeline_of(reopened(document, tmp_path / "merged.FCStd")) == merged


def test_unmerged_stations_are_refused_though_one_has_connections(document):
    add_pipeline(document, EVERYTHING)
    add_pipeline(document, Pipeline.of_station("B", (dataclasses.replace(BY_ID["P1"], id="B-P00", station="B"),)))
    with pytest.raises(PipeWorkbenchError, match="several stations"):
        pipeline_of(document)


def test_undo_takes_a_change_back_with_what_followed_from_it(document):
    obj = add_component(document, BY_ID["E1"])
    document.recompute()
    document.openTransaction("bend")
    obj.BendRadius = 108
    document.recompute()
    document.commitTransaction()
    assert obj.Standard == ""
    document.undo()
    document.recompute()
    assert component_of(obj) == BY_ID["E1"]


def test_pipe_of_version_1_is_read(document):
    pipe = BY_ID["P3"]
    obj = add_component(document, pipe)
    # what version 1 kept
    obj.MeasuredAs = json.dumps([*pipe.start, *pipe.end, pipe.outer_diameter])
    obj.addProperty("App::PropertyString", "Extra", "Base", "")
    obj.Extra = json.dumps({"note": "kept"})
    obj.SchemaVersion = 1
    obj.Proxy.onDocumentRestored(obj)
    assert obj.SchemaVersion == 3
    back = component_of(obj)
    assert back.extra == {"note": "kept"}
    assert back.start == pytest.approx(pipe.start)
    for name in ("id", "dn", "standard", "verified", "pick", "station", "loa", "quality", "sigma_position", "sigma_outer_diameter"):
        assert getattr(back, name) == getattr(pipe, name)


def test_there_is_an_object_for_every_kind(document):
    add_pipeline(document, EVERYTHING)
    kinds = {type(component_of(obj)) for obj in components_in(document)}
    assert kinds == {Pipe, Elbow, Flange, Tee, Reducer, Cap}
