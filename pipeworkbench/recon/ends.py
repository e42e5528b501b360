# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ends of components that something may be joined to, and which pairs of them may meet in a corner (Sect. 5)."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import across

Found = TypeVar("Found")

PARALLEL = 1e-9  # squared sine of the angle between axes that have no point nearest to each other
UNKNOWN_SIGMA_MM = 2.0  # of the axes of pipes that do not say how well they are known: the paper's Table 3
SIGMA_FACTOR = 1.5  # neighbouring edge points err alike: adjusted axes are less well known than they say
LEAST_SIGMA_MM = 0.3
APPROXIMATE_FACTOR = 3.0  # of the standard deviations of pipes that are marked as approximate
BEYOND = 1.5  # diameters by which a pipe must reach beyond a corner to be one that goes on there


@dataclass(frozen=True, eq=False)
class Ends:
    """Free ends, e in number, of components.

    owner (e,) row of the component; port (e,); point (e, 3) mm; direction (e, 3) unit, out of the component;
    diameter (e,) mm; length (e,) of the straight axis behind the end, mm, 0 for fittings, whose ends cannot move.
    """

    owner: NDArray[np.intp]
    port: NDArray[np.intp]
    point: Array
    direction: Array
    diameter: Array
    length: Array

    def __len__(self) -> int:
        return len(self.owner)

    def row_and_port(self, end: int) -> tuple[int, int]:
        """Return the row of an end's component and the number of its port."""
        return int(self.owner[end]), int(self.port[end])

    def pairs(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return every two ends (p,), (p,) of different components."""
        first, second = np.triu_indices(len(self), 1)
        other = self.owner[first] != self.owner[second]
        return first[other], second[other]


def ends_of(components: Sequence[AnyComponent], taken: frozenset[tuple[int, int]] = frozenset()) -> Ends:
    """Return the ends of components but for those (row, port) that are taken."""
    rows = [
        (row, number, port.point, port.direction, port.diameter, component.length if isinstance(component, Pipe) else 0.0)
        for row, component in enumerate(components)
        for number, port in enumerate(component.ports)
        if (row, number) not in taken
    ]
    owner, port, point, direction, diameter, length = zip(*rows, strict=True) if rows else ((),) * 6
    return Ends(
        np.array(owner, np.intp),
        np.array(port, np.intp),
        np.array(point, float).reshape(-1, 3),
        np.array(direction, float).reshape(-1, 3),
        np.array(diameter, float),
        np.array(length, float),
    )


def line_of(pipe: Pipe) -> tuple[Array, Array]:
    """Return where a pipe's axis starts (3,), mm, and its unit direction (3,) towards the end."""
    return np.array(pipe.start), np.subtract(pipe.end, pipe.start) / pipe.length


def segments_of(pipes: Sequence[Pipe]) -> tuple[Array, Array]:
    """Return where the axes of pipes start and end (p, 3), mm."""
    return np.array([pipe.start for pipe in pipes]).reshape(-1, 3), np.array([pipe.end for pipe in pipes]).reshape(-1, 3)


def shared_course(one: Pipe, other: Pipe) -> tuple[float, Array]:
    """Return over which length, in mm along the axis of ``one``, another pipe runs beside it, and how far aside its ends (2,) are."""
    start, axis = line_of(one)
    offsets = np.array([other.start, other.end]) - start
    along = offsets @ axis
    return float(min(one.length, along.max()) - max(0.0, along.min())), np.linalg.norm(across(offsets, axis), axis=1)


def each_end_once(found: Iterable[Found], ends: Callable[[Found], tuple[Hashable, Hashable]]) -> list[Found]:
    """Return what was found between two ``ends`` each, best first, without what is at an end that a better one has."""
    kept: list[Found] = []
    taken: set[Hashable] = set()
    for one in found:
        if not taken.intersection(ends(one)):
            kept.append(one)
            taken.update(ends(one))
    return kept


@dataclass(frozen=True, eq=False)
class Corners:
    """Pairs of ends whose axes meet, c in number.

    first, second (c,) rows of the ends; corner (c, 3) mm, in the middle between both axes; skew (c,) their distance, mm;
    angle (c,) rad by which the course turns there; ahead (c, 2) from the ends to the corner, mm, negative
    where an end lies beyond it.
    """

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    corner: Array
    skew: Array
    angle: Array
    ahead: Array

    def __len__(self) -> int:
        return len(self.first)

    def __getitem__(self, rows: NDArray[np.bool_] | NDArray[np.intp]) -> Corners:
        return Corners(self.first[rows], self.second[rows], self.corner[rows], self.skew[rows], self.angle[rows], self.ahead[rows])


def corners_of(ends: Ends) -> Corners:
    """Return where the axes of every two ends of different components are nearest to each other."""
    first, second = ends.pairs()
    d, e = ends.direction[first], ends.direction[second]
    w = ends.point[second] - ends.point[first]
    cosine, wd, we = (np.einsum("ci,ci->c", x, y) for x, y in ((d, e), (w, d), (w, e)))
    with np.errstate(invalid="ignore", divide="ignore"):
        sine2 = np.where(1 - cosine**2 > PARALLEL, 1 - cosine**2, np.nan)
        ahead = np.stack([(wd - cosine * we) / sine2, (cosine * wd - we) / sine2], axis=1)
    there, here = ends.point[first] + ahead[:, :1] * d, ends.point[second] + ahead[:, 1:] * e
    angle = np.arccos(np.clip(-cosine, -1, 1))
    return Corners(first, second, (there + here) / 2, np.linalg.norm(here - there, axis=1), angle, ahead)


def axis_observations(components: Sequence[AnyComponent], ends: Ends, rows: NDArray[np.intp]) -> tuple[Array, Array]:
    """Return two points (c, 2, 3) of the axis behind each end of ``rows`` and their covariances (c, 2, 3, 3).

    A straight line that was observed evenly along its length 2 h is as well known in place (sigma^2) and
    direction (3 sigma^2 / h^2) as from two points h / sqrt(3) from its middle with 2 sigma^2 each.
    """
    points, covariance = np.empty((len(rows), 2, 3)), np.empty((len(rows), 2, 3, 3))
    for number, end in enumerate(rows):
        component = components[ends.owner[end]]
        given = component.sigma_position or (UNKNOWN_SIGMA_MM,) * 3
        factor = SIGMA_FACTOR * (APPROXIMATE_FACTOR if isinstance(component, Pipe) and component.approximate else 1.0)
        sigma = np.maximum(factor * np.array(given), LEAST_SIGMA_MM)
        # a fitting's end is one point with a direction: as good as a short straight piece
        half = max(ends.length[end], ends.diameter[end]) / 2
        middle = ends.point[end] - half * ends.direction[end]
        lever = half / np.sqrt(3) * ends.direction[end]
        points[number] = middle + lever, middle - lever
        covariance[number] = 2 * np.diag(sigma**2)
    return points, covariance


def in_line(
    ends: Ends, corners: Corners, segments: tuple[Array, Array], offset: float, angle: float, gap: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return where (c, 2) a pipe lies in line with the first or the second end: beyond the corner, and between end and corner.

    Parameters
    ----------
    ends : Ends
    corners : Corners
    segments : starts (p, 3), ends (p, 3)
        The axes of all pipes, in mm.
    offset : float
        How far from the corner their axes may pass, in diameters of the end.
    angle : float
        Between the axes, rad.
    gap : float
        How far beyond the corner they may begin, in diameters.
    """
    starts, stops = segments
    length = np.linalg.norm(stops - starts, axis=1)
    axis = (stops - starts) / length[:, None]
    beyond, between = np.zeros((len(corners), 2), bool), np.zeros((len(corners), 2), bool)
    for side, rows in enumerate((corners.first, corners.second)):
        direction, diameter = ends.direction[rows], ends.diameter[rows, None]
        cosine = direction @ axis.T
        to_start = starts[None] - corners.corner[:, None]
        aside = np.linalg.norm(np.cross(to_start, axis[None]), axis=2)
        parallel = (np.abs(cosine) >= np.cos(angle)) & (aside < offset * diameter)
        # from where to where each pipe reaches, counted from the corner along the end's direction
        low = np.einsum("cpi,ci->cp", to_start, direction)
        high = low + cosine * length
        low, high = np.minimum(low, high), np.maximum(low, high)
        beyond[:, side] = (parallel & (high > BEYOND * diameter) & (low < gap * diameter)).any(axis=1)
        end = -corners.ahead[:, side, None]
        between[:, side] = (parallel & (low > end) & (high < diameter)).any(axis=1)
    return beyond, between
