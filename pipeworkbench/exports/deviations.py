# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviations between a model as designed and the pipework as built, as a table and as CSV."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

from pipeworkbench.files import written_whole
from pipeworkbench.recon.plant import Deviation

COLUMNS = (
    "designed", "built", "kind", "designed_diameter_mm", "built_diameter_mm", "diameter_difference_mm",
    "offset_x_mm", "offset_y_mm", "offset_z_mm", "distance_start_mm", "distance_end_mm", "angle_deg", "remark",
)  # fmt: skip
NOT_BUILT, NOT_DESIGNED = "not seen in the pipework", "not in the model"


def write_deviations(deviations: Sequence[Deviation], path: Path) -> None:
    """Write one line per component; UTF-8 with commas, decimal points and a header."""
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(deviation_row(deviation) for deviation in deviations)


def deviation_row(deviation: Deviation) -> dict[str, object]:
    """Return the cells of one line by their column; what is not known is empty."""
    both = (deviation.designed_diameter, deviation.built_diameter)
    row: dict[str, object] = {
        "designed": deviation.designed_id,
        "built": deviation.built_id,
        "kind": deviation.kind,
        "designed_diameter_mm": both[0],
        "built_diameter_mm": both[1],
        "diameter_difference_mm": None if both[0] is None or both[1] is None else round(both[1] - both[0], 3),
        "angle_deg": deviation.angle_deg,
        "remark": NOT_BUILT if deviation.built_id is None else NOT_DESIGNED if deviation.designed_id is None else "",
    }
    if deviation.offset is not None:
        row |= {f"offset_{axis}_mm": round(value, 3) for axis, value in zip("xyz", deviation.offset, strict=True)}
    row |= {f"distance_{end}_mm": round(value, 3) for end, value in zip(("start", "end"), deviation.distances, strict=False)}
    return {key: "" if value is None else value for key, value in row.items()}
