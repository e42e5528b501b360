# SPDX-License-Identifier: LGPL-2.1-or-later
"""The domain and its JSON file: what survives a round trip and what is refused with which key."""

import copy
import json
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import SCHEMA, Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee, moved

PIPE = {"kind": "pipe", "id": "P1", "start": [0.0, 3000.0, 0.0], "end": [300.0, 3400.0, 0.0], "outer_diameter": 48.3, "wall_thickness": 2.6, "dn": 40}
ELBOW = {
    "kind": "elbow",
    "id": "E1",
    "start": [300.0, 0.0, 0.0],
    "end": [357.0, 57.0, 0.0],
    "intersection": [357.0, 0.0, 0.0],
    "angle_deg": 90.0,
    "bend_radius": 57.0,
    "bend_type": "3D",
    "outer_diameter": 48.3,
}
FLANGE = {
    "kind": "flange",
    "id": "F1",
    "face": [0.0, 0.0, 0.0],
    "axis": [-1.0, 0.0, 0.0],
    "flange_type": "11",
    "pn": 16,
    "D": 150.0,
    "C": 18.0,
    "length": 45.0,
    "neck_diameter": 64.0,
    "neck_straight": 7.0,
    "K": 110.0,
    "L": 18.0,
    "bolts": 4,
    "raised_face_diameter": 88.0,
    "raised_face_height": 3.0,
    "outer_diameter": 48.3,
    "equivalents": [{"standard": "DIN 2633", "flange_type": "11", "pn": 16}],
}
TEE = {
    "kind": "tee",
    "id": "T1",
    "start": [0.0, 0.0, 0.0],
    "end": [0.0, 0.0, 152.0],
    "intersection": [0.0, 0.0, 76.0],
    "branch_end": [70.0, 0.0, 76.0],
    "branch_diameter": 33.7,
    "tee_type": "tee",
    "outer_diameter": 60.3,
}
REDUCER = {
    "kind": "reducer",
    "id": "R1",
    "start": [0.0, 0.0, 0.0],
    "end": [0.0, 6.0, 76.0],
    "axis": [0.0, 0.0, 1.0],
    "end_diameter": 48.3,
    "reducer_type": "eccentric",
    "outer_diameter": 60.3,
}
CAP = {"kind": "cap", "id": "C1", "start": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0], "length": 38.0, "outer_diameter": 60.3}
KINDS = [Pipe, Elbow, Flange, Tee, Reducer, Cap]
IDENTITY = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]


def complete() -> dict:
    """Return a file with one of everything."""
    return copy.deepcopy(
        {
            "schema": SCHEMA,
            "length_unit": "mm",
            "frame": "A",
            "components": [PIPE, ELBOW, FLANGE, TEE, REDUCER, CAP],
            "joints": [{"a": "P1", "a_port": 1, "b": "E1", "b_port": 0}],
            "stations": {"A": {"frame_from_level": IDENTITY}},
            "sigma0": 0.12,
        }
    )


def through_json(pipeline: Pipeline) -> Pipeline:
    return Pipeline.from_dict(json.loads(json.dumps(pipeline.to_dict(), allow_nan=False)))


def refused(data) -> InputError:
    with pytest.raises(InputError) as error:
        Pipeline.from_dict(data, source="p.json")
    assert error.value.source == "p.json"
    return error.value


# ---------------------------------------------------------------- round trips


def test_file_with_everything_survives_reading_and_writing(tmp_path):
    source, copy_ = tmp_path / "a.json", tmp_path / "b.json"
    source.write_text(json.dumps(complete()), encoding="utf-8")
    pipeline = Pipeline.read(source)
    assert [type(c) for c in pipeline.components] == KINDS
    pipeline.write(copy_)
    assert json.loads(copy_.read_text(encoding="utf-8")) == complete()
    assert Pipeline.read(copy_) == pipeline


def test_unknown_keys_survive_at_every_level():
    data = complete()
    unknown = {"colour": ["red", {"deep": None}], "extra": 7, "note": None}
    data |= unknown
    for part in (*data["components"], *data["joints"], data["stations"]["A"]):
        part.update(unknown)
    data["components"][2]["equivalents"][0]["remark"] = "same bolts"
    assert json.loads(json.dumps(Pipeline.from_dict(data).to_dict())) == data


