# SPDX-License-Identifier: LGPL-2.1-or-later
"""A made-up plant and what stations make of it: exact, or as far off as the paper's tables say."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, moved
from pipeworkbench.recon.topology import joined

SIGMA = (0.8, 0.8, 0.8)


def vector(array):
    return tuple(float(x) for x in array)


def pipe(name, start, end, diameter=60.3, **changes):
    known = {"sigma_position": SIGMA, "sigma_direction_deg": 0.2}
    return Pipe(id=name, start=vector(start), end=vector(end), outer_diameter=diameter, **(known | changes))


def elbow(name, corner, come, go, diameter=60.3, radius=76.0):
    """Return an elbow of 90 degrees between a course that comes along one direction and goes on along another."""
    corner, come, go = (np.array(x, float) for x in (corner, come, go))
    ends = vector(corner - radius * come), vector(corner + radius * go)
    return Elbow(id=name, start=ends[0], end=ends[1], intersection=vector(corner), angle_deg=90, bend_radius=radius, outer_diameter=diameter)


def flange(name, face, axis, diameter=60.3):
    kind = {"flange_type": "11", "pn": 16, "D": diameter + 105, "C": 18, "length": 45}
    return Flange(id=name, face=vector(face), axis=vector(axis), outer_diameter=diameter, sigma_position=SIGMA, **kind)


def plant():
    """Return two runs: one of DN 50 with two elbows and a pair of flanges, one of DN 100 with an elbow, and a thin pipe across."""
    x, y, z = np.eye(3)
    return (
        pipe("P0", (0, 0, 0), (924, 0, 0)),
        elbow("E0", (1000, 0, 0), x, z),
        pipe("P1", (1000, 0, 76), (1000, 0, 724)),
        elbow("E1", (1000, 0, 800), z, y),
        pipe("P2", (1000, 76, 800), (1000, 500, 800)),
        flange("F0", (1000, 545, 800), y),
        flange("F1", (1000, 547, 800), -y),
        pipe("P3", (1000, 592, 800), (1000, 1500, 800)),
        pipe("Q0", (-300, 400, -200), (-300, 400, 1048), 114.3),
        elbow("E2", (-300, 400, 1200), z, x, 114.3, 152.0),
        pipe("Q1", (-148, 400, 1200), (1400, 400, 1200), 114.3),
        pipe("R0", (200, -300, 300), (200, 900, 300), 33.7),
    )


def rack(count=5, spacing=200.0, length=2000.0):
    """Return parallel pipes of one diameter."""
    return tuple(pipe(f"K{n}", (0, n * spacing, 0), (length, n * spacing, 0)) for n in range(count))


def pose(heading_deg, shift, tilt_deg=(0.0, 0.0)):
    """Return the motion (4, 4) from a station's level frame to the plant."""
    turn = Rotation.from_euler("z", heading_deg, degrees=True) * Rotation.from_euler("xy", tilt_deg, degrees=True)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn.as_matrix(), shift
    return matrix


def seen(name, components, plant_from_level, only=None, noise=None):
    """Return the pipeline of a station that sees components, all or those named; ``noise`` draws Table 4's deviations."""
    back = np.linalg.inv(plant_from_level)
    joints = joined(Pipeline(frame="plant", components=tuple(components))).joints
    chosen = [c for c in components if only is None or c.id in only]
    names = {c.id for c in chosen}
    made = [disturbed(c, noise) if noise is not None else c for c in chosen]
    made = tuple(replace(moved(c, back.tolist()), id=f"{name}-{c.id}", station=name, pick=number) for number, c in enumerate(made))
    kept = tuple(replace(j, a=f"{name}-{j.a}", b=f"{name}-{j.b}") for j in joints if {j.a, j.b} <= names)
    return replace(Pipeline.of_station(name, made), joints=kept)


def disturbed(component, rng):
    """Return a component moved by about 1.1 mm and, if it is a pipe, turned by about 0.3 degrees (Table 4)."""
    shift = np.eye(4)
    shift[:3, 3] = rng.normal(0, 0.9, 3)
    component = moved(component, shift.tolist())
    if not isinstance(component, Pipe):
        return component
    lever = np.radians(0.24) * component.length / 2 * rng.normal(0, 1, 3)
    return replace(component, start=vector(component.start - lever), end=vector(component.end + lever))


def deviation(registration, name, plant_from_first, plant_from_other, points):
    """Return by how many mm at most a station's points (n, 3), given in the plant, are off after the registration."""
    found = plant_from_first @ np.array(registration.pipeline.stations[name].frame_from_level) @ np.linalg.inv(plant_from_other)
    return float(np.linalg.norm(points @ found[:3, :3].T + found[:3, 3] - points, axis=1).max())


def places(components):
    """Return all ports (n, 3) of components."""
    return np.array([port.point for component in components for port in component.ports])
