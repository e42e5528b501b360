# SPDX-License-Identifier: LGPL-2.1-or-later
"""The gores of segmented bends: cylinders between mitre planes.

The mitre plane between two gores halves the angle between their axes. On a cylinder of radius r it cuts a line at
h - r cos(phi) tan(delta / 2) from the gore's middle, where h is half the gore's length on its axis, delta the angle between the
axes and phi is counted from the throat: developed, a cosine.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.patterns.drafts import Draft, usable
from pipeworkbench.insulation.patterns.mantles import Edge, Mantle, develop
from pipeworkbench.insulation.patterns.openings import cylinder_openings
from pipeworkbench.insulation.treatment import MOST_GORES, Seams, SheetSize
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import AnyNotch, BendCovering, Sheet

MOST_SHELLS = 8  # pieces around, that a gore may be parted into
QUARTERS = (0.0, math.pi / 2, math.pi, 3 * math.pi / 2)


def neutral_radius(covering: BendCovering, sheet: Sheet) -> float:
    """Return the radius (mm) of the middle of the jacket's sheet."""
    return covering.radius + covering.thickness + sheet.thickness / 2


def throat_and_heel(covering: BendCovering, radius: float, index: int) -> tuple[float, float]:
    """Return a gore's lengths (mm) on the inside and on the outside of the bend, on a cylinder of ``radius`` (mm), without overlaps."""
    ends = 1 if index in {0, covering.gores - 1} else 2
    collar = covering.collars[0] * (index == 0) + covering.collars[1] * (index == covering.gores - 1)
    slope = math.tan(covering.joint_angle / 2)
    return collar + ends * (covering.bend_radius - radius) * slope, collar + ends * (covering.bend_radius + radius) * slope


def gore_seam(covering: BendCovering, seams: Seams, index: int) -> float:
    """Return the angle (rad, from the throat) of a gore's seam: the covering's, moved to both sides by turns."""
    return covering.seam + math.radians(seams.stagger_deg) * (1 if index % 2 == 0 else -1)


def gore(covering: BendCovering, seams: Seams, sheet: Sheet, index: int) -> Mantle:
    """Return one gore as a mantle: angles from the throat, y from the middle of its axis (of the end gores: from the square end of it).

    Raises
    ------
    InputError
        Where the bend is so tight that the gore has no length at its throat.
    """
    radius = neutral_radius(covering, sheet)
    _refuse_tight(covering, sheet, index)
    last = covering.gores - 1
    half, slope = covering.half_length, math.tan(covering.joint_angle / 2)
    lower = Edge.square(-covering.collars[0]) if index == 0 else Edge(lambda angles: radius * slope * np.cos(angles) - half)
    upper = (
        Edge.square(covering.collars[1], seams.circumferential_overlap)
        if index == last
        else Edge(lambda angles: half - radius * slope * np.cos(angles), (), seams.gore_overlap, "FOLD")
    )
    openings = cylinder_openings(_local_notches(covering, index), radius)
    return Mantle(radius, lower, upper, gore_seam(covering, seams, index), centres=QUARTERS, openings=openings)


def place(covering: BendCovering, index: int, points: Array) -> Array:
    """Return points (n, 3) of a gore's own axes, x towards the throat and z along it, in the covering's axes (mm)."""
    turn = index * covering.joint_angle
    cos, sin = math.cos(turn), math.sin(turn)
    rotation = np.array([(cos, 0.0, sin), (0.0, 1.0, 0.0), (-sin, 0.0, cos)])
    # the middle of its axis touches the bend's circle; the end gores' axes begin there
    middle = covering.bend_radius * np.array([1 - cos, 0.0, sin])
    placed: Array = points @ rotation.T + middle
    return placed


