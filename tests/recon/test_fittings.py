# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tees, reducers and caps: found where they are in the picture, with the catalogue's dimensions, and not elsewhere."""

import numpy as np
import pytest
from pipework import CENTRE, cone, pipe, straight, views

from pipeworkbench.pipeline import Cap, Pipe, Reducer, Tee
from pipeworkbench.recon.assemble import complete

X, Z = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])


def of_kind(done, kind):
    return [c for c in done.components if isinstance(c, kind)]


@pytest.mark.slow
@pytest.mark.parametrize("aside", [0.0, (114.3 - 88.9) / 2], ids=["concentric", "eccentric"])
def test_a_reducer_is_placed_by_its_edges(aside):
    length = 102.0  # EN 10253, DN 100 x 80
    first, last = CENTRE - length / 2 * X, CENTRE + length / 2 * X + aside * Z
    pictures = views(straight(first - 300 * X, first, 114.3), cone(first, last, 114.3, 88.9), straight(last, last + 300 * X, 88.9))
    pipes = (pipe("a", first - 300 * X, first - 10 * X, 114.3), pipe("b", last + 15 * X, last + 300 * X, 88.9))
    done = complete(pictures, pipes)
    (reducer,) = of_kind(done, Reducer)
    assert reducer.reducer_type == ("eccentric" if aside else "concentric")
    assert np.linalg.norm(np.subtract(reducer.start, first)) < 12
    assert np.linalg.norm(np.subtract(reducer.end, reducer.start) @ X) == pytest.approx(length, abs=3)
    assert len(done.joints) == 2
    assert done.warnings == ()


@pytest.mark.slow
def test_a_cap_is_told_from_a_cut_end():
    diameter, height = 114.3, 64.0
    end = CENTRE
    # 2 : 1 ellipsoid on a short straight part
    turn = np.linspace(0, np.pi / 2, 14)
    rise, width = diameter / 4 * np.sin(turn), diameter / 2 * np.cos(turn)
    straight_part = height - diameter / 4
    discs = [disc(end + (straight_part + r - 7 * s) * X, w) for r, w, s in zip(rise, width, np.sin(turn), strict=True) if w > 1]
    capped = views(straight(end - 400 * X, end, diameter)[:-12], disc_row(end - 60 * X, end + straight_part * X, diameter), *discs)
    one = (pipe("a", end - 400 * X, end + 8 * X, diameter),)
    (cap,) = of_kind(complete(capped, one), Cap)
    assert np.dot(cap.axis, X) == pytest.approx(1)
    assert abs(np.subtract(cap.start, end) @ X) < 8
    cut = views(straight(end - 400 * X, end, diameter)[:-12], disc_row(end - 60 * X, end, diameter))
    assert of_kind(complete(cut, one), Cap) == []


def disc(centre, radius, ball=7.0):
    """Return small balls that fill the rim of a disc across the x axis."""
    angle = np.linspace(0, 2 * np.pi, max(int(2 * np.pi * radius / 7), 8), endpoint=False)
    rim = centre + max(radius - ball, 0.1) * np.column_stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)])
    inner = [centre + s * (rim - centre) for s in np.arange(0.1, 1.0, 14 / max(radius, 14))]
    points = np.concatenate([rim, *inner])
    return np.column_stack([points, np.full(len(points), min(ball, radius))])


def disc_row(start, end, diameter):
    """Return a cylinder with flat ends."""
    count = int(np.linalg.norm(end - start) / 7) + 1
    axis = (end - start) / np.linalg.norm(end - start)
    places = np.linspace(7, np.linalg.norm(end - start) - 7, count)
    return np.concatenate([disc(start + p * axis, diameter / 2) for p in places])


@pytest.mark.slow
def test_a_branch_on_a_run_is_a_tee():
    run, branch = 114.3, 60.3
    surface = CENTRE - run / 2 * Z
    pictures = views(straight(CENTRE - 450 * X, CENTRE + 450 * X, run), straight(surface, surface - 350 * Z, branch))
    pipes = (pipe("run", CENTRE - 450 * X, CENTRE + 450 * X, run), pipe("branch", surface - 350 * Z, surface - 12 * Z, branch))
    done = complete(pictures, pipes)
    (tee,) = of_kind(done, Tee)
    assert np.linalg.norm(np.subtract(tee.intersection, CENTRE)) < 2
    assert (tee.outer_diameter, tee.branch_diameter) == (run, branch)
    assert tee.tee_type == "set-on"
    assert len(of_kind(done, Pipe)) == 3
    assert len(done.joints) == 3
    assert done.warnings == ()
