# SPDX-License-Identifier: LGPL-2.1-or-later
"""The domain: pipes, elbows, flanges, tees, reducers, caps and the joints between them, and their JSON file.

Lengths are millimetres in the frame the pipeline names. Frozen dataclasses; the file format is
``pipeworkbench-pipeline/1`` and keys that this version does not know survive a round trip.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import json
import math
from collections.abc import Container
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Predicate

from pipeworkbench.errors import InputError
from pipeworkbench.files import check, key_path, read_json, written_whole

SCHEMA = "pipeworkbench-pipeline/1"
BLIND_FLANGE = "05"  # of EN 1092-1
SHORTEST_GAP = 1.0  # mm; less is no gap
HUBBED_FLANGES = ("12", "13")  # of EN 1092-1: a short hub around the pipe instead of a cone that tapers to it

Finite = Annotated[float, Predicate(math.isfinite)]
Positive = Annotated[float, Gt(0), Predicate(math.isfinite)]
NotNegative = Annotated[float, Ge(0), Predicate(math.isfinite)]
Vector = tuple[Finite, Finite, Finite]
Matrix = tuple[tuple[Finite, Finite, Finite, Finite], ...]


@dataclass(frozen=True)
class Port:
    """Where another component can be joined: the centre (mm), the unit direction out of the component and the outside diameter (mm)."""

    point: Vector
    direction: Vector
    diameter: float


@dataclass(frozen=True, kw_only=True)
class Component:
    """What every component has: identity, standard, and how well it is known.

    ``quality`` is Eq. 4's q in pixels; ``sigma_position`` the standard deviations of the component's
    middle in mm along the frame's axes; ``verified`` the weakest source grade of its standard
    dimensions (2 two independent sources or more, 1 one, 0 none). It is hollow where its ``wall_thickness`` (mm) is known.
    """

    kind: ClassVar[str] = ""

    id: str
    outer_diameter: Positive
    wall_thickness: Positive | None = None
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

    def __post_init__(self) -> None:
        if self.wall_thickness is not None and 2 * self.wall_thickness >= self.narrowest_diameter:
            raise ValueError("the wall is thicker than the radius")

    @property
    def narrowest_diameter(self) -> float:
        """The smallest outside diameter (mm) that the wall must fit into."""
        return self.outer_diameter

    @property
    def ports(self) -> tuple[Port, ...]:
        """The component's ends in the order of a joint's port numbers."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class Pipe(Component):
    """A straight pipe from ``start`` to ``end`` (mm).

    ``gaps`` are the parts, in mm from ``start``, where no image shows both edges and the pipe was bridged;
    ``nearest_standard`` names the standard size within three ``sigma_outer_diameter`` of a free diameter.
    """

    kind: ClassVar[str] = "pipe"

    start: Vector
    end: Vector
    sigma_outer_diameter: NotNegative | None = None
    approximate: bool = False
    gaps: tuple[tuple[NotNegative, NotNegative], ...] | None = None
    nearest_standard: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if math.dist(self.start, self.end) == 0:
            raise ValueError("start and end are the same point")
        if any(start >= end for start, end in self.gaps or ()):
            raise ValueError("a gap ends before it starts")

    def with_ends(self, start: Vector, end: Vector) -> Pipe:
        """Return the pipe between other ends (mm) near its axis; of its gaps what lies between them stays."""
        length = math.dist(start, end)
        shift = sum((a - b) * (c - b) for a, b, c in zip(start, self.start, self.end, strict=True)) / self.length
        moved = ((max(first - shift, 0.0), min(last - shift, length)) for first, last in self.gaps or ())
        gaps = tuple((round(first, 1), round(last, 1)) for first, last in moved if last - first >= SHORTEST_GAP)
        return dataclasses.replace(self, start=start, end=end, gaps=gaps or None)

    @property
    def length(self) -> float:
        """Distance from start to end in mm."""
        return math.dist(self.start, self.end)

    @property
    def ports(self) -> tuple[Port, ...]:
        """Start and end."""
        return _port(self.end, self.start, self.outer_diameter), _port(self.start, self.end, self.outer_diameter)


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

    @property
    def length(self) -> float:
        """Length of the bent axis in mm."""
        return math.radians(self.angle_deg) * self.bend_radius

    @property
    def ports(self) -> tuple[Port, ...]:
        """Start and end."""
        return _port(self.intersection, self.start, self.outer_diameter), _port(self.intersection, self.end, self.outer_diameter)


