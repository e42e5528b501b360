# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of the common adjustment: what and how, the result beside what was before, residuals, and Apply."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.adjusting import apply_adjustment, compute, state_of, tasks_of
from pipeworkbench.features.document import components_in
from pipeworkbench.features.preferences import adjustment_settings
from pipeworkbench.gui.colours import BAD_TEXT
from pipeworkbench.gui.compat import QtWidgets
from pipeworkbench.gui.jobs import Progress
from pipeworkbench.gui.panel import Buttons, Panel
from pipeworkbench.gui.pipeline_panels.residuals import ResidualVectors
from pipeworkbench.gui.selection import SelectionObserver, select_components, selected_components
from pipeworkbench.gui.tables import Cell, Column, Table, from_to, number
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import amount, button, choice, group, switch, words

if TYPE_CHECKING:
    from pipeworkbench.features.adjusting import Adjusted
    from pipeworkbench.recon.adjust import AdjustmentSettings
    from pipeworkbench.recon.adjustment.changes import Change
    from pipeworkbench.recon.adjustment.solution import Solution

ALL, SELECTED = range(2)
SIZES = ("exact", "tolerance", "free")  # of AdjustmentSettings


class AdjustPanel(Panel):
    """Adjusts all components, or those selected, to the edges of all photographs."""

    title = "Adjust"
    icon = "adjust.svg"
    buttons = (Buttons.Ok, Buttons.Apply, Buttons.Cancel)

    def __init__(self, document: Any = None) -> None:
        super().__init__(document)
        self._results: list[Adjusted] = []
        self._applied = False
        self._state: tuple[Any, ...] = ()
        self._residuals = ResidualVectors(self.document)
        self._build_question()
        self._build_answer()
        self._selection = SelectionObserver(self.document, self._count)
        self._count()
        self._show_results()

    # the question

    def _build_question(self) -> None:
        box, form = group(tr("What and how"))
        self.scope = choice("scope", ("", ""), tr("Components that are fixed, or not selected, stay where they are"))
        self.scope.setCurrentIndex(SELECTED if selected_components(self.document) else ALL)
        form.addRow(tr("Adjust"), self.scope)
        self.sizes = choice(
            "sizes",
            (tr("exact"), tr("within their tolerances"), tr("not trusted")),
            tr("Diameters, bend radii and flange dimensions of standards; sizes that are no standard's are always measured"),
        )
        self.sizes.setCurrentIndex(SIZES.index(adjustment_settings().sizes))
        form.addRow(tr("Standard sizes"), self.sizes)
        self.reach = amount(
            3.0, (2.0, 100.0), "px", 0, tr("How far from the contours edges are looked for: more where components lie beside their pictures")
        )
        form.addRow(tr("Edges within"), self.reach)
        self.gasket = amount(2.0, (0.0, 10.0), "mm", 1, tr("Between the faces of two flanges that are bolted together"))
        form.addRow(tr("Gasket"), self.gasket)
        self.aligned = switch(
            "aligned",
            tr("Level, plumb and square runs"),
            tr("Runs that are nearly so are taken to be so, with little weight: the photographs decide where they say something else"),
        )
        self.aligned.setChecked(adjustment_settings().aligned)
        form.addRow(self.aligned)
        self.to_neighbours = switch(
            "to_neighbours",
            tr("Stay joined to what stays"),
            tr("Otherwise selected components follow their own edges, and gaps may open to their neighbours"),
            on=True,
        )
        form.addRow(self.to_neighbours)
        self.start = button(
            "start", tr("Adjust"), tr("Compute the adjustment; the document stays as it is until you apply it"), self.guard(self._compute)
        )
        form.addRow(self.start)
        self.layout.addWidget(box)

    def settings(self) -> AdjustmentSettings:
        """Return the settings that the panel shows."""
        sizes: Any = SIZES[self.sizes.currentIndex()]
        return replace(adjustment_settings(self.reach.value()), sizes=sizes, aligned=self.aligned.isChecked(), gasket=self.gasket.value())

    def _count(self) -> None:
        """Say how many components each choice means."""
        self.scope.setItemText(ALL, tr("all components ({count})").format(count=len(components_in(self.document))))
        self.scope.setItemText(SELECTED, tr("selected components ({count})").format(count=len(selected_components(self.document))))

    def _compute(self) -> None:
        document = self.document
        objects = None
        if self.scope.currentIndex() == SELECTED:
            objects = selected_components(document)
            if not objects:
                raise InputError(self.title, "", tr("no component is selected"), tr("select some, or adjust all"))
        tasks, settings = tasks_of(document, objects, to_neighbours=self.to_neighbours.isChecked()), self.settings()
        state = state_of(document)

        def work(progress: Progress) -> list[Adjusted]:
            return [compute(task, settings, progress) for task in tasks]

        self._results = self.compute(work)
        self._applied = False
        self._state = state
        self._show_results()
        self._show_residuals()

    # the answer

    def _build_answer(self) -> None:
        self.answer = QtWidgets.QGroupBox(tr("Result"))
        layout = QtWidgets.QVBoxLayout(self.answer)
        layout.setContentsMargins(4, 4, 4, 4)  # a table needs all the room there is
        self.summary = words("summary")
        layout.addWidget(self.summary)
        self.tabs = QtWidgets.QTabWidget()
        layout.addWidget(self.tabs)
        self.components = Table(
            "components",
            (
                Column(tr("Component"), names=True),
                Column(tr("Shift mm"), tr("How far its middle moves; of pipes across their axis")),
                Column(tr("Turn °"), tr("How far its axis turns")),
                Column(tr("σ mm"), tr("Standard deviation of its position before and after")),
                Column(tr("q px"), tr("RMS distance of its contours to the edges (Eq. 4) before and after")),
                Column(tr("LOA"), tr("Level of accuracy (USIBD)")),
                Column(tr("Note"), names=True),
            ),
            self._choose,
        )
        self.images = Table(
            "images",
            (
                Column(tr("Photograph"), names=True),
                Column(tr("RMS px"), tr("Of the distances between contours and edges")),
                Column(tr("Edges %"), tr("Part of the contours' samples that have an edge")),
            ),
        )
        self.gross = Table(
            "outliers",
            (
                Column(tr("What does not fit"), names=True),
                Column(tr("By"), tr("px in photographs, mm or degrees of conditions")),
                Column(tr("w"), tr("Standardised size (Baarda); 3.3 and more is a gross error")),
                Column(tr("Use"), tr("Whether it still counts")),
            ),
        )
        self.warnings = QtWidgets.QTextEdit()
        self.warnings.setObjectName("warnings")
        self.warnings.setReadOnly(True)
        pages = ((self.components, tr("Components")), (self.images, tr("Photographs")), (self.gross, tr("Outliers")), (self.warnings, tr("Warnings")))
        for widget, title in pages:
            self.tabs.addTab(widget, title)
        self.with_residuals = switch(
            "residuals",
            tr("Residuals in the photographs"),
            tr("An arrow from each contour point that counts to its edge, enlarged by the window's slider"),
        )
        self.with_residuals.toggled.connect(self.guard(self._show_residuals))
        layout.addWidget(self.with_residuals)
        self.layout.addWidget(self.answer)

    def _show_results(self) -> None:
        there = bool(self._results)
        self.answer.setVisible(there)
        self.make_room()
        for standard in (Buttons.Ok, Buttons.Apply):
            self.enable_button(standard, enabled=there and not self._applied)
        solutions = [result.solution for result in self._results]
        self.summary.setText("<br>".join(_summary(result) for result in self._results))
        self.components.fill([(change.after.id, _cells(change, result.solution)) for result in self._results for change in result.changes])
        self.images.fill(_image_rows(solutions))
        gross = [one for solution in solutions for one in solution.gross]
        self.gross.fill(
            [
                (one.what, (Cell(one.what), number(one.size, 2), number(one.w, 1), Cell(tr("left out") if one.left_out else tr("counts"))))
                for one in gross
            ]
        )
        warnings = _warnings(solutions)
        self.warnings.setPlainText("\n\n".join(warnings) or tr("None: everything is determined and nothing is weakly placed."))
        for page, count in ((self.gross, len(gross)), (self.warnings, len(warnings))):
            index = self.tabs.indexOf(page)
            title = self.tabs.tabText(index).split(" (")[0]
            self.tabs.setTabText(index, f"{title} ({count})" if count else title)

    def _show_residuals(self) -> None:
        if self.with_residuals.isChecked() and self._results:
            self._residuals.show([result.solution for result in self._results])
        else:
            self._residuals.hide()

    def _choose(self, ids: list[str]) -> None:
        with self.reporting():
            select_components(self.document, ids)

    # Apply, and the document's own life

    def has_result(self) -> bool:
        """Tell whether there is a result that is not applied."""
        return bool(self._results) and not self._applied

    def accept(self) -> bool:
        """Apply and close."""
        return self.attempt(self._apply) and super().accept()

    def clicked(self, button: int) -> None:
        """Apply and stay open."""
        if button == int(getattr(Buttons.Apply, "value", Buttons.Apply)):
            self.attempt(self._apply)

    def _apply(self) -> None:
        if not self.has_result():
            raise InputError(self.title, "", tr("there is no result yet"), tr("press Adjust first"))
        results = self._results
        self.apply(self.title, lambda: apply_adjustment(self.document, results))
        self._applied = True
        self._state = state_of(self.document)
        self._show_results()

    def refresh(self) -> None:
        """Forget a result that no longer belongs to what is in the document."""
        self._count()
        if self._results and state_of(self.document) != self._state:
            self._results = []
            self._show_results()
            self._residuals.hide()
            self.say(tr("The components have changed: adjust them again."))

    def discard(self) -> None:
        """Take the residuals away."""
        self._selection.stop()
        self._residuals.hide()


