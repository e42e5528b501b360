# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight edges in space: segments of two images whose planes meet in a line that a third image confirms.

The edges of a pipe that cameras side by side see are not the same lines on its surface, but the planes through
them and the projection centres are all tangent to it. Two of them meet beside the surface by
r (1 / cos(a / 2) - 1), where a is the angle between the views: some tenths of a millimetre. So the
edges can be matched as if they were one line in space, and a third camera is a witness.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.lines import LineSegments
from pipeworkbench.recon.match import match
from pipeworkbench.recon.texture import NODES
from pipeworkbench.recon.views import View

BLOCK = 512  # segments at a time against all of another image
CELL_PX, CELL_MM = 3.0, 100.0  # lines in one cell of direction and place are one
BESIDE_MM = 5.0  # step of the derivative across a line
OTHER_RAY = 1e-9  # below this two lines are parallel


@dataclass(frozen=True)
class EdgeLineSettings:
    """Tunables; lengths in mm, distances in images in px.

    ``working_range`` of distances from the cameras; ``least_angle_deg`` between the planes, below which their line is not
    known; ``overlap`` of the segments along the line, in parts of the shorter; ``samples`` per line with
    which the witnesses are asked, ``witness_range`` to each side; ``least_witnesses`` the part of samples
    that the best witness must confirm; ``steepest_deg`` between line and image plane.
    """

    working_range: tuple[float, float] = (2000.0, 12000.0)
    least_angle_deg: float = 1.0
    overlap: float = 0.4
    least_length: float = 40.0
    samples: int = 16
    witness_range: float = 2.0
    least_witnesses: float = 0.55
    steepest_deg: float = 65.0


@dataclass(frozen=True, eq=False)
class EdgeLines:
    """Straight edges in space, k in number.

    ends (k, 2, 3) mm; bright (k, 3) unit, across the line and the line of sight, towards what is brighter;
    support (k,) 0 to 1, how much the images agree; views (k, 2) the images whose segments made it and rows (k, 2)
    their numbers there.
    """

    ends: Array
    bright: Array
    support: Array
    views: NDArray[np.intp]
    rows: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.support)

    def __getitem__(self, which: NDArray[np.intp] | NDArray[np.bool_]) -> EdgeLines:
        return EdgeLines(self.ends[which], self.bright[which], self.support[which], self.views[which], self.rows[which])

    @property
    def direction(self) -> Array:
        """Unit vectors (k, 3) from the first end to the second."""
        along = self.ends[:, 1] - self.ends[:, 0]
        return along / np.linalg.norm(along, axis=1, keepdims=True)


@dataclass(frozen=True, eq=False)
class _Planes:
    """Planes through a projection centre and segments: centre (3,), rays (k, 2, 3) to the ends, normal (k, 3) towards the brighter side."""

    centre: Array
    rays: Array
    normal: Array


def match_lines(views: Sequence[View], segments: Sequence[LineSegments], settings: EdgeLineSettings | None = None) -> EdgeLines:
    """Find straight edges in space.

    Parameters
    ----------
    views : sequence of View
        Images of one station.
    segments : sequence of LineSegments
        Of each image, with the distortion taken off (``interior`` given).
    settings : EdgeLineSettings, optional

    Returns
    -------
    EdgeLines
        The best supported first; where an image confirms a line twice, once.
    """
    settings = settings or EdgeLineSettings()
    if len(views) < 2:
        none = np.zeros((0, 2), np.intp)
        return EdgeLines(np.zeros((0, 2, 3)), np.zeros((0, 3)), np.zeros(0), none, none)
    planes = [_planes_of(view.camera, lines, settings) for view, lines in zip(views, segments, strict=True)]
    found = [_between(views, planes, pair, settings) for pair in itertools.combinations(range(len(views)), 2)]
    lines = EdgeLines(*(np.concatenate([getattr(part, name) for part in found]) for name in ("ends", "bright", "support", "views", "rows")))
    return lines[_distinct(views, lines)]


