# SPDX-License-Identifier: LGPL-2.1-or-later
"""One step of undo: what happens in it is done as a whole or not at all."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def transaction(document: Any, name: str) -> Iterator[None]:
    """One step of undo: committed and recomputed at the end, undone where an error is raised."""
    document.openTransaction(name)
    try:
        yield
        document.recompute()
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
