# SPDX-License-Identifier: LGPL-2.1-or-later
"""Half sections of components that a lathe could turn: points (radius, along the axis) in mm, counted from the frame's origin.

Beside them is what every modeller must ask of the other components first: whether their dimensions make a solid at all.
"""

from __future__ import annotations

import math

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import BLIND_FLANGE, Cap, Elbow, Flange, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.shapes import DISH
from pipeworkbench.solids.frames import Frame, local_point

SHORTEST_MM = 1e-6
# bolts of EN 1092-1 as fractions of the thread's diameter d (ISO 4014, ISO 4032), rounded: they are drawn, not made
HEAD_HEIGHT, NUT_HEIGHT, ACROSS_FLATS, PROTRUSION = 0.63, 0.85, 1.5, 0.25
CLEARANCE_MM = ((12.0, 1.0), (26.0, 2.0), (math.inf, 3.0))  # bolt hole up to this diameter: wider than the bolt by (EN 1092-1)
GASKET_MM = 2.0  # a common thickness, where nothing says how thick it is

Outline = list[tuple[float, float]]


def bolt_diameter(flange: Flange) -> float:
    """Return the diameter of a flange's bolts (mm) from that of their holes; where it is not known the plate's thickness.

    The bolts of EN 1092-1 are hardly ever thicker than the plate.

    Raises
    ------
    InputError
        Where the holes are too small for any bolt.
    """
    if flange.L is None:
        return flange.C
    hole = flange.L
    diameter = hole - next(clearance for limit, clearance in CLEARANCE_MM if hole <= limit)
    if diameter <= 0:
        raise InputError(flange.id, "L", f"a hole of {hole:g} mm takes no bolt", "correct the diameter of the bolt holes")
    return diameter


def bolt_length(flange: Flange, grip: float | None = None) -> float:
    """Return the length of a flange's bolts in mm with their heads: what they need to be pulled out behind the plate.

    Parameters
    ----------
    flange : Flange
    grip : float
        From this flange's back to its partner's in mm; where it is not given, two equal flanges with a gasket.
    """
    grip = 2 * flange.C + GASKET_MM if grip is None else grip
    return grip + (HEAD_HEIGHT + NUT_HEIGHT + PROTRUSION) * bolt_diameter(flange)


def bolt_protrusion(flange: Flange) -> float:
    """Return how far a nut and the bolt's end stand out behind a flange's back, in mm; a head is lower."""
    return (NUT_HEIGHT + PROTRUSION) * bolt_diameter(flange)


def bore_radius(flange: Flange) -> float:
    """Return the radius of a flange's passage in mm: the pipe's, where its wall is known, else 0.

    A flange that the pipe is put through (types 01, 02, 04, 12) is modelled with the end of the pipe in it, because
    its port, where the pipe ends, lies at its back.
    """
    if flange.flange_type == BLIND_FLANGE or flange.wall_thickness is None:
        return 0.0
    return flange.outer_diameter / 2 - flange.wall_thickness


def raised_face(flange: Flange) -> tuple[float, float] | None:
    """Return radius and height of a flange's raised face in mm; None where they are not known."""
    if flange.raised_face_diameter is None or not flange.raised_face_height or flange.raised_face_diameter >= flange.D:
        return None
    return flange.raised_face_diameter / 2, flange.raised_face_height


def neck_outline(flange: Flange) -> Outline:
    """Return the half section of a flange's neck, which begins at the plate's back; empty where there is none.

    The cone goes from ``neck_diameter`` to the pipe's diameter and is followed by the straight part at the weld end.
    """
    if flange.flange_type == BLIND_FLANGE or flange.length - flange.C < SHORTEST_MM:
        return []
    root, pipe, bore = min(flange.neck_diameter or flange.outer_diameter, flange.D) / 2, flange.outer_diameter / 2, bore_radius(flange)
    straight = min(flange.neck_straight or 0.0, flange.length - flange.C)
    points = [(bore, flange.C), (root, flange.C), (pipe, flange.length - straight), (pipe, flange.length), (bore, flange.length)]
    return _without_repetition(points)


def flange_outline(flange: Flange) -> Outline:
    """Return the half section of a whole flange: raised face, plate and neck, without bolt holes."""
    bore, plate, face, neck = bore_radius(flange), flange.D / 2, raised_face(flange), neck_outline(flange)
    if bore >= plate:
        raise InputError(flange.id, "D", f"the plate ({flange.D:g} mm) is not wider than the pipe", "correct D or the outside diameter")
    front = [(bore, 0.0), (face[0], 0.0), (face[0], face[1]), (plate, face[1])] if face else [(bore, 0.0), (plate, 0.0)]
    # the neck goes on where the plate's back meets it
    return _without_repetition([*front, (plate, flange.C), *(neck[1:] or [(bore, flange.C)])])


def reducer_outline(reducer: Reducer) -> Outline:
    """Return the half section of a concentric reducer, a cone."""
    wide, narrow = reducer.outer_diameter / 2, reducer.end_diameter / 2
    if reducer.wall_thickness is None:
        return [(0.0, 0.0), (wide, 0.0), (narrow, reducer.length), (0.0, reducer.length)]
    wall = reducer.wall_thickness
    return [(wide - wall, 0.0), (wide, 0.0), (narrow, reducer.length), (narrow - wall, reducer.length)]


def refuse_tight_bend(elbow: Elbow) -> None:
    """Raise InputError where a bend is so tight that it would run into itself."""
    if elbow.bend_radius <= elbow.outer_diameter / 2:
        raise InputError(elbow.id, "bend_radius", f"{elbow.bend_radius:g} mm is not more than the pipe's radius", "correct the bend radius")


def refuse_odd_reducer(reducer: Reducer) -> None:
    """Raise InputError where a reducer does not lead in the direction of its axis."""
    if reducer.length <= 0:
        raise InputError(reducer.id, "end", "does not lie in the direction of the axis", "correct the reducer's points")


def tee_axes(tee: Tee, frame: Frame) -> tuple[float, float, Array]:
    """Return where a tee's run begins and ends along z, and where its branch ends (3,), in its own axes (mm).

    Raises
    ------
    InputError
        Where they make no tee.
    """
    begin, end = (float(local_point(frame, point)[2]) for point in (tee.start, tee.end))
    branch_end = local_point(frame, tee.branch_end)
    if not begin < 0 < end:
        raise InputError(tee.id, "intersection", "does not lie between the ends of the run", "correct the tee's points")
    if tee.branch_diameter > tee.outer_diameter:
        raise InputError(tee.id, "branch_diameter", f"{tee.branch_diameter:g} mm is more than the run's", "make the thicker pipe the run")
    if branch_end[0] <= tee.outer_diameter / 2:
        raise InputError(tee.id, "branch_end", "lies inside the run", "correct the tee's points")
    return begin, end, branch_end


def dish_height(cap: Cap) -> float:
    """Return the height of a cap's ellipsoidal head in mm."""
    return min(DISH * cap.outer_diameter, cap.length)


def refuse_thick_wall(cap: Cap) -> None:
    """Raise InputError where a cap's wall does not fit into its head."""
    wall, height = cap.wall_thickness, dish_height(cap)
    if wall is not None and wall >= height:
        raise InputError(cap.id, "wall_thickness", f"{wall:g} mm does not fit into a head of {height:g} mm", "give less than the head's height")


def _without_repetition(points: Outline) -> Outline:
    """Leave out points that coincide with the one before."""
    kept = points[:1]
    for point in points[1:]:
        if max(abs(point[0] - kept[-1][0]), abs(point[1] - kept[-1][1])) > SHORTEST_MM:
            kept.append(point)
    return kept
