# SPDX-License-Identifier: LGPL-2.1-or-later
"""Specifications as JSON: checked key by key when read, written with no more than what was asked for."""

from __future__ import annotations

import dataclasses
import functools
import logging
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, key_path, warn_of_unknown_keys
from pipeworkbench.insulation.materials import material, materials, sheet_metal, sheet_metals
from pipeworkbench.insulation.operation import Operation
from pipeworkbench.insulation.rules import Changes, ComponentRule, JacketSpec, LayerSpec, Match
from pipeworkbench.insulation.specification import LEAST_DISTANCE, SCHEMA, Block, Obstacle, Specification
from pipeworkbench.insulation.thickness import RULES, HeatLossRule, LayerThickness, Rule, SurfaceTemperatureRule, TableRule
from pipeworkbench.insulation.treatment import Bends, Flanges, Seams, SheetSize, Treatment
from pipeworkbench.pipeline import NotNegative

CHANGES = ("layers", "jacket", "bare", "seams", "bends", "flanges", "operation")
RULE = ("name", "match", *CHANGES)
TOP = ("schema", "name", "default", "rules", "operation", "sheet_sizes", "minimum_distance", "obstacles", "prices")
PARTS: dict[str, type[Any]] = {"seams": Seams, "bends": Bends, "flanges": Flanges, "operation": Operation}
GEG_RULE = "GEG"  # short for the table of that law
LEAST_RIVET_PITCH = 20.0  # mm; nearer to each other rivets tear the sheet
SOLVED = (HeatLossRule, SurfaceTemperatureRule)

Location = tuple[str | int, ...]
T = TypeVar("T")

_log = logging.getLogger(__name__)


def specification_of(data: Any, source: object) -> Specification:
    """Check the JSON file's structure and return the specification.

    Raises
    ------
    InputError
        With the path of the first key that is wrong.
    """
    if not isinstance(data, dict):
        raise InputError(source, "", "is not a JSON object", f"give a file of schema {SCHEMA}")
    if data.get("schema") != SCHEMA:
        raise InputError(source, "schema", f"is {data.get('schema')!r}", f"give a file of schema {SCHEMA}")
    return _Reader(source).specification(data)


def structure_of(specification: Specification) -> dict[str, Any]:
    """Return a specification as the JSON file's structure."""
    data: dict[str, Any] = {"schema": SCHEMA}
    if specification.name:
        data["name"] = specification.name
    if specification.operation != Operation():
        data["operation"] = _differing(specification.operation, Operation())
    default = Changes.of(specification.default) if isinstance(specification.default, Treatment) else specification.default
    if default is not None:
        data["default"] = _changes(default)
    if specification.rules:
        data["rules"] = [_rule(rule) for rule in specification.rules]
    if specification.sheet_sizes != (SheetSize(),):
        data["sheet_sizes"] = [_plain(size) for size in specification.sheet_sizes]
    if specification.minimum_distance != LEAST_DISTANCE:
        data["minimum_distance"] = specification.minimum_distance
    if specification.obstacles:
        data["obstacles"] = [_plain(obstacle) for obstacle in specification.obstacles]
    if specification.prices:
        data["prices"] = dict(specification.prices)
    return data | dict(specification.extra)


