# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the Insulation panel answers: pieces, heat and money saved, what is too close, what stays bare and why."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pipeworkbench.errors import InputError
from pipeworkbench.features.insulating import PlannedInsulation
from pipeworkbench.features.insulation import clash_text
from pipeworkbench.gui.colours import BAD_TEXT
from pipeworkbench.gui.tables import Cell, Column, Table, number
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import group, words
from pipeworkbench.solids.covering_quantities import axis_length, layer_volumes, outer_area

if TYPE_CHECKING:
    from pipeworkbench.insulation.clashes import Clash
    from pipeworkbench.insulation.energy import Energy, Yearly
    from pipeworkbench.insulation.planning import Piece

PROBLEMS_SHOWN = 4


@dataclass(frozen=True, eq=False, kw_only=True)
class Outcome:
    """What comes of the panel's settings; energies are None where no temperature of the medium is known."""

    planned: PlannedInsulation
    pieces: tuple[Piece, ...]
    clashes: tuple[Clash, ...]
    problems: tuple[InputError, ...]
    now: Energy | None
    then: Energy | None


class ResultView:
    """Shows an outcome; ``chosen`` is called with the rows of the clashes that the user selects."""

    def __init__(self, chosen: Callable[[list[str]], None]) -> None:
        self.widget, form = group(tr("Result"))
        self.summary = words("summary")
        form.addRow(self.summary)
        # above the tables, which may reach below the window: who presses OK is to have read what stays bare
        self.problems = words("problems")
        self.problems.setStyleSheet(f"color: {BAD_TEXT}")
        form.addRow(self.problems)
        self.energy = Table(
            "energy",
            (
                Column("", names=True),
                Column(tr("Heat W"), tr("While in operation")),
                Column(tr("kWh/a"), tr("Energy that is bought for it in a year")),
                Column(tr("Cost/a"), tr("What that energy costs; a dash where its price is not known")),
                Column(tr("CO2 kg/a"), tr("What it sets free; a dash where the share of a kWh is not known")),
            ),
        )
        form.addRow(self.energy)
        self.clashes = Table(
            "clashes",
            (
                Column(tr("Too close"), tr("Insulation, a bare component or an obstacle"), names=True),
                Column(tr("to"), names=True),
                Column(tr("Distance [mm]"), tr("Of the finished surfaces; negative where they overlap")),
            ),
            chosen,
        )
        form.addRow(self.clashes)

    def show(self, outcome: Outcome | None) -> None:
        """Show an outcome, or that there is none."""
        self.summary.setText(_summary(outcome.pieces) if outcome and outcome.pieces else "")
        self._show_energy(outcome)
        clashes = outcome.clashes if outcome else ()
        self.clashes.setVisible(bool(clashes))
        self.clashes.fill([(f"{place}", _clash_cells(one)) for place, one in enumerate(clashes)])
        self.clashes.setMaximumHeight(self.clashes.minimumHeight())
        problems = outcome.problems if outcome else ()
        texts = [str(problem) for problem in problems[:PROBLEMS_SHOWN]]
        if len(problems) > PROBLEMS_SHOWN:
            texts.append(tr("... and {count} more").format(count=len(problems) - PROBLEMS_SHOWN))
        self.problems.setText("\n".join(texts))
        self.problems.setVisible(bool(texts))

    def _show_energy(self, outcome: Outcome | None) -> None:
        if outcome is None or not outcome.pieces or outcome.now is None or outcome.then is None:
            self.energy.hide()
            return
        now, then = outcome.now.insulated, outcome.then.insulated
        rows = ((tr("now"), now), (tr("with this insulation"), then), (tr("saved"), now.less(then)))
        self.energy.show()
        self.energy.fill([(name, (Cell(name), *_cells(year))) for name, year in rows])
        self.energy.setFixedHeight(self.energy.height_of_rows(len(rows)))


def _summary(pieces: Sequence[Piece]) -> str:
    coverings = [piece.covering for piece in pieces]
    text = tr("{pieces} pieces over {length:.1f} m: {volume:.3f} m³ of insulation, {area:.2f} m² of jacket")
    return text.format(
        pieces=len(pieces),
        length=sum(map(axis_length, coverings)) * 1e-3,
        volume=sum(sum(layer_volumes(one)[: len(one.layers)]) for one in coverings) * 1e-9,
        area=sum(outer_area(one) for one in coverings if one.sheet) * 1e-6,
    )


def _clash_cells(clash: Clash) -> tuple[Cell, ...]:
    text = clash_text(clash)
    return Cell(clash.a, tooltip=text), Cell(clash.b, tooltip=text), number(clash.distance, 0, tooltip=text)


def _cells(year: Yearly) -> tuple[Cell, ...]:
    return number(year.heat, 0), number(year.energy, 0), number(year.cost, 0), number(year.co2, 0)
