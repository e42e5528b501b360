# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is cut and what must be ordered: cut list, sheet metal, insulation and sheets as CSV and XLSX."""

from __future__ import annotations

import dataclasses
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from pipeworkbench.errors import InputError
from pipeworkbench.exports.sheets import NestedSheet
from pipeworkbench.exports.spreadsheets import Cell, Column, Row, Table, write_csv_rows, write_xlsx
from pipeworkbench.exports.texts import Texts, named, phrased, texts_of
from pipeworkbench.insulation.flat import Pattern
from pipeworkbench.solids.covering_quantities import axis_length, layer_volumes, outer_area
from pipeworkbench.solids.coverings import AnyCovering, BoxCovering, Layer, Sheet, StopCovering, TeeCovering

TEXTS = "cut_lists.texts.json"
MM2, MM3, MM = 1e-6, 1e-9, 1e-3  # in m², m³, m
LENGTH_DIGITS = 1  # of mm; inner diameters that are equal so far are one

CUT_COLUMNS = (
    Column("part"), Column("run"), Column("component"), Column("kind"), Column("material"), Column("thickness_mm", 2), Column("quantity", 0),
    Column("width_mm", 1), Column("height_mm", 1), Column("gross_area_m2", 4), Column("net_area_m2", 4), Column("weight_kg", 3),
    Column("total_area_m2", 4), Column("total_weight_kg", 3), Column("sheets"), Column("remarks"),
)  # fmt: skip
METAL_COLUMNS = (
    Column("material"), Column("thickness_mm", 2), Column("pieces", 0), Column("parts_area_m2", 3), Column("parts_net_area_m2", 3),
    Column("parts_weight_kg", 2), Column("sheet_count", 0), Column("sheet_area_m2", 3), Column("waste_m2", 3), Column("waste_percent", 1),
    Column("sheet_weight_kg", 2), Column("cost", 2),
)  # fmt: skip
INSULATION_COLUMNS = (
    Column("material"), Column("thickness_mm", 1), Column("volume_m3", 4), Column("outer_area_m2", 3), Column("total_weight_kg", 2),
    Column("cost", 2),
)  # fmt: skip
SECTION_COLUMNS = (
    Column("material"), Column("thickness_mm", 1), Column("kind"), Column("inner_diameter_mm", 1), Column("pieces", 0), Column("length_m", 3),
    Column("volume_m3", 4),
)  # fmt: skip
COVERING_COLUMNS = (
    Column("covering"), Column("run"), Column("component"), Column("kind"), Column("material"), Column("thickness_mm", 1),
    Column("inner_diameter_mm", 1), Column("outer_diameter_mm", 1), Column("length_mm", 1), Column("volume_m3", 5), Column("weight_kg", 3),
)  # fmt: skip
SHEET_COLUMNS = (
    Column("number", 0), Column("material"), Column("thickness_mm", 2), Column("width_mm", 1), Column("height_mm", 1), Column("pieces", 0),
    Column("used_percent", 1), Column("sheet_area_m2", 3), Column("sheet_weight_kg", 2),
)  # fmt: skip
MATERIAL_CSV_COLUMNS = (
    Column("list"),
    *{column.key: column for columns in (METAL_COLUMNS, INSULATION_COLUMNS, SECTION_COLUMNS) for column in columns}.values(),
)

Figure = Callable[[str], float | None]  # of a material by its name, None where it is not known


class Insulated(Protocol):
    """A covering and the run it belongs to, as the pieces of a plan are."""

    @property
    def covering(self) -> AnyCovering:
        """What is put around a component."""

    @property
    def run(self) -> str:
        """The name of the run."""


@dataclass(frozen=True)
class CutLists:
    """Rows of all lists by the columns' keys.

    ``cuts`` has one for each part, ``metals`` for each material and thickness of sheet metal, ``insulation`` for each of layers,
    ``coverings`` for each layer around each component, ``sections`` for each kind and inner diameter of them, ``sheets`` for each sheet.
    """

    cuts: tuple[Row, ...]
    metals: tuple[Row, ...]
    insulation: tuple[Row, ...]
    coverings: tuple[Row, ...]
    sections: tuple[Row, ...]
    sheets: tuple[Row, ...]


