# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was found and waits for the user's word: proposals, of which one is shown and some are ticked. Knows neither Qt nor FreeCAD."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from pipeworkbench.pipeline import AnyComponent, Elbow
from pipeworkbench.recon import caps, elbows, reducers, tees
from pipeworkbench.recon.assemble import joined_ends
from pipeworkbench.recon.fitting import Assembly, with_caps, with_elbows, with_reducers, with_tees
from pipeworkbench.recon.topology import TopologySettings
from pipeworkbench.recon.views import View

Found = elbows.FoundElbow | tees.FoundTee | reducers.FoundReducer | caps.FoundCap
KINDS: tuple[tuple[type[Any], Any, Any], ...] = (
    # in the order of `assemble`: what is found first takes the ends
    (reducers.FoundReducer, reducers.detect, with_reducers),
    (tees.FoundTee, tees.detect, with_tees),
    (elbows.FoundElbow, elbows.detect, with_elbows),
    (caps.FoundCap, caps.detect, with_caps),
)
KIND_NAMES: dict[type[Any], str] = {reducers.FoundReducer: "reducer", tees.FoundTee: "tee", elbows.FoundElbow: "elbow", caps.FoundCap: "cap"}
EVERYTHING = 1e9
# of fittings between pipes that the user named: where they are and how they fit is asked for, not whether they are there
FORGIVING: dict[type[Any], Any] = {
    reducers.FoundReducer: reducers.ReducerSettings(gap=6.0, overlap=3.0, aside_mm=40.0, least_support=0.0, worst_quality=EVERYTHING),
    tees.FoundTee: tees.TeeSettings(skew=0.6, skew_mm=60.0, angle_tolerance_deg=30.0, gap=8.0, gap_mm=400.0, share=0.0),
    elbows.FoundElbow: elbows.ElbowSettings(
        largest_skew=0.6,
        largest_skew_mm=60.0,
        gap=12.0,
        gap_mm=1200.0,
        overshoot=4.0,
        diameter_tolerance=0.2,
        worst_quality=EVERYTHING,
        least_support=0.0,
        least_bend=-EVERYTHING,
        far_bend=-EVERYTHING,
        least_visible=0.0,
        hope=0.0,
    ),
    caps.FoundCap: caps.CapSettings(rough_support=0.0, least_support=0.0, worst_quality=EVERYTHING, clear=-EVERYTHING, near=0.1),
}


@dataclass(frozen=True, eq=False)
class Proposal:
    """A component that may be accepted.

    ``names`` are the ids of the components that ``found`` refers to by row, in their order when it was found; a pipe that was found refers to none.
    ``confidence`` is the logarithm of how much likelier than chance it is, None where nobody says.
    """

    component: AnyComponent
    found: Found | None = None
    names: tuple[str, ...] = ()
    confidence: float | None = None

    @property
    def key(self) -> object:
        """What tells it from other proposals, whatever its component becomes."""
        return self.component.id if self.found is None else id(self.found)

    @property
    def neighbours(self) -> tuple[str, ...]:
        """The ids of the components that it lies between."""
        return tuple(self.names[row] for row in _rows_of(self.found)) if self.found is not None else ()


@dataclass(eq=False)
class Proposals:
    """All proposals, which of them is shown and which are ticked."""

    items: list[Proposal] = field(default_factory=list)
    row: int = -1
    ticks: list[bool] = field(default_factory=list)

    def fill(self, items: Iterable[Proposal]) -> None:
        """Begin with new proposals, all ticked, the first one shown."""
        self.items = list(items)
        self.ticks = [True] * len(self.items)
        self.row = 0 if self.items else -1

    @property
    def current(self) -> Proposal | None:
        """The proposal that is shown."""
        return self.items[self.row] if 0 <= self.row < len(self.items) else None

    @property
    def ticked(self) -> list[Proposal]:
        """The proposals that are ticked."""
        return [item for item, ticked in zip(self.items, self.ticks, strict=True) if ticked]

    def remove(self, gone: Sequence[Proposal]) -> None:
        """Take proposals out: they were accepted or rejected."""
        shown = self.row
        kept = [number for number, item in enumerate(self.items) if all(item is not other for other in gone)]
        shown -= sum(1 for number in range(len(self.items)) if number < self.row and number not in kept)
        self.items, self.ticks = [self.items[number] for number in kept], [self.ticks[number] for number in kept]
        self.row = min(shown, len(self.items) - 1)

    def add(self, proposal: Proposal) -> None:
        """Put a proposal at the end of the list, ticked."""
        self.items.append(proposal)
        self.ticks.append(True)
        self.row = max(self.row, 0)

    def update(self, renewed: Callable[[Proposal], Proposal | None]) -> None:
        """Put renewed proposals in the places of the old ones; those that no longer are possible go."""
        new = [renewed(item) for item in self.items]
        self.remove([item for item, now in zip(self.items, new, strict=True) if now is None])
        self.items = [now for now in new if now is not None]

    def replace_current(self, proposal: Proposal) -> None:
        """Put another proposal in the place of the one that is shown."""
        self.items[self.row] = proposal

    def tick_above(self, confidence: float) -> None:
        """Tick the proposals from a confidence on, and no others."""
        self.ticks = [(item.confidence or 0.0) >= confidence for item in self.items]


