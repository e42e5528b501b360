# SPDX-License-Identifier: LGPL-2.1-or-later
"""One IFC file in the making: its header, owner history, GlobalIds and the small entities that many others share."""

from __future__ import annotations

import datetime as dt
import hashlib
import math
import uuid
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pipeworkbench import __version__
from pipeworkbench.errors import InputError, MissingPackageError

if TYPE_CHECKING:
    import ifcopenshell

NAMESPACE = uuid.UUID("7a1f4d55-3c5e-4f0b-9b55-0d6c8ac1e2f4")  # of this program's GlobalIds
APPLICATION, COMPANY, IDENTIFIER = "Pipe Workbench", "Pipe Workbench contributors", "PipeWorkbench"
VIEW_DEFINITION = "ViewDefinition [ReferenceView_V1.2]"
POINT_DIGITS, DIRECTION_DIGITS = 6, 12  # decimals of mm and of unit vectors: a nanometre, also at the end of a long pipe
ENUMERATED = "enumerated"  # stands for a value of an IFC enumeration property
LABEL_LENGTH = 255  # characters that IfcLabel and IfcIdentifier hold
ORIGIN, X, Y, Z = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_BASE64 = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$"  # IFC's digits

Point = Iterable[float]


def import_ifcopenshell(purpose: str) -> Any:
    """Import ifcopenshell late: it takes its time and only IFC needs it."""
    try:
        import ifcopenshell
    except ImportError:
        raise MissingPackageError("ifcopenshell", purpose, "pip install 'ifcopenshell>=0.8.4,<0.10'") from None
    return ifcopenshell


def rounded(value: float, digits: int = POINT_DIGITS) -> float:
    """Return a number as the file has it; without the sign of a negative nothing."""
    return round(float(value), digits) + 0.0


def significant(value: float) -> float:
    """Return a standard deviation with the two digits that mean something (GUM, 7.2.6)."""
    return float(f"{value:.2g}")


def upper_bound(value: float) -> float:
    """Return the next number with one digit that is not less than a positive one."""
    unit = 10.0 ** math.floor(math.log10(value))
    return float(f"{math.ceil(round(value / unit, 6)) * unit:.1g}")


def label(text: str) -> str:
    """Return a text as a label holds it: not too long, and of characters that can be written."""
    return text.encode("utf-8", "replace").decode()[:LABEL_LENGTH]


def compressed(identity: uuid.UUID) -> str:
    """Return a GlobalId: 128 bits in 22 digits of base 64 (IfcGloballyUniqueId)."""
    return "".join(_BASE64[identity.int >> 6 * place & 63] for place in reversed(range(22)))


def expanded(global_id: str) -> uuid.UUID | None:
    """Return the UUID of a GlobalId, None where it is none."""
    if len(global_id) != 22 or not set(global_id) <= set(_BASE64) or global_id[0] not in _BASE64[:4]:
        return None
    value = 0
    for digit in global_id:
        value = value << 6 | _BASE64.index(digit)
    return uuid.UUID(int=value)


def digest(content: object) -> str:
    """Return a short text that says whether two contents are the same."""
    return hashlib.blake2b(repr(content).encode("utf-8", "replace"), digest_size=12).hexdigest()


