# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where along an axis rims stand: how much the images speak for circles and outlines of given diameters at each place.

The straight edge of a flange's rim is parallel to the axis and ends at the plate's two edges (Sect. 6 of the
paper): the outline says where rim is, the circles' near halves, which nothing of the flange hides, where it ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.chance import density_of, hits_beside, over_rates, own_over_chance
from pipeworkbench.recon.cylinder import Cylinder, perpendicular_axes
from pipeworkbench.recon.match import edges_along_normals, match
from pipeworkbench.recon.vectors import across
from pipeworkbench.recon.views import View

KNOT_PX = 5.0  # between exact projections along the axis; straight in between to 0.01 px


@dataclass(frozen=True)
class LikelihoodSettings:
    """Tunables of the likelihood ratio of contour samples against chance; lengths in px.

    A sample's own edge lies within ``search_range`` with a scatter of ``scatter`` (Laplace); each of ``hit_rates``
    is as likely for a curve. How dense other edges are is seen in the ``background`` windows beside the contours.
    ``independent`` is the length of contour that counts as one observation: neighbouring samples meet the same edge.
    """

    search_range: float = 3.0
    scatter: float = 0.5
    hit_rates: tuple[float, ...] = (0.9, 0.6, 0.3)
    background: tuple[float, float] = (5.0, 12.0)
    least_density: float = 0.02
    independent: float = 20.0


@dataclass(frozen=True, eq=False)
class RimProfile:
    """Log-likelihood ratios along an axis.

    ``along`` (n,) mm from the axis' point, equally spaced; ``diameters`` (d,) mm; ``circle`` (d, n) for a sharp edge of that
    diameter there; ``outline`` (d, n) for the outline from the beginning up to there; ``click`` (d, n) px from a click to the
    circle's near half, NaN without a click.
    """

    along: Array
    diameters: Array
    circle: Array
    outline: Array
    click: Array

    def rims(self, row: int, width: float) -> tuple[Array, Array]:
        """Return the ratios (n,) of rims of a ``width`` (mm) that begin at each place, and the click's distances (n,) from them."""
        step = self.along[1] - self.along[0]
        end = self.along + width
        outline = self.outline[row]
        score = self.circle[row] + np.interp(end, self.along, self.circle[row]) + np.interp(end, self.along, outline) - outline
        score[end > self.along[-1]] = -np.inf
        count = int(np.ceil(width / step))
        near = np.pad(self.click[row], (0, count), constant_values=np.inf)
        return score, np.lib.stride_tricks.sliding_window_view(near, count + 1).min(axis=1)


def log_ratio(distance: Array, density: float | Array, rate: float, settings: LikelihoodSettings) -> Array:
    """Return the log-likelihood ratios of samples: their own edge against edges by chance.

    Parameters
    ----------
    distance : array
        To the nearest edge in px, NaN where there is none.
    density : float or array
        Edges per px by chance.
    rate : float
        Part of the samples that have an edge of their own.
    settings : LikelihoodSettings
    """
    return np.log(rate * own_over_chance(np.abs(distance), density, settings.scatter) + 1 - rate)


def density_beside(view: View, position: Array, normal: Array, settings: LikelihoodSettings) -> float:
    """Return how many edges of like direction per px there are beside contours (m, 2) by chance."""
    if not len(position):
        return settings.least_density
    low, high = settings.background
    sample, _, distance = edges_along_normals(view.edges, position, normal, high)
    share = float(hits_beside(sample, distance, low, len(position)).mean())
    return float(density_of(share, high - low, settings.least_density))


def near_halves(camera: Camera, cylinder: Cylinder, radii: Array, along: Array, count: int) -> Array:
    """Return pixels (d, n, count, 2) of the half circles of ``radii`` (d,) at ``along`` (n,) that face a camera.

    The first and the last of ``count`` lie on the outline of the cylinder of that radius.
    """
    length = float(along[-1] - along[0])
    ends = camera.project(cylinder.point + np.array([along[0], along[-1]])[:, None] * cylinder.direction)
    span = float(np.nan_to_num(np.linalg.norm(ends[1] - ends[0]), nan=1e3))
    knots = np.linspace(along[0], along[-1], max(int(np.ceil(span / KNOT_PX)), 3) + 1) if length > 0 else along[:1]
    to_camera = camera.projection_centre - cylinder.point
    to_camera = across(to_camera, cylinder.direction)
    distance = float(np.linalg.norm(to_camera))
    # nearly along the axis no half is nearer
    towards = to_camera / distance if distance > 1e-6 else perpendicular_axes(cylinder.direction[None])[0][0]
    sideways = np.cross(cylinder.direction, towards)
    widest = np.arccos(np.clip(radii / max(distance, 1e-6), -1, 1))
    angle = widest[:, None] * np.linspace(-1, 1, count)
    radial = np.cos(angle)[..., None] * towards + np.sin(angle)[..., None] * sideways
    centres = cylinder.point + knots[:, None] * cylinder.direction
    points = centres[None, :, None, :] + radii[:, None, None, None] * radial[:, None]
    pixels = camera.project(points.reshape(-1, 3)).reshape(len(radii), len(knots), count, 2)
    if len(knots) == 1:
        return pixels
    place = np.clip((along - knots[0]) / (knots[1] - knots[0]), 0, len(knots) - 1)
    low = np.minimum(place.astype(int), len(knots) - 2)
    part = (place - low)[None, :, None, None]
    between = pixels[:, low] * (1 - part) + pixels[:, low + 1] * part
    between[~camera.sees(between)] = np.nan
    return between


