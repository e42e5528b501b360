# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the tour shows, step by step, and how it knows that a step is done: from the document, not from clicks."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import FreeCADGui

from pipeworkbench.gui.dialogs import saved_files
from pipeworkbench.gui.translation import QT_TRANSLATE_NOOP

PHOTO_WINDOWS = "pipeworkbench.gui.photos.windows"


@dataclass(frozen=True)
class Step:
    """One step of the tour: title and text (to be translated), the command that does it, and whether a document shows it done."""

    title: str
    text: str
    command: str
    is_done: Callable[[Any], bool]


def components(document: Any, kind: str) -> list[Any]:
    """Return the document's components of a kind, such as ``pipe``."""
    return [obj for obj in document.Objects if getattr(getattr(getattr(obj, "Proxy", None), "kind", None), "kind", "") == kind]


def _has_station(document: Any) -> bool:
    return any(hasattr(obj, "StationFile") for obj in document.Objects)


def _shows_photographs(document: Any) -> bool:
    """Tell whether a photo window of the document's station is open; it is not loaded for that."""
    windows = sys.modules.get(PHOTO_WINDOWS)
    window = windows.photo_window() if windows else None
    return window is not None and window.document_name == document.Name


def _was_adjusted(document: Any) -> bool:
    return any(name.startswith("Adjust") for name in document.UndoNames)


def _was_exported(document: Any) -> bool:  # noqa: ARG001
    return any(path.is_file() for path in saved_files)


STEPS = (
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Import a station"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench",
            "A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.",
        ),
        "PipeWB_ImportStation",
        _has_station,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Open its photo window"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench",
            "The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to "
            "move the photographs.",
        ),
        "PipeWB_PhotoWindow",
        _shows_photographs,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Measure a pipe"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench",
            "Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all "
            "photographs; Enter accepts it, digits choose another proposal, Esc steps back.",
        ),
        "PipeWB_Pipe",
        lambda document: len(components(document, "pipe")) >= 1,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Measure the next pipe"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Measure the pipe that goes on behind a bend of the first one; the tool stays open for it."),
        "PipeWB_Pipe",
        lambda document: len(components(document, "pipe")) >= 2,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Put the elbow between them"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench", "Elbows are found from the pipes' axes; choose the bend radius that fits the photographs, Enter accepts it."
        ),
        "PipeWB_Elbows",
        lambda document: len(components(document, "elbow")) >= 1,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Add a flange"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench",
            "Click on the straight edge of a flange's rim, then choose its type and pressure class from those that fit; Enter accepts it.",
        ),
        "PipeWB_Flange",
        lambda document: len(components(document, "flange")) >= 1,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Adjust everything"),
        QT_TRANSLATE_NOOP(
            "PipeWorkbench",
            "The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous. Press Adjust in the "
            "panel, look at what it would change, and take it with OK.",
        ),
        "PipeWB_Adjust",
        _was_adjusted,
    ),
    Step(
        QT_TRANSLATE_NOOP("PipeWorkbench", "Export it"),
        QT_TRANSLATE_NOOP("PipeWorkbench", "Write the pipeline as IFC for BIM, as STEP solids or as a table."),
        "PipeWB_Export",
        _was_exported,
    ),
)


def available_steps() -> tuple[Step, ...]:
    """Return the steps whose commands this workbench has."""
    known = set(FreeCADGui.listCommands())
    return tuple(step for step in STEPS if step.command in known)
