# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric elbow: a part of a torus that follows its diameter, wall, bend radius, angle and placement."""

from __future__ import annotations

import math
from typing import Any

from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties
from pipeworkbench.pipeline import Elbow
from pipeworkbench.solids import Frame


class ElbowFeature(ComponentFeature):
    """Proxy of an elbow. It starts at the placement's base along the local z axis and bends towards the local x axis."""

    type_name = "PipeWorkbench::Elbow"
    kind = Elbow
    standard_dimensions = ("BendRadius",)
    properties = component_properties(
        "Elbow",
        Property("BendRadius", "App::PropertyLength", "Elbow", "Radius of the bent axis"),
        Property("Angle", "App::PropertyAngle", "Elbow", "Change of direction"),
        Property("BendType", "App::PropertyString", "Elbow", "Type of the standard (2D, 3D, 5D)", READ_ONLY),
    )

    def geometry(self, obj: Any) -> Fields:
        """Return both ends and the intersection point of the axes."""
        angle, radius = math.radians(obj.Angle.Value), obj.BendRadius.Value
        tangent = radius * math.tan(angle / 2)
        return {
            "start": [0.0, 0.0, 0.0],
            "intersection": [0.0, 0.0, tangent],
            "end": [tangent * math.sin(angle), 0.0, tangent + tangent * math.cos(angle)],
            "angle_deg": obj.Angle.Value,
            "bend_radius": radius,
        }

    def attributes(self, obj: Any) -> Fields:
        """Return the type, which an elbow of another radius has not."""
        return {"bend_type": obj.BendType or None}

    def forget_standard(self, obj: Any) -> None:
        """Take back the type too: it belongs to the standard's radius."""
        super().forget_standard(obj)
        obj.BendType = ""

    def set_dimensions(self, obj: Any, component: Elbow, frame: Frame) -> None:  # noqa: ARG002
        """Set radius, angle and type."""
        obj.BendRadius = component.bend_radius
        obj.Angle = component.angle_deg
        obj.BendType = component.bend_type or ""
