# SPDX-License-Identifier: LGPL-2.1-or-later
"""The photographs side by side with the back-projected contours drawn on them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.files import written_whole
from pipeworkbench.pipeline import Pipe, Pipeline
from pipeworkbench.recon.camera import Array, Camera
from pipeworkbench.recon.cylinder import Cylinder, contour
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.station import Station

PICTURE_WIDTH = 1296  # px of each photograph in the picture
SAMPLES = 200  # along a pipe; its edges are curves where the lens distorts
SUBPIXEL_BITS = 4  # of OpenCV's fixed-point drawing coordinates
# red, green, blue; told apart by colour-blind people too (Okabe and Ito), but for the last
COLOURS = ((86, 180, 233), (230, 159, 0), (0, 158, 115), (240, 228, 66), (213, 94, 0), (204, 121, 167), (120, 190, 255))
GREY_PERCENTILES = (0.5, 99.5)  # dim photographs are stretched to this range for the eye


def write_picture(pipeline: Pipeline, stations: Sequence[Station], path: Path) -> None:
    """Write a PNG: a row per station, a column per camera.

    Raises
    ------
    InputError
        Where no station is at hand.
    """
    import cv2

    shown = [station for station in stations if station.name in pipeline.stations]
    if not shown:
        raise InputError(path, "", "a picture needs the station's photographs", "name the station's folder")
    rows = []
    for station in shown:
        level_from_frame = np.linalg.inv(np.array(pipeline.stations[station.name].frame_from_level))
        panels = [annotated(station, index, pipeline, level_from_frame) for index in range(len(station.cameras))]
        height = max(panel.shape[0] for panel in panels)
        rows.append(np.hstack([np.pad(panel, ((0, height - panel.shape[0]), (0, 8), (0, 0))) for panel in panels]))
    width = max(row.shape[1] for row in rows)
    picture = np.vstack([np.pad(row, ((0, 8), (0, width - row.shape[1]), (0, 0))) for row in rows])
    good, data = cv2.imencode(".png", picture)
    if not good:
        raise InputError(path, "", "the picture could not be encoded", "use smaller photographs")
    with written_whole(path) as temporary:
        temporary.write_bytes(data.tobytes())


def annotated(station: Station, index: int, pipeline: Pipeline, level_from_frame: Array) -> NDArray[np.uint8]:
    """Return a camera's photograph (height, width, 3) BGR with the contours of all pipes."""
    import cv2

    camera = station.cameras[index]
    grey = read_image(station, index).astype(np.float32)
    low, high = np.percentile(grey[::7, ::7], GREY_PERCENTILES)
    grey = np.clip((grey - low) * (255 / max(high - low, 1)), 0, 255).astype(np.uint8)
    scale = min(1.0, PICTURE_WIDTH / grey.shape[1])
    small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    canvas = cv2.cvtColor(small, cv2.COLOR_GRAY2BGR)
    for number, pipe in enumerate(pipeline.pipes):
        red, green, blue = COLOURS[number % len(COLOURS)]
        _draw_pipe(canvas, camera, pipe, level_from_frame, scale, (blue, green, red))
    cv2.putText(canvas, f"{station.name} / {camera.name}", (12, 30), cv2.FONT_HERSHEY_SIMPLEX, 0.8, (255, 255, 255), 2, cv2.LINE_AA)
    return np.asarray(canvas, np.uint8)


def _draw_pipe(canvas: Any, camera: Camera, pipe: Pipe, level_from_frame: Array, scale: float, colour: tuple[int, int, int]) -> None:
    import cv2

    ends = np.array([pipe.start, pipe.end]) @ level_from_frame[:3, :3].T + level_from_frame[:3, 3]
    direction = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    cylinder = Cylinder(ends[0], direction, pipe.outer_diameter / 2)
    position = contour(camera, cylinder, np.linspace(0, pipe.length, SAMPLES)).position[0]

    def polyline(points: Array) -> None:
        # pixel centres at integers on both scales: shift by half a pixel before and after scaling
        drawn = ((points + 0.5) * scale - 0.5) * 2**SUBPIXEL_BITS
        known = np.isfinite(drawn).all(axis=1)
        for part in np.split(np.flatnonzero(known), np.flatnonzero(np.diff(np.flatnonzero(known)) > 1) + 1):
            if len(part) > 1:
                cv2.polylines(canvas, [np.rint(drawn[part]).astype(np.int32)], False, colour, 2, cv2.LINE_AA, SUBPIXEL_BITS)

    for side in position:
        polyline(side)
    polyline(position[:, 0])
    polyline(position[:, -1])
    middle = np.nanmean(position.reshape(-1, 2), axis=0) if np.isfinite(position).any() else None
    if middle is not None:
        label = f"{'' if pipe.pick is None else pipe.pick}: {'DN ' + str(pipe.dn) if pipe.dn else f'{pipe.outer_diameter:.1f}'}"
        at = (int(middle[0] * scale) - 30, int(middle[1] * scale) + 6)
        cv2.putText(canvas, label, at, cv2.FONT_HERSHEY_SIMPLEX, 0.6, (0, 0, 0), 4, cv2.LINE_AA)
        cv2.putText(canvas, label, at, cv2.FONT_HERSHEY_SIMPLEX, 0.6, (255, 255, 255), 1, cv2.LINE_AA)
