# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes over flanges: which flanges are under one box, how far pipes' insulation keeps away from their bolts, where boxes end.

Flanges that are joined, that face each other across a gasket or across a valve, or that are joined back to back by a pipe too short
for insulation of its own make a chain under one box.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.connections import Connections, End, Room, total_thickness
from pipeworkbench.insulation.treatment import Flanges, Treatment
from pipeworkbench.pipeline import BLIND_FLANGE, AnyComponent, Flange, Pipe
from pipeworkbench.recon.vectors import as_vector
from pipeworkbench.solids.covering_limits import LEAST_MM, largest_thickness
from pipeworkbench.solids.coverings import BoxCovering, Notch
from pipeworkbench.solids.frames import Frame, frame_of, local_point
from pipeworkbench.solids.outlines import bolt_diameter, bolt_length, bolt_protrusion, neck_outline

FACE, WELD = 0, 1  # a flange's ports
GASKET_MM = 8.0  # faces nearer than this are one joint (as recon.topology's gasket_mm)
FACING_DEG = 6.0  # between the axes of faces that look at each other
ASIDE = 0.1  # of the flange's diameter by which their centres may be beside each other's axes
SAME_SIZE = 0.02  # relative difference of pipes of the same diameter
SAME = 1e-6  # mm
METAL_AIR_MM = 5.0  # around a plate that is cut out of a box's end

Straights = dict[str, tuple[float, float]]  # the parts (mm from the start) of pipes with insulation of their own


@dataclass(frozen=True)
class Chain:
    """Flanges under one box in the order of their ids, the pipes that it goes over as well, its outer ends, and the flanges of valves."""

    flanges: tuple[Flange, ...]
    over: tuple[str, ...]
    treatment: Treatment
    ends: tuple[End, ...]
    valves: tuple[tuple[str, str], ...] = ()

    @property
    def first(self) -> Flange:
        """The flange in whose axes the box is."""
        return self.flanges[0]


@dataclass(frozen=True)
class _Side:
    """Where a box ends behind a flange's face (``far`` mm), with what hole; behind ``plain`` (mm) there is no bolt or plate any more."""

    far: float
    opening: float
    plain: float = -math.inf


def bolt_cuts(connections: Connections) -> dict[End, float]:
    """Return how much of pipes (mm) stays free behind flanges, by the pipe's end: bolts are pulled out there.

    The bolt's length and the gap count from the back of the flange's plate. The pipe's own treatment says how wide the gap is; over bare
    pipes neighbours' collars keep the usual one.
    """
    cuts = {}
    for name, pipe in connections.components.items():
        treatment = connections.treatments.get(name)
        gap = (treatment.flanges if treatment else Flanges()).gap
        for port in (0, 1) if isinstance(pipe, Pipe) else ():
            flange = connections.partner((name, port))
            if isinstance(flange, Flange) and connections.partners[name, port][1] == WELD:
                along = float(np.subtract(pipe.ports[port].point, flange.face) @ -np.array(flange.axis))
                free = flange.C + bolt_length(_bolted(flange), _grip(flange, connections)) + gap - along
                cuts[name, port] = max(free, 0.0)
    return cuts


def boxed(connections: Connections) -> set[str]:
    """Return the flanges that have a box by their own treatment."""
    return {name for name, t in connections.treatments.items() if t.flanges.cover == "box" and isinstance(connections.components[name], Flange)}


def with_partners(connections: Connections, left_bare: Collection[str]) -> tuple[Connections, dict[End, End], list[str]]:
    """Return the connections in which two flanges face to face are both under a box or both not; what faces what; and remarks.

    A box over one flange goes over its partner, too, whatever that one's treatment. Where one is to be left bare, so is the other.
    """
    faces = facing(connections)
    pairs = {name: other for (name, port), (other, _) in (connections.partners | faces).items() if port == FACE}
    under = {name for name in boxed(connections) if pairs.get(name) not in left_bare}
    treatments = {name: t for name, t in connections.treatments.items() if name in under or not isinstance(connections.components[name], Flange)}
    remarks = []
    for name in sorted(under):
        other = pairs.get(name, name)
        if other not in under and isinstance(connections.components[other], Flange):
            treatments[other] = treatments[name]
            remarks.append(f"{other}: lies under the box over {name}")
    return dataclasses.replace(connections, treatments=treatments), faces, remarks


