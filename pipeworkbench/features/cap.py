# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric cap: a dished head that follows its diameter, wall, length and placement."""

from __future__ import annotations

from typing import Any

from pipeworkbench.catalogue import PipeSize, caps
from pipeworkbench.features.base import Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties, port
from pipeworkbench.features.joints import End
from pipeworkbench.pipeline import Cap
from pipeworkbench.solids import Frame


class CapFeature(ComponentFeature):
    """Proxy of a cap. The weld end's centre is the placement's base, the cap closes the pipe along the local z axis."""

    type_name = "PipeWorkbench::Cap"
    kind = Cap
    ends = (End("Start"),)
    standard_dimensions = ("Length",)
    properties = component_properties("Cap", Property("Length", "App::PropertyLength", "Cap", "From the weld end to the top"), ends=ends)

    def geometry(self, obj: Any) -> Fields:
        """Return weld end, axis and length."""
        return {"start": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0], "length": obj.Length.Value}

    def ports(self, obj: Any) -> tuple[Any, ...]:  # noqa: ARG002
        """Return the weld end."""
        return (port(tilt_deg=180),)

    def set_dimensions(self, obj: Any, component: Cap, frame: Frame) -> None:  # noqa: ARG002
        """Set the length."""
        obj.Length = component.length

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the height of a standard cap of the new diameter."""
        cap = self.alike(obj, caps(obj.OutsideDiameter.Value))
        if cap is not None:
            obj.Length = cap.height
