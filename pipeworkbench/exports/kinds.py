# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a component is called and which colour it has, alike in all formats."""

from __future__ import annotations

import re

from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee

Colour = tuple[float, float, float]  # red, green, blue from 0 to 1 (sRGB)

# steel for pipes, told apart without gaudiness for the rest
COLOURS: dict[type[AnyComponent], Colour] = {
    Pipe: (0.55, 0.63, 0.70),
    Elbow: (0.44, 0.58, 0.72),
    Flange: (0.36, 0.42, 0.50),
    Tee: (0.47, 0.65, 0.60),
    Reducer: (0.66, 0.61, 0.50),
    Cap: (0.60, 0.52, 0.58),
}
INSULATION_COLOUR: Colour = (0.85, 0.82, 0.72)
JACKET_COLOUR: Colour = (0.76, 0.78, 0.80)
# colours of materials in whose name a word begins so, in lower case; the first that fits
MATERIAL_COLOURS: tuple[tuple[tuple[str, ...], Colour], ...] = (
    (("elastomer", "rubber", "kautschuk", "nbr", "epdm"), (0.27, 0.28, 0.30)),
    (("cellular glass", "foam glass", "schaumglas"), (0.36, 0.37, 0.40)),
    (("silicate", "silikat", "perlite", "perlit", "aerogel"), (0.91, 0.90, 0.87)),
    (("pur", "pir", "polyurethane", "polyisocyanurate", "phenolic", "polyethylene", "polystyrene", "foam"), (0.86, 0.77, 0.55)),
    (("glass wool", "glaswolle"), (0.88, 0.83, 0.60)),
    (("stone wool", "rock wool", "mineral", "steinwolle", "wool"), INSULATION_COLOUR),
    (("stainless", "1.4301", "1.4401", "1.4404", "1.4571", "edelstahl"), (0.72, 0.74, 0.75)),
    (("aluzinc", "galvan", "zinc", "verzink", "steel", "stahl"), (0.63, 0.66, 0.69)),
    (("alumin", "alu"), (0.79, 0.81, 0.83)),
    (("pvc", "plastic", "kunststoff"), (0.58, 0.60, 0.62)),
)
DISPLAY_COLOURS: dict[type[AnyComponent], str] = {
    Pipe: "blue grey",
    Elbow: "light blue",
    Flange: "dark grey",
    Tee: "grey green",
    Reducer: "beige",
    Cap: "mauve",
}


def size_of(component: AnyComponent) -> str:
    """Return ``DN 40`` where the nominal diameter is known, else the outside diameter."""
    return f"DN {component.dn}" if component.dn else f"{component.outer_diameter:g} mm"


def designation(component: AnyComponent) -> str:
    """Return what a component is in one phrase, such as ``Elbow DN 40, 90 deg, 3D (R 57 mm)``."""
    size = size_of(component)
    match component:
        case Pipe():
            return f"Pipe {size}"
        case Elbow():
            radius = f"R {component.bend_radius:g} mm"
            bend = f"{component.bend_type} ({radius})" if component.bend_type else radius
            return f"Elbow {size}, {component.angle_deg:.4g} deg, {bend}"
        case Flange():
            name = "Blind flange" if component.flange_type == BLIND_FLANGE else "Flange"
            return f"{name} {size}, type {component.flange_type}, PN {component.pn:g}"
        case Tee():
            kind = "Tee" if component.tee_type == "tee" else "Set-on branch"
            return f"{kind} {size}, branch {component.branch_diameter:g} mm"
        case Reducer():
            return f"Reducer {size} to {component.end_diameter:g} mm, {component.reducer_type}"
        case Cap():
            return f"Cap {size}"


def material_colour(material: str, *, jacket: bool = False) -> Colour:
    """Return the colour that a layer of insulation or a jacket is shown in: its material's, where its name says which that is."""
    name = material.casefold()
    found = (colour for words, colour in MATERIAL_COLOURS if any(re.search(rf"\b{re.escape(word)}", name) for word in words))
    return next(found, JACKET_COLOUR if jacket else INSULATION_COLOUR)


def equivalents_text(flange: Flange) -> str:
    """Return which other flanges have the same dimensions, such as ``DIN 2633 type 11 PN 16``; empty where there is none."""
    texts = []
    for other in flange.equivalents:
        kind, pressure = other.get("flange_type"), other.get("pn")
        parts = [other.get("standard"), f"type {kind}" if kind else None, f"PN {pressure:g}" if isinstance(pressure, int | float) else None]
        texts.append(" ".join(str(part) for part in parts if part))
    return "; ".join(filter(None, texts))
