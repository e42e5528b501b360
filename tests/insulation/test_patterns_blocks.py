# SPDX-License-Identifier: LGPL-2.1-or-later
"""What blocks take away from jackets: walls and beams leave openings with straight and curved sides."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pipeworkbench.insulation.patterns import patterns_of_covering
from pipeworkbench.insulation.patterns.openings import cylinder_openings
from pipeworkbench.insulation.treatment import Seams
from pipeworkbench.solids.coverings import BlockNotch, Layer, Notch, Sheet, StraightCovering
from pipeworkbench.solids.frames import Frame

RADIUS = 100.0
EDGE_MM = 0.1  # nearer to an opening's border than this a point may be on either side


def block(corner, size, rotation=None):
    axes = np.eye(3) if rotation is None else rotation.as_matrix().T
    return BlockNotch("beam", Frame(np.array(corner, float), *axes), np.array(size, float))


def jacket(*notches):
    made = {"frame": Frame(np.zeros(3), *np.eye(3)), "layers": (Layer("mineral wool", 60.0),), "sheet": Sheet("aluminium", 0.8), "seam": np.pi}
    return StraightCovering(id="P1", component="P1", radius=39.6, begin=0.0, end=900.0, notches=notches, **made)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_a_point_of_the_jacket_lies_in_an_opening_where_the_block_holds_it(seed):
    random = np.random.default_rng(seed)
    size = random.uniform(30, 150, 3)
    notch = block(random.uniform(-1, 1, 3) * (60, 60, 100) + (60, 0, 300), size, Rotation.random(random_state=seed))
    angles, heights = np.meshgrid(np.linspace(0, 2 * np.pi, 120, endpoint=False), np.linspace(0, 600, 120))
    angles, heights = angles.ravel(), heights.ravel()

    def held(da, dh):
        turned = angles + da / RADIUS
        return notch.holds(np.column_stack([RADIUS * np.cos(turned), RADIUS * np.sin(turned), heights + dh]))

    around = [held(da, dh) for da in (-EDGE_MM, 0, EDGE_MM) for dh in (-EDGE_MM, 0, EDGE_MM)]
    sure = np.all(around, axis=0) | ~np.any(around, axis=0)
    inside = np.zeros(len(angles), bool)
    for opening in cylinder_openings([notch], RADIUS):
        for turn in (-1, 0, 1, 2):
            inside |= opening.path.contains(np.column_stack([RADIUS * (angles + 2 * np.pi * turn), heights]))
    np.testing.assert_array_equal(inside[sure], held(0, 0)[sure])


def test_a_beam_beside_the_pipe_becomes_a_hole_of_its_exact_size():
    (opening,) = cylinder_openings([block((80, -30, 200), (100, 60, 50))], RADIUS)
    # it reaches in to x = 80, farther than y = 30 lies on the jacket: the hole's sides are its own
    width = 2 * RADIUS * np.arcsin(30 / RADIUS)
    left, low, right, high = opening.path.bounds
    assert (right - left, high - low) == pytest.approx((width, 50.0), abs=1e-3)
    assert opening.path.area == pytest.approx(50 * width, abs=0.1)


def test_the_pattern_of_a_jacket_has_the_hole_of_a_beam():
    (plain,) = patterns_of_covering(jacket(), Seams())
    (cut,) = patterns_of_covering(jacket(block((60, -30, 400), (100, 60, 50))), Seams())
    radius = 39.6 + 60.0 + 0.4
    taken = 50 * 2 * radius * np.arcsin(30 / radius)
    assert plain.net_area - cut.net_area == pytest.approx(taken, rel=1e-3)
    assert len(cut.holes) == len(plain.holes) + 1


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_a_notch_in_other_axes_holds_the_same_points(seed):
    random = np.random.default_rng(seed)
    axes, origin = Rotation.random(random_state=seed).as_matrix(), random.uniform(-100, 100, 3)
    points = random.uniform(-150, 150, (200, 3))
    cylinder = Notch("pipe", random.uniform(-90, 0, 3), random.uniform(10, 90, 3), 60.0)
    for notch in (cylinder, block((-40, -50, -60), (90, 80, 100), Rotation.random(random_state=seed + 1))):
        np.testing.assert_array_equal(notch.moved(axes, origin).holds((points - origin) @ axes.T), notch.holds(points))
