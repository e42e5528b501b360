# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several viewpoints become one pipeline over the components they share (the paper's Sect. 8).

Pairs of stations are put together by search, by hand or by control points; a spanning tree of the overlaps gives the starting
values of one adjustment of all stations' poses; what was seen twice is fused. What cannot be put together stays separate and
says why. Everything is deterministic: all hypotheses are tried in order, none is drawn by lot.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipeline
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.fusion import Merged, merge
from pipeworkbench.recon.registration.landmarks import landmarks_of
from pipeworkbench.recon.registration.overlaps import Overlap, starting_poses
from pipeworkbench.recon.registration.pairwise import SAME, Answer, is_in_contradiction, overlap_of, same_photographs
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.results import CandidatePose, ControlPoints, PairResidual, Registration
from pipeworkbench.recon.registration.settings import RegistrationSettings
from pipeworkbench.recon.registration.solve import Solved, solve
from pipeworkbench.recon.registration.stations import PLANT, Stations, are_the_same_photographs, stations_of

__all__ = [
    "CandidatePose",
    "ControlPoints",
    "Merged",
    "PairResidual",
    "Pose",
    "Registration",
    "RegistrationSettings",
    "merge",
    "register",
]


def register(
    pipelines: Sequence[Pipeline],
    settings: RegistrationSettings | None = None,
    assignments: Iterable[tuple[str, str]] = (),
    control_points: ControlPoints | None = None,
    chosen: Iterable[CandidatePose] = (),
) -> Registration:
    """Put stations together over the components they share.

    Parameters
    ----------
    pipelines : sequence of Pipeline
        One per station, each in its level frame; the first is the reference.
    settings : RegistrationSettings, optional
    assignments : iterable of (str, str)
        Components of two stations that are the same, by id (``station:id`` where several use it); between these two stations nothing is searched.
    control_points : ControlPoints, optional
        Alone, where stations share three or more that are not in line, or together with components.
    chosen : iterable of CandidatePose
        Of the candidates that an earlier registration told for ambiguous stations, those that are right.

    Returns
    -------
    Registration
        The same input always gives the same result.

    Raises
    ------
    InputError
        Where there is no station, or an assignment, a control point or a candidate names what does not exist.
    """
    if not pipelines:
        raise InputError("stations", "", "there is none", "give one pipeline or more")
    settings = settings or RegistrationSettings()
    pipelines, repeated, sentences = _once_each(pipelines)
    stations = stations_of(pipelines, assignments, control_points, chosen)
    answers = {(a, b): overlap_of(stations, a, b, settings.search) for a, b in itertools.combinations(range(len(stations)), 2)}
    copies = {b for (_, b), answer in answers.items() if answer.rank == SAME and answer.overlap is None}
    overlaps = {key: answer.overlap for key, answer in answers.items() if answer.overlap is not None and not copies.intersection(key)}
    poses, used = starting_poses(len(stations), overlaps, 0)
    solved = solve(stations, poses, settings)
    loops = _loops(stations, overlaps, used, poses, settings)
    found = _result(stations, answers, solved, loops)
    return replace(found, separate=(*found.separate, *repeated), problems=(*found.problems, *sentences))


def _once_each(pipelines: Sequence[Pipeline]) -> tuple[tuple[Pipeline, ...], tuple[Pipeline, ...], tuple[str, ...]]:
    """Return the pipelines with a name of their own, those whose name an earlier one has, and a sentence about each of these."""
    first: dict[str, Pipeline] = {}
    repeated, sentences = [], []
    for pipeline in pipelines:
        name = pipeline.frame
        if name not in first:
            first[name] = pipeline
            continue
        repeated.append(pipeline)
        same = are_the_same_photographs(landmarks_of(first[name]), landmarks_of(pipeline))
        sentences.append(same_photographs(name, name) if same else f"two stations are called '{name}'; give each a name of its own")
    return tuple(first.values()), tuple(repeated), tuple(sentences)


def _loops(
    stations: Stations,
    overlaps: Mapping[tuple[int, int], Overlap],
    used: Sequence[tuple[int, int]],
    poses: Mapping[int, Pose],
    settings: RegistrationSettings,
) -> tuple[str, ...]:
    """Return a sentence for every two stations that lie otherwise to each other than over the stations between them."""
    found = []
    for (a, b), overlap in overlaps.items():
        if (a, b) in used or a not in poses or b not in poses:
            continue
        over_others = poses[a].inverse @ poses[b]
        if is_in_contradiction(overlap, over_others, stations.landmarks[b], settings.search):
            found.append(
                f"{stations.names[b]} lies otherwise to {stations.names[a]} than over the other stations, which have more in common"
                " and were followed; check the components of both or assign some by hand"
            )
    return tuple(found)


def _result(stations: Stations, answers: Mapping[tuple[int, int], Answer], solved: Solved, loops: tuple[str, ...]) -> Registration:
    """Return the merged pipeline with all that is to be known of it."""
    rows = [row for row in solved.rows if stations.names[row] != PLANT]
    places = {row: number for number, row in enumerate(solved.rows)}
    merged = merge([stations.pipelines[row] for row in rows], [solved.solution.poses[places[row]] for row in rows])
    covariances = {stations.names[row]: solved.solution.covariance[places[row]] for row in rows}
    reasons, candidates = _reasons(stations, answers, solved)
    plant = next((solved.solution.poses[number].inverse for row, number in places.items() if stations.names[row] == PLANT), None)
    return Registration(
        pipeline=_with_sigmas(merged.pipeline, covariances),
        separate=tuple(stations.pipelines[row] for row in range(len(stations)) if row not in rows and stations.names[row] != PLANT),
        pairs=solved.pairs,
        candidates=candidates,
        problems=(*reasons, *loops, *solved.remarks),
        sources=merged.sources,
        covariances=covariances,
        plant_from_frame=plant.matrix() if plant is not None else None,
        sigma0=solved.solution.sigma0,
    )


def _reasons(stations: Stations, answers: Mapping[tuple[int, int], Answer], solved: Solved) -> tuple[tuple[str, ...], tuple[CandidatePose, ...]]:
    """Return one sentence for each station that stays separate, the most telling, and where it could stand."""
    sentences: list[str] = []
    candidates: list[CandidatePose] = []
    for row in range(len(stations)):
        if row in solved.rows:
            continue
        if row in solved.lost:
            sentences.append(solved.lost[row])
            continue
        open_pairs = [answer for (a, b), answer in answers.items() if row in {a, b} and (solved.rows == (0,) or {a, b} & set(solved.rows))]
        failed = [answer for answer in open_pairs if answer.overlap is None]
        best = min(failed, key=lambda answer: answer.rank)
        if best.reason not in sentences:
            sentences.append(best.reason)
        candidates += best.candidates
    return tuple(sentences), tuple(candidates)


def _with_sigmas(pipeline: Pipeline, covariances: Mapping[str, Array]) -> Pipeline:
    """Return a pipeline whose stations say how well their poses are known."""
    stations = dict(pipeline.stations)
    for name, covariance in covariances.items():
        if name in stations:
            sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0))
            degrees = [round(float(value), 5) for value in np.degrees(sigma[:3])]
            extra = {
                "sigma_position": [round(float(value), 4) for value in sigma[3:]],
                "sigma_heading_deg": degrees[2],
                "sigma_tilt_deg": degrees[:2],
            }
            stations[name] = replace(stations[name], extra=stations[name].extra | extra)
    return replace(pipeline, stations=stations)
