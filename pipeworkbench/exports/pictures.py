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
from pipeworkbench.pipeline import AnyComponent, Cap, Elbow, Flange, Pipe, Pipeline, Reducer, Tee, moved
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.contour import Contour, contour_of
from pipeworkbench.recon.images import read_image
from pipeworkbench.recon.station import Station

PICTURE_WIDTH = 1296  # px of each photograph in the picture
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
    """Return a camera's photograph (height, width, 3) BGR with the visible contours of all components."""
    import cv2

    camera = station.cameras[index]
    grey = read_image(station, index).astype(np.float32)
    low, high = np.percentile(grey[::7, ::7], GREY_PERCENTILES)
    grey = np.clip((grey - low) * (255 / max(high - low, 1)), 0, 255).astype(np.uint8)
    scale = min(1.0, PICTURE_WIDTH / grey.shape[1])
    small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    canvas = cv2.cvtColor(small, cv2.COLOR_GRAY2BGR)
    components = [_in_level(component, level_from_frame) for component in pipeline.components]
    contour = contour_of(camera, components)
    for number in range(len(components)):
        red, green, blue = COLOURS[number % len(COLOURS)]
        _draw_contour(canvas, contour[contour.component == number], scale, (blue, green, red))
    # the labels last, so that no line runs through them
    for number, component in enumerate(components):
        seen = contour.position[(contour.component == number) & contour.visible]
        if len(seen):
            _write_label(canvas, _label(component), seen.mean(axis=0) * scale)
    cv2.putText(canvas, f"{station.name} / {camera.name}", (12, 30), cv2.FONT_HERSHEY_SIMPLEX, 0.8, (255, 255, 255), 2, cv2.LINE_AA)
    return np.asarray(canvas, np.uint8)


def _in_level(component: AnyComponent, level_from_frame: Array) -> AnyComponent:
    rows: list[list[float]] = level_from_frame.tolist()
    return moved(component, tuple((row[0], row[1], row[2], row[3]) for row in rows))


def _draw_contour(canvas: Any, contour: Contour, scale: float, colour: tuple[int, int, int]) -> None:
    """Draw the visible parts of a component's curves: a line breaks where samples are hidden."""
    import cv2

    # pixel centres at integers on both scales: shift by half a pixel before and after scaling
    drawn = ((contour.position + 0.5) * scale - 0.5) * 2**SUBPIXEL_BITS
    rows = np.flatnonzero(contour.visible)
    breaks = (np.diff(rows) > 1) | (np.diff(contour.curve[rows]) != 0)
    lines = np.split(rows, np.flatnonzero(breaks) + 1)
    # a pipe's ends are where its two edges end
    at_end = [rows[np.isclose(contour.parameter[rows], end)] for end in (0.0, 1.0)]
    lines += [ends for ends in at_end if len(ends) == 2 and {contour.names[curve] for curve in contour.curve[ends]} == {"pipe"}]
    for line in lines:
        if len(line) > 1:
            cv2.polylines(canvas, [np.rint(drawn[line]).astype(np.int32)], False, colour, 2, cv2.LINE_AA, SUBPIXEL_BITS)


def _write_label(canvas: Any, text: str, middle: Array) -> None:
    import cv2

    at = (round(float(middle[0])) - 30, round(float(middle[1])) + 6)
    cv2.putText(canvas, text, at, cv2.FONT_HERSHEY_SIMPLEX, 0.6, (0, 0, 0), 4, cv2.LINE_AA)
    cv2.putText(canvas, text, at, cv2.FONT_HERSHEY_SIMPLEX, 0.6, (255, 255, 255), 1, cv2.LINE_AA)


def _label(component: AnyComponent) -> str:
    """Return a few letters that tell which component this is: there is little room."""
    match component:
        case Pipe():
            size = f"DN {component.dn}" if component.dn else f"{component.outer_diameter:.1f}"
            return size if component.pick is None else f"{component.pick}: {size}"
        case Elbow():
            return component.bend_type or f"R {component.bend_radius:.0f}"
        case Flange():
            return f"{component.flange_type} PN {component.pn:g}"
        case Tee():
            return "T"
        case Reducer():
            return f"> {component.end_diameter:.1f}"
        case Cap():
            return "cap"
