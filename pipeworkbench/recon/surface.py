# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a cylinder's surface is where it is said to be: the images of it agree, those of what is beside it do not.

Edges say where a contour may be, but mortar joints, door leaves and rails have edges too. If depth, tilt
and radius are right, every point of the surface has the same brightness in neighbouring cameras but for a factor;
and what is seen beside a pipe lies further back, so that there the images disagree. Stripes on a wall
agree beside their edges as well.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, spread
from pipeworkbench.recon.texture import NODES, parabola
from pipeworkbench.recon.views import View, brightness_between

ALONG = np.array([0.04, 0.5, 0.96])  # of the extent; its ends may be another component's
ACROSS = 0.8  # of the radius to each side; the limb itself is the edges' business
BESIDE = ((1.15, 1.6), (1.2, 2.2))  # radii; near beside the limb, and further out
LEAST_KNOWN = 0.5  # part of the samples that both images must contain
LEAST_SPREAD = 1e-6  # grey values; keeps blank images from a division by zero


@dataclass(frozen=True, eq=False)
class Agreement:
    """How well images agree about cylinders (k): correlations -1 to 1, NaN where two images do not contain it.

    surface (pairs, k) of the visible surface; beside (bands, k) the largest of what lies at either side, near and
    further out, in the pair of images that agrees least; constancy (k,) 0 to 1, the part of the surface's brightness that
    does not change along the axis.
    """

    surface: Array
    beside: Array
    constancy: Array


def agreement(views: Sequence[View], cylinders: Cylinders, extents: Array, along: int = 20, across: int = 9) -> Agreement:
    """Compare the images of cylinders' surfaces and of what is beside them.

    Parameters
    ----------
    views : sequence of View
    cylinders : Cylinders
    extents : (k, 2) array
        From where to where, mm along the axes.
    along, across : int
        Number of samples.
    """
    grey = _surface(views, cylinders, extents, along, across)
    bands = [_band(views, cylinders, extents, along, across, side * low, side * high) for low, high in BESIDE for side in (-1, 1)]
    least = []
    for band in bands:
        values = _correlations(band)
        known = np.isfinite(values).any(axis=0)
        least.append(np.where(known, np.where(np.isfinite(values), values, np.inf).min(axis=0, initial=np.inf), np.nan))
    return Agreement(_correlations(grey), np.array(least), _constancy(grey))


def surface_agreement(views: Sequence[View], cylinders: Cylinders, extents: Array, along: int = 20, across: int = 9) -> Array:
    """Return the correlations (pairs, k) of the surface alone."""
    return _correlations(_surface(views, cylinders, extents, along, across))


def _frame(views: Sequence[View], cylinders: Cylinders, extents: Array) -> tuple[Array, Array, Array]:
    """Return points on the axes (k, 3, 3), unit vectors across the axes and the sight (k, 3) and towards the cameras (k, 3)."""
    centre = np.mean([view.camera.projection_centre for view in views], axis=0)
    axis = cylinders.points[:, None] + spread(extents, ALONG)[:, :, None] * cylinders.directions[:, None]
    sight = cylinders.at(extents.mean(axis=1)) - centre
    sideways = np.cross(cylinders.directions, sight)
    sideways /= np.linalg.norm(sideways, axis=1, keepdims=True)
    towards = np.cross(cylinders.directions, sideways)
    towards *= np.where(np.einsum("ki,ki->k", towards, sight) > 0, -1.0, 1.0)[:, None]
    return axis, sideways, towards


def _surface(views: Sequence[View], cylinders: Cylinders, extents: Array, along: int, across: int) -> NDArray[np.float32]:
    axis, sideways, towards = _frame(views, cylinders, extents)
    part = ACROSS * NODES
    offset = part[:, None] * sideways[:, None] + np.sqrt(1 - part**2)[:, None] * towards[:, None]
    return _grey(views, axis[:, :, None] + cylinders.radii[:, None, None, None] * offset[:, None], along, across)


def _band(views: Sequence[View], cylinders: Cylinders, extents: Array, along: int, across: int, low: float, high: float) -> NDArray[np.float32]:
    axis, sideways, _ = _frame(views, cylinders, extents)
    offset = ((low + high) / 2 + (high - low) / 2 * NODES)[:, None] * sideways[:, None]
    return _grey(views, axis[:, :, None] + cylinders.radii[:, None, None, None] * offset[:, None], along, across)


def _grey(views: Sequence[View], nodes: Array, along: int, across: int) -> NDArray[np.float32]:
    """Return what the views show (views, k, along, across) between points (k, 3, 3, 3) along and across, NaN outside the images.

    Only these points are projected: between them a parabola is exact enough.
    """
    weights = np.kron(parabola(along), parabola(across)).T.astype(np.float32)
    grey = [brightness_between(view, nodes.reshape(len(nodes), len(NODES) ** 2, 3), weights) for view in views]
    return np.array(grey).reshape(len(views), len(nodes), along, across)


def _correlations(grey: NDArray[np.float32]) -> Array:
    """Return the correlations (pairs, k) between every two views (views, k, along, across)."""
    flat = grey.reshape(*grey.shape[:2], grey.shape[2] * grey.shape[3])
    result = []
    for one, other in itertools.combinations(flat, 2):
        known = np.isfinite(one) & np.isfinite(other)
        count = np.maximum(known.sum(axis=1), 1)[:, None]
        a, b = np.where(known, one, 0), np.where(known, other, 0)
        a, b = (np.where(known, x - x.sum(axis=1, keepdims=True) / count, 0) for x in (a, b))
        scale = np.sqrt((a * a).sum(axis=1) * (b * b).sum(axis=1))
        value = (a * b).sum(axis=1) / np.maximum(scale, LEAST_SPREAD)
        result.append(np.where(known.mean(axis=1) >= LEAST_KNOWN, value, np.nan))
    return np.array(result).reshape(len(result), grey.shape[1])


def _constancy(grey: NDArray[np.float32]) -> Array:
    """Return the part (k,) of the variance that a profile across the axis explains, the mean of the views that know it."""
    known = np.isfinite(grey)
    values = np.where(known, grey, 0)
    count = np.maximum(known.sum(axis=2, keepdims=True), 1)
    profile = values.sum(axis=2, keepdims=True) / count
    number = np.maximum(known.sum(axis=(2, 3)), 1)
    mean = values.sum(axis=(2, 3), keepdims=True) / number[:, :, None, None]
    rest = np.where(known, values - profile, 0)
    whole = np.where(known, values - mean, 0)
    share = 1 - (rest**2).sum(axis=(2, 3)) / np.maximum((whole**2).sum(axis=(2, 3)), LEAST_SPREAD)
    seen = known.mean(axis=(2, 3)) >= LEAST_KNOWN
    return np.where(seen, share, 0).sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
