# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find Pipes: pipes without a click, proposed."""

from __future__ import annotations

from pipeworkbench.commands.measuring import MeasuringCommand, station_to_measure


class FindPipes(MeasuringCommand):
    """Opens the Find Pipes tool."""

    name = "PipeWB_FindPipes"
    menu_text = "Find Pipes"
    tooltip = "Look for pipes in the whole station without any click; each is proposed and accepted or rejected"
    icon = "find_pipes.svg"

    def run(self) -> None:
        """Open the tool."""
        from pipeworkbench.gui.tools.find_pipes_tool import FindPipesTool

        FindPipesTool(station_to_measure()).open()
