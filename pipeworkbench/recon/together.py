# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several stations become one pipeline (Sect. 8): each by itself, put together over what they share, adjusted over all images at once.

The paper ends with the transformation of finished components. Here the images of all stations have the last word: a pipe that is
seen from three viewpoints is one pipe, and the stations' poses are unknowns of the same adjustment.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipeline, StationPose
from pipeworkbench.recon.adjust import AdjustedStation, AdjustmentSettings, Problem, Solution, StationViews, adjust
from pipeworkbench.recon.adjustment.changes import with_solution
from pipeworkbench.recon.pick_settings import PickSettings
from pipeworkbench.recon.picks import Picks
from pipeworkbench.recon.reconstruct import ADJUSTED, Reconstruction, reconstruct, reconstruct_without_picks
from pipeworkbench.recon.register import Registration, RegistrationSettings, register
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.views import View

POSE_SIGMA_MM, POSE_SIGMA_RAD = 50.0, 0.01  # how well stations lie where the registration puts them, at worst


@dataclass(frozen=True, eq=False)
class Together:
    """Stations reconstructed together.

    Attributes
    ----------
    pipeline : Pipeline
        Of all stations that could be put together, in the frame of the first.
    stations : mapping
        Each station's own reconstruction, by name.
    registration : Registration
        Residuals of corresponding components, candidates where it is ambiguous, and problems.
    separate : tuple of Pipeline
        Stations that could not be put together, as they were reconstructed.
    adjustment : Solution or None
        Of all images at once; None where none was wanted or nothing was put together.
    warnings : tuple of str
        What does not fit, in sentences.
    """

    pipeline: Pipeline
    stations: Mapping[str, Reconstruction]
    registration: Registration
    separate: tuple[Pipeline, ...]
    adjustment: Solution | None
    warnings: tuple[str, ...]


def reconstruct_together(
    stations: Sequence[Station],
    picks: Sequence[Picks] | None = None,
    settings: PickSettings | None = None,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
    *,
    flanges: bool = False,
    adjustment: AdjustmentSettings | None = ADJUSTED,
    registration: RegistrationSettings | None = None,
) -> Together:
    """Reconstruct several stations and merge them.

    Parameters
    ----------
    stations : sequence of Station
        The first one's level frame becomes the frame of all.
    picks : sequence of Picks, optional
        One for each station; None finds the pipes without picks.
    settings : PickSettings, optional
    progress : callable
        Called with what is being done, how many steps are done and how many there are.
    flanges : bool
        Without picks: look for flanges along the pipes, too.
    adjustment : AdjustmentSettings, optional
        Of each station's and of the last adjustment; None leaves everything as it was found and put together.
    registration : RegistrationSettings, optional

    Raises
    ------
    InputError
        Where an image does not fit its station, or two stations have one name.
    """
    names = [station.name for station in stations]
    for number, station in enumerate(stations):
        if station.name in names[:number]:
            raise InputError(station.source, "name", f"another station is called '{station.name}', too", "give each station its own name")
    done: dict[str, Reconstruction] = {}
    steps = len(stations) + 2
    for number, station in enumerate(stations):
        progress(f"station {station.name}", number, steps)
        if picks is None:
            done[station.name] = reconstruct_without_picks(station, settings, flanges=flanges, adjustment=adjustment)
        else:
            done[station.name] = reconstruct(station, picks[number], settings, adjustment=adjustment)
    progress("putting stations together", steps - 2, steps)
    found = register([one.pipeline for one in done.values()], registration)
    warnings = [f"{name}: {text}" for name, one in done.items() for text in one.warnings]
    pipeline, solution = found.pipeline, None
    if adjustment is not None and len(pipeline.stations) > 1:
        progress("adjusting all stations", steps - 1, steps)
        views = {name: one.views for name, one in done.items()}
        pipeline, solution = adjusted_together(pipeline, views, adjustment)
        warnings += [*solution.warnings, *(f"{one.component}: {one.reason}" for one in solution.weak)]
    progress("done", steps, steps)
    return Together(pipeline, done, found, found.separate, solution, (*found.problems, *warnings))


def adjusted_together(
    pipeline: Pipeline,
    views: Mapping[str, Sequence[View]],
    settings: AdjustmentSettings = ADJUSTED,
    progress: Callable[[str, int, int], None] = lambda text, done, total: None,  # noqa: ARG005
) -> tuple[Pipeline, Solution]:
    """Adjust a merged pipeline and the poses of its stations to the images of all of them.

    Parameters
    ----------
    pipeline : Pipeline
        Its frame is one station's, which stays.
    views : mapping
        The views of each of its stations, by name, in the station's own level frame.
    settings : AdjustmentSettings, optional
    progress : callable
        Called with what is being done, how many iterations are done and how many there may be.

    Returns
    -------
    Pipeline
        Its stations hold their poses and, as extra keys, ``sigma_position`` (mm, of the middle of its cameras), ``sigma_heading_deg`` and
        ``sigma_tilt_deg`` (2), about the frame's axes.
    Solution
    """
    stations = tuple(
        StationViews(
            name,
            views[name],
            np.array(pose.frame_from_level),
            free=name != pipeline.frame,
            sigma_position=POSE_SIGMA_MM,
            sigma_rotation=POSE_SIGMA_RAD,
        )
        for name, pose in pipeline.stations.items()
    )
    solution = adjust(Problem(pipeline.components, stations, pipeline.joints), settings, progress)
    poses = {name: _with_pose(pose, solution.stations[name]) for name, pose in pipeline.stations.items()}
    return replace(with_solution(pipeline, solution), stations=poses), solution


def _with_pose(pose: StationPose, adjusted: AdjustedStation) -> StationPose:
    """Return a station's pose with what was adjusted and its standard deviations."""
    matrix = Pose.from_matrix(adjusted.frame_from_level).matrix()
    sigma = np.sqrt(np.maximum(np.diag(adjusted.covariance), 0.0))
    extra = {
        "sigma_position": [round(float(value), 4) for value in sigma[:3]],
        "sigma_heading_deg": round(float(np.degrees(sigma[5])), 5),
        "sigma_tilt_deg": [round(float(np.degrees(value)), 5) for value in sigma[3:5]],
    }
    return replace(pose, frame_from_level=matrix, extra=pose.extra | extra)
