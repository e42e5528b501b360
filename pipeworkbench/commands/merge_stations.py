# SPDX-License-Identifier: LGPL-2.1-or-later
"""Merge Stations: several viewpoints become one pipeline over the components they share."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class MergeStations(Command):
    """Opens the panel that puts stations together."""

    name = "PipeWB_MergeStations"
    menu_text = "Merge Stations"
    tooltip = "Put several stations together over the pipes and fittings they share, and adjust them over all photographs"
    icon = "merge_stations.svg"
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.merge import MergePanel

        MergePanel().open()
