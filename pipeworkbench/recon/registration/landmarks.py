# SPDX-License-Identifier: LGPL-2.1-or-later
"""The components of one station as arrays: axes that may slide along themselves, and anchors that are fixed in all directions.

A pipe is an axis of which only a section may have been seen. An elbow's corner, a flange's face, a tee's and a reducer's
middle and a cap's seam are anchors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.ends import APPROXIMATE_FACTOR, LEAST_SIGMA_MM, SIGMA_FACTOR, UNKNOWN_SIGMA_MM
from pipeworkbench.recon.topology import join
from pipeworkbench.recon.vectors import unit

KINDS = (Pipe, Elbow, Flange, Tee, Reducer, Cap)
PIPE, ELBOW = 0, 1  # rows of KINDS
UNKNOWN_DIRECTION_DEG = 1.0  # the paper's Table 3: 1.1 degrees
ILL_CONDITIONED = 0.05  # relative singular value below which a correlation cannot be told from three standard deviations
WEIGHTS = (1.0, 0.7, 1.2, 0.8, 0.8, 0.8)  # of KINDS: a flange is measured by itself, fittings follow from their pipes


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Landmarks, n in number, in a station's level frame.

    kind (n,) row in KINDS; point (n, 3) mm, an axis' middle or the anchor; axis (n, 3) unit: the pipe's, either way, or a
    direction of the anchor that has a sign (elbow: from the corner inwards); half (n,) mm, half an axis' length, 0 for anchors;
    sizes (n, 2) outside diameter and the second size (mm; degrees for an elbow's angle); held (n, 2) whether start and end are joined;
    position (n, 3, 3) mm^2 and direction (n, 3, 3) rad^2 covariances; weight (n,) what explaining it counts;
    redundant (n, 2) the rows of the pipes whose axes meet in an elbow or tee, -1 where there are not two.
    """

    kind: NDArray[np.intp]
    point: Array
    axis: Array
    half: Array
    sizes: Array
    held: NDArray[np.bool_]
    position: Array
    direction: Array
    weight: Array
    redundant: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.kind)

    @property
    def is_axis(self) -> NDArray[np.bool_]:
        """Whether (n,) a landmark is a pipe's axis."""
        return np.asarray(self.kind == PIPE)

    @property
    def ends(self) -> Array:
        """Where axes start and end (n, 2, 3), mm; anchors twice."""
        return self.point[:, None] + np.array([-1.0, 1.0])[:, None] * (self.half[:, None] * self.axis)[:, None]

    @property
    def middle(self) -> Array:
        """The mean (3,) of all points, mm."""
        return np.asarray(self.point.mean(axis=0)) if len(self) else np.zeros(3)


def landmarks_of(pipeline: Pipeline) -> Landmarks:
    """Return the components of a pipeline as landmarks, in their order."""
    components = pipeline.components
    # whoever gives components alone has not said that nothing is joined
    neighbours = _neighbours(components, pipeline.joints or join(components))
    kind = np.array([KINDS.index(type(component)) for component in components], np.intp)
    placed = [_placed(component) for component in components]
    point, axis = (np.array([one[k] for one in placed], float).reshape(-1, 3) for k in (0, 1))
    held = np.array([[(row, port) in neighbours for port in (0, 1)] for row in range(len(components))], bool).reshape(-1, 2)
    half = np.array([component.length / 2 if isinstance(component, Pipe) else 0.0 for component in components])
    axes_covariance = [_covariances(component, axis[row], half[row]) for row, component in enumerate(components)]
    position, direction = (np.array([one[k] for one in axes_covariance], float).reshape(-1, 3, 3) for k in (0, 1))
    redundant = np.full((len(components), 2), -1, np.intp)
    for row, component in enumerate(components):
        if isinstance(component, Elbow | Tee):
            ports = (0, 1) if isinstance(component, Elbow) else (2, 0 if (row, 0) in neighbours else 1)
            rows = [neighbours[row, port] for port in ports if (row, port) in neighbours]
            pipes = [other for other in rows if isinstance(components[other], Pipe)]
            if len(pipes) == 2:
                redundant[row] = pipes
            if component.sigma_position is None and pipes:
                position[row] = _corner_covariance(np.array(pipes), axis, position)
    weight = np.array(WEIGHTS)[kind] if len(kind) else np.zeros(0)
    sizes = np.array([_sizes(component) for component in components], float).reshape(-1, 2)
    return Landmarks(kind, point, axis, half, sizes, held, position, direction, weight, redundant)


