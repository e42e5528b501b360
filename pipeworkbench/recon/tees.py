# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tees: where the axis of a pipe's end meets a pipe that goes on in line (Sect. 5: collinear objects indicate a T-piece).

A fitting of EN 10253 has a neck with a round crotch; where the plain branch is seen down to the run's surface it is set on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from pipeworkbench import catalogue
from pipeworkbench.pipeline import AnyComponent, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.ends import Ends, ends_of, line_of
from pipeworkbench.recon.extent import ExtentSettings, extent_of
from pipeworkbench.recon.placement import outline_match
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class TeeSettings:
    """Tunables; diameters are outside diameters of the run unless said otherwise.

    ``skew`` and ``skew_mm`` limit the distance of the axes, whichever is more; ``angle_tolerance_deg`` is from ``angle_deg``; ``gap`` is
    how far the branch may end from the run's surface, in its own diameters, ``gap_mm`` at least; ``beyond`` how far the run may end before
    the branch where its edges are seen on both sides of it. ``share`` of the samples must find edges within ``reach`` px. A branch
    whose edges reach down to ``crotch`` of a fitting's neck, or ``set_on_share`` of the samples there, is set on.
    """

    skew: float = 0.15
    skew_mm: float = 12.0
    angle_deg: float = 90.0
    angle_tolerance_deg: float = 8.0
    gap: float = 2.0
    gap_mm: float = 60.0
    beyond: float = 4.0
    largest_branch: float = 1.02
    share: float = 0.5
    reach: float = 2.0
    set_on_share: float = 0.6
    crotch: float = 0.5
    samples: int = 24
    extent: ExtentSettings = field(default_factory=ExtentSettings)


@dataclass(frozen=True, eq=False)
class FoundTee:
    """A branch (row, port) on a run: row of the run's pipe, corner (3,) on its axis, in mm, its extent along its axis from the corner, in mm.

    ``fitting`` is the catalogue's, None where the branch is set on.
    """

    branch: tuple[int, int]
    run: int
    corner: Array
    axis: Array
    direction: Array
    extent: tuple[float, float]
    fitting: catalogue.Tee | None


def detect(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    settings: TeeSettings | None = None,
    taken: frozenset[tuple[int, int]] = frozenset(),
) -> tuple[FoundTee, ...]:
    """Find the tees among pipes.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        In the station's frame.
    settings : TeeSettings, optional
    taken : frozenset of (row, port)
        Ends that are joined already.
    """
    settings = settings or TeeSettings()
    pipes = [row for row, c in enumerate(components) if isinstance(c, Pipe)]
    ends = ends_of(components, taken)
    found: list[FoundTee] = []
    for end in range(len(ends)):
        if ends.length[end] <= 0:
            continue
        tees = [tee for row in pipes if row != ends.owner[end] and (tee := _tee(views, components, ends, end, row, settings)) is not None]
        # one that runs through on both sides, else the run that is longest
        if tees:
            found.append(max(tees, key=lambda tee: min(-tee.extent[0], tee.extent[1])))
    return tuple(found)


def edge_share(views: Sequence[View], cylinder: Cylinder, low: float, high: float, reach: float, samples: int) -> float:
    """Return the part of samples, on both edges of a stretch (mm along the axis), that find an image edge within ``reach`` px.

    That of the second best view: one may be hidden, in one there may be an edge by chance.
    """
    shares = []
    for view in views:
        found = outline_match(view, cylinder, np.linspace(low, high, samples), reach).found
        if len(found) >= samples:
            shares.append(float(found.mean()))
    shares.sort(reverse=True)
    return shares[min(1, len(shares) - 1)] if shares else 0.0


def _tee(views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, end: int, row: int, settings: TeeSettings) -> FoundTee | None:
    """Return the tee of one branch's end on one run, None where there is none."""
    run = components[row]
    assert isinstance(run, Pipe)  # noqa: S101  # the caller asks for pipes only
    diameter, own = run.outer_diameter, float(ends.diameter[end])
    start, axis = line_of(run)
    direction = ends.direction[end]
    cosine = float(axis @ direction)
    if own > settings.largest_branch * diameter or abs(np.degrees(np.arccos(abs(cosine))) - settings.angle_deg) > settings.angle_tolerance_deg:
        return None
    offset = ends.point[end] - start
    # nearest points of both axes: run's at ``place``, branch's ``ahead`` of its end
    place = float((offset @ axis - cosine * (offset @ direction)) / (1 - cosine**2))
    ahead = float((cosine * (offset @ axis) - offset @ direction) / (1 - cosine**2))
    corner = start + place * axis
    skew = float(np.linalg.norm(offset + ahead * direction - place * axis))
    reach = diameter / 2 + max(settings.gap * own, settings.gap_mm)
    if skew > max(settings.skew * diameter, settings.skew_mm) or not 0 <= ahead <= reach:
        return None
    low, high = -place, run.length - place
    if low > settings.beyond * diameter or high < -settings.beyond * diameter:
        return None
    cylinder = Cylinder(corner, axis, diameter / 2)
    if min(-low, high) < diameter:
        # the run seems to end here: it is a tee only where its edges go on on the other side
        side = 1.0 if high < -low else -1.0
        near, far = sorted((side * 1.0 * max(own, 0.5 * diameter), side * (max(own, 0.5 * diameter) + 1.5 * diameter)))
        if edge_share(views, cylinder, near, far, settings.reach, settings.samples) < settings.share:
            return None
        known = (min(low, near), max(high, far))
        low, high = extent_of(views, cylinder, known, settings.extent).both
    branch = Cylinder(corner, -direction, own / 2)
    surface = diameter / 2
    if ahead > surface + 0.3 * own and edge_share(views, branch, surface + 0.1 * own, ahead, settings.reach, settings.samples) < settings.share:
        return None
    fittings = [t for t in catalogue.tees(diameter, own) if t.branch_length is not None]
    fitting = fittings[0] if fittings else None
    if fitting is not None and fitting.branch_length is not None:
        # where the crotch of a fitting is round the plain branch has no edges
        crotch = surface + settings.crotch * (fitting.branch_length - surface)
        followed = ahead <= crotch
        if followed or edge_share(views, branch, surface, crotch, settings.reach, settings.samples) >= settings.set_on_share:
            fitting = None
    return FoundTee(ends.row_and_port(end), row, corner, axis, -direction, (low, high), fitting)
