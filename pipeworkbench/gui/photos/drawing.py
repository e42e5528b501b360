# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is drawn over a photograph: polylines, points, vectors and edge points, in the photograph's pixels.

Thousands of them are turned into screen coordinates and cut to the screen in arrays; Qt gets only what is seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pipeworkbench.gui.compat import QtCore, QtGui
from pipeworkbench.gui.photos.picture import Frame
from pipeworkbench.recon.camera import Array
from pipeworkbench.recon.edges import EdgePoints

SIMPLIFIED_PX = 0.05  # what a drawn polyline may be off
MARGIN_PX = 12.0  # around the screen within which lines are kept
CASING = "#a0000000"  # dark border that lifts lines off a bright photograph
CASING_FROM = 1.5  # width of the lines that have one
DASHES = [5.0, 4.0]  # in line widths
POINT_RADIUS = 4.0
LABEL_OFFSET = 8
LEAST_BAND = 7.0  # width of a band on the screen
MOST_MARKERS = 3000  # beyond, points are mere dots
HEAD_LENGTH, HEAD_WIDTH = 5.0, 0.45  # of an arrow: px, in lengths
THREADS_FROM = 3.0  # scale from which edge points are drawn as pieces of their thread
HALF_THREAD = 0.5  # px
FAINTEST, STRONGEST = 70, 255  # opacity of edge points by their contrast's rank


class Drawing(Protocol):
    """Something that draws itself over what a frame shows."""

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw in the frame's screen coordinates."""


class Polylines:
    """Lines (n, 2) of one colour."""

    def __init__(self, lines: Sequence[Array], colour: str, width: float = 1.5, *, dashed: bool = False, casing: bool = True) -> None:
        kept = [_simplified(np.asarray(line, float)) for line in lines if len(line) > 1]
        self.points = np.concatenate(kept) if kept else np.zeros((0, 2))
        line_of = np.repeat(np.arange(len(kept)), [len(line) for line in kept])
        self._segments = np.flatnonzero(line_of[1:] == line_of[:-1])
        self._pen = _pen(colour, width, dashed=dashed)
        self._casing = _pen(CASING, width + 2.0) if casing and width >= CASING_FROM and not dashed else None

    def set_width(self, width: float) -> None:
        """Draw with another width (px of the screen)."""
        self._pen.setWidthF(width)

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw what of the lines is on the screen."""
        polygons = [QtGui.QPolygonF([QtCore.QPointF(u, v) for u, v in run]) for run in self._runs(frame)]
        for pen in (self._casing, self._pen):
            if pen is not None:
                painter.setPen(pen)
                for polygon in polygons:
                    painter.drawPolyline(polygon)

    def _runs(self, frame: Frame) -> Iterator[list[list[float]]]:
        """Yield the points of what is on the screen: dashes of a line that is mostly elsewhere would take forever."""
        screen = frame.to_screen(self.points)
        start, end = screen[self._segments], screen[self._segments + 1]
        enter, leave = _clipped(start, end, frame)
        rows = np.flatnonzero(enter < leave)
        if not len(rows):
            return
        first = start[rows] + enter[rows, None] * (end - start)[rows]
        last = start[rows] + leave[rows, None] * (end - start)[rows]
        whole = (np.diff(self._segments[rows]) == 1) & (leave[rows[:-1]] == 1) & (enter[rows[1:]] == 0)
        for run in np.split(np.arange(len(rows)), np.flatnonzero(~whole) + 1):
            yield [first[run[0]].tolist(), *last[run].tolist()]


class Band:
    """A translucent strip along polylines (n, 2), as wide as some pixels of the photograph."""

    def __init__(self, lines: Sequence[Array], colour: str, half_width: float) -> None:
        self._lines = Polylines(lines, colour, casing=False)
        self._half_width = half_width

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw what of the strip is on the screen."""
        self._lines.set_width(max(2 * self._half_width * frame.scale, LEAST_BAND))
        self._lines.draw(painter, frame)


