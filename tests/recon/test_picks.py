# SPDX-License-Identifier: LGPL-2.1-or-later
"""What picks.json may hold and what it may not."""

import json

import numpy as np
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.recon.picks import picks_from, read_picks
from pipeworkbench.recon.station import read_station

EDGES = [[[500.0, 400.0], [500.0, 900.0]], [[580.0, 400.0], [582.0, 900.0]]]


@pytest.fixture(scope="module")
def station(sample):
    return read_station(sample)


def file(*picks, **more):
    return {"schema": "pipeworkbench-picks/1", "picks": list(picks)} | more


def pipe(**more):
    return {"kind": "pipe", "camera": "right", "edges": EDGES} | more


def refused(data, station):
    with pytest.raises(InputError) as error:
        picks_from(data, station, "picks.json")
    return error.value


def test_picks_of_the_sample_are_read_by_kind(sample, station):
    picks = read_picks(sample / "picks.json", station)
    data = json.loads((sample / "picks.json").read_text(encoding="utf-8"))["picks"]
    assert [p.index for p in picks.pipes] == [i for i, p in enumerate(data) if p["kind"] == "pipe"]
    assert [p.index for p in picks.flanges] == [i for i, p in enumerate(data) if p["kind"] == "flange"]
    for pick in picks.pipes:
        assert np.array_equal(pick.edges, data[pick.index]["edges"])
        assert station.cameras[pick.camera].name == data[pick.index]["camera"]
    for pick in picks.flanges:
        assert np.array_equal(pick.point, data[pick.index]["point"])


@pytest.mark.parametrize(("diameter", "read"), [(48.3, 48.3), (48, 48.0), ("free", "free"), (None, None)])
def test_diameter_may_be_a_number_free_or_null(station, diameter, read):
    (pick,) = picks_from(file(pipe(diameter=diameter)), station).pipes
    assert pick.diameter == read
    assert type(pick.diameter) is type(read)


def test_diameter_may_be_left_out(station):
    assert picks_from(file(pipe()), station).pipes[0].diameter is None


@pytest.mark.parametrize("diameter", [0, -48.3, "wide", [48.3], float("inf"), float("nan"), {}])
def test_diameter_that_is_none_is_refused_with_its_key(station, diameter):
    error = refused(file(pipe(), pipe(edges=(np.array(EDGES) + 200).tolist(), diameter=diameter)), station)
    assert error.key == "picks[1].diameter"


@pytest.mark.parametrize("diameter", [True, "48.3"])
def test_diameter_must_be_a_json_number(station, diameter):
    assert refused(file(pipe(diameter=diameter)), station).key == "picks[0].diameter"


def test_unknown_keys_and_the_stations_name_are_accepted(station):
    picks = picks_from(file(pipe(truth="P1", remark=[1, 2]), station="A", author="somebody"), station)
    assert len(picks.pipes) == 1


def test_station_need_not_be_named(station):
    assert len(picks_from(file(pipe()), station).pipes) == 1


def test_order_of_the_points_and_edges_does_not_matter(station):
    turned = [EDGES[1][::-1], EDGES[0]]
    assert picks_from(file(pipe(edges=turned)), station).pipes[0].edges.shape == (2, 2, 2)
    assert refused(file(pipe(), pipe(edges=turned)), station).key == "picks[1].edges"


def test_same_place_in_another_image_is_another_pick(station):
    assert len(picks_from(file(pipe(), pipe(camera="left")), station).pipes) == 2


def test_neighbouring_pipe_may_share_an_edge(station):
    neighbour = [EDGES[1], np.add(EDGES[1], [80, 0]).tolist()]
    assert len(picks_from(file(pipe(), pipe(edges=neighbour)), station).pipes) == 2


def test_next_piece_of_the_same_line_may_be_picked_too(station):
    further = np.add(EDGES, [2, 600]).tolist()
    assert len(picks_from(file(pipe(), pipe(edges=further)), station).pipes) == 2


def test_point_in_the_outermost_pixel_is_inside(station):
    corner = [[[0.0, 0.0], [0.0, 1943.0]], [[80.0, 0.0], [80.0, 1943.0]]]
    assert len(picks_from(file(pipe(edges=corner)), station).pipes) == 1
    outside = [[[-0.5, 0.0], [0.0, 1943.0]], corner[1]]
    assert refused(file(pipe(edges=outside)), station).key.startswith("picks[0]")


def test_flange_outside_the_image_is_refused(station):
    error = refused(file({"kind": "flange", "camera": "top", "point": [100.0, 1950.0]}), station)
    assert error.key.startswith("picks[0]")
    assert "(100, 1950)" in error.problem


@pytest.mark.parametrize("edges", [None, "left", 5, {}])
def test_edges_that_are_no_points_are_refused(station, edges):
    assert refused(file(pipe(edges=edges)), station).key.startswith("picks[0].edges")


@pytest.mark.parametrize("edges", [[], EDGES[:1], [EDGES[0], EDGES[1][:1]], [[[1.0], [2.0]], EDGES[1]]])
def test_edges_with_too_few_points_are_refused(station, edges):
    assert refused(file(pipe(edges=edges)), station).key.startswith("picks[0].edges")


def test_one_point_near_each_edge_will_do(station):
    (pick,) = picks_from(file(pipe(edges=[[[500.0, 600.0]], [[580.0, 610.0]]])), station).pipes
    assert pick.edges.shape == (2, 1, 2)
    assert pick.edges[1, 0].tolist() == [580.0, 610.0]


@pytest.mark.parametrize(
    ("edges", "words"),
    [
        ([[[500.0, 600.0]], [[580.0, 610.0], [580.0, 700.0]]], "as many points"),
        ([[[500.0, 600.0]], [[501.0, 601.0]]], "1.4 px apart"),
        ([[[500.0, 600.0]], [[5000.0, 601.0]]], "outside the image"),
        ([[], [[580.0, 610.0]]], "edges"),
    ],
)
def test_single_points_that_do_not_fit_are_refused(station, edges, words):
    error = refused(file(pipe(edges=edges)), station)
    assert words in str(error)
    assert "picks[0]" in str(error)


def test_one_point_inside_a_pipe_is_told_what_is_needed(station):
    data = pipe(point=[540.0, 600.0])
    del data["edges"]
    error = refused(file(data), station)
    assert "one point inside" in str(error)
    assert "click near both edges" in str(error)
