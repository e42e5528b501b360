# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a pipeline and a specification to a plan: which covering goes where, what stays bare, what does not fit."""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass

from pipeworkbench.errors import InputError
from pipeworkbench.insulation.bends import bend_covering, bends_of, tight_bends
from pipeworkbench.insulation.boxes import Straights, bolt_cuts, box_covering, chains_of, straights_of, with_partners
from pipeworkbench.insulation.clashes import Clash, resolved_clashes
from pipeworkbench.insulation.connections import Connections, End, Room
from pipeworkbench.insulation.runs import runs_of
from pipeworkbench.insulation.seams import with_seams
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.insulation.stops import stops_of
from pipeworkbench.insulation.tees import tee_covering, tees_of
from pipeworkbench.insulation.treatment import Treatment
from pipeworkbench.pipeline import Cap, Pipeline, Reducer, free_id
from pipeworkbench.solids.covering_limits import refuse_impossible
from pipeworkbench.solids.coverings import AnyCovering, BoxCovering, CapCovering, ConeCovering, StopCovering, StraightCovering
from pipeworkbench.solids.frames import frame_of, local_point

Maker = Callable[[], tuple[AnyCovering, list[str]]]


@dataclass(frozen=True)
class Piece:
    """A covering, the treatment it follows, and the name of its run."""

    covering: AnyCovering
    treatment: Treatment
    run: str


@dataclass(frozen=True)
class Plan:
    """What insulation a pipeline gets.

    ``problems`` name what cannot be insulated as asked; those components have no covering, or, where an obstacle cannot be cut
    around, one that is not cut. ``bare`` are the components without covering, ``remarks`` what a person should know.
    ``left_bare`` are those that stay bare although the specification covers them.
    """

    pipeline: Pipeline
    specification: Specification
    pieces: tuple[Piece, ...]
    clashes: tuple[Clash, ...]
    problems: tuple[InputError, ...]
    remarks: tuple[str, ...]
    bare: tuple[str, ...]
    left_bare: frozenset[str] = frozenset()

    def piece_of(self, component: str) -> Piece | None:
        """Return the piece that covers a component, its own or the box over it; None where it is bare."""
        return self._pieces.get(component)

    def check(self) -> None:
        """Raise the first problem, which tells how many more there are."""
        if self.problems:
            first, more = self.problems[0], len(self.problems) - 1
            remedy = f"{first.remedy} ({more} more such problem{'s' if more > 1 else ''})" if more else first.remedy
            raise InputError(first.source, first.key, first.problem, remedy)

    def without(self, problems: Iterable[InputError]) -> Plan:
        """Return the plan in which the components that problems name stay bare."""
        return _planned(self.pipeline, self.specification, self.left_bare | {problem.source for problem in problems})

    @functools.cached_property
    def _pieces(self) -> dict[str, Piece]:
        return {name: piece for piece in self.pieces for name in _covered(piece.covering)}


def plan(pipeline: Pipeline, specification: Specification) -> Plan:
    """Return which covering goes where around a pipeline's components.

    Nothing is raised for what does not fit: it is listed among the plan's problems, and planned as if it were to stay bare.

    Parameters
    ----------
    pipeline : Pipeline
        With its joints: only what is joined belongs together.
    specification : Specification
    """
    return _planned(pipeline, specification, frozenset())


@dataclass(frozen=True, eq=False)
class _Layout:
    """Coverings with what they follow from, before anything is cut out of them."""

    connections: Connections
    room: Room
    faces: dict[End, End]
    coverings: tuple[AnyCovering, ...]
    problems: tuple[InputError, ...]
    remarks: tuple[str, ...]


def _planned(pipeline: Pipeline, specification: Specification, left_bare: frozenset[str]) -> Plan:
    runs = runs_of(pipeline)
    refused: set[str] = set(left_bare)
    problems: list[InputError] = []
    layout = _layout(pipeline, specification, runs, refused)
    # what does not fit stays bare, and its neighbours are planned anew
    while fresh := [problem for problem in layout.problems if problem.source not in refused]:
        problems += fresh
        refused |= {problem.source for problem in fresh}
        layout = _layout(pipeline, specification, runs, refused)
    used = {component.id for component in pipeline.components} | {covering.id for covering in layout.coverings}
    stops = stops_of(layout.coverings, layout.connections, layout.room, used)
    coverings = (*with_seams(layout.coverings, layout.connections), *stops)
    covered = {name for covering in coverings for name in _covered(covering)}
    bare = tuple(component.id for component in pipeline.components if component.id not in covered)
    resolved = resolved_clashes(coverings, layout.connections, layout.faces, bare, specification)
    told = [remark for treatment in layout.connections.treatments.values() for remark in treatment.remarks]
    return Plan(
        pipeline,
        specification,
        tuple(Piece(covering, layout.connections.treatments[covering.component], runs[covering.component]) for covering in resolved.coverings),
        resolved.clashes,
        (*problems, *resolved.problems),
        tuple(dict.fromkeys([*specification.unused(pipeline.components, runs), *layout.remarks, *told])),
        bare,
        left_bare,
    )


