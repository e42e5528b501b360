# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elbows and flanges from picks over scenes with known truth, beside the published figures; then their speed.

    python bench/elbows_flanges.py FOLDER [--out elbows_flanges.md] [--only dummy/A ...]

FOLDER holds ``scenes/NAME/STATION`` with station.json, picks.json and truth, and ``tools/score.py``, which judges.
Prints Markdown tables. An elbow is asked for where the pipes on both sides of it in the truth's runs were found.
"""

import argparse
import statistics
import sys
import time
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from scenes import Scene, judge, made_up, station_folders

from pipeworkbench.errors import InputError
from pipeworkbench.recon import elbows
from pipeworkbench.recon.flanges import from_pick
from pipeworkbench.recon.reconstruct import reconstruct
from pipeworkbench.recon.station import read_station
from pipeworkbench.recon.views import views_of

SAMPLE = Path(__file__).resolve().parent.parent / "resources" / "samples" / "dummy" / "A"
MATCHED_MM, TURNED_MM = 15.0, 50.0  # the judge's: what is further off is false; what a flange that faces the other way counts as
PIPES, REPEATS = 100, 3
ASKED_SECONDS = {"elbows": 2.0, "flange": 0.3}
# axial mm, orthogonal mm, direction deg of each flange, and their means as they are published
PAPER_FLANGES = {
    "Table 6: before the common adjustment": (((0.2, 1.4, 2.0), (1.6, 2.0, 2.3), (0.6, 2.3, 1.0), (1.3, 2.5, 2.3)), (0.9, 2.1, 1.9)),
    "Table 7: after the common adjustment": (((0.2, 0.8, 0.8), (1.3, 2.6, 2.1), (0.2, 0.7, 0.5), (0.0, 0.5, 0.3)), (0.4, 1.1, 0.9)),
}
ELBOW_COLUMNS = ("scene", "elbows", "both neighbours found", "of these found", "found in all", "false", "type right", "mean mm", "max mm", "s")
FLANGE_COLUMNS = ("scene", "picks", "found", "false", "type right", "type and PN right", "axial mm", "orthogonal mm", "direction deg")
SPEED_COLUMNS = ("", "of", "median s", "max s", "median s of the processors", "asked s")


class Sum:
    """Counts and lists that can be added up."""

    @classmethod
    def total(cls, parts):
        """Return the sums, lists one after the other."""
        return cls(*(sum((getattr(part, f.name) for part in parts), f.type()) for f in fields(cls)))


@dataclass(frozen=True)
class Elbows(Sum):
    """The judgement on elbows: ``asked`` of ``every`` and how many of these are ``there``; of all answers the false ones,
    of the ``off`` mm found those whose bend type is right; the seconds of the whole reconstruction.
    """

    every: int
    asked: int
    there: int
    false: int
    right: int
    off: tuple
    seconds: float

    def row(self, name):
        """Return a row of the table."""
        cells = (name, self.every, self.asked, share(self.there, self.asked), len(self.off), self.false, share(self.right, len(self.off)))
        return row(*cells, mean(self.off), f"{max(self.off):.2f}" if self.off else "-", f"{self.seconds:.1f}")


@dataclass(frozen=True)
class Flanges(Sum):
    """The judgement on the flanges of ``picks``: ``off`` are axial mm, orthogonal mm, degrees of those found.

    ``types`` and ``classes`` count where the type, and the pressure class too, is right; other flanges than the picks' may be false, too.
    """

    picks: int
    false: int
    types: int
    classes: int
    off: tuple

    def row(self, name):
        """Return a row of the table."""
        there, types, classes = (share(count, self.picks) for count in (len(self.off), self.types, self.classes))
        return row(name, self.picks, there, self.false, types, classes, *(mean([one[column] for one in self.off]) for column in range(3)))


def share(count, total):
    """Return a number with its part of the whole."""
    return f"{count} ({100 * count / total:.0f} %)" if total else "0"


def mean(values):
    """Return a mean as text, a dash where there is nothing."""
    return f"{statistics.mean(values):.2f}" if values else "-"


def row(*cells):
    """Return a row of a table."""
    return f"| {' | '.join(map(str, cells))} |"


def table(columns, rows):
    """Return the lines of a table."""
    return [row(*columns), "|---" * len(columns) + "|", *rows]


def components_of(scene, pipeline):
    """Return the components of each kind in the world's frame, as the judge reads them from a file."""
    every = [scene.score.move(component, scene.world_from_level) for component in pipeline.to_dict()["components"]]
    return {kind: [c for c in every if c["kind"] == kind] for kind in ("pipe", "elbow", "flange")}


