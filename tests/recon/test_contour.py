# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours of components: the exact condition, the image's side of it, and what hides what."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from synthetic import cameras

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Elbow, Flange, Pipe
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.cylinder import Cylinder, contour
from pipeworkbench.recon.shapes import shapes_of
from pipeworkbench.recon.visibility import hidden

CAMERA = cameras()[0]
P = CAMERA.projection_centre
TARGET = np.array([0.0, 3000.0, 0.0])


def elbow(rotation=None, angle_deg=90.0, bend_radius=152.0, outer_diameter=114.3, place=TARGET, name="elbow"):
    """Return a bend whose torus is centred in ``place``; unturned it starts towards +x and bends towards +z."""
    rotation = np.eye(3) if rotation is None else rotation
    angle = np.radians(angle_deg)
    local = np.array(
        [
            [bend_radius, 0, 0],
            [bend_radius * np.cos(angle), 0, bend_radius * np.sin(angle)],
            [bend_radius, 0, bend_radius * np.tan(angle / 2)],
        ]
    )
    start, end, corner = (tuple(row) for row in local @ rotation.T + place)
    return Elbow(id=name, outer_diameter=outer_diameter, start=start, end=end, intersection=corner, angle_deg=angle_deg, bend_radius=bend_radius)


def pipe(start, end, outer_diameter=114.3, name="pipe"):
    return Pipe(id=name, outer_diameter=outer_diameter, start=tuple(map(float, start)), end=tuple(map(float, end)))


def flange(axis=(0.6, -0.8, 0.0), face=(100.0, 2900.0, -100.0), name="flange", **changes):
    dimensions = {"outer_diameter": 114.3, "flange_type": "11", "pn": 16, "D": 220.0, "C": 20.0, "length": 52.0, "neck_diameter": 131.0}
    return Flange(id=name, face=face, axis=tuple(np.array(axis) / np.linalg.norm(axis)), **{**dimensions, **changes})


rotations = st.tuples(*[st.floats(-np.pi, np.pi)] * 3).map(lambda a: Rotation.from_euler("xyz", a).as_matrix())


# ---------------------------------------------------------------- the condition in space


@given(rotations, st.floats(20, 120), st.floats(1.2, 5))
@settings(max_examples=40)
def test_line_of_sight_touches_the_torus(rotation, angle_deg, ratio):
    bend = elbow(rotation, angle_deg, bend_radius=57.15 * ratio)
    found = contour_of(CAMERA, [bend])
    local = (found.point - TARGET) @ rotation  # the torus lies in the local xz plane
    on_circle = local * [1, 0, 1]
    on_circle *= bend.bend_radius / np.linalg.norm(on_circle, axis=1, keepdims=True)
    assert np.linalg.norm(local - on_circle, axis=1) == pytest.approx(57.15, abs=1e-6)
    surface_normal = (local - on_circle) @ rotation.T / 57.15
    sight = (found.point - P) / np.linalg.norm(found.point - P, axis=1, keepdims=True)
    assert np.abs(np.einsum("ni,ni->n", surface_normal, sight)).max() < 1e-9
    assert np.abs(found.outward - surface_normal).max() < 1e-9
    turn = np.degrees(np.arctan2(local[:, 2], local[:, 0]))
    assert turn.min() >= -1e-6
    assert turn.max() <= angle_deg + 1e-6


@given(rotations, st.floats(200, 900), st.floats(20, 300))
@settings(max_examples=30)
def test_pipe_has_the_two_lines_of_a_cylinder(rotation, length, diameter):
    axis = rotation[:, 0]
    one = pipe(TARGET - axis * length / 2, TARGET + axis * length / 2, diameter)
    found = contour_of(CAMERA, [one])
    assert set(found.names) == {"pipe"}
    reference = contour(CAMERA, Cylinder(TARGET, axis, diameter / 2), np.linspace(-length / 2, length / 2, 400))
    for number in np.unique(found.curve):
        rows = found.curve == number
        off = []
        for side in range(2):
            # distance from the other's densely sampled line
            line = reference.position[0, side]
            gap = np.einsum("nmi,mi->nm", found.position[rows][:, None, :] - line[None], reference.normal[0, side])
            near = np.linalg.norm(found.position[rows][:, None, :] - line[None], axis=2)
            off.append(np.nanmax(np.abs(gap[np.arange(rows.sum()), np.nanargmin(near, axis=1)])) if np.isfinite(near).any() else np.inf)
        assert min(off) < 1e-3


