# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolbar commands, one module each: gather, call, one undoable transaction."""

from __future__ import annotations

import FreeCADGui

from pipeworkbench.commands.export import Export
from pipeworkbench.commands.import_station import ImportStation
from pipeworkbench.commands.reconstruct_picks import ReconstructPicks

COMMANDS = (ImportStation, ReconstructPicks, Export)


def register() -> list[str]:
    """Add all commands to FreeCAD and return their names in the order of the toolbar."""
    for command in COMMANDS:
        FreeCADGui.addCommand(command.name, command())
    return [command.name for command in COMMANDS]
