# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kalibr's chains of cameras against the formulas of its documentation."""

import numpy as np
import pytest
import yaml
from conversions import convert, refuse
from foreign import HEIGHT, WIDTH, assert_agrees, kalibr_equidistant, kalibr_fov, opencv_lens, poses

from pipeworkbench.recon.station import read_station

INTRINSICS = [1100.0, 1090.0, 640.5, 500.25]
RADTAN = [-0.23, 0.09, 0.004, -0.006]
EQUIDISTANT = [-0.02, 0.01, -0.005, 0.001]
NAMES = ("0.png", "1.png", "2.png", "3.png")


def matrix():
    fu, fv, pu, pv = INTRINSICS
    return [[fu, 0, pu], [0, fv, pv], [0, 0, 1]]


def chain(rig, model="radtan", coefficients=RADTAN):
    data = {}
    for index, pose in enumerate(rig):
        data[f"cam{index}"] = {
            "camera_model": "pinhole",
            "intrinsics": INTRINSICS,
            "distortion_model": model,
            "distortion_coeffs": coefficients,
            "resolution": [WIDTH, HEIGHT],
            "rostopic": f"/cam{index}/image_raw",
            "cam_overlaps": [0, 1],
        }
        if index:
            data[f"cam{index}"]["T_cn_cnm1"] = (pose.matrix @ np.linalg.inv(rig[index - 1].matrix)).tolist()
    return data


@pytest.fixture
def camchain(tmp_path):
    """Give a function that writes a chain, changed by a function, as camchain.yaml."""

    def write(change=None, count=3, **options):
        data = chain(poses(count), **options)
        if change is not None:
            change(data)
        file = tmp_path / "camchain.yaml"
        # lists are copied, so that PyYAML makes no aliases of them
        text = yaml.dump(data, Dumper=NoAliases)
        file.write_text(text, encoding="utf-8")
        return file

    return write


class NoAliases(yaml.SafeDumper):
    def ignore_aliases(self, _data):
        return True


@pytest.mark.parametrize("count", [2, 3, 4])
def test_chain_of_cameras_projects_like_opencv(camchain, tmp_path, count):
    station = convert(tmp_path, camchain(count=count), NAMES[:count], named=False)
    assert_agrees(station, poses(count), [opencv_lens(matrix(), RADTAN)] * count)


def test_metres_become_millimetres_without_being_told(camchain, tmp_path):
    station = read_station(convert(tmp_path, camchain(), NAMES[:3], named=False))
    expected = [1000 * np.linalg.norm(pose.centre - poses()[0].centre) for pose in poses()]
    assert [np.linalg.norm(camera.projection_centre) for camera in station.cameras] == pytest.approx(expected)


def test_camera_without_distortion_is_a_pinhole(camchain, tmp_path):
    station = convert(tmp_path, camchain(model="none", coefficients=[]), NAMES[:3], named=False)
    assert_agrees(station, poses(), [opencv_lens(matrix(), np.zeros(4))] * 3)


@pytest.mark.parametrize(
    ("model", "coefficients", "lens"),
    [
        ("equidistant", EQUIDISTANT, kalibr_equidistant(*INTRINSICS, *EQUIDISTANT)),
        ("fov", [0.7], kalibr_fov(*INTRINSICS, 0.7)),
    ],
)
def test_other_lens_is_approximated_within_a_hundredth_of_a_pixel(camchain, tmp_path, caplog, model, coefficients, lens):
    station = convert(tmp_path, camchain(model=model, coefficients=coefficients), NAMES[:3], named=False)
    assert_agrees(station, poses(), [lens] * 3, tolerance=0.01)
    assert "camera 'cam2': lens model approximated" in caplog.text


def test_chosen_cameras_keep_their_place_in_the_chain(camchain, tmp_path):
    file = camchain(lambda data: data["cam1"].update(camera_model="omni"), count=4)
    station = read_station(convert(tmp_path, file, NAMES[:2], named=False, cameras=["cam3", "cam0"]))
    rig = poses(4)
    assert [camera.name for camera in station.cameras] == ["cam3", "cam0"]
    relative = station.cameras[1].rotation @ station.cameras[0].rotation.T
    assert np.abs(relative - rig[0].rotation @ rig[3].rotation.T).max() < 1e-12
    base = np.linalg.norm(station.cameras[1].projection_centre)
    assert base == pytest.approx(1000 * np.linalg.norm(rig[3].centre - rig[0].centre))


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        (lambda d: d.pop("cam1"), "cam1", "chain is broken"),
        (lambda d: d["cam1"].pop("T_cn_cnm1"), "cam1.T_cn_cnm1", "is missing"),
        (lambda d: d["cam1"].pop("intrinsics"), "cam1.intrinsics", "is missing"),
        (lambda d: d["cam0"].update(camera_model="omni"), "cam0.camera_model", "'omni' is not supported"),
        (lambda d: d["cam2"].update(distortion_model="warped"), "cam2.distortion_model", "'warped' is not supported"),
        (lambda d: d["cam0"].update(distortion_coeffs=[0.1]), "cam0.distortion_coeffs", "has 1 numbers where 4 belong"),
        (lambda d: d["cam0"].update(intrinsics=[0.0, 1, 2, 3]), "cam0.intrinsics", "focal length is not positive"),
        (lambda d: d["cam0"].update(intrinsics=[float("nan"), 1, 2, 3]), "cam0.intrinsics", "not a number"),
        (lambda d: d["cam0"].update(intrinsics="many"), "cam0.intrinsics", "not a list"),
        (lambda d: d["cam0"].update(resolution=[0, 5]), "cam0.resolution", "not an image's size"),
        (lambda d: d["cam1"].update(T_cn_cnm1=[[1, 0, 0, 0]] * 4), "cam1.T_cn_cnm1", "last row"),
        (lambda d: d["cam1"].update(T_cn_cnm1=np.diag([1.0, 2, 1, 1]).tolist()), "cam1.T_cn_cnm1", "not orthonormal"),
        (lambda d: d["cam1"].update(T_cn_cnm1=np.diag([1.0, 1, -1, 1]).tolist()), "cam1.T_cn_cnm1", "reflection"),
        (lambda d: d["cam1"].update(T_cn_cnm1=[[1, 0, 0]]), "cam1.T_cn_cnm1", "four rows"),
        (lambda d: d.update(cam1=5), "cam1", "is not a camera"),
        (lambda d: [d.pop(name) for name in ("cam1", "cam2")], "cameras", "two oriented cameras"),
    ],
)
def test_wrong_value_is_refused_with_its_key(camchain, change, key, problem):
    file = camchain(change)
    refuse(file, file, key, problem)


def test_lens_beyond_what_is_supported_is_refused_with_the_deviation(camchain):
    file = camchain(model="fov", coefficients=[2.9])
    error = refuse(file, file, "cam0.distortion_model (fov)", "")
    assert "deviates by up to" in error.problem or "no ray" in error.problem
    assert "radtan" in error.remedy