def test_cone_of_a_neck_is_touched_too():
    one = flange(axis=(1.0, 0.2, 0.0))
    found = contour_of(CAMERA, [one])
    neck = found[np.array([found.names[c] == "neck" for c in found.curve])]
    assert len(neck) > 4
    axis = -np.array(one.axis)
    along = (neck.point - one.face) @ axis
    radial = neck.point - one.face - along[:, None] * axis
    radius = 131 / 2 + (along - 20) * (114.3 - 131) / 2 / 32
    assert np.linalg.norm(radial, axis=1) == pytest.approx(radius, abs=1e-6)
    slope = (114.3 - 131) / 2 / 32
    normal = radial / np.linalg.norm(radial, axis=1, keepdims=True) - slope * axis
    assert np.abs(np.einsum("ni,ni->n", normal, neck.point - P)).max() < 1e-6


# ---------------------------------------------------------------- the image's side


@pytest.mark.parametrize(
    "component", [elbow(), elbow(Rotation.from_euler("xyz", [0.7, 0.3, 1.1]).as_matrix(), 45), pipe((-200, 2900, -50), (250, 3200, 60)), flange()]
)
def test_samples_are_projections_a_step_apart_with_normals_across(component):
    found = contour_of(CAMERA, [component], interval=4.0)
    assert np.abs(CAMERA.project(found.point) - found.position).max() < 1e-9
    for number in np.unique(found.curve):
        rows = found.curve == number
        steps = np.diff(found.position[rows], axis=0)
        length = np.linalg.norm(steps, axis=1)
        assert length.mean() == pytest.approx(4.0, rel=2 / rows.sum())
        assert np.ptp(length) < 0.1 * length.mean() + 1e-6
        middle = found.normal[rows][:-1] + found.normal[rows][1:]
        sine = np.einsum("ni,ni->n", middle, steps) / np.linalg.norm(middle, axis=1) / length
        assert np.abs(sine).max() < 0.02
    assert np.linalg.norm(found.normal, axis=1) == pytest.approx(1)
    assert np.einsum("ni,ni->n", found.normal, found.tangent) == pytest.approx(0, abs=1e-12)
    assert (found.gain > 0).all()


@pytest.mark.parametrize(
    "component", [elbow(), elbow(Rotation.from_euler("xyz", [0.7, 0.3, 1.1]).as_matrix(), 60), pipe((-200, 2900, -50), (250, 3200, 60))]
)
def test_a_thicker_component_moves_its_contour_along_the_normal_by_gain_times_radius(component):
    grown = replace(component, outer_diameter=component.outer_diameter + 2.0)
    before, after = contour_of(CAMERA, [component], 2.0), contour_of(CAMERA, [grown], 0.5)
    for number in np.unique(before.curve):
        old, new = before[before.curve == number], after[after.curve == number]
        off = new.position[None] - old.position[:, None]
        lateral = np.abs(np.einsum("nmi,ni->nm", off, old.tangent))
        nearest = np.argmin(lateral, axis=1)
        inside = (np.arange(len(old)) > 2) & (np.arange(len(old)) < len(old) - 3)
        moved = np.einsum("ni,ni->n", off[np.arange(len(old)), nearest], old.normal)
        assert moved[inside] == pytest.approx(old.gain[inside], rel=0.03)


def test_normals_point_away_from_the_component():
    components = [elbow(), pipe((-300, 2900, 200), (250, 3200, 260)), flange()]
    found = contour_of(CAMERA, components)
    outline = found[np.isin([found.names[c] for c in found.curve], ["pipe", "elbow", "rim"]) & found.visible]
    for sign, covers in ((1, False), (-1, True)):
        beyond = P + 9000 * CAMERA.rays(outline.position + sign * 2 * outline.normal)
        covered, _ = hidden(P, beyond, shapes_of(components), outline.component, 0.0)
        # but for the outlines' ends, beside which there is nothing
        assert (covered == covers).mean() > 0.95


