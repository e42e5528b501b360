# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hypotheses are adjusted to all the pairs they explain, all at once, and scored by what they explain and contradict (Sect. 8.1, step 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.comparison import (
    LEAST_COURSE_MM,
    Comparison,
    coarse_scores,
    compared,
    contradictions,
    least_of,
    nearest,
)
from pipeworkbench.recon.registration.hypotheses import Hypotheses, Pairs, alike, hypotheses_of
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.settings import SearchSettings
from pipeworkbench.recon.vectors import cross_matrices

PRIOR_DEG, PRIOR_MM = 1.0, 100.0  # how far a hypothesis may be off: keeps what its pairs do not determine where it is
WHOLE_BONUS = 0.5  # for a pipe whose joints on both sides coincide: they fix what its axis leaves open
HELD_APART = 0.5  # against a pose, for a pipe whose joints do not coincide
CROSSED = 1.0  # against a pose, for two pipes that would lie in each other
SAME_MM = 30.0  # poses nearer to each other than this are one before they are adjusted


@dataclass(frozen=True, eq=False)
class Verified:
    """A pose of a second station in the first one's frame and what it explains.

    score: the weights of the components explained, less what contradicts; share: the part of the smaller station's
    components that is explained; pairs: of landmarks, each of an axis or anchor and its counterpart.
    """

    pose: Pose
    score: float
    share: float
    pairs: Pairs


def verified_poses(one: Landmarks, other: Landmarks, settings: SearchSettings) -> list[Verified]:
    """Return the different poses that explain most, best first.

    Parameters
    ----------
    one, other : Landmarks
        Of both stations, in their level frames.
    settings : SearchSettings
    """
    pairs = alike(one, other, settings)
    gathered = []
    for _, poses, agree in hypotheses_of(one, other, pairs, settings):
        gathered.append((coarse_scores(one, other, agree, poses, settings), poses))
    if not gathered:
        return []
    scores = np.concatenate([score for score, _ in gathered])
    poses = Hypotheses(
        np.concatenate([found.rotation for _, found in gathered]),
        np.concatenate([found.translation for _, found in gathered]),
    )
    best = _different(poses, np.argsort(-scores, kind="stable"), other.middle, settings.refined)
    refined = _refined(one, other, pairs, poses[best], settings)
    return distinct_poses(_scored(one, other, pairs, refined, settings), other, settings)


def verify(one: Landmarks, other: Landmarks, pose: Pose, settings: SearchSettings) -> Verified:
    """Return what a pose that is known approximately explains, after it was adjusted to it."""
    pairs = alike(one, other, settings)
    start = Hypotheses(pose.rotation[None], pose.translation[None])
    return _scored(one, other, pairs, _refined(one, other, pairs, start, settings), settings)[0]


def explained_pairs(one: Landmarks, other: Landmarks, pose: Pose, settings: SearchSettings) -> Pairs:
    """Return the pairs of landmarks that coincide at a pose as it is."""
    pairs = alike(one, other, settings)
    poses = Hypotheses(pose.rotation[None], pose.translation[None])
    explained, _ = _explained(one, other, pairs, poses, settings)
    return pairs[np.sort(explained.pair)]


def distinct_poses(found: list[Verified], other: Landmarks, settings: SearchSettings) -> list[Verified]:
    """Return poses, best first, without those that are nearly the same as a better one."""
    ranked = sorted(found, key=lambda verified: -verified.score)
    places = np.array([verified.pose.points(other.point) for verified in ranked])
    kept: list[int] = []
    for row in range(len(ranked)):
        if (np.linalg.norm(places[kept] - places[row], axis=2).max(1, initial=0.0) > settings.distinct).all():
            kept.append(row)
    return [ranked[row] for row in kept]


def _different(poses: Hypotheses, order: NDArray[np.intp], middle: Array, most: int) -> NDArray[np.intp]:
    """Return the first rows of an order whose poses, at the middle of the components, are apart or turned otherwise."""
    places = np.einsum("hab,b->ha", poses.rotation, middle) + poses.translation
    kept: list[int] = []
    for row in order:
        near = np.linalg.norm(places[kept] - places[row], axis=1) < SAME_MM
        alike_turned = np.einsum("hab,ab->h", poses.rotation[kept], poses.rotation[row]) > 1 + 2 * np.cos(np.radians(PRIOR_DEG))
        if not (near & alike_turned).any():
            kept.append(int(row))
        if len(kept) == most:
            break
    return np.array(kept, np.intp)


