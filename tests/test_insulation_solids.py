# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids and quantities of insulation: volumes and areas against formulas and integrals, validity over many dimensions, notches, limits."""

import dataclasses
import itertools
import math
import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import dblquad, quad

from pipeworkbench.errors import InputError
from pipeworkbench.solids import covering_bodies, frame_of, placed_bodies
from pipeworkbench.solids.covering_limits import (
    largest_thickness,
    least_first_boundary,
    least_gores,
    least_mitre_collar,
    least_tee_extent,
)
from pipeworkbench.solids.covering_quantities import axis_length, crossing_volume, layer_volumes, outer_area
from pipeworkbench.solids.coverings import (
    BendCovering,
    BlockNotch,
    BoxCovering,
    CapCovering,
    ConeCovering,
    Layer,
    Notch,
    Sheet,
    StopCovering,
    StraightCovering,
    TeeCovering,
)
from pipeworkbench.solids.frames import IDENTITY, Frame

WOOL, MORE_WOOL, ALUMINIUM = Layer("mineral wool", 30.0), Layer("mineral wool", 20.0), Sheet("aluminium", 1.0)
BUILT = {"id": "I1", "component": "C1", "frame": IDENTITY, "layers": (WOOL, MORE_WOOL), "sheet": ALUMINIUM}
STOP = BUILT | {"layers": ()}

EVERY_KIND = {
    "straight": StraightCovering(radius=30.15, begin=-10, end=500, **BUILT),
    "smooth bend": BendCovering(radius=30.15, bend_radius=114, angle=math.pi / 2, **BUILT),
    "smooth bend with collars": BendCovering(radius=30.15, bend_radius=114, angle=math.pi / 3, collars=(20, 35), **BUILT),
    "segmented bend": BendCovering(radius=30.15, bend_radius=114, angle=math.pi / 2, gores=5, **BUILT),
    "segmented bend with a collar": BendCovering(radius=30.15, bend_radius=114, angle=math.radians(75), gores=4, collars=(0, 40), **BUILT),
    "mitre thicker than the bend's radius": BendCovering(radius=30.15, bend_radius=57, angle=math.pi / 2, gores=2, collars=(40, 30), **BUILT),
    "cone": ConeCovering(radius=57.15, end_radius=30.15, length=102, **BUILT),
    "eccentric cone": ConeCovering(radius=57.15, end_radius=30.15, length=102, offset=27, **BUILT),
    "tee": TeeCovering(radius=57.15, begin=-150, end=150, branch_radius=30.15, branch_angle=math.pi / 2, reach=220, **BUILT),
    "equal tee": TeeCovering(radius=57.15, begin=-150, end=150, branch_radius=57.15, branch_angle=math.pi / 2, reach=220, **BUILT),
    "oblique tee": TeeCovering(radius=57.15, begin=-150, end=300, branch_radius=45.0, branch_angle=math.radians(50), reach=300, **BUILT),
    "hole for a branch": TeeCovering(radius=57.15, begin=-90, end=150, branch_radius=17.0, branch_angle=math.radians(65), reach=0, **BUILT),
    "cap": CapCovering(radius=57.15, length=60, **BUILT),
    "box": BoxCovering(radius=170, begin=-200, end=260, openings=(108.15, 60.0), **BUILT),
    "box with a closed end": BoxCovering(radius=170, begin=-200, end=260, openings=(0, 108.15), **BUILT),
    "stop": StopCovering(radius=30.15, outer_radius=81.15, **STOP),
}
kinds = pytest.mark.parametrize("covering", EVERY_KIND.values(), ids=EVERY_KIND)


def volumes(bodies):
    """Volumes of what bodies belong together: half shells and parts have one name."""
    together = {}
    for body in bodies:
        name = body.name.split(",")[0]
        together[name] = together.get(name, 0.0) + body.solid.Volume()
    return together


def face_area(bodies, layer, name):
    return sum(face.Area() for body in bodies if body.name.split(",")[0] == layer for face in body.faces.get(name, []))


def assert_right(covering, relative=1e-6):
    bodies = covering_bodies(covering)
    for body in bodies:
        assert body.solid.ShapeType() == "Solid"
        assert body.solid.isValid()
        assert sum(len(group) for group in body.faces.values()) == len(body.solid.Faces())
    assert list(volumes(bodies).values()) == pytest.approx(layer_volumes(covering), rel=relative)
    last = bodies[-1].name.split(",")[0]
    assert face_area(bodies, last, "outer") == pytest.approx(outer_area(covering), rel=relative)
    return bodies