@dataclass(frozen=True, kw_only=True)
class Flange(Component):
    """A flange; ``axis`` points out of the sealing face, whose centre is ``face`` (mm).

    ``D`` and ``C`` are the plate's diameter and thickness, ``length`` reaches from the face to the weld end;
    ``neck_diameter`` is the neck's where it leaves the plate, the pipe's where it is not known; ``neck_straight``
    the length of the neck's straight part at the weld end. ``K`` is the diameter of the bolt circle, ``L`` of a bolt
    hole, ``bolts`` their number. The raised face is a part of ``C``. Letters are those of EN 1092-1, lengths mm.
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
    neck_straight: NotNegative | None = None
    K: Positive | None = None
    L: Positive | None = None
    bolts: Annotated[int, Gt(0)] | None = None
    raised_face_diameter: Positive | None = None
    raised_face_height: NotNegative | None = None
    equivalents: tuple[dict[str, Any], ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.K is not None and self.K + (self.L or 0) >= self.D:
            raise ValueError("the bolt holes reach over the plate's rim (K + L is not smaller than D)")
        if self.raised_face_diameter is not None and self.raised_face_diameter > self.D:
            raise ValueError("the raised face is wider than the plate")
        if self.raised_face_height is not None and self.raised_face_height >= self.C:
            raise ValueError("the raised face is as high as the plate is thick")

    @property
    def ports(self) -> tuple[Port, ...]:
        """The sealing face and the weld end, which a blind flange has not."""
        face = Port(self.face, self.axis, self.D)
        if self.flange_type == BLIND_FLANGE:
            return (face,)
        a, b, c = self.axis
        x, y, z = self.face
        weld_end = (x - self.length * a, y - self.length * b, z - self.length * c)
        return face, Port(weld_end, (-a, -b, -c), self.outer_diameter)


@dataclass(frozen=True, kw_only=True)
class Tee(Component):
    """A branch on a run: the run's axis from ``start`` to ``end``, the branch's from ``intersection`` on it to ``branch_end`` (mm).

    ``outer_diameter`` is the run's. ``tee_type`` is "tee" for a fitting of EN 10253 and "set-on" where the branch
    is welded onto a pipe that runs through; then start and end are where the seam's influence ends.
    """

    kind: ClassVar[str] = "tee"

    start: Vector
    end: Vector
    intersection: Vector
    branch_end: Vector
    branch_diameter: Positive
    tee_type: Literal["tee", "set-on"] = "tee"

    @property
    def length(self) -> float:
        """Length of the run in mm."""
        return math.dist(self.start, self.end)

    @property
    def narrowest_diameter(self) -> float:
        """The smaller of run and branch (mm)."""
        return min(self.outer_diameter, self.branch_diameter)

    @property
    def ports(self) -> tuple[Port, ...]:
        """Start and end of the run, end of the branch."""
        return (
            _port(self.end, self.start, self.outer_diameter),
            _port(self.start, self.end, self.outer_diameter),
            _port(self.intersection, self.branch_end, self.branch_diameter),
        )


@dataclass(frozen=True, kw_only=True)
class Reducer(Component):
    """A cone between pipes of two diameters: ``outer_diameter`` at ``start``, ``end_diameter``, the smaller, at ``end`` (mm).

    ``axis`` is the unit direction of both pipes, from start to end; an eccentric reducer's ends are offset from each other across it.
    """

    kind: ClassVar[str] = "reducer"

    start: Vector
    end: Vector
    axis: Vector
    end_diameter: Positive
    reducer_type: Literal["concentric", "eccentric"] = "concentric"

    @property
    def length(self) -> float:
        """Distance of both ends along the axis in mm."""
        return sum((b - a) * c for a, b, c in zip(self.start, self.end, self.axis, strict=True))

    @property
    def narrowest_diameter(self) -> float:
        """The smaller end's (mm)."""
        return min(self.outer_diameter, self.end_diameter)

    @property
    def ports(self) -> tuple[Port, ...]:
        """The wide end and the narrow end."""
        a, b, c = self.axis
        return Port(self.start, (-a, -b, -c), self.outer_diameter), Port(self.end, self.axis, self.end_diameter)


