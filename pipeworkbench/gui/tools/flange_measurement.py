# SPDX-License-Identifier: LGPL-2.1-or-later
"""One flange being measured, or given another type: the types it can be, and which is chosen. Knows neither Qt nor FreeCAD.

The position of the face is what was measured: it stays whatever type is chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from pipeworkbench.catalogue import FlangeDimensions, flanges_of_pipe
from pipeworkbench.pipeline import AnyComponent, Flange, Pipe
from pipeworkbench.recon.fitting import with_flanges
from pipeworkbench.recon.flanges import FlangeCandidate, from_pick, partner_of, with_dimensions
from pipeworkbench.recon.picks import FlangePick
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class FlangeChoice:
    """A type, class and standard of a flange; ``score`` is the logarithm of how likely the images make it, None where they were not asked."""

    dimensions: FlangeDimensions
    raised: bool
    score: float | None = None


@dataclass(frozen=True, eq=False)
class FlangeAnswer:
    """What a click on a rim means: the candidates, the likeliest first, and the flange that faces the first one."""

    candidates: tuple[FlangeCandidate, ...]
    partner: Flange | None


def answer_flange_pick(views: Sequence[View], pick: FlangePick, components: Sequence[AnyComponent], station: str) -> FlangeAnswer:
    """Return the flanges that a click on a rim can mean.

    Raises
    ------
    InputError
        Where it is on no rim, or far from all pipes; says which.
    """
    pipes = [component for component in components if isinstance(component, Pipe)]
    others = [component for component in components if not isinstance(component, Pipe)]
    candidates = from_pick(views, pick, pipes, others, station=station)
    partner = partner_of(views, candidates[0], pipes, others)
    known = [component for component in components if isinstance(component, Flange)]
    if partner is not None and any(_is_at(partner, other) for other in known):
        partner = None
    return FlangeAnswer(candidates, partner)


class FlangeMeasurement:
    """The flange, the list of what it can be, and the choice.

    Attributes
    ----------
    choices : list of FlangeChoice
        The likeliest first, then the others of the catalogue.
    row : int
        Which is chosen, -1 for what the flange is already.
    with_partner : bool
        Whether the flange that faces it is wanted as well.
    """

    def __init__(self) -> None:
        self.choices: list[FlangeChoice] = []
        self.row = -1
        self.with_partner = True
        self.partner: Flange | None = None
        self._measured: Flange | None = None

    @property
    def flange(self) -> Flange | None:
        """The flange as it is chosen, None where there is none."""
        if self._measured is None or self.row < 0:
            return self._measured
        choice = self.choices[self.row]
        if self._is_measured_as(choice):
            return self._measured
        height = choice.dimensions.raised_face_height if choice.raised else None
        # the face is kept raised or flat as the choice says
        return with_dimensions(replace(self._measured, raised_face_height=height, raised_face_diameter=None), choice.dimensions)

    def take(self, answer: FlangeAnswer, clicked: dict[str, Any]) -> None:
        """Take what a click means; the clicks are kept with the flange."""
        best = answer.candidates[0]
        self._measured = replace(best.flange, extra=best.flange.extra | clicked)
        self.partner = answer.partner
        ranked = [FlangeChoice(one.hypothesis.variant.dimensions, one.hypothesis.variant.raised > 0, one.score) for one in best.ranking]
        self.choices = _with_catalogue(_distinct(ranked), best.flange.outer_diameter)
        self.row = 0

    def change(self, flange: Flange) -> None:
        """Take a flange that is in the document, to give it another type."""
        self._measured, self.partner = flange, None
        self.choices = _with_catalogue([], flange.outer_diameter)
        self.row = next((row for row, choice in enumerate(self.choices) if self._is_measured_as(choice)), -1)

    def choose(self, row: int) -> bool:
        """Choose a type; whether there is such a one."""
        if not 0 <= row < len(self.choices):
            return False
        self.row = row
        return True

    def clear(self) -> None:
        """Forget the flange."""
        self.choices, self.row, self.partner, self._measured = [], -1, None, None

    def result(self, components: Sequence[AnyComponent]) -> tuple[tuple[AnyComponent, ...], tuple[AnyComponent, ...]]:
        """Return all components with the flange in its place, its pipe ending at it, and those of them that are new or changed."""
        if self.flange is None:
            return tuple(components), ()
        partner = (self.partner,) if self.partner is not None and self.with_partner else ()
        others = [component for component in components if component.id not in {self.flange.id, *(one.id for one in partner)}]
        whole = with_flanges([*others, self.flange, *partner])
        before = {id(component) for component in components}
        return whole, tuple(component for component in whole if id(component) not in before)

    def _is_measured_as(self, choice: FlangeChoice) -> bool:
        flange = self._measured
        if flange is None:
            return False
        same = (flange.standard, flange.flange_type, float(flange.pn)) == (
            choice.dimensions.standard,
            choice.dimensions.flange_type,
            float(choice.dimensions.pn),
        )
        return same and bool(flange.raised_face_height) == choice.raised


def _with_catalogue(ranked: list[FlangeChoice], outer_diameter: float) -> list[FlangeChoice]:
    """Return ranked choices and, after them, what else the catalogue has for a pipe."""
    known = {_name(choice) for choice in ranked}
    rest = [
        FlangeChoice(row, bool(row.raised_face_height and row.raised_face_diameter)) for row in flanges_of_pipe(outer_diameter) if row.is_complete
    ]
    rest.sort(key=lambda choice: (choice.dimensions.standard != "EN 1092-1", choice.dimensions.flange_type, choice.dimensions.pn))
    return ranked + [choice for choice in rest if _name(choice) not in known]


def _distinct(ranked: list[FlangeChoice]) -> list[FlangeChoice]:
    """Return the best choice of each type, class and standard."""
    kept: dict[tuple[str, str, float], FlangeChoice] = {}
    for choice in ranked:
        kept.setdefault(_name(choice), choice)
    return list(kept.values())


def _name(choice: FlangeChoice) -> tuple[str, str, float]:
    return choice.dimensions.standard, choice.dimensions.flange_type, float(choice.dimensions.pn)


def _is_at(one: Flange, other: Flange) -> bool:
    """Tell whether two flanges face the same way in the same place."""
    near = max(abs(a - b) for a, b in zip(one.face, other.face, strict=True)) < max(one.C, other.C) / 2
    return near and sum(a * b for a, b in zip(one.axis, other.axis, strict=True)) > 0
