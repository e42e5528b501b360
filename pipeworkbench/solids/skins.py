# SPDX-License-Identifier: LGPL-2.1-or-later
"""The boundaries of bends, tees and eccentric cones as open surfaces, between which their layers lie.

All seams lie in the plane of symmetry, x and z, on the side of -x, so that edges of neighbouring faces begin in the same point.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from pipeworkbench.solids.coverings import BendCovering, ConeCovering, TeeCovering
from pipeworkbench.solids.cylinder_faces import Crossing, Place, crossing, cylinder_face, mitre_border, square_border
from pipeworkbench.solids.modelling import SEWING_MM, Skin, axes, circle, modeller, prism

UP, BACK, SIDE = (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def torus_skin(covering: BendCovering, radius: float) -> Skin:
    """Return the torus of a radius (mm) around a bend's axis and the cylinders under the collars."""
    cq = modeller()
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

    about = gp_Ax1(gp_Pnt(covering.bend_radius, 0, 0), gp_Dir(*SIDE))
    start = circle(axes((0, 0, 0), UP, BACK), radius)
    faces = [cq.Face(BRepPrimAPI_MakeRevol(start.wrapped, about, covering.angle).Shape())]
    first, last = covering.collars
    end = _place_on_bend(covering, covering.angle)
    if first > SEWING_MM / 2:
        faces.append(prism(circle(axes((0, 0, -first), UP, BACK), radius), UP, first))
    if last > SEWING_MM / 2:
        faces.append(prism(circle(end.axes, radius), end.z.tolist(), last))
    return Skin(faces, _bend_rims(covering, radius))


def gore_skin(covering: BendCovering, radius: float) -> Skin:
    """Return the cylinders of a radius (mm) around a bend's gores, with mitred ends.

    A gore touches the bend's axis in the origin of its own axes, where its own is z; its neighbours' planes go through the
    line of the bend's centre at half the joint's angle.
    """
    slope = math.tan(covering.joint_angle / 2)
    first, last = covering.collars
    faces = []
    for number in range(covering.gores):
        place = _place_on_bend(covering, number * covering.joint_angle)
        low = mitre_border(place, radius, -covering.half_length, -slope) if number else square_border(place, radius, -first)
        beyond = number < covering.gores - 1
        high = mitre_border(place, radius, covering.half_length, slope) if beyond else square_border(place, radius, last)
        faces.append(cylinder_face(place, radius, low, high))
    return Skin(faces, _bend_rims(covering, radius))


def cone_skin(covering: ConeCovering, distance: float) -> Skin:
    """Return the straight lines between a cone's circles, at a distance (mm) from its inner face."""
    cq = modeller()
    from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections

    rims = {
        "begin": circle(axes((0, 0, 0), UP, BACK), covering.radius + distance),
        "end": circle(axes((covering.offset, 0, covering.length), UP, BACK), covering.end_radius + distance),
    }
    solid, ruled = False, True
    loft = BRepOffsetAPI_ThruSections(solid, ruled)
    for rim in rims.values():
        loft.AddWire(cq.Wire.assembleEdges([rim]).wrapped)
    loft.Build()
    return Skin(cq.Shape.cast(loft.Shape()).Faces(), rims)


def tee_skin(covering: TeeCovering, distance: float) -> Skin:
    """Return run and branch as one surface, at a distance (mm) from the inner face."""
    radius, branch_radius = covering.radius + distance, covering.branch_radius + distance
    place, branch = _tee_places(covering)
    meeting = crossing(place, radius, branch, branch_radius)
    faces = [
        _run_with_hole(covering, place, radius, meeting),
        cylinder_face(branch, branch_radius, meeting.branch, square_border(branch, branch_radius, covering.reach)),
    ]
    end = Place(branch.origin + covering.reach * branch.z, branch.z, branch.x)
    return Skin(faces, _run_rims(covering, radius) | {"branch": circle(end.axes, branch_radius)})


def pierced_skins(covering: TeeCovering) -> list[tuple[Skin, Skin, Any]]:
    """Return for each layer of a run its outer and its inner face and the wall of the hole for a bare branch between them."""
    place, branch = _tee_places(covering)
    radii = [covering.radius + distance for distance in covering.boundaries]
    meetings = [crossing(place, radius, branch, covering.branch_radius) for radius in radii]
    skins = [
        Skin([_run_with_hole(covering, place, radius, meeting)], _run_rims(covering, radius)) for radius, meeting in zip(radii, meetings, strict=True)
    ]
    walls = [cylinder_face(branch, covering.branch_radius, low.branch, high.branch) for low, high in itertools.pairwise(meetings)]
    return [(outer, inner, wall) for (inner, outer), wall in zip(itertools.pairwise(skins), walls, strict=True)]


def _tee_places(covering: TeeCovering) -> tuple[Place, Place]:
    """Return the axes of a tee's run and of its branch."""
    sine, cosine = math.sin(covering.branch_angle), math.cos(covering.branch_angle)
    origin = np.zeros(3)
    return Place(origin, np.array(UP), np.array(BACK)), Place(origin, np.array((sine, 0.0, cosine)), np.array((-cosine, 0.0, sine)))


def _run_with_hole(covering: TeeCovering, place: Place, radius: float, meeting: Crossing) -> Any:
    low, high = (square_border(place, radius, z) for z in (covering.begin, covering.end))
    return cylinder_face(place, radius, low, high, [meeting.run])


def _run_rims(covering: TeeCovering, radius: float) -> dict[str, Any]:
    return {name: circle(axes((0, 0, z), UP, BACK), radius) for name, z in (("begin", covering.begin), ("end", covering.end))}


def _place_on_bend(covering: BendCovering, angle: float) -> Place:
    """Return axes on the bend's axis at an angle (rad) from its start: z along it, x away from the bend's centre."""
    sine, cosine = math.sin(angle), math.cos(angle)
    out = np.array((-cosine, 0.0, sine))
    return Place(np.array((covering.bend_radius, 0.0, 0.0)) + covering.bend_radius * out, np.array((sine, 0.0, cosine)), out)


def _bend_rims(covering: BendCovering, radius: float) -> dict[str, Any]:
    first, last = covering.collars
    end = _place_on_bend(covering, covering.angle)
    return {
        "begin": circle(axes((0, 0, -first), UP, BACK), radius),
        "end": circle(Place(end.origin + last * end.z, end.z, end.x).axes, radius),
    }
