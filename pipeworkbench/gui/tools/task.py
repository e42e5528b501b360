# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work beside the window: one function in a thread, what it finds on the way handed over in the window's thread; the newest wins."""

from __future__ import annotations

import queue
from collections.abc import Callable
from typing import Any, TypeVar

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.gui.compat import QtCore
from pipeworkbench.gui.dialogs import Cancelled
from pipeworkbench.gui.worker import Job

T = TypeVar("T")
N = TypeVar("N")

POLL_MS = 15


def _nothing(_: object) -> None:
    """Take what nobody wants."""


class Task:
    """A place for one function at a time.

    Its owner hands over an object of Qt, with which it ends. Functions get ``tell``: what they tell is handed over at once, and
    ends them where it is no longer wanted. They touch neither a document nor Qt.
    """

    def __init__(self, owner: QtCore.QObject) -> None:
        self._job: Job[Any] | None = None
        self._news: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._take: tuple[Callable[[Any], None], ...] = ()
        self._timer = QtCore.QTimer(owner)
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self._deliver)

    @property
    def is_running(self) -> bool:
        """Whether an end is still awaited."""
        return self._job is not None

    def start(
        self,
        function: Callable[[Callable[[N], None]], T],
        ended: Callable[[T], None],
        failed: Callable[[str], None],
        news: Callable[[N], None] = _nothing,
    ) -> None:
        """Run a function instead of what is running.

        Parameters
        ----------
        function : callable
        ended : callable
            Takes what it returns.
        failed : callable
            Takes the sentence of an error that the user can mend; others are raised in the window's thread.
        news : callable
            Takes what it tells on the way.
        """
        self.cancel()
        told: queue.SimpleQueue[Any] = queue.SimpleQueue()

        def run(progress: Callable[[str, int, int], None]) -> T:
            def tell(item: N) -> None:
                progress("", 0, 0)  # raises where it was cancelled
                told.put(item)

            return function(tell)

        self._news, self._take = told, (news, ended, failed)
        self._job = Job(run)
        self._timer.start()

    def cancel(self) -> None:
        """Forget what is running; it ends with the next thing that it tells."""
        self._timer.stop()
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _deliver(self) -> None:
        job = self._job
        if job is None:
            return
        is_over = job.finished  # before the queue is emptied: nothing comes after it
        news, ended, failed = self._take
        while self._job is job and not self._news.empty():
            news(self._news.get())
        if not is_over or self._job is not job:
            return
        self._job = None
        self._timer.stop()
        try:
            result = job.result()
        except Cancelled:
            return
        except PipeWorkbenchError as error:
            failed(str(error))
            return
        ended(result)
