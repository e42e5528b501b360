# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight edges: segments from OpenCV's detectors, fitted to the subpixel edge points that support them.

The detectors say where a line is; how exactly is decided by the edge points alone. All segments are
fitted together, in arrays.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, Interior
from pipeworkbench.recon.edges import EdgeMap, as_grey
from pipeworkbench.recon.match import edges_along_normals

GROWTHS = 3  # times that segments may grow
MOST_SHARED = 0.5  # of a line's points may be a longer line's, else it is the same
CORRELATION = float(2 * np.sqrt(np.pi))  # sum of the autocorrelation of noise after Gaussian smoothing, in standard deviations


@dataclass(frozen=True)
class LineSettings:
    """Tunables of line detection; lengths in px.

    ``least_length`` of a segment; ``least_support`` the part of it that edge points must cover;
    ``search_range`` to each side of the detected segment, narrowed to ``fit_range`` for the last fits;
    ``largest_angle_deg`` between a segment's and a point's normal; a segment is grown by up to ``growth``
    of its length to each side as long as no gap between points exceeds ``largest_gap``; the Hough transform's:
    ``hough_votes``, ``hough_gap`` and the step ``hough_angle_deg``.
    """

    least_length: float = 20.0
    least_support: float = 0.5
    search_range: float = 3.0
    fit_range: float = 0.75
    largest_angle_deg: float = 15.0
    growth: float = 0.5
    largest_gap: float = 5.0
    hough_votes: int = 30
    hough_gap: float = 4.0
    hough_angle_deg: float = 0.5


# for pipes' edges, which brackets, stains and shade interrupt
INTERRUPTED = LineSettings(least_length=25.0, least_support=0.35, largest_gap=12.0, hough_votes=25, hough_gap=12.0)


@dataclass(frozen=True, eq=False)
class LineSegments:
    """Straight segments, k in number, the longest first.

    Attributes
    ----------
    ends : (k, 2, 2) array
        Where the support begins and ends, on the fitted line; pixels.
    direction : (k, 2) array
        Unit vectors from the first to the second end; the brighter side is on their right as seen in
        the image (v down).
    normal : (k, 2) array
        Unit vectors towards the brighter side.
    polarity : (k,) array
        How unanimous the points are about the brighter side: 1 all, 0 as many to either.
    length : (k,) array
        Distance of the ends.
    centre : (k, 2) array
        The weighted mean of the points, which the line passes through.
    covariance : (k, 2, 2) array
        Of the line's offset along ``normal`` at its centre (px) and of its direction (rad).
    residual_rms : (k,) array
        Root mean square distance of the points from the line, px.
    support : (k,) array of int
        Number of edge points.
    segment, edge : (m,) arrays of int
        Which points support which segment: rows of this object and of the edge map.
    """

    ends: Array
    direction: Array
    normal: Array
    polarity: Array
    length: Array
    centre: Array
    covariance: Array
    residual_rms: Array
    support: NDArray[np.intp]
    segment: NDArray[np.intp]
    edge: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.length)


def detect_lines(
    image: NDArray[Any],
    edges: EdgeMap,
    method: Literal["lsd", "hough"] = "lsd",
    interior: Interior | None = None,
    settings: LineSettings | None = None,
) -> LineSegments:
    """Find straight edges.

    Parameters
    ----------
    image : (height, width) or (height, width, 3 or 4) array of uint8 or uint16
    edges : EdgeMap
        Of the same image.
    method : "lsd" or "hough"
        OpenCV's line segment detector (von Gioi et al., IPOL 2012) on the image, or its progressive
        probabilistic Hough transform (Matas et al., CVIU 78(1), 2000) on the edge points' pixels.
    interior : Interior, optional
        With it the lines are fitted after the distortion is taken off, and everything that is returned is in
        pixels of an image without distortion (same principal point and scale on the axis).
    settings : LineSettings, optional

    Raises
    ------
    InputError
        Where the image is none, is not the edges', or the method is unknown.
    """
    settings = settings or LineSettings()
    grey = as_grey(image)
    if grey.shape != edges.index.shape:
        raise InputError("the image", "", f"is {grey.shape}, its edges' is {edges.index.shape}", "find the edges of this image")
    if method == "lsd":
        ends = _segment_detector(grey)
    elif method == "hough":
        ends = _hough_transform(edges, settings)
    else:
        raise InputError("the line detector", "method", f"{method!r} is unknown", 'use "lsd" or "hough"')
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return fit_segments(edges, ends[length >= settings.least_length], interior, settings)


