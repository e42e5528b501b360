# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rivet holes along seams: punched into the overlap, those beneath are drilled through them."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from pipeworkbench.insulation.flat import Path
from pipeworkbench.insulation.patterns.cutting import Cut
from pipeworkbench.insulation.treatment import Seams
from pipeworkbench.recon.camera import Array

FROM_END_MM = 15.0  # from the end of a seam to its first rivet
WIDTHS = 2.0  # an overlap must be so many rivet diameters wide, and a seam twice as long


def rivet_holes(start: Array, end: Array, seams: Seams, cut: Cut) -> tuple[Path, ...]:
    """Return rivet holes on the straight line between two points (2,), mm: near both ends and not farther apart than the pitch.

    Holes that would come too near the border of the part are left out, as are all where the overlap is too narrow.
    """
    length = float(np.hypot(*(end - start)))
    if seams.rivet_pitch <= 0 or seams.longitudinal_overlap < WIDTHS * seams.rivet_diameter or length < 2 * WIDTHS * seams.rivet_diameter:
        return ()
    places = start + (end - start) * (_places(length, seams.rivet_pitch) / length)[:, None]
    return tuple(_free((Path.circle((float(x), float(y)), seams.rivet_diameter / 2) for x, y in places), seams.rivet_diameter, cut))


def _places(length: float, pitch: float) -> Array:
    if length < 4 * FROM_END_MM:
        return np.array([length / 2])
    count = math.ceil((length - 2 * FROM_END_MM) / pitch - 1e-9) + 1
    return np.linspace(FROM_END_MM, length - FROM_END_MM, max(count, 2))


def _free(rivets: Iterable[Path], diameter: float, cut: Cut) -> Iterable[Path]:
    """Yield the rivet holes that lie within a part, with half their diameter of sheet around them."""
    for rivet in rivets:
        left, bottom, right, top = rivet.bounds
        around = Path.circle(((left + right) / 2, (bottom + top) / 2), 0.95 * diameter).sampled(diameter / 20)
        if cut.outline.contains(around).all() and not any(hole.contains(around).any() for hole in cut.holes):
            yield rivet
