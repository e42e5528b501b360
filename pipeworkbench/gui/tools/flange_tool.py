# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Flange tool: a click on a rim, the types and classes that it can be; or another type for a flange of the document."""

from __future__ import annotations

from typing import Any

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.gui.colours import WARNING_TEXT
from pipeworkbench.gui.photos.pointing import Click
from pipeworkbench.gui.tables import ChoiceTable, Column
from pipeworkbench.gui.tools.flange_measurement import FlangeAnswer, FlangeChoice, FlangeMeasurement, answer_flange_pick
from pipeworkbench.gui.tools.measured import components_of, joints_among, next_pick_index
from pipeworkbench.gui.tools.pipe_measurement import CLICKED
from pipeworkbench.gui.tools.tool import CLICK_COLOUR, CLICK_LAYER, Tool
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import beside, button, sentence, switch, words
from pipeworkbench.pipeline import Flange
from pipeworkbench.recon.picks import FlangePick
from pipeworkbench.recon.views import View

TYPES = {
    "01": QT_TRANSLATE_NOOP("PipeWorkbench", "plate"),
    "02": QT_TRANSLATE_NOOP("PipeWorkbench", "loose plate"),
    "04": QT_TRANSLATE_NOOP("PipeWorkbench", "loose plate, neck"),
    "05": QT_TRANSLATE_NOOP("PipeWorkbench", "blind"),
    "11": QT_TRANSLATE_NOOP("PipeWorkbench", "weld neck"),
    "12": QT_TRANSLATE_NOOP("PipeWorkbench", "slip-on"),
    "13": QT_TRANSLATE_NOOP("PipeWorkbench", "threaded"),
}


