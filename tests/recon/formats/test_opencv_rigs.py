# SPDX-License-Identifier: LGPL-2.1-or-later
"""OpenCV's stereo calibrations: files that FileStorage itself has written, against OpenCV's own projection."""

import json
from pathlib import Path

import cv2
import foreign
import numpy as np
import pytest
from conversions import convert, refuse
from foreign import HEIGHT, WIDTH, assert_agrees, opencv_lens

from pipeworkbench.recon.formats import opencv
from pipeworkbench.recon.station import read_station

M1 = np.array([[1100.0, 0, 640.5], [0, 1090, 500.25], [0, 0, 1]])
M2 = np.array([[1120.0, 0, 660.5], [0, 1115, 470.25], [0, 0, 1]])
DISTORTIONS = {
    4: [-0.23, 0.09, 0.004, -0.006],
    5: [-0.23, 0.09, 0.004, -0.006, -0.02],
    8: [0.21, 0.05, 0.004, -0.006, 0.02, 0.45, 0.08, 0.01],
    12: [0.21, 0.05, 0.004, -0.006, 0.02, 0.45, 0.08, 0.01, 0.003, -0.001, -0.002, 0.0015],
    14: [0.21, 0.05, 0.004, -0.006, 0.02, 0.45, 0.08, 0.01, 0.003, -0.001, -0.002, 0.0015, 0.02, -0.03],
}
NAMES = ("left.png", "right.png")
SQUARES_MM = 30.0  # what one unit of T is in these tests


def stereo():
    """Two poses (m) and R, T of x2 = R x1 + T in units of board squares."""
    rig = foreign.poses(2)
    rotation = rig[1].rotation @ rig[0].rotation.T
    translation = (rig[1].translation - rotation @ rig[0].translation) * 1000 / SQUARES_MM
    return rig, rotation, translation


def store(path, values):
    """Write a FileStorage with OpenCV."""
    writer = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for key, value in values.items():
        writer.write(key, np.array(value, float) if isinstance(value, list) else value)
    writer.release()
    return path


def mirrored(distortion):
    """Return another lens: its decentring the other way."""
    return [*distortion[:2], -distortion[2], -distortion[3], *distortion[4:]]


def calibration(distortion=DISTORTIONS[5]):
    _, rotation, translation = stereo()
    return {
        "cameraMatrix1": M1,
        "distCoeffs1": np.array([distortion]),
        "cameraMatrix2": M2,
        "distCoeffs2": np.array([mirrored(distortion)]),
        "R": rotation,
        "T": translation[:, None],
    }


def lenses(distortion=DISTORTIONS[5]):
    return [opencv_lens(M1, distortion), opencv_lens(M2, mirrored(distortion))]


@pytest.mark.parametrize("ending", ["yml", "xml", "json"])
@pytest.mark.parametrize("count", DISTORTIONS)
def test_projection_agrees_with_opencv(tmp_path, ending, count):
    file = store(tmp_path / f"stereo.{ending}", calibration(DISTORTIONS[count]))
    station = convert(tmp_path, file, NAMES, named=False, scale=SQUARES_MM)
    assert_agrees(station, stereo()[0], lenses(DISTORTIONS[count]))


@pytest.mark.parametrize(
    "names",
    [
        ("M1", "D1", "M2", "D2"),
        ("K1", "D1", "K2", "D2"),
        ("K1", "dist1", "K2", "dist2"),
        ("camera_matrix_left", "dist_coeffs_left", "camera_matrix_right", "dist_coeffs_right"),
        ("left_camera_matrix", "left_distortion_coefficients", "right_camera_matrix", "right_distortion_coefficients"),
        ("cameraMatrixL", "distCoeffsL", "cameraMatrixR", "distCoeffsR"),
        ("CAMERAMATRIX1", "DISTCOEFFS1", "CAMERAMATRIX2", "DISTCOEFFS2"),
        ("camera_matrix_0", "dist_coeffs_0", "camera_matrix_1", "dist_coeffs_1"),
    ],
    ids=lambda names: names[0],
)
def test_common_spellings_of_the_keys_are_known(tmp_path, names):
    values = calibration()
    old = ("cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2")
    renamed = {new: values[key] for key, new in zip(old, names, strict=True)} | {"R": values["R"], "T": values["T"]}
    station = convert(tmp_path, store(tmp_path / "stereo.yml", renamed), NAMES, named=False, scale=SQUARES_MM)
    assert_agrees(station, stereo()[0], lenses())