@kinds
def test_every_kind_is_valid_and_has_the_volumes_and_the_outer_area_of_the_formulas(covering):
    assert_right(covering)


@kinds
@pytest.mark.parametrize(
    ("layers", "sheet"), [((WOOL,), None), ((WOOL,), ALUMINIUM), ((WOOL, MORE_WOOL), None), ((WOOL, *[Layer("foam", 6)] * 2), ALUMINIUM)]
)
def test_bodies_are_the_layers_from_the_inside_and_then_the_jacket(covering, layers, sheet):
    if covering.kind == "stop":
        layers, sheet = (), ALUMINIUM
    bodies = assert_right(dataclasses.replace(covering, layers=layers, sheet=sheet))
    names = [f"layer {number}" for number in range(1, len(layers) + 1)] + ["jacket"] * (sheet is not None)
    assert list(volumes(bodies)) == names
    materials = dict(zip(names, [layer.material for layer in layers] + [ALUMINIUM.material], strict=False))
    assert {body.name.split(",")[0]: body.material for body in bodies} == materials


@kinds
def test_each_layer_s_outer_face_is_the_next_one_s_inner_face(covering):
    bodies = covering_bodies(covering)
    for below, above in itertools.pairwise(volumes(bodies)):
        assert face_area(bodies, below, "outer") > 0
        # where the ends of a box have openings, the faces inside and outside of them are alike, too
        assert face_area(bodies, below, "outer") == pytest.approx(face_area(bodies, above, "inner"), rel=1e-6)


@kinds
def test_outer_faces_look_away_from_the_insulation_and_inner_ones_too(covering):
    for body in covering_bodies(covering):
        round_faces = [face for name in ("outer", "inner") for face in body.faces[name] if face.geomType() != "PLANE"]
        assert round_faces or covering.kind == "stop"
        for face in round_faces:
            point = middle_of(face)
            step = face.normalAt(point).normalized() * 0.3
            assert body.solid.isInside(point - step)
            assert not body.solid.isInside(point + step)


def middle_of(face):
    """Return a point half way along a face and a fifth around it, beside the hole for a branch."""
    import cadquery as cq

    first, last, low, high = face._uvBounds()
    return cq.Vector(face._geomAdaptor().Value(0.8 * first + 0.2 * last, 0.5 * (low + high)))


# volumes, each written down once more without the module's formulas


def test_volume_of_layers_around_a_pipe():
    radii = [30.15, 60.15, 80.15, 81.15]
    expected = [math.pi * (b - a) * (b + a) * 510 for a, b in itertools.pairwise(radii)]
    assert [body.solid.Volume() for body in covering_bodies(EVERY_KIND["straight"])] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("angle", [15, 45, 90, 180])
def test_volume_of_layers_around_a_smooth_bend_is_that_of_the_torus(angle):
    covering = dataclasses.replace(EVERY_KIND["smooth bend"], angle=math.radians(angle))
    radii = [30.15, 60.15, 80.15, 81.15]
    tori = [2 * math.pi**2 * 114 * radius**2 * angle / 360 for radius in radii]
    expected = [outer - inner for inner, outer in itertools.pairwise(tori)]
    assert [body.solid.Volume() for body in covering_bodies(covering)] == pytest.approx(expected, rel=1e-9)


def test_volume_of_a_gore_by_summing_up_its_fibres():
    # fibres along the gore's axis at (x, y) are 2 (R - x) tan(joint / 2) long; two end halves and three whole ones
    covering = EVERY_KIND["segmented bend"]
    half = math.tan(math.radians(90) / 8)

    def summed(radius):
        return dblquad(lambda s, p: 8 * (114 - s * math.cos(p)) * half * s, 0, 2 * math.pi, 0, radius, epsrel=1e-10)[0]

    bodies = covering_bodies(covering)
    assert bodies[1].solid.Volume() == pytest.approx(summed(80.15) - summed(60.15), rel=1e-6)
    assert bodies[0].solid.Volume() == pytest.approx(summed(60.15) - math.pi * 30.15**2 * 114 * math.pi / 2, rel=1e-6)


