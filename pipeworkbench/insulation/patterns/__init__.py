# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat patterns: the sheet metal of every covering's jacket, developed at the middle of the sheet, ready to be cut.

All parts are seen from the outside of the finished jacket. The grain of mantles runs along the pipe, as far as ``straight`` can.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeworkbench.insulation.flat import Pattern
from pipeworkbench.insulation.patterns.boxes import box
from pipeworkbench.insulation.patterns.cones import cone
from pipeworkbench.insulation.patterns.discs import cap, stop
from pipeworkbench.insulation.patterns.drafts import numbered
from pipeworkbench.insulation.patterns.gores import gores
from pipeworkbench.insulation.patterns.straight import straight
from pipeworkbench.insulation.patterns.tees import tee
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import (
    AnyCovering,
    BendCovering,
    BoxCovering,
    CapCovering,
    ConeCovering,
    StopCovering,
    StraightCovering,
    TeeCovering,
)

if TYPE_CHECKING:
    from pipeworkbench.insulation.planning import Piece, Plan

__all__ = ["patterns_of", "patterns_of_covering", "patterns_of_piece"]


def patterns_of(plan: Plan) -> tuple[Pattern, ...]:
    """Return the patterns of all pieces of a plan that have a jacket.

    Raises
    ------
    InputError
        As ``patterns_of_covering``.
    """
    return tuple(pattern for piece in plan.pieces for pattern in patterns_of_piece(plan, piece))


def patterns_of_piece(plan: Plan, piece: Piece) -> tuple[Pattern, ...]:
    """Return the patterns of one of a plan's pieces; errors are those of ``patterns_of_covering``."""
    size = max(plan.specification.sheet_sizes, key=lambda one: one.width * one.height, default=None)
    return patterns_of_covering(piece.covering, piece.treatment.seams, size)


def patterns_of_covering(covering: AnyCovering, seams: Seams, sheet_size: SheetSize | None = None) -> tuple[Pattern, ...]:
    """Return the patterns of a covering's jacket; none where it has no sheet, or is a smooth bend, which no sheet develops.

    Parameters
    ----------
    covering : AnyCovering
    seams : Seams
    sheet_size : SheetSize, optional
        What the parts must fit; without it they are not parted.

    Raises
    ------
    InputError
        Where a part cannot be developed or does not fit the sheet; names the component and what works.
    """
    sheet = covering.sheet
    if sheet is None:
        return ()
    match covering:
        case StraightCovering():
            drafts = straight(covering, seams, sheet, sheet_size)
        case BendCovering():
            drafts = gores(covering, seams, sheet, sheet_size)
        case ConeCovering():
            drafts = cone(covering, seams, sheet, sheet_size)
        case TeeCovering():
            drafts = tee(covering, seams, sheet, sheet_size)
        case CapCovering():
            drafts = cap(covering, seams, sheet, sheet_size)
        case BoxCovering():
            drafts = box(covering, seams, sheet, sheet_size)
        case StopCovering():
            drafts = stop(covering, seams, sheet_size)
    return numbered(drafts, covering, sheet)
