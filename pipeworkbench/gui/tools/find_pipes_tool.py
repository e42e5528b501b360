# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Find Pipes tool: pipes that the images show without a click, proposed with how sure they are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from pipeworkbench.features.preferences import detect_settings, pick_settings
from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.dialogs import Cancelled
from pipeworkbench.gui.tools.measured import components_of
from pipeworkbench.gui.tools.proposal_tool import ProposalTool
from pipeworkbench.gui.tools.proposals import Proposal
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import beside
from pipeworkbench.gui.worker import run_long
from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon import detect
from pipeworkbench.recon.ends import shared_course
from pipeworkbench.recon.reconstruct import as_component

Progress = Callable[[str, int, int], None]
KNOWN_ASIDE, KNOWN_SHARE = 0.5, 0.2  # diameters, part of the shorter one: where a pipe runs that the document has already


class FindPipesTool(ProposalTool):
    """Looks for pipes in the whole station; those that the document has already are not proposed again."""

    title = QT_TRANSLATE_NOOP("PipeWorkbench", "Find Pipes")
    icon = "find_pipes.svg"
    headers = (
        QT_TRANSLATE_NOOP("PipeWorkbench", "Size"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Length"),
        "px",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Confidence"),
    )
    nothing_found = QT_TRANSLATE_NOOP("PipeWorkbench", "No further pipes are seen. Click on those that are missing with the Pipe tool.")

    def look(self) -> None:
        """Look for pipes in a thread, with a progress bar."""
        station, window = self.station, self.window
        settings, measuring = detect_settings(), pick_settings()

        def work(progress: Progress) -> tuple[Any, ...]:
            done = 0

            def report(text: str) -> None:
                nonlocal done
                done += 1
                progress(text, done, detect.STEPS + 1)

            progress(tr("finding edges"), 0, detect.STEPS + 1)
            return detect.detect(window.wait_for_views(), settings, measuring, progress=report)

        try:
            candidates = run_long(tr("Finding pipes"), work, self.document)
        except Cancelled:
            self.close()
            return
        if not self.is_open:
            return  # the station was deleted, or its window closed, meanwhile
        known = [component for component in components_of(self.station_object) if isinstance(component, Pipe)]
        taken = {component.id for component in components_of(self.station_object)}
        found = []
        for candidate in sorted(candidates, key=lambda candidate: -candidate.score):
            pipe = as_component(candidate, None, station.name)
            if any(_is_same(pipe, other) for other in known):
                continue
            name = next(new for number in range(len(taken) + len(candidates) + 1) if (new := f"{station.name}-A{number:02d}") not in taken)
            taken.add(name)
            found.append(Proposal(replace(pipe, id=name), confidence=candidate.score))
        self.show_found(found)

    def show_found(self, found: list[Proposal]) -> None:
        """Show what was found, and let the slider reach from the least to the surest."""
        scores = [proposal.confidence or 0.0 for proposal in found]
        self._slider.blockSignals(True)
        self._slider.setRange(int(min(scores, default=0.0)), int(max(scores, default=0.0)) + 1)
        self._slider.setValue(self._slider.minimum())
        self._slider.blockSignals(False)
        super().show_found(found)

    def texts(self, proposal: Proposal) -> tuple[str, ...]:
        """Return size, length, quality and confidence."""
        pipe = proposal.component
        assert isinstance(pipe, Pipe)  # noqa: S101  # the tool proposes nothing else
        size = f"DN {pipe.dn}" if pipe.dn else f"{pipe.outer_diameter:.1f}"
        return size, f"{pipe.length / 1000:.2f} m", f"{pipe.quality or 0:.2f}", f"{proposal.confidence or 0:.0f}"

    def make_choices(self) -> None:
        """Add the slider that ticks what is sure enough."""
        self._slider = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal)
        self._slider.setObjectName("confidence")
        self._slider.setToolTip(tr("Tick the pipes from this confidence on: how much likelier they are than chance, as a logarithm"))
        self._slider.valueChanged.connect(self.guard(self._tick_above))
        self._least = QtWidgets.QLabel()
        self.layout.addWidget(beside(QtWidgets.QLabel(tr("From")), self._slider, self._least))

    def show_choices(self) -> None:
        """Say from which confidence on pipes are ticked."""
        self._slider.setEnabled(bool(self.proposals.items))
        self._least.setText(str(self._slider.value()))

    def _tick_above(self) -> None:
        self.proposals.tick_above(self._slider.value())
        self.show_list()


def _is_same(pipe: Pipe, other: Pipe) -> bool:
    """Tell whether two pipes run in the same place over a part of the shorter one."""
    shared, aside = shared_course(pipe, other)
    return bool(aside.max() < KNOWN_ASIDE * pipe.outer_diameter and shared > KNOWN_SHARE * min(pipe.length, other.length))
