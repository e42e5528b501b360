# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric flange: plate, neck, raised face and bolt holes that follow the dimensions of EN 1092-1."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import FreeCAD
import numpy as np

from pipeworkbench.catalogue import FLANGE_TYPES, Catalogue, FlangeDimensions, PipeSize, catalogue, flanges_of_pipe
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Property
from pipeworkbench.features.component import GRADES, NONE, ComponentFeature, Fields, component_properties, offer, port
from pipeworkbench.features.joints import End
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Flange
from pipeworkbench.recon.flange_variants import flange_of
from pipeworkbench.solids import IDENTITY, Frame, flange_bolts

CURRENT_STANDARD = "EN 1092-1"
# of properties (0 where not known) and fields: the letters are EN 1092-1's
OPTIONAL = {
    "NeckDiameter": "neck_diameter",
    "NeckStraight": "neck_straight",
    "BoltCircle": "K",
    "BoltHoleDiameter": "L",
    "RaisedFaceDiameter": "raised_face_diameter",
    "RaisedFaceHeight": "raised_face_height",
}
NEEDED = {"PlateDiameter": "D", "PlateThickness": "C", "Length": "length"}


class Offered(NamedTuple):
    """What the catalogue has of flanges."""

    types: tuple[str, ...]
    pressures: tuple[str, ...]
    standards: tuple[str, ...]


