# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recognition of pipes over scenes with known truth, beside the published figures.

    python bench/recognition.py FOLDER [--out recognition.md] [--only dummy/A ...] [--no-auto]
                                       [--brute-force [lsd|hough]] [--time-limit SECONDS]

FOLDER holds ``scenes/NAME/STATION`` with station.json, picks.json and truth, and ``tools/score.py``, which judges.
Writes a Markdown table (the paper's Table 5: correct, wrong, failed; Tables 2 and 3: accuracy with one image and with
three; recall, precision and seconds without picks, beside the paper's brute force where that is asked for: it takes
minutes to hours) and beside it pictures of the failures: photograph, pick, and what was found there.
"""

import argparse
import statistics
import sys
import time
from collections import Counter
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from brute_force import BruteForceSettings, brute_force
from scenes import Scene, judge, station_folders

from pipeworkbench.errors import InputError
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.clicks import complete_picks
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.detect import detect
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.lines import INTERRUPTED, detect_lines
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.pipes import from_pick
from pipeworkbench.recon.plane_cylinders import cylinder_from_diameter
from pipeworkbench.recon.tangent_planes import apparent_pipe
from pipeworkbench.recon.tangents import SNAPPED_SIGMA_PX, tangents_of
from pipeworkbench.recon.views import views_of

VERDICTS = ("correct", "wrong", "failed")
PAPER_RECOGNITION = "| paper, Table 5 | 85 | 65 (76 %) | 12 (14 %) | 8 (10 %) | | | |"
PAPER_ACCURACY = [
    "| paper, Table 2: one image, of 48.3 mm at 3.6 m | 7 | 46 | 3.6 |",
    "| paper, Table 3: three images, adjusted one by one | 7 | 2.3 | 1.1 |",
]
MARGIN_PX = 80  # around what a picture shows
PANEL_PX, NARROWEST_PX = 640, 400  # height of a camera's part of a picture, which is its largest width too; its least width
CAPTION_PX = 36
SUBPIXEL_BITS = 4  # of drawn coordinates
GREEN, RED, YELLOW = (80, 220, 80), (60, 60, 255), (0, 255, 255)


@dataclass(frozen=True, eq=False)
class Answer:
    """What became of a pick: a verdict of ``VERDICTS`` and, where there are, the candidate, its deviations and the reason of a failure."""

    pick: PipePick
    truth: str
    verdict: str
    candidate: PipeCandidate | None = None
    deviation: dict[str, float] | None = None
    reason: str = ""

    @property
    def caption(self):
        """The verdict in a line."""
        if self.deviation is None:
            return f"{self.verdict}{': ' * bool(self.reason)}{self.reason}"
        found = f"{diameter_of(self.candidate):.1f} mm found, off by {self.deviation['diameter']:.1f} mm"
        return f"{self.verdict}: axis {self.deviation['position']:.1f} mm and {self.deviation['direction']:.2f} deg off; diameter {found}"


def diameter_of(candidate):
    """Return the standard's diameter in mm, the measured one where it is free."""
    return candidate.size.outer_diameter if candidate.size else candidate.diameter


def answer_to(scene, views, pick):
    """Answer a pick and judge the answer."""
    truth = scene.truth_of_pick[pick.index]
    try:
        found = from_pick(views, pick)
    except InputError as problem:
        return Answer(pick, truth, "failed", reason=str(problem))
    if not found:
        return Answer(pick, truth, "failed", reason=str(getattr(found, "reason", "")))
    candidate = found[0]
    deviation = scene.deviation(candidate.ends, diameter_of(candidate), truth)
    return Answer(pick, truth, "correct" if scene.score.pipe_ok(deviation) else "wrong", candidate, deviation)


