# SPDX-License-Identifier: LGPL-2.1-or-later
"""How thick a layer must be: by a table, a loss that is allowed, a surface that may be touched; and what can be had from stock."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, ClassVar, Final, Literal

from annotated_types import Ge, Le, MinLen

from pipeworkbench.catalogue import PIPE_STANDARD, InsulationThickness, JacketThickness, StockThickness, catalogue
from pipeworkbench.catalogue.insulation_records import in_band
from pipeworkbench.errors import InputError
from pipeworkbench.insulation.heat_loss import HeatFlow, Layers, pipe_heat_flow
from pipeworkbench.insulation.materials import Material
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.pipeline import Finite, NotNegative, Positive

GEG = "GEG Annex 8"
DIN_4140: Final = "DIN 4140"
FULL = "full"
THICKEST = 1000.0  # mm; up to which a thickness is searched
THINNEST = 10.0  # mm; from which on a thickness is searched
LEAST_LAYER = 1.0  # mm; what is thinner is no insulation
THICKNESS_TOLERANCE = 1e-6  # mm
ROUNDING = 1e-6  # mm; by which a thickness may miss a whole millimetre or a stock thickness
CONVERSION_COEFFICIENT = 10.0  # W/(m2 K), usual indoors: of the surface where a table's thickness is converted
CONVERSION_TEMPERATURE = 40.0  # deg C, where a table does not say which its conductivity is at
UNVERIFIED = "not verified against the standard"

LayerThickness = Annotated[Finite, Ge(LEAST_LAYER), Le(THICKEST)]


@dataclass(frozen=True, kw_only=True)
class TableRule:
    """A thickness after a table of ``insulation_thickness``, the law's (GEG) or the user's, converted to the layer's conductivity."""

    NAME: ClassVar[str] = "table"

    table: str = GEG
    case: str = FULL
    stock: bool = False


@dataclass(frozen=True, kw_only=True)
class Band:
    """A thickness (mm) for diameters above ``from_diameter`` up to ``to_diameter`` (mm)."""

    thickness: LayerThickness
    from_diameter: NotNegative = 0.0
    to_diameter: Positive | None = None

    def __post_init__(self) -> None:
        if self.to_diameter is not None and self.to_diameter <= self.from_diameter:
            raise ValueError("to_diameter is not more than from_diameter")


@dataclass(frozen=True, kw_only=True)
class BandsRule:
    """A thickness by the pipe's diameter; the first band that fits holds."""

    NAME: ClassVar[str] = "bands"

    bands: Annotated[tuple[Band, ...], MinLen(1)]
    measured_at: Literal["inner", "outer"] = "outer"


@dataclass(frozen=True, kw_only=True)
class HeatLossRule:
    """The thickness that lets through no more than ``at_most`` W per metre of the pipe."""

    NAME: ClassVar[str] = "heat loss"

    at_most: Positive
    stock: bool = False


@dataclass(frozen=True, kw_only=True)
class SurfaceTemperatureRule:
    """The thickness that keeps the surface at ``at_most`` deg C."""

    NAME: ClassVar[str] = "surface temperature"

    at_most: Finite
    stock: bool = False


Rule = TableRule | BandsRule | HeatLossRule | SurfaceTemperatureRule
RULES: dict[str, type[Rule]] = {kind.NAME: kind for kind in (TableRule, BandsRule, HeatLossRule, SurfaceTemperatureRule)}


@dataclass(frozen=True, kw_only=True)
class Situation:
    """Where a layer of unknown thickness lies.

    ``name`` is the component's; ``outer_diameter`` and ``wall_thickness`` (mm) the pipe's; ``inside`` and ``outside`` the layers
    beneath and above; ``emissivity`` that of the outer surface.
    """

    name: str
    outer_diameter: float
    material: Material
    wall_thickness: float | None = None
    inside: Layers = ()
    outside: Layers = ()
    operation: Operation = dataclasses.field(default_factory=Operation)
    emissivity: float = 0.9
    vertical: bool = False

    def flow(self, thickness: float) -> HeatFlow:
        """Return the heat flow per metre with the layer so thick (mm)."""
        if self.operation.medium_temperature is None:
            raise InputError(self.name, "operation.medium_temperature", "is missing", "give it: the thickness depends on it")
        layers = (*self.inside, (self.material, thickness), *self.outside)
        operation = self.operation
        return pipe_heat_flow(
            self.outer_diameter, layers, operation.medium_temperature, operation.surroundings, self.emissivity, vertical=self.vertical
        )


@dataclass(frozen=True)
class Thickness:
    """A thickness (mm) and what is to be told of how it came about."""

    value: float
    remarks: tuple[str, ...] = ()


