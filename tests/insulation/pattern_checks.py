# SPDX-License-Identifier: LGPL-2.1-or-later
"""What every pattern must be, checked without the code that made it; coverings to try."""

import numpy as np

from pipeworkbench.solids.coverings import Layer, Sheet
from pipeworkbench.solids.frames import IDENTITY

SHEET = Sheet("aluminium", 0.8)
FITTED = 0.05  # mm by which two fitted curves may differ


def common(name="P1", thickness=50.0, sheet=SHEET, **more):
    """The arguments all coverings share."""
    return {"id": name, "component": name, "frame": IDENTITY, "layers": (Layer("wool", thickness),), "sheet": sheet, **more}


def crossings(points, others=None):
    """Return how often closed polygons cross; of one polygon sides that are not neighbours, touching included."""
    itself = others is None
    others = points if itself else others
    a, b = np.roll(points, -1, axis=0) - points, np.roll(others, -1, axis=0) - others
    gap = others[None] - points[:, None]

    def cross(u, v):
        return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]

    with np.errstate(divide="ignore", invalid="ignore"):
        s = cross(gap, b[None]) / cross(a[:, None], b[None])
        t = cross(gap, a[:, None]) / cross(a[:, None], b[None])
        hit = (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    if itself:
        n = np.arange(len(points))
        apart = np.minimum(abs(n[:, None] - n), len(points) - abs(n[:, None] - n))
        hit &= apart > 1
    return int(hit.sum())


def winding(points, polygon):
    """Return how often a closed polygon winds around points (n, 2)."""
    to = polygon[None] - points[:, None]
    following = np.roll(to, -1, axis=1)
    turn = np.arctan2(to[..., 0] * following[..., 1] - to[..., 1] * following[..., 0], np.sum(to * following, axis=-1))
    return np.rint(turn.sum(axis=1) / (2 * np.pi)).astype(int)


def text_corners(text):
    """Return the corners (4, 2) of a text whose letters are as wide as they are tall."""
    angle = np.radians(text.angle_deg)
    along, up = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    width = len(text.text) * text.height
    return np.array([np.array(text.position) + u * along + v * up for u in (0, width) for v in (0, text.height)])


def check(pattern):
    """Assert what holds for every pattern."""
    border = pattern.outline.sampled(0.02)
    assert pattern.outline.closed
    assert pattern.outline.area > 0
    assert crossings(border) == 0
    holes = [hole.sampled(0.02) for hole in pattern.holes]
    for k, hole in enumerate(holes):
        assert pattern.holes[k].closed
        assert (winding(hole, border) == 1).all()
        assert crossings(hole) == 0
        for other in holes[:k]:
            assert crossings(hole, other) == 0
            assert not winding(hole[:1], other).any()
            assert not winding(other[:1], hole).any()
    for text in pattern.texts:
        corners = text_corners(text)
        assert (winding(corners, border) == 1).all()
        assert not any(winding(corners, hole).any() for hole in holes)
    left, bottom, right, top = pattern.outline.bounds
    for _, mark in pattern.marks:
        low_x, low_y, high_x, high_y = mark.bounds
        assert left - FITTED <= low_x
        assert bottom - FITTED <= low_y
        assert high_x <= right + FITTED
        assert high_y <= top + FITTED
    assert pattern.texts[0].text.startswith(pattern.id)
    assert 0 < pattern.net_area


def check_all(patterns):
    """Check every pattern of a covering and that their ids differ."""
    assert len({pattern.id for pattern in patterns}) == len(patterns)
    for pattern in patterns:
        check(pattern)
    return patterns


def marks(pattern, layer):
    """Return a pattern's marks of one layer."""
    return [path for name, path in pattern.marks if name == layer]


def distances(points, path):
    """Return the distances (n,) of points from a path."""
    corners = path.sampled(1e-4)
    return from_sides(points, np.vstack([corners, corners[:1]]) if path.closed else corners)


def from_sides(points, corners):
    """Return the distances (n,) of points from straight lines from corner to corner, in a plane or in space."""
    from scipy.spatial import cKDTree

    along = np.diff(corners, axis=0)
    # in pieces so short that the nearest side is one of those with the nearest middles
    pieces = np.maximum(np.ceil(np.linalg.norm(along, axis=1) / 0.5), 6).astype(int)
    share = np.concatenate([np.arange(n) / n for n in pieces])
    index = np.repeat(np.arange(len(pieces)), pieces)
    middles = corners[index] + (share + 0.5 / pieces[index])[:, None] * along[index]
    near = index[cKDTree(middles).query(points, k=6)[1]]
    gap = points[:, None] - corners[near]
    part = np.clip(np.sum(gap * along[near], axis=-1) / np.sum(along[near] ** 2, axis=-1), 0, 1)
    return np.linalg.norm(gap - part[..., None] * along[near], axis=-1).min(axis=1)