def _distinct(views: Sequence[View], lines: EdgeLines) -> NDArray[np.intp]:
    """Return the best of lines that are nearly the same, best first: one per cell of a grid over how they look from two cameras."""
    middle, length = lines.ends.mean(axis=1), np.linalg.norm(lines.ends[:, 1] - lines.ends[:, 0], axis=1)
    cells = []
    for view in views[:2]:
        normal = np.cross(lines.ends[:, 0] - view.camera.projection_centre, lines.ends[:, 1] - view.camera.projection_centre)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        normal *= np.where(np.einsum("ki,ki->k", normal, lines.bright) < 0, -1.0, 1.0)[:, None]
        cells.append(np.rint(normal * view.camera.interior.pixels_per_radian / CELL_PX))
    along = np.einsum("ki,ki->k", middle, np.abs(lines.direction)) / np.maximum(length, CELL_MM)
    cells += [np.rint(along)[:, None], np.rint(np.log2(np.maximum(length, 1.0)))[:, None]]
    order = np.argsort(-lines.support * np.sqrt(length), kind="stable")
    _, first = np.unique(np.column_stack(cells)[order], axis=0, return_index=True)
    return order[np.sort(first)]


def segment_rays(camera: Camera, ends: Array) -> Array:
    """Return unit vectors (k, 2, 3), in the station's frame, to the ends (k, 2, 2) of segments in pixels without distortion."""
    interior = camera.interior
    ideal = (ends.reshape(-1, 2) - interior.pixels(np.zeros((1, 2)))) / interior.pixels_per_radian
    rays = np.column_stack([ideal, np.ones(len(ideal))]) @ camera.rotation
    return (rays / np.linalg.norm(rays, axis=1, keepdims=True)).reshape(-1, 2, 3)


def _planes_of(camera: Camera, lines: LineSegments, settings: EdgeLineSettings) -> _Planes:
    rays = segment_rays(camera, lines.ends[lines.length >= settings.least_length])
    normal = np.cross(rays[:, 0], rays[:, 1])
    # the brighter side is on the right of the direction: with u right, v down and z forward that is z x direction
    return _Planes(camera.projection_centre, rays, normal / np.linalg.norm(normal, axis=1, keepdims=True))


def _between(views: Sequence[View], planes: Sequence[_Planes], pair: tuple[int, int], settings: EdgeLineSettings) -> EdgeLines:
    """Return the lines in which planes of two images meet and that the other images confirm."""
    first, second = planes[pair[0]], planes[pair[1]]
    parts = [_candidates(first, second, slice(start, start + BLOCK), settings) for start in range(0, max(len(first.normal), 1), BLOCK)]
    rows, ends = np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
    middle = ends.mean(axis=1)
    bright = first.normal[rows[:, 0]] + second.normal[rows[:, 1]]
    bright /= np.linalg.norm(bright, axis=1, keepdims=True)
    along = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1, keepdims=True)
    sight = middle - (first.centre + second.centre) / 2
    sight /= np.linalg.norm(sight, axis=1, keepdims=True)
    flat = np.abs(np.einsum("ki,ki->k", along, sight)) < np.sin(np.radians(settings.steepest_deg))
    rows, ends, bright = rows[flat], ends[flat], bright[flat]
    others = [view for number, view in enumerate(views) if number not in pair]
    support = np.max([_confirmed(view, ends, bright, settings) for view in others], axis=0) if others else np.ones(len(rows))
    # cameras that do not see the line say nothing against it, nor for it where another denies it
    support = np.where(support < 0, settings.least_witnesses, support)
    good = support >= settings.least_witnesses
    return EdgeLines(ends[good], bright[good], support[good], np.tile(pair, (int(good.sum()), 1)), rows[good])