@pytest.mark.parametrize(("radius", "branch_radius", "angle"), [(57.0, 30.0, 90), (57.0, 57.0, 90), (88.0, 87.9, 40), (60.0, 8.0, 150)])
def test_common_volume_of_two_cylinders_by_integration(radius, branch_radius, angle):
    def section(turn):
        y = branch_radius * math.sin(turn)
        return 4 * math.sqrt(max(radius**2 - y**2, 0)) * (branch_radius * math.cos(turn)) ** 2 / math.sin(math.radians(angle))

    expected = quad(section, -math.pi / 2, math.pi / 2, epsrel=1e-11, limit=400)[0]
    assert crossing_volume(radius, branch_radius, math.radians(angle)) == pytest.approx(expected, rel=1e-9)


def test_steinmetz_solid():
    assert crossing_volume(3.0, 3.0, math.pi / 2) == pytest.approx(16 / 3 * 27, rel=1e-12)


def test_volume_of_a_tee_s_layers_by_counting_points():
    covering = EVERY_KIND["oblique tee"]
    random = np.random.default_rng(5)
    low, high = np.array([-110.0, -110.0, -150.0]), np.array([320.0, 110.0, 320.0])
    points = random.uniform(low, high, (1_000_000, 3))
    direction = np.array([math.sin(covering.branch_angle), 0, math.cos(covering.branch_angle)])
    along = points @ direction
    beside = np.linalg.norm(points - along[:, None] * direction, axis=1)
    inside = []
    for distance in covering.boundaries[:3]:
        run = (np.hypot(points[:, 0], points[:, 1]) < 57.15 + distance) & (points[:, 2] > -150) & (points[:, 2] < 300)
        inside.append((run | ((beside < 45 + distance) & (along > 0) & (along < 300))).mean())
    expected = np.diff(inside) * np.prod(high - low)
    assert layer_volumes(covering)[:2] == pytest.approx(expected, rel=0.02)


def test_volume_and_area_of_an_eccentric_cone_by_integration():
    covering = EVERY_KIND["eccentric cone"]
    outer = [(57.15 + d, 30.15 + d) for d in covering.boundaries]
    volumes = [quad(lambda z, a=a, b=b: math.pi * (a + (b - a) * z / 102) ** 2, 0, 102)[0] for a, b in outer]
    assert layer_volumes(covering) == pytest.approx(np.diff(volumes), rel=1e-9)
    a, b = outer[-1]

    def area(turn, z):
        radius, slope = a + (b - a) * z / 102, ((b - a) + 27 * math.cos(turn)) / 102
        around = np.array([-radius * math.sin(turn), radius * math.cos(turn), 0])
        up = np.array([(b - a) / 102 * math.cos(turn) + 27 / 102, (b - a) / 102 * math.sin(turn), 1])
        assert math.isclose(slope, up[:2] @ (math.cos(turn), math.sin(turn)))
        return float(np.linalg.norm(np.cross(around, up)))

    assert outer_area(covering) == pytest.approx(dblquad(area, 0, 102, 0, 2 * math.pi, epsrel=1e-8)[0], rel=1e-7)


def test_volume_of_a_pot_and_of_a_box():
    pot = math.pi * np.diff([57.15**2 * 60, 87.15**2 * 90, 107.15**2 * 110, 108.15**2 * 111])
    assert layer_volumes(EVERY_KIND["cap"]) == pytest.approx(pot, rel=1e-12)
    holes = math.pi * (108.15**2 + 60**2) * np.array([30, 20, 1])
    box = math.pi * np.diff([170**2 * 358, 200**2 * 418, 220**2 * 458, 221**2 * 460]) - holes
    assert layer_volumes(EVERY_KIND["box"]) == pytest.approx(box, rel=1e-12)


def test_lengths_of_insulated_axes():
    lengths = {name: axis_length(covering) for name, covering in EVERY_KIND.items()}
    assert lengths["straight"] == 510
    assert lengths["smooth bend with collars"] == pytest.approx(114 * math.pi / 3 + 55)
    assert lengths["segmented bend"] == pytest.approx(8 * 114 * math.tan(math.pi / 16))
    assert lengths["oblique tee"] == 450 + 300
    assert (lengths["cone"], lengths["cap"], lengths["box"], lengths["stop"]) == (102, 60, 460, 0)


# where the bodies lie


def test_ends_are_square_and_where_the_next_covering_begins():
    covering = EVERY_KIND["segmented bend with a collar"]
    for body in covering_bodies(covering):
        (begin,), (end,) = body.faces["begin"], body.faces["end"]
        assert begin.normalAt().toTuple() == pytest.approx((0, 0, -1), abs=1e-9)
        assert begin.Center().toTuple() == pytest.approx((0, 0, 0), abs=1e-6)
        sine, cosine = math.sin(covering.angle), math.cos(covering.angle)
        assert end.normalAt().toTuple() == pytest.approx((sine, 0, cosine), abs=1e-9)
        assert end.Center().toTuple() == pytest.approx((114 * (1 - cosine) + 40 * sine, 0, 114 * sine + 40 * cosine), abs=1e-6)


