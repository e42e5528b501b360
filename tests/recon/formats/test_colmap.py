# SPDX-License-Identifier: LGPL-2.1-or-later
"""COLMAP's models, text and binary, against the projections of COLMAP's formulas."""

import contextlib
import struct

import foreign
import numpy as np
import pytest
from conversions import convert, refuse
from foreign import COLMAP, HEIGHT, WIDTH, assert_agrees, colmap_lens, poses, write_colmap_binary, write_colmap_text
from hypothesis import given
from hypothesis import strategies as st

from pipeworkbench.errors import InputError
from pipeworkbench.recon.formats import colmap
from pipeworkbench.recon.station import read_station

EXACT = [model for model in COLMAP if not model.endswith("FISHEYE") and model != "FOV"]
FISHEYES = [model for model in COLMAP if model not in EXACT]
WRITERS = {"text": write_colmap_text, "binary": write_colmap_binary}


def images_of(rig, camera=7):
    return [(pose, camera, f"{name}.png") for pose, name in zip(rig, foreign.NAMES, strict=False)]


@pytest.mark.parametrize("kind", WRITERS)
@pytest.mark.parametrize("model", EXACT)
def test_projection_agrees_with_colmaps_formula(tmp_path, model, kind):
    rig = poses()
    folder = WRITERS[kind](tmp_path / "sparse", {7: (model, COLMAP[model])}, images_of(rig))
    station = convert(tmp_path, folder, scale=1000.0)
    assert_agrees(station, rig, [colmap_lens(model, COLMAP[model])] * 3)
    assert [camera.name for camera in read_station(station).cameras] == ["left", "right", "top"]


@pytest.mark.parametrize("model", FISHEYES)
def test_fisheye_is_approximated_within_a_hundredth_of_a_pixel(tmp_path, model, caplog):
    rig = poses()
    folder = write_colmap_text(tmp_path / "sparse", {7: (model, COLMAP[model])}, images_of(rig))
    station = convert(tmp_path, folder, scale=1000.0)
    assert_agrees(station, rig, [colmap_lens(model, COLMAP[model])] * 3, tolerance=0.01)
    assert "largest deviation" in caplog.text


def test_centre_of_the_first_pixel_is_half_a_pixel_in_colmap_and_zero_here(tmp_path):
    folder = write_colmap_text(tmp_path / "sparse", {7: ("PINHOLE", (1000.0, 1000.0, WIDTH / 2, HEIGHT / 2))}, images_of(poses()))
    interior = colmap.read(folder).views[0].interior
    # the image's centre: half its size from the corner, (n - 1) / 2 where centres are integers
    assert (interior.cx, interior.cy) == ((WIDTH - 1) / 2, (HEIGHT - 1) / 2)


def test_each_image_has_the_interior_of_its_own_camera(tmp_path):
    rig = poses(4)
    models = ["RADIAL", "PINHOLE", "OPENCV", "SIMPLE_RADIAL"]
    cameras = {10 + i: (model, COLMAP[model]) for i, model in enumerate(models)}
    names = ["a.png", "b.png", "c.png", "d.png"]
    images = [(pose, 10 + i, name) for i, (pose, name) in enumerate(zip(rig, names, strict=True))]
    for kind, write in WRITERS.items():
        station = convert(tmp_path, write(tmp_path / kind, cameras, images), names, scale=1000.0)
        assert_agrees(station, rig, [colmap_lens(model, COLMAP[model]) for model in models])


@pytest.mark.parametrize(
    "observed", ["\n", "10.5 20.5 -1 30.25 40.0 17\n", "\n\n# a comment between two images\n\n"], ids=["none", "two", "comments"]
)
def test_points_blank_lines_and_comments_are_skipped(tmp_path, observed):
    folder = write_colmap_text(tmp_path / "sparse", {7: ("PINHOLE", COLMAP["PINHOLE"])}, images_of(poses()), observed)
    assert [view.image for view in colmap.read(folder).views] == ["left.png", "right.png", "top.png"]


def test_last_image_needs_no_line_of_points(tmp_path):
    folder = write_colmap_text(tmp_path / "sparse", {7: ("PINHOLE", COLMAP["PINHOLE"])}, images_of(poses()))
    text = (folder / "images.txt").read_text(encoding="utf-8").rstrip("\n")
    (folder / "images.txt").write_text(text, encoding="utf-8")
    assert len(colmap.read(folder).views) == 3


def test_names_with_spaces_and_folders_are_kept_and_shortened(tmp_path):
    images = [(pose, 7, name) for pose, name in zip(poses(), ("cam 1/shot 1.png", "cam 2/shot 2.png", "cam 3/shot 3.png"), strict=True)]
    for kind, write in WRITERS.items():
        folder = write(tmp_path / kind, {7: ("RADIAL", COLMAP["RADIAL"])}, images)
        station = read_station(convert(tmp_path, folder, [name for _, _, name in images], scale=1000.0))
        assert [camera.name for camera in station.cameras] == ["shot 1", "shot 2", "shot 3"]
        assert station.images[1].parts[-2:] == ("cam 2", "shot 2.png")


