# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tees, Reducers and Caps: fittings between measured pipes, proposed."""

from __future__ import annotations

from pipeworkbench.commands.measuring import MeasuringCommand, selected_of_kind, station_to_measure


class FindFittings(MeasuringCommand):
    """Opens the Tees, Reducers and Caps tool; with selected pipes it says what is between these."""

    name = "PipeWB_Fittings"
    menu_text = "Tees, Reducers and Caps"
    tooltip = "Find tees, reducers and caps at the pipes, or at the selected pipes"
    icon = "tee.svg"
    needs_components = True

    def run(self) -> None:
        """Open the tool."""
        from pipeworkbench.features.pipe import PipeFeature
        from pipeworkbench.gui.tools.fitting_tools import TeeReducerCapTool

        chosen = tuple(obj.ComponentId for obj in selected_of_kind(PipeFeature))
        TeeReducerCapTool(station_to_measure(), chosen).open()
