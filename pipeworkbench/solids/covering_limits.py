# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which dimensions of coverings go together: the largest thickness, the fewest gores, the shortest collars. Plain numbers.

The sections through a bend's and a tee's plane of symmetry say where faces of insulation would run into each other; the
formulas stand with the functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from pipeworkbench.errors import InputError
from pipeworkbench.solids.coverings import (
    AnyCovering,
    BendCovering,
    BlockNotch,
    BoxCovering,
    CapCovering,
    ConeCovering,
    StopCovering,
    StraightCovering,
    TeeCovering,
)

LEAST_MM = 1.0  # what must be left of a throat, an end or a hollow: less can neither be made nor modelled
STEP_MM = 0.1  # limits are told to so much
ROUNDING_MM = 1e-6  # by how much a limit may be missed: what was told must work
LARGEST_JOINT_DEG = 120.0  # between neighbouring gores; a mitre becomes infinitely long at 180


def largest_thickness(covering: AnyCovering) -> float:
    """Return the largest thickness (mm) of all layers and the jacket that a covering of these dimensions can have.

    Bend: the throat of the torus and of gores between others is R - r; a first or last gore's is
    collar + (R - r) tan(joint / 2), all that counts where there are two gores. Tee: what the branch cuts out of the run lies
    between begin and end, and the branch's end outside of the run. Box: a hollow is left between both ends.
    Infinite for other kinds.
    """
    match covering:
        case BendCovering():
            return _largest_of_bend(covering)
        case TeeCovering():
            return _largest_of_tee(covering)
        case BoxCovering():
            return (covering.end - covering.begin - LEAST_MM) / 2
    return math.inf


def least_first_boundary(covering: BendCovering) -> float:
    """Return how thick (mm) the first layer of a segmented bend must at least be, so that the elbow does not stick out of it.

    In the plane through the bend's axis at the joint (c the cosine of half the joint's angle, radius r, bend radius R) the torus'
    point at angle a from the outside lies hypot(r c cos a - R (1 - c), r sin a) from the gore's axis. That is largest at the
    throat, R - (R - r) c, or where cos a = -c R / (r (1 + c)): sqrt(r² + R² tan²(joint / 4)).
    """
    if covering.gores < 2:
        return 0.0
    half = covering.joint_angle / 2
    c, radius, bend = math.cos(half), covering.radius, covering.bend_radius
    if c * bend >= radius * (1 + c):
        return bend - (bend - radius) * c - radius
    return math.hypot(radius, bend * math.tan(half / 2)) - radius


def least_gores(radius: float, bend_radius: float, angle: float, first_layer: float) -> int:
    """Return the fewest gores under whose first layer (mm) an elbow of an angle (rad) does not come out (``least_first_boundary``).

    The least joint angle follows from the same formulas, solved for it.
    """
    outer = radius + first_layer
    cosine = max((bend_radius - outer) / (bend_radius - radius), -1.0)
    throat = 2 * math.acos(cosine)
    beside = 4 * math.atan(math.sqrt(outer**2 - radius**2) / bend_radius)
    c = math.cos(throat / 2)
    joint = throat if c * bend_radius >= radius * (1 + c) else beside
    joint = min(joint, math.radians(LARGEST_JOINT_DEG))
    return max(2, 1 + math.ceil(angle / joint - 1e-9))


def least_mitre_collar(outer_radius: float, bend_radius: float, angle: float) -> float:
    """Return how long (mm) the collars of a single mitre joint must at least be; 0 where the throat is long enough without."""
    return max(LEAST_MM + (outer_radius - bend_radius) * math.tan(angle / 2), 0.0)


def least_tee_extent(covering: TeeCovering) -> tuple[float, float, float]:
    """Return the values that a tee's begin must not exceed and that its end and its reach must not fall short of (mm).

    With the outer faces' radii r of the run and b of the branch, at the angle a: the branch meets the run between
    (r cos a -+ b) / sin a, and its end comes out of the run from (r + b |cos a|) / sin a on. Where ``reach`` is 0, the hole for
    the bare branch counts at the inner and at the outer face, and the reach is 0.
    """
    sine, cosine = math.sin(covering.branch_angle), math.cos(covering.branch_angle)
    total = covering.total_thickness
    outer = covering.radius + total
    branch, radii = (covering.branch_radius + total, (outer,)) if covering.reach else (covering.branch_radius, (covering.radius, outer))
    heel = min((radius * cosine - branch) / sine for radius in radii)
    toe = max((radius * cosine + branch) / sine for radius in radii)
    reach = (outer + branch * abs(cosine)) / sine + LEAST_MM if covering.reach else 0.0
    return heel - LEAST_MM, toe + LEAST_MM, reach


