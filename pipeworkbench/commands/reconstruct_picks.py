# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reconstruct Picks: the clicked pipes of a station become parametric pipes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.commands.base import Command, transaction
from pipeworkbench.errors import InputError, one_line


class ReconstructPicks(Command):
    """Asks for picks.json and reconstructs its pipes from the station's photographs."""

    name = "PipeWB_ReconstructPicks"
    menu_text = "Reconstruct Picks"
    tooltip = "Reconstruct the pipes that were picked in the station's photographs (picks.json)"
    icon = "reconstruct_picks.svg"
    needs_station = True

    def run(self) -> None:
        """Ask for the picks and reconstruct them."""
        from pipeworkbench.features.station import station_of
        from pipeworkbench.gui.dialogs import ask_open, progress

        obj = _chosen_station(FreeCAD.ActiveDocument)
        beside = station_of(obj).source.parent / "picks.json"
        path = ask_open("Reconstruct picks", "Picks (picks.json *.json)", beside)
        if path is not None:
            with progress("Reconstructing") as report:
                reconstruct_picks(obj, path, report)
            FreeCADGui.SendMsgToActiveView("ViewFit")


def reconstruct_picks(obj: Any, path: Path, progress: Callable[[str, int, int], None] = lambda text, done, total: None) -> list[Any]:  # noqa: ARG005
    """Reconstruct the picks of a file in a station object's photographs; return the components' objects."""
    from pipeworkbench.features.document import add_pipeline, connections_in
    from pipeworkbench.features.station import station_of
    from pipeworkbench.gui.view_providers import show
    from pipeworkbench.recon.picks import read_picks
    from pipeworkbench.recon.reconstruct import reconstruct

    station = station_of(obj)
    picks = read_picks(path, station)
    found = reconstruct(station, picks, progress=progress)
    with transaction(obj.Document, "Reconstruct Picks"):
        components = add_pipeline(obj.Document, found.pipeline)
        for made in (*components, *connections_in(obj.Document).values()):
            show(made)
    FreeCAD.Console.PrintMessage(f"Station {station.name}: {len(components)} components reconstructed\n")
    for index, reason in found.failed_picks:
        FreeCAD.Console.PrintWarning(f"Pick {index} failed: {one_line(reason)}.\n")
    for warning in found.warnings:
        FreeCAD.Console.PrintMessage(f"{one_line(warning)}\n")
    return components


def _chosen_station(document: Any) -> Any:
    """Return the selected station, or the only one."""
    from pipeworkbench.features.document import stations_in

    stations = stations_in(document)
    selected = [obj for obj in FreeCADGui.Selection.getSelection() if obj in stations]
    if len(selected) == 1:
        return selected[0]
    if len(stations) != 1:
        raise InputError(document.Label, "", f"the document has {len(stations)} stations", "select the one to work on")
    return stations[0]