def neighbours_of(scene):
    """Return the names of the true pipes before and after each elbow of the runs, None where there is none."""
    return {
        name: tuple(next((other for other in part if other in scene.pipes), None) for part in (reversed(run[:place]), run[place + 1 :]))
        for run in scene.runs
        for place, name in enumerate(run)
        if name in scene.elbows
    }


def judged_elbows(scene, components, seconds=0.0):
    """Judge the elbows and say in sentences what is missing, false or of a wrong type."""
    score = scene.score
    pipes = {name for name, true in scene.pipes.items() if any(score.pipe_ok(score.pipe_dev(pipe, true)) for pipe in components["pipe"])}
    asked = {name for name, both in neighbours_of(scene).items() if set(both) <= pipes}
    off, remarks, false, right = {}, [], 0, 0
    for elbow in components["elbow"]:
        distance = {name: float(np.linalg.norm(np.array(true["intersection"]) - elbow["intersection"])) for name, true in scene.elbows.items()}
        name = min(distance, key=distance.__getitem__, default=None)
        if name is None or distance[name] > MATCHED_MM:
            false += 1
            remarks.append(f"{scene.name} {elbow['id']}: no elbow is there")
        elif name not in off:
            off[name] = distance[name]
            true, found = scene.elbows[name]["bend_type"], elbow.get("bend_type")
            right += found == true
            if found != true:
                remarks.append(f"{scene.name} {name}: {found or 'free'} with a radius of {elbow['bend_radius']:.1f} mm instead of {true}")
    remarks += [f"{scene.name} {name}: not found, both neighbours are" for name in sorted(asked - set(off))]
    return Elbows(len(scene.elbows), len(asked), len(asked & set(off)), false, right, tuple(off.values()), seconds), remarks


def judged_flanges(scene, components, failures=()):
    """Judge the flanges of picks and say in sentences what is missing or not what it should be; ``failures`` are (pick, reason)."""
    why = dict(failures)
    named = {index: name for index, name in enumerate(scene.truth_of_pick) if name in scene.flanges}
    off, remarks, false, types, classes = {}, [], 0, 0, 0
    for flange in components["flange"]:
        pick = flange.get("pick")
        name = named[pick] if pick in named else min(scene.flanges, key=lambda one: apart(scene, flange, one), default=None)
        if name is None or apart(scene, flange, name) > MATCHED_MM:
            false += 1
            place = "" if name is None else f", {name} is {apart(scene, flange, name):.0f} mm away"
            why.setdefault(pick, "its flange is somewhere else")
            remarks.append(f"{scene.name} {flange['id']}: no flange is there{place}")
        elif pick in named:
            true = scene.flanges[name]
            axis, away = scene.score.unit(true["axis"]), flange["face"] - np.array(true["face"])
            along = float(away @ axis)
            off[pick] = abs(along), float(np.linalg.norm(away - along * axis)), scene.score.angle(flange["axis"], axis)
            meant = [(str(one["flange_type"]).zfill(2), float(one["pn"])) for one in (flange, *flange.get("equivalents", ()))]
            types += any(kind == true["type"] for kind, _ in meant)
            classes += (true["type"], true["pn"]) in meant
            if (true["type"], true["pn"]) not in meant:
                remarks.append(f"{scene.name} {name}: type {meant[0][0]}, PN {meant[0][1]:g} instead of type {true['type']}, PN {true['pn']:g}")
    remarks += [f"{scene.name} {name}: not found: {why.get(pick, 'no reason')}" for pick, name in named.items() if pick not in off]
    return Flanges(len(named), false, types, classes, tuple(off.values())), remarks


def apart(scene, flange, truth):
    """Return the judge's distance of a flange from a true one."""
    true = scene.flanges[truth]
    turned = float(np.dot(true["axis"], flange["axis"])) < 0
    return float(np.linalg.norm(flange["face"] - np.array(true["face"]))) + TURNED_MM * turned


def timed(function, *arguments):
    """Return what a function gives, None where it refuses, and the seconds by the clock and of the processors."""
    began, busy = time.perf_counter(), time.process_time()
    try:
        result = function(*arguments)
    except InputError:
        result = None
    return result, (time.perf_counter() - began, time.process_time() - busy)


def flange_seconds(views, picks, pipes):
    """Return the seconds that each flange pick takes to be ranked, the failures' too."""
    return [timed(from_pick, views, pick, pipes)[1] for pick in picks]


