# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which places of the components' contours are observed in each image, chosen once and for all iterations."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings
from pipeworkbench.recon.bodies import Bodies
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.contour import Contour, CurveSamples, contour_of_shapes, curves_of
from pipeworkbench.recon.shapes import Shapes
from pipeworkbench.recon.vectors import dot

COARSE = 33  # points per curve with which its length in the image is measured
AXIS_POINTS = 9  # of a component, with which it is decided whether an image shows it
STRIDE = 3  # samples of which one is looked at whether it is seen, where nothing changes
MARGIN_PX = 200.0  # around an image: a component's axis may leave it before its contours do
LEAST_SAMPLES = 6  # along a contour
RESOLUTION_PX = 3.0  # edges nearer than this are one: about twice the detector's smoothing
LATERAL_PX = 2.0  # half of the distance of samples
BENT = float(np.cos(np.radians(20)))  # between neighbouring samples
ALIKE = float(np.cos(np.radians(20)))  # directions of edges that are taken for each other
TINY = 1e-9
CIRCLES = ("face", "back")  # contours that are closed, of those that are observed
# of flanges what no standard fixes, or what sits between two faces, measures nothing
NOT_OBSERVED = ("neck", "hub end", "raised face")


@dataclass(frozen=True, eq=False)
class Samples:
    """The samples of one image, n in number, in g groups: each a contour of a component.

    wanted (c,) says which components it sees; curve, parameter, owner (n,) where the samples are; group (n,) ascends;
    group_owner (g,); group_part (g,) the contours' names; group_curve (g,) their numbers among curves of the component;
    pattern (n, 2): how errors change along a contour: from -1 to 1 along lines and bends (and 0), with cosine and sine around circles;
    circle (g,) tells these apart; spacing (g,) px between samples.
    """

    wanted: NDArray[np.bool_]
    curve: NDArray[np.intp]
    parameter: Array
    owner: NDArray[np.intp]
    group: NDArray[np.intp]
    group_owner: NDArray[np.intp]
    group_part: NDArray[np.str_]
    group_curve: NDArray[np.intp]
    pattern: Array
    circle: NDArray[np.bool_]
    spacing: Array

    def __len__(self) -> int:
        return len(self.curve)

    @functools.cached_property
    def count(self) -> NDArray[np.intp]:
        """The number of samples (g,) of each group."""
        return np.bincount(self.group, minlength=len(self.group_owner))

    def thinned(self, step: int) -> Samples:
        """Return every so manieth sample of each contour."""
        rank = np.arange(len(self)) - (np.cumsum(self.count) - self.count)[self.group]
        kept = rank % step == 0
        changes = {name: getattr(self, name)[kept] for name in ("curve", "parameter", "owner", "group", "pattern")}
        return replace(self, **changes, spacing=step * self.spacing)

    def seen_by(self, camera: Camera, shapes: Shapes) -> CurveSamples:
        """Return what the camera sees of the samples on the shapes as they are now."""
        return curves_of(shapes.of(self.wanted), camera.projection_centre, steady=True).seen_by(camera, self.curve, self.parameter)


