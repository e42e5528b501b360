# SPDX-License-Identifier: LGPL-2.1-or-later
"""What hangs together follows: a changed diameter runs along a run, an end that moves carries what is joined to it.

The component that somebody changed leads, the others follow in the same change of the document (and so in the same step of
undo), without being recomputed in between. Diameters go through pipes, elbows and flanges up to reducers and tees. Of the
movement of an end, a pipe takes up what lies along its axis by growing or shrinking, so that its other end stays; with the
rest it moves as a whole, as fittings do, and carries what is joined to its other end. So axes stay tangent to elbows, and
a movement ends at the next pipes that run along it. What is fixed by the user or placed by an expression does not follow.
"""

from __future__ import annotations

import contextlib
import math
from collections import deque
from collections.abc import Callable, Collection, Iterator
from typing import Any

import FreeCAD

from pipeworkbench.features.base import is_newer
from pipeworkbench.features.joints import is_joined, joints_of, points_of
from pipeworkbench.features.project import carries_joined

SAME_DIAMETER = 0.02  # what diameters may differ by, relatively, and still be meant to be the same (see recon.topology)
STILL_MM, STILL_RAD = 1e-6, 1e-9  # less is no movement
HELD = "it is held by what it is joined to"
SHORTEST_MM = 1.0  # what a pipe may be shortened to

_held: list[bool] = []
# what is about to be moved together with an object, by name, and so need not follow it: the window puts the selection here
together_hooks: list[Callable[[Any], Collection[str]]] = []


@contextlib.contextmanager
def holding() -> Iterator[None]:
    """For a while nothing follows what is changed: whoever changes the components knows where all of them are."""
    _held.append(True)
    try:
        yield
    finally:
        _held.pop()


def may_carry(obj: Any) -> bool:
    """Tell whether a change of a component object carries others."""
    return not _held and is_joined(obj) and carries_joined(obj.Document)


class Shape:
    """Where the ends of a component object are, and which diameters they have."""

    def __init__(self, obj: Any) -> None:
        feature, placement = obj.Proxy, obj.Proxy.placement(obj)
        self.ports = [placement.multiply(port) for port in feature.ports(obj)]
        self.sizes = [getattr(obj, end.size).Value for end in feature.ends]


class Carrier:
    """One change of a component object and what follows from it.

    Parameters
    ----------
    obj : document object
        The component that was changed.
    before : Shape
        What it was like.
    name : str
        The property that was changed.
    """

    def __init__(self, obj: Any, before: Shape, name: str) -> None:
        self._leader = obj
        self._together = {other for hook in together_hooks for other in hook(obj)} if name == "Placement" else set()
        self._before: dict[str, Shape] = {obj.Name: before}
        self._left_behind: dict[str, str] = {}

    def carry(self) -> None:
        """Let everything that is joined to the component follow; say what cannot."""
        with holding():
            resized = self._spread_diameters()
            self._spread_movements(resized)
        if self._left_behind:
            texts = "; ".join(f"{label} ({reason})" for label, reason in self._left_behind.items())
            FreeCAD.Console.PrintWarning(f"{self._leader.Label} was changed, but these do not follow: {texts}\n")

    def _spread_diameters(self) -> list[Any]:
        """Give what is joined to a changed diameter the same one; return the objects that were changed, the first one too."""
        resized, waiting = [self._leader], deque([self._leader])
        while waiting:
            obj = waiting.popleft()
            before = self._before[obj.Name]
            for end, other, other_end in joints_of(obj):
                size = getattr(obj, obj.Proxy.ends[end].size).Value
                if other.Name in self._before or math.isclose(size, before.sizes[end], abs_tol=STILL_MM):
                    continue
                known = Shape(other)
                if not math.isclose(known.sizes[other_end], before.sizes[end], rel_tol=SAME_DIAMETER):
                    continue  # they did not fit before either
                reason = _why_not(other, other.Proxy.ends[other_end].size) or other.Proxy.why_not_resized(other, other_end, size)
                if reason:
                    self._left_behind[other.Label] = reason
                    continue
                self._before[other.Name] = known
                other.Proxy.resize(other, other_end, size)
                resized.append(other)
                waiting.append(other)
        return resized

    def _spread_movements(self, resized: list[Any]) -> None:
        """Let what is joined to ends that moved follow them."""
        # a fitting that got other dimensions keeps its place, the pipes beside it are cut to fit
        waiting = deque(sorted(resized, key=lambda obj: obj.Proxy.stretches))
        placed = {self._leader.Name}
        while waiting:
            obj = waiting.popleft()
            for end, other, other_end in joints_of(obj):
                if other.Name in self._together:
                    continue
                motion = self._motion(obj, end).multiply(self._motion(other, other_end).inverse())
                rest = self._not_taken_up(other, other_end, motion)
                if rest is None:
                    continue
                reason = HELD if other.Name in placed else _why_not(other, "Placement")
                if reason:
                    self._left_behind.setdefault(other.Label, reason)
                    continue
                other.Proxy.move(other, rest)
                placed.add(other.Name)
                waiting.append(other)

    def _not_taken_up(self, obj: Any, end: int, motion: Any) -> Any | None:
        """Let a pipe take up what it can of an end's motion; return what moves it as a whole, None where nothing does."""
        if _turn(motion) >= STILL_RAD:
            return motion
        point = points_of(obj)[end]
        shift = motion.multVec(point) - point
        if shift.Length >= STILL_MM and obj.Proxy.stretches and not (_why_not(obj, "Length") or _why_not(obj, "Placement")):
            shift = obj.Proxy.stretch(obj, end, shift)
        return FreeCAD.Placement(shift, FreeCAD.Rotation()) if shift.Length >= STILL_MM else None

    def _motion(self, obj: Any, end: int) -> Any:
        """Return how an end has moved since the change began."""
        if obj.Name not in self._before:
            self._before[obj.Name] = Shape(obj)
        now = obj.Proxy.placement(obj).multiply(obj.Proxy.ports(obj)[end])
        return now.multiply(self._before[obj.Name].ports[end].inverse())


def _why_not(obj: Any, name: str) -> str:
    """Return why a property of a component does not follow, empty where it does."""
    if is_newer(obj):
        return "a newer version made it"
    if obj.Fixed:
        return "it is fixed"
    bound = {path.lstrip(".").split(".")[0] for path, *_ in obj.ExpressionEngine}
    if name in bound or (name == "OutsideDiameter" and "NominalDiameter" in bound):
        return "an expression sets it"
    return ""


def _turn(motion: Any) -> float:
    """Return the angle (rad) of a motion's rotation; sharp for small ones too."""
    x, y, z, _ = motion.Rotation.Q
    return 2 * math.sqrt(x * x + y * y + z * z)
