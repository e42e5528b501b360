# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids of insulation: every layer and the jacket of a covering as a valid closed body whose faces have names.

The faces are "inner" and "outer", "begin" and "end" where others follow along the axis, "branch" at the end of a tee's branch or
around the hole for it, "parting" between the half shells of a box and "notch" where something else needs the room.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.covering_limits import refuse_impossible
from pipeworkbench.solids.coverings import (
    AnyCovering,
    AnyNotch,
    BendCovering,
    BlockNotch,
    BoxCovering,
    CapCovering,
    ConeCovering,
    Notch,
    StopCovering,
    StraightCovering,
    TeeCovering,
)
from pipeworkbench.solids.modelling import NamedSolid, NotClosedError, Skin, between, cut, location, turned
from pipeworkbench.solids.skins import cone_skin, gore_skin, pierced_skins, tee_skin, torus_skin

if TYPE_CHECKING:
    import cadquery

CONCENTRIC_MM = 1e-6  # an offset below this is none
INSIDE_MM = 1e-3  # what is nearer to a face lies on it
TRIED, COMPARED = 60, 8  # points of a notch that are looked for in a body, and those that no longer may be there when it is cut
SIGMAS, FEWEST = 5.0, 4  # of what points tell of a volume; points that tell nothing
# by which notches are wider in solids where nearly the same one was cut before, and where nothing else can be cut: less than their air
APART_MM, WIDER_MM = 0.3, (0.1, 0.5, 1.0)
ALIKE_MM, ALIKE_COSINE = 0.2, math.cos(math.radians(10.0))  # of nearly the same notches
# points evenly in a unit cube: multiples of powers of the root of x^4 = x + 1 (Roberts 2018)
SPREAD = np.outer(np.arange(1, 401), 1.22074408460575947536 ** -np.arange(1.0, 4.0)) % 1.0


@dataclass
class CoveringBody:
    """One body: a layer ("layer 1", "layer 2", ... from the inside) or the jacket, with its material and its faces by name.

    Half shells have ", half 1" (on the side of +y) and ", half 2" in their names, pieces that notches part ", part 1" and so on.
    """

    name: str
    material: str
    solid: cadquery.Solid
    faces: dict[str, list[cadquery.Face]] = field(default_factory=dict)


def covering_bodies(covering: AnyCovering) -> list[CoveringBody]:
    """Return the bodies of a covering in its own axes (mm), notches cut, from the inside to the outside.

    Raises
    ------
    InputError
        Where the dimensions make no bodies, or notches leave nothing of one; names the component.
    """
    refuse_impossible(covering)
    try:
        return list(_checked_bodies(covering, _layers(covering)))
    except NotClosedError:
        problem = f"the faces of its insulation '{covering.id}' do not close"
        raise InputError(covering.component, "", problem, "correct the dimensions") from None


def placed_bodies(covering: AnyCovering) -> list[CoveringBody]:
    """Return the bodies of a covering in the pipeline's frame (mm); raises what ``covering_bodies`` does."""
    place = location(covering.frame)

    def moved(body: CoveringBody) -> CoveringBody:
        faces = {name: [face.moved(place) for face in group] for name, group in body.faces.items()}
        return CoveringBody(body.name, body.material, body.solid.moved(place), faces)

    return [moved(body) for body in covering_bodies(covering)]


def _checked_bodies(covering: AnyCovering, layers: list[list[NamedSolid]]) -> Iterator[CoveringBody]:
    materials = [(f"layer {number}", layer.material) for number, layer in enumerate(covering.layers, start=1)]
    if covering.sheet:
        materials.append(("jacket", covering.sheet.material))
    for (name, material), shells in zip(materials, layers, strict=True):
        halves = [f"{name}, half {number}" for number in range(1, len(shells) + 1)] if len(shells) > 1 else [name]
        for half, shell in zip(halves, shells, strict=True):
            parts = _without_notches(covering, half, shell)
            parted = [f"{half}, part {number}" for number in range(1, len(parts) + 1)] if len(parts) > 1 else [half]
            for part, body in zip(parted, parts, strict=True):
                if not (body.solid.isValid() and body.solid.Volume() > 0):
                    problem = f"the dimensions of its insulation make no {covering.kind} ({part})"
                    raise InputError(covering.component, "", problem, "correct the dimensions")
                yield CoveringBody(part, material, body.solid, body.faces)


