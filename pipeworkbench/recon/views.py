# SPDX-License-Identifier: LGPL-2.1-or-later
"""A camera with its edge map: what every step after edge detection works on."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from pipeworkbench.recon.camera import Camera
from pipeworkbench.recon.edges import EdgeMap, EdgeSettings, detect_edges
from pipeworkbench.recon.station import Station, read_image


@dataclass(frozen=True, eq=False)
class View:
    """An oriented camera and the edges of its image."""

    camera: Camera
    edges: EdgeMap


def views_of(station: Station, settings: EdgeSettings | None = None) -> tuple[View, ...]:
    """Read a station's images and find their edges; the cameras share the processor's cores.

    Raises
    ------
    InputError
        Where an image cannot be read or has another size than the calibration.
    """

    def view(index: int) -> View:
        return View(station.cameras[index], detect_edges(read_image(station, index), settings))

    # two at a time: OpenCV and NumPy release the interpreter lock, and memory stays low
    with ThreadPoolExecutor(max_workers=2) as pool:
        return tuple(pool.map(view, range(len(station.cameras))))
