# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all commands share: resources, missing packages and errors that reach the user."""

from __future__ import annotations

from typing import Any

import FreeCAD

from pipeworkbench.environment import missing_packages
from pipeworkbench.errors import MissingPackageError, PipeWorkbenchError
from pipeworkbench.features.transactions import transaction
from pipeworkbench.files import package_folder

__all__ = ["Command", "transaction"]


class Command:
    """A toolbar command; subclasses say what it is called, what it needs and what it does.

    Attributes
    ----------
    name : str
        FreeCAD's name of the command, which is also the context of its texts' translations.
    menu_text, tooltip : str
        In English; FreeCAD translates them itself, also when the language is changed.
    icon : str
        File in resources/icons.
    accelerator : str
        Q and a letter of the command's own, one after the other, such as ``Q, I``: FreeCAD's own workbenches leave Q free.
    needs : tuple of str
        Modules beyond NumPy, SciPy and pydantic without which it can do nothing, such as ``cv2``.
    needs_station, needs_components : bool
        What must be there for the command to be on.
    uses_preferences : bool
        Whether the packages must be there and the user's tables must fit before it runs.
    """

    name = ""
    menu_text = ""
    tooltip = ""
    icon = ""
    accelerator = ""
    needs: tuple[str, ...] = ()
    needs_station = False
    needs_components = False
    uses_preferences = True

    def GetResources(self) -> dict[str, str]:  # FreeCAD's name
        """Tell FreeCAD about texts, icon and keys."""
        resources = {
            "MenuText": self.menu_text,
            "ToolTip": self.tooltip,
            "StatusTip": self.tooltip,
            "Pixmap": str(package_folder("resources") / "icons" / self.icon),
        }
        return resources | ({"Accel": self.accelerator} if self.accelerator else {})

    def IsActive(self) -> bool:  # FreeCAD's name
        """Tell FreeCAD whether the command can be used; called often, so nothing heavy here."""
        from pipeworkbench.gui.worker import is_busy

        if is_busy():
            return False
        document = FreeCAD.ActiveDocument
        if document is None:
            return not (self.needs_station or self.needs_components)
        if self.needs_station and not _any_has(document, "StationFile"):
            return False
        return not self.needs_components or _any_has(document, "ComponentId")

    def Activated(self) -> None:  # FreeCAD's name
        """Run the command; whatever goes wrong is told in a dialog and in the report view."""
        from pipeworkbench.gui.failures import failures_told

        with failures_told(self.title):
            self._check()
            self.run()

    @property
    def title(self) -> str:
        """The command's name in the user's language, without the dots that announce a dialog."""
        from pipeworkbench.gui.translation import translate

        return translate(self.name, self.menu_text).replace("&", "").removesuffix("...").strip()

    def run(self) -> None:
        """Do the command's work."""
        raise NotImplementedError

    def _check(self) -> None:
        from pipeworkbench.gui.translation import tr
        from pipeworkbench.gui.worker import is_busy

        if is_busy():
            raise PipeWorkbenchError(tr("Something else is still being computed; wait for its end or cancel it"))
        if not self.uses_preferences:
            return
        missing = missing_packages(self.needs)
        if missing:
            raise MissingPackageError(", ".join(missing), self.title, f"pip install {' '.join(missing)}")
        from pipeworkbench.features.preferences import use_preferences

        use_preferences()


def _any_has(document: Any, name: str) -> bool:
    """Tell whether an object of a document has a property: stations and components are known by theirs, without loading more."""
    return any(hasattr(obj, name) for obj in document.Objects)
