# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations: frames and rounded files."""

import json

import cv2
import numpy as np
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import OpenCVInterior
from pipeworkbench.recon.station import read_station

WIDTH, HEIGHT = 64, 48


def small_station(folder, images, **changes):
    """Write a station of two small cameras with these images and read it."""
    cameras = []
    for number, image in enumerate(images):
        name = f"image{number}.png"
        cv2.imwrite(str(folder / name), image)
        cameras.append(
            {
                "name": f"camera{number}",
                "image": name,
                "width": WIDTH,
                "height": HEIGHT,
                "interior": {"model": "opencv", "fx": 100.0, "fy": 100.0, "cx": 31.5, "cy": 23.5, "distortion": [-0.1, 0, 0, 0]},
                "exterior": {"rotation_rig_to_camera": np.eye(3).tolist(), "projection_centre": [600.0 * number, 0, 0]},
            }
        )
    data = {"schema": "pipeworkbench-station/1", "name": "small", "cameras": cameras, "level_from_rig": [[1, 0, 0], [0, 0, 1], [0, -1, 0]]}
    (folder / "station.json").write_text(json.dumps(data | changes), encoding="utf-8")
    return read_station(folder)


def ramp(dtype, factor):
    return (np.arange(HEIGHT * WIDTH).reshape(HEIGHT, WIDTH) * factor).astype(dtype)


# ---------------------------------------------------------------- frames


def test_projection_centres_are_in_the_level_frame(sample):
    data = json.loads((sample / "station.json").read_text(encoding="utf-8"))
    level_from_rig = np.array(data["level_from_rig"])
    station = read_station(sample)
    assert [camera.name for camera in station.cameras] == ["left", "right", "top"]
    for camera, given in zip(station.cameras, data["cameras"], strict=True):
        assert np.abs(camera.projection_centre - level_from_rig @ given["exterior"]["projection_centre"]).max() < 1e-5


def test_level_frame_has_x_right_y_forward_and_z_up(sample):
    left, right, top = read_station(sample).cameras
    assert left.projection_centre == pytest.approx([0, 0, 0], abs=1e-9)
    assert right.projection_centre[0] > 600
    assert top.projection_centre[2] > 600
    for camera in (left, right, top):
        assert camera.rotation[2, 1] > 0.9  # z of the camera is forward
        assert camera.rotation[1, 2] < -0.9  # y of the camera is down


def test_point_straight_ahead_projects_into_the_principal_point(sample):
    for camera in read_station(sample).cameras:
        x0, y0 = camera.interior.principal_point
        expected = [(2592 - 1) / 2 + x0 / 0.004, (1944 - 1) / 2 + y0 / 0.004]
        ahead = camera.projection_centre + 4000 * camera.rotation[2]
        assert camera.project(ahead[None])[0] == pytest.approx(expected, abs=1e-6)


def test_point_in_the_rig_is_seen_where_the_files_numbers_put_it(tmp_path):
    image = ramp(np.uint8, 0.05)
    station = small_station(tmp_path, [image, image])
    # 200 mm to the right and 100 mm up at 2 m: 10 px right and 5 px up of the principal point, but for the distortion
    point = np.array([[200.0, 2000.0, 100.0]])
    factor = 1 - 0.1 * (0.1**2 + 0.05**2)
    assert station.cameras[0].project(point)[0] == pytest.approx([31.5 + 10 * factor, 23.5 - 5 * factor], abs=1e-9)
    factor = 1 - 0.1 * (0.2**2 + 0.05**2)
    assert station.cameras[1].project(point)[0] == pytest.approx([31.5 - 20 * factor, 23.5 - 5 * factor], abs=1e-9)


def test_file_rounded_to_six_decimals_gives_exact_rotations(sample, altered):
    def rounded(station):
        station["level_from_rig"] = np.round(station["level_from_rig"], 6).tolist()
        for camera in station["cameras"]:
            exterior = camera["exterior"]
            exterior["rotation_rig_to_camera"] = np.round(exterior["rotation_rig_to_camera"], 6).tolist()

    for camera, exact in zip(read_station(altered(station=rounded)).cameras, read_station(sample).cameras, strict=True):
        assert np.abs(camera.rotation @ camera.rotation.T - np.eye(3)).max() < 1e-12
        assert np.linalg.det(camera.rotation) == pytest.approx(1.0)
        assert np.abs(camera.rotation - exact.rotation).max() < 2e-6


@pytest.mark.parametrize("count", [1, 3, 6, 15])
def test_number_of_coefficients_that_opencv_does_not_know_is_refused(tmp_path, count):
    station = small_station(tmp_path, [ramp(np.uint8, 0.05)] * 2)
    data = json.loads(station.source.read_text(encoding="utf-8"))
    data["cameras"][1]["interior"]["distortion"] = [0.01] * count
    station.source.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_station(tmp_path)
    assert error.value.key == "cameras[1].interior.distortion"


def test_station_is_found_by_its_folder_and_by_its_file(sample):
    assert read_station(sample).source == read_station(sample / "station.json").source == sample / "station.json"


def test_camera_is_found_by_its_name(sample):
    station = read_station(sample)
    assert [station.camera_index(name) for name in ("left", "top", "middle")] == [0, 2, None]


def test_models_are_kept_apart(tmp_path, sample):
    image = ramp(np.uint8, 0.05)
    assert isinstance(small_station(tmp_path, [image, image]).cameras[0].interior, OpenCVInterior)
    assert not isinstance(read_station(sample).cameras[0].interior, OpenCVInterior)
