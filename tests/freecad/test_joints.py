# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints as links between document objects: what is changed carries what is joined to it."""

import dataclasses
import math
from pathlib import Path

import FreeCAD
import pytest

from pipeworkbench.catalogue import bends, catalogue
from pipeworkbench.features import connect, disconnect, make_elbow, make_pipe
from pipeworkbench.features.component import ComponentFeature, component_of
from pipeworkbench.features.document import add_pipeline, components_in, pipeline_of, remove_component, replace_components
from pipeworkbench.features.joints import joints_of
from pipeworkbench.features.project import make_project
from pipeworkbench.pipeline import Elbow, Joint, Pipe, Pipeline

EVERYTHING = Pipeline.read(Path(__file__).resolve().parent.parent / "data" / "one_of_everything.json")
RADIUS = 57.0
# an S in the x, z plane: along x, up, along x again; 3D bends of DN 40
BENT = Pipeline.of_station(
    "A",
    (
        Pipe(id="P1", start=(0.0, 0.0, 0.0), end=(1000.0, 0.0, 0.0), outer_diameter=48.3, wall_thickness=2.6, dn=40),
        Elbow(
            id="E1", start=(1000.0, 0.0, 0.0), intersection=(1057.0, 0.0, 0.0), end=(1057.0, 0.0, 57.0), angle_deg=90.0, bend_radius=RADIUS,
            bend_type="3D", outer_diameter=48.3, wall_thickness=2.6, dn=40, standard="EN 10253 / DIN 2605",
        ),
        Pipe(id="P2", start=(1057.0, 0.0, 57.0), end=(1057.0, 0.0, 800.0), outer_diameter=48.3, wall_thickness=2.6, dn=40),
        Elbow(
            id="E2", start=(1057.0, 0.0, 800.0), intersection=(1057.0, 0.0, 857.0), end=(1114.0, 0.0, 857.0), angle_deg=90.0, bend_radius=RADIUS,
            bend_type="3D", outer_diameter=48.3, wall_thickness=2.6, dn=40, standard="EN 10253 / DIN 2605",
        ),
        Pipe(id="P3", start=(1114.0, 0.0, 857.0), end=(2000.0, 0.0, 857.0), outer_diameter=48.3, wall_thickness=2.6, dn=40),
    ),
)  # fmt: skip
JOINED = dataclasses.replace(
    BENT, joints=tuple(Joint(a=a, a_port=1, b=b, b_port=0) for a, b in (("P1", "E1"), ("E1", "P2"), ("P2", "E2"), ("E2", "P3")))
)


@pytest.fixture
def bent(document):
    """The objects of the S by their ids, recomputed."""
    objects = add_pipeline(document, JOINED)
    document.recompute()
    return {obj.ComponentId: obj for obj in objects}


@pytest.fixture
def everything(document):
    """The objects of one of everything by their ids, recomputed."""
    objects = add_pipeline(document, EVERYTHING)
    document.recompute()
    return {obj.ComponentId: obj for obj in objects}


@pytest.fixture
def modelled(monkeypatch):
    """The ids of the objects that are modelled; to be asked for before objects are made, for FreeCAD keeps what it calls."""
    labels = []
    execute = ComponentFeature.execute

    def counted(self, obj):
        labels.append(obj.ComponentId)
        execute(self, obj)

    monkeypatch.setattr(ComponentFeature, "execute", counted)
    return labels


def ports(obj):
    return component_of(obj).ports


def gaps_and_bends(objects):
    """The distance (mm) and the angle (rad) between the axes at every joint."""
    found = []
    for obj in objects.values():
        for end, other, other_end in joints_of(obj):
            a, b = ports(obj)[end], ports(other)[other_end]
            cosine = -sum(x * y for x, y in zip(a.direction, b.direction, strict=True))
            found.append((math.dist(a.point, b.point), math.acos(min(1.0, cosine))))
    return found


def assert_continuous(objects, gap=1e-6):
    for distance, bend in gaps_and_bends(objects):
        assert distance < gap
        assert bend < 1e-6


