# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small station in memory: three cameras and pictures of pipes whose geometry is known exactly."""

import functools
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ndtr

from pipeworkbench.recon.camera import Camera, OpenCVInterior
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import views_of

WIDTH, HEIGHT, FOCAL_PX = 640, 480, 1300.0
BLUR_PX = 0.8
DARK, BRIGHT, NOISE = 60.0, 180.0, 1.5
# right handed: x right, y forward, z up; a camera looks along +y with its y axis down
LOOKING_FORWARD = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
INTERIOR = OpenCVInterior(WIDTH, HEIGHT, FOCAL_PX, FOCAL_PX, 322.0, 238.0, (-0.08, 0.02, 2e-4, -3e-4))
TARGET = np.array([0.0, 3000.0, 0.0])


@dataclass(frozen=True)
class TruePipe:
    """A pipe as it is: the ends of its axis and its outside diameter in mm."""

    start: np.ndarray
    end: np.ndarray
    diameter: float

    @property
    def direction(self):
        return (self.end - self.start) / np.linalg.norm(self.end - self.start)

    @property
    def cylinder(self):
        return Cylinder((self.start + self.end) / 2, self.direction, self.diameter / 2)

    @property
    def half_length(self):
        return float(np.linalg.norm(self.end - self.start)) / 2

    def distance(self, points):
        """Return the distances (n,) of points (n, 3) from the axis."""
        offset = np.atleast_2d(points) - self.start
        return np.linalg.norm(offset - np.outer(offset @ self.direction, self.direction), axis=1)


def pipe(diameter=114.3, tilt_deg=(10.0, 15.0), length=700.0, centre=TARGET):
    """Return a pipe; tilted in the picture and in depth, upright without."""
    roll, depth = np.radians(tilt_deg)
    direction = np.array([np.sin(roll) * np.cos(depth), np.sin(depth), np.cos(roll) * np.cos(depth)])
    return TruePipe(np.asarray(centre) - direction * length / 2, np.asarray(centre) + direction * length / 2, diameter)


DN100 = pipe()


def cameras(count=3):
    """Return cameras with bases of about 600 mm that look at the target; the lens distorts a little."""
    made = []
    for name, x, z in (("left", -300.0, 0.0), ("right", 300.0, 0.0), ("top", 0.0, 600.0))[:count]:
        centre = np.array([x, 0.0, z])
        yaw, pitch = np.arctan2(-x, TARGET[1]), np.arctan2(-z, TARGET[1])
        made.append(Camera(name, INTERIOR, Rotation.from_euler("xy", [-pitch, -yaw]).as_matrix() @ LOOKING_FORWARD, centre))
    return tuple(made)


def photograph(camera: Camera, pipes: Sequence[TruePipe], seed=0):
    """Return an 8-bit picture: a pixel is the mean over its area of blurred bright silhouettes, with noise.

    A point of the picture is in a pipe's silhouette where its ray passes the axis within the radius.
    """
    total = np.zeros(HEIGHT * WIDTH)
    for rays in _local_rays():
        light = np.zeros(len(rays))
        for one in pipes:
            light = np.maximum(light, _silhouette(camera, rays @ camera.rotation, one))
        total += light / 4
    picture = DARK + (BRIGHT - DARK) * total + np.random.default_rng(seed).normal(0, NOISE, total.shape)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8).reshape(HEIGHT, WIDTH)


@functools.cache
def _local_rays():
    """Return the rays, in the camera's frame, of four points in each pixel: Gauss-Legendre, two each way."""
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    centres = np.column_stack([u.ravel(), v.ravel()]).astype(float)
    camera = Camera("itself", INTERIOR, np.eye(3), np.zeros(3))
    node = 0.5 / np.sqrt(3)
    return tuple(camera.rays(np.add(centres, [du, dv])) for du in (-node, node) for dv in (-node, node))


def _silhouette(camera, rays, one):
    across = np.cross(rays, one.direction)
    offset = one.start - camera.projection_centre
    sine = np.linalg.norm(across, axis=1)
    gap = np.abs(across @ offset) / sine
    # where along the axis the ray passes it
    cosine = rays @ one.direction
    along = (cosine * (rays @ offset) - offset @ one.direction) / sine**2
    pixels_per_mm = FOCAL_PX / np.linalg.norm(offset + along[:, None] * one.direction, axis=1)
    length = 2 * one.half_length
    inside = ndtr((one.diameter / 2 - gap) * pixels_per_mm / BLUR_PX)
    return inside * ndtr(along * pixels_per_mm / BLUR_PX) * ndtr((length - along) * pixels_per_mm / BLUR_PX)


