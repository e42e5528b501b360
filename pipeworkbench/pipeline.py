# SPDX-License-Identifier: LGPL-2.1-or-later
"""The domain: pipes, elbows, flanges and the joints between them, and their JSON file.

Lengths are millimetres in the frame the pipeline names. Frozen dataclasses; the file format is
``pipeworkbench-pipeline/1`` and keys that this version does not know survive a round trip.
"""

from __future__ import annotations

import dataclasses
import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Predicate

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, key_path, read_json, written_whole

SCHEMA = "pipeworkbench-pipeline/1"

Finite = Annotated[float, Predicate(math.isfinite)]
Positive = Annotated[float, Gt(0), Predicate(math.isfinite)]
NotNegative = Annotated[float, Ge(0), Predicate(math.isfinite)]
Vector = tuple[Finite, Finite, Finite]
Matrix = tuple[tuple[Finite, Finite, Finite, Finite], ...]


@dataclass(frozen=True, kw_only=True)
class Component:
    """What every component has: identity, standard, and how well it is known.

    ``quality`` is Eq. 4's q in pixels; ``sigma_position`` the standard deviations of the component's
    middle in mm along the frame's axes; ``verified`` the weakest source grade of its standard
    dimensions (2 two independent sources or more, 1 one, 0 none).
    """

    kind: ClassVar[str] = ""

    id: str
    outer_diameter: Positive
    dn: Annotated[int, Gt(0)] | None = None
    standard: str | None = None
    pick: Annotated[int, Ge(0)] | None = None
    station: str | None = None
    quality: NotNegative | None = None
    sigma_position: tuple[NotNegative, NotNegative, NotNegative] | None = None
    sigma_direction_deg: NotNegative | None = None
    loa: str | None = None
    fixed: bool = False
    verified: Literal[0, 1, 2] | None = None
    extra: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Pipe(Component):
    """A straight pipe from ``start`` to ``end`` (mm); hollow where the wall thickness is known."""

    kind: ClassVar[str] = "pipe"

    start: Vector
    end: Vector
    wall_thickness: Positive | None = None
    sigma_outer_diameter: NotNegative | None = None
    approximate: bool = False

    def __post_init__(self) -> None:
        if math.dist(self.start, self.end) == 0:
            raise ValueError("start and end are the same point")
        if self.wall_thickness is not None and 2 * self.wall_thickness >= self.outer_diameter:
            raise ValueError("the wall is thicker than the radius")

    @property
    def length(self) -> float:
        """Distance from start to end in mm."""
        return math.dist(self.start, self.end)


@dataclass(frozen=True, kw_only=True)
class Elbow(Component):
    """A bend between two straight axes that meet in ``intersection`` (mm)."""

    kind: ClassVar[str] = "elbow"

    start: Vector
    end: Vector
    intersection: Vector
    angle_deg: Positive
    bend_radius: Positive
    bend_type: Literal["2D", "3D", "5D"] | None = None


