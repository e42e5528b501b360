# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flanges far from where they belong: the place along their pipe where their circles find edges.

The nearest edge of a face may be that of its plate's back or of the flange that it meets: no iteration gets away
from there. So all places along the axis are compared.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pipeworkbench.pipeline import Flange
from pipeworkbench.recon.adjustment.charts import POSITION
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.adjustment.sampling import NOT_OBSERVED
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.bodies import FLANGE, START
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.match import match
from pipeworkbench.recon.vectors import as_vector

STEP_MM = 0.5
REACH_PX, SCATTER_PX = 3.0, 1.0  # of an edge from a contour that it may be, and how fast it counts less
INTERVAL_PX = 6.0  # between samples
COARSE = 33  # points per curve with which its length is measured


def slid(state: State, settings: AdjustmentSettings) -> State:
    """Return the state with flanges along their axes where their contours find the most edges.

    Flanges that meet go together, as far apart as the gasket is thick: one alone looks the same where the other one is.
    """
    points, changed = state.bodies.points.copy(), state.bodies.changed.copy()
    shifts = np.arange(-settings.slide, settings.slide + STEP_MM / 2, STEP_MM)
    axis = state.bodies.axis
    for row, pair in _pairs(state).items():
        score, gap = _scores(state, row, shifts), 0.0
        if pair is not None:
            # the other one looks back: its shifts are against its own axis
            gap = float((points[pair, START] - points[row, START]) @ axis[row]) - settings.gasket
            score = score + _scores(state, pair, gap - shifts)
        if score.any():
            shift = float(shifts[np.argmax(score)])
            for flange, way in ((row, shift), (pair, gap - shift)):
                if flange is not None:
                    points[flange, START] += way * axis[flange]
                    changed[flange] = True
    return replace(state, bodies=replace(state.bodies, points=points, changed=changed))


def _pairs(state: State) -> dict[int, int | None]:
    """Return the rows of flanges that may slide, each with that of the flange that it meets, or None; each pair comes once."""
    links = state.conditions.links
    met: dict[int, int] = {}
    for one, other in links.bodies[links.faces(state.bodies)].tolist():
        met |= {one: other, other: one}
    free = {row for row in state.bodies.rows(FLANGE).tolist() if POSITION in state.free[row]}
    # the gasket says where one is whose neighbour stays
    return {row: met.get(row) for row in sorted(free) if row not in met or (met[row] in free and row < met[row])}


def _scores(state: State, row: int, shifts: Array) -> Array:
    """Return how many edges the contours of a flange find at shifts (s,), mm, along its axis, by how near they are."""
    flange, axis = state.components[row], state.bodies.axis[row]
    assert isinstance(flange, Flange)  # noqa: S101  # only flanges slide
    places = [replace(flange, face=as_vector(state.bodies.points[row, START] + shift * axis)) for shift in shifts]
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
