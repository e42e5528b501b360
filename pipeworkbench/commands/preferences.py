# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preferences: FreeCAD's dialog at this workbench's page."""

from __future__ import annotations

import FreeCADGui

from pipeworkbench.commands.base import Command


class ShowPreferences(Command):
    """Opens the workbench's preferences."""

    name = "PipeWB_Preferences"
    menu_text = "Preferences ..."
    tooltip = "Tables of your own, working range, tolerances, colours and threads"
    icon = "preferences.svg"
    uses_preferences = False  # they may be what is to be mended

    def run(self) -> None:
        """Show the page."""
        from pipeworkbench.gui.preferences_page import GROUP

        FreeCADGui.showPreferences(GROUP, 0)
