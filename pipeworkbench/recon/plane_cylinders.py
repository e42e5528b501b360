# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders from tangent planes: those of two or more images, or the two of one image and the diameter.

A plane with the unit normal n towards the axis, through the projection centre P, touches the cylinder
(a point X of its axis, unit direction d, radius r) where

    n . d = 0    and    n . (X - P) = r.

Hart, Knoblach, Moeser, "Automation Strategies for the Photogrammetric Reconstruction of Pipelines" (PFG,
2023), Sect. 4: four planes of two images, or three with an ambiguity, or two and the diameter.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.cylinder import Cylinder, perpendicular_axes
from pipeworkbench.recon.inversion import inverse_2x2
from pipeworkbench.recon.tangent_planes import ApparentPipe, StackedPlanes, TangentPlane, planes_of
from pipeworkbench.recon.vectors import across, unit

PARAMETERS = 5  # two shifts and two tilts across the axis, the radius
MOST_UNKNOWN_SIDES = 8  # each doubles the solutions to try
SINGULAR = 1e-9  # ratio of singular values below which an unknown is not determined at all
CONVERGED = 1e-10  # movement as part of the distance from the cameras: nanometres
ITERATIONS = 30


@dataclass(frozen=True)
class TangentSettings:
    """What counts as measured.

    ``least_angle_deg`` between the centre planes of the best two images (the rig's base of 650 mm at 10 m
    gives 3.7 deg); ``largest_relative_sigma`` the largest standard deviation of the axis' position as part of
    its distance; ``least_distance`` in mm of a pipe from a camera; ``largest_misfit`` the sum of squared
    standardised residuals that a solution may have more than the best where sides are unknown (five sigmas);
    ``nominal_distance`` in mm, the far end of the working range, at which a better pair is looked for.
    """

    least_angle_deg: float = 1.0
    largest_relative_sigma: float = 0.2
    least_distance: float = 100.0
    largest_misfit: float = 25.0
    nominal_distance: float = 10_000.0


class IntersectionError(InputError):
    """Base, axis and projection centre lie in one plane: the images do not determine the pipe's depth.

    ``angle`` is the largest angle in radians between two centre planes, NaN where it cannot be told; ``pair``
    the pair of the station's cameras that would do, None where there is none.
    """

    def __init__(self, problem: str, remedy: str, angle: float, pair: CameraPair | None) -> None:
        super().__init__("the pipe", "", problem, remedy)
        self.angle, self.pair = angle, pair


@dataclass(frozen=True, eq=False)
class CameraPair:
    """Two cameras, by their indices, and the angle in radians between their centre planes of an axis."""

    first: int
    second: int
    angle: float


