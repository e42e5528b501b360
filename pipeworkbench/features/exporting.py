# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document's components and their insulation written to files, in the format that the ending says."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pipeworkbench.features.document import pipeline_of, stations_in
from pipeworkbench.features.insulation import insulations_in, nothing_insulated, plans_of, write_plan
from pipeworkbench.features.station import station_of
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    from pipeworkbench.exports.ifc import Schema
    from pipeworkbench.insulation.planning import Plan

SHOWS_PHOTOGRAPHS = (".png", ".html")
TAKE_OFF = "take-off"


@dataclass(frozen=True)
class Format:
    """What a file's ending means to the user.

    ``key`` tells formats of one ending apart; that without one is meant where only the ending is known. ``insulation`` says whether
    the format can hold that of the document, or is about nothing else.
    """

    ending: str
    name: str
    explanation: str
    insulation: Literal["none", "carried", "needed"] = "none"
    key: str = ""

    @property
    def filter(self) -> str:
        """As file dialogs have it."""
        return f"{self.name} (*{self.ending})"


FORMATS = (
    Format(".ifc", "IFC", "For BIM: pipe segments and fittings with their dimensions and accuracy", "carried"),
    Format(".step", "STEP solids", "For CAD: named solids, coloured by kind", "carried"),
    Format(".pcf", "Piping component file", "For isometrics: components with their ends, bores and items", "carried"),
    Format(".html", "Report", "For people: one file with dimensions, accuracy, charts and photographs"),
    Format(".csv", "Table", "For spreadsheets: a line per component"),
    Format(".csv", "Take-off list", "For estimating and purchasing: a line per item with its quantity", key=TAKE_OFF),
    Format(".dxf", "Cut sheets", "For the shop: the insulation's parts of sheet metal, laid out on sheets", "needed"),
    Format(".pdf", "Pictures of the cut sheets", "To look at and print: the sheets with their parts", "needed"),
    Format(".xlsx", "Cut and material lists", "For the shop and purchasing: parts, sheets and materials of the insulation", "needed"),
    Format(".png", "Photographs with contours", "To check by eye: the photographs with what was measured drawn on them"),
    Format(".json", "Pipe Workbench pipeline", "Everything that is known, for this program's command line"),
)


@dataclass(frozen=True, eq=False)
class ExportTask:
    """What is to be written; gathered from a document, written without it.

    ``photographs`` False leaves them out of the report, whose ``title`` and ``language`` are given; ``ifc_schema`` is that of IFC.
    ``plan`` is the insulation to be written, ``key`` that of the format.
    """

    pipeline: Pipeline
    stations: tuple[Station, ...]
    title: str = ""
    language: str = "en"
    photographs: bool = True
    ifc_schema: Schema = "IFC4"
    plan: Plan | None = None
    key: str = ""

    def write(self, path: Path) -> None:
        """Write the file, whole or not at all.

        Raises
        ------
        InputError
            Where the ending is not known, the folder is missing or a photograph cannot be read.
        MissingPackageError
            Where a format needs a package that is not installed.
        """
        from pipeworkbench.exports import insulation_files
        from pipeworkbench.exports.take_off import ENDING, write_take_off
        from pipeworkbench.exports.writers import Result, check_paths, write

        if self.key == TAKE_OFF:
            check_paths([path], endings=(ENDING,))
            write_take_off(self.pipeline, path)
            return
        if self.plan is not None:
            check_paths([path], endings=tuple(insulation_files.WRITERS))
            write_plan(self.plan, path, self.language, self.ifc_schema)
            return
        check_paths([path], has_photographs=bool(self.stations))
        write(Result(self.pipeline, self.stations, self.language, self.ifc_schema, self.title, self.photographs), path)


def export_task(
    document: Any,
    ending: str,
    objects: Iterable[Any] | None = None,
    *,
    key: str = "",
    title: str = "",
    language: str = "en",
    photographs: bool = True,
    ifc_schema: Schema = "IFC4",
    insulation: bool = True,
) -> ExportTask:
    """Gather from a document what a file of this ending needs; ``key`` is that of the format, where several have the ending.

    ``insulation`` False leaves it out of formats that only carry it.

    Raises
    ------
    InputError
        Where there are no components, where a station's file is needed and has moved, or insulation is needed and there is none.
    """
    pipeline = pipeline_of(document, objects)
    wanted = next((one for one in FORMATS if (one.ending, one.key) == (ending.lower(), key)), None)
    asked = wanted is not None and (wanted.insulation == "needed" or (wanted.insulation == "carried" and insulation))
    plan = _plan_for(document, pipeline) if asked else None
    if plan is None and wanted is not None and wanted.insulation == "needed":
        raise nothing_insulated(document)
    # what shows no photographs can be written when they are elsewhere
    needed = ending.lower() in SHOWS_PHOTOGRAPHS and (photographs or ending.lower() == ".png")
    shown = [obj for obj in stations_in(document) if obj.StationName in pipeline.stations] if needed else ()
    stations = tuple(station_of(obj) for obj in shown)
    return ExportTask(pipeline, stations, title or document.Label, language, photographs, ifc_schema, plan, key)


def export_document(
    document: Any,
    path: Path,
    objects: Sequence[Any] | None = None,
    *,
    key: str = "",
    language: str = "en",
    photographs: bool = True,
    ifc_schema: Schema = "IFC4",
    insulation: bool = True,
) -> None:
    """Write a document's components (or those among ``objects``) in the format of the path's ending; errors are those of both steps."""
    task = export_task(
        document, path.suffix, objects, key=key, language=language, photographs=photographs, ifc_schema=ifc_schema, insulation=insulation
    )
    task.write(path)


def _plan_for(document: Any, pipeline: Pipeline) -> Plan | None:
    """Return what the document's insulation puts around a pipeline's components; None where they are bare."""
    if not insulations_in(document):
        return None
    here = {component.id for component in pipeline.components}
    for plan in plans_of(document):
        pieces = tuple(piece for piece in plan.pieces if piece.covering.component in here)
        if pieces:
            return replace(plan, pipeline=pipeline, pieces=pieces)
    return None
