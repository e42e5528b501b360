# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flanges from one click, at pipe ends and along pipes: what is found of flanges that are known exactly."""

import dataclasses

import numpy as np
import pytest
from synthetic import cameras, edge_view

from pipeworkbench.catalogue import catalogue
from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Flange, Pipe, Pipeline
from pipeworkbench.recon.camera import OpenCVInterior
from pipeworkbench.recon.flange_variants import flange_of
from pipeworkbench.recon.flanges import attach, attached, detect, from_pick, of_picks, partner_of, with_dimensions
from pipeworkbench.recon.picks import FlangePick

# 1.1 px per mm at 3.3 m, as the rig has at its usual range
INTERIOR = OpenCVInterior(2000, 1500, 3600.0, 3600.0, 1002.0, 748.0, (-0.08, 0.02, 2e-4, -3e-4))
FACE = np.array([40.0, 3300.0, 60.0])
AXIS = np.array([0.95, 0.25, 0.15]) / np.linalg.norm([0.95, 0.25, 0.15])
GASKET = 2.0
AXIAL_MM = 0.6  # what is asked for on average; here nothing but noise is wrong


def rig():
    return tuple(dataclasses.replace(camera, interior=INTERIOR) for camera in cameras())


def dimensions(flange_type, pn, dn, standard="EN 1092-1"):
    return catalogue().flanges(standard=standard, flange_type=flange_type, pn=pn, dn=dn)[0]


def pipe_between(name, start, end, diameter):
    return Pipe(id=name, start=tuple(FACE + start * AXIS), end=tuple(FACE + end * AXIS), outer_diameter=diameter)


def pair(one, other=None, raised=(True, True)):
    """Return two flanges face to face, or one alone, with their pipes."""
    diameter = one.pipe_diameter
    parts = [flange_of(one, FACE, AXIS, diameter, "left", raised=raised[0]), pipe_between("P1", -one.length, -500.0, diameter)]
    if other is not None:
        parts.append(flange_of(other, FACE + GASKET * AXIS, -AXIS, diameter, "right", raised=raised[1]))
        parts.append(pipe_between("P2", GASKET + other.length, 500.0, diameter))
    return parts


def views_of(parts):
    return tuple(edge_view(camera, parts, seed) for seed, camera in enumerate(rig()))


def pipes_of(parts, off=0.0):
    """Return the pipes as they might have been measured: a little off, and too short or too long."""
    across = np.cross(AXIS, [0.0, 0.0, 1.0])
    across *= off / np.linalg.norm(across)
    found = [part for part in parts if isinstance(part, Pipe)]
    return [
        dataclasses.replace(p, start=tuple(np.array(p.start) + across + 15 * AXIS), end=tuple(np.array(p.end) + across - 10 * AXIS)) for p in found
    ]


def click(flange, camera=0, off_px=1.5, index=7):
    """Return a click beside the middle of the rim's straight edge."""
    view = rig()[camera]
    middle = np.array(flange.face) - 0.6 * flange.C * np.array(flange.axis)
    sight = np.cross(view.projection_centre - middle, flange.axis)
    edge = middle + flange.D / 2 * sight / np.linalg.norm(sight)
    return FlangePick(index, camera, view.project(edge[None])[0] + [0.0, off_px])


def names(flange):
    return {(flange.standard, flange.flange_type, flange.pn), *((e["standard"], e["flange_type"], e["pn"]) for e in flange.equivalents)}


def axial(found, true):
    return float((np.array(found.face) - true.face) @ np.array(true.axis))


