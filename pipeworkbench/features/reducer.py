# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric reducer: a cone that follows both diameters, wall, length, offset and placement."""

from __future__ import annotations

from typing import Any

from pipeworkbench.catalogue import PipeSize, reducers
from pipeworkbench.features.base import Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties, port
from pipeworkbench.features.joints import End
from pipeworkbench.pipeline import Reducer
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import local_point

WIDE = 0


class ReducerFeature(ComponentFeature):
    """Proxy of a reducer. The wide end's centre is the placement's base, z goes to the narrow end, which is offset along x."""

    type_name = "PipeWorkbench::Reducer"
    kind = Reducer
    ends = (End("Start"), End("End", "EndDiameter"))
    choices = ("EndDiameter",)
    standard_dimensions = ("Length", "Offset")
    properties = component_properties(
        "Reducer",
        Property("EndDiameter", "App::PropertyLength", "Reducer", "Outside diameter of the narrow end"),
        Property("Length", "App::PropertyLength", "Reducer", "Length along the axis"),
        Property("Eccentric", "App::PropertyBool", "Reducer", "The ends do not lie on one axis"),
        Property("Offset", "App::PropertyDistance", "Reducer", "Of the narrow end across the axis, where it is eccentric"),
        ends=ends,
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

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return the wide and the narrow end."""
        return port(tilt_deg=180), port(x=obj.Offset.Value, z=obj.Length.Value)

    def why_not_resized(self, obj: Any, end: int, diameter: float) -> str:
        """Refuse what would make the wide end the narrower one."""
        wide, narrow = (diameter, obj.EndDiameter.Value) if end == WIDE else (obj.OutsideDiameter.Value, diameter)
        return "" if wide > narrow else "it would no longer narrow"

    def set_dimensions(self, obj: Any, component: Reducer, frame: Frame) -> None:
        """Set the narrow end."""
        end = local_point(frame, component.end)
        obj.EndDiameter = component.end_diameter
        obj.Length = float(end[2])
        obj.Eccentric = component.reducer_type == "eccentric"
        obj.Offset = float(end[0])

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the length of a standard reducer of both diameters; an eccentric one has its ends in line at one side."""
        wide, narrow = obj.OutsideDiameter.Value, obj.EndDiameter.Value
        reducer = self.alike(obj, reducers(wide, narrow))
        if reducer is not None:
            obj.Length = reducer.length
            if obj.Eccentric:
                obj.Offset = (wide - narrow) / 2

    def choose(self, obj: Any, name: str) -> None:  # noqa: ARG002
        """Another narrow end makes another reducer."""
        self.set_standard(obj, None)