def test_unknown_key_kind_of_a_joint_survives():
    data = complete()
    data["joints"][0]["kind"] = "weld"
    assert Pipeline.from_dict(data).to_dict()["joints"][0].get("kind") == "weld"


def test_ports_lie_at_the_ends_and_look_outwards():
    pipeline = Pipeline.from_dict(complete())
    assert [len(component.ports) for component in pipeline.components] == [2, 2, 2, 3, 2, 1]
    for component in pipeline.components:
        middle = [sum(x) / len(component.ports) for x in zip(*(port.point for port in component.ports), strict=True)]
        for port in component.ports:
            assert math.hypot(*port.direction) == pytest.approx(1)
            if len(component.ports) > 1:
                assert sum((a - b) * c for a, b, c in zip(port.point, middle, port.direction, strict=True)) > 0
    flange = pipeline.components[2]
    assert flange.ports[1].point == pytest.approx((45.0, 0.0, 0.0))
    assert Pipeline.from_dict(complete() | {"components": [FLANGE | {"flange_type": "05"}], "joints": []}).components[0].ports == flange.ports[:1]


def test_lengths_run_along_the_axes():
    lengths = [component.length for component in Pipeline.from_dict(complete()).components]
    assert lengths == pytest.approx([500.0, 57.0 * math.pi / 2, 45.0, 152.0, 76.0, 38.0])


def test_moved_components_keep_their_shape_and_their_ports_move_along():
    # a quarter turn about z, then a shift
    motion = ((0.0, -1.0, 0.0, 100.0), (1.0, 0.0, 0.0, 200.0), (0.0, 0.0, 1.0, 300.0), (0.0, 0.0, 0.0, 1.0))
    for component in Pipeline.from_dict(complete()).components:
        there = moved(component, motion)
        assert (there.id, there.length) == (component.id, pytest.approx(component.length))
        for port, found in zip(component.ports, there.ports, strict=True):
            x, y, z = port.point
            a, b, c = port.direction
            assert found.point == pytest.approx((100 - y, 200 + x, 300 + z))
            assert found.direction == pytest.approx((-b, a, c))


def test_gaps_stay_where_they_are_when_ends_move():
    pipe = Pipe(id="P", outer_diameter=48.3, start=(0.0, 0.0, 0.0), end=(1000.0, 0.0, 0.0), gaps=((50.0, 90.0), (400.0, 450.0), (900.0, 980.0)))
    moved = pipe.with_ends((80.0, 1.0, 0.0), (940.0, 0.0, 0.0))
    assert moved.gaps == ((0.0, 10.0), (320.0, 370.0), (820.0, 860.0))
    assert pipe.with_ends((100.0, 0.0, 0.0), (300.0, 0.0, 0.0)).gaps is None
    assert pipe.with_ends((-20.0, 0.0, 0.0), (1000.0, 0.0, 0.0)).gaps[0] == (70.0, 110.0)


def test_a_branch_is_a_tees_third_port():
    data = complete()
    data["joints"] = [{"a": "P1", "a_port": 0, "b": "T1", "b_port": 2}]
    assert Pipeline.from_dict(data).joints[0].b_port == 2


def test_nothing_but_the_frame_is_needed():
    pipeline = Pipeline.from_dict({"schema": SCHEMA, "frame": "A"})
    assert pipeline == Pipeline(frame="A")
    assert through_json(pipeline) == pipeline


coordinates = st.floats(-1e6, 1e6, allow_nan=False)
points = st.tuples(coordinates, coordinates, coordinates)
sigmas = st.floats(0, 100)
names = st.text(min_size=1, max_size=12)


@st.composite
def pipes(draw):
    start, end = draw(points), draw(points)
    assume(math.dist(start, end) > 0)
    diameter = draw(st.floats(1, 3000))
    return Pipe(
        id=draw(names),
        start=start,
        end=end,
        outer_diameter=diameter,
        wall_thickness=draw(st.none() | st.floats(0.001, 0.499).map(lambda part: part * diameter)),
        dn=draw(st.none() | st.integers(1, 2500)),
        standard=draw(st.none() | names),
        pick=draw(st.none() | st.integers(0, 1000)),
        station=draw(st.none() | names),
        quality=draw(st.none() | sigmas),
        sigma_position=draw(st.none() | st.tuples(sigmas, sigmas, sigmas)),
        sigma_direction_deg=draw(st.none() | sigmas),
        sigma_outer_diameter=draw(st.none() | sigmas),
        loa=draw(st.none() | st.sampled_from(["LOA20", "LOA50"])),
        fixed=draw(st.booleans()),
        approximate=draw(st.booleans()),
        verified=draw(st.sampled_from([None, 0, 1, 2])),
    )


