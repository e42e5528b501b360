# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parts of a specification: which components a rule is for, and what it changes about their insulation."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, TypeVar

from annotated_types import Ge, Gt, Le

from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.thickness import DIN_4140, Rule
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, Treatment
from pipeworkbench.pipeline import AnyComponent, NotNegative, Positive

KindName = Literal["pipe", "elbow", "flange", "tee", "reducer", "cap"]
THINNEST_SHEET, THICKEST_SHEET = 0.01, 20.0  # mm; what is beyond is a foil or a plate, or was not given in mm
SAME_DIAMETER = 0.05  # mm; a range's bounds are met by diameters that miss them by rounding

T = TypeVar("T", Seams, Bends, Flanges, Operation)


@dataclass(frozen=True, kw_only=True)
class Match:
    """Which components a rule is for: those of which all that is named here is true.

    ``diameter`` is the least and the greatest outside diameter (mm, both inclusive); ``runs`` are names of `runs_of`.
    """

    ids: tuple[str, ...] | None = None
    runs: tuple[str, ...] | None = None
    kinds: tuple[KindName, ...] | None = None
    stations: tuple[str, ...] | None = None
    dn: tuple[Annotated[int, Gt(0)], ...] | None = None
    diameter: tuple[NotNegative, Positive] | None = None

    def __post_init__(self) -> None:
        if self.diameter is not None and self.diameter[0] > self.diameter[1]:
            raise ValueError(f"the diameters go from {self.diameter[0]:g} to {self.diameter[1]:g}")

    def fits(self, component: AnyComponent, run: str | None) -> bool:
        """Tell whether a component of a run is meant."""
        wanted: tuple[tuple[tuple[Any, ...] | None, Any], ...] = (
            (self.ids, component.id),
            (self.runs, run),
            (self.kinds, component.kind),
            (self.stations, component.station),
            (self.dn, component.dn),
        )
        if any(values is not None and value not in values for values, value in wanted):
            return False
        if self.diameter is None:
            return True
        return self.diameter[0] - SAME_DIAMETER <= component.outer_diameter <= self.diameter[1] + SAME_DIAMETER


@dataclass(frozen=True)
class LayerSpec:
    """A layer: its material, and its thickness (mm) or the rule that it follows from."""

    material: str
    thickness: float | Rule


@dataclass(frozen=True)
class JacketSpec:
    """The jacket's sheet metal and its thickness (mm), or "DIN 4140": by the finished diameter."""

    material: str
    thickness: Annotated[Positive, Ge(THINNEST_SHEET), Le(THICKEST_SHEET)] | Literal["DIN 4140"] = DIN_4140


@dataclass(frozen=True, kw_only=True)
class Changes:
    """What a rule changes; what is None, "unchanged" or not in a mapping stays as it was.

    ``jacket`` None takes the jacket away, ``bare`` True all insulation. ``seams``, ``bends``, ``flanges`` and ``operation`` hold
    only the fields that are changed. ``extra`` are keys of the file that this version does not know.
    """

    layers: tuple[LayerSpec, ...] | None = None
    jacket: JacketSpec | Literal["unchanged"] | None = "unchanged"
    bare: bool | None = None
    seams: Mapping[str, Any] = field(default_factory=dict)
    bends: Mapping[str, Any] = field(default_factory=dict)
    flanges: Mapping[str, Any] = field(default_factory=dict)
    operation: Mapping[str, Any] = field(default_factory=dict)
    extra: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, treatment: Treatment) -> Changes:
        """Return what makes a treatment out of nothing."""
        return cls(
            layers=tuple(LayerSpec(layer.material, layer.thickness) for layer in treatment.layers),
            jacket=None if treatment.jacket is None else JacketSpec(treatment.jacket.material, treatment.jacket.thickness),
            seams=_fields(treatment.seams),
            bends=_fields(treatment.bends),
            flanges=_fields(treatment.flanges),
        )


@dataclass(frozen=True, kw_only=True)
class ComponentRule:
    """Changes to the components that match; ``name`` is for people."""

    match: Match = field(default_factory=Match)
    changes: Changes = field(default_factory=Changes)
    name: str = ""


@dataclass(frozen=True)
class Wanted:
    """What holds for one component after all rules, before thicknesses are worked out."""

    layers: tuple[LayerSpec, ...] | None
    jacket: JacketSpec | None
    bare: bool = False
    seams: Seams = field(default_factory=Seams)
    bends: Bends = field(default_factory=Bends)
    flanges: Flanges = field(default_factory=Flanges)
    operation: Operation = field(default_factory=Operation)

    def changed(self, changes: Changes) -> Wanted:
        """Return it with what a rule changes."""
        return Wanted(
            self.layers if changes.layers is None else changes.layers,
            self.jacket if changes.jacket == "unchanged" else changes.jacket,
            self.bare if changes.bare is None else changes.bare,
            _replaced(self.seams, changes.seams),
            _replaced(self.bends, changes.bends),
            _replaced(self.flanges, changes.flanges),
            _replaced(self.operation, changes.operation),
        )


def _replaced(item: T, changes: Mapping[str, Any]) -> T:
    return dataclasses.replace(item, **changes) if changes else item


def _fields(item: Seams | Bends | Flanges) -> dict[str, Any]:
    return {f.name: getattr(item, f.name) for f in dataclasses.fields(item)}
