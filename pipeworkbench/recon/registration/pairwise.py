# SPDX-License-Identifier: LGPL-2.1-or-later
"""How two stations lie to each other: by hand, by control points or by search, and why not where it cannot be said."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.registration.hypotheses import Pairs, alike
from pipeworkbench.recon.registration.landmarks import Landmarks
from pipeworkbench.recon.registration.overlaps import Overlap
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.pretransformation import from_points, pretransformation
from pipeworkbench.recon.registration.results import CandidatePose
from pipeworkbench.recon.registration.settings import SearchSettings
from pipeworkbench.recon.registration.stations import PLANT, Stations, are_the_same_photographs
from pipeworkbench.recon.registration.verification import Verified, verified_poses, verify

BY_HAND, BY_POINTS = 1000.0, 100.0  # scores of overlaps that are more certain than any found by search
CANDIDATES = 4  # of an ambiguous pose that are reported at most
SAME, AMBIGUOUS, PARALLEL, UNASSIGNED, NOTHING = range(5)  # why there is no overlap, the most telling reason first


@dataclass(frozen=True, eq=False)
class Answer:
    """The overlap of two stations, or else why there is none, in a sentence about the second, and how telling that reason is."""

    overlap: Overlap | None
    reason: str = ""
    rank: int = NOTHING
    candidates: tuple[CandidatePose, ...] = ()


def overlap_of(stations: Stations, a: int, b: int, settings: SearchSettings) -> Answer:
    """Return how station b lies to station a, a < b."""
    one, other = stations.landmarks[a], stations.landmarks[b]
    name, base = stations.names[b], stations.names[a]
    if (a, b) in stations.assigned or (a, b) in stations.chosen:
        return _given(stations, a, b, settings)
    points, targets = stations.point_arrays(a, b)
    pose = from_points(points, targets)
    if pose is not None:
        return Answer(Overlap(pose, BY_POINTS, verify(one, other, pose, settings).pairs if len(one) and len(other) else _none()))
    if PLANT in {name, base}:
        return Answer(None, f"{name} and {base}: fewer than three points in common that are not in line; measure more of them", UNASSIGNED)
    if are_the_same_photographs(one, other):
        return Answer(None, same_photographs(base, name), SAME)
    return _searched(one, other, (base, name), settings)


def same_photographs(base: str, name: str) -> str:
    """Return the sentence about a station that shows the same as another."""
    return f"{name} shows the same as {base}: these are the same photographs twice; leave one of them out"


def _given(stations: Stations, a: int, b: int, settings: SearchSettings) -> Answer:
    """Return the overlap that was chosen from candidates or follows from pairs assigned by hand."""
    one, other = stations.landmarks[a], stations.landmarks[b]
    assigned = stations.assigned.get((a, b), _none())
    pose = stations.chosen.get((a, b)) or pretransformation(one, other, assigned)
    if pose is None:
        what = f"{stations.names[b]} and {stations.names[a]}: the components assigned by hand do not fix how they lie to each other"
        return Answer(None, f"{what}; assign two pipes that are not parallel, or an elbow or a flange, too", UNASSIGNED)
    # a first approximation: what else it brings together makes it better
    verified = verify(one, other, pose, settings)
    if len(verified.pairs) > len(assigned):
        return Answer(Overlap(verified.pose, BY_HAND, assigned if len(assigned) else verified.pairs))
    return Answer(Overlap(pose, BY_HAND, assigned))


def _none() -> Pairs:
    return Pairs(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0))


def _searched(one: Landmarks, other: Landmarks, names: tuple[str, str], settings: SearchSettings) -> Answer:
    """Return the overlap that the search is certain of, or why it is not."""
    base, name = names
    pairs = alike(one, other, settings)
    if _only_parallel(one, pairs, settings):
        what = f"{name} has only parallel pipes in common with {base}: they may slide along each other"
        return Answer(None, f"{what}; add an elbow, a flange or a pipe across them to both stations", PARALLEL)
    found = verified_poses(one, other, settings)
    if not found or not _is_enough(found[0], settings):
        what = f"{name} has no components in common with {base} that are enough to put them together"
        return Answer(None, f"{what}; photograph so that three components or more, not all parallel, are in both, or assign them by hand", NOTHING)
    margin = max(settings.margin, settings.margin_share * found[0].score)
    rivals = [verified for verified in found if verified.score > found[0].score - margin]
    if len(rivals) > 1:
        candidates = tuple(CandidatePose(base, name, v.pose.matrix(), round(v.score, 2), len(v.pairs)) for v in rivals[:CANDIDATES])
        what = f"{name} fits {base} at {len(rivals)} different places nearly as well, as repeating or mirror-like pipework does"
        return Answer(None, f"{what}; assign one component that is not repeated by hand, or choose one of the candidates", AMBIGUOUS, candidates)
    return Answer(Overlap(found[0].pose, found[0].score, found[0].pairs))


def _is_enough(verified: Verified, settings: SearchSettings) -> bool:
    """Tell whether a pose explains more than chance would; the fewer of all components it explains, the more chances there were."""
    missing = 1 - min(verified.share / settings.least_share, 1.0)
    asked = settings.least_score + (settings.certain_score - settings.least_score) * missing
    return len(verified.pairs) >= settings.least_pairs and verified.score >= asked


def _only_parallel(one: Landmarks, pairs: Pairs, settings: SearchSettings) -> bool:
    """Tell whether what could be common are pipes alone whose axes are all parallel."""
    if not len(pairs) or not one.is_axis[pairs.first].all():
        return False
    axes = one.axis[np.unique(pairs.first)]
    return bool((np.abs(axes @ axes.T) >= np.cos(np.radians(settings.crossing_deg))).all())


def is_in_contradiction(overlap: Overlap, pose: Pose, other: Landmarks, settings: SearchSettings) -> bool:
    """Tell whether an overlap's pose puts what it has in common elsewhere than another pose does."""
    points = other.point[overlap.pairs.second] if len(overlap.pairs) else other.point
    return overlap.pose.farthest(pose, points) > settings.distinct
