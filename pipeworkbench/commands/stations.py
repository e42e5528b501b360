# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which station a command works on."""

from __future__ import annotations

from typing import Any

from pipeworkbench.errors import InputError


def chosen_station(document: Any) -> Any:
    """Return the selected station (or that of a selected component), else the document's only one.

    Raises
    ------
    InputError
        Where there is none, or several and none is selected.
    """
    from pipeworkbench.features.document import stations_in
    from pipeworkbench.gui.selection import selected_objects

    stations = stations_in(document)
    selection = selected_objects(document)
    selected = [obj for obj in stations if obj in selection]
    names = {getattr(obj, "StationName", "") for obj in selection}
    meant = selected or [obj for obj in stations if obj.StationName in names]
    if len(meant) == 1:
        return meant[0]
    if len(stations) == 1:
        return stations[0]
    if not stations:
        raise InputError(document.Label, "", "the document has no station", "import one first")
    raise InputError(document.Label, "", f"the document has {len(stations)} stations", "select the one to work on in the tree")
