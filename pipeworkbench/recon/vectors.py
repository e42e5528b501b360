# SPDX-License-Identifier: LGPL-2.1-or-later
"""Vectors and straight lines in space: what several steps need of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pipeworkbench.pipeline import Vector
from pipeworkbench.recon.camera import Array


def as_vector(array: Array) -> Vector:
    """Return an array (3,) as components hold it."""
    x, y, z = array.tolist()
    return x, y, z


def rounded(array: Array, digits: int) -> Vector:
    """Return an array (3,) as components hold it, with so many digits behind the point."""
    x, y, z = (round(float(value), digits) for value in array)
    return x, y, z


def unit(vector: Any) -> Array:
    """Return the unit vector of the same direction (n,)."""
    array = np.asarray(vector, float)
    return array / math.sqrt(array @ array)


def cross(one: Array, other: Array) -> Array:
    """Return the cross product of two vectors (3,): NumPy's is made for many at a time."""
    a, b, c = one.tolist()
    x, y, z = other.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def cross_matrices(vectors: Array) -> Array:
    """Return the matrices (..., 3, 3) whose product with another vector is the cross product with it."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    return np.stack([np.stack([zero, -z, y], -1), np.stack([z, zero, -x], -1), np.stack([-y, x, zero], -1)], -2)


def axes_across(direction: Array) -> tuple[Array, Array]:
    """Return two unit vectors (3,) that form a right-handed frame with a unit direction (3,): :func:`.cylinder.perpendicular_axes` for one."""
    x, y, z = direction.tolist()
    # the unit vector that is the furthest from it
    least = min(abs(x), abs(y), abs(z))
    helper = (1.0, 0.0, 0.0) if abs(x) == least else (0.0, 1.0, 0.0) if abs(y) == least else (0.0, 0.0, 1.0)
    first = cross(direction, np.array(helper))
    first /= math.sqrt(first @ first)
    return first, cross(direction, first)


def across(vectors: Array, direction: Array) -> Array:
    """Return the part of vectors (..., 3) at right angles to a unit direction (3,)."""
    return np.asarray(vectors - (vectors @ direction)[..., None] * direction)


def nearest_on_line(point: Array, start: Array, direction: Array) -> Array:
    """Return the point (3,) nearest to another on the line through ``start`` (3,) along a unit direction (3,), all in mm."""
    return np.asarray(start + ((point - start) @ direction) * direction)


def angle_between(one: Array, other: Array) -> float:
    """Return the angle between two directions (3,), 0 to pi rad; sharp for small angles too."""
    normal = cross(one, other)
    return math.atan2(math.sqrt(normal @ normal), one @ other)


def units(vectors: Array) -> Array:
    """Return the unit vectors of the same directions (..., 3)."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def dot(one: Array, other: Array) -> Array:
    """Return the products (n,) of vectors (n, 2) or (n, 3), one by one."""
    return np.asarray(np.einsum("ni,ni->n", one, other))