def _layers(covering: AnyCovering) -> list[list[NamedSolid]]:
    """Return what each layer and the jacket is made of: one body each, of a box two."""
    steps = list(itertools.pairwise(covering.boundaries))
    match covering:
        case StraightCovering():
            bodies = [_tube(covering, inner, outer) for inner, outer in steps]
        case BendCovering():
            bodies = _between_all([torus_skin(covering, covering.radius), *(_bend_skin(covering, outer) for _, outer in steps)])
        case ConeCovering() if abs(covering.offset) < CONCENTRIC_MM:
            bodies = [_concentric(covering, inner, outer) for inner, outer in steps]
        case ConeCovering():
            bodies = _between_all([cone_skin(covering, distance) for distance in covering.boundaries])
        case TeeCovering() if covering.reach:
            bodies = _between_all([tee_skin(covering, distance) for distance in covering.boundaries])
        case TeeCovering():
            bodies = [between(outer, inner, [("branch", wall)]) for outer, inner, wall in pierced_skins(covering)]
        case CapCovering():
            bodies = [_pot(covering, inner, outer) for inner, outer in steps]
        case BoxCovering():
            return [[_half_shell(covering, inner, outer, start) for start in (0.0, math.pi)] for inner, outer in steps]
        case StopCovering():
            bodies = [_disc(covering)]
    return [[body] for body in bodies]


def _between_all(skins: list[Skin]) -> list[NamedSolid]:
    return [between(outer, inner) for inner, outer in itertools.pairwise(skins)]


def _bend_skin(covering: BendCovering, distance: float) -> Skin:
    radius = covering.radius + distance
    return gore_skin(covering, radius) if covering.gores else torus_skin(covering, radius)


def _tube(covering: StraightCovering, inner: float, outer: float) -> NamedSolid:
    low, high, begin, end = covering.radius + inner, covering.radius + outer, covering.begin, covering.end
    return turned([(low, begin), (high, begin), (high, end), (low, end)], ("begin", "outer", "end", "inner"))


def _concentric(covering: ConeCovering, inner: float, outer: float) -> NamedSolid:
    wide, narrow, length = covering.radius, covering.end_radius, covering.length
    section = [(wide + inner, 0.0), (wide + outer, 0.0), (narrow + outer, length), (narrow + inner, length)]
    return turned(section, ("begin", "outer", "end", "inner"))


def _pot(covering: CapCovering, inner: float, outer: float) -> NamedSolid:
    radius, length = covering.radius, covering.length
    inside, outside = (radius + inner, length + inner), (radius + outer, length + outer)
    section = [(inside[0], 0.0), (outside[0], 0.0), outside, (0.0, outside[1]), (0.0, inside[1]), inside]
    return turned(section, ("begin", "outer", "outer", "axis", "inner", "inner"))


def _half_shell(covering: BoxCovering, inner: float, outer: float, start: float) -> NamedSolid:
    """Return one half of a layer of a box, turned from an angle (rad) on."""
    total, (first, last) = covering.total_thickness, covering.openings

    def can(distance: float) -> tuple[float, float, float]:
        return covering.radius + distance, covering.begin + total - distance, covering.end - total + distance

    (radius, low, high), (wide, bottom, top) = can(inner), can(outer)
    section = [(first, bottom), (wide, bottom), (wide, top), (last, top), (last, high), (radius, high), (radius, low), (first, low)]
    return turned(section, ("outer", "outer", "outer", "end", "inner", "inner", "inner", "begin"), start, math.pi)


def _disc(covering: StopCovering) -> NamedSolid:
    radius, outer, thickness = covering.radius, covering.outer_radius, covering.total_thickness
    return turned([(radius, 0.0), (outer, 0.0), (outer, thickness), (radius, thickness)], ("inner", "end", "outer", "begin"))


def _without_notches(covering: AnyCovering, name: str, body: NamedSolid) -> list[NamedSolid]:
    pieces = [body]
    for notch in _apart(covering.notches):
        pieces = [left for piece in pieces for left in _cut(covering, name, piece, notch)]
        if not pieces:
            raise InputError(covering.component, "notches", f"{notch.cause} leaves nothing of its {name}", "leave it bare or move them apart")
    return pieces


def _apart(notches: Sequence[AnyNotch]) -> list[AnyNotch]:
    """Return notches of which round ones that are nearly alike differ by some tenths of a millimetre.

    Those of a bend or of two flanges have nearly the same axis and radius; Open CASCADE cannot tell such faces apart.
    """
    made: list[AnyNotch] = []
    for notch in notches:
        alike = sum(isinstance(other, Notch) and isinstance(notch, Notch) and _alike(notch, other) for other in notches[: len(made)])
        made.append(replace(notch, radius=notch.radius + alike * APART_MM) if isinstance(notch, Notch) else notch)
    return made