def test_same_file_name_in_several_folders_keeps_the_folder(tmp_path):
    names = ["cam1/0.png", "cam2/0.png", "cam3/0.png"]
    images = [(pose, 7, name) for pose, name in zip(poses(), names, strict=True)]
    folder = write_colmap_text(tmp_path / "sparse", {7: ("RADIAL", COLMAP["RADIAL"])}, images)
    station = read_station(convert(tmp_path, folder, names, scale=1000.0))
    assert [camera.name for camera in station.cameras] == ["cam1/0", "cam2/0", "cam3/0"]


def test_chosen_cameras_come_in_the_order_given_and_others_do_not_matter(tmp_path):
    rig = poses(4)
    cameras = {7: ("RADIAL", COLMAP["RADIAL"]), 8: ("UNHEARD_OF", (1.0,))}
    images = [(pose, 8 if name == "x" else 7, f"{name}.png") for pose, name in zip(rig, ("a", "x", "b", "c"), strict=True)]
    folder = write_colmap_text(tmp_path / "sparse", cameras, images)
    station = convert(tmp_path, folder, ("a.png", "b.png", "c.png"), cameras=["c", "a.png", "b"], scale=1000.0)
    chosen = [rig[3], rig[0], rig[2]]
    read = read_station(station)
    assert [camera.name for camera in read.cameras] == ["c", "a", "b"]
    assert np.abs(read.cameras[0].projection_centre).max() < 1e-9
    lens = colmap_lens("RADIAL", COLMAP["RADIAL"])
    level = foreign.level_from_world(chosen[0], foreign.mean_up(chosen))
    for camera, pose in zip(read.cameras, chosen, strict=True):
        expected = lens(*foreign.ideal(pose, foreign.points()).T)
        found = camera.project(1000 * (foreign.points() - chosen[0].centre) @ level.T)
        inside = (expected > 0).all(axis=1) & (expected < [WIDTH - 1, HEIGHT - 1]).all(axis=1)
        assert np.abs(found - expected)[inside].max() < foreign.TOLERANCE_PX


def test_binary_model_is_preferred_and_a_file_of_it_names_the_kind(tmp_path):
    rig = poses()
    write_colmap_text(tmp_path, {7: ("PINHOLE", (1000.0, 1000.0, 600.0, 500.0))}, images_of(rig))
    write_colmap_binary(tmp_path, {7: ("PINHOLE", (2000.0, 2000.0, 600.0, 500.0))}, images_of(rig))
    assert colmap.read(tmp_path).views[0].interior.fx == 2000
    assert colmap.read(tmp_path / "cameras.txt").views[0].interior.fx == 1000
    assert colmap.read(tmp_path / "images.bin").views[0].interior.fx == 2000


# ---------------------------------------------------------------- refused


@pytest.fixture
def text_model(tmp_path):
    return write_colmap_text(tmp_path / "sparse", {7: ("RADIAL", COLMAP["RADIAL"])}, images_of(poses()))


@pytest.fixture
def binary_model(tmp_path):
    return write_colmap_binary(tmp_path / "sparse", {7: ("RADIAL", COLMAP["RADIAL"])}, images_of(poses()))


def change(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "key", "problem"),
    [
        ("7 RADIAL", "7 RADICAL", "line 4: MODEL", "'RADICAL' is not supported"),
        ("7 RADIAL 1296", "7 RADIAL 0", "line 4: WIDTH", "not an image's size"),
        ("7 RADIAL 1296", "7 RADIAL 1e999", "line 4: WIDTH", "not a finite number"),
        ("7 RADIAL", "seven RADIAL", "line 4: CAMERA_ID", "not a whole number"),
        ("1100.0", "0.0", "line 4: f", "focal length is not positive"),
        ("1100.0", "nan", "line 4: f", "not a finite number"),
        ("-0.23", "k1", "line 4: k1", "not a number"),
        (" 0.09", "", "line 4: PARAMS", "has 4 parameters, RADIAL takes 5"),
        ("7 RADIAL", "7 RADIAL 1 1 1 1 1 1 1\n7 RADIAL", "line 5: CAMERA_ID", "given twice"),
    ],
)
def test_wrong_camera_is_refused_with_its_line(text_model, old, new, key, problem):
    change(text_model / "cameras.txt", old, new)
    refuse(text_model, text_model / "cameras.txt", key, problem)


