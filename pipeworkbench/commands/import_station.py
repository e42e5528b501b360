# SPDX-License-Identifier: LGPL-2.1-or-later
"""Import Station: a calibrated rig and its photographs into the document."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD

from pipeworkbench.commands.base import Command, transaction


class ImportStation(Command):
    """Asks for station.json and adds the station to the document."""

    name = "PipeWB_ImportStation"
    menu_text = "Import Station"
    tooltip = "Import the photographs and the calibration of a station (station.json)"
    icon = "import_station.svg"

    def run(self) -> None:
        """Ask for the file and import it."""
        from pipeworkbench.gui.dialogs import ask_open

        path = ask_open("Import a station", "Station (station.json *.json)")
        if path is not None:
            import_station(path)


def import_station(path: Path, document: Any = None) -> Any:
    """Add the station of a file to a document (the active one, a new one where there is none)."""
    from pipeworkbench.features.document import add_station
    from pipeworkbench.gui.view_providers import show
    from pipeworkbench.recon.station import read_station

    station = read_station(path)
    document = document or FreeCAD.ActiveDocument or FreeCAD.newDocument("Pipeline")
    with transaction(document, "Import Station"):
        obj = add_station(document, station)
        show(obj)
    FreeCAD.Console.PrintMessage(f"Station {station.name}: {len(station.cameras)} photographs imported\n")
    return obj