def test_gores_meet_in_the_planes_between_their_axes():
    jacket = covering_bodies(EVERY_KIND["segmented bend"])[-1]
    gores = jacket.faces["outer"]
    assert [face.geomType() for face in gores] == ["CYLINDER"] * 5
    mitres = [edge for edge in jacket.solid.Edges() if edge.geomType() == "ELLIPSE"]
    angles = {round(math.degrees(math.atan2(edge.Center().z, 114 - edge.Center().x)), 6) for edge in mitres}
    assert angles == {11.25, 33.75, 56.25, 78.75}
    # heel and throat in a joint's plane: the polygon's corner is at R / cos(joint / 2) from the bend's centre
    reach = [math.dist((114, 0, 0), edge.positionAt(share).toTuple()) for edge in mitres for share in (0, 0.5)]
    radii = [80.15, 81.15]
    expected = {round((114 + sign * radius) / math.cos(math.radians(11.25)), 4) for radius in radii for sign in (-1, 1)}
    assert {round(distance, 4) for distance in reach} == expected


def test_inside_of_a_segmented_bend_is_the_elbow_s_torus():
    first = covering_bodies(EVERY_KIND["segmented bend"])[0]
    assert [face.geomType() for face in first.faces["inner"]] == ["TORUS"]


def test_half_shells_lie_on_both_sides_of_the_parting_plane():
    bodies = covering_bodies(EVERY_KIND["box"])
    assert [body.name for body in bodies[:2]] == ["layer 1, half 1", "layer 1, half 2"]
    for body, side in zip(bodies, itertools.cycle((1, -1)), strict=False):
        assert side * body.solid.Center().y > 0
        assert all(abs(face.Center().y) < 1e-9 for face in body.faces["parting"])
        box = body.solid.BoundingBox()
        assert min(abs(box.ymin), abs(box.ymax)) < 1e-6
    whole = bodies[-2].solid.BoundingBox()
    assert (whole.zmin, whole.zmax, whole.xmax) == pytest.approx((-200, 260, 221), abs=1e-3)


def test_branch_s_end_is_square_to_its_axis():
    for body in covering_bodies(EVERY_KIND["oblique tee"]):
        (end,) = body.faces["branch"]
        out = (math.sin(math.radians(50)), 0, math.cos(math.radians(50)))
        assert end.normalAt().toTuple() == pytest.approx(out, abs=1e-9)
        assert end.Center().toTuple() == pytest.approx(tuple(300 * x for x in out), abs=1e-6)


