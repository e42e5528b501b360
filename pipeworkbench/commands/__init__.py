# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolbar commands, one module each: gather, call, one undoable transaction.

`GROUPS` is the table of them all: a new command is one import and one name in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import FreeCADGui

from pipeworkbench.commands.adjust import Adjust
from pipeworkbench.commands.base import Command
from pipeworkbench.commands.deviations import Deviations
from pipeworkbench.commands.elbows import FindElbows
from pipeworkbench.commands.example_project import ExampleProject
from pipeworkbench.commands.export import Export
from pipeworkbench.commands.find_pipes import FindPipes
from pipeworkbench.commands.fittings import FindFittings
from pipeworkbench.commands.flange import MeasureFlange
from pipeworkbench.commands.import_station import ImportStation
from pipeworkbench.commands.insulation import Insulate
from pipeworkbench.commands.merge_stations import MergeStations
from pipeworkbench.commands.photo_window import PhotoWindowCommand
from pipeworkbench.commands.pipe import MeasurePipe
from pipeworkbench.commands.preferences import ShowPreferences
from pipeworkbench.commands.reconstruct_picks import ReconstructPicks
from pipeworkbench.commands.report import Report


@dataclass(frozen=True)
class Group:
    """Commands that belong together: a toolbar of their own, and a section of the menu.

    ``title`` is the toolbar's, in English, unlike any other workbench's; FreeCAD translates it (context ``Workbench``).
    """

    title: str
    commands: tuple[type[Command], ...]

    @property
    def names(self) -> list[str]:
        """FreeCAD's names of the commands."""
        return [command.name for command in self.commands]


GROUPS = (
    Group("Pipe measuring", (ImportStation, PhotoWindowCommand, MeasurePipe, FindPipes, FindElbows, MeasureFlange, FindFittings, ReconstructPicks)),
    Group("Pipe adjustment", (Adjust, MergeStations, Deviations)),
    Group("Pipe output", (Insulate, Export, Report)),
    Group("Pipe Workbench help", (ExampleProject, ShowPreferences)),
)
IN_CONTEXT_MENU: tuple[type[Command], ...] = (PhotoWindowCommand, Export)  # of the tree and the 3D view


def register() -> tuple[Group, ...]:
    """Add all commands to FreeCAD and return their groups."""
    for group in GROUPS:
        for command in group.commands:
            FreeCADGui.addCommand(command.name, command())
    return GROUPS
