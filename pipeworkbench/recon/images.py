# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading photographs as grey values: all bits, the pixels as the sensor stored them, or a clear refusal."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.recon.image_files import COPY_AGAIN, EncodedImage, inspected
from pipeworkbench.recon.station import MOST_PIXELS, Station

Grey = NDArray[np.uint8] | NDArray[np.uint16]

MOST_AREA = 2**29  # pixels of one image; the largest sensors have 1.5e8
MOST_BYTES = 2**31 - 1  # of a file; what OpenCV decodes

SILENT = 0  # OpenCV's LOG_LEVEL_SILENT

# OpenCV's log level is the whole program's: one image at a time changes it
_decoding = threading.Lock()


def read_grey(path: Path) -> Grey:
    """Read a photograph's grey values (height, width), 8 or 16 bit as stored; colours become Rec. 601 luminance.

    A rotation flag (EXIF) is ignored, because a calibration belongs to the sensor's pixels as they are
    stored; so are transparency and colour profiles. Of an animation or a TIFF with several images it is the first.

    Raises
    ------
    InputError
        Where the file cannot be read, is not a whole image or not one that can be measured in.
    """
    try:
        if path.stat().st_size > MOST_BYTES:
            raise InputError(path, "", "is larger than 2 GB", "give a photograph as PNG, TIFF or JPEG")
        encoded = inspected(path, path.read_bytes())
    except OSError as error:
        raise InputError(path, "", f"cannot be read ({error.strerror})", "check the name and the permissions") from None
    width, height = encoded.width, encoded.height
    if not (0 < width <= MOST_PIXELS and 0 < height <= MOST_PIXELS and width * height <= MOST_AREA):
        raise InputError(path, "", f"says it has {width} x {height} pixels", f"give an image of 1 to {MOST_PIXELS} pixels along each side")
    grey = _decoded(encoded)
    if grey is None or grey.dtype not in (np.uint8, np.uint16) or grey.shape != (height, width):
        raise InputError(path, "", "cannot be decoded as an 8- or 16-bit image", f"{COPY_AGAIN}, or open it in an image editor and export it as PNG")
    return np.invert(grey) if encoded.negative else grey


def read_image(station: Station, index: int) -> Grey:
    """Read a camera's photograph as grey values (height, width), 8 or 16 bit.

    Raises
    ------
    InputError
        Where the file is not an image or its size is not the calibration's.
    """
    path, interior = station.images[index], station.cameras[index].interior
    key = f"cameras[{index}].image"
    try:
        grey = read_grey(path)
    except InputError as error:
        raise InputError(station.source, key, f"{path} {error.problem}", error.remedy) from None
    height, width = grey.shape
    if (width, height) != (interior.width, interior.height):
        raise InputError(
            station.source,
            key,
            f"{path} is {width} x {height} pixels, the calibration is for {interior.width} x {interior.height}",
            "give the original image or the calibration of this size",
        )
    return grey


def _decoded(encoded: EncodedImage) -> Any:
    """Decode into grey values (height, width); None where that fails. What OpenCV would print is said by our own errors."""
    import cv2

    flags = cv2.IMREAD_GRAYSCALE if encoded.luminance else cv2.IMREAD_ANYCOLOR
    with _decoding:
        level = cv2.getLogLevel()
        cv2.setLogLevel(SILENT)
        try:
            image = cv2.imdecode(np.frombuffer(encoded.data, np.uint8), flags | cv2.IMREAD_ANYDEPTH | cv2.IMREAD_IGNORE_ORIENTATION)
            return cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) if image is not None and image.ndim == 3 else image
        except cv2.error:
            return None
        finally:
            cv2.setLogLevel(level)
