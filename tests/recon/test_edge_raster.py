# SPDX-License-Identifier: LGPL-2.1-or-later
"""The raster of edge directions answers as a search along normals does."""

import numpy as np

from pipeworkbench.recon.edge_raster import bin_of, raster_of
from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.match import match


def disc():
    v, u = np.mgrid[:200, :240].astype(float)
    return np.clip(60 + 120 / (1 + np.exp((np.hypot(u - 120, v - 100) - 60) / 0.7)), 0, 255).astype(np.uint8)


def test_edges_are_found_near_their_pixels_with_their_direction_only():
    edges = detect_edges(disc())
    raster = raster_of(edges, 2)
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    outward = np.column_stack([np.cos(angle), np.sin(angle)])
    for off, expected in ((0.0, True), (1.0, True), (-1.0, True), (8.0, False), (-8.0, False)):
        at = np.array([120.0, 100.0]) + (60 + off) * outward
        near = raster.near(*at.astype(np.float32).T)
        # the disc is bright: normals point inwards
        assert (near >> bin_of(angle + np.pi) & 1 > 0).all() == expected
        assert (near >> bin_of(angle) & 1 > 0).mean() == 0
        assert (near >> bin_of(angle + np.pi / 2) & 1 > 0).mean() == 0
        assert match(edges, at, outward, 2.0).found.all() == expected


def test_outside_the_image_and_at_unknown_places_there_is_nothing():
    raster = raster_of(detect_edges(disc()), 2)
    u = np.array([-3.0, 500.0, np.nan, 120.0, 1e9], np.float32)
    v = np.array([40.0, 40.0, 40.0, -900.0, np.nan], np.float32)
    assert not raster.near(u, v).any()