def test_an_elbows_contour_goes_on_where_the_pipes_ends():
    bend = elbow(Rotation.from_euler("xyz", [0.5, -0.4, 0.3]).as_matrix())
    start, corner = np.array(bend.start), np.array(bend.intersection)
    one = pipe(start - (corner - start) * 2, start)
    found = contour_of(CAMERA, [one, bend], interval=2.0)
    ends = np.array([found.position[found.curve == c][-1] for c in np.unique(found.curve[found.component == 0])])
    begins = np.array([found.position[found.curve == c][0] for c in np.unique(found.curve[found.component == 1])])
    gaps = np.linalg.norm(ends[:, None] - begins[None], axis=2)
    assert gaps.min(axis=1) == pytest.approx([0, 0], abs=1e-6)
    assert found.visible.mean() > 0.97  # neighbours touch; neither hides the other


# ---------------------------------------------------------------- what hides what

SIGHT = np.linspace(0, 1, 3000)


def depth_inside(component, points):
    """Return how deep points (n, 3) are inside a component, mm, negative outside: other formulas than the product's."""
    if isinstance(component, Pipe):
        a, b = np.array(component.start), np.array(component.end)
        along = (points - a) @ (b - a) / np.linalg.norm(b - a)
        off = np.linalg.norm(np.cross(points - a, b - a), axis=1) / np.linalg.norm(b - a)
        return np.minimum(component.outer_diameter / 2 - off, np.minimum(along, np.linalg.norm(b - a) - along))
    if isinstance(component, Elbow):
        start, end, corner = (np.array(x) for x in (component.start, component.end, component.intersection))
        middle = (start + end) / 2
        # the centre lies on the bisector, behind the chord's middle
        half = np.radians(component.angle_deg) / 2
        centre = corner + (middle - corner) / np.linalg.norm(middle - corner) * component.bend_radius / np.cos(half)
        normal = np.cross(start - centre, end - centre)
        normal /= np.linalg.norm(normal)
        offset = points - centre
        flat = offset - (offset @ normal)[:, None] * normal
        off = np.hypot(np.linalg.norm(flat, axis=1) - component.bend_radius, offset @ normal)
        turn = np.arccos(np.clip(flat @ (middle - centre) / np.linalg.norm(flat, axis=1) / np.linalg.norm(middle - centre), -1, 1))
        return np.minimum(component.outer_diameter / 2 - off, (half - turn) * component.bend_radius)
    axis = -np.array(component.axis)
    along = (points - component.face) @ axis
    off = np.linalg.norm(points - component.face - along[:, None] * axis, axis=1)
    plate = np.minimum(component.D / 2 - off, np.minimum(along, component.C - along))
    part = (along - component.C) / (component.length - component.C)
    radius = (component.neck_diameter + part * (component.outer_diameter - component.neck_diameter)) / 2
    return np.maximum(plate, np.minimum(radius - off, np.minimum(along - component.C, component.length - along)))


def deepest_before(component, point, margin):
    """Return how deep the line of sight dives into a component before it is ``margin`` mm from a point."""
    sight = point - P
    distance = np.linalg.norm(sight)
    near = max(distance - 1500, 0)
    t = near + SIGHT * (distance - margin - near)
    return depth_inside(component, P + t[:, None] * sight / distance).max()


@given(rotations, st.sampled_from([60.0, 90.0]))
@settings(max_examples=20)
def test_an_elbow_hides_its_own_contour_where_the_sight_passes_through_it(rotation, angle_deg):
    bend = elbow(rotation, angle_deg, bend_radius=90.0)
    found = contour_of(CAMERA, [bend], interval=3.0)
    # a sight that touches the surface without entering is 0.009 mm above it 1 mm before it touches
    depth = np.array([deepest_before(bend, point, 1.0) for point in found.point])
    assert not found.occluded.any()
    assert found.hidden[depth > 0.05].all()
    # what hides a sample may, where a contour turns back, lie in that last millimetre
    assert (found.hidden & (depth < -0.002)).sum() <= 1 + 0.03 * len(found)


