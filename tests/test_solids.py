# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: volumes against formulas, directions and ends of all kinds of components."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee, moved
from pipeworkbench.solids import brep_text, component_solid, flange_bolts, frame_of, straight_pipe

EVERYTHING = Pipeline.read(Path(__file__).parent / "data" / "one_of_everything.json").components
ORIGIN = (0.0, 0.0, 0.0)


def made(start, end, diameter=60.3, wall=None):
    return component_solid(Pipe(id="P", start=start, end=end, outer_diameter=diameter, wall_thickness=wall))


@pytest.mark.parametrize(("diameter", "wall", "length"), [(48.3, 2.6, 500.0), (219.1, 6.3, 12.0), (10.2, 5.0, 3000.0)])
def test_volume_of_a_hollow_pipe(diameter, wall, length):
    solid = straight_pipe(diameter, wall, length)
    assert solid.isValid()
    assert solid.Volume() == pytest.approx(math.pi * (diameter - wall) * wall * length, rel=1e-9)


def test_volume_of_a_massive_pipe():
    assert straight_pipe(48.3, None, 500.0).Volume() == pytest.approx(math.pi / 4 * 48.3**2 * 500, rel=1e-9)


def test_straight_pipe_stands_on_the_origin():
    box = straight_pipe(100.0, 5.0, 300.0).BoundingBox()
    assert (box.xmin, box.xmax, box.ymin, box.ymax) == pytest.approx((-50, 50, -50, 50), abs=0.01)
    assert (box.zmin, box.zmax) == pytest.approx((0, 300), abs=0.01)


@pytest.mark.parametrize(
    ("start", "end", "axis"),
    [((10.0, 20.0, 30.0), (510.0, 20.0, 30.0), 0), ((10.0, 20.0, 30.0), (10.0, -480.0, 30.0), 1), ((0.0, 0.0, 500.0), (0.0, 0.0, 0.0), 2)],
)
def test_solid_reaches_from_start_to_end(start, end, axis):
    box = made(start, end, wall=2.9).BoundingBox()
    low, high = (box.xmin, box.ymin, box.zmin), (box.xmax, box.ymax, box.zmax)
    for k in range(3):
        margin = 0 if k == axis else 60.3 / 2
        assert low[k] == pytest.approx(min(start[k], end[k]) - margin, abs=0.01)
        assert high[k] == pytest.approx(max(start[k], end[k]) + margin, abs=0.01)


coordinates = st.floats(-1e4, 1e4)
points = st.tuples(coordinates, coordinates, coordinates)


@settings(max_examples=30)
@given(points, points, st.booleans())
def test_any_pipe_has_its_volume_its_middle_and_its_end_faces(start, end, hollow):
    length = math.dist(start, end)
    assume(length > 10)
    solid = made(start, end, wall=2.9 if hollow else None)
    area = math.pi / 4 * (60.3**2 - (54.5**2 if hollow else 0))
    assert solid.Volume() == pytest.approx(area * length, rel=1e-6)
    assert solid.Center().toTuple() == pytest.approx((np.array(start) + end) / 2, abs=1e-3)
    direction = np.subtract(end, start) / length
    flat = {
        round(float(np.dot(face.normalAt().toTuple(), direction))): face.Center().toTuple() for face in solid.Faces() if face.geomType() == "PLANE"
    }
    assert flat[-1] == pytest.approx(start, abs=1e-3)
    assert flat[1] == pytest.approx(end, abs=1e-3)


@pytest.mark.parametrize("wall", [24.15, 30.0, -1.0])
def test_impossible_wall_is_refused(wall):
    with pytest.raises(InputError, match="does not fit") as error:
        straight_pipe(48.3, wall, 100.0)
    assert error.value.key == "wall_thickness"


