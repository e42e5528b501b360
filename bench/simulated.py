# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulated measurements of pipework whose truth is known exactly: edge maps with noise as photographs have it, but no pictures.

Edge points lie along the visible contours of all components. What they err is the sum of noise that neighbours on an edge share,
of an offset and a trend per curve and image, and of gross errors; stretches are missing and straight edges of other things are there.
Starting values that are off by a known amount and the errors of results belong to it. The pipework itself is :mod:`grown`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from grown import plant, rig, simulated_pipeline, spines
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Tee, moved
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.contour import Contour, contour_of
from pipeworkbench.recon.cylinder import perpendicular_axes
from pipeworkbench.recon.edges import BORDER, EdgeMap, EdgePoints, EdgeSettings, _fill
from pipeworkbench.recon.shapes import shapes_of
from pipeworkbench.recon.topology import join
from pipeworkbench.recon.vectors import across, nearest_on_line, unit
from pipeworkbench.recon.views import View
from pipeworkbench.recon.visibility import hidden

__all__ = [
    "CLUTTER",
    "Errors",
    "Noise",
    "SimulatedEdges",
    "errors",
    "middle_and_axis",
    "perturbed",
    "plant",
    "rig",
    "simulated_edges",
    "simulated_pipeline",
    "simulated_views",
]

CIRCLES = ("face", "back", "hub end", "raised face")
INTERVAL_PX = 1.0  # between edge points
SIGHT_SAMPLES = 5  # edge points that share a line of sight, which tells whether another component hides them
TILE_PX = 324  # of the image, in which lines of sight are cut with the same components
TOUCHING_MM = 1.0  # components that touch do not hide each other's contours
KERNEL_REACH = 5.0  # standard deviations of the smoothing that noise is made with: e^-12 is left out
STRETCH_PX = 12  # of an edge is missing at a time
OUTLIERS_PX = 2.0, 6.0  # how far gross errors are off, to either side
CLUTTER_PX = 30.0, 300.0  # length of other things' edges
CLUTTER = -1  # their component and curve
GRADIENT, CONTRAST, BLUR_PX = 20.0, 60.0, 0.8  # of all edge points: usual ones


@dataclass(frozen=True)
class Noise:
    """What edge points err, all lengths in px.

    Attributes
    ----------
    sigma
        Standard deviation of a single point across the edge.
    smoothing
        Standard deviation of the Gaussian that makes neighbours alike: the correlation of points d apart along the
        edge is exp(-d^2 / (4 smoothing^2)), that of smoothed white noise.
    common
        Standard deviation of an offset that all points of one curve in one image share (calibration, shading); around a circle
        it changes from side to side.
    trend
        Standard deviation of a linear trend along each open curve in each image, at the curve's ends.
    missing
        Share of stretches of 12 px that are not there.
    clutter
        Number of straight edges of other things in each image.
    outliers
        Share of the points that are 2 to 6 px beside their edge.
    """

    sigma: float = 0.1
    smoothing: float = 1.9
    common: float = 0.0
    trend: float = 0.0
    missing: float = 0.0
    clutter: int = 0
    outliers: float = 0.0


@dataclass(frozen=True, eq=False)
class SimulatedEdges:
    """The edge map of one image and what is true of its points, n in number.

    component (n,) row of the component that a point is an edge of, :data:`CLUTTER` for other things; curve (n,) number of its
    curve as `contour_of` counts those of all components in the field of view, :data:`CLUTTER` too; error (n,) px along the
    curve's normal out of the component, with all parts of the noise; outlier (n,) whether it is a gross one; common (c,) px,
    the offset of each curve.
    """

    edges: EdgeMap
    component: NDArray[np.intp]
    curve: NDArray[np.intp]
    error: Array
    outlier: NDArray[np.bool_]
    common: Array


def simulated_views(
    cameras: Sequence[Camera],
    components: Sequence[AnyComponent],
    random: np.random.Generator,
    noise: Noise | None = None,
    brighter: NDArray[np.bool_] | None = None,
) -> tuple[View, ...]:
    """Return views with the edges that cameras see of components.

    Parameters
    ----------
    cameras : sequence of Camera
    components : sequence of Component
        In the cameras' frame; opaque: they hide each other.
    random : Generator
    noise : Noise, optional
    brighter : (k,) array of bool, optional
        Whether each component is brighter than what is behind it; by default by chance, but alike in a run and in all images.
    """
    brighter = brighter_runs(components, random) if brighter is None else brighter
    return tuple(
        # nobody writes to the picture, which has no shading: one value stands for all
        View(
            camera,
            simulated_edges(camera, components, random, noise, brighter).edges,
            np.broadcast_to(np.float32(0), (camera.interior.height, camera.interior.width)),
        )
        for camera in cameras
    )


