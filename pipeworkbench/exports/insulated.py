# SPDX-License-Identifier: LGPL-2.1-or-later
"""What components are insulated with: as a plan has it, else as they say themselves (``extra["insulation"]``)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Pipeline
from pipeworkbench.solids.coverings import BoxCovering, Layer, Sheet

if TYPE_CHECKING:
    from pipeworkbench.insulation.planning import Plan

KEY = "insulation"

Build = tuple[tuple[Layer, ...], Sheet | None]  # layers from the inside to the outside, jacket


def insulation_of(component: AnyComponent) -> Layer | None:
    """Return what a component says it is insulated with (``extra["insulation"]``), None where it says nothing.

    Raises
    ------
    InputError
        Where thickness or material do not fit.
    """
    said = component.extra.get(KEY)
    if said is None:
        return None
    thickness, material = (said.get("thickness"), said.get("material")) if isinstance(said, dict) else (None, None)
    if isinstance(thickness, bool) or not isinstance(thickness, int | float) or not (math.isfinite(thickness) and thickness > 0):
        raise InputError(component.id, f"{KEY}.thickness", f"is {thickness!r}", "give the layer's thickness in mm")
    if not isinstance(material, str) or not material:
        raise InputError(component.id, f"{KEY}.material", f"is {material!r}", "name the layer's material")
    return Layer(material, float(thickness))


def builds_of(pipeline: Pipeline, plan: Plan | None = None) -> dict[str, Build]:
    """Return layers and jacket by component id, for those that are insulated; a plan stands for whatever components say themselves."""
    if plan is None:
        said = {component.id: insulation_of(component) for component in pipeline.components}
        return {name: ((layer,), None) for name, layer in said.items() if layer is not None}
    found: dict[str, Build] = {}
    for piece in plan.pieces:
        covering = piece.covering
        names = covering.components if isinstance(covering, BoxCovering) else ()
        if covering.layers:
            for name in dict.fromkeys((covering.component, *names)):
                # what was said first is the covering of its own; a box reaches over neighbours
                found.setdefault(name, (covering.layers, covering.sheet))
    return found


def build_text(build: Build) -> str:
    """Return layers and jacket in one phrase, such as ``60 mm mineral wool + 0.8 mm aluminium``."""
    layers, sheet = build
    parts: list[Layer | Sheet] = [*layers, *([sheet] if sheet else [])]
    return " + ".join(f"{part.thickness:g} mm {part.material}" for part in parts)
