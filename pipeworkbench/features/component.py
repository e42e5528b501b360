# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the parametric components share: size, wall, standard, measurement; their way from and to the pipeline."""

from __future__ import annotations

import contextlib
import functools
import itertools
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, ClassVar, TypeVar

import FreeCAD
import Part

from pipeworkbench.catalogue import Bend, Cap, Catalogue, PipeSize, Reducer, Tee, catalogue, pipe_size, pipe_sizes
from pipeworkbench.errors import InputError
from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property, is_newer, is_restoring, refuse_newer
from pipeworkbench.features.carrying import Carrier, Shape, holding, may_carry
from pipeworkbench.features.joints import End, Joined, joined_by, joint_properties, link_changed
from pipeworkbench.features.preferences import start_with_preferred_catalogue
from pipeworkbench.pipeline import SCHEMA, AnyComponent, Matrix, Pipe, Pipeline, moved
from pipeworkbench.solids import IDENTITY, Frame, brep_text, frame_of, local_solid

NONE = "none"  # of enumerations
NO_PICK = -1
PIPE_SEGMENT, PIPE_FITTING = "Pipe Segment", "Pipe Fitting"  # as FreeCAD's lists of IFC's classes have them
SAME = 1e-3  # what a coordinate (mm) or angle (deg) may differ from the measured one and still be it
SAME_DIRECTION = 1e-7
DIRECTIONS = ("axis",)
GRADES = {None: "", 0: "not verified", 1: "one source", 2: "two sources or more"}
ACCURACY = ("quality", "sigma_position", "sigma_direction_deg", "sigma_outer_diameter", "loa", "gaps", "nearest_standard")
SIZE_LABEL = r"DN \d+|\d+\.\d mm"  # what labels say of the size
MODELS_KEPT = 512  # of dimensions that were modelled: a pipeline repeats its fittings

Fields = dict[str, Any]
R = TypeVar("R", Bend, Cap, Reducer, Tee)

start_with_preferred_catalogue()  # before documents are opened, whose pipes may have sizes of the user's own


def component_properties(group: str, *own: Property, standard: str = "App::PropertyString", ends: tuple[End, ...]) -> tuple[Property, ...]:
    """Return the properties of a kind of components: those that all have, with the kind's own dimensions after the size."""
    chosen = standard == "App::PropertyEnumeration"
    return (
        Property("NominalDiameter", "App::PropertyEnumeration", group, "Nominal diameter of the standard"),
        Property("OutsideDiameter", "App::PropertyLength", group, "Outside diameter"),
        Property("WallThickness", "App::PropertyLength", group, "Wall thickness; 0 where it is not known"),
        *own,
        Property("Fixed", "App::PropertyBool", group, "Keep the component where and as it is, whatever is adjusted, measured again or joined to it"),
        Property("Standard", standard, group, "Standard of the dimensions", 0 if chosen else READ_ONLY),
        Property("IfcType", "App::PropertyString", "IFC", "Class that FreeCAD's own BIM exporter gives it", READ_ONLY),
        Property("StandardSources", "App::PropertyString", group, "How well the standard's dimensions are sourced", READ_ONLY),
        Property("Quality", "App::PropertyFloat", "Measurement", "RMS distance to the image edges in pixels (Eq. 4)", READ_ONLY),
        Property("SigmaPosition", "App::PropertyVector", "Measurement", "Standard deviation of the middle along x, y, z in mm", READ_ONLY),
        Property("SigmaDirection", "App::PropertyAngle", "Measurement", "Standard deviation of the direction", READ_ONLY),
        Property("LevelOfAccuracy", "App::PropertyString", "Measurement", "Level of accuracy (USIBD)", READ_ONLY),
        Property("StationName", "App::PropertyString", "Measurement", "Station that measured the component", READ_ONLY),
        Property("Pick", "App::PropertyInteger", "Measurement", "Index of the pick that made the component, -1 for none", READ_ONLY),
        *joint_properties(ends),
        Property("ComponentId", "App::PropertyString", "Base", "Identity in exchange files", READ_ONLY),
        Property("MeasuredAs", "App::PropertyString", "Base", "The component that was measured, and how it was modelled (JSON)", HIDDEN),
    )


