# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric pipe: a hollow solid that follows its diameter, wall, length and placement."""

from __future__ import annotations

from typing import Any

from pipeworkbench.catalogue import PipeSize
from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.component import GRADES, ComponentFeature, Fields, component_properties
from pipeworkbench.pipeline import Pipe
from pipeworkbench.solids import Frame


class PipeFeature(ComponentFeature):
    """Proxy of a pipe. Length runs along the local z axis, from the placement's base."""

    type_name = "PipeWorkbench::Pipe"
    kind = Pipe
    properties = (
        *component_properties("Pipe", Property("Length", "App::PropertyLength", "Pipe", "Length along the axis")),
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

    def set_dimensions(self, obj: Any, component: Pipe, frame: Frame) -> None:  # noqa: ARG002
        """Set the length."""
        obj.Length = component.length
        obj.SigmaOutsideDiameter = component.sigma_outer_diameter or 0
        obj.Approximate = component.approximate
        obj.Gaps = [end for gap in component.gaps or () for end in gap]
        obj.NearestStandard = component.nearest_standard or ""

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:
        """Every size of the catalogue is a pipe of the standard."""
        obj.Standard = size.standard if size else ""
        obj.StandardSources = GRADES[size.weakest_source if size else None]
