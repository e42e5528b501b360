# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of the Insulation panel: layers and jacket, bends and flanges, operation."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from pipeworkbench.features.component import NONE
from pipeworkbench.features.insulation_settings import FIXED, HEAT_LOSS, LONGER, SPECIFIED, SURFACE, Settings, choices_of
from pipeworkbench.gui.compat import QtWidgets
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr
from pipeworkbench.gui.widgets import amount, choice, switch
from pipeworkbench.insulation.heat_loss import ABSOLUTE_ZERO
from pipeworkbench.insulation.operation import HOURS_OF_A_YEAR, STRONGEST_WIND

THICKEST_MM, HOTTEST_C, LONGEST_MM, HIGHEST = 1000.0, 1500.0, 10000.0, 1000.0
MOST_GORES = 40
# how lists show what settings call otherwise; materials and tables have their names
SHOWN = {
    FIXED: QT_TRANSLATE_NOOP("PipeWorkbench", "fixed"),
    HEAT_LOSS: QT_TRANSLATE_NOOP("PipeWorkbench", "by heat loss"),
    SURFACE: QT_TRANSLATE_NOOP("PipeWorkbench", "by surface temperature"),
    SPECIFIED: QT_TRANSLATE_NOOP("PipeWorkbench", "as the specification says"),
    NONE: QT_TRANSLATE_NOOP("PipeWorkbench", "none"),
    "segmented": QT_TRANSLATE_NOOP("PipeWorkbench", "segmented"),
    "smooth": QT_TRANSLATE_NOOP("PipeWorkbench", "smooth"),
    "mitre": QT_TRANSLATE_NOOP("PipeWorkbench", "two pieces with a mitre"),
    "refuse": QT_TRANSLATE_NOOP("PipeWorkbench", "refuse"),
    "half": QT_TRANSLATE_NOOP("PipeWorkbench", "half as long as the others"),
    "equal": QT_TRANSLATE_NOOP("PipeWorkbench", "as long as the others"),
    LONGER: QT_TRANSLATE_NOOP("PipeWorkbench", "longer than the half"),
    "box": QT_TRANSLATE_NOOP("PipeWorkbench", "boxes"),
    "bare": QT_TRANSLATE_NOOP("PipeWorkbench", "bare"),
}


