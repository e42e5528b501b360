# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all document objects share: typed properties, schema versions, saving and restoring."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

READ_ONLY, HIDDEN = 1, 2  # FreeCAD's editor modes

# what a window wants done with every object of a document that is opened: one that was written
# without a window has no view provider yet. The window puts it here, for features know no window.
restored_hooks: list[Callable[[Any], None]] = []


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
    older version get what they lack when their document is opened.
    """

    type_name = ""
    version = 1
    properties: tuple[Property, ...] = ()

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        self.Type = self.type_name
        self.add_properties(obj)

    def add_properties(self, obj: Any) -> None:
        """Add the properties that the object does not have yet."""
        schema = Property("SchemaVersion", "App::PropertyInteger", "Base", "Version of this object's properties", HIDDEN)
        for prop in (schema, *self.properties):
            if prop.name not in obj.PropertiesList:
                obj.addProperty(prop.kind, prop.name, prop.group, prop.tooltip)
            # editor modes are not always saved with the document
            obj.setEditorMode(prop.name, prop.mode)
        obj.SchemaVersion = self.version

    def onDocumentRestored(self, obj: Any) -> None:  # FreeCAD's name
        """Bring an object of an older version up to date."""
        self.Type = self.type_name
        version = getattr(obj, "SchemaVersion", 1)
        self.add_properties(obj)
        self.migrate(obj, version)
        for hook in restored_hooks:
            hook(obj)

    def migrate(self, obj: Any, version: int) -> None:
        """Turn what an older version saved into what this one reads; the properties it lacked are there already."""

    def dumps(self) -> dict[str, str]:
        """Return what is saved beside the properties (FreeCAD 0.21 and newer)."""
        return {"Type": self.type_name}

    def loads(self, state: Any) -> None:  # noqa: ARG002
        """Restore what was saved; the properties come by themselves."""
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
