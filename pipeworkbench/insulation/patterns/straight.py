# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jackets of straight coverings."""

from __future__ import annotations

from pipeworkbench.insulation.patterns.drafts import Draft
from pipeworkbench.insulation.patterns.openings import cylinder_openings
from pipeworkbench.insulation.patterns.tubes import Tube, shifted, tube_parts
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import Sheet, StraightCovering


def straight(covering: StraightCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the jacket of a straight covering; its end overlaps the neighbour's jacket.

    Raises
    ------
    InputError
        Where the sheet is too small for the overlaps.
    """
    radius = covering.radius + covering.thickness + sheet.thickness / 2
    openings = cylinder_openings(covering.notches, radius)
    tube = Tube(
        component=covering.component,
        kind="jacket",
        radius=radius,
        length=covering.end - covering.begin,
        seam=covering.seam,
        upper_lap=seams.circumferential_overlap,
        openings=shifted(openings, -covering.begin),
    )
    return tube_parts(tube, seams, size)
