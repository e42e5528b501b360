# SPDX-License-Identifier: LGPL-2.1-or-later
"""The simulator does what it says: pipework that fits together exactly, edges with noise of a known size, starting values a known way off."""

import functools
from dataclasses import replace

import grown
import numpy as np
import pytest
from grown import DIAMETERS, GASKET_MM
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated import (
    CLUTTER,
    Noise,
    _correlated,
    brighter_runs,
    errors,
    middle_and_axis,
    perturbed,
    plant,
    rig,
    simulated_edges,
    simulated_pipeline,
    simulated_views,
)

from pipeworkbench import catalogue
from pipeworkbench.pipeline import Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.edges import BORDER
from pipeworkbench.recon.topology import join

CAMERAS = rig(np.zeros(3), 0.0)
CAMERA = CAMERAS[0]
NEARER = Pipe(id="near", start=(-500.0, 4000.0, 250.0), end=(700.0, 4200.0, 150.0), outer_diameter=114.3)
FURTHER = Pipe(id="far", start=(100.0, 5000.0, -400.0), end=(150.0, 4900.0, 800.0), outer_diameter=60.3)
EXACT = Noise(sigma=0.0)


@functools.cache
def pipework(seed=0, count=40):
    return simulated_pipeline(np.random.default_rng(seed), count, CAMERAS)


def edges_of(components=(NEARER, FURTHER), noise=EXACT, seed=0, brighter=None):
    brighter = np.ones(len(components), bool) if brighter is None else np.array(brighter)
    return simulated_edges(CAMERA, components, np.random.default_rng(seed), noise, brighter)


def gaps(rays, pipe):
    """Return the distances (n,) of lines of sight (n, 3) from a pipe's axis."""
    direction = np.subtract(pipe.end, pipe.start) / pipe.length
    across = np.cross(rays, direction)
    return np.abs(across @ (np.array(pipe.start) - CAMERA.projection_centre)) / np.linalg.norm(across, axis=1)


def ports_of(joint, components):
    by_id = {component.id: component for component in components}
    one, other = by_id[joint.a], by_id[joint.b]
    return one.ports[joint.a_port], other.ports[joint.b_port], isinstance(one, Flange) and isinstance(other, Flange)


@settings(deadline=None, max_examples=12, database=None)
@given(st.integers(0, 10**6), st.integers(1, 25))
def test_components_fit_together_exactly(seed, count):
    components, joints = simulated_pipeline(np.random.default_rng(seed), count, CAMERAS)
    assert len(components) == count == len({component.id for component in components})
    for joint in joints:
        one, other, faces = ports_of(joint, components)
        apart = GASKET_MM * np.array(one.direction) if faces else np.zeros(3)
        assert np.subtract(other.point, one.point) == pytest.approx(apart, abs=1e-9)
        assert np.add(one.direction, other.direction) == pytest.approx(np.zeros(3), abs=1e-9)
        assert one.diameter == other.diameter


def test_joints_are_those_of_the_topology():
    components, joints = pipework(count=60)

    def ends(joints):
        return {frozenset([(joint.a, joint.a_port), (joint.b, joint.b_port)]) for joint in joints}

    assert ends(joints) == ends(join(components))
    assert len(joints) > 0.6 * len(components)


