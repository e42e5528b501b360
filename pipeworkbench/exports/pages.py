# SPDX-License-Identifier: LGPL-2.1-or-later
"""Printed pages drawn with matplotlib: coordinates are mm from the page's lower left corner, sizes of texts points."""

from __future__ import annotations

import bisect
import functools
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from pipeworkbench.errors import InputError, MissingPackageError, one_line
from pipeworkbench.files import written_whole
from pipeworkbench.recon.camera import Array

MM_PER_INCH, MM_PER_POINT = 25.4, 25.4 / 72
LANDSCAPE, PORTRAIT = (297.0, 210.0), (210.0, 297.0)  # mm, A4
INK, GREY, PALE = "#1a1a1a", "#6b6b6b", "#d0d0d0"
HAIR, THIN, LINE = 0.25, 0.4, 0.7  # pt, widths of lines
ELLIPSIS = "…"
FONT = "DejaVu Sans"  # comes with matplotlib


@dataclass(frozen=True)
class Page:
    """One page of a size (mm) that is drawn on."""

    size: tuple[float, float]
    axes: Any

    def text(self, x: float, y: float, text: str, points: float, **options: Any) -> None:
        """Write a text; it begins at its base line's left end where ``ha`` and ``va`` say nothing else."""
        shown = {"color": INK, "ha": "left", "va": "baseline"} | options
        # ids may hold dollar signs, which are no formulas
        self.axes.text(x, y, one_line(text), fontsize=points, parse_math=False, **shown)

    def line(self, points: Array | Sequence[tuple[float, float]], width: float, colour: str = INK, **options: Any) -> None:
        """Draw straight lines through points (n, 2)."""
        x, y = np.asarray(points, float).T
        self.axes.plot(x, y, color=colour, linewidth=width, solid_capstyle="butt", **options)

    def lines(self, many: Sequence[Array], width: float, colour: str, linestyle: Any) -> None:
        """Draw many rows of straight lines, each through points (n, 2), above areas: much faster than one by one."""
        from matplotlib.collections import LineCollection

        collection = LineCollection(many, linewidths=width, colors=colour, linestyles=[linestyle], zorder=2)
        self.axes.add_collection(collection, autolim=False)

    def area(self, outlines: Sequence[Array], fill: str, width: float) -> None:
        """Fill closed polygons, each (n, 2): the first runs counter-clockwise, the others, holes in it, clockwise."""
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path

        path = Path.make_compound_path(*(Path(np.vstack([points, points[:1]]), closed=True) for points in outlines))
        self.axes.add_patch(PathPatch(path, facecolor=fill, edgecolor=INK, linewidth=width, joinstyle="miter"))

    def dimension(self, start: tuple[float, float], end: tuple[float, float], text: str, points: float) -> None:
        """Draw a dimension line along x or y with its figure on it."""
        self.axes.annotate("", end, start, arrowprops={"arrowstyle": "<|-|>", "linewidth": THIN, "color": GREY, "shrinkA": 0, "shrinkB": 0})
        upright = abs(end[1] - start[1]) > abs(end[0] - start[0])
        middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
        around = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
        self.text(*middle, text, points, ha="center", va="center", rotation=90 if upright else 0, color=GREY, bbox=around)


def write_pages(drawings: Sequence[Callable[[Page], None]], path: FilePath, size: tuple[float, float]) -> None:
    """Write pages of one size (mm): a PDF with a page for each drawing, or an SVG with all below each other, as the path ends.

    Raises
    ------
    InputError
        Where the path ends in neither ``.pdf`` nor ``.svg``.
    MissingPackageError
        Where matplotlib is not installed.
    """
    writers = {".pdf": _write_pdf, ".svg": _write_svg}
    if path.suffix.lower() not in writers:
        raise InputError(path, "", f"no pages can be written as '{path.suffix}'", "end the name in .pdf or .svg")
    with _drawing(), written_whole(path) as temporary:
        writers[path.suffix.lower()](drawings, temporary, size)


def text_width(text: str, points: float, *, bold: bool = False) -> float:
    """Return how wide (mm) a text is."""
    return _width_in_ems(one_line(text), bold) * points * MM_PER_POINT


def fitted(text: str, points: float, width: float, *, bold: bool = False) -> str:
    """Return a text that is no wider than ``width`` (mm): where it is too long its middle is left out."""
    text = one_line(text)

    def shortened(kept: int) -> str:
        head = (kept + 1) // 2
        return text[:head] + ELLIPSIS + text[len(text) - (kept - head) :]

    if text_width(text, points, bold=bold) <= width:
        return text
    # the longer a text the wider it is
    kept = bisect.bisect_right(range(1, len(text)), width, key=lambda kept: text_width(shortened(kept), points, bold=bold))
    return shortened(kept)


@functools.lru_cache(maxsize=10_000)
def _width_in_ems(text: str, bold: bool) -> float:  # noqa: FBT001  # keywords would be another entry of the cache
    try:
        from matplotlib.font_manager import FontProperties
        from matplotlib.textpath import text_to_path
    except ImportError:
        raise _missing() from None
    font = FontProperties(family=FONT, size=1.0, weight="bold" if bold else "normal")
    with _without_glyph_warnings():
        width, _, _ = text_to_path.get_text_width_height_descent(text, font, ismath=False)
    return float(width)


def _missing() -> MissingPackageError:
    return MissingPackageError("matplotlib", "Drawing pages", "pip install 'matplotlib>=3.6,<4'")


@contextmanager
def _without_glyph_warnings() -> Iterator[None]:
    """Draw a letter that the font lacks as a box, without a word."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph")
        yield


@contextmanager
def _drawing() -> Iterator[None]:
    """Draw the same pages alike at any time and on any machine."""
    try:
        from matplotlib import rc_context
    except ImportError:
        raise _missing() from None
    settings = {"font.family": FONT, "svg.fonttype": "path", "svg.hashsalt": "pipeworkbench"}
    with _without_glyph_warnings(), rc_context(settings):
        yield


def _write_pdf(drawings: Sequence[Callable[[Page], None]], path: FilePath, size: tuple[float, float]) -> None:
    from matplotlib.backends.backend_pdf import PdfPages

    with PdfPages(path, metadata={"CreationDate": None, "Creator": "Pipe Workbench"}) as file:
        for draw in drawings:
            file.savefig(figure_of([draw], size))


def _write_svg(drawings: Sequence[Callable[[Page], None]], path: FilePath, size: tuple[float, float]) -> None:
    figure_of(drawings, size).savefig(path, format="svg", metadata={"Date": None, "Creator": "Pipe Workbench"})


def figure_of(drawings: Sequence[Callable[[Page], None]], size: tuple[float, float]) -> Any:
    """Return a matplotlib figure of pages of one size (mm) below each other."""
    # the figure alone: nothing of a window is loaded
    from matplotlib.figure import Figure

    width, height = size
    count = len(drawings)
    figure = Figure(figsize=(width / MM_PER_INCH, count * height / MM_PER_INCH), facecolor="white")
    for index, draw in enumerate(drawings):
        axes = figure.add_axes((0.0, (count - 1 - index) / count, 1.0, 1.0 / count))
        axes.set_xlim(0.0, width)
        axes.set_ylim(0.0, height)
        axes.set_axis_off()
        draw(Page(size, axes))
    return figure
