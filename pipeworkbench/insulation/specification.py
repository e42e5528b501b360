# SPDX-License-Identifier: LGPL-2.1-or-later
"""The specification of insulation: what goes around which component, in which service it is, what is in the way.

The file format is ``pipeworkbench-insulation/1``; ``docs/insulation.md`` lists its keys.
"""

from __future__ import annotations

import dataclasses
import difflib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.files import MISSPELLING_SIMILARITY, check, read_json, written_whole
from pipeworkbench.insulation.heat_loss import BARE_EMISSIVITY, Layers
from pipeworkbench.insulation.materials import DEFAULT_MATERIAL, DEFAULT_SHEET, sheet_metal
from pipeworkbench.insulation.materials import material as material_named
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.rules import Changes, ComponentRule, JacketSpec, LayerSpec, Wanted
from pipeworkbench.insulation.thickness import DIN_4140, LEAST_LAYER, THICKEST, UNVERIFIED, Situation, jacket_thickness, thickness_by
from pipeworkbench.insulation.treatment import Seams, SheetSize, Treatment
from pipeworkbench.pipeline import AnyComponent, Elbow, Flange, Positive, Vector
from pipeworkbench.solids.coverings import Layer, Sheet

SCHEMA = "pipeworkbench-insulation/1"
LEAST_DISTANCE = 100.0  # mm between finished surfaces; DIN 4140, not verified: standards/insulation_distances_din4140.csv
MOST_TOLD = 5  # unknown names of one rule
FARTHEST = 1e10  # mm from the origin; plants have coordinates up to some thousand kilometres
UPRIGHT = math.sin(math.radians(45))  # of an axis' slope from which on it counts as vertical
DEFAULT_JACKET = JacketSpec(DEFAULT_SHEET)


def _check_obstacle(name: str, lengths: Iterable[float]) -> None:
    if not name:
        raise ValueError("the id is empty")
    if max(map(abs, lengths)) > FARTHEST:
        raise ValueError(f"a length is more than {FARTHEST:g} mm")


@dataclass(frozen=True, kw_only=True)
class Obstacle:
    """A cylinder that insulation must not run into (a bracket, a column): the ends of its axis and its diameter in the pipeline's frame, mm."""

    id: str
    start: Vector
    end: Vector
    diameter: Positive

    def __post_init__(self) -> None:
        _check_obstacle(self.id, (*self.start, *self.end, self.diameter))
        if math.dist(self.start, self.end) == 0:
            raise ValueError("start and end are the same point")


@dataclass(frozen=True, kw_only=True)
class Block:
    """A box along the pipeline's axes that insulation must not run into (a wall, a beam): two opposite corners, mm."""

    id: str
    lower: Vector
    upper: Vector

    def __post_init__(self) -> None:
        _check_obstacle(self.id, (*self.lower, *self.upper))
        if any(a >= b for a, b in zip(self.lower, self.upper, strict=True)):
            raise ValueError("lower is not less than upper in all of x, y and z")


