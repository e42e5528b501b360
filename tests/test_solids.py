# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: volumes, directions and ends of pipes."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Flange, Pipe
from pipeworkbench.solids import brep_text, component_solid, straight_pipe


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


def test_component_without_a_solid_is_refused():
    flange = Flange(id="F3", face=(0.0, 0.0, 0.0), axis=(1.0, 0.0, 0.0), flange_type="11", pn=16, D=150.0, C=18.0, length=45.0, outer_diameter=48.3)
    with pytest.raises(InputError, match="F3"):
        component_solid(flange)


def test_brep_text_is_read_back_with_the_same_volume(tmp_path):
    from cadquery import Shape

    solid = made((0.0, 0.0, 0.0), (300.0, 400.0, 0.0), wall=2.9)
    path = tmp_path / "pipe.brep"
    path.write_text(brep_text(solid), encoding="ascii")
    assert Shape.importBrep(str(path)).Volume() == pytest.approx(solid.Volume(), rel=1e-9)
