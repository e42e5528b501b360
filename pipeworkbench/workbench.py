# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench: menu, toolbars, preferences and icon; loads its commands when it is first activated."""

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
        """Register commands, translations and preferences, and make menu and toolbars."""
        from pipeworkbench.commands import register
        from pipeworkbench.gui.preferences_page import GROUP, ColoursPage, MeasuringPage
        from pipeworkbench.gui.translation import load_translations

        load_translations()
        for row, group in enumerate(register()):
            self.appendToolbar(group.title, group.names)
            self.appendMenu(NAME, ["Separator", *group.names] if row else group.names)
        # the group's icon: preferences-pipe_workbench.svg
        FreeCADGui.addIconPath(str(package_folder("resources") / "icons"))
        for page in (MeasuringPage, ColoursPage):
            FreeCADGui.addPreferencePage(page, GROUP)

    def ContextMenu(self, recipient: str) -> None:  # noqa: ARG002  # FreeCAD's name; "View" or "Tree"
        """Offer what can be done with what is selected."""
        from pipeworkbench.commands import IN_CONTEXT_MENU

        usable = [command.name for command in IN_CONTEXT_MENU if command().IsActive()]
        if usable and FreeCADGui.Selection.getSelection():
            self.appendContextMenu(NAME, usable)

    def GetClassName(self) -> str:  # FreeCAD's name
        """Tell FreeCAD that this is a Python workbench."""
        return "Gui::PythonWorkbench"