def test_dimensions_are_those_of_the_standards():
    components = [component for seed in range(4) for component in pipework(seed)[0]]
    assert {type(component).__name__ for component in components} == {"Pipe", "Elbow", "Flange", "Tee", "Reducer", "Cap"}
    assert len({component.outer_diameter for component in components}) > 5
    for component in components:
        assert component.outer_diameter in DIAMETERS
        match component:
            case Elbow():
                assert component.bend_radius in [bend.bend_radius for bend in catalogue.bends(component.outer_diameter)]
                tangent = component.bend_radius * np.tan(np.radians(component.angle_deg) / 2)
                assert np.linalg.norm(np.subtract(component.start, component.intersection)) == pytest.approx(tangent, abs=1e-9)
                assert component.angle_deg in (45.0, 90.0)
            case Flange():
                assert (component.D, component.C) in [(row.D, row.C) for row in catalogue.flanges_of_pipe(component.outer_diameter)]
            case Tee():
                run = np.subtract(component.end, component.start)
                assert run @ np.subtract(component.branch_end, component.intersection) == pytest.approx(0.0, abs=1e-6)
                assert catalogue.tees(component.outer_diameter, component.branch_diameter)
            case Reducer():
                lengths = [row.length for row in catalogue.reducers(component.outer_diameter, component.end_diameter)]
                assert min(abs(component.length - length) for length in lengths) < 1e-9


def test_everything_is_before_the_cameras():
    components, _ = pipework()
    points = np.array([port.point for component in components for port in component.ports])
    distance = np.linalg.norm(points - CAMERA.projection_centre, axis=1)
    assert distance.min() >= 3000 - 200  # a flange's rim and what is beside an axis
    assert distance.max() <= 6000
    for camera in CAMERAS:
        assert camera.sees(camera.project(points)).all()


def test_most_of_the_pipes_can_be_seen():
    components, _ = pipework(count=60)
    for camera in CAMERAS:
        contour = contour_of(camera, components, 10.0)
        pipes = np.array([isinstance(component, Pipe) for component in components])[contour.component]
        assert contour.visible[pipes].mean() > 0.8


def test_same_seed_gives_the_same():
    assert pipework(3, 12) == simulated_pipeline(np.random.default_rng(3), 12, CAMERAS)


def test_too_much_for_the_pictures_is_refused(monkeypatch):
    monkeypatch.setattr(grown, "STARTS", 3)
    monkeypatch.setattr(grown, "LAST_STARTS", 3)
    with pytest.raises(RuntimeError, match="no room for 400 components"):
        simulated_pipeline(np.random.default_rng(0), 400, CAMERAS)


def test_rig_is_the_sample_s_turned_and_moved():
    position = np.array([1000.0, -200.0, 50.0])
    moved = rig(position, np.pi / 2, "B ")
    local = np.array([[300.0, 4500.0, 200.0]])
    # what lies ahead of one lies to the left of the other, at the same place in the pictures
    turned = np.array([[-4500.0, 300.0, 200.0]]) + position
    for one, other in zip(CAMERAS, moved, strict=True):
        assert other.name == f"B {one.name}"
        assert other.project(turned) == pytest.approx(one.project(local), abs=1e-7)


@pytest.mark.slow
def test_plant_is_seen_by_one_to_three_stations():
    components, joints, rigs = plant(np.random.default_rng(1), 90, 3)
    assert len(components) == 90 == len({component.id for component in components})
    assert len(rigs) == 3
    brighter = np.ones(len(components), bool)
    points = [
        [np.bincount(simulated_edges(camera, components, np.random.default_rng(0), EXACT, brighter).component, minlength=90) for camera in cameras]
        for cameras in rigs
    ]
    stations = ((np.array(points) > 10).sum(axis=1) >= 2).sum(axis=0)
    assert np.mean(stations >= 1) > 0.97
    assert 0.3 < np.mean(stations >= 2) < 0.95
    for joint in joints:
        one, other, faces = ports_of(joint, components)
        assert np.linalg.norm(np.subtract(other.point, one.point)) == pytest.approx(GASKET_MM if faces else 0.0, abs=1e-9)


def test_exact_edges_lie_where_lines_of_sight_touch():
    found = edges_of()
    for row, pipe in enumerate((NEARER, FURTHER)):
        points = found.edges.position[found.component == row]
        assert len(points) > 200
        assert gaps(CAMERA.rays(points), pipe) == pytest.approx(pipe.outer_diameter / 2, abs=1e-6)