@dataclass(frozen=True, eq=False)
class TangentSolution:
    """A cylinder that touches the planes, and how well it is known.

    Attributes
    ----------
    cylinder : Cylinder
        Its point is in the middle of what the edges cover of the axis.
    covariance : (5, 5) array
        Shifts (mm) and tilts (mm at ``half_length``) along ``axes``, radius (mm); from the planes' own
        covariances, not scaled by ``sigma0``.
    axes : (2, 3) array
        Unit vectors across the axis.
    half_length : float
        Half of what the edges cover of the axis, mm.
    sides : (k,) array
        1 where the pipe is on the side that the plane's normal points to, else -1; a side that is known is 1.
    residuals : (k, 2) array
        How far each edge is off the cylinder's at its first and its last point, px; positive away from the axis.
    sigma0 : float
        Standard deviation of unit weight: 1 is as expected; NaN without redundancy.
    redundancy : int
    intersection_angle : float
        The largest angle in radians between the centre planes of two images; 0 for a single image.
    """

    cylinder: Cylinder
    covariance: Array
    axes: Array
    half_length: float
    sides: Array
    residuals: Array
    sigma0: float
    redundancy: int
    intersection_angle: float

    @property
    def sigma_position(self) -> Array:
        """Standard deviations (3,) of the axis' middle along the frame's axes, mm."""
        return np.asarray(np.sqrt(np.einsum("ai,ab,bi->i", self.axes, self.covariance[:2, :2], self.axes)))

    @property
    def sigma_direction(self) -> float:
        """Standard deviation of the axis' direction in radians, the larger of both tilts."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[2:4, 2:4])[-1])) / self.half_length

    @property
    def sigma_radius(self) -> float:
        """Standard deviation of the radius in mm."""
        return float(np.sqrt(self.covariance[4, 4]))


def cylinder_from_centre_planes(pipes: Sequence[ApparentPipe], cameras: Sequence[Camera] = (), settings: TangentSettings | None = None) -> Cylinder:
    """Intersect the centre planes of two or more images, in closed form (the paper's Sect. 4).

    The direction d minimises the sum of (n_e . d)^2, the axis that of (n_e . (X - P))^2; the radius is the mean
    of the tangent distances n . (X - P). Every image counts the same: :func:`cylinder_from_images` weighs
    them with their uncertainties.

    Raises
    ------
    InputError
        As :func:`cylinder_from_images`.
    """
    settings = settings or TangentSettings()
    planes = planes_of(pipes)
    _refuse_too_few(planes)
    normals = np.array([pipe.centre_normal for pipe in pipes])
    centres = np.array([pipe.camera.projection_centre for pipe in pipes])
    sines = np.linalg.norm(np.cross(normals[:, None], normals[None]), axis=2)
    angle = float(np.arcsin(min(sines.max(), 1.0)))
    if angle < np.radians(settings.least_angle_deg):
        raise _intersection_error(planes, cameras, angle, settings)
    direction = np.linalg.svd(normals)[2][2]
    direction = direction if direction @ planes[0].axes[1] > 0 else -direction
    axes = np.array(perpendicular_axes(direction))
    origin = centres.mean(axis=0)
    distances = np.einsum("ki,ki->k", normals, centres - origin)
    point = origin + np.linalg.lstsq(normals @ axes.T, distances, rcond=None)[0] @ axes
    stacked = StackedPlanes.of(planes)
    radius = float(np.mean(np.einsum("ki,ki->k", stacked.normals, point - stacked.centres)))
    estimate = _Estimate(Cylinder(point, direction, radius), stacked)
    problem = estimate.problem(settings)
    if problem:
        raise _impossible(planes, problem)
    return estimate.in_the_middle()[0]


def cylinder_from_images(
    planes: Sequence[TangentPlane | ApparentPipe], cameras: Sequence[Camera] = (), settings: TangentSettings | None = None
) -> TangentSolution:
    """Return the one cylinder that touches tangent planes of two or more images, in least squares.

    Parameters
    ----------
    planes : sequence of TangentPlane or ApparentPipe
        Three planes or more, one or two for each image.
    cameras : sequence of Camera, optional
        All of the station's, to name one that helps where those of the planes do not.
    settings : TangentSettings, optional

    Raises
    ------
    IntersectionError
        Where the pipe lies in one plane with the cameras, so that its depth cannot be measured.
    InputError
        Where there are fewer than three planes or two cameras, where no cylinder in front of the cameras
        touches the planes, or where several do because sides are unknown.
    """
    found = cylinders_from_images(planes, cameras, settings)
    if len(found) > 1:
        unknown = names_of([plane.camera for plane in planes_of(planes) if not plane.side_known])
        raise InputError(
            "the pipe",
            "",
            f"{len(found)} cylinders fit, because it may lie on either side of its edge in {unknown}",
            "click beside the edge, on the pipe, or click its other edge as well",
        )
    return found[0]


def cylinders_from_images(
    planes: Sequence[TangentPlane | ApparentPipe], cameras: Sequence[Camera] = (), settings: TangentSettings | None = None
) -> tuple[TangentSolution, ...]:
    """Return all cylinders in front of the cameras that touch tangent planes, whatever sides are unknown.

    Three planes without sides are the sides of a triangle in the cross-section, with four touching circles
    (Dingle 1998 in the paper's Sect. 4); two edges in one image leave two of them. The starting values solve
    the linear equations of the tangent distances (the difference of both of an image is its centre
    plane, n_1 - n_2); Gauss-Newton then minimises the standardised corrections to the planes' normals.
    Parameters and errors are those of :func:`cylinder_from_images`.

    Returns
    -------
    tuple of TangentSolution
        Best fit first, nearest first among equals; ``sides`` tells them apart.
    """
    settings = settings or TangentSettings()
    given = planes_of(planes)
    _refuse_too_few(given)
    unknown = [row for row, plane in enumerate(given) if not plane.side_known]
    if len(unknown) > MOST_UNKNOWN_SIDES:
        raise InputError("the pipe", "", f"the sides of {len(unknown)} edges are unknown", "click beside each edge, on the pipe")
    stacked = StackedPlanes.of(given)
    found: list[tuple[float, float, TangentSolution]] = []
    weak, problems = [], []
    for signs in itertools.product((1.0, -1.0), repeat=len(unknown)):
        sides = np.ones(len(given))
        sides[unknown] = signs
        estimate = _adjusted(stacked.on(sides))
        if estimate is None or estimate.is_weak(settings):
            weak.append(np.nan if estimate is None else estimate.angle)
            continue
        problem = estimate.problem(settings)
        if problem:
            problems.append(problem)
            continue
        solution = estimate.solution(sides, estimate.redundancy)
        found.append((solution.sigma0**2 * solution.redundancy, estimate.distance, solution))
    if not found and weak:
        raise _intersection_error(given, cameras, max((a for a in weak if np.isfinite(a)), default=np.nan), settings)
    if not found:
        raise _impossible(given, problems[0])
    best = min(misfit for misfit, _, _ in found)
    likely = [entry for entry in found if entry[0] <= best + settings.largest_misfit]
    likely.sort(key=lambda entry: (round(entry[0] - best, 3), entry[1]))
    return tuple(solution for _, _, solution in likely)


def cylinder_from_diameter(
    pipe: ApparentPipe, diameter: float, sigma_diameter: float = 0.0, settings: TangentSettings | None = None
) -> TangentSolution:
    """Return the cylinder of a known diameter whose two edges one image shows, in closed form.

    The axis is where both planes meet after a shift by the radius towards it (the paper's Sect. 4.2); its
    point nearest to the projection centre P is P + r (n_1 + n_2) / (1 + n_1 . n_2), its direction n_1 x n_2.

    Parameters
    ----------
    pipe : ApparentPipe
    diameter, sigma_diameter : float
        The outside diameter and its standard deviation, mm.
    settings : TangentSettings, optional

    Raises
    ------
    InputError
        Where the diameter is none, or the pipe would be nearer than a camera can see it.
    """
    if not (np.isfinite([diameter, sigma_diameter]).all() and diameter > 0 and sigma_diameter >= 0):
        raise InputError("the pipe", "diameter", f"{diameter:g} mm +/- {sigma_diameter:g} mm is none", "give it in mm, above zero")
    first, second = (plane.normal for plane in pipe.edges)
    foot = pipe.camera.projection_centre + diameter / 2 * (first + second) / (1 + first @ second)
    planes = StackedPlanes.of(pipe.edges)
    estimate = _Estimate(Cylinder(foot, pipe.direction, diameter / 2), planes)
    if estimate.problem(settings or TangentSettings()):
        problem = f"{diameter:g} mm would put it {estimate.distance:.0f} mm from camera {pipe.camera.name}"
        raise InputError("the pipe", "diameter", problem, "give its outside diameter in mm")
    return estimate.solution(np.ones(2), 0, sigma_diameter / 2)


def intersection_angles(cameras: Sequence[Camera], axis: Cylinder) -> Array:
    """Return the angles (n, n) in radians, up to a right angle, between the planes through each projection centre and an axis.

    0 where both cameras and the axis lie in one plane, and for a camera on the axis.
    """
    return _angles(np.array([camera.projection_centre for camera in cameras]).reshape(-1, 3), axis)


def best_pair(cameras: Sequence[Camera], axis: Cylinder) -> CameraPair:
    """Return the two cameras whose centre planes of an axis intersect at the largest angle.

    Raises
    ------
    InputError
        Where there are fewer than two cameras.
    """
    if len(cameras) < 2:
        raise InputError("the station", "cameras", f"has {len(cameras)}", "give two or more")
    angles = intersection_angles(cameras, axis)
    first, second = np.unravel_index(int(np.argmax(np.triu(angles))), angles.shape)
    if first == second:  # all angles are zero
        first, second = np.intp(0), np.intp(1)
    return CameraPair(int(first), int(second), float(angles[first, second]))


@dataclass(frozen=True, eq=False)
class _Estimate:
    """A cylinder and the planes it should touch."""

    cylinder: Cylinder
    planes: StackedPlanes
    converged: bool = True

    @property
    def redundancy(self) -> int:
        return 2 * len(self.planes.normals) - PARAMETERS

    @property
    def distance(self) -> float:
        """From the nearest camera to the axis, mm."""
        return float(_distances(self.planes.centres, self.cylinder).min())

    @property
    def angle(self) -> float:
        """The largest intersection angle, radians."""
        return float(_angles(self.planes.centres, self.cylinder).max())

    def on_edges(self) -> tuple[Array, Array]:
        """Return where the ends of the edges touch: distances (k, 2) from the camera, and along the axis from its point, mm."""
        d = self.cylinder.direction
        # in the plane, at right angles to the axis
        across = np.cross(d, self.planes.normals)
        rays = self.planes.rays
        offset = self.cylinder.point - self.planes.centres
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = np.einsum("ki,ki->k", across, offset)[:, None] / np.einsum("ki,kji->kj", across, rays)
        return distance, distance * (rays @ d) - (offset @ d)[:, None]

    def in_the_middle(self) -> tuple[Cylinder, float]:
        """Return the cylinder with its point in the middle of what the edges cover, and half of that in mm."""
        _, along = self.on_edges()
        middle, half_length = (along.max() + along.min()) / 2, (along.max() - along.min()) / 2
        return replace(self.cylinder, point=self.cylinder.at(float(middle))), max(float(half_length), 1.0)

    def problem(self, settings: TangentSettings) -> str:
        """Return what is impossible about the cylinder in the user's words, or nothing."""
        distance, _ = self.on_edges()
        if not self.converged or not np.isfinite(distance).all() or self.cylinder.radius <= 0:
            return "they leave no room for it between them"
        if (_distances(self.planes.centres, self.cylinder) <= self.cylinder.radius).any():
            return "a camera would be inside it"
        if distance.min() < settings.least_distance:
            return "it would be behind a camera or at its lens"
        return ""

    def is_weak(self, settings: TangentSettings) -> bool:
        """Tell whether the images do not determine how far away the cylinder is."""
        if not self.angle >= np.radians(settings.least_angle_deg):
            return True
        distance, _ = self.on_edges()
        if not (np.isfinite(distance).all() and distance.min() > 0):
            return False
        solution = self.solution(np.ones(len(self.planes.normals)), self.redundancy)
        return bool(np.linalg.norm(solution.sigma_position) > settings.largest_relative_sigma * self.distance)

    def solution(self, sides: Array, redundancy: int, sigma_radius: float | None = None) -> TangentSolution:
        """Return the cylinder with its covariance; ``sigma_radius`` in mm where the radius is given."""
        cylinder, half_length = self.in_the_middle()
        axes = np.array(perpendicular_axes(cylinder.direction))
        residuals, derivatives = _linearised(self.planes, cylinder, axes, half_length)
        design = derivatives.reshape(-1, PARAMETERS)
        free = PARAMETERS if sigma_radius is None else PARAMETERS - 1
        inverse = np.linalg.pinv(design[:, :free])
        covariance = np.zeros((PARAMETERS, PARAMETERS))
        covariance[:free, :free] = inverse @ inverse.T
        if sigma_radius is not None:
            by_radius = np.append(-inverse @ design[:, 4], 1.0)
            covariance += sigma_radius**2 * np.outer(by_radius, by_radius)
        corrections = np.einsum("kij,kj->ki", self.planes.roots, residuals)
        off = np.einsum("kej,kj->ke", self.planes.ends, corrections) * self.planes.scale[:, None]
        sigma0 = float(np.sqrt(np.sum(residuals**2) / redundancy)) if redundancy else np.nan
        return TangentSolution(cylinder, covariance, axes, half_length, sides, off, sigma0, redundancy, self.angle)


def _adjusted(planes: StackedPlanes) -> _Estimate | None:
    """Fit a cylinder to planes on known sides; None where they do not determine one."""
    current = _starting_values(planes)
    if current is None:
        return None
    reach = max(float(np.mean(_distances(planes.centres, current))), 1.0)
    for _ in range(ITERATIONS):
        axes = np.array(perpendicular_axes(current.direction))
        residuals, derivatives = _linearised(planes, current, axes, reach)
        design = derivatives.reshape(-1, PARAMETERS)
        if not np.isfinite(design).all():
            return _Estimate(current, planes, converged=False)
        step, _, rank, _ = np.linalg.lstsq(design, -residuals.ravel(), rcond=SINGULAR)
        if rank < PARAMETERS:
            return None
        direction = unit(current.direction + step[2:4] / reach @ axes)
        current = Cylinder(current.point + step[:2] @ axes, direction, current.radius + float(step[4]))
        if np.abs(step).max() < CONVERGED * reach:
            return _Estimate(current, planes)
    return _Estimate(current, planes, converged=False)


def _starting_values(planes: StackedPlanes) -> Cylinder | None:
    """Solve n . d = 0 for the direction, then n . (X - P) = r for the axis and the radius; None where they do not determine it."""
    _, size, vectors = np.linalg.svd(planes.normals)
    if size[1] < SINGULAR * size[0]:
        return None
    across = planes.axes[0, 1]
    direction = vectors[2] if vectors[2] @ across > 0 else -vectors[2]
    axes = np.array(perpendicular_axes(direction))
    origin = planes.centres.mean(axis=0)
    design = np.column_stack([planes.normals @ axes.T, -np.ones(len(planes.normals))])
    distances = np.einsum("ki,ki->k", planes.normals, planes.centres - origin)
    unknowns, _, rank, _ = np.linalg.lstsq(design, distances, rcond=SINGULAR)
    return None if rank < 3 else Cylinder(origin + unknowns[:2] @ axes, direction, float(unknowns[2]))


def _linearised(planes: StackedPlanes, cylinder: Cylinder, axes: Array, half_length: float) -> tuple[Array, Array]:
    """Return the standardised residuals (k, 2) and their derivatives (k, 2, 5) by the five parameters.

    The conditions f = (n . d, n . (X - P) - r) are met by a normal that is corrected by -F^-1 f along
    the plane's axes b, with F = ((d . b), ((X - P) . b)): the residual, in terms of its standard deviation.
    """
    offset = cylinder.point - planes.centres
    conditions = np.column_stack([planes.normals @ cylinder.direction, np.einsum("ki,ki->k", planes.normals, offset) - cylinder.radius])
    by_normal = np.stack([np.broadcast_to(cylinder.direction, offset.shape), offset], axis=1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        whiten = inverse_2x2(by_normal @ np.swapaxes(planes.axes, 1, 2) @ planes.roots)
    derivatives = np.zeros((len(offset), 2, PARAMETERS))
    across = planes.normals @ axes.T
    derivatives[:, 0, 2:4] = across / half_length
    derivatives[:, 1, :2] = across
    derivatives[:, 1, 4] = -1
    return np.einsum("kij,kj->ki", whiten, conditions), whiten @ derivatives


def _refuse_too_few(planes: Sequence[TangentPlane]) -> None:
    if len({_identity(plane.camera) for plane in planes}) < 2:
        where = f"camera {planes[0].camera.name}" if planes else "no camera"
        raise InputError("the pipe", "", f"its edges are picked in {where} only", "pick it in another camera as well, or give its diameter")
    if len(planes) < 3:
        raise InputError("the pipe", "", "two edges are too few to determine it", "pick its other edge in one of the pictures as well")


def _impossible(planes: Sequence[TangentPlane], problem: str) -> InputError:
    where = names_of([plane.camera for plane in planes])
    return InputError(
        "the pipe", "", f"the edges in {where} are not those of one pipe: {problem}", "pick both edges of the same pipe in each picture"
    )


def _intersection_error(planes: Sequence[TangentPlane], cameras: Sequence[Camera], angle: float, settings: TangentSettings) -> IntersectionError:
    """Say that the pipe lies in one plane with the cameras and which camera helps.

    Its distance is not known, so the other cameras are tried with an axis across the view at the far end of the working range.
    """
    used = {_identity(plane.camera): plane.camera for plane in planes}
    rays = np.concatenate([plane.rays for plane in planes if plane.camera is planes[0].camera])
    axis = Cylinder(planes[0].projection_centre + settings.nominal_distance * unit(rays.sum(axis=0)), planes[0].axes[1], 1.0)
    pair = best_pair(cameras, axis) if len(cameras) > 1 else None
    helpful = [] if pair is None else [cameras[i] for i in (pair.first, pair.second) if _identity(cameras[i]) not in used]
    if pair is None or not helpful or pair.angle < np.radians(settings.least_angle_deg):
        pair, helpful = None, []
    seen = "" if np.isnan(angle) else f" (they see it from directions {np.degrees(angle):.2g} deg apart)"
    return IntersectionError(
        f"it lies in one plane with {names_of(list(used.values()))}, so its depth cannot be measured with them{seen}",
        f"pick it in {names_of(helpful)} as well" if helpful else "give its diameter, or photograph it from another place",
        angle,
        pair,
    )


def _identity(camera: Camera) -> tuple[str | float, ...]:
    """Return what tells cameras apart, across stations too, and however often a station was read."""
    return (camera.name, *camera.projection_centre.tolist())


def names_of(cameras: Sequence[Camera]) -> str:
    """Return "camera left" or "cameras left, right and top"."""
    names = list(dict.fromkeys(camera.name for camera in cameras))
    return f"camera {names[0]}" if len(names) == 1 else f"cameras {', '.join(names[:-1])} and {names[-1]}"


def _offsets(centres: Array, axis: Cylinder) -> Array:
    """Return the vectors (n, 3) from centres to an axis, at right angles to it, mm."""
    return across(axis.point - centres, axis.direction)


def _distances(centres: Array, axis: Cylinder) -> Array:
    return np.asarray(np.linalg.norm(_offsets(centres, axis), axis=1))


def _angles(centres: Array, axis: Cylinder) -> Array:
    """Return the angles (n, n) between the planes through an axis and centres (n, 3)."""
    offset = _offsets(centres, axis)
    sine = np.cross(offset[:, None], offset[None]) @ axis.direction
    return np.arctan2(np.abs(sine), np.abs(offset @ offset.T))
