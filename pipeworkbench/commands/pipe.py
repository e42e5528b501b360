# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipe: measure pipes by clicking on them in the photographs."""

from __future__ import annotations

from pipeworkbench.commands.measuring import MeasuringCommand, selected_of_kind, station_to_measure


class MeasurePipe(MeasuringCommand):
    """Opens the Pipe tool in the station's photographs; with a selected pipe that was clicked, its clicks are measured again."""

    name = "PipeWB_Pipe"
    menu_text = "Pipe"
    tooltip = "Measure a pipe: one click inside it or one on each of its edges in a photograph"
    icon = "pipe.svg"

    def run(self) -> None:
        """Open the tool."""
        from pipeworkbench.features.pipe import PipeFeature
        from pipeworkbench.gui.tools.pipe_tool import PipeTool

        selected = selected_of_kind(PipeFeature)
        PipeTool(station_to_measure(), selected[0] if len(selected) == 1 else None).open()
