# SPDX-License-Identifier: LGPL-2.1-or-later
"""The insulation of a document: gathered from it, planned without it (in a thread, too).

All Insulation objects of a document are planned together, for neighbours must fit. Where several hold the same component the
last one counts. Components of stations that are not merged are planned by themselves.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pipeworkbench.catalogue import catalogue
from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import frames_of
from pipeworkbench.features.base import is_newer
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import components_in, connections_in, pipeline_of
from pipeworkbench.features.joints import joints_of
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.rules import Changes, ComponentRule
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import AnyComponent, Pipeline

if TYPE_CHECKING:
    from pipeworkbench.insulation.clashes import Clash
    from pipeworkbench.insulation.energy import Energy
    from pipeworkbench.insulation.planning import Piece, Plan

COMPONENTS_KEPT = 20000
PLANS_KEPT = 4  # the last ones: all Insulation objects of a document share one


@dataclass(frozen=True)
class Insulated:
    """Components that are insulated by one object: its name, their ids, and what is said of them."""

    name: str
    components: tuple[str, ...]
    specification: Specification


@dataclass(frozen=True, eq=False)
class InsulationTask:
    """What is to be planned: the pipelines of all frames, who insulates what, and what cannot be planned at all."""

    pipelines: tuple[Pipeline, ...]
    insulated: tuple[Insulated, ...]
    problems: tuple[InputError, ...] = ()

    def plan(self) -> PlannedInsulation:
        """Plan all frames in which something is insulated; the document is not touched."""
        from pipeworkbench.insulation.planning import plan

        owners = {component: one.name for one in self.insulated for component in one.components}
        plans, problems = [], list(self.problems)
        for pipeline in self.pipelines:
            if owners.keys().isdisjoint(component.id for component in pipeline.components):
                continue
            try:
                plans.append(plan(pipeline, together(self.insulated)))
            except InputError as error:
                problems.append(error)
        return PlannedInsulation(tuple(plans), owners, tuple(problems))


@dataclass(frozen=True, eq=False)
class PlannedInsulation:
    """The plans of all frames, whose component is whose, and what kept something from being planned."""

    plans: tuple[Plan, ...]
    owners: Mapping[str, str]
    unplanned: tuple[InputError, ...] = ()

    def pieces(self, name: str) -> list[Piece]:
        """Return the pieces of an object's components."""
        return [piece for plan in self.plans for piece in plan.pieces if self.owners.get(piece.covering.component) == name]

    def problems(self, name: str) -> list[InputError]:
        """Return what keeps an object's components bare."""
        planned = [error for plan in self.plans for error in plan.problems if self._concerns(error.source, name)]
        return [*(error for error in self.unplanned if self._concerns(error.source, name)), *planned]

    def clashes(self, name: str) -> list[Clash]:
        """Return where an object's insulation is too close to something."""
        own = {piece.covering.id for piece in self.pieces(name)}
        return [clash for plan in self.plans for clash in plan.clashes if not own.isdisjoint((clash.a, clash.b))]

    def components_of(self, ids: Iterable[str]) -> list[str]:
        """Return the components that coverings lie around, by their ids; other ids stay as they are."""
        components = {piece.covering.id: piece.covering.component for plan in self.plans for piece in plan.pieces}
        return [components.get(name, name) for name in ids]

    def remarks(self, name: str) -> list[str]:
        """Return what is to be told of an object's insulation, each once."""
        own = {remark for piece in self.pieces(name) for remark in piece.treatment.remarks}
        others = {remark for plan in self.plans for piece in plan.pieces for remark in piece.treatment.remarks} - own
        told = dict.fromkeys(remark for plan in self.plans for remark in plan.remarks if remark not in others)
        return [remark for remark in told if self._concerns(remark.partition(":")[0], name)]

    def energy(self, name: str, treatments: Mapping[str, Treatment] | None = None) -> Energy | None:
        """Return what an object's components lose, bare and insulated; None where no temperature of a medium is known.

        Parameters
        ----------
        name : str
            Of the object.
        treatments : mapping, optional
            Other treatments than the planned ones, by the components' ids; what has none is bare.
        """
        from pipeworkbench.insulation.energy import energy_of_components

        treated = self.treatments if treatments is None else treatments
        items = [(one, treated.get(one.id), operation) for one, operation in self._operated(name) if operation.medium_temperature is not None]
        return energy_of_components(items) if items else None

    @property
    def treatments(self) -> dict[str, Treatment]:
        """How components are treated, those under boxes too; bare ones are left out."""
        found: dict[str, Treatment] = {}
        for plan in self.plans:
            pieces = ((component.id, plan.piece_of(component.id)) for component in plan.pipeline.components)
            found |= {component: piece.treatment for component, piece in pieces if piece is not None}
        return found

    def _operated(self, name: str) -> Iterator[tuple[AnyComponent, Operation]]:
        """Yield an object's components and in what service they are."""
        from pipeworkbench.insulation.runs import runs_of

        for plan in self.plans:
            runs = runs_of(plan.pipeline)
            for component in plan.pipeline.components:
                if self.owners.get(component.id) == name:
                    yield component, plan.specification.operation_of(component, runs[component.id])

    def _concerns(self, source: str, name: str) -> bool:
        """Tell whether something that is said of components is said of an object's; what names none concerns all objects."""
        named = [self.owners[part] for part in source.split(", ") if part in self.owners]
        return name in named if named else True