class ComponentFeature(Feature):
    """Proxy of a component, which is modelled in its own axes (``solids.frames``) and placed by FreeCAD.

    Choosing a nominal diameter sets outside diameter and wall; typing an outside diameter (or binding it to an
    expression) finds the nominal diameter, if there is one. Choosing one of the ``choices`` takes the dimensions from the
    catalogue; whoever changes one of the ``standard_dimensions`` has something else than the standard's component. What is
    joined to the ``ends`` follows (``carrying``).
    """

    version = 3
    kind: ClassVar[type[AnyComponent]]
    ends: ClassVar[tuple[End, ...]] = ()
    choices: ClassVar[tuple[str, ...]] = ()
    standard_dimensions: ClassVar[tuple[str, ...]] = ()
    free_dimensions: ClassVar[tuple[str, ...]] = ()
    stretches: ClassVar[bool] = False
    _quiet = False
    _deriving = False
    _announced = ""
    _unlinked: Joined | None = None
    _before: Shape | None = None
    _anchor: Any = None

    def __init__(self, obj: Any) -> None:
        with self.quiet():
            super().__init__(obj)

    def geometry(self, obj: Any) -> Fields:
        """Return the component's geometry (its pipeline fields) in its own axes, from the properties."""
        raise NotImplementedError

    def attributes(self, obj: Any) -> Fields:  # noqa: ARG002
        """Return the pipeline fields that a user may change without changing what was measured."""
        return {}

    def set_dimensions(self, obj: Any, component: Any, frame: Frame) -> None:
        """Give the properties of this kind the component's values."""
        raise NotImplementedError

    def ports(self, obj: Any) -> tuple[Any, ...]:
        """Return the frames of the ends (FreeCAD.Placement) in the component's own axes; their z axes point out of it."""
        raise NotImplementedError

    def open_to(self, obj: Any) -> tuple[End, ...]:  # noqa: ARG002
        """Return the ends that something can be joined to."""
        return self.ends

    def anchor(self, obj: Any) -> Any:  # noqa: ARG002
        """Return the point, in the component's own axes, that keeps its place when the dimensions change."""
        return FreeCAD.Vector()

    def why_not_resized(self, obj: Any, end: int, diameter: float) -> str:  # noqa: ARG002
        """Return why an end cannot take over the diameter (mm) of what is joined to it, empty where it can."""
        return ""

    def resize(self, obj: Any, end: int, diameter: float) -> None:
        """Give an end another diameter (mm), with what follows from it."""
        setattr(obj, self.ends[end].size, diameter)

    def stretch(self, obj: Any, end: int, shift: Any) -> Any:  # noqa: ARG002
        """Take up what it can of an end's movement (mm) by another length; return the rest."""
        return shift

    def placement(self, obj: Any) -> Any:
        """Return the placement in the document's frame."""
        return obj.Placement if obj.getParentGeoFeatureGroup() is None else obj.getGlobalPlacement()

    def move(self, obj: Any, motion: Any) -> None:
        """Move the component by a motion (FreeCAD.Placement) of the document's frame."""
        here = self.placement(obj)
        obj.Placement = obj.Placement.multiply(here.inverse().multiply(motion).multiply(here))

    def standard(self, obj: Any) -> str | None:
        """Return the standard of the dimensions."""
        return obj.Standard or None

    def say_standard(self, obj: Any, standard: str | None, grade: int | None) -> None:
        """Say which standard the dimensions are of, and how well that is sourced."""
        obj.Standard = standard or ""
        obj.StandardSources = GRADES[grade]

    def forget_standard(self, obj: Any) -> None:
        """Take back what was said of the standard: the dimensions are no longer its own."""
        self.say_standard(obj, None, None)

    def set_standard(self, obj: Any, size: PipeSize | None) -> None:  # noqa: ARG002
        """Take the dimensions of another pipe size from the standard, where it has them, after the size was changed."""
        self.forget_standard(obj)

    def alike(self, obj: Any, records: Iterable[R], *, always: bool = False) -> R | None:
        """Return which of the catalogue's records the component is now, and say its standard; None where it is of none.

        One that was of no standard stays so, unless ``always`` is set.
        """
        before = self.standard(obj)
        self.forget_standard(obj)
        known = before is not None or always
        record = min(records, key=lambda record: (record.standard != before, -record.verified), default=None) if known else None
        if record is not None:
            self.say_standard(obj, record.standard, record.verified)
        return record

    def choose(self, obj: Any, name: str) -> None:
        """Take the dimensions that belong to what was chosen from the catalogue."""
        raise NotImplementedError

    def shape(self, obj: Any, component: AnyComponent) -> Any:  # noqa: ARG002
        """Return the CadQuery shape of a component in its own axes."""
        return local_solid(component, IDENTITY)

    def model_key(self, obj: Any) -> str:
        """Return what the shape depends on: components for which it is the same look the same."""
        size = obj.OutsideDiameter.Value, obj.WallThickness.Value
        return json.dumps([self.type_name, size, self.geometry(obj), self.attributes(obj)], sort_keys=True)

    def add_properties(self, obj: Any) -> dict[str, Any]:
        """Add what is missing; the list of nominal diameters comes from the catalogue."""
        replaced = super().add_properties(obj)
        offer(obj, "NominalDiameter", _nominal_diameters(catalogue()))
        obj.IfcType = PIPE_SEGMENT if self.kind is Pipe else PIPE_FITTING
        return replaced

    def bring_up_to_date(self, obj: Any) -> None:
        """Give an object what it lacks; one that was pasted beside its original gets an id of its own."""
        with self.quiet():
            super().bring_up_to_date(obj)
        ids = [other.ComponentId for other in obj.Document.Objects if other != obj and hasattr(other, "ComponentId")]
        if obj.ComponentId in ids:
            obj.ComponentId = next(name for number in itertools.count(2) if (name := f"{obj.ComponentId}-{number}") not in ids)

    def execute(self, obj: Any) -> None:
        """Model the solid; FreeCAD places it. What a newer version made keeps the shape that it was saved with."""
        if is_newer(obj):
            return
        key, component = self.model_key(obj), self.local_component(obj)
        text = _models.pop(key, None) or brep_text(self.shape(obj, component))
        _models[key] = text  # the last used is the last to go
        if len(_models) > MODELS_KEPT:
            del _models[next(iter(_models))]
        shape = Part.Shape()
        shape.importBrepFromString(text)
        obj.Shape = shape

    def onBeforeChange(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Remember where the ends are before one of the dimensions changes, and what a link joined before it does."""
        if any(end.link == name for end in self.ends):
            self._unlinked = None if self._quiet or is_restoring(obj) or is_newer(obj) else joined_by(obj, name)
            return
        # an expression announces its change twice, the second time when it is made already
        if self._deriving or name == self._announced or not self._leads(obj, name):
            return
        self._announced = name
        self._before = Shape(obj) if may_carry(obj) else None
        self._anchor = None if name == "Placement" else self.placement(obj).multVec(self.anchor(obj))

    def onChanged(self, obj: Any, name: str) -> None:  # FreeCAD's name
        """Keep dimensions and standard in step, and let what is joined to the component follow."""
        if any(end.link == name for end in self.ends):
            if not (self._quiet or is_restoring(obj) or is_newer(obj)):
                link_changed(obj, name, self._unlinked)
            return
        if not self._leads(obj, name):
            return
        if self._deriving:
            self._derive(obj, name)
            return
        self._deriving = True
        try:
            self._derive(obj, name)
            self._keep_place(obj)
        finally:
            self._deriving, self._announced = False, ""
            before, self._before = self._before, None
        if before is not None:
            Carrier(obj, before, name).carry()

    def export_ifc(self, obj: Any, ifcfile: Any) -> Any:
        """Add the component to an ifcopenshell model, as exporters ask objects that know better than their shape; return the product.

        Raises
        ------
        InputError
            Where the model is of another schema than IFC4 and IFC 4.3, or the object's dimensions do not belong together.
        """
        from pipeworkbench.exports.ifc_into import add_component

        return add_component(ifcfile, component_of(obj), obj.Document.Label)

    @contextlib.contextmanager
    def quiet(self) -> Iterator[None]:
        """For a while nothing is derived from this object's changes: whoever makes them sets all that belongs together."""
        before, self._quiet = self._quiet, True
        try:
            yield
        finally:
            self._quiet = before

    def _leads(self, obj: Any, name: str) -> bool:
        """Tell whether something is to be derived from a change of a property."""
        shaping = ("Placement", "NominalDiameter", "OutsideDiameter", *self.choices, *self.standard_dimensions, *self.free_dimensions)
        if self._quiet or name not in shaping or is_restoring(obj) or is_newer(obj):
            return False
        return all(hasattr(obj, prop.name) for prop in self.properties)  # else it is still being made

    def _derive(self, obj: Any, name: str) -> None:
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
            with self.quiet():
                self.set_standard(obj, size)
                obj.NominalDiameter = nominal_diameter(size)
            relabel(obj)
        elif name in self.choices:
            with self.quiet():
                self.choose(obj, name)
        elif name in self.standard_dimensions:
            with self.quiet():
                self.forget_standard(obj)

    def _keep_place(self, obj: Any) -> None:
        """Put the anchor back to where it was."""
        if self._anchor is None or any(path.lstrip(".").startswith("Placement") for path, *_ in obj.ExpressionEngine):
            return
        shift = self._anchor - self.placement(obj).multVec(self.anchor(obj))
        if shift.Length > 0:
            self.move(obj, FreeCAD.Placement(shift, FreeCAD.Rotation()))

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
            "standard": self.standard(obj),
            "verified": grades.get(obj.StandardSources),
            "fixed": obj.Fixed,
        }
        return _checked(obj, fields | self.geometry(obj) | self.attributes(obj))

    def migrate(self, obj: Any, version: int, replaced: Fields) -> None:
        """Version 1 kept the bare coordinates of what was measured, of pipes; version 2 had texts instead of enumerations."""
        with self.quiet():
            for name, value in replaced.items():
                offer(obj, name, obj.getEnumerationsOfProperty(name), value or NONE)
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