def _summary(result: Adjusted) -> str:
    solution = result.solution
    ended = tr("converged") if solution.converged else f"<b style='color:{BAD_TEXT}'>{tr('did not converge')}</b>"
    return tr("<b>Station {frame}</b>: σ₀ {sigma0}, edges ± {sigma} px, redundancy {redundancy}, {count} iterations, {ended}").format(
        frame=result.pipeline.frame,
        sigma0=number(solution.sigma0, 2).text,
        sigma=number(solution.sigma_image, 2).text,
        redundancy=number(solution.redundancy, 0).text,
        count=solution.iterations,
        ended=ended,
    )


def _cells(change: Change, solution: Solution) -> tuple[Cell, ...]:
    before, after = change.before, change.after
    return (
        Cell(after.id, tooltip=f"{after.id} ({after.kind})"),
        number(change.shift, 2),
        number(change.rotation_deg, 3),
        from_to(_sigma(before), _sigma(after), 2),
        from_to(before.quality, after.quality, 2),
        Cell((after.loa or "–").removeprefix("LOA")),
        _note(change, solution),
    )


def _note(change: Change, solution: Solution) -> Cell:
    weak = next((one for one in solution.weak if one.component == change.after.id), None)
    if change.before.fixed:
        return Cell(tr("fixed"))
    if change.after.id in solution.undetermined:
        return Cell(tr("not determined"), tooltip=solution.undetermined[change.after.id], colour=BAD_TEXT)
    if weak is not None:
        return Cell(tr("weak"), tooltip=weak.reason, colour=BAD_TEXT)
    return Cell("")


def _sigma(component: Any) -> float | None:
    return None if component.sigma_position is None else math.hypot(*component.sigma_position)


def _image_rows(solutions: Sequence[Solution]) -> list[tuple[str, tuple[Cell, ...]]]:
    from pipeworkbench.recon.adjustment.changes import image_fits

    fits = [fit for solution in solutions for fit in image_fits(solution)]
    return [
        (f"{fit.station}/{fit.image}", (Cell(f"{fit.station} / {fit.image}"), number(fit.rms, 2), number(100 * fit.found / max(fit.samples, 1), 0)))
        for fit in fits
    ]


def _warnings(solutions: Sequence[Solution]) -> list[str]:
    texts: list[str] = []
    for solution in solutions:
        texts += solution.warnings
        texts += [tr("{component} is weakly placed (σ {sigma:.1f} mm): {reason}").format(**one._asdict()) for one in solution.weak]
        if not solution.converged:
            texts.append(solution.message)
    return texts
