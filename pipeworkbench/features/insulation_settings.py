# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a set of components is insulated, in three forms: properties of a document object, a plain dataclass, a specification."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, get_args

from pipeworkbench.catalogue import InsulationThickness, JacketSheet, catalogue
from pipeworkbench.errors import InputError
from pipeworkbench.features.base import Property
from pipeworkbench.features.component import NONE, offer
from pipeworkbench.insulation.heat_loss import ABSOLUTE_ZERO
from pipeworkbench.insulation.materials import DEFAULT_MATERIAL, DEFAULT_SHEET, materials
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.rules import Changes, JacketSpec, LayerSpec
from pipeworkbench.insulation.specification import LEAST_DISTANCE, Specification
from pipeworkbench.insulation.thickness import DIN_4140, HeatLossRule, Rule, SurfaceTemperatureRule, TableRule
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, Treatment

FIXED, HEAT_LOSS, SURFACE, SPECIFIED = "fixed", "heat loss", "surface temperature", "specification"
HALF, EQUAL, LONGER = "half", "equal", "longer"
FURTHER_LAYER = re.compile(r"\s*(\d+(?:\.\d+)?)\s*mm\s+(\S.*?)\s*")
LAYERS, JACKET, BENDS, FLANGES, SEAMS, SERVICE = "Insulation", "Jacket", "Bends", "Flanges", "Seams", "Operation"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """What is said of the insulation of a set of components; lengths are mm, temperatures deg C.

    ``thickness`` holds where ``thickness_rule`` is "fixed"; the other rules are a table's name and case, "heat loss" and
    "surface temperature", which have a ``limit`` (W/m, deg C), and "specification": what an imported file says. ``stock`` rounds up
    what follows from a rule to what can be bought. ``second_material`` and ``jacket`` "none" leave the layer and the sheet away.
    ``sheet_thickness`` 0 is DIN 4140's, ``gores`` 0 that of the rule.
    """

    material: str = DEFAULT_MATERIAL
    thickness: float = 50.0
    thickness_rule: str = FIXED
    limit: float = 0.0
    stock: bool = True
    second_material: str = NONE
    second_thickness: float = 0.0
    further_layers: tuple[str, ...] = ()
    minimum_distance: float = LEAST_DISTANCE
    jacket: str = DEFAULT_SHEET
    sheet_thickness: float = 0.0
    longitudinal_overlap: float = Seams.longitudinal_overlap
    circumferential_overlap: float = Seams.circumferential_overlap
    gore_overlap: float = Seams.gore_overlap
    rivet_pitch: float = Seams.rivet_pitch
    rivet_diameter: float = Seams.rivet_diameter
    bead: bool = Seams.bead
    bead_allowance: float = Seams.bead_allowance
    stagger: float = Seams.stagger_deg
    bend_shape: str = Bends.shape
    gores: int = 0
    first_gore: str = HALF
    first_gore_extra: float = 0.0
    tight_bends: str = Bends.tight
    flange_cover: str = Flanges.cover
    clearance: float = Flanges.clearance
    gap: float = Flanges.gap
    box_overlap: float = Flanges.overlap
    valve_length: float = Flanges.longest_valve
    medium_temperature: float | None = None
    ambient_temperature: float = Operation.ambient_temperature
    wind_speed: float = Operation.wind_speed
    hours_per_year: float = Operation.hours_per_year
    price_per_kwh: float | None = None
    co2_per_kwh: float | None = None
    efficiency: float = Operation.efficiency

    def specification(self, base: Specification | None = None, source: str = "insulation") -> Specification:
        """Return the specification of components that are insulated like this.

        Parameters
        ----------
        base : Specification, optional
            Whatever settings do not say: rules for some of the components, obstacles, sheet sizes, prices.
        source : str, optional
            What messages name.

        Raises
        ------
        InputError
            Where a value does not fit.
        """
        base = base or Specification()
        if self.thickness_rule == FIXED and self.thickness <= 0:
            raise InputError(source, "thickness", f"is {self.thickness:g} mm", "give more than 0, or delete the insulation")
        default = Changes(
            layers=self._layers(base, source),
            jacket=None if self.jacket == NONE else JacketSpec(self.jacket, self.sheet_thickness or DIN_4140),
            bare=False,
            seams=dataclasses.asdict(self._seams()),
            bends=dataclasses.asdict(self._bends()),
            flanges=dataclasses.asdict(self._flanges()),
        )
        whole = dataclasses.replace(base, default=default, operation=self._operation(base), minimum_distance=self.minimum_distance)
        # the file's own checks: properties may hold anything
        checked = Specification.from_dict(whole.to_dict(), source)
        return dataclasses.replace(checked, rules=base.rules, source=base.source)

    @classmethod
    def of(cls, specification: Specification) -> Settings:
        """Return the settings of a specification's default; what they cannot say is left to the specification."""
        default = changes_of(specification)
        seams, bends, flanges = Seams(**default.seams), Bends(**default.bends), Flanges(**default.flanges)
        jacket = JacketSpec(DEFAULT_SHEET) if default.jacket == "unchanged" else default.jacket
        operation = specification.operation
        longer = not isinstance(bends.first_gore, str)
        return cls(
            **_said_of_layers(default),
            minimum_distance=specification.minimum_distance,
            jacket=jacket.material if jacket else NONE,
            sheet_thickness=0.0 if jacket is None or jacket.thickness == DIN_4140 else jacket.thickness,
            **{field.name: getattr(seams, field.name) for field in dataclasses.fields(seams) if field.name != "stagger_deg"},
            stagger=seams.stagger_deg,
            bend_shape=bends.shape,
            gores=bends.gores or 0,
            first_gore=LONGER if longer else str(bends.first_gore),
            first_gore_extra=float(bends.first_gore) if longer else 0.0,
            tight_bends=bends.tight,
            flange_cover=flanges.cover,
            clearance=flanges.clearance,
            gap=flanges.gap,
            box_overlap=flanges.overlap,
            valve_length=flanges.longest_valve,
            medium_temperature=operation.medium_temperature,
            ambient_temperature=operation.ambient_temperature,
            wind_speed=operation.wind_speed,
            hours_per_year=operation.hours_per_year,
            price_per_kwh=operation.price_per_kwh,
            co2_per_kwh=operation.kg_co2_per_kwh,
            efficiency=operation.efficiency,
        )

    def _layers(self, base: Specification, source: str) -> tuple[LayerSpec, ...] | None:
        if self.thickness_rule == SPECIFIED:
            return changes_of(base).layers
        layers = [LayerSpec(self.material, self._rule(source) or self.thickness)]
        if self.second_material != NONE and self.second_thickness > 0:
            layers.append(LayerSpec(self.second_material, self.second_thickness))
        for text in self.further_layers:
            found = FURTHER_LAYER.fullmatch(text)
            if found is None:
                raise InputError(source, "further layers", f"'{text}' is no layer", "write it like '40 mm mineral wool'")
            layers.append(LayerSpec(found[2], float(found[1])))
        return tuple(layers)

    def _rule(self, source: str) -> Rule | None:
        if self.thickness_rule == FIXED:
            return None
        if self.thickness_rule in (HEAT_LOSS, SURFACE):
            if self.thickness_rule == HEAT_LOSS and self.limit <= 0:
                raise InputError(source, "limit", f"is {self.limit:g} W/m", "give what a metre of the pipe may lose")
            kind = HeatLossRule if self.thickness_rule == HEAT_LOSS else SurfaceTemperatureRule
            return kind(at_most=self.limit, stock=self.stock)
        table, _, case = self.thickness_rule.rpartition(", ")
        return TableRule(table=table, case=case, stock=self.stock)

    def _seams(self) -> Seams:
        names = [field.name for field in dataclasses.fields(Seams) if field.name != "stagger_deg"]
        return Seams(**{name: getattr(self, name) for name in names}, stagger_deg=self.stagger)

    def _bends(self) -> Bends:
        first: Any = self.first_gore_extra if self.first_gore == LONGER else self.first_gore
        shape: Any = self.bend_shape
        tight: Any = self.tight_bends
        return Bends(shape, self.gores or None, first, tight)

    def _flanges(self) -> Flanges:
        cover: Any = self.flange_cover
        return Flanges(cover, self.clearance, self.gap, self.box_overlap, self.valve_length)

    def _operation(self, base: Specification) -> Operation:
        return dataclasses.replace(
            base.operation,
            medium_temperature=self.medium_temperature,
            ambient_temperature=self.ambient_temperature,
            wind_speed=self.wind_speed,
            hours_per_year=self.hours_per_year,
            price_per_kwh=self.price_per_kwh,
            kg_co2_per_kwh=self.co2_per_kwh,
            efficiency=self.efficiency,
        )


