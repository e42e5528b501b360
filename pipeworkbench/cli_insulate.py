# SPDX-License-Identifier: LGPL-2.1-or-later
"""`pipeworkbench insulate`: a pipeline's insulation as solids, cut sheets, lists and coverings, and what it saves."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.cli_place import add_ifc_schema
from pipeworkbench.errors import COMMAND_LINE, InputError, one_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from pipeworkbench.exports.insulation_files import Insulated
    from pipeworkbench.insulation.energy import Energy, Yearly
    from pipeworkbench.insulation.planning import Plan
    from pipeworkbench.insulation.specification import Specification

MOST_SHOWN = 12  # lines of one kind on the terminal
TABLES = {"labels": (".pdf", ".svg", ".csv"), "clashes": (".csv",), "energy": (".csv",)}  # outputs with options of their own
NO_JACKET = "none"
MM2_PER_M2, MM3_PER_M3 = 1e6, 1e9


def add_parser(commands: Any) -> None:
    """Add the command to a parser's commands."""
    command = commands.add_parser(
        "insulate",
        help="insulation of a pipeline: solids, cut sheets, lists, coverings",
        description="Plans the insulation of a pipeline and writes it in the formats of the outputs' endings.",
        epilog="Endings: .dxf (nested cut sheets) .svg .pdf (their preview) .csv .xlsx (cut and material list) .step (solids) "
        ".ifc (pipework with coverings) .pcf (pipework with insulation).",
    )
    command.add_argument("input", metavar="PIPELINE.json", type=Path)
    what = command.add_mutually_exclusive_group(required=True)
    what.add_argument("--thickness", metavar="MM", type=float, help="of one layer on everything")
    what.add_argument("--spec", metavar="FILE.json", type=Path, help="specification: what each component is insulated with (docs/insulation.md)")
    command.add_argument("--material", metavar="NAME", help="with --thickness: the layer's material; default: mineral wool")
    command.add_argument("--jacket", metavar="SHEET", help="with --thickness: the jacket's sheet metal, or none; default: aluminium")
    command.add_argument("--out", metavar="FILE", type=Path, action="append", default=[], help="output, may be repeated")
    command.add_argument("--parts", metavar="DIR", type=Path, help="folder for one DXF file per part")
    command.add_argument("--labels", metavar="FILE", type=Path, help="labels for the parts: .pdf, .svg or .csv")
    command.add_argument("--clashes", metavar="FILE.csv", type=Path, help="table of what is too near to each other")
    command.add_argument("--energy", metavar="FILE.csv", type=Path, help="table of what each component loses in a year, bare and insulated")
    command.add_argument("--medium", metavar="CELSIUS", type=float, help="temperature of what flows in the pipes: tells the heat loss")
    command.add_argument("--price", metavar="MONEY", type=float, help="of a kWh, with --medium")
    command.add_argument("--co2", metavar="KG", type=float, help="of a kWh, with --medium")
    command.add_argument("--leave-out", action="store_true", help="leave bare what cannot be insulated so, instead of refusing all")
    command.add_argument("--quiet", action="store_true", help="no output")
    command.add_argument("--json", action="store_true", help="print a machine-readable summary")
    command.add_argument("--catalogue", metavar="DIR", type=Path, help="folder with CSV tables of your own, which add to the standards'")
    command.add_argument("--language", choices=["en", "de"], default="en", help="of .xlsx, .pdf, .svg and labels; default: en")
    add_ifc_schema(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Plan the insulation of a pipeline and write it."""
    from pipeworkbench.exports.insulation_files import Insulated, refuse_unwritable
    from pipeworkbench.insulation.energy import energy_of_plan
    from pipeworkbench.insulation.planning import plan
    from pipeworkbench.pipeline import Pipeline

    began = time.perf_counter()
    _check_outputs(options)
    pipeline, specification = Pipeline.read(options.input), _specification(options)
    planned = plan(pipeline, specification)
    left_out: list[InputError] = []
    if options.leave_out:
        planned, left_out = _without_what_does_not_fit(planned)
    planned.check()
    made, energy = Insulated(planned, options.language, options.ifc_schema), energy_of_plan(planned)
    if options.energy is not None and energy is None:
        raise InputError(
            COMMAND_LINE, "--energy", "needs the temperature of what flows in the pipes", "give --medium, or operation in the specification"
        )
    if energy is None and (options.price is not None or options.co2 is not None):
        name = "--co2" if options.price is None else "--price"
        raise InputError(COMMAND_LINE, name, "tells nothing without the temperature of what flows in the pipes", "give --medium, or leave it out")
    files = [path for path in (*options.out, options.labels, options.clashes, options.energy) if path is not None]
    refuse_unwritable(made, files, options.labels, options.parts)
    outputs = _written(options, made, energy)
    seconds = time.perf_counter() - began
    if options.json:
        print(json.dumps(_summary(made, energy, left_out, outputs) | {"seconds": round(seconds, 2)}))
    elif not options.quiet:
        print("\n".join([*_told(made, energy, left_out), *(f"written: {path}" for path in outputs), f"{seconds:.1f} s"]))
    return 0


def _without_what_does_not_fit(planned: Plan) -> tuple[Plan, list[InputError]]:
    """Return the plan in which what cannot be insulated or cut stays bare, and why."""
    from pipeworkbench.exports.insulation_files import cutting_problems

    left_out: list[InputError] = []
    while problems := planned.problems or cutting_problems(planned):
        if planned.left_bare.issuperset(problem.source for problem in problems):
            break  # what is bare already cannot be mended so
        left_out += problems
        planned = planned.without(problems)
    return planned, left_out


def _check_outputs(options: argparse.Namespace) -> None:
    """Refuse, before anything is computed, what could not be written."""
    from pipeworkbench.exports.insulation_files import WRITERS
    from pipeworkbench.exports.writers import check_paths

    kept = [options.input, *([options.spec] if options.spec else [])]
    check_paths(options.out, inputs=kept, endings=tuple(WRITERS))
    outputs = list(options.out)
    for name, endings in TABLES.items():
        path = getattr(options, name)
        if path is not None:
            check_paths([path], inputs=kept, endings=endings, outputs=outputs)
            outputs.append(path)
    if options.parts is not None and options.parts.exists() and not options.parts.is_dir():
        raise InputError(options.parts, "", "is a file", "name a folder for the parts")


def _specification(options: argparse.Namespace) -> Specification:
    """Return the specification that the options name or are."""
    from pipeworkbench.insulation.materials import DEFAULT_MATERIAL, DEFAULT_SHEET
    from pipeworkbench.insulation.specification import Specification

    if options.spec is None:
        sheet = DEFAULT_SHEET if options.jacket is None else options.jacket
        jacket = None if sheet.strip().casefold() == NO_JACKET else sheet
        found = Specification.uniform(options.thickness, DEFAULT_MATERIAL if options.material is None else options.material, jacket)
    else:
        for name in ("material", "jacket"):
            if getattr(options, name) is not None:
                raise InputError(COMMAND_LINE, f"--{name}", "goes with --thickness", "leave it out, or name it in the specification")
        found = Specification.read(options.spec)
    given = {"medium_temperature": options.medium, "price_per_kwh": options.price, "kg_co2_per_kwh": options.co2}
    return found.with_operation({name: value for name, value in given.items() if value is not None}, COMMAND_LINE)


def _written(options: argparse.Namespace, made: Insulated, energy: Energy | None) -> list[Path]:
    """Write all outputs and return their paths."""
    from pipeworkbench.exports.dxf import write_parts
    from pipeworkbench.exports.insulation_files import write, write_labels
    from pipeworkbench.exports.insulation_tables import write_clashes, write_energy

    for path in options.out:
        write(made, path)
    if options.labels is not None:
        write_labels(made, options.labels)
    if options.clashes is not None:
        write_clashes(made.plan, options.clashes)
    if options.energy is not None and energy is not None:
        write_energy(energy, options.energy)
    if options.parts is not None:
        write_parts(made.patterns, options.parts)
    return [*options.out, *(path for path in (options.labels, options.clashes, options.energy, options.parts) if path is not None)]


def _summary(made: Insulated, energy: Energy | None, left_out: Sequence[InputError], outputs: Sequence[Path]) -> dict[str, Any]:
    plan = made.plan
    return {
        "pieces": len(plan.pieces),
        "parts": sum(pattern.quantity for pattern in made.patterns),
        "sheets": len(made.sheets),
        "volume_m3": round(_volume(plan) / MM3_PER_M3, 4),
        "bare": list(plan.bare),
        "left_out": [str(problem) for problem in left_out],
        "clashes": [{"a": one.a, "b": one.b, "distance_mm": round(one.distance, 1), "resolved": one.resolved} for one in plan.clashes],
        "remarks": list(plan.remarks),
        "energy": None if energy is None else {"bare": vars(energy.bare), "insulated": vars(energy.insulated), "saved": vars(energy.saved)},
        "outputs": [str(path) for path in outputs],
    }


def _told(made: Insulated, energy: Energy | None, left_out: Sequence[InputError]) -> list[str]:
    """Return what a person is told."""
    plan = made.plan
    area = sum(pattern.outline.area * pattern.quantity for pattern in made.patterns) / MM2_PER_M2
    count = sum(pattern.quantity for pattern in made.patterns)
    lines = [
        f"{len(plan.pieces)} coverings, {_volume(plan) / MM3_PER_M3:.3f} m³ of insulation, components that stay bare: {len(plan.bare)}",
        f"{count} parts of sheet metal, {area:.2f} m² on {len(made.sheets)} sheets",
    ]
    lines += _some("Left bare", (str(problem) for problem in left_out))
    lines += _some("Too near", (_near(one.a, one.b, one.distance, one.resolved) for one in plan.clashes))
    lines += _some("Note", plan.remarks)
    if energy is not None:
        money = " and ".join(sorted({row.currency for row in energy.rows}))
        lines += [f"{name}: {_year(year, money)}" for name, year in (("Bare", energy.bare), ("Insulated", energy.insulated), ("Saved", energy.saved))]
    return lines


def _some(head: str, texts: Iterable[str]) -> list[str]:
    """Return a line for each text, and one that counts those that are too many."""
    all_texts = list(texts)
    lines = [f"{head}: {one_line(text)}" for text in all_texts[:MOST_SHOWN]]
    return [*lines, f"{head}: {len(all_texts) - MOST_SHOWN} more"] if len(all_texts) > MOST_SHOWN else lines


def _near(one: str, other: str, distance: float, resolved: str) -> str:
    how = f"{max(distance, 0.0):.0f} mm apart" if distance > -0.5 else f"{-distance:.0f} mm into each other"
    return f"{one} and {other}: {how}{', ' + resolved if resolved else ''}"


def _year(year: Yearly, money: str) -> str:
    parts = [f"{year.heat:.0f} W", f"{year.energy:.0f} kWh a year"]
    parts += [] if year.cost is None else [f"{year.cost:.0f} {money} a year"]
    parts += [] if year.co2 is None else [f"{year.co2:.0f} kg CO2 a year"]
    return ", ".join(parts)


def _volume(plan: Plan) -> float:
    """Return the volume (mm³) of all layers without jackets."""
    from pipeworkbench.solids.covering_quantities import layer_volumes

    return sum(volume for piece in plan.pieces for volume, _ in zip(layer_volumes(piece.covering), piece.covering.layers, strict=False))
