# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rows of the tables of insulation: thicknesses, stock, jackets, distances, materials, sheet metal.

Every field is a column of the table of the same kind in ``standards/``, with ``verified``, ``unsourced`` and ``source`` as in
`records`. A band of diameters goes from ``from_diameter`` (exclusive) to ``to_diameter`` (inclusive); None is no bound.
"""

from __future__ import annotations

import functools
import itertools
import re
from dataclasses import dataclass

from pipeworkbench.catalogue.records import Grade, Problem, Record

LARGEST_CONDUCTIVITY = 1000.0  # W/(m K); more than any metal's: not given in W/(m K)
ABSOLUTE_ZERO = -273.15  # deg C
MEASURED_AT = ("inner", "outer")


def in_band(diameter: float, lower: float | None, upper: float | None) -> bool:
    """Tell whether a diameter (mm) lies in a band: above its lower bound, at most its upper one."""
    return (lower is None or diameter > lower) and (upper is None or diameter <= upper)


def _band_problem(lower: float | None, upper: float | None) -> Problem | None:
    if lower is not None and upper is not None and lower >= upper:
        return "from_diameter", f"is {lower:g}, not less than to_diameter {upper:g}"
    return None


@dataclass(frozen=True, kw_only=True)
class InsulationThickness(Record):
    """The thickness of insulation that a rule asks for in a band of diameters.

    The thickness (mm) is ``thickness``, or ``share_of_diameter`` times the diameter, or ``share_of_full`` times what the case
    "full" of the same standard asks for. ``conductivity`` (W/(m K), at ``conductivity_temperature``, deg C) is that of the
    insulation it is made for; None where it holds for any.
    """

    KEY = ("standard", "case", "from_diameter", "to_diameter")

    standard: str
    case: str = "full"
    measured_at: str = "outer"
    from_diameter: float | None = None
    to_diameter: float | None = None
    thickness: float | None = None
    share_of_diameter: float | None = None
    share_of_full: float | None = None
    conductivity: float | None = None
    conductivity_temperature: float | None = None
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a rule."""
        if self.measured_at not in MEASURED_AT:
            return "measured_at", f"is '{self.measured_at}', not inner or outer"
        given = [name for name in ("thickness", "share_of_diameter", "share_of_full") if getattr(self, name) is not None]
        if len(given) != 1:
            return "thickness", f"{len(given)} of thickness, share_of_diameter and share_of_full are given, not one"
        if self.share_of_full is not None and self.case == "full":
            return "share_of_full", "the case full is a share of itself"
        return _band_problem(self.from_diameter, self.to_diameter)


@dataclass(frozen=True, kw_only=True)
class StockThickness(Record):
    """A thickness (mm) that can be had from stock."""

    KEY = ("thickness",)

    thickness: float
    standard: str = ""
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return None: any thickness may be in stock."""
        return None


@dataclass(frozen=True, kw_only=True)
class JacketThickness(Record):
    """The least thickness (mm) of a jacket of a ``sheet`` metal in a band of finished outer diameters."""

    KEY = ("standard", "sheet", "from_diameter", "to_diameter")

    standard: str
    sheet: str
    thickness: float
    from_diameter: float | None = None
    to_diameter: float | None = None
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a jacket's."""
        return _band_problem(self.from_diameter, self.to_diameter)


@dataclass(frozen=True, kw_only=True)
class InsulationDistance(Record):
    """A least distance or overlap (mm); ``meaning`` says of what."""

    KEY = ("standard", "subject")

    standard: str
    subject: str
    distance: float
    meaning: str | None = None
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return None: any distance may be asked for."""
        return None


@dataclass(frozen=True, kw_only=True)
class InsulationMaterial(Record):
    """A material of insulation.

    ``conductivities`` are texts such as ``50:0.037``, the thermal conductivity (W/(m K)) at a mean temperature (deg C), by
    increasing temperature; ``density`` is in kg/m3, ``highest_temperature`` the service temperature in deg C.
    """

    KEY = ("name",)

    name: str
    conductivities: tuple[str, ...]
    density: float
    highest_temperature: float | None = None
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    @functools.cached_property
    def pairs(self) -> tuple[tuple[float, float], ...]:
        """Mean temperatures (deg C) and conductivities (W/(m K))."""
        return tuple((float(t), float(c)) for t, c in (text.split(":") for text in self.conductivities))

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a material's."""
        number = r"-?\d+(\.\d+)?"
        for text in self.conductivities:
            if not re.fullmatch(f"{number}:{number}", text, re.ASCII):
                return "conductivities", f"'{text}' is not a temperature and a conductivity such as 50:0.037"
        temperatures = [temperature for temperature, _ in self.pairs]
        if not self.pairs or any(a >= b for a, b in itertools.pairwise(temperatures)):
            return "conductivities", "the temperatures do not increase"
        if temperatures[0] <= ABSOLUTE_ZERO:
            return "conductivities", f"{temperatures[0]:g} deg C is below absolute zero"
        for _, conductivity in self.pairs:
            if not 0 < conductivity < LARGEST_CONDUCTIVITY:
                return "conductivities", f"{conductivity:g} is no thermal conductivity in W/(m K)"
        return None


@dataclass(frozen=True, kw_only=True)
class JacketSheet(Record):
    """Sheet metal: ``density`` (kg/m3) and ``emissivity`` of the surface (0 to 1)."""

    KEY = ("name",)

    name: str
    density: float
    emissivity: float
    verified: Grade = 0
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a sheet's."""
        if not 0 < self.emissivity <= 1:
            return "emissivity", f"is {self.emissivity:g}, not between 0 and 1"
        return None
