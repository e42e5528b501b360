# SPDX-License-Identifier: LGPL-2.1-or-later
"""The base of the measuring tools: a task panel that works in the photo windows of its document.

A tool listens to all photo windows of its document and works on the station that was clicked in last. It ends
with the window it works in and with the station, and leaves nothing behind: what it shows are overlays and ghosts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, TypeVar

from pipeworkbench.errors import InputError, PipeWorkbenchError
from pipeworkbench.gui.colours import rgb_of
from pipeworkbench.gui.compat import is_alive
from pipeworkbench.gui.jobs import Task
from pipeworkbench.gui.overlay import Overlay
from pipeworkbench.gui.panel import Buttons, Panel
from pipeworkbench.gui.photos.pointing import Click
from pipeworkbench.gui.photos.window import PhotoWindow
from pipeworkbench.gui.photos.windows import mdi_area, open_photo_window, photo_window
from pipeworkbench.gui.tools.measured import in_document, object_of, put_into_document
from pipeworkbench.gui.translation import tr
from pipeworkbench.gui.widgets import words
from pipeworkbench.pipeline import AnyComponent, Joint
from pipeworkbench.recon.camera import Array
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
TRANSPARENCY = 0.45

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
        self._ghosts = Overlay(self.document)
        self._revealed: list[AnyComponent] = []
        self._task = Task(self.form)
        self._accepted_ids: list[str] = []
        self._accepted_label = words("accepted")

    # what subclasses override

    def opened(self) -> None:
        """Begin, once the panel is shown."""

    def photo_clicked(self, click: Click) -> None:
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
        window, tell_failure = self.window, failed or self._tell_failure

        def fail(error: Exception) -> None:
            tell_failure(str(error))
            if not isinstance(error, PipeWorkbenchError):
                raise error  # a defect: it is told in a dialog

        self._task.start(lambda tell: function(window.wait_for_views(), tell), self._reported(ended), self._reported(fail), self._reported(news))

    def draw(
        self, drawn: Sequence[Drawn], *, guess: bool = False, alternatives: bool = False, still: str | None = None
    ) -> list[dict[str, list[Array]]]:
        """Show components in all photographs and in 3D, the chosen ones on top; return their contours as `contours_in` does.

        Parameters
        ----------
        drawn : sequence
        guess : bool
            Whether they are dashed.
        alternatives : bool
            Whether they may be in one another's place: then they do not hide each other.
        still : str, optional
            Camera whose photograph was clicked in: it stays where it is, while the others are moved to where the chosen ones are.
        """
        if self.window.is_closed:
            return []
        components = [component for component, _ in drawn]
        curves = contours_in(self.station, components, range(len(components)) if alternatives else None)
        is_chosen = [chosen for _, chosen in drawn]
        layer = self.window.layer(LAYER)
        layer.live = True  # it changes while something is dragged: the photographs below need not be drawn anew
        layer.clear()
        for chosen, colour, width in ((False, OTHER_COLOUR, WIDTH_OTHER), (True, CHOSEN_COLOUR, WIDTH_CHOSEN)):
            lines_by_camera = _together(curve for curve, one in zip(curves, is_chosen, strict=True) if one is chosen)
            for camera, lines in lines_by_camera.items():
                layer.add_polylines(camera, lines, colour, width=width, dashed=guess)
        # the chosen ones' lines; where they were shown before, the user may have looked elsewhere since
        shown = [component for component, chosen in drawn if chosen]
        if shown != self._revealed:
            self._revealed = shown
            self.window.reveal(lines_by_camera, still)
        self._ghosts.clear()
        for component, chosen in zip(in_document(self.station_object, components), is_chosen, strict=True):
            self._ghosts.add_component(component, rgb_of(CHOSEN_COLOUR if chosen else OTHER_COLOUR), TRANSPARENCY)
        self._ghosts.show()
        return curves

    def clear_drawing(self) -> None:
        """Show no proposals any more."""
        for window in self._open_windows:
            window.layer(LAYER).clear()
            window.layer(CLICK_LAYER).clear()
        self._ghosts.clear()

    def store(self, name: str, components: Sequence[AnyComponent], joints: Iterable[Joint] = ()) -> list[Any]:
        """Put components of the station's level frame into the document as one step of undo."""
        return self.apply(tr(name), lambda: put_into_document(self.station_object, components, joints))

    def remember(self, component_id: str) -> None:
        """Keep in mind what was accepted, to be told at the panel's foot."""
        if component_id not in self._accepted_ids:
            self._accepted_ids.append(component_id)

    def show_accepted(self) -> None:
        """Tell what was accepted and is in the document: undo may have taken it out."""
        there = [name for name in self._accepted_ids if object_of(self.document, name) is not None]
        self._accepted_label.setText(tr("In the document: {names}").format(names=", ".join(there)) if there else "")

    # Panel's side

    def open(self) -> None:
        """Show the panel and listen to the photographs."""
        if self._was_opened:
            return  # FreeCAD calls it once more while it shows the panel
        self._was_opened = True
        super().open()
        self._listen(self.window)
        mdi_area().subWindowActivated.connect(self._window_activated)
        with self.reporting():
            self.opened()

    def refresh(self) -> None:
        """End with the station; subclasses bring their lists up to date."""
        if self.document.getObject(self._station_name) is None:
            self.close()

    def discard(self) -> None:
        """Leave the photographs and views as they were."""
        mdi_area().subWindowActivated.disconnect(self._window_activated)
        self._task.cancel()
        self.clear_drawing()
        self._ghosts.remove()
        for window in self._open_windows:
            window.set_tool(False)
            for signal, slot in self._slots(window):
                signal.disconnect(slot)
        self._windows.clear()

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

    def _take_click(self, click: Click) -> None:
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
        self.say(reason, warning=True)


def _together(curves: Iterable[dict[str, list[Array]]]) -> dict[str, list[Array]]:
    """Return the lines of several components by camera; cameras that see none of them are left out."""
    found: dict[str, list[Array]] = {}
    for by_camera in curves:
        for camera, lines in by_camera.items():
            if lines:
                found.setdefault(camera, []).extend(lines)
    return found
