# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run by freecadcmd: makes a document from a pipeline file and saves it; answers in a file.

FreeCAD swallows exceptions of scripts and exits with 0, so whatever goes wrong goes into the answer.
"""

import json
import os
import sys
from pathlib import Path


def main() -> None:
    """Do the job that PIPEWORKBENCH_JOB describes."""
    job = json.loads(Path(os.environ["PIPEWORKBENCH_JOB"]).read_text(encoding="utf-8"))
    answer = {"error": ""}
    try:
        packages, source = job["paths"]
        sys.path.insert(0, source)
        if list(sys.version_info[:2]) == job["python"]:
            sys.path.insert(0, packages)
        _write(job)
    except Exception as error:  # noqa: BLE001  # FreeCAD would swallow it
        answer["error"] = f"{type(error).__name__}: {error}"
    Path(job["answer"]).write_text(json.dumps(answer), encoding="utf-8")


def _write(job: dict) -> None:  # type: ignore[type-arg]
    import FreeCAD

    from pipeworkbench.catalogue import use_folders
    from pipeworkbench.features.document import add_pipeline, add_station
    from pipeworkbench.pipeline import Pipeline
    from pipeworkbench.recon.station import read_station

    # the catalogue of whoever gave the job, not the one of FreeCAD's preferences
    use_folders(map(Path, job["catalogue"]))
    pipeline = Pipeline.read(Path(job["pipeline"]))
    document = FreeCAD.newDocument("Pipeline")
    document.Label = pipeline.frame
    for station in job["stations"]:
        add_station(document, read_station(Path(station)))
    add_pipeline(document, pipeline)
    document.recompute()
    broken = [item.Label for item in document.Objects if "Invalid" in item.State]
    if broken:
        raise RuntimeError(f"cannot be computed: {', '.join(broken)}")
    out = Path(job["out"])
    out.unlink(missing_ok=True)  # the placeholder: FreeCAD would keep it as a backup
    document.saveAs(str(out))


main()