def test_placed_bodies_lie_in_the_pipeline_s_frame():
    frame = Frame(np.array([1000.0, 200.0, -50.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))
    covering = dataclasses.replace(EVERY_KIND["straight"], frame=frame)
    for body, own in zip(placed_bodies(covering), covering_bodies(covering), strict=True):
        assert body.solid.Center().toTuple() == pytest.approx((1245, 200, -50), abs=1e-6)
        assert body.solid.Volume() == pytest.approx(own.solid.Volume(), rel=1e-9)
        assert body.faces["begin"][0].Center().x == pytest.approx(990)
        assert body.faces["end"][0].Center().x == pytest.approx(1500)


def test_insulation_goes_around_the_elbow_that_it_belongs_to():
    from pipeworkbench.pipeline import Elbow
    from pipeworkbench.solids import component_solid

    turn = math.radians(60)
    end = (200 + 200 * math.cos(turn), 100 + 200 * math.sin(turn), 0.0)
    bend_radius = 200 / math.tan(turn / 2)
    elbow = Elbow(id="E", start=(0, 100, 0), intersection=(200, 100, 0), end=end, angle_deg=60, bend_radius=bend_radius, outer_diameter=60.3)
    covering = BendCovering(radius=30.15, bend_radius=bend_radius, angle=turn, gores=4, **(BUILT | {"frame": frame_of(elbow)}))
    inner = placed_bodies(covering)[0].faces["inner"]
    steel = component_solid(elbow)
    assert sum(face.Area() for face in inner) == pytest.approx(math.pi * 60.3 * bend_radius * turn, rel=1e-9)
    common = steel.intersect(placed_bodies(covering)[0].solid)
    assert sum(solid.Volume() for solid in common.Solids()) == pytest.approx(0, abs=1e-3)


# many dimensions

layers = st.lists(st.floats(5, 40), min_size=1, max_size=3).map(lambda sizes: tuple(Layer("wool", size) for size in sizes))
sheets = st.one_of(st.none(), st.floats(0.5, 1.5).map(lambda size: Sheet("steel", size)))

collar_lengths = st.one_of(st.just(0.0), st.just(1e-6), st.floats(1e-3, 80))


def built(layers, sheet):
    return BUILT | {"layers": layers, "sheet": sheet}


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.floats(10, 300), st.floats(1, 5), st.floats(15, 180), st.integers(2, 9), layers, sheets, st.tuples(collar_lengths, collar_lengths))
def test_any_bend_that_is_not_refused_is_right(radius, slack, angle_deg, gores, layers, sheet, collars):
    thick = sum(layer.thickness for layer in layers) + (sheet.thickness if sheet else 0)
    covering = BendCovering(
        radius=radius, bend_radius=(radius + thick) * slack + 1, angle=math.radians(angle_deg), gores=gores, collars=collars, **built(layers, sheet)
    )
    fewest = max(least_gores(radius, covering.bend_radius, covering.angle, layers[0].thickness), gores)
    collar = least_mitre_collar(radius + thick, covering.bend_radius, covering.angle) if fewest == 2 else 0
    covering = dataclasses.replace(covering, gores=fewest, collars=(collars[0] + collar, collars[1] + collar))
    assume(fewest < 12)
    assert_right(covering)
    assert_right(dataclasses.replace(covering, gores=0))


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.floats(15, 150), st.floats(30, 110), layers, sheets)
def test_any_mitre_with_the_least_collars_is_right(radius, angle_deg, layers, sheet):
    covering = BendCovering(radius=radius, bend_radius=1.5 * radius, angle=math.radians(angle_deg), gores=2, **built(layers, sheet))
    if covering.boundaries[1] < least_first_boundary(covering):
        with pytest.raises(InputError, match="gores"):
            covering_bodies(dataclasses.replace(covering, collars=(200.0, 200.0)))
        return
    collar = least_mitre_collar(radius + covering.total_thickness, covering.bend_radius, covering.angle)
    assert_right(dataclasses.replace(covering, collars=(collar, collar + 5)))
    if collar > 1:
        with pytest.raises(InputError, match="throat"):
            covering_bodies(dataclasses.replace(covering, collars=(collar - 0.1, collar + 5)))


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.floats(15, 300), st.one_of(st.just(1.0), st.floats(0.1, 0.9999)), st.floats(30, 150), st.booleans(), layers, sheets)
def test_any_tee_of_the_least_extent_is_right(radius, ratio, angle_deg, covered, layers, sheet):
    angle = math.radians(angle_deg)
    covering = TeeCovering(
        radius=radius, branch_radius=radius * ratio, branch_angle=angle, begin=-1, end=1, reach=float(covered), **built(layers, sheet)
    )
    begin, end, reach = least_tee_extent(covering)
    assert_right(dataclasses.replace(covering, begin=min(begin, -1), end=max(end, 1), reach=reach))


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.floats(10, 300), st.floats(10, 300), st.floats(20, 400), st.floats(-150, 150), layers, sheets)
def test_any_cone_is_right(radius, end_radius, length, offset, layers, sheet):
    assert_right(ConeCovering(radius=radius, end_radius=end_radius, length=length, offset=offset, **built(layers, sheet)))


@pytest.mark.slow
@settings(max_examples=10, deadline=None)
@given(st.floats(30, 300), st.floats(0, 0.9), st.floats(0, 0.9), st.floats(5, 500), layers, sheets)
def test_any_box_pot_and_pipe_is_right(radius, first, last, length, layers, sheet):
    structure = built(layers, sheet)
    thick = sum(layer.thickness for layer in layers) + (sheet.thickness if sheet else 0)
    assert_right(BoxCovering(radius=radius, begin=0, end=2 * thick + length, openings=(first * radius, last * radius), **structure))
    assert_right(CapCovering(radius=radius, length=length, **structure))
    assert_right(StraightCovering(radius=radius, begin=-length, end=length, **structure))


