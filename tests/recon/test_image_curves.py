# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves drawn in photographs: contours with what hides them, epipolar curves, straight edges with distortion."""

from pathlib import Path

import numpy as np
import pytest
from parts import bend, straight
from synthetic import TARGET, cameras

from pipeworkbench.pipeline import Pipe
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.edges import detect_edges
from pipeworkbench.recon.image_curves import component_curves, contours_in, epipolar_curve, lines_in_photograph
from pipeworkbench.recon.lines import detect_lines
from pipeworkbench.recon.station import Station

CAMERAS = tuple(cameras())
STATION = Station("made up", CAMERAS, tuple(Path(camera.name) for camera in CAMERAS), Path("station.json"))


def test_every_camera_has_the_polylines_of_every_component():
    found = contours_in(STATION, (straight(), bend()))
    assert len(found) == 2
    assert all(set(by_camera) == {camera.name for camera in CAMERAS} for by_camera in found)


def test_polylines_are_the_visible_contour():
    pipe = straight()
    for camera in CAMERAS:
        contour = contour_of(camera, [pipe])
        drawn = np.concatenate(contours_in(STATION, [pipe])[0][camera.name])
        for sample in contour.position[contour.visible][::5]:
            assert np.linalg.norm(drawn - sample, axis=1).min() < 4  # half an interval


def test_a_pipe_is_closed_by_the_circles_of_its_ends():
    pipe = straight()
    lines = contours_in(STATION, [pipe])[0][CAMERAS[0].name]
    ends = CAMERAS[0].project(np.array([pipe.start, pipe.end]))
    radius_px = np.linalg.norm(np.diff(CAMERAS[0].project(np.array([pipe.start, np.add(pipe.start, (0, 0, pipe.outer_diameter / 2))])), axis=0))
    for end in ends:
        # some line lies within a radius of the end's centre, wherever it is in view
        if CAMERAS[0].sees(end[None])[0]:
            assert min(np.linalg.norm(line - end, axis=1).max() for line in lines) < 1.1 * radius_px


def test_what_another_pipe_hides_is_told_apart():
    behind = straight()
    before = Pipe(id="before", start=(0.0, 2500.0, -300.0), end=(0.0, 2500.0, 300.0), outer_diameter=60.3)
    alone = component_curves(STATION, [behind])[0]
    both = component_curves(STATION, [behind, before])[0]
    for camera in CAMERAS:
        seen_alone, seen = (sum(len(line) for line in curves[camera.name].seen) for curves in (alone, both))
        assert seen < seen_alone
        assert sum(len(line) for line in both[camera.name].hidden) > sum(len(line) for line in alone[camera.name].hidden)


def test_no_components_have_no_contours():
    assert contours_in(STATION, []) == []


def test_epipolar_curve_runs_through_the_point_at_every_distance():
    source, other = CAMERAS[0], CAMERAS[1]
    pixel = source.project(TARGET[None])[0]
    curve = epipolar_curve(source, tuple(pixel), other, (2500.0, 4000.0), samples=200)
    truth = other.project(TARGET[None])[0]
    distance = np.linalg.norm(TARGET - source.projection_centre)
    at = [np.interp(distance, curve.distance, curve.position[:, axis]) for axis in (0, 1)]
    assert at == pytest.approx(truth.tolist(), abs=0.02)
    assert (np.diff(curve.distance) > 0).all()
    assert other.sees(curve.position).all()


def test_straight_edges_come_back_to_where_they_are_in_the_photograph():
    interior = CAMERAS[0].interior
    picture = np.full((interior.height, interior.width), 60, np.uint8)
    picture[20:, :] = 180  # near the upper border, where the distortion is large
    edges = detect_edges(picture)
    lines = detect_lines(picture, edges, interior=interior)
    curves = lines_in_photograph(lines, interior)
    assert len(curves) == len(lines) > 0
    assert curves[0][:, 1] == pytest.approx(19.5, abs=1.0)