def changes_of(specification: Specification) -> Changes:
    """Return what a specification says of all components."""
    default = specification.default
    return Changes.of(default) if isinstance(default, Treatment) else default or Changes()


def choices_of(name: str) -> tuple[str, ...]:
    """Return what one of the settings that are chosen from a list can be, by its name in `Settings`."""
    match name:
        case "material":
            return tuple(material.name for material in materials())
        case "second_material":
            return (NONE, *(material.name for material in materials()))
        case "jacket":
            return (NONE, *(sheet.name for sheet in catalogue().records(JacketSheet)))
        case "thickness_rule":
            tables = (f"{record.standard}, {record.case}" for record in catalogue().records(InsulationThickness))
            return (FIXED, *dict.fromkeys(tables), HEAT_LOSS, SURFACE, SPECIFIED)
        case "first_gore":
            return (HALF, EQUAL, LONGER)
    field = {"bend_shape": (Bends, "shape"), "tight_bends": (Bends, "tight"), "flange_cover": (Flanges, "cover")}[name]
    return get_args(_types(field[0])[field[1]])


PROPERTIES = (
    Property("Material", "App::PropertyEnumeration", LAYERS, "What the inner layer is made of"),
    Property("Thickness", "App::PropertyLength", LAYERS, "Thickness of the inner layer where the rule is 'fixed'"),
    Property("ThicknessRule", "App::PropertyEnumeration", LAYERS, "What the thickness of the inner layer follows from"),
    Property("Limit", "App::PropertyFloat", LAYERS, "What the rule 'heat loss' allows in W/m, and the rule 'surface temperature' in °C"),
    Property("Stock", "App::PropertyBool", LAYERS, "Take the next thickness that can be bought where it follows from a rule"),
    Property("SecondMaterial", "App::PropertyEnumeration", LAYERS, "What the second layer is made of"),
    Property("SecondThickness", "App::PropertyLength", LAYERS, "Thickness of the second layer, 0 for none"),
    Property("FurtherLayers", "App::PropertyStringList", LAYERS, "Layers around the second one, outwards, each like '40 mm mineral wool'"),
    Property("MinimumDistance", "App::PropertyLength", LAYERS, "What is closer to the finished surface is listed among the clashes"),
    Property("Jacket", "App::PropertyEnumeration", JACKET, "Sheet metal around the insulation"),
    Property("SheetThickness", "App::PropertyLength", JACKET, "Thickness of the sheet metal, 0: by the finished diameter after DIN 4140"),
    Property("LongitudinalOverlap", "App::PropertyLength", SEAMS, "What is added along the length seams"),
    Property("CircumferentialOverlap", "App::PropertyLength", SEAMS, "What is added where a jacket goes over the next one"),
    Property("GoreOverlap", "App::PropertyLength", SEAMS, "What is added between the pieces of a bend"),
    Property("RivetPitch", "App::PropertyLength", SEAMS, "Distance of the rivet holes along seams, 0 for none"),
    Property("RivetDiameter", "App::PropertyLength", SEAMS, "Diameter of the rivet holes"),
    Property("Bead", "App::PropertyBool", SEAMS, "Mark the beads along the round edges"),
    Property("BeadAllowance", "App::PropertyLength", SEAMS, "What the sheet shrinks by for each bead"),
    Property("Stagger", "App::PropertyAngle", SEAMS, "What the length seams of neighbours are turned against each other"),
    Property("BendShape", "App::PropertyEnumeration", BENDS, "Bends of straight pieces (segmented) or round ones, as of foam shells (smooth)"),
    Property("Gores", "App::PropertyInteger", BENDS, "Pieces of a segmented bend, 0: by the rule"),
    Property(
        "FirstGore",
        "App::PropertyEnumeration",
        BENDS,
        "First and last piece of a bend: half as long as the others, equal, or longer than the half",
    ),
    Property("FirstGoreExtra", "App::PropertyLength", BENDS, "By what the first and the last piece are longer than the half"),
    Property("TightBends", "App::PropertyEnumeration", BENDS, "Bends that are too tight for the thickness: two pieces with a mitre, or refuse"),
    Property("FlangeCover", "App::PropertyEnumeration", FLANGES, "Boxes of two half shells over flanges, or bare flanges"),
    Property("Clearance", "App::PropertyLength", FLANGES, "Between a flange's rim and the inside of its box"),
    Property("Gap", "App::PropertyLength", FLANGES, "Added to the bolts' length between flange and insulation, so that bolts can be pulled"),
    Property("BoxOverlap", "App::PropertyLength", FLANGES, "How far a box reaches over the pipe's jacket"),
    Property("ValveLength", "App::PropertyLength", FLANGES, "Up to this distance two flange faces are taken for a valve's"),
    Property("MediumTemperature", "App::PropertyFloat", SERVICE, "Temperature of the medium in °C, -273.15: not known"),
    Property("AmbientTemperature", "App::PropertyFloat", SERVICE, "Temperature of the surroundings in °C"),
    Property("WindSpeed", "App::PropertySpeed", SERVICE, "Speed of the wind, 0 indoors"),
    Property("HoursPerYear", "App::PropertyFloat", SERVICE, "Hours of operation in a year"),
    Property("PricePerKwh", "App::PropertyFloat", SERVICE, "Price of a kWh of energy, 0: not known"),
    Property("Co2PerKwh", "App::PropertyFloat", SERVICE, "CO2 of a kWh of energy in kg, 0: not known"),
    Property("Efficiency", "App::PropertyFloat", SERVICE, "Heat delivered over energy bought"),
)

