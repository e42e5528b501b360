# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collects the texts of the window from the sources, keeps the translations (.ts) up to date and compiles them (.qm).

    make translations        or        python scripts/translations.py

New texts appear in ``resources/translations/PipeWorkbench_*.ts`` as unfinished: translate them there, with Qt Linguist or an
editor, and run it again. What is no longer in the sources stays as vanished, for texts come back. Python's standard library is all it needs.

Texts are: ``tr("...")``; ``QT_TRANSLATE_NOOP("context", "...")``; ``menu_text`` and ``tooltip`` of commands; ``title`` of
classes in the package's gui; ``Group("...")`` of the table of commands; tooltips of document objects' properties; names and
explanations of ``Format``, what is exported.
"""

from __future__ import annotations

import ast
import re
import struct
import sys
import xml.etree.ElementTree as ET  # our own files
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "pipeworkbench"
FOLDER = ROOT / "resources" / "translations"
LANGUAGES = ("de", "en")
OWN_LANGUAGE = "en"  # the sources'

CONTEXT, MENUS, PROPERTIES = "PipeWorkbench", "Workbench", "App::Property"
COMMAND_TEXTS = ("menu_text", "tooltip")
PROPERTY_TOOLTIP = 3  # position among the arguments of Property
FORMAT_TEXTS = slice(1, 3)  # positions among the arguments of Format
PLACEHOLDER = re.compile(r"{[^{}]*}")

# sections and tags of Qt's .qm files (qtranslator.cpp)
MAGIC = bytes.fromhex("3cb86418caef9c95cd211cbf60a1bddd")
HASHES, MESSAGES = 0x42, 0x69
END, TRANSLATION, SOURCE_TEXT, CONTEXT_NAME, COMMENT = 1, 3, 6, 7, 8

Key = tuple[str, str]  # context and text


@dataclass(frozen=True)
class Entry:
    """A translation; ``vanished`` where the sources no longer have the text."""

    text: str
    vanished: bool = False


def texts_of(folder: Path = SOURCES) -> dict[Key, str]:
    """Return the texts of all sources with the file each was found in first.

    Raises
    ------
    ValueError
        Where a text is put together before it is looked up, so that it can never be found.
    """
    found: dict[Key, str] = {}
    for path in sorted(folder.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
        for key in _texts_in(tree, path.relative_to(folder)):
            if key[1]:
                found.setdefault(key, str(path.relative_to(folder)))
    return found


def read_ts(path: Path) -> dict[Key, Entry]:
    """Return what a .ts file translates."""
    if not path.exists():
        return {}
    entries = {}
    for context in ET.parse(path).getroot().iter("context"):  # noqa: S314  # our own file
        name = context.findtext("name") or ""
        for message in context.iter("message"):
            translation = message.find("translation")
            text = "" if translation is None else translation.text or ""
            kind = "" if translation is None else translation.get("type", "")
            entries[name, message.findtext("source") or ""] = Entry(text, kind == "vanished")
    return entries


def updated(entries: Mapping[Key, Entry], texts: Iterable[Key], *, own: bool = False) -> dict[Key, Entry]:
    """Return the entries for these texts, new ones untranslated (``own``: as they are), and the others as vanished."""
    wanted = list(texts)
    now = {key: Entry(entries[key].text if key in entries and not own else key[1] if own else "") for key in wanted}
    gone = {} if own else {key: Entry(entry.text, vanished=True) for key, entry in entries.items() if key not in now and entry.text}
    return dict(sorted((now | gone).items()))


def ts_text(entries: Mapping[Key, Entry], language: str) -> str:
    """Return the .ts file of entries."""
    root = ET.Element("TS", version="2.1", language=language, sourcelanguage=OWN_LANGUAGE)
    for name in dict.fromkeys(context for context, _ in entries):
        context = ET.SubElement(root, "context")
        ET.SubElement(context, "name").text = name
        for (_, source), entry in ((key, entry) for key, entry in entries.items() if key[0] == name):
            message = ET.SubElement(context, "message")
            ET.SubElement(message, "source").text = source
            translation = ET.SubElement(message, "translation")
            translation.text = entry.text
            if entry.vanished or not entry.text:
                translation.set("type", "vanished" if entry.vanished else "unfinished")
    ET.indent(root, "    ")
    return '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n' + ET.tostring(root, encoding="unicode") + "\n"


def qm_bytes(entries: Mapping[Key, Entry]) -> bytes:
    """Return the .qm file of the entries that are in use and translated: messages in order, found by their texts' hash values."""
    messages, hashes = bytearray(), []
    for (context, source), entry in sorted(entries.items()):
        if entry.vanished or not entry.text:
            continue
        hashes.append((_elf_hash(source.encode()), len(messages)))
        messages += _tagged(TRANSLATION, entry.text.encode("utf-16-be")) + _tagged(COMMENT, b"")
        messages += _tagged(SOURCE_TEXT, source.encode()) + _tagged(CONTEXT_NAME, context.encode()) + bytes([END])
    table = b"".join(struct.pack(">II", *pair) for pair in sorted(hashes))
    return MAGIC + _tagged(HASHES, table) + _tagged(MESSAGES, bytes(messages))