def with_picks(scene, views, out):
    """Answer all picks, draw the failures and return the answers and the median of the seconds."""
    answers, seconds = [], []
    for pick in scene.picks.pipes:
        began = time.perf_counter()
        answers.append(answer_to(scene, views, pick))
        seconds.append(time.perf_counter() - began)
    for answer in answers:
        if answer.verdict != "correct":
            name = f"{out.stem}-{scene.name.replace('/', '-')}-{answer.truth}-{answer.verdict}.png"
            cv2.imwrite(str(out.with_name(name)), picture(scene, views, answer))
    return answers, statistics.median(seconds or [0.0])


def from_one_image(scene, views, pick):
    """Return the deviations of the cylinder that the clicked image and the known diameter give; None where they give none."""
    view, truth = views[pick.camera], scene.truth_of_pick[pick.index]
    diameter = scene.pipes[truth]["outer_diameter"]
    whole = complete_picks(view, pick)
    if not whole:
        return None
    drawn = tangents_of(view, whole[0])
    # the clicks, moved into the tangent planes of the edges they mean
    rays, normals = drawn.clicks.reshape(2, 2, 3), drawn.normals[:, None]
    rays = rays - np.sum(rays * normals, axis=2, keepdims=True) * normals
    edges = view.camera.project(view.camera.projection_centre + 1000 * rays.reshape(4, 3)).reshape(2, 2, 2)
    try:
        solution = cylinder_from_diameter(apparent_pipe(view.camera, *edges, SNAPPED_SIGMA_PX), diameter)
    except InputError:
        return None
    ends = [solution.cylinder.at(sign * solution.half_length) for sign in (-1, 1)]
    return scene.deviation(ends, diameter, truth)


@dataclass(frozen=True)
class Unpicked:
    """What a search without picks finds: ``hit`` of the ``visible`` true pipes, and of its ``answers`` the ``false``."""

    visible: int
    hit: int
    answers: int
    false: int

    def row(self, scene, method, *remarks):
        """Return a row of the table; the remarks are its last cells."""
        recall, precision = self.hit / max(self.visible, 1), 1 - self.false / max(self.answers, 1)
        cells = (scene, method, self.visible, self.hit, f"{recall:.2f}", self.answers, self.false, f"{precision:.2f}", *remarks)
        return f"| {' | '.join(map(str, cells))} |"

    @classmethod
    def total(cls, parts):
        """Return the sums."""
        return cls(*(sum(getattr(part, name) for part in parts) for name in cls.__dataclass_fields__))


def judged(scene, pipes):
    """Judge pipes that were found without picks: pairs of an axis' ends (2, 3) and a diameter in mm."""
    hit, false = set(), 0
    for ends, diameter in pipes:
        name, deviation = scene.nearest(ends, diameter)
        if scene.score.pipe_ok(deviation):
            hit.add(name)
        else:
            false += 1
    return Unpicked(len(scene.visible), len(hit & scene.visible), len(pipes), false)


def without_picks(views):
    """Find the pipes without picks and return them for :func:`judged`, and a remark."""
    return [(candidate.ends, diameter_of(candidate)) for candidate in detect(views)], ""


def by_brute_force(scene, views, method, time_limit):
    """Find the pipes as the paper does, with lines of a detector (its are "lsd"), and return them for :func:`judged`, and how far it came."""
    ends = [
        detect_lines(read_image(scene.station, number), view.edges, method, view.camera.interior, INTERRUPTED).ends
        for number, view in enumerate(views)
    ]
    settings = BruteForceSettings(time_limit=time_limit)
    found = brute_force([view.camera for view in views], ends, settings, lambda text: print(f"{scene.name}: {text}", file=sys.stderr))
    remark = f"{found.combinations:.1e} combinations" + (f", stopped after {100 * found.share:.2g} %" if found.share < 1 else "")
    return [(one, size.outer_diameter) for one, size in zip(found.ends, found.sizes, strict=True)], remark


