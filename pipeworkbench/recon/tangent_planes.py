# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tangent planes from clicked pixels: an edge of a pipe in an image and the projection centre span a plane that touches it."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from pipeworkbench.errors import InputError
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.picks import LEAST_LENGTH_PX, SAME_EDGE_PX
from pipeworkbench.recon.tangents import CLICK_SIGMA_PX
from pipeworkbench.recon.vectors import unit

WEIGHTINGS = 2  # of the rays of one plane: how much a pixel is worth depends on the plane, but hardly


@dataclass(frozen=True, eq=False)
class TangentPlane:
    """The plane through a projection centre and an edge of a pipe in the image.

    Attributes
    ----------
    camera : Camera
    normal : (3,) array
        Unit normal, towards the axis of the pipe where ``side_known``, else to either side.
    axes : (2, 3) array
        Unit vectors in the plane: to the middle of the edge and, at right angles, from its first point to its last.
    half_angle : float
        Angle in radians from the middle of the edge to its ends, as seen from the projection centre.
    covariance : (2, 2) array
        Of the normal's components along ``axes``, rad^2: the turn about the second and about the first of them.
    side_known : bool
    residual_rms : float
        Root mean square distance of the points from the plane, px; 0 for two points.
    """

    camera: Camera
    normal: Array
    axes: Array
    half_angle: float
    covariance: Array
    side_known: bool
    residual_rms: float

    @property
    def projection_centre(self) -> Array:
        """The projection centre (3,), a point of the plane, mm."""
        return self.camera.projection_centre

    @property
    def rays(self) -> Array:
        """Unit vectors (2, 3) in the plane to both ends of the edge."""
        return _ends(self.half_angle) @ self.axes

    @property
    def sigma(self) -> float:
        """Standard deviation of the plane across the middle of the edge, radians."""
        return float(np.sqrt(self.covariance[0, 0]))

    def turned(self) -> TangentPlane:
        """Return the same plane with its normal to the other side."""
        return replace(self, normal=-self.normal)

    def towards(self, rays: Array) -> TangentPlane:
        """Return the same plane with its normal to the side of rays (n, 3), which is then known."""
        plane = self if float(np.sum(rays @ self.normal)) > 0 else self.turned()
        return replace(plane, side_known=True)


@dataclass(frozen=True, eq=False)
class ApparentPipe:
    """Both edges of a pipe in one image, as two tangent planes with normals towards the axis."""

    edges: tuple[TangentPlane, TangentPlane]

    @property
    def camera(self) -> Camera:
        """The camera that both edges belong to."""
        return self.edges[0].camera

    @property
    def centre_normal(self) -> Array:
        """Unit normal (3,) of the centre plane, through the projection centre and the axis.

        Navab (2002), the paper's n_e = (n_1 + n_2) / 2 for normals that both point to the same side of the
        picture; those that both point to the axis are subtracted.
        """
        return unit(self.edges[0].normal - self.edges[1].normal)

    @property
    def direction(self) -> Array:
        """Unit direction (3,) of the axis that this image alone gives: where both planes intersect.

        It rests on the edges' convergence, which is weak for thin pipes.
        """
        direction = unit(np.cross(self.edges[0].normal, self.edges[1].normal))
        return direction if direction @ self.edges[0].axes[1] > 0 else -direction


@dataclass(frozen=True, eq=False)
class StackedPlanes:
    """Tangent planes as arrays: normals and centres (k, 3), axes (k, 2, 3), half angles (k,), pixels per radian (k,).

    ``roots`` (k, 2, 2) are the Cholesky factors of the covariances.
    """

    normals: Array
    centres: Array
    axes: Array
    half_angles: Array
    roots: Array
    scale: Array

    @classmethod
    def of(cls, planes: Sequence[TangentPlane]) -> StackedPlanes:
        """Stack planes."""
        return cls(
            np.array([plane.normal for plane in planes]),
            np.array([plane.projection_centre for plane in planes]),
            np.array([plane.axes for plane in planes]),
            np.array([plane.half_angle for plane in planes]),
            np.linalg.cholesky(np.array([plane.covariance for plane in planes])),
            np.array([plane.camera.interior.pixels_per_radian for plane in planes]),
        )

    def on(self, sides: Array) -> StackedPlanes:
        """Return the planes with their normals to these sides (k,): 1 as they are, -1 turned."""
        return replace(self, normals=self.normals * sides[:, None])

    @property
    def ends(self) -> Array:
        """The ends (k, 2, 2) of the edges along their planes' axes."""
        return np.stack([_ends(half_angle) for half_angle in self.half_angles])

    @property
    def rays(self) -> Array:
        """Unit vectors (k, 2, 3) in the planes to both ends of their edges."""
        return self.ends @ self.axes


