# SPDX-License-Identifier: LGPL-2.1-or-later
"""Why a pick gives no pipe: what its geometry and the images say against it, in the user's words.

Each function returns a sentence without a full stop that says what is wrong with the pick and how to mend it,
or nothing where it finds nothing wrong.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.cylinder import Cylinder, outlines
from pipeworkbench.recon.match import match
from pipeworkbench.recon.pick_settings import PickSettings, sizes_in
from pipeworkbench.recon.picks import PipePick
from pipeworkbench.recon.plane_cylinders import TangentSettings, best_pair, intersection_angles, names_of
from pipeworkbench.recon.tangents import CLICK_SIGMA_PX, PipeTangents
from pipeworkbench.recon.views import View

DEPTHS = 40  # tried over the working range, evenly in inverse depth as the parallax is
SAMPLES = 60  # along either edge of what was found
REACH_PX = 1.5  # from a contour to the edge that is its own
SEEN = 0.35  # part of an edge's samples from which on an image shows it
HARDLY_SEEN = 0.2  # part from which on it says anything about where the edge is
ABSENT = 0.15  # part up to which it does not show it: about what a contour meets by chance
LEAST_ANGLE_DEG = TangentSettings().least_angle_deg  # between the planes through an axis and two cameras


def size_problem(pick: PipePick, tangents: PipeTangents, settings: PickSettings, pixels_per_radian: float) -> str:
    """Return why no diameter in question fits between the clicked edges anywhere in the working range."""
    near, far = settings.working_range
    low, high = settings.diameter_range
    if isinstance(pick.diameter, float):
        if not low <= pick.diameter <= high:
            return f"its diameter of {pick.diameter:g} mm is outside the range of {low:g} to {high:g} mm; widen the range of diameters"
        low = high = pick.diameter
    elif pick.diameter is None:
        sizes = [size.outer_diameter for size in sizes_in(settings)]
        if not sizes:
            return f"the range of {low:g} to {high:g} mm holds no diameter of EN 10220; widen the range of diameters, or pick it as free"
        low, high = sizes[0], sizes[-1]
    width = 2 * tangents.half_width * pixels_per_radian
    slack = 1 + settings.tolerance + 4 * tangents.sigma_px / width
    thinnest, thickest = (2 * distance * float(np.sin(tangents.half_width)) for distance in (near, far))
    wanted = f"its diameter is {low:g} mm" if low == high else f"the diameters in question are {low:g} to {high:g} mm"
    room = f"a pipe between them would be {thinnest:.0f} to {thickest:.0f} mm thick at {near:g} to {far:g} mm from the camera, but {wanted}"
    remedy = "click the two edges of one pipe, or widen the range of distances or of diameters"
    if thinnest > slack * high:
        return f"the edges are {width:.0f} px apart, too far: {room}; {remedy}"
    if thickest * slack < low:
        return f"the edges are {width:.0f} px apart, too near: {room}; {remedy}"
    return ""


def place_problem(views: Sequence[View], pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> str:
    """Return why no other camera can have the pipe in its image, wherever in the working range it is."""
    camera = views[pick.camera].camera
    others = [view.camera for number, view in enumerate(views) if number != pick.camera]
    if not others:
        return "the station has one camera only; give another photograph of the pipe"
    points = _along_the_view(camera, tangents, settings)
    if any(other.sees(other.project(points)).any() for other in others):
        return ""
    behind = all(((points - other.projection_centre) @ other.rotation[2] <= 0).all() for other in others)
    where = "behind" if behind else "outside the images of"
    return f"at every distance of the working range the pipe is {where} {names_of(others)}; pick a pipe that two cameras see, or widen the range"


def plane_problem(views: Sequence[View], pick: PipePick, tangents: PipeTangents, settings: PickSettings) -> str:
    """Return how the cameras and the pipe lie in one plane, so that its distance cannot be measured.

    A pipe of a known diameter needs no second direction. The plane through the picked camera and the axis is
    known from the pick: whether the others lie in it does not depend on how deep the axis is, only the angles
    do, which are largest at the near end of the working range.
    """
    if isinstance(pick.diameter, float):
        return ""
    camera = views[pick.camera].camera
    points = _along_the_view(camera, tangents, settings)
    seeing = [view.camera for view in views if view.camera is camera or view.camera.sees(view.camera.project(points)).any()]
    axis = Cylinder(camera.projection_centre + settings.working_range[0] * tangents.middle, tangents.across, 1.0)
    return _degenerate(axis, seeing, [view.camera for view in views])


def found_plane_problem(views: Sequence[View], pick: PipePick, cylinder: Cylinder, extent: tuple[float, float]) -> str:
    """Return how the cameras that show what was found lie in one plane with it."""
    if isinstance(pick.diameter, float):
        return ""
    shares = shares_seen(views, cylinder, extent)
    # with one edge and the diameter an image says where the axis is
    showing = np.flatnonzero(np.nan_to_num(shares).max(axis=1) >= HARDLY_SEEN)
    seeing = [view.camera for number, view in enumerate(views) if number in showing or number == pick.camera]
    return _degenerate(cylinder, seeing, [view.camera for view in views]) if len(seeing) > 1 else ""


def one_sided_problem(views: Sequence[View], pick: PipePick, cylinder: Cylinder, extent: tuple[float, float]) -> str:
    """Return that the other images show one edge of what was found only, as those of a wall do."""
    shares = np.delete(shares_seen(views, cylinder, extent), pick.camera, axis=0)
    shares = shares[np.isfinite(shares).all(axis=1)]
    if not len(shares) or not (shares.max(axis=0).min() <= ABSENT and shares.max() >= SEEN):
        return ""
    return "the other images show one of its edges only, it may be the edge of a wall; click both edges of a pipe where two cameras see them"


def no_fit(views: Sequence[View], pick: PipePick, tangents: PipeTangents) -> str:
    """Return what to say where nothing that could be a pipe fits the images."""
    if tangents.sigma_px >= np.hypot(CLICK_SIGMA_PX, CLICK_SIGMA_PX) - 1e-9:
        return "no image edges run along the clicked lines; click both edges of the pipe, where they are clear"
    if tangents.sigma_px >= CLICK_SIGMA_PX:
        return "no image edge runs along one of the clicked lines; click both edges of the pipe, where they are clear"
    others = names_of([view.camera for number, view in enumerate(views) if number != pick.camera])
    return f"no pipe between the clicked edges fits the images of {others}; click both edges of one pipe, where those see it too"


def shares_seen(views: Sequence[View], cylinder: Cylinder, extent: tuple[float, float]) -> Array:
    """Return which part of either edge's samples has an image edge (views, 2); NaN where the image does not contain it."""
    along = np.linspace(*extent, SAMPLES)
    shares = np.full((len(views), 2), np.nan)
    for number, view in enumerate(views):
        position, normal = (x[0] for x in outlines(view.camera, cylinder.as_many(), along[None]))
        visible = np.isfinite(position[..., 0])
        if visible.sum(axis=1).min() < SEEN * SAMPLES:
            continue
        found = match(view.edges, position.reshape(-1, 2), normal.reshape(-1, 2), REACH_PX).found.reshape(2, -1)
        shares[number] = (found & visible).sum(axis=1) / visible.sum(axis=1)
    return shares