def _candidates(first: _Planes, second: _Planes, block: slice, settings: EdgeLineSettings) -> tuple[NDArray[np.intp], Array]:
    """Return rows (m, 2) of planes that meet in the working range and the ends (m, 2, 3) of what they share."""
    normals = first.normal[block]
    offset = int(block.start)
    # like polarity: both normals point to the brighter side, which is the same for cameras side by side
    cosine = normals @ second.normal.T
    near_parallel = np.cos(np.radians(settings.least_angle_deg))
    one, other = np.nonzero((cosine > 0) & (cosine < near_parallel))
    ends_first = _on_planes(first.centre, first.rays[block][one], second.centre, second.normal[other])
    near, far = settings.working_range
    with np.errstate(invalid="ignore"):
        good = ((ends_first > near) & (ends_first < far)).all(axis=1)
    one, other, ends_first = one[good], other[good], ends_first[good]
    ends_second = _on_planes(second.centre, second.rays[other], first.centre, normals[one])
    with np.errstate(invalid="ignore"):
        good = ((ends_second > near) & (ends_second < far)).all(axis=1)
    one, other, ends_first, ends_second = one[good], other[good], ends_first[good], ends_second[good]

    start = first.centre + ends_first[:, :1] * first.rays[block][one][:, 0]
    stop = first.centre + ends_first[:, 1:] * first.rays[block][one][:, 1]
    length = np.linalg.norm(stop - start, axis=1)
    along = (stop - start) / np.maximum(length, OTHER_RAY)[:, None]
    places = [np.einsum("mi,mi->m", second.centre + ends_second[:, i, None] * second.rays[other][:, i] - start, along) for i in (0, 1)]
    low, high = np.minimum(*places), np.maximum(*places)
    shared_low, shared_high = np.maximum(low, 0), np.minimum(high, length)
    good = shared_high - shared_low >= settings.overlap * np.minimum(length, high - low)
    # what either image shows is a part of the line: the union of both
    low, high = np.minimum(low, 0)[good], np.maximum(high, length)[good]
    start, along = start[good], along[good]
    ends = np.stack([start + low[:, None] * along, start + high[:, None] * along], axis=1)
    return np.column_stack([one[good] + offset, other[good]]), ends


def _on_planes(centre: Array, rays: Array, other_centre: Array, normals: Array) -> Array:
    """Return how far (m, 2) rays (m, 2, 3) from a centre go to planes through another centre."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return ((other_centre - centre) @ normals.T)[:, None] / np.einsum("mei,mi->me", rays, normals)


def _confirmed(view: View, ends: Array, bright: Array, settings: EdgeLineSettings) -> Array:
    """Return which part (k,) of lines' samples in another image has an edge of the same polarity, -1 where it does not see them."""
    position, normal, _ = samples_in(view.camera, ends, bright, settings.samples)
    hit = match(view.edges, position, normal, settings.witness_range, np.ones(len(position))).found.reshape(-1, settings.samples)
    seen = np.isfinite(position[:, 0]).reshape(-1, settings.samples).sum(axis=1)
    return np.where(seen >= settings.samples / 2, hit.sum(axis=1) / np.maximum(seen, 1), -1.0)


def samples_in(camera: Camera, ends: Array, bright: Array, samples: int) -> tuple[Array, Array, Array]:
    """Return evenly spaced samples of lines in an image, those of one line after those of the other.

    Parameters
    ----------
    camera : Camera
    ends : (k, 2, 3) array
        In space, mm.
    bright : (k, 3) array
        Unit vectors towards the brighter side.
    samples : int
        Per line.

    Returns
    -------
    position, normal : (k * samples, 2) arrays
        Pixels, NaN outside the image; unit normals towards the brighter side.
    scale : (k * samples,) array
        Pixels along the normal per mm along ``bright``.
    """
    # three places are projected, and those beside them: between them a parabola is exact enough
    part = 2 * (np.arange(samples) + 0.5) / samples - 1
    nodes = ends[:, :1] + (NODES[:, None] + 1) / 2 * (ends[:, 1:] - ends[:, :1])
    at_nodes = camera.project(nodes.reshape(-1, 3)).reshape(-1, 3, 2)
    beside = camera.project((nodes + BESIDE_MM * bright[:, None]).reshape(-1, 3)).reshape(-1, 3, 2)
    weights, slopes = _parabola_at(part)
    position = (weights @ at_nodes).reshape(-1, 2)
    towards = (weights @ (beside - at_nodes)).reshape(-1, 2) / BESIDE_MM
    tangent = (slopes @ at_nodes).reshape(-1, 2)
    position[~camera.sees(position)] = np.nan
    with np.errstate(invalid="ignore", divide="ignore"):
        normal = np.column_stack([-tangent[:, 1], tangent[:, 0]]) / np.linalg.norm(tangent, axis=1, keepdims=True)
    scale = np.einsum("ni,ni->n", towards, normal)
    return position, normal * np.where(scale < 0, -1.0, 1.0)[:, None], np.abs(scale)


def _parabola_at(places: Array) -> tuple[Array, Array]:
    """Return weights (n, 3) of values at NODES that interpolate at places (n,), and those of the slope there."""
    x = places
    return np.stack([x * (x - 1) / 2, 1 - x**2, x * (x + 1) / 2], axis=1), np.stack([x - 0.5, -2 * x, x + 0.5], axis=1)