def facing(connections: Connections) -> dict[End, End]:
    """Return which open faces look at each other across a gasket or a valve, both ways.

    Their pipes have the same diameter, nothing lies between them, and each face has one partner, the nearest first.
    """
    every = [c for c in connections.components.values() if isinstance(c, Flange) and (c.id, FACE) not in connections.partners]
    if len(every) < 2:
        return {}
    face, axis = np.array([f.face for f in every]), np.array([f.axis for f in every])
    diameter, plate = np.array([f.outer_diameter for f in every]), np.array([f.D for f in every])
    reach = np.array([_reach(f, connections) for f in every])
    apart = face[None] - face[:, None]
    along = np.einsum("abi,ai->ab", apart, axis)
    aside = np.linalg.norm(apart - along[..., None] * axis[:, None], axis=2)
    good = (axis @ axis.T <= -math.cos(math.radians(FACING_DEG))) & (aside <= ASIDE * plate[:, None]) & (along >= -GASKET_MM)
    good &= (along <= reach[:, None]) & (np.abs(diameter[None] - diameter[:, None]) <= SAME_SIZE * diameter[:, None])
    good &= good.T
    rows, columns = np.nonzero(np.triu(good, 1))
    partners: dict[End, End] = {}
    for pair in np.argsort(along[rows, columns], kind="stable"):
        one, other = every[rows[pair]], every[columns[pair]]
        ends = (one.id, FACE), (other.id, FACE)
        if not partners.keys() & set(ends) and not _something_between(one, other, connections.components.values()):
            partners[ends[0]], partners[ends[1]] = ends[1], ends[0]
    return partners


def straights_of(connections: Connections, room: Room) -> tuple[Straights, list[str]]:
    """Return the parts of pipes that get straight insulation (mm from their starts), and remarks on those that are too short for any.

    A box's end needs as much of it to sit on as it is thick.
    """
    under = boxed(connections)
    straights: Straights = {}
    remarks = []
    for name in connections.treatments:
        pipe = connections.components[name]
        if not isinstance(pipe, Pipe):
            continue
        neighbours = [connections.partners.get((name, port), ("", 0))[0] for port in (0, 1)]
        seats = [total_thickness(connections.treatments[other]) for other in neighbours if other in under]
        begin, end = room.taken.get((name, 0), 0.0), pipe.length - room.taken.get((name, 1), 0.0)
        if end - begin >= max(sum(seats), LEAST_MM):
            straights[name] = (begin, end)
        else:
            under_box = "; it lies under the box" if seats else "; it stays bare"
            remarks.append(f"{name}: {pipe.length:.0f} mm are too short for insulation between bolts and neighbours' insulation{under_box}")
    return straights, remarks


def chains_of(connections: Connections, faces: dict[End, End], straights: Straights) -> list[Chain]:
    """Return the flanges under boxes, chain by chain, in the order of their first ids.

    ``faces`` are the open faces that look at each other.
    """
    links, over = _links(connections, faces, straights)
    chains, seen = [], set[str]()
    for name in sorted(boxed(connections)):
        if name not in seen:
            members = _hanging_together(name, links)
            seen |= members
            ends = [(member, port) for member in sorted(members) for port in (FACE, WELD) if (member, port) not in links]
            under = {pipe for pair, pipe in over.items() if pair <= members}
            under |= {connections.partners[end][0] for end in ends if _is_under(connections.partner(end), connections, straights)}
            flanges = tuple(one for member in sorted(members) if isinstance(one := connections.components[member], Flange))
            valves = tuple(_valves(members, faces, connections))
            chains.append(Chain(flanges, tuple(sorted(under)), connections.treatments[min(members)], tuple(ends), valves))
    return chains


