# SPDX-License-Identifier: LGPL-2.1-or-later
"""One adjustment of the poses of all stations over all pairs of corresponding components (Sect. 8.3).

Unknowns are a quaternion and a translation per station, the scale is fixed; the norm of each quaternion is a condition that borders
the normal equations. Pairs that do not fit lose their weight: Huber's at first, then Tukey's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.observations import Observations, distances, jacobians, residuals
from pipeworkbench.recon.registration.poses import Pose, rotated, rotated_by_quaternion, tangents
from pipeworkbench.recon.registration.settings import NetworkSettings

HUBER_ITERATIONS = 5
MEDIAN_OF_SQUARES = 0.82  # of chi squared over its degrees of freedom, for three and four of them
LEAST_SCALE = 0.3  # of the normalised distances: few pairs fit by chance
WEAK = 1e-9  # information per mm^2 or rad^2 so small that it only keeps the equations regular


@dataclass(frozen=True, eq=False)
class NetworkSolution:
    """The adjusted poses of s stations and how well they are known.

    covariance (s, 6, 6): small rotation (rad) about the frame's axes after the pose's own, translation (mm), zero for the fixed station;
    distances (m, 2) mm, normalised (m,) and weights (m,) per pair; sigma0 of unit weight; redundancy.
    """

    poses: tuple[Pose, ...]
    covariance: Array
    distances: Array
    normalised: Array
    weights: Array
    sigma0: float
    redundancy: int
    iterations: int
    converged: bool

    def sigma_at(self, station: int, point: Array) -> tuple[Array, Array]:
        """Return standard deviations (3,) mm of a point (3,) of a station in the frame, and (3,) rad of the rotation."""
        x, y, z = self.poses[station].rotation @ point
        by_pose = np.hstack([np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]]), np.eye(3)])
        covariance = by_pose @ self.covariance[station] @ by_pose.T
        return np.sqrt(np.maximum(np.diag(covariance), 0)), np.sqrt(np.maximum(np.diag(self.covariance[station])[:3], 0))


def adjust_network(
    observations: Observations,
    poses: Sequence[Pose],
    fixed: int,
    settings: NetworkSettings | None = None,
    middles: Array | None = None,
    level: NDArray[np.bool_] | None = None,
) -> NetworkSolution:
    """Adjust the poses of all stations at once.

    Parameters
    ----------
    observations : Observations
    poses : sequence of Pose
        Starting values of s stations.
    fixed : int
        The row of the station that stays.
    settings : NetworkSettings, optional
    middles : (s, 3) array, optional
        A point among each station's components, mm: where the step that ends the iteration is measured.
    level : (s,) array, optional
        Which stations' inclination sensors are observed, if the settings say how well; all by default.
    """
    settings = settings or NetworkSettings()
    quaternions = np.array([pose.quaternion for pose in poses])
    translations = np.array([pose.translation for pose in poses])
    middles = np.zeros_like(translations) if middles is None else middles
    tilt = np.zeros(len(poses))
    if settings.tilt_deg is not None:
        tilt[slice(None) if level is None else level] = np.radians(settings.tilt_deg) ** -2.0 / 2
    free = np.flatnonzero(np.arange(len(poses)) != fixed)
    weights, converged, iteration = np.array(observations.share), not len(free), 0
    normal = np.zeros((7 * len(poses), 7 * len(poses)))
    for iteration in range(1, settings.iterations + 1 if len(free) else 1):
        now = residuals(observations, quaternions, translations)
        weights = _weights(now, observations, settings, huber=iteration <= HUBER_ITERATIONS)
        normal, right = _normal_equations(observations, quaternions, translations, now, weights, tilt)
        step = _bordered(normal, right, quaternions, free)
        before = rotated(quaternions, middles) + translations
        quaternions = quaternions + step[:, :4]
        quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
        translations = translations + step[:, 4:]
        moved = np.linalg.norm(rotated(quaternions, middles) + translations - before, axis=1).max()
        if moved < settings.step and iteration > HUBER_ITERATIONS:
            converged = True
            break
    now = residuals(observations, quaternions, translations)
    weighted = float((weights[:, None] * now**2).sum())
    redundancy = int(observations.counts[weights > 0].sum()) - 6 * len(free)
    sigma0 = float(np.sqrt(weighted / redundancy)) if redundancy > 0 else 1.0
    covariance = _covariance(normal, quaternions, free) * max(1.0, sigma0) ** 2
    return NetworkSolution(
        tuple(Pose.from_quaternion(*pose) for pose in zip(quaternions, translations, strict=True)),
        covariance,
        distances(observations, quaternions, translations),
        np.sqrt((now**2).sum(1) / observations.counts),
        weights,
        sigma0,
        redundancy,
        iteration,
        converged,
    )


def _weights(now: Array, observations: Observations, settings: NetworkSettings, *, huber: bool) -> Array:
    """Return robust weights (m,) from the normalised distances of pairs; their scale comes from all of them."""
    distance = np.sqrt((now**2).sum(1) / observations.counts)
    counted = distance[observations.share > 0]
    if not len(counted):
        return observations.share
    scale = max(float(np.sqrt(np.median(counted**2) / MEDIAN_OF_SQUARES)), LEAST_SCALE)
    ratio = distance / scale
    if huber:
        return np.asarray(observations.share * np.minimum(1.0, settings.huber / np.maximum(ratio, 1e-12)))
    return np.asarray(observations.share * np.maximum(1 - (ratio / settings.tukey) ** 2, 0) ** 2)


def _normal_equations(
    observations: Observations, quaternions: Array, translations: Array, now: Array, weights: Array, tilt: Array
) -> tuple[Array, Array]:
    """Return the normal matrix (7 s, 7 s) and the right-hand side (7 s,); ``tilt`` (s,) is the weight of the inclinations, rad^-2."""
    count = len(quaternions)
    normal, right = np.zeros((count, count, 7, 7)), np.zeros((count, 7))
    sides = list(zip(observations.stations.T, jacobians(observations, quaternions, translations), strict=True))
    for row, jacobian in sides:
        np.add.at(right, row, -np.einsum("mck,mc,m->mk", jacobian, now, weights))
        for column, other in sides:
            np.add.at(normal, (row, column), np.einsum("mck,mcl,m->mkl", jacobian, other, weights))
    # the vertical of each station, as its inclination sensor gives it, is the frame's
    up = np.broadcast_to([0.0, 0.0, 1.0], (count, 3))
    by_quaternion = rotated_by_quaternion(quaternions, up)[:, :2]
    stations = np.arange(count)
    normal[stations, stations, :4, :4] += np.einsum("sck,scl,s->skl", by_quaternion, by_quaternion, tilt)
    right[:, :4] -= np.einsum("sck,sc,s->sk", by_quaternion, rotated(quaternions, up)[:, :2], tilt)
    return normal.transpose(0, 2, 1, 3).reshape(7 * count, 7 * count), right.ravel()


def _columns(free: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the rows of the free stations' unknowns among all."""
    return np.ravel(7 * free[:, None] + np.arange(7))


