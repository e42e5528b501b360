# SPDX-License-Identifier: LGPL-2.1-or-later
"""What pipework loses in a year, bare and insulated: heat, energy, money, carbon dioxide, and what the insulation saves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from pipeworkbench.insulation.component_loss import ComponentLoss, component_loss
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.planning import Plan
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import AnyComponent, Pipeline

KW = 1e-3  # of a W


@dataclass(frozen=True)
class Yearly:
    """One year: ``heat`` lost in W while in operation, ``energy`` bought for it in kWh/a, ``cost`` in money/a, ``co2`` in kg/a.

    Cost and CO2 are None where their price or their share is not known.
    """

    heat: float
    energy: float
    cost: float | None = None
    co2: float | None = None

    def less(self, other: Yearly) -> Yearly:
        """Return how much less the other is."""
        return Yearly(self.heat - other.heat, self.energy - other.energy, _less(self.cost, other.cost), _less(self.co2, other.co2))


@dataclass(frozen=True, kw_only=True)
class EnergyRow:
    """One component: what it loses ``bare`` and as it is treated (``insulated``; the same where it stays bare).

    ``thickness`` (mm) of the insulation is 0 where it is bare, ``length`` in m; the temperatures (deg C) are the medium's and
    the surfaces'. ``remarks`` are those of the treatment.
    """

    component: str
    kind: str
    run: str
    outer_diameter: float
    length: float
    thickness: float
    medium_temperature: float
    bare_surface_temperature: float
    surface_temperature: float
    bare: Yearly
    insulated: Yearly
    currency: str
    remarks: tuple[str, ...] = ()

    @property
    def saved(self) -> Yearly:
        """What the insulation saves."""
        return self.bare.less(self.insulated)


@dataclass(frozen=True)
class Energy:
    """All components of a pipeline and their sums."""

    rows: tuple[EnergyRow, ...]

    @property
    def bare(self) -> Yearly:
        """What all lose without insulation."""
        return _sum([row.bare for row in self.rows])

    @property
    def insulated(self) -> Yearly:
        """What all lose as they are treated."""
        return _sum([row.insulated for row in self.rows])

    @property
    def saved(self) -> Yearly:
        """What the insulation of all saves."""
        return self.bare.less(self.insulated)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be told of the figures, each once."""
        return tuple(dict.fromkeys(remark for row in self.rows for remark in row.remarks))


def energy_of(pipeline: Pipeline, specification: Specification) -> Energy:
    """Return what a pipeline loses in a year, bare and insulated as specified.

    Raises
    ------
    InputError
        Where a component's medium temperature is not specified, or its treatment cannot be worked out.
    """
    runs = runs_of(pipeline)
    items = [(c, specification.treatment_of(c, runs[c.id]), specification.operation_of(c, runs[c.id])) for c in pipeline.components]
    return energy_of_components(items, runs.__getitem__)


def energy_of_plan(plan: Plan) -> Energy | None:
    """Return what a pipeline loses in a year, bare and as it is planned; components whose medium's temperature is not known are left out.

    None where that of no component is known.
    """
    runs = runs_of(plan.pipeline)
    items: list[tuple[AnyComponent, Treatment | None, Operation]] = []
    for component in plan.pipeline.components:
        operation, piece = plan.specification.operation_of(component, runs[component.id]), plan.piece_of(component.id)
        if operation.medium_temperature is not None:
            items.append((component, piece.treatment if piece else None, operation))
    return energy_of_components(items, runs.__getitem__) if items else None


def energy_of_components(items: Iterable[tuple[AnyComponent, Treatment | None, Operation]], run_of: Callable[[str], str] = lambda _: "") -> Energy:
    """Return what components lose in a year, each with its treatment (None is bare) and its operation; ``run_of`` names an id's run."""
    return Energy(tuple(_row(component, treatment, operation, run_of(component.id)) for component, treatment, operation in items))


def compare(component: AnyComponent, operation: Operation, treatments: Sequence[Treatment | None]) -> tuple[EnergyRow, ...]:
    """Return what one component would lose with each of several treatments: "what does this pipe lose now, and with 60 mm?".

    Parameters
    ----------
    component : Component
    operation : Operation
    treatments : sequence of Treatment or None
        None is the bare component.

    Returns
    -------
    tuple of EnergyRow
        In the treatments' order.
    """
    return tuple(_row(component, treatment, operation, "") for treatment in treatments)


def _row(component: AnyComponent, treatment: Treatment | None, operation: Operation, run: str) -> EnergyRow:
    bare = component_loss(component, None, operation)
    insulated = bare if treatment is None else component_loss(component, treatment, operation)
    return EnergyRow(
        component=component.id,
        kind=component.kind,
        run=run,
        outer_diameter=component.outer_diameter,
        length=bare.length,
        thickness=treatment.thickness if treatment is not None and insulated != bare else 0.0,
        medium_temperature=math.nan if operation.medium_temperature is None else operation.medium_temperature,
        bare_surface_temperature=bare.surface_temperature,
        surface_temperature=insulated.surface_temperature,
        bare=_yearly(bare, operation),
        insulated=_yearly(insulated, operation),
        currency=operation.currency,
        remarks=() if treatment is None else treatment.remarks,
    )


def _yearly(loss: ComponentLoss, operation: Operation) -> Yearly:
    """Return a year of a loss; cold that is lost is bought like heat."""
    energy = abs(loss.heat) * KW * operation.hours_per_year / operation.efficiency
    return Yearly(loss.heat, energy, _times(energy, operation.price_per_kwh), _times(energy, operation.kg_co2_per_kwh))


def _sum(years: Sequence[Yearly]) -> Yearly:
    costs, co2 = [year.cost for year in years], [year.co2 for year in years]
    return Yearly(math.fsum(year.heat for year in years), math.fsum(year.energy for year in years), _all_known(costs), _all_known(co2))


def _all_known(values: Sequence[float | None]) -> float | None:
    """Return the sum, None where one is not known."""
    known = [value for value in values if value is not None]
    return math.fsum(known) if len(known) == len(values) else None


def _times(energy: float, factor: float | None) -> float | None:
    return None if factor is None else energy * factor


def _less(a: float | None, b: float | None) -> float | None:
    return None if a is None or b is None else a - b
