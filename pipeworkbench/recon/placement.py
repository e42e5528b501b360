# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well components fit the images where they stand: Eq. 4 along the contours that are in view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.contour import contour_of
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.match import Match, match, robust_quality
from pipeworkbench.recon.views import View

SEARCH_RANGE_PX = 3.0  # the paper's b
LEAST_SAMPLES = 10  # in a view that counts
FACING = 0.5  # cosine


@dataclass(frozen=True)
class Placement:
    """Eq. 4's q in px with bounded influence, the part of the samples that found an edge, and how many samples there were.

    ``quality`` is over the contours of all components, ``own`` and ``support`` over the judged ones'.
    """

    quality: float
    own: float
    support: float
    samples: int


def outline_match(view: View, cylinder: Cylinder, along: Array, reach: float) -> Match:
    """Return the edges that a cylinder's outline meets in one image, of its visible samples only.

    Parameters
    ----------
    view : View
    cylinder : Cylinder
    along : (n,) array
        Samples of either edge, mm along the axis from the cylinder's point.
    reach : float
        How far from the outline an edge may be, px.
    """
    position, normal = (x.reshape(-1, 2) for x in outlines(view.camera, cylinder.as_many(), along[None]))
    visible = np.isfinite(position[:, 0])
    return match(view.edges, position[visible], normal[visible], reach)


def placement(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    judged: Sequence[int],
    others: Sequence[AnyComponent] = (),
    towards: Array | None = None,
) -> Placement:
    """Return how well components, joined to each other, fit all images.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        Whose contours are matched.
    judged : sequence of int
        Rows of those that are in question.
    others : sequence of Component
        What may stand before them.
    towards : (3,) array, optional
        Judge only by contours whose surface looks this way (unit vector): the others look like a pipe's that goes on.
    """
    distances, judged_samples = [], []
    for view in views:
        contour = contour_of(view.camera, [*components, *others])
        contour = contour[contour.visible & (contour.component < len(components))]
        if len(contour) >= LEAST_SAMPLES:
            distances.append(match(view.edges, contour.position, contour.normal, SEARCH_RANGE_PX).distance)
            own = np.isin(contour.component, list(judged))
            judged_samples.append(own if towards is None else own & (contour.outward @ towards >= FACING))
    if not distances:
        return Placement(np.inf, np.inf, 0.0, 0)
    distance, own = np.concatenate(distances), np.concatenate(judged_samples)
    count = int(own.sum())
    if count < LEAST_SAMPLES:
        return Placement(np.inf, np.inf, 0.0, count)
    return Placement(
        float(robust_quality(distance, SEARCH_RANGE_PX)),
        float(robust_quality(distance[own], SEARCH_RANGE_PX)),
        float(np.isfinite(distance[own]).mean()),
        count,
    )
