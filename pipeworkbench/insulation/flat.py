# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat parts of sheet metal: outlines of straight lines and arcs, marks and texts, in mm in the plane of the sheet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.coverings import Sheet

MarkLayer = Literal["MARK", "FOLD", "CENTRE"]


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


@dataclass(frozen=True)
class Text:
    """A text on the sheet: its lower left corner (mm), the height of its capitals (mm), the angle of its line (deg)."""

    text: str
    position: tuple[float, float]
    height: float
    angle_deg: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Pattern:
    """One part to be cut, seen from the outside of the finished jacket.

    ``covering`` and ``component`` name what it belongs to; ``kind`` says what it is: "jacket", "gore", "cone", "branch",
    "run", "disc", "box mantle", "box face". ``net_area`` (mm²) is that of the rolled-up part's neutral fibre without overlaps, slits
    closed; ``outline`` and ``holes`` are cut, ``marks`` scribed (layer and path), ``texts`` engraved. ``grain`` says whether the part
    may be turned by 90 degrees on the sheet ("any") or only by 180 ("along"); ``quantity`` is how many of it are needed.
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