_NAMES = {prop: re.sub(r"(?<!^)(?=[A-Z])", "_", prop.name).lower() for prop in PROPERTIES}  # of the settings
_UNKNOWN = {"MediumTemperature": ABSOLUTE_ZERO, "PricePerKwh": 0.0, "Co2PerKwh": 0.0}  # properties' values for None
_MM_PER_M = 1000.0  # of FreeCAD's speeds
ENUMERATIONS = {prop.name: name for prop, name in _NAMES.items() if prop.kind == "App::PropertyEnumeration"}


def settings_of(obj: Any) -> Settings:
    """Return the settings that an object's properties hold."""
    return Settings(**dict(_values(obj)))


def set_settings(obj: Any, settings: Settings) -> None:
    """Give an object's properties the values of settings; those that are the same are left alone."""
    present = dict(_values(obj))
    for prop, name in _NAMES.items():
        value = getattr(settings, name)
        if present[name] == value:
            continue
        match prop.kind.removeprefix("App::Property"):
            case "Enumeration":
                offer(obj, prop.name, choices_of(name), value)
            case "StringList":
                setattr(obj, prop.name, list(value))
            case "Speed":
                setattr(obj, prop.name, value * _MM_PER_M)
            case _:
                setattr(obj, prop.name, _UNKNOWN[prop.name] if value is None else value)