def test_normals_look_to_the_brighter_side():
    found = edges_of(brighter=[True, False])
    for row, pipe in enumerate((NEARER, FURTHER)):
        of_pipe = found.component == row
        beside = found.edges.position[of_pipe] + 2 * found.edges.normal[of_pipe]
        inside = gaps(CAMERA.rays(beside), pipe) < pipe.outer_diameter / 2
        assert inside.all() if row == 0 else not inside.any()


def test_edges_behind_other_components_are_not_there():
    found, alone = edges_of(), edges_of([FURTHER])
    hidden = gaps(CAMERA.rays(alone.edges.position), NEARER) < NEARER.outer_diameter / 2
    assert 50 < hidden.sum() < len(hidden) / 2
    assert (found.component == 1).sum() == pytest.approx((~hidden).sum(), abs=12)
    assert (gaps(CAMERA.rays(found.edges.position[found.component == 1]), NEARER) > NEARER.outer_diameter / 2 - 3).all()


def test_what_is_seen_is_what_the_contours_say():
    components, _ = pipework(count=60)
    found, contour = edges_of(components), contour_of(CAMERA, components, 1.0, 1.0)
    counts = np.bincount(found.component, minlength=60), np.bincount(contour.component[contour.visible], minlength=60)
    # a pixel on a slanted edge holds more than one sample
    assert 0.7 * counts[1].sum() < counts[0].sum() <= counts[1].sum()
    assert (counts[0] <= counts[1] + 20).all()


def test_edge_map_is_one_of_the_detector_s():
    found = edges_of(pipework()[0], Noise(sigma=0.2, smoothing=1.5, clutter=20, outliers=0.05))
    edges = found.edges
    height, width = edges.index.shape
    assert (width, height) == (CAMERA.interior.width, CAMERA.interior.height)
    assert (edges.pixel == np.rint(edges.position)).all()
    assert (edges.index[edges.pixel[:, 1], edges.pixel[:, 0]] == np.arange(len(edges))).all()
    assert edges.pixel.min() >= BORDER
    assert np.linalg.norm(edges.normal, axis=1) == pytest.approx(1.0)
    assert (edges.sigma == 0.2).all()
    assert (edges.smoothing == 1.5).all()


@pytest.mark.parametrize("smoothing", [1.2, 1.9, 4.0])
def test_noise_of_neighbours_is_that_of_smoothed_white_noise(smoothing):
    count, curves = 1000, 300
    noise = _correlated(np.repeat(np.arange(curves), count), smoothing, np.random.default_rng(0)).reshape(curves, count)
    assert noise.std() == pytest.approx(1.0, abs=0.01)
    for lag in (1, 2, 4, 8):
        assert (noise[:, lag:] * noise[:, :-lag]).mean() == pytest.approx(np.exp(-(lag**2) / (4 * smoothing**2)), abs=0.02)
    # one curve's last point and the next one's first are not neighbours
    assert abs((noise[1:, 0] * noise[:-1, -1]).mean()) < 4 / np.sqrt(curves)


def test_white_noise_where_nothing_is_smoothed():
    noise = _correlated(np.zeros(100000, int), 0.0, np.random.default_rng(0))
    assert noise.std() == pytest.approx(1.0, abs=0.01)
    assert abs((noise[1:] * noise[:-1]).mean()) < 0.015


def test_edge_points_err_by_sigma_across_the_edge():
    found = edges_of(pipework()[0], Noise(sigma=0.1))
    assert found.error.std() == pytest.approx(0.1, rel=0.05)
    assert abs(found.error.mean()) < 0.01
    pipe = edges_of([NEARER], Noise(sigma=0.1))
    exact = edges_of([NEARER])
    pixels_per_mm = CAMERA.interior.pixels_per_radian / np.linalg.norm(np.add(NEARER.start, NEARER.end) / 2)
    off = (gaps(CAMERA.rays(pipe.edges.position), NEARER) - NEARER.outer_diameter / 2) * pixels_per_mm
    assert len(pipe.edges) == pytest.approx(len(exact.edges), rel=0.02)
    assert off == pytest.approx(pipe.error, abs=0.05)
    assert np.corrcoef(off, pipe.error)[0, 1] > 0.995


