# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work in threads whose results come back into the window's thread.

The threads touch no Qt object, so that the window may vanish at any moment: they put what they found into a
queue, which a timer of the window empties.
"""

from __future__ import annotations

import queue
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

from pipeworkbench.gui.compat import QtCore

POLL_MS = 10
WORKERS = 2  # NumPy and OpenCV use more threads themselves

T = TypeVar("T")


class Background:
    """Jobs of one window; ``stop`` forgets those that have not begun, and the results of those that have."""

    def __init__(self, owner: QtCore.QObject) -> None:
        self._pool = ThreadPoolExecutor(WORKERS, thread_name_prefix="photographs")
        self._done: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._pending = 0
        self._stopped = False
        self._timer = QtCore.QTimer(owner)
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self._deliver)

    def submit(
        self,
        function: Callable[[], T],
        succeeded: Callable[[T], None] = lambda _: None,
        failed: Callable[[Exception], None] = lambda _: None,
    ) -> Future[T]:
        """Run a function in a thread and hand its result or its exception over in the window's thread."""

        def handed_over(future: Future[T]) -> None:
            # this runs in the job's thread
            self._done.put(lambda: _hand_over(future, succeeded, failed))

        future = self._pool.submit(function)
        self._pending += 1
        self._timer.start()
        future.add_done_callback(handed_over)
        return future

    def stop(self) -> None:
        """Begin nothing more and hand nothing over any more; what is running ends by itself."""
        self._stopped = True
        self._timer.stop()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _deliver(self) -> None:
        while not (self._stopped or self._done.empty()):
            self._pending -= 1
            self._done.get()()
        if self._pending == 0:
            self._timer.stop()


def _hand_over(future: Future[Any], succeeded: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
    error = future.exception()
    if error is None:
        succeeded(future.result())
    elif isinstance(error, Exception):
        failed(error)
