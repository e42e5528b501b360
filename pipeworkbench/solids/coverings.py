# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shapes that insulation has around components: plain numbers, in the axes that ``frames`` gives the component.

Every covering is built of layers from the component's surface outwards and of a jacket of sheet metal around them. Its
boundaries are counted from the inner face (0) to the jacket's outer face. Lengths are mm, angles rad; an angle about an
axis is counted from x towards y.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.solids.frames import Frame


@dataclass(frozen=True)
class Layer:
    """One layer of insulation: what it is made of (a name) and how thick it is (mm)."""

    material: str
    thickness: float


@dataclass(frozen=True)
class Sheet:
    """The jacket's sheet metal: what it is made of (a name) and how thick it is (mm)."""

    material: str
    thickness: float


@dataclass(frozen=True, eq=False)
class Notch:
    """A cylinder that is cut out of a covering, because ``cause`` (a component or an obstacle) needs the room.

    ``start`` and ``end`` (3,) are the ends of the cylinder's axis in the covering's own axes, mm.
    """

    cause: str
    start: Array
    end: Array
    radius: float

    def moved(self, axes: Array, origin: Array) -> Notch:
        """Return it in other axes: the rows of ``axes`` (3, 3) from ``origin`` (3,) on."""
        return replace(self, start=axes @ (self.start - origin), end=axes @ (self.end - origin))

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Return which of points (n, 3) lie in it."""
        length = float(np.linalg.norm(self.end - self.start))
        axis = (self.end - self.start) / length
        along = (points - self.start) @ axis
        across = np.linalg.norm(points - self.start - along[:, None] * axis, axis=1)
        inside: NDArray[np.bool_] = (across < self.radius) & (along > 0) & (along < length)
        return inside


@dataclass(frozen=True, eq=False)
class BlockNotch:
    """A block that is cut out of a covering, because ``cause`` (an obstacle) needs the room.

    ``frame`` is in the covering's own axes: its origin is the block's lower corner, from which the block goes on by
    ``size`` (3,) mm along the frame's x, y and z.
    """

    cause: str
    frame: Frame
    size: Array

    def moved(self, axes: Array, origin: Array) -> BlockNotch:
        """Return it in other axes: the rows of ``axes`` (3, 3) from ``origin`` (3,) on."""
        frame = self.frame
        return replace(self, frame=Frame(axes @ (frame.origin - origin), axes @ frame.x, axes @ frame.y, axes @ frame.z))

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Return which of points (n, 3) lie in it."""
        local = (points - self.frame.origin) @ np.array([self.frame.x, self.frame.y, self.frame.z]).T
        inside: NDArray[np.bool_] = np.all((local > 0) & (local < self.size), axis=1)
        return inside


AnyNotch = Notch | BlockNotch


@dataclass(frozen=True, eq=False, kw_only=True)
class Covering:
    """What every covering has: its own name, the component it lies around, where, and of what it is built.

    ``frame`` places it in the pipeline's frame; ``seam`` is the angle of the jacket's longitudinal seam about its axis.
    """

    kind: ClassVar[str] = ""

    id: str
    component: str
    frame: Frame
    layers: tuple[Layer, ...]
    sheet: Sheet | None = None
    seam: float = 0.0
    notches: tuple[AnyNotch, ...] = ()

    @property
    def boundaries(self) -> tuple[float, ...]:
        """Distances (mm) of the layers' faces from the inner face: 0, then one more for each layer and for the jacket."""
        thick = [layer.thickness for layer in self.layers] + ([self.sheet.thickness] if self.sheet else [])
        return (0.0, *itertools.accumulate(thick))

    @property
    def thickness(self) -> float:
        """Thickness (mm) of all layers without the jacket."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def total_thickness(self) -> float:
        """Thickness (mm) of all layers and the jacket."""
        return self.boundaries[-1]


@dataclass(frozen=True, eq=False, kw_only=True)
class StraightCovering(Covering):
    """A straight one around z from ``begin`` to ``end`` (mm); ``radius`` (mm) is the inner face's."""

    kind: ClassVar[str] = "straight"

    radius: float
    begin: float
    end: float


