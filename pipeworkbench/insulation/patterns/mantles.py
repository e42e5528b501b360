# SPDX-License-Identifier: LGPL-2.1-or-later
"""Developed cylinders: what lies between two edges around a cylinder, with overlaps, marks, rivets and openings.

A mantle is seen from outside: x is the neutral radius times the angle from the seam, y goes along the cylinder's axis.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pipeworkbench.insulation.flat import MarkLayer, Path, fit_arcs, joined
from pipeworkbench.insulation.patterns.cutting import opened
from pipeworkbench.insulation.patterns.drafts import Draft
from pipeworkbench.insulation.patterns.openings import Opening
from pipeworkbench.insulation.patterns.rivets import rivet_holes
from pipeworkbench.insulation.treatment import Seams
from pipeworkbench.recon.camera import Array

QUADRATURE_POINTS = 200  # of Gauss and Legendre between the corners of an edge
FULL_TURN = 2 * math.pi


@dataclass(frozen=True, eq=False)
class Edge:
    """An edge around a cylinder: ``height`` gives y (mm) of angles (rad), ``corners`` are the angles where it is not smooth.

    ``lap`` (mm) is added beyond it along the axis; where the lap begins there is a line on ``layer``.
    """

    height: Callable[[Array], Array]
    corners: tuple[float, ...] = ()
    lap: float = 0.0
    layer: MarkLayer = "MARK"

    @classmethod
    def square(cls, height: float, lap: float = 0.0, layer: MarkLayer = "MARK") -> Edge:
        """Return an edge in a plane across the axis."""
        return cls(lambda angles: np.full(len(angles), height), (), lap, layer)


@dataclass(frozen=True, eq=False)
class Mantle:
    """A cylinder of neutral ``radius`` (mm) between two edges, parted along the angle ``seam`` (rad).

    ``centres`` are angles of centre lines; ``openings`` lie in the plane of radius × angle and y.
    """

    radius: float
    lower: Edge
    upper: Edge
    seam: float
    centres: tuple[float, ...] = ()
    openings: tuple[Opening, ...] = ()


def develop(mantle: Mantle, seams: Seams, kind: str, *, shell: int = 0, shells: int = 1, riveted: bool = True) -> Draft:
    """Return one of the equal shells that a mantle is parted into, with the longitudinal overlap at its end.

    Openings that would part the shell or meet each other are marked and named in a remark.
    """
    start, stop, over = spread(mantle, seams, shell, shells)
    net = _outline(mantle, start, stop, laps=False)
    result = opened(_outline(mantle, start, over, laps=True), net, met_openings(mantle, start, over), tuple(_lines(mantle, start, stop, over)))
    middle = np.array([(stop + over) / 2])
    x = mantle.radius * (middle[0] - start)
    seam = [np.array([x, edge.height(middle)[0]]) for edge in (mantle.lower, mantle.upper)]
    return Draft(
        kind=kind,
        outline=result.cut.outline,
        net_area=net_area(mantle, start, stop) - result.taken,
        holes=(*result.cut.holes, *(rivet_holes(seam[0], seam[1], seams, result.cut) if riveted else ())),
        marks=result.marks,
        middle=_middle(mantle, start, stop),
        remarks=result.remarks,
    )


def spread(mantle: Mantle, seams: Seams, shell: int, shells: int) -> tuple[float, float, float]:
    """Return the angles (rad) where a shell begins and ends, and where its overlap ends."""
    start = mantle.seam + shell * FULL_TURN / shells
    stop = start + FULL_TURN / shells
    return start, stop, stop + seams.longitudinal_overlap / mantle.radius


def net_area(mantle: Mantle, start: float, stop: float) -> float:
    """Return the area (mm²) between a mantle's edges from one angle to another, without overlaps and openings."""
    knots = _knots((*mantle.lower.corners, *mantle.upper.corners), start, stop)
    return mantle.radius * sum(
        integral(lambda angles: mantle.upper.height(angles) - mantle.lower.height(angles), *pair) for pair in itertools.pairwise(knots)
    )


def integral(function: Callable[[Array], Array], start: float, stop: float) -> float:
    """Return the integral of a smooth function of an angle after Gauss and Legendre."""
    nodes, weights = _quadrature()
    return float(function((start + stop) / 2 + (stop - start) / 2 * nodes) @ weights) * (stop - start) / 2