def test_joints_are_links_between_objects(everything):
    p3, e1 = everything["P3"], everything["E1"]
    assert (p3.JoinedEnd, e1.JoinedStart) == (e1, p3)
    # they are not dependencies: FreeCAD's graph stays without rings
    assert p3.OutList == []
    assert e1.OutList == []


def test_joints_come_back_in_their_order_and_with_what_else_they_say(document):
    first = dataclasses.replace(EVERYTHING.joints[0], extra={"gasket_mm": 2})
    told = dataclasses.replace(EVERYTHING, joints=(first, *EVERYTHING.joints[1:]))
    add_pipeline(document, told)
    assert pipeline_of(document).joints == told.joints


def test_changed_diameter_runs_along_the_run_and_stays_continuous(bent, document):
    bent["P1"].NominalDiameter = "DN 50"
    document.recompute()
    components = {name: component_of(obj) for name, obj in bent.items()}
    assert {component.outer_diameter for component in components.values()} == {60.3}
    radius = next(bend.bend_radius for bend in bends(60.3) if bend.bend_type == "3D")
    for name in ("E1", "E2"):
        assert (components[name].bend_radius, components[name].bend_type) == (radius, "3D")
        # the axes of the pipes stay
        assert components[name].intersection == pytest.approx(next(c for c in BENT.components if c.id == name).intersection)
    assert_continuous(bent)
    assert components["P1"].start == pytest.approx((0, 0, 0))
    assert components["P3"].end == pytest.approx((2000, 0, 857))
    assert components["P2"].length == pytest.approx(857 - 2 * radius)


def test_label_says_the_size_unless_the_user_gave_another(bent):
    bent["P2"].Label = "riser"
    bent["P1"].NominalDiameter = "DN 50"
    assert [bent[name].Label for name in ("P1", "E1", "P2")] == ["P1 DN 50", "E1 DN 50", "riser"]
    bent["P1"].OutsideDiameter = 61.75
    assert bent["E1"].Label == "E1 61.8 mm"


def test_changed_diameter_stops_at_reducers_and_tees(everything, document):
    everything["P1"].OutsideDiameter = 88.9
    document.recompute()
    changed = {name: obj.OutsideDiameter.Value for name, obj in everything.items()}
    # both flanges follow, through their faces; the tee ends the run
    assert (changed["F1"], changed["F2"], changed["P1"], changed["T1"]) == (88.9, 88.9, 88.9, 60.3)
    assert (changed["P2"], changed["P3"], changed["R1"]) == (33.7, 48.3, 60.3)
    everything["P5"].OutsideDiameter = 42.4
    document.recompute()
    reducer = component_of(everything["R1"])
    assert [everything[name].OutsideDiameter.Value for name in ("P5", "E2", "P4", "E1", "P3", "F3")] == [42.4] * 6
    assert (reducer.outer_diameter, reducer.end_diameter) == (60.3, 42.4)
    assert not [obj.Label for obj in document.Objects if "Invalid" in obj.State]


def test_flange_of_another_diameter_is_the_standards_and_keeps_its_face(everything):
    face = everything["F1"].Placement.Base
    everything["P1"].NominalDiameter = "DN 80"
    flange = component_of(everything["F1"])
    row = catalogue().flanges(standard="EN 1092-1", flange_type="11", pn=16.0, dn=80)[0]
    assert (flange.D, flange.K, flange.L, flange.bolts, flange.C, flange.length) == (row.D, row.K, row.L, row.bolts, row.C, row.length)
    assert (flange.standard, flange.pn, flange.flange_type) == ("EN 1092-1", 16, "11")
    assert everything["F1"].Placement.Base.isEqual(face, 1e-9)
    # the pipe is cut to fit the longer flange
    assert component_of(everything["P1"]).start == pytest.approx((-600 + row.length, 3600, 300))