@dataclass(frozen=True, kw_only=True)
class Specification:
    """What is asked of the insulation of a pipeline.

    ``default`` holds for all components, then each of ``rules`` that matches changes what it names, so that later ones win.
    ``operation`` is the service of what no rule gives another. ``prices`` are per m3 of an insulation material and per m2 of sheet
    metal, by name. ``extra`` are the file's keys that this version does not know.
    """

    default: Changes | Treatment | None = None
    rules: tuple[ComponentRule, ...] = ()
    operation: Operation = field(default_factory=Operation)
    sheet_sizes: tuple[SheetSize, ...] = (SheetSize(),)
    minimum_distance: float = LEAST_DISTANCE
    obstacles: tuple[Obstacle | Block, ...] = ()
    prices: Mapping[str, float] = field(default_factory=dict)
    name: str = ""
    source: object = field(default="specification", compare=False)
    extra: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def uniform(cls, thickness: float, material: str = DEFAULT_MATERIAL, jacket: Sheet | str | None = DEFAULT_SHEET) -> Specification:
        """Return one layer around everything.

        Parameters
        ----------
        thickness : float
            In mm.
        material : str, optional
            Of the layer.
        jacket : Sheet, str or None, optional
            None leaves the jacket away; of a sheet metal that is only named it is as thick as DIN 4140 asks for.

        Raises
        ------
        InputError
            Where the thickness is less than 1 mm or more than 1 m, or no material is called so.
        """
        if not LEAST_LAYER <= thickness <= THICKEST:
            raise InputError("insulation", "thickness", f"is {thickness:g} mm", f"give a positive thickness of {LEAST_LAYER:g} to {THICKEST:g} mm")
        name = material_named(material, "insulation", "material").name
        if jacket is None:
            sheet = None
        elif isinstance(jacket, Sheet):
            sheet = JacketSpec(jacket.material, jacket.thickness)
        else:
            sheet = JacketSpec(sheet_metal(jacket, "insulation", "jacket").name)
        return cls(default=Changes(layers=(LayerSpec(name, float(thickness)),), jacket=sheet))

    @classmethod
    def read(cls, path: Path) -> Specification:
        """Read a JSON file; raise InputError with the path of the key that is wrong."""
        return cls.from_dict(read_json(path, keys_once=True), source=path)

    @classmethod
    def from_dict(cls, data: Any, source: object = "specification") -> Specification:
        """Check the JSON file's structure and return it as a Specification."""
        from pipeworkbench.insulation.specification_file import specification_of

        return specification_of(data, source)

    def to_dict(self) -> dict[str, Any]:
        """Return the specification as the JSON file's structure."""
        from pipeworkbench.insulation.specification_file import structure_of

        return structure_of(self)

    def write(self, path: Path) -> None:
        """Write the JSON file, whole or not at all."""
        with written_whole(path) as temporary:
            temporary.write_text(json.dumps(self.to_dict(), indent=1, allow_nan=False, ensure_ascii=False) + "\n", encoding="utf-8")

    def with_operation(self, known: Mapping[str, Any], source: object = "operation") -> Specification:
        """Return the specification with some of its operation's values replaced; rules that say something of the operation stay.

        Raises
        ------
        InputError
            Where a value does not fit, with ``source`` and the value's name.
        """
        from pydantic import TypeAdapter

        return dataclasses.replace(self, operation=check(TypeAdapter(Operation), dataclasses.asdict(self.operation) | dict(known), source))

    def treatment_of(self, component: AnyComponent, run: str | None = None) -> Treatment | None:
        """Return how a component is insulated, None where it stays bare.

        Parameters
        ----------
        component : Component
        run : str, optional
            The name of its run (`runs_of`), for rules that name runs.

        Raises
        ------
        InputError
            Where a thickness follows from a rule and the rule has no answer; names the component.
        """
        wanted = self._wanted(component, run)
        if wanted.bare or not wanted.layers:
            return None
        layers, remarks = _thick(wanted, component)
        sheet, told = _sheet(wanted, component, sum(layer.thickness for layer in layers))
        given = self.default.remarks if isinstance(self.default, Treatment) else ()
        remarks = (*given, *remarks, *told, *_doubts(layers, wanted.operation, component.id))
        return Treatment(layers, sheet, wanted.seams, wanted.bends, wanted.flanges, tuple(dict.fromkeys(remarks)))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be told of figures that hold for all components and that nobody named."""
        if self.minimum_distance != LEAST_DISTANCE:
            return ()
        seams = Seams()
        overlaps = f"overlaps {seams.longitudinal_overlap:g} and {seams.circumferential_overlap:g} mm"
        return (f"minimum distance {LEAST_DISTANCE:g} mm, {overlaps}: after {DIN_4140} ({UNVERIFIED})",)

    def operation_of(self, component: AnyComponent, run: str | None = None) -> Operation:
        """Return in what service a component is."""
        return self._wanted(component, run).operation

    def unused(self, components: Sequence[AnyComponent], runs: Mapping[str, str]) -> tuple[str, ...]:
        """Return what is to be told of rules that are for none of a pipeline's components, and of names in them that none has.

        Parameters
        ----------
        components : sequence of Component
        runs : mapping
            The names of their runs (`runs_of`) by their ids.
        """
        known = {
            "ids": {component.id for component in components},
            "runs": set(runs.values()),
            "stations": {component.station for component in components if component.station is not None},
        }
        told = []
        for index, rule in enumerate(self.rules):
            name = f"rules[{index}]" + (f" '{rule.name}'" if rule.name else "")
            for key, names in known.items():
                missing = [one for one in getattr(rule.match, key) or () if one not in names]
                told += [f"{name}: match.{key}: there is no '{one}'{_alike(one, names)}" for one in missing[:MOST_TOLD]]
                told += [f"{name}: match.{key}: nor are there {len(missing) - MOST_TOLD} more"] if len(missing) > MOST_TOLD else []
            if not any(rule.match.fits(component, runs[component.id]) for component in components):
                told.append(f"{name}: is for none of the components")
        return tuple(told)

    def _wanted(self, component: AnyComponent, run: str | None) -> Wanted:
        wanted = Wanted(None, DEFAULT_JACKET, operation=self.operation)
        if self.default is not None:
            wanted = wanted.changed(Changes.of(self.default) if isinstance(self.default, Treatment) else self.default)
        for rule in self.rules:
            if rule.match.fits(component, run):
                wanted = wanted.changed(rule.changes)
        return wanted


def _alike(name: str, names: Iterable[str]) -> str:
    close = difflib.get_close_matches(name, sorted(names), 1, MISSPELLING_SIMILARITY)
    return f"; did you mean '{close[0]}'?" if close else ""


def is_vertical(component: AnyComponent) -> bool:
    """Tell whether a component's axis stands (is 45 degrees or more steep) rather than lies; the frame's z is up, elbows lie."""
    return not isinstance(component, Elbow) and abs(component.ports[0].direction[2]) >= UPRIGHT


def finished_diameter(component: AnyComponent, treatment_thickness: float, clearance: float = 0.0) -> float:
    """Return the outer diameter (mm) of a component's insulation; of a flange that of its box."""
    inner = component.D + 2 * clearance if isinstance(component, Flange) else component.outer_diameter
    return inner + 2 * treatment_thickness