def cut_lists(
    patterns: Sequence[Pattern],
    sheets: Sequence[NestedSheet] = (),
    pieces: Sequence[Insulated] = (),
    *,
    sheet_density: Figure,
    layer_density: Figure,
    price: Figure = lambda _: None,
) -> CutLists:
    """Return what must be cut and ordered.

    Parameters
    ----------
    patterns : sequence of Pattern
    sheets : sequence of NestedSheet
        The same patterns on sheets; without them numbers of sheets and waste stay empty.
    pieces : sequence of Insulated
        A plan's pieces: their layers are the insulation, their runs those of the parts.
    sheet_density, layer_density : callable
        The density (kg/m³) of sheet metal and of insulation by its name; weights stay empty where it is None.
    price : callable, optional
        What a m² of sheet metal (of whole sheets, where there are any) and a m³ of insulation costs, by its name.

    Raises
    ------
    InputError
        Where there is neither a part nor insulation.
    """
    if not patterns and not pieces:
        raise InputError("the cut list", "", "there is neither a part nor insulation", "insulate at least one component")
    runs = {piece.covering.id: piece.run for piece in pieces}
    coverings = [piece.covering for piece in pieces]
    return CutLists(
        tuple(_cut_row(pattern, sheets, runs, sheet_density) for pattern in patterns),
        _metal_rows(patterns, sheets, sheet_density, price),
        _insulation_rows(coverings, layer_density, price),
        tuple(row for piece in pieces for row in _covering_rows(piece, layer_density)),
        _section_rows(coverings),
        tuple(_sheet_row(sheet, sheet_density) for sheet in sheets),
    )


def write_cut_list_csv(lists: CutLists, path: Path) -> None:
    """Write one line for each part."""
    write_csv_rows(CUT_COLUMNS, lists.cuts, path)


def write_material_list_csv(lists: CutLists, path: Path) -> None:
    """Write one line for each material and thickness of sheet metal and insulation and for each kind and size of sections."""
    groups = {"sheet metal": lists.metals, "insulation": lists.insulation, "section": lists.sections}
    write_csv_rows(MATERIAL_CSV_COLUMNS, [{"list": name, **row} for name, rows in groups.items() for row in rows], path)


def write_cut_list_xlsx(lists: CutLists, path: Path, *, language: str = "en", title: str = "") -> None:
    """Write all lists as one workbook with the worksheets cut list, insulation, materials and sheets.

    Raises
    ------
    InputError
        Where the language is not known.
    MissingPackageError
        Where openpyxl is not installed.
    """
    texts = texts_of(TEXTS, language, "the cut list")

    def table(name: str, columns: Sequence[Column], rows: Iterable[Row], sums: Sequence[str]) -> Table:
        shown = [_in_words(row, texts) for row in rows]
        return Table(texts["tables"][name], columns, texts["columns"], shown, _total(shown, sums, columns[0], texts))

    cuts = table("cuts", CUT_COLUMNS, lists.cuts, ("quantity", "total_area_m2", "total_weight_kg"))
    metal_sums = (
        "pieces",
        "parts_area_m2",
        "parts_net_area_m2",
        "parts_weight_kg",
        "sheet_count",
        "sheet_area_m2",
        "waste_m2",
        "sheet_weight_kg",
        "cost",
    )
    metals = table("metals", METAL_COLUMNS, lists.metals, metal_sums)
    insulation = table("insulation", INSULATION_COLUMNS, lists.insulation, ("volume_m3", "total_weight_kg", "cost"))
    coverings = table("coverings", COVERING_COLUMNS, lists.coverings, ("volume_m3", "weight_kg"))
    sections = table("sections", SECTION_COLUMNS, lists.sections, ("pieces", "volume_m3"))
    sheets = table("sheets", SHEET_COLUMNS, lists.sheets, ("pieces", "sheet_area_m2", "sheet_weight_kg"))
    names = texts["worksheets"]
    worksheets = {"cuts": [cuts], "coverings": [coverings], "materials": [metals, insulation, sections], "sheets": [sheets]}
    write_xlsx({names[key]: tables for key, tables in worksheets.items()}, path, title)


def _in_words(row: Row, texts: Texts) -> Row:
    """Return a row whose kinds, materials and remarks are in the texts' language."""
    words = {key: named(texts, f"{key}s", str(row[key])) for key in ("kind", "material") if key in row}
    if "remarks" in row:
        words["remarks"] = "; ".join(phrased(texts, "remarks", remark) for remark in str(row["remarks"]).split("; "))
    return {**row, **words}


