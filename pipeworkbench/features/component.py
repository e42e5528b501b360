# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the parametric components share: size, wall, standard, measurement; their way from and to the pipeline."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any, ClassVar

import FreeCAD
import Part

from pipeworkbench.catalogue import PipeSize, pipe_size, pipe_sizes
from pipeworkbench.errors import InputError
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_restoring
from pipeworkbench.features.preferences import start_with_preferred_catalogue
from pipeworkbench.pipeline import SCHEMA, AnyComponent, Matrix, Pipeline, moved
from pipeworkbench.solids import IDENTITY, Frame, brep_text, frame_of, local_solid

NO_NOMINAL_DIAMETER = "none"
NO_PICK = -1
SAME = 1e-3  # what a coordinate (mm) or angle (deg) may differ from the measured one and still be it
SAME_DIRECTION = 1e-7
DIRECTIONS = ("axis",)
GRADES = {None: "", 0: "not verified", 1: "one source", 2: "two sources or more"}
ACCURACY = ("quality", "sigma_position", "sigma_direction_deg", "sigma_outer_diameter", "loa", "gaps", "nearest_standard")

Fields = dict[str, Any]

start_with_preferred_catalogue()  # before documents are opened, whose pipes may have sizes of the user's own


def component_properties(group: str, *own: Property) -> tuple[Property, ...]:
    """Return the properties of a kind of components: those that all have, with the kind's own dimensions after the size."""
    return (
        Property("NominalDiameter", "App::PropertyEnumeration", group, "Nominal diameter of the standard"),
        Property("OutsideDiameter", "App::PropertyLength", group, "Outside diameter"),
        Property("WallThickness", "App::PropertyLength", group, "Wall thickness; 0 where it is not known"),
        *own,
        Property("Fixed", "App::PropertyBool", group, "Keep the component as it is when its pick is reconstructed again"),
        Property("Standard", "App::PropertyString", group, "Standard of the dimensions", READ_ONLY),
        Property("StandardSources", "App::PropertyString", group, "How well the standard's dimensions are sourced", READ_ONLY),
        Property("Quality", "App::PropertyFloat", "Measurement", "RMS distance to the image edges in pixels (Eq. 4)", READ_ONLY),
        Property("SigmaPosition", "App::PropertyVector", "Measurement", "Standard deviation of the middle along x, y, z in mm", READ_ONLY),
        Property("SigmaDirection", "App::PropertyAngle", "Measurement", "Standard deviation of the direction", READ_ONLY),
        Property("LevelOfAccuracy", "App::PropertyString", "Measurement", "Level of accuracy (USIBD)", READ_ONLY),
        Property("StationName", "App::PropertyString", "Measurement", "Station that measured the component", READ_ONLY),
        Property("Pick", "App::PropertyInteger", "Measurement", "Index of the pick that made the component, -1 for none", READ_ONLY),
        Property("ComponentId", "App::PropertyString", "Base", "Identity in exchange files", READ_ONLY),
        Property("MeasuredAs", "App::PropertyString", "Base", "The component that was measured, and how it was modelled (JSON)", HIDDEN),
    )


