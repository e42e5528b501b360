# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes over flanges and valves: two half mantles that overlap each other, held by latches, and end faces in halves.

The box is parted by the plane y = 0. The latches lie on the overlaps, their catches on the half beneath.
"""

from __future__ import annotations

from dataclasses import replace

from pipeworkbench.insulation.patterns.discs import ring, with_notches
from pipeworkbench.insulation.patterns.drafts import Draft
from pipeworkbench.insulation.patterns.openings import cylinder_openings
from pipeworkbench.insulation.patterns.tubes import Tube, shifted, tube_parts
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import BoxCovering, Sheet

LATCH_PITCH_MM = 300.0
SAME_MM = 0.05  # end faces whose openings differ by less are one part


def box(covering: BoxCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the half mantles and the half faces of a box.

    Mantles reach from the middle of one end face's sheet to that of the other. Faces have rims to be bent onto the mantle; their
    halves overlap each other.

    Raises
    ------
    InputError
        Where a part does not fit the sheet, or an end face has no width.
    """
    radius = covering.radius + covering.thickness + sheet.thickness / 2
    length = covering.end - covering.begin - sheet.thickness
    tube = Tube(
        component=covering.component,
        kind="box mantle",
        radius=radius,
        length=length,
        seam=0.0,
        shells=2,
        beads=False,
        latch_pitch=LATCH_PITCH_MM,
        openings=shifted(cylinder_openings(covering.notches, radius), -covering.begin - sheet.thickness / 2),
    )
    return [*tube_parts(tube, seams, size), *_faces(covering, radius, sheet, seams, size)]


def _faces(covering: BoxCovering, radius: float, sheet: Sheet, seams: Seams, size: SheetSize | None) -> list[Draft]:
    """Return the halves of both end faces; one part where they are equal."""
    faces = []
    for opening, height in zip(covering.openings, (covering.begin + sheet.thickness / 2, covering.end - sheet.thickness / 2), strict=True):
        face = ring(covering.component, "box face", opening, radius, seams, size, least=2, riveted=False)
        faces.append(with_notches(face, covering.notches, opening, radius, height))
    first, second = faces
    if abs(covering.openings[0] - covering.openings[1]) < SAME_MM and first.remarks == second.remarks:
        return [replace(first, quantity=first.quantity + second.quantity)]
    return faces