def test_curves_have_their_own_offset_and_trend():
    components, _ = pipework()
    found = edges_of(components, Noise(sigma=0.0, common=0.3))
    assert found.common.std() == pytest.approx(0.3, rel=0.2)
    circles = []
    for curve in np.unique(found.curve):
        error = found.error[found.curve == curve]
        if np.ptp(error) < 1e-9:
            assert error == pytest.approx(found.common[curve])
        else:
            circles.append(error)
    assert len(circles) > 5
    trend = edges_of(components, Noise(sigma=0.0, trend=0.3))
    ends = [trend.error[trend.curve == curve][[0, -1]] for curve in np.unique(trend.curve)]
    # a curve that is seen from end to end is off by the same to both sides
    mirrored = np.array([pair for pair in ends if pair.sum() == pytest.approx(0.0, abs=0.01)])
    assert len(mirrored) > 20
    assert np.sqrt((mirrored**2).mean()) == pytest.approx(0.3, rel=0.3)


def test_opposite_parts_of_a_circle_err_independently():
    """An offset, a cosine and a sine with half of the variance each: at each place they have the whole of it together."""
    flange = Flange(id="f", face=(0, 4000, 0), axis=(0, -1, 0), flange_type="05", pn=16, outer_diameter=114.3, D=220, C=20, length=20)
    parts = []
    for seed in range(60):
        found = edges_of([flange], Noise(sigma=0.0, common=0.3), seed)
        for curve in np.unique(found.curve):
            ours = found.curve == curve
            place = found.edges.position[ours] - found.edges.position[ours].mean(axis=0)
            if ours.sum() > 100:
                # nearly seen from ahead, so that the angle in the picture is nearly that around the circle
                angle = np.arctan2(place[:, 1], place[:, 0])
                design = np.column_stack([np.ones(len(angle)), np.cos(angle), np.sin(angle)])
                parts.append(np.linalg.lstsq(design, found.error[ours], rcond=None)[0])
    assert len(parts) >= 60
    assert np.std(parts, axis=0) == pytest.approx([0.3 / np.sqrt(2)] * 3, rel=0.25)
    assert np.abs(np.corrcoef(np.transpose(parts)) - np.eye(3)).max() < 0.4


def test_stretches_are_missing():
    components, _ = pipework(count=60)
    whole, part = edges_of(components), edges_of(components, replace(EXACT, missing=0.3))
    assert len(part.edges) / len(whole.edges) == pytest.approx(0.7, abs=0.03)
    pipe, holed = edges_of([NEARER]), edges_of([NEARER], replace(EXACT, missing=0.3))
    upper = holed.edges.position[holed.curve == 0]
    steps = np.linalg.norm(np.diff(upper, axis=0), axis=1)
    assert steps[steps > 3].min() > 10
    # what is there comes in whole stretches: at most one hole in 12 px
    assert (steps > 3).sum() < len(pipe.edges) / 24


def test_gross_errors_are_as_many_and_as_large_as_asked():
    found = edges_of(pipework(count=60)[0], Noise(sigma=0.05, outliers=0.1))
    assert found.outlier.mean() == pytest.approx(0.1, abs=0.02)
    size = np.abs(found.error[found.outlier])
    assert size.min() >= 2
    assert size.max() <= 6
    assert np.abs(found.error[~found.outlier]).max() < 0.5
    assert (found.error[found.outlier] > 0).mean() == pytest.approx(0.5, abs=0.1)


