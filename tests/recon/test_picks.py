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


def failed(data, station):
    """Return why the last pick of a file is set aside; those before it are not."""
    picks = picks_from(data, station, "picks.json")
    (one,) = picks.refused
    assert one.pick == len(data["picks"]) - 1
    assert len(picks.pipes) + len(picks.flanges) == one.pick
    return one.reason


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
    assert "same as those of picks[0]" in failed(file(pipe(), pipe(edges=turned)), station)


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
    assert "(-0.5, 0) is outside the image" in failed(file(pipe(edges=outside)), station)


def test_flange_outside_the_image_is_set_aside(station):
    reason = failed(file(pipe(), {"kind": "flange", "camera": "top", "point": [100.0, 1950.0]}), station)
    assert "(100, 1950)" in reason
    assert "click inside the image" in reason


@pytest.mark.parametrize(
    ("edges", "words"),
    [
        ([EDGES[0], [[300.0, 600.0], [700.0, 600.0]]], "more than 45 deg apart"),
        ([[[500.0, 400.0], [560.0, 900.0]], [[560.0, 400.0], [500.0, 900.0]]], "cross each other"),
        ([[[500.0, 400.0], [540.0, 700.0]], [[560.0, 600.0], [505.0, 900.0]]], "cross each other"),
        ([EDGES[0], [[501.0, 420.0], [501.0, 880.0]]], "the same edge"),
        ([EDGES[0], [[580.0, 400.0], [580.0, 405.0]]], "edges[1] are only 5.0 px apart"),
    ],
)
def test_edges_that_are_no_pipes_are_set_aside_and_the_others_kept(station, edges, words):
    other = (np.array(EDGES) + 300).tolist()
    assert words in failed(file(pipe(edges=other), pipe(edges=edges)), station)


def test_edges_of_a_pipe_that_runs_away_do_not_cross(station):
    converging = [[[500.0, 400.0], [530.0, 900.0]], [[580.0, 400.0], [550.0, 900.0]]]
    assert not picks_from(file(pipe(edges=converging)), station).refused


@pytest.mark.parametrize("alternative", [1, 2, 6, None])
def test_alternative_is_read(station, alternative):
    assert picks_from(file(pipe(alternative=alternative)), station).pipes[0].alternative == alternative


@pytest.mark.parametrize("alternative", [0, 7, -1, "second", 1.5])
def test_alternative_that_is_none_is_refused_with_its_key(station, alternative):
    assert refused(file(pipe(alternative=alternative)), station).key == "picks[0].alternative"


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


@pytest.mark.parametrize("edges", [[[[500.0, 600.0]], [[580.0, 610.0], [580.0, 700.0]]], [[], [[580.0, 610.0]]]])
def test_edges_with_unequal_numbers_of_points_are_refused(station, edges):
    assert refused(file(pipe(edges=edges)), station).key.startswith("picks[0].edges")


@pytest.mark.parametrize(
    ("edges", "words"), [([[[500.0, 600.0]], [[501.0, 601.0]]], "1.4 px apart"), ([[[500.0, 600.0]], [[5000.0, 601.0]]], "outside the image")]
)
def test_single_points_that_do_not_fit_are_set_aside(station, edges, words):
    assert words in failed(file(pipe(), pipe(edges=edges)), station)


def test_one_point_inside_a_pipe_will_do(station):
    data = pipe(point=[540.0, 600.0])
    del data["edges"]
    (pick,) = picks_from(file(data), station).pipes
    assert pick.edges.tolist() == [[[540.0, 600.0]]]


def test_pick_without_any_point_is_told_what_is_needed(station):
    data = pipe()
    del data["edges"]
    error = refused(file(data), station)
    assert error.key == "picks[0].edges"
    assert "click near both edges" in str(error)
