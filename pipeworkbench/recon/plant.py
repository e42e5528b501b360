# SPDX-License-Identifier: LGPL-2.1-or-later
"""Into the plant's coordinates: by a typed placement, onto control points, or onto the components of a model as designed.

The georeference stays with the pipeline, so that exports can tell where it came from.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Matrix, Pipe, Pipeline, Vector, moved
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.landmarks import Landmarks, landmarks_of
from pipeworkbench.recon.registration.network import adjust_network
from pipeworkbench.recon.registration.observations import distances, observations_of, observations_of_points
from pipeworkbench.recon.registration.pairwise import overlap_of
from pipeworkbench.recon.registration.poses import Pose
from pipeworkbench.recon.registration.pretransformation import from_points
from pipeworkbench.recon.registration.results import CandidatePose
from pipeworkbench.recon.registration.settings import NetworkSettings, RegistrationSettings, SearchSettings
from pipeworkbench.recon.registration.solve import solve
from pipeworkbench.recon.registration.stations import stations_of
from pipeworkbench.recon.registration.verification import explained_pairs
from pipeworkbench.recon.vectors import as_vector

RIGID = 1e-6  # by which the rotation of a typed placement may differ from one: what rounded figures leave
BUILT_SIGMA_MM, BUILT_MOST_MM = 15.0, 100.0  # how far pipework is built off its design: usually, at most
BUILT_DIRECTION_DEG = 1.0


def _design_settings() -> RegistrationSettings:
    """Return settings that look for what was built where a model has it: the model is exact, the pipework is not."""
    search = SearchSettings(floor_mm=BUILT_SIGMA_MM, floor_deg=BUILT_DIRECTION_DEG, most_mm=BUILT_MOST_MM, ranges=(200.0, 150.0, 100.0, 100.0, 100.0))
    return RegistrationSettings(search=search)


@dataclass(frozen=True)
class PointPlacement:
    """Where control points put a frame: ``plant_from_frame`` (4 x 4), ``residuals`` mm (3) per point by name, sentences on what does not fit."""

    plant_from_frame: Matrix
    residuals: Mapping[str, Vector]
    problems: tuple[str, ...] = ()


@dataclass(frozen=True)
class Deviation:
    """One component as designed and as built; what has no counterpart has one id only.

    Designed and built outside diameters in mm; ``offset`` from the designed to the built component in the plant's axes, mm, of pipes
    across the axis in the middle of the course both have in common; ``distances`` at both ends of it (one for other components); ``angle_deg``
    between both directions.
    """

    designed_id: str | None
    built_id: str | None
    kind: str
    designed_diameter: float | None = None
    built_diameter: float | None = None
    offset: Vector | None = None
    distances: tuple[float, ...] = ()
    angle_deg: float | None = None


@dataclass(frozen=True)
class ModelPlacement:
    """Where a model puts a frame, None where it cannot be said, how what was built deviates from it, and what is to be known."""

    plant_from_frame: Matrix | None
    deviations: tuple[Deviation, ...] = ()
    candidates: tuple[CandidatePose, ...] = ()
    problems: tuple[str, ...] = field(default_factory=tuple)


def placed(pipeline: Pipeline, plant_from_frame: Sequence[Sequence[float]], system: str = "plant") -> Pipeline:
    """Return a pipeline in the plant's system.

    Parameters
    ----------
    pipeline : Pipeline
    plant_from_frame : 4 x 4
        A motion without a scale, mm.
    system : str
        The new frame's name.

    Raises
    ------
    InputError
        Where the matrix is no motion.
    """
    pose = Pose.from_matrix(_checked(plant_from_frame))
    matrix = pose.matrix()
    components = tuple(_turned(moved(component, matrix), pose) for component in pipeline.components)
    stations = {
        name: replace(station, frame_from_level=(pose @ Pose.from_matrix(station.frame_from_level)).matrix())
        for name, station in pipeline.stations.items()
    }
    before = pipeline.extra.get("georeference")
    from_first = Pose.from_matrix(before["plant_from_frame"]) if before else Pose.identity()
    georeference = {"system": system, "frame": before["frame"] if before else pipeline.frame, "plant_from_frame": (pose @ from_first).matrix()}
    return replace(pipeline, frame=system, components=components, stations=stations, extra=pipeline.extra | {"georeference": georeference})


def placement_on_points(points: Mapping[str, Vector], known: Mapping[str, Vector], settings: NetworkSettings | None = None) -> PointPlacement:
    """Return where control points put a frame.

    Parameters
    ----------
    points : mapping
        By name, in the frame, mm.
    known : mapping
        By name, in the plant's system, mm.
    settings : NetworkSettings, optional

    Raises
    ------
    InputError
        Where fewer than three points are common or all lie in line.
    """
    settings = settings or NetworkSettings()
    names = sorted(set(points) & set(known))
    here, there = (np.array([source[name] for name in names], float).reshape(-1, 3) for source in (points, known))
    start = from_points(here, there)
    if start is None:
        problem = f"{len(names)} known points are too few or lie in line"
        raise InputError("control points", ", ".join(names), problem, "measure three points or more that are not in line")
    covariance = np.broadcast_to(np.eye(3) * settings.control_sigma**2, (len(names), 3, 3))
    observed = observations_of_points(here, there, covariance, (0, 1))
    alone = replace(settings, tilt_deg=None)
    pose = adjust_network(observed, [Pose.identity(), start], 0, alone).poses[1]
    residuals = pose.points(here) - there
    bad = [
        name
        for name, size in zip(names, np.linalg.norm(residuals, axis=1), strict=True)
        if size > settings.outlier * np.sqrt(3) * settings.control_sigma
    ]
    problems = (f"the control points {', '.join(bad)} do not fit the others; check their names and coordinates",) if bad else ()
    return PointPlacement(pose.matrix(), {name: as_vector(residual) for name, residual in zip(names, residuals, strict=True)}, problems)


def placement_on_model(
    built: Pipeline, designed: Pipeline, assignments: Iterable[tuple[str, str]] = (), settings: RegistrationSettings | None = None
) -> ModelPlacement:
    """Return where the components of a model put a pipeline as built, and how each deviates.

    Parameters
    ----------
    built : Pipeline
    designed : Pipeline
        The model's components, in the plant's system.
    assignments : iterable of (designed id, built id)
        Given by hand; ids that both use are written ``frame:id``.
    settings : RegistrationSettings, optional
        By default what is built may be 100 mm off the design.
    """
    settings = settings or _design_settings()
    if designed.frame == built.frame:
        designed = replace(designed, frame=f"{designed.frame} as designed")
    stations = stations_of((designed, built), assignments)
    answer = overlap_of(stations, 0, 1, settings.search)
    if answer.overlap is None:
        return ModelPlacement(None, (), answer.candidates, (answer.reason,))
    solved = solve(stations, {0: Pose.identity(), 1: answer.overlap.pose}, settings)
    if 1 in solved.lost:
        return ModelPlacement(None, (), (), (solved.lost[1],))
    pose = solved.solution.poses[1]
    pairs = [(pair.id_a, pair.id_b, pair.kind, pair.distances) for pair in solved.pairs]
    one, other = stations.landmarks
    return ModelPlacement(pose.matrix(), _deviations((designed, built), (one, other), pairs, pose))


def deviations_in_place(built: Pipeline, designed: Pipeline, settings: RegistrationSettings | None = None) -> tuple[Deviation, ...]:
    """Return how each component deviates from a model that is in the same coordinates: nothing is moved.

    Parameters
    ----------
    built : Pipeline
    designed : Pipeline
        In the built one's frame.
    settings : RegistrationSettings, optional
        By default what is built may be 100 mm off the design.
    """
    search = (settings or _design_settings()).search
    marks = landmarks_of(designed), landmarks_of(built)
    if not len(marks[0]) or not len(marks[1]):
        return _deviations((designed, built), marks, (), Pose.identity())
    pairs = explained_pairs(*marks, Pose.identity(), search)
    observed = observations_of(*marks, pairs, Pose.identity(), (0, 1))
    no_turn, no_shift = np.array([[1.0, 0.0, 0.0, 0.0]] * 2), np.zeros((2, 3))
    apart = distances(observed, no_turn, no_shift)
    found = []
    for i, j, both in zip(pairs.first, pairs.second, apart.tolist(), strict=True):
        one, other = designed.components[i], built.components[j]
        lengths = tuple(round(value, 3) for value in (both if one.kind == Pipe.kind else both[:1]))
        found.append((one.id, other.id, one.kind, lengths))
    return _deviations((designed, built), marks, found, Pose.identity())


def _checked(matrix: Sequence[Sequence[float]]) -> Array:
    """Return a 4 x 4 motion as an array with an exact rotation."""
    array = np.asarray(matrix, float)
    remedy = "give a 4 x 4 matrix of a rotation and a translation in mm, without a scale"
    if array.shape != (4, 4) or not np.isfinite(array).all() or not np.allclose(array[3], [0, 0, 0, 1]):
        raise InputError("placement", "", "is not a 4 x 4 matrix with a last row of 0, 0, 0, 1", remedy)
    rotation = array[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=RIGID) or np.linalg.det(rotation) < 0:
        raise InputError("placement", "", "its upper left 3 x 3 part is no rotation", remedy)
    left, _, right = np.linalg.svd(rotation)
    exact = np.array(array)
    exact[:3, :3] = left @ right
    return exact


def _turned(component: AnyComponent, pose: Pose) -> AnyComponent:
    """Return a component whose standard deviations are along the new frame's axes."""
    return replace(component, sigma_position=pose.sigmas(component.sigma_position))


