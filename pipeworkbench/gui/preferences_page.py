# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pages of this workbench in FreeCAD's preferences: measuring with its tables, and colours."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import FreeCAD

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.features.preferences import SIZES, Colour, Preferences, preferences, save_preferences
from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets
from pipeworkbench.gui.dialogs import ask_folder, show_error
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr

GROUP = "Pipe Workbench"
WARNING_COLOUR = "#c05000"  # legible on light and dark themes
LIMITS = {item.name: item.metadata for item in fields(Preferences) if "low" in item.metadata}
SIZE_TEXTS = {
    "exact": QT_TRANSLATE_NOOP("PipeWorkbench", "Exactly as in the standard"),
    "tolerance": QT_TRANSLATE_NOOP("PipeWorkbench", "Within the standard's tolerances"),
    "free": QT_TRANSLATE_NOOP("PipeWorkbench", "Free, as measured"),
}
KIND_COLOURS = (
    ("pipe_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Pipe")),
    ("elbow_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Elbow")),
    ("flange_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Flange")),
    ("tee_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Tee")),
    ("reducer_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Reducer")),
    ("cap_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Cap")),
    ("approximate_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Approximate pipe")),
)
QUALITY_COLOURS = (
    ("good_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Good")),
    ("fair_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Fair")),
    ("poor_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Poor")),
    ("bad_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Bad")),
    ("unknown_colour", QT_TRANSLATE_NOOP("PipeWorkbench", "Not measured")),
)


class Page:
    """A page of FreeCAD's preferences: ``form``, ``loadSettings`` and ``saveSettings`` are what FreeCAD asks for.

    Subclasses make their fields with `number`, `colour` and so on; each is bound to a field of `Preferences` by its name.
    """

    def __init__(self, title: str) -> None:
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(title)
        self.outer = QtWidgets.QVBoxLayout(self.form)
        self._shown: dict[str, tuple[Callable[[], Any], Callable[[Any], None]]] = {}
        self._loaded = preferences()
        self.build()
        self._message = QtWidgets.QLabel(self.form)
        self._message.setObjectName("message")
        self._message.setWordWrap(True)
        self._message.setStyleSheet(f"color: {WARNING_COLOUR}")
        defaults = QtWidgets.QPushButton(tr("Restore defaults"), self.form)
        defaults.setObjectName("defaults")
        defaults.setToolTip(tr("Set everything on this page to what it was at first"))
        defaults.clicked.connect(lambda: self.show(Preferences()))
        row = QtWidgets.QHBoxLayout()
        row.addWidget(self._message, 1)
        row.addWidget(defaults, 0, QtCore.Qt.AlignmentFlag.AlignTop)
        self.outer.addStretch(1)
        self.outer.addLayout(row)

    def build(self) -> None:
        """Make the page's fields."""
        raise NotImplementedError

    def loadSettings(self) -> None:  # FreeCAD's name
        """Show what is set."""
        self._loaded = preferences()
        self.show(self._loaded)

    def saveSettings(self) -> None:  # FreeCAD's name
        """Write what is shown; what does not fit is told and not written."""
        try:
            # the other page may have saved meanwhile
            save_preferences(self.chosen(preferences()))
        except PipeWorkbenchError as error:
            show_error(tr("The preferences are not changed. {error}").format(error=error))

    def chosen(self, base: Preferences) -> Preferences:
        """Return settings with what is shown on this page; raise InputError where it does not fit."""
        return replace(base, **{name: get() for name, (get, _) in self._shown.items()})

    def show(self, chosen: Preferences) -> None:
        """Show settings."""
        for name, (_, put) in self._shown.items():
            put(getattr(chosen, name))
        self.check()

    def check(self) -> None:
        """Say what does not fit in what is shown."""
        self._message.setText(self.problem())

    def problem(self) -> str:
        """Return what does not fit in what is shown; empty where all does."""
        try:
            self.chosen(self._loaded)
        except PipeWorkbenchError as error:
            return str(error)
        return ""

    def group(self, title: str) -> Any:
        """Return the form layout of a new group."""
        box = QtWidgets.QGroupBox(title, self.form)
        self.outer.addWidget(box)
        return QtWidgets.QFormLayout(box)

    def number(self, layout: Any, name: str, label: str, tooltip: str, unit: str = "mm", decimals: int = 0) -> None:
        """Add a number with its limits."""
        whole = isinstance(getattr(self._loaded, name), int)
        spin = QtWidgets.QSpinBox(self.form) if whole else QtWidgets.QDoubleSpinBox(self.form)
        if not whole:
            spin.setDecimals(decimals)
            spin.setSingleStep(10.0**-decimals)
        spin.setRange(LIMITS[name]["low"], LIMITS[name]["high"])
        spin.setSuffix(f" {unit}" if unit else "")
        spin.valueChanged.connect(lambda _: self.check())
        self._add(layout, name, label, tooltip, spin, (spin.value, spin.setValue))

    def switch(self, layout: Any, name: str, label: str, tooltip: str) -> None:
        """Add something that is on or off."""
        box = QtWidgets.QCheckBox(label, self.form)
        self._add(layout, name, "", tooltip, box, (box.isChecked, box.setChecked))

    def choice(self, layout: Any, name: str, label: str, tooltip: str, texts: Sequence[str], values: Sequence[str]) -> None:
        """Add one of several."""
        box = QtWidgets.QComboBox(self.form)
        box.addItems(list(texts))
        self._add(layout, name, label, tooltip, box, (lambda: values[box.currentIndex()], lambda value: box.setCurrentIndex(values.index(value))))

    def colour(self, layout: Any, name: str, label: str) -> None:
        """Add a colour."""
        button = ColourButton(self.form)
        self._add(layout, name, label, tr("Click to choose another colour"), button, (button.colour, button.set_colour))

    def _add(self, layout: Any, name: str, label: str, tooltip: str, widget: Any, access: tuple[Callable[[], Any], Callable[[Any], None]]) -> None:
        widget.setObjectName(name)
        widget.setToolTip(tooltip)
        layout.addRow(label, widget)
        self._shown[name] = access


