# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves to be drawn in the photographs, in their own, distorted pixels: contours, epipolar lines, straight edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent, Flange
from pipeworkbench.recon.camera import Array, Camera, Interior
from pipeworkbench.recon.contour import TOUCHING_MM, Contour, contour_of_shapes
from pipeworkbench.recon.lines import LineSegments
from pipeworkbench.recon.shapes import Circles, Shapes, shapes_of
from pipeworkbench.recon.station import Station

INTERVAL_PX = 6.0  # between the samples of a drawn contour
EPIPOLAR_SAMPLES = 65
LINE_SAMPLES = 9

Polylines = list[Array]


@dataclass(frozen=True, eq=False)
class ComponentCurves:
    """A component's contour in one image as polylines (n, 2) in pixels: what is seen of it, and what is hidden by something."""

    seen: Polylines
    hidden: Polylines


@dataclass(frozen=True, eq=False)
class EpipolarCurve:
    """Where the object point of a pixel may lie in another image: positions (n, 2) in pixels, distances (n,) in mm from the first camera."""

    position: Array
    distance: Array


def contours_in(station: Station, components: Sequence[AnyComponent], alternatives: Sequence[int] | None = None) -> list[dict[str, Polylines]]:
    """Return what a station's cameras see of components, for each component by the camera's name.

    Parameters
    ----------
    station : Station
    components : sequence of components
        In the station's level frame; they hide each other.
    alternatives : sequence of int, optional
        Number of the alternative that each component belongs to: those of different ones do not hide each other.

    Returns
    -------
    list of dict
        For each component polylines (n, 2) in pixels of each camera's photograph.

    Raises
    ------
    InputError
        Where a component has no such geometry.
    """
    return [{camera: curves.seen for camera, curves in by_camera.items()} for by_camera in component_curves(station, components, alternatives)]


def component_curves(
    station: Station, components: Sequence[AnyComponent], alternatives: Sequence[int] | None = None
) -> list[dict[str, ComponentCurves]]:
    """Return what :func:`contours_in` does together with the hidden parts."""
    shapes = _with_ends(shapes_of(components), components)
    found: list[dict[str, ComponentCurves]] = [{} for _ in components]
    for camera in station.cameras:
        contour = contour_of_shapes(camera, shapes, INTERVAL_PX, TOUCHING_MM, alternatives)
        seen, hidden = _runs(contour, contour.visible), _runs(contour, ~contour.visible)
        for owner, by_camera in enumerate(found):
            by_camera[camera.name] = ComponentCurves(seen.get(owner, []), hidden.get(owner, []))
    return found


def epipolar_curve(
    camera: Camera, point: tuple[float, float], other: Camera, working_range: tuple[float, float], samples: int = EPIPOLAR_SAMPLES
) -> EpipolarCurve:
    """Return where the object point of a pixel is in another camera's image, for all distances of a working range.

    Parameters
    ----------
    camera, other : Camera
    point : (u, v)
        In the first camera's image.
    working_range : (near, far)
        Distances from the first camera in mm.
    samples : int
        Their reciprocals are spaced evenly, as the images of the points about are.

    Returns
    -------
    EpipolarCurve
        From near to far; only what lies inside the other image.
    """
    near, far = working_range
    distance = 1 / np.linspace(1 / near, 1 / far, samples)
    ray = camera.rays(np.array([point], float))[0]
    position = other.project(camera.projection_centre + distance[:, None] * ray)
    inside = other.sees(position)
    return EpipolarCurve(position[inside], distance[inside])


def lines_in_photograph(lines: LineSegments, interior: Interior, samples: int = LINE_SAMPLES) -> Array:
    """Return straight edges that were fitted without distortion as curves (k, samples, 2) in the photograph's pixels."""
    part = np.linspace(0, 1, samples)[None, :, None]
    straight = lines.ends[:, :1] * (1 - part) + lines.ends[:, 1:] * part
    origin = interior.pixels(np.zeros((1, 2)))
    return interior.pixels((straight.reshape(-1, 2) - origin) / interior.pixels_per_radian).reshape(straight.shape)


def distance_to_polyline(point: Array, line: Array) -> float:
    """Return the distance of a point (2,) from a polyline (n, 2)."""
    start, way = line[:-1], np.diff(line, axis=0)
    length = np.maximum(np.einsum("ni,ni->n", way, way), 1e-12)
    part = np.clip(np.einsum("ni,ni->n", point - start, way) / length, 0.0, 1.0)
    return float(np.linalg.norm(start + part[:, None] * way - point, axis=1).min())


def _with_ends(shapes: Shapes, components: Sequence[AnyComponent]) -> Shapes:
    """Return shapes with the circles in which components end: nobody measures these, but the eye misses them."""
    ends = [(owner, port) for owner, component in enumerate(components) if not isinstance(component, Flange) for port in component.ports]
    if not ends:
        return shapes
    edges = Circles(
        np.concatenate([shapes.edges.centre, [port.point for _, port in ends]]),
        np.concatenate([shapes.edges.axis, [port.direction for _, port in ends]]),
        np.concatenate([shapes.edges.radius, [port.diameter / 2 for _, port in ends]]),
        np.concatenate([shapes.edges.owner, np.array([owner for owner, _ in ends], np.intp)]),
    )
    return replace(shapes, edges=edges, edge_part=(*shapes.edge_part, *("end",) * len(ends)))


def _runs(contour: Contour, wanted: NDArray[np.bool_]) -> dict[int, Polylines]:
    """Return by component the stretches of curves whose samples are wanted, each with the sample after it so that no gap is left."""
    same = contour.curve[1:] == contour.curve[:-1]
    kept = wanted.copy()
    kept[1:] |= wanted[:-1] & same
    rows = np.flatnonzero(kept & np.isfinite(contour.position).all(axis=1))
    if not len(rows):
        return {}
    breaks = (np.diff(rows) > 1) | (np.diff(contour.curve[rows]) != 0)
    runs: dict[int, Polylines] = {}
    for run in np.split(rows, np.flatnonzero(breaks) + 1):
        if len(run) > 1:
            runs.setdefault(int(contour.component[run[0]]), []).append(contour.position[run])
    return runs
