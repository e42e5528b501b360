# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looking for flanges without a click: edges that other pipes explain are left out, rims near each other belong together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.cylinder import Cylinders, outlines
from pipeworkbench.recon.ends import segments_of
from pipeworkbench.recon.flange_search import Rim
from pipeworkbench.recon.flange_settings import FlangeSettings
from pipeworkbench.recon.groups import groups_of
from pipeworkbench.recon.match import edges_along_normals
from pipeworkbench.recon.views import View

EXPLAINED_PX = 2.5  # an edge nearer to a pipe's outline is the pipe's
SAMPLES = 400  # along a pipe's outline


def without_edges_of(views: Sequence[View], pipes: Sequence[Pipe]) -> tuple[View, ...]:
    """Return views whose edge maps do not answer for the edges of pipes: a pipe that crosses looks like a rim's two edges."""
    if not pipes:
        return tuple(views)
    start, end = segments_of(pipes)
    length = np.linalg.norm(end - start, axis=1)
    cylinders = Cylinders(start, (end - start) / length[:, None], np.array([pipe.outer_diameter / 2 for pipe in pipes]))
    along = length[:, None] * np.linspace(0, 1, SAMPLES)
    made = []
    for view in views:
        position, normal = outlines(view.camera, cylinders, along)
        # between samples the outline is straight: a lattice fine enough for every edge point
        finer = np.concatenate([position + (np.roll(position, -1, axis=2) - position) * part for part in (0.0, 0.25, 0.5, 0.75)], axis=2)[:, :, :-1]
        normals = np.concatenate([normal] * 4, axis=2)[:, :, :-1]
        _, edge, _ = edges_along_normals(view.edges, finer.reshape(-1, 2), normals.reshape(-1, 2), EXPLAINED_PX)
        row = np.arange(-1, len(view.edges), dtype=np.int32)
        row[edge + 1] = -1
        made.append(replace(view, edges=replace(view.edges, index=row[view.edges.index + 1])))
    return tuple(made)


def clusters_of(rims: Sequence[Rim], settings: FlangeSettings) -> list[list[Rim]]:
    """Return rims that stand out in groups that lie near each other along the axis, the likeliest rims and groups first."""
    clear = sorted((rim for rim in rims if rim.score >= settings.least_rim), key=lambda rim: -rim.score)
    return groups_of(clear, lambda best, rim: abs(best.face - rim.face) < settings.cluster)
