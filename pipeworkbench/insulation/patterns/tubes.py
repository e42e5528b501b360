# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight jackets, as pipes, runs of tees, caps and boxes have them: rectangles, parted along and around as the sheet asks for.

The sheet's grain runs along the pipe. Only where a circumference fits the sheet's longer side and not the shorter one does it run
around: one seam along the pipe is tighter than two. Lengths are parted equally, so that all sections are one part.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.flat import Path
from pipeworkbench.insulation.patterns.drafts import Draft, usable
from pipeworkbench.insulation.patterns.mantles import FULL_TURN, Edge, Mantle, develop, met_openings, spread
from pipeworkbench.insulation.patterns.openings import Opening
from pipeworkbench.insulation.treatment import Seams, SheetSize

LATCH_MM = (40.0, 15.0)  # half a latch: across the joint and along it
MOST_AROUND, MOST_ALONG = 100, 1000  # parts of one jacket; more are a slip of the pen
ROUNDING_MM = 1e-6  # by how much a limit may be missed: what was told must work
BEAD_FROM_EDGE_MM = 10.0  # where there is no overlap whose middle the bead could follow


@dataclass(frozen=True, eq=False, kw_only=True)
class Tube:
    """A straight jacket: neutral ``radius`` and ``length`` (mm, y from 0), ``seam`` (rad), openings in radius × angle and y.

    It is made of ``shells`` or a multiple of it around; ``lower_lap`` and ``upper_lap`` (mm) are the overlaps at its two ends.
    Latches are marked at every ``latch_pitch`` (mm) along the joints, none where it is 0.
    """

    component: str
    kind: str
    radius: float
    length: float
    seam: float
    shells: int = 1
    lower_lap: float = 0.0
    upper_lap: float = 0.0
    beads: bool = True
    latch_pitch: float = 0.0
    openings: tuple[Opening, ...] = ()


@dataclass(frozen=True)
class Division:
    """How a tube is parted: sections along, shells around, and whether the pipe's axis lies across the sheet's grain."""

    sections: int
    shells: int
    across: bool


def shifted(openings: Sequence[Opening], shift: float) -> tuple[Opening, ...]:
    """Return openings moved along the axis (mm)."""
    return tuple(opening.moved((0.0, shift)) for opening in openings)


def tube_parts(tube: Tube, seams: Seams, size: SheetSize | None) -> list[Draft]:
    """Return the parts of a straight jacket: sections and shells that fit the sheet.

    Equal ones are one part with its number: all that no opening touches. Every section but the last overlaps the next one, the
    first and the last also have the tube's own overlaps.

    Raises
    ------
    InputError
        Where the overlaps leave nothing of the sheet; names the component and the largest overlap that works.
    """
    division = divide(tube, seams, size)
    drafts: dict[tuple[object, ...], Draft] = {}
    for section, shell in itertools.product(range(division.sections), range(division.shells)):
        mantle = _section(tube, seams, section, division)
        start, _, over = spread(mantle, seams, shell, division.shells)
        touched = bool(met_openings(mantle, start, over))
        key = (section, shell) if touched else (mantle.lower.lap, mantle.upper.lap, *_latched(tube, shell, division))
        if key in drafts:
            drafts[key] = replace(drafts[key], quantity=drafts[key].quantity + 1)
        else:
            drafts[key] = _part(tube, seams, mantle, division, shell=shell, name=_name(tube, division, section, shell, touched=touched))
    return list(drafts.values())


def divide(tube: Tube, seams: Seams, size: SheetSize | None) -> Division:
    """Return into how many sections and shells a tube is parted to fit a sheet.

    Raises
    ------
    InputError
        As ``tube_parts``.
    """
    if size is None:
        return Division(1, tube.shells, across=False)
    length, height = usable(size)
    plain = tube.radius * FULL_TURN / tube.shells + seams.longitudinal_overlap
    across = plain > height and length > height
    along_limit, around_limit = (height, length) if across else (length, height)
    room = around_limit - seams.longitudinal_overlap
    if room * MOST_AROUND < tube.radius * FULL_TURN / tube.shells - ROUNDING_MM:
        largest = around_limit - tube.radius * FULL_TURN / tube.shells / MOST_AROUND
        raise _overlap_too_wide(tube, "longitudinal_overlap", seams.longitudinal_overlap, largest, size)
    shells = tube.shells * math.ceil(tube.radius * FULL_TURN / tube.shells / room - 1e-9)
    # a section in the middle has what joins sections at its upper end; the ends' own overlaps are never longer together
    extra = seams.circumferential_overlap + tube.lower_lap + max(tube.upper_lap - seams.circumferential_overlap, 0.0) + _bead_growth(tube, seams)
    room = along_limit - extra
    if room * MOST_ALONG < tube.length - ROUNDING_MM:
        # a tube's own overlaps are as wide as those of sections: all shrink with the one that is asked for
        shares = 1 + (tube.lower_lap > 0)
        largest = seams.circumferential_overlap - (tube.length / MOST_ALONG - room) / shares
        raise _overlap_too_wide(tube, "circumferential_overlap", seams.circumferential_overlap, largest, size)
    sections = math.ceil(tube.length / room - 1e-9)
    if tube.length + tube.lower_lap + tube.upper_lap + _bead_growth(tube, seams) <= along_limit:
        sections = 1
    return Division(sections, shells, across)


