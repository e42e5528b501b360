# SPDX-License-Identifier: LGPL-2.1-or-later
"""How tees are insulated: how far their coverings go over the pipes of the run and of the branch.

With the outer radii r of the run and b of the branch and the angle a between them, the branch's surface meets the run's
between (r cos a -+ b) / sin a along the run and comes out of it at (r + b |cos a|) / sin a along the branch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.connections import BRANCH, Connections, End, Room, total_thickness
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import Pipe, Tee
from pipeworkbench.solids.covering_limits import LEAST_MM
from pipeworkbench.solids.coverings import TeeCovering
from pipeworkbench.solids.frames import Frame, frame_of, local_point

LEAST_STUB_MM = 30.0  # of a branch's insulation outside the run's: less can be neither rolled nor beaded
LEAST_RIM_MM = 10.0  # of a run's insulation beside the branch's
SAME = 1e-9


@dataclass(frozen=True, eq=False)
class Fitting:
    """A tee with its treatment: the run's ends along z, the branch's length and direction (mm, rad)."""

    tee: Tee
    treatment: Treatment
    frame: Frame
    begin: float
    end: float
    branch_length: float
    branch_angle: float

    @property
    def radius(self) -> float:
        """Outer radius (mm) of the run's jacket."""
        return self.tee.outer_diameter / 2 + total_thickness(self.treatment)

    @property
    def branch_radius(self) -> float:
        """Outer radius (mm) of the branch's jacket."""
        return self.tee.branch_diameter / 2 + total_thickness(self.treatment)

    @property
    def emergence(self) -> float:
        """Length (mm) along the branch behind which its insulation is out of the run's all around."""
        return (self.radius + self.branch_radius * abs(math.cos(self.branch_angle))) / math.sin(self.branch_angle)

    @property
    def footprint(self) -> tuple[float, float]:
        """Where the branch's insulation begins and ends along the run (mm), inside of it too."""
        sine, aside = math.sin(self.branch_angle), self.radius / math.tan(self.branch_angle)
        return min(aside, 0.0) - self.branch_radius / sine, max(aside, 0.0) + self.branch_radius / sine


def tees_of(connections: Connections) -> tuple[list[Fitting], list[InputError]]:
    """Return the insulated tees and what makes no tee."""
    fittings, problems = [], []
    for name, treatment in connections.treatments.items():
        tee = connections.components[name]
        if isinstance(tee, Tee):
            try:
                fittings.append(_fitting(tee, treatment))
            except InputError as error:
                problems.append(error)
    return fittings, problems


def tee_covering(fitting: Fitting, room: Room) -> tuple[TeeCovering, list[str]]:
    """Return a tee's covering, which goes over the pipes beside it as far as it must, and remarks.

    Where they have no room for the branch to come out of the run's insulation, the branch is a hole in it.
    """
    tee, first, last = fitting.tee, fitting.footprint[0] - LEAST_RIM_MM, fitting.footprint[1] + LEAST_RIM_MM
    begin, end = min(fitting.begin, first), max(fitting.end, last)
    needs = {(tee.id, 0): fitting.begin - begin, (tee.id, 1): end - fitting.end}
    remarks = []
    reach = _reach(fitting, room)
    if reach and all(need <= room.beside(one) + SAME for one, need in needs.items()):
        for one, need in (needs | {(tee.id, BRANCH): reach - fitting.branch_length}).items():
            room.take(one, need)
    else:
        begin, end, reach = fitting.begin, fitting.end, 0.0
        _keep_out(fitting, room)
        remarks.append(f"{tee.id}: the pipes beside it are too short for insulation around the branch; it is a hole in the run's")
    covering = TeeCovering(
        id=tee.id,
        component=tee.id,
        frame=fitting.frame,
        layers=fitting.treatment.layers,
        sheet=fitting.treatment.jacket,
        radius=tee.outer_diameter / 2,
        begin=begin,
        end=end,
        branch_radius=tee.branch_diameter / 2,
        branch_angle=fitting.branch_angle,
        reach=reach,
    )
    return covering, remarks


def _fitting(tee: Tee, treatment: Treatment) -> Fitting:
    frame = frame_of(tee)
    begin, end = (float(local_point(frame, point)[2]) for point in (tee.start, tee.end))
    if not begin < 0 < end:
        raise InputError(tee.id, "intersection", "does not lie between the ends of the run", "correct the tee's points")
    if tee.branch_diameter > tee.outer_diameter:
        raise InputError(tee.id, "branch_diameter", f"{tee.branch_diameter:g} mm is more than the run's", "make the thicker pipe the run")
    across, _, along = local_point(frame, tee.branch_end).tolist()
    return Fitting(tee, treatment, frame, begin, end, math.hypot(across, along), math.atan2(across, along))


def _reach(fitting: Fitting, room: Room) -> float:
    """Return how far along the branch insulation goes (mm), 0 where there is no room outside of the run's."""
    length = fitting.branch_length
    limit = length + room.beside((fitting.tee.id, BRANCH)) + SAME
    return next((far for stub in (LEAST_STUB_MM, LEAST_MM) if (far := max(fitting.emergence + stub, length)) <= limit), 0.0)


def _keep_out(fitting: Fitting, room: Room) -> None:
    """Let the insulation of a pipe at the branch begin where the run's ends."""
    end: End = (fitting.tee.id, BRANCH)
    pipe = room.connections.partner(end)
    outer = room.connections.outer_radius(room.connections.partners[end]) if isinstance(pipe, Pipe) else None
    if outer is not None:
        clear = (fitting.radius + outer * abs(math.cos(fitting.branch_angle))) / math.sin(fitting.branch_angle)
        room.take(end, min(clear - fitting.branch_length, room.beside(end)))
