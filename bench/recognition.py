# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recognition of pipes over scenes with known truth, beside the published figures.

    python bench/recognition.py FOLDER [--out recognition.md] [--no-auto]

FOLDER holds ``scenes/NAME/STATION`` with station.json, picks.json and truth, and ``tools/score.py``, which judges.
Writes a Markdown table (the paper's Table 5: correct, wrong, failed; Tables 2 and 3: accuracy with one image and with
three; recall, precision and seconds without picks) and beside it pictures of the failures: photograph, pick, and
what was found there.
"""

import argparse
import importlib.util
import json
import statistics
import sys
import time
from pathlib import Path

import cv2
import numpy as np

from pipeworkbench.recon.cylinder import contours
from pipeworkbench.recon.detect import detect
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.picks import read_picks
from pipeworkbench.recon.pipes import from_pick
from pipeworkbench.recon.plane_cylinders import cylinder_from_diameter
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.tangent_planes import apparent_pipe
from pipeworkbench.recon.views import views_of

PAPER_RECOGNITION = "| paper, Table 5 (85 pipes) | 85 | 65 (76 %) | 12 (14 %) | 8 (10 %) | | | |"
PAPER_ACCURACY = [
    "| paper, Table 2: one image, 7 pipes of 48.3 mm at 3.6 m | 46 | 3.6 |",
    "| paper, Table 3: three images, adjusted one by one | 2.3 | 1.1 |",
]
MARGIN_PX = 150


def judge(folder):
    """Return the judge as a module."""
    spec = importlib.util.spec_from_file_location("score", folder / "tools" / "score.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Scene:
    """A station with its truth, in the station's frame."""

    def __init__(self, score, folder):
        self.score, self.folder = score, folder
        self.name = f"{folder.parent.name}/{folder.name}"
        self.station = read_station(folder)
        self.picks = read_picks(folder / "picks.json", self.station)
        self.truth_of_pick = [pick.get("truth") for pick in json.loads((folder / "picks.json").read_text(encoding="utf-8"))["picks"]]
        self.world_from_level = score.world_from_result(str(folder.parent), folder.name)
        self.pipes = {t["id"]: t for t in json.loads((folder.parent / "truth.json").read_text(encoding="utf-8"))["pipes"]}
        seen = json.loads((folder / "truth.json").read_text(encoding="utf-8"))["visible_pixels"].values()
        self.visible = {name for name in self.pipes if sum(view.get(name, 0) > 1500 for view in seen) >= 2}

    def deviation(self, ends, diameter, truth):
        """Return the judge's deviations of a pipe from a true one."""
        moved = self.score.move({"start": ends[0], "end": ends[1], "outer_diameter": diameter}, self.world_from_level)
        return self.score.pipe_dev(moved, self.pipes[truth])

    def nearest(self, ends, diameter):
        """Return the name of the true pipe that a pipe is nearest to, and its deviations."""
        every = {name: self.deviation(ends, diameter, name) for name in self.pipes}
        name = min(every, key=lambda n: every[n]["position"] + 20 * every[n]["direction"] + (1e3 if every[n]["overlap"] < 0.05 else 0))
        return name, every[name]


def with_picks(scene, views, out):
    """Answer all picks and return what the tables need."""
    correct, wrong, failed, three, one, seconds = 0, [], [], [], [], []
    for pick in scene.picks.pipes:
        truth = scene.truth_of_pick[pick.index]
        began = time.perf_counter()
        answer = from_pick(views, pick)
        seconds.append(time.perf_counter() - began)
        if not answer:
            failed.append((pick, truth, None))
            continue
        candidate = answer[0]
        diameter = candidate.size.outer_diameter if candidate.size else candidate.diameter
        deviation = scene.deviation(candidate.ends, diameter, truth)
        if not scene.score.pipe_ok(deviation):
            wrong.append((pick, truth, candidate))
            continue
        correct += 1
        three.append(deviation)
        alone = cylinder_from_diameter(apparent_pipe(views[pick.camera].camera, *pick.edges), diameter).cylinder
        half = max(float(np.linalg.norm(candidate.ends[1] - candidate.ends[0])) / 2, 1.0)
        one.append(scene.deviation([alone.at(-half), alone.at(half)], diameter, truth))
    for kind, cases in (("wrong", wrong), ("failed", failed)):
        for pick, truth, candidate in cases:
            picture(scene, views, pick, candidate, out.with_name(f"{out.stem}-{scene.name.replace('/', '-')}-{truth}-{kind}.png"))
    return correct, len(wrong), len(failed), three, one, statistics.median(seconds)


def without_picks(scene, views):
    """Find the pipes without picks and return recall, precision and seconds."""
    began = time.perf_counter()
    found = detect(views)
    seconds = time.perf_counter() - began
    hit, false = set(), 0
    for candidate in found:
        name, deviation = scene.nearest(candidate.ends, candidate.size.outer_diameter)
        if scene.score.pipe_ok(deviation):
            hit.add(name)
        else:
            false += 1
    return len(hit & scene.visible), len(scene.visible), len(found), false, seconds


