# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tunables of the way from a pick to a pipe, and the standard sizes that they leave."""

from __future__ import annotations

from dataclasses import dataclass, field

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.extent import ExtentSettings


@dataclass(frozen=True)
class PickSettings:
    """Tunables of the search; lengths in mm, distances in the image in px.

    ``working_range`` and ``diameter_range`` limit the hypotheses (paper: 3-10 m, Fig. 6);
    ``search_range`` is Eq. 4's b of the ranking and ``step`` the hypotheses' distance in the other
    images, below twice b so that none is missed; ``largest_tilt_deg`` limits the axis against the image
    plane; the best ``ranked`` hypotheses by Eq. 4 and as many by texture are drawn onto the edges, at
    each of the edges that the clicks could mean; ``sized`` of those are tried with standard sizes, up to
    ``sizes`` each that are off by no more than ``widest_misfit``, and ``kept`` adjusted in full;
    ``final_range`` is the b of the reported quality.

    The score is a logarithm of likelihood ratios against clutter, summed over independent stretches of the
    edges, patches of the surface (of ``patch_area`` px^2, at most ``surface_patches``), the shading
    (``likeness_weight``), the clicks and the size: ``series_penalty`` per series of EN 10220 above the
    first. Where the other images speak for it by less than
    ``least_elsewhere`` there is no pipe; below ``least_score``, or with a diameter off by more
    than ``tolerance``, a pipe is marked approximate. A pipe that does not lead those at other places by
    ``least_lead``, or itself moved by ``certain_within`` and more by ``least_nearby_lead``, is not given without the alternatives.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (10.0, 2600.0)
    search_range: float = 8.0
    step: float = 7.0
    samples: int = 10
    largest_tilt_deg: float = 65.0
    ranked: int = 40
    alternatives: int = 3
    sized: int = 12
    sizes: int = 2
    widest_misfit: float = 0.15
    kept: int = 2
    final_range: float = 3.0
    tolerance: float = 0.012  # relative deviation of the adjusted diameter from the standard's
    least_tolerance: float = 0.4  # mm, the same for thin pipes
    surface_patches: float = 18.0
    patch_area: float = 800.0
    likeness_weight: float = 2.0
    series_penalty: float = 12.0
    least_score: float = 20.0
    least_elsewhere: float = 0.0
    least_lead: float = 3.0
    least_nearby_lead: float = 10.0
    certain_within: float = 20.0
    least_visible: float = 0.3  # part of the samples a view must contain to have a say
    extent: ExtentSettings = field(default_factory=ExtentSettings)


def sizes_in(settings: PickSettings) -> tuple[PipeSize, ...]:
    """Return the standard sizes within the diameter range."""
    low, high = settings.diameter_range
    return tuple(size for size in pipe_sizes() if low <= size.outer_diameter <= high)