def box_covering(chain: Chain, name: str, connections: Connections, straights: Straights, room: Room) -> tuple[BoxCovering, list[str]]:
    """Return a chain's box with the id ``name``, and remarks; arguments and errors as of ``_box``.

    Raises
    ------
    InputError
        Also where the box is so thick that no hollow is left; names the largest thickness that works, for its ends move with it.
    """
    covering = _box(chain, name, connections, straights, room)
    if covering.total_thickness > largest_thickness(covering) + SAME:

        def fits(thickness: float) -> bool:
            layers = (dataclasses.replace(chain.treatment.layers[0], thickness=thickness),)
            thinner = dataclasses.replace(chain, treatment=dataclasses.replace(chain.treatment, layers=layers))
            made = _box(thinner, name, connections, straights, room)
            return made.total_thickness <= largest_thickness(made)

        # in tenths of a millimetre: what is told must work
        low, high = 0, math.ceil(chain.treatment.thickness * 10)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if fits(middle / 10) else (low, middle)
        remedy = f"give at most {low / 10:g} mm" if low else "leave it bare"
        problem = f"{chain.treatment.thickness:g} mm is more than half the length of the box allows"
        raise InputError(chain.first.id, "thickness", problem, remedy)
    ends = sorted(chain.ends, key=lambda end: _place(end, chain, covering.frame))
    return covering, [*(text for end in ends for text in _remarks(end, connections)), *(_valve_remark(pair) for pair in chain.valves)]


def _box(chain: Chain, name: str, connections: Connections, straights: Straights, room: Room) -> BoxCovering:
    """Return a chain's box with the id ``name``.

    Each end lies over the neighbouring pipe's insulation by the overlap and its own thickness, at most as far as that goes, or half of it
    where another box sits at its other end. Before a fitting without a pipe between it ends where the fitting begins.

    Raises
    ------
    InputError
        Where the flanges have no two outer ends.
    """
    frame = frame_of(chain.first)
    places = {end: _place(end, chain, frame) for end in chain.ends}
    if len(places) != 2:
        raise InputError(chain.first.id, "joints", "flanges are joined in a ring", "correct the joints")
    ends = sorted(chain.ends, key=lambda end: places[end])
    sides = [_side(end, chain.treatment, connections, straights, room) for end in ends]
    total, plate = total_thickness(chain.treatment), max(flange.D for flange in chain.flanges) / 2
    radius = max(plate + chain.treatment.flanges.clearance, *(side.opening + LEAST_MM for side in sides))
    outer, notches = [], []
    for sign, end, side in zip((-1, 1), ends, sides, strict=True):
        flange = next(one for one in chain.flanges if one.id == end[0])
        face = float(local_point(frame, flange.face)[2])
        outer.append(face + sign * side.far)
        if side.far - total < side.plain < side.far:
            # the hollow ends before the bolts do: they are cut out of the end
            before, behind = (np.array([0.0, 0.0, face + sign * along]) for along in (min(side.far - total, 0.0), side.plain))
            notches.append(Notch(flange.id, before, behind, min(plate + METAL_AIR_MM, radius)))
    return BoxCovering(
        id=name,
        component=chain.first.id,
        frame=frame,
        layers=chain.treatment.layers,
        sheet=chain.treatment.jacket,
        radius=radius,
        begin=outer[0],
        end=outer[1],
        openings=(sides[0].opening, sides[1].opening),
        components=(*(flange.id for flange in chain.flanges), *chain.over),
        notches=tuple(notches),
    )


def _place(end: End, chain: Chain, frame: Frame) -> float:
    """Return where an outer end of a chain is along z (mm): a flange's face or its plate's back."""
    flange = next(one for one in chain.flanges if one.id == end[0])
    back = np.array(flange.face) - (flange.C if end[1] == WELD else 0.0) * np.array(flange.axis)
    return float(local_point(frame, as_vector(back))[2])


