# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents at the door: what is hostile, torn or too large is refused before it costs anything."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pipeworkbench.errors import InputError
from pipeworkbench.recon.formats import documents
from pipeworkbench.recon.formats.documents import read_bounded_json, read_text, read_xml, read_yaml
from pipeworkbench.recon.formats.recognition import READERS, read_rig

LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE document [<!ENTITY a "lol">'
    + "".join(f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(9))
    + "]><document>&j;</document>"
)


@pytest.fixture
def file(tmp_path):
    def write(content, name="document"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_entities_are_refused_in_every_encoding(file, encoding):
    content = LAUGHS.encode(encoding)
    with pytest.raises(InputError, match="DOCTYPE: document types are not read"):
        read_xml(file(content))


def test_yaml_aliases_are_refused(file):
    content = "a: &a [1, 1]\n" + "".join(f"{chr(98 + i)}: &{chr(98 + i)} [*{chr(97 + i)}, *{chr(97 + i)}]\n" for i in range(20))
    with pytest.raises(InputError, match=r"line 2, column 8: .*aliases .* are not read"):
        read_yaml(file(content))


def test_yaml_tags_make_nothing(file):
    content = "a: !!python/object/apply:os.system ['true']\nb: !!opencv-matrix\n   rows: 3\nc: 2001-99-99\nd: 0x1p\n"
    assert read_yaml(file(content)) == {"a": ["true"], "b": {"rows": "3"}, "c": "2001-99-99", "d": "0x1p"}


@pytest.mark.parametrize("content", ["a: 1\nb: 2\na: 3\n", "x:\n  a: 1\n  a: 3\n"])
def test_doubled_yaml_keys_are_refused(file, content):
    with pytest.raises(InputError, match=r"line 3, column .*the key 'a' is given twice"):
        read_yaml(file(content))


@pytest.mark.parametrize("content", ["a: [1, 2\nb: 3", "{[a]: 1}", "a: b: c", "\x07", "a: 1\n---\nb: 2\n", "[" * 20000])
def test_yaml_that_is_none_is_refused(file, content):
    with pytest.raises(InputError, match="not valid YAML"):
        read_yaml(file(content))


@pytest.mark.parametrize("content", ["<a>", "<a></b>", "no xml", '<?xml version="1.0" encoding="martian"?><a/>', b"<a>\xff</a>"])
def test_xml_that_is_none_is_refused(file, content):
    with pytest.raises(InputError, match="not valid XML"):
        read_xml(file(content))


def test_large_empty_and_missing_files_are_refused(file, tmp_path, monkeypatch):
    monkeypatch.setattr(documents, "LARGEST_YAML", 1000)
    with pytest.raises(InputError, match="larger than"):
        read_yaml(file("a: 1\n" * 1000))
    with pytest.raises(InputError, match="is empty"):
        read_text(file(""))
    with pytest.raises(InputError, match="no such file"):
        read_text(tmp_path / "nowhere")
    with pytest.raises(InputError, match="a folder, not a file"):
        read_text(tmp_path)
    with pytest.raises(InputError, match="not UTF-8"):
        read_text(file(b"a: \xff"))


def test_json_without_numbers_is_refused(file):
    with pytest.raises(InputError, match="finite"):
        read_bounded_json(file('{"a": NaN}'))


@pytest.mark.parametrize("form", [form for form in READERS if form != "colmap"])
@given(content=st.one_of(st.binary(min_size=1, max_size=80), st.text(min_size=1, max_size=80).map(str.encode)))
@example(content=b"cam0: {camera_model: pinhole}")
@example(content=b"<document><chunk/></document>")
@example(content=b"<opencv_storage><M1><data>1 2</data></M1><M2/></opencv_storage>")
@example(content=b"M1: 5\nM2: []\nD1: {}\nD2: {}\nR: []\nT: []")
@example(content=b'{"M1": {"rows": "x", "cols": [], "data": {}}, "M2": null, "R": [[], [1]], "T": {}}')
def test_any_content_is_read_or_refused_but_never_a_defect(tmp_path_factory, form, content):
    path = tmp_path_factory.mktemp("any") / "file"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_rig(path, form)
    assert error.value.remedy


@given(
    st.dictionaries(
        st.sampled_from(["cameraMatrix1", "M2", "K1", "K2", "D1", "D2", "R", "T", "imageSize", "distortion_model"]),
        st.recursive(
            st.one_of(st.none(), st.booleans(), st.floats(), st.text(max_size=5), st.integers()),
            lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(["rows", "cols", "data", "width"]), inner),
            max_leaves=12,
        ),
    )
)
def test_any_structure_of_a_calibration_is_refused_but_never_a_defect(tmp_path_factory, values):
    import json

    path = tmp_path_factory.mktemp("any") / "file.json"
    path.write_text(json.dumps({"K1": 0, "K2": 0} | values), encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_rig(path)
    assert error.value.remedy
