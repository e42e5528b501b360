# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a pipeline knows beyond its components, as a document object: stations, accuracy, and what joints say beyond their links.

The joints themselves are links between the components (``joints``).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import FreeCAD

from pipeworkbench.features.base import HIDDEN, READ_ONLY, SCHEMA_VERSION, Feature, Property, is_newer, refuse_newer
from pipeworkbench.features.carrying import holding
from pipeworkbench.features.joints import connect, disconnect_all, joints_of
from pipeworkbench.pipeline import Pipeline

Fields = dict[str, Any]
JointKey = frozenset[tuple[str, int]]


class ConnectionsFeature(Feature):
    """Proxy of the stations and the accuracy of the components that are measured in one frame."""

    type_name = "PipeWorkbench::Connections"
    version = 2
    properties = (
        Property("FrameName", "App::PropertyString", "Pipeline", "Station in whose level frame the components are", READ_ONLY),
        Property("Stations", "App::PropertyStringList", "Pipeline", "Stations that measured the components", READ_ONLY),
        Property("Sigma0", "App::PropertyFloat", "Pipeline", "Standard deviation of unit weight of the adjustment, 0 for none", READ_ONLY),
        Property(
            "Data", "App::PropertyString", "Base", "The pipeline without its components (JSON); of its joints those hold that are linked", HIDDEN
        ),
    )

    def execute(self, obj: Any) -> None:
        """Do nothing: connections have no shape."""

    def migrate(self, obj: Any, version: int, replaced: Fields) -> None:  # noqa: ARG002
        """Version 1 kept joints by the names of the components alone."""
        if version >= 2:
            return
        if "Joints" in obj.PropertiesList:
            obj.removeProperty("Joints")
        components = [other for other in obj.Document.Objects if hasattr(getattr(other, "Proxy", None), "ends")]
        for other in components:
            if getattr(other, SCHEMA_VERSION, 1) < other.Proxy.version:
                other.Proxy.bring_up_to_date(other)  # its links may not be there yet
        link(components, data_of(obj).get("joints", ()))


def is_needed(pipeline: Pipeline) -> bool:
    """Tell whether a pipeline knows more than its components and their station do."""
    plain = Pipeline.of_station(pipeline.frame, ())
    return bool(pipeline.joints or pipeline.extra) or pipeline.sigma0 is not None or pipeline.stations != plain.stations


def set_connections(obj: Any, pipeline: Pipeline, components: Iterable[Any]) -> None:
    """Bring the object and the joints of its components up to date; joints of components that the pipeline does not hold stay.

    Parameters
    ----------
    obj : document object
    pipeline : Pipeline
    components : document objects
        Of the pipeline's components.

    Raises
    ------
    InputError
        Where a newer version of the workbench made the object.
    """
    refuse_newer(obj)
    renewed = {component.id for component in pipeline.components}
    old = data_of(obj)
    data = pipeline.to_dict() | {"components": []}
    own = data["joints"]
    data["joints"] = [joint for joint in old.get("joints", []) if not {joint["a"], joint["b"]} <= renewed] + own
    data["stations"] = old.get("stations", {}) | data["stations"]
    obj.Data = json.dumps(data)
    obj.FrameName = pipeline.frame
    obj.Stations = list(data["stations"])
    obj.Sigma0 = pipeline.sigma0 or 0.0
    obj.Label = f"Connections {pipeline.frame}"
    objects = [other for other in components if not is_newer(other)]
    with holding():
        disconnect_all(objects)
        link(objects, own)


def link(components: Iterable[Any], joints: Iterable[Mapping[str, Any]]) -> None:
    """Link the ends of component objects as joints of the exchange format say; an end has one joint, the first."""
    by_id = {obj.ComponentId: obj for obj in components}
    for joint in joints:
        a, b = by_id.get(joint["a"]), by_id.get(joint["b"])
        if a is None or b is None:
            continue
        taken = {(obj.Name, joined.end) for obj in (a, b) for joined in joints_of(obj)}
        if taken & {(a.Name, joint["a_port"]), (b.Name, joint["b_port"])}:
            FreeCAD.Console.PrintWarning(f"{joint['a']} and {joint['b']}: an end of them is joined already; this joint is left out\n")
        else:
            connect(a, joint["a_port"], b, joint["b_port"])


def linked_joints(components: Iterable[Any], known: Iterable[Mapping[str, Any]] = ()) -> list[Fields]:
    """Return the joints between component objects as the exchange format has them.

    Those among ``known`` come first, in their order and with what they say beyond their ends.
    """
    among = {obj.Name: obj for obj in components}
    found: dict[JointKey, Fields] = {}
    for obj in among.values():
        for end, other, other_end in joints_of(obj):
            if other.Name in among:
                joint = {"a": obj.ComponentId, "a_port": end, "b": other.ComponentId, "b_port": other_end}
                found.setdefault(_key(joint), joint)
    kept = {_key(joint): dict(joint) for joint in known}
    return [joint for key, joint in kept.items() if key in found] + [joint for key, joint in found.items() if key not in kept]


def _key(joint: Mapping[str, Any]) -> JointKey:
    """Return what is the same for a joint whichever of its ends is named first."""
    return frozenset({(joint["a"], joint["a_port"]), (joint["b"], joint["b_port"])})


def data_of(obj: Any) -> Fields:
    """Return the pipeline without its components, as its file has it."""
    data: Fields = json.loads(obj.Data) if obj.Data else {}
    return data