def test_longer_pipe_carries_what_is_joined_to_its_end(bent):
    bent["P1"].Length = 1300
    components = {name: component_of(obj) for name, obj in bent.items()}
    assert components["E1"].start == pytest.approx((1300, 0, 0))
    assert components["P2"].start == pytest.approx((1357, 0, 57))
    assert components["P2"].end == pytest.approx((1357, 0, 800))
    # the pipe that runs in the same direction takes it up
    assert components["P3"].start == pytest.approx((1414, 0, 857))
    assert components["P3"].end == pytest.approx((2000, 0, 857))
    assert_continuous(bent)


def test_moved_pipe_carries_its_elbows_and_the_pipes_along_its_way_take_it_up(bent):
    bent["P2"].Placement.Base = bent["P2"].Placement.Base + FreeCAD.Vector(100, 0, 0)
    components = {name: component_of(obj) for name, obj in bent.items()}
    assert components["P1"].length == pytest.approx(1100)
    assert components["P3"].length == pytest.approx(2000 - 1214)
    assert components["P1"].start == pytest.approx((0, 0, 0))
    assert components["P3"].end == pytest.approx((2000, 0, 857))
    assert_continuous(bent)


def test_pipe_moved_across_carries_the_whole_run(bent):
    bent["P2"].Placement.Base = bent["P2"].Placement.Base + FreeCAD.Vector(0, 50, 0)
    assert [component_of(obj).ports[0].point[1] for obj in bent.values()] == pytest.approx([50] * 5)
    assert_continuous(bent)


def test_other_angle_of_an_elbow_turns_what_comes_after_it_and_stays_tangent(bent):
    bent["E1"].Angle = 60
    elbow, pipe = component_of(bent["E1"]), component_of(bent["P2"])
    assert elbow.intersection == pytest.approx((1057, 0, 0))
    direction = [b - a for a, b in zip(pipe.start, pipe.end, strict=True)]
    assert math.degrees(math.acos(direction[0] / pipe.length)) == pytest.approx(60)
    assert pipe.length == pytest.approx(743)
    assert_continuous(bent)


def test_chosen_bend_keeps_the_axes(bent):
    bent["E1"].BendType = "5D"
    elbow = component_of(bent["E1"])
    assert (elbow.bend_radius, elbow.bend_type) == (next(bend.bend_radius for bend in bends(48.3) if bend.bend_type == "5D"), "5D")
    assert elbow.intersection == pytest.approx((1057, 0, 0))
    assert component_of(bent["P1"]).end == pytest.approx((1057 - elbow.bend_radius, 0, 0))
    assert_continuous(bent)


def test_pipe_too_short_to_give_way_moves_as_a_whole(bent):
    bent["P1"].Length = 1000 + 900
    pipe = component_of(bent["P3"])
    assert (pipe.start[0], pipe.length) == (pytest.approx(2014), pytest.approx(886))


def test_rotated_pipe_takes_all_with_it(bent):
    bent["P1"].Placement = FreeCAD.Placement(FreeCAD.Vector(), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90)).multiply(bent["P1"].Placement)
    assert component_of(bent["P3"]).end == pytest.approx((0, 2000, 857))
    assert_continuous(bent)


def test_components_follow_inside_a_part_that_was_moved(bent, document):
    part = document.addObject("App::Part", "Skid")
    part.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 500), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90))
    for name in ("E1", "P2", "E2", "P3"):
        part.addObject(bent[name])
    bent["P1"].Placement = part.Placement.multiply(bent["P1"].Placement)  # it stays outside
    part.addObject(bent["P1"])
    bent["P1"].Placement = part.Placement.inverse().multiply(bent["P1"].Placement)
    before = component_of(bent["E1"]).start
    bent["P1"].Length = 1200
    after = component_of(bent["E1"]).start
    assert tuple(b - a for a, b in zip(before, after, strict=True)) == pytest.approx((0, 200, 0), abs=1e-9)


def test_fixed_components_are_not_dragged(bent):
    bent["E1"].Fixed = True
    before = component_of(bent["E1"])
    bent["P1"].NominalDiameter = "DN 50"
    bent["P1"].Length = 1200
    assert component_of(bent["E1"]) == before
    assert component_of(bent["P2"]).outer_diameter == 48.3
    assert component_of(bent["P1"]).length == 1200


