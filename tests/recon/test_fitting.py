# SPDX-License-Identifier: LGPL-2.1-or-later
"""Found fittings between their pipes: axes from corner to corner, pieces of a run, nothing left of a pipe."""

import numpy as np
import pytest
from pipework import pipe

from pipeworkbench.catalogue import bends, catalogue
from pipeworkbench.recon.elbows import FoundElbow
from pipeworkbench.recon.fitting import Assembly, with_elbows, with_flanges, with_tees
from pipeworkbench.recon.flange_variants import flange_of
from pipeworkbench.recon.tees import FoundTee
from pipeworkbench.recon.topology import graph_of

D = 114.3
X, Z = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
BEND = next(b for b in bends(D) if b.bend_type == "3D")
WELD_NECK, BLIND = (catalogue().flanges(standard="EN 1092-1", flange_type=kind, pn=16, dn=100)[0] for kind in ("11", "05"))
GASKET = 2.0


def found(first, second, corner, come, go, score=10.0):
    return FoundElbow(first, second, np.array(corner, float), come, go, BEND.bend_radius, BEND, D, 0.5, score, 9.0)


def three(middle_length):
    """Return an offset: pipe, elbow, pipe, elbow, pipe, a little off and too long or short."""
    height = middle_length + 2 * BEND.bend_radius
    pipes = (
        pipe("a", (-700, 0, 1), (-150, 0, -1), D),
        pipe("b", (2, 0, 100), (-1, 0, height - 40), D),
        pipe("c", (150, 0, height), (700, 1, height), D),
    )
    elbows = (found((0, 1), (1, 0), (0, 0, 0), X, Z, 20.0), found((1, 1), (2, 0), (0, 0, height), Z, X))
    return Assembly(pipes, frozenset(), "S"), elbows


def test_a_pipe_between_two_elbows_runs_from_corner_to_corner():
    assembly, elbows = three(300.0)
    done = with_elbows(assembly, elbows)
    middle = done.components[1]
    assert middle.start == pytest.approx((0, 0, BEND.bend_radius), abs=0.5)
    assert middle.end == pytest.approx((0, 0, BEND.bend_radius + 300.0), abs=0.5)
    graph = graph_of(done.components)
    assert len(graph.joints) == 4
    assert graph.runs == (("a", "S-E00", "b", "S-E01", "c"),)
    for joint in graph.joints:
        ends = [next(c for c in done.components if c.id == name).ports[port] for name, port in ((joint.a, joint.a_port), (joint.b, joint.b_port))]
        assert ends[0].point == pytest.approx(ends[1].point)
        assert np.dot(ends[0].direction, ends[1].direction) == pytest.approx(-1.0)


def test_where_nothing_would_remain_of_a_pipe_the_worse_elbow_goes():
    assembly, elbows = three(-60.0)
    done = with_elbows(assembly, elbows)
    assert [c.kind for c in done.components].count("elbow") == 1
    assert done.components[2] == assembly.components[2]


def test_a_tee_cuts_its_run_and_a_second_one_the_piece_it_sits_on():
    run = pipe("run", (-900, 0, 0), (900, 0, 0), D, pick=3)
    one, other = pipe("p", (-400, 0, 60), (-400, 0, 500), 60.3), pipe("q", (400, 0, 60), (400, 0, 500), 60.3)
    tees = [FoundTee((row, 0), 0, np.array([x, 0.0, 0]), X, Z, (-900 - x, 900 - x), None) for row, x in ((1, -400.0), (2, 400.0))]
    done = with_tees(Assembly((run, one, other), frozenset(), "S"), tees)
    graph = graph_of(done.components)
    assert len(graph.joints) == 6
    assert graph.branches == ("S-T00", "S-T01")
    assert graph.warnings == ()
    assert [c.pick for c in done.components if c.kind == "pipe"].count(3) == 1
    lengths = sorted(c.length for c in done.components if c.id.startswith("run"))
    assert sum(lengths) == pytest.approx(1800 - 4 * 60.3)


def flange(name, face, axis, dimensions=WELD_NECK, diameter=D):
    return flange_of(dimensions, np.array(face, float), np.array(axis, float), diameter, name, raised=True)


