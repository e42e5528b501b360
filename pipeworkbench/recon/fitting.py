# SPDX-License-Identifier: LGPL-2.1-or-later
"""Found fittings put between their pipes: pipes end where fittings begin, and axes meet where they should."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Elbow, Flange, Pipe, Tee, free_id
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.caps import FoundCap
from pipeworkbench.recon.elbows import FoundElbow
from pipeworkbench.recon.ends import line_of, shared_course
from pipeworkbench.recon.reducers import FoundReducer
from pipeworkbench.recon.tees import FoundTee
from pipeworkbench.recon.vectors import angle_between, as_vector, nearest_on_line

SHORTEST_PIPE = 0.02  # diameters that must remain of a pipe between two elbows
FLANGE_OFF_AXIS = 0.25  # pipe diameters a flange's weld end may lie beside the axis of its pipe
FLANGE_COSINE = 0.98
FLANGE_REACH = 2.0  # rim diameters that a pipe's visible end may be short of its flange: bolts and the rim hide it
THROUGH = 1.0  # pipe diameters by which a pipe must go on beyond a face to be a piece of its own there
SAME_DIAMETER = 0.02  # relative
KNOWN_OFF_AXIS, KNOWN_OVERLAP = 0.5, 0.2  # pipe diameters and part of the shorter one, where two pipes are one
SEAM = 1.0  # branch diameters from the axis of a branch that is set on to where its seam's influence ends


@dataclass(frozen=True)
class Assembly:
    """Components, their ends (row, port) that are taken, and the name of the station that new ids begin with."""

    components: tuple[AnyComponent, ...]
    taken: frozenset[tuple[int, int]]
    station: str | None

    def new_id(self, letter: str) -> str:
        """Return an id that no component has: the station's name, a letter for the kind and a number."""
        used = {component.id for component in self.components}
        prefix = f"{self.station}-{letter}" if self.station else letter
        return next(name for number in range(len(used) + 1) if (name := f"{prefix}{number:02d}") not in used)

    def added(self, component: AnyComponent, changed: Mapping[int, AnyComponent], taken: Sequence[tuple[int, int]]) -> Assembly:
        """Return the assembly with another component, with changed ones and with ends taken."""
        components = tuple(changed.get(row, old) for row, old in enumerate(self.components))
        return replace(self, components=(*components, component), taken=self.taken | set(taken))


def with_flanges(components: Sequence[AnyComponent]) -> tuple[AnyComponent, ...]:
    """Return the components with pipes that end at their flanges' weld ends; one that was followed through a flange becomes two.

    The pieces come last, so that the rows of what was given stay.
    """
    result = list(components)
    for flange in components:
        if not isinstance(flange, Flange) or len(flange.ports) < 2:
            continue
        found = _pipe_of_flange(result, flange)
        if found is None:
            continue
        row, low, high = found
        pipe = result[row]
        if not isinstance(pipe, Pipe) or pipe.fixed:
            continue
        axis, weld_end = -np.array(flange.axis), np.array(flange.ports[1].point)
        inwards = 0 if np.subtract(pipe.end, pipe.start) @ axis > 0 else 1  # the port that belongs to the flange
        through = -low - flange.length > THROUGH * pipe.outer_diameter
        whole = pipe
        result[row] = _with_end(pipe, inwards, nearest_on_line(weld_end, *line_of(whole)))
        if through:
            other = _with_end(whole, 1 - inwards, nearest_on_line(np.array(flange.face), *line_of(whole)))
            if -low - flange.length > high:  # the longer piece stays the pipe that was picked
                result[row], other = other, result[row]  # type: ignore[assignment]
            # a neighbour that was picked itself needs no second copy
            if not _is_known(other, result):
                result.append(replace(other, id=free_id(pipe.id, {one.id for one in result}), pick=None))
    return tuple(result)