def _values(obj: Any) -> Iterator[tuple[str, Any]]:
    for prop, name in _NAMES.items():
        value = getattr(obj, prop.name)
        match prop.kind.removeprefix("App::Property"):
            case "Length" | "Angle":
                value = value.Value
            case "Speed":
                value = value.Value / _MM_PER_M
            case "StringList":
                value = tuple(value)
        yield name, None if prop.name in _UNKNOWN and value <= _UNKNOWN[prop.name] else value


def _types(kind: type[Any]) -> dict[str, Any]:
    from typing import get_type_hints

    return get_type_hints(kind)


def _said_of_layers(default: Changes) -> dict[str, Any]:
    """Return the settings of the layers; they cannot say all that a specification can."""
    layers = default.layers or ()
    if not layers or not all(isinstance(layer.thickness, float | int) for layer in layers[1:]):
        return {"thickness_rule": SPECIFIED}
    first = layers[0]
    said: dict[str, Any] = {"material": first.material}
    match first.thickness:
        case HeatLossRule() | SurfaceTemperatureRule() as rule:
            said |= {"thickness_rule": HEAT_LOSS if isinstance(rule, HeatLossRule) else SURFACE, "limit": rule.at_most, "stock": rule.stock}
        case TableRule() as rule:
            said |= {"thickness_rule": f"{rule.table}, {rule.case}", "stock": rule.stock}
        case float() | int() as thickness:
            said["thickness"] = float(thickness)
        case _:
            return {"thickness_rule": SPECIFIED}
    if len(layers) > 1:
        said |= {"second_material": layers[1].material, "second_thickness": layers[1].thickness}
    return said | {"further_layers": tuple(f"{layer.thickness:g} mm {layer.material}" for layer in layers[2:])}
