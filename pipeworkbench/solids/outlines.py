# SPDX-License-Identifier: LGPL-2.1-or-later
"""Half sections of components that a lathe could turn: points (radius, along the axis) in mm, counted from the frame's origin.

Beside them is what every modeller must ask of the other components first: whether their dimensions make a solid at all.
"""

from __future__ import annotations

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import BLIND_FLANGE, Cap, Elbow, Flange, Reducer, Tee
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.shapes import DISH
from pipeworkbench.solids.frames import Frame, local_point

SHORTEST_MM = 1e-6

Outline = list[tuple[float, float]]


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
