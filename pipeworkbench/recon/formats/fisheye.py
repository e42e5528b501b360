# SPDX-License-Identifier: LGPL-2.1-or-later
"""Radial maps that fisheye models share, as factors on ideal coordinates."""

from __future__ import annotations

import math

import numpy as np

from pipeworkbench.recon.camera import Array

NEAR_THE_AXIS = 1e-8  # below this radius the factor is its limit


def equidistant_factor(ideal: Array) -> Array:
    """Return theta / r (n, 1) for ideal coordinates (n, 2): the angle from the axis as radius."""
    radius = np.linalg.norm(ideal, axis=1, keepdims=True)
    return np.where(radius > NEAR_THE_AXIS, np.arctan(radius) / np.maximum(radius, NEAR_THE_AXIS), 1.0)


def kannala_brandt(ideal: Array, k1: float, k2: float, k3: float, k4: float) -> Array:
    """Return distorted coordinates (n, 2): radius theta (1 + k1 theta^2 + ... + k4 theta^8)."""
    turned = ideal * equidistant_factor(ideal)
    t2 = (turned * turned).sum(axis=1, keepdims=True)
    return turned * (1 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))))


def field_of_view(ideal: Array, omega: float) -> Array:
    """Return distorted coordinates (n, 2): radius atan(2 r tan(omega / 2)) / omega (Devernay and Faugeras 2001)."""
    if abs(omega) < NEAR_THE_AXIS:
        return ideal
    radius = np.linalg.norm(ideal, axis=1, keepdims=True)
    slope = 2 * math.tan(omega / 2)
    factor = np.arctan(slope * radius) / (omega * np.maximum(radius, NEAR_THE_AXIS))
    return ideal * np.where(radius > NEAR_THE_AXIS, factor, slope / omega)