def pair():
    """Return two flanges face to face on the x axis."""
    return flange("left", (0, 0, 0), X), flange("right", (GASKET, 0, 0), -X)


LEFT_WELD, RIGHT_WELD = -WELD_NECK.length, GASKET + WELD_NECK.length


@pytest.mark.parametrize("seen_to", [LEFT_WELD - 60, LEFT_WELD + 20], ids=["short of the weld", "into the flange"])
@pytest.mark.parametrize("port", [0, 1])
def test_a_pipe_ends_at_the_weld_end_of_its_flange(port, seen_to):
    ends = [(-700, 3, 1), (seen_to, 3, 1)]
    seen = pipe("p", ends[1 - port], ends[port], D, pick=3)
    one, (left, _) = ("start", "end")[port], pair()
    moved, kept = with_flanges((seen, left))
    # on its own axis, which is measured: not on the flange's
    assert getattr(moved, one) == pytest.approx((LEFT_WELD, 3, 1))
    assert moved.ports[1 - port].point == seen.ports[1 - port].point
    assert (moved.id, moved.pick, kept) == ("p", 3, left)


@pytest.mark.parametrize(("start", "end"), [(-900, 500), (-500, 900), (500, -900), (900, -500)])
def test_a_pipe_that_was_followed_through_a_pair_of_flanges_becomes_two(start, end):
    flanges = pair()
    longer, *same, piece = with_flanges((pipe("p", (start, 0, 0), (end, 0, 0), D, pick=3), *flanges))
    assert tuple(same) == flanges
    spans = [sorted((part.start[0], part.end[0])) for part in (longer, piece)]
    first, last = sorted((start, end))
    assert sorted(spans) == [pytest.approx([first, LEFT_WELD]), pytest.approx([RIGHT_WELD, last])]
    assert longer.length > piece.length
    assert (longer.id, longer.pick) == ("p", 3)
    assert (piece.id, piece.pick) == ("p.2", None)
    # both go on in the direction of the whole
    assert all((part.end[0] - part.start[0]) * (end - start) > 0 for part in (longer, piece))


def test_a_pipe_beyond_the_flanges_that_was_picked_itself_is_not_there_twice():
    whole, neighbour = pipe("p", (-900, 0, 0), (500, 0, 0), D, pick=3), pipe("q", (100, 1, 0), (600, 1, 0), D, pick=4)
    pipes = [one for one in with_flanges((whole, neighbour, *pair())) if one.kind == "pipe"]
    assert [(one.id, one.pick) for one in pipes] == [("p", 3), ("q", 4)]
    assert pipes[0].end[0] == pytest.approx(LEFT_WELD)
    assert pipes[1].start[0] == pytest.approx(RIGHT_WELD)


def test_a_piece_gets_an_id_that_nobody_has():
    taken = pipe("p.2", (0, 900, 0), (500, 900, 0), D)
    assert with_flanges((pipe("p", (-900, 0, 0), (500, 0, 0), D), taken, *pair()))[-1].id == "p.3"


@pytest.mark.parametrize("end", [LEFT_WELD - 60, 500], ids=["short", "through"])
def test_fixed_pipes_stay_as_they_are_at_flanges(end):
    components = (pipe("p", (-900, 0, 0), (end, 0, 0), D, fixed=True), *pair())
    assert with_flanges(components) == components


@pytest.mark.parametrize(
    "lonely",
    [
        flange("beside", (0, 40, 0), X),
        flange("across", (0, 0, 0), Z),
        flange("of another size", (0, 0, 0), X, diameter=88.9),
        flange("far", (700, 0, 0), X),
        flange("turned away", (-60, 0, 0), -X),
        flange("blind", (0, 0, 0), X, BLIND),
    ],
    ids=lambda one: one.id,
)
def test_a_flange_without_a_pipe_changes_nothing(lonely):
    components = (pipe("p", (-700, 0, 0), (-100, 0, 0), D), lonely)
    assert with_flanges(components) == components
    assert with_flanges((lonely,)) == (lonely,)