def _pipe_of_flange(components: Sequence[AnyComponent], flange: Flange) -> tuple[int, float, float] | None:
    """Return the row of the pipe behind a flange and from where to where it reaches, mm behind the weld end."""
    axis, weld_end = -np.array(flange.axis), np.array(flange.ports[1].point)
    best: tuple[float, int, float, float] | None = None
    for row, pipe in enumerate(components):
        if not isinstance(pipe, Pipe) or abs(pipe.outer_diameter - flange.outer_diameter) > SAME_DIAMETER * flange.outer_diameter:
            continue
        start, direction = line_of(pipe)
        beside = float(np.linalg.norm(nearest_on_line(weld_end, start, direction) - weld_end))
        if abs(direction @ axis) < FLANGE_COSINE or beside > FLANGE_OFF_AXIS * pipe.outer_diameter:
            continue
        low, high = sorted(float((np.array(end) - weld_end) @ axis) for end in (pipe.start, pipe.end))
        if high <= SHORTEST_PIPE * pipe.outer_diameter or low > FLANGE_REACH * flange.D:
            continue
        if best is None or abs(low) < best[0]:
            best = (abs(low), row, low, high)
    return None if best is None else best[1:]


def _is_known(piece: Pipe, components: Sequence[AnyComponent]) -> bool:
    """Tell whether another pipe of the same diameter runs where a piece does, over a part of it."""
    alike = SAME_DIAMETER * piece.outer_diameter
    others = [c for c in components if isinstance(c, Pipe) and c.id != piece.id and abs(c.outer_diameter - piece.outer_diameter) <= alike]
    for pipe in others:
        shared, aside = shared_course(piece, pipe)
        if aside.max() < KNOWN_OFF_AXIS * piece.outer_diameter and shared > KNOWN_OVERLAP * min(piece.length, pipe.length):
            return True
    return False


def with_elbows(assembly: Assembly, found: Sequence[FoundElbow]) -> Assembly:
    """Return the assembly with elbows; pipes run from corner to corner and end at the tangent points."""
    elbows = [_on_fixed_axes(assembly.components, elbow) for elbow in found]
    while True:
        axes = _axes(assembly.components, elbows)
        ends = [_tangent_points(elbow, axes) for elbow in elbows]
        shortened, worst = _shortened(assembly.components, elbows, ends, axes)
        if worst is None:
            break
        # two elbows that leave nothing of the pipe between them: one is wrong
        elbows.remove(worst)
    for elbow, (start, end, corner, angle) in zip(elbows, ends, strict=True):
        neighbours = [assembly.components[row] for row, _ in (elbow.first, elbow.second)]
        component = Elbow(
            id=assembly.new_id("E"),
            start=as_vector(start),
            end=as_vector(end),
            intersection=as_vector(corner),
            angle_deg=round(float(np.degrees(angle)), 4),
            bend_radius=elbow.bend_radius if elbow.bend is not None else round(elbow.bend_radius, 3),
            bend_type=elbow.bend.bend_type if elbow.bend is not None else None,  # type: ignore[arg-type]  # the catalogue asks for 2D, 3D, 5D
            outer_diameter=neighbours[0].outer_diameter,
            dn=next((n.dn for n in neighbours if n.dn), None),
            standard=elbow.bend.standard if elbow.bend is not None else None,
            verified=elbow.bend.verified if elbow.bend is not None else None,
            station=assembly.station,
            quality=round(elbow.quality, 4),
        )
        assembly = assembly.added(component, {}, [elbow.first, elbow.second, (len(assembly.components), 0), (len(assembly.components), 1)])
    components = tuple(shortened.get(row, old) for row, old in enumerate(assembly.components))
    return replace(assembly, components=components)


def _is_fixed(component: AnyComponent) -> bool:
    """Tell whether a component's axis stays where it is: fittings, and what the user fixed."""
    return component.fixed or not isinstance(component, Pipe)


def _on_axis(component: AnyComponent, port: int, point: Array) -> Array:
    """Return the point (3,) of the axis at a port that is nearest to another."""
    end = component.ports[port]
    return nearest_on_line(point, np.array(end.point), np.array(end.direction))


def _on_fixed_axes(components: Sequence[AnyComponent], elbow: FoundElbow) -> FoundElbow:
    """Return an elbow with its corner on the axis that must not move, in the middle where both must not."""
    fixed = [_on_axis(components[row], port, elbow.corner) for row, port in (elbow.first, elbow.second) if _is_fixed(components[row])]
    return replace(elbow, corner=np.mean(fixed, axis=0)) if fixed else elbow


