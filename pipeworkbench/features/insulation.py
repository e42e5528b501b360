# SPDX-License-Identifier: LGPL-2.1-or-later
"""Insulation around a set of components as one document object: its settings as properties, its bodies as a compound."""

from __future__ import annotations

import dataclasses
import json
import math
from collections import deque
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCAD

from pipeworkbench.errors import InputError
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_kind, is_newer, refuse_newer
from pipeworkbench.features.component import offer
from pipeworkbench.features.insulating import Insulated, PlannedInsulation, planned, state_of
from pipeworkbench.features.insulation_settings import ENUMERATIONS, FIXED, PROPERTIES, Settings, choices_of, set_settings, settings_of
from pipeworkbench.features.insulation_shapes import model
from pipeworkbench.features.joints import joints_of
from pipeworkbench.features.kinds import is_component
from pipeworkbench.features.project import project_of
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.solids.covering_quantities import layer_volumes, outer_area

if TYPE_CHECKING:
    from pipeworkbench.exports.ifc import Schema
    from pipeworkbench.insulation.clashes import Clash
    from pipeworkbench.insulation.planning import Piece, Plan


RESULTS = "Results"


class InsulationFeature(Feature):
    """Proxy of the insulation of a set of components.

    All objects of a document are planned together (``insulating``). ``PlannedFrom`` says what of: where that has changed,
    whoever changed it, the object is touched before the document is recomputed.
    """

    type_name = "PipeWorkbench::Insulation"
    version = 1
    properties = (
        Property("Components", "App::PropertyLinkListGlobal", "Insulation", "Pipes and fittings that are insulated"),
        *PROPERTIES,
        Property("Pieces", "App::PropertyInteger", RESULTS, "Coverings: straight ones, bends, boxes, ...", READ_ONLY),
        Property("InsulationVolume", "App::PropertyVolume", RESULTS, "Of all layers, without the jacket", READ_ONLY),
        Property("JacketArea", "App::PropertyArea", RESULTS, "Outer surface of the jacket, without overlaps", READ_ONLY),
        Property(
            "HeatLossBare",
            "App::PropertyFloat",
            RESULTS,
            "Heat loss in W without insulation; 0 where the medium's temperature is not known",
            READ_ONLY,
        ),
        Property("HeatLossInsulated", "App::PropertyFloat", RESULTS, "Heat loss in W with the insulation, bare components included", READ_ONLY),
        Property("Clashes", "App::PropertyStringList", RESULTS, "What is closer to the insulation than the minimum distance", READ_ONLY),
        Property("Problems", "App::PropertyStringList", RESULTS, "Why components stay bare", READ_ONLY),
        Property("Remarks", "App::PropertyStringList", RESULTS, "What else is to be known", READ_ONLY),
        Property("Specification", "App::PropertyString", "Base", "What the properties do not say, as a specification file has it (JSON)", HIDDEN),
        Property("PlannedFrom", "App::PropertyString", "Base", "Digest of what the shape was made from", HIDDEN),
        Property("PieceKeys", "App::PropertyStringList", "Base", "Digests of the shape's parts", HIDDEN),
    )

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add what is missing; materials come from the catalogue."""
        is_new = "Thickness" not in obj.PropertiesList
        replaced = super().add_properties(obj)
        for name, setting in ENUMERATIONS.items():
            offer(obj, name, choices_of(setting))
        if is_new:
            set_settings(obj, Settings())
        return replaced

    def execute(self, obj: Any) -> None:
        """Model the pieces of this object's components. What a newer version made keeps the shape that it was saved with."""
        if is_newer(obj):
            return
        insulated, refused = insulated_in(obj.Document)
        state = _state(obj.Document)
        plan = planned(obj.Document, insulated, state)
        pieces, problems = plan.pieces(obj.Name), plan.problems(obj.Name)
        if obj.Name in refused:
            pieces, problems = [], [refused[obj.Name]]
        modelled, unmodelled = model(obj, pieces)
        _say(obj, plan, modelled, list(dict.fromkeys(str(error) for error in (*problems, *unmodelled))))
        obj.PlannedFrom = state
        # what was changed in this very recompute, such as by an expression, may concern the other objects, too
        for other in insulations_in(obj.Document):
            if other != obj and other.PlannedFrom != state:
                other.touch()


def insulations_in(document: Any) -> list[Any]:
    """Return the Insulation objects of a document that this version understands."""
    return [obj for obj in document.Objects if is_kind(obj, InsulationFeature) and not is_newer(obj)]


