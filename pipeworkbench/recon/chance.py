# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges by chance: how dense they are beside contours, and how much likelier than by chance a contour's own edges are.

What has nothing to do with a contour meets its normals as a Poisson process, whose density shows in windows beside it.
A contour's own edge is where the contour is but for a Laplace scatter; which part of its samples has one is not known.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array

MOST_SHARE = 0.98  # of samples with an edge beside them; a logarithm's end


def densities_beside(sample: NDArray[np.intp], distance: Array, windows: Array, visible: NDArray[np.intp], count: int, least: float) -> Array:
    """Return how many edges per px there are by chance beside each of many contours (k,).

    Parameters
    ----------
    sample, distance : (m,) arrays
        As :func:`.match.edges_along_normals` gives them for the samples of all contours, px.
    windows : (w, 2) array
        From where to where along the normals other edges are counted, px.
    visible : (k,) array
        How many samples of each contour are in view.
    count : int
        Samples of a contour.
    least : float
        As for :func:`density_of`.
    """
    hit = np.zeros((len(visible) * count, len(windows)), bool)
    for column, (low, high) in enumerate(windows):
        hit[sample[(distance > low) & (distance < high)], column] = True
    share = hit.reshape(len(visible), count * len(windows)).sum(axis=1) / (np.maximum(visible, 1) * len(windows))
    return density_of(share, float(np.mean(windows[:, 1] - windows[:, 0])), least)


def hits_beside(sample: NDArray[np.intp], distance: Array, nearest: float, count: int) -> NDArray[np.bool_]:
    """Return which of ``count`` samples have an edge further off than ``nearest`` px, before and behind them (count, 2)."""
    beside = np.abs(distance) > nearest
    hit = np.zeros((count, 2), bool)
    hit[sample[beside], (distance[beside] > 0).astype(int)] = True
    return hit


def density_of(share: Array | float, width: float, least: float) -> Array:
    """Return how many edges per px there are by chance, at ``least`` so many.

    Parameters
    ----------
    share : array or float
        Part of the windows with an edge in them: in a Poisson process 1 - exp(-density width).
    width : float
        Of a window, px.
    least : float
        An empty neighbourhood is not known to stay empty.
    """
    return np.asarray(np.maximum(-np.log(1 - np.minimum(share, MOST_SHARE)) / width, least))


def own_over_chance(off: Array, density: Array | float, scatter: float) -> Array:
    """Return how much likelier it is that the nearest edge of a sample is its own than that it is there by chance.

    Parameters
    ----------
    off : array
        How far off the edge is, px, NaN where there is none (the quotient is 0 there).
    density : array or float
        Edges per px by chance.
    scatter : float
        Of a contour's own edges, px.
    """
    own = np.exp(-off / scatter) / (2 * scatter)
    # the distance of the nearest of a Poisson process, to either side
    return np.nan_to_num(own / (density * np.exp(-2 * density * off)))


def over_rates(logarithms: Sequence[NDArray[Any]]) -> Array:
    """Return the logarithm of the mean of ratios over hit rates, each as likely, from the ratios' logarithms at each rate."""
    return np.asarray(np.logaddexp.reduce(logarithms, axis=0) - np.log(len(logarithms)))
