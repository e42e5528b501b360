# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adjust: the components, all or selected, are adjusted to the edges of all photographs."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class Adjust(Command):
    """Opens the panel of the common adjustment."""

    name = "PipeWB_Adjust"
    menu_text = "Adjust"
    tooltip = "Adjust pipes and fittings, all or those selected, to the edges of all photographs, with their joints and standard sizes"
    icon = "adjust.svg"
    needs = ("cv2",)
    needs_station = True
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.adjust import AdjustPanel

        AdjustPanel().open()
