# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volumes, areas and lengths of coverings from formulas: plain numbers, no solids. Notches are not taken off."""

from __future__ import annotations

import itertools
import math

import numpy as np

from pipeworkbench.solids.coverings import (
    AnyCovering,
    BendCovering,
    BoxCovering,
    CapCovering,
    ConeCovering,
    StopCovering,
    StraightCovering,
    TeeCovering,
)

AROUND = 1024  # points around an oblique cone; the mean over a period converges faster than any power


def layer_volumes(covering: AnyCovering) -> tuple[float, ...]:
    """Return the volume (mm³) of each layer, then of the jacket where there is one; of a box that of both halves."""
    enclosed = [_enclosed_volume(covering, distance) for distance in covering.boundaries]
    return tuple(outer - inner for inner, outer in itertools.pairwise(enclosed))


def outer_area(covering: AnyCovering) -> float:
    """Return the area (mm²) of the outer face, the jacket's or the last layer's, without the ends where others follow.

    A cap's bottom and the ends of a box around its openings belong to it; a stop has the side that looks outwards.
    """
    total = covering.total_thickness
    match covering:
        case StraightCovering() | BendCovering():
            return 2 * math.pi * (covering.radius + total) * axis_length(covering)
        case ConeCovering():
            return _cone_area(covering.radius + total, covering.end_radius + total, covering.length, covering.offset)
        case TeeCovering():
            return _tee_area(covering)
        case CapCovering():
            outer = covering.radius + total
            return 2 * math.pi * outer * (covering.length + total) + math.pi * outer**2
        case BoxCovering():
            outer = covering.radius + total
            ends = sum(outer**2 - opening**2 for opening in covering.openings)
            return 2 * math.pi * outer * (covering.end - covering.begin) + math.pi * ends
        case StopCovering():
            return math.pi * (covering.outer_radius**2 - covering.radius**2)


def axis_length(covering: AnyCovering) -> float:
    """Return the length (mm) of the insulated axis: of a segmented bend its pieces', of a tee run and branch, of a stop 0."""
    match covering:
        case StraightCovering() | BoxCovering():
            return covering.end - covering.begin
        case BendCovering():
            bent = covering.bend_radius * covering.angle if not covering.gores else 2 * (covering.gores - 1) * covering.half_length
            return bent + sum(covering.collars)
        case ConeCovering() | CapCovering():
            return covering.length
        case TeeCovering():
            return covering.end - covering.begin + covering.reach
        case StopCovering():
            return 0.0


def crossing_volume(radius: float, branch_radius: float, angle: float) -> float:
    """Return the volume (mm³) that two cylinders have in common whose axes cross at an angle (rad).

    A section at the distance y from both axes is a parallelogram of the area 4 sqrt(r² - y²) sqrt(b² - y²) / sin(angle). Its
    integral is 8/3 r ((r² + b²) E(m) - (r² - b²) K(m)) / sin(angle) with the complete elliptic integrals of m = b² / r²
    (for equal radii 16/3 r³ / sin(angle), the Steinmetz solid).
    """
    first, second = _elliptic(radius, branch_radius)
    both, apart = radius**2 + branch_radius**2, radius**2 - branch_radius**2
    return 8 / 3 * radius * (both * second - apart * first) / math.sin(angle)


def hole_area(radius: float, branch_radius: float, angle: float) -> float:
    """Return the area (mm²) that a branch covers on a run's cylinder: 4 r² (E(m) - (1 - m) K(m)) / sin(angle), m = b² / r²."""
    first, second = _elliptic(radius, branch_radius)
    return 4 * (radius**2 * second - (radius**2 - branch_radius**2) * first) / math.sin(angle)


def _elliptic(radius: float, branch_radius: float) -> tuple[float, float]:
    """Return K(m) and E(m); for equal radii, where K is infinite but always multiplied by 0, K is told as 0."""
    from scipy.special import ellipe, ellipkm1

    rest = (radius - branch_radius) * (radius + branch_radius) / radius**2
    return (float(ellipkm1(rest)) if rest > 0 else 0.0), float(ellipe(1 - rest))


def _enclosed_volume(covering: AnyCovering, distance: float) -> float:
    """Return the volume (mm³) inside the boundary at a distance (mm) from the inner face, between the planes of the ends."""
    radius = covering.radius + distance
    match covering:
        case StraightCovering():
            volume = math.pi * radius**2 * axis_length(covering)
        case BendCovering():
            # Pappus; the mean length of an obliquely cut cylinder is its axis'. The innermost face is the elbow's own
            straight = covering.bend_radius * covering.angle + sum(covering.collars)
            volume = math.pi * radius**2 * (axis_length(covering) if distance else straight)
        case ConeCovering():
            end = covering.end_radius + distance
            volume = math.pi * covering.length * (radius**2 + radius * end + end**2) / 3
        case TeeCovering():
            volume = _tee_volume(covering, distance)
        case CapCovering():
            volume = math.pi * radius**2 * (covering.length + distance)
        case BoxCovering():
            missing = covering.total_thickness - distance
            # a layer of the ends lacks its opening: the passages are taken as long as the layers inside of the boundary
            passages = sum(opening**2 for opening in covering.openings) * distance
            volume = math.pi * (radius**2 * (covering.end - covering.begin - 2 * missing) - passages)
        case StopCovering():
            volume = math.pi * (covering.outer_radius**2 - covering.radius**2) * distance
    return volume


def _tee_volume(covering: TeeCovering, distance: float) -> float:
    """Return run and branch less what they have in common: by symmetry half of what the whole cylinders have."""
    run = covering.radius + distance
    branch = covering.branch_radius + (distance if covering.reach else 0.0)
    common = crossing_volume(run, branch, covering.branch_angle) / 2
    return math.pi * run**2 * (covering.end - covering.begin) + math.pi * branch**2 * covering.reach - common


def _tee_area(covering: TeeCovering) -> float:
    """Return the run's area without the branch's hole and the branch's down to the run.

    A line of the branch's cylinder at the angle p from the plane of both axes begins (sqrt(r² - b² sin² p) - b cos p cos a) / sin a
    from the origin; around the branch the mean of the root is 2/pi r E(b² / r²), the other term's is 0.
    """
    total, angle = covering.total_thickness, covering.branch_angle
    run = covering.radius + total
    branch = covering.branch_radius + (total if covering.reach else 0.0)
    area = 2 * math.pi * run * (covering.end - covering.begin) - hole_area(run, branch, angle)
    if not covering.reach:
        return area
    _, second = _elliptic(run, branch)
    return area + 2 * math.pi * branch * covering.reach - 4 * branch * run * second / math.sin(angle)


def _cone_area(radius: float, end_radius: float, length: float, offset: float) -> float:
    """Return the area (mm²) of the straight lines between two circles: mean radius times height times the slopes around it.

    With p around the axis the area's element is r(z) sqrt(1 + (r' + o' cos p)²) dp dz, where r' and o' are the changes
    of radius and centre along z.
    """
    around = np.arange(AROUND) * (2 * math.pi / AROUND)
    slopes = ((end_radius - radius) + offset * np.cos(around)) / length
    return float((radius + end_radius) * length * math.pi * np.mean(np.hypot(1.0, slopes)))
