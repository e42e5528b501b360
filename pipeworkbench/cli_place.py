# SPDX-License-Identifier: LGPL-2.1-or-later
"""`pipeworkbench place`: a pipeline into the plant's coordinates, with a table of how what was built deviates from a model."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import COMMAND_LINE, InputError

if TYPE_CHECKING:
    from pipeworkbench.pipeline import Matrix


def add_parser(commands: Any) -> None:
    """Add the command to a parser's commands."""
    command = commands.add_parser(
        "place",
        help="a pipeline into the plant's coordinates",
        description="Moves a pipeline onto the pipes of an IFC model, or where a typed placement puts it.",
        epilog="What is built may be 100 mm off the model. The placement is kept in the result as georeference.",
    )
    command.add_argument("input", metavar="PIPELINE.json", type=Path)
    where = command.add_mutually_exclusive_group(required=True)
    where.add_argument("--onto", metavar="MODEL.ifc", type=Path, help="a model with the pipes as designed, as IfcPipeSegment")
    where.add_argument(
        "--placement",
        metavar=("X", "Y", "Z", "HEADING"),
        nargs=4,
        type=float,
        help="of the pipeline's origin in the plant (mm), turned about z (degrees)",
    )
    command.add_argument("--deviations", metavar="FILE.csv", type=Path, help="with --onto: as designed beside as built, per component")
    command.add_argument("--out", metavar="FILE", type=Path, action="append", required=True, help="output, may be repeated")
    command.add_argument("--quiet", action="store_true", help="no output")
    add_ifc_schema(command)
    command.set_defaults(run=run)


def add_ifc_schema(command: argparse.ArgumentParser) -> None:
    """Add the option that says which schema IFC is written in."""
    command.add_argument("--ifc-schema", choices=["IFC4", "IFC4X3_ADD2"], default="IFC4", help="of outputs that end in .ifc; default: IFC4")


def run(options: argparse.Namespace) -> int:
    """Place a pipeline and write it."""
    from pipeworkbench.exports.deviations import write_deviations
    from pipeworkbench.exports.writers import Result, check_paths, write
    from pipeworkbench.pipeline import Pipeline
    from pipeworkbench.recon.plant import placed

    inputs = [options.input, *([options.onto] if options.onto else [])]
    check_paths(options.out, has_photographs=False, inputs=inputs)
    if options.deviations is not None and options.onto is None:
        raise InputError(COMMAND_LINE, "--deviations", "compares with a model", "give one with --onto")
    if options.deviations is not None:
        check_paths([options.deviations], inputs=[*inputs, *options.out])
    pipeline = Pipeline.read(options.input)
    said: list[str] = []
    if options.onto is None:
        result = placed(pipeline, _typed(options.placement))
    else:
        from pipeworkbench.exports.ifc_reading import read_ifc_pipes
        from pipeworkbench.recon.plant import placement_on_model

        model = read_ifc_pipes(options.onto)
        found = placement_on_model(pipeline, model.pipeline)
        if found.plant_from_frame is None:
            raise InputError(options.onto, "", *_problem(found.problems))
        result = placed(pipeline, found.plant_from_frame, options.onto.stem)
        distances = [max(one.distances) for one in found.deviations if one.distances]
        said.append(f"{len(distances)} components lie where the model has them, at most {max(distances, default=0.0):.1f} mm off")
        if model.unreadable:
            said.append(f"{model.unreadable} pipe segments of the model could not be read")
        if options.deviations is not None:
            write_deviations(found.deviations, options.deviations)
            said.append(f"written: {options.deviations}")
    for path in options.out:
        write(Result(result, ifc_schema=options.ifc_schema), path)
        said.append(f"written: {path}")
    if not options.quiet:
        print("\n".join(said))
    return 0


def _typed(values: list[float]) -> Matrix:
    """Return the placement (4 x 4) of a typed origin (mm) and heading (degrees)."""
    if not all(map(math.isfinite, values)):
        raise InputError(COMMAND_LINE, "--placement", "is not finite", "give three lengths in mm and an angle in degrees")
    x, y, z, heading = values
    cosine, sine = math.cos(math.radians(heading)), math.sin(math.radians(heading))
    return ((cosine, -sine, 0.0, x), (sine, cosine, 0.0, y), (0.0, 0.0, 1.0, z), (0.0, 0.0, 0.0, 1.0))


def _problem(problems: tuple[str, ...]) -> tuple[str, str]:
    """Return what is wrong and what would help of the sentences that a placement gives."""
    what, _, remedy = (problems[0] if problems else "it fits nowhere; place the pipeline by hand").partition("; ")
    return what, remedy or "place the pipeline by hand with --placement"
