# SPDX-License-Identifier: LGPL-2.1-or-later
"""Metashape's exported cameras against the formulas of its manual."""

import foreign
import numpy as np
import pytest
from conversions import convert, refuse
from foreign import HEIGHT, WIDTH, assert_agrees, metashape_lens, poses
from scipy.spatial.transform import Rotation

from pipeworkbench.errors import InputError
from pipeworkbench.recon.formats import metashape
from pipeworkbench.recon.formats.rig import METRE
from pipeworkbench.recon.station import read_station

LENS = {"f": 1100.0, "cx": -7.5, "cy": 14.25, "b1": 2.5, "k1": -0.23, "k2": 0.09, "k3": -0.02, "p1": 0.004, "p2": -0.006}
ONE_CHUNK = {"rotation": Rotation.from_euler("xyz", [20, 40, -60], degrees=True).as_matrix(), "translation": [3.0, -2.0, 1.0], "scale": 0.37}
LOCAL = 'LOCAL_CS["Local Coordinates (m)",LOCAL_DATUM["Local Datum",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]]]'
GEOGRAPHIC = 'GEOGCS["WGS 84",DATUM["World Geodetic System 1984",SPHEROID["WGS 84",6378137,298.257223563]],UNIT["degree",0.01745329251994328]]'


def text(values):
    return " ".join(repr(float(value)) for value in np.ravel(values))


def calibration(values, kind="adjusted", lens_type="frame"):
    entries = "".join(f"<{name}>{value!r}</{name}>" for name, value in values.items())
    return f'<calibration type="{lens_type}" class="{kind}"><resolution width="{WIDTH}" height="{HEIGHT}"/>{entries}</calibration>'


def sensor(number, *calibrations, kind="frame"):
    return f'<sensor id="{number}" label="a" type="{kind}"><resolution width="{WIDTH}" height="{HEIGHT}"/>{"".join(calibrations)}</sensor>'


def transform(chunk=ONE_CHUNK, locked="true"):
    parts = "".join(f'<{name} locked="{locked}">{text(value)}</{name}>' for name, value in chunk.items())
    return f"<transform>{parts}</transform>"


def chunk_from_camera(pose, chunk=ONE_CHUNK):
    """Undo world_from_chunk: X_world = scale R X_chunk + t."""
    rotation = np.array(chunk["rotation"])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation.T @ pose.rotation.T
    matrix[:3, 3] = rotation.T @ (pose.centre - chunk["translation"]) / chunk["scale"]
    return matrix


def camera(number, label, pose, sensor_number=0, more="", chunk=ONE_CHUNK):
    matrix = text(chunk_from_camera(pose, chunk))
    return f'<camera id="{number}" sensor_id="{sensor_number}" label="{label}" {more}><transform>{matrix}</transform></camera>'


def document(sensors, cameras, chunk_transform=None, reference=LOCAL, components=""):
    placed = transform() if chunk_transform is None else chunk_transform
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<document version="1.5.0"><chunk label="Chunk 1" enabled="true">'
        f'<sensors next_id="1">{sensors}</sensors>{components}<cameras next_id="3" next_group_id="0">{cameras}</cameras>'
        f"<reference>{reference}</reference>{placed}</chunk></document>\n"
    )


@pytest.fixture
def cameras_xml(tmp_path):
    """Give a function that writes a document's text to a file."""

    def write(content):
        file = tmp_path / "cameras.xml"
        file.write_text(content, encoding="utf-8")
        return file

    return write


def three_cameras(rig=None, **options):
    rig = rig or poses()
    return "".join(camera(i, name, pose, **options) for i, (name, pose) in enumerate(zip(foreign.NAMES, rig, strict=True)))


UP = np.array([0.0, 0.0, 1.0])


def upright():
    """The poses turned so that z of the world is up, which is what Metashape's reference means."""
    rig = poses()
    # turn the world: level axes of the first camera become the world's
    level = foreign.level_from_world(rig[0], foreign.mean_up(rig))
    return [foreign.Pose(pose.rotation @ level.T, level @ pose.centre) for pose in rig]


