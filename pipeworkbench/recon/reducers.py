# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reducers between two collinear pipes of different diameter, concentric or eccentric, placed by their edges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pipeworkbench import catalogue
from pipeworkbench.pipeline import AnyComponent, Pipe, Reducer
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.ends import Ends, each_end_once, ends_of
from pipeworkbench.recon.placement import Placement, placement
from pipeworkbench.recon.vectors import as_vector
from pipeworkbench.recon.views import View

Kind = Literal["concentric", "eccentric"]


@dataclass(frozen=True)
class ReducerSettings:
    """Tunables; diameters are outside diameters of the wider pipe.

    ``angle_deg`` between the axes; ``gap`` and ``overlap`` how far the pipes may end from each other, beyond the longest reducer of the
    catalogue, or lie in each other; ``aside_mm`` how far the axes may be from a concentric or an eccentric reducer's; ``steps`` places along
    the axis are tried. A reducer is one where ``least_support`` of the cone's samples find an edge and Eq. 4's q,
    of bounded influence, is ``worst_quality`` px at most.
    """

    angle_deg: float = 4.0
    gap: float = 1.0
    overlap: float = 1.0
    aside_mm: float = 6.0
    least_change: float = 0.04
    steps: int = 25
    stub: float = 1.0
    least_support: float = 0.55
    worst_quality: float = 0.75
    free_lengths: tuple[float, ...] = (0.6, 0.9, 1.3)


@dataclass(frozen=True, eq=False)
class FoundReducer:
    """A reducer between the ends (row, port) of the wider and the narrower pipe; ``component`` has no id yet."""

    wide: tuple[int, int]
    narrow: tuple[int, int]
    component: Reducer
    record: catalogue.Reducer | None


def detect(
    views: Sequence[View],
    components: Sequence[AnyComponent],
    settings: ReducerSettings | None = None,
    taken: frozenset[tuple[int, int]] = frozenset(),
) -> tuple[FoundReducer, ...]:
    """Find the reducers between pipes.

    Parameters
    ----------
    views : sequence of View
    components : sequence of Component
        In the station's frame.
    settings : ReducerSettings, optional
    taken : frozenset of (row, port)
        Ends that are joined already.
    """
    settings = settings or ReducerSettings()
    ends = ends_of(components, taken)
    found: list[tuple[float, FoundReducer]] = []
    for wide, narrow, aside in _candidates(ends, settings):
        best = _best(views, components, ends, wide, narrow, aside, settings)
        if best is not None:
            found.append(best)
    best_first = [reducer for _, reducer in sorted(found, key=lambda pair: pair[0])]
    return tuple(each_end_once(best_first, lambda reducer: (reducer.wide, reducer.narrow)))


def _candidates(ends: Ends, settings: ReducerSettings) -> Iterator[tuple[int, int, Array]]:
    """Yield wide end, narrow end and the offset (3,) of the narrow axis from the wide one."""
    first, second = ends.pairs()
    facing = -np.einsum("pi,pi->p", ends.direction[first], ends.direction[second]) >= np.cos(np.radians(settings.angle_deg))
    different = np.abs(ends.diameter[first] - ends.diameter[second]) > settings.least_change * np.maximum(ends.diameter[first], ends.diameter[second])
    straight = (ends.length[first] > 0) & (ends.length[second] > 0)
    for pair in np.flatnonzero(facing & different & straight):
        wide, narrow = int(first[pair]), int(second[pair])
        if ends.diameter[wide] < ends.diameter[narrow]:
            wide, narrow = narrow, wide
        large, small = float(ends.diameter[wide]), float(ends.diameter[narrow])
        apart = ends.point[narrow] - ends.point[wide]
        along = float(apart @ ends.direction[wide])
        aside = apart - along * ends.direction[wide]
        longest = max((r.length for r in catalogue.reducers(large, small)), default=settings.free_lengths[-1] * large)
        near = -settings.overlap * large <= along <= longest + settings.gap * large
        if near and np.linalg.norm(aside) <= (large - small) / 2 + settings.aside_mm:
            yield wide, narrow, aside


def _best(
    views: Sequence[View], components: Sequence[AnyComponent], ends: Ends, wide: int, narrow: int, aside: Array, settings: ReducerSettings
) -> tuple[float, FoundReducer] | None:
    """Return the reducer that fits best between two ends, with its quality, None where none fits."""
    large, small = float(ends.diameter[wide]), float(ends.diameter[narrow])
    axis = ends.direction[wide]
    records: list[tuple[catalogue.Reducer | None, float]] = [(record, record.length) for record in catalogue.reducers(large, small)]
    lengths = records or [(None, factor * large) for factor in settings.free_lengths]
    own = {int(ends.owner[wide]), int(ends.owner[narrow])}
    others = [c for row, c in enumerate(components) if row not in own]
    along = float((ends.point[narrow] - ends.point[wide]) @ axis)
    best: tuple[float, Placement, Reducer, catalogue.Reducer | None] | None = None
    for record, length in lengths:
        # where the reducer begins, from the wide pipe's end
        low, high = sorted((min(0.0, along - length) - 0.3 * large, max(0.0, along - length) + 0.3 * large))
        far = settings.stub * large
        for place in np.linspace(low, high, settings.steps):
            start = ends.point[wide] + place * axis
            for kind, offset in _offsets(aside, large, small, settings):
                component = Reducer(
                    id="reducer",
                    outer_diameter=large,
                    end_diameter=small,
                    start=as_vector(start),
                    end=as_vector(start + length * axis + offset),
                    axis=as_vector(axis),
                    reducer_type=kind,
                )
                before = Pipe(id="wide", outer_diameter=large, start=as_vector(start - (place - low + far) * axis), end=component.start)
                after = Pipe(
                    id="narrow", outer_diameter=small, start=component.end, end=as_vector(start + (length + high - place + far) * axis + offset)
                )
                fit = placement(views, [before, component, after], [1], others)
                if best is None or fit.quality < best[0]:
                    best = fit.quality, fit, component, record
    if best is None or best[1].support < settings.least_support or best[1].own > settings.worst_quality:
        return None
    quality, fit, component, record = best
    component = replace(component, quality=round(fit.own, 4))
    return quality, FoundReducer(ends.row_and_port(wide), ends.row_and_port(narrow), component, record)


def _offsets(aside: Array, large: float, small: float, settings: ReducerSettings) -> list[tuple[Kind, Array]]:
    """Return the kinds of reducer that the axes' offset (3,) allows, with the offset of the narrow end as measured."""
    off, eccentric = float(np.linalg.norm(aside)), (large - small) / 2
    kinds: list[tuple[Kind, Array]] = []
    if off <= settings.aside_mm and off <= eccentric / 2:
        kinds.append(("concentric", aside))
    elif abs(off - eccentric) <= settings.aside_mm:
        kinds.append(("eccentric", aside))
    return kinds