class FlangeFeature(ComponentFeature):
    """Proxy of a flange. The centre of its face is the placement's base, its body lies along the local z axis.

    Choosing type, PN or standard, or giving it another diameter, takes all dimensions from the catalogue; the face stays.
    """

    type_name = "PipeWorkbench::Flange"
    kind = Flange
    ends = (End("Face"), End("WeldEnd"))
    choices = ("FlangeType", "PN", "PressureClass", "Standard")
    standard_dimensions = (*NEEDED, *OPTIONAL, "BoltCount")
    properties = component_properties(
        "Flange",
        Property("FlangeType", "App::PropertyEnumeration", "Flange", "Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)"),
        Property("PN", "App::PropertyEnumeration", "Flange", "Pressure class of the standards"),
        Property("PressureClass", "App::PropertyFloat", "Flange", "Pressure class as a number"),
        Property("PlateDiameter", "App::PropertyLength", "Flange", "Diameter D of the plate"),
        Property("PlateThickness", "App::PropertyLength", "Flange", "Thickness C of the plate, raised face included"),
        Property("Length", "App::PropertyLength", "Flange", "From the face to the weld end"),
        Property("NeckDiameter", "App::PropertyLength", "Flange", "Diameter of the neck where it leaves the plate; 0 for the pipe's"),
        Property("NeckStraight", "App::PropertyLength", "Flange", "Length of the neck's straight part at the weld end"),
        Property("BoltCircle", "App::PropertyLength", "Flange", "Diameter K of the bolt circle; 0 where it is not known"),
        Property("BoltHoleDiameter", "App::PropertyLength", "Flange", "Diameter L of a bolt hole; 0 where it is not known"),
        Property("BoltCount", "App::PropertyInteger", "Flange", "Number of bolts; 0 where it is not known"),
        Property("RaisedFaceDiameter", "App::PropertyLength", "Flange", "Diameter of the raised face; 0 where it is not known"),
        Property("RaisedFaceHeight", "App::PropertyLength", "Flange", "Height of the raised face"),
        Property("ShowBolts", "App::PropertyBool", "Flange", "Draw the bolts, through a partner of the same thickness"),
        Property("Equivalents", "App::PropertyStringList", "Flange", "Flanges of the same dimensions, which images cannot tell apart", READ_ONLY),
        Property("EquivalentsData", "App::PropertyString", "Flange", "These flanges as exchange files have them (JSON)", HIDDEN),
        standard="App::PropertyEnumeration",
        ends=ends,
    )

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add what is missing, with the lists of types, pressure classes and standards."""
        replaced = super().add_properties(obj)
        offered = _offered(catalogue())
        for name, names in (("FlangeType", offered.types), ("PN", offered.pressures), ("Standard", offered.standards)):
            offer(obj, name, names)
        return replaced

    def migrate(self, obj: Any, version: int, replaced: Fields) -> None:
        """Version 2 had the pressure class as a number alone, and the equivalents in what was measured."""
        super().migrate(obj, version, replaced)
        if version < 3:
            measured = json.loads(obj.MeasuredAs)["component"] if obj.MeasuredAs else {}
            with self.quiet():
                obj.PN = _pressure_name(obj.PressureClass)
                self._say_equivalents(obj, measured.get("equivalents", ()) if obj.Equivalents else ())

    def geometry(self, obj: Any) -> Fields:
        """Return face, axis and the dimensions that the images show."""
        return {"face": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, -1.0]} | {field: getattr(obj, name).Value for name, field in NEEDED.items()}

    def attributes(self, obj: Any) -> Fields:
        """Return type, pressure class and what else the standard says."""
        optional = {field: getattr(obj, name).Value or None for name, field in OPTIONAL.items()}
        named = {"flange_type": obj.FlangeType, "pn": obj.PressureClass, "bolts": obj.BoltCount or None}
        return optional | named | {"equivalents": json.loads(obj.EquivalentsData or "[]")}

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return the face and the weld end."""
        return port(tilt_deg=180), port(z=obj.Length.Value)

    def open_to(self, obj: Any) -> tuple[End, ...]:
        """Return the face, and the weld end, which a blind flange has not."""
        return self.ends[:1] if obj.FlangeType == BLIND_FLANGE else self.ends

    def standard(self, obj: Any) -> str | None:
        """Return the standard that was chosen."""
        return None if obj.Standard == NONE else obj.Standard

    def say_standard(self, obj: Any, standard: str | None, grade: int | None) -> None:
        """Choose the standard; one that the catalogue does not know is offered from now on."""
        offer(obj, "Standard", obj.getEnumerationsOfProperty("Standard"), standard or NONE)
        obj.StandardSources = GRADES[grade]

    def forget_standard(self, obj: Any) -> None:
        """Take back the equivalents too: another flange has others."""
        super().forget_standard(obj)
        self._say_equivalents(obj, ())

    def set_dimensions(self, obj: Any, component: Flange, frame: Frame) -> None:  # noqa: ARG002
        """Set type, pressure class and dimensions."""
        offer(obj, "FlangeType", obj.getEnumerationsOfProperty("FlangeType"), component.flange_type)
        obj.PressureClass = component.pn
        obj.PN = _pressure_name(component.pn)
        for name, field in (NEEDED | OPTIONAL).items():
            setattr(obj, name, getattr(component, field) or 0)
        obj.BoltCount = component.bolts or 0
        self._say_equivalents(obj, component.equivalents)

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the flange of the same standard, type and PN for the new diameter."""
        standard, kind, pressure = self.standard(obj), obj.FlangeType, obj.PressureClass
        self._become(obj, [row for row in self._fitting(obj) if (row.standard, row.flange_type, row.pn) == (standard, kind, pressure)])

    def choose(self, obj: Any, name: str) -> None:
        """Take the flange that was chosen; a standard without the present type or PN offers the nearest."""
        if name == "PN" and obj.PN != NONE:
            obj.PressureClass = _pressure_of(obj.PN)
        standard, kind, pressure = self.standard(obj), obj.FlangeType, obj.PressureClass
        if name == "Standard":
            rows = [row for row in self._fitting(obj) if row.standard == standard]
            rows.sort(key=lambda row: (row.flange_type != kind, abs(row.pn - pressure)))
        else:
            rows = [row for row in self._fitting(obj) if (row.flange_type, row.pn) == (kind, pressure)]
            rows.sort(key=lambda row: (row.standard != standard, row.standard != CURRENT_STANDARD, -row.verified))
        self._become(obj, rows)
        obj.PN = _pressure_name(obj.PressureClass)
        if not rows and standard is not None:
            FreeCAD.Console.PrintWarning(
                f"{obj.Label}: the catalogue does not have all dimensions of a flange of type {kind}, PN {pressure:g} "
                f"for {obj.OutsideDiameter.Value:g} mm; the dimensions stay\n"
            )

    def shape(self, obj: Any, component: AnyComponent) -> Any:
        """Return the flange, with its bolts where they are wanted and known."""
        solid = super().shape(obj, component)
        bolts = flange_bolts(component) if obj.ShowBolts and isinstance(component, Flange) else None
        return solid if bolts is None else type(bolts).makeCompound([solid, *bolts.Solids()])

    def model_key(self, obj: Any) -> str:
        """Bolts are drawn where they are wanted."""
        return f"{super().model_key(obj)} {obj.ShowBolts}"

    @staticmethod
    def _fitting(obj: Any) -> list[FlangeDimensions]:
        """Return the catalogue's flanges that sit on a pipe of the outside diameter."""
        return [row for row in flanges_of_pipe(obj.OutsideDiameter.Value) if row.is_complete]

    def _become(self, obj: Any, rows: list[FlangeDimensions]) -> None:
        """Take the dimensions of the first row; without one the flange is of no standard."""
        if not rows:
            self.forget_standard(obj)
            return
        raised = obj.RaisedFaceHeight.Value > 0
        flange = flange_of(rows[0], np.zeros(3), np.array((0.0, 0.0, -1.0)), obj.OutsideDiameter.Value, obj.ComponentId, raised=raised)
        self.set_dimensions(obj, flange, IDENTITY)
        self.say_standard(obj, flange.standard, flange.verified)

    @staticmethod
    def _say_equivalents(obj: Any, equivalents: Sequence[Mapping[str, Any]]) -> None:
        obj.Equivalents = [" ".join(str(value) for value in other.values()) for other in equivalents]
        obj.EquivalentsData = json.dumps(list(equivalents))


@functools.lru_cache(maxsize=1)
def _offered(tables: Catalogue) -> Offered:
    """Return what the tables have, with ``NONE`` for what is not in them."""
    rows = tables.flanges()
    return Offered(
        tuple(sorted({*FLANGE_TYPES, *(row.flange_type for row in rows)})),
        (NONE, *(_pressure_text(pressure) for pressure in sorted({row.pn for row in rows}))),
        (NONE, *sorted({row.standard for row in rows})),
    )


def _pressure_text(pressure: float) -> str:
    return f"PN {pressure:g}"


def _pressure_of(name: str) -> float:
    return float(name.removeprefix("PN "))


def _pressure_name(pressure: float) -> str:
    """Return what the enumeration calls a pressure class."""
    name = _pressure_text(pressure)
    return name if name in _offered(catalogue()).pressures else NONE
