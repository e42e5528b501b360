# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric tee: a run and a branch that follow their diameters, wall, lengths and placement."""

from __future__ import annotations

import math
from typing import Any

from pipeworkbench.catalogue import PipeSize, tees
from pipeworkbench.features.base import READ_ONLY, Property
from pipeworkbench.features.component import ComponentFeature, Fields, component_properties, port
from pipeworkbench.features.joints import End
from pipeworkbench.pipeline import Tee
from pipeworkbench.solids import Frame
from pipeworkbench.solids.frames import local_point

BRANCH = 2


class TeeFeature(ComponentFeature):
    """Proxy of a tee. The axes meet at the placement's base; the run lies along z, the branch goes towards x."""

    type_name = "PipeWorkbench::Tee"
    kind = Tee
    ends = (End("Start"), End("End"), End("Branch", "BranchDiameter"))
    choices = ("BranchDiameter",)
    standard_dimensions = ("StartLength", "EndLength", "BranchLength", "BranchAngle")
    properties = component_properties(
        "Tee",
        Property("StartLength", "App::PropertyLength", "Tee", "From the branch's axis to the start of the run"),
        Property("EndLength", "App::PropertyLength", "Tee", "From the branch's axis to the end of the run"),
        Property("BranchDiameter", "App::PropertyLength", "Tee", "Outside diameter of the branch"),
        Property("BranchLength", "App::PropertyLength", "Tee", "From the run's axis to the end of the branch"),
        Property("BranchAngle", "App::PropertyAngle", "Tee", "Between the run's direction and the branch"),
        Property("TeeType", "App::PropertyString", "Tee", "A fitting (tee) or a branch welded on (set-on)", READ_ONLY),
        ends=ends,
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

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return both ends of the run and the branch's."""
        x, _, z = self.geometry(obj)["branch_end"]
        return port(z=-obj.StartLength.Value, tilt_deg=180), port(z=obj.EndLength.Value), port(x, z, obj.BranchAngle.Value)

    def why_not_resized(self, obj: Any, end: int, diameter: float) -> str:
        """Say that a tee ends a run, for its branch would change with it; its branch may take another diameter."""
        if end != BRANCH:
            return "a tee ends the run; give the tee the diameter itself"
        return "" if diameter <= obj.OutsideDiameter.Value else "its branch would be wider than its run"

    def set_dimensions(self, obj: Any, component: Tee, frame: Frame) -> None:
        """Set lengths, branch and type."""
        branch = local_point(frame, component.branch_end)
        obj.StartLength = -float(local_point(frame, component.start)[2])
        obj.EndLength = float(local_point(frame, component.end)[2])
        obj.BranchDiameter = component.branch_diameter
        obj.BranchLength = math.hypot(*branch)
        obj.BranchAngle = math.degrees(math.atan2(branch[0], branch[2]))
        obj.TeeType = component.tee_type

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the lengths of a standard tee of both diameters."""
        tee = self.alike(obj, tees(obj.OutsideDiameter.Value, obj.BranchDiameter.Value))
        if tee is not None:
            obj.StartLength = obj.EndLength = tee.run_length
            obj.BranchLength = tee.branch_length or obj.BranchLength

    def choose(self, obj: Any, name: str) -> None:  # noqa: ARG002
        """Another branch makes another tee."""
        self.set_standard(obj, None)
