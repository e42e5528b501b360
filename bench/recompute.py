# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long FreeCAD takes for one changed diameter in a document of 300 components: python bench/recompute.py."""

import os
import subprocess
import sys
import sysconfig
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUNS, ELBOWS = 12, 11  # of each run: elbows, one pipe more, a flange at both ends
ANSWER = "PIPEWORKBENCH_BENCH"
LENGTH, RADIUS, FACE = 800.0, 57.0, 45.0


def components():
    """Staircases beside each other: pipes of DN 40, 3D elbows, a weld neck flange at both ends."""
    from pipeworkbench.pipeline import Elbow, Flange, Joint, Pipe, Pipeline

    size = {"outer_diameter": 48.3, "wall_thickness": 2.6, "dn": 40}
    plate = {
        "flange_type": "11",
        "pn": 16.0,
        "D": 150.0,
        "C": 18.0,
        "length": FACE,
        "neck_diameter": 64.0,
        "neck_straight": 7.0,
        "K": 110.0,
        "L": 18.0,
    }
    made, joints = [], []

    def add(component, port):
        if made and made[-1].id.startswith(component.id[:3]):
            joints.append(Joint(a=made[-1].id, a_port=1, b=component.id, b_port=port))
        made.append(component)

    for run in range(RUNS):
        y = 400.0 * run
        at, along = [0.0, y, 0.0], (0, 2)
        add(Flange(id=f"{run:02}-F0", face=(-FACE, y, 0.0), axis=(-1.0, 0.0, 0.0), standard="EN 1092-1", bolts=4, **plate, **size), 0)
        for number in range(ELBOWS + 1):
            axis = along[number % 2]
            end = list(at)
            end[axis] += LENGTH
            add(Pipe(id=f"{run:02}-P{number}", start=tuple(at), end=tuple(end), **size), 0)
            if number == ELBOWS:
                direction = tuple(1.0 if i == axis else 0.0 for i in range(3))
                face = tuple(value + FACE * d for value, d in zip(end, direction, strict=True))
                add(Flange(id=f"{run:02}-F1", face=face, axis=direction, standard="EN 1092-1", bolts=4, **plate, **size), 1)
                break
            corner, at = list(end), list(end)
            corner[axis] += RADIUS
            at[axis] += RADIUS
            at[along[(number + 1) % 2]] += RADIUS
            bend = {"angle_deg": 90.0, "bend_radius": RADIUS, "bend_type": "3D", "standard": "EN 10253 / DIN 2605"}
            add(Elbow(id=f"{run:02}-E{number}", start=tuple(end), intersection=tuple(corner), end=tuple(at), **bend, **size), 0)
    return Pipeline(frame="bench", components=tuple(made), joints=tuple(joints))


def measure():
    """Run inside FreeCAD: yield what was timed and the seconds it took."""
    import FreeCAD

    from pipeworkbench.features.component import ComponentFeature
    from pipeworkbench.features.document import add_pipeline

    modelled = []
    execute = ComponentFeature.execute
    ComponentFeature.execute = lambda self, obj: (modelled.append(obj.Name), execute(self, obj))[1]

    def timed(text, act):
        modelled.clear()
        began = time.perf_counter()
        act()
        said.append(f"{text}: {time.perf_counter() - began:.3f} s, {len(modelled)} of {len(objects)} computed")

    said = []
    document = FreeCAD.newDocument("bench")
    document.UndoMode = 1
    objects = []
    timed("making the document", lambda: objects.extend(add_pipeline(document, components())))
    timed("first recompute, importing CadQuery", document.recompute)
    pipe = next(obj for obj in objects if obj.ComponentId == "04-P6")

    def change(name, value):
        document.openTransaction("change")
        setattr(pipe, name, value)
        document.recompute()
        document.commitTransaction()

    timed("diameter of a run of 25 (2 flanges, 12 pipes, 11 elbows), new dimensions", lambda: change("NominalDiameter", "DN 65"))
    timed("the same, dimensions modelled before", lambda: change("NominalDiameter", "DN 40"))
    timed("another new diameter", lambda: change("NominalDiameter", "DN 80"))
    timed("length of a pipe", lambda: change("Length", 900.0))
    timed("undo", lambda: (document.undo(), document.recompute()))
    timed("everything once more", lambda: document.recompute([*objects], True))
    return said


def main():
    """Start FreeCAD with this file and print what it measured."""
    from pipeworkbench.exports.fcstd import find_freecad

    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer"
        environment = os.environ | {ANSWER: str(answer), "PYTHONPATH": f"{ROOT}:{sysconfig.get_path('purelib')}", "LANG": "C.UTF-8", "HOME": folder}
        subprocess.run([find_freecad(), __file__], env=environment, stdout=subprocess.DEVNULL, check=False)
        print(answer.read_text(encoding="utf-8") if answer.exists() else "FreeCAD gave no answer")


if ANSWER in os.environ:
    Path(os.environ[ANSWER]).write_text("\n".join(measure()), encoding="utf-8")
elif __name__ == "__main__":
    sys.exit(main())
