# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components to solids (CadQuery): the one place where geometry is modelled."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.pipeline import AnyComponent, Pipe

if TYPE_CHECKING:
    import cadquery


def _cadquery() -> type[cadquery.Solid]:
    """Import CadQuery late: it takes seconds and only some steps need it."""
    try:
        import cadquery
    except ImportError:
        raise MissingPackageError("CadQuery", "Making solids", "pip install 'cadquery>=2.4,<2.9'") from None
    return cadquery.Solid


def straight_pipe(outer_diameter: float, wall_thickness: float | None, length: float) -> cadquery.Solid:
    """Return a pipe from the origin along +z (mm); massive where the wall thickness is not known.

    Raises
    ------
    InputError
        Where the dimensions do not make a pipe.
    """
    if not all(math.isfinite(x) and x > 0 for x in (outer_diameter, length)):
        raise InputError("pipe", "", f"diameter {outer_diameter:g} mm and length {length:g} mm make no pipe", "give positive dimensions")
    solid = _cadquery()
    body = solid.makeCylinder(outer_diameter / 2, length)
    if not wall_thickness:
        return body
    inner_radius = outer_diameter / 2 - wall_thickness
    if not (math.isfinite(wall_thickness) and wall_thickness > 0 and inner_radius > 0):
        raise InputError("pipe", "wall_thickness", f"{wall_thickness:g} mm does not fit into {outer_diameter:g} mm", "give less than the radius")
    return body.cut(solid.makeCylinder(inner_radius, length)).Solids()[0]


def component_solid(component: AnyComponent) -> cadquery.Solid:
    """Return a component's solid in the pipeline's frame (mm)."""
    if not isinstance(component, Pipe):
        raise InputError(component.id, "kind", f"there is no solid for a {component.kind} yet", "export pipes only")
    import cadquery

    local = straight_pipe(component.outer_diameter, component.wall_thickness, component.length)
    direction = tuple(b - a for a, b in zip(component.start, component.end, strict=True))
    plane = cadquery.Plane(origin=component.start, normal=direction)
    return local.located(cadquery.Location(plane))


def brep_text(solid: cadquery.Solid) -> str:
    """Return a solid in Open CASCADE's BREP format, which FreeCAD reads in no time."""
    buffer = io.BytesIO()
    solid.exportBrep(buffer)
    return buffer.getvalue().decode("ascii")
