# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints from coincident ends, runs and open ends, and sentences about what does not fit."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, Tee
from pipeworkbench.recon.topology import graph_of, join, joined

D = 60.3


def pipe(name, start, end, diameter=D):
    return Pipe(id=name, start=tuple(map(float, start)), end=tuple(map(float, end)), outer_diameter=diameter)


def flange(name, face, axis):
    return Flange(id=name, face=face, axis=axis, outer_diameter=D, flange_type="11", pn=16, D=165, C=18, length=45)


ELBOW = Elbow(id="E", start=(500, 0, 0), end=(576, 0, 76), intersection=(576, 0, 0), angle_deg=90, bend_radius=76, outer_diameter=D)
CHAIN = (pipe("a", (0, 0, 0), (500, 0, 0)), ELBOW, pipe("b", (576, 0, 76), (576, 0, 500)))


def named(joints):
    return {frozenset({(j.a, j.a_port), (j.b, j.b_port)}) for j in joints}


CHAIN_JOINTS = {frozenset({("a", 1), ("E", 0)}), frozenset({("E", 1), ("b", 0)})}


def test_ends_that_coincide_are_joined():
    graph = graph_of(CHAIN)
    assert named(graph.joints) == CHAIN_JOINTS
    assert graph.runs == (("a", "E", "b"),)
    assert set(graph.open_ends) == {("a", 0), ("b", 1)}
    assert graph.warnings == ()
    assert named(joined(Pipeline(frame="A", components=CHAIN)).joints) == CHAIN_JOINTS


@given(
    st.tuples(*[st.floats(-np.pi, np.pi)] * 3),
    st.tuples(*[st.floats(-1e4, 1e4)] * 3),
    st.permutations(range(3)),
    st.tuples(*[st.floats(-1.5, 1.5)] * 3),
)
@settings(max_examples=40, deadline=None)
def test_joints_do_not_depend_on_place_order_and_small_errors(angles, shift, order, error):
    turn = Rotation.from_euler("xyz", angles).as_matrix()

    def moved(point, by=(0, 0, 0)):
        return tuple(float(x) for x in turn @ (np.array(point) + by) + shift)

    first, bend, second = CHAIN
    bend = replace(bend, start=moved(bend.start), end=moved(bend.end), intersection=moved(bend.intersection))
    components = [replace(first, start=moved(first.start, error), end=moved(first.end, error)), bend]
    components.append(replace(second, start=moved(second.start), end=moved(second.end)))
    assert named(join([components[i] for i in order])) == CHAIN_JOINTS


@pytest.mark.parametrize(("start", "end"), [((512, 0, 0), (900, 0, 0)), ((500, 0, 0), (500, 0, 400)), ((500, 0, 0), (100, 0, 0))])
def test_ends_apart_or_in_other_directions_are_not_joined(start, end):
    assert join((pipe("a", (0, 0, 0), (500, 0, 0)), pipe("b", start, end))) == ()


def test_each_end_is_joined_once_to_the_nearest():
    pipes = (pipe("a", (0, 0, 0), (500, 0, 0)), pipe("far", (503, 0, 0), (900, 0, 0)), pipe("near", (501, 0, 0), (900, 0, 0)))
    assert named(join(pipes)) == {frozenset({("a", 1), ("near", 0)})}


def test_flanges_meet_across_a_gasket_and_pipes_do_not_meet_faces():
    pair = (flange("f", (100.0, 0.0, 0.0), (1.0, 0.0, 0.0)), flange("g", (102.0, 0.0, 0.0), (-1.0, 0.0, 0.0)))
    pipes = (pipe("a", (0, 0, 0), (55, 0, 0)), pipe("b", (147, 0, 0), (300, 0, 0)))
    graph = graph_of((*pair, *pipes))
    assert len(graph.joints) == 3
    assert graph.warnings == ()
    assert join((pair[0], pipe("b", (102, 0, 0), (300, 0, 0)))) == ()


def test_runs_end_at_tees():
    tee = Tee(id="T", start=(500, 0, 0), end=(600, 0, 0), intersection=(550, 0, 0), branch_end=(550, 0, 60), branch_diameter=D, outer_diameter=D)
    pipes = (pipe("a", (0, 0, 0), (500, 0, 0)), pipe("b", (600, 0, 0), (900, 0, 0)), pipe("c", (550, 0, 60), (550, 0, 500)))
    graph = graph_of((tee, *pipes))
    assert len(graph.joints) == 3
    assert set(graph.runs) == {("a",), ("b",), ("c",)}
    assert graph.branches == ("T",)


def test_what_does_not_fit_is_said_in_sentences():
    changes = (pipe("a", (0, 0, 0), (500, 0, 0)), pipe("b", (501, 0, 0), (900, 0, 0), 48.3))
    assert graph_of(changes).warnings == ("a and b: the diameter changes from 60.3 to 48.3 mm without a reducer; check both diameters",)
    gap = (pipe("a", (0, 0, 0), (500, 0, 0)), pipe("b", (580, 0, 0), (900, 0, 0)))
    assert graph_of(gap).warnings == ("a and b: there is a gap of 80 mm between their ends; add what lies between them",)
    (lonely,) = graph_of((flange("f", (100.0, 0.0, 0.0), (1.0, 0.0, 0.0)),)).warnings
    assert lonely.startswith("f: the flange has no partner")
    (twice,) = graph_of((pipe("a", (0, 0, 0), (500, 0, 0)), pipe("b", (200, 1, 0), (700, 1, 0)))).warnings
    assert twice == "a and b: they lie in each other over 300 mm; delete one of them"


def test_nothing_has_no_joints():
    assert join(()) == ()
    assert graph_of(()).runs == ()
