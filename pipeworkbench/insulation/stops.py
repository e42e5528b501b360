# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a disc of sheet metal closes insulation: at open ends, before flanges and bare components, and where it becomes thinner."""

from __future__ import annotations

from collections.abc import Container, Iterable, MutableSet

import numpy as np

from pipeworkbench.insulation.connections import BRANCH, Connections, End, Room, end_radius
from pipeworkbench.pipeline import Flange, Pipe, Port, free_id
from pipeworkbench.recon.vectors import across
from pipeworkbench.solids.coverings import AnyCovering, BoxCovering, StopCovering, TeeCovering
from pipeworkbench.solids.frames import SAME_DIRECTION, UP, Frame

STEP_MM = 2.0  # between neighbours' outer radii from which on the thicker one is closed: less is a sheet's thickness, and no ring can be so narrow


def stops_of(coverings: Iterable[AnyCovering], connections: Connections, room: Room, used: MutableSet[str]) -> list[StopCovering]:
    """Return the discs that close coverings with a jacket, named after the component and its end; ids in ``used`` are avoided."""
    ends, boxes = _covered_ends(coverings, connections)
    stops = []
    for end in ends:
        name, port = end
        treatment = connections.treatments[name]
        inner = _inner_radius(end, ends, boxes, connections)
        outer = connections.outer_radius(end)
        if treatment.jacket is None or inner is None or outer is None or outer - inner <= STEP_MM:
            continue
        stop = StopCovering(
            id=free_id(f"{name} stop {port}", used),
            component=name,
            frame=_outwards(connections.components[name].ports[port], _beyond(end, connections, room)),
            layers=(),
            sheet=treatment.jacket,
            radius=inner,
            outer_radius=outer,
        )
        used.add(stop.id)
        stops.append(stop)
    return stops


def _covered_ends(coverings: Iterable[AnyCovering], connections: Connections) -> tuple[dict[End, None], set[str]]:
    """Return the ends at which coverings end, in their order, and the components under boxes."""
    ends: dict[End, None] = {}
    boxes: set[str] = set()
    for covering in coverings:
        if isinstance(covering, BoxCovering):
            boxes |= set(covering.components)
            continue
        hole = isinstance(covering, TeeCovering) and not covering.reach
        ports = range(len(connections.components[covering.component].ports))
        ends |= {(covering.component, port): None for port in ports if not (hole and port == BRANCH)}
    return ends, boxes


def _inner_radius(end: End, ends: Container[End], boxes: Container[str], connections: Connections) -> float | None:
    """Return the radius (mm) of the hole in the disc at an end; None where what follows closes the insulation there."""
    name, port = end
    component, partner = connections.components[name], connections.partner(end)
    metal = end_radius(component, port)
    if partner is None:
        return metal
    other = connections.partners[end]
    if isinstance(partner, Flange):
        # before a box a pipe keeps away from the bolts; anything else goes up to it
        return metal if isinstance(component, Pipe) or partner.id not in boxes else None
    if other in ends:
        thinner, own = connections.outer_radius(other), connections.outer_radius(end)
        return thinner if thinner is not None and own is not None and own - thinner > STEP_MM else None
    if isinstance(partner, Pipe) and partner.id in connections.treatments:
        beyond = connections.partners.get((partner.id, 1 - other[1]), ("", 0))[0]
        return None if beyond in boxes or partner.id in boxes else metal
    return metal


def _beyond(end: End, connections: Connections, room: Room) -> float:
    """Return how far (mm) a covering goes on beyond its component's end; negative where it ends before."""
    if isinstance(connections.components[end[0]], Pipe):
        return -room.taken.get(end, 0.0)
    partner = connections.partners.get(end)
    return room.taken.get(partner, 0.0) if partner else 0.0


def _outwards(port: Port, beyond: float) -> Frame:
    """Return axes with z out of a port (mm) and x upwards, as far as it is across z."""
    z = np.array(port.direction)
    x = across(np.array(UP), z)
    if np.linalg.norm(x) <= SAME_DIRECTION:
        x = np.array((1.0, 0.0, 0.0)) - z[0] * z
    x = x / np.linalg.norm(x)
    return Frame(np.array(port.point) + beyond * z, x, np.cross(z, x), z)
