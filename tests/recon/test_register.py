# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stations put together over what they share, and what is said where they cannot be."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stations import deviation, disturbed, elbow, flange, pipe, places, plant, pose, rack, seen

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Elbow, Flange, Pipe, Pipeline, Tee
from pipeworkbench.recon.register import CandidatePose, ControlPoints, Pose, RegistrationSettings, merge, register
from pipeworkbench.recon.registration.settings import NetworkSettings

# the inclination sensors are observations that pull towards the vertical: without them made-up stations fit exactly
EXACT = RegistrationSettings(adjustment=NetworkSettings(tilt_deg=None))
HERE, THERE = pose(20, (300, -4000, 100)), pose(75, (2500, -3500, 0), (0.4, -0.3))
PLANT = plant()
ALL = {c.id for c in PLANT}
EYE = Pose.identity().matrix()


def two(first=None, second=None, components=PLANT, rng=None):
    return seen("A", components, HERE, first, rng), seen("B", components, THERE, second, rng)


def only_sentence(registration, *words):
    """Check that there is one problem, one sentence long, with words in it."""
    (sentence,) = registration.problems
    assert sentence.count(". ") == 0
    assert ";" in sentence  # what is wrong; what would help
    for word in words:
        assert word in sentence


def test_two_stations_are_put_together_exactly():
    found = register(two(), EXACT)
    assert found.problems == ()
    assert found.separate == ()
    assert deviation(found, "B", HERE, THERE, places(PLANT)) < 1e-3
    assert len(found.pipeline.components) == len(PLANT)
    assert len(found.pipeline.joints) == len(two()[0].joints)
    assert len({c.id for c in found.pipeline.components}) == len(PLANT)
    assert max(max(pair.distances) for pair in found.pairs) < 1e-3
    assert found.poses["B"].farthest(Pose.from_matrix(np.linalg.inv(HERE) @ THERE), np.zeros((1, 3))) < 1e-2
    assert all(found.sources[c.id] == {"A": (c.id,), "B": (c.id.replace("A-", "B-"),)} for c in found.pipeline.components)


@given(
    st.floats(-180, 180),
    st.tuples(st.floats(-9000, 9000), st.floats(-9000, 9000), st.floats(-1000, 1000)),
    st.tuples(*[st.floats(-0.5, 0.5)] * 2),
    st.permutations(range(len(PLANT))),
    st.integers(0, 2**32),
)
@settings(max_examples=25, deadline=None)
@pytest.mark.slow
def test_any_heading_place_and_order_with_the_noise_of_table_4(heading, shift, tilt, order, seed):
    rng, there = np.random.default_rng(seed), pose(heading, shift, tilt)
    stations = seen("A", PLANT, HERE, noise=rng), seen("B", [PLANT[row] for row in order], there, noise=rng)
    found = register(stations)
    assert found.problems == ()
    assert deviation(found, "B", HERE, there, places(PLANT)) < 10
    assert len(found.pipeline.components) == len(PLANT)


def test_the_same_input_gives_the_same_result():
    stations = two(rng=np.random.default_rng(3))
    assert register(stations).pipeline.to_dict() == register(stations).pipeline.to_dict()


@pytest.mark.slow
def test_the_pose_is_as_well_known_as_it_says():
    rng, off, sigma = np.random.default_rng(5), [], []
    for _ in range(40):
        found = register(two(rng=rng))
        matrix = np.array(found.pipeline.stations["B"].frame_from_level)
        off.append(matrix[:3, 3] - (np.linalg.inv(HERE) @ THERE)[:3, 3])
        sigma.append(found.pipeline.stations["B"].extra["sigma_position"])
    ratio = np.sqrt(np.mean(np.square(off), 0)) / np.sqrt(np.mean(np.square(sigma), 0))
    # components are trusted less than they say, so that the pose is a little better than it says
    assert np.all(ratio > 0.3)
    assert np.all(ratio < 1.5)


def test_fused_axes_are_better_than_each_stations_own():
    rng, fused, own = np.random.default_rng(7), [], []
    truth = {c.id: c for c in PLANT if isinstance(c, Pipe)}
    for _ in range(20):
        a, b = two(rng=rng)
        merged = merge((a, b), [Pose.identity(), Pose.from_matrix(np.linalg.inv(HERE) @ THERE)]).pipeline
        for pipeline, collected in ((merged, fused), (a, own)):
            for made in pipeline.pipes:
                true, middle = truth[made.id[2:]], HERE @ [*(np.add(made.start, made.end) / 2), 1]
                axis = np.subtract(true.end, true.start) / true.length
                collected.append(np.linalg.norm(np.cross(middle[:3] - true.start, axis)))
    assert np.sqrt(np.mean(np.square(fused))) < 0.85 * np.sqrt(np.mean(np.square(own)))


