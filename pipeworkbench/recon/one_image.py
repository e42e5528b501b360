# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes that one image only shows, their diameter known: the paper's Table 2, good to some percent of the distance.

The convergence of both edges says how the axis is tilted, the diameter how far away it is; no other image checks
either. What is found so is marked approximate.
"""

from __future__ import annotations

from pipeworkbench.errors import InputError
from pipeworkbench.recon.cylinder_adjustment import HELD_RADIUS_SIGMA, AdjustSettings, CylinderSolution, adjust_cylinder
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.plane_cylinders import cylinder_from_diameter
from pipeworkbench.recon.tangent_planes import apparent_pipe
from pipeworkbench.recon.tangents import PipeTangents
from pipeworkbench.recon.views import View
from pipeworkbench.recon.weights import clicked_extents

SETTINGS = AdjustSettings(ranges=(6.0, 4.0, 2.0))


def solution_of_one_image(view: View, pick: PipePick, diameter: float, tangents: PipeTangents) -> CylinderSolution | str:
    """Return the cylinder of a pick from its image alone, or why there is none.

    Parameters
    ----------
    view : View
        The image that was clicked in.
    pick : PipePick
        With two points on each edge.
    diameter : float
        Outside diameter in mm.
    tangents : PipeTangents
        Of the pick.
    """
    try:
        start = cylinder_from_diameter(apparent_pipe(view.camera, *pick.edges), diameter).cylinder
    except InputError as error:
        return f"{error.problem}; {error.remedy}"
    first, last = clicked_extents(start.as_many(), view.camera.projection_centre, tangents)[0]
    solution = adjust_cylinder([view], start, (float(first), float(last)), (start.radius, HELD_RADIUS_SIGMA), SETTINGS)
    return solution or "its edges in this image do not say how it is tilted; click a longer part of it"
