# SPDX-License-Identifier: LGPL-2.1-or-later
"""From one edge of a pipe to the pipe: every standard diameter to either side, asked for its second edge.

An edge in space and a radius make a cylinder. Its other edge lies a diameter further across the line of
sight, in all images alike; where images have edges there, the cylinder is worth a closer look.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.edge_lines import EdgeLines, samples_in
from pipeworkbench.recon.edge_raster import EdgeRaster, bin_of
from pipeworkbench.recon.threads import thread_count
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class SecondEdgeSettings:
    """Tunables; the limits of the apparent ``width`` in px.

    ``samples`` along the edge; ``same_polarity`` is what an edge of the same polarity counts against one of the
    opposite (a pipe between a dark and a bright background has two alike); an image speaks for a
    diameter if at least ``least_hits`` of its samples find an edge, and at least ``least_views`` must; ``least_score``
    is the mean over the images, and ``kept`` of an edge's diameters go on. ``least_slenderness`` is length over
    diameter, ``least_length`` mm.
    """

    width: tuple[float, float] = (10.0, 1000.0)
    samples: int = 8
    same_polarity: float = 0.8
    least_hits: float = 0.35
    least_views: int = 2
    least_score: float = 0.25
    kept: int = 10
    least_slenderness: float = 1.0
    least_length: float = 40.0


def cylinders_from_edges(
    views: Sequence[View], rasters: Sequence[EdgeRaster], lines: EdgeLines, diameters: Array, settings: SecondEdgeSettings | None = None
) -> tuple[Cylinders, Array, Array]:
    """Return cylinders that have both edges in the images.

    Parameters
    ----------
    views : sequence of View
    rasters : sequence of EdgeRaster
        Of their edges; how far the second edge is searched is their reach.
    lines : EdgeLines
    diameters : (d,) array
        Outside diameters to try, mm.
    settings : SecondEdgeSettings, optional

    Returns
    -------
    cylinders : Cylinders
    extents : (k, 2) array
        What the edge spans, mm along the axes from the cylinders' points.
    score : (k,) array
        Mean part of the samples, over the images, that find the second edge.
    """
    settings = settings or SecondEdgeSettings()
    with ThreadPoolExecutor(thread_count(2)) as threads:
        seen = threads.map(lambda view, raster: _hits(view, raster, lines, diameters, settings), views, rasters)
        hits, known = (np.array(x) for x in zip(*seen, strict=True))
    enough = (hits >= settings.least_hits).sum(axis=0) >= settings.least_views
    score = np.where(enough, hits.sum(axis=0) / np.maximum(known.sum(axis=0), settings.least_views), 0.0)
    score = score.reshape(len(lines), 2 * len(diameters))
    best = np.argsort(-score, axis=1)[:, : settings.kept]
    row = np.repeat(np.arange(len(lines)), best.shape[1])
    choice = best.ravel()
    side, size = np.divmod(choice, len(diameters))
    length = np.linalg.norm(lines.ends[:, 1] - lines.ends[:, 0], axis=1)
    good = score[row, choice] >= settings.least_score
    good &= length[row] >= np.maximum(settings.least_length, settings.least_slenderness * diameters[size])
    row, choice, side, radius = row[good], choice[good], side[good], diameters[size[good]] / 2
    offset = np.where(side == 0, radius, -radius)[:, None] * lines.bright[row]
    half = length[row] / 2
    return Cylinders(lines.ends[row].mean(axis=1) + offset, lines.direction[row], radius), np.column_stack([-half, half]), score[row, choice]


def _hits(view: View, raster: EdgeRaster, lines: EdgeLines, diameters: Array, settings: SecondEdgeSettings) -> tuple[Array, Array]:
    """Return which part (lines, 2, d) of samples has a second edge in a view, on the brighter side and the other, and whether it is seen."""
    samples = settings.samples
    position, normal, scale = samples_in(view.camera, lines.ends, lines.bright, samples)
    in_image = np.isfinite(position[:, 0]).reshape(-1, samples)
    middle = np.where(in_image, scale.reshape(-1, samples), 0).sum(axis=1) / np.maximum(in_image.sum(axis=1), 1)
    length = np.linalg.norm(lines.ends[:, 1] - lines.ends[:, 0], axis=1)
    u, v = (position.astype(np.float32).reshape(-1, samples, 2)[:, None, :, i] for i in (0, 1))
    along_u, along_v = ((normal[:, i] * scale).astype(np.float32).reshape(-1, 1, samples) for i in (0, 1))
    angle = np.arctan2(normal[:, 1], normal[:, 0])
    same, opposite = (bin_of(np.nan_to_num(a)).reshape(-1, 1, samples) for a in (angle, angle + np.pi))
    sides = np.array([1.0, -1.0], np.float32)[:, None]
    hits, known = np.zeros((len(lines), 2, len(diameters))), np.zeros((len(lines), 2, len(diameters)))
    for size, diameter in enumerate(diameters):
        width = diameter * middle
        rows = np.flatnonzero((width > settings.width[0]) & (width < settings.width[1]) & (length >= settings.least_slenderness * diameter))
        shift = np.float32(diameter) * sides
        there_u, there_v = u[rows] + shift * along_u[rows], v[rows] + shift * along_v[rows]
        seen = view.camera.sees(np.stack([there_u, there_v], axis=-1)).sum(axis=2)
        near = raster.near(there_u, there_v)
        found = [(near >> bins[rows] & 1).astype(bool) for bins in (opposite, same)]
        value = np.select(found, [np.float32(1.0), np.float32(settings.same_polarity)], np.float32(0.0))
        enough = seen >= samples / 2
        hits[rows, :, size] = np.where(enough, value.sum(axis=2) / np.maximum(seen, 1), 0.0)
        known[rows, :, size] = enough
    return hits, known
