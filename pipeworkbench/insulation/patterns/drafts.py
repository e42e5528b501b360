# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts before they have a number: what the shapes' modules hand over, and how it becomes engraved patterns."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.insulation.flat import MarkLayer, Path, Pattern, Text, turned
from pipeworkbench.insulation.treatment import SheetSize
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import Covering, Sheet

TEXT_HEIGHTS_MM = (10.0, 7.0, 5.0, 3.5, 2.5, 1.8)  # the greatest that fits is engraved
LETTER_WIDTH = 1.0  # of a line in heights of its capitals, at most: stroke fonts advance by so much for each letter
LINE_PITCH = 1.6  # from line to line in heights of capitals
TEXT_CLEARANCE = 0.4  # around texts in heights of capitals
BORDER_POINTS = 17  # of each side of a block of text, that must lie on the part; odd
PLACES = 5  # in each direction, that are tried for texts
LEGIBLE_MM = 3.5  # height of texts that rather lie beside marks than be larger
MARK_CHORD_MM = 0.5  # of the straight pieces that marks are taken for
PARALLEL = 1e-12  # mm, in place of nothing

Marks = tuple[Array, Array]


@dataclass(frozen=True, eq=False, kw_only=True)
class Draft:
    """A part without id: as ``Pattern``; ``lines`` are engraved below its id, best about ``middle`` (mm) where they fit there."""

    kind: str
    outline: Path
    net_area: float
    holes: tuple[Path, ...] = ()
    marks: tuple[tuple[MarkLayer, Path], ...] = ()
    lines: tuple[str, ...] = ()
    middle: tuple[float, float] | None = None
    quantity: int = 1
    grain: Literal["any", "along"] = "any"
    remarks: tuple[str, ...] = ()

    def moved(self, angle_deg: float = 0.0, shift: tuple[float, float] = (0.0, 0.0)) -> Draft:
        """Return the part turned about the origin and then shifted (mm)."""
        middle = None if self.middle is None else turned(np.array([self.middle]), angle_deg)[0] + np.asarray(shift)
        return Draft(
            kind=self.kind,
            outline=self.outline.moved(angle_deg, shift),
            net_area=self.net_area,
            holes=tuple(hole.moved(angle_deg, shift) for hole in self.holes),
            marks=tuple((layer, mark.moved(angle_deg, shift)) for layer, mark in self.marks),
            lines=self.lines,
            middle=None if middle is None else (float(middle[0]), float(middle[1])),
            quantity=self.quantity,
            grain=self.grain,
            remarks=self.remarks,
        )


def numbered(drafts: Iterable[Draft], covering: Covering, sheet: Sheet) -> tuple[Pattern, ...]:
    """Return the drafts of a covering as patterns: ids ``<covering>-1`` and so on, engraved."""
    patterns = []
    for number, draft in enumerate(drafts, 1):
        name = f"{covering.id}-{number}"
        lines = (name if covering.component in covering.id else f"{name} {covering.component}", *draft.lines)
        texts = engraved(draft, lines)
        remarks = draft.remarks if texts else (*draft.remarks, "too small to be engraved")
        patterns.append(
            Pattern(
                id=name,
                covering=covering.id,
                component=covering.component,
                kind=draft.kind,
                outline=draft.outline.counter_clockwise(),
                sheet=sheet,
                net_area=draft.net_area,
                holes=draft.holes,
                marks=draft.marks,
                texts=texts,
                quantity=draft.quantity,
                grain=draft.grain,
                remarks=remarks,
            )
        )
    return tuple(patterns)


def engraved(draft: Draft, lines: tuple[str, ...]) -> tuple[Text, ...]:
    """Return lines of text where they lie within the outline and beside the holes: large ones first, then the first line alone.

    Legible ones lie beside the marks where there is such a place; else they go across them.
    """
    left, bottom, right, top = draft.outline.bounds
    grid = [np.linspace(low, high, PLACES + 2)[1:-1] for low, high in ((left, right), (bottom, top))]
    places = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    middle = np.array(draft.middle if draft.middle is not None else ((left + right) / 2, (bottom + top) / 2))
    places = np.vstack([middle, places[np.argsort(np.hypot(*(places - middle).T), kind="stable")]])
    marks = _straight_pieces(draft)
    across: Marks = np.zeros((0, 2)), np.zeros((0, 2))
    legible = [height for height in TEXT_HEIGHTS_MM if height >= LEGIBLE_MM]
    for chosen, heights, beside in ((lines, legible, marks), (lines, TEXT_HEIGHTS_MM, across), (lines[:1], TEXT_HEIGHTS_MM, across)):
        for height, angle_deg in itertools.product(heights, (0.0, 90.0)):
            box = _box(chosen, height, angle_deg)
            # most texts fit into the middle
            place = _place(draft, places[:1], box, beside)
            place = _place(draft, places[1:], box, beside) if place is None else place
            if place is not None:
                return _block(chosen, height, angle_deg, place)
    return ()


