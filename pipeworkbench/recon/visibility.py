# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which points of pipework a camera sees: lines of sight cut with the surfaces of all components.

Most lines of sight pass most surfaces at a distance: neighbouring ones are taken together and compared with the
capsule around each surface first, so that only those that may hit it are cut with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.shapes import Circles, Frustums, Shapes, Tori

GRAZING = 1e-5  # of the distance: what lies so close before a point is the point itself, touched by its own line of sight
BLOCK = 16  # neighbouring lines of sight that are compared with a surface as one
CHUNK = 1 << 17  # lines of sight with a surface at a time
REAL_ROOT = 1e-5  # imaginary part, in bend radii, below which a root counts as real

Rows = NDArray[np.intp]


def hidden(
    centre: Array, points: Array, shapes: Shapes, owners: Rows, tolerance: float, alternatives: Rows | None = None
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
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
    alternatives : (k,) array of int, optional
        The alternative that each component belongs to: only those of one can hide each other.

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
    hits: Callable[[Array, Array, Any, Rows], Array]
    for surfaces, hits in ((shapes.frustums, _frustum_hits), (shapes.discs, _disc_hits), (shapes.tori, _torus_hits)):
        for line, surface in _near(centre, sight, distance, surfaces):
            others = surfaces.owner[surface] != owners[line]
            if alternatives is not None:
                same = alternatives[surfaces.owner[surface]] == alternatives[owners[line]]
                line, surface, others = line[same], surface[same], others[same]  # noqa: PLW2901
            along = hits(centre, rays[line], surfaces, surface)  # (pairs, hits per surface) mm, inf for none
            with np.errstate(invalid="ignore"):
                nearest = np.where(along > 0, along, np.inf).min(axis=1)
                before = nearest < np.where(others, near_others[line], near_self[line])
            by_itself[line[before & ~others]] = True
            by_others[line[before & others]] = True
    return by_itself, by_others


def _near(centre: Array, sight: Array, distance: Array, surfaces: Frustums | Circles | Tori) -> Iterator[tuple[Rows, Rows]]:
    """Yield the rows of lines of sight (p,) and surfaces (p,) that may meet, so many at a time."""
    count = len(sight)
    if not count or not len(surfaces):
        return
    begin, end, radius = _capsules(surfaces, centre)
    first = np.arange(0, count, BLOCK)
    last = np.minimum(first + BLOCK, count) - 1
    known = np.isfinite(distance)
    weight = known[:, None].astype(float)
    rays = np.nan_to_num(sight) / np.where(known & (distance > 0), distance, 1.0)[:, None]
    middle = np.add.reduceat(rays * weight, first)
    size = np.linalg.norm(middle, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        middle /= size[:, None]
    off = np.where(known, np.linalg.norm(rays - np.repeat(middle, last - first + 1, axis=0), axis=1), 0.0)
    spread = np.maximum.reduceat(off, first)
    # the distance of the lines through the middles from the capsules' axes: squares and products of what lies across the lines
    way = end - begin
    begin_along, way_along = middle @ begin.T, middle @ way.T
    across_begin = np.einsum("si,si->s", begin, begin) - begin_along**2
    across_way = np.einsum("si,si->s", way, way) - way_along**2
    across_both = np.einsum("si,si->s", begin, way) - begin_along * way_along
    with np.errstate(invalid="ignore", divide="ignore"):
        place = np.clip(np.nan_to_num(-across_both / across_way), 0.0, 1.0)
        gap = np.sqrt(np.maximum(across_begin + place * (2 * across_both + place * across_way), 0.0))
        furthest = np.maximum(np.linalg.norm(begin, axis=1), np.linalg.norm(end, axis=1)) + radius
        # a chord is shorter than the offset that it stands for, by less than this where lines of sight are neighbours
        near = gap <= radius + 1.1 * furthest * spread[:, None]
        # what begins behind all points of a block hides none of them
        nearest = np.clip(np.nan_to_num(-np.einsum("si,si->s", begin, way) / np.einsum("si,si->s", way, way)), 0.0, 1.0)
        depth = np.linalg.norm(begin + nearest[:, None] * way, axis=1) - radius
        near &= depth <= np.maximum.reduceat(np.where(known, distance, 0.0), first)[:, None]
    block, surface = np.nonzero(near & (size > 0)[:, None])
    per_chunk = max(CHUNK // BLOCK, 1)
    for start in range(0, len(block), per_chunk):
        some = slice(start, start + per_chunk)
        number = last[block[some]] - first[block[some]] + 1
        line = np.repeat(first[block[some]], number) + np.arange(number.sum()) - np.repeat(np.cumsum(number) - number, number)
        yield line, np.repeat(surface[some], number)


def _capsules(surfaces: Frustums | Circles | Tori, centre: Array) -> tuple[Array, Array, Array]:
    """Return begin and end (k, 3) of the axes of capsules around surfaces, seen from the centre, and their radii (k,)."""
    if isinstance(surfaces, Frustums):
        begin = surfaces.start - centre
        return begin, begin + surfaces.length[:, None] * surfaces.axis, surfaces.radius.max(axis=1)
    if isinstance(surfaces, Circles):
        return surfaces.centre - centre, surfaces.centre - centre, surfaces.radius
    half = surfaces.angle / 2
    bisector = np.cos(half)[:, None] * surfaces.first + np.sin(half)[:, None] * surfaces.second
    # the chord from end to end, as far outwards as the middle of the bend
    reach = np.where(half < np.pi / 2, np.sin(np.minimum(half, np.pi / 2)), 1.0) * surfaces.bend_radius
    aside = np.cross(surfaces.axis, bisector)
    middle = surfaces.centre - centre + (surfaces.bend_radius * (1 + np.cos(half)) / 2)[:, None] * bisector
    radius = surfaces.tube_radius + surfaces.bend_radius * (1 - np.cos(half)) / 2
    return middle - reach[:, None] * aside, middle + reach[:, None] * aside, radius


def _frustum_hits(centre: Array, rays: Array, frustums: Frustums, rows: Rows) -> Array:
    """Return distances (p, 2) along rays (p, 3) to the lateral surfaces of some rows (p,), inf where they miss."""
    from_start = centre - frustums.start
    slope = (frustums.radius[:, 1] - frustums.radius[:, 0]) / frustums.length
    # distance from the axis squared = (r0 + slope x)^2, with x = x0 + x1 t along the axis
    x0 = np.einsum("ki,ki->k", from_start, frustums.axis)
    r0 = frustums.radius[:, 0] + slope * x0
    c = (np.einsum("ki,ki->k", from_start, from_start) - x0**2 - r0**2)[rows]
    x1 = np.einsum("pi,pi->p", rays, frustums.axis[rows])
    a = 1 - x1**2 - (slope[rows] * x1) ** 2
    b = np.einsum("pi,pi->p", rays, from_start[rows]) - x0[rows] * x1 - (slope * r0)[rows] * x1
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(b * b - a * c)
        along = np.stack([(-b - root) / a, (-b + root) / a], axis=1)
        x = x0[rows, None] + x1[:, None] * along
        return np.where((x >= 0) & (x <= frustums.length[rows, None]), along, np.inf)


def _disc_hits(centre: Array, rays: Array, discs: Circles, rows: Rows) -> Array:
    """Return distances (p, 1) along rays (p, 3) to discs of some rows (p,), inf where they miss."""
    towards = discs.centre - centre
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.einsum("ki,ki->k", towards, discs.axis)[rows] / np.einsum("pi,pi->p", rays, discs.axis[rows])
        off = np.linalg.norm(along[:, None] * rays - towards[rows], axis=1)
        return np.where(off <= discs.radius[rows], along, np.inf)[:, None]


def _torus_hits(centre: Array, rays: Array, tori: Tori, rows: Rows) -> Array:
    """Return distances (p, 4) along rays (p, 3) to parts of tori of some rows (p,), inf where they miss."""
    bend, tube = tori.bend_radius[rows], tori.tube_radius[rows]
    # start where the ray is nearest to the centre, and count in bend radii: the quartic is well conditioned then
    towards = tori.centre[rows] - centre
    nearest = np.einsum("pi,pi->p", rays, towards)
    offset = (nearest[:, None] * rays - towards) / bend[:, None]
    hits = np.full((len(rows), 4), np.inf)
    with np.errstate(invalid="ignore"):
        close = np.flatnonzero(np.linalg.norm(offset, axis=1) <= 1 + tube / bend)
    if not len(close):
        return hits
    q, d, torus = offset[close], rays[close], rows[close]
    axis = tori.axis[torus]
    alpha, delta = np.einsum("mi,mi->m", q, axis), np.einsum("mi,mi->m", d, axis)
    # (|x|^2 + 1 - r^2)^2 = 4 (|x|^2 - (x a)^2) with x = q + t d, q d = 0
    gamma = np.einsum("mi,mi->m", q, q)
    k = gamma + 1 - (tube / bend)[close] ** 2
    coefficients = np.stack([np.zeros_like(k), 2 * k - 4 * (1 - delta**2), 8 * alpha * delta, k * k - 4 * (gamma - alpha**2)], axis=1)
    companion = np.zeros((len(k), 4, 4))
    companion[:, 0] = -coefficients
    companion[:, [1, 2, 3], [0, 1, 2]] = 1
    roots = np.linalg.eigvals(companion)
    t = np.where(np.abs(roots.imag) < REAL_ROOT, roots.real, np.nan)
    x = q[:, None, :] + t[:, :, None] * d[:, None, :]
    first, second = tori.first[torus], np.cross(axis, tori.first[torus])
    turn = np.arctan2(np.einsum("mhi,mi->mh", x, second), np.einsum("mhi,mi->mh", x, first))
    with np.errstate(invalid="ignore"):
        on_bend = (turn >= 0) & (turn <= tori.angle[torus, None])
    hits[close] = np.where(on_bend, nearest[close, None] + t * bend[close, None], np.inf)
    return hits
