# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight edges: both detectors, the fit and its covariance, polarity, distortion, bad input."""

import cv2
import numpy as np
import pytest
from scipy.special import ndtr

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import OpenCVInterior
from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.lines import LineSettings, detect_lines, fit_segments

WIDTH, HEIGHT = 320, 240
BLUR_PX = 0.8


def bar(angle_deg, centre=(160.3, 119.6), half_width=20.0, half_length=90.0, noise=0.0, seed=0, low=60, high=170, dtype=np.uint8):
    """Return a picture of a bright bar; its long sides lie ``half_width`` to both sides of the centre."""
    v, u = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    tangent = np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])
    normal = np.array([-tangent[1], tangent[0]])
    along = (u - centre[0]) * tangent[0] + (v - centre[1]) * tangent[1]
    across = (u - centre[0]) * normal[0] + (v - centre[1]) * normal[1]
    inside = ndtr((half_width - np.abs(across)) / BLUR_PX) * ndtr((half_length - np.abs(along)) / BLUR_PX)
    image = low + (high - low) * inside
    if noise:
        image = image + np.random.default_rng(seed).normal(0, noise, image.shape)
    return np.clip(np.rint(image), 0, np.iinfo(dtype).max).astype(dtype), tangent, normal


def sides(lines, normal, centre=(160.3, 119.6)):
    """Return for both sides of the bar the line of the same direction that lies nearest."""
    offset = (lines.centre - centre) @ normal
    alike = np.abs(lines.direction @ normal) < 0.1
    return [np.flatnonzero(alike)[np.argmin(np.abs(offset[alike] - at))] for at in (-20.0, 20.0)]


@pytest.mark.parametrize("method", ["lsd", "hough"])
@pytest.mark.parametrize("angle_deg", [0, 13, 45, 77, 90, 121, 160])
def test_sides_of_a_bar_are_found_with_length_direction_and_polarity(method, angle_deg):
    image, tangent, normal = bar(angle_deg, noise=2.0)
    lines = detect_lines(image, detect_edges(image), method)
    assert (np.diff(lines.length) <= 0).all()
    for row, at in zip(sides(lines, normal), (-20.0, 20.0), strict=True):
        assert (lines.centre[row] - (160.3, 119.6)) @ normal == pytest.approx(at, abs=0.05)
        assert abs(lines.direction[row] @ tangent) == pytest.approx(1, abs=1e-5)
        assert 160 < lines.length[row] < 190
        assert lines.polarity[row] == 1
        # the bright side is inside, and on the right of the direction
        assert lines.normal[row] @ normal == pytest.approx(-np.sign(at), abs=1e-4)
        assert np.cross(lines.direction[row], lines.normal[row]) == pytest.approx(1)
        assert lines.residual_rms[row] < 0.2
        assert np.linalg.norm(lines.ends[row, 1] - lines.ends[row, 0]) == pytest.approx(lines.length[row])
        assert (lines.ends[row, 1] - lines.ends[row, 0]) @ lines.direction[row] > 0
        assert lines.support[row] == (lines.segment == row).sum()


@pytest.mark.parametrize("angle_deg", [3, 30])
def test_covariance_is_what_lines_scatter(angle_deg):
    offsets, turns, claimed = [], [], []
    for seed in range(40):
        image, tangent, normal = bar(angle_deg, noise=4.0, seed=seed)
        lines = detect_lines(image, detect_edges(image), settings=LineSettings(least_length=60))
        for row, at in zip(sides(lines, normal), (-20.0, 20.0), strict=True):
            along = (lines.centre[row] - (160.3, 119.6)) @ tangent
            direction = lines.direction[row] * np.sign(lines.direction[row] @ tangent)
            assert abs(along) < 20
            offsets.append((lines.centre[row] - (160.3, 119.6)) @ normal - at)
            turns.append(np.cross(tangent, direction))
            claimed.append(np.diag(lines.covariance[row]))
    sigma = np.sqrt(np.mean(claimed, axis=0))
    # 80 values tell their scatter to 8 %; the noise level at oblique edges is overestimated a little
    assert 0.4 < np.std(offsets) / sigma[0] < 1.3
    assert 0.4 < np.std(turns) / sigma[1] < 1.3


def test_longer_lines_are_known_better():
    results = []
    for half_length in (20, 40, 80):
        image, _, normal = bar(20, half_length=half_length, noise=3)
        lines = detect_lines(image, detect_edges(image))
        results.append(lines.covariance[sides(lines, normal)[0]].diagonal())
    (short, middle, long) = np.sqrt(results)
    assert 1.2 < short[0] / middle[0] < 2.0  # with the root of the length
    assert 2.0 < middle[1] / long[1] < 4.0  # with its power of 3/2


