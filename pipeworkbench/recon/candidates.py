# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes that a pick could be, with how well the images fit them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pipeworkbench.catalogue import PipeSize, nearest_pipe_size
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder_adjustment import CylinderSolution
from pipeworkbench.recon.vectors import across

STANDARD_SIGMAS = 3.0  # a free diameter that is no further off a standard's may be it


@dataclass(frozen=True, eq=False)
class PipeCandidate:
    """A pipe that fits the images: geometry, standard size (None where free) and quality.

    ``extent`` is where its edges are seen, in mm along the axis, but for the ``gaps`` (m, 2) that were bridged;
    ``quality`` Eq. 4's q in px over all views; ``diameter`` in mm the adjusted one, with ``sigma_diameter``, before the
    standard's was held; ``score`` the logarithm of how much more likely it is than clutter, ``lead`` than the best pipe elsewhere,
    ``nearby_lead`` than itself somewhat nearer or further.
    """

    solution: CylinderSolution
    extent: tuple[float, float]
    size: PipeSize | None
    quality: float
    diameter: float
    sigma_diameter: float
    score: float
    lead: float
    approximate: bool
    nearby_lead: float = np.inf
    gaps: Array = field(default_factory=lambda: np.zeros((0, 2)))

    @property
    def nearest_standard(self) -> PipeSize | None:
        """The standard size within three sigmas of a diameter that was estimated freely; None where none is."""
        if self.size is not None:
            return None
        nearest = nearest_pipe_size(self.diameter)
        return nearest if abs(nearest.outer_diameter - self.diameter) <= STANDARD_SIGMAS * self.sigma_diameter else None

    @property
    def ends(self) -> Array:
        """End points of the axis (2, 3) in mm."""
        return np.array([self.solution.cylinder.at(self.extent[0]), self.solution.cylinder.at(self.extent[1])])


def same_cylinder(one: PipeCandidate, other: PipeCandidate) -> bool:
    """Tell whether two candidates are one cylinder: axes within a tenth of the diameter at both ends."""
    ends = one.ends
    offset = across(ends - other.solution.cylinder.point, other.solution.cylinder.direction)
    return one.size == other.size and bool(np.linalg.norm(offset, axis=1).max() < 0.1 * other.diameter)
