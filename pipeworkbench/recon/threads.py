# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many threads the steps may use: one limit for the whole process, which leaves the user some of the processor."""

from __future__ import annotations

import contextlib
import os

_limit = [0]


def limit_threads(count: int) -> None:
    """Use at most so many threads from now on, OpenCV's included; 0 is as many as the processor has cores."""
    if count == _limit[0]:
        return
    _limit[0] = count
    # without OpenCV there is still work to do that needs no images
    with contextlib.suppress(ImportError):
        import cv2

        cv2.setNumThreads(count or -1)


def thread_count(wanted: int | None = None) -> int:
    """Return how many threads a step may use that wants so many (default: one for each core)."""
    most = _limit[0] or os.cpu_count() or 1
    return max(1, min(wanted or most, most))
