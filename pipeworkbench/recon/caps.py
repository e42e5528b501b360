# SPDX-License-Identifier: LGPL-2.1-or-later
"""Caps on free ends of pipes: where the dome's outline is seen and a pipe that is cut off fits worse."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeworkbench import catalogue
from pipeworkbench.pipeline import AnyComponent, Cap, Flange, Pipe
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.ends import Ends, ends_of
from pipeworkbench.recon.placement import Placement, placement
from pipeworkbench.recon.vectors import as_vector
from pipeworkbench.recon.views import View

CUT_MM = 1.0  # thickness of the disc that stands for a pipe's cut end


@dataclass(frozen=True)
class CapSettings:
    """Tunables; lengths in outside diameters, qualities as Eq. 4's q of bounded influence in px.

    A cap's middle is within ``around`` of the end, looked for in ``coarse_steps`` and, where ``rough_support`` of its samples find
    an edge, in finer ones. It is one where ``least_support`` of them find an edge, q is ``worst_quality`` at most
    and a cut end fits worse by ``clear``. Ends with another port within ``near`` are not free.
    """

    around: float = 0.6
    coarse_steps: int = 7
    steps: int = 4
    stub: float = 0.3
    rough_support: float = 0.5
    least_support: float = 0.8
    worst_quality: float = 0.55
    clear: float = 0.15
    near: float = 1.5


@dataclass(frozen=True, eq=False)
class FoundCap:
    """A cap on an end (row, port); ``component`` has no id yet."""

    end: tuple[int, int]
    component: Cap
    record: catalogue.Cap


def detect(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    settings: CapSettings | None = None,
    taken: frozenset[tuple[int, int]] = frozenset(),
) -> tuple[FoundCap, ...]:
    """Find the caps on the free ends of pipes.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        In the station's frame.
    settings : CapSettings, optional
    taken : frozenset of (row, port)
        Ends that are joined already.
    """
    settings = settings or CapSettings()
    ends = ends_of(components, taken)
    found = []
    for end in range(len(ends)):
        if ends.length[end] > 0 and not _met(components, ends, end, settings):
            cap = _cap(views, ends, end, settings)
            if cap is not None:
                found.append(cap)
    return tuple(found)


def _met(components: Sequence[AnyComponent], ends: Ends, end: int, settings: CapSettings) -> bool:
    """Tell whether another component's port is near an end: then nothing closes it."""
    own = int(ends.owner[end])
    ports = [port.point for row, c in enumerate(components) if row != own for port in c.ports]
    if not ports:
        return False
    return bool(np.linalg.norm(np.array(ports) - ends.point[end], axis=1).min() < settings.near * ends.diameter[end])


def _cap(views: Sequence[View], ends: Ends, end: int, settings: CapSettings) -> FoundCap | None:
    """Return the cap on an end, None where the images show none."""
    diameter, axis = float(ends.diameter[end]), ends.direction[end]
    around = np.linspace(-settings.around, settings.around, settings.coarse_steps) * diameter
    best: tuple[Placement, Cap, catalogue.Cap] | None = None
    for record in catalogue.caps(diameter):
        rough = max((_capped(views, ends, end, place, record, settings) for place in around - record.height / 2), key=lambda f: f[0].support)
        if rough[0].support < settings.rough_support:
            continue
        middle = float((np.array(rough[1].start) - ends.point[end]) @ axis)
        step = (around[1] - around[0]) / settings.steps
        for place in middle + step * np.arange(-settings.steps, settings.steps + 1):
            fit, cap = _capped(views, ends, end, float(place), record, settings)
            if best is None or fit.own < best[0].own:
                best = fit, cap, record
    if best is None or best[0].support < settings.least_support or best[0].own > settings.worst_quality:
        return None
    fit, cap, record = best
    along = float((np.array(cap.start) - ends.point[end]) @ axis)
    # a cut end, which is a sharp circle, anywhere from where the dome begins to its top
    cut = min(
        _placed(views, ends, end, place, _cut_end(ends.point[end] + place * axis, axis, diameter), settings).own
        for place in along + np.linspace(0, record.height, 2 * settings.steps + 1)
    )
    if fit.own > cut - settings.clear:
        return None
    return FoundCap(ends.row_and_port(end), replace(cap, quality=round(fit.own, 4)), record)


def _capped(views: Sequence[View], ends: Ends, end: int, place: float, record: catalogue.Cap, settings: CapSettings) -> tuple[Placement, Cap]:
    """Return how well a cap fits that begins ``place`` mm beyond an end."""
    axis = ends.direction[end]
    start = as_vector(ends.point[end] + place * axis)
    cap = Cap(id="cap", outer_diameter=float(ends.diameter[end]), start=start, axis=as_vector(axis), length=record.height)
    return _placed(views, ends, end, place, cap, settings), cap


def _placed(views: Sequence[View], ends: Ends, end: int, place: float, closing: AnyComponent, settings: CapSettings) -> Placement:
    """Return how well what closes a pipe fits that ends ``place`` mm beyond its end."""
    diameter, axis, point = float(ends.diameter[end]), ends.direction[end], ends.point[end]
    begin, finish = point + (place - settings.stub * diameter) * axis, point + place * axis
    pipe = Pipe(id="pipe", outer_diameter=diameter, start=as_vector(begin), end=as_vector(finish))
    return placement(views, [pipe, closing], [1], towards=axis)


def _cut_end(point: Array, axis: Array, diameter: float) -> Flange:
    """Return a thin disc with its sharp edge: what is seen of a pipe's cut end."""
    return Flange(
        id="cut",
        outer_diameter=diameter,
        face=as_vector(point + CUT_MM * axis),
        axis=as_vector(axis),
        flange_type="05",
        pn=1,
        D=diameter,
        C=CUT_MM,
        length=CUT_MM,
    )
