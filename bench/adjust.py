# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common adjustment: accuracy on scenes with known truth, sigmas against errors in simulations, convergence and time.

    python bench/adjust.py [FOLDER] [--out adjust.md] [--only dummy/A ...] [--pipelines 200]

FOLDER holds ``scenes/NAME/STATION`` and ``tools/score.py``, which judges; without it there are only the simulations. Prints Markdown
tables. The peer is SciPy's least_squares on the same observations: two-point derivatives, the sparse structure given.
"""

import argparse
import os
import statistics
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scenes import Scene, judge, station_folders
from scipy.optimize import least_squares
from scipy.sparse import coo_matrix
from simulated import Noise, errors, perturbed, plant, rig, simulated_pipeline, simulated_views

from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.adjust import AdjustmentSettings, Problem, StationViews, adjust
from pipeworkbench.recon.adjustment.conditions import NOBODY
from pipeworkbench.recon.adjustment.linearisation import Variances, linearised, sampled
from pipeworkbench.recon.adjustment.state import State
from pipeworkbench.recon.adjustment.variances import assessed
from pipeworkbench.recon.ends import ends_of
from pipeworkbench.recon.reconstruct import reconstruct

PAPER = {"pipes": (1.1, 0.3), "flanges": (0.4, 1.1, 0.9)}
ASKED = {"pipes": (0.25, 0.08), "flanges": (0.3, 0.4, 0.1), "gap": 0.01}
COMPONENTS = 10  # of a simulated pipeline
SETTINGS = AdjustmentSettings()
SCATTER = 0.1  # px, of edge points; the common errors are what the settings expect of contours that scatter so
AS_EXPECTED = Noise(
    sigma=SCATTER,
    common=float(np.hypot(SETTINGS.common_sigma, SETTINGS.common_share * SCATTER)),
    trend=float(np.hypot(SETTINGS.trend_sigma, SETTINGS.trend_share * SCATTER)),
)
NOISES = {
    "as expected": AS_EXPECTED,
    "20 % missing, 2 % gross errors, 50 other edges": replace(AS_EXPECTED, missing=0.2, outliers=0.02, clutter=50),
    "common errors of 0.2 px": replace(AS_EXPECTED, common=0.2, trend=0.1),
    "no common errors": Noise(sigma=SCATTER),
}
START_MM, START_DEG = 1.0, 0.1  # off the truth, where the start does not matter
ROUGH_MM, ROUGH_DEG = 20.0, 3.0
CONVERGED_MM = 1.0  # from where an iteration that began at the truth ends
SAME_SPACING_PX, SAMPLES = 1.5, 100  # so many samples lie along each contour
REPEATS = 3
FEWER = 4  # pipelines with other errors than expected
SIZES = ((100, 1), (300, 4), (1000, 12))  # components and stations
PEER_COMPONENTS = 100


def told(row):
    """Say on the terminal what is measured already, and return it."""
    print(*row, file=sys.stderr, flush=True)
    return row


def table(title, columns, rows):
    """Print a Markdown table."""
    print(f"\n## {title}\n")
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" * len(columns))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |", flush=True)


def scenes(folder: Path, only: Sequence[str]) -> None:
    """Judge the reconstruction of scenes with and without the common adjustment."""
    score = judge(folder)
    rows = []
    for where in station_folders(folder, only):
        scene = Scene(score, where)
        for name, settings in (("found", None), ("adjusted", SETTINGS)):
            found = reconstruct(scene.station, scene.picks, adjustment=settings)
            pipes, elbows, flanges = _deviations(scene, found.pipeline)
            solution = found.adjustment
            ratio = np.sqrt(np.mean([one[2] ** 2 for one in pipes])) if pipes else np.nan
            rows.append(
                (
                    f"{scene.name} {name}",
                    len(pipes),
                    *(f"{statistics.mean(values):.3f}" for values in list(zip(*pipes, strict=True))[:2]),
                    f"{ratio:.2f}",
                    f"{statistics.mean(elbows):.3f}" if elbows else "-",
                    *([f"{statistics.mean(values):.3f}" for values in zip(*flanges, strict=True)] if flanges else ["-"] * 3),
                    f"{_largest_gap(found.pipeline):.4f}",
                    f"{solution.iterations}" if solution else "-",
                )
            )
    asked = ("asked: dummy", "", *ASKED["pipes"], "", "", *ASKED["flanges"], ASKED["gap"], "")
    paper = ("paper, after", "", *PAPER["pipes"], "", "", *PAPER["flanges"], "", "")
    columns = ("scene", "pipes", "mm", "deg", "RMS of error / sigma", "elbows mm", "flanges axial mm", "orthogonal mm", "deg", "gap mm", "iterations")
    table("Scenes: mean deviations of what was recognised rightly", columns, [*rows, asked, paper])


def _deviations(scene: Scene, pipeline: Pipeline):
    """Return (mm, deg, error over sigma) of the right pipes, mm of elbows, (axial mm, orthogonal mm, deg) of flanges."""
    pipes, elbows, flanges = [], [], []
    level_from_world = np.linalg.inv(scene.world_from_level)

    def here(point):
        return level_from_world[:3, :3] @ np.array(point) + level_from_world[:3, 3]

    for one in pipeline.components:
        if one.kind == "pipe" and one.pick is not None:
            truth = scene.truth_of_pick[one.pick]
            off = scene.deviation((one.start, one.end), one.outer_diameter, truth)
            if scene.score.pipe_ok(off):
                cylinder, _ = scene.true_cylinder(truth)
                middle = (np.array(one.start) + one.end) / 2 - cylinder.point
                error = middle - (middle @ cylinder.direction) * cylinder.direction
                pipes.append((off["position"], off["direction"], float(np.linalg.norm(error) / np.linalg.norm(one.sigma_position))))
        elif one.kind == "elbow":
            nearest = min(float(np.linalg.norm(here(t["intersection"]) - one.intersection)) for t in scene.elbows.values())
            elbows += [nearest] if nearest < 15 else []
        elif one.kind == "flange" and one.pick is not None:
            truth = scene.flanges[scene.truth_of_pick[one.pick]]
            axis = level_from_world[:3, :3] @ np.array(truth["axis"])
            off = np.array(one.face) - here(truth["face"])
            along = float(off @ axis)
            flanges.append((abs(along), float(np.linalg.norm(off - along * axis)), scene.score.angle(one.axis, axis)))
    return pipes, elbows, flanges


def _largest_gap(pipeline: Pipeline) -> float:
    """Return the largest distance in mm of joined ends, gaskets left out."""
    rows = {component.id: row for row, component in enumerate(pipeline.components)}
    ends = ends_of(pipeline.components)
    place = {ends.row_and_port(number): ends.point[number] for number in range(len(ends))}
    gaps = [
        float(np.linalg.norm(place[rows[j.a], j.a_port] - place[rows[j.b], j.b_port]))
        for j in pipeline.joints
        if not (j.a_port == j.b_port == 0 and {pipeline.components[rows[j.a]].kind, pipeline.components[rows[j.b]].kind} == {"flange"})
    ]
    return max(gaps, default=0.0)


@dataclass(frozen=True, eq=False)
class Made:
    """A simulated pipeline: truth, joints and views."""

    truth: tuple
    joints: tuple
    views: tuple

    def problem(self, start, **more):
        """Return the problem with other starting values."""
        return Problem(tuple(start), (StationViews("S", self.views),), self.joints, **more)


def made(seed: int, noise: Noise, count: int = COMPONENTS) -> tuple[Made, np.random.Generator]:
    """Return a simulated pipeline before one rig."""
    random = np.random.default_rng(seed)
    cameras = rig((0, 0, 0), 0.0)
    truth, joints = simulated_pipeline(random, count, cameras)
    return Made(tuple(truth), tuple(joints), simulated_views(cameras, truth, random, noise)), random


def sigmas(pipelines: int) -> None:
    """Compare claimed standard deviations with errors, and errors with the Cramer-Rao bound of the same design."""
    rows = []
    for name, noise in NOISES.items():
        ratios, off, bound, left = [], [], [], 0
        number = pipelines if noise is AS_EXPECTED else max(pipelines // FEWER, 1)
        for seed in range(number):
            one, random = made(seed, noise)
            solution = adjust(one.problem(perturbed(one.truth, random, START_MM, START_DEG)))
            error = errors(solution.components, one.truth).position
            best = _bound(one, noise)
            for row, component in enumerate(one.truth):
                estimate = solution.estimates.get(component.id)
                if estimate is None or best[row] is None:
                    left += 1
                    continue
                # only the directions in which a component can move
                values, axes = np.linalg.eigh(estimate.covariance)
                there = values > 1e-9 * values[-1]
                ratios.append(float(np.mean((axes.T @ error[row])[there] ** 2 / values[there])))
                off.append(float(error[row] @ error[row]))
                bound.append(best[row])
        rows.append(
            told(
                (
                    name,
                    number,
                    len(ratios),
                    left,
                    f"{np.sqrt(np.mean(ratios)):.2f}",
                    f"{np.sqrt(np.mean(off)):.3f}",
                    f"{np.sqrt(np.mean(bound)):.3f}",
                    f"{np.mean(np.sqrt(off)) / np.mean(np.sqrt(bound)):.2f}",
                )
            )
        )
    rows.append(("asked", 200, "", "", "0.8 to 1.25", "", "", "at most 1.2"))
    columns = (
        "errors of edges",
        "pipelines",
        "components",
        "not determined",
        "RMS of error / sigma",
        "RMS error mm",
        "bound mm",
        "mean error / bound",
    )
    table(f"Simulated pipelines of {COMPONENTS} components: sigmas and errors", columns, rows)


def _bound(one: Made, noise: Noise) -> list[float | None]:
    """Return the variances (mm^2) of positions that no unbiased estimate gets below: at the truth, with the true variances."""
    known = replace(SETTINGS, common_sigma=max(noise.common, 1e-3), common_share=0.0, trend_sigma=max(noise.trend, 1e-3), trend_share=0.0)
    state = State.of(one.problem(one.truth), known)
    linear = linearised(state, sampled(state, known), known.ranges[-1], Variances(), known)
    cofactor = assessed(linear, Variances(), known, pseudo=False).motion_cofactor
    variance = np.einsum("cii->c", cofactor[:, :3, :3])
    return [float(value) if names and value < known.undetermined**2 else None for value, names in zip(variance, linear.unknowns.names, strict=True)]


def convergence(pipelines: int) -> None:
    """Count how often rough starting values lead to where the truth leads."""
    asked = right = told = wrong = whole = 0
    counts = []
    for seed in range(pipelines):
        one, random = made(seed + 10_000, AS_EXPECTED)
        reference = adjust(one.problem(one.truth))
        solution = adjust(one.problem(perturbed(one.truth, random, ROUGH_MM, ROUGH_DEG)), AdjustmentSettings.for_rough_values())
        counts.append(solution.iterations)
        off = np.linalg.norm(errors(solution.components, reference.components).position, axis=1)
        known = [component.id not in reference.undetermined for component in one.truth]
        asked += sum(known)
        good = off <= CONVERGED_MM
        right += int((good & known).sum())
        said = np.array([component.id in solution.undetermined for component in one.truth])
        told += int((~good & said & known).sum())
        wrong += int((~good & ~said & known).sum())
        whole += bool((good | ~np.array(known)).all())
    table(
        f"Starting values {ROUGH_MM:g} mm and {ROUGH_DEG:g} degrees off",
        ("pipelines", "wholly right", "components", "right", "said to be undetermined", "wrong", "median iterations", "asked"),
        [(pipelines, f"{whole / pipelines:.1%}", asked, f"{right / asked:.2%}", told, wrong, statistics.median(counts), "99 %")],
    )


def times() -> None:
    """Time the adjustment over its size, and the peer beside it."""
    dense = replace(SETTINGS, spacing=SAME_SPACING_PX, most_samples=SAMPLES)
    rows, measured = [], []
    first = None
    for count, stations in SIZES:
        problem = _problem(count, stations)
        first = first or problem
        for name, settings in (("default", SETTINGS), (f"up to {SAMPLES} samples per contour", dense)):
            if settings is dense and stations > 1:
                continue
            seconds = []
            for _ in range(REPEATS if stations == 1 else 1):
                began = time.perf_counter()
                solution = adjust(problem, settings)
                seconds.append(time.perf_counter() - began)
            middle = statistics.median(seconds)
            if settings is SETTINGS:
                measured.append((count, middle))
            samples = sum(fit.samples for fit in solution.contours)
            rows.append(told((count, 3 * stations, name, len(solution.contours), samples, solution.unknowns, solution.iterations, f"{middle:.2f}")))
    columns = ("components", "images", "samples", "contours", "samples in all", "unknowns", "iterations", "s")
    table(f"Time on {os.cpu_count()} cores (asked: 100 in 1 s, 1,000 in 15 s)", columns, rows)
    exponent = np.polyfit(*np.log(np.array(measured)).T, 1)[0]
    print(f"\nTime grows with the exponent {exponent:.2f} of the number of components (asked: at most 1.2).")
    peer(first)


def _problem(count: int, stations: int) -> Problem:
    random = np.random.default_rng(1)
    if stations == 1:
        one, random = made(1, AS_EXPECTED, count)
        return one.problem(perturbed(one.truth, random, START_MM, START_DEG))
    truth, joints, rigs = plant(random, count, stations)
    views = [StationViews(f"S{number}", simulated_views(cameras, truth, random, AS_EXPECTED)) for number, cameras in enumerate(rigs)]
    return Problem(tuple(perturbed(truth, random, START_MM, START_DEG)), tuple(views), tuple(joints))


def peer(problem: Problem) -> None:
    """Time SciPy's least_squares on the observations of a problem: components, contours' systematic errors and conditions."""
    began = time.perf_counter()
    solution = adjust(problem)
    ours = time.perf_counter() - began
    state = State.of(problem, SETTINGS)
    samples = sampled(state, SETTINGS)
    start = linearised(state, samples, SETTINGS.ranges[0], Variances(), SETTINGS)
    unknowns, count = start.unknowns, len(start.groups)
    deviation = np.sqrt(np.maximum(start.groups.systematic_variance(SETTINGS), 1e-12))
    sizes = [len(one.group_owner) for one in samples]
    group = np.concatenate([one.group + first for one, first in zip(samples, np.cumsum([0, *sizes[:-1]]), strict=True)])
    pattern = np.concatenate([np.column_stack([np.ones(len(one)), one.pattern]) for one in samples])
    weight = np.sqrt(np.concatenate([rows.weight for rows in start.samples]))
    owner = np.concatenate([one.owner for one in samples])
    evaluations = 0

    def residuals(x):
        nonlocal evaluations
        evaluations += 1
        now = linearised(state.moved(unknowns, x[: unknowns.total]), samples, SETTINGS.ranges[0], Variances(), SETTINGS, start.samples)
        systematic = x[unknowns.total :].reshape(count, 3)
        distance = np.nan_to_num(np.concatenate([rows.distance for rows in now.samples]))
        image = weight * (distance - np.einsum("ni,ni->n", pattern, (systematic * deviation)[group]))
        return np.concatenate([image, systematic.ravel(), now.observed.misclosure / now.observed.sigma])

    structure = _structure(start, owner, group, count)
    began = time.perf_counter()
    found = least_squares(residuals, np.zeros(unknowns.total + 3 * count), jac="2-point", jac_sparsity=structure, x_scale="jac", max_nfev=30)
    theirs = time.perf_counter() - began
    table(
        f"SciPy's least_squares on {PEER_COMPONENTS} components (its edges are matched once, ours anew each time)",
        ("", "s", "evaluations", "times slower"),
        [
            ("adjust", f"{ours:.2f}", solution.iterations, 1),
            ("least_squares", f"{theirs:.1f}", evaluations, f"{theirs / ours:.0f} (asked: 20); {found.message}"),
        ],
    )


def _structure(start, owner, group, count):
    """Return which residuals depend on which unknowns."""
    unknowns = start.unknowns
    rows, columns = [], []

    def add(row, column):
        rows.append(np.repeat(row, len(column)))
        columns.append(np.tile(column, len(row)))

    # pipes end where their neighbours do: their contours move with these
    near = [{component} for component in range(len(unknowns.count))]
    involved = [{body for body in bodies if body != NOBODY} for bodies in start.observed.bodies.tolist()]
    for bodies in involved:
        for component in bodies:
            near[component] |= bodies
    parts = [np.concatenate([unknowns.columns(other) for other in sorted(ours)]) for ours in near]
    for component, column in enumerate(parts):
        add(np.flatnonzero(owner == component), column)
    total = len(owner)
    for number in range(3):
        rows += [np.arange(total), total + 3 * np.arange(count) + number]
        columns += [unknowns.total + 3 * group + number, unknowns.total + 3 * np.arange(count) + number]
    for number, bodies in enumerate(involved):
        for component in bodies:
            add(np.array([total + 3 * count + number]), parts[component])
    row, column = np.concatenate(rows), np.concatenate(columns)
    shape = (total + 3 * count + len(start.observed), unknowns.total + 3 * count)
    return coo_matrix((np.ones(len(row)), (row, column)), shape=shape).tocsr()


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--pipelines", type=int, default=200)
    parser.add_argument("--parts", nargs="*", default=["scenes", "times", "sigmas", "convergence"])
    options = parser.parse_args()
    if options.out:
        sys.stdout = options.out.open("w", encoding="utf-8")
    if options.folder and "scenes" in options.parts:
        scenes(options.folder, options.only)
    if "times" in options.parts:
        times()
    if "sigmas" in options.parts:
        sigmas(options.pipelines)
    if "convergence" in options.parts:
        convergence(max(options.pipelines // FEWER, 1))


if __name__ == "__main__":
    main()