class FlangeTool(Tool):
    """Measures one flange after the other, or gives one another type.

    Parameters
    ----------
    station_object : document object
    existing : document object, optional
        The flange that is to have another type.
    """

    title = QT_TRANSLATE_NOOP("PipeWorkbench", "Flange")
    icon = "flange.svg"
    snapping = True
    hint = QT_TRANSLATE_NOOP("PipeWorkbench", "Flange: click on the straight edge of its rim")

    def __init__(self, station_object: Any, existing: Any = None) -> None:
        super().__init__(station_object)
        self.measurement = FlangeMeasurement()
        self.reason = ""
        self._existing_id: str | None = None if existing is None else existing.ComponentId
        self._click: tuple[str, tuple[float, float]] | None = None
        self._make_widgets()

    # what the user does

    def opened(self) -> None:
        """Show the flange that is to be changed."""
        if self._existing_id is not None:
            flange = next((one for one in components_of(self.station_object) if one.id == self._existing_id), None)
            if isinstance(flange, Flange):
                self.measurement.change(flange)
        self._show()

    def photo_clicked(self, click: Click) -> None:
        """Take a click on a rim."""
        point = (float(click.edge.point[0]), float(click.edge.point[1])) if click.edge is not None else click.point
        components, station = components_of(self.station_object), self.station
        pick = FlangePick(next_pick_index(self.station_object), station.camera_index(click.camera) or 0, np.array(point, float))
        entry = {CLICKED: {"kind": "flange", "camera": click.camera, "point": list(point)}}
        self._click, self._existing_id, self.reason = (click.camera, point), None, ""
        self.measurement.clear()

        def work(views: tuple[View, ...], _tell: object) -> FlangeAnswer | str:
            try:
                return answer_flange_pick(views, pick, components, station.name)
            except InputError as error:
                return f"{error.problem}; {error.remedy}"

        def ended(answer: FlangeAnswer | str) -> None:
            if isinstance(answer, str):
                self.reason = answer
            else:
                self.measurement.take(answer, entry)
            self._show()

        self.run(work, ended)
        self._show()

    def digit_pressed(self, number: int) -> None:
        """Choose a type by its number in the list."""
        self._choose(number - 1)

    def accept_current(self) -> None:
        """Put the flange into the document; its pipe ends at it."""
        flange = self.measurement.flange
        if flange is None:
            self.say(tr("There is no flange to accept yet."))
            return
        before = components_of(self.station_object)
        after, changed = self.measurement.result(before)
        stored, joints = joints_among(before, after, changed)
        self.store("Flange", stored, joints)
        self.remember(flange.id)
        self._forget()

    def step_back(self) -> bool:
        """Take back the click."""
        if self._click is None and self.measurement.flange is None:
            return False
        self._task.cancel()
        self._forget()
        return True

    def station_changed(self) -> None:
        """Begin anew in the other station."""
        self._forget()

    def refresh(self) -> None:
        """Follow undo and redo."""
        super().refresh()
        if not self.is_open:
            return
        if self._existing_id is not None:
            flange = next((one for one in components_of(self.station_object) if one.id == self._existing_id), None)
            if not isinstance(flange, Flange):
                self._forget()
        self.show_accepted()

    def _forget(self) -> None:
        self.measurement.clear()
        self._click, self._existing_id, self.reason = None, None, ""
        self._show()

    def _choose(self, row: int) -> None:
        if self.measurement.choose(row):
            self._show()

    def _row_chosen(self, row: int) -> None:
        with self.reporting():
            self._choose(row)

    def _partner_toggled(self) -> None:
        self.measurement.with_partner = self._partner.isChecked()
        self._show()

    # what is shown

    def _make_widgets(self) -> None:
        self._status = words("status")
        self.table = ChoiceTable(
            [Column(""), Column(tr("Type"), names=True), Column("PN"), Column(tr("Score")), Column(tr("Standard"), names=True)],
            tr(
                "Types and pressure classes, the likeliest first; the score is the logarithm of how likely the images make them, "
                "those without one were not compared with the images"
            ),
        )
        self.table.chosen.connect(self._row_chosen)
        self._size = words("size")
        self._reason = words("reason")
        self._reason.setStyleSheet(f"color: {WARNING_TEXT}")
        facing = tr("Add the flange on the other side of the gasket as well, where one is seen")
        self._partner = switch("partner", tr("The flange facing it, too"), facing, on=True)
        self._partner.toggled.connect(self.guard(self._partner_toggled))
        self._accept = button("accept", tr("Accept"), tr("Put the flange into the document (Enter)"), self.guard(self.accept_current))
        self._clear = button("clear", tr("Clear"), tr("Forget the click"), self.guard(self._forget))
        for widget in (self._status, self.table, self._size, self._partner, self._reason):
            self.layout.addWidget(widget)
        self.layout.addWidget(beside(self._accept, self._clear))
        self.layout.addWidget(self._accepted_label)

    def _show(self) -> None:
        if not self.is_open:
            return
        measurement = self.measurement
        flange = measurement.flange
        if self._task.is_running:
            text = tr("Looking for the rim ...")
        elif self._existing_id is not None and flange is not None:
            text = tr("Choose another type for {name}; its face stays where it is.").format(name=flange.id)
        elif flange is not None:
            text = tr("Enter accepts the flange. Choose another type if it is not the right one.")
        else:
            text = tr("Click on the straight edge of a flange's rim. Its pipe must have been measured.")
        self._status.setText(text)
        self.table.fill([_texts(number, choice) for number, choice in enumerate(measurement.choices)], measurement.row)
        self._size.setText(
            "" if flange is None else tr("D {D:g} mm, C {C:g} mm, length {length:g} mm").format(D=flange.D, C=flange.C, length=flange.length)
        )
        self._reason.setText(sentence(self.reason))
        self._reason.setVisible(bool(self.reason))
        self._partner.setVisible(measurement.partner is not None)
        self._accept.setEnabled(flange is not None)
        self._clear.setEnabled(flange is not None or self._click is not None)
        self._draw()
        self.show_accepted()

    def _draw(self) -> None:
        flange, partner = self.measurement.flange, self.measurement.partner
        others = [(partner, False)] if partner is not None and self.measurement.with_partner else []
        self.draw([*others, *([] if flange is None else [(flange, True)])], still=None if self._click is None else self._click[0])
        layer = self.window.layer(CLICK_LAYER)
        layer.clear()
        if self._click is not None:
            layer.set_points(self._click[0], np.array([self._click[1]]), CLICK_COLOUR)


def _texts(number: int, choice: FlangeChoice) -> tuple[str, ...]:
    dimensions = choice.dimensions
    kind = f"{dimensions.flange_type} {tr(TYPES[dimensions.flange_type])}" if dimensions.flange_type in TYPES else dimensions.flange_type
    score = "" if choice.score is None else f"{choice.score:.0f}"
    return str(number + 1) if number < 9 else "", kind, f"{dimensions.pn:g}", score, dimensions.standard
