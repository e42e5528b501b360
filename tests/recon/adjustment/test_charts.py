# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components as unknowns: motions, and their derivatives in images and at ports against differences of the true functions."""

from dataclasses import fields, replace

import numpy as np
import pytest
from parts import KINDS, PARAMETERS, Sight, bend, in_pose, part, plate, richardson, straight, turned
from scipy.spatial.transform import Rotation
from single import changed as moved
from single import chart_of, normalised, port_of, rates_of
from synthetic import cameras

from pipeworkbench.pipeline import Elbow
from pipeworkbench.recon.adjustment.charts import MOTION, RIGID, by_motion
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.sampling import samples_of
from pipeworkbench.recon.bodies import SIZE_NAMES, Bodies
from pipeworkbench.recon.shapes import shapes_of
from pipeworkbench.recon.vectors import angle_between, unit

CAMERAS = cameras()
ACCURACY = 1e-6  # relative
SEEDS = range(3)
EVERY_KIND = pytest.mark.parametrize("kind", KINDS)
EVERY_POSE = pytest.mark.parametrize("seed", SEEDS)


def component_of(kind, seed):
    return in_pose(part(kind), seed)


def design_of(sight, component):
    """Return by how much (n, k), px, the samples' distances grow with each parameter."""
    return sight.seen.gain[:, None] * rates_of(component, sight) @ chart_of(component).basis


def points_of(component):
    return np.array(
        [getattr(component, f.name) for f in fields(component) if f.name in ("start", "end", "intersection", "branch_end", "face", "axis")]
    )


def sizes_of(component):
    return np.array([getattr(component, name) for name in SIZE_NAMES[type(component)]])


def assert_same(one, other, tolerance=1e-9):
    assert points_of(one) == pytest.approx(points_of(other), abs=tolerance)
    assert sizes_of(one) == pytest.approx(sizes_of(other), abs=tolerance)


# ---------------------------------------------------------------- images


@EVERY_KIND
@EVERY_POSE
def test_distances_in_the_image_change_as_the_design_says(kind, seed):
    component = component_of(kind, seed)
    chart = chart_of(component)
    camera = CAMERAS[seed % len(CAMERAS)]
    sight = Sight(camera, component)
    assert len(sight) >= len(PARAMETERS)
    design = design_of(sight, component)
    for column, name in enumerate(chart.names):
        truth = richardson(lambda h, way=chart.basis[:, column]: sight.distances(moved(component, h * way)), 0.2)
        assert design[:, column] == pytest.approx(truth, rel=ACCURACY, abs=ACCURACY * np.abs(design).max()), name


# what is open where the ends of a surface are not seen: a torus looks the same along its bend, however far it bends, and a cone may
# begin anywhere on itself and is round even where its pipes are offset; a flange without a tapering neck says nothing of the pipe
OPEN = {"elbow": 2, "elbow by 45 degrees": 2, "concentric reducer": 1, "eccentric reducer": 2, "flat flange": 1, "flange with a hub": 1}


@EVERY_KIND
def test_images_determine_all_parameters_but_what_no_contour_shows(kind):
    component = component_of(kind, 11)
    design = np.concatenate([design_of(Sight(camera, component), component) for camera in CAMERAS])
    values = np.linalg.svd(design, compute_uv=False)
    open_ways = OPEN.get(kind, 0)
    assert (values < 1e-9 * values[0]).sum() == open_ways
    assert values[len(values) - open_ways - 1] > 1e-3 * values[0]


def test_samples_of_many_components_are_like_those_of_each():
    components = [component_of(kind, seed) for seed, kind in enumerate(KINDS)]
    sights = [Sight(CAMERAS[0], component) for component in components]
    alone = [
        by_motion(Bodies.of([one]), np.zeros(len(s), np.intp), s.names, s.seen.point, s.seen.outward)
        for one, s in zip(components, sights, strict=True)
    ]
    order = np.random.default_rng(1).permutation(sum(map(len, sights)))
    owner, names, point, outward = (
        np.concatenate(values)[order]
        for values in (
            [np.full(len(s), row) for row, s in enumerate(sights)],
            [s.names for s in sights],
            [s.seen.point for s in sights],
            [s.seen.outward for s in sights],
        )
    )
    together = by_motion(Bodies.of(components), owner, names, point, outward)
    assert together == pytest.approx(np.concatenate(alone)[order], abs=1e-12)


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.0, 0.0, np.pi / 2), (0.0, np.pi / 2, 0.0), (0.3, 0.5, 0.7)])
def test_samples_stay_on_a_flange_that_turns_a_little_also_where_its_axis_is_level_or_plumb(turn):
    """Samples are bound to edges: they must not leap around the rim between two iterations."""
    flange = turned(plate(), Rotation.from_euler("xyz", turn).as_matrix())
    first, second = (moved(flange, np.array([0, 0, 0, *way, 0, 0, 0])) for way in ((1e-4, -3e-4, 2e-4), (-3e-4, 2e-4, -1e-4)))
    samples = samples_of(CAMERAS[0], Bodies.of([first]), shapes_of([first]), AdjustmentSettings())
    here, there = (samples.seen_by(CAMERAS[0], shapes_of([one])).position for one in (first, second))
    # what is turned by 0.7 mrad and is 110 mm wide moves by 0.1 mm, which are 0.05 px
    assert len(samples) > 10
    assert np.linalg.norm(here - there, axis=1).max() < 0.3