@pytest.mark.slow
def test_step_gives_back_every_body(tmp_path):
    import cadquery as cq

    for number, covering in enumerate(EVERY_KIND.values()):
        bodies = placed_bodies(covering)
        path = tmp_path / f"{number}.step"
        cq.exporters.export(cq.Compound.makeCompound([body.solid for body in bodies]), str(path))
        solids = cq.importers.importStep(str(path)).solids().vals()
        assert all(solid.isValid() for solid in solids)
        assert sorted(solid.Volume() for solid in solids) == pytest.approx(sorted(body.solid.Volume() for body in bodies), rel=1e-6)


# notches


def with_notch(covering, start, end, radius):
    return dataclasses.replace(covering, notches=(Notch("B7", np.array(start, float), np.array(end, float), radius),))


def test_notch_takes_away_what_another_component_needs():
    covering = with_notch(EVERY_KIND["straight"], (0, 0, 200), (500, 0, 200), 10.0)
    whole = layer_volumes(covering)
    for body, before in zip(covering_bodies(covering), whole, strict=True):
        assert body.solid.isValid()
        (notch,) = body.faces["notch"]
        assert notch.geomType() == "CYLINDER"
        inner, outer = (np.mean([face.Area() for face in body.faces[name]]) for name in ("inner", "outer"))
        assert inner < outer
        assert body.solid.Volume() < before
    radii = [30.15, 60.15, 80.15, 81.15]
    removed = [
        crossing_volume(outer, 10.0, math.pi / 2) / 2 - crossing_volume(inner, 10.0, math.pi / 2) / 2 for inner, outer in itertools.pairwise(radii)
    ]
    left = [body.solid.Volume() for body in covering_bodies(covering)]
    assert np.array(whole) - left == pytest.approx(removed, rel=1e-4)


def test_notch_nearly_along_a_covering_is_cut():
    # axes that lean by half a degree: the solid modeller leaves all of the covering, without an error, unless it is helped
    cause = Notch("F1", np.array([-252.24561937, -160.81778034, 190.47001048]), np.array([-252.26654046, -161.11603987, 157.8914179]), 190.6)
    parts = {"layers": (Layer("mineral wool", 100.3),), "sheet": None}
    covering = StraightCovering(**(BUILT | parts), radius=24.15, begin=68.67752573, end=182.69061331, notches=(cause,))
    (body,) = covering_bodies(covering)
    (whole,) = layer_volumes(covering)
    # by counting points: 26254 mm3
    assert whole - body.solid.Volume() == pytest.approx(26254, rel=2e-3)


def test_notches_that_are_nearly_alike_are_cut_both():
    # the plates of two flanges within another pipe's insulation; as they are, the modeller takes all of the second one away
    one = Notch("F1", np.array([-143.1686278, -101.14653411, 144.60179174]), np.array([-163.80798495, -88.89839414, 144.59987304]), 70.0)
    other = Notch("F2", np.array([-149.9836427, -97.10225988, 144.60117719]), np.array([-127.62433236, -110.37106679, 144.6032437]), 70.0)
    parts = {"layers": (Layer("mineral wool", 100.0),), "sheet": None}
    covering = StraightCovering(**(BUILT | parts), radius=24.15, begin=0.0, end=500.0, notches=(one, other))
    (body,) = covering_bodies(covering)
    # by counting points, which are told from those of either notch alone
    grid = np.stack(
        np.meshgrid(np.linspace(-124.15, 0, 180), np.linspace(-124.15, 0, 180), np.linspace(60, 230, 240), indexing="ij"), axis=-1
    ).reshape(-1, 3)
    radius = np.hypot(grid[:, 0], grid[:, 1])
    taken = (radius > 24.15) & (radius < 124.15) & (one.holds(grid) | other.holds(grid))
    assert layer_volumes(covering)[0] - body.solid.Volume() == pytest.approx(taken.sum() * (124.15 / 179) ** 2 * 170 / 239, rel=0.04)


@pytest.mark.slow
@kinds
def test_every_kind_can_be_notched(covering):
    whole = covering_bodies(covering)
    box = max((body.solid.BoundingBox() for body in whole), key=lambda box: box.ymax)
    beside = (box.xmax, 0.3 * box.ymax)
    notched = with_notch(covering, (*beside, box.zmin - 10), (*beside, box.zmax + 10), 0.25 * box.ymax)
    before, after = volumes(whole), volumes(covering_bodies(notched))
    assert list(before) == list(after)
    assert after[list(after)[-1]] < before[list(before)[-1]] * (1 - 1e-6)
    for body in covering_bodies(notched):
        assert body.solid.isValid()
        assert sum(len(group) for group in body.faces.values()) == len(body.solid.Faces())


