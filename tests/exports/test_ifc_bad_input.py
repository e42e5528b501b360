# SPDX-License-Identifier: LGPL-2.1-or-later
"""IFC of what is bad: a file is written whole and valid, or an error says what to do and the target is as it was."""

import dataclasses
import json
import os
import subprocess
import sys
import tempfile
import textwrap

import ifc_checks as checks
import ifcopenshell
import ifcopenshell.simple_spf
import ifcopenshell.validate
import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.exports.ifc import SCHEMAS, IfcOptions, write_ifc
from pipeworkbench.pipeline import Cap, Elbow, Flange, Joint, Pipe, Pipeline, Reducer, Tee

SIZE = {"outer_diameter": 60.3, "wall_thickness": 2.9}
A = Pipe(id="A", start=(0.0, 0.0, 0.0), end=(500.0, 0.0, 0.0), **SIZE)
B = Pipe(id="B", start=(500.0, 0.0, 0.0), end=(900.0, 0.0, 0.0), **SIZE)
OLD = "what was there before\n"
LONG = "a name longer than IFC's labels hold " * 8
NAMES = [
    "",
    " ",
    "it's",
    "''",
    'say "DN 50"',
    "a\\b",
    "\\X2\\00E4\\X0\\",
    "Rohrstück Ü ß",
    "水管",
    "😀",
    "a\nb",
    "a\r\nb\tc",
    "\x00",
    "\x7f\x85",
    "\ud800",
    "#1;ENDSEC;",
    "/* no comment */",
]


@pytest.fixture
def target(tmp_path):
    path = tmp_path / "plant.ifc"
    path.write_text(OLD, encoding="utf-8")
    return path


def pipeline(*components, joints=(), **rest):
    return Pipeline(frame="A", components=components, joints=joints, **rest)


def faults_of(path):
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger)
    ifcopenshell.simple_spf.parse(filecontent=path.read_text(encoding="utf-8"), with_tree=False)  # raises where the text is not STEP
    return logger.statements


def refused_or_valid(made, target):
    """Return the model that was written, None where it was refused; in both cases nothing broken is left."""
    try:
        write_ifc(made, target)
    except InputError as error:
        said, result = str(error), None
    else:
        said = ""
        assert faults_of(target) == []
        result = ifcopenshell.open(str(target))
    assert "\n" not in said
    assert not said or target.read_text(encoding="utf-8") == OLD
    assert [entry.name for entry in target.parent.iterdir()] == [target.name]
    return result


# ---------------------------------------------------------------- texts


@pytest.mark.parametrize("schema", SCHEMAS)
@pytest.mark.parametrize("name", [*NAMES, LONG], ids=lambda name: ascii(name)[:24])
def test_any_name_is_written_and_read_again(target, name, schema):
    known = {"station": name, "standard": name, "loa": name, "extra": {"name": name, "system": name, "material": name, "colour": name}}
    named = dataclasses.replace(A, id=name, **known)
    joints = (Joint(a=name, a_port=1, b="B", b_port=0),)
    made = Pipeline(frame=name, components=(named, B), joints=joints, extra={"project": name, "date": name})
    write_ifc(made, target, IfcOptions(schema))
    assert faults_of(target) == []
    model = ifcopenshell.open(str(target))
    assert len(model.by_type("IfcPipeSegment")) == 2
    assert len(model.by_type("IfcRelConnectsPorts")) == 1
    if name.isprintable() and name.strip() and name != LONG:
        assert name in {item.Name for item in model.by_type("IfcPipeSegment")}
        assert checks.products_by_tag(model)[name].Name == name


def test_names_alike_in_all_that_a_label_holds_stay_two(target):
    made = pipeline(dataclasses.replace(A, id=LONG + "1"), dataclasses.replace(B, id=LONG + "2"))
    write_ifc(made, target)
    assert faults_of(target) == []
    model = ifcopenshell.open(str(target))
    assert len({item.GlobalId for item in model.by_type("IfcPipeSegment")}) == 2


def test_a_file_name_with_all_kinds_of_characters(tmp_path):
    path = tmp_path / "Rohr 'Ü' \"😀\" \\.ifc"
    write_ifc(pipeline(A, B), path)
    assert faults_of(path) == []
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


# ---------------------------------------------------------------- components

