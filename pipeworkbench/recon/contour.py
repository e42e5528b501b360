# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a camera sees of components: apparent contours and sharp edges, sampled in distorted pixels.

A smooth surface's contour is where the line of sight touches it: with the projection centre P, a surface
point X and its normal N, N (X - P) = 0. For the surfaces of pipework that is closed form:

- frustum (pipe, rim, neck), X = A + x a + (r + k x) e(phi), N ~ e - k a: with w = P - A the condition
  is w e(phi) = r + k w a, two values of phi, thus two straight lines;
- torus (elbow), X = C + R e(phi) + r N, N = cos(psi) e(phi) + sin(psi) a: with w = P - C it is
  (w e(phi) - R) cos(psi) + (w a) sin(psi) = r, two values of psi for each phi, thus two curves.

The image's normal n follows from N without differentiating the curve: n J = gain N with the derivative J
of the projection, because all directions of the tangent plane project onto the contour's tangent.
That holds at a contour's cusps too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.pipeline import AnyComponent
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.shapes import Shapes, shapes_of
from pipeworkbench.recon.visibility import hidden

INTERVAL_PX = 3.0  # the paper's s
TOUCHING_MM = 10.0  # another component hides a sample only where it is nearer by more than this
COARSE = 129  # points per curve with which its length in the image is measured
LINE, TORUS, CIRCLE = 0, 1, 2  # kinds of curves
# what circles begin beside: no component's axis but by chance, so that where they begin changes little when they turn a little
OBLIQUE = np.array([0.48, 0.64, 0.6])
PARALLEL = 1e-3  # sine of the angle to it below which there is no such direction


@dataclass(frozen=True, eq=False)
class Contour:
    """Samples of contours in one image, n of all components together.

    Attributes
    ----------
    component : (n,) array
        Row of the component that a sample belongs to.
    curve : (n,) array
        Number of the curve; a curve's samples follow each other. ``names[curve]`` says what it is: "pipe",
        "branch", "cone", "cap", "elbow", "rim", "neck" (outlines), "face", "back", "hub end" (circles), "raised face" (both).
    parameter : (n,) array
        0 to 1 along the curve: from a component's start to its end, from a flange's face to its back, or around.
    position, tangent, normal : (n, 2) arrays
        Pixels; unit vectors in the image; the normal points away from the component.
    point : (n, 3) array
        The point in space, mm.
    outward : (n, 3) array
        Unit normal of the plane through the line of sight and the curve's tangent; the surface's normal on outlines.
    gain : (n,) array
        Pixels along ``normal`` per mm along ``outward``.
    hidden : (n,) array of bool
        Whether the component itself lies before the sample.
    occluded : (n,) array of bool
        Whether another component lies before it.
    names : tuple of str
    """

    component: NDArray[np.intp]
    curve: NDArray[np.intp]
    parameter: Array
    position: Array
    tangent: Array
    normal: Array
    point: Array
    outward: Array
    gain: Array
    hidden: NDArray[np.bool_]
    occluded: NDArray[np.bool_]
    names: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.curve)

    def __getitem__(self, rows: NDArray[np.bool_] | NDArray[np.intp] | slice) -> Contour:
        return Contour(**{f.name: getattr(self, f.name) if f.name == "names" else getattr(self, f.name)[rows] for f in fields(self)})

    @property
    def visible(self) -> NDArray[np.bool_]:
        """Which samples (n,) nothing hides."""
        return ~(self.hidden | self.occluded)


def contour_of(
    camera: Camera,
    components: Sequence[AnyComponent],
    interval: float = INTERVAL_PX,
    touching: float = TOUCHING_MM,
    alternatives: Sequence[int] | None = None,
    coarse: int = COARSE,
) -> Contour:
    """Return what a camera sees of components, sampled every ``interval`` pixels inside the image.

    Parameters
    ----------
    camera : Camera
    components : sequence of Pipe, Elbow, Flange
        In the camera's (the station's) frame; all of them hide each other.
    interval : float
        The paper's s (Sect. 4.1), px.
    touching : float
        Another component hides a sample only where it is nearer by more than this (mm).
    alternatives : sequence of int, optional
        Number of the alternative that each component belongs to: those of different ones do not hide each other.
    coarse : int
        Points per curve with which its length in the image is measured; few do for small components that are wholly in it.

    Raises
    ------
    InputError
        Where a component has no such geometry.
    """
    return contour_of_shapes(camera, shapes_of(components), interval, touching, alternatives, coarse)


