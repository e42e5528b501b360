# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station becomes a pipeline: the main job, from images and picks, or images alone, to components."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np

from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.accuracy import level_of_accuracy
from pipeworkbench.recon.adjust import AdjustmentSettings, Problem, Solution, StationViews, adjust
from pipeworkbench.recon.adjustment.changes import with_solution
from pipeworkbench.recon.assemble import AssembleSettings, Completed, complete
from pipeworkbench.recon.candidates import PipeCandidate
from pipeworkbench.recon.flanges import detect as detect_flanges
from pipeworkbench.recon.flanges import of_picks as flanges_of_picks
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import FailedPick, Picks, PipePick
from pipeworkbench.recon.pipes import PickAnswer, answer_pick
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.threads import thread_count
from pipeworkbench.recon.vectors import as_vector, rounded
from pipeworkbench.recon.views import View, views_of

ADJUSTED = AdjustmentSettings()
WORKERS = 2  # picks at a time; more wait for each other's interpreter lock


@dataclass(frozen=True)
class Reconstruction:
    """What came out of a station.

    ``failed_picks`` gave nothing, each with its reason; ``alternatives`` holds for each pick's index what it could mean
    too, best first; ``warnings`` say what does not fit in the pipeline, in sentences; ``adjustment`` is the common adjustment's solution,
    None where there was none; ``views`` are the station's, for what comes after.
    """

    pipeline: Pipeline
    failed_picks: tuple[FailedPick, ...]
    alternatives: dict[int, tuple[Alternative, ...]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    adjustment: Solution | None = None
    views: tuple[View, ...] = field(default=(), repr=False)


@dataclass(frozen=True, eq=False)
class Alternative:
    """One of the ranked answers of a pick: ``score`` is the logarithm of how much likelier it is than clutter."""

    pipe: Pipe
    score: float
    chosen: bool


def reconstruct(
    station: Station,
    picks: Picks,
    settings: PickSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
    alternatives: int = 1,
    *,
    adjustment: AdjustmentSettings | None = ADJUSTED,
    assembly: AssembleSettings | None = None,
) -> Reconstruction:
    """Reconstruct the pipes and flanges that were picked in a station.

    Parameters
    ----------
    station : Station
    picks : Picks
    settings : PickSettings, optional
    alternatives : int
        How many ranked answers are wanted for each pick at most.
    progress : callable
        Called with what is being done, how many steps are done and how many there are.
    adjustment : AdjustmentSettings, optional
        Of the common adjustment; None leaves every component as it was found.
    assembly : AssembleSettings, optional
        Of what is found between the components, and of their joints.

    Raises
    ------
    InputError
        Where an image does not fit the station.
    """
    steps = len(picks.pipes) + 3
    progress("finding edges", 0, steps)
    views = views_of(station)
    pipes: list[Pipe] = []
    failed = list(picks.refused)
    ranked: dict[int, tuple[Alternative, ...]] = {}
    # threads: the array operations release the interpreter lock, and nothing needs to be copied
    with ThreadPoolExecutor(thread_count(WORKERS)) as pool:
        running = [pool.submit(answer_pick, views, pick, settings, alternatives) for pick in picks.pipes]
        try:
            for done, (pick, future) in enumerate(zip(picks.pipes, running, strict=True), 1):
                progress(f"pick {pick.index}", done, steps)
                answer = future.result()
                if answer.chosen is None:
                    failed.append(FailedPick(pick.index, answer.reason))
                else:
                    pipes.append(as_component(answer.chosen, pick, station.name))
                if alternatives > 1:
                    ranked[pick.index] = _alternatives(answer, pick, station.name, alternatives)
        except BaseException:
            # the user cancelled or a step failed: do not wait for picks that nobody wants
            pool.shutdown(wait=True, cancel_futures=True)
            raise
    progress("flanges and elbows", steps - 2, steps)
    flanges = flanges_of_picks(views, picks.flanges, pipes, station.name)
    failed += [FailedPick(*failure) for failure in flanges.failures]
    found = complete(views, (*pipes, *flanges.flanges), assembly, station.name)
    progress("adjusting", steps - 1, steps)
    pipeline, warnings, solution = _adjusted(views, found, station, adjustment)
    progress("done", steps, steps)
    return Reconstruction(pipeline, tuple(sorted(failed)), ranked, warnings, solution, views)


def _alternatives(answer: PickAnswer, pick: PipePick, station: str, most: int) -> tuple[Alternative, ...]:
    return tuple(
        Alternative(as_component(candidate, pick, station), round(candidate.score, 2), candidate is answer.chosen)
        for candidate in answer.ranked[:most]
    )


def reconstruct_without_picks(
    station: Station,
    settings: PickSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
    *,
    flanges: bool = False,
    adjustment: AdjustmentSettings | None = ADJUSTED,
    assembly: AssembleSettings | None = None,
) -> Reconstruction:
    """Reconstruct the pipes of a station without picks, and what joins them.

    Parameters
    ----------
    station : Station
    settings : PickSettings, optional
        Its working range and diameters limit what is looked for.
    progress : callable
        Called with what is being done, how many steps are done and how many there are.
    flanges : bool
        Look for flanges along the pipes, too; that takes seconds.
    adjustment : AdjustmentSettings, optional
        Of the common adjustment; None leaves every component as it was found.
    assembly : AssembleSettings, optional
        Of what is found between the components, and of their joints.

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
        progress(text, done, STEPS + 3)

    progress("finding edges", 0, STEPS + 3)
    views = views_of(station)
    candidates = detect(views, limits, settings, report)
    pipes = tuple(as_component(candidate, None, station.name, number) for number, candidate in enumerate(candidates))
    progress("flanges and elbows", STEPS + 1, STEPS + 3)
    also = detect_flanges(views, pipes, station.name) if flanges else ()
    found = complete(views, (*pipes, *also), assembly, station.name)
    progress("adjusting", STEPS + 2, STEPS + 3)
    pipeline, warnings, solution = _adjusted(views, found, station, adjustment)
    progress("done", STEPS + 3, STEPS + 3)
    return Reconstruction(pipeline, (), {}, warnings, solution, views)


def _adjusted(
    views: Sequence[View], found: Completed, station: Station, settings: AdjustmentSettings | None
) -> tuple[Pipeline, tuple[str, ...], Solution | None]:
    """Return the pipeline after the common adjustment, what does not fit, and the adjustment's solution."""
    pipeline = replace(Pipeline.of_station(station.name, found.components), joints=found.joints)
    if settings is None or not found.components:
        return pipeline, found.warnings, None
    placed = frozenset(component.id for component in found.components if isinstance(component, Pipe))
    solution = adjust(Problem(found.components, (StationViews(station.name, views),), found.joints, placed=placed), settings)
    weak = (f"{one.component}: {one.reason}" for one in solution.weak)
    return with_solution(pipeline, solution), (*found.warnings, *solution.warnings, *weak), solution


def as_component(candidate: PipeCandidate, pick: PipePick | None, station: str, number: int = 0) -> Pipe:
    """Return a candidate as a component of the pipeline; without a pick it is named after its ``number``."""
    solution, size = candidate.solution, candidate.size
    start, end = (as_vector(point) for point in candidate.ends)
    sigma = solution.sigma_position
    gaps = tuple((round(float(first), 1), round(float(last), 1)) for first, last in candidate.gaps - candidate.extent[0])
    nearest = candidate.nearest_standard
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
        sigma_position=rounded(sigma, 4),
        sigma_direction_deg=round(float(np.degrees(solution.sigma_direction)), 5),
        sigma_outer_diameter=round(candidate.sigma_diameter, 4),
        loa=level_of_accuracy(float(np.linalg.norm(sigma))),
        approximate=candidate.approximate,
        gaps=gaps or None,
        nearest_standard=nearest.designation if nearest else None,
    )
