# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel that insulates components: how, what it saves, what it runs into, the sheets to cut."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui

from pipeworkbench.errors import InputError
from pipeworkbench.features.document import components_in
from pipeworkbench.features.insulating import Insulated, InsulationTask, task_of
from pipeworkbench.features.insulation import (
    change_insulation,
    insulated_in,
    make_insulation,
    only_plan,
    rules_of,
    run_of,
    write_plan,
)
from pipeworkbench.features.insulation_settings import Settings, settings_of
from pipeworkbench.features.insulation_shapes import model_ahead, shape_of
from pipeworkbench.gui.colours import insulation_colour
from pipeworkbench.gui.compat import QtCore, QtWidgets
from pipeworkbench.gui.dialogs import ask_open, ask_save, saved_files
from pipeworkbench.gui.jobs import Progress, Task
from pipeworkbench.gui.overlay import Overlay
from pipeworkbench.gui.panel import Panel
from pipeworkbench.gui.pipeline_panels.insulation_fields import SettingsFields
from pipeworkbench.gui.pipeline_panels.insulation_result import Outcome, ResultView
from pipeworkbench.gui.selection import SelectionObserver, select_components, selected_components
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import button, choice, words
from pipeworkbench.insulation.specification import Specification

ALL, SELECTED, RUNS, KEPT = range(4)
CANDIDATE = ""  # name of what is not in the document yet
DEBOUNCE_MS = 300
PROBLEMS_SHOWN = 4
GHOST_TRANSPARENCY = 0.4
SHEETS_FILTER = "DXF (*.dxf);;PDF (*.pdf);;SVG (*.svg)"
LISTS_FILTER = "Excel (*.xlsx);;CSV (*.csv)"


@dataclass(frozen=True, eq=False)
class _Question:
    """What is asked: the document's insulation with the panel's settings, and without them."""

    name: str
    task: InsulationTask
    present: InsulationTask | None

    def answer(self) -> Outcome:
        """Plan it; the document is not touched."""
        planned = self.task.plan()
        then = planned.energy(self.name)
        treatments = self.present.plan().treatments if self.present and then else {}
        return Outcome(
            planned=planned,
            pieces=tuple(planned.pieces(self.name)),
            clashes=tuple(planned.clashes(self.name)),
            problems=tuple(planned.problems(self.name)),
            now=planned.energy(self.name, treatments) if then else None,
            then=then,
        )


