# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which stations overlap, and how each is reached from the first over the pairs of stations that have most in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from pipeworkbench.recon.registration.hypotheses import Pairs
from pipeworkbench.recon.registration.poses import Pose


@dataclass(frozen=True, eq=False)
class Overlap:
    """How two stations lie to each other: the pose of the second in the first, what speaks for it, and the pairs it rests on."""

    pose: Pose
    score: float
    pairs: Pairs


def starting_poses(count: int, overlaps: Mapping[tuple[int, int], Overlap], root: int) -> tuple[Mapping[int, Pose], Sequence[tuple[int, int]]]:
    """Return the poses of all stations that are reached from the root, in its frame, and the overlaps they come from.

    The tree is the spanning tree with the largest sum of scores.

    Parameters
    ----------
    count : int
        Number of stations.
    overlaps : mapping
        From (a, b), a < b, to how b lies in a.
    root : int
        The row of the station whose frame is taken.
    """
    poses = {root: Pose.identity()}
    if not overlaps:
        return poses, ()
    a, b = np.array(list(overlaps)).T
    scores = np.array([overlap.score for overlap in overlaps.values()])
    # the tree's edges must not be zero, which would be none
    costs = 1.0 + scores.max() - scores
    tree = minimum_spanning_tree(coo_array((costs, (a, b)), shape=(count, count)))
    order, before = breadth_first_order(tree, root, directed=False)
    used = []
    for station in order[1:]:
        there = int(before[station])
        edge = (min(there, int(station)), max(there, int(station)))
        step = overlaps[edge].pose if edge[0] == there else overlaps[edge].pose.inverse
        poses[int(station)] = poses[there] @ step
        used.append(edge)
    return poses, used
