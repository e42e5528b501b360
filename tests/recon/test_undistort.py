# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures without distortion: straight lines, exact overlays, tables that are made once."""

import gc
import weakref
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from lenses import COEFFICIENTS, HEIGHT, RIG, STRONG, WIDTH, interiors, opencv, photogrammetric, whole_sensor

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Camera
from pipeworkbench.recon.undistort import CACHED_VIEWS, LARGEST_SIDE, undistorted_view

LENSES = {
    "barrel": STRONG,
    "wide barrel": opencv((-0.3, 0.1, 1e-3, -1e-3), focal=900.0),
    "pincushion": opencv((0.4, 0.1, 0, 0), focal=1000.0),
    "rational, prism and tilt": opencv(COEFFICIENTS[14]),
    "photogrammetric": photogrammetric(**RIG),
    "photogrammetric, almost folding": replace(photogrammetric(8.0, A1=7e-3), width=1296, height=972, pixel_pitch=0.008),
}
lenses = pytest.mark.parametrize("interior", LENSES.values(), ids=LENSES)


def sizes(interior):
    return np.array([interior.width, interior.height])


def as_numbers(tables):
    """Return the places (height, width, 2) that OpenCV's fixed-point tables stand for: fractions in 1/32 px."""
    whole, fraction = tables
    return whole + np.stack([fraction & 31, fraction >> 5], axis=-1) / 32


# ---------------------------------------------------------------- the picture


@lenses
def test_straight_edges_of_the_plant_are_straight(interior):
    view = undistorted_view(interior)
    u, v = np.meshgrid(*(np.arange(size, dtype=float) for size in sizes(interior)))
    ideal = interior.ideal(np.column_stack([u.ravel(), v.ravel()])).reshape(*u.shape, 2)
    for share, slope in ((-0.6, 0.0), (0.1, 0.35), (0.8, 0.35), (0.8, 0.0)):
        assert straightness(view, ideal, share * 0.8 * ideal[:, :, 1].max(), slope) < 0.05


def straightness(view, ideal, side, slope):
    """Return by how many px the edge y = side + slope * x is off its straight line in the picture.

    The photograph, whose pixels have these ideal coordinates (height, width, 2), is dark above the edge and bright below.
    """
    distance = (ideal[:, :, 1] - side - slope * ideal[:, :, 0]) * view.interior.pixels_per_radian
    picture = view.picture((30000 + 20000 * np.tanh(distance / 3)).astype(np.uint16)).astype(float) - 30000
    # where each column of the picture crosses the middle grey, between two whole photographed pixels
    columns = np.arange(0, view.pinhole.width, 7)
    expected = view.pinhole.cy + view.pinhole.fy * (side + slope * (columns - view.pinhole.cx) / view.pinhole.fx)
    above = np.floor(expected).astype(int)
    source = view.original(np.column_stack([columns, expected]))
    good = np.all((source > 3) & (source < sizes(view.interior) - 4), axis=1) & (above > 1) & (above < view.pinhole.height - 3)
    assert good.sum() > 40
    columns, above, expected = columns[good], above[good], expected[good]
    rows = above[:, None] + np.arange(-1, 3)
    values = picture[rows, columns[:, None]]
    first = np.argmax(np.diff(values > 0, axis=1), axis=1)
    here, there = values[np.arange(len(rows)), first], values[np.arange(len(rows)), first + 1]
    assert np.all((here <= 0) & (there > 0))
    crossing = above - 1 + first + here / (here - there)
    return np.abs(crossing - expected).max()


@lenses
def test_tables_say_where_every_pixel_comes_from(interior):
    view = undistorted_view(interior)
    v, u = np.mgrid[0 : view.pinhole.height : 5, 0 : view.pinhole.width : 5]
    exact = view.original(np.column_stack([u.ravel(), v.ravel()]))
    found = as_numbers(view.tables)[v.ravel(), u.ravel()]
    shown = np.all((exact >= 0) & (exact <= sizes(interior) - 1), axis=1)
    assert shown.mean() > 0.5
    assert np.abs(found - exact)[shown].max() < 0.01 + 1 / 64 + 1e-3
    # and nothing is shown twice or from nowhere
    nowhere = ~np.all((exact > -1.1) & (exact < sizes(interior) + 0.1), axis=1)
    assert not np.all((found > -1) & (found < sizes(interior)), axis=1)[nowhere].any()


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [(), (3,)], ids=["grey", "colour"])
def test_photograph_without_distortion_stays_as_it_is(dtype, channels):
    photograph = np.random.default_rng(1).integers(0, np.iinfo(dtype).max, (HEIGHT, WIDTH, *channels)).astype(dtype)
    for interior in (opencv(()), opencv((0.0,) * 5)):
        picture = undistorted_view(interior).picture(photograph)
        assert picture.dtype == dtype
        assert np.array_equal(picture, photograph)


def test_photogrammetric_camera_without_distortion_stays_as_it_is():
    interior = photogrammetric()
    photograph = np.random.default_rng(1).integers(0, 255, (interior.height, interior.width)).astype(np.uint8)
    assert np.array_equal(undistorted_view(interior).picture(photograph), photograph)


