# SPDX-License-Identifier: LGPL-2.1-or-later
"""How components hang together: joints from coincident ends, runs and branches, and what does not fit.

Two ports are joined where their points coincide and their directions are opposite, within tolerances; each
port once, the nearest first. What remains is open, and said where it looks like a fault.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Flange, Joint, Pipe, Pipeline, Tee
from pipeworkbench.recon.ends import Ends, each_end_once, ends_of, line_of, shared_course

FACE = 0  # a flange's port at its sealing face


@dataclass(frozen=True)
class TopologySettings:
    """Tolerances of joints.

    ``gap`` in diameters and ``gap_mm``, whichever is less but at least ``least_gap_mm``: the distance of joined ends; ``gasket_mm``
    that of two flanges' faces; ``angle_deg`` between their directions; ``diameter`` the relative difference of diameters that are the
    same. Open ends in line with each other less than ``suspicious_gap`` diameters apart are a gap.
    """

    gap: float = 0.15
    gap_mm: float = 10.0
    least_gap_mm: float = 4.0
    gasket_mm: float = 8.0
    angle_deg: float = 6.0
    diameter: float = 0.02
    suspicious_gap: float = 3.0
    overlap: float = 0.5


@dataclass(frozen=True)
class PipelineGraph:
    """What is joined to what.

    ``runs`` are the components, by id, one after the other between open ends and branches; ``branches`` the tees' ids; ``open_ends``
    the ports (id, port) that nothing is joined to; ``warnings`` what does not fit, in sentences.
    """

    joints: tuple[Joint, ...]
    runs: tuple[tuple[str, ...], ...]
    branches: tuple[str, ...]
    open_ends: tuple[tuple[str, int], ...]
    warnings: tuple[str, ...]


def join(components: Sequence[AnyComponent], settings: TopologySettings | None = None) -> tuple[Joint, ...]:
    """Return the joints of components that meet.

    Parameters
    ----------
    components : sequence of Component
        In one frame.
    settings : TopologySettings, optional
    """
    settings = settings or TopologySettings()
    ports = ends_of(components)
    first, second = ports.pairs()
    distance = np.linalg.norm(ports.point[first] - ports.point[second], axis=1)
    opposite = -np.einsum("pi,pi->p", ports.direction[first], ports.direction[second]) >= np.cos(np.radians(settings.angle_deg))
    smaller = np.minimum(ports.diameter[first], ports.diameter[second])
    tolerance = np.maximum(np.minimum(settings.gap * smaller, settings.gap_mm), settings.least_gap_mm)
    face = np.array([isinstance(components[row], Flange) and port == FACE for row, port in zip(ports.owner, ports.port, strict=True)], bool)
    near = distance <= np.where(face[first] & face[second], settings.gasket_mm, tolerance)
    # a sealing face meets a sealing face, never a pipe's end
    good = np.flatnonzero(near & opposite & (face[first] == face[second]))
    nearest_first = [(int(first[pair]), int(second[pair])) for pair in good[np.argsort(distance[good], kind="stable")]]
    return tuple(_joint(components, ports, a, b) for a, b in sorted(each_end_once(nearest_first, lambda pair: pair)))


def graph_of(components: Sequence[AnyComponent], joints: Sequence[Joint] | None = None, settings: TopologySettings | None = None) -> PipelineGraph:
    """Return runs, branches, open ends and warnings.

    Parameters
    ----------
    components : sequence of Component
    joints : sequence of Joint, optional
        Default: those that :func:`join` finds.
    settings : TopologySettings, optional
    """
    settings = settings or TopologySettings()
    joints = tuple(joints) if joints is not None else join(components, settings)
    taken = {(j.a, int(j.a_port)) for j in joints} | {(j.b, int(j.b_port)) for j in joints}
    open_ends = tuple((c.id, n) for c in components for n in range(len(c.ports)) if (c.id, n) not in taken)
    return PipelineGraph(
        joints,
        runs_of(components, joints),
        tuple(c.id for c in components if isinstance(c, Tee)),
        open_ends,
        _warnings(components, joints, open_ends, settings),
    )


def joined(pipeline: Pipeline, settings: TopologySettings | None = None) -> Pipeline:
    """Return a pipeline with the joints of its components."""
    return replace(pipeline, joints=join(pipeline.components, settings))


def _joint(components: Sequence[AnyComponent], ports: Ends, a: int, b: int) -> Joint:
    (row, port), (other_row, other_port) = ports.row_and_port(a), ports.row_and_port(b)
    return Joint(a=components[row].id, a_port=port, b=components[other_row].id, b_port=other_port)  # type: ignore[arg-type]  # 0, 1 or 2


def runs_of(components: Sequence[AnyComponent], joints: Sequence[Joint]) -> tuple[tuple[str, ...], ...]:
    """Return the components that follow each other, tees left out: they are where runs meet."""
    next_to: dict[str, list[str]] = {c.id: [] for c in components if not isinstance(c, Tee)}
    for joint in joints:
        if joint.a in next_to and joint.b in next_to:
            next_to[joint.a].append(joint.b)
            next_to[joint.b].append(joint.a)
    runs, seen = [], set()
    # ends first, then what is left are rings
    for name in sorted(next_to, key=lambda n: len(next_to[n]) >= 2):
        run: list[str] = []
        current: str | None = name
        while current is not None and current not in seen:
            seen.add(current)
            run.append(current)
            current = next((other for other in next_to[current] if other not in seen), None)
        if run:
            runs.append(tuple(run))
    return tuple(runs)


def _warnings(
    components: Sequence[AnyComponent], joints: Sequence[Joint], open_ends: Sequence[tuple[str, int]], settings: TopologySettings
) -> tuple[str, ...]:
    by_id = {c.id: c for c in components}
    return (
        *_diameter_changes(by_id, joints, settings),
        *_lonely_flanges(by_id, open_ends),
        *_gaps(by_id, open_ends, settings),
        *_overlaps([c for c in components if isinstance(c, Pipe)], settings),
    )


def _diameter_changes(by_id: dict[str, AnyComponent], joints: Sequence[Joint], settings: TopologySettings) -> list[str]:
    """Return a sentence for each joint of different diameters; flanges' faces may differ."""
    found = []
    for joint in joints:
        one, other = by_id[joint.a].ports[joint.a_port], by_id[joint.b].ports[joint.b_port]
        faces = isinstance(by_id[joint.a], Flange) and joint.a_port == FACE
        if not faces and abs(one.diameter - other.diameter) > settings.diameter * max(one.diameter, other.diameter):
            found.append(
                f"{joint.a} and {joint.b}: the diameter changes from {one.diameter:g} to {other.diameter:g} mm without a reducer; "
                "check both diameters"
            )
    return found


