# SPDX-License-Identifier: LGPL-2.1-or-later
"""A camera with its edge map: what every step after edge detection works on."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Camera
from pipeworkbench.recon.edges import EdgeMap, EdgeSettings, detect_edges
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.station import Station

MOST_ROWS = 32000  # OpenCV takes no more than 32767 at a time
SHADING_SIGMA_PX = 1.5  # smoothing of the image where only its shading matters


@dataclass(frozen=True, eq=False)
class View:
    """An oriented camera, the edges of its image and the image itself, smoothed (height, width), for its shading."""

    camera: Camera
    edges: EdgeMap
    smooth: NDArray[np.float32]


def brightness_at(view: View, position: NDArray[Any], inside: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Return the smoothed image's values (..., m) at pixels (..., m, 2), NaN where they are not ``inside`` (..., m)."""
    import cv2

    table = np.where(inside[..., None], position, 0).astype(np.float32).reshape(-1, *position.shape[-2:])
    grey = np.empty(table.shape[:2], np.float32)
    for first in range(0, len(table), MOST_ROWS):
        rows = slice(first, first + MOST_ROWS)
        grey[rows] = cv2.remap(view.smooth, table[rows], None, cv2.INTER_LINEAR)
    return np.where(inside, grey.reshape(inside.shape), np.float32(np.nan))


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
    with ThreadPoolExecutor(max_workers=2) as pool:
        return tuple(pool.map(view, range(len(station.cameras))))
