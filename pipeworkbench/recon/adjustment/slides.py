# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flanges far from where they belong: the place along their pipe where their circles find edges.

The nearest edge of a face may be that of its plate's back or of the flange that it meets: no iteration gets away
from there. So all places along the axis are compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Flange
from pipeworkbench.recon.adjustment.charts import POSITION
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.sampling import NOT_OBSERVED
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.match import match
from pipeworkbench.recon.vectors import as_vector, unit

STEP_MM = 0.5
REACH_PX, SCATTER_PX = 3.0, 1.0  # of an edge from a contour that it may be, and how fast it counts less
INTERVAL_PX = 6.0  # between samples
COARSE = 33  # points per curve with which its length is measured


def slid(state: State, settings: AdjustmentSettings) -> State:
    """Return the state with flanges along their axes where their contours find the most edges.

    Flanges that meet go together, as far apart as the gasket is thick: one alone looks the same where the other one is.
    """
    components: list[AnyComponent] = list(state.components)
    for row, pair in _pairs(state).items():
        flange = components[row]
        assert isinstance(flange, Flange)  # noqa: S101  # only flanges were collected
        shifts = np.arange(-settings.slide, settings.slide + STEP_MM / 2, STEP_MM)
        score = _scores(state, flange, shifts)
        other = components[pair] if pair is not None else None
        if isinstance(other, Flange):
            # the other one looks back: its shifts are against its own axis
            gap = float(np.subtract(other.face, flange.face) @ unit(flange.axis)) - settings.gasket
            score = score + _scores(state, other, gap - shifts)
        if score.any():
            shift = float(shifts[np.argmax(score)])
            components[row] = _shifted(flange, shift)
            if pair is not None and isinstance(other, Flange):
                components[pair] = _shifted(other, gap - shift)
    return replace(state, components=tuple(components))


def _pairs(state: State) -> dict[int, int | None]:
    """Return the rows of flanges that may slide, each with that of the flange that it meets, or None; each pair comes once."""
    number = {component.id: row for row, component in enumerate(state.components)}
    met: dict[int, int] = {}
    for joint in (state.problem.joints[index] for index in state.joints):
        one, other = number[joint.a], number[joint.b]
        if joint.a_port == joint.b_port == 0 and all(isinstance(state.components[row], Flange) for row in (one, other)):
            met |= {one: other, other: one}
    free = {row for row, component in enumerate(state.components) if isinstance(component, Flange) and POSITION in state.free[row]}
    # the gasket says where one is whose neighbour stays
    return {row: met.get(row) for row in sorted(free) if row not in met or (met[row] in free and row < met[row])}


def _shifted(flange: Flange, shift: float) -> Flange:
    return replace(flange, face=as_vector(np.array(flange.face) + shift * unit(flange.axis)))


def _scores(state: State, flange: Flange, shifts: Sequence[float] | Array) -> Array:
    """Return how many edges the contours of a flange find at shifts (s,) along its axis, by how near they are."""
    places = [_shifted(flange, float(shift)) for shift in shifts]
    total = np.zeros(len(places))
    for view, camera in zip(state.views, state.cameras, strict=True):
        if not len(view.edges):
            continue
        contour = contour_of(camera, places, INTERVAL_PX, alternatives=range(len(places)), coarse=COARSE)
        if not len(contour):
            continue
        observed = ~np.isin(contour.names, NOT_OBSERVED)[contour.curve]
        contour = contour[observed & contour.visible]
        found = match(view.edges, contour.position, contour.normal, REACH_PX)
        near = np.where(found.found, np.exp(-0.5 * (np.nan_to_num(found.distance) / SCATTER_PX) ** 2), 0.0)
        number = np.bincount(contour.component, minlength=len(places))
        total += np.bincount(contour.component, near, len(places)) / np.maximum(number, 1)
    return total