def elbow_speed(cameras, count, repeats=REPEATS):
    """Return the seconds of searching all elbows of so many made-up pipes, each time, and their judgement."""
    made = made_up(cameras, count)
    runs = [timed(elbows.detect, made.views, made.pipes) for _ in range(repeats)]
    found, seconds = runs[0][0], [seconds for _, seconds in runs]
    off, false, right = {}, 0, 0
    for elbow in found:
        distance = [float(np.linalg.norm(elbow.corner - true.intersection)) for true in made.elbows]
        nearest = int(np.argmin(distance))
        false += distance[nearest] > MATCHED_MM
        if distance[nearest] <= MATCHED_MM and nearest not in off:
            off[nearest] = distance[nearest]
            right += elbow.bend is not None and elbow.bend.bend_type == made.elbows[nearest].bend_type
    asked = len(made.elbows)
    return seconds, Elbows(asked, asked, len(off), false, right, tuple(off.values()), statistics.median(seconds)[0])


def speed_row(name, of, seconds, asked):
    """Return a row of the table of speeds."""
    clock, busy = zip(*seconds, strict=True) if seconds else ((np.nan,), (np.nan,))
    return row(name, of, *(f"{value:.2f}" for value in (statistics.median(clock), max(clock), statistics.median(busy))), f"< {asked:g}")


def paper_rows():
    """Return the rows of the paper's tables: the mean and, in brackets, each flange."""
    rows = []
    for name, (flanges, means) in PAPER_FLANGES.items():
        cells = [f"{middle:.1f} ({', '.join(map(str, column))})" for middle, column in zip(means, zip(*flanges, strict=True), strict=True)]
        rows.append(row(f"paper, {name}", len(flanges), "", "", "", "", *cells))
    return rows


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, metavar="FILE.md", help="where to write what is printed")
    parser.add_argument("--only", nargs="+", default=[], metavar="SCENE", help="scenes or stations, such as dummy or dummy/A")
    options = parser.parse_args()
    score = judge(options.folder)
    bent, flanged, remarks, ranked = {}, {}, [], []
    for folder in station_folders(options.folder, options.only):
        scene = Scene(score, folder)
        print(scene.name, file=sys.stderr, flush=True)
        began = time.perf_counter()
        found = reconstruct(scene.station, scene.picks)
        seconds = time.perf_counter() - began
        components = components_of(scene, found.pipeline)
        bent[scene.name], first = judged_elbows(scene, components, seconds)
        flanged[scene.name], second = judged_flanges(scene, components, found.failed_picks)
        remarks += first + second
        ranked += flange_seconds(views_of(scene.station), scene.picks.flanges, found.pipeline.pipes)
    print("made-up pipes", file=sys.stderr, flush=True)
    searched, made = elbow_speed(read_station(SAMPLE).cameras, PIPES)
    elbow_rows = [part.row(name) for name, part in bent.items()]
    elbow_rows += [Elbows.total(bent.values()).row("**all**"), row("asked", "", "", "all", "", 0, "95 %", "1 on dummy", "", "")]
    elbow_rows.append(row("paper (no figures for elbows)", *[""] * (len(ELBOW_COLUMNS) - 1)))
    elbow_rows.append(made.row(f"{PIPES} made-up pipes, elbows alone"))
    flange_rows = [part.row(name) for name, part in flanged.items()]
    flange_rows += [Flanges.total(flanged.values()).row("**all**"), row("asked", "", "90 %", "", "90 %", "80 %", "0.6", "", ""), *paper_rows()]
    speed = [
        speed_row(f"all elbows of {PIPES} made-up pipes", f"{REPEATS} times", searched, ASKED_SECONDS["elbows"]),
        speed_row("one flange ranked", f"{len(ranked)} picks", ranked, ASKED_SECONDS["flange"]),
    ]
    lines = ["# Elbows and flanges", "", "Elbows, with the seconds of the whole reconstruction from picks:", ""]
    lines += [
        *table(ELBOW_COLUMNS, elbow_rows),
        "",
        "Flanges of picks (types and classes with what has the same dimensions; parts are of the picks):",
        "",
    ]
    lines += [*table(FLANGE_COLUMNS, flange_rows), "", "Speed:", "", *table(SPEED_COLUMNS, speed), "", "What is not as it should be:", ""]
    text = "\n".join([*lines, *(f"- {remark}" for remark in remarks or ["nothing"]), ""])
    print(text)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