@functools.cache
def _quadrature() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_POINTS)  # type: ignore[no-untyped-call]
    return nodes, weights


def edge_path(edge: Edge, radius: float, start: float, stop: float, offset: float = 0.0) -> Path:
    """Return an edge developed from one angle to another, ``offset`` mm further along the axis; x is counted from the first."""

    def curve(angles: Array) -> Array:
        return np.column_stack([radius * (angles - start), edge.height(angles) + offset])

    knots = _knots(edge.corners, start, stop)
    return joined(*(fit_arcs(curve, a, b) for a, b in itertools.pairwise(knots)), closed=False)


def _knots(corners: tuple[float, ...], start: float, stop: float) -> list[float]:
    """Return start, the corners and their repetitions between, and stop."""
    turns = FULL_TURN * np.arange(-3, 5)
    inside = sorted({float(angle) for corner in corners for angle in corner + turns if start + 1e-9 < angle < stop - 1e-9})
    return [start, *inside, stop]


def _outline(mantle: Mantle, start: float, stop: float, *, laps: bool) -> Path:
    """Return the outline between both edges from one angle to another."""
    lower = edge_path(mantle.lower, mantle.radius, start, stop, offset=-mantle.lower.lap if laps else 0.0)
    upper = edge_path(mantle.upper, mantle.radius, start, stop, offset=mantle.upper.lap if laps else 0.0).reversed()
    return joined(lower, Path.line(lower.points[-1], upper.points[0]), upper)


def _lines(mantle: Mantle, start: float, stop: float, over: float) -> list[tuple[MarkLayer, Path]]:
    """Return the lines where overlaps begin and the centre lines."""
    marks: list[tuple[MarkLayer, Path]] = []
    if over > stop:
        marks.append(("MARK", _ruling(mantle, start, stop)))
    lapped = [edge for edge in (mantle.lower, mantle.upper) if edge.lap > 0]
    marks += [(edge.layer, edge_path(edge, mantle.radius, start, over)) for edge in lapped]
    for centre in mantle.centres:
        angle = start + (centre - start) % FULL_TURN
        # a line on the very edge would be cut away
        if start + 1e-6 < angle < stop - 1e-6:
            marks.append(("CENTRE", _ruling(mantle, start, angle)))
    return marks


def _ruling(mantle: Mantle, start: float, angle: float) -> Path:
    """Return the straight line along the axis at an angle, over the laps at both ends."""
    x = mantle.radius * (angle - start)
    at = np.array([angle])
    low, high = mantle.lower.height(at)[0] - mantle.lower.lap, mantle.upper.height(at)[0] + mantle.upper.lap
    return Path.line((x, float(low)), (x, float(high)))


def _middle(mantle: Mantle, start: float, stop: float) -> tuple[float, float]:
    """Return the middle of a shell beside its centre line, where texts are to lie."""
    angle = np.array([start + (stop - start) * 0.375])
    y = (mantle.lower.height(angle)[0] + mantle.upper.height(angle)[0]) / 2
    return float(mantle.radius * (angle[0] - start)), float(y)


def met_openings(mantle: Mantle, start: float, over: float) -> list[Opening]:
    """Return openings wherever they are met between two angles, x counted from the first."""
    met = []
    for opening in mantle.openings:
        if opening.path is None:
            met.append(opening)
            continue
        left, bottom, right, top = opening.path.bounds
        if not _reaches(mantle, bottom, top):
            continue
        shifts = mantle.radius * (np.array([-(start % FULL_TURN)]) if opening.around else FULL_TURN * np.arange(-3, 5) - start)
        reached = shifts[(right + shifts > 0) & (left + shifts < mantle.radius * (over - start))]
        met += [opening.moved((float(shift), 0.0)) for shift in reached]
    return met


def _reaches(mantle: Mantle, bottom: float, top: float) -> bool:
    """Return whether anything between two heights (mm) may touch a mantle."""
    angles = mantle.seam + np.linspace(0, FULL_TURN, 73)
    return bool(top > mantle.lower.height(angles).min() - mantle.lower.lap and bottom < mantle.upper.height(angles).max() + mantle.upper.lap)
