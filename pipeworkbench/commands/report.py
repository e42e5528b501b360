# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: one HTML file that says what was measured and how well."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class Report(Command):
    """Opens the panel that writes a report and shows it in the browser."""

    name = "PipeWB_Report"
    menu_text = "Report"
    tooltip = "Write a report of what was measured and how well, with charts and photographs, and open it in the browser"
    icon = "report.svg"
    needs = ("jinja2", "matplotlib", "cv2")
    needs_components = True

    def run(self) -> None:
        """Open the panel."""
        from pipeworkbench.gui.pipeline_panels.export import ReportPanel

        ReportPanel().open()