def picture(scene, views, answer):
    """Draw a pick (yellow), what was found (red) and the true pipe (green) into all photographs, over a caption."""
    shown: list[tuple[Cylinder, Any, Any]] = [(*scene.true_cylinder(answer.truth), GREEN)]
    if answer.candidate is not None:
        shown.append((answer.candidate.solution.cylinder, answer.candidate.extent, RED))
    panels = []
    for number, view in enumerate(views):
        lines = []
        for cylinder, extent, colour in shown:
            sides = outlines(view.camera, cylinder.as_many(), np.linspace(*extent, 200)[None])[0][0]
            lines += [(side[np.isfinite(side[:, 0])], colour) for side in sides]
        if number == answer.pick.camera:
            lines += [(edge, YELLOW) for edge in answer.pick.edges]
        panels.append(panel(read_image(scene.station, number), lines, view.camera.name))
    height = max(one.shape[0] for one in panels)
    whole = np.hstack([np.pad(one, ((0, height - one.shape[0]), (0, 0), (0, 0)), constant_values=255) for one in panels])
    text = f"{scene.name} {answer.truth} (pick {answer.pick.index}, {scene.pipes[answer.truth]['outer_diameter']:g} mm) {answer.caption}"
    return np.vstack([whole, caption(text, whole.shape[1])])


def panel(image, lines, name):
    """Return the part of a grey photograph around coloured lines (n, 2), at most a square, with the lines and a name over it."""
    points = np.concatenate([points for points, _ in lines] or [np.zeros((0, 2))])
    low, high = np.zeros(2), np.array(image.shape[1::-1], float)
    if len(points):
        low, high = np.maximum(points.min(axis=0) - MARGIN_PX, low), np.minimum(points.max(axis=0) + MARGIN_PX, high)
    low, high = np.floor(low).astype(int), np.ceil(high).astype(int)
    scale = PANEL_PX / max(*(high - low), 1)
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    part = cv2.resize(image[low[1] : high[1], low[0] : high[0]], None, fx=scale, fy=scale, interpolation=how)[:PANEL_PX, :PANEL_PX]
    shown = np.full((CAPTION_PX + part.shape[0], max(part.shape[1], NARROWEST_PX), 3), 255, np.uint8)
    shown[:CAPTION_PX] = caption(name, shown.shape[1])
    below = shown[CAPTION_PX:]
    below[: part.shape[0], : part.shape[1]] = part[:, :, None]
    for points, colour in lines:
        # pixel centres are at integers, before and after
        drawn = np.rint(((points - low + 0.5) * scale - 0.5) * 2**SUBPIXEL_BITS).astype(np.int32)
        # what was found must show below the pick
        cv2.polylines(below, [drawn], False, colour, 1 if colour == YELLOW else 2, cv2.LINE_AA, SUBPIXEL_BITS)
        if colour == YELLOW:
            for u, v in drawn:
                cv2.circle(below, (int(u), int(v)), 5 * 2**SUBPIXEL_BITS, colour, 2, cv2.LINE_AA, SUBPIXEL_BITS)
    return shown


def caption(text, width):
    """Return a line of text, black on white, as small as it has to be for a width in px."""
    strip = np.full((CAPTION_PX, width, 3), 255, np.uint8)
    # the fonts of OpenCV know no other letters
    text = text.encode("ascii", "replace").decode()
    size = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, 1.0, 1)[0][0]
    scale = min(0.6, (width - 20) / max(size, 1))
    cv2.putText(strip, text, (10, CAPTION_PX - 12), cv2.FONT_HERSHEY_SIMPLEX, scale, (0, 0, 0), 1, cv2.LINE_AA)
    return strip


def share(count, total):
    """Return a number with its part of the whole."""
    return f"{count} ({100 * count / max(total, 1):.0f} %)"


def shares(name, counts):
    """Return the beginning of a row: a name, the sum and the shares of all verdicts."""
    total = sum(counts.values())
    return f"| {name} | {total} | {' | '.join(share(counts[verdict], total) for verdict in VERDICTS)} |"