def contour_of_shapes(
    camera: Camera,
    shapes: Shapes,
    interval: float = INTERVAL_PX,
    touching: float = TOUCHING_MM,
    alternatives: Sequence[int] | None = None,
    coarse: int = COARSE,
    *,
    steady: bool = False,
    stride: int = 1,
) -> Contour:
    """Do what :func:`contour_of` does for the surfaces of components; ``steady`` as in :func:`curves_of`.

    Where samples that are ``stride`` apart are both seen, or hidden by the same, those between them are taken to be so, too.
    """
    curves = curves_of(shapes, camera.projection_centre, steady=steady)
    curve, parameter = _spaced(camera, curves, interval, coarse)
    seen = curves.seen_by(camera, curve, parameter)
    # a curve's first and last sample may lie a little outside
    inside = camera.sees(seen.position)
    curve, parameter = curve[inside], parameter[inside]
    seen = CurveSamples(*(getattr(seen, f.name)[inside] for f in fields(seen)))
    owner = curves.owner[curve]
    number = None if alternatives is None else np.asarray(alternatives, np.intp)

    def hiding(rows: NDArray[np.intp]) -> NDArray[np.bool_]:
        return np.stack(hidden(camera.projection_centre, seen.point[rows], shapes, owner[rows], touching, number), axis=1)

    by_itself, by_others = _sparsely(hiding, curve, stride).T
    tangent = np.column_stack([-seen.normal[:, 1], seen.normal[:, 0]])
    return Contour(
        owner, curve, parameter, seen.position, tangent, seen.normal, seen.point, seen.outward, seen.gain, by_itself, by_others, curves.names
    )


def _sparsely(ask: Callable[[NDArray[np.intp]], NDArray[np.bool_]], curve: NDArray[np.intp], stride: int) -> NDArray[np.bool_]:
    """Return what ``ask`` says of the rows of samples (n,) of curves, (n, k), asked of every so manieth and wherever two of these differ."""
    count = len(curve)
    if stride == 1 or not count:
        return ask(np.arange(count))
    begins = np.flatnonzero(np.diff(curve, prepend=-1))
    ends = np.append(begins[1:], count) - 1
    rank = np.arange(count) - np.repeat(begins, ends - begins + 1)
    first = rank % stride == 0
    first[ends] = True
    rows = np.flatnonzero(first)
    answers = ask(rows)
    # the last that was asked before each one, and the next one
    before = np.cumsum(first) - 1
    same = (answers[before] == answers[np.minimum(before + 1, len(rows) - 1)]).all(axis=1) | first
    result = answers[before]
    result[~same] = ask(np.flatnonzero(~same))
    return result


