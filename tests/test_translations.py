# SPDX-License-Identifier: LGPL-2.1-or-later
"""The translations: complete, as the sources are, and compiled from what is committed."""

import importlib.util
import struct
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "resources" / "translations"
HOW = "run 'make translations' and translate what it names in resources/translations/PipeWorkbench_de.ts"


@pytest.fixture(scope="module")
def translations():
    specification = importlib.util.spec_from_file_location("translations", ROOT / "scripts" / "translations.py")
    module = importlib.util.module_from_spec(specification)
    sys.modules["translations"] = module
    specification.loader.exec_module(module)
    yield module
    del sys.modules["translations"]


def source(folder, name, text):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def test_every_text_has_a_german_translation(translations):
    texts = translations.texts_of()
    lacking = translations.missing(translations.read_ts(FOLDER / "PipeWorkbench_de.ts"), texts)
    listed = "\n".join(f"{texts[key]}: [{key[0]}] {key[1]}" for key in lacking)
    assert not lacking, f"not translated:\n{listed}\n{HOW}"


def test_translations_have_the_placeholders_of_their_texts(translations):
    for language in translations.LANGUAGES:
        assert translations.wrong_placeholders(translations.read_ts(FOLDER / f"PipeWorkbench_{language}.ts")) == []


def test_english_is_what_the_sources_say(translations):
    entries = translations.read_ts(FOLDER / "PipeWorkbench_en.ts")
    assert set(entries) == set(translations.texts_of()), HOW
    assert all(entry.text == text for (_, text), entry in entries.items())


def test_compiled_files_are_those_of_the_sources(translations):
    for language in translations.LANGUAGES:
        path = FOLDER / f"PipeWorkbench_{language}.ts"
        entries = translations.read_ts(path)
        assert path.with_suffix(".qm").read_bytes() == translations.qm_bytes(entries), HOW
        assert path.read_text(encoding="utf-8") == translations.ts_text(entries, language), HOW


def test_texts_are_found_where_they_are_written(translations, tmp_path):
    source(tmp_path, "gui/panel.py", 'class P:\n    title = "Pipe"\n\nA = QT_TRANSLATE_NOOP("PipeWorkbench", "One")\nb = tr("Two " "three")\n')
    source(
        tmp_path, "commands/a.py", 'class A(Command):\n    name = "PipeWB_A"\n    menu_text = "Do A"\n    tooltip = "It does A"\n    icon = "a.svg"\n'
    )
    source(tmp_path, "commands/__init__.py", 'G = Group("Bar", ())\n')
    source(
        tmp_path,
        "features/f.py",
        'p = Property("Length", "App::PropertyLength", "Pipe", "How long")\nf = Format(".csv", "Table", "A line each", "none")\n',
    )
    assert set(translations.texts_of(tmp_path)) == {
        ("PipeWorkbench", "Pipe"),
        ("PipeWorkbench", "One"),
        ("PipeWorkbench", "Two three"),
        ("PipeWB_A", "Do A"),
        ("PipeWB_A", "It does A"),
        ("Workbench", "Bar"),
        ("App::Property", "How long"),
        ("PipeWorkbench", "Table"),
        ("PipeWorkbench", "A line each"),
    }


def test_text_that_is_put_together_before_it_is_looked_up_is_refused(translations, tmp_path):
    source(tmp_path, "gui/a.py", 'text = tr(f"{count} pipes")\n')
    with pytest.raises(ValueError, match=r"a\.py:1"):
        translations.texts_of(tmp_path)


def test_texts_that_vanish_keep_their_translation_until_they_come_back(translations):
    entry = translations.Entry
    gone = translations.updated({("C", "old"): entry("alt"), ("C", "never"): entry("")}, [("C", "new")])
    assert gone == {("C", "new"): entry(""), ("C", "old"): entry("alt", vanished=True)}
    assert translations.missing(gone, [("C", "new")]) == [("C", "new")]
    assert translations.updated(gone, [("C", "old")]) == {("C", "old"): entry("alt")}


def test_compiled_messages_are_found_by_their_hash(translations):
    """Looks a text up as Qt does: hash value, offset, then the message's source and context."""
    data = translations.qm_bytes({("C", "Pipe"): translations.Entry("Röhre"), ("C", "open"): translations.Entry("")})
    assert data[:16] == translations.MAGIC
    tag, length = struct.unpack(">BI", data[16:21])
    assert (tag, length) == (translations.HASHES, 8)
    value, offset = struct.unpack(">II", data[21:29])
    assert (value, offset) == (0x57065, 0)  # of 'Pipe', by the definition of ELF's hash
    assert data[34 : 34 + 5] == struct.pack(">BI", translations.TRANSLATION, 10)
    assert data[39:49].decode("utf-16-be") == "Röhre"
