# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which kinds of tables there are: a table's kind is the beginning of its file's name."""

from __future__ import annotations

from pipeworkbench.catalogue.insulation_records import (
    InsulationDistance,
    InsulationMaterial,
    InsulationThickness,
    JacketSheet,
    JacketThickness,
    StockThickness,
)
from pipeworkbench.catalogue.records import Bend, Cap, FlangeDimensions, PipeSize, PipeWall, Record, Reducer, Tee

KINDS: dict[str, type[Record]] = {
    "pipes": PipeSize,
    "pipe_walls": PipeWall,
    "bends": Bend,
    "flanges": FlangeDimensions,
    "tees": Tee,
    "reducers": Reducer,
    "caps": Cap,
    "insulation_thickness": InsulationThickness,
    "insulation_stock_thicknesses": StockThickness,
    "insulation_jackets": JacketThickness,
    "insulation_distances": InsulationDistance,
    "insulation_materials": InsulationMaterial,
    "insulation_sheets": JacketSheet,
}
