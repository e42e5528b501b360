# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat rings and discs: stops, bottoms of caps, end faces of boxes; and the pots over caps.

A ring is slit so that it can be put around the pipe, or parted into equal sectors where the sheet asks for it. Its border has a
rim to be bent onto the jacket.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.flat import MarkLayer, Path, joined
from pipeworkbench.insulation.patterns.cutting import Cut, crosses_itself
from pipeworkbench.insulation.patterns.drafts import Draft, fits
from pipeworkbench.insulation.patterns.openings import cylinder_openings
from pipeworkbench.insulation.patterns.rivets import rivet_holes
from pipeworkbench.insulation.patterns.tubes import Tube, tube_parts
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.solids.coverings import AnyNotch, CapCovering, Sheet, StopCovering

PLAY_MM = 1.0  # between the pipe and a disc's hole
SLIT_MM = 2.0
MOST_SECTORS = 8
NARROWEST_MM = 1.0  # a ring that is narrower is none
GRID = (24, 180)  # points along the radius and around, where a notch is looked for in a disc


def stop(covering: StopCovering, seams: Seams, size: SheetSize | None) -> list[Draft]:
    """Return the ring that closes insulation.

    Raises
    ------
    InputError
        Where it has no width, or does not fit the sheet.
    """
    draft = ring(covering.component, "disc", covering.radius, covering.outer_radius, seams, size, play=PLAY_MM)
    return [with_notches(draft, covering.notches, covering.radius, covering.outer_radius, 0.0)]