# ---------------------------------------------------------------- ports


@EVERY_KIND
@EVERY_POSE
def test_ports_change_as_their_derivatives_say(kind, seed):
    component = component_of(kind, seed)
    for number, port in enumerate(component.ports):
        moving = port_of(component, number)
        assert moving.point == pytest.approx(np.array(port.point), abs=1e-12)
        assert moving.direction == pytest.approx(np.array(port.direction), abs=1e-12)
        assert moving.radius == port.diameter / 2
        for column in range(RIGID + len(SIZE_NAMES[type(component)])):
            step = 1e-3 if column in range(3, RIGID) or (isinstance(component, Elbow) and column == MOTION - 1) else 0.1

            def values(h, component=component, number=number, column=column):
                there = moved(component, h * np.eye(MOTION)[column]).ports[number]
                return np.array([*there.point, *there.direction, there.diameter / 2])

            truth = richardson(values, step)
            largest = max(np.abs(truth).max(), 1.0)
            assert moving.by_motion[:, column] == pytest.approx(truth, rel=ACCURACY, abs=ACCURACY * largest), (number, column)


# ---------------------------------------------------------------- motions


@EVERY_KIND
def test_motion_of_nothing_changes_nothing(kind):
    component = component_of(kind, 3)
    assert_same(moved(component, np.zeros(MOTION)), component)


@EVERY_KIND
@EVERY_POSE
def test_motion_and_its_opposite_cancel(kind, seed):
    random = np.random.default_rng(seed)
    component = component_of(kind, seed)
    motion = np.concatenate([random.normal(0, 30, 3), random.normal(0, 0.3, 3), random.normal(0, 0.2, 3)])
    assert_same(moved(moved(component, motion), -motion), component, 1e-8)


@EVERY_KIND
def test_two_motions_are_one_with_both_turns(kind):
    random = np.random.default_rng(5)
    component = component_of(kind, 5)
    first, second = (np.concatenate([random.normal(0, 30, 3), random.normal(0, 0.3, 3), [2.0, 0.0, 0.0]]) for _ in range(2))
    turns = Rotation.from_rotvec(second[3:RIGID]) * Rotation.from_rotvec(first[3:RIGID])
    both = np.concatenate([first[:3] + second[:3], turns.as_rotvec(), first[RIGID:] + second[RIGID:]])
    assert_same(moved(moved(component, first), second), moved(component, both), 1e-8)


@EVERY_KIND
def test_rigid_motion_keeps_all_sizes_and_distances(kind):
    component = component_of(kind, 8)
    there = moved(component, np.array([10.0, -20, 30, 0.4, -0.5, 0.6, 0, 0, 0]))
    assert sizes_of(there) == pytest.approx(sizes_of(component), abs=1e-12)
    for one, other in zip(component.ports, there.ports, strict=True):
        assert one.diameter == pytest.approx(other.diameter)
    spread, other_spread = (np.ptp([port.point for port in x.ports], axis=0) for x in (component, there))
    assert np.linalg.norm(spread) == pytest.approx(np.linalg.norm(other_spread)) or len(component.ports) != 2


@EVERY_KIND
@pytest.mark.parametrize("change", [-1e5, -300.0, 300.0])
def test_sizes_stay_positive_however_large_a_step_is(kind, change):
    component = component_of(kind, 2)
    there = moved(component, np.concatenate([np.zeros(RIGID), np.full(3, change)]))
    assert (sizes_of(there) > 0).all()
    assert np.isfinite(points_of(there)).all()
    shapes_of([there])


@pytest.mark.parametrize("kind", ["pipe", "elbow", "flange", "tee", "concentric reducer", "cap"])
def test_component_with_a_wall_stays_one_however_much_it_shrinks(kind):
    component = replace(component_of(kind, 2), wall_thickness=3.6)
    there = moved(component, np.concatenate([np.zeros(RIGID), [-1e4, -1e4, 0.0]]))
    assert there.narrowest_diameter > 2 * 3.6