def simulated_edges(
    camera: Camera, components: Sequence[AnyComponent], random: np.random.Generator, noise: Noise | None, brighter: NDArray[np.bool_]
) -> SimulatedEdges:
    """Return the edges that a camera sees of components; parameters as in :func:`simulated_views`."""
    noise = noise or Noise()
    balls = _balls(components)
    rows = np.flatnonzero(_meet(balls, camera.projection_centre, camera.rotation[2], float(np.arctan(camera.interior.field_radius))))
    components, brighter = [components[row] for row in rows], brighter[rows]
    contour = contour_of(camera, components, INTERVAL_PX, TOUCHING_MM, alternatives=range(len(components)))
    visible = ~contour.hidden & ~_occluded(camera, components, contour, balls[rows])
    rank, count = _ranks(contour.curve)
    curves = len(contour.names)
    common = random.normal(0, noise.common, curves)
    closed = np.isin(np.array(contour.names)[contour.curve], CIRCLES) if curves else np.zeros(0, bool)
    turn = 2 * np.pi * contour.parameter
    # opposite parts of a circle err independently, as both sides of a pipe do
    around = np.column_stack([np.ones(len(turn)), np.cos(turn), np.sin(turn)]) / np.sqrt(2)
    shape = np.where(closed[:, None], around, [1.0, 0.0, 0.0])
    # -1 to 1 along what the image shows of a curve
    along = 2 * rank / np.maximum(count - 1, 1) - 1
    error = noise.sigma * _correlated(contour.curve, noise.smoothing, random)
    error += common[contour.curve] * shape[:, 0] + random.normal(0, noise.trend, curves)[contour.curve] * along * ~closed
    error += np.einsum("nj,nj->n", random.normal(0, noise.common, (curves, 2))[contour.curve], shape[:, 1:])
    outlier = random.uniform(size=len(contour)) < noise.outliers
    error = np.where(outlier, random.uniform(*OUTLIERS_PX, len(contour)) * random.choice([-1.0, 1.0], len(contour)), error)
    there = visible & ~_missing(contour.curve, rank, noise.missing, random)
    sign = np.where(brighter[contour.component], -1.0, 1.0)[:, None]
    position = contour.position + error[:, None] * contour.normal
    on_curves = (position, sign * contour.normal, rows[contour.component], contour.curve, error, outlier)
    both = zip(on_curves, _clutter(camera, random, noise), strict=True)
    position, normal, component, curve, error, outlier = (np.concatenate([one[there], other]) for one, other in both)
    kept = _one_per_pixel(camera, position)
    edges = _edge_map(camera, position[kept], normal[kept], noise)
    return SimulatedEdges(edges, component[kept], curve[kept], error[kept], outlier[kept], common)


def perturbed(components: Sequence[AnyComponent], random: np.random.Generator, position_mm: float, direction_deg: float) -> tuple[AnyComponent, ...]:
    """Return each component moved by exactly ``position_mm`` in a direction of its own and turned by exactly ``direction_deg``.

    It turns about its middle (:func:`middle_and_axis`) and a random axis across its own; its dimensions stay.
    """
    made = []
    for component in components:
        middle, axis = middle_and_axis(component)
        turn = Rotation.from_rotvec(np.radians(direction_deg) * unit(across(random.normal(size=3), axis))).as_matrix()
        there = middle + position_mm * unit(random.normal(size=3))
        motion = np.column_stack([turn, there - turn @ middle])
        made.append(moved(component, (*(tuple(map(float, row)) for row in motion), (0.0, 0.0, 0.0, 1.0))))
    return tuple(made)


@dataclass(frozen=True, eq=False)
class Errors:
    """What components, k in number, are off.

    position (k, 3) mm at the true middle, of pipes only the part across the axis; direction (k, 2) rad, the axis' tilts towards
    the two `perpendicular_axes` of the true axis; turn (k,) rad about the own axis, of elbows and tees, else 0; diameter (k,) mm.
    """

    position: Array
    direction: Array
    turn: Array
    diameter: Array