@pytest.mark.parametrize("axis", [(0.6, -0.8, 0.0), (-0.6, 0.8, 0.0), (1.0, 0.05, 0.1), (0.2, 0.9, -0.5), (0.0, -1.0, 0.0)])
def test_a_flange_hides_its_far_side(axis):
    one = flange(axis)
    found = contour_of(CAMERA, [one], interval=2.0)
    depth = np.array([deepest_before(one, point, 4.0) for point in found.point])
    assert found.hidden[depth > 0.3].all()
    assert not found.hidden[depth < -0.3].any()
    facing = np.dot(one.axis, np.array(one.face) - P) < 0
    faces = found[np.array([found.names[c] == "face" for c in found.curve])]
    assert facing == (not faces.hidden.any())


def test_what_lies_before_a_component_hides_it_and_nothing_else():
    behind, before = pipe((-500, 3000, 0), (500, 3000, 0), name="behind"), pipe((-80, 2700, -300), (30, 2750, 300), 60.3, "before")
    bend = elbow(Rotation.from_euler("xyz", [0.2, 0.4, 0.1]).as_matrix(), place=np.array([250.0, 2800.0, 20.0]))
    components = [behind, before, bend]
    found = contour_of(CAMERA, components, interval=2.0)
    assert not found.occluded[found.component != 0].any()
    depth = np.array([max(deepest_before(other, point, 10.0) for other in components[1:]) for point in found.point[found.component == 0]])
    occluded = found.occluded[found.component == 0]
    assert occluded[depth > 0.3].all()
    assert not occluded[depth < -0.3].any()
    assert 0.1 < occluded.mean() < 0.8


def test_touching_neighbours_do_not_hide_each_other_but_for_what_sticks_out():
    one = pipe((-400, 3000, 0), (0, 3000, 0))
    plate = flange(axis=(1.0, 0.0, 0.0), face=(52.0, 3000.0, 0.0))
    found = contour_of(CAMERA, [one, plate], interval=2.0)
    assert found.visible[found.component == 0].mean() > 0.9
    alone = contour_of(CAMERA, [plate], interval=2.0)
    assert found.visible[found.component == 1].mean() > 0.85 * alone.visible.mean()


def test_many_components_are_one_call():
    random = np.random.default_rng(3)
    components = []
    for number in range(40):
        start = TARGET + random.uniform(-500, 500, 3)
        components.append(pipe(start, start + random.uniform(-300, 300, 3), 60.3, f"pipe {number}"))
    found = contour_of(CAMERA, components)
    assert set(found.component) <= set(range(40))
    assert len(set(found.component)) > 30
    alone = contour_of(CAMERA, [components[7]])
    assert np.allclose(found.position[found.component == 7], alone.position)


# ---------------------------------------------------------------- nothing to see, bad input


def test_components_behind_the_camera_or_outside_the_image_have_no_samples():
    for where in ((0, -3000, 0), (0, 3000, 9000)):
        assert len(contour_of(CAMERA, [pipe(where, np.add(where, (300, 0, 0)))])) == 0
    assert len(contour_of(CAMERA, [])) == 0


def test_camera_inside_a_pipe_sees_no_outline():
    assert len(contour_of(CAMERA, [pipe(np.subtract(P, (0, 500, 0)), np.add(P, (0, 500, 0)), 300.0)])) == 0


def test_pipe_that_leaves_the_image_is_sampled_inside_it():
    found = contour_of(CAMERA, [pipe((-5000, 3000, 0), (5000, 3000, 0))])
    assert CAMERA.sees(found.position).all()
    assert np.ptp(found.position[:, 0]) > 600


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"intersection": (152.0, 3000.0, 0.0)}, "coincides"),
        ({"end": (152.0, 3000.0, 400.0)}, "does not bend"),
        ({"end": (152.0, 3000.0, 10.0)}, "turns back"),
    ],
)
def test_elbow_that_is_none_is_refused_in_words(changes, words):
    broken = replace(elbow(), **changes)
    with pytest.raises(InputError, match=words):
        contour_of(CAMERA, [broken])