@dataclass(frozen=True, eq=False)
class CurveSamples:
    """Samples of curves as one camera sees them, in arrays of one length m: what :class:`Contour` says of them."""

    position: Array
    normal: Array
    point: Array
    outward: Array
    gain: Array


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves of all kinds, c in number; what a kind has no use for is zero.

    kind, owner (c,); origin, axis, first, second (c, 3): a point and a frame; radius, tube (c,): radii of a
    circle or torus; begin, range (c,): values of the curve's own parameter, mm or rad; side (c,) +1 or -1;
    centre (3,) the projection centre.
    """

    kind: NDArray[np.intp]
    owner: NDArray[np.intp]
    origin: Array
    axis: Array
    first: Array
    second: Array
    radius: Array
    tube: Array
    begin: Array
    range: Array
    side: Array
    centre: Array
    names: tuple[str, ...]

    def at(self, curve: NDArray[np.intp], parameter: Array) -> tuple[Array, Array]:
        """Return points and outward normals (m, 3) of curves at parameters (m,) from 0 to 1."""
        points, outward = np.full((len(curve), 3), np.nan), np.full((len(curve), 3), np.nan)
        value = self.begin[curve] + parameter * self.range[curve]
        for kind, evaluate in ((LINE, self._line), (TORUS, self._torus), (CIRCLE, self._circle)):
            rows = np.flatnonzero(self.kind[curve] == kind)
            if len(rows):
                points[rows], outward[rows] = evaluate(curve[rows], value[rows, None])
        return points, outward

    def seen_by(self, camera: Camera, curve: NDArray[np.intp], parameter: Array) -> CurveSamples:
        """Return what the camera at ``centre`` sees of curves (m,) at parameters (m,) from 0 to 1."""
        point, outward = self.at(curve, parameter)
        position, derivative = camera.project_with_derivative(point)
        normal, gain = image_normal(derivative, outward)
        return CurveSamples(position, normal, point, outward, gain)

    def _line(self, c: NDArray[np.intp], along: Array) -> tuple[Array, Array]:
        return self.origin[c] + along * self.axis[c], self.first[c]

    def _torus(self, c: NDArray[np.intp], angle: Array) -> tuple[Array, Array]:
        radial = np.cos(angle) * self.first[c] + np.sin(angle) * self.second[c]
        to_camera = self.centre - self.origin[c]
        a = np.einsum("mi,mi->m", to_camera, radial) - self.radius[c]
        b = np.einsum("mi,mi->m", to_camera, self.axis[c])
        with np.errstate(invalid="ignore"):
            turn = np.arctan2(b, a) + self.side[c] * np.arccos(self.tube[c] / np.hypot(a, b))
        normal = np.cos(turn)[:, None] * radial + np.sin(turn)[:, None] * self.axis[c]
        return self.origin[c] + self.radius[c, None] * radial + self.tube[c, None] * normal, normal

    def _circle(self, c: NDArray[np.intp], angle: Array) -> tuple[Array, Array]:
        radial = np.cos(angle) * self.first[c] + np.sin(angle) * self.second[c]
        tangent = np.cos(angle) * self.second[c] - np.sin(angle) * self.first[c]
        point = self.origin[c] + self.radius[c, None] * radial
        with np.errstate(invalid="ignore", divide="ignore"):
            outward = np.cross(point - self.centre, tangent)
            outward /= np.linalg.norm(outward, axis=1, keepdims=True)
        return point, outward * np.where(np.einsum("mi,mi->m", outward, radial) < 0, -1.0, 1.0)[:, None]


def curves_of(shapes: Shapes, centre: Array, *, steady: bool = False) -> Curves:
    """Return the contour and edge curves of surfaces for a projection centre (3,).

    Where a circle begins leaps when its axis passes from one coordinate plane's side to another's; ``steady`` circles begin where
    they did a moment ago, for who follows samples while components move.
    """
    frustums, tori, edges = shapes.frustums, shapes.tori, shapes.edges
    first, second = perpendicular_axes(frustums.axis)
    to_camera = centre - frustums.start
    slope = (frustums.radius[:, 1] - frustums.radius[:, 0]) / frustums.length
    u, v = np.einsum("ki,ki->k", to_camera, first), np.einsum("ki,ki->k", to_camera, second)
    height = frustums.radius[:, 0] + slope * np.einsum("ki,ki->k", to_camera, frustums.axis)
    lines = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for side in (1.0, -1.0):
            angle = (np.arctan2(v, u) + side * np.arccos(height / np.hypot(u, v)))[:, None]
            radial = np.cos(angle) * first + np.sin(angle) * second
            normal = (radial - slope[:, None] * frustums.axis) / np.sqrt(1 + slope**2)[:, None]
            direction = frustums.axis + slope[:, None] * radial
            lines.append((frustums.start + frustums.radius[:, :1] * radial, direction, normal))
    origin, direction, normal = (np.concatenate(x) for x in zip(*lines, strict=True))
    edge_first, edge_second = _beside(edges.axis) if steady else perpendicular_axes(edges.axis)
    count = np.array([2 * len(frustums), 2 * len(tori), len(edges)])

    def stacked(line: Array | float, torus: Array | float, circle: Array | float) -> Array:
        shape = next((np.shape(x)[1:] for x in (line, torus, circle) if np.ndim(x) > 1), ())
        return np.concatenate([np.broadcast_to(x, (n, *shape)) for x, n in zip((line, torus, circle), count, strict=True)])

    def twice(values: NDArray[Any]) -> NDArray[Any]:
        return np.concatenate([values, values])

    curves = Curves(
        kind=np.repeat([LINE, TORUS, CIRCLE], count),
        owner=np.concatenate([twice(frustums.owner), twice(tori.owner), edges.owner]),
        origin=stacked(origin, twice(tori.centre), edges.centre),
        axis=stacked(direction, twice(tori.axis), edges.axis),
        first=stacked(normal, twice(tori.first), edge_first),
        second=stacked(normal, twice(tori.second), edge_second),
        radius=stacked(0.0, twice(tori.bend_radius), edges.radius),
        tube=stacked(0.0, twice(tori.tube_radius), 0.0),
        begin=np.zeros(count.sum()),
        range=stacked(twice(frustums.length), twice(tori.angle), 2 * np.pi),
        side=stacked(0.0, np.repeat([1.0, -1.0], len(tori)), 0.0),
        centre=centre,
        names=(*shapes.part, *shapes.part, *("elbow",) * (2 * len(tori)), *shapes.edge_part),
    )
    # a component's curves follow each other
    order = np.argsort(curves.owner, kind="stable")
    sorted_fields = {f.name: getattr(curves, f.name)[order] for f in fields(curves) if f.name not in ("centre", "names")}
    return Curves(**sorted_fields, centre=centre, names=tuple(curves.names[i] for i in order))


def _beside(axes: Array) -> tuple[Array, Array]:
    """Return unit vectors (k, 3) that make right-handed frames with axes (k, 3) and, unlike `perpendicular_axes`, turn steadily with them."""
    first = np.cross(axes, OBLIQUE)
    sine = np.linalg.norm(first, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        first = np.where(sine > PARALLEL, first / sine, perpendicular_axes(axes)[0])
    return first, np.cross(axes, first)


def _spaced(camera: Camera, curves: Curves, interval: float, coarse: int) -> tuple[NDArray[np.intp], Array]:
    """Return curve numbers and parameters (n,) of samples that lie ``interval`` pixels apart in the image."""
    count = len(curves.owner)
    if not count:
        return np.zeros(0, np.intp), np.zeros(0)
    number, grid = np.arange(count), np.linspace(0, 1, coarse)
    parameter = np.tile(grid, (count, 1))
    for narrowing in (True, False):
        points, _ = curves.at(np.repeat(number, coarse), parameter.ravel())
        position = camera.project(points)
        inside = camera.sees(position).reshape(count, coarse)
        if narrowing:
            # the same number of points where the curve is in the image: it may leave it soon
            first = np.maximum(inside.argmax(axis=1) - 1, 0)
            last = np.minimum(coarse - inside[:, ::-1].argmax(axis=1), coarse - 1)
            low, high = parameter[number, first], parameter[number, last]
            parameter = low[:, None] + (high - low)[:, None] * grid
    position = np.where(inside[:, :, None], position.reshape(count, coarse, 2), np.nan)
    # what is not in the image has no length, so that no samples fall there
    steps = np.nan_to_num(np.linalg.norm(np.diff(position, axis=1), axis=2))
    length = np.concatenate([np.zeros((count, 1)), np.cumsum(steps, axis=1)], axis=1)
    total = length[:, -1]
    samples = np.where(total > 0, np.maximum(np.rint(total / interval), 1).astype(np.intp) + 1, 0)
    curve = np.repeat(np.arange(count), samples)
    # one interpolation for all curves: lengths laid end to end, with a gap between curves
    start = np.concatenate([[0.0], np.cumsum(total + 1.0)[:-1]])
    rank = np.arange(len(curve)) - np.repeat(np.cumsum(samples) - samples, samples)
    wanted = start[curve] + total[curve] * rank / np.maximum(samples[curve] - 1, 1)
    rising = (length + start[:, None]).ravel() + np.arange(count * coarse) * 1e-12
    found = np.interp(wanted, rising, parameter.ravel())
    return curve, np.clip(found, 0.0, 1.0)


def image_normal(derivative: Array, outward: Array) -> tuple[Array, Array]:
    """Return unit normals (n, 2) and gains (n,) with normal J = gain outward, for derivatives J (n, 2, 3)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        seen = np.einsum("nij,nj->ni", derivative, outward)
        (a, b), (_, d) = np.moveaxis(np.einsum("nij,nkj->nik", derivative, derivative), 0, -1)
        # the inverse of the symmetric J J^T, but for its determinant, which falls out
        normal = np.column_stack([d * seen[:, 0] - b * seen[:, 1], a * seen[:, 1] - b * seen[:, 0]])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return normal, np.einsum("ni,ni->n", normal, seen)
