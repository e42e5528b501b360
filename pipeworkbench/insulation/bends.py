# SPDX-License-Identifier: LGPL-2.1-or-later
"""How elbows are insulated: the number of gores, collars, and what is done where insulation is too thick for a bend.

With the outer radius r (jacket included), the bend radius R and the angle j between neighbouring gores a gore between others is
2 (R - r) tan(j / 2) long at its throat and 2 (R + r) tan(j / 2) at its heel.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.connections import Connections, End, Room, total_thickness
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import Elbow
from pipeworkbench.solids.covering_limits import LARGEST_JOINT_DEG, LEAST_MM, least_gores
from pipeworkbench.solids.coverings import BendCovering
from pipeworkbench.solids.frames import bend_angle, frame_of
from pipeworkbench.solids.outlines import refuse_tight_bend

# common shop practice: a 90 degree bend is made of three whole gores and two halves, of five and two where it is wide
USUAL_JOINT_DEG, WIDE_JOINT_DEG, WIDE_MM = 22.5, 15.0, 150.0
MEASURED_DEG = 1.0  # by which a bend that is made as 45 or 90 degrees may have been measured wider
SMALL_ANGLE_DEG = 20.0  # below, two halves will do
LEAST_THROAT_MM = 30.0  # of a mitre joint's pieces: less can be neither rolled nor beaded
SAME = 1e-9


@dataclass(frozen=True)
class Bend:
    """An elbow with its treatment; ``angle`` in rad."""

    elbow: Elbow
    treatment: Treatment
    angle: float

    @property
    def outer_radius(self) -> float:
        """Radius (mm) of the jacket's outer face."""
        return self.elbow.outer_diameter / 2 + total_thickness(self.treatment)

    @property
    def is_tight(self) -> bool:
        """Tell whether smooth insulation, or gores between others, would run into themselves at the throat."""
        return self.outer_radius > self.elbow.bend_radius - LEAST_MM + SAME

    def mitre_collar(self, less: float = 0.0) -> float:
        """Return the collars' length (mm) with a single mitre joint of insulation ``less`` mm thinner: the throat's least length is left."""
        excess = self.outer_radius - less - self.elbow.bend_radius
        return max(excess * math.tan(self.angle / 2) + LEAST_THROAT_MM, 0.0)

    @property
    def largest_in_gores(self) -> float:
        """The largest thickness (mm) of the layers that is not tight."""
        return self.treatment.thickness - (self.outer_radius - (self.elbow.bend_radius - LEAST_MM))


def gores_by_rule(angle: float, outer_radius: float, bend_radius: float, sheet_width: float = math.inf) -> int:
    """Return the number of gores of a bend, the first and the last being halves.

    Common shop practice: neighbours' axes differ by at most 22.5 degrees up to an outer radius of 150 mm and by 15 beyond, where a
    degree more of the whole bend, as it was measured, does not count; there are at least three gores, two for less than 20 degrees. A
    gore's heel is not longer than the sheet is wide.

    Parameters
    ----------
    angle : float
        Of the bend, rad.
    outer_radius, bend_radius : float
        Of the jacket and of the bend's axis, mm.
    sheet_width : float
        What a gore may be long at its heel, mm, without overlap.
    """
    joint = math.radians(USUAL_JOINT_DEG if outer_radius <= WIDE_MM else WIDE_JOINT_DEG)
    usual = 1 + math.ceil((angle - math.radians(MEASURED_DEG)) / joint - SAME)
    return max(usual, 2 if angle < math.radians(SMALL_ANGLE_DEG) else 3, fewest_gores(angle, outer_radius, bend_radius, sheet_width))


def fewest_gores(angle: float, outer_radius: float, bend_radius: float, sheet_width: float) -> int:
    """Return the least number of gores whose heels (2 (R + r) tan(j / 2)) are not longer than the sheet is wide."""
    joint = 2 * math.atan(sheet_width / (2 * (bend_radius + outer_radius)))
    return max(1 + math.ceil(angle / joint - SAME), 2)


