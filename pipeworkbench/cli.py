# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: the workbench's jobs without FreeCAD's window.

Exit status 0 done; 2 bad input, one line on stderr that names the file and what to do; 1 a defect.
"""

from __future__ import annotations

import argparse
import io
import json
import logging
import math
import re
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from pipeworkbench import __version__, cli_insulate, cli_place
from pipeworkbench.catalogue import using_folder
from pipeworkbench.errors import COMMAND_LINE, InputError, PipeWorkbenchError, one_line

if TYPE_CHECKING:
    from rich.console import Console

    from pipeworkbench.exports.writers import Result
    from pipeworkbench.pipeline import Pipeline
    from pipeworkbench.recon.adjust import AdjustmentSettings, Solution
    from pipeworkbench.recon.pick_settings import PickSettings
    from pipeworkbench.recon.picks import Picks
    from pipeworkbench.recon.reconstruct import Alternative, Reconstruction
    from pipeworkbench.recon.station import Station
    from pipeworkbench.recon.together import Together

SMALLEST_MM, LARGEST_MM, NEAREST_MM = 1.0, 200_000.0, 200.0  # of ranges that make sense
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0}  # in mm
BASES_SHOWN = 5
REASONS_SHOWN = 3  # in the one line that says that all picks failed
MOST_LISTED = 6  # alternatives; as many as a pick may name (recon.picks, which is loaded late)
DONE, BAD_INPUT = 0, 2  # 1 is what Python exits with after an exception nobody expected


class _Parser(argparse.ArgumentParser):
    """A parser that reports a wrong call in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status."""
    # a terminal that cannot show a name must not end the program
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    parser = _parser()
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.ERROR if options.quiet else logging.WARNING, format="%(levelname)s: %(message)s")
    try:
        with using_folder(getattr(options, "catalogue", None)):
            return int(options.run(options))
    except PipeWorkbenchError as error:
        print(f"pipeworkbench: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("pipeworkbench: interrupted; nothing half-written was left", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="pipeworkbench", description="As-built pipelines from photographs.")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    command = commands.add_parser(
        "reconstruct",
        help="pipes from a station's photographs, picked or not",
        description="Reconstructs the pipes of a station, picked or found by themselves, and writes them in the formats of the outputs' endings.",
        epilog="Endings: .json .csv .ifc .step .pcf .FCStd .png .html. Lengths are mm in the station's level frame.",
    )
    command.add_argument("station", metavar="STATION_DIR", type=Path, nargs="+", help="folder with station.json (or that file); several are merged")
    command.add_argument(
        "--picks", metavar="FILE", type=Path, action="append", help="picks.json, once per station; default: the one beside station.json"
    )
    command.add_argument("--auto", action="store_true", help="find the pipes without picks; most, not all of them: look at the .png")
    command.add_argument("--flanges", action="store_true", help="with --auto: look for flanges along the pipes, too; takes some seconds more")
    command.add_argument("--out", metavar="FILE", type=Path, action="append", required=True, help="output, may be repeated")
    _add_take_off(command)
    command.add_argument("--working-range", metavar=("NEAR", "FAR"), nargs=2, type=float, help="distances of the pipes from the rig in mm")
    command.add_argument("--diameters", metavar=("FROM", "TO"), nargs=2, type=float, help="outside diameters to consider in mm")
    command.add_argument("--alternatives", metavar="N", type=int, default=1, help=f"list up to N ranked answers per pick (at most {MOST_LISTED})")
    command.add_argument("--no-adjustment", action="store_true", help="leave out the common adjustment: every component stays as it was found")
    command.add_argument("--tolerance", action="store_true", help="standard sizes may deviate by their tolerances; default: they are exact")
    command.add_argument("--aligned", action="store_true", help="runs that are nearly level, plumb or square are taken to be so, with little weight")
    command.add_argument("--quiet", action="store_true", help="no table, no progress, no warnings")
    command.add_argument("--json", action="store_true", help="print a machine-readable summary instead of the table")
    _add_catalogue(command)
    _add_language(command)
    cli_place.add_ifc_schema(command)
    command.set_defaults(run=_reconstruct)
    _add_convert(commands)
    return parser


def _add_convert(commands: argparse._SubParsersAction[_Parser]) -> None:
    command = commands.add_parser(
        "convert",
        help="a rig of another program to station.json; a pipeline to other formats",
        description="Writes the station.json of a rig from OpenCV, COLMAP, Metashape or Kalibr, or a pipeline in the formats of the "
        "outputs' endings.",
        epilog="Photographs whose names the input gives are looked up beside it and in folders 'images' around it.",
    )
    command.add_argument("input", metavar="INPUT", type=Path, help="calibration file, folder of a COLMAP model, or pipeline JSON")
    command.add_argument("--out", metavar="FILE", type=Path, action="append", required=True, help="output; may be repeated for a pipeline")
    _add_take_off(command)
    command.add_argument("--format", choices=["opencv", "colmap", "metashape", "kalibr"], help="default: recognised by the content")
    command.add_argument("--images", metavar="FILE", type=Path, nargs="+", help="the photographs, one per camera in the cameras' order")
    command.add_argument("--image-folder", metavar="DIR", type=Path, help="where the photographs lie that the input names")
    length = command.add_mutually_exclusive_group()
    length.add_argument("--unit", choices=list(UNITS), help="the input's unit of length, where the format does not define it")
    length.add_argument("--scale", metavar="FACTOR", type=float, help="millimetres per unit of the input")
    command.add_argument("--up", metavar=("X", "Y", "Z"), nargs=3, type=float, help="upward vertical in the input's world")
    command.add_argument("--cameras", metavar="NAME", nargs="+", help="cameras to take, in this order; the first is the reference")
    command.add_argument("--name", help="name of the station; default: that of its folder")
    command.add_argument("--quiet", action="store_true", help="no output, no warnings")
    _add_catalogue(command)
    _add_language(command)
    cli_place.add_ifc_schema(command)
    command.set_defaults(run=_convert)
    cli_place.add_parser(commands)
    cli_insulate.add_parser(commands)


def _add_catalogue(command: argparse.ArgumentParser) -> None:
    command.add_argument("--catalogue", metavar="DIR", type=Path, help="folder with CSV tables of your own, which add to the standards'")


def _add_take_off(command: argparse.ArgumentParser) -> None:
    command.add_argument("--takeoff", metavar="FILE.csv", type=Path, help="take-off list of the pipeline: a line per item with its quantity")


def _add_language(command: argparse.ArgumentParser) -> None:
    command.add_argument("--language", choices=["en", "de"], default="en", help="of the report (.html); default: en")


def _reconstruct(options: argparse.Namespace) -> int:
    from pipeworkbench.recon.station import read_station

    began = time.perf_counter()
    _check_outputs(options)
    _check_together(options)
    stations = [read_station(path) for path in options.station]
    files = options.picks or [station.source.parent / "picks.json" for station in stations]
    _check_outputs(options, inputs=[path for station in stations for path in (station.source, *station.images)] + files)
    picks = None if options.auto else [_picks_of(file, station) for file, station in zip(files, stations, strict=True)]
    found, separate = _found(options, stations, picks)
    if not found.pipeline.components:
        if options.json:
            print(json.dumps(_summary(found, (), time.perf_counter() - began)))
        raise _nothing_found(found, stations[0].source if picks is None else files[0], auto=picks is None)
    outputs = _written(options, found.pipeline, separate, stations)
    seconds = time.perf_counter() - began
    if options.json:
        print(json.dumps(_summary(found, outputs, seconds)))
    elif not options.quiet:
        _print_table(found, outputs, seconds)
    return DONE


def _found(options: argparse.Namespace, stations: Sequence[Station], picks: Sequence[Picks] | None) -> tuple[Reconstruction, tuple[Pipeline, ...]]:
    """Return what is in the images, and the stations that could not be merged."""
    from pipeworkbench.recon.reconstruct import reconstruct, reconstruct_without_picks
    from pipeworkbench.recon.together import reconstruct_together

    settings, adjustment = _settings_of(options, picks), _adjustment_of(options)
    with _Progress(show=not options.quiet and not options.json) as progress:
        if len(stations) > 1:
            merged = reconstruct_together(stations, picks, settings, progress, flanges=options.flanges, adjustment=adjustment)
            return _as_one(merged), merged.separate
        if picks is None:
            return reconstruct_without_picks(stations[0], settings, progress, flanges=options.flanges, adjustment=adjustment), ()
        return reconstruct(stations[0], picks[0], settings, progress, options.alternatives, adjustment=adjustment), ()


def _written(options: argparse.Namespace, pipeline: Pipeline, separate: Sequence[Pipeline], stations: Sequence[Station]) -> list[Path]:
    """Write the pipeline, and beside it, so that nothing is lost, those of stations that could not be merged."""
    from pipeworkbench.exports.writers import Result
    from pipeworkbench.pipeline import free_id

    outputs = _outputs_of(options)
    for path in list(outputs):
        _write(options, Result(pipeline, tuple(stations), options.language, options.ifc_schema), path, path)
    for one in separate:
        # a station may be called what no file can be
        name = re.sub(r"[^\w.-]", "_", one.frame)
        for path in _outputs_of(options):
            own = path.with_stem(free_id(f"{path.stem}-{name}", {other.stem for other in outputs if other.suffix == path.suffix}))
            _write(options, Result(one, tuple(stations), options.language, options.ifc_schema), path, own)
            outputs.append(own)
    return outputs


def _outputs_of(options: argparse.Namespace) -> list[Path]:
    """Return all files that are to be written."""
    return [*options.out, *([] if options.takeoff is None else [options.takeoff])]


def _check_outputs(options: argparse.Namespace, *, has_photographs: bool = True, inputs: Sequence[Path] = ()) -> None:
    """Refuse outputs that could not be written."""
    from pipeworkbench.exports.take_off import ENDING
    from pipeworkbench.exports.writers import check_paths

    if options.takeoff is not None:
        check_paths([options.takeoff], endings=(ENDING,))
    check_paths(_outputs_of(options), has_photographs=has_photographs, inputs=inputs)


def _write(options: argparse.Namespace, result: Result, asked: Path, path: Path) -> None:
    """Write a result in the way that is asked for with an output of the options."""
    from pipeworkbench.exports.take_off import write_take_off
    from pipeworkbench.exports.writers import write

    if asked == options.takeoff:
        write_take_off(result.pipeline, path)
    else:
        write(result, path)


def _as_one(merged: Together) -> Reconstruction:
    """Return several stations' reconstruction as if it were one station's; failed picks say whose they are."""
    failed = [pick._replace(reason=f"{name}: {pick.reason}") for name, station in merged.stations.items() for pick in station.failed_picks]
    first = next(iter(merged.stations.values()))
    return replace(first, pipeline=merged.pipeline, failed_picks=tuple(failed), warnings=merged.warnings, adjustment=merged.adjustment)


def _adjustment_of(options: argparse.Namespace) -> AdjustmentSettings | None:
    from pipeworkbench.recon.adjust import AdjustmentSettings

    if options.no_adjustment:
        return None
    return AdjustmentSettings(sizes="tolerance" if options.tolerance else "exact", aligned=options.aligned)


def _check_together(options: argparse.Namespace) -> None:
    """Refuse options that do not go with each other."""
    if options.auto and options.picks is not None:
        raise InputError(COMMAND_LINE, "--auto", "finds the pipes without picks, and --picks names some", "give one of the two")
    if options.flanges and not options.auto:
        raise InputError(COMMAND_LINE, "--flanges", "goes with --auto: flanges of picked pipes are picked, too", "leave it out, or give --auto")
    if options.picks is not None and len(options.picks) != len(options.station):
        raise InputError(
            COMMAND_LINE, "--picks", f"is given {len(options.picks)} times for {len(options.station)} stations", "give it once per station"
        )
    if options.no_adjustment and (options.tolerance or options.aligned):
        raise InputError(COMMAND_LINE, "--no-adjustment", "leaves out what --tolerance and --aligned are for", "give one or the other")
    if len(options.station) > 1 and options.alternatives > 1:
        raise InputError(COMMAND_LINE, "--alternatives", "ranks what one station's picks can mean", "name one station")
    if not 1 <= options.alternatives <= MOST_LISTED:
        raise InputError(COMMAND_LINE, "--alternatives", f"is {options.alternatives}", f"give a number from 1 to {MOST_LISTED}")
    if options.auto and options.alternatives > 1:
        raise InputError(COMMAND_LINE, "--alternatives", "ranks what picks can mean, and --auto has none", "leave one of the two out")


def _nothing_found(found: Reconstruction, file: Path, *, auto: bool) -> InputError:
    what = "the calibration belongs to the photographs and that working range and diameters hold the pipes"
    if auto:
        return InputError(file, "cameras", "no pipe was found in the photographs", f"check that {what}, or pick the pipes")
    why = "; ".join(f"pick {failed.pick}: {failed.reason}" for failed in found.failed_picks[:REASONS_SHOWN])
    return InputError(file, "picks", f"no pipe fits the images ({why})", f"check that the picks are on pipe edges, that {what}")


def _picks_of(file: Path, station: Station) -> Picks:
    from pipeworkbench.recon.picks import read_picks

    picks = read_picks(file, station)
    if not picks.pipes and not picks.refused:
        raise InputError(file, "picks", "there are only flange picks, and a flange is found on its pipe", "pick pipes too")
    return picks


def _settings_of(options: argparse.Namespace, picks: Sequence[Picks] | None) -> PickSettings:
    """Return the settings that the options ask for; the picks say whether standard diameters are needed."""
    from pipeworkbench.recon.pick_settings import PickSettings, sizes_in

    settings = PickSettings()
    if options.working_range is not None:
        settings = replace(settings, working_range=_range(options.working_range, "--working-range"))
        if settings.working_range[0] < NEAREST_MM:
            raise InputError(COMMAND_LINE, "--working-range", "begins inside the rig", f"begin at {NEAREST_MM:g} mm or more")
    if options.diameters is not None:
        settings = replace(settings, diameter_range=_range(options.diameters, "--diameters"))
        # a pick that gives its diameter, or is free, needs none: then only the others fail
        standard = picks is None or all(pick.diameter is None for one in picks for pick in one.pipes)
        if standard and not sizes_in(settings):
            raise InputError(COMMAND_LINE, "--diameters", "holds no diameter of EN 10220", "widen it, or pick with a free diameter")
    return settings


def _convert(options: argparse.Namespace) -> int:
    from pipeworkbench.exports.writers import check_paths
    from pipeworkbench.recon.formats.conversion import convert_rig
    from pipeworkbench.recon.formats.recognition import read_rig

    pipeline = _read_pipeline(options.input) if options.format is None else None
    if pipeline is not None:
        return _convert_pipeline(pipeline, options)
    if len(options.out) > 1:
        raise InputError(COMMAND_LINE, "--out", "a rig becomes one station", "name one output")
    if options.takeoff is not None:
        raise InputError(COMMAND_LINE, "--takeoff", f"is for pipelines, {options.input} is a rig", "leave it out")
    (output,) = options.out
    if output.suffix.lower() != ".json":
        raise InputError(output, "", "a rig becomes a station file", "name an output that ends in .json")
    given = tuple(options.images or ())
    check_paths(options.out, inputs=(options.input, *given))
    rig = read_rig(options.input, options.format, options.cameras)
    check_paths(options.out, inputs=(*rig.files, *given))
    scale = UNITS[options.unit] if options.unit is not None else options.scale
    station = convert_rig(rig, output, images=options.images, image_folder=options.image_folder, scale=scale, up=options.up, name=options.name)
    if not options.quiet:
        first, *others = (camera.projection_centre for camera in station.cameras)
        distances = ", ".join(f"{math.dist(first, other):.1f}" for other in others[:BASES_SHOWN]) + (" ..." if len(others) > BASES_SHOWN else "")
        print(f"written: {output}: {len(station.cameras)} cameras ({rig.format}), {distances} mm from the first")
    return DONE


def _read_pipeline(path: Path) -> Pipeline | None:
    """Return the pipeline a file holds, None where it is something else."""
    from pipeworkbench.files import read_json
    from pipeworkbench.pipeline import SCHEMA, Pipeline

    if path.suffix.lower() != ".json" or not path.is_file():
        return None
    data = read_json(path)
    schema = data.get("schema") if isinstance(data, dict) else None
    if schema == SCHEMA:
        return Pipeline.from_dict(data, source=path)
    if isinstance(schema, str) and schema.startswith("pipeworkbench-"):
        raise InputError(path, "schema", f"is {schema!r}", f"give a rig of another program or a pipeline ({SCHEMA})")
    return None


def _convert_pipeline(pipeline: Pipeline, options: argparse.Namespace) -> int:
    from pipeworkbench.exports.writers import Result

    unused = ("images", "image_folder", "unit", "scale", "up", "cameras", "name")
    for name in unused:
        if getattr(options, name) is not None:
            raise InputError(COMMAND_LINE, f"--{name.replace('_', '-')}", f"is for rigs, {options.input} is a pipeline", "leave it out")
    _check_outputs(options, has_photographs=False, inputs=(options.input,))
    for path in _outputs_of(options):
        _write(options, Result(pipeline, language=options.language, ifc_schema=options.ifc_schema), path, path)
        if not options.quiet:
            print(f"written: {path}")
    return DONE


def _range(values: Sequence[float], key: str) -> tuple[float, float]:
    low, high = values
    if not SMALLEST_MM <= low < high <= LARGEST_MM:
        limits = f"between {SMALLEST_MM:g} and {LARGEST_MM:g} mm"
        raise InputError(COMMAND_LINE, key, f"{low:g} to {high:g} is no range", f"give two lengths {limits}, the smaller first")
    return low, high


def _summary(found: Reconstruction, outputs: Sequence[Path], seconds: float) -> dict[str, object]:
    summary: dict[str, object] = {
        "station": found.pipeline.frame,
        "pipes": len(found.pipeline.pipes),
        "failed_picks": [failed._asdict() for failed in found.failed_picks],
        "warnings": found.warnings,
        "outputs": [str(path) for path in outputs],
        "seconds": round(seconds, 2),
        "components": found.pipeline.to_dict()["components"],
    }
    if found.adjustment is not None:
        summary["adjustment"] = _adjustment_summary(found.adjustment)
    if found.alternatives:
        summary["alternatives"] = [{"pick": index, "ranked": _ranked(found.alternatives[index])} for index in sorted(found.alternatives)]
    return summary


def _adjustment_summary(solution: Solution) -> dict[str, object]:
    numbers = {"sigma0": solution.sigma0, "sigma_image_px": solution.sigma_image, "redundancy": solution.redundancy}
    return {
        **{name: round(value, 4) if math.isfinite(value) else None for name, value in numbers.items()},
        "iterations": solution.iterations,
        "converged": solution.converged,
        "message": solution.message,
        "undetermined": solution.undetermined,
        "gross": [{"what": one.what, "size": one.size, "left_out": one.left_out} for one in solution.gross],
    }


def _ranked(alternatives: Sequence[Alternative]) -> list[dict[str, object]]:
    return [
        {
            "alternative": rank,
            "dn": one.pipe.dn,
            "outer_diameter": one.pipe.outer_diameter,
            "start": one.pipe.start,
            "end": one.pipe.end,
            "quality": one.pipe.quality,
            "score": one.score,
            "approximate": one.pipe.approximate,
            "chosen": one.chosen,
        }
        for rank, one in enumerate(alternatives, 1)
    ]


def _print_table(found: Reconstruction, outputs: Sequence[Path], seconds: float) -> None:
    from rich.console import Console
    from rich.table import Table

    from pipeworkbench.exports.tables import TERMINAL_COLUMNS, terminal_row

    # a fixed width where there is no terminal: a table in a file is not cut at 80 columns
    console = Console(width=None if sys.stdout.isatty() else 120, highlight=False)
    names = list(found.pipeline.stations)
    table = Table(title=f"Station{'s' if len(names) > 1 else ''} {', '.join(names)}", title_justify="left")
    for column in TERMINAL_COLUMNS:
        table.add_column(column, justify="left" if column == "remarks" else "right")
    for component in found.pipeline.components:
        table.add_row(*terminal_row(component))
    for index, _ in found.failed_picks:
        table.add_row(str(index), "-", "-", "-", "-", "-", "failed, see below")
    console.print(table)
    for index, reason in found.failed_picks:
        console.print(f"Pick {index} failed: {one_line(reason)}.", soft_wrap=True, markup=False)
    if found.alternatives:
        _print_alternatives(found.alternatives, console)
    if found.adjustment is not None:
        left_out = sum(one.left_out for one in found.adjustment.gross)
        how = f"sigma0 {found.adjustment.sigma0:.2f}, {found.adjustment.iterations} iterations, gross errors left out: {left_out}"
        console.print(f"Adjusted: {how}.", soft_wrap=True, markup=False)
    for warning in found.warnings:
        console.print(f"Note: {one_line(warning)}", soft_wrap=True, markup=False)
    for path in outputs:
        console.print(f"written: {path}", soft_wrap=True)
    console.print(f"{seconds:.1f} s")


def _print_alternatives(alternatives: Mapping[int, Sequence[Alternative]], console: Console) -> None:
    from rich.table import Table

    table = Table(title='Alternatives: a pick gets another one with the key "alternative" in picks.json', title_justify="left")
    for column in ("pick", "alternative", "DN", "outside diameter", "middle (x, y, z)", "quality", "score", "chosen"):
        table.add_column(column, justify="right")
    for index in sorted(alternatives):
        for rank, one in enumerate(alternatives[index], 1):
            pipe = one.pipe
            middle = ", ".join(f"{(start + end) / 2:.0f}" for start, end in zip(pipe.start, pipe.end, strict=True))
            quality = "-" if pipe.quality is None else f"{pipe.quality:.2f} px"
            chosen = "yes" if one.chosen else ""
            table.add_row(str(index), str(rank), str(pipe.dn or "-"), f"{pipe.outer_diameter:.1f} mm", middle, quality, f"{one.score:.1f}", chosen)
    console.print(table)


class _Progress:
    """A progress bar on a terminal, nothing elsewhere."""

    def __init__(self, *, show: bool) -> None:
        self.show = show and sys.stderr.isatty()

    def __enter__(self) -> Callable[[str, int, int], None]:
        if not self.show:
            return lambda text, done, total: None  # noqa: ARG005
        from rich.console import Console
        from rich.progress import Progress

        self.bar = Progress(console=Console(stderr=True), transient=True)
        task = self.bar.add_task("", total=None)
        self.bar.start()

        def report(text: str, done: int, total: int) -> None:
            self.bar.update(task, description=text, completed=done, total=total)

        return report

    def __exit__(self, *_: object) -> None:
        if self.show:
            self.bar.stop()
