# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parametric pipe: a hollow solid that follows its diameter, wall, length and placement."""

from __future__ import annotations

import json
from typing import Any

import FreeCAD
import Part

from pipeworkbench.catalogue import pipe_size, pipe_sizes
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_restoring
from pipeworkbench.features.preferences import start_with_preferred_catalogue
from pipeworkbench.pipeline import Pipe

NO_NOMINAL_DIAMETER = "none"
NO_PICK = -1
SAME_MM = 1e-3  # what a geometry may differ from the measured one and still be it
GRADES = {None: "", 0: "not verified", 1: "one source", 2: "two sources or more"}

start_with_preferred_catalogue()  # before documents are opened, whose pipes may have sizes of the user's own


class PipeFeature(Feature):
    """Proxy of a pipe. Length runs along the local z axis, from the placement's base.

    Choosing a nominal diameter sets outside diameter and wall; typing an outside diameter (or binding
    it to an expression) finds the nominal diameter, if there is one.
    """

    type_name = "PipeWorkbench::Pipe"
    properties = (
        Property("NominalDiameter", "App::PropertyEnumeration", "Pipe", "Nominal diameter of the standard"),
        Property("OutsideDiameter", "App::PropertyLength", "Pipe", "Outside diameter"),
        Property("WallThickness", "App::PropertyLength", "Pipe", "Wall thickness; 0 where it is not known"),
        Property("Length", "App::PropertyLength", "Pipe", "Length along the axis"),
        Property("Fixed", "App::PropertyBool", "Pipe", "Keep the pipe as it is when its pick is reconstructed again"),
        Property("Standard", "App::PropertyString", "Pipe", "Standard of the dimensions", READ_ONLY),
        Property("StandardSources", "App::PropertyString", "Pipe", "How well the standard's dimensions are sourced", READ_ONLY),
        Property("Quality", "App::PropertyFloat", "Measurement", "RMS distance to the image edges in pixels (Eq. 4)", READ_ONLY),
        Property("SigmaPosition", "App::PropertyVector", "Measurement", "Standard deviation of the middle along x, y, z in mm", READ_ONLY),
        Property("SigmaDirection", "App::PropertyAngle", "Measurement", "Standard deviation of the direction", READ_ONLY),
        Property("SigmaOutsideDiameter", "App::PropertyLength", "Measurement", "Standard deviation of the measured diameter", READ_ONLY),
        Property("LevelOfAccuracy", "App::PropertyString", "Measurement", "Level of accuracy (USIBD)", READ_ONLY),
        Property("Approximate", "App::PropertyBool", "Measurement", "The images do not support the pipe well", READ_ONLY),
        Property("StationName", "App::PropertyString", "Measurement", "Station that measured the pipe", READ_ONLY),
        Property("Pick", "App::PropertyInteger", "Measurement", "Index of the pick that made the pipe, -1 for none", READ_ONLY),
        Property("ComponentId", "App::PropertyString", "Base", "Identity in exchange files", READ_ONLY),
        Property("MeasuredAs", "App::PropertyString", "Base", "The geometry that the measurement belongs to (JSON)", HIDDEN),
        Property("Extra", "App::PropertyString", "Base", "What other programs said of the component (JSON)", HIDDEN),
    )

    def add_properties(self, obj: Any) -> None:
        """Add what is missing; the list of nominal diameters comes from the catalogue."""
        super().add_properties(obj)
        wanted = list(dict.fromkeys((NO_NOMINAL_DIAMETER, *(size.designation for size in pipe_sizes() if size.dn))))
        if obj.getEnumerationsOfProperty("NominalDiameter") != wanted:
            chosen = obj.NominalDiameter
            obj.NominalDiameter = wanted
            if chosen in wanted:
                obj.NominalDiameter = chosen

    def execute(self, obj: Any) -> None:
        """Model the solid; FreeCAD places it."""
        from pipeworkbench.solids import brep_text, straight_pipe

        solid = straight_pipe(obj.OutsideDiameter.Value, obj.WallThickness.Value or None, obj.Length.Value)
        shape = Part.Shape()
        shape.importBrepFromString(brep_text(solid))
        obj.Shape = shape

    def onChanged(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Keep nominal and outside diameter in step."""
        if name not in ("NominalDiameter", "OutsideDiameter") or is_restoring(obj):
            return
        if not all(hasattr(obj, needed) for needed in ("NominalDiameter", "OutsideDiameter", "WallThickness", "StandardSources")):
            return  # still being made
        if name == "NominalDiameter":
            named = (size for size in pipe_sizes() if size.designation == obj.NominalDiameter)
            size = min(named, key=lambda size: size.series, default=None)  # the usual one first
            present = pipe_size(obj.OutsideDiameter.Value)
            if present is not None and present.designation == obj.NominalDiameter:
                size = present  # a user's table may have several outside diameters of one DN
            if size is not None and abs(obj.OutsideDiameter.Value - size.outer_diameter) > 1e-6:
                obj.OutsideDiameter = size.outer_diameter
                obj.WallThickness = size.wall_thickness or 0
            return
        size = pipe_size(obj.OutsideDiameter.Value)
        if size is not None and size.wall_thickness and obj.NominalDiameter != size.designation:
            obj.WallThickness = size.wall_thickness
        obj.Standard = size.standard if size else ""
        obj.StandardSources = GRADES[size.weakest_source if size else None]
        nominal = size.designation if size and size.dn else NO_NOMINAL_DIAMETER
        if obj.NominalDiameter != nominal:
            obj.NominalDiameter = nominal


def add_pipe(document: Any, pipe: Pipe) -> Any:
    """Add a pipe to a document and return the object; the document is not recomputed."""
    obj = document.addObject("Part::FeaturePython", "Pipe")
    PipeFeature(obj)
    obj.Label = f"{pipe.id} DN {pipe.dn}" if pipe.dn else f"{pipe.id} {pipe.outer_diameter:.1f} mm"
    set_pipe(obj, pipe)
    return obj


def set_pipe(obj: Any, pipe: Pipe) -> None:
    """Give a pipe object the geometry and measurement of a component; links to the object stay."""
    obj.OutsideDiameter = pipe.outer_diameter
    obj.WallThickness = pipe.wall_thickness or 0
    obj.Length = pipe.length
    obj.Standard = pipe.standard or ""
    obj.StandardSources = GRADES[pipe.verified]
    start, end = FreeCAD.Vector(*pipe.start), FreeCAD.Vector(*pipe.end)
    obj.Placement = FreeCAD.Placement(start, FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), end - start))
    obj.MeasuredAs = json.dumps([*pipe.start, *pipe.end, pipe.outer_diameter])
    obj.ComponentId = pipe.id
    obj.StationName = pipe.station or ""
    obj.Pick = NO_PICK if pipe.pick is None else pipe.pick
    obj.Quality = -1.0 if pipe.quality is None else pipe.quality
    obj.SigmaPosition = FreeCAD.Vector(*(pipe.sigma_position or (0, 0, 0)))
    obj.SigmaDirection = pipe.sigma_direction_deg or 0
    obj.SigmaOutsideDiameter = pipe.sigma_outer_diameter or 0
    obj.LevelOfAccuracy = pipe.loa or ""
    obj.Approximate = pipe.approximate
    obj.Fixed = pipe.fixed
    obj.Extra = json.dumps(pipe.extra) if pipe.extra else ""


def pipe_of(obj: Any) -> Pipe:
    """Return a document object as a component, in the document's global frame.

    Accuracy belongs to what was measured: a pipe that the user changed since is returned without it.
    """
    placement = obj.getGlobalPlacement()
    start = placement.Base
    end = placement.multVec(FreeCAD.Vector(0, 0, obj.Length.Value))
    size = pipe_size(obj.OutsideDiameter.Value)
    sigma = tuple(obj.SigmaPosition)
    now = (*start, *end, obj.OutsideDiameter.Value)
    measured = bool(obj.MeasuredAs) and max(abs(a - b) for a, b in zip(now, json.loads(obj.MeasuredAs), strict=True)) < SAME_MM
    grades = {text: grade for grade, text in GRADES.items()}
    return Pipe(
        id=obj.ComponentId or obj.Name,
        start=tuple(start),
        end=tuple(end),
        outer_diameter=obj.OutsideDiameter.Value,
        wall_thickness=obj.WallThickness.Value or None,
        dn=size.dn if size else None,
        standard=obj.Standard or None,
        verified=grades.get(obj.StandardSources),  # type: ignore[arg-type]  # GRADES' keys
        pick=None if obj.Pick == NO_PICK else obj.Pick,
        station=obj.StationName or None,
        quality=obj.Quality if measured and obj.Quality >= 0 else None,
        sigma_position=sigma if measured and any(sigma) else None,
        sigma_direction_deg=(obj.SigmaDirection.Value or None) if measured else None,
        sigma_outer_diameter=(obj.SigmaOutsideDiameter.Value or None) if measured else None,
        loa=(obj.LevelOfAccuracy or None) if measured else None,
        approximate=obj.Approximate,
        fixed=obj.Fixed,
        extra=json.loads(obj.Extra) if obj.Extra else {},
    )
