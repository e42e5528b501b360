# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pipeline as a table: CSV for spreadsheets, rows for the terminal."""

from __future__ import annotations

import csv
from pathlib import Path

from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import Pipe, Pipeline

CSV_COLUMNS = (
    "id", "kind", "pick", "station", "standard", "dn", "outer_diameter_mm", "wall_thickness_mm", "verified_sources",
    "length_mm", "start_x_mm", "start_y_mm", "start_z_mm", "end_x_mm", "end_y_mm", "end_z_mm",
    "quality_px", "sigma_x_mm", "sigma_y_mm", "sigma_z_mm", "sigma_direction_deg", "sigma_outer_diameter_mm", "loa", "approximate",
)  # fmt: skip
TERMINAL_COLUMNS = ("pick", "DN", "outside diameter", "length", "quality", "sigma", "remarks")
UNVERIFIED = "dimensions of the standard not verified"


def write_csv(pipeline: Pipeline, path: Path) -> None:
    """Write one line per pipe; UTF-8 with commas, decimal points and a header."""
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(CSV_COLUMNS)
        writer.writerows(_csv_row(pipe) for pipe in pipeline.pipes)


def terminal_row(pipe: Pipe) -> tuple[str, ...]:
    """Return the texts of one line of the table that is printed, as TERMINAL_COLUMNS names them."""
    sigma = "-" if pipe.sigma_position is None else f"{sum(s * s for s in pipe.sigma_position) ** 0.5:.2f} mm"
    remarks = [text for text, true in (("approximate", pipe.approximate), (UNVERIFIED, pipe.verified == 0)) if true]
    return (
        "-" if pipe.pick is None else str(pipe.pick),
        str(pipe.dn or "-"),
        f"{pipe.outer_diameter:.1f} mm",
        f"{pipe.length:.0f} mm",
        "-" if pipe.quality is None else f"{pipe.quality:.2f} px",
        sigma,
        ", ".join(remarks),
    )


def _csv_row(pipe: Pipe) -> list[object]:
    def rounded(values: tuple[float, ...] | None, digits: int = 3) -> list[object]:
        return ["", "", ""] if values is None else [round(value, digits) for value in values]

    row: list[object] = [
        pipe.id, pipe.kind, pipe.pick, pipe.station, pipe.standard, pipe.dn, pipe.outer_diameter, pipe.wall_thickness, pipe.verified,
        round(pipe.length, 3), *rounded(pipe.start), *rounded(pipe.end),
        pipe.quality, *rounded(pipe.sigma_position, 4), pipe.sigma_direction_deg, pipe.sigma_outer_diameter, pipe.loa,
        "yes" if pipe.approximate else "no",
    ]  # fmt: skip
    return ["" if value is None else value for value in row]
