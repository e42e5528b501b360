# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files at the door: JSON is read with checks that name the key, and written whole or not at all."""

from __future__ import annotations

import contextlib
import difflib
import json
import math
import os
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pipeworkbench.errors import InputError, one_line

if TYPE_CHECKING:
    from pydantic import TypeAdapter

T = TypeVar("T")
MISSPELLING_SIMILARITY = 0.8  # difflib ratio above which an unknown key is taken for a slip of the pen


def package_folder(name: str) -> Path:
    """Return the folder of the project's data, ``standards`` or ``resources``.

    In a wheel they lie inside the package, in a checkout (and FreeCAD's Mod folder) beside it.
    """
    here = Path(__file__).resolve().parent
    for folder in (here / name, here.parent / name):
        if folder.is_dir():
            return folder
    raise InputError(here, "", f"the data folder '{name}' is missing", "install the package again")


def read_json(path: Path, *, keys_once: bool = False) -> Any:
    """Read a JSON file; raise InputError where it is missing, unreadable, not JSON or holds NaN or Infinity.

    ``keys_once`` refuses an object that has a key twice, of which the reader would drop the first.
    """

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        made = dict(pairs)
        if keys_once and len(made) < len(pairs):
            key = next(key for key, count in Counter(key for key, _ in pairs).items() if count > 1)
            raise InputError(path, key, "is given twice in one object", "keep one of them")
        return made

    try:
        data = json.loads(path.read_text(encoding="utf-8"), object_pairs_hook=once)
        # Python's reader takes NaN and Infinity, and makes infinity of 1e999
        location = next(_not_finite(data), None)
    except FileNotFoundError:
        raise InputError(path, "", "there is no such file", "check the path") from None
    except IsADirectoryError:
        raise InputError(path, "", "this is a folder, not a file", "name the file in it") from None
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise InputError(path, where, f"not valid JSON ({error.msg})", "correct the file there") from None
    except (UnicodeDecodeError, RecursionError, ValueError) as error:
        raise InputError(path, "", f"not valid JSON ({error})", "write it anew as UTF-8 JSON") from None
    except OSError as error:
        raise InputError(path, "", f"cannot be read ({error.strerror})", "check the permissions") from None
    if location is not None:
        raise InputError(path, key_path(location), "is not a finite number", "give a number")
    return data


def _not_finite(data: object, location: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the locations of numbers that are not finite."""
    if isinstance(data, float) and not math.isfinite(data):
        yield location
    elif isinstance(data, dict):
        for key, value in data.items():
            yield from _not_finite(value, (*location, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from _not_finite(value, (*location, index))


def key_path(location: Iterable[str | int]) -> str:
    """Write a location as people do: ``('cameras', 1, 'image')`` becomes ``cameras[1].image``."""
    text = ""
    for part in location:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def check(adapter: TypeAdapter[T], data: object, source: object, prefix: tuple[str | int, ...] = ()) -> T:
    """Validate data against a pydantic type; the first thing wrong becomes an InputError.

    ``prefix`` locates ``data`` inside ``source``, for parts that are checked by themselves.
    """
    from pydantic import ValidationError

    try:
        return adapter.validate_python(data)
    except ValidationError as failure:
        raise _as_input_error(failure.errors()[0], data, source, prefix) from None


def _as_input_error(error: Mapping[str, Any], data: object, source: object, prefix: tuple[str | int, ...]) -> InputError:
    # pydantic inserts the names of union members into the location: only keep what is in the data
    location: list[str | int] = []
    inside: Any = data
    for part in error["loc"]:
        if (isinstance(inside, Mapping) and part in inside) or (isinstance(inside, list | tuple) and isinstance(part, int) and part < len(inside)):
            inside = inside[part]
            location.append(part)
        elif error["type"] == "missing" and part == error["loc"][-1]:
            location.append(part)
    key = key_path((*prefix, *location))
    if error["type"] == "missing":
        keys = list(inside) if isinstance(inside, Mapping) else []
        close = difflib.get_close_matches(str(error["loc"][-1]), keys, 1, MISSPELLING_SIMILARITY)
        remedy = f"rename the key '{close[0]}' to it" if close else "add this key"
        return InputError(source, key, "is missing", remedy)
    value = repr(error["input"])
    shown = value if len(value) <= 60 else value[:57] + "..."
    message = error["msg"].removeprefix("Value error, ")
    message = message[:1].lower() + message[1:]
    if error["type"] == "predicate_failed" and isinstance(error["input"], float) and not math.isfinite(error["input"]):
        message = "input should be a finite number"
    return InputError(source, key, f"{message} (found {shown})", "correct this value")


def warn_of_unknown_keys(data: Mapping[str, Any], known: Iterable[str], source: object, location: str, warn: Callable[[str], None]) -> None:
    """Refuse keys that look like a misspelt known one and tell of the others, which are ignored."""
    known = list(known)
    for key in data:
        if key in known:
            continue
        close = [k for k in difflib.get_close_matches(key, known, 1, MISSPELLING_SIMILARITY) if k not in data]
        path = f"{location}.{key}" if location else key
        if close:
            raise InputError(source, path, "unknown key", f"did you mean '{close[0]}'?")
        warn(one_line(f"{source}: {path}: unknown key, ignored"))


@contextlib.contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Give a temporary name in the target's folder; rename it to the target when all went well.

    The temporary name keeps the target's ending, which decides the format for many writers.
    """
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
    except OSError as error:
        raise InputError(path, "", f"cannot be written ({error.strerror})", "choose an existing, writable folder") from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp makes private files: give the result the permissions any new file would have
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)
        temporary.replace(path)
    except OSError as error:
        raise InputError(path, "", f"cannot be written ({error.strerror or error})", "check the folder and the space on the disk") from None
    finally:
        temporary.unlink(missing_ok=True)