CASES = {
    "weld necks": (("11", 16, 40), ("11", 16, 40), (True, True)),
    "weld neck and plate": (("11", 6, 50), ("01", 6, 50), (True, False)),
    "thick weld necks": (("11", 40, 80), ("11", 40, 80), (True, True)),
    "plates": (("01", 16, 100), ("01", 16, 100), (False, False)),
    "hubs": (("12", 16, 100), ("12", 16, 100), (True, True)),
    "weld neck and blind": (("11", 16, 80), ("05", 16, 80), (True, True)),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_type_class_facing_and_face_are_found_from_one_click(case):
    one, other, raised = case
    parts = pair(dimensions(*one), dimensions(*other), raised)
    if other[0] == "05":
        parts = parts[:3]
        parts[2] = flange_of(dimensions(*other), FACE + GASKET * AXIS, -AXIS, dimensions(*one).pipe_diameter, "right", raised=True)
    true = parts[0]
    best = from_pick(views_of(parts), click(true), pipes_of(parts), station="S")[0].flange
    assert ("EN 1092-1", *one[:2]) in names(best)
    assert np.dot(best.axis, true.axis) > 0.999
    assert abs(axial(best, true)) < AXIAL_MM
    assert (best.K, best.L, best.bolts) == (true.K, true.L, true.bolts)
    assert best.pick == 7


def test_other_flange_of_the_pair_is_found_without_a_click():
    parts = pair(dimensions("11", 6, 50), dimensions("01", 6, 50), (True, False))
    found = of_picks(views_of(parts), [click(parts[0])], pipes_of(parts), "S")
    assert found.failures == ()
    mine, partner = found.flanges
    assert ("EN 1092-1", "01", 6.0) in names(partner)
    assert partner.pick is None
    assert abs(axial(partner, parts[2])) < AXIAL_MM
    assert np.dot(mine.axis, partner.axis) < -0.999


def test_open_end_has_no_partner():
    parts = pair(dimensions("11", 16, 100))
    views, pipes = views_of(parts), pipes_of(parts)
    candidate = from_pick(views, click(parts[0]), pipes)[0]
    assert ("EN 1092-1", "11", 16.0) in names(candidate.flange)
    assert partner_of(views, candidate, pipes) is None


def test_pipe_that_is_measured_two_millimetres_off_does_no_harm():
    parts = pair(dimensions("11", 16, 80), dimensions("11", 16, 80))
    best = from_pick(views_of(parts), click(parts[0]), pipes_of(parts, off=2.0))[0].flange
    assert ("EN 1092-1", "11", 16.0) in names(best)
    off = np.array(best.face) - parts[0].face
    assert abs(off @ AXIS) < AXIAL_MM
    assert np.linalg.norm(off - (off @ AXIS) * AXIS) < 2.0


def test_pipe_that_is_known_on_the_other_side_only_is_enough():
    parts = pair(dimensions("11", 16, 80), dimensions("11", 16, 80))
    best = from_pick(views_of(parts), click(parts[0]), pipes_of(parts)[1:])[0].flange
    assert ("EN 1092-1", "11", 16.0) in names(best)
    assert np.dot(best.axis, AXIS) > 0.999


def test_click_on_the_edge_of_the_face_means_the_same_flange():
    parts = pair(dimensions("11", 16, 100))
    true = parts[0]
    around = np.cross(AXIS, [0.0, 0.0, 1.0])
    around /= np.linalg.norm(around)
    towards = min((around, -around), key=lambda side: side[1])
    edge = np.array(true.face) - true.raised_face_height * AXIS + true.D / 2 * (0.5 * towards + np.sqrt(0.75) * np.cross(AXIS, towards))
    best = from_pick(views_of(parts), FlangePick(0, 0, rig()[0].project(edge[None])[0]), pipes_of(parts))[0].flange
    assert abs(axial(best, true)) < AXIAL_MM
    assert best.D == true.D


def test_face_stays_when_the_type_changes():
    flange = flange_of(dimensions("11", 16, 40), FACE, AXIS, 48.3, "F", raised=True)
    other = with_dimensions(flange, dimensions("01", 6, 40))
    assert other.face == flange.face
    assert other.axis == flange.axis
    assert (other.flange_type, other.pn, other.D, other.length) == ("01", 6.0, 130.0, 16.0)
    assert other.id == "F"


def test_flange_attached_to_an_end_begins_where_the_pipe_ends():
    pipe = pipe_between("P", 0.0, 400.0, 48.3)
    flange = attached(pipe, 1, dimensions("11", 16, 40))
    weld_end = flange.ports[1]
    assert np.allclose(weld_end.point, pipe.end)
    assert np.allclose(flange.axis, AXIS)
    assert np.allclose(attached(pipe, 0, dimensions("11", 16, 40)).axis, -AXIS)


def test_flange_at_an_end_is_recognised_without_a_click():
    parts = pair(dimensions("11", 16, 100), dimensions("11", 16, 100))
    pipe = pipes_of(parts)[0]
    best = attach(views_of(parts), pipe, 0, pipes_of(parts)).flange
    assert ("EN 1092-1", "11", 16.0) in names(best)
    assert abs(axial(best, parts[0])) < AXIAL_MM


def test_no_flange_is_attached_where_none_is_seen():
    pipe = pipe_between("P1", -400.0, 400.0, 114.3)
    with pytest.raises(InputError, match="no flange is seen there"):
        attach(views_of([pipe]), pipe, 1)


@pytest.mark.slow
def test_flanges_along_a_pipe_are_proposed_without_a_click():
    parts = pair(dimensions("11", 16, 100), dimensions("11", 16, 100))
    found = detect(views_of(parts), pipes_of(parts), "S")
    assert len(found) == 2
    assert {round(float(np.dot(flange.axis, AXIS))) for flange in found} == {1, -1}
    for flange in found:
        true = parts[0] if np.dot(flange.axis, AXIS) > 0 else parts[2]
        assert abs(axial(flange, true)) < AXIAL_MM
        assert ("EN 1092-1", "11", 16.0) in names(flange)


@pytest.mark.slow
def test_nothing_is_proposed_on_a_plain_pipe_that_another_one_crosses():
    pipe = pipe_between("P1", -400.0, 400.0, 114.3)
    crossing = Pipe(id="P2", start=(60.0, 3100.0, -300.0), end=(90.0, 3100.0, 400.0), outer_diameter=60.3)
    assert detect(views_of([pipe, crossing]), [pipe, crossing]) == ()


def test_bad_clicks_are_named_and_the_others_still_processed():
    parts = pair(dimensions("11", 16, 80), dimensions("11", 16, 80))
    pipes = pipes_of(parts)
    picks = [
        FlangePick(0, 0, np.array([5000.0, 10.0])),
        FlangePick(1, 0, np.array([300.0, 1400.0])),
        click(parts[0], index=2),
        FlangePick(3, 0, rig()[0].project((FACE - 250 * AXIS)[None])[0] + [0.0, -105.0]),
    ]
    found = of_picks(views_of(parts), picks, pipes, "S")
    assert [flange.pick for flange in found.flanges if flange.pick is not None] == [2]
    messages = dict(found.failures)
    assert set(messages) == {0, 1, 3}
    assert "outside the image" in messages[0]
    assert "nearest pipe" in messages[1]
    assert "no rim" in messages[3]
    assert all("; " in message and "\n" not in message for message in messages.values())


def test_diameter_that_no_table_knows_is_named():
    parts = pair(dimensions("11", 16, 80))
    odd = [dataclasses.replace(pipe, outer_diameter=71.0) for pipe in pipes_of(parts)]
    with pytest.raises(InputError, match="no table has a flange"):
        from_pick(views_of(parts), click(parts[0]), odd)


def test_click_without_pipes_asks_for_the_pipe():
    parts = pair(dimensions("11", 16, 80))
    with pytest.raises(InputError, match="no pipe"):
        from_pick(views_of(parts), click(parts[0]), [])


def test_two_clicks_on_one_flange_give_it_once():
    parts = pair(dimensions("11", 16, 80))
    found = of_picks(views_of(parts), [click(parts[0], index=0), click(parts[0], camera=1, index=1)], pipes_of(parts), "S")
    assert len(found.flanges) == 1
    assert len(found.failures) == 1
    assert "same flange as pick" in found.failures[0][1]


def test_flange_with_all_its_keys_survives_the_file(tmp_path):
    flange = flange_of(dimensions("11", 16, 40), FACE, AXIS, 48.3, "F", raised=True)
    path = tmp_path / "pipeline.json"
    Pipeline(frame="S", components=(flange,)).write(path)
    (read,) = Pipeline.read(path).components
    assert isinstance(read, Flange)
    assert read == flange
