# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stations of a registration as the adjustment sees them, the control points' system among them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import Pipeline, Vector
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.hypotheses import Pairs
from pipeworkbench.recon.registration.landmarks import Landmarks, landmarks_of
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.results import CandidatePose, ControlPoints

PLANT = "control points"  # the name of the system of known coordinates
IDENTICAL_MM = 0.2  # two photographs from two tripods never give components as near as this in their own frames
IDENTICAL_SHARE = 0.8


@dataclass(frozen=True, eq=False)
class Stations:
    """Stations, s in number, in rows; the last one is the plant's system where control points have known coordinates.

    names; pipelines; landmarks; points: the control points of each by name, mm; assigned: the pairs of landmarks given by hand
    for (a, b), a < b; chosen: the poses of b in a that were chosen from candidates; sigma of a control point's coordinate, mm,
    None where it is not known.
    """

    names: tuple[str, ...]
    pipelines: tuple[Pipeline, ...]
    landmarks: tuple[Landmarks, ...]
    points: tuple[Mapping[str, Vector], ...]
    assigned: Mapping[tuple[int, int], Pairs]
    chosen: Mapping[tuple[int, int], Pose]
    sigma: float | None = None

    def __len__(self) -> int:
        return len(self.names)

    @property
    def level(self) -> NDArray[np.bool_]:
        """Which (s,) have an inclination sensor."""
        return np.array([name != PLANT for name in self.names])

    def middle(self, row: int) -> Array:
        """Return the mean (3,) of a station's components and control points, mm."""
        points = [*self.landmarks[row].point, *(np.array(point) for point in self.points[row].values())]
        return np.mean(points, axis=0) if points else np.zeros(3)

    def common_points(self, a: int, b: int) -> tuple[str, ...]:
        """Return the names of the control points that two stations share."""
        return tuple(sorted(set(self.points[a]) & set(self.points[b])))

    def point_arrays(self, a: int, b: int) -> tuple[Array, Array]:
        """Return the common control points (m, 3) in b and in a, mm."""
        names = self.common_points(a, b)
        return tuple(np.array([self.points[row][name] for name in names], float).reshape(-1, 3) for row in (b, a))  # type: ignore[return-value]


def stations_of(
    pipelines: Sequence[Pipeline],
    assignments: Iterable[tuple[str, str]] = (),
    control_points: ControlPoints | None = None,
    chosen: Iterable[CandidatePose] = (),
) -> Stations:
    """Return pipelines, each with a name of its own, as stations.

    Raises
    ------
    InputError
        Where an assignment, a control point or a candidate names what does not exist.
    """
    names = tuple(pipeline.frame for pipeline in pipelines)
    observed = control_points.observed if control_points is not None else {}
    unknown = next((name for name in observed if name not in names), None)
    if unknown is not None:
        raise InputError("control points", unknown, "there is no such station", f"use one of {', '.join(names)}")
    landmarks = tuple(landmarks_of(pipeline) for pipeline in pipelines)
    points = tuple(observed.get(name, {}) for name in names)
    given = _assigned(pipelines, assignments), _chosen(names, chosen)
    if control_points is not None and control_points.known:
        plant = Pipeline(frame=PLANT)
        everything = (*names, PLANT), (*pipelines, plant), (*landmarks, landmarks_of(plant)), (*points, control_points.known)
        return Stations(*everything, *given, control_points.sigma)
    return Stations(names, tuple(pipelines), landmarks, points, *given, control_points.sigma if control_points is not None else None)


def _chosen(names: Sequence[str], chosen: Iterable[CandidatePose]) -> dict[tuple[int, int], Pose]:
    """Return the poses of chosen candidates by the rows of their stations."""
    found = {}
    for candidate in chosen:
        unknown = next((name for name in (candidate.station_a, candidate.station_b) if name not in names), None)
        if unknown is not None:
            raise InputError("candidate", unknown, "there is no such station", f"use one of {', '.join(names)}")
        a, b = names.index(candidate.station_a), names.index(candidate.station_b)
        pose = Pose.from_matrix(candidate.a_from_b)
        found[min(a, b), max(a, b)] = pose if a < b else pose.inverse
    return found


def _assigned(pipelines: Sequence[Pipeline], assignments: Iterable[tuple[str, str]]) -> dict[tuple[int, int], Pairs]:
    """Return the pairs given by hand; an id that several stations use is written ``station:id``."""
    homes: dict[str, list[tuple[int, int]]] = {}
    for number, pipeline in enumerate(pipelines):
        for row, component in enumerate(pipeline.components):
            for name in (component.id, f"{pipeline.frame}:{component.id}"):
                homes.setdefault(name, []).append((number, row))
    found: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for pair in assignments:
        places = []
        for name in pair:
            if len(homes.get(name, ())) != 1:
                problem = "no station has it" if name not in homes else "several stations have it"
                raise InputError("assignment", name, problem, "name a component by its id, or as station:id")
            places.append(homes[name][0])
        (a, first), (b, second) = sorted(places)
        if a == b:
            raise InputError("assignment", f"{pair[0]}, {pair[1]}", "both are of one station", "assign components of two stations")
        kinds = [pipelines[a].components[first].kind, pipelines[b].components[second].kind]
        if kinds[0] != kinds[1]:
            raise InputError("assignment", f"{pair[0]}, {pair[1]}", f"one is of kind {kinds[0]}, one {kinds[1]}", "assign components of one kind")
        found.setdefault((a, b), []).append((first, second))
    columns = {key: np.array(sorted(set(rows)), np.intp).T for key, rows in found.items()}
    return {key: Pairs(first, second, np.ones(len(first))) for key, (first, second) in columns.items()}


def are_the_same_photographs(one: Landmarks, other: Landmarks) -> bool:
    """Tell whether two stations have nearly all components at the same places of their own frames."""
    if not len(one) or not len(other):
        return False
    distance = cdist(one.point, other.point)
    distance[one.kind[:, None] != other.kind] = np.inf
    smaller = distance.min(1) if len(one) <= len(other) else distance.min(0)
    return bool((smaller <= IDENTICAL_MM).mean() >= IDENTICAL_SHARE)
