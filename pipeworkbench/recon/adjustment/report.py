# SPDX-License-Identifier: LGPL-2.1-or-later
"""An adjustment's outcome as a solution: components with their accuracy, fits, gross errors and weak places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.pipeline import AnyComponent, Pipe
from pipeworkbench.recon.accuracy import level_of_accuracy
from pipeworkbench.recon.adjustment.charts import RIGID
from pipeworkbench.recon.adjustment.linearisation import Linearisation, Variances, image_distances
from pipeworkbench.recon.adjustment.normal_equations import FRAME_UNITS
from pipeworkbench.recon.adjustment.observations import MAD
from pipeworkbench.recon.adjustment.problem import AdjustmentSettings, Problem
from pipeworkbench.recon.adjustment.sampling import Samples
from pipeworkbench.recon.adjustment.solution import AdjustedStation, ContourFit, Estimate, Gross, ImageResiduals, PseudoFit, Solution, Weak
from pipeworkbench.recon.adjustment.variances import Assessment
from pipeworkbench.recon.bodies import SIZE_NAMES, unit_of
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.match import quality
from pipeworkbench.recon.vectors import as_vector, rounded, unit

QUALITY_RANGE = 3.0  # px; the b of Eq. 4 that qualities are given with


@dataclass(frozen=True, eq=False)
class Outcome:
    """What the iteration left: the last linearisation, its statistics, and what is not determined and why."""

    problem: Problem
    last: Linearisation
    assessment: Assessment
    variances: Variances
    samples: tuple[Samples, ...]
    undetermined: dict[str, str]
    iterations: int
    converged: bool
    message: str


def solution_of(outcome: Outcome, settings: AdjustmentSettings) -> Solution:
    """Return the solution."""
    linear, assessment = outcome.last, outcome.assessment
    image, pseudo = assessment.image_factor, assessment.pseudo_factor(linear)
    telling = linear.observed.telling
    observations = float(linear.groups.effective.sum()) + int(telling.sum())
    redundancy = max(observations - linear.unknowns.total, 0.0)
    squares = float(assessment.squares.sum() + linear.observed.squares[telling].sum())
    sigma0 = float(np.sqrt(squares / redundancy)) if redundancy > 0 else float("nan")
    # few residuals that happen to be small do not make the result better known
    factor = max(image, 1.0)
    estimates = _estimates(linear, assessment, factor)
    components = _components(outcome, estimates, settings)
    distances = np.concatenate([rows.distance for rows in linear.samples]) if linear.samples else np.zeros(0)
    known = np.abs(distances[np.isfinite(distances)])
    contours = _contours(outcome)
    fits = _pseudo(linear, assessment)
    systematic = outcome.variances.of(linear.groups, settings)
    common, trend = (float(np.sqrt(np.median(column))) if len(column) else 0.0 for column in systematic[~linear.groups.circle, :2].T)
    return Solution(
        components=components,
        estimates=estimates,
        stations=_poses(linear, assessment, factor),
        sigma0=sigma0,
        sigma_image=float(MAD * np.median(known)) if len(known) else float("nan"),
        redundancy=redundancy,
        observations=observations,
        unknowns=linear.unknowns.total,
        iterations=outcome.iterations,
        converged=outcome.converged,
        message=outcome.message,
        common_sigma=common,
        trend_sigma=trend,
        variance_factors={"image": image, "common": outcome.variances.common, "trend": outcome.variances.trend, "pseudo": pseudo},
        contours=contours,
        pseudo=fits,
        gross=_gross(outcome, contours, fits, settings),
        undetermined=outcome.undetermined,
        weak=_weak(linear, assessment, factor, settings),
        residuals=_residuals(outcome),
        warnings=tuple(_warnings(linear, outcome.undetermined)),
        full_covariance=_covariances(linear, assessment, factor),
    )


def _estimates(linear: Linearisation, assessment: Assessment, factor: float) -> dict[str, Estimate]:
    estimates = {}
    for row, component in enumerate(linear.state.components):
        names = linear.unknowns.names[row]
        if not names:
            continue
        cofactor = factor * assessment.motion_cofactor[row]
        position = cofactor[:3, :3]
        direction = float(np.sqrt(max(np.linalg.eigvalsh(cofactor[3:RIGID, 3:RIGID])[-1], 0.0)))
        sizes = {}
        for number, name in enumerate(SIZE_NAMES[type(component)], RIGID):
            if name in names:
                sizes[name] = unit_of(name) * float(np.sqrt(max(cofactor[number, number], 0.0)))
        estimates[component.id] = Estimate(np.sqrt(np.maximum(np.diag(position), 0.0)), position, direction, sizes)
    return estimates


def _components(outcome: Outcome, estimates: dict[str, Estimate], settings: AdjustmentSettings) -> tuple[AnyComponent, ...]:
    """Return the components with their accuracy; pipes end exactly where their neighbours begin."""
    state = outcome.last.state.with_ends(exact=True)
    owner = np.concatenate([samples.owner for samples in outcome.samples]) if outcome.samples else np.zeros(0, np.intp)
    distance = image_distances(state, outcome.samples, QUALITY_RANGE, settings)
    result: list[AnyComponent] = []
    for row, (component, given) in enumerate(zip(state.components, outcome.problem.components, strict=True)):
        estimate = estimates.get(component.id)
        if estimate is None:
            result.append(given)
            continue
        own = distance[owner == row]
        changes: dict[str, Any] = {
            "sigma_position": rounded(estimate.sigma_position, 4),
            "sigma_direction_deg": round(float(np.degrees(estimate.sigma_direction)), 5),
            "loa": level_of_accuracy(float(np.linalg.norm(estimate.sigma_position))),
        }
        if len(own):
            changes["quality"] = round(float(quality(own, QUALITY_RANGE)), 4)
        if isinstance(component, Pipe) and "outer_diameter" in estimate.sizes:
            changes["sigma_outer_diameter"] = round(estimate.sizes["outer_diameter"], 4)
        result.append(replace(component, **changes))
    return tuple(result)


def _poses(linear: Linearisation, assessment: Assessment, factor: float) -> dict[str, AdjustedStation]:
    state = linear.state
    poses = {}
    for number, station in enumerate(state.problem.stations):
        inverse = np.linalg.inv(state.poses[number])
        cameras = tuple(camera.placed(inverse) for camera, of in zip(state.cameras, state.station_of_view, strict=True) if of == number)
        covariance = np.zeros((RIGID, RIGID))
        for place, frame in enumerate(linear.unknowns.frames):
            if frame.name == station.name and not frame.camera:
                rows = np.arange(RIGID) + RIGID * place
                covariance = factor * assessment.covariance.border[np.ix_(rows, rows)] / np.outer(FRAME_UNITS, FRAME_UNITS)
        poses[station.name] = AdjustedStation(state.poses[number], cameras, covariance)
    return poses


def _contours(outcome: Outcome) -> tuple[ContourFit, ...]:
    linear, assessment = outcome.last, outcome.assessment
    groups, state = linear.groups, linear.state
    group = np.concatenate([samples.group for samples in outcome.samples]) if outcome.samples else np.zeros(0, np.intp)
    if len(outcome.samples) > 1:
        sizes = [len(samples.group_owner) for samples in outcome.samples]
        group = group + np.repeat(np.cumsum([0, *sizes[:-1]]), [len(samples) for samples in outcome.samples])
    distance = np.concatenate([rows.distance for rows in linear.samples]) if linear.samples else np.zeros(0)
    found = np.isfinite(distance)
    squares = np.bincount(group[found], distance[found] ** 2, minlength=len(groups))
    rms = np.sqrt(squares / np.maximum(groups.found, 1))
    share = assessment.redundancy / np.maximum(groups.effective, 1e-9)
    out = outcome.variances.left_out if outcome.variances.left_out is not None else np.zeros(len(groups), bool)
    station = [state.problem.stations[number].name for number in state.station_of_view]
    return tuple(
        ContourFit(
            state.components[groups.owner[row]].id,
            station[groups.view[row]],
            state.cameras[groups.view[row]].name,
            f"{groups.part[row]} {groups.curve[row]}",
            int(groups.samples[row]),
            int(groups.found[row]),
            float(rms[row]),
            float(assessment.offset[row]) if out[row] else float(assessment.systematic[row, 0]),
            float(assessment.w[row]),
            float(share[row]),
        )
        for row in range(len(groups))
    )


def _residuals(outcome: Outcome) -> tuple[ImageResiduals, ...]:
    state = outcome.last.state
    found = []
    for number, (samples, rows) in enumerate(zip(outcome.samples, outcome.last.samples, strict=True)):
        known = np.isfinite(rows.distance) & (rows.weight > 0)
        contour = rows.position[known]
        edge = contour + rows.distance[known, None] * rows.normal[known]
        station = state.problem.stations[state.station_of_view[number]].name
        found.append(ImageResiduals(station, state.cameras[number].name, samples.owner[known], contour, edge))
    return tuple(found)


def _pseudo(linear: Linearisation, assessment: Assessment) -> tuple[PseudoFit, ...]:
    observed = linear.observed
    numbers = (-observed.misclosure, observed.sigma, assessment.pseudo_redundancy, assessment.pseudo_w)
    return tuple(PseudoFit(*one) for one in zip(observed.what, *(column.tolist() for column in numbers), strict=True))


def _gross(outcome: Outcome, contours: tuple[ContourFit, ...], pseudo: tuple[PseudoFit, ...], settings: AdjustmentSettings) -> tuple[Gross, ...]:
    left_out = outcome.variances.left_out if outcome.variances.left_out is not None else np.zeros(len(contours), bool)
    found = [
        Gross(f"{fit.component}: {fit.contour} in {fit.station}/{fit.image}", fit.offset, fit.w, bool(out))
        for fit, out in zip(contours, left_out, strict=True)
        if out or abs(fit.w) > settings.snooping  # where nothing checks it, w is not a number and not larger
    ]
    found += [Gross(fit.what, fit.residual, fit.w, left_out=False) for fit in pseudo if abs(fit.w) > settings.snooping]
    return tuple(sorted(found, key=lambda one: -abs(np.nan_to_num(one.w))))


def _weak(linear: Linearisation, assessment: Assessment, factor: float, settings: AdjustmentSettings) -> tuple[Weak, ...]:
    """Return the pipes whose planes of sight hardly meet, and whatever is many times less sure in one direction than in others."""
    groups, state = linear.groups, linear.state
    weak = []
    for row, component in enumerate(state.components):
        if not linear.unknowns.names[row]:
            continue
        values, axes = np.linalg.eigh(factor * assessment.motion_cofactor[row][:3, :3])
        # of a pipe the axis itself is no direction
        sigma = np.sqrt(np.maximum(values[1:] if isinstance(component, Pipe) else values, 0.0))
        reason = ""
        if isinstance(component, Pipe):
            views = np.unique(groups.view[(groups.owner == row) & (groups.found > 0)])
            angle = _intersection(component, [state.cameras[view].projection_centre for view in views])
            if angle < settings.weak_angle_deg:
                reason = f"the planes of sight through its axis meet at {angle:.1f} degrees: its axis is nearly parallel to the cameras' base"
        if not reason and sigma[-1] > settings.weak_ratio * max(sigma[0], 1e-9):
            reason = f"it is {sigma[-1] / max(sigma[0], 1e-9):.0f} times less sure this way than across"
        if reason and sigma[-1] > settings.weak_sigma:
            weak.append(Weak(component.id, as_vector(axes[:, -1]), float(sigma[-1]), reason))
    return tuple(weak)


def _intersection(pipe: Pipe, centres: list[NDArray[np.float64]]) -> float:
    """Return the largest angle in degrees between the planes through a pipe's axis and projection centres."""
    if len(centres) < 2:
        return 0.0
    axis = unit(np.subtract(pipe.end, pipe.start))
    normals = np.cross(axis, np.array(centres) - np.array(pipe.start))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    sine = np.linalg.norm(np.cross(normals[:, None], normals[None]), axis=2)
    return float(np.degrees(np.arcsin(np.clip(sine.max(), 0, 1))))


