# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components to solids: the one place where geometry is modelled.

``frames`` says where a component's own axes lie, ``outlines`` gives the half sections of what can be turned on a
lathe, ``model`` makes the solids (CadQuery). The first two are plain numbers, so that a format which knows swept
solids of its own needs no modeller.

``coverings`` says what shapes insulation has, ``covering_limits`` which dimensions of them go together,
``covering_quantities`` gives volumes and areas; ``insulation`` makes the solids, with the boundaries of ``skins``.
"""

from pipeworkbench.solids.covering_limits import largest_thickness
from pipeworkbench.solids.covering_quantities import axis_length, layer_volumes, outer_area
from pipeworkbench.solids.frames import IDENTITY, Frame, frame_of
from pipeworkbench.solids.insulation import CoveringBody, covering_bodies, placed_bodies
from pipeworkbench.solids.model import brep_text, component_solid, flange_bolts, local_solid, straight_pipe

__all__ = [
    "IDENTITY",
    "CoveringBody",
    "Frame",
    "axis_length",
    "brep_text",
    "component_solid",
    "covering_bodies",
    "flange_bolts",
    "frame_of",
    "largest_thickness",
    "layer_volumes",
    "local_solid",
    "outer_area",
    "placed_bodies",
    "straight_pipe",
]
