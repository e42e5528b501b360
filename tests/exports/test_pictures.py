# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures: contours are drawn where the pipes are, and nowhere else."""

import json

import cv2
import numpy as np
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.exports.pictures import annotated, write_picture
from pipeworkbench.exports.writers import check_paths
from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, StationPose
from pipeworkbench.recon.station import read_station

WIDTH, HEIGHT, FOCAL = 320, 240, 400.0
PIPE = Pipe(id="P", start=(-150.0, 2000.0, 0.0), end=(150.0, 2000.0, 0.0), outer_diameter=100.0)
MOVED = np.array([[1.0, 0, 0, 500], [0, 1, 0, -200], [0, 0, 1, 80], [0, 0, 0, 1]])


@pytest.fixture
def station(tmp_path):
    """Two cameras, 100 mm apart, before a plain grey wall."""
    cameras = []
    for name, x in (("left", 0.0), ("right", 100.0)):
        cv2.imwrite(str(tmp_path / f"{name}.png"), np.full((HEIGHT, WIDTH), 90, np.uint8))
        cameras.append(
            {
                "name": name,
                "image": f"{name}.png",
                "width": WIDTH,
                "height": HEIGHT,
                "interior": {"model": "opencv", "fx": FOCAL, "fy": FOCAL, "cx": 160.0, "cy": 120.0},
                "exterior": {"rotation_rig_to_camera": np.eye(3).tolist(), "projection_centre": [x, 0, 0]},
            }
        )
    data = {"schema": "pipeworkbench-station/1", "name": "S", "cameras": cameras, "level_from_rig": [[1, 0, 0], [0, 0, 1], [0, -1, 0]]}
    (tmp_path / "station.json").write_text(json.dumps(data), encoding="utf-8")
    return read_station(tmp_path)


def drawn(station, index, pipeline):
    """Return which pixels (height, width) a pipeline changes in a camera's photograph."""
    level_from_frame = np.linalg.inv(np.array(pipeline.stations["S"].frame_from_level))
    bare = annotated(station, index, Pipeline.of_station("S", ()), np.eye(4))
    return (annotated(station, index, pipeline, level_from_frame) != bare).any(axis=2)


@pytest.mark.parametrize("index", [0, 1])
def test_contour_is_drawn_where_the_pipe_is(station, index):
    changed = drawn(station, index, Pipeline.of_station("S", (PIPE,)))
    middle = 160 - index * 100 / 2000 * FOCAL
    # the edges of a cylinder of radius r at distance d are seen at asin(r / d) above and below its axis
    above = FOCAL * np.tan(np.arcsin(50 / 2000))
    for row in (120 - above, 120 + above):
        assert changed[round(row), round(middle - 20) : round(middle + 20)].all()
    rows, columns = np.nonzero(changed)
    assert rows.min() >= 120 - above - 3
    assert rows.max() <= 120 + above + 3
    ends = 150 / 2000 * FOCAL
    assert columns.min() >= middle - ends - 3
    assert columns.max() <= max(middle + ends + 3, middle + 40)  # the label may reach further


def test_pipe_of_another_frame_is_drawn_at_the_same_place(station):
    there = [tuple((MOVED @ [*point, 1.0])[:3]) for point in (PIPE.start, PIPE.end)]
    moved = Pipe(id="P", start=there[0], end=there[1], outer_diameter=100.0)
    pipeline = Pipeline(frame="plant", components=(moved,), stations={"S": StationPose(frame_from_level=tuple(map(tuple, MOVED.tolist())))})
    assert np.array_equal(drawn(station, 0, pipeline), drawn(station, 0, Pipeline.of_station("S", (PIPE,))))


