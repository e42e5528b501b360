# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of curved pipework: the union of the silhouettes of many balls along its axis, without any code of the product's contours."""

import numpy as np
from scipy.special import ndtr
from synthetic import BLUR_PX, BRIGHT, DARK, FOCAL_PX, HEIGHT, NOISE, WIDTH, _local_rays, cameras

from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.views import view_of

STEP_MM = 5.0  # between balls: the scallops between them are far below a pixel
CENTRE = np.array([0.0, 3000.0, 150.0])


def straight(start, end, diameter):
    """Return balls (m, 4), centres and radii in mm, along a line."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    count = int(np.ceil(np.linalg.norm(end - start) / STEP_MM)) + 1
    return np.column_stack([start + np.linspace(0, 1, count)[:, None] * (end - start), np.full(count, diameter / 2)])


def cone(start, end, diameter, end_diameter):
    """Return balls along an axis whose diameter changes."""
    balls = straight(start, end, diameter)
    balls[:, 3] = np.linspace(diameter, end_diameter, len(balls)) / 2
    return balls


def bend(corner, come, go, radius, diameter):
    """Return balls along an arc that touches two directions (3,), and its ends."""
    come, go, corner = (np.asarray(v, float) for v in (come, go, corner))
    angle = np.arccos(come @ go)
    length = radius * np.tan(angle / 2)
    inwards = (go - np.cos(angle) * come) / np.sin(angle)
    turn = np.linspace(0, angle, int(np.ceil(radius * angle / STEP_MM)) + 1)[:, None]
    points = corner - length * come + radius * (np.sin(turn) * come + (1 - np.cos(turn)) * inwards)
    return np.column_stack([points, np.full(len(points), diameter / 2)]), points[0], points[-1]


def photograph(camera, balls, seed=0):
    """Return an 8-bit picture of balls: a pixel's brightness is the mean over four rays of the blurred silhouette."""
    light = np.zeros((4, HEIGHT, WIDTH))
    rays = [local.reshape(HEIGHT, WIDTH, 3) for local in _local_rays()]
    for ball in balls:
        offset = ball[:3] - camera.projection_centre
        distance = np.linalg.norm(offset)
        ((u, v),) = camera.project(ball[None, :3])
        half = int(ball[3] * FOCAL_PX / distance * 1.2 + 8)
        if not (np.isfinite(u) and -half < u < WIDTH + half and -half < v < HEIGHT + half):
            continue
        us = np.arange(max(int(u) - half, 0), min(int(u) + half + 1, WIDTH))
        vs = np.arange(max(int(v) - half, 0), min(int(v) + half + 1, HEIGHT))
        if not len(us) or not len(vs):
            continue
        part = np.s_[vs[0] : vs[-1] + 1, us[0] : us[-1] + 1]
        local = camera.rotation @ offset
        for layer in range(4):
            gap = np.sqrt(np.maximum(distance**2 - (rays[layer][part] @ local) ** 2, 0))
            inside = ndtr((ball[3] - gap) * FOCAL_PX / distance / BLUR_PX)
            np.maximum(light[layer][part], inside, out=light[layer][part])
    picture = DARK + (BRIGHT - DARK) * light.mean(axis=0) + np.random.default_rng(seed).normal(0, NOISE, (HEIGHT, WIDTH))
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)


def views(*parts):
    """Return the views of three cameras that look at balls."""
    balls = np.concatenate(parts)
    return tuple(view_of(camera, photograph(camera, balls, seed)) for seed, camera in enumerate(cameras()))


def pipe(name, start, end, diameter, **changes):
    """Return a pipe as the reconstruction gives it."""
    known = {"sigma_position": (0.5, 1.0, 0.5), "station": "S"}
    return Pipe(id=name, start=tuple(map(float, start)), end=tuple(map(float, end)), outer_diameter=diameter, **(known | changes))


def unit(*vector):
    return np.array(vector, float) / np.linalg.norm(vector)


def corner_of_two(angle_deg, radius, diameter, turn_deg=0.0, legs=330.0, centre=CENTRE):
    """Return pictures of two pipes with a bend and the pipes, a little off; ``turn_deg`` turns the bend's plane out of the picture's."""
    angle, turn = np.radians(angle_deg), np.radians(turn_deg)
    come = np.array([1.0, 0, 0])
    go = np.cos(angle) * come - np.sin(angle) * np.array([0, np.sin(turn), np.cos(turn)])
    arc, first, last = bend(centre, come, go, radius, diameter)
    start, end = first - legs * come, last + legs * go
    pictures = views(straight(start, first, diameter), arc, straight(last, end, diameter))
    off = np.array([0.4, 1.0, -0.5])
    pipes = (pipe("S-P00", start + off, first + off - 9 * come, diameter), pipe("S-P01", end - off, last - off + 6 * go, diameter))
    return pictures, pipes