def test_flange_stays_wider_than_what_is_on_it():
    flange = in_pose(plate(raised_face_diameter=158.0, raised_face_height=3.0, K=180.0, L=18.0, bolts=8), 4)
    there = moved(flange, np.array([0, 0, 0, 0, 0, 0, 0, -60.0, -30.0]))
    assert there.D > there.K + there.L
    assert there.C > there.raised_face_height


def test_thicker_plate_keeps_its_face_and_its_neck():
    flange = plate()
    there = moved(flange, np.array([0, 0, 0, 0, 0, 0, 0, 0, 3.0]))
    assert there.face == pytest.approx(flange.face)
    assert there.length - there.C == pytest.approx(flange.length - flange.C)


# ---------------------------------------------------------------- elbows


@EVERY_POSE
def test_elbow_keeps_the_tangent_lengths_that_its_bend_radius_and_angle_make(seed):
    random = np.random.default_rng(seed)
    elbow = in_pose(bend(angle_deg=random.uniform(20, 120), bend_radius=random.uniform(100, 400)), seed)
    there = moved(elbow, np.concatenate([random.normal(0, 20, 3), random.normal(0, 0.2, 3), [3.0, random.normal(0, 20), random.normal(0, 0.1)]]))
    come, go = np.subtract(there.intersection, there.start), np.subtract(there.end, there.intersection)
    angle = angle_between(come, go)
    assert np.degrees(angle) == pytest.approx(there.angle_deg)
    assert np.linalg.norm(come) == pytest.approx(there.bend_radius * np.tan(angle / 2))
    assert np.linalg.norm(go) == pytest.approx(np.linalg.norm(come))


@EVERY_POSE
@pytest.mark.parametrize("change", [-40.0, 0.5, 60.0])
def test_bend_radius_alone_moves_the_ends_along_their_axes_and_not_the_intersection(seed, change):
    """Sect. 7.3, Fig. 14b."""
    elbow = in_pose(bend(angle_deg=70.0, bend_radius=200.0), seed)
    there = moved(elbow, np.array([0, 0, 0, 0, 0, 0, 0, change, 0]))
    assert there.bend_radius == pytest.approx(200.0 + change)
    assert there.intersection == pytest.approx(elbow.intersection, abs=1e-9)
    for end in ("start", "end"):
        axis = unit(np.subtract(getattr(elbow, end), elbow.intersection))
        shift = np.subtract(getattr(there, end), getattr(elbow, end))
        assert shift == pytest.approx(change * np.tan(np.radians(35.0)) * axis, abs=1e-9)


def test_angle_alone_turns_both_axes_alike_in_the_elbows_plane():
    elbow = in_pose(bend(angle_deg=70.0), 6)
    there = moved(elbow, np.array([0, 0, 0, 0, 0, 0, 0, 0, np.radians(4.0)]))
    assert there.angle_deg == pytest.approx(74.0)
    normal = unit(np.cross(elbow.ports[0].direction, elbow.ports[1].direction))
    for one, other in zip(elbow.ports, there.ports, strict=True):
        assert np.degrees(angle_between(np.array(one.direction), np.array(other.direction))) == pytest.approx(2.0)
        assert np.dot(other.direction, normal) == pytest.approx(0.0, abs=1e-12)


def test_elbow_whose_ends_do_not_fit_is_put_right_at_its_intersection():
    elbow = bend()
    off = np.array([3.0, 0.0, 0.0])
    there = normalised(replace(elbow, start=tuple(np.subtract(elbow.start, off)), angle_deg=88.0))
    assert there.start == pytest.approx(elbow.start)
    assert there.end == pytest.approx(elbow.end)
    assert there.angle_deg == pytest.approx(90.0)


def test_pipe_does_not_move_along_its_axis_and_nothing_round_turns_about_it():
    axis = {kind: component_of(kind, 9) for kind in ("pipe", "flange", "concentric reducer", "cap")}
    for kind, component in axis.items():
        way = np.array(component.ports[0].direction)
        basis = chart_of(component).basis
        assert np.abs(way @ basis[3:RIGID]).max() < 1e-12, kind
        if kind == "pipe":
            assert np.abs(way @ basis[:3]).max() < 1e-12


def test_parameters_are_millimetres_at_the_components_own_scale():
    pipe = straight(length=500.0)
    chart = chart_of(pipe)
    for column, name in enumerate(chart.names):
        there = moved(pipe, chart.basis[:, column])
        farthest = max(np.linalg.norm(np.subtract(getattr(there, end), getattr(pipe, end))) for end in ("start", "end"))
        expected = 0.0 if name == "outer_diameter" else 1.0
        assert farthest == pytest.approx(expected, abs=1e-3), name
