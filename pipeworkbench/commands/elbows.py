# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elbows: fittings between measured pipes, proposed."""

from __future__ import annotations

from pipeworkbench.commands.measuring import MeasuringCommand, selected_of_kind, station_to_measure


class FindElbows(MeasuringCommand):
    """Opens the Elbows tool; with selected pipes it says what is between these."""

    name = "PipeWB_Elbows"
    menu_text = "Elbows"
    tooltip = "Find the elbows between the pipes, or between two selected pipes, and choose their bend radius"
    icon = "elbows.svg"
    needs_components = True

    def run(self) -> None:
        """Open the tool."""
        from pipeworkbench.features.pipe import PipeFeature
        from pipeworkbench.gui.tools.fitting_tools import ElbowTool

        chosen = tuple(obj.ComponentId for obj in selected_of_kind(PipeFeature))
        ElbowTool(station_to_measure(), chosen).open()
