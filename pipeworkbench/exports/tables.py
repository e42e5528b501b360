# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pipeline as a table: CSV for spreadsheets, rows for the terminal."""

from __future__ import annotations

import csv
from pathlib import Path

from pipeworkbench.exports.kinds import designation, equivalents_text
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee

CSV_COLUMNS = (
    "id", "kind", "pick", "station", "standard", "dn", "outer_diameter_mm", "wall_thickness_mm", "verified_sources",
    "length_mm", "start_x_mm", "start_y_mm", "start_z_mm", "end_x_mm", "end_y_mm", "end_z_mm",
    "quality_px", "sigma_x_mm", "sigma_y_mm", "sigma_z_mm", "sigma_direction_deg", "sigma_outer_diameter_mm", "loa", "approximate",
    "type", "pn", "bend_angle_deg", "bend_radius_mm", "second_diameter_mm", "D_mm", "C_mm", "K_mm", "L_mm", "bolts",
    "nearest_standard", "gaps_mm", "remarks",
)  # fmt: skip
TERMINAL_COLUMNS = ("pick", "DN", "outside diameter", "length", "quality", "sigma", "remarks")
UNVERIFIED = "dimensions of the standard not verified"


def write_csv(pipeline: Pipeline, path: Path) -> None:
    """Write one line per component; UTF-8 with commas, decimal points and a header.

    Start and end are the component's first two ports (a flange's face and weld end), the length runs along its axis.
    """
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, CSV_COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(_csv_row(component) for component in pipeline.components)


def terminal_row(component: AnyComponent) -> tuple[str, ...]:
    """Return the texts of one line of the table that is printed, as TERMINAL_COLUMNS names them.

    What is not a pipe says so first in its remarks.
    """
    sigma = "-" if component.sigma_position is None else f"{sum(s * s for s in component.sigma_position) ** 0.5:.2f} mm"
    said = remarks(component)
    return (
        "-" if component.pick is None else str(component.pick),
        str(component.dn or "-"),
        f"{component.outer_diameter:.1f} mm",
        f"{component.length:.0f} mm",
        "-" if component.quality is None else f"{component.quality:.2f} px",
        sigma,
        ", ".join(said if isinstance(component, Pipe) else [designation(component), *said]),
    )


def remarks(component: AnyComponent) -> list[str]:
    """Return what a reader must know before he trusts a component's figures."""
    said = []
    if isinstance(component, Pipe) and component.approximate:
        said.append("approximate")
    if component.verified == 0:
        said.append(UNVERIFIED)
    if isinstance(component, Pipe) and component.nearest_standard:
        said.append(f"within 3 sigma of {component.nearest_standard}")
    if isinstance(component, Pipe) and component.gaps:
        said.append(f"bridged at {', '.join(f'{start:.0f}-{end:.0f}' for start, end in component.gaps)} mm")
    if isinstance(component, Flange) and component.equivalents:
        said.append(f"same dimensions as {equivalents_text(component)}")
    return said


def _csv_row(component: AnyComponent) -> dict[str, object]:
    def rounded(name: str, values: tuple[float, ...] | None, digits: int = 3) -> dict[str, object]:
        return {} if values is None else {f"{name}_{axis}_mm": round(value, digits) for axis, value in zip("xyz", values, strict=True)}

    row: dict[str, object] = {
        "id": component.id,
        "kind": component.kind,
        "pick": component.pick,
        "station": component.station,
        "standard": component.standard,
        "dn": component.dn,
        "outer_diameter_mm": component.outer_diameter,
        "wall_thickness_mm": component.wall_thickness,
        "verified_sources": component.verified,
        "length_mm": round(component.length, 3),
        "quality_px": component.quality,
        "sigma_direction_deg": component.sigma_direction_deg,
        "loa": component.loa,
        "remarks": ", ".join(remarks(component)),
    }
    row |= _dimensions(component) | rounded("sigma", component.sigma_position, 4)
    for name, port in zip(("start", "end"), component.ports[:2], strict=False):
        row |= rounded(name, port.point)
    return {key: "" if value is None else value for key, value in row.items()}


def _dimensions(component: AnyComponent) -> dict[str, object]:
    """Return the cells that only some kinds have."""
    match component:
        case Pipe():
            return {
                "sigma_outer_diameter_mm": component.sigma_outer_diameter,
                "approximate": "yes" if component.approximate else "no",
                "nearest_standard": component.nearest_standard,
                "gaps_mm": " ".join(f"{start:g}-{end:g}" for start, end in component.gaps or ()),
            }
        case Elbow():
            return {"type": component.bend_type, "bend_angle_deg": round(component.angle_deg, 4), "bend_radius_mm": component.bend_radius}
        case Flange():
            letters: dict[str, object] = {f"{letter}_mm": getattr(component, letter) for letter in "DCKL"}
            return letters | {"type": component.flange_type, "pn": component.pn, "bolts": component.bolts}
        case Tee():
            return {"type": component.tee_type, "second_diameter_mm": component.branch_diameter}
        case Reducer():
            return {"type": component.reducer_type, "second_diameter_mm": component.end_diameter}
        case Cap():
            return {}