def test_a_line_is_one_segment_however_often_it_was_detected():
    image, tangent, normal = bar(25, noise=1)
    edges = detect_edges(image)
    first = np.array([160.3, 119.6]) + 20 * normal
    ends = np.array(
        [[first - 80 * tangent, first + 80 * tangent], [first - 78 * tangent, first + 70 * tangent], [first + 60 * tangent, first - 79 * tangent]]
    )
    lines = fit_segments(edges, ends)
    assert len(lines) == 1
    assert len(np.unique(lines.edge)) == len(lines.edge)


def test_segments_without_edges_fall_away():
    image, _, _ = bar(25)
    ends = np.array([[[10.0, 10.0], [80.0, 12.0]], [[5.0, 200.0], [9.0, 230.0]]])
    assert len(fit_segments(detect_edges(image), ends)) == 0


def test_outliers_beside_a_line_do_not_bend_it():
    image, tangent, normal = bar(0, noise=1)
    image[136:139, 200:215] = 250  # a spot near the lower side
    lines = detect_lines(image, detect_edges(image))
    row = sides(lines, normal)[1]
    assert (lines.centre[row] - (160.3, 119.6)) @ normal == pytest.approx(20, abs=0.05)
    assert abs(np.cross(lines.direction[row], tangent)) < 1e-3


def test_distortion_is_taken_off_before_the_fit():
    """A straight edge that the lens bends by several pixels is a line again, where it belongs."""
    interior = OpenCVInterior(WIDTH, HEIGHT, 300.0, 300.0, 160.0, 120.0, (-0.25, 0.05, 0.0, 0.0))
    straight = OpenCVInterior(WIDTH, HEIGHT, 300.0, 300.0, 160.0, 120.0)
    v, u = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    ideal = straight.pixels(interior.ideal(np.column_stack([u.ravel(), v.ravel()])))
    normal = np.array([np.sin(0.2), -np.cos(0.2)])
    distance = (ideal - (160, 40)) @ normal
    image = np.rint(60 + 120 * ndtr(distance / 0.8)).astype(np.uint8).reshape(HEIGHT, WIDTH)
    edges = detect_edges(image)
    bent, right = detect_lines(image, edges), detect_lines(image, edges, interior=interior, settings=LineSettings(least_length=60))
    assert right.length[0] > 70
    assert right.residual_rms[0] < bent.residual_rms[0] + 0.02
    for row in range(len(right)):
        assert (right.ends[row] - (160, 40)) @ normal == pytest.approx([0, 0], abs=0.1)
        assert right.normal[row] @ normal == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("method", ["lsd", "hough"])
def test_sixteen_bits_and_colours_will_do(method):
    image, _, normal = bar(33, noise=1)
    deep = image.astype(np.uint16) * 200
    colour = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    for other in (deep, colour):
        lines = detect_lines(other, detect_edges(other), method)
        for row, at in zip(sides(lines, normal), (-20.0, 20.0), strict=True):
            assert (lines.centre[row] - (160.3, 119.6)) @ normal == pytest.approx(at, abs=0.05)


@pytest.mark.parametrize("method", ["lsd", "hough"])
@pytest.mark.parametrize("image", [np.zeros((1, 1), np.uint8), np.full((50, 60), 9, np.uint8), np.zeros((3, 40), np.uint16)])
def test_images_without_edges_have_no_lines(method, image):
    lines = detect_lines(image, detect_edges(image), method)
    assert len(lines) == 0
    assert lines.ends.shape == (0, 2, 2)
    assert len(lines.edge) == 0


def test_wrong_calls_are_refused_in_words():
    image, _, _ = bar(0)
    edges = detect_edges(image)
    with pytest.raises(InputError, match="unknown"):
        detect_lines(image, edges, "ransac")
    with pytest.raises(InputError, match="find the edges of this image"):
        detect_lines(image[:-1], edges)
    with pytest.raises(InputError, match="8- or 16-bit"):
        detect_lines(image.astype(float), edges)


def test_edges_that_are_picked_in_real_photographs_are_straight(shared):
    """Photographs with the distortion taken off: pipes' edges have residuals below 0.3 px."""
    from pipeworkbench.recon.images import read_image
    from pipeworkbench.recon.picks import read_picks
    from pipeworkbench.recon.station import read_station

    station = read_station(shared / "scenes" / "eth3d_pipes" / "X")
    picks = read_picks(station.source.parent / "picks.json", station)
    checked = 0
    for camera in {pick.camera for pick in picks.pipes}:
        edges = detect_edges(read_image(station, camera))
        picked = np.concatenate([pick.edges for pick in picks.pipes if pick.camera == camera])
        lines = fit_segments(edges, picked, station.cameras[camera].interior, LineSettings(search_range=4.0))
        assert (lines.residual_rms < 0.3).mean() >= 0.9
        assert np.median(lines.residual_rms) < 0.25
        assert len(lines) >= 0.9 * len(picked)
        checked += len(lines)
    assert checked >= 10