def _alike(one: Notch, other: Notch) -> bool:
    axis, other_axis = one.end - one.start, other.end - other.start
    cosine = abs(float(axis @ other_axis)) / float(np.linalg.norm(axis) * np.linalg.norm(other_axis))
    return abs(one.radius - other.radius) < ALIKE_MM and cosine > ALIKE_COSINE


@dataclass(frozen=True, eq=False)
class _Shared:
    """What a body and a notch have in common: some points (n, 3) mm of it, its volume (mm³) and how uncertain that is."""

    points: Array
    volume: float
    tolerance: float


def _cut(covering: AnyCovering, name: str, body: NamedSolid, notch: AnyNotch) -> list[NamedSolid]:
    """Return what a notch leaves of a body, as one of several ways of cutting does it right.

    Open CASCADE may leave all of a body, or too little of it, without an error, where two cylinders' axes are nearly parallel; a tool of
    free-form surfaces or of another radius is cut then. Points tell which way is right.
    """
    tool = _notch_tool(notch)
    shared = _shared(body, notch, tool)
    if shared is None:
        return [body]
    for way in _notch_tools(notch, tool):
        left = cut(body, way, "notch")
        taken = body.solid.Volume() - sum(piece.solid.Volume() for piece in left)
        if abs(taken - shared.volume) <= shared.tolerance and not any(any(_inside(piece.solid, shared.points)) for piece in left):
            return left
    problem = f"{notch.cause} cannot be cut out of its {name}"
    raise InputError(covering.component, "notches", problem, "change its thickness a little or leave it bare")


def _shared(body: NamedSolid, notch: AnyNotch, tool: cadquery.Solid) -> _Shared | None:
    """Return what a body and a notch have in common, None where the boxes around them are apart."""
    one, other = body.solid.BoundingBox(), tool.BoundingBox()
    low = np.array([max(one.xmin, other.xmin), max(one.ymin, other.ymin), max(one.zmin, other.zmin)])
    high = np.array([min(one.xmax, other.xmax), min(one.ymax, other.ymax), min(one.zmax, other.zmax)])
    if not (low < high).all():
        return None
    points = low + SPREAD * (high - low)
    held = points[notch.holds(points)]
    room = float(np.prod(high - low)) * len(held) / len(points)
    tried = held[:TRIED]
    found = np.fromiter(_inside(body.solid, tried), bool, len(tried))
    share = float(found.mean()) if len(found) else 0.0
    deviation = math.hypot(math.sqrt(share * (1 - share) / max(len(found), 1)), 1 / max(len(found), 1))
    # where hardly a point of the box is in the notch, that is not known better than to some of them
    slack = float(np.prod(high - low)) * FEWEST / len(points)
    return _Shared(tried[found][:COMPARED], share * room, SIGMAS * deviation * room + slack)


def _inside(solid: cadquery.Solid, points: Array) -> Iterator[bool]:
    """Yield whether points (n, 3) lie within a solid, one after the other: each takes some milliseconds."""
    from OCP.BRepClass3d import BRepClass3d_SolidClassifier
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_IN

    classifier = BRepClass3d_SolidClassifier(solid.wrapped)

    for point in points.tolist():
        classifier.Perform(gp_Pnt(*point), INSIDE_MM)
        yield bool(classifier.State() == TopAbs_IN)


def _notch_tools(notch: AnyNotch, tool: cadquery.Solid) -> Iterator[cadquery.Solid]:
    """Yield a notch's solid, the same with its faces as free-form surfaces, then as cylinders that are a little wider."""
    from cadquery import Solid
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    yield tool
    yield Solid(BRepBuilderAPI_NurbsConvert(tool.wrapped, True).Shape())
    if isinstance(notch, Notch):
        yield from (_notch_tool(replace(notch, radius=notch.radius + wider)) for wider in WIDER_MM)


def _notch_tool(notch: AnyNotch) -> cadquery.Solid:
    from cadquery import Solid, Vector

    if isinstance(notch, BlockNotch):
        return Solid.makeBox(*notch.size.tolist()).moved(location(notch.frame))
    way = Vector(*notch.end) - Vector(*notch.start)
    return Solid.makeCylinder(notch.radius, way.Length, Vector(*notch.start), way)
