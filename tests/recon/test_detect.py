# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pipes without picks: what is there is found once, what is not there is not found."""

import importlib.util
import itertools
import json

import cv2
import numpy as np
import pytest
from synthetic import HEIGHT, TARGET, WIDTH, _local_rays, cameras, pipe, views
from test_surface import PaintedPipe, Wall, mottled, photograph, stains

from pipeworkbench.recon.cylinder import Cylinders
from pipeworkbench.recon.detect import DetectSettings, detect, detect_cylinders
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.views import view_of, views_of

DN200 = pipe(219.1, (8.0, 3.0), centre=np.add(TARGET, [-160.0, 0.0, 0.0]))
DN125 = pipe(139.7, (-12.0, 5.0), centre=np.add(TARGET, [190.0, 100.0, 0.0]))
WALLS = {"plain": lambda points: np.full(len(points), 70.0), "textured": mottled(75.0, 12.0, 8)}


def shaded(truth, contrast=6.0):
    """Return the brightness of a pipe that is lit from the left and a little mottled."""
    light = np.array([-0.5, -0.8, 0.3]) / np.linalg.norm([-0.5, -0.8, 0.3])

    def paint(points):
        offset = points - truth.start
        normal = (offset - np.outer(offset @ truth.direction, truth.direction)) / (truth.diameter / 2)
        return 150 + 60 * np.maximum(normal @ light, 0) + contrast * stains(points)

    return paint


def pictured(things, count=3):
    """Return views with edges: each pixel is the mean of four rays."""
    made = []
    for number, camera in enumerate(cameras(count)):
        pictures = [photograph(camera, things, 90 + 4 * number + k, rays @ camera.rotation) for k, rays in enumerate(_local_rays())]
        made.append(view_of(camera, np.clip(np.rint(np.mean(pictures, axis=0)), 0, 255).astype(np.uint8)))
    return made


@pytest.fixture(scope="module", params=WALLS)
def two_pipes(request):
    return pictured([Wall(3700.0, WALLS[request.param]), *(PaintedPipe(truth, shaded(truth)) for truth in (DN200, DN125))])


def view_all(pictures):
    return [view_of(camera, picture.astype(np.uint8)) for camera, picture in zip(cameras(len(pictures)), pictures, strict=True)]


def assert_is(candidate, truth):
    assert candidate.size.outer_diameter == truth.diameter
    assert truth.distance(candidate.ends).max() < 3.0
    assert candidate.diameter == pytest.approx(truth.diameter, rel=0.01)


@pytest.mark.slow
def test_two_pipes_of_different_diameter_are_found_before_a_wall(two_pipes):
    found = {candidate.size.outer_diameter: candidate for candidate in detect(two_pipes)}
    assert sorted(found) == [139.7, 219.1]
    assert_is(found[219.1], DN200)
    assert_is(found[139.7], DN125)


@pytest.mark.slow
def test_detected_cylinders_are_distinct_sizes_fit_and_the_best_comes_first(two_pipes):
    settings = DetectSettings()
    said = []
    found = detect_cylinders(two_pipes, settings, said.append)
    assert len(found.cylinders) == len(found.extents) == len(found.sizes) == len(found.confidence) >= 2
    assert said == list(dict.fromkeys(said)) != []
    for size, radius in zip(found.sizes, found.cylinders.radii, strict=True):
        assert 2 * radius == pytest.approx(size.outer_diameter, rel=settings.tolerance)
    length = found.extents[:, 1] - found.extents[:, 0]
    assert (length >= settings.slenderness * 2 * found.cylinders.radii).all()
    assert (np.diff(found.confidence * np.sqrt(length)) <= 0).all()
    for one, other in itertools.combinations(range(len(length)), 2):
        assert not same_place(found.cylinders, found.extents, one, other)


def same_place(cylinders, extents, one, other):
    """Tell whether the middle of a cylinder is in another one of like direction."""
    middle = cylinders.points[one] + extents[one].mean() * cylinders.directions[one]
    offset = middle - cylinders.points[other]
    along = offset @ cylinders.directions[other]
    across = np.linalg.norm(offset - along * cylinders.directions[other])
    parallel = abs(cylinders.directions[one] @ cylinders.directions[other]) > 0.98
    return parallel and across < cylinders.radii[other] and extents[other, 0] < along < extents[other, 1]


