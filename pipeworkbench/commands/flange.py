# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flange: measure flanges by clicking on their rims in the photographs."""

from __future__ import annotations

from pipeworkbench.commands.measuring import MeasuringCommand, selected_of_kind, station_to_measure


class MeasureFlange(MeasuringCommand):
    """Opens the Flange tool; with a selected flange, to give it another type."""

    name = "PipeWB_Flange"
    menu_text = "Flange"
    tooltip = "Measure a flange: click on the straight edge of its rim; or give the selected flange another type"
    icon = "flange.svg"
    needs_components = True

    def run(self) -> None:
        """Open the tool."""
        from pipeworkbench.features.flange import FlangeFeature
        from pipeworkbench.gui.tools.flange_tool import FlangeTool

        selected = selected_of_kind(FlangeFeature)
        FlangeTool(station_to_measure(), selected[0] if len(selected) == 1 else None).open()