def _axes(components: Sequence[AnyComponent], elbows: Sequence[FoundElbow]) -> dict[tuple[int, int], tuple[Array, Array]]:
    """Return, for each end with an elbow, the corner (3,) and the axis' unit direction (3,) out of the component.

    A pipe's axis runs through its corners; through its other end where there is no elbow.
    """
    corners = {end: elbow.corner for elbow in elbows for end in (elbow.first, elbow.second)}
    axes = {}
    for (row, port), corner in corners.items():
        component = components[row]
        direction = np.array(component.ports[port].direction)
        if not _is_fixed(component):
            other = corners.get((row, 1 - port))
            away = corner - (other if other is not None else np.array(component.ports[1 - port].point))
            # corners may have changed places where a short pipe was followed too far: its own direction stays then
            if away @ direction > 0:
                direction = away / np.linalg.norm(away)
        axes[row, port] = corner, direction
    return axes


def _tangent_points(elbow: FoundElbow, axes: Mapping[tuple[int, int], tuple[Array, Array]]) -> tuple[Array, Array, Array, float]:
    """Return the ends of an elbow, its corner and its angle in rad."""
    (corner, come), (_, back) = axes[elbow.first], axes[elbow.second]
    angle = angle_between(come, -back)
    length = elbow.bend_radius * np.tan(angle / 2)
    return corner - length * come, corner - length * back, corner, angle


def _shortened(
    components: Sequence[AnyComponent],
    elbows: Sequence[FoundElbow],
    ends: Sequence[tuple[Array, Array, Array, float]],
    axes: Mapping[tuple[int, int], tuple[Array, Array]],
) -> tuple[dict[int, Pipe], FoundElbow | None]:
    """Return the pipes with their ends at the tangent points, and the elbow that must go where nothing remains of one."""
    moved: dict[int, dict[int, Array]] = {}
    at: dict[int, list[FoundElbow]] = {}
    for elbow, (start, end, _, _) in zip(elbows, ends, strict=True):
        for (row, port), point in ((elbow.first, start), (elbow.second, end)):
            moved.setdefault(row, {})[port] = point
            at.setdefault(row, []).append(elbow)
    pipes: dict[int, Pipe] = {}
    for row, points in moved.items():
        pipe = components[row]
        if not isinstance(pipe, Pipe):
            continue
        direction = next(axes[row, port][1] * (1 if port else -1) for port in points)
        start, end = (points.get(port, np.array(pipe.ports[port].point)) for port in (0, 1))
        if pipe.fixed:
            start, end = (_on_axis(pipe, port, end) for port, end in enumerate((start, end)))
        if (end - start) @ direction < SHORTEST_PIPE * pipe.outer_diameter:
            return {}, min(at[row], key=lambda elbow: elbow.score)
        pipes[row] = pipe.with_ends(as_vector(start), as_vector(end))
    return pipes, None


def with_tees(assembly: Assembly, found: Sequence[FoundTee]) -> Assembly:
    """Return the assembly with tees; the run's pipe becomes two, one on each side of its tee."""
    for tee in found:
        assembly = _with_tee(assembly, tee)
    return assembly