class ComponentFeature(Feature):
    """Proxy of a component, which is modelled in its own axes (``solids.frames``) and placed by FreeCAD.

    Choosing a nominal diameter sets outside diameter and wall; typing an outside diameter (or binding it to an
    expression) finds the nominal diameter, if there is one. Whoever changes one of the ``standard_dimensions``
    has something else than the standard's component.
    """

    version = 2
    kind: ClassVar[type[AnyComponent]]
    standard_dimensions: ClassVar[tuple[str, ...]] = ()

    def geometry(self, obj: Any) -> Fields:
        """Return the component's geometry (its pipeline fields) in its own axes, from the properties."""
        raise NotImplementedError

    def attributes(self, obj: Any) -> Fields:  # noqa: ARG002
        """Return the pipeline fields that a user may change without changing what was measured."""
        return {}

    def set_dimensions(self, obj: Any, component: Any, frame: Frame) -> None:
        """Give the properties of this kind the component's values."""
        raise NotImplementedError

    def forget_standard(self, obj: Any) -> None:
        """Take back what was said of the standard: the dimensions are no longer its own."""
        obj.Standard = ""
        obj.StandardSources = GRADES[None]

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Say which standard a component of a pipe size follows, after the size was changed."""
        self.forget_standard(obj)

    def shape(self, obj: Any, component: AnyComponent) -> Any:  # noqa: ARG002
        """Return the CadQuery shape of a component in its own axes."""
        return local_solid(component, IDENTITY)

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
        shape = Part.Shape()
        shape.importBrepFromString(brep_text(self.shape(obj, self.local_component(obj))))
        obj.Shape = shape

    def onChanged(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Keep nominal and outside diameter in step, and the standard with the dimensions."""
        if name not in ("NominalDiameter", "OutsideDiameter", *self.standard_dimensions) or is_restoring(obj):
            return
        if not all(hasattr(obj, prop.name) for prop in self.properties):
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
        elif name == "OutsideDiameter":
            size = pipe_size(obj.OutsideDiameter.Value)
            if size is not None and size.wall_thickness and obj.NominalDiameter != size.designation:
                obj.WallThickness = size.wall_thickness
            self.set_standard(obj, size)
            nominal = size.designation if size and size.dn else NO_NOMINAL_DIAMETER
            if obj.NominalDiameter != nominal:
                obj.NominalDiameter = nominal
        else:
            self.forget_standard(obj)

    def local_component(self, obj: Any) -> AnyComponent:
        """Return the component in its own axes, from the properties alone."""
        grades = {text: grade for grade, text in GRADES.items()}
        size = pipe_size(obj.OutsideDiameter.Value)
        fields = {
            "kind": self.kind.kind,
            "id": obj.ComponentId or obj.Name,
            "outer_diameter": obj.OutsideDiameter.Value,
            "wall_thickness": obj.WallThickness.Value or None,
            "dn": size.dn if size else None,
            "standard": obj.Standard or None,
            "verified": grades.get(obj.StandardSources),
            "fixed": obj.Fixed,
        }
        return _checked(obj, fields | self.geometry(obj) | self.attributes(obj))

    def migrate(self, obj: Any, version: int) -> None:
        """Version 1 kept the bare coordinates of what was measured, of pipes."""
        if version < 2 and obj.MeasuredAs.startswith("["):
            measured = json.loads(obj.MeasuredAs)
            component = moved(self.local_component(obj), _matrix(obj.getGlobalPlacement()))
            fields, now = _fields(component), [x for port in component.ports for x in port.point] + [component.outer_diameter]
            if max(abs(a - b) for a, b in zip(now, measured, strict=True)) < SAME:
                fields |= _shown_accuracy(obj)
            fields |= {"station": obj.StationName or None, "pick": None if obj.Pick == NO_PICK else obj.Pick}
            if getattr(obj, "Extra", ""):
                fields |= json.loads(obj.Extra)
            _remember(obj, self, _checked(obj, fields))


def set_component(obj: Any, component: AnyComponent) -> None:
    """Give a document object the geometry and measurement of a component; links to the object stay."""
    feature, frame = obj.Proxy, frame_of(component)
    obj.ComponentId = component.id
    obj.OutsideDiameter = component.outer_diameter
    feature.set_dimensions(obj, component, frame)
    obj.WallThickness = component.wall_thickness or 0
    obj.Standard = component.standard or ""
    obj.StandardSources = GRADES[component.verified]
    obj.Placement = FreeCAD.Placement(FreeCAD.Matrix(*(value for row in frame.matrix for value in row)))
    obj.StationName = component.station or ""
    obj.Pick = NO_PICK if component.pick is None else component.pick
    obj.Quality = -1.0 if component.quality is None else component.quality
    obj.SigmaPosition = FreeCAD.Vector(*(component.sigma_position or (0, 0, 0)))
    obj.SigmaDirection = component.sigma_direction_deg or 0
    obj.LevelOfAccuracy = component.loa or ""
    obj.Fixed = component.fixed
    _remember(obj, feature, component)


