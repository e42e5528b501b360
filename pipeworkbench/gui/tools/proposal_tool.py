# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of the tools that propose: a list with ticks, ghosts in the photographs and in 3D, accepting and rejecting."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from pipeworkbench.features.preferences import assemble_settings
from pipeworkbench.gui.photos.pointing import Click
from pipeworkbench.gui.tables import ChoiceTable, Column
from pipeworkbench.gui.tools.measured import components_of, joints_among
from pipeworkbench.gui.tools.proposals import Proposal, Proposals, applied, preview
from pipeworkbench.gui.tools.tool import Tool
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import beside, button, words
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.image_curves import distance_to_polyline

HIT_PX = 25.0  # of the photograph, from a click to the ghost that is meant


class ProposalTool(Tool):
    """Shows proposals; each is accepted or rejected by itself, or all that are ticked are accepted together."""

    headers: ClassVar[tuple[str, ...]] = ()
    names: ClassVar[tuple[str, ...]] = ()  # headers of the columns whose texts may be cut
    nothing_found: ClassVar[str] = ""
    hint = QT_TRANSLATE_NOOP("PipeWorkbench", "Click on a proposal to choose it; Enter accepts it, Esc leaves")

    def __init__(self, station_object: Any) -> None:
        super().__init__(station_object)
        self.proposals = Proposals()
        self._accepted: list[tuple[Proposal, str]] = []  # with the ids of their components
        self._still: str | None = None  # camera in whose photograph the proposal that is shown was clicked on
        self._outlines: list[dict[str, list[Array]]] = []  # of the proposals, by camera
        self._make_widgets()

    # what subclasses override

    def look(self) -> None:
        """Begin to look for what can be proposed."""
        raise NotImplementedError

    def texts(self, proposal: Proposal) -> tuple[str, ...]:
        """Return what the list says of a proposal."""
        raise NotImplementedError

    def make_choices(self) -> None:
        """Add widgets between the list and the buttons."""

    def show_choices(self) -> None:
        """Bring these widgets up to date with the proposal that is shown."""

    # what the user does

    def opened(self) -> None:
        """Begin to look."""
        self.look()
        self.show_all()

    def photo_clicked(self, click: Click) -> None:
        """Choose the proposal whose ghost was clicked on."""
        row = self._row_at(click.camera, np.array(click.point, float))
        if row is not None:
            self.proposals.row = row
            self._still = click.camera
            self.show_all()

    def digit_pressed(self, number: int) -> None:
        """Choose a proposal by its number."""
        if number <= len(self.proposals.items):
            self.proposals.row = number - 1
            self._still = None
            self.show_all()

    def accept_current(self) -> None:
        """Accept the proposal that is shown."""
        if self.proposals.current is not None:
            self._accept([self.proposals.current])

    def accept_ticked(self) -> None:
        """Accept all that are ticked."""
        self._accept(self.proposals.ticked)

    def reject_current(self) -> None:
        """Take the proposal that is shown off the list."""
        if self.proposals.current is not None:
            self.proposals.remove([self.proposals.current])
            self.show_all()

    def station_changed(self) -> None:
        """Look in the other station."""
        self.proposals.fill([])
        self.look()
        self.show_all()

    def refresh(self) -> None:
        """Follow the document: proposals whose neighbours are gone go too, what was undone is proposed again."""
        super().refresh()
        if not self.is_open:
            return
        components = components_of(self.station_object)
        there = {component.id for component in components}
        for proposal, name in self._accepted:
            is_listed = any(one.key == proposal.key for one in self.proposals.items)
            if name in there and is_listed:
                self.proposals.remove([one for one in self.proposals.items if one.key == proposal.key])
            elif name not in there and not is_listed:
                self.proposals.add(proposal)
        topology = assemble_settings().topology
        self.proposals.update(lambda proposal: preview(components, proposal, self.station.name, topology))
        self.show_all()

    def show_found(self, found: list[Proposal]) -> None:
        """Show what was found."""
        self.proposals.fill(found)
        if not found:
            self._status.setText(tr(self.nothing_found))
        self.show_all()

    # what is shown

    def show_all(self) -> None:
        """Bring list, ghosts and buttons up to date."""
        if self.is_open:
            self.show_list()
            self.show_ghosts()

    def show_list(self) -> None:
        """Bring list and buttons up to date; the ghosts do not depend on what is ticked."""
        proposals = self.proposals
        self.table.fill([self.texts(proposal) for proposal in proposals.items], proposals.row, proposals.ticks)
        self._accept_one.setEnabled(proposals.current is not None)
        self._reject_one.setEnabled(proposals.current is not None)
        self._accept_all.setEnabled(any(proposals.ticks))
        self._accept_all.setText(tr("Accept the {count} ticked").format(count=sum(proposals.ticks)))
        if self._task.is_running:
            self._status.setText(tr("Looking ..."))
        elif proposals.items:
            self._status.setText(tr("{count} found. Click on one to choose it.").format(count=len(proposals.items)))
        self.show_choices()

    def show_ghosts(self) -> None:
        """Draw all proposals, the one that is shown on top."""
        proposals = self.proposals
        drawn = [(proposal.component, row == proposals.row) for row, proposal in enumerate(proposals.items)]
        self._outlines = self.draw(drawn, alternatives=True, still=self._still)

    def _accept(self, accepted: list[Proposal]) -> None:
        if not accepted:
            return
        before = components_of(self.station_object)
        after, changed, names = applied(before, accepted, self.station.name, assemble_settings().topology)
        stored, joints = joints_among(before, after, changed)
        self.store(self.title, stored, joints)
        self._accepted += [(proposal, names[proposal.key]) for proposal in accepted if proposal.key in names]
        self.proposals.remove(accepted)
        self.show_all()

    def _row_at(self, camera: str, point: Any) -> int | None:
        """Return the row of the proposal whose outline a pixel is nearest to, None where it is far from all."""
        outlines = [by_camera[camera] for by_camera in self._outlines]
        distances = [min((distance_to_polyline(point, line) for line in lines), default=np.inf) for lines in outlines]
        row = int(np.argmin(distances)) if distances else -1
        if row < 0 or not outlines[row]:
            return None
        places = np.concatenate(outlines[row])
        is_inside = bool((places.min(axis=0) <= point).all() and (point <= places.max(axis=0)).all())
        return row if is_inside or distances[row] <= HIT_PX else None

    def _make_widgets(self) -> None:
        self._status = words("status")
        self.table = ChoiceTable(
            [Column(tr(text), names=text in self.names) for text in self.headers], tr("What was found; ticked ones are accepted together"), ticks=True
        )
        self.table.chosen.connect(self._row_chosen)
        self.table.ticked.connect(self._ticked)
        self._accept_one = button("accept", tr("Accept"), tr("Put the chosen one into the document (Enter)"), self.guard(self.accept_current))
        self._reject_one = button("reject", tr("Reject"), tr("Take the chosen one off the list"), self.guard(self.reject_current))
        self._accept_all = button("accept_ticked", "", tr("Put all that are ticked into the document"), self.guard(self.accept_ticked))
        self.layout.addWidget(self._status)
        self.layout.addWidget(self.table)
        self.make_choices()
        self.layout.addWidget(beside(self._accept_one, self._reject_one))
        self.layout.addWidget(self._accept_all)

    def _row_chosen(self, row: int) -> None:
        with self.reporting():
            self.proposals.row = row
            self._still = None
            self.show_choices()
            self.show_ghosts()

    def _ticked(self, row: int, ticked: bool) -> None:  # noqa: FBT001  # Qt's signal
        self.proposals.ticks[row] = ticked
        with self.reporting():
            self.show_list()
