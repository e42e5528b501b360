# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel that puts stations together: which, what they share in colours and in a table, what stays apart and why, and Accept."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import frames_of, state_of
from pipeworkbench.features.document import components_in
from pipeworkbench.features.merging import apply_merge, compute, merge_task
from pipeworkbench.features.preferences import adjustment_settings
from pipeworkbench.gui.colours import BAD, BAD_TEXT, GOOD, Colour
from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.jobs import Progress
from pipeworkbench.gui.overlay import Overlay
from pipeworkbench.gui.panel import Buttons, Panel
from pipeworkbench.gui.selection import select_components, selected_components
from pipeworkbench.gui.tables import Cell, Column, Table, number
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import beside, button, choice, switch, words

if TYPE_CHECKING:
    from pipeworkbench.features.merging import Merged
    from pipeworkbench.recon.register import CandidatePose, PairResidual

CHECKED, UNCHECKED = QtCore.Qt.CheckState.Checked, QtCore.Qt.CheckState.Unchecked
NAME_ROLE = QtCore.Qt.ItemDataRole.UserRole
# of moved stations, one after the other (Okabe and Ito)
STATION_COLOURS: tuple[Colour, ...] = ((0.90, 0.62, 0.0), (0.34, 0.71, 0.91), (0.80, 0.47, 0.65), (0.94, 0.89, 0.26))
GHOST = 0.45  # transparency
LARGE = 3.0  # standard deviations from which a pair's distance is shown in red