def _bolted(flange: Flange) -> Flange:
    """Return a flange whose bolts have a diameter: holes that take none count as not known."""
    try:
        bolt_diameter(flange)
    except InputError:
        return dataclasses.replace(flange, L=None)
    return flange


def _grip(flange: Flange, connections: Connections) -> float | None:
    """Return the distance (mm) of two joined flanges' backs; None where there is no partner."""
    partner = connections.partner((flange.id, FACE))
    if not isinstance(partner, Flange):
        return None
    return flange.C + partner.C + abs(float(np.subtract(partner.face, flange.face) @ np.array(flange.axis)))


def _reach(flange: Flange, connections: Connections) -> float:
    """Return how far (mm) before a flange's face another one belongs to the same joint or valve."""
    treatment = connections.treatments.get(flange.id)
    return GASKET_MM if treatment is None or treatment.flanges.cover != "box" else max(treatment.flanges.longest_valve, GASKET_MM)


def _something_between(one: Flange, other: Flange, components: Iterable[AnyComponent]) -> bool:
    """Tell whether a port of another component lies between two faces."""
    start, way = np.array(one.face), np.subtract(other.face, one.face)
    length = float(np.linalg.norm(way))
    if length <= GASKET_MM:
        return False
    points = np.array([port.point for c in components if c.id not in (one.id, other.id) for port in c.ports])
    if not len(points):
        return False
    along = (points - start) @ way / length
    aside = np.linalg.norm(points - start - along[:, None] * way / length, axis=1)
    return bool(np.any((along > 0) & (along < length) & (aside < one.D / 2)))


def _links(connections: Connections, faces: dict[End, End], straights: Straights) -> tuple[dict[End, End], dict[frozenset[str], str]]:
    """Return which ends of flanges are under one box, and the pipes between them."""
    under = boxed(connections)
    links = {end: partner for end, partner in faces.items() if {end[0], partner[0]} <= under}
    over: dict[frozenset[str], str] = {}
    for end, partner in connections.partners.items():
        if end[0] not in under:
            continue
        other = connections.components[partner[0]]
        if isinstance(other, Pipe) and other.id in connections.treatments and other.id not in straights:
            beyond = connections.partners.get((other.id, 1 - partner[1]), ("", 0))
            if beyond[0] in under and beyond[0] != end[0] and beyond[1] == WELD:
                links[end] = beyond
                over[frozenset((end[0], beyond[0]))] = other.id
        elif other.id in under:
            links[end] = partner
    return links, over


def _hanging_together(name: str, links: dict[End, End]) -> set[str]:
    found, stack = {name}, [name]
    while stack:
        here = stack.pop()
        near = {links[here, port][0] for port in (FACE, WELD) if (here, port) in links} - found
        found |= near
        stack += near
    return found


def _is_under(partner: AnyComponent | None, connections: Connections, straights: Straights) -> bool:
    """Tell whether what follows a flange is a pipe too short for insulation of its own, so that it lies under the box's end."""
    return isinstance(partner, Pipe) and partner.id in connections.treatments and partner.id not in straights


def _side(end: End, treatment: Treatment, connections: Connections, straights: Straights, room: Room) -> _Side:
    flange = connections.components[end[0]]
    if not isinstance(flange, Flange) or end[1] == FACE:
        return _Side(treatment.flanges.clearance + total_thickness(treatment), 0.0)
    total, plain = total_thickness(treatment), flange.C + bolt_protrusion(_bolted(flange))
    beyond = max(plain, flange.length) + total
    partner = connections.partner(end)
    if flange.flange_type == BLIND_FLANGE:
        return _Side(beyond + treatment.flanges.clearance, 0.0)
    if partner is None:
        return _Side(beyond, flange.outer_diameter / 2)
    if isinstance(partner, Pipe) and partner.id in straights:
        return _on_insulation(flange, partner, treatment, connections, straights[partner.id])
    far = flange.length
    if isinstance(partner, Pipe):
        other_end = (partner.id, 1 - connections.partners[end][1])
        far += max(partner.length - room.taken.get(other_end, 0.0), 0.0)
        if other_end not in connections.partners:
            far = max(far, beyond)
        if partner.id not in connections.treatments:
            far = min(far, beyond)
    sheet = treatment.jacket.thickness if treatment.jacket else 0.0
    if plain > far - sheet - LEAST_MM:
        # the bolts stand out of the box
        return _Side(far, flange.D / 2 + METAL_AIR_MM)
    opening = _neck_radius(flange, max(plain, far - total))
    if isinstance(partner, Pipe):
        opening = max(opening, partner.outer_diameter / 2 + _misfit(flange, partner, (far - total, far)))
    return _Side(far, opening, plain)