def _along_the_view(camera: Camera, tangents: PipeTangents, settings: PickSettings) -> Array:
    """Return points (3 * DEPTHS, 3) of the clicked part of the axis over the working range."""
    near, far = settings.working_range
    depths = 1 / np.linspace(1 / far, 1 / near, DEPTHS)
    rays = np.array([tangents.middle, *tangents.end_rays])
    return np.asarray(camera.projection_centre + (depths[:, None, None] * rays).reshape(-1, 3))


def _degenerate(axis: Cylinder, seeing: Sequence[Camera], cameras: Sequence[Camera]) -> str:
    """Say that an axis lies in one plane with the cameras that see it, and which pair would do."""
    least = np.radians(LEAST_ANGLE_DEG)
    angle = float(intersection_angles(seeing, axis).max())
    if angle >= least:
        return ""
    pair = best_pair(cameras, axis)
    if pair.angle >= least:
        works = names_of([cameras[pair.first], cameras[pair.second]]).removeprefix("cameras ")
        missing = [cameras[number] for number in (pair.first, pair.second) if all(cameras[number] is not camera for camera in seeing)]
        remedy = f"the camera pair that still works is {works}: pick it where {names_of(missing)} shows it too"
    else:
        remedy = "no camera pair of the station works: give its diameter, or photograph it with a base across it"
    return (
        f"degenerate: the pipe lies in one plane with {names_of(seeing)}, so its distance cannot be measured with them"
        f" (their directions to it differ by {np.degrees(angle):.2g} deg); {remedy}"
    )
