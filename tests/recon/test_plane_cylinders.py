# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders from tangent planes: exact planes give the exact pipe, noisy ones errors of the size that is said."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from synthetic import TARGET, TruePipe, cameras, pipe, true_edges

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Camera, OpenCVInterior
from pipeworkbench.recon.cylinder import Cylinder, edge_lines
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.plane_cylinders import (
    IntersectionError,
    TangentSettings,
    best_pair,
    cylinder_from_centre_planes,
    cylinder_from_diameter,
    cylinder_from_images,
    cylinders_from_images,
    intersection_angles,
)
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.tangent_planes import apparent_pipe

PINHOLE = OpenCVInterior(2592, 1944, 6500.0, 6500.0, 1300.0, 970.0, ())
LEFT, RIGHT, TOP = cameras()
STRAIGHT = tuple(replace(camera, interior=OpenCVInterior(640, 480, 1300.0, 1300.0, 322.0, 238.0, ())) for camera in cameras())
EXACT = 1e-9  # of the distance
TRIALS = 100
TWO_TO_FOUR = st.integers(2, 4)


def looking(name, centre, target=TARGET, interior=PINHOLE, roll=0.0):
    """Return a camera whose axis goes through the target, rolled about it."""
    forward = (target - centre) / np.linalg.norm(target - centre)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.array([right, np.cross(forward, right), forward])
    return Camera(name, interior, Rotation.from_euler("z", roll).as_matrix() @ rotation, np.asarray(centre, float))


def edges_of(camera, cylinder, half_length, count=2):
    """Return pixels (2, count, 2) of both edges of a cylinder."""
    lines, _ = edge_lines(cylinder.as_many(), camera.projection_centre)
    along = np.linspace(-half_length, half_length, count)
    return np.array([camera.project(point + along[:, None] * cylinder.direction) for point in lines[0]])


def apparent(camera, cylinder, half_length=200.0, count=2, noise=None, sigma_px=1.0):
    """Return what a camera sees of a cylinder, with noise of ``sigma_px`` where a generator is given."""
    edges = edges_of(camera, cylinder, half_length, count)
    if noise is not None:
        edges = edges + noise.normal(0, sigma_px, edges.shape)
    return apparent_pipe(camera, *edges, sigma_px)


def without_side(plane):
    return replace(plane, side_known=False)


def gap(found, truth):
    """Return how far the middle of what was found is from the true axis, mm."""
    offset = found.point - truth.point
    return float(np.linalg.norm(offset - (offset @ truth.direction) * truth.direction))


def assert_same(found, truth, camera, tolerance=EXACT):
    distance = np.linalg.norm(truth.point - camera.projection_centre)
    assert gap(found, truth) < tolerance * distance
    assert np.linalg.norm(np.cross(found.direction, truth.direction)) < 10 * tolerance
    assert found.radius == pytest.approx(truth.radius, abs=tolerance * distance)


def assert_touches(cylinder, planes):
    """Check n . d = 0 and |n . (X - P)| = r, whatever the side."""
    for plane in planes:
        assert plane.normal @ cylinder.direction == pytest.approx(0.0, abs=1e-9)
        assert abs(plane.normal @ (cylinder.point - plane.projection_centre)) == pytest.approx(cylinder.radius, abs=1e-6)


@st.composite
def rigs(draw, count=TWO_TO_FOUR):
    """Give cameras around a pipe, none of them in line with it, the best two well apart."""
    number = draw(count)
    made = []
    for index in range(number):
        centre = np.array([draw(st.floats(-2500, 2500)), draw(st.floats(-1500, 500)), draw(st.floats(-2000, 2000))])
        made.append(looking(f"camera {index}", centre, roll=draw(st.floats(-3, 3))))
    tilt, turn = draw(st.floats(-1.2, 1.2)), draw(st.floats(-np.pi, np.pi))
    direction = np.array([np.sin(turn) * np.cos(tilt), np.sin(tilt), np.cos(turn) * np.cos(tilt)])
    shift = np.array([draw(st.floats(-100, 100)) for _ in range(3)])
    truth = Cylinder(TARGET + shift, direction, draw(st.floats(10, 250)))
    for camera in made:
        ray = truth.point - camera.projection_centre
        assume(abs(ray @ direction) < 0.9 * np.linalg.norm(ray))
    assume(intersection_angles(made, truth).max() > np.radians(5))
    return tuple(made), truth


