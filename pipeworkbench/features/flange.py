# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric flange: plate, neck, raised face and bolt holes that follow the dimensions of EN 1092-1."""

from __future__ import annotations

from typing import Any

from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties
from pipeworkbench.pipeline import AnyComponent, Flange
from pipeworkbench.solids import Frame, flange_bolts

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


class FlangeFeature(ComponentFeature):
    """Proxy of a flange. The centre of its face is the placement's base, its body lies along the local z axis."""

    type_name = "PipeWorkbench::Flange"
    kind = Flange
    standard_dimensions = ("FlangeType", "PressureClass", *NEEDED, *OPTIONAL, "BoltCount")
    properties = component_properties(
        "Flange",
        Property("FlangeType", "App::PropertyString", "Flange", "Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)"),
        Property("PressureClass", "App::PropertyFloat", "Flange", "PN"),
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
    )

    def geometry(self, obj: Any) -> Fields:
        """Return face, axis and the dimensions that the images show."""
        return {"face": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, -1.0]} | {field: getattr(obj, name).Value for name, field in NEEDED.items()}

    def attributes(self, obj: Any) -> Fields:
        """Return type, pressure class and what else the standard says."""
        optional = {field: getattr(obj, name).Value or None for name, field in OPTIONAL.items()}
        named = {"flange_type": obj.FlangeType, "pn": obj.PressureClass, "bolts": obj.BoltCount or None}
        # where the list was emptied the flange has become another one
        return optional | named | ({} if obj.Equivalents else {"equivalents": []})

    def forget_standard(self, obj: Any) -> None:
        """Take back the equivalents too: another flange has others."""
        super().forget_standard(obj)
        obj.Equivalents = []

    def set_dimensions(self, obj: Any, component: Flange, frame: Frame) -> None:  # noqa: ARG002
        """Set type, pressure class and dimensions."""
        obj.FlangeType = component.flange_type
        obj.PressureClass = component.pn
        for name, field in (NEEDED | OPTIONAL).items():
            setattr(obj, name, getattr(component, field) or 0)
        obj.BoltCount = component.bolts or 0
        obj.Equivalents = [" ".join(str(value) for value in other.values()) for other in component.equivalents]

    def shape(self, obj: Any, component: AnyComponent) -> Any:
        """Return the flange, with its bolts where they are wanted and known."""
        solid = super().shape(obj, component)
        bolts = flange_bolts(component) if obj.ShowBolts and isinstance(component, Flange) else None
        return solid if bolts is None else type(bolts).makeCompound([solid, *bolts.Solids()])
