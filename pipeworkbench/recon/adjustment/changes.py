# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an adjustment did, for people: how each component moved, how each image fits, and a summary that goes with the pipeline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from pipeworkbench.pipeline import AnyComponent, Pipeline
from pipeworkbench.recon.adjustment.solution import Solution
from pipeworkbench.recon.registration.landmarks import landmarks_of
from pipeworkbench.recon.vectors import dot

SUMMARY_KEY = "adjustment"  # among the extra keys of a pipeline
MOST_TOLD = 20  # gross errors in a summary; all of a bad adjustment's help nobody


class Change(NamedTuple):
    """How a component moved.

    ``shift`` mm of its middle, of pipes across their axis; ``rotation_deg`` of its axis; ``before`` and ``after`` the component itself.
    """

    before: AnyComponent
    after: AnyComponent
    shift: float
    rotation_deg: float


class ImageFit(NamedTuple):
    """How the contours fit one image: ``rms`` px of the distances to the edges, NaN where there is none; ``found`` of ``samples`` have an edge."""

    station: str
    image: str
    rms: float
    found: int
    samples: int


def changes(before: Sequence[AnyComponent], after: Sequence[AnyComponent]) -> tuple[Change, ...]:
    """Return how components moved; both sequences hold the same components in the same order."""
    if not before:
        return ()
    one, other = (landmarks_of(Pipeline(frame="", components=tuple(components))) for components in (before, after))
    moved = other.point - one.point
    # along its axis a pipe's middle moves when an end does
    sideways = moved - dot(moved, one.axis)[:, None] * one.axis
    shift = np.linalg.norm(np.where(one.is_axis[:, None], sideways, moved), axis=1)
    cosine = dot(one.axis, other.axis)
    sine = np.linalg.norm(np.cross(one.axis, other.axis), axis=1)
    rotation = np.degrees(np.arctan2(sine, np.where(one.is_axis, np.abs(cosine), cosine)))
    return tuple(Change(*row) for row in zip(before, after, shift.tolist(), rotation.tolist(), strict=True))


def image_fits(solution: Solution) -> tuple[ImageFit, ...]:
    """Return how each image is fitted, in the order of the contours."""
    fits: dict[tuple[str, str], tuple[float, int, int]] = {}
    for contour in solution.contours:
        squares, found, samples = fits.get((contour.station, contour.image), (0.0, 0, 0))
        own = contour.rms**2 * contour.found if contour.found else 0.0
        fits[contour.station, contour.image] = squares + own, found + contour.found, samples + contour.samples
    return tuple(
        ImageFit(station, image, float(np.sqrt(squares / found)) if found else float("nan"), found, samples)
        for (station, image), (squares, found, samples) in fits.items()
    )


def summary_of(solution: Solution) -> dict[str, Any]:
    """Return what a report says of an adjustment, as JSON has it; numbers that are not known are None."""
    return {
        "sigma0": _number(solution.sigma0),
        "sigma_image_px": _number(solution.sigma_image),
        "observations": _number(solution.observations, 1),
        "unknowns": solution.unknowns,
        "redundancy": _number(solution.redundancy, 1),
        "iterations": solution.iterations,
        "converged": solution.converged,
        "message": solution.message,
        "images": [
            {"station": fit.station, "image": fit.image, "rms_px": _number(fit.rms), "found": fit.found, "samples": fit.samples}
            for fit in image_fits(solution)
        ],
        "gross": [
            {"what": one.what, "size": _number(one.size), "w": _number(one.w, 2), "left_out": one.left_out} for one in solution.gross[:MOST_TOLD]
        ],
        "weak": [{"component": one.component, "sigma_mm": _number(one.sigma, 3), "reason": one.reason} for one in solution.weak],
        "undetermined": dict(solution.undetermined),
        "warnings": list(solution.warnings),
    }


def with_solution(pipeline: Pipeline, solution: Solution) -> Pipeline:
    """Return a pipeline as its adjustment left it: the components, sigma0 and the summary; its stations stay as they are."""
    summary = summary_of(solution)
    return replace(pipeline, components=solution.components, sigma0=summary["sigma0"], extra=pipeline.extra | {SUMMARY_KEY: summary})


def _number(value: float, digits: int = 4) -> float | None:
    return round(float(value), digits) if np.isfinite(value) else None
