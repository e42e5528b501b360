# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a rig to a station: unit, vertical, photographs, names, and what is refused on the way."""

import json
import logging
from pathlib import Path

import foreign
import numpy as np
import pytest
from foreign import COLMAP, HEIGHT, WIDTH, poses, write_colmap_text
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import OpenCVInterior
from pipeworkbench.recon.formats.conversion import convert_rig, level_axes
from pipeworkbench.recon.formats.recognition import read_rig, recognise
from pipeworkbench.recon.formats.rig import Rig, View, select
from pipeworkbench.recon.station import Station, read_station, write_station

NAMES = ("left.png", "right.png", "top.png")
ANGLE = st.floats(-180, 180)
FILES = [f"{name}.png" for name in foreign.NAMES]


@pytest.fixture
def model(tmp_path):
    """A COLMAP model as its users have it: photographs in images, the model in sparse/0."""
    foreign.photographs(tmp_path / "project" / "images", NAMES)
    images = [(pose, 7, name) for pose, name in zip(poses(), NAMES, strict=True)]
    return write_colmap_text(tmp_path / "project" / "sparse" / "0", {7: ("RADIAL", COLMAP["RADIAL"])}, images)


def rig_of(rotations, centres, **changes):
    interior = OpenCVInterior(WIDTH, HEIGHT, 1000.0, 1000.0, 600.0, 500.0)
    views = tuple(
        View(f"view{i}", None, interior, np.asarray(r, float), np.asarray(c, float)) for i, (r, c) in enumerate(zip(rotations, centres, strict=True))
    )
    values = {"format": "opencv", "source": Path("rig"), "views": views, "millimetres_per_unit": 1.0, "up": None, "files": ()}
    return Rig(**(values | changes))


# ---------------------------------------------------------------- level frame


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(ANGLE, ANGLE))
def test_level_frame_is_a_rotation_with_z_up_and_the_camera_looking_along_y(camera, vertical):
    rotation = Rotation.from_euler("xyz", camera, degrees=True).as_matrix()
    up = Rotation.from_euler("xy", vertical, degrees=True).as_matrix()[2]
    level = level_axes(rotation, up)
    assert np.abs(level @ level.T - np.eye(3)).max() < 1e-12
    assert np.linalg.det(level) == pytest.approx(1)
    assert level @ up == pytest.approx([0, 0, 1], abs=1e-12)
    x, y, _ = level @ rotation[2]
    if abs(rotation[2] @ up) < np.sin(np.radians(89)):
        assert x == pytest.approx(0, abs=1e-12)
        assert y > 0


@pytest.mark.parametrize("pitch", [-90, -89.5, -60, 0, 60, 89.5, 90])
def test_right_stays_right_when_a_camera_looks_up_or_down(pitch):
    # camera axes: x right, y down, z forward; the world is level already
    looking_forward = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    rotation = Rotation.from_euler("x", pitch, degrees=True).as_matrix() @ looking_forward
    assert np.abs(level_axes(rotation, np.array([0.0, 0, 1])) - np.eye(3)).max() < 1e-12


def test_vertical_is_the_mean_of_the_cameras_upward_axes_and_said_to_be(model, tmp_path, caplog):
    output = tmp_path / "station.json"
    convert_rig(read_rig(model), output, scale=1000.0)
    assert "vertical is not known" in caplog.text
    assert "--up" in caplog.text
    station = read_station(output)
    upward = -np.mean([camera.rotation[1] for camera in station.cameras], axis=0)
    assert upward / np.linalg.norm(upward) == pytest.approx([0, 0, 1], abs=1e-12)
    assert station.cameras[0].rotation[2, 0] == pytest.approx(0, abs=1e-12)
    assert station.cameras[0].rotation[2, 1] > 0.9


def test_given_vertical_is_taken_without_a_warning(model, tmp_path, caplog):
    up = foreign.mean_up(poses()) + np.array([0.05, -0.1, 0.02])
    output = tmp_path / "station.json"
    convert_rig(read_rig(model), output, scale=1000.0, up=up * 17)
    assert caplog.text == ""
    foreign.assert_agrees(output, poses(), [foreign.colmap_lens("RADIAL", COLMAP["RADIAL"])] * 3, up=up / np.linalg.norm(up))


def test_vertical_that_the_cameras_contradict_is_doubted(model, tmp_path, caplog):
    convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0, up=-foreign.mean_up(poses()))
    assert "180 deg off the cameras' upward axes" in caplog.text


def test_opposite_cameras_need_a_vertical(tmp_path):
    rig = rig_of([np.eye(3), np.diag([-1.0, -1.0, 1.0])], [[0, 0, 0], [600, 0, 0]])
    with pytest.raises(InputError, match=r"opposite directions; give the vertical .* --up"):
        convert_rig(rig, tmp_path / "station.json", images=foreign.photographs(tmp_path, ["a.png", "b.png"]))


