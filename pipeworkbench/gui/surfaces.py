# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surfaces of components as grids of points: to show them without making solids, as fast as a slider is dragged."""

from __future__ import annotations

import numpy as np

from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.shapes import shapes_of

AROUND = 33  # points of a circle, the first one again at its end
ALONG = 17  # points of a bend


def surfaces_of(component: AnyComponent) -> list[Array]:
    """Return a component's surfaces as grids (rows, columns, 3) of points, mm."""
    shapes = shapes_of([component])
    frustums, tori = shapes.frustums, shapes.tori
    around = np.linspace(0, 2 * np.pi, AROUND)
    circle = np.stack([np.cos(around), np.sin(around)])
    grids = []
    first, second = perpendicular_axes(frustums.axis)
    for row in range(len(frustums)):
        ring = circle.T @ np.stack([first[row], second[row]])
        ends = frustums.start[row] + np.array([[0.0], [frustums.length[row]]]) * frustums.axis[row]
        grids.append(ends[:, None] + frustums.radius[row][:, None, None] * ring)
    for row in range(len(tori)):
        turn = np.linspace(0, tori.angle[row], ALONG)
        radial = np.stack([np.cos(turn), np.sin(turn)]).T @ np.stack([tori.first[row], tori.second[row]])
        outwards = tori.bend_radius[row] + tori.tube_radius[row] * circle[0]
        along_axis = tori.tube_radius[row] * circle[1]
        grids.append(tori.centre[row] + outwards[None, :, None] * radial[:, None] + along_axis[None, :, None] * tori.axis[row])
    return grids
