# SPDX-License-Identifier: LGPL-2.1-or-later
"""Things that are alike put together, the first of them, which is the best where they are sorted, standing for the others."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")


def groups_of(things: Iterable[T], alike: Callable[[T, T], bool]) -> list[list[T]]:
    """Return things in groups, in their order; ``alike`` tells whether a group's first and another one belong together."""
    groups: list[list[T]] = []
    for one in things:
        group = next((group for group in groups if alike(group[0], one)), None)
        if group is None:
            groups.append([one])
        else:
            group.append(one)
    return groups


def distinct(things: Iterable[T], alike: Callable[[T, T], bool]) -> list[T]:
    """Return things, in their order, without those that are ``alike`` to an earlier one that stays."""
    return [group[0] for group in groups_of(things, alike)]
