# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the common adjustment says: the components, how well they are known, and what does not fit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array, Camera


class ContourFit(NamedTuple):
    """How one contour of a component fits one image.

    ``rms`` px of its distances to the edges, ``offset`` px their common part with its standardised size ``w`` (Baarda),
    ``found`` of ``samples`` have an edge, ``redundancy`` is the part of its observations that the others check.
    """

    component: str
    station: str
    image: str
    contour: str
    samples: int
    found: int
    rms: float
    offset: float
    w: float
    redundancy: float


class ImageResiduals(NamedTuple):
    """The residuals in one image, of samples of contours that have an edge and count, n in number.

    ``component`` (n,) rows of the solution's components; ``contour`` and ``edge`` (n, 2) px, from the contour's point to the edge's beside it.
    """

    station: str
    image: str
    component: NDArray[np.intp]
    contour: Array
    edge: Array


class PseudoFit(NamedTuple):
    """How a pseudo-observation fits: ``residual`` and ``sigma`` in mm or rad, its redundancy number and Baarda's ``w``."""

    what: str
    residual: float
    sigma: float
    redundancy: float
    w: float


class Gross(NamedTuple):
    """A gross error: what is off by how much (px, mm or rad), with its standardised size; ``left_out`` where it no longer counts."""

    what: str
    size: float
    w: float
    left_out: bool


class Weak(NamedTuple):
    """A component that is weakly placed: along which ``direction`` (3,), with which sigma (mm), and why."""

    component: str
    direction: tuple[float, float, float]
    sigma: float
    reason: str


@dataclass(frozen=True, eq=False)
class Estimate:
    """An adjusted component's accuracy.

    sigma_position (3,) mm along the frame's axes and covariance (3, 3) mm^2 of its middle; sigma_direction in rad, the larger of two;
    sizes maps the names of adjusted sizes to their standard deviations (mm or degrees).
    """

    sigma_position: Array
    covariance: Array
    sigma_direction: float
    sizes: dict[str, float]


@dataclass(frozen=True, eq=False)
class AdjustedStation:
    """An adjusted station: where its level frame lies (4, 4), its cameras in that frame, and the pose's covariance (6, 6) in mm and rad."""

    frame_from_level: Array
    cameras: tuple[Camera, ...]
    covariance: Array


@dataclass(frozen=True, eq=False)
class Solution:
    """The result of an adjustment.

    Attributes
    ----------
    components
        In the order they were given, those that are not determined as they were.
    estimates
        By id, of those that were adjusted.
    stations
        The poses by name, with the priors' covariance replaced by what was estimated; zero where a station was not free.
    sigma0
        A posteriori standard deviation of unit weight: 1 where the observations scatter as they should.
    sigma_image
        Standard deviation of an image distance in px, robust, over all contours.
    redundancy, observations, unknowns
        Their numbers; observations count as often as they are independent.
    iterations, converged, message
        How it ended and why.
    common_sigma, trend_sigma
        Estimated standard deviations in px of what the samples of a contour have in common, and of its trend; the contours' medians.
    variance_factors
        Estimated over assumed variances of "image" observations, of the contours' "common" errors and their "trend", and of soft "pseudo"
        observations.
    contours, pseudo
        The fit of every contour in every image, and of every pseudo-observation.
    gross
        Gross errors found by data snooping, largest first.
    undetermined
        Ids with the reason: they are as they were.
    weak
        Components with a direction in which they are weakly placed.
    residuals
        Of each image, in the order of the views.
    warnings
        What else a person should know, in sentences.
    """

    components: tuple[AnyComponent, ...]
    estimates: dict[str, Estimate]
    stations: dict[str, AdjustedStation]
    sigma0: float
    sigma_image: float
    redundancy: float
    observations: float
    unknowns: int
    iterations: int
    converged: bool
    message: str
    common_sigma: float
    trend_sigma: float
    variance_factors: dict[str, float]
    contours: tuple[ContourFit, ...]
    pseudo: tuple[PseudoFit, ...]
    gross: tuple[Gross, ...]
    undetermined: dict[str, str]
    weak: tuple[Weak, ...]
    residuals: tuple[ImageResiduals, ...]
    warnings: tuple[str, ...]
    full_covariance: Callable[[str], tuple[tuple[str, ...], Array]]

    def covariance(self, component: str) -> tuple[tuple[str, ...], Array]:
        """Return the names of a component's adjusted parameters (k,) and their covariance (k, k), all in mm at the component's scale.

        Raises
        ------
        InputError
            Where the component was not adjusted.
        """
        return self.full_covariance(component)
