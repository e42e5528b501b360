# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convex bodies that stand for insulation, bare components and obstacles, and the distances between them.

A body is the convex hull of discs, of two for a pipe, a gore or a cone, or of eight points for a block. Its support function,
the furthest it reaches along a unit direction n, is max over its discs of c n + hypot(u n, v n) with the centre c and the half
axes u, v. Two convex bodies A and B are max over n of -(h_A(n) + h_B(-n)) apart; where they overlap this is the least
way by which they must be moved apart, negative (Gilbert, Johnson, Keerthi 1988 state the same as a minimum).
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array

Rows = NDArray[np.intp]
BLOCK_CORNERS = 8
DIRECTIONS = 64  # that the search begins with, spread over the sphere
ROUNDS, TRIES = 40, 6  # of the search, and directions around the best in each
FIRST_STEP, SHRINK = 0.35, 0.7  # rad; from round to round
CHUNK = 2000  # bodies compared with all others at a time
PROJECTIONS = 30  # to and fro between an axis and a block
SAME = 1e-12


@dataclass(frozen=True, eq=False)
class Hulls:
    """Bodies in arrays: ``centres``, half axes ``u`` and ``v`` (n, k, 3) mm of their k discs, ``owner`` (n,) the number of what they are part of.

    A body's axis goes from its first to its last disc's centre (a block's from corner to corner), ``radius`` (n,) mm contains all of it.
    """

    centres: Array
    u: Array
    v: Array
    owner: Rows

    @functools.cached_property
    def radius(self) -> Array:
        """Radius (n,) mm around the axis within which all of the body is, counted from points of the axis."""
        start, end = self.centres[:, 0], self.centres[:, -1]
        away = _from_segment(self.centres, start, end)
        reach = np.sqrt((self.u**2).sum(-1) + (self.v**2).sum(-1)) if self.centres.shape[1] == BLOCK_CORNERS else _longest(self.u, self.v)
        return np.asarray((away + reach).max(axis=1))

    @functools.cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper corners (n, 3) mm of the boxes around the bodies."""
        reach = np.sqrt(self.u**2 + self.v**2)
        return (self.centres - reach).min(axis=1), (self.centres + reach).max(axis=1)

    def __getitem__(self, rows: Rows) -> Hulls:
        return Hulls(self.centres[rows], self.u[rows], self.v[rows], self.owner[rows])

    def __len__(self) -> int:
        return len(self.centres)

    def support(self, directions: Array) -> Array:
        """Return how far (n, m) mm the bodies reach along directions (n, m, 3)."""
        turned = np.swapaxes(directions, 1, 2)
        reach = self.centres @ turned + np.hypot(self.u @ turned, self.v @ turned)
        return np.asarray(reach.max(axis=1))

    @property
    def ways(self) -> Array:
        """From the axes' starts to their ends (n, 3) mm."""
        return np.asarray(self.centres[:, -1] - self.centres[:, 0])

    def moved(self, origin: Array, axes: Array) -> Hulls:
        """Return the bodies of a frame with this origin (3,) and these axes (3, 3), in rows, in the frame around it."""
        return Hulls(self.centres @ axes + origin, self.u @ axes, self.v @ axes, self.owner)


def discs(centres: Array, u: Array, v: Array, owner: int) -> Hulls:
    """Return the bodies between consecutive discs (m, 3) mm of one owner."""

    def pairs(values: Array) -> Array:
        return np.stack([values[:-1], values[1:]], axis=1)

    return Hulls(pairs(centres), pairs(u), pairs(v), np.full(len(centres) - 1, owner, np.intp))


def cylinder(start: Array, end: Array, start_radius: float, end_radius: float, owner: int) -> Hulls:
    """Return a cylinder or a cone between circles across the line of their centres (3,) mm."""
    way = np.subtract(end, start)
    way = way / np.linalg.norm(way)
    aside = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
    aside /= np.linalg.norm(aside)
    radii = np.array([[start_radius], [end_radius]])
    return discs(np.array([start, end]), radii * aside, radii * np.cross(way, aside), owner)


