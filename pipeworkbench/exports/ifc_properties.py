# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is known of components as IFC property and quantity sets: each schema's own where it has them, ours for the rest.

A property is its IFC type and value; ``ENUMERATED`` stands for a value of an IFC enumeration property. Names are those of the schemas'
property set definitions (IFC4 Add2 TC1, IFC 4.3 Add2), which differ between them. What all components of a type have stands on the type.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pipeworkbench.exports.ifc_file import ENUMERATED, rounded, significant, upper_bound
from pipeworkbench.exports.kinds import DISPLAY_COLOURS, equivalents_text
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee
from pipeworkbench.solids.frames import bend_angle

PASCAL_PER_BAR = 1e5  # PN is the pressure in bar that a class is named after (EN 1333)
STEEL_KG_PER_M3 = 7850.0  # of unalloyed steel (EN 1993-1-1, 3.2.6)
STEEL_STANDARDS = ("EN 10220", "EN 10253", "EN 1092-1", "DIN 2527", "DIN 2573", "DIN 2576", "DIN 26")  # what they standardise is of steel
STEEL, UNSPECIFIED = "Steel", "Unspecified"
DEVIATION = "IfcNonNegativeLengthMeasure"
LENGTH, NUMBER, LABEL = "IfcPositiveLengthMeasure", "IfcInteger", "IfcLabel"
AS_BUILT = "PipeWorkbench_AsBuilt"
OLD_SCHEMA = "IFC4"  # the schema whose names differ
Q_LENGTH, Q_AREA, Q_WEIGHT = "Length", "Area", "Weight"

Properties = dict[str, tuple[str, Any]]
Quantities = dict[str, tuple[str, float]]  # kind and value in mm, m2, kg


def material_of(component: AnyComponent) -> str:
    """Return what a component is made of: as it says (``extra["material"]``), else what its standard is for."""
    said = component.extra.get("material")
    if isinstance(said, str) and said:
        return said
    return STEEL if (component.standard or "").startswith(STEEL_STANDARDS) else UNSPECIFIED


def type_sets(component: AnyComponent, schema: str) -> dict[str, Properties]:
    """Return the property sets that all components of a component's type share, by their names; what is not known is left out."""
    status: Properties = {"Status": (ENUMERATED, "EXISTING")}
    size = _size(component)
    if isinstance(component, Pipe):
        return _known({"Pset_PipeSegmentTypeCommon": status | size})
    pressure: Properties = {"PressureClass": ("IfcPressureMeasure", component.pn * PASCAL_PER_BAR if isinstance(component, Flange) else None)}
    own = "PipeWorkbench_Flange" if isinstance(component, Flange) else "PipeWorkbench_Dimensions"
    return _known({"Pset_PipeFittingTypeCommon": status | pressure, **_of_kind(component, schema), own: size | _dimensions(component)})


def shared_sets(component: AnyComponent, schema: str) -> dict[str, Properties]:
    """Return the schema's own property sets of a component that others can have just so, by their names.

    The colour is what the component says (``extra["colour"]``), else the one it is shown in.
    """
    said = component.extra.get("colour")
    colour = said if isinstance(said, str) and said else DISPLAY_COLOURS[type(component)]
    name = "Pset_PipeSegmentOccurrence" if isinstance(component, Pipe) else "Pset_PipeFittingOccurrence"
    sets: dict[str, Properties] = {name: {"Color" if schema == OLD_SCHEMA else "Colour": (LABEL, colour)}}
    sigma = component.sigma_position
    if schema != OLD_SCHEMA and sigma is not None:
        # bounds, which many components share; what was computed stands in our own set
        across, height = math.hypot(sigma[0], sigma[1]), sigma[2]
        sets["Pset_Uncertainty"] = {
            "UncertaintyBasis": (ENUMERATED, "MEASUREMENT"),
            "UncertaintyDescription": ("IfcText", "Bounds of the standard deviations of the component's middle"),
            "HorizontalUncertainty": (LENGTH, upper_bound(across) if across else None),
            "VerticalUncertainty": (LENGTH, upper_bound(height) if height else None),
        }
    return _known(sets)


def as_built_properties(component: AnyComponent, date: str) -> Properties:
    """Return how well a component is known: its standard's sources and the accuracy it was measured with on a ``date`` (ISO 8601)."""
    sigma = component.sigma_position or (None, None, None)
    direction = component.sigma_direction_deg
    pipe = component if isinstance(component, Pipe) else None
    said: Properties = {
        "Station": (LABEL, component.station),
        "Quality": ("IfcReal", None if component.quality is None else rounded(component.quality, 3)),
        "SigmaX": (DEVIATION, _if_known(sigma[0])),
        "SigmaY": (DEVIATION, _if_known(sigma[1])),
        "SigmaZ": (DEVIATION, _if_known(sigma[2])),
        "SigmaDirection": ("IfcPlaneAngleMeasure", None if direction is None else significant(math.radians(direction))),
        "SigmaOuterDiameter": (DEVIATION, _if_known(pipe.sigma_outer_diameter if pipe else None)),
        "LevelOfAccuracy": (LABEL, component.loa),
        "Standard": (LABEL, component.standard),
        "NearestStandard": (LABEL, pipe and pipe.nearest_standard),
        "VerifiedGrade": (NUMBER, component.verified),
        "Approximate": ("IfcBoolean", pipe and (pipe.approximate or None)),
        "FixedByUser": ("IfcBoolean", component.fixed or None),
        "Date": ("IfcDate", date),
    }
    return _known({AS_BUILT: said})[AS_BUILT]


