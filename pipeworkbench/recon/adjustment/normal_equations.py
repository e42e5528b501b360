# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sparse normal equations by components, stations and cameras: solution and covariance.

Components are bound to each other by joints only, so that their part falls apart into one block per connected
pipeline; stations and cameras border it. Covariances come block by block, the border by its Schur complement.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import coo_matrix, csc_matrix, diags
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import SuperLU, splu

from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.adjustment.charts import MOTION, RIGID, parameter_names
from pipeworkbench.recon.adjustment.conditions import NOBODY, Observed
from pipeworkbench.recon.adjustment.observations import Groups, Reduced
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.vectors import cross_matrices

LEAST_INFORMATION = 1e-8  # 1 / mm^2; what is known before: a component is within 10 m of where it was
FRAME_LEVER = 1000.0  # mm; a frame's rotations count by what they move at this distance
FRAME_UNITS = np.repeat([1.0, FRAME_LEVER], 3)  # of a frame's unknowns in its shift (mm) and turn (rad)
LARGEST_DENSE = 900  # unknowns of a connected part that is inverted as a whole
COLUMNS = 256  # of a covariance that is solved for at a time


@dataclass(frozen=True, eq=False)
class Frame:
    """A station or a camera whose pose is an unknown.

    views are the numbers of the images that move with it; origin (3,) is the point that it turns about, mm; the sigmas
    (mm, rad) say how well its pose ``deviation`` (6,), so far, from the given one is known to be zero. A ``camera`` moves in its station.
    """

    name: str
    camera: bool
    views: frozenset[int]
    origin: Array
    sigma_position: float
    sigma_rotation: float
    deviation: Array

    def of(self, view: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return the rows of the images (g,) that move with it."""
        return np.flatnonzero(np.isin(view, list(self.views)))


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Where each component's and frame's unknowns are.

    basis (c, 9, 9): a component's unknowns to its motion, zero columns where it has fewer; ``names`` of its unknowns, their
    count (c,) and start (c,); reference (c, 3) mm; frames with ``frame_start`` (f,); total.
    """

    basis: Array
    names: tuple[tuple[str, ...], ...]
    count: NDArray[np.intp]
    start: NDArray[np.intp]
    reference: Array
    frames: tuple[Frame, ...]
    frame_start: NDArray[np.intp]
    total: int

    @property
    def own(self) -> int:
        """The number of the components' unknowns; those of frames follow."""
        return int(self.count.sum())

    def columns(self, component: int) -> NDArray[np.intp]:
        """Return the numbers of a component's unknowns."""
        return np.arange(self.start[component], self.start[component] + self.count[component])

    def places(self, components: NDArray[np.intp]) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
        """Return which of nine columns (m, 9) components (m,) have, and the numbers of those unknowns, one component after the other."""
        column = np.arange(MOTION)
        there = column < self.count[components, None]
        return there, (self.start[components, None] + column)[there]

    def motions(self, step: Array) -> Array:
        """Return the motions (c, 9) of a step (u,)."""
        padded = np.zeros((len(self.count), MOTION))
        there, numbers = self.places(np.arange(len(self.count)))
        padded[there] = step[numbers]
        return np.asarray(np.einsum("cij,cj->ci", self.basis, padded))

    def frame_motions(self, frame: Frame, components: NDArray[np.intp]) -> Array:
        """Return how components (m,) seem to move when a frame does: (m, 6, 6), by their motions about their references.

        A camera that moves by t and turns by w about its origin sees what it would if all else moved the other way.
        """
        offset = self.reference[components] - frame.origin
        transform = np.zeros((len(components), RIGID, RIGID))
        transform[:, :3, :3] = -np.eye(3)
        transform[:, 3:, 3:] = -np.eye(3) / FRAME_LEVER
        # (X - o) x N = (X - p) x N + (p - o) x N
        transform[:, :3, 3:] = cross_matrices(offset / FRAME_LEVER)
        return transform


@dataclass(frozen=True, eq=False)
class Layout:
    """Which of the components' parameters are unknowns: ``names`` and column (c, 9) of their charts, -1 where there are fewer."""

    names: tuple[tuple[str, ...], ...]
    column: NDArray[np.intp]

    @classmethod
    def of(cls, components: Sequence[AnyComponent], free: Sequence[frozenset[str]]) -> Layout:
        """Return the unknowns of components of which the parameters named in ``free`` may change."""
        column = np.full((len(components), MOTION), -1)
        names: list[tuple[str, ...]] = []
        for row, (component, wanted) in enumerate(zip(components, free, strict=True)):
            every = parameter_names(component) if wanted else ()
            columns = [number for number, name in enumerate(every) if name in wanted]
            column[row, : len(columns)] = columns
            names.append(tuple(every[number] for number in columns))
        return cls(tuple(names), column)

    def unknowns(self, reference: Array, basis: Array, frames: Sequence[Frame]) -> Unknowns:
        """Return the unknowns of components with charts (:func:`.charts.charts`), and of frames."""
        there = self.column >= 0
        chosen = np.where(there[:, None, :], np.take_along_axis(basis, np.maximum(self.column, 0)[:, None, :], axis=2), 0.0)
        count = there.sum(axis=1)
        own = int(count.sum())
        frame_start = own + RIGID * np.arange(len(frames))
        return Unknowns(chosen, self.names, count, np.cumsum(count) - count, reference, tuple(frames), frame_start, own + RIGID * len(frames))


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """N x = n for all unknowns."""

    matrix: csc_matrix
    right: Array
    unknowns: Unknowns

    def solve(self, damping: float = 0.0) -> Array:
        """Return the step (u,) of Levenberg and Marquardt with a damping relative to the diagonal."""
        if not len(self.right):
            return np.zeros(0)
        matrix = self.matrix
        if damping:
            matrix = matrix + diags(damping * matrix.diagonal(), format="csc")
        return np.asarray(_factor(matrix).solve(self.right))


def _factor(matrix: csc_matrix) -> SuperLU:
    """Factor a sparse matrix that is symmetric and positive definite."""
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def normal_equations(groups: Groups, systems: Reduced, observed: Observed, unknowns: Unknowns) -> NormalEquations:
    """Sum up the normal equations of image contours and pseudo-observations."""
    count = len(unknowns.count)
    blocks, right = np.zeros((count, MOTION, MOTION)), np.zeros((count, MOTION))
    np.add.at(blocks, groups.owner, systems.normal[:, :MOTION, :MOTION])
    np.add.at(right, groups.owner, systems.normal[:, :MOTION, MOTION])
    basis = unknowns.basis
    own_blocks = np.swapaxes(basis, 1, 2) @ blocks @ basis
    own_right = np.einsum("cij,ci->cj", basis, right)
    there, numbers = unknowns.places(np.arange(count))
    places = np.zeros(there.shape, np.intp)
    places[there] = numbers
    pair = there[:, :, None] & there[:, None, :]
    line = [np.broadcast_to(places[:, :, None], pair.shape)[pair]]
    along = [np.broadcast_to(places[:, None, :], pair.shape)[pair]]
    value = [own_blocks[pair]]
    vector = np.zeros(unknowns.total)
    vector[numbers] = own_right[there]
    for number, frame in enumerate(unknowns.frames):
        for some in _of_frame(groups, systems, unknowns, number, frame, vector):
            line.append(some[0])
            along.append(some[1])
            value.append(some[2])
    pseudo = design(observed, unknowns)
    weighted = diags(observed.sigma**-2.0) @ pseudo
    matrix = coo_matrix((np.concatenate(value), (np.concatenate(line), np.concatenate(along))), shape=(unknowns.total,) * 2)
    matrix = csc_matrix(matrix) + pseudo.T @ weighted + diags(np.full(unknowns.total, LEAST_INFORMATION), format="csc")
    return NormalEquations(csc_matrix(matrix), vector + weighted.T @ observed.misclosure, unknowns)


def _of_frame(
    groups: Groups, systems: Reduced, unknowns: Unknowns, number: int, frame: Frame, vector: Array
) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp], Array]]:
    """Yield rows, columns and values of a frame's part of the matrix, and add to the right side."""
    start = unknowns.frame_start[number]
    places = start + np.arange(RIGID)
    mine = frame.of(groups.view)
    transform = unknowns.frame_motions(frame, groups.owner[mine])
    normal = systems.normal[mine]
    rigid = normal[:, :RIGID, :RIGID]
    prior = (np.repeat([frame.sigma_position, frame.sigma_rotation], 3) * FRAME_UNITS) ** -2.0
    block = np.einsum("gai,gab,gbj->ij", transform, rigid, transform) + np.diag(prior)
    vector[places] += np.einsum("gai,ga->i", transform, normal[:, :RIGID, MOTION])
    vector[places] -= prior * frame.deviation * FRAME_UNITS
    yield np.repeat(places, RIGID), np.tile(places, RIGID), block.ravel()
    # with the components
    between = np.zeros((len(unknowns.count), MOTION, RIGID))
    np.add.at(between, groups.owner[mine], normal[:, :MOTION, :RIGID] @ transform)
    between = np.swapaxes(unknowns.basis, 1, 2) @ between
    component = np.unique(groups.owner[mine])
    there, numbers = unknowns.places(component)
    line = np.repeat(numbers, RIGID)
    along = np.tile(places, len(numbers))
    values = between[component][there].ravel()
    yield line, along, values
    yield along, line, values
    # with the frames before it whose images are the same: a camera's with its station's
    for other in range(number):
        shared = np.isin(groups.view[mine], list(unknowns.frames[other].views))
        if not shared.any():
            continue
        theirs = unknowns.frame_motions(unknowns.frames[other], groups.owner[mine[shared]])
        block = np.einsum("gai,gab,gbj->ij", transform[shared], rigid[shared], theirs)
        there_too = unknowns.frame_start[other] + np.arange(RIGID)
        yield np.repeat(places, RIGID), np.tile(there_too, RIGID), block.ravel()
        yield np.repeat(there_too, RIGID), np.tile(places, RIGID), block.T.ravel()


