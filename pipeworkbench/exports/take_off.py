# SPDX-License-Identifier: LGPL-2.1-or-later
"""The take-off of the pipework: how much there is of each item, as estimating software and purchasing take it.

An item is what is bought alike: pipes of one diameter, wall, standard and material are one whatever their lengths; fittings are
one where their dimensions are, measured angles rounded to whole degrees. Weights are those of pipes and elbows of steel whose wall
is known, from its section and 7850 kg/m³. Gaskets and bolts are counted where the faces of two flanges are joined.
"""

from __future__ import annotations

import csv
import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from pipeworkbench.exports.bolting import BoltedJoint, bolted_joints
from pipeworkbench.exports.ifc_properties import material_of, quantities
from pipeworkbench.exports.kinds import designation
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import AnyComponent, Elbow, Pipe, Pipeline

ENDING = ".csv"  # of the files' names
COLUMNS = (
    "item", "kind", "description", "dn", "outer_diameter_mm", "wall_thickness_mm", "standard", "material",
    "quantity", "unit", "pieces", "length_m", "weight_kg", "components",
)  # fmt: skip
DIAMETER_DIGITS = 1  # decimals of mm in which measured diameters are taken for one
PIECES, METRES = "pcs", "m"
MM_PER_M = 1000.0


@dataclass(frozen=True)
class Item:
    """What is bought alike; lengths are mm, what is not known is None."""

    kind: str
    description: str
    dn: int | None = None
    outer_diameter: float | None = None
    wall_thickness: float | None = None
    standard: str | None = None
    material: str | None = None


def item_of(component: AnyComponent) -> Item:
    """Return what a component counts as."""
    shown = component
    if isinstance(component, Elbow):
        shown = dataclasses.replace(component, angle_deg=max(1.0, round(component.angle_deg)), bend_radius=round(component.bend_radius, 1))
    shown = dataclasses.replace(shown, outer_diameter=round(component.outer_diameter, DIAMETER_DIGITS))
    size = shown.dn, shown.outer_diameter, shown.wall_thickness
    return Item(component.kind, designation(shown), *size, component.standard, material_of(component))


def gasket_of(joint: BoltedJoint) -> Item:
    """Return the gasket of two flanges."""
    return Item("gasket", f"Gasket {_flange_size(joint)}, {joint.gap:.1f} mm", joint.a.dn)


def bolts_of(joint: BoltedJoint) -> Item | None:
    """Return the bolts of two flanges, None where they are not known."""
    bolts = joint.bolts
    return None if bolts is None else Item("bolt", f"Bolt M{bolts.diameter:g} x {bolts.length:g} with nut")


def write_take_off(pipeline: Pipeline, path: Path) -> None:
    """Write one line per item; UTF-8 with commas, decimal points and a header.

    ``quantity`` is metres of pipes and the number of everything else, as ``unit`` says; ``length_m`` runs along the axes of pipes and
    elbows; ``components`` are the ids of what was counted, parted by blanks.
    """
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(take_off_rows(pipeline))


def take_off_rows(pipeline: Pipeline) -> list[dict[str, object]]:
    """Return the cells of each line by their column, in the order in which items first come; what is not known is empty."""
    counted: dict[Item, list[AnyComponent]] = {}
    for component in pipeline.components:
        counted.setdefault(item_of(component), []).append(component)
    rows = [_row(item, components) for item, components in counted.items()]
    between: dict[Item, list[tuple[int, str]]] = {}
    for joint in bolted_joints(pipeline):
        for item, count in _between(joint):
            between.setdefault(item, []).append((count, f"{joint.a.id} {joint.b.id}"))
    rows += [_cells(item, sum(count for count, _ in found), PIECES, [name for _, name in found]) for item, found in between.items()]
    return [{"item": number} | row for number, row in enumerate(rows, 1)]


def _between(joint: BoltedJoint) -> Iterator[tuple[Item, int]]:
    """Yield what is between two flanges and how many of it."""
    if joint.has_gasket:
        yield gasket_of(joint), 1
    bolts, item = joint.bolts, bolts_of(joint)
    if bolts is not None and item is not None:
        yield item, bolts.count


def _row(item: Item, components: list[AnyComponent]) -> dict[str, object]:
    """Return the cells of components that are one item."""
    length = sum(component.length for component in components if isinstance(component, Pipe | Elbow)) / MM_PER_M
    is_pipe = item.kind == Pipe.kind
    row = _cells(item, round(length, 3) if is_pipe else len(components), METRES if is_pipe else PIECES, [one.id for one in components])
    row["pieces"] = len(components)
    weights = [quantities(component)[1].get("NetWeight") for component in components]
    known = [value for _, value in filter(None, weights)]
    if length:
        row["length_m"] = round(length, 3)
    if len(known) == len(components):
        row["weight_kg"] = round(sum(known), 3)
    return row


def _cells(item: Item, quantity: float, unit: str, names: list[str]) -> dict[str, object]:
    """Return the cells that all items have."""
    cells: dict[str, object] = {
        "kind": item.kind,
        "description": item.description,
        "dn": item.dn,
        "outer_diameter_mm": item.outer_diameter,
        "wall_thickness_mm": item.wall_thickness,
        "standard": item.standard,
        "material": item.material,
        "quantity": quantity,
        "unit": unit,
        "components": " ".join(names),
    }
    return {key: "" if value is None else value for key, value in cells.items()}


def _flange_size(joint: BoltedJoint) -> str:
    size = f"DN {joint.a.dn}" if joint.a.dn else f"{joint.a.outer_diameter:g} mm"
    return f"{size}, PN {joint.a.pn:g}"