def test_nothing_follows_where_the_project_says_so(bent, document):
    make_project(document).CarryJoined = False
    bent["P1"].Length = 1300
    assert component_of(bent["E1"]).start == pytest.approx((1000, 0, 0))


def test_flange_that_becomes_blind_has_no_joint_at_its_back(everything, document):
    flange = everything["F1"]
    flange.FlangeType = "05"
    document.recompute()
    assert len(pipeline_of(document).joints) == len(EVERYTHING.joints) - 1
    everything["P1"].NominalDiameter = "DN 65"
    assert flange.OutsideDiameter.Value == 60.3
    flange.FlangeType = "11"
    assert len(pipeline_of(document).joints) == len(EVERYTHING.joints)


def test_gap_of_a_gasket_stays(everything):
    everything["F1"].Placement.Base = everything["F1"].Placement.Base + FreeCAD.Vector(-25, 0, 0)
    assert component_of(everything["F2"]).face == pytest.approx((-627, 3600, 300))
    assert component_of(everything["P1"]).start == pytest.approx((-580, 3600, 300))
    assert component_of(everything["P1"]).end == pytest.approx((-300, 3600, 300))


def test_undo_and_redo_take_one_step_with_all_that_followed(bent, document):
    before = {name: component_of(obj) for name, obj in bent.items()}
    document.openTransaction("Diameter")
    bent["P1"].NominalDiameter = "DN 65"
    document.recompute()
    document.commitTransaction()
    after = {name: component_of(obj) for name, obj in bent.items()}
    assert after["P3"].outer_diameter == 76.1
    document.undo()
    document.recompute()
    assert {name: component_of(obj) for name, obj in bent.items()} == before
    assert bent["P3"].Shape.BoundBox.YLength == pytest.approx(48.3, rel=1e-3)
    document.redo()
    document.recompute()
    assert {name: component_of(obj) for name, obj in bent.items()} == after
    assert bent["P3"].Shape.BoundBox.YLength == pytest.approx(76.1, rel=1e-3)
    assert_continuous(bent)


def test_nothing_is_modelled_twice_and_what_did_not_change_not_at_all(modelled, bent, document):
    modelled.clear()
    bent["P1"].NominalDiameter = "DN 50"
    document.recompute()
    assert sorted(modelled) == sorted(bent)
    modelled.clear()
    bent["P3"].Length = 1000  # its end is free
    document.recompute()
    assert modelled == ["P3"]


def test_spreadsheet_drives_a_whole_run(modelled, bent, document):
    sheet = document.addObject("Spreadsheet::Sheet", "Sheet")
    sheet.set("A1", "=60.3 mm")
    document.recompute()
    bent["P2"].setExpression("OutsideDiameter", "Sheet.A1")
    document.recompute()
    assert {obj.OutsideDiameter.Value for obj in bent.values()} == {60.3}
    assert_continuous(bent)
    modelled.clear()
    document.openTransaction("Edit cell")
    sheet.set("A1", "=88.9 mm")
    document.recompute()
    document.commitTransaction()
    assert {obj.OutsideDiameter.Value for obj in bent.values()} == {88.9}
    assert sorted(modelled) == sorted(bent)
    assert bent["P1"].Shape.BoundBox.YLength == pytest.approx(88.9, rel=1e-3)
    document.undo()
    document.recompute()
    assert {obj.OutsideDiameter.Value for obj in bent.values()} == {60.3}


def test_expressions_that_contradict_each_other_come_to_rest(bent, document):
    bent["P1"].setExpression("OutsideDiameter", "60.3 mm")
    bent["P3"].setExpression("OutsideDiameter", "88.9 mm")
    document.recompute()
    assert (bent["P1"].OutsideDiameter.Value, bent["P3"].OutsideDiameter.Value) == (60.3, 88.9)
    assert not [obj for obj in document.Objects if "Touched" in obj.State]


