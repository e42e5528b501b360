# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a pipeline knows beyond its components, as a document object: joints, stations and accuracy."""

from __future__ import annotations

import json
from typing import Any

from pipeworkbench.features.base import HIDDEN, READ_ONLY, Feature, Property
from pipeworkbench.pipeline import Pipeline

Fields = dict[str, Any]


class ConnectionsFeature(Feature):
    """Proxy of the joints and stations of the components that are measured in one frame."""

    type_name = "PipeWorkbench::Connections"
    properties = (
        Property("FrameName", "App::PropertyString", "Pipeline", "Station in whose level frame the components are", READ_ONLY),
        Property("Joints", "App::PropertyStringList", "Pipeline", "Which ends are joined: component and number of its end", READ_ONLY),
        Property("Stations", "App::PropertyStringList", "Pipeline", "Stations that measured the components", READ_ONLY),
        Property("Sigma0", "App::PropertyFloat", "Pipeline", "Standard deviation of unit weight of the adjustment, 0 for none", READ_ONLY),
        Property("Data", "App::PropertyString", "Base", "The pipeline without its components (JSON)", HIDDEN),
    )

    def execute(self, obj: Any) -> None:
        """Do nothing: connections have no shape."""


def is_needed(pipeline: Pipeline) -> bool:
    """Tell whether a pipeline knows more than its components and their station do."""
    plain = Pipeline.of_station(pipeline.frame, ())
    return bool(pipeline.joints or pipeline.extra) or pipeline.sigma0 is not None or pipeline.stations != plain.stations


def set_connections(obj: Any, pipeline: Pipeline) -> None:
    """Bring the object up to date; joints of components that the pipeline does not hold stay."""
    renewed = {component.id for component in pipeline.components}
    old = data_of(obj)
    data = pipeline.to_dict() | {"components": []}
    data["joints"] = [joint for joint in old.get("joints", []) if not {joint["a"], joint["b"]} <= renewed] + data["joints"]
    data["stations"] = old.get("stations", {}) | data["stations"]
    obj.Data = json.dumps(data)
    obj.FrameName = pipeline.frame
    obj.Joints = [f"{joint['a']} ({joint['a_port']}) - {joint['b']} ({joint['b_port']})" for joint in data["joints"]]
    obj.Stations = list(data["stations"])
    obj.Sigma0 = pipeline.sigma0 or 0.0
    obj.Label = f"Connections {pipeline.frame}"


def data_of(obj: Any) -> Fields:
    """Return the pipeline without its components, as its file has it."""
    data: Fields = json.loads(obj.Data) if obj.Data else {}
    return data
