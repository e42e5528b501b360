# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a jacket's longitudinal seams lie: where no rain gets in, to either side of that from piece to piece.

Straight pieces have theirs at the underside. Gores have theirs at the throat, where they are the shortest and least seen, or at the
heel where the throat is at the top; the patterns move them to either side by turns.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable

import numpy as np

from pipeworkbench.insulation.connections import Connections
from pipeworkbench.recon.vectors import across
from pipeworkbench.solids.coverings import AnyCovering, BendCovering, BoxCovering, StopCovering
from pipeworkbench.solids.frames import SAME_DIRECTION, UP, Frame

TOP = math.sin(math.radians(30))  # of the slope upwards from which on a side is the top, where it rains


def underside(frame: Frame) -> float:
    """Return the angle (rad) about z of the direction that is the furthest down; 0 where z is vertical."""
    down = across(-np.array(UP), frame.z)
    if np.linalg.norm(down) <= SAME_DIRECTION:
        return 0.0
    return math.atan2(float(down @ frame.y), float(down @ frame.x))


def bend_seam(covering: BendCovering) -> float:
    """Return the angle (rad) of a bend's seams: 0 at the throat, half a turn at the heel where the throat looks up."""
    half, frame = covering.angle / 2, covering.frame
    # from the middle of the bend's axis to its centre
    throat = math.cos(half) * frame.x - math.sin(half) * frame.z
    return math.pi if float(throat @ np.array(UP)) > TOP else 0.0


def with_seams(coverings: Iterable[AnyCovering], connections: Connections) -> list[AnyCovering]:
    """Return coverings with their seams, straight ones half the stagger to one side and the other of the underside in turns along the pipework."""
    depths = _depths(connections)
    placed: list[AnyCovering] = []
    for covering in coverings:
        if isinstance(covering, BoxCovering | StopCovering):
            placed.append(covering)
            continue
        if isinstance(covering, BendCovering):
            placed.append(dataclasses.replace(covering, seam=bend_seam(covering)))
            continue
        stagger = math.radians(connections.treatments[covering.component].seams.stagger_deg) / 2
        sign = 1 if depths[covering.component] % 2 == 0 else -1
        placed.append(dataclasses.replace(covering, seam=underside(covering.frame) + sign * stagger))
    return placed


def _depths(connections: Connections) -> dict[str, int]:
    """Return how many components are between each and the first of its run, by the order of the pipeline."""
    neighbours: dict[str, list[str]] = {name: [] for name in connections.components}
    for (name, _), (other, _) in connections.partners.items():
        neighbours[name].append(other)
    depths: dict[str, int] = {}
    for first in connections.components:
        level = [] if first in depths else [first]
        depth = 0
        while level:
            depths |= dict.fromkeys(level, depth)
            level = [other for other in dict.fromkeys(o for name in level for o in neighbours[name]) if other not in depths]
            depth += 1
    return depths
