# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rows of the standards' tables: pipes, walls, bends, flanges, tees, reducers, caps (lengths in mm).

Every field is a column of the table of the same kind in ``standards/``; a field that may be None may be
empty there. ``verified`` is the number of independent public sources of the weakest figure that gives the
component its shape (2 two or more, 1 one, 0 none), ``unsourced`` names the columns without any source,
``source`` the user's file, empty for the tables that come with the program.
"""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

PIPE_STANDARD = "EN 10220"
STEEL_DENSITY = 7850.0  # kg/m3, EN 10220
SMALLEST_DIAMETER = 1.0  # mm; what is smaller was not given in mm
SAME_LENGTH = 0.01  # mm; keys and dimensions that differ by less are the same figure
STANDARD_BENDS = ("2D", "3D", "5D")
FLANGE_TYPES = {"01": "plate", "05": "blind", "11": "weld neck", "12": "hubbed slip-on", "13": "hubbed threaded"}  # EN 1092-1

Grade = Literal[0, 1, 2]
Problem = tuple[str, str]  # the column that is wrong, and what is wrong


class Record(ABC):
    """A row of a table; ``KEY`` names the columns that tell it from all others of the table."""

    KEY: ClassVar[tuple[str, ...]]

    @abstractmethod
    def problem(self) -> Problem | None:
        """Return the column and the reason why the figures do not fit together, None where they do."""

    @property
    def key(self) -> tuple[Any, ...]:
        """What no two records of one table share; a user's record takes the place of the one with its key."""
        values = (getattr(self, name) for name in self.KEY)
        return tuple(round(value / SAME_LENGTH) if isinstance(value, float) else value for value in values)


@dataclass(frozen=True)
class PipeSize(Record):
    """One outside diameter of EN 10220 (mm).

    ``wall_thickness`` is the normal wall of a seamless tube, None where no figure is known;
    ``verified`` and ``wall_verified`` grade the sources (2 two or more, 1 one, 0 none).
    """

    KEY = ("outer_diameter",)

    outer_diameter: float
    series: int
    dn: int | None
    wall_thickness: float | None
    verified: int
    wall_verified: int | None
    standard: str = PIPE_STANDARD
    source: str = ""

    @property
    def designation(self) -> str:
        """``DN 40`` where the size has a nominal diameter, else the outside diameter."""
        return f"DN {self.dn}" if self.dn else f"{self.outer_diameter:g} mm"

    @property
    def weakest_source(self) -> int:
        """The lower of the two grades; a wall without a grade has no source."""
        return self.verified if self.wall_thickness is None else min(self.verified, self.wall_verified or 0)

    @property
    def unsourced(self) -> tuple[str, ...]:
        """The columns that have no source."""
        walls = ("wall_thickness",) if self.wall_thickness is not None and not self.wall_verified else ()
        return walls if self.verified else ("outer_diameter", *walls)

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a pipe's."""
        if self.series not in (1, 2, 3):
            return "series", f"is {self.series}, not 1, 2 or 3"
        return _tube_problem(self.outer_diameter, self.wall_thickness)


@dataclass(frozen=True, kw_only=True)
class PipeWall(Record):
    """A wall thickness that is made for an outside diameter; ``role`` says what it is used for."""

    KEY = ("outer_diameter", "wall_thickness")

    standard: str
    outer_diameter: float
    dn: int | None
    wall_thickness: float
    role: str | None
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    @property
    def mass_per_metre(self) -> float:
        """Mass in kg/m of a steel tube: pi (d - t) t rho."""
        return math.pi * (self.outer_diameter - self.wall_thickness) * self.wall_thickness * STEEL_DENSITY / 1e6

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a tube's."""
        return _tube_problem(self.outer_diameter, self.wall_thickness)


@dataclass(frozen=True, kw_only=True)
class Bend(Record):
    """A butt-welding bend: ``bend_radius`` is the axis', ``bend_type`` 2D, 3D or 5D (also 10D, 20D)."""

    KEY = ("standard", "bend_type", "outer_diameter")

    standard: str
    bend_type: str
    dn: int | None
    outer_diameter: float
    bend_radius: float
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a bend's."""
        if not re.fullmatch(r"[1-9]\d*(\.\d+)?D", self.bend_type):
            return "bend_type", f"is '{self.bend_type}', not 2D, 3D, 5D or alike"
        if self.bend_radius <= self.outer_diameter / 2:
            return "bend_radius", f"is {self.bend_radius:g}, not more than half the outside diameter {self.outer_diameter:g}"
        return _tube_problem(self.outer_diameter, None)