@pytest.mark.parametrize("up", [(0, 0, 0), (float("nan"), 0, 1), (float("inf"), 0, 1), (1e200, 1e200, 1e200), (0, 1)])
def test_vertical_that_is_no_direction_is_refused(model, tmp_path, up):
    with pytest.raises(InputError) as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1.0, up=up)
    assert error.value.key == "--up"


# ---------------------------------------------------------------- unit


def test_missing_unit_is_refused_with_the_reason(model, tmp_path):
    with pytest.raises(InputError, match="depths and diameters would be wrong; give --unit") as error:
        convert_rig(read_rig(model), tmp_path / "station.json")
    assert error.value.source == str(model)
    assert not (tmp_path / "station.json").exists()


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), float("inf")])
def test_scale_that_is_none_is_refused(model, tmp_path, scale):
    with pytest.raises(InputError) as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=scale)
    assert error.value.key == "--scale"


@pytest.mark.parametrize("scale", [1e-3, 1e8])
def test_scale_that_makes_a_nonsensical_base_is_refused(model, tmp_path, scale):
    with pytest.raises(InputError, match="from the first; check --unit"):
        convert_rig(read_rig(model), tmp_path / "station.json", scale=scale)


# ---------------------------------------------------------------- photographs


@pytest.mark.parametrize("place", ["station.json", "stations/A/station.json", "project/images/station.json"])
def test_photographs_are_named_relative_to_the_station(model, tmp_path, place):
    output = tmp_path / place
    output.parent.mkdir(parents=True, exist_ok=True)
    convert_rig(read_rig(model), output, scale=1000.0)
    names = [camera["image"] for camera in json.loads(output.read_text(encoding="utf-8"))["cameras"]]
    up = "../" * (len(Path(place).parts) - 1)
    expected = "" if place.startswith("project") else f"{up}project/images/"
    assert names == [f"{expected}{name}" for name in NAMES]
    assert [image.resolve() for image in read_station(output).images] == [tmp_path / "project" / "images" / name for name in NAMES]


def test_way_up_through_a_link_leads_to_the_photographs(model, tmp_path):
    (tmp_path / "deep" / "deeper").mkdir(parents=True)
    (tmp_path / "short").symlink_to(tmp_path / "deep" / "deeper")
    convert_rig(read_rig(model), tmp_path / "short" / "station.json", scale=1000.0)
    assert all(image.is_file() for image in read_station(tmp_path / "short").images)


def test_folder_of_photographs_may_lie_elsewhere(model, tmp_path):
    (tmp_path / "project" / "images").rename(tmp_path / "elsewhere")
    output = tmp_path / "station.json"
    with pytest.raises(InputError, match=r"left.png, right.png, top.png are not in .*--image-folder") as error:
        convert_rig(read_rig(model), output, scale=1000.0)
    assert (error.value.source, error.value.key) == (str(model), "images")
    convert_rig(read_rig(model), output, scale=1000.0, image_folder=tmp_path / "elsewhere")
    assert len(read_station(output).images) == 3


def test_given_photographs_come_before_the_names_in_the_file(model, tmp_path):
    others = foreign.photographs(tmp_path / "new", ["a.png", "b.png", "c.png"])
    output = tmp_path / "station.json"
    convert_rig(read_rig(model), output, scale=1000.0, images=others)
    assert [image.name for image in read_station(output).images] == ["a.png", "b.png", "c.png"]


def test_wrong_number_of_photographs_is_refused(model, tmp_path):
    with pytest.raises(InputError, match=r"names 1 photographs for 3 cameras \(left.png, right.png, top.png\)"):
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1.0, images=[tmp_path / "a.png"])


def test_photograph_of_another_size_is_refused_with_both_sizes(model, tmp_path):
    images = foreign.photographs(tmp_path / "new", ["a.png", "b.png", "c.png"], WIDTH // 2, HEIGHT // 2)
    with pytest.raises(InputError, match=r"is 648 x 486 pixels, .* 'left.png' for 1296 x 972") as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0, images=images)
    assert error.value.source == str(images[0])


@pytest.mark.parametrize("content", [b"", b"no picture", b"\x89PNG\r\n\x1a\n"], ids=["empty", "text", "torn"])
def test_photograph_that_is_none_is_refused(model, tmp_path, content):
    file = tmp_path / "project" / "images" / "right.png"
    file.write_bytes(content)
    with pytest.raises(InputError, match="not a photograph") as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0)
    assert error.value.source == str(file)


def test_one_photograph_for_two_cameras_is_refused_in_the_inputs_words(model, tmp_path):
    images = foreign.photographs(tmp_path / "new", ["a.png", "b.png"])
    with pytest.raises(InputError) as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0, images=[*images, images[0]])
    assert error.value.source == str(model)
    assert error.value.key.startswith("camera 'top.png'")
    assert not (tmp_path / "station.json").exists()


