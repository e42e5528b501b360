# SPDX-License-Identifier: LGPL-2.1-or-later
"""Least-squares adjustment of a cylinder to the image edges of all views (the paper's Sect. 7.1).

Observations are the distances d_i from samples of the back-projected edges to the nearest subpixel
edge points, matched anew in each iteration within a shrinking range. The derivatives follow Eqs. 5-13:
an edge-generating point moves with the cylinder; only the part along the surface normal shows in the
image across the contour. The diameter is free or a pseudo-observation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder, contour, perpendicular_axes
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View

LEAST_SAMPLES, MOST_SAMPLES = 8, 1000  # along one edge in one view
NOT_CONVERGED = "the largest number of iterations was reached"
NOT_MOVED = "not moved: no iterations were asked for"
HELD_RADIUS_SIGMA = 1e-4  # mm; a pseudo-observation with a weight that no number of edges moves
PARAMETERS = 5  # two shifts and two tilts across the axis, the radius


@dataclass(frozen=True)
class AdjustSettings:
    """Tunables of the adjustment.

    ``spacing`` is the distance between samples in px (neighbouring edge points share pixels: closer
    samples would repeat the same noise), ``ranges`` the search ranges b in px iteration by iteration
    (the last one stays), ``tukey`` the factor of Tukey's biweight in robust standard deviations,
    ``least_scale`` a floor in px for that standard deviation, ``systematic`` the
    standard deviation in px of what all samples of one edge in one image have in common (calibration,
    shading of the limb), which no number of samples averages away, ``step`` the movement in mm below which
    the iteration has converged; no ``iterations`` at all give the statistics of the starting values.
    """

    spacing: float = 4.0
    ranges: tuple[float, ...] = (8.0, 6.0, 4.0, 3.0)
    tukey: float = 4.7
    least_scale: float = 0.05
    systematic: float = 0.2
    step: float = 1e-3
    iterations: int = 30


@dataclass(frozen=True, eq=False)
class CylinderSolution:
    """The adjusted cylinder and how well it is known.

    covariance (5, 5): shifts (mm) and tilts (mm at ``half_length``) along ``axes`` (2, 3), radius (mm);
    sigma0 in px; residuals, weights and views, one entry per observation; ``support`` is the part of
    all samples in the images that found an edge; message says why it stopped.
    """

    cylinder: Cylinder
    covariance: Array
    axes: Array
    half_length: float
    sigma0: float
    residuals: Array
    redundancy: int
    iterations: int
    converged: bool
    support: float
    message: str

    @property
    def sigma_position(self) -> Array:
        """Standard deviations (3,) of the axis' middle along the frame's axes, mm."""
        shifts = self.covariance[:2, :2]
        return np.asarray(np.sqrt(np.einsum("ai,ab,bi->i", self.axes, shifts, self.axes)))

    @property
    def sigma_direction(self) -> float:
        """Standard deviation of the axis' direction in radians, the larger of both tilts."""
        largest = float(np.linalg.eigvalsh(self.covariance[2:4, 2:4])[-1])
        return float(np.sqrt(max(largest, 0.0))) / self.half_length

    @property
    def sigma_radius(self) -> float:
        """Standard deviation of the radius in mm."""
        return float(np.sqrt(max(self.covariance[4, 4], 0.0)))


def adjust_cylinder(
    views: Sequence[View],
    cylinder: Cylinder,
    extent: tuple[float, float],
    radius_observation: tuple[float, float] | None = None,
    settings: AdjustSettings | None = None,
) -> CylinderSolution | None:
    """Fit a cylinder to the edges of all views.

    Parameters
    ----------
    views : sequence of View
    cylinder : Cylinder
        Starting values.
    extent : (float, float)
        From where to where, along the axis from ``cylinder.point`` in mm, its edges are used.
    radius_observation : (radius, sigma) in mm, optional
        Pseudo-observation of the radius; None leaves it free.
    settings : AdjustSettings, optional

    Returns
    -------
    CylinderSolution or None
        None where too few edges were found or the geometry does not determine the cylinder.
    """
    settings = settings or AdjustSettings()
    middle = (extent[0] + extent[1]) / 2
    half_length = max((extent[1] - extent[0]) / 2, 1.0)
    current = Cylinder(cylinder.at(middle), cylinder.direction, cylinder.radius)
    system: _System | None = None
    if settings.iterations == 0:
        system = _observe(views, current, half_length, settings.ranges[-1], radius_observation, settings)
        return system.solution(current, 0, NOT_MOVED, settings) if system else None
    for iteration in range(1, settings.iterations + 1):
        reach = settings.ranges[min(iteration, len(settings.ranges)) - 1]
        system = _observe(views, current, half_length, reach, radius_observation, settings)
        step = None if system is None else system.solve()
        if system is None or step is None or np.abs(step[:4]).max() > half_length + 50 * current.radius:
            return None
        current = system.moved(step)
        if current.radius <= 0:
            return None
        if iteration >= len(settings.ranges) and np.abs(step).max() < settings.step:
            return system.solution(current, iteration, f"converged: no movement above {settings.step:g} mm", settings)
    return system.solution(current, settings.iterations, NOT_CONVERGED, settings) if system else None


