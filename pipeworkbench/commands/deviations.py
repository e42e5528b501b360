# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviations: what was built beside what was designed."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class Deviations(Command):
    """Opens the panel that compares components with a design."""

    name = "PipeWB_Deviations"
    menu_text = "Deviations"
    tooltip = "Measure how pipes and fittings deviate from a design: an IFC model, or solids of the document"
    icon = "deviations.svg"
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.deviations import DeviationsPanel

        DeviationsPanel().open()