def test_lens_that_folds_the_image_is_refused_in_the_inputs_words(model, tmp_path):
    file = model / "cameras.txt"
    file.write_text(file.read_text(encoding="utf-8").replace("-0.23", "-2.3"), encoding="utf-8")
    with pytest.raises(InputError, match="folds or tears") as error:
        convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0)
    assert error.value.source == str(model)
    assert error.value.key == "camera 'left.png'.interior"
    assert list(tmp_path.glob("*.json")) == list(tmp_path.glob(".*")) == []


# ---------------------------------------------------------------- selection and recognition


def test_cameras_are_chosen_by_full_or_short_names():
    names = ["a/left.jpg", "b/left.jpg", "b/right.jpg"]
    assert select(names, None, Path("rig")) == [0, 1, 2]
    assert select(names, ["right", "a/left"], Path("rig")) == [2, 0]
    assert select(names, ["b/left.jpg", "right.jpg"], Path("rig")) == [1, 2]


@pytest.mark.parametrize(
    ("wanted", "problem"),
    [
        (["left", "right"], "name of 2 cameras"),
        (["top", "right"], "no oriented camera 'top'"),
        (["right", "right.jpg"], "names a camera twice"),
        (["right"], "needs two oriented cameras"),
    ],
)
def test_choice_that_does_not_fit_is_refused(wanted, problem):
    with pytest.raises(InputError, match=problem):
        select(["a/left.jpg", "b/left.jpg", "b/right.jpg"], wanted, Path("rig"))


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("camchain.yaml", "cam0:\n  camera_model: pinhole\n", "kalibr"),
        ("x.yaml", "# chain\r\ncam0 :\r\n  camera_model: pinhole\r\n", "kalibr"),
        ("stereo.yml", "%YAML:1.0\n---\nM1: !!opencv-matrix\n", "opencv"),
        ("stereo.xml", '<?xml version="1.0"?>\n<opencv_storage>\n', "opencv"),
        ("stereo.json", '\ufeff{"M1": 1}', "opencv"),
        ("cameras.xml", '<?xml version="1.0"?>\n<!-- <opencv_storage> -->\n<document version="2.0.0">', "metashape"),
        ("calibration.xml", "<calibration>", "metashape"),
        ("images.txt", "1 1 0 0 0 0 0 0 1 a.png", "colmap"),
        ("cameras.bin", "", "colmap"),
    ],
)
def test_format_is_recognised_by_its_content(tmp_path, name, content, expected):
    (tmp_path / name).write_text(content, encoding="utf-8")
    assert recognise(tmp_path / name) == expected


@pytest.mark.parametrize(
    ("content", "problem"), [(b"\xff\xd8\xff\xe0 a photograph", "format is not known"), (b"<svg>", "XML is not known"), (b"", "not known")]
)
def test_other_files_are_refused_with_what_is_supported(tmp_path, content, problem):
    file = tmp_path / "file"
    file.write_bytes(content)
    with pytest.raises(InputError, match=f"{problem}.*OpenCV.*COLMAP.*Metashape.*Kalibr"):
        recognise(file)


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        recognise(tmp_path / "nowhere.yml")


# ---------------------------------------------------------------- the writer


def test_station_survives_being_written_and_read(sample, tmp_path):
    original = read_station(sample)
    output = tmp_path / "station.json"
    write_station(original, output)
    again = read_station(output)
    assert again.name == original.name
    assert [image.resolve() for image in again.images] == [image.resolve() for image in original.images]
    points = np.random.default_rng(2).uniform([-1500, 3000, -1000], [1500, 8000, 1500], (500, 3))
    for camera, before in zip(again.cameras, original.cameras, strict=True):
        assert camera.name == before.name
        assert np.nanmax(np.abs(camera.project(points) - before.project(points))) < 1e-6
        assert (np.isfinite(camera.project(points)) == np.isfinite(before.project(points))).all()


def test_station_that_could_not_be_read_is_not_written(sample, tmp_path):
    original = read_station(sample)
    output = tmp_path / "station.json"
    output.write_text("what was there before", encoding="utf-8")
    with pytest.raises(InputError) as error:
        write_station(Station("", original.cameras, original.images, original.source), output)
    assert (error.value.source, error.value.key) == (str(output), "name")
    assert output.read_text(encoding="utf-8") == "what was there before"
    assert [file.name for file in tmp_path.iterdir()] == ["station.json"]


def test_nothing_is_logged_where_nothing_is_uncertain(model, tmp_path, caplog):
    caplog.set_level(logging.INFO)
    convert_rig(read_rig(model), tmp_path / "station.json", scale=1000.0, up=foreign.mean_up(poses()))
    assert caplog.text == ""