def accuracy_row(name, deviations):
    """Return a row with the means, and the medians in brackets."""
    cells = [f"{mean(deviations, key)} (median {mean(deviations, key, statistics.median)})" for key in ("position", "direction")]
    return f"| {name} | {len(deviations)} | {cells[0]} | {cells[1]} |"


def mean(deviations, key, of=statistics.mean):
    """Return a mean as text, a dash where there is nothing."""
    return f"{of(d[key] for d in deviations):.2f}" if deviations else "-"


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=Path("recognition.md"))
    parser.add_argument("--only", nargs="+", default=[], metavar="SCENE", help="scenes or stations, such as dummy or dummy/A")
    parser.add_argument("--no-auto", action="store_true")
    parser.add_argument("--brute-force", nargs="?", const="lsd", choices=("lsd", "hough"), help="with lines of this detector; the paper's is lsd")
    parser.add_argument("--time-limit", type=float, default=BruteForceSettings.time_limit, help="of the brute force, s per station (%(default)g)")
    options = parser.parse_args()
    options.out.parent.mkdir(parents=True, exist_ok=True)
    score = judge(options.folder)
    rows = ["| scene | pipes | correct | wrong | failed | mean mm | mean deg | s per pick |", "|---|---|---|---|---|---|---|---|"]
    columns = ("scene", "method", "visible pipes", "found", "recall", "answers", "false", "precision", "s", "s of the processors", "")
    auto = [f"| {' | '.join(columns)} |", "|---" * len(columns) + "|"]
    counts, unpicked, dummy_one, dummy_three = Counter(), {}, [], []
    for folder in station_folders(options.folder, options.only):
        scene = Scene(score, folder)
        views = views_of(scene.station)
        answers, seconds = with_picks(scene, views, options.out)
        here = Counter(answer.verdict for answer in answers)
        counts += here
        three = [answer.deviation for answer in answers if answer.verdict == "correct"]
        rows.append(f"{shares(scene.name, here)} {mean(three, 'position')} | {mean(three, 'direction')} | {seconds:.2f} |")
        print(rows[-1], flush=True)
        if folder.parent.name == "dummy":
            dummy_one += [one for pick in scene.picks.pipes if (one := from_one_image(scene, views, pick)) is not None]
            dummy_three += three
        methods = {} if options.no_auto else {"--auto": partial(without_picks, views)}
        if options.brute_force:
            methods[f"brute force, {options.brute_force}"] = partial(by_brute_force, scene, views, options.brute_force, options.time_limit)
        for name, method in methods.items():
            began, busy = time.perf_counter(), time.process_time()
            pipes, remark = method()
            seconds = [f"{time.perf_counter() - began:.1f}", f"{time.process_time() - busy:.1f}"]
            found = judged(scene, pipes)
            unpicked.setdefault(name, []).append(found)
            auto.append(found.row(scene.name, name, *seconds, remark))
            print(auto[-1], flush=True)
    rows.append(f"{shares('**all**', counts)} | | |")
    rows.append(PAPER_RECOGNITION)
    auto += [Unpicked.total(parts).row("**all**", name, "", "", "") for name, parts in unpicked.items()]
    accuracy = [
        "| pipes of dummy | pipes | mean mm | mean deg |",
        "|---|---|---|---|",
        *PAPER_ACCURACY,
        accuracy_row("here: one image, the size known", dummy_one),
        accuracy_row("here: three images, adjusted one by one", dummy_three),
    ]
    text = "\n".join(["# Recognition of pipes", "", "With picks:", "", *rows, "", *accuracy, "", "Without picks:", "", *auto, ""])
    options.out.write_text(text, encoding="utf-8")
    print(text)
    print(f"written: {options.out} and pictures of the failures beside it", file=sys.stderr)


if __name__ == "__main__":
    main()