class Points:
    """Points (n, 2) as small circles, with labels beside them."""

    def __init__(self, points: Array, colour: str, labels: Sequence[str] = ()) -> None:
        self.points = np.asarray(points, float).reshape(-1, 2)
        self._labels = list(labels)
        self._pen, self._casing = _pen(colour, 1.5), _pen(CASING, 3.5)
        self._colour = QtGui.QColor(colour)

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw what is on the screen."""
        screen = frame.to_screen(self.points)
        rows = np.flatnonzero(_on_screen(screen, frame))
        places = [QtCore.QPointF(u, v) for u, v in screen[rows].tolist()]
        if len(places) > MOST_MARKERS:
            painter.setPen(_pen(self._colour.name(), 3.0))
            painter.drawPoints(QtGui.QPolygonF(places))
            return
        painter.setBrush(QtCore.Qt.BrushStyle.NoBrush)
        for pen in (self._casing, self._pen):
            painter.setPen(pen)
            for place in places:
                painter.drawEllipse(place, POINT_RADIUS, POINT_RADIUS)
        for row, place in zip(rows.tolist(), places, strict=True):
            if row < len(self._labels) and self._labels[row]:
                draw_label(painter, place + QtCore.QPointF(LABEL_OFFSET, -LABEL_OFFSET), self._labels[row], self._colour)


class Vectors:
    """Arrows from points (n, 2) towards others, drawn longer than they are."""

    def __init__(self, starts: Array, ends: Array, colour: str) -> None:
        self.starts = np.asarray(starts, float).reshape(-1, 2)
        self.offsets = np.asarray(ends, float).reshape(-1, 2) - self.starts
        self.exaggeration = 1.0
        self._pen = _pen(colour, 1.2)

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw what is on the screen, with heads where there is room for them."""
        start = frame.to_screen(self.starts)
        arrow = self.offsets * (self.exaggeration * frame.scale)
        end = start + arrow
        shown = _on_screen(start, frame) | _on_screen(end, frame)
        start, arrow, end = start[shown], arrow[shown], end[shown]
        length = np.linalg.norm(arrow, axis=1)
        big = length > 2 * HEAD_LENGTH
        back = -arrow[big] / length[big, None] * HEAD_LENGTH
        across = HEAD_WIDTH * np.column_stack([-back[:, 1], back[:, 0]])
        tips = end[big]
        lines = np.concatenate(
            [np.column_stack([start, end]), np.column_stack([tips, tips + back + across]), np.column_stack([tips, tips + back - across])]
        )
        painter.setPen(self._pen)
        painter.drawLines([QtCore.QLineF(*line) for line in lines.tolist()])


class EdgeDots:
    """The edge points of an image: pixels from afar, the stronger the brighter; pieces of their threads near by."""

    def __init__(self, edges: EdgePoints, colour: str) -> None:
        order = np.argsort(edges.contrast, kind="stable")  # the strongest are drawn last
        self._u, self._v = np.ascontiguousarray(edges.position[order].T, np.float32)
        self._tangent = np.column_stack([edges.normal[order, 1], -edges.normal[order, 0]]).astype(np.float32)
        opacity = np.linspace(FAINTEST, STRONGEST, max(len(order), 1))[: len(order)]
        self._premultiplied = _premultiplied(QtGui.QColor(colour), opacity)
        self._pen = _pen(colour, 1.6)

    def draw(self, painter: QtGui.QPainter, frame: Frame) -> None:
        """Draw what is on the screen."""
        column = _whole_pixels(self._u, frame.centre[0], frame.scale, frame.width)
        row = _whole_pixels(self._v, frame.centre[1], frame.scale, frame.height)
        # negative ones are very large without a sign: one comparison each
        inside = np.flatnonzero((column.view(np.uint32) < frame.width) & (row.view(np.uint32) < frame.height))
        if frame.scale >= THREADS_FROM:
            self._draw_threads(painter, frame, inside)
            return
        image = QtGui.QImage(frame.width, frame.height, QtGui.QImage.Format.Format_ARGB32_Premultiplied)
        image.fill(0)
        pixels: NDArray[np.uint32] = np.frombuffer(image.bits(), np.uint32)
        pixels[row[inside] * frame.width + column[inside]] = self._premultiplied[inside]
        painter.drawImage(0, 0, image)

    def _draw_threads(self, painter: QtGui.QPainter, frame: Frame, rows: NDArray[np.intp]) -> None:
        middle, half = np.column_stack([self._u[rows], self._v[rows]]).astype(float), HALF_THREAD * self._tangent[rows]
        ends = np.column_stack([frame.to_screen(middle - half), frame.to_screen(middle + half)])
        painter.setPen(self._pen)
        painter.drawLines([QtCore.QLineF(*line) for line in ends.tolist()])