@pytest.mark.parametrize(
    ("old", "new", "key", "problem"),
    [
        (" 7 right.png", " 9 right.png", "line 5: CAMERA_ID", "camera 9 is not in cameras.txt"),
        ("left.png", "right.png", "camera 'right.png'", "used twice"),
        ("left.png", "", "line 3", "is not IMAGE_ID"),
        (" 7 left.png\n\n", " 7 left.png\n", "line 4", "not the line of an image's points"),
        (" 7 left.png\n\n", " 7 left.png\n1.0 2.0\n", "line 4", "not the line of an image's points"),
    ],
)
def test_wrong_image_is_refused_with_its_line(text_model, old, new, key, problem):
    change(text_model / "images.txt", old, new)
    refuse(text_model, text_model / "images.txt", key, problem)


def test_quaternion_that_is_none_is_refused(text_model):
    file = text_model / "images.txt"
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    words = lines[2].split()
    for value, problem in (("2.5", "length"), ("inf", "finite")):
        lines[2] = " ".join([words[0], value, *words[2:]]) + "\n"
        file.write_text("".join(lines), encoding="utf-8")
        refuse(text_model, file, "line 3", problem)


def test_single_image_is_refused(text_model, tmp_path):
    write_colmap_text(text_model, {7: ("RADIAL", COLMAP["RADIAL"])}, images_of(poses())[:1])
    refuse(text_model, text_model / "images.txt", "cameras", "needs two oriented cameras")


def test_missing_half_of_a_model_is_named(text_model):
    (text_model / "images.txt").unlink()
    refuse(text_model / "cameras.txt", text_model / "images.txt", "", "no such file")
    refuse(text_model, text_model, "", "no COLMAP model")


@given(cut=st.integers(0, 10**6))
def test_torn_binary_file_is_refused(tmp_path_factory, cut):
    folder = write_colmap_binary(tmp_path_factory.mktemp("sparse"), {7: ("RADIAL", COLMAP["RADIAL"])}, images_of(poses()))
    for name in ("cameras.bin", "images.bin"):
        file = folder / name
        whole = file.read_bytes()
        file.write_bytes(whole[: cut % len(whole)])
        with pytest.raises(InputError) as error:
            colmap.read(folder)
        assert error.value.source == str(file)
        file.write_bytes(whole)


@given(position=st.integers(0, 10**6), value=st.integers(0, 255))
def test_damaged_binary_file_is_read_or_refused_but_never_a_defect(tmp_path_factory, position, value):
    folder = write_colmap_binary(tmp_path_factory.mktemp("sparse"), {7: ("RADIAL", COLMAP["RADIAL"])}, images_of(poses()))
    for name in ("cameras.bin", "images.bin"):
        file = folder / name
        whole = bytearray(file.read_bytes())
        whole[position % len(whole)] = value
        file.write_bytes(whole)
    with contextlib.suppress(InputError):
        colmap.read(folder)


@pytest.mark.parametrize(("name", "key"), [("cameras.bin", "number of cameras"), ("images.bin", "number of images")])
def test_count_that_the_file_cannot_hold_is_refused_before_anything_is_read(binary_model, name, key):
    file = binary_model / name
    file.write_bytes(struct.pack("<Q", 2**60) + file.read_bytes()[8:])
    refuse(binary_model, file, key, f"{2**60} records do not fit")


def test_number_of_points_that_the_file_cannot_hold_is_refused(binary_model):
    file = binary_model / "images.bin"
    data = file.read_bytes()
    position = data.index(b"left.png\0") + 9
    file.write_bytes(data[:position] + struct.pack("<Q", 2**62) + data[position + 8 :])
    refuse(binary_model, file, "record 0: number of points", "do not fit")


def test_endless_name_in_a_binary_file_is_refused(binary_model):
    file = binary_model / "images.bin"
    position = file.read_bytes().index(b"left.png\0")
    file.write_bytes(file.read_bytes()[:position] + b"a" * 100_000)
    refuse(binary_model, file, "record 0: NAME", "longer than")


def test_unknown_model_number_is_refused(binary_model):
    file = binary_model / "cameras.bin"
    data = bytearray(file.read_bytes())
    data[12:16] = struct.pack("<i", 99)
    file.write_bytes(data)
    refuse(binary_model, file, "record 0: MODEL", "number 99 is not supported")


def test_fisheye_that_no_pinhole_model_represents_is_refused_with_the_deviation(tmp_path):
    # 600 px is 1.08 rad off the axis in the corners
    parameters = (600.0, 600.0, 648.0, 486.0, 0.3, -0.4, 0.5, -0.2)
    folder = write_colmap_text(tmp_path / "sparse", {7: ("OPENCV_FISHEYE", parameters)}, images_of(poses()))
    error = refuse(folder, folder / "cameras.txt", "OPENCV_FISHEYE", "")
    assert "deviates by up to" in error.problem or "no ray" in error.problem
    assert "FULL_OPENCV" in error.remedy