def _deviations(
    pipelines: tuple[Pipeline, Pipeline],
    landmarks: tuple[Landmarks, Landmarks],
    pairs: Sequence[tuple[str, str, str, tuple[float, ...]]],
    pose: Pose,
) -> tuple[Deviation, ...]:
    """Return the deviations of what corresponds, designed and built, then what has no counterpart.

    ``pairs`` are (designed id, built id, kind, distances); the pose puts what was built where the model is.
    """
    designed, built = (pipeline.components for pipeline in pipelines)
    marks, other = landmarks
    rows, other_rows = ({component.id: row for row, component in enumerate(components)} for components in (designed, built))
    found = []
    for designed_id, built_id, kind, lengths in pairs:
        i, j = rows[designed_id], other_rows[built_id]
        axis, direction = marks.axis[i], pose.rotation @ other.axis[j]
        offset = pose.points(other.point[j]) - marks.point[i]
        if marks.is_axis[i]:
            # from the designed axis to the built one's point beside the middle of what both have in common
            along = offset @ axis
            middle = (max(-marks.half[i], along - other.half[j]) + min(marks.half[i], along + other.half[j])) / 2
            cosine = direction @ axis
            offset = offset + (middle - along) / cosine * direction
            offset = offset - (offset @ axis) * axis
        angle = float(np.degrees(np.arctan2(np.linalg.norm(np.cross(axis, direction)), abs(axis @ direction))))
        diameters = designed[i].outer_diameter, built[j].outer_diameter
        found.append(Deviation(designed_id, built_id, kind, *diameters, as_vector(offset), lengths, round(angle, 4)))
    with_both = ({pair[0] for pair in pairs}, {pair[1] for pair in pairs})
    missing = [Deviation(c.id, None, c.kind, designed_diameter=c.outer_diameter) for c in designed if c.id not in with_both[0]]
    additional = [Deviation(None, c.id, c.kind, built_diameter=c.outer_diameter) for c in built if c.id not in with_both[1]]
    return tuple(itertools.chain(found, missing, additional))