def _total(rows: Sequence[Row], sums: Sequence[str], first: Column, texts: Texts) -> Row | None:
    """Return the row of sums, None where there is nothing to be summed; a sum of which a part is not known is not known either."""
    if len(rows) < 2:
        return None
    total: dict[str, Cell] = {first.key: texts["total"]}
    for key in sums:
        values = [row.get(key) for row in rows]
        numbers = [value for value in values if isinstance(value, int | float)]
        total[key] = sum(numbers) if len(numbers) == len(values) else None
    return total


def _cut_row(pattern: Pattern, sheets: Sequence[NestedSheet], runs: Mapping[str, str], density: Figure) -> Row:
    left, bottom, right, top = pattern.outline.bounds
    weight = _weight(pattern.cut_area * pattern.sheet.thickness, density(pattern.sheet.material))
    numbers = [sheet.number for sheet in sheets if any(part.pattern is pattern for part in sheet.parts)]
    return {
        "part": pattern.id,
        "run": runs.get(pattern.covering, ""),
        "component": pattern.component,
        "kind": pattern.kind,
        "material": pattern.sheet.material,
        "thickness_mm": pattern.sheet.thickness,
        "quantity": pattern.quantity,
        "width_mm": round(right - left, 3),
        "height_mm": round(top - bottom, 3),
        "gross_area_m2": round(pattern.cut_area * MM2, 9),
        "net_area_m2": round(pattern.net_area * MM2, 9),
        "weight_kg": weight,
        "total_area_m2": round(pattern.quantity * pattern.cut_area * MM2, 9),
        "total_weight_kg": None if weight is None else round(pattern.quantity * weight, 6),
        "sheets": ", ".join(map(str, numbers)),
        "remarks": "; ".join(pattern.remarks),
    }


def _weight(volume: float, density: float | None) -> float | None:
    """Return the weight (kg) of a volume (mm³)."""
    return None if density is None else round(volume * MM3 * density, 6)


def _cost(amount: float, price: float | None) -> float | None:
    return None if price is None else round(amount * price, 2)


def _metal_rows(patterns: Sequence[Pattern], sheets: Sequence[NestedSheet], density: Figure, price: Figure) -> tuple[Row, ...]:
    by_sheet: dict[Sheet, list[Pattern]] = defaultdict(list)
    for pattern in patterns:
        by_sheet[pattern.sheet].append(pattern)
    ordered = sorted(by_sheet, key=lambda sheet: (sheet.material, sheet.thickness))
    return tuple(_metal_row(sheet, by_sheet[sheet], [one for one in sheets if one.sheet == sheet], density, price) for sheet in ordered)


def _metal_row(sheet: Sheet, patterns: Sequence[Pattern], cut_from: Sequence[NestedSheet], density: Figure, price: Figure) -> Row:
    gross = sum(pattern.quantity * pattern.cut_area for pattern in patterns)
    row: dict[str, Cell] = {
        "material": sheet.material,
        "thickness_mm": sheet.thickness,
        "pieces": sum(pattern.quantity for pattern in patterns),
        "parts_area_m2": round(gross * MM2, 6),
        "parts_net_area_m2": round(sum(pattern.quantity * pattern.net_area for pattern in patterns) * MM2, 6),
        "parts_weight_kg": _weight(gross * sheet.thickness, density(sheet.material)),
        "cost": _cost(gross * MM2, price(sheet.material)),
    }
    if not cut_from:
        return row
    area = sum(one.size.width * one.size.height for one in cut_from)
    return row | {
        "sheet_count": len(cut_from),
        "sheet_area_m2": round(area * MM2, 6),
        "waste_m2": round((area - gross) * MM2, 6),
        "waste_percent": round(100 * (area - gross) / area, 3),
        "sheet_weight_kg": _weight(area * sheet.thickness, density(sheet.material)),
        "cost": _cost(area * MM2, price(sheet.material)),
    }