def bends_of(connections: Connections) -> tuple[list[Bend], list[InputError]]:
    """Return the insulated elbows and what makes no bend at all."""
    bends, problems = [], []
    for name, treatment in connections.treatments.items():
        elbow = connections.components[name]
        if isinstance(elbow, Elbow):
            try:
                refuse_tight_bend(elbow)
                frame_of(elbow)
            except InputError as error:
                problems.append(error)
                continue
            bends.append(Bend(elbow, treatment, bend_angle(elbow)))
    return bends, problems


def tight_bends(bends: Iterable[Bend], room: Room) -> list[InputError]:
    """Let the collars of mitre joints go over the neighbouring pipes; return problems of bends for which there is no room.

    Two tight bends may share a pipe: where it is too short for both, both are refused.
    """
    tight = {bend.elbow.id: bend for bend in bends if bend.is_tight}
    limits = {name: _largest_mitred(bend, tight, room) for name, bend in tight.items()}
    problems = []
    for name, bend in tight.items():
        if bend.treatment.bends.tight == "refuse" and bend.treatment.bends.gores != 2:
            problems.append(_too_thick(bend, bend.largest_in_gores, "the throat would run into itself"))
        elif limits[name] < bend.treatment.thickness - SAME:
            problems.append(
                _too_thick(bend, max(bend.largest_in_gores, limits[name]), "the throat would run into itself and a mitre joint has no room beside it")
            )
    refused = {problem.source for problem in problems}
    for name, bend in tight.items():
        if name not in refused:
            for port in (0, 1):
                room.take((name, port), bend.mitre_collar())
    return problems


def bend_covering(bend: Bend, connections: Connections, room: Room) -> tuple[BendCovering, list[str]]:
    """Return an elbow's covering, whose collars are taken from the pipes beside it, and remarks.

    Raises
    ------
    InputError
        Where the gores asked for are too few for the sheet.
    """
    elbow, treatment = bend.elbow, bend.treatment
    remarks: list[str] = []
    if bend.is_tight:
        gores, collars = 2, (bend.mitre_collar(), bend.mitre_collar())
        _refuse_long_mitre(bend, connections.sheet_width)
        text = f"{treatment.thickness:g} mm is too thick for gores in a bend of radius {elbow.bend_radius:g} mm: two pieces with one mitre joint"
        remarks.append(f"{elbow.id}: {text}, which go over their neighbours by {collars[0]:.0f} mm")
    elif treatment.bends.shape == "smooth":
        gores, collars = 0, (0.0, 0.0)
    else:
        gores = _gores(bend, connections.sheet_width)
        collars, remarks = _wished_collars(bend, gores, room)
    covering = BendCovering(
        id=elbow.id,
        component=elbow.id,
        frame=frame_of(elbow),
        layers=treatment.layers,
        sheet=treatment.jacket,
        radius=elbow.outer_diameter / 2,
        bend_radius=elbow.bend_radius,
        angle=bend.angle,
        gores=gores,
        collars=collars,
    )
    return covering, remarks


def _refuse_long_mitre(bend: Bend, sheet_width: float | None) -> None:
    """Raise InputError where a mitre joint's piece, from the heel's square end to the joint, is longer than the widest sheet."""
    treatment, radius, slope = bend.treatment, bend.outer_radius, math.tan(bend.angle / 2)
    if sheet_width is None or treatment.jacket is None:
        return
    overlap = max(treatment.seams.gore_overlap, treatment.seams.circumferential_overlap)
    length = bend.mitre_collar() + (bend.elbow.bend_radius + radius) * slope + overlap
    if length <= sheet_width + SAME:
        return
    # with a collar it is the throat's least length and twice the radius' share, without it the heel alone
    widest = min((sheet_width - overlap - LEAST_THROAT_MM) / (2 * slope), (sheet_width - overlap) / slope - bend.elbow.bend_radius)
    largest = math.floor(max(treatment.thickness - (radius - widest), bend.largest_in_gores) + SAME)
    problem = f"the pieces of its mitre joint are {length:.0f} mm long at the heel with their overlaps; the widest sheet is {sheet_width:g} mm"
    remedy = f"give a sheet of {math.ceil(length)} mm between its margins" + (f" or at most {largest} mm" if largest > 0 else "")
    raise InputError(bend.elbow.id, "thickness", problem, remedy)


