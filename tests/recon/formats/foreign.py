# SPDX-License-Identifier: LGPL-2.1-or-later
"""A rig of three views with strong distortion, and projections in the formulas of other programs' manuals.

Nothing here uses the code under test: `assert_agrees` compares a converted station with these formulas.
"""

import struct
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.recon.station import read_station

WIDTH, HEIGHT = 1296, 972
NAMES = ("left", "right", "top")
MM_PER_METRE = 1000.0
TOLERANCE_PX = 1e-6


@dataclass
class Pose:
    """World (m) to camera: x = R (X - C)."""

    rotation: np.ndarray
    centre: np.ndarray

    @property
    def translation(self):
        return -self.rotation @ self.centre

    @property
    def matrix(self):
        result = np.eye(4)
        result[:3, :3], result[:3, 3] = self.rotation, self.translation
        return result


def poses(count=3):
    """Poses in a world whose axes have nothing to do with the cameras'."""
    world = Rotation.from_euler("xyz", [70, -35, 120], degrees=True).as_matrix()
    angles = [[0, 0, 0], [2, -9, 3], [-8, -4, -2], [4, 3, 8]]
    centres = [[0, 0, 0], [0.65, 0.02, -0.01], [0.3, -0.6, 0.05], [-0.4, -0.3, 0.1]]
    origin = np.array([12.0, -7.0, 3.0])
    return [
        Pose(Rotation.from_euler("xyz", a, degrees=True).as_matrix() @ world, origin + world.T @ np.array(c))
        for a, c in zip(angles[:count], centres[:count], strict=True)
    ]


def points(count=400):
    """Points (n, 3) in the world, in front of the first camera, 3 to 8 m away."""
    generator = np.random.default_rng(5)
    depth = generator.uniform(3, 8, count)
    local = np.column_stack([generator.uniform(-0.55, 0.55, count) * depth, generator.uniform(-0.42, 0.42, count) * depth, depth])
    first = poses()[0]
    return local @ first.rotation + first.centre


def ideal(pose, world):
    local = (world - pose.centre) @ pose.rotation.T
    return local[:, :2] / local[:, 2:]


def photographs(folder, names, width=WIDTH, height=HEIGHT):
    """Write black photographs and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / name for name in names]
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        assert cv2.imwrite(str(path), np.zeros((height, width), np.uint8))
    return paths


def level_from_world(pose, up):
    """x right, y forward, z up of a camera that looks about horizontally."""
    forward = pose.rotation[2] - (pose.rotation[2] @ up) * up
    forward /= np.linalg.norm(forward)
    return np.array([np.cross(forward, up), forward, up])


def mean_up(rig):
    up = -np.mean([pose.rotation[1] for pose in rig], axis=0)
    return up / np.linalg.norm(up)


def assert_agrees(station_file, rig, lenses, *, up=None, scale=MM_PER_METRE, tolerance=TOLERANCE_PX):
    """Compare the projection through a written station with lenses (ideal coordinates to our pixels)."""
    station = read_station(station_file)
    assert len(station.cameras) == len(rig)
    world = points()
    level = level_from_world(rig[0], mean_up(rig) if up is None else up)
    for camera, pose, lens in zip(station.cameras, rig, lenses, strict=True):
        expected = lens(*ideal(pose, world).T)
        found = camera.project(scale * (world - rig[0].centre) @ level.T)
        inside = (expected > -0.5).all(axis=1) & (expected < [WIDTH - 0.5, HEIGHT - 0.5]).all(axis=1)
        assert inside.sum() > 80
        assert np.abs(found[inside] - expected[inside]).max() < tolerance
    return station


# ---------------------------------------------------------------- COLMAP

# of src/colmap/sensor/models.h: parameters and distortion; u = fx x' + cx counts from the image's corner
COLMAP = {
    "SIMPLE_PINHOLE": (1100.0, 640.0, 500.0),
    "PINHOLE": (1100.0, 1090.0, 640.0, 500.0),
    "SIMPLE_RADIAL": (1100.0, 640.0, 500.0, -0.21),
    "RADIAL": (1100.0, 640.0, 500.0, -0.23, 0.09),
    "OPENCV": (1100.0, 1090.0, 640.0, 500.0, -0.23, 0.09, 0.004, -0.006),
    "FULL_OPENCV": (1100.0, 1090.0, 640.0, 500.0, 0.21, 0.05, 0.004, -0.006, 0.02, 0.45, 0.08, 0.01),
    "OPENCV_FISHEYE": (1100.0, 1090.0, 640.0, 500.0, -0.02, 0.01, -0.005, 0.001),
    "FOV": (1100.0, 1090.0, 640.0, 500.0, 0.6),
    "SIMPLE_RADIAL_FISHEYE": (1100.0, 640.0, 500.0, -0.03),
    "RADIAL_FISHEYE": (1100.0, 640.0, 500.0, -0.03, 0.01),
    "THIN_PRISM_FISHEYE": (1100.0, 1090.0, 640.0, 500.0, -0.02, 0.01, 0.0005, -0.0004, -0.003, 0.001, 0.0003, -0.0002),
}
COLMAP_NUMBERS = {
    "SIMPLE_PINHOLE": 0,
    "PINHOLE": 1,
    "SIMPLE_RADIAL": 2,
    "RADIAL": 3,
    "OPENCV": 4,
    "OPENCV_FISHEYE": 5,
    "FULL_OPENCV": 6,
    "FOV": 7,
    "SIMPLE_RADIAL_FISHEYE": 8,
    "RADIAL_FISHEYE": 9,
    "THIN_PRISM_FISHEYE": 10,
}


def colmap_lens(model, parameters):
    """Return the projection of ideal coordinates into OUR pixels by COLMAP's formulas, which count from the corner."""
    p = list(parameters)
    if model.startswith(("SIMPLE", "RADIAL")):
        p = [p[0], *p]  # one focal length for both directions
    fx, fy, cx, cy, *d = p

    def lens(x, y):
        if model == "FOV":
            r = np.hypot(x, y)
            factor = np.arctan(r * 2 * np.tan(d[0] / 2)) / (r * d[0])
            x, y = x * factor, y * factor
        elif model.endswith("FISHEYE"):
            r = np.hypot(x, y)
            x, y = x * np.arctan(r) / r, y * np.arctan(r) / r
            r2 = x**2 + y**2
            if model == "THIN_PRISM_FISHEYE":
                k1, k2, p1, p2, k3, k4, sx1, sy1 = d
                radial = k1 * r2 + k2 * r2**2 + k3 * r2**3 + k4 * r2**4
                x, y = (
                    x + x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2) + sx1 * r2,
                    y + y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y**2) + sy1 * r2,
                )
            else:
                radial = sum(k * r2 ** (i + 1) for i, k in enumerate(d))
                x, y = x + x * radial, y + y * radial
        else:
            k1, k2, p1, p2, k3, k4, k5, k6 = [*d, *[0.0] * (8 - len(d))]
            r2 = x**2 + y**2
            radial = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
            x, y = (
                x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2),
                y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y**2),
            )
        # in COLMAP the centre of the first pixel is (0.5, 0.5), ours is (0, 0)
        return np.column_stack([fx * x + cx, fy * y + cy]) - 0.5

    return lens