def compare(station_file, rig, lenses, up, scale=1000.0, tolerance=foreign.TOLERANCE_PX):
    """Compare at points in front of the first camera of any rig."""
    station = read_station(station_file)
    original, first = poses()[0], rig[0]
    world = (foreign.points() - original.centre) @ original.rotation.T @ first.rotation + first.centre
    level = foreign.level_from_world(first, up)
    for converted_camera, pose, lens in zip(station.cameras, rig, lenses, strict=True):
        expected = lens(*foreign.ideal(pose, world).T)
        found = converted_camera.project(scale * (world - first.centre) @ level.T)
        inside = (expected > -0.5).all(axis=1) & (expected < [WIDTH - 0.5, HEIGHT - 0.5]).all(axis=1)
        assert inside.sum() > 80
        assert np.abs(found[inside] - expected[inside]).max() < tolerance
    return station


def test_projection_agrees_with_the_manuals_formula(cameras_xml, tmp_path):
    rig = upright()
    file = cameras_xml(document(sensor(0, calibration(LENS)), three_cameras(rig)))
    compare(convert(tmp_path, file), rig, [metashape_lens(LENS)] * 3, UP)


def test_centre_of_the_first_pixel_is_half_a_pixel_there_and_zero_here(cameras_xml):
    file = cameras_xml(document(sensor(0, calibration({"f": 1000.0})), three_cameras()))
    interior = metashape.read(file).views[0].interior
    assert (interior.cx, interior.cy) == ((WIDTH - 1) / 2, (HEIGHT - 1) / 2)


@pytest.mark.parametrize(
    "more",
    [{"k4": 0.004}, {"b2": 0.01}, {"p3": 0.0055, "p4": 0.0025}, {"k4": -0.003, "b2": -0.004, "p3": 0.005}],
    ids=lambda more: " ".join(more),
)
def test_terms_without_equivalent_are_approximated_within_a_hundredth_of_a_pixel(cameras_xml, tmp_path, caplog, more):
    rig = upright()
    file = cameras_xml(document(sensor(0, calibration(LENS | more)), three_cameras(rig)))
    compare(convert(tmp_path, file), rig, [metashape_lens(LENS | more)] * 3, UP, tolerance=0.01)
    assert "lens model approximated" in caplog.text


def test_fisheye_is_approximated_within_a_hundredth_of_a_pixel(cameras_xml, tmp_path):
    values = {"f": 1100.0, "cx": 3.0, "cy": -2.0, "k1": -0.02, "k2": 0.005, "p1": 0.0004}
    rig = upright()
    file = cameras_xml(document(sensor(0, calibration(values, lens_type="fisheye"), kind="fisheye"), three_cameras(rig)))
    compare(convert(tmp_path, file), rig, [metashape_lens(values, fisheye=True)] * 3, UP, tolerance=0.01)


def test_shear_beyond_what_is_supported_is_refused_with_the_deviation(cameras_xml):
    file = cameras_xml(document(sensor(0, calibration(LENS | {"b2": 3.0})), three_cameras()))
    error = refuse(file, file, "sensor '0': calibration (b2)", "deviates by up to")
    assert "b1, k1 to k3, p1 and p2" in error.remedy


def test_adjusted_calibration_comes_before_the_initial_one(cameras_xml):
    for order in (("initial", "adjusted"), ("adjusted", "initial")):
        both = [calibration({"f": 1000.0 if kind == "initial" else 1234.5}, kind) for kind in order]
        assert metashape.read(cameras_xml(document(sensor(0, *both), three_cameras()))).views[0].interior.fx == 1234.5
    only = document(sensor(0, calibration({"f": 1000.0}, "initial")), three_cameras())
    assert metashape.read(cameras_xml(only)).views[0].interior.fx == 1000


def test_each_camera_has_its_own_sensor(cameras_xml, tmp_path):
    rig = upright()
    lenses = [LENS | {"f": 1100.0 + 20 * i, "k1": -0.2 - 0.02 * i} for i in range(3)]
    sensors = "".join(sensor(5 + i, calibration(lens)) for i, lens in enumerate(lenses))
    cameras = "".join(camera(i, name, rig[i], 5 + i) for i, name in enumerate(foreign.NAMES))
    compare(convert(tmp_path, cameras_xml(document(sensors, cameras))), rig, [metashape_lens(lens) for lens in lenses], UP)


def test_disabled_and_unaligned_cameras_are_left_out_and_groups_are_entered(cameras_xml):
    rig = poses()
    cameras = (
        camera(0, "left", rig[0])
        + camera(1, "off", rig[0], more='enabled="false"')
        + '<camera id="2" sensor_id="0" label="lost"><orientation>1</orientation></camera>'
        + f'<group id="0" label="Group 1" type="folder">{camera(3, "right", rig[1], more="enabled=" + chr(34) + "true" + chr(34))}</group>'
    )
    file = cameras_xml(document(sensor(0, calibration(LENS)), cameras))
    assert [view.name for view in metashape.read(file).views] == ["left", "right"]