def layers_of(layers: Iterable[Layer]) -> Layers:
    """Return layers with their materials' figures, as the heat loss needs them."""
    return tuple((material_named(layer.material), layer.thickness) for layer in layers)


def outer_emissivity(sheet: str | None) -> float:
    """Return the emissivity of a jacket of a sheet metal; without one that of bare insulation, as dull as black steel."""
    return BARE_EMISSIVITY if sheet is None else sheet_metal(sheet).emissivity


def _thick(wanted: Wanted, component: AnyComponent) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    """Return a component's layers with their thicknesses, and what is to be told of these."""
    specs = wanted.layers or ()
    fixed = [Layer(spec.material, spec.thickness) for spec in specs if isinstance(spec.thickness, float | int)]
    layers: list[Layer] = []
    remarks: tuple[str, ...] = ()
    for spec in specs:
        if isinstance(spec.thickness, float | int):
            layers.append(fixed.pop(0))
            continue
        # of the layers outside, those whose thickness is known by now count
        found = thickness_by(spec.thickness, _situation(spec.material, component, wanted, layers, fixed))
        layers.append(Layer(spec.material, found.value))
        remarks += found.remarks
    return tuple(layers), remarks


def _situation(name: str, component: AnyComponent, wanted: Wanted, inside: Sequence[Layer], outside: Sequence[Layer]) -> Situation:
    return Situation(
        name=component.id,
        outer_diameter=component.outer_diameter,
        material=material_named(name, component.id, "material"),
        wall_thickness=component.wall_thickness,
        inside=layers_of(inside),
        outside=layers_of(outside),
        operation=wanted.operation,
        emissivity=outer_emissivity(wanted.jacket.material if wanted.jacket else None),
        vertical=is_vertical(component),
    )


def _sheet(wanted: Wanted, component: AnyComponent, thickness: float) -> tuple[Sheet | None, tuple[str, ...]]:
    if wanted.jacket is None:
        return None, ()
    if wanted.jacket.thickness != DIN_4140:
        return Sheet(wanted.jacket.material, float(wanted.jacket.thickness)), ()
    diameter = finished_diameter(component, thickness, wanted.flanges.clearance)
    found = jacket_thickness(wanted.jacket.material, diameter, component.id, "jacket")
    return Sheet(wanted.jacket.material, found.value), found.remarks


def _doubts(layers: tuple[Layer, ...], operation: Operation, name: str) -> tuple[str, ...]:
    """Return what is to be told of the materials: no source, or too hot a medium."""
    remarks = []
    for layer in layers:
        own = material_named(layer.material, name, "material")
        if not own.verified:
            remarks.append(f"conductivity of {own.name}: general knowledge, no source")
        medium = operation.medium_temperature
        if medium is not None and own.highest_temperature is not None and medium > own.highest_temperature and layer == layers[0]:
            remarks.append(f"the medium ({medium:g} deg C) is hotter than {own.name} may get ({own.highest_temperature:g} deg C)")
    return tuple(remarks)