def _with_tee(assembly: Assembly, tee: FoundTee) -> Assembly:
    branch = assembly.components[tee.branch[0]]
    # an earlier tee may have cut the run: the piece that is left around this corner
    row, run, low, high = _piece(assembly.components, tee)
    if run is None or not isinstance(branch, Pipe):
        return assembly
    axis = tee.axis
    half = tee.fitting.run_length if tee.fitting is not None else SEAM * branch.outer_diameter
    height = (tee.fitting.branch_length if tee.fitting is not None else None) or run.outer_diameter / 2 + SEAM * branch.outer_diameter / 2
    here = np.array(branch.ports[1 - tee.branch[1]].point)
    if (here - tee.corner) @ tee.direction <= height:
        return assembly
    component = Tee(
        id=assembly.new_id("T"),
        start=as_vector(tee.corner - half * axis),
        end=as_vector(tee.corner + half * axis),
        intersection=as_vector(tee.corner),
        branch_end=as_vector(tee.corner + height * tee.direction),
        branch_diameter=branch.outer_diameter,
        outer_diameter=run.outer_diameter,
        tee_type="tee" if tee.fitting is not None else "set-on",
        dn=run.dn,
        standard=tee.fitting.standard if tee.fitting is not None else None,
        verified=tee.fitting.verified if tee.fitting is not None else None,
        station=assembly.station,
    )
    number = len(assembly.components)
    port = tee.branch[1]
    changed: dict[int, AnyComponent] = {tee.branch[0]: _with_end(branch, port, tee.corner + height * tee.direction)}
    taken = [tee.branch, (number, 2)]
    pieces = [(low, -half, 1), (half, high, 0)]
    pieces = [(a, b, end) for a, b, end in pieces if b - a > SHORTEST_PIPE * run.outer_diameter]
    # the longer piece stays the pipe that was picked
    pieces.sort(key=lambda piece: piece[0] - piece[1])
    extra: Pipe | None = None
    for index, (a, b, end) in enumerate(pieces):
        start, stop = as_vector(tee.corner + a * axis), as_vector(tee.corner + b * axis)
        if index == 0:
            changed[row] = run.with_ends(start, stop)
            taken += [(row, end), (number, 1 - end)]
        else:
            extra = replace(run.with_ends(start, stop), pick=None)
            taken.append((number, 1 - end))
    assembly = assembly.added(component, changed, taken)
    if extra is None:
        return assembly
    row_taken = {(row, 0), (row, 1)} & assembly.taken
    own_end = pieces[0][2]
    # what was joined to the run's far end is now joined to the other piece
    far = {(number + 1, 1 - own_end)} if (row, 1 - own_end) in row_taken else set()
    extra = replace(extra, id=free_id(run.id, {one.id for one in assembly.components}))
    joined = assembly.added(extra, {}, [(number + 1, pieces[1][2]), *far])
    return replace(joined, taken=joined.taken - {(row, 1 - own_end)}) if far else joined


def _piece(components: Sequence[AnyComponent], tee: FoundTee) -> tuple[int, Pipe | None, float, float]:
    """Return row and pipe of the run that reaches over a tee's corner, and from where to where it does, mm from the corner."""
    run = components[tee.run]
    if not isinstance(run, Pipe):
        return tee.run, None, 0.0, 0.0
    for row, component in enumerate(components):
        if isinstance(component, Pipe) and (row == tee.run or component.id.startswith(f"{run.id}.")):
            low, high = sorted(float((np.array(end) - tee.corner) @ tee.axis) for end in (component.start, component.end))
            if low < 0 < high:
                return row, component, low, high
    # edges go on beyond the pipe's end
    return tee.run, run, *tee.extent


def with_reducers(assembly: Assembly, found: Sequence[FoundReducer]) -> Assembly:
    """Return the assembly with reducers; pipes end where they begin."""
    for reducer in found:
        wide, narrow = (assembly.components[row] for row, _ in (reducer.wide, reducer.narrow))
        if not isinstance(wide, Pipe) or not isinstance(narrow, Pipe):
            continue
        component = replace(
            reducer.component,
            id=assembly.new_id("R"),
            dn=wide.dn,
            standard=reducer.record.standard if reducer.record is not None else None,
            verified=reducer.record.verified if reducer.record is not None else None,
            station=assembly.station,
        )
        changed = {
            reducer.wide[0]: _with_end(wide, reducer.wide[1], np.array(component.start)),
            reducer.narrow[0]: _with_end(narrow, reducer.narrow[1], np.array(component.end)),
        }
        number = len(assembly.components)
        assembly = assembly.added(component, changed, [reducer.wide, reducer.narrow, (number, 0), (number, 1)])
    return assembly


def with_caps(assembly: Assembly, found: Sequence[FoundCap]) -> Assembly:
    """Return the assembly with caps; pipes end where they begin."""
    for cap in found:
        pipe = assembly.components[cap.end[0]]
        if not isinstance(pipe, Pipe):
            continue
        component = replace(
            cap.component, id=assembly.new_id("C"), dn=pipe.dn, standard=cap.record.standard, verified=cap.record.verified, station=assembly.station
        )
        changed = {cap.end[0]: _with_end(pipe, cap.end[1], np.array(component.start))}
        assembly = assembly.added(component, changed, [cap.end, (len(assembly.components), 0)])
    return assembly


def _with_end(pipe: Pipe, port: int, point: Array) -> Pipe:
    """Return a pipe with one end elsewhere."""
    ends = [pipe.start, pipe.end]
    ends[port] = as_vector(point)
    return pipe.with_ends(ends[0], ends[1])