# two images and more


@settings(max_examples=50)
@given(rigs())
def test_exact_planes_of_both_edges_give_the_exact_pipe(rig):
    made, truth = rig
    planes = [apparent(camera, truth) for camera in made]
    solution = cylinder_from_images(planes)
    assert_same(solution.cylinder, truth, made[0])
    assert np.abs(solution.residuals).max() < 1e-6
    assert solution.redundancy == 4 * len(made) - 5
    assert solution.sides.tolist() == [1.0] * (2 * len(made))
    assert solution.intersection_angle == pytest.approx(intersection_angles(made, truth).max(), abs=1e-9)
    assert_same(cylinder_from_centre_planes(planes), truth, made[0])


@settings(max_examples=50)
@given(rigs(), st.lists(st.integers(0, 2), min_size=4, max_size=4))
def test_any_mix_of_one_edge_and_both_gives_the_exact_pipe(rig, which):
    made, truth = rig
    planes = []
    for camera, choice in zip(made, which, strict=False):
        seen = apparent(camera, truth)
        planes.append(seen if choice == 2 else seen.edges[choice])
    flat = sum(1 if choice < 2 else 2 for choice in which[: len(made)])
    assume(flat > 2)
    # the image with a single edge must see the axis from elsewhere for its plane to say more than the others
    assume(min(np.sort(intersection_angles(made, truth), axis=1)[:, 1:].min(axis=1)) > np.radians(3))
    # two cameras may see their edges in one and the same plane, which then counts once
    normals = np.array([plane.normal for seen in planes for plane in getattr(seen, "edges", (seen,))])
    sines = np.linalg.norm(np.cross(normals[:, None], normals[None]), axis=2)
    assume(sines[np.triu_indices(len(normals), 1)].min() > 0.003)
    solution = cylinder_from_images(planes)
    assert_same(solution.cylinder, truth, made[0], 100 * EXACT)


def test_two_lenses_with_distortion_give_the_pipe():
    truth = pipe()
    planes = [apparent_pipe(camera, *true_edges(camera, truth)) for camera in (LEFT, RIGHT)]
    found = cylinder_from_images(planes).cylinder
    assert truth.distance(found.point[None])[0] < 1e-5
    assert 2 * found.radius == pytest.approx(truth.diameter, abs=1e-5)


def test_point_is_in_the_middle_of_what_is_seen():
    truth = pipe()
    solution = cylinder_from_images([apparent_pipe(camera, *true_edges(camera, truth, part=0.6)) for camera in cameras()])
    assert solution.half_length == pytest.approx(0.6 * truth.half_length, rel=0.05)
    assert solution.cylinder.point == pytest.approx((truth.start + truth.end) / 2, abs=0.05 * truth.half_length)


def test_direction_goes_as_the_first_edge_was_clicked():
    truth = pipe().cylinder
    edges = edges_of(LEFT, truth, 200.0)
    seen, other = apparent(RIGHT, truth), apparent_pipe(LEFT, *edges[:, ::-1])
    assert cylinder_from_images([apparent_pipe(LEFT, *edges), seen]).cylinder.direction @ truth.direction > 0.99
    assert cylinder_from_images([other, seen]).cylinder.direction @ truth.direction < -0.99
    assert cylinder_from_centre_planes([other, seen]).direction @ truth.direction < -0.99
    assert cylinder_from_diameter(other, 114.3).cylinder.direction @ truth.direction < -0.99


