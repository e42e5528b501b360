# SPDX-License-Identifier: LGPL-2.1-or-later
"""The endings this program writes and the writer behind each."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pipeworkbench.errors import InputError
from pipeworkbench.exports import fcstd, ifc, pcf, pictures, report, step, tables
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import Station

LONGEST_NAME = 200  # bytes; file systems take 255, and the temporary name beside it is longer


@dataclass(frozen=True)
class Result:
    """What there is to write: a pipeline, the stations whose photographs show it, and how.

    ``language`` and ``title`` (the frame where it is empty) are those of the report, which ``photographs`` False leaves without them;
    ``ifc_schema`` is that of IFC.
    """

    pipeline: Pipeline
    stations: tuple[Station, ...] = field(default=())
    language: str = "en"
    ifc_schema: ifc.Schema = "IFC4"
    title: str = ""
    photographs: bool = True


WRITERS: dict[str, Callable[[Result, Path], None]] = {
    ".json": lambda result, path: result.pipeline.write(path),
    ".csv": lambda result, path: tables.write_csv(result.pipeline, path),
    ".ifc": lambda result, path: ifc.write_ifc(result.pipeline, path, ifc.IfcOptions(schema=result.ifc_schema)),
    ".step": lambda result, path: step.write_step(result.pipeline, path),
    ".pcf": lambda result, path: pcf.write_pcf(result.pipeline, path),
    ".fcstd": lambda result, path: fcstd.write_fcstd(result.pipeline, path, result.stations),
    ".png": lambda result, path: pictures.write_picture(result.pipeline, result.stations, path),
    ".html": lambda result, path: _write_report(result, path),
}


def check_paths(
    paths: Sequence[Path],
    *,
    has_photographs: bool = True,
    inputs: Sequence[Path] = (),
    endings: Collection[str] = tuple(WRITERS),
    outputs: Sequence[Path] = (),
) -> None:
    """Refuse, before anything is computed, what could not be written: unknown endings, missing folders, one name twice.

    ``inputs`` are files that must not be overwritten; ``has_photographs`` is False where there is no
    station at hand, so that no picture can be drawn; ``endings`` are those that are known; ``outputs`` are files that are written as well.
    """
    seen = {path.resolve() for path in outputs}
    kept = {path.resolve() for path in inputs}
    for path in paths:
        if path.suffix.lower() not in endings:
            raise InputError(path, "", f"unknown ending '{path.suffix}'", f"use one of {' '.join(endings).replace('fcstd', 'FCStd')}")
        if path.suffix.lower() == ".fcstd":
            fcstd.find_freecad()
        if path.suffix.lower() == ".png" and not has_photographs:
            raise InputError(path, "", "a picture needs the station's photographs", "name the station")
        if len(os.fsencode(path.name)) > LONGEST_NAME:
            raise InputError(path, "", "the name is too long", "choose a shorter one")
        if not path.parent.is_dir():
            raise InputError(path, "", f"there is no folder {path.parent}", "make it first or correct the path")
        if path.is_dir():
            raise InputError(path, "", "is a folder", "name a file")
        if path.resolve() in kept:
            raise InputError(path, "", "is an input of this run", "choose another name: it would be lost")
        if path.resolve() in seen:
            raise InputError(path, "", "is given twice as an output", "name each output once")
        seen.add(path.resolve())


def write(result: Result, path: Path) -> None:
    """Write a result in the format of the path's ending."""
    WRITERS[path.suffix.lower()](result, path)


def _write_report(result: Result, path: Path) -> None:
    report.write_report(result.pipeline, path, result.stations, language=result.language, title=result.title or None, photographs=result.photographs)