def refuse_impossible(covering: AnyCovering) -> None:
    """Raise InputError where a covering's dimensions cannot be built; it names the component and the largest value that works."""
    _refuse_bad_layers(covering)
    _refuse_bad_notches(covering)
    match covering:
        case StraightCovering() | BoxCovering():
            _refuse(covering, "end", covering.end - covering.begin, "is not behind its begin")
        case ConeCovering():
            _refuse(covering, "length", covering.length)
            _refuse(covering, "end_radius", covering.end_radius)
        case CapCovering():
            _refuse(covering, "length", covering.length)
        case StopCovering():
            _refuse(covering, "outer_radius", covering.outer_radius - covering.radius, "is not larger than the radius")
        case BendCovering():
            _refuse_bad_bend(covering)
        case TeeCovering():
            _refuse_bad_tee(covering)
    if isinstance(covering, BoxCovering):
        _refuse_bad_openings(covering)
    _refuse_too_thick(covering)
    if isinstance(covering, BendCovering):
        _refuse_elbow_outside(covering)
    if isinstance(covering, TeeCovering):
        _refuse_short_tee(covering)


def _refuse(covering: AnyCovering, key: str, value: float, problem: str = "must be positive") -> None:
    if not (math.isfinite(value) and value > 0):
        raise InputError(covering.component, key, problem, f"correct the dimensions of its insulation '{covering.id}'")


def _refuse_bad_layers(covering: AnyCovering) -> None:
    if isinstance(covering, StopCovering):
        if covering.layers or covering.sheet is None:
            raise InputError(covering.component, "layers", "a stop is made of sheet metal alone", "give it a sheet and no layers")
    elif not (covering.layers or covering.sheet):
        raise InputError(covering.component, "layers", "its insulation has neither layers nor a jacket", "give it a layer")
    for layer in covering.layers:
        _refuse(covering, "thickness", layer.thickness, f"{layer.thickness:g} mm of {layer.material} is no thickness")
    if covering.sheet:
        _refuse(covering, "jacket.thickness", covering.sheet.thickness, f"{covering.sheet.thickness:g} mm is no thickness")
    _refuse(covering, "radius", covering.radius)


def _refuse_bad_notches(covering: AnyCovering) -> None:
    for index, notch in enumerate(covering.notches):
        if isinstance(notch, BlockNotch):
            _refuse(covering, f"notches[{index}].size", float(min(notch.size)))
            continue
        _refuse(covering, f"notches[{index}].radius", notch.radius)
        _refuse(covering, f"notches[{index}].end", math.dist(notch.start, notch.end), "is the same point as its start")


def _refuse_bad_bend(covering: BendCovering) -> None:
    name, gores = covering.component, covering.gores
    _refuse(covering, "angle", covering.angle)
    if covering.angle > math.pi + 1e-9:
        raise InputError(name, "angle", f"{math.degrees(covering.angle):g} degrees is more than half a turn", "part the bend")
    if covering.bend_radius <= covering.radius:
        problem = f"{covering.bend_radius:g} mm is not more than the component's radius {covering.radius:g} mm"
        raise InputError(name, "bend_radius", problem, "correct the bend radius")
    if min(covering.collars) < 0:
        raise InputError(name, "collars", f"{min(covering.collars):g} mm is less than nothing", "give 0 mm or more")
    if gores < 0 or gores == 1:
        raise InputError(name, "gores", f"{gores} gores make no bend", "give at least 2, or 0 for a smooth one")
    if gores and math.degrees(covering.joint_angle) > LARGEST_JOINT_DEG:
        least = 1 + math.ceil(math.degrees(covering.angle) / LARGEST_JOINT_DEG)
        raise InputError(name, "gores", f"{gores} gores meet at {math.degrees(covering.joint_angle):g} degrees", f"give at least {least}")


def _refuse_bad_tee(covering: TeeCovering) -> None:
    name = covering.component
    _refuse(covering, "branch_radius", covering.branch_radius)
    if covering.branch_radius > covering.radius:
        problem = f"{covering.branch_radius:g} mm is more than the run's {covering.radius:g} mm"
        raise InputError(name, "branch_radius", problem, "make the thicker pipe the run")
    if not 0 < covering.branch_angle < math.pi:
        raise InputError(name, "branch_angle", "the branch does not leave the run", "give more than 0 and less than 180 degrees")
    if covering.reach < 0:
        raise InputError(name, "reach", f"{covering.reach:g} mm is less than nothing", "give 0 mm or more")
    _refuse(covering, "begin", -covering.begin, "does not lie before the branch")
    _refuse(covering, "end", covering.end, "does not lie behind the branch")