class MeasuringPage(Page):
    """Where pipes are looked for, from which tables, and what is still taken for the same."""

    def __init__(self, parent: Any = None) -> None:  # noqa: ARG002  # newer FreeCADs give one
        super().__init__(tr("Measuring"))

    def build(self) -> None:
        """Make the page's fields."""
        self._build_tables()
        layout = self.group(tr("What is looked for"))
        self.number(layout, "nearest", tr("Pipes from"), tr("Distance of the nearest pipes from the cameras"))
        self.number(layout, "farthest", tr("up to"), tr("Distance of the farthest pipes from the cameras"))
        self.number(layout, "smallest_diameter", tr("Outside diameters from"), tr("Thinner pipes are not looked for"), decimals=1)
        self.number(layout, "largest_diameter", tr("up to"), tr("Thicker pipes are not looked for"), decimals=1)
        layout = self.group(tr("Tolerances"))
        self.number(
            layout,
            "size_tolerance_percent",
            tr("Approximate from a deviation of"),
            tr("A pipe whose measured diameter differs by more from the standard's is marked as approximate"),
            "%",
            1,
        )
        self.number(
            layout, "snap_radius_px", tr("Snap to edges within"), tr("How near to an edge the pointer must be, in pixels of the screen"), "px"
        )
        self.number(layout, "joint_gap", tr("Join ends up to"), tr("Ends that face each other and are not farther apart are joined"), decimals=1)
        layout = self.group(tr("Adjustment"))
        self.choice(
            layout,
            "sizes",
            tr("Standard sizes"),
            tr("How the adjustment treats diameters and bend radii of the standards"),
            [tr(SIZE_TEXTS[size]) for size in SIZES],
            SIZES,
        )
        self.number(
            layout,
            "outlier_limit",
            tr("Outliers from"),
            tr("Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier"),
            "",
            2,
        )
        self.switch(
            layout,
            "aligned",
            tr("Pipes that are nearly level, plumb or at right angles are so"),
            tr("A weak condition: what the images say clearly is stronger"),
        )
        layout = self.group(tr("Computer"))
        self.number(layout, "threads", tr("Threads"), tr("How many parts of the processor are used at most"), "")
        self.form.findChild(QtWidgets.QSpinBox, "threads").setSpecialValueText(tr("all"))

    def problem(self) -> str:
        """Return what does not fit, in the tables either."""
        said = super().problem()
        if said:
            return said
        try:
            _try_tables(self._folders())
        except (PipeWorkbenchError, ImportError) as error:
            return str(error)
        return ""

    def saveSettings(self) -> None:  # FreeCAD's name
        """Write what is shown, and use the tables."""
        super().saveSettings()
        from pipeworkbench.features.preferences import start_with_preferred_catalogue

        start_with_preferred_catalogue()

    def _build_tables(self) -> None:
        layout = self.group(tr("Tables of your own"))
        self._list = QtWidgets.QListWidget(self.form)
        self._list.setObjectName("catalogue_folders")
        self._list.setFixedHeight(76)
        self._list.setToolTip(tr("Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'"))
        buttons = QtWidgets.QVBoxLayout()
        for name, text, tooltip, slot in (
            ("add_folder", tr("Add ..."), tr("Add a folder with tables"), self._add_folder),
            ("remove_folder", tr("Remove"), tr("Take the chosen folder from the list; its files stay"), self._remove_folder),
            ("move_up", tr("Up"), tr("Move the chosen folder up"), lambda: self._move(-1)),
            ("move_down", tr("Down"), tr("Move the chosen folder down: its tables come before those above"), lambda: self._move(1)),
        ):
            button = QtWidgets.QToolButton(self.form)
            button.setObjectName(name)
            button.setText(text)
            button.setToolTip(tooltip)
            button.setSizePolicy(QtWidgets.QSizePolicy.Policy.Expanding, QtWidgets.QSizePolicy.Policy.Fixed)
            button.clicked.connect(lambda _=False, slot=slot: slot())
            buttons.addWidget(button)
        buttons.setSpacing(0)
        row = QtWidgets.QHBoxLayout()
        row.addWidget(self._list, 1)
        row.addLayout(buttons)
        layout.addRow(row)
        self._shown["catalogue_folders"] = (self._folders, self._show_folders)

    def _folders(self) -> tuple[str, ...]:
        return tuple(self._list.item(row).text() for row in range(self._list.count()))

    def _show_folders(self, folders: Sequence[str]) -> None:
        self._list.clear()
        self._list.addItems(list(folders))

    def _add_folder(self) -> None:
        folder = ask_folder(tr("A folder with tables of your own"))
        if folder is not None and str(folder) not in self._folders():
            self._list.addItem(str(folder))
            self._list.setCurrentRow(self._list.count() - 1)
            self.check()

    def _remove_folder(self) -> None:
        self._list.takeItem(self._list.currentRow())
        self.check()

    def _move(self, step: int) -> None:
        row = self._list.currentRow()
        target = row + step
        if row >= 0 and 0 <= target < self._list.count():
            self._list.insertItem(target, self._list.takeItem(row))
            self._list.setCurrentRow(target)
            self.check()