def rim_profile(
    views: Sequence[View],
    cylinder: Cylinder,
    diameters: Array,
    along: Array,
    click: tuple[int, Array] | None = None,
    settings: LikelihoodSettings | None = None,
    count: int = 17,
) -> RimProfile:
    """Weigh circles and outlines of diameters along an axis in all views.

    Parameters
    ----------
    views : sequence of View
    cylinder : Cylinder
        The axis; its radius does not matter.
    diameters : (d,) array
        mm.
    along : (n,) array
        Equally spaced places along the axis, mm from its point; n > 1.
    click : (int, (2,) array), optional
        View and pixel that was clicked.
    settings : LikelihoodSettings, optional
    count : int
        Samples of a half circle.
    """
    settings = settings or LikelihoodSettings()
    shape = (len(diameters), len(along))
    circle, outline, clicked = np.zeros(shape), np.zeros(shape), np.full(shape, np.nan)
    for number, view in enumerate(views):
        position = near_halves(view.camera, cylinder, diameters / 2, along, count)
        if click is not None and click[0] == number:
            clicked = distance_from_curves(click[1], position)
        around = np.gradient(position, axis=2)
        beside = np.gradient(position[:, :, [0, -1]], axis=1)
        # a circle's tangent is not known well from neighbours where the ellipse turns round
        circle += _weighed(view, position[:, :, 1:-1], around[:, :, 1:-1], settings)
        steps = _log_ratios(view, position[:, :, [0, -1]], beside, settings, settings.hit_rates[1]).sum(axis=2)
        outline += np.cumsum(steps, axis=1)
    return RimProfile(along, np.asarray(diameters, float), circle, outline, clicked)


def _tangents(step: Array) -> tuple[Array, Array]:
    """Return lengths (...) and normals (..., 2) of steps (..., 2) from sample to sample."""
    length = np.linalg.norm(step, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return length, np.stack([step[..., 1], -step[..., 0]], axis=-1) / length[..., None]


def _distances_and_density(view: View, position: Array, step: Array, settings: LikelihoodSettings) -> tuple[Array, float, Array, NDArray[np.bool_]]:
    length, normal = _tangents(step)
    flat, flat_normal = position.reshape(-1, 2), normal.reshape(-1, 2)
    known = np.isfinite(flat).all(axis=1) & np.isfinite(flat_normal).all(axis=1)
    some = np.flatnonzero(known)
    some = some[:: max(len(some) // 1500, 1)]
    density = density_beside(view, flat[some], flat_normal[some], settings)
    distance = match(view.edges, flat, flat_normal, settings.search_range).distance.reshape(length.shape)
    return distance, density, np.nan_to_num(length) / settings.independent, known.reshape(length.shape)


def _log_ratios(view: View, position: Array, step: Array, settings: LikelihoodSettings, rate: float) -> Array:
    """Return the weighted ratios (...) of samples."""
    distance, density, weight, known = _distances_and_density(view, position, step, settings)
    return np.where(known, weight * log_ratio(distance, density, rate, settings), 0.0)


def _weighed(view: View, position: Array, step: Array, settings: LikelihoodSettings) -> Array:
    """Return the ratios (d, n) of curves of samples (d, n, c), over all rates that are possible."""
    distance, density, weight, known = _distances_and_density(view, position, step, settings)
    rates = [np.where(known, weight * log_ratio(distance, density, rate, settings), 0.0).sum(axis=2) for rate in settings.hit_rates]
    return over_rates(rates)


def distance_from_curves(point: Array, curves: Array) -> Array:
    """Return the distances (d, n) of a point (2,) from polygons (d, n, c, 2)."""
    start, step = curves[:, :, :-1], np.diff(curves, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        part = np.clip(np.einsum("dnci,dnci->dnc", point - start, step) / np.einsum("dnci,dnci->dnc", step, step), 0, 1)
        off = np.linalg.norm(start + part[..., None] * step - point, axis=3)
    return np.where(np.isnan(off), np.inf, off).min(axis=2)