def thickness_by(rule: Rule, situation: Situation) -> Thickness:
    """Return the thickness that a rule asks for.

    Raises
    ------
    InputError
        Where no row of a table fits, the medium's temperature is missing, or no thickness up to a metre will do.
    """
    match rule:
        case TableRule():
            found = _by_table(rule, situation)
        case BandsRule():
            return _by_bands(rule, situation)
        case HeatLossRule():
            found = _by_heat_loss(rule, situation)
        case SurfaceTemperatureRule():
            found = _by_surface_temperature(rule, situation)
    if not rule.stock:
        return dataclasses.replace(found, value=float(math.ceil(found.value - ROUNDING)))
    stock = stock_thickness(found.value)
    return Thickness(stock.value, (*found.remarks, *stock.remarks))


def stock_thickness(thickness: float) -> Thickness:
    """Return the next thickness (mm) that can be had from stock; above the thickest the next whole centimetre, in several layers."""
    records = catalogue().records(StockThickness)
    fitting = next((record for record in records if record.thickness >= thickness - ROUNDING), None)
    if fitting is not None:
        return Thickness(fitting.thickness, () if fitting.verified else (f"stock thickness {fitting.thickness:g} mm: trade practice, no standard",))
    greatest = f"{records[-1].thickness:g} mm" if records else "none"
    return Thickness(math.ceil(thickness / 10 - ROUNDING) * 10.0, (f"thicker than what is in stock ({greatest}): lay it in several layers",))


def inner_diameter(outer_diameter: float, wall_thickness: float | None) -> tuple[float, tuple[str, ...]]:
    """Return a pipe's inner diameter (mm) and what was assumed of its wall.

    Where the wall is not known it is the normal wall of EN 10220 for this diameter; where there is none the outer diameter is
    returned, on the safe side.
    """
    if wall_thickness is not None:
        return outer_diameter - 2 * wall_thickness, ()
    size = catalogue().pipe_size(outer_diameter)
    if size is None or size.wall_thickness is None:
        return outer_diameter, (f"wall of {outer_diameter:g} mm not known: its outer diameter is taken for the inner one",)
    doubt = "" if size.wall_verified else f" ({UNVERIFIED})"
    return outer_diameter - 2 * size.wall_thickness, (f"wall {size.wall_thickness:g} mm assumed: normal wall of {PIPE_STANDARD}{doubt}",)


def converted(thickness: float, outer_diameter: float, conductivity: float, reference: float) -> float:
    """Return the thickness of another conductivity that loses as much heat per metre as the table's.

    Equal resistances per metre, ln(d2 / d1) / (2 pi lambda) + 1 / (pi d2 h), with the same outer coefficient h of
    10 W/(m2 K), which is usual indoors; ``conductivity`` and ``reference`` (the table's) in W/(m K), the lengths in mm.
    """
    from scipy.optimize import brentq

    def resistance(s: float, lambda_: float) -> float:
        outer = outer_diameter + 2 * s
        return math.log(outer / outer_diameter) / (2 * math.pi * lambda_) + 1 / (math.pi * outer / 1000 * CONVERSION_COEFFICIENT)

    if conductivity == reference:
        return thickness
    wanted = resistance(thickness, reference)
    # beneath the critical radius, lambda / h, a thicker layer loses more: the solution lies beyond it
    low = max(conductivity / CONVERSION_COEFFICIENT * 1000 - outer_diameter / 2, 0.0)
    if resistance(low, conductivity) >= wanted:
        return low
    high = max(low, thickness, 1.0)
    while resistance(high, conductivity) < wanted:
        high *= 2
    return float(brentq(lambda s: resistance(s, conductivity) - wanted, low, high, xtol=THICKNESS_TOLERANCE))


def jacket_thickness(sheet: str, finished_diameter: float, source: object = "jacket", key: str = "") -> Thickness:
    """Return the least thickness (mm) of a jacket's sheet metal by DIN 4140 for a finished outer diameter (mm).

    Raises
    ------
    InputError
        Where no table has a row for the sheet and the diameter.
    """
    records = [record for record in catalogue().records(JacketThickness) if record.sheet.casefold() == sheet.casefold()]
    fitting = [record for record in records if in_band(finished_diameter, record.from_diameter, record.to_diameter)]
    # a user's own table goes before the standard's
    record = next(iter(sorted(fitting, key=lambda r: not r.source)), None)
    if record is None:
        problem = f"no thickness for {sheet} around {finished_diameter:g} mm is in the tables"
        raise InputError(source, key, problem, "give the sheet's thickness in mm, or a table insulation_jackets_...")
    told = f"jacket {record.thickness:g} mm of {sheet} after {record.standard}"
    return Thickness(record.thickness, () if record.verified else (f"{told} ({UNVERIFIED})",))