def together(insulated: Sequence[Insulated]) -> Specification:
    """Return one specification for all: the later ones win, and nothing holds for components that none of them has."""
    rules: list[ComponentRule] = []
    for one in insulated:
        said, default = one.specification, one.specification.default
        changes = Changes.of(default) if isinstance(default, Treatment) else default or Changes(layers=())
        changes = dataclasses.replace(changes, operation={**_fields(said.operation), **changes.operation})
        rules.append(_rule_for(one.components, ComponentRule(changes=changes, name=one.name)))
        rules += [_rule_for(one.components, rule) for rule in said.rules]
    if not insulated:
        return Specification()
    specifications = [one.specification for one in insulated]
    obstacles = {obstacle.id: obstacle for said in specifications for obstacle in said.obstacles}
    return dataclasses.replace(
        specifications[-1],
        default=None,
        rules=tuple(rules),
        minimum_distance=max(said.minimum_distance for said in specifications),
        obstacles=tuple(obstacles.values()),
        sheet_sizes=tuple(dict.fromkeys(size for said in reversed(specifications) for size in said.sheet_sizes)),
        prices={name: price for said in specifications for name, price in said.prices.items()},
    )


def task_of(document: Any, insulated: Sequence[Insulated]) -> InsulationTask:
    """Gather from a document what is to be planned.

    Components whose properties do not fit are left out, and said to be a problem.
    """
    pipelines: list[Pipeline] = []
    problems: list[InputError] = []
    wanted = {component for one in insulated for component in one.components}
    for objects in frames_of(document).values():
        if wanted.isdisjoint(obj.ComponentId for obj in objects):
            continue
        try:
            pipelines.append(pipeline_of(document, objects, _component))
        except InputError:
            fitting, errors = _fitting(objects)
            problems += [error for error in errors if error.source in wanted]
            try:
                pipelines.append(pipeline_of(document, fitting, _component))
            except InputError as error:
                problems.append(error)
    return InsulationTask(tuple(pipelines), tuple(insulated), tuple(problems))


def planned(document: Any, insulated: Sequence[Insulated], state: str) -> PlannedInsulation:
    """Return the plan of a document in a state (``state_of``); made where it was not made already."""
    key = (state, id(catalogue()))
    found = _plans.pop(key, None) or task_of(document, insulated).plan()
    _plans[key] = found  # the last used is the last to go
    if len(_plans) > PLANS_KEPT:
        del _plans[next(iter(_plans))]
    return found


_plans: dict[tuple[str, int], PlannedInsulation] = {}


def state_of(document: Any, said: Iterable[object]) -> str:
    """Return a digest of what a document's insulation depends on: its components, their joints and frames, and what is ``said`` of insulation."""
    components = [(obj.Name, *_said(obj), [(one.end, one.other.Name, one.other_end) for one in joints_of(obj)]) for obj in components_in(document)]
    frames = sorted((name, list(obj.Stations)) for name, obj in connections_in(document).items())
    return hashlib.sha256(json.dumps([components, frames, list(said)]).encode()).hexdigest()


def _said(obj: Any) -> tuple[Any, ...]:
    """Return what the component of an object depends on."""
    placement = tuple(obj.getGlobalPlacement().toMatrix().A)
    shape = "" if is_newer(obj) else obj.Proxy.model_key(obj)
    return (obj.ComponentId, obj.SchemaVersion, shape, placement, obj.Fixed, obj.Standard, obj.StandardSources, obj.MeasuredAs)


_components: dict[tuple[Any, ...], AnyComponent] = {}


def _component(obj: Any) -> AnyComponent:
    """Return an object's component; reading it anew takes longer than telling that nothing has changed."""
    key = _said(obj)
    if key not in _components:
        if len(_components) >= COMPONENTS_KEPT:
            _components.clear()
        _components[key] = component_of(obj)
    return _components[key]


def _rule_for(components: tuple[str, ...], rule: ComponentRule) -> ComponentRule:
    """Return a rule for no other components than these."""
    ids = components if rule.match.ids is None else tuple(name for name in rule.match.ids if name in components)
    return dataclasses.replace(rule, match=dataclasses.replace(rule.match, ids=ids))


def _fields(item: Any) -> dict[str, Any]:
    return {field.name: getattr(item, field.name) for field in dataclasses.fields(item)}


def _fitting(objects: Iterable[Any]) -> tuple[list[Any], list[InputError]]:
    """Part component objects into those that are components and the reasons why the others are none."""
    fitting, errors = [], []
    for obj in objects:
        try:
            _component(obj)
        except InputError as error:
            errors.append(InputError(obj.ComponentId, error.key, error.problem, error.remedy))
        else:
            fitting.append(obj)
    return fitting, errors
