# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation to files: one writer per format, chosen by the file's ending."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from pipeworkbench.errors import InputError
from pipeworkbench.exports import cut_lists, dxf, ifc, labels, pcf, sheet_pictures, step
from pipeworkbench.exports.sheets import NestedSheet, nest, refuse_too_large
from pipeworkbench.insulation.flat import Pattern
from pipeworkbench.insulation.materials import material, sheet_metal
from pipeworkbench.insulation.patterns import patterns_of, patterns_of_piece
from pipeworkbench.insulation.planning import Plan


@dataclass(frozen=True, eq=False)
class Insulated:
    """A planned insulation, with the parts, sheets and lists that follow from it once they are asked for.

    ``language`` is that of lists, pictures and labels, ``ifc_schema`` that of IFC.
    """

    plan: Plan
    language: str = "en"
    ifc_schema: ifc.Schema = "IFC4"

    @property
    def title(self) -> str:
        """What stands above lists and pictures."""
        return self.plan.specification.name or self.plan.pipeline.frame

    @property
    def runs(self) -> dict[str, str]:
        """The runs' names by the coverings' ids."""
        return {piece.covering.id: piece.run for piece in self.plan.pieces}

    @functools.cached_property
    def patterns(self) -> tuple[Pattern, ...]:
        """The parts of sheet metal."""
        return patterns_of(self.plan)

    @functools.cached_property
    def sheets(self) -> tuple[NestedSheet, ...]:
        """The parts on sheets of the specification's sizes; none where there is no jacket."""
        return nest(self.patterns, self.plan.specification.sheet_sizes) if self.patterns else ()

    @functools.cached_property
    def lists(self) -> cut_lists.CutLists:
        """What must be cut and ordered."""
        prices = {name.casefold(): price for name, price in self.plan.specification.prices.items()}
        return cut_lists.cut_lists(
            self.patterns,
            self.sheets,
            self.plan.pieces,
            sheet_density=_sheet_density,
            layer_density=_layer_density,
            price=lambda name: prices.get(name.casefold()),
        )


OF_SHEETS = (".dxf", ".svg", ".pdf")  # endings of what cannot be without a part
WRITERS: Mapping[str, Callable[[Insulated, Path], None]] = {
    ".dxf": lambda made, path: dxf.write_dxf(made.sheets, path),
    ".svg": lambda made, path: sheet_pictures.write_sheet_pictures(made.sheets, path, language=made.language, title=made.title),
    ".pdf": lambda made, path: sheet_pictures.write_sheet_pictures(made.sheets, path, language=made.language, title=made.title),
    ".csv": lambda made, path: cut_lists.write_cut_list_csv(made.lists, path),
    ".xlsx": lambda made, path: cut_lists.write_cut_list_xlsx(made.lists, path, language=made.language, title=made.title),
    ".step": lambda made, path: step.write_step(made.plan.pipeline, path, made.plan),
    ".ifc": lambda made, path: ifc.write_ifc(made.plan.pipeline, path, ifc.IfcOptions(schema=made.ifc_schema, plan=made.plan)),
    ".pcf": lambda made, path: pcf.write_pcf(made.plan.pipeline, path, made.plan),
}


def write(made: Insulated, path: Path) -> None:
    """Write an insulation in the format of the path's ending, one of `WRITERS`; errors are those of the writers."""
    WRITERS[path.suffix.lower()](made, path)


def write_labels(made: Insulated, path: Path) -> None:
    """Write a label for each part of sheet metal, as pages of A4 or as a table as the path ends."""
    labels.write_labels(labels.labels_of_sheets(made.sheets, made.runs), path, language=made.language)


def cutting_problems(plan: Plan) -> tuple[InputError, ...]:
    """Return why sheet metal of a plan cannot be developed or cut from its sheets, at most one problem of each piece."""
    problems = []
    for piece in plan.pieces:
        try:
            for pattern in patterns_of_piece(plan, piece):
                refuse_too_large(pattern, plan.specification.sheet_sizes)
        except InputError as error:
            problems.append(error)
    return tuple(problems)


def refuse_unwritable(made: Insulated, outputs: Iterable[Path], labels: Path | None = None, parts: Path | None = None) -> None:
    """Raise what writing would raise once other files are written: no part to be cut, and parts whose files are there already.

    Parameters
    ----------
    made : Insulated
    outputs : iterable of Path
        Files to be written, by their endings.
    labels : Path, optional
        Their file.
    parts : Path, optional
        The parts' folder.

    Raises
    ------
    InputError
        Also where a part cannot be developed or does not fit the sheets.
    """
    outputs = list(outputs)
    cut = [path for path in (*(path for path in outputs if path.suffix.lower() in OF_SHEETS), labels, parts) if path is not None]
    if cut and not made.sheets:
        remedy = "give the insulation a jacket of sheet metal" if made.plan.pieces else "insulate at least one component"
        raise InputError(cut[0], "", "there is no part to be cut", remedy)
    written = {path.resolve() for path in outputs}
    for file in dxf.part_files(made.patterns, parts) if parts is not None else ():
        if file.resolve() in written:
            raise InputError(file, "", "is an output and the name of a part as well", "choose another name or another folder for the parts")
        if file.exists() or file.is_symlink():
            raise InputError(file, "", "is there already and would be lost", "name a new or an empty folder for the parts")


def _sheet_density(name: str) -> float | None:
    return sheet_metal(name).density


def _layer_density(name: str) -> float | None:
    return material(name).density
