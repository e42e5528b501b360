# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a pipe reaches: from where to where its edges are seen, merged over all images."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class ExtentSettings:
    """Tunables; ``reach`` in px is how near an edge must be, lengths are in outside diameters or in mm.

    A gap longer than ``bridge`` or ``bridge_mm`` ends the pipe, so that a bracket is bridged and a pair
    of weld-neck flanges is not (brackets do not grow with the pipe as flanges do); ``window`` is the
    stretch over which the evidence must hold on both sides in ``evidence`` of its samples.
    """

    reach: float = 1.5
    bridge: float = 1.05
    bridge_mm: float = 70.0
    window: float = 0.3
    evidence: float = 0.6
    sample: float = 0.04
    longest: float = 12000.0  # mm to either side of what is known


def extent_of(views: Sequence[View], cylinder: Cylinder, known: tuple[float, float], settings: ExtentSettings) -> tuple[float, float]:
    """Return from where to where, along the axis in mm, the cylinder's edges are seen.

    Parameters
    ----------
    views : sequence of View
    cylinder : Cylinder
    known : (float, float)
        The part, along the axis from ``cylinder.point``, that is known to be the pipe.
    settings : ExtentSettings
    """
    diameter = 2 * cylinder.radius
    step = settings.sample * diameter
    reach = min(settings.longest, 60 * diameter)
    along = np.arange(known[0] - reach, known[1] + reach, step)
    window = max(3, round(settings.window / settings.sample))
    seen = np.zeros(len(along), bool)
    for view in views:
        seen |= _both_edges_seen(view, cylinder, along, window, settings)
    seen |= (along >= known[0]) & (along <= known[1])
    inside = int(np.argmin(np.abs(along - (known[0] + known[1]) / 2)))
    gap = round(min(settings.bridge * diameter, settings.bridge_mm) / step)
    first = along[inside - _end_of_run(seen[: inside + 1][::-1], gap)]
    last = along[inside + _end_of_run(seen[inside:], gap)]
    return min(float(first), known[0]), max(float(last), known[1])


def _both_edges_seen(view: View, cylinder: Cylinder, along: Array, window: int, settings: ExtentSettings) -> NDArray[np.bool_]:
    """Return where (n,) both edges have image edges in most samples of the surrounding window."""
    depth = (cylinder.point + along[:, None] * cylinder.direction - view.camera.projection_centre) @ view.camera.rotation[2]
    ahead = depth > 2 * cylinder.radius
    result = np.zeros(len(along), bool)
    if np.count_nonzero(ahead) < 2:
        return result
    position, normal = outlines(view.camera, cylinder.as_many(), along[None, ahead])
    found = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), settings.reach).found.reshape(2, -1)
    kernel = np.ones(window) / window
    share = np.array([np.convolve(side, kernel, mode="same") for side in found.astype(float)])
    result[ahead] = (found.any(axis=0)) & (share >= settings.evidence).all(axis=0)
    return result


def _end_of_run(seen: NDArray[np.bool_], gap: int) -> int:
    """Return the index of the last True before the first run of more than ``gap`` False."""
    places = np.flatnonzero(seen)
    wide = np.flatnonzero(np.diff(places) > gap)
    return int(places[wide[0]] if len(wide) else places[-1])
