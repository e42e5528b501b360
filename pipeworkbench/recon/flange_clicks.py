# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a click on a rim to the pipes it can belong to: where the image ray passes their axes, and how far from them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.flange_axes import FlangeAxis, axes_of, places_near_click
from pipeworkbench.recon.flange_search import variants_for
from pipeworkbench.recon.flange_settings import FlangeSettings
from pipeworkbench.recon.groups import distinct
from pipeworkbench.recon.picks import FlangePick
from pipeworkbench.recon.vectors import across
from pipeworkbench.recon.views import View


def axes_of_click(
    view: View, pick: FlangePick, pipes: Sequence[Pipe], settings: FlangeSettings, name: str
) -> list[tuple[FlangeAxis, tuple[float, float]]]:
    """Return the axes that the clicked rim can be on, the likeliest first, and where; of collinear pipes the nearest one's."""
    (ray,) = view.camera.rays(pick.point[None])
    reachable: list[tuple[float, FlangeAxis, tuple[float, float]]] = []
    unknown: list[tuple[float, Pipe]] = []
    nearest = (np.inf, "", 0.0)
    for axis in axes_of(pipes, settings):
        along, distance = _passing(view, axis, ray)
        beyond = float(axis.beyond(np.array([along]))[0])
        diameters = np.array(sorted({v.dimensions.D for v in variants_for(axis.pipe.outer_diameter, 2 * distance)}))
        if not len(diameters):
            if distance < 2 * axis.pipe.outer_diameter and beyond < settings.beyond:
                unknown.append((distance, axis.pipe))
            continue
        nearest = min(nearest, (distance + beyond, axis.pipe.id, float(diameters.max() / 2)))
        if distance > diameters.max() / 2 + settings.off_axis:
            continue
        places = places_near_click(view, axis, diameters, pick.point, settings)
        if places is not None:
            # where the pipe's own piece is nearest, its axis is known best
            own = float(np.maximum(np.maximum(-along, along - axis.pipe.length), 0))
            off = float(np.abs(diameters / 2 - distance).min())
            reachable.append((min(beyond, own) / 10 + off, axis, places))
    if not reachable and unknown:
        _, pipe = min(unknown, key=lambda item: item[0])
        raise InputError(
            name,
            "point",
            f"no table has a flange for pipe {pipe.id} of {pipe.outer_diameter:g} mm",
            "give the pipe a standard diameter or add a table of your own",
        )
    if not reachable:
        distance, pipe_id, radius = nearest
        raise InputError(
            name,
            "point",
            f"the click is {distance:.0f} mm from the nearest pipe {pipe_id}, whose largest flange has a radius of {radius:g} mm",
            "click on the straight edge of the rim, or pick the flange's pipe first",
        )
    nearest_first = [(axis, places) for _, axis, places in sorted(reachable, key=lambda item: item[0])]
    return distinct(nearest_first, lambda nearer, one: one[0].pipe.id in nearer[0].same)[: settings.pipes]


def _passing(view: View, axis: FlangeAxis, ray: Array) -> tuple[float, float]:
    """Return where along the axis (mm) a ray passes it nearest, and at which distance: the rim's radius where it touches the rim."""
    cylinder = axis.cylinder
    along = float(cylinder.as_many().nearest_to_ray(view.camera.projection_centre, ray)[0])
    return along, float(np.linalg.norm(across(cylinder.at(along) - view.camera.projection_centre, ray)))


def rim_diameter(view: View, axis: FlangeAxis, point: Array) -> float:
    """Return the diameter (mm) of the rim that a pixel's ray touches (Sect. 6: from the skew distance of ray and axis)."""
    (ray,) = view.camera.rays(point[None])
    return 2 * _passing(view, axis, ray)[1]
