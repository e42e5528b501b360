# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of the measuring tools: a task panel that works in the photo windows of its document.

A tool listens to all photo windows of its document and works on the station that was clicked in last. It ends
with the window it works in and with the station, and leaves nothing behind: what it shows are overlays and ghosts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, TypeVar

import FreeCADGui

from pipeworkbench.errors import InputError
from pipeworkbench.gui.compat import QtWidgets, is_alive
from pipeworkbench.gui.panel import Buttons, Panel
from pipeworkbench.gui.photos.window import PhotoWindow, open_photo_window, photo_window
from pipeworkbench.gui.tools.ghosts import Ghosts
from pipeworkbench.gui.tools.measured import in_document, put_into_document
from pipeworkbench.gui.tools.task import Task
from pipeworkbench.gui.translation import tr
from pipeworkbench.pipeline import AnyComponent, Joint
from pipeworkbench.recon.image_curves import contours_in
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View

T = TypeVar("T")
N = TypeVar("N")

CHOSEN_COLOUR = "#ff4fd8"  # unlike all colours of components, legible on grey
OTHER_COLOUR = "#ffd24f"
CLICK_COLOUR = "#ff4fd8"
LAYER = "proposal"
CLICK_LAYER = "clicks"
WIDTH_CHOSEN, WIDTH_OTHER = 2.2, 1.4

Drawn = tuple[AnyComponent, bool]  # a component, and whether it is the chosen one


