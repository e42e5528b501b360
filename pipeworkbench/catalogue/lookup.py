# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looking up what the standards' tables and the user's hold (lengths in mm)."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pipeworkbench.catalogue.records import (
    SAME_LENGTH,
    STANDARD_BENDS,
    Bend,
    Cap,
    FlangeDimensions,
    PipeSize,
    PipeWall,
    Record,
    Reducer,
    Tee,
)
from pipeworkbench.catalogue.tables import kind_of, read_table, read_user_tables
from pipeworkbench.files import package_folder

R = TypeVar("R", bound=Record)
DIAMETER_TOLERANCE = 0.05  # mm; EN 10220's diameters differ by 0.5 and more
RIM_TOLERANCE = 1.0  # mm; D of EN 1092-1 goes in steps of 5


@functools.cache
def built_in(kind: type[R]) -> tuple[R, ...]:
    """Return the records of one kind of the tables that come with the program."""
    paths = sorted(path for path in package_folder("standards").glob("*.csv") if kind_of(path) is kind)
    return tuple(record for path in paths for record in read_table(path, kind))


class Catalogue:
    """The tables that come with the program, with those of the user's folders added.

    A user's record with the key of a built-in one takes its place, and that of a later folder an earlier one's. The user's tables are
    read at once, so that what is wrong in them is said before the work begins; the others when they are first needed.

    Parameters
    ----------
    folders : Path
        Folders with tables of the user's own; see `tables`.

    Raises
    ------
    InputError
        Where the folder or a table in it does not fit; names file, line and column.
    """

    def __init__(self, *folders: Path) -> None:
        self.folders = folders
        self._user: Sequence[Mapping[type[Record], tuple[Record, ...]]] = tuple(map(read_user_tables, folders))
        self._merged: dict[type[Record], tuple[Any, ...]] = {}

    def records(self, kind: type[R]) -> tuple[R, ...]:
        """Return all records of a kind in the order of their keys."""
        if kind not in self._merged:
            own = (record for tables in self._user for record in tables.get(kind, ()))
            merged = {record.key: record for record in (*built_in(kind), *own)}
            self._merged[kind] = tuple(sorted(merged.values(), key=_order))
        return self._merged[kind]

    def pipe_sizes(self) -> tuple[PipeSize, ...]:
        """Return all pipe sizes by increasing diameter."""
        return self.records(PipeSize)

    def nearest_pipe_size(self, outer_diameter: float) -> PipeSize:
        """Return the size whose outside diameter is nearest."""
        return min(self.pipe_sizes(), key=lambda size: abs(size.outer_diameter - outer_diameter))

    def pipe_size(self, outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> PipeSize | None:
        """Return the size with this outside diameter within ``tolerance``, or None."""
        nearest = self.nearest_pipe_size(outer_diameter)
        return nearest if abs(nearest.outer_diameter - outer_diameter) <= tolerance else None

    def pipe_sizes_of(self, dn: int) -> tuple[PipeSize, ...]:
        """Return the sizes of a nominal diameter, the usual (of series 1) first."""
        return tuple(sorted((size for size in self.pipe_sizes() if size.dn == dn), key=lambda size: size.series))

    def pipe_walls(self, outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[PipeWall, ...]:
        """Return the walls made for an outside diameter, the thinnest first."""
        return tuple(wall for wall in self.records(PipeWall) if abs(wall.outer_diameter - outer_diameter) <= tolerance)

    def bends(self, outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE, types: Iterable[str] | None = STANDARD_BENDS) -> tuple[Bend, ...]:
        """Return the bends of an outside diameter by increasing radius; of all types where ``types`` is None.

        Where the standards differ there are several radii of a type.
        """
        near = (bend for bend in self.records(Bend) if abs(bend.outer_diameter - outer_diameter) <= tolerance)
        wanted = None if types is None else frozenset(types)
        return tuple(sorted((bend for bend in near if wanted is None or bend.bend_type in wanted), key=lambda bend: bend.bend_radius))

    def flanges(
        self, *, standard: str | None = None, flange_type: str | None = None, pn: float | None = None, dn: int | None = None
    ) -> tuple[FlangeDimensions, ...]:
        """Return the flanges of a standard, type, PN and DN; what is None may be any."""
        wanted = {"standard": standard, "flange_type": flange_type, "pn": pn, "dn": dn}
        asked = {name: value for name, value in wanted.items() if value is not None}
        return tuple(f for f in self.records(FlangeDimensions) if all(getattr(f, name) == value for name, value in asked.items()))

    def flanges_of_rim(self, D: float, tolerance: float = RIM_TOLERANCE) -> tuple[FlangeDimensions, ...]:
        """Return the flanges whose outside diameter is within ``tolerance`` of ``D``, the nearest first."""
        found = (flange for flange in self.records(FlangeDimensions) if abs(flange.D - D) <= tolerance)
        return tuple(sorted(found, key=lambda flange: abs(flange.D - D)))

    def flanges_of_pipe(self, outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[FlangeDimensions, ...]:
        """Return the flanges that sit on a pipe of an outside diameter, and the blind ones of its DN."""
        flanges = self.records(FlangeDimensions)
        on_pipe = [flange.pipe_diameter is not None and abs(flange.pipe_diameter - outer_diameter) <= tolerance for flange in flanges]
        nominal = {flange.dn for flange, near in zip(flanges, on_pipe, strict=True) if near}
        return tuple(flange for flange, near in zip(flanges, on_pipe, strict=True) if near or (flange.blind and flange.dn in nominal))

    def equivalents(self, flange: FlangeDimensions, tolerance: float = SAME_LENGTH) -> tuple[FlangeDimensions, ...]:
        """Return the other flanges that look the same from outside (`FlangeDimensions.looks_like`)."""
        near = (other for other in self.records(FlangeDimensions) if abs(other.D - flange.D) <= tolerance)
        return tuple(other for other in near if flange.looks_like(other, tolerance) and other.key != flange.key)

    def tees(self, run_diameter: float, branch_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Tee, ...]:
        """Return the tees of a run and a branch."""
        return tuple(
            tee
            for tee in self.records(Tee)
            if abs(tee.run_diameter - run_diameter) <= tolerance and abs(tee.branch_diameter - branch_diameter) <= tolerance
        )

    def reducers(self, large_diameter: float, small_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Reducer, ...]:
        """Return the reducers between two diameters, one for each length that a standard gives."""
        return tuple(
            reducer
            for reducer in self.records(Reducer)
            if abs(reducer.large_diameter - large_diameter) <= tolerance and abs(reducer.small_diameter - small_diameter) <= tolerance
        )

    def caps(self, outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Cap, ...]:
        """Return the caps of an outside diameter."""
        return tuple(cap for cap in self.records(Cap) if abs(cap.outer_diameter - outer_diameter) <= tolerance)


def _order(record: Record) -> tuple[Any, ...]:
    """Return what records are sorted by: their key, where what is not known comes first."""
    return tuple((value is not None, value) for value in record.key)