def gores(covering: BendCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the gores of a segmented bend; none of a smooth one, which no sheet develops (its jacket is made of pre-formed shells).

    Equal gores are one part with its number; seams moved to both sides by turns make two variants of the middle ones.

    Raises
    ------
    InputError
        Where the bend is too tight, or a gore is longer than the sheet; names the component and what works.
    """
    if covering.gores == 0:
        return []
    if covering.gores < 2:
        raise InputError(covering.component, "gores", "a bend of one gore has no joint", "take 2 or more")
    shells = shells_needed(covering, seams, sheet, size)
    variants = [_variant(covering, seams, k) for k in range(covering.gores)]
    first_of = {variant: k for k, variant in reversed(list(enumerate(variants)))}
    return [
        draft
        for k, variant in enumerate(variants)
        if first_of[variant] == k
        for draft in _parts(covering, seams, sheet, k, shells, variants.count(variant))
    ]


def shells_needed(covering: BendCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> int:
    """Return into how many shells around every gore must be parted to fit the sheet.

    Raises
    ------
    InputError
        Where the gores are too long; names the smallest number that works.
    """
    shells = _shells(covering, seams, sheet, size)
    if shells is None:
        least = smallest_gore_count(covering, seams, sheet, size)
        problem = f"{covering.gores} gores are too few for the sheet of {size.width:g} x {size.height:g} mm" if size else ""
        if least is None:
            raise InputError(covering.component, "gores", problem, "take a larger sheet or shorter overlaps: no number of gores fits this one")
        raise InputError(covering.component, "gores", problem, f"take {least} or more, or a larger sheet")
    return shells


def smallest_gore_count(covering: BendCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> int | None:
    """Return the smallest number of gores, 2 or more, whose parts fit the sheet.

    None where the overlaps alone are too long for it, or the bend is too tight for gores between others.
    """
    if size is None:
        return 2
    if neutral_radius(covering, sheet) >= covering.bend_radius:
        return None
    low, high = 1, 2
    while _shells(replace(covering, gores=high), seams, sheet, size) is None:
        low, high = high, 2 * high
        if high > MOST_GORES:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if _shells(replace(covering, gores=middle), seams, sheet, size) is None else (low, middle)
    return high


def _shells(covering: BendCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> int | None:
    """Return how many shells around make all gores fit, None where none does: counted from their lengths alone."""
    if size is None:
        return 1
    radius = neutral_radius(covering, sheet)
    last = covering.gores - 1
    longest = 0.0
    for index in {0, min(1, last), last}:
        overlap = seams.circumferential_overlap if index == last else seams.gore_overlap
        _, heel = throat_and_heel(covering, radius, index)
        # a middle gore's box reaches from the lowest point to the highest, both at the heel
        longest = max(longest, heel + overlap)
    sides = usable(size)
    for shells in range(1, MOST_SHELLS + 1):
        around = 2 * math.pi * radius / shells + seams.longitudinal_overlap
        if any(longest <= a and around <= b for a, b in (sides, sides[::-1])):
            return shells
    return None


def _variant(covering: BendCovering, seams: Seams, index: int) -> tuple[int, int]:
    """Return what gores have in common that are cut alike: which end they are, and the side their seam is on; its own with notches."""
    if covering.notches:
        return index, 0
    end = 0 if index == 0 else 2 if index == covering.gores - 1 else 1
    return end, index % 2 if seams.stagger_deg else 0


def _parts(covering: BendCovering, seams: Seams, sheet: Sheet, index: int, shells: int, quantity: int) -> list[Draft]:
    mantle = gore(covering, seams, sheet, index)
    throat, heel = throat_and_heel(covering, mantle.radius, index)
    name = "first gore" if index == 0 else "last gore" if index == covering.gores - 1 else "gore"
    drafts = []
    for k in range(shells):
        draft = develop(mantle, seams, "gore", shell=k, shells=shells)
        shell = f" shell {k + 1} of {shells}" if shells > 1 else ""
        lines = (f"{name}{shell}", f"throat {throat:.1f} heel {heel:.1f}")
        remarks = (*draft.remarks, f"throat {throat:.1f} mm, heel {heel:.1f} mm")
        drafts.append(replace(draft, lines=lines, quantity=quantity, remarks=remarks))
    return drafts


def _refuse_tight(covering: BendCovering, sheet: Sheet, index: int) -> None:
    """Raise InputError where a gore's throat has no length; the collars may lend some to the end gores."""
    radius = neutral_radius(covering, sheet)
    throat, _ = throat_and_heel(covering, radius, index)
    if throat > 0:
        return
    ends = 1 if index in {0, covering.gores - 1} else 2
    # the throat grows by this for each mm that the insulation is thinner
    room = throat / (ends * math.tan(covering.joint_angle / 2))
    largest = covering.thickness + room
    advice = f"take less than {largest:.1f} mm" if largest > 0 else "the bend itself is too tight for gores: cover it with longer collars"
    problem = f"{covering.thickness:g} mm of insulation leave no sheet at the bend's throat"
    raise InputError(covering.component, "thickness", problem, advice)


def _local_notches(covering: BendCovering, index: int) -> list[AnyNotch]:
    """Return the covering's notches in a gore's own axes."""
    origin = place(covering, index, np.zeros((1, 3)))[0]
    axes = place(covering, index, np.eye(3)) - origin
    return [notch.moved(axes, origin) for notch in covering.notches]
