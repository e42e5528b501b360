# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the colours of components say: their kind, how well they fit the images, or their level of accuracy."""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

from pipeworkbench.exports.kinds import COLOURS

Colour = tuple[float, float, float]  # red, green, blue from 0 to 1

APPROXIMATE: Colour = (0.90, 0.62, 0.0)
UNKNOWN: Colour = (0.62, 0.62, 0.62)
# told apart by colour-blind people too (Okabe and Ito): from good to bad
GOOD, FAIR, POOR, BAD = (0.0, 0.62, 0.45), (0.34, 0.71, 0.91), (0.94, 0.89, 0.26), (0.84, 0.37, 0.0)
# upper limits of the RMS distance to the image edges in pixels (the paper's Eq. 4); beyond the last one the component is doubtful
QUALITY_PX = ((0.3, GOOD), (0.6, FAIR), (1.0, POOR), (math.inf, BAD))
# USIBD's levels of accuracy as 2 sigma in mm; LOA 10 is what is coarser than LOA 20
LEVELS = {
    "LOA50": ("LOA 50, up to 1 mm", (0.0, 0.45, 0.70)),
    "LOA40": ("LOA 40, 1 to 5 mm", GOOD),
    "LOA30": ("LOA 30, 5 to 15 mm", FAIR),
    "LOA20": ("LOA 20, 15 to 50 mm", POOR),
    "LOA10": ("LOA 10, over 50 mm", BAD),
}


class LegendEntry(NamedTuple):
    """A colour and what it says."""

    text: str
    colour: Colour


def colour_of(obj: Any, mode: str) -> Colour:
    """Return the colour of a component object.

    Parameters
    ----------
    obj : document object
    mode : str
        "kind", "quality" or "loa".
    """
    if mode == "quality":
        return next(colour for limit, colour in QUALITY_PX if limit >= obj.Quality) if _is_measured(obj) else UNKNOWN
    if mode == "loa":
        return LEVELS.get(obj.LevelOfAccuracy, ("", UNKNOWN))[1]
    return APPROXIMATE if getattr(obj, "Approximate", False) else COLOURS[obj.Proxy.kind]


def legend_of(mode: str) -> list[LegendEntry]:
    """Return what the colours of a mode ("kind", "quality" or "loa") say, in English."""
    if mode == "quality":
        limits = [limit for limit, _ in QUALITY_PX]
        texts = [
            f"up to {limits[0]:g} px",
            *(f"{low:g} to {high:g} px" for low, high in itertools.pairwise(limits[:-1])),
            f"over {limits[-2]:g} px",
        ]
        entries = [LegendEntry(text, colour) for text, (_, colour) in zip(texts, QUALITY_PX, strict=True)]
        return [*entries, LegendEntry("not measured", UNKNOWN)]
    if mode == "loa":
        return [*(LegendEntry(text, colour) for text, colour in LEVELS.values()), LegendEntry("not known", UNKNOWN)]
    return [*(LegendEntry(kind.__name__, colour) for kind, colour in COLOURS.items()), LegendEntry("Approximate pipe", APPROXIMATE)]


def _is_measured(obj: Any) -> bool:
    return bool(obj.Quality >= 0)
