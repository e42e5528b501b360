# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric reducer: a cone that follows both diameters, wall, length, offset and placement."""

from __future__ import annotations

from typing import Any

from pipeworkbench.features.base import Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties
from pipeworkbench.pipeline import Reducer
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import local_point


class ReducerFeature(ComponentFeature):
    """Proxy of a reducer. The wide end's centre is the placement's base, z goes to the narrow end, which is offset along x."""

    type_name = "PipeWorkbench::Reducer"
    kind = Reducer
    standard_dimensions = ("EndDiameter", "Length", "Offset")
    properties = component_properties(
        "Reducer",
        Property("EndDiameter", "App::PropertyLength", "Reducer", "Outside diameter of the narrow end"),
        Property("Length", "App::PropertyLength", "Reducer", "Length along the axis"),
        Property("Eccentric", "App::PropertyBool", "Reducer", "The ends do not lie on one axis"),
        Property("Offset", "App::PropertyDistance", "Reducer", "Of the narrow end across the axis, where it is eccentric"),
    )

    def geometry(self, obj: Any) -> Fields:
        """Return both ends and the axis."""
        return {
            "start": [0.0, 0.0, 0.0],
            "end": [obj.Offset.Value, 0.0, obj.Length.Value],
            "axis": [0.0, 0.0, 1.0],
            "end_diameter": obj.EndDiameter.Value,
        }

    def attributes(self, obj: Any) -> Fields:
        """Return the type."""
        return {"reducer_type": "eccentric" if obj.Eccentric else "concentric"}

    def set_dimensions(self, obj: Any, component: Reducer, frame: Frame) -> None:
        """Set the narrow end."""
        end = local_point(frame, component.end)
        obj.EndDiameter = component.end_diameter
        obj.Length = float(end[2])
        obj.Eccentric = component.reducer_type == "eccentric"
        obj.Offset = float(end[0])