@dataclasses.dataclass(frozen=True)
class _Reader:
    """Reads the parts of one file, which its messages name."""

    source: object

    def specification(self, data: dict[str, Any]) -> Specification:
        """Return the whole specification."""
        extra = self.unknown(data, TOP, ())
        return Specification(
            default=self.changes(data["default"], ("default",), CHANGES) if "default" in data else None,
            rules=tuple(self.each(data, "rules", self.rule)),
            operation=Operation(**self.part(Operation, data.get("operation", {}), ("operation",))),
            sheet_sizes=tuple(self.each(data, "sheet_sizes", functools.partial(self.whole, SheetSize))) or (SheetSize(),),
            minimum_distance=self.value(NotNegative, data.get("minimum_distance", LEAST_DISTANCE), ("minimum_distance",)),
            obstacles=self.obstacles(data),
            prices=self.prices(data.get("prices", {})),
            name=self.value(str, data.get("name", ""), ("name",)),
            source=self.source,
            extra=extra,
        )

    def wrong(self, location: Location, problem: str, remedy: str) -> InputError:
        """Return the error of a key."""
        return InputError(self.source, key_path(location), problem, remedy)

    def value(self, kind: Any, data: Any, location: Location) -> Any:
        """Return a value checked by its type."""
        return check(_adapter(kind), data, self.source, location)

    def unknown(self, data: Mapping[str, Any], known: Iterable[str], location: Location) -> dict[str, Any]:
        """Tell of unknown keys and return them; refuse misspelt ones."""
        known = tuple(known)
        warn_of_unknown_keys(data, known, self.source, key_path(location), _log.warning)
        return {key: value for key, value in data.items() if key not in known}

    def mapping(self, data: Any, location: Location) -> dict[str, Any]:
        """Return a JSON object."""
        if not isinstance(data, dict):
            raise self.wrong(location, "is not a JSON object", "write it in braces, with its keys")
        return data

    def each(self, data: Mapping[str, Any], key: str, read: Callable[[Any, Location], T]) -> list[T]:
        """Read each item of a list that may be missing."""
        items = data.get(key, [])
        if not isinstance(items, list):
            raise self.wrong((key,), "is not a list", "give a JSON array")
        return [read(item, (key, index)) for index, item in enumerate(items)]

    def whole(self, kind: type[Any], data: Any, location: Location) -> Any:
        """Return a dataclass whose fields are the keys."""
        values = self.mapping(data, location)
        names = [f.name for f in dataclasses.fields(kind)]
        self.unknown(values, names, location)
        return self.value(kind, {key: value for key, value in values.items() if key in names}, location)

    def part(self, kind: type[Any], data: Any, location: Location) -> dict[str, Any]:
        """Return the fields of a dataclass that are given, checked."""
        whole = self.whole(kind, data, location)
        return {f.name: getattr(whole, f.name) for f in dataclasses.fields(kind) if f.name in data}

    def rule(self, data: Any, location: Location) -> ComponentRule:
        """Return a rule: its match, its name and what it changes."""
        values = self.mapping(data, location)
        match = self.whole(Match, values.get("match", {}), (*location, "match"))
        name = self.value(str, values.get("name", ""), (*location, "name"))
        return ComponentRule(match=match, changes=self.changes(values, location, RULE), name=name)

    def changes(self, data: Any, location: Location, known: tuple[str, ...]) -> Changes:
        """Return what a rule changes."""
        values = self.mapping(data, location)
        given: dict[str, Any] = {"extra": self.unknown(values, known, location)}
        for key, kind in PARTS.items():
            if key in values:
                given[key] = self.part(kind, values[key], (*location, key))
        pitch = given.get("seams", {}).get("rivet_pitch", 0.0)
        if 0 < pitch < LEAST_RIVET_PITCH:
            raise self.wrong((*location, "seams", "rivet_pitch"), f"is {pitch:g} mm", f"give at least {LEAST_RIVET_PITCH:g}, or 0 for no rivets")
        if "bare" in values:
            given["bare"] = self.value(bool, values["bare"], (*location, "bare"))
        if "layers" in values:
            given["layers"] = self.layers(values["layers"], (*location, "layers"))
        if "jacket" in values:
            given["jacket"] = None if values["jacket"] is None else self.jacket(values["jacket"], (*location, "jacket"))
        return Changes(**given)

    def layers(self, data: Any, location: Location) -> tuple[LayerSpec, ...]:
        """Return layers, of which one at most may follow from the heat flow through all."""
        if not isinstance(data, list) or not data:
            raise self.wrong(location, "is not a list of layers", "give at least one, or 'bare': true for no insulation")
        layers = tuple(self.layer(item, (*location, index)) for index, item in enumerate(data))
        solved = [index for index, layer in enumerate(layers) if isinstance(layer.thickness, SOLVED)]
        if len(solved) > 1:
            raise self.wrong((*location, solved[1], "thickness"), "is the second that follows from the heat flow", "give one of them in mm")
        return layers

    def layer(self, data: Any, location: Location) -> LayerSpec:
        """Return a layer."""
        values = self.mapping(data, location)
        self.unknown(values, ("material", "thickness"), location)
        for key in ("material", "thickness"):
            if key not in values:
                raise self.wrong((*location, key), "is missing", "add this key")
        name = self.value(str, values["material"], (*location, "material"))
        thickness = values["thickness"]
        place = (*location, "thickness")
        return LayerSpec(
            material(name, self.source, key_path((*location, "material"))).name,
            self.thickness_rule(thickness, place) if isinstance(thickness, dict) else self.value(LayerThickness, thickness, place),
        )

    def thickness_rule(self, data: dict[str, Any], location: Location) -> Rule:
        """Return the rule that a thickness follows from."""
        name = data.get("rule")
        kind = TableRule if name == GEG_RULE else RULES.get(name) if isinstance(name, str) else None
        if kind is None:
            raise self.wrong((*location, "rule"), f"is {name!r}", f"use one of {', '.join((GEG_RULE, *RULES))}")
        values = {key: value for key, value in data.items() if key != "rule"}
        if name == TableRule.NAME and "table" not in values:
            raise self.wrong((*location, "table"), "is missing", f"name the table (its column 'standard'), or use the rule {GEG_RULE}")
        found: Rule = self.whole(kind, values, location)
        return found

    def jacket(self, data: Any, location: Location) -> JacketSpec:
        """Return the jacket of a known sheet metal."""
        found: JacketSpec = self.whole(JacketSpec, data, location)
        return dataclasses.replace(found, material=sheet_metal(found.material, self.source, key_path((*location, "material"))).name)

    def obstacles(self, data: Mapping[str, Any]) -> tuple[Obstacle | Block, ...]:
        """Return cylinders and boxes, each with its own id."""

        def read(item: Any, location: Location) -> Obstacle | Block:
            values = self.mapping(item, location)
            found: Obstacle | Block = self.whole(Block if "lower" in values or "upper" in values else Obstacle, values, location)
            return found

        obstacles = tuple(self.each(data, "obstacles", read))
        seen: set[str] = set()
        for index, obstacle in enumerate(obstacles):
            if obstacle.id in seen:
                raise self.wrong(("obstacles", index, "id"), f"'{obstacle.id}' is used twice", "give each obstacle its own id")
            seen.add(obstacle.id)
        return obstacles

    def prices(self, data: Any) -> dict[str, float]:
        """Return the prices by the names of materials."""
        values = self.mapping(data, ("prices",))
        names = [item.name for item in materials()] + [item.name for item in sheet_metals()]
        known = {name.casefold(): name for name in names}
        self.unknown({name: price for name, price in values.items() if name.casefold() not in known}, known.values(), ("prices",))
        return {name: self.value(NotNegative, price, ("prices", name)) for name, price in values.items()}


