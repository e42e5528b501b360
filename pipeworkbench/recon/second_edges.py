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
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View


@dataclass(frozen=True)
class SecondEdgeSettings:
    """Tunables; ``search_range`` and the limits of the apparent ``width`` in px.

    ``samples`` along the edge; ``same_polarity`` is what an edge of the same polarity counts against one of the
    opposite (a pipe between a dark and a bright background has two alike); an image speaks for a
    diameter if at least ``least_hits`` of its samples find an edge, and at least ``least_views`` must; ``least_score``
    is the mean over the images, and ``kept`` of an edge's diameters go on. ``least_slenderness`` is length over
    diameter, ``least_length`` mm.
    """

    search_range: float = 3.0
    width: tuple[float, float] = (10.0, 1000.0)
    samples: int = 8
    same_polarity: float = 0.8
    least_hits: float = 0.35
    least_views: int = 2
    least_score: float = 0.25
    kept: int = 6
    least_slenderness: float = 1.0
    least_length: float = 40.0


def cylinders_from_edges(
    views: Sequence[View], lines: EdgeLines, diameters: Array, settings: SecondEdgeSettings | None = None
) -> tuple[Cylinders, Array, Array]:
    """Return cylinders that have both edges in the images.

    Parameters
    ----------
    views : sequence of View
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
    with ThreadPoolExecutor(2) as threads:
        hits, known = (np.array(x) for x in zip(*threads.map(lambda view: _hits(view, lines, diameters, settings), views), strict=True))
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


def _hits(view: View, lines: EdgeLines, diameters: Array, settings: SecondEdgeSettings) -> tuple[Array, Array]:
    """Return which part (lines, 2, d) of samples has a second edge in a view, on the brighter side and the other, and whether it is seen."""
    samples = settings.samples
    position, normal, scale = samples_in(view.camera, lines.ends, lines.bright, samples)
    in_image = np.isfinite(position[:, 0]).reshape(-1, samples)
    middle = np.where(in_image, scale.reshape(-1, samples), 0).sum(axis=1) / np.maximum(in_image.sum(axis=1), 1)
    hits, known = np.zeros((len(lines), 2, len(diameters))), np.zeros((len(lines), 2, len(diameters)))
    first = np.arange(samples)
    for size, diameter in enumerate(diameters):
        width = diameter * middle
        rows = np.flatnonzero((width > settings.width[0]) & (width < settings.width[1]))
        if not len(rows):
            continue
        which = (rows[:, None] * samples + first).ravel()
        for side, sign in enumerate((1.0, -1.0)):
            there = position[which] + sign * diameter * scale[which, None] * normal[which]
            inside = view.camera.sees(there).reshape(-1, samples)
            found = match(view.edges, there, normal[which], settings.search_range)
            opposite = np.einsum("ni,ni->n", view.edges.normal[found.edge], normal[which]) < 0
            value = np.where(found.found, np.where(opposite, 1.0, settings.same_polarity), 0.0).reshape(-1, samples)
            seen = inside.sum(axis=1)
            enough = seen >= samples / 2
            hits[rows, side, size] = np.where(enough, value.sum(axis=1) / np.maximum(seen, 1), 0.0)
            known[rows, side, size] = enough
    return hits, known
