# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth curves through few nodes: what is projected at some places along a straight line is known at all places between.

A lens's distortion along a line is all but a polynomial of low degree. A few projected nodes and one
product of matrices for all lines cost a fraction of projecting each sample.
"""

from __future__ import annotations

import numpy as np

from pipeworkbench.recon.inversion import Array

# extremes of the fourth Chebyshev polynomial, where no place between them is far from exact: below 0.01 px along a clicked part
NODES = -np.cos(np.pi * np.arange(5) / 4)


def interpolation(nodes: Array, places: Array) -> Array:
    """Return weights (m, n): values (..., m) at nodes (m,) times these are those, at places (n,), of the polynomial through them."""
    powers_at_nodes, powers_at_places = (np.vander(x, len(nodes), increasing=True).T for x in (nodes, places))
    return np.asarray(np.linalg.solve(powers_at_nodes, powers_at_places))
