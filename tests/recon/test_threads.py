# SPDX-License-Identifier: LGPL-2.1-or-later
"""The limit of threads."""

import os

import cv2
import pytest

from pipeworkbench.recon.threads import limit_threads, thread_count


@pytest.fixture(autouse=True)
def _no_limit_afterwards():
    yield
    limit_threads(0)


def test_steps_get_what_they_want_within_the_limit():
    cores = os.cpu_count() or 1
    assert thread_count() == cores
    assert thread_count(1) == 1
    limit_threads(3)
    assert (thread_count(), thread_count(2), thread_count(8)) == (3, 2, 3)
    assert cv2.getNumThreads() == 3
    limit_threads(1)
    assert thread_count(8) == 1
    limit_threads(0)
    assert thread_count() == cores
    assert cv2.getNumThreads() >= cores