def test_length_bound_to_an_expression_is_kept(bent, document):
    bent["P1"].setExpression("Length", "2 * 450 mm")
    document.recompute()
    assert component_of(bent["E1"]).start == pytest.approx((900, 0, 0))
    # the pipe cannot give way, it moves as a whole
    bent["P2"].Placement.Base = bent["P2"].Placement.Base + FreeCAD.Vector(30, 0, 0)
    assert (component_of(bent["P1"]).start[0], component_of(bent["P1"]).length) == (pytest.approx(30), pytest.approx(900))


def test_results_are_put_in_place_without_carrying(bent, document):
    moved = dataclasses.replace(BENT.components[0], end=(1003.0, 0.0, 0.0), quality=0.2)
    replace_components(document, dataclasses.replace(JOINED, components=(moved, *BENT.components[1:]), sigma0=0.9))
    assert pipeline_of(document).components == (moved, *BENT.components[1:])
    assert pipeline_of(document).sigma0 == 0.9


def test_replacing_leaves_fixed_and_other_components(bent, document):
    bent["P1"].Fixed = True
    longer = tuple(dataclasses.replace(c, quality=0.5) for c in BENT.components)
    replace_components(document, dataclasses.replace(JOINED, components=longer), chosen={"P1", "P2"})
    assert [component_of(bent[name]).quality for name in ("P1", "P2", "P3")] == [None, 0.5, None]


def test_replacing_what_was_deleted_says_so_and_changes_nothing(bent, document):
    remove_component(bent["E2"])
    with pytest.raises(Exception, match="E2"):
        replace_components(document, dataclasses.replace(JOINED, components=tuple(dataclasses.replace(c, quality=0.5) for c in BENT.components)))
    assert component_of(bent["P1"]).quality is None


def test_deleted_component_leaves_open_ends_and_undo_joins_them_again(bent, document):
    document.openTransaction("Delete")
    remove_component(bent["E1"])
    document.commitTransaction()
    assert bent["P1"].JoinedEnd is None
    assert [(joint.a, joint.b) for joint in pipeline_of(document).joints] == [("P2", "E2"), ("E2", "P3")]
    bent["P1"].Length = 500
    document.undo()
    assert len(pipeline_of(document).joints) == 4


def test_link_that_a_user_sets_is_answered_by_the_nearest_end(document):
    pipe, elbow = make_pipe(document, BENT.components[0]), make_elbow(document, BENT.components[1])
    pipe.JoinedEnd = elbow
    assert elbow.JoinedStart == pipe
    assert pipeline_of(document).joints == (Joint(a="P1", a_port=1, b="E1", b_port=0),)
    pipe.JoinedEnd = None
    assert elbow.JoinedStart is None
    assert pipeline_of(document).joints == ()


def test_end_has_one_joint(document):
    objects = [make_pipe(document, BENT.components[0]), make_elbow(document, BENT.components[1]), make_elbow(document, BENT.components[3])]
    connect(objects[0], 1, objects[1], 0)
    connect(objects[0], 1, objects[2], 1)
    assert (objects[0].JoinedEnd, objects[1].JoinedStart, objects[2].JoinedEnd) == (objects[2], None, objects[0])
    disconnect(objects[2], 1)
    assert objects[0].JoinedEnd is None


def test_joints_survive_saving(bent, document, tmp_path):
    document.saveAs(str(tmp_path / "bent.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "bent.FCStd"))
    assert pipeline_of(again) == JOINED
    objects = {obj.ComponentId: obj for obj in components_in(again)}
    objects["P1"].NominalDiameter = "DN 50"
    again.recompute()
    assert {obj.OutsideDiameter.Value for obj in objects.values()} == {60.3}
    assert_continuous(objects)


def test_pasted_component_gets_an_id_of_its_own(bent, document):
    copy = document.copyObject(bent["P1"], False)
    assert copy.ComponentId == "P1-2"
    assert list(joints_of(copy)) == []
    assert len(pipeline_of(document).joints) == 4