def _on_insulation(flange: Flange, pipe: Pipe, treatment: Treatment, connections: Connections, straight: tuple[float, float]) -> _Side:
    """Return the side of a box that sits on a pipe's insulation, which begins where the bolts need no more room."""
    port = connections.partners[flange.id, WELD][1]
    begin, end = straight
    free = begin if port == 0 else pipe.length - end
    beyond = connections.partners.get((pipe.id, 1 - port), ("", 0))[0]
    shared = beyond in connections.treatments and isinstance(connections.components[beyond], Flange)
    seat = (end - begin) / (2 if shared else 1)
    along = float(np.subtract(pipe.ports[port].point, flange.face) @ -np.array(flange.axis))
    overlap = min(treatment.flanges.overlap + total_thickness(treatment), seat)
    far = along + free + overlap
    outer = connections.outer_radius((pipe.id, port)) or pipe.outer_diameter / 2
    return _Side(far, outer + _misfit(flange, pipe, (far - total_thickness(treatment), far)))


def _misfit(flange: Flange, pipe: Pipe, places: tuple[float, ...]) -> float:
    """Return how far (mm) the axis of a measured pipe is from that of its flange, at most, at places behind the flange's face (mm)."""
    axis, along = np.array(flange.axis), pipe.ports[1].direction
    across = np.subtract(pipe.start, flange.face)
    # where the pipe's axis meets the planes across the flange's axis
    steps = [-(place + float(across @ axis)) / float(along @ axis) for place in places]
    return max(float(np.linalg.norm(across + step * np.array(along) + place * axis)) for step, place in zip(steps, places, strict=True))


def _neck_radius(flange: Flange, place: float) -> float:
    """Return the neck's radius (mm) so far behind the face."""
    outline = [(along, radius) for radius, along in neck_outline(flange)[1:-1]]
    if not outline:
        return flange.outer_diameter / 2
    places, radii = zip(*outline, strict=True)
    return float(np.interp(place, places, radii))


def _valves(members: set[str], faces: dict[End, End], connections: Connections) -> Iterator[tuple[str, str]]:
    """Yield the pairs of flanges with a valve between them: their faces are further apart than a gasket is thick."""
    for (name, _), (other, _) in faces.items():
        one, facing_it = connections.components[name], connections.components[other]
        if name < other and {name, other} <= members and math.dist(one.ports[FACE].point, facing_it.ports[FACE].point) > GASKET_MM:
            yield name, other


def _valve_remark(pair: tuple[str, str]) -> str:
    return (
        f"{pair[0]}: the bonnet and the handwheel of the valve between it and {pair[1]} are not known; their opening in the box is to be cut on site"
    )


def _remarks(end: End, connections: Connections) -> list[str]:
    name, port = end
    flange, partner = connections.components[name], connections.partner(end)
    if port == FACE:
        return [f"{name}: nothing is joined to its face; the box is closed there"]
    if partner is None or isinstance(partner, Pipe) or (isinstance(flange, Flange) and flange.flange_type == BLIND_FLANGE):
        return []
    return [f"{name}: {partner.id} follows without a pipe between; bolts can only be pulled out when the box is off, and its end is thinner there"]