def test_a_fused_pipe_reaches_as_far_as_any_station_saw_it():
    long = replace(PLANT[-1], id="R0", start=(200.0, -300.0, 300.0), end=(200.0, 500.0, 300.0))
    other = replace(PLANT[-1], id="R0", start=(200.0, 100.0, 300.0), end=(200.0, 900.0, 300.0))
    found = register([seen("A", [*PLANT[:-1], long], HERE), seen("B", [*PLANT[:-1], other], THERE)])
    (whole,) = [c for c in found.pipeline.pipes if c.outer_diameter == 33.7]
    assert whole.length == pytest.approx(1200, abs=0.1)


def test_pieces_of_one_pipe_become_one_where_nothing_lies_between():
    pieces = [pipe("R1", (200, -300, 300), (200, 250, 300), 33.7), pipe("R2", (200, 280, 300), (200, 900, 300), 33.7)]
    found = register([seen("A", [*PLANT[:-1], pieces[0]], HERE), seen("B", [*PLANT[:-1], pieces[1]], THERE)])
    (whole,) = [c for c in found.pipeline.pipes if c.outer_diameter == 33.7]
    assert whole.length == pytest.approx(1200, abs=0.1)
    assert whole.gaps == ((550.0, 580.0),)


def test_a_pipe_followed_through_flanges_is_cut_where_another_station_saw_them():
    through = [c for c in PLANT if c.id not in {"P2", "P3", "F0", "F1"}]
    through.append(pipe("P2", (1000, 76, 800), (1000, 1500, 800)))
    found = register([seen("A", through, HERE), seen("B", PLANT, THERE)])
    lengths = sorted(round(c.length) for c in found.pipeline.pipes if c.outer_diameter == 60.3)
    assert lengths == [424, 648, 908, 924]
    assert sum(isinstance(c, Flange) for c in found.pipeline.components) == 2
    assert len(found.pipeline.joints) == 9


def test_joined_ends_coincide_after_noise_was_averaged():
    found = register(two(rng=np.random.default_rng(11)))
    by_id = {c.id: c for c in found.pipeline.components}
    elbows = [c for c in by_id.values() if isinstance(c, Elbow)]
    joined = [j for j in found.pipeline.joints if j.a in {e.id for e in elbows} or j.b in {e.id for e in elbows}]
    assert len(joined) == 6
    for joint in joined:
        one, other = by_id[joint.a].ports[joint.a_port], by_id[joint.b].ports[joint.b_port]
        assert np.linalg.norm(np.subtract(one.point, other.point)) < 1e-6
        assert np.dot(one.direction, other.direction) == pytest.approx(-1, abs=1e-9)


def test_a_tee_that_one_station_saw_follows_the_axis_that_all_gave():
    run = [pipe("T0", (1500, -500, 0), (1500, -54, 0)), pipe("T1", (1500, 54, 0), (1500, 700, 0))]
    branch = pipe("T2", (1500, 0, 70), (1500, 0, 600), 33.7)
    shape = {"start": (1500.0, -54.0, 0.0), "end": (1500.0, 54.0, 0.0), "intersection": (1500.0, 0.0, 0.0), "branch_end": (1500.0, 0.0, 70.0)}
    tee = Tee(id="T", outer_diameter=60.3, branch_diameter=33.7, **shape)
    whole = pipe("T0", (1503, -500, 3), (1503, 700, 3))  # the other station saw no tee and put the run 4 mm aside
    found = register([seen("A", [*PLANT, *run, branch, tee], HERE), seen("B", [*PLANT, whole], THERE)])
    by_id = {c.id: c for c in found.pipeline.components}
    assert by_id["A-T0"].length + by_id["A-T1"].length == pytest.approx(1200 - 108, abs=0.5)
    for name, port in (("A-T0", 1), ("A-T1", 0)):
        ends = [p.point for p in by_id["A-T"].ports[:2]]
        assert min(np.linalg.norm(np.subtract(by_id[name].ports[port].point, end)) for end in ends) < 1.0
    joined = {frozenset({j.a, j.b}) for j in found.pipeline.joints}
    assert {frozenset({"A-T", name}) for name in ("A-T0", "A-T1", "A-T2")} <= joined