@pytest.mark.slow
def test_no_two_pipes_are_in_the_same_place(two_pipes):
    found = detect(two_pipes)
    cylinders = Cylinders(
        np.array([candidate.solution.cylinder.point for candidate in found]),
        np.array([candidate.solution.cylinder.direction for candidate in found]),
        np.array([candidate.solution.cylinder.radius for candidate in found]),
    )
    extents = np.array([candidate.extent for candidate in found])
    for one, other in itertools.permutations(range(len(found)), 2):
        assert not same_place(cylinders, extents, one, other)


@pytest.mark.slow
def test_pipes_out_of_the_ranges_are_not_found(two_pipes):
    assert {candidate.size.outer_diameter for candidate in detect(two_pipes, DetectSettings(diameter_range=(150.0, 700.0)))} == {219.1}
    assert detect(two_pipes, DetectSettings(working_range=(4500.0, 12000.0))) == ()


@pytest.mark.slow
def test_stripe_painted_on_a_wall_is_no_pipe():
    def paint(points):
        return mottled(100.0, 8.0)(points) + np.where(np.abs(points[:, 0]) < DN200.diameter / 2, 60.0, 0.0)

    assert detect(pictured([Wall(3000.0, paint)])) == ()


@pytest.mark.slow
def test_two_pictures_are_enough(two_pipes):
    found = detect(two_pipes[:2])
    assert {candidate.size.outer_diameter for candidate in found} >= {219.1}
    assert_is(next(candidate for candidate in found if candidate.size.outer_diameter == 219.1), DN200)


@pytest.mark.slow
def test_one_picture_alone_finds_nothing(two_pipes):
    assert detect(two_pipes[:1]) == ()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_empty_pictures_have_no_pipes(count):
    blank = view_all([np.full((HEIGHT, WIDTH), 100)] * count)
    assert sum(len(view.edges) for view in blank) == 0
    assert detect(blank) == ()
    found = detect_cylinders(blank)
    assert (len(found.cylinders), found.extents.shape, found.sizes, found.confidence.shape) == (0, (0, 2), (), (0,))


@pytest.mark.parametrize("seed", [1, 2])
def test_noise_has_no_pipes(seed):
    rng = np.random.default_rng(seed)
    assert detect(view_all([rng.integers(0, 256, (HEIGHT, WIDTH)) for _ in range(3)])) == ()


@pytest.mark.slow
def test_clutter_that_differs_from_picture_to_picture_has_no_pipes():
    rng = np.random.default_rng(3)
    clutter = [np.clip(128 + 600 * cv2.GaussianBlur(rng.normal(0, 1, (HEIGHT, WIDTH)), (0, 0), 4.0), 0, 255) for _ in range(3)]
    assert all(len(view.edges) > 3000 for view in view_all(clutter))
    assert detect(view_all(clutter)) == ()


@pytest.mark.slow
def test_one_pattern_in_all_pictures_has_no_pipes():
    # what is at infinity looks alike from everywhere
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    stripes = 120 + 60 * np.sign(np.sin(u / 11 + v / 40))
    assert detect(view_all([stripes] * 3)) == ()


@pytest.mark.slow
def test_catalogue_without_a_size_in_the_range_has_no_pipes():
    seen = views([DN200], 2)
    assert all(len(view.edges) > 500 for view in seen)
    assert detect(seen, DetectSettings(diameter_range=(0.5, 1.0))) == ()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")  # the judge leaves its files open
def test_pipes_of_a_scene_with_known_truth_are_found(shared):
    spec = importlib.util.spec_from_file_location("score", shared / "tools" / "score.py")
    score = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(score)
    scene = shared / "scenes" / "dummy"
    truth = {one["id"]: one for one in json.loads((scene / "truth.json").read_text(encoding="utf-8"))["pipes"]}
    world_from_level = score.world_from_result(str(scene), "A")
    hit, false = set(), 0
    for candidate in detect(views_of(read_station(scene / "A"))):
        start, end = candidate.ends
        moved = score.move({"start": start, "end": end, "outer_diameter": candidate.size.outer_diameter}, world_from_level)
        right = {name for name, one in truth.items() if score.pipe_ok(score.pipe_dev(moved, one))}
        hit |= right
        false += not right
    assert len(hit) >= 7
    assert false <= 1