def block(lower: Sequence[float], upper: Sequence[float], owner: int) -> Hulls:
    """Return a block along the axes between two opposite corners (3,) mm; its first and last corner are the given ones."""
    corners = np.array(np.meshgrid(*zip(lower, upper, strict=True), indexing="ij")).reshape(3, BLOCK_CORNERS).T[None]
    return Hulls(corners.astype(float), np.zeros((1, BLOCK_CORNERS, 3)), np.zeros((1, BLOCK_CORNERS, 3)), np.array([owner], np.intp))


def joined(parts: Sequence[Hulls]) -> Hulls:
    """Return bodies of as many discs in one."""
    return Hulls(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("centres", "u", "v", "owner")))


def near_pairs(one: Hulls, other: Hulls, distance: float) -> tuple[Rows, Rows]:
    """Return rows of two sets of bodies that may be nearer than a distance (mm): their boxes are, and their axes with all around them."""
    (low, high), (other_low, other_high) = one.bounds, other.bounds
    found = []
    for begin in range(0, len(one), CHUNK):
        part = slice(begin, begin + CHUNK)
        near = np.ones((len(low[part]), len(other)), bool)
        for axis in range(3):
            near &= low[part, None, axis] - distance <= other_high[None, :, axis]
            near &= other_low[None, :, axis] - distance <= high[part, None, axis]
        found.append(np.argwhere(near) + np.array([begin, 0]))
    rows, columns = np.concatenate(found).T if found else np.zeros((2, 0), np.intp)
    apart = axis_distances(one[rows], other[columns]) - one.radius[rows] - other.radius[columns]
    good = apart <= distance
    return rows[good], columns[good]


def axis_distances(one: Hulls, other: Hulls) -> Array:
    """Return the distances (n,) mm between the axes of bodies, one by one."""
    first, second = nearest_on_axes(one, other)
    return np.asarray(np.linalg.norm(first - second, axis=1))


def nearest_on_axes(one: Hulls, other: Hulls) -> tuple[Array, Array]:
    """Return the nearest points (n, 3) mm of the bodies' axes, one by one; of parallel ones some that are.

    The unconstrained solution is cut off at the ends in turn (Ericson, Real-Time Collision Detection, 5.1.9).
    """
    start, way, other_start, other_way = one.centres[:, 0], one.ways, other.centres[:, 0], other.ways
    apart = start - other_start
    a, e = (way**2).sum(1), (other_way**2).sum(1)
    b, c, f = (way * other_way).sum(1), (way * apart).sum(1), (other_way * apart).sum(1)
    determinant = a * e - b * b
    s = np.where(determinant > SAME * a * e, np.clip((b * f - c * e) / np.where(determinant > 0, determinant, 1.0), 0, 1), 0.0)
    t = np.clip((b * s + f) / np.maximum(e, SAME), 0, 1)
    s = np.clip((b * t - c) / np.maximum(a, SAME), 0, 1)
    return start + s[:, None] * way, other_start + t[:, None] * other_way


def signed_distances(one: Hulls, other: Hulls, limit: float = np.inf) -> tuple[Array, Array]:
    """Return the distances (n,) mm of bodies, one by one, negative depths where they overlap, and a point (n, 3) between both surfaces.

    What is surely further apart than ``limit`` (mm) is not looked at closely: its distance is only more than that. The best of some
    directions is turned in ever smaller steps; directions across an axis are tried as well, because there the
    support function has an edge.
    """
    count = len(one)
    if not count:
        return np.zeros(0), np.zeros((0, 3))
    first, second = nearest_on_axes(one, other)
    crossed = np.cross(_units(one.ways), _units(other.ways))
    starts = _units(np.stack([second - first, crossed, -crossed, one.ways, -one.ways, other.ways, -other.ways], axis=1))
    # along the axes of space lie a block's faces
    usual = np.concatenate([np.eye(3), -np.eye(3), _spread(DIRECTIONS)])
    tried = np.concatenate([starts, np.broadcast_to(usual, (count, *usual.shape))], axis=1)
    best, apart = _best(one, other, tried)
    close = np.flatnonzero(apart <= limit)
    if len(close):
        best[close], apart[close] = _refined(one[close], other[close], best[close], apart[close])
    middle = (first + second) / 2 if other.centres.shape[1] != BLOCK_CORNERS else _beside_blocks(one, other)
    # half way between the planes across the direction that touch both bodies
    level = (one.support(best[:, None])[:, 0] - other.support(-best[:, None])[:, 0]) / 2
    return apart, middle + (level - (middle * best).sum(1))[:, None] * best