@dataclass(frozen=True, kw_only=True)
class Flange(Component):
    """A flange; ``axis`` points out of the sealing face, whose centre is ``face`` (mm).

    ``D`` and ``C`` are the plate's diameter and thickness, ``length`` reaches from the face to the weld end;
    ``neck_diameter`` is the neck's where it leaves the plate, the pipe's where it is not known.
    """

    kind: ClassVar[str] = "flange"

    face: Vector
    axis: Vector
    flange_type: str
    pn: Positive
    D: Positive
    C: Positive
    length: Positive
    neck_diameter: Positive | None = None
    equivalents: tuple[dict[str, Any], ...] = ()


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Port ``a_port`` of component ``a`` meets port ``b_port`` of component ``b``."""

    a: str
    a_port: Literal[0, 1]
    b: str
    b_port: Literal[0, 1]
    extra: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class StationPose:
    """Where a station's level frame lies in the pipeline's frame (4 x 4)."""

    frame_from_level: Matrix
    extra: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if len(self.frame_from_level) != 4:
            raise ValueError("frame_from_level must have 4 rows")


AnyComponent = Pipe | Elbow | Flange
_KINDS: dict[str, type[AnyComponent]] = {kind.kind: kind for kind in (Pipe, Elbow, Flange)}
_PIPELINE_KEYS = {"schema", "length_unit", "frame", "components", "joints", "stations", "sigma0"}
_IDENTITY: Matrix = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class Pipeline:
    """Components and joints in one frame, named after the station that defines it."""

    frame: str
    components: tuple[AnyComponent, ...] = ()
    joints: tuple[Joint, ...] = ()
    stations: dict[str, StationPose] = field(default_factory=dict)
    sigma0: float | None = None
    extra: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def of_station(cls, name: str, components: tuple[AnyComponent, ...]) -> Pipeline:
        """Return the components of one station in that station's level frame."""
        return cls(frame=name, components=components, stations={name: StationPose(frame_from_level=_IDENTITY)})

    @property
    def pipes(self) -> tuple[Pipe, ...]:
        """The straight pipes among the components."""
        return tuple(c for c in self.components if isinstance(c, Pipe))

    def to_dict(self) -> dict[str, Any]:
        """Return the pipeline as the JSON file's structure."""
        data: dict[str, Any] = {
            "schema": SCHEMA,
            "length_unit": "mm",
            "frame": self.frame,
            "components": [{"kind": c.kind} | _fields(c) for c in self.components],
            "joints": [_fields(j) for j in self.joints],
            "stations": {name: _fields(pose) for name, pose in self.stations.items()},
            "sigma0": self.sigma0,
        }
        return data | self.extra

    def write(self, path: Path) -> None:
        """Write the JSON file, whole or not at all."""
        with written_whole(path) as temporary:
            temporary.write_text(json.dumps(self.to_dict(), indent=1, allow_nan=False) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> Pipeline:
        """Read a JSON file; raise InputError with the path of the key that is wrong."""
        return cls.from_dict(read_json(path), source=path)

    @classmethod
    def from_dict(cls, data: Any, source: object = "pipeline") -> Pipeline:
        """Check the JSON file's structure and return it as a Pipeline."""
        if not isinstance(data, dict):
            raise InputError(source, "", "is not a JSON object", f"give a file of schema {SCHEMA}")
        if data.get("schema") != SCHEMA:
            raise InputError(source, "schema", f"is {data.get('schema')!r}", f"give a file of schema {SCHEMA}")
        if data.get("length_unit", "mm") != "mm":
            raise InputError(source, "length_unit", f"is {data['length_unit']!r}", "give lengths in mm")
        components = tuple(
            _from_dict(_kind_of(item, source, index), item, source, ("components", index))
            for index, item in enumerate(_list(data, "components", source))
        )
        _refuse_repeated_ids(components, source)
        joints = tuple(_from_dict(Joint, item, source, ("joints", i)) for i, item in enumerate(_list(data, "joints", source)))
        _refuse_dangling_joints(components, joints, source)
        stations = data.get("stations", {})
        if not isinstance(stations, dict):
            raise InputError(source, "stations", "is not a JSON object", "map each station's name to its pose")
        rest = {"frame": data.get("frame"), "sigma0": data.get("sigma0")}
        if not isinstance(rest["frame"], str):
            raise InputError(source, "frame", "is missing or not a text", "name the station whose level frame is used")
        if rest["sigma0"] is not None and not (isinstance(rest["sigma0"], int | float) and math.isfinite(rest["sigma0"])):
            raise InputError(source, "sigma0", f"is {rest['sigma0']!r}", "give a finite number or null")
        return cls(
            frame=rest["frame"],
            components=components,
            joints=joints,
            stations={name: _from_dict(StationPose, pose, source, ("stations", name)) for name, pose in stations.items()},
            sigma0=rest["sigma0"],
            extra={k: v for k, v in data.items() if k not in _PIPELINE_KEYS},
        )


def _fields(item: Any) -> dict[str, Any]:
    """Return a dataclass as a dictionary without what is not known and with the unknown keys in place."""
    data = {f.name: getattr(item, f.name) for f in dataclasses.fields(item) if f.name != "extra"}
    return {k: v for k, v in data.items() if v is not None and v is not False} | item.extra


def _list(data: dict[str, Any], key: str, source: object) -> list[Any]:
    items = data.get(key, [])
    if not isinstance(items, list):
        raise InputError(source, key, "is not a list", "give a JSON array")
    return items


def _kind_of(item: Any, source: object, index: int) -> type[AnyComponent]:
    kind = item.get("kind") if isinstance(item, dict) else None
    if not isinstance(kind, str) or kind not in _KINDS:
        raise InputError(source, f"components[{index}].kind", f"is {kind!r}", f"use one of {', '.join(_KINDS)}")
    return _KINDS[kind]


def _from_dict(kind: type[Any], item: Any, source: object, location: tuple[str | int, ...]) -> Any:
    if not isinstance(item, dict):
        raise InputError(source, key_path(location), "is not a JSON object", "correct this value")
    from pydantic import TypeAdapter

    names = {f.name for f in dataclasses.fields(kind)} - {"extra"}
    known = {k: v for k, v in item.items() if k in names}
    made = check(TypeAdapter(kind), known, source, location)
    if issubclass(kind, Component):
        names.add("kind")
    return dataclasses.replace(made, extra={k: v for k, v in item.items() if k not in names})


def _refuse_repeated_ids(components: tuple[AnyComponent, ...], source: object) -> None:
    seen: set[str] = set()
    for index, component in enumerate(components):
        if component.id in seen:
            raise InputError(source, f"components[{index}].id", f"'{component.id}' is used twice", "give each component its own id")
        seen.add(component.id)


def _refuse_dangling_joints(components: tuple[AnyComponent, ...], joints: tuple[Joint, ...], source: object) -> None:
    ids = {component.id for component in components}
    for index, joint in enumerate(joints):
        for key in ("a", "b"):
            if getattr(joint, key) not in ids:
                raise InputError(source, f"joints[{index}].{key}", f"no component '{getattr(joint, key)}'", "name an existing component")