def _straight_pieces(draft: Draft) -> Marks:
    """Return the starts and ends (n, 2) mm of straight pieces of a part's marks."""
    sampled = [(mark.sampled(MARK_CHORD_MM), mark.closed) for _, mark in draft.marks]
    starts = [points if closed else points[:-1] for points, closed in sampled]
    ends = [np.roll(points, -1, axis=0) if closed else points[1:] for points, closed in sampled]
    return (np.concatenate(starts), np.concatenate(ends)) if sampled else (np.zeros((0, 2)), np.zeros((0, 2)))


def _crossed(low: Array, high: Array, marks: Marks) -> bool:
    """Return whether any straight piece enters a rectangle between two corners (2,): its shares within both pairs of sides overlap."""
    starts, ends = marks
    along = ends - starts
    safe = np.where(along == 0, PARALLEL, along)
    one, other = (low - starts) / safe, (high - starts) / safe
    first, last = np.minimum(one, other).max(axis=1), np.maximum(one, other).min(axis=1)
    return bool(np.any((first <= last) & (last >= 0) & (first <= 1)))


def _box(lines: tuple[str, ...], height: float, angle_deg: float) -> Array:
    """Return the border (n, 2) of a block of text about its middle."""
    width = max(len(line) for line in lines) * LETTER_WIDTH * height
    x, y = width / 2 + TEXT_CLEARANCE * height, ((len(lines) - 1) * LINE_PITCH + 1) * height / 2 + TEXT_CLEARANCE * height
    share = np.linspace(-1, 1, BORDER_POINTS)
    ones = np.ones(len(share))
    border = np.concatenate([np.column_stack(pair) for pair in ((share, ones), (share, -ones), (ones, share), (-ones, share))])
    return turned(border * (x, y), angle_deg)


def _place(draft: Draft, places: Array, box: Array, marks: Marks) -> Array | None:
    """Return the first place about which a box, given by its border, lies within a part and beside marks."""
    # corners and middles of sides rule most places out
    rough = box[:: (BORDER_POINTS - 1) // 2]
    hopeful = _free(draft, (places[:, None] + rough).reshape(-1, 2)).reshape(len(places), -1).all(axis=1)
    low, high = box.min(axis=0), box.max(axis=0)
    for place in places[hopeful]:
        # a small hole may lie within the box and touch none of its border's points
        bounds = (hole.bounds for hole in draft.holes)
        hit = any((place + low < (b[2], b[3])).all() and (place + high > (b[0], b[1])).all() for b in bounds)
        if not hit and not _crossed(place + low, place + high, marks) and _free(draft, place + box).all():
            return np.asarray(place)
    return None


def _free(draft: Draft, points: Array) -> NDArray[np.bool_]:
    """Return which points lie on a part, outside of its holes."""
    free = draft.outline.contains(points)
    for hole in draft.holes:
        free = free & ~hole.contains(points)
    return free


def _block(lines: tuple[str, ...], height: float, angle_deg: float, middle: Array) -> tuple[Text, ...]:
    """Return lines of text as a block about its middle."""
    width = max(len(line) for line in lines) * LETTER_WIDTH * height
    tall = ((len(lines) - 1) * LINE_PITCH + 1) * height
    corners = np.array([(-width / 2, tall / 2 - height - k * LINE_PITCH * height) for k in range(len(lines))])
    return tuple(Text(line, (float(x), float(y)), height, angle_deg) for line, (x, y) in zip(lines, middle + turned(corners, angle_deg), strict=True))


def usable(size: SheetSize) -> tuple[float, float]:
    """Return the width and the height (mm) of what can be cut from a sheet between its margins."""
    return size.width - 2 * size.margin, size.height - 2 * size.margin


def fits(draft: Draft, size: SheetSize | None) -> bool:
    """Return whether a part can be cut from a sheet, turned by 90 degrees too where its grain lets it."""
    if size is None:
        return True
    left, bottom, right, top = draft.outline.bounds
    width, height = usable(size)
    lengthwise = right - left <= width and top - bottom <= height
    across = draft.grain == "any" and right - left <= height and top - bottom <= width
    return lengthwise or across
