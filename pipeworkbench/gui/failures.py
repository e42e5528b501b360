# SPDX-License-Identifier: LGPL-2.1-or-later
"""What goes wrong is told in one way: a sentence where the user can mend it, the report view's details where it is a defect."""

from __future__ import annotations

import contextlib
import sys
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

import FreeCAD

from pipeworkbench.environment import PACKAGES, install_command
from pipeworkbench.errors import MissingPackageError, PipeWorkbenchError
from pipeworkbench.gui.dialogs import Cancelled, show_error
from pipeworkbench.gui.translation import tr


@contextlib.contextmanager
def failures_told(title: str, tell: Callable[[str], None] = show_error) -> Iterator[None]:
    """Run a block; an error ends it and is told instead of raised.

    Parameters
    ----------
    title : str
        What is being done, as the user calls it.
    tell : callable
        Shows the sentence of an error that the user can mend; defects are always shown in a dialog. Both are in the report view.
    """
    try:
        yield
    except Cancelled:
        FreeCAD.Console.PrintMessage(tr("{what}: cancelled").format(what=title) + "\n")
    except PipeWorkbenchError as error:
        text = with_install_command(error)
        FreeCAD.Console.PrintError((text if text.startswith(title) else f"{title}: {text}") + "\n")
        tell(text)
    except ImportError as error:
        FreeCAD.Console.PrintError(traceback.format_exc())
        module = (error.name or "").split(".")[0]
        # a module of our own that is not there is a defect
        (show_error if module in ("", "pipeworkbench") else tell)(_failed_import(title, error, module))
    except Exception as error:  # noqa: BLE001  # FreeCAD would only print it where nobody looks
        FreeCAD.Console.PrintError(traceback.format_exc())
        show_error(_defect(title, error))


def how_to_install(packages: tuple[str, ...]) -> str:
    """Return the command line that installs packages where this FreeCAD finds them."""
    folder = Path(FreeCAD.getUserAppDataDir()) / "AdditionalPythonPackages"
    # from 0.21 on there is a folder for each version of Python
    if tuple(int(part) for part in FreeCAD.Version()[:2]) >= (0, 21):
        folder /= f"py{sys.version_info.major}{sys.version_info.minor}"
    return install_command(packages, Path(FreeCAD.getHomePath()), folder)


def with_install_command(error: PipeWorkbenchError) -> str:
    """Return what an error says; where a package is missing, with the command line for FreeCAD's Python instead of a terminal's."""
    if isinstance(error, MissingPackageError) and error.packages:
        text = tr("{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again")
        return text.format(what=error.purpose, package=error.name, how=how_to_install(error.packages))
    return str(error)


def _failed_import(title: str, error: ImportError, module: str) -> str:
    """Say that a package is there but does not load, or lacks one of its own, and what pip can do about it."""
    if module in ("", "pipeworkbench"):
        return _defect(title, error)
    package = PACKAGES.get(module, module)
    return tr("{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}").format(
        what=title, package=package, reason=error, how=how_to_install((package,))
    )


def _defect(title: str, error: Exception) -> str:
    text = tr("{what} failed ({error}); the report view has the details, please report them")
    return text.format(what=title, error=f"{type(error).__name__}: {error}")