def errors(components: Sequence[AnyComponent], truth: Sequence[AnyComponent]) -> Errors:
    """Return what components are off from the true ones, which come in the same order."""
    middle, axis = (np.array(x).reshape(-1, 3) for x in zip(*map(middle_and_axis, components), strict=True))
    true_middle, true_axis = (np.array(x).reshape(-1, 3) for x in zip(*map(middle_and_axis, truth), strict=True))
    position = middle - true_middle
    for row, component in enumerate(truth):
        if component.kind == "pipe":
            # a pipe may be longer to one side: what counts is how far its line is from the true middle
            line = nearest_on_line(true_middle[row], middle[row], axis[row])
            position[row] = across(line - true_middle[row], true_axis[row])
    first, second = perpendicular_axes(true_axis)
    cosine = np.einsum("ki,ki->k", axis, true_axis)
    tilts = np.stack([np.einsum("ki,ki->k", axis, first), np.einsum("ki,ki->k", axis, second)], axis=1)
    sine = np.linalg.norm(tilts, axis=1)
    direction = tilts * (np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0))[:, None]
    turn = np.array([_turn(one, other, here) for one, other, here in zip(components, truth, true_axis, strict=True)])
    diameter = np.array([one.outer_diameter - other.outer_diameter for one, other in zip(components, truth, strict=True)])
    return Errors(position, direction, turn, diameter)


def middle_and_axis(component: AnyComponent) -> tuple[Array, Array]:
    """Return the point (3,), mm, that stands for a component's place, and the unit vector (3,) for its direction.

    The middle of a pipe or a reducer; where the axes of an elbow or a tee meet; a flange's face and a cap's weld end. An elbow's
    direction is its chord's from start to end.
    """
    match component:
        case Elbow():
            return np.array(component.intersection), unit(np.subtract(component.end, component.start))
        case Tee():
            return np.array(component.intersection), unit(np.subtract(component.end, component.start))
        case Flange():
            return np.array(component.face), unit(component.axis)
        case Cap():
            return np.array(component.start), unit(component.axis)
        case _:
            return np.add(component.start, component.end) / 2, unit(np.subtract(component.end, component.start))


def brighter_runs(components: Sequence[AnyComponent], random: np.random.Generator) -> NDArray[np.bool_]:
    """Return by chance whether components (k,) are brighter than their background; those that are joined are alike."""
    row = {component.id: number for number, component in enumerate(components)}
    pairs = np.array([(row[joint.a], row[joint.b]) for joint in join(components)], np.intp).reshape(-1, 2)
    graph = coo_array((np.ones(len(pairs), bool), tuple(pairs.T)), shape=(len(components),) * 2)
    count, run = connected_components(graph, directed=False)
    return (random.uniform(size=count) < 0.5)[run]


def _turn(component: AnyComponent, truth: AnyComponent, axis: Array) -> float:
    """Return by how much (rad) an elbow or tee is turned about its own axis (3,), 0 for what looks the same from all sides."""
    name = {"elbow": "start", "tee": "branch_end"}.get(truth.kind)
    if name is None:
        return 0.0
    here, there = (across(np.subtract(getattr(one, name), one.intersection), axis) for one in (truth, component))
    return float(np.arctan2(np.cross(here, there) @ axis, here @ there))


def _balls(components: Sequence[AnyComponent]) -> Array:
    """Return balls (k, 4), centres and radii in mm, around components."""
    made = []
    for component in components:
        axes = spines(component)
        points = np.concatenate([points for points, _ in axes])
        centre = points.mean(axis=0)
        made.append((*centre, np.linalg.norm(points - centre, axis=1).max() + max(diameter for _, diameter in axes) / 2))
    return np.array(made).reshape(-1, 4)


def _meet(balls: Array, centre: Array, direction: Array, angle: float) -> NDArray[np.bool_]:
    """Return which balls (k, 4) reach into the cone from a centre (3,) along a unit direction (3,) with half an opening angle (rad)."""
    sight = balls[:, :3] - centre
    distance = np.linalg.norm(sight, axis=1)
    aside = np.arccos(np.clip(sight @ direction / distance, -1, 1))
    return aside <= angle + np.arcsin(np.minimum(balls[:, 3] / distance, 1.0))


