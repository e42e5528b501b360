# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts put onto sheets: their bounding boxes packed with rectpack, best of several ways.

Parts of one material and thickness share sheets. A part whose grain is "any" may stand upright, one "along" the grain only
turned by half a turn.
"""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.insulation.flat import Path, Pattern, Text
from pipeworkbench.insulation.treatment import SheetSize
from pipeworkbench.solids.coverings import Sheet

STEPS_PER_MM = 100  # rectpack counts in whole numbers: a hundredth of a millimetre, always rounded to the safe side
EFFORT = 200_000  # ways that are tried times parts times parts on a sheet: some seconds
ROUNDING = 1e-6  # mm


@dataclass(frozen=True, eq=False)
class Placed:
    """One piece on a sheet: its pattern turned about the origin by ``turn_deg``, then moved by ``position`` (mm).

    ``number`` counts the pieces of one pattern from 1 to its quantity.
    """

    pattern: Pattern
    number: int
    turn_deg: float
    position: tuple[float, float]

    def path(self, path: Path) -> Path:
        """Return one of the pattern's paths where it lies on the sheet."""
        return path.moved(self.turn_deg, self.position)

    def text(self, text: Text) -> Text:
        """Return one of the pattern's texts where it lies on the sheet."""
        return text.moved(self.turn_deg, self.position)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, least y, greatest x and greatest y (mm) of the outline on the sheet."""
        return self.path(self.pattern.outline).bounds


@dataclass(frozen=True, eq=False)
class NestedSheet:
    """One sheet with what is cut from it; ``number`` counts all sheets from 1, ``used`` is the share of its area that is parts."""

    number: int
    sheet: Sheet
    size: SheetSize
    parts: tuple[Placed, ...]
    used: float


@dataclass(frozen=True, eq=False)
class _Piece:
    """A piece to be packed: its corner of the least x and y, and its size (mm)."""

    pattern: Pattern
    number: int
    corner: tuple[float, float]
    width: float
    height: float

    @property
    def stances(self) -> list[tuple[float, float]]:
        """Its size lying and, where the grain does not matter, upright."""
        lying = (self.width, self.height)
        return [lying, lying[::-1]] if self.pattern.grain == "any" else [lying]


@dataclass(eq=False)
class _Bin:
    """A sheet being filled."""

    size: SheetSize
    packer: Any
    pieces: list[_Piece]


@dataclass(frozen=True)
class _Way:
    """One way of packing: rectpack's algorithm, the order of the pieces, the size of a new sheet that is preferred."""

    algorithm: str
    order: Callable[[_Piece], float]
    first_size: int


def nest(patterns: Sequence[Pattern], sizes: Sequence[SheetSize]) -> tuple[NestedSheet, ...]:
    """Put every piece of the patterns onto sheets, few and small ones.

    Parameters
    ----------
    patterns : sequence of Pattern
        Each counts as often as its ``quantity``.
    sizes : sequence of SheetSize
        What there is to cut from; pieces keep ``margin`` from the edge and ``spacing`` from each other.

    Returns
    -------
    tuple of NestedSheet
        By material and thickness, the fullest sheets first; the same input gives the same sheets.

    Raises
    ------
    InputError
        Where there is nothing to cut or no sheet, or a part is larger than all sheets: names it and the size it needs.
    MissingPackageError
        Where rectpack is not installed.
    """
    patterns = [pattern for pattern in patterns if pattern.quantity > 0]
    if not patterns:
        raise InputError("the sheets", "", "there is no part to be cut", "give the insulation a jacket of sheet metal")
    if not sizes:
        raise InputError("the sheets", "sheet_sizes", "there is no sheet to cut from", "give at least one size")
    by_sheet: dict[Sheet, list[Pattern]] = defaultdict(list)
    for pattern in patterns:
        refuse_too_large(pattern, sizes)
        by_sheet[pattern.sheet].append(pattern)
    found: list[NestedSheet] = []
    for sheet in sorted(by_sheet, key=lambda one: (one.material, one.thickness)):
        bins = _best(by_sheet[sheet], sizes)
        filled = [NestedSheet(0, sheet, one.size, parts, _used(parts, one.size)) for one in bins for parts in [_placed(one)]]
        found += sorted(filled, key=lambda one: -one.used)
    return tuple(replace(one, number=number) for number, one in enumerate(found, 1))


def refuse_too_large(pattern: Pattern, sizes: Sequence[SheetSize]) -> None:
    """Raise InputError where a part is larger than all sheets, or none at all: names it and the size it needs."""
    piece = _piece(pattern, 1)
    if not (0 < piece.width < math.inf and 0 < piece.height < math.inf):
        size = f"{piece.width:g} x {piece.height:g} mm"
        raise InputError(pattern.component, pattern.id, f"{size} make no part of sheet metal", "correct the dimensions of the component")
    if any(_fits(width, height, size) for size in sizes for width, height in piece.stances):
        return
    turned = " (its grain runs along the sheet)" if pattern.grain == "along" else ""
    largest = max(sizes, key=lambda size: size.width * size.height)
    needed = (piece.width + 2 * largest.margin, piece.height + 2 * largest.margin)
    raise InputError(
        pattern.component,
        pattern.id,
        f"the part of {piece.width:.0f} x {piece.height:.0f} mm{turned} is larger than every sheet",
        f"give a sheet of at least {math.ceil(needed[0])} x {math.ceil(needed[1])} mm, or divide the part (more gores, shorter pieces)",
    )


def _fits(width: float, height: float, size: SheetSize) -> bool:
    return _steps(width) <= _room(size.width, size) and _steps(height) <= _room(size.height, size)


