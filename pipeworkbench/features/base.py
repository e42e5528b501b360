# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all document objects share: typed properties, schema versions, saving and restoring."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pipeworkbench.errors import InputError

READ_ONLY, HIDDEN = 1, 2  # FreeCAD's editor modes
NO_RECOMPUTE = 16  # FreeCAD's attribute of properties that the shape does not depend on
SAID_ONLY = frozenset({"Base", "Joints", "Measurement"})  # groups of such properties
SCHEMA_VERSION = "SchemaVersion"
UPDATE = "update the Pipe Workbench (FreeCAD: Tools, Addon manager) to change it"

# what a window wants done with every object that is made, and with those of a document that is opened: one that was
# written without a window has no view provider yet. The window puts it here, for features know no window.
window_hooks: list[Callable[[Any], None]] = []


@dataclass(frozen=True)
class Property:
    """A property of a document object: FreeCAD's type, group in the editor, tooltip and editor mode."""

    name: str
    kind: str
    group: str
    tooltip: str
    mode: int = 0


class Feature:
    """A document object's proxy; subclasses name their properties and compute their shape.

    ``type_name`` identifies the object's kind in the document, ``version`` its schema: objects of an
    older version get what they lack when their document is opened, those of a newer one are left as they are.
    """

    type_name = ""
    version = 1
    properties: tuple[Property, ...] = ()

    def __init__(self, obj: Any) -> None:
        self.Type = self.type_name
        self.state: dict[str, Any] = {}  # saved beside the properties; a newer version may keep more there
        obj.Proxy = self
        self.add_properties(obj)
        for hook in window_hooks:
            hook(obj)

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add the properties that the object does not have yet; return the values of those that had another type."""
        schema = Property(SCHEMA_VERSION, "App::PropertyInteger", "Base", "Version of this object's properties", HIDDEN)
        replaced: dict[str, Any] = {}
        for prop in (schema, *self.properties):
            if prop.name in obj.PropertiesList and obj.getTypeIdOfProperty(prop.name) != prop.kind:
                replaced[prop.name] = getattr(obj, prop.name)
                obj.removeProperty(prop.name)
            if prop.name not in obj.PropertiesList:
                obj.addProperty(prop.kind, prop.name, prop.group, prop.tooltip, NO_RECOMPUTE if prop.group in SAID_ONLY else 0)
            # editor modes are not always saved with the document
            obj.setEditorMode(prop.name, prop.mode)
        obj.SchemaVersion = self.version
        return replaced

    def onDocumentRestored(self, obj: Any) -> None:  # FreeCAD's name
        """Bring an object of an older version up to date; one of a newer version stays as it is and cannot be edited."""
        self.Type = self.type_name
        if is_newer(obj):
            _protect(obj)
        else:
            self.bring_up_to_date(obj)
        for hook in window_hooks:
            hook(obj)

    def bring_up_to_date(self, obj: Any) -> None:
        """Give an object what it lacks, and read what an older version saved."""
        version = getattr(obj, SCHEMA_VERSION, 1)
        self.migrate(obj, version, self.add_properties(obj))

    def migrate(self, obj: Any, version: int, replaced: dict[str, Any]) -> None:
        """Turn what an older version saved into what this one reads.

        The properties it lacked are there already; ``replaced`` are the values of those that had another type.
        """

    def dumps(self) -> dict[str, Any]:
        """Return what is saved beside the properties (FreeCAD 0.21 and newer)."""
        return self.state | {"Type": self.type_name}

    def loads(self, state: Any) -> None:
        """Restore what was saved; the properties come by themselves."""
        self.state = dict(state) if isinstance(state, dict) else {}
        self.Type = self.type_name

    # FreeCAD 0.20 asks with these names
    __getstate__ = dumps
    __setstate__ = loads


def is_restoring(obj: Any) -> bool:
    """Tell whether the object's document is being opened, or undone: then nothing may be derived from changes."""
    document = obj.Document
    return "Restore" in obj.State or bool(getattr(document, "Restoring", False)) or bool(getattr(document, "Transacting", False))


def is_kind(obj: Any, feature: type[Feature]) -> bool:
    """Tell whether a document object is of a feature's kind."""
    return getattr(getattr(obj, "Proxy", None), "Type", None) == feature.type_name


def is_newer(obj: Any) -> bool:
    """Tell whether a newer version of the workbench made the object: this one does not understand it and leaves it alone."""
    proxy = getattr(obj, "Proxy", None)
    return isinstance(proxy, Feature) and getattr(obj, SCHEMA_VERSION, 1) > proxy.version


def newer_objects(document: Any) -> list[Any]:
    """Return the objects of a document that a newer version of the workbench made."""
    return [obj for obj in document.Objects if is_newer(obj)]


def refuse_newer(obj: Any) -> None:
    """Raise InputError where a newer version of the workbench made the object."""
    if is_newer(obj):
        problem = f"is {obj.SchemaVersion}, but this version of the workbench knows {obj.Proxy.version} at most"
        raise InputError(obj.Label, SCHEMA_VERSION, problem, UPDATE)


def _protect(obj: Any) -> None:
    """Keep an object of a newer version from being edited, and say once per document what to do."""
    import FreeCAD

    for name in obj.PropertiesList:
        with contextlib.suppress(Exception):  # not every property has an editor
            obj.setEditorMode(name, READ_ONLY)
    newer = newer_objects(obj.Document)
    if newer[0] == obj:
        names = ", ".join(other.Label for other in newer[:3]) + (", ..." if len(newer) > 3 else "")
        FreeCAD.Console.PrintWarning(
            f"{obj.Document.Label}: {len(newer)} objects ({names}) were made by a newer version of the Pipe Workbench; "
            f"they are shown and saved as they are, but cannot be edited; {UPDATE}\n"
        )