def views(pipes: Sequence[TruePipe], count=3, seed=0):
    """Return the views of a station that looks at these pipes."""
    with tempfile.TemporaryDirectory() as folder:
        made = station(Path(folder), count)
        for index, (camera, path) in enumerate(zip(made.cameras, made.images, strict=True)):
            cv2.imwrite(str(path), photograph(camera, pipes, seed + index))
        return views_of(made)


@functools.cache
def views_of_dn100():
    """Return the views of a station that looks at :data:`DN100`; made once for all tests."""
    return views([DN100], seed=20)


@functools.cache
def views_without_edges():
    """Return the views of three cameras in whose pictures nothing is."""
    (one,) = views([], 1)
    return tuple(replace(one, camera=camera) for camera in cameras())


def true_edges(camera: Camera, one: TruePipe, part=0.6):
    """Return the true edges (2, 2, 2) of a pipe's middle part in a picture: rays that touch the cylinder.

    Found by bisection with the distance of ray and axis alone.
    """
    edges = []
    ends = [one.cylinder.at(part * one.half_length * sign) for sign in (-1, 1)]
    axis_px = camera.project(np.array(ends))
    tangent = (axis_px[1] - axis_px[0]) / np.linalg.norm(axis_px[1] - axis_px[0])
    for side in (1, -1):
        normal = side * np.array([-tangent[1], tangent[0]])
        points = []
        for start in axis_px:
            low, high = 0.0, 200.0
            for _ in range(50):
                middle = (low + high) / 2
                (ray,) = camera.rays((start + middle * normal)[None])
                across = np.cross(ray, one.direction)
                gap = abs(across @ (one.start - camera.projection_centre)) / np.linalg.norm(across)
                low, high = (middle, high) if gap < one.diameter / 2 else (low, middle)
            points.append(start + low * normal)
        edges.append(points)
    return np.array(edges)


def pick(camera_index: int, one: TruePipe, off_px=0.0, seed=0, diameter=None):
    """Return a pick of a pipe whose clicks lie ``off_px`` beside the true edges, in any direction."""
    edges = true_edges(cameras()[camera_index], one)
    angle = np.random.default_rng(seed).uniform(0, 2 * np.pi, (2, 2))
    return PipePick(0, camera_index, edges + off_px * np.stack([np.cos(angle), np.sin(angle)], axis=-1), diameter)


def station(folder: Path, count=3):
    """Return the station itself, without pictures."""
    made = cameras(count)
    return Station("synthetic", made, tuple(folder / f"{camera.name}.png" for camera in made), folder / "station.json")


def edge_view(camera: Camera, components, seed=0, noise_px=0.15, seen=0.9):
    """Return a view whose edges are the visible contours of components, with noise; a part ``seen`` of them is there."""
    from pipeworkbench.recon.contour import contour_of
    from pipeworkbench.recon.edges import EdgeMap, _fill
    from pipeworkbench.recon.views import View

    random = np.random.default_rng(seed)
    found = contour_of(camera, components, 1.0, 1.0)
    # whole stretches of 8 px are missing, as they are in photographs
    stretch = (found.parameter * 1e4).astype(int) // 50 + 1000 * found.curve
    there = random.uniform(size=stretch.max() + 1)[stretch] < seen
    found = found[found.visible & there]
    width, height = camera.interior.width, camera.interior.height
    position = np.clip(found.position + random.normal(0, noise_px, len(found))[:, None] * found.normal, 3, (width - 4, height - 4))
    pixel = np.rint(position).astype(np.int32)
    index = np.full((height, width), -1, np.int32)
    _fill(index, pixel, position)
    ones = np.ones(len(found))
    edges = EdgeMap(position, found.normal, 20 * ones, 60 * ones, 0.8 * ones, 0.1 * ones, 1.2 * ones, pixel, index)
    return View(camera, edges, np.zeros((height, width), np.float32))
