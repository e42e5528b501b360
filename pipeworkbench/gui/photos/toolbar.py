# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photo window's slim toolbar: navigation, loupe, brightness, layers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

from pipeworkbench.files import package_folder
from pipeworkbench.gui.compat import QAction, QtCore, QtGui, QtWidgets
from pipeworkbench.gui.photos.contours import Colouring
from pipeworkbench.gui.photos.picture import Tone
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP, tr

ICON_PX = 18
SLIDER_STEPS = 100
CONTRAST_RANGE, GAMMA_RANGE, VECTOR_RANGE = (0.25, 4.0), (0.3, 3.0), (1.0, 1000.0)
VECTOR_START = 100.0
INK = "currentColor"  # in the icons' files: the colour of the theme's text

# name, icon, text and tooltip of the layers that the user switches
LAYERS = (
    (
        "contours",
        "contours",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Contours"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Contours of the pipes and fittings"),
    ),
    (
        "edges",
        "edges",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Edges"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Edges found in the photographs, with subpixel accuracy"),
    ),
    (
        "lines",
        "lines",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Straight lines"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Straight edges found in the photographs"),
    ),
    (
        "epipolar",
        "epipolar",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Search band"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Where the point under the pointer lies in the other photographs, from near to far"),
    ),
    (
        "residuals",
        "residuals",
        QT_TRANSLATE_NOOP("PipeWorkbench", "Residuals"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Residuals of the last adjustment, enlarged"),
    ),
)


class Actions(Protocol):
    """What the toolbar does."""

    def fit(self) -> None:
        """Show all photographs whole."""

    def one_to_one(self) -> None:
        """Show them pixel by pixel."""

    def set_linked(self, linked: bool) -> None:  # noqa: FBT001
        """Let all photographs show the same object."""

    def set_loupe(self, shown: bool) -> None:  # noqa: FBT001
        """Show the loupe at the pointer."""

    def set_tone(self, tone: Tone) -> None:
        """Show the photographs with other brightness."""

    def show_layer(self, name: str, shown: bool) -> None:  # noqa: FBT001
        """Show or hide a layer."""

    def set_vector_scale(self, scale: float) -> None:
        """Draw residuals longer or shorter."""

    def set_colouring(self, colouring: Colouring) -> None:
        """Let the contours' colours say something else."""

    def set_hidden_shown(self, shown: bool) -> None:  # noqa: FBT001
        """Show what components hide of each other, or not."""


