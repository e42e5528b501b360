# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's File > Export: selected components as a table or IFC; FreeCAD calls ``export`` for the types that Init.py adds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.features.exporting import export_document
from pipeworkbench.features.kinds import is_component


def export(objects: Sequence[Any], filename: str) -> None:
    """Write document objects to a file of the ending that FreeCAD was given.

    Raises
    ------
    InputError
        Where there is no pipe or fitting among them.
    """
    components = [obj for obj in objects if is_component(obj)]
    if not components:
        raise InputError(filename, "", "there is no pipe or fitting among the selected objects", "select some in the tree")
    export_document(components[0].Document, Path(filename), components)
