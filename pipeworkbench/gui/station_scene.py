# SPDX-License-Identifier: LGPL-2.1-or-later
"""A station in 3D: the fields of view of its cameras and, on request, one photograph where it would hang in space.

Nothing of it can be picked, so that it is never in the way of the pipes. Where coin's Python module (pivy) is missing,
stations are seen in the tree alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import FreeCAD
import numpy as np

from pipeworkbench.errors import PipeWorkbenchError
from pipeworkbench.features.base import is_newer
from pipeworkbench.features.station import cameras_of, station_of
from pipeworkbench.recon.camera import Array, Camera

if TYPE_CHECKING:
    from numpy.typing import NDArray

try:
    from pivy import coin
except ImportError:  # FreeCAD without pivy
    coin = None

NO_PHOTO = "none"
CAMERA_SIZE_MM, PHOTO_DISTANCE_MM = 300.0, 4000.0
LINE_COLOUR, LINE_WIDTH_PX = (0.90, 0.62, 0.0), 2.0
PHOTO_PX = 2048  # width of the picture on the graphics card
MESH = 24  # pieces of the photograph's longer side: within each its distortion is taken as linear
GREY_PERCENTILES = (0.5, 99.5)  # dim photographs are stretched to this range for the eye
VIEW_PROPERTIES = (
    ("CameraSize", "App::PropertyLength", "How long the fields of view are drawn", CAMERA_SIZE_MM),
    ("Photo", "App::PropertyEnumeration", "Camera whose photograph is shown in 3D", [NO_PHOTO]),
    ("PhotoDistance", "App::PropertyLength", "How far from the camera its photograph is shown", PHOTO_DISTANCE_MM),
    ("PhotoTransparency", "App::PropertyPercent", "Of the photograph", 0),
)
SHAPING = frozenset({"Calibration", "Cameras", "Pose", "Images", "KnownFiles"})  # properties of the station that the scene shows


class StationScene:
    """The nodes of one station."""

    def __init__(self, view_object: Any) -> None:
        self._view = view_object
        self._shown = coin.SoSwitch()
        self._shown.whichChild = coin.SO_SWITCH_ALL
        self._pose, self._lines, self._photo = coin.SoTransform(), coin.SoSeparator(), coin.SoSeparator()
        root, unpickable, unlit = coin.SoSeparator(), coin.SoPickStyle(), coin.SoLightModel()
        unpickable.style = coin.SoPickStyle.UNPICKABLE
        unlit.model = coin.SoLightModel.BASE_COLOR
        for node in (unpickable, unlit, self._pose, self._lines, self._photo):
            root.addChild(node)
        self._shown.addChild(root)
        view_object.RootNode.addChild(self._shown)

    @classmethod
    def attached_to(cls, view_object: Any) -> StationScene | None:
        """Return the scene of a station's view, drawn; None where coin is not at hand."""
        if coin is None:
            FreeCAD.Console.PrintWarning("Stations are not shown in 3D: pivy is missing (Debian: apt-get install python3-pivy)\n")
            return None
        for name, kind, tooltip, value in VIEW_PROPERTIES:
            if name not in view_object.PropertiesList:
                view_object.addProperty(kind, name, "Station", tooltip)
                setattr(view_object, name, value)
        scene = cls(view_object)
        scene._draw()
        return scene

    def object_changed(self, obj: Any, name: str) -> None:
        """Draw anew what depends on a property of the station."""
        if name in SHAPING and not is_newer(obj):
            self._draw()

    def view_changed(self, view_object: Any, name: str) -> None:
        """Draw anew what depends on a property of the view."""
        if name == "Visibility":
            self._shown.whichChild = coin.SO_SWITCH_ALL if view_object.Visibility else coin.SO_SWITCH_NONE
        elif name == "CameraSize":
            self._draw_fields(self._cameras())
        elif name in ("Photo", "PhotoDistance", "PhotoTransparency"):
            self._draw_photo()

    def _cameras(self) -> Sequence[Camera]:
        """Return the station's cameras; none while it is being made, or where its calibration cannot be found."""
        obj = self._view.Object
        if is_newer(obj) or "Pose" not in obj.PropertiesList or not (obj.Calibration or obj.StationFile):
            return ()
        try:
            return cameras_of(obj)
        except PipeWorkbenchError as error:
            FreeCAD.Console.PrintWarning(f"{error}\n")
            return ()

    def _draw(self) -> None:
        cameras = self._cameras()
        if cameras:
            pose, offered = self._view.Object.Pose, [NO_PHOTO, *(camera.name for camera in cameras)]
            self._pose.translation = tuple(pose.Base)
            self._pose.rotation = pose.Rotation.Q
            if self._view.getEnumerationsOfProperty("Photo") != offered:
                self._view.Photo = offered
        self._draw_fields(cameras)
        self._draw_photo()

    def _draw_fields(self, cameras: Sequence[Camera]) -> None:
        """Draw a pyramid from each camera's projection centre to the corners of its image; a second line marks its upper side."""
        self._lines.removeAllChildren()
        if not cameras:
            return
        points: list[Array] = []
        for camera in cameras:
            centre = camera.projection_centre
            # from the upper left corner clockwise
            corners = centre + self._view.CameraSize.Value * camera.rays(_corners(camera))
            top = corners[:2] + 0.04 * (corners[:2] - corners[[3, 2]])
            for corner in corners:
                points += [centre, corner]
            for first, second in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                points += [first, second]
            points += [*top]
        colour, style, coordinates, lines = coin.SoBaseColor(), coin.SoDrawStyle(), coin.SoCoordinate3(), coin.SoLineSet()
        colour.rgb = LINE_COLOUR
        style.lineWidth = LINE_WIDTH_PX
        coordinates.point.setValues(0, len(points), np.array(points).tolist())
        lines.numVertices.setValues(0, len(points) // 2, [2] * (len(points) // 2))
        for node in (colour, style, coordinates, lines):
            self._lines.addChild(node)

    def _draw_photo(self) -> None:
        """Hang the wanted photograph into space: a mesh of rays through its pixels, so that its distortion is taken back."""
        self._photo.removeAllChildren()
        wanted = self._view.Photo
        if wanted in (NO_PHOTO, None):
            return
        try:
            station = station_of(self._view.Object)
            index = station.camera_index(wanted)
            if index is None:
                return
            picture = _picture(station, index)
        except PipeWorkbenchError as error:
            FreeCAD.Console.PrintError(f"{error}\n")
            return
        pixels, across, down = _mesh(station.cameras[index])
        points = station.cameras[index].projection_centre + _at_depth(station.cameras[index], pixels, self._view.PhotoDistance.Value)
        interior = station.cameras[index].interior
        # a picture's first row is its lowest one in coin
        places = np.column_stack([(pixels[:, 0] + 0.5) / interior.width, 1 - (pixels[:, 1] + 0.5) / interior.height])
        material, texture, coordinates = coin.SoMaterial(), coin.SoTexture2(), coin.SoCoordinate3()
        texture_coordinates, mesh = coin.SoTextureCoordinate2(), coin.SoQuadMesh()
        material.diffuseColor = (1, 1, 1)
        material.transparency = self._view.PhotoTransparency / 100
        texture.image.setValue(coin.SbVec2s(picture.shape[1], picture.shape[0]), 1, np.ascontiguousarray(picture[::-1]).tobytes())
        texture.wrapS = texture.wrapT = coin.SoTexture2.CLAMP
        coordinates.point.setValues(0, len(points), points.tolist())
        texture_coordinates.point.setValues(0, len(places), places.tolist())
        mesh.verticesPerRow, mesh.verticesPerColumn = across, down
        for node in (material, texture, texture_coordinates, coordinates, mesh):
            self._photo.addChild(node)


def _corners(camera: Camera) -> Array:
    """Return the corners (4, 2) of a camera's image in pixels, from the upper left one clockwise."""
    right, bottom = camera.interior.width - 0.5, camera.interior.height - 0.5
    return np.array([[-0.5, -0.5], [right, -0.5], [right, bottom], [-0.5, bottom]])


def _mesh(camera: Camera) -> tuple[Array, int, int]:
    """Return pixels (n, 2) all over a camera's image, row by row, how many there are in a row and how many rows."""
    width, height = camera.interior.width, camera.interior.height
    across, down = (max(2, round(MESH * side / max(width, height)) + 1) for side in (width, height))
    u, v = np.meshgrid(np.linspace(-0.5, width - 0.5, across), np.linspace(-0.5, height - 0.5, down))
    return np.column_stack([u.ravel(), v.ravel()]), across, down


def _at_depth(camera: Camera, pixels: Array, depth: float) -> Array:
    """Return where the rays of pixels (n, 2) meet the plane at a depth (mm) before the camera, (n, 3) from its projection centre."""
    rays = camera.rays(pixels)
    return np.asarray(rays * (depth / (rays @ camera.rotation[2]))[:, None])


def _picture(station: Any, index: int) -> NDArray[np.uint8]:
    """Return a photograph (height, width) as grey values for the eye, no larger than the graphics card needs."""
    import cv2

    from pipeworkbench.recon.images import read_image

    grey = read_image(station, index).astype(np.float32)
    low, high = np.percentile(grey[::7, ::7], GREY_PERCENTILES)
    scale = min(1.0, PHOTO_PX / grey.shape[1])
    small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.clip((small - low) * (255 / max(high - low, 1)), 0, 255).astype(np.uint8)
