# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a pipe reaches and what is bridged, against pipes whose ends are known."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import TruePipe, pick, pipe, views

from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.extent import ExtentSettings, extent_of
from pipeworkbench.recon.pipes import from_pick
from pipeworkbench.recon.reconstruct import as_component

WHOLE = pipe(114.3, (5.0, 0.0), length=900.0)
SETTINGS = ExtentSettings()
END = SETTINGS.window * 114.3 + 5  # an end is known to a window of samples


def piece(first, last):
    """Return the part of the whole pipe between two distances from its start."""
    return TruePipe(WHOLE.start + first * WHOLE.direction, WHOLE.start + last * WHOLE.direction, WHOLE.diameter)


def found(parts, known=(60.0, 160.0), settings=SETTINGS):
    middle = WHOLE.half_length
    extent = extent_of(views(parts, seed=5), WHOLE.cylinder, (known[0] - middle, known[1] - middle), settings)
    return extent.start + middle, extent.end + middle, extent.gaps + middle


def test_whole_pipe_has_no_gaps():
    start, end, gaps = found([WHOLE])
    assert (start, end) == pytest.approx((0.0, 900.0), abs=END)
    assert gaps.shape == (0, 2)


def test_short_gap_is_bridged_and_reported():
    start, end, gaps = found([piece(0, 400), piece(450, 900)])
    assert (start, end) == pytest.approx((0.0, 900.0), abs=END)
    assert gaps.shape == (1, 2)
    assert gaps[0] == pytest.approx([400.0, 450.0], abs=END / 2)


def test_long_gap_ends_the_pipe():
    start, end, gaps = found([piece(0, 400), piece(520, 900)])
    assert (start, end) == pytest.approx((0.0, 400.0), abs=END)
    assert not len(gaps)


def test_gap_between_the_clicks_is_reported_too():
    _, end, gaps = found([piece(0, 300), piece(420, 900)], known=(100.0, 700.0))
    assert end == pytest.approx(900.0, abs=END)
    assert gaps[0] == pytest.approx([300.0, 420.0], abs=END / 2)


def test_longest_bridge_is_settable():
    _, end, _ = found([piece(0, 400), piece(520, 900)], settings=replace(SETTINGS, bridge=2.0, bridge_mm=150.0))
    assert end == pytest.approx(900.0, abs=END)


@pytest.mark.slow
def test_gap_of_a_picked_pipe_is_in_its_component():
    parts = [piece(0, 480), piece(530, 900)]
    (candidate,) = from_pick(views(parts, seed=5), pick(0, piece(60, 460)))
    component = as_component(candidate, None, "synthetic")
    assert isinstance(component, Pipe)
    (gap,) = component.gaps
    along = np.array([component.start, component.end]) @ WHOLE.direction - WHOLE.start @ WHOLE.direction
    first, last = (along[0] + np.array(gap)) if along[0] < along[1] else (along[0] - np.array(gap))[::-1]
    assert (first, last) == pytest.approx((480.0, 530.0), abs=END / 2)