def _warnings(linear: Linearisation, undetermined: dict[str, str]) -> list[str]:
    """Return sentences about images whose edges cannot be used and components that stayed."""
    texts = [f"{name}: it stays as it was: {reason}" for name, reason in undetermined.items()]
    texts += [
        f"station {frame.name}: none of its edges belongs to a component; nothing but what was known before says where it is"
        for frame in linear.unknowns.frames
        if not frame.camera and not linear.groups.found[frame.of(linear.groups.view)].any()
    ]
    for view in linear.state.views:
        edges = view.edges
        bad = ~(
            np.isfinite(edges.position).all(axis=1) & np.isfinite(edges.normal).all(axis=1) & np.isfinite(edges.sigma) & np.isfinite(edges.smoothing)
        )
        if bad.any():
            texts.append(f"image {view.camera.name}: {int(bad.sum())} of {len(bad)} edge points are not numbers; they are left out")
    return texts


def _covariances(linear: Linearisation, assessment: Assessment, factor: float) -> Callable[[str], tuple[tuple[str, ...], Array]]:
    rows = {component.id: row for row, component in enumerate(linear.state.components)}

    def of(name: str) -> tuple[tuple[str, ...], Array]:
        if name not in rows or not linear.unknowns.names[rows[name]]:
            raise InputError("the adjustment", name, "was not adjusted", "ask for one of the estimates")
        return linear.unknowns.names[rows[name]], factor * assessment.covariance.of(linear.unknowns.columns(rows[name]))

    return of