@dataclass(frozen=True, kw_only=True)
class FlangeDimensions(Record):
    """A flange of one type, PN and DN, with the letters of EN 1092-1.

    ``D`` outside (rim) diameter, ``K`` bolt circle, ``L`` bolt hole, ``bolts`` their number, ``C`` thickness
    of the plate; ``length`` from the sealing face to the other end: the height H of a neck, C of a plate;
    ``neck_diameter`` (N) where the neck leaves the plate, ``neck_straight`` (H3) its straight part at the
    weld end, ``pipe_diameter`` (A) the outside diameter of the pipe it sits on, None for blind flanges;
    ``raised_face_diameter`` (d1) and ``raised_face_height`` (f1, a part of C).
    """

    KEY = ("standard", "flange_type", "pn", "dn", "pipe_diameter")

    standard: str
    flange_type: str
    pn: float
    dn: int
    pipe_diameter: float | None
    D: float
    K: float
    L: float
    bolts: int
    bolt_size: str | None
    C: float | None
    length: float | None
    neck_diameter: float | None
    neck_straight: float | None
    weld_wall: float | None
    bore: float | None
    raised_face_diameter: float | None
    raised_face_height: float | None
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        if self.length is None:
            object.__setattr__(self, "length", self.C)  # a plate is as long as it is thick

    @property
    def blind(self) -> bool:
        """Whether it closes the pipe: no pipe goes into it."""
        return self.pipe_diameter is None

    @property
    def has_neck(self) -> bool:
        """Whether a neck (or hub) stands on the plate."""
        return self.neck_diameter is not None or (self.length or 0) > (self.C or math.inf)

    @property
    def is_complete(self) -> bool:
        """Whether thickness and length are known, so that it can be modelled; the neck's diameter may be missing."""
        return self.C is not None and self.length is not None

    @property
    def designation(self) -> str:
        """As it is ordered: ``EN 1092-1 type 11 DN 40 PN 16``."""
        return f"{self.standard} type {self.flange_type} DN {self.dn} PN {self.pn:g}"

    def looks_like(self, other: FlangeDimensions, tolerance: float = SAME_LENGTH) -> bool:
        """Tell whether no dimension of the outside view differs by more than ``tolerance`` (mm).

        Bolts and raised face are left out, for they are small and often hidden. A neck's dimension that is
        not known of one of the two cannot tell them apart.
        """
        needed = ((self.D, other.D), (self.C, other.C), (self.length, other.length), (self.pipe_diameter, other.pipe_diameter))
        neck = ((self.neck_diameter, other.neck_diameter), (self.neck_straight, other.neck_straight))
        return (
            self.has_neck == other.has_neck
            and all(a == b or (a is not None and b is not None and abs(a - b) <= tolerance) for a, b in needed)
            and all(a is None or b is None or abs(a - b) <= tolerance for a, b in neck)
        )

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a flange's."""
        checks = (self._drilling_problem, self._neck_problem, self._face_problem)
        return next(filter(None, (check() for check in checks)), None)

    def _drilling_problem(self) -> Problem | None:
        if self.K + self.L >= self.D:
            return "K", f"bolt circle {self.K:g} and holes {self.L:g} do not fit into the outside diameter D {self.D:g} (K + L < D)"
        if self.bolts * self.L >= math.pi * self.K:
            return "bolts", f"{self.bolts} holes of {self.L:g} do not fit on the bolt circle K {self.K:g}"
        metric = re.fullmatch(r"M(\d+)", self.bolt_size or "")
        if metric and int(metric[1]) >= self.L:
            return "bolt_size", f"{self.bolt_size} does not go through a hole of {self.L:g}"
        return None

    def _neck_problem(self) -> Problem | None:
        widest = self.K - self.L  # what lies inside all holes
        for column in ("pipe_diameter", "neck_diameter", "bore"):
            value = getattr(self, column)
            if value is not None and value >= widest:
                return column, f"is {value:g} and reaches into the bolt holes, which begin at {widest:g} (K - L)"
        if self.neck_diameter is not None and self.pipe_diameter is not None and self.neck_diameter < self.pipe_diameter:
            return "neck_diameter", f"is {self.neck_diameter:g}, less than the pipe's {self.pipe_diameter:g}"
        if self.C is not None and self.length is not None:
            if self.length < self.C:
                return "length", f"is {self.length:g}, less than the thickness C {self.C:g}"
            if self.has_neck and self.length <= self.C + (self.neck_straight or 0):
                return "length", f"is {self.length:g}, no more than thickness C and straight part together"
        if self.weld_wall is not None and self.pipe_diameter is not None and 2 * self.weld_wall >= self.pipe_diameter:
            return "weld_wall", f"is {self.weld_wall:g}, not less than half the pipe's diameter {self.pipe_diameter:g}"
        return None

    def _face_problem(self) -> Problem | None:
        if self.raised_face_diameter is not None and self.raised_face_diameter > self.K - self.L:
            return (
                "raised_face_diameter",
                f"is {self.raised_face_diameter:g} and reaches into the bolt holes, which begin at {self.K - self.L:g} (K - L)",
            )
        if self.raised_face_height is not None and self.C is not None and self.raised_face_height >= self.C:
            return "raised_face_height", f"is {self.raised_face_height:g}, not less than the thickness C {self.C:g}"
        return None


