# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pipes of an IFC model as a pipeline: axes and diameters of its IfcPipeSegments, in mm of the model's world.

A segment's axis is that of its swept body, else its axis representation; its diameter is the circle's it is swept from, else what its
properties say. Segments that have neither, such as facets without properties, are counted and left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_file import import_ifcopenshell
from pipeworkbench.pipeline import AnyComponent, Pipe, Pipeline

if TYPE_CHECKING:
    import ifcopenshell

MM_PER_METRE = 1000.0
SHORTEST_MM = 1.0
DIAMETER_PROPERTIES = ("OuterDiameter", "OutsideDiameter")  # of IFC4 and IFC2x3
Array = NDArray[np.float64]


@dataclass(frozen=True)
class IfcPipes:
    """The pipes of a model, named by their GlobalIds, and how many segments could not be read."""

    pipeline: Pipeline
    unreadable: int


def read_ifc_pipes(path: Path) -> IfcPipes:
    """Read the pipes of an IFC file.

    Raises
    ------
    InputError
        Where the file cannot be read or has no pipe segments.
    MissingPackageError
        Where ifcopenshell is not installed.
    """
    ifcopenshell = import_ifcopenshell("Reading IFC")
    try:
        file = ifcopenshell.open(str(path))
    except (OSError, RuntimeError, ifcopenshell.Error) as error:
        raise InputError(path, "", f"cannot be read as IFC ({error})", "give an IFC file of schema IFC2X3 or IFC4") from None
    segments = _segments(file)
    if not segments:
        raise InputError(path, "", "holds no IfcPipeSegment", "export the model with its pipes as IfcPipeSegment")
    return _pipes_of(file, segments, path.stem)


def ifc_pipes(file: ifcopenshell.file, name: str = "model") -> IfcPipes:
    """Return the pipes of an ifcopenshell model; the pipeline's frame gets a name."""
    return _pipes_of(file, _segments(file), name)


def _pipes_of(file: ifcopenshell.file, segments: Sequence[Any], name: str) -> IfcPipes:
    from ifcopenshell.util.unit import calculate_unit_scale

    scale = float(calculate_unit_scale(file)) * MM_PER_METRE
    pipes: list[AnyComponent] = [pipe for segment in segments if (pipe := _pipe(segment, scale)) is not None]
    return IfcPipes(Pipeline(frame=name, components=tuple(pipes)), len(segments) - len(pipes))


def _segments(file: ifcopenshell.file) -> list[Any]:
    """Return the pipe segments; IFC2X3 keeps what they are in their type."""
    if file.schema == "IFC2X3":
        return [
            element
            for element in file.by_type("IfcFlowSegment")
            for relation in element.IsDefinedBy
            if relation.is_a("IfcRelDefinesByType") and relation.RelatingType.is_a("IfcPipeSegmentType")
        ]
    return list(file.by_type("IfcPipeSegment"))


def _pipe(segment: Any, scale: float) -> Pipe | None:
    """Return a segment as a pipe, None where its axis or diameter is not told."""
    from ifcopenshell.util.element import get_psets
    from ifcopenshell.util.placement import get_local_placement

    if segment.Representation is None:
        return None
    world = np.asarray(get_local_placement(segment.ObjectPlacement), float) if segment.ObjectPlacement is not None else np.eye(4)
    properties = {key: value for values in get_psets(segment).values() for key, value in values.items()}
    told = next((float(value) for key in DIAMETER_PROPERTIES if isinstance(value := properties.get(key), int | float) and value > 0), None)
    axis, radius = _axis(segment)
    diameter = 2 * radius if radius is not None else told
    if axis is None or diameter is None:
        return None
    start, end = (axis @ world[:3, :3].T + world[:3, 3]) * scale
    if np.linalg.norm(end - start) < SHORTEST_MM:
        return None
    return Pipe(
        id=segment.GlobalId,
        start=(float(start[0]), float(start[1]), float(start[2])),
        end=(float(end[0]), float(end[1]), float(end[2])),
        outer_diameter=round(diameter * scale, 6),
        extra={"name": segment.Name} if segment.Name else {},
    )


def _axis(segment: Any) -> tuple[Array | None, float | None]:
    """Return the ends (2, 3) of a segment's axis in its own axes and its outer radius, in the file's unit, as far as they are told."""
    line: Array | None = None
    for representation in segment.Representation.Representations:
        for item, matrix in _items(representation):
            if item.is_a("IfcExtrudedAreaSolid") and item.SweptArea.is_a("IfcCircleProfileDef"):
                return _transformed(_extrusion(item), matrix), float(item.SweptArea.Radius)
            if item.is_a("IfcSweptDiskSolid") and (ends := _ends(item.Directrix)) is not None:
                return _transformed(ends, matrix), float(item.Radius)
            if representation.RepresentationIdentifier == "Axis" and line is None and (ends := _ends(item)) is not None:
                line = _transformed(ends, matrix)
    return line, None


def _items(representation: Any, matrix: Array | None = None) -> Iterator[tuple[Any, Array]]:
    """Yield the items of a representation with their transformations (4, 4), those of mapped ones too."""
    from ifcopenshell.util.placement import get_mappeditem_transformation

    matrix = np.eye(4) if matrix is None else matrix
    for item in representation.Items:
        if item.is_a("IfcMappedItem"):
            yield from _items(item.MappingSource.MappedRepresentation, matrix @ np.asarray(get_mappeditem_transformation(item), float))
        else:
            yield item, matrix


def _extrusion(item: Any) -> Array:
    """Return the ends (2, 3) of the axis of an extruded circle."""
    from ifcopenshell.util.placement import get_axis2placement

    position = np.asarray(get_axis2placement(item.Position), float) if item.Position is not None else np.eye(4)
    profile = item.SweptArea.Position
    centre = np.zeros(3)
    if profile is not None:
        centre[:2] = profile.Location.Coordinates[:2]
    direction = np.array(item.ExtrudedDirection.DirectionRatios, float)
    along = float(item.Depth) * direction / np.linalg.norm(direction)
    return _transformed(np.array([centre, centre + along]), position)


def _ends(curve: Any) -> Array | None:
    """Return the ends (2, 3) of a straight curve, None where it is not straight or of another kind."""
    if curve.is_a("IfcPolyline"):
        points = [point.Coordinates for point in curve.Points]
    elif curve.is_a("IfcIndexedPolyCurve") and curve.Points.is_a("IfcCartesianPointList3D"):
        points = list(curve.Points.CoordList)
    else:
        return None
    return np.array(points, float) if len(points) == 2 and all(len(point) == 3 for point in points) else None


def _transformed(points: Array, matrix: Array) -> Array:
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])