def monte_carlo(planes_of, truth, redundancy, solve=cylinder_from_images):
    """Compare the errors of many noisy solutions with their covariance: chi-square of five degrees of freedom."""
    squares, misfits, shifts, sigmas, rank = [], [], [], [], 5
    for seed in range(TRIALS):
        solution = solve(planes_of(np.random.default_rng(seed)))
        found, axes = solution.cylinder, solution.axes
        true_direction = truth.direction * np.sign(truth.direction @ found.direction)
        # where the true axis crosses the plane across the found one
        along = (found.point - truth.point) @ found.direction / (true_direction @ found.direction)
        shift = axes @ (found.point - truth.point - along * true_direction)
        tilt = solution.half_length * (axes @ (found.direction - true_direction))
        error = np.concatenate([shift, tilt, [found.radius - truth.radius]])
        rank = np.linalg.matrix_rank(solution.covariance, tol=1e-12)
        squares.append(error @ np.linalg.pinv(solution.covariance, rcond=1e-12) @ error)
        misfits.append(solution.sigma0**2 * solution.redundancy)
        shifts.append(np.linalg.norm(shift))
        sigmas.append(np.linalg.norm(solution.sigma_position))
        assert solution.redundancy == redundancy
    assert np.mean(squares) == pytest.approx(rank, abs=4 * np.sqrt(2 * rank / TRIALS))
    if redundancy:
        assert np.mean(misfits) == pytest.approx(redundancy, abs=4 * np.sqrt(2 * redundancy / TRIALS))
    assert np.sqrt(np.mean(np.square(shifts))) == pytest.approx(np.sqrt(np.mean(np.square(sigmas))), rel=0.15)


BOTH = slice(2)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tilt_deg", "edges", "sigma_px"),
    [((10.0, 15.0), (BOTH, BOTH), 0.3), ((10.0, 15.0), (BOTH, BOTH, BOTH), 0.3), ((10.0, 15.0), (BOTH, 0), 0.3), ((40.0, 10.0), (0, 1, 0), 0.1)],
    ids=["both edges in two images", "both in three", "both and one", "one in each of three"],
)
def test_errors_agree_with_the_sigmas(tilt_deg, edges, sigma_px):
    truth = pipe(tilt_deg=tilt_deg).cylinder

    def planes(noise):
        seen = [apparent(camera, truth, 250.0, 4, noise, sigma_px) for camera in STRAIGHT[: len(edges)]]
        return [one if which == BOTH else one.edges[which] for one, which in zip(seen, edges, strict=True)]

    monte_carlo(planes, truth, 2 * sum(2 if which == BOTH else 1 for which in edges) - 5)


def test_errors_from_a_diameter_agree_with_the_sigmas():
    truth = pipe().cylinder
    monte_carlo(
        lambda noise: (apparent(STRAIGHT[0], truth, 250.0, 4, noise, 0.3), 2 * truth.radius + noise.normal(0, 0.5)),
        truth,
        0,
        lambda seen: cylinder_from_diameter(*seen, 0.5),
    )


def test_third_image_and_finer_edges_sharpen_the_result():
    truth = pipe().cylinder
    two, three = ([apparent(c, truth) for c in cameras(n)] for n in (2, 3))
    fine = cylinder_from_images([apparent(c, truth, sigma_px=0.1) for c in cameras(2)])
    assert np.linalg.norm(cylinder_from_images(three).sigma_position) < np.linalg.norm(cylinder_from_images(two).sigma_position)
    assert fine.sigma_position == pytest.approx(0.1 * cylinder_from_images(two).sigma_position)
    assert fine.sigma_radius == pytest.approx(0.1 * cylinder_from_images(two).sigma_radius)
    assert fine.sigma_direction == pytest.approx(0.1 * cylinder_from_images(two).sigma_direction)


def test_depth_sigma_is_that_of_the_parallax():
    # upright and thin, two edges of one pixel each: depth^2 / base times the centre planes' sigma in each image
    base, distance = 600.0, 3000.0
    truth = Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), 5.0)
    made = [looking(name, np.array([x, 0.0, 0.0])) for name, x in (("left", -base / 2), ("right", base / 2))]
    solution = cylinder_from_images([apparent(c, truth, 200.0) for c in made])
    centre_plane = 1.0 / 6500 / np.sqrt(2) / np.sqrt(2)  # two clicks on each of two edges
    assert solution.sigma_position[1] == pytest.approx(distance**2 / base * centre_plane * np.sqrt(2), rel=0.03)
    # across the view the mean of both
    assert solution.sigma_position[0] == pytest.approx(distance * centre_plane / np.sqrt(2), rel=0.03)


