# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Pipe tool: one click inside a pipe or on both its edges, the pipes that it can be, and which diameter it has."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pipeworkbench.catalogue import pipe_sizes
from pipeworkbench.features.preferences import pick_settings
from pipeworkbench.gui.colours import WARNING_TEXT
from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.photos.pointing import Click
from pipeworkbench.gui.tables import ChoiceTable, Column
from pipeworkbench.gui.tools.measured import components_of, joints_among, next_pick_index
from pipeworkbench.gui.tools.pipe_measurement import CLICKED, ClickMode, Diameter, PipeMeasurement, Request, State
from pipeworkbench.gui.tools.tool import CLICK_COLOUR, CLICK_LAYER, Tool
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import amount, beside, button, choice, sentence, words
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.pipes import PickAnswer, Sighting, follow_pick
from pipeworkbench.recon.views import View

SETTLED_MS = 350  # after the last change of a diameter it is measured anew
DRAG_RANGE = 1.6  # how many times thicker and thinner the slider goes
DRAG_STEPS = 400
SMALLEST_MM, LARGEST_MM = 5.0, 3000.0
WHAT_TO_DO = {
    State.EMPTY: QT_TRANSLATE_NOOP("PipeWorkbench", "Click inside a pipe, or on one of its edges."),
    State.ONE_EDGE: QT_TRANSLATE_NOOP("PipeWorkbench", "Click on the other edge of the pipe, in the same photograph."),
    State.MEASURING: QT_TRANSLATE_NOOP("PipeWorkbench", "Measuring ..."),
    State.ANSWERED: QT_TRANSLATE_NOOP("PipeWorkbench", "Enter accepts the pipe. Digits choose another one. Esc steps back."),
    State.FAILED: QT_TRANSLATE_NOOP("PipeWorkbench", "Click again, change the diameter, or step back with Esc."),
}
MODES = {
    ClickMode.AUTOMATIC: QT_TRANSLATE_NOOP("PipeWorkbench", "an edge where one is marked, else the inside"),
    ClickMode.EDGES: QT_TRANSLATE_NOOP("PipeWorkbench", "always an edge"),
    ClickMode.INSIDE: QT_TRANSLATE_NOOP("PipeWorkbench", "always the inside"),
}


