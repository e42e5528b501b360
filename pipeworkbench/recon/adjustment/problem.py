# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is to be adjusted: components, joints, the images of one station or several, and what is held."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Joint
from pipeworkbench.recon.adjustment.charts import DIRECTION, POSITION
from pipeworkbench.recon.bodies import SIZE_NAMES
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.views import View

SOURCE = "the adjustment"
# what may be nothing, and what must be one at least
MAY_BE_ZERO = frozenset(
    {
        "aligned",
        "common_share",
        "common_sigma",
        "gasket",
        "settling",
        "slide",
        "trend_share",
        "trend_sigma",
        "variance_rounds",
        "weak_angle_deg",
        "weak_sigma",
    }
)
AT_LEAST_ONE = frozenset({"most_samples", "iterations"})


@dataclass(frozen=True)
class AdjustmentSettings:
    """Tunables of the common adjustment.

    Attributes
    ----------
    spacing, most_samples
        Distance of samples along a contour in px, and their largest number along one.
    ranges
        The search ranges b in px, iteration by iteration; the last one stays.
    slide
        mm along their axes in which flanges are looked for before; 0 where they are nearly where they belong.
    settling
        How often edges are matched anew within the last range before they stay.
    tukey
        Factor of Tukey's biweight in robust standard deviations of a contour's distances.
    common_sigma, common_share
        What all samples of a contour in an image have in common (calibration, shading of the limb): its standard deviation is that many
        px together with so large a share of the contour's scatter. Measured at the true contours of rendered scenes: bench/adjust.py.
    trend_sigma, trend_share
        The same for the change of this error from the middle of a contour to its ends.
    systematic_weight
        How many contours the expected variances of both count for when a factor is estimated for them.
    common_freedom
        Degrees of freedom of Student's t for these: a contour drawn to somebody else's edge counts less.
    sizes
        "exact": standard sizes stay as they are; "tolerance": they are pseudo-observations with the tolerances of their
        standards; "free": nothing is known of them. Sizes that are no standard's are free in any case.
    diameter_tolerance
        Part of the outside diameter, and mm at least: EN 10216, D2 / T2 (+-1 %, 0.5 mm).
    bend_tolerance, plate_tolerance
        Part of the bend radius; mm of a flange's diameter and thickness (EN 1092-1, Table 11, rounded).
    angle_sigma_deg
        Standard deviation of a standard bend's angle (90, 45 degrees): the ends' tolerance of EN 10253-2 is about twice that.
    offset_sigma, turn_sigma
        Standard deviations of the conditions at a joint, mm and rad: so little that they hold exactly; more makes them soft.
    gasket, gasket_sigma
        Thickness of the gasket between two flanges' faces, mm (EN 1514-1: 1.5 to 3).
    aligned
        Weak pseudo-observations: runs within ``aligned_within_deg`` of level or plumb are, bends so near to 90 degrees
        are right angles, with ``aligned_sigma_deg``.
    variance_rounds
        How often variances are estimated and everything is adjusted again.
    snooping
        Limit of Baarda's w beyond which a contour or pseudo-observation is a gross error; 3.29 is the error probability 0.1 %.
    undetermined
        mm; a component whose standard deviation is larger is not determined and stays as it was.
    weak_sigma
        mm; what is surer than that in all directions is not weakly placed.
    weak_angle_deg, weak_ratio
        An axis is weakly placed where the planes of sight through it meet at less than this angle, or where one direction is so
        many times less sure than the other.
    step
        mm; the iteration has converged when nothing moves by more.
    """

    spacing: float = 4.0
    most_samples: int = 150
    ranges: tuple[float, ...] = (3.0, 2.0)
    slide: float = 0.0
    settling: int = 2
    tukey: float = 4.7
    common_sigma: float = 0.05
    common_share: float = 0.8
    trend_sigma: float = 0.02
    trend_share: float = 0.5
    systematic_weight: float = 6.0
    common_freedom: float = 4.0
    sizes: Literal["exact", "tolerance", "free"] = "exact"
    diameter_tolerance: tuple[float, float] = (0.01, 0.5)
    bend_tolerance: float = 0.01
    plate_tolerance: float = 2.0
    angle_sigma_deg: float = 0.5
    offset_sigma: float = 1e-3
    turn_sigma: float = 1e-5
    gasket: float = 2.0
    gasket_sigma: float = 0.5
    aligned: bool = False
    aligned_within_deg: float = 3.0
    aligned_sigma_deg: float = 0.3
    variance_rounds: int = 3
    snooping: float = 3.29
    undetermined: float = 50.0
    weak_sigma: float = 2.0
    weak_angle_deg: float = 1.5
    weak_ratio: float = 25.0
    step: float = 1e-3
    iterations: int = 40

    def __post_init__(self) -> None:
        if not self.ranges:
            raise InputError(SOURCE, "ranges", "there is no search range", "give at least one, in px")
        for name, value in vars(self).items():
            for number in value if isinstance(value, tuple) else (value,):
                least = 1 if name in AT_LEAST_ONE else 0
                if isinstance(number, int | float) and not (np.isfinite(number) and number >= least and (number > 0 or name in MAY_BE_ZERO)):
                    raise InputError(SOURCE, name, f"{number} is no use", f"give a finite number {'from 1' if least else 'that is positive'}")

    @classmethod
    def for_rough_values(cls, reach: float = 70.0, slide: float = 45.0) -> AdjustmentSettings:
        """Return settings for starting values that lie up to ``reach`` px off in the images, flanges up to ``slide`` mm along their axes."""
        return cls(ranges=(*(float(r) for r in np.geomspace(reach, 8.0, 7)), 6.0, 4.0, 3.0, 2.0), slide=slide, iterations=60)