_models: dict[str, str] = {}  # BREP of what was modelled, by ComponentFeature.model_key


def offer(obj: Any, name: str, wanted: Iterable[str], chosen: str | None = None) -> None:
    """Offer names in an enumeration of an object and choose one; without ``chosen`` the choice stays where it is still offered."""
    present = obj.getEnumerationsOfProperty(name) or []
    chosen = chosen or (getattr(obj, name) if present else None)
    names = list(dict.fromkeys((*wanted, *([chosen] if chosen else ()))))
    if present != names:
        setattr(obj, name, names)
    if chosen:
        setattr(obj, name, chosen)


def port(x: float = 0.0, z: float = 0.0, tilt_deg: float = 0.0) -> Any:
    """Return the frame of an end in the plane y = 0 of a component's own axes; its z axis is turned by an angle from z towards x."""
    return FreeCAD.Placement(FreeCAD.Vector(x, 0, z), FreeCAD.Rotation(FreeCAD.Vector(0, 1, 0), tilt_deg))


def nominal_diameter(size: PipeSize | None) -> str:
    """Return what the enumeration of nominal diameters calls a size."""
    return size.designation if size and size.dn else NONE


def relabel(obj: Any) -> None:
    """Let the label say the size, unless the user gave another one."""
    name = obj.ComponentId
    if re.fullmatch(SIZE_LABEL, obj.Label.removeprefix(f"{name} ")):
        size = obj.NominalDiameter if obj.NominalDiameter != NONE else f"{obj.OutsideDiameter.Value:.1f} mm"
        if obj.Label != f"{name} {size}":
            obj.Label = f"{name} {size}"


