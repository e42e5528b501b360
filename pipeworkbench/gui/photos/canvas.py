# SPDX-License-Identifier: LGPL-2.1-or-later
"""One photograph on the screen: painted from its pyramid, with the layers over it; says what the mouse does.

A widget that paints the visible part itself rather than a QGraphicsView: a scene scales whole pixmaps and can
neither brighten a 12-megapixel photograph while a slider is dragged nor draw a quarter of a million edge points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pipeworkbench.gui.compat import QtCore, QtGui, QtWidgets, Signal, device_pixel_ratio, event_position
from pipeworkbench.gui.photos.drawing import draw_label
from pipeworkbench.gui.photos.layers import Layer
from pipeworkbench.gui.photos.loupe import draw_loupe
from pipeworkbench.gui.photos.picture import Frame, Picture, Tone
from pipeworkbench.gui.translation import tr

GROUND = "#2b2d30"
CAPTION = "#e8eaed"
SNAP = "#ffe14d"
CLICK_REACH_PX = 5  # a press that moves further is no click
SMALLEST_WIDTH = 120
WHEEL_STEP = 120.0  # Qt's eighths of degrees of a notch
ZOOM_PER_NOTCH = 1.25
# Qt composes a window that holds a 3D view with OpenGL, all of it with every movement of the pointer over a photograph;
# a photograph with a surface of its own is painted by itself, which is five times as fast without a graphics card
OWN_SURFACE_PLATFORMS = ("xcb",)

Qt = QtCore.Qt


@dataclass(frozen=True, eq=False)
class Pressed:
    """Where a mouse button went down, what it does, and whether the pointer has moved off since."""

    button: Any
    place: QtCore.QPointF
    pans: bool
    moved: bool = False


class PhotoCanvas(QtWidgets.QWidget):  # type: ignore[misc]  # Qt has no types
    """A camera's photograph; all places it tells are pixels of the photograph."""

    hovered = Signal(object)  # (u, v), None where the pointer has left the photograph
    clicked = Signal(object, object)  # (u, v), modifiers
    missed = Signal()  # a click beside the photograph
    panned = Signal(object)  # way in screen pixels
    zoomed = Signal(float, object)  # factor, place on the screen that stays
    resized = Signal()
    activated = Signal()

    def __init__(self, camera: str, size: tuple[int, int], layers: Callable[[], Iterable[Layer]]) -> None:
        super().__init__()
        self.camera = camera
        self.size_of_photograph = size
        self.centre = ((size[0] - 1) / 2, (size[1] - 1) / 2)
        self.scale = 1.0
        self.tone = Tone()
        self.picture: Picture | None = None
        self.loupe = False
        self.pans_with_left = False
        self.pointer: QtCore.QPointF | None = None
        self._layers = layers
        self._problem = ""
        self._backdrop: QtGui.QPixmap | None = None
        self._pressed: Pressed | None = None
        self._ignores_release = False
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(SMALLEST_WIDTH, SMALLEST_WIDTH)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        if QtGui.QGuiApplication.platformName() in OWN_SURFACE_PLATFORMS:
            self.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
            self.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)

    # what is shown

    @property
    def frame(self) -> Frame:
        """The part of the photograph that is shown, in the widget's own pixels."""
        return Frame(self.centre, self.scale, max(self.width(), 1), max(self.height(), 1))

    def show_picture(self, picture: Picture) -> None:
        """Show a photograph."""
        self.picture = picture
        self._problem = ""
        self.refresh()

    def show_problem(self, text: str) -> None:
        """Say why there is no photograph."""
        self._problem = text
        self.refresh()

    def look_at(self, centre: tuple[float, float], scale: float) -> None:
        """Show a place of the photograph in the middle."""
        if (centre, scale) != (self.centre, self.scale):
            self.centre, self.scale = centre, scale
            self.refresh()

    def set_tone(self, tone: Tone) -> None:
        """Show the photograph with other brightness."""
        self.tone = tone
        self.refresh()

    def refresh(self) -> None:
        """Paint photograph and layers anew."""
        self._backdrop = None
        self.update()

    def contains(self, point: tuple[float, float]) -> bool:
        """Tell whether a place is in the photograph."""
        width, height = self.size_of_photograph
        return -0.5 <= point[0] <= width - 0.5 and -0.5 <= point[1] <= height - 0.5

    def photograph_at(self, place: QtCore.QPointF) -> tuple[float, float]:
        """Return the pixel of the photograph at a place of the widget."""
        u, v = self.frame.to_photograph(np.array([place.x(), place.y()])).tolist()
        return u, v

    def screen_at(self, point: tuple[float, float]) -> QtCore.QPointF:
        """Return where a pixel of the photograph is in the widget."""
        return QtCore.QPointF(*self.frame.to_screen(np.asarray(point, float)).tolist())

    # painting

    def paintEvent(self, event: Any) -> None:  # noqa: ARG002  # Qt's name
        """Paint what is kept, and above it what follows the pointer."""
        if self._backdrop is None:
            self._backdrop = self._painted()
        painter = QtGui.QPainter(self)
        painter.drawPixmap(0, 0, self._backdrop)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        for layer in self._layers():
            if layer.live:
                layer.draw(painter, self.camera, self.frame)
        if self.loupe and self.picture is not None and self.pointer is not None and self._pressed is None:
            focus = self.photograph_at(self.pointer)
            if self.contains(focus):
                draw_loupe(painter, self, focus, [layer for layer in self._layers() if layer.visible])
        painter.end()

    def _painted(self) -> QtGui.QPixmap:
        """Return photograph and layers, in the screen's own pixels."""
        ratio = device_pixel_ratio(self)
        frame = self.frame
        fine = replace(frame, scale=frame.scale * ratio, width=max(round(frame.width * ratio), 1), height=max(round(frame.height * ratio), 1))
        pixmap = QtGui.QPixmap(fine.width, fine.height)
        pixmap.fill(QtGui.QColor(GROUND))
        painter = QtGui.QPainter(pixmap)
        draw_photograph(painter, self.picture, fine, self.tone)
        painter.scale(ratio, ratio)
        painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
        for layer in self._layers():
            if not layer.live:
                layer.draw(painter, self.camera, frame)
        self._draw_caption(painter)
        painter.end()
        pixmap.setDevicePixelRatio(ratio)
        return pixmap

    def _draw_caption(self, painter: QtGui.QPainter) -> None:
        font = painter.font()
        font.setBold(True)
        painter.setFont(font)
        draw_label(painter, QtCore.QPointF(8, 8 + painter.fontMetrics().height()), self.camera, QtGui.QColor(CAPTION))
        font.setBold(False)
        painter.setFont(font)
        if self.picture is None:
            painter.setPen(QtGui.QColor(CAPTION))
            text = self._problem or tr("Loading the photograph...")
            painter.drawText(self.rect().adjusted(16, 16, -16, -16), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, text)

    # the mouse

    def mousePressEvent(self, event: Any) -> None:  # Qt's name
        """Begin a click or a pan."""
        self.activated.emit()
        button = event.button()
        pans = button in (Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton) or (button == Qt.MouseButton.LeftButton and self.pans_with_left)
        self._pressed = Pressed(button, event_position(event), pans)
        self._ignores_release = False
        if pans:
            self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def mouseDoubleClickEvent(self, event: Any) -> None:  # Qt's name
        """Take the second click of a double click for what it is: not another click."""
        self.mousePressEvent(event)
        self._ignores_release = event.button() == Qt.MouseButton.LeftButton

    def mouseMoveEvent(self, event: Any) -> None:  # Qt's name
        """Pan, or tell what the pointer is at."""
        place = event_position(event)
        pressed, before = self._pressed, self.pointer
        self.pointer = place
        if pressed is not None and not pressed.moved:
            way = place - pressed.place
            if abs(way.x()) + abs(way.y()) <= CLICK_REACH_PX:
                return
            self._pressed = pressed = replace(pressed, moved=True)
            before = pressed.place
        if pressed is not None and pressed.pans and before is not None:
            self.panned.emit(place - before)
            return
        self._tell_pointer()

    def mouseReleaseEvent(self, event: Any) -> None:  # Qt's name
        """End a pan, or tell of a click."""
        pressed, self._pressed = self._pressed, None
        self._show_cursor()
        ignored, self._ignores_release = self._ignores_release, False
        if pressed is None or pressed.moved or pressed.pans or ignored or event.button() != Qt.MouseButton.LeftButton:
            return
        point = self.photograph_at(pressed.place)
        if self.picture is not None and self.contains(point):
            self.clicked.emit(point, event.modifiers())
        else:
            self.missed.emit()

    def leaveEvent(self, event: Any) -> None:  # noqa: ARG002  # Qt's name
        """Tell that the pointer is gone."""
        self.pointer = None
        self._tell_pointer()

    def wheelEvent(self, event: Any) -> None:  # Qt's name
        """Zoom to the pointer."""
        notches = event.angleDelta().y() / WHEEL_STEP
        if notches:
            self.zoomed.emit(ZOOM_PER_NOTCH**notches, event_position(event))
        event.accept()

    def resizeEvent(self, event: Any) -> None:  # noqa: ARG002  # Qt's name
        """Paint for another size."""
        self.refresh()
        self.resized.emit()

    def set_pans_with_left(self, pans: bool) -> None:  # noqa: FBT001  # as Qt's setters
        """Let the left button pan, while the space bar is held."""
        self.pans_with_left = pans
        self._show_cursor()

    def _show_cursor(self) -> None:
        if self.pans_with_left:
            self.setCursor(Qt.CursorShape.OpenHandCursor)
        else:
            self.setCursor(Qt.CursorShape.CrossCursor)

    def _tell_pointer(self) -> None:
        point = None if self.pointer is None else self.photograph_at(self.pointer)
        self.hovered.emit(point if point is not None and self.contains(point) else None)
        if self.loupe:
            self.update()


def draw_photograph(painter: QtGui.QPainter, picture: Picture | None, frame: Frame, tone: Tone) -> None:
    """Draw what a frame shows of a photograph, its upper left corner at the painter's origin."""
    cutout = None if picture is None else picture.cutout(frame, tone)
    if cutout is None:
        return
    height, width = cutout.grey.shape
    image = QtGui.QImage(width, height, QtGui.QImage.Format.Format_Grayscale8)
    rows = np.frombuffer(image.bits(), np.uint8).reshape(height, image.bytesPerLine())
    rows[:, :width] = cutout.grey
    painter.drawImage(cutout.left, cutout.top, image)
