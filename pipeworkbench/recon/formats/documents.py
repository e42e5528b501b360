# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text, YAML, XML and JSON documents at the door: bounded, plain data only, nothing expanded."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeworkbench.errors import InputError, MissingPackageError
from pipeworkbench.files import read_json

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

LARGEST_DOCUMENT = 32 * 2**20  # bytes; a Metashape export takes about 2 kB per camera
LARGEST_YAML = 4 * 2**20  # bytes; the reader takes some seconds for so much


def read_bytes(path: Path, largest: int = LARGEST_DOCUMENT) -> bytes:
    """Return a file's bytes; InputError where it is missing, unreadable, empty or larger than ``largest`` bytes."""
    try:
        with path.open("rb") as file:
            data = file.read(largest + 1)
    except OSError as error:
        raise cannot_be_read(path, error) from None
    if len(data) > largest:
        raise InputError(path, "", f"is larger than {largest // 2**20} MB", "give a calibration file, not data")
    if not data:
        raise InputError(path, "", "is empty", "export the file again")
    return data


def cannot_be_read(path: Path, error: OSError) -> InputError:
    """Return the message for a file the system does not give."""
    if isinstance(error, FileNotFoundError):
        return InputError(path, "", "there is no such file", "check the path")
    if isinstance(error, IsADirectoryError):
        return InputError(path, "", "this is a folder, not a file", "name the file in it")
    return InputError(path, "", f"cannot be read ({error.strerror})", "check the permissions")


def read_text(path: Path, largest: int = LARGEST_DOCUMENT) -> str:
    """Return a UTF-8 file's text."""
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(path, f"byte {error.start}", "is not UTF-8 text", "write the file anew as UTF-8") from None


def read_yaml(path: Path) -> Any:
    """Return a YAML document as dictionaries, lists and texts: scalars stay text, tags are ignored.

    OpenCV's first line ``%YAML:1.0``, which no other reader takes, is understood. Aliases are refused: a few
    lines of them stand for gigabytes.
    """
    try:
        from pipeworkbench.recon.formats.plain_yaml import load
    except ModuleNotFoundError:
        raise MissingPackageError("PyYAML", "reading YAML files", "pip install 'pyyaml>=6.0,<7'") from None
    text = read_text(path, LARGEST_YAML)
    return load(text.partition("\n")[2] if text.startswith("%YAML:") else text, path)


def read_xml(path: Path) -> Element:
    """Return an XML document's root; document types, and with them entities, are refused."""
    from xml.etree import ElementTree as ET
    from xml.parsers import expat

    data = read_bytes(path)

    def refuse(*_: object) -> None:
        raise InputError(path, "DOCTYPE", "document types are not read: their entities can stand for gigabytes", "remove the DOCTYPE")

    try:
        scanner = expat.ParserCreate()
        scanner.StartDoctypeDeclHandler = refuse
        scanner.Parse(data, True)
        return ET.fromstring(data)  # noqa: S314  the scanner has refused what is dangerous
    except (expat.ExpatError, ET.ParseError) as error:
        line, column = getattr(error, "position", None) or (getattr(error, "lineno", 0), getattr(error, "offset", 0))
        raise InputError(path, f"line {line}, column {column + 1}", "not valid XML", "correct the file there or export it again") from None
    except (LookupError, ValueError) as error:
        raise InputError(path, "", f"not valid XML ({error})", "write the file anew as UTF-8") from None


def read_bounded_json(path: Path) -> Any:
    """Return a JSON document of limited size."""
    read_bytes(path)
    return read_json(path)
