# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders followed along their axes to where their edges end: a short piece of a pipe measures its diameter badly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.cylinder import Cylinders, outlines, spread
from pipeworkbench.recon.match import match
from pipeworkbench.recon.views import View

FURTHEST = 4.0  # times its own half length that a piece is followed beyond each end: its direction is not known better
SAMPLES = 48  # to each side
SEARCH_PX = 1.5
LEAST_HITS = 0.4  # part of the samples of both edges in all images; below it a stretch speaks against the pipe


def prolonged(views: Sequence[View], cylinders: Cylinders, extents: Array) -> Array:
    """Return extents (k, 2) as far as edges go on, at least as they are.

    Parameters
    ----------
    views : sequence of View
    cylinders : Cylinders
    extents : (k, 2) array
        From where to where, mm along the axes.
    """
    if not len(cylinders):
        return extents
    half = np.diff(extents, axis=1) / 2
    fractions = (np.arange(SAMPLES) + 0.5) / SAMPLES
    beyond = [spread(np.column_stack([end, end + sign * FURTHEST * half[:, 0]]), fractions) for end, sign in zip(extents.T, (-1, 1), strict=True)]
    along = np.concatenate(beyond, axis=1)
    hits, seen = np.zeros(along.shape), np.zeros(along.shape)
    for view in views:
        position, normal = outlines(view.camera, cylinders, along)
        found = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), SEARCH_PX).found
        hits += found.reshape(position.shape[:3]).sum(axis=1)
        seen += np.isfinite(position[..., 0]).sum(axis=1)
    gain = (hits / np.maximum(seen, 1) - LEAST_HITS).reshape(-1, 2, SAMPLES).cumsum(axis=2)
    # the end is where most speaks for the pipe: interruptions are outweighed by what follows
    best = np.where(gain.max(axis=2) > 0, gain.argmax(axis=2) + 1, 0) / SAMPLES
    return extents + best * FURTHEST * half * np.array([-1, 1])
