# SPDX-License-Identifier: LGPL-2.1-or-later
"""Example Project: the sample station in a new document, and a guide that says what to click next."""

from __future__ import annotations

from pipeworkbench.commands.base import Command


class ExampleProject(Command):
    """Starts the tour."""

    name = "PipeWB_ExampleProject"
    menu_text = "Example project: dummy station"
    tooltip = "Open an example with photographs, and a guide through the first steps"
    icon = "tour.svg"
    needs = ("cv2", "cadquery")

    def run(self) -> None:
        """Make the document, show its photographs and start the guide."""
        from pipeworkbench.features.document import stations_in
        from pipeworkbench.gui.photos.windows import open_photo_window
        from pipeworkbench.gui.tour.example import make_example
        from pipeworkbench.gui.tour.guide import start_guide

        document = make_example()
        start_guide(document)
        open_photo_window(stations_in(document)[0])