def picture(scene, views, pick, candidate, path):
    """Draw a pick (yellow) and what was found (red) into all photographs, around the pick or what was found."""
    parts = []
    for number, view in enumerate(views):
        image = cv2.cvtColor(read_image(scene.station, number), cv2.COLOR_GRAY2BGR)
        marked = [pick.edges.reshape(-1, 2)] if number == pick.camera else []
        if candidate is not None:
            cylinder = candidate.solution.cylinder
            outline = contours(view.camera, cylinder.as_many(), np.linspace(*candidate.extent, 200)[None]).position[0]
            for side in outline:
                seen = side[np.isfinite(side[:, 0])]
                marked.append(seen)
                cv2.polylines(image, [np.rint(seen).astype(np.int32)], False, (0, 0, 255), 2)
        if number == pick.camera:
            for edge in pick.edges:
                cv2.line(image, *(tuple(int(x) for x in np.rint(point)) for point in edge), (0, 255, 255), 2)
        points = np.concatenate(marked) if marked else np.zeros((0, 2))
        if len(points):
            low = np.maximum(points.min(axis=0) - MARGIN_PX, 0).astype(int)
            high = np.minimum(points.max(axis=0) + MARGIN_PX, image.shape[1::-1]).astype(int)
            image = image[low[1] : high[1], low[0] : high[0]]
        scale = 480 / max(image.shape[0], 1)
        parts.append(cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA))
    cv2.imwrite(str(path), np.hstack(parts))


def mean(deviations, key):
    """Return a mean as text, a dash where there is nothing."""
    return f"{statistics.mean(d[key] for d in deviations):.2f}" if deviations else "-"


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=Path("recognition.md"))
    parser.add_argument("--no-auto", action="store_true")
    options = parser.parse_args()
    score = judge(options.folder)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    rows = ["| scene | pipes | correct | wrong | failed | mean mm | mean deg | s per pick |", "|---|---|---|---|---|---|---|---|", PAPER_RECOGNITION]
    auto = ["| scene | visible pipes | found | recall | answers | false | precision | s |", "|---|---|---|---|---|---|---|---|"]
    accuracy = ["| pipes of dummy | mean mm | mean deg |", "|---|---|---|", *PAPER_ACCURACY]
    sums, auto_sums, dummy_one, dummy_three = np.zeros(3, int), np.zeros(4, int), [], []
    stations = sorted(path.parent for path in options.folder.glob("scenes/*/*/station.json") if (path.parent.parent / "truth.json").is_file())
    for folder in stations:
        scene = Scene(score, folder)
        views = views_of(scene.station)
        correct, wrong, failed, three, one, seconds = with_picks(scene, views, options.out)
        total = correct + wrong + failed
        sums += (correct, wrong, failed)
        rows.append(
            f"| {scene.name} | {total} | {correct} ({100 * correct / total:.0f} %) | {wrong} | {failed} | {mean(three, 'position')} |"
            f" {mean(three, 'direction')} | {seconds:.2f} |"
        )
        print(rows[-1], flush=True)
        if folder.parent.name == "dummy":
            dummy_one += one
            dummy_three += three
        if not options.no_auto:
            hit, visible, answers, false, seconds = without_picks(scene, views)
            auto_sums += (hit, visible, answers, false)
            recall, precision = hit / max(visible, 1), 1 - false / max(answers, 1)
            auto.append(f"| {scene.name} | {visible} | {hit} | {recall:.2f} | {answers} | {false} | {precision:.2f} | {seconds:.1f} |")
            print(auto[-1], flush=True)
    total = sums.sum()
    rows.append(
        "| **all** | {} | {} ({:.0f} %) | {} ({:.0f} %) | {} ({:.0f} %) | | | |".format(total, *(x for n in sums for x in (n, 100 * n / total)))
    )
    hit, visible, answers, false = auto_sums
    if visible:
        auto.append(f"| **all** | {visible} | {hit} | {hit / visible:.2f} | {answers} | {false} | {1 - false / max(answers, 1):.2f} | |")
    accuracy.append(f"| here: one image, the size known | {mean(dummy_one, 'position')} | {mean(dummy_one, 'direction')} |")
    accuracy.append(f"| here: three images, adjusted one by one | {mean(dummy_three, 'position')} | {mean(dummy_three, 'direction')} |")
    text = "\n".join(["# Recognition of pipes", "", "With picks:", "", *rows, "", *accuracy, "", "Without picks:", "", *auto, ""])
    options.out.write_text(text, encoding="utf-8")
    print(text)
    print(f"written: {options.out} and pictures of the failures beside it", file=sys.stderr)


if __name__ == "__main__":
    main()
