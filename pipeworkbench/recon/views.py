# SPDX-License-Identifier: LGPL-2.1-or-later
"""A camera with its edge map: what every step after edge detection works on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.edges import EdgeMap, EdgeSettings, detect_edges
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.station import Station
from pipeworkbench.recon.threads import thread_count

MOST_ROWS = 32000  # OpenCV takes no more than 32767 at a time
SAMPLES = 16384  # of the brightness, at a time: they stay in the processor's cache
SHADING_SIGMA_PX = 1.5  # smoothing of the image where only its shading matters


@dataclass(frozen=True, eq=False)
class View:
    """An oriented camera, the edges of its image and the image itself, smoothed (height, width), for its shading."""

    camera: Camera
    edges: EdgeMap
    smooth: NDArray[np.float32]


def brightness_at(view: View, u: NDArray[np.float32], v: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the smoothed image's values (k, m) at pixels with columns u and rows v (k, m), NaN where they are not in the image."""
    import cv2

    height, width = view.smooth.shape
    inside = (u >= 0) & (u <= width - 1) & (v >= 0) & (v <= height - 1)
    whole = bool(inside.all())
    if not whole:
        u, v = np.where(inside, u, np.float32(0)), np.where(inside, v, np.float32(0))
    grey = np.empty(u.shape, np.float32)
    for first in range(0, len(u), MOST_ROWS):
        rows = slice(first, first + MOST_ROWS)
        grey[rows] = cv2.remap(view.smooth, u[rows], v[rows], cv2.INTER_LINEAR)
    return grey if whole else np.where(inside, grey, np.float32(np.nan))


def brightness_between(view: View, nodes: Array, weights: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the smoothed image's values (k, n) on surfaces of which points (k, m, 3) are given, NaN where they are not in the image.

    Only these nodes are projected; ``weights`` (m, n) interpolate between them in the image.
    """
    count, nodes_each = nodes.shape[:2]
    u, v = view.camera.project(nodes.reshape(-1, 3)).astype(np.float32).T.reshape(2, count, nodes_each)
    grey = np.empty((count, weights.shape[1]), np.float32)
    step = max(1, SAMPLES // weights.shape[1])
    for first in range(0, count, step):
        rows = slice(first, first + step)
        grey[rows] = brightness_at(view, u[rows] @ weights, v[rows] @ weights)
    return grey


def view_of(camera: Camera, image: NDArray[np.uint8] | NDArray[np.uint16], settings: EdgeSettings | None = None) -> View:
    """Find the edges of a camera's grey image (height, width)."""
    import cv2

    return View(camera, detect_edges(image, settings), cv2.GaussianBlur(image.astype(np.float32), (0, 0), SHADING_SIGMA_PX))


def views_of(station: Station, settings: EdgeSettings | None = None) -> tuple[View, ...]:
    """Read a station's images and find their edges; the cameras share the processor's cores.

    Raises
    ------
    InputError
        Where an image cannot be read or has another size than the calibration.
    """

    def view(index: int) -> View:
        return view_of(station.cameras[index], read_image(station, index), settings)

    # two at a time: OpenCV and NumPy release the interpreter lock, and memory stays low
    with ThreadPoolExecutor(thread_count(2)) as pool:
        return tuple(pool.map(view, range(len(station.cameras))))


def views_by_station(stations: Sequence[Station], progress: Callable[[str, int, int], None]) -> dict[str, tuple[View, ...]]:
    """Return the views of stations by their names; ``progress`` is told which station, how many are done and how many there are.

    Raises
    ------
    InputError
        Where an image cannot be read or has another size than the calibration.
    """
    views = {}
    for number, station in enumerate(stations):
        progress(f"finding edges of station {station.name}", number, len(stations))
        views[station.name] = views_of(station)
    return views