class SettingsFields:
    """Widgets for settings; what they do not show is kept. ``changed`` is called when the user has changed something."""

    def __init__(self, settings: Settings, changed: Callable[[], None]) -> None:
        self._kept = settings
        self._lists: dict[str, tuple[Any, list[str]]] = {}
        self._amounts: dict[str, tuple[Any, bool]] = {}  # with whether the least value says that it is not known
        self._switches: dict[str, Any] = {}
        self._rows: dict[str, tuple[Any, Any]] = {}
        self._changed = changed
        self.widget = QtWidgets.QTabWidget()
        self.widget.setObjectName("settings")
        self._build_layers(self._tab(tr("Layers")))
        self._build_shapes(self._tab(tr("Bends, flanges")))
        self._build_operation(self._tab(tr("Operation")))
        self.show(settings)

    def settings(self) -> Settings:
        """Return what the fields say."""
        values: dict[str, Any] = {name: items[box.currentIndex()] for name, (box, items) in self._lists.items()}
        for name, (box, can_be_unknown) in self._amounts.items():
            box.interpretText()  # what is being typed counts, too
            values[name] = None if can_be_unknown and box.value() <= box.minimum() else box.value()
        values |= {name: box.isChecked() for name, box in self._switches.items()}
        return dataclasses.replace(self._kept, **values | {"gores": round(values["gores"])})

    def show(self, settings: Settings) -> None:
        """Fill the fields; nobody is told of it."""
        self._kept = settings
        boxes = [box for box, _ in (*self._lists.values(), *self._amounts.values())] + list(self._switches.values())
        before = [box.blockSignals(True) for box in boxes]
        for name, (box, items) in self._lists.items():
            value = getattr(settings, name)
            if value not in items:  # of a user's table that is not in use
                items.append(value)
                box.addItem(value)
            box.setCurrentIndex(items.index(value))
        for name, (box, _) in self._amounts.items():
            value = getattr(settings, name)
            box.setValue(box.minimum() if value is None else value)
        for name, box in self._switches.items():
            box.setChecked(getattr(settings, name))
        for box, blocked in zip(boxes, before, strict=True):
            box.blockSignals(blocked)
        self._arrange()

    def _build_layers(self, form: Any) -> None:
        self._list(form, "thickness_rule", tr("Thickness"), tr("A fixed one, or what it follows from: a table, the heat a metre may lose, ..."))
        self._amount(form, "thickness", "", (0.0, THICKEST_MM), "mm", 1, tr("Of the inner layer"))
        self._amount(form, "limit", tr("At most"), (0.0, HIGHEST), "W/m", 1, tr("Heat that a metre of pipe may lose, or temperature of the surface"))
        self._switch(form, "stock", tr("Round up to what can be bought"), tr("The next thickness that merchants keep in stock"))
        self._list(form, "material", tr("Material"), tr("Of the inner layer"))
        second = self._list(None, "second_material", "", tr("Material of a layer around the first"))
        thickness = self._amount(None, "second_thickness", "", (0.0, THICKEST_MM), "mm", 1, tr("Thickness of the second layer"))
        form.addRow(tr("Second layer"), second)
        self._row(form, "second_thickness", "", thickness)
        self._list(form, "jacket", tr("Jacket"), tr("Sheet metal around the insulation"))
        self._amount(form, "sheet_thickness", tr("Sheet"), (0.0, 5.0), "mm", 2, tr("Thickness of the sheet metal"), special=tr("by DIN 4140"))

    def _build_shapes(self, form: Any) -> None:
        self._list(form, "bend_shape", tr("Bends"), tr("Of straight pieces of sheet metal, or round as foam shells are"))
        self._amount(form, "gores", tr("Pieces"), (0, MOST_GORES), "", 0, tr("Of a segmented bend"), special=tr("by rule"))
        self._list(form, "first_gore", tr("First and last"), tr("How long the first and the last piece of a bend are"))
        self._amount(
            form, "first_gore_extra", tr("Longer by"), (0.0, LONGEST_MM), "mm", 1, tr("What the first and the last piece reach over the pipe")
        )
        self._list(form, "tight_bends", tr("Tight bends"), tr("What is done where the insulation is too thick for a bend's radius"))
        self._list(form, "flange_cover", tr("Flanges"), tr("Boxes of two half shells, or nothing"))
        self._amount(form, "clearance", tr("Clearance"), (0.0, LONGEST_MM), "mm", 0, tr("Between a flange's rim and the inside of its box"))
        self._amount(
            form, "minimum_distance", tr("Distance"), (0.0, LONGEST_MM), "mm", 0, tr("What is closer to the finished surface is listed as a clash")
        )

    def _build_operation(self, form: Any) -> None:
        low = ABSOLUTE_ZERO
        self._amount(form, "medium_temperature", tr("Medium"), (low, HOTTEST_C), "°C", 1, tr("Temperature of what flows"), can_be_unknown=True)
        self._amount(form, "ambient_temperature", tr("Surroundings"), (low + 1, HOTTEST_C), "°C", 1, tr("Temperature of the air around"))
        self._amount(form, "wind_speed", tr("Wind"), (0.0, STRONGEST_WIND), "m/s", 1, tr("0 indoors"))
        self._amount(form, "hours_per_year", tr("Hours in a year"), (0.0, HOURS_OF_A_YEAR), "h", 0, tr("Of operation"))
        self._amount(form, "price_per_kwh", tr("Price"), (0.0, HIGHEST), "/kWh", 4, tr("Of the energy that is bought"), can_be_unknown=True)
        self._amount(form, "co2_per_kwh", tr("CO2"), (0.0, HIGHEST), "kg/kWh", 4, tr("Of the energy that is bought"), can_be_unknown=True)
        self._amount(
            form, "efficiency", tr("Efficiency"), (0.01, 10.0), "", 2, tr("Heat delivered over energy bought: 0.9 of a boiler, 3 of a heat pump")
        )

    def _tab(self, title: str) -> Any:
        page = QtWidgets.QWidget()
        form = QtWidgets.QFormLayout(page)
        form.setFieldGrowthPolicy(QtWidgets.QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.widget.addTab(page, title)
        return form

    def _list(self, form: Any, name: str, label: str, tooltip: str) -> Any:
        items = list(choices_of(name))
        box = choice(name, [tr(SHOWN[item]) if item in SHOWN else item for item in items], tooltip)
        box.currentIndexChanged.connect(self._tell)
        self._lists[name] = box, items
        if form is not None:
            self._row(form, name, label, box)
        return box

    def _amount(
        self,
        form: Any,
        name: str,
        label: str,
        limits: tuple[float, float],
        unit: str,
        decimals: int,
        tooltip: str,
        special: str = "",
        *,
        can_be_unknown: bool = False,
    ) -> Any:
        box = amount(limits[0], limits, unit, decimals, tooltip, name)
        box.setKeyboardTracking(False)
        if special or can_be_unknown:
            box.setSpecialValueText(special or tr("not known"))
        box.valueChanged.connect(self._tell)
        self._amounts[name] = box, can_be_unknown
        if form is not None:
            self._row(form, name, label, box)
        return box

    def _switch(self, form: Any, name: str, text: str, tooltip: str) -> None:
        box = switch(name, text, tooltip)
        box.toggled.connect(self._tell)
        self._switches[name] = box
        self._row(form, name, "", box)

    def _row(self, form: Any, name: str, label: str, box: Any) -> None:
        title = QtWidgets.QLabel(label)
        form.addRow(title, box)
        self._rows[name] = title, box

    def _tell(self, *_: Any) -> None:
        self._arrange()
        self._changed()

    def _arrange(self) -> None:
        """Show the fields that mean something with what the others say."""
        values = self.settings()
        rule = values.thickness_rule
        limited = rule in (HEAT_LOSS, SURFACE)
        said = {
            "thickness": rule == FIXED,
            "limit": limited,
            "stock": rule not in (FIXED, SPECIFIED),
            "second_thickness": values.second_material != NONE,
            "sheet_thickness": values.jacket != NONE,
            "gores": values.bend_shape == "segmented",
            "first_gore": values.bend_shape == "segmented",
            "first_gore_extra": values.bend_shape == "segmented" and values.first_gore == LONGER,
            "clearance": values.flange_cover == "box",
        }
        for name, visible in said.items():
            for widget in self._rows[name]:
                widget.setVisible(visible)
        self._amounts["limit"][0].setSuffix(" °C" if rule == SURFACE else " W/m")
        for name in ("material", "second_material"):
            self._lists[name][0].setEnabled(rule != SPECIFIED)