def _occluded(camera: Camera, components: Sequence[AnyComponent], contour: Contour, balls: Array) -> NDArray[np.bool_]:
    """Return which samples (n,) of contours other components hide.

    One line of sight stands for neighbouring samples of a curve. In each tile of the image they are cut only with what reaches into it.
    """
    rank, count = _ranks(contour.curve)
    first = np.flatnonzero(rank % SIGHT_SAMPLES == 0)
    # in the middle of the samples that it stands for
    sample = first + np.minimum(SIGHT_SAMPLES // 2, count[first] - rank[first] - 1)
    centre, shapes = camera.projection_centre, shapes_of(components)
    tile = (contour.position[sample] // TILE_PX).astype(np.intp) @ [camera.interior.height, 1]
    occluded = np.zeros(len(sample), bool)
    for one in np.unique(tile):
        rows = np.flatnonzero(tile == one)
        points = contour.point[sample[rows]]
        sight = (points - centre) / np.linalg.norm(points - centre, axis=1, keepdims=True)
        middle = unit(sight.mean(axis=0))
        angle = float(np.arccos(np.clip(sight @ middle, -1, 1)).max())
        before = shapes.of(_meet(balls, centre, middle, angle))
        _, occluded[rows] = hidden(centre, points, before, contour.component[sample[rows]], TOUCHING_MM)
    return occluded[np.cumsum(rank % SIGHT_SAMPLES == 0) - 1]


def _ranks(curve: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return which sample of its curve each one (n,) is, and how many the curve has; a curve's samples follow each other."""
    _, first, number, count = np.unique(curve, return_index=True, return_inverse=True, return_counts=True)
    return np.arange(len(curve)) - first[number], count[number]


def _correlated(curve: NDArray[np.intp], smoothing: float, random: np.random.Generator) -> Array:
    """Return noise (n,) of standard deviation 1 for samples 1 px apart: smoothed white noise, independent from curve to curve."""
    reach = int(np.ceil(KERNEL_REACH * smoothing))
    if not reach:
        return random.normal(size=len(curve))
    kernel = np.exp(-(np.arange(-reach, reach + 1) ** 2) / (2 * smoothing**2))
    kernel /= np.linalg.norm(kernel)
    # so far apart that no white noise is in two curves
    place = np.arange(len(curve)) + 2 * reach * np.cumsum(np.diff(curve, prepend=curve[:1]) != 0)
    white = random.normal(size=place.max(initial=0) + 2 * reach + 1)
    return np.convolve(white, kernel, mode="valid")[place]


def _missing(curve: NDArray[np.intp], rank: NDArray[np.intp], share: float, random: np.random.Generator) -> NDArray[np.bool_]:
    """Return which samples (n,) lie in stretches that are not there."""
    if not len(curve):
        return np.zeros(0, bool)
    phase = random.integers(STRETCH_PX, size=curve.max() + 1)
    stretch = (rank + phase[curve]) // STRETCH_PX
    begins = (np.diff(stretch, prepend=-1) != 0) | (np.diff(curve, prepend=-1) != 0)
    number = np.cumsum(begins) - 1
    return (random.uniform(size=number[-1] + 1) < share)[number]


def _clutter(camera: Camera, random: np.random.Generator, noise: Noise) -> tuple[NDArray, ...]:
    """Return position, normal (n, 2), component, curve, error and outlier (n,) of points on straight edges of other things."""
    width, height = camera.interior.width, camera.interior.height
    length = random.uniform(*CLUTTER_PX, noise.clutter)
    start, angle = random.uniform((0, 0), (width, height), (noise.clutter, 2)), random.uniform(0, 2 * np.pi, noise.clutter)
    # the direction is by chance, and the polarity with it
    tangent = np.column_stack([np.cos(angle), np.sin(angle)])
    edge = np.repeat(np.arange(noise.clutter), np.rint(length / INTERVAL_PX).astype(int) + 1)
    rank, _ = _ranks(edge)
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])[edge]
    error = noise.sigma * _correlated(edge, noise.smoothing, random)
    position = start[edge] + INTERVAL_PX * rank[:, None] * tangent[edge] + error[:, None] * normal
    none = np.full(len(edge), CLUTTER, np.intp)
    return position, normal, none, none, error, np.zeros(len(edge), bool)


def _one_per_pixel(camera: Camera, position: Array) -> NDArray[np.intp]:
    """Return the rows of points (n, 2) that lie in the image, the first one of each pixel."""
    inside = np.flatnonzero(camera.sees(np.rint(position), BORDER))
    u, v = np.rint(position[inside]).astype(np.intp).T
    _, first = np.unique(v * camera.interior.width + u, return_index=True)
    return inside[np.sort(first)]


def _edge_map(camera: Camera, position: Array, normal: Array, noise: Noise) -> EdgeMap:
    """Return edge points (n, 2) as the detector would; it never claims to be better than its floor."""
    index = np.full((camera.interior.height, camera.interior.width), -1, np.int32)
    pixel = np.rint(position).astype(np.int32)
    _fill(index, pixel, position)
    same = {"gradient": GRADIENT, "contrast": CONTRAST, "blur": BLUR_PX, "smoothing": noise.smoothing}
    same["sigma"] = max(noise.sigma, EdgeSettings().sigma_floor)
    columns = {f.name: np.full(len(position), same[f.name]) for f in fields(EdgePoints) if f.name in same}
    return EdgeMap(position=position, normal=normal, pixel=pixel, index=index, **columns)