def _beside_blocks(one: Hulls, blocks: Hulls) -> Array:
    """Return the points (n, 3) of the bodies' axes that are the nearest to blocks, one by one, by projections to and fro."""
    start, way = one.centres[:, 0], one.ways
    low, high = blocks.bounds
    point = start + way / 2
    for _ in range(PROJECTIONS):
        share = ((np.clip(point, low, high) - start) * way).sum(1) / np.maximum((way**2).sum(1), SAME)
        point = start + np.clip(share, 0, 1)[:, None] * way
    return np.asarray(point)


def _refined(one: Hulls, other: Hulls, best: Array, apart: Array) -> tuple[Array, Array]:
    """Return the best directions (n, 3) near some good ones, and the distances (n,) mm along them."""
    axes = (_units(one.ways), _units(other.ways))
    step = FIRST_STEP
    for turn in range(ROUNDS):
        angles = 2 * np.pi * (np.arange(TRIES) / TRIES) + turn
        aside = _units(np.cross(best, np.eye(3)[np.argmin(np.abs(best), axis=1)]))
        beside = np.cross(best, aside)
        offsets = np.cos(angles)[:, None] * aside[:, None] + np.sin(angles)[:, None] * beside[:, None]
        around = best[:, None] + np.tan(step) * offsets
        flat = [around - (around * axis[:, None]).sum(2, keepdims=True) * axis[:, None] for axis in axes]
        direction, value = _best(one, other, _units(np.concatenate([around, *flat], axis=1)))
        best, apart = np.where((value > apart)[:, None], direction, best), np.maximum(value, apart)
        step *= SHRINK
    return best, apart


def _best(one: Hulls, other: Hulls, tried: Array) -> tuple[Array, Array]:
    """Return the directions (n, 3) of those tried (n, m, 3) along which the bodies are the furthest apart, and how far (n,) mm."""
    found = -(one.support(tried) + other.support(-tried))
    number = found.argmax(axis=1)
    rows = np.arange(len(found))
    return tried[rows, number], found[rows, number]


def _units(vectors: Array) -> Array:
    """Return unit vectors (..., 3); of nothing the z axis."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(length > SAME, vectors / np.maximum(length, SAME), np.array([0.0, 0.0, 1.0]))


@functools.cache
def _spread(count: int) -> Array:
    """Return unit vectors (count, 3) evenly over the sphere (Fibonacci's spiral)."""
    number = np.arange(count) + 0.5
    height, turn = 1 - 2 * number / count, np.pi * (1 + np.sqrt(5)) * number
    across = np.sqrt(1 - height**2)
    return np.column_stack([across * np.cos(turn), across * np.sin(turn), height])


def _longest(u: Array, v: Array) -> Array:
    """Return the larger half axes (n, k) of discs whose half axes are at right angles."""
    return np.maximum(np.linalg.norm(u, axis=-1), np.linalg.norm(v, axis=-1))


def _from_segment(points: Array, start: Array, end: Array) -> Array:
    """Return the distances (n, k) of points (n, k, 3) from segments (n, 3)."""
    way = end - start
    share = np.einsum("nki,ni->nk", points - start[:, None], way) / np.maximum((way**2).sum(1), SAME)[:, None]
    return np.asarray(np.linalg.norm(points - start[:, None] - np.clip(share, 0, 1)[..., None] * way[:, None], axis=2))
