# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders moved nearer, further or tilted: whether the images speak for them where they are or for a place beside.

In the picked image a moved cylinder looks as before; in the others its edges lie elsewhere, where they may meet
another row of edges.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, Cylinders, joined
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import Weights, clicked_extents, weights_of

MOVES_PX, TILTS_PX = np.linspace(-3.9, 3.9, 7), np.linspace(-1.3, 1.3, 3)  # of a cylinder's middle and of its ends against it
RIVAL_MOVES, RIVAL_TILTS_PX = np.array([-4.0, -3, -2, -1, 1, 2, 3, 4]), np.linspace(-2, 2, 5)  # the same, of which the first in steps
LEAST_GAIN = 2.0  # logarithm; what a move must gain, for settled cylinders are where their edges are


def best_moved(
    views: Sequence[View],
    pick: PipePick,
    tangents: PipeTangents,
    cylinders: Cylinders,
    extents: Array,
    series: Array,
    settings: PickSettings,
) -> tuple[Cylinders, Weights]:
    """Return each cylinder as it is or, where that is clearly more likely, a little nearer, further or tilted.

    Edges draw a contour to the nearest row only, which may be a joint of a wall: the moves find the row
    with which the texture fits too.
    """
    variants, spans = _with_moved(views, pick, cylinders, extents, MOVES_PX, TILTS_PX)
    count = len(variants) // len(cylinders)
    weights = weights_of(views, pick, tangents, variants, np.tile(series, count), settings, spans)
    total = weights.total.reshape(count, -1)
    total[0] += LEAST_GAIN
    best = total.argmax(axis=0) * len(cylinders) + np.arange(len(cylinders))
    return variants[best], weights[best]


def lead_over_neighbours(views: Sequence[View], pick: PipePick, tangents: PipeTangents, cylinder: Cylinder, settings: PickSettings) -> float:
    """Return by how much a cylinder's score exceeds the best of itself moved by ``certain_within`` and more, nearer or further.

    Where a limb is hidden, mirrors its surroundings or has no contrast, edges still draw a cylinder to
    some place with a small standard deviation; how much better that place fits than those around it tells whether it is the pipe's.
    """
    camera = views[pick.camera].camera
    origin, pixels_per_radian = camera.projection_centre, camera.interior.pixels_per_radian
    own = cylinder.as_many()
    extents = clicked_extents(own, origin, tangents)
    distance = float(np.linalg.norm(cylinder.at(float(extents.mean())) - origin))
    # less than a pixel of parallax does not show
    step = max(settings.certain_within / distance**2 * longest_base(views, origin) * pixels_per_radian, 1.0)
    variants, spans = _with_moved(views, pick, own, extents, step * RIVAL_MOVES, RIVAL_TILTS_PX)
    total = weights_of(views, pick, tangents, variants, 1.0, settings, spans).total
    return float(total[0] - total[1:].max())


def _with_moved(views: Sequence[View], pick: PipePick, cylinders: Cylinders, extents: Array, moves: Array, tilts: Array) -> tuple[Cylinders, Array]:
    """Return the cylinders, then all of them moved and tilted in every way, and what is compared of each (rows, 2), mm along the axes.

    Their ends move along the rays from the picked camera: in its image they stay where they are; in the others
    they move by ``moves`` and turn by ``tilts``, px at the longest base. All of the first move come first.
    """
    camera = views[pick.camera].camera
    origin, pixels_per_radian = camera.projection_centre, camera.interior.pixels_per_radian
    base = longest_base(views, origin)
    middle, tilt = (x.ravel() for x in np.meshgrid(moves, tilts))
    ends = []
    for end, sign in ((0, -1.0), (1, 1.0)):
        towards = cylinders.at(extents[:, end]) - origin
        # parallax is inverse to the distance
        nearer = (middle + sign * tilt)[:, None] / (pixels_per_radian * base) * np.linalg.norm(towards, axis=1)
        ends.append((origin + towards / (1 + nearer)[..., None]).reshape(-1, 3))
    directions = ends[1] - ends[0]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    moved = Cylinders((ends[0] + ends[1]) / 2, directions, np.tile(cylinders.radii, len(middle)))
    # moved ones have their points in the middle of what is compared
    half = np.tile(np.diff(extents, axis=1)[:, 0] / 2, len(middle))
    return joined([cylinders, moved]), np.concatenate([extents, np.stack([-half, half], axis=1)])


def longest_base(views: Sequence[View], origin: Array) -> float:
    """Return the distance of the camera furthest from ``origin`` (3,), mm."""
    return max(float(np.linalg.norm(view.camera.projection_centre - origin)) for view in views)
