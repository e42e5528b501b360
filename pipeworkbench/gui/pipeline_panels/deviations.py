# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel that compares what was built with what was designed: a model or solids, the table, colours in 3D, CSV."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import state_of
from pipeworkbench.features.comparing import Comparison, compare_with_model, compare_with_solids, distances_to_surface, has_shape
from pipeworkbench.features.document import components_in, pipeline_of
from pipeworkbench.features.kinds import is_component
from pipeworkbench.gui.colours import BAD, GOOD, POOR, Colour, hex_of
from pipeworkbench.gui.compat import QtWidgets
from pipeworkbench.gui.dialogs import ask_open, ask_save
from pipeworkbench.gui.jobs import Progress
from pipeworkbench.gui.overlay import Overlay
from pipeworkbench.gui.panel import Buttons, Panel
from pipeworkbench.gui.selection import SelectionObserver, select_components, selected_components, selected_objects
from pipeworkbench.gui.tables import Cell, Column, Table, number
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import amount, beside, button, choice, group, switch, text_line, words

if TYPE_CHECKING:
    from pipeworkbench.recon.plant import Deviation

IFC, SOLIDS, SURFACE = range(3)
WITHIN, BETWEEN, BEYOND = GOOD, POOR, BAD
UNKNOWN: Colour = (0.75, 0.75, 0.75)
GOOD_MM, BAD_MM = 5.0, 20.0
DIAMETER_DIFFERS = 0.02  # of the diameter: no mill tolerance