def _gores(bend: Bend, sheet_width: float | None) -> int:
    """Return the number of gores by choice or by rule; the jacket's sheet is what limits them."""
    treatment, radius, bend_radius = bend.treatment, bend.outer_radius, bend.elbow.bend_radius
    width = math.inf if sheet_width is None or treatment.jacket is None else sheet_width - treatment.seams.gore_overlap
    if width <= 0:
        problem = f"the overlap of {treatment.seams.gore_overlap:g} mm is as wide as the widest sheet"
        raise InputError(bend.elbow.id, "seams.gore_overlap", problem, f"give less than {sheet_width:g} mm")
    chosen = treatment.bends.gores
    # the elbow must not come out of the first layer's polygon
    covered = least_gores(bend.elbow.outer_diameter / 2, bend_radius, bend.angle, treatment.layers[0].thickness)
    if chosen is None:
        return max(gores_by_rule(bend.angle, radius, bend_radius, width), covered)
    # two halves are together as long as one gore
    joint = bend.angle / (chosen - 1)
    heel = (1 if chosen == 2 else 2) * (bend_radius + radius) * math.tan(joint / 2)
    if heel > width:
        least = fewest_gores(bend.angle, radius, bend_radius, width)
        problem = f"{chosen} gores are {heel:.0f} mm long at the heel and need {treatment.seams.gore_overlap:g} mm of overlap; the widest sheet is"
        raise InputError(bend.elbow.id, "gores", f"{problem} {sheet_width:g} mm", f"give at least {max(least, covered)} gores")
    return chosen


def _wished_collars(bend: Bend, gores: int, room: Room) -> tuple[tuple[float, float], list[str]]:
    """Return the collars that the first gore's shape asks for, where a pipe has the room, and remarks where none has."""
    wish = bend.treatment.bends.first_gore
    half_length = bend.elbow.bend_radius * math.tan(bend.angle / (gores - 1) / 2)
    collar = {"half": 0.0, "equal": half_length}[wish] if isinstance(wish, str) else wish
    collars, remarks = [0.0, 0.0], []
    for port in (0, 1):
        end: End = (bend.elbow.id, port)
        if 0 < collar <= room.beside(end) + SAME:
            room.take(end, collar)
            collars[port] = collar
        elif collar > 0:
            remarks.append(f"{bend.elbow.id}: no pipe beside its end {port} has room for a first gore {collar:.0f} mm longer; it is a half one there")
    return (collars[0], collars[1]), remarks


def _largest_mitred(bend: Bend, tight: dict[str, Bend], room: Room) -> float:
    """Return the thickness (mm) for which the pipes at both ends have room; the bends at the other ends of them shrink too.

    Minus infinity where one joint cannot turn so far.
    """
    if bend.angle > math.radians(LARGEST_JOINT_DEG) + SAME:
        return -math.inf
    return min(_largest_beside(bend, port, tight, room) for port in (0, 1))


def _largest_beside(bend: Bend, port: int, tight: dict[str, Bend], room: Room) -> float:
    end = (bend.elbow.id, port)
    if end not in room.connections.partners:
        return -math.inf
    name, pipe_port = room.connections.partners[end]
    other = room.connections.partners.get((name, 1 - pipe_port), ("", 0))[0]
    sharing = [bend] + ([tight[other]] if other in tight and room.beside(end) > 0 else [])
    limit = room.beside(end)
    if sum(one.mitre_collar() for one in sharing) <= limit + SAME:
        return bend.treatment.thickness
    # all give way by the same thickness; a collar that has come to nothing shrinks no more
    for parts in ([sharing[0]], sharing) if len(sharing) == 2 else (sharing,):
        slope = sum(math.tan(one.angle / 2) for one in parts)
        less = (sum(one.mitre_collar() for one in parts) - limit) / slope
        if sum(one.mitre_collar(less) for one in sharing) <= limit + SAME:
            return bend.treatment.thickness - less
    return -math.inf


def _too_thick(bend: Bend, largest: float, why: str) -> InputError:
    whole = math.floor(largest + SAME)
    remedy = f"give at most {whole} mm" if whole > 0 else "leave it bare"
    problem = f"{bend.treatment.thickness:g} mm does not fit into a bend of radius {bend.elbow.bend_radius:g} mm: {why}"
    return InputError(bend.elbow.id, "thickness", problem, remedy)