@given(st.lists(pipes(), max_size=4, unique_by=lambda pipe: pipe.id), names)
def test_any_pipes_survive_a_round_trip_to_the_last_bit(components, frame):
    pipeline = Pipeline.of_station(frame, tuple(components))
    assert through_json(pipeline) == pipeline


@given(pipes())
def test_length_is_the_distance_of_the_ends(pipe):
    assert pipe.length == pytest.approx(sum((b - a) ** 2 for a, b in zip(pipe.start, pipe.end, strict=True)) ** 0.5)


def test_failed_writing_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.json"
    Pipeline(frame="A").write(path)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="JSON"):
        Pipeline(frame="A", sigma0=math.nan).write(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize("schema", [None, "pipeworkbench-pipeline/2", "pipeworkbench-station/1", 1, []])
def test_another_schema_is_refused(schema):
    error = refused(complete() | {"schema": schema})
    assert error.key == "schema"
    assert SCHEMA in error.remedy


def test_lengths_in_another_unit_are_refused():
    assert refused(complete() | {"length_unit": "m"}).key == "length_unit"


@pytest.mark.parametrize("data", [None, [], "text", 5])
def test_file_that_is_no_object_is_refused(data):
    assert "not a JSON object" in refused(data).problem


@pytest.mark.parametrize(
    ("component", "key"),
    [(0, "id"), (0, "start"), (0, "end"), (0, "outer_diameter"), (1, "bend_radius"), (1, "intersection"), (2, "face"), (2, "D"), (2, "flange_type")],
)
def test_missing_key_is_named(component, key):
    data = complete()
    del data["components"][component][key]
    error = refused(data)
    assert error.key == f"components[{component}].{key}"
    assert error.problem == "is missing"


@pytest.mark.parametrize(
    ("key", "value", "where"),
    [
        ("id", 7, "id"),
        ("outer_diameter", "thick", "outer_diameter"),
        ("outer_diameter", None, "outer_diameter"),
        ("outer_diameter", -48.3, "outer_diameter"),
        ("outer_diameter", 0, "outer_diameter"),
        ("outer_diameter", math.inf, "outer_diameter"),
        ("start", [0, 0], "start"),
        ("start", [0, 0, 0, 0], "start"),
        ("start", 5, "start"),
        ("end", [1, 2, "x"], "end[2]"),
        ("end", [1, math.nan, 3], "end[1]"),
        ("wall_thickness", math.nan, "wall_thickness"),
        ("wall_thickness", -1, "wall_thickness"),
        ("dn", 40.5, "dn"),
        ("dn", -40, "dn"),
        ("pick", -1, "pick"),
        ("quality", math.nan, "quality"),
        ("sigma_position", [1, 2], "sigma_position"),
        ("sigma_position", [1, 2, -1], "sigma_position[2]"),
        ("fixed", "perhaps", "fixed"),
        ("verified", 3, "verified"),
    ],
)
def test_wrong_value_is_refused_with_its_key(key, value, where):
    data = complete()
    data["components"][0][key] = value
    # pydantic names the missing or superfluous member of a tuple
    assert refused(data).key.startswith(f"components[0].{where}")


@pytest.mark.parametrize("kind", [None, "valve", 5])
def test_unknown_kind_of_component_is_refused(kind):
    data = complete()
    data["components"][1]["kind"] = kind
    error = refused(data)
    assert error.key == "components[1].kind"
    assert "pipe, elbow, flange" in error.remedy


@pytest.mark.parametrize("kind", [[], {}])
def test_kind_that_is_no_text_is_refused(kind):
    data = complete()
    data["components"][1]["kind"] = kind
    assert refused(data).key == "components[1].kind"


def test_component_that_is_no_object_is_refused():
    data = complete()
    data["components"][1] = "elbow"
    assert refused(data).key.startswith("components[1]")


def test_repeated_id_is_refused():
    data = complete()
    data["components"][2]["id"] = "P1"
    error = refused(data)
    assert error.key == "components[2].id"
    assert "'P1'" in error.problem


@pytest.mark.parametrize("side", ["a", "b"])
def test_dangling_joint_is_refused(side):
    data = complete()
    data["joints"][0][side] = "P9"
    error = refused(data)
    assert error.key == f"joints[0].{side}"
    assert "P9" in error.problem


def test_third_port_is_refused():
    data = complete()
    data["joints"][0]["b_port"] = 2
    assert refused(data).key == "joints[0].b_port"


@pytest.mark.parametrize("wall", [24.15, 24.2, 48.3])
def test_wall_thicker_than_the_radius_is_refused(wall):
    data = complete()
    data["components"][0]["wall_thickness"] = wall
    error = refused(data)
    assert error.key.startswith("components[0]")
    assert "wall" in error.problem


@pytest.mark.parametrize(
    ("component", "wall"),
    [(1, 24.2), (2, 24.2), (3, 16.9), (4, 24.2), (5, 30.2)],
)
def test_wall_must_fit_into_every_end_of_a_fitting(component, wall):
    data = complete()
    data["components"][component]["wall_thickness"] = wall
    assert "wall" in refused(data).problem
    data["components"][component]["wall_thickness"] = wall - 0.2
    assert Pipeline.from_dict(data).components[component].wall_thickness == wall - 0.2


@pytest.mark.parametrize(
    ("changes", "said"),
    [({"K": 140.0}, "bolt holes"), ({"raised_face_diameter": 151.0}, "raised face"), ({"raised_face_height": 18.0}, "raised face")],
)
def test_flange_whose_dimensions_contradict_each_other_is_refused(changes, said):
    data = complete()
    data["components"][2] |= changes
    assert said in refused(data).problem


def test_pipe_without_length_is_refused():
    data = complete()
    data["components"][0]["end"] = data["components"][0]["start"]
    error = refused(data)
    assert error.key.startswith("components[0]")
    assert "same point" in error.problem


def test_gaps_and_the_nearest_standard_survive_a_round_trip():
    data = complete()
    data["components"][0] |= {"gaps": [[54.2, 132.0], [200.0, 210.5]], "nearest_standard": "DN 50"}
    pipeline = Pipeline.from_dict(data)
    assert pipeline.pipes[0].gaps == ((54.2, 132.0), (200.0, 210.5))
    again = through_json(pipeline)
    assert again.pipes[0] == pipeline.pipes[0]
    assert json.loads(json.dumps(again.to_dict()))["components"][0]["gaps"] == [[54.2, 132.0], [200.0, 210.5]]


@pytest.mark.parametrize("gaps", [[[20.0, 10.0]], [[-1.0, 10.0]], [[1.0]], 5, [["a", "b"]]])
def test_gaps_that_are_none_are_refused(gaps):
    data = complete()
    data["components"][0]["gaps"] = gaps
    assert refused(data).key.startswith("components[0]")


@pytest.mark.parametrize("key", ["components", "joints"])
def test_list_that_is_none_is_refused(key):
    assert refused(complete() | {key: {}}).key == key


@pytest.mark.parametrize("stations", [[], "A", 1])
def test_stations_that_are_no_object_are_refused(stations):
    assert refused(complete() | {"stations": stations}).key == "stations"


@pytest.mark.parametrize("matrix", [IDENTITY[:3], [row[:3] for row in IDENTITY], None, [[math.nan] * 4] * 4])
def test_pose_that_is_no_4_by_4_matrix_is_refused(matrix):
    data = complete()
    data["stations"]["A"]["frame_from_level"] = matrix
    assert refused(data).key.startswith("stations.A")


@pytest.mark.parametrize("frame", [None, 5])
def test_frame_must_be_named(frame):
    assert refused(complete() | {"frame": frame}).key == "frame"


def test_sigma0_that_is_no_number_is_refused():
    assert refused(complete() | {"sigma0": "small"}).key == "sigma0"


@pytest.mark.parametrize("sigma0", [math.inf, math.nan])
def test_sigma0_that_is_not_finite_is_refused(sigma0):
    assert refused(complete() | {"sigma0": sigma0}).key == "sigma0"


def test_errors_of_a_file_name_the_file(tmp_path):
    path = tmp_path / "broken.json"
    path.write_text(json.dumps(complete() | {"frame": None}), encoding="utf-8")
    with pytest.raises(InputError, match=r"broken\.json: frame:"):
        Pipeline.read(path)
