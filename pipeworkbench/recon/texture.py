# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well the surface of a cylinder maps from one image to another: stains, rust and grain fix its depth.

Edges say where a contour may be, but texture near a limb, a beam or a row of bricks has edges too. The
surface of the true cylinder maps point by point between neighbouring cameras; that of a wrong one,
some pixels of parallax away, does not. Where the surface is bare or mirrors its surroundings the
correlation says nothing, and the likelihood ratio is built so that it then stays near zero.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, spread
from pipeworkbench.recon.interpolation import interpolation
from pipeworkbench.recon.views import View, brightness_between

NODES = np.array([-1.0, 0.0, 1.0])  # where a surface is projected, along and across; between them a parabola is exact to 0.2 px
MARGIN = 0.97  # of the length: the ends of the clicked part may lie on a seam


@dataclass(frozen=True)
class TextureSettings:
    """Tunables of the comparison.

    ``along`` and ``across`` are samples on the surface, ``patches`` their partition (along, across); each
    patch is judged by itself because others may be hidden behind something. ``widest`` is the sine of
    the angle about the axis, from the direction to the camera, up to which the surface is compared.
    ``independent`` is the number of independent samples in a patch (blobs of texture, not pixels),
    ``textured`` the part of a true surface's patches that correlate at all, ``outliers`` the part of
    a wrong surface's that correlate by accident (repeated patterns).
    """

    along: int = 48
    across: int = 8
    patches: tuple[int, int] = (6, 2)
    widest: float = 0.8
    independent: float = 12.0
    textured: float = 0.5
    outliers: float = 0.01


def texture(views: Sequence[View], reference: int, cylinders: Cylinders, extents: Array, settings: TextureSettings | None = None) -> Array:
    """Return log-likelihood ratios that the views show the same surface as the reference.

    Parameters
    ----------
    views : sequence of View
    reference : int
        The view that the cylinders were clicked in.
    cylinders : Cylinders
    extents : (k, 2) array
        From where to where, mm along the axes.
    settings : TextureSettings, optional

    Returns
    -------
    (views, k) array
        Mean over the patches; 0 for the reference and where an image does not contain a cylinder.
    """
    settings = settings or TextureSettings()
    surface = _control_points(cylinders, extents, views[reference].camera.projection_centre, settings)
    own, own_norm = _patches(views[reference], surface, settings)
    result = np.zeros((len(views), len(cylinders)))
    for number, view in enumerate(views):
        if number == reference:
            continue
        other, other_norm = _patches(view, surface, settings)
        with np.errstate(invalid="ignore", divide="ignore"):
            correlation = np.einsum("kpi,kpi->kp", own, other) / (own_norm * other_norm)
        result[number] = _log_ratio(correlation, settings).mean(axis=1)
    return result


def _log_ratio(correlation: Array, settings: TextureSettings) -> Array:
    """Return how much more likely a correlation is on the true surface; 0 where there is none (NaN)."""
    known = np.isfinite(correlation)
    r = np.where(known, correlation, 0.0)
    # n independent pairs without correlation: density (1 - r^2)^((n - 4) / 2) / B(1/2, (n - 2) / 2), near enough a normal one of 1/sqrt(n - 1)
    power = (settings.independent - 4) / 2
    by_chance = np.clip(1 - r**2, 0, None) ** power * np.sqrt((settings.independent - 1) / (2 * np.pi))
    wrong = (1 - settings.outliers) * by_chance + settings.outliers / 2
    # a textured surface correlates the better, the more its texture stands out from noise: density 2 r
    right = settings.textured * 2 * np.maximum(r, 0) + (1 - settings.textured) * wrong
    return np.where(known, np.log(right / wrong), 0.0)


def _control_points(cylinders: Cylinders, extents: Array, origin: Array, settings: TextureSettings) -> Array:
    """Return points (k, 3, 3, 3) on the surfaces that face ``origin``: along, across, coordinate."""
    towards = origin - cylinders.points
    towards = towards - np.einsum("ki,ki->k", towards, cylinders.directions)[:, None] * cylinders.directions
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    sideways = np.cross(cylinders.directions, towards)
    sine = settings.widest * NODES
    cosine = np.sqrt(1 - sine**2)
    outward = cosine[:, None] * towards[:, None] + sine[:, None] * sideways[:, None]
    along = spread(extents, (1 + MARGIN * NODES) / 2)
    axis = cylinders.points[:, None] + along[:, :, None] * cylinders.directions[:, None]
    return np.asarray(axis[:, :, None] + cylinders.radii[:, None, None, None] * outward[:, None])


def _patches(view: View, surface: Array, settings: TextureSettings) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the brightness of patches (k, p, n) but for straight lines along the axis, and its norm (k, p).

    Without the lines the shading across is left out, which moves with the camera, also where an axis is
    a little askew. A sample that is not in the image makes its patch unknown.
    """
    weights, without_lines = _sampling(settings)
    grey = brightness_between(view, surface.reshape(len(surface), len(NODES) ** 2, 3), weights)
    rows, columns = settings.patches
    patches = (grey.reshape(-1, len(without_lines)) @ without_lines).reshape(len(surface), rows * columns, -1)
    return patches, np.asarray(np.sqrt(np.einsum("kpi,kpi->kp", patches, patches)))


@functools.cache
def _sampling(settings: TextureSettings) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return weights (9, n) from control points to samples, patch by patch and line by line along the axis; and what leaves lines out.

    The latter (s, s - 2) takes the brightness of a patch's s samples along the axis to its components in an
    orthonormal basis of all that is neither constant nor linear: correlations are the same in it.
    """
    rows, columns = settings.patches
    along = parabola(settings.along).reshape(rows, -1, len(NODES))
    across = parabola(settings.across).reshape(columns, -1, len(NODES))
    weights = np.einsum("psi,qtj->ijpqts", along, across).reshape(len(NODES) ** 2, -1)
    line = np.linspace(-1, 1, along.shape[1])
    basis, _ = np.linalg.qr(np.stack([np.ones_like(line), line], axis=1), mode="complete")
    return weights.astype(np.float32), basis[:, 2:].astype(np.float32)


def parabola(count: int) -> Array:
    """Return weights (count, 3) that interpolate values at NODES to evenly spaced places from -1 to 1."""
    return interpolation(NODES, np.linspace(-1, 1, count)).T
