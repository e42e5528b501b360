# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jackets of reducers: cones of straight lines between two circles, developed along these lines.

Of a right cone the development is a sector of a ring. All straight lines of an oblique one meet in its apex, too: a point of the
wide circle is developed by its true distance d from the apex and by the angle psi between the developed lines, which grows by
sqrt(ds² - dd²) / d along the circle (s is the circle's length). Both edges get rims, to be bent onto the neighbours' jackets.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.flat import MarkLayer, Path, fit_arcs, joined
from pipeworkbench.insulation.patterns.cutting import crosses_itself, opened
from pipeworkbench.insulation.patterns.drafts import Draft, fits, usable
from pipeworkbench.insulation.patterns.mantles import FULL_TURN, integral
from pipeworkbench.insulation.patterns.openings import Opening, notch_openings
from pipeworkbench.insulation.patterns.rivets import rivet_holes
from pipeworkbench.insulation.treatment import Seams, SheetSize
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import ConeCovering, Sheet

MOST_SHELLS = 12
EQUAL_MM = 1e-3  # radii that differ by less are equal, an offset that is less is none
HARMONICS = 1024  # of the angle between developed lines; it is smooth, so that they fall off like a geometric series
NEGLIGIBLE = 1e-15  # amplitudes below this share of the mean are rounding

Develop = Callable[[Array, float], Array]


@dataclass(frozen=True, eq=False)
class Development:
    """A cone in the plane: ``point`` gives points (n, 2) of angles (n,) at a distance (mm) along the straight lines beyond an edge.

    ``lower`` is that function for the edge in z = 0, ``upper`` for the other one. ``slant`` (n,) of angles (n,) is the length (mm) of
    the straight lines, ``strip`` (n,) the area per angle (mm²/rad); ``radii`` (mm) are those of both circles.
    """

    lower: Develop
    upper: Develop
    slant: Callable[[Array], Array]
    radii: tuple[float, float]
    strip: Callable[[Array], Array]


def cone(covering: ConeCovering, seams: Seams, sheet: Sheet, size: SheetSize | None) -> list[Draft]:
    """Return the jacket of a reducer, parted into equal angles where the sheet asks for it.

    The seam of an eccentric one lies on its shortest line, that of a concentric one where the covering says.

    Raises
    ------
    InputError
        For an eccentric one of equal radii, no length, or one that is longer than the sheet.
    """
    developed = development(covering, sheet)
    seam = seam_angle(covering)
    openings = cone_openings(covering, developed)
    # every piece is at least as long as the longest line, between its rims
    longest = float(developed.slant(np.linspace(0, FULL_TURN, 73)).max()) + 2 * seams.gore_overlap
    most = MOST_SHELLS if size is None or longest <= max(usable(size)) else 0
    for shells in range(1, most + 1):
        step = FULL_TURN / shells
        drafts = [_shell(developed, seams, openings, seam + k * step, seam + (k + 1) * step) for k in range(shells)]
        if all(fits(draft, size) and not crosses_itself(draft.outline) for draft in drafts):
            return _named(drafts, developed, alike=abs(covering.offset) <= EQUAL_MM and not openings)
    raise InputError(
        covering.component,
        "sheet_size",
        f"the cone's jacket, {longest:.0f} mm along its longest line with its rims, does not fit the sheet",
        f"take a sheet whose longer side is more than {longest + 2 * (size.margin if size else 0.0):.0f} mm",
    )


def seam_angle(covering: ConeCovering) -> float:
    """Return the angle (rad) of a cone's seam: of an eccentric one that of its shortest line."""
    if abs(covering.offset) <= EQUAL_MM:
        return covering.seam
    return 0.0 if (covering.radius - covering.end_radius) * covering.offset > 0 else math.pi


def development(covering: ConeCovering, sheet: Sheet) -> Development:
    """Return the development of the middle of a reducer's sheet; of an angle pi, its middle line lies on the y axis.

    Raises
    ------
    InputError
        For an eccentric one of equal radii, or no length.
    """
    grown = covering.thickness + sheet.thickness / 2
    first, second = covering.radius + grown, covering.end_radius + grown
    if covering.length <= 0:
        raise InputError(covering.component, "length", f"a reducer of {covering.length:g} mm has no cone", "correct its length")
    if abs(covering.offset) <= EQUAL_MM:
        return _right(first, second, covering.length)
    if abs(first - second) <= EQUAL_MM:
        raise InputError(
            covering.component,
            "end_diameter",
            f"both ends are {2 * covering.radius:g} mm wide and {covering.offset:g} mm apart: an oblique tube is no reducer",
            "correct the diameters, or cover it as a pipe",
        )
    return _oblique(first, second, covering.length, covering.offset)


def _right(first: float, second: float, length: float) -> Development:
    """Return a ring's sector, a rectangle where both radii (mm) are the same.

    With s = sin(half the apex angle) the radius in the plane is r / s and the angle phi s; taken from the middle line's foot,
    x = r sin(phi s) / s and y = r (1 - cos(phi s)) / s stay exact when s goes to 0.
    """
    slant = math.hypot(length, first - second)
    s = (first - second) / slant

    def point(angles: Array, radius: float, height: float) -> Array:
        turn = angles - math.pi
        # sinc(x) is sin(pi x) / (pi x)
        x = radius * turn * np.sinc(turn * s / np.pi)
        y = radius * s * turn**2 / 2 * np.sinc(turn * s / 2 / np.pi) ** 2
        return np.column_stack([x, y + height])

    return Development(
        lower=lambda angles, beyond: point(angles, first + beyond * s, -beyond),
        upper=lambda angles, beyond: point(angles, second - beyond * s, slant + beyond),
        slant=lambda angles: np.full(len(angles), slant),
        radii=(first, second),
        strip=lambda angles: np.full(len(angles), (first + second) / 2 * slant),
    )


def _oblique(first: float, second: float, length: float, offset: float) -> Development:
    """Return the development of a cone about its apex; lengths are mm."""
    scale = first / (first - second)
    apex_x, apex_z = offset * scale, length * scale
    share = second / first  # of the distance from the apex at which the other circle lies

    def distance(angles: Array) -> Array:
        return np.sqrt(first**2 - 2 * first * apex_x * np.cos(angles) + apex_x**2 + apex_z**2)

    samples = np.arange(HARMONICS) * FULL_TURN / HARMONICS
    # ds² - dd² of the circle, with d dd = r x sin: what is left is the square of r times the distance across the circle's tangent
    rate = first * np.hypot(first - apex_x * np.cos(samples), apex_z) / distance(samples) ** 2
    amplitudes = np.fft.rfft(rate).real / HARMONICS
    count = int(np.flatnonzero(abs(amplitudes) > NEGLIGIBLE * amplitudes[0])[-1])
    orders = np.arange(1, count + 1)

    def turn(angles: Array) -> Array:
        # the integral of the rate, from pi
        waves = np.sin(np.outer(angles, orders)) @ (2 * amplitudes[1 : count + 1] / orders)
        return amplitudes[0] * (angles - math.pi) + waves

    # the apex lies above the first circle where the cone narrows upwards; with the other sign below
    side = math.copysign(1.0, scale)
    foot = float(distance(np.array([math.pi]))[0])

    def point(angles: Array, distances: Array) -> Array:
        psi = turn(angles)
        x, y = distances * np.sin(psi), foot - distances + 2 * distances * np.sin(psi / 2) ** 2
        return np.column_stack([x, side * y])

    return Development(
        lower=lambda angles, beyond: point(angles, distance(angles) + side * beyond),
        upper=lambda angles, beyond: point(angles, distance(angles) * share - side * beyond),
        slant=lambda angles: distance(angles) * abs(1 - share),
        radii=(first, second),
        strip=lambda angles: first * np.hypot(first - apex_x * np.cos(angles), apex_z) / 2 * abs(1 - share**2),
    )


def cone_openings(covering: ConeCovering, developed: Development) -> tuple[Opening, ...]:
    """Return what notches take away from a cone, wherever it is met between angles from -2 pi to 6 pi."""
    first, second = developed.radii

    def lines(angles: Array) -> tuple[Array, Array]:
        around = np.column_stack([np.cos(angles), np.sin(angles)])
        origins = np.column_stack([first * around, np.zeros(len(angles))])
        ends = np.column_stack([second * around + (covering.offset, 0.0), np.full(len(angles), covering.length)])
        return origins, (ends - origins) / developed.slant(angles)[:, None]

    found: list[Opening] = []
    for shift in FULL_TURN * np.arange(-1, 3):
        found += notch_openings(covering.notches, lines, lambda angles, s, shift=shift: developed.lower(angles + shift, -s))  # type: ignore[misc]
    return tuple(found)


def _shell(developed: Development, seams: Seams, openings: tuple[Opening, ...], start: float, stop: float) -> Draft:
    """Return the cone between two angles, with the overlap beyond the second; its middle line stands upright."""
    rim = min(seams.gore_overlap, min(developed.radii) / 2)
    lower, upper = (fit_arcs(lambda angles, f=f: f(angles, rim), start, stop) for f in (developed.lower, developed.upper))  # type: ignore[misc]
    net_lower, net_upper = (fit_arcs(lambda angles, f=f: f(angles, 0.0), start, stop) for f in (developed.lower, developed.upper))  # type: ignore[misc]
    foot, head = lower.points[-1], upper.points[-1]
    along = (head - foot) / np.hypot(*(head - foot))
    lap = seams.longitudinal_overlap * np.array([along[1], -along[0]])
    tab = Path.polygon(np.array([foot, foot + lap, head + lap, head]), closed=False)
    outline = joined(lower, tab, upper.reversed())
    net = joined(net_lower, Path.line(net_lower.points[-1], net_upper.points[-1]), net_upper.reversed())
    marks: list[tuple[MarkLayer, Path]] = [("FOLD", net_lower), ("FOLD", net_upper)] if rim > 0 else []
    marks += [("MARK", Path.line(foot, head))] if seams.longitudinal_overlap > 0 else []
    quarters = start + (stop - start) * np.array([0.25, 0.5, 0.75])
    ends = np.stack([developed.lower(quarters, rim), developed.upper(quarters, rim)], axis=1)
    marks += [("CENTRE", Path.line(pair[0], pair[1])) for pair in ends]
    result = opened(outline, net, openings, tuple(marks))
    draft = Draft(
        kind="cone",
        outline=result.cut.outline,
        net_area=integral(developed.strip, start, stop) - result.taken,
        holes=(*result.cut.holes, *rivet_holes(net_lower.points[-1] + lap / 2, net_upper.points[-1] + lap / 2, seams, result.cut)),
        marks=result.marks,
        middle=tuple(np.mean(ends[:2], axis=(0, 1)).tolist()),
        remarks=result.remarks,
    )
    up = ends[1, 1] - ends[1, 0]
    return draft.moved(90.0 - math.degrees(math.atan2(up[1], up[0])))


def _named(drafts: list[Draft], developed: Development, *, alike: bool) -> list[Draft]:
    """Return the shells of a cone with what is engraved; equal ones as one part with its number."""
    first, second = developed.radii
    lengths = developed.slant(np.linspace(0, FULL_TURN, 181))
    size = f"dia {2 * first:.1f} to {2 * second:.1f}, line {lengths.min():.1f}" + (f" to {lengths.max():.1f}" if np.ptp(lengths) > 0.05 else "")
    if alike:
        return [replace(drafts[0], lines=("cone", size), quantity=len(drafts))]
    names = [f"cone shell {k} of {len(drafts)}" if len(drafts) > 1 else "cone" for k in range(1, len(drafts) + 1)]
    return [replace(draft, lines=(name, size)) for draft, name in zip(drafts, names, strict=True)]