def test_picks_of_other_stations_are_kept_beside_the_references():
    found = register(two(first=ALL - {"R0"}, second=ALL - {"Q1"}))
    by_id = {c.id: c for c in found.pipeline.components}
    assert by_id["A-P0"].pick == 0
    assert by_id["A-P0"].extra["picks"] == {"A": 0, "B": 0}
    assert by_id["B-R0"].pick is None
    assert by_id["B-R0"].extra["picks"] == {"B": 10}


def test_the_result_survives_its_file(tmp_path):
    found = register(two(rng=np.random.default_rng(2)))
    found.pipeline.write(tmp_path / "plant.json")
    again = Pipeline.read(tmp_path / "plant.json")
    assert len(again.stations["B"].extra["sigma_position"]) == 3
    assert again.stations["B"].extra["sigma_heading_deg"] > 0
    assert again.to_dict() == found.pipeline.to_dict()


def test_a_chain_of_stations_is_one_network():
    shift = np.eye(4)
    long = [*PLANT]
    for number in (1, 2):
        shift[:3, 3] = number * np.array([1900.0, 800.0 * number, 0])
        # each part of the plant has its own diameters
        long += [replace(c, id=f"{c.id}{number}", outer_diameter=c.outer_diameter * 1.27**number) for c in _shifted(PLANT, shift)]
    ids = [c.id for c in long]
    parts, poses = [ids[:18], ids[6:30], ids[18:]], [HERE, THERE, pose(-120, (5000, 6000, 50), (0.2, 0.2))]
    rng = np.random.default_rng(4)
    found = register([seen(name, long, place, set(part), rng) for name, part, place in zip("ABC", parts, poses, strict=True)])
    assert found.problems == ()
    assert len(found.pipeline.components) == len(long)
    for name, place in zip("BC", poses[1:], strict=True):
        assert deviation(found, name, HERE, place, places(long)) < 15
    # further away is less well known
    sigma = [np.linalg.norm(found.pipeline.stations[name].extra["sigma_position"]) for name in "ABC"]
    assert sigma == sorted(sigma)
    assert sigma[0] == 0


def _shifted(components, shift):
    from pipeworkbench.pipeline import moved

    return [moved(c, shift.tolist()) for c in components]


def test_an_anchor_fixes_the_slide_along_parallel_pipes():
    uneven = [pipe(f"K{n}", (0, y, z), (2000, y, z)) for n, (y, z) in enumerate([(0, 0), (200, 0), (500, 90), (800, 0)])]
    anchors = [flange("F", (2045, 200, 0), (1, 0, 0))]
    found = register(two(components=[*uneven, *anchors]), EXACT)
    assert found.problems == ()
    assert deviation(found, "B", HERE, THERE, places(uneven)) < 1e-2
    # without it the slide stays open
    alone = register(two(components=uneven))
    assert [one.frame for one in alone.separate] == ["B"]
    only_sentence(alone, "parallel", "elbow")


def test_parallel_pipes_with_other_components_that_are_not_common_are_told():
    uneven = [pipe(f"K{n}", (0, y, z), (2000, y, z)) for n, (y, z) in enumerate([(0, 0), (200, 0), (500, 90), (800, 0)])]
    found = register(two({c.id for c in uneven} | {"Q0", "Q1"}, {c.id for c in uneven} | {"R0"}, [*uneven, *PLANT]))
    assert [one.frame for one in found.separate] == ["B"]
    only_sentence(found, "B has", "in common")


def test_nothing_in_common_leaves_the_stations_as_they_are():
    a, b = two(first={"P0", "E0", "P1", "E1", "P2"}, second={"Q0", "E2", "Q1", "R0"})
    found = register([a, b])
    assert found.separate == (b,)
    assert {c.id for c in found.pipeline.components} == {c.id for c in a.components}
    only_sentence(found, "B", "in common with A", "by hand")


def test_a_repeating_rack_is_ambiguous_and_its_candidates_are_told():
    across = [pipe(f"L{n}", (300 + 300 * n, -100, 100), (300 + 300 * n, 1300, 100)) for n in range(5)]
    found = register(two(components=[*rack(6), *across], first={f"{k}{n}" for k in "KL" for n in range(4)}))
    only_sentence(found, "repeating", "candidates")
    assert [one.frame for one in found.separate] == ["B"]
    assert len(found.candidates) >= 2
    assert found.candidates[0].score >= found.candidates[-1].score


