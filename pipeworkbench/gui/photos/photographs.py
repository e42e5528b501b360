# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station's photographs as they come in: decoded first, all of them; then their edges; lines when they are asked for."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError, Future, wait
from functools import partial

from pipeworkbench.errors import InputError
from pipeworkbench.gui.photos.background import Background
from pipeworkbench.gui.photos.picture import Picture
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.image_curves import lines_in_photograph
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.lines import hough_segments
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View, view_of


class Photographs:
    """Reads a station's photographs and finds their edges in the background.

    Parameters
    ----------
    station : Station
    background : Background
    shown, failed, viewed : callables
        Called in the window's thread with the camera's index and its picture, what is wrong with its file, or its view.
    """

    def __init__(
        self,
        station: Station,
        background: Background,
        shown: Callable[[int, Picture], None],
        failed: Callable[[int, Exception], None],
        viewed: Callable[[int, View], None],
    ) -> None:
        self._station, self._background = station, background
        count = range(len(station.cameras))
        self._pictures = [background.submit(self._reader(i), partial(shown, i), partial(failed, i)) for i in count]
        # they stand in line behind all photographs, so that nobody waits for edges to see something
        self._views = [background.submit(self._viewer(i), partial(viewed, i)) for i in count]
        self._lines: dict[int, Future[Array]] = {}

    def view(self, index: int) -> View | None:
        """Return a camera's view, None while it is not ready."""
        future = self._views[index]
        return future.result() if future.done() and not future.cancelled() and future.exception() is None else None

    def wait_for_views(self) -> tuple[View, ...]:
        """Return the views of all cameras, once they are ready; to be called in any thread.

        Raises
        ------
        InputError
            Where an image cannot be read, or the window was closed meanwhile.
        """
        try:
            return tuple(future.result() for future in self._views)
        except CancelledError:
            raise InputError(self._station.name, "", "its photo window was closed", "open it again") from None

    def find_lines(self, index: int, found: Callable[[int, Array], None]) -> None:
        """Find a camera's straight edges and hand them over (k, n, 2), in the photograph's pixels; once."""
        if index not in self._lines:
            self._lines[index] = self._background.submit(self._line_finder(index), partial(found, index))

    def _reader(self, index: int) -> Callable[[], Picture]:
        return lambda: Picture(read_image(self._station, index))

    def _viewer(self, index: int) -> Callable[[], View]:
        def view() -> View:
            wait(self._pictures)
            return view_of(self._station.cameras[index], self._pictures[index].result().grey)

        return view

    def _line_finder(self, index: int) -> Callable[[], Array]:
        def lines() -> Array:
            interior = self._station.cameras[index].interior
            return lines_in_photograph(hough_segments(self._views[index].result().edges, interior), interior)

        return lines