def hough_segments(edges: EdgeMap, interior: Interior | None = None, settings: LineSettings | None = None) -> LineSegments:
    """Find straight edges by the Hough transform, which needs no image but its edges; see :func:`detect_lines`."""
    settings = settings or LineSettings()
    return fit_segments(edges, _hough_transform(edges, settings), interior, settings)


def fit_segments(edges: EdgeMap, ends: Array, interior: Interior | None = None, settings: LineSettings | None = None) -> LineSegments:
    """Fit lines to the edge points near segments (k, 2, 2), in measured pixels; doubles and those without support fall away."""
    settings = settings or LineSettings()
    position, normal = edges.position, edges.normal
    if interior is not None:
        position, normal = without_distortion(position, normal, interior)
    for growth in range(GROWTHS):
        segment, edge = _supporting(edges, ends, settings)
        lines = fit_points(position, normal, edges, segment, edge, len(ends), settings)
        segment, edge = _unbroken(lines, position, settings)
        lines = fit_points(position, normal, edges, segment, edge, len(ends), settings)
        ends = _grown(lines, edges, ends, settings)
        if growth == 0:
            # detectors find most lines several times: the sooner doubles go, the less there is to fit
            ends = ends[(owned(lines.segment, lines.edge, lines.length)[1] >= MOST_SHARED * lines.support) & (lines.support > 2)]
    keep, own = owned(lines.segment, lines.edge, lines.length)
    good = (own >= settings.least_support * lines.length) & (own >= MOST_SHARED * lines.support) & (lines.length >= settings.least_length)
    segment, edge = lines.segment[keep], lines.edge[keep]
    kept = good[segment]
    lines = fit_points(position, normal, edges, segment[kept], edge[kept], len(ends), settings)
    return longest_first(lines, good & (lines.support > 2))


def _segment_detector(grey: NDArray[np.uint8] | NDArray[np.uint16]) -> Array:
    import cv2

    if grey.dtype == np.uint16:
        # the detector takes 8 bits: stretch what there is, its thresholds are of the gradient's direction
        low, high = float(grey.min()), float(grey.max())
        grey = np.asarray(cv2.convertScaleAbs(grey.astype(np.float32) - low, alpha=255 / max(high - low, 1)))
    found = cv2.createLineSegmentDetector(cv2.LSD_REFINE_STD).detect(grey)[0]
    return np.zeros((0, 2, 2)) if found is None else found.reshape(-1, 2, 2).astype(float)


def _hough_transform(edges: EdgeMap, settings: LineSettings) -> Array:
    import cv2

    picture = np.zeros(edges.index.shape, np.uint8)
    picture[edges.pixel[:, 1], edges.pixel[:, 0]] = 255
    found = cv2.HoughLinesP(
        picture, 1.0, np.radians(settings.hough_angle_deg), settings.hough_votes, minLineLength=settings.least_length, maxLineGap=settings.hough_gap
    )
    return np.zeros((0, 2, 2)) if found is None else np.asarray(found, float).reshape(-1, 2, 2)


