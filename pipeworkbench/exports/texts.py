# SPDX-License-Identifier: LGPL-2.1-or-later
"""The texts of what is written for people, in their languages, from ``resources/templates``."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from pipeworkbench.errors import InputError
from pipeworkbench.files import package_folder

LANGUAGES = ("en", "de")

Texts = Mapping[str, Any]


def texts_of(file: str, language: str, source: object) -> Texts:
    """Return one language's texts by their keys; ``source`` is what an unknown language is told of.

    Raises
    ------
    InputError
        Where the language is not one of LANGUAGES.
    """
    if language not in LANGUAGES:
        raise InputError(source, "language", f"there is no '{language}'", f"use one of {', '.join(LANGUAGES)}")
    texts: dict[str, Texts] = json.loads((package_folder("resources") / "templates" / file).read_text(encoding="utf-8"))
    return texts[language]


def named(texts: Texts, group: str, key: str) -> str:
    """Return the text of a key in a group, the key itself where the group does not hold it."""
    return str(texts[group].get(key, key))


def phrased(texts: Texts, group: str, text: str) -> str:
    """Return a text in the words of a group, whose keys are texts with places such as ``{cause}``; itself where none is like it.

    Examples
    --------
    >>> phrased({"remarks": {"{here} of {all}": "{here} von {all}"}}, "remarks", "1 of 2")
    '1 von 2'
    """
    for like, wanted in texts[group].items():
        found = re.fullmatch(re.sub(r"\\{(\w+)\\}", r"(?P<\1>.+)", re.escape(like)), text)
        if found:
            return str(wanted.format(**found.groupdict()))
    return text
