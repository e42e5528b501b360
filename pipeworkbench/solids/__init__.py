# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components to solids: the one place where geometry is modelled.

``frames`` says where a component's own axes lie, ``outlines`` gives the half sections of what can be turned on a
lathe, ``model`` makes the solids (CadQuery). The first two are plain numbers, so that a format which knows swept
solids of its own needs no modeller.
"""

from pipeworkbench.solids.frames import IDENTITY, Frame, frame_of
from pipeworkbench.solids.model import brep_text, component_solid, flange_bolts, local_solid, straight_pipe

__all__ = ["IDENTITY", "Frame", "brep_text", "component_solid", "flange_bolts", "frame_of", "local_solid", "straight_pipe"]
