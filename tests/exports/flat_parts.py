# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flat parts made by hand, whose areas are known."""

import math

import numpy as np

from pipeworkbench.insulation.flat import Path, Pattern, Text
from pipeworkbench.solids.coverings import Sheet

ALUMINIUM, STEEL = Sheet("aluminium", 0.8), Sheet("galvanised steel", 1.0)
ODD_ID = '=A1+"Rohr %%c ^J/äöüß\n\\U+0041'


def rectangle(name, width, height, **changes):
    """A rectangle from the origin."""
    values = {
        "id": name,
        "covering": name,
        "component": name.split(" ")[0],
        "kind": "jacket",
        "outline": Path.rectangle((0.0, 0.0), (width, height)),
        "sheet": ALUMINIUM,
        "net_area": width * height,
    }
    return Pattern(**(values | changes))


def jacket(name="P1 jacket", **changes):
    """600 x 300 mm with two rivet holes of 4 mm, a line of the overlap, a fold, a centre line and its id."""
    centres = ((10.0, 20.0), (10.0, 280.0))
    parts = {
        "holes": tuple(Path.circle(centre, 2.0) for centre in centres),
        "marks": (
            ("MARK", Path.line((30.0, 0.0), (30.0, 300.0))),
            ("FOLD", Path.line((0.0, 5.0), (600.0, 5.0))),
            ("CENTRE", Path.line((300.0, 0.0), (300.0, 300.0))),
        ),
        "texts": (Text(name, (60.0, 150.0), 8.0),),
        "net_area": 570.0 * 300.0,
        "grain": "along",
    }
    return rectangle(name, 600.0, 300.0, **(parts | changes))


def gore(name="E1 gore", quantity=3, **changes):
    """400 mm wide, its straight sides 40 mm high, above and below an arc with a rise of 30 mm."""
    bulge = 2 * 30.0 / 400.0
    outline = Path(np.array([(0.0, -20.0), (400.0, -20.0), (400.0, 20.0), (0.0, 20.0)]), np.array([bulge, 0.0, bulge, 0.0]))
    parts = {"outline": outline, "kind": "gore", "quantity": quantity, "net_area": gore_area()}
    return rectangle(name, 1.0, 1.0, **(parts | {"texts": (Text(name, (150.0, -4.0), 8.0),)} | changes))


def gore_area():
    """A rectangle and two segments of a circle, from chord and rise."""
    radius = (200.0**2 + 30.0**2) / (2 * 30.0)
    half = math.asin(200.0 / radius)
    return 400.0 * 40.0 + 2 * radius**2 * (half - math.sin(half) * math.cos(half))


def disc(name="F1 disc", **changes):
    """A ring of 100 and 60 mm radius, in steel."""
    outline, hole = Path.circle((0.0, 0.0), 100.0), Path.circle((0.0, 0.0), 60.0)
    area = math.pi * (100.0**2 - 60.0**2)
    return rectangle(
        name, 1.0, 1.0, **({"outline": outline, "holes": (hole,), "kind": "disc", "sheet": STEEL, "net_area": area, "quantity": 2} | changes)
    )