@dataclass(frozen=True, eq=False)
class StationViews:
    """A station of the problem: its views, in its own level frame, and where that lies.

    ``sigma_position`` (mm) and ``sigma_rotation`` (rad) say how well ``frame_from_level`` (4, 4) is known before the
    adjustment, infinite ones that it is not; a station that is not ``free`` stays. ``free_cameras`` are the indices of
    cameras whose place in the rig is adjusted too, with these priors.
    """

    name: str
    views: Sequence[View]
    frame_from_level: Array = field(default_factory=lambda: np.eye(4))
    free: bool = False
    sigma_position: float = np.inf
    sigma_rotation: float = np.inf
    free_cameras: frozenset[int] = frozenset()
    camera_sigma_position: float = 0.1
    camera_sigma_rotation: float = 1e-4

    def __post_init__(self) -> None:
        sigmas = (self.sigma_position, self.sigma_rotation, self.camera_sigma_position, self.camera_sigma_rotation)
        if not all(sigma > 0 for sigma in sigmas):
            raise InputError(SOURCE, f"station {self.name}", "a standard deviation is not positive", "give how well the pose is known")
        for index in self.free_cameras:
            if not 0 <= index < len(self.views):
                raise InputError(SOURCE, f"station {self.name}", f"there is no camera {index}", f"it has {len(self.views)}")


@dataclass(frozen=True, eq=False)
class Problem:
    """Everything the adjustment looks at.

    ``held`` names for components, by id, what stays: "position", "direction" or sizes' names ("outer_diameter",
    "bend_radius", "angle_deg", "D", "C", "branch_diameter", "end_diameter"). Components that are ``fixed`` stay altogether.
    ``observed`` gives sizes a value and a standard deviation of their own: {id: {name: (value, sigma)}}. ``placed`` are ids of
    pipes whose given place is an observation, too, with the ``sigma_position`` and ``sigma_direction_deg`` that they have: recognition
    looked at their surface, where edges alone may not say where they are.
    """

    components: tuple[AnyComponent, ...]
    stations: tuple[StationViews, ...]
    joints: tuple[Joint, ...] = ()
    held: Mapping[str, frozenset[str]] = field(default_factory=dict)
    observed: Mapping[str, Mapping[str, tuple[float, float]]] = field(default_factory=dict)
    placed: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        by_id = {component.id: component for component in self.components}
        self._check_names_and_places(by_id)
        self._check_datum()
        for name, held in self.held.items():
            self._check(by_id, name, held, "held", {POSITION, DIRECTION})
        for name, observed in self.observed.items():
            self._check(by_id, name, observed, "observed", set())
            for size, (value, sigma) in observed.items():
                if not (np.isfinite(value) and value > 0 and np.isfinite(sigma) and sigma > 0):
                    raise InputError(SOURCE, f"observed.{name}.{size}", f"is {value} +- {sigma}", "give a positive value and sigma")
        ports = {component.id: len(component.ports) for component in self.components}
        for joint in self.joints:
            for name, port in ((joint.a, joint.a_port), (joint.b, joint.b_port)):
                if name not in ports or port >= ports[name]:
                    raise InputError(SOURCE, f"joint {joint.a} - {joint.b}", f"there is no port {port} of '{name}'", "join what is there")

    def _check_names_and_places(self, by_id: Mapping[str, AnyComponent]) -> None:
        if len(by_id) < len(self.components):
            raise InputError(SOURCE, "components", "two have the same id", "give each component its own id")
        if len({station.name for station in self.stations}) < len(self.stations):
            raise InputError(SOURCE, "stations", "two have the same name", "give each station its own name")
        for component in self.components:
            if not all(np.isfinite([*port.point, *port.direction, port.diameter]).all() for port in component.ports):
                raise InputError(SOURCE, component.id, "its ends are not all numbers", "leave it out or give it a place")

    def _check_datum(self) -> None:
        """Refuse stations all of which are anywhere, unless something in sight is fixed."""
        anywhere = [station.free and not np.isfinite([station.sigma_position, station.sigma_rotation]).all() for station in self.stations]
        if anywhere and all(anywhere) and not any(component.fixed for component in self.components):
            remedy = "at least one station must be held, or its pose known with a sigma"
            raise InputError(SOURCE, "stations", "all of them are free, and nothing says where they are", remedy)

    @staticmethod
    def _check(by_id: Mapping[str, AnyComponent], name: str, names: object, key: str, more: set[str]) -> None:
        if name not in by_id:
            raise InputError(SOURCE, f"{key}.{name}", "there is no such component", "name one of the components")
        known = {*SIZE_NAMES[type(by_id[name])], *more}
        for one in names:  # type: ignore[attr-defined]  # a set or a mapping
            if one not in known:
                raise InputError(SOURCE, f"{key}.{name}", f"'{one}' is nothing it has", f"use {', '.join(sorted(known))}")