def test_picture_is_black_where_the_photograph_shows_nothing():
    interior = LENSES["wide barrel"]
    picture = undistorted_view(interior).picture(np.full((HEIGHT, WIDTH), 200, np.uint8))
    rows, columns = picture.shape
    assert (picture[rows // 2, columns // 2], picture[0, columns // 2], picture[rows // 2, 3]) == (200, 0, 0)


def test_photograph_of_another_camera_is_refused():
    with pytest.raises(ValueError, match="the calibration is for"):
        undistorted_view(STRONG).picture(np.zeros((WIDTH, HEIGHT), np.uint8))


# ---------------------------------------------------------------- size and scale


@lenses
def test_picture_shows_the_whole_field_and_ends_there(interior):
    view = undistorted_view(interior)
    border = view.undistorted(interior.border(200))
    size = sizes(view.pinhole)
    assert np.all((border > -0.6) & (border < size - 0.4))
    # the sides end with the pixel that shows the border
    assert np.all(border.min(axis=0) < 0.6)
    assert np.all(border.max(axis=0) > size - 1.6)


@lenses
@pytest.mark.parametrize("magnification", [1.0, 0.25, 1.5])
def test_scale_on_the_axis_is_the_photographs(interior, magnification):
    view = undistorted_view(interior, magnification)
    axis = interior.pixels(np.zeros((1, 2)))
    steps = view.undistorted(axis + np.array([[0.5, 0], [-0.5, 0], [0, 0.5], [0, -0.5]]))
    assert steps[0] - steps[1] == pytest.approx([magnification, 0], abs=0.07)  # the tilted sensor turns by its shear
    assert steps[2] - steps[3] == pytest.approx([0, magnification], abs=0.07)
    assert view.pinhole.pixels_per_radian == pytest.approx(interior.pixels_per_radian * magnification, rel=0.01)


def test_smaller_picture_shows_the_same():
    large, small = undistorted_view(STRONG), undistorted_view(STRONG, 0.25)
    assert sizes(small.pinhole) == pytest.approx(sizes(large.pinhole) / 4, abs=2)
    corners = whole_sensor(STRONG, 2, 2)
    # a pixel of the small picture covers four of the large one; both begin at a whole pixel
    difference = small.undistorted(corners) - (large.undistorted(corners) + 0.5) / 4
    assert np.ptp(difference, axis=0) == pytest.approx([0, 0], abs=1e-9)


def test_lens_of_almost_a_half_turn_does_not_give_an_endless_picture():
    interior = opencv((0.05, 0, 0, 0, 0, 0.3, 0, 0), focal=480.0)
    corner = interior.ideal(np.array([[0.0, 0.0]]))[0]
    assert abs(corner[0]) * interior.fx > 1.5 * WIDTH
    pinhole = undistorted_view(interior).pinhole
    assert 1.8 * WIDTH < pinhole.width <= 2 * WIDTH + 1
    assert pinhole.height <= 2 * HEIGHT + 1


def test_picture_beyond_opencvs_tables_is_refused():
    view = undistorted_view(replace(opencv(()), width=LARGEST_SIDE + 1))
    with pytest.raises(InputError, match="smaller magnification"):
        _ = view.tables


# ---------------------------------------------------------------- points for overlays


@settings(max_examples=30)
@given(interiors)
def test_points_come_back_both_ways(interior):
    view = undistorted_view(interior)
    pixels = whole_sensor(interior)
    there = view.undistorted(pixels)
    assert np.abs(view.original(there) - pixels).max() < 1e-6
    assert np.abs(view.undistorted(view.original(there)) - there).max() < 1e-6


@lenses
def test_pinhole_camera_projects_straight_into_the_picture(interior):
    view = undistorted_view(interior)
    camera = Camera("test", interior, np.eye(3), np.array([10.0, 20, 30]))
    points = camera.projection_centre + 4000 * camera.rays(whole_sensor(interior))
    picture = replace(camera, interior=view.pinhole).project(points)
    assert np.abs(picture - view.undistorted(camera.project(points))).max() < 1e-6


def test_points_outside_the_field_are_nan():
    view = undistorted_view(STRONG)
    assert np.isnan(view.original(np.array([[-1e5, 0.0], [0, 1e6]]))).all()
    assert np.isnan(view.undistorted(np.array([[np.nan, 3.0]]))).all()


# ---------------------------------------------------------------- made once


@pytest.fixture
def counted(monkeypatch):
    """Count the pixels that interior orientations map, by method."""
    counts = Counter()
    for kind in (type(STRONG), type(photogrammetric())):
        for name in ("pixels", "ideal"):
            real = getattr(kind, name)

            def method(self, points, real=real, name=name):
                counts[name] += len(points)
                return real(self, points)

            monkeypatch.setattr(kind, name, method)
    return counts


@pytest.mark.parametrize("interior", [STRONG, photogrammetric(**RIG)])
def test_second_picture_computes_no_distortion(interior, counted):
    interior = interior.with_parameters(interior.parameters)  # one that nobody has asked for yet
    photograph = np.zeros((interior.height, interior.width), np.uint8)
    undistorted_view(interior).picture(photograph)
    assert counted["pixels"] > 1000
    # a thirtieth of the pixels is computed, the others are interpolated
    assert counted["pixels"] < interior.width * interior.height / 20
    counted.clear()
    again = undistorted_view(interior)
    again.picture(photograph)
    assert not counted
    assert again.tables is undistorted_view(interior).tables


def test_only_a_rigs_tables_are_kept():
    views = [undistorted_view(opencv((-0.1, k2, 0, 0))) for k2 in np.linspace(0, 0.1, CACHED_VIEWS + 2)]
    kept = [weakref.ref(view) for view in views]
    del views
    gc.collect()
    assert sum(reference() is not None for reference in kept) == CACHED_VIEWS