def _covered(covering: AnyCovering) -> tuple[str, ...]:
    """Return the components that a covering goes over."""
    if isinstance(covering, BoxCovering):
        return covering.components
    return () if isinstance(covering, StopCovering) else (covering.component,)


def _layout(pipeline: Pipeline, specification: Specification, runs: dict[str, str], bare: Collection[str]) -> _Layout:
    """Plan all coverings but the stops: first who needs room on which pipe, then who gets what is left."""
    connections, faces, remarks = with_partners(Connections.of(pipeline, specification, runs, bare), bare)
    room = Room(connections, bolt_cuts(connections))
    bends, bend_problems = bends_of(connections)
    tees, tee_problems = tees_of(connections)
    problems = [*connections.problems, *bend_problems, *tee_problems, *tight_bends(bends, room)]
    refused = {problem.source for problem in problems}
    coverings: list[AnyCovering] = []

    def make(makers: Iterable[Maker]) -> None:
        for maker in makers:
            try:
                covering, told = maker()
                refuse_impossible(covering)
            except InputError as error:
                problems.append(error)
            else:
                coverings.append(covering)
                remarks.extend(told)

    make(functools.partial(tee_covering, tee, room) for tee in tees)
    make(functools.partial(bend_covering, bend, connections, room) for bend in bends if bend.elbow.id not in refused)
    straights, told = straights_of(connections, room)
    remarks += told
    make(functools.partial(_plain, connections, name, straights) for name in connections.treatments if _is_plain(connections, name, straights))
    make(_boxes(connections, faces, straights, room))
    order = {name: number for number, name in enumerate(connections.components)}
    coverings.sort(key=lambda covering: order[covering.component])
    return _Layout(connections, room, faces, tuple(coverings), tuple(problems), tuple(remarks))


def _boxes(connections: Connections, faces: dict[End, End], straights: Straights, room: Room) -> list[Maker]:
    used = set(connections.components)
    makers: list[Maker] = []
    for chain in chains_of(connections, faces, straights):
        name = free_id(f"{chain.first.id} box", used)
        used.add(name)
        makers.append(functools.partial(box_covering, chain, name, connections, straights, room))
    return makers


def _is_plain(connections: Connections, name: str, straights: Straights) -> bool:
    return name in straights or isinstance(connections.components[name], Reducer | Cap)


def _plain(connections: Connections, name: str, straights: Straights) -> tuple[AnyCovering, list[str]]:
    """Return the covering of a component that takes nothing of its neighbours."""
    match connections.components[name]:
        case Reducer() as reducer:
            return _cone(reducer, connections.treatments[name]), []
        case Cap() as cap:
            return _pot(cap, connections.treatments[name]), []
    return _straight(connections, name, straights[name]), []


def _straight(connections: Connections, name: str, part: tuple[float, float]) -> StraightCovering:
    pipe, treatment = connections.components[name], connections.treatments[name]
    return StraightCovering(
        id=name,
        component=name,
        frame=frame_of(pipe),
        layers=treatment.layers,
        sheet=treatment.jacket,
        radius=pipe.outer_diameter / 2,
        begin=part[0],
        end=part[1],
    )


def _cone(reducer: Reducer, treatment: Treatment) -> ConeCovering:
    frame = frame_of(reducer)
    return ConeCovering(
        id=reducer.id,
        component=reducer.id,
        frame=frame,
        layers=treatment.layers,
        sheet=treatment.jacket,
        radius=reducer.outer_diameter / 2,
        end_radius=reducer.end_diameter / 2,
        length=reducer.length,
        offset=float(local_point(frame, reducer.end)[0]) if reducer.reducer_type == "eccentric" else 0.0,
    )


def _pot(cap: Cap, treatment: Treatment) -> CapCovering:
    return CapCovering(
        id=cap.id,
        component=cap.id,
        frame=frame_of(cap),
        layers=treatment.layers,
        sheet=treatment.jacket,
        radius=cap.outer_diameter / 2,
        length=cap.length,
    )
