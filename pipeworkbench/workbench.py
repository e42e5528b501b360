# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench: menu, toolbar and icon; loads its commands when it is first activated."""

from typing import Any

import FreeCADGui

from pipeworkbench.features.base import window_hooks
from pipeworkbench.files import package_folder

NAME = "Pipe Workbench"


def _show_restored(obj: Any) -> None:
    from pipeworkbench.gui.view_providers import show

    show(obj)


window_hooks.append(_show_restored)


class PipeWorkbench(FreeCADGui.Workbench):  # type: ignore[misc]  # FreeCAD has no types
    """As-built pipelines from photographs."""

    MenuText = NAME
    ToolTip = "Measure pipes in photographs and model them as built"
    Icon = str(package_folder("resources") / "icons" / "workbench.svg")

    def Initialize(self) -> None:  # FreeCAD's name
        """Register the commands and put them into menu and toolbar."""
        from pipeworkbench.commands import register

        names = register()
        self.appendToolbar(NAME, names)
        self.appendMenu(NAME, names)

    def GetClassName(self) -> str:  # FreeCAD's name
        """Tell FreeCAD that this is a Python workbench."""
        return "Gui::PythonWorkbench"