def _refuse_bad_openings(covering: BoxCovering) -> None:
    for opening in covering.openings:
        if opening < 0:
            raise InputError(covering.component, "openings", f"{opening:g} mm is less than nothing", "give 0 mm where an end is closed")
        if opening > covering.radius - LEAST_MM + ROUNDING_MM:
            problem = f"{opening:g} mm is not less than the hollow's radius {covering.radius:g} mm"
            remedy = f"give at most {_rounded_down(covering.radius - LEAST_MM):g} mm or make the box wider"
            raise InputError(covering.component, "openings", problem, remedy)


def _refuse_too_thick(covering: AnyCovering) -> None:
    limit = largest_thickness(covering)
    if covering.total_thickness <= limit + ROUNDING_MM:
        return
    sheet = covering.sheet.thickness if covering.sheet else 0.0
    largest = _rounded_down(limit - sheet)
    where = {"bend": "the throat of the bend", "tee": "the room beside the branch", "box": "half the length of the box"}[covering.kind]
    ways = [f"give at most {largest:g} mm" if largest > 0 else "leave it bare"]
    if isinstance(covering, TeeCovering):
        ways.append(_extent_told(covering))
    remedy = " or ".join(ways)
    raise InputError(covering.component, "thickness", f"{covering.thickness:g} mm is more than {where} allows", remedy)


def _extent_told(covering: TeeCovering) -> str:
    begin, end, reach = least_tee_extent(covering)
    far = f" and to {_rounded_up(reach):g} mm along the branch" if covering.reach else ""
    return f"cover the run from {_rounded_down(begin):g} to {_rounded_up(end):g} mm{far}"


def _refuse_elbow_outside(covering: BendCovering) -> None:
    least, first = least_first_boundary(covering), covering.boundaries[1]
    if covering.gores and first < least - ROUNDING_MM:
        enough = least_gores(covering.radius, covering.bend_radius, covering.angle, first)
        problem = f"with {covering.gores} gores the elbow comes out of the first layer ({first:g} mm)"
        raise InputError(covering.component, "gores", problem, f"give at least {enough} gores or {_rounded_up(least):g} mm")


def _refuse_short_tee(covering: TeeCovering) -> None:
    """Raise what a tee's largest thickness cannot tell: ends and reach that are too near whatever the thickness."""
    begin, end, reach = least_tee_extent(covering)
    keys = (
        ("begin", covering.begin <= begin + ROUNDING_MM, begin),
        ("end", covering.end >= end - ROUNDING_MM, end),
        ("reach", covering.reach >= reach - ROUNDING_MM, reach),
    )
    for key, far_enough, limit in keys:
        if not far_enough:
            told = f"at most {_rounded_down(limit):g}" if key == "begin" else f"at least {_rounded_up(limit):g}"
            raise InputError(covering.component, key, f"{getattr(covering, key):g} mm is too near the branch", f"give {told} mm")


def _largest_of_bend(covering: BendCovering) -> float:
    if covering.gores != 2:
        return covering.bend_radius - covering.radius - LEAST_MM
    throat = (min(covering.collars) - LEAST_MM) / math.tan(covering.joint_angle / 2)
    return covering.bend_radius - covering.radius + throat


def _largest_of_tee(covering: TeeCovering) -> float:
    """Solve ``least_tee_extent`` for the thickness that begin, end and reach leave."""
    return min(_tee_limits(covering), default=math.inf)


def _tee_limits(covering: TeeCovering) -> Iterator[float]:
    sine, cosine = math.sin(covering.branch_angle), math.cos(covering.branch_angle)
    run, branch = covering.radius, covering.branch_radius
    toe_room = (covering.end - LEAST_MM) * sine - run * cosine - branch
    heel_room = -(covering.begin + LEAST_MM) * sine + run * cosine - branch
    if covering.reach:
        yield toe_room / (1 + cosine)
        yield heel_room / (1 - cosine)
        yield ((covering.reach - LEAST_MM) * sine - run - branch * abs(cosine)) / (1 + abs(cosine))
    elif cosine > 0:
        yield toe_room / cosine
    elif cosine < 0:
        yield heel_room / -cosine


def _rounded_down(value: float) -> float:
    return math.floor((value + ROUNDING_MM) / STEP_MM) * STEP_MM


def _rounded_up(value: float) -> float:
    return math.ceil((value - ROUNDING_MM) / STEP_MM) * STEP_MM