def design(observed: Observed, unknowns: Unknowns) -> csc_matrix:
    """Return how pseudo-observations change with the unknowns: (r, u)."""
    number, side = np.nonzero(observed.bodies != NOBODY)
    component = observed.bodies[number, side]
    values = np.einsum("ri,rij->rj", observed.derivative[number, side], unknowns.basis[component])
    there, places = unknowns.places(component)
    shape = (len(observed), unknowns.total)
    return csc_matrix(coo_matrix((values[there], (np.repeat(number, unknowns.count[component]), places)), shape=shape))


@dataclass(frozen=True, eq=False)
class Covariance:
    """Cofactors of the unknowns, block by block.

    parts are connected pipelines: their unknowns' numbers (p,) and the cofactor matrix (p, p); part_of_unknown (u,) and place (u,) an
    unknown's part and row in its part; border (b, b) the cofactors of the frames,
    with_border (u, b) those between components and frames.
    """

    parts: tuple[tuple[NDArray[np.intp], Array], ...]
    part_of_unknown: NDArray[np.intp]
    place: NDArray[np.intp]
    border: Array
    with_border: Array

    def of(self, numbers: NDArray[np.intp]) -> Array:
        """Return the cofactors (p, p) of some unknowns of one part."""
        if not len(numbers):
            return np.zeros((0, 0))
        rows = self.place[numbers]
        return self.parts[self.part_of_unknown[numbers[0]]][1][np.ix_(rows, rows)]

    def blocks(self, unknowns: Unknowns, one: NDArray[np.intp], other: NDArray[np.intp]) -> Array:
        """Return the cofactors (m, 9, 9) between the unknowns of components (m,) and (m,), zeros where these have fewer or are of different parts."""
        column = np.arange(MOTION)
        result = np.zeros((len(one), MOTION, MOTION))
        known = np.flatnonzero((unknowns.count[one] > 0) & (unknowns.count[other] > 0))
        first, second = unknowns.start[one[known]], unknowns.start[other[known]]
        label = np.where(self.part_of_unknown[first] == self.part_of_unknown[second], self.part_of_unknown[first], -1)
        for part in np.unique(label[label >= 0]):
            ours = label == part
            # a component's unknowns follow each other in their part
            line, along = (np.minimum(self.place[begin[ours], None] + column, len(self.parts[part][0]) - 1) for begin in (first, second))
            result[known[ours]] = self.parts[part][1][line[:, :, None], along[:, None, :]]
        there = (column < unknowns.count[one, None])[:, :, None] & (column < unknowns.count[other, None])[:, None, :]
        return np.where(there, result, 0.0)

    def between(self, unknowns: Unknowns, components: NDArray[np.intp], places: NDArray[np.intp]) -> Array:
        """Return the cofactors (m, 9, p) between the motions of components (m,) and some of the frames' unknowns (p,)."""
        there, numbers = unknowns.places(components)
        padded = np.zeros((len(components), MOTION, len(places)))
        padded[there] = self.with_border[numbers][:, places]
        return np.asarray(unknowns.basis[components] @ padded)


