# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel that writes components to a file: format, which components, the format's options, where to."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.features.document import components_in
from pipeworkbench.features.exporting import FORMATS, TAKE_OFF, ExportTask, Format, export_task
from pipeworkbench.features.insulation import insulations_in
from pipeworkbench.features.preferences import PREFERENCES
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets
from pipeworkbench.gui.dialogs import ask_save, saved_files
from pipeworkbench.gui.jobs import Progress
from pipeworkbench.gui.panel import Panel
from pipeworkbench.gui.selection import SelectionObserver, selected_components
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import beside, button, choice, group, switch, text_line, words

if TYPE_CHECKING:
    from pipeworkbench.exports.ifc import Schema

LANGUAGES = (("en", "English"), ("de", "Deutsch"))
IFC_SCHEMAS: tuple[tuple[Schema, str], ...] = (("IFC4", "IFC4"), ("IFC4X3_ADD2", "IFC 4.3"))
ALL, SELECTED = range(2)
REPORT, IFC = ".html", ".ifc"
TRANSLATED = (REPORT, ".pdf", ".xlsx")  # formats with texts for people


class ExportPanel(Panel):
    """Writes components to a file."""

    title = "Export"
    icon = "export.svg"
    formats: tuple[Format, ...] = FORMATS

    def __init__(self, document: object = None) -> None:
        super().__init__(document)
        self._build()
        self._selection = SelectionObserver(self.document, self._count)
        self._count()
        self._suggest()
        self._choose_format()

    def _build(self) -> None:
        box, form = group(tr("What and where to"))
        self.format = choice("format", [f"{tr(one.name)} (*{one.ending})" for one in self.formats])
        self.format.currentIndexChanged.connect(self.guard(self._choose_format))
        form.addRow(tr("Format"), self.format)
        self.explanation = words("explanation")
        form.addRow(self.explanation)
        self.scope = choice("scope", ("", ""), tr("Joints to components that are left out are left out, too"))
        self.scope.setCurrentIndex(SELECTED if selected_components(self.document) else ALL)
        form.addRow(tr("Components"), self.scope)
        self.options = QtWidgets.QWidget()
        options = QtWidgets.QFormLayout(self.options)
        options.setContentsMargins(0, 0, 0, 0)
        self.report_title = text_line("reportTitle", tr("The report's heading, such as the project's name"), self.document.Label)
        options.addRow(tr("Heading"), self.report_title)
        self.photographs = switch("photographs", tr("Photographs with contours"), tr("They make most of the file's size"), on=True)
        options.addRow(self.photographs)
        self.opened = switch("opened", tr("Open it afterwards"), tr("In the browser"), on=True)
        options.addRow(self.opened)
        form.addRow(self.options)
        self.language = choice("language", [name for _, name in LANGUAGES], tr("Of the texts in the file"))
        self.language.setCurrentIndex(int(QtCore.QLocale().name().startswith("de")))
        self.language_row = _row(tr("Language"), self.language)
        form.addRow(self.language_row)
        self.schema = choice("ifcSchema", [name for _, name in IFC_SCHEMAS], tr("IFC4 is what most programs read"))
        self.schema_row = _row(tr("Version"), self.schema)
        form.addRow(self.schema_row)
        self.insulation = switch("insulation", tr("With insulation"), tr("Around what is insulated in the document"), on=True)
        form.addRow(self.insulation)
        self.path = text_line("path", tr("A file that is there is replaced"))
        browse = button("browse", "...", tr("Choose folder and name"), self.guard(self._browse))
        form.addRow(tr("File"), beside(self.path, browse))
        self.layout.addWidget(box)

    def _chosen(self) -> Format:
        return self.formats[self.format.currentIndex()]

    def _count(self) -> None:
        self.scope.setItemText(ALL, tr("all ({count})").format(count=len(components_in(self.document))))
        self.scope.setItemText(SELECTED, tr("selected ({count})").format(count=len(selected_components(self.document))))

    def _suggest(self) -> None:
        last = FreeCAD.ParamGet(PREFERENCES).GetString("LastFolder", str(Path.home()))
        folder = Path(self.document.FileName).parent if self.document.FileName else Path(last)
        self.path.setText(str(folder / f"{self.document.Label}{self._chosen().ending}"))

    def _choose_format(self) -> None:
        chosen = self._chosen()
        self.options.setVisible(chosen.ending == REPORT)
        self.language_row.setVisible(chosen.ending in TRANSLATED)
        self.schema_row.setVisible(chosen.ending == IFC)
        self._show_insulation()
        if self.path.text().strip():
            path = Path(self.path.text().strip())
            # with one name for all tables, one would replace another
            stem = path.stem.removesuffix(f"-{TAKE_OFF}") + (f"-{chosen.key}" if chosen.key else "")
            self.path.setText(str(path.with_name(stem + chosen.ending)))

    def _show_insulation(self) -> None:
        chosen, is_there = self._chosen(), bool(insulations_in(self.document))
        lacking = chosen.insulation == "needed" and not is_there
        self.explanation.setText(tr(chosen.explanation) + (". " + tr("Nothing is insulated yet: use Insulation first.") if lacking else ""))
        self.insulation.setVisible(chosen.insulation == "carried" and is_there)

    def _browse(self) -> None:
        path = ask_save(tr("Export"), self._chosen().filter, Path(self.path.text().strip() or ".").name)
        if path is not None:
            self.path.setText(str(path))

    def accept(self) -> bool:
        """Write the file and close."""
        return self.attempt(self._write) and super().accept()

    def _write(self) -> None:
        path = self._checked_path()
        objects = None
        if self.scope.currentIndex() == SELECTED:
            objects = selected_components(self.document)
            if not objects:
                raise InputError(self.title, "", tr("no component is selected"), tr("select some, or export all"))
        language = LANGUAGES[self.language.currentIndex()][0]
        chosen = self._chosen()
        task = export_task(
            self.document,
            path.suffix,
            objects,
            key=chosen.key if path.suffix.lower() == chosen.ending else "",
            title=self.report_title.text().strip(),
            language=language,
            photographs=self.photographs.isChecked(),
            ifc_schema=IFC_SCHEMAS[self.schema.currentIndex()][0],
            insulation=self.insulation.isChecked(),
        )
        self.compute(lambda progress: _written(task, path, progress))
        saved_files.append(path)
        FreeCAD.Console.PrintMessage(tr("written: {path}").format(path=path) + "\n")
        if path.suffix.lower() == REPORT and self.opened.isChecked():
            open_in_browser(path)

    def _checked_path(self) -> Path:
        text = self.path.text().strip()
        if not text:
            raise InputError(self.title, "", tr("there is no file name"), tr("give one"))
        path = Path(text).expanduser()
        return path if path.suffix else path.with_suffix(self._chosen().ending)

    def refresh(self) -> None:
        """Count anew; insulation may have come or gone, too."""
        self._count()
        self._show_insulation()

    def discard(self) -> None:
        """Hear no more of the selection."""
        self._selection.stop()


class ReportPanel(ExportPanel):
    """Writes a report, and nothing else."""

    title = "Report"
    icon = "report.svg"
    formats = tuple(one for one in FORMATS if one.ending == REPORT)


def _row(name: str, field: Any) -> Any:
    """Return a field with its name, which are shown and hidden together."""
    holder = QtWidgets.QWidget()
    form = QtWidgets.QFormLayout(holder)
    form.setContentsMargins(0, 0, 0, 0)
    form.addRow(name, field)
    return holder


def open_in_browser(path: Path) -> None:
    """Show a file in the user's browser."""
    QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(path)))


def _written(task: ExportTask, path: Path, progress: Progress) -> None:
    progress(f"writing {path.name}", 0, 0)
    task.write(path)