def _steps(length: float) -> int:
    return math.ceil(length * STEPS_PER_MM - ROUNDING)


def _room(length: float, size: SheetSize) -> int:
    """Return what of a sheet's length is for parts, in steps."""
    return math.floor((length - 2 * size.margin) * STEPS_PER_MM + ROUNDING)


def _piece(pattern: Pattern, number: int) -> _Piece:
    left, bottom, right, top = pattern.outline.bounds
    return _Piece(pattern, number, (left, bottom), right - left, top - bottom)


def _best(patterns: Sequence[Pattern], sizes: Sequence[SheetSize]) -> list[_Bin]:
    """Return the packing with the least area of sheets, then the fewest sheets, then the largest rest on them."""
    pieces = [_piece(pattern, number) for pattern in patterns for number in range(1, pattern.quantity + 1)]
    ways = _ways(len(sizes))
    largest = max(size.width * size.height for size in sizes)
    on_a_sheet = min(len(pieces), largest * len(pieces) / sum(piece.width * piece.height for piece in pieces))
    ways = ways[: max(1, int(EFFORT / (len(pieces) * on_a_sheet)))]
    return min((_smaller(_packed(pieces, sizes, way), sizes) for way in ways), key=_cost)


def _ways(sizes: int) -> list[_Way]:
    orders: list[Callable[[_Piece], float]] = [
        lambda piece: piece.width * piece.height,
        lambda piece: max(piece.width, piece.height),
        lambda piece: piece.height,
        lambda piece: piece.width + piece.height,
        lambda piece: min(piece.width, piece.height),
    ]
    algorithms = ("MaxRectsBssf", "MaxRectsBl", "MaxRectsBaf")
    return [_Way(algorithm, order, first) for order, algorithm, first in itertools.product(orders, algorithms, range(sizes))]


def _cost(bins: list[_Bin]) -> tuple[float, int, float]:
    area = sum(one.size.width * one.size.height for one in bins)
    # what the parts of a sheet span: the rest can be cut off in one piece
    spanned = 0.0
    for one in bins:
        rectangles = one.packer.rectangles
        spanned += max(r.right for r in rectangles) * max(r.top for r in rectangles)
    return area, len(bins), spanned


def _packed(pieces: Sequence[_Piece], sizes: Sequence[SheetSize], way: _Way) -> list[_Bin]:
    """Pack pieces, the largest first, each into the sheet where it fits best; a new one where it fits in none."""
    bins: list[_Bin] = []
    for piece in sorted(pieces, key=way.order, reverse=True):
        if not any(_added(one, piece) for one in bins):
            bins.append(_new_bin(piece, sizes, way))
    return bins


def _new_bin(piece: _Piece, sizes: Sequence[SheetSize], way: _Way) -> _Bin:
    order = [sizes[way.first_size], *sizes]
    size = next(size for size in order if any(_fits(*stance, size) for stance in piece.stances))
    made = _Bin(size, _packer(size, way.algorithm), [])
    _added(made, piece)
    return made


def _packer(size: SheetSize, algorithm: str) -> Any:
    try:
        import rectpack
    except ImportError:
        raise MissingPackageError("rectpack", "Putting parts onto sheets", "pip install 'rectpack>=0.2.2,<0.3'") from None
    # every piece is larger by the spacing above and to the right: so is the sheet
    spacing = _steps(size.spacing)
    return getattr(rectpack, algorithm)(_room(size.width, size) + spacing, _room(size.height, size) + spacing, rot=False)


def _added(one: _Bin, piece: _Piece) -> bool:
    """Put a piece into a sheet in the stance that fits better, where it fits."""
    spacing = _steps(one.size.spacing)
    stances = [(_steps(width) + spacing, _steps(height) + spacing) for width, height in piece.stances]
    fitness = [(one.packer.fitness(*stance), index) for index, stance in enumerate(stances)]
    fitting = [(value, index) for value, index in fitness if value is not None]
    if not fitting:
        return False
    _, index = min(fitting)
    one.packer.add_rect(*stances[index], rid=(len(one.pieces), index))
    one.pieces.append(piece)
    return True


def _smaller(bins: list[_Bin], sizes: Sequence[SheetSize]) -> list[_Bin]:
    """Return the packing with each sheet replaced by a smaller one that takes the same parts, where there is one."""
    return [_smallest(one, sizes) for one in bins]


def _smallest(one: _Bin, sizes: Sequence[SheetSize]) -> _Bin:
    for size in sorted(sizes, key=lambda size: size.width * size.height):
        if size.width * size.height >= one.size.width * one.size.height:
            break
        other = _Bin(size, _packer(size, type(one.packer).__name__), [])
        if all(_added(other, piece) for piece in one.pieces):
            return other
    return one


def _placed(one: _Bin) -> tuple[Placed, ...]:
    """Return the pieces of a filled sheet, in the sheet's axes."""
    placed = []
    for rectangle in one.packer.rectangles:
        index, upright = rectangle.rid
        piece = one.pieces[index]
        x, y = (one.size.margin + step / STEPS_PER_MM for step in (rectangle.x, rectangle.y))
        left, bottom = piece.corner
        # a quarter turn makes the lower side the right one
        position = (x + bottom + piece.height, y - left) if upright else (x - left, y - bottom)
        placed.append(Placed(piece.pattern, piece.number, 90.0 if upright else 0.0, position))
    return tuple(placed)


def _used(parts: Iterable[Placed], size: SheetSize) -> float:
    return sum(part.pattern.cut_area for part in parts) / (size.width * size.height)
