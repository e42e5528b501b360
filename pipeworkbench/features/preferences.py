# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user has set in FreeCAD's parameters for this workbench."""

from __future__ import annotations

from pathlib import Path

import FreeCAD

from pipeworkbench.catalogue import catalogue, use_folder
from pipeworkbench.errors import InputError

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/PipeWorkbench"
CATALOGUE_FOLDER = "CatalogueFolder"


def use_preferred_catalogue() -> None:
    """Use the tables of the folder that the parameter names beside the standards'; none where it is empty.

    They are read anew each time, for the user may have changed them.

    Raises
    ------
    InputError
        Where a table does not fit; the catalogue in use stays.
    """
    name = FreeCAD.ParamGet(PREFERENCES).GetString(CATALOGUE_FOLDER, "")
    if name or catalogue().folder is not None:
        use_folder(Path(name).expanduser() if name else None)


def start_with_preferred_catalogue() -> None:
    """Use the preferred tables; where they do not fit, say so and go on without: a document must open all the same."""
    try:
        use_preferred_catalogue()
    except InputError as error:
        FreeCAD.Console.PrintError(f"Pipe Workbench: {error}\n")