def draw_label(painter: QtGui.QPainter, place: QtCore.QPointF, text: str, colour: QtGui.QColor) -> None:
    """Write a text on a dark ground, its lower left corner at a place."""
    box = painter.fontMetrics().boundingRect(text).adjusted(-4, -2, 4, 2)
    box.moveBottomLeft(place.toPoint())
    painter.setPen(QtCore.Qt.PenStyle.NoPen)
    painter.setBrush(QtGui.QColor(0, 0, 0, 170))
    painter.drawRoundedRect(box, 3, 3)
    painter.setBrush(QtCore.Qt.BrushStyle.NoBrush)
    painter.setPen(colour)
    painter.drawText(box, QtCore.Qt.AlignmentFlag.AlignCenter, text)


def _pen(colour: str, width: float, *, dashed: bool = False) -> QtGui.QPen:
    pen = QtGui.QPen(QtGui.QColor(colour))
    pen.setWidthF(width)
    pen.setJoinStyle(QtCore.Qt.PenJoinStyle.RoundJoin)
    if dashed:
        pen.setCapStyle(QtCore.Qt.PenCapStyle.FlatCap)
        pen.setDashPattern(DASHES)
    return pen


def _whole_pixels(places: NDArray[np.float32], centre: float, scale: float, length: int) -> NDArray[np.int32]:
    """Return which pixel of the screen, along one axis, shows places (n,) of the photograph."""
    offset = places - np.float32(centre)
    offset *= np.float32(scale)
    offset += np.float32(length / 2)
    return np.asarray(np.floor(offset, out=offset), np.int32)


def _simplified(line: Array) -> Array:
    """Return a polyline without the points that say nothing about its course."""
    import cv2

    if len(line) < 3 or not np.isfinite(line).all():
        return line[np.isfinite(line).all(axis=1)]
    # OpenCV takes single precision: from the first point on, so that no digits are lost
    return np.asarray(cv2.approxPolyDP((line - line[0]).astype(np.float32), SIMPLIFIED_PX, closed=False)[:, 0], float) + line[0]


def _on_screen(points: Array, frame: Frame) -> NDArray[np.bool_]:
    return ((points > -MARGIN_PX) & (points < (frame.width + MARGIN_PX, frame.height + MARGIN_PX))).all(axis=1)


def _clipped(start: Array, end: Array, frame: Frame) -> tuple[Array, Array]:
    """Return where segments (n, 2) enter and leave the screen, from 0 to 1 (n,): Liang and Barsky; what misses it leaves before it enters."""
    low = np.array([-MARGIN_PX, -MARGIN_PX])
    high = np.array([frame.width + MARGIN_PX, frame.height + MARGIN_PX])
    way = end - start
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / way, (high - start) / way
    enter, leave = np.minimum(one, other), np.maximum(one, other)
    level = way == 0  # a coordinate that does not change is inside for the whole way or never
    inside = (start >= low) & (start <= high)
    enter = np.where(level, np.where(inside, -np.inf, np.inf), enter)
    leave = np.where(level, np.where(inside, np.inf, -np.inf), leave)
    return np.maximum(enter.max(axis=1), 0.0), np.minimum(leave.min(axis=1), 1.0)


def _premultiplied(colour: QtGui.QColor, opacity: Array) -> NDArray[np.uint32]:
    """Return a colour at opacities (n,) from 0 to 255 as Qt's premultiplied pixels."""
    red, green, blue = (np.rint(channel * opacity / 255).astype(np.uint32) for channel in (colour.red(), colour.green(), colour.blue()))
    return (opacity.astype(np.uint32) << 24) | (red << 16) | (green << 8) | blue
