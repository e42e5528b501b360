# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations of made-up plants put together over their components: how often rightly, wrongly, ambiguously; then the speed.

    python bench/register.py [--plants 300] [--seed 1] [--out register.md]

A plant is two or more runs of pipes at right angles, some at 45 degrees, with elbows and flanges, some of them racks of parallel pipes. Two
stations see it from anywhere; each component is seen by both or by one only; pipes are as far off as the paper's Table 4
says, flanges as its Table 7, elbows are where the axes of their pipes meet. A registration is right where the components
both stations saw lie within 10 mm of each other's true places (root mean square), and wrong where it is not and no problem was reported.
"""

import argparse
import math
import statistics
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, moved
from pipeworkbench.recon.register import register
from pipeworkbench.recon.topology import joined

DIAMETERS = (33.7, 48.3, 60.3, 76.1, 88.9, 114.3, 168.3)  # mm, of EN 10220
TABLE_4 = ((1.4, 0.6), (1.2, 0.3), (0.5, 0.2), (1.1, 0.2), (1.6, 0.3), (0.9, 0.5), (0.7, 0.2))  # mm, degrees: pipes
TABLE_7 = ((0.2, 0.8, 0.8), (1.3, 2.6, 2.1), (0.2, 0.7, 0.5), (0.0, 0.5, 0.3))  # axial mm, orthogonal mm, degrees: flanges
SIGMA_MM, SIGMA_DEG = 0.8, 0.25  # what the components say of themselves: the tables' means for each of two directions
SHARED = (5, 40)
ONE_ONLY = 0.3
TILT_DEG = 0.5
RIGHT_MM = 10.0
BEND = 1.5  # diameters: the usual radius of an elbow
LENGTHS = (300.0, 1800.0)
AROUND = 2500.0  # mm: half the size of the part of a plant that a station sees
STATIONS, COMPONENTS = 10, 100
AXES = np.vstack([np.eye(3), -np.eye(3)])


@dataclass(frozen=True)
class Outcome:
    """What became of two stations: ``shared`` components, the deviation in mm, None where they stayed apart, and what was said."""

    shared: int
    deviation: float | None
    far: float | None
    problems: tuple
    ambiguous: bool
    seconds: float

    @property
    def right(self):
        """Whether the stations are where they belong."""
        return self.deviation is not None and self.deviation <= RIGHT_MM

    @property
    def wrong(self):
        """Whether they are not, and nobody says so."""
        return self.deviation is not None and not self.right


def vector(array):
    """Return an array (3,) as components hold it."""
    return tuple(float(x) for x in array)


def run_of(rng, name, diameter, start, direction, pieces):
    """Return the components of a run: pipes, elbows between them, here and there a pair of flanges."""
    components, place = [], np.array(start, float)
    for number in range(pieces):
        length = rng.uniform(*LENGTHS)
        end = place + length * direction
        components.append(Pipe(id=f"{name}-P{number}", start=vector(place), end=vector(end), outer_diameter=diameter))
        place = end
        if number == pieces - 1:
            break
        if rng.random() < 0.3:
            face, reach = (
                place + 45 * direction,
                {"outer_diameter": diameter, "flange_type": "11", "pn": 16, "D": diameter + 100, "C": 18, "length": 45},
            )
            components.append(Flange(id=f"{name}-F{number}a", face=vector(face), axis=vector(direction), **reach))
            components.append(Flange(id=f"{name}-F{number}b", face=vector(face + 2 * direction), axis=vector(-direction), **reach))
            place = face + 47 * direction
            continue
        choices = AXES[np.abs(AXES @ direction) < 0.9]
        turn = choices[rng.integers(len(choices))]
        if rng.random() < 0.15:
            turn = (direction + turn) / np.linalg.norm(direction + turn)
        turn = turn / np.linalg.norm(turn)
        angle = math.acos(np.clip(direction @ turn, -1, 1))
        if angle < 0.1:
            continue
        tangent = BEND * diameter * math.tan(angle / 2)
        corner = place + tangent * direction
        place = corner + tangent * turn
        components.append(
            Elbow(
                id=f"{name}-E{number}",
                start=vector(corner - tangent * direction),
                end=vector(place),
                intersection=vector(corner),
                angle_deg=math.degrees(angle),
                bend_radius=BEND * diameter,
                outer_diameter=diameter,
            )
        )
        direction = turn
    return components


def plant_of(rng, count):
    """Return the components of a made-up plant, ``count`` of them."""
    components = []
    extent = AROUND * max(1.0, (count / 60) ** (1 / 3))
    while len(components) < count:
        direction = AXES[rng.integers(len(AXES))]
        start = rng.uniform(-extent, extent, 3) * (1, 1, 0.5)
        diameter = DIAMETERS[rng.integers(len(DIAMETERS))]
        run = run_of(rng, f"R{len(components)}", diameter, start, direction, int(rng.integers(1, 6)))
        # two runs at least: one alone, straight as some are, looks the same from both its ends
        run = run[: max(count // 2, 2)]
        copies = 1
        # a rack: the same run beside itself
        if rng.random() < 0.2:
            copies = int(rng.integers(2, 5))
        aside = np.cross(direction, AXES[rng.integers(len(AXES))])
        spacing = (diameter + rng.choice((50.0, 100.0, 150.0))) * (aside if np.linalg.norm(aside) > 0.5 else np.roll(direction, 1))
        for copy in range(copies):
            shift = np.eye(4)
            shift[:3, 3] = copy * spacing
            single = run if copy == 0 else [one for one in run if isinstance(one, Pipe)] if rng.random() < 0.5 else run
            components += [replace(moved(one, shift.tolist()), id=f"{one.id}/{copy}") for one in single]
    return components[:count]


def noisy_pipe(rng, pipe, whole):
    """Return a pipe as far off as Table 4 says; where an end is not joined, a part of it was not seen."""
    position, direction = TABLE_4[rng.integers(len(TABLE_4))]
    start, end = np.array(pipe.start), np.array(pipe.end)
    axis = (end - start) / pipe.length
    around = np.linalg.svd(axis[None])[2][1:]
    shift, tilt = (np.array([math.cos(a), math.sin(a)]) @ around for a in rng.uniform(0, 2 * math.pi, 2))
    lever = math.radians(direction) * pipe.length / 2 * tilt
    start, end = start + position * shift - lever, end + position * shift + lever
    cut = [0.0 if joint else float(rng.uniform(0, 0.2)) for joint in whole]
    sigma = vector(np.sqrt(np.clip(1 - axis**2, 0.0, 1.0)) * SIGMA_MM)
    return replace(
        pipe,
        start=vector(start + cut[0] * (end - start)),
        end=vector(end - cut[1] * (end - start)),
        sigma_position=sigma,
        sigma_direction_deg=SIGMA_DEG,
    )


def noisy_flange(rng, flange):
    """Return a flange as far off as Table 7 says."""
    axial, orthogonal, direction = TABLE_7[rng.integers(len(TABLE_7))]
    axis = np.array(flange.axis)
    around = np.linalg.svd(axis[None])[2][1:]
    shift, tilt = (np.array([math.cos(a), math.sin(a)]) @ around for a in rng.uniform(0, 2 * math.pi, 2))
    turned = axis + math.radians(direction) * tilt
    face = np.array(flange.face) + rng.choice((-1, 1)) * axial * axis + orthogonal * shift
    return replace(flange, face=vector(face), axis=vector(turned / np.linalg.norm(turned)), sigma_position=(SIGMA_MM,) * 3)


def noisy_elbow(rng, elbow, pipes):
    """Return an elbow where the axes of its pipes meet; where one was not seen, as far off as Table 4 says."""
    if len(pipes) == 2:
        (p, d), (q, e) = ((np.array(pipe.start), np.subtract(pipe.end, pipe.start) / pipe.length) for pipe in pipes)
        cosine, away = d @ e, q - p
        first, second = np.linalg.solve([[1, -cosine], [cosine, -1]], [away @ d, away @ e])
        corner = (p + first * d + q + second * e) / 2
    else:
        corner = np.array(elbow.intersection) + rng.normal(0, 1.0, 3)
    shift = np.eye(4)
    shift[:3, 3] = corner - elbow.intersection
    return moved(elbow, shift.tolist())


def station_of(rng, name, components, seen):
    """Return what a station makes of the components it sees, in its level frame, and the pose (4, 4) of that in the plant."""
    joints = joined(Pipeline(frame="plant", components=tuple(components))).joints
    names = {one.id for one in seen}
    ends = {(joint.a, joint.a_port) for joint in joints if joint.b in names} | {(joint.b, joint.b_port) for joint in joints if joint.a in names}
    neighbours = {}
    for joint in joints:
        neighbours.setdefault(joint.a, []).append(joint.b)
        neighbours.setdefault(joint.b, []).append(joint.a)
    made = {one.id: noisy_pipe(rng, one, [(one.id, port) in ends for port in (0, 1)]) for one in seen if isinstance(one, Pipe)}
    for one in seen:
        if isinstance(one, Flange):
            made[one.id] = noisy_flange(rng, one)
        elif isinstance(one, Elbow):
            made[one.id] = noisy_elbow(rng, one, [made[other] for other in neighbours.get(one.id, ()) if isinstance(made.get(other), Pipe)])
    tilt = Rotation.from_euler("xy", rng.uniform(-TILT_DEG, TILT_DEG, 2), degrees=True)
    pose = np.eye(4)
    pose[:3, :3] = (Rotation.from_euler("z", rng.uniform(0, 360), degrees=True) * tilt).as_matrix()
    pose[:3, 3] = rng.uniform(-8000, 8000, 3) * (1, 1, 0.1)
    back = np.linalg.inv(pose)
    order = [one.id for one in seen]
    rng.shuffle(order)
    own = tuple(replace(moved(made[one], back.tolist()), id=f"{name}-{one}", station=name) for one in order)
    # the joints are those of the plant: the ends of pipes with noise need not meet
    kept = tuple(replace(joint, a=f"{name}-{joint.a}", b=f"{name}-{joint.b}") for joint in joints if joint.a in names and joint.b in names)
    return replace(Pipeline.of_station(name, own), joints=kept), pose


def points_of(components):
    """Return points (n, 3) of components that tell where they are."""
    return np.array([port.point for one in components for port in one.ports])


def two_stations(rng):
    """Register two stations of a made-up plant and return what became of them."""
    shared = int(rng.integers(SHARED[0], SHARED[1] + 1))
    count = max(shared, round(shared / (1 - ONE_ONLY)))
    plant = plant_of(rng, count)
    who = np.zeros(count, int)
    who[rng.permutation(count)[: count - shared]] = rng.integers(1, 3, count - shared)
    seen = [[one for one, only in zip(plant, who, strict=True) if only in (0, number)] for number in (1, 2)]
    (first, here), (second, there) = (station_of(rng, name, plant, part) for name, part in zip("AB", seen, strict=True))
    began = time.perf_counter()
    result = register([first, second])
    seconds = time.perf_counter() - began
    off, far = None, None
    if "B" in result.pipeline.stations:
        wrong = here @ np.array(result.pipeline.stations["B"].frame_from_level) @ np.linalg.inv(there) - np.eye(4)
        both = points_of([one for one, only in zip(plant, who, strict=True) if only == 0])
        off = math.sqrt((((both @ wrong[:3, :3].T + wrong[:3, 3]) ** 2).sum(1)).mean())
        far = float(np.linalg.norm(points_of(plant) @ wrong[:3, :3].T + wrong[:3, 3], axis=1).max())
    return Outcome(shared, off, far, result.problems, bool(result.candidates), seconds)


def chain(rng, stations, components):
    """Return stations of a long plant that see so many components each, most of them the neighbours', and their poses."""
    plant = plant_of(rng, stations * components // 2)
    order = np.argsort(points_of_each(plant)[:, 0], kind="stable")
    step = (len(plant) - components) / max(stations - 1, 1)
    found = []
    for number in range(stations):
        part = [plant[row] for row in order[round(number * step) : round(number * step) + components]]
        found.append(station_of(rng, f"S{number}", plant, part))
    return found


def points_of_each(components):
    """Return one point (n, 3) of each component."""
    return np.array([one.ports[0].point for one in components])


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plants", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, metavar="FILE.md", help="where to write what is printed")
    options = parser.parse_args()
    outcomes = [two_stations(np.random.default_rng([options.seed, number])) for number in range(options.plants)]
    right, wrong = ([one for one in outcomes if getattr(one, name)] for name in ("right", "wrong"))
    ambiguous = [one for one in outcomes if one.ambiguous]
    apart = [one for one in outcomes if one.deviation is None and not one.ambiguous]
    stations = chain(np.random.default_rng(options.seed), STATIONS, COMPONENTS)
    began = time.perf_counter()
    result = register([pipeline for pipeline, _ in stations])
    seconds = time.perf_counter() - began
    total = len(outcomes)
    share = [f"{len(part)} ({100 * len(part) / total:.1f} %)" for part in (right, wrong, ambiguous, apart)]
    off, far, times = ([getattr(one, name) for one in part] for name, part in (("deviation", right), ("far", right), ("seconds", outcomes)))
    figures = [f"{value:.2f}" for value in (statistics.median(off), max(off), statistics.median(far), statistics.median(times), max(times))]
    columns = ("right", "wrong without a warning", "ambiguous", "apart for another reason", "RMS mm, median", "RMS mm, max")
    columns = (*columns, "farthest mm, median", "s, median", "s, max")
    remarks = [
        f"- plant {number}, {one.shared} shared: {'wrong' if one.wrong else 'apart'}: {one.deviation} {' '.join(one.problems)}"
        for number, one in enumerate(outcomes)
        if not one.right
    ]
    lines = [
        "# Registration of made-up plants",
        "",
        f"{total} plants, 2 stations, {SHARED[0]} to {SHARED[1]} shared components, {100 * ONE_ONLY:.0f} % seen by one only:",
        "",
        f"| {' | '.join(columns)} |",
        "|" + "---|" * len(columns),
        f"| {' | '.join([*share, *figures])} |",
        "| asked: >= 99 % | asked: <= 0.5 %" + " | " * (len(columns) - 1),
        "",
        f"{STATIONS} stations of {COMPONENTS} components: {len(result.pipeline.stations)} merged in {seconds:.1f} s (asked: under 10 s).",
        "",
        *remarks,
    ]
    text = "\n".join([*lines, ""])
    print(text)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