class Entities:
    """Adds entities to an IFC file of a schema ("IFC4", "IFC4X3_ADD2").

    GlobalIds derive from ``project`` and a key, so that the same thing has the same one in every export. ``timestamp`` is in
    seconds since 1970 (UTC).
    """

    def __init__(self, schema: str, project: str, timestamp: int, name: str) -> None:
        self.file: ifcopenshell.file = import_ifcopenshell("Writing IFC").file(schema=schema)
        self.schema, self.project, self.timestamp = schema, project, timestamp
        self._shared: dict[Hashable, Any] = {}
        self._points: dict[tuple[float, ...], Any] = {}
        self._header(name)
        self.history = self._owner_history()
        self.origin = self.point(ORIGIN)
        self._unit = {direction: self._direction(direction) for sign in (1.0, -1.0) for axis in (X, Y, Z) for direction in [_times(axis, sign)]}
        self.identity = self.add("IfcAxis2Placement3D", Location=self.origin, Axis=self._unit[Z], RefDirection=self._unit[X])

    def add(self, kind: str, **attributes: Any) -> Any:
        """Add an entity."""
        return self.file.create_entity(kind, **attributes)

    def root(self, kind: str, key: str, **attributes: Any) -> Any:
        """Add a rooted entity with a GlobalId that depends on the project, its kind and ``key`` only."""
        identity = uuid.uuid5(NAMESPACE, f"{self.project}/{kind}/{key}".encode("utf-8", "replace").decode())
        return self.file.create_entity(kind, GlobalId=compressed(identity), OwnerHistory=self.history, **attributes)

    def once(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return what was made under a key, made when it is asked for first."""
        if key not in self._shared:
            self._shared[key] = make()
        return self._shared[key]

    def point(self, values: Point) -> Any:
        """Return a point (mm, two or three coordinates), one for each place that a component has."""
        place = tuple(rounded(value) for value in values)
        if place not in self._points:
            self._points[place] = self.file.create_entity("IfcCartesianPoint", place)
        return self._points[place]

    def begin_component(self) -> None:
        """Forget the points there are: no component shares one with another, for it may be moved without it."""
        self._points.clear()

    def direction(self, values: Point) -> Any:
        """Return a direction; those along the axes are shared."""
        x, y, z = (rounded(value, DIRECTION_DIGITS) for value in values)
        return self._unit.get((x, y, z)) or self._direction((x, y, z))

    def axes(self, location: Point = ORIGIN, axis: Point = Z, reference: Point = X) -> Any:
        """Return axes at a place: ``axis`` is their z, ``reference`` their x direction."""
        place, up, across = tuple(map(rounded, location)), self.direction(axis), self.direction(reference)
        if place != ORIGIN:
            return self.add("IfcAxis2Placement3D", Location=self.point(place), Axis=up, RefDirection=across)
        if up == self._unit[Z] and across == self._unit[X]:
            return self.identity
        return self.add("IfcAxis2Placement3D", Location=self.origin, Axis=up, RefDirection=across)

    def axes_2d(self, location: tuple[float, float] = (0.0, 0.0)) -> Any:
        """Return axes in a profile's plane, one for each place."""
        place = rounded(location[0]), rounded(location[1])
        return self.once(("axes 2d", place), lambda: self.add("IfcAxis2Placement2D", Location=self.point(place)))

    def property_value(self, name: str, kind: str, value: Any) -> Any:
        """Return a property; properties of the same value are shared, which keeps files small."""

        def make() -> Any:
            content = self.file.create_entity("IfcLabel" if kind == ENUMERATED else kind, label(value) if isinstance(value, str) else value)
            if kind == ENUMERATED:
                return self.file.create_entity("IfcPropertyEnumeratedValue", Name=name, EnumerationValues=(content,))
            return self.file.create_entity("IfcPropertySingleValue", Name=name, NominalValue=content)

        return self.once((name, kind, value), make)

    def quantity(self, name: str, kind: str, value: float) -> Any:
        """Return a quantity ("Length", "Area", "Weight"), shared like properties."""
        attributes = {"Name": name, f"{kind}Value": value}
        return self.once((name, kind, value), lambda: self.file.create_entity(f"IfcQuantity{kind}", **attributes))

    def quantity_set(self, key: str, name: str, found: Mapping[str, tuple[str, float]]) -> Any:
        """Return a set of base quantities: kind ("Length", "Area", ...) and value by name."""
        made = tuple(self.quantity(quantity, kind, value) for quantity, (kind, value) in found.items())
        return self.root("IfcElementQuantity", key, Name=name, MethodOfMeasurement="BaseQuantities", Quantities=made)

    def describe(self, thing: Any, key: str, definition: Any) -> None:
        """Relate a property or quantity set of its own to a thing."""
        self.root("IfcRelDefinesByProperties", key, RelatedObjects=(thing,), RelatingPropertyDefinition=definition)

    def relate(self, kind: str, key: str, one: str, many: str, relating: Any, related: Sequence[Any], **attributes: Any) -> Any:
        """Add a relation of one thing with many."""
        return self.root(kind, key, **{one: relating, many: tuple(related)}, **attributes)

    def _direction(self, values: tuple[float, float, float]) -> Any:
        return self.file.create_entity("IfcDirection", values)

    def _header(self, name: str) -> None:
        header = self.file.header
        when = dt.datetime.fromtimestamp(self.timestamp, dt.UTC)
        header.file_description.description = (VIEW_DEFINITION,)
        header.file_name.name = name.encode("utf-8", "replace").decode()
        header.file_name.time_stamp = when.strftime("%Y-%m-%dT%H:%M:%S")
        header.file_name.author = ("User",)
        header.file_name.organization = (COMPANY,)
        header.file_name.originating_system = f"{COMPANY} - {APPLICATION} - {__version__}"
        header.file_name.preprocessor_version = f"{APPLICATION} {__version__}"
        header.file_name.authorization = "None"

    def _owner_history(self) -> Any:
        organisation = self.add("IfcOrganization", Name=COMPANY)
        person = self.add("IfcPersonAndOrganization", ThePerson=self.add("IfcPerson", FamilyName="User"), TheOrganization=organisation)
        application = self.add(
            "IfcApplication",
            ApplicationDeveloper=organisation,
            Version=__version__,
            ApplicationFullName=APPLICATION,
            ApplicationIdentifier=IDENTIFIER,
        )
        return self.add(
            "IfcOwnerHistory",
            OwningUser=person,
            OwningApplication=application,
            ChangeAction="ADDED",
            LastModifiedDate=self.timestamp,
            CreationDate=self.timestamp,
        )


def finite(name: str, values: Iterable[float]) -> None:
    """Refuse a component whose coordinates cannot be written."""
    if not all(map(math.isfinite, values)):
        raise InputError(name, "", "has a coordinate that is not a finite number", "correct the component's points")


def _times(axis: tuple[float, float, float], sign: float) -> tuple[float, float, float]:
    x, y, z = (sign * value + 0.0 for value in axis)
    return x, y, z