def test_residuals_are_positive_where_an_edge_is_too_far_out():
    truth = pipe().cylinder
    left = edges_of(LEFT, truth, 250.0)
    outward = (left[0] - left[1]) / np.linalg.norm(left[0] - left[1], axis=1, keepdims=True)
    others = [apparent(c, truth, 250.0, sigma_px=1e-3) for c in (RIGHT, TOP)]  # these hold the pipe
    out = cylinder_from_images([apparent_pipe(LEFT, left[0] + 2 * outward, left[1], 1.0), *others])
    assert out.residuals[0] == pytest.approx([2.0, 2.0], rel=0.05)
    assert out.residuals[1:] == pytest.approx(0.0, abs=0.05)
    one_end = cylinder_from_images([apparent_pipe(LEFT, left[0] + [[0.0], [2.0]] * outward, left[1], 1.0), *others])
    assert one_end.residuals[0] == pytest.approx([0.0, 2.0], abs=0.1)
    assert out.sigma0 > 0.5


# three planes


def test_single_edge_with_its_side_gives_one_pipe_and_without_two():
    truth = pipe().cylinder
    both, single = apparent(LEFT, truth), apparent(RIGHT, truth).edges[0]
    known = cylinders_from_images([both, single])
    assert len(known) == 1
    assert_same(known[0].cylinder, truth, LEFT, 1e-7)
    unknown = cylinders_from_images([both, without_side(single.turned())])
    assert len(unknown) == 2
    assert sorted(s.sides[2] for s in unknown) == [-1.0, 1.0]
    true = next(s for s in unknown if s.sides[2] == -1)
    assert_same(true.cylinder, truth, LEFT, 1e-7)
    for solution in unknown:
        assert_touches(solution.cylinder, [*both.edges, single])
    # equally good: the nearer comes first
    distances = [np.linalg.norm(s.cylinder.point - LEFT.projection_centre) for s in unknown]
    assert distances == sorted(distances)


def test_both_pipes_of_three_planes_are_the_circles_of_a_triangle():
    # upright: cross-sections are circles in a wedge of half angle a at the left camera; the right edge's line
    # crosses the wedge's middle at the angle b and the distance s, so that the centres are at s / (1 +- sin a / sin b)
    truth = Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), 60.0)
    left, right = (looking(name, np.array([x, 0.0, 0.0])) for name, x in (("left", -300.0), ("right", 300.0)))
    both, single = apparent(left, truth), apparent(right, truth).edges[0]
    half_width = np.arcsin(60.0 / np.hypot(300.0, 3000.0))
    sine = abs(single.normal @ ((TARGET - left.projection_centre) / np.hypot(300.0, 3000.0)))
    ratio = (1 + np.sin(half_width) / sine) / (1 - np.sin(half_width) / sine)
    near, far = (s.cylinder for s in cylinders_from_images([both, without_side(single)]))
    distances = [np.linalg.norm((c.point - left.projection_centre)[:2]) for c in (near, far)]
    assert distances[1] / distances[0] == pytest.approx(ratio, rel=1e-9)
    assert far.radius / near.radius == pytest.approx(ratio, rel=1e-9)


def test_ambiguous_side_is_told_with_the_camera_to_click_in():
    truth = pipe().cylinder
    planes = [apparent(LEFT, truth), without_side(apparent(RIGHT, truth).edges[0])]
    with pytest.raises(InputError, match=r"2 cylinders fit.*in camera right; click beside the edge, on the pipe"):
        cylinder_from_images(planes)


@settings(max_examples=40)
@given(rigs(st.just(3)), st.lists(st.integers(0, 1), min_size=3, max_size=3), st.lists(st.booleans(), min_size=3, max_size=3))
def test_three_single_edges_without_sides_give_up_to_four_pipes_that_all_touch(rig, which, turned):
    made, truth = rig
    angles = intersection_angles(made, truth)[np.triu_indices(3, 1)]
    assume(angles.min() > np.radians(6))
    planes = [apparent(camera, truth).edges[side] for camera, side in zip(made, which, strict=True)]
    # the triangle must be one
    assume(min(np.linalg.norm(np.cross(planes[i].normal, planes[j].normal)) for i, j in ((0, 1), (0, 2), (1, 2))) > np.sin(np.radians(3)))
    assume(truth.radius > 30)
    given_planes = [without_side(plane.turned() if turn else plane) for plane, turn in zip(planes, turned, strict=True)]
    found = cylinders_from_images(given_planes)
    assert 1 <= len(found) <= 4
    for solution in found:
        assert_touches(solution.cylinder, planes)
        for camera in made:
            ray = solution.cylinder.point - camera.projection_centre
            assert ray @ camera.rotation[2] > 0
    assert min(gap(s.cylinder, truth) + abs(s.cylinder.radius - truth.radius) for s in found) < 1e-3
    expected = [-1.0 if turn else 1.0 for turn in turned]
    assert expected in [s.sides.tolist() for s in found]