def test_intrinsics_and_extrinsics_beside_each_other_are_one_calibration(tmp_path):
    # OpenCV's example stereo_calib writes these two files
    values = calibration()
    store(tmp_path / "intrinsics.yml", {"M1": M1, "D1": values["distCoeffs1"], "M2": M2, "D2": values["distCoeffs2"]})
    store(tmp_path / "extrinsics.yml", {"R": values["R"], "T": values["T"], "R1": np.eye(3), "R2": np.eye(3), "P1": np.eye(3, 4), "Q": np.eye(4)})
    for name in ("intrinsics.yml", "extrinsics.yml"):
        assert_agrees(convert(tmp_path, tmp_path / name, NAMES, named=False, scale=SQUARES_MM), stereo()[0], lenses())
    assert {file.name for file in opencv.read(tmp_path / "intrinsics.yml").files} == {"intrinsics.yml", "extrinsics.yml"}


def test_plain_json_of_nested_lists_and_a_rotation_vector_are_read(tmp_path):
    values = {key: np.asarray(value).tolist() for key, value in calibration().items()}
    values["R"] = cv2.Rodrigues(stereo()[1])[0].ravel().tolist()
    values["T"] = stereo()[2].tolist()
    values |= {"k1": -0.23, "k2": 0.09}  # scalars that are not camera matrices
    file = tmp_path / "stereo.json"
    file.write_text(json.dumps({"result": values}), encoding="utf-8")
    assert_agrees(convert(tmp_path, file, NAMES, named=False, scale=SQUARES_MM), stereo()[0], lenses())


@pytest.mark.parametrize(
    "size",
    [{"imageSize": [WIDTH, HEIGHT]}, {"image_size": [WIDTH, HEIGHT]}, {"image_width": WIDTH, "image_height": HEIGHT}, {"size": [WIDTH, HEIGHT]}, {}],
    ids=lambda size: "+".join(size) or "none",
)
@pytest.mark.parametrize("ending", ["yml", "xml", "json"])
def test_image_size_comes_from_the_file_or_else_from_the_photographs(tmp_path, size, ending):
    file = tmp_path / f"stereo.{ending}"
    writer = cv2.FileStorage(str(file), cv2.FILE_STORAGE_WRITE)
    for key, value in calibration().items():
        writer.write(key, value)
    for key, value in size.items():
        if isinstance(value, list):
            writer.startWriteStruct(key, cv2.FileNode_SEQ)
            for side in value:
                writer.write("", side)
            writer.endWriteStruct()
        else:
            writer.write(key, value)
    writer.release()
    known = opencv.read(file).views[0].interior
    assert (known.width, known.height) == ((WIDTH, HEIGHT) if size else (0, 0))
    interior = read_station(convert(tmp_path, file, NAMES, named=False, scale=SQUARES_MM)).cameras[1].interior
    assert (interior.width, interior.height) == (WIDTH, HEIGHT)


def test_second_camera_can_be_the_reference(tmp_path):
    file = store(tmp_path / "stereo.yml", calibration())
    station = convert(tmp_path, file, ("b.png", "a.png"), named=False, cameras=["camera2", "camera1"], scale=SQUARES_MM)
    rig = stereo()[0][::-1]
    assert_agrees(station, rig, lenses()[::-1])