class MergePanel(Panel):
    """Puts stations together over the components they share."""

    title = "Merge Stations"
    icon = "merge_stations.svg"
    buttons = (Buttons.Ok, Buttons.Cancel)

    def __init__(self, document: Any = None) -> None:
        super().__init__(document)
        self._merged: Merged | None = None
        self._state: tuple[Any, ...] = ()
        self._assignments: list[tuple[str, str]] = []
        self._candidates: tuple[CandidatePose, ...] = ()
        self._overlay = Overlay(self.document)
        self._build_question()
        self._build_answer()
        self._list_stations()
        self._show_result()

    # the question

    def _build_question(self) -> None:
        box = QtWidgets.QGroupBox(tr("Stations"))
        layout = QtWidgets.QVBoxLayout(box)
        self.stations = QtWidgets.QListWidget()
        self.stations.setObjectName("stations")
        self.stations.setToolTip(tr("All that are checked are merged into the frame of the reference"))
        self.stations.setMaximumHeight(84)
        self.stations.itemChanged.connect(lambda _item: self._list_references())
        layout.addWidget(self.stations)
        self.reference = choice("reference", (), tr("The station that stays where it is"))
        layout.addWidget(beside(QtWidgets.QLabel(tr("Reference")), self.reference))
        self.adjusted = switch(
            "adjusted",
            tr("Adjust over all photographs"),
            tr("All components and the stations' places at once; takes some seconds per station"),
            on=True,
        )
        layout.addWidget(self.adjusted)
        assign = button(
            "assign",
            tr("Assign Selected"),
            tr("Where the search does not find it: say that the two selected components, one of each station, are the same"),
            self.guard(self._assign),
        )
        forget = button("forget", tr("Forget"), tr("Take back what was assigned by hand"), self.guard(self._forget))
        layout.addWidget(beside(assign, forget))
        self.assigned = words("assigned")
        layout.addWidget(self.assigned)
        self.start = button(
            "start",
            tr("Find What They Share"),
            tr("Look how the stations lie to each other; the document stays as it is until you press OK"),
            self.guard(self._compute),
        )
        layout.addWidget(self.start)
        self.layout.addWidget(box)
        self._tell_assigned()

    def _list_stations(self) -> None:
        unchecked = {item.data(NAME_ROLE) for item in self._items() if item.checkState() == UNCHECKED}
        self.stations.blockSignals(True)
        self.stations.clear()
        for frame, objects in frames_of(self.document).items():
            item = QtWidgets.QListWidgetItem(tr("{station} ({count} components)").format(station=frame, count=len(objects)))
            item.setData(NAME_ROLE, frame)
            item.setFlags(item.flags() | QtCore.Qt.ItemFlag.ItemIsUserCheckable)
            item.setCheckState(UNCHECKED if frame in unchecked else CHECKED)
            self.stations.addItem(item)
        self.stations.blockSignals(False)
        self._list_references()

    def _list_references(self) -> None:
        chosen = self.reference.currentText()
        self.reference.clear()
        names = [str(item.data(NAME_ROLE)) for item in self._items() if item.checkState() == CHECKED]
        self.reference.addItems(names)
        if chosen in names:
            self.reference.setCurrentText(chosen)

    def _items(self) -> list[Any]:
        return [self.stations.item(number_) for number_ in range(self.stations.count())]

    def frames(self) -> list[str]:
        """Return the names of the chosen stations, the reference first."""
        names = [self.reference.itemText(number_) for number_ in range(self.reference.count())]
        return sorted(names, key=lambda name: name != self.reference.currentText())

    def _assign(self) -> None:
        pair = selected_components(self.document)
        frame_of = {obj.Name: frame for frame, objects in frames_of(self.document).items() for obj in objects}
        if len(pair) != 2 or frame_of[pair[0].Name] == frame_of[pair[1].Name]:
            raise InputError(self.title, "", tr("not two components of two stations are selected"), tr("select one of each (Ctrl and click)"))
        self._assignments.append((pair[0].ComponentId, pair[1].ComponentId))
        self._tell_assigned()

    def _forget(self) -> None:
        self._assignments.clear()
        self._tell_assigned()

    def _tell_assigned(self) -> None:
        self.assigned.setVisible(bool(self._assignments))
        self.assigned.setText(tr("Assigned by hand: {pairs}").format(pairs=", ".join(f"{a} = {b}" for a, b in self._assignments)))

    def _compute(self, chosen: tuple[CandidatePose, ...] = ()) -> None:
        document = self.document
        adjustment = adjustment_settings() if self.adjusted.isChecked() else None
        task = merge_task(document, self.frames(), with_images=adjustment is not None)
        assignments = tuple(self._assignments)
        state = state_of(document)

        def work(progress: Progress) -> Merged:
            return compute(task, adjustment, assignments, progress, chosen)

        self._merged = self.compute(work)
        self._state = state
        self._show_result()

    # the answer

    def _build_answer(self) -> None:
        self.answer = QtWidgets.QGroupBox(tr("What they share"))
        layout = QtWidgets.QVBoxLayout(self.answer)
        layout.setContentsMargins(4, 4, 4, 4)  # a table needs all the room there is
        self.summary = words("summary")
        layout.addWidget(self.summary)
        self.pairs = Table(
            "pairs",
            (
                Column(tr("Kind")),
                Column(tr("Component"), tr("In the station that was there before"), names=True),
                Column(tr("is"), names=True),
                Column(tr("Distance mm"), tr("Between both after the adjustment of the stations' places; of pipes the larger of both ends")),
                Column(tr("σ"), tr("The distance in standard deviations; 4 and more does not fit")),
                Column(tr("Note"), names=True),
            ),
            self._choose,
        )
        layout.addWidget(self.pairs)
        self.candidates = choice("candidates", (), tr("The station fits at several places: look at each in the 3D view and choose"))
        self.candidates.activated.connect(self.guard(self._choose_candidate))
        layout.addWidget(self.candidates)
        self.layout.addWidget(self.answer)

    def _show_result(self) -> None:
        merged = self._merged
        self.answer.setVisible(merged is not None)
        self.make_room()
        self.enable_button(Buttons.Ok, enabled=self.has_result())
        self._overlay.clear()
        if merged is None:
            return
        self.summary.setText(_summary(merged))
        self.pairs.setVisible(bool(merged.registration.pairs))
        self.pairs.fill([(f"{pair.id_a}\n{pair.id_b}", _cells(pair)) for pair in merged.registration.pairs])
        if merged.registration.candidates:
            self._candidates = merged.registration.candidates
        self._list_candidates()
        self._draw(merged)

    def _list_candidates(self) -> None:
        self.candidates.clear()
        self.candidates.setVisible(bool(self._candidates))
        self.candidates.addItem(tr("Choose one of the places it fits at ..."))
        for place, one in enumerate(self._candidates, 1):
            text = tr("{station} in {reference}, place {place}: {count} components fit (score {score:.1f})")
            self.candidates.addItem(text.format(station=one.station_b, reference=one.station_a, place=place, count=one.explained, score=one.score))

    def _choose_candidate(self) -> None:
        number_ = self.candidates.currentIndex() - 1
        if 0 <= number_ < len(self._candidates):
            self._compute((self._candidates[number_],))

    def _draw(self, merged: Merged) -> None:
        """Show the moved stations' components where they would be, and lines between what is the same."""
        objects = {obj.ComponentId: obj for obj in components_in(self.document)}
        by_frame = {pipeline.frame: pipeline for pipeline in merged.task.pipelines}
        middles = {name: obj.Shape.BoundBox.Center for name, obj in objects.items()}
        motions = {}
        for number_, frame in enumerate(merged.merged_frames[1:]):
            motions[frame] = merged.motion_of(frame)
            for component in by_frame[frame].components:
                colour = STATION_COLOURS[number_ % len(STATION_COLOURS)]
                self._overlay.add_shape(objects[component.id].Shape, colour, GHOST, motions[frame])
        fitting: list[Any] = []
        outlying: list[Any] = []
        for pair in merged.registration.pairs:
            # from where the component is now to its counterpart
            ends = (middles.get(pair.id_a), middles.get(pair.id_b))
            if None not in ends:
                (outlying if pair.outlier else fitting).append(ends)
        self._overlay.add_lines(fitting, GOOD)
        self._overlay.add_lines(outlying, BAD)
        self._overlay.show()

    def _choose(self, keys: list[str]) -> None:
        with self.reporting():
            select_components(self.document, [name for key in keys for name in key.split("\n")])

    # Accept, and the document's own life

    def has_result(self) -> bool:
        """Tell whether there is something to accept."""
        return self._merged is not None and len(self._merged.merged_frames) > 1

    def accept(self) -> bool:
        """Merge and close."""
        return self.attempt(self._apply) and super().accept()

    def _apply(self) -> None:
        merged = self._merged
        if merged is None:
            raise InputError(self.title, "", tr("nothing was put together yet"), tr("press Find What They Share first"))
        self.apply(self.title, lambda: apply_merge(self.document, merged))
        self._merged = None

    def refresh(self) -> None:
        """Forget a result that no longer belongs to what is in the document."""
        self._list_stations()
        if self._merged is not None and state_of(self.document) != self._state:
            self._merged = None
            self._show_result()
            self.say(tr("The components have changed: put the stations together again."))

    def discard(self) -> None:
        """Take the ghosts away."""
        self._overlay.remove()