class PhotoToolbar(QtWidgets.QToolBar):  # type: ignore[misc]  # Qt has no types
    """The buttons above the photographs."""

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        self._actions = actions
        self.setIconSize(QtCore.QSize(ICON_PX, ICON_PX))
        self.setMovable(False)
        self._add("fit", tr("Fit"), tr("Show the photographs whole (F)"), actions.fit)
        self._add("one_to_one", "1:1", tr("Show one pixel of the photograph as one of the screen (Ctrl+1)"), actions.one_to_one)
        self.linked = self._toggle(
            "linked", tr("Same place"), tr("Show the same part of the object in the middle of all photographs"), actions.set_linked
        )
        self.loupe = self._toggle("loupe", tr("Loupe"), tr("Enlarge the pixels around the pointer (L)"), actions.set_loupe)
        self._add_brightness()
        self.addSeparator()
        self.layers: dict[str, Any] = {}
        for name, icon_name, text, tooltip in LAYERS:
            self.layers[name] = self._toggle(icon_name, tr(text), tr(tooltip), partial(actions.show_layer, name))
        self._add_settings()

    def _add(self, icon_name: str, text: str, tooltip: str, function: Callable[[], None]) -> Any:
        action = QAction(themed_icon(icon_name, self.palette()), text, self)
        action.setToolTip(tooltip)
        action.triggered.connect(lambda *_: function())
        self.addAction(action)
        return action

    def _toggle(self, icon_name: str, text: str, tooltip: str, function: Callable[[bool], None]) -> Any:
        action = QAction(themed_icon(icon_name, self.palette()), text, self)
        action.setToolTip(tooltip)
        action.setCheckable(True)
        action.toggled.connect(function)
        self.addAction(action)
        return action

    def _add_brightness(self) -> None:
        """Add a button with sliders for contrast and gamma."""
        panel = QtWidgets.QWidget()
        layout = QtWidgets.QGridLayout(panel)
        self.contrast = LogarithmicSlider(CONTRAST_RANGE, 1.0, tr("Contrast of the photographs"))
        self.gamma = LogarithmicSlider(GAMMA_RANGE, 1.0, tr("Brightens the dark parts to the right, darkens to the left"))
        reset = QtWidgets.QPushButton(tr("Reset"))
        reset.setToolTip(tr("Show the photographs as they are, stretched to the screen's range"))
        for row, (text, slider) in enumerate(((tr("Contrast"), self.contrast), (tr("Gamma"), self.gamma))):
            layout.addWidget(QtWidgets.QLabel(text), row, 0)
            layout.addWidget(slider, row, 1)
            slider.valueChanged.connect(lambda *_: self._actions.set_tone(Tone(self.contrast.number, self.gamma.number)))
        layout.addWidget(reset, 2, 1)
        for slider in (self.contrast, self.gamma):
            reset.clicked.connect(slider.reset)
        self._add_popup("brightness", tr("Brightness"), tr("Contrast and brightness of the photographs"), panel)

    def _add_settings(self) -> None:
        """Add a button with what the layers look like."""
        panel = QtWidgets.QWidget()
        layout = QtWidgets.QGridLayout(panel)
        layout.addWidget(QtWidgets.QLabel(tr("Colours of the contours")), 0, 0)
        colouring = QtWidgets.QComboBox()
        colouring.setToolTip(tr("What the colours of the contours tell"))
        for text, value in ((tr("by kind"), Colouring.KIND), (tr("by quality"), Colouring.QUALITY)):
            colouring.addItem(text, value.value)
        colouring.currentIndexChanged.connect(lambda index: self._actions.set_colouring(Colouring(colouring.itemData(index))))
        layout.addWidget(colouring, 0, 1)
        hidden = QtWidgets.QCheckBox(tr("Dash what is hidden"))
        hidden.setToolTip(tr("Show the parts of the contours that are behind something as dashed lines"))
        hidden.setChecked(True)
        hidden.toggled.connect(self._actions.set_hidden_shown)
        layout.addWidget(hidden, 1, 0, 1, 2)
        layout.addWidget(QtWidgets.QLabel(tr("Length of the residuals")), 2, 0)
        self.vector_scale = LogarithmicSlider(VECTOR_RANGE, VECTOR_START, tr("How many times their length residuals are drawn"))
        self.vector_scale.valueChanged.connect(lambda *_: self._actions.set_vector_scale(self.vector_scale.number))
        layout.addWidget(self.vector_scale, 2, 1)
        self.colouring, self.hidden_shown = colouring, hidden
        self._add_popup("settings", tr("Display"), tr("Colours of the contours and length of the residuals"), panel)

    def _add_popup(self, icon_name: str, text: str, tooltip: str, panel: QtWidgets.QWidget) -> None:
        button = QtWidgets.QToolButton()
        button.setIcon(themed_icon(icon_name, self.palette()))
        button.setText(text)
        button.setToolTip(tooltip)
        button.setPopupMode(QtWidgets.QToolButton.ToolButtonPopupMode.InstantPopup)
        menu = QtWidgets.QMenu(button)
        holder = QtWidgets.QWidgetAction(menu)
        holder.setDefaultWidget(panel)
        menu.addAction(holder)
        button.setMenu(menu)
        self.addWidget(button)


class LogarithmicSlider(QtWidgets.QSlider):  # type: ignore[misc]
    """A slider over a range of factors, evenly spaced by ratio."""

    def __init__(self, factors: tuple[float, float], start: float, tooltip: str) -> None:
        super().__init__(QtCore.Qt.Orientation.Horizontal)
        self._low, self._high = factors
        self._start = start
        self.setRange(0, SLIDER_STEPS)
        self.setMinimumWidth(140)
        self.setToolTip(tooltip)
        self.reset()

    @property
    def number(self) -> float:
        """The factor."""
        return float(self._low * (self._high / self._low) ** (self.value() / SLIDER_STEPS))

    def set_number(self, number: float) -> None:
        """Move to the step next to a factor."""
        import math

        self.setValue(round(SLIDER_STEPS * math.log(number / self._low) / math.log(self._high / self._low)))

    def reset(self, *_: object) -> None:
        """Move back to where it started."""
        self.set_number(self._start)

    def mouseDoubleClickEvent(self, event: Any) -> None:  # noqa: ARG002  # Qt's name
        """Move back to where it started."""
        self.reset()


def themed_icon(name: str, palette: QtGui.QPalette) -> QtGui.QIcon:
    """Return an icon of this window in the colour of the theme's text."""
    source = (package_folder("resources") / "icons" / "photos" / f"{name}.svg").read_text(encoding="utf-8")
    icon = QtGui.QIcon()
    for mode, group in ((QtGui.QIcon.Mode.Normal, QtGui.QPalette.ColorGroup.Active), (QtGui.QIcon.Mode.Disabled, QtGui.QPalette.ColorGroup.Disabled)):
        ink = palette.color(group, QtGui.QPalette.ColorRole.ButtonText).name()
        pixmap = QtGui.QPixmap()
        pixmap.loadFromData(source.replace(INK, ink).encode(), "SVG")
        icon.addPixmap(pixmap, mode)
    return icon
