# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric tee: a run and a branch that follow their diameters, wall, lengths and placement."""

from __future__ import annotations

import math
from typing import Any

from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties
from pipeworkbench.pipeline import Tee
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import local_point


class TeeFeature(ComponentFeature):
    """Proxy of a tee. The axes meet at the placement's base; the run lies along z, the branch goes towards x."""

    type_name = "PipeWorkbench::Tee"
    kind = Tee
    standard_dimensions = ("BranchDiameter", "StartLength", "EndLength", "BranchLength", "BranchAngle")
    properties = component_properties(
        "Tee",
        Property("StartLength", "App::PropertyLength", "Tee", "From the branch's axis to the start of the run"),
        Property("EndLength", "App::PropertyLength", "Tee", "From the branch's axis to the end of the run"),
        Property("BranchDiameter", "App::PropertyLength", "Tee", "Outside diameter of the branch"),
        Property("BranchLength", "App::PropertyLength", "Tee", "From the run's axis to the end of the branch"),
        Property("BranchAngle", "App::PropertyAngle", "Tee", "Between the run's direction and the branch"),
        Property("TeeType", "App::PropertyString", "Tee", "A fitting (tee) or a branch welded on (set-on)", READ_ONLY),
    )

    def geometry(self, obj: Any) -> Fields:
        """Return the ends of run and branch."""
        angle, length = math.radians(obj.BranchAngle.Value), obj.BranchLength.Value
        return {
            "start": [0.0, 0.0, -obj.StartLength.Value],
            "end": [0.0, 0.0, obj.EndLength.Value],
            "intersection": [0.0, 0.0, 0.0],
            "branch_end": [length * math.sin(angle), 0.0, length * math.cos(angle)],
            "branch_diameter": obj.BranchDiameter.Value,
        }

    def attributes(self, obj: Any) -> Fields:
        """Return how it is made."""
        return {"tee_type": obj.TeeType or "tee"}

    def set_dimensions(self, obj: Any, component: Tee, frame: Frame) -> None:
        """Set lengths, branch and type."""
        branch = local_point(frame, component.branch_end)
        obj.StartLength = -float(local_point(frame, component.start)[2])
        obj.EndLength = float(local_point(frame, component.end)[2])
        obj.BranchDiameter = component.branch_diameter
        obj.BranchLength = math.hypot(*branch)
        obj.BranchAngle = math.degrees(math.atan2(branch[0], branch[2]))
        obj.TeeType = component.tee_type