class DeviationsPanel(Panel):
    """Measures how components deviate from a design."""

    title = "Deviations"
    icon = "deviations.svg"
    buttons = (Buttons.Close,)

    def __init__(self, document: Any = None) -> None:
        super().__init__(document)
        self._comparison: Comparison | None = None
        self._state: tuple[Any, ...] = ()
        self._solids: list[str] = []
        self._overlay = Overlay(self.document)
        self._build_question()
        self._build_answer()
        self._selection = SelectionObserver(self.document, self._follow_selection)
        self._follow_selection()
        self._choose_source()
        self._show_result()

    # the question

    def _build_question(self) -> None:
        box, form = group(tr("As designed"))
        self.source = choice(
            "source",
            (tr("Pipes of an IFC file"), tr("Pipes of selected solids"), tr("Surface of selected solids")),
            tr("Round outer faces of solids are taken for pipes; to a surface only the shortest distance is measured"),
        )
        self.source.currentIndexChanged.connect(self.guard(self._choose_source))
        form.addRow(tr("Compare with"), self.source)
        self.path = text_line("path", tr("An IFC model with the pipes as designed, as IfcPipeSegment"))
        self.path.setPlaceholderText(tr("model.ifc"))
        self.file_row = beside(self.path, button("browse", "...", tr("Choose the file"), self.guard(self._browse)))
        form.addRow(self.file_row)
        self.chosen = words("chosen")
        form.addRow(self.chosen)
        self.fit = switch(
            "fit",
            tr("Fit the model to the pipework"),
            tr("Where the model has other coordinates than the document; else both are compared as they stand"),
        )
        form.addRow(self.fit)
        self.only_selected = switch(
            "only_selected", tr("Selected components only"), tr("Else all components are compared"), on=bool(selected_components(self.document))
        )
        form.addRow(self.only_selected)
        self.start = button("start", tr("Compare"), tr("Measure the deviations; the document stays as it is"), self.guard(self._compute))
        form.addRow(self.start)
        self.layout.addWidget(box)

    def _choose_source(self) -> None:
        source = self.source.currentIndex()
        self.file_row.setVisible(source == IFC)
        self.chosen.setVisible(source != IFC)
        self.fit.setEnabled(source != SURFACE)
        self.fit.setChecked(source == IFC)

    def _browse(self) -> None:
        path = ask_open(tr("The model as designed"), "IFC (*.ifc)", Path(self.path.text()).parent if self.path.text() else None)
        if path is not None:
            self.path.setText(str(path))

    def _follow_selection(self) -> None:
        """Take selected solids for the design; selecting components afterwards does not forget them."""
        solids = [obj for obj in selected_objects(self.document) if not is_component(obj) and has_shape(obj)]
        if solids:
            self._solids = [obj.Name for obj in solids]
        labels = [obj.Label for obj in self._designed()]
        self.chosen.setText(tr("Solids: {labels}").format(labels=", ".join(labels)) if labels else tr("Select the solids in the tree or in 3D."))

    def _designed(self) -> list[Any]:
        found = (self.document.getObject(name) for name in self._solids)
        return [obj for obj in found if obj is not None]

    def _compute(self) -> None:
        document, source = self.document, self.source.currentIndex()
        objects = selected_components(document) if self.only_selected.isChecked() else None
        if objects is not None and not objects:
            raise InputError(self.title, "", tr("no component is selected"), tr("select some, or compare all"))
        if source != IFC and not self._designed():
            raise InputError(self.title, "", tr("no solid is selected"), tr("select the solids as designed in the tree or in 3D"))
        state = state_of(document)
        if source == IFC:
            self._comparison = self._compared_with_ifc(objects)
        elif source == SOLIDS:
            self._comparison = compare_with_solids(document, self._designed(), objects, fit=self.fit.isChecked())
        else:
            self._comparison = distances_to_surface(document, self._designed(), objects)
        self._state = state
        self._show_result()

    def _compared_with_ifc(self, objects: list[Any] | None) -> Comparison:
        if not self.path.text().strip():
            raise InputError(self.title, "", tr("there is no IFC file"), tr("choose the model as designed"))
        path, fit = Path(self.path.text().strip()), self.fit.isChecked()
        built = pipeline_of(self.document, objects)

        def work(progress: Progress) -> Comparison:
            progress(tr("comparing with the model"), 0, 0)
            return compare_with_model(built, path, fit=fit)

        return self.compute(work)

    # the answer

    def _build_answer(self) -> None:
        self.answer = QtWidgets.QGroupBox(tr("Deviations"))
        layout = QtWidgets.QVBoxLayout(self.answer)
        layout.setContentsMargins(4, 4, 4, 4)  # a table needs all the room there is
        self.summary = words("summary")
        layout.addWidget(self.summary)
        self.table = Table(
            "deviations",
            (
                Column(tr("Component"), tr("As built"), names=True),
                Column(tr("Distance mm"), tr("Of the axes, the larger of both ends of what they have in common; of surfaces the shortest")),
                Column(tr("Δx mm"), tr("From the design to what was built")),
                Column(tr("Δy mm"), tr("From the design to what was built")),
                Column(tr("Δz mm"), tr("From the design to what was built")),
                Column(tr("Angle °"), tr("Between both axes")),
                Column(tr("Diameter mm"), tr("As built; in red where the design has another, which the tooltip tells")),
                Column(tr("As designed"), names=True),
                Column(tr("Note"), names=True),
            ),
            self._choose,
        )
        layout.addWidget(self.table)
        self.coloured = switch(
            "coloured",
            tr("Colours in 3D"),
            tr("Green within the first limit, yellow up to the second, red beyond; grey has no counterpart"),
            on=True,
        )
        self.coloured.toggled.connect(self.guard(self._draw))
        layout.addWidget(self.coloured)
        limits = []
        for text, colour, value in ((tr("up to"), WITHIN, GOOD_MM), (tr("beyond"), BEYOND, BAD_MM)):
            limit = amount(value, (0.0, 1000.0), "mm", 1)
            limit.valueChanged.connect(self.guard(self._recolour))
            limits += [QtWidgets.QLabel(f"{_sample(colour)} {text}"), limit]
        _, self.good, _, self.bad = limits
        layout.addWidget(beside(*limits))
        layout.addWidget(button("csv", tr("Save as CSV ..."), tr("The table for a spreadsheet"), self.guard(self._save)))
        self.layout.addWidget(self.answer)

    def _show_result(self) -> None:
        self.answer.setVisible(self._comparison is not None)
        self.make_room()
        self._fill()
        self._draw()

    def _recolour(self) -> None:
        if self.bad.value() < self.good.value():
            self.bad.setValue(self.good.value())
        self._fill()
        self._draw()

    def _fill(self) -> None:
        if self._comparison is None:
            return
        deviations = self._comparison.deviations
        rows = [(one.built_id or "", self._cells(one)) for one in deviations]
        self.table.fill(rows)
        self.summary.setText(_summary(self._comparison, self.good.value(), self.bad.value()))

    def _cells(self, deviation: Deviation) -> tuple[Cell, ...]:
        from pipeworkbench.exports.deviations import NOT_BUILT, NOT_DESIGNED

        note = NOT_BUILT if deviation.built_id is None else NOT_DESIGNED if deviation.designed_id is None else ""
        colour = hex_of(self._colour(deviation)) if deviation.distances and max(deviation.distances) > self.bad.value() else ""
        offset = deviation.offset or (None, None, None)
        return (
            Cell(deviation.built_id or "–", tooltip=f"{deviation.built_id or deviation.designed_id} ({deviation.kind})"),
            number(max(deviation.distances, default=None), 1, colour=colour),
            *(number(value, 1) for value in offset),
            number(deviation.angle_deg, 2),
            _diameter(deviation),
            Cell(deviation.designed_id or "–"),
            Cell(tr(note) if note else ""),
        )

    def _colour(self, deviation: Deviation) -> Colour:
        if not deviation.distances:
            return UNKNOWN
        distance = max(deviation.distances)
        return WITHIN if distance <= self.good.value() else BETWEEN if distance <= self.bad.value() else BEYOND

    def _draw(self) -> None:
        """Show components in the colour of their deviation."""
        self._overlay.clear()
        if self._comparison is None or not self.coloured.isChecked():
            return
        objects = {obj.ComponentId: obj for obj in components_in(self.document)}
        for deviation in self._comparison.deviations:
            if deviation.built_id in objects:
                self._overlay.add_shape(objects[deviation.built_id].Shape, self._colour(deviation))
        self._overlay.show()

    def _choose(self, ids: list[str]) -> None:
        with self.reporting():
            select_components(self.document, ids)

    def _save(self) -> None:
        from pipeworkbench.exports.deviations import write_deviations

        if self._comparison is None:
            return
        path = ask_save(tr("Save deviations"), "CSV (*.csv)", f"{self.document.Label} deviations.csv")
        if path is not None:
            write_deviations(self._comparison.deviations, path)
            self.say(tr("Written: {path}").format(path=path))

    # the document's own life

    def refresh(self) -> None:
        """Forget a result that no longer belongs to what is in the document."""
        self._follow_selection()
        if self._comparison is not None and state_of(self.document) != self._state:
            self._comparison = None
            self._show_result()
            self.say(tr("The components have changed: compare them again."))

    def discard(self) -> None:
        """Give the components their own colours back."""
        self._selection.stop()
        self._overlay.remove()