def test_clutter_is_straight():
    found = edges_of([NEARER], Noise(sigma=0.0, clutter=50))
    stray = found.component == CLUTTER
    assert 50 * 30 < stray.sum() < 50 * 300
    normal = found.edges.normal[stray]
    assert len(np.unique(normal.round(9), axis=0)) <= 50
    along = np.abs(np.einsum("ni,ni->n", np.diff(found.edges.position[stray], axis=0), normal[1:]))
    assert (along < 1e-9).mean() > 0.95


def test_views_share_the_polarity_of_a_run():
    components, joints = pipework(count=60)
    brighter = brighter_runs(components, np.random.default_rng(0))
    assert brighter.any()
    assert not brighter.all()
    row = {component.id: number for number, component in enumerate(components)}
    assert all(brighter[row[joint.a]] == brighter[row[joint.b]] for joint in joints)
    views = simulated_views(CAMERAS, components, np.random.default_rng(0))
    assert [view.camera for view in views] == list(CAMERAS)
    assert all(view.smooth.shape == view.edges.index.shape for view in views)
    assert all(len(view.edges) > 1000 for view in views)


@pytest.mark.parametrize(("position_mm", "direction_deg"), [(20.0, 3.0), (0.5, 0.01), (5.0, 0.0), (0.0, 1.0)])
def test_starting_values_are_as_far_off_as_asked(position_mm, direction_deg):
    components, _ = pipework()
    off = perturbed(components, np.random.default_rng(0), position_mm, direction_deg)
    for one, other in zip(components, off, strict=True):
        (middle, axis), (there, tilted) = middle_and_axis(one), middle_and_axis(other)
        assert np.linalg.norm(there - middle) == pytest.approx(position_mm, abs=1e-9)
        assert np.arctan2(np.linalg.norm(np.cross(axis, tilted)), axis @ tilted) == pytest.approx(np.radians(direction_deg), abs=1e-9)
        assert other.outer_diameter == one.outer_diameter
        assert other.id == one.id
    found = errors(off, components)
    assert np.linalg.norm(found.direction, axis=1) == pytest.approx(np.radians(direction_deg), abs=1e-9)
    pipes = np.array([isinstance(component, Pipe) for component in components])
    assert np.linalg.norm(found.position[~pipes], axis=1) == pytest.approx(position_mm, abs=1e-9)
    # across a random direction there is on average 2 / 3 of the square
    assert (np.linalg.norm(found.position[pipes], axis=1) <= position_mm * 1.01 + 1e-9).all()
    assert (found.diameter == 0).all()


def test_nothing_is_off_the_truth_itself():
    components, _ = pipework()
    found = errors(components, components)
    assert found.position == pytest.approx(0.0, abs=1e-12)
    assert found.direction == pytest.approx(0.0, abs=1e-12)
    assert found.turn == pytest.approx(0.0, abs=1e-12)


def test_pipe_that_is_longer_is_not_off():
    axis = np.subtract(NEARER.end, NEARER.start) / NEARER.length
    longer = replace(NEARER, end=tuple(NEARER.end + 80 * axis), outer_diameter=115.0)
    found = errors([longer], [NEARER])
    assert found.position == pytest.approx(0.0, abs=1e-9)
    assert found.diameter == pytest.approx([0.7])


def test_tilt_is_told_along_both_axes_and_turn_about_the_own():
    elbow = Elbow(id="e", start=(-100, 0, 0), intersection=(0, 0, 0), end=(0, 100, 0), angle_deg=90, bend_radius=100, outer_diameter=60.3)
    chord = np.array([1.0, 1.0, 0.0]) / np.sqrt(2)
    angle = 0.01
    turned = [np.array(point) for point in (elbow.start, elbow.end)]
    # Rodrigues' formula
    turned = [np.cos(angle) * p + np.sin(angle) * np.cross(chord, p) + (1 - np.cos(angle)) * (chord @ p) * chord for p in turned]
    found = errors([replace(elbow, start=tuple(turned[0]), end=tuple(turned[1]))], [elbow])
    assert found.turn == pytest.approx([angle])
    assert found.direction == pytest.approx(0.0, abs=1e-12)