def samples_of(camera: Camera, bodies: Bodies, shapes: Shapes, settings: AdjustmentSettings) -> Samples:
    """Return the samples of all contours that an image shows and nothing hides."""
    wanted = shown(camera, bodies)
    contour = contour_of_shapes(camera, shapes.of(wanted), settings.spacing, coarse=COARSE, steady=True, stride=STRIDE)
    contour = contour[contour.visible & ~_sharply_bent(contour)]
    contour = contour[~_beside_others(contour)]
    observed = ~np.isin(contour.names, NOT_OBSERVED) if contour.names else np.zeros(0, bool)
    contour = contour[observed[contour.curve] & ~_in_gaps(bodies, contour.component, contour.parameter)]
    curve = contour.curve
    count = np.bincount(curve, minlength=curve.max(initial=-1) + 1)
    # long contours are thinned evenly
    step = np.maximum(-(-count // settings.most_samples), 1)
    rank = np.arange(len(curve)) - (np.cumsum(count) - count)[curve]
    kept = (rank % step[curve] == 0) & (count[curve] // step[curve] >= LEAST_SAMPLES)
    kept |= _is_part_of_dish(contour)
    contour = contour[kept]
    whole = _whole(contour)
    order = np.argsort(whole, kind="stable")
    contour = contour[order]
    numbers, first, group = np.unique(whole[order], return_index=True, return_inverse=True)
    part = np.array(contour.names, dtype=str)[numbers] if len(numbers) else np.zeros(0, str)
    circle = np.isin(part, CIRCLES)
    return Samples(
        wanted,
        contour.curve,
        contour.parameter,
        contour.component,
        group,
        contour.component[first],
        part,
        numbers,
        _patterns(contour.parameter, group, circle),
        circle,
        settings.spacing * step[numbers],
    )


def _is_part_of_dish(contour: Contour) -> NDArray[np.bool_]:
    return np.array([name == "cap" for name in contour.names], bool)[contour.curve]


def _whole(contour: Contour) -> NDArray[np.intp]:
    """Return the numbers of the samples' curves (n,); a dish, which is modelled as cones, is one with that of its first."""
    whole = contour.curve.copy()
    dish = np.flatnonzero(_is_part_of_dish(contour))
    first = np.full(int(contour.component.max(initial=-1)) + 1, np.iinfo(np.intp).max)
    np.minimum.at(first, contour.component[dish], contour.curve[dish])
    whole[dish] = first[contour.component[dish]]
    return whole


def _patterns(parameter: Array, group: NDArray[np.intp], circle: NDArray[np.bool_]) -> Array:
    """Return how errors change along contours (n, 2), from end to end of what is seen of them."""
    count = len(circle)
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, group, parameter)
    np.maximum.at(high, group, parameter)
    along = 2 * (parameter - low[group]) / np.maximum(high - low, TINY)[group] - 1
    turn, closed = 2 * np.pi * parameter, circle[group]
    return np.column_stack([np.where(closed, np.cos(turn), along), np.where(closed, np.sin(turn), 0.0)])


def _sharply_bent(contour: Contour) -> NDArray[np.bool_]:
    """Return which samples (n,) lie where a contour turns within few pixels: near cusps, and where circles are seen from the side.

    Edges are not found well there, and what the contour does is far from linear.
    """
    bent = np.zeros(len(contour), bool)
    turned = dot(contour.normal[1:], contour.normal[:-1]) < BENT
    turned &= contour.curve[1:] == contour.curve[:-1]
    bent[1:] |= turned
    bent[:-1] |= turned
    return bent


def _beside_others(contour: Contour) -> NDArray[np.bool_]:
    """Return which samples (n,) have another contour so near beside them that the image shows one edge for both."""
    beside = np.zeros(len(contour), bool)
    if len(contour):
        pairs = cKDTree(contour.position).query_pairs(float(np.hypot(RESOLUTION_PX, LATERAL_PX)), output_type="ndarray")
        pairs = pairs[contour.curve[pairs[:, 0]] != contour.curve[pairs[:, 1]]]
        normal, offset = contour.normal[pairs[:, 0]], np.diff(contour.position[pairs], axis=1)[:, 0]
        apart = np.abs(dot(offset, normal))
        aside = np.abs(offset[:, 0] * normal[:, 1] - offset[:, 1] * normal[:, 0])
        alike = np.abs(dot(normal, contour.normal[pairs[:, 1]])) > ALIKE
        beside[pairs[(apart <= RESOLUTION_PX) & (aside <= LATERAL_PX) & alike].ravel()] = True
    return beside


def shown(camera: Camera, bodies: Bodies) -> NDArray[np.bool_]:
    """Return which components (c,) an image may show: some point of their axes lies in it or near it."""
    first, last = bodies.first_and_last()
    place = np.linspace(0, 1, AXIS_POINTS)[:, None]
    pixels = camera.project((first[:, None] + place * (last - first)[:, None]).reshape(-1, 3))
    return np.asarray(camera.sees(pixels, -MARGIN_PX).reshape(len(bodies), AXIS_POINTS).any(axis=1))


def _in_gaps(bodies: Bodies, owner: NDArray[np.intp], parameter: Array) -> NDArray[np.bool_]:
    """Return which samples (n,) lie where a pipe was bridged: no image shows its edges there."""
    bridged = np.zeros(len(owner), bool)
    for row, component in enumerate(bodies.components):
        if isinstance(component, Pipe) and component.gaps:
            ours = np.flatnonzero(owner == row)
            at = parameter[ours] * component.length
            for first, last in component.gaps:
                bridged[ours] |= (at > first) & (at < last)
    return bridged
