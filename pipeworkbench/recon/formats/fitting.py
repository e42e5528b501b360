# SPDX-License-Identifier: LGPL-2.1-or-later
"""OpenCV's pinhole model with 14 coefficients fitted to a lens model that it does not contain."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, OpenCVInterior

Projection = Callable[[Array], Array]  # ideal coordinates (n, 2) to our pixels (n, 2)

LARGEST_DEVIATION_PX = 0.01  # a tenth of what edges are measured with
FIT_GRID, CHECK_GRID = (28, 22), (61, 47)  # pixels along and across the sensor, to its outer border
INVERSION_STEPS, INVERSION_TOLERANCE_PX = 60, 1e-6
DIFFERENCE_STEP = 1e-6  # of ideal coordinates, for derivatives
EVALUATIONS, CONVERGED = 400, 1e-15
FAR_PX = 1e6  # stands for what is not finite
FIRST_INTERIOR_COLUMN = 6  # of projectPoints' derivative, after rotation and translation
WITHOUT_TILT, WITH_TILT = 16, 18  # unknowns: focal lengths, principal point, distortion


def fit_opencv(project: Projection, width: int, height: int, source: Path, key: str, remedy: str) -> tuple[OpenCVInterior, float]:
    """Return the OpenCV interior orientation nearest to a lens model over the whole sensor, and the largest deviation in px.

    Parameters
    ----------
    project : callable
        Ideal coordinates (n, 2) to pixels (n, 2), centres at integers.
    width, height : int
        Of the image in pixels.
    source, key, remedy
        For the message where the model cannot be represented.

    Raises
    ------
    InputError
        Where the largest deviation is over `LARGEST_DEVIATION_PX`, or the sensor sees 90 degrees off the axis.
    """
    with np.errstate(all="ignore"):
        rays, pixels = _sensor(project, width, height, FIT_GRID, source, key, remedy)
        start = _start(project)
        interior, deviation = None, np.inf
        check_rays, check_pixels = _sensor(project, width, height, CHECK_GRID, source, key, remedy)
        for unknowns in (WITHOUT_TILT, WITH_TILT):
            try:
                candidate = _fit(rays, pixels, start, unknowns, width, height)
            except (np.linalg.LinAlgError, ValueError):  # coefficients without a meaning
                continue
            distance = np.linalg.norm(candidate.pixels(check_rays) - check_pixels, axis=1)
            largest = float(np.where(np.isnan(distance), np.inf, distance).max())
            if interior is None or largest < deviation:
                interior, deviation = candidate, largest
            if deviation <= LARGEST_DEVIATION_PX:
                break
    if interior is None or not deviation <= LARGEST_DEVIATION_PX:
        problem = f"this lens model deviates by up to {deviation:.3g} px from any that is supported (limit {LARGEST_DEVIATION_PX:g} px)"
        raise InputError(source, key, problem, remedy)
    return interior, deviation


def _fit(rays: Array, pixels: Array, start: Array, unknowns: int, width: int, height: int) -> OpenCVInterior:
    """Return the least-squares fit to rays (n, 2), as ideal coordinates, and their pixels (n, 2)."""
    import cv2

    scale = start[:2].mean()
    points = np.column_stack([rays, np.ones(len(rays))])
    zero = np.zeros(3)

    def projected(values: Array) -> tuple[Array, Array]:
        """Return residuals (2 n,) and their derivative (2 n, unknowns)."""
        fx, fy, cx, cy = values[:4] * scale
        distortion = np.concatenate([values[4:], np.zeros(WITH_TILT - unknowns)])
        found, jacobian = cv2.projectPoints(points, zero, zero, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), distortion)
        derivative = jacobian[:, FIRST_INTERIOR_COLUMN : FIRST_INTERIOR_COLUMN + unknowns]
        derivative[:, :4] *= scale
        residuals = (found[:, 0] - pixels).ravel()
        return np.nan_to_num(residuals, nan=FAR_PX, posinf=FAR_PX, neginf=-FAR_PX), np.nan_to_num(derivative)

    first = np.concatenate([start / scale, np.zeros(unknowns - 4)])
    solution = least_squares(
        lambda x: projected(x)[0],
        first,
        lambda x: projected(x)[1],
        x_scale="jac",
        xtol=CONVERGED,
        ftol=CONVERGED,
        gtol=CONVERGED,
        max_nfev=EVALUATIONS,
    )
    fx, fy, cx, cy = map(float, solution.x[:4] * scale)
    return OpenCVInterior(width, height, fx, fy, cx, cy, tuple(map(float, solution.x[4:])))


def _start(project: Projection) -> Array:
    """Return focal lengths and principal point (4,) of a lens model's middle."""
    middle = project(np.zeros((1, 2)))[0]
    return np.concatenate([np.abs(np.diag(_derivative(project, np.zeros((1, 2)))[0])), middle])


def _sensor(project: Projection, width: int, height: int, grid: tuple[int, int], source: Path, key: str, remedy: str) -> tuple[Array, Array]:
    """Return ideal coordinates (n, 2) and pixels (n, 2) of a grid over the whole sensor: Newton's method."""
    u, v = np.meshgrid(np.linspace(-0.5, width - 0.5, grid[0]), np.linspace(-0.5, height - 0.5, grid[1]))
    pixels = np.column_stack([u.ravel(), v.ravel()])
    start = _start(project)
    ideal = (pixels - start[2:]) / start[:2]
    missing = pixels - project(ideal)
    for _ in range(INVERSION_STEPS):
        if not np.abs(missing).max() > INVERSION_TOLERANCE_PX:
            break
        (a, b), (c, d) = np.moveaxis(_derivative(project, ideal), 0, -1)
        determinant = a * d - b * c
        ideal = ideal + np.column_stack([d * missing[:, 0] - b * missing[:, 1], a * missing[:, 1] - c * missing[:, 0]]) / determinant[:, None]
        missing = pixels - project(ideal)
    if not np.abs(missing).max() <= INVERSION_TOLERANCE_PX:
        raise InputError(source, key, "the lens model folds the image or sees 90 deg off its axis: some pixels have no ray", remedy)
    return ideal, pixels


def _derivative(project: Projection, ideal: Array) -> Array:
    """Return d pixels / d ideal (n, 2, 2) by central differences."""
    steps = DIFFERENCE_STEP * np.eye(2)
    return np.stack([(project(ideal + step) - project(ideal - step)) / (2 * DIFFERENCE_STEP) for step in steps], axis=2)