@pytest.mark.parametrize(("diameter", "length"), [(0.0, 100.0), (-5.0, 100.0), (48.3, 0.0), (48.3, -1.0), (math.nan, 1.0), (48.3, math.inf)])
def test_impossible_dimensions_are_refused(diameter, length):
    with pytest.raises(InputError, match="make no pipe"):
        straight_pipe(diameter, None, length)


def test_wall_that_is_not_a_number_is_refused():
    with pytest.raises(InputError):
        straight_pipe(48.3, math.nan, 100.0)


def test_brep_text_is_read_back_with_the_same_volume(tmp_path):
    from cadquery import Shape

    solid = made((0.0, 0.0, 0.0), (300.0, 400.0, 0.0), wall=2.9)
    path = tmp_path / "pipe.brep"
    path.write_text(brep_text(solid), encoding="ascii")
    assert Shape.importBrep(str(path)).Volume() == pytest.approx(solid.Volume(), rel=1e-9)


# ---------------------------------------------------------------- other kinds than pipes


def elbow(angle_deg, wall=None, radius=76.0, diameter=60.3):
    turn = math.radians(angle_deg)
    tangent = radius * math.tan(turn / 2)
    end = (tangent + tangent * math.cos(turn), tangent * math.sin(turn), 0.0)
    return Elbow(
        id="E", start=ORIGIN, intersection=(tangent, 0.0, 0.0), end=end, angle_deg=angle_deg, bend_radius=radius, outer_diameter=diameter,
        wall_thickness=wall,
    )  # fmt: skip


def flange(**changes):
    """Return a flange of EN 1092-1, type 11, DN 50, PN 16."""
    plain = Flange(
        id="F", face=ORIGIN, axis=(0.0, -1.0, 0.0), flange_type="11", pn=16, D=165.0, C=18.0, length=45.0, neck_diameter=74.0, outer_diameter=60.3
    )
    return dataclasses.replace(plain, **changes)


def tee(branch=60.3, wall=None, branch_end=(64.0, 0.0, 0.0), kind="tee"):
    return Tee(
        id="T", start=(0.0, 0.0, -64.0), end=(0.0, 0.0, 64.0), intersection=ORIGIN, branch_end=branch_end, branch_diameter=branch, tee_type=kind,
        outer_diameter=60.3, wall_thickness=wall,
    )  # fmt: skip


def reducer(wall=None, offset=0.0):
    kind = "eccentric" if offset else "concentric"
    return Reducer(
        id="R", start=ORIGIN, end=(0.0, offset, 76.0), axis=(0.0, 0.0, 1.0), end_diameter=48.3, reducer_type=kind, outer_diameter=60.3,
        wall_thickness=wall,
    )  # fmt: skip


def cap(wall=None, length=38.0):
    return Cap(id="C", start=ORIGIN, axis=(0.0, 0.0, 1.0), length=length, outer_diameter=60.3, wall_thickness=wall)


def cone(length, root, top):
    return math.pi * length / 12 * (root**2 + root * top + top**2)


def cylinder(diameter, length):
    return math.pi / 4 * diameter**2 * length


def crossing(run, branch, length, reach):
    """Return the volume of a run with a branch of ``reach`` at a right angle: the run, and the branch where it is outside."""
    inside, _ = quad(lambda y: 2 * math.sqrt((branch**2 / 4 - y * y) * (run**2 / 4 - y * y)), -branch / 2, branch / 2)
    return cylinder(run, length) + cylinder(branch, reach) - inside


@pytest.mark.parametrize("component", EVERYTHING, ids=lambda component: component.id)
def test_every_component_is_one_valid_closed_solid(component):
    solid = component_solid(component)
    assert solid.isValid()
    assert solid.ShapeType() == "Solid"
    assert len(solid.Shells()) == 1
    assert solid.Shells()[0].Closed()


