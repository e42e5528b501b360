# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all commands share: resources, undoable transactions and errors that reach the user."""

from __future__ import annotations

import contextlib
import traceback
from collections.abc import Iterator
from typing import Any

import FreeCAD

from pipeworkbench.environment import missing_packages
from pipeworkbench.errors import MissingPackageError, PipeWorkbenchError
from pipeworkbench.files import package_folder


class Command:
    """A toolbar command; subclasses say what it is called and what it does."""

    name = ""
    menu_text = ""
    tooltip = ""
    icon = ""
    needs_station = False

    def GetResources(self) -> dict[str, str]:  # FreeCAD's name
        """Tell FreeCAD about texts and icon."""
        return {
            "MenuText": self.menu_text,
            "ToolTip": self.tooltip,
            "Pixmap": str(package_folder("resources") / "icons" / self.icon),
        }

    def IsActive(self) -> bool:  # FreeCAD's name
        """Tell FreeCAD whether the command can be used; called often, so nothing heavy here."""
        if not self.needs_station:
            return True
        document = FreeCAD.ActiveDocument
        return document is not None and any(hasattr(obj, "StationFile") for obj in document.Objects)

    def Activated(self) -> None:  # FreeCAD's name
        """Run the command; whatever goes wrong is told in a dialog and in the report view."""
        from pipeworkbench.features.preferences import use_preferred_catalogue
        from pipeworkbench.gui.dialogs import Cancelled, show_error

        try:
            self._check_packages()
            use_preferred_catalogue()
            self.run()
        except Cancelled:
            FreeCAD.Console.PrintMessage(f"{self.menu_text}: cancelled\n")
        except PipeWorkbenchError as error:
            FreeCAD.Console.PrintError(f"{self.menu_text}: {error}\n")
            show_error(str(error))
        except Exception as error:  # noqa: BLE001  # FreeCAD would only print it where nobody looks
            FreeCAD.Console.PrintError(traceback.format_exc())
            show_error(f"{self.menu_text} failed ({type(error).__name__}: {error}); the report view has the details, please report them")

    def _check_packages(self) -> None:
        missing = missing_packages()
        if missing:
            raise MissingPackageError(", ".join(missing), self.menu_text, f"pip install {' '.join(missing)}")

    def run(self) -> None:
        """Do the command's work."""
        raise NotImplementedError


@contextlib.contextmanager
def transaction(document: Any, name: str) -> Iterator[None]:
    """One step of undo: committed and recomputed at the end, undone where an error is raised."""
    document.openTransaction(name)
    try:
        yield
        document.recompute()
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