class ColoursPage(Page):
    """What components look like in 3D."""

    def __init__(self, parent: Any = None) -> None:  # noqa: ARG002  # newer FreeCADs give one
        super().__init__(tr("Colours"))

    def build(self) -> None:
        """Make the page's fields."""
        layout = self.group(tr("Kinds of components"))
        for name, text in KIND_COLOURS:
            self.colour(layout, name, tr(text))
        layout = self.group(tr("Quality"))
        for name, text in QUALITY_COLOURS:
            self.colour(layout, name, tr(text))
        tooltip = tr("Quality is the root mean square distance of a component's contour from the edges in the photographs")
        self.number(layout, "good_quality_px", tr("Good up to"), tooltip, "px", 2)
        self.number(layout, "fair_quality_px", tr("Fair up to"), tooltip, "px", 2)
        self.number(layout, "poor_quality_px", tr("Poor up to"), tooltip, "px", 2)

    def saveSettings(self) -> None:  # FreeCAD's name
        """Write what is shown, and colour what is open."""
        super().saveSettings()
        try:
            from pipeworkbench.gui.view_providers import recolour
        except ImportError:  # without its packages the workbench has no components to colour
            return
        for document in FreeCAD.listDocuments().values():
            recolour(document)


class ColourButton(QtWidgets.QPushButton):  # type: ignore[misc]  # Qt has no types
    """A button in a colour that asks for another one."""

    def __init__(self, parent: Any) -> None:
        super().__init__(parent)
        self.setFixedWidth(80)
        self._colour: Colour = (0.0, 0.0, 0.0)
        self.clicked.connect(self._ask)

    def colour(self) -> Colour:
        """Return the colour, red, green and blue from 0 to 1."""
        return self._colour

    def set_colour(self, colour: Colour) -> None:
        """Show a colour."""
        self._colour = colour
        pixmap = QtGui.QPixmap(48, 14)
        pixmap.fill(QtGui.QColor.fromRgbF(*colour))
        self.setIcon(QtGui.QIcon(pixmap))
        self.setIconSize(pixmap.size())

    def _ask(self) -> None:
        chosen = QtWidgets.QColorDialog.getColor(QtGui.QColor.fromRgbF(*self._colour), self)
        if chosen.isValid():
            self.set_colour((chosen.redF(), chosen.greenF(), chosen.blueF()))


def _try_tables(folders: Sequence[str]) -> None:
    """Read tables; raise InputError where they do not fit."""
    if folders:
        from pipeworkbench.catalogue import Catalogue

        Catalogue(*(Path(name).expanduser() for name in folders))