class PipeTool(Tool):
    """Measures one pipe after the other until it is closed.

    Parameters
    ----------
    station_object : document object
    again : document object, optional
        A pipe that was measured with this tool: its clicks are measured again, and it is brought up to date.
    """

    title = QT_TRANSLATE_NOOP("PipeWorkbench", "Pipe")
    icon = "pipe.svg"
    snapping = True
    hint = QT_TRANSLATE_NOOP("PipeWorkbench", "Pipe: click inside it, or on both its edges")

    def __init__(self, station_object: Any, again: Any = None) -> None:
        super().__init__(station_object)
        self.measurement = PipeMeasurement(self.station, next_pick_index(station_object))
        self._again = again
        self._settle = QtCore.QTimer(self.form)
        self._settle.setSingleShot(True)
        self._settle.setInterval(SETTLED_MS)
        self._settle.timeout.connect(self.guard(self._measure_tried))
        self._make_widgets()

    def opened(self) -> None:
        """Measure again what was measured before."""
        if self._again is not None:
            from pipeworkbench.features.component import component_of

            pipe = component_of(self._again)
            if pipe.pick is not None and CLICKED in pipe.extra:
                self.measurement.pick_index = pipe.pick
                self.measurement.repeat(pipe.extra[CLICKED])
                self._measure()
        self._show()

    # what the user does

    def photo_clicked(self, click: Click) -> None:
        """Take a click on an edge or inside a pipe."""
        if self.measurement.state is State.ANSWERED:
            self.measurement.pick_index = next_pick_index(self.station_object)
        self.measurement.click(click.camera, click.point, click.edge, self.window.edges(click.camera))
        self._measure()

    def digit_pressed(self, number: int) -> None:
        """Choose one of the answers."""
        self._choose(number - 1)

    def accept_current(self) -> None:
        """Put the chosen pipe into the document."""
        pipe = self.measurement.component()
        if pipe is None:
            self.say(tr("There is no pipe to accept yet."))
            return
        before = components_of(self.station_object)
        after = [*(component for component in before if component.id != pipe.id), pipe]
        components, joints = joints_among(before, after, [pipe])
        self.store("Pipe", components, joints)
        self.remember(pipe.id)
        self._start_again()

    def step_back(self) -> bool:
        """Take back a diameter that is being tried, a click, or the answer."""
        self._settle.stop()
        was_step = self.measurement.step_back()
        if self.measurement.request is None:
            self._task.cancel()
        self._show()
        return was_step

    def station_changed(self) -> None:
        """Begin anew in another station."""
        mode, diameter = self.measurement.mode, self.measurement.diameter
        self.measurement = PipeMeasurement(self.station, next_pick_index(self.station_object))
        self.measurement.mode, self.measurement.diameter = mode, diameter

    def refresh(self) -> None:
        """Follow undo and redo: what was accepted may be gone, or back."""
        super().refresh()
        if self.is_open:
            if self.measurement.state is State.EMPTY:
                self.measurement.pick_index = next_pick_index(self.station_object)
            self.show_accepted()

    # measuring

    def _measure(self) -> None:
        request = self.measurement.request
        if request is None:
            self._task.cancel()
        else:
            self._measure_beside(request)
        self._show()

    def _measure_beside(self, request: Request) -> None:
        settings = pick_settings()

        def work(views: tuple[View, ...], tell: Callable[[Sighting], None]) -> PickAnswer:
            return follow_pick(views, request.pick, tell, settings)

        def sighted(sighting: Sighting) -> None:
            self.measurement.sighted(request, sighting)
            self._show()

        def ended(answer: PickAnswer) -> None:
            self.measurement.answered(request, answer)
            self._show()

        def failed(reason: str) -> None:
            self.measurement.failed(request, reason)
            self._show()

        self.run(work, ended, failed, sighted)

    def _choose(self, row: int) -> None:
        if self.measurement.choose(row):
            self._show()

    def _next(self) -> None:
        if self.measurement.answers:
            self._choose((self.measurement.row + 1) % len(self.measurement.answers))

    def _start_again(self) -> None:
        self._settle.stop()
        self._task.cancel()
        self.measurement.restart()
        self.measurement.pick_index = next_pick_index(self.station_object)
        self._show()

    # diameters

    def _wish_changed(self) -> None:
        """Take the list of diameters."""
        self._ask_for(self._wish.currentData())

    def _ask_for(self, diameter: Diameter) -> None:
        self._settle.stop()
        self.measurement.set_diameter(diameter)
        self._measure()

    def _try(self, diameter: float) -> None:
        """Show at once what a diameter would mean, and measure it when the user has settled on it."""
        if self.measurement.try_diameter(diameter) is not None:
            self._draw()
        self._settle.start()

    def _measure_tried(self) -> None:
        """Measure with the diameter that was dragged to."""
        if self._slider.isSliderDown():
            self._settle.start()
            return
        diameter = round(self._spin.value(), 2)
        row = self._wish.findData(diameter)
        self._wish.blockSignals(True)
        if row < 0:
            row = self._wish.count() - 1
            self._wish.setItemData(row, diameter)
            self._wish.setItemText(row, tr("{diameter:g} mm, as entered").format(diameter=diameter))
        self._wish.setCurrentIndex(row)
        self._wish.blockSignals(False)
        self._ask_for(diameter)

    def _slider_moved(self) -> None:
        diameter = self._drag_base * DRAG_RANGE ** (self._slider.value() / DRAG_STEPS)
        self._spin.blockSignals(True)
        self._spin.setValue(diameter)
        self._spin.blockSignals(False)
        self._try(diameter)

    def _spin_changed(self) -> None:
        self._try(self._spin.value())

    # what is shown

    def _make_widgets(self) -> None:
        self._status = words("status")
        self._reason = words("reason")
        self._reason.setStyleSheet(f"color: {WARNING_TEXT}")
        self._mode = choice("mode", tooltip=tr("What a click in a photograph means"))
        for mode, text in MODES.items():
            self._mode.addItem(tr(text), mode)
        self._mode.currentIndexChanged.connect(self.guard(self._mode_changed))
        self._wish = choice("wish", tooltip=tr("Which diameters are possible: those of the standard, any, or a certain one"))
        self._wish.addItem(tr("of the standard"), None)
        self._wish.addItem(tr("any (free)"), "free")
        for size in sorted(pipe_sizes(), key=lambda size: size.outer_diameter):
            self._wish.addItem(f"{size.designation} - {size.outer_diameter:g} mm" if size.dn else f"{size.outer_diameter:g} mm", size.outer_diameter)
        self._wish.addItem(tr("as entered below"), 0.0)
        self._wish.currentIndexChanged.connect(self.guard(self._wish_changed))
        fixing = tr("Fix the outside diameter; the projection follows, and the pipe is measured with it")
        self._spin = amount(SMALLEST_MM, (SMALLEST_MM, LARGEST_MM), "mm", 1, fixing, "diameter")
        self._spin.setKeyboardTracking(False)
        self._spin.valueChanged.connect(self.guard(self._spin_changed))
        self._slider = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal)
        self._slider.setObjectName("drag")
        self._slider.setRange(-DRAG_STEPS, DRAG_STEPS)
        self._slider.setToolTip(tr("Drag to make the pipe thicker or thinner: it moves away or nearer, so that its clicked edges stay"))
        self._slider.valueChanged.connect(self.guard(self._slider_moved))
        self._drag_base = 0.0
        self.table = ChoiceTable(
            [Column(title) for title in ("", tr("Size"), "mm", "m", "px")],
            tr(
                "The pipes that the clicks can mean, the likeliest first: outside diameter, distance, and the quality, which is the mean distance "
                "of the image's edges from the contours"
            ),
        )
        self.table.chosen.connect(self._row_chosen)
        accept = button("accept", tr("Accept"), tr("Put the chosen pipe into the document (Enter)"), self.guard(self.accept_current))
        following = button("next", tr("Next"), tr("Show the next pipe of the list (digits choose directly)"), self.guard(self._next))
        again = button("clear", tr("Clear"), tr("Forget the clicks"), self.guard(self._start_again))
        self._buttons = (accept, following, again)
        form = QtWidgets.QFormLayout()
        form.addRow(tr("A click is"), self._mode)
        form.addRow(tr("Diameter"), self._wish)
        form.addRow(tr("Fixed at"), self._spin)
        form.addRow("", self._slider)
        self.layout.addWidget(self._status)
        self.layout.addLayout(form)
        self.layout.addWidget(self.table)
        self.layout.addWidget(self._reason)
        self.layout.addWidget(beside(*self._buttons))
        self.layout.addWidget(self._accepted_label)

    def _mode_changed(self) -> None:
        self.measurement.mode = self._mode.currentData()

    def _row_chosen(self, row: int) -> None:
        with self.reporting():
            self._choose(row)

    def _show(self) -> None:
        if not self.is_open:
            return
        measurement = self.measurement
        state = measurement.state
        text = tr(WHAT_TO_DO[state])
        self._status.setText(text + (" " + tr("Looking for more ...") if state is State.ANSWERED and measurement.is_measuring else ""))
        self._reason.setText(sentence(measurement.reason))
        self._reason.setVisible(bool(measurement.reason))
        self.table.fill([self._texts(number, answer) for number, answer in enumerate(measurement.answers)], measurement.row)
        accept, following, again = self._buttons
        accept.setEnabled(bool(measurement.answers))
        following.setEnabled(len(measurement.answers) > 1)
        again.setEnabled(state is not State.EMPTY)
        self._show_diameter()
        self._draw()
        self.show_accepted()

    def _texts(self, number: int, answer: PipeCandidate) -> tuple[str, ...]:
        diameter = answer.size.outer_diameter if answer.size else 2 * answer.solution.cylinder.radius
        name = answer.size.designation if answer.size and answer.size.dn else tr("free")
        camera = next(camera for camera in self.station.cameras if camera.name == self.measurement.camera)
        distance = float(np.linalg.norm(answer.solution.cylinder.point - camera.projection_centre))
        mark = " ~" if answer.approximate else ""
        return str(number + 1), name, f"{diameter:.1f}", f"{distance / 1000:.2f}", f"{answer.quality:.2f}{mark}"

    def _show_diameter(self) -> None:
        """Let spin box and slider begin at the diameter that is shown."""
        shown = self.measurement.shown
        for widget in (self._spin, self._slider):
            widget.setEnabled(shown is not None)
            widget.blockSignals(True)
        if shown is not None and not self._settle.isActive():
            self._drag_base = shown.outer_diameter
            self._spin.setValue(shown.outer_diameter)
            self._slider.setValue(0)
        for widget in (self._spin, self._slider):
            widget.blockSignals(False)

    def _draw(self) -> None:
        shown = self.measurement.shown
        self.draw([] if shown is None else [(shown, True)], guess=self.measurement.is_guess, still=self.measurement.camera)
        self._draw_clicks()

    def _draw_clicks(self) -> None:
        layer = self.window.layer(CLICK_LAYER)
        layer.clear()
        if self.measurement.camera is not None and self.measurement.touches:
            layer.set_points(self.measurement.camera, np.array([touch.point for touch in self.measurement.touches]), CLICK_COLOUR)
