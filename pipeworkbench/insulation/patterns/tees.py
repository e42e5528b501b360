# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jackets of tees: the run with the hole of the branch, and the branch with its saddle.

With the angle theta about the branch's axis, counted from its side towards the run's begin, and s along that axis, points of the
branch's cylinder (radius r, at the angle beta to the run) lie on the run's (radius R) at
s = (sqrt(R² - r² sin² theta) - r cos theta cos beta) / sin beta. Both edges follow this curve: as a saddle over theta, and as the
hole in the plane of R times the run's angle and z. Where the radii are equal, it has corners at both sides of the branch.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.flat import Path
from pipeworkbench.insulation.patterns.drafts import Draft, fits
from pipeworkbench.insulation.patterns.mantles import FULL_TURN, Edge, Mantle, develop
from pipeworkbench.insulation.patterns.openings import Opening, chain, cylinder_openings, smooth
from pipeworkbench.insulation.patterns.tubes import Tube, shifted, tube_parts
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import AnyNotch, Sheet, TeeCovering

RIM_MM = 8.0  # of the saddle, bent outwards onto the run
PLAY_MM = 2.0  # around a bare branch in the run's hole
SIDES = (math.pi / 2, 3 * math.pi / 2)  # of the branch, where the curve is bent most
MOST_SHELLS = 8
ROUNDING = 1e-9


def saddle(run_radius: float, branch_radius: float, branch_angle: float, angles: Array) -> Array:
    """Return s (n,) in mm: where a branch's cylinder comes out of the run's, along the branch's axis from that of the run.

    Parameters
    ----------
    run_radius, branch_radius : float
        mm; the branch's is not greater.
    branch_angle : float
        Between both axes, rad.
    angles : (n,) array
        About the branch's axis, rad, from its side towards the run's begin.
    """
    depth = np.sqrt(np.maximum(run_radius**2 - (branch_radius * np.sin(angles)) ** 2, 0.0))
    return (depth - branch_radius * np.cos(angles) * math.cos(branch_angle)) / math.sin(branch_angle)


def hole(run_radius: float, branch_radius: float, branch_angle: float) -> Path:
    """Return the outline of a branch's hole in the run, developed: run radius × angle from the branch and z (mm)."""

    def curve(angles: Array) -> Array:
        s = saddle(run_radius, branch_radius, branch_angle, angles)
        across = s * math.sin(branch_angle) + branch_radius * np.cos(angles) * math.cos(branch_angle)
        along = s * math.cos(branch_angle) - branch_radius * np.cos(angles) * math.sin(branch_angle)
        return np.column_stack([run_radius * np.arctan2(branch_radius * np.sin(angles), across), along])

    return chain([smooth(curve, -math.pi / 2, math.pi / 2), smooth(curve, math.pi / 2, 3 * math.pi / 2)])


