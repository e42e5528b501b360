# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the benchmarks look at: the scenes of a folder with their truth and their judge, and a made-up pipeline of any size."""

import importlib.util
import itertools
import json
from dataclasses import dataclass, replace

import cv2
import numpy as np
from scipy.spatial.distance import cdist
from scipy.spatial.transform import Rotation

from pipeworkbench.catalogue import bends
from pipeworkbench.pipeline import Elbow, Pipe
from pipeworkbench.recon.cylinder import Cylinder
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.views import view_of

VISIBLE_PX = 1500  # the judge's, in two images
PIPES_PER_LINE = 10
DIAMETERS = (33.7, 48.3)  # mm, of the made-up lines
LEGS_MM = (220.0, 380.0)  # from corner to corner
BOX_MM = (-900.0, 1500.0), (2800.0, 4600.0), (-900.0, 1300.0)  # before the cameras; only what all of them see counts
TURN_DEG = (10.0, -6.0, 2.0)  # pipework is seldom parallel to the images
_EVERY = np.array([way for way in itertools.product((-1.0, 0.0, 1.0), repeat=3) if 1 <= sum(map(abs, way)) <= 2])
# along the edges and the faces' diagonals of a cube
DIRECTIONS = Rotation.from_euler("zyx", TURN_DEG, degrees=True).apply(_EVERY / np.linalg.norm(_EVERY, axis=1, keepdims=True))
RIGHT_ANGLES = 0.7  # of the made-up bends; the others are of 45 degrees
CLEARANCE = 3.0  # diameters between axes of pipes that do not meet
SAMPLE_MM = 20.0  # along axes, to tell how far they are apart
STRAIGHT = 1.0  # diameters of straight pipe between bends, at least
TRIES, LINES = 60, 2000  # of a leg, and of lines that came to a dead end
OFF_MM, SHORT_MM = (0.4, 1.0, 0.5), 8.0  # what measured pipes are off, across and in depth, and short of their bends
BALL_MM, RING, FINER = 4.0, 48, 2  # of the pictures: between balls; points on an outline; parts of a pixel
DARK, BRIGHT, DARKER_PER_MM, BLUR_PX, NOISE = 40.0, 330.0, 0.045, 0.8, 2.0
SUBPIXEL_BITS = 4