def component_of(obj: Any) -> AnyComponent:
    """Return a document object as a component, in the document's global frame.

    What was measured comes back as it was. Accuracy belongs to it: a component that the user moved or gave other
    dimensions is returned without.

    Raises
    ------
    InputError
        Where the object's dimensions do not belong together; names the object.
    """
    feature = obj.Proxy
    now = moved(feature.local_component(obj), _matrix(obj.getGlobalPlacement()))
    fields = _fields(now)
    if not obj.MeasuredAs:
        return now
    memory = json.loads(obj.MeasuredAs)
    measured, modelled = memory["component"], memory["modelled"]
    geometry = {"outer_diameter", *feature.geometry(obj)}
    said = {*feature.attributes(obj), "id", "wall_thickness", "standard", "verified", "fixed"}
    unchanged = all(_same(key, fields.get(key), modelled.get(key)) for key in geometry)
    if unchanged:
        kept = {key: value for key, value in measured.items() if key not in said}
    else:
        kept = {key: value for key, value in measured.items() if key not in {*said, *geometry, *ACCURACY}}
        if not _same("outer_diameter", now.outer_diameter, measured["outer_diameter"]):
            kept["dn"] = now.dn
        kept |= {key: fields[key] for key in geometry if key in fields}
    return _checked(obj, kept | {key: fields[key] for key in said if key in fields})


def _remember(obj: Any, feature: ComponentFeature, component: AnyComponent) -> None:
    """Keep the component as it was measured, and how the properties say it, which is rounded where its points do not quite fit."""
    modelled = _fields(moved(feature.local_component(obj), _matrix(obj.getGlobalPlacement())))
    obj.MeasuredAs = json.dumps({"component": _fields(component), "modelled": modelled})


def _shown_accuracy(obj: Any) -> Fields:
    sigma = list(obj.SigmaPosition)
    return {
        "quality": obj.Quality if obj.Quality >= 0 else None,
        "sigma_position": sigma if any(sigma) else None,
        "sigma_direction_deg": obj.SigmaDirection.Value or None,
        "sigma_outer_diameter": obj.SigmaOutsideDiameter.Value or None,
        "loa": obj.LevelOfAccuracy or None,
    }


def _fields(component: AnyComponent) -> Fields:
    """Return a component as the pipeline's file has it."""
    data: Fields = Pipeline(frame="", components=(component,)).to_dict()["components"][0]
    return data


def _checked(obj: Any, fields: Mapping[str, Any]) -> AnyComponent:
    """Return the component that the fields describe, with the pipeline's own checks."""
    known = {key: value for key, value in fields.items() if value is not None}
    try:
        return Pipeline.from_dict({"schema": SCHEMA, "frame": "", "components": [known]}, source=obj.Label).components[0]
    except InputError as error:
        key = error.key.removeprefix("components[0]").removeprefix(".")
        problem = error.problem.split(" (found {")[0]  # all properties at once tell nobody anything
        raise InputError(obj.Label, key, problem, "correct the object's properties") from None


def _matrix(placement: Any) -> Matrix:
    a = placement.toMatrix().A
    return tuple((a[i], a[i + 1], a[i + 2], a[i + 3]) for i in (0, 4, 8, 12))


def _same(key: str, a: Any, b: Any) -> bool:
    """Tell whether two values of a field are the same but for rounding."""
    if isinstance(a, int | float) and isinstance(b, int | float):
        return math.isclose(a, b, rel_tol=0, abs_tol=SAME_DIRECTION if key in DIRECTIONS else SAME)
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(_same(key, x, y) for x, y in zip(a, b, strict=True))
    return bool(a == b)
