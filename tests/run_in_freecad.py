# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs pytest inside FreeCAD and writes its exit status to the file that PIPEWORKBENCH_EXIT names.

With a window the tests start once FreeCAD has settled, and FreeCAD is ended afterwards.
"""

import os
import sys
import traceback
from pathlib import Path

import FreeCAD


def run() -> None:
    """Run the folder of tests that PIPEWORKBENCH_TESTS names, then end FreeCAD."""
    status = "an exception outside the tests"
    try:
        import pytest

        folder = os.environ["PIPEWORKBENCH_TESTS"]
        status = str(
            int(pytest.main(["-q", "-s", "-p", "no:cacheprovider", "-o", "addopts=", "-o", "filterwarnings=ignore", "--rootdir", folder, folder]))
        )
    except BaseException:  # noqa: BLE001  # FreeCAD would swallow it
        traceback.print_exc()
    finally:
        Path(os.environ["PIPEWORKBENCH_EXIT"]).write_text(status, encoding="utf-8")
        sys.stdout.flush()
        sys.stderr.flush()
        # documents left open would ask whether to save them
        os._exit(0)


if FreeCAD.GuiUp:
    from PySide import QtCore

    QtCore.QTimer.singleShot(2500, run)
else:
    run()
