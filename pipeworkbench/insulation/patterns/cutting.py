# SPDX-License-Identifier: LGPL-2.1-or-later
"""Openings cut out of outlines: closed ones become holes, those across the edge change the outline."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.insulation.flat import MarkLayer, Path, joined
from pipeworkbench.insulation.patterns.openings import Opening
from pipeworkbench.recon.camera import Array

Mark = tuple[MarkLayer, Path]

CHORD_ERROR_MM = 0.005  # of the polygons whose crossings are looked for
LEAST_WEB_MM = 1.0  # of sheet between two openings, or an opening and the border
ROUNDING = 1e-9
SHORTEST_CUT_MM = 0.05  # pieces of an outline that are shorter are left out


@dataclass(frozen=True, eq=False)
class Cut:
    """An outline with its holes."""

    outline: Path
    holes: tuple[Path, ...] = ()


@dataclass(frozen=True, eq=False)
class Opened:
    """A part with all its openings: what is cut, the net area they take (mm²), the marks that are left and what is to be said of it."""

    cut: Cut
    taken: float
    marks: tuple[Mark, ...]
    remarks: tuple[str, ...]


def opened(outline: Path, net: Path, openings: Iterable[Opening], marks: tuple[Mark, ...]) -> Opened:
    """Return an outline without openings, and its marks as far as they lie within it; ``net`` is the outline without overlaps.

    Openings that would part it, meet another one or leave webs that would not hold are marked and named in a remark. They take
    nothing then. Overlaps that are parted from the rest fall away.
    """
    cut, rest, taken = Cut(outline), [net], 0.0
    left: list[Path] = []
    remarks: list[str] = []
    for opening in openings:
        path = opening.path
        if path is None:
            remarks.append(f"the opening for {opening.cause}, all around, is to be cut on site")
            continue
        result = cut_out(cut, path, net)
        if result is None:
            left.append(path)
            remarks.append(f"the opening for {opening.cause} is marked and to be cut on site")
            continue
        cut = result
        closed = opening.net or path
        before = sum(piece.area for piece in rest)
        hole = sum(closed.area for piece in rest if not len(_crossings(piece, closed)) and piece.contains(closed.points[:1])[0])
        rest = [part for piece in rest for part in _remaining(piece, closed)]
        taken += abs(hole) + before - sum(piece.area for piece in rest)
    whole = (*marks, *(("MARK", path) for path in left))
    trimmed = left or cut.outline is not outline
    kept = tuple((layer, piece) for layer, mark in whole for piece in clipped(mark, cut.outline)) if trimmed else marks
    return Opened(cut, taken, kept, tuple(dict.fromkeys(remarks)))


def cut_out(cut: Cut, opening: Path, net: Path) -> Cut | None:
    """Return a part without an opening, a closed path: itself where that lies beside it, None where it cannot be cut.

    An opening inside becomes a hole; one that crosses the outline trims it. What else is parted from the largest piece falls away
    if nothing of it lies within ``net``; otherwise the opening cannot be cut. Nor can it where it meets another hole, leaves a web
    that would not hold, or nothing.
    """
    opening = opening.counter_clockwise()
    if any(_web(hole, opening) < LEAST_WEB_MM for hole in cut.holes):
        return None
    if len(_crossings(cut.outline, opening)):
        return _trimmed(cut, opening, net)
    if not cut.outline.contains(opening.points[:1])[0]:
        return None if opening.contains(cut.outline.points[:1])[0] else cut
    if any(hole.contains(opening.points[:1])[0] for hole in cut.holes):
        return cut
    return replace(cut, holes=(*cut.holes, opening)) if _web(cut.outline, opening) >= LEAST_WEB_MM else None


def _trimmed(cut: Cut, opening: Path, net: Path) -> Cut | None:
    """Return a part without an opening that crosses its outline, None where pieces would be lost."""
    pieces = sorted(_parted(cut.outline, opening), key=lambda piece: -piece.area)
    if not pieces or any(net.contains(_inner_points(piece)).any() for piece in pieces[1:]):
        return None
    return Cut(pieces[0], tuple(hole for hole in cut.holes if pieces[0].contains(hole.points[:1])[0]))


def _remaining(piece: Path, opening: Path) -> list[Path]:
    """Return the outlines of what remains of a piece, holes not counted."""
    opening = opening.counter_clockwise()
    if len(_crossings(piece, opening)):
        return _parted(piece, opening) or [piece]
    return [] if opening.contains(piece.points[:1])[0] else [piece]


def _inner_points(piece: Path) -> Array:
    """Return points on a border, moved a little inwards."""
    points = piece.sampled(CHORD_ERROR_MM)
    along = np.roll(points, -1, axis=0) - points
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(np.hypot(*along.T), ROUNDING)[:, None]
    inwards: Array = points + along / 2 + SHORTEST_CUT_MM * normal
    return inwards


def crosses_itself(path: Path) -> bool:
    """Return whether a closed path crosses itself, to 0.05 mm."""
    points = path.sampled(0.05)
    along = np.roll(points, -1, axis=0) - points
    gap = points[None] - points[:, None]
    across = along[:, None, 0] * along[None, :, 1] - along[:, None, 1] * along[None, :, 0]
    safe = np.where(across == 0, np.inf, across)
    s = (gap[..., 0] * along[None, :, 1] - gap[..., 1] * along[None, :, 0]) / safe
    t = (gap[..., 0] * along[:, None, 1] - gap[..., 1] * along[:, None, 0]) / safe
    index = np.arange(len(points))
    apart = abs(index[:, None] - index)
    neighbours = np.minimum(apart, len(points) - apart) <= 1
    return bool(np.any(~neighbours & (across != 0) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)))


def _web(border: Path, opening: Path) -> float:
    """Return the least distance (mm) between two closed paths, as polygons."""
    points, corners = opening.sampled(CHORD_ERROR_MM), border.sampled(CHORD_ERROR_MM)
    least = [_distances(points, corners), _distances(corners, points)]
    return 0.0 if len(_crossings(border, opening)) else min(float(part.min()) for part in least)


def _distances(points: Array, corners: Array) -> Array:
    """Return the distances (n, m) of points from the sides of a polygon."""
    along = np.roll(corners, -1, axis=0) - corners
    square = np.maximum(np.sum(along**2, axis=1), 1e-18)
    gap = points[:, None] - corners
    share = np.clip(np.einsum("ijk,jk->ij", gap, along) / square, 0.0, 1.0)
    distances: Array = np.linalg.norm(gap - share[..., None] * along, axis=-1)
    return distances


def clipped(mark: Path, outline: Path) -> list[Path]:
    """Return the pieces of a mark that lie within an outline."""
    places = np.sort(_crossings(outline, mark)[:, 2:].sum(axis=1))
    if not len(places):
        return [mark] if outline.contains(_middle(mark))[0] else []
    if mark.closed:
        starts, ends = places, np.roll(places, -1)
    else:
        starts, ends = np.append(0.0, places), np.append(places, float(len(mark.points) - 1))
    # a place that is a whole number begins a segment, the path's very end belongs to its last
    last = len(mark.segments[2]) - 1
    pieces = []
    for start, end in zip(starts, ends, strict=True):
        if mark.closed or end - start > ROUNDING:
            places_on = [(min(np.floor(place), last), place - min(np.floor(place), last)) for place in (start, end)]
            pieces.append(_between(mark, *places_on[0], *places_on[1]))
    return [piece for piece in pieces if outline.contains(_middle(piece))[0]]


def _crossings(outline: Path, other: Path) -> Array:
    """Return where a closed path is crossed by another, a row each: segment and share of it on the first, then on the second."""
    (a, a_segment, a_share), (b, b_segment, b_share) = (path.samples(CHORD_ERROR_MM) for path in (outline, other))
    a_along, b_along = np.roll(a, -1, axis=0) - a, np.roll(b, -1, axis=0) - b
    if not other.closed:
        b_along[-1] = 0.0
    gap = b[None] - a[:, None]
    across = a_along[:, None, 0] * b_along[None, :, 1] - a_along[:, None, 1] * b_along[None, :, 0]
    safe = np.where(across == 0, np.inf, across)
    s = (gap[..., 0] * b_along[None, :, 1] - gap[..., 1] * b_along[None, :, 0]) / safe
    t = (gap[..., 0] * a_along[:, None, 1] - gap[..., 1] * a_along[:, None, 0]) / safe
    i, j = np.nonzero((across != 0) & (s >= 0) & (s < 1) & (t >= 0) & (t < 1))

    a_place = a_share[i] + s[i, j] * (_next_shares(a_share) - a_share)[i]
    b_place = b_share[j] + t[i, j] * (_next_shares(b_share) - b_share)[j]
    return np.column_stack([a_segment[i], a_place, b_segment[j], b_place])


def _next_shares(shares: Array) -> Array:
    """Return the shares of the following samples, 1 where these begin the next segment."""
    following = np.roll(shares, -1)
    return np.where(following == 0, 1.0, following)


def _parted(outline: Path, opening: Path) -> list[Path]:
    """Return the pieces, counter-clockwise, of what an opening that crosses an outline leaves of it; none where they cannot be told.

    Pieces of the outline outside the opening are followed by pieces of the opening inside the outline, backwards.
    """
    crossings = _crossings(outline, opening)
    along, across = np.argsort(crossings[:, 0] + crossings[:, 1]), np.argsort(crossings[:, 2] + crossings[:, 3])
    kept: dict[int, tuple[int, Path]] = {}
    for i, j in zip(along, np.roll(along, -1), strict=True):
        piece = _between(outline, *crossings[i, :2], *crossings[j, :2])
        if not opening.contains(_middle(piece))[0]:
            kept[int(i)] = (int(j), piece)
    back: dict[int, tuple[int, Path]] = {}
    for i, j in zip(across, np.roll(across, -1), strict=True):
        piece = _between(opening, *crossings[i, 2:], *crossings[j, 2:])
        if outline.contains(_middle(piece))[0]:
            back[int(j)] = (int(i), piece.reversed())
    if {end for end, _ in kept.values()} != set(back) or {end for end, _ in back.values()} != set(kept):
        return []
    pieces = []
    while kept:
        here, chain = next(iter(kept)), list[Path]()
        while here in kept:
            turn, edge = kept.pop(here)
            here, border = back[turn]
            # both were sampled: their ends agree to the chord error, the outline's are taken
            following = kept[here][1].points[0] if here in kept else (chain[0] if chain else edge).points[0]
            points = np.vstack([edge.points[-1], border.points[1:-1], following])
            chain += [edge, Path(points, border.bulges, closed=False)]
        pieces.append(joined(*chain))
    return [piece for piece in pieces if piece.area > SHORTEST_CUT_MM]


def _middle(path: Path) -> Array:
    points = path.sampled(CHORD_ERROR_MM)
    k = len(points) // 2
    return (points[k - 1 : k] + points[k : k + 1]) / 2


def _between(path: Path, first: float, first_share: float, last: float, last_share: float) -> Path:
    """Return the part of a closed path from one place on it, a segment and a share of it, forwards to another."""
    n = len(path.points)
    begin, end = first + first_share, last + last_share
    end = end if end > begin else end + n
    knots = np.array([begin, *np.arange(np.floor(begin) + 1, np.ceil(end)), end])
    segment = np.floor((knots[:-1] + knots[1:]) / 2).astype(int)
    shares = np.diff(knots)
    last_point = path.at(np.array([segment[-1] % n]), np.array([end - segment[-1]]))
    points = np.vstack([path.at(segment % n, knots[:-1] - segment), last_point])
    bulges = np.append(np.tan(shares * np.arctan(path.bulges[segment % n])), 0.0)
    return Path(points, bulges, closed=False)