def _summary(merged: Merged) -> str:
    frames, registration = merged.merged_frames, merged.registration
    lines = []
    if len(frames) > 1:
        lines.append(
            tr("<b>{stations}</b> become one: {pairs} pairs, {count} components, σ₀ {sigma0}").format(
                stations=" + ".join(frames),
                pairs=len(registration.pairs),
                count=len(merged.pipeline.components),
                sigma0=number(merged.solution.sigma0 if merged.solution else registration.sigma0, 2).text,
            )
        )
        for frame in frames[1:]:
            extra = merged.pipeline.stations[frame].extra if frame in merged.pipeline.stations else {}
            if "sigma_position" in extra:
                sigma = sum(value**2 for value in extra["sigma_position"]) ** 0.5
                text = tr("Station {station}: place ± {sigma:.2f} mm, heading ± {heading:.3f}°")
                lines.append(text.format(station=frame, sigma=sigma, heading=extra.get("sigma_heading_deg", 0.0)))
    lines += [f"<span style='color:{BAD_TEXT}'>{problem}</span>" for problem in registration.problems]
    return "<br>".join(lines)


def _cells(pair: PairResidual) -> tuple[Cell, ...]:
    colour = BAD_TEXT if pair.outlier or pair.normalised > LARGE else ""
    note = tr("does not fit") if pair.outlier else tr("follows from its pipes") if pair.weight == 0 else ""
    return (
        Cell(pair.kind),
        Cell(pair.id_a),
        Cell(pair.id_b),
        number(max(pair.distances), 2, colour=colour),
        number(pair.normalised, 1, colour=colour),
        Cell(note),
    )
