# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs: what hangs together by joints."""

from __future__ import annotations

import re

from pipeworkbench.pipeline import Pipeline


def runs_of(pipeline: Pipeline) -> dict[str, str]:
    """Return the name of each component's run by its id.

    A run is everything that is joined, directly or through others. Runs are numbered ``R1``, ``R2``, ... by their smallest id,
    numbers in it counted as such (``P2`` before ``P10``), whatever the order of components and joints.
    """
    leader = {component.id: component.id for component in pipeline.components}

    def first(name: str) -> str:
        while leader[name] != name:
            leader[name] = leader[leader[name]]
            name = leader[name]
        return name

    for joint in pipeline.joints:
        a, b = sorted((first(joint.a), first(joint.b)), key=_order)
        leader[b] = a
    names: dict[str, str] = {}
    for name in sorted(leader, key=_order):
        names.setdefault(first(name), f"R{len(names) + 1}")
    return {component.id: names[first(component.id)] for component in pipeline.components}


def _order(name: str) -> tuple[tuple[bool, int, str], ...]:
    """Return what ids are sorted by: text as text, numbers as numbers."""
    return tuple((not part.isdecimal(), int(part) if part.isdecimal() else 0, part) for part in re.split(r"(\d+)", name) if part)
