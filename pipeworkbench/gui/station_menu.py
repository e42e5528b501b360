# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station's context menu: photographs that were moved away are found again, taken into the document or out of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pipeworkbench.features.base import is_newer
from pipeworkbench.features.station import embed_images, missing_images, release_images, relocate
from pipeworkbench.features.transactions import transaction
from pipeworkbench.gui.dialogs import ask_open, show_error
from pipeworkbench.gui.failures import failures_told

FILES = "Photographs and calibrations (*.jpg *.jpeg *.png *.tif *.tiff *.bmp *.pgm *.json);;All files (*)"


def fill(menu: Any, station: Any) -> None:
    """Add what can be done with a station object's photographs to a menu."""
    if is_newer(station):
        return
    find = "Say where one of them is now; the others are looked for beside it"
    _add(menu, "Find Photographs...", find, lambda: find_photographs(station))
    act: Callable[[Any], None]
    if station.EmbedImages:
        text, tooltip, act = "Take Photographs out of the Document", "Refer to the files again", release_images
    else:
        text, tooltip, act = "Keep Photographs in the Document", "They are saved inside the document, which becomes larger", embed_images
    _add(menu, text, tooltip, lambda: _change(station, text, act))


def find_photographs(station: Any) -> bool:
    """Ask where a station's photographs are now, as one step of undo; return whether all of them are found."""
    names = ", ".join(path.name for path in missing_images(station))
    place = ask_open(f"{station.Label}: where is {names} now?" if names else f"{station.Label}: where are the photographs?", FILES)
    if place is None:
        return not names
    _change(station, "Find photographs", lambda obj: relocate(obj, place))
    missing = missing_images(station)
    if missing:
        show_error(f"{station.Label}: {', '.join(path.name for path in missing)} cannot be found beside {place}; say where they are, too")
    return not missing


def _add(menu: Any, text: str, tooltip: str, act: Callable[[], object]) -> None:
    action = menu.addAction(text)
    action.setToolTip(tooltip)
    action.triggered.connect(lambda *_: act())


def _change(station: Any, name: str, act: Callable[[Any], object]) -> None:
    """Change a station as one step of undo; where it fails, say why."""
    with failures_told(name), transaction(station.Document, name):
        act(station)
