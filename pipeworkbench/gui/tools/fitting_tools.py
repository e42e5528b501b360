# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tools that propose fittings between pipes: Elbows, and Tees, Reducers and Caps."""

from __future__ import annotations

from typing import Any, ClassVar

from pipeworkbench.catalogue import bends
from pipeworkbench.features.preferences import assemble_settings
from pipeworkbench.gui.compat import QtWidgets
from pipeworkbench.gui.tools.measured import components_of
from pipeworkbench.gui.tools.proposal_tool import ProposalTool
from pipeworkbench.gui.tools.proposals import Proposal, fittings_found, preview, with_radius
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import amount, choice
from pipeworkbench.pipeline import Cap, Elbow, Reducer, Tee
from pipeworkbench.recon.caps import FoundCap
from pipeworkbench.recon.elbows import FoundElbow
from pipeworkbench.recon.reducers import FoundReducer
from pipeworkbench.recon.tees import FoundTee
from pipeworkbench.recon.views import View

SMALLEST_MM, LARGEST_MM = 1.0, 20000.0


class FittingTool(ProposalTool):
    """Proposes fittings of some kinds at the free ends of the station's pipes.

    Parameters
    ----------
    station_object : document object
    chosen : sequence of str
        Ids of two or three pipes between which there is a fitting; without any, it is looked for everywhere.
    """

    kinds: ClassVar[tuple[type[Any], ...]] = ()

    def __init__(self, station_object: Any, chosen: tuple[str, ...] = ()) -> None:
        super().__init__(station_object)
        self._chosen = chosen

    def look(self) -> None:
        """Look for fittings beside the window."""
        components = components_of(self.station_object)
        station, kinds, chosen, topology = self.station.name, self.kinds, self._chosen, assemble_settings().topology
        if not components:
            self.show_found([])
            return

        def work(views: tuple[View, ...], _tell: object) -> list[Proposal]:
            return fittings_found(views, components, kinds, station, chosen, topology)

        self.run(work, self.show_found)

    def station_changed(self) -> None:
        """Look everywhere in the other station: what was chosen belongs to the former one."""
        self._chosen = ()
        super().station_changed()


class ElbowTool(FittingTool):
    """Proposes elbows; their bend radius may be another one of the standard, or free."""

    title = QT_TRANSLATE_NOOP("PipeWorkbench", "Elbows")
    icon = "elbow.svg"
    kinds = (FoundElbow,)
    headers = (
        QT_TRANSLATE_NOOP("PipeWorkbench", "Between"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Angle"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Bend"),
        "px",
    )
    names = ("Between",)
    nothing_found = QT_TRANSLATE_NOOP(
        "PipeWorkbench", "No elbows are seen between the free ends of the pipes. Measure the pipes on both sides of a bend, or select two pipes."
    )

    def texts(self, proposal: Proposal) -> tuple[str, ...]:
        """Return the pipes, the angle, the radius and the quality."""
        elbow = proposal.component
        assert isinstance(elbow, Elbow)  # noqa: S101  # the tool proposes nothing else
        kind = elbow.bend_type or f"{elbow.bend_radius:.0f} mm"
        return short_names(proposal), f"{elbow.angle_deg:.1f}\N{DEGREE SIGN}", kind, f"{elbow.quality or 0:.2f}"

    def make_choices(self) -> None:
        """Add the list of radii and the box for a free one."""
        self._bend = choice("bend", tooltip=tr("Bend radius of the chosen elbow: one of the standard, or a free one"))
        self._bend.activated.connect(self.guard(self._bend_chosen))
        self._radius = amount(SMALLEST_MM, (SMALLEST_MM, LARGEST_MM), "mm", 1, tr("Free bend radius; the projection follows"), "radius")
        self._radius.valueChanged.connect(self.guard(self._radius_changed))
        form = QtWidgets.QFormLayout()
        form.addRow(tr("Bend"), self._bend)
        form.addRow(tr("Radius"), self._radius)
        self.layout.addLayout(form)

    def show_choices(self) -> None:
        """List the radii of the standard for the diameter, and mark the elbow's."""
        elbow = self._elbow
        for widget in (self._bend, self._radius):
            widget.setEnabled(elbow is not None)
            widget.blockSignals(True)
        self._bend.clear()
        if elbow is not None:
            for bend in bends(elbow.outer_diameter):
                self._bend.addItem(f"{bend.bend_type} - {bend.bend_radius:g} mm", bend)
            self._bend.addItem(tr("free"), None)
            rows = [row for row in range(self._bend.count() - 1) if _is_bend(elbow, self._bend.itemData(row))]
            self._bend.setCurrentIndex(rows[0] if rows else self._bend.count() - 1)
            self._radius.setValue(elbow.bend_radius)
        for widget in (self._bend, self._radius):
            widget.blockSignals(False)

    @property
    def _elbow(self) -> Elbow | None:
        current = self.proposals.current
        return current.component if current is not None and isinstance(current.component, Elbow) else None

    def _bend_chosen(self) -> None:
        bend = self._bend.currentData()
        if bend is not None:
            self._change(bend.bend_radius, bend)
        elif self._elbow is not None:
            self._change(self._elbow.bend_radius, None)

    def _radius_changed(self) -> None:
        self._change(self._radius.value(), None)

    def _change(self, radius: float, bend: Any) -> None:
        current = self.proposals.current
        if current is None:
            return
        changed = preview(components_of(self.station_object), with_radius(current, radius, bend), self.station.name, assemble_settings().topology)
        if changed is None:
            self.show_choices()
            self.say(tr("With a bend radius of {radius:g} mm nothing would be left of a pipe beside it.").format(radius=radius), warning=True)
            return
        self.proposals.replace_current(changed)
        self.show_all()


class TeeReducerCapTool(FittingTool):
    """Proposes tees, reducers and caps."""

    title = QT_TRANSLATE_NOOP("PipeWorkbench", "Tees, Reducers and Caps")
    icon = "tee.svg"
    kinds = (FoundTee, FoundReducer, FoundCap)
    headers = (
        QT_TRANSLATE_NOOP("PipeWorkbench", "Kind"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "At"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Size"),
        "px",
    )
    names = ("At",)
    nothing_found = QT_TRANSLATE_NOOP(
        "PipeWorkbench", "No tees, reducers or caps are seen at the free ends of the pipes. Select the pipes that belong to one."
    )

    def texts(self, proposal: Proposal) -> tuple[str, ...]:
        """Return the kind, the pipes, the size and the quality."""
        component = proposal.component
        quality = "" if component.quality is None else f"{component.quality:.2f}"
        match component:
            case Tee():
                kind, size = (
                    tr("Tee") if component.tee_type == "tee" else tr("Set-on branch"),
                    f"{component.outer_diameter:g}/{component.branch_diameter:g}",
                )
            case Reducer():
                kind, size = tr("Reducer"), f"{component.outer_diameter:g}/{component.end_diameter:g}"
            case Cap():
                kind, size = tr("Cap"), f"{component.outer_diameter:g}"
            case _:
                kind, size = component.kind, f"{component.outer_diameter:g}"
        return kind, short_names(proposal), size, quality


def short_names(proposal: Proposal) -> str:
    """Return the pipes that a fitting belongs to, without the station's name before them."""
    return ", ".join(name.rsplit("-", 1)[-1] for name in proposal.neighbours)


def _is_bend(elbow: Elbow, bend: Any) -> bool:
    return bend.bend_type == elbow.bend_type and abs(bend.bend_radius - elbow.bend_radius) < 1e-6