def _by_table(rule: TableRule, situation: Situation) -> Thickness:
    row, thickness, remarks = _table_row(rule, rule.case, situation)
    if row.conductivity is None:
        return Thickness(thickness, remarks)
    own = situation.material.conductivity_at(CONVERSION_TEMPERATURE if row.conductivity_temperature is None else row.conductivity_temperature)
    value = converted(thickness, situation.outer_diameter, own, row.conductivity)
    if abs(value - thickness) > ROUNDING:
        remarks = (*remarks, f"{thickness:g} mm of {row.conductivity:g} W/(m K) converted to {own:.3g} W/(m K) of {situation.material.name}")
    return Thickness(value, remarks)


def _table_row(rule: TableRule, case: str, situation: Situation) -> tuple[InsulationThickness, float, tuple[str, ...]]:
    """Return the row of a case that fits, its thickness (mm) and what is to be told."""
    records = [record for record in catalogue().records(InsulationThickness) if record.standard == rule.table]
    if not records:
        names = ", ".join(sorted({record.standard for record in catalogue().records(InsulationThickness)}))
        raise InputError(situation.name, "thickness.table", f"no table is called '{rule.table}'", f"use one of {names}")
    of_case = [record for record in records if record.case == case]
    if not of_case:
        cases = ", ".join(sorted({record.case for record in records}))
        raise InputError(situation.name, "thickness.case", f"{rule.table} has no case '{case}'", f"use one of {cases}")
    inner, assumed = inner_diameter(situation.outer_diameter, situation.wall_thickness)
    for record in of_case:
        diameter = inner if record.measured_at == "inner" else situation.outer_diameter
        if in_band(diameter, record.from_diameter, record.to_diameter):
            break
    else:
        problem = f"{rule.table}, case {case}, has no row for {situation.outer_diameter:g} mm"
        raise InputError(situation.name, "thickness", problem, "give the thickness in mm")
    told = () if record.verified else (f"{rule.table}, case {case}: {UNVERIFIED}",)
    assumed = assumed if record.measured_at == "inner" else ()
    if record.share_of_full is not None:
        full, thickness, remarks = _table_row(rule, FULL, situation)
        return full, record.share_of_full * thickness, tuple(dict.fromkeys((*remarks, *told)))
    if record.share_of_diameter is not None:
        return record, record.share_of_diameter * diameter, (*assumed, *told)
    return record, record.thickness or 0.0, (*assumed, *told)


def _by_bands(rule: BandsRule, situation: Situation) -> Thickness:
    inner, assumed = inner_diameter(situation.outer_diameter, situation.wall_thickness)
    diameter, assumed = (inner, assumed) if rule.measured_at == "inner" else (situation.outer_diameter, ())
    for band in rule.bands:
        if in_band(diameter, band.from_diameter, band.to_diameter):
            return Thickness(band.thickness, assumed)
    raise InputError(situation.name, "thickness.bands", f"no band holds {diameter:g} mm", "add one for it")


def _by_heat_loss(rule: HeatLossRule, situation: Situation) -> Thickness:
    def excess(thickness: float) -> float:
        return abs(situation.flow(thickness).flow) - rule.at_most

    return _least(excess, lambda s: f"{math.ceil((excess(s) + rule.at_most) * 100) / 100:g} W/m", f"a heat loss of {rule.at_most:g} W/m", situation)


def _by_surface_temperature(rule: SurfaceTemperatureRule, situation: Situation) -> Thickness:
    ambient = situation.operation.ambient_temperature
    if rule.at_most <= ambient:
        problem = f"{rule.at_most:g} deg C is not more than the surroundings' {ambient:g} deg C"
        raise InputError(situation.name, "thickness.at_most", problem, f"give more than {ambient:g}")

    def excess(thickness: float) -> float:
        return situation.flow(thickness).surface_temperature - rule.at_most

    return _least(excess, lambda s: f"{math.ceil((excess(s) + rule.at_most) * 100) / 100:g} deg C", f"a surface of {rule.at_most:g} deg C", situation)


def _least(excess: Callable[[float], float], reached: Callable[[float], str], wanted: str, situation: Situation) -> Thickness:
    """Return the least thickness from which on nothing is in excess.

    A thin layer around a thin pipe may lose more than the bare pipe; beyond the thickness of the greatest loss the excess falls.
    """
    from scipy.optimize import brentq

    if excess(THICKEST) > 0:
        problem = f"{wanted} is not reached with {THICKEST:g} mm of {situation.material.name} around {situation.outer_diameter:g} mm"
        raise InputError(situation.name, "thickness.at_most", problem, f"give {reached(THICKEST)} or more")
    if excess(THINNEST) <= 0:
        return Thickness(THINNEST, (f"{wanted} needs no more than the least thickness of {THINNEST:g} mm",))
    return Thickness(float(brentq(functools.cache(excess), THINNEST, THICKEST, xtol=THICKNESS_TOLERANCE)))