def test_a_mirror_like_rack_is_ambiguous_until_one_component_is_assigned_by_hand():
    # a half turn about the vertical carries it onto itself
    legs = [pipe("U0", (-500, 0, -600), (-500, 0, -76)), pipe("U2", (500, 0, -600), (500, 0, -76))]
    bends = [elbow("E0", (-500, 0, 0), (0, 0, 1), (1, 0, 0)), elbow("E1", (500, 0, 0), (1, 0, 0), (0, 0, -1))]
    components = [*legs, pipe("U1", (-424, 0, 0), (424, 0, 0)), *bends]
    a, b = two(components=components)
    found = register([a, b])
    only_sentence(found, "2 different places")
    (right,) = [one for one in found.candidates if np.allclose(one.a_from_b, np.linalg.inv(HERE) @ THERE, atol=1)]
    assert deviation(register([a, b], EXACT, chosen=[right]), "B", HERE, THERE, places(components)) < 0.1
    by_hand = register([a, b], EXACT, [("A-U0", "B-U0"), ("A-U1", "B-U1")])
    assert by_hand.problems == ()
    assert deviation(by_hand, "B", HERE, THERE, places(components)) < 0.1
    assert len(by_hand.pipeline.components) == 5


def test_the_same_photographs_twice_are_told():
    a = two()[0]
    again = replace(a, frame="A2", components=tuple(replace(c, id=c.id.replace("A-", "A2-")) for c in a.components), joints=())
    found = register([a, again])
    only_sentence(found, "same photographs", "leave one of them out")
    assert found.separate == (again,)
    assert len(found.pipeline.components) == len(PLANT)


def test_a_name_that_two_stations_have_is_told():
    a, b = two()
    twice = register([a, b, a])
    only_sentence(twice, "same photographs")
    assert twice.separate == (a,)
    other = replace(b, frame="A")
    named_alike = register([a, other])
    only_sentence(named_alike, "two stations are called 'A'")
    assert named_alike.separate == (other,)


def test_stations_that_lie_otherwise_over_a_third_one_are_told():
    a, b = two()
    third = pose(-60, (1000, 5000, 50))
    wrong = Pose.from_matrix(np.linalg.inv(HERE) @ pose(0, (0, 0, 900)) @ third).matrix()
    found = register([a, b, seen("C", PLANT, third)], chosen=[CandidatePose("A", "C", wrong, 1.0, 1)])
    assert any(sentence.startswith("C lies otherwise to B") for sentence in found.problems)
    assert [one.frame for one in found.separate] == ["C"]
    assert deviation(found, "B", HERE, THERE, places(PLANT)) < 0.5


CONTROLS = np.array([[0, 0, -300], [1500, 0, -300], [0, 1500, -250], [1500, 1500, 900]], float)


def points_in(place, points=CONTROLS, rng=None):
    inverse = np.linalg.inv(place)
    moved = points @ inverse[:3, :3].T + inverse[:3, 3] + (rng.normal(0, 0.3, points.shape) if rng is not None else 0)
    return {f"T{n}": tuple(point) for n, point in enumerate(moved.tolist())}


def test_control_points_alone_put_stations_together_and_into_the_plant():
    a, b = two(first={"P0", "E0", "P1"}, second={"Q0", "E2", "Q1"})
    known = {f"T{n}": tuple(point) for n, point in enumerate(CONTROLS.tolist())}
    found = register([a, b], EXACT, control_points=ControlPoints({"A": points_in(HERE), "B": points_in(THERE)}, known))
    assert found.problems == ()
    assert deviation(found, "B", HERE, THERE, places(PLANT)) < 1e-3
    assert np.allclose(found.plant_from_frame, HERE, atol=1e-3)
    assert {pair.kind for pair in found.pairs} == {"control point"}
    assert "control points" not in found.pipeline.stations


@pytest.mark.slow
def test_control_points_and_components_together_are_better_than_components_alone():
    rng, off = np.random.default_rng(8), {True: [], False: []}
    for _ in range(15):
        stations = two(rng=rng)
        points = ControlPoints({"A": points_in(HERE, rng=rng), "B": points_in(THERE, rng=rng)}, sigma=0.3)
        for with_points in (True, False):
            found = register(stations, control_points=points if with_points else None)
            off[with_points].append(deviation(found, "B", HERE, THERE, CONTROLS))
    assert np.mean(off[True]) < 0.7 * np.mean(off[False])


