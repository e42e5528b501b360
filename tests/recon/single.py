# SPDX-License-Identifier: LGPL-2.1-or-later
"""The adjustment's arrays for one component, or a few, at a time: its tests say what they mean with these."""

from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.adjustment import charts, conditions
from pipeworkbench.recon.adjustment.conditions import NO_JOINT, NOBODY, Conditions, Links
from pipeworkbench.recon.adjustment.problem import Problem
from pipeworkbench.recon.bodies import Bodies

NOTHING = np.zeros(0, np.intp)


@dataclass(frozen=True, eq=False)
class Chart:
    """A component's chart: reference (3,), basis (9, k), names (k,)."""

    reference: np.ndarray
    basis: np.ndarray
    names: tuple


def chart_of(component):
    reference, basis = charts.charts(Bodies.of([component]), NOTHING, np.zeros((0, 3)))
    names = charts.parameter_names(component)
    return Chart(reference[0], basis[0][:, : len(names)], names)


def changed(component, motion):
    """Return a component after a motion (9,)."""
    (there,) = charts.moved(Bodies.of([component]), np.array([motion], float), np.array([True])).components
    return there


def normalised(elbow):
    (there,) = charts.normalised(Bodies.of([elbow]), np.array([0])).components
    return there


def port_of(component, number):
    ports = charts.ports_of(Bodies.of([component]), np.array([0]), np.array([number]))
    return charts.Ports(*(values[0] for values in vars(ports).values()))


def rates_of(component, sight):
    """Return how the points of a sight move along their normals with the motion of their component: (n, 9)."""
    return charts.by_motion(Bodies.of([component]), np.zeros(len(sight), np.intp), sight.names, sight.seen.point, sight.seen.outward)


@dataclass(frozen=True, eq=False)
class Row:
    """One pseudo-observation; its parts are rows of components with derivatives (9,)."""

    what: str
    parts: tuple
    misclosure: float
    sigma: float
    joint: int | None
    exact: bool


def rows_of(problem, components, free, joints, settings):
    """Return the pseudo-observations of components at places of their own; ``free`` maps rows to the names of what is unknown."""
    names = [free.get(row, frozenset()) | ({"position"} if row in free else set()) for row in range(len(components))]
    return rows_as_such(Conditions.of(problem, names, list(joints), settings).at(Bodies.of(components)))


def rows_as_such(observed):
    return [
        Row(
            what,
            tuple((int(body), part) for body, part in zip(bodies, derivative, strict=True) if body != NOBODY),
            float(misclosure),
            float(sigma),
            None if joint == NO_JOINT else int(joint),
            bool(exact),
        )
        for what, bodies, derivative, misclosure, sigma, joint, exact in zip(
            observed.what, observed.bodies, observed.derivative, observed.misclosure, observed.sigma, observed.joint, observed.exact, strict=True
        )
    ]


def with_pipe_ends(components, joints, kept, *, exact=False):
    links = Links.of(Problem(tuple(components), (), tuple(joints)), range(len(joints)))
    stays = np.array([row in kept for row in range(len(components))])
    return conditions.with_pipe_ends(Bodies.of(components), links, stays, exact=exact).components
