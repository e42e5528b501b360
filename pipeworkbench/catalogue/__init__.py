# SPDX-License-Identifier: LGPL-2.1-or-later
"""The standards' tables as objects: which pipes, bends, flanges and fittings exist, and how well each figure is sourced.

The functions ask the catalogue in use: the tables of ``standards/``, with a user's own after `use_folder`.
It is one for the whole process, for the reconstruction looks it up from several threads.

Examples
--------
>>> pipe_size(48.3).designation
'DN 40'
>>> [(bend.bend_type, bend.bend_radius) for bend in bends(114.3)]
[('2D', 102.0), ('3D', 152.0), ('5D', 270.0)]
>>> flange = catalogue().flanges(standard="EN 1092-1", flange_type="11", pn=16, dn=40)[0]
>>> flange.D, flange.C, flange.length, flange.neck_diameter, flange.verified
(150.0, 18.0, 45.0, 64.0, 2)
>>> [other.designation for other in equivalents(flange) if other.standard != "EN 1092-1"]
['DIN 2634 type 11 DN 40 PN 25', 'DIN 2635 type 11 DN 40 PN 40']
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from pathlib import Path

from pipeworkbench.catalogue.insulation_records import (
    InsulationDistance,
    InsulationMaterial,
    InsulationThickness,
    JacketSheet,
    JacketThickness,
    StockThickness,
)
from pipeworkbench.catalogue.lookup import DIAMETER_TOLERANCE, RIM_TOLERANCE, Catalogue
from pipeworkbench.catalogue.records import (
    FLANGE_TYPES,
    PIPE_STANDARD,
    SAME_LENGTH,
    STANDARD_BENDS,
    Bend,
    Cap,
    FlangeDimensions,
    PipeSize,
    PipeWall,
    Reducer,
    Tee,
)
from pipeworkbench.catalogue.tables import read_pipe_sizes

__all__ = [
    "FLANGE_TYPES",
    "PIPE_STANDARD",
    "STANDARD_BENDS",
    "Bend",
    "Cap",
    "Catalogue",
    "FlangeDimensions",
    "InsulationDistance",
    "InsulationMaterial",
    "InsulationThickness",
    "JacketSheet",
    "JacketThickness",
    "PipeSize",
    "PipeWall",
    "Reducer",
    "StockThickness",
    "Tee",
    "bends",
    "caps",
    "catalogue",
    "equivalents",
    "flanges_of_pipe",
    "flanges_of_rim",
    "nearest_pipe_size",
    "pipe_size",
    "pipe_sizes",
    "pipe_walls",
    "read_pipe_sizes",
    "reducers",
    "tees",
    "use_folder",
    "use_folders",
    "using_folder",
]

_in_use = [Catalogue()]


def catalogue() -> Catalogue:
    """Return the catalogue in use."""
    return _in_use[0]


def use_folder(folder: Path | None) -> Catalogue:
    """Use the tables of a user's folder beside the built-in ones from now on; with None these alone.

    Raises
    ------
    InputError
        Where a table does not fit; the catalogue in use stays.
    """
    return use_folders(() if folder is None else (folder,))


def use_folders(folders: Iterable[Path]) -> Catalogue:
    """Use the tables of several of a user's folders from now on; a later folder's take the place of an earlier one's.

    Raises
    ------
    InputError
        Where a table does not fit; the catalogue in use stays.
    """
    _in_use[0] = Catalogue(*folders)
    return _in_use[0]


@contextlib.contextmanager
def using_folder(folder: Path | None) -> Iterator[Catalogue]:
    """Use a user's folder for a while; with None the catalogue in use stays."""
    before = catalogue()
    try:
        yield before if folder is None else use_folder(folder)
    finally:
        _in_use[0] = before


def pipe_sizes() -> tuple[PipeSize, ...]:
    """Return all pipe sizes (EN 10220 and the user's) by increasing diameter."""
    return catalogue().pipe_sizes()


def pipe_size(outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> PipeSize | None:
    """Return the size with this outside diameter (mm, within ``tolerance``), or None."""
    return catalogue().pipe_size(outer_diameter, tolerance)


def nearest_pipe_size(outer_diameter: float) -> PipeSize:
    """Return the size whose outside diameter (mm) is nearest."""
    return catalogue().nearest_pipe_size(outer_diameter)


def pipe_walls(outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[PipeWall, ...]:
    """Return the walls made for an outside diameter (mm), the thinnest first."""
    return catalogue().pipe_walls(outer_diameter, tolerance)


def bends(outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Bend, ...]:
    """Return the bends 2D, 3D and 5D of an outside diameter (mm) by increasing radius."""
    return catalogue().bends(outer_diameter, tolerance)


def flanges_of_rim(D: float, tolerance: float = RIM_TOLERANCE) -> tuple[FlangeDimensions, ...]:
    """Return the flanges whose outside diameter is within ``tolerance`` (mm) of ``D``, the nearest first."""
    return catalogue().flanges_of_rim(D, tolerance)


def flanges_of_pipe(outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[FlangeDimensions, ...]:
    """Return the flanges that sit on a pipe of an outside diameter (mm), and the blind ones of its DN."""
    return catalogue().flanges_of_pipe(outer_diameter, tolerance)


def equivalents(flange: FlangeDimensions, tolerance: float = SAME_LENGTH) -> tuple[FlangeDimensions, ...]:
    """Return the other flanges that look the same from outside (within ``tolerance``, mm)."""
    return catalogue().equivalents(flange, tolerance)


def tees(run_diameter: float, branch_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Tee, ...]:
    """Return the tees of a run and a branch (outside diameters in mm)."""
    return catalogue().tees(run_diameter, branch_diameter, tolerance)


def reducers(large_diameter: float, small_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Reducer, ...]:
    """Return the reducers between two outside diameters (mm)."""
    return catalogue().reducers(large_diameter, small_diameter, tolerance)


def caps(outer_diameter: float, tolerance: float = DIAMETER_TOLERANCE) -> tuple[Cap, ...]:
    """Return the caps of an outside diameter (mm)."""
    return catalogue().caps(outer_diameter, tolerance)
