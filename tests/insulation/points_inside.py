# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which points of space lie within coverings and components: plain formulas beside the solids."""

import math

import numpy as np

from pipeworkbench.pipeline import Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids.coverings import BendCovering, BoxCovering, CapCovering, ConeCovering, StopCovering, StraightCovering, TeeCovering
from pipeworkbench.solids.frames import bend_angle, frame_of, local_point


def local(frame, points):
    """Return points (n, 3) in a frame's axes."""
    return (points - frame.origin) @ np.column_stack([frame.x, frame.y, frame.z])


def within_tube(points, radius, begin, end):
    """Which points lie within a cylinder about z."""
    return (np.hypot(points[:, 0], points[:, 1]) < radius) & (points[:, 2] > begin) & (points[:, 2] < end)


def within_torus(points, radius, bend_radius, angle, collars=(0.0, 0.0)):
    """Which points lie within a bend about (bend_radius, 0, 0) from z on, or within the straight ends of it."""
    x, y, z = points.T
    turn = np.arctan2(z, bend_radius - x)
    away = np.hypot(np.hypot(bend_radius - x, z) - bend_radius, y)
    inside = (away < radius) & (turn > 0) & (turn < angle)
    inside |= within_tube(points, radius, -collars[0], 0.0)
    return inside | within_tube(turned(points, bend_radius, angle), radius, 0.0, collars[1])


def turned(points, bend_radius, turn):
    """Return points in the axes that have gone along a bend by a turn."""
    cos, sin = math.cos(turn), math.sin(turn)
    moved = points - bend_radius * np.array([1 - cos, 0.0, sin])
    return moved @ np.array([(cos, 0.0, -sin), (0.0, 1.0, 0.0), (sin, 0.0, cos)]).T


def within_gores(points, radius, bend_radius, angle, gores, collars):
    """Which points lie within straight pieces between mitre planes, which are those through the bend's centre."""
    joint = angle / (gores - 1)
    from_centre = points - [bend_radius, 0.0, 0.0]
    inside = np.zeros(len(points), bool)
    for k in range(gores):
        own = turned(points, bend_radius, k * joint)
        piece = np.hypot(own[:, 0], own[:, 1]) < radius
        for turn, sign, outer in (((k - 0.5) * joint, 1, k == 0), ((k + 0.5) * joint, -1, k == gores - 1)):
            if outer:
                piece &= own[:, 2] > -collars[0] if k == 0 else own[:, 2] < collars[1]
            else:
                # the plane's normal is the direction of the bend's axis there
                piece &= sign * (from_centre @ [math.sin(turn), 0.0, math.cos(turn)]) > 0
        inside |= piece
    return inside


def within_cone(points, radius, end_radius, length, offset):
    """Which points lie within the straight lines between two circles."""
    share = points[:, 2] / length
    away = np.hypot(points[:, 0] - offset * share, points[:, 1])
    return (away < radius + (end_radius - radius) * share) & (share > 0) & (share < 1)


def within_tee(points, radius, begin, end, branch_radius, angle, reach):
    """Which points lie within a run about z or within its branch."""
    cos, sin = math.cos(angle), math.sin(angle)
    own = points @ np.array([(cos, 0.0, -sin), (0.0, 1.0, 0.0), (sin, 0.0, cos)]).T
    return within_tube(points, radius, begin, end) | within_tube(own, branch_radius, 0.0, reach)


def in_covering(covering, points, outer=None, inner=0.0):
    """Which points (n, 3) of the pipeline lie within a covering, between two distances from its inner face; by default in all of it."""
    own = local(covering.frame, points)
    total = covering.total_thickness
    inside = _inside(covering, own, inner, total if outer is None else outer)
    for notch in covering.notches:
        inside &= ~notch.holds(own)
    return inside


def _inside(covering, own, inner, outer):
    if isinstance(covering, BoxCovering):
        return _in_box(covering, own, inner, outer)
    if isinstance(covering, StopCovering):
        return within_tube(own, covering.outer_radius, 0.0, outer) & ~within_tube(own, covering.radius, 0.0, outer)
    inside = _enclosed(covering, own, outer) & ~_enclosed(covering, own, inner)
    if isinstance(covering, TeeCovering) and not covering.reach:
        inside &= ~within_tee(own, 0.0, covering.begin, covering.end, covering.branch_radius, covering.branch_angle, math.inf)
    return inside


def _enclosed(covering, own, distance):
    """Which points a boundary encloses that lies so far from the inner face."""
    r = covering.radius + distance
    match covering:
        case StraightCovering(begin=begin, end=end):
            return within_tube(own, r, begin, end)
        case BendCovering(bend_radius=bend, angle=angle, gores=gores, collars=collars) if gores and distance:
            return within_gores(own, r, bend, angle, gores, collars)
        case BendCovering(bend_radius=bend, angle=angle, collars=collars):
            return within_torus(own, r, bend, angle, collars)
        case ConeCovering(end_radius=end, length=length, offset=offset):
            return within_cone(own, r, end + distance, length, offset)
        case TeeCovering(begin=begin, end=end, branch_radius=branch, branch_angle=angle, reach=reach):
            return within_tee(own, r, begin, end, branch + distance, angle, reach)
        case CapCovering(length=length):
            return within_tube(own, r, 0.0, length + distance)


def _in_box(covering, own, inner, outer):
    total, begin, end = covering.total_thickness, covering.begin, covering.end

    def can(distance):
        return within_tube(own, covering.radius + distance, begin + total - distance, end - total + distance)

    opening = np.where(own[:, 2] < (begin + end) / 2, *covering.openings)
    in_end = (own[:, 2] < begin + total - inner) | (own[:, 2] > end - total + inner)
    return can(outer) & ~can(inner) & ~((np.hypot(own[:, 0], own[:, 1]) < opening) & in_end)


def in_metal(component, points):
    """Which points (n, 3) lie within a component or what flows in it; of a flange its plate and the neck as wide as its pipe."""
    frame = frame_of(component)
    own, r = local(frame, points), component.outer_diameter / 2
    match component:
        case Pipe():
            return within_tube(own, r, 0.0, component.length)
        case Elbow():
            return within_torus(own, r, component.bend_radius, bend_angle(component))
        case Flange():
            return within_tube(own, component.D / 2, 0.0, component.C) | within_tube(own, r, 0.0, component.length)
        case Tee():
            begin, end = (local_point(frame, point)[2] for point in (component.start, component.end))
            across, _, along = local_point(frame, component.branch_end)
            angle, reach = math.atan2(across, along), math.hypot(across, along)
            return within_tee(own, r, begin, end, component.branch_diameter / 2, angle, reach)
        case Reducer():
            offset = local_point(frame, component.end)[0] if component.reducer_type == "eccentric" else 0.0
            return within_cone(own, r, component.end_diameter / 2, component.length, offset)
        case Cap():
            return within_tube(own, r, 0.0, component.length)
