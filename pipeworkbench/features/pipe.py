# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric pipe: a hollow solid that follows its diameter, wall, length and placement."""

from __future__ import annotations

from typing import Any

import FreeCAD

from pipeworkbench.catalogue import PipeSize
from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.carrying import SHORTEST_MM
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties, port
from pipeworkbench.features.joints import End
from pipeworkbench.pipeline import Pipe
from pipeworkbench.solids import Frame

START, END = 0, 1


class PipeFeature(ComponentFeature):
    """Proxy of a pipe. Length runs along the local z axis, from the placement's base."""

    type_name = "PipeWorkbench::Pipe"
    kind = Pipe
    ends = (End("Start"), End("End"))
    free_dimensions = ("Length",)
    stretches = True
    properties = (
        *component_properties("Pipe", Property("Length", "App::PropertyLength", "Pipe", "Length along the axis"), ends=ends),
        Property("SigmaOutsideDiameter", "App::PropertyLength", "Measurement", "Standard deviation of the measured diameter", READ_ONLY),
        Property("Approximate", "App::PropertyBool", "Measurement", "The images do not support the pipe well", READ_ONLY),
        Property("Gaps", "App::PropertyFloatList", "Measurement", "Starts and ends, in mm from the pipe's start, of what was bridged", READ_ONLY),
        Property("NearestStandard", "App::PropertyString", "Measurement", "Standard size within 3 sigma of a free diameter", READ_ONLY),
    )

    def geometry(self, obj: Any) -> Fields:
        """Return both ends."""
        return {"start": [0.0, 0.0, 0.0], "end": [0.0, 0.0, obj.Length.Value]}

    def attributes(self, obj: Any) -> Fields:
        """Return whether the images support the pipe."""
        return {"approximate": obj.Approximate}

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return both ends."""
        return port(tilt_deg=180), port(z=obj.Length.Value)

    def stretch(self, obj: Any, end: int, shift: Any) -> Any:
        """Take up what lies along the axis, unless nothing would be left of the pipe; the other end stays."""
        axis = self.placement(obj).Rotation.multVec(FreeCAD.Vector(0, 0, 1))
        along = shift.dot(axis)
        length = obj.Length.Value + (along if end == END else -along)
        if length < SHORTEST_MM:
            return shift
        obj.Length = length
        if end == START:
            self.move(obj, FreeCAD.Placement(axis * along, FreeCAD.Rotation()))
        return shift - axis * along

    def set_dimensions(self, obj: Any, component: Pipe, frame: Frame) -> None:  # noqa: ARG002
        """Set the length."""
        obj.Length = component.length
        obj.SigmaOutsideDiameter = component.sigma_outer_diameter or 0
        obj.Approximate = component.approximate
        obj.Gaps = [end for gap in component.gaps or () for end in gap]
        obj.NearestStandard = component.nearest_standard or ""

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:
        """Every size of the catalogue is a pipe of the standard."""
        self.say_standard(obj, size.standard if size else None, size.weakest_source if size else None)
