# SPDX-License-Identifier: LGPL-2.1-or-later
"""The benchmark's brute force: finds a pipe from exact lines among others, and says how far it came."""

import numpy as np
import pytest
from brute_force import BruteForceSettings, brute_force, line_pairs
from synthetic import DN100, FOCAL_PX, INTERIOR, TARGET, cameras, pipe

from pipeworkbench.recon.cylinder import edge_lines
from pipeworkbench.recon.plane_cylinders import cylinder_from_centre_planes
from pipeworkbench.recon.tangent_planes import apparent_pipe

TRUTH = DN100
HALF = 250.0  # mm of the axis to each side that the lines show


def without_distortion(camera, points):
    """Return points (n, 3) as pixels (n, 2) of a camera whose lens does not distort."""
    local = (points - camera.projection_centre) @ camera.rotation.T
    return local[:, :2] / local[:, 2:] * INTERIOR.pixels_per_radian + INTERIOR.pixels(np.zeros((1, 2)))


def exact_lines(camera, truth):
    """Return the ends (2, 2, 2) of a pipe's edges as a camera without errors has them."""
    points, _ = edge_lines(truth.cylinder.as_many(), camera.projection_centre)
    return np.array([without_distortion(camera, point + np.outer([-HALF, HALF], truth.direction)) for point in points[0]])


def seen(pipes, clutter=0, count=3, seed=1):
    """Return cameras and the lines of pipes in their images, among lines that belong to nothing."""
    noise = np.random.default_rng(seed)
    made = cameras(count)
    lines = []
    for camera in made:
        stray = noise.uniform((0, 0), (INTERIOR.width, INTERIOR.height), (clutter, 2, 2))
        lines.append(np.concatenate([stray, *(exact_lines(camera, truth) for truth in pipes)]))
    return made, lines


def is_found(found, truth, row):
    ends = found.ends[row]
    return truth.distance(ends).max() < 0.5 and found.sizes[row].outer_diameter == truth.diameter


@pytest.mark.parametrize("count", [2, 3])
def test_pipe_is_found_among_clutter(count):
    found = brute_force(*seen([TRUTH], clutter=40, count=count))
    rows = [row for row in range(len(found.sizes)) if is_found(found, TRUTH, row)]
    # once, and before what clutter makes
    assert rows == [0]
    assert found.rms[0] < 0.05
    assert found.share == 1.0
    assert np.linalg.norm(found.ends[0, 1] - found.ends[0, 0]) == pytest.approx(2 * HALF, rel=0.02)


def test_two_pipes_are_found():
    other = pipe(60.3, (-40.0, 5.0), centre=np.add(TARGET, [150.0, 200.0, 50.0]))
    found = brute_force(*seen([TRUTH, other]))
    assert is_found(found, TRUTH, [size.outer_diameter for size in found.sizes].index(114.3))
    assert is_found(found, other, [size.outer_diameter for size in found.sizes].index(60.3))


def test_cylinder_is_that_of_the_centre_planes():
    made, lines = seen([TRUTH], count=2)
    found = brute_force(made, lines)
    edges = [
        camera.interior.pixels((ends.reshape(-1, 2) - [322.0, 238.0]) / FOCAL_PX).reshape(2, 2, 2) for camera, ends in zip(made, lines, strict=True)
    ]
    expected = cylinder_from_centre_planes([apparent_pipe(camera, *of_one) for camera, of_one in zip(made, edges, strict=True)])
    (cylinder,) = (found.cylinders.one(row) for row in range(len(found.sizes)))
    assert abs(cylinder.direction @ expected.direction) == pytest.approx(1.0, abs=1e-12)
    assert cylinder.radius == pytest.approx(expected.radius, abs=1e-3)
    assert np.linalg.norm(np.cross(cylinder.point - expected.point, expected.direction)) < 1e-3


@pytest.mark.parametrize(
    ("truth", "settings"),
    [
        (TRUTH, BruteForceSettings(working_range=(3500.0, 9000.0))),
        (TRUTH, BruteForceSettings(working_range=(1000.0, 2500.0))),
        (TRUTH, BruteForceSettings(diameter_range=(150.0, 700.0))),
        (pipe(120.0, (10.0, 15.0)), BruteForceSettings()),
        (pipe(114.3, (90.0, 0.0)), BruteForceSettings()),
    ],
    ids=["beyond it", "before it", "other diameters", "no standard diameter", "in one plane with the cameras"],
)
def test_filters_refuse(truth, settings):
    found = brute_force(*seen([truth], count=2), settings)
    assert found.passed == 0
    assert found.share == 1.0
    assert found.ends.shape == (0, 2, 3)


def test_planes_that_are_not_tangent_to_one_cylinder_are_refused():
    made, lines = seen([TRUTH], count=2)
    wider = lines[1].copy()
    wider[1] += wider[1, 0] - wider[0, 0]
    assert brute_force(made, [lines[0], wider]).passed == 0


def test_small_blocks_find_the_same():
    made, lines = seen([TRUTH], clutter=40)
    one, many = brute_force(made, lines), brute_force(made, lines, BruteForceSettings(block=500))
    assert many.passed == one.passed > 1
    assert many.tested == one.tested == one.combinations
    assert many.rms == pytest.approx(one.rms)


def test_only_the_best_are_kept():
    made, lines = seen([TRUTH], clutter=60)
    found = brute_force(made, lines, BruteForceSettings(most_kept=3, block=2000, largest_rms=10.0, tolerance=0.05))
    assert found.passed > 6
    assert len(found.sizes) <= 3
    assert is_found(found, TRUTH, 0)


def test_only_the_longest_lines_are_combined():
    made, lines = seen([TRUTH], clutter=40)
    every = line_pairs(made[0], lines[0], BruteForceSettings())
    few = line_pairs(made[0], lines[0], BruteForceSettings(most_lines=8))
    assert 0 < len(few) <= 8 * 7 / 2
    assert len(few) < len(every)


def test_time_limit_stops_and_tells_how_far_it_came():
    made, lines = seen([TRUTH], clutter=60)
    found = brute_force(made, lines, BruteForceSettings(time_limit=0.0))
    assert found.tested == 0
    assert found.share == 0.0
    assert found.combinations > 0


def test_pairs_are_those_of_like_direction_with_the_axis_between_them():
    camera = cameras()[0]
    ends = np.array([[[100, 50], [110, 400]], [[200, 60], [215, 420]], [[20, 300], [600, 310]], [[150, 50], [162, 400]]], float)
    pairs = line_pairs(camera, ends, BruteForceSettings(largest_angle_deg=5.0))
    assert len(pairs) == 3
    middle = camera.rays(np.array([[125.0, 200.0]]))[0]
    assert sum((tangents @ middle > 0).all() for tangents in pairs.tangents) == 2  # between 100 and 150, and 100 and 200
    assert brute_force([camera, camera], [ends[:1], ends]).combinations == 0
