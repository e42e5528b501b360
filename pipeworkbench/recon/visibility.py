# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which points of pipework a camera sees: lines of sight cut with the surfaces of all components."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.shapes import Circles, Frustums, Shapes, Tori

GRAZING = 1e-5  # of the distance: what lies so close before a point is the point itself, touched by its own line of sight
CHUNK = 1 << 18  # lines of sight times surfaces at a time
REAL_ROOT = 1e-5  # imaginary part, in bend radii, below which a root counts as real


def hidden(centre: Array, points: Array, shapes: Shapes, owners: NDArray[np.intp], tolerance: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which points are hidden from a projection centre by their own component and by others.

    Parameters
    ----------
    centre : (3,) array
        The projection centre.
    points : (n, 3) array
        Points on the components' surfaces, or NaN.
    shapes : Shapes
        All components.
    owners : (n,) array
        The component that each point belongs to.
    tolerance : float
        Another component hides a point only where it is nearer by more than this many mm:
        neighbours touch, and where they are measured they overlap a little.

    Returns
    -------
    by_itself, by_others : (n,) arrays of bool
    """
    sight = points - centre
    distance = np.linalg.norm(sight, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        rays = sight / distance[:, None]
    near_self, near_others = distance * (1 - GRAZING), distance - tolerance
    by_itself, by_others = np.zeros(len(points), bool), np.zeros(len(points), bool)
    surfaces: Any
    hits: Callable[[Array, Array, Any], Array]
    for surfaces, hits in ((shapes.frustums, _frustum_hits), (shapes.discs, _disc_hits), (shapes.tori, _torus_hits)):
        if not len(surfaces):
            continue
        step = max(CHUNK // len(surfaces), 1)
        for first in range(0, len(points), step):
            rows = slice(first, first + step)
            along = hits(centre, rays[rows], surfaces)  # (lines, surfaces, hits per surface) mm, inf for none
            own = surfaces.owner[None, :] == owners[rows, None]
            with np.errstate(invalid="ignore"):
                along = np.where(along > 0, along, np.inf).min(axis=2)
                by_itself[rows] |= (own & (along < near_self[rows, None])).any(axis=1)
                by_others[rows] |= (~own & (along < near_others[rows, None])).any(axis=1)
    return by_itself, by_others


def hidden_in_alternatives(
    centre: Array, points: Array, shapes: Shapes, owners: NDArray[np.intp], tolerance: float, alternatives: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Do what :func:`hidden` does where only components of one alternative (k,) can hide each other."""
    by_itself, by_others = np.zeros(len(points), bool), np.zeros(len(points), bool)
    own = alternatives[owners]
    for alternative in np.unique(own):
        rows = np.flatnonzero(own == alternative)
        few = shapes.of(alternatives == alternative)
        by_itself[rows], by_others[rows] = hidden(centre, points[rows], few, owners[rows], tolerance)
    return by_itself, by_others


def _frustum_hits(centre: Array, rays: Array, frustums: Frustums) -> Array:
    """Return distances (n, k, 2) along rays (n, 3) to the lateral surfaces, inf where they miss."""
    from_start = centre - frustums.start
    slope = (frustums.radius[:, 1] - frustums.radius[:, 0]) / frustums.length
    # distance from the axis squared = (r0 + slope x)^2, with x = x0 + x1 t along the axis
    x0, x1 = np.einsum("ki,ki->k", from_start, frustums.axis), rays @ frustums.axis.T
    r0 = frustums.radius[:, 0] + slope * x0
    a = 1 - x1**2 - (slope * x1) ** 2
    b = rays @ from_start.T - x0 * x1 - slope * x1 * r0
    c = np.einsum("ki,ki->k", from_start, from_start) - x0**2 - r0**2
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(b * b - a * c)
        along = np.stack([(-b - root) / a, (-b + root) / a], axis=2)
        x = x0[:, None] + x1[:, :, None] * along
        return np.where((x >= 0) & (x <= frustums.length[:, None]), along, np.inf)


def _disc_hits(centre: Array, rays: Array, discs: Circles) -> Array:
    """Return distances (n, k, 1) along rays (n, 3) to discs, inf where they miss."""
    towards = discs.centre - centre
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.einsum("ki,ki->k", towards, discs.axis) / (rays @ discs.axis.T)
        off = np.linalg.norm(along[:, :, None] * rays[:, None, :] - towards, axis=2)
        return np.where(off <= discs.radius, along, np.inf)[:, :, None]


def _torus_hits(centre: Array, rays: Array, tori: Tori) -> Array:
    """Return distances (n, k, 4) along rays (n, 3) to parts of tori, inf where they miss."""
    bend, tube = tori.bend_radius, tori.tube_radius
    # start where the ray is nearest to the centre, and count in bend radii: the quartic is well conditioned then
    towards = tori.centre - centre
    nearest = rays @ towards.T
    offset = (nearest[:, :, None] * rays[:, None, :] - towards) / bend[:, None]
    hits = np.full((*nearest.shape, 4), np.inf)
    with np.errstate(invalid="ignore"):
        close = np.linalg.norm(offset, axis=2) <= 1 + tube / bend
    row, column = np.nonzero(close)
    if not len(row):
        return hits
    q, d, axis = offset[row, column], rays[row], tori.axis[column]
    alpha, delta = np.einsum("mi,mi->m", q, axis), np.einsum("mi,mi->m", d, axis)
    # (|x|^2 + 1 - r^2)^2 = 4 (|x|^2 - (x a)^2) with x = q + t d, q d = 0
    gamma = np.einsum("mi,mi->m", q, q)
    k = gamma + 1 - (tube / bend)[column] ** 2
    coefficients = np.stack([np.zeros_like(k), 2 * k - 4 * (1 - delta**2), 8 * alpha * delta, k * k - 4 * (gamma - alpha**2)], axis=1)
    companion = np.zeros((len(k), 4, 4))
    companion[:, 0] = -coefficients
    companion[:, [1, 2, 3], [0, 1, 2]] = 1
    roots = np.linalg.eigvals(companion)
    t = np.where(np.abs(roots.imag) < REAL_ROOT, roots.real, np.nan)
    x = q[:, None, :] + t[:, :, None] * d[:, None, :]
    first, second = tori.first[column], np.cross(axis, tori.first[column])
    turn = np.arctan2(np.einsum("mhi,mi->mh", x, second), np.einsum("mhi,mi->mh", x, first))
    with np.errstate(invalid="ignore"):
        on_bend = (turn >= 0) & (turn <= tori.angle[column, None])
    hits[row, column] = np.where(on_bend, nearest[row, column, None] + t * bend[column, None], np.inf)
    return hits
