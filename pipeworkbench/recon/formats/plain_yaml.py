# SPDX-License-Identifier: LGPL-2.1-or-later
"""YAML as dictionaries, lists and texts: no tags, no numbers, no objects, no aliases, no doubled keys."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from pipeworkbench.errors import InputError


class _PlainLoader(yaml.BaseLoader):  # type: ignore[misc]  # PyYAML has no types
    """PyYAML's loader that makes nothing of tags, with what it allows too much refused."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            raise yaml.MarkedYAMLError(problem="aliases (*name) are not read", problem_mark=self.peek_event().start_mark)
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:  # noqa: FBT001, FBT002
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in seen:
                    raise yaml.MarkedYAMLError(problem=f"the key '{key.value}' is given twice", problem_mark=key.start_mark)
                seen.add(key.value)
        return super().construct_mapping(node, deep=deep)


def load(text: str, source: Path) -> Any:
    """Return the document in a text; InputError, with the place in ``source``, where it is none."""
    try:
        loader = _PlainLoader(text)
        try:
            return loader.get_single_data()
        finally:
            loader.dispose()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise InputError(source, where, f"not valid YAML ({error.problem or error.context})", "correct the file there") from None
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise InputError(source, "", f"not valid YAML ({type(error).__name__})", "export the file again") from None
