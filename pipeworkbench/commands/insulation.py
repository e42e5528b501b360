# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation: layers and jackets around components, what they save, what they run into, and the sheets that are cut for them."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class Insulate(Command):
    """Opens the panel that insulates components."""

    name = "PipeWB_Insulation"
    menu_text = "Insulation"
    tooltip = "Insulate pipes and fittings (all, or those selected): layers, jacket, boxes over flanges, heat saved, sheets to cut"
    icon = "insulation.svg"
    accelerator = "Q, N"
    needs = ("cadquery",)
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.insulation import InsulationPanel

        InsulationPanel().open()
