# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat parts of sheet metal: outlines of straight lines and arcs, marks and texts, in mm in the plane of the sheet."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import Sheet

MarkLayer = Literal["MARK", "FOLD", "CENTRE"]

FIT_TOLERANCE_MM = 0.02  # arcs stay so close to the curve they stand for
SAME_POINT_MM = 1e-6
STRAIGHT_MM = 1e-9  # what leaves its chord by less is a straight line
ROUGH_SAMPLES, FINE_SAMPLES = 33, 161  # odd; where an arc is compared with its curve while it is looked for, and before it is taken
HALVINGS, DIVISIONS = 12, 16  # of the parameter's range, when the longest arc is looked for
LEAST_SHARE = 2.0**-36  # of the range, that an arc must reach
SERIES_BELOW = 1e-3  # bulge below which an arc's segment is computed by its series


@dataclass(frozen=True, eq=False)
class Path:
    """Straight lines and arcs: ``points`` (n, 2) mm and ``bulges`` (n,).

    A bulge is the tangent of a quarter of the angle of the arc from a point to the next, positive counter-clockwise and 0
    for a straight line (DXF, group code 42); the last belongs to the way back to the first point and is 0 where the path is open.
    """

    points: Array
    bulges: Array
    closed: bool = True

    @classmethod
    def polygon(cls, points: Array, *, closed: bool = True) -> Path:
        """Return straight lines through points (n, 2)."""
        points = np.asarray(points, float)
        return cls(points, np.zeros(len(points)), closed)

    @classmethod
    def line(cls, start: Array | tuple[float, float], end: Array | tuple[float, float]) -> Path:
        """Return the straight line between two points (mm)."""
        return cls.polygon(np.array([start, end], float), closed=False)

    @classmethod
    def rectangle(cls, lower: tuple[float, float], upper: tuple[float, float]) -> Path:
        """Return a rectangle from its lower left to its upper right corner (mm), counter-clockwise."""
        (left, bottom), (right, top) = lower, upper
        return cls.polygon(np.array([(left, bottom), (right, bottom), (right, top), (left, top)], float))

    @classmethod
    def circle(cls, centre: tuple[float, float], radius: float) -> Path:
        """Return a circle (mm) as two half arcs, counter-clockwise."""
        x, y = centre
        return cls(np.array([(x + radius, y), (x - radius, y)], float), np.ones(2))

    @classmethod
    def arc(cls, centre: tuple[float, float], radius: float, start: float, end: float) -> Path:
        """Return an arc (mm) from one angle (rad) to another, clockwise where ``end`` is less; no piece is longer than a quarter."""
        pieces = max(int(np.ceil(abs(end - start) / (np.pi / 2) - 1e-9)), 1)
        angles = np.linspace(start, end, pieces + 1)
        points = np.asarray(centre) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        bulges = np.append(np.full(pieces, np.tan((end - start) / pieces / 4)), 0.0)
        return cls(points, bulges, closed=False)

    @classmethod
    def slot(cls, start: tuple[float, float], end: tuple[float, float], width: float) -> Path:
        """Return a slot with round ends between the centres of its ends (mm), counter-clockwise."""
        along = np.subtract(end, start) / np.hypot(*np.subtract(end, start))
        side = width / 2 * np.array([-along[1], along[0]])
        points = np.array([start - side, end - side, end + side, start + side])
        return cls(points, np.array([0.0, 1.0, 0.0, 1.0]))

    @property
    def segments(self) -> tuple[Array, Array, Array]:
        """Starts (k, 2), ends (k, 2) and bulges (k,) of the lines and arcs, with the way back where the path is closed."""
        if self.closed:
            return self.points, np.roll(self.points, -1, axis=0), self.bulges
        return self.points[:-1], self.points[1:], self.bulges[:-1]

    @property
    def area(self) -> float:
        """What the path encloses (mm²), positive where it runs counter-clockwise; an open one is closed by a straight line."""
        x, y = (self.points - self.points[0]).T
        straight = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
        starts, ends, bulges = self.segments
        return straight + float(np.sum(_segment_shares(bulges) * np.sum((ends - starts) ** 2, axis=1)))

    @property
    def length(self) -> float:
        """Length (mm) of all lines and arcs."""
        starts, ends, bulges = self.segments
        safe = np.where(bulges == 0, 1.0, bulges)
        stretch = np.where(bulges == 0, 1.0, np.arctan(safe) / safe * (1 + safe**2))
        return float(np.sum(np.hypot(*(ends - starts).T) * stretch))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, least y, greatest x and greatest y (mm), arcs included."""
        corners = [self.points]
        starts, ends, bulges = self.segments
        curved = bulges != 0
        if curved.any():
            starts, ends, bulges = starts[curved], ends[curved], bulges[curved]
            centres, radii = _circles(starts, ends, bulges)
            first = np.arctan2(*(starts - centres).T[::-1])
            for angle in np.arange(4) * np.pi / 2:
                turn = np.where(bulges > 0, angle - first, first - angle) % (2 * np.pi)
                reached = turn <= 4 * np.arctan(abs(bulges))
                corners.append((centres + radii[:, None] * (np.cos(angle), np.sin(angle)))[reached])
        points = np.concatenate(corners)
        return (*map(float, points.min(axis=0)), *map(float, points.max(axis=0)))  # type: ignore[return-value]

    def moved(self, angle_deg: float = 0.0, shift: Array | tuple[float, float] = (0.0, 0.0)) -> Path:
        """Return the path turned about the origin, counter-clockwise, and then shifted (mm)."""
        return Path(turned(self.points, angle_deg) + np.asarray(shift), self.bulges, self.closed)

    def mirrored(self) -> Path:
        """Return the path with x and -x exchanged; a closed one runs the other way round then."""
        return Path(self.points * (-1.0, 1.0), -self.bulges, self.closed)

    def reversed(self) -> Path:
        """Return the path run through from its end."""
        bulges = -self.bulges[::-1]
        return Path(self.points[::-1], np.roll(bulges, -1), self.closed)

    def counter_clockwise(self) -> Path:
        """Return a closed path so that it runs counter-clockwise."""
        return self if self.area >= 0 else self.reversed()

    def sampled(self, chord_error: float = 0.05) -> Array:
        """Return points (n, 2) whose straight connections stay within ``chord_error`` (mm) of the path; a closed one does not repeat its first."""
        points, _, _ = self.samples(chord_error)
        return points

    def samples(self, chord_error: float) -> tuple[Array, Array, Array]:
        """Return points as ``sampled`` does, with the segment (n,) each lies on and how far along it (n,), from 0 up to 1."""
        starts, ends, bulges = self.segments
        turns = 4 * np.arctan(bulges)
        safe = np.where(bulges == 0, 1.0, abs(bulges))
        radii = np.hypot(*(ends - starts).T) * (1 + safe**2) / (4 * safe)
        step = 2 * np.arccos(np.clip(1 - chord_error / np.maximum(radii, SAME_POINT_MM), 0.0, 1.0))
        counts = np.where(bulges == 0, 1, np.ceil(abs(turns) / np.maximum(step, 1e-9))).astype(int).clip(1)
        segment = np.repeat(np.arange(len(counts)), counts)
        share = (np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[segment]
        points = self.at(segment, share)
        if self.closed:
            return points, segment, share
        return np.vstack([points, self.points[-1:]]), np.append(segment, len(counts) - 1), np.append(share, 1.0)

    def at(self, segment: Array, share: Array) -> Array:
        """Return the points (n, 2) that lie by ``share`` (n,) of its length along each segment (n,) of the path."""
        starts, ends, bulges = (part[segment] for part in self.segments)
        # of the arc's point in units of its chord: the angle at the start is half the turn, chords go with the sine of half angles
        half = 2 * np.arctan(bulges)
        safe = np.where(half == 0, 1.0, half)
        reach = np.where(half == 0, share, np.sin(share * safe) / np.sin(safe))
        along = ends - starts
        across = np.column_stack([along[:, 1], -along[:, 0]])
        lean = (1 - share) * half
        return starts + reach[:, None] * (np.cos(lean)[:, None] * along + np.sin(lean)[:, None] * across)

    def contains(self, points: Array) -> NDArray[np.bool_]:
        """Return which points (n, 2) a closed path encloses (n,), to 0.01 mm; the border counts as either."""
        x, y = np.asarray(points, float).T
        corners = self.sampled(0.01)
        (x0, y0), (x1, y1) = corners.T, np.roll(corners, -1, axis=0).T
        spans = (y0 > y[:, None]) != (y1 > y[:, None])
        rise = np.where(y1 == y0, 1.0, y1 - y0)
        left = x[:, None] < x0 + (y[:, None] - y0) * (x1 - x0) / rise
        inside: NDArray[np.bool_] = np.count_nonzero(spans & left, axis=1) % 2 == 1
        return inside


@dataclass(frozen=True)
class Text:
    """A text on the sheet: its lower left corner (mm), the height of its capitals (mm), the angle of its line (deg)."""

    text: str
    position: tuple[float, float]
    height: float
    angle_deg: float = 0.0

    def moved(self, angle_deg: float = 0.0, shift: Array | tuple[float, float] = (0.0, 0.0)) -> Text:
        """Return the text turned about the origin, counter-clockwise, and then shifted (mm)."""
        x, y = turned(np.array([self.position]), angle_deg)[0] + np.asarray(shift)
        return dataclasses.replace(self, position=(float(x), float(y)), angle_deg=self.angle_deg + angle_deg)


@dataclass(frozen=True, eq=False, kw_only=True)
class Pattern:
    """One part to be cut, seen from the outside of the finished jacket.

    ``covering`` and ``component`` name what it belongs to; ``kind`` says what it is: "jacket", "gore", "cone", "branch",
    "run", "disc", "box mantle", "box face". ``net_area`` (mm²) is that of the rolled-up part's neutral fibre without overlaps, slits
    and play closed; ``outline`` and ``holes`` are cut, ``marks`` scribed (layer and path), ``texts`` engraved. ``grain`` says whether the
    part may be turned by 90 degrees on the sheet ("any") or only by 180 ("along"); ``quantity`` is how many of it are needed.
    """

    id: str
    covering: str
    component: str
    kind: str
    outline: Path
    sheet: Sheet
    net_area: float
    holes: tuple[Path, ...] = ()
    marks: tuple[tuple[MarkLayer, Path], ...] = ()
    texts: tuple[Text, ...] = ()
    quantity: int = 1
    grain: Literal["any", "along"] = "any"
    remarks: tuple[str, ...] = field(default=())

    @property
    def cut_area(self) -> float:
        """Area (mm²) of the sheet that the part is, overlaps included and holes left out."""
        return abs(self.outline.area) - sum(abs(hole.area) for hole in self.holes)


def turned(points: Array, angle_deg: float) -> Array:
    """Return points (n, 2) turned about the origin, counter-clockwise; exact for whole quarters."""
    quarter, rest = divmod(angle_deg, 90.0)
    cos, sin = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    if rest:
        cos, sin = float(np.cos(np.radians(angle_deg))), float(np.sin(np.radians(angle_deg)))
    return np.asarray(points, float) @ np.array([(cos, sin), (-sin, cos)])


def joined(*paths: Path, closed: bool = True) -> Path:
    """Return paths that follow one another as one; what leads from the last back to the first is a straight line.

    Raises
    ------
    ValueError
        Where a path does not begin where the one before ends.
    """
    points, bulges = [paths[0].points[:1]], []
    for path in paths:
        if np.max(abs(path.points[0] - points[-1][-1])) > SAME_POINT_MM:
            raise ValueError(f"a path begins at {path.points[0]}, the one before ends at {points[-1][-1]}")
        steps = np.hypot(*np.diff(path.points, axis=0).T) > SAME_POINT_MM
        points.append(path.points[1:][steps])
        bulges.append(path.bulges[:-1][steps])
    chain, curves = np.concatenate(points), np.append(np.concatenate(bulges), 0.0)
    if closed and np.max(abs(chain[0] - chain[-1])) <= SAME_POINT_MM:
        chain, curves = chain[:-1], curves[:-1]
    return Path(chain, curves, closed)


def fit_arcs(curve: Callable[[Array], Array], start: float, end: float, tolerance: float = FIT_TOLERANCE_MM) -> Path:
    """Return few arcs through points of a smooth curve that stay close to it.

    Each arc goes from the end of the one before as far as it may; the farthest end is found by trying many at a time. Arcs go
    through their curve's point in the middle and are no longer than half a circle.

    Parameters
    ----------
    curve : callable
        From parameters (n,) to points (n, 2) in mm; without corners between ``start`` and ``end``.
    start, end : float
        The range of the parameter; ``end`` may be the lesser.
    tolerance : float
        The greatest distance (mm) between an arc and the curve.

    Returns
    -------
    Path
        An open one.

    Raises
    ------
    ValueError
        Where the curve jumps, so that no arc follows it.
    """
    points, bulges = [curve(np.array([start]))[0]], []
    here = float(start)
    while here != end:
        there, bend = _longest_arc(curve, here, float(end), tolerance)
        points.append(curve(np.array([there]))[0])
        bulges.append(bend)
        here = there
    return Path(np.array(points), np.array([*bulges, 0.0]), closed=False)


def _longest_arc(curve: Callable[[Array], Array], start: float, end: float, tolerance: float) -> tuple[float, float]:
    """Return how far one arc from a parameter may go towards another, and its bulge."""
    share = 1.0
    while share > LEAST_SHARE:
        ends = start + (end - start) * share * 0.5 ** np.arange(HALVINGS)
        ends = np.where(ends == start + (end - start), end, ends)
        good, _ = _arcs_from(curve, start, ends, tolerance, ROUGH_SAMPLES)
        best = int(np.argmax(good))
        if good[best]:
            # where not even the first one is too long, it is the whole way; else the one before, twice as far, is
            between = ends[:1] if best == 0 else np.linspace(ends[best - 1], ends[best], DIVISIONS + 1)[1:]
            fine, bulges = _arcs_from(curve, start, between, tolerance, FINE_SAMPLES)
            longest = int(np.argmax(fine))
            if fine[longest]:
                return float(between[longest]), float(bulges[longest])
        share *= 0.5 ** (best + 1) if good[best] else 0.5 ** (HALVINGS - 1)
    raise ValueError(f"no arc follows the curve at {start:g}")


def _arcs_from(curve: Callable[[Array], Array], start: float, ends: Array, tolerance: float, count: int) -> tuple[NDArray[np.bool_], Array]:
    """Return which arcs from one parameter to several others (n,) follow the curve closely at ``count`` points (n,), and their bulges (n,)."""
    # close together at both ends, where a curve may be bent most
    share = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    parameters = start + (ends - start)[:, None] * share
    samples = curve(parameters.ravel()).reshape(len(ends), -1, 2)
    chord = samples[:, -1] - samples[:, 0]
    length = np.maximum(np.hypot(*chord.T), SAME_POINT_MM)[:, None]
    along = chord / length
    offset = samples - samples[:, :1]
    x = np.einsum("ijk,ik->ij", offset, along)
    y = offset[..., 1] * along[:, :1] - offset[..., 0] * along[:, 1:]
    # circles through both ends: q (x² - length x + y²) = y, where q is half the curvature's share and 0 for a straight line
    middle = np.argmin(abs(x - length / 2), axis=1)[:, None]
    middle_x, middle_y = np.take_along_axis(x, middle, 1), np.take_along_axis(y, middle, 1)
    power = middle_x**2 - length * middle_x + middle_y**2
    q = np.where(abs(middle_y) < STRAIGHT_MM, 0.0, middle_y / np.where(power < 0, power, -SAME_POINT_MM))
    to_centre = np.hypot(q * (x - length / 2), q * y - 0.5)
    distance = (q * (x**2 - length * x + y**2) - y) / (to_centre + np.hypot(q * length / 2, 0.5))
    no_turning_back = (x > -STRAIGHT_MM).all(axis=1) & (x < length + STRAIGHT_MM).all(axis=1) & (power[:, 0] < 0)
    forward = (np.diff(x, axis=1) > -STRAIGHT_MM).all(axis=1)
    good = (abs(distance).max(axis=1) <= 0.9 * tolerance) & no_turning_back & forward
    turn = q * length
    return good, (turn / (1 + np.sqrt(1 + turn**2)))[:, 0]


def _segment_shares(bulges: Array) -> Array:
    """Return the areas between arcs and their chords, in squares of the chords: (turn - sin turn) r² / 2."""
    small = abs(bulges) < SERIES_BELOW
    safe = np.where(small, 1.0, bulges)
    turn = 4 * np.arctan(safe)
    return np.where(small, bulges / 3 + bulges**3 / 15, (turn - np.sin(turn)) * (1 + safe**2) ** 2 / (32 * safe**2))


def _circles(starts: Array, ends: Array, bulges: Array) -> tuple[Array, Array]:
    """Return centres (n, 2) and radii (n,) of arcs."""
    along = ends - starts
    left = np.column_stack([-along[:, 1], along[:, 0]])
    centres = (starts + ends) / 2 + left * ((1 - bulges**2) / (4 * bulges))[:, None]
    return centres, np.hypot(*(starts - centres).T)
