# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an IFC file needs before there is anything in it: project, units, contexts, site, building, storey, and where all that lies.

The georeference of a pipeline (``recon.plant``) becomes an IfcMapConversion. Coordinates in IFC stay those of the pipeline, so that the file
lies where other models of the plant do, unless they are so far from the origin that viewers' single precision would show it: then the
file has the coordinates of the first station, turned and moved to where the conversion says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc_file import Entities, label, rounded
from pipeworkbench.pipeline import Matrix, Pipeline
from pipeworkbench.recon.plant import placed

FAR_MM = 1e7  # from the origin, where single precision ends at about a millimetre
METRE_PER_MM = 0.001


@dataclass(frozen=True)
class MapPlace:
    """Where the file's origin lies in a projected coordinate system: its name, metres, and the direction of the file's x axis (rad).

    ``file_from_pipeline`` is the 4 x 4 motion from the pipeline's coordinates to the file's (mm), None where these are the same.
    """

    system: str
    eastings: float = 0.0
    northings: float = 0.0
    height: float = 0.0
    heading: float = 0.0
    file_from_pipeline: Matrix | None = None


@dataclass(frozen=True)
class Spatial:
    """What components hang in: storey, building, and the contexts of bodies and axes."""

    storey: Any
    building: Any
    body: Any
    axis: Any


def project_key(pipeline: Pipeline) -> str:
    """Return what says which project a pipeline belongs to, wherever it was placed since: an id that it was given, or its first frame."""
    given, georeference = pipeline.extra.get("project_id"), pipeline.extra.get("georeference")
    first = georeference.get("frame") if isinstance(georeference, dict) else None
    return str(given or first or pipeline.frame)


def on_map(pipeline: Pipeline) -> tuple[Pipeline, MapPlace | None]:
    """Return a pipeline in the coordinates of the file, and where these lie on the map, None where that is not known.

    Raises
    ------
    InputError
        Where the georeference has no matrix of 4 x 4 numbers.
    """
    georeference = pipeline.extra.get("georeference")
    if georeference is None:
        return pipeline, None
    try:
        rows = [[float(value) for value in row] for row in georeference["plant_from_frame"]]
        system = str(georeference["system"])
        (a, _, _, x), (b, _, _, y), (_, _, _, z), _ = rows
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(pipeline.frame, "georeference", f"does not fit ({error})", "give system, frame and plant_from_frame") from None
    if math.hypot(x, y, z) < FAR_MM:
        return pipeline, MapPlace(system)
    heading = math.atan2(b, a)
    cosine, sine = math.cos(heading), math.sin(heading)
    file_from_plant: Matrix = (
        (cosine, sine, 0.0, -cosine * x - sine * y),
        (-sine, cosine, 0.0, sine * x - cosine * y),
        (0.0, 0.0, 1.0, -z),
        (0.0, 0.0, 0.0, 1.0),
    )
    place = MapPlace(system, x * METRE_PER_MM, y * METRE_PER_MM, z * METRE_PER_MM, heading, file_from_plant)
    return placed(pipeline, file_from_plant, pipeline.frame), place


def skeleton(entities: Entities, name: str, place: MapPlace | None) -> Spatial:
    """Add project, site, building and storey with units and contexts."""
    add, identity = entities.add, entities.identity
    units = [
        add("IfcSIUnit", UnitType=kind, Prefix=prefix, Name=unit)
        for kind, prefix, unit in (
            ("LENGTHUNIT", "MILLI", "METRE"),
            ("AREAUNIT", None, "SQUARE_METRE"),
            ("VOLUMEUNIT", None, "CUBIC_METRE"),
            ("PLANEANGLEUNIT", None, "RADIAN"),
            ("MASSUNIT", "KILO", "GRAM"),
            ("PRESSUREUNIT", None, "PASCAL"),
        )
    ]
    model = add(
        "IfcGeometricRepresentationContext",
        ContextType="Model",
        CoordinateSpaceDimension=3,
        Precision=1e-5,
        WorldCoordinateSystem=identity,
        TrueNorth=None if place is None else _north(entities, place),
    )
    body, axis = (
        add("IfcGeometricRepresentationSubContext", ContextIdentifier=what, ContextType="Model", ParentContext=model, TargetView=view)
        for what, view in (("Body", "MODEL_VIEW"), ("Axis", "GRAPH_VIEW"))
    )
    if place is not None:
        _georeference(entities, model, place)
    project = entities.root(
        "IfcProject", "project", Name=label(name), RepresentationContexts=(model,), UnitsInContext=add("IfcUnitAssignment", Units=tuple(units))
    )
    parents, placement = [project], None
    for kind, title in (("IfcSite", "Site"), ("IfcBuilding", "Building"), ("IfcBuildingStorey", "Storey")):
        placement = add("IfcLocalPlacement", PlacementRelTo=placement, RelativePlacement=identity)
        child = entities.root(kind, title, Name=title, ObjectPlacement=placement, CompositionType="ELEMENT")
        entities.relate("IfcRelAggregates", title, "RelatingObject", "RelatedObjects", parents[-1], [child])
        parents.append(child)
    return Spatial(storey=parents[-1], building=parents[-2], body=body, axis=axis)


def _north(entities: Entities, place: MapPlace) -> Any:
    """Return the map's north in the file's coordinates."""
    return entities.add("IfcDirection", DirectionRatios=(rounded(math.sin(place.heading), 12), rounded(math.cos(place.heading), 12)))


def _georeference(entities: Entities, model: Any, place: MapPlace) -> None:
    metre = entities.add("IfcSIUnit", UnitType="LENGTHUNIT", Name="METRE")
    system = entities.add("IfcProjectedCRS", Name=label(place.system), MapUnit=metre)
    entities.add(
        "IfcMapConversion",
        SourceCRS=model,
        TargetCRS=system,
        Eastings=rounded(place.eastings),
        Northings=rounded(place.northings),
        OrthogonalHeight=rounded(place.height),
        XAxisAbscissa=rounded(math.cos(place.heading), 12),
        XAxisOrdinate=rounded(math.sin(place.heading), 12),
        Scale=METRE_PER_MM,
    )
