# SPDX-License-Identifier: LGPL-2.1-or-later
"""The standards' tables as objects: which outside diameters exist, and how well each figure is sourced."""

from __future__ import annotations

import csv
import functools
import math
from dataclasses import dataclass
from pathlib import Path

from pipeworkbench.errors import InputError
from pipeworkbench.files import package_folder

PIPE_STANDARD = "EN 10220"


@dataclass(frozen=True)
class PipeSize:
    """One outside diameter of EN 10220 (mm).

    ``wall_thickness`` is the normal wall of a seamless tube, None where no figure is known;
    ``verified`` and ``wall_verified`` grade the sources (2 two or more, 1 one, 0 none).
    """

    outer_diameter: float
    series: int
    dn: int | None
    wall_thickness: float | None
    verified: int
    wall_verified: int | None

    @property
    def designation(self) -> str:
        """``DN 40`` where the size has a nominal diameter, else the outside diameter."""
        return f"DN {self.dn}" if self.dn else f"{self.outer_diameter:g} mm"

    def is_sensible(self) -> bool:
        """Tell whether the figures can be a pipe's and the grades are grades."""
        wall = self.wall_thickness
        return (
            0 < self.outer_diameter < math.inf
            and (wall is None or 0 < wall < self.outer_diameter / 2)
            and self.series in (1, 2, 3)
            and (self.dn is None or self.dn > 0)
            and {self.verified, self.wall_verified} <= {0, 1, 2, None}
        )

    @property
    def weakest_source(self) -> int:
        """The lower of the two grades."""
        return min(self.verified, 2 if self.wall_verified is None else self.wall_verified)


@functools.cache
def pipe_sizes() -> tuple[PipeSize, ...]:
    """Return all sizes of EN 10220 by increasing diameter."""
    return read_pipe_sizes(package_folder("standards") / "pipes_en10220.csv")


def read_pipe_sizes(path: Path) -> tuple[PipeSize, ...]:
    """Read a table of pipe sizes; lines that start with ``#`` are comments."""
    sizes = []
    with path.open(encoding="utf-8", newline="") as file:
        numbered = [(number, line) for number, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
    reader = csv.DictReader(line for _, line in numbered)
    for (number, _), row in zip(numbered[1:], reader, strict=True):
        try:
            size = PipeSize(
                float(row["outer_diameter"]),
                int(row["series"]),
                int(row["dn"]) if row["dn"] else None,
                float(row["wall_thickness"]) if row["wall_thickness"] else None,
                int(row["verified"]),
                int(row["wall_verified"]) if row["wall_verified"] else None,
            )
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(path, f"line {number}", f"not a pipe size ({error!r})", "correct this row") from None
        if not size.is_sensible():
            raise InputError(path, f"line {number}", f"these figures make no pipe ({size})", "correct this row")
        sizes.append(size)
    return tuple(sorted(sizes, key=lambda size: size.outer_diameter))


def pipe_size(outer_diameter: float, tolerance: float = 0.05) -> PipeSize | None:
    """Return the size with this outside diameter (mm, within ``tolerance``), or None."""
    nearest = nearest_pipe_size(outer_diameter)
    return nearest if abs(nearest.outer_diameter - outer_diameter) <= tolerance else None


def nearest_pipe_size(outer_diameter: float) -> PipeSize:
    """Return the size whose outside diameter (mm) is nearest."""
    return min(pipe_sizes(), key=lambda size: abs(size.outer_diameter - outer_diameter))
