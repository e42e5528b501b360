# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was built beside what was designed: an IFC model, or solids of the document whose round faces are pipes, or their bare surface."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import Part

from pipeworkbench.errors import InputError
from pipeworkbench.features.component import component_of
from pipeworkbench.features.document import components_in, pipeline_of
from pipeworkbench.pipeline import Pipe, Pipeline, Vector, free_id

if TYPE_CHECKING:
    from pipeworkbench.recon.plant import Deviation

DESIGNED_FRAME = "as designed"
SHORTEST_FACE = 1.0  # mm; a shorter round face is an edge's rounding
SAME_AXIS_MM = 0.01
WHOLE_TURN = 1e-6  # rad; halves of one cylinder are faces of their own in some files


@dataclass(frozen=True)
class Comparison:
    """How components deviate from a design, and sentences on what could not be compared."""

    deviations: tuple[Deviation, ...]
    remarks: tuple[str, ...] = ()


def compare_with_ifc(document: Any, path: Path, objects: Iterable[Any] | None = None, *, fit: bool = True) -> Comparison:
    """Return how a document's components (or those among ``objects``) deviate from the pipes of an IFC file.

    Parameters
    ----------
    document : FreeCAD document
    path : Path
    objects : iterable of document objects, optional
    fit : bool
        Look where the pipework fits the model best; else both are in the same coordinates.

    Raises
    ------
    InputError
        Where the file has no pipes, or they fit nowhere.
    """
    return compare_with_model(pipeline_of(document, objects), path, fit=fit)


def compare_with_model(built: Pipeline, path: Path, *, fit: bool) -> Comparison:
    """Return how a pipeline deviates from the pipes of an IFC file; touches no document.

    Raises
    ------
    InputError
        Where the file has no pipes, or they fit nowhere.
    """
    from pipeworkbench.exports.ifc_reading import read_ifc_pipes

    model = read_ifc_pipes(path)
    remarks = (f"{model.unreadable} pipe segments of the model could not be read",) if model.unreadable else ()
    return compare(built, model.pipeline, fit=fit, source=path.name, remarks=remarks)


def compare_with_solids(document: Any, solids: Iterable[Any], objects: Iterable[Any] | None = None, *, fit: bool = False) -> Comparison:
    """Return how components deviate from the pipes that solids of the document show by their round faces.

    Raises
    ------
    InputError
        Where the solids have no round faces.
    """
    return compare(pipeline_of(document, objects), designed_pipes(solids), fit=fit, source=document.Label)


def compare(built: Pipeline, designed: Pipeline, *, fit: bool, source: str, remarks: tuple[str, ...] = ()) -> Comparison:
    """Return how what was built deviates from what was designed; touches no document."""
    from pipeworkbench.recon.plant import deviations_in_place, placement_on_model

    if not fit:
        return Comparison(deviations_in_place(built, designed), remarks)
    found = placement_on_model(built, designed)
    if found.plant_from_frame is None:
        what, _, remedy = (found.problems[0] if found.problems else "the pipework fits nowhere").partition("; ")
        raise InputError(source, "", what, remedy or "compare without fitting, if both are in the same coordinates")
    return Comparison(found.deviations, (*remarks, *found.problems))


def distances_to_surface(document: Any, solids: Sequence[Any], objects: Iterable[Any] | None = None) -> Comparison:
    """Return the shortest distance of each component's surface to solids of the document, 0 where they touch or overlap.

    Raises
    ------
    InputError
        Where the solids have no shape, or there are no components.
    """
    from pipeworkbench.recon.plant import Deviation

    shapes = [shape for obj in solids if (shape := _shape_of(obj)) is not None]
    chosen = [obj for obj in (components_in(document) if objects is None else objects) if obj not in solids]
    if not shapes or not chosen:
        raise InputError(document.Label, "", "there is nothing to compare", "select the solid as designed, and have some components measured")
    target = shapes[0] if len(shapes) == 1 else Part.makeCompound(shapes)
    label = ", ".join(obj.Label for obj in solids)
    found = []
    for obj in chosen:
        component = component_of(obj)
        distance, points, _ = obj.Shape.distToShape(target)
        offset = _vector(points[0][0] - points[0][1])
        found.append(
            Deviation(label, component.id, component.kind, None, component.outer_diameter, offset=offset, distances=(round(float(distance), 3),))
        )
    return Comparison(tuple(found))


def designed_pipes(solids: Iterable[Any]) -> Pipeline:
    """Return the pipes that the outer round faces of document objects' shapes stand for, named after the objects.

    Raises
    ------
    InputError
        Where there is no such face.
    """
    pipes: list[Pipe] = []
    names: set[str] = set()
    for obj in solids:
        shape = _shape_of(obj)
        own: list[Pipe] = []
        for face in () if shape is None else shape.Faces:
            pipe = _pipe_of_face(face, obj.Label if not own else f"{obj.Label} ({len(own) + 1})")
            if pipe is not None and not any(_is_same(pipe, other) for other in own):
                own.append(pipe)
        for pipe in own:
            # labels may repeat
            names.add(name := free_id(pipe.id, names))
            pipes.append(replace(pipe, id=name))
    if not pipes:
        raise InputError(DESIGNED_FRAME, "", "the selected solids have no round outer faces", "select pipes, or compare with their surface")
    return Pipeline(frame=DESIGNED_FRAME, components=tuple(pipes))


def has_shape(obj: Any) -> bool:
    """Tell whether a document object has a shape to compare with."""
    return _shape_of(obj) is not None


def _shape_of(obj: Any) -> Any:
    """Return an object's shape where it stands in the document, None where it has none."""
    shape = Part.getShape(obj)
    return None if shape.isNull() or not shape.Faces else shape


def _pipe_of_face(face: Any, name: str) -> Pipe | None:
    """Return the pipe whose outside a face is, None where it is no such face."""
    surface = face.Surface
    if not isinstance(surface, Part.Cylinder):
        return None
    first_turn, last_turn, start, end = face.ParameterRange
    if end - start < SHORTEST_FACE or last_turn - first_turn < math.pi - WHOLE_TURN:
        return None
    middle = face.valueAt((first_turn + last_turn) / 2, (start + end) / 2)
    outward = middle - surface.Center
    outward -= surface.Axis * outward.dot(surface.Axis)
    if face.normalAt((first_turn + last_turn) / 2, (start + end) / 2).dot(outward) < 0:
        return None  # the inside of a hollow pipe
    ends = [_vector(surface.Center + surface.Axis * along) for along in (start, end)]
    return Pipe(id=name, start=ends[0], end=ends[1], outer_diameter=round(2 * surface.Radius, 6))


def _is_same(one: Pipe, other: Pipe) -> bool:
    """Tell whether two pipes are halves of one cylinder."""
    return (
        abs(one.outer_diameter - other.outer_diameter) < SAME_AXIS_MM
        and min(math.dist(one.start, other.start), math.dist(one.start, other.end)) < SAME_AXIS_MM
        and min(math.dist(one.end, other.end), math.dist(one.end, other.start)) < SAME_AXIS_MM
    )


def _vector(vector: Any) -> Vector:
    return (float(vector.x), float(vector.y), float(vector.z))
