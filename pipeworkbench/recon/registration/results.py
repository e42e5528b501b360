# SPDX-License-Identifier: LGPL-2.1-or-later
"""What comes out of a registration: the pipeline of all stations that could be put together, and what is to be known of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from pipeworkbench.pipeline import Matrix, Pipeline, Vector
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.registration.poses import Pose


@dataclass(frozen=True)
class ControlPoints:
    """Points that were measured in stations.

    ``observed`` holds for each station, by name, the coordinates of points in its level frame, ``known`` those in the plant's system, mm;
    ``sigma`` is the standard deviation of a coordinate in mm, None where it is not known.
    """

    observed: Mapping[str, Mapping[str, Vector]]
    known: Mapping[str, Vector] = field(default_factory=dict)
    sigma: float | None = None


@dataclass(frozen=True)
class PairResidual:
    """How far two corresponding components, or the images of a control point, are apart after the adjustment.

    ``distances`` in mm, across the axis at both ends of what the stations have in common of a pipe, or one of two anchors;
    ``normalised`` is their size in standard deviations; ``weight`` the robust one, 0 for corners that follow from their pipes.
    """

    station_a: str
    id_a: str
    station_b: str
    id_b: str
    kind: str
    distances: tuple[float, ...]
    normalised: float
    weight: float
    outlier: bool


@dataclass(frozen=True)
class CandidatePose:
    """One of several places where a station could stand: ``a_from_b`` (4 x 4), the score and how many pairs it explains."""

    station_a: str
    station_b: str
    a_from_b: Matrix
    score: float
    explained: int


@dataclass(frozen=True, eq=False)
class Registration:
    """Stations put together.

    Attributes
    ----------
    pipeline : Pipeline
        The merged one, in the frame of the reference station; its stations hold their poses and, as extra keys, ``sigma_position`` (3, mm,
        of the station's origin), ``sigma_heading_deg`` and ``sigma_tilt_deg`` (2).
    separate : tuple of Pipeline
        The stations that could not be merged, as they came.
    pairs : tuple of PairResidual
        The residual table.
    candidates : tuple of CandidatePose
        Where ambiguous stations could stand, best first.
    problems : tuple of str
        A sentence each, with what would help.
    sources : mapping
        For each component of the pipeline, by id, the ids it was made of per station.
    covariances : mapping
        For each merged station the covariance (6, 6) of its pose: small rotation about the frame's axes (rad), translation (mm).
    plant_from_frame : 4 x 4 matrix or None
        Where control points with known coordinates put the pipeline's frame.
    sigma0 : float
        Of unit weight, after the adjustment.
    """

    pipeline: Pipeline
    separate: tuple[Pipeline, ...] = ()
    pairs: tuple[PairResidual, ...] = ()
    candidates: tuple[CandidatePose, ...] = ()
    problems: tuple[str, ...] = ()
    sources: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    covariances: Mapping[str, Array] = field(default_factory=dict)
    plant_from_frame: Matrix | None = None
    sigma0: float = 1.0

    @property
    def poses(self) -> dict[str, Pose]:
        """From each merged station's level frame to the pipeline's: where a joint adjustment of images starts."""
        return {name: Pose.from_matrix(station.frame_from_level) for name, station in self.pipeline.stations.items()}
