# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work of a photo window in threads, in the order in which it was handed in; the results come back into the window's thread."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from pipeworkbench.gui.compat import QtCore
from pipeworkbench.gui.jobs import Handover

WORKERS = 2  # NumPy and OpenCV use more threads themselves

T = TypeVar("T")


class Background:
    """Jobs of one window; ``stop`` forgets those that have not begun, and the results of those that have."""

    def __init__(self, owner: QtCore.QObject) -> None:
        self._pool = ThreadPoolExecutor(WORKERS, thread_name_prefix="photographs")
        self._handover = Handover(owner)

    def submit(
        self,
        function: Callable[[], T],
        succeeded: Callable[[T], None] = lambda _: None,
        failed: Callable[[Exception], None] = lambda _: None,
    ) -> Future[T]:
        """Run a function in a thread and hand its result or its exception over in the window's thread."""

        def handed_over(future: Future[T]) -> None:
            # this runs in the job's thread
            self._handover.put_last(lambda: _hand_over(future, succeeded, failed))

        future = self._pool.submit(function)
        self._handover.expect()
        future.add_done_callback(handed_over)
        return future

    def stop(self) -> None:
        """Begin nothing more and hand nothing over any more; what is running ends by itself."""
        self._handover.stop()
        self._pool.shutdown(wait=False, cancel_futures=True)


def _hand_over(future: Future[Any], succeeded: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
    error = future.exception()
    if error is None:
        succeeded(future.result())
    elif isinstance(error, Exception):
        failed(error)
