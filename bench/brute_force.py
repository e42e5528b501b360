# SPDX-License-Identifier: LGPL-2.1-or-later
"""The published brute force: all pairs of lines of one image with all pairs of another (Sect. 4.1), for comparison only.

Two lines of about the same direction are the edges of a potential cylinder; each such pair of one image is
intersected with each of another, and three filters keep what could be a pipe: its depth is in the working range, its
diameter is near a standard one, and the rays to the ends of its four edges pass its axis at the distance of the radius.
The number of combinations grows with the fourth power of the number of lines, so there is a time limit.
"""

import itertools
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.catalogue import PipeSize, pipe_sizes
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.edge_lines import segment_rays

PARALLEL = 0.97  # cosine
REPORT_EVERY = 20.0  # s
PER_CYLINDER = 40  # times the memory of a combination that is refused at once
ROUNDING = 1.01  # allowance for single precision, in which most combinations are refused


@dataclass(frozen=True)
class BruteForceSettings:
    """Tunables, where the paper gives no figures those of the search without picks; lengths in mm.

    ``largest_angle_deg`` between two lines of one image that may be a pipe's edges; ``working_range`` of the
    mean distance from the cameras to the edges (first filter); ``diameter_range`` and ``tolerance``, in parts of
    the nearest standard diameter (second filter); ``largest_rms`` of the rays' distances from the axis, less the
    radius (third filter); ``least_intersection_deg`` between the centre planes of both images.
    ``time_limit`` in s. Three limits keep the memory low: ``most_lines`` of an image, the longest, are combined;
    ``block`` combinations are looked at together, some 30 bytes each; ``most_kept`` cylinders that pass are kept, the best.
    """

    largest_angle_deg: float = 5.0
    working_range: tuple[float, float] = (2000.0, 12000.0)
    diameter_range: tuple[float, float] = (15.0, 700.0)
    tolerance: float = 0.012
    largest_rms: float = 0.5
    least_intersection_deg: float = 1.0
    time_limit: float = 1800.0
    most_lines: int = 1500
    block: int = 500_000
    most_kept: int = 100_000


@dataclass(frozen=True, eq=False)
class BruteForce:
    """What passes the filters, best first, and how far the search came.

    ``cylinders`` (k) with extents (k, 2) mm along their axes, rms (k,) mm of the third filter and ``sizes`` (k);
    ``passed`` counts those that passed before those in the same place were left out, ``combinations`` all
    there are, ``tested`` those that were looked at within ``seconds``.
    """

    cylinders: Cylinders
    extents: Array
    rms: Array
    sizes: tuple[PipeSize, ...]
    passed: int
    combinations: int
    tested: int
    seconds: float

    @property
    def ends(self) -> Array:
        """End points (k, 2, 3) of the axes in mm."""
        return self.cylinders.points[:, None] + self.extents[:, :, None] * self.cylinders.directions[:, None]

    @property
    def share(self) -> float:
        """The part of all combinations that was looked at."""
        return self.tested / self.combinations if self.combinations else 1.0


@dataclass(frozen=True, eq=False)
class LinePairs:
    """Pairs of lines of one image that could be a pipe's edges, the longest first.

    centre (3,); tangents (k, 2, 3) unit normals of the planes through both lines, towards the axis;
    centre_planes (k, 3) unit normals (Eq. 1); inward (k, 3) the mean of both tangents; rays (k, 4, 3) unit vectors to the
    ends of both lines.
    """

    centre: Array
    tangents: Array
    centre_planes: Array
    inward: Array
    rays: Array

    def __len__(self) -> int:
        return len(self.tangents)


@dataclass(frozen=True, eq=False)
class _Passed:
    """Cylinders that pass all filters: points, directions (k, 3), radii, rms, size (k,), extents (k, 2)."""

    points: Array
    directions: Array
    radii: Array
    rms: Array
    size: NDArray[np.intp]
    extents: Array

    def __getitem__(self, rows: NDArray[np.intp] | NDArray[np.bool_] | slice) -> "_Passed":
        return _Passed(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    @classmethod
    def joined(cls, parts: Sequence["_Passed"]) -> "_Passed":
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__dataclass_fields__))