def quantities(component: AnyComponent) -> tuple[str, Quantities]:
    """Return the base quantities of a component; weights where its wall is known and it is of steel."""
    name = "Qto_PipeSegmentBaseQuantities" if isinstance(component, Pipe) else "Qto_PipeFittingBaseQuantities"
    found: Quantities = {"Length": (Q_LENGTH, rounded(component.length, 3))}
    wall, outer = component.wall_thickness, component.outer_diameter
    if isinstance(component, Pipe | Elbow):
        length = component.length if isinstance(component, Pipe) else bend_angle(component) * component.bend_radius
        gross = math.pi / 4 * outer**2
        found["GrossCrossSectionArea"] = Q_AREA, _square_metres(gross)
        if wall is not None:
            net = gross - math.pi / 4 * (outer - 2 * wall) ** 2
            found["NetCrossSectionArea"] = Q_AREA, _square_metres(net)
        found["OuterSurfaceArea"] = Q_AREA, _square_metres(math.pi * outer * length)
        if wall is not None and material_of(component) == STEEL:
            weight = rounded(net * length * STEEL_KG_PER_M3 * 1e-9, 4)
            found["NetWeight"] = Q_WEIGHT, weight
    elif isinstance(component, Reducer) and component.reducer_type == "concentric":
        slant = math.hypot(component.length, (outer - component.end_diameter) / 2)
        found["OuterSurfaceArea"] = Q_AREA, _square_metres(math.pi / 2 * (outer + component.end_diameter) * slant)
    return name, found


def port_properties(connection: str, nominal: int | None, outer: float) -> Properties:
    """Return what is known of a port: FLANGED or WELDED, its nominal and outside diameter (mm)."""
    sets = {"": {"ConnectionType": (ENUMERATED, connection), "NominalDiameter": (LENGTH, nominal), "OuterDiameter": (LENGTH, rounded(outer, 3))}}
    return _known(sets)[""]


def _size(component: AnyComponent) -> Properties:
    inner = component.wall_thickness and rounded(component.outer_diameter - 2 * component.wall_thickness)
    return {
        "NominalDiameter": (LENGTH, component.dn),
        "OuterDiameter": (LENGTH, rounded(component.outer_diameter)),
        "InnerDiameter": (LENGTH, inner),
    }


def _of_kind(component: AnyComponent, schema: str) -> dict[str, Properties]:
    """Return the schema's own property set of a kind of fittings."""
    old = schema == OLD_SCHEMA
    match component:
        case Elbow():
            angle = rounded(bend_angle(component))
            bend: Properties = {"BendAngle": ("IfcPositivePlaneAngleMeasure", angle), "BendRadius": (LENGTH, component.bend_radius)}
            return {"Pset_PipeFittingTypeBend" if old else "Pset_FittingBend": bend}
        case Tee():
            return {"Pset_PipeFittingTypeJunction" if old else "Pset_FittingJunction": {"JunctionType": (ENUMERATED, "TEE")}}
        case Reducer() if not old:
            return {"Pset_FittingTransition": {"NominalLength": (LENGTH, rounded(component.length, 3))}}
        case _:
            return {}


def _dimensions(component: AnyComponent) -> Properties:
    match component:
        case Elbow():
            return {"BendType": (LABEL, component.bend_type)}
        case Flange():
            # names of Pset_PipeConnectionFlanged, which is for pipe segments only
            return {
                "FlangeType": (LABEL, component.flange_type),
                "NominalPressure": ("IfcReal", float(component.pn)),
                "FlangeDiameter": (LENGTH, component.D),
                "FlangeThickness": (LENGTH, component.C),
                "BoltholePitch": (LENGTH, component.K),
                "BoltholeDiameter": (LENGTH, component.L),
                "NumberOfBoltholes": (NUMBER, component.bolts),
                "RaisedFaceDiameter": (LENGTH, component.raised_face_diameter),
                "RaisedFaceHeight": (LENGTH, component.raised_face_height or None),
                "NeckDiameter": (LENGTH, component.neck_diameter),
                "SameDimensionsAs": ("IfcText", equivalents_text(component) or None),
            }
        case Tee():
            return {"BranchDiameter": (LENGTH, component.branch_diameter), "TeeType": (LABEL, component.tee_type)}
        case Reducer():
            return {"EndDiameter": (LENGTH, component.end_diameter), "ReducerType": (LABEL, component.reducer_type)}
        case Pipe() | Cap():
            return {}


def _known(sets: Mapping[str, Properties]) -> dict[str, Properties]:
    """Leave out what is not known, and sets of nothing: IFC allows none."""
    filled = {
        name: {key: (kind, _number(kind, value)) for key, (kind, value) in values.items() if value is not None} for name, values in sets.items()
    }
    return {name: values for name, values in filled.items() if values}


def _number(kind: str, value: Any) -> Any:
    """Return a measure as the number with decimals that it is, also where the pipeline's file has none."""
    return float(value) if kind.endswith("Measure") else value


def _if_known(value: float | None) -> float | None:
    return None if value is None else significant(value)


def _square_metres(square_mm: float) -> float:
    return rounded(square_mm * 1e-6, 9)