def quaternion(pose):
    x, y, z, w = Rotation.from_matrix(pose.rotation).as_quat()
    return [w, x, y, z]


def write_colmap_text(folder, cameras, images, observed="\n"):
    """Write a text model; cameras {id: (model, parameters)}, images [(pose, camera id, name)]."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["# Camera list with one line of data per camera:", "", "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"]
    lines += [f"{i} {model} {WIDTH} {HEIGHT} {' '.join(map(repr, map(float, p)))}" for i, (model, p) in cameras.items()]
    (folder / "cameras.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    text = "# Image list with two lines of data per image:\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
    for i, (pose, camera, name) in enumerate(images, 1):
        numbers = " ".join(repr(float(v)) for v in (*quaternion(pose), *pose.translation))
        text += f"{i} {numbers} {camera} {name}\n{observed}"
    (folder / "images.txt").write_text(text, encoding="utf-8")
    return folder


def write_colmap_binary(folder, cameras, images, observations=3):
    folder.mkdir(parents=True, exist_ok=True)
    data = struct.pack("<Q", len(cameras))
    for i, (model, p) in cameras.items():
        data += struct.pack("<IiQQ", i, COLMAP_NUMBERS[model], WIDTH, HEIGHT) + struct.pack(f"<{len(p)}d", *p)
    (folder / "cameras.bin").write_bytes(data)
    data = struct.pack("<Q", len(images))
    for i, (pose, camera, name) in enumerate(images, 1):
        data += struct.pack("<I4d3dI", i, *quaternion(pose), *pose.translation, camera) + name.encode() + b"\0"
        data += struct.pack("<Q", observations) + struct.pack("<ddQ", 1.5, 2.5, 2**64 - 1) * observations
    (folder / "images.bin").write_bytes(data)
    return folder


# ---------------------------------------------------------------- OpenCV and Kalibr


def opencv_lens(matrix, distortion):
    """Return the projection by OpenCV itself."""

    def lens(x, y):
        local = np.column_stack([x, y, np.ones_like(x)])
        return cv2.projectPoints(local, np.zeros(3), np.zeros(3), np.array(matrix, float), np.array(distortion, float))[0][:, 0]

    return lens


def kalibr_equidistant(fu, fv, pu, pv, k1, k2, k3, k4):
    def lens(x, y):
        r = np.hypot(x, y)
        theta = np.arctan(r)
        scaled = theta * (1 + k1 * theta**2 + k2 * theta**4 + k3 * theta**6 + k4 * theta**8) / r
        return np.column_stack([fu * x * scaled + pu, fv * y * scaled + pv])

    return lens


def kalibr_fov(fu, fv, pu, pv, w):
    def lens(x, y):
        r = np.hypot(x, y)
        scaled = np.arctan(2 * r * np.tan(w / 2)) / (w * r)
        return np.column_stack([fu * x * scaled + pu, fv * y * scaled + pv])

    return lens


# ---------------------------------------------------------------- Metashape


def metashape_lens(calibration, fisheye=False):  # noqa: FBT002
    """Return the projection into OUR pixels by the manual's appendix on camera models."""
    f, cx, cy, b1, b2, k1, k2, k3, k4, p1, p2, p3, p4 = (
        calibration.get(n, 0.0) for n in ("f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4")
    )

    def lens(x, y):
        if fisheye:
            r = np.hypot(x, y)
            x, y = x * np.arctan(r) / r, y * np.arctan(r) / r
        r = np.hypot(x, y)
        radial = 1 + k1 * r**2 + k2 * r**4 + k3 * r**6 + k4 * r**8
        more = 1 + p3 * r**2 + p4 * r**4
        xd = x * radial + (p1 * (r**2 + 2 * x**2) + 2 * p2 * x * y) * more
        yd = y * radial + (p2 * (r**2 + 2 * y**2) + 2 * p1 * x * y) * more
        u, v = WIDTH * 0.5 + cx + xd * f + xd * b1 + yd * b2, HEIGHT * 0.5 + cy + yd * f
        return np.column_stack([u, v]) - 0.5  # the centre of the first pixel is (0.5, 0.5) there

    return lens
