# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation materials and sheet metal by name, from the tables ``insulation_materials`` and ``insulation_sheets`` and the user's."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from pipeworkbench.catalogue import InsulationMaterial, JacketSheet, catalogue
from pipeworkbench.errors import InputError
from pipeworkbench.files import MISSPELLING_SIMILARITY
from pipeworkbench.recon.camera import Array

DEFAULT_MATERIAL = "mineral wool"
DEFAULT_SHEET = "aluminium"

R = TypeVar("R", InsulationMaterial, JacketSheet)


@dataclass(frozen=True)
class Material:
    """What a layer is made of.

    ``points`` are mean temperatures (deg C) and thermal conductivities (W/(m K)) by increasing temperature. ``density`` is in
    kg/m3, ``highest_temperature`` the service temperature in deg C; both None where not known. ``verified`` is the number of
    independent sources of the conductivities, 2 for more.
    """

    name: str
    points: tuple[tuple[float, float], ...]
    density: float | None = None
    highest_temperature: float | None = None
    verified: int = 0

    @classmethod
    def constant(cls, name: str, conductivity: float) -> Material:
        """Return a material of one conductivity (W/(m K)) at all temperatures."""
        return cls(name, ((0.0, conductivity),))

    def conductivity(self, temperature_c: Array | float) -> Array:
        """Return the thermal conductivity.

        Straight lines between the points. Below the first point its conductivity is kept, above the last one the last line
        goes on: of materials that conduct better the hotter they are, neither is less than the truth is likely to be.

        Parameters
        ----------
        temperature_c : (...) array or float
            The layer's mean temperature in deg C.

        Returns
        -------
        (...) array
            In W/(m K).
        """
        temperatures, conductivities = np.array(self.points).T
        found = np.interp(temperature_c, temperatures, conductivities)
        if len(temperatures) == 1:
            return found
        slope = max((conductivities[-1] - conductivities[-2]) / (temperatures[-1] - temperatures[-2]), 0.0)
        return found + slope * np.maximum(np.asarray(temperature_c) - temperatures[-1], 0.0)

    def conductivity_at(self, temperature_c: float) -> float:
        """Return the thermal conductivity (W/(m K)) at one temperature (deg C): `conductivity` without arrays, which iterations are slowed by."""
        (low, low_conductivity), *others = self.points
        if temperature_c <= low or not others:
            return low_conductivity
        for high, high_conductivity in others:
            slope = (high_conductivity - low_conductivity) / (high - low)
            if temperature_c <= high:
                return low_conductivity + slope * (temperature_c - low)
            low, low_conductivity = high, high_conductivity
        return low_conductivity + max(slope, 0.0) * (temperature_c - low)

    @property
    def tabulated(self) -> tuple[float, float]:
        """The lowest and the highest mean temperature (deg C) that a conductivity is given for."""
        return self.points[0][0], self.points[-1][0]


@dataclass(frozen=True)
class SheetMetal:
    """What a jacket is made of: ``density`` in kg/m3, ``emissivity`` of its surface, ``verified`` as of `Material`."""

    name: str
    density: float
    emissivity: float
    verified: int = 0


def materials() -> tuple[Material, ...]:
    """Return all insulation materials of the catalogue in use."""
    return tuple(_material(record) for record in catalogue().records(InsulationMaterial))


def sheet_metals() -> tuple[SheetMetal, ...]:
    """Return all sheet metals of the catalogue in use."""
    return tuple(_sheet_metal(record) for record in catalogue().records(JacketSheet))


def material(name: str, source: object = "materials", key: str = "") -> Material:
    """Return the insulation material of a name, capitals and blanks at its ends left aside.

    Parameters
    ----------
    name : str
    source, key : optional
        What the message names where there is no such material.

    Raises
    ------
    InputError
        Where no table holds the name; with a name that looks like it.
    """
    return _material(_named(catalogue().records(InsulationMaterial), name, source, key, "insulation_materials"))


def sheet_metal(name: str, source: object = "materials", key: str = "") -> SheetMetal:
    """Return the sheet metal of a name; arguments and errors as of :func:`material`."""
    return _sheet_metal(_named(catalogue().records(JacketSheet), name, source, key, "insulation_sheets"))


def _material(record: InsulationMaterial) -> Material:
    return Material(record.name, record.pairs, record.density, record.highest_temperature, record.verified)


def _sheet_metal(record: JacketSheet) -> SheetMetal:
    return SheetMetal(record.name, record.density, record.emissivity, record.verified)


def _named(records: Iterable[R], name: str, source: object, key: str, table: str) -> R:
    known = {record.name.casefold(): record for record in records}
    wanted = name.strip().casefold()
    if wanted in known:
        return known[wanted]
    close = difflib.get_close_matches(wanted, known, 1, MISSPELLING_SIMILARITY)
    remedy = (
        f"did you mean '{known[close[0]].name}'?"
        if close
        else f"use one of {', '.join(r.name for r in known.values())}, or add it to a table {table}_..."
    )
    raise InputError(source, key, f"no material is called '{name}'", remedy)