def test_fourth_plane_settles_the_sides():
    truth = pipe().cylinder
    planes = [apparent(LEFT, truth, sigma_px=0.3), *(without_side(apparent(c, truth, sigma_px=0.3).edges[0]) for c in (RIGHT, TOP))]
    solution = cylinder_from_images(planes)
    assert_same(solution.cylinder, truth, LEFT, 1e-7)
    assert solution.sides.tolist() == [1.0, 1.0, 1.0, 1.0]


def test_both_edges_of_an_image_settle_their_own_sides():
    # beside both planes a cylinder would have one of its edges behind the camera
    truth = pipe().cylinder
    planes = [without_side(plane) for camera in (LEFT, RIGHT) for plane in apparent(camera, truth, sigma_px=0.3).edges]
    planes[1] = planes[1].turned()
    solution = cylinder_from_images(planes)
    assert_same(solution.cylinder, truth, LEFT, 1e-7)
    assert solution.sides.tolist() == [1.0, -1.0, 1.0, 1.0]


def test_pipe_between_parallel_planes_is_found():
    # the left camera's right edge and the right camera's left edge are parallel: both see the pipe's sides straight on
    radius, distance = 300.0, 3000.0
    left, right = (looking(name, np.array([x, 0.0, 0.0]), np.array([x, distance, 0.0])) for name, x in (("left", -radius), ("right", radius)))
    top = looking("top", np.array([0.0, -2000.0, 100.0]))
    truth = Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), radius)
    planes = [min(apparent(c, truth).edges, key=lambda p: abs(p.normal[1])) for c in (left, right)]
    assert planes[0].normal == pytest.approx(-planes[1].normal, abs=1e-12)
    assert_same(cylinder_from_images([*planes, apparent(top, truth).edges[0]]).cylinder, truth, left, 1e-8)


def test_too_many_unknown_sides_are_refused():
    truth = pipe().cylinder
    made = [looking(f"camera {i}", np.array([200.0 * i - 900, 0.0, 0.0])) for i in range(9)]
    with pytest.raises(InputError, match="the sides of 9 edges are unknown"):
        cylinders_from_images([without_side(apparent(c, truth).edges[0]) for c in made])


# one image and a diameter


@given(rigs())
def test_one_image_and_the_diameter_give_the_exact_pipe(rig):
    made, truth = rig
    solution = cylinder_from_diameter(apparent(made[0], truth, 400.0), 2 * truth.radius)
    # the direction is that of the edges' convergence alone
    assert_same(solution.cylinder, truth, made[0], 1e-8)
    assert solution.redundancy == 0
    assert np.isnan(solution.sigma0)
    assert solution.sigma_radius == 0.0


@given(st.floats(10, 1000), st.floats(1.01, 3))
def test_distance_grows_with_the_diameter(diameter, factor):
    seen = apparent(LEFT, pipe().cylinder)
    one, other = (cylinder_from_diameter(seen, d).cylinder for d in (diameter, factor * diameter))
    assert other.point - LEFT.projection_centre == pytest.approx(factor * (one.point - LEFT.projection_centre), abs=1e-8)


def test_uncertain_diameter_makes_the_depth_uncertain():
    seen = apparent(LEFT, pipe(tilt_deg=(0.0, 0.0)).cylinder, sigma_px=1e-6)
    solution = cylinder_from_diameter(seen, 114.3, sigma_diameter=1.143)
    # one per cent of the diameter is one per cent of the distance
    assert np.linalg.norm(solution.sigma_position) == pytest.approx(0.01 * np.linalg.norm(TARGET - LEFT.projection_centre), rel=0.02)
    assert solution.sigma_radius == pytest.approx(1.143 / 2)


