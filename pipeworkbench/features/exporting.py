# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document's components written to files, in the format that the ending says."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.features.document import pipeline_of, stations_in
from pipeworkbench.features.station import station_of
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import Station

if TYPE_CHECKING:
    from pipeworkbench.exports.ifc import Schema

SHOWS_PHOTOGRAPHS = (".png", ".html")


@dataclass(frozen=True)
class Format:
    """What a file's ending means to the user."""

    ending: str
    name: str
    explanation: str

    @property
    def filter(self) -> str:
        """As file dialogs have it."""
        return f"{self.name} (*{self.ending})"


# marked for translation where they are shown
FORMATS = (
    Format(".ifc", "IFC", "For BIM: pipe segments and fittings with their dimensions and accuracy"),
    Format(".step", "STEP solids", "For CAD: named solids, coloured by kind"),
    Format(".pcf", "Piping component file", "For isometrics: components with their ends, bores and items"),
    Format(".html", "Report", "For people: one file with dimensions, accuracy, charts and photographs"),
    Format(".csv", "Table", "For spreadsheets: a line per component"),
    Format(".png", "Photographs with contours", "To check by eye: the photographs with what was measured drawn on them"),
    Format(".json", "Pipe Workbench pipeline", "Everything that is known, for this program's command line"),
)


@dataclass(frozen=True, eq=False)
class ExportTask:
    """What is to be written; gathered from a document, written without it.

    ``photographs`` False leaves them out of the report, whose ``title`` and ``language`` are given; ``ifc_schema`` is that of IFC.
    """

    pipeline: Pipeline
    stations: tuple[Station, ...]
    title: str = ""
    language: str = "en"
    photographs: bool = True
    ifc_schema: Schema = "IFC4"

    def write(self, path: Path) -> None:
        """Write the file, whole or not at all.

        Raises
        ------
        InputError
            Where the ending is not known, the folder is missing or a photograph cannot be read.
        MissingPackageError
            Where a format needs a package that is not installed.
        """
        from pipeworkbench.exports.writers import Result, check_paths, write

        check_paths([path], has_photographs=bool(self.stations))
        write(Result(self.pipeline, self.stations, self.language, self.ifc_schema, self.title, self.photographs), path)


def export_task(
    document: Any,
    ending: str,
    objects: Iterable[Any] | None = None,
    *,
    title: str = "",
    language: str = "en",
    photographs: bool = True,
    ifc_schema: Schema = "IFC4",
) -> ExportTask:
    """Gather from a document what a file of this ending needs.

    Raises
    ------
    InputError
        Where there are no components, or a station's file is needed and has moved.
    """
    pipeline = pipeline_of(document, objects)
    # what shows no photographs can be written when they are elsewhere
    needed = ending.lower() in SHOWS_PHOTOGRAPHS and (photographs or ending.lower() == ".png")
    shown = [obj for obj in stations_in(document) if obj.StationName in pipeline.stations] if needed else ()
    return ExportTask(pipeline, tuple(station_of(obj) for obj in shown), title or document.Label, language, photographs, ifc_schema)


def export_document(
    document: Any,
    path: Path,
    objects: Sequence[Any] | None = None,
    *,
    language: str = "en",
    photographs: bool = True,
    ifc_schema: Schema = "IFC4",
) -> None:
    """Write a document's components (or those among ``objects``) in the format of the path's ending; errors are those of both steps."""
    export_task(document, path.suffix, objects, language=language, photographs=photographs, ifc_schema=ifc_schema).write(path)
