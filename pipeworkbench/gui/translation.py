# SPDX-License-Identifier: LGPL-2.1-or-later
"""The user's language: texts are written in English and translated by Qt, from ``resources/translations``.

Commands' texts have the command's name as context, for FreeCAD looks them up itself; everything else is in `CONTEXT`.
``make translations`` collects the texts and compiles the translations.
"""

from __future__ import annotations

import FreeCADGui

from pipeworkbench.files import package_folder
from pipeworkbench.gui.compat import QtCore

CONTEXT = "PipeWorkbench"


def QT_TRANSLATE_NOOP(context: str, text: str) -> str:  # Qt's name, which the tools that collect texts look for
    """Mark a text that is translated later, where it is shown; return it as it is."""
    del context
    return text


def tr(text: str) -> str:
    """Return a text in the user's language; the text itself where there is no translation.

    Numbers and names go in afterwards, for the text is looked up as it is written:
    ``tr("{count} pipes found").format(count=3)``.
    """
    return translate(CONTEXT, text)


def translate(context: str, text: str) -> str:
    """Return a text of a context in the user's language."""
    return str(QtCore.QCoreApplication.translate(context, text))


def load_translations() -> None:
    """Tell FreeCAD where the translations are; it loads those of its language, now and when it is changed."""
    FreeCADGui.addLanguagePath(str(package_folder("resources") / "translations"))
    FreeCADGui.updateLocale()