@dataclass(frozen=True, eq=False)
class _System:
    """One linearisation: design matrix (n, 5), misclosures, prior sigmas and robust weights (n,).

    ``edge`` numbers the edge in an image that an observation belongs to; the last ``pseudo`` rows are
    pseudo-observations and belong to none.
    """

    cylinder: Cylinder
    axes: Array
    half_length: float
    design: Array
    misclosure: Array
    prior_sigma: Array
    robust: Array
    edge: NDArray[np.int_]
    pseudo: int
    support: float

    def _weights(self) -> Array:
        return self.robust / self.prior_sigma**2

    def _normal_matrix(self) -> Array:
        return self.design.T @ (self.design * self._weights()[:, None])

    def solve(self) -> Array | None:
        try:
            step = np.linalg.solve(self._normal_matrix(), self.design.T @ (self._weights() * self.misclosure))
        except np.linalg.LinAlgError:
            return None
        return step if np.isfinite(step).all() else None

    def moved(self, step: Array) -> Cylinder:
        direction = self.cylinder.direction + (step[2:4] / self.half_length) @ self.axes
        point = self.cylinder.point + step[:2] @ self.axes
        return Cylinder(point, direction / np.linalg.norm(direction), self.cylinder.radius + float(step[4]))

    def solution(self, cylinder: Cylinder, iterations: int, message: str, settings: AdjustSettings) -> CylinderSolution | None:
        image = slice(None, len(self.misclosure) - self.pseudo)
        residuals, weights = self.misclosure[image], self._weights()[image]
        effective = float(self.robust[image].sum())
        redundancy = round(effective) + self.pseudo - PARAMETERS
        if redundancy <= 0:
            return None
        sigma0_unit = float(np.sqrt(np.sum(weights * residuals**2) / redundancy))
        try:
            cofactors = np.linalg.inv(self._normal_matrix())
        except np.linalg.LinAlgError:
            return None
        # each edge's common error enters the parameters with the sum of its samples' influence
        influence = (self.design[image] * weights[:, None]).T @ (self.edge[:, None] == np.unique(self.edge))
        common = settings.systematic * cofactors @ influence
        covariance = cofactors * max(sigma0_unit**2, 1.0) + common @ common.T
        sigma0 = float(np.sqrt(np.sum(self.robust[image] * residuals**2) / redundancy))
        return CylinderSolution(
            cylinder,
            covariance,
            self.axes,
            self.half_length,
            sigma0,
            residuals,
            redundancy,
            iterations,
            message not in (NOT_CONVERGED, NOT_MOVED),
            self.support,
            message,
        )


def _observe(
    views: Sequence[View],
    cylinder: Cylinder,
    half_length: float,
    reach: float,
    radius_observation: tuple[float, float] | None,
    settings: AdjustSettings,
) -> _System | None:
    """Match the contours in all views and linearise."""
    axes = np.array(perpendicular_axes(cylinder.direction))
    designs, misclosures, sigmas, robusts, edges = [], [], [], [], []
    samples = 0
    for number, view in enumerate(views):
        along = _sample_positions(view, cylinder, half_length, settings.spacing)
        if along is None:
            continue
        seen = contour(view.camera, cylinder, along)
        position, normal = seen.position.reshape(-1, 2), seen.normal.reshape(-1, 2)
        samples += int(np.isfinite(position[:, 0]).sum())
        matched = match(view.edges, position, normal, reach)
        found = matched.found
        if not found.any():
            continue
        gain = seen.gain.reshape(-1)[found, None]
        outward = np.repeat(seen.outward[0], len(along), axis=0)[found]
        lever = np.tile(along, 2)[found, None] / half_length
        across = outward @ axes.T
        designs.append(gain * np.hstack([across, lever * across, np.ones((len(across), 1))]))
        edges.append(2 * number + np.repeat([0, 1], len(along))[found])
        distance = matched.distance[found]
        misclosures.append(distance)
        sigmas.append(view.edges.sigma[matched.edge[found]])
        robusts.append(_tukey(distance, settings, coarse=reach > settings.ranges[-1]))
    if not designs or sum(map(len, designs)) < 3 * PARAMETERS:
        return None
    count = sum(map(len, designs))
    pseudo = 0
    if radius_observation is not None:
        pseudo = 1
        designs.append(np.array([[0.0, 0, 0, 0, 1]]))
        misclosures.append(np.array([radius_observation[0] - cylinder.radius]))
        sigmas.append(np.array([radius_observation[1]]))
        robusts.append(np.ones(1))
    return _System(
        cylinder,
        axes,
        half_length,
        np.vstack(designs),
        np.concatenate(misclosures),
        np.concatenate(sigmas),
        np.concatenate(robusts),
        np.concatenate(edges),
        pseudo,
        count / samples,
    )


def _sample_positions(view: View, cylinder: Cylinder, half_length: float, spacing: float) -> Array | None:
    """Return positions along the axis (n,) that are about ``spacing`` pixels apart in this view."""
    rays = np.array([cylinder.at(-half_length), cylinder.at(half_length)]) - view.camera.projection_centre
    if (rays @ view.camera.rotation[2]).min() <= cylinder.radius:
        return None
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    angle = float(np.arccos(np.clip(rays[0] @ rays[1], -1, 1)))
    count = int(np.clip(angle * view.camera.interior.pixels_per_radian / spacing, LEAST_SAMPLES, MOST_SAMPLES))
    return np.linspace(-half_length, half_length, count)


def _tukey(distance: Array, settings: AdjustSettings, *, coarse: bool) -> Array:
    """Return Tukey's biweight with a scale from the data; wide while the search is still coarse."""
    scale = max(1.4826 * float(np.median(np.abs(distance))), settings.least_scale)
    limit = settings.tukey * scale
    if coarse:
        limit = max(limit, settings.ranges[-1])
    return np.asarray(np.clip(1 - (distance / limit) ** 2, 0, None) ** 2)
