# SPDX-License-Identifier: LGPL-2.1-or-later
"""A component put into an IFC model of somebody else's, as FreeCAD's own exporter asks objects to do."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, ifc_model
from pipeworkbench.exports.ifc_update import same
from pipeworkbench.pipeline import AnyComponent, Pipeline

if TYPE_CHECKING:
    import ifcopenshell

# what goes along: type, properties, material, ports, insulation
RELATIONS = ("IfcRelDefinesByType", "IfcRelDefinesByProperties", "IfcRelAssociatesMaterial", "IfcRelNests", "IfcRelAggregates")
BODY = "Body"


def add_component(file: ifcopenshell.file, component: AnyComponent, project: str = "") -> Any:
    """Add a component with its type, ports and properties to a model and return the product, which is nowhere in the building yet.

    Parameters
    ----------
    file : ifcopenshell.file
        IFC4 or IFC4X3_ADD2, in any unit of length; its body context is used where it has one.
    component : Component
        In the model's coordinates, mm.
    project : str
        What GlobalIds derive from beside the component's id.

    Raises
    ------
    InputError
        Where the model has another schema or the component cannot be written.
    """
    schema = next((one for one in SCHEMAS if one == file.schema_identifier), None)
    if schema is None:
        raise InputError(component.id, "schema", f"the model is of {file.schema_identifier}", f"export with {' or '.join(SCHEMAS)}")
    model = ifc_model(Pipeline(frame=project, components=(component,)), options=IfcOptions(schema=schema))
    made = next(iter(model.by_type("IfcPipeSegment") or model.by_type("IfcPipeFitting")))
    made.ObjectPlacement.PlacementRelTo = None  # whoever puts it into the building says where that is
    known = {context.id() for context in file.by_type("IfcRepresentationContext")}
    product = file.add(made)
    for kind in RELATIONS:
        for relation in model.by_type(kind):
            if not (relation.is_a("IfcRelAggregates") and relation.RelatingObject != made):
                _merge(file, relation)
    _use_contexts(file, known)
    _one_application(file)
    return product


def _merge(file: ifcopenshell.file, relation: Any) -> None:
    """Add a relation to a model; where it is there already, what is newly related joins it."""
    here = same(relation, file)
    if here is not None:
        here.RelatedObjects = tuple(
            dict.fromkeys((*here.RelatedObjects, *(same(thing, file) or file.add(thing) for thing in relation.RelatedObjects)))
        )
        return
    # types share property sets, of which the model may have some
    typed = relation.RelatingType if relation.is_a("IfcRelDefinesByType") else None
    there = [one for one in (typed.HasPropertySets or ()) if same(one, file) is not None] if typed else []
    if typed and there:
        shared = tuple(same(one, file) for one in there)
        typed.HasPropertySets = tuple(one for one in typed.HasPropertySets if one not in there) or None
        copy = file.add(relation).RelatingType
        copy.HasPropertySets = (*shared, *(copy.HasPropertySets or ()))
    else:
        file.add(relation)


def _one_application(file: ifcopenshell.file) -> None:
    """Let all owner histories name the application once: its identifier is unique."""
    first: dict[str, Any] = {}
    for application in file.by_type("IfcApplication"):
        kept = first.setdefault(application.ApplicationIdentifier, application)
        if kept != application:
            for user in file.get_inverse(application):
                user.OwningApplication = kept
            file.remove(application)


def _use_contexts(file: ifcopenshell.file, known: Collection[int]) -> None:
    """Let what was added use the contexts that the model had before, where it had any."""
    own = [context for context in file.by_type("IfcRepresentationContext") if context.id() in known]
    if not own:
        return
    added = [context for context in file.by_type("IfcRepresentationContext") if context.id() not in known]
    fallback = next((context for context in own if context.ContextIdentifier == BODY), own[0])
    for context in added:
        alike = next((one for one in own if one.ContextIdentifier == context.ContextIdentifier), fallback)
        for representation in context.RepresentationsInContext:
            representation.ContextOfItems = alike
    for context in sorted(added, key=lambda one: one.is_a("IfcGeometricRepresentationSubContext"), reverse=True):
        file.remove(context)
