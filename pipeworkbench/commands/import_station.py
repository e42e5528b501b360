# SPDX-License-Identifier: LGPL-2.1-or-later
"""Import Station: a calibrated rig and its photographs into the document."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD

from pipeworkbench.commands.base import Command, transaction
from pipeworkbench.environment import missing_packages


class ImportStation(Command):
    """Asks for station.json and adds the station to the document."""

    name = "PipeWB_ImportStation"
    menu_text = "Import Station"
    tooltip = "Import the photographs and the calibration of a station (station.json)"
    icon = "import_station.svg"
    accelerator = "Q, I"

    def run(self) -> None:
        """Ask for the file and import it."""
        from pipeworkbench.gui.dialogs import ask_open
        from pipeworkbench.gui.translation import tr

        path = ask_open(tr("Import a station"), tr("Station") + " (station.json *.json)")
        if path is None:
            return
        station = import_station(path)
        lacking = missing_packages(("cv2",))
        if lacking:
            FreeCAD.Console.PrintWarning(tr("The photographs are not shown: {packages} is missing").format(packages=", ".join(lacking)) + "\n")
            return
        from pipeworkbench.gui.photos.windows import open_photo_window

        open_photo_window(station)


def import_station(path: Path, document: Any = None) -> Any:
    """Add the station of a file to a document (the active one, a new one where there is none)."""
    from pipeworkbench.features.document import add_station
    from pipeworkbench.gui.translation import tr
    from pipeworkbench.recon.station import read_station

    station = read_station(path)
    document = document or FreeCAD.ActiveDocument or FreeCAD.newDocument("Pipeline")
    with transaction(document, "Import Station"):
        obj = add_station(document, station)
    report = tr("Station {name}: {count} photographs imported")
    FreeCAD.Console.PrintMessage(report.format(name=station.name, count=len(station.cameras)) + "\n")
    return obj