def _supporting(edges: EdgeMap, ends: Array, settings: LineSettings) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return segments and edges (m,) that belong together, each pair once."""
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    count = np.ceil(length).astype(np.intp) + 1
    segment = np.repeat(np.arange(len(ends)), count)
    part = (np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)) / np.maximum(count - 1, 1)[segment]
    tangent = along / np.maximum(length, 1e-9)[:, None]
    samples = ends[segment, 0] + part[:, None] * along[segment]
    normals = np.column_stack([-tangent[:, 1], tangent[:, 0]])[segment]
    sample, edge, _ = edges_along_normals(edges, samples, normals, settings.search_range, np.radians(settings.largest_angle_deg))
    pairs = np.unique(segment[sample] * max(len(edges), 1) + edge)
    found = np.divmod(pairs, max(len(edges), 1))
    return found[0], found[1]


def owned(segment: NDArray[np.intp], edge: NDArray[np.intp], weight: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Let each point count for one segment only, the one of most weight that it supports.

    Parameters
    ----------
    segment, edge : (m,) arrays of int
        Which points support which segment.
    weight : (k,) array
        Of the segments.

    Returns
    -------
    keep : array of int
        Rows of the pairs (segment, edge) that count.
    count : (k,) array of int
        How many each segment has.
    """
    rank = np.argsort(np.argsort(-weight, kind="stable"))
    order = np.lexsort((rank[segment], edge))
    first = np.ones(len(order), bool)
    first[1:] = edge[order][1:] != edge[order][:-1]
    keep = order[first]
    return keep, np.bincount(segment[keep], minlength=len(weight))


def _unbroken(lines: LineSegments, position: Array, settings: LineSettings) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return of the supporting pairs (m,) those in the largest run of each segment without a gap."""
    along = np.einsum("ni,ni->n", position[lines.edge] - lines.centre[lines.segment], lines.direction[lines.segment])
    order = np.lexsort((along, lines.segment))
    segment, edge, along = lines.segment[order], lines.edge[order], along[order]
    if not len(segment):
        return segment, edge
    starts = np.ones(len(order), bool)
    starts[1:] = (segment[1:] != segment[:-1]) | (np.diff(along) > settings.largest_gap)
    run = np.cumsum(starts) - 1
    size, owner = np.bincount(run), segment[starts]
    largest = np.zeros(len(lines), np.intp)
    by_size = np.argsort(size, kind="stable")  # the largest is written last
    largest[owner[by_size]] = by_size
    kept = run == largest[segment]
    return segment[kept], edge[kept]


def _grown(lines: LineSegments, edges: EdgeMap, ends: Array, settings: LineSettings) -> Array:
    """Return the segments' measured ends (k, 2, 2) after the fit, moved apart to look for more points there."""
    grown = ends.copy()
    if len(lines.edge):
        # in measured pixels, whatever the lines were fitted in: the outermost points themselves
        along = np.einsum("ni,ni->n", edges.position[lines.edge], lines.direction[lines.segment])
        order = np.lexsort((along, lines.segment))
        segment = lines.segment[order]
        first = np.flatnonzero(np.concatenate([[True], segment[1:] != segment[:-1]]))
        last = np.concatenate([first[1:], [len(segment)]]) - 1
        low, high = edges.position[lines.edge[order[first]]], edges.position[lines.edge[order[last]]]
        reach = settings.growth * (high - low)
        grown[segment[first]] = np.stack([low - reach, high + reach], axis=1)
    return grown


def without_distortion(position: Array, normal: Array, interior: Interior) -> tuple[Array, Array]:
    """Return points and normals (n, 2) in pixels of an image without distortion."""
    scale, origin = interior.pixels_per_radian, interior.pixels(np.zeros((1, 2)))
    tip = 0.5 * normal
    ahead, behind = interior.ideal(position + tip), interior.ideal(position - tip)
    turned = ahead - behind
    return interior.ideal(position) * scale + origin, turned / np.linalg.norm(turned, axis=1, keepdims=True)


