# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reconstruct Picks: the clicked pipes of a station become parametric pipes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.commands.base import Command, transaction
from pipeworkbench.errors import one_line


class ReconstructPicks(Command):
    """Asks for picks.json and reconstructs its pipes from the station's photographs."""

    name = "PipeWB_ReconstructPicks"
    menu_text = "Reconstruct Picks"
    tooltip = "Reconstruct the pipes that were picked in the station's photographs (picks.json)"
    icon = "reconstruct_picks.svg"
    needs = ("cv2", "cadquery")
    needs_station = True

    def run(self) -> None:
        """Ask for the picks and reconstruct them."""
        from pipeworkbench.commands.stations import chosen_station
        from pipeworkbench.features.station import station_of
        from pipeworkbench.gui.dialogs import ask_open
        from pipeworkbench.gui.translation import tr

        obj = chosen_station(FreeCAD.ActiveDocument)
        beside = station_of(obj).source.parent / "picks.json"
        path = ask_open(tr("Reconstruct picks"), tr("Picks") + " (picks.json *.json)", beside)
        if path is not None:
            reconstruct_picks(obj, path)
            FreeCADGui.SendMsgToActiveView("ViewFit")


def reconstruct_picks(obj: Any, path: Path) -> list[Any]:
    """Reconstruct the picks of a file in a station object's photographs; return the components' objects.

    Raises
    ------
    InputError
        Where station, photographs or picks do not fit.
    Cancelled
        Where the user cancelled it.
    """
    from pipeworkbench.features.document import add_pipeline
    from pipeworkbench.features.preferences import adjustment_settings, assemble_settings, pick_settings
    from pipeworkbench.features.station import station_of
    from pipeworkbench.gui.jobs import Progress
    from pipeworkbench.gui.translation import tr
    from pipeworkbench.gui.worker import run_long
    from pipeworkbench.recon.picks import read_picks
    from pipeworkbench.recon.reconstruct import Reconstruction, reconstruct

    document, station = obj.Document, station_of(obj)
    picks = read_picks(path, station)
    settings, adjustment, assembly = pick_settings(), adjustment_settings(), assemble_settings()

    def work(progress: Progress) -> Reconstruction:
        return reconstruct(station, picks, settings, progress, adjustment=adjustment, assembly=assembly)

    found = run_long(tr("Reconstructing picks"), work, document, leave=True)
    with transaction(document, "Reconstruct Picks"):
        components = add_pipeline(document, found.pipeline)
    report = tr("Station {name}: {count} components reconstructed")
    FreeCAD.Console.PrintMessage(report.format(name=station.name, count=len(components)) + "\n")
    for index, reason in found.failed_picks:
        FreeCAD.Console.PrintWarning(tr("Pick {index} failed: {reason}.").format(index=index, reason=one_line(reason)) + "\n")
    for warning in found.warnings:
        FreeCAD.Console.PrintMessage(f"{one_line(warning)}\n")
    return components