@dataclass(frozen=True, kw_only=True)
class Cap(Component):
    """A dished cap on a pipe's end: the weld end's centre ``start``, the unit direction ``axis`` out of the pipe, the ``length`` (mm)."""

    kind: ClassVar[str] = "cap"

    start: Vector
    axis: Vector
    length: Positive

    @property
    def ports(self) -> tuple[Port, ...]:
        """The weld end."""
        a, b, c = self.axis
        return (Port(self.start, (-a, -b, -c), self.outer_diameter),)


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Port ``a_port`` of component ``a`` meets port ``b_port`` of component ``b``; 2 is a tee's branch."""

    a: str
    a_port: Literal[0, 1, 2]
    b: str
    b_port: Literal[0, 1, 2]
    extra: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class StationPose:
    """Where a station's level frame lies in the pipeline's frame (4 x 4)."""

    frame_from_level: Matrix
    extra: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if len(self.frame_from_level) != 4:
            raise ValueError("frame_from_level must have 4 rows")


AnyComponent = Pipe | Elbow | Flange | Tee | Reducer | Cap
_KINDS: dict[str, type[AnyComponent]] = {kind.kind: kind for kind in (Pipe, Elbow, Flange, Tee, Reducer, Cap)}
# fields of components that move with them
POINTS = frozenset({"start", "end", "intersection", "branch_end", "face"})
DIRECTIONS = frozenset({"axis"})
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


def moved(component: AnyComponent, b_from_a: Matrix) -> AnyComponent:
    """Return a component of frame a in frame b, for the 4 x 4 motion from a to b; its sigmas stay along the axes of a."""

    def turned(vector: Vector, shift: int) -> Vector:
        x, y, z = (sum(row[k] * vector[k] for k in range(3)) + shift * row[3] for row in b_from_a[:3])
        return x, y, z

    names = {f.name for f in dataclasses.fields(component)}
    changes: dict[str, Any] = {name: turned(getattr(component, name), 1) for name in POINTS & names}
    changes |= {name: turned(getattr(component, name), 0) for name in DIRECTIONS & names}
    return dataclasses.replace(component, **changes)


def free_id(name: str, used: Container[str]) -> str:
    """Return an id that is not used: the wished one, or that with the first number from 2 on that is free."""
    return next(new for new in itertools.chain([name], (f"{name}.{number}" for number in itertools.count(2))) if new not in used)


def _port(inside: Vector, point: Vector, diameter: float) -> Port:
    """Return the port at ``point`` that looks away from another point of the component's axis."""
    length = math.dist(inside, point) or math.nan
    a, b, c = ((q - p) / length for p, q in zip(inside, point, strict=True))
    return Port(point, (a, b, c), diameter)


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
    names = {f.name for f in dataclasses.fields(kind)} - {"extra"}
    known = {k: v for k, v in item.items() if k in names}
    made = check(_adapter(kind), known, source, location)  # type: ignore[arg-type]  # classes are hashable
    if issubclass(kind, Component):
        names.add("kind")
    return dataclasses.replace(made, extra={k: v for k, v in item.items() if k not in names})


@functools.cache
def _adapter(kind: type[Any]) -> Any:
    """Return pydantic's checks of a dataclass: making them takes longer than a check."""
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def _refuse_repeated_ids(components: tuple[AnyComponent, ...], source: object) -> None:
    seen: set[str] = set()
    for index, component in enumerate(components):
        if component.id in seen:
            raise InputError(source, f"components[{index}].id", f"'{component.id}' is used twice", "give each component its own id")
        seen.add(component.id)


def _refuse_dangling_joints(components: tuple[AnyComponent, ...], joints: tuple[Joint, ...], source: object) -> None:
    ports = {component.id: len(component.ports) for component in components}
    for index, joint in enumerate(joints):
        for key, port_key in (("a", "a_port"), ("b", "b_port")):
            name, port = getattr(joint, key), getattr(joint, port_key)
            if name not in ports:
                raise InputError(source, f"joints[{index}].{key}", f"no component '{name}'", "name an existing component")
            if port >= ports[name]:
                raise InputError(source, f"joints[{index}].{port_key}", f"'{name}' has no port {port}", f"use 0 to {ports[name] - 1}")
