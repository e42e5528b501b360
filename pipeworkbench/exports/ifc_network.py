# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which way a pipeline flows through its ports, and where the ports of a joint are.

What flows where is not in photographs: from an open end on, everything flows away from it. Two joined ports are a SOURCE and a SINK, and
what has two ports or three has at least one of each.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Flange, Joint, Vector

SAME_PLACE_MM = 0.005  # ports nearer than this stay at the ends of their components
SOURCE, SINK = "SOURCE", "SINK"
FACE = 0  # a flange's port at its sealing face

End = tuple[str, int]


@dataclass(frozen=True)
class Network:
    """Flow direction and place (mm) by component id and port number; what each port is joined to."""

    flow: dict[End, str]
    places: dict[End, Vector]
    partners: dict[End, End]


def network_of(components: Sequence[AnyComponent], joints: Sequence[Joint], source: str = "pipeline") -> Network:
    """Return how a pipeline's ports belong together.

    Raises
    ------
    InputError
        Where a joint names what is not there, joins a component to itself or a port twice: IFC has one connection per port.
    """
    ports = {component.id: component.ports for component in components}
    partners: dict[End, End] = {}
    for index, joint in enumerate(joints):
        one, other = (joint.a, int(joint.a_port)), (joint.b, int(joint.b_port))
        for name, number in (one, other):
            if name not in ports or number >= len(ports[name]):
                raise InputError(source, f"joints[{index}]", f"there is no port {number} of '{name}'", "correct the joint or leave it out")
            if (name, number) in partners or one[0] == other[0]:
                raise InputError(
                    source, f"joints[{index}]", f"port {number} of '{name}' cannot be joined so", "join each port once, to another component"
                )
        partners[one], partners[other] = other, one
    places = {(name, number): port.point for name, found in ports.items() for number, port in enumerate(found)}
    for joint in joints:
        one, other = (joint.a, int(joint.a_port)), (joint.b, int(joint.b_port))
        if math.dist(places[one], places[other]) > SAME_PLACE_MM:
            # a gasket's thickness, or what the measurement left between both ends
            (a, b, c), (x, y, z) = places[one], places[other]
            places[one] = places[other] = ((a + x) / 2, (b + y) / 2, (c + z) / 2)
    return Network(_flow({name: len(found) for name, found in ports.items()}, partners), places, partners)


def connection_type(component: AnyComponent, port: int, *, joined: bool) -> str:
    """Return how a port is connected: a sealing face is FLANGED, another joint WELDED; of what is open it is not known (UNSET)."""
    if isinstance(component, Flange) and port == FACE:
        return "FLANGED"
    return "WELDED" if joined else "UNSET"


def _flow(counts: dict[str, int], partners: dict[End, End]) -> dict[End, str]:
    """Return the ports' flow directions.

    The search goes in depth: a component that is reached again was reached by what flows out of it, so that every one but the first has
    a port where it flows in, and everything but an end one where it flows out.
    """
    flow: dict[End, str] = {}
    seen: set[str] = set()
    for name, port in _entries(counts, partners):
        if name in seen:
            continue
        if port is not None:
            flow[name, port] = SINK
        seen.add(name)
        stack = [(name, iter(range(counts[name])))]
        while stack:
            here, rest = stack[-1]
            number = next(rest, None)
            if number is None:
                stack.pop()
                continue
            if (here, number) in flow:
                continue
            flow[here, number] = SOURCE
            partner = partners.get((here, number))
            if partner is not None:
                flow[partner] = SINK
                if partner[0] not in seen:
                    seen.add(partner[0])
                    stack.append((partner[0], iter(range(counts[partner[0]]))))
    return flow


def _entries(counts: dict[str, int], partners: dict[End, End]) -> Iterator[tuple[str, int | None]]:
    """Yield where to begin, and the port where it flows in: open ends of what goes on from there, then caps, then what is left: rings."""
    for name, count in counts.items():
        opened = [port for port in range(count) if (name, port) not in partners]
        if count > 1 and opened:
            yield name, opened[0]
    for name, count in counts.items():
        if count == 1:
            yield name, None if (name, 0) in partners else 0
    yield from ((name, None) for name in counts)