@pytest.mark.parametrize("diameter", [0.0, -48.3, np.nan, np.inf])
def test_diameters_that_are_none_are_refused(diameter):
    with pytest.raises(InputError, match=r"the pipe: diameter: .* is none; give it in mm"):
        cylinder_from_diameter(apparent(LEFT, pipe().cylinder), diameter)


def test_diameter_that_puts_the_pipe_at_the_lens_is_refused():
    truth = pipe()
    nearest = truth.distance(LEFT.projection_centre)[0] * 2.0 / truth.diameter
    with pytest.raises(InputError, match=f"2 mm would put it {nearest:.0f} mm from camera left"):
        cylinder_from_diameter(apparent(LEFT, truth.cylinder), 2.0)


def test_clicks_and_a_diameter_give_the_depth_as_well_as_they_say(shared):
    folder = shared / "scenes" / "dummy" / "A"
    station = read_station(folder / "station.json")
    clicked = json.loads((folder / "picks.json").read_text(encoding="utf-8"))["picks"]
    pipes = {one["id"]: one for one in json.loads((folder.parent / "truth.json").read_text(encoding="utf-8"))["pipes"]}
    world_from_level = np.array(json.loads((folder / "truth.json").read_text(encoding="utf-8"))["world_from_level"])
    ratios = []
    for pick in read_picks(folder / "picks.json", station).pipes:
        one = pipes[clicked[pick.index]["truth"]]
        camera = station.cameras[pick.camera]
        solution = cylinder_from_diameter(apparent_pipe(camera, *pick.edges), one["outer_diameter"])
        centre = solution.cylinder.point
        assert 3000 < np.linalg.norm(centre - camera.projection_centre) < 4500  # they hang 3.6 m away
        true = TruePipe(np.array(one["start"]), np.array(one["end"]), one["outer_diameter"])
        distance = true.distance(world_from_level[:3, :3] @ centre + world_from_level[:3, 3])[0]
        ratios.append(distance / np.linalg.norm(solution.sigma_position))
    assert len(ratios) > 5
    assert max(ratios) < 3.5
    assert 0.3 < np.sqrt(np.mean(np.square(ratios))) < 2.0


# degenerate configurations


def level_pipe(height=0.0, turn_deg=0.0):
    """Return a pipe in the plane of the left and the right camera, which are at height 0."""
    turn = np.radians(turn_deg)
    return Cylinder(np.add(TARGET, [0.0, 0.0, height]), np.array([np.cos(turn), np.sin(turn), 0.0]), 57.15)


