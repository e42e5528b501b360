# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many hypotheses drawn onto the nearest edges at once: a few robust Gauss-Newton steps, batched.

The same observation equations as in adjust.py, but without statistics: this only decides which
hypotheses are worth a full adjustment, and one array operation for all of them is what makes it fast.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, contours, perpendicular_axes
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View

RANGES_PX = (8.0, 6.0, 4.0, 3.0, 2.0, 2.0)
KEPT = (1.0, 0.6, 1.0, 0.6, 1.0, 1.0)  # part of the hypotheses that goes on after each iteration
SAMPLES = 18
DAMPING = 1e-6  # of the largest diagonal element: keeps hypotheses without edges from a singular matrix


def settle(views: Sequence[View], cylinders: Cylinders, extents_of: Callable[[Cylinders], Array]) -> Cylinders:
    """Return the cylinders after a few iterations with free diameters.

    Parameters
    ----------
    views : sequence of View
    cylinders : Cylinders
    extents_of : callable
        Gives the extents (k, 2), mm along the axes, whose edges are used.
    """
    for reach, kept in zip(RANGES_PX, KEPT, strict=True):
        if not len(cylinders):
            return cylinders
        extents = extents_of(cylinders)
        middle, half = extents.mean(axis=1), np.maximum(np.diff(extents, axis=1)[:, 0] / 2, 1.0)
        moved = Cylinders(cylinders.points + middle[:, None] * cylinders.directions, cylinders.directions, cylinders.radii)
        cylinders, support = _moved(views, moved, half, reach)
        good = (cylinders.radii > 0) & np.isfinite(cylinders.points).all(axis=1)
        good &= support >= np.quantile(support, 1 - kept)
        cylinders = cylinders[good]
    return cylinders


def drawn_onto_edges(views: Sequence[View], cylinders: Cylinders, half_lengths: Array, reach: float) -> Cylinders:
    """Return all cylinders after one iteration with edges up to ``reach`` px away, ``half_lengths`` (k,) mm to both sides of their points."""
    return _moved(views, cylinders, half_lengths, reach)[0]


def _moved(views: Sequence[View], cylinders: Cylinders, half: Array, reach: float) -> tuple[Cylinders, Array]:
    step, axes, support = _steps(views, cylinders, half, reach)
    directions = cylinders.directions + np.einsum("kp,kpi->ki", step[:, 2:4] / half[:, None], axes)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Cylinders(cylinders.points + np.einsum("kp,kpi->ki", step[:, :2], axes), directions, cylinders.radii + step[:, 4]), support


def _steps(views: Sequence[View], cylinders: Cylinders, half: Array, reach: float) -> tuple[Array, Array, Array]:
    """Return a Gauss-Newton step (k, 5) for each cylinder, the axes (k, 2, 3) it is given along and its support (k,).

    The support is the mean weight of the samples in the images: near edges count more than far ones.
    """
    axes = np.stack(perpendicular_axes(cylinders.directions), axis=1)
    normal_matrix, right = np.zeros((len(cylinders), 5, 5)), np.zeros((len(cylinders), 5))
    support, visible = np.zeros(len(cylinders)), np.zeros(len(cylinders))
    lever = np.linspace(-1, 1, SAMPLES)
    for view in views:
        seen = contours(view.camera, cylinders, half[:, None] * lever)
        shape = seen.gain.shape
        distance = match(view.edges, seen.position.reshape(-1, 2), seen.normal.reshape(-1, 2), reach).distance.reshape(shape)
        weight = np.where(np.isnan(distance), 0, (1 - (np.nan_to_num(distance) / (1.2 * reach)) ** 2) ** 2)
        support += weight.sum(axis=(1, 2))
        visible += np.isfinite(seen.position[..., 0]).sum(axis=(1, 2))
        across = np.einsum("ksi,kpi->ksp", seen.outward, axes)[:, :, None, :]
        across = np.broadcast_to(across, (*shape, 2))
        design = np.concatenate([across, lever[:, None] * across, np.ones((*shape, 1))], axis=3)
        design = np.nan_to_num(seen.gain[..., None] * design).reshape(len(cylinders), -1, 5)
        weighted = design * weight.reshape(len(cylinders), -1, 1)
        normal_matrix += np.einsum("knp,knq->kpq", weighted, design)
        right += np.einsum("knp,kn->kp", weighted, np.nan_to_num(distance).reshape(len(cylinders), -1))
    largest = normal_matrix.diagonal(axis1=1, axis2=2).max(axis=1)
    normal_matrix += (DAMPING * largest + 1e-12)[:, None, None] * np.eye(5)
    return np.linalg.solve(normal_matrix, right[..., None])[..., 0], axes, support / np.maximum(visible, 1)