def _lonely_flanges(by_id: dict[str, AnyComponent], open_ends: Sequence[tuple[str, int]]) -> list[str]:
    return [
        f"{name}: the flange has no partner at its sealing face; pick the other flange or leave it as the end"
        for name, port in open_ends
        if isinstance(by_id[name], Flange) and port == FACE
    ]


def _gaps(by_id: dict[str, AnyComponent], open_ends: Sequence[tuple[str, int]], settings: TopologySettings) -> list[str]:
    """Return a sentence for every two open ends that face each other at a short distance."""
    found = []
    for (a, a_port), (b, b_port) in itertools.combinations(open_ends, 2):
        if a == b:
            continue
        one, other = by_id[a].ports[a_port], by_id[b].ports[b_port]
        apart = np.subtract(other.point, one.point)
        distance = float(np.linalg.norm(apart))
        along = float(apart @ np.array(one.direction))
        facing = -float(np.dot(one.direction, other.direction)) >= np.cos(np.radians(settings.angle_deg))
        smaller = min(one.diameter, other.diameter)
        aside = np.sqrt(max(distance**2 - along**2, 0.0))
        if facing and 0 < along <= settings.suspicious_gap * smaller and aside <= max(0.5 * smaller, settings.least_gap_mm):
            change = f" and the diameter changes from {one.diameter:g} to {other.diameter:g} mm" if abs(one.diameter - other.diameter) > 1 else ""
            found.append(f"{a} and {b}: there is a gap of {distance:.0f} mm between their ends{change}; add what lies between them")
    return found


def _overlaps(pipes: Sequence[Pipe], settings: TopologySettings) -> list[str]:
    """Return a sentence for every two pipes of which one lies in the other."""
    found = []
    for one, other in itertools.combinations(pipes, 2):
        shared, aside = shared_course(one, other)
        radius = max(one.outer_diameter, other.outer_diameter) / 2
        parallel = abs(line_of(one)[1] @ line_of(other)[1]) >= np.cos(np.radians(settings.angle_deg))
        if parallel and aside.mean() < radius and shared > settings.overlap * 2 * radius:
            found.append(f"{one.id} and {other.id}: they lie in each other over {shared:.0f} mm; delete one of them")
    return found