@pytest.mark.parametrize("turn_deg", [0.0, 20.0, -35.0])
def test_pipe_in_one_plane_with_the_cameras_names_the_camera_that_helps(turn_deg):
    truth = level_pipe(turn_deg=turn_deg)
    planes = [apparent(c, truth, 150.0) for c in (LEFT, RIGHT)]
    for solve in (cylinder_from_images, cylinder_from_centre_planes):
        with pytest.raises(IntersectionError, match="the pipe: it lies in one plane with cameras left and right, so its depth cannot be") as error:
            solve(planes, cameras())
        assert error.value.remedy == "pick it in camera top as well"
        assert 2 in (error.value.pair.first, error.value.pair.second)
        assert error.value.pair.angle > np.radians(1)
        with pytest.raises(IntersectionError, match="give its diameter, or photograph it from another place"):
            solve(planes, (LEFT, RIGHT))
        with pytest.raises(IntersectionError, match="give its diameter") as error:
            solve(planes)
        assert error.value.pair is None
    helped = [*planes, apparent(TOP, truth, 150.0)]
    assert_same(cylinder_from_images(helped).cylinder, truth, LEFT, 1e-6)
    assert_same(cylinder_from_centre_planes(helped), truth, LEFT, 1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_pipe_in_one_plane_is_told_from_clicks_as_well(seed):
    noise = np.random.default_rng(seed)
    planes = [apparent(c, level_pipe(), 150.0, 2, noise, 1.5) for c in (LEFT, RIGHT)]
    with pytest.raises(IntersectionError, match="camera top as well"):
        cylinder_from_images(planes, cameras())


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("known", [True, False])
def test_single_edge_in_the_same_plane_is_told(seed, known):
    noise = np.random.default_rng(seed)
    single = apparent(RIGHT, level_pipe(), 150.0, 2, noise, 1.5).edges[seed % 2]
    with pytest.raises(IntersectionError, match="camera top as well"):
        cylinders_from_images([apparent(LEFT, level_pipe(), 150.0, 2, noise, 1.5), single if known else without_side(single)], cameras())


def test_edges_of_three_cameras_in_one_tangent_plane_are_told():
    made = (LEFT, looking("middle", np.zeros(3)), RIGHT)
    upper = [max(apparent(c, level_pipe()).edges, key=lambda plane: -plane.normal[2]) for c in made]
    with pytest.raises(IntersectionError, match=r"cameras left, middle and right, so .*; pick it in camera top as well"):
        cylinders_from_images(upper, (*made, TOP))


def test_camera_behind_the_other_in_the_plane_of_the_axis_is_told():
    # of different apparent widths, which tell the depth in theory
    truth = level_pipe()
    planes = [apparent(c, truth) for c in (looking("near", np.zeros(3)), looking("far", np.array([0.0, -800.0, 0.0])))]
    with pytest.raises(IntersectionError, match="cameras near and far"):
        cylinder_from_images(planes)


def test_depth_is_measured_once_the_angle_is_large_enough():
    angle_of = {}
    for height in (30.0, 200.0):
        truth = level_pipe()
        made = [looking("low", np.zeros(3)), looking("high", np.array([0.0, 0.0, height]))]
        angle_of[height] = intersection_angles(made, truth).max()
        planes = [apparent(c, truth, sigma_px=0.05) for c in made]
        if height < 100:
            with pytest.raises(IntersectionError, match=r"0\.57 deg apart") as error:
                cylinder_from_images(planes)
            assert error.value.angle == pytest.approx(np.arctan2(30.0, 3000.0), abs=1e-6)
            lenient = cylinder_from_images(planes, settings=TangentSettings(least_angle_deg=0.1))
            assert_same(lenient.cylinder, truth, made[0], 1e-7)
        else:
            assert_same(cylinder_from_images(planes).cylinder, truth, made[0])
    assert angle_of[200.0] == pytest.approx(np.arctan2(200.0, 3000.0))


# pairs


def test_angle_of_a_pair_is_that_of_its_base_seen_from_the_axis():
    upright = Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), 50.0)
    angles = intersection_angles(cameras(), upright)
    assert angles[0, 1] == pytest.approx(2 * np.arctan(300 / 3000))
    assert angles[0, 2] == pytest.approx(np.arctan(300 / 3000))  # its height does not count
    assert angles == pytest.approx(angles.T)
    assert np.diag(angles) == pytest.approx(0.0, abs=1e-12)
    level = Cylinder(TARGET, np.array([1.0, 0.0, 0.0]), 50.0)
    assert intersection_angles(cameras(), level)[0, 1] == pytest.approx(0.0, abs=1e-12)
    assert intersection_angles(cameras(), level)[0, 2] == pytest.approx(np.arctan(600 / 3000))


def test_cameras_on_opposite_sides_of_a_pipe_do_not_intersect():
    made = [looking("front", np.array([0.0, 0.0, 0.0])), looking("back", np.array([0.0, 6000.0, 0.0]))]
    assert intersection_angles(made, Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), 50.0))[0, 1] == pytest.approx(0.0, abs=1e-12)


def test_camera_on_the_axis_intersects_with_none():
    made = [looking("on", np.zeros(3)), looking("beside", np.array([500.0, 0.0, 0.0]))]
    assert intersection_angles(made, Cylinder(TARGET, np.array([0.0, 1.0, 0.0]), 50.0)) == pytest.approx(0.0, abs=1e-12)


