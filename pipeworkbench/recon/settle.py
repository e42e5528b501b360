# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many hypotheses drawn onto the nearest edges at once: a few robust Gauss-Newton steps, batched.

The same observation equations as in cylinder_adjustment.py, but without statistics: this only decides which
hypotheses are worth a full adjustment, and one array operation for all of them is what makes it fast.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, perpendicular_axes, smooth_contours
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View

RANGES_PX = (8.0, 6.0, 4.0, 3.0, 2.0)
HELD_RANGES_PX = (3.0, 2.0, 2.0)
SAMPLES = 18
DAMPING = 1e-6  # of the largest diagonal element: keeps hypotheses without edges from a singular matrix

# the parameters, two shifts and two tilts across the axis and the radius: what they move an edge by, and the power of the lever
QUANTITY, LEVERS = np.array([0, 1, 0, 1, 2]), np.array([0, 0, 1, 1, 0])


def settle(views: Sequence[View], cylinders: Cylinders, extents_of: Callable[[Cylinders], Array], *, held: bool = False) -> Cylinders:
    """Return the cylinders after a few iterations.

    Parameters
    ----------
    views : sequence of View
    cylinders : Cylinders
    extents_of : callable
        Gives the extents (k, 2), mm along the axes, whose edges are used.
    held : bool
        Hold the diameters and start near; else the diameters are free.
    """
    for reach in HELD_RANGES_PX if held else RANGES_PX:
        if not len(cylinders):
            return cylinders
        extents = extents_of(cylinders)
        middle, half = extents.mean(axis=1), np.maximum(np.diff(extents, axis=1)[:, 0] / 2, 1.0)
        moved = Cylinders(cylinders.at(middle), cylinders.directions, cylinders.radii)
        cylinders = drawn_onto_edges(views, moved, half, reach, held=held)
        good = (cylinders.radii > 0) & np.isfinite(cylinders.points).all(axis=1)
        cylinders = cylinders[good]
    return cylinders


def drawn_onto_edges(views: Sequence[View], cylinders: Cylinders, half_lengths: Array, reach: float, *, held: bool = False) -> Cylinders:
    """Return all cylinders after one iteration with edges up to ``reach`` px away, ``half_lengths`` (k,) mm to both sides of their points."""
    step, axes = _steps(views, cylinders, half_lengths, reach, held=held)
    directions = cylinders.directions + np.einsum("kp,kpi->ki", step[:, 2:4] / half_lengths[:, None], axes)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Cylinders(cylinders.points + np.einsum("kp,kpi->ki", step[:, :2], axes), directions, cylinders.radii + step[:, 4])


def _steps(views: Sequence[View], cylinders: Cylinders, half: Array, reach: float, *, held: bool) -> tuple[Array, Array]:
    """Return a Gauss-Newton step (k, 5) for each cylinder and the axes (k, 2, 3) it is given along."""
    axes = np.stack(perpendicular_axes(cylinders.directions), axis=1)
    normal_matrix, right = np.zeros((len(cylinders), 5, 5)), np.zeros((len(cylinders), 5))
    lever = np.linspace(-1, 1, SAMPLES)
    powers = np.stack([np.ones(SAMPLES), lever, lever**2], axis=1)
    for view in views:
        seen = smooth_contours(view.camera, cylinders, half[:, None] * np.array([-1.0, 1.0]), (1 + lever) / 2)
        distance = match(view.edges, seen.position.reshape(-1, 2), seen.normal.reshape(-1, 2), reach).distance.reshape(seen.gain.shape)
        found = np.isfinite(distance)
        distance, gain = np.where(found, distance, 0.0), np.where(found, seen.gain, 0.0)
        weighted = (1 - (distance / (1.2 * reach)) ** 2) ** 2 * gain
        # along an edge the rows of the design matrix differ by their gain and lever only: their moments are all that is needed
        by_edge = np.concatenate([np.einsum("ksi,kpi->ksp", seen.outward, axes), np.ones((len(cylinders), 2, 1))], axis=2)[:, :, QUANTITY]
        by_edge = np.where(found.any(axis=2)[..., None], by_edge, 0.0)
        moments = ((weighted * gain) @ powers)[:, :, LEVERS[:, None] + LEVERS]
        normal_matrix += (by_edge[..., None] * by_edge[:, :, None] * moments).sum(axis=1)
        right += (by_edge * ((weighted * distance) @ powers[:, :2])[:, :, LEVERS]).sum(axis=1)
    largest = normal_matrix.diagonal(axis1=1, axis2=2).max(axis=1)
    normal_matrix += (DAMPING * largest + 1e-12)[:, None, None] * np.eye(5)
    if held:
        right[:, 4] = 0.0
        normal_matrix[:, 4, :] = normal_matrix[:, :, 4] = 0.0
        normal_matrix[:, 4, 4] = 1.0
    return np.linalg.solve(normal_matrix, right[..., None])[..., 0], axes