def make_insulation(document: Any, objects: Iterable[Any] | None = None, specification: Specification | None = None, **settings: Any) -> Any:
    """Add insulation to a document and return the object; the document is not recomputed.

    Parameters
    ----------
    document : FreeCAD document
    objects : iterable of document objects, optional
        The components among them are insulated; all of the document's where it is not given.
    specification : Specification, optional
        Its default gives the settings that are not given; its rules hold, too.
    **settings
        Fields of `insulation_settings.Settings`, such as ``thickness=60, material="mineral wool", jacket="aluminium"``.

    Raises
    ------
    InputError
        Where there is no component, or a value does not fit.
    """
    base = specification or Specification()
    fixed = {"thickness_rule": FIXED} if "thickness" in settings else {}
    given = dataclasses.replace(Settings.of(base) if specification else Settings(), **(fixed | settings))
    given.specification(base, "insulation")
    components = _components(document, objects)
    obj = document.addObject("Part::FeaturePython", "Insulation")
    InsulationFeature(obj)
    obj.Components = components
    _set(obj, given, specification)
    project = project_of(document)
    if project is not None:
        project.addObject(obj)
    return obj


def change_insulation(obj: Any, settings: Settings, objects: Iterable[Any], specification: Specification | None = None) -> None:
    """Give an Insulation object other settings, components and rules; those of an object that is the same are left alone.

    Raises
    ------
    InputError
        Where there is no component, a value does not fit, or a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    settings.specification(specification, obj.Label)
    components = _components(obj.Document, objects)
    if components != list(obj.Components):
        obj.Components = components
    _set(obj, settings, specification)


def apply_specification(document: Any, specification: Specification, objects: Iterable[Any] | None = None) -> Any:
    """Insulate a document's components (or those among ``objects``) as a specification says, in addition to what is there; return the object."""
    return make_insulation(document, objects, specification)


def insulation_of(obj: Any) -> Insulated:
    """Return which components an object insulates, and how.

    Raises
    ------
    InputError
        Where a property's value does not fit, or a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    ids = tuple(component.ComponentId for component in obj.Components if is_component(component))
    return Insulated(obj.Name, ids, settings_of(obj).specification(rules_of(obj), obj.Label))


def rules_of(obj: Any) -> Specification:
    """Return what an object knows beyond its properties: rules, obstacles, sheet sizes, prices."""
    return Specification.from_dict(json.loads(obj.Specification), obj.Label) if obj.Specification else Specification()


def insulated_in(document: Any) -> tuple[list[Insulated], dict[str, InputError]]:
    """Return what a document's objects insulate, and why some of them, by name, insulate nothing."""
    insulated, refused = [], {}
    for obj in insulations_in(document):
        try:
            insulated.append(insulation_of(obj))
        except InputError as error:
            refused[obj.Name] = error
    return insulated, refused


def plans_of(document: Any) -> tuple[Plan, ...]:
    """Return the plans of a document's insulation as it is now, one for each frame in which something is insulated."""
    return planned(document, insulated_in(document)[0], _state(document)).plans


def plan_of(document: Any) -> Plan:
    """Return the plan of a document's insulation as it is now.

    Raises
    ------
    InputError
        Where nothing is insulated, or components of several stations that are not merged are.
    """
    return only_plan(document, plans_of(document))


def only_plan(document: Any, plans: Sequence[Plan]) -> Plan:
    """Return the plan of a document's only frame; errors are those of `plan_of`."""
    if not plans:
        raise nothing_insulated(document)
    if len(plans) > 1:
        frames = ", ".join(plan.pipeline.frame for plan in plans)
        raise InputError(document.Label, frames, "these stations are not merged, so that their insulation has no common frame", "merge them first")
    return plans[0]


def nothing_insulated(document: Any) -> InputError:
    """Return what is to be raised where a document's insulation is needed and there is none."""
    return InputError(document.Label, "", "nothing is insulated", "insulate some components first")


def export_insulation(document: Any, path: Path, language: str = "en") -> None:
    """Write a document's insulation in the format of the path's ending: cut sheets, lists, models.

    Raises
    ------
    InputError
        Where nothing is insulated, there is no common frame, or the ending is not known.
    """
    write_plan(plan_of(document), path, language)


def write_plan(plan: Plan, path: Path, language: str = "en", ifc_schema: Schema = "IFC4") -> None:
    """Write a plan in the format of the path's ending; no document is touched.

    Raises
    ------
    InputError
        Where the ending is not known.
    """
    from pipeworkbench.exports import insulation_files

    if path.suffix.lower() not in insulation_files.WRITERS:
        raise InputError(path, "", f"unknown ending '{path.suffix}'", f"use one of {' '.join(insulation_files.WRITERS)}")
    insulation_files.write(insulation_files.Insulated(plan, language, ifc_schema), path)