def _bordered(normal: Array, right: Array, quaternions: Array, free: NDArray[np.intp]) -> Array:
    """Solve for the step (s, 7) under the linearised condition q.dq = (1 - q.q) / 2 of each free station."""
    columns, count = _columns(free), len(free)
    condition = np.zeros((count, 7 * count))
    for number, station in enumerate(free):
        condition[number, 7 * number : 7 * number + 4] = quaternions[station]
    # condition and normal matrix of the same size keep the system well scaled
    scale = max(float(np.diag(normal).max()), 1.0)
    matrix = np.block(
        [[normal[np.ix_(columns, columns)] + WEAK * np.eye(7 * count), scale * condition.T], [scale * condition, np.zeros((count, count))]]
    )
    misfit = scale * (1 - (quaternions[free] ** 2).sum(1)) / 2
    solution = np.linalg.solve(matrix, np.concatenate([right[columns], misfit]))
    step = np.zeros(7 * len(quaternions))
    step[columns] = solution[: 7 * count]
    return step.reshape(-1, 7)


def _covariance(normal: Array, quaternions: Array, free: NDArray[np.intp]) -> Array:
    """Return the covariances (s, 6, 6) of small rotations and translations: the bordered system's, on the quaternions' unit sphere."""
    covariance = np.zeros((len(quaternions), 6, 6))
    if not len(free):
        return covariance
    columns, count = _columns(free), len(free)
    onto = np.zeros((7 * count, 6 * count))
    for number, tangent in enumerate(tangents(quaternions[free])):
        onto[7 * number : 7 * number + 4, 6 * number : 6 * number + 3] = tangent
        onto[7 * number + 4 : 7 * number + 7, 6 * number + 3 : 6 * number + 6] = np.eye(3)
    information = onto.T @ normal[np.ix_(columns, columns)] @ onto + WEAK * np.eye(6 * count)
    whole = np.linalg.inv(information).reshape(count, 6, count, 6)
    covariance[free] = whole[np.arange(count), :, np.arange(count)]
    return covariance