def _diameter(deviation: Deviation) -> Cell:
    built, designed = deviation.built_diameter, deviation.designed_diameter
    if built is None or designed is None:
        return number(built or designed, 1)
    differs = abs(built - designed) > DIAMETER_DIFFERS * designed
    tooltip = tr("designed {designed:.1f} mm, difference {difference:+.1f} mm").format(designed=designed, difference=built - designed)
    return number(built, 1, colour=hex_of(BEYOND) if differs else "", tooltip=tooltip)


def _summary(comparison: Comparison, good: float, bad: float) -> str:
    distances = [max(one.distances) for one in comparison.deviations if one.distances]
    counts = (
        sum(distance <= good for distance in distances),
        sum(good < distance <= bad for distance in distances),
        sum(distance > bad for distance in distances),
    )
    parts = (
        f"{_sample(WITHIN)} {tr('{count} within {limit:g} mm').format(count=counts[0], limit=good)}",
        f"{_sample(BETWEEN)} {tr('{count} up to {limit:g} mm').format(count=counts[1], limit=bad)}",
        f"{_sample(BEYOND)} {tr('{count} beyond').format(count=counts[2])}",
        f"{_sample(UNKNOWN)} {tr('{count} without counterpart').format(count=len(comparison.deviations) - len(distances))}",
    )
    largest = tr("Largest distance {distance:.1f} mm.").format(distance=max(distances)) if distances else ""
    return "<br>".join(filter(None, ("&nbsp; ".join(parts[:2]), "&nbsp; ".join(parts[2:]), largest, *comparison.remarks)))


def _sample(colour: Colour) -> str:
    return f"<span style='color:{hex_of(colour)}'>&#9632;</span>"