def test_one_wrong_control_point_is_left_out_and_told():
    there = points_in(THERE)
    there["T3"] = tuple(np.add(there["T3"], (40, 0, 0)))
    more = np.array([[700, 0, 0], [0, 700, 200.0]])
    here = points_in(HERE) | {f"M{n}": p for n, p in enumerate(points_in(HERE, more).values())}
    there |= {f"M{n}": p for n, p in enumerate(points_in(THERE, more).values())}
    found = register(two(), control_points=ControlPoints({"A": here, "B": there}))
    only_sentence(found, "T3", "left out")
    assert deviation(found, "B", HERE, THERE, places(PLANT)) < 1


def test_known_coordinates_that_contradict_leave_the_stations_merged_in_their_own_frame():
    rng = np.random.default_rng(6)
    known = {f"T{n}": tuple(point) for n, point in enumerate((CONTROLS + rng.uniform(-80, 80, CONTROLS.shape)).tolist())}
    found = register(two(), control_points=ControlPoints({"A": points_in(HERE), "B": points_in(THERE)}, known))
    assert found.separate == ()
    assert found.plant_from_frame is None
    only_sentence(found, "known ones", "contradict")


def test_contradicting_control_points_leave_the_station_separate():
    rng = np.random.default_rng(6)
    there = {name: tuple(np.add(point, rng.uniform(-80, 80, 3))) for name, point in points_in(THERE).items()}
    a, b = two()
    found = register([a, b], control_points=ControlPoints({"A": points_in(HERE), "B": there}))
    assert found.separate == (b,)
    only_sentence(found, "contradict", "B", "check")


def test_a_badly_measured_component_is_marked_and_does_not_pull_the_pose():
    a, b = two()
    bad = {c.id: c for c in b.components}
    bad["B-R0"] = disturbed(bad["B-R0"], _Far())
    found = register([a, replace(b, components=tuple(bad.values()))])
    assert deviation(found, "B", HERE, THERE, places(PLANT)) < 0.5
    # a body is where it is once: what lies in it is the same pipe
    assert len(found.pipeline.components) == len(PLANT)


class _Far:
    """Draws deviations of many standard deviations."""

    @staticmethod
    def normal(mean, sigma, count):
        return np.array([5.0, 0.0, 5.0][:count]) * sigma + mean


def test_assignments_are_checked():
    a, b = two()
    with pytest.raises(InputError, match="no station has it"):
        register([a, b], assignments=[("A-P0", "B-X")])
    with pytest.raises(InputError, match="one is of kind pipe"):
        register([a, b], assignments=[("A-P0", "B-E0")])
    with pytest.raises(InputError, match="both are of one station"):
        register([a, b], assignments=[("A-P0", "A-P1")])
    with pytest.raises(InputError, match="there is none"):
        register([])
    with pytest.raises(InputError, match="there is no such station"):
        register([a, b], chosen=[CandidatePose("A", "X", EYE, 1.0, 1)])
    parallel = register([a, b], assignments=[("A-P0", "B-P0")])
    only_sentence(parallel, "not parallel")


def test_ids_that_two_stations_use_stay_unique():
    stations = [replace(one, components=tuple(replace(c, id=c.id[2:]) for c in one.components), joints=()) for one in two(ALL - {"R0"}, ALL - {"Q1"})]
    found = register(stations)
    ids = [c.id for c in found.pipeline.components]
    assert len(set(ids)) == len(ids) == len(PLANT)
    assert found.sources["P0"] == {"A": ("P0",), "B": ("P0",)}


def test_one_station_stays_what_it_is():
    a = two()[0]
    found = register([a])
    assert found.problems == ()
    assert [c.id for c in found.pipeline.components] == [c.id for c in a.components]
    assert all(
        np.allclose(one.point, other.point)
        for c, d in zip(found.pipeline.components, a.components, strict=True)
        for one, other in zip(c.ports, d.ports, strict=True)
    )


def test_stations_without_components_do_not_stop_the_others():
    a, b = two()
    found = register([a, Pipeline.of_station("E", ()), b])
    assert [one.frame for one in found.separate] == ["E"]
    assert set(found.pipeline.stations) == {"A", "B"}
    assert all(one <= other for one, other in pairwise(["A", "B"]))
