# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation through few nodes: exact for polynomials of their degree."""

import numpy as np
import pytest

from pipeworkbench.recon.interpolation import NODES, interpolation


def test_polynomials_of_the_nodes_degree_are_reproduced():
    coefficients, places = np.array([0.3, -1.2, 0.5, 2.0, -0.7]), np.linspace(-1, 1, 33)
    assert np.polyval(coefficients, NODES) @ interpolation(NODES, places) == pytest.approx(np.polyval(coefficients, places), abs=1e-12)


def test_values_at_the_nodes_stay():
    assert interpolation(NODES, NODES) == pytest.approx(np.eye(len(NODES)), abs=1e-12)
