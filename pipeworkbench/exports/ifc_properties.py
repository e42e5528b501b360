# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is known of components as IFC property sets: the standard ones where IFC4 has them, our own for the rest.

A property is its IFC type and value; ``enumerated`` stands for a value of an IFC enumeration property.
"""

from __future__ import annotations

import math
from typing import Any

from pipeworkbench.exports.kinds import equivalents_text
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Reducer, Tee

PASCAL_PER_BAR = 1e5  # PN is the pressure in bar that a class is named after (EN 1333)
LENGTH, NUMBER, LABEL = "IfcPositiveLengthMeasure", "IfcInteger", "IfcLabel"

Properties = dict[str, tuple[str, Any]]


def property_sets(component: AnyComponent) -> dict[str, Properties]:
    """Return the property sets of a component by their names; what is not known is left out."""
    inner = component.wall_thickness and round(component.outer_diameter - 2 * component.wall_thickness, 6)
    size: Properties = {
        "NominalDiameter": (LENGTH, component.dn),
        "OuterDiameter": (LENGTH, component.outer_diameter),
        "InnerDiameter": (LENGTH, inner),
        "Length": (LENGTH, component.length),
    }
    sets: dict[str, Properties]
    if isinstance(component, Pipe):
        sets = {"Pset_PipeSegmentTypeCommon": size}
    else:
        pressure = component.pn * PASCAL_PER_BAR if isinstance(component, Flange) else None
        common: Properties = {"Status": ("enumerated", "EXISTING"), "PressureClass": ("IfcPressureMeasure", pressure)}
        sets = {"Pset_PipeFittingTypeCommon": common, **_of_kind(component), "PipeWorkbench_Dimensions": size | _dimensions(component)}
    sets["PipeWorkbench_Measurement"] = _measurement(component)
    known = {name: {key: (kind, value) for key, (kind, value) in values.items() if value is not None} for name, values in sets.items()}
    return {name: values for name, values in known.items() if values}  # IFC allows no empty set


def _of_kind(component: AnyComponent) -> dict[str, Properties]:
    """Return IFC4's own property set of a kind of fittings."""
    match component:
        case Elbow():
            angle = math.radians(component.angle_deg)
            return {"Pset_PipeFittingTypeBend": {"BendAngle": ("IfcPositivePlaneAngleMeasure", angle), "BendRadius": (LENGTH, component.bend_radius)}}
        case Tee():
            return {"Pset_PipeFittingTypeJunction": {"JunctionType": ("enumerated", "TEE")}}
        case _:
            return {}


def _dimensions(component: AnyComponent) -> Properties:
    match component:
        case Elbow():
            return {"BendType": (LABEL, component.bend_type)}
        case Flange():
            # names of Pset_PipeConnectionFlanged, which IFC4 allows on pipe segments only
            return {
                "FlangeType": (LABEL, component.flange_type),
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


def _measurement(component: AnyComponent) -> Properties:
    """Return how well a component is known: its standard's sources and the accuracy it was measured with."""
    sigma = component.sigma_position or (None, None, None)
    return {
        "Standard": (LABEL, component.standard),
        "VerifiedSources": (NUMBER, component.verified),
        "QualityPixel": ("IfcReal", component.quality),
        "SigmaX": ("IfcNonNegativeLengthMeasure", sigma[0]),
        "SigmaY": ("IfcNonNegativeLengthMeasure", sigma[1]),
        "SigmaZ": ("IfcNonNegativeLengthMeasure", sigma[2]),
        "SigmaDirectionDegrees": ("IfcReal", component.sigma_direction_deg),
        "LevelOfAccuracy": (LABEL, component.loa),
        "Approximate": ("IfcBoolean", component.approximate if isinstance(component, Pipe) else None),
        "Station": (LABEL, component.station),
        "FixedByUser": ("IfcBoolean", component.fixed or None),
    }
