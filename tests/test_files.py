# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files are read with errors that name the place, and written whole or not at all."""

import os
import stat

import pytest

from pipeworkbench.errors import InputError
from pipeworkbench.files import key_path, package_folder, read_json, warn_of_unknown_keys, written_whole


def interrupted(path, error):
    """Begin to write a file and fail in the middle."""
    with written_whole(path) as temporary:
        temporary.write_text("half of ", encoding="utf-8")
        raise error


def test_written_file_has_its_content_and_leaves_nothing_else(tmp_path):
    target = tmp_path / "result.step"
    with written_whole(target) as temporary:
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".step"
        temporary.write_text("all of it", encoding="utf-8")
        assert not target.exists()
    assert target.read_text(encoding="utf-8") == "all of it"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("error", [ValueError("defect"), KeyboardInterrupt(), InputError("a", "b", "c", "d")])
def test_nothing_is_left_when_the_writing_fails(tmp_path, error):
    with pytest.raises(type(error)):
        interrupted(tmp_path / "result.json", error)
    assert list(tmp_path.iterdir()) == []


def test_old_content_is_kept_when_the_writing_fails(tmp_path):
    target = tmp_path / "result.json"
    target.write_text("old", encoding="utf-8")
    with pytest.raises(ZeroDivisionError):
        interrupted(target, ZeroDivisionError())
    assert target.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_full_disk_is_an_error_of_the_user_not_of_the_program(tmp_path):
    with pytest.raises(InputError, match="No space left"):
        interrupted(tmp_path / "result.json", OSError(28, "No space left on device"))
    assert list(tmp_path.iterdir()) == []


def test_missing_folder_is_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be written") as error, written_whole(tmp_path / "none" / "result.json"):
        pass
    assert "result.json" in error.value.source


@pytest.mark.skipif(os.name == "nt", reason="Windows has no umask")
@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_permissions_follow_the_umask(tmp_path, mask, mode):
    target = tmp_path / "result.json"
    before = os.umask(mask)
    try:
        with written_whole(target) as temporary:
            temporary.write_text("{}", encoding="utf-8")
        assert os.umask(mask) == mask  # looking at it has not changed it
    finally:
        os.umask(before)
    assert stat.S_IMODE(target.stat().st_mode) == mode


@pytest.mark.parametrize(
    ("location", "text"),
    [
        ((), ""),
        (("schema",), "schema"),
        (("cameras", 1, "image"), "cameras[1].image"),
        (("picks", 0, "edges", 1, 0), "picks[0].edges[1][0]"),
        (("a", "b", "c"), "a.b.c"),
    ],
)
def test_key_path_is_written_as_people_do(location, text):
    assert key_path(location) == text


def test_json_is_read(tmp_path):
    path = tmp_path / "data.json"
    path.write_text('{"größe": [1, 2.5, null]}', encoding="utf-8")
    assert read_json(path) == {"größe": [1, 2.5, None]}


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"data\.json: there is no such file"):
        read_json(tmp_path / "data.json")


def test_folder_is_refused_as_a_file(tmp_path):
    with pytest.raises(InputError, match="this is a folder"):
        read_json(tmp_path)


def test_broken_json_is_refused_with_line_and_column(tmp_path):
    path = tmp_path / "data.json"
    path.write_text('{\n  "a": 1,\n  "b": ]\n}', encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_json(path)
    assert error.value.key == "line 3, column 8"
    assert error.value.source == str(path)


@pytest.mark.parametrize(
    "content", [b"", b"\xff\xfe{\x00}\x00", b'{"name": "M\xfcller"}', b"[" * 100_000], ids=["empty", "UTF-16", "Latin-1", "too deep"]
)
def test_file_that_is_no_utf8_json_is_refused(tmp_path, content):
    path = tmp_path / "data.json"
    path.write_bytes(content)
    with pytest.raises(InputError, match="not valid JSON"):
        read_json(path)


@pytest.mark.parametrize("constant", ["NaN", "Infinity", "-Infinity"])
def test_constants_that_json_does_not_know_are_refused(tmp_path, constant):
    path = tmp_path / "data.json"
    path.write_text(f'{{"a": {constant}}}', encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_json(path)
    assert error.value.key == "a"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser may read everything")
def test_unreadable_file_is_refused(tmp_path):
    path = tmp_path / "data.json"
    path.write_text("{}", encoding="utf-8")
    path.chmod(0)
    with pytest.raises(InputError, match="cannot be read"):
        read_json(path)


def test_error_says_file_key_problem_and_remedy():
    assert str(InputError("a.json", "b[2]", "is wrong", "mend it")) == "a.json: b[2]: is wrong; mend it"
    assert str(InputError("a.json", "", "is wrong", "mend it")) == "a.json: is wrong; mend it"


def test_misspelt_key_is_refused_and_a_foreign_one_told():
    told = []
    warn_of_unknown_keys({"width": 1, "colour_space": 2}, ["width", "height"], "a.json", "cameras[0]", told.append)
    assert told == ["a.json: cameras[0].colour_space: unknown key, ignored"]
    with pytest.raises(InputError, match="did you mean 'height'") as error:
        warn_of_unknown_keys({"width": 1, "heigth": 2}, ["width", "height"], "a.json", "cameras[0]", told.append)
    assert error.value.key == "cameras[0].heigth"


def test_data_folders_are_found():
    assert (package_folder("standards") / "pipes_en10220.csv").is_file()
    with pytest.raises(InputError, match="nonsense"):
        package_folder("nonsense")
