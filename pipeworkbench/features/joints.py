# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints as links between document objects: each end of a component links to the component that is joined to it.

The links are hidden from FreeCAD's dependency graph, for joints go both ways and runs may close to rings. A joint holds
where both ends name each other, so that it ends with either component. Which end of the other one is meant stands in
``JoinedEnds``, by the number of the own end.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from pipeworkbench.features.base import HIDDEN, Property

OPEN = -1
JOINED = "Joined"
LINK = "App::PropertyLinkHidden"


class End(NamedTuple):
    """An end of a kind of components: its name, and the property that holds the diameter there."""

    name: str
    size: str = "OutsideDiameter"

    @property
    def link(self) -> str:
        """The property that links to what is joined there."""
        return JOINED + self.name


class Joined(NamedTuple):
    """An own end, and the component and its end that are joined to it."""

    end: int
    other: Any
    other_end: int


def joint_properties(ends: Sequence[End]) -> tuple[Property, ...]:
    """Return the properties that hold the joints of a kind of components."""
    texts = [f"What is joined to the {end.name.lower()}; it follows when this component is changed" for end in ends]
    return (
        *(Property(end.link, LINK, "Joints", text) for end, text in zip(ends, texts, strict=True)),
        Property("JoinedEnds", "App::PropertyIntegerList", "Joints", "Numbers of the ends that are joined to the own ones", HIDDEN),
    )


def joints_of(obj: Any) -> Iterator[Joined]:
    """Yield what is joined to a component object."""
    for number, end in enumerate(obj.Proxy.open_to(obj)):
        other, other_end = _named(obj, number, end)
        if other is not None and _names(other, other_end, obj, number):
            yield Joined(number, other, other_end)


def is_joined(obj: Any) -> bool:
    """Tell whether anything is joined to a component object."""
    return next(joints_of(obj), None) is not None


def points_of(obj: Any) -> list[Any]:
    """Return where the ends of a component object are in the document's frame (FreeCAD.Vector)."""
    placement = obj.Proxy.placement(obj)
    return [placement.multVec(port.Base) for port in obj.Proxy.ports(obj)]


def connect(obj: Any, end: int, other: Any, other_end: int) -> None:
    """Join an end of a component object to one of another; what was joined to either of them before no longer is."""
    disconnect(obj, end)
    disconnect(other, other_end)
    _set(obj, end, other, other_end)
    _set(other, other_end, obj, end)


def disconnect(obj: Any, end: int) -> None:
    """Open an end of a component object."""
    other, other_end = _named(obj, end, obj.Proxy.ends[end])
    if other is not None and _names(other, other_end, obj, end):
        _set(other, other_end, None, OPEN)
    _set(obj, end, None, OPEN)


def disconnect_all(objects: Iterable[Any]) -> None:
    """Open the ends of component objects that are joined to each other; those to other components stay."""
    among = {obj.Name: obj for obj in objects}
    for obj in among.values():
        for joined in list(joints_of(obj)):
            if joined.other.Name in among:
                disconnect(obj, joined.end)


def joined_by(obj: Any, name: str) -> Joined | None:
    """Return what the link of an end joins to a component object."""
    return next((joined for joined in joints_of(obj) if obj.Proxy.ends[joined.end].link == name), None)


def link_changed(obj: Any, name: str, before: Joined | None) -> None:
    """Complete a joint after someone set the link of an end: the nearest end of the other component links back.

    ``before`` is what was joined there; its end is open now.
    """
    end = next(number for number, end in enumerate(obj.Proxy.ends) if end.link == name)
    if before is not None and before.other != getattr(obj, name):
        _set(before.other, before.other_end, None, OPEN)
    other, other_end = _named(obj, end, obj.Proxy.ends[end])
    if other is not None and _names(other, other_end, obj, end):
        return
    linked = getattr(obj, name)
    if linked is None or linked == obj or not hasattr(getattr(linked, "Proxy", None), "ends"):
        _set(obj, end, None, OPEN)
        return
    here, others = points_of(obj)[end], points_of(linked)
    nearest = min(range(len(linked.Proxy.open_to(linked))), key=lambda number: (others[number] - here).Length)
    connect(obj, end, linked, nearest)


def _named(obj: Any, number: int, end: End) -> tuple[Any, int]:
    """Return which component and which of its ends an end names, whether or not it names this one."""
    other = getattr(obj, end.link, None)
    numbers = getattr(obj, "JoinedEnds", ())
    if other is None or len(numbers) <= number or numbers[number] == OPEN:
        return None, OPEN
    return other, numbers[number]


def _names(obj: Any, number: int, other: Any, other_end: int) -> bool:
    """Tell whether an end of a component object names an end of another one."""
    feature = getattr(obj, "Proxy", None)
    ends = feature.open_to(obj) if feature is not None and hasattr(feature, "open_to") else ()
    return number < len(ends) and _named(obj, number, ends[number]) == (other, other_end)


def _set(obj: Any, number: int, other: Any, other_end: int) -> None:
    ends = obj.Proxy.ends
    numbers = list(obj.JoinedEnds) or [OPEN] * len(ends)
    numbers[number] = other_end
    # first the number: it says what a changed link means
    with obj.Proxy.quiet():
        obj.JoinedEnds = numbers
        setattr(obj, ends[number].link, other)