def test_block_takes_away_what_a_beam_needs():
    # a beam along x across the top, from 70 mm above the axis on
    covering = EVERY_KIND["straight"]
    turned = Frame(np.array([-200.0, 70.0, 100.0]), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    notched = dataclasses.replace(covering, notches=(BlockNotch("beam", turned, np.array([50.0, 400.0, 60.0])),))
    bodies = covering_bodies(notched)

    def segment(radius):
        return radius**2 * math.acos(70 / radius) - 70 * math.sqrt(radius**2 - 70**2)

    removed = np.array(layer_volumes(covering)) - [body.solid.Volume() for body in bodies]
    expected = [0, 50 * segment(80.15), 50 * (segment(81.15) - segment(80.15))]
    assert removed == pytest.approx(expected, rel=1e-6, abs=1e-3)
    assert "notch" not in bodies[0].faces
    assert all("notch" in body.faces and body.solid.isValid() for body in bodies[1:])


def test_notch_beside_a_covering_changes_nothing():
    covering = EVERY_KIND["segmented bend"]
    notched = with_notch(covering, (500, 0, 0), (500, 0, 300), 20.0)
    assert volumes(covering_bodies(notched)) == pytest.approx(volumes(covering_bodies(covering)), rel=1e-12)


def test_notch_that_parts_a_covering_leaves_two_parts():
    covering = dataclasses.replace(EVERY_KIND["straight"], layers=(WOOL,), sheet=None)
    bodies = covering_bodies(with_notch(covering, (-300, 0, 200), (300, 0, 200), 100.0))
    assert [body.name for body in bodies] == ["layer 1, part 1", "layer 1, part 2"]
    assert all(body.solid.isValid() and "outer" in body.faces for body in bodies)
    assert bodies[0].solid.Center().z < 200 < bodies[1].solid.Center().z


def test_notch_that_leaves_nothing_is_refused():
    covering = with_notch(EVERY_KIND["straight"], (0, 0, -100), (0, 0, 700), 70.0)
    with pytest.raises(InputError, match="C1: notches: B7 leaves nothing of its layer 1"):
        covering_bodies(covering)


# what cannot be built


def given_limit(error):
    found = re.search(r"give at most ([\d.]+) mm", str(error.value))
    assert found, str(error.value)
    return float(found[1])


def thick(covering, thickness):
    return dataclasses.replace(covering, layers=(Layer("wool", thickness),))


@pytest.mark.parametrize("sheet", [None, ALUMINIUM])
@pytest.mark.parametrize(
    "name", ["smooth bend", "segmented bend", "mitre thicker than the bend's radius", "tee", "oblique tee", "equal tee", "box", "hole for a branch"]
)
def test_too_thick_insulation_is_refused_with_the_largest_that_can_be_built(name, sheet):
    covering = dataclasses.replace(EVERY_KIND[name], sheet=sheet)
    with pytest.raises(InputError, match="C1: thickness: 400 mm") as error:
        covering_bodies(thick(covering, 400.0))
    largest = given_limit(error)
    assert_right(thick(covering, largest))
    with pytest.raises(InputError, match="thickness"):
        covering_bodies(thick(covering, largest + 0.2))
    assert largest + (sheet.thickness if sheet else 0) <= largest_thickness(covering) + 1e-6


def test_throat_of_a_smooth_bend_limits_the_thickness():
    covering = BendCovering(radius=30.15, bend_radius=76, angle=math.pi / 2, **(BUILT | {"layers": (Layer("wool", 60.0),)}))
    with pytest.raises(InputError, match=r"C1: thickness: 60 mm is more than the throat of the bend allows; give at most 43\.8 mm"):
        covering_bodies(covering)


def test_elbow_that_would_come_out_of_its_gores_is_refused_with_what_works():
    covering = BendCovering(radius=109.55, bend_radius=305, angle=math.pi / 2, gores=2, **(BUILT | {"layers": (Layer("wool", 20.0),), "sheet": None}))
    with pytest.raises(InputError, match="with 2 gores the elbow comes out") as error:
        covering_bodies(covering)
    gores, thickness = (float(number) for number in re.search(r"at least (\d+) gores or ([\d.]+) mm", str(error.value)).groups())
    assert_right(dataclasses.replace(covering, gores=int(gores)))
    assert_right(thick(covering, thickness))
    with pytest.raises(InputError, match="gores"):
        covering_bodies(dataclasses.replace(covering, gores=int(gores) - 1))
    with pytest.raises(InputError, match="gores"):
        covering_bodies(thick(covering, thickness - 0.2))


@pytest.mark.parametrize(("radius", "bend_radius"), [(100.0, 150.0), (100.0, 300.0), (20.0, 200.0)])
def test_least_first_layer_is_the_farthest_point_of_the_torus_from_the_gores(radius, bend_radius):
    covering = BendCovering(radius=radius, bend_radius=bend_radius, angle=math.pi / 2, gores=3, **BUILT)
    along, around = np.meshgrid(np.linspace(0, math.pi / 8, 200), np.linspace(0, 2 * math.pi, 721))
    out = bend_radius + radius * np.cos(around)
    distance = np.hypot(out * np.cos(along) - bend_radius, radius * np.sin(around)).max()
    assert least_first_boundary(covering) == pytest.approx(distance - radius, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("straight", {"end": -10}, "end: is not behind its begin"),
        ("straight", {"layers": (), "sheet": None}, "layers: its insulation has neither layers nor a jacket"),
        ("straight", {"layers": (Layer("wool", -5.0),)}, "thickness: -5 mm of wool is no thickness"),
        ("straight", {"sheet": Sheet("steel", 0.0)}, "jacket.thickness: 0 mm is no thickness"),
        ("straight", {"radius": math.nan}, "radius: must be positive"),
        ("straight", {"notches": (Notch("B7", np.zeros(3), np.zeros(3), 5.0),)}, r"notches\[0\].end: is the same point"),
        ("straight", {"notches": (BlockNotch("beam", IDENTITY, np.array([5.0, 0.0, 5.0])),)}, r"notches\[0\].size: must be positive"),
        ("cap", {"length": 0.0}, "length: must be positive"),
        ("cone", {"end_radius": -1.0}, "end_radius: must be positive"),
        ("box", {"openings": (170.0, 60.0)}, "openings: 170 mm is not less than the hollow's radius 170 mm; give at most 169 mm"),
        ("box", {"openings": (-1.0, 60.0)}, "openings: -1 mm is less than nothing"),
        ("stop", {"outer_radius": 30.15}, "outer_radius: is not larger than the radius"),
        ("stop", {"layers": (WOOL,)}, "layers: a stop is made of sheet metal alone"),
        ("smooth bend", {"gores": 1}, "gores: 1 gores make no bend"),
        ("smooth bend", {"angle": 3.5}, "angle: 200.535 degrees is more than half a turn"),
        ("smooth bend", {"collars": (-1.0, 0.0)}, "collars: -1 mm is less than nothing"),
        ("smooth bend", {"bend_radius": 30.0}, "bend_radius: 30 mm is not more than the component's radius 30.15 mm"),
        ("smooth bend", {"gores": 2, "angle": math.radians(150)}, "gores: 2 gores meet at 150 degrees; give at least 3"),
        ("tee", {"branch_radius": 60.0}, "branch_radius: 60 mm is more than the run's 57.15 mm"),
        ("tee", {"begin": 5.0}, "begin: does not lie before the branch"),
        ("tee", {"branch_angle": 0.0}, "branch_angle: the branch does not leave the run"),
        ("tee", {"reach": 60.0}, r"thickness: .*; give at most 0\.8 mm or cover the run from -82\.2 to 82\.2 mm and to 109\.2 mm along the branch"),
        ("hole for a branch", {"branch_radius": 40.0, "begin": -10.0}, r"begin: -10 mm is too near the branch; give at most -18\.5 mm"),
        ("hole for a branch", {"branch_radius": 40.0, "end": 45.0}, r"thickness: .*; leave it bare or cover the run from -18\.5 to 95\.6 mm"),
    ],
)
def test_impossible_dimensions_are_refused_with_the_component_s_name(name, changes, message):
    with pytest.raises(InputError, match=f"^C1: {message}"):
        covering_bodies(dataclasses.replace(EVERY_KIND[name], **changes))


def test_the_extent_that_a_message_names_can_be_built():
    covering = dataclasses.replace(EVERY_KIND["tee"], begin=-40.0, end=40.0, reach=70.0)
    with pytest.raises(InputError, match="cover the run") as error:
        covering_bodies(covering)
    begin, end, reach = (float(number) for number in re.search(r"from ([-\d.]+) to ([\d.]+) mm and to ([\d.]+) mm", str(error.value)).groups())
    assert_right(dataclasses.replace(covering, begin=begin, end=end, reach=reach))
