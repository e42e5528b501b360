# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD documents, written by FreeCAD itself without a window (freecadcmd)."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from pathlib import Path

import pipeworkbench
from pipeworkbench.catalogue import catalogue
from pipeworkbench.errors import MissingPackageError, PipeWorkbenchError
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.station import Station

PROGRAM_VARIABLE = "PIPEWORKBENCH_FREECADCMD"  # names FreeCAD's command-line program where it is not on the path
PROGRAMS = ("freecadcmd", "FreeCADCmd", "freecad.cmd")
JOB_VARIABLE = "PIPEWORKBENCH_JOB"
TIMEOUT_S = 600.0


def find_freecad() -> str:
    """Return FreeCAD's command-line program.

    Raises
    ------
    MissingPackageError
        Where there is none; says how to install or name it.
    """
    named = os.environ.get(PROGRAM_VARIABLE)
    if named and shutil.which(named) is None:
        raise PipeWorkbenchError(f"{named}: cannot be started (no such program); correct {PROGRAM_VARIABLE}")
    program = named or next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        raise MissingPackageError("FreeCAD", "Writing FCStd", f"apt-get install freecad (or name freecadcmd in {PROGRAM_VARIABLE})")
    return program


def write_fcstd(pipeline: Pipeline, path: Path, stations: Sequence[Station] = ()) -> None:
    """Write a document with a parametric object per component.

    Raises
    ------
    MissingPackageError
        Where FreeCAD's command-line program is not found.
    PipeWorkbenchError
        Where FreeCAD could not do it; says what FreeCAD said.
    """
    program = find_freecad()
    package = Path(pipeworkbench.__file__).parent
    tables = catalogue().folders
    with written_whole(path) as temporary, tempfile.TemporaryDirectory() as folder:
        pipeline_file, job_file, answer_file = (Path(folder) / name for name in ("pipeline.json", "job.json", "answer.json"))
        pipeline.write(pipeline_file)
        job = {
            "pipeline": str(pipeline_file),
            "catalogue": [str(folder.resolve()) for folder in tables],
            "stations": [str(station.source.resolve()) for station in stations],
            "out": str(temporary.resolve()),
            "answer": str(answer_file),
            "python": list(sys.version_info[:2]),
            # FreeCAD's Python may use this Python's packages where the versions are the same
            "paths": [sysconfig.get_path("purelib"), str(package.parent)],
        }
        job_file.write_text(json.dumps(job), encoding="utf-8")
        script = package / "features" / "headless_job.py"
        environment = os.environ | {JOB_VARIABLE: str(job_file), "LANG": "C.UTF-8", "HOME": os.environ.get("HOME", folder)}
        try:
            done = subprocess.run([program, str(script)], env=environment, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
        except OSError as error:
            raise PipeWorkbenchError(f"{program}: cannot be started ({error.strerror}); correct {PROGRAM_VARIABLE}") from None
        except subprocess.TimeoutExpired:
            raise PipeWorkbenchError(f"{program}: gave no answer within {TIMEOUT_S:.0f} s; export fewer components at a time") from None
        # FreeCAD exits with 0 whatever happens in a script: only the answer file counts
        answer = json.loads(answer_file.read_text(encoding="utf-8")) if answer_file.exists() else {"error": _last_words(done)}
        if answer.get("error"):
            raise PipeWorkbenchError(f"{path}: FreeCAD could not write the document: {answer['error']}")


def _last_words(done: subprocess.CompletedProcess[str]) -> str:
    lines = (done.stderr.strip() or done.stdout.strip()).splitlines()
    return lines[-1] if lines else f"it ended with status {done.returncode} and said nothing; is it FreeCAD's command-line program?"