POINT = (100.0, 0.0, 0.0)
PLATE = {"flange_type": "11", "pn": 16.0, "D": 165.0, "C": 18.0, "length": 45.0}
TINY = {
    "pipe": Pipe(id="P", start=(0.0, 0.0, 0.0), end=(1e-9, 0.0, 0.0), **SIZE),
    "short pipe far away": Pipe(id="P", start=(1e7, 1e7, 0.0), end=(1e7, 1e7, 1e-3), **SIZE),
    "thin wall": Pipe(id="P", start=(0.0, 0.0, 0.0), end=POINT, outer_diameter=60.3, wall_thickness=1e-9),
    "wall of nearly the radius": Pipe(id="P", start=(0.0, 0.0, 0.0), end=POINT, outer_diameter=60.0, wall_thickness=29.9999999),
    "elbow": Elbow(id="E", start=POINT, end=POINT, intersection=POINT, angle_deg=90.0, bend_radius=76.0, **SIZE),
    "straight elbow": Elbow(id="E", start=(0.0,) * 3, end=(200.0, 0.0, 0.0), intersection=POINT, angle_deg=1e-6, bend_radius=76.0, **SIZE),
    "elbow that turns back": Elbow(id="E", start=(0.0,) * 3, end=(0.0,) * 3, intersection=POINT, angle_deg=180.0, bend_radius=76.0, **SIZE),
    "tight elbow": Elbow(id="E", start=(0.0,) * 3, end=(100.0, 100.0, 0.0), intersection=POINT, angle_deg=90.0, bend_radius=20.0, **SIZE),
    "reducer": Reducer(id="R", start=POINT, end=POINT, axis=(1.0, 0.0, 0.0), end_diameter=48.3, **SIZE),
    "reducer backwards": Reducer(id="R", start=POINT, end=(0.0,) * 3, axis=(1.0, 0.0, 0.0), end_diameter=48.3, **SIZE),
    "reducer without axis": Reducer(id="R", start=(0.0,) * 3, end=POINT, axis=(0.0, 0.0, 0.0), end_diameter=48.3, **SIZE),
    "tee": Tee(id="T", start=POINT, end=POINT, intersection=POINT, branch_end=POINT, branch_diameter=33.7, **SIZE),
    "tee without branch": Tee(id="T", start=(0.0,) * 3, end=(200.0, 0.0, 0.0), intersection=POINT, branch_end=POINT, branch_diameter=33.7, **SIZE),
    "flat cap": Cap(id="C", start=POINT, axis=(1.0, 0.0, 0.0), length=1e-9, **SIZE),
    "cap without axis": Cap(id="C", start=POINT, axis=(0.0, 0.0, 0.0), length=38.0, **SIZE),
    "flange without axis": Flange(id="F", face=POINT, axis=(0.0, 0.0, 0.0), **PLATE, **SIZE),
    "flange narrower than its pipe": Flange(id="F", face=POINT, axis=(1.0, 0.0, 0.0), **(PLATE | {"D": 20.0}), **SIZE),
    "flange shorter than its plate": Flange(id="F", face=POINT, axis=(1.0, 0.0, 0.0), **(PLATE | {"length": 1e-9}), **SIZE),
    "infinite": Pipe(id="P", start=(0.0, 0.0, 0.0), end=(float("inf"), 0.0, 0.0), **SIZE),
    "not a number": Pipe(id="P", start=(0.0, 0.0, 0.0), end=(float("nan"), 0.0, 0.0), **SIZE),
}


@pytest.mark.parametrize("kind", TINY)
def test_what_has_no_length_or_direction_leaves_no_broken_file(target, kind):
    model = refused_or_valid(pipeline(A, TINY[kind], B), target)
    if model is not None:
        assert len(checks.products_by_tag(model)) == 3


REFUSED = ["pipe", "elbow", "reducer", "reducer backwards", "tee", "flat cap", "infinite", "not a number"]


@pytest.mark.parametrize("kind", REFUSED)
def test_what_has_no_length_is_refused_by_its_name(target, kind):
    with pytest.raises(InputError, match=TINY[kind].id):
        write_ifc(pipeline(A, TINY[kind], B), target)


def test_an_id_used_twice_is_refused(target):
    with pytest.raises(InputError, match="'A' is used twice"):
        write_ifc(pipeline(A, A, B), target)
    assert target.read_text(encoding="utf-8") == OLD


JOINTS = {
    "twice": (Joint(a="A", a_port=1, b="B", b_port=0), Joint(a="A", a_port=1, b="B", b_port=0)),
    "both ways": (Joint(a="A", a_port=1, b="B", b_port=0), Joint(a="B", a_port=0, b="A", b_port=1)),
    "one port in two": (Joint(a="A", a_port=1, b="B", b_port=0), Joint(a="A", a_port=1, b="B", b_port=1)),
    "with itself": (Joint(a="A", a_port=0, b="A", b_port=1),),
    "a port with itself": (Joint(a="A", a_port=1, b="A", b_port=1),),
    "ring": (Joint(a="A", a_port=1, b="B", b_port=0), Joint(a="B", a_port=1, b="A", b_port=0)),
    "unknown": (Joint(a="A", a_port=1, b="nobody", b_port=0),),
    "no such port": (Joint(a="A", a_port=2, b="B", b_port=0),),
}