def missing(entries: Mapping[Key, Entry], texts: Iterable[Key]) -> list[Key]:
    """Return the texts that are not translated."""
    return [key for key in texts if key not in entries or entries[key].vanished or not entries[key].text]


def wrong_placeholders(entries: Mapping[Key, Entry]) -> list[Key]:
    """Return the texts whose translation has other {placeholders}."""
    in_use = {key: entry for key, entry in entries.items() if entry.text and not entry.vanished}
    return [key for key, entry in in_use.items() if sorted(PLACEHOLDER.findall(key[1])) != sorted(PLACEHOLDER.findall(entry.text))]


def main() -> int:
    """Bring all languages up to date; 1 where a text is not translated."""
    texts = texts_of()
    FOLDER.mkdir(parents=True, exist_ok=True)
    lacking = 0
    for language in LANGUAGES:
        path = FOLDER / f"PipeWorkbench_{language}.ts"
        entries = updated(read_ts(path), texts, own=language == OWN_LANGUAGE)
        path.write_text(ts_text(entries, language), encoding="utf-8")
        path.with_suffix(".qm").write_bytes(qm_bytes(entries))
        for context, text in missing(entries, texts):
            print(f"{path.name}: not translated: [{context}] {text}  ({texts[context, text]})")
            lacking += 1
        for context, text in wrong_placeholders(entries):
            print(f"{path.name}: other placeholders than the text: [{context}] {text}")
            lacking += 1
    print(f"{len(texts)} texts in {', '.join(LANGUAGES)}; {lacking} to be translated")
    return 1 if lacking else 0


def _texts_in(tree: ast.Module, path: Path) -> Iterator[Key]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            yield from _texts_of_call(node, path)
        elif isinstance(node, ast.ClassDef):
            yield from _texts_of_class(node, path)


def _texts_of_call(call: ast.Call, path: Path) -> Iterator[Key]:
    name = call.func.id if isinstance(call.func, ast.Name) else call.func.attr if isinstance(call.func, ast.Attribute) else ""
    arguments = call.args
    if name == "tr" and arguments:
        if isinstance(arguments[0], ast.JoinedStr | ast.BinOp):
            raise ValueError(f"{path}:{call.lineno}: tr() of a text that is put together; put the values in afterwards, with .format()")
        yield from ((CONTEXT, text) for text in _literals(arguments[:1]))
    elif name in ("QT_TRANSLATE_NOOP", "translate") and len(arguments) == 2:
        context, text = _literals(arguments[:1]), _literals(arguments[1:])
        yield from ((c, t) for c in context for t in text)
    elif name == "Group" and arguments and path.parts[0] == "commands":
        yield from ((MENUS, text) for text in _literals(arguments[:1]))
    elif name == "Property":
        yield from ((PROPERTIES, text) for text in _literals(arguments[PROPERTY_TOOLTIP : PROPERTY_TOOLTIP + 1]))
    elif name == "Format" and path.parts[0] == "features":
        yield from ((CONTEXT, text) for text in _literals(arguments[FORMAT_TEXTS]))


def _texts_of_class(node: ast.ClassDef, path: Path) -> Iterator[Key]:
    constants = {
        target.id: statement.value.value
        for statement in node.body
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Constant) and isinstance(statement.value.value, str)
        for target in statement.targets
        if isinstance(target, ast.Name)
    }
    if path.parts[0] == "commands" and constants.get("name"):
        yield from ((constants["name"], constants[key]) for key in COMMAND_TEXTS if key in constants)
    elif path.parts[0] == "gui" and "title" in constants:
        yield CONTEXT, constants["title"]


def _literals(nodes: Iterable[ast.expr]) -> list[str]:
    return [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]


def _tagged(tag: int, data: bytes) -> bytes:
    return struct.pack(">BI", tag, len(data)) + data


def _elf_hash(data: bytes) -> int:
    """Return the hash value of System V's object files, as Qt uses it; never 0."""
    value = 0
    for byte in data:
        value = (value << 4) + byte
        high = value & 0xF0000000
        value = (value ^ (high >> 24)) & ~high
    return value or 1


if __name__ == "__main__":
    sys.exit(main())
