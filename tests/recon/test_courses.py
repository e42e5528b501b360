# SPDX-License-Identifier: LGPL-2.1-or-later
"""Courses around corners: the same contours as the exact ones of components, and derivatives that tell how they move."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from synthetic import cameras

from pipeworkbench.pipeline import Elbow, Pipe
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.courses import Courses, contour_of_courses, hidden_samples

CAMERA = cameras()[0]
VIEW = SimpleNamespace(camera=CAMERA)
CORNER = np.array([0.0, 3000.0, 0.0])

turns = st.tuples(*[st.floats(-np.pi, np.pi)] * 3).map(lambda a: Rotation.from_euler("xyz", a).as_matrix())


def course(rotation, angle_deg, radius=152.0, tube=57.15, reach=400.0):
    angle = np.radians(angle_deg)
    come, go = rotation @ [1.0, 0, 0], rotation @ [np.cos(angle), np.sin(angle), 0]
    return Courses(CORNER[None], come[None], go[None], np.array([radius]), np.array([tube]), np.array([reach]))


@given(turns, st.floats(20, 120))
@settings(max_examples=30, deadline=None)
def test_contours_touch_the_tube_and_are_those_of_the_elbow(turn, angle_deg):
    one = course(turn, angle_deg)
    places = one.spread(60)
    seen = contour_of_courses(VIEW, one, places)
    axis, tangent = one.axis(places)
    surface = axis[:, :, None] + 57.15 * seen.outward
    sight = surface - CAMERA.projection_centre
    # where the line of sight goes into the tube there is no contour
    assert np.nanmax(np.abs(np.einsum("knsi,knsi->kns", seen.outward, sight))) < 1e-6
    assert np.nanmax(np.abs(np.einsum("knsi,kni->kns", seen.outward, tangent))) < 1e-9
    # the exact torus' contour at the same places
    length = float(one.tangent_length[0])
    start, end = CORNER - length * one.come[0], CORNER + length * one.go[0]
    elbow = Elbow(
        id="e", start=tuple(start), end=tuple(end), intersection=tuple(CORNER), angle_deg=angle_deg, bend_radius=152.0, outer_diameter=114.3
    )
    exact = contour_of(CAMERA, [elbow])
    same = contour_of_courses(VIEW, one, exact.parameter[None])
    gaps = np.linalg.norm(same.position[0] - exact.position[:, None], axis=2).min(axis=1)
    assert np.nan_to_num(gaps).max(initial=0.0) < 1e-4


@given(turns, st.floats(30, 110), st.integers(0, 7))
@settings(max_examples=30, deadline=None)
def test_derivatives_tell_how_the_axis_moves_across_itself(turn, angle_deg, parameter):
    one = course(turn, angle_deg)
    places = one.spread(40)
    step = np.zeros((1, 8))
    step[0, parameter] = 1e-3 if parameter in (0, 1, 2, 7) else 1e-5
    before, tangent = one.axis(places)
    after, _ = one.moved(step).axis(places)
    across = (after - before) - np.einsum("kni,kni->kn", after - before, tangent)[..., None] * tangent
    told = one.derivatives(places)[..., parameter] * step[0, parameter]
    told -= np.einsum("kni,kni->kn", told, tangent)[..., None] * tangent
    assert told == pytest.approx(across, abs=1e-6)


@given(turns, st.floats(20, 120))
@settings(max_examples=20, deadline=None)
def test_samples_are_evenly_spaced(turn, angle_deg):
    one = course(turn, angle_deg)
    points, _ = one.axis(one.spread(200))
    steps = np.linalg.norm(np.diff(points[0], axis=0), axis=1)
    assert steps == pytest.approx(np.full(199, steps.mean()), rel=0.02)


def test_what_a_pipe_stands_before_is_hidden():
    one = course(np.eye(3), 90.0)
    places = one.spread(60)
    x, y, z = CORNER
    before = Pipe(id="p", start=(x - 100, y - 800, z - 600), end=(x - 100, y - 800, z + 600), outer_diameter=60.3)
    obstacle = (np.array([before.start]), np.array([before.end]), np.array([before.outer_diameter / 2]))
    free = hidden_samples(VIEW, one, places)
    covered = hidden_samples(VIEW, one, places, [obstacle])
    assert not (free & ~covered).any()
    assert 5 < (covered & ~free).sum() < 60
    behind = (obstacle[0] + [0, 1600, 0], obstacle[1] + [0, 1600, 0], obstacle[2])
    assert (hidden_samples(VIEW, one, places, [behind]) == free).all()
