# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the colours of components say: their kind, how well they fit the images, or their level of accuracy."""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

from pipeworkbench.exports.kinds import COLOURS, material_colour
from pipeworkbench.features.component import NONE
from pipeworkbench.features.preferences import Preferences, preferences

Colour = tuple[float, float, float]  # red, green, blue from 0 to 1

# told apart by colour-blind people too (Okabe and Ito): from good to bad
GOOD, FAIR, POOR, BAD = (0.0, 0.62, 0.45), (0.34, 0.71, 0.91), (0.94, 0.89, 0.26), (0.84, 0.37, 0.0)
# USIBD's levels of accuracy as 2 sigma in mm; LOA 10 is what is coarser than LOA 20
LEVELS = {
    "LOA50": ("LOA 50, up to 1 mm", (0.0, 0.45, 0.70)),
    "LOA40": ("LOA 40, 1 to 5 mm", GOOD),
    "LOA30": ("LOA 30, 5 to 15 mm", FAIR),
    "LOA20": ("LOA 20, 15 to 50 mm", POOR),
    "LOA10": ("LOA 10, over 50 mm", BAD),
}


WARNING_TEXT, BAD_TEXT = "#c05000", "#c0392b"  # legible on light and dark themes


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
    chosen = preferences()
    if mode == "quality":
        return quality_colour(obj.Quality if obj.Quality >= 0 else None, chosen)
    if mode == "loa":
        return LEVELS.get(obj.LevelOfAccuracy, ("", chosen.unknown_colour))[1]
    return chosen.approximate_colour if getattr(obj, "Approximate", False) else chosen.kind_colour(obj.Proxy.kind.kind)


def insulation_colour(jacket: str, material: str) -> Colour:
    """Return the colour of insulation: its jacket's, its material's where there is none ("none")."""
    return material_colour(material) if jacket == NONE else material_colour(jacket, jacket=True)


def legend_of(mode: str) -> list[LegendEntry]:
    """Return what the colours of a mode ("kind", "quality" or "loa") say, in English."""
    chosen = preferences()
    if mode == "quality":
        limits = [limit for limit, _ in chosen.quality_scale]
        texts = [
            f"up to {limits[0]:g} px",
            *(f"{low:g} to {high:g} px" for low, high in itertools.pairwise(limits[:-1])),
            f"over {limits[-2]:g} px",
        ]
        entries = [LegendEntry(text, colour) for text, (_, colour) in zip(texts, chosen.quality_scale, strict=True)]
        return [*entries, LegendEntry("not measured", chosen.unknown_colour)]
    if mode == "loa":
        return [*(LegendEntry(text, colour) for text, colour in LEVELS.values()), LegendEntry("not known", chosen.unknown_colour)]
    return [
        *(LegendEntry(kind.__name__, chosen.kind_colour(kind.kind)) for kind in COLOURS),
        LegendEntry("Approximate pipe", chosen.approximate_colour),
    ]


def quality_colour(quality: float | None, chosen: Preferences) -> Colour:
    """Return the colour of an RMS distance to the image edges in px (the paper's Eq. 4), None where it was not measured."""
    return chosen.unknown_colour if quality is None else next(colour for limit, colour in chosen.quality_scale if limit >= quality)


def hex_of(colour: Colour) -> str:
    """Return a colour as Qt and HTML write it."""
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)


def rgb_of(text: str) -> Colour:
    """Return the colour that Qt and HTML write as ``#rrggbb``."""
    red, green, blue = (int(text[place : place + 2], 16) / 255 for place in (1, 3, 5))
    return red, green, blue