def fit_points(
    position: Array, normals: Array, edges: EdgeMap, segment: NDArray[np.intp], edge: NDArray[np.intp], count: int, settings: LineSettings
) -> LineSegments:
    """Fit all lines at once to the points of each, with weights from their standard deviations and against outliers."""

    def total(values: NDArray[Any]) -> Array:
        return np.bincount(segment, values, minlength=count).astype(float)

    points, normal = position[edge], normals[edge]
    weight = 1 / edges.sigma[edge] ** 2
    # double the angle: normals of either polarity agree
    cosine, sine = total(weight * (normal[:, 0] ** 2 - normal[:, 1] ** 2)), total(2 * weight * normal[:, 0] * normal[:, 1])
    angle = 0.5 * np.arctan2(sine, cosine)
    robust = np.ones(len(edge))
    with np.errstate(invalid="ignore", divide="ignore"):
        for reach in (settings.search_range, settings.search_range, 2 * settings.fit_range, settings.fit_range, settings.fit_range):
            w = weight * robust
            sums = total(w)
            centre = np.column_stack([total(w * points[:, 0]), total(w * points[:, 1])]) / sums[:, None]
            offset = points - centre[segment]
            uu, vv, uv = total(w * offset[:, 0] ** 2), total(w * offset[:, 1] ** 2), total(w * offset[:, 0] * offset[:, 1])
            # the principal axis; its normal at a right angle
            angle = 0.5 * np.arctan2(2 * uv, uu - vv)
            tangent = np.column_stack([np.cos(angle), np.sin(angle)])
            across = np.column_stack([-tangent[:, 1], tangent[:, 0]])
            distance = np.einsum("ni,ni->n", offset, across[segment])
            robust = np.where(np.abs(distance) < reach, (1 - (distance / reach) ** 2) ** 2, 0.0)
        inside = robust > 0
        bright = np.sign(total(inside * np.einsum("ni,ni->n", normal, across[segment])))
        bright = np.where(bright == 0, 1.0, bright)
        across, tangent = across * bright[:, None], tangent * bright[:, None]
        along = np.einsum("ni,ni->n", offset, tangent[segment])
        support = np.bincount(segment[inside], minlength=count)
        polarity = np.abs(total(inside * np.sign(np.einsum("ni,ni->n", normal, across[segment])))) / support
        rms = np.sqrt(total(inside * distance**2) / support)
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, segment[inside], along[inside])
        np.maximum.at(high, segment[inside], along[inside])
        length = np.where(support > 2, high - low, 0.0)
        # smoothing along the edge makes neighbours' errors alike: so many points count for one
        alike = CORRELATION * total(inside * edges.smoothing[edge]) / np.maximum(length, 1)
        # where the points scatter more than they should, that counts
        sigma0 = np.maximum(np.sqrt(total(w * distance**2) / np.maximum(support - 2, 1)), 1.0)
        covariance = np.zeros((count, 2, 2))
        covariance[:, 0, 0] = sigma0**2 * np.maximum(alike, 1) / sums
        covariance[:, 1, 1] = sigma0**2 * np.maximum(alike, 1) / total(w * along**2)
    extent = np.where(length[:, None] > 0, np.stack([low, high], axis=1), 0.0)
    ends = centre[:, None, :] + extent[:, :, None] * tangent[:, None, :]
    return LineSegments(ends, tangent, across, polarity, length, centre, covariance, rms, support, segment[inside], edge[inside])


def longest_first(lines: LineSegments, good: NDArray[np.bool_]) -> LineSegments:
    """Return those of lines (k) that are good (k,), the longest first."""
    rows = np.flatnonzero(good)
    rows = rows[np.argsort(-lines.length[rows], kind="stable")]
    new = np.full(len(lines), -1)
    new[rows] = np.arange(len(rows))
    kept = new[lines.segment] >= 0
    return LineSegments(
        lines.ends[rows],
        lines.direction[rows],
        lines.normal[rows],
        lines.polarity[rows],
        lines.length[rows],
        lines.centre[rows],
        lines.covariance[rows],
        lines.residual_rms[rows],
        lines.support[rows],
        new[lines.segment[kept]],
        lines.edge[kept],
    )
