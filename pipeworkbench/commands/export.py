# SPDX-License-Identifier: LGPL-2.1-or-later
"""Export: the document's components, or the selected ones, to IFC, STEP, JSON, CSV or a picture."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.commands.base import Command

FILTERS = (
    "IFC4 (*.ifc)",
    "STEP solids (*.step)",
    "Pipe Workbench pipeline (*.json)",
    "Table (*.csv)",
    "Photographs with contours (*.png)",
)


class Export(Command):
    """Asks for a file and writes the components to it."""

    name = "PipeWB_Export"
    menu_text = "Export"
    tooltip = "Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV or as a picture"
    icon = "export.svg"
    accelerator = "Q, X"
    needs_components = True

    def run(self) -> None:
        """Ask for the file and write it."""
        from pipeworkbench.features.document import components_in
        from pipeworkbench.gui.dialogs import ask_save

        document = FreeCAD.ActiveDocument
        components = components_in(document)
        selected = [obj for obj in FreeCADGui.Selection.getSelection() if obj in components]
        path = ask_save("Export pipes and fittings", ";;".join(FILTERS), f"{document.Label}.ifc")
        if path is not None:
            export(document, path, selected or None)


def export(document: Any, path: Path, objects: Iterable[Any] | None = None) -> None:
    """Write a document's components (or those among ``objects``) in the format of the path's ending."""
    from pipeworkbench.exports.writers import Result, check_paths, write
    from pipeworkbench.features.document import pipeline_of, stations_in
    from pipeworkbench.features.station import station_of

    stations = stations_in(document)
    check_paths([path], has_photographs=bool(stations))
    # only a picture needs the photographs: a document without them can still be exported otherwise
    shown = tuple(station_of(obj) for obj in stations) if path.suffix.lower() == ".png" else ()
    write(Result(pipeline_of(document, objects), shown), path)
    FreeCAD.Console.PrintMessage(f"written: {path}\n")