def _overlap_too_wide(tube: Tube, key: str, overlap: float, largest: float, size: SheetSize) -> InputError:
    """Return the problem of an overlap (mm) that leaves too little of a sheet."""
    problem = f"{overlap:g} mm leave too little of the sheet of {size.width:g} x {size.height:g} mm"
    tenths = math.floor(largest * 10)
    remedy = f"give at most {tenths / 10:g} mm or take a larger sheet" if tenths >= 0 else "take a larger sheet"
    return InputError(tube.component, key, problem, remedy)


def _bead_growth(tube: Tube, seams: Seams) -> float:
    """Return what is added (mm) to a section's length for its two beads."""
    return 2 * seams.bead_allowance if seams.bead and tube.beads else 0.0


def _section(tube: Tube, seams: Seams, index: int, division: Division) -> Mantle:
    """Return one section as a mantle, y from its lower net edge; what beads take is added where they are."""
    length, allowance = tube.length / division.sections, _bead_growth(tube, seams) / 2
    lower_lap = tube.lower_lap if index == 0 else 0.0
    upper_lap = tube.upper_lap if index == division.sections - 1 else seams.circumferential_overlap
    # the upper bead lies in the overlap, if there is one
    in_lap = allowance if upper_lap > 0 else 0.0
    upper = Edge.square(length + 2 * allowance - in_lap, upper_lap + in_lap)
    step = FULL_TURN / division.shells
    return Mantle(
        radius=tube.radius,
        lower=Edge.square(0.0, lower_lap),
        upper=upper,
        seam=tube.seam,
        centres=tuple(tube.seam + (shell + quarter / 4) * step for shell in range(division.shells) for quarter in (1, 2, 3)),
        openings=shifted(tube.openings, allowance - index * length),
    )


def _part(tube: Tube, seams: Seams, mantle: Mantle, division: Division, *, shell: int, name: str) -> Draft:
    """Return a shell of a section, laid with the grain."""
    first, last = _latched(tube, shell, division)
    draft = develop(mantle, seams, tube.kind, shell=shell, shells=division.shells, riveted=not last)
    length = tube.length / division.sections
    grown = float(mantle.upper.height(np.zeros(1))[0]) - length
    around, lap = FULL_TURN / division.shells * tube.radius, seams.longitudinal_overlap
    marks = draft.marks + tuple(("MARK", Path.line((0.0, y), (around + lap, y))) for y in _beads(tube, seams, mantle))
    marks += tuple(("MARK", mark) for mark in _latches(tube, length, ([lap] if first else []) + ([around + lap - LATCH_MM[0]] if last else [])))
    draft = replace(
        draft,
        net_area=draft.net_area - grown * around,
        marks=marks,
        lines=(name, f"dia {2 * tube.radius:.1f} x {length:.1f}"),
        grain="along",
    )
    return draft if division.across else draft.moved(-90.0)


def _beads(tube: Tube, seams: Seams, mantle: Mantle) -> list[float]:
    """Return where the beads lie (mm): in the middle of the overlap, and on the other end where the neighbour's one comes to lie."""
    if not (seams.bead and tube.beads):
        return []
    net = float(mantle.upper.height(np.zeros(1))[0])
    inner = seams.circumferential_overlap / 2 or BEAD_FROM_EDGE_MM
    outer = net + mantle.upper.lap / 2 if mantle.upper.lap > 0 else net - BEAD_FROM_EDGE_MM
    return [inner, outer]


def _latched(tube: Tube, shell: int, division: Division) -> tuple[bool, bool]:
    """Return whether there are latches where a shell begins and where it ends: at the joints of a box, between its ``shells``."""
    if tube.latch_pitch <= 0:
        return False, False
    pieces = division.shells // tube.shells
    return shell % pieces == 0, (shell + 1) % pieces == 0


def _latches(tube: Tube, length: float, places: list[float]) -> list[Path]:
    """Return the latches or catches that begin at places around (mm), evenly along the joint."""
    if not places:
        return []
    count = max(math.ceil(length / tube.latch_pitch), 2)
    wide, tall = LATCH_MM
    middles = (np.arange(count) + 0.5) * length / count
    return [Path.rectangle((x, float(y) - tall / 2), (x + wide, float(y) + tall / 2)) for y in middles for x in places]


def _name(tube: Tube, division: Division, section: int, shell: int, *, touched: bool) -> str:
    """Return what a part is called: which of several it is, where only one is like it."""
    if not touched:
        return tube.kind
    section_name = f" section {section + 1} of {division.sections}" if division.sections > 1 else ""
    shell_name = f" shell {shell + 1} of {division.shells}" if division.shells > 1 else ""
    return f"{tube.kind}{section_name}{shell_name}"
