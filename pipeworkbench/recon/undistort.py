# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures without distortion, for the eye only: measurements stay in the photographs as taken.

Straight edges of the plant are straight in these pictures, and a display can draw 3D lines by their ends.
The tables that say where every pixel comes from are made once per interior orientation and kept.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.errors import InputError
from pipeworkbench.recon.interior import Interior, OpenCVInterior
from pipeworkbench.recon.inversion import Array

Image = TypeVar("Image", NDArray[np.uint8], NDArray[np.uint16])

CELL = 8  # px between the places where the distortion is computed; interpolated linearly between them, where that is
TABLE_ACCURACY_PX = 0.01  # accurate; fixed point adds up to 1 / 64 px
LARGEST_GROWTH = 2.0  # of the picture over the photograph: a very wide lens's corners go to infinity
LARGEST_SIDE = 32766  # px; OpenCV's tables are of 16 bits
CACHED_VIEWS = 4  # a rig's cameras; each holds 6 bytes per pixel
BORDER_SAMPLES = 64
ROUNDING_PX = 1e-6  # of the picture's size
OUTSIDE = -1000.0  # where the photograph shows nothing


@dataclass(frozen=True, eq=False)
class UndistortedView:
    """What a camera would see without distortion.

    Attributes
    ----------
    interior : Interior
        The photograph's interior orientation.
    pinhole : OpenCVInterior
        The picture's: its ``width`` and ``height``, focal lengths and principal point in px, no distortion.
        Together with the camera's exterior orientation it projects points straight into the picture.
    """

    interior: Interior
    pinhole: OpenCVInterior

    def undistorted(self, pixels: Array) -> Array:
        """Return where pixels (n, 2) of the photograph are in the picture, exactly; NaN where no ray leads to one."""
        return self.interior.ideal(np.asarray(pixels, float)) * self._scale + self._principal_point

    def original(self, pixels: Array) -> Array:
        """Return where pixels (n, 2) of the picture are in the photograph, exactly; NaN outside its field of view."""
        return self.interior.pixels((np.asarray(pixels, float) - self._principal_point) / self._scale)

    def picture(self, photograph: Image) -> Image:
        """Return the photograph (height, width[, channels]) without distortion; black where it shows nothing."""
        import cv2

        expected = (self.interior.height, self.interior.width)
        if photograph.shape[:2] != expected:
            raise ValueError(f"the photograph is {photograph.shape[:2]} pixels high and wide, the calibration is for {expected}")
        return cv2.remap(photograph, *self.tables, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)

    @functools.cached_property
    def tables(self) -> tuple[NDArray[np.int16], NDArray[np.uint16]]:
        """OpenCV's fixed-point tables of where each pixel comes from: whole pixels (height, width, 2), fractions (height, width)."""
        import cv2

        if max(self.pinhole.width, self.pinhole.height, self.interior.width, self.interior.height) > LARGEST_SIDE:
            raise InputError("the undistorted picture", "", f"has more than {LARGEST_SIDE} pixels along a side", "choose a smaller magnification")
        width, height = self.pinhole.width, self.pinhole.height
        nodes = self._at_nodes(0.0)
        rows, columns = nodes.shape[:2]
        full = cv2.resize(nodes.astype(np.float32), (columns * CELL, rows * CELL), interpolation=cv2.INTER_LINEAR)
        # the nodes begin one cell outside the picture
        source = np.ascontiguousarray(full[CELL : CELL + height, CELL : CELL + width])
        rough = self._rough_cells(nodes).repeat(CELL, axis=0).repeat(CELL, axis=1)
        v, u = np.nonzero(rough[CELL // 2 : CELL // 2 + height, CELL // 2 : CELL // 2 + width])
        source[v, u] = self.original(np.column_stack([u, v]))
        source[np.isnan(source)] = OUTSIDE
        whole, fraction = cv2.convertMaps(source, None, cv2.CV_16SC2)
        return whole, fraction

    def _at_nodes(self, shift: float) -> Array:
        """Return the photograph's pixels (rows, columns, 2) at the middles of square cells, shifted by a part of a cell."""
        columns, rows = (math.ceil(size / CELL) for size in (self.pinhole.width, self.pinhole.height))
        u, v = np.meshgrid(*((np.arange(-1, count + 1) + 0.5 + shift) * CELL - 0.5 for count in (columns, rows)))
        return self.original(np.column_stack([u.ravel(), v.ravel()])).reshape(rows + 2, columns + 2, 2)

    def _rough_cells(self, nodes: Array) -> NDArray[np.bool_]:
        """Return which squares (rows - 1, columns - 1) between nodes show the photograph and cannot be interpolated: half way it would be seen."""
        between = (nodes[:-1, :-1] + nodes[1:, :-1] + nodes[:-1, 1:] + nodes[1:, 1:]) / 4
        exact = self._at_nodes(0.5)[:-1, :-1]
        shown = np.all((exact > -2 * CELL) & (exact < (self.interior.width + 2 * CELL, self.interior.height + 2 * CELL)), axis=2)
        return shown & ~(np.abs(between - exact).max(axis=2) <= TABLE_ACCURACY_PX)

    @property
    def _scale(self) -> Array:
        return np.array([self.pinhole.fx, self.pinhole.fy])

    @property
    def _principal_point(self) -> Array:
        return np.array([self.pinhole.cx, self.pinhole.cy])


@functools.lru_cache(maxsize=CACHED_VIEWS)
def undistorted_view(interior: Interior, magnification: float = 1.0) -> UndistortedView:
    """Lay out the picture without distortion that shows a photograph's whole field.

    On the optical axis its scale is the photograph's times ``magnification``; where there is no
    distortion it is the photograph. Its corners may be empty, and it ends at twice the photograph's size.
    Views are kept, with their tables, for the last few interior orientations that were asked for.

    Parameters
    ----------
    interior : Interior
        The photograph's interior orientation.
    magnification : float
        Pixels of the picture per pixel of the photograph, on the optical axis.
    """
    axis = np.zeros((1, 2))
    middle = (interior.pixels(axis)[0] + 0.5) * magnification - 0.5
    # pixels that are not square stay so; what the sensor is sheared by goes
    scale = np.abs(np.diagonal(interior.pixel_derivative(axis, interior.pixels(axis))[0])) * magnification
    ideal = interior.ideal(interior.border(BORDER_SAMPLES))
    reach = ideal[np.isfinite(ideal).all(axis=1)] * scale
    most = np.array([interior.width, interior.height]) * magnification * LARGEST_GROWTH / 2
    low, high = np.maximum(reach.min(axis=0), -most), np.minimum(reach.max(axis=0), most)
    # the border is that of whole pixels; rounding must not add a row where nothing is distorted
    first, last = np.floor(middle + low + 0.5 + ROUNDING_PX), np.ceil(middle + high - 0.5 - ROUNDING_PX)
    width, height = (int(count) for count in last - first + 1)
    cx, cy = (float(value) for value in middle - first)
    return UndistortedView(interior, OpenCVInterior(width, height, float(scale[0]), float(scale[1]), cx, cy))
