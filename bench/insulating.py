"""How long insulating takes, what comes out of it, and whether all solids are valid.

Prints a table: reconstructed scenes (where the folder with the rendered stations is given) with 30 and 60 mm, and a pipe rack of 300
components; each is planned, modelled, unfolded, nested and written to STEP and DXF.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pipe_rack

from pipeworkbench.insulation.patterns import patterns_of
from pipeworkbench.insulation.planning import plan
from pipeworkbench.insulation.specification import Specification
from pipeworkbench.pipeline import Pipeline

STATIONS = {"dummy": ("dummy/A", "dummy/B"), "plant": ("plant/A", "plant/B", "plant/C")}
THICKNESSES = (30.0, 60.0)
SIZE = 300  # components of the pipe rack


def measure(pipeline: Pipeline, thickness: float, folder: Path) -> dict[str, object]:
    """Return times (s) and counts of one pipeline's insulation; the command line's whole way is timed beside its steps."""
    from pipeworkbench.solids.insulation import covering_bodies

    specification = Specification.uniform(thickness)
    began = time.perf_counter()
    planned = plan(pipeline, specification)
    plan_time = time.perf_counter() - began
    began = time.perf_counter()
    bodies = [body for piece in planned.pieces for body in covering_bodies(piece.covering)]
    solids_time = time.perf_counter() - began
    invalid = [body.name for body in bodies if not (body.solid.isValid() and body.solid.Volume() > 0 and body.solid.ShapeType() == "Solid")]
    began = time.perf_counter()
    patterns = patterns_of(planned)
    patterns_time = time.perf_counter() - began
    source = folder / "pipeline.json"
    pipeline.write(source)
    began = time.perf_counter()
    outputs = [folder / f"insulation.{ending}" for ending in ("step", "dxf", "csv", "xlsx", "ifc")]
    command = [sys.executable, "-m", "pipeworkbench", "insulate", str(source), "--thickness", f"{thickness:g}", "--leave-out", "--json"]
    done = subprocess.run(
        [*command, *(argument for path in outputs for argument in ("--out", str(path)))], check=True, capture_output=True, text=True
    )
    return {
        "components": len(pipeline.components),
        "thickness": thickness,
        "pieces": len(planned.pieces),
        "problems": len(planned.problems),
        "clashes": len(planned.clashes),
        "bodies": len(bodies),
        "invalid": len(invalid),
        "parts": len(patterns),
        "plan": plan_time,
        "solids": solids_time,
        "patterns": patterns_time,
        "command": time.perf_counter() - began,
        "sheets": json.loads(done.stdout)["sheets"],
    }


def reconstructed(stations: tuple[str, ...], scenes: Path, folder: Path) -> Pipeline:
    """Return stations reconstructed together from their picks."""
    out = folder / "reconstructed.json"
    command = [sys.executable, "-m", "pipeworkbench", "reconstruct", *(str(scenes / name) for name in stations), "--out", str(out), "--quiet"]
    subprocess.run(command, check=True)
    return Pipeline.read(out)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("shared", nargs="?", type=Path, help="folder with scenes/")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene, stations in STATIONS.items() if options.shared else ():
            pipeline = reconstructed(stations, options.shared / "scenes", folder)
            rows += [{"pipeline": scene} | measure(pipeline, thickness, folder) for thickness in THICKNESSES]
        rack = pipe_rack.pipe_rack(SIZE)
        rows += [{"pipeline": "pipe rack"} | measure(rack, THICKNESSES[0], folder)]
    columns = list(rows[0])
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for row in rows:
        print(
            "| "
            + " | ".join(f"{value:.2f} s" if isinstance(value, float) and key != "thickness" else f"{value}" for key, value in row.items())
            + " |"
        )


if __name__ == "__main__":
    main()