def _insulation_rows(coverings: Sequence[AnyCovering], density: Figure, price: Figure) -> tuple[Row, ...]:
    """Return volume, outer area and weight by material and thickness of layers."""
    sums: dict[Layer, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for covering in coverings:
        for number, (layer, volume) in enumerate(zip(covering.layers, layer_volumes(covering), strict=False), 1):
            sums[layer][0] += volume
            sums[layer][1] += outer_area(_first_layers(covering, number))
    return tuple(
        {
            "material": layer.material,
            "thickness_mm": layer.thickness,
            "volume_m3": round(volume * MM3, 9),
            "outer_area_m2": round(area * MM2, 6),
            "total_weight_kg": _weight(volume, density(layer.material)),
            "cost": _cost(volume * MM3, price(layer.material)),
        }
        for layer, (volume, area) in sorted(sums.items(), key=lambda item: (item[0].material, item[0].thickness))
    )


def _first_layers(covering: AnyCovering, number: int) -> AnyCovering:
    """Return a covering with its innermost layers alone."""
    inner = dataclasses.replace(covering, layers=covering.layers[:number], sheet=None)
    if isinstance(covering, BoxCovering) and isinstance(inner, BoxCovering):
        # a box's ends are its outer faces
        missing = covering.total_thickness - inner.total_thickness
        inner = dataclasses.replace(inner, begin=covering.begin + missing, end=covering.end - missing)
    return inner


def _covering_rows(piece: Insulated, density: Figure) -> Iterable[Row]:
    """Yield what each layer of a covering is cut to, from the inside to the outside."""
    covering = piece.covering
    if isinstance(covering, StopCovering):
        return
    for layer, inner, volume in zip(covering.layers, covering.boundaries, layer_volumes(covering), strict=False):
        yield {
            "covering": covering.id,
            "run": piece.run,
            "component": covering.component,
            "kind": covering.kind,
            "material": layer.material,
            "thickness_mm": layer.thickness,
            "inner_diameter_mm": round(2 * (covering.radius + inner), 3),
            "outer_diameter_mm": round(2 * (covering.radius + inner + layer.thickness), 3),
            "length_mm": round(axis_length(covering), 3),
            "volume_m3": round(volume * MM3, 9),
            "weight_kg": _weight(volume, density(layer.material)),
        }


def _section_rows(coverings: Sequence[AnyCovering]) -> tuple[Row, ...]:
    """Return number, length on the axis and volume by material, thickness, kind and inner diameter, which is how they are ordered."""
    sums: dict[tuple[str, float, str, float], list[float]] = defaultdict(lambda: [0.0, 0.0, 0.0])
    for covering in coverings:
        if isinstance(covering, StopCovering):
            continue
        for layer, inner, volume in zip(covering.layers, covering.boundaries, layer_volumes(covering), strict=False):
            for kind, diameter, length, share in _sections(covering, inner, layer.thickness, volume):
                entry = sums[layer.material, layer.thickness, kind, round(diameter, LENGTH_DIGITS)]
                entry[0] += 1
                entry[1] += length
                entry[2] += share
    return tuple(
        {
            "material": material,
            "thickness_mm": thickness,
            "kind": kind,
            "inner_diameter_mm": diameter,
            "pieces": int(number),
            "length_m": round(length * MM, 6),
            "volume_m3": round(volume * MM3, 9),
        }
        for (material, thickness, kind, diameter), (number, length, volume) in sorted(sums.items())
    )


def _sections(covering: AnyCovering, inner: float, thickness: float, volume: float) -> list[tuple[str, float, float, float]]:
    """Return the kind, inner diameter (mm), length (mm) and volume (mm³) of what a covering's layer is made of: of a tee run and branch.

    The layer begins at ``inner`` (mm). A tee's branch is ordered from the run's axis on, so that the saddle can be cut from it; its share
    of the tee's volume is that of its wall.
    """
    diameter = 2 * (covering.radius + inner)
    if not (isinstance(covering, TeeCovering) and covering.reach):
        return [(covering.kind, diameter, axis_length(covering), volume)]
    branch_diameter, run = 2 * (covering.branch_radius + inner), covering.end - covering.begin
    walls = (diameter + thickness) * run, (branch_diameter + thickness) * covering.reach
    branch_volume = volume * walls[1] / sum(walls)
    return [("tee", diameter, run, volume - branch_volume), ("branch", branch_diameter, covering.reach, branch_volume)]


def _sheet_row(sheet: NestedSheet, density: Figure) -> Row:
    area = sheet.size.width * sheet.size.height
    return {
        "number": sheet.number,
        "material": sheet.sheet.material,
        "thickness_mm": sheet.sheet.thickness,
        "width_mm": sheet.size.width,
        "height_mm": sheet.size.height,
        "pieces": len(sheet.parts),
        "used_percent": round(100 * sheet.used, 3),
        "sheet_area_m2": round(area * MM2, 6),
        "sheet_weight_kg": _weight(area * sheet.sheet.thickness, density(sheet.sheet.material)),
    }
