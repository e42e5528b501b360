# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lines that flanges sit on: axes of pipes with their continuations, and where on them a clicked rim can lie."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.flange_settings import FlangeSettings
from pipeworkbench.recon.rim_profile import distance_from_curves, near_halves
from pipeworkbench.recon.vectors import across, unit
from pipeworkbench.recon.views import View

SAME_DIAMETER_MM = 0.5


@dataclass(frozen=True, eq=False)
class FlangeAxis:
    """A line that flanges sit on: a ``pipe``'s axis, and the ``spans`` (m, 2) mm along it that it and its continuations cover."""

    pipe: Pipe
    cylinder: Cylinder
    spans: Array
    same: tuple[str, ...]

    def beyond(self, along: Array) -> Array:
        """Return how far (mm) places (n,) lie outside the nearest span."""
        return np.asarray(np.maximum(np.maximum(self.spans[:, 0] - along[:, None], along[:, None] - self.spans[:, 1]), 0).min(axis=1))

    def coverage(self, one: Array, other: Array) -> Array:
        """Return which part (n,) of the stretches between places (n,) and (n,) the pipes cover."""
        low, high = np.minimum(one, other)[:, None], np.maximum(one, other)[:, None]
        covered = np.clip(np.minimum(high, self.spans[:, 1]) - np.maximum(low, self.spans[:, 0]), 0, None).sum(axis=1)
        return np.minimum(covered / (high - low)[:, 0], 1.0)


def axes_of(pipes: Sequence[Pipe], settings: FlangeSettings) -> tuple[FlangeAxis, ...]:
    """Return the axis of each pipe with the spans of all pipes in the same line."""
    found = []
    for pipe in pipes:
        start, end = np.array(pipe.start), np.array(pipe.end)
        direction = unit(end - start)
        spans, same = [], []
        for other in pipes:
            offsets = np.array([other.start, other.end]) - start
            off = across(offsets, direction)
            turned = abs(direction @ (np.array(other.end) - other.start)) / other.length
            if (
                abs(other.outer_diameter - pipe.outer_diameter) < SAME_DIAMETER_MM
                and turned > np.cos(np.radians(settings.collinear_deg))
                and np.linalg.norm(off, axis=1).min() < settings.collinear_mm
            ):
                spans.append(np.sort(offsets @ direction))
                same.append(other.id)
        found.append(FlangeAxis(pipe, Cylinder(start, direction, pipe.outer_diameter / 2), np.array(spans), tuple(same)))
    return tuple(found)


def occluders_of(axis: FlangeAxis, components: Iterable[AnyComponent], views: Sequence[View], place: Array, radius: float) -> list[AnyComponent]:
    """Return what may hide a flange of a ``radius`` at a place (3,): components other than the line's own that a line of sight passes near."""
    near: list[AnyComponent] = []
    for component in components:
        if not isinstance(component, Pipe) or component.id in axis.same:
            continue
        ends = np.array([component.start, component.end])
        if any(_gap(view.camera.projection_centre, place, *ends) < radius + component.outer_diameter / 2 + 10.0 for view in views):
            near.append(component)
    return near


def _gap(a: Array, b: Array, c: Array, d: Array) -> float:
    """Return the smallest distance of two segments, each sampled."""
    part = np.linspace(0, 1, 41)[:, None]
    return float(np.linalg.norm((a + part * (b - a))[:, None] - (c + part * (d - c))[None], axis=2).min())


def places_near_click(view: View, axis: FlangeAxis, diameters: Array, click: Array, settings: FlangeSettings) -> tuple[float, float] | None:
    """Return between which places along an axis a rim can lie whose image passes the click, None where none can."""
    (ray,) = view.camera.rays(click[None])
    cylinder = axis.cylinder
    cosine = float(abs(ray @ cylinder.direction))
    sine = float(np.sqrt(max(1 - cosine**2, 1e-6)))
    nearest = float(cylinder.as_many().nearest_to_ray(view.camera.projection_centre, ray)[0])
    half = min((diameters.max() / 2 * cosine + 3 * settings.off_axis) / sine + 50.0, 1500.0)
    along = np.linspace(nearest - half, nearest + half, 300)
    halves = near_halves(view.camera, cylinder, diameters / 2, along, 15)
    good = (distance_from_curves(click, halves) <= settings.click_reach_px).any(axis=0)
    good &= axis.beyond(along) <= settings.beyond
    if not good.any():
        return None
    return float(along[good][0]), float(along[good][-1])
