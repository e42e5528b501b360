# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric elbow: a part of a torus that follows its diameter, wall, bend radius, angle and placement."""

from __future__ import annotations

import math
from typing import Any

import FreeCAD

from pipeworkbench.catalogue import STANDARD_BENDS, PipeSize, bends
from pipeworkbench.features.base import Property
from pipeworkbench.features.component import NONE, ComponentFeature, Fields, component_properties, offer, port
from pipeworkbench.features.joints import End, is_joined
from pipeworkbench.pipeline import Elbow
from pipeworkbench.solids import Frame


class ElbowFeature(ComponentFeature):
    """Proxy of an elbow. It starts at the placement's base along the local z axis and bends towards the local x axis.

    Another radius or angle leaves the axes of the pipes that are joined to it where they are.
    """

    type_name = "PipeWorkbench::Elbow"
    kind = Elbow
    ends = (End("Start"), End("End"))
    choices = ("BendType",)
    standard_dimensions = ("BendRadius",)
    free_dimensions = ("Angle",)
    properties = component_properties(
        "Elbow",
        Property("BendRadius", "App::PropertyLength", "Elbow", "Radius of the bent axis"),
        Property("Angle", "App::PropertyAngle", "Elbow", "Change of direction"),
        Property("BendType", "App::PropertyEnumeration", "Elbow", "Type of the standard; choosing one sets the bend radius"),
        ends=ends,
    )

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add what is missing, with the list of the standard's types."""
        replaced = super().add_properties(obj)
        offer(obj, "BendType", (NONE, *STANDARD_BENDS))
        return replaced

    def geometry(self, obj: Any) -> Fields:
        """Return both ends and the intersection point of the axes."""
        angle, tangent = math.radians(obj.Angle.Value), self._tangent(obj)
        return {
            "start": [0.0, 0.0, 0.0],
            "intersection": [0.0, 0.0, tangent],
            "end": [tangent * math.sin(angle), 0.0, tangent + tangent * math.cos(angle)],
            "angle_deg": obj.Angle.Value,
            "bend_radius": obj.BendRadius.Value,
        }

    def attributes(self, obj: Any) -> Fields:
        """Return the type, which an elbow of another radius has not."""
        return {"bend_type": None if obj.BendType == NONE else obj.BendType}

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return both ends."""
        x, _, z = self.geometry(obj)["end"]
        return port(tilt_deg=180), port(x, z, obj.Angle.Value)

    def anchor(self, obj: Any) -> Any:
        """Return the point where the axes meet; the start of an elbow that nothing is joined to."""
        return FreeCAD.Vector(0, 0, self._tangent(obj) if is_joined(obj) else 0)

    def forget_standard(self, obj: Any) -> None:
        """Take back the type too: it belongs to the standard's radius."""
        super().forget_standard(obj)
        obj.BendType = NONE

    def set_dimensions(self, obj: Any, component: Elbow, frame: Frame) -> None:  # noqa: ARG002
        """Set radius, angle and type."""
        obj.BendRadius = component.bend_radius
        obj.Angle = component.angle_deg
        obj.BendType = component.bend_type or NONE

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the radius of the same type of bend for the new diameter."""
        kind = obj.BendType
        bend = self.alike(obj, [bend for bend in bends(obj.OutsideDiameter.Value) if bend.bend_type == kind], always=kind != NONE)
        if bend is not None:
            obj.BendRadius = bend.bend_radius
            obj.BendType = bend.bend_type

    def choose(self, obj: Any, name: str) -> None:  # noqa: ARG002
        """Take the radius of the chosen type; where the catalogue has none for this diameter, the elbow is of no type."""
        chosen = obj.BendType
        self.set_standard(obj, None)
        if chosen not in (NONE, obj.BendType):
            FreeCAD.Console.PrintWarning(f"{obj.Label}: there is no {chosen} bend of {obj.OutsideDiameter.Value:g} mm in the catalogue\n")

    @staticmethod
    def _tangent(obj: Any) -> float:
        """Return the distance (mm) from both ends to the point where the axes meet."""
        return float(obj.BendRadius.Value * math.tan(math.radians(obj.Angle.Value) / 2))