@pytest.mark.parametrize("component", EVERYTHING, ids=lambda component: component.id)
def test_every_port_is_a_flat_face_that_looks_outwards(component):
    flat = [face for face in component_solid(component).Faces() if face.geomType() == "PLANE"]
    for port in component.ports:
        found = [face for face in flat if face.Center().toTuple() == pytest.approx(port.point, abs=1e-3)]
        assert [face.normalAt().toTuple() for face in found] == [pytest.approx(port.direction, abs=1e-6)]


@pytest.mark.slow
@settings(max_examples=20)
@given(
    st.sampled_from(EVERYTHING),
    st.tuples(*[st.floats(-1e4, 1e4)] * 3),
    st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_solid_moves_with_its_component(component, shift, turn):
    w, x, y, z = np.array(turn) / np.linalg.norm(turn)
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    motion = np.vstack([np.column_stack([rotation, shift]), [0, 0, 0, 1]])
    there = moved(component, tuple(map(tuple, motion.tolist())))
    frame = frame_of(there)
    axes = np.array([frame.x, frame.y, frame.z])
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    here, moved_solid = component_solid(component), component_solid(there)
    assert moved_solid.Volume() == pytest.approx(here.Volume(), rel=1e-6)
    assert moved_solid.Center().toTuple() == pytest.approx(rotation @ here.Center().toTuple() + shift, abs=1e-3)


@pytest.mark.parametrize("angle_deg", [15.0, 45.0, 90.0, 137.3])
@pytest.mark.parametrize("wall", [None, 2.9])
def test_volume_of_an_elbow_is_its_section_times_its_axis(angle_deg, wall):
    section = math.pi / 4 * (60.3**2 - ((60.3 - 2 * wall) ** 2 if wall else 0))
    assert component_solid(elbow(angle_deg, wall)).Volume() == pytest.approx(section * 76 * math.radians(angle_deg), rel=1e-6)


def test_volume_of_a_weld_neck_flange():
    straight = flange(neck_straight=8.0)
    solid = cylinder(165, 18) + cone(19, 74, 60.3) + cylinder(60.3, 8)
    assert component_solid(straight).Volume() == pytest.approx(solid, rel=1e-6)
    hollow = dataclasses.replace(straight, wall_thickness=2.9)
    assert component_solid(hollow).Volume() == pytest.approx(solid - cylinder(54.5, 45), rel=1e-6)


def test_raised_face_is_a_part_of_the_plate():
    made = component_solid(flange(raised_face_diameter=102.0, raised_face_height=3.0))
    assert made.Volume() == pytest.approx(cylinder(102, 3) + cylinder(165, 15) + cone(27, 74, 60.3), rel=1e-6)
    box = made.BoundingBox()
    assert (box.ymin, box.ymax) == pytest.approx((0, 45), abs=1e-3)


def test_bolt_holes_go_through_the_plate_and_straddle_the_vertical():
    made = component_solid(flange(flange_type="05", length=18.0, K=125.0, L=18.0, bolts=4))
    assert made.Volume() == pytest.approx(cylinder(165, 18) - 4 * cylinder(18, 18), rel=1e-6)
    holes = [face.Center() for face in made.Faces() if face.geomType() == "CYLINDER" and face.Area() < 2000]
    # the axis lies along y: no hole straight above or beside it
    assert sorted((round(hole.x, 1), round(hole.z, 1)) for hole in holes) == [(-44.2, -44.2), (-44.2, 44.2), (44.2, -44.2), (44.2, 44.2)]


@pytest.mark.parametrize("neck", [None, 60.3])
def test_plate_flange_has_no_neck_and_the_pipes_bore(neck):
    made = component_solid(flange(flange_type="01", length=18.0, neck_diameter=neck, wall_thickness=2.9))
    assert made.Volume() == pytest.approx(cylinder(165, 18) - cylinder(54.5, 18), rel=1e-6)


def test_blind_flange_is_closed_though_the_pipes_wall_is_known():
    assert component_solid(flange(flange_type="05", wall_thickness=2.9)).Volume() == pytest.approx(cylinder(165, 18), rel=1e-6)


def test_bolts_reach_through_both_flanges():
    bolts = flange_bolts(flange(K=125.0, L=18.0, bolts=4))
    assert len(bolts.Solids()) == 4
    assert all(bolt.isValid() for bolt in bolts.Solids())
    box = bolts.BoundingBox()  # in the flange's own axes: behind its back to behind its partner's
    assert box.zmax == pytest.approx(18 + 0.63 * 16, abs=0.01)
    assert box.zmin == pytest.approx(-(2 + 18 + 1.1 * 16), abs=0.01)
    assert flange_bolts(flange()) is None


@pytest.mark.slow
@pytest.mark.parametrize("branch", [60.3, 48.3, 21.3])
@pytest.mark.parametrize("kind", ["tee", "set-on"])
def test_volume_of_a_tee(branch, kind):
    outer = crossing(60.3, branch, 128, 64)
    assert component_solid(tee(branch, kind=kind)).Volume() == pytest.approx(outer, rel=1e-5)
    inner = crossing(60.3 - 5.2, branch - 5.2, 128, 64)
    assert component_solid(tee(branch, wall=2.6, kind=kind)).Volume() == pytest.approx(outer - inner, rel=1e-4)


def test_branch_may_be_oblique():
    upright, oblique = (component_solid(tee(48.3, 2.6, end)) for end in ((90.0, 0.0, 0.0), (90.0, 0.0, 50.0)))
    assert oblique.isValid()
    assert oblique.Volume() > upright.Volume()


@pytest.mark.parametrize("offset", [0.0, 6.0])
def test_volume_of_a_reducer(offset):
    outer = cone(76, 60.3, 48.3)
    assert component_solid(reducer(offset=offset)).Volume() == pytest.approx(outer, rel=1e-6)
    hollow = component_solid(reducer(2.9, offset))
    assert hollow.Volume() == pytest.approx(outer - cone(76, 54.5, 42.5), rel=1e-6)
    assert hollow.BoundingBox().ymax == pytest.approx(30.15, abs=0.01)


@pytest.mark.parametrize("length", [38.0, 60.3 / 4])
def test_volume_of_a_cap(length):
    straight, head = length - 60.3 / 4, 60.3 / 4
    outer = cylinder(60.3, straight) + 2 / 3 * cylinder(60.3, head)
    assert component_solid(cap(length=length)).Volume() == pytest.approx(outer, rel=1e-6)
    inner = cylinder(54.5, straight) + 2 / 3 * cylinder(54.5, head - 2.9)
    assert component_solid(cap(2.9, length)).Volume() == pytest.approx(outer - inner, rel=1e-6)


@pytest.mark.parametrize(
    ("component", "key"),
    [
        (elbow(90, radius=30.0), "bend_radius"),
        (dataclasses.replace(elbow(90), intersection=ORIGIN), "intersection"),
        (dataclasses.replace(elbow(90), end=(200.0, 0.0, 0.0)), "intersection"),
        (flange(D=50.0, neck_diameter=None, wall_thickness=2.0), "D"),
        (flange(axis=ORIGIN), "axis"),
        (tee(branch=88.9), "branch_diameter"),
        (tee(branch_end=(20.0, 0.0, 0.0)), "branch_end"),
        (tee(branch_end=(0.0, 0.0, 90.0)), "branch_end"),
        (dataclasses.replace(tee(), start=(0.0, 0.0, 10.0)), "intersection"),
        (dataclasses.replace(reducer(), axis=(0.0, 0.0, -1.0)), "end"),
        (cap(15.2), "wall_thickness"),
    ],
    ids=lambda value: value if isinstance(value, str) else value.id,
)
def test_impossible_component_is_refused_with_its_name_and_key(component, key):
    with pytest.raises(InputError) as error:
        component_solid(component)
    assert (error.value.source, error.value.key) == (component.id, key)
