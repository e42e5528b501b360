# SPDX-License-Identifier: LGPL-2.1-or-later
"""What planning knows of a pipeline: which end is joined to which, how each component is insulated, and how long pipes are free."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, field

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import AnyComponent, Pipe, Pipeline, Tee

End = tuple[str, int]  # a component's id and the number of its port
BRANCH = 2  # a tee's third port


@dataclass(frozen=True)
class Connections:
    """Components and their treatments by id, and what each end is joined to.

    ``sheet_width`` (mm) is the widest usable sheet, None where the specification names none. Components whose treatment
    cannot be told have none, and a problem.
    """

    components: dict[str, AnyComponent]
    partners: dict[End, End]
    treatments: dict[str, Treatment]
    sheet_width: float | None = None
    problems: tuple[InputError, ...] = ()

    @classmethod
    def of(cls, pipeline: Pipeline, specification: Specification, runs: dict[str, str], bare: Container[str] = ()) -> Connections:
        """Return a pipeline's connections; the components in ``bare`` get no insulation whatever the specification says."""
        treatments: dict[str, Treatment] = {}
        problems = []
        for component in pipeline.components:
            try:
                treatment = None if component.id in bare else specification.treatment_of(component, runs[component.id])
            except InputError as error:
                problems.append(error)
            else:
                treatments |= {} if treatment is None else {component.id: treatment}
        partners: dict[End, End] = {}
        for joint in pipeline.joints:
            one, other = (joint.a, int(joint.a_port)), (joint.b, int(joint.b_port))
            # each end once: what is joined twice is the pipeline's fault, and the first joint is as good as the second
            if one not in partners and other not in partners and one != other:
                partners[one], partners[other] = other, one
        sheets = [max(size.width, size.height) - 2 * size.margin for size in specification.sheet_sizes]
        return cls(
            {c.id: c for c in pipeline.components},
            partners,
            treatments,
            max(sheets, default=None),
            tuple(problems),
        )

    def partner(self, end: End) -> AnyComponent | None:
        """Return the component that is joined to an end."""
        return self.components[self.partners[end][0]] if end in self.partners else None

    def outer_radius(self, end: End) -> float | None:
        """Return the radius (mm) of the insulation around a component's end with its jacket; None where it is bare."""
        name, port = end
        if name not in self.treatments:
            return None
        return end_radius(self.components[name], port) + total_thickness(self.treatments[name])


@dataclass
class Room:
    """How much of each pipe (mm) is given up at its ends, for bolts and for the collars of its neighbours; ``taken`` by end."""

    connections: Connections
    taken: dict[End, float] = field(default_factory=dict)

    def left(self, pipe: Pipe) -> float:
        """Return what is left of a pipe in mm."""
        return pipe.length - self.taken.get((pipe.id, 0), 0.0) - self.taken.get((pipe.id, 1), 0.0)

    def beside(self, end: End) -> float:
        """Return how far (mm) a collar can go over what is joined to an end: as much as is left of a pipe, nothing of anything else."""
        partner = self.connections.partner(end)
        return max(self.left(partner), 0.0) if isinstance(partner, Pipe) else 0.0

    def take(self, end: End, collar: float) -> None:
        """Let a collar (mm) go over the pipe that is joined to an end."""
        if collar > 0:
            other = self.connections.partners[end]
            self.taken[other] = self.taken.get(other, 0.0) + collar


def total_thickness(treatment: Treatment) -> float:
    """Return the thickness (mm) of all layers and the jacket."""
    return treatment.thickness + (treatment.jacket.thickness if treatment.jacket else 0.0)


def end_radius(component: AnyComponent, port: int) -> float:
    """Return the radius (mm) of a component's metal at one of its ends; a flange's that of its pipe."""
    match component:
        case Tee() if port == BRANCH:
            return component.branch_diameter / 2
        case _ if component.kind == "reducer" and port == 1:
            return component.ports[1].diameter / 2
    return component.outer_diameter / 2
