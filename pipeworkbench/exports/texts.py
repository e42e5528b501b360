# SPDX-License-Identifier: LGPL-2.1-or-later
"""The texts of what is written for people, in their languages, from ``resources/templates``."""

from __future__ import annotations

import json
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