@functools.cache
def _adapter(kind: Any) -> Any:
    """Return pydantic's checks of a type: making them takes longer than a check."""
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def _rule(rule: ComponentRule) -> dict[str, Any]:
    data: dict[str, Any] = {"name": rule.name} if rule.name else {}
    match = _plain(rule.match)
    return data | ({"match": match} if match else {}) | _changes(rule.changes)


def _changes(changes: Changes) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if changes.bare is not None:
        data["bare"] = changes.bare
    if changes.layers is not None:
        data["layers"] = [{"material": layer.material, "thickness": _thickness(layer.thickness)} for layer in changes.layers]
    if changes.jacket != "unchanged":
        data["jacket"] = None if changes.jacket is None else _plain(changes.jacket)
    for key in PARTS:
        if getattr(changes, key):
            data[key] = dict(getattr(changes, key))
    return data | dict(changes.extra)


def _thickness(thickness: float | Rule) -> Any:
    return thickness if isinstance(thickness, float | int) else {"rule": thickness.NAME} | _plain(thickness)


def _plain(item: Any) -> dict[str, Any]:
    """Return a dataclass as a dictionary of what is known."""

    def known(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        return {key: value for key, value in pairs if value is not None}

    return dataclasses.asdict(item, dict_factory=known)


def _differing(item: Any, default: Any) -> dict[str, Any]:
    return {f.name: getattr(item, f.name) for f in dataclasses.fields(item) if getattr(item, f.name) != getattr(default, f.name)}
