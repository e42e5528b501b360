# SPDX-License-Identifier: LGPL-2.1-or-later
"""The loupe: the pixels around the pointer, much enlarged, beside it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from pipeworkbench.gui.compat import QtCore, QtGui
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.photos.picture import Frame

if TYPE_CHECKING:
    from pipeworkbench.gui.photos.canvas import PhotoCanvas

SIDE = 190  # px
OFFSET = 26  # from the pointer
LEAST_SCALE = 8.0
ENLARGEMENT = 4.0  # against the photograph, where that is more
RING, CROSS = "#f2f2f2", "#ff4d4d"
GAP, ARM = 5.0, 16.0  # of the cross


def draw_loupe(painter: QtGui.QPainter, canvas: PhotoCanvas, focus: tuple[float, float], layers: Iterable[Layer]) -> None:
    """Draw the loupe over a canvas whose pointer is at a pixel of the photograph."""
    from pipeworkbench.gui.photos.canvas import GROUND, draw_photograph

    pointer = canvas.screen_at(focus)
    # to the right below the pointer, on its other side where there is no room
    left = pointer.x() + OFFSET if pointer.x() + OFFSET + SIDE < canvas.width() else pointer.x() - OFFSET - SIDE
    top = pointer.y() + OFFSET if pointer.y() + OFFSET + SIDE < canvas.height() else pointer.y() - OFFSET - SIDE
    circle = QtGui.QPainterPath()
    circle.addEllipse(QtCore.QRectF(0, 0, SIDE, SIDE))
    frame = Frame(focus, max(LEAST_SCALE, ENLARGEMENT * canvas.scale), SIDE, SIDE)
    painter.save()
    painter.translate(round(left), round(top))
    painter.setClipPath(circle)
    painter.fillRect(0, 0, SIDE, SIDE, QtGui.QColor(GROUND))
    draw_photograph(painter, canvas.picture, frame, canvas.tone)
    for layer in layers:
        layer.draw(painter, canvas.camera, frame)
    middle = SIDE / 2
    painter.setPen(QtGui.QPen(QtGui.QColor(CROSS), 1.2))
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        painter.drawLine(QtCore.QPointF(middle + dx * GAP, middle + dy * GAP), QtCore.QPointF(middle + dx * (GAP + ARM), middle + dy * (GAP + ARM)))
    painter.setClipping(False)
    painter.setPen(QtGui.QPen(QtGui.QColor(RING), 2.0))
    painter.drawPath(circle)
    painter.restore()