def _neighbours(components: Sequence[AnyComponent], joints: Sequence[Joint]) -> dict[tuple[int, int], int]:
    """Return the row of what is joined at each (row, port)."""
    rows = {component.id: row for row, component in enumerate(components)}
    found = {}
    for joint in joints:
        found[rows[joint.a], int(joint.a_port)] = rows[joint.b]
        found[rows[joint.b], int(joint.b_port)] = rows[joint.a]
    return found


def _placed(component: AnyComponent) -> tuple[Array, Array]:
    """Return the point (3,) and the unit direction (3,) of a component."""
    match component:
        case Pipe():
            return np.add(component.start, component.end) / 2, unit(np.subtract(component.end, component.start))
        case Elbow():
            legs = [unit(np.subtract(end, component.intersection)) for end in (component.start, component.end)]
            return np.array(component.intersection), unit(legs[0] + legs[1])
        case Flange():
            return np.array(component.face), unit(component.axis)
        case Tee():
            return np.array(component.intersection), unit(np.subtract(component.branch_end, component.intersection))
        case Reducer():
            return np.add(component.start, component.end) / 2, unit(component.axis)
        case Cap():
            return np.array(component.start), unit(component.axis)


def _sizes(component: AnyComponent) -> tuple[float, float]:
    match component:
        case Elbow():
            return component.outer_diameter, component.angle_deg
        case Tee():
            return component.outer_diameter, component.branch_diameter
        case Reducer():
            return component.outer_diameter, component.end_diameter
        case _:
            return component.outer_diameter, 0.0


def _covariances(component: AnyComponent, axis: Array, half: float) -> tuple[Array, Array]:
    """Return the covariances (3, 3) of a component's point, mm^2, and of its direction, rad^2.

    Adjusted components are less well known than they say (see ``recon.ends``). An axis' covariance lies across it: three standard
    deviations along the frame's axes are three equations for its three elements. Its direction is worst where its place is.
    """
    factor = SIGMA_FACTOR * (APPROXIMATE_FACTOR if isinstance(component, Pipe) and component.approximate else 1.0)
    known = component.sigma_position is not None
    sigma = factor * np.array(component.sigma_position) if known else np.full(3, UNKNOWN_SIGMA_MM)
    if not isinstance(component, Pipe):
        return np.diag(np.maximum(sigma, LEAST_SIGMA_MM) ** 2), np.eye(3) * np.radians(UNKNOWN_DIRECTION_DEG) ** 2
    across = np.stack(perpendicular_axes(axis))
    if known:
        first, second = across
        equations = np.stack([first**2, 2 * first * second, second**2], axis=1)
        a, b, c = np.linalg.lstsq(equations, sigma**2, rcond=ILL_CONDITIONED)[0]
        values, vectors = np.linalg.eigh(np.array([[a, b], [b, c]]))
    else:
        values, vectors = np.full(2, UNKNOWN_SIGMA_MM**2), np.eye(2)
    values = np.maximum(values, LEAST_SIGMA_MM**2)
    turned = vectors.T @ across
    position = turned.T @ np.diag(values) @ turned
    given = component.sigma_direction_deg
    tilt = np.radians(factor * given if given is not None else UNKNOWN_DIRECTION_DEG)
    tilts = np.maximum(values / values.max() * tilt**2, (LEAST_SIGMA_MM / half) ** 2)
    return position, turned.T @ np.diag(tilts) @ turned


def _corner_covariance(pipes: NDArray[np.intp], axis: Array, position: Array) -> Array:
    """Return the covariance (3, 3), mm^2, of a corner where the axes of pipes meet: each tells of it across itself."""
    information = np.eye(3) / (3 * UNKNOWN_SIGMA_MM) ** 2
    for row in pipes:
        across = np.stack(perpendicular_axes(axis[row]))
        information = information + across.T @ np.linalg.inv(across @ position[row] @ across.T) @ across
    return np.asarray(np.linalg.inv(information))