def covariance(equations: NormalEquations) -> Covariance:
    """Return the cofactors of all unknowns: N^-1, but for those between pipelines that no joint connects."""
    own, total = equations.unknowns.own, equations.unknowns.total
    matrix = equations.matrix.tocsr()
    inner, side = matrix[:own, :own], matrix[:own, own:].toarray()
    count, label = connected_components(inner + _together(equations.unknowns), directed=False) if own else (0, np.zeros(0, np.intp))
    order = np.argsort(label, kind="stable")
    bounds = np.concatenate([[0], np.cumsum(np.bincount(label, minlength=count))])
    place = np.zeros(own, np.intp)
    place[order] = np.arange(own) - np.repeat(bounds[:-1], np.diff(bounds))
    numbers = [order[begin:end] for begin, end in itertools.pairwise(bounds)]
    inverses = [_inverse(block) for block in _blocks(inner.tocoo(), label, place, np.diff(bounds))]
    if total == own:
        return Covariance(tuple(zip(numbers, inverses, strict=True)), label, place, np.zeros((0, 0)), np.zeros((own, 0)))
    shares = [inverse @ side[rows] for rows, inverse in zip(numbers, inverses, strict=True)]
    schur = matrix[own:, own:].toarray() - sum(side[rows].T @ share for rows, share in zip(numbers, shares, strict=True))
    border = np.linalg.inv(schur)
    with_border = np.zeros((own, total - own))
    for rows, share in zip(numbers, shares, strict=True):
        with_border[rows] = -share @ border
    parts = tuple((rows, inverse + share @ border @ share.T) for rows, inverse, share in zip(numbers, inverses, shares, strict=True))
    return Covariance(parts, label, place, border, with_border)


