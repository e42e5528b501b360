# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses of stations: motions without a scale, and quaternions with their derivatives (Sect. 8.3).

A quaternion is (x, y, z, w). R(q) is taken without its norm, so that all four elements have derivatives; the norm is a condition.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import Matrix, Vector
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import cross_matrices, rounded


@dataclass(frozen=True, eq=False)
class Pose:
    """The motion x' = ``rotation`` (3, 3) x + ``translation`` (3,), mm."""

    rotation: Array
    translation: Array

    @classmethod
    def identity(cls) -> Pose:
        """Return the pose of what stays where it is."""
        return cls(np.eye(3), np.zeros(3))

    @classmethod
    def from_matrix(cls, matrix: Sequence[Sequence[float]] | Array) -> Pose:
        """Return the pose of a 4 x 4 matrix."""
        array = np.asarray(matrix, float)
        return cls(array[:3, :3], array[:3, 3])

    @classmethod
    def from_quaternion(cls, quaternion: Array, translation: Array) -> Pose:
        """Return the pose of a unit quaternion (4,) and a translation (3,)."""
        return cls(Rotation.from_quat(quaternion).as_matrix(), np.asarray(translation, float))

    @property
    def quaternion(self) -> Array:
        """The unit quaternion (4,)."""
        return np.asarray(Rotation.from_matrix(self.rotation).as_quat())

    @property
    def inverse(self) -> Pose:
        """The motion back."""
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.rotation @ other.rotation, self.rotation @ other.translation + self.translation)

    def points(self, points: Array) -> Array:
        """Return points (..., 3) after the motion."""
        return np.asarray(points @ self.rotation.T + self.translation)

    def sigmas(self, sigmas: Vector | None) -> Vector | None:
        """Return standard deviations along a frame's axes, mm, as they are along the new frame's; correlations are not known."""
        return None if sigmas is None else rounded(np.sqrt(self.rotation**2 @ np.square(sigmas)), 4)

    def matrix(self) -> Matrix:
        """Return the 4 x 4 matrix as files hold it."""
        rows = (*np.column_stack([self.rotation, self.translation]), np.array([0.0, 0.0, 0.0, 1.0]))
        return tuple((float(a), float(b), float(c), float(d)) for a, b, c, d in rows)

    def farthest(self, other: Pose, points: Array) -> float:
        """Return by how many mm at most points (n, 3) differ after this and another motion."""
        return float(np.linalg.norm(self.points(points) - other.points(points), axis=1).max(initial=0.0))


def headed(heading: float) -> Array:
    """Return the rotation (3, 3) about the vertical by an angle in rad."""
    return np.asarray(Rotation.from_euler("z", heading).as_matrix())


def rotated(quaternions: Array, points: Array) -> Array:
    """Return R(q) p (n, 3) = (w^2 - u.u) p + 2 (u.p) u + 2 w u x p for quaternions (n, 4) and points (n, 3)."""
    u, w = quaternions[:, :3], quaternions[:, 3:]
    return np.asarray((w**2 - (u * u).sum(1, keepdims=True)) * points + 2 * (u * points).sum(1, keepdims=True) * u + 2 * w * np.cross(u, points))


def rotated_by_quaternion(quaternions: Array, points: Array) -> Array:
    """Return the derivatives (n, 3, 4) of R(q) p with respect to the elements of q, the paper's dP/dq."""
    u, w = quaternions[:, :3], quaternions[:, 3, None, None]
    along = np.einsum("ni,ni->n", u, points)[:, None, None]
    by_vector = -2 * points[:, :, None] * u[:, None, :] + 2 * u[:, :, None] * points[:, None, :] + 2 * along * np.eye(3)
    by_vector -= 2 * w * cross_matrices(points)
    by_scalar = 2 * (w[:, :, 0] * points + np.cross(u, points))
    return np.concatenate([by_vector, by_scalar[:, :, None]], axis=2)


def conjugated(quaternions: Array) -> Array:
    """Return the quaternions (n, 4) of the inverse rotations."""
    return np.asarray(quaternions * np.array([-1.0, -1.0, -1.0, 1.0]))


def tangents(quaternions: Array) -> Array:
    """Return how quaternions (n, 4) change with a small rotation vector after them, (n, 4, 3): dq = (w, 0) q / 2."""
    u, w = quaternions[:, :3], quaternions[:, 3]
    upper = w[:, None, None] * np.eye(3) - cross_matrices(u)
    return np.concatenate([upper, -u[:, None, :]], axis=1) / 2