@dataclass(frozen=True, eq=False, kw_only=True)
class BendCovering(Covering):
    """Around an elbow's axis, which leaves the origin along z and turns towards x about (bend_radius, 0, 0).

    ``gores`` is the number of straight pieces with mitred ends that stand for the torus; 0 is the torus itself. The
    polygon of their axes touches the bend's axis: neighbours' axes differ by angle / (gores - 1), the first and the last
    piece are half as long as the others, so that their outer ends are square. ``collars`` (mm) is by how much the first
    and the last piece go on straight over the neighbour at the start and at the end.
    The innermost face is the elbow's torus whatever ``gores`` is, continued by the cylinder under the collars.
    """

    kind: ClassVar[str] = "bend"

    radius: float
    bend_radius: float
    angle: float
    gores: int = 0
    collars: tuple[float, float] = (0.0, 0.0)

    @property
    def joint_angle(self) -> float:
        """The angle (rad) between the axes of neighbouring gores."""
        return self.angle / (self.gores - 1)

    @property
    def half_length(self) -> float:
        """Length (mm) along the axis of the first and of the last gore without collar; the others are twice as long."""
        return float(self.bend_radius * np.tan(self.joint_angle / 2))


@dataclass(frozen=True, eq=False, kw_only=True)
class ConeCovering(Covering):
    """Around a reducer: inner ``radius`` in the plane z = 0, ``end_radius`` in z = ``length`` about (``offset``, 0), all mm.

    Each boundary is the cone of straight lines between both circles, whose radii are larger by the boundary's distance.
    """

    kind: ClassVar[str] = "cone"

    radius: float
    end_radius: float
    length: float
    offset: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class TeeCovering(Covering):
    """Around a run along z from ``begin`` (< 0) to ``end`` and a branch from the origin in the x, z plane (mm).

    The branch's axis leaves z at ``branch_angle`` (rad, pi / 2 is square) towards +x and is covered to ``reach`` mm from
    the origin. Where the branch's outer face does not come out of the run's, ``reach`` is 0 and the branch is a hole.
    """

    kind: ClassVar[str] = "tee"

    radius: float
    begin: float
    end: float
    branch_radius: float
    branch_angle: float
    reach: float


@dataclass(frozen=True, eq=False, kw_only=True)
class CapCovering(Covering):
    """A pot over a pipe's cap: a cylinder from z = 0 to ``length`` and a flat bottom of the same thickness behind it.

    The inner face is the cylinder ``radius`` with a flat end at ``length`` (mm): the hollow above a dished head is filled
    with loose insulation and counts as the component.
    """

    kind: ClassVar[str] = "cap"

    radius: float
    length: float


@dataclass(frozen=True, eq=False, kw_only=True)
class BoxCovering(Covering):
    """A round box of two half shells over flanges or a valve, about z from ``begin`` to ``end`` (outer faces of its ends, mm).

    The hollow has ``radius`` and is shorter by the layers and the jacket at both ends; ``openings`` are the radii (mm) of
    the holes in the ends, 0 where an end is closed. ``components`` are all it goes over. It is parted by the plane y = 0.
    """

    kind: ClassVar[str] = "box"

    radius: float
    begin: float
    end: float
    openings: tuple[float, float]
    components: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class StopCovering(Covering):
    """A disc of sheet metal that closes insulation: in the plane z = 0, from ``radius`` to ``outer_radius`` (mm), normal z outwards.

    It has no layers; its sheet reaches from z = 0 to the sheet's thickness.
    """

    kind: ClassVar[str] = "stop"

    radius: float
    outer_radius: float


AnyCovering = StraightCovering | BendCovering | ConeCovering | TeeCovering | CapCovering | BoxCovering | StopCovering
