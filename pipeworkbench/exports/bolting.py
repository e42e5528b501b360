# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where two flanges' faces are joined: the gasket between them and the bolts through them, as far as they are known."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pipeworkbench.pipeline import Flange, Pipeline
from pipeworkbench.solids.outlines import GASKET_MM, NUT_HEIGHT, PROTRUSION, bolt_diameter

FACE = 0  # a flange's port at its sealing face
THINNEST_GASKET_MM, THICKEST_GASKET_MM = 0.5, 10.0  # of what stands between two faces; else a gasket is not seen
LENGTH_STEP_MM = 5.0  # of bolts (ISO 4014, preferred lengths up to 150 mm)


@dataclass(frozen=True)
class Bolts:
    """The bolts of a joint: their thread's diameter and length under the head (mm), and how many they are."""

    diameter: float
    length: float
    count: int


@dataclass(frozen=True)
class BoltedJoint:
    """Two flanges face to face; ``gap`` (mm) is the distance of their faces."""

    a: Flange
    b: Flange
    gap: float

    @property
    def has_gasket(self) -> bool:
        """Whether the faces stand so far apart as a gasket is thick."""
        return THINNEST_GASKET_MM <= self.gap <= THICKEST_GASKET_MM

    @property
    def bolts(self) -> Bolts | None:
        """The bolts by the first flange that says its holes; None where no flange does.

        The length is what plates, gasket and nut need with the thread standing over, rounded up to what bolts are made in;
        where no gasket is seen one of a common thickness is assumed.
        """
        known = next((flange for flange in (self.a, self.b) if flange.L is not None and flange.bolts is not None), None)
        if known is None or known.bolts is None:
            return None
        diameter = bolt_diameter(known)
        grip = self.a.C + self.b.C + (self.gap if self.has_gasket else GASKET_MM)
        length = math.ceil((grip + (NUT_HEIGHT + PROTRUSION) * diameter) / LENGTH_STEP_MM) * LENGTH_STEP_MM
        return Bolts(diameter, length, known.bolts)


def bolted_joints(pipeline: Pipeline) -> tuple[BoltedJoint, ...]:
    """Return a pipeline's joints of flanges face to face, in its order."""
    flanges = {component.id: component for component in pipeline.components if isinstance(component, Flange)}
    found = []
    for joint in pipeline.joints:
        a, b = flanges.get(joint.a), flanges.get(joint.b)
        if a is not None and b is not None and joint.a_port == joint.b_port == FACE:
            found.append(BoltedJoint(a, b, math.dist(a.face, b.face)))
    return tuple(found)