@pytest.mark.parametrize("kind", JOINTS)
def test_odd_joints_leave_no_broken_file(target, kind):
    refused_or_valid(pipeline(A, B, joints=JOINTS[kind]), target)


def test_a_ring_of_components_flows_round(target):
    made = pipeline(A, B, joints=JOINTS["ring"])
    write_ifc(made, target)
    model = ifcopenshell.open(str(target))
    flows = [{port.FlowDirection for port in checks.ports_of(product)} for product in checks.products_by_tag(model).values()]
    assert flows == [{"SOURCE", "SINK"}] * 2


INSULATION = [
    {"thickness": 0, "material": "Mineral wool"},
    {"thickness": "30", "material": "Mineral wool"},
    {"thickness": 1e400, "material": "Mineral wool"},
    {"thickness": 30},
    "30 mm",
]


@pytest.mark.parametrize("said", INSULATION, ids=repr)
def test_insulation_that_is_none_is_refused(target, said):
    with pytest.raises(InputError, match="insulation"):
        write_ifc(pipeline(dataclasses.replace(A, extra={"insulation": said})), target)
    assert target.read_text(encoding="utf-8") == OLD


# ---------------------------------------------------------------- where it is written

FULL_DISK = """
    import resource, sys
    from pathlib import Path
    from pipeworkbench.errors import InputError
    from pipeworkbench.exports.ifc import write_ifc
    from pipeworkbench.pipeline import Pipeline

    made, target = Pipeline.read(Path(sys.argv[1])), Path(sys.argv[2])
    answer = "no error"
    # a file that may not grow is a disk that is full; our own output goes into a pipe and is not limited
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), resource.RLIM_INFINITY))
    try:
        write_ifc(made, target)
    except InputError as error:
        answer = str(error)
    print(answer)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="limits on the size of files are Unix's")
@pytest.mark.parametrize("there", [True, False], ids=["over a file", "new"])
@pytest.mark.parametrize("part", [0.0, 0.5, 0.9999])
def test_a_full_disk_leaves_the_target_as_it_was(tmp_path, everything, part, there):
    source, target = tmp_path / "plant.json", tmp_path / "out" / "plant.ifc"
    target.parent.mkdir()
    everything.write(source)
    write_ifc(everything, target)
    size = target.stat().st_size
    target.unlink()
    if there:
        target.write_text(OLD, encoding="utf-8")
    command = [sys.executable, "-c", textwrap.dedent(FULL_DISK), str(source), str(target), str(int(size * part))]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=checks.ROOT)
    assert done.returncode == 0, done.stderr
    assert "cannot be written" in done.stdout
    assert [entry.name for entry in target.parent.iterdir()] == ([target.name] if there else [])
    assert not there or target.read_text(encoding="utf-8") == OLD


def test_a_folder_that_takes_no_files_is_told(target, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(tempfile, "mkstemp", refuse)
    with pytest.raises(InputError, match="Permission denied"):
        write_ifc(pipeline(A), target)
    assert target.read_text(encoding="utf-8") == OLD


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the superuser may write everywhere")
def test_a_read_only_folder_is_told(target):
    target.parent.chmod(0o500)
    try:
        with pytest.raises(InputError, match="cannot be written"):
            write_ifc(pipeline(A), target)
    finally:
        target.parent.chmod(0o700)
    assert target.read_text(encoding="utf-8") == OLD


def test_a_missing_folder_and_a_folder_of_that_name_are_told(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        write_ifc(pipeline(A), tmp_path / "missing" / "plant.ifc")
    (tmp_path / "plant.ifc").mkdir()
    with pytest.raises(InputError, match="cannot be written"):
        write_ifc(pipeline(A), tmp_path / "plant.ifc")
    assert [entry.name for entry in tmp_path.iterdir()] == ["plant.ifc"]


def test_the_command_line_tells_what_is_wrong_and_leaves_the_target(tmp_path, target):
    broken = pipeline(A, B, joints=JOINTS["twice"]).to_dict()
    source = tmp_path / "plant.json"
    source.write_text(json.dumps(broken), encoding="utf-8")
    command = [sys.executable, "-m", "pipeworkbench", "convert", str(source), "--out", str(target)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=checks.ROOT)
    if done.returncode:
        assert done.returncode == 2
        assert len(done.stderr.splitlines()) == 1
        assert target.read_text(encoding="utf-8") == OLD
    else:
        assert faults_of(target) == []