@pytest.mark.parametrize("version", ["v1", "v2"])
def test_real_calibration_is_converted_with_its_photographs(shared, tmp_path, version):
    from pipeworkbench.recon.formats.conversion import convert_rig

    folder = shared / "real" / "charuco" / "calibration"
    images = [folder / "v1" / side / "000.jpg" for side in ("left", "right")]
    output = tmp_path / "station.json"
    convert_rig(opencv.read(folder / version / "calibration.yml"), output, images=images, scale=1.0)
    station = read_station(output)
    assert [camera.name for camera in station.cameras] == ["left", "right"]
    base = np.linalg.norm(station.cameras[1].projection_centre)
    storage = cv2.FileStorage(str(folder / version / "calibration.yml"), cv2.FILE_STORAGE_READ)
    values = storage.getNode("calibration")
    assert base == pytest.approx(np.linalg.norm(values.getNode("T").mat()), abs=1e-9)
    if version == "v1":
        assert base == pytest.approx(75.3, abs=0.1)  # as the calibration's documentation has it
    assert [(camera.interior.width, camera.interior.height) for camera in station.cameras] == [(640, 480)] * 2
    # x2 = R x1 + T, projected by OpenCV into the right photograph
    rng = np.random.default_rng(1)
    left = rng.uniform([-100, -80, 500], [100, 80, 900], (50, 3))
    rotation, translation = values.getNode("R").mat(), values.getNode("T").mat()
    matrix, distortion = values.getNode("camera_matrix_right").mat(), values.getNode("dist_coeffs_right").mat()
    expected = cv2.projectPoints(left, cv2.Rodrigues(rotation)[0], translation, matrix, distortion)[0][:, 0]
    found = station.cameras[1].project(left @ station.cameras[0].rotation)
    assert np.nanmax(np.abs(found - expected)) < 1e-6


# ---------------------------------------------------------------- refused


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        ({"cameraMatrix1": np.eye(2)}, "cameraMatrix1", "is 2 x 2"),
        ({"cameraMatrix2": M2 * [[0], [1], [1]]}, "cameraMatrix2", "focal length is not positive"),
        ({"cameraMatrix1": M1 + np.array([[0, 5, 0], [0, 0, 0], [0, 0, 0]])}, "cameraMatrix1", "not of the form"),
        ({"cameraMatrix1": M1.T.copy()}, "cameraMatrix1", "not of the form"),
        ({"cameraMatrix1": M1 * np.nan}, "cameraMatrix1", "not a"),
        ({"distCoeffs1": np.zeros((1, 7))}, "distCoeffs1", "has 7 coefficients"),
        ({"distCoeffs2": None}, "distCoeffs2", "no distortion coefficients"),
        ({"cameraMatrix2": None}, "cameraMatrix1", "is missing"),
        ({"R": None}, "R", "is missing"),
        ({"T": None}, "T", "is missing"),
        ({"R": 2 * np.eye(3)}, "R", "not orthonormal"),
        ({"R": np.diag([1.0, 1.0, -1.0])}, "R", "a reflection"),
        ({"R": np.eye(4)}, "R", "16 numbers"),
        ({"T": np.zeros((2, 1))}, "T", "2 numbers"),
        ({"imageSize": "wide"}, "imageSize", "not a list of numbers"),
        ({"distortion_model": "equidistant"}, "distortion_model", "'equidistant' is not supported"),
    ],
)
def test_wrong_value_is_refused_with_its_key(tmp_path, change, key, problem):
    values = {name: value for name, value in (calibration() | change).items() if value is not None}
    file = store(tmp_path / "stereo.yml", values)
    refuse(file, file, key, problem)


def test_matrix_whose_count_is_wrong_is_refused(tmp_path):
    file = store(tmp_path / "stereo.yml", calibration())
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("rows: 3", "rows: 300000000000", 1), encoding="utf-8")
    refuse(file, file, "cameraMatrix1.data", "has 9 numbers where 3e+11 x 3 belong")


def test_file_without_a_calibration_is_refused(tmp_path):
    file = store(tmp_path / "other.yml", {"something": np.eye(3)})
    refuse(file, file, "cameraMatrix1", "no two camera matrices")


def test_doubled_key_in_xml_is_refused(tmp_path):
    file = store(tmp_path / "stereo.xml", calibration())
    text = file.read_text(encoding="utf-8")
    start, end = text.index("<R "), text.index("</R>") + 4
    file.write_text(text[:end] + text[start:end] + text[end:], encoding="utf-8")
    refuse(file, file, "R", "given twice")


def test_gap_in_the_pair_of_files_is_explained(tmp_path):
    values = calibration()
    file = store(Path(tmp_path / "intrinsics.yml"), {key: values[key] for key in values if key not in ("R", "T")})
    assert "extrinsics" in refuse(file, file, "R", "is missing").remedy