def cap(covering: CapCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the mantle and the bottom of the pot over a cap; the mantle overlaps the pipe's jacket at the pot's mouth."""
    radius = covering.radius + covering.thickness + sheet.thickness / 2
    length = covering.length + covering.thickness + sheet.thickness / 2
    mantle = Tube(
        component=covering.component,
        kind="jacket",
        radius=radius,
        length=length,
        seam=covering.seam,
        lower_lap=seams.circumferential_overlap,
        beads=False,
        openings=cylinder_openings(covering.notches, radius),
    )
    bottom = disc(covering.component, "disc", radius, seams, size)
    return [*tube_parts(mantle, seams, size), *(with_notches(part, covering.notches, 0.0, radius, length) for part in bottom)]


def disc(component: str, kind: str, radius: float, seams: Seams, size: SheetSize | None) -> list[Draft]:
    """Return a round disc of net ``radius`` (mm) with its rim, in one piece or, where the sheet is too small, in sectors.

    Raises
    ------
    InputError
        Where not even the sectors fit the sheet.
    """
    rim = seams.gore_overlap
    whole = Draft(
        kind=kind,
        outline=Path.circle((0.0, 0.0), radius + rim),
        net_area=math.pi * radius**2,
        marks=(*_fold(Path.circle((0.0, 0.0), radius), rim), *_cross(0.0, radius)),
        lines=("disc", f"dia {2 * radius:.1f}"),
        middle=(radius / 3, radius / 3),
    )
    if fits(whole, size):
        return [whole]
    return [ring(component, kind, 0.0, radius, seams, size, least=2)]


def ring(
    component: str,
    kind: str,
    inner: float,
    outer: float,
    seams: Seams,
    size: SheetSize | None,
    *,
    play: float = 0.0,
    least: int = 1,
    riveted: bool = True,
) -> Draft:
    """Return a ring as one slit part, or as the sector of which several make it, one overlapping the next.

    Parameters
    ----------
    component, kind : str
    inner, outer : float
        Net radii, mm; ``inner`` may be 0.
    seams : Seams
        Its ``gore_overlap`` is the rim's width, its ``longitudinal_overlap`` joins sectors.
    size : SheetSize or None
    play : float
        By which the hole is larger than ``inner``, mm; the net area does not know it.
    least : int
        The least number of sectors; their number is a multiple of it.
    riveted : bool
        Whether sectors get rivet holes in their overlap.

    Raises
    ------
    InputError
        Where the ring has no width, or not even sectors fit the sheet.
    """
    if outer - inner - play < NARROWEST_MM:
        raise InputError(component, "thickness", f"a ring from {inner:.1f} to {outer:.1f} mm has no width", "leave the stop out")
    for sectors in range(least, MOST_SECTORS + 1, least):
        draft = _slit(inner, outer, seams, play) if sectors == 1 else _sector(inner, outer, seams, play, sectors, riveted=riveted)
        draft = _called(draft, kind, inner, outer, sectors)
        if fits(draft, size) and not crosses_itself(draft.outline):
            return draft
    left, bottom, right, top = draft.outline.bounds
    margins = 2 * size.margin if size else 0.0
    needed = f"{math.ceil(right - left + margins)} x {math.ceil(top - bottom + margins)} mm"
    problem = f"a ring of {2 * outer:.0f} mm does not fit the sheet, not even in sectors"
    raise InputError(component, "sheet_size", problem, f"take a sheet of at least {needed}")


def _slit(inner: float, outer: float, seams: Seams, play: float) -> Draft:
    """Return a ring with a slit towards +x."""
    rim, hole = seams.gore_overlap, inner + play
    far, near = (math.asin(SLIT_MM / 2 / radius) for radius in (outer + rim, max(hole, SLIT_MM)))
    border = Path.arc((0.0, 0.0), outer + rim, far, 2 * math.pi - far)
    mouth = Path.arc((0.0, 0.0), hole, 2 * math.pi - near, near)
    outline = joined(border, Path.line(border.points[-1], mouth.points[0]), mouth)
    fold = Path.arc((0.0, 0.0), outer, math.asin(SLIT_MM / 2 / outer), 2 * math.pi - math.asin(SLIT_MM / 2 / outer))
    return Draft(
        kind="",
        outline=outline,
        net_area=math.pi * (outer**2 - inner**2),
        marks=(*_fold(fold, rim), *_cross(hole, outer)[1:]),
        middle=_beside_the_line(hole, outer, math.pi),
    )


def _sector(inner: float, outer: float, seams: Seams, play: float, sectors: int, *, riveted: bool) -> Draft:
    """Return one of equal sectors from the angle 0 on, with the overlap before it."""
    rim, hole, lap, end = seams.gore_overlap, inner + play, seams.longitudinal_overlap, 2 * math.pi / sectors
    far, near = max(outer + rim, lap), hole
    border = Path.arc((0.0, 0.0), far, 0.0, end)
    closing = [Path.line(border.points[-1], near * border.points[-1] / far)]
    if near > 0:
        mouth = Path.arc((0.0, 0.0), near, end, 0.0)
        closing = [Path.line(border.points[-1], mouth.points[0]), mouth]
    foot = closing[-1].points[-1]
    tab = Path.polygon(np.array([foot, (near, -lap), (far, -lap), (far, 0.0)]), closed=False)
    outline = joined(border, *closing, tab)
    holes = rivet_holes(np.array([near, -lap / 2]), np.array([outer, -lap / 2]), seams, Cut(outline)) if riveted else ()
    overlap: tuple[tuple[MarkLayer, Path], ...] = (("MARK", Path.line((near, 0.0), (far, 0.0))),) if lap > 0 else ()
    return Draft(
        kind="",
        outline=outline,
        net_area=math.pi * (outer**2 - inner**2) / sectors,
        holes=holes,
        marks=(*_fold(Path.arc((0.0, 0.0), outer, 0.0, end), rim), *overlap),
        middle=_beside_the_line(hole, outer, end / 2),
        quantity=sectors,
    )


def _called(draft: Draft, kind: str, inner: float, outer: float, sectors: int) -> Draft:
    """Return a ring or sector with its kind and what is engraved."""
    parts = f", 1 of {sectors}" if sectors > 1 else ""
    size = f"dia {2 * outer:.1f}, hole {2 * inner:.1f}" if inner > 0 else f"dia {2 * outer:.1f}"
    lines = (f"{kind}{parts}", size)
    return replace(draft, kind=kind, lines=lines)


def _beside_the_line(inner: float, outer: float, angle: float) -> tuple[float, float]:
    """Return the middle of a ring's width at an angle."""
    middle = (inner + outer) / 2
    return middle * math.cos(angle), middle * math.sin(angle)


def _fold(path: Path, rim: float) -> tuple[tuple[MarkLayer, Path], ...]:
    return (("FOLD", path),) if rim > 0 else ()


def _cross(inner: float, outer: float) -> tuple[tuple[MarkLayer, Path], ...]:
    """Return centre lines from one radius to another: towards +x, +y, -x and -y."""
    directions = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
    return tuple(("CENTRE", Path.line((inner * x, inner * y), (outer * x, outer * y))) for x, y in directions)


def with_notches(draft: Draft, notches: Iterable[AnyNotch], inner: float, outer: float, height: float) -> Draft:
    """Return a disc's draft with a remark for each notch that meets the ring between two radii in the plane z = ``height`` (mm)."""
    met = [notch.cause for notch in notches if _meets_ring(notch, inner, outer, height)]
    remarks = tuple(f"the opening for {cause} is to be cut on site" for cause in dict.fromkeys(met))
    return replace(draft, remarks=(*draft.remarks, *remarks))


def _meets_ring(notch: AnyNotch, inner: float, outer: float, height: float) -> bool:
    """Return whether a notch takes anything from a ring about z in the plane z = ``height`` (mm)."""
    radii, angles = np.meshgrid(np.linspace(inner, outer, GRID[0]), np.linspace(0, 2 * math.pi, GRID[1]))
    points = np.stack([radii * np.cos(angles), radii * np.sin(angles), np.full(radii.shape, height)], axis=-1).reshape(-1, 3)
    return bool(notch.holds(points).any())