def _blocks(matrix: coo_matrix, label: NDArray[np.intp], place: NDArray[np.intp], sizes: NDArray[np.intp]) -> Iterator[csc_matrix | Array]:
    """Yield the blocks of a matrix that falls apart into parts, dense ones where they are small."""
    of_part = label[matrix.row]
    order = np.argsort(of_part, kind="stable")
    row, column, value = place[matrix.row][order], place[matrix.col][order], matrix.data[order]
    bounds = np.concatenate([[0], np.cumsum(np.bincount(of_part, minlength=len(sizes)))])
    for size, begin, end in zip(sizes.tolist(), bounds[:-1], bounds[1:], strict=True):
        entries = (value[begin:end], (row[begin:end], column[begin:end]))
        if size > LARGEST_DENSE:
            yield csc_matrix(entries, shape=(size, size))
        else:
            block = np.zeros((size, size))
            block[entries[1]] = entries[0]
            yield block


def _together(unknowns: Unknowns) -> csc_matrix:
    """Return a matrix (u, u) of the components' unknowns that binds each one's to each other: what nothing observes belongs to its component."""
    own = unknowns.own
    first = np.repeat(unknowns.start, unknowns.count)
    return csc_matrix((np.ones(own), (first, np.arange(own))), shape=(own, own))


def _inverse(matrix: csc_matrix | Array) -> Array:
    """Return the inverse (p, p) of a positive definite matrix, dense or sparse."""
    size = matrix.shape[0]
    if isinstance(matrix, np.ndarray):
        return np.asarray(cho_solve(cho_factor(matrix), np.eye(size)))
    factor = _factor(matrix)
    columns = [factor.solve(np.eye(size, min(COLUMNS, size - first), -first)) for first in range(0, size, COLUMNS)]
    return np.concatenate(columns, axis=1)