def fittings_found(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    kinds: Iterable[type[Any]],
    station: str,
    chosen: Sequence[str] = (),
    topology: TopologySettings | None = None,
) -> list[Proposal]:
    """Look for fittings of some kinds between components.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        Of the station, in its level frame.
    kinds : iterable
        Of ``FoundElbow``, ``FoundTee``, ``FoundReducer``, ``FoundCap``.
    station : str
        Its name begins the fittings' ids.
    chosen : sequence of str
        Ids of the pipes between which the user says that there is one; then the likeliest is returned even where the images hardly show it.
    topology : TopologySettings, optional
        Which ends are joined already.
    """
    names = tuple(component.id for component in components)
    considered = tuple(component for component in components if not chosen or component.id in chosen)
    rows = {component.id: row for row, component in enumerate(components)}
    taken = joined_ends(components, topology)
    own_taken = frozenset((row, port) for row, component in enumerate(considered) for port in range(3) if (rows[component.id], port) in taken)
    wanted = set(kinds)
    found: list[Proposal] = []
    for kind, detect, _ in KINDS:
        if kind not in wanted:
            continue
        for one in detect(views, considered, FORGIVING[kind] if chosen else None, own_taken):
            whole = _renumbered(one, {row: rows[component.id] for row, component in enumerate(considered)})
            proposal = preview(components, Proposal(components[0], whole, names, _confidence(one)), station, topology)
            if proposal is not None:
                found.append(proposal)
    return found


def preview(components: Sequence[AnyComponent], proposal: Proposal, station: str, topology: TopologySettings | None = None) -> Proposal | None:
    """Return a proposal with its component as it would be among the components as they are now, None where it is no longer possible."""
    whole, _, names = applied(components, [proposal], station, topology)
    made = next((component for component in whole if component.id == names.get(proposal.key)), None)
    return None if made is None else replace(proposal, component=made)


def applied(
    components: Sequence[AnyComponent], proposals: Sequence[Proposal], station: str, topology: TopologySettings | None = None
) -> tuple[tuple[AnyComponent, ...], tuple[AnyComponent, ...], dict[object, str]]:
    """Put proposals among components.

    Returns
    -------
    components : tuple
        All, after that.
    changed : tuple
        Those of them that are new or changed.
    names : dict
        The ids of the proposals' components by the proposals' keys; what is no longer possible has none.
    """
    rows = {component.id: row for row, component in enumerate(components)}
    assembly = Assembly(tuple(components), joined_ends(components, topology), station)
    names: dict[object, str] = {}
    for kind, _, put in KINDS:
        for proposal in proposals:
            if not isinstance(proposal.found, kind) or not set(proposal.neighbours) <= rows.keys():
                continue
            before = {component.id for component in assembly.components}
            assembly = put(assembly, [_renumbered(proposal.found, {row: rows[proposal.names[row]] for row in _rows_of(proposal.found)})])
            made = next((c for c in assembly.components if c.id not in before and c.kind == KIND_NAMES[kind]), None)
            if made is not None:
                names[proposal.key] = made.id
    pipes = [proposal for proposal in proposals if proposal.found is None and proposal.component.id not in rows]
    names |= {proposal.key: proposal.component.id for proposal in pipes}
    whole = (*assembly.components, *(proposal.component for proposal in pipes))
    before_all = {id(component) for component in components}
    return whole, tuple(component for component in whole if id(component) not in before_all), names


def with_radius(proposal: Proposal, bend_radius: float, bend: Any = None) -> Proposal:
    """Return the proposal of an elbow with another bend radius (mm), a standard's where its ``bend`` is given."""
    if not isinstance(proposal.found, elbows.FoundElbow) or not isinstance(proposal.component, Elbow):
        return proposal
    return replace(proposal, found=replace(proposal.found, bend_radius=bend_radius, bend=bend))


def _confidence(found: Any) -> float | None:
    score = getattr(found, "score", None)
    return None if score is None else float(score)


def _rows_of(found: Any) -> tuple[int, ...]:
    """Return the rows of the components that a finding refers to."""
    match found:
        case elbows.FoundElbow():
            return found.first[0], found.second[0]
        case tees.FoundTee():
            return found.branch[0], found.run
        case reducers.FoundReducer():
            return found.wide[0], found.narrow[0]
        case caps.FoundCap():
            return (found.end[0],)
        case _:
            return ()


def _renumbered(found: Any, rows: dict[int, int]) -> Any:
    """Return a finding that refers to components by other rows."""

    def moved(end: tuple[int, int]) -> tuple[int, int]:
        return rows[end[0]], end[1]

    match found:
        case elbows.FoundElbow():
            return replace(found, first=moved(found.first), second=moved(found.second))
        case tees.FoundTee():
            return replace(found, branch=moved(found.branch), run=rows[found.run])
        case reducers.FoundReducer():
            return replace(found, wide=moved(found.wide), narrow=moved(found.narrow))
        case _:
            return replace(found, end=moved(found.end))