def run_of(objects: Sequence[Any]) -> list[Any]:
    """Return everything that hangs together with component objects by joints, themselves first."""
    found = {obj.Name: obj for obj in objects if is_component(obj)}
    waiting = deque(found.values())
    while waiting:
        for joined in joints_of(waiting.popleft()):
            if joined.other.Name not in found:
                found[joined.other.Name] = joined.other
                waiting.append(joined.other)
    return list(found.values())


def clash_text(clash: Clash) -> str:
    """Return what is to be told of a clash, and which thicknesses would keep the distance."""
    far = f"{clash.distance:.0f} mm apart" if clash.distance >= 0 else f"{-clash.distance:.0f} mm into each other"
    if clash.resolved:
        return f"{clash.a} and {clash.b}: {far}, {clash.least:g} mm are needed; the insulation is cut out there"
    largest = ((clash.a, clash.largest_a), (clash.b, clash.largest_b))
    ways = [f"{math.floor(most)} mm of {name}" for name, most in largest if most is not None and most >= 1]
    remedy = f"insulate with at most {' or '.join(ways)}" if ways else "move them apart, or leave one of them bare"
    return f"{clash.a} and {clash.b}: {far}, {clash.least:g} mm are needed; {remedy}"


def _components(document: Any, objects: Iterable[Any] | None) -> list[Any]:
    chosen = [obj for obj in (document.Objects if objects is None else objects) if is_component(obj)]
    if not chosen:
        raise InputError(document.Label, "", "there are no pipes or fittings to insulate", "measure some, or select those to insulate")
    return chosen


def _set(obj: Any, settings: Settings, specification: Specification | None) -> None:
    set_settings(obj, settings)
    text = json.dumps(specification.to_dict()) if specification else ""
    if obj.Specification != text:
        obj.Specification = text


def _state(document: Any) -> str:
    said = [
        (obj.Name, [component.Name for component in obj.Components], dataclasses.astuple(settings_of(obj)), obj.Specification)
        for obj in insulations_in(document)
    ]
    return state_of(document, said)


def _say(obj: Any, plan: PlannedInsulation, pieces: Sequence[Piece], problems: list[str]) -> None:
    """Give an object's results, and tell what keeps components bare where that is new."""
    coverings = [piece.covering for piece in pieces]
    obj.Pieces = len(coverings)
    obj.InsulationVolume = sum(sum(layer_volumes(covering)[: len(covering.layers)]) for covering in coverings)
    obj.JacketArea = sum(outer_area(covering) for covering in coverings if covering.sheet)
    try:
        energy = plan.energy(obj.Name)
    except InputError as error:
        energy = None
        problems.append(str(error))
    obj.HeatLossBare = energy.bare.heat if energy else 0.0
    obj.HeatLossInsulated = energy.insulated.heat if energy else 0.0
    obj.Clashes = [clash_text(clash) for clash in plan.clashes(obj.Name)]
    if not obj.Components:
        problems.append(f"{obj.Label}: it has no components; choose some, or delete it")
    for text in problems:
        if text not in obj.Problems:
            FreeCAD.Console.PrintWarning(f"{obj.Label}: {text}\n")
    obj.Problems = problems
    others = sorted({f"{name} is insulated by '{_label(obj, owner)}'" for name, owner in _others(obj, plan)})
    obj.Remarks = [*others, *plan.remarks(obj.Name)]


def _others(obj: Any, plan: PlannedInsulation) -> Iterable[tuple[str, str]]:
    """Yield the components of an object that another one insulates, with its name."""
    for component in obj.Components:
        owner = plan.owners.get(getattr(component, "ComponentId", ""))
        if owner not in (None, obj.Name):
            yield component.ComponentId, owner


def _label(obj: Any, name: str) -> str:
    other = obj.Document.getObject(name)
    return other.Label if other is not None else name


class _Watch:
    """Touches insulation before its document is recomputed, where what it was planned from has changed; the method's name is FreeCAD's."""

    def slotBeforeRecomputeDocument(self, document: Any) -> None:
        """Compare with what is there now."""
        objects = insulations_in(document)
        if not objects:
            return
        state = _state(document)
        for obj in objects:
            if obj.PlannedFrom and obj.PlannedFrom != state:
                obj.touch()


FreeCAD.addDocumentObserver(_Watch())