@dataclass(frozen=True, kw_only=True)
class Tee(Record):
    """A butt-welding tee: ``run_length`` from the centre to each end of the run, ``branch_length`` to the branch's end."""

    KEY = ("standard", "run_diameter", "branch_diameter")

    standard: str
    dn: int | None
    branch_dn: int | None
    run_diameter: float
    branch_diameter: float
    run_length: float
    branch_length: float | None
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    @property
    def equal(self) -> bool:
        """Whether the branch is as wide as the run."""
        return abs(self.run_diameter - self.branch_diameter) < SAME_LENGTH

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a tee's."""
        if self.branch_diameter > self.run_diameter:
            return "branch_diameter", f"is {self.branch_diameter:g}, more than the run's {self.run_diameter:g}"
        if self.run_length <= self.branch_diameter / 2:
            return "run_length", f"is {self.run_length:g}, not more than half the branch's diameter {self.branch_diameter:g}"
        if self.branch_length is not None and self.branch_length <= self.run_diameter / 2:
            return "branch_length", f"is {self.branch_length:g}, not more than half the run's diameter {self.run_diameter:g}"
        return _tube_problem(self.branch_diameter, None, "branch_diameter")


@dataclass(frozen=True, kw_only=True)
class Reducer(Record):
    """A butt-welding reducer, concentric or eccentric, of an overall ``length``."""

    KEY = ("standard", "large_diameter", "small_diameter")

    standard: str
    dn: int | None
    small_dn: int | None
    large_diameter: float
    small_diameter: float
    length: float
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a reducer's."""
        if self.small_diameter >= self.large_diameter:
            return "small_diameter", f"is {self.small_diameter:g}, not less than the large one {self.large_diameter:g}"
        return _tube_problem(self.small_diameter, None, "small_diameter")


@dataclass(frozen=True, kw_only=True)
class Cap(Record):
    """A butt-welding cap (dome) of an overall ``height``."""

    KEY = ("standard", "outer_diameter")

    standard: str
    dn: int | None
    outer_diameter: float
    height: float
    verified: Grade
    unsourced: tuple[str, ...] = ()
    source: str = ""

    def problem(self) -> Problem | None:
        """Return the column and what keeps the figures from being a cap's."""
        return _tube_problem(self.outer_diameter, None)


def _tube_problem(outer_diameter: float, wall_thickness: float | None, column: str = "outer_diameter") -> Problem | None:
    if outer_diameter < SMALLEST_DIAMETER:
        return column, f"is {outer_diameter:g}, no diameter in mm"
    if wall_thickness is not None and 2 * wall_thickness >= outer_diameter:
        return "wall_thickness", f"is {wall_thickness:g}, not less than half the outside diameter {outer_diameter:g}"
    return None
