# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station becomes a pipeline: the main job, from images and picks, or images alone, to components."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.picks import Picks, PipePick
from pipeworkbench.recon.pipes import PipeCandidate, from_pick
from pipeworkbench.recon.search import PickSettings
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View, views_of

# Level of Accuracy of the U.S. Institute of Building Documentation: upper limits in mm at 95 %
LEVELS_OF_ACCURACY = ((1.0, "LOA50"), (5.0, "LOA40"), (15.0, "LOA30"), (50.0, "LOA20"))
WORKERS = 2  # picks at a time; more wait for each other's interpreter lock
COVERAGE_FACTOR = 2.0  # standard deviations in a 95 % interval


@dataclass(frozen=True)
class Reconstruction:
    """What came out of a station: the pipeline and the indices of the picks that gave nothing."""

    pipeline: Pipeline
    failed_picks: tuple[int, ...]
    skipped_picks: tuple[int, ...]


def reconstruct(
    station: Station,
    picks: Picks,
    settings: PickSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
) -> Reconstruction:
    """Reconstruct the pipes that were picked in a station.

    Parameters
    ----------
    station : Station
    picks : Picks
    settings : PickSettings, optional
    progress : callable
        Called with what is being done, how many steps are done and how many there are.

    Raises
    ------
    InputError
        Where an image does not fit the station.
    """
    steps = len(picks.pipes) + 1
    progress("finding edges", 0, steps)
    views = views_of(station)
    pipes, failed = [], []
    # threads: the array operations release the interpreter lock, and nothing needs to be copied
    with ThreadPoolExecutor(max_workers=WORKERS) as pool:
        running = [pool.submit(pipe_from_pick, views, pick, station, settings) for pick in picks.pipes]
        try:
            for done, (pick, future) in enumerate(zip(picks.pipes, running, strict=True), 1):
                progress(f"pick {pick.index}", done, steps)
                pipe = future.result()
                if pipe is None:
                    failed.append(pick.index)
                else:
                    pipes.append(pipe)
        except BaseException:
            # the user cancelled or a step failed: do not wait for picks that nobody wants
            pool.shutdown(wait=True, cancel_futures=True)
            raise
    progress("done", steps, steps)
    return Reconstruction(Pipeline.of_station(station.name, tuple(pipes)), tuple(failed), tuple(p.index for p in picks.flanges))


def reconstruct_without_picks(
    station: Station,
    settings: PickSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
) -> Reconstruction:
    """Reconstruct the pipes of a station without picks.

    Parameters
    ----------
    station : Station
    settings : PickSettings, optional
        Its working range and diameters limit what is looked for.
    progress : callable
        Called with what is being done, how many steps are done and how many there are.

    Raises
    ------
    InputError
        Where an image does not fit the station.
    """
    from pipeworkbench.recon.detect import STEPS, DetectSettings, detect

    settings = settings or PickSettings()
    limits = replace(DetectSettings(), working_range=settings.working_range)
    # without a wish the range stays at what can be told from clutter
    if settings.diameter_range != PickSettings().diameter_range:
        limits = replace(limits, diameter_range=settings.diameter_range)
    done = 0

    def report(text: str) -> None:
        nonlocal done
        done += 1
        progress(text, done, STEPS + 1)

    progress("finding edges", 0, STEPS + 1)
    candidates = detect(views_of(station), limits, settings, report)
    pipes = tuple(as_component(candidate, None, station.name, number) for number, candidate in enumerate(candidates))
    progress("done", STEPS + 1, STEPS + 1)
    return Reconstruction(Pipeline.of_station(station.name, pipes), (), ())


def pipe_from_pick(views: tuple[View, ...], pick: PipePick, station: Station, settings: PickSettings | None = None) -> Pipe | None:
    """Return the best pipe for a pick, None where no cylinder fits the images."""
    candidates = from_pick(views, pick, settings)
    return as_component(candidates[0], pick, station.name) if candidates else None


def as_component(candidate: PipeCandidate, pick: PipePick | None, station: str, number: int = 0) -> Pipe:
    """Return a candidate as a component of the pipeline; without a pick it is named after its ``number``."""
    solution, size = candidate.solution, candidate.size
    start, end = ((float(x), float(y), float(z)) for x, y, z in candidate.ends)
    sigma = solution.sigma_position
    return Pipe(
        id=f"{station}-P{pick.index:02d}" if pick else f"{station}-A{number:02d}",
        start=start,
        end=end,
        outer_diameter=size.outer_diameter if size else round(2 * solution.cylinder.radius, 3),
        wall_thickness=size.wall_thickness if size else None,
        dn=size.dn if size else None,
        standard=size.standard if size else None,
        verified=size.weakest_source if size else None,  # type: ignore[arg-type]  # the table holds 0, 1, 2
        pick=pick.index if pick else None,
        station=station,
        quality=round(candidate.quality, 4),
        sigma_position=(round(float(sigma[0]), 4), round(float(sigma[1]), 4), round(float(sigma[2]), 4)),
        sigma_direction_deg=round(float(np.degrees(solution.sigma_direction)), 5),
        sigma_outer_diameter=round(candidate.sigma_diameter, 4),
        loa=level_of_accuracy(float(np.linalg.norm(sigma))),
        approximate=candidate.approximate,
    )


def level_of_accuracy(sigma: float) -> str:
    """Return the USIBD level of accuracy of a position with this standard deviation in mm."""
    return next((name for limit, name in LEVELS_OF_ACCURACY if COVERAGE_FACTOR * sigma <= limit), "LOA10")
