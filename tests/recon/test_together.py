# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several stations adjusted at once, on simulated edges."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from simulated import Noise, errors, perturbed, rig, simulated_pipeline, simulated_views

from pipeworkbench.pipeline import Pipeline, StationPose
from pipeworkbench.recon.together import adjusted_together

OFF_MM, OFF_DEG = 1.0, 0.02  # somewhat more than the registration leaves


@pytest.fixture(scope="module")
def two_stations():
    """Return the true components with their joints, views of two stations in their own frames, and where the second stands."""
    random = np.random.default_rng(7)
    first, second = rig((0, 0, 0), 0.0), rig((350, -150, 40), np.radians(8))
    truth, joints = simulated_pipeline(random, 12, first)
    noise = Noise(sigma=0.1, common=0.05)
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("z", 8, degrees=True).as_matrix()
    pose[:3, 3] = (350, -150, 40)
    level_from_frame = np.linalg.inv(pose)
    seen = simulated_views(second, truth, random, noise)
    views = {
        "A": simulated_views(first, truth, random, noise),
        "B": tuple(replace(view, camera=view.camera.placed(level_from_frame)) for view in seen),
    }
    return tuple(truth), tuple(joints), views, pose


def merged(truth, joints, pose, random):
    """Return a pipeline as the registration leaves it: components and the second station's pose a little off."""
    off = np.eye(4)
    off[:3, :3] = Rotation.from_rotvec(np.radians(OFF_DEG) * random.normal(size=3) / np.sqrt(3)).as_matrix()
    off[:3, 3] = OFF_MM * random.normal(size=3) / np.sqrt(3)
    stations = {
        "A": StationPose(frame_from_level=tuple(map(tuple, np.eye(4)))),
        "B": StationPose(frame_from_level=tuple(map(tuple, pose @ off)), extra={"note": "kept"}),
    }
    return Pipeline(frame="A", components=perturbed(truth, random, 1.0, 0.1), joints=joints, stations=stations)


def test_pose_of_the_second_station_follows_from_the_images(two_stations):
    truth, joints, views, pose = two_stations
    pipeline, solution = adjusted_together(merged(truth, joints, pose, np.random.default_rng(1)), views)
    found = np.array(pipeline.stations["B"].frame_from_level)
    points = np.array([component.ports[0].point for component in truth])
    there = points @ np.linalg.inv(pose)[:3, :3].T + np.linalg.inv(pose)[:3, 3]
    back = there @ found[:3, :3].T + found[:3, 3]
    # as good as the components are measured, not as the registration left it
    assert np.linalg.norm(back - points, axis=1).max() < 1.0
    assert np.linalg.norm(errors(solution.components, truth).position, axis=1).max() < 1.0
    assert solution.converged


def test_reference_station_stays_and_the_others_say_how_well_they_are_known(two_stations):
    truth, joints, views, pose = two_stations
    pipeline, _ = adjusted_together(merged(truth, joints, pose, np.random.default_rng(2)), views)
    np.testing.assert_array_equal(pipeline.stations["A"].frame_from_level, np.eye(4))
    assert pipeline.stations["A"].extra["sigma_position"] == [0.0, 0.0, 0.0]
    extra = pipeline.stations["B"].extra
    assert extra["note"] == "kept"
    assert all(0 < sigma < 1 for sigma in extra["sigma_position"])
    assert 0 < extra["sigma_heading_deg"] < 0.1
    assert all(0 < sigma < 0.1 for sigma in extra["sigma_tilt_deg"])


def test_two_stations_know_more_than_one(two_stations):
    truth, joints, views, pose = two_stations
    both = merged(truth, joints, pose, np.random.default_rng(3))
    alone = replace(both, stations={"A": both.stations["A"]})
    one, _ = adjusted_together(alone, views)
    two, _ = adjusted_together(both, views)

    def sigma(pipeline):
        return np.median([np.linalg.norm(c.sigma_position) for c in pipeline.components if c.sigma_position is not None])

    # most of them by little: the first station sees them well
    assert sigma(two) < sigma(one)