@functools.lru_cache(maxsize=1)
def _nominal_diameters(tables: Catalogue) -> tuple[str, ...]:
    return tuple(dict.fromkeys((NONE, *(size.designation for size in tables.pipe_sizes() if size.dn))))


def set_component(obj: Any, component: AnyComponent) -> None:
    """Give a document object the geometry and measurement of a component; links to the object stay, and nothing else follows.

    Raises
    ------
    InputError
        Where a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    if obj.MeasuredAs and component_of(obj) == component:
        return
    feature, frame = obj.Proxy, frame_of(component)
    with feature.quiet(), holding():
        obj.ComponentId = component.id
        obj.OutsideDiameter = component.outer_diameter
        obj.NominalDiameter = nominal_diameter(pipe_size(component.outer_diameter))
        feature.set_dimensions(obj, component, frame)
        obj.WallThickness = component.wall_thickness or 0
        feature.say_standard(obj, component.standard, component.verified)
        obj.Placement = FreeCAD.Placement(FreeCAD.Matrix(*(value for row in frame.matrix for value in row)))
        obj.StationName = component.station or ""
        obj.Pick = NO_PICK if component.pick is None else component.pick
        obj.Quality = -1.0 if component.quality is None else component.quality
        obj.SigmaPosition = FreeCAD.Vector(*(component.sigma_position or (0, 0, 0)))
        obj.SigmaDirection = component.sigma_direction_deg or 0
        obj.LevelOfAccuracy = component.loa or ""
        obj.Fixed = component.fixed
        _remember(obj, feature, component)
    relabel(obj)


def component_of(obj: Any) -> AnyComponent:
    """Return a document object as a component, in the document's global frame.

    What was measured comes back as it was. Accuracy belongs to it: a component that the user moved or gave other
    dimensions is returned without.

    Raises
    ------
    InputError
        Where the object's dimensions do not belong together, or a newer version of the workbench made it; names the object.
    """
    refuse_newer(obj)
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
