# SPDX-License-Identifier: LGPL-2.1-or-later
"""A photograph as it is shown: a pyramid of smaller copies, cut out and brightened for the eye at any scale."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.images import Grey

GREY_PERCENTILES = (0.5, 99.5)  # dim photographs are stretched to this range
SAMPLED_EVERY = 7  # pixel, for the percentiles
SMALLEST_LEVEL = 256  # px along the longer side
WHOLE_PIXELS_FROM = 2.0  # scale from which a pixel is shown as the square that it is
MIDDLE_GREY = 0.5


@dataclass(frozen=True)
class Tone:
    """How grey values are shown: ``contrast`` 1 stretches what the photograph has to what the screen has; ``gamma`` above 1 brightens."""

    contrast: float = 1.0
    gamma: float = 1.0


@dataclass(frozen=True)
class Frame:
    """Which part of a photograph is shown: ``centre`` (u, v) in its pixels at the middle of ``width`` x ``height`` screen pixels.

    ``scale`` is in screen pixels per pixel of the photograph.
    """

    centre: tuple[float, float]
    scale: float
    width: int
    height: int

    def to_screen(self, points: Array) -> Array:
        """Return where points (..., 2) of the photograph are on the screen."""
        return (points - np.asarray(self.centre)) * self.scale + (self.width / 2, self.height / 2)

    def to_photograph(self, points: Array) -> Array:
        """Return what points (..., 2) of the screen show."""
        return (points - np.array([self.width / 2, self.height / 2])) / self.scale + np.asarray(self.centre)


@dataclass(frozen=True, eq=False)
class Cutout:
    """A piece of a picture, 8 bit: its grey values (height, width) and the screen pixel (left, top) where it begins."""

    grey: NDArray[np.uint8]
    left: int
    top: int


class Picture:
    """A photograph's grey values (height, width), 8 or 16 bit, with half, quarter, ... as large copies."""

    def __init__(self, grey: Grey) -> None:
        self.levels: list[Grey] = _pyramid(grey)
        seen = grey[::SAMPLED_EVERY, ::SAMPLED_EVERY]
        low, high = np.percentile(seen, GREY_PERCENTILES)
        self.range = float(low), float(max(high, low + 1))

    @property
    def grey(self) -> Grey:
        """The photograph itself."""
        return self.levels[0]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        height, width = self.grey.shape
        return width, height

    def value_at(self, u: float, v: float) -> int | None:
        """Return the grey value of the pixel at (u, v), None outside."""
        width, height = self.size
        column, row = round(u), round(v)
        return int(self.grey[row, column]) if 0 <= column < width and 0 <= row < height else None

    def cutout(self, frame: Frame, tone: Tone) -> Cutout | None:
        """Return what a frame shows of the photograph, None where that is nothing."""
        import cv2

        width, height = self.size
        corners = frame.to_screen(np.array([[-0.5, -0.5], [width - 0.5, height - 0.5]]))
        left, top = np.maximum(np.floor(corners[0]).astype(int), 0)
        right, bottom = np.minimum(np.ceil(corners[1]).astype(int), (frame.width, frame.height))
        if right <= left or bottom <= top:
            return None
        level = self.levels[min(max(int(np.floor(-np.log2(frame.scale) + 1e-9)), 0), len(self.levels) - 1)]
        per_pixel = np.array([level.shape[1] / width, level.shape[0] / height])  # of the level, a little off a power of two
        # screen pixel -> level: centres are at integers in both
        first = (frame.to_photograph(np.array([left + 0.5, top + 0.5])) + 0.5) * per_pixel - 0.5
        step = per_pixel / frame.scale
        last = first + step * (right - left - 1, bottom - top - 1)
        crop_low = np.clip(np.floor(first).astype(int) - 1, 0, (level.shape[1] - 1, level.shape[0] - 1))
        crop_high = np.clip(np.ceil(last).astype(int) + 2, crop_low + 1, (level.shape[1], level.shape[0]))
        crop = level[crop_low[1] : crop_high[1], crop_low[0] : crop_high[0]]
        sampling = cv2.INTER_NEAREST if frame.scale >= WHOLE_PIXELS_FROM else cv2.INTER_LINEAR
        offset = first - crop_low
        shown = cv2.warpAffine(
            crop,
            np.array([[step[0], 0, offset[0]], [0, step[1], offset[1]]]),
            (int(right - left), int(bottom - top)),
            flags=sampling | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        )
        table = tone_table(self.range, tone, int(np.iinfo(self.grey.dtype).max))
        grey = cv2.LUT(shown, table) if shown.dtype == np.uint8 else table[shown]
        return Cutout(np.ascontiguousarray(grey), int(left), int(top))


@functools.lru_cache(maxsize=16)
def tone_table(grey_range: tuple[float, float], tone: Tone, largest: int) -> NDArray[np.uint8]:
    """Return the shown value (0 to 255) of each grey value from 0 to ``largest``."""
    low, high = grey_range
    part = (np.arange(largest + 1) - low) / (high - low)
    part = np.clip((part - MIDDLE_GREY) * tone.contrast + MIDDLE_GREY, 0, 1) ** (1 / tone.gamma)
    return np.rint(part * 255).astype(np.uint8)


def _pyramid(grey: Grey) -> list[Grey]:
    import cv2

    levels = [grey]
    while max(levels[-1].shape) > 2 * SMALLEST_LEVEL and min(levels[-1].shape) > 1:
        height, width = levels[-1].shape
        levels.append(np.asarray(cv2.resize(levels[-1], ((width + 1) // 2, (height + 1) // 2), interpolation=cv2.INTER_AREA)))
    return levels
