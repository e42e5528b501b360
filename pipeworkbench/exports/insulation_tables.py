# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of an insulation: where it is too near to something, and what heat it saves."""

from __future__ import annotations

from pathlib import Path

from pipeworkbench.exports.spreadsheets import Column, Row, write_csv_rows
from pipeworkbench.insulation.energy import Energy, EnergyRow
from pipeworkbench.insulation.planning import Plan

CLASH_COLUMNS = tuple(
    Column(key) for key in ("a", "b", "distance_mm", "least_mm", "resolved", "largest_thickness_a_mm", "largest_thickness_b_mm", "x", "y", "z")
)
YEARLY = ("heat_w", "energy_kwh_a", "cost_a", "co2_kg_a")
STATES = ("bare", "insulated", "saved")
ENERGY_COLUMNS = (
    *(Column(key) for key in ("component", "run", "kind", "outer_diameter_mm", "length_m", "thickness_mm", "medium_c")),
    *(Column(key) for key in ("bare_surface_c", "surface_c", "currency")),
    *(Column(f"{state}_{key}") for state in STATES for key in YEARLY),
    Column("remarks"),
)


def write_clashes(plan: Plan, path: Path) -> None:
    """Write a line for each pair of finished surfaces that are nearer than the least distance; a negative distance is a depth."""
    rows: list[Row] = []
    for clash in plan.clashes:
        x, y, z = (round(value, 1) for value in clash.point)
        row: Row = {
            "a": clash.a,
            "b": clash.b,
            "distance_mm": round(clash.distance, 1),
            "least_mm": clash.least,
            "resolved": clash.resolved,
            "largest_thickness_a_mm": _rounded(clash.largest_a),
            "largest_thickness_b_mm": _rounded(clash.largest_b),
        }
        rows.append({**row, "x": x, "y": y, "z": z})
    write_csv_rows(CLASH_COLUMNS, rows, path)


def write_energy(energy: Energy, path: Path) -> None:
    """Write a line for each component: what it loses in a year bare and insulated, and what that saves."""
    write_csv_rows(ENERGY_COLUMNS, [_energy_row(row) for row in energy.rows], path)


def _energy_row(row: EnergyRow) -> Row:
    cells: dict[str, str | float | None] = {
        "component": row.component,
        "run": row.run,
        "kind": row.kind,
        "outer_diameter_mm": row.outer_diameter,
        "length_m": round(row.length, 3),
        "thickness_mm": row.thickness,
        "medium_c": row.medium_temperature,
        "bare_surface_c": _rounded(row.bare_surface_temperature),
        "surface_c": _rounded(row.surface_temperature),
        "currency": row.currency,
        "remarks": ", ".join(row.remarks),
    }
    for state, year in zip(STATES, (row.bare, row.insulated, row.saved), strict=True):
        values = (year.heat, year.energy, year.cost, year.co2)
        cells |= {f"{state}_{key}": _rounded(value, 2) for key, value in zip(YEARLY, values, strict=True)}
    return cells


def _rounded(value: float | None, digits: int = 1) -> float | None:
    return None if value is None else round(value, digits)
