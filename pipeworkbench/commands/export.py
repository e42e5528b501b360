# SPDX-License-Identifier: LGPL-2.1-or-later
"""Export: the document's components, or the selected ones, to IFC, STEP, JSON, CSV, a report or a picture."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class Export(Command):
    """Opens the panel that writes components to a file."""

    name = "PipeWB_Export"
    menu_text = "Export"
    tooltip = "Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV, as a report or as a picture"
    icon = "export.svg"
    accelerator = "Q, X"
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.export import ExportPanel

        ExportPanel().open()