class Tool(Panel):
    """A measuring tool; subclasses say what clicks and keys mean.

    Attributes
    ----------
    window : PhotoWindow
        That is worked in.
    """

    snapping: ClassVar[bool] = False
    hint: ClassVar[str] = ""
    buttons = (Buttons.Close,)

    def __init__(self, station_object: Any) -> None:
        super().__init__(station_object.Document)
        self.window: PhotoWindow = open_photo_window(station_object)
        if self.window.is_missing:
            raise InputError(station_object.Label, "", tr("its photographs are missing"), tr("say where they are in its photo window"))
        self._station_name: str = station_object.Name
        self._was_opened = False
        self._windows: list[PhotoWindow] = []
        self._ghosts = Ghosts(self.document)
        self._task = Task(self.form)

    # what subclasses override

    def opened(self) -> None:
        """Begin, once the panel is shown."""

    def photo_clicked(self, click: Any) -> None:
        """Take a click in a photograph."""

    def digit_pressed(self, number: int) -> None:
        """Take a digit."""

    def accept_current(self) -> None:
        """Take Enter in a photograph."""

    def station_changed(self) -> None:
        """Forget what belongs to the former station: a photograph of another one was clicked in."""

    # what subclasses use

    @property
    def station(self) -> Station:
        """The station that is worked on."""
        return self.window.station

    @property
    def station_object(self) -> Any:
        """Its document object."""
        return self.window.station_object

    def run(
        self,
        function: Callable[[tuple[View, ...], Callable[[N], None]], T],
        ended: Callable[[T], None],
        failed: Callable[[str], None] | None = None,
        news: Callable[[N], None] = lambda _: None,
    ) -> None:
        """Run a function of the station's views beside the window, instead of what is running; see ``Task.start``.

        It waits for the views where they are not ready yet. Errors are told in the panel.
        """
        window = self.window
        self._task.start(
            lambda tell: function(window.wait_for_views(), tell), self._reported(ended), failed or self._tell_failure, self._reported(news)
        )

    def draw(self, drawn: Sequence[Drawn], *, guess: bool = False) -> None:
        """Show components in all photographs and in 3D, the chosen one on top; a ``guess`` is dashed."""
        if self.window.is_closed:
            return
        layer = self.window.layer(LAYER)
        layer.live = True  # it changes while something is dragged: the photographs below need not be drawn anew
        layer.clear()
        curves = [contours_in(self.station, [component])[0] for component, _ in drawn]
        for camera in (camera.name for camera in self.station.cameras):
            for chosen, colour, width in ((False, OTHER_COLOUR, WIDTH_OTHER), (True, CHOSEN_COLOUR, WIDTH_CHOSEN)):
                lines = [line for (_, is_chosen), by_camera in zip(drawn, curves, strict=True) if is_chosen is chosen for line in by_camera[camera]]
                if lines:
                    layer.add_polylines(camera, lines, colour, width=width, dashed=guess)
        self._ghosts.show((in_document(self.station_object, component), CHOSEN_COLOUR if chosen else OTHER_COLOUR) for component, chosen in drawn)

    def clear_drawing(self) -> None:
        """Show no proposals any more."""
        for window in self._open_windows:
            window.layer(LAYER).clear()
            window.layer(CLICK_LAYER).clear()
        self._ghosts.clear()

    def store(self, name: str, components: Sequence[AnyComponent], joints: Iterable[Joint] = ()) -> list[Any]:
        """Put components of the station's level frame into the document as one step of undo."""
        return self.apply(tr(name), lambda: put_into_document(self.station_object, components, joints))

    # Panel's side

    def open(self) -> None:
        """Show the panel and listen to the photographs."""
        if self._was_opened:
            return  # FreeCAD calls it once more while it shows the panel
        self._was_opened = True
        super().open()
        self._listen(self.window)
        area = _mdi_area()
        if area is not None:
            area.subWindowActivated.connect(self._window_activated)
        with self.reporting():
            self.opened()

    def refresh(self) -> None:
        """End with the station; subclasses bring their lists up to date."""
        if self.document.getObject(self._station_name) is None:
            self.close()

    def discard(self) -> None:
        """Leave the photographs and views as they were."""
        area = _mdi_area()
        if area is not None:
            area.subWindowActivated.disconnect(self._window_activated)
        self._task.cancel()
        self._ghosts.clear()
        for window in self._open_windows:
            window.layer(LAYER).clear()
            window.layer(CLICK_LAYER).clear()
            window.set_tool(False)
            for signal, slot in self._slots(window):
                signal.disconnect(slot)
        self._windows.clear()

    def step_back(self) -> bool:
        """Take Esc; subclasses say whether there was a step to take back."""
        return False

    # how it listens

    @property
    def _open_windows(self) -> list[PhotoWindow]:
        return [window for window in self._windows if is_alive(window) and not window.is_closed]

    def _listen(self, window: PhotoWindow) -> None:
        if window in self._windows:
            return
        self._windows.append(window)
        for signal, slot in self._slots(window):
            signal.connect(slot)
        window.set_tool(True, snapping=self.snapping, hint=tr(self.hint))

    def _slots(self, window: PhotoWindow) -> list[tuple[Any, Callable[..., None]]]:
        """Return a window's signals with what takes them; bound methods, so that they can be disconnected."""
        return [
            (window.clicked, self._take_click),
            (window.accepted, self._take_enter),
            (window.stepped_back, self._take_escape),
            (window.digit_pressed, self._take_digit),
            (window.closed, self._take_closing),
        ]

    def _window_activated(self, _sub_window: Any) -> None:
        """Listen to the photographs of another station of the document, too."""
        window = photo_window()
        if self.is_open and window is not None and not window.is_missing and window.station_object.Document.Name == self._document_name:
            self._listen(window)

    def _take_click(self, click: Any) -> None:
        last = photo_window()  # a click makes its window the last used one
        window = last if last in self._open_windows else self.window
        with self.reporting():
            if window is not self.window:
                self._change_to(window)
            self.photo_clicked(click)

    def _change_to(self, window: PhotoWindow) -> None:
        self._task.cancel()
        self.clear_drawing()
        self.window, self._station_name = window, window.station_object.Name
        self.station_changed()

    def _take_enter(self) -> None:
        with self.reporting():
            self.accept_current()

    def _take_escape(self) -> None:
        with self.reporting():
            if not self.step_back():
                self.close()

    def _take_digit(self, number: int) -> None:
        with self.reporting():
            self.digit_pressed(number)

    def _take_closing(self) -> None:
        # the window that is worked in, or another one that was only listened to
        if self.window not in self._open_windows:
            self.close()

    def _reported(self, function: Callable[[T], None]) -> Callable[[T], None]:
        def told(value: T) -> None:
            if self.is_open:
                with self.reporting():
                    function(value)

        return told

    def _tell_failure(self, reason: str) -> None:
        if self.is_open:
            self.say(reason, warning=True)


def _mdi_area() -> Any:
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)