@given(rigs())
def test_best_pair_has_the_largest_angle(rig):
    made, axis = rig
    pair = best_pair(made, axis)
    for i, one in enumerate(made):
        for j, other in enumerate(made[:i]):
            normals = [np.cross(axis.direction, c.projection_centre - axis.point) for c in (one, other)]
            cosine = abs(normals[0] @ normals[1]) / np.prod(np.linalg.norm(normals, axis=1))
            angle = np.arccos(min(cosine, 1.0))
            assert intersection_angles(made, axis)[i, j] == pytest.approx(angle, abs=1e-6)
            assert pair.angle >= angle - 1e-6
    assert pair.first < pair.second
    assert intersection_angles(made, axis)[pair.first, pair.second] == pair.angle


def test_best_pair_of_cameras_in_one_plane_is_a_pair_without_an_angle():
    pair = best_pair((LEFT, RIGHT), Cylinder(TARGET, np.array([1.0, 0.0, 0.0]), 50.0))
    assert (pair.first, pair.second) == (0, 1)
    assert pair.angle == pytest.approx(0.0, abs=1e-12)
    same = best_pair((LEFT, LEFT), Cylinder(TARGET, np.array([0.0, 0.0, 1.0]), 50.0))
    assert (same.first, same.second, same.angle) == (0, 1, 0.0)


def test_one_camera_is_no_pair():
    with pytest.raises(InputError, match="give two or more"):
        best_pair((LEFT,), pipe().cylinder)


# what cannot be


def test_one_image_without_a_diameter_is_not_enough():
    with pytest.raises(InputError, match="picked in camera left only; pick it in another camera as well, or give its diameter"):
        cylinder_from_images([apparent(LEFT, pipe().cylinder)])
    with pytest.raises(InputError, match="no camera"):
        cylinder_from_centre_planes([])


def test_two_edges_are_not_enough():
    truth = pipe().cylinder
    with pytest.raises(InputError, match="two edges are too few"):
        cylinder_from_images([apparent(c, truth).edges[0] for c in (LEFT, RIGHT)])


def upright_at(x, y, radius=50.0):
    return Cylinder(np.array([x, y, 0.0]), np.array([0.0, 0.0, 1.0]), radius)


def test_edges_that_meet_behind_the_cameras_are_refused():
    # the left camera's pipe is far to the left and the right one's far to the right: the planes part in front
    planes = [apparent(LEFT, upright_at(-700, 3000.0)), apparent(RIGHT, upright_at(700, 3000.0))]
    for solve in (cylinder_from_images, cylinder_from_centre_planes):
        with pytest.raises(InputError, match="the edges in cameras left and right are not those of one pipe") as error:
            solve(planes)
        assert not isinstance(error.value, IntersectionError)


def test_camera_inside_the_pipe_is_refused():
    # three cameras: the left and right see a wide pipe, which would swallow the third, whose planes are another's
    made = [looking(name, np.array([x, 0.0, 0.0])) for name, x in (("left", -1500.0), ("right", 1500.0))]
    inside = looking("inside", np.array([0.0, 2700.0, 0.0]), np.array([0.0, 6000.0, 0.0]))
    wide = [apparent(c, upright_at(0.0, 3000.0, 400.0), sigma_px=0.01) for c in made]
    stray = apparent(inside, upright_at(0.0, 5000.0, 300.0), sigma_px=1e3)
    with pytest.raises(InputError, match="a camera would be inside it"):
        cylinder_from_images([*wide, stray])


def test_planes_of_different_pipes_show_in_sigma0():
    planes = [apparent(LEFT, upright_at(0.0, 3000.0, 50.0)), apparent(RIGHT, upright_at(0.0, 3000.0, 30.0))]
    assert cylinder_from_images(planes).sigma0 > 3
    same = [apparent(c, upright_at(0.0, 3000.0, 50.0)) for c in (LEFT, RIGHT)]
    assert cylinder_from_images(same).sigma0 < 1e-6


def test_frames_far_from_the_origin_lose_nothing():
    shift = np.array([3e5, -2e5, 1e4])
    truth = pipe().cylinder
    made = [replace(c, projection_centre=c.projection_centre + shift) for c in cameras()]
    moved = replace(truth, point=truth.point + shift)
    assert_same(cylinder_from_images([apparent(c, moved) for c in made]).cylinder, moved, made[0], 1e-7)