def _refined(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses, settings: SearchSettings) -> Hypotheses:
    """Return poses adjusted to what they explain, within tolerances that shrink: normal equations of all poses at once."""
    middle = other.middle
    prior = np.diag([np.radians(PRIOR_DEG) ** -2.0] * 3 + [PRIOR_MM**-2.0] * 3)
    for tolerance in settings.ranges:
        now = compared(one, other, pairs, poses, settings)
        now = now[(now.distance <= tolerance) & (now.course > LEAST_COURSE_MM) & now.agrees]
        now = now[nearest(one, pairs, now, len(poses), len(other))]
        h, axis = now.pose, one.axis[pairs.first[now.pair]] * one.is_axis[pairs.first[now.pair], None]
        centre = np.einsum("hab,b->ha", poses.rotation, middle) + poses.translation
        # how a point moves with a turn about the middle and a shift, as far as its pair notices
        by_turn = -cross_matrices(now.points - centre[h, None])
        notice = np.eye(3) - axis[:, :, None] * axis[:, None, :]
        jacobian = notice[:, None] @ np.concatenate([by_turn, np.broadcast_to(np.eye(3), by_turn.shape)], axis=3)
        weight = now.sigma**-2.0 / 2
        flat = jacobian.reshape(-1, 6, 6)
        normal = flat.transpose(0, 2, 1) @ (weight[:, None, None] * flat)
        right = -np.einsum("mvc,mv,m->mc", flat, now.off.reshape(-1, 6), weight)
        normals, rights = np.zeros((len(poses), 6, 6)), np.zeros((len(poses), 6))
        np.add.at(normals, h, normal)
        np.add.at(rights, h, right)
        step = np.linalg.solve(normals + prior, rights[..., None])[..., 0]
        turn = Rotation.from_rotvec(step[:, :3]).as_matrix()
        rotation = turn @ poses.rotation
        poses = Hypotheses(rotation, centre + step[:, 3:] - np.einsum("hab,b->ha", rotation, middle))
    return poses


def _explained(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses, settings: SearchSettings) -> tuple[Comparison, Array]:
    """Return which combinations of poses and pairs coincide, and their squared distances as parts of what is tolerated."""
    now = compared(one, other, pairs, poses, settings)
    now = now[(now.distance <= _tolerance(now, settings)) & (now.course > LEAST_COURSE_MM) & now.agrees]
    now = now[nearest(one, pairs, now, len(poses), len(other))]
    return now, (now.distance / _tolerance(now, settings)) ** 2


def _tolerance(now: Comparison, settings: SearchSettings) -> Array:
    return np.minimum(settings.sigmas * now.sigma, settings.most_mm)


def _scored(one: Landmarks, other: Landmarks, pairs: Pairs, poses: Hypotheses, settings: SearchSettings) -> list[Verified]:
    now, square = _explained(one, other, pairs, poses, settings)
    i, j = pairs.first[now.pair], pairs.second[now.pair]
    whole, apart = _ends(one, other, now, pairs, poses, settings)
    gain = one.weight[i] * (1 - square) + WHOLE_BONUS * whole - HELD_APART * apart
    sums = []
    for rows, count in ((i, len(one)), (j, len(other))):
        best = -least_of(-gain, now.pose, rows, (len(poses), count))
        sums.append(np.where(np.isfinite(best), best, 0.0).sum(1))
    scores = (sums[0] + sums[1]) / 2 - CROSSED * contradictions(one, other, poses)
    found = []
    for row, score in enumerate(scores):
        explained = pairs[np.sort(now.pair[now.pose == row])]
        found.append(Verified(Pose(poses.rotation[row], poses.translation[row]), float(score), _share(one, other, explained), explained))
    return found


def _ends(
    one: Landmarks, other: Landmarks, now: Comparison, pairs: Pairs, poses: Hypotheses, settings: SearchSettings
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return for which combinations (m,) of pipes the joints on both sides coincide, and for which joints on one side are apart."""
    i, j, h = pairs.first[now.pair], pairs.second[now.pair], now.pose
    ends = other.ends[j] @ poses.rotation[h].transpose(0, 2, 1) + poses.translation[h][:, None]
    along = np.einsum("msa,ma->ms", ends - one.point[i][:, None], one.axis[i])
    turned = along[:, :1] > along[:, 1:]
    along = np.where(turned, along[:, ::-1], along)
    held = np.where(turned, other.held[j][:, ::-1], other.held[j]) & one.held[i]
    off = np.abs(along - np.stack([-one.half[i], one.half[i]], 1)) > settings.most_mm
    line = one.is_axis[i]
    return (held & ~off).all(1) & line, (held & off).any(1) & line


def _share(one: Landmarks, other: Landmarks, pairs: Pairs) -> float:
    """Return which part of the smaller station's landmarks is explained."""
    return max(len(np.unique(rows)) / max(len(marks), 1) for rows, marks in ((pairs.first, one), (pairs.second, other)))