def tee(covering: TeeCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the jackets of a tee's run and of its branch; of a bare branch (``reach`` 0) the run alone, with a hole for its pipe.

    The run's seam lies where the covering says unless the branch is there: opposite the branch then. The branch's lies on the
    side of its obtuse angle, where there is room for the rivets.

    Raises
    ------
    InputError
        Where the branch is wider than the run, along it, or covered to less than it comes out of the run.
    """
    run_radius = covering.radius + covering.thickness + sheet.thickness / 2
    covered = covering.reach > 0
    branch_radius = covering.branch_radius + (covering.thickness + sheet.thickness / 2 if covered else PLAY_MM)
    _refuse(covering, run_radius, branch_radius)
    bare = None if covered else hole(run_radius, covering.branch_radius, covering.branch_angle)
    opening = Opening("the branch", hole(run_radius, branch_radius, covering.branch_angle), net=bare)
    half_width = math.asin(min(branch_radius / run_radius, 1.0)) + seams.longitudinal_overlap / run_radius
    blocked = abs((covering.seam + math.pi) % FULL_TURN - math.pi) < half_width
    run = Tube(
        component=covering.component,
        kind="run",
        radius=run_radius,
        length=covering.end - covering.begin,
        seam=math.pi if blocked else covering.seam,
        upper_lap=seams.circumferential_overlap,
        openings=shifted((opening, *cylinder_openings(covering.notches, run_radius)), -covering.begin),
    )
    drafts = tube_parts(run, seams, size)
    return [*drafts, *_branch(covering, seams, run_radius, branch_radius, size)] if covered else drafts


def branch_mantle(covering: TeeCovering, seams: Seams, run_radius: float, branch_radius: float) -> Mantle:
    """Return the branch's jacket: angles as ``saddle``'s, y along its axis from that of the run."""
    edge = Edge(
        lambda angles: saddle(run_radius, branch_radius, covering.branch_angle, angles),
        corners=SIDES,
        lap=RIM_MM,
        layer="FOLD",
    )
    return Mantle(
        radius=branch_radius,
        lower=edge,
        upper=Edge.square(covering.reach, seams.circumferential_overlap),
        seam=0.0 if covering.branch_angle <= math.pi / 2 else math.pi,
        centres=(0.0, math.pi / 2, math.pi, 3 * math.pi / 2),
        openings=cylinder_openings(_branch_notches(covering), branch_radius),
    )


def _branch(covering: TeeCovering, seams: Seams, run_radius: float, branch_radius: float, size: SheetSize | None) -> list[Draft]:
    """Return the branch's jacket in as few shells as fit the sheet."""
    mantle = branch_mantle(covering, seams, run_radius, branch_radius)
    ends = saddle(run_radius, branch_radius, covering.branch_angle, np.linspace(0, FULL_TURN, 721))
    lines = ("branch", f"dia {2 * branch_radius:.1f}, length {covering.reach - ends.max():.1f} to {covering.reach - ends.min():.1f}")
    for shells in range(1, MOST_SHELLS + 1):
        drafts = [develop(mantle, seams, "branch", shell=shell, shells=shells) for shell in range(shells)]
        if all(fits(draft, size) for draft in drafts):
            names = [f"branch shell {k + 1} of {shells}" if shells > 1 else "branch" for k in range(shells)]
            return [replace(draft, lines=(name, *lines[1:])) for draft, name in zip(drafts, names, strict=True)]
    longest = covering.reach - ends.min() + RIM_MM + seams.circumferential_overlap
    raise InputError(
        covering.component,
        "sheet_size",
        f"the branch's jacket of {longest:.0f} mm with its overlaps does not fit the sheet",
        "take a larger sheet or cover less of the branch",
    )


def _refuse(covering: TeeCovering, run_radius: float, branch_radius: float) -> None:
    if not ROUNDING < covering.branch_angle < math.pi - ROUNDING:
        raise InputError(covering.component, "branch_end", "the branch runs along the run", "correct its points")
    if branch_radius > run_radius * (1 + ROUNDING):
        raise InputError(
            covering.component,
            "branch_diameter",
            f"the branch's jacket ({2 * branch_radius:.1f} mm) is wider than the run's ({2 * run_radius:.1f} mm)",
            f"give the branch less insulation: its jacket may be {2 * run_radius:.1f} mm wide at most",
        )
    if covering.reach > 0:
        least = float(saddle(run_radius, branch_radius, covering.branch_angle, np.linspace(0, FULL_TURN, 721)).max())
        if covering.reach <= least:
            raise InputError(
                covering.component,
                "reach",
                f"the branch is covered to {covering.reach:.1f} mm and its jacket comes out of the run's at {least:.1f} mm",
                f"cover more than {least:.1f} mm of it, or leave it bare",
            )


def _branch_notches(covering: TeeCovering) -> list[AnyNotch]:
    """Return the covering's notches in the branch's axes: x towards the run's begin, y as the run's, z along the branch."""
    cos, sin = math.cos(covering.branch_angle), math.sin(covering.branch_angle)
    axes: Array = np.array([(cos, 0.0, -sin), (0.0, 1.0, 0.0), (sin, 0.0, cos)])
    return [notch.moved(axes, np.zeros(3)) for notch in covering.notches]