def brute_force(
    cameras: Sequence[Camera],
    ends: Sequence[Array],
    settings: BruteForceSettings | None = None,
    progress: Callable[[str], None] = lambda text: None,  # noqa: ARG005
) -> BruteForce:
    """Intersect all pairs of parallel lines of each two images.

    Parameters
    ----------
    cameras : sequence of Camera
    ends : sequence of (n, 2, 2) arrays
        Of the straight lines in each image, in pixels without distortion.
    settings : BruteForceSettings, optional
        Each two cameras get the same part of the time limit; the longest lines are combined first.
    progress : callable
        Called with how far the search came, a few times a minute.
    """
    settings = settings or BruteForceSettings()
    began = time.perf_counter()
    pairs = [line_pairs(camera, lines, settings) for camera, lines in zip(cameras, ends, strict=True)]
    both = list(itertools.combinations(pairs, 2))
    combinations = sum(len(first) * len(second) for first, second in both)
    kept, passed, tested = [_nothing()], 0, 0
    for number, (first, second) in enumerate(both):
        deadline = began + settings.time_limit * (number + 1) / len(both)
        step = max(1, settings.block // max(len(second), 1))
        reported = time.perf_counter()
        for start in range(0, len(first), step):
            now = time.perf_counter()
            if now > deadline:
                break
            if now - reported > REPORT_EVERY:
                progress(f"{tested:.3g} of {combinations:.3g} combinations, {passed} cylinders, {now - began:.0f} s")
                reported = now
            block = slice(start, min(start + step, len(first)))
            found = _combined(first, second, block, settings)
            tested += (block.stop - block.start) * len(second)
            passed += len(found.rms)
            kept.append(found)
            if sum(len(part.rms) for part in kept) > 2 * settings.most_kept:
                kept = [_best(_Passed.joined(kept), settings.most_kept)]
    best = _best(_Passed.joined(kept), settings.most_kept)
    best = best[_one_in_each_place(best)]
    cylinders = Cylinders(best.points, best.directions, best.radii)
    sizes = tuple(pipe_sizes()[row] for row in best.size)
    return BruteForce(cylinders, best.extents, best.rms, sizes, passed, combinations, tested, time.perf_counter() - began)


def line_pairs(camera: Camera, ends: Array, settings: BruteForceSettings) -> LinePairs:
    """Return all pairs of lines with ends (n, 2, 2), in pixels without distortion, that have about the same direction and do not cross."""
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    longest = np.argsort(-length, kind="stable")[: settings.most_lines]
    ends, length = ends[longest], length[longest]
    along = (ends[:, 1] - ends[:, 0]) / length[:, None]
    alike = np.abs(along @ along.T) > np.cos(np.radians(settings.largest_angle_deg))
    first, second = np.nonzero(np.triu(alike, 1))
    order = np.argsort(-np.minimum(length[first], length[second]), kind="stable")
    first, second = first[order], second[order]
    rays = segment_rays(camera, ends)
    normals = np.cross(rays[:, 0], rays[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    # each plane's normal points to the other line: the axis is between them
    beside = np.stack([np.einsum("kei,ki->ke", rays[second], normals[first]), np.einsum("kei,ki->ke", rays[first], normals[second])], axis=1)
    apart = (np.sign(beside).sum(axis=2) != 0).all(axis=1)
    first, second, beside = first[apart], second[apart], beside[apart]
    tangents = np.stack([normals[first], normals[second]], axis=1) * np.sign(beside.sum(axis=2))[:, :, None]
    across = tangents[:, 0] - tangents[:, 1]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    return LinePairs(camera.projection_centre, tangents, across, tangents.mean(axis=1), np.concatenate([rays[first], rays[second]], axis=1))


def _combined(first: LinePairs, second: LinePairs, block: slice, settings: BruteForceSettings) -> _Passed:
    """Return what passes of a block of the first image's pairs with all of the second's."""
    one, other = _of_like_radius(first, second, block, settings)
    step = max(1, settings.block // PER_CYLINDER)
    rows = [slice(start, start + step) for start in range(0, len(one), step)]
    return _Passed.joined([_nothing(), *(_filtered(first, second, one[part], other[part], settings) for part in rows)])


def _of_like_radius(first: LinePairs, second: LinePairs, block: slice, settings: BruteForceSettings) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the combinations of which both images give the same radius: nothing else could pass the third filter.

    For centre planes e and f, through projection centres a base b apart, the axis is |f . b| / |e x f| from the first
    of these, and the radius there is (f . b) (m . f) / |e x f|^2 with the mean m of both tangent planes' normals.
    """
    single = np.float32
    e, f = first.centre_planes[block].astype(single), second.centre_planes.astype(single)
    base = second.centre - first.centre
    sine = 1 - np.square(e @ f.T)
    # radii times the squared sine
    radius = (first.inward[block].astype(single) @ f.T) * (second.centre_planes @ base).astype(single)
    other_radius = e @ second.inward.T.astype(single) * -(first.centre_planes[block] @ base).astype(single)[:, None]
    smallest, largest = settings.diameter_range
    good = np.abs(radius - other_radius) <= single(2 * ROUNDING * settings.largest_rms) * sine
    radius += other_radius
    good &= radius >= single(smallest / ROUNDING) * sine
    good &= radius <= single(largest * ROUNDING) * sine
    good &= sine >= single(np.sin(np.radians(settings.least_intersection_deg)) ** 2)
    one, other = np.nonzero(good)
    return one + block.start, other


def _filtered(first: LinePairs, second: LinePairs, one: NDArray[np.intp], other: NDArray[np.intp], settings: BruteForceSettings) -> _Passed:
    """Return the cylinders of combinations (k,) that pass the three filters."""
    e, f = first.centre_planes[one], second.centre_planes[other]
    directions = np.cross(e, f)
    sine = np.linalg.norm(directions, axis=1)
    directions /= sine[:, None]
    distance = f @ (second.centre - first.centre) / sine
    points = first.centre + distance[:, None] * np.cross(directions, e)
    tangents = np.concatenate([first.tangents[one], second.tangents[other]], axis=1)
    centres = np.repeat([first.centre, second.centre], [2, 2], axis=0)
    radii = np.einsum("kei,kei->ke", tangents, points[:, None] - centres).mean(axis=1)

    rays = np.concatenate([first.rays[one], second.rays[other]], axis=1)
    offset = np.repeat([first.centre, second.centre], [4, 4], axis=0) - points[:, None]
    cosine = np.einsum("kei,ki->ke", rays, directions)
    on_axis, on_ray = np.einsum("kei,ki->ke", offset, directions), np.einsum("kei,kei->ke", offset, rays)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (on_axis - cosine * on_ray) / (1 - cosine**2)
        depth = (cosine * on_axis - on_ray) / (1 - cosine**2)
        skew = np.abs(np.einsum("kei,kei->ke", offset, np.cross(directions[:, None], rays))) / np.sqrt(1 - cosine**2)
        rms = np.sqrt(np.mean((skew - radii[:, None]) ** 2, axis=1))
        near, far = settings.working_range
        good = (depth > 0).all(axis=1) & (depth.mean(axis=1) >= near) & (depth.mean(axis=1) <= far)
        good &= rms <= settings.largest_rms
    standard = np.array([size.outer_diameter for size in pipe_sizes()])
    usable = np.flatnonzero((standard >= settings.diameter_range[0]) & (standard <= settings.diameter_range[1]))
    off = np.abs(2 * radii[:, None] / standard[usable] - 1)
    good &= off.min(axis=1) <= settings.tolerance
    extents = np.column_stack([along.min(axis=1), along.max(axis=1)])
    return _Passed(points, directions, radii, rms, usable[off.argmin(axis=1)], extents)[good]


def _best(found: _Passed, most: int) -> _Passed:
    return found[np.argsort(found.rms, kind="stable")[:most]]


def _one_in_each_place(found: _Passed) -> NDArray[np.intp]:
    """Return the rows of the best of cylinders, given best first, that run along and through each other."""
    free = np.ones(len(found.rms), bool)
    chosen = []
    for row in range(len(free)):
        if not free[row]:
            continue
        chosen.append(row)
        rest = row + 1 + np.flatnonzero(free[row + 1 :])
        ends = found.points[rest, None] + found.extents[rest, :, None] * found.directions[rest, None] - found.points[row]
        along = ends @ found.directions[row]
        across = np.linalg.norm(ends - along[:, :, None] * found.directions[row], axis=2).min(axis=1)
        low, high = found.extents[row]
        taken = (across < found.radii[row]) & (along.max(axis=1) > low) & (along.min(axis=1) < high)
        taken &= np.abs(found.directions[rest] @ found.directions[row]) > PARALLEL
        free[rest[taken]] = False
    return np.array(chosen, dtype=np.intp)


def _nothing() -> _Passed:
    return _Passed(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(0, np.intp), np.zeros((0, 2)))
