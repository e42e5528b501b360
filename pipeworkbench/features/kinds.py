# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which document object stands for which kind of component."""

from __future__ import annotations

from typing import Any

from pipeworkbench.features.base import is_kind
from pipeworkbench.features.cap import CapFeature
from pipeworkbench.features.component import ComponentFeature, set_component
from pipeworkbench.features.elbow import ElbowFeature
from pipeworkbench.features.flange import FlangeFeature
from pipeworkbench.features.pipe import PipeFeature
from pipeworkbench.features.reducer import ReducerFeature
from pipeworkbench.features.tee import TeeFeature
from pipeworkbench.pipeline import AnyComponent

FEATURES: dict[type[AnyComponent], type[ComponentFeature]] = {
    feature.kind: feature for feature in (PipeFeature, ElbowFeature, FlangeFeature, TeeFeature, ReducerFeature, CapFeature)
}


def add_component(document: Any, component: AnyComponent) -> Any:
    """Add a component to a document and return the object; the document is not recomputed."""
    obj = document.addObject("Part::FeaturePython", component.kind.capitalize())
    FEATURES[type(component)](obj)
    obj.Label = f"{component.id} DN {component.dn}" if component.dn else f"{component.id} {component.outer_diameter:.1f} mm"
    set_component(obj, component)
    return obj


def is_component(obj: Any) -> bool:
    """Tell whether a document object is a component of a pipeline."""
    return any(is_kind(obj, feature) for feature in FEATURES.values())