def tangent_plane(camera: Camera, pixels: ArrayLike, inside: ArrayLike | None = None, sigma_px: ArrayLike = CLICK_SIGMA_PX) -> TangentPlane:
    """Fit the plane through the projection centre to points on one edge, lens distortion included.

    Parameters
    ----------
    camera : Camera
    pixels : (n, 2) array
        Two or more points of the edge: clicks, or the edge points that support a fitted line.
    inside : (2,) array, optional
        A pixel on the pipe: it tells on which side of the edge the pipe is.
    sigma_px : float or (n,) array
        Standard deviation of the points in px.

    Raises
    ------
    InputError
        Where points lie outside the lens' field, or too near together for a direction.
    """
    points = np.asarray(pixels, float).reshape(-1, 2)
    sigmas = np.broadcast_to(np.asarray(sigma_px, float), (len(points),))
    source = f"the edge in camera {camera.name}"
    if len(points) < 2:
        raise InputError(source, "", "has fewer than two points", "click two points far apart on the edge")
    if not (np.isfinite(sigmas) & (sigmas > 0)).all():
        raise InputError(source, "", "the standard deviation of its points is not above zero", "give it in pixels")
    found = camera.rays_with_derivatives(points)
    rays, by_pixel = found.directions, found.by_pixel
    if not np.isfinite(rays).all():
        raise InputError(source, "", "a point has no ray through the lens", "click inside the image")
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    if extent < LEAST_LENGTH_PX:
        raise InputError(source, "", f"its points are only {extent:.1f} px apart", "click two points far apart on the edge")
    weights = 1 / sigmas
    for _ in range(WEIGHTINGS):
        normal = np.linalg.svd(rays * weights[:, None], full_matrices=len(points) < 3)[2][2]
        # a pixel's error moves its ray across the plane by n . (d ray / d pixel)
        weights = 1 / (sigmas * np.linalg.norm(np.einsum("i,nij->nj", normal, by_pixel), axis=1))
    mean = rays.sum(axis=0)
    middle = unit(mean - (mean @ normal) * normal)
    across = np.cross(normal, middle)
    angle = np.arctan2(rays @ across, rays @ middle)
    centre, half_angle = (angle.max() + angle.min()) / 2, (angle.max() - angle.min()) / 2
    axes = np.array([[np.cos(centre), np.sin(centre)], [-np.sin(centre), np.cos(centre)]]) @ [middle, across]
    if axes[1] @ (rays[-1] - rays[0]) < 0:
        axes[1] = -axes[1]
    design = (rays @ axes.T) * weights[:, None]
    rms = float(np.sqrt(np.mean((rays @ normal * weights * sigmas) ** 2)))
    plane = TangentPlane(camera, normal, axes, float(half_angle), np.linalg.inv(design.T @ design), side_known=False, residual_rms=rms)
    if inside is None:
        return plane
    on_pipe = camera.rays(np.asarray(inside, float).reshape(1, 2))
    if not np.isfinite(on_pipe).all():
        raise InputError(source, "", "the point beside it has no ray through the lens", "click on the pipe, inside the image")
    return plane.towards(on_pipe)


def apparent_pipe(
    camera: Camera, first_edge: ArrayLike, second_edge: ArrayLike, sigma_px: ArrayLike | tuple[ArrayLike, ArrayLike] = CLICK_SIGMA_PX
) -> ApparentPipe:
    """Fit the tangent planes of both edges (n, 2), (m, 2) of a pipe in one image: it is between them.

    ``sigma_px`` is the points' standard deviation, or one for each edge as :func:`tangent_plane` takes it.

    Raises
    ------
    InputError
        As :func:`tangent_plane`; where both are the same edge; where the edges cross.
    """
    sigmas = sigma_px if isinstance(sigma_px, tuple) else (sigma_px, sigma_px)
    first, second = (tangent_plane(camera, edge, None, sigma) for edge, sigma in zip((first_edge, second_edge), sigmas, strict=True))
    sides = np.array([second.rays @ first.normal, first.rays @ second.normal])
    if np.abs(sides).max() * camera.interior.pixels_per_radian < SAME_EDGE_PX:
        raise InputError(f"the pipe in camera {camera.name}", "", "both edges are the same edge", "click one edge on each side of the pipe")
    if (sides.min(axis=1) * sides.max(axis=1) <= 0).any():
        raise InputError(f"the pipe in camera {camera.name}", "", "its edges cross in the picture", "click along the pipe on both sides")
    return ApparentPipe((first.towards(second.rays), second.towards(first.rays)))


def planes_of(planes: Sequence[TangentPlane | ApparentPipe]) -> tuple[TangentPlane, ...]:
    """Return all planes in the order given, both of each apparent pipe."""
    return tuple(itertools.chain.from_iterable(p.edges if isinstance(p, ApparentPipe) else (p,) for p in planes))


def _ends(half_angle: float) -> Array:
    """Return the ends (2, 2) of an edge along its plane's axes."""
    return np.array([[np.cos(half_angle), -np.sin(half_angle)], [np.cos(half_angle), np.sin(half_angle)]])