@pytest.mark.parametrize("shift", [(0.0, -9000.0, 0.0), (5000.0, 0.0, 0.0)], ids=["behind the camera", "beside the image"])
def test_pipe_that_is_not_in_the_photograph_changes_nothing(station, shift):
    away = [tuple(np.add(point, shift).tolist()) for point in (PIPE.start, PIPE.end)]
    assert not drawn(station, 0, Pipeline.of_station("S", (Pipe(id="P", start=away[0], end=away[1], outer_diameter=100.0),))).any()


def test_rim_and_bend_are_drawn_where_they_are(station):
    flange = Flange(
        id="F", face=(-60.0, 1500.0, 0.0), axis=(0.0, -1.0, 0.0), flange_type="05", pn=16, D=100.0, C=1.0, length=1.0, outer_diameter=40.0
    )
    changed = drawn(station, 0, Pipeline.of_station("S", (flange,)))
    turn = np.linspace(0, 2 * np.pi, 60)
    # the face looks at the camera: a circle
    columns = 160 + FOCAL * (-60 + 50 * np.cos(turn)) / 1500
    rows = 120 - FOCAL * 50 * np.sin(turn) / 1500
    assert np.mean(changed[np.rint(rows).astype(int), np.rint(columns).astype(int)]) > 0.95
    elbow = Elbow(
        id="E", start=(0.0, 2000.0, 0.0), intersection=(100.0, 2000.0, 0.0), end=(100.0, 2000.0, -100.0), angle_deg=90, bend_radius=100.0,
        outer_diameter=40.0,
    )  # fmt: skip
    changed = drawn(station, 0, Pipeline.of_station("S", (elbow,)))
    turn = np.linspace(0.1, np.pi / 2 - 0.1, 30)
    columns, rows = 160 + FOCAL * 120 * np.sin(turn) / 2000, 120 + FOCAL * (100 - 120 * np.cos(turn)) / 2000
    near = [changed[round(v) - 1 : round(v) + 2, round(u) - 1 : round(u) + 2].any() for u, v in zip(columns, rows, strict=True)]
    assert all(near)


def test_hidden_parts_are_not_drawn(station):
    # its longer part is above: its label, at the middle of what is seen, is not before the other pipe
    behind = Pipe(id="B", start=(150.0, 2300.0, -150.0), end=(150.0, 2300.0, 400.0), outer_diameter=40.0)
    before = Pipe(id="P", start=(-200.0, 2000.0, 0.0), end=(200.0, 2000.0, 0.0), outer_diameter=100.0)
    edge = 160 + round(FOCAL * 170 / 2300)
    alone = drawn(station, 0, Pipeline.of_station("S", (behind,)))
    assert alone[95:140, edge - 2 : edge + 3].any(axis=1).all()
    both = drawn(station, 0, Pipeline.of_station("S", (behind, before)))
    assert not both[113:127, edge - 2 : edge + 3].any()
    assert both[95:105, edge - 2 : edge + 3].any(axis=1).all()
    assert both[134:140, edge - 2 : edge + 3].any(axis=1).all()


def test_picture_has_a_panel_for_each_camera(station, tmp_path):
    path = tmp_path / "picture.png"
    write_picture(Pipeline.of_station("S", (PIPE,)), [station], path)
    picture = cv2.imread(str(path))
    assert picture.shape[1] >= 2 * WIDTH
    assert HEIGHT <= picture.shape[0] < 2 * HEIGHT
    assert not [entry for entry in tmp_path.iterdir() if entry.name.startswith(".")]


@pytest.mark.parametrize("names", [[], ["S"]])
def test_picture_without_its_station_is_refused(station, tmp_path, names):
    stations = [station] if names else []
    path = tmp_path / "picture.png"
    with pytest.raises(InputError, match="photographs"):
        write_picture(Pipeline.of_station("other", (PIPE,)), stations, path)
    assert not path.exists()


def test_picture_without_photographs_is_refused_before_anything_is_done(tmp_path):
    with pytest.raises(InputError, match="photographs"):
        check_paths([tmp_path / "picture.png"], has_photographs=False)