def judge(folder):
    """Return the judge as a module."""
    spec = importlib.util.spec_from_file_location("score", folder / "tools" / "score.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def station_folders(folder, only=()):
    """Return the stations of a folder's scenes whose truth is known; ``only`` names scenes or stations, such as dummy or dummy/A."""
    every = sorted(path.parent for path in folder.glob("scenes/*/*/station.json") if (path.parent.parent / "truth.json").is_file())
    return [one for one in every if not only or {one.parent.name, f"{one.parent.name}/{one.name}"} & set(only)]


class Scene:
    """A station with its truth, in the station's frame."""

    def __init__(self, score, folder):
        self.score, self.folder = score, folder
        self.name = f"{folder.parent.name}/{folder.name}"
        self.station = read_station(folder)
        self.picks = read_picks(folder / "picks.json", self.station)
        self.truth_of_pick = [pick.get("truth") for pick in json.loads((folder / "picks.json").read_text(encoding="utf-8"))["picks"]]
        self.world_from_level = score.world_from_result(str(folder.parent), folder.name)
        truth = json.loads((folder.parent / "truth.json").read_text(encoding="utf-8"))
        self.pipes, self.elbows, self.flanges = ({t["id"]: t for t in truth[kind]} for kind in ("pipes", "elbows", "flanges"))
        self.runs = truth["runs"]
        seen = json.loads((folder / "truth.json").read_text(encoding="utf-8"))["visible_pixels"].values()
        self.visible = {name for name in self.pipes if sum(view.get(name, 0) > VISIBLE_PX for view in seen) >= 2}

    def deviation(self, ends, diameter, truth):
        """Return the judge's deviations of a pipe from a true one."""
        moved = self.score.move({"start": ends[0], "end": ends[1], "outer_diameter": diameter}, self.world_from_level)
        return self.score.pipe_dev(moved, self.pipes[truth])

    def nearest(self, ends, diameter):
        """Return the name of the true pipe that a pipe is nearest to, and its deviations."""
        every = {name: self.deviation(ends, diameter, name) for name in self.pipes}
        name = min(every, key=lambda n: every[n]["position"] + 20 * every[n]["direction"] + (1e3 if every[n]["overlap"] < 0.05 else 0))
        return name, every[name]

    def true_cylinder(self, truth):
        """Return a true pipe in the station's frame, and its extent along the axis from the cylinder's point, mm."""
        level_from_world = np.linalg.inv(self.world_from_level)
        pipe = self.pipes[truth]
        start, end = (level_from_world[:3, :3] @ np.array(pipe[key]) + level_from_world[:3, 3] for key in ("start", "end"))
        length = float(np.linalg.norm(end - start))
        return Cylinder(start, (end - start) / length, pipe["outer_diameter"] / 2), (0.0, length)


@dataclass(frozen=True, eq=False)
class MadeUp:
    """Made-up pipework: its views, the pipes as they might have been measured, and the true elbows between them."""

    views: tuple
    pipes: tuple
    elbows: tuple


@dataclass(frozen=True, eq=False)
class _Line:
    """Pipes one after the other: corners (n + 1, 3) with both ends, the outside diameter, the bend radii (n - 1,), lengths in mm."""

    corners: np.ndarray
    diameter: float
    radii: np.ndarray


def made_up(cameras, count, seed=0):
    """Return a made-up pipeline of so many pipes in lines of ten, with pictures that show all of it to all cameras.

    Bends are by 90 and 45 degrees in any plane, of all types of the catalogue. The pictures are the
    silhouettes of balls along the axes, further away darker.
    """
    random = np.random.default_rng(seed)
    lines: list[_Line] = []
    for number, first in enumerate(range(0, count, PIPES_PER_LINE)):
        lines.append(_line(cameras, min(PIPES_PER_LINE, count - first), DIAMETERS[number % len(DIAMETERS)], lines, random))
    balls = np.concatenate([_balls(line) for line in lines])
    views = tuple(view_of(camera, _picture(camera, balls, random)) for camera in cameras)
    pipes = [pipe for line in lines for pipe in _pipes(line, random)]
    named = [
        Pipe(id=f"M-P{row:02d}", start=tuple(start), end=tuple(end), outer_diameter=diameter, station="M", sigma_position=(0.5, 1.0, 0.5))
        for row, (start, end, diameter) in enumerate(pipes)
    ]
    return MadeUp(views, tuple(named), tuple(elbow for line in lines for elbow in _elbows(line)))


def _line(cameras, count, diameter, others, random):
    """Return a line of so many pipes that meets no other one."""
    taken = np.concatenate([_along(line.corners) for line in others] or [np.zeros((0, 3))])
    for _ in range(LINES):
        line = _grown(cameras, count, diameter, taken, random)
        if line is not None:
            return line
    raise RuntimeError(f"no room for {count} more pipes beside {len(others)} lines")


def _grown(cameras, count, diameter, taken, random):
    """Return a line away from points (n, 3) that are taken, None where it came to a dead end."""
    line = _Line(random.uniform(*np.array(BOX_MM).T)[None], diameter, np.zeros(0))
    for _ in range(count):
        # the leg before touches the next one
        mine = _along(line.corners[:-1]) if len(line.corners) > 2 else taken[:0]
        options = (_longer(line, random) for _ in range(TRIES))
        free = (one for one in options if one is not None and _is_free(cameras, one, np.concatenate([taken, mine])))
        line = next(free, None)
        if line is None:
            return None
    return line


def _longer(line, random):
    """Return a line with another leg in some direction, None where its bends have no room."""
    legs = np.diff(line.corners, axis=0)
    radius = float(random.choice([bend.bend_radius for bend in bends(line.diameter)]))
    length = random.uniform(*LEGS_MM)
    if not len(legs):
        return replace(line, corners=np.concatenate([line.corners, line.corners[-1:] + length * random.choice(DIRECTIONS)]))
    before = float(np.linalg.norm(legs[-1]))
    cosine = np.sqrt(0.0 if random.uniform() < RIGHT_ANGLES else 0.5)
    direction = random.choice(DIRECTIONS[np.abs(DIRECTIONS @ legs[-1] / before - cosine) < 1e-6])
    line = _Line(np.concatenate([line.corners, line.corners[-1:] + length * direction]), line.diameter, np.append(line.radii, radius))
    tangents = [tangent for *_, tangent in _bends(line)]
    # a straight piece remains on both sides
    room = min(before - sum(tangents[-2:]), length - tangents[-1])
    return line if room > STRAIGHT * line.diameter else None


def _is_free(cameras, line, taken):
    """Tell whether the last leg is away from points (n, 3) that are taken, in the box and in all pictures."""
    leg = _along(line.corners[-2:])
    low, high = np.array(BOX_MM).T
    if not ((leg >= low) & (leg <= high)).all():
        return False
    if len(taken) and cdist(leg, taken).min() < CLEARANCE * line.diameter:
        return False
    return all(camera.sees(camera.project(leg)).all() for camera in cameras)


def _along(corners):
    """Return points (n, 3) along straight lines from corner to corner."""
    return np.concatenate([_points(start, end, SAMPLE_MM) for start, end in itertools.pairwise(corners)])


def _points(start, end, step):
    """Return points (n, 3) on a straight line, both ends among them."""
    part = np.linspace(0, 1, int(np.ceil(np.linalg.norm(end - start) / step)) + 1)
    return start + part[:, None] * (end - start)


def _bends(line):
    """Return corner, direction before and after it, angle, radius and distance of the tangent points of every bend."""
    way = np.diff(line.corners, axis=0)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    for corner, come, go, radius in zip(line.corners[1:-1], way, way[1:], line.radii, strict=False):
        angle = float(np.arccos(come @ go))
        yield corner, come, go, angle, float(radius), float(radius * np.tan(angle / 2))


def _straights(line):
    """Return start and end of the straight pieces."""
    starts, ends = list(line.corners[:-1]), list(line.corners[1:])
    for row, (corner, come, go, _, _, length) in enumerate(_bends(line)):
        ends[row], starts[row + 1] = corner - length * come, corner + length * go
    return list(zip(starts, ends, strict=True))


def _balls(line):
    """Return balls (n, 4), centres and radii in mm, along a line's axis."""
    parts = [_points(start, end, BALL_MM) for start, end in _straights(line)]
    for corner, come, go, angle, radius, length in _bends(line):
        inwards = (go - np.cos(angle) * come) / np.sin(angle)
        turn = np.linspace(0, angle, int(np.ceil(radius * angle / BALL_MM)) + 1)[:, None]
        parts.append(corner - length * come + radius * (np.sin(turn) * come + (1 - np.cos(turn)) * inwards))
    points = np.concatenate(parts)
    return np.column_stack([points, np.full(len(points), line.diameter / 2)])


def _pipes(line, random):
    """Return start, end and diameter of the pipes as they might have been measured."""
    for start, end in _straights(line):
        direction = (end - start) / np.linalg.norm(end - start)
        off = random.normal(0, OFF_MM, (2, 3))
        yield start + SHORT_MM * direction + off[0], end - SHORT_MM * direction + off[1], line.diameter


def _elbows(line):
    """Return the true elbows; their ids do not matter."""
    types = {bend.bend_radius: bend.bend_type for bend in bends(line.diameter)}
    for corner, come, go, angle, radius, length in _bends(line):
        yield Elbow(
            id="truth",
            start=tuple(corner - length * come),
            end=tuple(corner + length * go),
            intersection=tuple(corner),
            angle_deg=float(np.degrees(angle)),
            bend_radius=radius,
            bend_type=types[radius],
            outer_diameter=line.diameter,
        )


def _picture(camera, balls, random):
    """Return an 8-bit picture of balls."""
    width, height = camera.interior.width, camera.interior.height
    fine = np.full((FINER * height, FINER * width), DARK, np.uint8)
    offset = balls[:, :3] - camera.projection_centre
    distance = np.linalg.norm(offset, axis=1)
    sight = offset / distance[:, None]
    # sight touches a ball in a circle before its middle
    cosine = np.sqrt(1 - (balls[:, 3] / distance) ** 2)
    aside = np.cross(sight, [0.0, 0.0, 1.0])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    turn = np.linspace(0, 2 * np.pi, RING, endpoint=False)[:, None]
    ring = np.cos(turn) * aside[:, None] + np.sin(turn) * np.cross(sight, aside)[:, None]
    points = camera.projection_centre + (cosine**2 * distance)[:, None, None] * sight[:, None] + (cosine * balls[:, 3])[:, None, None] * ring
    outline = camera.project(points.reshape(-1, 3)).reshape(len(balls), RING, 2)
    grey = np.clip(BRIGHT - DARKER_PER_MM * distance, DARK, 255)
    # pixel centres are at integers, before and after
    drawn = ((outline + 0.5) * FINER - 0.5) * 2**SUBPIXEL_BITS
    for row in np.argsort(-distance):
        if np.isfinite(drawn[row]).all():
            cv2.fillConvexPoly(fine, np.rint(drawn[row]).astype(np.int32), float(grey[row]), cv2.LINE_8, SUBPIXEL_BITS)
    picture = cv2.resize(fine, (width, height), interpolation=cv2.INTER_AREA).astype(np.float32)
    picture = cv2.GaussianBlur(picture, (0, 0), BLUR_PX) + random.normal(0, NOISE, picture.shape)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)