class InsulationPanel(Panel):
    """Insulates components, or changes an insulation that the document has."""

    title = "Insulation"
    icon = "insulation.svg"

    def __init__(self, document: Any = None, edited: Any = None) -> None:
        super().__init__(document)
        self._edited: str = edited.Name if edited is not None else CANDIDATE
        self._specification: Specification | None = None
        self._outcome: Outcome | None = None
        self._chosen: list[str] = []
        self._selecting = False
        self._task = Task(self.form)
        self._overlay = Overlay(self.document)
        self._timer = QtCore.QTimer(self.form)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DEBOUNCE_MS)
        self._timer.timeout.connect(self.guard(self._ask))
        self._build_scope()
        self.fields = SettingsFields(Settings(), self._settings_changed)
        self.layout.addWidget(self.fields.widget)
        self._build_specification()
        self._build_answer()
        if edited is not None:
            self.depends_on(edited)
            self._load(edited)
        self._selection = SelectionObserver(self.document, self._follow_selection)
        self._follow_selection()
        self._show()
        self._timer.start()

    # the question

    def _build_scope(self) -> None:
        self.scope = choice("scope", ("", "", ""), tr("A component that several insulations hold has the last one"))
        if self._edited:
            self.scope.addItem("")
        self.scope.setCurrentIndex(KEPT if self._edited else SELECTED if selected_components(self.document) else ALL)
        self.scope.currentIndexChanged.connect(self.guard(self._settings_changed))
        form = QtWidgets.QFormLayout()
        form.addRow(tr("Components"), self.scope)
        self.layout.addLayout(form)

    def _build_specification(self) -> None:
        self.rules = words("rules")
        self.layout.addWidget(self.rules)
        self.loaded = button(
            "specification", tr("Specification..."), tr("Read layers, rules for single components, obstacles"), self.guard(self._read)
        )
        self.forgotten = button("forget", tr("Without it"), tr("Leave the specification's rules and obstacles away"), self.guard(self._forget))
        self._add_buttons(self.loaded, self.forgotten)

    def _add_buttons(self, *buttons: Any) -> None:
        row = QtWidgets.QHBoxLayout()
        for one in buttons:
            row.addWidget(one)
        self.layout.addLayout(row)

    def _load(self, edited: Any) -> None:
        self._specification = rules_of(edited) if edited.Specification else None
        self.fields.show(settings_of(edited))

    def _read(self) -> None:
        path = ask_open(tr("Specification of insulation"), "JSON (*.json)")
        if path is None:
            return
        self._specification = Specification.read(path)
        self.fields.show(Settings.of(self._specification))
        self._settings_changed()

    def _forget(self) -> None:
        self._specification = None
        self._settings_changed()

    def _follow_selection(self) -> None:
        if self._selecting:
            return
        names = [obj.Name for obj in selected_components(self.document)]
        if names != self._chosen:
            self._chosen = names
            if self.scope.currentIndex() in (SELECTED, RUNS):
                self._settings_changed()
        self._count()

    def _count(self) -> None:
        counts = {
            ALL: tr("all ({count})").format(count=len(components_in(self.document))),
            SELECTED: tr("selected ({count})").format(count=len(self._selected())),
            RUNS: tr("runs of the selected ({count})").format(count=len(run_of(self._selected()))),
        }
        edited = self._edited_object()
        if edited is not None:
            counts[KEPT] = tr("as it is ({count})").format(count=len(edited.Components))
        for place, text in counts.items():
            self.scope.setItemText(place, text)

    def _selected(self) -> list[Any]:
        found = (self.document.getObject(name) for name in self._chosen)
        return [obj for obj in found if obj is not None]

    def _edited_object(self) -> Any | None:
        return self.document.getObject(self._edited) if self._edited else None

    def _objects(self) -> list[Any]:
        edited = self._edited_object()
        match self.scope.currentIndex():
            case index if index == ALL:
                return components_in(self.document)
            case index if index == KEPT and edited is not None:
                objects = list(edited.Components)
            case index if index == RUNS:
                objects = run_of(self._selected())
            case _:
                objects = self._selected()
        if not objects:
            raise InputError(self.title, "", tr("no component is selected"), tr("select some, or insulate all"))
        return objects

    def _question(self) -> _Question:
        """Gather what the panel's settings mean in the document."""
        ids = tuple(obj.ComponentId for obj in self._objects())
        candidate = Insulated(self._edited, ids, self.fields.settings().specification(self._specification, self.title))
        present = insulated_in(self.document)[0]
        insulated = [candidate if one.name == self._edited else one for one in present]
        if candidate not in insulated:
            insulated.append(candidate)
        return _Question(self._edited, task_of(self.document, insulated), task_of(self.document, present) if present else None)

    # the answer

    def _build_answer(self) -> None:
        self.result = ResultView(self._choose_clash)
        self.layout.addWidget(self.result.widget)
        self.preview = button("preview", tr("Preview"), tr("Show the insulation in 3D; the document stays as it is"), self.guard(self._preview))
        self.sheets = button(
            "sheets", tr("Cut sheets..."), tr("Write the flat parts of the jacket, laid out on sheets"), self.guard(self._save_sheets)
        )
        self.lists = button("lists", tr("Cut list..."), tr("Write the list of parts, sheets and material"), self.guard(self._save_list))
        self._add_buttons(self.preview, self.sheets, self.lists)

    @property
    def is_planning(self) -> bool:
        """Whether the result of what the fields say is still awaited."""
        return bool(self._timer.isActive() or self._task.is_running)

    def _settings_changed(self) -> None:
        self._outcome = None
        self._overlay.clear()
        self._count()
        self._show_specification()
        self._timer.start()

    def _ask(self) -> None:
        self._outcome = None
        try:
            question = self._question()
        except InputError:
            self._task.cancel()
            self._show()
            raise
        self._task.start(lambda _: question.answer(), self._take, self._fail)

    def _take(self, outcome: Outcome) -> None:
        with self.reporting():
            self._outcome = outcome
            self._show()

    def _fail(self, error: Exception) -> None:
        with self.reporting():
            self._show()
            raise error

    def _show(self) -> None:
        """Show the result, or that there is none."""
        self._show_specification()
        for one in (self.preview, self.sheets, self.lists):
            one.setEnabled(bool(self._outcome and self._outcome.pieces))
        self.result.show(self._outcome)
        self.make_room()

    def _show_specification(self) -> None:
        known = self._specification
        self.forgotten.setVisible(known is not None)
        self.rules.setVisible(known is not None)
        if known is not None:
            text = tr("Specification {name}: {rules} rules, {obstacles} obstacles")
            self.rules.setText(text.format(name=known.name, rules=len(known.rules), obstacles=len(known.obstacles)))

    def _choose_clash(self, rows: list[str]) -> None:
        with self.reporting():
            if self._outcome is None or not rows:
                return
            clashes = self._outcome.clashes
            ids = [name for row in rows for name in (clashes[int(row)].a, clashes[int(row)].b)]
            self._selecting = True  # looking at a clash changes nothing of what is to be insulated
            try:
                select_components(self.document, self._outcome.planned.components_of(ids))
            finally:
                self._selecting = False
            FreeCADGui.SendMsgToActiveView("ViewSelection")

    def _answered(self) -> Outcome:
        """Return the result of what the fields say now, with everything modelled."""
        question = self._question()

        def work(progress: Progress) -> Outcome:
            progress(tr("planning the insulation"), 0, 0)
            outcome = question.answer()
            model_ahead([piece.covering for piece in outcome.pieces], progress)
            return outcome

        self._timer.stop()
        self._task.cancel()
        self._outcome = self.compute(work)
        self._show()
        if not self._outcome.pieces:
            raise next(iter(self._outcome.problems), None) or InputError(
                self.title, "", tr("nothing is insulated like this"), tr("give at least one layer")
            )
        return self._outcome

    def _preview(self) -> None:
        settings = self.fields.settings()
        outcome = self._answered()
        self._overlay.clear()
        for piece in outcome.pieces:
            self._overlay.add_shape(shape_of(piece.covering), insulation_colour(settings.jacket, settings.material), GHOST_TRANSPARENCY)
        self._overlay.show()

    def _save_sheets(self) -> None:
        self._save(ask_save(tr("Cut sheets"), SHEETS_FILTER, f"{self.document.Label}.dxf"))

    def _save_list(self) -> None:
        self._save(ask_save(tr("Cut list"), LISTS_FILTER, f"{self.document.Label}.xlsx"))

    def _save(self, path: Path | None) -> None:
        if path is None:
            return
        plan = only_plan(self.document, self._answered().planned.plans)
        language = "de" if QtCore.QLocale().name().startswith("de") else "en"

        def work(progress: Progress) -> None:
            progress(tr("writing {path}").format(path=path.name), 0, 0)
            write_plan(plan, path, language)

        self.compute(work)
        saved_files.append(path)
        self.say(tr("Written: {path}").format(path=path))

    # the document

    def accept(self) -> bool:
        """Insulate and close."""
        return self.attempt(self._insulate) and super().accept()

    def _insulate(self) -> None:
        settings, objects = self.fields.settings(), self._objects()
        self._answered()
        edited = self._edited_object()
        if edited is None:
            self.apply(tr("Insulate"), lambda: make_insulation(self.document, objects, self._specification, **vars(settings)))
        else:
            self.apply(tr("Change the insulation"), lambda: change_insulation(edited, settings, objects, self._specification))
        FreeCAD.Console.PrintMessage(tr("{count} components insulated").format(count=len(objects)) + "\n")

    def refresh(self) -> None:
        """Plan anew: something has changed, this insulation perhaps too."""
        self._count()
        self._timer.start()

    def discard(self) -> None:
        """Take the preview away."""
        self._selection.stop()
        self._timer.stop()
        self._task.cancel()
        self._overlay.remove()
