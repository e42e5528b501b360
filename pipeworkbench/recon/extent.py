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
    of weld-neck flanges is not (brackets do not grow with the pipe as flanges do); gaps from ``least_gap`` on are
    reported; ``window`` is the stretch over which the evidence must hold on both sides in ``evidence`` of its
    samples of one image. Before a background of like brightness one edge is faint in all images: where the
    other one holds in ``clear`` of the samples of two images, ``faint`` of all images' samples will do for it.
    """

    reach: float = 1.25
    bridge: float = 1.05
    bridge_mm: float = 70.0
    least_gap: float = 0.4
    window: float = 0.3
    evidence: float = 0.6
    clear: float = 0.8
    faint: float = 0.15
    sample: float = 0.04
    longest: float = 12000.0  # mm to either side of what is known


@dataclass(frozen=True, eq=False)
class Extent:
    """From where to where a pipe reaches, in mm along its axis; ``gaps`` (m, 2) are what was bridged in between."""

    start: float
    end: float
    gaps: Array

    @property
    def both(self) -> tuple[float, float]:
        """Start and end."""
        return self.start, self.end


def extent_of(views: Sequence[View], cylinder: Cylinder, known: tuple[float, float], settings: ExtentSettings) -> Extent:
    """Return from where to where the cylinder's edges are seen, and where in between they are not.

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
    seen = _both_edges_seen(views, cylinder, along, settings)
    trusted = seen | ((along >= known[0]) & (along <= known[1]))
    inside = int(np.argmin(np.abs(along - (known[0] + known[1]) / 2)))
    longest = round(min(settings.bridge * diameter, settings.bridge_mm) / step)
    first = inside - _end_of_run(trusted[: inside + 1][::-1], longest)
    last = inside + _end_of_run(trusted[inside:], longest)
    start, end = min(float(along[first]), known[0]), max(float(along[last]), known[1])
    return Extent(start, end, _gaps(along, seen, (start, end), settings.least_gap * diameter))


def _gaps(along: Array, seen: NDArray[np.bool_], extent: tuple[float, float], least: float) -> Array:
    """Return the stretches (m, 2) of at least a length, in mm along the axis, without evidence inside an extent."""
    places = np.concatenate([extent[:1], along[seen & (along >= extent[0]) & (along <= extent[1])], extent[1:]])
    wide = np.flatnonzero(np.diff(places) >= least)
    return np.column_stack([places[wide], places[wide + 1]])


def _both_edges_seen(views: Sequence[View], cylinder: Cylinder, along: Array, settings: ExtentSettings) -> NDArray[np.bool_]:
    """Return where (n,) the images show both edges in most samples of the surrounding window."""
    window = max(3, round(settings.window / settings.sample))
    kernel = np.ones(window) / window
    found = np.array([_edges_found(view, cylinder, along, settings.reach) for view in views])
    shares = np.array([[np.convolve(side, kernel, mode="same") for side in image] for image in found.astype(float)])
    seen = ((shares >= settings.evidence).all(axis=1) & found.any(axis=1)).any(axis=0)
    if len(views) > 1:
        in_two = np.sort(shares, axis=0)[-2] >= settings.clear
        some = shares.mean(axis=0) >= settings.faint
        seen |= ((in_two[0] & some[1]) | (in_two[1] & some[0])) & found.any(axis=(0, 1))
    return np.asarray(seen)


def _edges_found(view: View, cylinder: Cylinder, along: Array, reach: float) -> NDArray[np.bool_]:
    """Return which samples (2, n) of both edges have an image edge."""
    depth = (cylinder.point + along[:, None] * cylinder.direction - view.camera.projection_centre) @ view.camera.rotation[2]
    ahead = depth > 2 * cylinder.radius
    result = np.zeros((2, len(along)), bool)
    if np.count_nonzero(ahead) >= 2:
        position, normal = outlines(view.camera, cylinder.as_many(), along[None, ahead])
        result[:, ahead] = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), reach).found.reshape(2, -1)
    return result


def _end_of_run(seen: NDArray[np.bool_], gap: int) -> int:
    """Return the index of the last True before the first run of more than ``gap`` False."""
    places = np.flatnonzero(seen)
    wide = np.flatnonzero(np.diff(places) > gap)
    return int(places[wide[0]] if len(wide) else places[-1])
