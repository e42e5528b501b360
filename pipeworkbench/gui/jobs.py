# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work in threads: a job, what comes out of threads into the window's thread, and a place for one job at a time.

Threads touch no object of Qt, so that windows and panels may vanish at any moment.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from functools import partial
from typing import Any, Generic, TypeVar

from pipeworkbench.gui.compat import QtCore
from pipeworkbench.gui.dialogs import Cancelled

T = TypeVar("T")
N = TypeVar("N")
Progress = Callable[[str, int, int], None]

POLL_MS = 10


class Job(Generic[T]):
    """A function in a thread: its progress, its end and the wish to end it.

    Parameters
    ----------
    function : callable
        Gets ``progress(text, done, total)``, which raises Cancelled where the job was asked to end.
    ended : callable
        Called in the thread when the function has returned or raised.
    """

    def __init__(self, function: Callable[[Progress], T], ended: Callable[[], None] = lambda: None) -> None:
        self._function, self._ended = function, ended
        self._result: list[T] = []
        self._error: BaseException | None = None
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self._run, name="PipeWorkbench", daemon=True)
        self.state = ("", 0, 0)
        self._thread.start()

    @property
    def finished(self) -> bool:
        """Whether the function has returned or raised."""
        return not self._thread.is_alive()

    @property
    def cancelled(self) -> bool:
        """Whether the function was asked to end."""
        return self._cancelled.is_set()

    def cancel(self) -> None:
        """Ask the function to end: its next call of progress raises Cancelled."""
        self._cancelled.set()

    def wait(self, seconds: float) -> None:
        """Wait for the function's end, at most so long."""
        self._thread.join(seconds)

    def result(self) -> T:
        """Return what the function returned; raise what it raised, and Cancelled where it was asked to end."""
        # what was asked to end is not wanted any more, even where it came to its end
        if self.cancelled:
            raise Cancelled
        if self._error is not None:
            raise self._error
        return self._result[0]

    def _run(self) -> None:
        try:
            self._result.append(self._function(self._progress))
        except BaseException as error:  # noqa: BLE001  # raised again in the caller
            self._error = error
        self._ended()

    def _progress(self, text: str, done: int, total: int) -> None:
        if self.cancelled:
            raise Cancelled
        self.state = (text, done, total)


class Handover:
    """Calls in the window's thread what threads put into it, as long as its owner, an object of Qt, lives."""

    def __init__(self, owner: QtCore.QObject) -> None:
        self._calls: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._pending = 0
        self._timer = QtCore.QTimer(owner)
        self._timer.setInterval(POLL_MS)
        self._timer.timeout.connect(self._deliver)

    def expect(self) -> None:
        """Look for what is put in, until one more ``put_last`` has come (in the window's thread)."""
        self._pending += 1
        self._timer.start()

    def put(self, call: Callable[[], None]) -> None:
        """Have something called in the window's thread (in any thread)."""
        self._calls.put(call)

    def put_last(self, call: Callable[[], None]) -> None:
        """Do the same with the last that comes of what was expected (in any thread)."""
        self._calls.put(partial(self._last, call))

    def stop(self) -> None:
        """Call nothing any more."""
        self._timer.stop()

    def _last(self, call: Callable[[], None]) -> None:
        self._pending -= 1
        call()

    def _deliver(self) -> None:
        # a call may stop it
        while self._timer.isActive() and not self._calls.empty():
            self._calls.get()()
        if self._pending == 0:
            self._timer.stop()


class Task:
    """A place for one function at a time, of which the newest is wanted; it ends with its owner, an object of Qt.

    Functions get ``tell``: what they tell is handed over at once, and ends them where it is no longer wanted.
    They touch neither a document nor Qt.
    """

    def __init__(self, owner: QtCore.QObject) -> None:
        self._handover = Handover(owner)
        self._job: Job[Any] | None = None

    @property
    def is_running(self) -> bool:
        """Whether an end is still awaited."""
        return self._job is not None

    def start(
        self,
        function: Callable[[Callable[[N], None]], T],
        ended: Callable[[T], None],
        failed: Callable[[Exception], None],
        news: Callable[[N], None] = lambda _: None,
    ) -> None:
        """Run a function instead of what is running.

        Parameters
        ----------
        function : callable
        ended : callable
            Takes what it returns.
        failed : callable
            Takes what it raises.
        news : callable
            Takes what it tells on the way.
        """
        self.cancel()

        def run(progress: Progress) -> T:
            def tell(item: N) -> None:
                progress("", 0, 0)  # raises where it was cancelled
                self._handover.put(lambda: news(item) if self._job is job else None)

            return function(tell)

        def over() -> None:
            if self._job is not job:
                return
            self._job = None
            try:
                result = job.result()
            except Exception as error:  # noqa: BLE001  # whoever started it tells it
                failed(error)
            else:
                ended(result)

        self._handover.expect()
        job = self._job = Job(run, lambda: self._handover.put_last(over))

    def cancel(self) -> None:
        """Forget what is running; it ends with the next thing that it tells."""
        if self._job is not None:
            self._job.cancel()
            self._job = None