def test_disabled_camera_cannot_be_chosen(cameras_xml):
    rig = poses()
    cameras = camera(0, "left", rig[0]) + camera(1, "right", rig[1], more='enabled="0"') + camera(2, "top", rig[2])
    file = cameras_xml(document(sensor(0, calibration(LENS)), cameras))
    refuse(file, "the command line", "--cameras", "no oriented camera 'right'", cameras=["left", "right"])


def two_components():
    rig, other = poses(), {"rotation": np.eye(3), "translation": [0, 0, 0], "scale": 2.0}
    cameras = "".join(camera(i, name, rig[i % 2], more=f'component_id="{i // 2}"', chunk=(ONE_CHUNK, other)[i // 2]) for i, name in enumerate("abcd"))
    components = "".join(f'<component id="{i}">{transform(chunk)}</component>' for i, chunk in enumerate((ONE_CHUNK, other)))
    return document(sensor(0, calibration(LENS)), cameras, chunk_transform="", components=f"<components>{components}</components>")


def test_components_have_frames_of_their_own(cameras_xml):
    file = cameras_xml(two_components())
    refuse(file, file, "chunk", "aligned in 2 separate frames")
    refuse(file, "the command line", "--cameras", "no chunk or component", cameras=["a", "c"])
    for names in (["a", "b"], ["d", "c"]):
        views = metashape.read(file, names).views
        for view in views:
            pose = poses()["abcd".index(view.name) % 2]
            assert np.abs(view.projection_centre - pose.centre).max() < 1e-9
            assert np.abs(view.rotation - pose.rotation).max() < 1e-9


def test_scale_and_vertical_count_only_where_a_reference_or_scale_bar_has_fixed_them(cameras_xml):
    def read(chunk_transform, reference=LOCAL):
        return metashape.read(cameras_xml(document(sensor(0, calibration(LENS)), three_cameras(), chunk_transform, reference)))

    assert (read(transform()).millimetres_per_unit, read(transform()).up.tolist()) == (METRE, [0, 0, 1])
    free = transform(locked="false")
    assert (read(free).millimetres_per_unit, read(free).up) == (None, None)
    scale_bar = free.replace('<scale locked="false">', '<scale locked="true">')
    assert (read(scale_bar).millimetres_per_unit, read(scale_bar).up) == (METRE, None)
    assert (read("").millimetres_per_unit, read("").up) == (None, None)
    assert read(transform(), LOCAL.replace('"metre",1', '"millimetre",0.001')).millimetres_per_unit is None
    assert read(transform(), "").millimetres_per_unit == METRE


def test_missing_unit_is_refused(cameras_xml, tmp_path):
    file = cameras_xml(document(sensor(0, calibration(LENS)), three_cameras(), chunk_transform=""))
    with pytest.raises(InputError, match=r"not scaled.*depths and diameters would be wrong.*--unit"):
        convert(tmp_path, file)
    assert_agrees(convert(tmp_path, file, scale=1000.0 * ONE_CHUNK["scale"]), poses(), [metashape_lens(LENS)] * 3)


def test_vertical_of_geocentric_coordinates_is_the_ellipsoids_normal(cameras_xml):
    latitude, longitude = np.radians(48.5), np.radians(11.25)
    normal = np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])
    a, e2, height = 6378137.0, 0.00669437999014, 512.0
    curvature = a / np.sqrt(1 - e2 * np.sin(latitude) ** 2)
    place = normal * (curvature + height) - np.array([0, 0, e2 * curvature * np.sin(latitude)])
    rig = [foreign.Pose(pose.rotation, pose.centre + place) for pose in poses()]
    chunk = {"rotation": ONE_CHUNK["rotation"], "translation": place.tolist(), "scale": 3.0}
    file = cameras_xml(document(sensor(0, calibration(LENS)), three_cameras(rig, chunk=chunk), transform(chunk), GEOGRAPHIC))
    read = metashape.read(file)
    assert read.millimetres_per_unit == METRE
    assert np.degrees(np.arccos(min(1.0, read.up @ normal))) < 0.001
    assert np.abs(read.views[2].projection_centre - rig[2].centre).max() < 1e-8


def test_labels_without_ending_or_with_a_path_find_their_photographs(cameras_xml, tmp_path):
    rig = poses()
    labels = ("shot_1", "/home/user/images/shot_2.PNG", "C:\\images\\shot_3.png")
    cameras = "".join(camera(i, label, pose) for i, (label, pose) in enumerate(zip(labels, rig, strict=True)))
    file = cameras_xml(document(sensor(0, calibration(LENS)), cameras))
    station = read_station(convert(tmp_path, file, ("shot_1.jpg", "shot_2.PNG", "shot_3.png"), up=foreign.mean_up(rig)))
    assert [camera.name for camera in station.cameras] == ["shot_1", "shot_2", "shot_3"]
    assert [image.name for image in station.images] == ["shot_1.jpg", "shot_2.PNG", "shot_3.png"]


# ---------------------------------------------------------------- refused


def test_calibration_of_a_single_camera_is_refused(cameras_xml):
    file = cameras_xml(f'<?xml version="1.0"?>\n<calibration><projection>frame</projection><width>{WIDTH}</width><f>1000</f></calibration>')
    assert "Export Cameras" in refuse(file, file, "calibration", "single camera").remedy


def test_project_file_without_poses_is_refused(cameras_xml):
    file = cameras_xml('<document version="1.2.0" path="{projectname}.files/project.zip"/>')
    refuse(file, file, "document", "project without poses")


@pytest.mark.parametrize(
    ("old", "new", "key", "problem"),
    [
        ("<f>1100.0</f>", "", "sensor '0': calibration.f", "is missing"),
        ("<f>1100.0</f>", "<fx>1100.0</fx>", "sensor '0': calibration.f", "PhotoScan"),
        ("<f>1100.0</f>", "<f>0</f>", "sensor '0': calibration.f", "not positive"),
        ("<f>1100.0</f>", "<f>NaN</f>", "sensor '0': calibration.f", "not a finite number"),
        ("<k1>-0.23</k1>", "<k1>much</k1>", "sensor '0': calibration.k1", "not a number"),
        ("<k1>-0.23</k1>", "<k4>1e300</k4>", "sensor '0': calibration (k4)", ""),
        ('type="frame" class', 'type="spherical" class', "sensor '0': calibration.type", "'spherical' is not supported"),
        ('sensor_id="0"', 'sensor_id="3"', "camera 'left': sensor_id", "no sensor '3'"),
        ('label="right"', 'label="left"', "camera 'left'", "used twice"),
        ('<scale locked="true">0.37', '<scale locked="true">-0.37', "transform.scale", "is -0.37"),
        ('<scale locked="true">0.37', '<scale locked="true">one', "transform.scale", "not a number"),
        ('<rotation locked="true">', '<rotation locked="true">1 ', "transform.rotation", "has 10 numbers where 9 belong"),
        ("0.0 0.0 0.0 1.0</transform>", "0.0 0.0 0.0</transform>", "camera 'left': transform", "has 15 numbers"),
        ("0.0 0.0 0.0 1.0</transform>", "0.0 0.0 1.0 1.0</transform>", "camera 'left': transform", "last row"),
        ("<document", '<!DOCTYPE document [<!ENTITY a "b">]><document', "DOCTYPE", "not read"),
        ("</chunk>", "", "line 2", "not valid XML"),
    ],
)
def test_wrong_value_is_refused_with_its_key(cameras_xml, old, new, key, problem):
    content = document(sensor(0, calibration(LENS)), three_cameras())
    assert old in content
    file = cameras_xml(content.replace(old, new, 1))
    refuse(file, file, key, problem)


def test_reflected_camera_is_refused(cameras_xml):
    rig = poses()
    rig[1].rotation = rig[1].rotation * [[1], [1], [-1]]
    file = cameras_xml(document(sensor(0, calibration(LENS)), three_cameras(rig)))
    refuse(file, file, "camera 'right': transform", "reflection")


def test_cameras_of_a_multi_camera_system_without_own_poses_are_explained(cameras_xml):
    slaves = "".join(f'<camera id="{i}" sensor_id="0" master_id="0" label="{i}"/>' for i in range(3))
    file = cameras_xml(document(sensor(0, calibration(LENS)), slaves))
    assert "multi-camera system" in refuse(file, file, "chunk.cameras", "no enabled camera with a pose").remedy
