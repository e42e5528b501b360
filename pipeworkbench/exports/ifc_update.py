# SPDX-License-Identifier: LGPL-2.1-or-later
"""What others added to an earlier export, taken over into the one that replaces it.

Ours is what has a GlobalId derived from a name (UUID version 5) and, of property and quantity sets, one of our sets' names; everything else
is somebody else's. Property sets, classifications, documents, groups and whatever else is assigned or associated go with the components, types
and parts of the building that the new file has, too.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_file import expanded, import_ifcopenshell

if TYPE_CHECKING:
    import ifcopenshell

OUR_SETS = (
    "PipeWorkbench_",
    "Pset_Pipe",
    "Pset_Fitting",
    "Pset_DistributionPortTypePipe",
    "Pset_Uncertainty",
    "Pset_Covering",
    "Qto_Pipe",
    "Qto_Covering",
)
OUR_UUID_VERSION = 5
KEPT = ("IfcRelDefinesByProperties", "IfcRelAssociates", "IfcRelAssignsToGroup")
logger = logging.getLogger(__name__)


def carry_over(path: Path, file: ifcopenshell.file) -> None:
    """Add to a new model what others added to the file that it is about to replace; nothing where that holds another project or no IFC.

    Raises
    ------
    InputError
        Where the old file has another schema, and something that would be lost.
    """
    if not path.is_file():
        return
    ifcopenshell = import_ifcopenshell("Reading IFC")
    try:
        old = ifcopenshell.open(str(path))
    except (OSError, RuntimeError, ifcopenshell.Error):
        return
    projects = old.by_type("IfcProject")
    if not projects or projects[0].GlobalId != file.by_type("IfcProject")[0].GlobalId:
        return
    relations = [relation for kind in KEPT for relation in old.by_type(kind) if _is_foreign(relation)]
    types = [(kind, sets) for kind in old.by_type("IfcTypeObject") if (sets := [one for one in kind.HasPropertySets or () if _is_foreign(one)])]
    if (relations or types) and old.schema_identifier != file.schema_identifier:
        problem = f"is of schema {old.schema_identifier}, and others added to it what {file.schema_identifier} would lose"
        raise InputError(path, "", problem, "export with its schema or to another name")
    for relation in relations:
        _keep(relation, file)
    for kind, sets in types:
        here = same(kind, file)
        if here is not None:
            here.HasPropertySets = (*(here.HasPropertySets or ()), *(_added(one, file) for one in sets))
    changed = [ours.Name for ours in old.by_type("IfcPropertySet") if _names(ours) - _names(same(ours, file) or ours)]
    if changed:
        logger.warning("%s: properties that others put into our sets (%s) are not in the new file", path, ", ".join(sorted(set(changed))))
    lost = [product for product in old.by_type("IfcProduct") if _is_foreign(product)]
    if lost:
        what = lost[0].Name or lost[0].is_a()
        logger.warning("%s: %d elements that others put into the file, such as %s, are not in the new one", path, len(lost), what)


def _keep(relation: Any, file: ifcopenshell.file) -> None:
    """Add a relation to a model, for those of its objects that this has."""
    things = [here for thing in relation.RelatedObjects if (here := same(thing, file)) is not None]
    if not things or same(relation, file) is not None:
        return
    values = {}
    for name, value in zip(_attributes(relation), relation, strict=True):
        if name == "RelatedObjects":
            values[name] = tuple(things)
        elif name == "OwnerHistory" and value is not None:
            values[name] = _history(value, file)
        elif hasattr(value, "is_a"):
            values[name] = (same(value, file) if hasattr(value, "GlobalId") else None) or _added(value, file)
        elif value is not None:
            values[name] = value
    made = file.create_entity(relation.is_a(), **values)
    definition = getattr(made, "RelatingPropertyDefinition", None)
    if definition is not None and definition.is_a("IfcPropertySet"):
        for thing in things:
            _as_one_set(file, thing, made)


def _as_one_set(file: ifcopenshell.file, thing: Any, relation: Any) -> None:
    """Put into a set that somebody else relates what ours of the same name says, for a thing has one set of a name; ours goes."""
    foreign = relation.RelatingPropertyDefinition
    for other in thing.IsDefinedBy:
        ours = other.RelatingPropertyDefinition
        if other == relation or ours.Name != foreign.Name or not ours.is_a("IfcPropertySet"):
            continue
        names = {one.Name for one in ours.HasProperties}
        foreign.HasProperties = (*ours.HasProperties, *(one for one in foreign.HasProperties if one.Name not in names))
        rest = tuple(one for one in other.RelatedObjects if one != thing)
        if rest:
            other.RelatedObjects = rest
        else:
            file.remove(other)
            file.remove(ours)


def _names(properties: Any) -> set[str]:
    return {one.Name for one in properties.HasProperties}


def _history(history: Any, file: ifcopenshell.file) -> Any:
    """Return an owner history in a model: the model's own where it names our application, which a model has once."""
    ours = next(iter(file.by_type("IfcOwnerHistory")))
    return ours if history.OwningApplication.ApplicationIdentifier == ours.OwningApplication.ApplicationIdentifier else file.add(history)


def _added(entity: Any, file: ifcopenshell.file) -> Any:
    """Add something, with its owner history, to a model."""
    history = getattr(entity, "OwnerHistory", None)
    if history is None:
        return file.add(entity)
    entity.OwnerHistory = None
    copy = file.add(entity)
    copy.OwnerHistory = _history(history, file)
    return copy


def _attributes(entity: Any) -> Iterator[str]:
    return (entity.attribute_name(index) for index in range(len(entity)))


def same(entity: Any, file: ifcopenshell.file) -> Any | None:
    """Return what has the same GlobalId in a model, None where nothing has."""
    try:
        return file.by_guid(entity.GlobalId)
    except RuntimeError:
        return None


def _is_foreign(entity: Any) -> bool:
    """Tell whether somebody else made an entity, or relates something that somebody else made."""
    identity = expanded(entity.GlobalId)
    if identity is None or identity.version != OUR_UUID_VERSION:
        return True
    if entity.is_a("IfcRelDefinesByProperties"):
        definition = entity.RelatingPropertyDefinition
        return hasattr(definition, "GlobalId") and _is_foreign(definition)
    return entity.is_a("IfcPropertySetDefinition") and not (entity.Name or "").startswith(OUR_SETS)
